"""The longest stable step of the explicit scheme in space, see `mjrock.distinct.limit`."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from ...linear import rates_of
from ...problem.masonry.joints_in_space import axes_across
from ..limit import step_on_springs
from ..system import Rows, stacked
from .columns import root_of_masses, vectors
from .system import System


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = system.lines, len(system.bodies)
    normal, arms = vectors(lines, "normal"), (vectors(lines, "at"), vectors(lines, "origin"))
    ways, pair = (normal, *np.moveaxis(axes_across(normal), 1, 0)), stacked(lines, ("body", "face"))
    rates = [rates_of(pair, arms, way, bodies) for way in ways]
    rates += [link_rates(links, bodies) for links in (system.ties, system.dampers)]
    return step_on_springs(system, rates, root_of_masses(system.bodies))


def link_rates(links: Rows, bodies: int) -> csr_array:
    """Rates at which ties or dampers lengthen, for unit velocities at rest."""
    between = vectors(links, "between")
    ways = between / np.linalg.norm(between, axis=1)[:, None]
    return rates_of(stacked(links, ("body", "anchor")), (vectors(links, "at"), vectors(links, "origin")), ways, bodies)
