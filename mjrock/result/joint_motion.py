"""What the joints of masonry do in a run: how far they open and slide, and when they hold no longer."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..geometry.frames import frames_of, take_frames
from ..geometry.kinematics import Places, along, depth
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags, Integers
from .fallen import LOST

AT_ONCE = 1_000_000
"""Most gaps that are held at once while the joints of a run are looked at."""


class Followed(NamedTuple):
    """What joints did in a run.

    Args:
        opening, sliding: the largest of each joint [m], shape (joints,).
        deepest: the deepest penetration [m].
        lost: which joints hold no longer, shape (steps, joints).
    """

    opening: Array
    sliding: Array
    deepest: float
    lost: Flags


def in_parts(pose: Array, joints: int, look: Callable[[Array], Followed]) -> Followed:
    """What joints did at poses, looked at a part of the steps at a time.

    `look` takes the poses of some steps and gives what the joints do at each: opening, sliding and lost have the shape
    (steps, joints).
    """
    opening, sliding, deepest = np.zeros(joints), np.zeros(joints), 0.0
    lost = np.zeros((len(pose), joints), dtype=bool)
    size = max(1, AT_ONCE // max(1, joints))
    for first in range(0, len(pose), size):
        seen = look(np.ascontiguousarray(pose[first : first + size]))
        opening, sliding = np.maximum(opening, seen.opening.max(axis=0)), np.maximum(sliding, seen.sliding.max(axis=0))
        lost[first : first + size], deepest = seen.lost, max(deepest, seen.deepest)
    return Followed(opening, sliding, deepest, np.logical_or.accumulate(lost, axis=0))


def joint_motion(masonry: Masonry, places: Places, joint: Integers, start: Array, pose: Array) -> Followed:
    """What the joints of masonry did.

    Args:
        masonry: the masonry.
        places, joint: its contact lines, and the number of the joint of each.
        start: pose at rest, shape (n nq,).
        pose: of the steps or samples, shape (steps, n nq).
    """
    joints = masonry.plane_joints
    widths = np.array([joint.width for joint in joints])
    (back, forth), frames = np.array([joint.travel for joint in joints]).T, frames_of(start, places.freedom)
    at_rest = np.array([along(places, i, frames, start).place for i in range(len(joint))])  # of each line on its face

    def look(some: Array) -> Followed:
        opened, slid = np.empty((2, len(some), len(joints)))
        deepest = _look(places, Lines(joint, at_rest), some, frames, np.empty(len(joints)), opened, slid)
        return Followed(opened, np.abs(slid), deepest, (opened > LOST * widths) | (slid > forth) | (slid < -back))

    return in_parts(pose, len(joints), look)


class Lines(NamedTuple):
    """The joint of each contact line, and the place of the line on its face at rest [m], shape (m,) each."""

    joint: Integers
    at_rest: Array


@compiled
def _look(places: Places, lines: Lines, pose: Array, frames: Array, most: Array, opened: Array, slid: Array) -> float:
    """Write the opening of each joint at its widest line, and its sliding at its most pressed, shape (steps, joints).

    Returns the deepest penetration [m]. `most` is room for the deepest line of each joint, shape (joints,).
    """
    deepest = 0.0
    for n in range(len(pose)):
        take_frames(pose[n], frames, places.axes)
        for j in range(len(most)):
            most[j], opened[n, j], slid[n, j] = -np.inf, 0.0, 0.0
        for i in range(len(lines.joint)):
            pressed, j = depth(places, i, frames), lines.joint[i]
            opened[n, j] = max(opened[n, j], -pressed)
            if pressed > most[j]:
                most[j] = pressed
                slid[n, j] = along(places, i, frames, pose[n]).place - lines.at_rest[i]
                deepest = max(deepest, pressed)
    return deepest
