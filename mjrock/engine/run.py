"""One run of the engine: checked, and turned into a response."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.kinematics import gaps
from ..quantities import Array, Integers
from ..result.ledger import StepError, require_no_gain
from ..result.motion import SampledMotion
from ..result.problem import Problem
from ..result.reading import Reading
from ..result.response import Response
from ..result.ties import Plastic, plastic_of, ties_message
from ..scene.course import Course
from ..scene.potential import breaks
from ..scene.scene import Scene
from ..scene.time_step import sound_timestep
from .energy_work import ground_work, ledger
from .forces import kept_forces
from .model import SimulationError
from .options import Options
from .record import Steps

MARKS = 1000
"""Most times in a run of masonry between which no energy may appear."""
SLIDING_STABLE = 4.0
"""omega h up to which a fixed step follows masonry that slides, omega the highest contact frequency [-]."""
Settings = dict[str, float | None]
"""Settings of a run and times that its steps took, for the `stats` of its response."""


@dataclass(frozen=True, eq=False)
class EngineRun:
    """A run of the engine that has been checked.

    Args:
        problem, scene, course: the problem, the structure, and what happened to it.
        steps: what the engine did.
        energy: at the steps, above the scene at rest [J], shape (steps,).
        dissipated: by ties up to each step [J], shape (steps, t).
        broken: the step from which each tie no longer acts, see `mjrock.scene.potential.breaks`.
        reading: what is read from the motion, of the wall or of the joints.
        scale: energy of the release, of the springs at rest, or at most where they start as drawn, and of what the
            ground put in or took, or the largest kinetic energy if that is more [J].
        gain: energy that has appeared from nowhere after the first block fell, or None.
    """

    problem: Problem
    scene: Scene
    course: Course
    steps: Steps
    energy: Array
    dissipated: Array
    broken: Integers
    reading: Reading
    scale: float
    gain: StepError | None

    @classmethod
    def checked(cls, problem: Problem, scene: Scene, course: Course, steps: Steps) -> EngineRun:
        """The run of these steps.

        Raises:
            StepError: if energy appears from nowhere before a wall cannot come back, or before the first block falls.
        """
        broken, nq, nv = breaks(scene.ties, steps.pose), scene.freedom.nq, scene.freedom.nv
        stored, dissipated = scene.accounts(steps.pose, steps.velocity, broken)
        energy = stored.sum(axis=1) - scene.rest_energies.sum()
        bodies = len(scene.bodies.names)
        motion = SampledMotion(steps.pose.reshape(-1, bodies, nq), steps.velocity.reshape(-1, bodies, nv), energy)
        reading = problem.read(scene, steps.t, motion, released=course.released)
        marks, count = marks_of(reading, steps), reading.count
        work = ground_work(scene, course, steps)
        unloaded = not problem.case.settled  # its springs have no energy at the start
        elastic = float(stored[:count, 2].max()) if unloaded else float(scene.rest_energies[2])
        put_in = max(float(energy[0]), 0.0) + float(np.abs(work[:count]).sum()) + elastic
        scale = max(put_in, float(stored[:count, 0].max()))  # what falls below its rest has more
        require_no_gain(steps.windows.t[marks], balance(scene, steps, work, marks), scale)
        gain = None
        if reading.joints is not None:
            gain = gain_of_falling(scene, steps, work, count, scale + float(stored[:, 0].max()))
        return cls(
            problem=problem,
            scene=scene,
            course=course,
            steps=steps,
            energy=energy,
            dissipated=dissipated,
            broken=broken,
            reading=reading,
            scale=scale,
            gain=gain,
        )

    def response(self, options: Options, settings: Settings) -> Response:
        """The response of the run, with the samples, ledger and forces that the options ask for."""
        scene, course, steps, reading = self.scene, self.course, self.steps, self.reading
        t, pose, velocity, end = steps.sampled(course.duration, options.spacing, options.stride)
        plastic = self.plastic()
        return Response(
            case=self.problem.case,
            solver="MuJoCo",
            t=t,
            motion=SampledMotion(pose, velocity, np.interp(t, steps.t, self.energy)),
            outcome=reading.outcome,
            message=reading.message + ties_message(plastic),
            rocking=reading.rocking,
            joints=reading.joints,
            plastic=plastic,
            ledger=ledger(scene, course, steps).at(t) if options.ledger else None,
            stats=self.stats() | reading.stats | settings,
            end=end,
            kept_forces=kept_forces(self.problem.case, scene, steps, t, plastic) if options.forces else None,
        )

    def plastic(self) -> dict[str, Plastic]:
        """How far each tie has yielded, and whether it has broken, when the duration is over."""
        steps, links, duration = self.steps, self.scene.links.sprung, self.course.duration
        energy = np.array([np.interp(duration, steps.t, dissipated) for dissipated in self.dissipated.T])
        when = np.append(steps.windows.t, np.inf)[np.minimum(self.broken, len(steps.t))]
        when[when > duration] = np.inf
        broke = np.isfinite(when)
        strength = links.law["strength"]
        energy[broke] = (strength * links.law["ultimate"])[broke]
        lost = np.where(broke, 0.5 * strength**2 / links.law["k"], 0.0)
        return plastic_of(self.scene, elongation=energy / strength, energy=energy, broken=when, lost=lost)

    def stats(self) -> Settings:
        """Numbers of the steps and the contacts, for the `stats` of a response."""
        scene, steps, contacts = self.scene, self.steps, self.scene.contacts
        stats: Settings = {
            "steps": len(steps.t),
            "longest_timestep": float(steps.h.max()),
            "sound_timestep": sound_timestep(scene.highest_frequency),
            "touches": steps.touches,
        }
        if self.reading.joints is None:
            deepest = -gaps(scene.places, steps.pose).min(axis=0)
            for joint, name in enumerate(contacts.joints):
                stats[f"deepest_{name}"] = float(max(0.0, *deepest[contacts.joint == joint]))
        return stats


def marks_of(reading: Reading, steps: Steps) -> Integers:
    """The windows between which no energy may appear, in order, until the wall cannot come back or a block falls.

    They are those in which the peaks of a wall lie, and MARKS of masonry. What a fall of a wall releases dwarfs the
    energy it was released with.
    """
    last, times = reading.count - 1, reading.peak_times
    if times is None:
        return np.linspace(0, last, min(reading.count, MARKS)).astype(int)
    peaks = np.searchsorted(steps.windows.t, times[times <= steps.t[last]])
    return np.unique(np.concatenate([[0], np.minimum(peaks, last), [last]]))


def gain_of_falling(scene: Scene, steps: Steps, work: Array, count: int, scale: float) -> StepError | None:
    """Energy that has appeared from nowhere in masonry after its first block fell, or None.

    Args:
        scene, steps, work: as of `balance`.
        count: how many steps come before that.
        scale: the energy there was, with that of the fall [J].
    """
    marks = np.linspace(count, len(steps.t) - 1, min(len(steps.t) - count, MARKS)).astype(int)
    if len(marks):
        try:
            require_no_gain(steps.windows.t[marks], balance(scene, steps, work, marks), scale)
        except StepError as gain:
            return gain
    return None


def balance(scene: Scene, steps: Steps, work: Array, marks: Integers) -> Array:
    """Energy that is there and was taken less the work of the ground, at the start of some windows [J], shape (marks,).

    In a window energy and work belong to the same time. Neighbouring windows are not compared, since a touch inside a
    step misplaces energy while the contact lasts. What counts is whether an impact as a whole has lost or gained.

    Args:
        scene, steps: the run.
        work: of the ground in each window [J], see `ground_work`.
        marks: which windows, in order.
    """
    windows = steps.windows
    yields = bool(np.isfinite(scene.links.sprung.law["strength"]).any())  # a tie yields between the marks too
    at = np.arange(marks[-1] + 1) if yields else marks
    broken = (breaks(scene.ties, steps.pose),) if yields else ()
    stored, dissipated = scene.accounts(windows.pose[at], windows.velocity[at], *broken)
    balance_at = stored.sum(axis=1) + dissipated.sum(axis=1) - np.append(0.0, np.cumsum(work))[at]
    return np.asarray(balance_at[marks] if yields else balance_at)


def simulation_error(error: StepError, scene: Scene, h: float, accuracy: float | None) -> SimulationError:
    """The error for the user: what happened and what to change."""
    sound = sound_timestep(scene.highest_frequency)
    if accuracy is not None:
        advice = f"give an accuracy below {accuracy:.3g}, or fix the step: the largest sound one is {sound:.3g} s"
    elif h > sound * (1 + 1e-9):
        advice = f"the largest sound step is {sound:.3g} s"
    else:
        advice = "the step is sound: the contacts are too stiff or too little damped for it; halve it"
    if accuracy is None and scene.limits.damped_joints and h * scene.highest_frequency > SLIDING_STABLE:
        advice = (
            f"joints that slide are unstable at a fixed step beyond {SLIDING_STABLE / scene.highest_frequency:.3g} s "
            f"(omega h = {SLIDING_STABLE:g}, omega the highest frequency of the closed contacts); {advice}"
        )
    return SimulationError(f"{error} at t = {error.t:.4g} s with a step of {h:.3g} s; {advice}")
