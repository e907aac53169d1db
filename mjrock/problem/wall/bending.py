"""Vertical bending of a wall between floors: two bodies that turn about the toe, a crack and the floor above."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, NamedTuple, get_args

import numpy as np

from ...quantities import GRAVITY, Array, Density, Within, keep, keep_declared, require_kind, require_within, short_repr
from .block import Block

CURVE_POINTS = 20_001
"""Rotations at which the curve is looked at."""
DEEPEST_FLOOR, TYPICAL = 5.0, 2500.0
DENSITIES: Within = get_args(Density)[1]
"""Largest depth of a floor, over the thickness of the wall [-], its density where it has one of between one and as many
thicknesses, and those that a block may have [kg/m3]."""


class BendingCurve(NamedTuple):
    """The static curve of a wall that bends between floors, or between side walls.

    Args:
        rotation: of the lower or first body [rad], shape (n,).
        displacement: horizontal, of the centroid of both bodies [m], shape (n,).
        multiplier: horizontal acceleration over g that holds the wall at each [-], shape (n,), zero at the last.
    """

    rotation: Array
    displacement: Array
    multiplier: Array


def require_plain(wall: Block) -> None:
    """Raise a TypeError or a ValueError unless a wall is a plain rectangle."""
    require_kind("wall", wall, Block)
    if not wall.is_plain or wall.inset:
        raise ValueError(f"wall = {wall!r} is not a plain rectangle; cut it to the strip between its openings")


@dataclass(frozen=True)
class VerticalBending:
    """A wall that cracks between two floors, which hold it sideways; the upper one rests on it and may rise.

    The wall is pushed outwards. Its lower body turns about the outer edge of the base, and the upper one about the
    inner edge of the crack and the place where the floor bears. With W the weight of the wall, t its thickness, h its
    height, N the load at a from the inner face and mu h the height of the crack, virtual work gives

        alpha_0 = 2 / (W h) [(W + N) t / mu + N a / (1 - mu)],

    which is least, 2 / (W h) [sqrt((W + N) t) + sqrt(N a)]^2, where mu / (1 - mu) = sqrt((W + N) t / (N a)). Rigid
    bodies, no tension, no sliding.

    Args:
        wall: a plain rectangle.
        load: of the floor on the whole length of the wall [N], 1 to 1e9. It has no inertia sideways, where the floors
            are held.
        bearing: how far from the inner face the floor bears at most [m], above 0 and up to the thickness, where the
            whole load acts as the wall turns; None is the thickness.
        crack: its height [m], 0.01 to 0.99 times that of the wall; None is that of the least multiplier.

    Raises:
        TypeError, ValueError: for a wall that is not a plain rectangle, or a value outside its range.

    Examples:
        >>> strip = mr.VerticalBending(mr.Block.from_size(0.3, 4.0), load=20e3)
        >>> round(strip.crack_height, 2), round(strip.multiplier, 2)
        (2.38, 0.78)
    """

    wall: Block
    load: Annotated[float, Within(1, 1e9, "N", "load of the floor")]
    bearing: float | None = None
    crack: float | None = None

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_plain(self.wall)
        keep_declared(self)
        thickness, height = 2 * self.wall.b, 2 * self.wall.h
        if self.bearing is not None:
            keep(self, bearing=require_within("bearing", self.bearing, 1e-3 * thickness, thickness, "m"))
        if self.crack is not None:
            keep(self, crack=require_within("crack", self.crack, 0.01 * height, 0.99 * height, "m"))

    @property
    def lever(self) -> float:
        """Distance of the load from the inner face [m]."""
        return 2 * self.wall.b if self.bearing is None else self.bearing

    @cached_property
    def crack_height(self) -> float:
        """Height of the crack [m], the given one or that of the least multiplier."""
        if self.crack is not None:
            return self.crack
        ratio = math.sqrt((self.wall.weight + self.load) * 2 * self.wall.b / (self.load * self.lever))
        return 2 * self.wall.h * ratio / (1 + ratio)

    @property
    def multiplier(self) -> float:
        """alpha_0, at which the wall begins to bend [-]."""
        weight, mu = self.wall.weight, self.crack_height / (2 * self.wall.h)
        work = (weight + self.load) * 2 * self.wall.b / mu + self.load * self.lever / (1 - mu)
        return work / (weight * self.wall.h)

    @cached_property
    def curve(self) -> BendingCurve:
        """The static curve up to where the multiplier falls to zero, by virtual work at finite rotations.

        The multiplier is the rate of the potential energy of the weights and the load over that of the horizontal
        displacement of the weights.
        """
        t, a, z = 2 * self.wall.b, self.lever, self.crack_height
        above, reach = 2 * self.wall.h - z, math.hypot(self.lever, 2 * self.wall.h - z)
        theta = np.linspace(0.0, 0.5 * math.pi, CURVE_POINTS)
        x = t * (1 - np.cos(theta)) + z * np.sin(theta)  # of the inner edge of the crack
        theta, x = theta[x - a < reach], x[x - a < reach]
        psi = math.atan2(a, above) + np.arcsin((x - a) / reach)  # where the floor bears stays in place sideways
        sine, cosine, sine_up, cosine_up = np.sin(theta), np.cos(theta), np.sin(psi), np.cos(psi)
        across, up = t * sine + z * cosine, t * cosine - z * sine  # rates of the inner edge of the crack
        rate = across / (above * cosine_up + a * sine_up)  # of psi
        lower, upper = np.array([z, 2 * self.wall.h - z]) / (2 * self.wall.h) * self.wall.weight
        rise = lower * up / 2 + upper * (up + rate * (t * cosine_up - above * sine_up) / 2)
        rise += self.load * (up + rate * (a * cosine_up - above * sine_up))
        sway = lower * across / 2 + upper * (across - rate * (t * sine_up + above * cosine_up) / 2)
        moved = (lower * x / 2 + upper * (x + (t * (cosine_up - 1) - above * sine_up) / 2)) / self.wall.weight
        multiplier = rise / sway
        end = int(np.flatnonzero(multiplier <= 0)[0])
        part = multiplier[end - 1] / (multiplier[end - 1] - multiplier[end])
        last = [row[end - 1] + part * (row[end] - row[end - 1]) for row in (theta, moved)]
        return BendingCurve(
            np.append(theta[:end], last[0]), np.append(moved[:end], last[1]), np.append(multiplier[:end], 0.0)
        )

    @property
    def floor_depth(self) -> float:
        """Depth of a floor with the mass of the load at some 2500 kg/m3 [m], once to five times the thickness."""
        thickness = 2 * self.wall.b
        return min(max(self.load / (self._specific * TYPICAL), thickness), DEEPEST_FLOOR * thickness)

    @property
    def floor_density(self) -> float:
        """Density of a floor of that depth with the mass of the load [kg/m3].

        Raises:
            ValueError: for a load that is too small or too large for a block.
        """
        thickness = 2 * self.wall.b
        least = self._specific * thickness * DENSITIES.low
        most = self._specific * DEEPEST_FLOOR * thickness * DENSITIES.high
        load = require_within("load", self.load, least, most, "N")
        return min(max(load / (self._specific * self.floor_depth), DENSITIES.low), DENSITIES.high)

    @property
    def _specific(self) -> float:
        """Weight of a floor over its depth and density [m3/s2]."""
        return GRAVITY * self.wall.length * (self.floor_ends[1] - self.floor_ends[0])

    @property
    def floor_ends(self) -> tuple[float, float]:
        """Between which x from the inner face the floor above lies [m]: from half a thickness behind it to where it
        bears, and beyond the outer face where it bears on the whole thickness."""
        thickness = 2 * self.wall.b
        return -0.5 * thickness, 1.5 * thickness if self.bearing is None else self.bearing
