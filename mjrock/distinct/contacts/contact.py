"""A contact line at a pose: where it presses, how fast, and with what force.

The force along the normal is that of `joint_law`. The dashpot takes the velocity half a step before the pose. Along the
face a spring with a slider acts, or the line sticks rigidly, see `friction`.

A line beyond the outline of its face has moved past an end of it. The nearest point of the outline then presses on the
face of the block that carries the line. Past the outline of that face too the contact has no force, and it has none
once the two faces are turned away from each other. A line that the contact search has found has no end.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, minus, no_spin, plus, put, read, scaled, spun, vector
from ...problem.masonry.laws.joint_law import normal_force, shear_limit, stored
from ..rotation import apply_impulse_at, in_body, in_world, may_face_away, rotation_change
from ..rows import POINT_ON_FIXED_BLOCK, Row, Rows
from ..supports import Supports
from ..system import Books, System
from ..thread import press_apart
from .faces import is_beside, pulled_inside
from .friction import along_face, as_vector, begin, carried, last_friction, list_rigid, sprung_friction, turned_along
from .touches import due_impulse, foreseen, time_closed, touched_forces, was_open

GAP_OF_OPEN = 1.0
"""Gap of a line that has left its face [m]."""
TURNED_OVER = 2 * GAP_OF_OPEN
"""Gap of a line whose block has turned over [m]. The contact does not close again."""
TOUCH_PASSES = 3
"""Passes over the lines that touched in a step, which change the rates of each other. A pass reads the rates of all
lines before it applies an impulse to any, so that their order does not matter."""


class Meeting(NamedTuple):
    """A line at a pose.

    Args:
        gap: [m].
        normal: out of the face.
        arm: from the centroid of the body to the line [m].
        face_arm: from the centroid of the body of the face to the line [m]; of a fixed block no arm is taken.
        past: whether the line is past the end of the face.
    """

    gap: float
    normal: Vector
    arm: Vector
    face_arm: Vector
    past: bool


@inlined
def position_over_face(system: System, line: Row) -> tuple[Vector, Vector, Vector, Vector]:
    """Position of the point of a line relative to its face, the normal of the face, and the arms, see `Meeting`."""
    body, at, normal = system.bodies[line.body], read(line.at), read(line.normal)
    change = rotation_change(body, at)
    arm, offset = plus(at, change), plus(read(line.between), plus(read(body.place), change))
    face_arm = arm
    if line.face >= 0:
        face, origin = system.bodies[line.face], read(line.origin)
        change = rotation_change(face, origin)
        offset = minus(offset, plus(read(face.place), change))
        face_arm = plus(plus(origin, change), offset)
        normal = plus(normal, rotation_change(face, normal))
    else:
        if line.support >= 0:
            offset = minus(offset, vector(system.supports.moved, line.support, at))
        if line.face == POINT_ON_FIXED_BLOCK:
            normal, arm = in_world(body, normal), minus(arm, offset)
    return offset, normal, arm, face_arm


@inlined
def meeting(system: System, line: Row) -> Meeting:
    """Where a line is."""
    body = system.bodies[line.body]
    offset, normal, arm, face_arm = position_over_face(system, line)
    gap = dot(normal, offset)
    if gap < 0 and line.margin < math.inf:
        turned = may_face_away(body) or (line.face >= 0 and may_face_away(system.bodies[line.face]))
        if turned and dot(normal, in_world(body, read(line.normal))) < 0:
            return Meeting(TURNED_OVER, normal, arm, face_arm, True)
        if dot(offset, offset) - gap * gap > line.margin:
            return past_face_edge(system, line, offset, Meeting(gap, normal, arm, face_arm, False))
    return Meeting(gap, normal, arm, face_arm, False)


@inlined
def past_face_edge(system: System, line: Row, offset: Vector, meet: Meeting) -> Meeting:
    """Where a line is that may have moved past the outline of its face, `offset` from its place there at rest [m]."""
    fixed = line.face < 0
    face, body = system.bodies[max(line.face, 0)], system.bodies[line.body]
    reached = plus(read(line.origin), offset if fixed else in_body(face, offset))
    inside, share = pulled_inside(system.edges, line.first, line.last, reached)
    if share == 0:
        return meet
    over = minus(reached, inside)
    from_outline = plus(scaled(meet.gap, meet.normal), over if fixed else in_world(face, over))  # from the outline
    own = in_world(body, read(line.normal))
    gap = dot(own, from_outline)
    along = minus(from_outline, scaled(gap, own))
    place = minus(read(line.at), in_body(body, along))
    if is_beside(system.edges, line.own_first, line.own_last, place):
        gap = GAP_OF_OPEN
    normal = plus(meet.normal, scaled(min(share, 1.0), minus(own, meet.normal)))
    normal = scaled(1 / math.sqrt(dot(normal, normal)), normal)
    return Meeting(gap, normal, minus(meet.arm, along), minus(meet.face_arm, along), True)


@inlined
def relative_velocity(bodies: Rows, line: Row, supports: Supports, meet: Meeting) -> Vector:
    """Velocity of the point of a line over the face [m/s]."""
    body = bodies[line.body]
    velocity = plus(read(body.velocity), spun(read(body.spin), meet.arm))
    if line.face >= 0:
        face = bodies[line.face]
        of_face = plus(read(face.velocity), spun(read(face.spin), meet.face_arm))
        velocity = minus(velocity, of_face)
    elif line.support >= 0:
        velocity = minus(velocity, vector(supports.moving, line.support, velocity))
    return velocity


@inlined
def where_friction_rubs(meet: Meeting) -> Meeting:
    """The same meeting with arms to halfway into the overlap. The force along the normal turns the bodies alike there,
    and the gap has the same rate."""
    halfway = scaled(-0.5 * min(meet.gap, 0.0), meet.normal)
    return Meeting(meet.gap, meet.normal, plus(meet.arm, halfway), plus(meet.face_arm, halfway), meet.past)


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
def press_lines(system: System, books: Books, h: float, kick: float, lead: float) -> tuple[int, int]:
    """Add the forces of all lines but rigid friction, and list the lines that stick rigidly, and those that touched.

    Args:
        system, books: the bodies and their lines, and the accounts.
        h: length of the step that led to the pose [s], zero at the start.
        kick: time for which the forces act on the velocities [s].
        lead: by how many steps dashpots look ahead, see `foreseen`.

    Returns:
        How many lines stick rigidly, and how many met or left their face in the last step.
    """
    bodies, lines, supports, active, touched = system.bodies, system.lines, system.supports, 0, 0
    rubbed, put_in = 0.0, 0.0
    for p in range(len(lines)):
        line = lines[p]
        if line.k == 0 and line.margin == math.inf:
            continue  # a law of its joint holds it, or it is handed over, see `contact_search`
        meet = meeting(system, line)
        if 0 <= meet.gap < TURNED_OVER:
            line.widest = max(line.widest, 0.0 if meet.past else meet.gap)
            if was_open(line):
                put(line.grip, no_spin(meet.normal))
                continue
        meet = where_friction_rubs(meet)
        velocity = relative_velocity(bodies, line, supports, meet)
        rate, slip = dot(meet.normal, velocity), along_face(meet.normal, velocity)
        sprung, push = normal_force(line, meet.gap, 0.0), normal_force(line, meet.gap, rate)
        if lead > 0 and push > 0 and line.push > 0:
            push = normal_force(line, meet.gap, foreseen(line, rate, push, lead))
        if (push > 0) != (line.push > 0) or (meet.gap < 0) != (line.depth > 0):
            sprung, push = touched_forces(line, meet.gap, rate, h)
            if line.due != 0:
                books.touched[touched] = p
                touched += 1
        books.dashpots[line.group] -= 0.5 * h * (line.pressed + push - sprung) * rate
        if meet.past or line.past == 1:
            books.totals[0].joint_ends += lost_past_face_edge(line, meet, h * rate)
        last, drag = read(line.dragged), no_spin(meet.normal)
        if push <= 0:
            if push < 0 and line.push > 0:
                drag = scaled(push / line.push, turned_along(meet.normal, last_friction(bodies, line, last)))
            put(line.grip, no_spin(meet.normal))
        elif line.k_s < math.inf:
            drag = sprung_friction(bodies, line, meet.normal, slip, push, time_closed(line, meet.gap, rate, h))
        elif line.friction > 0:
            books.active[active] = p
            list_rigid(
                system, line, (len(meet.normal) - 1) * active, meet.normal, (meet.arm, meet.face_arm), velocity, kick
            )
            begin(system, line, (len(meet.normal) - 1) * active, shear_limit(line, push), kick, meet.normal)
            active += 1
        mean = scaled(0.5 * h, plus(last, drag))
        rubbed -= dot(mean, slip)
        if line.support >= 0:
            work = plus(scaled(0.5 * h * (line.push + push), meet.normal), as_vector(meet.normal, mean))
            put_in += carried(line, supports, work)
        line.push, line.rate = push, rate
        line.pressed = push - sprung if meet.gap < 0 or push < 0 else 0.0
        line.depth, line.past = max(-meet.gap, 0.0), meet.past
        put(line.dragged, drag)
        if meet.gap == TURNED_OVER:
            line.k = line.c = line.friction = 0.0
        force = plus(scaled(push, meet.normal), as_vector(meet.normal, drag))
        press_apart(books.apart, bodies, line, (meet.arm, meet.face_arm), force)
    books.totals[0].friction += rubbed
    books.totals[0].ground += put_in
    return active, touched


@inlined
def settle_touches(system: System, books: Books, count: int, kick: float) -> tuple[float, float]:
    """Let the springs of lines that closed or opened in the step do the remaining work of their touch, see `touches`.

    Returns the energy that the halves of these impulses before the pose have taken, which a sample counts as held by
    the springs, and the work of the supports through them [J].
    """
    stored_energy, put_in = 0.0, 0.0
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
            put_in += carried(line, system.supports, scaled(impulse, meeting(system, line).normal))
        line.push, line.due = line.push + books.impulse[i] / kick, 0.0
        stored_energy -= 0.5 * books.impulse[i] * line.rate
    books.totals[0].ground += put_in
    return stored_energy, put_in
