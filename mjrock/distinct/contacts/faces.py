"""Where a face ends: at two ends in the plane, at the edges of its outline in space. Both are rows of edges."""

from __future__ import annotations

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, components, dot, minus, scaled
from ...problem.wall.rest_geometry import Face
from ...quantities import Array
from ..rows import Rows, kinds, rows

OVERHANG = 0.02
"""Length by which a face is taken to be longer at either end, over the shorter of its length and that of the face that
it meets [-]. The points of a block that stands flush lie at the very end of the face, and move to and fro there. Over
the same length beyond, the normal turns from that of the face to that of the face of the block above."""
ROUNDS = 3
"""Rounds over the edges of a face in the search for the nearest place of its outline. One is enough in the plane and
for a rectangle."""


def edges_of(face: Face, origin: Array, met: Face) -> Rows:
    """The edges of a face, which is taken to be longer by `OVERHANG` at either end, from a point of its block [m].

    A joint is made by this face and another that is `met`.
    """
    places = (face.corners - origin) @ face.ways.T  # (corners, edges)
    extent = np.minimum(np.ptp(places, axis=0), np.ptp(met.corners @ face.ways.T, axis=0))
    reach, band = places.max(axis=0) + OVERHANG * extent, OVERHANG * (1 + 2 * OVERHANG) * extent
    edge = kinds(len(origin)).edge
    return rows(edge, len(face.ways), way=face.ways, reach=reach, band=band)


def margins(lines: Rows, edges: Rows) -> Array:
    """Square of the smallest distance of each line from the end of its face [m2], shape (m,)."""
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
    """The point of the outline that is nearest to a place on a body [m], and the distance of the place beyond it, over
    the width of its band.
    """
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
