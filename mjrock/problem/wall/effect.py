"""The interface of all effects, so that solvers need not distinguish their kinds.

An effect has a link, a constant force or a mass, or several of them. A scene, the solvers, pictures and reports take
these, and a new effect is a class of its own with one entry in `mjrock.problem.wall.effects.EFFECT_KINDS`.
"""

from __future__ import annotations

import math
from dataclasses import fields
from itertools import accumulate
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from ...compiled import inlined
from ...quantities import (
    Array,
    Within,
    keep,
    keep_declared,
    require_array,
    require_reals,
    require_whole,
    require_within,
    short_repr,
)

Point = tuple[float, float, float]
FARTHEST_POINT = 1e4
"""Largest coordinate of a point [m]."""
PointOf = tuple[Annotated[float, Within(-FARTHEST_POINT, FARTHEST_POINT, "m")], ...]
"""A point x, z of the plane or x, y, z of space [m]."""
HIGHEST_WALL = 200.0
"""Largest height of a wall, and so of an effect [m]."""
Height = Annotated[float, Within(0, HIGHEST_WALL, "m")]
"""Height of an effect on a wall."""
OfBlock = Annotated[int, str]
"""Number of a block. Where an effect is made it may be the name, of which a case of masonry knows the number."""
BLOCKS = 100_000
"""Largest number of a block."""
SHORTER = 1e-9
"""How much shorter than its reach a link may be by rounding and still pull [m]."""
OF_MASONRY, IN_SPACE = {"of": "masonry"}, {"of": "masonry in space"}
"""Metadata of a field of an effect that only masonry takes, and of one that only masonry in space takes."""


def place_or_none(name: str, value: object, least: int = 2) -> PointOf | None:
    """A point as a tuple, or None.

    Raises:
        TypeError, ValueError: with the name, unless it is two or three numbers, at least `least`, within -10000 to
            10000 m.
    """
    if value is None:
        return None
    point = require_reals(name, value, "x, z or x, y, z")
    count = 2 if point.shape == (2,) and least == 2 else 3
    return tuple(
        require_within(name, each, -FARTHEST_POINT, FARTHEST_POINT, "m")
        for each in require_array(name, point, (count,))
    )


def _block(name: str, given: object) -> str | int:
    """A block as it is named, of which a case of masonry knows the number, or its number."""
    return given if isinstance(given, str) else require_whole(name, given, 0, BLOCKS)


def _height(kind: str, height: float | None, at: PointOf) -> float:
    """The height of an effect with a point, that of the point [m]."""
    if (
        height is not None
        and require_within(f"height of the {kind}", height, -FARTHEST_POINT, FARTHEST_POINT, "m") != at[-1]
    ):
        raise ValueError(f"height of the {kind} = {height} m is given with at = {at} m; leave it out")
    return at[-1]


def require_only(name: str, effect: Any, *kinds: str) -> None:
    """Raise a ValueError that names the field, if an effect has one that is for none of these kinds of problem."""
    for entry in fields(effect):
        given, of = getattr(effect, entry.name), entry.metadata.get("of")
        if given is not None and of is not None and of not in kinds:
            raise ValueError(f"{name}, {entry.name} = {given} is for {of}; leave it out, and give height")


class LinkLaw(NamedTuple):
    """The law of a link between a point and an anchor: its force from its length and the rate of its length.

    A spring with a slider, and a dashpot beside it. The spring pulls from the length `reach` on. Beyond `strength` the
    slider moves, and the link yields. Below `reach` the link is slack, or pushes up to the force `push` and yields
    then.

    Args:
        k: stiffness of the spring [N/m], zero for none.
        reach: length up to which it is slack, or at which it bears nothing [m]; infinite without a spring.
        strength: force at which it yields as it gets longer [N], infinite for one that does not.
        push: force at which it yields as it gets shorter [N], zero for one that only pulls.
        ultimate: plastic elongation at which it breaks [m], infinite for one that never does.
        c: damping coefficient [N s/m], zero for none.
    """

    k: float = 0.0
    reach: float = math.inf
    strength: float = math.inf
    push: float = 0.0
    ultimate: float = math.inf
    c: float = 0.0

    @property
    def yields(self) -> bool:
        """Whether a force is known at which it yields."""
        return self.strength < math.inf

    @property
    def damps(self) -> bool:
        """Whether it has a dashpot."""
        return bool(resistance(self, 1.0) > 0)

    @property
    def holds(self) -> bool:
        """Whether it may hold what stands: it has a spring that pulls at rest. One that pushes too bears nothing
        there."""
        return self.k > 0 and self.push == 0

    def pulls_at(self, length: float) -> float:
        """The largest force that its spring bears at a length [N]: none where it is slack or has broken."""
        beyond = length - self.reach
        broken = self.strength < math.inf and beyond > self.strength / self.k + self.ultimate
        return 0.0 if broken or beyond < -SHORTER else self.strength

    def plastic_elongation(self, elongation: Array, before: float = 0.0) -> Array:
        """How far the slider has moved along elongations beyond the slack [m], shape (n,), if nothing breaks, from
        where it was before [m]."""
        stretch, squeeze = self.strength / self.k, self.push / self.k
        if squeeze == 0:
            return np.maximum.accumulate(np.maximum(elongation - stretch, before))
        slid = accumulate(
            elongation.tolist(), lambda at, length: min(max(at, length - stretch), length + squeeze), initial=before
        )
        return np.array(list(slid)[1:])


DASHPOT = ("c",)
"""The numbers of a `LinkLaw` that `resistance` reads."""


@inlined
def resistance(law: LinkLaw, rate: float) -> float:
    """Force with which the dashpot of a link, or of a row, resists the rate of its length [N], for all solvers."""
    return law.c * rate


def damping_coefficient(law: Any) -> Any:
    """How fast the force of the dashpot of a link, or of many rows, grows at most with the rate of its length up to
    1 m/s [N s/m]. The longest stable step is that of a linear dashpot with this coefficient."""
    return law.c


class ReportItem(Protocol):
    """What sketch and report show: an effect, or what several effects stand for.

    Attributes:
        label: its name.
        arguments: names of its arguments as they stand in a sketch.
    """

    label: ClassVar[str]
    arguments: ClassVar[str]

    @property
    def description(self) -> str:
        """Where it is and what it does."""


class Effect:
    """An effect: where it acts, and what it brings.

    Attributes:
        label: its name, to which its number among those of its kind is added.
        called: its kind in messages; the words of the label where it is empty.
        arguments: names of its arguments as they stand in a sketch.
        on_face: whether it holds the inner face. Otherwise it acts at `offset` from the middle of base or block.
        on_block: whether its point has to lie on its block.
        offset: from there, outwards [m].
        only: what may take it, "solve_explicit", or empty where all solvers do.
    """

    label: ClassVar[str]
    called: ClassVar[str] = ""
    arguments: ClassVar[str]
    only: ClassVar[str] = ""
    on_face: ClassVar[bool] = False
    on_block: ClassVar[bool] = True
    height: float
    block: int
    at: PointOf | None
    offset: float = 0.0

    __repr__ = short_repr

    def __post_init__(self) -> None:
        """Check and keep its block, its height or point, its anchor, and the numbers that declare a range.

        Raises:
            TypeError, ValueError: with the name and the kind of effect, for what is not a number or point, or out of
                range.
        """
        kind, anchor_block = self.called or self.label.replace("_", " "), getattr(self, "anchor_block", None)
        for name in ("at", "anchor"):
            if hasattr(self, name):
                keep(self, **{name: place_or_none(f"{name} of the {kind}", getattr(self, name))})
        if self.at is None and (anchor := getattr(self, "anchor", None)) is not None:
            raise ValueError(f"anchor of the {kind} = {anchor} m goes with at, the point that is held; give it too")
        if anchor_block is not None:
            keep(self, anchor_block=_block(f"anchor_block of the {kind}", anchor_block))
        if self.at is not None:
            keep(self, height=_height(kind, self.height, self.at))
        keep(self, block=_block(f"block of the {kind}", self.block))
        keep_declared(self, kind, but=() if self.at is None else ("height",))

    @property
    def mass_added(self) -> float:
        """The mass that it brings [kg]."""
        return 0.0

    @property
    def force_vector(self) -> Point | None:
        """The constant force that it brings, along x, y and z [N], or None."""
        return None

    @property
    def description(self) -> str:
        """Where it is and what it does, for sketch and report."""
        raise NotImplementedError

    @property
    def report_item(self) -> ReportItem | None:
        """What sketch and report show in its place: itself, or None where they show it already."""
        return self

    @property
    def outline(self) -> Array:
        """Corners of its outline in the section, x from the middle of the base and z [m], shape (n, 2); (0, 2) of what
        is at a point."""
        return np.empty((0, 2))


class CombinedEffect:
    """What acts as several effects that follow from the wall, such as a `Wedge` of its side walls."""

    def on(self, wall: Any) -> tuple[Effect, ...]:
        """The effects of a wall."""
        raise NotImplementedError


class Anchored(Effect):
    """An effect that is a link, from the point that it holds to its anchor.

    Attributes:
        colour, dashes: how its line is drawn, in the ways of matplotlib.
        limit: name of its argument that is the force at which it yields.
        user_law: its law where that is one of a user, see `own_link`.
        length: distance from the inner face to the anchor [m].
        anchor: of masonry, the anchor at rest [m]; None is `length` behind the point.
        anchor_block: of masonry, the block that it moves with; None is the ground.
    """

    on_face = True
    colour: ClassVar[str] = "#12406b"
    dashes: ClassVar[Literal["-", "--", "-."]] = "-"
    limit: ClassVar[str] = "strength"
    user_law: Any = None
    length: float
    anchor: PointOf | None
    anchor_block: int | None

    @property
    def law(self) -> LinkLaw:
        """Its force."""
        raise NotImplementedError

    @property
    def rise(self) -> float:
        """How much higher the anchor is than the point that is held [m]."""
        return 0.0

    @property
    def span(self) -> float:
        """Distance from the point that is held to the anchor at rest [m]."""
        if self.at is not None and self.anchor is not None:
            return math.dist(self.at, self.anchor)
        return math.hypot(self.length, self.rise)

    def anchor_of(self, held: Array) -> Array:
        """The anchor at rest [m] from the point that is held, in the plane or in space, shape (2,) or (3,)."""
        if self.anchor is not None:
            return np.array(self.anchor)
        behind = np.zeros(len(held))
        behind[0], behind[-1] = -self.length, self.rise
        return np.asarray(held + behind)
