"""What the joints of masonry do in a run: how far they open and slide, and when their blocks part."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.frames import frames_of, inverse_rotation_change, take_frames
from ..geometry.kinematics import Places, meeting
from ..geometry.vectors import Vector, minus, plus, scaled
from ..problem.masonry.faces_of_joints import faces_of_joints, travels
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags, Integers
from .fallen import PARTED

AT_ONCE = 1_000_000
"""Most gaps that are held at once while the joints of a run are looked at."""


class JointRecord(NamedTuple):
    """What joints did in a run.

    Args:
        opening, sliding: the largest of each joint [m], shape (joints,).
        deepest: the deepest penetration [m].
        off: whether one block of each joint has slid off the other, shape (steps, joints).
        parted: whether each joint holds nothing any more, of the same shape, see `joint_motion`.
    """

    opening: Array
    sliding: Array
    deepest: float
    off: Flags
    parted: Flags


def in_parts(pose: Array, joints: int, look: Callable[[Array], JointRecord]) -> JointRecord:
    """What joints did at poses, looked at a part of the steps at a time.

    `look` takes the poses of some steps and gives what the joints do at each: all but `deepest` has the shape (steps,
    joints).
    """
    opening, sliding, deepest = np.zeros(joints), np.zeros(joints), 0.0
    off, parted = np.zeros((2, len(pose), joints), dtype=bool)
    size = max(1, AT_ONCE // max(1, joints))
    for first in range(0, len(pose), size):
        seen = look(np.ascontiguousarray(pose[first : first + size]))
        opening, sliding = np.maximum(opening, seen.opening.max(axis=0)), np.maximum(sliding, seen.sliding.max(axis=0))
        off[first : first + size], parted[first : first + size] = seen.off, seen.parted
        deepest = max(deepest, seen.deepest)
    return JointRecord(opening, sliding, deepest, off, parted)


def joint_motion(masonry: Masonry, places: Places, joint: Integers, start: Array, pose: Array) -> JointRecord:
    """What the joints of masonry did.

    The blocks of a joint have parted where one has slid by more than the width of the joint, or where their faces are
    apart by more than a tenth of this width at the nearest point.

    Args:
        masonry: the masonry.
        places, joint: its contact points, and the number of the joint of each.
        start: pose at rest, shape (n nq,).
        pose: of the steps or samples, shape (steps, n nq).
    """
    joints, frames = masonry.joints, frames_of(start, places.freedom)
    points = JointPoints.of(masonry, places, joint, frames)
    slid_off = _slid_off_in_space(masonry) if masonry.in_space else _slid_off_in_plane(masonry)
    widths = np.array([each.width for each in joints])

    def look(some: Array) -> JointRecord:
        opened, nearest, slid = _looked(places, points, some, frames, len(joints))
        far, off = slid_off(slid)
        return JointRecord(
            opened, far, max(0.0, -float(nearest.min())), off, (far > widths) | (nearest > PARTED * widths)
        )

    return in_parts(pose, len(joints), look)


def slips(masonry: Masonry, places: Places, joint: Integers, start: Array, pose: Array) -> Array:
    """How far the block above each joint has slid on the one below [m], shape (steps, joints, d)."""
    frames = frames_of(start, places.freedom)
    points = JointPoints.of(masonry, places, joint, frames)
    return _looked(places, points, np.ascontiguousarray(pose), frames, len(masonry.joints))[2]


SlidOff = Callable[[Array], tuple[Array, Flags]]
"""How far joints have slid [m], and whether one block has left the other, (steps, joints) each, from their slips."""


def _slid_off_in_plane(masonry: Masonry) -> SlidOff:
    ways = np.array([joint.along for joint in masonry.plane_joints])
    back, forth = np.array([joint.travel for joint in masonry.plane_joints]).T

    def slid_off(slid: Array) -> tuple[Array, Flags]:
        along = np.einsum("sji,ji->sj", slid, ways)
        return np.abs(along), (along > forth) | (along < -back)

    return slid_off


def _slid_off_in_space(masonry: Masonry) -> SlidOff:
    widths, faces = np.array([joint.width for joint in masonry.joints]), faces_of_joints(masonry)

    def slid_off(slid: Array) -> tuple[Array, Flags]:
        far = np.linalg.norm(slid, axis=2)
        off = far >= widths
        for j in np.flatnonzero(off.any(axis=0)):
            ways = slid[:, j] / np.maximum(far[:, j], widths[j])[:, None]
            off[:, j] &= far[:, j] > travels(faces[j], ways)
        return far, off

    return slid_off


class JointPoints(NamedTuple):
    """The joint of each contact point, its place along its face at rest [m], and 1 if the block above has it, or -1."""

    joint: Integers
    at_rest: Array
    sign: Array

    @classmethod
    def of(cls, masonry: Masonry, places: Places, joint: Integers, frames: Array) -> JointPoints:
        """The points of masonry, with the number of the joint of each, and the frames at rest."""
        above = np.array([each.above for each in masonry.joints])[joint] == np.array(masonry.free)[places.body]
        at_rest = np.array([_along(places, i, frames) for i in range(len(joint))])
        return cls(joint, at_rest, np.where(above, 1.0, -1.0))


def _looked(places: Places, points: JointPoints, pose: Array, frames: Array, joints: int) -> tuple[Array, Array, Array]:
    """The gap of each joint at its widest point and at its nearest, and how far the block above has slid there."""
    opened, nearest = np.empty((2, len(pose), joints))
    slid = np.empty((len(pose), joints, points.at_rest.shape[1]))
    _look(places, points, pose, frames, opened, nearest, slid)
    return opened, nearest, slid


@inlined
def _along(places: Places, i: int, frames: Array) -> Vector:
    """Where point i is along its face, from the origin of the face, in the axes of the face [m]."""
    meets, face = meeting(places, i, frames), places.face_body[i]
    along = minus(meets.across, scaled(meets.gap, meets.normal))
    return along if face < 0 else plus(along, inverse_rotation_change(frames, face, along))


@compiled
def _look(
    places: Places, points: JointPoints, pose: Array, frames: Array, opened: Array, nearest: Array, slid: Array
) -> None:
    """Write the gap of each joint at its widest point and at its nearest, and how far the block above has slid there.

    Args:
        places, points: the points.
        pose: of the steps, shape (steps, n nq).
        frames: room for the frames of a pose.
        opened, nearest, slid: shapes (steps, joints), the same and (steps, joints, d).
    """
    for n in range(len(pose)):
        take_frames(pose[n], frames, places.axes)
        for j in range(opened.shape[1]):
            opened[n, j], nearest[n, j] = 0.0, np.inf
        for i in range(len(points.joint)):
            gap, j = meeting(places, i, frames).gap, points.joint[i]
            opened[n, j] = max(opened[n, j], gap)
            if gap < nearest[n, j]:
                nearest[n, j] = gap
                along = _along(places, i, frames)
                for axis in range(len(along)):
                    slid[n, j, axis] = points.sign[i] * (along[axis] - points.at_rest[i, axis])
