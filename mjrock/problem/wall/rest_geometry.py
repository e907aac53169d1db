"""What stands in a case at rest: solids of convex parts, joints with their axes and faces; those of a wall."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from ...geometry.convex import cross_in_space
from ...geometry.hull import Convex, Faces, Side
from ...quantities import Array, Flags, Integers
from .block import Block

ROUND = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 13))
"""Heights between which a round opening has straight sides, over its height [-]."""
NARROWEST_PIER = 1e-9
"""Width beside an opening, over the length of the wall, up to which nothing of the wall is left there [-]."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A block at rest: convex parts that move as one.

    Args:
        name: of the block, "wall", "base" or "side".
        block: number of its block, None of what a wall stands on or against.
        body: number of its body, -1 of what is fixed.
        rest: its centroid with the masses that are added to it [m], shape (3,).
        drawn: its convex parts where they are drawn [m]. Blocks of the plane reach over their length about y = 0.
        inside: of each part, which faces nothing meets: those within the block, and the ends of prisms, (faces,).
        sides: its surface in plane pieces, in the plane edges; none of a wall.
        size: largest distance of a corner from the centroid without added masses [m].
    """

    name: str
    block: int | None
    body: int
    rest: Array
    drawn: tuple[Convex, ...]
    inside: tuple[Flags, ...]
    sides: tuple[Side, ...]
    size: float

    @property
    def fixed(self) -> bool:
        """Whether it is the ground or a fixed block, which does not move."""
        return self.body < 0

    @cached_property
    def parts(self) -> tuple[Convex, ...]:
        """Its convex parts about `rest` [m], which is the origin of its body."""
        return tuple(part.about(self.rest) for part in self.drawn)

    @property
    def corners(self) -> Array:
        """Corners of all parts about `rest` [m], shape (corners, 3)."""
        return np.concatenate([part.corners for part in self.parts])

    @property
    def faces(self) -> Faces:
        """Numbers of the corners of each face of a part, counterclockwise as seen from outside."""
        before = np.cumsum([0, *(len(part.corners) for part in self.drawn)]).tolist()
        pairs = zip(before, self.drawn, strict=False)
        return tuple(tuple(first + i for i in face) for first, part in pairs for face in part.faces)


class JointFrames(NamedTuple):
    """Joints at rest, in the order of their names, and what they join.

    Args:
        names: of the j joints.
        middle: of each [m], shape (j, d).
        axes: unit vectors, the normal out of what is below and then those along the joint, shape (j, d, d).
        below, above: numbers of the two bodies, -1 for what is fixed, shape (j,).
        fixed: number of the fixed block below, -1 where what is below is free, shape (j,).
        blocks: names of the fixed blocks.
        rest: centroids of the bodies at rest [m], shape (bodies, d).
    """

    names: tuple[str, ...]
    middle: Array
    axes: Array
    below: Integers
    above: Integers
    fixed: Integers
    blocks: tuple[str, ...]
    rest: Array

    @property
    def from_body(self) -> Array:
        """Of each joint on a body the vector from its centroid to the middle [m], and the axes, shape (j, 1 + d, d)."""
        arm = self.middle - np.where(self.below[:, None] < 0, 0.0, self.rest[self.below])
        return np.concatenate([arm[:, None], self.axes], axis=1)


class Face(NamedTuple):
    """A whole face that makes a joint, of which the joint covers a part.

    Args:
        corners: in the plane its two ends [m], shape (2, 2), in space counterclockwise from outside, shape (n, 3).
        normal: unit vector out of its block, shape (d,).
        edge_normals: unit vectors out of the face in its plane, perpendicular to its edges; in the plane both
            directions along the edge, shape (edges, d).
    """

    corners: Array
    normal: Array
    edge_normals: Array

    @classmethod
    def in_plane(cls, origin: Array, along: Array, ends: tuple[float, float], sense: float) -> Face:
        """An edge from a point along a unit vector, shape (2,), between two ends [m]. Its normal is to the left of
        that vector where `sense` is 1, and to the right where it is -1."""
        corners = origin + np.outer(ends, along)
        return cls(corners, sense * np.array([-along[1], along[0]]), np.array([-along, along]))

    @classmethod
    def in_space(cls, sides: Sequence[Side]) -> list[Face]:
        """Sides of blocks in space, those of as many corners at once."""
        faces, counts = dict[int, Face](), np.array([len(side.corners) for side in sides])
        for count in np.unique(counts):
            numbers = np.flatnonzero(counts == count).tolist()
            corners, normals = (np.array([getattr(sides[i], name) for i in numbers]) for name in ("corners", "normal"))
            edge_normals = cross_in_space(np.roll(corners, -1, axis=1) - corners, normals[:, None])
            edge_normals /= np.linalg.norm(edge_normals, axis=2)[..., None]
            for i, normals_of_edges in zip(numbers, edge_normals, strict=True):
                faces[i] = cls(sides[i].corners, sides[i].normal, normals_of_edges)
        return [faces[i] for i in range(len(sides))]


class Meeting(Protocol):
    """A joint and the two bodies that it connects: `Joint` and `SpaceJoint` of masonry, `WallJoint` of a wall."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def below(self) -> int:
        """Number of the solid below, whose face points to the other one."""

    @property
    def above(self) -> int:
        """Number of the solid above."""

    @property
    def sides(self) -> tuple[int, int]:
        """Numbers of the sides of the solids below and above that make it."""

    @property
    def width(self) -> float:
        """Its extent in the plane, in space the smallest one [m]."""

    @property
    def length(self) -> float:
        """Its extent out of the plane [m]."""

    @property
    def area(self) -> float:
        """Its area [m2]."""


class WallJoint(NamedTuple):
    """The base of a wall, or its side stop, see `Meeting`."""

    name: str
    below: int
    above: int
    width: float
    length: float
    sides: tuple[int, int] = (0, 0)

    @property
    def area(self) -> float:
        """Its area [m2]."""
        return self.width * self.length


class RestGeometry(Protocol):
    """The bodies and joints of a wall or of masonry at rest. Each property is computed when it is first read."""

    @property
    def solids(self) -> tuple[Solid, ...]:
        """The blocks in their order, fixed ones too; of a wall that one and what it stands on and against."""

    @property
    def joints(self) -> Sequence[Meeting]:
        """The joints, with the numbers of the solids that they join."""

    @property
    def frames(self) -> JointFrames:
        """Where the joints are."""

    @property
    def faces(self) -> tuple[tuple[Face, Face], ...]:
        """Of each joint the whole faces of the solids below and above."""


def in_space(vectors: Array) -> Array:
    """Vectors of the plane x, z with y = 0, shape (..., 3); those of space as they are."""
    return vectors if vectors.shape[-1] == 3 else np.insert(vectors, 1, 0.0, axis=-1)


@dataclass(frozen=True, eq=False)
class WallRestGeometry:
    """A wall on its base, with a side stop of a height [m] or without one."""

    wall: Block
    stop_top: float | None

    @cached_property
    def solids(self) -> tuple[Solid, ...]:
        """The wall less its openings, the base as a slab below it, and the side stop as a slab beside it."""
        wall, b = self.wall, self.wall.b
        half, rest = 0.5 * wall.length, in_space(np.array([wall.centroid_offset, wall.centroid_height]))
        solids = [Solid("wall", 0, 0, rest, parts := parts_of_wall(wall), _interior(parts), (), math.hypot(b, wall.h))]
        base = (_slab((-b, -half, half), (0.0, -half, half), [(-3 * b, 3 * b)] * 2),)
        solids.append(Solid("base", None, -1, np.zeros(3), base, _interior(base), (), 0.5 * math.hypot(6 * b, b)))
        if self.stop_top is not None:
            side = tuple(
                _slab((low, -half, half), (high, -half, half), [(-3 * b, x), (-3 * b, x_high)])
                for (x, low), (x_high, high) in pairwise(self.met_by_stop.tolist())
                if high > low
            )
            size = 0.5 * math.hypot(2 * b, self.stop_top)
            solids.append(Solid("side", None, -1, np.zeros(3), side, _interior(side), (), size))
        return tuple(solids)

    @property
    def met_by_stop(self) -> Array:
        """Corners of the inner face of the wall from the base up to the top of the side stop [m], shape (n, 2)."""
        return self.wall.section.inner_up_to(self.stop_top or 0.0)

    @property
    def joints(self) -> tuple[WallJoint, ...]:
        """The base and the side stop."""
        base = WallJoint("base", 1, 0, 2 * self.wall.half_base, self.wall.base_length)
        return (base,) if self.stop_top is None else (base, WallJoint("side", 2, 0, self.stop_top, self.wall.length))

    @property
    def frames(self) -> JointFrames:
        """Position and axes of the base and of the side stop."""
        sides, top = len(self.joints), self.stop_top or 0.0
        names, numbers = ("base", "side")[:sides], np.arange(sides)
        middle = np.array([(0.0, 0.0), (-self.wall.b, 0.5 * top)])[:sides]
        axes = np.array([[(0.0, 1.0), (1.0, 0.0)], [(1.0, 0.0), (0.0, -1.0)]])[:sides]
        rest = np.array([[self.wall.centroid_offset, self.wall.centroid_height]])
        return JointFrames(names, middle, axes, 0 * numbers - 1, 0 * numbers, numbers, names, rest)

    @property
    def faces(self) -> tuple[tuple[Face, Face], ...]:
        """The faces of base and side stop, each with the face of the wall that lies on it."""
        b, foot, right, down = self.wall.b, np.array([-self.wall.b, 0.0]), np.array([1.0, 0.0]), np.array([0.0, -1.0])
        reaches = [(right, (-2 * b, 4 * b), (0.0, 2 * b))]
        if self.stop_top is not None:
            reaches.append((down, (-self.stop_top, 0.0), (-2 * self.wall.h, 0.0)))
        return tuple(
            (Face.in_plane(foot, direction, below, 1.0), Face.in_plane(foot, direction, above, -1.0))
            for direction, below, above in reaches
        )


def _interior(parts: Sequence[Convex]) -> tuple[Flags, ...]:
    """For each part which of its faces lie inside the body: none."""
    return tuple(np.zeros(len(part.faces), dtype=bool) for part in parts)


def parts_of_wall(wall: Block) -> tuple[Convex, ...]:
    """The convex parts that a wall is made of [m]: what is left of it beside its openings, between heights at which its
    thickness, its length or an opening has a corner. Round openings have straight sides between some heights."""
    front, parts = wall.front, list[Convex]()
    heights = front.corners | {
        float(opening.sill + share * opening.height) for opening in front.openings if opening.round for share in ROUND
    }
    for ends, thickness in wall.section.slabs(heights):
        faces = np.transpose(wall.section.x_of_faces(thickness)).tolist()
        for left, right in _parts_beside_openings(wall, *ends):
            bottom, top = ((z, a, b) for z, a, b in zip(ends, left, right, strict=True))
            parts.append(_slab(bottom, top, faces))
    return tuple(parts)


def _parts_beside_openings(wall: Block, low: float, high: float) -> list[tuple[Array, Array]]:
    """Where each part that is left of a wall between two heights begins and ends along it [m], shape (2,) each: at both
    heights."""
    front, z = wall.front, np.array([low, high])
    half, middle = 0.5 * front.long(z), 0.5 * (low + high)
    left, pieces = -half, list[tuple[Array, Array]]()
    for place, opening in sorted(zip(front.places, front.openings, strict=True), key=lambda pair: pair[0]):
        if opening.sill < middle < opening.head:
            widths = 0.5 * (opening.across(z) if opening.round else np.full(2, opening.width))
            pieces.append((left, np.clip(place - widths, left, half)))
            left = np.clip(place + widths, left, half)
    pieces.append((left, half))
    return [piece for piece in pieces if (piece[1] - piece[0]).max() > NARROWEST_PIER * wall.length]


def _slab(
    bottom: tuple[float, float, float], top: tuple[float, float, float], faces: Sequence[tuple[float, float]]
) -> Convex:
    """The body between two heights, each with where the body begins and ends along the wall there [m], and the x of its
    inner and outer face at both [m]."""
    rings = [
        np.array([(inner, right, z), (outer, right, z), (outer, left, z), (inner, left, z)])
        for (z, left, right), (inner, outer) in zip((bottom, top), faces, strict=True)
    ]
    return Convex.between(*rings)
