"""Checks of the arguments of pictures by their names: `ax` is an Axes in each, `title` a text. Figures of panels."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Concatenate, ParamSpec, Protocol, TypeVar, cast, overload

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from numpy.typing import ArrayLike

from ..problem.wall.case import Case
from ..quantities import Array, require_kind, require_reals, require_text, require_whole, require_within, shown
from ..result.response import Response
from ..study.intensity.fragility import Fragility
from .style import Drawing, Picture, figure_of_panels, wrapped

P = ParamSpec("P")
Drawer = TypeVar("Drawer", bound=Callable[..., object])
Check = Callable[[str, object], object]
"""Raises a TypeError or ValueError with the name and the value of an invalid argument."""
MOST_COLUMNS = 50
"""Most panels beside each other."""
BETWEEN, LOWER = 0.12, 0.95
"""Height between two rows of panels [inch], and that over which a figure of panels is not made lower, over its own."""


def kind(*kinds: type) -> Check:
    """A check for one of these types."""
    return lambda name, value: require_kind(name, value, *kinds)


def shaped(axes: int, needed: str) -> Check:
    """A check for an array of real numbers with a number of axes, of at least one number."""

    def checked(name: str, value: object) -> None:
        array = require_reals(name, value, needed)
        if array.ndim != axes or not array.size:
            raise ValueError(f"{name} has the shape {array.shape}; {needed} is needed")

    return checked


def equal_rows(**rows: ArrayLike) -> tuple[Array, ...]:
    """Rows of real numbers that are drawn against each other, as arrays.

    Raises:
        TypeError, ValueError: with their names, unless they are rows of one length, of at least one number.
    """
    checked = {name: require_reals(name, row, "a row of real numbers") for name, row in rows.items()}
    shapes = {name: row.shape for name, row in checked.items()}
    if len(set(shapes.values())) > 1 or any(row.ndim != 1 or not row.size for row in checked.values()):
        shapes_text = ", ".join(f"{name} has the shape {shape}" for name, shape in shapes.items())
        raise ValueError(f"{shapes_text}; rows of one length are needed")
    return tuple(checked.values())


def anything(name: str, value: object) -> None:
    """An argument that is checked elsewhere."""


def mapping(check: Check, least: int = 1) -> Check:
    """A check for a mapping of at least `least` names to values, each with a check of its own."""

    def checked(name: str, value: object) -> None:
        if not isinstance(value, Mapping) or len(value) < least:
            raise TypeError(f'{name} = {shown(value)} is not a mapping like {{"name": value}}, of at least {least}')
        for key, item in value.items():
            require_text(f"a name of {name}", key)
            check(f"{name}[{key!r}]", item)

    return checked


def listed(check: Check) -> Check:
    """A check for a sequence of at least one, each with a check of its own."""

    def checked(name: str, value: object) -> None:
        if isinstance(value, str) or not isinstance(value, Sequence) or not len(value):
            raise TypeError(f"{name} = {shown(value)} is not a sequence of at least one")
        for i, item in enumerate(value):
            check(f"{name}[{i}]", item)

    return checked


def pair(first: Check, second: Check) -> Check:
    """A check for a pair."""

    def checked(name: str, value: object) -> None:
        if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 2:
            raise TypeError(f"{name} = {shown(value)} is not a pair")
        first(f"{name}[0]", value[0])
        second(f"{name}[1]", value[1])

    return checked


def of_wall(name: str, value: object) -> None:
    """A response of a wall."""
    require_kind(name, value, Response)
    if isinstance(value, Response) and value.rocking is None:
        raise TypeError(f"{name} is of masonry, and the picture is of one wall; for masonry take plotting.displacement")


def drawing(name: str, value: object) -> None:
    """A function that draws on an Axes."""
    if not callable(value):
        raise TypeError(f"{name} = {shown(value)} is not a function that draws on an Axes")


CHECKS: dict[str, Check] = {
    "ax": kind(Axes),
    "case": kind(Case),
    "closed": mapping(pair(anything, anything), least=0),
    "columns": lambda name, value: require_whole(name, value, 1, MOST_COLUMNS),
    "draw": drawing,
    "drawings": listed(pair(require_text, drawing)),
    "fit": kind(Fragility),
    "intensity": shaped(1, "a row of at least one real number"),
    "labels": listed(require_text),
    "panels": listed(pair(require_text, listed(of_wall))),
    "peaks": shaped(2, "a table of real numbers in rows and columns"),
    "responses": listed(of_wall),
    "title": require_text,
    "until": lambda name, value: require_within(name, value, -1e9, 1e9),
}
"""The check of each argument that means the same in every picture."""


class AxesDrawing(Protocol[P]):
    """A function that draws on an Axes, its first argument or `ax`, or on one of its own, and returns it."""

    @overload
    def __call__(self, ax: Axes, /, *given: P.args, **options: P.kwargs) -> Axes: ...

    @overload
    def __call__(self, *given: P.args, **options: P.kwargs) -> Axes: ...


class PictureDecorator(Protocol):
    """The decorator that `picture` returns."""

    @overload
    def __call__(self, draw: Callable[Concatenate[Axes, P], Axes], /) -> AxesDrawing[P]: ...

    @overload
    def __call__(self, draw: Drawer, /) -> Drawer: ...


def own_axes(about: object) -> Axes:
    """An Axes in a figure of its own, which a notebook shows; of three dimensions for masonry in space and its runs."""
    about = getattr(about, "case", about)
    deep = getattr(getattr(about, "masonry", about), "in_space", False)
    figure = Picture(figsize=(6.4, 4.8) if deep else (5.2, 3.6), layout="constrained")
    ax = figure.add_subplot(projection="3d" if deep else None)
    vars(ax)["_repr_png_"] = figure._repr_png_
    return ax


def picture(**own: Check) -> PictureDecorator:
    """Check the arguments of a function that draws, by `CHECKS` and by those of its own, before anything is drawn.

    One that draws on an Axes makes a figure where it is not given one.
    """

    def decorated(draw: Callable[..., object]) -> Callable[..., object]:
        signature = inspect.signature(draw)
        on_axes = next(iter(signature.parameters)) == "ax"

        @functools.wraps(draw)
        def checked(*arguments: object, ax: Axes | None = None, **options: object) -> object:
            if ax is not None:
                arguments = (ax, *arguments)
            elif on_axes and not (arguments and isinstance(arguments[0], Axes)):
                arguments = (own_axes(next(iter((*arguments, *options.values())), None)), *arguments)
            for name, value in signature.bind(*arguments, **options).arguments.items():
                check = own.get(name) or CHECKS.get(name)
                if check is not None and not (value is None and signature.parameters[name].default is None):
                    check(name, value)
            return draw(*arguments, **options)

        return checked

    return cast(PictureDecorator, decorated)


@picture()
def single(draw: Drawing, size: tuple[float, float] = (5.2, 3.6)) -> Figure:
    """A figure with one Axes, drawn by `draw`."""
    figure = Picture(figsize=size, layout="constrained")
    draw(figure.subplots())
    return figure


@picture()
def panels(drawings: Sequence[tuple[str, Drawing]], columns: int = 2) -> Figure:
    """Several drawings, each on an Axes of its own under its title.

    Drawings in the plane that are to scale, such as those of `blocks`, have one scale and level, and a row of them is
    no higher than they need.
    """
    figure, axes = figure_of_panels(len(drawings), columns, (4.4, 3.4))
    axes_drawn = [draw(ax) for ax, (_, draw) in zip(axes.flat, drawings, strict=False)]
    for ax, (title, _) in zip(axes_drawn, drawings, strict=True):
        ax.set_title(wrapped(title, figure.get_figwidth() / axes.shape[1] - 0.4, 10), fontsize=10)
    to_scale = [ax for ax in axes_drawn if ax.name != "3d" and ax.get_aspect() != "auto"]
    one_scale(to_scale)
    rows = [axes_drawn[i : i + columns] for i in range(0, len(axes_drawn), columns)]
    if any(set(row) <= set(to_scale) for row in rows):
        fit_height(figure, rows)
    return figure


def one_scale(axes: Sequence[Axes]) -> None:
    """Give Axes that are drawn to scale the same limits, unless these would be twice as wide as those of each."""
    for name in "xy":
        limits = np.reshape([getattr(ax, f"get_{name}lim")() for ax in axes], (-1, 2))
        if len(limits) and np.ptp(limits) <= 2 * np.ptp(limits, axis=1).max():
            for ax in axes:
                getattr(ax, f"set_{name}lim")(limits.min(), limits.max())


def fit_height(figure: Figure, rows: Sequence[Sequence[Axes]]) -> None:
    """Make a figure only as high as what its rows of Axes show, as drawings to scale may be lower than their place."""
    figure.draw_without_rendering()
    boxes = [Bbox.union([box for ax in row if (box := ax.get_tightbbox())]) for row in rows]
    needed = sum(box.height / figure.dpi + BETWEEN for box in boxes)
    if needed < LOWER * figure.get_figheight():
        figure.set_figheight(needed)
        spec = rows[0][0].get_subplotspec()
        assert spec is not None
        spec.get_gridspec().set_height_ratios([max(ax.bbox.height for ax in row) for row in rows])
