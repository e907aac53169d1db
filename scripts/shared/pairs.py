"""A picture of the same cases in two ways."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike


def pairs(ax: Axes, values: ArrayLike, names: tuple[str, str], limits: tuple[float, float]) -> Axes:
    """Peak rotations of the same cases in two ways, on logarithmic axes; what falls lies on the upper edge.

    `values` are multiples of alpha, shape (n, 2).
    """
    low, high = limits
    a, b = np.clip(np.asarray(values, dtype=float), low, high).T
    ax.plot([low, high], [low, high], color="0.6", linewidth=0.8)
    ax.loglog(a, b, linestyle="", marker="o", markersize=3.5, markeredgewidth=0, alpha=0.55, color="#12406b")
    limits = 0.8 * low, 1.25 * high
    x, y = (rf"$\theta_{{max}}/\alpha$, {name} [-]" for name in names)
    ax.set(xlim=limits, ylim=limits, aspect="equal", xlabel=x, ylabel=y)
    return ax
