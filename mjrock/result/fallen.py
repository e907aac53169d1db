"""Which blocks of masonry fell, and when."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..geometry.graph import components, nearest_roots
from ..problem.masonry.histories import Support
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags, Integers

TOPPLED = 0.25 * np.pi
"""Tilt of a block beyond which it has fallen [rad]."""
DROPPED = 0.5
"""Drop of a block that nothing holds beyond which it has fallen, over its height at rest [-]."""
PARTED = 0.1
"""Gap between the faces of a joint where they are nearest, over its width, beyond which the joint holds nothing [-]."""


def fallen_blocks(masonry: Masonry, t: Array, parted: Flags, tilt: Array, drop: Array) -> dict[str, float]:
    """When each block that fell did [s], by its name, the first first.

    A block has fallen when, as the run ends, it is tilted by more than 45 degrees, or no joint that holds connects it
    with a fixed block and it lies lower than at rest by more than half its height. It fell when this became so for
    good.

    Args:
        masonry: the masonry.
        t: times [s], shape (n,).
        parted: whether the blocks of each joint have parted then, shape (n, joints).
        tilt: of each free block from rest [rad], shape (n, bodies).
        drop: how far the centroid of each free block lies below where its ground holds it at rest [m], (n, bodies).
    """
    heights = np.array([np.ptp(masonry.blocks[block].corners[:, -1]) for block in masonry.free])
    toppled, low = tilt > TOPPLED, drop > DROPPED * heights
    pairs, down, since = _pairs(masonry), np.ones(len(masonry.free), dtype=bool), np.full(len(masonry.free), np.inf)
    for n in reversed(range(len(t))):
        down &= toppled[n] | low[n]
        if not down.any():
            break
        if n == len(t) - 1 or (parted[n] != parted[n + 1]).any():
            loose = _cut_off(masonry, pairs[~parted[n]])
        down &= toppled[n] | loose
        since[down] = t[n]
    return in_order({masonry.names[block]: when for block, when in zip(masonry.free, since.tolist(), strict=True)})


def left_joints(masonry: Masonry, t: Array, off: Flags) -> dict[str, float]:
    """When each block that left its joints did [s]: it slid off, and none connects it with a fixed block any more.

    In MuJoCo faces have no end and blocks have no other contacts. So such a block moves as no masonry does, and
    it counts as fallen there.

    Args:
        masonry, t: as of `fallen_blocks`.
        off: whether one block of each joint has slid off the other then, shape (n, joints).
    """
    pairs, off = _pairs(masonry), np.logical_or.accumulate(off, axis=0)
    since = np.full(len(masonry.free), np.inf)
    for n in np.flatnonzero(np.diff(off.sum(axis=1), prepend=0)):
        loose = _cut_off(masonry, pairs[~off[n]])
        since[loose] = np.minimum(since[loose], t[n])
    return in_order({masonry.names[block]: when for block, when in zip(masonry.free, since.tolist(), strict=True)})


def below_everything(masonry: Masonry, supports: tuple[Support, ...], t: Array, drop: Array) -> list[str]:
    """Names of the blocks that lie below all fixed blocks in the end, as those that fall past the edge of the ground.

    Args:
        masonry: the masonry.
        supports: that move fixed blocks.
        t: times [s], shape (n,).
        drop: how far the centroid of each free block lies below where it was at rest [m], shape (n, bodies).
    """
    moved = {support.block: float(support.at(t[-1:])[0, -1]) for support in supports}
    fixed = [(masonry.names[i], block.corners[:, -1].min()) for i, block in enumerate(masonry.blocks) if block.fixed]
    lowest = min(low + moved.get(name, 0.0) for name, low in fixed)
    heights = masonry.centroids[list(masonry.free), -1] - drop[-1]
    return [masonry.names[block] for block, height in zip(masonry.free, heights, strict=True) if height < lowest]


def in_order(when: Mapping[str, float]) -> dict[str, float]:
    """The finite times, the first first."""
    return {name: when[name] for name in sorted(when, key=when.__getitem__) if np.isfinite(when[name])}


def sunk_ground(masonry: Masonry, supports: tuple[Support, ...], t: Array) -> Array:
    """How far the ground of each free block has sunk [m], shape (n, bodies): the fixed block that the fewest joints
    part it from."""
    fixed = [i for i, block in enumerate(masonry.blocks) if block.fixed]
    nearest = nearest_roots(_pairs(masonry), len(masonry.blocks), fixed)
    sunk = {masonry.names.index(support.block): -support.at(t)[:, -1] for support in supports}
    still = np.zeros(len(t))
    return np.stack([sunk.get(ground, still) for ground in nearest[list(masonry.free)].tolist()], axis=1)


def _pairs(masonry: Masonry) -> Integers:
    """The two blocks of each joint, shape (joints, 2)."""
    return np.array([(joint.below, joint.above) for joint in masonry.joints])


def _cut_off(masonry: Masonry, pairs: Integers) -> Flags:
    """Which free blocks no joint connects with a fixed block, shape (bodies,), from the pairs that a joint holds."""
    labels = components(pairs, len(masonry.blocks))
    standing = {labels[i] for i, block in enumerate(masonry.blocks) if block.fixed}
    return ~np.isin(labels[list(masonry.free)], list(standing))
