"""Frames: where bodies are and how they move, from the coordinates of their joints.

A body of the plane has the joints x, z and a rotation about y. A body of space has x, y, z and a ball. Poses are
displacements from rest: (x, z, theta) or (x, y, z, quaternion), of all bodies one after the other. Velocities are the
rates of the displacements and the angular velocity: theta' in the plane, and in space three components in the axes of
the body, which are those of the world at rest.

A frame is a pose with its rotation computed once: the displacement of the centroid, and R - 1, with R the rotation
matrix. R - 1 keeps the precision of small rotations. The functions of this module and of `poses` are the only ones that
know the joints.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..quantities import Array
from .vectors import Vector, minus, moment, plus, scaled, spun, vector


@inlined
def coordinates(axes: tuple[int, ...]) -> int:
    """Coordinates of a body."""
    return 3 if len(axes) == 2 else 7


@inlined
def velocities(axes: tuple[int, ...]) -> int:
    """Velocities of a body."""
    return 3 if len(axes) == 2 else 6


class Freedom(NamedTuple):
    """How bodies may move.

    Args:
        axes: axes of the world along which they are displaced. Compiled functions are compiled for their number.
    """

    axes: tuple[int, ...]

    @property
    def nq(self) -> int:
        """Coordinates of a body."""
        return coordinates(self.axes)

    @property
    def nv(self) -> int:
        """Velocities of a body."""
        return velocities(self.axes)

    @property
    def translations(self) -> int:
        """Displacements of a body."""
        return len(self.axes)

    def frames(self, bodies: int) -> Array:
        """Room for the frames of some bodies."""
        return np.empty((bodies, 4 if len(self.axes) == 2 else 12))


PLANE, SPACE = Freedom((0, 2)), Freedom((0, 1, 2))


@inlined
def take_frames(q: Array, frames: Array, axes: tuple[int, ...]) -> None:
    """Write the frames of a pose: x, z, sin(theta), 1 - cos(theta), or x, y, z and the rows of R - 1."""
    if len(axes) == 2:
        for body in range(len(frames)):
            half = 0.5 * q[3 * body + 2]
            sine = math.sin(half)
            frames[body, 0], frames[body, 1] = q[3 * body], q[3 * body + 1]
            frames[body, 2], frames[body, 3] = 2 * sine * math.cos(half), 2 * sine * sine
    else:
        for body in range(len(frames)):
            w, x, y, z = q[7 * body + 3], q[7 * body + 4], q[7 * body + 5], q[7 * body + 6]
            for axis in range(3):
                frames[body, axis] = q[7 * body + axis]
            frames[body, 3], frames[body, 4], frames[body, 5] = (
                -2 * (y * y + z * z),
                2 * (x * y - w * z),
                2 * (x * z + w * y),
            )
            frames[body, 6], frames[body, 7], frames[body, 8] = (
                2 * (x * y + w * z),
                -2 * (x * x + z * z),
                2 * (y * z - w * x),
            )
            frames[body, 9], frames[body, 10], frames[body, 11] = (
                2 * (x * z - w * y),
                2 * (y * z + w * x),
                -2 * (x * x + y * y),
            )


def frames_of(q: Array, freedom: Freedom = PLANE) -> Array:
    """The frames of a pose, shape (n, 4) or (n, 12)."""
    frames = freedom.frames(len(q) // freedom.nq)
    _take_frames(q, frames, freedom.axes)
    return frames


@compiled
def _take_frames(q: Array, frames: Array, axes: tuple[int, ...]) -> None:
    take_frames(q, frames, axes)


@inlined
def rotation_change(frames: Array, body: int, r: Vector) -> Vector:
    """(R - 1) r: the displacement of the end of a vector r of a body by its rotation alone."""
    if len(r) == 2:
        sine, versine = frames[body, 2], frames[body, 3]
        return r[1] * sine - r[0] * versine, -r[0] * sine - r[1] * versine
    return (
        frames[body, 3] * r[0] + frames[body, 4] * r[1] + frames[body, 5] * r[2],
        frames[body, 6] * r[0] + frames[body, 7] * r[1] + frames[body, 8] * r[2],
        frames[body, 9] * r[0] + frames[body, 10] * r[1] + frames[body, 11] * r[2],
    )


@inlined
def displaced(start: Vector, frames: Array, body: int, r: Vector) -> Vector:
    """Start + (R - 1) r, summed from left to right."""
    if len(r) == 2:
        sine, versine = frames[body, 2], frames[body, 3]
        return start[0] + r[1] * sine - r[0] * versine, start[1] - r[0] * sine - r[1] * versine
    return plus(start, rotation_change(frames, body, r))


@inlined
def inverse_rotation_change(frames: Array, body: int, r: Vector) -> Vector:
    """(R^T - 1) r: the reverse of `rotation_change`."""
    if len(r) == 2:
        sine, versine = frames[body, 2], frames[body, 3]
        return -r[1] * sine - r[0] * versine, r[0] * sine - r[1] * versine
    return (
        frames[body, 3] * r[0] + frames[body, 6] * r[1] + frames[body, 9] * r[2],
        frames[body, 4] * r[0] + frames[body, 7] * r[1] + frames[body, 10] * r[2],
        frames[body, 5] * r[0] + frames[body, 8] * r[1] + frames[body, 11] * r[2],
    )


@inlined
def linear(v: Array, body: int, axes: tuple[int, ...]) -> Vector:
    """Velocity of the centroid of a body, or the same of an acceleration."""
    if len(axes) == 2:
        return v[3 * body], v[3 * body + 1]
    return v[6 * body], v[6 * body + 1], v[6 * body + 2]


@inlined
def spin(frames: Array, v: Array, body: int, axes: tuple[int, ...]) -> Vector:
    """Angular velocity of a body in the axes of the world, or the same of an acceleration."""
    if len(axes) == 2:
        return (v[3 * body + 2],)
    local = v[6 * body + 3], v[6 * body + 4], v[6 * body + 5]
    return plus(local, rotation_change(frames, body, local))


@inlined
def turn_between(start: Array, pose: Array, body: int, axes: tuple[int, ...]) -> Vector:
    """Rotation of a body from one pose to the next, in the axes of the world; in space twice the sine of its half."""
    if len(axes) == 2:
        return (pose[3 * body + 2] - start[3 * body + 2],)
    w, later = start[7 * body + 3], pose[7 * body + 3]
    old = start[7 * body + 4], start[7 * body + 5], start[7 * body + 6]
    new = pose[7 * body + 4], pose[7 * body + 5], pose[7 * body + 6]
    return scaled(2.0, plus(minus(scaled(w, new), scaled(later, old)), spun(old, new)))


@inlined
def push_body(frames: Array, body: int, arm: Vector, force: Vector, total: Array) -> None:
    """Add to generalised forces what a force does at `arm` from the centroid of a body."""
    turning = moment(arm, force)
    if len(arm) == 2:
        total[3 * body] += force[0]
        total[3 * body + 1] += force[1]
        total[3 * body + 2] += turning[0]
    else:
        local = plus(turning, inverse_rotation_change(frames, body, turning))
        for axis in range(3):
            total[6 * body + axis] += force[axis]
            total[6 * body + 3 + axis] += local[axis]


@inlined
def place(frames: Array, body: int, axes: tuple[int, ...]) -> Vector:
    """Displacement of the centroid of a body from rest."""
    return vector(frames, body, axes)
