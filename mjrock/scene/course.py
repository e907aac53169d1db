"""The course of a run: what happens to a scene, and how the ground moves.

Seen from the moving ground there is a force -m a_g on every body, along each direction in which it moves. The leapfrog
gets its mean over each window, from half a step before the pose to half a step after it. The bodies then receive the
impulse of the ground exactly, whatever the step and wherever the record jumps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..geometry.frames import velocities
from ..problem.ground.motion import GroundMotion
from ..quantities import Array
from .scene import Scene


class Shaking(NamedTuple):
    """A ground motion in one direction as arrays for compiled functions; empty ones stand for a base at rest.

    Args:
        accel, velocity: at the samples [m/s2, m/s], shape (samples,).
        dt: time step of the samples [s].
        instants: times of the samples where they are not every dt, one twice at a jump [s], shape (samples,), or none.
    """

    accel: Array
    velocity: Array
    dt: float
    instants: Array

    @classmethod
    def from_motion(cls, motion: GroundMotion | None) -> Shaking:
        """The arrays of a motion."""
        if motion is None:
            return cls(np.empty(0), np.empty(0), 1.0, np.empty(0))
        return cls(motion.accel.copy(), motion.velocities, motion.dt, instants_of(motion))


class Ground(NamedTuple):
    """The motions of the ground: horizontal away from the side stop, vertical upwards, and in space along y."""

    x: Shaking
    z: Shaking
    y: Shaking

    @classmethod
    def from_motions(
        cls, motion: GroundMotion | None, vertical: GroundMotion | None = None, transverse: GroundMotion | None = None
    ) -> Ground:
        """The arrays of the motions."""
        return cls(Shaking.from_motion(motion), Shaking.from_motion(vertical), Shaking.from_motion(transverse))


def instants_of(motion: GroundMotion) -> Array:
    """The times of the samples of a motion that are not evenly apart [s], for compiled functions; none of others."""
    return np.empty(0) if motion.instants is None else motion.instants.copy()


@inlined
def last_before(instants: Array, t: float) -> int:
    """The last of the instants that is not later than t; -1 where all are later."""
    low, high = -1, len(instants)
    while high - low > 1:
        middle = (low + high) // 2
        if instants[middle] <= t:
            low = middle
        else:
            high = middle
    return low


@inlined
def ground_velocity(shaking: Shaking, t: float) -> float:
    """Exact integral of the acceleration from zero to t, constant after the last sample [m/s]."""
    if len(shaking.instants) > 0:
        return ground_velocity_by_pieces(shaking, t)
    position, last = t / shaking.dt, len(shaking.accel) - 1
    if position <= 0:
        return 0.0
    if position >= last:
        return shaking.velocity[last]
    i = int(position)
    s = position - i
    rise = shaking.accel[i + 1] - shaking.accel[i]
    return shaking.velocity[i] + shaking.dt * s * (shaking.accel[i] + 0.5 * s * rise)


@inlined
def ground_velocity_by_pieces(shaking: Shaking, t: float) -> float:
    """The same between samples that are not evenly apart [m/s]."""
    i, last = last_before(shaking.instants, t), len(shaking.instants) - 1
    if i < 0:
        return 0.0
    if i >= last:
        return shaking.velocity[last]
    length, since = shaking.instants[i + 1] - shaking.instants[i], t - shaking.instants[i]
    rise = shaking.accel[i + 1] - shaking.accel[i]
    return shaking.velocity[i] + since * (shaking.accel[i] + 0.5 * since / length * rise)


@inlined
def mean_acceleration(shaking: Shaking, t: float, h: float) -> float:
    """Mean acceleration of the ground over the window of a step [m/s2]."""
    if len(shaking.accel) == 0:
        return 0.0
    return (ground_velocity(shaking, t + 0.5 * h) - ground_velocity(shaking, t - 0.5 * h)) / h


@inlined
def push_along(d: int, acceleration: float, masses: Array, axes: tuple[int, ...], applied: Array) -> None:
    """Add to `applied` what an acceleration of the ground in direction d of `Ground` adds to it [N], (n nv,)."""
    for j in range(0 if d == 0 else len(axes) - d, len(masses), velocities(axes)):
        applied[j] -= masses[j] * acceleration


@inlined
def push_ground(ground: Ground, masses: Array, axes: tuple[int, ...], t: float, h: float, applied: Array) -> None:
    """Add the force of the moving ground on every body to `applied` [N], shape (n nv,), as `masses`."""
    for d in range(len(axes)):
        if len(ground[d].accel) > 0:
            push_along(d, mean_acceleration(ground[d], t, h), masses, axes, applied)


@dataclass(frozen=True, eq=False)
class Course:
    """How a scene starts, for how long it is followed, and how the ground moves.

    Args:
        pose, velocity: of the bodies at the start, shape (n, nq) and (n, nv).
        duration: how long to follow the motion [s].
        motion, vertical: acceleration of the ground, horizontal and upwards, or None.
        transverse: the same along y, in space.
        released: whether the start is a release, whose rotation is the first peak. Otherwise an earlier run goes on.
    """

    pose: Array
    velocity: Array
    duration: float
    motion: GroundMotion | None = None
    vertical: GroundMotion | None = None
    released: bool = True
    transverse: GroundMotion | None = None

    def continued(self, pose: Array, velocity: Array) -> Course:
        """The same from another state, in which an earlier run ended."""
        return replace(self, pose=pose, velocity=velocity, released=False)

    @property
    def ground(self) -> Ground:
        """The motions of the ground for compiled functions."""
        return Ground.from_motions(self.motion, self.vertical, self.transverse)

    @property
    def sampling(self) -> list[float]:
        """Time steps of the records that move the ground [s]."""
        return [motion.dt for motion in (self.motion, self.vertical, self.transverse) if motion is not None]

    def energy(self, scene: Scene) -> float:
        """Energy at the start above the scene at rest [J]."""
        return float(scene.energy(self.pose[None], self.velocity[None])[0])
