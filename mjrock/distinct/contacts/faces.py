"""Where a face ends: at two ends in the plane, at the edges of its outline in space. Both are rows of edges."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, components, dot, minus, scaled
from ...problem.wall.rest_geometry import Face
from ...quantities import Array, Integers
from ..rows import Rows, kinds, rows

OVERHANG = 0.02
"""Length by which a face is taken to be longer at either end, over the shorter of its length and that of the face that
it meets [-]. The points of a block that stands flush lie at the very end of the face, and move to and fro there. Over
the same length beyond, the normal turns from that of the face to that of the face of the block above."""
ROUNDS = 3
"""Rounds over the edges of a face in the search for the nearest place of its outline. One is enough in the plane and
for a rectangle."""


def edges_of(faces: Sequence[Face], origins: Array, met: Sequence[Face]) -> tuple[Rows, Integers]:
    """The edges of faces, which are taken to be longer by `OVERHANG` at either end, and where those of each begin.

    Args:
        faces: of joints.
        origins: a point of the block of each [m], shape (faces, d).
        met: the face of the other block of the joint of each.

    Returns:
        The edges, and the number of the first one of each face, with that after the last, shape (faces + 1,).
    """
    begin = np.cumsum([0, *(len(face.edge_normals) for face in faces)])
    edges = rows(kinds(origins.shape[1]).edge, int(begin[-1]))
    pairs = zip(faces, met, strict=True)
    shapes = np.array([(len(one.edge_normals), len(one.corners), len(other.corners)) for one, other in pairs])
    for shape in np.unique(shapes, axis=0):
        which = np.flatnonzero((shapes == shape).all(axis=1)).tolist()
        normals, corners, others = (
            np.array(each)
            for each in zip(*((faces[i].edge_normals, faces[i].corners, met[i].corners) for i in which), strict=True)
        )
        along = normals.swapaxes(1, 2)
        places = (corners - origins[which][:, None]) @ along  # (faces, corners, edges)
        extent = np.minimum(np.ptp(places, axis=1), np.ptp(others @ along, axis=1))
        of = begin[which][:, None] + np.arange(len(normals[0]))
        edges["way"][of], edges["reach"][of] = normals, places.max(axis=1) + OVERHANG * extent
        edges["band"][of] = OVERHANG * (1 + 2 * OVERHANG) * extent
    return edges, begin


def margins(lines: Rows, edges: Rows) -> Array:
    """Square of the smallest distance of each line from the end of its face [m2], shape (m,)."""
    margin, counts = np.empty(len(lines)), lines["last"] - lines["first"]
    for count in np.unique(counts):
        which = np.flatnonzero(counts == count)
        of = lines["first"][which][:, None] + np.arange(count)
        along = (edges["way"][of] @ lines["origin"][which][:, :, None])[:, :, 0]
        margin[which] = np.maximum((edges["reach"][of] - along).min(axis=1), 0.0)
    return margin**2


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
    """The point of the outline that is nearest to a place on a body [m], and the distance of the place beyond it, over
    the width of its band.
    """
    inside, share = place, 0.0
    for sweep in range(ROUNDS):
        for i in range(first, last):
            edge = edges[i]
            outwards = components(edge.way, place)
            excess = dot(outwards, inside) - edge.reach
            if excess > 0:
                inside = minus(inside, scaled(excess, outwards))
                if sweep == 0:
                    share = max(share, excess / edge.band)
    return inside, share
