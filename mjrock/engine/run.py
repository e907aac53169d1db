"""One run of the engine: checked, and turned into a response."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from ..quantities import Array, Integers
from ..result.ledger import ENERGY_GAIN, from_nowhere
from ..result.motion import SampledMotion
from ..result.response import Response
from ..result.ties import Plastic, told_of_ties
from ..scene.course import Course
from ..scene.scene import Scene
from ..scene.structure import breaks
from .energy_work import ground_work, ledger
from .forces import kept_forces
from .model import SimulationError
from .reading import Asked, Reading
from .record import StepError, Steps

SLIDING = 4.0
"""omega h up to which a fixed step follows masonry that slides, omega the highest contact frequency [-]."""


def sound_timestep(frequency: float) -> float:
    """`automatic_timestep` for the highest frequency of the closed contacts [rad/s]."""
    return 2 * math.sqrt(ENERGY_GAIN) / frequency


@dataclass(frozen=True, eq=False)
class EngineRun:
    """A run of the engine that has been checked.

    Args:
        asked, scene, course: what was asked, what stands, and what happened to it.
        steps: what the engine did.
        energy: at the steps, above the scene at rest [J], shape (steps,).
        taken: what ties have taken up to each step [J], shape (steps, t).
        broken: the step from which each tie no longer acts, see `mjrock.scene.structure.breaks`.
        reading: what is read from the motion, of the wall or of the joints.
        scale: energy of the release, of the springs at rest, or at most where they start empty, and of what the ground
            put in or took [J].
    """

    asked: Asked
    scene: Scene
    course: Course
    steps: Steps
    energy: Array
    taken: Array
    broken: Integers
    reading: Reading
    scale: float

    @classmethod
    def judged(cls, asked: Asked, scene: Scene, course: Course, steps: Steps) -> EngineRun:
        """The run of these steps.

        Raises:
            StepError: if energy appears from nowhere.
        """
        broken = breaks(scene.ties, steps.pose, scene.places.freedom)
        stored, taken = scene.accounts(steps.pose, steps.velocity, broken)
        energy = stored.sum(axis=1) - scene.rest_energies.sum()
        reading = asked.read(scene, course, steps, energy)
        work = ground_work(scene, course, steps)[: reading.count]
        elastic = float(scene.rest_energies[2]) or float(stored[: reading.count, 2].max())  # as drawn springs hold none
        scale = max(float(energy[0]), 0.0) + float(np.abs(work).sum()) + elastic
        require_no_gain(scene, steps, work, reading.marks, scale)
        return cls(asked, scene, course, steps, energy, taken, broken, reading, scale)

    def response(
        self, spacing: float | None, stride: int, want_ledger: bool, want_forces: bool, settings: dict[str, Any]
    ) -> Response:
        """What was found: samples `spacing` apart, or every `stride`-th step where that is None."""
        scene, course, steps, reading = self.scene, self.course, self.steps, self.reading
        t, pose, velocity, end = steps.sampled(course.duration, spacing, stride)
        plastic = plastic_of(scene, steps, self.taken, self.broken, course.duration)
        return Response(
            case=self.asked.case,
            solver="MuJoCo",
            t=t,
            motion=SampledMotion(pose, velocity, np.interp(t, steps.t, self.energy)),
            outcome=reading.outcome,
            message=reading.message + told_of_ties(plastic),
            rocking=reading.rocking,
            joints=reading.joints,
            plastic=plastic,
            ledger=ledger(scene, course, steps).at(t) if want_ledger else None,
            stats=stats_of(scene, steps) | reading.stats | settings,
            end=end,
            kept_forces=kept_forces(self.asked.case, scene, steps, t, plastic) if want_forces else None,
        )


def stats_of(scene: Scene, steps: Steps) -> dict[str, Any]:
    """What a run took, for the `stats` of its response."""
    return {
        "steps": len(steps.t),
        "longest_timestep": float(steps.h.max()),
        "sound_timestep": sound_timestep(scene.highest_frequency),
        "touches": steps.touches,
        "mujoco": mujoco.__version__,
    }


def plastic_of(scene: Scene, steps: Steps, taken: Array, broken: Integers, duration: float) -> dict[str, Plastic]:
    """What each tie has yielded when the duration [s] is over, from what it had taken [J] by each step, (n, ties)."""
    plastic = {}
    links = scene.links.sprung
    for i, (name, strength) in enumerate(zip(links.names, links.strength.tolist(), strict=True)):
        energy = float(np.interp(duration, steps.t, taken[:, i]))
        plastic[name] = Plastic(energy / strength, energy, start=float(scene.ties.reach[i] - links.reach[i]))
        if broken[i] < len(steps.t) and (when := float(steps.windows.t[broken[i]])) <= duration:
            energy = strength * float(links.ultimate[i])
            plastic[name] = Plastic(energy / strength, energy, when, 0.5 * strength**2 / float(links.k[i]))
    return plastic


def require_no_gain(scene: Scene, steps: Steps, work: Array, marks: Integers, scale: float) -> None:
    """Make sure that no energy appears from nowhere.

    The energy less what the ground has put in may not be larger at one mark than at an earlier one, by more than
    ENERGY_GAIN of `scale`. Marks are some of the windows of the steps, where energy and work belong to the same time,
    and not neighbouring ones: a touch inside a step misplaces energy while the contact lasts. What matters is whether
    an impact as a whole has lost or gained.

    Args:
        scene, steps: the run.
        work: of the ground in each window [J], see `ground_work`.
        marks: which windows, in order.
        scale: the energy there was [J].

    Raises:
        StepError: if energy has appeared.
    """
    windows = steps.windows
    yields = bool(np.isfinite(scene.links.sprung.strength).any())  # a tie yields between the marks too
    at = np.arange(marks[-1] + 1) if yields else marks
    broken = (breaks(scene.ties, steps.pose, scene.places.freedom),) if yields else ()
    stored, taken = scene.accounts(windows.pose[at], windows.velocity[at], *broken)
    balance = stored.sum(axis=1) + taken.sum(axis=1) - np.append(0.0, np.cumsum(work))[at]
    balance = balance[marks] if yields else balance
    gain = from_nowhere(balance, scale)
    if gain is not None:
        worst, _, said = gain
        raise StepError(said, float(windows.t[marks[worst]]))


def explained(error: StepError, scene: Scene, h: float, accuracy: float | None) -> SimulationError:
    """The error for the user: what happened and what to change."""
    sound = sound_timestep(scene.highest_frequency)
    if accuracy is not None:
        advice = f"lower accuracy = {accuracy:g}, or fix the step: the largest sound one is {sound:.3g} s"
    elif h > sound * (1 + 1e-9):
        advice = f"the largest sound step is {sound:.3g} s"
    else:
        advice = "the step is sound: the contacts are too stiff or too little damped for it; halve it"
    if accuracy is None and scene.limits.damped_joints and h * scene.highest_frequency > SLIDING:
        advice = (
            f"joints that slide are unstable at a fixed step beyond {SLIDING / scene.highest_frequency:.3g} s "
            f"(omega h = {SLIDING:g}, omega the highest frequency of the closed contacts); {advice}"
        )
    return SimulationError(f"{error} at t = {error.t:.4g} s with a step of {h:.3g} s; {advice}")
