"""The longest stable step of a system, from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack
from scipy.sparse.linalg import eigsh

from ..quantities import Array, Integers
from ..scene.explicit_step import stable_step
from .system import Rows, System

SMALL = 20
"""Number of springs up to which the eigenvalues are those of a full matrix."""
ALLOWANCE = 1.01
"""Allowance for the tolerance of the search for an eigenvalue [-]."""


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, ties, dampers = system.lines, system.ties, system.dampers
    along = line_rates(system, lines["normal_z"], -lines["normal_x"])
    rates = csr_array(
        vstack(
            [
                line_rates(system, lines["normal_x"], lines["normal_z"]),
                along,
                link_rates(system, ties),
                link_rates(system, dampers),
            ]
        )
    )
    sprung = np.isfinite(lines["k_s"])
    shear = [np.where(sprung, lines[name], 0.0) for name in ("k_s", "c_s")]
    bodies = system.bodies
    ease = np.column_stack([1 / bodies["mass"], 1 / bodies["mass"], bodies["ease"]]).ravel()
    return step_on_springs(
        rates,
        np.concatenate([lines["k"], shear[0], ties["k"], dampers["k"]]),
        np.concatenate([lines["c"], shear[1], ties["c"], dampers["c"]]),
        diags_array(np.sqrt(ease)),
    )


def step_on_springs(rates: csr_array, k: Array, c: Array, root: Any) -> float:
    """The longest stable step [s] on springs k and dashpots c, whose lengths have these rates.

    Args:
        rates: of the lengths of the springs, for unit velocities, shape (springs, unknowns).
        k, c: of each spring [N/m, N s/m].
        root: R with R R^T = M^-1, of masses on a diagonal 1 / sqrt(m).
    """
    return stable_step(highest(rates, k, root), highest(rates, c, root))


def highest(rates: csr_array, weights: Array, root: Any) -> float:
    """The highest eigenvalue of M^-1 J^T W J, as that of W^1/2 J M^-1 J^T W^1/2."""
    acting = np.flatnonzero(weights)
    if not acting.size:
        return 0.0
    scaled = diags_array(np.sqrt(weights[acting])) @ rates[acting] @ root
    matrix = scaled @ scaled.T
    if len(acting) <= SMALL:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    start = np.random.default_rng(0).random(len(acting))
    return ALLOWANCE * float(eigsh(matrix, 1, which="LA", tol=1e-3, v0=start, return_eigenvectors=False)[0])


def line_rates(system: System, x: Array, z: Array) -> csr_array:
    """Rates at which the points of the lines move over their faces in the directions x, z, for unit velocities."""
    lines, bodies = system.lines, system.bodies
    own, on_body = lines["body"], np.flatnonzero(lines["face"] >= 0).astype(np.int64)
    face = lines["face"][on_body]
    arms = [lines[f"at_{axis}"] + bodies[f"{axis}0"][own] for axis in "xz"]
    rates = entries(
        system,
        np.arange(len(own), dtype=np.int64),
        own,
        [arms[0] - bodies["x0"][own], arms[1] - bodies["z0"][own]],
        x,
        z,
    )
    others = [arms[0][on_body] - bodies["x0"][face], arms[1][on_body] - bodies["z0"][face]]
    return rates - entries(system, on_body, face, others, x[on_body], z[on_body], len(own))


def link_rates(system: System, links: Rows) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities."""
    x, z = links["between_x"], links["between_z"]
    size = np.hypot(x, z)
    return entries(
        system, np.arange(len(links), dtype=np.int64), links["body"], [links["at_x"], links["at_z"]], x / size, z / size
    )


def entries(
    system: System, row: Integers, body: Integers, arms: list[Array], x: Array, z: Array, count: int | None = None
) -> csr_array:
    """A matrix whose rows hold the rates, in the directions x, z, of points at arms from the centroids of bodies."""
    values = np.column_stack([x, z, arms[1] * x - arms[0] * z])
    places = np.repeat(row, 3), (3 * body[:, None] + np.arange(3)).ravel()
    shape = (len(row) if count is None else count, 3 * len(system.bodies))
    return csr_array((values.ravel(), places), shape=shape)
