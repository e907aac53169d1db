"""Pieces: the convex solids of a scene, each of which is a geom of a plain model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import ConvexHull

from ...geometry.frames import PLANE
from ...geometry.graph import components
from ...geometry.hull import prism
from ...problem.masonry.case import AnyCase
from ...problem.wall.standing import Solid
from ...quantities import Array
from ...scene.checks import GROUND
from ...scene.scene import Scene
from ..shapes import part_names


@dataclass(frozen=True, eq=False)
class Piece:
    """A convex solid that belongs to a body or stands fixed.

    Args:
        name: of its geom.
        block: name of the block or the body that it belongs to.
        body: number of the body that carries it, or -1 where it is fixed.
        corners: in the frame of its body, or of the world where it is fixed [m], shape (n, 3).
        is_ground: whether it stands for level ground without an end, whose surface is its top.
    """

    name: str
    block: str
    body: int
    corners: Array
    is_ground: bool = False

    @cached_property
    def middle(self) -> Array:
        """Middle between its outermost corners [m], shape (3,)."""
        return np.asarray(0.5 * (self.corners.min(axis=0) + self.corners.max(axis=0)))

    @cached_property
    def half(self) -> Array:
        """Half its extents [m], shape (3,)."""
        return np.asarray(0.5 * np.ptp(self.corners, axis=0))

    @cached_property
    def is_box(self) -> bool:
        """Whether it is a box along the axes."""
        return len(self.corners) == 8 and np.allclose(np.abs(self.corners - self.middle), self.half, rtol=1e-12)

    @property
    def has_shape(self) -> bool:
        """Whether it is a shape of MuJoCo's own, a box or a plane, and needs no mesh."""
        return self.is_box or self.is_ground

    @cached_property
    def planes(self) -> Array:
        """Its faces as outward normals and offsets, shape (faces, 4): inside, normal . x + offset < 0."""
        return np.asarray(ConvexHull(self.corners).equations)

    @cached_property
    def volume(self) -> float:
        """Its volume [m3]."""
        return float(ConvexHull(self.corners).volume)

    def beside(self, points: Array, normals: Array) -> Array:
        """How far points with normals are from being on its surface, with the normals out of it [m], shape (n,)."""
        away = points @ self.planes[:, :3].T + self.planes[:, 3]
        turned = np.linalg.norm(self.half) * (1 - normals @ self.planes[:, :3].T)
        return np.asarray((np.abs(away) + turned).min(axis=1) + np.maximum(away.max(axis=1), 0.0))


def pieces_of(case: AnyCase, scene: Scene) -> list[Piece]:
    """The pieces of a scene: those of its bodies in their order, and then what stands fixed."""
    return [*_of_bodies(scene), *(piece for solid in case.solids if solid.fixed for piece in _of_fixed(solid))]


def _of_bodies(scene: Scene) -> Iterator[Piece]:
    for j, block in enumerate(scene.bodies.names):
        for name, outline in zip(part_names(scene, j), scene.bodies.parts_of(j), strict=True):
            corners = outline
            if scene.freedom == PLANE:
                section = outline if len(scene.bodies.names) > 1 else chamfered(outline, _edges(scene))
                corners = prism(section, scene.bodies.length)[0]
            yield Piece(name, block, j, corners)


def _edges(scene: Scene) -> Array:
    """Where a single body of the plane rests on its level base, from its centroid [m], shape (2, 2) or (0, 2)."""
    on_base = scene.contacts.at[scene.contacts.normal[:, 1] == 1]
    return on_base[[on_base[:, 0].argmin(), on_base[:, 0].argmax()]] if len(on_base) else on_base


def chamfered(outline: Array, edges: Array) -> Array:
    """A convex section whose lowest edge reaches no farther than two points, as an edge that has been crushed.

    Args:
        outline: corners of the section [m], shape (n, 2).
        edges: the two points between which the section rests [m], shape (2, 2).
    """
    hull = outline[ConvexHull(outline).vertices]
    low = hull[:, 1].min()
    bottom = hull[hull[:, 1] == low]
    if not len(edges) or edges[0, 1] != low:
        return hull
    inset = np.abs(np.sort(bottom[:, 0])[[0, -1]] - np.sort(edges[:, 0]))
    if (inset <= 1e-12 * np.abs(hull).max()).all():
        return hull
    raised = bottom + np.array([0.0, inset.max()])
    return np.asarray(hull_around(np.concatenate([hull[hull[:, 1] > low], raised, edges])))


def hull_around(points: Array) -> Array:
    """Corners of the convex hull of points of the plane, counterclockwise, shape (n, 2)."""
    return points[ConvexHull(points).vertices]


def _of_fixed(solid: Solid) -> Iterator[Piece]:
    """The convex parts of a solid that stands fixed: those whose faces hang together."""
    pairs = [(face[0], corner) for face in solid.faces for corner in face[1:]]
    of = components(pairs, len(solid.corners))
    for i, part in enumerate(np.unique(of)):
        name = solid.name if i == 0 else f"{solid.name} part {i}"
        ground = solid.block is None and solid.name == "base"
        yield Piece(name, solid.name, GROUND, solid.rest + solid.corners[of == part], ground)
