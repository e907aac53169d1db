"""Blocks in space in motion, as a picture needs them: their faces, and where they are drawn and seen from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike

from ..problem.masonry.blocks.compound import SolidBlock
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Integers, keep, require_array, require_within
from ..result.bodies import Moving
from ..result.response import Response
from ..scene.tints import colours_of
from .bodies import evened, required_limits
from .depths import Ground, Surfaces

AROUND, FARTHEST = 0.6, 3.0
"""How far the ground is drawn beyond all corners, and the farthest corners that count for it, over the extent [-]."""
SUNK = 0.05
"""How far blocks may lie below the ground and it is still drawn, over the extent [-]."""
PLANE_ROUNDING = 1e-6
"""Part of normals and of the extent to which two faces lie in one plane [-]."""
SUN = np.array([-0.75, 0.55, 1.0])
"""Where the sun stands: to the right of the camera, towards it, and upwards."""


class Facets(NamedTuple):
    """The faces of bodies: corners about the centroid of the body, at rest [m], shape (faces, most, 3), of which a face
    with few repeats the last one; and the numbers of the block and of the plane piece of it, shape (faces,) each."""

    corners: Array
    block: Integers
    plane: Integers


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
    def _grounds(self) -> list[SolidBlock]:
        """The fixed blocks below all that move, which are not moved themselves."""
        return [block for block, is_ground in zip(self.masonry.polyhedra, self._are_ground, strict=True) if is_ground]

    @cached_property
    def _are_ground(self) -> list[bool]:
        blocks = self.masonry.blocks
        lowest = min(float(blocks[i].corners[:, 2].min()) for i in self.masonry.free) + 1e-3
        below = [block.fixed and bool(block.corners[:, 2].max() <= lowest) for block in blocks]
        moved = {support.block for support in self.case.supports}
        return [low and name not in moved for low, name in zip(below, self.masonry.names, strict=True)]

    @cached_property
    def facets(self) -> Facets:
        """The faces of the blocks that are shown."""
        return self._faces_of(self.shown)

    def _faces_of(self, blocks: Integers) -> Facets:
        """The faces of some blocks."""
        parts = [(block, part) for block in blocks.tolist() for part in self.case.standing.solids[block].parts]
        block = np.repeat([block for block, _ in parts], [len(part.faces) for _, part in parts])
        corners = evened([part.corners[list(face)] for _, part in parts for face in part.faces])
        normals = np.concatenate([part.normals for _, part in parts])
        offsets = np.concatenate([part.offsets for _, part in parts])
        planes = np.column_stack([block * PLANE_ROUNDING, normals, offsets / np.abs(corners).max()])
        planes = np.round(planes / PLANE_ROUNDING)
        return Facets(corners, block, np.unique(planes, axis=0, return_inverse=True)[1].ravel())

    def corners(self, frame: int) -> Array:
        """Where the corners of all facets are drawn at a frame [m], shape (faces, most, 3)."""
        return self.moving.placed_at(frame, self.facets.block, self.facets.corners)

    def stage(self, frame: int) -> tuple[Surfaces, Array, Ground | None]:
        """What is seen at a frame, a unit vector to the sun, which stands to the left of the camera, and the ground."""
        (right, _), azimuth = self.across, np.radians(np.asarray(self.camera)[1])
        sun = SUN @ np.array([right, (np.cos(azimuth), np.sin(azimuth), 0.0), (0.0, 0.0, 1.0)])
        corners, block, plane = self._staged
        surfaces = Surfaces(self.moving.placed_at(frame, block, corners), plane, colours_of(self.case.standing)[block])
        return surfaces, sun / np.linalg.norm(sun), self.ground

    @cached_property
    def _staged(self) -> Facets:
        """The faces of the blocks that are shown, and those of the ground where blocks fall past its edge."""
        return self.facets if self.ground is not None else self._faces_of(np.arange(len(self.masonry.blocks)))

    @cached_property
    def ground(self) -> Ground | None:
        """The ground, which reaches beyond all corners; None where there is none, or blocks fall past its edge."""
        tops = [float(block.corners[:, 2].max()) for block in self._grounds]
        low, high = self.extent()
        size = float((high - low).max())
        if not tops or self.reached[0, 2] < max(tops) - SUNK * size:
            return None
        near, far = np.clip(self.reached, low - FARTHEST * size, high + FARTHEST * size)[:, :2]
        low, high = np.minimum(near, low[:2]), np.maximum(far, high[:2])
        return Ground(max(tops), 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low)) + AROUND * size)

    def extent(self) -> tuple[Array, Array]:
        """The lowest and the highest x, y and z that the blocks reach in the picture [m], shape (3,) each.

        What goes farther than one extent of the blocks at rest is outside. Where all has, these are the blocks at rest.
        Given limits come first.
        """
        if self.limits is not None:
            return self.limits[:, 0], self.limits[:, 1]
        rest = self.facets.corners + self.case.centroids[self.facets.block, None]
        rest_low, rest_high = rest.min(axis=(0, 1)), rest.max(axis=(0, 1))
        room = float((rest_high - rest_low).max())
        low, high = np.maximum(self.reached[0], rest_low - room), np.minimum(self.reached[1], rest_high + room)
        return (low, high) if (low < high).all() else (rest_low, rest_high)

    @cached_property
    def reached(self) -> Array:
        """The lowest and the highest x, y and z of all corners [m], shape (2, 3)."""
        ends = [(corners.min(axis=(0, 1)), corners.max(axis=(0, 1))) for corners in map(self.corners, self._some)]
        return np.array([np.min(ends, axis=(0, 1)), np.max(ends, axis=(0, 1))])

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
    def extent_seen(self) -> Array:
        """Width and height of what the picture has to hold [m], shape (2,)."""
        return np.asarray(np.ptp(self.seen, axis=0))

    @property
    def _some(self) -> list[int]:
        """Numbers of at most 100 frames, from the first to the last."""
        numbers: list[int] = np.unique(np.linspace(0, len(self.t) - 1, 100).astype(int)).tolist()
        return numbers
