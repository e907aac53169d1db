"""Softening: the share of their stiffness with which contacts that are found in a run leave its step stable.

The highest eigenvalue of each body is bounded alone. For this a spring between two bodies is replaced by two, one on
each body with the other one held, which together are never softer: (a - b)^2 <= a^2 / s + b^2 / (1 - s) for any share
s. The shares are proportional to the stiffness of all springs of each body over its masses, so that the contacts of a
heavy body on many light ones are not softened because of these. The trace of a power of a matrix bounds its highest
eigenvalue.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import compiled_at_once, inlined
from ...geometry.vectors import (
    Vector,
    components,
    dot,
    moment,
    put,
    read,
    spin_components,
    tangent,
    tangents,
    times,
    vector,
)
from ...problem.masonry.laws.joint_law import Law, largest_stiffness
from ...quantities import Array, Integers
from ...rows import Row, Rows
from ..rotation import spin_from_many
from .constants import SQUARINGS, STABLE


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
        traces: of each place on its two bodies, the trace of its stiffness over the masses of the body, shape (2, n).
        shares: of the springs of each place, in which its two bodies have them, shape (2, n).
        loads: of each body, the sum of these traces, shape (bodies,).
        stiffness: of each body by its places, shape (bodies, nv, nv).
        powers: of the stiffness of a body over its masses, two matrices, shape (2, nv, nv).
        share: of its law that the places of each body have left, and 1 for fixed blocks, shape (bodies + 1,).
    """

    traces: Array
    shares: Array
    loads: Array
    stiffness: Array
    powers: Array
    share: Array


@inlined
def direction_at(normal: Vector, i: int) -> Vector:
    """The normal of a place, or a direction along its face."""
    if i == 0:
        return normal
    if len(normal) == 2:
        return tangent(normal)
    return tangents(normal)[i - 1]


@inlined
def trace_of(body: Row, sides: Sides, side: int, p: int, k_normal: float, k_tangent: float) -> float:
    """The trace of the stiffness of place p over the masses of one of its bodies."""
    masses = read(body.inverse_mass)
    trace, arm, normal = 0.0, vector(sides.arms[side], p, masses), vector(sides.normals, p, masses)
    for k in range(len(masses)):
        direction = direction_at(normal, k)
        turning = moment(arm, direction)
        moved = dot(times(masses, direction), direction)
        trace += (k_normal if k == 0 else k_tangent) * (moved + dot(spin_from_many(body, turning), turning))
    return trace


@inlined
def add_up(sides: Sides, room: Room) -> None:
    """Add up the traces of all places on each body, over its shares of them."""
    for b in range(len(room.loads)):
        room.loads[b] = 0.0
    for side in range(2):
        for p in range(sides.bodies.shape[1]):
            if sides.bodies[side, p] >= 0:
                room.loads[sides.bodies[side, p]] += room.traces[side, p] / room.shares[side, p]


@inlined
def split(sides: Sides, room: Room) -> None:
    """Divide the springs of each place between its two bodies in proportion to their loads."""
    for p in range(sides.bodies.shape[1]):
        if sides.bodies[0, p] >= 0 and sides.bodies[1, p] >= 0:
            load, other_load = room.loads[sides.bodies[0, p]], room.loads[sides.bodies[1, p]]
            if load > 0 and other_load > 0:
                room.shares[0, p], room.shares[1, p] = load / (load + other_load), other_load / (load + other_load)


@inlined
def stiffen(sides: Sides, k_normal: Array, k_tangent: Array, bodies: Rows, room: Room) -> None:
    """Add up the stiffness of each body with much load by its places, over its shares of them."""
    for side in range(2):
        for p in range(len(k_normal)):
            body = sides.bodies[side, p]
            if body < 0 or room.loads[body] <= STABLE:
                continue
            normal = vector(sides.normals, p, read(bodies[body].inverse_mass))
            for n in range(len(normal)):
                direction = direction_at(normal, n)
                rate = direction + moment(vector(sides.arms[side], p, normal), direction)
                k = k_normal[p] if n == 0 else k_tangent[p]
                for i in range(len(rate)):
                    for j in range(len(rate)):
                        room.stiffness[body, i, j] += k / room.shares[side, p] * rate[i] * rate[j]


@inlined
def over_masses(body: Row, stiffness: Array, rates: Array) -> None:
    """Write a stiffness over the masses of its body."""
    masses = read(body.inverse_mass)
    d = len(masses)
    for j in range(len(stiffness)):
        put(rates[:, j], times(masses, components(stiffness[:, j], masses)))
        put(rates[d:, j], spin_from_many(body, spin_components(stiffness[d:, j], masses)))


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


@compiled_at_once
def soften(sides: Sides, k_normal: Array, k_tangent: Array, bodies: Rows, room: Room) -> None:
    """Write the share of their stiffness that the places of each body keep, see `shares_within`.

    Args:
        sides: the two blocks of each place.
        k_normal, k_tangent: stiffness along the normal and along the face of each place, shape (n,).
        bodies: whose inverse inertia is taken in the axes of the world, in space.
        room: with shares of 1 and no stiffness.
    """
    for side in range(2):
        for p in range(len(k_normal)):
            if sides.bodies[side, p] >= 0:
                body = bodies[sides.bodies[side, p]]
                room.traces[side, p] = trace_of(body, sides, side, p, k_normal[p], k_tangent[p])
    add_up(sides, room)
    split(sides, room)
    add_up(sides, room)
    stiffen(sides, k_normal, k_tangent, bodies, room)
    for b in range(len(bodies)):
        if room.loads[b] > STABLE:
            over_masses(bodies[b], room.stiffness[b], room.powers[0])
            trace = 0.0
            for i in range(SQUARINGS):
                trace = squared(room.powers[i % 2], room.powers[1 - i % 2])
            room.share[b] = STABLE / max(trace ** (0.5**SQUARINGS), STABLE)


def shares_within(sides: Sides, law: dict[str, Array], bodies: Rows, step: float) -> Array:
    """Share of its stiffness and damping with which each place leaves a step stable, at most 1, shape (n,).

    Args:
        sides: the two blocks of each place.
        law: the numbers of the law that places have, and `c_s`, by name, shape (n,) each.
        bodies: whose inverse inertia is taken in the axes of the world, in space.
        step: that is to be stable [s].
    """
    k_normal = (
        step**2 * largest_stiffness(Law(**{name: law[name] for name in Law._fields if name in law}))
        + 2 * step * law["c"]
    )
    k_tangent = np.where(np.isfinite(law["k_s"]), step**2 * law["k_s"] + 2 * step * law["c_s"], 0.0)
    nv, share = 3 * sides.normals.shape[1] - 3, np.ones(len(bodies) + 1)
    stiffness, powers = np.zeros((len(bodies), nv, nv)), np.empty((2, nv, nv))
    traces, shares = np.zeros(sides.bodies.shape), np.ones(sides.bodies.shape)
    room = Room(traces, shares, np.empty(len(bodies)), stiffness, powers, share)
    soften(sides, k_normal, k_tangent, bodies, room)
    return np.asarray(share[sides.bodies].min(axis=0))


def unsoftened(share: float, step: float, slow: float) -> float:
    """The step with which a place keeps its whole stiffness, where a longer step leaves it a share [s].

    The limit of a spring is proportional to the square of the step, that of a dashpot to the step.

    Args:
        share: of its law that the longer step leaves [-].
        step: the longer one that is to be stable [s].
        slow: its dashpot over its spring [s].
    """
    damped = 2 * slow / step
    return 0.5 * step * (math.sqrt(damped**2 + 4 * (1 + damped) * share) - damped)
