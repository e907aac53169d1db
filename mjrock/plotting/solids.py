"""Blocks in space in motion, as a picture needs them: their faces, and where they are drawn and seen from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import null_space

from ..geometry.hull import unlike_ways
from ..problem.masonry.blocks.compound import SolidBlock
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Integers, keep, require_array, require_within
from ..result.bodies import Moving
from ..result.response import Response
from ..scene.tints import colours_of
from .bodies import evened, required_limits

ASIDE = 1e-9
"""Cosine of the angle between the line of sight and the normal of a plane that is seen as a line [-]."""
TOUCHING = 1e-4
"""Overlap of bodies, or of their outlines in the picture, that counts as touching, over the extent of all [-]."""
AROUND, FARTHEST = 0.15, 3.0
"""How far the ground is drawn beyond all corners, and the farthest corners that count for it, over the extent [-]."""


class Facets(NamedTuple):
    """The faces of bodies: corners about the centroid of the body, at rest [m], shape (faces, most, 3), of which a face
    with few repeats the last one; the number of the body, that of its convex part, counted over all bodies, and that of
    the corners, shape (faces,) each."""

    corners: Array
    body: Integers
    part: Integers
    counts: Integers


class Parts(NamedTuple):
    """Convex parts of bodies: the number of the body, shape (parts,); corners about its centroid at rest [m], and unit
    normals of faces and unit vectors along edges at rest, those that are parallel once, shapes (parts, most, 3) each,
    of which a part with few repeats the last one."""

    body: Integers
    corners: Array
    normals: Array
    edges: Array


def hiding(corners: Array, normals: Array, edges: Array, eye: Array) -> Integers:
    """Pairs of convex bodies of which the second hides some of the first, as numbers, shape (n, 2).

    Two convex bodies lie on two sides of a plane. It is looked for along their faces, and along the lines of sight that
    pass an edge: bodies on two sides of a line of sight do not hide each other. Of two bodies that overlap, or lie
    across each other's edges, the one that is nearer by the widest gap is the second.

    Args:
        corners: of each body [m], shape (bodies, most, 3).
        normals, edges: of its faces, and vectors along its edges, shapes (bodies, most, 3).
        eye: unit vector to the camera, shape (3,).
    """
    ways = np.concatenate([normals, np.cross(edges, eye)], axis=1)
    length = np.linalg.norm(ways, axis=2, keepdims=True)
    ways = np.where(length > ASIDE, ways, ways[:, :1])  # in place of an edge along the line of sight
    ways /= np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), ASIDE)
    ways *= np.where(ways @ eye < 0, -1.0, 1.0)[..., None]
    screen = corners @ null_space(eye[None])
    low, high = screen.min(axis=1), screen.max(axis=1)
    first, second = np.nonzero(np.triu(((low[:, None] < high) & (low < high[:, None])).all(axis=2), 1))
    ways = np.concatenate([ways[first], ways[second]], axis=1)
    one, other = (ways @ np.swapaxes(corners[body], 1, 2) for body in (first, second))
    nearer, farther = other.min(axis=2) - one.max(axis=2), one.min(axis=2) - other.max(axis=2)
    across = np.where(ways @ eye < ASIDE, np.maximum(nearer, farther), -np.inf)
    gaps = np.maximum([nearer, farther], across).max(axis=2)  # with which the second is nearer, and farther
    pairs = np.where(gaps[0] > gaps[1], [first, second], [second, first])
    return np.asarray(pairs[:, gaps.min(axis=0) < -TOUCHING * np.ptp(screen, axis=(0, 1)).max()].T)


@dataclass(frozen=True, eq=False)
class Solids:
    """Masonry in space, as a picture shows it.

    Args:
        moving: where its blocks are.
        camera: elevation and azimuth that the blocks are seen from [deg], -90 to 90 and -360 to 360; None is (18, 35).
        limits: lowest and highest x, y and z of the picture [m], three pairs; None shows the blocks, see `extent`.

    Raises:
        ValueError: for a value outside its range.
    """

    moving: Moving
    camera: Sequence[float] | None = None
    limits: Array | None = None

    def __post_init__(self) -> None:
        elevation, azimuth = require_array("camera", (18.0, 35.0) if self.camera is None else self.camera, (2,))
        elevation = require_within("elevation of the camera", elevation, -90.0, 90.0, "degrees")
        keep(
            self,
            camera=(elevation, require_within("azimuth of the camera", azimuth, -360.0, 360.0, "degrees")),
            limits=required_limits(self.limits, "xyz"),
        )

    @classmethod
    def of(
        cls,
        response: Response,
        magnify: float = 1.0,
        camera: Sequence[float] | None = None,
        limits: ArrayLike | None = None,
    ) -> Solids:
        """The blocks of a response in space."""
        magnify = require_within("magnify", magnify, 0.01, 1e4)
        return cls(replace(response.moving, magnify=magnify), camera, required_limits(limits, "xyz"))

    @property
    def t(self) -> Array:
        """Times [s], shape (n,)."""
        return self.moving.t

    @property
    def case(self) -> MasonryCase:
        """What is drawn."""
        return cast(MasonryCase, self.moving.case)

    @property
    def masonry(self) -> Masonry:
        """The blocks."""
        return self.case.masonry

    def at(self, times: Array) -> Solids:
        """The same blocks at other times, their poses interpolated linearly."""
        return replace(self, moving=self.moving.between(times))

    @cached_property
    def eye(self) -> Array:
        """Unit vector to the camera, shape (3,)."""
        elevation, azimuth = np.radians(np.asarray(self.camera))
        level = np.cos(elevation)
        return np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])

    @cached_property
    def shown(self) -> Integers:
        """Numbers of the blocks that are drawn as bodies: all but the ground, fixed ones too."""
        return np.flatnonzero(~np.array(self._are_ground))

    @property
    def ground(self) -> list[SolidBlock]:
        """The fixed blocks below all that move, which are not moved themselves."""
        return [block for block, is_ground in zip(self.masonry.polyhedra, self._are_ground, strict=True) if is_ground]

    @cached_property
    def _are_ground(self) -> list[bool]:
        blocks = self.masonry.blocks
        lowest = min(float(blocks[i].corners[:, 2].min()) for i in self.masonry.free) + 1e-3
        below = [block.fixed and bool(block.corners[:, 2].max() <= lowest) for block in blocks]
        moved = {support.block for support in self.case.supports}
        return [low and name not in moved for low, name in zip(below, self.masonry.names, strict=True)]

    @property
    def colours(self) -> Array:
        """Red, green and blue of each facet, 0 to 1, shape (faces, 3)."""
        return colours_of(self.case.standing)[self.shown[self.facets.body]]

    @cached_property
    def facets(self) -> Facets:
        """The faces of the blocks that are shown."""
        blocks = self._blocks
        counts = np.array([len(side.corners) for block in blocks for side in block.sides])
        body = np.repeat(np.arange(len(blocks)), [len(block.sides) for block in blocks])
        first = np.searchsorted(self._parts.body, body)
        part = first + np.array([side.parts[0] for block in blocks for side in block.sides])
        corners = evened([side.corners for block in blocks for side in block.sides])
        return Facets(corners - self.case.centroids[self.shown[body], None], body, part, counts)

    def corners(self, frame: int) -> Array:
        """Where the corners of all facets are drawn at a frame [m], shape (faces, most, 3)."""
        return self._drawn(frame, self.facets.body, self.facets.corners)

    def order(self, frame: int) -> Integers:
        """The convex parts of all bodies from the farthest to the nearest, shape (parts,).

        A part that another one hides comes before it. Parts that hide one another in a ring, or that overlap, have no
        such order: one of them is drawn too early.
        """
        parts, hidden = self._parts, [set[int]() for _ in self._parts.body]
        corners = self._drawn(frame, parts.body, parts.corners)
        turned = self._drawn(frame, parts.body, np.eye(3)[None]) - self._drawn(frame, parts.body, np.zeros((1, 1, 3)))
        areas = np.cross(np.roll(turned, -1, axis=1), np.roll(turned, -2, axis=1))
        normals, edges = parts.normals @ areas, parts.edges @ turned
        for behind, before in hiding(corners, normals, edges, self.eye).tolist():
            hidden[before].add(behind)
        order, begun, stack = dict[int, None](), set[int](), np.argsort(-corners.mean(axis=1) @ self.eye).tolist()
        while stack:
            part = stack.pop()
            if part in begun:  # what it hides is in the order
                order[part] = None
            else:
                begun.add(part)
                stack += [part, *hidden[part] - begun]
        return np.array([*order])

    def extent(self) -> tuple[Array, Array]:
        """The lowest and the highest x, y and z that the blocks reach in the picture [m], shape (3,) each.

        What goes farther than one extent of the blocks at rest is outside. Where all has, these are the blocks at rest.
        Given limits come first.
        """
        if self.limits is not None:
            return self.limits[:, 0], self.limits[:, 1]
        rest = self.facets.corners + self.case.centroids[self.shown[self.facets.body], None]
        rest_low, rest_high = rest.min(axis=(0, 1)), rest.max(axis=(0, 1))
        room = float((rest_high - rest_low).max())
        low, high = np.maximum(self.reached[0], rest_low - room), np.minimum(self.reached[1], rest_high + room)
        return (low, high) if (low < high).all() else (rest_low, rest_high)

    @cached_property
    def reached(self) -> Array:
        """The lowest and the highest x, y and z of all corners [m], shape (2, 3)."""
        ends = [(corners.min(axis=(0, 1)), corners.max(axis=(0, 1))) for corners in map(self.corners, self._some)]
        return np.array([np.min(ends, axis=(0, 1)), np.max(ends, axis=(0, 1))])

    @property
    def floor(self) -> Array:
        """The lowest and the highest x and y of the ground that is drawn: beyond all corners [m], shape (2, 2)."""
        low, high = self.extent()
        size = float((high - low).max())
        near, far = np.clip(self.reached, low - FARTHEST * size, high + FARTHEST * size)
        return np.array([np.minimum(near, low) - AROUND * size, np.maximum(far, high) + AROUND * size])[:, :2]

    @cached_property
    def across(self) -> Array:
        """Unit vectors to the right and upwards in the picture, shape (2, 3)."""
        azimuth = np.radians(np.asarray(self.camera)[1])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        return np.array([right, np.cross(self.eye, right)])

    @cached_property
    def seen(self) -> Array:
        """Where what the picture has to hold begins and ends, to the right and upwards in it [m], shape (2, 2).

        It is that of the blocks as far as `extent` goes, and with given limits that of their box.
        """
        low, high = self.extent()
        box = np.stack(np.meshgrid(*np.transpose([low, high]), indexing="ij"), axis=-1).reshape(-1, 3)
        held = [box] if self.limits is not None else [np.clip(self.corners(k), low, high) for k in self._some]
        places = [corners.reshape(-1, 3) @ self.across.T for corners in held]
        ends = [(place.min(axis=0), place.max(axis=0)) for place in places]
        return np.array([np.min(ends, axis=(0, 1)), np.max(ends, axis=(0, 1))])

    @property
    def _some(self) -> list[int]:
        """Numbers of at most 100 frames, from the first to the last."""
        numbers: list[int] = np.unique(np.linspace(0, len(self.t) - 1, 100).astype(int)).tolist()
        return numbers

    @cached_property
    def _blocks(self) -> list[SolidBlock]:
        """The blocks that are drawn as bodies."""
        return [self.masonry.polyhedra[i] for i in self.shown]

    @cached_property
    def _parts(self) -> Parts:
        """The convex parts of the blocks that are shown."""
        solids = [self.case.standing.solids[i] for i in self.shown]
        body = np.repeat(np.arange(len(solids)), [len(solid.parts) for solid in solids])
        parts = [part for solid in solids for part in solid.parts]
        normals, edges = evened([unlike_ways(part.normals) for part in parts]), evened([part.edges for part in parts])
        return Parts(body, evened([part.corners for part in parts]), normals, edges)

    def _drawn(self, frame: int, body: Integers, points: Array) -> Array:
        """Points about the centroids of bodies [m], shape (m, n, 3), drawn at a frame."""
        return self.moving.placed_at(frame, self.shown[body], points)
