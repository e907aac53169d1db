"""Words at the curves of a picture, in place of a legend."""

from __future__ import annotations

import re
from typing import Any

from matplotlib.axes import Axes

from mjrock.plotting.bodies import FORCE

SMALL = 8
"""Size of words in a picture [pt]."""


def beside(
    ax: Axes, at: tuple[float, float], text: str, color: str, shift: tuple[float, float] = (4, 0), **look: Any
) -> None:
    """A text of a colour, so many points right of a place and above it; left of it where that is negative."""
    look = {"ha": "left" if shift[0] >= 0 else "right", "va": "center", "fontsize": SMALL, "zorder": 6} | look
    ax.annotate(text, at, shift, textcoords="offset points", color=color, annotation_clip=False, **look)


def width_bar(ax: Axes) -> None:
    """Take the axes away, and draw a line as wide as that which their label has, with its size, below what is drawn."""
    found = re.search(r"line ([\d.]+) pt wide: (.+)", ax.get_xlabel())
    assert found is not None
    ax.axis("off")
    look: dict[str, Any] = {"transform": ax.transAxes, "clip_on": False, "solid_capstyle": "butt"}
    ax.plot([0.3, 0.4], [-0.06, -0.06], color=FORCE, linewidth=float(found[1]), **look)
    ax.text(0.43, -0.06, found[2], transform=ax.transAxes, fontsize=SMALL, va="center")
