"""Pairs of blocks that have no joint: friction and damping where they meet, as they are given."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import NamedTuple

from ....quantities import require_kind, shown
from .dry import Dry

OfPair = Callable[[str, str], Dry | None]
"""A function of the names of two blocks, in their order, that gives what they have where they meet, or None."""
AnyPairs = Dry | OfPair | None
"""What all pairs of blocks without a joint have, a function of two blocks, or None."""
RUBBING = ("friction", "xi", "frequency")
"""Fields of a `Dry` that count for a pair. Its springs follow from the joints of its blocks."""


class Meets(NamedTuple):
    """What two blocks have where they meet: friction [-], and dashpot over spring, c/k [s]."""

    friction: float
    retardation: float


def required_pairs(pairs: AnyPairs) -> AnyPairs:
    """What pairs have, checked where it is one for all.

    Raises:
        TypeError, ValueError: for another kind, or springs.
    """
    return pairs if callable(pairs) else _rubbing("pairs", pairs)


def asked_pair(pairs: AnyPairs, one: str, other: str) -> Dry | None:
    """What is given for two blocks by their names, or None.

    Raises:
        TypeError, ValueError: with their names, for another kind, or springs.
    """
    if not callable(pairs):
        return pairs
    try:
        given = pairs(one, other)
    except TypeError as error:
        raise TypeError(f"pairs = {shown(pairs)} is not called as pairs(one, other): {error}") from None
    return _rubbing(f"pairs of {one} and {other}", given)


def _rubbing(name: str, dry: Dry | None) -> Dry | None:
    """A joint of which friction and damping alone are given, or None."""
    require_kind(name, dry, Dry, type(None))
    if dry is not None:
        odd = [
            each.name for each in fields(dry) if each.name not in RUBBING and getattr(dry, each.name) != each.default
        ]
        if odd:
            raise ValueError(
                f"{name} has {', '.join(odd)}; {', '.join(RUBBING)} are taken: the springs of two blocks without a "
                "joint follow from those of their own joints"
            )
    return dry
