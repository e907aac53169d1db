"""The longest stable step of a system, from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode. Contacts that are found later are softened until the step that a run has is stable for each body among them.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, vstack
from scipy.sparse.linalg import eigsh

from ..compiled import compiled, inlined
from ..geometry.vectors import Vector, moment, tangent, tangents, vector
from ..linear import rates_of
from ..problem.masonry.joints_in_space import axes_across
from ..quantities import Array, Integers
from ..scene.explicit_step import stable_step
from .rows import Rows
from .system import System
from .turning import roots_of_masses

SQUARED = 4
"""How often a matrix is squared before its trace is taken. The trace of the 16th power of a matrix of six rows bounds
the highest eigenvalue by 1.12 times what it is."""


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = system.lines, len(system.bodies)
    rates = [line_rates(lines, way, bodies) for way in ways_of(np.asarray(lines["normal"]))]
    linked = (system.ties, system.dampers, system.actuators)
    rates += [link_rates(links, bodies) for links in linked]
    lengths, root = (
        csr_array(vstack(rates)),
        csr_array(block_diag([coo_array(root) for root in roots_of_masses(system.bodies)])),
    )

    def weights(along: str, across: str) -> Array:
        shear = np.where(np.isfinite(lines["k_s"]), lines[across], 0.0)
        ways = [shear] * (len(system.axes) - 1)
        return np.concatenate([lines[along], *ways, *(links[along] for links in linked)])

    return stable_step(highest(lengths, weights("k", "k_s"), root), highest(lengths, weights("c", "c_s"), root))


def highest(rates: csr_array, weights: Array, root: Any) -> float:
    """The highest eigenvalue of M^-1 J^T W J, as that of W^1/2 J M^-1 J^T W^1/2.

    Args:
        rates: J, of lengths for unit velocities, shape (springs, unknowns).
        weights: W, of the springs or dashpots, shape (springs,).
        root: R with R R^T = M^-1.
    """
    acting = np.flatnonzero(weights)
    if not acting.size:
        return 0.0
    scaled = diags_array(np.sqrt(weights[acting])) @ rates[acting] @ root
    matrix = scaled @ scaled.T
    if len(acting) <= 20:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    start = np.random.default_rng(0).random(len(acting))
    largest = eigsh(matrix, 1, which="LA", tol=1e-3, v0=start, return_eigenvectors=False)[0]
    return 1.01 * float(largest)  # an allowance for the tolerance


def ways_of(normal: Array) -> tuple[Array, ...]:
    """Unit vectors along the normals of lines, and along their faces one in the plane and two in space, (m, d) each."""
    if normal.shape[1] == 2:
        return normal, np.column_stack([normal[:, 1], -normal[:, 0]])
    return normal, *np.moveaxis(axes_across(normal), 1, 0)


def line_rates(lines: Rows, way: Array, bodies: int) -> csr_array:
    """Rates at which the points of lines move over their faces in directions, for unit velocities at rest."""
    arms = np.asarray(lines["at"]), np.asarray(lines["origin"])
    return rates_of(np.column_stack([lines["body"], lines["face"]]), arms, way, bodies)


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
        shares: of each spring that its two bodies take, shape (2, n).
        loads: trace of the springs of each body over its masses, shape (bodies,).
        stiffness: of each body, in the axes of the world, shape (bodies, nv, nv).
        powers: two matrices, shape (2, nv, nv).
        share: of its law that the places of each body have left, and 1 for fixed blocks, shape (bodies + 1,).
    """

    shares: Array
    loads: Array
    stiffness: Array
    powers: Array
    share: Array


@inlined
def add_spring(sides: Sides, p: int, way: Vector, k: float, shares: Array, stiffness: Array) -> None:
    """Add a spring of stiffness k at place p along a way to the stiffness of both bodies, over their shares of it."""
    for side in range(2):
        body = sides.bodies[side, p]
        if body >= 0:
            rate, k_here = way + moment(vector(sides.arms[side], p, way), way), k / shares[side, p]
            for i in range(len(rate)):
                for j in range(len(rate)):
                    stiffness[body, i, j] += k_here * rate[i] * rate[j]


@inlined
def add_springs(sides: Sides, along: Array, across: Array, room: Room, axes: tuple[int, ...]) -> None:
    """Add the springs of places along their normal and their face to the stiffness of their bodies."""
    for p in range(len(along)):
        normal = vector(sides.normals, p, axes)
        add_spring(sides, p, normal, along[p], room.shares, room.stiffness)
        if across[p] > 0:
            if len(axes) == 2:
                add_spring(sides, p, tangent(normal), across[p], room.shares, room.stiffness)
            else:
                for way in tangents(normal):
                    add_spring(sides, p, way, across[p], room.shares, room.stiffness)


@inlined
def split(sides: Sides, room: Room) -> None:
    """Let the two bodies of each place take shares of its springs that go as their loads."""
    for p in range(sides.bodies.shape[1]):
        if sides.bodies[0, p] >= 0 and sides.bodies[1, p] >= 0:
            one, other = room.loads[sides.bodies[0, p]], room.loads[sides.bodies[1, p]]
            if one > 0 and other > 0:
                room.shares[0, p], room.shares[1, p] = one / (one + other), other / (one + other)


@inlined
def multiply(a: Array, b: Array, product: Array) -> float:
    """Write the product of two square matrices. Returns its trace."""
    trace = 0.0
    for i in range(len(a)):
        for j in range(len(a)):
            product[i, j] = 0.0
            for k in range(len(a)):
                product[i, j] += a[i, k] * b[k, j]
        trace += product[i, i]
    return trace


@compiled
def soften(sides: Sides, along: Array, across: Array, inverse: Array, room: Room, axes: tuple[int, ...]) -> None:
    """Write the share of their law that the places of each body have left, see `shares_within`.

    Args:
        sides: the two blocks of each place.
        along, across: stiffness along the normal and along the face of each place, shape (n,).
        inverse: of the masses of each body, shape (bodies, nv, nv).
        room: with shares of 1.
        axes: of the system.
    """
    for turn in range(2):
        for b in range(len(inverse)):
            for i in range(inverse.shape[1]):
                for j in range(inverse.shape[1]):
                    room.stiffness[b, i, j] = 0.0
        add_springs(sides, along, across, room, axes)
        for b in range(len(inverse)):
            room.loads[b] = multiply(inverse[b], room.stiffness[b], room.powers[0])
            if turn == 1 and room.loads[b] > 4:
                trace = 0.0
                for i in range(SQUARED):
                    trace = multiply(room.powers[i % 2], room.powers[i % 2], room.powers[1 - i % 2])
                room.share[b] = 4 / max(trace ** (0.5**SQUARED), 4.0)
        if turn == 0:
            split(sides, room)


def shares_within(sides: Sides, law: dict[str, Array], inverse: Array, step: float) -> Array:
    """Share of its stiffness and damping with which each place leaves a step stable, at most 1, shape (n,).

    Each body is bounded alone. For this a spring between two bodies is taken as two, one on each body with the other
    one held, which together are never softer: (a - b)^2 <= a^2 / s + b^2 / (1 - s) for any share s. The shares go as
    what all springs of each body are over its masses, so that a heavy body on many light ones is not softened for them.
    The trace of a power of a matrix bounds its highest eigenvalue.

    Args:
        sides: the two blocks of each place.
        law: `k`, `c`, `k_s` and `c_s` of the places, shape (n,) each.
        inverse: of the masses of each body in the axes of the world, shape (bodies, nv, nv).
        step: that is to be stable [s].
    """
    along = step**2 * law["k"] + 2 * step * law["c"]
    across = np.where(np.isfinite(law["k_s"]), step**2 * law["k_s"] + 2 * step * law["c_s"], 0.0)
    bodies, nv = inverse.shape[:2]
    shares, share, powers = np.ones(sides.bodies.shape), np.ones(bodies + 1), np.empty((2, nv, nv))
    room = Room(shares, np.empty(bodies), np.empty_like(inverse), powers, share)
    soften(sides, along, across, inverse, room, tuple(range(sides.normals.shape[1])))
    return np.asarray(share[sides.bodies].min(axis=0))


def link_rates(links: Rows, bodies: int) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities at rest."""
    between, arms = np.asarray(links["between"]), (np.asarray(links["at"]), np.asarray(links["origin"]))
    ways = between / np.linalg.norm(between, axis=1)[:, None]
    return rates_of(np.column_stack([links["body"], links["anchor"]]), arms, ways, bodies)
