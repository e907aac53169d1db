"""Ties in rocking theory: when one goes taut, yields or goes slack, and what it has yielded."""

from __future__ import annotations

from ..compiled import jitable
from ..problem.pulling import pulled
from .law import SLACK, TAUT, YIELDING, Law, Push, nystroem, pull_of

HALVINGS = 50
"""Halvings of a step in the search of the time at which a tie changes."""


@jitable
def change_of(law: Law, i: int, side: float, theta: float) -> int:
    """What tie i does at a rotation, other than what it does in this step; -1 where that is the same.

    A tie that yields goes on until the wall turns.
    """
    tie = pull_of(law, i)
    elastic = pulled(tie, theta, side)[0] - law.plastic[i]
    if law.doing[i] == SLACK:
        return TAUT if elastic > 0 else -1
    if law.doing[i] == TAUT:
        if elastic < 0:
            return SLACK
        if elastic * tie.stiffness > tie.strength:
            return YIELDING
    return -1


@jitable
def any_change(law: Law, side: float, theta: float) -> bool:
    """Whether any tie does something else at a rotation."""
    for i in range(len(law.ties)):  # noqa: SIM110, numba knows no any()
        if change_of(law, i, side, theta) >= 0:
            return True
    return False


@jitable
def until_change(law: Law, side: float, push: Push, theta: float, omega: float, h: float) -> float:
    """The time within a step after which a tie first does something else, from just after it; `h` where none does."""
    if len(law.ties) == 0 or not any_change(law, side, nystroem(law, side, push, theta, omega, h)[0]):
        return h
    low, high = 0.0, h
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if any_change(law, side, nystroem(law, side, push, theta, omega, middle)[0]):
            high = middle
        else:
            low = middle
    return high


@jitable
def take_changes(law: Law, side: float, theta: float, turned: bool) -> None:
    """Let every tie do what it does from here on. One that yields has yielded for good when the wall turns."""
    for i in range(len(law.ties)):
        if law.doing[i] == YIELDING and turned:
            tie = pull_of(law, i)
            law.plastic[i] = pulled(tie, theta, side)[0] - tie.strength / tie.stiffness
            law.doing[i] = TAUT
        else:
            change = change_of(law, i, side, theta)
            if change >= 0:
                law.doing[i] = change
