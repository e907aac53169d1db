"""Where an effect acts on masonry in space: fields that effects have beside those of the plane.

A field that came later counts in the fingerprint of a task only where it is set. Tasks without it keep theirs.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

from ...quantities import require_array, require_within
from .input_bounds import HIGHEST

Point = tuple[float, float, float]
FARTHEST = 1e4
"""Largest coordinate of a point [m]."""


LATER = {"later": True}
"""Metadata of a field that came later. It is given by keyword, and None unless it is set."""


def written(effect: Any) -> str:
    """An effect as it would be written, without what is said in space alone where it is not said."""
    shown = ((field, getattr(effect, field.name)) for field in fields(effect))
    said = (f"{field.name}={value!r}" for field, value in shown if not (field.kw_only and value is None))
    return f"{type(effect).__name__}({', '.join(said)})"


def point_or_none(name: str, value: Any) -> Point | None:
    """A point in space as a tuple, or None.

    Raises:
        TypeError, ValueError: with the name, unless it is three numbers within -10000 to 10000 m.
    """
    if value is None:
        return None
    x, y, z = (require_within(name, each, -FARTHEST, FARTHEST, "m") for each in require_array(name, value, (3,)))
    return x, y, z


def direction_or_none(name: str, value: Any) -> Point | None:
    """A vector in space at unit length, or None.

    Raises:
        TypeError, ValueError: with the name, unless it is three numbers that are not all zero.
    """
    point = point_or_none(name, value)
    if point is None:
        return None
    length = math.hypot(*point)
    if not length > 1e-9:
        raise ValueError(f"{name} = {point} has no length; the valid range are vectors longer than 1e-9")
    return point[0] / length, point[1] / length, point[2] / length


def height_of(kind: str, height: float | None, at: Point | None) -> float:
    """The height of an effect, that of its point in space where it has one [m].

    Raises:
        TypeError: if it has neither.
        ValueError: if the height is out of its range, or both are given and differ.
    """
    if at is None:
        return require_within(f"height of the {kind}", height, 0.0, HIGHEST, "m")
    if height is not None and require_within(f"height of the {kind}", height, -FARTHEST, FARTHEST, "m") != at[2]:
        raise ValueError(f"height of the {kind} = {height} m is given with at = {at} m; leave it out")
    return at[2]


def require_in_plane(name: str, effect: Any) -> None:
    """Raise a ValueError that names the field, if an effect has one that only masonry in space takes."""
    for entry in fields(effect):
        if entry.metadata.get("later") and getattr(effect, entry.name) is not None:
            given = getattr(effect, entry.name)
            raise ValueError(f"{name}, {entry.name} = {given} is for masonry in space; in the plane give height")
