"""A convex block of masonry, from the vertices of its outline."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....geometry.convex import next_of
from ....geometry.hull import Convex, Side, prism
from ....quantities import (
    Array,
    Density,
    Flags,
    Within,
    frozen,
    keep,
    require_flag,
    require_reals,
    require_text,
    short_repr,
    shown,
    within_ranges,
)

Corners = tuple[tuple[float, float], ...]
FARTHEST_VERTEX = 1e4
"""Largest coordinate of a vertex [m]."""
COORDINATE = Within(-FARTHEST_VERTEX, FARTHEST_VERTEX, "m")
LENGTHS = Within(1e-3, 1e3, "m")
"""The ranges of a coordinate, and of the length of a block out of the plane."""
BEND = 1e-9
"""Sine of a corner that is too flat to tell whether it turns inwards [-]."""
MOST_VERTICES = 1000
"""Most vertices of a block."""


class AreaMoments(NamedTuple):
    """Area of an outline [m2], its centroid x, z [m], and its polar second moment of area about it [m4]."""

    area: float
    centroid: Array
    polar: float


@dataclass(frozen=True)
class Polygon:
    """A convex prism of masonry, seen along its length.

    Args:
        vertices: corners x, z at rest in order around the block, in either direction [m], shape (3 to 1000, 2), each
            coordinate within -10000 to 10000. They are kept counterclockwise, x to the right and z upwards, without
            those on a straight edge.
        density: mass density [kg/m3], 100 to 30000.
        length: length out of the plane [m], 1e-3 to 1000.
        fixed: whether the block belongs to the ground, as an abutment does.
        name: what it is called in results and in the model, at most 1000 characters on one line, without "|"; None
            numbers it.

    Raises:
        ValueError: for fewer than three vertices, two that coincide, edges that cross, a corner that points inwards, or
            a value outside its range.
    """

    vertices: Corners
    density: float = 2000.0
    length: float = 1.0
    fixed: bool = False
    name: str | None = field(default=None)

    __repr__ = short_repr

    @within_ranges
    def __init__(
        self,
        vertices: Annotated[ArrayLike, COORDINATE] | Sequence[Sequence[float]],
        density: Density = 2000.0,
        length: Annotated[float, LENGTHS] = 1.0,
        fixed: bool = False,
        name: str | None = None,
    ) -> None:
        keep(
            self,
            name=checked_name(name),
            vertices=checked_corners(vertices),
            density=density,
            length=length,
            fixed=require_flag("fixed", fixed),
        )

    @cached_property
    def corners(self) -> Array:
        """The vertices counterclockwise [m], shape (n, 2)."""
        return frozen(self.vertices)

    @cached_property
    def normals(self) -> Array:
        """Unit normals out of the edges, each of which begins at the corner of the same number, shape (n, 2)."""
        edges = next_of(self.corners) - self.corners
        return frozen(np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(*edges.T)[:, None])

    @property
    def parts(self) -> tuple[Polygon, ...]:
        """The convex parts that it is made of: itself."""
        return (self,)

    @cached_property
    def sides(self) -> tuple[Side, ...]:
        """Its edges, in the order of `normals`."""
        ends = np.stack([self.corners, next_of(self.corners)], axis=1)
        return tuple(Side(*edge) for edge in zip(ends, self.normals, strict=True))

    @property
    def solids(self) -> tuple[Convex, ...]:
        """The prism that it is, over its length along y about 0."""
        corners, faces = prism(self.corners, self.length)
        across, normals = np.array([(0.0, -1.0, 0.0), (0.0, 1.0, 0.0)]), np.zeros((len(self.corners), 3))
        normals[:, ::2] = self.normals
        return (Convex(corners, faces, np.concatenate([across, normals])),)

    @property
    def inside(self) -> tuple[Flags, ...]:
        """Of the prism, which faces nothing meets: its two ends, before its sides, shape (faces,)."""
        return (np.arange(2 + len(self.corners)) < 2,)

    @property
    def in_space(self) -> bool:
        """Whether it is a body in space."""
        return False

    @cached_property
    def _moments(self) -> AreaMoments:
        """Sums over the triangles between an edge and the first vertex, which is the origin here."""
        origin, (p, q, twice) = self.corners[0], _triangles(self.corners)
        area = 0.5 * float(twice.sum())
        offset = (twice[:, None] * (p + q)).sum(axis=0) / (6 * area)
        about_origin = float((twice * (p * p + p * q + q * q).sum(axis=1)).sum()) / 12
        return AreaMoments(area, origin + offset, about_origin - area * float((offset * offset).sum()))

    @property
    def area(self) -> float:
        """Area of the outline [m2]."""
        return self._moments.area

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.density * self.length * self.area

    @property
    def centroid(self) -> Array:
        """x and z of the centroid at rest [m], shape (2,)."""
        return self._moments.centroid.copy()

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centroid [kg m2]."""
        return self.density * self.length * self._moments.polar

    def left_at(self, z: float) -> float:
        """The left end of the block at a height z [m], x [m]; at the end of its range where z lies beyond that."""
        ends = []
        for (x0, z0), (x1, z1) in zip(self.corners, next_of(self.corners), strict=True):
            low, high = min(z0, z1), max(z0, z1)
            if low - 1e-9 <= z <= high + 1e-9:
                share = 0.5 if z1 == z0 else min(max((z - z0) / (z1 - z0), 0.0), 1.0)
                ends.append(min(x0, x1) if z1 == z0 else x0 + share * (x1 - x0))
        return float(min(ends, default=self.corners[:, 0].min()))

    @cached_property
    def size(self) -> float:
        """Largest distance of a vertex from the centroid [m]."""
        return float(np.hypot(*(self.corners - self.centroid).T).max())


class InwardsError(ValueError):
    """An outline that is not convex."""


def checked_name(name: str | None) -> str | None:
    """The name of a block, or None.

    Raises:
        TypeError, ValueError: for any other.
    """
    if name is not None and (require_text("name", name).splitlines() != [name] or "|" in name or name == "world"):
        raise ValueError(f"name = {shown(name)} is empty, is world, or holds a | or the end of a line")
    return name


def required_vertices(vertices: ArrayLike | Sequence[Sequence[float]], least: int, axes: int) -> Array:
    """Vertices as an array, at least a given number.

    Raises:
        TypeError, ValueError: for any other.
    """
    shape = f"({least} to {MOST_VERTICES}, {axes})"
    points = require_reals("vertices", vertices, f"an array of real numbers of the shape {shape}")
    if points.ndim != 2 or points.shape[1] != axes or not least <= len(points) <= MOST_VERTICES:
        raise ValueError(f"vertices has the shape {points.shape}; {shape} is needed")
    require_near(points)
    return points


def require_near(points: Array) -> None:
    """Raise a ValueError unless all coordinates of vertices lie within FARTHEST_VERTEX [m]."""
    if not (np.abs(points) <= FARTHEST_VERTEX).all():  # a NaN is not
        low, high = -FARTHEST_VERTEX, FARTHEST_VERTEX
        at = "; national coordinates? Subtract an origin near the masonry" if np.isfinite(points).all() else ""
        raise ValueError(f"vertices holds a coordinate outside the valid range {low:g} to {high:g} m{at}")


def checked_corners(vertices: ArrayLike | Sequence[Sequence[float]]) -> Corners:
    """Vertices as pairs of numbers, counterclockwise.

    Raises:
        TypeError, ValueError: for any other.
    """
    corners = required_vertices(vertices, 3, 2)
    edges = next_of(corners) - corners
    lengths = np.hypot(*edges.T)
    extent = float(np.ptp(corners, axis=0).max())
    if not lengths.min() > max(1e-9 * extent, 1e-7):
        i = int(lengths.argmin())
        raise ValueError(f"vertices {i} and {(i + 1) % len(corners)} coincide at {corners[i].tolist()} m")
    _require_no_crossing(corners)
    unit = edges / lengths[:, None]
    before = np.roll(unit, 1, axis=0)
    turns = before[:, 0] * unit[:, 1] - before[:, 1] * unit[:, 0]
    area = 0.5 * float(_triangles(corners)[2].sum())
    if not abs(area) > max(1e-6 * extent**2, 1e-8):
        raise ValueError(f"vertices enclose an area of {abs(area):.3g} m2: they lie on a line")
    inwards = np.flatnonzero(np.sign(area) * turns < -BEND)
    if inwards.size:
        i = int(inwards[0])
        raise InwardsError(f"vertices: the corner {i} at {corners[i].tolist()} m points inwards; a block is convex")
    winding = float(np.arctan2(turns, (before * unit).sum(axis=1)).sum()) / (2 * math.pi)
    if abs(abs(winding) - 1) > 0.1:
        raise ValueError("vertices: the edges cross; give the vertices in order around the block")
    corners = corners[np.abs(turns) > BEND]  # what lies on a straight edge is not a corner
    ordered = corners if area > 0 else corners[::-1]
    return tuple((float(x), float(z)) for x, z in ordered)


def _triangles(corners: Array) -> tuple[Array, Array, Array]:
    """Corners and those that follow them, from the first one [m], and twice the areas of the triangles with it."""
    p = corners - corners[0]
    q = next_of(p)
    return p, q, p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]


def _require_no_crossing(p: Array) -> None:
    """Raise ValueError if two edges that are not neighbours cross."""
    q, n = next_of(p), len(p)

    def side(a: Array, b: Array, c: Array) -> float:
        return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))

    for i in range(n if n <= 50 else 0):  # the winding finds it in an outline of many vertices
        for j in range(i + 2, n - (i == 0)):
            apart = side(p[i], q[i], p[j]) * side(p[i], q[i], q[j])
            if apart < 0 and side(p[j], q[j], p[i]) * side(p[j], q[j], q[i]) < 0:
                raise ValueError(
                    f"vertices: the edges after corners {i} and {j} cross; give the vertices in order around the block"
                )
