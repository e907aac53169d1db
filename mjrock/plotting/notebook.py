"""Pictures that a notebook shows of each type of problem and answer, without a call."""

from __future__ import annotations

import re
from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..problem.masonry.case import MasonryCase
from ..problem.masonry.limit.collapse import Collapse
from ..problem.masonry.masonry import Masonry
from ..problem.wall.case import Case
from ..result.compare import Comparison
from ..result.response import Response
from ..study.intensity.fragility import Fragility
from ..study.intensity.overturning_map import OverturningMap
from ..study.intensity.thresholds import Thresholds
from ..study.loading.design import Design
from ..study.loading.push import Push
from ..study.loading.pushover import PushoverCurve
from ..study.sensitivity import Sensitivity
from .histories import displacement, history
from .masonry import blocks, mechanism
from .studies import design, fragility, overturning_map, push, pushover, thresholds, tornado
from .style import Picture, figure_of, png, wrapped
from .wall import sketch

MOST_BLOCKS = 3000
"""Most blocks of masonry that a notebook draws by itself, which takes some seconds."""
PICTURES: dict[type, Callable[..., Figure | Axes | None]] = {
    Case: sketch,
    MasonryCase: lambda case, title: _masonry(case.masonry),
    Masonry: lambda masonry, title: _masonry(masonry),
    Collapse: lambda found, title: None if found.forces is None else mechanism(found),
    Response: lambda answer, title: history(answer, title) if answer.joints is None else _run(answer, title),
    Comparison: lambda pair, title: history([pair.reference, pair.candidate], title),
    Push: lambda curve, title: push({"": curve}),
    PushoverCurve: lambda curve, title: pushover({"": curve}),
    Fragility: lambda fit, title: fragility(fit),
    Design: lambda found, title: design(found),
    Sensitivity: lambda found, title: tornado(found),
    Thresholds: lambda found, title: thresholds(found),
    OverturningMap: lambda found, title: overturning_map(found),
}
"""The function that draws each type, from it and the text that it prints as. It returns None for no picture."""


def png_of(shown: object) -> bytes | None:
    """The picture of a problem or an answer as a PNG; None where it has none.

    Its title is the line that it prints as, without that of its wall or masonry, which the picture shows.
    """
    title = re.sub(r" of <[^<>]*>", "", repr(shown)).strip("<>")
    draw = next(draw for shown_type, draw in PICTURES.items() if isinstance(shown, shown_type))
    picture_drawn = draw(shown, title)
    if not isinstance(picture_drawn, Axes):
        return None if picture_drawn is None else png(picture_drawn)
    figure = figure_of(picture_drawn)
    picture_drawn.set_title(wrapped(title, figure.get_figwidth() - 0.6, 9), fontsize=9)
    return png(figure)


def _masonry(masonry: Masonry) -> Axes | None:
    return blocks(masonry) if len(masonry.blocks) <= MOST_BLOCKS else None


def _run(answer: Response, title: str) -> Figure:
    """The blocks of masonry at the end of a run, above how far they have moved."""
    figure = Picture(figsize=(6.4, 6.0), layout="constrained")
    (above,), (below,) = figure.subfigures(2, 1, squeeze=False, height_ratios=(2.0, 1.0))
    above.suptitle(wrapped(title, 6.0, 9), fontsize=9)
    if len(answer.case.rest_geometry.solids) <= MOST_BLOCKS:
        blocks(above.subplots(subplot_kw={"projection": "3d"} if answer.in_space else None), answer)
    ax = displacement(below.subplots(), [answer])
    if answer.fallen:
        ax.set_title("a cross where a block falls", fontsize=9)
    return figure
