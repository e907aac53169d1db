"""Ties, dampers, actuators and constant forces on bodies, from the ground or from another body, and the supports that
move."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..compiled import inlined
from ..geometry.vectors import Vector, components, dot, increase, minus, plus, scaled, spin_components, spun, vector
from .contact import add_force
from .rows import Row, Rows
from .system import Books, Supports, System
from .turning import rotation_change


class Pull(NamedTuple):
    """A link at a pose: its length [m], its direction away from the anchor, and the arms to its two ends [m]."""

    length: float
    way: Vector
    arm: Vector
    anchor_arm: Vector


@inlined
def pull(link: Row, system: System, axes: tuple[int, ...]) -> Pull:
    """Where a tie or a damper is."""
    bodies = system.bodies
    body, at = bodies[link.body], components(link.at, axes)
    change = rotation_change(body, at)
    arm, across = plus(at, change), plus(components(link.between, axes), plus(components(body.place, axes), change))
    anchor_arm = components(link.origin, axes)
    if link.anchor >= 0:
        anchor = bodies[link.anchor]
        change = rotation_change(anchor, anchor_arm)
        across = minus(across, plus(components(anchor.place, axes), change))
        anchor_arm = plus(anchor_arm, change)
    elif link.support >= 0:
        across = minus(across, vector(system.supports.moved, link.support, axes))
    length = math.sqrt(dot(across, across))
    return Pull(length, scaled(1 / length, across), arm, anchor_arm)


@inlined
def act(link: Row, bodies: Rows, now: Pull, force: float) -> None:
    """Add a force along a link on the bodies at both ends [N], positive where it pushes them apart."""
    add_force(bodies[link.body], now.arm, scaled(force, now.way))
    if link.anchor >= 0:
        add_force(bodies[link.anchor], now.anchor_arm, scaled(-force, now.way))


@inlined
def lengthening(link: Row, system: System, now: Pull, axes: tuple[int, ...]) -> float:
    """Rate of the length of a link [m/s]."""
    bodies = system.bodies
    body = bodies[link.body]
    velocity = plus(components(body.velocity, axes), spun(spin_components(body.spin, axes), now.arm))
    if link.anchor >= 0:
        anchor = bodies[link.anchor]
        of_anchor = plus(components(anchor.velocity, axes), spun(spin_components(anchor.spin, axes), now.anchor_arm))
        velocity = minus(velocity, of_anchor)
    elif link.support >= 0:
        velocity = minus(velocity, vector(system.supports.moving, link.support, axes))
    return dot(now.way, velocity)


@inlined
def book_support(link: Row, system: System, books: Books, now: Pull, force: float, h: float) -> None:
    """Book the work that the support of a link does in a time h, from the force of the last step to this one [N]."""
    if link.support >= 0:
        carried = dot(now.way, vector(system.supports.moving, link.support, now.way))
        books.totals[0].ground += 0.5 * h * (link.pulled + force) * carried
    link.pulled = force


@inlined
def since_broken(over: float, rate: float, h: float) -> float:
    """How long before the pose a tie broke that is longer than it can be by `over` [s], within the step of length h."""
    return min(over / rate, h) if rate > 0 else 0.0


@inlined
def pulled_until_broken(tie: Row, since: float, h: float) -> float:
    """Force at the pose after a tie broke, in place of none [N].

    That of the pose before acts on the velocity up to the middle of the step. What the tie pulled after the middle and
    before it broke is still to act, and what it pulled in the middle after it had broken is to be taken back.
    """
    return tie.strength * (0.5 - since / h) if h > 0 else 0.0


@inlined
def elongation(tie: Row, length: float) -> float:
    """Elastic elongation of a link with a spring [m], zero where one that only pulls is slack."""
    elastic: float = length - tie.reach
    return elastic if tie.push > 0 else max(0.0, elastic)


@inlined
def pull_links(system: System, books: Books, t: float, h: float, axes: tuple[int, ...]) -> None:
    """Add the forces of ties, dampers and constant forces at time t, and book what the last step of length h took."""
    bodies = system.bodies
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if t >= tie.broken:
            tie.pulled = 0.0
            continue
        now = pull(tie, system, axes)
        beyond = now.length - tie.reach - tie.strength / tie.k
        shorter = tie.reach - now.length - tie.push / tie.k
        if beyond > 0:  # it yields, and breaks where it has been drawn out as far as it can be
            left = tie.ultimate - tie.drawn
            tie.drawn, tie.reach = tie.drawn + min(beyond, left), tie.reach + min(beyond, left)
            books.ties[i] += tie.strength * min(beyond, left)
            if beyond >= left:
                since = since_broken(beyond - left, lengthening(tie, system, now, axes), h)
                book_support(tie, system, books, now, -tie.strength, h - since)
                tie.broken, books.broken[i] = t - since, 0.5 * tie.strength**2 / tie.k
                tie.pulled = -pulled_until_broken(tie, since, h)
                act(tie, bodies, now, tie.pulled)
                continue
        elif tie.push > 0 and shorter > 0:  # it slips the other way
            tie.drawn, tie.reach = tie.drawn + shorter, tie.reach - shorter
            books.ties[i] += tie.push * shorter
        force = -tie.k * elongation(tie, now.length)
        book_support(tie, system, books, now, force, h)
        act(tie, bodies, now, force)
    for i in range(len(system.dampers)):
        damper = system.dampers[i]
        now = pull(damper, system, axes)
        rate = lengthening(damper, system, now, axes)
        force = -damper.c * rate
        books.dampers[i] -= 0.5 * h * (force + damper.pulled) * rate
        book_support(damper, system, books, now, force, h)
        act(damper, bodies, now, force)
    for i in range(len(system.actuators)):
        drive(system, books, i, h, axes)
    for i in range(len(system.forces)):
        row = system.forces[i]
        body, at = bodies[row.body], components(row.at, axes)
        add_force(body, plus(at, rotation_change(body, at)), components(row.between, axes))


@inlined
def drive(system: System, books: Books, i: int, h: float, axes: tuple[int, ...]) -> None:
    """Add the force of actuator i, and book the work that it has put in in the last step of length h."""
    row, way = system.actuators[i], components(system.actuators[i].between, axes)
    moved, speed = driven_place(row, system.bodies, way)
    rate = system.drives.moving[i, 0] - speed
    dragged = row.c * rate
    force = row.k * (system.drives.moved[i, 0] - (moved - row.reach)) + dragged
    books.driven[i] += 0.5 * h * (row.pulled + force) * system.drives.moving[i, 0]
    books.dampers[len(system.dampers) + i] += 0.5 * h * (row.dragged + dragged) * rate
    row.pulled, row.dragged = force, dragged
    if row.body >= 0:
        body, at = system.bodies[row.body], components(row.at, way)
        add_force(body, plus(at, rotation_change(body, at)), scaled(force, way))
        return
    acceleration = scaled(force / mass_of(system.bodies), way)
    for b in range(len(system.bodies)):
        increase(system.bodies[b].force, scaled(system.bodies[b].mass, acceleration))


@inlined
def mass_of(bodies: Rows) -> float:
    """Mass of all bodies [kg]."""
    mass = 0.0
    for b in range(len(bodies)):
        mass += bodies[b].mass
    return mass


@inlined
def driven_place(row: Row, bodies: Rows, way: Vector) -> tuple[float, float]:
    """Displacement along a way [m] and velocity [m/s] of what an actuator drives: its point, or the centroid of all."""
    if row.body >= 0:
        body, at = bodies[row.body], components(row.at, way)
        change = rotation_change(body, at)
        speed = plus(components(body.velocity, way), spun(spin_components(body.spin, way), plus(at, change)))
        return dot(way, plus(components(body.place, way), change)), dot(way, speed)
    moved, speeds, mass = 0.0, 0.0, mass_of(bodies)
    for b in range(len(bodies)):
        moved += bodies[b].mass * dot(way, components(bodies[b].place, way))
        speeds += bodies[b].mass * dot(way, components(bodies[b].velocity, way))
    return moved / mass, speeds / mass


@inlined
def linked_energy(system: System, axes: tuple[int, ...]) -> tuple[float, float]:
    """Potential energy of constant forces, and energy in the springs of ties and actuators [J]."""
    falls, elastic = 0.0, 0.0
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if tie.broken < math.inf:
            continue
        stretched = elongation(tie, pull(tie, system, axes).length)
        elastic += 0.5 * tie.k * stretched * stretched
    for i in range(len(system.actuators)):
        actuator = system.actuators[i]
        held = actuator.pulled - actuator.dragged
        elastic += 0.5 * held * held / actuator.k
    for i in range(len(system.forces)):
        row = system.forces[i]
        body = system.bodies[row.body]
        moved = plus(components(body.place, axes), rotation_change(body, components(row.at, axes)))
        falls -= dot(components(row.between, axes), moved)
    return falls, elastic


@inlined
def support_place(supports: Supports, i: int, axis: int, t: float) -> float:
    """Displacement of support i along an axis, linear between its samples and constant beyond them [m]."""
    low, high = supports.first[i], supports.first[i + 1] - 1
    t = min(max(t, supports.t[low]), supports.t[high])
    while high - low > 1:
        middle = (low + high) // 2
        if supports.t[middle] <= t:
            low = middle
        else:
            high = middle
    share = (t - supports.t[low]) / (supports.t[high] - supports.t[low]) if high > low else 0.0
    place: float = (1 - share) * supports.displacement[low, axis] + share * supports.displacement[high, axis]
    return place


@inlined
def move_supports(supports: Supports, t: float, h: float) -> None:
    """Bring displacement and mean velocity of the supports up to date, after a step of length h."""
    for i in range(len(supports.moved)):
        for axis in range(supports.moved.shape[1]):
            place = support_place(supports, i, axis, t)
            supports.moving[i, axis] = (place - supports.moved[i, axis]) / h if h > 0 else 0.0
            supports.moved[i, axis] = place
