"""Ties, dampers and constant forces on bodies in space, between a body and the ground or between two bodies."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...compiled import inlined, jitable
from ...geometry.vectors import Vector, dot, minus, plus, scaled, spun
from ..system import Books, Row, Rows
from ..yielding import elongation, let_yield
from .system import System, add_force, at_of, between_of, origin_of, place_of, spin_of, velocity_of
from .turning import swung


class Pull(NamedTuple):
    """A link at a pose: its length [m], its direction away from the anchor, and the arms to its two ends [m]."""

    length: float
    way: Vector
    arm: Vector
    anchor_arm: Vector


@inlined
def pull(link: Row, bodies: Rows) -> Pull:
    """Where a tie or a damper is."""
    body, at = bodies[link.body], at_of(link)
    swing = swung(body, at)
    arm, across = plus(at, swing), plus(between_of(link), plus(place_of(body), swing))
    anchor_arm = origin_of(link)
    if link.anchor >= 0:
        anchor = bodies[link.anchor]
        swing = swung(anchor, anchor_arm)
        across = minus(across, plus(place_of(anchor), swing))
        anchor_arm = plus(anchor_arm, swing)
    length = math.sqrt(dot(across, across))
    return Pull(length, scaled(1 / length, across), arm, anchor_arm)


@inlined
def act(link: Row, bodies: Rows, now: Pull, force: float) -> None:
    """Add a force along a link on the bodies at both ends [N], positive where it pushes them apart."""
    add_force(bodies[link.body], now.arm, scaled(force, now.way))
    if link.anchor >= 0:
        add_force(bodies[link.anchor], now.anchor_arm, scaled(-force, now.way))


@inlined
def lengthening(link: Row, bodies: Rows, now: Pull) -> float:
    """Rate of the length of a link [m/s]."""
    body = bodies[link.body]
    velocity = plus(velocity_of(body), spun(spin_of(body), now.arm))
    if link.anchor >= 0:
        anchor = bodies[link.anchor]
        velocity = minus(velocity, plus(velocity_of(anchor), spun(spin_of(anchor), now.anchor_arm)))
    return dot(now.way, velocity)


@jitable
def pull_links(system: System, books: Books, t: float, h: float) -> None:
    """Add the forces of ties, dampers and constant forces at time t, and book what the last step of length h took."""
    bodies = system.bodies
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if t >= tie.broken:
            continue
        now = pull(tie, bodies)
        let_yield(tie, now.length, books, i, t)
        if tie.broken <= t:
            continue
        act(tie, bodies, now, -tie.k * elongation(tie, now.length))
    for i in range(len(system.dampers)):
        damper = system.dampers[i]
        now = pull(damper, bodies)
        rate = lengthening(damper, bodies, now)
        force = -damper.c * rate
        books.dampers[i] -= 0.5 * h * (force + damper.pulled) * rate
        damper.pulled = force
        act(damper, bodies, now, force)
    for i in range(len(system.forces)):
        row = system.forces[i]
        body, at = bodies[row.body], at_of(row)
        add_force(body, plus(at, swung(body, at)), between_of(row))


@jitable
def linked_energy(system: System) -> tuple[float, float]:
    """Potential energy of constant forces, and energy in the springs of the ties [J]."""
    falls, elastic = 0.0, 0.0
    for i in range(len(system.ties)):
        tie = system.ties[i]
        if tie.broken < math.inf:
            continue
        stretched = elongation(tie, pull(tie, system.bodies).length)
        elastic += 0.5 * tie.k * stretched * stretched
    for i in range(len(system.forces)):
        row = system.forces[i]
        body = system.bodies[row.body]
        falls -= dot(between_of(row), plus(place_of(body), swung(body, at_of(row))))
    return falls, elastic
