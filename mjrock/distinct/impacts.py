"""Flat impacts: the step with which the restitution of two blocks that meet on a whole joint is exact to 1 %.

Such an impact is that of a reduced mass m on the springs K and dashpots C of the joint, of the circular frequency
w = (K / m)^1/2 and the damping ratio r = C / (2 m w). Dashpots take the velocity half a step before the pose. To first
order that acts like a mass less by C h / 2, so that ln |e|, -pi r, falls by pi/2 r^2 w h. Where this is too much, they
look ahead, see `touches.foreseen`, and the step is so short that they brake little within it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..problem.masonry.laws.joint_law import largest_stiffness
from ..quantities import Array
from .system import System

LAGGED = 0.01
"""Error of |e| from which on dashpots look ahead [-]."""
BRAKING = 0.1
"""Step over the time C / m in which dashpots that look ahead stop a block, up to which |e| is exact to 1 % [-]."""
SWINGING = 0.15
"""Step times the circular frequency that is short enough for any damping [-]. From a damping ratio of a third on |e| is
below a third, and its error below 0.5 % of the speed of approach."""


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
        lines, inverse = system.lines, np.asarray(system.bodies["inverse_mass"])
        along = np.asarray(lines["normal"]) ** 2
        light = (inverse[lines["body"]] * along).sum(axis=1)
        light += np.where(lines["face"] >= 0, (inverse[np.maximum(lines["face"], 0)] * along).sum(axis=1), 0.0)
        moves = light > 0  # where guides hold both blocks along the normal there is no impact
        _, first, joint = np.unique(lines["group"][moves], return_index=True, return_inverse=True)
        light = light[moves][first]
        springs = largest_stiffness(lines), lines["c"]
        stiffness, damping = (light * np.bincount(joint, each[moves]) for each in springs)
        frequency = np.sqrt(stiffness)
        return cls(frequency, damping / (2 * frequency))

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
