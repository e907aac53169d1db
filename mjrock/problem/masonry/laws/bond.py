"""The bond of a mortared joint: its strength in tension, along the face and in crushing, and its fracture energies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from ....quantities import (
    Array,
    Implausible,
    Within,
    keep,
    keep_declared,
    require_flag,
    require_within,
    short_repr,
    warn_of,
)
from .bond_law import HARDENED, YIELDS

LEAST_POINTS = 3
"""Fewest contact lines of a joint with a bond: of these the stiffness in bending can be k_n I."""
ROUNDED_UP = 1.01
"""Factor on values in messages, so that what is rounded to three digits is within the range."""
STRONGEST, TOUGHEST = 1e12, 1e15
"""Largest strength [Pa] and largest fracture energy [J/m2]. The largest ones stand for joints that never break."""
Strength = Annotated[float, Within(0, STRONGEST, "Pa")]
Energy = Annotated[float, Within(1e-6, TOUGHEST, "J/m2")]


WEAKEST, FRAGILE = 100.0, 0.06
"""Strength [Pa] and fracture energy [J/m2] below which they are taken for ones in MPa and N/mm."""


@dataclass(frozen=True)
class Bond:
    """Mortar of a joint that cracks, slips and crushes, beside its stiffness and friction.

    Args:
        tension: tensile strength f_t [Pa], 0 to 1e12.
        cohesion: shear strength without pressure c [Pa], 0 to 1e12. One above zero needs a tension above zero.
        opening_energy: fracture energy of opening G_I [J/m2], 1e-6 to 1e15. 1 N/mm is 1000 J/m2. A joint whose
            spring gives back as much, f_t^2 / k_n, breaks at once when it reaches its tension.
        slip_energy: fracture energy of slip G_II [J/m2], 1e-6 to 1e15.
        crushing: compressive strength f_c [Pa], 1e3 to 1e12, or None for a joint that is not crushed.
        crushing_energy: energy of crushing G_c [J/m2], 1e-6 to 1e15, given with `crushing`. A joint needs at least
            f_c^2 / k_n, and what `hardening` takes, since its spring would give back more than crushing takes.
        residual_friction: coefficient to which friction falls as the bond is lost [-], 0 to 10, and at most that of the
            joint. None keeps that of the joint.
        hardening: plastic closing at which a joint that is crushed reaches f_c [m], 1e-9 to 0.1. Up to there it bears
            f_c (1 + 2 sqrt(2 x - x^2)) / 3 at the share x of this closing (Lourenco and Rots, Journal of Engineering
            Mechanics 123, 1997). G_c is the whole area, of which this part takes 0.857 f_c times the closing. None
            bears f_c from the start.
        damped: whether the dashpots of the joint act while it holds. False leaves them to the share of each line that
            has cracked: a whole joint is not damped, and one that has lost its bond is damped as a dry one.

    Raises:
        TypeError, ValueError: for a value of another type, or outside its range.

    Warns:
        Implausible: for strengths that are probably in MPa, and fracture energies that are probably in N/mm.

    Examples:
        >>> bond = mr.Bond(tension=0.2e6, cohesion=0.3e6, opening_energy=18.0, slip_energy=125.0)
        >>> len(mr.Masonry.column(0.5, 2.0, 4, k_s=5e9, points=3, bond=bond).bonds)
        4
    """

    tension: Strength
    cohesion: Strength
    opening_energy: Energy
    slip_energy: Energy
    crushing: Annotated[float | None, Within(1e3, STRONGEST, "Pa")] = None
    crushing_energy: Annotated[float | None, Within(1e-6, TOUGHEST, "J/m2")] = None
    residual_friction: Annotated[float | None, Within(0, 10)] = None
    hardening: Annotated[float | None, Within(1e-9, 0.1, "m")] = field(default=None, kw_only=True)
    damped: bool = field(default=True, kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        if (self.crushing is None) != (self.crushing_energy is None):
            crushing = f"crushing = {self.crushing}, crushing_energy = {self.crushing_energy}"
            raise ValueError(f"{crushing}: give both of them, or neither")
        keep_declared(self)
        keep(self, damped=require_flag("damped", self.damped))
        if self.hardening is not None:
            if self.crushing is None:
                raise ValueError(f"hardening = {self.hardening} needs crushing and crushing_energy; give them, or None")
            if self.energy_of_hardening >= float(self.crushing_energy or 0.0):
                longest = self.hardening * float(self.crushing_energy or 0.0) / self.energy_of_hardening
                raise ValueError(
                    f"hardening = {self.hardening:g} m would take {self.energy_of_hardening:g} J/m2 of the "
                    f"crushing_energy = {self.crushing_energy:g} J/m2; the valid range is 1e-9 to {longest:g} m"
                )
        if self.cohesion > 0 and self.tension == 0:
            raise ValueError(
                f"cohesion = {self.cohesion:g} Pa with a tension of 0: cohesion ends where a joint opens; the valid "
                "range of the tension is then above 0"
            )
        if doubt := self._doubt():
            warn_of(doubt, Implausible)

    def _doubt(self) -> str:
        """What is odd about strengths and energies, in words, empty where nothing is."""
        for name in ("tension", "cohesion"):
            if 0 < (strength := getattr(self, name)) < WEAKEST:
                return f"{name} = {strength:g} Pa, and one unit presses with more than {WEAKEST:g} Pa: is it in MPa?"
        for name in ("opening_energy", "slip_energy"):
            if (energy := getattr(self, name)) < FRAGILE and self.tension >= 1e4:
                return f"{name} = {energy:g} J/m2, and mortar takes more than {FRAGILE:g} J/m2: is it in N/mm?"
        return ""

    def require_fit(self, joint: str, k_n: float, k_s: float, friction: float, points: int) -> None:
        """Raise a ValueError that names the joint, if its springs cannot have this bond.

        Args:
            joint: its name.
            k_n, k_s: its stiffness along the normal and along the face, infinite where it sticks rigidly [N/m3].
            friction: its coefficient of friction [-].
            points: its contact lines.
        """
        if self.is_dry:
            return
        if points < LEAST_POINTS:
            raise ValueError(
                f"points = {points}, and {joint} has a bond: on two lines it would crack in bending at 3 times "
                f"the moment that it bears; the valid range is {LEAST_POINTS} or more, and 5 or more follow the crack"
            )
        if not math.isfinite(k_s):
            raise ValueError(f"bond of {joint}: k_s = None, and a bond needs a shear stiffness; give k_s in N/m3")
        if self.residual_friction is not None:
            require_within(f"residual_friction of {joint}", self.residual_friction, 0.0, friction)
        if self.steepest > k_n:
            stiff, tough = (ROUNDED_UP * required for required in (self.steepest, self.crushing_energy_on(k_n)))
            raise ValueError(
                f"bond of {joint}: its spring of k_n = {k_n:g} N/m3 gives back more than crushing takes; the "
                f"valid range of k_n is {stiff:.3g} N/m3 or more with this crushing_energy, and that of the "
                f"crushing_energy {tough:.3g} J/m2 or more with this k_n; or leave crushing out"
            )

    @property
    def is_dry(self) -> bool:
        """Whether the joint has no bond at all."""
        return self.tension == 0 and self.cohesion == 0 and self.crushing is None

    @property
    def pulls(self) -> bool:
        """Whether it pulls where it is open."""
        return self.tension > 0

    @property
    def elastic_limit(self) -> float:
        """Pressure that it bears without closing for good [Pa], infinite where it is not crushed."""
        if self.crushing is None:
            return math.inf
        return self.crushing if self.hardening is None else YIELDS * self.crushing

    @property
    def steepest(self) -> float:
        """Stress that a joint which is crushed loses by closing for good, at most [N/m3]; 0 where it is not crushed."""
        if self.crushing is None or self.crushing_energy is None:
            return 0.0
        return self.crushing**2 / (self.crushing_energy - self.energy_of_hardening)

    def crushing_energy_on(self, k_n: float) -> float:
        """The least energy of crushing on a spring [N/m3], which is released as the stress falls [J/m2]."""
        return (self.crushing or 0.0) ** 2 / k_n + self.energy_of_hardening

    @property
    def energy_of_hardening(self) -> float:
        """Part of the energy of crushing that is taken before the peak [J/m2]."""
        return HARDENED * (self.crushing or 0.0) * (self.hardening or 0.0)


def strengths(bonds: Sequence[object], name: str) -> Array:
    """A strength of each bond, or of a law of one's own, which has none [Pa], zero where there is none, (joints,)."""
    return np.array([0.0 if bond is None else getattr(bond, name) for bond in bonds])


BONDS = {
    # shear wall J4D of Raijmakers and Vermeltfoort, as two independent micro-models of it have its mortar, after
    # Lourenco and Rots, Journal of Engineering Mechanics 123, 1997; without crushing, for which no source was at hand
    "cement mortar, wall J4D": Bond(0.25e6, 0.35e6, 18.0, 125.0),
    # out-of-plane shake-table wall of the SAFEGO project, 3DEC deck of its authors; G_c = 15 + 0.43 f_c - 0.0036 f_c^2
    "clay brick, SAFEGO": Bond(0.2e6, 0.3e6, 13.0, 130.0, 20e6, 22.2e3),
    # calcium silicate bricks tested at EUCENTRE, deck of the group; G_I = 0.025 (2 f_t)^0.7 and G_II = 10 G_I in N/mm
    "calcium silicate, EUCENTRE": Bond(0.238e6, 0.21e6, 14.9, 149.0, 6.2e6, 17.5e3),
    # an example of rubble masonry of EPFL
    "rubble, EPFL": Bond(0.05e6, 0.05e6, 20.0, 5.0),
}
"""Named bonds, each with its source above it. Tests of one's own masonry come first, see docs/mortar.md."""
