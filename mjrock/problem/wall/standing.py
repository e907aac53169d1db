"""What stands in a case at rest: solids with their faces, and joints with their axes; those of a wall."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.hull import Faces, prism
from ...quantities import Array, Integers
from .block import Block


class Solid(NamedTuple):
    """A body at rest.

    Args:
        name: of the block, "wall", "base" or "side".
        block: number of its block, None of what a wall stands on or against.
        corners: about its centroid [m], shape (corners, 3).
        faces: numbers of the corners of each, counterclockwise as seen from outside.
        rest: its centroid [m], shape (3,).
        fixed: whether it is the ground, or a fixed block.
    """

    name: str
    block: int | None
    corners: Array
    faces: Faces
    rest: Array
    fixed: bool


class JointFrames(NamedTuple):
    """Joints at rest, in the order of their names, and what they join.

    Args:
        names: of the j joints.
        middle: of each [m], shape (j, d).
        axes: unit vectors, the normal out of what is below and then those along the joint, shape (j, d, d).
        below, above: numbers of the two bodies, -1 for what is fixed, shape (j,).
        fixed: number of the fixed block below, -1 where what is below is free, shape (j,).
        blocks: names of the fixed blocks.
        rest: centroids of the bodies at rest [m], shape (bodies, d).
    """

    names: tuple[str, ...]
    middle: Array
    axes: Array
    below: Integers
    above: Integers
    fixed: Integers
    blocks: tuple[str, ...]
    rest: Array

    @property
    def from_body(self) -> Array:
        """Of each joint on a body the vector from its centroid to the middle [m], and the axes, shape (j, 1 + d, d)."""
        arm = self.middle - np.where(self.below[:, None] < 0, 0.0, self.rest[self.below])
        return np.concatenate([arm[:, None], self.axes], axis=1)


def in_space(vectors: Array) -> Array:
    """Vectors of the plane x, z with y = 0, shape (..., 3); those of space as they are."""
    return vectors if vectors.shape[-1] == 3 else np.insert(vectors, 1, 0.0, axis=-1)


def solids_of_wall(wall: Block, stop_top: float | None) -> list[Solid]:
    """The wall without its openings, a slab below it, and where it has a side stop one beside it."""
    b, length, rest = wall.b, wall.length, np.array([wall.centroid_offset, 0.0, wall.centroid_height])
    outer = wall.outline[1:-1]
    if wall.gable is not None:
        z = np.sort(np.append(outer[:, 1], wall.front.eaves - rest[2]))
        outer = np.column_stack([np.interp(z, outer[:, 1], outer[:, 0]), z])
    inner = np.column_stack([np.full(len(outer), wall.outline[0, 0]), outer[:, 1]])
    corners, n = prism(np.concatenate([outer, inner[::-1]]), length)[0], 2 * len(outer)
    corners[:, 1] *= wall.front.long(corners[:, 2] + rest[2]) / length
    ends = [(i, i + 1, n - 2 - i, n - 1 - i) for i in range(len(outer) - 1)]  # the outline of a profile is not convex
    rim = [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]
    faces = (*ends, *(tuple(n + i for i in end[::-1]) for end in ends), *rim)
    solids = [Solid("wall", 0, corners, faces, rest, False)]
    slabs = {"base": (-3 * b, 3 * b, -b, 0.0)}
    slabs |= {} if stop_top is None else {"side": (-3 * b, -b, 0.0, stop_top)}
    for name, (left, right, low, high) in slabs.items():
        slab = prism(np.array([(left, low), (right, low), (right, high), (left, high)]), length)
        solids.append(Solid(name, None, *slab, np.zeros(3), True))
    return solids


def joints_of_wall(wall: Block, stop_top: float | None, rests: Array) -> JointFrames:
    """The base of a wall, and its side stop where it has one; its centroid at rest has the shape (1, 2) [m]."""
    sides = 1 if stop_top is None else 2
    middle = np.array([(0.0, 0.0), (-wall.b, 0.5 * (stop_top or 0.0))])[:sides]
    axes = np.array([[(0.0, 1.0), (1.0, 0.0)], [(1.0, 0.0), (0.0, -1.0)]])[:sides]
    names, numbers = ("base", "side")[:sides], np.arange(sides)
    return JointFrames(
        names,
        middle,
        axes,
        0 * numbers - 1,
        0 * numbers,
        numbers,
        names,
        np.array([[wall.centroid_offset, wall.centroid_height]]),
    )
