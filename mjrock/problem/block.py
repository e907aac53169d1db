"""The rigid wall: its size, its mass, and the quantities of classical rocking theory."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .quantities import GRAVITY, Array, Real, require_real, require_within


@dataclass(frozen=True)
class Block:
    """A homogeneous rectangular wall that rocks in its plane of thickness and height.

    Args:
        b: half the thickness [m], 1e-3 to 10.
        h: half the height [m], 5e-3 to 100.
        length: length along the wall, out of the plane of rocking [m], 1e-3 to 1000. Mass and contact stiffness are
            both proportional to it, so that no rotation depends on it.
        density: mass density [kg/m3], 100 to 30000.
        inset: how far the edges that the wall rocks about lie inside its faces [m], 0 to less than b. Crushed or broken
            corners move them inwards. Mass and inertia are those of the full wall.

    Raises:
        ValueError: for a value outside its range, or a wall that is thicker than it is high.
    """

    b: float
    h: float
    length: float = 1.0
    density: float = 2000.0
    inset: float = 0.0

    def __post_init__(self) -> None:
        require_within("half thickness b", self.b, 1e-3, 10.0, "m")
        require_within("half height h", self.h, 5e-3, 100.0, "m")
        require_within("length", self.length, 1e-3, 1e3, "m")
        require_within("density", self.density, 100.0, 3e4, "kg/m3")
        require_within("slenderness h/b", self.h / self.b, 1.0, 200.0)
        if not 0 <= require_real("inset", self.inset) < self.b:
            raise ValueError(f"inset = {self.inset:g} m is outside the valid range 0 <= inset < b = {self.b:g} m")
        require_within("slenderness h / (b - inset)", self.slenderness, 1.0, 200.0)

    @classmethod
    def from_size(
        cls, thickness: float, height: float, length: float = 1.0, density: float = 2000.0, inset: float = 0.0
    ) -> Block:
        """The wall of full sizes `thickness` 2b, `height` 2h and `length` [m], with its edges `inset` [m]."""
        require_within("thickness", thickness, 2e-3, 20.0, "m")
        require_within("height", height, max(1e-2, thickness), min(200.0, 200 * thickness), "m")
        return cls(b=thickness / 2, h=height / 2, length=length, density=density, inset=inset)

    @classmethod
    def from_slenderness(cls, slenderness: float, R: float, length: float = 1.0, density: float = 2000.0) -> Block:
        """The wall of a `slenderness` h/b [-] and a half diagonal `R` [m], as Table 1 of the paper lists walls."""
        require_within("slenderness h/b", slenderness, 1.0, 200.0)
        alpha = math.atan(1 / slenderness)
        most = min(10 / math.sin(alpha), 100 / math.cos(alpha))
        require_within("half diagonal R", R, max(1e-3 / math.sin(alpha), 5e-3 / math.cos(alpha)), most, "m")
        return cls(b=R * math.sin(alpha), h=R * math.cos(alpha), length=length, density=density)

    @property
    def half_base(self) -> float:
        """Half the distance between the edges that the wall rocks about, b less the inset [m]."""
        return self.b - self.inset

    @property
    def slenderness(self) -> float:
        """h/b [-], as Eqs. 5-6 and Table 1 of the paper use it, with b between the edges that the wall rocks about."""
        return self.h / self.half_base

    @property
    def alpha(self) -> float:
        """Angle of the diagonal to the vertical, arctan(b/h) [rad]; a static tilt beyond it overturns the wall.

        The paper prints arctan(h/b) below Eq. 1; its own example (Figure 3) needs arctan(b/h) in Eq. 2.
        """
        return math.atan2(self.half_base, self.h)

    @property
    def R(self) -> float:
        """Half the diagonal: distance from the centroid to the edge that the wall rocks about [m]."""
        return math.hypot(self.half_base, self.h)

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return 4 * self.b * self.h * self.length * self.density

    @property
    def weight(self) -> float:
        """Weight [N]."""
        return self.mass * GRAVITY

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centroid [kg m2]."""
        return self.mass * (self.b**2 + self.h**2) / 3

    @property
    def toe_inertia(self) -> float:
        """Moment of inertia about the toe, I_0 of Eq. 1 [kg m2]."""
        return self.inertia + self.mass * self.R**2

    @property
    def p(self) -> float:
        """Frequency parameter sqrt(m g R / I_0) of Eq. 1 [rad/s]."""
        return math.sqrt(self.weight * self.R / self.toe_inertia)

    def potential_energy(self, theta: Real) -> Real:
        """Energy of the rigid wall tilted by `theta` [rad] about its toe, above the wall at rest [J]."""
        height: Real = np.cos(self.alpha - np.abs(theta)) - math.cos(self.alpha)
        return self.weight * self.R * height

    def rotation_at(self, energy: float) -> float:
        """The rotation in [0, alpha] whose `potential_energy` is `energy` [J]; the inverse of that function.

        Raises:
            ValueError: if the wall has more energy than it takes to overturn it.
        """
        cosine = math.cos(self.alpha) + energy / (self.weight * self.R)
        if not math.cos(self.alpha) <= cosine <= 1:
            top = float(self.potential_energy(self.alpha))
            raise ValueError(f"energy = {energy:g} J is outside the valid range 0 to {top:g} J (overturning)")
        return self.alpha - math.acos(cosine)

    def pose(self, theta: Array) -> Array:
        """Displacement (x, z) of the centroid [m] and rotation [rad] of the rigid wall turned about its toe.

        Args:
            theta: rotations [rad], shape (n,).

        Returns:
            x away from the side stop, z upwards, and theta, shape (n, 3).
        """
        toe = np.copysign(self.half_base, theta)
        x = toe * (1 - np.cos(theta)) + self.h * np.sin(theta)
        z = toe * np.sin(theta) - self.h * (1 - np.cos(theta))
        return np.stack([x, z, theta], axis=-1)

    def turning(self, theta: float, direction: float) -> Array:
        """Rate of `pose` per unit of angular velocity, the wall turning about the toe in `direction`, +1 or -1;
        (3,)."""
        toe, sine, cosine = direction * self.half_base, math.sin(theta), math.cos(theta)
        return np.array([self.h * cosine + toe * sine, toe * cosine - self.h * sine, 1.0])
