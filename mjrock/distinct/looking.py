"""Which corners of blocks are near faces of other blocks, at a pose."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..quantities import Array, Flags, Integers


class Look(NamedTuple):
    """What is looked at for encounters, at the pose.

    Args:
        corners: of all blocks [m], shape (corners, d).
        first: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        normals, offsets: of the faces of all blocks, n and n.x of a point x on each [m], (faces, d) and (faces,).
        first_face: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        low, high: least and largest coordinates of each block [m], shape (blocks, d).
        order: the blocks by their low ends along the axis on which they are spread most, shape (blocks,).
        axis: its number.
        loose, fixed: which blocks have left their places, and which are fixed, shape (blocks,).
        held: pairs of blocks that have a joint, increasing, see `pair_number`.
        flush: difference of depths up to which faces count as equally near [m].
    """

    corners: Array
    first: Integers
    normals: Array
    offsets: Array
    first_face: Integers
    low: Array
    high: Array
    order: Integers
    axis: int
    loose: Flags
    fixed: Flags
    held: Integers
    flush: float


def pair_number(a: Integers, b: Integers, blocks: int) -> Integers:
    """One number for two blocks."""
    return np.asarray(np.minimum(a, b) * blocks + np.maximum(a, b), dtype=np.int64)


@jitable
def among(values: Integers, number: int) -> bool:
    """Whether a number is among increasing values."""
    low, high = 0, len(values)
    while low < high:
        middle = (low + high) // 2
        if values[middle] < number:
            low = middle + 1
        else:
            high = middle
    return low < len(values) and values[low] == number


@jitable
def gap_to(look: Look, face: int, corner: int) -> float:
    """Distance of a corner from the plane of a face [m]."""
    gap: float = -look.offsets[face]
    for i in range(look.corners.shape[1]):
        gap += look.normals[face, i] * look.corners[corner, i]
    return gap


@jitable
def are_apart(look: Look, near: float, a: int, b: int) -> bool:
    """Whether two blocks are farther apart than a distance along an axis [m]."""
    for i in range(look.low.shape[1]):
        if look.low[a, i] > look.high[b, i] + near or look.low[b, i] > look.high[a, i] + near:
            return True
    return False


@jitable
def meet_faces(look: Look, near: float, met: Array, count: int, p: int, q: int) -> int:
    """Write the faces of block q that corners of block p may come through: all that they are outside of.

    For a corner that is inside already, that is the face that it is nearest to, or the faces if several are so. Returns
    how many rows are written.
    """
    for corner in range(look.first[p], look.first[p + 1]):
        widest = -np.inf
        for face in range(look.first_face[q], look.first_face[q + 1]):
            widest = max(widest, gap_to(look, face, corner))
            if widest > near:
                break
        if widest > near:
            continue
        for face in range(look.first_face[q], look.first_face[q + 1]):
            gap = gap_to(look, face, corner)
            if gap > min(0.0, widest - look.flush) and count < len(met):
                met[count, 0], met[count, 1], met[count, 2], met[count, 3] = p, corner, q, face
                met[count, 4] = gap
                count += 1
    return count


@compiled
def near_corners(look: Look, near: float, met: Array) -> int:
    """Write corners nearer than `near` [m] to other blocks: block, corner, other block, face, gap [m].

    Returns:
        How many there are, at most as many as there is room for.
    """
    order, blocks, count = look.order, len(look.order), 0
    for turn in range(blocks):
        a = order[turn]
        for other in range(turn + 1, blocks):
            b = order[other]
            if look.low[b, look.axis] > look.high[a, look.axis] + near:
                break
            if not (look.loose[a] or look.loose[b]) or are_apart(look, near, a, b):
                continue
            if among(look.held, min(a, b) * blocks + max(a, b)):
                continue
            if not look.fixed[a]:
                count = meet_faces(look, near, met, count, a, b)
            if not look.fixed[b]:
                count = meet_faces(look, near, met, count, b, a)
    return count
