"""Joints of masonry: where edges of two blocks lie on one another, and the contact lines that they carry."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from ....geometry.hull import Convex, Side
from ....quantities import Array, Flags, Integers, short_repr


class Shape(Protocol):
    """What joints, solvers and pictures need of a block, convex or not: `Polygon`, `Polyhedron` or `Compound`."""

    @property
    def name(self) -> str | None:
        """What it is called, or None."""

    @property
    def fixed(self) -> bool:
        """Whether it belongs to the ground."""

    @property
    def corners(self) -> Array:
        """Its corners [m], shape (n, d)."""

    @property
    def parts(self) -> tuple[Any, ...]:
        """The convex parts that it is made of, all of one kind."""

    @property
    def sides(self) -> tuple[Side, ...]:
        """Its surface, in plane pieces."""

    @property
    def solids(self) -> tuple[Convex, ...]:
        """Its convex parts in space, of a block of the plane prisms over its length."""

    @property
    def inside(self) -> tuple[Flags, ...]:
        """Of each of these, which faces nothing meets: those within the block, and the ends of prisms, (faces,)."""


class Flat(Shape, Protocol):
    """A block of the plane."""

    @property
    def length(self) -> float:
        """Its length out of the plane [m]."""


SHORTEST_JOINT = 10.0
"""Length of the shortest joint, over the tolerance [-]. Blocks that share less than this touch at a corner only."""
PARALLEL = 0.05
"""Largest sine of the angle between two edges that make a joint [-]."""
TOGETHER = 512
"""Pairs of blocks whose joints are found at once."""
PARTS_APART = 1e-5
"""Largest distance between the faces of two parts of a unit that are joined, and largest overlap of parts [m]."""
LEVEL = 1e-6
"""Largest |x| of the normal of a bed joint, and largest |z| of that of a head joint [-]."""


@dataclass(frozen=True)
class Joint:
    """Where two blocks meet along a line.

    Args:
        below, above: numbers of the two blocks. The normal points from `below` to `above`. Of the two blocks of a joint
            that is not vertical, `above` lies higher. A fixed block is always `below`.
        start, end: ends of the joint [m], with the normal to the left of the direction from start to end.
        length: length out of the plane, that of the shorter block or part of one [m].
        travel: how far the block above can slide from end to start, and from start to end, before the two edges no
            longer overlap [m].
        corners: whether an end is a corner of the block above, for start and end.
        name: names of the two blocks with a | between them, the one below first. A second joint of the same two has
            " (2)" after it.
        sides: numbers of the sides of the block below and of the block above that make it.
    """

    below: int
    above: int
    start: tuple[float, float]
    end: tuple[float, float]
    length: float
    travel: tuple[float, float]
    corners: tuple[bool, bool]
    name: str
    sides: tuple[int, int]

    __repr__ = short_repr

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
    def frame(self) -> Array:
        """The normal and the direction along, shape (2, 2)."""
        return np.array([self.normal, self.along])

    @property
    def is_bed(self) -> bool:
        """Whether the joint is horizontal."""
        return bool(abs(self.normal[0]) < LEVEL)


AnyJoint = TypeVar("AnyJoint", bound=Any)
"""A joint of the plane or of space."""


def names_of(blocks: Sequence[Shape]) -> tuple[str, ...]:
    """Names of the blocks: their own, or `block_` and their number."""
    return tuple(block.name or f"block_{i}" for i, block in enumerate(blocks))


def numbered_parts(blocks: Sequence[Shape]) -> tuple[Integers, Integers]:
    """Where the convex parts of each block begin among those of all, and how many it has, shape (blocks,) each."""
    count = np.array([len(block.parts) for block in blocks])
    return np.cumsum(count) - count, count


def each_with_each(first: Integers, number: Integers, pairs: Integers) -> tuple[Integers, Integers, Integers]:
    """Every thing of one block with every thing of another, for pairs of blocks of the shape (pairs, 2).

    Args:
        first, number: where the things of each block begin, and how many there are, shape (blocks,) each.
        pairs: numbers of the blocks.

    Returns:
        The number of the pair, of the thing of the first block and of that of the second, shape (n,) each.
    """
    counts = number[pairs]
    sizes = counts.prod(axis=1)
    pair = np.repeat(np.arange(len(pairs)), sizes)
    of_first, of_second = np.divmod(np.arange(len(pair)) - np.repeat(np.cumsum(sizes) - sizes, sizes), counts[pair, 1])
    return pair, first[pairs[pair, 0]] + of_first, first[pairs[pair, 1]] + of_second


class Edges(NamedTuple):
    """Edges of all blocks, one block after the other.

    Args:
        start, end: corners [m], shape (edges, 2) each.
        normal: unit normals out of the blocks, shape (edges, 2).
        first, number: where those of each block begin, and how many there are, shape (blocks,) each.
    """

    start: Array
    end: Array
    normal: Array
    first: Integers
    number: Integers

    @classmethod
    def from_blocks(cls, blocks: Sequence[Shape]) -> Edges:
        """The edges of blocks."""
        count = np.array([len(block.sides) for block in blocks])
        starts, ends = np.array([side.corners for block in blocks for side in block.sides]).swapaxes(0, 1)
        normals = np.array([side.normal for block in blocks for side in block.sides])
        return cls(starts, ends, normals, np.cumsum(count) - count, count)

    def sunk(self, pairs: Integers) -> Array:
        """How deep the second block of each pair reaches behind an edge of the first [m], the least over its edges.

        The blocks are convex.
        """
        _, edge, other = each_with_each(self.first, self.number, pairs)
        behind = _dot(self.start[edge] - self.start[other], self.normal[edge])
        return least_of_deepest(behind, edge, self.number[pairs[:, 0]])


def least_of_deepest(behind: Array, edge: Integers, counts: Integers) -> Array:
    """The depth to which the second block of each pair reaches behind an edge or face of the first, the least over its
    edges [m], shape (pairs,).

    Args:
        behind: depth of each corner of the second behind each edge of the first [m], those of an edge together.
        edge: its number, of the same shape.
        counts: of the edges of the first block of each pair, shape (pairs,).
    """
    deepest = np.maximum.reduceat(behind, np.flatnonzero(np.diff(edge, prepend=-1)))
    return np.asarray(np.minimum.reduceat(deepest, np.cumsum(counts) - counts))


class Meetings(NamedTuple):
    """Edges that lie on one another.

    Args:
        pair: numbers of the two blocks, shape (n, 2).
        edge: numbers of the two edges among those of their block, shape (n, 2).
        ends: of the joint, along the edge of the first block [m], shape (n, 2, 2).
        normal: out of the first block, shape (n, 2).
        travel: as of a `Joint`, shape (n, 2).
    """

    pair: Integers
    edge: Integers
    ends: Array
    normal: Array
    travel: Array


def joints_in_plane(
    blocks: Sequence[Flat], tolerance: float, gap: float, pairs: Integers | None = None
) -> tuple[Joint, ...]:
    """The joints between blocks, in the order of the blocks.

    Two edges make a joint where they overlap along a line and are nowhere farther apart than the gap [m]. The tolerance
    is the largest overlap of blocks [m]. The joint lies halfway between them. Two fixed blocks make none. Pairs are the
    numbers of blocks that are looked at, shape (pairs, 2); None looks at all.

    Raises:
        OverlapError: for blocks that overlap more, with the two that overlap most.
    """
    names, edges = names_of(blocks), Edges.from_blocks(blocks)
    pairs = neighbours(blocks, gap) if pairs is None else pairs
    first, number = numbered_parts(blocks)
    of_parts = (
        edges if number.max() == 1 else Edges.from_blocks(list(chain.from_iterable(block.parts for block in blocks)))
    )
    joints: list[Joint] = []
    overlaps: list[tuple[float, int, int]] = []
    for batch in np.split(pairs, range(TOGETHER, len(pairs), TOGETHER)):
        pair, part, other_part = each_with_each(first, number, batch)
        part_pairs = np.column_stack([part, other_part])
        depth = np.minimum(of_parts.sunk(part_pairs), of_parts.sunk(part_pairs[:, ::-1]))
        deep = depth > tolerance
        overlaps += [(how, i, j) for how, (i, j) in zip(depth[deep].tolist(), batch[pair[deep]].tolist(), strict=True)]
        joints += _joints(blocks, edges, meetings(edges, batch, tolerance, gap), names, corner_within(tolerance, gap))
    require_apart(overlaps, names, tolerance)
    return unlike_named(joints)


def corner_within(tolerance: float, gap: float) -> float:
    """Distance of a corner from an end of a joint, which lies amid the gap, up to which it is at that end [m]."""
    return max(SHORTEST_JOINT * tolerance, gap)


def unlike_named(joints: Sequence[AnyJoint]) -> tuple[AnyJoint, ...]:
    """The joints, those with a name that others had before them with a number after it."""
    count, named = Counter[str](), []
    for joint in joints:
        count[joint.name] += 1
        repeats = count[joint.name]
        named.append(joint if repeats == 1 else replace(joint, name=f"{joint.name} ({repeats})"))
    return tuple(named)


def meetings(edges: Edges, pairs: Integers, tolerance: float, gap: float) -> Meetings:
    """Where edges of the blocks of pairs lie on one another, no farther apart than the gap and no deeper in each other
    than the tolerance [m]."""
    pair, edge, other = each_with_each(edges.first, edges.number, pairs)
    facing = _dot(edges.normal[edge], edges.normal[other]) <= 0
    facing &= np.abs(_cross(edges.normal[edge], edges.normal[other])) <= PARALLEL
    pair, edge, other = pair[facing], edge[facing], other[facing]
    a, b, c, d = edges.start[edge], edges.end[edge], edges.start[other], edges.end[other]
    direction, n = (b - a) / np.hypot(*(b - a).T)[:, None], edges.normal[edge]
    # the other outline runs in the opposite direction
    first, last, long = _dot(d - a, direction), _dot(c - a, direction), _dot(b - a, direction)
    span = np.column_stack([np.maximum(0.0, first), np.minimum(long, last)])
    rise = _dot(c - d, n) / (last - first)
    gaps = _dot(d - a, n)[:, None] + rise[:, None] * (span - first[:, None])
    lie = (span[:, 1] - span[:, 0] > SHORTEST_JOINT * tolerance) & ((-tolerance <= gaps) & (gaps <= gap)).all(axis=1)
    # ends are corners, without rounding, moved to the middle between the edges
    starts = np.where((first > 0)[:, None], d, a) + (np.where(first > 0, -0.5, 0.5) * gaps[:, 0])[:, None] * n
    stops = np.where((last < long)[:, None], c, b) + (np.where(last < long, -0.5, 0.5) * gaps[:, 1])[:, None] * n
    # whichever of the two is above, it leaves the other after the same travel back and forth along the joint
    travel = np.column_stack([long - first, last])
    edge_pairs = np.column_stack([edge, other])[lie] - edges.first[pairs[pair[lie]]]
    return Meetings(pairs[pair[lie]], edge_pairs, np.stack([starts, stops], axis=1)[lie], n[lie], travel[lie])


def _joints(
    blocks: Sequence[Flat], edges: Edges, met: Meetings, names: Sequence[str], within: float
) -> Iterator[Joint]:
    """The joints of edges that lie on one another; a corner so near an end of one is at it [m]."""
    n, fixed = met.normal, np.array([block.fixed for block in blocks])
    upwards = np.where(np.abs(n[:, 1]) > LEVEL, n[:, 1], n[:, 0]) > 0  # across a vertical joint, the right is above
    turned = np.where(upwards, fixed[met.pair[:, 1]], ~fixed[met.pair[:, 0]])
    pairs, sides = (np.where(turned[:, None], two[:, ::-1], two) for two in (met.pair, met.edge))  # below, above
    along = met.ends[:, 1] - met.ends[:, 0]
    back = np.where(turned, -1.0, 1.0) * _cross(along, n) < 0
    ends = np.where(back[:, None, None], met.ends[:, ::-1], met.ends)
    counts = edges.number[pairs[:, 1]]
    joint = np.repeat(np.arange(len(pairs)), counts)
    corner = np.arange(len(joint)) + np.repeat(edges.first[pairs[:, 1]] - np.cumsum(counts) + counts, counts)
    away = np.hypot(*(edges.start[corner, None] - ends[joint]).transpose(2, 0, 1))
    near = np.minimum.reduceat(away, np.cumsum(counts) - counts) < within if len(pairs) else away
    rows = zip(pairs.tolist(), sides.tolist(), ends.tolist(), met.travel.tolist(), near.tolist(), strict=True)
    for (below, above), (on, under), (start, end), (back_by, on_by), (first, last) in rows:
        yield Joint(
            below=below,
            above=above,
            start=tuple(start),
            end=tuple(end),
            length=min(_length_of(blocks[below], on), _length_of(blocks[above], under)),
            travel=(back_by, on_by),
            corners=(first, last),
            name=f"{names[below]}|{names[above]}",
            sides=(on, under),
        )


def _length_of(block: Flat, side: int) -> float:
    """Length out of the plane of the part of a block that has a side [m]."""
    return float(block.parts[block.sides[side].parts[0]].length)


def _dot(a: Array, b: Array) -> Array:
    """Products of vectors, shape (n,)."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1])


def _cross(a: Array, b: Array) -> Array:
    """Products across of vectors, shape (n,)."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


class OverlapError(ValueError):
    """Blocks that overlap by more than the tolerance, and by how much the most of them do [m]."""

    def __init__(self, message: str, deepest: float) -> None:
        super().__init__(message)
        self.deepest = deepest


def require_apart(overlaps: Sequence[tuple[float, int, int]], names: Sequence[str], tolerance: float) -> None:
    """Raise an `OverlapError` that names the two blocks that overlap most, and how many pairs do.

    Overlaps are depths above the tolerance [m], with the numbers of the two blocks.
    """
    if not overlaps:
        return
    deepest, i, j = max(overlaps, key=lambda overlap: overlap[0])
    pairs = len({(block, other_block) for _, block, other_block in overlaps})
    most = f", the most of {pairs} pairs of blocks" if pairs > 1 else ""
    raise OverlapError(
        f"blocks {names[i]} and {names[j]} overlap by {deepest:.3g} m{most}; the valid range is up to the tolerance, "
        f"{tolerance:g} m",
        deepest,
    )


def neighbours(blocks: Sequence[Shape], tolerance: float) -> Integers:
    """Pairs of blocks, not both fixed, whose bounding boxes touch, in the order of the blocks, shape (pairs, 2).

    Along the longest axis the blocks are sorted by where they begin. Of those that begin before one ends, the rest of
    the box is compared.
    """
    low = np.array([block.corners.min(axis=0) for block in blocks]) - tolerance
    high = np.array([block.corners.max(axis=0) for block in blocks]) + tolerance
    axis = int(np.ptp(low, axis=0).argmax())
    order = np.argsort(low[:, axis], kind="stable")
    low, high, fixed = low[order], high[order], np.array([block.fixed for block in blocks])[order]
    pairs = []
    for i, last in enumerate(np.searchsorted(low[:, axis], high[:, axis], side="right").tolist()):
        near = ((low[i] <= high[i + 1 : last]) & (low[i + 1 : last] <= high[i])).all(axis=1)
        others = i + 1 + np.flatnonzero(near & ~(fixed[i] & fixed[i + 1 : last]))
        pairs.append(np.column_stack([np.full(len(others), i), others]))
    ordered = np.sort(order[np.concatenate(pairs)], axis=1)
    return np.asarray(ordered[np.lexsort(ordered.T[::-1])])
