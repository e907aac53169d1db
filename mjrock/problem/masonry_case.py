"""The problem of masonry that stands, and is shaken or set moving."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .masonry import Masonry
from .motion import GroundMotion
from .quantities import Array, require_array, require_kind, require_within

FASTEST = 1e3
"""Largest velocity at the release [m/s, rad/s]."""
COMPARED = ("masonry", "duration", "motion", "vertical")
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
        velocity: velocity of each block that is not fixed at the release: x, z and rotation [m/s, m/s, rad/s], shape
            (bodies, 3), each within -1000 to 1000. None is rest. The rotation is positive where the top of a block
            turns to the right.

    Raises:
        ValueError: for a value outside its range, or velocities of another shape.
    """

    masonry: Masonry
    duration: float
    motion: GroundMotion | None = None
    vertical: GroundMotion | None = None
    velocity: Array | ArrayLike | None = None

    def __post_init__(self) -> None:
        require_kind("masonry", self.masonry, Masonry)
        require_within("duration", self.duration, 1e-6, 1e6, "s")
        for name in ("motion", "vertical"):
            require_kind(name, getattr(self, name), GroundMotion, type(None))
        if self.velocity is not None:
            velocity = require_array("velocity", self.velocity, (len(self.masonry.free), 3))
            for value in velocity[np.abs(velocity) > FASTEST].tolist():
                require_within("velocity", value, -FASTEST, FASTEST, "m/s or rad/s")
            velocity.setflags(write=False)
            object.__setattr__(self, "velocity", velocity)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, MasonryCase)
            and all(getattr(self, name) == getattr(other, name) for name in COMPARED)
            and (self.velocity is None) == (other.velocity is None)
            and (self.velocity is None or np.array_equal(self.velocity, np.asarray(other.velocity)))
        )

    def __hash__(self) -> int:
        return hash((self.masonry, self.duration, self.motion, self.vertical))
