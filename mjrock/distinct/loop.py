"""The explicit steps: forces at the pose, then velocities and spins, then the pose.

Velocities and spins stand half a step before the pose, and the step is symplectic Euler's. At a start that no step led
to they stand at the pose, and the forces act on them for half a step.
"""

from __future__ import annotations

import math
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
from ..rows import Rows
from ..scene.course import Ground, mean_acceleration
from .contacts.contact import settle_touches
from .contacts.friction import book_rubbing, sheared, stick
from .contacts.touches import in_transit, was_open
from .force_record import record_forces, record_guide_loads
from .kinds.lists import act_all, record_links, settle_all, stored_by_laws
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
from .spans import bodies_of_span, list_touched, press_by_laws, press_spans, sum_up
from .supports import move_supports
from .system import Books, Samples, System
from .thread import Thread, add_pending_forces, end_all, has_ended, wait

BROKEN_DOWN = 1e6
"""Displacement beyond which a run has broken down [m]."""


class Clock(NamedTuple):
    """Where a run is.

    Args:
        h: length of a step [s].
        steps_per_sample, steps_per_check: steps from one sample, and from one check of the energy, to the next.
        stop: number of the step before which to stop.
        last: number of the last step of the run.
        ground_acceleration_before: its mean over the half of a step before the start [m/s2].
        step, sample: numbers of the next step and of the next sample.
        end_rotation: rotation at which the run ends [rad], infinite for a run to its end.
        h_before: length of the step that led to the start, zero for a start that no step led to [s].
        steps_ahead: by how many steps dashpots look ahead, see `touches.foreseen`.
        mass_damping, local_damping: of the motion [1/s, -], see `motion_damping`.
    """

    h: float
    steps_per_sample: int
    stop: int
    last: int
    ground_acceleration_before: Vector
    step: int = 0
    sample: int = 0
    end_rotation: float = math.inf
    h_before: float = 0.0
    steps_per_check: int = sys.maxsize
    steps_ahead: float = 0.0
    mass_damping: float = 0.0
    local_damping: float = 0.0


@inlined
def ground_acceleration(ground: Ground, t: float, h: float, like: Vector) -> Vector:
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
def start_forces(system: System, books: Books, acceleration: Vector, h_before: float) -> None:
    """Start the forces with weight and ground motion, and book the work of the ground in the last step.

    Args:
        system, books: the bodies and the accounts.
        acceleration: mean acceleration of the ground while the forces act [m/s2].
        h_before: length of the last step [s].
    """
    totals, work = books.totals[0], 0.0
    mean = scaled(0.5, plus(acceleration, read(totals.ground_acceleration)))
    of_weight = plus(acceleration, upwards(GRAVITY, acceleration))
    for b in range(len(system.bodies)):
        body = system.bodies[b]
        update_rotation(body)
        if len(system.tangents) > 0:
            take_inverse_inertia(body)
        work -= h_before * body.mass * dot(mean, read(body.velocity))
        put(body.force, scaled(-body.mass, of_weight))
        put(body.moment, no_spin(acceleration))
    totals.ground += work
    put(totals.ground_acceleration, acceleration)


@inlined
def accelerate_bodies(bodies: Rows, force_time: float) -> None:
    """Let forces and moments act for a time [s]."""
    for b in range(len(bodies)):
        body = bodies[b]
        apply_impulse(body, scaled(force_time, read(body.force)))
        apply_angular_impulse(body, scaled(force_time, read(body.moment)))


@inlined
def move_bodies(bodies: Rows, h: float) -> None:
    """Move the bodies by a step."""
    for b in range(len(bodies)):
        body = bodies[b]
        increase(body.place, scaled(h, read(body.velocity)))
        rotate_body(body, h)


@inlined
def record_pose(system: System, books: Books, samples: Samples, sample: int, h_before: float) -> None:
    """Keep pose and velocities before it, the potential and elastic energy, and the accounts of work.

    The angular momenta stand in place of the spins until `record_velocity` replaces them. `h_before` is the length of
    the last step [s]."""
    for b in range(len(system.bodies)):
        body, pose, velocity = system.bodies[b], samples.pose[sample, b], samples.velocity[sample, b]
        put(pose, read(body.place))
        write_rotation(body, pose)
        put(velocity, read(body.velocity))
        put(velocity[len(body.place) :], momentum_of(body))
    sum_up(system, books)
    record_account(books.dashpots, samples.dashpots[sample])
    energy, totals = samples.energy[sample], books.totals[0]
    energy.potential = energy.elastic = energy.driven = 0.0
    record_links(system.links, system, books, energy, samples.link_forces[sample])
    elastic = energy.elastic
    along_normals, along_faces = stored_by_laws(system.laws)
    for p in range(len(system.lines)):
        line = system.lines[p]
        if not was_open(line):
            transit, early = in_transit(line, h_before)
            elastic += stored(line, -line.depth) + transit
            if samples.dashpots.shape[1] > 0:
                samples.dashpots[sample, line.group] += early
        along_faces += sheared(line)
    energy.elastic = elastic + along_normals + along_faces
    energy.friction, energy.ground = totals.friction - along_faces, totals.ground
    energy.tension, energy.slip, energy.crushing = totals.tension, totals.slip, totals.crushing
    energy.joint_ends, energy.encounter_ends = totals.joint_ends, totals.encounter_ends
    record_account(books.links, samples.links[sample])


@inlined
def record_account(account: Array, kept: Array) -> None:
    """Keep an account, for which there is room where there is a ledger."""
    for i in range(len(kept)):
        kept[i] = account[i]


@inlined
def record_velocity(bodies: Rows, samples: Samples, sample: int, h_before: float) -> None:
    """Bring the recorded velocities to the time of the pose, and record the kinetic and the whole potential energy.

    The velocity at the pose is the mean of those half a step before and after it, and at a start that of the start.
    Spins in the axes of the bodies replace the angular momenta. The kinetic energy, which the steps conserve, is half
    the product of the momentum before and the velocity after the pose. It is less than that of the mean velocity, and
    negative where a stiff contact reverses a motion. `h_before` is the length of the last step [s]."""
    kinetic, potential, share = 0.0, 0.0, 0.5 if h_before > 0 else 0.0
    for b in range(len(bodies)):
        body, recorded = bodies[b], samples.velocity[sample, b]
        after, d = read(body.velocity), len(body.place)
        velocity, momentum = components(recorded, after), spin_components(recorded[d:], after)
        change, momentum_change = minus(after, velocity), minus(momentum_of(body), momentum)
        velocity, change = plus(velocity, scaled(share, change)), scaled(1 - share, change)
        momentum, momentum_change = (
            in_body(body, plus(momentum, scaled(share, momentum_change))),
            in_body(body, scaled(1 - share, momentum_change)),
        )
        spin = apply_inverse_inertia(body, momentum)
        put(recorded, velocity)
        put(recorded[d:], spin)
        kinetic += 0.5 * body.mass * (dot(velocity, velocity) - dot(change, change))
        kinetic += 0.5 * (dot(momentum, spin) - dot(momentum_change, apply_inverse_inertia(body, momentum_change)))
        potential += GRAVITY * body.mass * body.place[d - 1]
    samples.energy[sample].kinetic = kinetic
    samples.energy[sample].potential += potential


@inlined
def is_astray(bodies: Rows, end_rotation: float) -> bool:
    """Whether a body has gone so far that the run has broken down, or has turned by more than a run follows."""
    for b in range(len(bodies)):
        body = bodies[b]
        for i in range(len(body.place)):
            if not abs(body.place[i]) < BROKEN_DOWN:
                return True
        if not rotation_within(body, end_rotation):
            return True
    return False


class Step(NamedTuple):
    """A step of a run.

    Args:
        t: when it begins [s].
        h_before: length of the step before [s].
        force_time: for how long its forces act on the velocities [s].
        sampled, checked: whether there is a sample, and a check of the energy, of its start.
        sample: number of the sample that is written, of one beyond the last where there is a check alone.
    """

    t: float
    h_before: float
    force_time: float
    sampled: bool
    checked: bool
    sample: int


@inlined
def step_of(clock: Clock, n: int, next_sample: int, samples: Samples) -> Step:
    """Step n, with the number of the next sample."""
    h_before = clock.h if n > 0 else clock.h_before
    sampled = n % clock.steps_per_sample == 0 or n == clock.last
    checked = n % clock.steps_per_check == 0 or n == clock.last
    sample = next_sample if sampled else len(samples.pose) - 1
    return Step(
        t=n * clock.h,
        h_before=h_before,
        force_time=0.5 * (h_before + clock.h),
        sampled=sampled,
        checked=checked,
        sample=sample,
    )


@inlined
def add_forces(system: System, books: Books, samples: Samples, clock: Clock, thread: Thread, step: Step) -> int:
    """Add all forces at the pose but rigid friction. Returns how many lines stick rigidly."""
    t, h, h_before = step.t, clock.h, step.h_before
    if thread.number == 0:
        move_supports(system.supports, t, h_before)
    mean = scaled(h / step.force_time, ground_acceleration(system.ground, t, h, read(system.bodies[0].place)))
    if t == 0:
        mean = plus(mean, scaled(0.5 * h_before / step.force_time, clock.ground_acceleration_before))
    for span in range(thread.own_bodies[0], thread.own_bodies[1]):
        start_forces(*bodies_of_span(system, books, thread, span), mean, h_before)
    wait(thread)
    if has_links(samples):
        if thread.number == 0:
            act_all(system.links, system, books, t, h_before)
            if step.sampled:
                record_guide_loads(system, samples, step.sample)
        wait(thread)
    press_by_laws(system.laws, system, books, thread, t, h_before)
    sticking = press_spans(system, books, thread, h_before, step.force_time, clock.steps_ahead)
    add_pending_forces(thread, books.pending, system.bodies)
    return sticking


@inlined
def has_links(samples: Samples) -> bool:
    """Whether there are links, whose forces are kept."""
    return bool(samples.link_forces.shape[1] > 0)


@inlined
def settle_step(system: System, books: Books, samples: Samples, step: Step, sticking: int, touched: int) -> None:
    """Finish the forces of a step, by one thread for all: rigid friction, touches and links."""
    energy, force_time = samples.energy[step.sample], step.force_time
    stick(system, books.active, sticking, force_time)
    stored_energy, put_in = settle_touches(system, books, touched, force_time)
    by_links, put_in_by_links = settle_all(system.links, system, books, force_time)
    energy.elastic += stored_energy + by_links
    energy.ground += put_in + put_in_by_links
    if samples.dashpots.shape[1] > 0 or len(system.supports.moved) > 0:
        rubbed, put_in = book_rubbing(system, books, sticking)
        if step.h_before > 0:  # halves that belong to the time before the pose
            energy.friction += rubbed
            energy.ground += put_in


@compiled_at_once
def advance(system: System, books: Books, samples: Samples, clock: Clock, thread: Thread) -> tuple[int, int, bool]:
    """Steps up to that before which to stop. Samples and checks are made at fixed numbers of steps, and at the last.

    Each thread of a run calls it. Returns the number of the next step and of the next sample, and
    whether the run has ended.
    """
    n, next_sample = clock.step, clock.sample
    first, last = thread.bodies[thread.own_bodies[0]], thread.bodies[thread.own_bodies[1]]
    own_bodies = system.bodies[first:last]
    while n < clock.stop:
        step = step_of(clock, n, next_sample, samples)
        sticking = add_forces(system, books, samples, clock, thread, step)
        touched = list_touched(books, thread)
        recorded = step.sampled or step.checked
        if recorded or clock.local_damping > 0:
            wait(thread)
            if thread.number == 0:
                if recorded:
                    record_pose(system, books, samples, step.sample, step.h_before)
                if clock.local_damping > 0:
                    damp_unbalanced(system, books, clock.local_damping, step.force_time)
            wait(thread)
        accelerate_bodies(own_bodies, step.force_time)
        if recorded or sticking > 0 or touched > 0 or clock.mass_damping > 0 or has_links(samples):
            wait(thread)
            if thread.number == 0:
                settle_step(system, books, samples, step, sticking, touched)
                if clock.mass_damping > 0:
                    damp_velocities(system, books, clock.mass_damping * step.force_time)
                if recorded:
                    record_velocity(system.bodies, samples, step.sample, step.h_before)
                if step.sampled:
                    record_forces(system, samples, step.sample)
                if step.checked:
                    samples.checks[-(-n // clock.steps_per_check)] = samples.energy[step.sample]
                if step.sampled and is_astray(system.bodies, clock.end_rotation):
                    end_all(thread)
            wait(thread)
        if step.sampled:
            next_sample += 1
            if has_ended(thread):
                return n, next_sample, True
        move_bodies(own_bodies, clock.h)
        n += 1
    return n, next_sample, False
