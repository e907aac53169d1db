"""The longest stable step of the explicit scheme in space, see `mjrock.distinct.limit`."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, vstack

from ...linear import entries
from ...problem.masonry.joints_in_space import axes_across
from ...quantities import Array, Integers
from ..limit import step_on_springs
from ..system import Rows
from .columns import root_of_masses, vectors
from .system import System


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = system.lines, len(system.bodies)
    normal, arms = vectors(lines, "normal"), (vectors(lines, "at"), vectors(lines, "origin"))
    first, second = np.moveaxis(axes_across(normal), 1, 0)
    pair = np.column_stack([lines["body"], lines["face"]])
    rates = [rates_of(pair, arms, way, bodies) for way in (normal, first, second)]
    links = [link_rates(links, bodies) for links in (system.ties, system.dampers)]
    sprung = np.isfinite(lines["k_s"])

    def weights(along: str, across: str) -> Array:
        shear = np.where(sprung, lines[across], 0.0)
        return np.concatenate([lines[along], shear, shear, system.ties[along], system.dampers[along]])

    masses = root_of_masses(system.bodies)
    return step_on_springs(csr_array(vstack([*rates, *links])), weights("k", "k_s"), weights("c", "c_s"), masses)


def link_rates(links: Rows, bodies: int) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities at rest."""
    between = vectors(links, "between")
    ways = between / np.linalg.norm(between, axis=1)[:, None]
    pair = np.column_stack([links["body"], links["anchor"]])
    return rates_of(pair, (vectors(links, "at"), vectors(links, "origin")), ways, bodies)


def rates_of(pair: Integers, arms: tuple[Array, Array], way: Array, bodies: int) -> csr_array:
    """Rates at which places of pairs of bodies move apart in directions, for unit velocities, shape (rows, 6 bodies).

    Args:
        pair: numbers of the two bodies, negative for one that is fixed, shape (rows, 2).
        arms: from the centroid of each to the place [m], shape (rows, 3) each.
        way: directions, shape (rows, 3).
        bodies: how many there are.

    Returns:
        Rates for velocity and angular velocity in the axes of the world.
    """
    sides = [sign * np.hstack([way, np.cross(arm, way)]) for sign, arm in zip((1.0, -1.0), arms, strict=True)]
    return entries(np.stack(sides, axis=1), np.asarray(pair, dtype=np.int64), 6 * bodies)
