"""Which figures a page cannot show well: too wide, with small or cut text, or in colours of another meaning."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.colors import TABLEAU_COLORS, to_hex, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from mjrock.plotting import style

SMALLEST = 8.0
"""Smallest size of text [pt]."""
EDGE = 0.015
"""How far a text may go beyond the edge of a figure [inch]."""


def save(figure: Figure | Axes, path: str | Path) -> Path:
    """`plotting.save`, of a figure that a page shows well; AssertionError with the faults of any other."""
    drawn = style.figure_of(figure) if isinstance(figure, Axes) else figure
    dpi = drawn.dpi
    drawn.set_dpi(style.FINE)  # texts are measured where they are drawn
    written = style.save(drawn, path)
    assert list(faults(drawn)) == []
    drawn.set_dpi(dpi)
    return written


def faults(figure: Figure) -> Iterator[str]:
    """What a page cannot show well of a figure that is drawn already, as sentences.

    These are a figure wider than 7.4 in, text smaller than 8 pt, text that the edge cuts off, one of Matplotlib's own
    colours, and a line with the name of a solver and another colour than that of `STYLES`.
    """
    if (width := figure.get_figwidth()) > style.WIDEST + 1e-6:
        yield f"the figure is {width:.3g} in wide; at most {style.WIDEST:g} in are shown in full size"
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_visible() and text.get_text().strip() and (size := float(text.get_fontsize())) < SMALLEST - 1e-6:
            yield f"text {text.get_text()!r} has {size:g} pt; at least {SMALLEST:g} pt can be read"
    for text in placed_texts(figure):
        box = text.get_window_extent()
        if text.get_text().strip() and figure.bbox.padded(EDGE * figure.dpi).count_contains(box.corners()) != 4:
            yield f"text {text.get_text()!r} is cut off by the edge of the figure"
    for artist in figure.findobj(lambda one: isinstance(one, Line2D | Patch | Collection)):
        yield from _foreign_colours(artist)


def placed_texts(figure: Figure) -> list[Text]:
    """Titles, labels of axes, legends and texts that are drawn, but for those of ticks."""
    legends = [*figure.legends, *(ax.get_legend() for ax in figure.axes if ax.get_visible())]
    found = [*figure.texts, *(text for legend in legends if legend is not None for text in legend.get_texts())]
    for ax in figure.axes:
        if ax.get_visible():
            found.append(ax.title)
            if ax.name != "3d":  # a place in space is none in the figure
                found += [text for text in ax.texts if not text.get_clip_on()]
                found += [axis.label for axis in (ax.xaxis, ax.yaxis) if ax.axison]
    return [text for text in found if text.get_visible()]


def _foreign_colours(artist: Artist) -> Iterator[str]:
    """Artists with one of Matplotlib's own colours, or with the name of a solver and not its colour, as sentences."""
    label, of = str(artist.get_label()), {str(look["label"]): look["color"] for look in style.STYLES.values()}
    solver = next((name for name in of if label == name or label.startswith((f"{name},", f"{name}:"))), None)
    for colour in _colours(artist):
        if colour in TABLEAU_COLORS.values():
            yield f"{label!r} has the colour {colour} of Matplotlib; take those of plotting.PALETTE"
        if solver is not None and colour != of[solver]:
            yield f"{label!r} has the colour {colour}; that of its solver is {of[solver]}"


def _colours(artist: Artist) -> set[str]:
    """The colours of what is drawn, but for what is white or clear, and for values on a scale of colours."""
    names = ("color",) if isinstance(artist, Line2D) else ("facecolor", "edgecolor")
    if isinstance(artist, Collection) and artist.get_array() is not None:
        return set()
    found = np.concatenate([to_rgba_array(getattr(artist, f"get_{name}")()) for name in names])
    return {to_hex(colour) for colour in found if colour[3] > 0} - {"#ffffff"}
