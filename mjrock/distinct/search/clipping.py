"""Clipping: the places where a face of one block lies over a face of another.

The common area of the two faces is bounded by corners of either and by points where edges cross. Each of these is a
place of contact: a corner meets the other face, and edges that cross meet along the normal of both. Its share of the
contact is the angle by which the outline of the area turns there, over a whole turn: a quarter for each corner of a
rectangle. Places that coincide have together the share of one, and a place on a straight side has none.

A pair that had a joint keeps the `points` of the joint. A common area of four corners is one quadrilateral, divided
into points - 1 cells a side, in the plane along the joint alone. Any other area is divided into a quadrilateral for
each corner, between that corner, the middles of its two edges and the centroid, with half as many cells a side. So the
grid is that of `geometry.convex.spread`. The tributary area of each point is the integral of its bilinear weight: the
sum of these areas is the common area, and their mean position is its centroid.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, minus, plus, put, scaled, spun, vector
from ...quantities import Array
from ..rows import Row, Rows, integers, numbers, vectors
from .constants import AS_LARGE, AS_TOWARDS, EDGES_ALONG_FACE, ON_EDGE, ONE_PLACE, PARALLEL_EDGES
from .solids import Solids, triple

PLACE = np.dtype(
    [*integers("face", "other"), *vectors(3, "at", "normal"), *numbers("gap", "share", "area"), *integers("sides")]
)
"""A place: block of the face, other block, where, normal out of the face, gap [m], share, area of the part [m2], and
number of the pair of sides, see `sides_between`."""


@inlined
def corner_of(solids: Solids, number: int) -> Vector:
    """Where a corner of an outline is [m]."""
    return triple(solids.corners, solids.outline[number])


@inlined
def next_corner(solids: Solids, face: int, number: int) -> Vector:
    """Where the corner after another one of the outline of a face is [m]."""
    return corner_of(solids, solids.first[face] if number + 1 == solids.first[face + 1] else number + 1)


@inlined
def normal_of(solids: Solids, face: int) -> Vector:
    """The normal of a face."""
    return triple(solids.normals, face)


@inlined
def length_of(a: Vector) -> float:
    """Length of a vector."""
    return math.sqrt(dot(a, a))


@inlined
def longest_edge(solids: Solids, face: int) -> float:
    """Length of the longest edge of a face [m]. What is small beside a face goes by it: an edge beside a corner is
    another one where the outline runs the other way round, as in a mirror image."""
    longest = 0.0
    for i in range(solids.first[face], solids.first[face + 1]):
        longest = max(longest, length_of(minus(next_corner(solids, face, i), corner_of(solids, i))))
    return longest


@inlined
def face_towards(solids: Solids, block: int, way: Vector) -> int:
    """The face of a block whose normal is nearest to a direction, of two that are as near the one that `is_before`."""
    best, largest = -1, -math.inf
    for face in range(solids.face[block], solids.face[block + 1]):
        cosine = dot(normal_of(solids, face), way)
        ahead = cosine - largest
        if ahead > AS_TOWARDS or (ahead >= -AS_TOWARDS and is_before(solids, face, best)):
            best, largest = face, cosine
    return best


@inlined
def is_before(solids: Solids, face: int, other: int) -> bool:
    """Whether a face of a block is taken and not another one of it that would do as well: it is larger, or as large and
    looks further up. So neither the numbers of faces nor the axes decide, where faces differ in this."""
    longer = solids.extent[face] - solids.extent[other]
    if abs(longer) > AS_LARGE * solids.extent[other]:
        return bool(longer > 0)
    return bool(solids.normals[face, 2] > solids.normals[other, 2] + AS_LARGE)


@inlined
def sides_between(solids: Solids, faces: tuple[int, int]) -> int:
    """One number for the sides that two faces lie on."""
    one, other = solids.side[faces[0]], solids.side[faces[1]]
    number: int = min(one, other) * len(solids.side) + max(one, other)
    return number


@inlined
def cut(polygon: Array, count: int, way: Vector, reach: float, slack: float, room: Array) -> int:
    """Cut off the part of a polygon beyond a limit along a direction. Returns how many corners are left.

    A convex polygon gains at most one corner. One that is no longer convex by rounding gains no more than there is room
    for."""
    left = 0
    for i in range(count):
        a, b = vector(polygon, i, way), vector(polygon, (i + 1) % count, way)
        beyond, next_beyond = dot(way, a) - reach, dot(way, b) - reach
        if beyond <= slack and left < len(room):
            put(room[left], a)
            left += 1
        if (beyond <= slack) != (next_beyond <= slack) and left < len(room):
            share = min(max(beyond / (beyond - next_beyond), 0.0), 1.0)
            put(room[left], plus(a, scaled(share, minus(b, a))))
            left += 1
    for i in range(left):
        put(polygon[i], vector(room, i, way))
    return left


@inlined
def parted(polygon: Array, count: int, slack: float) -> int:
    """Remove corners of a polygon that are within a distance of those before them. Returns how many are left."""
    left = 0
    for i in range(count):
        at, last = triple(polygon, i), triple(polygon, left - 1 if left else count - 1)
        if length_of(minus(at, last)) > slack:
            put(polygon[left], at)
            left += 1
    return left


@inlined
def lying_over(solids: Solids, face: int, over: int, room: Array) -> int:
    """Write the common area of two faces into the first half of the room, without corners that coincide.

    Returns:
        How many corners it has.
    """
    count, polygon, further = 0, room[: len(room) // 2], room[len(room) // 2 :]
    for i in range(solids.first[over], solids.first[over + 1]):
        put(polygon[count], corner_of(solids, i))
        count += 1
    normal, slack = normal_of(solids, face), ON_EDGE * longest_edge(solids, face)
    for i in range(solids.first[face], solids.first[face + 1]):
        a = corner_of(solids, i)
        way = spun(minus(next_corner(solids, face, i), a), normal)
        way = scaled(1 / length_of(way), way)
        count = cut(polygon, count, way, dot(way, a), slack, further)
    return parted(polygon, count, slack)


@inlined
def turn_at(polygon: Array, count: int, i: int) -> float:
    """The angle by which the outline of a polygon turns at a corner, over a whole turn."""
    at = triple(polygon, i)
    before = minus(at, triple(polygon, i - 1 if i else count - 1))
    after = minus(triple(polygon, (i + 1) % count), at)
    return math.atan2(length_of(spun(before, after)), dot(before, after)) / (2 * math.pi)


@inlined
def area_of(polygon: Array, count: int) -> float:
    """Area of a polygon [m2]."""
    first, area = triple(polygon, 0), 0.0
    for i in range(1, count - 1):
        one, next_one = triple(polygon, i), triple(polygon, i + 1)
        area += 0.5 * length_of(spun(minus(one, first), minus(next_one, first)))
    return area


@inlined
def distance_from(at: Vector, a: Vector, along: Vector) -> float:
    """Distance of a place from the line through another one [m]."""
    return length_of(spun(along, minus(at, a))) / length_of(along)


@inlined
def write_place(place: Row, blocks: tuple[int, int], at: Vector, normal: Vector, gap: float) -> None:
    """Write a place of a face, the first block, and of a point on the other one."""
    place.face, place.other, place.gap, place.sides = blocks[0], blocks[1], gap, -1
    put(place.at, minus(at, scaled(0.5 * gap, normal)))
    put(place.normal, normal)


@inlined
def meet(solids: Solids, faces: tuple[int, int], blocks: tuple[int, int], at: Vector, place: Row) -> None:
    """Write the place at a corner of the common area of two faces: a corner of either, or edges that cross.

    Args:
        solids: the blocks where they are.
        faces, blocks: the face below and that over it, and their blocks.
        at: the corner, on the face over the other [m].
        place: the row to write.
    """
    face, over = faces
    normal, edge, from_edge = normal_of(solids, face), -1, math.inf
    one_place = ONE_PLACE * longest_edge(solids, over)
    for i in range(solids.first[over], solids.first[over + 1]):
        corner = corner_of(solids, i)
        along = minus(next_corner(solids, over, i), corner)
        if length_of(minus(at, corner)) < one_place:
            gap = dot(normal, minus(at, corner_of(solids, solids.first[face])))
            write_place(place, blocks, at, normal, gap)
            return
        distance = distance_from(at, corner, along)
        if distance < from_edge:
            edge, from_edge = i, distance
    crossed, from_crossed, one_place = -1, math.inf, ONE_PLACE * longest_edge(solids, face)
    for i in range(solids.first[face], solids.first[face + 1]):
        corner = corner_of(solids, i)
        own, off = minus(next_corner(solids, face, i), corner), minus(at, corner)
        off = minus(off, scaled(dot(off, normal), normal))
        if length_of(off) < one_place:
            normal = normal_of(solids, over)
            gap = dot(normal, minus(corner, corner_of(solids, solids.first[over])))
            write_place(place, (blocks[1], blocks[0]), corner, normal, gap)
            return
        distance = distance_from(off, scaled(0.0, own), own)
        if distance < from_crossed:
            crossed, from_crossed = i, distance
    below = corner_of(solids, crossed)
    own, along = (
        minus(next_corner(solids, face, crossed), below),
        minus(next_corner(solids, over, edge), corner_of(solids, edge)),
    )
    across = spun(along, own)
    size = length_of(across)
    if abs(dot(across, normal)) > EDGES_ALONG_FACE * size and size > PARALLEL_EDGES * length_of(along) * length_of(own):
        normal = scaled(math.copysign(1 / size, dot(across, normal)), across)
    write_place(place, blocks, at, normal, dot(normal, minus(at, below)))


@inlined
def clip(solids: Solids, face: int, blocks: tuple[int, int], table: Rows, count: int, room: Array) -> int:
    """Write the places where a block lies over a face of another. Returns how many places there are then.

    Args:
        solids: the blocks where they are.
        face, blocks: the face, its block, and the other one.
        table: rows of `PLACE`.
        count: how many places there are.
        room: for the corners of two faces, twice.
    """
    faces = face, face_towards(solids, blocks[1], scaled(-1.0, normal_of(solids, face)))
    corners = lying_over(solids, faces[0], faces[1], room)
    if corners < 3:
        return count
    area = area_of(room, corners)
    for i in range(corners):
        share = turn_at(room, corners, i)
        if share > ONE_PLACE:
            if count < len(table):
                meet(solids, faces, blocks, triple(room, i), table[count])
                table[count].share, table[count].area = share, area
                table[count].sides = sides_between(solids, faces)
            count += 1
    return count


Quad = tuple[Vector, Vector, Vector, Vector]
"""Corners of a quadrilateral [m], one after the other."""


class Grid(NamedTuple):
    """How a common area is divided: numbers of corners and of quadrilaterals, each of along x across cells."""

    corners: int
    quads: int
    along: int
    across: int


@inlined
def straightened(polygon: Array, count: int, room: Array) -> int:
    """Remove corners of a polygon on straight edges. Returns how many are left."""
    left = 0
    for i in range(count):
        if turn_at(polygon, count, i) > ONE_PLACE:
            put(room[left], triple(polygon, i))
            left += 1
    for i in range(left):
        put(polygon[i], triple(room, i))
    return left


@inlined
def grid_of(polygon: Array, corners: int, cells: tuple[int, int]) -> Grid:
    """The grid of a common area with a given number of cells a side: along x and z, and along y."""
    if corners != 4:
        return Grid(corners, corners, (cells[0] + 1) // 2, (cells[0] + 1) // 2)
    way = minus(triple(polygon, 1), triple(polygon, 0))
    if abs(way[1]) > 0.5 * length_of(way):
        return Grid(corners, 1, cells[1], cells[0])
    return Grid(corners, 1, cells[0], cells[1])


@inlined
def nodes_of(grid: Grid) -> int:
    """How many nodes a grid has."""
    if grid.quads == 1:
        return (grid.along + 1) * (grid.across + 1)
    return grid.quads * grid.along * (grid.along + 1) + 1


@inlined
def number_of(grid: Grid, quad: int, i: int, j: int) -> int:
    """Number of node i, j of a quadrilateral. The last row of one is the last column of the next, and the middle is
    common to all."""
    if grid.quads == 1:
        return i * (grid.across + 1) + j
    side, each = grid.along, grid.along * (grid.along + 1)
    if j < side:
        return quad * each + i * side + j
    if i < side:
        return (quad - 1 if quad > 0 else grid.quads - 1) * each + side * side + i
    return grid.quads * each


@inlined
def middle_of(polygon: Array, count: int) -> Vector:
    """Centroid of the area of a polygon [m]."""
    first, area = triple(polygon, 0), 0.0
    off = scaled(0.0, first)
    for i in range(1, count - 1):
        one, other = minus(triple(polygon, i), first), minus(triple(polygon, i + 1), first)
        part = length_of(spun(one, other))
        area, off = area + part, plus(off, scaled(part / 3, plus(one, other)))
    return plus(first, scaled(1 / area, off))


@inlined
def quad_of(polygon: Array, grid: Grid, quad: int, middle: Vector) -> Quad:
    """One of the quadrilaterals of a part."""
    here = triple(polygon, quad)
    after = triple(polygon, (quad + 1) % grid.corners)
    before = triple(polygon, (quad + grid.corners - 1) % grid.corners)
    if grid.quads == 1:
        return here, after, triple(polygon, 2), before
    return here, scaled(0.5, plus(here, after)), middle, scaled(0.5, plus(here, before))


@inlined
def of_corners(s: float, t: float) -> tuple[float, float, float, float]:
    """Bilinear weights of the corners of a quadrilateral."""
    return (1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t


@inlined
def place_in(quad: Quad, s: float, t: float) -> Vector:
    """A place in a quadrilateral [m]."""
    a, b, c, d = of_corners(s, t)
    return plus(plus(scaled(a, quad[0]), scaled(b, quad[1])), plus(scaled(c, quad[2]), scaled(d, quad[3])))


@inlined
def density_at(quad: Quad, s: float, t: float) -> float:
    """Area per unit of s and t there [m2], the determinant of the map, which is bilinear."""
    a, b, c, d = of_corners(s, t)
    ab, bc, cd, da = minus(quad[1], quad[0]), minus(quad[2], quad[1]), minus(quad[3], quad[2]), minus(quad[0], quad[3])
    low = a * length_of(spun(da, ab)) + b * length_of(spun(ab, bc))
    return low + c * length_of(spun(bc, cd)) + d * length_of(spun(cd, da))


@inlined
def stands_for(quad: Quad, grid: Grid, i: int, j: int) -> float:
    """Tributary area of node i, j of a quadrilateral [m2]: the integral of its weight over the cells beside it."""
    across, along, area = 1 / grid.across, 1 / grid.along, 0.0
    at_node = density_at(quad, i * along, j * across)
    for x in range(2):
        for y in range(2):
            if 0 <= i - x < grid.along and 0 <= j - y < grid.across:
                middle = density_at(quad, (i - x + 0.5) * along, (j - y + 0.5) * across)
                area += (at_node + 2 * middle) / 12 * along * across
    return area


@inlined
def is_corner(grid: Grid, i: int, j: int) -> bool:
    """Whether node i, j of a quadrilateral is a corner of the part."""
    if grid.quads == 1:
        return (i == 0 or i == grid.along) and (j == 0 or j == grid.across)
    return i == 0 and j == 0


@inlined
def is_on_edge(grid: Grid, i: int, j: int) -> bool:
    """Whether node i, j of a quadrilateral is on an edge of the part."""
    return i == 0 or j == 0 or (grid.quads == 1 and (i == grid.along or j == grid.across))


@inlined
def is_at_outline(solids: Solids, face: int, at: Vector) -> bool:
    """Whether a place of the plane of a face is on its outline."""
    nearest = math.inf
    for i in range(solids.first[face], solids.first[face + 1]):
        corner = corner_of(solids, i)
        along = minus(next_corner(solids, face, i), corner)
        nearest = min(nearest, distance_from(at, corner, along))
    return nearest < ONE_PLACE * longest_edge(solids, face)


@inlined
def press_at(
    solids: Solids,
    faces: tuple[int, int],
    blocks: tuple[int, int],
    at: Vector,
    on_edge: bool,
    place: Row,
) -> None:
    """Write a place of the common area of two faces that is not a corner of it: a point of the upper face, or, on an
    edge of the lower face alone, a point of that edge on the upper face.
    """
    face, over = faces
    normal = normal_of(solids, face)
    gap = dot(normal, minus(at, corner_of(solids, solids.first[face])))
    if on_edge and not is_at_outline(solids, over, at):
        below, normal = minus(at, scaled(gap, normal)), normal_of(solids, over)
        gap = dot(normal, minus(below, corner_of(solids, solids.first[over])))
        write_place(place, (blocks[1], blocks[0]), below, normal, gap)
    else:
        write_place(place, blocks, at, normal, gap)


@inlined
def lay_out(
    solids: Solids,
    face: int,
    blocks: tuple[int, int],
    cells: tuple[int, int],
    table: Rows,
    count: int,
    room: Array,
) -> int:
    """Write the places where a block lies over a face of another, in the grid of their joint. Returns how many places
    there are then.

    Args:
        solids, face, blocks, table, count, room: as of `clipping.clip`.
        cells: of the grid, along x and z and along y.
    """
    faces = face, face_towards(solids, blocks[1], scaled(-1.0, normal_of(solids, face)))
    corners = lying_over(solids, faces[0], faces[1], room)
    corners = straightened(room, corners, room[len(room) // 2 :])
    if corners < 3:
        return count
    grid = grid_of(room, corners, cells)
    nodes = nodes_of(grid)
    if count + nodes > len(table):
        return count + nodes
    area, middle = area_of(room, corners), middle_of(room, corners)
    for node in range(count, count + nodes):
        table[node].share, table[node].area = 0.0, area
    for q in range(grid.quads):
        quad = quad_of(room, grid, q, middle)
        for i in range(grid.along + 1):
            for j in range(grid.across + 1):
                number, at = count + number_of(grid, q, i, j), place_in(quad, i / grid.along, j / grid.across)
                table[number].share += stands_for(quad, grid, i, j) / area
                if is_corner(grid, i, j):
                    meet(solids, faces, blocks, at, table[number])
                else:
                    press_at(solids, faces, blocks, at, is_on_edge(grid, i, j), table[number])
                table[number].sides = sides_between(solids, faces)
    return count + nodes
