"""The whole faces of blocks in space that make a joint, of which the joint covers a part."""

from __future__ import annotations

import numpy as np

from ...quantities import Array
from .blocks.joints_in_space import Face, faces_of
from .masonry import Masonry


def faces_of_joints(masonry: Masonry) -> tuple[tuple[Face, Face], ...]:
    """Of each joint of masonry in space, the face of the block below and that of the block above."""
    faces = [faces_of(block.sides) for block in masonry.polyhedra]
    return tuple(
        (faces[joint.below][joint.sides[0]], faces[joint.above][joint.sides[1]]) for joint in masonry.space_joints
    )


def travels(faces: tuple[Face, Face], ways: Array) -> Array:
    """How far the face above can slide along unit vectors until it has left the face below [m], shape (n,).

    The two faces then touch along a line square to the way at most.
    """
    below, above = faces
    return np.asarray((below.corners @ ways.T).max(axis=0) - (above.corners @ ways.T).min(axis=0))
