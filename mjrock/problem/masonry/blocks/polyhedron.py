"""A convex block of masonry in space, from its vertices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, NamedTuple, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ....geometry.hull import Convex, Hull, Side, hull_of
from ....quantities import (
    Array,
    Density,
    Flags,
    Within,
    frozen,
    keep,
    require_array,
    require_flag,
    require_kind,
    short_repr,
    within_ranges,
)
from .polygon import COORDINATE, FARTHEST_VERTEX, Polygon, checked_name, required_vertices

Vertices = tuple[tuple[float, float, float], ...]
Extents = Annotated[ArrayLike, Within(1e-3, FARTHEST_VERTEX, "m")]
"""Extents of a box along x, y and z."""
DENTED = 1e-4
"""Depth of a vertex below the hull of all from which a body is not convex, over its extent [-]."""
DIAGONAL = 1e-12
"""Product of inertia that is put down to rounding, over the sum of the moments [-]."""


@dataclass(frozen=True)
class Polyhedron:
    """A convex block of masonry in space: the convex hull of its vertices.

    x points out of the facade, y along it, and z upwards.

    Args:
        vertices: corners at rest in any order [m], shape (4 to 1000, 3), each coordinate within -10000 to 10000. Those
            in the middle of an edge or of a face are left out.
        density: mass density [kg/m3], 100 to 30000.
        fixed: whether the block belongs to the ground, as an abutment does.
        name: what it is called in results and in the model, at most 1000 characters on one line, without "|"; None
            numbers it.

    Raises:
        ValueError: for fewer than four vertices, two that coincide, vertices in a plane, one that lies inside the hull
            of the others, or a value outside its range.
    """

    vertices: Vertices
    density: float = 2000.0
    fixed: bool = False
    name: str | None = field(default=None)
    hull: Hull = field(init=False, repr=False, compare=False)
    """Faces and their normals, found from the vertices."""

    __repr__ = short_repr

    @within_ranges
    def __init__(
        self,
        vertices: Annotated[ArrayLike, COORDINATE] | Sequence[Sequence[float]],
        density: Density = 2000.0,
        fixed: bool = False,
        name: str | None = None,
    ) -> None:
        hull, corners = checked_hull(vertices)
        keep(
            self,
            name=checked_name(name),
            vertices=corners,
            hull=hull,
            density=density,
            fixed=require_flag("fixed", fixed),
        )

    @classmethod
    @within_ranges
    def box(
        cls,
        size: Extents,
        centre: Annotated[ArrayLike, COORDINATE] = (0.0, 0.0, 0.0),
        density: Density = 2000.0,
        fixed: bool = False,
        name: str | None = None,
    ) -> Self:
        """A box with its edges along the axes.

        Args:
            size: its extents along x, y and z [m], 1e-3 to 10000 each.
            centre: its centre [m], -10000 to 10000 each.
            density, fixed, name: as of `Polyhedron`.

        Raises:
            ValueError: for a value outside its range.
        """
        extents, middle = require_array("size", size, (3,)), require_array("centre", centre, (3,))
        signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        return cls(middle + signs * extents, density, fixed, name)

    @classmethod
    @within_ranges
    def prism(cls, polygon: Polygon, middle: Annotated[float, COORDINATE] = 0.0) -> Self:
        """A block of the plane as a body in space: it reaches over its length along y.

        Args:
            polygon: the block, whose density, name and support are kept.
            middle: y of the middle of its length [m], -10000 to 10000.

        Raises:
            ValueError: for a value outside its range.
        """
        require_kind("polygon", polygon, Polygon)
        half = 0.5 * polygon.length
        ends = [[(x, middle + y, z) for x, z in polygon.vertices] for y in (-half, half)]
        return cls([*ends[0], *ends[1]], polygon.density, polygon.fixed, polygon.name)

    @cached_property
    def corners(self) -> Array:
        """The vertices [m], shape (n, 3)."""
        return frozen(self.vertices)

    @property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """The plane faces: numbers of the corners of each, counterclockwise as seen from outside."""
        return self.hull.faces

    @property
    def normals(self) -> Array:
        """Unit normals out of the faces, shape (faces, 3)."""
        return self.hull.normals

    @property
    def parts(self) -> tuple[Polyhedron, ...]:
        """The convex parts that it is made of: itself."""
        return (self,)

    @property
    def sides(self) -> tuple[Side, ...]:
        """Its faces."""
        return self.solids[0].sides

    @property
    def in_space(self) -> bool:
        """Whether it is a body in space."""
        return True

    @cached_property
    def solids(self) -> tuple[Convex, ...]:
        """The convex body that it is."""
        return (Convex(self.corners, self.faces, self.normals),)

    @property
    def inside(self) -> tuple[Flags, ...]:
        """Which faces nothing meets: none, shape (faces,)."""
        return (np.zeros(len(self.faces), dtype=bool),)

    @property
    def edges(self) -> Array:
        """Unit vectors along the edges, those that are parallel once, shape (directions, 3)."""
        return self.solids[0].edges

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return self.solids[0].bulk.volume

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.density * self.volume

    @property
    def centroid(self) -> Array:
        """The centroid at rest [m], shape (3,)."""
        return np.array(self.solids[0].bulk.centroid)

    @cached_property
    def inertia(self) -> Array:
        """Tensor of inertia about the centroid, in the axes of the world [kg m2], shape (3, 3)."""
        second = self.density * self.solids[0].bulk.second
        return frozen(np.trace(second) * np.eye(3) - second)

    @cached_property
    def principal(self) -> PrincipalInertia:
        """Principal moments of inertia and their axes."""
        return principal_of(self.inertia)

    @cached_property
    def size(self) -> float:
        """Largest distance of a vertex from the centroid [m]."""
        return float(np.linalg.norm(self.corners - self.centroid, axis=1).max())


class PrincipalInertia(NamedTuple):
    """Principal moments of inertia [kg m2], shape (3,), and their axes, the columns of a right-handed array, (3, 3)."""

    moments: Array
    axes: Array


def principal_of(inertia: Array) -> PrincipalInertia:
    """Principal moments and axes of a tensor of inertia [kg m2], shape (3, 3).

    The axes of the world are kept where they are principal. Otherwise the moments ascend.
    """
    if np.abs(inertia - np.diag(np.diag(inertia))).max() <= DIAGONAL * float(np.trace(inertia)):
        return PrincipalInertia(np.diag(inertia).copy(), np.eye(3))
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return PrincipalInertia(moments, axes)


def checked_hull(vertices: ArrayLike | Sequence[Sequence[float]]) -> tuple[Hull, Vertices]:
    """The hull of vertices, and those that are its corners, in the order given.

    Raises:
        TypeError, ValueError: for other than at least 4 points in space, two that coincide, and no convex body.
    """
    points = required_vertices(vertices, 4, 3)
    extent = float(np.ptp(points, axis=0).max())
    if not extent > 1e-3:
        raise ValueError(f"vertices extend over {extent:.3g} m; the valid range begins at 0.001 m")
    if pairs := scipy.spatial.cKDTree(points).query_pairs(max(1e-9 * extent, 1e-7)):
        i, j = min(pairs)
        raise ValueError(f"vertices {i} and {j} coincide at {points[i].tolist()} m")
    try:
        hull = hull_of(points)
    except ValueError as error:
        raise ValueError(f"{error}; valid vertices are the corners of a convex body") from None
    deepest = int(hull.depth.argmax())
    if hull.depth[deepest] > DENTED * extent:
        raise ValueError(
            f"vertices: {deepest} at {points[deepest].tolist()} m lies {hull.depth[deepest]:.3g} m inside the hull of "
            "the others; a block is convex"
        )
    return hull, tuple((float(x), float(y), float(z)) for x, y, z in points[list(hull.corners)])
