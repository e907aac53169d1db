"""The longest stable step of a system, from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode. Contacts that are found later are softened until the step that a run has is stable for each body among them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import block_diag, csr_array, diags_array, vstack
from scipy.sparse.linalg import eigsh

from ..linear import rates_of
from ..problem.masonry.joints_in_space import axes_across
from ..quantities import Array, Integers
from ..scene.explicit_step import stable_step
from .rows import Rows
from .system import System
from .turning import roots_of_masses


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = system.lines, len(system.bodies)
    rates = [line_rates(lines, way, bodies) for way in ways_of(np.asarray(lines["normal"]))]
    linked = (system.ties, system.dampers, system.actuators)
    rates += [link_rates(links, bodies) for links in linked]
    lengths, root = csr_array(vstack(rates)), csr_array(block_diag(roots_of_masses(system.bodies)))

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


class Side(NamedTuple):
    """One of the two blocks of each place, in its axes.

    Args:
        body: its number, negative for a fixed block, shape (n,).
        arm: from its centroid to the place [m], shape (n, d).
        ways: the normal and the directions along the face, shape (n, d) each.
    """

    body: Integers
    arm: Array
    ways: tuple[Array, ...]


def yields_of(roots: Array, d: int) -> tuple[Array, Array]:
    """Inverse mass [1/kg] and largest inverse inertia [1/(kg m2)] of each body in d dimensions, shape (bodies,) each,
    from the roots that `shares_within` takes."""
    return roots[:, 0, 0] ** 2, np.linalg.norm(roots[:, d:, d:], ord=2, axis=(1, 2)) ** 2


def sums_of_yields(
    bodies: tuple[Integers, Integers],
    arms: Sequence[Array],
    law: dict[str, Array],
    yields: tuple[Array, Array],
    step: float,
) -> Array:
    """A quick bound of the highest eigenvalue that `shares_within` holds at 4, never too low, shape (bodies,).

    A place adds to that of a body at most its stiffest way, over what mass and inertia of both blocks yield to it.

    Args:
        bodies: the two of each place, negative for a fixed block, shape (n,) each.
        arms: from their centroids to the places [m], shape (n, d) each.
        law, step: as `shares_within` takes them.
        yields: of the bodies, see `yields_of`.
    """
    across = np.where(np.isfinite(law["k_s"]), step**2 * law["k_s"] + 2 * step * law["c_s"], 0.0)
    weight = np.maximum(step**2 * law["k"] + 2 * step * law["c"], across)
    linear, spun = yields
    for_unit = [
        np.where(body >= 0, linear[body] + np.sum(arm**2, axis=1) * spun[body], 0.0)
        for body, arm in zip(bodies, arms, strict=True)
    ]
    pairs, added = np.concatenate(bodies), np.tile(weight * (for_unit[0] + for_unit[1]), 2)
    return np.asarray(np.bincount(pairs[pairs >= 0], added[pairs >= 0], len(linear)))


def shares_within(sides: tuple[Side, Side], law: dict[str, Array], roots: Array, step: float) -> Array:
    """Share of its stiffness and damping with which each place leaves a step stable, at most 1, shape (n,).

    Each body is bounded alone. For this a spring between two bodies counts in each of them, stiffer by what both yield
    over what this one does.

    Args:
        sides: the two blocks of each place.
        law: `k`, `c`, `k_s` and `c_s` of the places.
        roots: of each body a matrix whose product with its transpose is the inverse of its masses, (bodies, nv, nv).
        step: that is to be stable [s].
    """
    sprung, along = np.isfinite(law["k_s"]), len(sides[0].ways) - 1
    across = np.where(sprung, step**2 * law["k_s"] + 2 * step * law["c_s"], 0.0)
    weight = np.column_stack([step**2 * law["k"] + 2 * step * law["c"], *[across] * along])
    rates = [_rates(side, roots) for side in sides]
    yields = [np.sum(rate**2, axis=2) for rate in rates]
    both, share = yields[0] + yields[1], np.ones(len(weight))
    for side, rate, own in zip(sides, rates, yields, strict=True):
        scaled = rate * np.sqrt(weight * both / np.where(own > 0, own, np.inf))[:, :, None]
        bodies, of = np.unique(side.body, return_inverse=True)
        matrix = np.zeros((len(bodies), *roots.shape[1:]))
        np.add.at(matrix, of, np.einsum("nwi,nwj->nij", scaled, scaled))
        share = np.minimum(share, 4 / np.maximum(np.linalg.eigvalsh(matrix)[:, -1], 4.0)[of])
    return share


def _rates(side: Side, roots: Array) -> Array:
    """Rates of the ways of places for unit velocities over the root of the masses, shape (n, ways, nv)."""
    ways, free = np.stack(side.ways, axis=1), side.body >= 0
    arm = np.broadcast_to(side.arm[:, None], ways.shape)
    plane = ways.shape[2] == 2
    spin = arm[..., 1:] * ways[..., :1] - arm[..., :1] * ways[..., 1:] if plane else np.cross(arm, ways)
    return np.where(free[:, None, None], np.concatenate([ways, spin], axis=2) @ roots[side.body], 0.0)


def link_rates(links: Rows, bodies: int) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities at rest."""
    between, arms = np.asarray(links["between"]), (np.asarray(links["at"]), np.asarray(links["origin"]))
    ways = between / np.linalg.norm(between, axis=1)[:, None]
    return rates_of(np.column_stack([links["body"], links["anchor"]]), arms, ways, bodies)
