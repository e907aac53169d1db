"""Masonry in MuJoCo: step its scene, and turn what it did into a response."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from ..compiled import compiled
from ..problem.masonry_case import MasonryCase
from ..problem.quantities import Array, Flags, Integers, require_flag, require_size, require_within
from ..result.masonry import LOST, MasonryResponse, fallen_blocks, masonry_ending
from ..result.response import State
from .accounts import ground_work, ledger
from .attempts import fitted, fixed, require_coulomb, required_start, stride_of
from .caveats import warn_if_coarse, warn_if_lifted
from .kinematics import Points, along, depth, take_frame
from .masonry import masonry_scene
from .mjcf import pair_rows
from .run import ENERGY_GAIN, own_energy, plastic_of, told
from .scene import Scene
from .steps import StepError, Steps

AT_ONCE = 1_000_000
"""Most gaps that are held at once while the joints of a run are looked at."""
MARKS = 1000
"""Times in a run between which no energy may appear."""


class MasonryRun:
    """One run of the engine, checked: its steps, its energy, and what its joints did.

    Raises:
        StepError: if energy appears from nowhere before the first block falls.
    """

    def __init__(self, case: MasonryCase, scene: Scene, steps: Steps) -> None:
        self.case, self.scene, self.steps = case, scene, steps
        stored, taken = scene.accounts(steps.pose, steps.velocity)
        self.energy = stored.sum(axis=1) - scene.rest_energies.sum()
        self.plastic = plastic_of(scene, steps.t, taken, case.duration)
        self.opening, self.sliding, self.deepest, lost = joint_motion(case, scene, steps)
        sizes = np.array([case.masonry.blocks[i].size for i in case.masonry.free])
        drop = (scene.at_rest[:, 1] - steps.pose[:, 1::3]) / sizes
        self.fallen = fallen_blocks(case.masonry, steps.t, lost, drop) or self._left_behind()
        self._require_no_gain()

    def _left_behind(self) -> dict[str, float]:
        """When a run ended that a block left by going too far or turning over [s], by the name of each that did."""
        end = float(self.steps.t[-1])
        if end >= self.case.duration - 0.5 * float(self.steps.h[-1]):
            return {}
        moved = self.steps.pose[-1].reshape(-1, 3) - self.scene.at_rest
        far = np.hypot(moved[:, 0], moved[:, 1]) + np.abs(moved[:, 2]) * self.scene.extent
        names = self.scene.names
        return {name: end for name, gone in zip(names, far, strict=True) if gone >= 0.5 * far.max()}

    def _require_no_gain(self) -> None:
        """Raise a StepError where the energy, less the work of the ground, has grown from one mark to a later one.

        Marks are MARKS of the seams of the leapfrog's windows, where energy and work belong to the same time.
        """
        until = next(iter(self.fallen.values()), math.inf)
        count = int(np.searchsorted(self.steps.t, until))
        work = ground_work(self.scene, self.steps)[:count]
        marks = np.linspace(0, count - 1, min(count, MARKS)).astype(int)
        own = own_energy(self.scene, self.steps, work, marks)
        gains = own - np.minimum.accumulate(own)
        worst = int(gains.argmax())
        released, elastic = float(self.energy[0]), float(self.scene.rest_energies[2])
        scale = released + float(np.abs(work).sum()) + elastic
        if not gains[worst] <= ENERGY_GAIN * scale:
            raise StepError(
                f"{gains[worst]:.3g} J, {gains[worst] / scale:.2%} of the energy there was, appeared from nowhere",
                float(self.steps.t[marks[worst]]),
            )

    @property
    def quiet(self) -> bool:
        """Whether the energy left at the end opens no joint: it is less than that of the springs at rest.

        A structure that is falling has less energy than at rest, and is not quiet.
        """
        return bool(abs(self.energy[-1]) < self.scene.rest_energies[2])

    def response(self, spacing: float | None, stride: int, want_ledger: bool, stats: dict[str, Any]) -> MasonryResponse:
        """What was found: samples `spacing` apart, or every `stride`-th step where that is None; `stats` says how."""
        case, steps, scene = self.case, self.steps, self.scene
        t, pose, velocity, end = steps.sampled(case.duration, spacing, stride)
        outcome, message = masonry_ending(self.fallen, self.quiet, min(float(steps.t[-1]), case.duration))
        return MasonryResponse(
            case=case,
            solver="MuJoCo",
            t=t,
            pose=pose,
            velocity=velocity,
            energy=np.interp(t, steps.t, self.energy),
            opening=self.opening,
            sliding=self.sliding,
            fallen=self.fallen,
            outcome=outcome,
            message=message,
            plastic=self.plastic,
            ledger=ledger(scene, steps).at(t) if want_ledger else None,
            stats=told(scene, steps) | {"deepest": self.deepest} | stats,
            end=end,
        )


def joint_motion(case: MasonryCase, scene: Scene, steps: Steps) -> tuple[Array, Array, float, Flags]:
    """Largest opening and sliding of each joint [m], the deepest penetration [m], and which joints hold no longer.

    The last has the shape (steps, joints).
    """
    joints = case.masonry.joints
    number = {joint.name: i for i, joint in enumerate(joints)}
    of, widths = np.array([number[name] for name in scene.group]), np.array([joint.width for joint in joints])
    opening, sliding, deepest = np.zeros(len(joints)), np.zeros(len(joints)), 0.0
    lost, (back, forth) = np.zeros((len(steps.t), len(joints)), dtype=bool), np.array([j.travel for j in joints]).T
    frame = np.empty((len(scene.names), 4))
    rest = np.zeros(len(of))
    start = scene.at_rest.reshape(1, -1)
    for i in range(len(of)):  # where each line stands on its face at rest
        take_frame(start[0], frame)
        rest[i] = along(scene.points, i, frame, start[0])[0]
    size = max(1, AT_ONCE // max(1, len(joints)))
    for first in range(0, len(steps.t), size):
        pose = steps.pose[first : first + size]
        room = np.empty((2, len(pose), len(joints)))
        deepest = max(deepest, _look(scene.points, of, rest, pose, frame, np.empty((2, len(joints))), *room))
        opening, sliding = np.maximum(opening, room[0].max(axis=0)), np.maximum(sliding, np.abs(room[1]).max(axis=0))
        lost[first : first + size] = (room[0] > LOST * widths) | (room[1] > forth) | (room[1] < -back)
    gone: Flags = np.logical_or.accumulate(lost, axis=0)
    return opening, sliding, deepest, gone


@compiled
def _look(
    points: Points, of: Integers, rest: Array, pose: Array, frame: Array, most: Array, opened: Array, slid: Array
) -> float:
    """Write the opening of each joint at its widest line, and its sliding at its most pressed, shape (steps, joints).

    Returns the deepest penetration [m].
    """
    deepest = 0.0
    for n in range(len(pose)):
        take_frame(pose[n], frame)
        for j in range(opened.shape[1]):
            most[0, j], opened[n, j], slid[n, j] = -np.inf, 0.0, 0.0
        for i in range(len(of)):
            pressed, j = depth(points, i, frame), of[i]
            opened[n, j] = max(opened[n, j], -pressed)
            if pressed > most[0, j]:
                most[0, j] = pressed
                slid[n, j] = along(points, i, frame, pose[n])[0] - rest[i]
                deepest = max(deepest, pressed)
    return deepest


def simulate_masonry(
    case: MasonryCase,
    timestep: float | None,
    accuracy: float,
    newmark_beta: float,
    coulomb: bool | None,
    output_step: float | None,
    want_ledger: bool,
    start: object,
) -> MasonryResponse:
    """What `simulate` does with masonry; the arguments are its."""
    begun = time.perf_counter()
    accuracy = require_within("accuracy", accuracy, 1e-8, 0.1)
    newmark_beta = require_within("newmark_beta", newmark_beta, 0.0, 10.0)
    require_flag("ledger", want_ledger)
    require_coulomb(coulomb)
    if output_step is not None:
        output_step = require_within("output_step", output_step, 1e-9, case.duration, "s")
    bodies, scene = len(case.masonry.free), masonry_scene(case)
    begin = scene.started if start is None else _required_state(start, bodies, case)

    def judge(steps: Steps) -> MasonryRun:
        return MasonryRun(case, scene, steps)

    if timestep is None:
        spacing = output_step or 1e-3
        require_size("the samples of this answer", case.duration / spacing, "raise output_step or follow it for less")
        run, settings = fitted(scene, begin, accuracy, coulomb, judge)
        made = run.response(spacing, 1, want_ledger, settings)
    else:
        timestep = require_within("timestep", timestep, 1e-9, 1.0, "s")
        require_size("the steps of this run", case.duration / timestep, "take a longer timestep, or fitted steps")
        warn_if_coarse(scene, timestep)
        rows = pair_rows(scene, timestep, newmark_beta)
        run, settings = fixed(scene, begin, timestep, newmark_beta, rows, coulomb, judge)
        if coulomb is not True:
            warn_if_lifted(scene, run.steps)
        made = run.response(None, stride_of(output_step, timestep), want_ledger, settings)
    made.stats["wall_time"] = time.perf_counter() - begun
    return made


def _required_state(start: object, bodies: int, case: MasonryCase) -> State:
    """A start as pose and velocity of all bodies, none of them out of any proportion."""
    pose, velocity = required_start(start, bodies, case.effects)
    for name, values in (("pose", pose), ("velocity", velocity)):
        require_within(f"start, largest of {name}", float(np.abs(values).max()), 0.0, 1e3)
    return pose, velocity
