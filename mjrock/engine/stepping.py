"""Steps of MuJoCo: of one length, or fitted to the motion so that every touch is centred in time.

A wall rocks smoothly for a second and then hits something for milliseconds. `fitted_steps` takes long steps while
nothing new touches, lands half a short step behind every touch, and goes on in short steps until the contacts have died
down. The
rules are in modules of their own: `pace` (how long), `touches` (when), `sticking` (where), `ground` (the force of the
moving base). The loops are compiled. They call `mj_step` by its address and change timestep, rows, friction and
velocities in the memory of the engine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np
from tqdm import tqdm

from ..compiled import compiled, jitable
from ..problem.quantities import ON_ITS_FACE, Array, Flags, Integers
from .contact import set_rows
from .ground import Ground, push
from .kinematics import Points, frame_of, take_frame
from .memory import IMPRATIO, TIMESTEP, Memory
from .model import Engine
from .pace import SMOOTH, Pace, judged, resolves, while_loaded
from .scene import Scene
from .sticking import Joints, put_back, sticks
from .touches import closure_changed, step_to_touch

CHUNK = 4_000
"""Steps between two looks at the run from Python: progress, warnings of the engine, an interruption by the user."""


class StepError(RuntimeError):
    """The engine warned, or the state is no longer finite, at the time given [s]."""

    def __init__(self, what: str, t: float) -> None:
        super().__init__(what)
        self.t = t


@dataclass(frozen=True)
class Steps:
    """What the engine did: the poses at each step, and the velocities half a step before and after it.

    Args:
        t: times [s], shape (steps,).
        h: step lengths [s], shape (steps,).
        pose: x, z, theta of each body [m, m, rad], shape (steps, 3 n).
        before, after: velocities at t - h/2 and t + h/2 [m/s, m/s, rad/s], shape (steps, 3 n).
        beta: Newmark's beta of each contact [-], in the two kinds of steps, shape (2, m).
        ringing: the extra dashpots of each contact in units of h k [-], shape (2, m).
        kind: which of the two each step is, shape (steps,).
        touches: how many touches were met with a short step.
    """

    t: Array
    h: Array
    pose: Array
    before: Array
    after: Array
    beta: Array
    ringing: Array
    kind: Integers
    touches: int = 0

    @property
    def velocity(self) -> Array:
        """Velocities at the times of the poses, shape (steps, 3 n)."""
        velocity: Array = 0.5 * (self.before + self.after)
        return velocity

    @property
    def seams(self) -> Array:
        """Starts of the leapfrog's windows, half a step before the poses [s], shape (steps,)."""
        return self.t - 0.5 * self.h

    @property
    def widths(self) -> Array:
        """Lengths of the windows, from seam to seam, zero for the last [s], shape (steps,)."""
        return np.append(np.diff(self.seams), 0.0)


class Record(NamedTuple):
    """Room for the steps of a chunk, and the acceleration of the last of them."""

    t: Array
    h: Array
    pose: Array
    before: Array
    after: Array

    @classmethod
    def of(cls, steps: int, coordinates: int) -> Record:
        """Room for a number of steps."""
        return cls(*(np.empty(steps) for _ in "th"), *(np.empty((steps, coordinates)) for _ in "pba"))


class State(NamedTuple):
    """What one step hands to the next.

    Args:
        acceleration: in the last step, shape (3 n,).
        rate: its rate, from the last two steps, shape (3 n,).
        velocity_now, acceleration_now: room for the values at the time of the pose, shape (3 n,).
        none: zeros, shape (3 n,).
        frame: frame of the pose, shape (n, 4).
        closed: which contacts are closed, shape (m,).
        sticking: which contacts stuck in the last step, shape (m,).
        touch: room for the touches of a step, shape (m, 2).
    """

    acceleration: Array
    rate: Array
    velocity_now: Array
    acceleration_now: Array
    none: Array
    frame: Array
    closed: Flags
    sticking: Flags
    touch: Array

    @classmethod
    def of(cls, engine: Engine, scene: Scene) -> State:
        """The state at the release."""
        n, m = 3 * len(scene.names), len(scene.k)
        return cls(
            acceleration=np.array(engine.memory.acceleration),
            rate=np.zeros(n),
            velocity_now=np.zeros(n),
            acceleration_now=np.zeros(n),
            none=np.zeros(n),
            frame=frame_of(engine.memory.pose),
            closed=np.zeros(m, dtype=np.bool_),
            sticking=np.zeros(m, dtype=np.bool_),
            touch=np.zeros((m, 2)),
        )


class Clock(NamedTuple):
    """Where a run of fitted steps is.

    Args:
        t: time of the next pose [s].
        h: length of step that the pace allows [s].
        last: length of the last step [s].
        energy: twice the kinetic energy at the last touch [J], by which changes are measured.
        calm: how many steps in a row changed little.
        fresh: whether the last step says nothing of the next: after a touch, and at the release.
        touches: how many touches have been met.
        ended: whether the run is over.
    """

    t: float
    h: float
    last: float
    energy: float
    calm: int
    fresh: bool
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
def present(memory: Memory, state: State, last: float) -> None:
    """Velocity and acceleration at the time of the pose, from the last step and its rate of change."""
    for j in range(len(state.rate)):
        state.acceleration_now[j] = state.acceleration[j] + state.rate[j] * last
        state.velocity_now[j] = memory.velocity[j] + 0.5 * last * state.acceleration_now[j]


@jitable
def change_step(memory: Memory, points: Points, pace: Pace, state: State, now: float, last: float) -> None:
    """Set timestep, rows and friction for a step of another length.

    The velocity lies half a step before the pose. It moves to half a new step before it, with the acceleration in
    between.
    """
    late, lag = 0.5 * (now - last), last - 0.25 * (last + now)
    for j in range(len(state.rate)):
        memory.velocity[j] -= late * (state.acceleration[j] + lag * state.rate[j])
    kind = resolves(pace, now)
    memory.options[TIMESTEP] = now
    memory.options[IMPRATIO] = set_rows(
        points.k,
        points.c,
        points.weight,
        points.held,
        now,
        pace.beta[kind],
        pace.ringing[kind],
        memory.solref,
        memory.solimp,
        memory.solreffriction,
    )


@jitable
def look_again(memory: Memory, ground: Ground, masses: Array, state: State, t: float, short: float) -> None:
    """Take the acceleration from the engine where a contact has opened or closed unforeseen in a long step."""
    push(ground, masses, t, short, memory.applied)
    memory.forward(memory.model, memory.data)
    copied(memory.acceleration, state.acceleration_now)


@jitable
def change_of_acceleration(memory: Memory, masses: Array, state: State, last: float, now: float, fresh: bool) -> float:
    """(h |da|)^2 of the step just made, infinite after a fresh start; brings acceleration and rate up to date."""
    change = 0.0
    for j in range(len(masses)):
        difference = memory.acceleration[j] - state.acceleration[j]
        change += masses[j] * difference * difference
        state.rate[j] = 0.0 if fresh else difference / last
        state.acceleration[j] = memory.acceleration[j]
    return math.inf if fresh else now * now * change


@jitable
def hold(memory: Memory, points: Points, pace: Pace, joints: Joints, state: State, record: Record, n: int) -> None:
    """Take the frame of the new pose, with sticking edges put back to where they stuck, after step n of the record."""
    h = record.h[n]
    kind = resolves(pace, h)
    for i in range(len(points.k)):
        if joints.of[i] >= 0:
            state.sticking[i] = sticks(
                points,
                i,
                state.frame,
                record.before[n],
                record.after[n],
                h,
                pace.beta[kind, i],
                pace.ringing[kind, i],
                memory.options[IMPRATIO],
            )
    take_frame(memory.pose, state.frame)
    put_back(points, joints, memory.pose, state.frame, state.sticking)


@jitable
def make_step(memory: Memory, ground: Ground, masses: Array, record: Record, n: int, t: float, h: float) -> None:
    """Let the engine make a step, and record it as step n."""
    push(ground, masses, t, h, memory.applied)
    record.t[n], record.h[n] = t, h
    copied(memory.pose, record.pose[n])
    copied(memory.velocity, record.before[n])
    memory.step(memory.model, memory.data)
    copied(memory.velocity, record.after[n])


@compiled
def fitted_loop(
    memory: Memory,
    points: Points,
    masses: Array,
    ground: Ground,
    pace: Pace,
    joints: Joints,
    state: State,
    clock: Clock,
    record: Record,
    duration: float,
) -> tuple[Clock, int]:
    """Steps that fit the motion until the record is full or the run is over; the clock, and how many they were."""
    t, h, last, energy, calm, fresh, touches, ended = clock
    n = 0
    while n < len(record.t) and not ended:
        present(memory, state, last)
        if closure_changed(points, state.frame, state.closed) and last > pace.short and not fresh:
            look_again(memory, ground, masses, state, t, pace.short)
            h, calm, fresh = pace.short, 0, True

        # predict
        v, a = state.velocity_now, state.acceleration_now
        now = while_loaded(points, state.frame, v, state.none, h, pace.short)
        to_touch = step_to_touch(points, state.frame, v, a, now, h, energy, pace, state.touch)
        if to_touch > 0:
            now = to_touch

        # step
        if now != last:
            change_step(memory, points, pace, state, now, last)
        make_step(memory, ground, masses, record, n, t, now)
        ended = t >= duration or fallen(record.pose[n])
        change = change_of_acceleration(memory, masses, state, last, now, fresh) / energy
        hold(memory, points, pace, joints, state, record, n)

        # judge
        t, last, fresh = t + now, now, False
        if to_touch > 0:
            energy = max(kinetic(masses, memory.velocity), pace.least_energy)
            touches += 1
            h, calm, fresh = pace.short, 0, True
        else:
            h, calm = judged(pace, h, change, calm)
        n += 1
    return Clock(t, h, last, energy, calm, fresh, touches, ended), n


@compiled
def fixed_loop(
    memory: Memory, masses: Array, ground: Ground, record: Record, first: int, h: float, last: int
) -> tuple[bool, int]:
    """Steps of one length from number `first` until the record is full, number `last`, or a body lies on its face.

    Returns whether the run is over, and how many steps they were.
    """
    for n in range(len(record.t)):
        make_step(memory, ground, masses, record, n, h * (first + n), h)
        if first + n >= last or fallen(record.pose[n]):
            return True, n + 1
    return False, len(record.t)


def fitted_steps(engine: Engine, scene: Scene, accuracy: float) -> Steps:
    """Steps that fit the motion, until the duration of the scene or until a body lies on its face.

    The engine has to be at the release, with the step and the rows of `Pace.short`.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    pace, memory, masses = Pace.of(scene, accuracy), engine.memory, scene.masses
    points, ground, joints, state = (
        scene.points,
        Ground.of(scene.motion),
        Joints.of_scene(scene),
        State.of(engine, scene),
    )
    energy = max(2 * scene.release_energy, pace.least_energy)
    clock = Clock(0.0, pace.short, pace.short, energy, 0, True, 0, False)
    record, chunks = Record.of(CHUNK, len(masses)), []
    with tqdm(total=scene.duration, desc="MuJoCo", unit="s", delay=3, disable=None, leave=False) as bar:
        while not clock.ended:
            clock, n = fitted_loop(memory, points, masses, ground, pace, joints, state, clock, record, scene.duration)
            chunks.append([values[:n].copy() for values in record])
            bar.update(min(clock.t, scene.duration) - bar.n)
            _check(engine.data, clock.t)
    t, h, pose, before, after = (np.concatenate(values) for values in zip(*chunks, strict=True))
    kind = (h * pace.frequency >= SMOOTH).astype(int)
    return Steps(t, h, pose, before, after, pace.beta, pace.ringing, kind, clock.touches)


def fixed_steps(engine: Engine, scene: Scene, timestep: float, newmark_beta: float) -> Steps:
    """Steps of one length, until the duration of the scene or until a body lies on its face.

    The engine has to be at the release, with the step and the rows of that length.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    last = max(1, round(scene.duration / timestep))
    ground, record, chunks = Ground.of(scene.motion), Record.of(min(CHUNK, last + 1), len(scene.masses)), []
    done, ended = 0, False
    with tqdm(total=scene.duration, desc="MuJoCo", unit="s", delay=3, disable=None, leave=False) as bar:
        while not ended:
            ended, n = fixed_loop(engine.memory, scene.masses, ground, record, done, timestep, last)
            chunks.append([values[:n].copy() for values in record])
            done += n
            bar.update(min(done * timestep, scene.duration) - bar.n)
            _check(engine.data, done * timestep)
    t, h, pose, before, after = (np.concatenate(values) for values in zip(*chunks, strict=True))
    m = len(scene.k)
    beta, none = np.full((2, m), newmark_beta), np.zeros((2, m))
    return Steps(t, h, pose, before, after, beta, none, np.zeros(len(t), dtype=int))


def _check(data: mujoco.MjData, t: float) -> None:
    warned = [mujoco.mjtWarning(i).name for i in np.flatnonzero(data.warning.number)]
    if warned or not (np.isfinite(data.qpos).all() and np.isfinite(data.qvel).all()):
        raise StepError(f"MuJoCo warned ({', '.join(warned)})" if warned else "the state is not finite", t)
