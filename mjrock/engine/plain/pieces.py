"""Pieces: the convex solids of a scene, the geoms of a plain model, and the volume that two of them have in common."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy

from ...geometry.hull import Convex, hull_of
from ...problem.wall.rest_geometry import Solid
from ...quantities import Array
from ...scene.scene import Scene

LEAST_BALL = 1e-12
"""Radius of the largest ball within both solids up to which they have nothing in common, over their size [-]."""


class Cuboid(NamedTuple):
    """A box: its middle and its half sizes [m], shape (3,) each, and its axes, shape (3, 3)."""

    middle: Array
    half: Array
    axes: Array


@dataclass(frozen=True, eq=False)
class Piece:
    """A convex solid that belongs to a body or stands fixed.

    Args:
        name: of its geom.
        block: name of the block that it belongs to.
        body: number of the body that carries it, or -1 where it is fixed.
        shape: in the frame of its body, or of the world where it is fixed [m].
        is_ground: whether it stands for level ground without an end, whose surface is its top.
        is_seen: whether it is seen.
        meets: whether it meets others.
    """

    name: str
    block: str
    body: int
    shape: Convex
    is_ground: bool = False
    is_seen: bool = True
    meets: bool = True

    @cached_property
    def middle(self) -> Array:
        """Middle between its outermost corners [m], shape (3,)."""
        return np.asarray(0.5 * (self.shape.corners.min(axis=0) + self.shape.corners.max(axis=0)))

    @cached_property
    def thickness(self) -> float:
        """Its smallest extent along the axes, that of the ground without end [m]."""
        return np.inf if self.is_ground else float(np.ptp(self.shape.corners, axis=0).min())

    @cached_property
    def box(self) -> Cuboid | None:
        """The solid as a box, however it is turned; None where it is none."""
        if self.shape.box is not None:
            return Cuboid(*self.shape.box, np.eye(3))
        corners, normals = self.shape.corners, self.shape.normals
        if len(corners) != 8 or len(normals) != 6:
            return None
        first = normals[0]
        across = normals[np.abs(normals @ first).argmin()]
        axes = np.stack([first, across, np.cross(first, across)])
        along = (corners - self.middle) @ axes.T
        half = np.abs(along).max(axis=0)
        is_box = np.abs(np.abs(along) - half).max() <= 1e-9 * half.max()
        return Cuboid(self.middle, half, axes) if is_box else None

    @property
    def has_mesh(self) -> bool:
        """Whether it is neither a box nor a plane, which MuJoCo has as shapes of their own."""
        return not (self.is_ground or self.box)

    def distance(self, points: Array, normals: Array) -> Array:
        """How far points are from its faces, with the normals of these as theirs [m], shape (n,).

        A normal that differs from that of the face adds the size of the solid times one less the cosine between both.
        """
        away = points @ self.shape.normals.T - self.shape.offsets
        size = float(np.ptp(self.shape.corners, axis=0).max())
        distances = np.abs(away) + size * (1 - normals @ self.shape.normals.T)
        return np.asarray(distances.min(axis=1) + np.maximum(away.max(axis=1), 0.0))


def pieces_of(scene: Scene) -> list[Piece]:
    """The pieces of a scene: those of its bodies in their order, and then the fixed ones."""
    solids = sorted(scene.rest_geometry.solids, key=lambda solid: solid.fixed)
    return [piece for solid in solids for piece in _pieces_of_solid(solid, scene)]


def _pieces_of_solid(solid: Solid, scene: Scene) -> Iterator[Piece]:
    """The convex parts of a solid."""
    parts, is_wall = solid.drawn if solid.fixed else solid.parts, solid.block is None or not solid.sides
    if is_wall and not solid.fixed:
        yield from _pieces_of_wall(solid, scene)
        return
    if is_stepped_stop(solid):
        corners = solid.corners
        foot = corners[corners[:, 2] == corners[:, 2].min(), 0].max()
        yield from _pieces_of_hull(solid, np.minimum(corners, (foot, np.inf, np.inf)))
        return
    for i, part in enumerate(parts):
        name = solid.name if i == 0 else f"{solid.name} part {i}"
        yield Piece(name, solid.name, solid.body, part, is_ground=is_wall and solid.name == "base")


def is_stepped_stop(solid: Solid) -> bool:
    """Whether a solid is a side stop behind a wall with setbacks inside, which are filled where the two meet."""
    return solid.name == "side" and not solid.sides and len(solid.drawn) > 1


def _pieces_of_hull(solid: Solid, corners: Array) -> Iterator[Piece]:
    """A solid that meets others as the hull of corners. Where it has several parts, those are seen and meet nothing."""
    hull = hull_of(corners)
    hull_solid, simple = Convex(corners[list(hull.corners)], hull.faces, hull.normals), len(solid.drawn) == 1
    yield Piece(solid.name, solid.name, solid.body, hull_solid, is_seen=simple)
    if not simple:
        for i, part in enumerate(solid.drawn if solid.fixed else solid.parts):
            yield Piece(f"{solid.name} part {i}", solid.name, solid.body, part, meets=False)


def _pieces_of_wall(solid: Solid, scene: Scene) -> Iterator[Piece]:
    """A wall meets its base and its side as one convex solid."""
    corners = solid.corners
    rests = scene.contacts.at[scene.contacts.normal[:, 1] == 1, 0]
    ends, low = np.array([rests.min(), rests.max()]), corners[:, 2].min()
    foot = corners[corners[:, 2] == low]
    inset = float(np.abs(np.array([foot[:, 0].min(), foot[:, 0].max()]) - ends).max())
    if inset > 1e-12 * np.abs(corners).max():  # edges that have been crushed are cut off
        edges = np.array([(x, y, low) for x in ends for y in (foot[:, 1].min(), foot[:, 1].max())])
        corners = np.concatenate([corners[corners[:, 2] > low], foot + np.array((0.0, 0.0, inset)), edges])
    if any(is_stepped_stop(solid_beside) for solid_beside in scene.rest_geometry.solids):
        top = corners[corners[:, 2] == corners[:, 2].max()]
        corners = np.concatenate([corners, np.minimum(top, (corners[:, 0].min(), np.inf, np.inf))])
    yield from _pieces_of_hull(solid, corners)


class Overlap(NamedTuple):
    """Two pieces that lie inside each other.

    Args:
        depth: of their deepest contact, over the smallest thickness of the two [-].
        t: when [s].
        pieces: the two.
        place, turn: where the frames of their bodies are [m], and how they are turned, shapes (2, 3) and (2, 3, 3).
    """

    depth: float
    t: float
    pieces: tuple[Piece, Piece]
    place: Array
    turn: Array

    @property
    def share(self) -> float:
        """Volume that they have in common, over that of the smaller one [-]."""
        planes = []
        for piece, place, turn in zip(self.pieces, self.place, self.turn, strict=True):
            normals = piece.shape.normals @ turn.T
            sides = np.column_stack([normals, -piece.shape.offsets - normals @ place])
            planes.append(sides[sides[:, 2] > 0.5] if piece.is_ground else sides)  # of the ground its top alone
        smallest = min(piece.shape.bulk.volume for piece in self.pieces if not piece.is_ground)
        return common_volume(np.concatenate(planes)) / smallest


def common_volume(planes: Array) -> float:
    """Volume of the points x with normal . x + offset <= 0 for all planes [m3], from normals and offsets, (n, 4).

    The middle of the largest ball within is the point about which the planes are taken to their dual.
    """
    normals, offsets = planes[:, :3], planes[:, 3]
    ball = scipy.optimize.linprog(
        (0, 0, 0, -1), np.column_stack([normals, np.ones(len(planes))]), -offsets, bounds=[(None, None)] * 4
    )
    if ball.status != 0 or ball.x[3] <= LEAST_BALL * np.abs(offsets).max():
        return 0.0
    inner = scipy.spatial.HalfspaceIntersection(planes, ball.x[:3])
    return float(scipy.spatial.ConvexHull(inner.intersections).volume)
