"""Clipping: contact places where a face of one block lies over a face of another.

The corners of the common area of two faces are corners of either face, or points where edges of both cross. Each is a
contact place: a corner is in contact with the other face, and crossing edges are in contact along their common normal.
The share of a place is the angle by which the outline turns there, over a whole turn: a quarter for each corner of a
rectangle. Places that coincide share that of one, and a place on a straight edge has none.

A pair of blocks that had a joint keeps the number of `points` of the joint, in the grid of `geometry.convex.spread`. A
common area of four corners is one quadrilateral with points - 1 cells a side, in the plane along the joint alone. Any
other area is divided into one quadrilateral for each corner, between that corner, the middles of its two edges and the
centroid, with half as many cells a side. The tributary area of each node is the integral of its bilinear weight, so
that the areas add up to the common area and the mean of the nodes, weighted by them, is its centroid.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, minus, norm, plus, put, scaled, spun, vector
from ...quantities import Array
from ...rows import Row, Rows, integers, numbers, row_type, vectors
from .constants import AS_LARGE, AS_TOWARDS, EDGES_ALONG_FACE, ON_EDGE, ONE_PLACE, PARALLEL_EDGES
from .solids import Solids, triple

PLACE = row_type(
    [*integers("face", "other"), *vectors(3, "at", "normal"), *numbers("gap", "share", "area"), *integers("sides")]
)
"""A contact place: block of the face, other block, position [m], normal out of the face, gap [m], share, common area
[m2], and number of the pair of sides, see `sides_between`."""


class Workspace(NamedTuple):
    """Arrays that a search writes.

    Args:
        places: rows of `PLACE`.
        corners: room for the corners of two faces, twice [m], shape (n, 3).
    """

    places: Rows
    corners: Array


@inlined
def corner_of(solids: Solids, number: int) -> Vector:
    """Position of a corner of an outline [m]."""
    return triple(solids.corners, solids.outline[number])


@inlined
def next_corner(solids: Solids, face: int, number: int) -> Vector:
    """Position of the corner that follows another one in the outline of a face [m]."""
    return corner_of(solids, solids.first[face] if number + 1 == solids.first[face + 1] else number + 1)


@inlined
def normal_of(solids: Solids, face: int) -> Vector:
    """The normal of a face."""
    return triple(solids.normals, face)


@inlined
def longest_edge(solids: Solids, face: int) -> float:
    """Length of the longest edge of a face [m], to which small distances are compared.

    The edge beside a corner would not do: in a mirror image, whose outline runs the other way round, it is another one.
    """
    longest = 0.0
    for i in range(solids.first[face], solids.first[face + 1]):
        longest = max(longest, norm(minus(next_corner(solids, face, i), corner_of(solids, i))))
    return longest


@inlined
def face_towards(solids: Solids, block: int, direction: Vector) -> int:
    """The face of a block whose normal is nearest to a direction. Of equally near ones `is_before` chooses."""
    best, largest = -1, -math.inf
    for face in range(solids.face[block], solids.face[block + 1]):
        cosine = dot(normal_of(solids, face), direction)
        ahead = cosine - largest
        if ahead > AS_TOWARDS or (ahead >= -AS_TOWARDS and is_before(solids, face, best)):
            best, largest = face, cosine
    return best


@inlined
def is_before(solids: Solids, face: int, other: int) -> bool:
    """Whether a face of a block comes before another one of it that would do as well: it is larger, or as large and
    faces further upwards. The choice depends on neither the numbers of faces nor the axes, where faces differ so."""
    longer = solids.extent[face] - solids.extent[other]
    if abs(longer) > AS_LARGE * solids.extent[other]:
        return bool(longer > 0)
    return bool(solids.normals[face, 2] > solids.normals[other, 2] + AS_LARGE)


@inlined
def sides_between(solids: Solids, faces: tuple[int, int]) -> int:
    """A number of the pair of sides on which two faces lie."""
    side, other_side = solids.side[faces[0]], solids.side[faces[1]]
    number: int = min(side, other_side) * len(solids.side) + max(side, other_side)
    return number


@inlined
def cut(polygon: Array, count: int, direction: Vector, reach: float, slack: float, room: Array) -> int:
    """Cut off the part of a polygon beyond a limit along a direction. Returns the number of its corners.

    A convex polygon gains at most one corner. A polygon that rounding has made concave may gain more, up to the size of
    the room."""
    kept = 0
    for i in range(count):
        a, b = vector(polygon, i, direction), vector(polygon, (i + 1) % count, direction)
        beyond, next_beyond = dot(direction, a) - reach, dot(direction, b) - reach
        if beyond <= slack and kept < len(room):
            put(room[kept], a)
            kept += 1
        if (beyond <= slack) != (next_beyond <= slack) and kept < len(room):
            share = min(max(beyond / (beyond - next_beyond), 0.0), 1.0)
            put(room[kept], plus(a, scaled(share, minus(b, a))))
            kept += 1
    for i in range(kept):
        put(polygon[i], vector(room, i, direction))
    return kept


@inlined
def without_duplicates(polygon: Array, count: int, slack: float) -> int:
    """Remove corners of a polygon within a distance of the corner before. Returns the number of its corners."""
    kept = 0
    for i in range(count):
        at, last = triple(polygon, i), triple(polygon, kept - 1 if kept else count - 1)
        if norm(minus(at, last)) > slack:
            put(polygon[kept], at)
            kept += 1
    return kept


@inlined
def common_area(solids: Solids, face: int, over: int, room: Array) -> int:
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
        outwards = spun(minus(next_corner(solids, face, i), a), normal)
        outwards = scaled(1 / norm(outwards), outwards)
        count = cut(polygon, count, outwards, dot(outwards, a), slack, further)
    return without_duplicates(polygon, count, slack)


@inlined
def turn_share(polygon: Array, count: int, i: int) -> float:
    """Angle by which the outline of a polygon turns at a corner, over a whole turn [-]."""
    at = triple(polygon, i)
    before = minus(at, triple(polygon, i - 1 if i else count - 1))
    after = minus(triple(polygon, (i + 1) % count), at)
    return math.atan2(norm(spun(before, after)), dot(before, after)) / (2 * math.pi)


@inlined
def area_of(polygon: Array, count: int) -> float:
    """Area of a polygon [m2]."""
    first, area = triple(polygon, 0), 0.0
    for i in range(1, count - 1):
        corner, following = triple(polygon, i), triple(polygon, i + 1)
        area += 0.5 * norm(spun(minus(corner, first), minus(following, first)))
    return area


@inlined
def distance_from(at: Vector, a: Vector, along: Vector) -> float:
    """Distance of a place from the line through another one [m]."""
    return norm(spun(along, minus(at, a))) / norm(along)


@inlined
def write_place(place: Row, blocks: tuple[int, int], at: Vector, normal: Vector, gap: float) -> None:
    """Write the place of a face of the first block and a point of the other block."""
    place.face, place.other, place.gap, place.sides = blocks[0], blocks[1], gap, -1
    put(place.at, minus(at, scaled(0.5 * gap, normal)))
    put(place.normal, normal)


@inlined
def write_corner(solids: Solids, faces: tuple[int, int], blocks: tuple[int, int], at: Vector, place: Row) -> None:
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
        if norm(minus(at, corner)) < one_place:
            gap = dot(normal, minus(at, corner_of(solids, solids.first[face])))
            write_place(place, blocks, at, normal, gap)
            return
        distance = distance_from(at, corner, along)
        if distance < from_edge:
            edge, from_edge = i, distance
    crossed, from_crossed, one_place = -1, math.inf, ONE_PLACE * longest_edge(solids, face)
    for i in range(solids.first[face], solids.first[face + 1]):
        corner = corner_of(solids, i)
        edge_below, off = minus(next_corner(solids, face, i), corner), minus(at, corner)
        off = minus(off, scaled(dot(off, normal), normal))
        if norm(off) < one_place:
            normal = normal_of(solids, over)
            gap = dot(normal, minus(corner, corner_of(solids, solids.first[over])))
            write_place(place, (blocks[1], blocks[0]), corner, normal, gap)
            return
        distance = distance_from(off, scaled(0.0, edge_below), edge_below)
        if distance < from_crossed:
            crossed, from_crossed = i, distance
    below = corner_of(solids, crossed)
    edge_below, along = (
        minus(next_corner(solids, face, crossed), below),
        minus(next_corner(solids, over, edge), corner_of(solids, edge)),
    )
    common = spun(along, edge_below)
    size = norm(common)
    if abs(dot(common, normal)) > EDGES_ALONG_FACE * size and size > PARALLEL_EDGES * norm(along) * norm(edge_below):
        normal = scaled(math.copysign(1 / size, dot(common, normal)), common)
    write_place(place, blocks, at, normal, dot(normal, minus(at, below)))


@inlined
def clip(solids: Solids, face: int, blocks: tuple[int, int], work: Workspace, count: int) -> int:
    """Write the places where a block lies over a face of another. Returns the number of places in the table.

    Args:
        solids: the blocks where they are.
        face, blocks: the face, its block, and the other one.
        work: the table of places, and room for corners.
        count: number of places in the table.
    """
    table, room = work
    faces = face, face_towards(solids, blocks[1], scaled(-1.0, normal_of(solids, face)))
    corners = common_area(solids, faces[0], faces[1], room)
    if corners < 3:
        return count
    area = area_of(room, corners)
    for i in range(corners):
        share = turn_share(room, corners, i)
        if share > ONE_PLACE:
            if count < len(table):
                write_corner(solids, faces, blocks, triple(room, i), table[count])
                table[count].share, table[count].area = share, area
                table[count].sides = sides_between(solids, faces)
            count += 1
    return count


Quad = tuple[Vector, Vector, Vector, Vector]
"""Corners of a quadrilateral [m], one after the other."""


class Grid(NamedTuple):
    """How a common area is divided: numbers of its corners, of quadrilaterals, and of cells of each along s and t."""

    corners: int
    quads: int
    cells_s: int
    cells_t: int


@inlined
def straightened(polygon: Array, count: int, room: Array) -> int:
    """Remove corners of a polygon on straight edges. Returns the number of its corners."""
    kept = 0
    for i in range(count):
        if turn_share(polygon, count, i) > ONE_PLACE:
            put(room[kept], triple(polygon, i))
            kept += 1
    for i in range(kept):
        put(polygon[i], triple(room, i))
    return kept


@inlined
def grid_of(polygon: Array, corners: int, cells: tuple[int, int]) -> Grid:
    """The grid of a common area with a given number of cells a side: along x and z, and along y."""
    if corners != 4:
        return Grid(corners, corners, (cells[0] + 1) // 2, (cells[0] + 1) // 2)
    edge = minus(triple(polygon, 1), triple(polygon, 0))
    if abs(edge[1]) > 0.5 * norm(edge):
        return Grid(corners, 1, cells[1], cells[0])
    return Grid(corners, 1, cells[0], cells[1])


@inlined
def node_count(grid: Grid) -> int:
    """Number of nodes of a grid."""
    if grid.quads == 1:
        return (grid.cells_s + 1) * (grid.cells_t + 1)
    return grid.quads * grid.cells_s * (grid.cells_s + 1) + 1


@inlined
def node_number(grid: Grid, quad: int, i: int, j: int) -> int:
    """Number of node i, j of a quadrilateral in its grid. The last row of one is the last column of the next one, and
    the centroid is a node of all."""
    if grid.quads == 1:
        return i * (grid.cells_t + 1) + j
    side, nodes_of_quad = grid.cells_s, grid.cells_s * (grid.cells_s + 1)
    if j < side:
        return quad * nodes_of_quad + i * side + j
    if i < side:
        return (quad - 1 if quad > 0 else grid.quads - 1) * nodes_of_quad + side * side + i
    return grid.quads * nodes_of_quad


@inlined
def middle_of(polygon: Array, count: int) -> Vector:
    """Centroid of the area of a polygon [m]."""
    first, area = triple(polygon, 0), 0.0
    off = scaled(0.0, first)
    for i in range(1, count - 1):
        to_corner, to_next = minus(triple(polygon, i), first), minus(triple(polygon, i + 1), first)
        part = norm(spun(to_corner, to_next))
        area, off = area + part, plus(off, scaled(part / 3, plus(to_corner, to_next)))
    return plus(first, scaled(1 / area, off))


@inlined
def quad_of(polygon: Array, grid: Grid, quad: int, middle: Vector) -> Quad:
    """One of the quadrilaterals of a common area."""
    corner = triple(polygon, quad)
    after = triple(polygon, (quad + 1) % grid.corners)
    before = triple(polygon, (quad + grid.corners - 1) % grid.corners)
    if grid.quads == 1:
        return corner, after, triple(polygon, 2), before
    return corner, scaled(0.5, plus(corner, after)), middle, scaled(0.5, plus(corner, before))


@inlined
def bilinear_weights(s: float, t: float) -> tuple[float, float, float, float]:
    """Bilinear weights of the corners of a quadrilateral."""
    return (1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t


@inlined
def point_in(quad: Quad, s: float, t: float) -> Vector:
    """Position of s, t in a quadrilateral [m]."""
    a, b, c, d = bilinear_weights(s, t)
    return plus(plus(scaled(a, quad[0]), scaled(b, quad[1])), plus(scaled(c, quad[2]), scaled(d, quad[3])))


@inlined
def density_at(quad: Quad, s: float, t: float) -> float:
    """Jacobian of the bilinear map from s, t [m2]."""
    a, b, c, d = bilinear_weights(s, t)
    ab, bc, cd, da = minus(quad[1], quad[0]), minus(quad[2], quad[1]), minus(quad[3], quad[2]), minus(quad[0], quad[3])
    low = a * norm(spun(da, ab)) + b * norm(spun(ab, bc))
    return low + c * norm(spun(bc, cd)) + d * norm(spun(cd, da))


@inlined
def tributary_area(quad: Quad, grid: Grid, i: int, j: int) -> float:
    """Tributary area of node i, j of a quadrilateral [m2]: the integral of its weight over the cells around it."""
    step_t, step_s, area = 1 / grid.cells_t, 1 / grid.cells_s, 0.0
    at_node = density_at(quad, i * step_s, j * step_t)
    for x in range(2):
        for y in range(2):
            if 0 <= i - x < grid.cells_s and 0 <= j - y < grid.cells_t:
                middle = density_at(quad, (i - x + 0.5) * step_s, (j - y + 0.5) * step_t)
                area += (at_node + 2 * middle) / 12 * step_s * step_t
    return area


@inlined
def is_corner(grid: Grid, i: int, j: int) -> bool:
    """Whether node i, j of a quadrilateral is a corner of the common area."""
    if grid.quads == 1:
        return (i == 0 or i == grid.cells_s) and (j == 0 or j == grid.cells_t)
    return i == 0 and j == 0


@inlined
def is_on_edge(grid: Grid, i: int, j: int) -> bool:
    """Whether node i, j of a quadrilateral is on an edge of the common area."""
    return i == 0 or j == 0 or (grid.quads == 1 and (i == grid.cells_s or j == grid.cells_t))


@inlined
def is_at_outline(solids: Solids, face: int, at: Vector) -> bool:
    """Whether a point in the plane of a face is on its outline."""
    nearest = math.inf
    for i in range(solids.first[face], solids.first[face + 1]):
        corner = corner_of(solids, i)
        along = minus(next_corner(solids, face, i), corner)
        nearest = min(nearest, distance_from(at, corner, along))
    return nearest < ONE_PLACE * longest_edge(solids, face)


@inlined
def write_inner_point(
    solids: Solids,
    faces: tuple[int, int],
    blocks: tuple[int, int],
    at: Vector,
    on_edge: bool,
    place: Row,
) -> None:
    """Write a place of the common area of two faces that is not a corner of it: a point of the upper face on the lower
    face, or on an edge of the lower face alone a point of that edge on the upper face.
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
def clip_in_grid(
    solids: Solids, face: int, blocks: tuple[int, int], cells: tuple[int, int], work: Workspace, count: int
) -> int:
    """Write the places where a block lies over a face of another, in the grid of their joint. Returns the number of
    places in the table.

    Args:
        solids, face, blocks, work, count: as of `clip`.
        cells: of the grid, along x and z and along y.
    """
    table, room = work
    faces = face, face_towards(solids, blocks[1], scaled(-1.0, normal_of(solids, face)))
    corners = common_area(solids, faces[0], faces[1], room)
    corners = straightened(room, corners, room[len(room) // 2 :])
    if corners < 3:
        return count
    grid = grid_of(room, corners, cells)
    nodes = node_count(grid)
    if count + nodes > len(table):
        return count + nodes
    area, middle = area_of(room, corners), middle_of(room, corners)
    for node in range(count, count + nodes):
        table[node].share, table[node].area = 0.0, area
    for q in range(grid.quads):
        quad = quad_of(room, grid, q, middle)
        for i in range(grid.cells_s + 1):
            for j in range(grid.cells_t + 1):
                number, at = count + node_number(grid, q, i, j), point_in(quad, i / grid.cells_s, j / grid.cells_t)
                table[number].share += tributary_area(quad, grid, i, j) / area
                if is_corner(grid, i, j):
                    write_corner(solids, faces, blocks, at, table[number])
                else:
                    write_inner_point(solids, faces, blocks, at, is_on_edge(grid, i, j), table[number])
                table[number].sides = sides_between(solids, faces)
    return count + nodes
