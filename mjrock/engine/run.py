"""One run of the engine: checked, and turned into a response."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np

from ..problem.case import Case
from ..problem.quantities import Array, Integers
from ..problem.uplift import Uplift
from ..result.history import rocking_history
from ..result.response import Plastic, Response, ending
from .accounts import ground_work, ledger
from .kinematics import gaps
from .model import SimulationError
from .scene import Scene
from .steps import StepError, Steps

ENERGY_GAIN = 1e-3
"""Most energy that may appear from nowhere, as a share of the energy of release [-]."""


SLIDING = 4.0
"""omega h up to which a fixed step follows masonry that slides, omega the highest contact frequency [-]."""


def sound_timestep(frequency: float) -> float:
    """`automatic_timestep` for the highest frequency of the closed contacts [rad/s]."""
    return 2 * math.sqrt(ENERGY_GAIN) / frequency


def told(scene: Scene, steps: Steps) -> dict[str, Any]:
    """What a run took, for the `stats` of its response."""
    return {
        "steps": len(steps.t),
        "longest_timestep": float(steps.h.max()),
        "sound_timestep": sound_timestep(scene.highest_frequency),
        "touches": steps.touches,
        "mujoco": mujoco.__version__,
    }


def plastic_of(scene: Scene, t: Array, taken: Array, duration: float) -> dict[str, Plastic]:
    """What each tie has yielded when the duration [s] is over, from what it had taken [J] at times t, (n, ties)."""
    ends = [float(np.interp(duration, t, own)) for own in taken.T]
    each = zip(scene.tie_names, ends, scene.tie_strength.tolist(), strict=True)
    return {name: Plastic(energy / strength, energy) for name, energy, strength in each}


def own_energy(scene: Scene, steps: Steps, work: Array, marks: Integers) -> Array:
    """Energy at the starts of some windows, less what the ground has put in up to there [J], shape (marks,).

    Energy and work belong to the same time there, wherever the record jumps.

    Args:
        scene, steps: the run.
        work: of the ground in each window [J], see `ground_work`.
        marks: which windows, in order.
    """
    windows = steps.windows
    yields = bool(np.isfinite(scene.tie_strength).any())  # a tie yields between the marks too
    at = np.arange(marks[-1] + 1) if yields else marks
    stored = scene.accounts(windows.pose[at], windows.velocity[at])
    own: Array = stored[0].sum(axis=1) + stored[1].sum(axis=1) - np.append(0.0, np.cumsum(work))[at]
    return own[marks] if yields else own


def energy_gain(t: Array, energy: Array) -> tuple[float, float]:
    """The largest gain of energy from one mark to the next [J], and when it had happened [s].

    Marks are the release, the peaks and the end, and not neighbouring steps, because a touch inside a step misplaces
    energy while the contact lasts. What matters is whether the impact as a whole has lost or gained.
    """
    gains = np.diff(energy)
    worst = int(gains.argmax()) if len(gains) else 0
    return (float(gains[worst]), float(t[worst + 1])) if len(gains) else (0.0, float(t[0]))


class Run:
    """One run of the engine, checked: its steps, its energy, its peaks and impacts, and how far its base slid.

    `scale` is the energy of the release and of what the ground put in or took [J]. The slip is that of the lower edge
    along the base since the release [m], and `slid` its largest size while the wall can still come back.

    Raises:
        StepError: if energy appears from nowhere.
    """

    def __init__(self, case: Case, uplift: Uplift, scene: Scene, steps: Steps, *, released: bool) -> None:
        self.case, self.uplift, self.scene, self.steps = case, uplift, scene, steps
        t, self.theta, self.omega = steps.t, steps.pose[:, 2], steps.velocity[:, 2]
        self.slip = steps.pose[:, 0] - case.wall.pose(self.theta)[:, 0]
        stored, taken = scene.accounts(steps.pose, steps.velocity)
        self.energy = stored.sum(axis=1) - scene.rest_energies.sum()
        self.plastic = plastic_of(scene, t, taken, case.duration)
        times, self.peaks, self.impacts = rocking_history(
            case, t, self.theta, self.omega, self.energy, uplift, released=released
        )

        # up to where the wall can still come back: what a fall releases dwarfs the energy it was released with
        standing = np.flatnonzero(case.returns_from(self.theta))
        count = int(standing[-1]) + 1 if standing.size else 1
        self.slid = float(np.abs(self.slip[:count] - self.slip[0]).max())
        work = ground_work(scene, steps)[:count]
        met = np.searchsorted(steps.windows.t, times[times <= t[count - 1]])
        marks = np.unique(np.concatenate([[0], np.minimum(met, count - 1), [count - 1]]))
        gain, when = energy_gain(steps.windows.t[marks], own_energy(scene, steps, work, marks))
        self.scale = max(float(self.energy[0]) + float(np.abs(work).sum()), uplift.energy)
        if not gain <= ENERGY_GAIN * self.scale:
            raise StepError(
                f"{gain:.3g} J, {gain / self.scale:.2%} of the energy there was, appeared from nowhere", when
            )

    def response(self, spacing: float | None, stride: int, want_ledger: bool, stats: dict[str, Any]) -> Response:
        """What was found: samples `spacing` apart, or every `stride`-th step where that is None; `stats` says how."""
        case, steps, scene = self.case, self.steps, self.scene
        t, pose, velocity, end = steps.sampled(case.duration, spacing, stride)
        outcome, message = ending(case, steps.t, self.theta, self.energy, self.uplift.energy)
        deepest = -gaps(scene.points, steps.pose).min(axis=0)
        return Response(
            case=case,
            solver="MuJoCo",
            t=t,
            theta=pose[:, 0, 2],
            omega=velocity[:, 0, 2],
            impacts=self.impacts,
            peaks=self.peaks,
            outcome=outcome,
            message=message,
            compliant=(np.interp(t, steps.t, self.energy), pose),
            ledger=ledger(scene, steps).at(t) if want_ledger else None,
            plastic=self.plastic,
            end=end,
            stats=told(scene, steps)
            | {"base_displacement": float(np.interp(case.duration, steps.t, self.slip) - self.slip[0])}
            | {
                f"deepest_{name}": float(max(0.0, *deepest[np.array(scene.group) == name]))
                for name in dict.fromkeys(scene.group)
            }
            | stats,
        )


def broken(error: StepError, scene: Scene, h: float, accuracy: float | None) -> SimulationError:
    """The error for the user: what happened and what to change."""
    sound = sound_timestep(scene.highest_frequency)
    if accuracy is not None:
        advice = f"lower accuracy = {accuracy:g}, or fix the step: the largest sound one is {sound:.3g} s"
    elif h > sound * (1 + 1e-9):
        advice = f"the largest sound step is {sound:.3g} s"
    else:
        advice = "the step is sound: the contacts are too stiff or too little damped for it; halve it"
    if accuracy is None and len(scene.names) > 1 and h * scene.highest_frequency > SLIDING:
        advice = (
            f"joints that slide are unstable at a fixed step beyond {SLIDING / scene.highest_frequency:.3g} s "
            f"(omega h = {SLIDING:g}, omega the highest frequency of the closed contacts); {advice}"
        )
    return SimulationError(f"{error} at t = {error.t:.4g} s with a step of {h:.3g} s; {advice}")
