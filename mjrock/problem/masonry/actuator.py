"""An actuator: it pushes a point of a block, or all blocks, to a displacement, as the jack of a laboratory does."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np

from ...quantities import Within, keep, keep_declared, require_array, require_reals, require_whole, shown
from ..wall.effect import BLOCKS, FARTHEST_POINT, Effect, PointOf
from .histories import Times, history_of

LARGEST_STROKE = 10.0
"""Largest displacement of an actuator [m]: a larger one is in mm."""
Stroke = tuple[Times, tuple[Annotated[float, Within(-LARGEST_STROKE, LARGEST_STROKE, "m")], ...]]
"""History of the displacement of an actuator."""


class Guide(NamedTuple):
    """What a guide keeps a block from: rising, and turning."""

    rising: bool = False
    turning: bool = False


GUIDES = {None: Guide(), "upright": Guide(turning=True), "translation": Guide(rising=True, turning=True)}
"""What `guided` may be."""


@dataclass(frozen=True, repr=False)
class Actuator(Effect):
    """An actuator that drives a point of a block of masonry along a direction, through a spring, or all blocks.

    Its force is stiffness (d - u) + damping (d' - u'): d is the history, u the displacement of the point along the
    direction since the masonry stood at rest, or as drawn, and d' and u' are their rates. Without a block it pushes
    every free block in proportion to its mass, with added masses, and u is the displacement of their common centroid.
    The actuator pushes and pulls, and its direction stays as it is in space. Its force at the samples is
    `response.actuators` [N], positive where it pushes along the direction. What it puts in is in `ledger.actuators`,
    what its spring holds in `ledger.elastic`, and what its dashpot takes in `ledger.dashpots`. A stiffness far above
    that of the joints follows the history closely and makes the steps short. Without damping the block swings on the
    spring.

    Args:
        block: the block that it drives, by its name or number, or None for all free blocks.
        at: the point of the block that it drives, as drawn, x, z and in space x, y, z [m], -10000 to 10000; None for
            all free blocks.
        direction: 1 or -1 along x, or a vector of any length, (x, z) and in space (x, y, z), kept as a unit
            vector. All free blocks of masonry in space take a vector.
        displacement: (t, d) in s and m, from (0, 0) on, linear in between and constant after the last, within 10 m.
            None rests, for `push`, which finds its own.
        stiffness: of its spring [N/m], 1 to 1e12.
        damping: of its dashpot [N s/m], 0 to 1e12.
        guided: how the block is guided from the start on: None leaves it free, "upright" keeps it from turning, as a
            beam that a constant load presses on the wall, and "translation" from turning and rising, as a beam of a rig
            that is held in both. Guides do no work, so that the block starts with no velocity that they do not allow.

    Raises:
        TypeError, ValueError: for a value outside its range. A case checks that the point is on the block.
    """

    label: ClassVar[str] = "actuator"
    only: ClassVar[str] = "solve_explicit"
    arguments: ClassVar[str] = "block, at, direction,\ndisplacement, stiffness"
    block: Annotated[Any, int, str]
    at: Annotated[Any, PointOf, type(None), Within(-FARTHEST_POINT, FARTHEST_POINT, "m")]
    direction: Annotated[Any, float, tuple[float, ...]]
    displacement: Annotated[Any, Stroke]
    stiffness: Annotated[float, Within(1, 1e12, "N/m")]
    damping: Annotated[float, Within(0, 1e12, "N s/m")] = 0.0
    guided: Literal["upright", "translation"] | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if self.block is None:
            self._require_all()
        else:
            at = require_reals("at of the actuator", self.at, "x, z or x, y, z")
            keep(self, at=tuple(require_array("at of the actuator", at, (3,) if at.shape == (3,) else (2,)).tolist()))
        if not isinstance(self.guided, str | None) or self.guided not in GUIDES:
            names = "None, 'upright' and 'translation'"
            raise ValueError(f"guided of the actuator = {shown(self.guided)} is not known; the valid ones are {names}")
        if not isinstance(self.block, str | None):
            keep(self, block=require_whole("block of the actuator", self.block, 0, BLOCKS))
        if self.displacement is None:
            keep(self, displacement=((0.0,), (0.0,)))
        shaped = require_reals("direction of the actuator", self.direction if self.at is None else self.at, "a vector")
        keep(
            self,
            direction=_unit(self.direction, 3 if shaped.shape == (3,) else 2),
            displacement=history_of(
                "displacement of the actuator", self.displacement, LARGEST_STROKE, "m", from_zero=True
            ),
        )
        keep_declared(self, "actuator")

    def _require_all(self) -> None:
        """Raise a ValueError unless it is one of all blocks: without a point and without a guide."""
        if self.at is not None or self.guided is not None:
            name, value = ("at", self.at) if self.at is not None else ("guided", self.guided)
            raise ValueError(f"{name} of the actuator = {shown(value)} needs a block; block = None drives all blocks")

    @property
    def height(self) -> float:  # type: ignore[override]
        """Of its point [m], not a number for one that drives all blocks."""
        return math.nan if self.at is None else float(self.at[-1])

    @property
    def guide(self) -> Guide:
        """What its block is kept from."""
        return GUIDES[self.guided]

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        largest = max(self.displacement[1], key=abs)
        where = "all blocks" if self.at is None else f"z = {self.height:g} m"
        return f"{where},\nto {1e3 * largest:g} mm, k = {self.stiffness / 1e6:.4g} kN/mm"


def _unit(direction: object, d: int) -> tuple[float, ...]:
    """The unit vector of a direction, along x for a number, in d dimensions."""
    components = require_reals("direction of the actuator", direction, f"1, -1 or a vector of the shape ({d},)")
    if components.shape == () and abs(float(components)) == 1:
        components = float(components) * np.eye(d)[0]
    vector = require_array("direction of the actuator", components, (d,))
    length = math.hypot(*vector)
    if not 1e-9 < length < math.inf:
        raise ValueError(f"direction of the actuator = {shown(direction)} has no length; it is above 1e-9 and finite")
    return tuple((vector / length).tolist())
