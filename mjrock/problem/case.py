"""The physical problem that every solver is asked."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from functools import cached_property

from .block import Block
from .motion import GroundMotion
from .quantities import ON_ITS_FACE, require_flag, require_kind, require_within, shown


@dataclass(frozen=True)
class Case:
    """A wall released, tilted, on its base.

    Args:
        block: the wall.
        theta0: rotation at release [rad]; positive opens away from the side stop.
        duration: how long to follow the motion [s].
        side_stop: whether a stop behind the inner face keeps the rotation from becoming negative (one-sided rocking).
        omega0: angular velocity at release [rad/s], the wall turning about its toe.
        motion: acceleration of the base, or None for a base at rest. Responses are motions as seen from the base.

    Raises:
        ValueError: for a rotation beyond 90 degrees or into the side stop, a duration that is not positive, or a
            motion that is none.
    """

    block: Block
    theta0: float
    duration: float
    side_stop: bool = True
    omega0: float = 0.0
    motion: GroundMotion | None = None

    def __post_init__(self) -> None:
        require_kind("block", self.block, Block)
        require_flag("side_stop", self.side_stop)
        lowest = 0.0 if self.side_stop else -ON_ITS_FACE
        require_within("release rotation theta0", self.theta0, lowest, ON_ITS_FACE, "rad")
        require_within("duration", self.duration, 1e-6, 1e6, "s")
        require_within("release velocity omega0", self.omega0, -100.0, 100.0, "rad/s")
        if abs(self.theta0) > 2 * self.block.alpha:
            warnings.warn(
                f"theta0 = {self.theta0:g} rad is {abs(self.theta0) / self.block.alpha:.3g} alpha: "
                "the wall overturns from 1 alpha; rotations are radians",
                stacklevel=3,
            )
        if not (self.motion is None or isinstance(self.motion, GroundMotion)):
            raise TypeError(f"motion = {shown(self.motion)} is not a GroundMotion")

    @cached_property
    def release_energy(self) -> float:
        """Kinetic and potential energy of the rigid wall at release, above the wall at rest [J]."""
        return self.block.potential_energy(self.theta0) + 0.5 * self.block.toe_inertia * self.omega0**2

    @property
    def direction(self) -> float:
        """Sign of the rotation that the wall is released to, +1 or -1; a side stop leaves only +1."""
        return 1.0 if self.side_stop else math.copysign(1.0, self.theta0 if self.theta0 else self.omega0)

    @property
    def released_outwards(self) -> bool:
        """Whether the wall is released on its way out, so that its first rotation maximum is still to come."""
        return self.direction * self.omega0 > 0

    @property
    def release_peak(self) -> float:
        """The rotation from which the wall would have had to fall to be released as it is [rad], at most alpha."""
        if self.omega0 == 0:
            return abs(self.theta0)
        return self.block.rotation_at(min(self.release_energy, float(self.block.potential_energy(self.block.alpha))))
