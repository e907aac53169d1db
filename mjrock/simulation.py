"""MuJoCo: compile the text of a case, step it, record it. The only module that steps MuJoCo."""

from __future__ import annotations

import math
import time

import mujoco
import numpy as np
from mujoco import rollout
from numpy.typing import NDArray
from tqdm import tqdm

from .block import Block, require_within
from .case import Case
from .interface import Contacts
from .mjcf import inverse_weight, wall_mjcf
from .pose import mechanical_energy
from .response import Response, ending, rocking_history

Array = NDArray[np.float64]
ENERGY_GAIN = 1e-3
"""Most energy that may appear from nowhere, as a share of the energy of release [-]."""
CHUNK = 20_000
"""Steps between two looks at the wall: whether it has overturned, whether MuJoCo has warned."""


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


def release(model: mujoco.MjModel) -> mujoco.MjData:
    """Data at the keyframe `release`, with the velocity half a step back, where the leapfrog keeps it."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("release").id)
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


def simulate(
    case: Case,
    contacts: Contacts,
    timestep: float | None = None,
    *,
    newmark_beta: float = 0.25,
    output_step: float | None = None,
) -> Response:
    """Free rocking of a wall on compliant contacts in MuJoCo.

    Args:
        case: the wall, its release, its sides.
        contacts: the interfaces.
        timestep: fixed step [s]; None takes `automatic_timestep`.
        newmark_beta: Newmark's beta of the contact rows [-], see `mjrock.contact`.
        output_step: spacing of the returned samples [s], rounded to whole steps; None returns every step.

    Raises:
        ValueError: if the contacts do not fit the case, or cannot be represented at this step.
        SimulationError: if the run produces a NaN, an engine warning, or more energy than was there before.
    """
    wall = case.block
    contacts.require_fit(wall, side_stop=case.side_stop)
    sound = automatic_timestep(wall, contacts, side_stop=case.side_stop)
    h = sound if timestep is None else require_within("timestep", timestep, 1e-9, 1.0, "s")
    started = time.perf_counter()
    model = compile_wall(wall_mjcf(case, contacts, h, newmark_beta=newmark_beta), wall)
    data = release(model)
    total = max(1, round(case.duration / h)) + 1  # a sample needs the velocity half a step after it
    stride = max(1, round(output_step / h)) if output_step else 1

    def broken(what: str, t: float) -> SimulationError:
        advice = f"the largest sound step is {sound:.3g} s" if h > sound * (1 + 1e-9) else "check the contacts"
        return SimulationError(f"{what} at t = {t:.4g} s with a step of {h:.3g} s; {advice}")

    spec = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.empty(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    kept = []  # every stride-th pose, with the velocities half a step before and after it
    done = 0
    with tqdm(total=total * h, desc="simulate", unit="s", delay=3, disable=None, leave=False) as bar:
        while done < total:
            steps = min(CHUNK, total - done)
            run, _ = rollout.rollout(model, data, state[None], nstep=steps)
            chunk = np.vstack([state, run[0]])
            first = -done % stride
            kept.append(np.hstack([chunk[:-1], chunk[1:, 4:]])[first::stride])
            done, state = done + steps, run[0, -1]
            bar.update(steps * h)
            warned = [mujoco.mjtWarning(i).name for i, w in enumerate(data.warning) if w.number]
            if warned or not np.isfinite(state).all():
                what = f"MuJoCo warned ({', '.join(warned)})" if warned else "the state is not finite"
                raise broken(what, state[0])
            if abs(state[3]) > math.pi / 2:
                break
    history = np.vstack(kept)
    fallen = np.flatnonzero(np.abs(history[:, 3]) > math.pi / 2)
    if fallen.size:
        history = history[: fallen[0] + 1]
    t, pose, velocity = history[:, 0], history[:, 1:4], 0.5 * (history[:, 4:7] + history[:, 7:10])
    theta, omega = pose[:, 2], velocity[:, 2]
    energy = mechanical_energy(case, contacts, pose, velocity)
    times, peaks, impacts = rocking_history(case, t, theta, omega, contacts.uplift_rotation(wall))

    worst, when = energy_gain(times, t, energy)
    scale = max(float(energy[0]), contacts.uplift_energy(wall))
    if worst > ENERGY_GAIN * scale:
        raise broken(f"{worst:.3g} J, {worst / scale:.2%} of the release energy, appeared from nowhere", when)
    outcome, message = ending(case, t, theta, energy, contacts.uplift_energy(wall))
    return Response(
        case=case,
        solver="MuJoCo",
        t=t,
        theta=theta,
        omega=omega,
        energy=energy,
        impacts=impacts,
        peaks=peaks,
        outcome=outcome,
        message=message,
        stats={
            "wall_time": time.perf_counter() - started,
            "steps": done,
            "timestep": h,
            "sound_timestep": sound,
            "newmark_beta": newmark_beta,
            "mujoco": mujoco.__version__,
        },
    )
