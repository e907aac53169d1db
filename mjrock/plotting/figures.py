"""Figures that a notebook shows where they are the last value of a cell."""

from __future__ import annotations

from io import BytesIO

from matplotlib.axes import Axes
from matplotlib.figure import Figure

FINE = 120
"""Dots of a picture in a notebook [1/inch]."""


class Picture(Figure):
    """A figure without `pyplot`, which a notebook shows by itself."""

    def sole_axes(self, projection: str | None = None) -> Axes:
        """A new Axes, which a notebook shows as the figure."""
        ax: Axes = self.add_subplot(projection=projection)
        vars(ax)["_repr_png_"] = self._repr_png_
        return ax

    def _repr_png_(self) -> bytes:
        return png(self)


def png(figure: Figure) -> bytes:
    """A figure as a notebook shows it, a PNG."""
    written = BytesIO()
    figure.savefig(written, format="png", dpi=FINE)
    return written.getvalue()
