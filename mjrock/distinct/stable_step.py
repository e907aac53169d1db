"""The longest stable step: from the highest eigenvalues of stiffness and of damping over the masses.

They are taken with every contact closed, and need not belong to one mode. The formula is that of
`scene.time_step`. Contacts that are found later are softened for the step of the run, see `softening`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy
from scipy.sparse import csr_array, vstack

from ..linear import block_diagonal, rates_of, scaled_rows
from ..problem.masonry.blocks.joints_in_space import tangent_axes
from ..problem.masonry.laws.joint_law import largest_stiffness
from ..quantities import Array
from ..rows import Rows
from ..scene.time_step import stable_step
from .rotation import roots_of_masses
from .system import System

MANY_SPRINGS = 50_000
"""Springs or dashpots above which the matrix of the highest eigenvalue has a row for each unknown of the bodies [-]. A
wall in space has six times as many springs as unknowns."""


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = stiffest_lines(system), len(system.bodies)
    rates = [line_rates(lines, directions_of(np.asarray(lines["normal"])), bodies)]
    links = [table for table in system.links if any(springs.any() for springs in table.springs())]
    rates += [table.rates(system.bodies) for table in links]
    lengths = rates[0] if not links else csr_array(vstack(rates))
    root = root_of_masses(system)

    def weights(i: int) -> Array:
        normal, shear = ((largest_stiffness(lines), lines["k_s"]), (lines["c"], lines["c_s"]))[i]
        along_faces = [np.where(np.isfinite(lines["k_s"]), shear, 0.0)] * (len(system.axes) - 1)
        return np.concatenate([normal, *along_faces, *(table.springs()[i] for table in links)])

    return stable_step(*(highest(lengths, weights(i), root) for i in range(2)))


def rates_of_links(system: System) -> tuple[float, float]:
    """The highest circular frequency of the bodies on the springs of links alone, and the highest rate at which
    dashpots of links without a spring let a velocity decay [1/s]. Actuators, which follow histories, are left out."""
    links = [table for table in system.links if not table.driven and any(springs.any() for springs in table.springs())]
    if not links:
        return 0.0, 0.0
    k, c = (np.concatenate([table.springs()[i] for table in links]) for i in range(2))
    lengths, root = csr_array(vstack([table.rates(system.bodies) for table in links])), root_of_masses(system)
    return math.sqrt(highest(lengths, k, root)), highest(lengths, np.where(k > 0, 0.0, c), root)


def root_of_masses(system: System) -> csr_array:
    """R with R R^T = M^-1, shape (unknowns, unknowns)."""
    return block_diagonal(roots_of_masses(system.bodies))


def stiffest_lines(system: System) -> Rows:
    """The lines with the largest springs and dashpots that they may have with the laws of their joints, with columns as
    attributes, as the law of a joint reads them."""
    lines = system.lines.copy().view(np.recarray)
    for law in system.laws:
        for name, largest in law.springs().items():
            lines[name][: len(largest)] = np.maximum(lines[name][: len(largest)], largest)
    return lines


def highest(rates: csr_array, weights: Array, root: csr_array) -> float:
    """The highest eigenvalue of M^-1 J^T W J, as that of W^1/2 J M^-1 J^T W^1/2.

    Of many springs it is that of R^T J^T W J R, which has a row for each unknown of the bodies. Both are equal within
    the tolerance of the search, 1e-3.

    Args:
        rates: J, of lengths for unit velocities, shape (springs, unknowns).
        weights: W, of the springs or dashpots, shape (springs,).
        root: R with R R^T = M^-1.
    """
    stiff = np.flatnonzero(weights)
    if not stiff.size:
        return 0.0
    scaled = scaled_rows(np.sqrt(weights[stiff]), rates[stiff]) @ root
    matrix = scaled.T @ scaled if len(stiff) > MANY_SPRINGS else scaled @ scaled.T
    if len(stiff) <= 20:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    start = np.random.default_rng(0).random(matrix.shape[0])
    largest = scipy.sparse.linalg.eigsh(matrix, 1, which="LA", tol=1e-3, v0=start, return_eigenvectors=False)[0]
    return 1.01 * float(largest)  # an allowance for the tolerance


def directions_of(normal: Array) -> tuple[Array, ...]:
    """Unit vectors along the normals of lines, and along their faces one in the plane and two in space, (m, d) each."""
    if normal.shape[1] == 2:
        return normal, np.column_stack([normal[:, 1], -normal[:, 0]])
    return normal, *np.moveaxis(tangent_axes(normal), 1, 0)


def line_rates(lines: Rows, directions: Sequence[Array], bodies: int) -> csr_array:
    """Rates at which the points of lines move over their faces in directions of each, one after the other, for unit
    velocities at rest."""
    times = len(directions), 1
    arms = np.tile(lines["at"], times), np.tile(lines["origin"], times)
    pair = np.tile(np.column_stack([lines["body"], lines["face"]]), times)
    return rates_of(pair, arms, np.concatenate(directions), bodies)
