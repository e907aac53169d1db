"""Horizontal bending of a wall held at its sides: two bodies that turn about upright edges, as an arch in plan."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from ...quantities import Implausible, Within, keep, keep_declared, require_within, short_repr, warn_of
from .bending import CURVE_POINTS, BendingCurve, require_plain
from .block import Block
from .tie import Tie

TYPICAL_FRICTION = 0.4
"""Coefficient of friction of masonry, NTC 2018 and EN 1996-1-1, 3.6.2 [-]."""
TIE_STIFFNESS = 1e3
"""Stiffness of the tie that stands for the side walls, their thrust per thickness of the wall [-]."""


@dataclass(frozen=True)
class HorizontalBending:
    """A strip of wall under the roof that cracks upright between two side walls, and is pushed outwards.

    It is an arch in plan, of two bodies with a rise of one thickness: they turn about the inner edge of the crack and
    about the outer edges of both ends. The side walls bear a thrust H along the wall, give way under it, and hold the
    ends across it. With W the weight, t the thickness, L the length and a the distance of the crack from one end,
    virtual work gives

        alpha_0 = 2 H t / W [1 / a + 1 / (L - a)],

    8 H t / (W L) with a crack in the middle, where it is least. Rigid bodies without tension on a smooth bed; what
    the floor and the masonry below hold is left out, on the safe side.

    Args:
        wall: a plain rectangle, as high as what bends.
        thrust: H that the weaker of both side walls bears along the wall, at any displacement [N], 1 to 1e9.
        crack: its distance from one end [m], 0.01 to 0.99 times the length; None is the middle.

    Raises:
        TypeError, ValueError: for a wall that is not a plain rectangle, or a value outside its range.

    Warns:
        Implausible: where it slides before it bends unless friction is above 0.4.

    Examples:
        >>> strip = mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), thrust=12e3)
        >>> round(strip.multiplier, 4), round(strip.friction, 2)
        (0.068, 0.33)
    """

    wall: Block
    thrust: Annotated[float, Within(1, 1e9, "N", "thrust of the side walls")]
    crack: float | None = None

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_plain(self.wall)
        keep_declared(self)
        if self.crack is not None:
            length = self.wall.length
            keep(self, crack=require_within("crack", self.crack, 0.01 * length, 0.99 * length, "m"))
        if self.friction > TYPICAL_FRICTION:
            warn_of(
                f"the strip slides before it bends unless friction at its ends and crack is {self.friction:.2g}; "
                f"{TYPICAL_FRICTION:g} is usual",
                Implausible,
            )

    @property
    def parts(self) -> tuple[float, float]:
        """Lengths of both bodies [m]."""
        first = 0.5 * self.wall.length if self.crack is None else self.crack
        return first, self.wall.length - first

    @property
    def multiplier(self) -> float:
        """alpha_0, at which the wall begins to bend [-]."""
        return 4 * self.thrust * self.wall.b / self.wall.weight * sum(1 / part for part in self.parts)

    @property
    def friction(self) -> float:
        """The least coefficient of friction of the ends and of the crack, without which they slide before [-]."""
        t, H, per_length = 2 * self.wall.b, self.thrust, self.multiplier * self.wall.weight / self.wall.length
        shears = [0.5 * per_length * part + H * t / part for part in self.parts]  # of the ends
        return max(*shears, abs(shears[0] - per_length * self.parts[0])) / H

    @cached_property
    def curve(self) -> BendingCurve:
        """The static curve up to where the multiplier falls to zero and the arch is flat, by virtual work at finite
        rotations.

        The multiplier is the rate of the work on the thrust over that of the weight's displacement.
        """
        t, parts = 2 * self.wall.b, np.array(self.parts)[:, None]
        rise = t * np.cos(np.linspace(0.0, 0.5 * math.pi, CURVE_POINTS))  # of the arch
        along = np.sqrt(t**2 + parts**2 - rise**2)  # of each body, from edge to edge
        theta = np.arctan2(t, parts) - np.arctan2(rise, along)
        share = parts / self.wall.length
        moved = (share * (0.5 * t * (1 - np.cos(theta)) + 0.5 * parts * np.sin(theta))).sum(axis=0)
        sway = (share * (0.5 * t * np.sin(theta) + 0.5 * parts * np.cos(theta)) / along).sum(axis=0)
        multiplier = self.thrust * (rise / along).sum(axis=0) / (self.wall.weight * sway)
        multiplier[-1] = 0.0
        return BendingCurve(theta[0], moved, multiplier)

    @property
    def tie(self) -> Tie:
        """What stands for the thrust in `Masonry.between_sides`: a tie of that strength from side to side."""
        t, half, z = 2 * self.wall.b, 0.5 * self.wall.length, self.wall.h
        ends = [(0.5 * t, sign * (half + 0.5 * t), z) for sign in (-1, 1)]
        blocks = {"block": "side_0", "anchor_block": "side_1"}
        stiffness = TIE_STIFFNESS * self.thrust / t
        return Tie(stiffness=stiffness, strength=self.thrust, at=ends[0], anchor=ends[1], **blocks)  # type: ignore[arg-type]
