"""The explicit steps in space: forces at the pose, then velocities and angular momenta, then the pose.

Velocities and angular momenta stand half a step before the pose. At the start they stand at the pose, and the forces
act on them for half a step.
"""

from __future__ import annotations

import math

from ...compiled import compiled, jitable
from ...geometry.vectors import dot, minus, plus, scaled
from ...quantities import GRAVITY
from ...scene.ground import mean_acceleration
from ..links import move_supports
from ..loop import GONE, Clock, keep_work
from ..system import ALWAYS, Books, Rows, Samples
from .contact import meeting, press_points
from .friction import book_rubbing, note_slips, stick
from .links import linked_energy, pull_links
from .system import System, grip_of, momentum_of, velocity_of
from .turning import eased, in_body, take_spin, take_turn, turn_body


@jitable
def weigh(system: System, books: Books, t: float, h: float, kick: float) -> None:
    """Start the forces with weight and ground motion, and book the work of the ground in the last step."""
    accounts, last, ground = books.friction, h if kick == h else 0.0, system.ground
    push_x = mean_acceleration(ground.x, t, h) * h / kick
    push_y = mean_acceleration(ground.y, t, h) * h / kick
    push_z = mean_acceleration(ground.z, t, h) * h / kick
    mean = 0.5 * (push_x + accounts[2]), 0.5 * (push_y + accounts[4]), 0.5 * (push_z + accounts[3])
    for b in range(len(system.bodies)):
        body = system.bodies[b]
        take_turn(body)
        take_spin(body)
        accounts[1] -= last * body.mass * dot(mean, velocity_of(body))
        body.fx, body.fy = -body.mass * push_x, -body.mass * push_y
        body.fz = -body.mass * (GRAVITY + push_z)
        body.moment_x, body.moment_y, body.moment_z = 0.0, 0.0, 0.0
    accounts[2], accounts[3], accounts[4] = push_x, push_z, push_y


@jitable
def kick_bodies(bodies: Rows, kick: float) -> None:
    """Let forces and moments act on the velocities and angular momenta for a time [s]."""
    for b in range(len(bodies)):
        body = bodies[b]
        body.vx += kick * body.fx / body.mass
        body.vy += kick * body.fy / body.mass
        body.vz += kick * body.fz / body.mass
        body.momentum_x += kick * body.moment_x
        body.momentum_y += kick * body.moment_y
        body.momentum_z += kick * body.moment_z
        take_spin(body)


@jitable
def move_bodies(bodies: Rows, h: float) -> None:
    """Move the bodies by a step."""
    for b in range(len(bodies)):
        body = bodies[b]
        body.x += h * body.vx
        body.y += h * body.vy
        body.z += h * body.vz
        turn_body(body, h)


@jitable
def keep_pose(system: System, books: Books, samples: Samples, row: int) -> None:
    """Keep pose and velocities before it, the potential and elastic energy, and the accounts of work.

    Instead of angular velocities the angular momenta are kept for now, see `keep_velocity`."""
    for b in range(len(system.bodies)):
        body, pose, velocity = system.bodies[b], samples.pose[row, b], samples.velocity[row, b]
        pose[0], pose[1], pose[2] = body.x, body.y, body.z
        pose[3], pose[4], pose[5], pose[6] = body.qw, body.qx, body.qy, body.qz
        velocity[0], velocity[1], velocity[2] = velocity_of(body)
        velocity[3], velocity[4], velocity[5] = momentum_of(body)
    potential, elastic = linked_energy(system)
    sheared = 0.0
    for p in range(len(system.lines)):
        point = system.lines[p]
        pressed = min(meeting(system, point).gap, 0.0)
        elastic += 0.5 * point.k * pressed * pressed
        if point.k_s < math.inf:
            sheared += 0.5 * point.k_s * dot(grip_of(point), grip_of(point))
    samples.energy[row, 1], samples.energy[row, 2] = potential, elastic + sheared
    samples.work[row, 0], samples.work[row, 1] = books.friction[0] - sheared, books.friction[1]
    samples.work[row, 2], samples.work[row, 3] = books.ends
    if samples.work.shape[1] > ALWAYS:
        keep_work(books, samples.work[row])


@jitable
def keep_velocity(bodies: Rows, samples: Samples, row: int) -> None:
    """Bring the kept velocities to the time of the pose, and keep the kinetic and the whole potential energy.

    Angular momenta give way to angular velocities in the axes of the bodies."""
    kinetic, potential, share = 0.0, 0.0, 0.5 if row > 0 else 0.0
    for b in range(len(bodies)):
        body, velocity = bodies[b], samples.velocity[row, b]
        kept = (velocity[0], velocity[1], velocity[2]), (velocity[3], velocity[4], velocity[5])
        linear = plus(kept[0], scaled(share, minus(velocity_of(body), kept[0])))
        momentum = in_body(body, plus(kept[1], scaled(share, minus(momentum_of(body), kept[1]))))
        spin = eased(body, momentum)
        velocity[0], velocity[1], velocity[2] = linear
        velocity[3], velocity[4], velocity[5] = spin
        kinetic += 0.5 * body.mass * dot(linear, linear) + 0.5 * dot(momentum, spin)
        potential += GRAVITY * body.mass * body.z
    samples.energy[row, 0] = kinetic
    samples.energy[row, 1] += potential


@jitable
def astray(bodies: Rows) -> bool:
    """Whether a body has gone so far that the run has broken down."""
    for b in range(len(bodies)):
        body = bodies[b]
        if not (abs(body.x) < GONE and abs(body.y) < GONE and abs(body.z) < GONE and abs(body.wx) < math.inf):
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
        sticking = press_points(system, books, before, kick)
        if sampled:
            keep_pose(system, books, samples, row)
        if accounted:
            note_slips(system, books, sticking)
        kick_bodies(system.bodies, kick)
        stick(system, books, sticking, kick)
        if accounted:
            rubbed, carried = books.friction[0], books.friction[1]
            book_rubbing(system, books, sticking)
            if sampled and n > 0:  # half of it belongs to the time before the pose
                samples.work[row, 0] += 0.5 * (books.friction[0] - rubbed)
                samples.work[row, 1] += 0.5 * (books.friction[1] - carried)
        if sampled:
            keep_velocity(system.bodies, samples, row)
            row += 1
            if astray(system.bodies):
                return n, row, True
        move_bodies(system.bodies, h)
        n += 1
        if row == last:
            return n, row, False
