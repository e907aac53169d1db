"""The problem of masonry that stands, and is shaken or set moving."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import Array, keep, require_array, require_kind, require_whole, require_within, shown
from ..ground.motion import GroundMotion
from ..wall.effects import KINDS, Effect, Load
from .masonry import Masonry
from .support import supports_of

FASTEST = 1e3
"""Largest velocity at the release [m/s, rad/s]."""
COMPARED = ("masonry", "duration", "motion", "vertical", "effects", "supports")
"""What two equal cases share, beside the velocity."""


@dataclass(frozen=True, eq=False)
class MasonryCase:
    """Masonry at rest under its weight, and what moves it.

    Args:
        masonry: the blocks and their joints.
        duration: how long to follow the motion [s], 1e-6 to 1e6.
        motion: horizontal acceleration of the ground and of all fixed blocks, or None. A positive one pushes the blocks
            to the left. Responses are motions as seen from the ground.
        vertical: the same, vertical. A positive one is upwards and presses the blocks on their joints.
        effects: ties, loads, thrusts and added masses. Each says which `block` it belongs to, by its number in
            `masonry.blocks`. Heights are z; offsets are measured from the centroid of the block. A tie holds the left
            end of its block at its height.
        velocity: velocity of each block that is not fixed at the release: x, z and rotation [m/s, m/s, rad/s], shape
            (bodies, 3), each within -1000 to 1000. None is rest. The rotation is positive where the top of a block
            turns to the right.

        supports: displacement histories of fixed blocks, by name, (t, dx, dz) in s and m, for `solve_explicit`.

    Raises:
        ValueError: for a value outside its range, velocities of another shape, or an effect that is not on its block.
    """

    masonry: Masonry
    duration: float
    motion: GroundMotion | None = None
    vertical: GroundMotion | None = None
    velocity: Array | ArrayLike | None = None
    effects: tuple[Effect, ...] = ()
    supports: Any = ()

    def __post_init__(self) -> None:
        require_kind("masonry", self.masonry, Masonry)
        keep(self, duration=require_within("duration", self.duration, 1e-6, 1e6, "s"))
        for name in ("motion", "vertical"):
            require_kind(name, getattr(self, name), GroundMotion, type(None))
        if self.velocity is not None:
            velocity = require_array("velocity", self.velocity, (len(self.masonry.free), 3))
            for value in velocity[np.abs(velocity) > FASTEST].tolist():
                require_within("velocity", value, -FASTEST, FASTEST, "m/s or rad/s")
            velocity.setflags(write=False)
            keep(self, velocity=velocity)
        self._require_effects()
        keep(self, supports=supports_of(self.masonry, self.supports))

    def _require_effects(self) -> None:
        """Check that each effect is on a block that is not fixed, and keep them as a tuple."""
        given = (self.effects,) if isinstance(self.effects, KINDS) else self.effects
        if not isinstance(given, Sequence) or isinstance(given, str):
            raise TypeError(f"effects = {shown(self.effects)} is no sequence of Tie, Thrust, Load, AddedMass or Damper")
        keep(self, effects=tuple(given))
        for i, one in enumerate(self.effects):
            require_kind(f"effects[{i}]", one, *KINDS)
            require_whole(f"effects[{i}], block", one.block, 0, len(self.masonry.blocks) - 1)
            block = self.masonry.blocks[one.block]
            name = f"effects[{i}] on {self.masonry.names[one.block]}"
            if block.fixed:
                raise ValueError(f"{name}: this block is fixed; the valid ones are {list(self.masonry.free)}")
            low, high = block.corners.min(axis=0) - 1e-9, block.corners.max(axis=0) + 1e-9
            require_within(f"{name}, height", one.height, float(low[1]), float(high[1]), "m")
            if isinstance(one, Load):
                middle = float(block.centroid[0])
                require_within(f"{name}, offset", one.offset, float(low[0]) - middle, float(high[0]) - middle, "m")

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, MasonryCase)
            and all(getattr(self, name) == getattr(other, name) for name in COMPARED)
            and (self.velocity is None) == (other.velocity is None)
            and (self.velocity is None or np.array_equal(self.velocity, np.asarray(other.velocity)))
        )

    def __hash__(self) -> int:
        return hash((self.masonry, self.duration, self.motion, self.vertical, self.effects, self.supports))
