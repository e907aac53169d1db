"""The longest stable step of a system, from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode. Contacts that are found later are softened for the step that a run has, see `softening`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, vstack
from scipy.sparse.linalg import eigsh

from ..linear import entries, rates_of
from ..problem.masonry.joints_in_space import axes_across
from ..quantities import Array
from ..scene.explicit_step import stable_step
from .rows import Rows
from .system import System
from .turning import roots_of_masses


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = system.lines, len(system.bodies)
    rates = [line_rates(lines, way, bodies) for way in ways_of(np.asarray(lines["normal"]))]
    linked = (system.ties, system.dampers, system.actuators)
    rates += [link_rates(links, bodies) for links in linked[:2]] + [drive_rates(system)]
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


def link_rates(links: Rows, bodies: int) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities at rest."""
    between, arms = np.asarray(links["between"]), (np.asarray(links["at"]), np.asarray(links["origin"]))
    ways = between / np.linalg.norm(between, axis=1)[:, None]
    return rates_of(np.column_stack([links["body"], links["anchor"]]), arms, ways, bodies)


def drive_rates(system: System) -> csr_array:
    """Rates at which what actuators drive moves, for unit velocities at rest: a point, or the centroid of all."""
    actuators, mass, bodies = system.actuators, np.asarray(system.bodies["mass"]), len(system.bodies)
    ways = np.where((actuators["body"] < 0)[:, None], actuators["between"], 0.0)
    turning = np.zeros((len(actuators), 2 * ways.shape[1] - 3))
    shares = np.hstack([ways, turning])[:, None] * (mass / mass.sum())[:, None]
    pairs = np.broadcast_to(np.arange(bodies), shares.shape[:2])
    return csr_array(link_rates(actuators, bodies) + entries(shares, pairs, shares.shape[1] * shares.shape[2]))
