"""Friction along a face: one tangential direction in the plane, two in space.

A line with a shear stiffness has a spring in series with a slider, as in distinct-element codes: its force is at most
the friction that the face can carry. The line stores the elongation of the spring, in the plane a number along the face
and in space a vector in the axes of the face.

A line that sticks rigidly gets an impulse along its face that stops the slip, within the limit of Coulomb's law. The
impulses of all lines are found by projected Gauss-Seidel, from those of the last step on: one line after the other gets
the impulse that stops its slip, until the impulses no longer change. In space a line whose impulse would exceed the
limit gets the friction of the limit against its slip.
"""

from __future__ import annotations

import math

from ...compiled import inlined
from ...geometry.vectors import (
    Vector,
    dot,
    increase,
    minus,
    moment,
    plus,
    put,
    read,
    scaled,
    spin_components,
    spun,
    tangent,
    tangents,
    times,
    vector,
)
from ...problem.masonry.laws.joint_law import shear_limit, stored_along
from ...quantities import Array, Integers
from ...rows import Row, Rows
from ..rotation import add_momentum, apply_impulse, in_body, in_world, spin_from_many
from ..supports import Supports
from ..system import Books, System
from .faces import Meeting

SWEEPS = 50
"""Most sweeps over the lines in a step."""
SETTLED = 1e-3
"""Change of an impulse in a sweep, over the friction that the most loaded line can carry, below which the sweeps end
[-]."""
STRIDE = 3
"""Distance, in numbers of lines, from one line of a sweep to the next."""
ROUNDED_ALONG = 1e-16
"""Square of the part of a vector along a normal, over that of the vector, below which it is rounding [-]."""
COMPLIANCE_OF_GUIDED = 1e-9
"""Least compliance of a guided body, over that of its mass [-]."""


@inlined
def along_face(normal: Vector, a: Vector) -> Vector:
    """The part of a vector along a face: in the plane a number along the tangent, in space a vector. A number stays."""
    if len(a) == 1:
        return a
    if len(a) == 2:
        return (dot(tangent(normal), a),)
    return minus(a, scaled(dot(normal, a), normal))


@inlined
def as_vector(normal: Vector, a: Vector) -> Vector:
    """A vector of the world from its part along a face."""
    if len(a) == 1:
        return scaled(a[0], tangent(normal))
    return a


@inlined
def turned_along(normal: Vector, a: Vector) -> Vector:
    """A tangential vector of a face after the face has turned: in the plane a number, which stays, in space its part
    along the face, scaled to its length before."""
    if len(a) == 1:
        return a
    off = dot(normal, a)
    along, square = minus(a, scaled(off, normal)), dot(a, a)
    if off * off <= ROUNDED_ALONG * square or off * off >= square:
        return along
    return scaled(math.sqrt(square / (square - off * off)), along)


@inlined
def shortened(a: Vector, limit: float) -> Vector:
    """A vector, shortened to a limit if it is longer."""
    if len(a) == 1:
        return (min(max(a[0], -limit), limit),)
    square = dot(a, a)
    return a if square <= limit * limit else scaled(limit / math.sqrt(square), a)


@inlined
def carried(row: Row, supports: Supports, direction: Vector) -> float:
    """Velocity along a direction of the support that carries a line, zero for a line without a support [m/s]."""
    if row.support < 0:
        return 0.0
    return dot(direction, vector(supports.moving, row.support, direction))


@inlined
def stretched(bodies: Rows, face: int, shear_state: Array, normal: Vector, displacement: Vector) -> Vector:
    """Elongation of a shear spring in the axes of the world, after a displacement along the face [m]."""
    kept = spin_components(shear_state, normal)
    if face >= 0:
        kept = in_world(bodies[face], kept)
    return plus(turned_along(normal, kept), displacement)


@inlined
def sprung_friction(bodies: Rows, line: Row, normal: Vector, slip: Vector, push: float, time: float) -> Vector:
    """Force along the face of the shear spring with its slider and dashpot [N].

    The slip of the last step stretches the spring for the time in which the line was closed [s]. The friction that the
    face can carry limits first the force of the spring, then the sum of spring and dashpot. Where the dashpot alone
    exceeds the limit, the spring stays as it is, since a longer spring would add energy.
    """
    limit = shear_limit(line, push)
    stretch = shortened(stretched(bodies, line.face, line.shear_state, normal, scaled(time, slip)), limit / line.k_s)
    friction = shortened(minus(scaled(-line.k_s, stretch), scaled(line.c_s, slip)), limit)
    if line.face >= 0:
        stretch = in_body(bodies[line.face], stretch)
    put(line.shear_state, stretch)
    return friction


@inlined
def sheared(line: Row) -> float:
    """Energy in the shear spring of a line, or of a law of its joint [J], zero for rigid friction."""
    if line.k_s == math.inf:
        return 0.0
    stretch = read(line.shear_state)
    energy: float = stored_along(line, dot(stretch, stretch))
    return energy


@inlined
def last_friction(bodies: Rows, line: Row, shear_force: Vector) -> Vector:
    """Friction of a line in the last step [N], of which `shear_force` is that of its shear spring."""
    if line.k_s < math.inf:
        return shear_force
    friction = read(line.shear_state) if len(shear_force) == 3 else (line.shear_state[0],)
    return in_world(bodies[line.face], friction) if line.face >= 0 else friction


@inlined
def inverse_mass_along(body: Row, direction: Vector) -> float:
    """Velocity of the centroid of a body along a unit vector by a unit impulse along it [1/kg].

    For a guided body it is a small number instead of zero, so that it can be divided by.
    """
    inverse_mass: float = dot(direction, times(read(body.inverse_mass), direction))
    return inverse_mass if inverse_mass * body.mass > COMPLIANCE_OF_GUIDED else COMPLIANCE_OF_GUIDED / body.mass


@inlined
def list_direction(system: System, line: Row, number: int, direction: Vector, meet: Meeting, velocity: Vector) -> None:
    """Prepare one tangential direction of a line that sticks rigidly, see `list_rigid`."""
    row, body, on_face = system.tangents[number], system.bodies[line.body], line.face >= 0
    row.body, row.face, row.support, row.slip = line.body, line.face, line.support, dot(direction, velocity)
    lever = moment(meet.arm, direction)
    spin = spin_from_many(body, lever)
    put(row.direction, direction)
    put(row.lever, lever)
    put(row.spin, spin)
    compliance = inverse_mass_along(body, direction) + dot(lever, spin)
    if on_face:
        face, lever = system.bodies[line.face], moment(meet.face_arm, direction)
        spin = spin_from_many(face, lever)
        put(row.lever_on_face, lever)
        put(row.spin_of_face, spin)
        compliance += inverse_mass_along(face, direction) + dot(lever, spin)
    row.compliance = compliance


@inlined
def swept(system: System, line: Row, arm: Vector, face_arm: Vector) -> Vector:
    """Centripetal acceleration of the point of a line relative to its face [m/s2], of both bodies."""
    spin = spin_components(system.bodies[line.body].spin, arm)
    towards = spun(spin, spun(spin, arm))
    if line.face >= 0:
        spin = spin_components(system.bodies[line.face].spin, arm)
        towards = minus(towards, spun(spin, spun(spin, face_arm)))
    return towards


@inlined
def list_rigid(system: System, line: Row, first: int, meet: Meeting, velocity: Vector, h: float) -> None:
    """Prepare the tangential directions of a line that sticks rigidly.

    Args:
        system: the bodies, and the room for the directions.
        line: the line.
        first: number of its first direction.
        meet: its normal, and the arms to where friction acts.
        velocity: of the point there against its face, before the forces act [m/s].
        h: length of a step [s].
    """
    a, normal = system.tangents[first], meet.normal
    drift = scaled(0.5 * h, swept(system, line, meet.arm, meet.face_arm))
    if len(velocity) == 2:
        list_direction(system, line, first, tangent(normal), meet, velocity)
        a.stiffness, a.drift = 1 / a.compliance, dot(tangent(normal), drift)
        return
    b, (first_tangent, second_tangent) = system.tangents[first + 1], tangents(normal)
    list_direction(system, line, first, first_tangent, meet, velocity)
    list_direction(system, line, first + 1, second_tangent, meet, velocity)
    a.drift, b.drift = dot(first_tangent, drift), dot(second_tangent, drift)
    a.coupling = dot(read(a.lever), read(b.spin))
    if line.face >= 0:
        a.coupling += dot(read(a.lever_on_face), read(b.spin_of_face))
    area = 1 / (a.compliance * b.compliance - a.coupling * a.coupling)
    a.stiffness, a.shared, b.stiffness = area * b.compliance, area * a.coupling, area * a.compliance


@inlined
def slip_along(system: System, row: Row) -> float:
    """Slip along a tangential direction of a line that sticks rigidly [m/s]."""
    body, direction = system.bodies[row.body], read(row.direction)
    slip = dot(direction, read(body.velocity))
    slip += dot(read(row.lever), read(body.spin))
    if row.face >= 0:
        face = system.bodies[row.face]
        slip -= dot(direction, read(face.velocity))
        slip -= dot(read(row.lever_on_face), read(face.spin))
    return slip - carried(row, system.supports, direction)


@inlined
def combined(impulses: Vector, first: Vector, second: Vector) -> Vector:
    """Effect of impulses along the tangential directions of a line, from that of a unit impulse along each. The plane
    has one direction."""
    if len(impulses) == 1:
        return scaled(impulses[0], first)
    return plus(scaled(impulses[0], first), scaled(impulses[1], second))


@inlined
def strike(system: System, first: int, impulses: Vector) -> None:
    """Apply impulses along the tangential directions of a line to its body and to that of its face [N s]."""
    a, b = system.tangents[first], system.tangents[first + len(impulses) - 1]
    body, impulse = system.bodies[a.body], combined(impulses, read(a.direction), read(b.direction))
    apply_impulse(body, impulse)
    increase(body.spin, combined(impulses, read(a.spin), read(b.spin)))
    if a.face >= 0:
        face = system.bodies[a.face]
        apply_impulse(face, scaled(-1.0, impulse))
        spin = combined(impulses, read(a.spin_of_face), read(b.spin_of_face))
        increase(face.spin, scaled(-1.0, spin))


@inlined
def impulses_of(system: System, first: int, like: Vector) -> Vector:
    """The impulses along the tangential directions of a line [N s]."""
    if len(like) == 2:
        return (system.tangents[first].impulse,)
    return system.tangents[first].impulse, system.tangents[first + 1].impulse


@inlined
def begin(system: System, line: Row, first: int, friction: float, force_time: float, like: Vector) -> None:
    """Start the impulses of a line from the friction of the last step, within what the face can carry now [N]."""
    limit: float = force_time * friction
    impulse = scaled(force_time, read(line.shear_state))
    if line.face >= 0:
        impulse = in_world(system.bodies[line.face], impulse)
    if len(like) == 2:
        impulses = shortened(impulse, limit)
    else:
        a, b = system.tangents[first], system.tangents[first + 1]
        impulses = shortened((dot(read(a.direction), impulse), dot(read(b.direction), impulse)), limit)
    for i in range(len(like) - 1):
        row = system.tangents[first + i]
        row.impulse, row.limit = impulses[i], limit


@inlined
def stopping(system: System, first: int, like: Vector) -> Vector:
    """The impulses that stop the slip of a line in the middle of the step, within its friction [N s].

    The slip after the forces have acted is then the negative of that before, so that a line that sticks dissipates no
    energy and stays where it is.
    """
    a = system.tangents[first]
    slip, limit = slip_along(system, a) + a.drift, a.limit
    if len(like) == 2:
        return shortened((a.impulse - slip * a.stiffness,), limit)
    b = system.tangents[first + 1]
    other_slip = slip_along(system, b) + b.drift
    impulse = a.impulse - (a.stiffness * slip - a.shared * other_slip)
    other_impulse = b.impulse - (b.stiffness * other_slip - a.shared * slip)
    if impulse * impulse + other_impulse * other_impulse > limit * limit:  # it slips, and friction is against the slip
        half = 0.5 * (a.compliance - b.compliance)
        loosest = 0.5 * (a.compliance + b.compliance) + math.sqrt(half * half + a.coupling * a.coupling)
        impulse, other_impulse = a.impulse - slip / loosest, b.impulse - other_slip / loosest
        shorter = min(1.0, limit / math.sqrt(impulse * impulse + other_impulse * other_impulse))
        impulse, other_impulse = shorter * impulse, shorter * other_impulse
    return impulse, other_impulse


@inlined
def stop(system: System, first: int, like: Vector) -> float:
    """Stop the slip of one line within its friction. Returns the largest change of its impulses [N s]."""
    impulses = stopping(system, first, like)
    change = minus(impulses, impulses_of(system, first, like))
    strike(system, first, change)
    system.tangents[first].impulse = impulses[0]
    if len(like) == 2:
        return abs(change[0])
    system.tangents[first + 1].impulse = impulses[1]
    return max(abs(change[0]), abs(change[1]))


@inlined
def stick(system: System, active: Integers, count: int, force_time: float) -> None:
    """Stop the slip of the lines that stick rigidly. Their impulses are in the rows of their directions [N s].

    Neighbouring lines share their bodies, so that the processor would wait for each before the next: a sweep takes
    every third line, then those after them, and then the rest.
    """
    like = read(system.bodies[0].place)
    directions, largest = len(like) - 1, 0.0
    for i in range(count):
        largest = max(largest, system.tangents[directions * i].limit)
        strike(system, directions * i, impulses_of(system, directions * i, like))
    for sweep in range(SWEEPS):
        changed = 0.0
        for start in range(STRIDE):
            for turn in range(start, count, STRIDE):
                i = turn if sweep % 2 else count - 1 - turn
                changed = max(changed, stop(system, directions * i, like))
        if changed <= SETTLED * largest:
            break
    for i in range(count):
        keep_rigid(system, system.lines[active[i]], directions * i, force_time, like)


@inlined
def keep_rigid(system: System, line: Row, first: int, force_time: float, like: Vector) -> None:
    """Keep the friction of a line that sticks rigidly for the next step [N], and its moments on the bodies."""
    impulses = impulses_of(system, first, like)
    if len(like) == 2:
        line.shear_state[0] = impulses[0] / force_time
        return
    a, b = system.tangents[first], system.tangents[first + 1]
    lever = combined(impulses, read(a.lever), read(b.lever))
    add_momentum(system.bodies[a.body], lever)
    friction = scaled(1 / force_time, combined(impulses, read(a.direction), read(b.direction)))
    if a.face >= 0:
        lever = combined(impulses, read(a.lever_on_face), read(b.lever_on_face))
        add_momentum(system.bodies[a.face], scaled(-1.0, lever))
        friction = in_body(system.bodies[a.face], friction)
    put(line.shear_state, friction)


@inlined
def book_rubbing(system: System, books: Books, count: int) -> tuple[float, float]:
    """Book the energy that rigid friction dissipates in a step, its impulses times the mean of the slips before and
    after, and the work of the supports through it. Returns the halves of both before the pose [J].
    """
    totals, rubbed, put_in = books.totals[0], 0.0, 0.0
    for i in range((len(read(system.bodies[0].place)) - 1) * count):
        row = system.tangents[i]
        totals.friction -= 0.5 * row.impulse * (row.slip + slip_along(system, row))
        work = row.impulse * carried(row, system.supports, read(row.direction))
        totals.ground += work
        rubbed -= 0.5 * row.impulse * row.slip
        put_in += 0.5 * work
    return rubbed, put_in
