"""The acceleration of gravity, and types of arrays and checks of arguments: those of contacts, and further ones."""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Callable, Collection, Sequence
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .contacts.checks import (  # passed on to the rest of the package
    MOST_SAMPLES, NAMED, Array, Flags, Integers, Message, P, Result, Within, alternatives, brief, declared,
    is_iterable, keep, keep_declared, listed, named, reason, require_array, require_flag, require_kind,
    require_plain, require_real, require_reals, require_row, require_size, require_text, require_whole,
    require_within, short_repr, shown, spelt, warn_of, within_ranges,
)  # fmt: skip

GRAVITY = 9.81
"""Acceleration of gravity [m/s2], in every solver and in the generated model."""

ON_ITS_FACE = math.pi / 2
"""Rotation up to which a body is followed [rad]. It has overturned and lies on its face."""

Real = TypeVar("Real", float, Array)


class Implausible(UserWarning):
    """A possible value that is usually an error of unit, or belongs to another wall."""


def ratio_text(ratio: float) -> str:
    """Capacity over demand with two decimals, cut off and not rounded, so that none below one reads as one."""
    cut = math.floor(100 * ratio + 1e-9) if ratio <= 99 else 9900
    return "> 99" if ratio > 99 else f"{(min(cut, 99) if ratio < 1 else cut) / 100:.2f}"


def share_text(share: float) -> str:
    """Demand over capacity with two decimals, rounded up, so that none above one reads as one."""
    if math.isinf(share):
        return "inf"
    up = math.ceil(100 * share - 1e-9)
    return f"{(max(up, 101) if share > 1 else up) / 100:.2f}"


def percent_text(share: float) -> str:
    """A part of a whole in percent: only all of it reads as 100%, and only nothing as 0%."""
    if 0 < share < 0.01:
        return "<1%"
    return ">99%" if 0.99 < share < 1 else f"{share:.0%}"


Stiffness = Annotated[float, Within(1e4, 1e14, "N/m3")]
"""Stiffness of an interface or a joint."""

Density = Annotated[float, Within(100, 30_000, "kg/m3")]
"""Mass density of stone, brick or earth, and of what is heavier."""


def require_sample_count(count: float) -> None:
    """Raise a ValueError for more samples of an answer, over all bodies, than fit into memory."""
    require_size("the samples of this answer", count, "raise output_step, or shorten the duration")


def require_stiffness(name: str, value: object) -> float:
    """Return the stiffness of an interface as a float, see `Stiffness` and `require_within`."""
    within: Within = get_args(Stiffness)[1]
    return within.checked(name, value)


class OneOf(NamedTuple):
    """The texts that a field or an argument may be, declared with it: `plumb: Annotated[str, OneOf(PLUMB)]`.

    Args:
        known: the texts, or a function that gives them.
    """

    known: Collection[str] | Callable[[], Collection[str]]

    @property
    def texts(self) -> tuple[str, ...]:
        """The texts."""
        return tuple(self.known() if callable(self.known) else self.known)


def require_one_of(name: str, value: object, known: Collection[str]) -> str:
    """Return `value`, one of the names that are known; a ValueError lists them for any other value."""
    if not isinstance(value, str) or value not in known:
        values = {"name": name, "value": brief(value), "known": ", ".join(known)}
        raise ValueError(Message("{name} = {value} is not one of {known}", **values))
    return value


def takes(value: object, count: int) -> bool:
    """Whether a value is a function that takes a given number of positional arguments."""
    if not callable(value):
        return False
    try:
        inspect.signature(value).bind(*range(count))
    except TypeError:
        return False
    except ValueError:  # some built-in functions have no signature
        return True
    return True


def require_sequence(name: str, value: object, expected: str) -> None:
    """Check a sequence.

    Args:
        name: what it is called.
        value: the sequence.
        expected: what it should be, in words.

    Raises:
        TypeError: unless it is a sequence and no text, with as many values as its length, at most MOST_LISTED.
    """
    if not isinstance(value, Sequence) or isinstance(value, str):
        raise TypeError(f"{name} = {shown(value)} is not {expected}")
    if len(listed(name, value)) != len(value):
        raise TypeError(
            f"{name} = {shown(value)} is not {expected}: its length is {len(value)}, and it has other values"
        )


def require_path(name: str, path: object) -> Path:
    """Return `path` as a Path.

    Raises:
        TypeError: unless it is a text or a path.
        ValueError: if it is empty, or no name that a file can have.
    """
    require_kind(name, path, str, PathLike)
    text = os.fspath(path)  # type: ignore[call-overload]
    require_kind(name, text, str)
    try:
        encoded = os.fsencode(text)
    except UnicodeError:
        encoded = b"\0"
    if not encoded or b"\0" in encoded:
        raise ValueError(f"{name} = {shown(path)} is empty, or holds characters that no path has")
    return Path(text)


def require_increasing(name: str, values: ArrayLike, element: str, high: float, valid: str) -> Array:
    """Return a copy of `values` as a row of increasing numbers from 0 to `high`, see `require_row`.

    Raises:
        TypeError, ValueError: as `require_row`; with the `valid` range in words, unless they increase within it.
    """
    row = require_row(name, values, element)
    if not (row[0] >= 0 and row[-1] <= high and (np.diff(row) > 0).all()):
        raise ValueError(f"{name} = {shown(values)} has to increase within the valid range {valid}")
    return row


def frozen(values: ArrayLike) -> NDArray[Any]:
    """A copy, as an array, that cannot be written to."""
    array = np.array(values)
    array.setflags(write=False)
    return array
