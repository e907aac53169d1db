"""The compiled loops around the engine's steps: of one length, and fitted to the motion.

A step that fits the motion is made in four parts: predict which contacts will touch, change the length of the step, let
the engine step, and find how long the next step may be. The rules are in modules of their own: `step_control` (length),
`touches` (their times), `sticking` (edges that friction holds), `sliding` (friction), and `mjrock.scene.course` (the
force of the moving base). The loops call `mj_step` by its address and change timestep, rows, friction and velocities in
the memory of the engine.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.frames import frames_of, take_frames
from ..geometry.kinematics import snaps, stretch
from ..quantities import ON_ITS_FACE, Array, Flags
from ..rows import Row, Rows, flags, integers, numbers, row_type, rows
from ..scene.course import Ground, mean_acceleration, push_along
from ..scene.masses import coupling
from .memory import IMPRATIO, TIMESTEP, EngineArrays
from .record import Record
from .rows import Points, set_rows
from .setting import Setting, push
from .sliding import (
    STAGE_VELOCITY,
    Sliding,
    any_slid,
    find_acceleration,
    give_rows_back,
    slide,
    sliding_changed,
    time_to_stop,
)
from .step_control import (
    StepControl,
    limited_by_approach,
    limited_by_loaded_contacts,
    limited_by_taut_ties,
    next_length,
    step_of,
)
from .sticking import Joints, StepMotion, put_sticking_edges_back
from .touches import Openings, Touches, closure_changed, follow_openings, step_to_break, step_to_touch


class GroundResponse(NamedTuple):
    """The ground in the last step, and the answer of the bodies. Directions are x, z, and y in space, as in `Ground`.

    The acceleration of the ground has a kink at every sample of its record, and bodies on stiff contacts answer to it
    at once. Extrapolated from the last steps it would be the largest error of a run. So the accelerations of the bodies
    are split, q'' = s + G a: a is the acceleration of the ground, whose mean over any time is known exactly, and s
    changes smoothly between touches. The engine itself gives G wherever the length of the step changes: contacts hold
    and let go as they do then, and the ground accelerates by one unit more. Accelerations of several bodies are not
    split, so that there is no direction then: where they slide and strike, their answer changes from step to step.

    Args:
        mean: mean acceleration of the ground over the window of the last step [m/s2], shape (2 or 3,).
        answer: acceleration of the bodies for a unit of it, G, shape (2 or 3, n nv); zero until it is found.
    """

    mean: Array
    answer: Array

    @classmethod
    def at_start(cls, setting: Setting) -> GroundResponse:
        """Before the first step."""
        directions = len(setting.points.places.axes) if setting.splits else 0
        return cls(np.zeros(directions), np.zeros((directions, len(setting.masses))))


@inlined
def find_answer(
    memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, ground_response: GroundResponse, t: float
) -> None:
    """Find how the bodies answer to the ground at the pose, with the step and the velocity that are set."""
    if not slide(memory, setting, sliding, frames, t):
        push(memory, setting, frames, t)
        memory.forward(memory.model, memory.data)
    for d in range(len(ground_response.mean)):
        for j in range(len(memory.acceleration)):
            ground_response.answer[d, j] = -memory.acceleration[j]
    axes, masses = setting.points.places.axes, setting.masses
    for d in range(len(ground_response.mean)):
        if len(setting.ground[d].accel) > 0:
            push_along(d, 1.0, masses, axes, memory.applied)
            memory.accelerate(memory.model, memory.data, STAGE_VELOCITY, 1)
            push_along(d, -1.0, masses, axes, memory.applied)
            for j in range(len(memory.acceleration)):
                ground_response.answer[d, j] += memory.acceleration[j]
    give_rows_back(memory, sliding)


@inlined
def add_change(ground_response: GroundResponse, ground: Ground, t: float, h: float, weight: float, to: Array) -> None:
    """Add to `to` the weight times the answer of the bodies to the change of the ground.

    It is the change of the mean acceleration of the ground, from the window of the last step to a time h [s] around
    t [s].
    """
    for d in range(len(ground_response.mean)):
        if len(ground[d].accel) > 0:
            change = mean_acceleration(ground[d], t, h) - ground_response.mean[d]
            for j in range(len(to)):
                to[j] += weight * change * ground_response.answer[d, j]


@inlined
def set_mean(ground_response: GroundResponse, ground: Ground, t: float, h: float) -> None:
    """Take the mean acceleration of the ground over the window of a step h [s] at t [s]."""
    for d in range(len(ground_response.mean)):
        ground_response.mean[d] = mean_acceleration(ground[d], t, h)


LYING = math.sin(0.5 * ON_ITS_FACE) ** 2
"""x^2 + y^2 of the quaternion of a body of space whose axis that stood at rest lies on the ground [-]."""
SLACK_OF_BROKEN = 1e9
"""Length up to which a tie that has broken is slack [m]."""


class Progress(NamedTuple):
    """The state of a run that one step hands to the next, and room for what a step computes.

    Args:
        acceleration: in the last step, shape (n nv,).
        rate: its rate, from the last two steps, shape (n nv,).
        change: room for the change of the acceleration in a step, shape (n nv,).
        velocity_now, acceleration_now: room for the values at the time of the pose, shape (n nv,).
        frames, next_frames: frames of the pose before and after the step.
        openings: gap of each contact, slack of each tie, and their rates.
        closed: which contacts are closed and which ties are taut, shape (m + t,).
        touches: room for the touches of a step.
        joints: where sticking edges stuck.
        sliding: which contacts slide.
        ground_response: the ground in the last step, and how the bodies answer to it.
    """

    acceleration: Array
    rate: Array
    change: Array
    velocity_now: Array
    acceleration_now: Array
    frames: Array
    next_frames: Array
    openings: Openings
    closed: Flags
    touches: Touches
    joints: Joints
    sliding: Sliding
    ground_response: GroundResponse

    @classmethod
    def at_start(cls, memory: EngineArrays, setting: Setting, joints: Joints, sliding: Sliding) -> Progress:
        """The state before the first step."""
        places = setting.points.places
        frames, touches = frames_of(memory.pose, places.freedom), Touches.with_room(places, setting.ties)
        rates = ("acceleration", "rate", "change", "velocity_now", "acceleration_now")
        return cls(
            **{name: np.zeros(len(memory.velocity)) for name in rates},
            frames=frames,
            next_frames=frames.copy(),
            openings=Openings.with_room(len(touches.k)),
            closed=np.zeros(len(touches.k), dtype=np.bool_),
            touches=touches,
            joints=joints,
            sliding=sliding,
            ground_response=GroundResponse.at_start(setting),
        )


class StepTimes(NamedTuple):
    """A step about a pose: time of the pose, and lengths of the step and of the one before, 0 at the release [s]."""

    t: float
    length: float
    previous: float


CLOCK = row_type(
    [
        *numbers("t"),  # time of the next pose [s]
        *numbers("allowed"),  # length of step that the step control allows [s]
        *numbers("previous"),  # length of the last step, zero at the release [s]
        *numbers("energy"),  # twice the kinetic energy at the last touch [J], a measure of changes, see `Method.faster`
        *integers("calm_steps"),  # how many steps in a row changed little
        *integers("touches"),  # how many touches have been met
        *integers("steps"),  # how many steps the last call of the loop has made
        *flags("no_rate"),  # whether no rate of the acceleration is known: after a touch, and at the release
        *flags("unpredictable"),  # whether the last step changed the velocity too much for it to predict the next
        *flags("ended"),  # whether the run is over
    ]
)
"""Where a run of fitted steps is."""


def clock_at_start(control: StepControl, energy: float) -> Rows:
    """The one row of `CLOCK` at the release, with the energy of the release [J]."""
    largest = max(2 * energy, control.least_energy)
    return rows(CLOCK, 1, allowed=control.short, energy=largest, no_rate=True)


@inlined
def copy_into(values: Array, to: Array) -> None:
    """Copy values into another array."""
    for j in range(len(values)):
        to[j] = values[j]


@inlined
def mass_square(masses: Array, products: Array, v: Array) -> float:
    """Square of rates weighted with the masses: of velocities twice the kinetic energy [J]."""
    total = 0.0
    for j in range(len(v)):
        total += masses[j] * v[j] * v[j]
    return total + coupling(products, v) if len(products) > 0 else total


@inlined
def lies_on_its_face(q: Array, axes: tuple[int, ...]) -> bool:
    """Whether a body lies on its face. A NaN counts."""
    if len(axes) == 2:
        for j in range(2, len(q), 3):
            if not abs(q[j]) <= ON_ITS_FACE:
                return True
    else:
        for j in range(4, len(q), 7):
            if not q[j] * q[j] + q[j + 1] * q[j + 1] <= LYING:
                return True
    return False


@inlined
def out_of_reach(points: Points, openings: Openings) -> bool:
    """Whether a contact has opened, or is overlapped, by more than a run follows."""
    for i in range(len(points.bears)):  # noqa: SIM110, numba knows no any()
        if not -points.overlapped <= openings.value[i] <= points.opened:
            return True
    return False


@inlined
def update_rates(memory: EngineArrays, setting: Setting, state: Progress, t: float, previous: float) -> None:
    """Velocity at the time of the pose, and acceleration after it, from the last step and its rate of change; gaps and
    slack."""
    for j in range(len(state.rate)):
        state.acceleration_now[j] = state.acceleration[j] + state.rate[j] * previous
        state.velocity_now[j] = memory.velocity[j] + 0.5 * previous * state.acceleration_now[j]
    if previous > 0:
        half = 0.5 * previous
        add_change(state.ground_response, setting.ground, t - 0.5 * half, half, half, state.velocity_now)
        add_change(state.ground_response, setting.ground, t + half, previous, 1.0, state.acceleration_now)
    update_openings(setting, state)


@inlined
def take_acceleration(memory: EngineArrays, setting: Setting, state: Progress, t: float) -> None:
    """Acceleration at the time of the pose, found by the engine, where a contact has just opened or closed."""
    find_acceleration(memory, setting, state.sliding, state.frames, t)
    copy_into(memory.acceleration, state.acceleration_now)
    update_openings(setting, state)


@inlined
def update_openings(setting: Setting, state: Progress) -> None:
    """Bring gaps and slack up to date."""
    places, ties = setting.points.places, setting.ties
    follow_openings(places, ties, state.frames, state.velocity_now, state.acceleration_now, state.openings)


@inlined
def shift_velocity(memory: EngineArrays, setting: Setting, state: Progress, times: StepTimes) -> None:
    """Move the velocity from half the last step before the pose to half a new one, by the acceleration in between."""
    t, step, previous = times
    if setting.splits:
        find_answer(memory, setting, state.sliding, state.frames, state.ground_response, t)
    late, middle = 0.5 * (step - previous), 0.25 * (previous + step)
    for j in range(len(state.rate)):
        memory.velocity[j] -= late * (state.acceleration[j] + (previous - middle) * state.rate[j])
    add_change(state.ground_response, setting.ground, t - middle, abs(late), -late, memory.velocity)


@inlined
def set_step(memory: EngineArrays, points: Points, control: StepControl, step: float) -> None:
    """Set timestep, rows and friction for a step of another length."""
    memory.options[TIMESTEP] = step
    memory.options[IMPRATIO] = set_rows(points, step_of(control, step), memory.rows)


@inlined
def take_first_acceleration(memory: EngineArrays, setting: Setting, state: Progress, step: float) -> None:
    """Acceleration on the ground that is quiet before the release."""
    find_acceleration(memory, setting, state.sliding, state.frames, -step)
    copy_into(memory.acceleration, state.acceleration)


@inlined
def release(memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, velocity: Array) -> None:
    """Set the velocity half the first step before the release, where the leapfrog keeps it.

    The ground is quiet before the release. The dashpots act on the velocity that is being set: this is a contraction,
    exact to rounding.
    """
    h = memory.options[TIMESTEP]
    for _ in range(10):
        find_acceleration(memory, setting, sliding, frames, -h)
        for j in range(len(velocity)):
            memory.velocity[j] = velocity[j] - 0.5 * h * memory.acceleration[j]


@inlined
def change_of_acceleration(
    memory: EngineArrays, setting: Setting, state: Progress, times: StepTimes, no_rate: bool
) -> float:
    """(h |da|)^2 of the step just made [J], which brings acceleration and rate up to date.

    The answer of the bodies to the ground counts only where a contact slides, since friction turns with it.
    """
    t, step, previous = times
    for j in range(len(state.change)):
        state.change[j] = memory.acceleration[j] - state.acceleration[j]
        state.acceleration[j] = memory.acceleration[j]
    slid = any_slid(state.sliding)
    square = mass_square(setting.masses, setting.products, state.change) if slid else 0.0
    add_change(state.ground_response, setting.ground, t, step, -1.0, state.change)
    set_mean(state.ground_response, setting.ground, t, step)
    for j in range(len(state.change)):
        state.rate[j] = 0.0 if no_rate else state.change[j] / previous
    if not slid:
        square = mass_square(setting.masses, setting.products, state.change)
    return step * step * square


@inlined
def make_step(memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, record: Record, n: int) -> None:
    """Let the engine make step n of the record, whose time and length are set."""
    t = record.t[n]
    copy_into(memory.pose, record.pose[n])
    copy_into(memory.velocity, record.before[n])
    if slide(memory, setting, sliding, frames, t):
        memory.finish(memory.model, memory.data)
        for i in range(len(sliding.slides)):
            record.friction[n, i] = sliding.force[i] if sliding.slides[i] else math.nan
        give_rows_back(memory, sliding)
    else:
        push(memory, setting, frames, t)
        memory.step(memory.model, memory.data)
        record.friction[n, :] = math.nan
    copy_into(setting.damping, record.damping[n])
    copy_into(memory.velocity, record.after[n])


@inlined
def settle_pose(
    memory: EngineArrays, setting: Setting, control: StepControl, state: Progress, record: Record, n: int
) -> None:
    """Put sticking edges back after step n of the record, take frames of the new pose, and let ties yield and break."""
    motion = StepMotion(
        step=step_of(control, record.h[n]),
        impratio=memory.options[IMPRATIO],
        before=record.before[n],
        after=record.after[n],
        from_pose=record.pose[n],
        pose=memory.pose,
        from_frames=state.frames,
        frames=state.next_frames,
    )
    put_sticking_edges_back(setting.points, state.joints, motion)
    for body in range(len(state.frames)):
        copy_into(state.next_frames[body], state.frames[body])
    settle_ties(memory, setting, state.frames)


@inlined
def settle_ties(memory: EngineArrays, setting: Setting, frames: Array) -> None:
    """Let ties yield and break at a pose. For the engine, one that has broken is slack up to any length."""
    for i in range(len(setting.ties.k)):
        if snaps(setting.ties, i, frames, memory.velocity):
            memory.plastic[memory.upper[i]] = SLACK_OF_BROKEN
        stretch(setting.ties, i, frames, memory.velocity)


@inlined
def allowed_step(setting: Setting, control: StepControl, openings: Openings, h: float) -> float:
    """The step that the step control allows, shortened for loaded contacts and taut ties."""
    loaded = limited_by_loaded_contacts(control, setting.points, openings, h)
    return limited_by_taut_ties(control, setting.ties, openings, loaded)


@inlined
def step_to_event(
    setting: Setting, control: StepControl, state: Progress, step: float, allowed: float, least: float
) -> tuple[float, float]:
    """The step as long as the motion can be predicted, and the step to a touch or to a tie that breaks in it [s].

    The second is zero where there is none. Touches of less than the energy `least` [J] do not count.
    """
    method, openings = control.method, state.openings
    ahead = step / method.approach if setting.splits else step
    to_touch = step_to_touch(state.touches, openings, ahead, allowed, least, control.short)
    if setting.splits:
        places = setting.points.places
        stop = time_to_stop(places, state.sliding, state.frames, state.velocity_now, state.acceleration_now)
        step = min(step, max(method.approach * stop, control.short))
        step, to_touch = limited_by_approach(control, step, to_touch)
    to_break = step_to_break(setting.ties, openings, step, control.short)
    if to_break > 0 and not 0 < to_touch < to_break:
        to_touch = to_break
    return step, to_touch


@inlined
def forget_rate(control: StepControl, clock: Row) -> None:
    """Go on with short steps, the first of which knows no rate of the acceleration."""
    clock.allowed, clock.calm_steps, clock.no_rate = control.short, 0, True


@compiled
def fitted_loop(
    memory: EngineArrays, setting: Setting, control: StepControl, state: Progress, clocks: Rows, record: Record
) -> None:
    """Steps that fit the motion until the record is full or the run is over.

    `clocks` has the row of `CLOCK` that is read and written.
    """
    clock, points, openings, sliding = clocks[0], setting.points, state.openings, state.sliding
    axes, method = points.places.axes, control.method
    clock.steps = 0
    if clock.previous == 0:
        set_step(memory, points, control, clock.allowed)
        take_first_acceleration(memory, setting, state, clock.allowed)
    while clock.steps < len(record.t) and not clock.ended:
        n, t, previous = clock.steps, clock.t, clock.previous
        update_rates(memory, setting, state, t, previous)
        if closure_changed(points.places, openings, state.closed) and previous > control.short and not clock.no_rate:
            take_acceleration(memory, setting, state, t)
            forget_rate(control, clock)

        # predict
        step, to_touch = allowed_step(setting, control, openings, clock.allowed), 0.0
        if not clock.unpredictable:
            least = method.faded * control.accuracy * clock.energy
            step, to_touch = step_to_event(setting, control, state, step, clock.allowed, least)
        if to_touch > 0:
            step = to_touch

        # step
        times = StepTimes(t, step, previous)
        if previous == 0:
            set_step(memory, points, control, step)
            release(memory, setting, sliding, state.frames, state.velocity_now)
            copy_into(memory.acceleration, state.acceleration)
        elif step != previous:
            shift_velocity(memory, setting, state, times)
            set_step(memory, points, control, step)
        record.t[n], record.h[n] = t, step
        make_step(memory, setting, sliding, state.frames, record, n)
        clock.ended = t >= setting.duration or lies_on_its_face(record.pose[n], axes) or out_of_reach(points, openings)
        sliding_turned = sliding_changed(sliding)
        change = change_of_acceleration(memory, setting, state, times, clock.no_rate or sliding_turned)
        twice_kinetic = mass_square(setting.masses, setting.products, memory.velocity)
        change /= max(clock.energy, method.faster * twice_kinetic)
        clock.unpredictable = change > method.abrupt * method.abrupt
        settle_pose(memory, setting, control, state, record, n)

        # length of the next step
        clock.t, clock.previous, clock.steps = t + step, step, n + 1
        if to_touch > 0:
            clock.energy = max(twice_kinetic, control.least_energy)
            clock.touches += 1
            forget_rate(control, clock)
        else:
            change = math.inf if clock.no_rate else change
            clock.allowed, clock.calm_steps = next_length(control, step, change, clock.calm_steps)
            clock.no_rate = False


@compiled
def fixed_loop(
    memory: EngineArrays, setting: Setting, sliding: Sliding, frames: Array, record: Record, first: int
) -> tuple[bool, int]:
    """Steps of the length that is set, from number `first` until the record is full, the duration is over, or a body
    has fallen.

    Returns whether the run is over, and how many steps they were.
    """
    h = memory.options[TIMESTEP]
    last = max(1, round(setting.duration / h))
    for n in range(len(record.t)):
        if sliding.coulomb or len(setting.dampers.law) > 0:
            take_frames(memory.pose, frames, setting.points.places.axes)
        record.t[n], record.h[n] = h * (first + n), h
        make_step(memory, setting, sliding, frames, record, n)
        if first + n >= last or lies_on_its_face(record.pose[n], setting.points.places.axes):
            return True, n + 1
    return False, len(record.t)
