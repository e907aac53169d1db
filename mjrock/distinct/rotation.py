"""How a body turns: by an angle in the plane, by its angular momentum and a quaternion in space.

In space a body keeps its angular momentum L in the axes of the world half a step before the pose, and its quaternion at
the pose. The angular velocity w in the middle of a step, in the axes of the body, solves w = I^-1 exp(-h w / 2) R^T L,
with R the rotation before the step. The step is of second order and keeps |L| exactly.

R - 1 keeps the precision of small rotations. The field `rotation` of a body holds it in space, and the sine and 1 - cos
of the angle in the plane.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..compiled import by_type, inlined
from ..geometry.vectors import Vector, dot, increase, moment, norm, plus, put, read, scaled, spun, times
from ..quantities import Array
from ..rows import Row, Rows

SPIN_PASSES = 3
"""Passes of the search for the angular velocity in the middle of a step. Each gains the order of h w."""
SMALL_ROTATION, PASSES_IF_SMALL = 1e-3, 2
"""Rotation in a step below which fewer passes are enough [rad], and how many: their error is below its third power."""
EIGHTH = 1 - math.sqrt(0.5)
"""1 - cos of an eighth of a turn."""
SERIES_ANGLE = 1e-4
"""Angle below which sines and cosines are computed from their series [rad]. The first term that is left out is below
rounding."""


@inlined
def rotation_change(body: Row, a: Vector) -> Vector:
    """(R - 1) a: the displacement of the end of a vector a of a body by its rotation."""
    change = body.rotation
    if len(a) == 2:
        return a[1] * change[0] - a[0] * change[1], -a[0] * change[0] - a[1] * change[1]
    return (
        change[0, 0] * a[0] + change[0, 1] * a[1] + change[0, 2] * a[2],
        change[1, 0] * a[0] + change[1, 1] * a[1] + change[1, 2] * a[2],
        change[2, 0] * a[0] + change[2, 1] * a[1] + change[2, 2] * a[2],
    )


def by_body(flat: Callable[..., Any], deep: Callable[..., Any]) -> Callable[..., Any]:
    """A function of a body with one implementation for the plane and one for space."""
    return by_type(lambda body: flat if "angle" in (getattr(body, "fields", None) or body.dtype.names) else deep)


@inlined
def _turned_far_in_plane(body: Row) -> bool:
    return bool(body.rotation[1] > EIGHTH)


@inlined
def _turned_far_in_space(body: Row) -> bool:
    return bool(body.rotation[0, 0] + body.rotation[1, 1] + body.rotation[2, 2] < -2 * EIGHTH)


may_face_away = by_body(_turned_far_in_plane, _turned_far_in_space)
"""Whether a body has turned by more than an eighth of a turn. The faces of two bodies that have not still face each
other."""


@inlined
def in_world(body: Row, a: Vector) -> Vector:
    """R a: a vector of a body in the axes of the world. The spin of a plane body is the same in both."""
    if len(a) == 1:
        return a
    return plus(a, rotation_change(body, a))


@inlined
def in_body(body: Row, a: Vector) -> Vector:
    """R^T a: a vector of the world in the axes of a body. The spin of a plane body is the same in both."""
    if len(a) == 1:
        return a
    change = body.rotation
    if len(a) == 2:
        return a[0] - a[0] * change[1] - a[1] * change[0], a[1] + a[0] * change[0] - a[1] * change[1]
    return (
        a[0] + change[0, 0] * a[0] + change[1, 0] * a[1] + change[2, 0] * a[2],
        a[1] + change[0, 1] * a[0] + change[1, 1] * a[1] + change[2, 1] * a[2],
        a[2] + change[0, 2] * a[0] + change[1, 2] * a[1] + change[2, 2] * a[2],
    )


@inlined
def apply_inverse_inertia(body: Row, a: Vector) -> Vector:
    """I^-1 a, in the axes of the body."""
    inverse = body.inverse_inertia
    if len(a) == 1:
        return (inverse[0, 0] * a[0],)
    return (
        inverse[0, 0] * a[0] + inverse[0, 1] * a[1] + inverse[0, 2] * a[2],
        inverse[0, 1] * a[0] + inverse[1, 1] * a[1] + inverse[1, 2] * a[2],
        inverse[0, 2] * a[0] + inverse[1, 2] * a[1] + inverse[2, 2] * a[2],
    )


@inlined
def spin_from_moment(body: Row, a: Vector) -> Vector:
    """I^-1 a, in the axes of the world at the pose."""
    return in_world(body, apply_inverse_inertia(body, in_body(body, a)))


@inlined
def _no_inverse(body: Row) -> None:
    pass


@inlined
def _inverse_in_space(body: Row) -> None:
    for i in range(3):
        axis = (1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0, 1.0 if i == 2 else 0.0)
        put(body.inverse_in_world[i], spin_from_moment(body, axis))


take_inverse_inertia = by_body(_no_inverse, _inverse_in_space)
"""Keep I^-1 of a body in space in the axes of the world at the pose, for many moments."""


@inlined
def spin_from_many(body: Row, a: Vector) -> Vector:
    """`spin_from_moment` for a body on which many moments act: its inverse inertia has been kept before."""
    if len(a) == 1:
        return apply_inverse_inertia(body, a)
    inverse = body.inverse_in_world
    return (
        inverse[0, 0] * a[0] + inverse[0, 1] * a[1] + inverse[0, 2] * a[2],
        inverse[0, 1] * a[0] + inverse[1, 1] * a[1] + inverse[1, 2] * a[2],
        inverse[0, 2] * a[0] + inverse[1, 2] * a[1] + inverse[2, 2] * a[2],
    )


@inlined
def _momentum_in_plane(body: Row) -> Vector:
    inverse = body.inverse_inertia[0, 0]
    return (body.spin[0] / inverse if inverse > 0 else 0.0,)


@inlined
def _momentum_in_space(body: Row) -> Vector:
    momentum: Vector = read(body.momentum)
    return momentum


momentum_of = by_body(_momentum_in_plane, _momentum_in_space)
"""Angular momentum in the axes of the world [N m s]."""


@inlined
def _rotation_in_plane(body: Row) -> None:
    half = math.sin(0.5 * body.angle)
    body.rotation[0], body.rotation[1] = 2 * half * math.cos(0.5 * body.angle), 2 * half * half


@inlined
def _rotation_in_space(body: Row) -> None:
    change = body.rotation
    w, x, y, z = body.quaternion[0], body.quaternion[1], body.quaternion[2], body.quaternion[3]
    change[0, 0], change[0, 1], change[0, 2] = -2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    change[1, 0], change[1, 1], change[1, 2] = 2 * (x * y + w * z), -2 * (x * x + z * z), 2 * (y * z - w * x)
    change[2, 0], change[2, 1], change[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), -2 * (x * x + y * y)
    put(body.spin, spin_from_moment(body, read(body.momentum)))


update_rotation = by_body(_rotation_in_plane, _rotation_in_space)
"""Bring R - 1 and the angular velocity of a body up to date with its pose."""


@inlined
def apply_angular_impulse(body: Row, change: Vector) -> None:
    """Apply the impulse of a moment to a body [N m s]."""
    if len(change) == 1:
        increase(body.spin, apply_inverse_inertia(body, change))
    else:
        increase(body.momentum, change)
        put(body.spin, spin_from_moment(body, read(body.momentum)))


@inlined
def add_momentum(body: Row, change: Vector) -> None:
    """Change the angular momentum that a body in space keeps [N m s]; a plane body keeps none."""
    if len(change) == 3:
        increase(body.momentum, change)


@inlined
def apply_impulse(body: Row, impulse: Vector) -> None:
    """Apply an impulse to the centroid of a body [N s]."""
    increase(body.velocity, times(read(body.inverse_mass), impulse))


@inlined
def apply_impulse_at(body: Row, arm: Vector, impulse: Vector) -> None:
    """Apply an impulse at an arm from the centroid of a body [N s]."""
    lever = moment(arm, impulse)
    apply_impulse(body, impulse)
    add_momentum(body, lever)
    increase(body.spin, spin_from_moment(body, lever))


@inlined
def rotated(by: Vector, a: Vector) -> Vector:
    """exp(by) a: a vector turned by a rotation vector [rad]."""
    square = dot(by, by)
    angle = math.sqrt(square)
    if angle < SERIES_ANGLE:
        sine, versine = 1 - square / 6, 0.5 - square / 24
    else:
        half = math.sin(0.5 * angle)
        sine, versine = math.sin(angle) / angle, 2 * half * half / square
    cross_product = spun(by, a)
    return plus(a, plus(scaled(sine, cross_product), scaled(versine, spun(by, cross_product))))


@inlined
def middle_spin(body: Row, momentum: Vector, h: float) -> Vector:
    """Angular velocity in the middle of a step of length h, in the axes of the body [rad/s], in space."""
    start = in_body(body, momentum)
    spin = apply_inverse_inertia(body, start)
    for _ in range(PASSES_IF_SMALL if h * h * dot(spin, spin) < SMALL_ROTATION * SMALL_ROTATION else SPIN_PASSES):
        spin = apply_inverse_inertia(body, rotated(scaled(-0.5 * h, spin), start))
    return spin


@inlined
def _step_in_plane(body: Row, h: float) -> None:
    body.angle += h * body.spin[0]


@inlined
def _step_in_space(body: Row, h: float) -> None:
    spin = middle_spin(body, momentum_of(body), h)
    size = norm(spin)
    half = 0.5 * h * size
    if half < SERIES_ANGLE:
        c, share = 1 - 0.5 * half * half, 0.5 * h * (1 - half * half / 6)
    else:
        c, share = math.cos(half), math.sin(half) / size
    x, y, z = scaled(share, spin)
    turned = body.quaternion
    qw, qx, qy, qz = turned[0], turned[1], turned[2], turned[3]
    w = qw * c - qx * x - qy * y - qz * z
    i = qw * x + qx * c + qy * z - qz * y
    j = qw * y - qx * z + qy * c + qz * x
    k = qw * z + qx * y - qy * x + qz * c
    size = 1 / math.sqrt(w * w + i * i + j * j + k * k)
    turned[0], turned[1], turned[2], turned[3] = w * size, i * size, j * size, k * size


rotate_body = by_body(_step_in_plane, _step_in_space)
"""Turn a body by a step of some length."""


@inlined
def _write_angle(body: Row, pose: Array) -> None:
    pose[2] = body.angle


@inlined
def _write_quaternion(body: Row, pose: Array) -> None:
    for i in range(4):
        pose[3 + i] = body.quaternion[i]


write_rotation = by_body(_write_angle, _write_quaternion)
"""Write the rotation of a body into its pose, after the displacements."""


@inlined
def _within_in_plane(body: Row, ends: float) -> bool:
    return bool(abs(body.angle) < ends)


@inlined
def _within_in_space(body: Row, ends: float) -> bool:
    return bool(abs(body.spin[0]) < math.inf)


rotation_within = by_body(_within_in_plane, _within_in_space)
"""Whether a body has turned by less than a run follows [rad], in the plane, or turns at a finite speed."""


def set_rotations_and_spins(bodies: Rows, pose: Array, velocity: Array) -> None:
    """Give bodies the rotations of a pose, shape (n, nq), and the spins of velocities, shape (n, nv)."""
    set_rotations(bodies, pose)
    if is_flat(bodies):
        bodies["spin"] = velocity[:, 2:]
        return
    momentum = (np.linalg.pinv(bodies["inverse_inertia"]) @ velocity[:, 3:, None])[:, :, 0]  # zero of guided bodies
    bodies["momentum"] = momentum + np.einsum("nij,nj->ni", rotations(bodies), momentum)


def set_rotations(bodies: Rows, pose: Array) -> None:
    """Give bodies the rotations of a pose, shape (n, nq)."""
    if is_flat(bodies):
        bodies["angle"] = pose[:, 2]
    else:
        bodies["quaternion"] = pose[:, 3:]


def is_flat(bodies: Rows) -> bool:
    """Whether bodies are those of the plane."""
    return "angle" in (bodies.dtype.names or ())


def rotations(bodies: Rows) -> Array:
    """R - 1 of bodies at their pose, shape (n, d, d)."""
    if is_flat(bodies):
        half = np.sin(0.5 * bodies["angle"])
        sine, versine = 2 * half * np.cos(0.5 * bodies["angle"]), 2 * half**2
        return np.moveaxis(np.array([[-versine, sine], [-sine, -versine]]), 2, 0)
    w, x, y, z = bodies["quaternion"].T
    matrix = (
        (-2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), -2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), -2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(matrix), 2, 0)


def roots_of_masses(bodies: Rows) -> Array:
    """Of each body a matrix whose product with its transpose is the inverse of its masses at rest, (n, nv, nv)."""
    d = bodies["rest"].shape[1]
    nv = d + bodies["inverse_inertia"].shape[1]
    roots = np.zeros((len(bodies), nv, nv))
    roots[:, range(d), range(d)] = np.sqrt(np.asarray(bodies["inverse_mass"]))
    turning = bodies["inverse_inertia"].any(axis=(1, 2))  # guides keep the others from it
    roots[turning, d:, d:] = np.linalg.cholesky(bodies["inverse_inertia"][turning])
    return roots
