"""Solids: convex blocks as corners, faces and edges, where they are. Blocks of the plane are prisms."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ...compiled import compiled_at_once, inlined
from ...geometry.frames import SPACE
from ...geometry.hull import prism
from ...geometry.vectors import Vector, increase, put, vector
from ...problem.masonry.blocks.compound import AnyBlock, Compound
from ...problem.masonry.blocks.polygon import Polygon
from ...problem.masonry.blocks.polyhedron import Polyhedron
from ...quantities import Array, Flags, Integers


class Solid(NamedTuple):
    """A block in space, with the fields of a `Polyhedron` that are asked for."""

    corners: Array
    faces: tuple[tuple[int, ...], ...]
    normals: Array
    edges: Array
    volume: float


class Solids(NamedTuple):
    """Convex solids in space: blocks, or the parts of a block that is not convex.

    Args:
        corners: of all blocks [m], shape (corners, 3).
        corner: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        normals: out of the faces of all blocks, shape (faces, 3).
        face: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        ways: directions of the edges of all blocks, parallel ones once, shape (ways, 3).
        way: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        outline: numbers of the corners around each face, one face after the other.
        first: where those of each face begin, and where those of the last end, shape (faces + 1,).
        inside: which faces lie inside the block that they are a part of, where nothing meets them, shape (faces,).
        owner: number of the block that each solid is a part of, shape (solids,).
        extent: length of the outline of each face [m], of prisms of the plane without their length, shape (faces,).
    """

    corners: Array
    corner: Integers
    normals: Array
    face: Integers
    ways: Array
    way: Integers
    outline: Integers
    first: Integers
    inside: Flags
    owner: Integers
    extent: Array

    @classmethod
    def about(
        cls,
        blocks: Sequence[Solid | Polyhedron],
        centroids: Array,
        inside: Sequence[Flags],
        owner: Integers,
        axes: tuple[int, ...] = SPACE.axes,
    ) -> Solids:
        """Solids about the centroids of their blocks [m], shape (solids, 3). Outlines are measured along the axes."""
        corner = _begins(block.corners for block in blocks)
        outlines = [np.add(face, at) for block, at in zip(blocks, corner[:-1], strict=True) for face in block.faces]
        corners = np.concatenate([block.corners - at for block, at in zip(blocks, centroids, strict=True)])
        around = [np.diff(corners[[*outline, outline[0]]][:, axes], axis=0) for outline in outlines]
        return cls(
            corners,
            corner,
            np.concatenate([block.normals for block in blocks]),
            _begins(block.normals for block in blocks),
            np.concatenate([block.edges for block in blocks]),
            _begins(block.edges for block in blocks),
            np.concatenate(outlines),
            _begins(outlines),
            np.concatenate(inside),
            owner,
            np.array([np.linalg.norm(ways, axis=1).sum() for ways in around]),
        )

    def moved(self, place: Array, change: Array) -> Solids:
        """The blocks at centroids [m], shape (blocks, 3), turned from where they are by rotations less 1."""
        corners, normals, ways = (np.empty_like(each) for each in (self.corners, self.normals, self.ways))
        moved = self._replace(corners=corners, normals=normals, ways=ways)
        move(self, place, change, moved)
        return moved


class Poses(NamedTuple):
    """Where all blocks are.

    Args:
        drawn: the centroids as drawn [m], shape (blocks, d).
        moved: their displacements from there [m], shape (blocks, d).
        change: rotations less 1, shape (blocks, d, d).
    """

    drawn: Array
    moved: Array
    change: Array


@inlined
def changed(change: Array, a: Vector) -> Vector:
    """A vector after a rotation, given by the rotation less 1."""
    if len(a) == 2:
        return (
            a[0] + change[0, 0] * a[0] + change[0, 1] * a[1],
            a[1] + change[1, 0] * a[0] + change[1, 1] * a[1],
        )
    return (
        a[0] + change[0, 0] * a[0] + change[0, 1] * a[1] + change[0, 2] * a[2],
        a[1] + change[1, 0] * a[0] + change[1, 1] * a[1] + change[1, 2] * a[2],
        a[2] + change[2, 0] * a[0] + change[2, 1] * a[1] + change[2, 2] * a[2],
    )


@compiled_at_once
def move(solids: Solids, place: Array, change: Array, moved: Solids) -> None:
    """Write where solids are, see `Solids.moved`."""
    for b in range(len(place)):
        turn = change[b]
        for i in range(solids.corner[b], solids.corner[b + 1]):
            put(moved.corners[i], changed(turn, vector(solids.corners, i, SPACE.axes)))
            increase(moved.corners[i], vector(place, b, SPACE.axes))
        for i in range(solids.face[b], solids.face[b + 1]):
            put(moved.normals[i], changed(turn, vector(solids.normals, i, SPACE.axes)))
        for i in range(solids.way[b], solids.way[b + 1]):
            put(moved.ways[i], changed(turn, vector(solids.ways, i, SPACE.axes)))


def _begins(tables: Iterable[Array | Integers]) -> Integers:
    """Where each of some tables begins, one after the other, and where the last one ends."""
    return np.cumsum([0, *map(len, tables)])


def solids_of(blocks: Sequence[AnyBlock], half: float) -> list[Solid | Polyhedron]:
    """The convex parts of blocks in space: those of the plane as prisms of some half length [m]."""
    parts = (part for block in blocks for part in block.parts)
    return [solid_of(part, half) if isinstance(part, Polygon) else part for part in parts]


def inside_of(block: AnyBlock) -> list[Flags]:
    """Which faces of each solid of a block lie inside it, a prism's two ends before its sides. Nothing meets the ends,
    as nothing meets a face inside."""
    ends = np.ones(0 if block.in_space else 2, dtype=bool)
    flags = block.surface.inside if isinstance(block, Compound) else [np.zeros(len(block.sides), dtype=bool)]
    return [np.append(ends, some) for some in flags]


def solid_of(block: Polygon, half: float) -> Solid:
    """A block of the plane as a prism from y = -half to half. (`Polyhedron.prism` searches its corners for a hull.)

    It has no edges that cross others: those along y meet faces as their corners do."""
    across, normals = np.array([(0.0, -1.0, 0.0), (0.0, 1.0, 0.0)]), np.zeros((len(block.corners), 3))
    normals[:, ::2] = block.normals
    corners, faces = prism(block.corners, 2 * half)
    return Solid(corners, faces, np.concatenate([across, normals]), np.empty((0, 3)), 2 * half * block.area)
