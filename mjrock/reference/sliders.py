"""Sliders of friction dampers for SciPy: they stick or slip, and an arc of the integration ends where that changes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..problem.wall.effect import LinkLaw
from ..quantities import Array

ROUNDING = 1e-9
"""Share of the slip force that is put down to rounding [-]."""


@dataclass
class Slider:
    """The slider of a friction damper, in an arc in which it sticks or slips one way.

    Args:
        law: of the link.
        place: where it is while it sticks: the elongation at which the spring bears nothing [m].
        way: 1 where it slips as the link gets longer, -1 as it gets shorter, 0 where it sticks.
        start: its place at rest [m].
        path: how far it has slipped, either way [m].
    """

    law: LinkLaw
    place: float = 0.0
    way: int = 0
    start: float = 0.0
    path: float = 0.0

    def pull(self, elongation: float) -> float:
        """The force of the link [N], negative where it pushes."""
        return self.way * self.law.strength if self.way else self.law.k * (elongation - self.place)

    def change(self, elongation: float, rate: float) -> float:
        """A number that falls through zero where it begins to slip, or to stick."""
        if self.way:
            return self.way * rate
        return self.law.strength - abs(self.law.k * (elongation - self.place))

    def places(self, elongation: Array) -> Array:
        """Where it is at elongations of the arc [m], shape (n,)."""
        if not self.way:
            return np.full(len(elongation), self.place)
        return np.asarray(elongation - self.way * self.law.strength / self.law.k)

    def move_to(self, elongation: float) -> None:
        """Let it slip to an elongation [m]."""
        stretch = self.law.strength / self.law.k
        place = min(max(self.place, elongation - stretch), elongation + stretch)
        self.path += abs(place - self.place)
        self.place = place

    def settle(self, elongation: float, rate: float, fired: bool) -> None:
        """Let it stick or slip in the next arc.

        Args:
            elongation, rate: of the link now [m, m/s].
            fired: whether the last arc ended because `change` fell through zero.
        """
        before = self.way
        self.move_to(elongation)
        pull = self.law.k * (elongation - self.place)
        if before:
            slips = not fired and before * rate >= 0
        else:
            slips = abs(pull) >= self.law.strength * (1 - ROUNDING) and (fired or pull * rate > 0)
        self.way = int(math.copysign(1.0, pull)) if slips else 0
