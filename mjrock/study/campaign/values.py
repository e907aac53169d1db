"""What a table of rows can hold, and the checksum of a row."""

from __future__ import annotations

import zlib
from collections.abc import Mapping

import numpy as np

from ...quantities import spelt

Value = str | int | float | None


def plain(value: object) -> Value:
    """A value as a table holds it: text, a 64-bit integer, a float or None; NaN becomes None, a truth value 0 or 1.
    ValueError for anything else."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None:
        return None
    if isinstance(value, str):
        if not value.isascii() and value.encode("utf-8", "ignore").decode() != value:
            raise ValueError(f"{table_text(value)} is text that UTF-8 cannot hold")
        return str(value)
    if isinstance(value, float):
        return None if value != value else float(value)
    if isinstance(value, int):
        if -(2**63) <= value < 2**63:
            return int(value)
        raise ValueError(f"{table_text(value)} is outside the valid range of an integer, -2**63 to 2**63 - 1")
    raise ValueError(f"{table_text(value)} is of type {type(value).__name__}, and a table holds text, numbers and None")


def table_text(value: object) -> str:
    """A value as short text that every table can hold."""
    text = value.encode("utf-8", "backslashreplace").decode() if isinstance(value, str) else spelt(value)
    return text if len(text) <= 200 else text[:200] + "..."


def checksum(row: Mapping[str, Value]) -> int:
    """The checksum of a row, whatever the order of its columns; a column that is None counts as one that is absent."""
    held = sorted((name, value) for name, value in row.items() if value is not None)
    return zlib.crc32(repr(held).encode())
