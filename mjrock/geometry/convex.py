"""Convex polygons in a plane: clipping, cleaning, area, width, and weights of their corners.

A polygon is an array of its corners counterclockwise, shape (n, 2) [m].
"""

from __future__ import annotations

import numpy as np

from ..quantities import Array


def cross(a: Array, b: Array) -> Array:
    """The product a_x b_y - a_y b_x, of vectors with shape (..., 2)."""
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def cross_in_space(a: Array, b: Array) -> Array:
    """The vector product of vectors with shape (..., 3); for few vectors it is far faster than `numpy.cross`."""
    product: Array = a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]]
    return product


def next_of(corners: Array) -> Array:
    """The corner after each one of a polygon, shape of the corners; `numpy.roll` takes five times as long."""
    return np.concatenate([corners[1:], corners[:1]])


def clipped(polygon: Array, window: Array) -> Array:
    """The part of a convex polygon within another; no corners where there is none.

    It is cut by one edge after the other (Sutherland and Hodgman, Communications of the ACM 17, 1974, 32-42).
    """
    for start, edge in zip(window, next_of(window) - window, strict=True):
        inwards = cross(edge, polygon - start)
        if (inwards >= 0).all():
            continue
        polygon = kept_of(polygon, inwards)
        if len(polygon) < 3:
            return np.zeros((0, 2))
    return polygon


def kept_of(polygon: Array, inwards: Array) -> Array:
    """The part of a convex polygon, shape (n, 2) or (n, 3), whose distances inwards from a line or plane are positive.

    Args:
        polygon: its corners.
        inwards: these distances of the corners, shape (n,).
    """
    kept, distances = [], inwards.tolist()
    for i, distance in enumerate(distances):
        j = (i + 1) % len(polygon)
        if distance >= 0:
            kept.append(polygon[i])
        if (distance >= 0) != (distances[j] >= 0):
            kept.append(polygon[i] + distance / (distance - distances[j]) * (polygon[j] - polygon[i]))
    return np.array(kept)


def cleaned(polygon: Array, tolerance: float) -> Array:
    """A polygon without corners that lie within a distance of the line between their neighbours [m].

    The flattest corner is removed first, and the others are measured again without it. No corners remain of a polygon
    that is narrower than the distance.
    """
    while len(polygon):
        before, after = np.concatenate([polygon[-1:], polygon[:-1]]), next_of(polygon)
        chord = np.hypot(*(after - before).T)
        height = np.hypot(*(polygon - before).T)
        np.divide(cross(polygon - before, after - before), chord, out=height, where=chord > 0)
        height = np.minimum(np.abs(height), np.hypot(*(polygon - before).T))
        flattest = int(height.argmin())
        if height[flattest] > tolerance:
            return polygon
        polygon = np.delete(polygon, flattest, axis=0) if len(polygon) > 3 else np.zeros((0, 2))
    return polygon


def area(polygon: Array) -> float:
    """Area of a polygon [m2]."""
    arms = polygon - polygon[0]
    return 0.5 * float(cross(arms, next_of(arms)).sum())


def polygon_centroid(polygon: Array) -> Array:
    """Centroid of the area of a polygon [m], shape (2,)."""
    arms = polygon - polygon[0]
    after = next_of(arms)
    doubled_areas = cross(arms, after)
    middle: Array = polygon[0] + (doubled_areas[:, None] * (arms + after)).sum(axis=0) / (3 * doubled_areas.sum())
    return middle


def width(polygon: Array) -> float:
    """The smallest extent of a convex polygon in any direction of its plane [m]."""
    edges = next_of(polygon) - polygon
    normals = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.hypot(*edges.T)[:, None]
    return float(np.ptp(polygon @ normals.T, axis=0).min())


def within(polygon: Array, points: Array) -> Array:
    """Distance of points from the nearest edge of a convex polygon [m], negative outside, shape (p,)."""
    edges = next_of(polygon) - polygon
    inwards = cross(edges, points[:, None] - polygon) / np.hypot(*edges.T)
    return np.asarray(inwards.min(axis=1))


def shares(polygon: Array, point: Array) -> Array:
    """Weights of the corners of a convex polygon, all positive, whose sum is 1 and whose mean is a point inside, (n,).

    They are mean value coordinates (Floater, Computer Aided Geometric Design 20, 2003).
    """
    spokes = polygon - point
    lengths = np.hypot(*spokes.T)
    after = next_of(spokes)
    # tan of half the angle between a spoke and the next
    halves = cross(spokes, after) / (lengths * next_of(lengths) + (spokes * after).sum(axis=1))
    weights = (halves + np.roll(halves, 1)) / lengths
    normed: Array = weights / weights.sum()
    return normed


def exact_shares(count: int) -> Array:
    """Weights of evenly spaced points on a length, ends included, for integrals over it, shape (count,).

    Length, middle and second moment are exact, and all weights are positive. They are those of the trapezoidal rule,
    with 1 / (12 (count - 2)) moved from each end to the point beside it. Three points have Simpson's weights 1/6, 4/6,
    1/6, and four his 1/8, 3/8, 3/8, 1/8. The count is at least 3.
    """
    shares = np.full(count, 1 / (count - 1))
    shares[[0, -1]] /= 2
    correction = 1 / (12 * (count - 2))
    np.add.at(shares, [0, 1, -2, -1], [-correction, correction, correction, -correction])
    return shares


def spread(polygon: Array, points: int) -> tuple[Array, Array]:
    """Points of a convex polygon [m], shape (p, 2), and the part of its area for each [m2], shape (p,).

    With `points` = 2 they are its corners. With more, a polygon of four corners is divided into (points - 1)^2 cells by
    lines between opposite edges, which gives points x points points. Any other polygon is divided into one
    quadrilateral per corner, between that corner, the middles of its edges and the centroid, and each of them into m^2
    cells, with m half of points - 1, rounded up. The area of each cell is shared among its corners. All areas are
    positive. Their sum is the area of the polygon, and the mean of the points, weighted by them, is its centroid.
    """
    if points == 2:
        return polygon, area(polygon) * shares(polygon, polygon_centroid(polygon))
    quads, divisions = ([polygon], points - 1) if len(polygon) == 4 else (_quarters(polygon), points // 2)
    corners, areas = [], []
    for quad in quads:
        grid = _grid(quad, divisions)[0]
        for i in range(divisions):
            for j in range(divisions):
                cell = np.array([grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]])
                corners.append(cell)
                areas.append(area(cell) * shares(cell, polygon_centroid(cell)))
    return _merged_places(np.concatenate(corners), np.concatenate(areas))


def sectioned(polygon: Array, points: int) -> tuple[Array, Array]:
    """The points of `spread` with areas that give the second moments of the polygon exactly too, all positive.

    They are the weights of `exact_shares` along both sides of a quadrilateral, times the area of the quadrilateral
    about each point. The quadrilaterals of other polygons have at least three points a side. `points` is at least 3.
    """
    quads, divisions = ([polygon], points - 1) if len(polygon) == 4 else (_quarters(polygon), max(points // 2, 2))
    weights = np.multiply.outer(*[exact_shares(divisions + 1)] * 2)
    grids = [_grid(quad, divisions) for quad in quads]
    places = np.concatenate([grid.reshape(-1, 2) for grid, _ in grids])
    return _merged_places(places, np.concatenate([(weights * jacobian).ravel() for _, jacobian in grids]))


def _quarters(polygon: Array) -> list[Array]:
    """Quadrilaterals of a polygon: one per corner, between it, the middles of its edges and the centroid."""
    middle, halves = polygon_centroid(polygon), 0.5 * (polygon + next_of(polygon))
    return [np.array([polygon[i], halves[i], middle, halves[i - 1]]) for i in range(len(polygon))]


def _grid(quad: Array, divisions: int) -> tuple[Array, Array]:
    """Corners of the cells of a quadrilateral [m], shape (divisions + 1, divisions + 1, 2), and at each the Jacobian of
    the map from the unit square [m2]."""
    a, b, c, d = quad
    steps = np.linspace(0.0, 1.0, divisions + 1)
    s, t = (values[..., None] for values in np.meshgrid(steps, steps, indexing="ij"))
    places = ((1 - s) * (1 - t)) * a + (s * (1 - t)) * b + (s * t) * c + ((1 - s) * t) * d
    return places, cross((1 - t) * (b - a) + t * (c - d), (1 - s) * (d - a) + s * (c - b))


def _merged_places(places: Array, areas: Array) -> tuple[Array, Array]:
    """Places that coincide as one, with the sum of their areas."""
    extent = float(np.ptp(places, axis=0).max())
    keys = np.round((places - places[0]) / (1.3e-9 * extent))  # no fraction of an edge lies between two keys
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    total = np.zeros(len(first))
    np.add.at(total, number.ravel(), areas)
    order = np.argsort(first)
    return places[first][order], total[order]
