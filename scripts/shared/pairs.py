"""A picture of the same cases in two ways."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from mjrock.plotting.style import BLUE
from scripts.shared.labels import SMALL

GUTTER = 2.2
"""Width of the strips for walls that rest and that overturn, as a factor on the axis [-]."""


def pairs(ax: Axes, values: ArrayLike, names: tuple[str, str], limits: tuple[float, float]) -> Axes:
    """Peak rotations of the same cases in two ways, on logarithmic axes.

    Peaks below the limits lie in a grey strip at the left or below, of walls that rest, and those above, of walls that
    overturn, in one at the right or above. Numbers say how many overturn in both ways, and in each of them alone.

    Args:
        ax: where to draw.
        values: peaks over alpha, shape (n, 2); infinity stands for overturning.
        names: of the two ways.
        limits: least and largest rotation of a wall that rocks, over alpha.
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
    text = f"{len(given)} runs\noverturned\nin both {int(fell.all(axis=1).sum())}"
    text += "".join(f"\n{name} alone {count}" for name, count in zip(names, alone, strict=True))
    ax.text(0.86, 0.14, text, transform=ax.transAxes, fontsize=SMALL, ha="right", va="bottom")
    ax.text(low / wide, np.sqrt(low * high), "at rest", rotation=90, fontsize=SMALL, ha="center", va="center")
    ax.text(np.sqrt(low * high), high * wide, "overturned", fontsize=SMALL, ha="center", va="center")
    return ax
