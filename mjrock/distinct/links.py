"""Ties, dampers and constant forces on bodies, and the supports that move."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..compiled import inlined, jitable
from .contact import add_force
from .system import Books, Row, Supports, System


class Pull(NamedTuple):
    """A link at a pose: its length [m], its direction away from the anchor, and the arm to its point [m]."""

    length: float
    nx: float
    nz: float
    rx: float
    rz: float


@inlined
def pull(link: Row, body: Row) -> Pull:
    """Where a tie or a damper is."""
    swung_x = link.at_z * body.sine - link.at_x * body.versine
    swung_z = -link.at_x * body.sine - link.at_z * body.versine
    dx, dz = link.between_x + body.x + swung_x, link.between_z + body.z + swung_z
    length = math.sqrt(dx * dx + dz * dz)
    return Pull(length, dx / length, dz / length, link.at_x + swung_x, link.at_z + swung_z)


@inlined
def lengthening(now: Pull, body: Row) -> float:
    """Rate of the length of a tie or a damper [m/s]."""
    rate: float = now.nx * (body.vx + body.w * now.rz) + now.nz * (body.vz - body.w * now.rx)
    return rate


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


@jitable
def pull_links(system: System, books: Books, t: float, h: float) -> None:
    """Add the forces of ties, dampers and constant forces at time t, and book what the last step of length h took."""
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if t >= tie.broken:
            continue
        body = system.bodies[tie.body]
        now = pull(tie, body)
        beyond = now.length - tie.reach - tie.strength / tie.k
        if beyond > 0:  # it yields, and breaks where it has been drawn out as far as it can be
            left = tie.ultimate - tie.drawn
            tie.drawn, tie.reach = tie.drawn + min(beyond, left), tie.reach + min(beyond, left)
            books.ties[i] += tie.strength * min(beyond, left)
            if beyond >= left:
                since = since_broken(beyond - left, lengthening(now, body), h)
                tie.broken, books.broken[i] = t - since, 0.5 * tie.strength**2 / tie.k
                last = pulled_until_broken(tie, since, h)
                add_force(body, now.rx, now.rz, -last * now.nx, -last * now.nz)
                continue
        force = -tie.k * max(0.0, now.length - tie.reach)
        add_force(body, now.rx, now.rz, force * now.nx, force * now.nz)
    for i in range(len(system.dampers)):
        damper = system.dampers[i]
        body = system.bodies[damper.body]
        now = pull(damper, body)
        rate = lengthening(now, body)
        force = -damper.c * rate
        books.dampers[i] -= 0.5 * h * (force + damper.pulled) * rate
        damper.pulled = force
        add_force(body, now.rx, now.rz, force * now.nx, force * now.nz)
    for i in range(len(system.forces)):
        force_row = system.forces[i]
        body = system.bodies[force_row.body]
        rx = force_row.at_x + force_row.at_z * body.sine - force_row.at_x * body.versine
        rz = force_row.at_z - force_row.at_x * body.sine - force_row.at_z * body.versine
        add_force(body, rx, rz, force_row.between_x, force_row.between_z)


@jitable
def linked_energy(system: System) -> tuple[float, float]:
    """Potential energy of constant forces, and energy in the springs of the ties [J]."""
    falls, elastic = 0.0, 0.0
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if tie.broken < math.inf:
            continue
        stretched = max(0.0, pull(tie, system.bodies[tie.body]).length - tie.reach)
        elastic += 0.5 * tie.k * stretched * stretched
    for i in range(len(system.forces)):
        force = system.forces[i]
        body = system.bodies[force.body]
        falls -= force.between_x * (body.x + force.at_z * body.sine - force.at_x * body.versine)
        falls -= force.between_z * (body.z - force.at_x * body.sine - force.at_z * body.versine)
    return falls, elastic


@jitable
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


@jitable
def move_supports(supports: Supports, t: float, h: float) -> None:
    """Bring displacement and mean velocity of the supports up to date, after a step of length h."""
    for i in range(len(supports.moved)):
        for axis in range(supports.moved.shape[1]):
            place = support_place(supports, i, axis, t)
            supports.moving[i, axis] = (place - supports.moved[i, axis]) / h if h > 0 else 0.0
            supports.moved[i, axis] = place
