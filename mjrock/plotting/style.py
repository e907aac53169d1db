"""How the lines of the solvers look, and how figures are laid out and saved."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..files import replacing
from ..quantities import require_kind, require_path
from ..result.response import Response
from .arguments import picture
from .figures import Picture

Look = dict[str, Any]
"""Options of what matplotlib draws, such as its colour."""
STYLES: dict[str, Look] = {
    "analytical": {"label": "rocking theory", "color": "0.15", "linestyle": "-", "linewidth": 1.1},
    "plain MuJoCo": {"label": "plain MuJoCo", "color": "#b5402a", "linestyle": "-.", "linewidth": 1.4, "zorder": 2.5},
    "MuJoCo": {"label": "MuJoCo", "color": "#f0a35e", "linestyle": "-", "linewidth": 2.6, "zorder": 1.5},
    "compliant": {"label": "contact law, SciPy", "color": "#12406b", "linestyle": ":", "linewidth": 1.5, "zorder": 3},
    "explicit": {"label": "explicit steps", "color": "#3f8f5b", "linestyle": "--", "linewidth": 1.6, "zorder": 2.5},
}
"""Lines that a black-and-white print still tells apart."""

Drawing = Callable[[Axes], Axes]
"""A function that draws a panel."""


OWN: tuple[Look, ...] = (
    {"color": "#12406b", "linestyle": "-", "linewidth": 1.5, "zorder": 2.4},
    {"color": "#e07b2a", "linestyle": "-", "linewidth": 2.4, "zorder": 2.2},
    {"color": "#3f8f5b", "linestyle": "--", "linewidth": 1.6, "zorder": 2.3},
    {"color": "#8c4a8f", "linestyle": ":", "linewidth": 2.0, "zorder": 2.5},
    {"color": "0.25", "linestyle": "-.", "linewidth": 1.4, "zorder": 2.1},
)
"""Lines of responses that have labels of their own."""


def styles_of(responses: Sequence[Response], labels: Sequence[str] | None = None) -> list[Look]:
    """The line style of each response: that of its solver, or with labels one of its own."""
    if labels is None:
        return [STYLES.get(response.solver, {"label": response.solver}) for response in responses]
    if len(labels) != len(responses):
        raise ValueError(f"labels has {len(labels)} texts for {len(responses)} responses; one for each is needed")
    return [OWN[i % len(OWN)] | {"label": folded(label)} for i, label in enumerate(labels)]


def folded(label: str) -> str:
    """A label on as many lines as a legend needs for it."""
    return wrapped(label, 3.2, 10)


def short(label: str) -> str:
    """A label that may be cut, where another legend has it in full."""
    return textwrap.shorten(label, 24, placeholder=" ...")


def below_figure(figure: Figure, ax: Axes, ncols: int = 3, **options: Any) -> None:
    """The legend of an Axes below its figure."""
    legend_below(figure, *ax.get_legend_handles_labels(), ncols, **options)


def legend_below(figure: Figure, handles: Sequence[Artist], labels: Sequence[str], ncols: int, **options: Any) -> None:
    """A legend below a figure, in at most `ncols` columns and no more than its width has room for.

    A legend of many lines makes the figure higher.
    """
    for columns in range(max(1, min(ncols, len(labels))), 0, -1):
        legend = figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False, **options)
        box = legend.get_window_extent()
        if columns == 1 or box.width <= 0.98 * figure.bbox.width:
            break
        legend.remove()
    figure.set_figheight(figure.get_figheight() + max(0.0, box.height / figure.dpi - 0.8))


def wrapped(text: str, wide: float, size: float) -> str:
    """Text of a size [pt] on as many lines as a width [inch] needs."""
    most = max(1, int(72 * wide / (0.55 * size)))
    return "\n".join(line for row in text.splitlines() for line in textwrap.wrap(row, most))


def titled(figure: Figure, text: str, size: float = 11.0) -> float:
    """Write a title [pt] above a figure on as many lines as its width needs; the height that it takes [inch]."""
    title = wrapped(text, figure.get_figwidth(), size)
    figure.suptitle(title, fontsize=size)
    return 1.3 * size * len(title.splitlines()) / 72


def several(count: int, columns: int, size: tuple[float, float]) -> tuple[Figure, Any]:
    """A figure with so many panels in rows of some columns, each of a size [inch], and its Axes, (rows, columns)."""
    rows = -(-count // columns)
    figure = Picture(figsize=(size[0] * columns, size[1] * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for ax in axes.flat[count:]:
        ax.set_visible(False)
    return figure, axes


def figure_of(ax: Axes) -> Figure:
    """The figure that an Axes stands in."""
    figure = ax.get_figure(root=True)
    assert isinstance(figure, Figure)
    return figure


def save(figure: Figure | Axes, path: str | Path) -> Path:
    """Write a figure, or that of an Axes, in the format of the path's suffix.

    It has no traces of when and by what it was made (reproducible bytes).

    A path without a suffix is that of a PNG. Returns the path that was written.

    Raises:
        TypeError: for what is not a figure or an Axes.
        ValueError: for a suffix that Matplotlib does not write.
    """
    require_kind("figure", figure, Figure, Axes)
    drawn = figure_of(figure) if isinstance(figure, Axes) else figure
    path = require_path("path", path)
    if path.name not in ("", "..") and not path.suffix:
        path = path.with_suffix(".png")
    formats = drawn.canvas.get_supported_filetypes()
    if path.suffix[1:].lower() not in formats:
        raise ValueError(f"path = {(path.name or str(path))!r} does not end in .{', .'.join(sorted(formats))}")
    with replacing(path) as partial:
        drawn.savefig(partial, dpi=200, metadata={"Software": None} if path.suffix == ".png" else None)
    return path


@picture()
def single(draw: Drawing, size: tuple[float, float] = (5.2, 3.6)) -> Figure:
    """A figure with one Axes, drawn by `draw`."""
    figure = Picture(figsize=size, layout="constrained")
    draw(figure.subplots())
    return figure


@picture()
def panels(drawings: Sequence[tuple[str, Drawing]], columns: int = 2) -> Figure:
    """Several drawings, each on an Axes of its own under its title."""
    figure, axes = several(len(drawings), columns, (4.4, 3.4))
    for ax, (title, draw) in zip(axes.flat, drawings, strict=False):
        draw(ax).set_title(wrapped(title, 4.0, 10), fontsize=10)
    return figure
