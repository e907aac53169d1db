"""Joints of masonry: where edges of two blocks lie on one another, and the contact lines that they carry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...quantities import Array
from .polygon import Polygon
from .polyhedron import Polyhedron

SHORTEST = 10.0
"""Length of the shortest joint, over the tolerance [-]. Blocks that share less than this touch at a corner only."""
PARALLEL = 0.05
"""Largest sine of the angle between two edges that make a joint [-]."""
LEVEL = 1e-6
"""Largest |x| of the normal of a bed joint, and largest |z| of that of a head joint [-]."""


@dataclass(frozen=True)
class Joint:
    """Where two blocks meet along a line.

    Args:
        below, above: numbers of the two blocks. The normal points from `below` to `above`. Of the two blocks of a joint
            that is not vertical, `above` lies higher. A fixed block is always `below`.
        start, end: ends of the joint [m], with the normal to the left of the way from start to end.
        length: length out of the plane, that of the shorter block [m].
        travel: how far the block above can slide from end to start, and from start to end, before the two edges no
            longer overlap [m].
        corners: whether an end is a corner of the block above, for start and end.
        name: names of the two blocks with a | between them, the one below first.
    """

    below: int
    above: int
    start: tuple[float, float]
    end: tuple[float, float]
    length: float
    travel: tuple[float, float]
    corners: tuple[bool, bool]
    name: str

    @cached_property
    def width(self) -> float:
        """Length of the joint in the plane [m]."""
        return float(np.hypot(*np.subtract(self.end, self.start)))

    @property
    def area(self) -> float:
        """Area of the joint [m2]."""
        return self.width * self.length

    @property
    def middle(self) -> Array:
        """Middle of the joint [m], shape (2,)."""
        return 0.5 * np.add(self.start, self.end)

    @cached_property
    def along(self) -> Array:
        """Unit vector from start to end, shape (2,)."""
        return np.subtract(self.end, self.start) / self.width

    @property
    def normal(self) -> Array:
        """Unit vector from the block below to the block above, shape (2,)."""
        x, z = self.along
        return np.array([-z, x]) + 0.0  # no negative zeros

    @property
    def is_bed(self) -> bool:
        """Whether the joint is horizontal."""
        return bool(abs(self.normal[0]) < LEVEL)


def names_of(blocks: Sequence[Polygon | Polyhedron]) -> tuple[str, ...]:
    """Names of the blocks: their own, or `block_` and their number."""
    return tuple(block.name or f"block_{i}" for i, block in enumerate(blocks))


def joints_in_plane(blocks: Sequence[Polygon], tolerance: float) -> tuple[Joint, ...]:
    """The joints between blocks, in the order of the blocks. A ValueError names two that overlap.

    Two edges make a joint where they overlap along a line and are nowhere farther apart than the tolerance [m], which
    is the largest overlap of blocks too. The joint lies halfway between them. Two fixed blocks make none.
    """
    names, found = names_of(blocks), []
    for i, j in neighbours(blocks, tolerance):
        require_apart(names[i], names[j], _overlap(blocks[i], blocks[j]), tolerance)
        found += list(_between(blocks, (i, j), names, tolerance))
    return tuple(found)


def require_apart(name: str, other: str, deep: float, tolerance: float) -> None:
    """Raise a ValueError that names two blocks, if they overlap by more than the tolerance [m]."""
    if deep > tolerance:
        overlap = f"blocks {name} and {other} overlap by {deep:.3g} m"
        raise ValueError(f"{overlap}; the valid range is up to the tolerance, {tolerance:g} m")


def neighbours(blocks: Sequence[Polygon | Polyhedron], tolerance: float) -> list[tuple[int, int]]:
    """Pairs of blocks, not both fixed, whose bounding boxes touch."""
    low = np.array([block.corners.min(axis=0) for block in blocks]) - tolerance
    high = np.array([block.corners.max(axis=0) for block in blocks]) + tolerance
    pairs: list[tuple[int, int]] = []
    for i, block in enumerate(blocks):
        near = ((low[i] <= high[i + 1 :]) & (low[i + 1 :] <= high[i])).all(axis=1)
        others = (i + 1 + np.flatnonzero(near)).tolist()
        pairs += [(i, j) for j in others if not (block.fixed and blocks[j].fixed)]
    return pairs


def _overlap(block: Polygon, other: Polygon) -> float:
    """Depth by which two blocks overlap [m], negative where they are apart: least over the normals."""
    depths = [
        (a.corners @ a.normals.T).max(axis=0) - (b.corners @ a.normals.T).min(axis=0)
        for a, b in ((block, other), (other, block))
    ]
    return float(np.concatenate(depths).min())


def _between(
    blocks: Sequence[Polygon],
    pair: tuple[int, int],
    names: Sequence[str],
    tolerance: float,
) -> Iterator[Joint]:
    """The joints between two blocks."""
    i, j = pair
    (p, normals), (q, others) = ((blocks[number].corners, blocks[number].normals) for number in pair)
    sine = np.abs(np.outer(normals[:, 0], others[:, 1]) - np.outer(normals[:, 1], others[:, 0]))
    for edge, other in np.argwhere((normals @ others.T <= 0) & (sine <= PARALLEL)).tolist():
        a, b, n = p[edge], p[(edge + 1) % len(p)], normals[edge]
        c, d = q[other], q[(other + 1) % len(q)]
        way = (b - a) / np.hypot(*(b - a))
        first, last = (d - a) @ way, (c - a) @ way  # the other outline runs the other way
        long = float((b - a) @ way)
        low, high = max(0.0, first), min(long, last)
        if high - low <= SHORTEST * tolerance:
            continue
        rise = (c - d) @ n / (last - first)
        apart = np.array([(d - a) @ n + rise * (s - first) for s in (low, high)])
        if np.abs(apart).max() > tolerance:
            continue
        corners = (d, -0.5) if first > 0 else (a, 0.5), (c, -0.5) if last < long else (b, 0.5)  # without rounding
        ends = [corner + share * gap * n for (corner, share), gap in zip(corners, apart, strict=True)]
        # whichever of the two is above, it leaves the other after the same travel back and forth along the joint
        travel = (long - float(first), float(last))
        upwards = n[1] if abs(n[1]) > LEVEL else n[0]  # across a vertical joint, the block on the right counts as above
        below, above = (i, j) if upwards > 0 else (j, i)
        if blocks[above].fixed:
            below, above = above, below
        start, end = ends
        normal = n if below == i else -n
        if normal @ np.array([-(end - start)[1], (end - start)[0]]) < 0:
            start, end = end, start
        near = [np.hypot(*(blocks[above].corners - place).T).min() < SHORTEST * tolerance for place in (start, end)]
        yield Joint(
            below=below,
            above=above,
            start=(float(start[0]), float(start[1])),
            end=(float(end[0]), float(end[1])),
            travel=travel,
            length=min(blocks[i].length, blocks[j].length),
            corners=(bool(near[0]), bool(near[1])),
            name=f"{names[below]}|{names[above]}",
        )
