"""Elongation of ties on masonry in space, from the poses of the blocks at both ends."""

from __future__ import annotations

import numpy as np

from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import laden
from ..problem.masonry.effects_in_space import anchored_at, held_at
from ..problem.wall.effects import Tie
from ..quantities import Array


def elongation_in_space(case: MasonryCase, tie: Tie, pose: Array) -> Array:
    """How much longer than its slack length a tie is at poses of shape (n, bodies, 7) [m], negative where slack."""
    held, anchor = held_at(tie), anchored_at(tie)
    across = held - anchor + _displaced(case, tie.block, held, pose)
    if tie.anchor_block is not None:
        across = across - _displaced(case, tie.anchor_block, anchor, pose)
    return np.asarray(np.linalg.norm(across, axis=1) - tie.reach)


def _displaced(case: MasonryCase, block: int, point: Array, pose: Array) -> Array:
    """Displacement of a point of a block from rest [m], zero of a fixed one, shape (n, 3)."""
    free = case.masonry.free
    if block not in free:
        return np.zeros((len(pose), 3))
    moved = pose[:, free.index(block)]
    w, v, arm = moved[:, 3:4], moved[:, 4:], point - laden(case.masonry, case.effects)[1][block]
    # (R - 1) r = 2 w v x r + 2 v x (v x r)
    turned = np.cross(v, np.broadcast_to(arm, v.shape))
    return np.asarray(moved[:, :3] + 2 * w * turned + 2 * np.cross(v, turned))
