"""The longest stable step of a system, from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack
from scipy.sparse.linalg import eigsh

from ..linear import rates_of
from ..quantities import Array
from ..scene.explicit_step import stable_step
from .system import Rows, System, stacked


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    bodies = system.bodies
    rates = [line_rates(system, way) for way in ways_of(system.lines)]
    rates += [link_rates(links, len(bodies)) for links in (system.ties, system.dampers)]
    ease = np.column_stack([1 / bodies["mass"], 1 / bodies["mass"], bodies["ease"]]).ravel()
    return step_on_springs(system, rates, diags_array(np.sqrt(ease)))


def step_on_springs(system: Any, rates: Sequence[csr_array], root: Any) -> float:
    """The longest stable step of a system in the plane or in space [s].

    Args:
        system: the springs and dashpots.
        rates: of lengths, for unit velocities: of the lines along their normals and then along the ways on their faces,
            of the ties and of the dampers, shape (springs, unknowns) each.
        root: R with R R^T = M^-1, of masses on a diagonal 1 / sqrt(m).
    """
    lines, lengths = system.lines, csr_array(vstack(rates))

    def weights(along: str, across: str) -> Array:
        shear = np.where(np.isfinite(lines["k_s"]), lines[across], 0.0)
        ways = [shear] * (len(rates) - 3)
        return np.concatenate([lines[along], *ways, system.ties[along], system.dampers[along]])

    return stable_step(highest(lengths, weights("k", "k_s"), root), highest(lengths, weights("c", "c_s"), root))


def highest(rates: csr_array, weights: Array, root: Any) -> float:
    """The highest eigenvalue of M^-1 J^T W J, as that of W^1/2 J M^-1 J^T W^1/2."""
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


def ways_of(lines: Rows) -> tuple[Array, Array]:
    """Unit vectors along the normals of lines, and along their faces, shape (m, 2) each."""
    x, z = lines["normal_x"], lines["normal_z"]
    return np.column_stack([x, z]), np.column_stack([z, -x])


def line_rates(system: System, way: Array) -> csr_array:
    """Rates at which the points of the lines move over their faces in directions, for unit velocities."""
    lines, rest = system.lines, stacked(system.bodies, ("x0", "z0"))
    place = stacked(lines, ("at_x", "at_z")) + rest[lines["body"]]
    arms = place - rest[lines["body"]], place - rest[lines["face"]]
    return rates_of(stacked(lines, ("body", "face")), arms, way, len(rest))


def link_rates(links: Rows, bodies: int) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities."""
    at, between = stacked(links, ("at_x", "at_z")), stacked(links, ("between_x", "between_z"))
    ways = between / np.hypot(*between.T)[:, None]
    return rates_of(np.column_stack([links["body"], np.full(len(links), -1)]), (at, at), ways, bodies)
