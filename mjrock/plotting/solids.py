"""Blocks in space in motion, as a picture needs them: their faces, and where they are drawn and seen from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from heapq import heapify, heappop, heappush
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.frames import SPACE
from ..geometry.poses import displaced, rotations
from ..problem.masonry.blocks.compound import Compound, SolidBlock
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Integers, keep, require_array, require_within
from ..result.bodies import Moving
from ..result.response import Response
from .bodies import interpolated, required_limits

TINTS = ("#e3b79a", "#d39f7e", "#ecc9b0", "#c99272", "#ddab8b", "#efd3bd", "#cf9a80")
"""Colours of blocks, which take turns so that neighbours are told apart."""


class Facets(NamedTuple):
    """The faces of bodies: corners about the centroid of the body, at rest [m], shape (faces, most, 3), of which a face
    with few repeats the last one; the number of the body, that of its convex part, counted over all bodies, and that of
    the corners, shape (faces,) each."""

    corners: Array
    body: Integers
    part: Integers
    counts: Integers


@dataclass(frozen=True, eq=False)
class Solids:
    """Masonry in space and its motion.

    Args:
        case: of the masonry, for its blocks, the masses that are added to them, and its supports.
        t: times [s], shape (n,), increasing.
        poses: displacement of each centroid from rest [m] and unit quaternion, w first, of each block that is not
            fixed, shape (n, bodies, 7).
        magnify: factor on the displacement of every point [-], 0 to 1e6; 1 is true to scale.
        camera: elevation and azimuth that the blocks are seen from [deg], -90 to 90 and -360 to 360; None is (18, 35).
        limits: lowest and highest x, y and z of the picture [m], three pairs; None shows the blocks, see `extent`.

    Raises:
        ValueError: for poses of another shape, or a value outside its range.
    """

    case: MasonryCase
    t: Array
    poses: Array
    magnify: float = 1.0
    camera: Sequence[float] | None = None
    limits: Array | None = None

    def __post_init__(self) -> None:
        elevation, azimuth = require_array("camera", (18.0, 35.0) if self.camera is None else self.camera, (2,))
        elevation = require_within("elevation of the camera", elevation, -90.0, 90.0, "degrees")
        keep(
            self,
            camera=(elevation, require_within("azimuth of the camera", azimuth, -360.0, 360.0, "degrees")),
            limits=required_limits(self.limits, "xyz"),
            magnify=require_within("magnify", self.magnify, 0.0, 1e6),
            poses=require_array("poses", self.poses, (len(self.t), len(self.masonry.free), SPACE.nq)),
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
        return cls(response.of_masonry, response.t, response.pose, magnify, camera, limits)  # type: ignore[arg-type]

    @property
    def masonry(self) -> Masonry:
        """The blocks."""
        return self.case.masonry

    @property
    def moving(self) -> Moving:
        """Where the bodies are drawn."""
        return Moving(self.case, self.t, self.poses, self.magnify)

    def at(self, times: Array) -> Solids:
        """The same blocks at other times, their poses interpolated linearly."""
        poses = interpolated(times, self.t, self.poses)
        poses[..., 3:] /= np.linalg.norm(poses[..., 3:], axis=-1, keepdims=True)
        return replace(self, t=times, poses=poses)

    @cached_property
    def eye(self) -> Array:
        """Unit vector to the camera, shape (3,)."""
        elevation, azimuth = np.radians(np.asarray(self.camera))
        level = np.cos(elevation)
        return np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])

    @cached_property
    def shown(self) -> tuple[int, ...]:
        """Numbers of the blocks that are drawn as bodies: all but the ground, fixed ones too."""
        return tuple(i for i, is_ground in enumerate(self._are_ground) if not is_ground)

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
    def colours(self) -> list[str]:
        """Colour of each facet, grey of fixed blocks."""
        tints = ["#bdbdbd" if self.masonry.blocks[i].fixed else TINTS[i % len(TINTS)] for i in self.shown]
        return [tints[body] for body in self.facets.body]

    @cached_property
    def rests(self) -> Array:
        """Centroid of each block that is shown, with its added masses, at rest [m], shape (shown, 3)."""
        return self.case.centroids[list(self.shown)]

    @cached_property
    def facets(self) -> Facets:
        """The faces of the blocks that are shown."""
        blocks = self._blocks
        counts = np.array([len(side.corners) for block in blocks for side in block.sides])
        body = np.repeat(np.arange(len(blocks)), [len(block.sides) for block in blocks])
        part = self._first[body] + np.array([side.parts[0] for block in blocks for side in block.sides])
        corners = np.empty((len(counts), counts.max(), 3))
        bodies = zip(blocks, self.rests, strict=True)
        about = [side.corners - rest for block, rest in bodies for side in block.sides]
        for row, face in zip(corners, about, strict=True):
            row[: len(face)], row[len(face) :] = face, face[-1]
        return Facets(corners, body, part, counts)

    def corners(self, frame: int) -> Array:
        """Where the corners of all facets are drawn at a frame [m], shape (faces, most, 3)."""
        return self._drawn(frame, self.facets.body, self.facets.corners)

    def order(self, frame: int) -> Integers:
        """The convex parts of all bodies from the farthest to the nearest, shape (parts,).

        Of two that lie on each other the one on the far side comes first. Among those that hide no other the one with
        the farthest centroid is next.
        """
        bodies = np.repeat(np.arange(len(self.shown)), np.diff(self._first))
        poses, rests = self._posed(frame)[bodies], self.rests[bodies]
        turned = rotations(poses)
        arms = np.array([part.centroid for block in self._blocks for part in block.parts]) - rests
        nearness = (rests + poses[:, :3] + (turned @ arms[:, :, None])[:, :, 0]) @ self.eye
        waits, hidden = np.zeros(len(nearness), dtype=int), [list[int]() for _ in nearness]
        for below, above, normal in self._pairs:
            behind, before = (below, above) if turned[below] @ normal @ self.eye > 0 else (above, below)
            hidden[behind].append(before)
            waits[before] += 1
        ready = [(float(nearness[i]), int(i)) for i in np.flatnonzero(waits == 0)]
        heapify(ready)
        left, order = set(range(len(nearness))), []
        while left:
            part = heappop(ready)[1] if ready else min(left, key=nearness.__getitem__)  # a ring of joints is cut there
            if part not in left:
                continue
            left.discard(part)
            order.append(part)
            for before in hidden[part]:
                waits[before] -= 1
                if waits[before] == 0:
                    heappush(ready, (float(nearness[before]), before))
        return np.array(order)

    def extent(self) -> tuple[Array, Array]:
        """The lowest and the highest x, y and z that the blocks reach in the picture [m], shape (3,) each.

        What goes farther than one extent of the blocks at rest is outside. Given limits come first.
        """
        if self.limits is not None:
            return self.limits[:, 0], self.limits[:, 1]
        rest = self.facets.corners + self.rests[self.facets.body, None]
        low, high = rest.min(axis=(0, 1)), rest.max(axis=(0, 1))
        room = float((high - low).max())
        some = np.unique(np.linspace(0, len(self.t) - 1, 100).astype(int))
        corners = np.concatenate([self.corners(int(frame)).reshape(-1, 3) for frame in some])
        return np.maximum(corners.min(axis=0), low - room), np.minimum(corners.max(axis=0), high + room)

    @cached_property
    def _blocks(self) -> list[SolidBlock]:
        """The blocks that are drawn as bodies."""
        return [self.masonry.polyhedra[i] for i in self.shown]

    @cached_property
    def _first(self) -> Integers:
        """Number of the first convex part of each body that is shown, and of all parts, shape (shown + 1,)."""
        return np.cumsum([0, *(len(block.parts) for block in self._blocks)])

    @cached_property
    def _pairs(self) -> list[tuple[int, int, Array]]:
        """Convex parts below and above each joint between two that are shown, and its normal at rest."""
        pairs = []
        body = {block: i for i, block in enumerate(self.shown)}
        for joint in self.masonry.space_joints:
            if joint.below in body and joint.above in body:
                ends = zip((body[joint.below], body[joint.above]), joint.sides, strict=True)
                lower, upper = ([self._first[i] + k for k in self._blocks[i].sides[side].parts] for i, side in ends)
                pairs += [(below, above, joint.normal) for below in lower for above in upper]
        for first, block in zip(self._first, self._blocks, strict=False):
            joined = block.joined if isinstance(block, Compound) else ()
            pairs += [(first + joint.below, first + joint.above, joint.normal) for joint in joined]
        return pairs

    def _posed(self, frame: int) -> Array:
        """Pose of each block that is shown at a frame, shape (shown, 7)."""
        poses = np.tile(np.eye(1, SPACE.nq, 3), (len(self.shown), 1))
        poses[np.isin(self.shown, self.masonry.free)] = self.poses[frame]
        for body, support in enumerate(map(self.case.support_of, self.shown)):
            if support is not None:
                poses[body, :3] = support.at(self.t[frame : frame + 1])
        return poses

    def _drawn(self, frame: int, body: Integers, points: Array) -> Array:
        """Points about the centroids of bodies [m], shape (m, n, 3), drawn at a frame."""
        return self.rests[body, None] + points + self.magnify * displaced(points, self._posed(frame)[body])
