"""Effects that a case may carry: ties, dampers, thrusts, loads, added masses, and a side stop up to a height.

Heights are measured from the base. Offsets are measured from the middle of the base, positive outwards, away from the
side stop. A wall of many blocks names the block that an effect belongs to; a single wall is block 0. On masonry in
space an effect acts at a point, `at`, in place of a height.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Literal, TypeVar

from ...notebook import NotebookPicture
from ...quantities import Within, keep, keep_declared, named, require_kind, require_sequence, short_repr
from ..ground.motion import GroundMotion
from .effect import (
    HIGHEST_WALL,
    IN_SPACE,
    OF_MASONRY,
    Anchored,
    Effect,
    Height,
    LinkLaw,
    OfBlock,
    Point,
    PointOf,
    place_or_none,
)
from .own_link import Link
from .tie import Tie


@dataclass(frozen=True, repr=False)
class Damper(Anchored):
    """A linear viscous damper that runs horizontally from the inner face to an anchor behind the wall.

    It resists in both directions with c times the rate of its length. A wall at rest does not feel it.

    Args:
        height: where it holds the wall [m], 0 to 200.
        c: damping coefficient [N s/m], 0 to 1e9.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        block: the block that it holds.
        at: of masonry, the point that it holds, x, z or x, y, z at rest [m]; it takes the place of the height.
        anchor: of masonry, its other end at rest [m]. None is `length` behind the point.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> damper = mr.Damper(height=4.0, c=2e4)
        >>> mr.Case(wall, 0.0, 1.0, effects=(damper,)).effects[0].c
        20000.0
    """

    label: ClassVar[str] = "damper"
    arguments: ClassVar[str] = "height, c, length"
    colour: ClassVar[str] = "#3f8f5b"
    dashes: ClassVar[Literal["-", "--", "-."]] = "-."
    height: Height = None  # type: ignore[assignment]
    c: Annotated[float, Within(0, 1e9, "N s/m", "coefficient c of the damper")] = None  # type: ignore[assignment]
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: OfBlock | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    @property
    def law(self) -> LinkLaw:
        """A dashpot."""
        return LinkLaw(c=self.c)

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"z = {self.height:g} m, c = {self.c / 1e3:g} kN s/m"


@dataclass(frozen=True, repr=False)
class FrictionDamper(Anchored):
    """A friction damper that runs horizontally from the inner face to an anchor behind the wall.

    It is a spring with a slider: its force is that of the spring up to the slip force, at which it slips, in either
    direction. A cycle of the amplitude d takes 4 F (d - F/k) from the wall, with F the slip force and k the stiffness.
    It is put in when the wall stands, so that it bears nothing at rest.

    Args:
        height: where it holds the wall [m], 0 to 200.
        stiffness: of the spring [N/m], 1 to 1e12.
        slip_force: force at which it slips [N], 1e-3 to 1e9.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        block: the block that it holds.
        at: of masonry, the point that it holds, x, z or x, y, z at rest [m]; it takes the place of the height.
        anchor: of masonry, its other end at rest [m]. None is `length` behind the point.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.

    Raises:
        ValueError: for a value outside its range.
    """

    label: ClassVar[str] = "friction_damper"
    arguments: ClassVar[str] = "height, stiffness,\nslip_force, length"
    colour: ClassVar[str] = "#8a4f9e"
    dashes: ClassVar[Literal["-", "--", "-."]] = "--"
    limit: ClassVar[str] = "slip_force"
    height: Height = None  # type: ignore[assignment]
    stiffness: Annotated[float, Within(1, 1e12, "N/m")] = None  # type: ignore[assignment]
    slip_force: Annotated[float, Within(1e-3, 1e9, "N")] = None  # type: ignore[assignment]
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: OfBlock | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    @property
    def law(self) -> LinkLaw:
        """A spring that yields in both directions."""
        return LinkLaw(self.stiffness, self.span, self.slip_force, push=self.slip_force)

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        text = f"z = {self.height:g} m,\nk = {self.stiffness / 1e6:.4g} kN/mm"
        return f"{text}, slips at {self.slip_force / 1e3:g} kN"


@dataclass(frozen=True, repr=False)
class Thrust(Effect):
    """A horizontal force that keeps its size and direction: the thrust of an arch, a vault or a rafter.

    Args:
        height: where it acts, on the middle of the wall [m], 0 to 200.
        force: its size on the whole length of the wall, positive outwards [N], -1e9 to 1e9.
        block: the block that it pushes.
        at: of masonry, the point where it acts, x, z or x, y, z at rest [m]; it takes the place of the height.
        direction: in space, the direction of the force, a vector of any length; None is x, out of the facade.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> push = mr.Thrust(height=4.0, force=2e3)
        >>> mr.Case(wall, 0.0, 1.0, effects=(push,)).effects[0].force
        2000.0
    """

    label: ClassVar[str] = "thrust"
    arguments: ClassVar[str] = "height, force"
    height: Height = None  # type: ignore[assignment]
    force: Annotated[float, Within(-1e9, 1e9, "N")] = None  # type: ignore[assignment]
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    direction: Point | None = field(default=None, kw_only=True, metadata=IN_SPACE)

    def __post_init__(self) -> None:
        if (vector := place_or_none("direction of the thrust", self.direction, least=3)) is not None:
            length = math.hypot(*vector)
            if not length > 1e-9:
                name = f"direction of the thrust = {vector}"
                raise ValueError(f"{name} has no length; valid vectors are longer than 1e-9")
            keep(self, direction=(vector[0] / length, vector[1] / length, vector[2] / length))
        super().__post_init__()

    @property
    def force_vector(self) -> Point:
        """Along its direction."""
        if self.direction is None:
            return self.force, 0.0, 0.0
        x, y, z = self.direction
        return self.force * x, self.force * y, self.force * z

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"z = {self.height:g} m, {self.force / 1e3:g} kN outwards"


@dataclass(frozen=True, repr=False)
class Load(Effect):
    """A vertical force on the wall that has weight but no mass of its own here: a floor or roof that rests on it.

    Args:
        force: its size on the whole length of the wall, downwards [N], 0 to 1e9.
        height: where it acts [m], 0 to 200.
        offset: from the middle of the base, outwards [m], -10 to 10.
        block: the block that it rests on.
        at: of masonry, the point where it acts, x, z or x, y, z at rest [m]; it takes the place of height and offset.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> roof = mr.Load(force=5e3, height=4.2, offset=0.1)
        >>> mr.Case(wall, 0.0, 1.0, effects=(roof,)).effects[0].force
        5000.0
    """

    label: ClassVar[str] = "load"
    arguments: ClassVar[str] = "force, height, offset"
    force: Annotated[float, Within(0, 1e9, "N")]
    height: Height = None  # type: ignore[assignment]
    offset: Annotated[float, Within(-10, 10, "m")] = 0.0
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    @property
    def force_vector(self) -> Point:
        """Downwards."""
        return 0.0, 0.0, -self.force

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"z = {self.height:g} m, x = {self.offset:g} m,\n{self.force / 1e3:g} kN downwards"


@dataclass(frozen=True, repr=False)
class AddedMass(Effect):
    """A mass that moves with the wall: a cornice, a balcony, a roof that is fixed to it.

    Args:
        mass: the mass, as a point [kg], 0 to 1e8.
        height: where it is [m], 0 to 200.
        offset: from the middle of the base, outwards [m], -13 to 13.
        block: the block that it moves with.
        at: of masonry, where it is, x, z or x, y, z at rest [m]; it takes the place of height and offset.

    Raises:
        ValueError: for a value outside its range.
    """

    label: ClassVar[str] = "mass"
    called: ClassVar[str] = "added mass"
    arguments: ClassVar[str] = "mass, height, offset"
    on_block: ClassVar[bool] = False
    mass: Annotated[float, Within(0, 1e8, "kg", "added mass")]
    height: Height = None  # type: ignore[assignment]
    offset: Annotated[float, Within(-13, 13, "m")] = 0.0
    block: OfBlock = 0
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)

    @property
    def mass_added(self) -> float:
        """The mass."""
        return self.mass

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        return f"z = {self.height:.4g} m, x = {self.offset:.4g} m, {self.mass:.4g} kg"


@dataclass(frozen=True)
class SideStop:
    """A stop behind the inner face that reaches from the base up to a height, as side walls do.

    Args:
        top: the height that it reaches [m], 0.01 to 200, and at most that of the wall.

    Raises:
        ValueError: for a value outside its range.
    """

    top: Annotated[float, Within(0.01, HIGHEST_WALL, "m")]

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self, "side stop")


EFFECT_KINDS = (Tie, Load, Thrust, Damper, FrictionDamper, Link, AddedMass)
"""The kinds of effects, in the order in which scenes, pictures and reports name them."""
Kind = TypeVar("Kind", bound=Effect)


def required_effects(name: str, values: Any, kinds: tuple[type[Kind], ...], takes: str = "") -> tuple[Kind, ...]:
    """Effects of some kinds, or a single one, as a tuple.

    Raises:
        TypeError: for any other, with their name and the kinds that they may have.
    """
    effects = (values,) if isinstance(values, kinds) else values
    require_sequence(name, effects, takes or f"a sequence of {named([kind.__name__ for kind in kinds])}")
    for i, effect in enumerate(effects):
        require_kind(f"{name}[{i}]", effect, *kinds)
    return tuple(effects)


def named_effects(effects: Sequence[Effect]) -> dict[str, Effect]:
    """Effects by name: `tie_0`, `load_0` and so on, each kind in its order."""
    return {
        f"{kind.label}_{i}": effect
        for kind in EFFECT_KINDS
        for i, effect in enumerate(effect for effect in effects if isinstance(effect, kind))
    }


def link_effects(effects: Sequence[Effect]) -> dict[str, Anchored]:
    """The effects that are links, by name."""
    return {name: effect for name, effect in named_effects(effects).items() if isinstance(effect, Anchored)}


def constant_forces_of(effects: Sequence[Effect]) -> dict[str, tuple[Effect, Point]]:
    """The effects that bring a constant force, by name, and the force [N]."""
    named = ((name, effect, effect.force_vector) for name, effect in named_effects(effects).items())
    return {name: (effect, force) for name, effect, force in named if force is not None}


class Carrying(NotebookPicture):
    """What carries effects."""

    effects: tuple[Effect, ...]

    @property
    def grounds(self) -> dict[str, GroundMotion]:
        """The motions of the ground, by name: "motion", "vertical" and "transverse", those that there are."""
        moved = {name: getattr(self, name) for name in ("motion", "vertical", "transverse")}
        return {name: motion for name, motion in moved.items() if motion is not None}

    def each(self, kind: type[Kind]) -> tuple[Kind, ...]:
        """The effects of one kind, in their order."""
        return tuple(effect for effect in self.effects if isinstance(effect, kind))

    @property
    def named(self) -> dict[str, Effect]:
        """The effects by name, see `named_effects`."""
        return named_effects(self.effects)

    @property
    def links(self) -> dict[str, Anchored]:
        """The effects that are links, by name."""
        return link_effects(self.effects)

    @property
    def springs(self) -> dict[str, Anchored]:
        """The links with a spring, by name."""
        return {name: effect for name, effect in self.links.items() if effect.law.k > 0}

    def require_for(self, solver: str) -> None:
        """Raise a ValueError that names an effect which this solver does not take."""
        for i, effect in enumerate(self.effects):
            if effect.only:
                name = f"effects[{i}], {type(effect).__name__}"
                raise ValueError(f"{name}: {solver} does not know it; take {effect.only}")

    def _keep_sequence(self, *further: type[Effect]) -> None:
        """Keep the effects, or a single one, as a tuple. They are of `EFFECT_KINDS` or `further` ones."""
        kinds = (*EFFECT_KINDS, *further)
        effects = (self.effects,) if isinstance(self.effects, kinds) else self.effects
        names = [kind.__name__ for kind in kinds]
        require_sequence("effects", effects, f"a sequence of {', '.join(names[:-1])} or {names[-1]}")
        keep(self, effects=tuple(effects))
