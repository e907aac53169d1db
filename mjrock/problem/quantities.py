"""What every module shares: the acceleration of gravity, and the check of a value against its range."""

from __future__ import annotations

import math
from typing import TypeVar

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


def require_within(name: str, value: float, low: float, high: float, unit: str = "") -> float:
    """Return `value` as a float.

    Raises:
        ValueError: with the value and the range, unless the value lies within [low, high]. NaN never does.
    """
    if not low <= value <= high:
        unit = unit and f" {unit}"
        raise ValueError(f"{name} = {value:g}{unit} is outside the valid range {low:g} to {high:g}{unit}")
    return float(value)
