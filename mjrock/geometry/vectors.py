"""Vectors as tuples, for compiled functions of the plane and of space.

A vector of the plane is (x, z), and one of space is (x, y, z). A spin, or angular velocity, is (about y,) in the plane,
positive from z towards x, and has three components in space. numba compiles each function for the lengths of the tuples
that it gets, so that the plane takes no time for the third axis.
"""

from __future__ import annotations

import math

from ..compiled import by_type, inlined
from ..quantities import Array

Vector = tuple[float, ...]


@inlined
def vector(values: Array, i: int, axes: Vector) -> Vector:
    """The first numbers of row i, as many as there are axes."""
    if len(axes) == 2:
        return values[i, 0], values[i, 1]
    return values[i, 0], values[i, 1], values[i, 2]


read = by_type(lambda values: (_one, _two, _three)[values.shape[0] - 1])
"""The vector or the angular velocity in a field of a row; its length is that of the field."""


def _one(values: Array) -> Vector:
    return (values[0],)


def _two(values: Array) -> Vector:
    return values[0], values[1]


def _three(values: Array) -> Vector:
    return values[0], values[1], values[2]


@inlined
def components(values: Array, axes: Vector) -> Vector:
    """The vector in an array: two or three numbers, as many as there are axes or as another vector has."""
    if len(axes) == 2:
        return values[0], values[1]
    return values[0], values[1], values[2]


@inlined
def spin_components(values: Array, axes: Vector) -> Vector:
    """The angular velocity, or the moment, in an array: one number in the plane and three in space."""
    if len(axes) == 2:
        return (values[0],)
    return values[0], values[1], values[2]


@inlined
def put(values: Array, a: Vector) -> None:
    """Write a vector or an angular velocity into an array."""
    values[0] = a[0]
    if len(a) > 1:
        values[1] = a[1]
    if len(a) > 2:
        values[2] = a[2]


@inlined
def increase(values: Array, a: Vector) -> None:
    """Add a vector or an angular velocity to the one in an array."""
    values[0] += a[0]
    if len(a) > 1:
        values[1] += a[1]
    if len(a) > 2:
        values[2] += a[2]


@inlined
def no_spin(axes: Vector) -> Vector:
    """The angular velocity of a body that does not rotate: zero."""
    if len(axes) == 2:
        return (0.0,)
    return 0.0, 0.0, 0.0


@inlined
def plus(a: Vector, b: Vector) -> Vector:
    """a + b."""
    if len(a) == 1:
        return (a[0] + b[0],)
    if len(a) == 2:
        return a[0] + b[0], a[1] + b[1]
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    if len(a) == 1:
        return (a[0] - b[0],)
    if len(a) == 2:
        return a[0] - b[0], a[1] - b[1]
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def scaled(factor: float, a: Vector) -> Vector:
    """A vector or an angular velocity times a number."""
    if len(a) == 1:
        return (factor * a[0],)
    if len(a) == 2:
        return factor * a[0], factor * a[1]
    return factor * a[0], factor * a[1], factor * a[2]


@inlined
def times(a: Vector, b: Vector) -> Vector:
    """The products of the components of two vectors."""
    if len(a) == 2:
        return a[0] * b[0], a[1] * b[1]
    return a[0] * b[0], a[1] * b[1], a[2] * b[2]


@inlined
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    if len(a) == 1:
        return a[0] * b[0]
    if len(a) == 2:
        return a[0] * b[0] + a[1] * b[1]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def norm(a: Vector) -> float:
    """Length of a vector."""
    return math.sqrt(dot(a, a))


@inlined
def spun(spin: Vector, r: Vector) -> Vector:
    """omega x r: the velocity of a point at r from an axis of rotation."""
    if len(r) == 2:
        return spin[0] * r[1], -spin[0] * r[0]
    return spin[1] * r[2] - spin[2] * r[1], spin[2] * r[0] - spin[0] * r[2], spin[0] * r[1] - spin[1] * r[0]


@inlined
def moment(r: Vector, force: Vector) -> Vector:
    """r x force: the moment of a force at r; one number in the plane, three in space."""
    if len(r) == 2:
        return (r[1] * force[0] - r[0] * force[1],)
    return (r[1] * force[2] - r[2] * force[1], r[2] * force[0] - r[0] * force[2], r[0] * force[1] - r[1] * force[0])


@inlined
def tangent(normal: Vector) -> Vector:
    """The direction along a face of the plane, a quarter turn from its normal."""
    return normal[1], -normal[0]


@inlined
def tangents(normal: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors along a face of space, perpendicular to each other and to its unit normal.

    They lose no digits near any axis (Duff et al., Building an orthonormal basis, revisited, Journal of Computer
    Graphics Techniques 6(1), 2017).
    """
    sign = math.copysign(1.0, normal[2])
    a = -1.0 / (sign + normal[2])
    b = normal[0] * normal[1] * a
    first = (1.0 + sign * normal[0] * normal[0] * a, sign * b, -sign * normal[0])
    return first, (b, sign + normal[1] * normal[1] * a, -normal[1])
