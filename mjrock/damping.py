"""The damping law: the damping ratio that loses in a compliant contact what restitution loses at once."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

from .block import Block
from .restitution import Restitution


@dataclass(frozen=True)
class PowerLaw:
    """xi = -coefficient (h/b)^slenderness_exponent k_n^stiffness_exponent ln|e|, with k_n of the base in N/m3."""

    coefficient: float
    slenderness_exponent: float
    stiffness_exponent: float
    r_squared: float

    def __call__(self, slenderness: float, k_n: float, e: float) -> float:
        """The damping ratio [-]; `e` is the restitution of this law's own impact."""
        factor = slenderness**self.slenderness_exponent * k_n**self.stiffness_exponent
        return float(-self.coefficient * factor * math.log(abs(e)))


@dataclass(frozen=True)
class DampingLaw:
    """Two power laws, their source, and the ranges they were fitted over.

    Calling a law gives `(xi_base, xi_side)` as fractions, and warns (UserWarning) outside the fitted ranges.

    Args:
        name: what a generated model records.
        source: where the coefficients come from.
        base: law of the base, of ln e_2s.
        side: law of the side stop, of ln |e_side|.
        R_range: half diagonals covered by the fit [m].
        slenderness_range: h/b covered by the fit [-].
        k_n_range: interface stiffnesses covered by the fit [N/m3].
    """

    name: str
    source: str
    base: PowerLaw
    side: PowerLaw
    R_range: tuple[float, float]
    slenderness_range: tuple[float, float]
    k_n_range: tuple[float, float]

    def __call__(self, wall: Block, e: Restitution, k_n: float) -> tuple[float, float]:
        """Damping ratios of base and side for interface stiffness `k_n` of the base [N/m3].

        Raises:
            ValueError: if `k_n` is not positive, or `e.side` is zero (its logarithm has no value).
        """
        if not k_n > 0:
            raise ValueError(f"k_n = {k_n:g} N/m3 is outside the valid range k_n > 0")
        if e.side == 0:
            raise ValueError("side restitution = 0 has no damping ratio; the valid range is -1 <= e_side < 0")
        covered = {
            "R [m]": (wall.R, self.R_range),
            "h/b [-]": (wall.slenderness, self.slenderness_range),
            "k_n [N/m3]": (k_n, self.k_n_range),
        }
        outside = [
            f"{name} = {value:.4g} not in {low:g} to {high:g}"
            for name, (value, (low, high)) in covered.items()
            if not low * (1 - 1e-9) <= value <= high * (1 + 1e-9)
        ]
        if outside:
            warnings.warn(f"{self.name}: outside the range of the fit: {'; '.join(outside)}", stacklevel=2)
        return self.base(wall.slenderness, k_n, e.base), self.side(wall.slenderness, k_n, e.side)


PUBLISHED = DampingLaw(
    name="PUBLISHED",
    source="Dynamic simulation of one-sided rocking masonry facades using an energy-consistent viscous damping model, "
    "Eqs. 5-6 and Table 1. Eq. 5 is printed with the exponent 0.935 on k_n,b as well; 0.343 is the one that returns "
    "Figure 3's 5.3 % and the six xi_b of Table 2 to the printed digit (tests/validation/test_table2.py).",
    base=PowerLaw(coefficient=0.000292, slenderness_exponent=0.935, stiffness_exponent=0.343, r_squared=0.978),
    side=PowerLaw(coefficient=0.0807, slenderness_exponent=0.2548, stiffness_exponent=-0.1283, r_squared=0.994),
    R_range=(1.4, 2.8),
    slenderness_range=(4.0, 15.0),
    k_n_range=(0.5e8, 30e8),
)
"""The law of the paper (Eqs. 5-6), fitted there in a finite element code with its own contact discretisation."""
