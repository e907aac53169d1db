"""A picture of the same cases by two methods."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from mjrock.plotting.style import BLUE, Look
from scripts.shared.labels import SMALL

GUTTER = 2.2
"""Width of the strips for walls that rest and that overturn, as a factor on the axis [-]."""


def pairs(ax: Axes, values: ArrayLike, names: tuple[str, str], limits: tuple[float, float], title: str) -> Axes:
    """Peak rotations of the same cases by two methods, on logarithmic axes.

    Peaks below the limits lie in a grey strip at the left or below, of walls that rest, and those above, of walls that
    overturn, in one at the right or above. Two lines below the title count the walls that overturn by both methods and
    by each of them alone.

    Args:
        ax: where to draw.
        values: peaks over alpha, shape (n, 2); infinity stands for overturning.
        names: of the two methods.
        limits: least and largest rotation of a wall that rocks, over alpha.
        title: what stands above.
    """
    low, high = limits
    given = np.asarray(values, dtype=float)
    fell = ~(given <= high)
    wide = np.sqrt(GUTTER)
    a, b = np.where(fell, high * wide, np.where(given < low, low / wide, given)).T
    for span in (ax.axvspan, ax.axhspan):
        span(low / GUTTER, low, color="0.93", linewidth=0, zorder=0)
        span(high, high * GUTTER, color="0.93", linewidth=0, zorder=0)
    ax.plot([low, high], [low, high], color="0.6", linewidth=0.8)
    ax.loglog(a, b, linestyle="", marker="o", markersize=3.5, markeredgewidth=0, alpha=0.45, color=BLUE)
    x, y = (rf"$\theta_{{max}}/\alpha$, {name} [-]" for name in names)
    limits = low / GUTTER, high * GUTTER
    ax.set(xlim=limits, ylim=limits, aspect="equal", xlabel=x, ylabel=y)
    alone = [int((fell[:, i] & ~fell[:, 1 - i]).sum()) for i in (0, 1)]
    counts = f"{len(given)} runs, overturned: both {int(fell.all(axis=1).sum())},\n"
    counts += ", ".join(f"{name} alone {count}" for name, count in zip(names, alone, strict=True))
    look: Look = {"textcoords": "offset points", "fontsize": SMALL, "xycoords": "axes fraction"}
    ax.annotate(counts, (0.5, 1.0), (0, 4), ha="center", va="bottom", **look)
    ax.set_title(title, fontsize=9, pad=6 + 2.6 * SMALL)
    ax.text(low / wide, high, "at rest", rotation=90, fontsize=SMALL, ha="center", va="top")
    ax.text(low, high * wide, "overturned", fontsize=SMALL, ha="left", va="center")
    return ax
