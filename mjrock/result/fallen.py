"""Which blocks of masonry fell, and when."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..problem.masonry.joints import Joint
from ..problem.masonry.joints_in_space import SpaceJoint
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Flags

LOST = 0.7
"""Opening of a joint, over its width, beyond which it holds no longer [-]: the blocks have turned by 45 degrees."""
DROPPED = 1.0
"""Drop of a centroid, over the largest distance of a corner from it, beyond which a block has fallen [-]."""


def fallen_blocks(masonry: Masonry, t: Array, lost: Flags, drop: Array) -> dict[str, float]:
    """When each block that fell did [s], by its name, the first first.

    Args:
        masonry: the masonry.
        t: times [s], shape (n,).
        lost: whether each joint has ceased to hold by then, shape (n, joints).
        drop: how far the centroid of each free block has dropped from rest [m], shape (n, bodies).
    """
    gone: dict[int, float] = {}
    for body, block in enumerate(masonry.free):
        late = np.flatnonzero(drop[:, body] / masonry.blocks[block].size > DROPPED)
        if late.size:
            gone[block] = float(t[late[0]])
    for step in np.flatnonzero(np.diff(lost.sum(axis=1), prepend=0)):
        held = [joint for joint, over in zip(masonry.joints, lost[step], strict=True) if not over]
        for block in _cut_off(masonry, held):
            gone[block] = min(gone.get(block, np.inf), float(t[step]))
    return {masonry.names[block]: gone[block] for block in sorted(gone, key=gone.__getitem__)}


def _cut_off(masonry: Masonry, held: Sequence[Joint | SpaceJoint]) -> list[int]:
    """Blocks that no joint in `held` connects with a fixed block."""
    pairs, count = [(joint.below, joint.above) for joint in held], len(masonry.blocks)
    graph = coo_array((np.ones(len(pairs)), np.reshape(pairs, (-1, 2)).T.astype(int)), shape=(count, count))
    labels = connected_components(graph, directed=False)[1]
    standing = {labels[i] for i, block in enumerate(masonry.blocks) if block.fixed}
    return [block for block in masonry.free if labels[block] not in standing]
