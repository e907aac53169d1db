"""The wall above each bed joint of a stack, taken as one rigid wall on that joint, and the damping that a law gives
it."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from .block import Block
from .contacts import Contacts, Law
from .joints import Joint
from .polygon import Polygon
from .quantities import Array
from .restitution import Restitution


def walls_above(blocks: Sequence[Polygon], joints: Sequence[Joint]) -> list[Block]:
    """The rigid wall on each joint of a stack.

    It is as thick as the joint, has the mass of all blocks above the joint, and its centroid is where theirs is.

    Raises:
        ValueError: if the blocks are no stack: each that is not fixed stands on one other block, on a bed joint, and
            carries at most one; or if a part is too squat for a rocking wall.
    """
    on = {joint.above: joint for joint in joints}
    carried = {joint.below: joint.above for joint in joints if not blocks[joint.below].fixed}
    beds = all(joint.is_bed for joint in joints)
    loose = [i for i, block in enumerate(blocks) if not block.fixed and i not in on]
    stands = [joint.below for joint in joints if not blocks[joint.below].fixed]
    if not beds or loose or len(on) != len(joints) or len(set(stands)) != len(stands):
        raise ValueError("law = is for stacks, where every block stands on one other block or on the ground; give xi")
    walls = []
    for joint in joints:
        part, block = [joint.above], joint.above
        while block in carried:
            block = carried[block]
            part.append(block)
        mass = np.array([blocks[i].mass for i in part])
        height = float(mass @ [blocks[i].centroid[1] - joint.middle[1] for i in part]) / float(mass.sum())
        b = 0.5 * joint.width
        try:
            density = float(mass.sum()) / (4 * b * height * joint.length)
            walls.append(Block(b=b, h=height, length=joint.length, density=density))
        except ValueError as error:
            raise ValueError(f"law = has no wall for the joint {joint.name}: {error}; give xi") from None
    return walls


def retardations(blocks: Sequence[Polygon], joints: Sequence[Joint], k_n: Array, points: int, law: Law | str) -> Array:
    """c/k of each joint of a stack [s], as `Contacts.from_law` gives it for the rigid wall above.

    What is asked for is the restitution of that wall by conservation of angular momentum.

    Raises:
        ValueError: as `walls_above` does, and what the law raises.

    Warns:
        UserWarning: what the law warns of, with the name of the joint.
    """
    found = []
    for joint, wall, k in zip(joints, walls_above(blocks, joints), k_n.tolist(), strict=True):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            made = Contacts.from_law(wall, Restitution.from_geometry(wall), k_base=k, law=law, points=points)
        for warning in caught:
            warnings.warn(f"the joint {joint.name}: {warning.message}", warning.category, stacklevel=4)
        found.append(made.base.retardation)
    return np.array(found)
