"""What a run solves, as arrays for compiled functions: contacts, ties, masses, and the ground that moves."""

from __future__ import annotations

from typing import NamedTuple

from ..compiled import jitable
from ..geometry.kinematics import Ties
from ..method import METHOD, Method
from ..quantities import Array
from ..scene.course import Course
from ..scene.ground import Ground, push_ground
from ..scene.scene import Scene
from .memory import TIMESTEP, Memory
from .points import Points, points_of


class Setting(NamedTuple):
    """What does not change in a run, but for ties that yield.

    Args:
        points: the contacts.
        ties: the ties.
        masses: the generalised ones, shape (n nv,).
        ground: how the ground moves.
        duration: how long the motion is followed [s].
    """

    points: Points
    ties: Ties
    masses: Array
    ground: Ground
    duration: float

    @classmethod
    def of(cls, scene: Scene, course: Course, method: Method = METHOD) -> Setting:
        """That of a run, whose ties yield in it alone."""
        ties = scene.ties._replace(reach=scene.ties.reach.copy())
        return cls(points_of(scene, method), ties, scene.masses, course.ground, float(course.duration))


@jitable
def push(memory: Memory, setting: Setting, t: float) -> None:
    """Write the force of the moving ground in the step that is set into the applied forces."""
    push_ground(setting.ground, setting.masses, t, memory.options[TIMESTEP], memory.applied)
