"""Pressure of earth on a wall, at rest of the ground and in an earthquake, after Mononobe and Okabe."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated

from ...quantities import GRAVITY, Within, keep_declared, require_kind, require_within, short_repr
from .block import Block
from .effect import CombinedEffect
from .effects import Load, Thrust


@dataclass(frozen=True)
class EarthPressure(CombinedEffect):
    """Dry earth without cohesion behind a wall whose inner face is upright.

    A wedge of earth slides on the plane on which it presses most, or resists least where the wall moves into it. With
    phi the friction angle, delta that on the wall, i the slope of the surface and theta = arctan(k_h / (1 - k_v)),

        K_A = cos^2(phi - theta) / (cos(theta) cos(delta + theta) [1 + r]^2),
        r = sqrt(sin(phi + delta) sin(phi - theta - i) / (cos(delta + theta) cos(i))),

    and K_P is the same with [1 - r]^2 and sin(phi - theta + i) (Mononobe and Okabe; EN 1998-5, E.4 and E.6). The force
    on a metre is K (1 - k_v) rho g H^2 / 2, inclined by delta. Without an earthquake it acts at H / 3, and what an
    earthquake adds to the active one at H / 2. Friction on the wall makes K_P too large where it is above phi / 2, as
    the surface that slides is then curved.

    Args:
        height: of the earth H above the base [m], 0.1 to 50.
        friction_angle: phi [rad], 0.1 to 0.9.
        density: of the earth [kg/m3], 1000 to 2600.
        wall_friction: delta [rad], 0 to 0.9, at most phi.
        slope: of the surface i, rising away from the wall [rad], 0 to 0.9, less than phi.
        k_h: horizontal acceleration of the earth over g, towards the wall [-], 0 to 1.
        k_v: vertical acceleration over g, upwards [-], -0.5 to 0.5.

    Raises:
        ValueError: for a value outside its range, or earth whose surface slides by itself, phi - theta < i.

    Examples:
        >>> earth = mr.EarthPressure(3.0, friction_angle=0.5236)
        >>> round(earth.active, 3), round(earth.passive, 2), round(earth.force)
        (0.333, 3.0, 27958)
    """

    height: Annotated[float, Within(0.1, 50, "m", "height of the earth")]
    friction_angle: Annotated[float, Within(0.1, 0.9, "rad")]
    density: Annotated[float, Within(1000, 2600, "kg/m3", "density of the earth")] = 1900.0
    wall_friction: Annotated[float, Within(0, 0.9, "rad")] = field(default=0.0, kw_only=True)
    slope: Annotated[float, Within(0, 0.9, "rad", "slope of the earth")] = field(default=0.0, kw_only=True)
    k_h: Annotated[float, Within(0, 1)] = field(default=0.0, kw_only=True)
    k_v: Annotated[float, Within(-0.5, 0.5)] = field(default=0.0, kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)
        phi = self.friction_angle
        require_within("wall_friction", self.wall_friction, 0.0, phi, "rad")
        if not self.slope < phi or phi - self.inclination < self.slope:
            raise ValueError(
                f"slope = {self.slope:g} rad and k_h = {self.k_h:g}: the surface of the earth slides by itself, "
                f"as friction_angle - arctan(k_h / (1 - k_v)) = {phi - self.inclination:.4g} rad; the valid "
                "range is above the slope"
            )

    @property
    def inclination(self) -> float:
        """Angle of weight and inertia from the vertical, theta [rad]."""
        return math.atan2(self.k_h, 1 - self.k_v)

    def _coefficient(self, sense: float) -> float:
        """K of the active (1) or the passive pressure (-1)."""
        phi, delta, theta = self.friction_angle, self.wall_friction, self.inclination
        cosine = math.cos(delta + theta)
        root = math.sqrt(
            math.sin(phi + delta) * math.sin(phi - theta - sense * self.slope) / (cosine * math.cos(self.slope))
        )
        return math.cos(phi - theta) ** 2 / (math.cos(theta) * cosine * (1 + sense * root) ** 2)

    @property
    def active(self) -> float:
        """K_A [-]."""
        return self._coefficient(1.0)

    @property
    def passive(self) -> float:
        """K_P [-], which earth bears at most where a wall moves into it."""
        return self._coefficient(-1.0)

    @property
    def force(self) -> float:
        """Active force on a metre of the wall [N/m]."""
        return 0.5 * self.density * GRAVITY * self.height**2 * (1 - self.k_v) * self.active

    @property
    def level(self) -> float:
        """Height at which it acts [m]: H / 3 of what acts without an earthquake, and H / 2 of what this adds."""
        static_force = EarthPressure(
            self.height, self.friction_angle, self.density, wall_friction=self.wall_friction, slope=self.slope
        ).force
        return (static_force * self.height / 3 + (self.force - static_force) * self.height / 2) / self.force

    def on(self, wall: Block) -> tuple[Thrust, Load]:
        """The active force on the whole length of a wall, as effects of a `Case`.

        Raises:
            TypeError, ValueError: for what is no wall, or one that is lower than the earth.
        """
        require_kind("wall", wall, Block)
        require_within("height of the earth", self.height, 0.1, 2 * wall.h * (1 + 1e-12), "m")
        total, delta = self.force * wall.length, self.wall_friction
        across, down = total * math.cos(delta), total * math.sin(delta)
        return Thrust(self.level, across), Load(down, self.level, wall.inner_face(self.level))
