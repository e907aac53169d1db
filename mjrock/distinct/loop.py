"""The explicit steps: forces at the pose, then velocities, then the pose.

Velocities stand half a step before the pose, and the step is symplectic Euler's. At the start they stand at the pose,
and the forces act on them for half a step.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..compiled import compiled, jitable
from ..quantities import GRAVITY, Array
from ..scene.ground import mean_acceleration
from .contact import meeting, press_lines
from .friction import book_rubbing, note_slips, stick
from .links import linked_energy, move_supports, pull_links
from .system import ALWAYS, Books, Rows, Samples, System

GONE = 1e6
"""Displacement beyond which a run has broken down [m]."""


class Clock(NamedTuple):
    """Where a run is.

    Args:
        step: number of the next step.
        h: length of a step [s].
        every: steps from one sample to the next.
        row: number of the next sample.
        rows: how many samples to make.
        ends: rotation at which the run ends [rad], infinite for a run to its end.
    """

    step: int
    h: float
    every: int
    row: int
    rows: int
    ends: float


@jitable
def weigh(system: System, books: Books, t: float, h: float, kick: float) -> None:
    """Start the forces with weight and ground motion, and book the work of the ground in the last step."""
    accounts, last = books.friction, h if kick == h else 0.0
    push_x = mean_acceleration(system.ground.x, t, h) * h / kick
    push_z = mean_acceleration(system.ground.z, t, h) * h / kick
    mean_x, mean_z = 0.5 * (push_x + accounts[2]), 0.5 * (push_z + accounts[3])
    for b in range(len(system.bodies)):
        body = system.bodies[b]
        half = math.sin(0.5 * body.theta)
        body.sine, body.versine = 2 * half * math.cos(0.5 * body.theta), 2 * half * half
        accounts[1] -= last * body.mass * (mean_x * body.vx + mean_z * body.vz)
        body.fx, body.fz, body.moment = -body.mass * push_x, -body.mass * (GRAVITY + push_z), 0.0
    accounts[2], accounts[3] = push_x, push_z


@jitable
def kick_bodies(bodies: Rows, kick: float) -> None:
    """Let the forces act on the velocities for a time [s]."""
    for b in range(len(bodies)):
        body = bodies[b]
        body.vx += kick * body.fx / body.mass
        body.vz += kick * body.fz / body.mass
        body.w += kick * body.moment * body.ease


@jitable
def move_bodies(bodies: Rows, h: float) -> None:
    """Move the bodies by a step."""
    for b in range(len(bodies)):
        body = bodies[b]
        body.x += h * body.vx
        body.z += h * body.vz
        body.theta += h * body.w


@jitable
def keep_pose(system: System, books: Books, samples: Samples, row: int) -> None:
    """Keep pose and velocities before it, the potential and elastic energy, and the accounts of work."""
    for b in range(len(system.bodies)):
        body, pose, velocity = system.bodies[b], samples.pose[row, b], samples.velocity[row, b]
        pose[0], pose[1], pose[2] = body.x, body.z, body.theta
        velocity[0], velocity[1], velocity[2] = body.vx, body.vz, body.w
    potential, elastic = linked_energy(system)
    sheared = 0.0
    for p in range(len(system.lines)):
        line = system.lines[p]
        pressed = min(meeting(system.bodies, line, system.supports).gap, 0.0)
        if line.corner == 1:  # it may be behind an edge that it has not come through
            pressed = 0.0
        elastic += 0.5 * line.k * pressed * pressed
        if line.k_s < math.inf:
            sheared += 0.5 * line.k_s * line.grip * line.grip
    samples.energy[row, 1], samples.energy[row, 2] = potential, elastic + sheared
    samples.work[row, 0], samples.work[row, 1] = books.friction[0] - sheared, books.friction[1]
    samples.work[row, 2], samples.work[row, 3] = books.ends
    if samples.work.shape[1] > ALWAYS:
        keep_work(books, samples.work[row])


@jitable
def keep_work(books: Books, work: Array) -> None:
    """Keep the accounts of dampers, ties, broken ties and dashpots."""
    column = ALWAYS
    for account in (books.dampers, books.ties, books.broken, books.dashpots):
        for i in range(len(account)):
            work[column] = account[i]
            column += 1


@jitable
def keep_velocity(bodies: Rows, samples: Samples, row: int) -> None:
    """Bring the kept velocities to the time of the pose, and keep the kinetic and the whole potential energy."""
    kinetic, potential, share = 0.0, 0.0, 0.5 if row > 0 else 0.0
    for b in range(len(bodies)):
        body, velocity = bodies[b], samples.velocity[row, b]
        velocity[0] += share * (body.vx - velocity[0])
        velocity[1] += share * (body.vz - velocity[1])
        velocity[2] += share * (body.w - velocity[2])
        kinetic += 0.5 * body.mass * (velocity[0] ** 2 + velocity[1] ** 2) + 0.5 * velocity[2] ** 2 / body.ease
        potential += GRAVITY * body.mass * body.z
    samples.energy[row, 0] = kinetic
    samples.energy[row, 1] += potential


@jitable
def broken(bodies: Rows, ends: float) -> bool:
    """Whether a body has gone astray, or has turned by more than a run follows."""
    for b in range(len(bodies)):
        body = bodies[b]
        if not (abs(body.x) < GONE and abs(body.z) < GONE and abs(body.theta) < ends):
            return True
    return False


@compiled
def advance(system: System, books: Books, samples: Samples, clock: Clock) -> tuple[int, int, bool]:
    """Steps until some samples are made.

    Returns the number of the next step and of the next sample, and whether the run has ended.
    """
    n, h, row, last = clock.step, clock.h, clock.row, clock.row + clock.rows
    accounted = samples.work.shape[1] > ALWAYS or len(system.supports.moved) > 0
    while True:
        before, kick, sampled = h if n > 0 else 0.0, h if n > 0 else 0.5 * h, n % clock.every == 0
        move_supports(system.supports, n * h, before)
        weigh(system, books, n * h, h, kick)
        pull_links(system, books, n * h, before)
        sticking = press_lines(system, books, before, kick)
        if sampled:
            keep_pose(system, books, samples, row)
        if accounted:
            note_slips(system, books.active, sticking)
        kick_bodies(system.bodies, kick)
        stick(system, books.active, sticking, kick)
        if accounted:
            rubbed, carried = books.friction[0], books.friction[1]
            book_rubbing(system, books, sticking)
            if sampled and n > 0:  # half of it belongs to the time before the pose
                samples.work[row, 0] += 0.5 * (books.friction[0] - rubbed)
                samples.work[row, 1] += 0.5 * (books.friction[1] - carried)
        if sampled:
            keep_velocity(system.bodies, samples, row)
            row += 1
            if broken(system.bodies, clock.ends):
                return n, row, True
        move_bodies(system.bodies, h)
        n += 1
        if row == last:
            return n, row, False
