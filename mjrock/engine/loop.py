"""The compiled loops around the engine's steps: of one length, and fitted to the motion.

A step that fits the motion is made in four moves: predict (which contacts will touch), change the step, let the engine
step, judge (how long the next may be). The rules are in modules of their own: `pace` (how long), `touches` (when),
`sticking` (where), `sliding` (friction), and `mjrock.scene.ground` (the force of the moving base). The loops call
`mj_step` by its address and change timestep, rows, friction and velocities in the memory of the engine.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..geometry.frames import frames_of, take_frames
from ..geometry.kinematics import stretch
from ..problem.quantities import ON_ITS_FACE, Array, Flags
from .memory import IMPRATIO, TIMESTEP, Memory
from .pace import Pace, judged, step_of, while_loaded, while_taut
from .points import Points, Reach
from .problem import Problem, push
from .rows import set_rows
from .sliding import Sliding, find_acceleration, give_rows_back, slide, sliding_changed
from .steps import Record
from .sticking import Joints, Moved, put_sticking_edges_back
from .touches import Openings, Springs, Touches, closure_changed, follow, step_to_touch


class Progress(NamedTuple):
    """What one step hands to the next.

    Args:
        acceleration: in the last step, shape (n nv,).
        rate: its rate, from the last two steps, shape (n nv,).
        velocity_now, acceleration_now: room for the values at the time of the pose, shape (n nv,).
        frames, next_frames: frames of the pose before and after the step.
        openings: gap of each contact, slack of each tie, and their rates.
        closed: which contacts are closed and which ties are taut, shape (m + t,).
        touches: room for the touches of a step.
        springs: of the contacts and the ties.
        joints: where sticking edges stuck.
        sliding: which contacts slide.
    """

    acceleration: Array
    rate: Array
    velocity_now: Array
    acceleration_now: Array
    frames: Array
    next_frames: Array
    openings: Openings
    closed: Flags
    touches: Touches
    springs: Springs
    joints: Joints
    sliding: Sliding

    @classmethod
    def of(cls, memory: Memory, problem: Problem, joints: Joints, sliding: Sliding) -> Progress:
        """The state before the first step."""
        springs, freedom = Springs.of(problem.points.law, problem.ties), problem.points.places.freedom
        frames = frames_of(memory.pose, freedom)
        closed = np.zeros(len(springs.k), dtype=np.bool_)
        acceleration, rate, velocity_now, acceleration_now = np.zeros((4, len(memory.velocity)))
        rates = acceleration, rate, velocity_now, acceleration_now
        touching = Openings.of(springs), closed, Touches.of(springs), springs
        return cls(*rates, frames, frames.copy(), *touching, joints, sliding)


class Clock(NamedTuple):
    """Where a run of fitted steps is.

    Args:
        t: time of the next pose [s].
        h: length of step that the pace allows [s].
        last: length of the last step, zero at the release [s].
        energy: twice the kinetic energy at the last touch [J], by which changes are measured.
        calm: how many steps in a row changed little.
        fresh: whether no rate of the acceleration is known: after a touch, and at the release.
        abrupt: whether the last step changed the velocity so much that it says nothing of the next.
        touches: how many touches have been met.
        ended: whether the run is over.
    """

    t: float
    h: float
    last: float
    energy: float
    calm: int
    fresh: bool
    abrupt: bool
    touches: int
    ended: bool

    @classmethod
    def started(cls, pace: Pace, energy: float) -> Clock:
        """At the release, with the energy of the release [J]."""
        return cls(0.0, pace.short, 0.0, max(2 * energy, pace.least_energy), 0, True, False, 0, False)


@jitable
def copied(values: Array, to: Array) -> None:
    """Copy values into another array."""
    for j in range(len(values)):
        to[j] = values[j]


@jitable
def kinetic(masses: Array, v: Array) -> float:
    """Twice the kinetic energy [J], or the same norm of any other rate."""
    total = 0.0
    for j in range(len(v)):
        total += masses[j] * v[j] * v[j]
    return total


@jitable
def fallen(q: Array) -> bool:
    """Whether a body of the plane lies on its face. A NaN counts."""
    for j in range(2, len(q), 3):  # noqa: SIM110, numba knows no any()
        if not abs(q[j]) <= ON_ITS_FACE:
            return True
    return False


@jitable
def out_of_reach(reach: Reach, openings: Openings) -> bool:
    """Whether a contact has opened, or is overlapped, by more than a run follows."""
    for i in range(len(reach.bears)):  # noqa: SIM110, numba knows no any()
        if not -reach.overlapped <= openings.value[i] <= reach.opened:
            return True
    return False


@jitable
def at_the_pose(memory: Memory, state: Progress, last: float) -> None:
    """Velocity and acceleration at the time of the pose, from the last step and its rate of change."""
    for j in range(len(state.rate)):
        state.acceleration_now[j] = state.acceleration[j] + state.rate[j] * last
        state.velocity_now[j] = memory.velocity[j] + 0.5 * last * state.acceleration_now[j]


@jitable
def acceleration_from_engine(memory: Memory, problem: Problem, state: Progress, t: float) -> None:
    """Acceleration at the time of the pose, found by the engine, where a contact has just opened or closed."""
    find_acceleration(memory, problem, state.sliding, state.frames, t)
    copied(memory.acceleration, state.acceleration_now)
    follow_now(problem, state)


@jitable
def follow_now(problem: Problem, state: Progress) -> None:
    """Bring gaps and slack up to date."""
    places, ties = problem.points.places, problem.ties
    follow(places, ties, state.frames, state.velocity_now, state.acceleration_now, state.openings)


@jitable
def shift_velocity(memory: Memory, state: Progress, now: float, last: float) -> None:
    """Move the velocity from half the last step before the pose to half a new one, by the acceleration in between."""
    late, lag = 0.5 * (now - last), last - 0.25 * (last + now)
    for j in range(len(state.rate)):
        memory.velocity[j] -= late * (state.acceleration[j] + lag * state.rate[j])


@jitable
def set_step(memory: Memory, points: Points, pace: Pace, now: float) -> None:
    """Set timestep, rows and friction for a step of another length."""
    memory.options[TIMESTEP] = now
    memory.options[IMPRATIO] = set_rows(points.law, points.inertia, step_of(pace, now), memory.rows)


@jitable
def release(memory: Memory, problem: Problem, sliding: Sliding, frames: Array, velocity: Array) -> None:
    """Set the velocity half the first step before the release, where the leapfrog keeps it.

    The ground is quiet before the release. The dashpots act on the velocity that is being set: this is a contraction,
    exact to rounding.
    """
    h = memory.options[TIMESTEP]
    for _ in range(10):
        find_acceleration(memory, problem, sliding, frames, -h)
        for j in range(len(velocity)):
            memory.velocity[j] = velocity[j] - 0.5 * h * memory.acceleration[j]


@jitable
def change_of_acceleration(
    memory: Memory, masses: Array, state: Progress, last: float, now: float, fresh: bool
) -> float:
    """(h |da|)^2 of the step just made; brings acceleration and rate up to date."""
    change = 0.0
    for j in range(len(masses)):
        difference = memory.acceleration[j] - state.acceleration[j]
        change += masses[j] * difference * difference
        state.rate[j] = 0.0 if fresh else difference / last
        state.acceleration[j] = memory.acceleration[j]
    return now * now * change


@jitable
def make_step(memory: Memory, problem: Problem, sliding: Sliding, frames: Array, record: Record, n: int) -> None:
    """Let the engine make step n of the record, whose time and length are set."""
    t = record.t[n]
    copied(memory.pose, record.pose[n])
    copied(memory.velocity, record.before[n])
    if slide(memory, problem, sliding, frames, t):
        memory.finish(memory.model, memory.data)
        for i in range(len(sliding.slides)):
            record.friction[n, i] = sliding.force[i] if sliding.slides[i] else math.nan
        give_rows_back(memory, sliding)
    else:
        push(memory, problem, t)
        memory.step(memory.model, memory.data)
        record.friction[n, :] = math.nan
    copied(memory.velocity, record.after[n])


@jitable
def settle_pose(memory: Memory, problem: Problem, pace: Pace, state: Progress, record: Record, n: int) -> None:
    """Put sticking edges back after step n of the record, take the frames of the new pose, and let ties yield."""
    moved = Moved(record.pose[n], state.frames, memory.pose, state.next_frames)
    put_sticking_edges_back(problem.points, pace, state.joints, record, n, moved, memory.options[IMPRATIO])
    for body in range(len(state.frames)):
        copied(state.next_frames[body], state.frames[body])
    for i in range(len(problem.ties.k)):
        stretch(problem.ties, i, state.frames, memory.velocity, problem.points.places.axes)


@jitable
def allowed_step(problem: Problem, pace: Pace, openings: Openings, h: float) -> float:
    """The step that the pace allows, shortened for loaded contacts and taut ties."""
    loaded = while_loaded(pace, problem.points.reach, openings, h)
    return while_taut(pace, problem.ties, openings, loaded)


@compiled
def fitted_loop(
    memory: Memory, problem: Problem, pace: Pace, state: Progress, clock: Clock, record: Record
) -> tuple[tuple[Any, ...], int]:
    """Steps that fit the motion until the record is full or the run is over.

    Returns the values of the clock, see `compiled`, and how many steps they were.
    """
    t, h, last, energy, calm, fresh, abrupt, touches, ended = clock
    points, openings, sliding, n = problem.points, state.openings, state.sliding, 0
    if last == 0:
        set_step(memory, points, pace, h)
        find_acceleration(memory, problem, sliding, state.frames, -h)
        copied(memory.acceleration, state.acceleration)
    while n < len(record.t) and not ended:
        at_the_pose(memory, state, last)
        follow_now(problem, state)
        if closure_changed(openings, state.closed) and last > pace.short and not fresh:
            acceleration_from_engine(memory, problem, state, t)
            h, calm, fresh = pace.short, 0, True

        # predict
        now = allowed_step(problem, pace, openings, h)
        least = pace.method.faded * pace.accuracy * energy
        to_touch = 0.0
        if not abrupt:
            to_touch = step_to_touch(state.springs, openings, now, h, least, pace.short, state.touches)
        if to_touch > 0:
            now = to_touch

        # step
        if last == 0:
            set_step(memory, points, pace, now)
            release(memory, problem, sliding, state.frames, state.velocity_now)
            copied(memory.acceleration, state.acceleration)
        elif now != last:
            shift_velocity(memory, state, now, last)
            set_step(memory, points, pace, now)
        record.t[n], record.h[n] = t, now
        make_step(memory, problem, sliding, state.frames, record, n)
        ended = t >= problem.duration or fallen(record.pose[n]) or out_of_reach(points.reach, openings)
        turned = sliding_changed(sliding)
        change = change_of_acceleration(memory, problem.masses, state, last, now, fresh or turned) / energy
        abrupt = change > pace.method.abrupt**2
        settle_pose(memory, problem, pace, state, record, n)

        # judge
        t, last = t + now, now
        if to_touch > 0:
            energy = max(kinetic(problem.masses, memory.velocity), pace.least_energy)
            touches += 1
            h, calm, fresh = pace.short, 0, True
        else:
            h, calm = judged(pace, now, math.inf if fresh else change, calm)
            fresh = False
        n += 1
    return (t, h, last, energy, calm, fresh, abrupt, touches, ended), n


@compiled
def fixed_loop(
    memory: Memory, problem: Problem, sliding: Sliding, frames: Array, record: Record, first: int, h: float
) -> tuple[bool, int]:
    """Steps of length h from number `first` until the record is full, the duration is over, or a body has fallen.

    Returns whether the run is over, and how many steps they were.
    """
    last = max(1, round(problem.duration / h))
    for n in range(len(record.t)):
        if sliding.coulomb:
            take_frames(memory.pose, frames, problem.points.places.axes)
        record.t[n], record.h[n] = h * (first + n), h
        make_step(memory, problem, sliding, frames, record, n)
        if first + n >= last or fallen(record.pose[n]):
            return True, n + 1
    return False, len(record.t)
