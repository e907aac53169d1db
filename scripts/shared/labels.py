"""Words at the curves of a picture, in place of a legend."""

from __future__ import annotations

import math
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


def power_of_ten(value: float) -> str:
    """A number as a figure has it, 5e8 as 5 times ten to the eighth."""
    exponent = math.floor(math.log10(value) + 1e-9)
    first = f"{value / 10**exponent:.3g}"
    return rf"$10^{{{exponent}}}$" if first == "1" else rf"${first} \cdot 10^{{{exponent}}}$"
