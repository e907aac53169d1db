"""What the joints of masonry in space do in a run: how far they open and slide, and when they hold no longer."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled, jitable
from ..geometry.frames import frames_of, take_frames, unswung
from ..geometry.kinematics import Places, meeting
from ..geometry.vectors import Vector, minus, plus, scaled
from ..problem.masonry.faces_of_joints import faces_of_joints, travels
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Integers
from .fallen import LOST
from .joint_motion import Followed, in_parts


def joint_motion_in_space(masonry: Masonry, places: Places, joint: Integers, start: Array, pose: Array) -> Followed:
    """What the joints of masonry in space did.

    A joint holds no longer when it has opened by 0.7 of its width, or when one block has slid off the other.

    Args:
        masonry: the masonry.
        places, joint: its contact points, and the number of the joint of each.
        start: pose at rest, shape (7 n,).
        pose: of the steps or samples, shape (steps, 7 n).
    """
    joints = masonry.joints
    widths = np.array([joint.width for joint in joints])
    faces, frames = faces_of_joints(masonry), frames_of(start, places.freedom)
    at_rest = np.array([_along(places, i, frames) for i in range(len(joint))])
    free = np.array(masonry.free)
    above = np.array([joint.above for joint in joints])[joint] == free[places.body]
    at_rest_and_sign = np.column_stack([at_rest, np.where(above, 1.0, -1.0)])

    def look(some: Array) -> Followed:
        opened, slid = np.empty((len(some), len(joints))), np.empty((len(some), len(joints), 3))
        deepest = _look(places, joint, at_rest_and_sign, some, (frames, np.empty(len(joints))), opened, slid)
        far, gone = np.linalg.norm(slid, axis=2), opened > LOST * widths
        for j in np.flatnonzero((far >= widths).any(axis=0)):
            ways = slid[:, j] / np.maximum(far[:, j], widths[j])[:, None]
            gone[:, j] |= (far[:, j] >= widths[j]) & (far[:, j] > travels(faces[j], ways))
        return Followed(opened, far, deepest, gone)

    return in_parts(pose, len(joints), look)


@jitable
def _along(places: Places, i: int, frames: Array) -> Vector:
    """Where point i is along its face, from the origin of the face, in the axes of the face [m]."""
    meets, face = meeting(places, i, frames), places.face_body[i]
    along = minus(meets.across, scaled(meets.gap, meets.normal))
    return along if face < 0 else plus(along, unswung(frames, face, along))


@compiled
def _look(
    places: Places, joint: Integers, rest: Array, pose: Array, room: tuple[Array, Array], opened: Array, slid: Array
) -> float:
    """Write the opening of each joint at its widest point, and how far the block above has slid at its most pressed.

    Args:
        places: the points.
        joint: of each point, shape (m,).
        rest: place of each point along its face at rest, and 1 for a point of the block above, or -1, shape (m, 4).
        pose: of the steps, shape (steps, 7 n).
        room: for the frames of a pose, and for the deepest point of each joint, shape (joints,).
        opened, slid: shape (steps, joints) and (steps, joints, 3).

    Returns:
        The deepest penetration [m].
    """
    deepest, (frames, most) = 0.0, room
    for n in range(len(pose)):
        take_frames(pose[n], frames, places.axes)
        for j in range(opened.shape[1]):
            opened[n, j], most[j] = 0.0, -np.inf
        for i in range(len(joint)):
            gap, j = meeting(places, i, frames).gap, joint[i]
            opened[n, j] = max(opened[n, j], gap)
            if -gap > most[j]:
                most[j] = -gap
                along = _along(places, i, frames)
                for axis in range(3):
                    slid[n, j, axis] = rest[i, 3] * (along[axis] - rest[i, axis])
                deepest = max(deepest, -gap)
    return deepest
