"""Sliding: contacts that slide obey Coulomb's law, which the rows of the engine alone do not.

A friction row of MuJoCo requires its slip to stop within the step. While the contact slides on, the cone answers with a
normal force on top of the contact law, mu m_n |v_t| / h, with m_n the inertia of the normal row and v_t the slip. With
m_n = h c / 2 + beta h^2 k it presses the bodies apart by mu (c / 2 + beta h k) |v_t|, which no short step removes.

So a contact that slides has no friction row. The force of friction, mu times the normal force and against the slip, is
applied to the two bodies. The normal force follows from the contact law at the accelerations of the step, which the
engine finds with the force in place. One such iteration is most often enough, because the normal force hardly depends
on friction within a step. A contact whose slip friction stops within the step gets its row back, which stops
and then holds it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..contacts.solref import inertia_of
from ..geometry.kinematics import Meeting, Places, meeting, push_apart, relative_velocity, where_friction_acts
from ..geometry.vectors import Vector, dot, minus, plus, put, scaled, tangent, vector
from ..method import METHOD, Method
from ..quantities import Array, Flags
from .memory import IMPRATIO, TIMESTEP, EngineArrays
from .rows import Points
from .setting import Setting, push
from .touches import ROUNDING_OF_GAP

SMOOTH, ROUGH = 1, 3
"""MuJoCo's dimension of a contact without and with rows of friction."""
SLOWEST = 1e-300
"""Slip below which it has no direction [m/s]."""
STAGE_VELOCITY = 2
"""mjSTAGE_VEL: positions and velocities are as before, and only forces have changed."""


class Sliding(NamedTuple):
    """The contacts that slide in a step.

    Args:
        coulomb: whether contacts that slide obey Coulomb's law; otherwise all have their rows.
        method: the constants of the method.
        slides, slid: which contacts slide in this step, and which slid in the last, shape (m,).
        force: friction of each that does, along its direction, on the body that carries the point [N], shape (m,).
        direction: unit vectors along the faces, shape (m, d): (nz, -nx) in the plane, and in space that of the slip,
            along which the friction is negative.
    """

    coulomb: bool
    method: Method
    slides: Flags
    slid: Flags
    force: Array
    direction: Array

    @classmethod
    def at_start(cls, points: Points, *, coulomb: bool, method: Method = METHOD) -> Sliding:
        """No contact slides at the start."""
        none, directions = np.zeros((2, len(points.rubs)), dtype=np.bool_), np.zeros_like(points.places.normal)
        rubs = coulomb and bool(points.rubs.any())
        return cls(rubs, method, none[0], none[1], np.zeros(len(points.rubs)), directions)


class Slipping(NamedTuple):
    """How fast two bodies slip [m/s], and the unit vector along which they do; see `Sliding` for its sign."""

    speed: float
    direction: Vector


@inlined
def slip_of(normal: Vector, velocity: Vector) -> Slipping:
    """The slip of a velocity over a face."""
    if len(normal) == 2:
        along_face = tangent(normal)
        return Slipping(dot(along_face, velocity), along_face)
    tangential = minus(velocity, scaled(dot(normal, velocity), normal))
    speed = math.sqrt(dot(tangential, tangential))
    return Slipping(speed, scaled(1.0 / max(speed, SLOWEST), tangential))


@inlined
def slipping(places: Places, i: int, meets: Meeting, frames: Array, v: Array) -> Slipping:
    """Slip of contact i where friction acts for velocities v."""
    return slip_of(meets.normal, relative_velocity(places, i, meets, frames, v))


@inlined
def set_direction(sliding: Sliding, i: int, direction: Vector) -> float:
    """Write the direction of contact i, and return by how much it has changed [-]."""
    change = minus(direction, vector(sliding.direction, i, direction))
    put(sliding.direction[i], direction)
    return math.sqrt(dot(change, change))


@inlined
def update_direction(
    memory: EngineArrays, places: Places, sliding: Sliding, i: int, meets: Meeting, frames: Array
) -> float:
    """Write the direction of contact i at the velocity of the pose, and return by how much it has changed [-].

    The leapfrog keeps the velocity of half a step before. The slip may turn with the motion in between.
    """
    before = relative_velocity(places, i, meets, frames, memory.velocity)
    ahead = scaled(0.5 * memory.options[TIMESTEP], relative_velocity(places, i, meets, frames, memory.acceleration))
    return set_direction(sliding, i, slip_of(meets.normal, plus(before, ahead)).direction)


@inlined
def pressing_force(memory: EngineArrays, points: Points, i: int, meets: Meeting, frames: Array) -> float:
    """Force of the contact law at the velocity and acceleration in the memory, not below zero [N]."""
    places, d, W = points.places, memory.rows.solimp[i, 0], points.weight[i]
    rate = dot(meets.normal, relative_velocity(places, i, meets, frames, memory.velocity))
    closing = dot(meets.normal, relative_velocity(places, i, meets, frames, memory.acceleration))
    sprung = memory.rows.solref[i, 0] * meets.gap + memory.rows.solref[i, 1] * rate
    return max(sprung / ((1 - d) * W) - inertia_of(d, W) * closing, 0.0)


@inlined
def find_sliding(memory: EngineArrays, points: Points, sliding: Sliding, frames: Array) -> bool:
    """Whether a contact slides; its friction is guessed from the acceleration of the last step, its row let go.

    A contact slides where its slip is more than its row could stop, and the row would press it apart.
    """
    any_slides, places = False, points.places
    for i in range(len(sliding.slides)):
        sliding.slides[i] = False
        if not points.rubs[i]:
            continue
        meets = where_friction_acts(places, meeting(places, i, frames))
        if meets.gap > -ROUNDING_OF_GAP * places.radius:
            continue
        mu, now = places.friction[i], slipping(places, i, meets, frames, memory.velocity)
        inertia = inertia_of(memory.rows.solimp[i, 0], points.weight[i])
        stopping = inertia * abs(now.speed) / memory.options[TIMESTEP]
        pressing = pressing_force(memory, points, i, meets, frames)
        beyond = memory.options[IMPRATIO] * stopping > sliding.method.slides * mu * pressing
        if beyond and mu * stopping > sliding.method.neglected * pressing:
            sliding.slides[i] = any_slides = True
            sliding.force[i] = -math.copysign(mu * pressing, now.speed)
            set_direction(sliding, i, now.direction)
            memory.dimension[i] = SMOOTH
    return any_slides


@inlined
def apply_friction(memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, t: float) -> None:
    """Write the force of the moving ground and the friction of what slides into the applied forces."""
    places = setting.points.places
    push(memory, setting, frames, t)
    for i in range(len(sliding.slides)):
        if sliding.slides[i]:
            meets = where_friction_acts(places, meeting(places, i, frames))
            force = scaled(sliding.force[i], vector(sliding.direction, i, meets.normal))
            push_apart(places, i, meets, frames, force, memory.applied)


@inlined
def update_friction(memory: EngineArrays, points: Points, sliding: Sliding, frames: Array, n: int) -> tuple[bool, bool]:
    """Bring the friction of what slides up to date with the accelerations that the engine found in iteration n.

    A contact gets its row back where friction stops its slip within the step, or where no force is found: beyond some
    coefficient friction raises the normal force by more than that gives, and the contact jams. Returns whether another
    iteration is needed, and whether a row was given back.
    """
    change, turning, largest, places, method = 0.0, 0.0, 0.0, points.places, sliding.method
    for i in range(len(sliding.slides)):
        if sliding.slides[i]:
            meets = where_friction_acts(places, meeting(places, i, frames))
            slip = slipping(places, i, meets, frames, memory.velocity).speed
            pressing = pressing_force(memory, points, i, meets, frames)
            force = -math.copysign(places.friction[i] * pressing, slip)
            turned = update_direction(memory, places, sliding, i, meets, frames)
            change, turning = max(change, abs(force - sliding.force[i])), max(turning, turned * abs(force))
            largest = max(largest, abs(force), abs(sliding.force[i]))
            sliding.force[i] = force
    again, stopped = change > method.known * largest or turning > method.way_known * largest, False
    for i in range(len(sliding.slides)):
        if sliding.slides[i] and (n >= method.patient or not again):
            meets = where_friction_acts(places, meeting(places, i, frames))
            now = slipping(places, i, meets, frames, memory.velocity)
            faster = dot(now.direction, relative_velocity(places, i, meets, frames, memory.acceleration))
            later = now.speed + memory.options[TIMESTEP] * faster
            if now.speed * later <= 0 or (again and n == method.looks - 1):
                memory.dimension[i] = ROUGH
                sliding.slides[i] = False
                stopped = True
    return again or stopped, stopped


@inlined
def slide(memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, t: float) -> bool:
    """Whether contacts slide. The applied forces then have their friction, and the engine lacks the accelerations."""
    if not (sliding.coulomb and find_sliding(memory, setting.points, sliding, frames)):
        return False
    rows_changed = True
    for n in range(sliding.method.looks):
        apply_friction(memory, setting, sliding, frames, t)
        if rows_changed:
            memory.forward(memory.model, memory.data)
        else:
            memory.accelerate(memory.model, memory.data, STAGE_VELOCITY, 1)
        for j in range(len(memory.guess)):
            memory.guess[j] = memory.acceleration[j]
        again, rows_changed = update_friction(memory, setting.points, sliding, frames, n)
        if not again:
            break
    if rows_changed:
        memory.forward(memory.model, memory.data)
    apply_friction(memory, setting, sliding, frames, t)
    return True


@inlined
def sliding_changed(sliding: Sliding) -> bool:
    """Whether a contact has begun or ceased to slide in the step, which is then the last one."""
    changed = False
    for i in range(len(sliding.slides)):
        changed = changed or sliding.slides[i] != sliding.slid[i]
        sliding.slid[i] = sliding.slides[i]
    return changed


@inlined
def any_slid(sliding: Sliding) -> bool:
    """Whether a contact slid in the last step."""
    slid = False
    for i in range(len(sliding.slid)):
        slid = slid or sliding.slid[i]
    return slid


@inlined
def time_to_stop(places: Places, sliding: Sliding, frames: Array, v: Array, a: Array) -> float:
    """Time in which the slip of a contact that slid in the last step ends [s], infinite where it does in none.

    Friction turns round as a slip does. Within a long step the velocity would miss much of that.
    """
    soonest = math.inf
    for i in range(len(sliding.slid)):
        if sliding.slid[i]:
            meets = where_friction_acts(places, meeting(places, i, frames))
            now = slipping(places, i, meets, frames, v)
            faster = dot(now.direction, relative_velocity(places, i, meets, frames, a))
            if now.speed * faster < 0:
                soonest = min(soonest, -now.speed / faster)
    return soonest


@inlined
def give_rows_back(memory: EngineArrays, sliding: Sliding) -> None:
    """Give every contact that slid its row back, and clear the applied forces."""
    memory.applied[:] = 0.0
    for i in range(len(sliding.slides)):
        if sliding.slides[i]:
            memory.dimension[i] = ROUGH


@inlined
def find_acceleration(memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, t: float) -> None:
    """Let the engine find the accelerations of a step, and make none."""
    if slide(memory, setting, sliding, frames, t):
        memory.accelerate(memory.model, memory.data, STAGE_VELOCITY, 1)
        give_rows_back(memory, sliding)
    else:
        push(memory, setting, frames, t)
        memory.forward(memory.model, memory.data)
