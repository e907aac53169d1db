"""Where a face ends: at two ends in the plane, at the edges of its outline in space. Both are rows of edges."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, components, dot, minus, scaled
from ...problem.masonry.blocks.joints_in_space import Face
from ...problem.masonry.faces_of_joints import faces_of_joints
from ...problem.masonry.lines import edge_ends
from ...problem.masonry.masonry import Masonry
from ...quantities import Array
from ..rows import Rows, kinds, rows

OVERHANG = 0.02
"""Length by which a face is taken to be longer at either end, over its length or that of the face that it meets, which
is shorter [-]. The points of a block that stands flush lie at the very end of the face, and move to and fro there. Over
the same length beyond, the normal turns from that of the face to that of the face of the block above."""
ROUNDS = 3
"""Rounds over the edges of a face in the search for the nearest place of its outline. One is enough in the plane and
for a rectangle."""


class Outline(NamedTuple):
    """A face of a block: corners [m], shape (n, d), its normal, and normals of its edges in its plane, (edges, d)."""

    corners: Array
    normal: Array
    ways: Array


def outlines_of_joints(masonry: Masonry) -> list[tuple[Outline, Outline]]:
    """The whole faces that make each joint, of which it covers a part: of the block below and of the block above."""
    if masonry.in_space:
        return [(_polygonal(below), _polygonal(above)) for below, above in faces_of_joints(masonry)]
    pairs = []
    for joint in masonry.plane_joints:
        ways, normal = np.array([-joint.along, joint.along]), np.array([-joint.along[1], joint.along[0]])
        below, above = (
            Outline(
                joint.middle + np.outer(edge_ends(masonry.polygons[block].sides[side], joint), joint.along), way, ways
            )
            for block, side, way in zip((joint.below, joint.above), joint.sides, (normal, -normal), strict=True)
        )
        pairs.append((below, above))
    return pairs


def _polygonal(face: Face) -> Outline:
    ways = np.cross(np.roll(face.corners, -1, axis=0) - face.corners, face.normal)
    return Outline(face.corners, face.normal, ways / np.linalg.norm(ways, axis=1)[:, None])


def edges_of(face: Outline, origin: Array, met: Outline) -> Rows:
    """The edges of a face, which is taken to be longer by `OVERHANG` at either end, from a point of its block [m].

    A joint is made by this face and another that is `met`.
    """
    places = (face.corners - origin) @ face.ways.T  # (corners, edges)
    extent = np.minimum(np.ptp(places, axis=0), np.ptp(met.corners @ face.ways.T, axis=0))
    reach, band = places.max(axis=0) + OVERHANG * extent, OVERHANG * (1 + 2 * OVERHANG) * extent
    edge = kinds(len(origin)).edge
    return rows(edge, len(face.ways), way=face.ways, reach=reach, band=band)


def margins(lines: Rows, edges: Rows) -> Array:
    """Square of the least way that each line has along its face to its end [m2], shape (m,)."""
    margin = np.empty(len(lines))
    for i, (place, first, last) in enumerate(zip(lines["origin"], lines["first"], lines["last"], strict=True)):
        margin[i] = max(float((edges["reach"][first:last] - edges["way"][first:last] @ place).min()), 0.0)
    return np.asarray(margin**2)


@inlined
def is_beside(edges: Rows, first: int, last: int, place: Vector) -> bool:
    """Whether a place on a body [m] lies beyond the outline of a face of it, whose edges are numbered."""
    beside = False
    for i in range(first, last):
        if dot(components(edges[i].way, place), place) > edges[i].reach:
            beside = True
    return beside


@inlined
def pulled_inside(edges: Rows, first: int, last: int, place: Vector) -> tuple[Vector, float]:
    """The place of the outline that is nearest to a place on a body [m], and how far beyond this is, over its band."""
    inside, share = place, 0.0
    for sweep in range(ROUNDS):
        for i in range(first, last):
            edge = edges[i]
            way = components(edge.way, place)
            excess = dot(way, inside) - edge.reach
            if excess > 0:
                inside = minus(inside, scaled(excess, way))
                if sweep == 0:
                    share = max(share, excess / edge.band)
    return inside, share
