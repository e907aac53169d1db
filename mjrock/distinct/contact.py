"""A contact line at a pose: where it presses, how fast, and with what force.

The force along the normal is max(0, -(k g + c g')) while the gap g is negative, so never a tension. The dashpot takes
the velocity half a step before the pose. Along the face a spring of stiffness k_s slips where its force would pass the
friction, as in distinct-element codes, or the line sticks rigidly, see `friction`.

A line has moved past the end of its face where the block above overhangs. There the corner of the face presses on the
edge of the block above, and past the end of that edge too nothing is left of the contact.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..compiled import inlined, jitable
from .system import Books, Row, Rows, Supports, System

OPEN = 1.0
"""Gap of a line that has left its face [m]."""
OVERHANG = 0.02
"""Length by which a face is taken to be longer at either end, over its length [-]. The points of a block that stands
flush lie at the very end of the face, and move to and fro there. Over the same length beyond, the normal turns from
that of the face to that of the edge of the block above."""


ENTERED = 2.0
"""Depth of a corner in its first step behind an edge, over its way in the step [-]. A deeper one has come round the end
of the edge, and the edge does not push it."""


class Meeting(NamedTuple):
    """A line at a pose.

    Args:
        gap: [m].
        nx, nz: normal out of the face.
        rx, rz: from the centroid of the body to the line [m].
        sx, sz: from the centroid of the body of the face to the line [m]; of a fixed block no arm is taken.
        past: whether the point is past the end of the face.
    """

    gap: float
    nx: float
    nz: float
    rx: float
    rz: float
    sx: float
    sz: float
    past: bool


@inlined
def meeting(bodies: Rows, line: Row, supports: Supports) -> Meeting:
    """Where a line is."""
    body, nx, nz = bodies[line.body], line.normal_x, line.normal_z
    swung_x = line.at_z * body.sine - line.at_x * body.versine
    swung_z = -line.at_x * body.sine - line.at_z * body.versine
    rx, rz = line.at_x + swung_x, line.at_z + swung_z
    dx, dz = line.between_x + body.x + swung_x, line.between_z + body.z + swung_z
    sx, sz = rx, rz
    if line.face >= 0:
        face = bodies[line.face]
        dx -= face.x + line.origin_z * face.sine - line.origin_x * face.versine
        dz -= face.z - line.origin_x * face.sine - line.origin_z * face.versine
        nx, nz = (
            nx + line.normal_z * face.sine - line.normal_x * face.versine,
            nz - line.normal_x * face.sine - line.normal_z * face.versine,
        )
        sx, sz = (body.x0 - face.x0) + (body.x - face.x), (body.z0 - face.z0) + (body.z - face.z)
    elif line.support >= 0:
        dx, dz = dx - supports.moved[line.support, 0], dz - supports.moved[line.support, 1]
    gap, past = nx * dx + nz * dz, False
    if gap < 0:
        place = nz * dx - nx * dz
        past = place < line.low or place > line.high
        if past:
            end = line.low if place < line.low else line.high
            dx, dz = dx - end * nz, dz + end * nx
            mx = line.normal_x + line.normal_z * body.sine - line.normal_x * body.versine
            mz = line.normal_z - line.normal_x * body.sine - line.normal_z * body.versine
            back = mx * dz - mz * dx
            gap = OPEN if back < line.back or back > line.forth else mx * dx + mz * dz
            rx, rz = rx + back * mz, rz - back * mx
            share = min(abs(place - end) / (OVERHANG * (line.high - line.low)), 1.0)
            nx, nz = nx + share * (mx - nx), nz + share * (mz - nz)
            size = math.sqrt(nx * nx + nz * nz)
            nx, nz = nx / size, nz / size
    if line.face >= 0:
        sx, sz = sx + rx, sz + rz
    return Meeting(gap, nx, nz, rx, rz, sx, sz, past)


@inlined
def relative(bodies: Rows, line: Row, supports: Supports, meet: Meeting) -> tuple[float, float]:
    """Velocity of the point of a line over the face [m/s]."""
    body = bodies[line.body]
    ux, uz = body.vx + body.w * meet.rz, body.vz - body.w * meet.rx
    if line.face >= 0:
        face = bodies[line.face]
        ux, uz = ux - face.vx - face.w * meet.sz, uz - face.vz + face.w * meet.sx
    elif line.support >= 0:
        ux, uz = ux - supports.moving[line.support, 0], uz - supports.moving[line.support, 1]
    return ux, uz


@inlined
def slip_halfway(bodies: Rows, line: Row, meet: Meeting, ux: float, uz: float) -> float:
    """Velocity along its face halfway into the overlap, where friction rubs, from that at the point [m/s]."""
    spin = bodies[line.body].w
    if line.face >= 0:
        spin -= bodies[line.face].w
    slip: float = meet.nz * ux - meet.nx * uz - 0.5 * min(meet.gap, 0.0) * spin
    return slip


@inlined
def carried(line: Row, supports: Supports, x: float, z: float) -> float:
    """Velocity of the support of a line in a direction, zero where none moves it [m/s]."""
    if line.support < 0:
        return 0.0
    velocity: float = x * supports.moving[line.support, 0] + z * supports.moving[line.support, 1]
    return velocity


@inlined
def closed_share(line: Row, gap: float, opened: float) -> float:
    """Share of the last step in which a line was closed [-], whose gap has grown by some length in it [m]."""
    before, now = line.push > line.pressed, gap < 0
    if before and now:
        return 1.0
    depth = (line.push - line.pressed) / line.k if before else -min(gap, 0.0)
    share: float = depth / abs(opened) if depth < abs(opened) else 1.0
    return share


@inlined
def lost_at_the_end(line: Row, gap: float, past: bool, opened: float) -> float:
    """Energy that a line has lost in the last step since it was past the end of its face before or after it [J]: what
    its spring holds less, and has not done as work while the gap grew by some length [m].

    A line that opened or closed as far as it moved did so within the step, and has lost nothing at an end.
    """
    before, now = line.push - line.pressed, -line.k * min(gap, 0.0)
    if not (past or line.past == 1) or before + now == 0:
        return 0.0
    lost: float = 0.5 * (before + now) * ((before - now) / line.k - opened)
    if before == 0:
        return min(lost, 0.0)
    return lost if now > 0 else max(lost, 0.0)


@inlined
def add_force(body: Row, rx: float, rz: float, fx: float, fz: float) -> None:
    """Add a force at an arm from the centroid of a body [N]."""
    body.fx += fx
    body.fz += fz
    body.moment += rz * fx - rx * fz


@inlined
def sprung_friction(line: Row, push: float, slip: float, h: float) -> float:
    """Force of the shear spring with its slider and dashpot [N]. The last velocity has stretched the spring.

    The slider shortens the spring to what friction can hold, and then spring and dashpot together pull no more than
    that. A dashpot that alone exceeds it stretches no spring, which would put energy in.
    """
    most = line.friction * push
    longest = most / line.k_s
    line.grip = min(max(line.grip + h * slip, -longest), longest)
    drag: float = min(max(-line.k_s * line.grip - line.c_s * slip, -most), most)
    return drag


@jitable
def press_lines(system: System, books: Books, h: float, kick: float) -> int:
    """Add the forces of all lines but rigid friction, and list the lines that stick rigidly.

    Args:
        system, books: the bodies and their lines, and the accounts.
        h: length of the step that led to the pose [s], zero at the start.
        kick: time for which the forces act on the velocities [s].

    Returns:
        How many lines stick rigidly.
    """
    bodies, lines, supports, active = system.bodies, system.lines, system.supports, 0
    for p in range(len(lines)):
        line = lines[p]
        meet = meeting(bodies, line, supports)
        if meet.gap >= 0:
            line.widest = max(line.widest, meet.gap)
            if line.push == 0 and line.pressed == 0 and line.dragged == 0:
                line.grip, line.corner = 0.0, min(line.corner, 1)
                continue
        ux, uz = relative(bodies, line, supports, meet)
        rate, slip = meet.nx * ux + meet.nz * uz, slip_halfway(bodies, line, meet, ux, uz)
        if line.corner == 1:
            if meet.gap < -ENTERED * h * abs(rate):
                continue  # it did not come through this edge
            line.corner = 2 if meet.gap < 0 else 1
        sprung = -line.k * min(meet.gap, 0.0)
        push = max(0.0, sprung - line.c * rate) if meet.gap < 0 else 0.0
        books.dashpots[line.group] -= 0.5 * h * (line.pressed + push - sprung) * rate
        books.ends[min(line.corner, 1)] += lost_at_the_end(line, meet.gap, meet.past, h * rate)
        closed, pushed = closed_share(line, meet.gap, h * rate), line.push + push
        line.push, line.pressed, line.past = push, push - sprung, meet.past
        middle = -0.5 * min(meet.gap, 0.0)  # friction rubs halfway into the overlap
        last, drag = line.dragged if line.k_s < math.inf else 0.0, 0.0
        if push == 0:
            line.grip = 0.0
        elif line.k_s < math.inf:
            drag = sprung_friction(line, push, slip, h)
        elif line.friction > 0:
            books.active[active] = p
            active += 1
            list_rigid(bodies, line, meet, kick * line.friction * push)
        line.dragged = drag
        books.friction[0] -= 0.5 * h * (last + drag) * slip
        along, across = carried(line, supports, meet.nx, meet.nz), carried(line, supports, meet.nz, -meet.nx)
        books.friction[1] += 0.5 * h * closed * (pushed * along + (last + drag) * across)
        fx, fz, turning = push * meet.nx + drag * meet.nz, push * meet.nz - drag * meet.nx, middle * drag
        add_force(bodies[line.body], meet.rx, meet.rz, fx, fz)
        bodies[line.body].moment += turning
        if line.face >= 0:
            add_force(bodies[line.face], meet.sx, meet.sz, -fx, -fz)
            bodies[line.face].moment -= turning
    return active


@inlined
def list_rigid(bodies: Rows, line: Row, meet: Meeting, most: float) -> None:
    """Prepare the row of a line that sticks rigidly: way and levers of its friction, its most, and what it moves."""
    middle, body = -0.5 * meet.gap, bodies[line.body]
    line.way_x, line.way_z, line.most = meet.nz, -meet.nx, most
    line.lever = meet.rz * meet.nz + meet.rx * meet.nx + middle
    line.light = 1 / body.mass + body.ease * line.lever**2
    if line.face >= 0:
        face = bodies[line.face]
        line.other = meet.sz * meet.nz + meet.sx * meet.nx + middle
        line.light += 1 / face.mass + face.ease * line.other**2
