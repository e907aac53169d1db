"""What the joints of masonry do in a run: how far they open and slide, and when their blocks part."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.frames import frames_of, inverse_rotation_change, take_frames
from ..geometry.kinematics import Meeting, Places, meeting
from ..geometry.vectors import Vector, dot, minus, plus, scaled, vector
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.histories import Support
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.standing import MasonryStanding, travels
from ..quantities import Array, Flags, Integers
from ..scene.scene import Scene
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


def in_parts(pose: Array, shift: Array, joints: int, look: Callable[[Array, Array], JointRecord]) -> JointRecord:
    """What joints did at poses, looked at a part of the steps at a time.

    `look` takes the poses of some steps and where supports are then, and gives what the joints do at each: all but
    `deepest` has the shape (steps, joints).
    """
    opening, sliding, deepest = np.zeros(joints), np.zeros(joints), 0.0
    off, parted = np.zeros((2, len(pose), joints), dtype=bool)
    size = max(1, AT_ONCE // max(1, joints))
    for first in range(0, len(pose), size):
        some = slice(first, first + size)
        seen = look(np.ascontiguousarray(pose[some]), np.ascontiguousarray(shift[some]))
        opening, sliding = np.maximum(opening, seen.opening.max(axis=0)), np.maximum(sliding, seen.sliding.max(axis=0))
        off[some], parted[some] = seen.off, seen.parted
        deepest = max(deepest, seen.deepest)
    return JointRecord(opening, sliding, deepest, off, parted)


def joint_motion(case: MasonryCase, scene: Scene, t: Array, pose: Array) -> JointRecord:
    """What the joints of masonry did, as seen from the supports that move.

    The blocks of a joint have parted where one has slid by more than the width of the joint, or where their faces are
    apart by more than a tenth of this width at the nearest point.

    Args:
        case: the case, for the masonry and its supports.
        scene: of the case.
        t: times of the steps or samples [s], shape (steps,).
        pose: at these times, shape (steps, n nq).
    """
    masonry, points = case.masonry, JointPoints.of(case, scene)
    slid_off = _slid_off_in_space(case.standing) if masonry.in_space else _slid_off_in_plane(masonry)
    widths = np.array([each.width for each in masonry.joints])

    def look(some: Array, shift: Array) -> JointRecord:
        seen = _looked(scene, points, some, shift)
        (far, off), nearest = slid_off(seen.slid), seen.nearest
        parted = (far > widths) | (nearest > PARTED * widths)
        return JointRecord(seen.opened, far, max(0.0, -float(nearest.min())), off, parted)

    return in_parts(pose, displacements(case.supports, t, scene.freedom.translations), len(masonry.joints), look)


def slips(case: MasonryCase, scene: Scene, t: Array, pose: Array) -> Array:
    """How far the block above each joint has slid on the one below [m], shape (steps, joints, d)."""
    shift = displacements(case.supports, t, scene.freedom.translations)
    return _looked(scene, JointPoints.of(case, scene), np.ascontiguousarray(pose), shift).slid


def displacements(supports: Sequence[Support], t: Array, d: int) -> Array:
    """Where supports that move are at some times, from where they are drawn [m], shape (times, supports, d)."""
    moved = np.empty((len(t), len(supports), d))
    for i, support in enumerate(supports):
        moved[:, i] = support.at(t)
    return moved


SlidOff = Callable[[Array], tuple[Array, Flags]]
"""How far joints have slid [m], and whether one block has left the other, (steps, joints) each, from their slips."""


def _slid_off_in_plane(masonry: Masonry) -> SlidOff:
    ways = np.array([joint.along for joint in masonry.plane_joints])
    back, forth = np.array([joint.travel for joint in masonry.plane_joints]).T

    def slid_off(slid: Array) -> tuple[Array, Flags]:
        along = np.einsum("sji,ji->sj", slid, ways)
        return np.abs(along), (along > forth) | (along < -back)

    return slid_off


def _slid_off_in_space(standing: MasonryStanding) -> SlidOff:
    widths, faces = np.array([joint.width for joint in standing.joints]), standing.faces

    def slid_off(slid: Array) -> tuple[Array, Flags]:
        far = np.linalg.norm(slid, axis=2)
        off = far >= widths
        for j in np.flatnonzero(off.any(axis=0)):
            ways = slid[:, j] / np.maximum(far[:, j], widths[j])[:, None]
            off[:, j] &= far[:, j] > travels(faces[j], ways)
        return far, off

    return slid_off


class JointPoints(NamedTuple):
    """The contact points of masonry as those of joints.

    Args:
        joint: the joint of each, shape (m,).
        at_rest: its place along its face at rest [m], shape (m, d).
        sign: 1 if the block above has it, or -1, shape (m,).
        support: number of the support that moves its face, -1 where none does, shape (m,).
    """

    joint: Integers
    at_rest: Array
    sign: Array
    support: Integers

    @classmethod
    def of(cls, case: MasonryCase, scene: Scene) -> JointPoints:
        """The points of a case."""
        masonry, places, joint = case.masonry, scene.places, scene.contacts.joint
        frames = frames_of(scene.at_rest.ravel(), places.freedom)
        above = np.array([each.above for each in masonry.joints])[joint] == np.array(masonry.free)[places.body]
        at_rest = np.array([_along(places, i, meeting(places, i, frames), frames) for i in range(len(joint))])
        number = {masonry.names.index(support.block): i for i, support in enumerate(case.supports)}
        below = np.array([number.get(each.below, -1) for each in masonry.joints])  # a block above is never fixed
        support = np.where(places.face_body < 0, below[joint], -1)
        return cls(joint, at_rest, np.where(above, 1.0, -1.0), support)


class Looked(NamedTuple):
    """What joints do at some steps: the gap at the widest point and at the nearest [m], shape (steps, joints), and how
    far the block above has slid at the nearest [m], shape (steps, joints, d)."""

    opened: Array
    nearest: Array
    slid: Array


def _looked(scene: Scene, points: JointPoints, pose: Array, shift: Array) -> Looked:
    """What joints do at poses, shape (steps, n nq), with supports that are displaced [m], (steps, supports, d)."""
    size = len(pose), len(scene.contacts.joints)
    seen = Looked(np.empty(size), np.empty(size), np.empty((*size, scene.freedom.translations)))
    _look(scene.places, points, pose, shift, scene.freedom.frames(len(scene.bodies.names)), seen)
    return seen


@inlined
def _along(places: Places, i: int, meets: Meeting, frames: Array) -> Vector:
    """Where point i is along its face, from the origin of the face, in the axes of the face [m]."""
    along, face = minus(meets.across, scaled(meets.gap, meets.normal)), places.face_body[i]
    return along if face < 0 else plus(along, inverse_rotation_change(frames, face, along))


@inlined
def _met(places: Places, i: int, frames: Array, shift: Array, support: int) -> Meeting:
    """Where point i and its face meet, which a support may have moved."""
    meets = meeting(places, i, frames)
    if support < 0:
        return meets
    across = minus(meets.across, vector(shift, support, places.axes))
    return Meeting(dot(meets.normal, across), meets.normal, across, meets.arm, across)


@compiled
def _look(places: Places, points: JointPoints, pose: Array, shift: Array, frames: Array, seen: Looked) -> None:
    """Write what joints do, see `_looked`; `frames` is room for those of a pose."""
    opened, nearest, slid = seen
    for n in range(len(pose)):
        take_frames(pose[n], frames, places.axes)
        for j in range(opened.shape[1]):
            opened[n, j], nearest[n, j] = 0.0, np.inf
        for i in range(len(points.joint)):
            meets, j = _met(places, i, frames, shift[n], points.support[i]), points.joint[i]
            opened[n, j] = max(opened[n, j], meets.gap)
            if meets.gap < nearest[n, j]:
                nearest[n, j] = meets.gap
                along = _along(places, i, meets, frames)
                for axis in range(len(along)):
                    slid[n, j, axis] = points.sign[i] * (along[axis] - points.at_rest[i, axis])
