"""The course of a run: what happens to a scene."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..problem.ground.motion import GroundMotion
from ..quantities import Array
from .ground import Ground
from .scene import Scene


@dataclass(frozen=True, eq=False)
class Course:
    """How a scene starts, for how long it is followed, and how the ground moves.

    Args:
        pose, velocity: of the bodies at the start, shape (n, nq) and (n, nv).
        duration: how long to follow the motion [s].
        motion, vertical: acceleration of the ground, horizontal and upwards, or None.
        transverse: the same along y, in space.
        released: whether the start is a release, whose rotation is the first peak. Otherwise an earlier run goes on.
    """

    pose: Array
    velocity: Array
    duration: float
    motion: GroundMotion | None = None
    vertical: GroundMotion | None = None
    released: bool = True
    transverse: GroundMotion | None = None

    def continued(self, pose: Array, velocity: Array) -> Course:
        """The same from another state, in which an earlier run ended."""
        return replace(self, pose=pose, velocity=velocity, released=False)

    @property
    def ground(self) -> Ground:
        """The motions of the ground for compiled functions."""
        return Ground.of(self.motion, self.vertical, self.transverse)

    @property
    def sampling(self) -> list[float]:
        """Time steps of the records that move the ground [s]."""
        return [motion.dt for motion in (self.motion, self.vertical, self.transverse) if motion is not None]

    def energy(self, scene: Scene) -> float:
        """Energy at the start above the scene at rest [J]."""
        return float(scene.energy(self.pose[None], self.velocity[None])[0])
