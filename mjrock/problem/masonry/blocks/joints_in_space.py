"""Joints of masonry in space: where faces of two blocks lie on one another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ....geometry import convex
from ....geometry.hull import Convex, Side
from ....quantities import Array, Integers, frozen, short_repr
from .joints import LEVEL, SHORTEST_JOINT, Shape, corner_within, names_of, neighbours, require_apart, unlike_named
from .polyhedron import Vertices

OPPOSITE = -1 + 1e-3
"""Largest cosine of the angle between the normals of two faces that make a joint [-]."""
BLUNT = 1e-6
"""Share of a force across a normal below which it has no direction there [-]."""


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
        return np.asarray(axes_across(self.normal[None])[0])

    @cached_property
    def flat(self) -> Array:
        """The outline along `axes`, from its first corner [m], shape (n, 2)."""
        return np.asarray((self.outline - self.outline[0]) @ self.axes.T)

    @cached_property
    def area(self) -> float:
        """Area of the joint [m2]."""
        return convex.area(self.flat)

    @cached_property
    def width(self) -> float:
        """The smallest extent of the joint in any direction of its plane [m]."""
        return convex.width(self.flat)

    @property
    def length(self) -> float:
        """Length of a rectangle of that width and the area of the joint [m]."""
        return self.area / self.width

    @cached_property
    def middle(self) -> Array:
        """Centroid of the area of the joint [m], shape (3,)."""
        return np.asarray(self.outline[0] + convex.polygon_centroid(self.flat) @ self.axes)

    @property
    def frame(self) -> Array:
        """The normal and the axes, shape (3, 3)."""
        return np.array([self.normal, *self.axes])

    @property
    def is_bed(self) -> bool:
        """Whether the joint is horizontal."""
        return bool(np.abs(self.normal[:2]).max() < LEVEL)


class Facing(NamedTuple):
    """A side of a block that may face another one.

    Corners counterclockwise from outside [m], (n, 3), normal out of it, n.x on it, and two axes in its plane.
    """

    corners: Array
    normal: Array
    offset: float
    axes: Array


def axes_across(normals: Array) -> Array:
    """Two unit vectors across each of some normals, shape (m, 3), right-handed with it, shape (m, 2, 3)."""
    first = convex.cross_in_space(np.eye(3)[np.abs(normals).argmin(axis=1)], normals)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.asarray(np.stack([first, convex.cross_in_space(normals, first)], axis=1) + 0.0)


def axes_along(normals: Array, forces: Array) -> tuple[Array, Array]:
    """Two unit vectors across each of some normals, the first along its force, or one for all, where it can be.

    Shapes are (m, 3) each.
    """
    first = forces - (normals * forces).sum(axis=1)[:, None] * normals
    lengths = np.linalg.norm(first, axis=1)
    blunt = lengths <= BLUNT * np.linalg.norm(forces, axis=-1)
    first = np.where(blunt[:, None], axes_across(normals)[:, 0], first / np.where(blunt, 1.0, lengths)[:, None])
    return first, convex.cross_in_space(normals, first)


def joints_in_space(
    blocks: Sequence[Shape], tolerance: float, gap: float, pairs: Integers | None = None
) -> tuple[SpaceJoint, ...]:
    """The joints between blocks, in the order of the blocks. An `OverlapError` names the two that overlap most.

    Two faces make a joint where they cover a common area and are nowhere in it farther apart than the gap [m]. The
    tolerance is the largest overlap of blocks [m]. The joint lies halfway between them. Two fixed blocks make none.
    Pairs are the numbers of blocks that are looked at, shape (pairs, 2); None looks at all.
    """
    names = names_of(blocks)
    faces = [facing(block.sides) for block in blocks]
    normals = [np.array([face.normal for face in of_block]) for of_block in faces]
    solids = [block.solids for block in blocks]
    joints: list[SpaceJoint] = []
    overlaps: list[tuple[float, int, int]] = []
    for i, j in (neighbours(blocks, gap) if pairs is None else pairs).tolist():
        deep = max(_depth(part, other, tolerance) for part in solids[i] for other in solids[j])
        if deep < -gap:
            continue
        if deep > tolerance:
            overlaps.append((deep, i, j))
        for side, other in np.argwhere(normals[i] @ normals[j].T <= OPPOSITE).tolist():
            facing_sides = faces[i][side], faces[j][other]
            joints += _between(blocks, (i, j), facing_sides, (side, other), names, (tolerance, gap))
    require_apart(overlaps, names, tolerance)
    return unlike_named(joints)


def facing(sides: Sequence[Side]) -> list[Facing]:
    """The sides of a block with their axes."""
    axes = axes_across(np.array([side.normal for side in sides]))
    pairs = zip(sides, axes, strict=True)
    return [Facing(side.corners, side.normal, float((side.corners @ side.normal).mean()), way) for side, way in pairs]


def _depth(one: Convex, other: Convex, tolerance: float) -> float:
    """How deep two convex parts lie inside each other [m], negative where they are apart."""
    deep = min(one.depth(other.corners), other.depth(one.corners))
    return min(deep, _depth_across_edges(one, other)) if deep > tolerance else deep


def _depth_across_edges(block: Convex, neighbour: Convex) -> float:
    """The least depth by which two blocks overlap along the products of an edge of each [m].

    Beside the normals of their faces these are the directions in which convex bodies can be apart (Gottschalk,
    Separating axis theorem, Technical Report TR96-024, UNC Chapel Hill, 1996).
    """
    across = convex.cross_in_space(block.edges[:, None], neighbour.edges[None]).reshape(-1, 3)
    lengths = np.linalg.norm(across, axis=1)
    across = across[lengths > 1e-6] / lengths[lengths > 1e-6, None]
    if not len(across):
        return np.inf
    along, beside = block.corners @ across.T, neighbour.corners @ across.T
    ahead, behind = along.max(axis=0) - beside.min(axis=0), beside.max(axis=0) - along.min(axis=0)
    return float(np.minimum(ahead, behind).min())


def _between(
    blocks: Sequence[Shape],
    pair: tuple[int, int],
    faces: tuple[Facing, Facing],
    sides: tuple[int, int],
    names: Sequence[str],
    within: tuple[float, float],
) -> Iterator[SpaceJoint]:
    """The joint between two faces that look at each other, if they touch within a tolerance and a gap [m]."""
    (face, other), (tolerance, gap) = faces, within
    normal, origin, axes = face.normal, face.corners[0], face.axes
    heights = other.corners @ normal - face.offset
    if heights.min() > gap or heights.max() < -tolerance:
        return
    outline = convex.clipped((face.corners - origin) @ axes.T, ((other.corners - origin) @ axes.T)[::-1])
    outline = convex.cleaned(outline, tolerance)
    if not len(outline) or convex.width(outline) <= SHORTEST_JOINT * tolerance:
        return
    places = origin + outline @ axes
    gaps = (other.offset - places @ other.normal) / float(normal @ other.normal)
    if gaps.max() > gap or gaps.min() < -tolerance:
        return
    places = places + 0.5 * gaps[:, None] * normal  # counterclockwise about the normal out of the first block
    (below, above), upwards = pair, next(x for x in normal[[2, 0, 1]] if abs(x) > LEVEL)
    if blocks[above].fixed or (upwards < 0 and not blocks[below].fixed):
        below, above, normal, places, sides = above, below, -normal, places[::-1], sides[::-1]

    def is_corner(block: Shape, place: Array) -> bool:
        return bool(np.linalg.norm(block.corners - place, axis=1).min() < corner_within(tolerance, gap))

    yield SpaceJoint(
        below=below,
        above=above,
        vertices=tuple((float(x), float(y), float(z)) for x, y, z in places),
        direction=(float(normal[0]), float(normal[1]), float(normal[2])),
        corners=tuple(is_corner(blocks[below], p) and not is_corner(blocks[above], p) for p in places),
        name=f"{names[below]}|{names[above]}",
        sides=sides,
    )
