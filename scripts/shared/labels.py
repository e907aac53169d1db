"""Words at the curves of a picture, in place of a legend."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes

SMALL = 8
"""Size of words in a picture [pt]."""


def beside(
    ax: Axes, at: tuple[float, float], text: str, color: str, shift: tuple[float, float] = (4, 0), **look: Any
) -> None:
    """A text of a colour, so many points right of a place and above it; left of it where that is negative."""
    look = {"ha": "left" if shift[0] >= 0 else "right", "va": "center", "fontsize": SMALL, "zorder": 6} | look
    ax.annotate(text, at, shift, textcoords="offset points", color=color, annotation_clip=False, **look)


def without_axes(ax: Axes) -> None:
    """Take the axes away, and put the legend in their place."""
    ax.axis("off")
    if (legend := ax.get_legend()) is not None:
        legend.set_bbox_to_anchor((0.5, 0.0), ax.transAxes)
