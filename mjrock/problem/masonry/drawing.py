"""What is odd about masonry as it is given: sizes or damping in another unit, faces split by rounded vertices."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Sequence

import numpy as np

from ...quantities import Array, named
from .blocks.compound import AnyBlock
from .blocks.joints import Joint
from .blocks.joints_in_space import SpaceJoint

LARGEST, SMALLEST = 50.0, 2e-3
"""Sizes beyond which the free blocks of masonry are probably not in m: all of them larger, or all of them smaller."""
WIDEST = 0.1
"""Largest tolerance of masonry [m]."""
FINE = 1.05
"""Factor to which the tolerance that joints need is found [-]."""
FAR = 30.0
"""How far below the lowest frequency a given one is doubted [-], where it damps that one beyond `OVERDAMPED`."""
OVERDAMPED = 30.0
"""Damping ratio of the lowest mode above which the frequency that xi refers to is doubted [-]."""
UNDAMPED = 1e-4
"""The same below which it is doubted [-], where xi is a hundred times as much."""
Finder = Callable[[float], Sequence[Joint | SpaceJoint]]
"""The joints that a tolerance gives [m]."""
ALIKE = 0.99
"""Cosine of the angle between the normals of two joints of the same two blocks, which convex blocks cannot have [-]."""


def odd_damping(xi: Array) -> str:
    """What is odd about damping ratios of joints at the lowest frequency [-], in words, empty where nothing is."""
    most = float(xi.max(initial=0.0))
    return f"xi = {most:g} is {most:.0%} of critical; damping ratios are fractions" if most > 1 else ""


def odd_frequency(xi: float, frequency: float, lowest: float) -> str:
    """What is odd about a given frequency, beside the lowest one of the masonry [rad/s], in words, empty where nothing.

    With the lowest one it makes of xi the damping ratio of that mode, which says whether c/k is odd.
    """
    found, c_over_k = xi * lowest / frequency, 2 * xi / frequency
    overdamped = found > OVERDAMPED and lowest > FAR * frequency
    if not (overdamped or (0 < found < UNDAMPED and xi > 100 * UNDAMPED)):
        return ""
    return (
        f"frequency = {frequency:g} rad/s, and the lowest one of this masonry is {lowest:.3g} rad/s: with xi = "
        f"{xi:g} that one is damped to {found:.3g} times critical, c/k = {c_over_k:.2g} s; frequencies are in "
        "rad/s, and None takes the lowest"
    )


def odd_sizes(blocks: Sequence[AnyBlock], names: Sequence[str]) -> str:
    """What is odd about the sizes of the free blocks, in words, empty where nothing is."""
    sizes = {name: 2 * block.size for block, name in zip(blocks, names, strict=True) if not block.fixed}
    least, most = min(sizes, key=sizes.__getitem__), max(sizes, key=sizes.__getitem__)
    if sizes[most] >= SMALLEST and sizes[least] <= LARGEST:
        return ""
    name = least if sizes[least] > LARGEST else most
    return f"{name} is {sizes[name]:.4g} m across; vertices are in m: are they in mm? A file takes scale=0.001"


def gaps(
    blocks: Sequence[AnyBlock], names: Sequence[str], loose: Sequence[int], joints_within: Finder, tolerance: float
) -> str:
    """The smallest gap of blocks that touch no other within a tolerance [m], and the one with which all would.

    Args:
        blocks, names: of the masonry.
        loose: numbers of blocks without a joint.
        joints_within: the joints that a tolerance gives.
        tolerance: that gives them none.
    """
    low, high = (np.array([end(block.corners, axis=0) for block in blocks]) for end in (np.min, np.max))
    apart = np.array([np.linalg.norm(np.maximum(0.0, np.maximum(low - high[i], low[i] - high)), axis=1) for i in loose])
    apart[np.arange(len(loose)), loose] = np.inf
    one, other = divmod(int(apart.argmin()), len(blocks))
    pair = f"{names[loose[one]]} and {names[other]}"
    said = f"between the bounds of {pair} there are {apart[one, other]:.3g} m"
    needed = needed_tolerance(loose, joints_within, tolerance)
    if needed is None:
        return f"{said}, and no tolerance up to {WIDEST:g} m joins all of them"
    return f"{said}; tolerance = {needed:.2g} m joins all of them"


def needed_tolerance(loose: Sequence[int], joints_within: Finder, given: float) -> float | None:
    """A tolerance of two digits with which blocks have a joint each [m], near the least one; None where none has."""

    def joins(tolerance: float) -> bool:
        return set(loose) <= {i for joint in joints_within(tolerance) for i in (joint.below, joint.above)}

    low = high = given
    while not joins(high):
        if high >= WIDEST:
            return None
        low, high = high, min(2 * high, WIDEST)
    while high > FINE * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if joins(middle) else (middle, high)
    digit = 10.0 ** (math.floor(math.log10(high)) - 1)
    rounded = min(digit * math.ceil(high / digit), WIDEST)
    return rounded if joins(rounded) else high


def split_faces(joints: Sequence[Joint | SpaceJoint], blocks: Sequence[AnyBlock], names: Sequence[str]) -> str:
    """What is odd about the joints of blocks in space, in words, empty where nothing is.

    Two convex blocks have one face each that points at the other in one way. Two joints of theirs with nearly the same
    normal are parts of a face that vertices off its plane have split.
    """
    normals = defaultdict(list)
    for joint in joints:
        if isinstance(joint, SpaceJoint) and len(blocks[joint.below].parts) == len(blocks[joint.above].parts) == 1:
            normals[joint.below, joint.above].append(joint.normal)
    odd = []
    for pair, ways in normals.items():
        if len(ways) > 1 and (np.array(ways) @ np.transpose(ways) - np.eye(len(ways))).max() > ALIKE:
            odd.append(f"{names[pair[0]]} and {names[pair[1]]}")
    if not odd:
        return ""
    return (
        f"{len(odd)} pairs of blocks meet along a face that is split into parts which are nearly parallel, such as "
        f"{named(odd)}: vertices lie off the planes of their faces; round them, or draw the faces plane"
    )
