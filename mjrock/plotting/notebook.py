"""What notebooks show: figures, without a word of magic, and the picture of each type of problem and answer."""

from __future__ import annotations

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
from ..study.loading.push import Push
from ..study.loading.pushover import PushoverCurve
from ..study.sensitivity import Sensitivity
from .histories import history
from .masonry import blocks, mechanism
from .studies import fragility, push, pushover, tornado
from .style import figure_of, png, wrapped
from .wall import sketch

MOST_BLOCKS = 3000
"""Blocks up to which masonry is drawn unasked, which takes some seconds."""
PICTURES: dict[type, Callable[..., Figure | Axes | None]] = {
    Case: sketch,
    MasonryCase: lambda case, said: _masonry(case.masonry, said),
    Masonry: lambda masonry, said: _masonry(masonry, said),
    Collapse: lambda found, said: None if found.forces is None else _titled(mechanism(found), said),
    Response: history,
    Comparison: lambda pair, said: history([pair.reference, pair.candidate], said),
    Push: lambda curve, said: _titled(push({"": curve}), said),
    PushoverCurve: lambda curve, said: _titled(pushover({"": curve}), said),
    Fragility: lambda fit, said: _titled(fragility(fit), said),
    Sensitivity: lambda found, said: _titled(tornado(found), said),
}
"""The picture of each type below its text; None stands for no picture."""


def png_of(shown: object) -> bytes | None:
    """The picture of a problem or an answer as a PNG, below the line that it prints as; None where it has none."""
    draw = next(draw for kind, draw in PICTURES.items() if isinstance(shown, kind))
    drawn = draw(shown, repr(shown).strip("<>"))
    figure = figure_of(drawn) if isinstance(drawn, Axes) else drawn
    return None if figure is None else png(figure)


def _titled(ax: Axes, said: str) -> Axes:
    ax.set_title(wrapped(said, figure_of(ax).get_figwidth() - 0.6, 9), fontsize=9)
    return ax


def _masonry(masonry: Masonry, said: str) -> Axes | None:
    return _titled(blocks(masonry), said) if len(masonry.blocks) <= MOST_BLOCKS else None
