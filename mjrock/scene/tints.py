"""Colours of the blocks of masonry, wherever they are drawn."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..problem.wall.rest_geometry import RestGeometry
from ..quantities import Array

TINTS = (
    (0.88, 0.69, 0.56),
    (0.75, 0.50, 0.37),
    (0.93, 0.79, 0.69),
    (0.82, 0.61, 0.47),
    (0.69, 0.44, 0.33),
    (0.86, 0.64, 0.52),
)
"""Red, green and blue of blocks, 0 to 1 as a screen shows them: fired clay, pale enough for forces to be drawn over."""
FIXED_COLOUR = (0.75, 0.75, 0.75)
"""The same of what is fixed."""
GOLDEN = 0.5 * (5**0.5 - 1)
"""Step around a circle of tints from block to block, over the circle: it gives tints that are far apart [-]."""


def distinct_tints(count: int, touching: Iterable[tuple[int, int]]) -> list[int]:
    """The number of the tint of each body, another one than those of the bodies that touch it.

    Where a body touches bodies of all tints, it has one of theirs.

    Args:
        count: of the bodies.
        touching: pairs of numbers of bodies.
    """
    neighbours_of: list[set[int]] = [set() for _ in range(count)]
    for body, neighbour in touching:
        neighbours_of[body].add(neighbour)
        neighbours_of[neighbour].add(body)
    chosen: list[int] = []
    for j, neighbours in enumerate(neighbours_of):
        used, first = {chosen[i] for i in neighbours if i < j}, int(len(TINTS) * (j * GOLDEN % 1))
        order = [(first + k) % len(TINTS) for k in range(len(TINTS))]
        chosen.append(next((tint for tint in order if tint not in used), first))
    return chosen


def colours_of(geometry: RestGeometry) -> Array:
    """Red, green and blue of each solid, 0 to 1, shape (solids, 3)."""
    body = [solid.body for solid in geometry.solids]
    pairs = ((body[joint.below], body[joint.above]) for joint in geometry.joints)
    numbers = distinct_tints(max(body) + 1, (pair for pair in pairs if min(pair) >= 0))
    return np.array([FIXED_COLOUR if number < 0 else TINTS[numbers[number]] for number in body])
