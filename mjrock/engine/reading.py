"""Reading: the peaks of a wall, or the openings and falls of masonry. All else of a run is the same for both."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from ..geometry.kinematics import gaps
from ..geometry.poses import angles, tilts
from ..problem.damping.contacts import Contacts, Uplift
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import laden
from ..problem.wall.case import Case
from ..quantities import Array, Integers
from ..result.ending import Outcome, ending, masonry_ending
from ..result.fallen import fallen_blocks, in_order, left_joints
from ..result.history import rocking_history
from ..result.joint_motion import joint_motion, slips
from ..result.joints import JointMotion
from ..result.overhang import past_support, told_of_overhang
from ..result.rocking import Rocking
from ..scene.course import Course
from ..scene.scene import Scene, is_quiet
from .record import Steps

MARKS = 1000
"""Times in a run of masonry between which no energy may appear."""


@dataclass(frozen=True, eq=False)
class Reading:
    """What is read from a motion.

    Args:
        outcome, message: how it ended.
        marks: windows of the steps between which no energy may appear, in order.
        count: how many steps come before the wall cannot come back, or before the first block falls.
        rocking: impacts and peaks of a wall.
        joints: openings, slidings and falls of masonry.
        stats: how far contacts went.
        slid: largest slip of the base of a wall since the release while it can still come back [m].
    """

    outcome: Outcome
    message: str
    marks: Integers
    count: int
    rocking: Rocking | None = None
    joints: JointMotion | None = None
    stats: dict[str, Any] = field(default_factory=dict)
    slid: float = 0.0


class Asked(Protocol):
    """A case, and how the motion of its bodies is read."""

    @property
    def case(self) -> Case | MasonryCase:
        """What was asked."""

    def read(self, scene: Scene, course: Course, steps: Steps, energy: Array) -> Reading:
        """Read a motion; `energy` is that at the steps above the scene at rest [J]."""


@dataclass(frozen=True)
class AskedWall:
    """A wall on its contacts."""

    case: Case
    contacts: Contacts

    def read(self, scene: Scene, course: Course, steps: Steps, energy: Array) -> Reading:
        """Peaks and impacts. No energy may appear from one peak to a later one."""
        case, uplift = self.case, Uplift.of(self.case, self.contacts)
        t, theta, omega = steps.t, steps.pose[:, 2], steps.velocity[:, 2]
        times, peaks, impacts = rocking_history(case, t, theta, omega, energy, uplift, released=course.released)
        # up to where the wall can still come back: what a fall releases dwarfs the energy it was released with
        count = case.returning(theta)
        met = np.searchsorted(steps.windows.t, times[times <= t[count - 1]])
        slip = steps.pose[:, 0] - case.wall.pose(theta)[:, 0]
        deepest, contacts = -gaps(scene.places, steps.pose).min(axis=0), scene.contacts
        stats = {"base_displacement": float(np.interp(case.duration, t, slip) - slip[0])}
        for joint, name in enumerate(contacts.joints):
            stats[f"deepest_{name}"] = float(max(0.0, *deepest[contacts.joint == joint]))
        return Reading(
            *ending(case, t, theta, energy, uplift.energy, steps.velocity[-1]),
            marks=np.unique(np.concatenate([[0], np.minimum(met, count - 1), [count - 1]])),
            count=count,
            rocking=Rocking(impacts, peaks),
            stats=stats,
            slid=float(np.abs(slip[:count] - slip[0]).max()),
        )


@dataclass(frozen=True)
class AskedMasonry:
    """Masonry on its joints."""

    case: MasonryCase

    def read(self, scene: Scene, course: Course, steps: Steps, energy: Array) -> Reading:
        """Openings, slidings and falls. No energy may appear from one of MARKS times to a later one before a fall."""
        masonry, t = self.case.masonry, steps.t
        up = scene.freedom.translations - 1
        motion = joint_motion(masonry, scene.places, scene.contacts.joint, scene.at_rest.ravel(), steps.pose)
        drop = scene.at_rest[:, up] - steps.pose[:, up :: scene.freedom.nq]
        left = left_joints(masonry, t, motion.off)
        fell = fallen_blocks(masonry, t, motion.parted, tilts(steps.pose, scene.freedom), drop)
        both = {name: min(left.get(name, np.inf), fell.get(name, np.inf)) for name in left | fell}
        fallen = in_order(both) or left_behind(scene, course, steps)
        count = int(np.searchsorted(t, next(iter(fallen.values()), np.inf)))
        quiet = is_quiet(scene, float(energy[-1]), steps.velocity[-1].reshape(len(scene.bodies.names), -1))
        outcome, message = masonry_ending(fallen, quiet, min(float(t[-1]), course.duration))
        past = past_support(
            masonry,
            laden(masonry, self.case.effects)[1],
            motion,
            lambda some: slips(masonry, scene.places, scene.contacts.joint, scene.at_rest.ravel(), steps.pose[some]),
        )
        return Reading(
            outcome,
            message + told_of_overhang({name: far for name, far in past.items() if name not in fallen}),
            marks=np.linspace(0, count - 1, min(count, MARKS)).astype(int),
            count=count,
            joints=JointMotion(motion.opening, motion.sliding, fallen),
            stats={"deepest": motion.deepest},
        )


def left_behind(scene: Scene, course: Course, steps: Steps) -> dict[str, float]:
    """When a run ended that a block left by going too far or turning over [s], by the name of each that did."""
    end = float(steps.t[-1])
    if end >= course.duration - 0.5 * float(steps.h[-1]):
        return {}
    freedom = scene.freedom
    last, first = steps.pose[-1].reshape(-1, freedom.nq), scene.at_rest
    shifted = np.hypot.reduce((last - first)[:, : freedom.translations], axis=1)
    far = shifted + angles(last.ravel(), first.ravel(), freedom) * scene.bodies.extent
    return {name: end for name, distance in zip(scene.bodies.names, far, strict=True) if distance >= 0.5 * far.max()}
