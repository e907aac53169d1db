"""The whole faces of blocks in space that make a joint, of which the joint covers a part."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...quantities import Array
from .joints_in_space import Face, SpaceJoint, faces_of
from .masonry import Masonry

FACING = 0.99
"""Least cosine of the angle between the normal of a joint and that of the face of a block that makes it [-]."""


def faces_of_joints(masonry: Masonry) -> tuple[tuple[Face, Face], ...]:
    """Of each joint of masonry in space, the face of the block below and that of the block above."""
    faces = [faces_of(block) for block in masonry.polyhedra]
    return tuple(
        (_towards(faces[joint.below], joint.normal, joint), _towards(faces[joint.above], -joint.normal, joint))
        for joint in masonry.space_joints
    )


def _towards(faces: Sequence[Face], outwards: Array, joint: SpaceJoint) -> Face:
    """The face of a block that makes a joint, whose normal out of the block is given."""
    apart = [abs(float(outwards @ (face.corners.mean(axis=0) - joint.middle))) for face in faces]
    facing = np.array([face.normal @ outwards for face in faces]) > FACING
    return faces[int(np.argmin(np.where(facing, apart, np.inf)))]


def travels(faces: tuple[Face, Face], ways: Array) -> Array:
    """How far the face above can slide along unit vectors until it has left the face below [m], shape (n,).

    The two faces then touch along a line square to the way at most.
    """
    below, above = faces
    return np.asarray((below.corners @ ways.T).max(axis=0) - (above.corners @ ways.T).min(axis=0))
