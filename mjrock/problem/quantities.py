"""What every module shares: the acceleration of gravity, and checks of what is given against what can be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real as RealNumber
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

GRAVITY = 9.81
"""Acceleration of gravity [m/s2], in every solver and in the generated model."""

ON_ITS_FACE = math.pi / 2
"""Rotation up to which a body is followed [rad]. It has overturned and lies on its face."""

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]
Real = TypeVar("Real", float, Array)


MOST_SAMPLES = 50_000_000
"""Most samples or fixed steps of one answer: some gigabytes."""


def shown(value: object) -> str:
    """A value and its type, short enough for a message."""
    text = repr(value)
    return f"{text[:60]}{'...' if len(text) > 60 else ''} of type {type(value).__name__}"


def require_real(name: str, value: object) -> float:
    """Return `value` as a float.

    Raises:
        TypeError: with the name and the value, unless it is a real number. True and False are none.
        ValueError: if it is too large for a float.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, RealNumber):
        raise TypeError(f"{name} = {shown(value)} is not a real number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{name} is an integer of {value.bit_length()} bits, beyond any valid range") from None  # type: ignore[attr-defined]


def require_within(name: str, value: object, low: float, high: float, unit: str = "") -> float:
    """Return `value` as a float.

    Raises:
        TypeError: unless it is a real number.
        ValueError: with the value and the range, unless the value lies within [low, high]. NaN never does.
    """
    number = require_real(name, value)
    if not low <= number <= high:
        unit = unit and f" {unit}"
        raise ValueError(f"{name} = {number:g}{unit} is outside the valid range {low:g} to {high:g}{unit}")
    return number


def require_stiffness(name: str, value: object) -> float:
    """Return an interface stiffness as a float; it is within 1e4 to 1e14 N/m3, see `require_within`."""
    return require_within(name, value, 1e4, 1e14, "N/m3")


def require_whole(name: str, value: object, low: int, high: int) -> int:
    """Return `value` as an integer.

    Raises:
        TypeError: unless it is a real number.
        ValueError: with the value and the range, unless it is a whole number within [low, high].
    """
    number = require_within(name, value, low, high)
    if number != int(number):
        raise ValueError(f"{name} = {number:g} is not a whole number; the valid range is {low} to {high}")
    return int(number)


def require_kind(name: str, value: object, *kinds: type) -> None:
    """Raise a TypeError that names the value and what is needed, unless it is of one of these types."""
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        needed = " or ".join(kind.__name__ for kind in kinds)
        raise TypeError(f"{name} = {shown(value)} is not a {needed}")


def require_flag(name: str, value: object) -> None:
    """Raise a TypeError unless the value is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name} = {shown(value)} is neither True nor False")


def require_size(what: str, count: float, remedy: str) -> None:
    """Raise a ValueError that says the number and what to change, if there are more samples than MOST_SAMPLES."""
    if not count <= MOST_SAMPLES:
        raise ValueError(f"{what} would be {count:.3g}; at most {MOST_SAMPLES:.0e} fit into memory; {remedy}")


def require_array(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """Return `value` as an array of finite numbers.

    Raises:
        TypeError: if it is no array of real numbers.
        ValueError: if it has another shape, or a value that is not finite.
    """
    try:
        made = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} = {shown(value)} is no array of real numbers") from None
    if made.shape != shape:
        raise ValueError(f"{name} has the shape {made.shape}; {shape} is needed")
    if not np.isfinite(made).all():
        raise ValueError(f"{name} holds a value that is not finite")
    return made


NAMED = 5
"""Most things that a message names."""


def named(names: Sequence[str]) -> str:
    """Names in a message, not too many."""
    rest = len(names) - NAMED
    return ", ".join(names[:NAMED]) + (f" and {rest} more" if rest > 0 else "")
