"""Bodies of a wall or of masonry in space: their faces, where they stand, and how they move."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..geometry.frames import PLANE
from ..geometry.hull import Faces, prism
from ..geometry.poses import rotations
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.compound import AnyBlock
from ..problem.masonry.effects import laden
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.polygon import Polygon
from ..problem.wall.case import Case
from ..quantities import Array, Integers, require_within

SHORT = 1e-6
"""Half the time over which the velocity of a support is taken [s]."""


class Body(NamedTuple):
    """A body at some times.

    Args:
        name: of the block, "wall", "base" or "side".
        corners: about its centroid, at rest [m], shape (corners, 3).
        faces: numbers of the corners of each, counterclockwise as seen from outside.
        rest: its centroid at rest [m], shape (3,).
        pose: displacement x, y, z of the centroid [m] and unit quaternion, w first, shape (n, 7).
        velocity: of the centroid [m/s], and angular velocity in the axes of the world [rad/s], shape (n, 6).
        fixed: whether it is the ground, or a fixed block.
        moves: whether it is free, or a support that is displaced.
    """

    name: str
    corners: Array
    faces: Faces
    rest: Array
    pose: Array
    velocity: Array
    fixed: bool
    moves: bool

    @property
    def triangles(self) -> list[tuple[int, ...]]:
        """Numbers of the corners of triangles that make up the faces."""
        return [(face[0], *pair) for face in self.faces for pair in pairwise(face[1:])]

    def turned(self, vectors: Array) -> Array:
        """Vectors of the body at rest, shape (m, 3), as they are turned, shape (n, m, 3)."""
        return np.asarray(vectors @ rotations(self.pose).swapaxes(1, 2))

    def placed(self, about: Array) -> Array:
        """Where points are that are given about the centroid at rest [m], shape (m, 3), shape (n, m, 3)."""
        return self.rest + self.pose[:, None, :3] + self.turned(about)

    def rate(self, about: Array) -> Array:
        """Velocity of these points [m/s], shape (n, m, 3)."""
        return self.velocity[:, None, :3] + np.cross(self.velocity[:, None, 3:], self.turned(about))


def frames_at(t: Array, fps: float) -> Integers:
    """Numbers of the samples that are the first in each frame, and of the last one. Their times differ as 32 bits."""
    rate = require_within("fps", fps, 1.0, 1e4, "1/s")
    first = np.unique(np.floor((t - t[0]) * rate * (1 + 1e-12)), return_index=True)[1]
    kept = np.unique(np.append(first, len(t) - 1))
    return np.asarray(kept[np.unique(t[kept].astype(np.float32), return_index=True)[1]])


def in_space(vectors: Array) -> Array:
    """Vectors of the plane x, z with y = 0, shape (..., 3); those of space as they are."""
    return vectors if vectors.shape[-1] == 3 else np.insert(vectors, 1, 0.0, axis=-1)


def bodies_of(case: Case | MasonryCase, t: Array, pose: Array, velocity: Array) -> list[Body]:
    """All bodies, in the order of the blocks, or the wall and what it stands against.

    Args:
        case: what was asked.
        t: times [s], shape (n,).
        pose, velocity: of a `Response` at these times.
    """
    if pose.shape[2] == PLANE.nq:
        turn, zero = 0.5 * pose[..., 2], np.zeros(pose.shape[:2])
        parts = pose[..., 0], zero, pose[..., 1], np.cos(turn), zero, np.sin(turn), zero
        pose = np.stack(parts, axis=-1)
        velocity = np.stack([velocity[..., 0], zero, velocity[..., 1], zero, velocity[..., 2], zero], axis=-1)
    else:
        spin = (rotations(pose) @ velocity[..., 3:, None])[..., 0]
        velocity = np.concatenate([velocity[..., :3], spin], axis=-1)
    still = np.tile(np.eye(1, 7, 3), (len(t), 1)), np.zeros((len(t), 6))
    if isinstance(case, Case):
        return _wall(case, pose[:, 0], velocity[:, 0], still)
    masonry, bodies = case.masonry, []
    moved = {support.block: support for support in case.supports}
    for i, (name, block, rest) in enumerate(
        zip(masonry.names, masonry.blocks, in_space(laden(masonry, case.effects)[1]), strict=True)
    ):
        corners, faces = faces_of(block)
        where, rate = still
        if not block.fixed:
            where, rate = (part[:, masonry.free.index(i)] for part in (pose, velocity))
        elif name in moved:
            where, rate, at = where.copy(), rate.copy(), moved[name].at
            where[:, :3], rate[:, :3] = in_space(at(t)), in_space(at(t + SHORT) - at(t - SHORT)) / (2 * SHORT)
        moves = not block.fixed or name in moved
        bodies.append(Body(name, corners - rest, faces, rest, where, rate, block.fixed, moves))
    return bodies


def faces_of(block: AnyBlock) -> tuple[Array, Faces]:
    """Corners of a block in space [m], shape (corners, 3), and its faces: those of each of its convex parts."""
    corners, faces = list[Array](), list[tuple[int, ...]]()
    for part in block.parts:
        before = sum(map(len, corners))
        own, rings = prism(part.corners, part.length) if isinstance(part, Polygon) else (part.corners, part.faces)
        corners.append(own)
        faces += [tuple(before + i for i in ring) for ring in rings]
    return np.concatenate(corners), tuple(faces)


def _wall(case: Case, pose: Array, velocity: Array, still: tuple[Array, Array]) -> list[Body]:
    """The wall without its openings, a slab below it, and where it has a side stop one beside it."""
    wall, top = case.wall, case.stop_top
    b, length, rest = wall.b, wall.length, np.array([wall.centroid_offset, 0.0, wall.centroid_height])
    outer = wall.outline[1:-1]
    if wall.gable is not None:
        z = np.sort(np.append(outer[:, 1], wall.front.eaves - rest[2]))
        outer = np.column_stack([np.interp(z, outer[:, 1], outer[:, 0]), z])
    inner = np.column_stack([np.full(len(outer), wall.outline[0, 0]), outer[:, 1]])
    corners, n = prism(np.concatenate([outer, inner[::-1]]), length)[0], 2 * len(outer)
    corners[:, 1] *= wall.front.long(corners[:, 2] + rest[2]) / length
    ends = [(i, i + 1, n - 2 - i, n - 1 - i) for i in range(len(outer) - 1)]  # the outline of a profile is not convex
    rim = [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]
    faces = (*ends, *(tuple(n + i for i in end[::-1]) for end in ends), *rim)
    bodies = [Body("wall", corners, faces, rest, pose, velocity, False, True)]
    slabs = {"base": (-3 * b, 3 * b, -b, 0.0)} | ({} if top is None else {"side": (-3 * b, -b, 0.0, top)})
    for name, (left, right, low, high) in slabs.items():
        solid = prism(np.array([(left, low), (right, low), (right, high), (left, high)]), length)
        bodies.append(Body(name, *solid, np.zeros(3), *still, True, False))
    return bodies


def openings(masonry: Masonry, bodies: list[Body]) -> Array:
    """Largest gap of the contact lines of each joint at the times of the bodies [m], shape (n, joints), 0 where all
    press."""
    lines, at = masonry.lines, in_space(masonry.lines.at)
    largest = np.zeros((len(bodies[0].pose), len(masonry.joints)))
    for i, normal in enumerate(in_space(lines.normal)):
        above, below, joint = bodies[lines.body[i]], bodies[lines.face[i]], lines.joint[i]
        apart = above.placed((at[i] - above.rest)[None]) - below.placed((at[i] - below.rest)[None])
        gap = (apart * below.turned(normal[None])).sum(axis=2)[:, 0]
        largest[:, joint] = np.maximum(largest[:, joint], gap)
    return largest
