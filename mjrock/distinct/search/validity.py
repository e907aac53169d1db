"""Validity: how long the contacts that a search has found are valid, and which joints blocks have left."""

from __future__ import annotations

import math
from copy import deepcopy
from typing import NamedTuple

import numpy as np

from ...compiled import compiled_at_once, inlined
from ...geometry.vectors import dot, norm, plus, put, read, scaled, vector
from ...problem.masonry.laws.joint_law import normal_force, stored
from ...quantities import GRAVITY, Array, Flags, Integers
from ..contacts.faces import meeting, position_over_face, relative_velocity, where_friction_rubs
from ..contacts.friction import along_face, as_vector, carried, sheared
from ..kinds.lists import is_bonded, stored_by_laws
from ..rotation import in_world, rotation_change, take_inverse_inertia, update_rotation
from ..system import System, Tables
from .constants import LONGEST_INTERVAL, NEAR, REACH, SEARCHED_TOGETHER, SHORTEST_INTERVAL, VALID_APPROACH
from .finder import ContactPlaces
from .handover import Blocks
from .solids import Poses

AXES = np.eye(3)
"""Unit vectors."""


class Motion(NamedTuple):
    """Where all blocks are, and how fast.

    Args:
        poses: where they are.
        velocity: of their centroids [m/s], shape (blocks, d).
        about: the largest velocity of a corner about the centroid of its block, and its surge [m/s], shape (blocks,).
        surge: largest change of the velocity of a driven block until the next update [m/s], shape (blocks,), see
            `supports.velocity_changes`.
    """

    poses: Poses
    velocity: Array
    about: Array
    surge: Array

    @classmethod
    def initial(cls, start: Poses) -> Motion:
        """Of blocks that stand where they start."""
        about, surge = np.zeros((2, len(start.moved)))
        return cls(deepcopy(start), np.zeros_like(start.moved), about, surge)


class Validity(NamedTuple):
    """For how long the contacts of each block are valid, which an update of the search brings up to date.

    Args:
        searched: whether the contacts of each block are searched at all, shape (blocks,).
        motion: where each was, and how fast, when its contacts were last searched.
        searches: how often that was done, shape (blocks,).
        valid_for: time for which its contacts are valid from the last update on [s], shape (blocks,).
        ahead: how far each may go within the longest time between two updates [m], shape (blocks,).
        outdated: whether its contacts were valid no longer at the last update, shape (blocks,).
        left: whether it had left a joint since the update before, shape (blocks,).
    """

    searched: Flags
    motion: Motion
    searches: Integers
    valid_for: Array
    ahead: Array
    outdated: Flags
    left: Flags

    @classmethod
    def initial(cls, start: Poses, interval: float) -> Validity:
        """Of blocks that stand where they start, with the longest time between two updates [s]."""
        count = len(start.moved)
        searched, outdated, left = np.zeros((3, count), dtype=bool)
        searches, valid_for = np.zeros(count, dtype=np.int64), np.full(count, interval)
        return cls(searched, Motion.initial(start), searches, valid_for, np.zeros(count), outdated, left)


class Limits(NamedTuple):
    """How far blocks may go without a search.

    Args:
        start: where they stood.
        first_search: how far each may be from there before its contacts are searched [m], shape (blocks,).
        displacement: by how much each may move while its contacts stay valid [m], shape (blocks,).
        interval: longest time between two updates [s].
    """

    start: Poses
    first_search: Array
    displacement: Array
    interval: float


class Account(NamedTuple):
    """Energy in the springs of lines [J], and the power of their forces [W].

    Args:
        energy: in the springs along normals of some of the lines.
        sheared: in the shear springs of all lines and of the laws of their joints.
        power: at which the springs along normals give energy away.
        carried: with which the forces of the last step move supports. The next step books this and the two below for
            its half before the pose.
        rubbed: that friction takes.
        damped: that the dashpots along normals take.
    """

    energy: float
    sheared: float
    power: float
    carried: float
    rubbed: float
    damped: float


class JointState(NamedTuple):
    """How far joints have slipped, opened and tilted.

    Args:
        pairs: number of the pair of blocks of each line of a joint, shape (m,).
        blocks: the two blocks of each pair, shape (pairs, 2).
        slip_limit: slip or gap from which on a pair has left its joints [m], shape (pairs,).
        tilt_limit: tilt from which on it has left them [-], shape (pairs,).
        slip, gap: largest slip along the joints of each pair, and least opening [m], shape (pairs,).
        tilt: 1 less the cosine of the angle of its faces [-], shape (pairs,).
        left: whether it has left its joints since the last update, shape (pairs,).
    """

    pairs: Integers
    blocks: Integers
    slip_limit: Array
    tilt_limit: Array
    slip: Array
    gap: Array
    tilt: Array
    left: Flags

    @classmethod
    def intact(cls, pairs: Integers, blocks: Integers, slip_limit: Array, tilt_limit: Array) -> JointState:
        """Of joints that are as drawn."""
        (slip, gap, tilt), left = np.zeros((3, len(blocks))), np.zeros(len(blocks), dtype=bool)
        return cls(pairs, blocks, slip_limit, tilt_limit, slip, gap, tilt, left)


class SearchInput(NamedTuple):
    """The input of an update of the search: the blocks and their motion, how far they may go without a search, their
    joints, which pairs have handed these over, and the validity of their contacts."""

    blocks: Blocks
    motion: Motion
    limits: Limits
    joints: JointState
    handed_over: Flags
    validity: Validity


@compiled_at_once
def is_outdated(system: System, examined: SearchInput, since: float) -> bool:
    """Whether the contacts of a block are outdated, a time after the last update [s].

    Brings the motion, the joints and the validity up to date.
    """
    validity = examined.validity
    update_motion(system, examined.blocks, examined.motion)
    update_joints(system, examined.joints)
    mark_left(system.laws, examined.joints, examined.handed_over, validity.left)
    return mark_outdated(examined.motion, examined.blocks.sizes, examined.limits, validity, since)


@inlined
def update_motion(system: System, blocks: Blocks, motion: Motion) -> None:
    """Write where the blocks are that move, and how fast, and take the inertia of the bodies there."""
    poses, supports = motion.poses, system.supports
    for b in range(len(blocks.free)):
        body, block = system.bodies[b], blocks.free[b]
        update_rotation(body)
        take_inverse_inertia(body)
        place, spin = read(body.place), read(body.spin)
        for i in range(len(place)):
            put(poses.change[block][:, i], rotation_change(body, vector(AXES, i, place)))
        put(poses.moved[block], place)
        put(motion.velocity[block], read(body.velocity))
        motion.about[block] = norm(spin) * blocks.sizes[block] + motion.surge[block]
    for block in range(len(blocks.support)):
        if blocks.support[block] >= 0:
            motion.about[block] = motion.surge[block]
            put(poses.moved[block], vector(supports.moved, blocks.support[block], system.axes))
            put(motion.velocity[block], vector(supports.moving, blocks.support[block], system.axes))


@inlined
def displacement_of(poses: Poses, other: Poses, block: int, size: float) -> float:
    """Largest displacement of a corner of a block from where it is in other poses [m]."""
    square = turned = 0.0
    for i in range(poses.moved.shape[1]):
        square += (poses.moved[block, i] - other.moved[block, i]) ** 2
        for j in range(poses.moved.shape[1]):
            turned += (poses.change[block, i, j] - other.change[block, i, j]) ** 2
    return math.sqrt(square) + math.sqrt(turned) * size


@inlined
def speed_of(motion: Motion, block: int) -> float:
    """The largest speed of a corner of a block [m/s]."""
    square = 0.0
    for i in range(motion.velocity.shape[1]):
        square += motion.velocity[block, i] ** 2
    speed: float = math.sqrt(square) + motion.about[block]
    return speed


@inlined
def record(kept: Motion, motion: Motion, block: int) -> None:
    """Keep where a block is, and how fast."""
    for i in range(motion.velocity.shape[1]):
        kept.poses.moved[block, i], kept.velocity[block, i] = motion.poses.moved[block, i], motion.velocity[block, i]
        for j in range(motion.velocity.shape[1]):
            kept.poses.change[block, i, j] = motion.poses.change[block, i, j]
    kept.about[block] = motion.about[block]


def longest_interval(sizes: Array) -> float:
    """The longest time between two updates of the search of blocks of some sizes [s]: that of the smallest one."""
    return LONGEST_INTERVAL * math.sqrt(float(sizes.min()) / GRAVITY)


@inlined
def fall_within(interval: float) -> float:
    """The height by which a block falls in the longest time between two updates [m]."""
    return 0.5 * GRAVITY * interval**2


@inlined
def mark_outdated(motion: Motion, sizes: Array, limits: Limits, validity: Validity, since: float) -> bool:
    """Bring up to date which blocks are searched, and mark those whose contacts are valid no longer.

    These are blocks that are searched for the first time or have left a joint, those that have moved and whose contacts
    have been valid for their time, and those that have become too fast for the contacts that were kept.

    Args:
        motion, sizes: of the blocks.
        limits: how far they may go without a search.
        validity: of their contacts.
        since: time since the last update [s].

    Returns:
        Whether the contacts of a block are outdated.
    """
    any_outdated, left, interval = False, validity.left, limits.interval
    for block in range(len(sizes)):
        speed, size, searched, valid_for = speed_of(motion, block), sizes[block], validity.searched[block], interval
        if searched:
            valid_for = max(validity.valid_for[block] - since, 0.0)
        validity.ahead[block] = interval * speed
        distance = displacement_of(motion.poses, limits.start, block, size) + validity.ahead[block]
        validity.searched[block] = searched or left[block] or distance > limits.first_search[block]
        outdated = left[block] or validity.searched[block] != searched
        if searched and not outdated:
            moved = displacement_of(motion.poses, validity.motion.poses, block, size) > limits.displacement[block]
            kept = REACH * (speed_of(validity.motion, block) * valid_for + fall_within(interval) + NEAR * size)
            outdated = (moved and valid_for < SEARCHED_TOGETHER * interval) or speed * valid_for > kept
        validity.valid_for[block] = valid_for if valid_for >= SEARCHED_TOGETHER * interval else interval
        if outdated:
            validity.searches[block] += 1
            record(validity.motion, motion, block)
        validity.outdated[block] = outdated
        any_outdated = any_outdated or outdated
    return any_outdated


@inlined
def approach_speed(motion: Motion, one: int, other: int) -> float:
    """The largest speed at which two blocks may come together [m/s]."""
    square = 0.0
    for j in range(motion.velocity.shape[1]):
        square += (motion.velocity[one, j] - motion.velocity[other, j]) ** 2
    speed: float = math.sqrt(square) + motion.about[one] + motion.about[other]
    return speed


@compiled_at_once
def set_validity(
    places: ContactPlaces, motion: Motion, sizes: Array, validity: Validity, may_touch: Flags, interval: float
) -> None:
    """Write for how long the contacts that a search has found are valid.

    Those of a pair are valid until either block is searched again: the faster one, if it was searched now.

    Args:
        places: that are found.
        motion, sizes: of the blocks.
        validity: which blocks were searched.
        may_touch: room for whether each place may touch by then, shape (n,).
        interval: longest time between two updates [s].
    """
    valid_for, outdated = validity.valid_for, validity.outdated
    for block in range(len(valid_for)):
        if outdated[block]:
            valid_for[block] = interval
    for turn in range(2):
        for i in range(len(places.gap)):
            one, other = places.face[i], places.other[i]
            speed, size = approach_speed(motion, one, other), min(sizes[one], sizes[other])
            if turn == 0:
                valid = max(VALID_APPROACH * size, 0.5 * places.gap[i]) / max(speed, 1e-9)
                first = outdated[one] and (not outdated[other] or speed_of(motion, one) >= speed_of(motion, other))
                block = one if first else other
                valid_for[block] = min(valid_for[block], max(valid, SHORTEST_INTERVAL * interval))
            else:
                until = min(valid_for[one], valid_for[other])
                may_touch[i] = places.gap[i] < REACH * (speed * until + 2 * fall_within(interval) + NEAR * size)


@inlined
def update_joints(system: System, joints: JointState) -> None:
    """Bring slip, gap and tilt of joints up to date, for bodies whose rotations are."""
    pairs, slip, gap, tilt = joints.pairs, joints.slip, joints.gap, joints.tilt
    for pair in range(len(slip)):
        slip[pair], gap[pair], tilt[pair] = 0.0, math.inf, 0.0
    for p in range(len(pairs)):
        line = system.lines[p]
        offset, normal, _, _ = position_over_face(system, line)
        line_normal, opening = in_world(system.bodies[line.body], read(line.normal)), dot(normal, offset)
        slip[pairs[p]] = max(slip[pairs[p]], math.sqrt(max(dot(offset, offset) - opening * opening, 0.0)))
        gap[pairs[p]] = min(gap[pairs[p]], opening)
        tilt[pairs[p]] = max(tilt[pairs[p]], 1 - dot(line_normal, normal))
        line.widest = max(line.widest, opening)


@inlined
def mark_left(laws: Tables, joints: JointState, handed_over: Flags, left: Flags) -> None:
    """Mark which pairs have left their joints since the last update, and which blocks have `left` one, shape (blocks,).

    Of these pairs no line holds more than friction. Those that are handed over had left them before.
    """
    for block in range(len(left)):
        left[block] = False
    for pair in range(len(handed_over)):
        slid = max(joints.slip[pair], joints.gap[pair]) > joints.slip_limit[pair]
        joints.left[pair] = not handed_over[pair] and (slid or joints.tilt[pair] > joints.tilt_limit[pair])
    for p in range(len(joints.pairs)):
        if joints.left[joints.pairs[p]] and is_bonded(laws, p):
            joints.left[joints.pairs[p]] = False
    for pair in range(len(handed_over)):
        if joints.left[pair]:
            left[joints.blocks[pair, 0]] = left[joints.blocks[pair, 1]] = True


def account(system: System, numbers: Integers, depth: Array) -> Account:
    """The account of some of the lines, with the normals that they have now, and write how deep each presses [m]."""
    return Account(*sums(system, numbers, depth))


@compiled_at_once
def sums(system: System, numbers: Integers, depth: Array) -> tuple[float, ...]:
    """The numbers of an `account`."""
    energy = power = moved = rubbed = damped = 0.0
    for i in range(len(numbers)):
        line = system.lines[numbers[i]]
        meet = meeting(system, line)
        depth[i] = max(-meet.gap, 0.0)
        energy += stored(line, meet.gap)
        if meet.gap < 0:
            rate = dot(meet.normal, relative_velocity(system.bodies, line, system.supports, meet))
            power += normal_force(line, meet.gap, 0.0) * rate
        meet = where_friction_rubs(meet)
        velocity, friction = relative_velocity(system.bodies, line, system.supports, meet), read(line.shear_force)
        moved += carried(line, system.supports, plus(scaled(line.push, meet.normal), as_vector(meet.normal, friction)))
        rubbed -= dot(friction, along_face(meet.normal, velocity))
        damped -= line.dashpot_force * dot(meet.normal, velocity)
    along_faces = stored_by_laws(system.laws)[1]
    for p in range(len(system.lines)):
        along_faces += sheared(system.lines[p])
    return energy, along_faces, power, moved, rubbed, damped
