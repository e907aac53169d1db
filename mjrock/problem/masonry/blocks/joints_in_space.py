"""Joints of masonry in space: where faces of two blocks lie on one another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import chain
from typing import NamedTuple

import numpy as np

from ....geometry import convex
from ....geometry.hull import SHAPES, Convex, Side, edge_separating_axes
from ....quantities import Array, Integers, frozen, short_repr
from .joints import (
    LEVEL,
    SHORTEST_JOINT,
    TOGETHER,
    Shape,
    corner_within,
    each_with_each,
    least_of_deepest,
    names_of,
    neighbours,
    numbered_parts,
    require_apart,
    unlike_named,
)
from .polyhedron import Vertices

OPPOSITE = -1 + 1e-3
"""Largest cosine of the angle between the normals of two faces that make a joint [-]."""
BLUNT = 1e-6
"""Share of a force across a normal below which it has no direction there [-]."""
NEARBY = 1e-6
"""By how much more than the gap and the tolerance faces may lie apart that are looked at closely, over these [-]."""


@dataclass(frozen=True)
class SpaceJoint:
    """Where two blocks in space meet along a plane.

    Args:
        below, above: numbers of the two blocks. The normal points from `below` to `above`, upwards unless the joint is
            vertical, and then out of the facade or, across it, along it. A fixed block is always `below`.
        vertices: corners of the polygon that both faces cover, counterclockwise as seen from above [m].
        direction: the normal.
        corners: of each vertex, whether it is a corner of the block below and none of the block above.
        name: names of the two blocks with a | between them, the one below first. A second joint of the same two has
            " (2)" after it.
        sides: numbers of the sides of the block below and of the block above that make it.
    """

    below: int
    above: int
    vertices: Vertices
    direction: tuple[float, float, float]
    corners: tuple[bool, ...]
    name: str
    sides: tuple[int, int]

    __repr__ = short_repr

    @cached_property
    def outline(self) -> Array:
        """Corners of the joint, counterclockwise about the normal [m], shape (n, 3)."""
        return frozen(self.vertices)

    @property
    def normal(self) -> Array:
        """Unit vector from the block below to the block above, shape (3,)."""
        return np.array(self.direction)

    @cached_property
    def axes(self) -> Array:
        """Two unit vectors in the plane of the joint, right-handed with the normal, shape (2, 3)."""
        return _axes_of(self.direction)

    @cached_property
    def flat(self) -> Array:
        """The outline along `axes`, from its first corner [m], shape (n, 2)."""
        return np.asarray((self.outline - self.outline[0]) @ self.axes.T)

    @cached_property
    def area(self) -> float:
        """Area of the joint [m2]."""
        return _measures_of(self.flat.tobytes())[0]

    @cached_property
    def width(self) -> float:
        """The smallest extent of the joint in any direction of its plane [m]."""
        return _measures_of(self.flat.tobytes())[1]

    @property
    def length(self) -> float:
        """Length of a rectangle of that width and the area of the joint [m]."""
        return self.area / self.width

    @cached_property
    def middle(self) -> Array:
        """Centroid of the area of the joint [m], shape (3,)."""
        return np.asarray(self.outline[0] + _measures_of(self.flat.tobytes())[2] @ self.axes)

    @property
    def frame(self) -> Array:
        """The normal and the axes, shape (3, 3)."""
        return np.array([self.normal, *self.axes])

    @property
    def is_bed(self) -> bool:
        """Whether the joint is horizontal."""
        return bool(np.abs(self.normal[:2]).max() < LEVEL)


class Faces(NamedTuple):
    """Faces and corners of bodies, one body after the other.

    Args:
        corners: [m], shape (corners, 3).
        normals: out of the faces, shape (faces, 3).
        first, number: where the faces of each of n bodies begin, and how many there are, and then the same of the
            corners, shape (2 n,) each.
        outlines: the corners of the faces, one face after the other [m], shape (places, 3).
        begin, sizes: where those of each face begin, and how many there are, shape (faces,) each.
        offsets: how far the faces lie along their normals, by the mean of their corners [m], shape (faces,).
    """

    corners: Array
    normals: Array
    first: Integers
    number: Integers
    outlines: Array
    begin: Integers
    sizes: Integers
    offsets: Array

    @classmethod
    def from_sides(cls, corners: Sequence[Array], sides: Sequence[Sequence[Side]]) -> Faces:
        """Those of bodies with these corners and sides."""
        every = list(chain.from_iterable(sides))
        numbers = [np.array([len(things) for things in lists]) for lists in (sides, corners)]
        normals, outlines = np.array([side.normal for side in every]), [side.corners for side in every]
        count, first = np.array([len(ring) for ring in outlines]), [np.cumsum(things) - things for things in numbers]
        begin, places = np.cumsum(count) - count, np.concatenate(outlines)
        along = (places * np.repeat(normals, count, axis=0)).sum(axis=1)
        offsets = np.add.reduceat(along, begin) / count
        numbering = np.concatenate(first), np.concatenate(numbers)
        return cls(np.concatenate(corners), normals, *numbering, places, begin, count, offsets)

    def sunk(self, pairs: Integers) -> Array:
        """How deep the second body of each pair reaches behind a face of the first [m], the least over its faces."""
        of_corners = np.array([0, len(self.first) // 2])
        _, face, corner = each_with_each(self.first, self.number, pairs + of_corners)
        behind = self.offsets[face] - (self.normals[face] * self.corners[corner]).sum(axis=1)
        return least_of_deepest(behind, face, self.number[pairs[:, 0]])

    def facing(self, pairs: Integers, tolerance: float, gap: float) -> tuple[Integers, Integers, Integers]:
        """Faces of pairs of bodies that look at each other and may touch within a tolerance and a gap [m].

        The number of the pair, of the face of the first body and of that of the second, shape (n,) each.
        """
        pair, face, other = each_with_each(self.first, self.number, pairs)
        looks = (self.normals[face] * self.normals[other]).sum(axis=1) <= OPPOSITE
        pair, face, other = pair[looks], face[looks], other[looks]
        count = self.sizes[other]
        start = np.cumsum(count) - count
        place = np.arange(count.sum()) + np.repeat(self.begin[other] - start, count)
        heights = (self.outlines[place] * np.repeat(self.normals[face], count, axis=0)).sum(axis=1)
        heights -= np.repeat(self.offsets[face], count)
        if not len(heights):
            return pair, face, other
        low, high = np.minimum.reduceat(heights, start), np.maximum.reduceat(heights, start)
        near = (low <= (1 + NEARBY) * gap) & (high >= -(1 + NEARBY) * tolerance)
        return pair[near], face[near], other[near]


class FacePair(NamedTuple):
    """Two faces of blocks that face each other.

    Args:
        blocks: numbers of the two blocks.
        sides: numbers of the faces among those of their block.
        faces: the faces.
        axes: two unit vectors in the plane of the first, shape (2, 3).
    """

    blocks: tuple[int, int]
    sides: tuple[int, int]
    faces: tuple[Side, Side]
    axes: Array


def tangent_axes(normals: Array) -> Array:
    """Two unit vectors across each of some normals, shape (m, 3), right-handed with it, shape (m, 2, 3)."""
    first = convex.cross_in_space(np.eye(3)[np.abs(normals).argmin(axis=1)], normals)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.asarray(np.stack([first, convex.cross_in_space(normals, first)], axis=1) + 0.0)


@lru_cache(maxsize=SHAPES)
def _measures_of(flat: bytes) -> tuple[float, float, Array]:
    """Area [m2], width and centroid [m] of a polygon, from the bytes of an array of the shape (n, 2)."""
    polygon = np.frombuffer(flat).reshape(-1, 2)
    return convex.area(polygon), convex.width(polygon), frozen(convex.polygon_centroid(polygon))


@lru_cache(maxsize=SHAPES)
def _axes_of(direction: tuple[float, float, float]) -> Array:
    """The same of one normal, shape (2, 3)."""
    return frozen(tangent_axes(np.array([direction]))[0])


def tangent_axes_along(normals: Array, forces: Array) -> tuple[Array, Array]:
    """Two unit vectors across each of some normals, the first along its force, or one for all, where it can be.

    Shapes are (m, 3) each.
    """
    first = forces - (normals * forces).sum(axis=1)[:, None] * normals
    lengths = np.linalg.norm(first, axis=1)
    blunt = lengths <= BLUNT * np.linalg.norm(forces, axis=-1)
    first = np.where(blunt[:, None], tangent_axes(normals)[:, 0], first / np.where(blunt, 1.0, lengths)[:, None])
    return first, convex.cross_in_space(normals, first)


def joints_in_space(
    blocks: Sequence[Shape], tolerance: float, gap: float, pairs: Integers | None = None
) -> tuple[SpaceJoint, ...]:
    """The joints between blocks, in the order of the blocks.

    Two faces make a joint where they cover a common area and are nowhere in it farther apart than the gap [m]. The
    tolerance is the largest overlap of blocks [m]. The joint lies halfway between them. Two fixed blocks make none.
    Pairs are the numbers of blocks that are looked at, shape (pairs, 2); None looks at all.

    Raises:
        OverlapError: for blocks that overlap more, with the two that overlap most.
    """
    names, solids = names_of(blocks), [solid for block in blocks for solid in block.solids]
    first, number = numbered_parts(blocks)
    faces = Faces.from_sides([block.corners for block in blocks], [block.sides for block in blocks])
    parts = faces
    if number.max() > 1:
        parts = Faces.from_sides([solid.corners for solid in solids], [solid.sides for solid in solids])
    axes = tangent_axes(faces.normals)
    sides = [side for block in blocks for side in block.sides]
    joints: list[SpaceJoint] = []
    overlaps: list[tuple[float, int, int]] = []
    known: dict[tuple[bytes, bytes], Array] = {}
    pairs = neighbours(blocks, gap) if pairs is None else pairs
    for batch in np.split(pairs, range(TOGETHER, len(pairs), TOGETHER)) if len(pairs) else ():
        pair, part, other_part = each_with_each(first, number, batch)
        part_pairs = np.column_stack([part, other_part])
        depth = np.minimum(parts.sunk(part_pairs), parts.sunk(part_pairs[:, ::-1]))
        for i in np.flatnonzero(depth > tolerance).tolist():
            depth[i] = min(depth[i], _depth_along_edge_axes(solids[part[i]], solids[other_part[i]]))
        deepest = np.maximum.reduceat(depth, np.flatnonzero(np.diff(pair, prepend=-1)))
        deep, near = deepest > tolerance, batch[deepest >= -gap]
        overlaps += [(how, i, j) for how, (i, j) in zip(deepest[deep].tolist(), batch[deep].tolist(), strict=True)]
        pair, face, opposite = faces.facing(near, tolerance, gap)
        side_pairs = np.column_stack([face, opposite]) - faces.first[near[pair]]
        rows = zip(near[pair].tolist(), side_pairs.tolist(), face.tolist(), opposite.tolist(), strict=True)
        for (i, j), (side, facing), k, m in rows:
            face_pair = FacePair(blocks=(i, j), sides=(side, facing), faces=(sides[k], sides[m]), axes=axes[k])
            joints += _joints_between(blocks, face_pair, names, (tolerance, gap), known)
    require_apart(overlaps, names, tolerance)
    return unlike_named(joints)


def _depth_along_edge_axes(block: Convex, neighbour: Convex) -> float:
    """The least overlap of two blocks along the separating axes of their edges [m], infinite without such an axis."""
    axes = edge_separating_axes(block, neighbour)
    if not len(axes):
        return np.inf
    along, along_neighbour = block.corners @ axes.T, neighbour.corners @ axes.T
    ahead, behind = along.max(axis=0) - along_neighbour.min(axis=0), along_neighbour.max(axis=0) - along.min(axis=0)
    return float(np.minimum(ahead, behind).min())


def _joints_between(
    blocks: Sequence[Shape],
    face_pair: FacePair,
    names: Sequence[str],
    within: tuple[float, float],
    known: dict[tuple[bytes, bytes], Array],
) -> Iterator[SpaceJoint]:
    """The joint between two faces that face each other, if they touch within a tolerance and a gap [m].

    The outlines of joints are `known` of faces of the same shape that lie alike over each other.
    """
    (face, opposite), (tolerance, gap), axes, sides = face_pair.faces, within, face_pair.axes, face_pair.sides
    normal, origin = face.normal, face.corners[0]
    flat, window = (face.corners - origin) @ axes.T, (opposite.corners - origin) @ axes.T
    shape = flat.tobytes(), window.tobytes()
    if shape not in known:
        outline = convex.cleaned(convex.clipped(flat, window[::-1]), tolerance)
        narrow = not len(outline) or convex.width(outline) <= SHORTEST_JOINT * tolerance
        known[shape] = outline[:0] if narrow else outline
    outline = known[shape]
    if not len(outline):
        return
    places = origin + outline @ axes
    offset = float((opposite.corners @ opposite.normal).mean())
    gaps = (offset - places @ opposite.normal) / float(normal @ opposite.normal)
    if gaps.max() > gap or gaps.min() < -tolerance:
        return
    places = places + 0.5 * gaps[:, None] * normal  # counterclockwise about the normal out of the first block
    (below, above), upwards = face_pair.blocks, next(x for x in normal[[2, 0, 1]] if abs(x) > LEVEL)
    if blocks[above].fixed or (upwards < 0 and not blocks[below].fixed):
        below, above, normal, places, sides = above, below, -normal, places[::-1], sides[::-1]
    of_below, of_above = (
        np.linalg.norm(blocks[i].corners - places[:, None], axis=2).min(axis=1) < corner_within(tolerance, gap)
        for i in (below, above)
    )
    x, y, z = normal.tolist()
    yield SpaceJoint(
        below=below,
        above=above,
        vertices=tuple((x, y, z) for x, y, z in places.tolist()),
        direction=(x, y, z),
        corners=tuple((of_below & ~of_above).tolist()),
        name=f"{names[below]}|{names[above]}",
        sides=sides,
    )
