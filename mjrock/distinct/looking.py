"""Looking at blocks and lines: where and how fast blocks are, which joints hold no longer, and what springs hold."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.vectors import components, dot, minus, plus, put, spin_components, vector
from ..problem.masonry.joint_law import stored
from ..quantities import GRAVITY, Array, Flags, Integers
from .contact import meeting
from .finder import Found
from .handover import Blocks
from .solids import Poses
from .system import System
from .turning import rotation_change, take_inverse_inertia, take_turn

LOOK, SOONEST = 5e-3, 5e-4
"""Longest and shortest time between two looks [s]."""
FALL = 0.5 * GRAVITY * LOOK**2
"""What a block falls by from one look to the next [m]."""
PASSED = 0.02
"""Way that a pair may make between two looks, over the size of the smaller block [-]."""
SURE = 2.0
"""Way within which places are kept until the next look, over that which speeds alone make [-]."""
NEAR = 1e-3
"""Distance at which blocks are near each other, and way up to which no block is looked at, over their size [-]. Blocks
without a common joint that are so near at rest touch at edges or corners, and are looked at later, from `PASSED` on."""
AXES = np.eye(3)
"""Unit vectors."""


class Motion(NamedTuple):
    """Where all blocks are, and how fast.

    Args:
        poses: where they are.
        velocity: of their centroids [m/s], shape (blocks, d).
        about: the largest velocity of a corner about the centroid of its block [m/s], shape (blocks,).
    """

    poses: Poses
    velocity: Array
    about: Array


class Seen(NamedTuple):
    """What looks have seen of the blocks, which a look brings up to date.

    Args:
        watched: whether each block is looked at, shape (blocks,).
        poses: where it was when it was last taken to have moved.
        moves: how often it has, shape (blocks,).
    """

    watched: Flags
    poses: Poses
    moves: Integers


class Reach(NamedTuple):
    """How far blocks may go.

    Args:
        start: where they stood.
        limits: how far each may be from there before it is looked at [m], shape (blocks,).
        stay: by how much each may move while a find of it stays valid [m], shape (blocks,).
    """

    start: Poses
    limits: Array
    stay: Array


class Wear(NamedTuple):
    """How far joints have worn.

    Args:
        pairs: number of the pair of blocks of each line of a joint, shape (m,).
        slip, gap: largest way along the joints of each pair, and least opening [m], shape (pairs,).
        left: slip or gap from which on a pair has left its joints [m], shape (pairs,).
    """

    pairs: Integers
    slip: Array
    gap: Array
    left: Array


@compiled
def take_motion(system: System, blocks: Blocks, motion: Motion) -> None:
    """Write where the blocks are that move, and how fast, and take the inertia of the bodies there."""
    write_motion(system, blocks, motion, system.axes)


@inlined
def write_motion(system: System, blocks: Blocks, motion: Motion, axes: tuple[int, ...]) -> None:
    """`take_motion`, in the plane or in space."""
    poses, supports = motion.poses, system.supports
    for b in range(len(blocks.free)):
        body, block = system.bodies[b], blocks.free[b]
        take_turn(body, axes)
        take_inverse_inertia(body, axes)
        for i in range(len(axes)):
            put(poses.change[block][:, i], rotation_change(body, vector(AXES, i, axes)))
        spin = spin_components(body.spin, axes)
        put(poses.moved[block], components(body.place, axes))
        put(motion.velocity[block], components(body.velocity, axes))
        motion.about[block] = math.sqrt(dot(spin, spin)) * blocks.sizes[block]
    for block in range(len(blocks.support)):
        if blocks.support[block] >= 0:
            put(poses.moved[block], vector(supports.moved, blocks.support[block], axes))
            put(motion.velocity[block], vector(supports.moving, blocks.support[block], axes))


@inlined
def far(poses: Poses, other: Poses, block: int, size: float) -> float:
    """How far a corner of a block may be from where it is in other poses [m]."""
    way = turned = 0.0
    for i in range(poses.moved.shape[1]):
        way += (poses.moved[block, i] - other.moved[block, i]) ** 2
        for j in range(poses.moved.shape[1]):
            turned += (poses.change[block, i, j] - other.change[block, i, j]) ** 2
    return math.sqrt(way) + math.sqrt(turned) * size


@compiled
def watch(motion: Motion, sizes: Array, reach: Reach, seen: Seen, left: Flags, ahead: Array) -> bool:
    """Bring up to date which blocks are looked at, and which have moved.

    Args:
        motion, sizes: of the blocks.
        reach: how far they may go.
        seen: what looks before have seen.
        left: blocks that have left a joint, shape (blocks,).
        ahead: room for how far each may go until the next look [m], shape (blocks,).

    Returns:
        Whether a block is looked at, and one has moved.
    """
    some = moved = False
    for block in range(len(sizes)):
        speed = 0.0
        for i in range(motion.velocity.shape[1]):
            speed += motion.velocity[block, i] ** 2
        ahead[block] = LOOK * (math.sqrt(speed) + motion.about[block])
        watched, way = seen.watched[block], far(motion.poses, reach.start, block, sizes[block]) + ahead[block]
        seen.watched[block] = watched or left[block] or way > reach.limits[block]
        if seen.watched[block] != watched or far(motion.poses, seen.poses, block, sizes[block]) > reach.stay[block]:
            moved = True
            seen.moves[block] += 1
            for i in range(motion.velocity.shape[1]):
                seen.poses.moved[block, i] = motion.poses.moved[block, i]
                for j in range(motion.velocity.shape[1]):
                    seen.poses.change[block, i, j] = motion.poses.change[block, i, j]
        some = some or seen.watched[block]
    return some and moved


@compiled
def wait(found: Found, motion: Motion, sizes: Array, soon: Flags) -> float:
    """The time until the next look [s]. Which of the places may touch by then is written, shape (n,)."""
    until = LOOK
    for turn in range(2):
        for i in range(len(found.gap)):
            one, other, apart = found.face[i], found.other[i], 0.0
            for j in range(motion.velocity.shape[1]):
                apart += (motion.velocity[one, j] - motion.velocity[other, j]) ** 2
            speed, size = math.sqrt(apart) + motion.about[one] + motion.about[other], min(sizes[one], sizes[other])
            if turn == 0:
                until = min(until, max(PASSED * size, 0.5 * found.gap[i]) / max(speed, 1e-9))
            else:
                soon[i] = found.gap[i] < SURE * (speed * until + 2 * FALL + NEAR * size)
        until = max(until, SOONEST)
    return until


@compiled
def wears(system: System, wear: Wear) -> bool:
    """Bring slip and gap of joints up to date. Returns whether a pair has left its joints."""
    return wears_joints(system, wear, system.axes)


@inlined
def wears_joints(system: System, wear: Wear, axes: tuple[int, ...]) -> bool:
    """`wears`, in the plane or in space."""
    pairs, slip, gap = wear.pairs, wear.slip, wear.gap
    for pair in range(len(slip)):
        slip[pair], gap[pair] = 0.0, math.inf
    for b in range(len(system.bodies)):
        take_turn(system.bodies[b], axes)
    for p in range(len(pairs)):
        line = system.lines[p]
        body, at, normal = system.bodies[line.body], components(line.at, axes), components(line.normal, axes)
        across = plus(components(line.between, axes), plus(components(body.place, axes), rotation_change(body, at)))
        if line.face >= 0:
            face = system.bodies[line.face]
            change = rotation_change(face, components(line.origin, axes))
            across = minus(across, plus(components(face.place, axes), change))
            normal = plus(normal, rotation_change(face, normal))
        elif line.support >= 0:
            across = minus(across, vector(system.supports.moved, line.support, axes))
        apart = dot(normal, across)
        slip[pairs[p]] = max(slip[pairs[p]], math.sqrt(max(dot(across, across) - apart * apart, 0.0)))
        gap[pairs[p]] = min(gap[pairs[p]], apart)
        line.widest = max(line.widest, apart)
    left = False
    for pair in range(len(slip)):
        left = left or max(slip[pair], gap[pair]) > wear.left[pair]
    return left


@compiled
def held(system: System, which: Integers, depth: Array) -> float:
    """Energy in the springs along the normal of some of the lines [J], and write how deep each presses [m]. What shear
    springs lose, friction takes."""
    return held_by_lines(system, which, depth, system.axes)


@inlined
def held_by_lines(system: System, which: Integers, depth: Array, axes: tuple[int, ...]) -> float:
    """`held`, in the plane or in space."""
    energy = 0.0
    for i in range(len(which)):
        line = system.lines[which[i]]
        gap = meeting(system, line, axes).gap
        depth[i] = max(-gap, 0.0)
        energy += stored(line, gap)
    return energy
