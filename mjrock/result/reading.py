"""Results read from a motion of a wall or of masonry on compliant contacts, whichever solver found it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..geometry.poses import angles, tilts
from ..problem.damping.contacts import Contacts, Uplift
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import Array, named
from ..scene.scene import Scene, liveliness
from .ending import Outcome, Standstill, ending, masonry_ending
from .joint_motion import (
    JointMotion,
    JointRecord,
    below_everything,
    fallen_blocks,
    in_order,
    joint_motion,
    left_joints,
    overhang_message,
    past_support,
    slips,
    sunk_ground,
)
from .motion import SampledMotion
from .rocking import Rocking, RotationHistory, rocking_history

TIME_AT_REST = 0.2
"""Duration from which on blocks that have left their joints may lie still [s]."""


@dataclass(frozen=True, eq=False)
class Reading:
    """Results that are read from a motion.

    Args:
        outcome, message: how it ended.
        rocking: impacts and peaks of a wall.
        joints: openings, slidings and falls of masonry.
        count: how many times come before the wall cannot come back, or before the first block falls.
        peak_times: times of the peaks of a wall [s].
        slip: of the base of a wall at each time over half its width [-], shape (n,).
        stats: numbers for the `stats` of the response.
    """

    outcome: Outcome
    message: str
    rocking: Rocking | None = None
    joints: JointMotion | None = None
    count: int = 0
    peak_times: Array | None = None
    slip: Array = field(default_factory=lambda: np.zeros(1))
    stats: dict[str, float] = field(default_factory=dict)


class ContactHistory(NamedTuple):
    """What a solver that finds all contacts knows of them beside the poses.

    Args:
        widest_gap: the widest gap of each contact in any step [m], shape (m,).
        has_left_joints: whether blocks have left joints.
        cracked: when each mortared joint that cracked did [s], by its name, the earliest first.
    """

    widest_gap: Array
    has_left_joints: bool
    cracked: Mapping[str, float]


def wall_reading(case: Case, contacts: Contacts, t: Array, motion: SampledMotion, *, released: bool = True) -> Reading:
    """Impacts, peaks and the ending of a wall. `released` is whether the motion starts with the release."""
    uplift, theta, omega = Uplift.from_case(case, contacts), motion.theta[:, 0], motion.velocity[:, 0, 2]
    rotation = RotationHistory(t, theta, omega, motion.energy)
    rocking = rocking_history(case, rotation, uplift, released=released)
    slip = motion.pose[:, 0, 0] - case.wall.pose(theta)[:, 0]
    return Reading(
        *ending(case, t, motion.pose[:, 0], motion.energy, uplift.energy, motion.velocity[-1, 0]),
        rocking=Rocking(rocking.impacts, rocking.peaks),
        count=case.returning(theta),
        peak_times=rocking.times,
        slip=slip / case.block.half_base,
        stats={"base_displacement": float(np.interp(case.duration, t, slip) - slip[0])},
    )


def masonry_reading(
    case: MasonryCase, scene: Scene, t: Array, motion: SampledMotion, history: ContactHistory | None = None
) -> Reading:
    """Openings, slidings and falls of masonry. Without `history` blocks meet at the joints at rest alone, whose faces
    have no end."""
    masonry, pose = case.masonry, motion.pose.reshape(len(t), -1)
    up = scene.freedom.translations - 1
    joints = joint_motion(case, scene, t, pose)
    drop = scene.at_rest[:, up] - motion.pose[:, :, up]
    below = drop - sunk_ground(masonry, case.supports, t)
    fallen = fallen_blocks(masonry, t, joints.parted, tilts(pose, scene.freedom), below)
    sizes = np.array([np.linalg.norm(outline, axis=1).max() for outline in scene.bodies.outlines])
    standstill = Standstill.of(scene.bodies.names, sizes, t, motion.pose, liveliness(scene, motion.velocity[-1]))
    quiet, opening = bool(abs(motion.energy[-1]) < scene.rest_energies[2]), joints.opening.copy()
    if history is None:
        fallen = _fallen_from_faces(case, scene, t, motion, joints, fallen)
        past = past_support(case.rest_geometry, joints, lambda steps: slips(case, scene, t[steps], pose[steps]))
        place = overhang_message({name: distance for name, distance in past.items() if name not in fallen})
    else:
        # where blocks have moved, the energy at rest is another one
        elsewhere = history.has_left_joints or bool(case.supports) or bool(case.actuators)
        quiet = quiet or (elsewhere and t[-1] > TIME_AT_REST)
        below_all = below_everything(masonry, case.supports, t, drop)
        place = f" Below all fixed blocks, past the edge of any ground: {named(below_all)}." if below_all else ""
        np.maximum.at(opening, scene.contacts.joint, history.widest_gap)
    end = min(float(t[-1]), case.duration)
    outcome, message = masonry_ending(fallen, standstill, quiet, end, everywhere=history is not None)
    return Reading(
        outcome,
        message + place,
        joints=JointMotion(opening, joints.sliding, fallen, {} if history is None else history.cracked),
        count=int(np.searchsorted(t, next(iter(fallen.values()), np.inf))),
        stats={"deepest": joints.deepest},
    )


def _fallen_from_faces(
    case: MasonryCase, scene: Scene, t: Array, motion: SampledMotion, joints: JointRecord, fallen: dict[str, float]
) -> dict[str, float]:
    """When each block fell [s], where one that has slid off its joints counts as fallen, and one that ended the run."""
    slid_off = left_joints(case.masonry, t, joints.off)
    first_fall = {name: min(slid_off.get(name, np.inf), fallen.get(name, np.inf)) for name in slid_off | fallen}
    early = t[-1] < case.duration - 0.5 * (t[-1] - t[-2:][0])  # fixed steps end with the one nearest to the duration
    return in_order(first_fall) or (_stopped_by(scene, motion.pose[-1], float(t[-1])) if early else {})


def _stopped_by(scene: Scene, last: Array, end: float) -> dict[str, float]:
    """When a run ended because a block went too far or turned over [s], by the name of the block."""
    freedom, first = scene.freedom, scene.at_rest
    shifted = np.hypot.reduce((last - first)[:, : freedom.translations], axis=1)
    distances = shifted + angles(last.ravel(), first.ravel(), freedom) * scene.bodies.extent
    threshold = 0.5 * distances.max()
    return {name: end for name, distance in zip(scene.bodies.names, distances, strict=True) if distance >= threshold}
