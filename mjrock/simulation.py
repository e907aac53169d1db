"""MuJoCo: compile the text of a case, step it, and turn what it did into a response."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from .block import Block, require_within
from .case import Case
from .interface import Contacts
from .ledger import Ledger
from .mjcf import inverse_weight, wall_mjcf
from .pose import base_gaps, mechanical_energy, release_pose, side_gaps
from .response import Response, State, ending, rocking_history
from .stepping import SMOOTH, StepError, Steps, fitted_steps, fixed_steps, ground_work, short_step

Array = NDArray[np.float64]
ENERGY_GAIN = 1e-3
"""Most energy that may appear from nowhere, as a share of the energy of release [-]."""


class SimulationError(RuntimeError):
    """A run broke down: NaN, a warning of the engine, or energy from nowhere. The message says what to change."""


def automatic_timestep(wall: Block, contacts: Contacts, *, side_stop: bool) -> float:
    """The step [s] at which a touch misplaces no more than ENERGY_GAIN of the energy that it meets.

    A point that touches inside a step of length h is met up to h/2 too early or too late, and its spring then stores up
    to k (v h/2)^2 / 2 that the motion has not paid. Against the kinetic energy m v^2 / 2 behind the point that is
    (omega h / 2)^2, with omega the frequency of the contact. So omega h = 2 sqrt(ENERGY_GAIN), omega the highest
    frequency of the wall with every contact closed: about a hundred steps in the shortest contact period.
    """
    return 2 * math.sqrt(ENERGY_GAIN) / contacts.highest_frequency(wall, side_stop=side_stop)


def compile_wall(text: str, wall: Block) -> mujoco.MjModel:
    """The compiled model, once it is sure that MuJoCo weighs its contacts as the text presumes."""
    model = mujoco.MjModel.from_xml_string(text)
    weighed = float(model.body_invweight0[model.body("wall").id, 0])
    if not math.isclose(weighed, inverse_weight(wall.mass), rel_tol=1e-9):
        raise SimulationError(
            f"MuJoCo {mujoco.__version__} gives the wall the inverse weight {weighed:g} 1/kg instead of "
            f"{inverse_weight(wall.mass):g} 1/kg: its contact stiffness would not be the one asked for"
        )
    return model


def release(model: mujoco.MjModel, start: State | None = None) -> mujoco.MjData:
    """Data at `start` or the keyframe `release`, with the velocity half a step back, where the leapfrog keeps it.

    Before the release the ground is quiet.
    """
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("release").id)
    if start is not None:
        data.qpos[:], data.qvel[:] = start
    velocity = data.qvel.copy()
    for _ in range(10):  # the dashpots act on the velocity that is being set: a contraction, exact to rounding
        mujoco.mj_forward(model, data)
        data.qvel[:] = velocity - 0.5 * model.opt.timestep * data.qacc
    return data


def energy_gain(peak_times: Array, t: Array, energy: Array) -> tuple[float, float]:
    """The largest gain of energy from release to peak to peak to the end [J], and when it had happened [s].

    Peaks are compared, and not neighbouring samples, because a touch inside a step misplaces energy while the contact
    lasts; what matters is whether the impact as a whole has lost or gained.
    """
    marks = np.concatenate([t[:1], peak_times, t[-1:]])
    gains = np.diff(np.interp(marks, t, energy))
    worst = int(gains.argmax())
    return float(gains[worst]), float(marks[worst + 1])


class _Run:
    """One run of the engine, checked: its steps, its energy, its peaks and impacts.

    Raises:
        StepError: if energy appears from nowhere.
    """

    def __init__(self, case: Case, contacts: Contacts, steps: Steps, *, released: bool) -> None:
        wall = case.block
        self.case, self.contacts, self.steps = case, contacts, steps
        t, self.theta, self.omega = steps.t, steps.pose[:, 2], steps.velocity[:, 2]
        self.energy = mechanical_energy(case, contacts, steps.pose, steps.velocity)
        self.uplift = contacts.uplift_rotation(wall), contacts.uplift_energy(wall)
        times, self.peaks, self.impacts = rocking_history(
            case, t, self.theta, self.omega, self.energy, self.uplift, released=released
        )

        # up to where the wall can still come back: what a fall releases dwarfs the energy it was released with
        standing = np.flatnonzero(np.abs(self.theta) <= wall.alpha)
        count = int(standing[-1]) + 1 if standing.size else 1
        work = ground_work(case, steps)[:count]
        own = self.energy[:count] - (np.cumsum(work) - 0.5 * work)
        gain, when = energy_gain(times[times <= t[count - 1]], t[:count], own)
        scale = max(float(self.energy[0]) + float(np.abs(work).sum()), self.uplift[1])
        if not gain <= ENERGY_GAIN * scale:
            raise StepError(f"{gain:.3g} J, {gain / scale:.2%} of the energy there was, appeared from nowhere", when)

    def thinned(self, stride: int) -> tuple[tuple[Array, Array, Array], State]:
        """Time, rotation and velocity of every `stride`-th step, and the last pose and velocity."""
        steps = self.steps
        kept = steps.t[::stride], self.theta[::stride], self.omega[::stride]
        return kept, (steps.pose[-1], steps.velocity[-1])

    def interpolated(self, spacing: float) -> tuple[tuple[Array, Array, Array], State]:
        """Time, rotation and velocity, `spacing` apart, and pose and velocity at the end."""
        steps = self.steps
        finish = min(float(steps.t[-1]), self.case.duration)
        t = np.linspace(0.0, finish, max(2, math.ceil(finish / spacing) + 1))
        spline = CubicHermiteSpline(steps.t, self.theta, self.omega)
        last = CubicHermiteSpline(steps.t[-2:], steps.pose[-2:], steps.velocity[-2:])
        return (t, spline(t), spline(t, 1)), (last(finish), last(finish, 1))

    def response(self, kept: tuple[tuple[Array, Array, Array], State], ledger: bool, stats: dict[str, Any]) -> Response:
        """What was found, at the times kept; `stats` says how."""
        case, contacts, steps, wall = self.case, self.contacts, self.steps, self.case.block
        (t, theta, omega), end = kept
        outcome, message = ending(case, steps.t, self.theta, self.energy, self.uplift[1])
        return Response(
            case=case,
            solver="MuJoCo",
            t=t,
            theta=theta,
            omega=omega,
            energy=np.interp(t, steps.t, self.energy),
            impacts=self.impacts,
            peaks=self.peaks,
            outcome=outcome,
            message=message,
            ledger=Ledger.of(case, contacts, steps).at(t) if ledger else None,
            end=end,
            stats={
                "steps": len(steps.t),
                "longest_timestep": float(steps.h.max()),
                "sound_timestep": automatic_timestep(wall, contacts, side_stop=case.side_stop),
                "touches": steps.touches,
                "deepest_base": _deepest(base_gaps(wall, contacts, steps.pose)),
                "deepest_side": _deepest(side_gaps(wall, contacts, steps.pose)) if case.side_stop else 0.0,
                "base_displacement": float(steps.pose[-1, 0] - wall.h * math.sin(steps.pose[-1, 2])),
                "mujoco": mujoco.__version__,
            }
            | stats,
        )


def _broken(error: StepError, case: Case, contacts: Contacts, h: float, accuracy: float | None) -> SimulationError:
    """The error for the user: what happened and what to change."""
    sound = automatic_timestep(case.block, contacts, side_stop=case.side_stop)
    if accuracy is not None:
        advice = f"lower accuracy = {accuracy:g}, or fix the step: the largest sound one is {sound:.3g} s"
    elif h > sound * (1 + 1e-9):
        advice = f"the largest sound step is {sound:.3g} s"
    else:
        advice = "the step is sound: the contacts are too stiff or too little damped for it; halve it"
    return SimulationError(f"{error} at t = {error.t:.4g} s with a step of {h:.3g} s; {advice}")


def simulate(
    case: Case,
    contacts: Contacts,
    timestep: float | None = None,
    *,
    accuracy: float = 1e-3,
    newmark_beta: float = 0.25,
    output_step: float | None = None,
    ledger: bool = False,
    start: State | None = None,
) -> Response:
    """Rocking of a wall on compliant contacts in MuJoCo.

    Args:
        case: the wall, its release, its sides.
        contacts: the interfaces.
        timestep: a fixed step [s]; None lets the steps fit the motion, see `mjrock.stepping`.
        accuracy: what fitted steps aim at, as a relative tolerance on rotation and energy [-], 1e-8 to 0.1. A run in
            which energy appears from nowhere is taken back and repeated with a tenth of it, twice at most.
        newmark_beta: Newmark's beta of the contact rows at a fixed step [-], see `mjrock.contact`.
        output_step: spacing of the returned samples [s]. Fixed steps are thinned to whole steps, None returns them
            all; fitted steps are interpolated, None stands for 1 ms.
        ledger: whether to account for every part of the energy, see `mjrock.ledger`.
        start: pose and velocity to start from instead of the release, the `end` of an earlier response; the release is
            then no peak, and the first is the first that is reached.

    Raises:
        ValueError: if the contacts do not fit the case or cannot be represented at this step, or for a value outside
            its range.
        SimulationError: if the run produces a NaN, an engine warning, or more energy than was there and was put in.

    Warns:
        UserWarning: if a fixed step is too long to resolve the contacts.
    """
    contacts.require_fit(case.block, side_stop=case.side_stop)
    require_within("accuracy", accuracy, 1e-8, 0.1)
    if output_step is not None:
        require_within("output_step", output_step, 1e-9, case.duration, "s")
    if timestep is not None:
        (answer,) = _simulate_fixed([case], contacts, timestep, newmark_beta, output_step, ledger, start)
        if isinstance(answer, SimulationError):
            raise answer
        return answer
    started = time.perf_counter()
    used = accuracy
    while True:
        h = short_step(case, contacts, used)
        model = compile_wall(wall_mjcf(case, contacts, h, newmark_beta=newmark_beta), case.block)
        data = release(model, start)
        begun = time.perf_counter()
        try:
            steps = fitted_steps(model, data, case, contacts, used)
            stepping_time = time.perf_counter() - begun
            run = _Run(case, contacts, steps, released=start is None)
            break
        except StepError as error:
            if used < 0.02 * accuracy:
                raise _broken(error, case, contacts, h, used) from None
            used /= 10
    kept = run.interpolated(output_step or 1e-3)
    took = {"wall_time": time.perf_counter() - started, "stepping_time": stepping_time}
    return run.response(kept, ledger, took | {"timestep": h, "accuracy": used, "newmark_beta": newmark_beta})


def simulate_batch(
    cases: Sequence[Case],
    contacts: Contacts,
    timestep: float,
    *,
    newmark_beta: float = 0.25,
    output_step: float | None = None,
    ledger: bool = False,
) -> list[Response | SimulationError]:
    """Many cases of one wall on the same contacts at one fixed step, stepped by MuJoCo's threads.

    Each answer is what `simulate(case, contacts, timestep, ...)` returns or raises, to the last bit; a run that breaks
    down leaves the others alone.

    Args:
        cases: the cases; they differ in release, duration and ground motion only.
        contacts: the interfaces.
        timestep: the step [s].
        newmark_beta, output_step, ledger: as in `simulate`.

    Raises:
        ValueError: if the walls or sides of the cases differ, or as `simulate` does.
    """
    if not cases:
        return []
    first = cases[0]
    for i, case in enumerate(cases):
        if (case.block, case.side_stop) != (first.block, first.side_stop):
            raise ValueError(f"cases[{i}] has another wall or other sides than cases[0]; a batch has one geometry")
    return _simulate_fixed(cases, contacts, timestep, newmark_beta, output_step, ledger, None)


def _simulate_fixed(
    cases: Sequence[Case],
    contacts: Contacts,
    timestep: float,
    newmark_beta: float,
    output_step: float | None,
    ledger: bool,
    start: State | None,
) -> list[Response | SimulationError]:
    """Runs of one geometry at one fixed step, or how each broke down."""
    first = cases[0]
    contacts.require_fit(first.block, side_stop=first.side_stop)
    require_within("timestep", timestep, 1e-9, 1.0, "s")
    _warn_if_coarse(first, contacts, timestep)
    started = time.perf_counter()
    model = compile_wall(wall_mjcf(first, contacts, timestep, newmark_beta=newmark_beta), first.block)
    data = [release(model, start or release_pose(case, contacts)) for case in cases]
    begun = time.perf_counter()
    made = fixed_steps(model, data, cases, newmark_beta)
    stepping_time = (time.perf_counter() - begun) / len(cases)
    stride = max(1, round(output_step / timestep)) if output_step else 1
    answers: list[Response | SimulationError] = []
    for case, steps in zip(cases, made, strict=True):
        try:
            if isinstance(steps, StepError):
                raise steps
            run = _Run(case, contacts, steps, released=start is None)
        except StepError as error:
            answers.append(_broken(error, case, contacts, timestep, None))
            continue
        wall_time = (time.perf_counter() - started) / len(cases)
        took = {"wall_time": wall_time, "stepping_time": stepping_time}
        settings = {"timestep": timestep, "accuracy": None, "newmark_beta": newmark_beta}
        answers.append(run.response(run.thinned(stride), ledger, took | settings))
    return answers


def _warn_if_coarse(case: Case, contacts: Contacts, h: float) -> None:
    if h * contacts.highest_frequency(case.block, side_stop=case.side_stop) > SMOOTH:
        sound = automatic_timestep(case.block, contacts, side_stop=case.side_stop)
        warnings.warn(
            f"a step of {h:.3g} s does not resolve the contacts: impacts lose what the step makes of them; "
            f"the largest sound step is {sound:.3g} s",
            stacklevel=4,
        )


def _deepest(gaps: Array) -> float:
    """Largest penetration [m]."""
    return max(0.0, -float(gaps.min()))
