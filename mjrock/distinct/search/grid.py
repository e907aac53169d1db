"""The grid of points of a joint, laid out again over the common area of its two faces.

A pair that had a joint keeps the `points` of the joint. A common area of four corners is one quadrilateral, divided
into points - 1 cells a side, in the plane along the joint alone. Any other area is divided into a quadrilateral for
each corner, between that corner, the middles of its two edges and the centroid, with half as many cells a side. So the
grid is that of `geometry.convex.spread`. The tributary area of each point is the integral of its bilinear weight: the
sum of these areas is the common area, and their mean position is its centroid.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, minus, plus, put, scaled, spun
from ...quantities import Array
from ..rows import Row, Rows
from .clipping import (
    area_of,
    corner_of,
    distance_from,
    face_towards,
    length_of,
    longest_edge,
    lying_over,
    meet,
    next_corner,
    normal_of,
    parted,
    sides_between,
    turn_at,
    write_place,
)
from .constants import ONE_PLACE
from .solids import Solids, triple

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
    """The grid of a common area with so many cells a side: along x and z, and along y."""
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
    corners = parted(room, lying_over(solids, faces[0], faces[1], room))
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
