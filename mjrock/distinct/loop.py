"""The explicit steps: forces at the pose, then velocities and spins, then the pose.

Velocities and spins stand half a step before the pose, and the step is symplectic Euler's. At a start that no step led
to they stand at the pose, and the forces act on them for half a step.
"""

from __future__ import annotations

import sys
from typing import NamedTuple

from ..compiled import compiled_at_once, inlined
from ..geometry.vectors import (
    Vector,
    components,
    dot,
    increase,
    minus,
    no_spin,
    plus,
    put,
    read,
    scaled,
    spin_components,
)
from ..problem.masonry.laws.joint_law import stored
from ..quantities import GRAVITY, Array
from ..scene.course import Ground, mean_acceleration
from .contacts.contact import settle_touches
from .contacts.friction import book_rubbing, sheared, stick
from .contacts.touches import in_transit, was_open
from .force_record import record_forces, record_guide_loads
from .kinds.lists import act_all, hold_all, settle_all, stored_by_laws
from .motion_damping import damp_unbalanced, damp_velocities
from .rotation import (
    apply_angular_impulse,
    apply_impulse,
    apply_inverse_inertia,
    in_body,
    momentum_of,
    rotate_body,
    rotation_within,
    take_inverse_inertia,
    update_rotation,
    write_rotation,
)
from .rows import Rows
from .spans import bodies_of_span, list_touched, press_by_laws, press_own_lines, sum_up
from .supports import move_supports
from .system import Books, Samples, System
from .thread import Thread, bring_together, end_all, has_ended, wait

BROKEN_DOWN = 1e6
"""Displacement beyond which a run has broken down [m]."""


class Clock(NamedTuple):
    """Where a run is.

    Args:
        step: number of the next step.
        h: length of a step [s].
        every: steps from one sample to the next.
        row: number of the next sample.
        stop: number of the step before which to stop.
        last: number of the last step of the run.
        ends: rotation at which the run ends [rad], infinite for a run to its end.
        before: length of the step that led to the start, zero for a start that no step led to [s].
        pushed: mean acceleration of the ground over the half of a step before the start [m/s2].
        check: steps from one check of the energy to the next.
        drag, local: mass-proportional damping [1/s] and local damping [-] of the motion, see `motion_damping`.
        lead: by how many steps dashpots look ahead, see `touches.foreseen`.
    """

    step: int
    h: float
    every: int
    row: int
    stop: int
    last: int
    ends: float
    before: float
    pushed: Vector
    check: int = sys.maxsize
    lead: float = 0.0
    drag: float = 0.0
    local: float = 0.0


@inlined
def accelerated(ground: Ground, t: float, h: float, like: Vector) -> Vector:
    """Mean acceleration of the ground over the window of a step [m/s2], with as many components as another vector."""
    x, z = mean_acceleration(ground.x, t, h), mean_acceleration(ground.z, t, h)
    if len(like) == 2:
        return x, z
    return x, mean_acceleration(ground.y, t, h), z


@inlined
def upwards(size: float, like: Vector) -> Vector:
    """A vertical vector of as many components as another one."""
    if len(like) == 2:
        return 0.0, size
    return 0.0, 0.0, size


@inlined
def start_forces(system: System, books: Books, push: Vector, before: float) -> None:
    """Start the forces with weight and ground motion, and book the work of the ground in the last step.

    Args:
        system, books: the bodies and the accounts.
        push: mean acceleration of the ground while the forces act [m/s2].
        before: length of the last step [s].
    """
    totals, done = books.totals[0], 0.0
    mean = scaled(0.5, plus(push, read(totals.push)))
    weight = plus(push, upwards(GRAVITY, push))
    for b in range(len(system.bodies)):
        body = system.bodies[b]
        update_rotation(body)
        if len(system.tangents) > 0:
            take_inverse_inertia(body)
        done -= before * body.mass * dot(mean, read(body.velocity))
        put(body.force, scaled(-body.mass, weight))
        put(body.moment, no_spin(push))
    totals.ground += done
    put(totals.push, push)


@inlined
def kick_bodies(bodies: Rows, kick: float) -> None:
    """Let forces and moments act for a time [s]."""
    for b in range(len(bodies)):
        body = bodies[b]
        apply_impulse(body, scaled(kick, read(body.force)))
        apply_angular_impulse(body, scaled(kick, read(body.moment)))


@inlined
def move_bodies(bodies: Rows, h: float) -> None:
    """Move the bodies by a step."""
    for b in range(len(bodies)):
        body = bodies[b]
        increase(body.place, scaled(h, read(body.velocity)))
        rotate_body(body, h)


@inlined
def record_pose(system: System, books: Books, samples: Samples, row: int, before: float) -> None:
    """Keep pose and velocities before it, the potential and elastic energy, and the accounts of work.

    In place of the spins the angular momenta are kept for now, see `record_velocity`. `before` is the length of the
    last step [s]."""
    for b in range(len(system.bodies)):
        body, pose, velocity = system.bodies[b], samples.pose[row, b], samples.velocity[row, b]
        put(pose, read(body.place))
        write_rotation(body, pose)
        put(velocity, read(body.velocity))
        put(velocity[len(body.place) :], momentum_of(body))
    sum_up(system, books)
    record_account(books.dashpots, samples.dashpots[row])
    energy, totals = samples.energy[row], books.totals[0]
    energy.potential = energy.elastic = energy.driven = 0.0
    hold_all(system.links, system, books, energy, samples.pulled[row])
    elastic = energy.elastic
    bonded, along_faces = stored_by_laws(system.laws)
    for p in range(len(system.lines)):
        line = system.lines[p]
        if not was_open(line):
            transit, early = in_transit(line, before)
            elastic += stored(line, -line.depth) + transit
            if samples.dashpots.shape[1] > 0:
                samples.dashpots[row, line.group] += early
        along_faces += sheared(line)
    energy.elastic = elastic + bonded + along_faces
    energy.friction, energy.ground = totals.friction - along_faces, totals.ground
    energy.tension, energy.slip, energy.crushing = totals.tension, totals.slip, totals.crushing
    energy.joint_ends, energy.encounter_ends = totals.joint_ends, totals.encounter_ends
    record_account(books.links, samples.links[row])


@inlined
def record_account(account: Array, kept: Array) -> None:
    """Keep an account, for which there is room where there is a ledger."""
    for i in range(len(kept)):
        kept[i] = account[i]


@inlined
def record_velocity(bodies: Rows, samples: Samples, row: int, before: float) -> None:
    """Bring the kept velocities to the time of the pose, and keep the kinetic and the whole potential energy.

    Angular momenta give way to spins in the axes of the bodies. `before` is the length of the last step [s]. The
    kinetic energy is that which the steps conserve: half the product of velocity and momentum before and after the
    pose, at a start after it and as far before it. It is less than that of the mean velocity, and below zero where a
    stiff contact reverses a motion."""
    kinetic, potential, share = 0.0, 0.0, 0.5 if before > 0 else 0.0
    for b in range(len(bodies)):
        body, velocity = bodies[b], samples.velocity[row, b]
        after, d = read(body.velocity), len(body.place)
        linear, momentum = components(velocity, after), spin_components(velocity[d:], after)
        faster, turned = minus(after, linear), minus(momentum_of(body), momentum)
        linear, faster = plus(linear, scaled(share, faster)), scaled(1 - share, faster)
        momentum, turned = (
            in_body(body, plus(momentum, scaled(share, turned))),
            in_body(body, scaled(1 - share, turned)),
        )
        spin = apply_inverse_inertia(body, momentum)
        put(velocity, linear)
        put(velocity[d:], spin)
        kinetic += 0.5 * body.mass * (dot(linear, linear) - dot(faster, faster))
        kinetic += 0.5 * (dot(momentum, spin) - dot(turned, apply_inverse_inertia(body, turned)))
        potential += GRAVITY * body.mass * body.place[d - 1]
    samples.energy[row].kinetic = kinetic
    samples.energy[row].potential += potential


@inlined
def is_astray(bodies: Rows, ends: float) -> bool:
    """Whether a body has gone so far that the run has broken down, or has turned by more than a run follows."""
    for b in range(len(bodies)):
        body = bodies[b]
        for i in range(len(body.place)):
            if not abs(body.place[i]) < BROKEN_DOWN:
                return True
        if not rotation_within(body, ends):
            return True
    return False


class Step(NamedTuple):
    """A step of a run.

    Args:
        t: when it begins [s].
        before: length of the step before [s].
        kick: time for which its forces act on the velocities [s].
        sampled, checked: whether there is a sample, and a check of the energy, of its start.
        kept: number of the sample that is written, the one that is not kept where there is a check alone.
    """

    t: float
    before: float
    kick: float
    sampled: bool
    checked: bool
    kept: int


@inlined
def step_of(clock: Clock, n: int, row: int, samples: Samples) -> Step:
    """Step n, with the number of the next sample."""
    before = clock.h if n > 0 else clock.before
    sampled = n % clock.every == 0 or n == clock.last
    checked = n % clock.check == 0 or n == clock.last
    kept = row if sampled else len(samples.pose) - 1
    return Step(n * clock.h, before, 0.5 * (before + clock.h), sampled, checked, kept)


@inlined
def add_forces(system: System, books: Books, samples: Samples, clock: Clock, thread: Thread, step: Step) -> int:
    """Add all forces at the pose but rigid friction. Returns how many lines stick rigidly."""
    t, h, before = step.t, clock.h, step.before
    if thread.number == 0:
        move_supports(system.supports, t, before)
    push = scaled(h / step.kick, accelerated(system.ground, t, h, read(system.bodies[0].place)))
    if t == 0:
        push = plus(push, scaled(0.5 * before / step.kick, clock.pushed))
    for span in range(thread.own_bodies[0], thread.own_bodies[1]):
        some, own = bodies_of_span(system, books, thread, span)
        start_forces(some, own, push, before)
    wait(thread)
    if has_links(samples):
        if thread.number == 0:
            act_all(system.links, system, books, t, before)
            if step.sampled:
                record_guide_loads(system, samples, step.kept)
        wait(thread)
    press_by_laws(system.laws, system, books, thread, t, before)
    sticking = press_own_lines(system, books, thread, before, step.kick, clock.lead)
    bring_together(thread, books.apart, system.bodies)
    return sticking


@inlined
def has_links(samples: Samples) -> bool:
    """Whether there are links, whose forces are kept."""
    return bool(samples.pulled.shape[1] > 0)


@inlined
def settle_step(system: System, books: Books, samples: Samples, step: Step, sticking: int, touched: int) -> None:
    """Finish the forces of a step, by one thread for all: rigid friction, touches and links."""
    energy, kick = samples.energy[step.kept], step.kick
    stick(system, books.active, sticking, kick)
    stored_energy, put_in = settle_touches(system, books, touched, kick)
    by_links, put_in_by_links = settle_all(system.links, system, books, kick)
    energy.elastic += stored_energy + by_links
    energy.ground += put_in + put_in_by_links
    if samples.dashpots.shape[1] > 0 or len(system.supports.moved) > 0:
        rubbed, put_in = book_rubbing(system, books, sticking)
        if step.before > 0:  # halves that belong to the time before the pose
            energy.friction += rubbed
            energy.ground += put_in


@compiled_at_once
def advance(system: System, books: Books, samples: Samples, clock: Clock, thread: Thread) -> tuple[int, int, bool]:
    """Steps up to that before which to stop. Samples and checks are made at fixed numbers of steps, and at the last.

    Each thread of a run calls it. Returns the number of the next step and of the next sample, and
    whether the run has ended.
    """
    n, row = clock.step, clock.row
    first, last = thread.bodies[thread.own_bodies[0]], thread.bodies[thread.own_bodies[1]]
    own = system.bodies[first:last]
    while n < clock.stop:
        step = step_of(clock, n, row, samples)
        sticking = add_forces(system, books, samples, clock, thread, step)
        touched = list_touched(books, thread)
        kept = step.sampled or step.checked
        if kept or clock.local > 0:
            wait(thread)
            if thread.number == 0:
                if kept:
                    record_pose(system, books, samples, step.kept, step.before)
                if clock.local > 0:
                    damp_unbalanced(system, books, clock.local, step.kick)
            wait(thread)
        kick_bodies(own, step.kick)
        if kept or sticking > 0 or touched > 0 or clock.drag > 0 or has_links(samples):
            wait(thread)
            if thread.number == 0:
                settle_step(system, books, samples, step, sticking, touched)
                if clock.drag > 0:
                    damp_velocities(system, books, clock.drag * step.kick)
                if kept:
                    record_velocity(system.bodies, samples, step.kept, step.before)
                if step.sampled:
                    record_forces(system, samples, step.kept)
                if step.checked:
                    samples.checks[-(-n // clock.check)] = samples.energy[step.kept]
                if step.sampled and is_astray(system.bodies, clock.ends):
                    end_all(thread)
            wait(thread)
        if step.sampled:
            row += 1
            if has_ended(thread):
                return n, row, True
        move_bodies(own, clock.h)
        n += 1
    return n, row, False
