"""Steps of MuJoCo: of one length, or fitted to the motion so that every touch is centred in time.

A wall rocks smoothly for a second and then hits something for milliseconds. `fitted_steps` takes long steps while
nothing new touches, lands half a short step behind every touch, so that the touch is the start of the leapfrog window
in which the new contact first acts, and goes on in short steps until the contacts have died down. Contact rows,
friction and the velocity, which the leapfrog keeps half a step back, follow every change of the step.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import overload

import mujoco
import numpy as np
from mujoco import rollout
from numpy.typing import NDArray
from tqdm import tqdm

from .case import ON_ITS_FACE, Case
from .contact import OVERDAMPED, impedance, most_inertia, row_terms
from .interface import Contacts
from .mjcf import HELD_MASSES, inverse_weight

Array = NDArray[np.float64]
CHUNK = 4_000
"""Fixed steps between two looks at the wall: whether it has overturned, whether MuJoCo has warned."""

SHORT = 24.0
"""(omega h)^2 of a short step over the accuracy, omega the highest contact frequency: Newmark's period error is
(omega h)^2 / 24 for beta = 0 and less for beta = 1/12, which short steps use."""
DASHPOT = 12.0
"""(c h / m)^2 of a short step over the accuracy, m = 1 / (6 W) the least mass that a contact may feel: the error of a
dashpot centred in the step is (c h / m)^2 / 12."""
LONG = 0.6
"""(p h)^2 of the longest step over the accuracy, p the frequency parameter of the rocking."""
CHANGE = 1.5
"""Change of acceleration in a step, times the step, that is tolerated: over the accuracy and the speed of the wall."""
FADED = 0.01
"""A touch is met with a short step where ignoring it would misplace this much energy, over accuracy and energy."""
SMOOTH = 1.5
"""omega h below which a step resolves the contacts and takes Newmark's beta = 1/12 (stable below 2.45). Above it the
closed contacts are as good as at rest: beta = 1/4 is stable there, but lets what is left ring on from step to step."""
RINGING = (0.1, 1.0)
"""Damping of that ringing at base and side, an extra dashpot h k r with beta = (1 + r^2)/4. At the base it loses a
third of its energy in a step, and the rocking next to nothing. A side stop only ever carries what has just hit it: what
is too faint to be met with a short step is to die in it, and not to be thrown back with more."""


class StepError(RuntimeError):
    """The engine warned, or the state is no longer finite, at the time given [s]."""

    def __init__(self, what: str, t: float) -> None:
        super().__init__(what)
        self.t = t


@dataclass(frozen=True)
class Steps:
    """What the engine did: the pose at each step, and the velocity half a step before and after it.

    Args:
        t: times [s], shape (n,).
        h: step lengths [s], shape (n,).
        pose: x, z, theta [m, m, rad], shape (n, 3).
        before, after: velocities at t - h/2 and t + h/2 [m/s, m/s, rad/s], shape (n, 3).
        beta: Newmark's beta of the rows of base and side in each step [-], shape (2, n).
        ringing: their extra dashpots in units of h k [-], shape (2, n).
        touches: how many touches were met with a short step.
    """

    t: Array
    h: Array
    pose: Array
    before: Array
    after: Array
    beta: Array
    ringing: Array
    touches: int = 0

    @property
    def velocity(self) -> Array:
        """Velocities at the times of the poses, shape (n, 3)."""
        return 0.5 * (self.before + self.after)

    @property
    def seams(self) -> Array:
        """Starts of the leapfrog's windows, half a step before the poses [s], shape (n,)."""
        return self.t - 0.5 * self.h

    @property
    def widths(self) -> Array:
        """Lengths of the windows, from seam to seam, zero for the last [s], shape (n,)."""
        return np.append(np.diff(self.seams), 0.0)


def _check(data: mujoco.MjData, values: Array, t: float) -> None:
    warned = [mujoco.mjtWarning(i).name for i, w in enumerate(data.warning) if w.number]
    if warned or not np.isfinite(values).all():
        raise StepError(f"MuJoCo warned ({', '.join(warned)})" if warned else "the state is not finite", t)


@overload
def push(case: Case, t: float, h: float) -> float: ...
@overload
def push(case: Case, t: Array, h: float | Array) -> float | Array: ...
def push(case: Case, t: float | Array, h: float | Array) -> float | Array:
    """Force that the moving base exerts on the wall as seen from it [N]: -m a_g, its mean over t - h/2 to t + h/2.

    The leapfrog's window is that long, so that the wall receives the impulse of the ground exactly, whatever the step
    and wherever the record jumps.
    """
    if case.motion is None:
        return 0.0
    velocity = case.motion.velocity
    return -case.block.mass * (velocity(t + 0.5 * h) - velocity(t - 0.5 * h)) / h


def ground_work(case: Case, steps: Steps) -> Array:
    """Work that the moving base has done in the window of each step [J], shape (n,)."""
    work: Array = push(case, steps.t, steps.h) * steps.velocity[:, 0] * steps.widths
    return work


def fixed_steps(
    model: mujoco.MjModel, data: Sequence[mujoco.MjData], cases: Sequence[Case], newmark_beta: float
) -> list[Steps | StepError]:
    """Steps of the model's own length, recorded natively, until each case ends or its wall lies on its face.

    Runs of several cases are the same, to the last bit, as runs of one: each is a state that one of the engine's
    threads takes up, steps on, and puts back.

    Args:
        model: the model of every case.
        data: each case at its release; several are stepped by as many threads as there are processors.
        cases: the cases, which may differ in release, duration and ground motion.
        newmark_beta: what the rows of the model were made with [-].

    Returns:
        For each case its steps, or the error that ended them: a warning of the engine, or a state that is not finite.
    """
    h = model.opt.timestep
    totals = [max(1, round(case.duration / h)) + 1 for case in cases]  # the last velocity needs the half step after it
    spec, applied = mujoco.mjtState.mjSTATE_FULLPHYSICS, mujoco.mjtState.mjSTATE_QFRC_APPLIED
    state = np.empty((len(cases), mujoco.mj_stateSize(model, spec)))
    for row, own in zip(state, data, strict=True):
        mujoco.mj_getState(model, own, row, spec)
    history = [[row[None].copy()] for row in state]
    errors: dict[int, StepError] = {}
    going, done = list(range(len(cases))), 0
    with tqdm(total=max(totals) * h, desc="MuJoCo", unit="s", delay=3, disable=None, leave=False) as bar:
        while going:
            steps = min(CHUNK, max(totals[i] for i in going) - done)
            forces = None
            if any(cases[i].motion for i in going):
                forces = np.zeros((len(going), steps, model.nv))
                for force, i in zip(forces, going, strict=True):
                    force[:, 0] = push(cases[i], h * np.arange(done, done + steps), h)
            threads = data[: min(len(going), os.cpu_count() or 1)]
            run, _ = rollout.rollout(model, threads, state[going], forces, nstep=steps, control_spec=applied)
            state[going] = run[:, -1]
            done += steps
            bar.update(steps * h)
            for i, states in zip(going, run, strict=True):
                history[i].append(states.copy())
                stopped = np.flatnonzero(states[:, 0] < h * (np.arange(done - steps, done) + 0.5))  # by a warning
                if stopped.size or not np.isfinite(states[-1]).all():
                    t = float(states[-1, 0])
                    errors[i] = StepError("MuJoCo warned of a state that is not finite, or soon would not be", t)
            going = [i for i in going if i not in errors and done < totals[i] and abs(state[i, 3]) <= ON_ITS_FACE]
    return [
        errors.get(i) or _fixed(np.concatenate(own)[: total + 1], h, newmark_beta)
        for i, (own, total) in enumerate(zip(history, totals, strict=True))
    ]


def _fixed(states: Array, h: float, newmark_beta: float) -> Steps:
    """Recorded states (time, pose, velocity) as steps, up to where the wall lies on its face."""
    fallen = np.flatnonzero(np.abs(states[:-1, 3]) > ON_ITS_FACE)
    count = int(fallen[0]) + 1 if fallen.size else len(states) - 1
    return Steps(
        t=h * np.arange(count, dtype=float),
        h=np.full(count, h),
        pose=states[:count, 1:4],
        before=states[:count, 4:],
        after=states[1 : count + 1, 4:],
        beta=np.full((2, count), newmark_beta),
        ringing=np.zeros((2, count)),
    )


def _long_or_short(h: float | Array, frequency: float) -> tuple[Array, Array]:
    """Newmark's beta and the extra dashpot of fitted steps [-], at base and side, shapes (2, n)."""
    r = np.array(RINGING)[:, None]
    smooth = np.atleast_1d(h) * frequency < SMOOTH
    return np.where(smooth, 1 / 12, (1 + r**2) / 4), np.where(smooth, 0.0, r)


class _Rows:
    """The contact rows of a model, set in place for any step."""

    def __init__(self, model: mujoco.MjModel, case: Case, contacts: Contacts) -> None:
        faces = contacts.faces(side_stop=case.side_stop)
        self.model = model
        self.k = np.concatenate([face.stiffness for face in faces])
        self.c = np.concatenate([face.damping for face in faces])
        self.face = np.repeat([0, 1][: len(faces)], [face.points for face in faces])
        self.weight = inverse_weight(case.block.mass)
        self.held = HELD_MASSES * case.block.mass
        self.frequency = contacts.highest_frequency(case.block, side_stop=case.side_stop)
        self.known: dict[float, tuple[Array, Array, Array, float]] = {}

    def follow(self, h: float, *, remember: bool) -> None:
        """Set step, rows and friction; `remember` the rows of a step that will come again."""
        rows = self.known.get(h) or self._rows(h)
        if remember:
            self.known[h] = rows
        model = self.model
        model.opt.timestep = h
        model.pair_solref[:], model.pair_solimp[:, :2], model.pair_solreffriction[:, 1], model.opt.impratio = rows

    def _rows(self, h: float) -> tuple[Array, Array, Array, float]:
        beta, ringing = (values[self.face, 0] for values in _long_or_short(h, self.frequency))
        damping, inertia = row_terms(self.k, self.c, h, self.weight, beta, ringing)
        d = impedance(inertia, self.weight)
        scale = (1 - d) * self.weight
        solref = -np.stack([scale * self.k, scale * damping], axis=1)
        sticks = self.model.pair_solreffriction[:, 1] < 0
        return solref, np.stack([d, d], axis=1), np.where(sticks, -d / h, 0.0), float(self.held / inertia[0])


def fitted_steps(model: mujoco.MjModel, data: mujoco.MjData, case: Case, contacts: Contacts, accuracy: float) -> Steps:
    """Steps that fit the motion, until the case's duration or until the wall lies on its face.

    The lengths follow from the contacts, the pivot's motion and an error estimate, never from the wall at hand:

    * the short step from the highest frequency of the closed contacts, omega h = sqrt(SHORT accuracy);
    * the longest from the rocking, p h = sqrt(LONG accuracy), as far as MuJoCo represents the rows and, on a shaken
      base, up to the time step of the record;
    * between the two, a step is doubled after two in a row in which the acceleration changed by little, h |da| under a
      quarter of CHANGE accuracy |v|, and halved when it changed by more than that; |.| weighs with the masses, and |v|
      is the speed with which the wall arrived at its last touch;
    * a step in which a point would touch, to second order in time, ends half a short step behind the touch, unless the
      touch is too faint to matter (FADED). A face is straight, so that the next point of it to touch is the first or
      the last of those that are open.

    `data` has to be at the release, its velocity half a short step back, and `model` made for the short step.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    wall, duration = case.block, case.duration
    b, height, mass, inertia = wall.b, wall.h, wall.mass, wall.inertia
    rows = _Rows(model, case, contacts)
    short = model.opt.timestep
    k_max, c_max = float(rows.k.max()), float(rows.c.max())
    longest = min(math.sqrt(LONG * accuracy) / wall.p, math.sqrt(0.4 * most_inertia(rows.weight) / k_max))
    longest = max(short, min(longest, case.motion.dt) if case.motion else longest)
    tolerated = (CHANGE * accuracy) ** 2
    least_energy = 2 * contacts.uplift_energy(wall)
    energy = max(2 * case.release_energy, least_energy)  # twice the kinetic energy that an impact is measured by
    stops = c_max * short * rows.weight > 0.1 * OVERDAMPED  # a dashpot that even the short step does not resolve
    base_points, side_points = contacts.base.points, contacts.side.points if case.side_stop and contacts.side else 0
    sin, cos, step = math.sin, math.cos, mujoco.mj_step
    qpos, qvel, qacc = data.qpos, data.qvel, data.qacc

    rows.follow(short, remember=True)
    record: list[tuple[float, ...]] = []
    t, h, last_h = 0.0, short, short
    x, z, theta = qpos.tolist()
    vx, vz, w = qvel.tolist()
    ax, az, aw = qacc.tolist()
    jx = jz = jw = 0.0  # rates of the accelerations
    fresh, calm, touches, stopping = True, 0, 0, 0
    last_ends: tuple[tuple[float, ...], ...] = ()
    moving = case.motion is not None
    with tqdm(total=duration, desc="MuJoCo", unit="s", delay=3, disable=None, leave=False) as bar:
        recorded, turned_to = -1.0, 0.0
        while recorded < duration and abs(turned_to) <= ON_ITS_FACE:  # a NaN ends the loop too
            # accelerations and velocities at this very time, from the last step
            ax_now, az_now, aw_now = ax + jx * last_h, az + jz * last_h, aw + jw * last_h
            late = 0.5 * last_h
            vx_now, vz_now, w_now = vx + ax_now * late, vz + az_now * late, w + aw_now * late

            sine, cosine = sin(theta), cos(theta)
            ends = (
                _open_ends(z + height - height * cosine, -sine, b, base_points),
                _open_ends(x + b - b * cosine, sine, height, side_points) if side_points else (),
            )
            if ends != last_ends and last_h > short and not fresh:
                # a long step has opened or closed a contact unforeseen: what it felt does not say what comes
                if moving:
                    data.qfrc_applied[0] = push(case, t, short)
                mujoco.mj_forward(model, data)
                ax_now, az_now, aw_now = qacc.tolist()
                h, calm, fresh = short, 0, True
            last_ends = ends
            now, touch = h, False
            if stopping:
                stopping -= 1  # how a wall is being stopped says nothing of the next step
            else:
                w2 = w_now * w_now
                approaches = []  # gap, its rate and its rate's rate where one closes within the step
                for p in ends[0]:
                    arm = p * cosine - height * sine
                    g0, g1 = z + height - p * sine - height * cosine, vz_now - w_now * arm
                    g2 = az_now - aw_now * arm + w2 * (p * sine + height * cosine)
                    if g0 + now * (g1 + 0.5 * now * g2) <= 0:
                        approaches.append((g0, g1, g2))
                for p in ends[1]:
                    arm = b * sine + p * cosine
                    g0, g1 = x + b - b * cosine + p * sine, vx_now + w_now * arm
                    g2 = ax_now + aw_now * arm + w2 * (b * cosine - p * sine)
                    if g0 + now * (g1 + 0.5 * now * g2) <= 0:
                        approaches.append((g0, g1, g2))
                met = []  # when a gap closes, and how fast
                for g0, g1, g2 in approaches:
                    closing = math.sqrt(max(0.0, g1 * g1 - 2 * g0 * g2))
                    if (0.25 * k_max * h * h + c_max * h) * closing * closing > FADED * accuracy * energy:
                        met.append((2 * g0 / (closing - g1), closing))
                if met:  # of the touches that fall into one window, the hardest starts it
                    latest = min(met)[0] + 0.5 * short
                    now, touch = max((c, tau) for tau, c in met if tau <= latest)[1] + 0.5 * short, True
            if now != last_h:
                late, lag = 0.5 * (now - last_h), last_h - 0.25 * (last_h + now)
                vx, vz, w = vx - (ax + jx * lag) * late, vz - (az + jz * lag) * late, w - (aw + jw * lag) * late
                qvel[:] = vx, vz, w
                rows.follow(now, remember=not touch)
            if moving:
                data.qfrc_applied[0] = push(case, t, now)
            step(model, data)

            ax_new, az_new, aw_new = qacc.tolist()
            vx_new, vz_new, w_new = qvel.tolist()
            record.append((t, now, x, z, theta, vx, vz, w, vx_new, vz_new, w_new))
            recorded, turned_to = t, theta
            vx, vz, w = vx_new, vz_new, w_new
            x, z, theta = qpos.tolist()
            t += now
            if fresh:
                jx = jz = jw = 0.0
                change, fresh = math.inf, False
            else:
                dx, dz, dw = ax_new - ax, az_new - az, aw_new - aw
                change = now * now * (mass * (dx * dx + dz * dz) + inertia * dw * dw) / energy
                jx, jz, jw = dx / last_h, dz / last_h, dw / last_h
            ax, az, aw, last_h = ax_new, az_new, aw_new, now

            if touch:
                touches += 1
                h, calm, fresh = short, 0, True
                stopping = 4 if stops else 0
                energy = max(mass * (vx * vx + vz * vz) + inertia * w * w, least_energy)
            elif change > tolerated:
                h, calm = max(0.5 * h, short), 0
            elif 16 * change < tolerated:
                calm += 1
                if calm >= 2:
                    h, calm = min(2 * h, longest), 0
            else:
                calm = 0
            if len(record) % 5000 == 0:
                bar.update(t - bar.n)
                _check(data, qpos, t)
    _check(data, np.concatenate([qpos, qvel]), t)
    history = np.array(record)
    beta, ringing = _long_or_short(history[:, 1], rows.frequency)
    return Steps(
        t=history[:, 0],
        h=history[:, 1],
        pose=history[:, 2:5],
        before=history[:, 5:8],
        after=history[:, 8:11],
        beta=beta,
        ringing=ringing,
        touches=touches,
    )


def short_step(case: Case, contacts: Contacts, accuracy: float) -> float:
    """The step that resolves the stiffest spring and the strongest dashpot to `accuracy` [s].

    However loose the accuracy, omega h is never more than 0.35: some eighteen steps in the shortest period. A dashpot
    that would ask for less than an eighth of the spring's step is left to act at the end of the step: it stops what it
    meets, and how it does so no longer matters.
    """
    frequency = contacts.highest_frequency(case.block, side_stop=case.side_stop)
    spring = min(0.35, math.sqrt(SHORT * accuracy)) / frequency
    faces = contacts.faces(side_stop=case.side_stop)
    strongest = max(float(face.damping.max()) for face in faces) * inverse_weight(case.block.mass)
    dashpot = math.sqrt(DASHPOT * accuracy) / (6 * strongest) if strongest else math.inf
    return min(spring, max(dashpot, spring / 8))


def _open_ends(offset: float, slope: float, half: float, points: int) -> tuple[float, ...]:
    """Positions of the first and the last open point of a face, whose gap is offset + slope * position."""
    low, high = offset - slope * half, offset + slope * half
    if low >= 0:
        if high >= 0:
            return (-half, half)
        if points == 2:
            return (-half,)
        last = math.ceil((-offset / slope + half) / (2 * half) * (points - 1)) - 1
        return (-half, -half + 2 * half * last / (points - 1))
    if high >= 0:
        if points == 2:
            return (half,)
        first = math.floor((-offset / slope + half) / (2 * half) * (points - 1)) + 1
        return (-half + 2 * half * first / (points - 1), half)
    return ()
