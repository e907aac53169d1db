"""The wall above each bed joint of a stack, taken as one rigid wall on that joint, and the damping that a law gives
it."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from ....quantities import Array, Integers, warn_of
from ...damping.contacts import AnyLaw, Contacts
from ...damping.restitution import Restitution
from ...wall.block import Block
from ..blocks.compound import AnyBlock
from ..blocks.joints import Joint
from ..blocks.joints_in_space import SpaceJoint

StackBlocks = Sequence[AnyBlock]


def is_side(blocks: StackBlocks, joint: Joint | SpaceJoint) -> bool:
    """Whether a joint is that with a fixed block beside its block, as with a side stop."""
    return blocks[joint.below].fixed and abs(joint.normal[-1]) < 1e-6


def parts_above(blocks: StackBlocks, beds: Sequence[Joint | SpaceJoint]) -> list[list[int]] | None:
    """Numbers of the blocks above each bed joint of a stack, from the lowest upwards; None if this is not a stack.

    In a stack each block that is not fixed stands on one other block, on a bed joint, and carries at most one.
    """
    on = {joint.above: joint for joint in beds}
    carried = {joint.below: joint.above for joint in beds if not blocks[joint.below].fixed}
    loose = [i for i, block in enumerate(blocks) if not block.fixed and i not in on]
    stands = [joint.below for joint in beds if not blocks[joint.below].fixed]
    if not all(joint.is_bed for joint in beds) or loose or len(on) != len(beds) or len(set(stands)) != len(stands):
        return None
    parts = []
    for joint in beds:
        part = [joint.above]
        while part[-1] in carried:
            part.append(carried[part[-1]])
        parts.append(part)
    return parts


def wall_of(blocks: StackBlocks, joint: Joint | SpaceJoint, part: Sequence[int]) -> Block:
    """Some blocks as one rigid wall on a joint: as thick as the joint, with their mass, its centroid where theirs is.

    In space the joint is as thick as where it is thinnest.

    Raises:
        ValueError: if they are too squat for a rocking wall.
    """
    mass = np.array([blocks[i].mass for i in part])
    height = float(mass @ [blocks[i].centroid[-1] - joint.middle[-1] for i in part]) / float(mass.sum())
    b = 0.5 * joint.width
    return Block(b=b, h=height, length=joint.length, density=float(mass.sum()) / (4 * b * height * joint.length))


def damping_by_law(
    blocks: StackBlocks, joints: Sequence[Joint | SpaceJoint], k_n: Array, points: Integers, law: AnyLaw | str
) -> tuple[Array, Array]:
    """xi of each joint of a stack, and the frequency to which it refers [rad/s], as `Contacts.from_law` gives them for
    the rigid wall above.

    The required loss is the restitution of that wall by conservation of angular momentum. A joint with a fixed block
    beside the stack is damped as the side stop of the whole stack.

    Raises:
        ValueError: if the blocks are not a stack, if a part is too squat for a rocking wall, and what the law raises.

    Warns:
        UserWarning: what the law warns of, with the name of the joint.
    """
    beds = [i for i, joint in enumerate(joints) if not is_side(blocks, joint)]
    parts = parts_above(blocks, [joints[i] for i in beds])
    if parts is None:
        raise ValueError(
            "law: damping by a law is for stacks, where every block stands on one other block or on the ground; give xi"
        )
    if len(beds) < len(joints) and isinstance(joints[0], SpaceJoint):
        raise ValueError("law: in space it is for stacks that stand free, with no fixed block beside them; give xi")
    walls = {}
    for i, part in zip(beds, parts, strict=True):
        try:
            walls[i] = wall_of(blocks, joints[i], part)
        except ValueError as error:
            raise ValueError(f"law: there is no wall for the joint {joints[i].name}: {error}; give xi") from None
    under = {joints[i].above: i for i in beds}
    damping = np.empty((2, len(joints)))
    for i, joint in enumerate(joints):
        base, k_side, top = i, None, None
        if i not in walls:
            base, k_side = under[joint.above], float(k_n[i])
            while not blocks[joints[base].below].fixed:
                base = under[joints[base].below]
            stop = [
                max(j.start[1], j.end[1])
                for j in joints
                if isinstance(j, Joint) and j.below == joint.below and is_side(blocks, j)
            ]
            top = max(stop) - float(joints[base].middle[1])
        wall = walls[base]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            e = Restitution.from_geometry(wall, None if top is None else min(top, 2 * wall.h))
            contacts = Contacts.from_law(
                wall, e, k_base=float(k_n[base]), k_side=k_side, law=law, points=int(points[base])
            )
        for warning in caught:
            warn_of(f"the joint {joint.name}: {warning.message}", warning.category)
        interface = contacts.side or contacts.base
        damping[:, i] = interface.xi, interface.frequency
    return damping[0], damping[1]
