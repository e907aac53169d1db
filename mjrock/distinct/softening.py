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
        shares: of the springs of each place that its two bodies take, shape (2, n).
        stiffness: of each body by its places, shape (bodies, nv, nv).
        loads: trace of this stiffness over the masses of the body, shape (bodies,).
        powers: of the stiffness of a body over its masses, two matrices, shape (2, nv, nv).
        share: of its law that the places of each body have left, and 1 for fixed blocks, shape (bodies + 1,).
    """

    shares: Array
    stiffness: Array
    loads: Array
    powers: Array
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
def stiffen(sides: Sides, along: Array, across: Array, room: Room, axes: tuple[int, ...]) -> None:
    """Write the stiffness of each body by its places, over its shares of them."""
    for b in range(len(room.stiffness)):
        for i in range(room.stiffness.shape[1]):
            for j in range(room.stiffness.shape[1]):
                room.stiffness[b, i, j] = 0.0
    for p in range(len(along)):
        normal = vector(sides.normals, p, axes)
        for way in range(len(axes)):
            direction, k = way_at(normal, way), along[p] if way == 0 else across[p]
            for side in range(2):
                body = sides.bodies[side, p]
                if body >= 0:
                    rate = direction + moment(vector(sides.arms[side], p, axes), direction)
                    for i in range(len(rate)):
                        for j in range(len(rate)):
                            room.stiffness[body, i, j] += k / room.shares[side, p] * rate[i] * rate[j]


@inlined
def split(sides: Sides, room: Room) -> None:
    """Let the two bodies of each place take shares of its springs that go as their loads."""
    for p in range(sides.bodies.shape[1]):
        if sides.bodies[0, p] >= 0 and sides.bodies[1, p] >= 0:
            one, other = room.loads[sides.bodies[0, p]], room.loads[sides.bodies[1, p]]
            if one > 0 and other > 0:
                room.shares[0, p], room.shares[1, p] = one / (one + other), other / (one + other)


@inlined
def over_masses(body: Row, stiffness: Array, rates: Array, axes: tuple[int, ...]) -> float:
    """Write a stiffness over the masses of its body. Returns its trace."""
    trace = 0.0
    for j in range(len(stiffness)):
        column, of_spin = stiffness[:, j], stiffness[len(axes) :, j]
        put(rates[:, j], times(components(body.inverse_mass, axes), components(column, axes)))
        put(rates[len(axes) :, j], spin_from_many(body, spin_components(of_spin, axes)))
        trace += rates[j, j]
    return trace


@inlined
def squared(a: Array, square: Array) -> float:
    """Write the square of a matrix. Returns its trace."""
    trace = 0.0
    for i in range(len(a)):
        for j in range(len(a)):
            square[i, j] = 0.0
            for k in range(len(a)):
                square[i, j] += a[i, k] * a[k, j]
        trace += square[i, i]
    return trace


@compiled
def soften(sides: Sides, along: Array, across: Array, bodies: Rows, room: Room, axes: tuple[int, ...]) -> None:
    """Write the share of their law that the places of each body have left, see `shares_within`.

    Args:
        sides: the two blocks of each place.
        along, across: stiffness along the normal and along the face of each place, shape (n,).
        bodies: whose inverse inertia is taken in the axes of the world, in space.
        room: with shares of 1.
        axes: of the system.
    """
    for turn in range(2):
        stiffen(sides, along, across, room, axes)
        for b in range(len(bodies)):
            trace = room.loads[b] = over_masses(bodies[b], room.stiffness[b], room.powers[0], axes)
            if turn == 1 and trace > 4:
                for i in range(SQUARED):
                    trace = squared(room.powers[i % 2], room.powers[1 - i % 2])
                room.share[b] = 4 / max(trace ** (0.5**SQUARED), 4.0)
        if turn == 0:
            split(sides, room)


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
    d, nv, share = sides.normals.shape[1], 3 * sides.normals.shape[1] - 3, np.ones(len(bodies) + 1)
    stiffness, powers = np.empty((len(bodies), nv, nv)), np.empty((2, nv, nv))
    room = Room(np.ones(sides.bodies.shape), stiffness, np.empty(len(bodies)), powers, share)
    soften(sides, along, across, bodies, room, tuple(range(d)))
    return np.asarray(share[sides.bodies].min(axis=0))
