"""Loose blocks: the longest step with which one that has no joint is stable on its springs.

The step of a run is found from the joints at rest, which loose blocks do not have. Each is taken here with the springs
that it has on one of its sides, twice over, as a block between two others.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...problem.wall.standing import Solid
from ...quantities import Array
from ..limit import longest_step
from ..rows import chosen, joined, rows
from ..system import System
from .pair_law import SHARED, PairLaw, part_of_face, side_area

SIDES = 2.0
"""On how many others a block lies at once."""


def longest_step_of_loose(solids: Sequence[Solid], law: PairLaw, system: System) -> float:
    """The longest stable step [s] of loose blocks on their springs, infinite where there are none."""
    tables, kept, in_space = [rows(system.lines.dtype, 0)], list[int](), len(system.axes) == 3
    for i in np.flatnonzero(law.loose & ~law.fixed).tolist():
        solid = solids[i]
        centroid = solid.rest if in_space else solid.rest[::2]
        for corners, normal, shared in _springs(solid, law.of_block[0][i]):
            columns = dict(zip(SHARED, shared, strict=True))
            ends: dict[str, Any] = {"body": len(kept), "face": -1, "at": corners - centroid, "normal": -normal}
            tables.append(rows(system.lines.dtype, len(corners), **ends, **columns))
            kept.append(solid.body)
    if not kept:
        return math.inf
    return longest_step(system._replace(bodies=chosen(system.bodies, np.array(kept)), lines=joined(*tables), links=()))


def _springs(solid: Solid, shared: Array) -> list[tuple[Array, Array, Array]]:
    """The corners of each side of a loose block [m], its normal, and the springs and dashpots that each corner has."""
    springs = []
    for side in solid.sides:
        over = np.array([side_area(side) / shared[-1]])
        part = SIDES * float(part_of_face(over)[0]) / len(side.corners)
        springs.append((np.asarray(side.corners), np.asarray(side.normal), part * shared[:-1]))
    return springs
