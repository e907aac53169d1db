"""Masonry in a pose: its blocks where they have moved, and the contact lines that press there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....geometry.convex import within
from ....geometry.poses import at_rest, rotations
from ....quantities import Array, Flags, Integers, keep, require_array, require_reals
from ...wall.effect import Anchored, Effect
from ..blocks.compound import AnyBlock, Compound
from ..blocks.joints import Joint
from ..blocks.joints_in_space import SpaceJoint
from ..blocks.polygon import Polygon
from ..blocks.polyhedron import Polyhedron
from ..effects import place_in_world
from ..lines import Lines
from ..masonry import Masonry

DEEPEST_IN_POSE, FARTHEST_IN_POSE = 0.05, 0.01
"""How deep a contact line may lie behind its face, and in space how far a point may lie beside it, over the width of
the joint [-]."""
OFF_UNIT = 1e-6
"""Difference of the length of a quaternion from 1 that is put down to rounding [-]."""


Numbers = int | Sequence[int] | Integers
"""The number of a block, or of each of some."""


def pose_of_all(masonry: Masonry, pose: ArrayLike) -> Array:
    """The pose of all blocks, shape (blocks, nq), from one of all or of the free ones.

    Raises:
        TypeError, ValueError: for another shape, or quaternions that are not of unit length.
    """
    blocks, freedom = len(masonry.blocks), masonry.freedom
    moved = at_rest(blocks, freedom).reshape(blocks, freedom.nq)
    numbers = require_reals("pose", pose, "a pose of all blocks, or of those that are free")
    moving = list(range(blocks)) if numbers.shape == moved.shape else list(masonry.free)
    moved[moving] = require_array("pose", numbers, moved[moving].shape)
    if masonry.in_space:
        length = np.linalg.norm(moved[:, 3:], axis=1)
        if (off := np.abs(length - 1)).max() > OFF_UNIT:
            raise ValueError(f"pose has a quaternion of the length {length[off.argmax()]:g}; the valid one is 1")
    return moved


class Moves(NamedTuple):
    """Where the blocks have moved, also the fixed ones.

    Args:
        turn: matrices of their rotations, shape (blocks, d, d).
        rest, place: their centroids at rest and in the pose [m], shape (blocks, d).
    """

    turn: Array
    rest: Array
    place: Array

    @classmethod
    def from_pose(cls, masonry: Masonry, pose: ArrayLike) -> Moves:
        """Those of a pose of all blocks or of the free ones.

        Raises:
            TypeError, ValueError: as `pose_of_all`, and for a rotation in the plane beyond pi.
        """
        moved = pose_of_all(masonry, pose)
        if not masonry.in_space and (turn := np.abs(moved[:, 2])).max() > np.pi:
            largest = moved[turn.argmax(), 2]
            raise ValueError(
                f"pose has a rotation of {largest:g} rad; the valid range is -pi to pi, and angles are radians"
            )
        d = moved.shape[1] - (4 if masonry.in_space else 1)
        return cls(rotations(moved), masonry.centroids, masonry.centroids + moved[:, :d])

    def at(self, block: Numbers, points: Array) -> Array:
        """Where points of blocks are that are given at rest [m], shape (n, d)."""
        return np.asarray(self.place[block] + self.turned(block, points - self.rest[block]))

    def turned(self, block: Numbers, vectors: Array) -> Array:
        """Vectors of blocks as they are turned from rest, shape (n, d)."""
        return np.asarray((self.turn[block] @ vectors[..., None])[..., 0])

    def block(self, number: int, block: AnyBlock) -> AnyBlock:
        """A block where it has moved."""
        if isinstance(block, Compound):
            return replace(block, parts=tuple(self.part(number, part) for part in block.parts))
        return self.part(number, block)

    def part(self, number: int, part: Polygon | Polyhedron) -> Polygon | Polyhedron:
        """A convex part of a block where it has moved. A body in space keeps its faces, which turn with it: to find
        them anew takes a fifth of a limit curve."""
        corners = np.array(part.vertices)
        places = self.at([number] * len(corners), corners)
        if isinstance(part, Polygon):
            return replace(part, vertices=places)  # type: ignore[arg-type]
        moved = object.__new__(Polyhedron)
        keep(moved, **{entry.name: getattr(part, entry.name) for entry in fields(part)})
        hull = part.hull._replace(normals=self.turned(number, part.normals))
        keep(moved, vertices=tuple(map(tuple, places.tolist())), hull=hull)
        return moved


def posed(masonry: Masonry, pose: ArrayLike, effects: Sequence[Effect] = ()) -> tuple[Masonry, tuple[Effect, ...]]:
    """Masonry whose blocks have moved, with the contact lines that press in the pose, and effects that moved with them.

    Its joints are those at rest. In the plane a block that has slid rests on the corner of the block below, where that
    ends.

    Raises:
        ValueError: for a pose of another shape, blocks that have moved into one another by more than a twentieth of a
            joint, and in space for points that have slid off their face.
    """
    moves = Moves.from_pose(masonry, pose)
    moved = object.__new__(type(masonry))
    keep(moved, **{entry.name: getattr(masonry, entry.name) for entry in fields(masonry)}, table=masonry.table)
    lines = _lines_in_plane(masonry, moves) if not masonry.in_space else _lines_in_space(masonry, moves)
    joints = [_joint(joint, moves) for joint in masonry.joints]
    blocks = tuple(moves.block(i, block) for i, block in enumerate(masonry.blocks))
    keep(moved, blocks=blocks, joints=tuple(joints), lines=lines)
    return moved, tuple(_carried(masonry, effect, moves) for effect in effects)


def _joint(joint: Joint | SpaceJoint, moves: Moves) -> Joint | SpaceJoint:
    """A joint on the block below."""
    if isinstance(joint, Joint):
        start, end = moves.at([joint.below] * 2, np.array([joint.start, joint.end])).tolist()
        return replace(joint, start=tuple(start), end=tuple(end))
    below = [joint.below] * len(joint.vertices)
    places = tuple(map(tuple, moves.at(below, np.array(joint.vertices)).tolist()))
    return replace(joint, vertices=places, direction=tuple(moves.turned(joint.below, joint.normal).tolist()))


def _carried(masonry: Masonry, effect: Effect, moves: Moves) -> Effect:
    """An effect where its block, and that of its anchor, have moved."""
    point = np.array(place_in_world(masonry, effect))
    changes: dict[str, object] = {"at": moves.at(effect.block, point), "height": None}
    if isinstance(effect, Anchored):
        changes["anchor"] = _ends(masonry, effect, moves)[1]
    elif effect.offset:
        changes["offset"] = 0.0
    return replace(effect, **changes)  # type: ignore[type-var]


def _ends(masonry: Masonry, link: Anchored, moves: Moves) -> tuple[Array, Array]:
    """Both ends of a link where its blocks have moved [m]."""
    point = np.array(place_in_world(masonry, link))
    anchor, block = link.anchor_of(point), link.anchor_block
    return moves.at(link.block, point), anchor if block is None else moves.at(block, anchor)


def spans_in(masonry: Masonry, link: Anchored, poses: Array) -> Array:
    """Length of a link in poses of the free blocks [m], shape (n,)."""
    return np.array([math.dist(*_ends(masonry, link, Moves.from_pose(masonry, pose))) for pose in poses])


class MovedLines(NamedTuple):
    """Contact lines in a pose: where they are [m] and the normals of the faces that they meet, shape (m, d) each, and
    the gaps [m], shape (m,)."""

    at: Array
    normal: Array
    gap: Array


def moved_lines(lines: Lines, moves: Moves) -> MovedLines:
    """Contact lines where their blocks have moved."""
    at, normal = moves.at(lines.body, lines.at), moves.turned(lines.face, lines.normal)
    return MovedLines(at, normal, ((at - moves.at(lines.face, lines.at)) * normal).sum(axis=1))


def _lines_in_plane(masonry: Masonry, moves: Moves) -> Lines:
    """The lines that press. Where one has slid past the end of its face, the corner there meets the other face."""
    lines, slack = masonry.lines, masonry.tolerance
    at, normal, gap = moved_lines(lines, moves)
    faces, edges = (_edges(masonry, moves, blocks, lines.joint) for blocks in (lines.face, lines.body))
    along, long = _positions_along(faces, at)
    past = (along < -slack) | (along > long + slack)
    corner = np.where((along < 0)[:, None], faces[:, 0], faces[:, 1])
    outward = -moves.turned(lines.body, lines.normal)
    along, long = _positions_along(edges, corner)
    meets = ~past | ((along > -slack) & (along < long + slack))
    gap = np.where(past, ((corner - at) * outward).sum(axis=1), gap)
    body, face = np.where(past, [lines.face, lines.body], [lines.body, lines.face])
    at, normal = np.where(past[:, None], [corner, outward], [at, normal])
    return _pressed(masonry, lines._replace(body=body, face=face, at=at, normal=normal), np.where(meets, gap, np.inf))


def _edges(masonry: Masonry, moves: Moves, blocks: Integers, joint: Integers) -> Array:
    """Ends of the edges of some blocks that make joints [m], shape (n, 2, 2)."""
    ends = []
    for block, number in zip(blocks.tolist(), joint.tolist(), strict=True):
        below, above = masonry.joints[number].sides
        side = below if block == masonry.joints[number].below else above
        ends.append(moves.at([block] * 2, np.asarray(masonry.blocks[block].sides[side].corners)))
    return np.array(ends)


def _positions_along(edges: Array, at: Array) -> tuple[Array, Array]:
    """How far points lie along edges, and how long these are [m], shape (n,) each."""
    direction = edges[:, 1] - edges[:, 0]
    long = np.hypot(*direction.T)
    return ((at - edges[:, 0]) * direction).sum(axis=1) / long, long


def _lines_in_space(masonry: Masonry, moves: Moves) -> Lines:
    """The points that press."""
    at, normal, gap = moved_lines(masonry.lines, moves)
    back = (
        moves.rest[masonry.lines.face]
        + (np.swapaxes(moves.turn[masonry.lines.face], 1, 2) @ (at - moves.place[masonry.lines.face])[..., None])[
            ..., 0
        ]
    )
    for name, past in _slid_off(masonry, back, gap <= masonry.tolerance):
        raise ValueError(
            f"pose: the joint {name} has slid {past:.3g} m off its face; limit analysis of blocks in space takes poses "
            f"in which joints turn and open, and slide by up to {FARTHEST_IN_POSE:g} of their width past an edge"
        )
    return _pressed(masonry, masonry.lines._replace(at=at, normal=normal), gap)


def _slid_off(masonry: Masonry, back: Array, pressed: Flags) -> Iterator[tuple[str, float]]:
    """Names of joints with a point that presses beside its face, and how far it lies there [m].

    Points are seen from the face, at rest.
    """
    for number, joint in enumerate(masonry.space_joints):
        for block, side in zip((joint.below, joint.above), joint.sides, strict=True):
            presses = (masonry.lines.joint == number) & (masonry.lines.face == block) & pressed
            face = (np.asarray(masonry.blocks[block].sides[side].corners) - joint.outline[0]) @ joint.axes.T
            flat = (back[presses] - joint.outline[0]) @ joint.axes.T
            past = -within(face if block == joint.below else face[::-1], flat).min(initial=0.0)
            if past > FARTHEST_IN_POSE * joint.width:
                yield joint.name, float(past)


def _pressed(masonry: Masonry, lines: Lines, gap: Array) -> Lines:
    """The lines whose gap is closed [m]."""
    widths = np.array([joint.width for joint in masonry.joints])[lines.joint]
    deepest = int((gap / widths).argmin())
    if gap[deepest] < -DEEPEST_IN_POSE * widths[deepest]:
        name = masonry.joints[lines.joint[deepest]].name
        raise ValueError(
            f"pose: the blocks of the joint {name} are {-gap[deepest]:.3g} m inside one another; the valid range is up "
            f"to {DEEPEST_IN_POSE:g} of its width"
        )
    return Lines(*(values[gap <= masonry.tolerance] for values in lines))  # type: ignore[arg-type]
