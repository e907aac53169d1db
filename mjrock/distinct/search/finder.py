"""Finder: contact places of convex blocks that touch or are close to each other, at any pose.

The distance of two blocks is the largest gap along their separating axes: the normals of their faces, and the vector
products of an edge of each (Gottschalk, Lin and Manocha, OBBTree, SIGGRAPH 1996). If that axis is the normal of a face,
`clipping` gives the places; if it belongs to two edges, there is one place. MuJoCo finds such contacts too, but for two
faces that are nearly parallel it gives at most four places, and not always the deepest. The law of a contact and the
motion are the subject of other modules.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from typing import NamedTuple

import numpy as np

from ...compiled import compiled_at_once, inlined
from ...geometry.vectors import Vector, dot, minus, norm, plus, read, scaled, spun
from ...problem.masonry.blocks.joints import each_with_each
from ...problem.wall.rest_geometry import Solid
from ...quantities import Array, Flags, Integers
from ...rows import Rows, rows
from .clipping import (
    PLACE,
    Workspace,
    clip,
    clip_in_grid,
    corner_of,
    face_towards,
    next_corner,
    normal_of,
    write_place,
)
from .constants import (
    AS_LARGE,
    CANDIDATE_FACES,
    EDGES_MEET,
    FACES_MEET,
    LARGER_FACE,
    NOT_PARALLEL,
    ON_ENDS,
    SECOND_FACE,
    SHALLOWER,
    SHARE_OF_EDGES,
)
from .pair_law import pair_number
from .solids import Poses, Solids, parts_of, sides_of, triple, with_whole_sides

NONE = np.zeros(0, dtype=np.int64)
"""Numbers of no pairs."""


class ContactPlaces(NamedTuple):
    """Contact places: where two blocks touch or are near each other.

    Args:
        face, other: block of the face, of two edges either, and the other block, shape (n,).
        place: halfway between the two surfaces [m], shape (n, d).
        normal: unit vector out of the face, shape (n, d).
        gap: between the surfaces, negative for an overlap [m], shape (n,).
        share: of the law of the pair, zero where no face lies over the other, shape (n,).
        area: common area of the two faces [m2], in the plane its length [m], zero for edges, shape (n,).
    """

    face: Integers
    other: Integers
    place: Array
    normal: Array
    gap: Array
    share: Array
    area: Array

    def only(self, numbers: Flags | Integers) -> ContactPlaces:
        """Some of the places."""
        return ContactPlaces._make(part[numbers] for part in self)


class Near(NamedTuple):
    """Which pairs are searched.

    Args:
        low, high: least and largest coordinates of each solid, enlarged by its reach [m], shape (solids, 3).
        order: the solids by their least coordinate along an axis, shape (solids,).
        axis: number of that axis.
        reach: distance up to which places of each solid are wanted [m], shape (solids,).
        searched, fixed: which solids, shape (solids,). Of a pair at least one is searched, and at least one is free.
        rank: of the block of each solid, shape (solids,). Where faces are equal or edges cross, the normal is that of
            the block of lower rank.
        skipped: numbers of pairs of solids that are left out, increasing, see `pair_law.pair_number`.
        jointed: numbers of pairs of solids that had a joint, increasing.
        cells: of the grids of these, along x and z and along y, shape (pairs, 2).
    """

    low: Array
    high: Array
    order: Integers
    axis: int
    reach: Array
    searched: Flags
    fixed: Flags
    rank: Integers
    skipped: Integers
    jointed: Integers = NONE
    cells: Integers = np.ones((0, 2), dtype=np.int64)


class Finder:
    """Blocks, and the convex solids that they are made of.

    Args:
        solids: the blocks.
        flat: whether they are those of the plane.

    `jointed` has the numbers of the pairs of solids that had a joint, increasing, and `points` the lines of each.
    """

    def __init__(self, solids: Sequence[Solid], *, flat: bool) -> None:
        self.flat = flat
        self.jointed = self.points = NONE
        self._half = min(solid.size for solid in solids)  # of the length of a prism, which plays no part
        self.number = np.array([len(solid.drawn) for solid in solids])
        self._of_parts = bool(self.number.max() > 1)
        self.first = np.cumsum(self.number) - self.number
        self.owner = np.repeat(np.arange(len(solids)), self.number)
        fixed, centroids = np.array([solid.fixed for solid in solids]), np.array([solid.rest for solid in solids])
        self._fixed = fixed[self.owner]
        parts = parts_of(solids, self._half, flat=flat)
        self.volumes = np.add.reduceat([part.bulk.volume for part in parts], self.first)
        self._rank = ranked(fixed, self.volumes, centroids[:, -1], self._half)[self.owner]
        inside = [flags for solid in solids for flags in solid.inside]
        self.solids = Solids.about(parts, centroids[self.owner], inside, self.owner, sides_of(solids), flat=flat)
        most_corners = int(np.diff([*self.solids.first, *self.solids.begin]).max())
        self._work = Workspace(rows(PLACE, 256), np.empty((4 * most_corners + 4, 3)))

    def with_own_workspace(self) -> Finder:
        """A copy with work arrays of its own: runs in two threads must not share them."""
        fresh = copy(self)
        fresh._work = Workspace._make(part.copy() for part in self._work)
        return fresh

    def places_near(self, poses: Poses, reach: Array, searched: Flags, skipped: Integers) -> ContactPlaces:
        """Places of pairs of blocks that are nearer than the sum of their reaches, and of which one is searched.

        Args:
            poses: of all blocks.
            reach: of each block [m], shape (blocks,).
            searched: shape (blocks,).
            skipped: numbers of pairs of solids that are left out, increasing, see `between`.
        """
        solids, reach, searched = self.posed(poses), reach[self.owner], searched[self.owner]
        low, high = (ends.reduceat(solids.corners, solids.corner[:-1]) for ends in (np.minimum, np.maximum))
        low, high = low - reach[:, None], high + reach[:, None]
        axis = int((low.max(axis=0) - low.min(axis=0)).argmax())
        order, cells = low[:, axis].argsort(), np.ones((len(self.points), 2), dtype=np.int64)
        cells[:, : 1 if self.flat else 2] = self.points[:, None] - 1
        near = Near(low, high, order, axis, reach, searched, self._fixed, self._rank, skipped, self.jointed, cells)
        while (count := find(solids, near, self._work)) > len(self._work.places):
            self._work = self._work._replace(places=rows(PLACE, 2 * count))
        table = self._without_repetitions(self._work.places[:count]) if self._of_parts else self._work.places[:count]
        order = self._order_of(table)
        places = ContactPlaces(*(table[name][order] for name in (PLACE.names or ())[:-1]))
        places = self._places_in_plane(places) if self.flat else places
        return self._among_blocks(places) if self._of_parts else places

    def _without_repetitions(self, table: Rows) -> Rows:
        """The places without repetitions: several pairs of parts of two blocks find those of a common side."""
        sides, pair = table["sides"], pair_number(table["face"], table["other"], len(self.owner))
        _, side_of_place = np.unique(sides, return_inverse=True)
        first = np.full(len(table) + 1, np.iinfo(np.int64).max)
        np.minimum.at(first, side_of_place, pair)
        once: Rows = table[(sides < 0) | (pair == first[side_of_place])]
        return once

    def _order_of(self, table: Rows) -> Integers:
        """An order of the places, in the plane of those at one end of the prisms, that neither the numbers of blocks
        nor the axes change, where blocks differ in rank. Those of a pair are together."""
        face, other = table["face"], table["other"]
        of_blocks = pair_number(self._rank[face], self._rank[other], len(self.number))
        order = np.lexsort((pair_number(face, other, len(self.owner)), of_blocks))
        at_end = table["at"][order, 1] > 0.5 * self._half
        return order[at_end] if self.flat else order

    def between(self, a: Integers, b: Integers) -> Integers:
        """Numbers of the pairs of solids of pairs of blocks, shape (n,)."""
        if self._of_parts:
            _, a, b = each_with_each(self.first, self.number, np.column_stack([a, b]))
        return pair_number(a, b, len(self.owner))

    def parts_of(self, block: int) -> range:
        """Numbers of the solids of a block."""
        return range(self.first[block], self.first[block] + self.number[block])

    def posed(self, poses: Poses) -> Solids:
        """The solids at some poses."""
        place, change = np.zeros((len(poses.moved), 3)), np.zeros((len(poses.moved), 3, 3))
        axes = slice(None, None, 2 if self.flat else 1)
        place[:, axes], change[:, axes, axes] = poses.drawn + poses.moved, poses.change
        return self.solids.moved(place[self.owner], change[self.owner])

    def _among_blocks(self, places: ContactPlaces) -> ContactPlaces:
        """Places of solids as those of blocks, sorted by pair. The law of a pair of blocks is shared among its pairs of
        solids in proportion to their common areas."""
        solids, count = pair_number(places.face, places.other, len(self.owner)), len(self.number)
        places = places._replace(face=self.owner[places.face], other=self.owner[places.other])
        blocks = pair_number(places.face, places.other, count)
        at = np.unique(solids, return_index=True)[1]  # the places of solids have one area
        _, of_pair = np.unique(blocks, return_inverse=True)
        in_pair = np.bincount(of_pair[at], weights=places.area[at])[of_pair]
        over = places.area > 0
        share = places.share * np.where(over, places.area / np.where(over, in_pair, 1.0), 1.0)
        area = np.where(over, in_pair, 0.0)
        return places._replace(share=share, area=area)

    def _places_in_plane(self, places: ContactPlaces) -> ContactPlaces:
        """The places at one end of the prisms as those of the plane."""
        normal, share, area = places.normal[:, ::2], 2 * places.share, places.area / (2 * self._half)
        normal = normal / np.hypot(normal[:, 0], normal[:, 1])[:, None]
        return places._replace(place=places.place[:, ::2], normal=normal, share=share, area=area)


def ranked(fixed: Flags, volumes: Array, heights: Array, size: float) -> Integers:
    """The rank of each block: fixed ones first, then the largest and then the lowest ones. It depends neither on their
    numbers nor on which side is left. Blocks that are alike in all of these have the order of the drawing.

    Args:
        fixed, volumes, heights: of the blocks, fixed or not, volume [m3] and height of the centroid [m], shape (n,).
        size: of the smallest [m].
    """
    keys = steps_of(heights / size), steps_of(-np.log(volumes)), ~fixed
    rank = np.empty(len(fixed), dtype=np.int64)
    rank[np.lexsort(keys)] = np.arange(len(fixed))
    return rank


def steps_of(values: Array) -> Integers:
    """Values in steps: those that are alike have the same number, shape of the values."""
    order = np.argsort(values, kind="stable")
    steps = np.empty(len(values), dtype=np.int64)
    steps[order] = np.cumsum(np.diff(values[order], prepend=values[order][:1]) > AS_LARGE)
    return steps


@inlined
def index_of(values: Integers, number: int) -> int:
    """Index of a number in increasing values, -1 where it is none of them."""
    low, high = 0, len(values)
    while low < high:
        middle = (low + high) // 2
        if values[middle] < number:
            low = middle + 1
        else:
            high = middle
    return low if low < len(values) and values[low] == number else -1


@compiled_at_once
def find(solids: Solids, near: Near, work: Workspace) -> int:
    """Write the places of all pairs that are near, see `clipping.clip`, those of faces in the grid of their joint where
    they had one.

    Returns:
        How many there are, or more than there is room for where there may be too many.
    """
    count, blocks = 0, len(near.order)
    for turn in range(blocks):
        a = near.order[turn]
        for later in range(turn + 1, blocks):
            b = near.order[later]
            if near.low[b, near.axis] > near.high[a, near.axis]:
                break
            if not (near.searched[a] or near.searched[b]) or (near.fixed[a] and near.fixed[b]):
                continue
            if solids.owner[a] == solids.owner[b]:
                continue
            pair = (a, b) if near.rank[a] < near.rank[b] else (b, a)
            number = min(a, b) * blocks + max(a, b)
            if bounds_separated(near, a, b) or index_of(near.skipped, number) >= 0:
                continue
            had = index_of(near.jointed, number)
            cells = (near.cells[had, 0], near.cells[had, 1]) if had >= 0 else (1, 1)
            count = find_pair(solids, near.reach[a] + near.reach[b], pair, cells, work, count)
    return count


@inlined
def bounds_separated(near: Near, a: int, b: int) -> bool:
    """Whether the bounds of two solids are separated along an axis."""
    separated = False
    for i in range(3):
        separated = separated or near.low[a, i] > near.high[b, i] or near.low[b, i] > near.high[a, i]
    return separated


@inlined
def find_pair(
    solids: Solids,
    reach: float,
    blocks: tuple[int, int],
    cells: tuple[int, int],
    work: Workspace,
    count: int,
) -> int:
    """Write the places of a pair that is nearer than its reach [m], on faces in a grid of some cells.

    Returns the number of places in the table, or a larger number than it has room for where that may be too small.
    """
    a, b = blocks
    face, distance = separating_face(solids, a, b, reach)
    other_face, other_distance = (-1, -math.inf) if distance > reach else separating_face(solids, b, a, reach)
    best = max(distance, other_distance)
    if best > reach or face < 0 or other_face < 0:
        return count
    if count + len(work.corners) > len(work.places):
        return count + len(work.corners)
    least_distance = best - CANDIDATE_FACES * min(solids.extent[face], solids.extent[other_face])
    longer = solids.extent[other_face] - solids.extent[face]
    if other_distance + LARGER_FACE * longer - SECOND_FACE * solids.extent[face] > distance:
        face, blocks = other_face, (b, a)
    if best < 0:
        face, blocks, gap = shallowest(solids, face, blocks, least_distance, work, count)
        over = face_towards(solids, blocks[1], scaled(-1.0, normal_of(solids, face)))
        if gap == -math.inf or dot(normal_of(solids, face), normal_of(solids, over)) > FACES_MEET:
            direction, edge_distance = edge_separation(solids, a, b)
            if edge_distance > EDGES_MEET * gap:
                if edge_distance >= reach:
                    return count
                return write_edges(solids, (a, b), direction, edge_distance, work.places, count)
    whole_solids = with_whole_sides(solids)
    if cells[0] > 1:
        last = clip_in_grid(whole_solids, face, blocks, cells, work, count)
    else:
        last = clip(whole_solids, face, blocks, work, count)
    return last if last > count else write_near_corner(solids, face, blocks, best, work.places, count)


@inlined
def write_near_corner(solids: Solids, face: int, blocks: tuple[int, int], gap: float, table: Rows, count: int) -> int:
    """Write a corner of a face as a place without a share, from whose gap the time of the next search follows.

    It is for blocks that are near each other without a common area, such as two that approach at their corners.

    Returns the number of places in the table."""
    corner = solids.first[face]
    for i in range(corner, solids.first[face + 1]):
        if corner_of(solids, i)[1] > corner_of(solids, corner)[1]:  # at the end of the prisms that is kept
            corner = i
    write_place(table[count], blocks, corner_of(solids, corner), normal_of(solids, face), gap)
    table[count].share = table[count].area = 0.0
    return count + 1


@inlined
def shallowest(
    solids: Solids, face: int, blocks: tuple[int, int], least_distance: float, work: Workspace, count: int
) -> tuple[int, tuple[int, int], float]:
    """The face of two overlapping blocks with the smallest overlap at its places, its block and the other one, and the
    least gap of these places [m].

    A corner of the whole face may lie deep below the plane of another one, far from where the two lie over each other.
    A face whose places are open, or that misses the deepest place of the first face, does not separate the blocks.

    Args:
        solids: the blocks where they are.
        face, blocks: the face from which the other block is farthest, its block and the other one.
        least_distance: distance of the other block from a face from which on that face is a candidate [m].
        work, count: for places that are not kept, see `clipping.clip`.
    """
    table = work.places
    first = deepest(table, count, clip(solids, face, blocks, work, count))
    has_place, best_gap, middle = first >= 0, -math.inf, corner_of(solids, solids.first[face])
    if has_place:
        best_gap, middle = table[first].gap, read(table[first].at)
    slack = ON_ENDS * max(-best_gap, 0.0)
    common = has_place and lies_in(solids, blocks[0], middle, slack) and lies_in(solids, blocks[1], middle, slack)
    best, of_best, least_gap = face, blocks, SHALLOWER * best_gap
    for turn in range(2):
        block, other = blocks if turn == 0 else (blocks[1], blocks[0])
        for trial in range(solids.face[block], solids.face[block + 1]):
            if trial != face and not solids.inside[trial] and distance_outside(solids, trial, other) > least_distance:
                row = deepest(table, count, clip(solids, trial, (block, other), work, count))
                gap = table[row].gap if row >= 0 else -math.inf
                open_or_beside = (has_place and gap >= 0) or (common and gap > height(solids, trial, middle))
                if gap > least_gap and not open_or_beside:
                    best, of_best, least_gap, best_gap = trial, (block, other), gap, gap
    return best, of_best, best_gap


@inlined
def deepest(table: Rows, first: int, last: int) -> int:
    """Number of the place with the least gap, -1 for none."""
    best = -1
    for i in range(first, last):
        if best < 0 or table[i].gap < table[best].gap:
            best = i
    return best


@inlined
def height(solids: Solids, face: int, at: Vector) -> float:
    """Height of a place over the plane of a face [m]."""
    above: float = dot(normal_of(solids, face), minus(at, corner_of(solids, solids.first[face])))
    return above


@inlined
def lies_in(solids: Solids, block: int, at: Vector, slack: float) -> bool:
    """Whether a place lies inside a block, or outside by some slack [m]."""
    inside = True
    for face in range(solids.face[block], solids.face[block + 1]):
        inside = inside and height(solids, face, at) <= slack
    return inside


@inlined
def distance_outside(solids: Solids, face: int, other: int) -> float:
    """Distance of a block from the plane of a face of another one [m], negative for an overlap."""
    normal = normal_of(solids, face)
    return -dot(normal, corner_of(solids, solids.first[face])) - farthest_along(solids, other, scaled(-1.0, normal))


@inlined
def farthest_along(solids: Solids, block: int, direction: Vector) -> float:
    """Largest coordinate of a block along a direction [m]."""
    farthest = -math.inf
    for i in range(solids.corner[block], solids.corner[block + 1]):
        farthest = max(farthest, dot(direction, triple(solids.corners, i)))
    return farthest


@inlined
def separating_face(solids: Solids, block: int, other: int, reach: float) -> tuple[int, float]:
    """The face of a block from whose plane another block is farthest, and that distance [m], negative for an overlap.

    The search ends at the first face with a distance above the reach. A face between two parts of a block has no
    contact: a block outside of its plane counts as infinitely far."""
    best, farthest = -1, -math.inf
    for face in range(solids.face[block], solids.face[block + 1]):
        distance = distance_outside(solids, face, other)
        if solids.inside[face]:
            distance = math.inf if distance >= 0 else -math.inf
        if distance > farthest:
            best, farthest = face, distance
            if farthest > reach:
                break
    return best, farthest


@inlined
def edge_separation(solids: Solids, a: int, b: int) -> tuple[Vector, float]:
    """The separating axis of two edges along which two blocks are farthest from each other, and that distance [m]."""
    best: Vector = (0.0, 0.0, 0.0)
    farthest = -math.inf
    for i in range(solids.edge[a], solids.edge[a + 1]):
        for j in range(solids.edge[b], solids.edge[b + 1]):
            normal = spun(triple(solids.edges, i), triple(solids.edges, j))
            size = norm(normal)
            if size < NOT_PARALLEL:
                continue
            for sign in (1.0, -1.0):
                direction = scaled(sign / size, normal)
                distance = -farthest_along(solids, b, scaled(-1.0, direction)) - farthest_along(solids, a, direction)
                if distance > farthest:
                    best, farthest = direction, distance
    return best, farthest


@inlined
def edge_towards(solids: Solids, block: int, direction: Vector) -> tuple[Vector, Vector]:
    """The edge of a block that is farthest along a direction: one end, and the vector to the other one [m]."""
    farthest, end, along = -math.inf, direction, direction
    for face in range(solids.face[block], solids.face[block + 1]):
        for i in range(solids.first[face], solids.first[face + 1]):
            corner, after = corner_of(solids, i), next_corner(solids, face, i)
            reaches = dot(direction, plus(corner, after))
            if reaches > farthest:
                farthest, end, along = reaches, corner, minus(after, corner)
    return end, along


@inlined
def write_edges(solids: Solids, blocks: tuple[int, int], normal: Vector, gap: float, table: Rows, count: int) -> int:
    """Write the place where two edges cross. Returns the number of places in the table."""
    if count < len(table):
        start, edge = edge_towards(solids, blocks[0], normal)
        other_start, other_edge = edge_towards(solids, blocks[1], scaled(-1.0, normal))
        share = dot(spun(minus(start, other_start), edge), normal) / dot(spun(other_edge, edge), normal)
        write_place(table[count], blocks, plus(other_start, scaled(share, other_edge)), normal, gap)
        table[count].share, table[count].area = SHARE_OF_EDGES, 0.0
    return count + 1
