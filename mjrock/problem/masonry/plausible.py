"""What is odd about a case of masonry: what is odd about that of a wall, asked of many blocks."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ..wall.plausible import IN_G, Whole, of_effects, of_motion
from ..wall.tie import Tie
from .collapse import limit_of, pushed
from .effects import held_at
from .masonry import Masonry
from .statics import falling

FEW = 40
"""Most free blocks of which the acceleration that they stand is looked for to judge a record: a second of time."""


def doubts(case: Any) -> list[str]:
    """What is odd about a `mjrock.MasonryCase`, in words; empty for a plausible one."""
    masonry = case.masonry
    mass = sum(masonry.blocks[i].mass for i in masonry.free)
    found = of_motion(case.motion, case.duration, "masonry", stood(case))
    return found + of_effects(case.effects, Whole("masonry", "its block", mass), lambda tie: _room(masonry, tie))


def stood(case: Any) -> float:
    """Acceleration over g that the masonry of a case stands from rest, for a record that may be in g, or infinity."""
    weak = case.motion is not None and case.motion.peak <= IN_G and len(case.masonry.free) <= FEW
    at_rest = case.velocity is None and case.vertical is None and not case.effects
    return _multiplier(case.masonry) if weak and at_rest else math.inf


@lru_cache(maxsize=16)
def _multiplier(masonry: Masonry) -> float:
    if falling(masonry):  # it cannot stand, which the solvers say
        return math.inf
    ways = np.eye(3 if masonry.in_space else 2)[0] * [[1.0], [-1.0]]
    return min(limit_of(masonry, way, pushed(masonry, way)).multiplier for way in ways)


def _room(masonry: Masonry, tie: Tie) -> tuple[float, float]:
    """Largest extent of the block that a tie holds, and of all free blocks along the tie [m]."""
    held = np.zeros(2) if tie.at is None else held_at(tie)
    way = held - tie.anchor_of(held)
    along = np.concatenate([masonry.blocks[i].corners for i in masonry.free]) @ (way / np.linalg.norm(way))
    return 2 * masonry.blocks[tie.block].size, float(np.ptp(along))
