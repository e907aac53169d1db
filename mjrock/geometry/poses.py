"""Poses of all bodies as arrays: at rest, moved by velocities, and the rates of their coordinates.

Angular velocities of space are about the axes of the body, and rotations are quaternions. So neither the sum of a pose
and a motion nor the difference of two poses is a pose or a motion. All arrays may have further axes before the last,
for many poses at once.
"""

from __future__ import annotations

import numpy as np

from ..quantities import Array
from .frames import PLANE, SPACE, Freedom, frames_of


def tilt_of(pose: Array) -> Array:
    """Angle between the axis of each body that was vertical at rest and the vertical [rad], from 0 to pi.

    Args:
        pose: displacement and unit quaternion, w first, shape (..., 7).
    """
    w, x, y, z = np.moveaxis(pose[..., 3:], -1, 0)
    angle: Array = 2 * np.arctan2(np.hypot(x, y), np.hypot(w, z))
    return angle


def angle_of(pose: Array) -> Array:
    """Angle of rotation from rest, about whatever axis [rad], from 0 to pi, of poses as in `tilt_of`."""
    angle: Array = 2 * np.arctan2(np.linalg.norm(pose[..., 4:], axis=-1), np.abs(pose[..., 3]))
    return angle


def rotations(pose: Array) -> Array:
    """Rotation matrices of bodies from rest, shape (..., d, d), of poses of shape (..., 3) in the plane and (..., 7) in
    space."""
    if pose.shape[-1] == PLANE.nq:
        sine, cosine = np.sin(pose[..., 2]), np.cos(pose[..., 2])
        return np.stack([np.stack([cosine, sine], axis=-1), np.stack([-sine, cosine], axis=-1)], axis=-2)
    changes = frames_of(np.ascontiguousarray(pose).ravel(), SPACE)[:, 3:]
    return np.eye(3) + changes.reshape(*pose.shape[:-1], 3, 3)


def rotated(vectors: Array, pose: Array) -> Array:
    """Vectors of bodies, given at rest, shape (..., m, d), rotated to poses of shape (..., 3) or (..., 7)."""
    return np.asarray(np.matmul(vectors, np.swapaxes(rotations(pose), -1, -2)))


def displaced(about: Array, pose: Array) -> Array:
    """Displacement of points of bodies [m], shape (..., m, d), which are given about the centroids at rest [m]."""
    return np.asarray(pose[..., None, : about.shape[-1]] + (rotated(about, pose) - about))


def at_rest(bodies: int, freedom: Freedom) -> Array:
    """The pose of bodies that have not moved, shape (bodies nq,)."""
    pose = np.zeros((bodies, freedom.nq))
    if freedom != PLANE:
        pose[:, 3] = 1.0
    return pose.ravel()


def moved(pose: Array, motion: Array, freedom: Freedom) -> Array:
    """A pose after a motion.

    Args:
        pose: shape (..., bodies nq).
        motion: velocities of all bodies times a time [m, rad], shape (..., bodies nv).
        freedom: of the bodies.
    """
    if freedom == PLANE:
        return pose + motion
    before, change = _values_by_body(pose, 7), _values_by_body(motion, 6)
    angle = np.linalg.norm(change[..., 3:], axis=-1, keepdims=True)
    turn = np.concatenate([np.cos(0.5 * angle), 0.5 * np.sinc(0.5 * angle / np.pi) * change[..., 3:]], axis=-1)
    after = np.concatenate([before[..., :3] + change[..., :3], _product(before[..., 3:], turn)], axis=-1)
    return after.reshape(pose.shape)


def turned(pose: Array, freedom: Freedom) -> Array:
    """Angle by which each body is turned from rest [rad], shape (..., bodies)."""
    if freedom == PLANE:
        return np.abs(pose[..., 2::3])
    return angle_of(_values_by_body(pose, 7))


def tilts(pose: Array, freedom: Freedom) -> Array:
    """Angle between the axis of each body that was vertical at rest and the vertical [rad], from 0 to pi, shape (...,
    bodies), of poses of shape (..., bodies nq)."""
    if freedom == PLANE:
        turn = np.abs(pose[..., 2::3]) % (2 * np.pi)
        return np.minimum(turn, 2 * np.pi - turn)
    return tilt_of(_values_by_body(pose, 7))


def angles(pose: Array, start: Array, freedom: Freedom) -> Array:
    """Angle by which each body is turned from a start to a pose [rad], shape (..., bodies)."""
    if freedom == PLANE:
        return np.abs(pose[..., 2::3] - start[..., 2::3])
    turn = _values_by_body(pose, 7).copy()
    turn[..., 3:] = _product(_values_by_body(start, 7)[..., 3:] * (1.0, -1.0, -1.0, -1.0), turn[..., 3:])
    return angle_of(turn)


def coordinate_rates(pose: Array, velocity: Array, freedom: Freedom) -> Array:
    """Rates of the coordinates of a pose at a velocity, shape (..., bodies nq)."""
    if freedom == PLANE:
        return velocity
    q, v = _values_by_body(pose, 7), _values_by_body(velocity, 6)
    spin = np.concatenate([np.zeros_like(v[..., :1]), v[..., 3:]], axis=-1)
    rates = np.concatenate([v[..., :3], 0.5 * _product(q[..., 3:], spin)], axis=-1)
    return rates.reshape(pose.shape)


def from_rates(pose: Array, rates: Array, freedom: Freedom) -> tuple[Array, Array]:
    """A pose with quaternions of unit length, and the velocity at which its coordinates have these rates."""
    if freedom == PLANE:
        return pose, rates
    q, v = _values_by_body(pose, 7).copy(), _values_by_body(rates, 7)
    length = np.linalg.norm(q[..., 3:], axis=-1, keepdims=True)
    q[..., 3:] /= length
    spin = 2 * _product(q[..., 3:] * (1.0, -1.0, -1.0, -1.0), v[..., 3:] / length)[..., 1:]
    velocity = np.concatenate([v[..., :3], spin], axis=-1)
    return q.reshape(pose.shape), velocity.reshape(*pose.shape[:-1], -1)


def _values_by_body(values: Array, count: int) -> Array:
    """Values by body, shape (..., bodies, count)."""
    return values.reshape(*values.shape[:-1], -1, count)


def _product(p: Array, q: Array) -> Array:
    """Products of quaternions, shape (..., 4)."""
    (a, b), (u, v) = (p[..., :1], p[..., 1:]), (q[..., :1], q[..., 1:])
    return np.concatenate([a * u - (b * v).sum(axis=-1, keepdims=True), a * v + u * b + np.cross(b, v)], axis=-1)
