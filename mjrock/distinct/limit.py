"""The longest stable step of a system, from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode. Contacts that are found later are softened for the step that a run has, see `softening`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, vstack

from ..linear import rates_of
from ..problem.masonry.blocks.joints_in_space import axes_across
from ..problem.masonry.laws.joint_law import largest_stiffness
from ..quantities import Array
from ..scene.explicit_step import stable_step
from .rows import Rows
from .system import System
from .turning import roots_of_masses


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = system.lines, len(system.bodies)
    rates = [line_rates(lines, way, bodies) for way in ways_of(np.asarray(lines["normal"]))]
    links = [table for table in system.links if any(of.any() for of in table.springs())]
    rates += [table.rates(system.bodies) for table in links]
    lengths, root = (
        csr_array(vstack(rates)),
        csr_array(block_diag([coo_array(root) for root in roots_of_masses(system.bodies)])),
    )

    def weights(i: int) -> Array:
        along, across = ((largest_stiffness(lines), lines["k_s"]), (lines["c"], lines["c_s"]))[i]
        ways = [np.where(np.isfinite(lines["k_s"]), across, 0.0)] * (len(system.axes) - 1)
        return np.concatenate([along, *ways, *(table.springs()[i] for table in links)])

    return stable_step(*(highest(lengths, weights(i), root) for i in range(2)))


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
    largest = scipy.sparse.linalg.eigsh(matrix, 1, which="LA", tol=1e-3, v0=start, return_eigenvectors=False)[0]
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
