"""Rows: tables of numbers by name, for compiled functions, which read and write a number as an attribute of its row."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .quantities import Array, Flags, Integers

Rows = NDArray[np.void]
Row = Any
"""One of the rows; its numbers are attributes."""
Fields = list[Any]
"""Names of numbers, and of vectors with how many numbers they have."""


def row_type(fields: Fields) -> np.dtype[np.void]:
    """The type of rows with these numbers and vectors."""
    return np.dtype((np.record, fields))


def numbers(*names: str) -> Fields:
    """Numbers of a row."""
    return [(name, float) for name in names]


def integers(*names: str) -> Fields:
    """Integers of a row."""
    return [(name, np.int64) for name in names]


def short_integers(*names: str) -> Fields:
    """Integers of a row that take half the room of a number. There is an even number of them side by side."""
    return [(name, np.int32) for name in names]


def flags(*names: str) -> Fields:
    """What is true or false of a row."""
    return [(name, np.bool_) for name in names]


def vectors(size: int, *names: str) -> Fields:
    """Vectors of a row, of some size."""
    return [(name, float, (size,)) for name in names]


def rows(kind: np.dtype[np.void], count: int, **columns: Array | Integers | float) -> Rows:
    """Rows with these columns, and zeros in the others. Their numbers are attributes, and columns are plain arrays."""
    table = np.zeros(count, dtype=kind)
    for name, values in columns.items():
        table[name] = values
    return table


def joined(*tables: Rows) -> Rows:
    """Rows of one kind, one table after the other. numpy joins bytes faster than columns."""
    joint = np.concatenate([as_bytes(table) for table in tables])
    return joint.reshape(-1).view(tables[0].dtype)


def chosen(table: Rows, selection: Integers | Flags) -> Rows:
    """Some of the rows. numpy takes bytes faster than columns."""
    return as_bytes(table)[selection].reshape(-1).view(table.dtype)


def unsound(table: Rows, endless: tuple[str, ...] = ()) -> Integers:
    """Numbers of the rows with a number that is not finite. Numbers named in `endless` may be infinite, and not NaN."""
    words = as_bytes(table).view(float)
    if np.isfinite(words).all():
        return np.zeros(0, dtype=np.int64)
    finite, infinite = _words(table.dtype, endless)
    sound = np.isfinite(words[:, finite]).all(axis=1) & ~np.isnan(words[:, infinite]).any(axis=1)
    return np.flatnonzero(~sound)


@lru_cache
def _words(kind: np.dtype[np.void], names: tuple[str, ...]) -> tuple[Flags, Flags]:
    """Which words of a row are numbers that must be finite, and which may be infinite. The others are integers."""
    finite, endless = np.zeros((2, kind.itemsize // 8), dtype=bool)
    for name, (part_type, offset, *_) in (kind.fields or {}).items():
        if part_type.base == np.float64:
            (endless if name in names else finite)[offset // 8 : (offset + part_type.itemsize) // 8] = True
    return finite, endless


def as_bytes(table: Rows) -> NDArray[np.uint8]:
    """The bytes of each row."""
    return np.ascontiguousarray(table).view(np.uint8).reshape(len(table), table.dtype.itemsize)
