"""Figures that a notebook shows where they are the last value of a cell."""

from __future__ import annotations

from io import BytesIO
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

BLACK, ORANGE, BLUE, PURPLE, GREEN = "#262626", "#d97706", "#1f6fc4", "#7a2a6b", "#3a9d7a"
PALETTE = (BLUE, ORANGE, GREEN, PURPLE, BLACK)
"""Colours of lines, in the order of a figure that says nothing else.

Each has a contrast of three on white, and readers who do not see red, green or blue tell them apart.
"""
FINE = 120
"""Dots of a picture in a notebook [1/inch]."""


class Picture(Figure):
    """A figure without `pyplot`, which a notebook shows by itself."""

    def sole_axes(self, projection: str | None = None) -> Axes:
        """A new Axes, which a notebook shows as the figure."""
        ax: Axes = self.add_subplot(projection=projection)
        vars(ax)["_repr_png_"] = self._repr_png_
        return ax

    def add_subplot(self, *given: Any, **options: Any) -> Axes:
        """A new Axes, whose lines have the colours of this package."""
        ax: Axes = super().add_subplot(*given, **options)
        ax.set_prop_cycle(color=PALETTE)
        return ax

    def _repr_png_(self) -> bytes:
        return png(self)


def png(figure: Figure) -> bytes:
    """A figure as a notebook shows it, a PNG."""
    written = BytesIO()
    figure.savefig(written, format="png", dpi=FINE)
    return written.getvalue()
