"""What every peer is asked, in plain numbers, and what it answers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

GRAVITY = 9.81
"""Acceleration of gravity [m/s2]."""
SAMPLING = 5e-4
"""Spacing of the answers [s]; a longer step gives fewer."""

Motion = tuple[NDArray[Any], NDArray[Any], NDArray[Any]]
"""Times [s], rotations [rad] and angular velocities [rad/s]; the rotation is positive away from the side stop."""


@dataclass(frozen=True)
class Question:
    """A wall that is released at rest from a rotation about its outer edge.

    Args:
        thickness, height, length: size of the wall [m].
        mass: mass [kg].
        theta0: release rotation [rad].
        duration: simulated time [s].
        side_stop: whether a rigid stop covers the inner face.
        k_base, c_base: spring and dashpot of one edge of the base [N/m, N s/m].
        k_side, c_side: those of the top or bottom edge of the inner face [N/m, N s/m].
        e: |e| of a rebound that a code of rigid bodies is given at the stop [-].
    """

    thickness: float
    height: float
    length: float
    mass: float
    theta0: float
    duration: float
    side_stop: bool
    k_base: float
    c_base: float
    k_side: float
    c_side: float
    e: float

    @property
    def weight(self) -> float:
        """The weight [N]."""
        return self.mass * GRAVITY

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centroid [kg m2]."""
        return self.mass * (self.thickness**2 + self.height**2) / 12

    def centroid(self, *, settled: bool) -> tuple[float, float]:
        """Across and up, from the middle of the base, on the outer edge; `settled` into the spring of that edge [m]."""
        b, h, turn = self.thickness / 2, self.height / 2, self.theta0
        load = self.weight * (1 - 0.75 * math.sin(math.atan2(b, h) - turn) ** 2)  # as it begins to turn
        sunk = load / self.k_base if settled else 0.0
        return b - b * math.cos(turn) + h * math.sin(turn), b * math.sin(turn) + h * math.cos(turn) - sunk

    def samples(self, h: float) -> tuple[int, int]:
        """Steps between samples, and how many samples, at a step h [s]."""
        stride = max(1, round(SAMPLING / h))
        return stride, math.ceil(self.duration / (stride * h))
