"""The forces of contact lines at a pose.

The force along the normal is that of `joint_law`. The dashpot takes the velocity half a step before the pose. Along the
face a spring with a slider acts, or the line sticks rigidly, see `friction`.
"""

from __future__ import annotations

import math

from ...compiled import inlined
from ...geometry.vectors import dot, no_spin, plus, put, read, scaled
from ...problem.masonry.laws.joint_law import normal_force, shear_limit, stored
from ...rows import Row
from ..rotation import apply_impulse_at
from ..system import Books, System
from ..thread import add_line_force
from .faces import TURNED_OVER, Meeting, meeting, relative_velocity, where_friction_rubs
from .friction import along_face, as_vector, begin, carried, last_friction, list_rigid, sprung_friction, turned_along
from .touches import due_impulse, foreseen, time_closed, touched_forces, was_open

TOUCH_PASSES = 3
"""Passes over the lines that touched in a step, which change the rates of each other. A pass reads the rates of all
lines before it applies an impulse to any, so that their order does not matter."""


@inlined
def lost_past_face_edge(line: Row, meet: Meeting, opened: float) -> float:
    """Energy that a line has lost in the last step because it was past the end of its face before or after it [J]: the
    decrease of its spring energy minus the work it has done while the gap grew by some length [m].

    A line whose gap changed by as much as it moved has opened or closed within the step, and has lost no energy at an
    end.
    """
    mean = 0.5 * (normal_force(line, -line.depth, 0.0) + normal_force(line, meet.gap, 0.0))
    lost: float = stored(line, -line.depth) - stored(line, meet.gap) - mean * opened
    if line.depth == 0:
        return min(lost, 0.0)
    return lost if meet.gap < 0 else max(lost, 0.0)


@inlined
def press_lines(system: System, books: Books, h: float, force_time: float, steps_ahead: float) -> tuple[int, int]:
    """Add the forces of all lines but rigid friction, and list the lines that stick rigidly, and those that touched.

    Args:
        system, books: the bodies and their lines, and the accounts.
        h: length of the step that led to the pose [s], zero at the start.
        force_time: for how long the forces act on the velocities [s].
        steps_ahead: by how many steps dashpots look ahead, see `foreseen`.

    Returns:
        How many lines stick rigidly, and how many met or left their face in the last step.
    """
    bodies, lines, supports, active, touched = system.bodies, system.lines, system.supports, 0, 0
    dissipated, support_work = 0.0, 0.0
    for p in range(len(lines)):
        line = lines[p]
        if line.k == 0 and line.margin == math.inf:
            continue  # a law of its joint holds it, or it is handed over, see `contact_search`
        meet = meeting(system, line)
        if 0 <= meet.gap < TURNED_OVER:
            line.widest = max(line.widest, 0.0 if meet.past else meet.gap)
            if was_open(line):
                put(line.shear_state, no_spin(meet.normal))
                continue
        meet = where_friction_rubs(meet)
        velocity = relative_velocity(bodies, line, supports, meet)
        rate, slip = dot(meet.normal, velocity), along_face(meet.normal, velocity)
        spring_force, push = normal_force(line, meet.gap, 0.0), normal_force(line, meet.gap, rate)
        if steps_ahead > 0 and push > 0 and line.push > 0:
            push = normal_force(line, meet.gap, foreseen(line, rate, push, steps_ahead))
        if (push > 0) != (line.push > 0) or (meet.gap < 0) != (line.depth > 0):
            spring_force, push = touched_forces(line, meet.gap, rate, h)
            if line.due != 0:
                books.touched[touched] = p
                touched += 1
        books.dashpots[line.group] -= 0.5 * h * (line.dashpot_force + push - spring_force) * rate
        if meet.past or line.past == 1:
            books.totals[0].joint_ends += lost_past_face_edge(line, meet, h * rate)
        last_shear, friction = read(line.shear_force), no_spin(meet.normal)
        if push <= 0:
            if push < 0 and line.push > 0:
                friction = scaled(push / line.push, turned_along(meet.normal, last_friction(bodies, line, last_shear)))
            put(line.shear_state, no_spin(meet.normal))
        elif line.k_s < math.inf:
            friction = sprung_friction(bodies, line, meet.normal, slip, push, time_closed(line, meet.gap, rate, h))
        elif line.friction > 0:
            books.active[active] = p
            list_rigid(system, line, (len(meet.normal) - 1) * active, meet, velocity, force_time)
            begin(system, line, (len(meet.normal) - 1) * active, shear_limit(line, push), force_time, meet.normal)
            active += 1
        shear_impulse = scaled(0.5 * h, plus(last_shear, friction))
        dissipated -= dot(shear_impulse, slip)
        if line.support >= 0:
            impulse = plus(scaled(0.5 * h * (line.push + push), meet.normal), as_vector(meet.normal, shear_impulse))
            support_work += carried(line, supports, impulse)
        line.push, line.rate = push, rate
        line.dashpot_force = push - spring_force if meet.gap < 0 or push < 0 else 0.0
        line.depth, line.past = max(-meet.gap, 0.0), meet.past
        put(line.shear_force, friction)
        if meet.gap == TURNED_OVER:
            line.k = line.c = line.friction = 0.0
        force = plus(scaled(push, meet.normal), as_vector(meet.normal, friction))
        add_line_force(books.pending, bodies, line, (meet.arm, meet.face_arm), force)
    books.totals[0].friction += dissipated
    books.totals[0].ground += support_work
    return active, touched


@inlined
def settle_touches(system: System, books: Books, count: int, force_time: float) -> tuple[float, float]:
    """Let the springs of lines that closed or opened in the step do the remaining work of their touch, see `touches`.

    Returns the energy that the halves of these impulses before the pose have taken, which a sample counts as held by
    the springs, and the work of the supports through them [J].
    """
    stored_energy, support_work = 0.0, 0.0
    for i in range(count):
        books.impulse[i] = 0.0
    for _ in range(TOUCH_PASSES):
        for i in range(count):
            line = system.lines[books.touched[i]]
            meet = meeting(system, line)
            rate = dot(meet.normal, relative_velocity(system.bodies, line, system.supports, meet))
            books.remaining[i] = due_impulse(line, rate) - books.impulse[i]
        for i in range(count):
            line, impulse = system.lines[books.touched[i]], books.remaining[i]
            meet = meeting(system, line)
            apply_impulse_at(system.bodies[line.body], meet.arm, scaled(impulse, meet.normal))
            if line.face >= 0:
                apply_impulse_at(system.bodies[line.face], meet.face_arm, scaled(-impulse, meet.normal))
            books.impulse[i] += impulse
    for i in range(count):
        line = system.lines[books.touched[i]]
        if line.support >= 0:
            impulse = 0.5 * books.impulse[i]
            support_work += carried(line, system.supports, scaled(impulse, meeting(system, line).normal))
        line.push, line.due = line.push + books.impulse[i] / force_time, 0.0
        stored_energy -= 0.5 * books.impulse[i] * line.rate
    books.totals[0].ground += support_work
    return stored_energy, support_work
