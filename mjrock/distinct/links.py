"""Ties, dampers and constant forces on bodies, and the supports that move."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..compiled import inlined, jitable
from .contact import add_force
from .system import Books, Row, Supports, System
from .yielding import elongation, let_yield


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


@jitable
def pull_links(system: System, books: Books, t: float, h: float) -> None:
    """Add the forces of ties, dampers and constant forces at time t, and book what the last step of length h took."""
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if t >= tie.broken:
            continue
        body = system.bodies[tie.body]
        now = pull(tie, body)
        let_yield(tie, now.length, books, i, t)
        if tie.broken <= t:
            continue
        force = -tie.k * elongation(tie, now.length)
        add_force(body, now.rx, now.rz, force * now.nx, force * now.nz)
    for i in range(len(system.dampers)):
        damper = system.dampers[i]
        body = system.bodies[damper.body]
        now = pull(damper, body)
        rate = now.nx * (body.vx + body.w * now.rz) + now.nz * (body.vz - body.w * now.rx)
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
        stretched = elongation(tie, pull(tie, system.bodies[tie.body]).length)
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
