"""Softening: how much of its law a place has that is found in a run, so that the step of the run stays stable.

Each body is bounded alone. For this a spring between two bodies is taken as two, one on each body with the other one
held, which together are never softer: (a - b)^2 <= a^2 / s + b^2 / (1 - s) for any share s. The shares go as what all
springs of each body are over its masses, so that a heavy body on many light ones is not softened for them. The trace of
a power of a matrix bounds its highest eigenvalue.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.vectors import (
    Vector,
    components,
    dot,
    moment,
    put,
    spin_components,
    tangent,
    tangents,
    times,
    vector,
)
from ..quantities import Array, Integers
from .rows import Row, Rows
from .turning import spin_from_many

SQUARED = 4
"""How often a matrix is squared before its trace is taken. The trace of the 16th power of a matrix of six rows bounds
the highest eigenvalue by 1.12 times what it is."""


class Sides(NamedTuple):
    """The two blocks of each place.

    Args:
        bodies: their numbers, negative for a fixed block, shape (2, n).
        arms: from their centroids to the place [m], shape (2, n, d).
        normals: of the places, shape (n, d).
    """

    bodies: Integers
    arms: Array
    normals: Array


class Room(NamedTuple):
    """Room for `soften`.

    Args:
        over: trace of the springs of each place over the masses of its two bodies, shape (2, n).
        shares: of them that the two bodies take, shape (2, n).
        loads: sum of these traces over the places of each body, shape (bodies,).
        matrices: stiffness of a body, and two powers of its rates, shape (3, nv, nv).
        share: of its law that the places of each body have left, and 1 for fixed blocks, shape (bodies + 1,).
    """

    over: Array
    shares: Array
    loads: Array
    matrices: Array
    share: Array


@inlined
def way_at(normal: Vector, i: int) -> Vector:
    """The normal of a place, or a direction along its face."""
    if i == 0:
        return normal
    if len(normal) == 2:
        return tangent(normal)
    return tangents(normal)[i - 1]


@inlined
def square_of(body: Row, rate: Vector, lever: Vector) -> float:
    """Square of a rate of the centroid and a lever, over the masses of a body."""
    of_spin = dot(spin_from_many(body, lever), lever)
    square: float = dot(times(components(body.inverse_mass, rate), rate), rate) + of_spin
    return square


@inlined
def load(sides: Sides, along: Array, across: Array, bodies: Rows, room: Room, axes: tuple[int, ...]) -> None:
    """Write what the springs of each place are over the masses of its bodies, and let these take shares of them."""
    for p in range(len(along)):
        normal = vector(sides.normals, p, axes)
        for side in range(2):
            for i in range(len(axes)):
                way, body = way_at(normal, i), sides.bodies[side, p]
                if body >= 0:
                    k, lever = along[p] if i == 0 else across[p], moment(vector(sides.arms[side], p, axes), way)
                    room.over[side, p] += k * square_of(bodies[body], way, lever)
    add_loads(sides, room)
    for p in range(len(along)):
        if sides.bodies[0, p] >= 0 and sides.bodies[1, p] >= 0:
            one, other = room.loads[sides.bodies[0, p]], room.loads[sides.bodies[1, p]]
            if one > 0 and other > 0:
                room.shares[0, p], room.shares[1, p] = one / (one + other), other / (one + other)
    add_loads(sides, room)


@inlined
def add_loads(sides: Sides, room: Room) -> None:
    """Sum what the places of each body are, over their shares."""
    for b in range(len(room.loads)):
        room.loads[b] = 0.0
    for p in range(room.over.shape[1]):
        for side in range(2):
            if sides.bodies[side, p] >= 0:
                room.loads[sides.bodies[side, p]] += room.over[side, p] / room.shares[side, p]


@inlined
def stiffen(
    sides: Sides, along: Array, across: Array, b: int, shares: Array, stiffness: Array, axes: tuple[int, ...]
) -> None:
    """Write the stiffness of the places of body b, over its shares of them."""
    for i in range(len(stiffness)):
        for j in range(len(stiffness)):
            stiffness[i, j] = 0.0
    for p in range(len(along)):
        for side in range(2):
            if sides.bodies[side, p] == b:
                normal, arm = vector(sides.normals, p, axes), vector(sides.arms[side], p, axes)
                for way in range(len(axes)):
                    direction, k = way_at(normal, way), (along[p] if way == 0 else across[p]) / shares[side, p]
                    rate = direction + moment(arm, direction)
                    for i in range(len(rate)):
                        for j in range(len(rate)):
                            stiffness[i, j] += k * rate[i] * rate[j]


@inlined
def take_rates(body: Row, stiffness: Array, rates: Array, axes: tuple[int, ...]) -> None:
    """Write a stiffness over the masses of its body."""
    for j in range(len(stiffness)):
        column, of_spin = stiffness[:, j], stiffness[len(axes) :, j]
        put(rates[:, j], times(components(body.inverse_mass, axes), components(column, axes)))
        put(rates[len(axes) :, j], spin_from_many(body, spin_components(of_spin, axes)))


@inlined
def multiply(a: Array, product: Array) -> float:
    """Write the square of a matrix. Returns its trace."""
    trace = 0.0
    for i in range(len(a)):
        for j in range(len(a)):
            product[i, j] = 0.0
            for k in range(len(a)):
                product[i, j] += a[i, k] * a[k, j]
        trace += product[i, i]
    return trace


@compiled
def soften(sides: Sides, along: Array, across: Array, bodies: Rows, room: Room, axes: tuple[int, ...]) -> None:
    """Write the share of their law that the places of each body have left, see `shares_within`.

    Args:
        sides: the two blocks of each place.
        along, across: stiffness along the normal and along the face of each place, shape (n,).
        bodies: whose inverse inertia is taken, in space.
        room: with traces of 0 and shares of 1.
        axes: of the system.
    """
    load(sides, along, across, bodies, room, axes)
    for b in range(len(bodies)):
        if room.loads[b] > 4:
            stiffen(sides, along, across, b, room.shares, room.matrices[0], axes)
            take_rates(bodies[b], room.matrices[0], room.matrices[1], axes)
            trace = 0.0
            for i in range(SQUARED):
                trace = multiply(room.matrices[1 + i % 2], room.matrices[2 - i % 2])
            room.share[b] = 4 / max(trace ** (0.5**SQUARED), 4.0)


def shares_within(sides: Sides, law: dict[str, Array], bodies: Rows, step: float) -> Array:
    """Share of its stiffness and damping with which each place leaves a step stable, at most 1, shape (n,).

    Args:
        sides: the two blocks of each place.
        law: `k`, `c`, `k_s` and `c_s` of the places, shape (n,) each.
        bodies: whose inverse inertia is taken in the axes of the world, in space.
        step: that is to be stable [s].
    """
    along = step**2 * law["k"] + 2 * step * law["c"]
    across = np.where(np.isfinite(law["k_s"]), step**2 * law["k_s"] + 2 * step * law["c_s"], 0.0)
    d, shape = sides.normals.shape[1], sides.bodies.shape
    share, matrices = np.ones(len(bodies) + 1), np.empty((3, 3 * d - 3, 3 * d - 3))
    room = Room(np.zeros(shape), np.ones(shape), np.empty(len(bodies)), matrices, share)
    soften(sides, along, across, bodies, room, tuple(range(d)))
    return np.asarray(share[sides.bodies].min(axis=0))
