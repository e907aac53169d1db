"""Clipping: the places where a face of one block lies over a face of another.

The part of one face that lies over the other is bounded by corners of either and by places where edges cross. Each of
them is a place: a corner meets the other face, and edges that cross meet along the normal of both. It stands for half
of the two sides of the part that meet there, over its whole outline. So places that fall together stand for what one
stood for.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined, jitable
from ..geometry.frames import SPACE
from ..geometry.vectors import Vector, dot, minus, plus, put, scaled, spun, vector
from ..problem.masonry.polyhedron import Polyhedron
from ..quantities import Array, Flags, Integers

ALONG = 0.995
"""Cosine of the angle between a normal and that of a face below which the meeting is one of edges [-]."""
OUTSIDE = 1e-9
"""Distance of a corner beyond an edge within which it counts as on it, over the length of the edges [-]."""
SAME = 1e-6
"""Distance of two places that are one, over the length of an edge [-]."""
PARALLEL = 1e-3
"""Sine of the angle of two edges below which they do not cross [-]."""


class Shapes(NamedTuple):
    """Blocks as faces.

    Args:
        corners: of all blocks, from their centroids [m], shape (corners, 3).
        normals: of the faces of all blocks, shape (faces, 3).
        face: where the faces of each block begin, and where those of the last end, shape (blocks + 1,).
        outline: numbers of the corners around each face, one face after the other.
        first: where those of each face begin, and where those of the last end, shape (faces + 1,).
    """

    corners: Array
    normals: Array
    face: Integers
    outline: Integers
    first: Integers

    @classmethod
    def of(cls, blocks: list[Polyhedron], centroids: Array) -> Shapes:
        """The faces of blocks, shape of the centroids (blocks, 3)."""
        before = np.cumsum([0, *(len(block.corners) for block in blocks)])
        outlines = [np.add(face, at) for block, at in zip(blocks, before[:-1], strict=True) for face in block.faces]
        return cls(
            np.concatenate([block.corners - at for block, at in zip(blocks, centroids, strict=True)]),
            np.concatenate([block.normals for block in blocks]),
            np.cumsum([0, *(len(block.faces) for block in blocks)]),
            np.concatenate(outlines),
            np.cumsum([0, *map(len, outlines)]),
        )


@inlined
def turned(matrix: Array, block: int, a: Array) -> Vector:
    """A vector of a block in the axes of the world."""
    m = matrix[block]
    return (
        m[0, 0] * a[0] + m[0, 1] * a[1] + m[0, 2] * a[2],
        m[1, 0] * a[0] + m[1, 1] * a[1] + m[1, 2] * a[2],
        m[2, 0] * a[0] + m[2, 1] * a[1] + m[2, 2] * a[2],
    )


@jitable
def corner_of(shapes: Shapes, place: Array, matrix: Array, block: int, number: int) -> Vector:
    """Where a corner of the outline of a face of a block is [m]."""
    return plus(vector(place, block, SPACE.axes), turned(matrix, block, shapes.corners[shapes.outline[number]]))


@jitable
def face_along(shapes: Shapes, matrix: Array, block: int, way: Vector) -> tuple[int, float]:
    """The face of a block whose normal is nearest to a direction, and the cosine between them."""
    best, largest = -1, -2.0
    for face in range(shapes.face[block], shapes.face[block + 1]):
        cosine = dot(turned(matrix, block, shapes.normals[face]), way)
        if cosine > largest:
            best, largest = face, cosine
    return best, largest


@jitable
def cut(polygon: Array, count: int, way: Vector, reach: float, slack: float, room: Array) -> int:
    """Cut a polygon to where it reaches no further along a direction. Returns how many corners are left."""
    left = 0
    for i in range(count):
        a, b = vector(polygon, i, way), vector(polygon, (i + 1) % count, way)
        beyond, next_beyond = dot(way, a) - reach, dot(way, b) - reach
        if beyond <= slack:
            put(room[left], a)
            left += 1
        if (beyond <= slack) != (next_beyond <= slack):
            share = min(max(beyond / (beyond - next_beyond), 0.0), 1.0)
            put(room[left], plus(a, scaled(share, minus(b, a))))
            left += 1
    for i in range(left):
        put(polygon[i], vector(room, i, way))
    return left


@jitable
def lying_over(
    shapes: Shapes, place: Array, matrix: Array, face: int, block: int, over: int, other: int, room: Array
) -> int:
    """Write the part of a face of another block that lies over the face of a block into the first half of the room.

    Returns:
        How many corners it has.
    """
    count, extent, polygon, further = 0, 0.0, room[: len(room) // 2], room[len(room) // 2 :]
    for i in range(shapes.first[over], shapes.first[over + 1]):
        put(polygon[count], corner_of(shapes, place, matrix, other, i))
        count += 1
    normal = turned(matrix, block, shapes.normals[face])
    first, last = shapes.first[face], shapes.first[face + 1]
    for i in range(first, last):
        a = corner_of(shapes, place, matrix, block, i)
        way = spun(minus(corner_of(shapes, place, matrix, block, first if i + 1 == last else i + 1), a), normal)
        length = math.sqrt(dot(way, way))
        extent = max(extent, length)
        way = scaled(1 / length, way)
        count = cut(polygon, count, way, dot(way, a), OUTSIDE * extent, further)
    return count


@inlined
def edge_length(polygon: Array, i: int, j: int, axes: tuple[int, ...]) -> float:
    """Distance of two corners of a polygon [m]."""
    edge = minus(vector(polygon, i, axes), vector(polygon, j, axes))
    return math.sqrt(dot(edge, edge))


@jitable
def distance_of_edge(room: Array, a: Vector, b: Vector, i: int) -> float:
    """Distance of a place from an edge [m]."""
    along, off = minus(b, a), minus(vector(room, i, a), a)
    across = spun(along, off)
    return math.sqrt(dot(across, across) / dot(along, along))


@jitable
def write_place(table: Array, count: int, pair: int, owner: int, at: Vector, normal: Vector, gap: float) -> None:
    """Write a place, halfway into its gap from the point on the block that is not the owner."""
    table[count, 0], table[count, 1], table[count, 8] = pair, owner, gap
    put(table[count, 2:5], minus(at, scaled(0.5 * gap, normal)))
    put(table[count, 5:8], normal)


@jitable
def meet(
    shapes: Shapes,
    place: Array,
    matrix: Array,
    faces: tuple[int, int],
    blocks: tuple[int, int],
    room: Array,
    i: int,
    table: Array,
    count: int,
    pair: int,
) -> None:
    """Write what corner i of the part of a face that lies over another is: a corner of either, or edges that cross.

    Args:
        shapes, place, matrix: the blocks and where they are.
        faces, blocks: the face below and that over it, and their blocks.
        room: corners of the part.
        i: number of the corner.
        table, count: where to write.
        pair: number of the pair.
    """
    (face, over), (block, other), axes = faces, blocks, SPACE.axes
    at = vector(room, i, axes)
    normal, base = turned(matrix, block, shapes.normals[face]), corner_of(shapes, place, matrix, block, shapes.first[face])
    nearest, first, last = math.inf, shapes.first[over], shapes.first[over + 1]
    edge, from_edge = first, math.inf
    for j in range(first, last):
        corner = corner_of(shapes, place, matrix, other, j)
        off, after = minus(corner, at), corner_of(shapes, place, matrix, other, first if j + 1 == last else j + 1)
        nearest = min(nearest, math.sqrt(dot(off, off)))
        distance = distance_of_edge(room, corner, after, i)
        if distance < from_edge:
            edge, from_edge = j, distance
    after = corner_of(shapes, place, matrix, other, first if edge + 1 == last else edge + 1)
    along = minus(after, corner_of(shapes, place, matrix, other, edge))
    close = SAME * math.sqrt(dot(along, along))
    if nearest < close:
        write_place(table, count, pair, block, at, normal, dot(normal, minus(at, base)))
        return
    own_normal = turned(matrix, other, shapes.normals[over])
    first, last = shapes.first[face], shapes.first[face + 1]
    crossed, from_crossed = base, math.inf
    way = along
    for j in range(first, last):
        corner = corner_of(shapes, place, matrix, block, j)
        own = minus(corner_of(shapes, place, matrix, block, first if j + 1 == last else j + 1), corner)
        off = minus(at, corner)
        off = minus(off, scaled(dot(off, normal), normal))
        if math.sqrt(dot(off, off)) < close:
            gap = dot(own_normal, minus(corner, corner_of(shapes, place, matrix, other, shapes.first[over])))
            write_place(table, count, pair, other, corner, own_normal, gap)
            return
        across = spun(own, off)
        distance = math.sqrt(dot(across, across) / dot(own, own))
        if distance < from_crossed:
            crossed, from_crossed, way = corner, distance, own
    across = spun(along, way)
    size = math.sqrt(dot(across, across))
    if size > PARALLEL * math.sqrt(dot(along, along) * dot(way, way)):
        normal = scaled(math.copysign(1 / size, dot(across, normal)), across)
    write_place(table, count, pair, block, at, normal, dot(normal, minus(at, crossed)))


@compiled
def clip(
    shapes: Shapes,
    place: Array,
    matrix: Array,
    pairs: Integers,
    normals: Array,
    table: Array,
    are_faces: Flags,
    room: Array,
) -> int:
    """Write the places of pairs of blocks whose meeting is one of faces.

    Args:
        shapes: the blocks.
        place, matrix: where they are [m], shapes (blocks, 3) and (blocks, 3, 3).
        pairs, normals: two blocks each, and the normal from the first to the second, shapes (n, 2) and (n, 3).
        table: room for pair, block of the face, place, normal out of it, gap [m] and share of each place, shape (most, 10).
        are_faces: room to say whether the meeting of each pair is one of faces, shape (n,).
        room: for the corners of two faces, twice.

    Returns:
        How many places there are. Those for which there is no room are not written.
    """
    count, axes = 0, SPACE.axes
    for pair in range(len(pairs)):
        first, second, way = pairs[pair, 0], pairs[pair, 1], vector(normals, pair, axes)
        face, cosine = face_along(shapes, matrix, first, way)
        other_face, other_cosine = face_along(shapes, matrix, second, scaled(-1.0, way))
        are_faces[pair] = False
        if max(cosine, other_cosine) < ALONG:
            continue
        swapped = other_cosine > cosine
        block, other, own = (second, first, other_face) if swapped else (first, second, face)
        normal = turned(matrix, block, shapes.normals[own])
        over, _ = face_along(shapes, matrix, other, scaled(-1.0, normal))
        corners = lying_over(shapes, place, matrix, own, block, over, other, room)
        if corners < 3:
            continue
        are_faces[pair] = True
        around = 0.0
        for i in range(corners):
            around += edge_length(room, i, (i + 1) % corners, axes)
        for i in range(corners):
            if count < len(table):
                edges = edge_length(room, i, (i + 1) % corners, axes)
                edges += edge_length(room, i, i - 1 if i else corners - 1, axes)
                table[count, 9] = 0.5 * edges / around
                meet(shapes, place, matrix, (own, over), (block, other), room, i, table, count, pair)
            count += 1
    return count
