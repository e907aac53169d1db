"""Colours of the blocks of masonry, wherever they are drawn as bodies."""

from __future__ import annotations

from collections.abc import Iterable

BRICKS = (
    (0.70, 0.33, 0.23),
    (0.79, 0.47, 0.33),
    (0.60, 0.27, 0.19),
    (0.74, 0.40, 0.25),
    (0.65, 0.36, 0.29),
    (0.83, 0.53, 0.40),
)
"""Red, green and blue, 0 to 1 as a screen shows them."""


def told_apart(count: int, touching: Iterable[tuple[int, int]], tints: int = len(BRICKS)) -> list[int]:
    """The number of the tint of each body, another one than those of the bodies that touch it.

    Where a body touches bodies of all tints, it has one of theirs.

    Args:
        count: of the bodies.
        touching: pairs of numbers of bodies.
        tints: how many there are.
    """
    near: list[set[int]] = [set() for _ in range(count)]
    for one, other in touching:
        near[one].add(other)
        near[other].add(one)
    chosen: list[int] = []
    for j, neighbours in enumerate(near):
        taken = {chosen[i] for i in neighbours if i < j}
        order = [(j + k) % tints for k in range(tints)]
        chosen.append(next((tint for tint in order if tint not in taken), order[0]))
    return chosen
