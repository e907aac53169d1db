"""The compiled loops around the engine's steps: of one length, and fitted to the motion.

A step that fits the motion is made in four moves: predict (which contacts will touch), change the step, let the engine
step, judge (how long the next may be). The rules are in modules of their own: `pace` (how long), `touches` (when),
`sticking` (where), `ground` (the force of the moving base). The loops call `mj_step` by its address and change
timestep, rows, friction and velocities in the memory of the engine.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..problem.quantities import ON_ITS_FACE, Array, Flags
from .contact import set_rows
from .ground import Ground, push
from .kinematics import Points, Ties, frame_of, stretch, take_frame
from .memory import IMPRATIO, TIMESTEP, Memory
from .pace import Pace, judged, resolves, while_loaded, while_taut
from .sliding import Sliding, find_acceleration, give_rows_back, slide, sliding_changed
from .steps import Record
from .sticking import Joints, deepest, put_back, sticks
from .touches import ABRUPT, FADED, Springs, closure_changed, follow, step_to_touch


class Progress(NamedTuple):
    """What one step hands to the next.

    Args:
        acceleration: in the last step, shape (3 n,).
        rate: its rate, from the last two steps, shape (3 n,).
        velocity_now, acceleration_now: room for the values at the time of the pose, shape (3 n,).
        frame, next_frame: frames of the pose before and after the step, shape (n, 4).
        motion: gap of each contact, slack of each tie, and their rates, see `touches.follow`, shape (m + t, 4).
        closed: which contacts are closed and which ties are taut, shape (m + t,).
        touch: room for the touches of a step, shape (m + t, 2).
        springs: of the contacts and the ties.
    """

    acceleration: Array
    rate: Array
    velocity_now: Array
    acceleration_now: Array
    frame: Array
    next_frame: Array
    motion: Array
    closed: Flags
    touch: Array
    springs: Springs

    @classmethod
    def of(cls, memory: Memory, springs: Springs) -> Progress:
        """The state before the first step."""
        n, touching = len(memory.pose), len(springs.k)
        return cls(
            acceleration=np.zeros(n),
            rate=np.zeros(n),
            velocity_now=np.zeros(n),
            acceleration_now=np.zeros(n),
            frame=frame_of(memory.pose),
            next_frame=frame_of(memory.pose),
            motion=np.zeros((touching, 4)),
            closed=np.zeros(touching, dtype=np.bool_),
            touch=np.zeros((touching, 2)),
            springs=springs,
        )


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
    """Whether a body lies on its face. A NaN counts."""
    for j in range(2, len(q), 3):  # noqa: SIM110, numba knows no any()
        if not abs(q[j]) <= ON_ITS_FACE:
            return True
    return False


@jitable
def apart(points: Points, motion: Array) -> bool:
    """Whether a contact has opened, or is overlapped, by more than a run follows."""
    for i in range(len(points.k)):  # noqa: SIM110, numba knows no any()
        if not -points.overlap <= motion[i, 0] <= points.reach:
            return True
    return False


@jitable
def present(memory: Memory, state: Progress, last: float) -> None:
    """Velocity and acceleration at the time of the pose, from the last step and its rate of change."""
    for j in range(len(state.rate)):
        state.acceleration_now[j] = state.acceleration[j] + state.rate[j] * last
        state.velocity_now[j] = memory.velocity[j] + 0.5 * last * state.acceleration_now[j]


@jitable
def shift_velocity(memory: Memory, state: Progress, now: float, last: float) -> None:
    """Move the velocity from half the last step before the pose to half a new one, by the acceleration in between."""
    late, lag = 0.5 * (now - last), last - 0.25 * (last + now)
    for j in range(len(state.rate)):
        memory.velocity[j] -= late * (state.acceleration[j] + lag * state.rate[j])


@jitable
def set_step(memory: Memory, points: Points, pace: Pace, now: float) -> None:
    """Set timestep, rows and friction for a step of another length."""
    kind = resolves(pace, now)
    memory.options[TIMESTEP] = now
    memory.options[IMPRATIO] = set_rows(
        points.k,
        points.c,
        points.weight,
        points.held,
        points.growth,
        now,
        pace.beta[kind],
        pace.ringing[kind],
        points.overdamped,
        memory.solref,
        memory.solimp,
        memory.solreffriction,
    )


@jitable
def release(
    memory: Memory, points: Points, ground: Ground, masses: Array, sliding: Sliding, frame: Array, velocity: Array
) -> None:
    """Set the velocity half the first step before the release, where the leapfrog keeps it.

    The ground is quiet before the release. The dashpots act on the velocity that is being set: this is a contraction,
    exact to rounding.
    """
    h = memory.options[TIMESTEP]
    for _ in range(10):
        find_acceleration(memory, points, ground, masses, sliding, frame, -h)
        for j in range(len(masses)):
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
def hold(memory: Memory, points: Points, pace: Pace, joints: Joints, state: Progress, record: Record, n: int) -> None:
    """Take the frame of the new pose, with sticking edges put back to where they stuck, after step n of the record."""
    h = record.h[n]
    kind = resolves(pace, h)
    take_frame(memory.pose, state.next_frame)
    for j in range(len(joints.body)):
        i = deepest(points, joints, j, state.next_frame)
        if i >= 0 and not sticks(
            points,
            i,
            state.frame,
            record.before[n],
            record.after[n],
            h,
            pace.beta[kind, i],
            pace.ringing[kind, i],
            memory.options[IMPRATIO],
        ):
            i = -1
        put_back(points, joints, j, i, state.frame, record.pose[n], memory.pose, state.next_frame)
    for body in range(len(state.frame)):
        copied(state.next_frame[body], state.frame[body])


@jitable
def make_step(
    memory: Memory,
    points: Points,
    ground: Ground,
    masses: Array,
    sliding: Sliding,
    frame: Array,
    record: Record,
    n: int,
    t: float,
    h: float,
) -> None:
    """Let the engine make a step, and record it as step n."""
    record.t[n], record.h[n] = t, h
    copied(memory.pose, record.pose[n])
    copied(memory.velocity, record.before[n])
    if slide(memory, points, ground, masses, sliding, frame, t):
        memory.finish(memory.model, memory.data)
        for i in range(len(points.k)):
            record.friction[n, i] = sliding.force[i] if sliding.slides[i] else math.nan
        give_rows_back(memory, points, sliding)
    else:
        push(ground, masses, t, h, memory.applied)
        memory.step(memory.model, memory.data)
        record.friction[n, :] = math.nan
    copied(memory.velocity, record.after[n])


@compiled
def fitted_loop(
    memory: Memory,
    points: Points,
    ties: Ties,
    masses: Array,
    ground: Ground,
    pace: Pace,
    joints: Joints,
    sliding: Sliding,
    state: Progress,
    clock: Clock,
    record: Record,
    duration: float,
) -> tuple[tuple[Any, ...], int]:
    """Steps that fit the motion until the record is full or the run is over.

    Returns the values of the clock, see `compiled`, and how many steps they were.
    """
    t, h, last, energy, calm, fresh, abrupt, touches, ended = clock
    n = 0
    if last == 0:
        set_step(memory, points, pace, h)
        find_acceleration(memory, points, ground, masses, sliding, state.frame, -h)
        copied(memory.acceleration, state.acceleration)
    while n < len(record.t) and not ended:
        present(memory, state, last)
        motion, v, a = state.motion, state.velocity_now, state.acceleration_now
        follow(points, ties, state.frame, v, a, motion)
        if closure_changed(motion, state.closed) and last > pace.short and not fresh:
            find_acceleration(memory, points, ground, masses, sliding, state.frame, t)
            copied(memory.acceleration, state.acceleration_now)
            follow(points, ties, state.frame, v, a, motion)
            h, calm, fresh = pace.short, 0, True

        # predict
        now = while_taut(pace, ties, motion, while_loaded(points, motion, h, pace.short))
        least = FADED * pace.accuracy * energy
        to_touch = 0.0 if abrupt else step_to_touch(state.springs, motion, now, h, least, pace.short, state.touch)
        if to_touch > 0:
            now = to_touch

        # step
        if last == 0:
            set_step(memory, points, pace, now)
            release(memory, points, ground, masses, sliding, state.frame, v)
            copied(memory.acceleration, state.acceleration)
        elif now != last:
            shift_velocity(memory, state, now, last)
            set_step(memory, points, pace, now)
        make_step(memory, points, ground, masses, sliding, state.frame, record, n, t, now)
        ended = t >= duration or fallen(record.pose[n]) or apart(points, motion)
        turned = sliding_changed(sliding)
        change = change_of_acceleration(memory, masses, state, last, now, fresh or turned) / energy
        abrupt = change > ABRUPT**2
        hold(memory, points, pace, joints, state, record, n)
        for i in range(len(ties.k)):
            stretch(ties, i, state.frame, memory.velocity)

        # judge
        t, last = t + now, now
        if to_touch > 0:
            energy = max(kinetic(masses, memory.velocity), pace.least_energy)
            touches += 1
            h, calm, fresh = pace.short, 0, True
        else:
            h, calm = judged(pace, now, math.inf if fresh else change, calm)
            fresh = False
        n += 1
    return (t, h, last, energy, calm, fresh, abrupt, touches, ended), n


@compiled
def fixed_loop(
    memory: Memory,
    points: Points,
    masses: Array,
    ground: Ground,
    sliding: Sliding,
    frame: Array,
    record: Record,
    first: int,
    h: float,
    last: int,
) -> tuple[bool, int]:
    """Steps of one length from number `first` until the record is full, number `last`, or a body lies on its face.

    Returns whether the run is over, and how many steps they were.
    """
    for n in range(len(record.t)):
        if sliding.coulomb:
            take_frame(memory.pose, frame)
        make_step(memory, points, ground, masses, sliding, frame, record, n, h * (first + n), h)
        if first + n >= last or fallen(record.pose[n]):
            return True, n + 1
    return False, len(record.t)
