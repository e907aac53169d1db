"""What a run solves, as arrays for compiled functions: contacts, ties, masses, and the ground that moves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..geometry.kinematics import Ties
from ..geometry.vectors import increase, minus
from ..method import METHOD, Method
from ..quantities import Array
from ..scene.course import Course, Ground, push_ground
from ..scene.dampers import Dampers, damp, damping_forces
from ..scene.masses import gyroscopic
from ..scene.scene import Scene
from .memory import TIMESTEP, EngineArrays
from .rows import Points, points_of


class Setting(NamedTuple):
    """The arrays of a run that no step changes, but for ties that yield and the forces of dampers.

    Args:
        points: the contacts.
        ties: the ties.
        masses: the generalised ones, shape (n nv,).
        products: products of inertia of bodies of space, see `mjrock.scene.masses`, shape (n, 3), or (0, 3).
        ground: how the ground moves.
        dampers: the dampers.
        damping: their forces in the last step [N], shape (d,).
        refines: whether dampers, and what MuJoCo's gyroscopic moments lack, act as applied forces at the velocity of
            the pose; otherwise the engine does what is in its text.
        splits: whether accelerations are split into the answer to the ground and what is smooth, see
            `mjrock.engine.loop`: those of one body on moving ground.
        duration: how long the motion is followed [s].
    """

    points: Points
    ties: Ties
    masses: Array
    products: Array
    ground: Ground
    dampers: Dampers
    damping: Array
    refines: bool
    splits: bool
    duration: float

    @classmethod
    def of_run(cls, scene: Scene, course: Course, method: Method = METHOD, *, refines: bool = True) -> Setting:
        """That of a run, whose ties yield in it alone."""
        return cls(
            points=points_of(scene, method),
            ties=scene.ties._replace(reach=scene.ties.reach.copy()),
            masses=scene.bodies.masses,
            products=scene.bodies.products,
            ground=course.ground,
            dampers=scene.dampers,
            damping=np.zeros(len(scene.links.damped.names)),
            refines=refines,
            splits=len(scene.bodies.names) == 1 and any(len(shaking.accel) for shaking in course.ground),
            duration=float(course.duration),
        )


@inlined
def add_gyroscopic_correction(memory: EngineArrays, setting: Setting, axes: tuple[int, ...], ahead: float) -> None:
    """Add to the applied forces what MuJoCo's gyroscopic moments lack in space; in the plane there are none.

    MuJoCo has -w x I w at the velocity that it keeps, half a step before the pose. This is first order in the step, and
    energy grows by it. The difference to the velocity of the pose, w + h/2 w', makes it second order.
    """
    if len(axes) == 2:
        return  # the rest is then not compiled
    v, a = memory.velocity, memory.acceleration
    for body in range(len(setting.products)):
        x, y, z = 6 * body + 3, 6 * body + 4, 6 * body + 5
        before = (v[x], v[y], v[z])
        at_pose = (v[x] + ahead * a[x], v[y] + ahead * a[y], v[z] + ahead * a[z])
        correction = minus(
            gyroscopic(setting.masses, setting.products, body, before),
            gyroscopic(setting.masses, setting.products, body, at_pose),
        )
        increase(memory.applied[x:], correction)


@inlined
def push(memory: EngineArrays, setting: Setting, frames: Array, t: float) -> None:
    """Write the forces of the moving ground and of the dampers in the step that is set into the applied forces.

    A damper acts at the velocity of the pose where `setting.refines`; a damper of the model text, which a fixed step
    has, acts at the velocity half a step earlier. The same holds for the gyroscopic moments of bodies of space.
    """
    dampers, axes, ahead = setting.dampers, setting.points.places.axes, 0.5 * memory.options[TIMESTEP]
    if len(dampers.law) > 0:
        for j in range(len(memory.applied)):
            memory.applied[j] = memory.velocity[j] + (ahead * memory.acceleration[j] if setting.refines else 0.0)
        damping_forces(dampers, frames, memory.applied, setting.damping)
    memory.applied[:] = 0.0
    if setting.refines:
        damp(dampers, frames, setting.damping, memory.applied)
        add_gyroscopic_correction(memory, setting, axes, ahead)
    push_ground(setting.ground, setting.masses, axes, t, memory.options[TIMESTEP], memory.applied)
