"""How long a step may be: so that it is stable, and so that flat impacts are exact to 1 %.

The longest stable step follows from the eigenvalues that go into `scene.explicit_step`.

The bound takes the highest eigenvalues of stiffness and of damping with every contact closed, which need not belong to
one mode. Contacts that are found later are softened for the step that a run has, see `softening`.

A flat impact is that of two blocks that meet on a whole joint: of a reduced mass m on the springs K and dashpots C of
the joint, of the circular frequency w = (K / m)^1/2 and the damping ratio r = C / (2 m w). Dashpots take the velocity
half a step before the pose. To first order that acts like a mass less by C h / 2, so that ln |e|, -pi r, falls by pi/2
r^2 w h. Where this is too much, the rate is extrapolated, see `touches.foreseen`, and the step is so short that
dashpots brake little within it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy
from scipy.sparse import block_diag, coo_array, csr_array, vstack

from ..linear import rates_of, times
from ..problem.masonry.blocks.joints_in_space import axes_across
from ..problem.masonry.laws.joint_law import largest_stiffness
from ..quantities import Array
from ..scene.explicit_step import stable_step
from .rotation import roots_of_masses
from .rows import Rows
from .system import System

LEAD = 0.5
"""By how many steps dashpots look ahead: they take the rate at the pose, half a step after the velocity that there is.
In long steps what is foreseen at a contact is worse than that velocity, see `Setup.looks_ahead`."""
STABLE_AHEAD = 0.5
"""Step up to which a dashpot that looks ahead by half a step is stable, over the longest one in which it is stable
otherwise [-]: it acts as one of twice its strength."""
LAGGED = 0.01
"""Error of |e| from which on dashpots look ahead [-]."""
BRAKING = 0.1
"""Step over the time C / m in which dashpots that look ahead stop a block, up to which |e| is exact to 1 % [-]."""
SWINGING = 0.15
"""Step times the circular frequency that is short enough for any damping [-]. From a damping ratio of a third on |e| is
below a third, and its error below 0.5 % of the speed of approach."""


def longest_step(system: System) -> float:
    """The longest stable step [s], infinite where nothing acts but weight."""
    lines, bodies = stiffest_lines(system), len(system.bodies)
    rates = [line_rates(lines, way, bodies) for way in ways_of(np.asarray(lines["normal"]))]
    links = [table for table in system.links if any(of.any() for of in table.springs())]
    rates += [table.rates(system.bodies) for table in links]
    lengths, root = csr_array(vstack(rates)), root_of_masses(system)

    def weights(i: int) -> Array:
        along, across = ((largest_stiffness(lines), lines["k_s"]), (lines["c"], lines["c_s"]))[i]
        ways = [np.where(np.isfinite(lines["k_s"]), across, 0.0)] * (len(system.axes) - 1)
        return np.concatenate([along, *ways, *(table.springs()[i] for table in links)])

    return stable_step(*(highest(lengths, weights(i), root) for i in range(2)))


def rates_of_links(system: System) -> tuple[float, float]:
    """The highest circular frequency of the bodies on the springs of links alone, and the highest rate at which
    dashpots of links without a spring let a velocity decay [1/s]. Actuators, which follow histories, are left out."""
    links = [table for table in system.links if not table.driven and any(of.any() for of in table.springs())]
    if not links:
        return 0.0, 0.0
    k, c = (np.concatenate([table.springs()[i] for table in links]) for i in range(2))
    lengths, root = csr_array(vstack([table.rates(system.bodies) for table in links])), root_of_masses(system)
    return math.sqrt(highest(lengths, k, root)), highest(lengths, np.where(k > 0, 0.0, c), root)


def root_of_masses(system: System) -> csr_array:
    """R with R R^T = M^-1, shape (unknowns, unknowns)."""
    return csr_array(block_diag([coo_array(root) for root in roots_of_masses(system.bodies)]))


def stiffest_lines(system: System) -> Rows:
    """The lines with the largest springs and dashpots that they may have with the laws of their joints."""
    lines = system.lines.copy()
    for law in system.laws:
        for name, most in law.springs().items():
            lines[name][: len(most)] = np.maximum(lines[name][: len(most)], most)
    return lines


def highest(rates: csr_array, weights: Array, root: csr_array) -> float:
    """The highest eigenvalue of M^-1 J^T W J, as that of W^1/2 J M^-1 J^T W^1/2.

    Args:
        rates: J, of lengths for unit velocities, shape (springs, unknowns).
        weights: W, of the springs or dashpots, shape (springs,).
        root: R with R R^T = M^-1.
    """
    acting = np.flatnonzero(weights)
    if not acting.size:
        return 0.0
    scaled = times(np.sqrt(weights[acting]), rates[acting]) @ root
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


class Impacts(NamedTuple):
    """Flat impacts at the joints.

    Args:
        frequency: circular frequency of each without damping [1/s], shape (joints,).
        ratio: its damping ratio [-], likewise.
    """

    frequency: Array
    ratio: Array

    @classmethod
    def at_joints(cls, system: System) -> Impacts:
        """Those of the joints of a system, which are the groups of its lines."""
        lines, inverse = stiffest_lines(system), np.asarray(system.bodies["inverse_mass"])
        along = np.asarray(lines["normal"]) ** 2
        inverse_mass = (inverse[lines["body"]] * along).sum(axis=1)
        inverse_mass += np.where(lines["face"] >= 0, (inverse[np.maximum(lines["face"], 0)] * along).sum(axis=1), 0.0)
        moves = inverse_mass > 0  # where guides hold both blocks along the normal there is no impact
        _, first, joint = np.unique(lines["group"][moves], return_index=True, return_inverse=True)
        inverse_mass = inverse_mass[moves][first]
        springs = largest_stiffness(lines), lines["c"]
        stiffness, damping = (inverse_mass * np.bincount(joint, each[moves]) for each in springs)
        frequency = np.sqrt(stiffness)
        return cls(frequency, damping / (2 * frequency))

    def beside(self, others: Impacts) -> Impacts:
        """These and others."""
        return Impacts(*map(np.concatenate, zip(self, others, strict=True)))

    def lag(self, h: float) -> Array:
        """How much |e| falls in steps of h [s] since dashpots take the velocity half a step before the pose [-]."""
        return np.asarray(0.5 * math.pi * self.ratio**2 * self.frequency * h)

    def step(self, longest: float) -> float:
        """A step no longer than another one with which each |e| is exact to 1 % [s]."""
        lagging = self.lag(longest) > LAGGED
        ratio, frequency = self.ratio[lagging], self.frequency[lagging]
        short = np.maximum(BRAKING / (2 * ratio), SWINGING) / frequency
        return float(short.min(initial=longest))

    def look_ahead(self, h: float) -> bool:
        """Whether dashpots are to look ahead in steps of h [s]: if they lag, and the steps are short enough for it."""
        return bool((self.lag(h) > LAGGED).any()) and self.step(h) > (1 - 1e-9) * h
