"""Rotation of bodies in space: quaternion, R - 1, and the angular velocity in the middle of a step.

A body keeps its angular momentum L in the axes of the world half a step before the pose, and its quaternion at the
pose. The angular velocity w in the middle of a step, in the axes of the body, solves w = I^-1 exp(-h w / 2) R^T L, with
R the rotation before the step. The step is of second order and keeps |L| exactly. R - 1 keeps the digits of small
rotations.
"""

from __future__ import annotations

import math

from ...compiled import inlined, jitable
from ...geometry.vectors import Vector, dot, plus, scaled, spun
from ..system import Row
from .system import momentum_of

PASSES = 3
"""Passes of the search for the angular velocity in the middle of a step. Each gains the order of h w."""
SLOW, PASSES_OF_SLOW = 1e-3, 2
"""Rotation in a step below which fewer passes are enough [rad]: they leave less than its third power."""
SMALL = 1e-4
"""Angle below which sines and cosines are taken from their series [rad]. The first term left out is below rounding."""


@inlined
def swung(body: Row, a: Vector) -> Vector:
    """(R - 1) a: the displacement of the end of a vector a of a body by its rotation."""
    return (
        body.turn_xx * a[0] + body.turn_xy * a[1] + body.turn_xz * a[2],
        body.turn_yx * a[0] + body.turn_yy * a[1] + body.turn_yz * a[2],
        body.turn_zx * a[0] + body.turn_zy * a[1] + body.turn_zz * a[2],
    )


@inlined
def in_world(body: Row, a: Vector) -> Vector:
    """R a: a vector of a body in the axes of the world."""
    return plus(a, swung(body, a))


@inlined
def in_body(body: Row, a: Vector) -> Vector:
    """R^T a: a vector of the world in the axes of a body."""
    return (
        a[0] + body.turn_xx * a[0] + body.turn_yx * a[1] + body.turn_zx * a[2],
        a[1] + body.turn_xy * a[0] + body.turn_yy * a[1] + body.turn_zy * a[2],
        a[2] + body.turn_xz * a[0] + body.turn_yz * a[1] + body.turn_zz * a[2],
    )


@inlined
def eased(body: Row, a: Vector) -> Vector:
    """I^-1 a, in the axes of the body."""
    return (
        body.ease_xx * a[0] + body.ease_xy * a[1] + body.ease_xz * a[2],
        body.ease_xy * a[0] + body.ease_yy * a[1] + body.ease_yz * a[2],
        body.ease_xz * a[0] + body.ease_yz * a[1] + body.ease_zz * a[2],
    )


@inlined
def eased_in_world(body: Row, a: Vector) -> Vector:
    """I^-1 a, in the axes of the world at the pose."""
    return in_world(body, eased(body, in_body(body, a)))


@jitable
def take_turn(body: Row) -> None:
    """Bring R - 1 of a body up to date with its quaternion."""
    w, x, y, z = body.qw, body.qx, body.qy, body.qz
    body.turn_xx, body.turn_xy, body.turn_xz = -2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    body.turn_yx, body.turn_yy, body.turn_yz = 2 * (x * y + w * z), -2 * (x * x + z * z), 2 * (y * z - w * x)
    body.turn_zx, body.turn_zy, body.turn_zz = 2 * (x * z - w * y), 2 * (y * z + w * x), -2 * (x * x + y * y)


@inlined
def take_spin(body: Row) -> None:
    """Bring the angular velocity of a body up to date with its angular momentum, at the pose."""
    body.wx, body.wy, body.wz = eased_in_world(body, momentum_of(body))


@inlined
def rotated(by: Vector, a: Vector) -> Vector:
    """exp(by) a: a vector turned by a rotation vector [rad]."""
    square = dot(by, by)
    angle = math.sqrt(square)
    if angle < SMALL:
        sine, versine = 1 - square / 6, 0.5 - square / 24
    else:
        half = math.sin(0.5 * angle)
        sine, versine = math.sin(angle) / angle, 2 * half * half / square
    across = spun(by, a)
    return plus(a, plus(scaled(sine, across), scaled(versine, spun(by, across))))


@jitable
def middle_spin(body: Row, h: float) -> Vector:
    """Angular velocity in the middle of a step of length h, in the axes of the body [rad/s]."""
    start = in_body(body, momentum_of(body))
    spin = eased(body, start)
    for _ in range(PASSES_OF_SLOW if h * h * dot(spin, spin) < SLOW * SLOW else PASSES):
        spin = eased(body, rotated(scaled(-0.5 * h, spin), start))
    return spin


@jitable
def turn_body(body: Row, h: float) -> None:
    """Turn a body by a step of length h."""
    spin = middle_spin(body, h)
    size = math.sqrt(dot(spin, spin))
    half = 0.5 * h * size
    if half < SMALL:
        c, share = 1 - 0.5 * half * half, 0.5 * h * (1 - half * half / 6)
    else:
        c, share = math.cos(half), math.sin(half) / size
    x, y, z = scaled(share, spin)
    qw, qx, qy, qz = body.qw, body.qx, body.qy, body.qz
    w = qw * c - qx * x - qy * y - qz * z
    i = qw * x + qx * c + qy * z - qz * y
    j = qw * y - qx * z + qy * c + qz * x
    k = qw * z + qx * y - qy * x + qz * c
    size = 1 / math.sqrt(w * w + i * i + j * j + k * k)
    body.qw, body.qx, body.qy, body.qz = w * size, i * size, j * size, k * size
