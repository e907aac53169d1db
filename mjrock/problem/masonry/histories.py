"""Histories of what is driven: numbers at increasing times, linear in between and constant after the last."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...quantities import Array, require_increasing, require_row, require_within, shown

LONGEST = 1e6
"""Latest time of a history [s]."""

History = tuple[tuple[float, ...], tuple[float, ...]]
"""Times [s] and values."""


def require_as_many(name: str, rows: Mapping[str, Array]) -> None:
    """Raise ValueError with the name unless these rows have as many values, see `require_row`."""
    lengths = [len(row) for row in rows.values()]
    if len(set(lengths)) > 1:
        counts = f"{', '.join(map(str, lengths[:-1]))} and {lengths[-1]}"
        raise ValueError(f"{name}: {', '.join(rows)} have {counts} values; give as many")


def history_of(name: str, given: Any, largest: float, unit: str, *, from_zero: bool = False) -> History:
    """A history from (t, values).

    Args:
        name: what it is called.
        given: times and values, as many.
        largest: of the values, either way.
        unit: of the values.
        from_zero: whether the first value has to be zero.

    Raises:
        TypeError, ValueError: with the name, unless it is two rows of as many finite numbers, the times increase from
            zero and the values are in their range.
    """
    if not isinstance(given, list | tuple) or len(given) != 2:
        raise TypeError(f"{name} = {shown(given)} is not (t, values), two rows of numbers")
    t = require_increasing(f"{name}, t", given[0], "time", LONGEST, f"0 to {LONGEST:g} s")
    values = require_row(f"{name}, values", given[1], "number")
    require_as_many(name, {"t": t, "values": values})
    if t[0] != 0:
        raise ValueError(f"{name}: t begins at {t[0]:g} s; the valid start is 0 s")
    if from_zero and values[0] != 0:
        raise ValueError(f"{name} begins at {values[0]:g} {unit}; the valid start is 0 {unit}, where nothing is driven")
    require_within(f"{name}, values", float(values[np.abs(values).argmax()]), -largest, largest, unit)
    return tuple(t.tolist()), tuple(values.tolist())
