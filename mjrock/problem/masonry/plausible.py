"""What is odd about a case of masonry: what is odd about that of a wall, asked of many blocks."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ...quantities import GRAVITY, Array
from ..wall.effect import Anchored
from ..wall.plausible import IN_G, NEGLIGIBLE_SHARE, Whole, of_effects, of_motion
from .actuator import Actuator
from .effects import held_at
from .limit.collapse import limit_of, pushed
from .masonry import Masonry

JUDGED_BLOCKS = 40
"""Most free blocks of which the acceleration that they stand is looked for to judge a record: a second of time."""
OF_THE_WEIGHT = 3.0
"""Force of an actuator at its full displacement over the weight, up to which its spring may be a force that is given,
and the displacement no motion [-]."""


def doubts(case: Any) -> list[str]:
    """What is odd about a `mjrock.MasonryCase`, in words; empty for a plausible one."""
    masonry = case.masonry
    mass = sum(masonry.blocks[i].mass for i in masonry.free)
    found = of_motion(case.motion, case.duration, "masonry", stood(case))
    found += of_effects(case.effects, Whole("masonry", "its block", mass), lambda link: _room(masonry, link))
    return found + [odd for name, jack in case.actuators.items() if (odd := _of_jack(name, jack, masonry, mass))]


def stood(case: Any) -> float:
    """Acceleration over g that the masonry of a case stands from rest, for a record that may be in g, or infinity."""
    weak = case.motion is not None and case.motion.peak <= IN_G and len(case.masonry.free) <= JUDGED_BLOCKS
    at_rest = case.velocity is None and case.vertical is None and not case.effects
    return _multiplier(case.masonry) if weak and at_rest else math.inf


@lru_cache(maxsize=16)
def _multiplier(masonry: Masonry) -> float:
    ways = np.eye(3 if masonry.in_space else 2)[0] * [[1.0], [-1.0]]
    try:
        return min(limit_of(masonry, way, pushed(masonry, way)).multiplier for way in ways)
    except ValueError:  # it cannot stand, which the solvers say
        return math.inf


def _room(masonry: Masonry, link: Anchored) -> tuple[float, float]:
    """Largest extent of the block that a link holds, and of all free blocks along the link [m]."""
    held = np.zeros(2) if link.at is None else held_at(link)
    way = held - link.anchor_of(held)
    return 2 * masonry.blocks[link.block].size, _extent(masonry, way / np.linalg.norm(way))


def _extent(masonry: Masonry, way: Array) -> float:
    """Extent of all free blocks along a unit vector [m]."""
    return float(np.ptp(np.concatenate([masonry.blocks[i].corners for i in masonry.free]) @ way))


def _of_jack(name: str, jack: Actuator, masonry: Masonry, mass: float) -> str:
    """A doubt about an actuator, empty where there is none."""
    far, extent = max(map(abs, jack.displacement[1])), _extent(masonry, jack.way)
    if far > extent and jack.stiffness * far > OF_THE_WEIGHT * mass * GRAVITY:
        return f"{name}: displacement reaches {far:g} m, and the masonry is {extent:.3g} m long there: is it in mm?"
    if 0 < jack.stiffness * far < NEGLIGIBLE_SHARE * mass * GRAVITY:
        return (
            f"{name}: stiffness = {jack.stiffness:g} N/m pushes with at most {jack.stiffness * far:.3g} N, and the "
            f"masonry weighs {mass * GRAVITY:.3g} N: is it in N/m?"
        )
    return ""
