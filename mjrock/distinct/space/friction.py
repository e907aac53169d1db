"""Rigid friction in space: impulses along the faces that stop the slip, as far as Coulomb's circular cone lets them.

They are found by projected Gauss-Seidel, as in the plane: one point after the other gets the impulse along its two ways
that stops its slip, until the impulses no longer change. They start from those of the last step. Where this impulse is
more than mu times the pressure, the point gets one against its slip instead, shortened to what friction can do. In the
end the friction of a point that slips is against its slip.
"""

from __future__ import annotations

import math

from ...compiled import inlined, jitable
from ...geometry.vectors import Vector, dot, plus, scaled, spun
from ..friction import SETTLED, SWEEPS
from ..system import Books, Row
from .system import System, grip_of, keep_grip, moving_support, spin_of, velocity_of, way_of
from .turning import eased_in_world, in_body, in_world


@inlined
def across(normal: Vector) -> Vector:
    """A unit vector along a face."""
    x, y, z = normal
    if abs(z) > 0.5:
        size = 1 / math.sqrt(x * x + z * z)
        return z * size, 0.0, -x * size
    size = 1 / math.sqrt(x * x + y * y)
    return -y * size, x * size, 0.0


@jitable
def list_rigid(system: System, point: Row, number: int, place: tuple[Vector, Vector, Vector], gap: float) -> None:
    """Prepare the two ways of a point that sticks rigidly.

    Args:
        system: the bodies, and the room for the ways.
        point: the point.
        number: how many points stick before it.
        place: the normal of its face, and the arms from the two centroids [m].
        gap: of the point [m]; friction rubs halfway into the overlap.
    """
    normal, arm, face_arm = place
    halfway = scaled(-0.5 * gap, normal)
    first = across(normal)
    for i in range(2):
        row = system.ways[2 * number + i]
        way = first if i == 0 else spun(normal, first)
        body = system.bodies[point.body]
        lever = spun(plus(arm, halfway), way)
        turn = eased_in_world(body, lever)
        row.light = 1 / body.mass + dot(lever, turn)
        row.way_x, row.way_y, row.way_z = way
        row.lever_x, row.lever_y, row.lever_z = lever
        row.turn_x, row.turn_y, row.turn_z = turn
        if point.face >= 0:
            face = system.bodies[point.face]
            lever = spun(plus(face_arm, halfway), way)
            turn = eased_in_world(face, lever)
            row.light += 1 / face.mass + dot(lever, turn)
            row.other_x, row.other_y, row.other_z = lever
            row.counter_x, row.counter_y, row.counter_z = turn
    a, b = system.ways[2 * number], system.ways[2 * number + 1]
    a.cross = dot((a.lever_x, a.lever_y, a.lever_z), (b.turn_x, b.turn_y, b.turn_z))
    if point.face >= 0:
        a.cross += dot((a.other_x, a.other_y, a.other_z), (b.counter_x, b.counter_y, b.counter_z))


@inlined
def slip_along(system: System, point: Row, row: Row) -> float:
    """Velocity along a way of a point that sticks rigidly [m/s]."""
    body, way = system.bodies[point.body], way_of(row)
    slip = dot(way, velocity_of(body)) + dot((row.lever_x, row.lever_y, row.lever_z), spin_of(body))
    if point.face >= 0:
        face = system.bodies[point.face]
        slip -= dot(way, velocity_of(face)) + dot((row.other_x, row.other_y, row.other_z), spin_of(face))
    elif point.support >= 0:
        slip -= dot(way, moving_support(system.supports, point.support))
    return slip


@inlined
def strike(body: Row, impulse: float, way: Vector, lever: Vector, turn: Vector) -> None:
    """Change velocity and angular momentum of a body by an impulse along a way [N s]."""
    share = impulse / body.mass
    body.vx += share * way[0]
    body.vy += share * way[1]
    body.vz += share * way[2]
    body.momentum_x += impulse * lever[0]
    body.momentum_y += impulse * lever[1]
    body.momentum_z += impulse * lever[2]
    body.wx += impulse * turn[0]
    body.wy += impulse * turn[1]
    body.wz += impulse * turn[2]


@inlined
def strike_both(system: System, point: Row, row: Row, impulse: float) -> None:
    """Let an impulse along a way act on the body of a point and on that of its face [N s]."""
    lever, turn = (row.lever_x, row.lever_y, row.lever_z), (row.turn_x, row.turn_y, row.turn_z)
    strike(system.bodies[point.body], impulse, way_of(row), lever, turn)
    if point.face >= 0:
        lever, turn = (row.other_x, row.other_y, row.other_z), (row.counter_x, row.counter_y, row.counter_z)
        strike(system.bodies[point.face], -impulse, way_of(row), lever, turn)


@jitable
def begin(system: System, point: Row, number: int, kick: float) -> float:
    """Start with the friction of the last step. Returns the most that friction can do [N s]."""
    a, b = system.ways[2 * number], system.ways[2 * number + 1]
    most: float = kick * point.friction * point.push
    grip = scaled(kick, grip_of(point))
    if point.face >= 0:
        grip = in_world(system.bodies[point.face], grip)
    a.impulse, b.impulse = dot(way_of(a), grip), dot(way_of(b), grip)
    size = math.sqrt(a.impulse**2 + b.impulse**2)
    if size > most:
        a.impulse, b.impulse = a.impulse * most / size, b.impulse * most / size
    strike_both(system, point, a, a.impulse)
    strike_both(system, point, b, b.impulse)
    return most


@jitable
def stop(system: System, point: Row, number: int, most: float) -> float:
    """Stop the slip of one point as far as its friction can. Returns by how much its impulses have changed [N s]."""
    a, b = system.ways[2 * number], system.ways[2 * number + 1]
    slip_a, slip_b = slip_along(system, point, a), slip_along(system, point, b)
    area = a.light * b.light - a.cross * a.cross
    impulse_a = a.impulse - (b.light * slip_a - a.cross * slip_b) / area
    impulse_b = b.impulse - (a.light * slip_b - a.cross * slip_a) / area
    if impulse_a * impulse_a + impulse_b * impulse_b > most * most:  # it slips, and friction is against the slip
        half = 0.5 * (a.light - b.light)
        loosest = 0.5 * (a.light + b.light) + math.sqrt(half * half + a.cross * a.cross)
        impulse_a, impulse_b = a.impulse - slip_a / loosest, b.impulse - slip_b / loosest
        shorter = min(1.0, most / math.sqrt(impulse_a * impulse_a + impulse_b * impulse_b))
        impulse_a, impulse_b = shorter * impulse_a, shorter * impulse_b
    change_a, change_b = impulse_a - a.impulse, impulse_b - b.impulse
    strike_both(system, point, a, change_a)
    strike_both(system, point, b, change_b)
    a.impulse, b.impulse = impulse_a, impulse_b
    changed: float = max(abs(change_a), abs(change_b))
    return changed


@jitable
def stick(system: System, books: Books, count: int, kick: float) -> None:
    """Stop the slip of the points that stick rigidly. Their impulses are left in the ways [N s]."""
    lines, active, largest = system.lines, books.active, 0.0
    for i in range(count):
        largest = max(largest, begin(system, lines[active[i]], i, kick))
    for sweep in range(SWEEPS):
        changed = 0.0
        for turn in range(count):
            i = turn if sweep % 2 else count - 1 - turn
            point = lines[active[i]]
            changed = max(changed, stop(system, point, i, kick * point.friction * point.push))
        if changed <= SETTLED * largest:
            break
    for i in range(count):
        point, a, b = lines[active[i]], system.ways[2 * i], system.ways[2 * i + 1]
        grip = plus(scaled(a.impulse / kick, way_of(a)), scaled(b.impulse / kick, way_of(b)))
        if point.face >= 0:
            grip = in_body(system.bodies[point.face], grip)
        keep_grip(point, grip)


@jitable
def note_slips(system: System, books: Books, count: int) -> None:
    """Keep the slip of the points that stick rigidly before the forces act."""
    for i in range(2 * count):
        row = system.ways[i]
        row.sliding = slip_along(system, system.lines[books.active[i // 2]], row)


@jitable
def book_rubbing(system: System, books: Books, count: int) -> None:
    """Book what rigid friction takes in a step, its impulses along the mean of the slips before and after, and what
    the supports put in through it."""
    for i in range(2 * count):
        row, point = system.ways[i], system.lines[books.active[i // 2]]
        slip = 0.5 * (row.sliding + slip_along(system, point, row))
        books.friction[0] -= row.impulse * slip
        if point.support >= 0:
            books.friction[1] += row.impulse * dot(way_of(row), moving_support(system.supports, point.support))
