"""Displacement histories: of fixed blocks that move, and of what actuators drive."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..quantities import Array, Integers


class Supports(NamedTuple):
    """Displacement histories of fixed blocks, and where the blocks are.

    Args:
        t: times of the samples of all supports, one support after the other [s], shape (samples,).
        displacement: along the axes [m], shape (samples, d), linear in between.
        first: where the samples of each support begin, and where those of the last end, shape (s + 1,).
        moved, moving: displacement and velocity at the pose [m, m/s], shape (s, d).
    """

    t: Array
    displacement: Array
    first: Integers
    moved: Array
    moving: Array


def moving(histories: Sequence[tuple[Sequence[float], Array]], d: int) -> Supports:
    """Histories of displacement along d axes for compiled functions: times, and displacements of the shape (t, d)."""
    return Supports(
        np.concatenate([np.empty(0), *(t for t, _ in histories)]),
        np.concatenate([np.empty((0, d)), *(displacement for _, displacement in histories)]),
        np.cumsum([0, *(len(t) for t, _ in histories)]),
        np.zeros((len(histories), d)),
        np.zeros((len(histories), d)),
    )


@inlined
def support_place(supports: Supports, i: int, axis: int, t: float) -> float:
    """Displacement of support i along an axis, linear between its samples and constant beyond them [m]."""
    low, high = supports.first[i], supports.first[i + 1] - 1
    t = min(max(t, supports.t[low]), supports.t[high])
    while high - low > 1:
        middle = (low + high) // 2
        if supports.t[middle] <= t:
            low = middle
        else:
            high = middle
    share = (t - supports.t[low]) / (supports.t[high] - supports.t[low]) if high > low else 0.0
    place: float = (1 - share) * supports.displacement[low, axis] + share * supports.displacement[high, axis]
    return place


@inlined
def move_supports(supports: Supports, t: float, h: float) -> None:
    """Bring displacement and mean velocity of the supports up to date, after a step of length h."""
    for i in range(len(supports.moved)):
        for axis in range(supports.moved.shape[1]):
            place = support_place(supports, i, axis, t)
            supports.moving[i, axis] = (place - supports.moved[i, axis]) / h if h > 0 else 0.0
            supports.moved[i, axis] = place


def places(supports: Supports, t: float) -> Array:
    """Displacements of all supports at a time [m], shape (s, d)."""
    count, d = supports.moved.shape
    return np.array([[support_place(supports, i, axis, t) for axis in range(d)] for i in range(count)]).reshape(-1, d)


def velocity_changes(supports: Supports, t: float, until: float) -> Array:
    """Largest change of the velocity of each support, or of each drive of a jack, between two times [m/s], shape
    (supports,)."""
    changes, d = np.zeros(len(supports.moved)), supports.moved.shape[1]
    for i, (first, last) in enumerate(zip(supports.first[:-1], supports.first[1:], strict=True)):
        times = supports.t[first:last]
        low, high = np.searchsorted(times, (t, until), side="right")
        parts = slice(first + max(low - 1, 0), min(first + high + 1, last))
        rates = np.diff(supports.displacement[parts], axis=0) / np.diff(supports.t[parts])[:, None]
        standstill = np.zeros((int(low == 0 or high == len(times)), d))  # before and after its history
        changes[i] = np.linalg.norm(np.concatenate([rates, standstill]) - supports.moving[i], axis=1).max()
    return changes
