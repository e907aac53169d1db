"""Looking at blocks and lines: where and how fast blocks are, which joints hold no longer, and what springs hold."""

from __future__ import annotations

import math
from copy import deepcopy
from typing import NamedTuple

import numpy as np

from ...compiled import compiled_at_once, inlined
from ...geometry.vectors import dot, put, read, vector
from ...problem.masonry.laws.joint_law import normal_force, stored
from ...quantities import GRAVITY, Array, Flags, Integers
from ..contacts.contact import meeting, over_face, relative
from ..system import System
from ..turning import in_world, rotation_change, take_inverse_inertia, take_turn
from .finder import Found
from .handover import Blocks
from .solids import Poses

LOOK = 0.03
"""Longest time between two looks, over the time in which a block falls by half its size [-]: 5 ms for one of 0.27 m,
which is half the diagonal of a block of 0.5 x 0.25 m. So a model is looked at as often as what it is a model of."""
SOONEST = 0.1
"""Shortest time between two looks over the longest one [-]."""
PASSED = 0.02
"""Way that a pair may make between two looks, over the size of the smaller block [-]."""
SURE = 2.0
"""Way within which places are kept until the next look at a block, over that which speeds alone make [-]."""
EARLY = 0.5
"""Time up to which places serve on at a look without being kept for it, over the longest between two looks [-]. So
blocks are looked at together."""
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
        about: the largest velocity of a corner about the centroid of its block, and by how much that of a block that is
            driven changes until the next look, see `surges` [m/s], shape (blocks,).
    """

    poses: Poses
    velocity: Array
    about: Array


class Seen(NamedTuple):
    """What looks have seen of the blocks, which a look brings up to date.

    Args:
        watched: whether each block is looked at, shape (blocks,).
        motion: where each was, and how fast, when its places were last found.
        moves: how often they have been found, shape (blocks,).
        due: time for which they serve from the last look on [s], shape (blocks,).
        ahead: how far each may go within the longest time between looks [m], shape (blocks,).
        stale: whether its places have served no longer at the last look, shape (blocks,).
    """

    watched: Flags
    motion: Motion
    moves: Integers
    due: Array
    ahead: Array
    stale: Flags

    @classmethod
    def nothing(cls, start: Poses, look: float) -> Seen:
        """Of blocks that stand where they start, with the longest time between looks [s]."""
        count, still = len(start.moved), deepcopy(start)
        flags, speeds = np.zeros((2, count), dtype=bool), np.zeros((2, count))
        motion = Motion(still, np.zeros_like(still.moved), speeds[0])
        return cls(flags[0], motion, np.zeros(count, dtype=np.int64), np.full(count, look), speeds[1], flags[1])


class Reach(NamedTuple):
    """How far blocks may go.

    Args:
        start: where they stood.
        limits: how far each may be from there before it is looked at [m], shape (blocks,).
        stay: by how much each may move while a find of it stays valid [m], shape (blocks,).
        look: longest time between two looks [s].
    """

    start: Poses
    limits: Array
    stay: Array
    look: float


class Wear(NamedTuple):
    """How far joints have worn.

    Args:
        pairs: number of the pair of blocks of each line of a joint, shape (m,).
        slip, gap: largest way along the joints of each pair, and least opening [m], shape (pairs,).
        tilt: 1 less the cosine of the angle of its faces [-], shape (pairs,).
        left: slip or gap from which on a pair has left its joints [m], shape (pairs,).
        rolled: tilt from which on it has left them [-], shape (pairs,).
    """

    pairs: Integers
    slip: Array
    gap: Array
    tilt: Array
    left: Array
    rolled: Array

    @classmethod
    def unworn(cls, pairs: Integers, left: Array, rolled: Array) -> Wear:
        """Of joints that are as drawn."""
        return cls(pairs, np.zeros(len(left)), np.zeros(len(left)), np.zeros(len(left)), left, rolled)

    def leave(self) -> Flags:
        """Which pairs have left their joints, shape (pairs,)."""
        return np.asarray((np.maximum(self.slip, self.gap) > self.left) | (self.tilt > self.rolled))


@compiled_at_once
def take_motion(system: System, blocks: Blocks, motion: Motion) -> None:
    """Write where the blocks are that move, and how fast, and take the inertia of the bodies there."""
    poses, supports = motion.poses, system.supports
    for b in range(len(blocks.free)):
        body, block = system.bodies[b], blocks.free[b]
        take_turn(body)
        take_inverse_inertia(body)
        place, spin = read(body.place), read(body.spin)
        for i in range(len(place)):
            put(poses.change[block][:, i], rotation_change(body, vector(AXES, i, place)))
        put(poses.moved[block], place)
        put(motion.velocity[block], read(body.velocity))
        motion.about[block] = math.sqrt(dot(spin, spin)) * blocks.sizes[block]
    for block in range(len(blocks.support)):
        if blocks.support[block] >= 0:
            put(poses.moved[block], vector(supports.moved, blocks.support[block], system.axes))
            put(motion.velocity[block], vector(supports.moving, blocks.support[block], system.axes))


@inlined
def far(poses: Poses, other: Poses, block: int, size: float) -> float:
    """How far a corner of a block may be from where it is in other poses [m]."""
    way = turned = 0.0
    for i in range(poses.moved.shape[1]):
        way += (poses.moved[block, i] - other.moved[block, i]) ** 2
        for j in range(poses.moved.shape[1]):
            turned += (poses.change[block, i, j] - other.change[block, i, j]) ** 2
    return math.sqrt(way) + math.sqrt(turned) * size


@inlined
def speed_of(motion: Motion, block: int) -> float:
    """The largest speed of a corner of a block [m/s]."""
    square = 0.0
    for i in range(motion.velocity.shape[1]):
        square += motion.velocity[block, i] ** 2
    speed: float = math.sqrt(square) + motion.about[block]
    return speed


@inlined
def keep(seen: Motion, motion: Motion, block: int) -> None:
    """Keep where a block is, and how fast."""
    for i in range(motion.velocity.shape[1]):
        seen.poses.moved[block, i], seen.velocity[block, i] = motion.poses.moved[block, i], motion.velocity[block, i]
        for j in range(motion.velocity.shape[1]):
            seen.poses.change[block, i, j] = motion.poses.change[block, i, j]
    seen.about[block] = motion.about[block]


def longest_time(sizes: Array) -> float:
    """The longest time between two looks at blocks of some sizes [s]: that of the smallest one."""
    return LOOK * math.sqrt(float(sizes.min()) / GRAVITY)


@inlined
def fallen(look: float) -> float:
    """What a block falls by in the longest time between two looks [m]."""
    return 0.5 * GRAVITY * look**2


@compiled_at_once
def watch(motion: Motion, sizes: Array, reach: Reach, seen: Seen, left: Flags, since: float) -> bool:
    """Bring up to date which blocks are looked at, and name those whose places serve no longer.

    These are blocks that are looked at for the first time or have left a joint, those that have moved and whose places
    have served their time, and those that have become too fast for the places that were kept.

    Args:
        motion, sizes: of the blocks.
        reach: how far they may go.
        seen: what looks before have seen.
        left: blocks that have left a joint, shape (blocks,).
        since: time since the last look [s].

    Returns:
        Whether those of a block do not.
    """
    some, look = False, reach.look
    for block in range(len(sizes)):
        speed, size, watched, due = speed_of(motion, block), sizes[block], seen.watched[block], look
        if watched:
            due = max(seen.due[block] - since, 0.0)
        seen.ahead[block] = look * speed
        way = far(motion.poses, reach.start, block, size) + seen.ahead[block]
        seen.watched[block] = watched or left[block] or way > reach.limits[block]
        stale = left[block] or seen.watched[block] != watched
        if watched and not stale:
            moved = far(motion.poses, seen.motion.poses, block, size) > reach.stay[block]
            kept = SURE * (speed_of(seen.motion, block) * due + fallen(look) + NEAR * size)
            stale = (moved and due < EARLY * look) or speed * due > kept
        seen.due[block] = due if due >= EARLY * look else look
        if stale:
            seen.moves[block] += 1
            keep(seen.motion, motion, block)
        seen.stale[block] = stale
        some = some or stale
    return some


@inlined
def closing(motion: Motion, one: int, other: int) -> float:
    """The largest speed at which two blocks may come together [m/s]."""
    square = 0.0
    for j in range(motion.velocity.shape[1]):
        square += (motion.velocity[one, j] - motion.velocity[other, j]) ** 2
    speed: float = math.sqrt(square) + motion.about[one] + motion.about[other]
    return speed


@compiled_at_once
def wait(found: Found, motion: Motion, sizes: Array, seen: Seen, soon: Flags, look: float) -> None:
    """Write for how long places serve that have been found.

    Those of a pair serve until either block is looked at again: the faster one, if its places were found.

    Args:
        found: the places.
        motion, sizes: of the blocks.
        seen: which blocks were looked at.
        soon: room for whether each place may touch by then, shape (n,).
        look: longest time between two looks [s].
    """
    due, stale = seen.due, seen.stale
    for block in range(len(due)):
        if stale[block]:
            due[block] = look
    for turn in range(2):
        for i in range(len(found.gap)):
            one, other = found.face[i], found.other[i]
            speed, size = closing(motion, one, other), min(sizes[one], sizes[other])
            if turn == 0:
                serve = max(PASSED * size, 0.5 * found.gap[i]) / max(speed, 1e-9)
                first = stale[one] and (not stale[other] or speed_of(motion, one) >= speed_of(motion, other))
                block = one if first else other
                due[block] = min(due[block], max(serve, SOONEST * look))
            else:
                until = min(due[one], due[other])
                soon[i] = found.gap[i] < SURE * (speed * until + 2 * fallen(look) + NEAR * size)


@compiled_at_once
def wears(system: System, wear: Wear) -> bool:
    """Bring slip, gap and tilt of joints up to date. Returns whether a pair has left its joints."""
    pairs, slip, gap, tilt = wear.pairs, wear.slip, wear.gap, wear.tilt
    for pair in range(len(slip)):
        slip[pair], gap[pair], tilt[pair] = 0.0, math.inf, 0.0
    for b in range(len(system.bodies)):
        take_turn(system.bodies[b])
    for p in range(len(pairs)):
        line = system.lines[p]
        across, normal, _, _ = over_face(system, line)
        own, apart = in_world(system.bodies[line.body], read(line.normal)), dot(normal, across)
        slip[pairs[p]] = max(slip[pairs[p]], math.sqrt(max(dot(across, across) - apart * apart, 0.0)))
        gap[pairs[p]] = min(gap[pairs[p]], apart)
        tilt[pairs[p]] = max(tilt[pairs[p]], 1 - dot(own, normal))
        line.widest = max(line.widest, apart)
    left = False
    for pair in range(len(slip)):
        left = left or max(slip[pair], gap[pair]) > wear.left[pair] or tilt[pair] > wear.rolled[pair]
    return left


@compiled_at_once
def held(system: System, which: Integers, depth: Array) -> tuple[float, float]:
    """Energy in the springs along the normal of some of the lines [J] and the power at which they give it away [W], and
    write how deep each presses [m]."""
    energy = power = 0.0
    for i in range(len(which)):
        line = system.lines[which[i]]
        meet = meeting(system, line)
        depth[i] = max(-meet.gap, 0.0)
        energy += stored(line, meet.gap)
        if meet.gap < 0:
            rate = dot(meet.normal, relative(system.bodies, line, system.supports, meet))
            power += normal_force(line, meet.gap, 0.0) * rate
    return energy, power
