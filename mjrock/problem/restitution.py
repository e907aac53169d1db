"""Coefficients of restitution of classical rocking theory."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .block import Block
from .quantities import require_real


@dataclass(frozen=True)
class Restitution:
    """What is left of the angular velocity after an impact.

    Args:
        base: e_2s, one impact on the base, two-sided rocking [-], in (0, 1].
        side: e_side, the impact on the side stop [-], in [-1, 1]; negative where the wall rebounds.

    Raises:
        ValueError: for a value outside its range.
    """

    base: float
    side: float

    def __post_init__(self) -> None:
        if not 0 < require_real("base restitution", self.base) <= 1:
            raise ValueError(f"base restitution = {self.base:g} is outside the valid range 0 < e <= 1")
        if not -1 <= require_real("side restitution", self.side) <= 1:
            raise ValueError(f"side restitution = {self.side:g} is outside the valid range -1 to 1")

    @property
    def lumped(self) -> float:
        """e_1s = e_2s e_side e_2s: base, side, base in quick succession (Eq. 4) [-]."""
        return self.base**2 * self.side

    def require_rebound(self) -> None:
        """Raise ValueError unless the wall rebounds from the side stop."""
        if self.side >= 0:
            raise ValueError(f"side restitution = {self.side:g} is no rebound; the valid range is -1 <= e_side < 0")

    @classmethod
    def from_geometry(cls, wall: Block | float) -> Restitution:
        """Conservation of angular momentum through each impact (Eqs. 2-3).

        Args:
            wall: the wall, or alpha = arctan(b/h) [rad] of a wall whose edges are not inset. Eqs. 2-3 are written for
                such a wall. With edges at b' < b below and the corner at b above, the momentum about the edge, and then
                about the top corner, gives e_2s = (I + m (h^2 - b'^2)) / (I + m (h^2 + b'^2)) and e_side =
                (I + m (b b' - h^2)) / (I + m (b^2 + h^2)).

        Raises:
            ValueError: if alpha is too large for Eq. 2 to leave any velocity, that is from 54.7 degrees.
        """
        if isinstance(wall, Block) and wall.inset:
            low, b, h, own = wall.half_base, wall.b, wall.h, wall.inertia / wall.mass
            return cls(
                base=(own + h**2 - low**2) / (own + h**2 + low**2), side=(own + b * low - h**2) / (own + b**2 + h**2)
            )
        alpha = wall.alpha if isinstance(wall, Block) else require_real("alpha", wall)
        if not 0 < alpha < math.asin(math.sqrt(2 / 3)):
            raise ValueError(f"alpha = {alpha:g} rad is outside the valid range 0 < alpha < 0.9553 rad of Eq. 2")
        return cls(base=1 - 1.5 * math.sin(alpha) ** 2, side=1 - 1.5 * math.cos(alpha) ** 2)

    @classmethod
    def from_lumped(cls, lumped: float, wall: Block | float) -> Restitution:
        """From a measured e_1s: e_2s by Eq. 2, and the side takes the rest, e_side = e_1s / e_2s^2.

        `wall` is the wall, or its alpha [rad], as in `from_geometry`.

        This is how Table 2 of the paper turns its experiments into damping ratios.

        Raises:
            ValueError: if the measured value asks more of the side than a perfect rebound.
        """
        require_real("lumped restitution", lumped)
        base = cls.from_geometry(wall).base
        if not -(base**2) <= lumped < 0:
            raise ValueError(
                f"lumped restitution = {lumped:g} is outside the valid range {-(base**2):.4g} to 0 for this wall"
            )
        return cls(base=base, side=lumped / base**2)
