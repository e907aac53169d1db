"""Bodies of a wall or of masonry in space: their faces, where they stand, and how they move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..geometry.frames import PLANE, SPACE
from ..geometry.hull import Faces, triangles_of
from ..geometry.poses import displaced, rotated, rotations
from ..problem.masonry.case import AnyCase
from ..problem.masonry.masonry import Masonry
from ..problem.wall.rest_geometry import JointFrames, in_space
from ..quantities import Array, Flags, Integers, require_within
from ..scene.tints import colours_of

SUPPORT_INTERVAL = 1e-6
"""Half the time over which the velocity of a support is taken [s]."""
SAME_LEVEL = 1e-3
"""Height up to which fixed bodies lie on one level, over the extent of the free ones [-]."""


class Body(NamedTuple):
    """A body in space at some times.

    Args:
        name: of the block, "wall", "base" or "side".
        corners: about its centroid, at rest [m], shape (corners, 3).
        faces: numbers of the corners of each, counterclockwise as seen from outside.
        rest: its centroid at rest [m], shape (3,).
        colour: red, green and blue, 0 to 1, shape (3,).
        pose: displacement x, y, z of the centroid [m] and unit quaternion, w first, shape (n, 7).
        velocity: of the centroid [m/s], and angular velocity in the axes of the world [rad/s], shape (n, 6).
        fixed: whether it is the ground, or a fixed block.
        moves: whether it is free, or a support that is displaced.
    """

    name: str
    corners: Array
    faces: Faces
    rest: Array
    colour: Array
    pose: Array
    velocity: Array
    fixed: bool
    moves: bool

    @property
    def triangles(self) -> list[tuple[int, int, int]]:
        """Triangles of the faces, each by the numbers of its corners."""
        return triangles_of(self.faces)

    def turned(self, vectors: Array) -> Array:
        """Vectors that are given at rest, shape (m, 3), turned with the body, shape (n, m, 3)."""
        return rotated(vectors, self.pose)

    def placed(self, about: Array) -> Array:
        """Positions of points that are given about the centroid at rest, shape (m, 3) [m], shape (n, m, 3)."""
        return self.rest + self.pose[:, None, :3] + self.turned(about)

    def rate(self, about: Array) -> Array:
        """Velocity of these points [m/s], shape (n, m, 3)."""
        return self.velocity[:, None, :3] + np.cross(self.velocity[:, None, 3:], self.turned(about))


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """Where the bodies of a case are, for forces, ties, pictures and files.

    Args:
        case: of a wall or of masonry.
        t: times [s], shape (n,).
        pose: of a `Response` at these times.
        magnify: factor on displacements, for pictures [-].
    """

    case: AnyCase
    t: Array
    pose: Array
    magnify: float = 1.0

    def pose_of(self, block: int) -> Array:
        """Pose of a block at the times, of a fixed one as its support has moved it, shape (n, 3) or (n, 7)."""
        body, support = self.case.body_of(block), self.case.support_of(block)
        if body is not None:
            return self.pose[:, body]
        count, nq = self.pose.shape[0], self.pose.shape[2]
        pose = np.tile(np.eye(1, nq, 3), (count, 1)) if nq == SPACE.nq else np.zeros((count, nq))
        if support is not None:
            pose[:, : self.case.centroids.shape[1]] = support.at(self.t)
        return pose

    @cached_property
    def poses(self) -> Array:
        """Poses of all blocks, shape (n, blocks, 3) or (n, blocks, 7)."""
        return np.stack([self.pose_of(block) for block in range(len(self.case.centroids))], axis=1)

    @cached_property
    def are_ground(self) -> Flags:
        """Which bodies are ground, shape (bodies,).

        Of the fixed bodies that stay where they are, it is those with the lowest top, unless a free body is below it.
        """
        solids = self.case.rest_geometry.solids
        corners = [solid.corners + solid.rest for solid in solids]
        ends = [(places.min(axis=0), places.max(axis=0)) for places in corners]
        free = np.array([end for end, solid in zip(ends, solids, strict=True) if not solid.fixed])
        stays = [solid.fixed and self.case.support_of(solid.block) is None for solid in solids]
        tops = np.where(stays, [float(high[2]) for _, high in ends], np.inf)
        low, high = free[:, 0].min(axis=0), free[:, 1].max(axis=0)
        return np.asarray(tops <= min(low[2], tops.min()) + SAME_LEVEL * float((high - low).max()))

    def displaced(self, block: int | None, points: Array) -> Array:
        """Displacement from rest of points of a block, or of the ground [m], shape (n, m, d).

        Args:
            block: its number, None for the ground. A fixed block is where its support has moved it.
            points: at rest [m], shape (m, d).
        """
        if block is None:
            return np.zeros((len(self.t), *points.shape))
        return displaced(points - self.case.centroids[block], self.pose_of(block))

    def at(self, numbers: Sequence[int] | Integers) -> BodyMotion:
        """The bodies at some of the times, by their numbers."""
        return replace(self, t=self.t[numbers], pose=self.pose[numbers])

    def between(self, times: Array) -> BodyMotion:
        """The bodies at other times [s]; poses are interpolated linearly between the samples."""
        columns = self.pose.reshape(len(self.t), -1).T
        pose = np.stack([np.interp(times, self.t, column) for column in columns], axis=-1)
        pose = pose.reshape(len(times), *self.pose.shape[1:])
        if pose.shape[2] == SPACE.nq:
            pose[..., 3:] /= np.linalg.norm(pose[..., 3:], axis=-1, keepdims=True)
        return replace(self, t=times, pose=pose)

    def placed(self, block: int | None, points: Array) -> Array:
        """Positions of these points, magnified for pictures [m], shape (n, m, d)."""
        return points + self.magnify * self.displaced(block, points)

    def placed_at(self, number: int, blocks: Sequence[int] | Integers, about: Array) -> Array:
        """Positions at one of the times of points of many blocks, magnified [m], shape (blocks, m, d).

        Args:
            number: of the time.
            blocks: their numbers.
            about: points of each about its centroid at rest [m], shape (blocks, m, d).
        """
        blocks = np.asarray(blocks, dtype=int)
        moved = displaced(about, self.poses[number, blocks])
        return np.asarray(self.case.centroids[blocks, None] + about + self.magnify * moved)

    def joints(self, frames: JointFrames) -> tuple[Array, Array]:
        """Middles [m] and axes of joints, which move with the block below, shapes (n, j, d) and (n, j, d, d)."""
        d, on_body = frames.middle.shape[1], frames.below >= 0
        middle, axes = (np.repeat(part[None], len(self.t), axis=0) for part in (frames.middle, frames.axes))
        block_below = frames.below[on_body]
        turned = rotated(frames.from_body[on_body], self.pose[:, block_below])
        middle[:, on_body] = frames.rest[block_below] + self.pose[:, block_below, :d] + turned[:, :, 0]
        axes[:, on_body] = turned[:, :, 1:]
        for support in self.case.supports:
            middle[:, frames.fixed == frames.blocks.index(support.block)] += support.at(self.t)[:, None]
        return frames.middle + self.magnify * (middle - frames.middle) if self.magnify != 1 else middle, axes


def frames_at(t: Array, fps: float) -> Integers:
    """Numbers of the first sample in each frame, and of the last sample. Their times differ as numbers of 32 bits."""
    rate = require_within("fps", fps, 1.0, 1e4, "1/s")
    first = np.unique(np.floor((t - t[0]) * rate * (1 + 1e-12)), return_index=True)[1]
    numbers = np.unique(np.append(first, len(t) - 1))
    return np.asarray(numbers[np.unique(t[numbers].astype(np.float32), return_index=True)[1]])


def bodies_of(moving: BodyMotion, velocity: Array) -> list[Body]:
    """All bodies, in the order of the blocks, or the wall and what it stands against.

    Args:
        moving: where they are at some times.
        velocity: of a `Response` at these times.
    """
    case, t = moving.case, moving.t
    if velocity.shape[2] == PLANE.nv:
        zero = np.zeros(velocity.shape[:2])
        velocity = np.stack([velocity[..., 0], zero, velocity[..., 1], zero, velocity[..., 2], zero], axis=-1)
    else:
        spin = (rotations(moving.pose) @ velocity[..., 3:, None])[..., 0]
        velocity = np.concatenate([velocity[..., :3], spin], axis=-1)
    bodies = []
    for solid, colour in zip(case.rest_geometry.solids, colours_of(case.rest_geometry), strict=True):
        body, support = case.body_of(solid.block), case.support_of(solid.block)
        pose, rate = np.tile(np.eye(1, 7, 3), (len(t), 1)), np.zeros((len(t), 6))
        if solid.block is not None:
            pose = _poses_in_space(moving.pose_of(solid.block))
        if body is not None:
            rate = velocity[:, body]
        elif support is not None:
            after, before = (in_space(support.at(t + step)) for step in (SUPPORT_INTERVAL, -SUPPORT_INTERVAL))
            rate[:, :3] = (after - before) / (2 * SUPPORT_INTERVAL)
        bodies.append(
            Body(
                name=solid.name,
                corners=solid.corners,
                faces=solid.faces,
                rest=solid.rest,
                colour=colour,
                pose=pose,
                velocity=rate,
                fixed=solid.fixed,
                moves=body is not None or support is not None,
            )
        )
    return bodies


def _poses_in_space(pose: Array) -> Array:
    """Poses of shape (n, 7), of those of the plane too."""
    if pose.shape[1] == SPACE.nq:
        return pose
    turn, zero = 0.5 * pose[:, 2], np.zeros(len(pose))
    return np.column_stack([pose[:, 0], zero, pose[:, 1], np.cos(turn), zero, np.sin(turn), zero])


def without_jumps(quaternions: Array) -> Array:
    """Unit quaternions over time, shape (..., n, 4), each with the sign that is nearer to the one before."""
    along = (quaternions[..., 1:, :] * quaternions[..., :-1, :]).sum(axis=-1, keepdims=True)
    signs = np.cumprod(np.where(along < 0, -1.0, 1.0), axis=-2)
    return np.concatenate([quaternions[..., :1, :], quaternions[..., 1:, :] * signs], axis=-2)


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
