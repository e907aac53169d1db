"""The arrays that describe a scene, their shapes, and the values that they may hold."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..quantities import Array, Integers, shown

GROUND = -1
"""The body of a face or an anchor that belongs to the ground."""
SHAPES: dict[str, tuple[str | int, ...]] = {
    "mass": ("names",),
    "inertia": ("names",),
    "rest": ("names", 2),
    "point_body": ("group",),
    "point": ("group", 2),
    "face_body": ("group",),
    "face": ("group", 2),
    "normal": ("group", 2),
    "k": ("group",),
    "c": ("group",),
    "friction": ("group",),
    "tie_body": ("tie_names",),
    "tie_point": ("tie_names", 2),
    "anchor_body": ("tie_names",),
    "anchor": ("tie_names", 2),
    "tie_k": ("tie_names",),
    "tie_length": ("tie_names",),
    "tie_strength": ("tie_names",),
    "tie_ultimate": ("tie_names",),
    "damper_body": ("damper_names",),
    "damper_point": ("damper_names", 2),
    "damper_anchor": ("damper_names", 2),
    "damper_c": ("damper_names",),
    "force_body": ("force_names",),
    "force_point": ("force_names", 2),
    "force": ("force_names", 2),
}
"""Shape of each array: the names whose number is its length, and two for vectors."""
POSITIVE = ("mass", "inertia", "k", "tie_k", "tie_length", "tie_strength")
NOT_NEGATIVE = ("c", "friction", "damper_c", "tie_ultimate")
INFINITE = ("tie_strength", "tie_ultimate")
"""What may be infinite."""
CARRIERS = {"face_body": "point_body", "anchor_body": "tie_body"}
"""Where the body of a face or an anchor stands, and the body that must be another one."""


def frozen(values: ArrayLike) -> NDArray[Any]:
    """A copy that cannot be changed."""
    made = np.array(values)
    made.setflags(write=False)
    return made


def nothing() -> NDArray[Any]:
    """An array without values, for what a scene does not have."""
    return np.empty(0)


def checked(given: Mapping[str, Any]) -> dict[str, Array | Integers]:
    """The arrays of a scene, in the order of SHAPES, with the kinds that compiled functions take.

    Args:
        given: what the scene was made with, by the name of the field.

    Raises:
        ValueError: for an array of another shape, or a value that cannot be. The message names it.
    """
    made: dict[str, Array | Integers] = {}
    for name, shape in SHAPES.items():
        wanted = tuple(size if isinstance(size, int) else len(given[size]) for size in shape)
        try:
            values = np.ascontiguousarray(given[name], dtype=np.int64 if name.endswith("body") else float)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"{name} = {shown(given[name])} is no array of numbers") from None
        values = values if values.size else values.reshape(wanted)
        if values.shape != wanted:
            raise ValueError(f"{name} has the shape {values.shape}; {wanted} is needed")
        if np.isnan(values).any() or (name not in INFINITE and not np.isfinite(values).all()):
            raise ValueError(f"{name} holds a value that is not finite")
        made[name] = frozen(values)
    for name in POSITIVE:
        if not (made[name] > 0).all():
            raise ValueError(f"{name} = {made[name].min():g} is outside the valid range {name} > 0")
    for name in NOT_NEGATIVE:
        if not (made[name] >= 0).all():
            raise ValueError(f"{name} = {made[name].min():g} is outside the valid range, which starts at 0")
    bodies = len(given["names"])
    for name in ("point_body", "tie_body", "damper_body", "force_body"):
        if not ((made[name] >= 0) & (made[name] < bodies)).all():
            raise ValueError(f"{name} is outside the valid range 0 to {bodies - 1}")
    for name, carrier in CARRIERS.items():
        if not ((made[name] >= GROUND) & (made[name] < bodies) & (made[name] != made[carrier])).all():
            raise ValueError(f"{name} is another body, 0 to {bodies - 1}, or {GROUND} for the ground")
    if not np.allclose(np.hypot(*made["normal"].T), 1.0):
        raise ValueError("normal holds a vector that is not of unit length")
    names = (*given["names"], *dict.fromkeys(given["group"]), *given["tie_names"], *given["damper_names"])
    names += tuple(given["force_names"])
    for name, number in Counter(names).items():
        if number > 1:
            raise ValueError(
                f"{name} names two things of the scene; bodies, groups of contacts, ties and forces need names of "
                "their own"
            )
    return made
