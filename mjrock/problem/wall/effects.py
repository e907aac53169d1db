"""Effects that a case may carry: ties, thrusts, loads, added masses, and a side stop that reaches only so high.

Heights are measured from the base. Offsets are measured from the middle of the base, positive outwards, away from the
side stop. A wall of many blocks names the block that an effect belongs to; a single wall is block 0. On masonry in
space an effect acts at a point, `at`, in place of a height.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from ...quantities import keep, require_real, require_within, shown
from .damper import Damper
from .in_space import HIGHEST, LATER, Point, keep_place, point_or_none, written


@dataclass(frozen=True)
class Tie:
    """A tie that holds the inner face of the wall back: it pulls, never pushes, yields plastically, and may break.

    The tie runs horizontally from the inner face to an anchor behind the wall, unless `anchor_height` says otherwise.
    Its force is min(strength, stiffness times elongation), the elongation beyond the slack and beyond what has yielded.
    A tie that has yielded by `ultimate` breaks: it pulls no more, and its elastic energy is lost.

    Args:
        height: where it holds the wall [m].
        stiffness: E A over its length [N/m], 1 to 1e12.
        slack: elongation before it pulls [m], 0 to 10.
        strength: force at which it yields [N], above 0; infinite for one that does not.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        anchor_height: height of the anchor [m]; None is that of the tie.
        block: the block that it holds.
        ultimate: plastic elongation at which it breaks [m], 0 to 10, such as the slip at which an anchor plate is
            pulled through; 0 for one that breaks as it begins to yield. None never breaks.
        at: in space, the point that it holds, x, y, z at rest [m]; it takes the place of the height.
        anchor: in space, its other end at rest [m]. None is `length` behind the point, as in the plane.
        anchor_block: in space, the block that the other end is fixed to and moves with; None is the ground.

    Raises:
        ValueError: for a value outside its range, or an `ultimate` without a finite strength.
    """

    height: float = None  # type: ignore[assignment]
    stiffness: float = None  # type: ignore[assignment]
    slack: float = 0.0
    strength: float = math.inf
    length: float = 5.0
    anchor_height: float | None = None
    block: int = 0
    ultimate: float | None = None
    at: Point | None = field(default=None, kw_only=True, metadata=LATER)
    anchor: Point | None = field(default=None, kw_only=True, metadata=LATER)
    anchor_block: int | None = field(default=None, kw_only=True, metadata=LATER)

    __repr__ = written

    def __post_init__(self) -> None:
        keep_place(self, "tie")
        keep(
            self,
            stiffness=require_within("stiffness of the tie", self.stiffness, 1.0, 1e12, "N/m"),
            slack=require_within("slack of the tie", self.slack, 0.0, 10.0, "m"),
            strength=require_real("strength of the tie", self.strength),
            length=require_within("length of the tie", self.length, 0.01, 1000.0, "m"),
        )
        if not self.strength > 0:
            raise ValueError(
                f"strength of the tie = {self.strength:g} N is outside the valid range, which is above 0 N"
            )
        if self.anchor_height is not None:
            anchored = require_within("height of the anchor", self.anchor_height, -HIGHEST, HIGHEST, "m")
            keep(self, anchor_height=anchored)
        if self.ultimate is not None:
            keep(self, ultimate=require_within("ultimate of the tie", self.ultimate, 0.0, 10.0, "m"))
            if self.strength == math.inf:
                raise ValueError(
                    f"ultimate of the tie = {self.ultimate:g} m, and its strength is infinite: it does not yield and "
                    "never breaks; give it a strength [N], or leave ultimate out"
                )

    @property
    def rise(self) -> float:
        """How much higher the anchor is than the point that is held [m]."""
        return 0.0 if self.anchor_height is None else self.anchor_height - self.height

    @property
    def reach(self) -> float:
        """Length up to which the tie is slack [m]."""
        if self.at is not None and self.anchor is not None:
            return math.dist(self.at, self.anchor) + self.slack
        return math.hypot(self.length, self.rise) + self.slack

    @property
    def stretch(self) -> float:
        """Elastic elongation at which it yields [m]."""
        return self.strength / self.stiffness

    @property
    def breaks_at(self) -> float:
        """Plastic elongation at which it breaks [m], infinite for one that never does."""
        return math.inf if self.ultimate is None else self.ultimate


@dataclass(frozen=True)
class Thrust:
    """A horizontal force that keeps its size and direction: the thrust of an arch, a vault or a rafter.

    Args:
        height: where it acts, on the middle of the wall [m].
        force: its size on the whole length of the wall, positive outwards [N], -1e9 to 1e9.
        block: the block that it pushes.
        at: in space, the point where it acts, x, y, z at rest [m]; it takes the place of the height.
        direction: in space, the direction of the force, a vector of any length; None is x, out of the facade.

    Raises:
        ValueError: for a value outside its range.
    """

    height: float = None  # type: ignore[assignment]
    force: float = None  # type: ignore[assignment]
    block: int = 0
    at: Point | None = field(default=None, kw_only=True, metadata=LATER)
    direction: Point | None = field(default=None, kw_only=True, metadata=LATER)

    __repr__ = written

    def __post_init__(self) -> None:
        if (given := point_or_none("direction of the thrust", self.direction)) is not None:
            length = math.hypot(*given)
            if not length > 1e-9:
                name = f"direction of the thrust = {given}"
                raise ValueError(f"{name} has no length; the valid range are vectors longer than 1e-9")
            keep(self, direction=(given[0] / length, given[1] / length, given[2] / length))
        keep_place(self, "thrust")
        keep(self, force=require_within("force of the thrust", self.force, -1e9, 1e9, "N"))


@dataclass(frozen=True)
class Load:
    """A vertical force on the wall that has weight but no mass of its own here: a floor or roof that rests on it.

    Args:
        force: its size on the whole length of the wall, downwards [N], 0 to 1e9.
        height: where it acts [m].
        offset: from the middle of the base, outwards [m], -10 to 10.
        block: the block that it rests on.
        at: in space, the point where it acts, x, y, z at rest [m]; it takes the place of height and offset.

    Raises:
        ValueError: for a value outside its range.
    """

    force: float
    height: float = None  # type: ignore[assignment]
    offset: float = 0.0
    block: int = 0
    at: Point | None = field(default=None, kw_only=True, metadata=LATER)

    __repr__ = written

    def __post_init__(self) -> None:
        keep_place(self, "load")
        keep(
            self,
            force=require_within("force of the load", self.force, 0.0, 1e9, "N"),
            offset=require_within("offset of the load", self.offset, -10.0, 10.0, "m"),
        )


@dataclass(frozen=True)
class AddedMass:
    """A mass that moves with the wall: a cornice, a balcony, a roof that is fixed to it.

    Args:
        mass: the mass, as a point [kg], 0 to 1e8.
        height: where it is [m].
        offset: from the middle of the base, outwards [m], -13 to 13.
        block: the block that it moves with.
        at: in space, where it is, x, y, z at rest [m]; it takes the place of height and offset.

    Raises:
        ValueError: for a value outside its range.
    """

    mass: float
    height: float = None  # type: ignore[assignment]
    offset: float = 0.0
    block: int = 0
    at: Point | None = field(default=None, kw_only=True, metadata=LATER)

    __repr__ = written

    def __post_init__(self) -> None:
        keep_place(self, "added mass")
        keep(
            self,
            mass=require_within("added mass", self.mass, 0.0, 1e8, "kg"),
            offset=require_within("offset of the added mass", self.offset, -13.0, 13.0, "m"),
        )


@dataclass(frozen=True)
class SideStop:
    """A stop behind the inner face that reaches from the base up to a height, as side walls do.

    Args:
        top: the height that it reaches [m], 0.01 to the height of the wall.

    Raises:
        ValueError: for a value outside its range.
    """

    top: float

    __repr__ = written

    def __post_init__(self) -> None:
        keep(self, top=require_within("top of the side stop", self.top, 0.01, HIGHEST, "m"))


Effect = Tie | Thrust | Load | AddedMass | Damper
"""What `Case.effects` may hold."""
KINDS = (Tie, Thrust, Load, AddedMass, Damper)
"""The same, as classes."""
Kind = TypeVar("Kind", Tie, Thrust, Load, AddedMass, Damper)


class Carrying:
    """What carries effects."""

    effects: tuple[Effect, ...]

    def each(self, kind: type[Kind]) -> tuple[Kind, ...]:
        """The effects of one kind, in their order."""
        return tuple(effect for effect in self.effects if isinstance(effect, kind))

    def _keep_sequence(self) -> None:
        """Keep the effects, or a single one, as a tuple."""
        given = (self.effects,) if isinstance(self.effects, KINDS) else self.effects
        if not isinstance(given, Sequence) or isinstance(given, str):
            raise TypeError(f"effects = {shown(self.effects)} is no sequence of Tie, Thrust, Load, AddedMass or Damper")
        keep(self, effects=tuple(given))
