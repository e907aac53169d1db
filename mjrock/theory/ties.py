"""Ties in rocking theory: when one goes taut, yields, breaks or goes slack, and what it has yielded."""

from __future__ import annotations

from ..compiled import jitable
from ..problem.wall.ties_on_wall import pulled
from .law import BROKEN, SLACK, TAUT, YIELDING, Push, Ties, Toe, nystroem, pull_of

HALVINGS = 50
"""Halvings of a step in the search of the time at which a tie changes."""


@jitable
def change_of(toe: Toe, ties: Ties, i: int, theta: float) -> int:
    """What tie i does at a rotation, other than what it does in this step; -1 where that is the same.

    A tie that yields goes on until the wall turns or it breaks, and one that has broken stays so.
    """
    if ties.doing[i] == BROKEN:
        return -1
    tie = pull_of(ties, i)
    elastic = pulled(tie, theta, toe.side)[0] - ties.plastic[i]
    if ties.doing[i] == SLACK:
        return TAUT if elastic > 0 else -1
    if ties.doing[i] == TAUT:
        if elastic < 0:
            return SLACK
        if elastic * tie.stiffness > tie.strength:
            return YIELDING
    if ties.doing[i] == YIELDING:
        drawn = pulled(tie, theta, toe.side)[0] - tie.strength / tie.stiffness
        if drawn > tie.ultimate:
            return BROKEN
    return -1


@jitable
def any_change(toe: Toe, ties: Ties, theta: float) -> bool:
    """Whether any tie does something else at a rotation."""
    for i in range(len(ties.doing)):  # noqa: SIM110, numba knows no any()
        if change_of(toe, ties, i, theta) >= 0:
            return True
    return False


@jitable
def until_change(toe: Toe, ties: Ties, push: Push, theta: float, omega: float, h: float) -> float:
    """The time within a step after which a tie first does something else, from just after it; `h` where none does."""
    if len(ties.doing) == 0 or not any_change(toe, ties, nystroem(toe, ties, push, theta, omega, h)[0]):
        return h
    low, high = 0.0, h
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if any_change(toe, ties, nystroem(toe, ties, push, theta, omega, middle)[0]):
            high = middle
        else:
            low = middle
    return high


@jitable
def take_changes(toe: Toe, ties: Ties, theta: float, turned: bool) -> None:
    """Let every tie do what it does from here on. One that yields has yielded for good when the wall turns."""
    for i in range(len(ties.doing)):
        change = change_of(toe, ties, i, theta)
        if change >= 0:
            ties.doing[i] = change
        elif ties.doing[i] == YIELDING and turned:
            tie = pull_of(ties, i)
            ties.plastic[i] = pulled(tie, theta, toe.side)[0] - tie.strength / tie.stiffness
            ties.doing[i] = TAUT
