"""Words of a figure as its reader sees them: where they stand, and what they lie on."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.transforms import Bbox

TOUCH = 0.6
"""How far boxes of words reach into each other before they touch, in pt: a box has room around its letters."""
COVERS = 0.6
"""Least opacity of the box behind words from which on a line below does not strike them through [-]."""
STRIKES = 0.25
"""Share of the height of a word by which a line has to be away from its upper and lower edge to strike it through."""


def words_of(figure: Figure) -> list[tuple[Text, Bbox]]:
    """Every text that is drawn with its box [pixel]; the figure is drawn already."""
    found = [*figure.texts, figure._suptitle, *itertools.chain(*(legend.get_texts() for legend in figure.legends))]
    for ax in figure.axes:
        if not ax.get_visible():
            continue
        found += [ax.title, ax._left_title, ax._right_title]
        if (legend := ax.get_legend()) is not None:
            found += [*legend.get_texts(), legend.get_title()]
        if ax.name == "3d":  # a place in space is none in the figure
            continue
        found += ax.texts
        if ax.axison:
            for axis in (ax.xaxis, ax.yaxis):
                low, high = sorted(axis.get_view_interval())
                near = 1e-9 * (high - low)
                ticks = [tick for tick in axis.get_major_ticks() if low - near <= tick.get_loc() <= high + near]
                found += [axis.label, axis.get_offset_text(), *(tick.label1 for tick in ticks)]
    seen = {id(text): text for text in found if text is not None and text.get_visible() and text.get_text().strip()}
    return [(text, Text.get_window_extent(text)) for text in seen.values()]  # of an annotation without its arrow


def legends_of(figure: Figure) -> list[Legend]:
    """The legends of a figure and of its Axes."""
    own = [ax.get_legend() for ax in figure.axes if ax.get_visible()]
    return [*figure.legends, *(legend for legend in own if legend is not None)]


def shared(one: Bbox, other: Bbox) -> tuple[float, float]:
    """Width and height of what two boxes share [pixel], negative where they share nothing."""
    return min(one.x1, other.x1) - max(one.x0, other.x0), min(one.y1, other.y1) - max(one.y0, other.y0)


def covered(figure: Figure) -> Iterator[str]:
    """The words that lie on other words, that a line strikes through, or that the edge of the figure cuts off."""
    words = words_of(figure)
    least = TOUCH * figure.dpi / 72
    for (text, box), (other, its) in itertools.combinations(words, 2):
        if min(shared(box, its)) > least:
            yield f"{text.get_text()!r} lies on {other.get_text()!r}"
    for text, box in words:
        if figure.bbox.padded(3.0).count_contains(box.corners()) != 4:
            yield f"{text.get_text()!r} is cut off by the edge of the figure"
        for line in lines_below(figure, text):
            if struck(line, box):
                yield f"{text.get_text()!r} is struck through by the line {line.get_label()!r}"


def lines_below(figure: Figure, text: Text) -> Iterator[Line2D]:
    """Lines that a text without a box of its own may lie on."""
    frames = [
        legend.get_frame() for legend in legends_of(figure) if text in legend.get_texts() and legend.get_frame_on()
    ]
    behind = text.get_bbox_patch() or next(iter(frames), None)
    if behind is not None and (behind.get_alpha() or 1.0) >= COVERS:
        return
    for ax in figure.axes:
        if ax.get_visible() and ax.name != "3d":
            yield from (line for line in ax.get_lines() if line.get_visible() and line.get_linestyle() != "None")


def struck(line: Line2D, box: Bbox) -> bool:
    """Whether a line that is drawn goes through the middle of a box, in the part of it that its Axes shows."""
    ax: Axes = line.axes
    path = line.get_transform().transform_path(line.get_path())
    room = STRIKES * box.height
    middle = Bbox.from_extents(box.x0, box.y0 + room, box.x1, box.y1 - room)
    seen = Bbox.intersection(middle, line.get_clip_box() or ax.bbox) if line.get_clip_on() else middle
    if seen is None or len(path.vertices) < 2 or not np.isfinite(path.vertices).all():
        return False
    return bool(Path(path.vertices).intersects_bbox(seen, filled=False))
