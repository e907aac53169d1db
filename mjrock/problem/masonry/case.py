"""The problem of masonry that stands, and is shaken or set moving."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import (
    GRAVITY,
    Array,
    Flags,
    Implausible,
    Within,
    keep,
    keep_declared,
    require_array,
    require_flag,
    require_kind,
    require_whole,
    require_within,
    warn_of,
)
from ..ground.motion import GroundMotion
from ..wall.case import Case
from ..wall.effect import Anchored, Effect, require_only
from ..wall.effects import EFFECT_KINDS, Carrying, Load
from ..wall.plausibility import LARGEST_PEAK_IN_G, NEGLIGIBLE_SHARE, HeldSize, Subject, effect_doubts, record_doubts
from .actuator import Actuator
from .blocks.joints import Joint
from .blocks.joints_in_space import SpaceJoint
from .effects import (
    place_in_world,
    point_of_effect,
    require_anchored,
    require_placed,
    require_pushing,
    with_added_masses,
    with_block_numbers,
)
from .histories import OfSupports, Support, Tilt, supports_of, tilt_history
from .laws.bond import Bond
from .laws.own_law import Own
from .limit.collapse import LimitLoads, limit_of, pushed
from .masonry import Masonry
from .rest_geometry import MasonryRestGeometry

JUDGED_BLOCKS = 40
"""Most free blocks of which the acceleration that they stand is looked for to judge a record: a second of time."""
SPRING_FORCE_OVER_WEIGHT = 3.0
"""Force of an actuator at its full displacement over the weight, up to which its spring may be a force that is given,
and the displacement no motion [-]."""


def doubts(case: MasonryCase) -> list[str]:
    """What is odd about a case, in words; empty for a plausible one. For a wall see `problem.wall.plausibility`."""
    masonry = case.masonry
    mass = sum(masonry.blocks[i].mass for i in masonry.free)
    messages = record_doubts(case.motion, case.duration, "masonry", sustained_acceleration(case))
    messages += effect_doubts(
        case.effects, Subject("masonry", "its block", mass), lambda link: _size_along(masonry, link)
    )
    return messages + [
        doubt for name, jack in case.actuators.items() if (doubt := _doubt_of(name, jack, masonry, mass))
    ]


def sustained_acceleration(case: MasonryCase) -> float:
    """Acceleration over g that the masonry of a case stands from rest, for a record that may be in g, or infinity."""
    weak = case.motion is not None and case.motion.peak <= LARGEST_PEAK_IN_G and len(case.masonry.free) <= JUDGED_BLOCKS
    at_rest = case.velocity is None and case.vertical is None and not case.effects
    return _multiplier(case.masonry) if weak and at_rest else math.inf


@lru_cache(maxsize=16)
def _multiplier(masonry: Masonry) -> float:
    senses = np.eye(masonry.freedom.translations)[0] * [[1.0], [-1.0]]
    try:
        return min(limit_of(masonry, LimitLoads(sense, pushed(masonry, sense))).multiplier for sense in senses)
    except ValueError:  # it cannot stand, which the solvers say
        return math.inf


def _size_along(masonry: Masonry, link: Anchored) -> HeldSize:
    """Largest extent of the block that a link holds, and of all free blocks along the link [m]."""
    point = np.zeros(2) if link.at is None else point_of_effect(link)
    direction = point - link.anchor_of(point)
    return HeldSize(2 * masonry.blocks[link.block].size, _extent(masonry, direction / np.linalg.norm(direction)))


def _extent(masonry: Masonry, direction: Array) -> float:
    """Extent of all free blocks along a unit vector [m]."""
    return float(np.ptp(np.concatenate([masonry.blocks[i].corners for i in masonry.free]) @ direction))


def _doubt_of(name: str, jack: Actuator, masonry: Masonry, mass: float) -> str:
    """A doubt about an actuator, empty where there is none."""
    largest, extent = max(map(abs, jack.displacement[1])), _extent(masonry, np.array(jack.direction))
    if largest > extent and jack.stiffness * largest > SPRING_FORCE_OVER_WEIGHT * mass * GRAVITY:
        return f"{name}: displacement reaches {largest:g} m, and the masonry is {extent:.3g} m long there: is it in mm?"
    if 0 < jack.stiffness * largest < NEGLIGIBLE_SHARE * mass * GRAVITY:
        return (
            f"{name}: stiffness = {jack.stiffness:g} N/m pushes with at most {jack.stiffness * largest:.3g} N, and the "
            f"masonry weighs {mass * GRAVITY:.3g} N: is it in N/m?"
        )
    return ""


FASTEST = 1e3
"""Largest velocity at the release [m/s, rad/s]."""
REMOVED_BY_GUIDE = 1e-3
"""Largest speed that the guide of an actuator takes from a block at a start, over sqrt(g size) [-]."""
EQUAL_FIELDS = ("masonry", "duration", "motion", "vertical", "transverse", "effects", "supports", "settled", "tilt")
"""What two equal cases share, beside the velocity."""


@dataclass(frozen=True, eq=False)
class MasonryCase(Carrying):
    """Masonry, at rest under its weight or as it is drawn, and what moves it.

    Args:
        masonry: the blocks and their joints.
        duration: how long to follow the motion [s], 1e-6 to 1e6.
        motion: horizontal acceleration of the ground and of all fixed blocks, or None. A positive one pushes the blocks
            to the left. Responses are motions as seen from the ground.
        vertical: the same, vertical. A positive one is upwards and presses the blocks on their joints.
        effects: ties, loads, thrusts, added masses, dampers and actuators. Each says which `block` it belongs to, by
            its name or its number in `masonry.blocks`. Heights are z; offsets are measured from the centroid of the
            block. A tie holds the left end of its block at its height. In space each acts at a point, `at`.
        velocity: velocity of each block that is not fixed at the release: x, z and rotation [m/s, m/s, rad/s], shape
            (bodies, 3), each within -1000 to 1000. None is rest. The rotation is positive where the top of a block
            turns to the right. In space x, y, z and the angular velocity about the three axes, shape (bodies, 6). A
            block that an actuator guides has none that its guide does not allow.
        supports: displacement histories of fixed blocks, by name, (t, dx, dz) in s and m, in space (t, dx, dy, dz), for
            `solve_explicit`.
        transverse: in space, the acceleration of the ground along y, or None; `motion` is that along x.
        settled: whether the masonry starts at rest under its weight. False starts it as drawn, with springs that are
            not stretched and without friction, whether or not it stands.
        tilt: (t, angle) of a table on which the masonry stands, in s and rad, in space about y. A positive angle lets
            the blocks slide and turn towards +x. It is linear in between and constant after the last. The motion is
            seen from the table, and what the table puts in is in `ledger.ground`.

    Raises:
        ValueError: for a value outside its range, velocities of another shape, an effect that is not on its block, or
            a support that is not a fixed block of the masonry.

    Warns:
        Implausible: for values that can be and are most often in another unit, see `mjrock.problem.wall.plausibility`.
    """

    stop_top: ClassVar[None] = None
    is_still: ClassVar[bool] = False
    rocks_on_moving_ground: ClassVar[bool] = False

    masonry: Masonry
    duration: Annotated[float, Within(1e-6, 1e6, "s")] = 10.0
    motion: GroundMotion | None = None
    vertical: GroundMotion | None = None
    velocity: Annotated[Array | ArrayLike | None, Within(-FASTEST, FASTEST, "m/s, m/s, rad/s")] = None
    effects: tuple[Effect, ...] = ()
    supports: Annotated[Any, OfSupports] = ()
    transverse: GroundMotion | None = field(default=None, kw_only=True)
    settled: bool = field(default=True, kw_only=True)
    tilt: Annotated[Any, Tilt] = field(default=None, kw_only=True)

    def __repr__(self) -> str:
        parts = [f"{self.duration:.6g} s", *(f"{name} {motion.name!r}" for name, motion in self.grounds.items())]
        optional = {name: getattr(self, name) for name in ("velocity", "supports", "tilt")}
        parts += [name for name, value in optional.items() if value is not None and len(value)]
        parts += [type(effect).__name__ for effect in self.effects]
        return f"<MasonryCase of {self.masonry!r}: {', '.join(parts)}{'' if self.settled else ', as drawn'}>"

    def __post_init__(self) -> None:
        require_kind("masonry", self.masonry, Masonry)
        keep_declared(self)
        for name in ("motion", "vertical", "transverse"):
            require_kind(name, getattr(self, name), GroundMotion, type(None))
        require_flag("settled", self.settled)
        if self.transverse is not None and not self.masonry.in_space:
            raise ValueError(
                "transverse is for masonry in space; blocks in the plane are shaken by motion and vertical"
            )
        keep(self, tilt=tilt_history(self.tilt))
        if self.tilt is not None and (self.motion is not None or self.vertical is not None):
            raise ValueError("tilt does not go with motion and vertical: a table either tilts or shakes; leave one out")
        if self.velocity is not None:
            velocity = require_array("velocity", self.velocity, (len(self.masonry.free), self.masonry.freedom.nv))
            velocity.setflags(write=False)
            keep(self, velocity=velocity)
        self._require_effects()
        if self.velocity is not None:
            self.require_guided("velocity", np.asarray(self.velocity))
        keep(self, supports=supports_of(self.masonry, self.supports))
        for doubt in doubts(self):
            warn_of(doubt, Implausible)

    def _require_effects(self) -> None:
        """Check that each effect is on a block that is not fixed, and keep them as a tuple."""
        self._keep_sequence(Actuator)
        numbers: list[Effect] = []
        for i, effect in enumerate(self.effects):
            if not (isinstance(effect, Effect) and effect.only):
                require_kind(f"effects[{i}]", effect, *EFFECT_KINDS, Actuator)
            effect = with_block_numbers(f"effects[{i}]", effect, self.masonry)
            numbers.append(effect)
            if effect.block is None:
                require_pushing(f"effects[{i}]", effect, self.masonry)
                continue
            require_whole(f"effects[{i}], block", effect.block, 0, len(self.masonry.blocks) - 1)
            block = self.masonry.blocks[effect.block]
            name = f"effects[{i}] on {self.masonry.names[effect.block]}"
            if block.fixed:
                raise ValueError(f"{name}: this block is fixed; the valid ones are {list(self.masonry.free)}")
            if isinstance(effect, Actuator):
                require_pushing(name, effect, self.masonry)
                continue
            require_only(name, effect, "masonry", *["masonry in space"] * self.masonry.in_space)
            if self.masonry.in_space or effect.at is not None:
                require_placed(name, effect, self.masonry)
                continue
            require_anchored(name, effect, self.masonry)
            low, high = block.corners.min(axis=0) - 1e-9, block.corners.max(axis=0) + 1e-9
            require_within(f"{name}, height", effect.height, float(low[1]), float(high[1]), "m")
            if isinstance(effect, Load):
                middle = float(block.centroid[0])
                require_within(f"{name}, offset", effect.offset, float(low[0]) - middle, float(high[0]) - middle, "m")
        keep(self, effects=tuple(numbers))

    @property
    def joints(self) -> tuple[Joint | SpaceJoint, ...]:
        """The joints of the masonry."""
        return self.masonry.joints

    @property
    def bonds(self) -> tuple[Bond | Own | None, ...]:
        """The bond of each joint, None where it is dry."""
        return self.masonry.bonds

    def require_dry(self, what: str) -> None:
        """Raise a ValueError that says what takes dry joints, where some have a bond."""
        self.masonry.require_dry(what)

    @property
    def built(self) -> Masonry:
        """What stands: the masonry without its effects."""
        return self.masonry

    @property
    def description(self) -> str:
        """The same in words."""
        return "masonry"

    def require_own_joints(self, *given: object) -> None:
        """Raise a ValueError where restitution or contacts are given beside the case, which has its own."""
        if any(argument is not None for argument in given):
            raise ValueError("masonry has its joints, with their stiffness and damping; leave e and contacts out")

    @property
    def in_space(self) -> bool:
        """Whether the blocks are in space."""
        return self.masonry.in_space

    @property
    def blocks(self) -> tuple[str, ...]:
        """Names of all blocks, in their order."""
        return self.masonry.names

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the blocks that are not fixed, in their order."""
        return tuple(self.masonry.names[i] for i in self.masonry.free)

    @cached_property
    def masses(self) -> Array:
        """Mass of each block with its added masses [kg], shape (blocks,)."""
        return with_added_masses(self.masonry, self.effects).mass

    @cached_property
    def centroids(self) -> Array:
        """Centroid of each block with its added masses at rest [m], shape (blocks, d)."""
        return with_added_masses(self.masonry, self.effects).centroid

    @cached_property
    def rests(self) -> Array:
        """The same of the blocks that are not fixed, shape (bodies, d)."""
        return self.centroids[list(self.masonry.free)]

    @property
    def outlines(self) -> tuple[Array, ...]:
        """Corners of the blocks that are not fixed about their centroids [m]."""
        return tuple(self.masonry.blocks[i].corners - self.centroids[i] for i in self.masonry.free)

    @property
    def fixed(self) -> dict[int, Array]:
        """Corners of each fixed block [m], by its number."""
        return {i: block.corners for i, block in enumerate(self.masonry.blocks) if block.fixed}

    @cached_property
    def rest_geometry(self) -> MasonryRestGeometry:
        """The blocks and their joints at rest."""
        return MasonryRestGeometry(self.masonry, self.centroids)

    def held_by(self, link: Anchored) -> Array:
        """The point that a link holds, at rest [m], shape (d,)."""
        return np.array(place_in_world(self.masonry, link))

    def body_of(self, block: int | None) -> int | None:
        """Number of the body of a block among those that are not fixed; None of what is fixed, or of no block."""
        return self.masonry.free.index(block) if block in self.masonry.free else None

    def support_of(self, block: int | None) -> Support | None:
        """What moves a fixed block, None where nothing does."""
        moved = {self.masonry.names.index(support.block): support for support in self.supports}
        return None if block is None else moved.get(block)

    def require_start(self, pose: Array, velocity: Array) -> Array:
        """The velocity of a start [m/s, rad/s], shape (bodies, nv), without what guides take from it.

        Raises:
            ValueError: if a block moves as its guide does not allow by more than a thousandth of sqrt(g size).
        """
        guiding = [actuator.block for actuator in self.actuators.values() if any(actuator.guide)]
        if not guiding:
            return velocity
        smallest = min(self.masonry.blocks[block].size for block in guiding)
        self.require_guided("start, velocity", velocity, REMOVED_BY_GUIDE * math.sqrt(GRAVITY * smallest))
        return np.where(self.guided, 0.0, velocity)

    @property
    def is_moved(self) -> bool:
        """Whether something moves the masonry beside its weight."""
        driven = self.grounds or self.supports or self.actuators
        return bool(driven) or self.tilt is not None or self.velocity is not None

    @property
    def actuators(self) -> dict[str, Actuator]:
        """The actuators by name: `actuator_0` and so on."""
        return {f"{Actuator.label}_{i}": actuator for i, actuator in enumerate(self.each(Actuator))}

    @property
    def guided(self) -> Flags:
        """Which velocities of blocks that are not fixed guides of actuators keep at zero, shape (bodies, nv)."""
        d = self.masonry.freedom.translations
        allowed = np.zeros((len(self.masonry.free), self.masonry.freedom.nv), dtype=bool)
        for actuator in self.actuators.values():
            if not any(actuator.guide):
                continue  # it may drive all blocks
            body = self.masonry.free.index(actuator.block)
            allowed[body, d - 1] |= actuator.guide.rising
            allowed[body, d:] |= actuator.guide.turning
        return allowed

    def require_guided(self, name: str, velocity: Array, most: float = 0.0) -> None:
        """Raise a ValueError that names the block where a guide holds one that moves as it may not.

        Args:
            name: of the velocities.
            velocity: of the blocks that are not fixed [m/s, rad/s], shape (bodies, nv).
            most: velocity that is taken for none, rotations times the size of the block [m/s].
        """
        removed, d = self.guided, self.masonry.freedom.translations
        for body in np.flatnonzero(removed.any(axis=1)).tolist():
            block, speeds = self.masonry.free[body], np.abs(velocity[body])
            speeds[d:] *= self.masonry.blocks[block].size
            if (speeds[removed[body]] > most).any():
                axes = (*"xyz",) if d == 3 else (*"xz",)
                may = " and ".join(axis for axis, no in zip(axes, removed[body], strict=False) if not no)
                raise ValueError(
                    f"{name} of {self.masonry.names[block]} = {velocity[body].tolist()}: its actuator guides it, which "
                    f"lets it move along {may} alone; the others are 0"
                )

    @property
    def passive(self) -> tuple[Effect, ...]:
        """The effects that are not driven, with which the masonry comes to rest."""
        return tuple(effect for effect in self.effects if not isinstance(effect, Actuator))

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, MasonryCase)
            and all(getattr(self, name) == getattr(other, name) for name in EQUAL_FIELDS)
            and (self.velocity is None) == (other.velocity is None)
            and (self.velocity is None or np.array_equal(self.velocity, np.asarray(other.velocity)))
        )

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name in EQUAL_FIELDS))


AnyCase = Case | MasonryCase
"""A case of a wall or of masonry. Both answer alike for what they share."""


def require_wall(name: str, value: object, instead: str) -> None:
    """Raise a TypeError unless it is a Case of one wall. For masonry it names the call that takes that."""
    if isinstance(value, Masonry | MasonryCase):
        raise TypeError(f"{name} is masonry, and one wall is needed; for masonry take {instead}")
    require_kind(name, value, Case)
