"""The formulas of the damping laws: a damping ratio from the dimensionless groups of a wall on its interfaces.

`Groups` are the numbers that a damping ratio can depend on. `PowerLaw` is the form of the paper (Eqs. 5-6).
`CornerLaw`, `BedLaw` and `SideLaw` are the forms of the laws that are calibrated in MuJoCo.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, Protocol

import numpy as np

from ...quantities import Array, keep, require_real, short_repr
from ..wall.block import Block
from .restitution import Restitution

Numbers = float | Array
"""A number, or one for each of many walls."""


@dataclass(frozen=True)
class Groups:
    """The dimensionless numbers that the damping ratios of a wall on its interfaces can depend on.

    They are floats, or arrays of one shape. Two rigid walls of the same h/b and the same k_n / (density g) differ in
    their scale alone, because the dashpots of both are proportional to the springs through the reference frequency.
    Size and density therefore do not appear on their own.

    Args:
        slenderness: h/b [-].
        k_n: interface stiffness of the base [N/m3].
        softness: rotation at which an edge of the wall at rest decompresses, over alpha [-]. It is
            2 (h/b) density g / (k_n alpha), the share of the way to overturning in which the wall does not rock yet.
        work: softness * 0.75 / (phi (2 - phi)) with phi = theta_0/alpha of the release [-]: the work of the weight on
            the springs of the base, over the energy that arrives. For a release at alpha/2 it is the softness itself.
        side_ratio: interface stiffness of the side over that of the base [-].
        housner: -ln e_2s of Eq. 2, the loss that conservation of angular momentum asks for [-].
        base_loss: -ln e_2s, what is asked for [-].
        side_loss: -ln |e_side|, what is asked for [-].
    """

    slenderness: Numbers
    k_n: Numbers
    softness: Numbers
    work: Numbers
    side_ratio: Numbers
    housner: Numbers
    base_loss: Numbers
    side_loss: Numbers

    @classmethod
    def of(cls, wall: Block, e: Restitution, k_n: float, k_side: float | None = None, amplitude: float = 0.5) -> Groups:
        """The groups of `wall` on a base of `k_n` [N/m3] against a side of `k_side`, the same where it is None."""
        softness = wall.weight / (2 * k_n * wall.base_length * wall.half_base**2) / wall.alpha
        return cls(
            slenderness=wall.slenderness,
            k_n=k_n,
            softness=softness,
            work=softness * 0.75 / (amplitude * (2 - amplitude)),
            side_ratio=1.0 if k_side is None else k_side / k_n,
            housner=-math.log(Restitution.from_geometry(wall).base),
            base_loss=-math.log(e.base),
            side_loss=-math.log(abs(e.side)),
        )

    @classmethod
    def stack(cls, groups: list[Groups]) -> Groups:
        """Many as one, whose fields are arrays of shape (n,)."""
        return cls(*np.array([[getattr(group, name.name) for group in groups] for name in fields(cls)], dtype=float))


class Form(Protocol):
    """A formula for one damping ratio: a frozen dataclass of its coefficients, the last of which is its R2."""

    @property
    def r_squared(self) -> float:
        """R2 of the damping ratio over the matched simulations that it was fitted to [-]."""

    def xi(self, groups: Groups, loss: Numbers) -> Any:
        """The damping ratio [-] that loses `loss` = -ln|e| in the impact of this formula; floats or arrays."""


@dataclass(frozen=True)
class PowerLaw:
    """xi = -coefficient (h/b)^slenderness_exponent k_n^stiffness_exponent ln|e|, with k_n of the base in N/m3."""

    coefficient: float
    slenderness_exponent: float
    stiffness_exponent: float
    r_squared: float

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep(self, **{part.name: require_real(part.name, getattr(self, part.name)) for part in fields(self)})

    def __call__(self, slenderness: float, k_n: float, e: float) -> float:
        """The damping ratio [-]; `e` is the restitution of this law's own impact."""
        slenderness, k_n, e = require_real("slenderness", slenderness), require_real("k_n", k_n), require_real("e", e)
        factor = slenderness**self.slenderness_exponent * k_n**self.stiffness_exponent
        return float(-self.coefficient * factor * math.log(abs(e)))

    def xi(self, groups: Groups, loss: Numbers) -> Any:
        """As `Form.xi`."""
        factor = groups.slenderness**self.slenderness_exponent * groups.k_n**self.stiffness_exponent
        return self.coefficient * factor * loss


@dataclass(frozen=True)
class CornerLaw:
    """The base of a wall on two corner lines.

    With L = -ln e_2s the loss asked for, L_H that of Eq. 2 and w = work, the loss goes from an undamped
    bounce to a plastic touch-down as the damping grows:

        L = L_f - (L_f - L_u) exp(-xi / xi_0)        xi = xi_0 ln[(L_f - L_u) / (L_f - L)]
        L_f = L_H + floor w                          plastic: Housner's loss, and the work of the weight on the springs
        L_u = max(0, L_H - bounce sqrt(w) b/h)       undamped: what the bounce off the springs gives back
        xi_0 = scale w^work_exponent (h/b)^slenderness_exponent (1 + growth w)

    No damping loses more than L_f or less than L_u: a restitution beyond them is out of reach.
    """

    floor: float
    bounce: float
    scale: float
    work_exponent: float
    slenderness_exponent: float
    growth: float
    r_squared: float = math.nan

    def _parts(self, groups: Groups) -> tuple[Any, Any, Any]:
        w = groups.work
        most = groups.housner + self.floor * w
        least = np.maximum(0.0, groups.housner - self.bounce * np.sqrt(w) / groups.slenderness)
        steepness = w**self.work_exponent * groups.slenderness**self.slenderness_exponent
        return most, least, self.scale * steepness * (1 + self.growth * w)

    def xi(self, groups: Groups, loss: Numbers) -> Any:
        """As `Form.xi`; infinite where no damping loses as much, zero or less where none loses as little."""
        most, least, scale = self._parts(groups)
        left = np.maximum(0.0, most - loss) / (most - least)
        with np.errstate(divide="ignore"):
            return -scale * np.log(left)

    def loss(self, groups: Groups, xi: Numbers) -> Any:
        """The loss -ln e_2s of a damping ratio, the inverse of `xi`."""
        most, least, scale = self._parts(groups)
        return most - (most - least) * np.exp(-xi / scale)


@dataclass(frozen=True)
class BedLaw:
    """The base of a wall on a bed of many lines.

    The lines close one after the other. An early one is damped while the wall still turns about a late one. The loss
    therefore grows with the logarithm of the damping, and for small losses in proportion to it, as in the paper. With
    L = -ln e_2s, L_H that of Eq. 2 and w = work:

        L = A ln(1 + xi / xi_0)        xi = xi_0 (e_2s^(-1/A) - 1)
        A = inertia L_H + weight w
        xi_0 = scale w^exponent
    """

    inertia: float
    weight: float
    scale: float
    exponent: float
    r_squared: float = math.nan

    def _parts(self, groups: Groups) -> tuple[Any, Any]:
        w = groups.work
        return self.inertia * groups.housner + self.weight * w, self.scale * w**self.exponent

    def xi(self, groups: Groups, loss: Numbers) -> Any:
        """As `Form.xi`."""
        amplitude, scale = self._parts(groups)
        return scale * np.expm1(np.minimum(loss / amplitude, 50.0))

    def loss(self, groups: Groups, xi: Numbers) -> Any:
        """The loss -ln e_2s of a damping ratio, the inverse of `xi`."""
        amplitude, scale = self._parts(groups)
        return amplitude * np.log1p(xi / scale)


@dataclass(frozen=True)
class SideLaw:
    """The side stop, once the base has the damping of its own law.

    The top of the wall hits the stop like a mass on a spring and a dashpot. Its damping ratio is
    zeta = xi sqrt(2 k_side / k_base) (h/b)^1.5, where the factor of xi is the rocking frequency against the stop over
    that on the base. The base takes little energy in the quick sequence base, side, base, so that the stop has to lose
    nearly all of L = -ln|e_1s|. With w = work:

        xi = scale (h/b)^slenderness_exponent (k_side / k_base)^ratio_exponent L (1 + curvature L) (1 + softening w L)
        L = side_loss + base_share base_loss         -ln|e_1s| itself has base_share = 2
    """

    scale: float
    slenderness_exponent: float
    ratio_exponent: float
    base_share: float
    curvature: float
    softening: float
    r_squared: float = math.nan

    def xi(self, groups: Groups, loss: Numbers) -> Any:
        """As `Form.xi`."""
        total = loss + self.base_share * groups.base_loss
        factor = groups.slenderness**self.slenderness_exponent * groups.side_ratio**self.ratio_exponent
        curve = (1 + self.curvature * total) * (1 + self.softening * groups.work * total)
        return self.scale * factor * total * curve


FORMS: dict[str, type] = {form.__name__: form for form in (PowerLaw, CornerLaw, BedLaw, SideLaw)}
"""The formulas that a file may name."""
