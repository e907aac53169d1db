"""A contact point at a pose: where it presses, how fast, and with what force.

The law is that of the plane: along the normal max(0, -(k g + c g')) while the gap g is negative. Along the face a
spring vector of stiffness k_s, kept in the axes of the face, slips where its force would pass the friction, or the
point sticks rigidly, see `friction`.

A point beyond the outline of its face has moved past an edge of it. The nearest place of the outline then presses on
the face of the block that carries the point, and past the outline of that face too nothing is left of the contact. Nor
is anything left of it once the two faces are turned away from each other. A corner that meets a face beyond the joints
presses where it has come through the face, until it leaves the outline.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...compiled import inlined, jitable
from ...geometry.vectors import Vector, dot, minus, plus, scaled, spun
from ..contact import OPEN, closed_share, lost_at_the_end
from ..system import THROUGH, Books, Row, Rows, Supports
from .friction import list_rigid
from .system import (
    System,
    add_force,
    add_moment,
    at_of,
    between_of,
    displaced_support,
    grip_of,
    keep_grip,
    moving_support,
    normal_of,
    origin_of,
    place_of,
    spin_of,
    velocity_of,
    way_of,
)
from .turning import in_body, in_world, swung

NEAR, BESIDE = 1, 3
"""A corner outside a face, and one that is behind it and passed beside its outline. Between them it is THROUGH."""
TURNED_OVER = 2 * OPEN
"""Gap of a point whose block has turned over [m]. The contact is gone for good."""
ROUNDS = 3
"""Rounds over the edges of a face in the search for the nearest place of its outline. One is enough for a rectangle."""


class Meeting(NamedTuple):
    """A point at a pose.

    Args:
        gap: [m].
        normal: out of the face.
        arm: from the centroid of the body to the point [m].
        face_arm: from the centroid of the body of the face to the point [m]; of a fixed block no arm is taken.
        past: whether the point is past the outline of the face.
    """

    gap: float
    normal: Vector
    arm: Vector
    face_arm: Vector
    past: bool


@inlined
def meeting(system: System, point: Row) -> Meeting:
    """Where a point is."""
    body, at, normal = system.bodies[point.body], at_of(point), normal_of(point)
    swing = swung(body, at)
    arm, across = plus(at, swing), plus(between_of(point), plus(place_of(body), swing))
    face_arm = arm
    if point.face >= 0:
        face, origin = system.bodies[point.face], origin_of(point)
        swing = swung(face, origin)
        across = minus(across, plus(place_of(face), swing))
        face_arm = plus(plus(origin, swing), across)
        normal = plus(normal, swung(face, normal))
    elif point.support >= 0:
        across = minus(across, displaced_support(system.supports, point.support))
    gap = dot(normal, across)
    if point.corner > 0:
        return cornered(system, point, across, Meeting(gap, normal, arm, face_arm, False))
    if gap < 0:
        if dot(normal, in_world(body, normal_of(point))) < 0:
            return Meeting(TURNED_OVER, normal, arm, face_arm, True)
        if dot(across, across) - gap * gap > point.margin:
            return at_the_end(system, point, across, Meeting(gap, normal, arm, face_arm, False))
    return Meeting(gap, normal, arm, face_arm, False)


@jitable
def at_the_end(system: System, point: Row, across: Vector, meet: Meeting) -> Meeting:
    """Where a point is that may have moved past the outline of its face, `across` from its place there at rest [m]."""
    fixed = point.face < 0
    face, body = system.bodies[max(point.face, 0)], system.bodies[point.body]
    reached = plus(origin_of(point), across if fixed else in_body(face, across))
    inside, share = reached, 0.0
    for sweep in range(ROUNDS):
        for i in range(point.first, point.last):
            edge = system.edges[i]
            excess = dot(way_of(edge), inside) - edge.reach
            if excess > 0:
                inside = minus(inside, scaled(excess, way_of(edge)))
                if sweep == 0:
                    share = max(share, excess / edge.band)
    if share == 0:
        return meet
    over = minus(reached, inside)
    apart = plus(scaled(meet.gap, meet.normal), over if fixed else in_world(face, over))  # from the outline
    own = in_world(body, normal_of(point))
    gap = dot(own, apart)
    along = minus(apart, scaled(gap, own))
    place = minus(at_of(point), in_body(body, along))
    for i in range(point.own_first, point.own_last):
        edge = system.edges[i]
        if dot(way_of(edge), place) > edge.reach:
            gap = OPEN
    normal = plus(meet.normal, scaled(min(share, 1.0), minus(own, meet.normal)))
    normal = scaled(1 / math.sqrt(dot(normal, normal)), normal)
    return Meeting(gap, normal, minus(meet.arm, along), minus(meet.face_arm, along), True)


@jitable
def cornered(system: System, point: Row, across: Vector, meet: Meeting) -> Meeting:
    """Where a corner is that may meet a face, `across` from the origin of the face [m]. Beside the face it is open."""
    if meet.gap >= 0:
        point.corner = NEAR
        return meet
    if point.corner != BESIDE:
        within = across if point.face < 0 else in_body(system.bodies[point.face], across)
        reached, point.corner = plus(origin_of(point), within), THROUGH
        for i in range(point.first, point.last):
            edge = system.edges[i]
            if dot(way_of(edge), reached) > edge.reach:
                point.corner = BESIDE
    if point.corner == BESIDE:
        return Meeting(OPEN, meet.normal, meet.arm, meet.face_arm, True)
    return meet


@inlined
def relative(bodies: Rows, point: Row, supports: Supports, meet: Meeting) -> Vector:
    """Velocity of a point over its face [m/s]."""
    body = bodies[point.body]
    velocity = plus(velocity_of(body), spun(spin_of(body), meet.arm))
    if point.face >= 0:
        face = bodies[point.face]
        velocity = minus(velocity, plus(velocity_of(face), spun(spin_of(face), meet.face_arm)))
    elif point.support >= 0:
        velocity = minus(velocity, moving_support(supports, point.support))
    return velocity


@inlined
def slip_halfway(bodies: Rows, point: Row, meet: Meeting, velocity: Vector, rate: float) -> Vector:
    """Velocity along its face halfway into the overlap, where friction rubs, from that at the point [m/s]."""
    spin = spin_of(bodies[point.body])
    if point.face >= 0:
        spin = minus(spin, spin_of(bodies[point.face]))
    slip = minus(velocity, scaled(rate, meet.normal))
    return plus(slip, spun(spin, scaled(-0.5 * min(meet.gap, 0.0), meet.normal)))


@inlined
def carried(point: Row, supports: Supports, way: Vector) -> float:
    """Velocity of the support of a point along a vector, zero where none moves it."""
    if point.support < 0:
        return 0.0
    return dot(way, moving_support(supports, point.support))


@inlined
def shortened(vector: Vector, most: float) -> Vector:
    """A vector that is no longer than a length."""
    square = dot(vector, vector)
    return vector if square <= most * most else scaled(most / math.sqrt(square), vector)


@inlined
def sprung_friction(bodies: Rows, point: Row, normal: Vector, slip: Vector, limits: tuple[float, float]) -> Vector:
    """Force of the shear spring with its slider and dashpot [N], as in the plane. The last velocity has stretched the
    spring.

    Limits are the force that presses, and the length of the last step.
    """
    push, h = limits
    grip, most = grip_of(point), point.friction * push
    if point.face >= 0:
        grip = in_world(bodies[point.face], grip)
    grip = plus(grip, scaled(h, slip))
    grip = minus(grip, scaled(dot(grip, normal), normal))
    grip = shortened(grip, most / point.k_s)
    drag = shortened(minus(scaled(-point.k_s, grip), scaled(point.c_s, slip)), most)
    if point.face >= 0:
        grip = in_body(bodies[point.face], grip)
    keep_grip(point, grip)
    return drag


@jitable
def press_points(system: System, books: Books, h: float, kick: float) -> int:
    """Add the forces of all points but rigid friction, and list the points that stick rigidly.

    Args:
        system, books: the bodies and their points, and the accounts.
        h: length of the step that led to the pose [s], zero at the start.
        kick: time for which the forces act on the velocities [s].

    Returns:
        How many points stick rigidly.
    """
    bodies, lines, supports, active = system.bodies, system.lines, system.supports, 0
    rubbed, put_in = 0.0, 0.0
    for p in range(len(lines)):
        point = lines[p]
        meet = meeting(system, point)
        if 0 <= meet.gap < TURNED_OVER:
            point.widest = max(point.widest, meet.gap)
            if point.push == 0 and point.pressed == 0:  # nor was there friction
                keep_grip(point, (0.0, 0.0, 0.0))
                continue
        velocity = relative(bodies, point, supports, meet)
        rate = dot(meet.normal, velocity)
        slip = slip_halfway(bodies, point, meet, velocity, rate)
        sprung = -point.k * min(meet.gap, 0.0)
        push = max(0.0, sprung - point.c * rate) if meet.gap < 0 else 0.0
        books.dashpots[point.group] -= 0.5 * h * (point.pressed + push - sprung) * rate
        books.ends[min(point.corner, 1)] += lost_at_the_end(point, meet.gap, meet.past, h * rate)
        closed, pushed = closed_share(point, meet.gap, h * rate), point.push + push
        last: Vector = (point.dragged_x, point.dragged_y, point.dragged_z)
        drag: Vector = (0.0, 0.0, 0.0)
        point.push, point.pressed, point.past = push, push - sprung, meet.past
        if meet.gap == TURNED_OVER:
            point.k = point.c = point.friction = 0.0
        if push == 0:
            keep_grip(point, (0.0, 0.0, 0.0))
        elif point.k_s < math.inf:
            drag = sprung_friction(bodies, point, meet.normal, slip, (push, h))
        elif point.friction > 0:
            books.active[active] = p
            list_rigid(system, point, active, (meet.normal, meet.arm, meet.face_arm), meet.gap)
            active += 1
        mean = scaled(0.5 * h, plus(last, drag))
        rubbed -= dot(mean, slip)
        put_in += closed * carried(point, supports, plus(mean, scaled(0.5 * h * pushed, meet.normal)))
        point.dragged_x, point.dragged_y, point.dragged_z = drag
        force = plus(scaled(push, meet.normal), drag)
        # friction rubs halfway into the overlap
        turning = spun(scaled(-0.5 * min(meet.gap, 0.0), meet.normal), drag)
        push_apart(bodies, point, meet, force, turning)
    books.friction[0] += rubbed
    books.friction[1] += put_in
    return active


@inlined
def push_apart(bodies: Rows, point: Row, meet: Meeting, force: Vector, turning: Vector) -> None:
    """Add a force and a moment on the body of a point, and their reaction on the body of the face."""
    body = bodies[point.body]
    add_force(body, meet.arm, force)
    add_moment(body, turning)
    if point.face >= 0:
        face = bodies[point.face]
        add_force(face, meet.face_arm, scaled(-1.0, force))
        add_moment(face, scaled(-1.0, turning))
