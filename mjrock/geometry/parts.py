"""Bodies that are not convex: how they are divided into convex parts, and the edges of their surface."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, combinations

import numpy as np

from ..quantities import Array
from .convex import kept_of
from .hull import Convex, Hull, area_vector, bulk_of, face_edges, hull_of, triangles_of

ON_PLANE = 1e-6
"""Distance from a plane below which a corner lies on it, over the extent of the body [-]."""
ONE_PART = 1e-6
"""Volume that the hull of two parts adds to them, over that of the hull, up to which they are joined into one [-]."""
CELLS_A_PART = 3
"""Largest number of cells that are cut, over the largest number of parts [-]."""


def convex_parts(corners: Array, faces: Sequence[tuple[int, ...]], most: int) -> list[Array]:
    """The corners of convex parts that fill a closed body, shape (n, 3) each.

    The hull of the body is cut by the plane of the largest face that goes through it, each piece by that of the largest
    face within it, and so on. A piece that no face goes through is whole or empty, by the winding number about its
    centroid. Neighbours whose union is convex are then put together.

    Args:
        corners: of the body [m], shape (n, 3).
        faces: numbers of the corners of each, all counterclockwise as seen from outside, or all clockwise. One that is
            not plane is taken as the triangles with its first corner.
        most: parts at most.

    Raises:
        ValueError: for more parts.
    """
    origin, extent = corners.mean(axis=0), float(np.ptp(corners, axis=0).max())
    centred = (corners - origin) / extent
    fans = [centred[triangles_of([face])] for face in faces]
    triangles = np.concatenate(fans)
    is_plane = [np.ptp(centred[list(face)] @ _normal(centred[list(face)])) <= ON_PLANE for face in faces]
    sides = [[centred[list(face)]] if flat else [*fan] for face, fan, flat in zip(faces, fans, is_plane, strict=True)]
    open_cells = [(centred, list(chain.from_iterable(sides)))]
    filled_cells: list[Array] = []
    count = 0
    while open_cells:
        cell, polygons = open_cells.pop()
        try:
            hull = hull_of(cell)
        except ValueError:  # what is cut off is thinner than a part can be
            continue
        cell = cell[list(hull.corners)]
        plane = _cutting_plane(cell, polygons)
        if plane is None:
            if abs(_winding(bulk_of(cell, hull.faces).centroid, triangles)) > 0.5:
                filled_cells.append(cell)
            continue
        count += 1
        if count > CELLS_A_PART * most:
            raise ValueError(f"its faces cut it into more than {most} parts")
        normal, offset = plane
        for sense in (1.0, -1.0):
            kept = [_polygon_beyond(polygon, sense * normal, sense * offset) for polygon in polygons]
            corners_kept = _cell_corners_beyond(cell, hull, sense * normal, sense * offset)
            open_cells.append((corners_kept, [polygon for polygon in kept if len(polygon) > 2]))
    filled_cells = _joined_parts(filled_cells)
    if len(filled_cells) > most:
        raise ValueError(f"its faces cut it into {len(filled_cells)} parts, and {most} is the most")
    return [origin + extent * part for part in filled_cells]


def _normal(ring: Array) -> Array:
    """Unit normal of a polygon."""
    normal = area_vector(ring)
    return normal / max(float(np.linalg.norm(normal)), ON_PLANE * ON_PLANE)


def _cutting_plane(cell: Array, polygons: Sequence[Array]) -> tuple[Array, float] | None:
    """The plane of the largest polygon that goes through a cell, its unit normal and offset, or None."""
    areas = np.array([np.linalg.norm(area_vector(polygon)) for polygon in polygons])
    for i in np.argsort(-areas, kind="stable").tolist():
        normal = _normal(polygons[i])
        offset = float((polygons[i] @ normal).mean())
        beyond = cell @ normal - offset
        if beyond.min() < -ON_PLANE and beyond.max() > ON_PLANE:
            return normal, offset
    return None


def _polygon_beyond(polygon: Array, normal: Array, offset: float) -> Array:
    """The part of a polygon on the side of a plane to which its normal points; none of a polygon in the plane."""
    above = polygon @ normal - offset
    if above.max() <= ON_PLANE:
        return np.zeros((0, 3))
    if above.min() >= -ON_PLANE:
        return polygon
    return kept_of(polygon, above)


def _cell_corners_beyond(cell: Array, hull: Hull, normal: Array, offset: float) -> Array:
    """Corners of the part of a convex cell on the side of a plane to which its normal points."""
    above = cell @ normal - offset
    above = np.where(np.abs(above) <= ON_PLANE, 0.0, above)
    points = list(cell[above >= 0])
    for face in hull.faces:
        for i, j in face_edges(face):
            if i < j and above[i] * above[j] < 0:
                points.append(cell[i] + above[i] / (above[i] - above[j]) * (cell[j] - cell[i]))
    return np.array(points)


def _winding(point: Array, triangles: Array) -> float:
    """How often triangles go around a point [-] (Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983, 125)."""
    a, b, c = (triangles - point).transpose(1, 0, 2)
    lengths = [np.linalg.norm(vectors, axis=1) for vectors in (a, b, c)]
    numerator = (np.cross(a, b) * c).sum(axis=1)
    denominator = lengths[0] * lengths[1] * lengths[2]
    for (first, second), length in zip(((a, b), (b, c), (c, a)), (lengths[2], lengths[0], lengths[1]), strict=True):
        denominator = denominator + (first * second).sum(axis=1) * length
    return float(np.arctan2(numerator, denominator).sum()) / (2 * np.pi)


def _joined_parts(parts: list[Array]) -> list[Array]:
    """Parts, with those joined whose union is convex."""
    volumes = [_volume(part) for part in parts]
    while True:
        for i, j in combinations(range(len(parts)), 2):
            if not _touch(parts[i], parts[j]):
                continue
            union = np.concatenate([parts[i], parts[j]])
            if (volume := _volume(union)) - volumes[i] - volumes[j] <= ONE_PART * volume:
                kept = [k for k in range(len(parts)) if k not in (i, j)]
                parts = [union[list(hull_of(union).corners)], *(parts[k] for k in kept)]
                volumes = [volume, *(volumes[k] for k in kept)]
                break
        else:
            return parts


def _touch(part: Array, other: Array) -> bool:
    """Whether the bounds of two parts touch."""
    gap = np.maximum(part.min(axis=0) - other.max(axis=0), other.min(axis=0) - part.max(axis=0))
    return bool((gap <= ON_PLANE).all())


def _volume(points: Array) -> float:
    hull = hull_of(points)
    return bulk_of(points[list(hull.corners)], hull.faces).volume


PROBES = 72
"""Points around an edge that are tested for lying within the body."""
ASIDE_OF_EDGE = 1e-3
"""Distance of these points from the edge, over the extent of the body [-]."""
ALONG_EDGE = 1e-6
"""Distance from an edge at which a corner lies on it, over the extent of the body [-]."""


def creases_of(parts: Sequence[Convex]) -> Array:
    """Ends of the edges of a body [m], shape (n, 2, 3).

    An edge of a part is cut at the corners of other parts that lie on it. A piece of it is an edge of the body unless
    all points on a circle around it lie within the body, or just those of one half, where the surface is plane.
    """
    edges = np.concatenate([part.edge_ends for part in parts])
    if len(parts) == 1:
        return edges
    corners = np.concatenate([part.corners for part in parts])
    extent = float(np.ptp(corners, axis=0).max())
    pieces = np.concatenate([_pieces_of_edge(edge, corners, ALONG_EDGE * extent) for edge in edges])
    middles = pieces.mean(axis=1)
    _, first_of_each = np.unique(np.round(middles / (ALONG_EDGE * extent)), axis=0, return_index=True)
    pieces, middles = pieces[np.sort(first_of_each)], middles[np.sort(first_of_each)]
    circles = np.stack([_circle(end - start) for start, end in pieces])
    probes = middles[:, None] + ASIDE_OF_EDGE * extent * circles
    inside = np.zeros(probes.shape[:2], dtype=bool)
    for part in parts:
        inside |= (probes @ part.normals.T <= part.offsets + ALONG_EDGE * extent).all(axis=2)
    count = inside.sum(axis=1)
    return np.asarray(pieces[(count < PROBES) & (np.abs(count - PROBES // 2) > 1)])


def _pieces_of_edge(edge: Array, corners: Array, near: float) -> Array:
    """The pieces of an edge between the corners that lie on it [m], shape (n, 2, 3)."""
    start, along = edge[0], edge[1] - edge[0]
    length = float(np.linalg.norm(along))
    places = (corners - start) @ along / length
    aside = np.linalg.norm(corners - start - places[:, None] * along / length, axis=1)
    inner = np.unique(np.round(places[(aside < near) & (places > near) & (places < length - near)] / near)) * near
    points = start + np.concatenate([[0.0], inner, [length]])[:, None] * along / length
    return np.stack([points[:-1], points[1:]], axis=1)


def _circle(along: Array) -> Array:
    """Unit vectors perpendicular to a vector, all around it, shape (PROBES, 3)."""
    first = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    first /= np.linalg.norm(first)
    second = np.cross(along, first) / np.linalg.norm(along)
    angles = 2 * np.pi * (np.arange(PROBES) + 0.5) / PROBES
    return np.asarray(np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))
