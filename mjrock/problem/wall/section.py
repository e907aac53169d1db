"""The section of a wall: openings, a thickness that changes with the height, and the moments that follow.

A wall is cut into slabs at every height where its thickness or the width of its openings changes. Within a slab the
thickness is linear in the height and the length is constant, so that each moment is exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

from ...quantities import keep, require_within, shown

Profile = tuple[tuple[float, float], ...]
"""Height [m] and thickness [m] from the base to the top, linear in between. Two at one height are a step."""


@dataclass(frozen=True)
class Opening:
    """A door or a window through the whole thickness of the wall.

    Where it lies along the wall makes no difference to the rocking. Openings at the same height lie side by side.

    Args:
        width: along the wall [m], 0.01 to 1000.
        height: its own height [m], 0.01 to 200.
        sill: height of its lower edge above the base [m], 0 for a door, which shortens the base too.

    Raises:
        ValueError: for a value outside its range.
    """

    width: float
    height: float
    sill: float = 0.0

    def __post_init__(self) -> None:
        keep(
            self,
            width=require_within("width of the opening", self.width, 0.01, 1000.0, "m"),
            height=require_within("height of the opening", self.height, 0.01, 200.0, "m"),
            sill=require_within("sill of the opening", self.sill, 0.0, 200.0, "m"),
        )

    @property
    def head(self) -> float:
        """Height of its upper edge above the base [m]."""
        return self.sill + self.height


class Moments(NamedTuple):
    """Volume [m3], and its moments of the first order from the middle of the base outwards and upwards, x and z [m4],
    and of the second order, xx and zz [m5]."""

    volume: float
    x: float
    z: float
    xx: float
    zz: float


def require_profile(profile: Sequence[Sequence[float]], thickness: float, height: float) -> Profile:
    """A profile as pairs of floats; a ValueError says if it does not go from the base of this thickness up to this
    height [m], or if a value is out of range."""
    if not isinstance(profile, Sequence) or isinstance(profile, str):
        raise TypeError(f"profile = {shown(profile)} is not a sequence of pairs of height and thickness [m]")
    pairs: list[tuple[float, float]] = []
    for i, pair in enumerate(profile):
        if not isinstance(pair, Sequence) or isinstance(pair, str) or len(pair) != 2:
            raise TypeError(f"profile[{i}] = {shown(pair)} is not a pair of height and thickness [m]")
        z = require_within(f"profile[{i}], height", pair[0], pairs[-1][0] if pairs else 0.0, height * (1 + 1e-12), "m")
        pairs.append((min(z, height), require_within(f"profile[{i}], thickness", pair[1], 1e-3, 20.0, "m")))
    whole = len(pairs) > 1 and pairs[0][0] == 0 and abs(pairs[-1][0] - height) <= 1e-9 * height
    if not whole or abs(pairs[0][1] / thickness - 1) > 1e-9:
        raise ValueError(
            f"profile = {shown(profile)} is outside the valid range: it starts at height 0 with the thickness "
            f"{thickness:g} m and ends at the height {height:g} m"
        )
    return tuple(pairs)


def require_openings(openings: Sequence[Opening], length: float, height: float) -> None:
    """Raise ValueError unless the openings lie within the wall and leave some of it at every height."""
    for i, opening in enumerate(openings):
        if opening.head > height * (1 + 1e-12):
            raise ValueError(
                f"openings[{i}] reaches from {opening.sill:g} to {opening.head:g} m; "
                f"the valid range is 0 to {height:g} m, the height of the wall"
            )
    for opening in openings:
        z = opening.sill + 1e-9 * height  # just above the sill
        across = sum(other.width for other in openings if other.sill <= z < other.head)
        if not across < length * (1 - 1e-9):
            raise ValueError(
                f"the openings at a height of {opening.sill:.4g} m are {across:g} m wide together; the valid range is "
                f"less than {length:g} m, the length of the wall"
            )


def moments(profile: Profile, length: float, openings: Sequence[Opening]) -> Moments:
    """Volume and moments of a wall of a length [m], without its openings.

    The thickness of its profile is measured from the straight inner face, which stands half the lowest thickness behind
    the middle of the base.
    """
    inner = -0.5 * profile[0][1]
    total = [0.0] * 5
    for (low, t_low), (high, t_high) in pairwise(profile):
        cuts = {low, high} | {z for opening in openings for z in (opening.sill, opening.head) if low < z < high}
        for z0, z1 in pairwise(sorted(cuts)):
            middle = 0.5 * (z0 + z1)
            left = length - sum(opening.width for opening in openings if opening.sill < middle < opening.head)
            t0, t1 = (t_low + (t_high - t_low) * (z - low) / (high - low) for z in (z0, z1))
            for i, value in enumerate(_slab(inner, z0, z1, t0, t1)):
                total[i] += left * value
    return Moments(*total)


def _slab(inner: float, z0: float, z1: float, t0: float, t1: float) -> tuple[float, ...]:
    """Area and moments of a trapezium from z0 to z1 whose thickness from x = inner outwards goes from t0 to t1.

    Each integrand is a polynomial of at most the third degree in z, which Simpson's rule integrates exactly.
    """
    area, x, z, xx, zz = 0.0, 0.0, 0.0, 0.0, 0.0
    for weight, at, t in ((1, z0, t0), (4, 0.5 * (z0 + z1), 0.5 * (t0 + t1)), (1, z1, t1)):
        share = weight * (z1 - z0) / 6
        outer = inner + t
        area += share * t
        x += share * 0.5 * (outer**2 - inner**2)
        z += share * t * at
        xx += share * (outer**3 - inner**3) / 3
        zz += share * t * at**2
    return area, x, z, xx, zz
