"""Convex bodies: their faces, the hull of points, and volume, centroid and second moments."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy

from ..quantities import Array, Integers, frozen
from .convex import cross_in_space, next_of

Faces = tuple[tuple[int, ...], ...]
"""Numbers of the corners of each face, counterclockwise as seen from outside."""
COPLANAR = 1e-5
"""Distance from the plane of a face up to which a vertex belongs to it, over the extent of the points [-]."""
THINNEST = 1e-4
"""Smallest thickness of points that bound a body, over their extent [-]."""
UNCROSSED = 1e-6
"""Sine of the angle between two edges up to which they count as parallel [-]."""
SHAPES = 512
"""Latest shapes of bodies whose hull, volume and edges are kept: masonry has many blocks of few shapes [-]."""


class Hull(NamedTuple):
    """The convex hull of points.

    Args:
        corners: numbers of the points that are its corners, in ascending order.
        faces: of each face, the numbers of its corners in `corners`, counterclockwise as seen from outside.
        normals: unit normals out of the faces, shape (faces, 3).
        depth: how deep each of the points lies inside [m], shape (points,); about zero on the surface.
    """

    corners: tuple[int, ...]
    faces: Faces
    normals: Array
    depth: Array


class Bulk(NamedTuple):
    """Volume [m3], centroid [m], shape (3,), and volume integral of x x^T about the centroid [m5], shape (3, 3)."""

    volume: float
    centroid: Array
    second: Array


class Side(NamedTuple):
    """A plane piece of the surface of a body.

    Args:
        corners: in the plane the two ends of an edge, counterclockwise about the body [m], shape (2, 2). In space
            those of a convex polygon, counterclockwise as seen from outside [m], shape (n, 3).
        normal: unit vector out of the body, shape (d,).
        parts: numbers of the convex parts of the body that it bounds.
    """

    corners: Array
    normal: Array
    parts: tuple[int, ...] = (0,)


@dataclass(frozen=True, eq=False)
class Convex:
    """A convex body of plane faces.

    Args:
        corners: [m], shape (n, 3).
        faces: numbers of the corners of each face, counterclockwise as seen from outside.
        normals: unit normals out of the faces, shape (faces, 3).
    """

    corners: Array
    faces: Faces
    normals: Array

    @classmethod
    def between(cls, ring: Array, other: Array) -> Convex:
        """The body between two plane polygons of as many corners, (n, 3) each, clockwise as seen from the other one.

        Corners of the second may coincide, as in a wedge. Faces are the two polygons, and then one for each edge.
        """
        n, points = len(ring), np.concatenate([ring, other])
        corners, first, number = np.unique(points, axis=0, return_index=True, return_inverse=True)
        order = np.argsort(first)
        number = np.argsort(order)[number.ravel()]
        rings = (range(n), range(2 * n - 1, n - 1, -1), *_ring_faces(n))
        faces = [tuple(dict.fromkeys(number[list(ring)].tolist())) for ring in rings]
        corners, kept = corners[order], tuple(face for face in faces if len(face) > 2)
        vectors = np.array([area_vector(corners[list(face)]) for face in kept])
        return cls(corners, kept, vectors / np.linalg.norm(vectors, axis=1)[:, None])

    def about(self, point: Array) -> Convex:
        """The same from another origin [m], shape (3,)."""
        return Convex(self.corners - point, self.faces, self.normals)

    @cached_property
    def sides(self) -> tuple[Side, ...]:
        """Its faces."""
        pairs = zip(self.faces, self.normals, strict=True)
        return tuple(Side(self.corners[list(face)], normal) for face, normal in pairs)

    @cached_property
    def offsets(self) -> Array:
        """Where the faces are along their normals, by the mean of their corners [m], shape (faces,)."""
        pairs = zip(self.faces, self.normals, strict=True)
        return np.array([float((self.corners[list(face)] @ normal).mean()) for face, normal in pairs])

    def depth(self, points: Array) -> float:
        """Penetration of the deepest of some points behind a face [m], the least over the faces; negative outside."""
        return float((self.offsets - (points @ self.normals.T).min(axis=0)).min())

    @cached_property
    def edge_ends(self) -> Array:
        """Ends of the edges [m], each once, shape (edges, 2, 3)."""
        return self.corners[_ends_of_edges(self.faces)]

    @cached_property
    def edges(self) -> Array:
        """Unit vectors along the edges, those that are parallel once, shape (directions, 3)."""
        edges = self.edge_ends[:, 1] - self.edge_ends[:, 0]
        return _distinct_directions((edges / np.linalg.norm(edges, axis=1)[:, None]).tobytes())

    @cached_property
    def bulk(self) -> Bulk:
        """Volume, centroid and second moments."""
        return bulk_of(self.corners, self.faces)

    @cached_property
    def box(self) -> tuple[Array, Array] | None:
        """Middle and half sizes of a box along the axes [m], shape (3,) each; None of any other body."""
        low, high = self.corners.min(axis=0), self.corners.max(axis=0)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        deviation = np.abs(np.abs(self.corners - middle) - half).max()
        return (middle, half) if len(self.corners) == 8 and deviation <= 1e-12 * np.abs(self.corners).max() else None


def hull_of(points: Array) -> Hull:
    """The convex hull of points, shape (n, 3). Facets of one plane are one face.

    A point in the middle of a face or on an edge is not a corner.

    Raises:
        ValueError: for points that lie in a plane, with the thickness that they have.
    """
    extent = float(np.ptp(points, axis=0).max())
    hull = _hull_of_shape(((points - points.mean(axis=0)) / extent).tobytes(), extent)
    return hull._replace(normals=hull.normals.copy(), depth=hull.depth.copy())


@lru_cache(maxsize=SHAPES)
def _hull_of_shape(points: bytes, extent: float) -> Hull:
    """The hull of points about their mean over their extent [m]: the bytes of an array of the shape (n, 3)."""
    centred = np.frombuffer(points).reshape(-1, 3).copy()
    thickness = float(np.ptp(centred @ np.linalg.svd(centred, full_matrices=False)[2][-1]))
    if not thickness > THINNEST:
        raise ValueError(f"vertices lie in a plane: they are {thickness * extent:.3g} m thick")
    try:
        facets = scipy.spatial.ConvexHull(centred)
    except scipy.spatial.QhullError:
        raise ValueError(f"vertices enclose no body: they are {thickness * extent:.3g} m thick") from None
    planes = _corners_by_plane(centred, facets)
    number_of_faces = np.zeros(len(centred), dtype=int)
    for members in planes:
        number_of_faces[members] += 1
    corners = np.flatnonzero(number_of_faces >= 3)  # a point on an edge belongs to two faces
    number = np.full(len(centred), -1)
    number[corners] = np.arange(len(corners))
    faces, normals = [], []
    for members in planes:
        ring = [i for i in members if number[i] >= 0]
        if len(ring) >= 3:
            order, normal = _ordered_ring(centred[ring], centred[members].mean(axis=0))
            faces.append(tuple(int(number[ring[i]]) for i in order))
            normals.append(normal)
    if len(faces) < 4:
        raise ValueError(f"vertices enclose no body: they are {thickness * extent:.3g} m thick")
    outwards = np.array(normals) + 0.0  # no negative zeros
    offsets = np.array([centred[corners[list(face)]].mean(axis=0) for face in faces])
    depth = (np.einsum("fi,fi->f", outwards, offsets) - centred @ outwards.T).min(axis=1)
    return Hull(tuple(corners.tolist()), tuple(faces), outwards, depth * extent)


def _corners_by_plane(points: Array, facets: scipy.spatial.ConvexHull) -> list[list[int]]:
    """Corners of the facets of each plane, the planes of the largest facets first. Points have an extent of 1."""
    a, b, c = points[facets.simplices].transpose(1, 0, 2)
    areas = np.linalg.norm(cross_in_space(b - a, c - a), axis=1)
    unassigned = np.ones(len(areas), dtype=bool)
    planes = []
    for seed in np.argsort(-areas, kind="stable"):
        if unassigned[seed]:
            normal, offset = facets.equations[seed, :3], facets.equations[seed, 3]
            on_plane = np.abs(points @ normal + offset) <= COPLANAR
            in_plane = unassigned & on_plane[facets.simplices].all(axis=1) & (facets.equations[:, :3] @ normal > 0)
            in_plane[seed] = True
            unassigned &= ~in_plane
            planes.append(np.unique(facets.simplices[in_plane]).tolist())
    return planes


def _ordered_ring(ring: Array, middle: Array) -> tuple[list[int], Array]:
    """The order of corners of a face around it, and its unit normal, which points away from the origin."""
    centred = ring - ring.mean(axis=0)
    plane = np.linalg.svd(centred, full_matrices=False)[2]
    order = np.argsort(np.arctan2(centred @ plane[1], centred @ plane[0]), kind="stable")
    normal = area_vector(centred[order])
    if normal @ middle < 0:
        order, normal = order[::-1], -normal
    first = int(np.argmin(order))  # each face starts at its lowest number
    return [*order[first:].tolist(), *order[:first].tolist()], normal / np.linalg.norm(normal)


@lru_cache(maxsize=SHAPES)
def _ends_of_edges(faces: Faces) -> Integers:
    """Numbers of the corners at the ends of the edges of faces, each once, shape (edges, 2)."""
    pairs = {(min(edge), max(edge)) for face in faces for edge in face_edges(face)}
    return frozen(sorted(pairs))


def face_edges(face: tuple[int, ...]) -> list[tuple[int, int]]:
    """The edges of a face, in its order."""
    return list(pairwise((*face, face[0])))


def triangles_of(faces: Iterable[tuple[int, ...]]) -> list[tuple[int, int, int]]:
    """The triangles of faces with their first corners."""
    return [(face[0], i, j) for face in faces for i, j in pairwise(face[1:])]


def area_vector(ring: Array) -> Array:
    """The normal of a plane polygon, as long as its area, shape (3,); the ring is counterclockwise about it, (n, 3)."""
    arms = ring - ring[0]
    area_normal: Array = 0.5 * cross_in_space(arms, next_of(arms)).sum(axis=0)
    return area_normal


def prism(outline: Array, length: float) -> tuple[Array, Faces]:
    """Corners and faces of a convex outline x, z, counterclockwise with z upwards, over a length along y about 0."""
    n, (x, z) = len(outline), outline.T
    corners = np.concatenate([np.column_stack([x, np.full(n, y), z]) for y in (-0.5 * length, 0.5 * length)])
    return corners, (tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1)), *_ring_faces(n))


def _ring_faces(n: int) -> Faces:
    """Numbers of the corners of the faces between two polygons of n corners, one for each edge."""
    return tuple((i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n))


def edge_separating_axes(body: Convex, other: Convex) -> Array:
    """Unit vectors perpendicular to an edge of each of two bodies, for pairs of edges that are not parallel, (n, 3).

    Two convex bodies that do not touch are separated along one of these or along the normal of a face (Gottschalk,
    Separating axis theorem, Technical Report TR96-024, UNC Chapel Hill, 1996).
    """
    axes = cross_in_space(body.edges[:, None], other.edges[None]).reshape(-1, 3)
    lengths = np.linalg.norm(axes, axis=1)
    unlike_edges = lengths > UNCROSSED
    return np.asarray(axes[unlike_edges] / lengths[unlike_edges, None])


@lru_cache(maxsize=SHAPES)
def _distinct_directions(vectors: bytes) -> Array:
    """Unit vectors, one of each set of parallel ones, from the bytes of an array of the shape (n, 3)."""
    directions = np.frombuffer(vectors).reshape(-1, 3)
    distinct = np.abs(directions @ directions.T) < 1 - 1e-12
    return frozen(directions[[bool(distinct[i, :i].all()) for i in range(len(directions))]])


def bulk_of(corners: Array, faces: Faces) -> Bulk:
    """Volume, centroid and second moments of a closed body of plane faces.

    They are sums over the tetrahedra between the triangles of the faces and the mean of the corners. A tetrahedron
    whose triangle is clockwise counts negative.

    Args:
        corners: [m], shape (n, 3).
        faces: numbers of the corners of each face, counterclockwise as seen from outside.
    """
    origin = corners.mean(axis=0)
    bulk = _bulk_of_shape((corners - origin).tobytes(), faces)
    return Bulk(bulk.volume, origin + bulk.centroid, bulk.second.copy())


@lru_cache(maxsize=SHAPES)
def _bulk_of_shape(corners: bytes, faces: Faces) -> Bulk:
    """The same from the mean of the corners [m], from the bytes of an array of the shape (n, 3)."""
    # one tetrahedron for each triangle: three edges from the origin
    edges = np.frombuffer(corners).reshape(-1, 3)[triangles_of(faces)]
    determinants = np.linalg.det(edges)
    volume = float(determinants.sum()) / 6
    sums = edges.sum(axis=1)
    middle = determinants @ sums / (24 * volume)
    # integral of x x^T over a tetrahedron: determinant/120 (s s^T + sum of e e^T)
    weighted = determinants[:, None, None] / 120
    second = (weighted * (sums[:, :, None] * sums[:, None, :] + edges.transpose(0, 2, 1) @ edges)).sum(axis=0)
    return Bulk(volume, middle, second - volume * np.outer(middle, middle))
