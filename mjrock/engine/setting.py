"""What a run solves, as arrays for compiled functions: contacts, ties, masses, and the ground that moves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..geometry.kinematics import Ties
from ..method import METHOD, Method
from ..quantities import Array
from ..scene.course import Course
from ..scene.dampers import Dampers, damp, damping_forces
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
        dampers: the dampers.
        damping: their forces in the last step [N], shape (d,).
        damps: whether they act as applied forces; else the engine has them in its text.
        duration: how long the motion is followed [s].
    """

    points: Points
    ties: Ties
    masses: Array
    ground: Ground
    dampers: Dampers
    damping: Array
    damps: bool
    duration: float

    @classmethod
    def of(cls, scene: Scene, course: Course, method: Method = METHOD, *, damps: bool = True) -> Setting:
        """That of a run, whose ties yield in it alone."""
        ties, damping = scene.ties._replace(reach=scene.ties.reach.copy()), np.zeros(len(scene.damper_c))
        acting = scene.dampers, damping, damps, float(course.duration)
        return cls(points_of(scene, method), ties, scene.masses, course.ground, *acting)


@jitable
def push(memory: Memory, setting: Setting, frames: Array, t: float) -> None:
    """Write the forces of the moving ground and of the dampers in the step that is set into the applied forces.

    A damper acts at the velocity of the pose. That of the text, which a fixed step has, acts half a step earlier.
    """
    dampers, axes, ahead = setting.dampers, setting.points.places.axes, 0.5 * memory.options[TIMESTEP]
    if len(dampers.c) > 0:
        for j in range(len(memory.applied)):
            memory.applied[j] = memory.velocity[j] + (ahead * memory.acceleration[j] if setting.damps else 0.0)
        damping_forces(dampers, frames, memory.applied, axes, setting.damping)
    memory.applied[:] = 0.0
    if setting.damps:
        damp(dampers, frames, setting.damping, axes, memory.applied)
    push_ground(setting.ground, setting.masses, axes, t, memory.options[TIMESTEP], memory.applied)
