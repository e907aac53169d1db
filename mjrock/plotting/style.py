"""How the lines of the solvers look, and how figures are laid out and saved."""

from __future__ import annotations

import math
import textwrap
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..contacts.files import replacing
from ..quantities import require_kind, require_path, require_text, shown
from ..result.response import Response

BLACK, ORANGE, BLUE, PURPLE, GREEN = "#262626", "#d97706", "#1f6fc4", "#7a2a6b", "#3a9d7a"
PALETTE = (BLUE, ORANGE, GREEN, PURPLE, BLACK)
"""Colours of lines, in the order in which a figure takes them.

Each has a contrast of three on white, and they differ also for readers who do not see red, green or blue.
"""
Look = dict[str, Any]
"""Options of what matplotlib draws, such as its colour."""
STYLES: dict[str, Look] = {
    "analytical": {"label": "rocking theory", "color": BLACK, "linestyle": "-", "linewidth": 1.1},
    "plain MuJoCo": {"label": "plain MuJoCo", "color": GREEN, "linestyle": "-.", "linewidth": 1.4, "zorder": 2.5},
    "MuJoCo": {"label": "MuJoCo", "color": ORANGE, "linestyle": "-", "linewidth": 2.6, "zorder": 1.5},
    "compliant": {"label": "contact law, SciPy", "color": PURPLE, "linestyle": ":", "linewidth": 1.5, "zorder": 3},
    "explicit": {"label": "explicit steps", "color": BLUE, "linestyle": "--", "linewidth": 1.6, "zorder": 2.5},
}
"""The line of each solver, the same in every figure. They differ in black and white too."""
WIDEST = 7.4
"""Largest width of a figure of panels [inch]: pages show it as wide as that."""
FINE = 200
"""Dots of a figure that is saved [1/inch]."""
COARSE = 120
"""Dots of a figure in a notebook [1/inch]."""
BEHIND: Look = {"facecolor": "white", "alpha": 0.9, "edgecolor": "none", "pad": 0.5}
"""A box behind text that may lie on lines."""
ON_LINES: Look = {"frameon": True, "framealpha": 0.8, "edgecolor": "none", "fancybox": False, "fontsize": 8}
"""A legend that may lie on lines."""

Drawing = Callable[[Axes], Axes]
"""A function that draws a panel."""


OWN: tuple[Look, ...] = (
    {"color": BLUE, "linestyle": "-", "linewidth": 1.5, "zorder": 2.4},
    {"color": ORANGE, "linestyle": "-", "linewidth": 2.4, "zorder": 2.2},
    {"color": GREEN, "linestyle": "--", "linewidth": 1.6, "zorder": 2.3},
    {"color": PURPLE, "linestyle": ":", "linewidth": 2.0, "zorder": 2.5},
    {"color": BLACK, "linestyle": "-.", "linewidth": 1.4, "zorder": 2.1},
)
"""Lines of responses that have labels of their own."""


class Picture(Figure):
    """A figure without `pyplot`, which a notebook shows by itself."""

    def add_subplot(self, *arguments: Any, **options: object) -> Axes:
        """A new Axes, whose lines have the colours of this package."""
        ax: Axes = super().add_subplot(*arguments, **options)
        ax.set_prop_cycle(color=PALETTE)
        return ax

    def _repr_png_(self) -> bytes:
        return png(self)


def png(figure: Figure) -> bytes:
    """A figure as a notebook shows it, a PNG."""
    written = BytesIO()
    figure.savefig(written, format="png", dpi=COARSE)
    return written.getvalue()


def styles_of(responses: Sequence[Response], labels: Sequence[str] | None = None) -> list[Look]:
    """The line style of each response: that of its solver, or with labels one of its own."""
    if labels is None:
        return [STYLES.get(response.solver, {"label": response.solver}) for response in responses]
    checked = require_labels(labels, responses)
    return [OWN[i % len(OWN)] | {"label": folded(label)} for i, label in enumerate(checked)]


def require_labels(labels: object, responses: Sequence[Response]) -> list[str]:
    """Labels of responses, a text for each.

    Raises:
        TypeError, ValueError: if they are not texts, or another number of them.
    """
    if isinstance(labels, str) or not isinstance(labels, Sequence):
        raise TypeError(f"labels = {shown(labels)} is not a sequence of texts")
    if len(labels) != len(responses):
        raise ValueError(f"labels has {len(labels)} texts for {len(responses)} responses; one for each is needed")
    return [require_text(f"labels[{i}]", label) for i, label in enumerate(labels)]


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Names of effects as a picture has them: "tie" for `tie_0` where it is the only tie."""
    all_names = list(names)
    kinds = Counter(name.rpartition("_")[0] for name in all_names)
    return {
        name: stem.replace("_", " ") if number == "0" and stem and kinds[stem] == 1 else name
        for name, (stem, _, number) in zip(all_names, (name.rpartition("_") for name in all_names), strict=True)
    }


def folded(label: str) -> str:
    """A label on as many lines as a legend needs for it."""
    return wrapped(label, 3.2, 10)


def short(label: str) -> str:
    """A label that may be cut, where another legend has it in full."""
    return textwrap.shorten(label, 24, placeholder=" ...")


def below_figure(figure: Figure, ax: Axes, ncols: int = 3, fontsize: float | None = None) -> None:
    """The legend of an Axes below its figure."""
    legend_below(figure, *ax.get_legend_handles_labels(), ncols, fontsize)


def legend_below(
    figure: Figure, handles: Sequence[Artist], labels: Sequence[str], ncols: int, fontsize: float | None = None
) -> None:
    """A legend below a figure, in at most `ncols` columns and no more than its width has room for.

    A legend of many lines makes the figure higher. The size of its text is given in pt.
    """
    for columns in range(max(1, min(ncols, len(labels))), 0, -1):
        look: Look = {"loc": "outside lower center", "ncols": columns, "frameon": False, "fontsize": fontsize}
        legend = figure.legend(handles, labels, **look)
        box = legend.get_window_extent()
        if columns == 1 or box.width <= 0.98 * figure.bbox.width:
            break
        legend.remove()
    figure.set_figheight(figure.get_figheight() + max(0.0, box.height / figure.dpi - 0.8))


def wrapped(text: str, wide: float, size: float) -> str:
    """Text of a size [pt] on as many lines as a width [inch] needs."""
    columns = max(1, int(72 * wide / (0.55 * size)))
    return "\n".join(line for row in text.splitlines() for line in textwrap.wrap(row, columns))


def width_of(figure: Figure, text: str, size: float) -> float:
    """Width of a text of a size [pt] in a figure [inch]."""
    written = figure.text(0.0, 0.0, text, fontsize=size)
    width = float(written.get_window_extent().width) / figure.dpi
    written.remove()
    return width


def power_of_ten(value: float) -> str:
    """A number as a figure has it: 5e8 as 5 times ten to the eighth, and in full from 0.001 to 9999."""
    if value == 0 or not math.isfinite(value) or 1e-3 <= abs(value) < 1e4:
        return f"{value:.4g}"
    first, exponent = f"{value:.3e}".split("e")
    factor = "" if float(first) == 1 else rf"{float(first):.4g} \cdot "
    return rf"${factor}10^{{{int(exponent)}}}$"


def write_title(figure: Figure, text: str, size: float = 11.0) -> float:
    """Write a title [pt] above a figure on as many lines as its width needs; the height that it takes [inch]."""
    title = wrapped(text, figure.get_figwidth(), size)
    figure.suptitle(title, fontsize=size)
    return 1.3 * size * len(title.splitlines()) / 72


def figure_of_panels(count: int, columns: int, size: tuple[float, float]) -> tuple[Figure, NDArray[Any]]:
    """A figure with `count` panels of a size [inch] in rows of some columns, and its Axes, shape (rows, columns).

    Panels are narrower where the figure would be wider than `WIDEST`.
    """
    rows = -(-count // columns)
    figure = Picture(figsize=(min(size[0] * columns, WIDEST), size[1] * rows), layout="constrained")
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
    figure_saved = figure_of(figure) if isinstance(figure, Axes) else figure
    path = require_path("path", path)
    if path.name not in ("", "..") and not path.suffix:
        path = path.with_suffix(".png")
    formats = figure_saved.canvas.get_supported_filetypes()
    if path.suffix[1:].lower() not in formats:
        raise ValueError(f"path = {(path.name or str(path))!r} does not end in .{', .'.join(sorted(formats))}")
    with replacing(path) as partial:
        figure_saved.savefig(partial, dpi=FINE, metadata={"Software": None} if path.suffix == ".png" else None)
    return path
