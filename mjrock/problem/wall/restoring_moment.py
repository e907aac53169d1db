"""The moment that brings a tilted rigid wall back, of its weight and of every force that keeps its size and direction.

About the toe, at a rotation phi >= 0 towards that toe, the moment is M(phi) = P cos(phi) - Q sin(phi). A weight W at a
height z and a distance d inwards from the toe has P = W d and Q = W z. A horizontal force F outwards at (d, z) has
P = -F z and Q = F d. A wall with loads and thrusts so rocks as a plain one with another P and Q.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...quantities import Array, Real


class Moment(NamedTuple):
    """The restoring moment about one toe.

    Args:
        P: at rest [N m].
        Q: what it loses with the sine of the rotation [N m].
    """

    P: float
    Q: float

    @property
    def alpha(self) -> float:
        """Rotation at which the moment is zero [rad]; beyond it the wall overturns."""
        return math.atan2(self.P, self.Q)

    def at(self, phi: Real) -> Real:
        """The moment at a rotation phi >= 0 [N m]."""
        moment: Real = self.P * np.cos(phi) - self.Q * np.sin(phi)
        return moment

    def energy(self, phi: Real) -> Real:
        """The work that a rotation phi >= 0 takes [J]."""
        taken: Real = self.P * np.sin(phi) - 2 * self.Q * np.sin(0.5 * phi) ** 2
        return taken

    def rotation_at(self, energy: float) -> float:
        """The rotation in [0, alpha] that takes `energy` [J].

        Raises:
            ValueError: if that is more energy than it takes to overturn the wall.
        """
        size = math.hypot(self.P, self.Q)
        cosine = (self.Q + energy) / size
        if not self.Q / size <= cosine <= 1:
            top = self.energy(self.alpha)
            raise ValueError(f"energy = {energy:g} J is outside the valid range 0 to {top:g} J (overturning)")
        return self.alpha - math.acos(cosine)


class Restoring(NamedTuple):
    """The restoring moments about the outer toe, for theta > 0, and about the inner toe, for theta < 0."""

    outer: Moment
    inner: Moment

    def towards(self, side: float) -> Moment:
        """The one about the outer toe (+1) or the inner toe (-1)."""
        return self.outer if side >= 0 else self.inner

    def energy(self, theta: Real) -> Real:
        """The work that rotations of either sign take [J]."""
        size: Any = np.abs(theta)
        if self.outer == self.inner:
            return self.outer.energy(size)  # type: ignore[no-any-return]
        return np.where(np.asarray(theta) >= 0, self.outer.energy(size), self.inner.energy(size))  # type: ignore[no-any-return]

    def plus(self, moments: list[Restoring]) -> Restoring:
        """The sum of this one and others."""
        sides = [
            Moment(sum(moment.P for moment in side), sum(moment.Q for moment in side))
            for side in zip(self, *moments, strict=True)
        ]
        return Restoring(*sides)


def of_force(x: float, z: float, outwards: float, downwards: float, half_base: float) -> Restoring:
    """The restoring moments of a force that acts at an offset x from the middle of the base and a height z.

    Its components are [N], x and z [m]. Either toe is `half_base` from the middle of the base [m].
    """
    sides = []
    for side in (1.0, -1.0):
        d, out = half_base - side * x, side * outwards
        sides.append(Moment(downwards * d - out * z, downwards * z + out * d))
    return Restoring(*sides)


def pose_of(theta: Array, x: float, z: float, half_base: float) -> Array:
    """Displacement (x, z) [m] of a point of a rigid wall at rotations theta about its toes [rad], and theta, (n, 3).

    At rest the point lies at x, z [m], and either toe at `half_base` [m], from the middle of the base. It stands beside
    `mjrock.geometry` because it takes many rotations at once, and rocking theory uses it.
    """
    lever = np.copysign(half_base, theta) - x
    sine, versine = np.sin(theta), 1 - np.cos(theta)
    return np.stack([lever * versine + z * sine, lever * sine - z * versine, theta], axis=-1)
