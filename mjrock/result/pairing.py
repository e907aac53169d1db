"""Impacts of two motions that belong to each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..quantities import Array, Integers
from .rocking import Impact

FAINT = 0.01
"""Energy before an impact under ground motion that is too small to be paired, over that which overturns the wall
[-]."""
TOGETHER = 0.25
"""How far apart in time two impacts may be that belong to each other, times p of the wall [-]."""


def paired(left: Sequence[Impact], right: Sequence[Impact], within: float, least: float) -> Integers:
    """Numbers of the impacts of two motions that belong to each other, -1 where one has none, shape (n, 2).

    Two impacts are a pair where each is the nearest to the other in time, `within` [s] of it. Those are left out before
    which the wall has less energy than `least` [J]. All are in the order of their times.
    """
    kept = [[i for i, impact in enumerate(side) if impact.energy_before >= least] for side in (left, right)]
    a, b = (np.array([side[i].t for i in own]) for side, own in zip((left, right), kept, strict=True))
    pairs, alone = [], set(range(len(b)))
    for i, t in enumerate(a):
        j = int(np.abs(b - t).argmin()) if len(b) else -1
        if j >= 0 and abs(b[j] - t) <= within and int(np.abs(a - b[j]).argmin()) == i:
            pairs.append((t, kept[0][i], kept[1][j]))
            alone.discard(j)
        else:
            pairs.append((t, kept[0][i], -1))
    pairs += [(b[j], -1, kept[1][j]) for j in alone]
    return np.array([numbers for _, *numbers in sorted(pairs)], dtype=np.int64).reshape(-1, 2)


def taken_by(numbers: Integers, left: Sequence[float] | Array, right: Sequence[float] | Array) -> Array:
    """Values of the impacts of each pair, NaN where there is none, shape (n, 2)."""
    sides = zip(numbers.T, (left, right), strict=True)
    columns = [[values[i] if 0 <= i < len(values) else np.nan for i in own] for own, values in sides]
    return np.array(columns, dtype=float).T.reshape(-1, 2)
