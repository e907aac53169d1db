"""What is odd about masonry as it is given: sizes or damping in another unit, faces split by rounded vertices."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import product
from typing import NamedTuple

import numpy as np

from ...geometry.hull import Convex, edge_separating_axes
from ...quantities import Array, Integers, named
from .blocks.compound import AnyBlock
from .blocks.joints import SHORTEST_JOINT, Joint, neighbours
from .blocks.joints_in_space import SpaceJoint
from .files.bodies import LENGTH_UNITS

LARGEST_BLOCK, SMALLEST_BLOCK = 50.0, 2e-3
"""Sizes beyond which the free blocks of masonry are probably not in m: all of them larger, or all of them smaller."""
LARGE_BLOCKS, SMALL_BLOCKS, LEAST_COUNT = 5.0, 0.02, 5
"""Sizes that half of the free blocks of masonry exceed, or fall short of, which are probably not in m, where there are
at least `MANY` [m, m, -]."""
STOREY_HEIGHT = 1.5
"""Height of blocks that stand, and are no wall that lies on its face [m]."""
USUAL, COMMON_SIZE = (0.04, 3.0), 0.35
"""Sizes of blocks that a unit is named for, and that of which the nearest is named first [m]."""
DOUBTED_GAP = 20.0
"""Gap over the tolerance up to which faces of a file that have no joint are doubted [-]."""
LYING_BESIDE, SHARE_ON_GROUND, AREA_ACROSS = 0.25, 0.5, 2.0
"""Free blocks of a file lie along y from fixed ones by this share of the extent, and half of them lie on the ground
while joints across y have twice the area of all others, where y may be the axis that points upwards [-]."""
FINE_TOLERANCE = 1e-5
"""The usual tolerance of masonry [m], at which narrow faces are found too."""
WIDEST_TOLERANCE = 0.1
"""Largest tolerance of masonry [m]."""
TOLERANCE_FACTOR = 1.05
"""Factor to which the gap that joints need is found [-]."""
FAR_BELOW_LOWEST = 30.0
"""How far below the lowest frequency a given one is doubted [-], where it damps that one beyond `OVERDAMPED`."""
OVERDAMPED = 30.0
"""Damping ratio of the lowest mode above which the frequency that xi refers to is doubted [-]."""
UNDAMPED = 1e-4
"""The same below which it is doubted [-], where xi is a hundred times as much."""
JointFinder = Callable[[float], Sequence[Joint | SpaceJoint]]
"""The joints that a gap, or a tolerance, gives [m]."""
ALIKE = 0.99
"""Cosine of the angle between the normals of two joints of the same two blocks, which convex blocks cannot have [-]."""


class Touch(NamedTuple):
    """Numbers of two blocks that touch without a joint, and where: "at a corner" or "along a line"."""

    block: int
    other: int
    where: str


def odd_damping(xi: Array) -> str:
    """What is odd about damping ratios of joints at the lowest frequency [-], in words, empty where nothing is."""
    largest = float(xi.max(initial=0.0))
    return f"xi = {largest:g} is {largest:.0%} of critical; damping ratios are fractions" if largest > 1 else ""


def odd_frequency(xi: float, frequency: float, lowest: float) -> str:
    """What is odd about a given frequency, beside the lowest one of the masonry [rad/s], in words, empty where nothing.

    With the lowest one it makes of xi the damping ratio of that mode, which says whether c/k is odd.
    """
    ratio, c_over_k = xi * lowest / frequency, 2 * xi / frequency
    overdamped = ratio > OVERDAMPED and lowest > FAR_BELOW_LOWEST * frequency
    if not (overdamped or (0 < ratio < UNDAMPED and xi > 100 * UNDAMPED)):
        return ""
    return (
        f"frequency = {frequency:g} rad/s, and the lowest one of this masonry is {lowest:.3g} rad/s: with xi = "
        f"{xi:g} that one is damped to {ratio:.3g} times critical, c/k = {c_over_k:.2g} s; frequencies are in "
        "rad/s, and None takes the lowest"
    )


def odd_sizes(sizes: Mapping[str, float]) -> str:
    """What is odd about the sizes of free blocks by their names [m], in words, empty where nothing is."""
    if not sizes:
        return ""
    ordered = sorted(sizes, key=sizes.__getitem__)
    median = sizes[ordered[len(ordered) // 2]]
    if sizes[ordered[0]] > LARGEST_BLOCK:
        name = ordered[0]
    elif sizes[ordered[-1]] < SMALLEST_BLOCK or (len(sizes) >= LEAST_COUNT and median < SMALL_BLOCKS):
        name = ordered[len(ordered) // 2]
        return f"{name} is {sizes[name]:.4g} m across: is the unit too small? A file takes unit='m'"
    elif len(sizes) >= LEAST_COUNT and median > LARGE_BLOCKS:
        name = ordered[len(ordered) // 2]
    else:
        return ""
    size_in_unit = {unit: sizes[name] * scale for unit, scale in LENGTH_UNITS.items()}
    likely = [unit for unit, size in size_in_unit.items() if unit != "m" and USUAL[0] <= size <= USUAL[1]] or ["mm"]
    likely.sort(key=lambda unit: abs(math.log(size_in_unit[unit] / COMMON_SIZE)))
    units = " or ".join(f"{unit}, {size_in_unit[unit]:.2g} m" for unit in likely)
    return (
        f"{name} is {sizes[name]:.4g} m across; vertices are in m: are they in {units}? A file takes unit={likely[0]!r}"
    )


@contextmanager
def sizes_in_errors(drawn: Mapping[str, Array], turn: Array) -> Iterator[None]:
    """A ValueError that is raised within also has what is odd about the sizes of the bodies of a file.

    Args:
        drawn: vertices of the bodies by name, in the units and axes of the file, shape (n, 3).
        turn: what takes these to m with z upwards, shape (3, 3).
    """
    try:
        yield
    except ValueError as error:
        turned = {name: np.abs(turn) @ np.ptp(places, axis=0) for name, places in drawn.items() if len(places)}
        sizes = {name: float(np.linalg.norm(extents)) for name, extents in turned.items()}
        doubt = odd_sizes({name: size for name, size in sizes.items() if 0 < size < np.inf})
        raise ValueError(f"{error}; {doubt}" if doubt else str(error)) from None


def odd_axis(blocks: Sequence[AnyBlock], joints: Sequence[SpaceJoint], ground: bool) -> str:
    """What says that blocks of a file stand along another axis than z, in words, empty where nothing does.

    Free blocks lie beside all fixed ones and not above them; or, where ground was put under the file, most of them lie
    on it and are stacked sideways, as a wall that has been laid on its face. Walls as high as a storey stand there.
    """
    free = [i for i, block in enumerate(blocks) if not block.fixed]
    fixed = [i for i, block in enumerate(blocks) if block.fixed]
    extent = np.ptp(np.concatenate([blocks[i].corners for i in free]), axis=0)
    text = "z points upwards: does {0} in this file? up={0!r} turns it, and up='z' keeps z"
    if not ground:
        centroids = np.array([block.centroid for block in blocks])
        beyond = (centroids[free].mean(axis=0) - centroids[fixed].mean(axis=0)) / extent.max()
        axis = 0 if beyond[0] > beyond[1] else 1
        if beyond[axis] > LYING_BESIDE and beyond[2] < 0.1 * beyond[axis]:
            return f"the free blocks lie along {'xy'[axis]} from the fixed ones and not above them; " + text.format(
                "xy"[axis]
            )
        return ""
    if STOREY_HEIGHT <= np.median([np.ptp(blocks[i].corners[:, 2]) for i in free]) <= LARGE_BLOCKS:
        return ""
    inner = [joint for joint in joints if joint.below not in fixed]
    areas = sum((joint.area * np.abs(joint.normal) for joint in inner), np.zeros(3))
    lying = len({joint.above for joint in joints if joint.below in fixed})
    axis = 0 if areas[0] > areas[1] else 1
    if (
        len(inner) > 1
        and lying >= SHARE_ON_GROUND * len(free)
        and areas[axis] > AREA_ACROSS * (areas.sum() - areas[axis])
    ):
        return f"{lying} of {len(free)} blocks lie on the ground, side by side along {'xy'[axis]}; " + text.format(
            "xy"[axis]
        )
    return ""


def remedy(deepest: float, joints_within: JointFinder, blocks: Sequence[AnyBlock]) -> str:
    """The tolerance that takes blocks which overlap by at most an amount [m], and the joints that it finds."""
    tolerance = rounded_up(deepest)
    if tolerance > WIDEST_TOLERANCE:
        return f"no tolerance up to {WIDEST_TOLERANCE:g} m takes them"
    joints = joints_within(tolerance)
    touching = {i for joint in joints for i in (joint.below, joint.above)}
    if loose := sum(i not in touching and not block.fixed for i, block in enumerate(blocks)):
        return f"with tolerance = {tolerance:g} m, which takes them, {loose} blocks have no joint: mend the file"
    lost = len(not_joined(blocks, joints, tolerance))
    narrow = SHORTEST_JOINT * tolerance
    text = f", and leaves {lost} pairs of near blocks without one, since joints are wider than {narrow:g} m"
    return f"tolerance = {tolerance:g} m takes them: it finds {len(joints)} joints{text if lost else ''}"


def rounded_up(value: float) -> float:
    """A positive value with two digits that is no less."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{digit * math.ceil(value / digit):.2g}")


def not_joined(blocks: Sequence[AnyBlock], joints: Sequence[Joint | SpaceJoint], tolerance: float) -> Integers:
    """Pairs of blocks whose bounds touch within a tolerance [m] and that have no joint, shape (pairs, 2)."""
    joined = {tuple(sorted((joint.below, joint.above))) for joint in joints}
    pairs = neighbours(blocks, tolerance)
    return pairs[[tuple(pair) not in joined for pair in pairs.tolist()]]


def nearly_joined(names: Sequence[str], gap: float, tolerance: float) -> str:
    """What is odd about joints of a file that only another gap finds [m], in words, empty where none are."""
    if not names:
        return ""
    text = f"{len(names)} pairs of blocks have no joint and lie less than {gap:g} m apart, such as {named(names)}; "
    if gap > tolerance:
        return f"{text}gap = {gap:g} m joins them"
    return (
        f"{text}their faces are no wider than {SHORTEST_JOINT:g} times the tolerance of {tolerance:g} m; gap = {gap:g} "
        "m in its place joins them"
    )


def along_lines(blocks: Sequence[AnyBlock], joints: Sequence[Joint | SpaceJoint], tolerance: float) -> list[Touch]:
    """Pairs of blocks that touch without a joint: an edge or a corner of one lies within a face of the other.

    The planes between them all have one normal then. Blocks that meet edge on edge, as bricks across a corner do, have
    several, and press on each other in none.
    """
    touches = []
    for i, j in not_joined(blocks, joints, tolerance).tolist():
        for solid, other_solid in product(blocks[i].solids, blocks[j].solids):
            if where := _touch(solid, other_solid, tolerance, blocks[i].in_space):
                touches.append(Touch(i, j, where))
                break
    return touches


def _touch(solid: Convex, other_solid: Convex, tolerance: float, in_space: bool) -> str:
    """Where two convex bodies touch without a common face, empty where they do not."""
    axes = np.concatenate([solid.normals, other_solid.normals, edge_separating_axes(solid, other_solid)])
    along, beside = solid.corners @ axes.T, other_solid.corners @ axes.T
    gap = np.maximum(beside.min(axis=0) - along.max(axis=0), along.min(axis=0) - beside.max(axis=0))
    if abs(gap.max()) > tolerance:
        return ""
    between = axes[gap > -SHORTEST_JOINT * tolerance]
    if np.abs(between @ between[0]).min() < ALIKE:
        return ""
    axis = int(gap.argmax())
    sense = 1 if along[:, axis].mean() > beside[:, axis].mean() else -1
    low, high = sense * along[:, axis], sense * beside[:, axis]
    fewest = min((low < low.min() + tolerance).sum(), (high > high.max() - tolerance).sum())
    return "at a corner" if in_space and fewest == 1 else "along a line"


def touches_text(touches: Sequence[Touch], names: Sequence[str]) -> str:
    """Blocks that touch without a joint, in words."""
    pairs = named([f"{names[touch.block]} and {names[touch.other]} touch {touch.where}" for touch in touches])
    return f"{pairs}; a joint takes faces: cut the edge or the corner back to a small face"


def smallest_gap(
    blocks: Sequence[AnyBlock], names: Sequence[str], loose: Sequence[int], joints_within: JointFinder, reach: float
) -> str:
    """The smallest gap of blocks that touch no other within a reach [m], and the one with which all would.

    Args:
        blocks, names: of the masonry.
        loose: numbers of blocks without a joint.
        joints_within: the joints that a gap gives.
        reach: the gap that gives them none.
    """
    low, high = (np.array([end(block.corners, axis=0) for block in blocks]) for end in (np.min, np.max))
    gaps = np.array([np.linalg.norm(np.maximum(0.0, np.maximum(low - high[i], low[i] - high)), axis=1) for i in loose])
    gaps[np.arange(len(loose)), loose] = np.inf
    row, neighbour = divmod(int(gaps.argmin()), len(blocks))
    pair = f"{names[loose[row]]} and {names[neighbour]}"
    touches = [touch for touch in along_lines(blocks, (), reach) if {touch.block, touch.other} & set(loose)]
    text = f"{touches_text(touches, names)}; " if touches else ""
    if set(loose) <= {i for touch in touches for i in (touch.block, touch.other)}:
        return text.removesuffix("; ")
    text += f"between the bounds of {pair} there are {gaps[row, neighbour]:.3g} m"
    needed = needed_gap(loose, joints_within, reach)
    if needed is None:
        return f"{text}, and no gap up to {WIDEST_TOLERANCE:g} m joins all of them"
    return f"{text}; gap = {needed:.2g} m joins all of them: it finds {len(joints_within(needed))} joints"


def needed_gap(loose: Sequence[int], joints_within: JointFinder, reach: float) -> float | None:
    """A gap of two digits with which blocks have a joint each [m], near the least one; None where none has."""

    def joins(gap: float) -> bool:
        return set(loose) <= {i for joint in joints_within(gap) for i in (joint.below, joint.above)}

    low = high = reach
    while not joins(high):
        if high >= WIDEST_TOLERANCE:
            return None
        low, high = high, min(2 * high, WIDEST_TOLERANCE)
    while high > TOLERANCE_FACTOR * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if joins(middle) else (middle, high)
    rounded = min(rounded_up(high), WIDEST_TOLERANCE)
    return rounded if joins(rounded) else high


def split_faces(joints: Sequence[Joint | SpaceJoint], blocks: Sequence[AnyBlock], names: Sequence[str]) -> str:
    """What is odd about the joints of blocks in space, in words, empty where nothing is.

    Two convex blocks have at most one face each that points at the other with one normal. Two joints of theirs with
    nearly the same normal are parts of a face that vertices off its plane have split.
    """
    normals = defaultdict(list)
    for joint in joints:
        if isinstance(joint, SpaceJoint) and len(blocks[joint.below].parts) == len(blocks[joint.above].parts) == 1:
            normals[joint.below, joint.above].append(joint.normal)
    split = []
    for pair, group in normals.items():
        if len(group) > 1 and (np.array(group) @ np.transpose(group) - np.eye(len(group))).max() > ALIKE:
            split.append(f"{names[pair[0]]} and {names[pair[1]]}")
    if not split:
        return ""
    return (
        f"{len(split)} pairs of blocks meet along a face that is split into parts which are nearly parallel, such as "
        f"{named(split)}: vertices lie off the planes of their faces; round them, or draw the faces plane"
    )
