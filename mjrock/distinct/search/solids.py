"""Solids: convex blocks as corners, faces and edges, where they are. Blocks of the plane are prisms."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy

from ...compiled import compiled_at_once, inlined
from ...geometry.convex import cleaned
from ...geometry.frames import SPACE
from ...geometry.graph import connected_parts
from ...geometry.hull import Convex, Side, area_vector
from ...geometry.vectors import Vector, increase, put
from ...problem.masonry.blocks.joints import PARTS_APART
from ...problem.masonry.blocks.joints_in_space import tangent_axes
from ...problem.wall.rest_geometry import Solid
from ...quantities import Array, Flags, Integers


class Solids(NamedTuple):
    """Convex solids in space: blocks, or the parts of a block that is not convex.

    Args:
        corners: of all blocks [m], shape (corners, 3).
        corner: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        normals: out of the faces of all blocks, shape (faces, 3).
        face: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        edges: directions of the edges of all blocks, parallel ones once, shape (directions, 3).
        edge: where those of each block begin, and where those of the last end, shape (blocks + 1,).
        outline: numbers of the corners around each face, one face after the other.
        first: where those of each face begin, and where those of the last end, shape (faces + 1,).
        inside: which faces lie inside the block that they are a part of, where nothing meets them, shape (faces,).
        owner: number of the block that each solid is a part of, shape (solids,).
        extent: length of the outline of each face [m], of prisms of the plane without their length, shape (faces,).
        side: number of the side of its block that each face lies on, see `sides_of`, shape (faces,).
        around: numbers of the corners around the side of each face, one face after the other.
        begin: where those of each face begin, and where those of the last end, shape (faces + 1,).
    """

    corners: Array
    corner: Integers
    normals: Array
    face: Integers
    edges: Array
    edge: Integers
    outline: Integers
    first: Integers
    inside: Flags
    owner: Integers
    extent: Array
    side: Integers
    around: Integers
    begin: Integers

    @classmethod
    def about(
        cls,
        blocks: Sequence[Convex],
        centroids: Array,
        inside: Sequence[Flags],
        owner: Integers,
        side: Integers | None = None,
        *,
        flat: bool = False,
    ) -> Solids:
        """Solids about the centroids of their blocks [m], shape (solids, 3). Without sides, each face is one of its
        own. Outlines of prisms of the plane are measured without their length, and have no edges that cross others:
        those along y meet faces as their corners do."""
        corner = _begins(block.corners for block in blocks)
        outlines = [np.add(face, at) for block, at in zip(blocks, corner[:-1], strict=True) for face in block.faces]
        corners = np.concatenate([block.corners - at for block, at in zip(blocks, centroids, strict=True)])
        axes = (0, 2) if flat else SPACE.axes
        edges = [np.empty((0, 3)) if flat else block.edges for block in blocks]
        normals = np.concatenate([block.normals for block in blocks])
        side = np.arange(len(outlines)) if side is None else side
        around = whole_outlines(outlines, side, corners, normals)
        return cls(
            corners=corners,
            corner=corner,
            normals=normals,
            face=_begins(block.normals for block in blocks),
            edges=np.concatenate(edges),
            edge=_begins(edges),
            outline=np.concatenate(outlines),
            first=_begins(outlines),
            inside=np.concatenate(inside),
            owner=owner,
            extent=_lengths(corners[:, axes], outlines),
            side=side,
            around=np.concatenate(around),
            begin=_begins(around),
        )

    def moved(self, place: Array, change: Array) -> Solids:
        """The blocks at centroids [m], shape (blocks, 3), turned from where they are by rotations less 1."""
        corners, normals, edges = (np.empty_like(array) for array in (self.corners, self.normals, self.edges))
        moved = self._replace(corners=corners, normals=normals, edges=edges)
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
def triple(values: Array, i: int) -> Vector:
    """Row i of vectors of space."""
    return values[i, 0], values[i, 1], values[i, 2]


@inlined
def changed(change: Array, a: Vector) -> Vector:
    """A vector after a rotation, given by the rotation less 1. A spin of the plane stays."""
    if len(a) == 1:
        return a
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


@inlined
def with_whole_sides(solids: Solids) -> Solids:
    """The solids whose faces have the outlines of the sides that they lie on."""
    return Solids(
        corners=solids.corners,
        corner=solids.corner,
        normals=solids.normals,
        face=solids.face,
        edges=solids.edges,
        edge=solids.edge,
        outline=solids.around,
        first=solids.begin,
        inside=solids.inside,
        owner=solids.owner,
        extent=solids.extent,
        side=solids.side,
        around=solids.around,
        begin=solids.begin,
    )


@compiled_at_once
def move(solids: Solids, place: Array, change: Array, moved: Solids) -> None:
    """Write where solids are, see `Solids.moved`."""
    for b in range(len(place)):
        turn = change[b]
        for i in range(solids.corner[b], solids.corner[b + 1]):
            put(moved.corners[i], changed(turn, triple(solids.corners, i)))
            increase(moved.corners[i], triple(place, b))
        for i in range(solids.face[b], solids.face[b + 1]):
            put(moved.normals[i], changed(turn, triple(solids.normals, i)))
        for i in range(solids.edge[b], solids.edge[b + 1]):
            put(moved.edges[i], changed(turn, triple(solids.edges, i)))


def _begins(tables: Iterable[Array | Integers]) -> Integers:
    """Where each of some tables begins, one after the other, and where the last one ends."""
    return np.cumsum([0, *map(len, tables)])


def _lengths(corners: Array, outlines: Sequence[Integers]) -> Array:
    """Length of each outline, from the numbers of its corners [m], shape (outlines,)."""
    counts, lengths = np.array([len(outline) for outline in outlines]), np.empty(len(outlines))
    for count in np.unique(counts):
        numbers = np.flatnonzero(counts == count)
        rings = corners[np.array([outlines[i] for i in numbers.tolist()])]
        lengths[numbers] = np.linalg.norm(np.roll(rings, -1, axis=1) - rings, axis=2).sum(axis=1)
    return lengths


def parts_of(solids: Sequence[Solid], half: float, *, flat: bool) -> list[Convex]:
    """The convex parts of blocks: those of the plane as prisms from y = -half to half [m]."""
    parts = [part for solid in solids for part in solid.drawn]
    return [Convex(_reaching(part.corners, half), part.faces, part.normals) for part in parts] if flat else parts


def _reaching(corners: Array, half: float) -> Array:
    """The corners of a prism with another length."""
    x, y, z = corners.T
    return np.column_stack([x, np.copysign(half, y), z])


def sides_of(solids: Sequence[Solid]) -> Integers:
    """A number of the side of its block that each face of each part lies on, shape (faces,). Faces of parts that lie
    in one plane across a cut have one number, in space where they make a convex side, as their joints do."""
    first, flush_pairs = 0, list[tuple[int, int]]()
    for solid in solids:
        begin = first + np.cumsum([0, *map(len, solid.inside)])
        for side in (side for side in solid.sides if len(side.parts) > 1):
            faces = [
                int(begin[part]) + face
                for part in side.parts
                for face in np.flatnonzero(~solid.inside[part]).tolist()
                if _is_flush(solid.drawn[part], face, side)
            ]
            flush_pairs += pairwise(faces)
        first = int(begin[-1])
    return connected_parts(flush_pairs, first) if flush_pairs else np.arange(first)


def _is_flush(part: Convex, face: int, side: Side) -> bool:
    """Whether a face of a part lies in the plane of a side."""
    corners, normal, axes = part.corners[list(part.faces[face])], part.normals[face], SPACE.axes
    if len(side.normal) == 2:
        axes = (0, 2)
    off = (corners[:, axes] - side.corners[0]) @ side.normal
    return bool(normal[list(axes)] @ side.normal > 0 and np.abs(off).max() <= 2 * PARTS_APART)


def whole_outlines(outlines: Sequence[Integers], side: Integers, corners: Array, normals: Array) -> list[Integers]:
    """The outline of the side that each face lies on: its own, or the hull of those of all faces of the side.

    Args:
        outlines: numbers of the corners around each face.
        side: number of the side of each, shape (faces,).
        corners, normals: of all, shape (corners, 3) and (faces, 3).
    """
    around = list(outlines)
    sides, counts = np.unique(side, return_counts=True)
    for number in sides[counts > 1]:
        faces = np.flatnonzero(side == number)
        points = np.unique(np.concatenate([outlines[face] for face in faces.tolist()]))
        flat = corners[points] @ tangent_axes(normals[faces[:1]])[0].T
        ring = cleaned(flat[scipy.spatial.ConvexHull(flat).vertices], PARTS_APART)
        hull = points[np.array([np.hypot(*(flat - at).T).argmin() for at in ring])]
        for face in faces.tolist():
            around[face] = hull if area_vector(corners[hull]) @ normals[faces[0]] > 0 else hull[::-1]
    return around
