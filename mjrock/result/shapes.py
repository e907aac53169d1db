"""Bodies and joints as surfaces in space, at rest and as a run moves them: what other programs are given."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..geometry.poses import rotations
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import laden
from ..problem.masonry.joints import Joint
from ..problem.masonry.joints_in_space import SpaceJoint
from ..problem.masonry.polygon import Polygon
from ..problem.masonry.polyhedron import Polyhedron
from ..problem.wall.block import Block
from ..problem.wall.case import Case
from ..quantities import Array, Integers, require_within
from .response import Response

Faces = tuple[tuple[int, ...], ...]
FLOOR = 0.05
"""Thickness that the ground and the side stop of a wall are drawn with, over its height [-]."""


class Shape(NamedTuple):
    """A body.

    Args:
        name: of the block, or "wall", "ground" and "side stop".
        corners: about the centroid at rest [m], shape (n, 3).
        faces: numbers of the corners of each face, counterclockwise from outside.
        rest: the centroid at rest [m], shape (3,).
        fixed: whether it belongs to the ground.
    """

    name: str
    corners: Array
    faces: Faces
    rest: Array
    fixed: bool

    @property
    def triangles(self) -> Integers:
        """The faces as triangles, shape (m, 3)."""
        return np.array([(face[0], *face[i : i + 2]) for face in self.faces for i in range(1, len(face) - 1)])


def shapes_of(case: Case | MasonryCase) -> list[Shape]:
    """The blocks of masonry in their order, or a wall, the ground that it stands on and its side stop.

    A block of the plane reaches over its length along y. Openings of a wall are left out.
    """
    if isinstance(case, Case):
        return _of_wall(case)
    rests = laden(case.masonry, case.effects)[1]
    return [
        _of_block(block, name, rest)
        for block, name, rest in zip(case.masonry.blocks, case.masonry.names, rests, strict=True)
    ]


def in_space(points: Array, y: float = 0.0) -> Array:
    """Points of the plane, or of space as they are, shape (..., 3)."""
    return points if points.shape[-1] == 3 else np.insert(points, 1, y, axis=-1)


def _of_block(block: Polygon | Polyhedron, name: str, rest: Array) -> Shape:
    if isinstance(block, Polyhedron):
        return Shape(name, block.corners - rest, block.faces, rest, block.fixed)
    n, half = len(block.corners), 0.5 * block.length
    corners = np.concatenate([in_space(block.corners - rest, y) for y in (-half, half)])
    sides = ((i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n))
    ends = tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1))
    return Shape(name, corners, (*ends, *((a, d, c, b) for a, b, c, d in sides)), in_space(rest), block.fixed)


def _of_wall(case: Case) -> list[Shape]:
    wall: Block = case.wall
    rest = np.array([wall.centroid_offset, 0.0, wall.centroid_height])
    outer = wall.outline[1:-1] + rest[[0, 2]]
    heights = np.sort(np.append(outer[:, 1], wall.front.eaves)) if wall.gable else outer[:, 1]
    x = np.interp(heights, outer[:, 1], outer[:, 0]) if wall.gable else outer[:, 0]
    half = 0.5 * wall.front.long(heights)
    rings = [
        ((-wall.b, -y, z), (w, -y, z), (w, y, z), (-wall.b, y, z)) for w, y, z in zip(x, half, heights, strict=True)
    ]
    top = 4 * (len(rings) - 1)
    sides = [(i + j, i + (j + 1) % 4, i + 4 + (j + 1) % 4, i + 4 + j) for i in range(0, top, 4) for j in range(4)]
    faces = ((3, 2, 1, 0), *sides, tuple(range(top, top + 4)))
    shapes = [Shape("wall", np.reshape(rings, (-1, 3)) - rest, faces, rest, False)]
    thick, far, long = FLOOR * 2 * wall.h, 2 * wall.h, wall.length
    boxes = {"ground": ((2 * far, 1.5 * long, thick), (0.0, 0.0, -0.5 * thick))}
    if case.stop_top is not None:
        boxes["side stop"] = (thick, long, case.stop_top), (-wall.b - 0.5 * thick, 0.0, 0.5 * case.stop_top)
    return shapes + [_of_block(Polyhedron.box(*box, fixed=True), name, np.array(box[1])) for name, box in boxes.items()]


@dataclass(frozen=True, eq=False)
class MovingShapes:
    """The shapes of a response, at some of its samples.

    Args:
        response: the run.
        samples: numbers of the samples, shape (n,).
    """

    response: Response
    samples: Integers

    @classmethod
    def of(cls, response: Response, fps: float) -> MovingShapes:
        """The samples next to so many times a second [1/s], 1 to 10000, and the last one."""
        fps, t = require_within("fps", fps, 1.0, 1e4, "1/s"), response.t
        times = np.arange(t[0], t[-1], 1 / fps)
        return cls(response, np.unique([*np.searchsorted(t, times * (1 - 1e-12)), len(t) - 1]))

    @property
    def t(self) -> Array:
        """Times of the samples [s], shape (n,)."""
        return self.response.t[self.samples]

    @cached_property
    def shapes(self) -> list[Shape]:
        """The bodies, fixed ones too."""
        return shapes_of(self.response.case)

    @cached_property
    def motion(self) -> tuple[Array, Array]:
        """Displacement of each centroid from rest [m] and unit quaternion of its rotation, w first.

        The shapes are (n, shapes, 3) and (n, shapes, 4), in the order of `shapes`.
        """
        case, pose = self.response.case, self.response.pose[self.samples]
        shapes = self.shapes
        moved, turned = np.zeros((len(pose), len(shapes), 3)), np.zeros((len(pose), len(shapes), 4))
        turned[..., 0] = 1.0
        free = [i for i, shape in enumerate(shapes) if not shape.fixed]
        if pose.shape[2] == 7:
            moved[:, free], turned[:, free] = pose[..., :3], pose[..., 3:]
        else:
            moved[:, free] = in_space(pose[..., :2])
            turned[:, free, 0], turned[:, free, 2] = np.cos(0.5 * pose[..., 2]), np.sin(0.5 * pose[..., 2])
        for support in getattr(case, "supports", ()):
            moved[:, case.masonry.names.index(support.block)] = in_space(support.at(self.t))
        return moved, turned

    def placed(self, body: int, points: Array) -> Array:
        """Where points of a body, given at rest [m], shape (m, 3), are at the samples [m], shape (n, m, 3)."""
        moved, turned = self.motion
        rest = self.shapes[body].rest
        turn = rotations(np.concatenate([moved[:, body], turned[:, body]], axis=1))
        return np.asarray((points - rest) @ np.swapaxes(turn, 1, 2) + (rest + moved[:, body])[:, None])


def outline_of(joint: Joint | SpaceJoint) -> Array:
    """Corners of a joint at rest, counterclockwise about its normal [m], shape (n, 3)."""
    if isinstance(joint, SpaceJoint):
        return joint.outline
    ends = np.array([joint.end, joint.start])
    return np.concatenate([in_space(ends, -0.5 * joint.length), in_space(ends[::-1], 0.5 * joint.length)])
