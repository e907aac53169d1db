"""The physical problem of a wall, which every solver takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, ClassVar, Never

import numpy as np

from ...quantities import (
    ON_ITS_FACE,
    Array,
    Flags,
    Implausible,
    Within,
    keep,
    keep_declared,
    require_flag,
    require_kind,
    require_within,
    shown,
    warn_of,
)
from ..ground.motion import GroundMotion
from .block import Block
from .effect import Anchored, Effect, require_only
from .effects import EFFECT_KINDS, AddedMass, Carrying, Load, SideStop, constant_forces_of
from .plausibility import doubts
from .rest_geometry import WallRestGeometry
from .restoring_moment import Restoring, TiePull, dissipated_by_ties, of_force, tie_energy, tie_limits, yielded


@dataclass(frozen=True)
class Case(Carrying):
    """A wall released, tilted, on its base.

    Args:
        block: the wall.
        theta0: rotation at release [rad], -1.6 to 1.6 and not beyond 90 degrees; positive opens away from the side
            stop.
        duration: how long to follow the motion [s], 1e-6 to 1e6.
        side_stop: whether a stop behind the inner face keeps the rotation from becoming negative (one-sided rocking):
            True over the whole face, or a `SideStop` that reaches only so high.
        omega0: angular velocity at release [rad/s], -100 to 100, the wall turning about its toe.
        motion: horizontal acceleration of the base, or None for a base at rest. Responses are motions as seen from the
            base.
        vertical: vertical acceleration of the base, positive upwards, or None.
        effects: ties, thrusts, loads and added masses, as many as there are.

    Raises:
        ValueError: for a rotation beyond 90 degrees or into the side stop, a duration that is not positive, a motion
            of another type, an effect that is not on the wall, or effects that overturn the wall as it stands.

    Warns:
        Implausible: for values that can be and are most often in another unit, see `mjrock.problem.wall.plausibility`.
    """

    transverse: ClassVar[None] = None
    supports: ClassVar[tuple[()]] = ()
    actuators: ClassVar[dict[str, Never]] = {}
    settled: ClassVar[bool] = True
    tilt: ClassVar[None] = None
    joints: ClassVar[tuple[()]] = ()
    bonds: ClassVar[tuple[()]] = ()
    in_space: ClassVar[bool] = False
    bodies: ClassVar[tuple[str, ...]] = ("wall",)
    blocks: ClassVar[tuple[str, ...]] = ("wall",)
    fixed: ClassVar[dict[int, Array]] = {}

    block: Block
    theta0: Annotated[float, Within(-1.6, 1.6, "rad", "release rotation theta0")] = 0.0
    duration: Annotated[float, Within(1e-6, 1e6, "s")] = 10.0
    side_stop: bool | SideStop = True
    omega0: Annotated[float, Within(-100, 100, "rad/s", "release velocity omega0")] = 0.0
    motion: GroundMotion | None = None
    vertical: GroundMotion | None = None
    effects: tuple[Effect, ...] = ()

    def __post_init__(self) -> None:
        require_kind("block", self.block, Block)
        if isinstance(self.side_stop, SideStop):
            top = self.side_stop.top
            require_within("top of the side stop", top, 0.01, 2 * self.block.h * (1 + 1e-12), "m")
        else:
            keep(self, side_stop=require_flag("side_stop", self.side_stop))
        lowest = 0.0 if self.side_stop else -ON_ITS_FACE
        keep(self, theta0=require_within("release rotation theta0", self.theta0, lowest, ON_ITS_FACE, "rad"))
        keep_declared(self)
        for name in ("motion", "vertical"):
            require_kind(name, getattr(self, name), GroundMotion, type(None))
        self._require_effects()
        for doubt in doubts(self):
            warn_of(doubt, Implausible)

    def _require_effects(self) -> None:
        """Check that each effect is on the wall and that the wall stands with them, and keep them as a tuple."""
        self._keep_sequence()
        top, b = 2 * self.block.h * (1 + 1e-12), self.block.b * (1 + 1e-12)
        wedges = np.vstack([np.empty((0, 2)), *(mass.outline for mass in self.each(AddedMass))])
        inner = float(wedges[:, 0].min(initial=-b))  # a load may rest on wedges of side walls
        for i, effect in enumerate(self.effects):
            if isinstance(effect, SideStop):
                raise TypeError(f"effects[{i}] = {shown(effect)}: give it as side_stop")
            require_kind(f"effects[{i}]", effect, *EFFECT_KINDS)
            if effect.block:
                raise ValueError(
                    f"effects[{i}], block = {effect.block}, is outside the valid range: a wall has block 0"
                )
            require_only(f"effects[{i}]", effect)
            require_within(f"effects[{i}], height of the {type(effect).__name__}", effect.height, 0.0, top, "m")
            if isinstance(effect, Load):
                require_within(f"effects[{i}], offset of the Load", effect.offset, inner, b, "m")
        for side, sense in ((1.0, "outwards"), (-1.0, "inwards")):
            restores = side > 0 and self.overturning_rotation > 0  # by ties
            if (side > 0 or not self.side_stop) and self.restoring.towards(side).P <= 0 and not restores:
                raise ValueError(
                    f"the loads and thrusts overturn the wall {sense} as it stands: their moment about the toe "
                    f"and that of the weight is {self.restoring.towards(side).P:.4g} N m, and no tie makes up "
                    "for it; the valid range is above 0: lower the thrust, or give a "
                    f"{'tie that can hold it' if side > 0 else 'side stop'}"
                )

    def __repr__(self) -> str:
        stop = "no side stop" if self.stop_top is None else "side stop"
        if isinstance(self.side_stop, SideStop):
            stop += f" up to {self.side_stop.top:.6g} m"
        share = self.theta0 / self.wall.alpha
        parts = [f"theta0 = {self.theta0:.4g} rad = {share:.3g} alpha", f"{self.duration:.6g} s", stop]
        if self.omega0:
            parts.append(f"omega0 = {self.omega0:.4g} rad/s")
        parts += [f"{name} {motion.name!r}" for name, motion in self.grounds.items()]
        parts += [type(effect).__name__ for effect in self.effects]
        return f"<Case of {self.block!r}: {', '.join(parts)}>"

    @cached_property
    def wall(self) -> Block:
        """The wall with the masses that the case adds to it."""
        masses = self.each(AddedMass)
        return replace(self.block, masses=self.block.masses + masses) if masses else self.block

    @cached_property
    def centroids(self) -> Array:
        """Centroid of the wall with its added masses at rest, x and z [m], shape (1, 2)."""
        return np.array([[self.wall.centroid_offset, self.wall.centroid_height]])

    @property
    def masses(self) -> Array:
        """Mass of the wall with its added masses [kg], shape (1,)."""
        return np.array([self.wall.mass])

    @property
    def rests(self) -> Array:
        """Centroid of each body at rest [m]: of the wall alone."""
        return self.centroids

    @property
    def outlines(self) -> tuple[Array, ...]:
        """Corners of the wall about its centroid [m]."""
        return (self.wall.outline,)

    @cached_property
    def rest_geometry(self) -> WallRestGeometry:
        """The wall and what it stands on and against, at rest."""
        return WallRestGeometry(self.wall, self.stop_top)

    def held_by(self, link: Anchored) -> Array:
        """The point that a link holds, at rest [m], shape (2,)."""
        return np.array([self.block.inner_face(link.height), link.height])

    def body_of(self, block: int | None) -> int | None:
        """Number of the body of a block: 0 of the wall, None of what does not move."""
        return block

    def support_of(self, block: int | None) -> None:
        """What moves a fixed block: nothing does."""

    def require_start(self, pose: Array, velocity: Array) -> Array:
        """The velocity of a start [m/s, rad/s], shape (1, 3).

        Raises:
            ValueError: for a rotation beyond 90 degrees.
        """
        require_within("start, rotation", float(pose[0, 2]), -ON_ITS_FACE, ON_ITS_FACE, "rad")
        return velocity

    @property
    def one_sided(self) -> bool:
        """Whether there is a side stop."""
        return bool(self.side_stop)

    @property
    def stop_top(self) -> float | None:
        """Height that the side stop reaches [m], or None without one."""
        if isinstance(self.side_stop, SideStop):
            return min(self.side_stop.top, 2 * self.block.h)
        return 2 * self.block.h if self.side_stop else None

    @cached_property
    def restoring(self) -> Restoring:
        """The restoring moments of weight, loads and thrusts about the two toes; ties come on top."""
        return self.wall.restoring.plus(self._forces(0.0, self.block.half_base))

    @cached_property
    def inward_limit(self) -> float:
        """Largest inward rotation from which weight, loads and thrusts still bring the wall back [rad].

        Against a side stop it is the rotation about the highest point of the stop beyond which they turn the wall over
        it, not below alpha. A stop that reaches the centroid holds the wall at every rotation.
        """
        if self.stop_top is None:
            return self.restoring.inner.alpha
        wall, top = self.wall, self.stop_top
        face = -wall.inner_face(top)
        weight = of_force(wall.centroid_offset, wall.centroid_height - top, 0.0, wall.weight, face)
        about_stop = weight.plus(self._forces(top, face)).inner
        return min(max(about_stop.alpha, wall.alpha), ON_ITS_FACE) if about_stop.Q > 0 else ON_ITS_FACE

    def _forces(self, level: float, half_base: float) -> list[Restoring]:
        """Restoring moments of loads and thrusts about two edges at a height and a distance from the middle [m]."""
        return [
            of_force(force.offset, force.height - level, offset, -up, half_base)
            for force, (offset, _, up) in constant_forces_of(self.effects).values()
        ]

    @cached_property
    def pulls(self) -> tuple[TiePull, ...]:
        """The ties, in the geometry of the wall."""
        return tuple(pull for pull, tie in zip(self.resisting, self.springs.values(), strict=True) if tie.law.holds)

    @cached_property
    def resisting(self) -> tuple[TiePull, ...]:
        """All springs that resist a push outwards: ties, which bring the wall back, and what slips in either sense."""
        return tuple(TiePull.from_tie(tie, self.block) for tie in self.springs.values())

    def limits_of_ties(self, rotations: Array) -> tuple[dict[str, float], dict[str, float]]:
        """Rotations [rad] at which ties yield, and at which they break, by name, within increasing `rotations` (n,)."""
        names = (name for name, tie in self.springs.items() if tie.law.holds)
        return tie_limits(dict(zip(names, self.pulls, strict=True)), rotations)

    @property
    def pressing(self) -> float:
        """Weight and loads that press on the base [N]."""
        return self.wall.weight - sum(up for _, (_, _, up) in constant_forces_of(self.effects).values())

    @property
    def shaken(self) -> bool:
        """Whether the base moves."""
        return self.motion is not None or self.vertical is not None

    rocks_on_moving_ground = shaken

    @property
    def is_still(self) -> bool:
        """Whether nothing moves the wall."""
        return not (self.theta0 or self.omega0 or self.shaken)

    @property
    def is_moved(self) -> bool:
        """Whether something moves the wall."""
        return not self.is_still

    def require_dry(self, what: str) -> None:
        """Raise a ValueError where joints have a bond, which those of a wall have not."""

    @property
    def built(self) -> Block:
        """What stands: the wall without its effects."""
        return self.block

    @property
    def description(self) -> str:
        """The same in words."""
        return repr(self.block)

    def require_own_joints(self, *given: object) -> None:
        """Raise a ValueError where joints have what is given beside the case, which those of a wall have not."""

    @property
    def lopsided(self) -> bool:
        """Whether the wall rocks to both sides, and not alike."""
        return not self.side_stop and self.restoring.outer != self.restoring.inner

    def peak_energies(self, peaks: Array) -> tuple[Array, Array]:
        """Energy at the rotation peaks of a base at rest [J], shape (n,): on leaving each, and on the way to it.

        The second is larger by what ties have dissipated up to there. Peaks have their sign [rad], shape (n,).
        """
        energy = np.asarray(self.restoring.energy(peaks), dtype=float)
        if not self.pulls:
            return energy, energy
        plastic = yielded(self.pulls, peaks)
        energy = energy + tie_energy(self.pulls, peaks, plastic)
        return energy, energy + np.diff(dissipated_by_ties(self.pulls, plastic), prepend=0.0)

    @cached_property
    def overturning_rotation(self) -> float:
        """Largest rotation from which weight, loads, thrusts and ties still bring the wall back [rad].

        It is alpha of a wall without loads, thrusts and ties. Each tie is taken as one that is stretched for the first
        time.
        """
        moment = self.restoring.outer
        if not self.pulls:
            return max(moment.alpha, 0.0)

        def restores(phi: Array) -> Flags:
            return np.asarray(moment.at(phi) + sum(pull.moment(phi) for pull in self.pulls) > 0)

        phi = np.linspace(0.0, ON_ITS_FACE, 2001)
        restored = 1 + np.flatnonzero(restores(phi[1:]))
        if not restored.size or restored[-1] == len(phi) - 1:
            return float(phi[restored[-1]]) if restored.size else 0.0
        low, high = (float(phi[restored[-1] + i]) for i in (0, 1))
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if restores(np.array([middle]))[0] else (low, middle)
        return low

    def returns_from(self, theta: Array) -> Flags:
        """Whether the wall may still come back from rotations of either sign [rad], shape (n,)."""
        return np.asarray((theta <= self.overturning_rotation) & (theta >= -self.inward_limit))

    def returning(self, theta: Array) -> int:
        """How many samples of a motion come before the wall can no longer come back, one at least."""
        standing = np.flatnonzero(self.returns_from(theta))
        return int(standing[-1]) + 1 if standing.size else 1

    def energy(self, theta: Array, omega: Array) -> Array:
        """Kinetic and potential energy of the rigid wall, above the wall at rest [J], without ties; shape (n,)."""
        outwards = np.where(theta == 0, omega, theta) >= 0
        inertia = np.where(outwards, self.wall.inertia_about(1), self.wall.inertia_about(-1))
        return np.asarray(self.restoring.energy(theta) + 0.5 * inertia * omega**2)

    @cached_property
    def release_energy(self) -> float:
        """Kinetic and potential energy of the rigid wall at release, above the wall at rest [J], without ties."""
        inertia = self.wall.inertia_about(self.direction)
        return float(self.restoring.energy(self.theta0)) + 0.5 * inertia * self.omega0**2

    @property
    def direction(self) -> float:
        """Sign of the rotation that the wall is released to, +1 or -1; a side stop leaves only +1."""
        return 1.0 if self.side_stop else math.copysign(1.0, self.theta0 if self.theta0 else self.omega0)

    @property
    def released_outwards(self) -> bool:
        """Whether the wall is released on its way out, so that its first rotation maximum is still to come."""
        return self.direction * self.omega0 > 0

    @property
    def release_peak(self) -> float:
        """The rotation from which the wall would have had to fall to be released as it is [rad], at most alpha."""
        if self.omega0 == 0:
            return abs(self.theta0)
        moment = self.restoring.towards(self.direction)
        return moment.rotation_at(min(self.release_energy, float(moment.energy(moment.alpha))))
