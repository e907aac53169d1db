"""The moving ground, as seen from it: a force -m a_g on every body.

The leapfrog gets its mean over each window, from half a step before the pose to half a step after it. The bodies then
receive the impulse of the ground exactly, whatever the step and wherever the record jumps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..problem.motion import GroundMotion
from ..problem.quantities import Array


class Ground(NamedTuple):
    """A ground motion as arrays for compiled functions; empty ones stand for a base at rest.

    Args:
        accel, velocity: at the samples [m/s2, m/s], shape (samples,).
        dt: time step of the samples [s].
    """

    accel: Array
    velocity: Array
    dt: float

    @classmethod
    def of(cls, motion: GroundMotion | None) -> Ground:
        """The arrays of a motion."""
        if motion is None:
            return cls(np.empty(0), np.empty(0), 1.0)
        return cls(motion.accel.copy(), motion.velocities, motion.dt)


@jitable
def ground_velocity(ground: Ground, t: float) -> float:
    """Exact integral of the acceleration from zero to t, constant after the last sample [m/s]."""
    position, last = t / ground.dt, len(ground.accel) - 1
    if position <= 0:
        return 0.0
    if position >= last:
        return ground.velocity[last]
    i = int(position)
    s = position - i
    return ground.velocity[i] + ground.dt * s * (ground.accel[i] + 0.5 * s * (ground.accel[i + 1] - ground.accel[i]))


@jitable
def mean_acceleration(ground: Ground, t: float, h: float) -> float:
    """Mean acceleration of the ground over the window of a step [m/s2]."""
    if len(ground.accel) == 0:
        return 0.0
    return (ground_velocity(ground, t + 0.5 * h) - ground_velocity(ground, t - 0.5 * h)) / h


@jitable
def push(ground: Ground, masses: Array, t: float, h: float, applied: Array) -> None:
    """Write the force of the moving ground on every body into `applied` [N], shape (3 n,)."""
    if len(ground.accel) == 0:
        return
    mean = mean_acceleration(ground, t, h)
    for j in range(0, len(masses), 3):
        applied[j] = -masses[j] * mean
