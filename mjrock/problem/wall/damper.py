"""A viscous damper between a wall and the building behind it."""

from __future__ import annotations

from dataclasses import dataclass

from ...quantities import keep, require_whole, require_within
from .limits import BLOCKS, HIGHEST


@dataclass(frozen=True)
class Damper:
    """A linear viscous damper that runs horizontally from the inner face to an anchor behind the wall.

    It resists both ways with c times the rate of its length. A wall at rest does not feel it.

    Args:
        height: where it holds the wall [m].
        c: damping coefficient [N s/m], 0 to 1e9.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        block: the block that it holds.

    Raises:
        ValueError: for a value outside its range.
    """

    height: float
    c: float
    length: float = 5.0
    block: int = 0

    def __post_init__(self) -> None:
        keep(
            self,
            height=require_within("height of the damper", self.height, 0.0, HIGHEST, "m"),
            c=require_within("coefficient c of the damper", self.c, 0.0, 1e9, "N s/m"),
            length=require_within("length of the damper", self.length, 0.01, 1000.0, "m"),
            block=require_whole("block of the damper", self.block, 0, BLOCKS),
        )
