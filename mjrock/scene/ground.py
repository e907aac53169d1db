"""The moving ground, as seen from it: a force -m a_g on every body, along each direction in which it moves.

The leapfrog gets its mean over each window, from half a step before the pose to half a step after it. The bodies then
receive the impulse of the ground exactly, whatever the step and wherever the record jumps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..geometry.frames import velocities
from ..problem.ground.motion import GroundMotion
from ..quantities import Array


class Shaking(NamedTuple):
    """A ground motion in one direction as arrays for compiled functions; empty ones stand for a base at rest.

    Args:
        accel, velocity: at the samples [m/s2, m/s], shape (samples,).
        dt: time step of the samples [s].
    """

    accel: Array
    velocity: Array
    dt: float

    @classmethod
    def of(cls, motion: GroundMotion | None) -> Shaking:
        """The arrays of a motion."""
        if motion is None:
            return cls(np.empty(0), np.empty(0), 1.0)
        return cls(motion.accel.copy(), motion.velocities, motion.dt)


class Ground(NamedTuple):
    """The motions of the ground: horizontal away from the side stop, vertical upwards, and in space along y."""

    x: Shaking
    z: Shaking
    y: Shaking

    @classmethod
    def of(
        cls,
        motion: GroundMotion | None,
        vertical: GroundMotion | None = None,
        transverse: GroundMotion | None = None,
    ) -> Ground:
        """The arrays of the motions."""
        return cls(Shaking.of(motion), Shaking.of(vertical), Shaking.of(transverse))


@inlined
def ground_velocity(shaking: Shaking, t: float) -> float:
    """Exact integral of the acceleration from zero to t, constant after the last sample [m/s]."""
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
