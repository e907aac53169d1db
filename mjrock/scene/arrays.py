"""The arrays that describe a scene: their shapes and their valid values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..quantities import Array, Integers, frozen, shown

GROUND = -1
"""The body of a face or an anchor that belongs to the ground."""
NUMBERS = {
    "names": ("mass", "inertia"),
    "group": ("point_body", "face_body", "k", "c", "friction"),
    "tie_names": ("tie_body", "anchor_body", "tie_k", "tie_length", "tie_strength", "tie_ultimate"),
    "damper_names": ("damper_body", "damper_anchor_body", "damper_c"),
    "force_names": ("force_body",),
}
"""Arrays with one number for each of the bodies, contacts, ties, dampers and forces, by the field with their names."""
VECTORS = {
    "names": ("rest",),
    "group": ("point", "face", "normal"),
    "tie_names": ("tie_point", "anchor"),
    "damper_names": ("damper_point", "damper_anchor"),
    "force_names": ("force_point", "force"),
}
"""The same for arrays with one vector for each."""
POSITIVE = ("mass", "k", "tie_k", "tie_length", "tie_strength")
NOT_NEGATIVE = ("c", "friction", "damper_c", "tie_ultimate")
INFINITE = ("tie_strength", "tie_ultimate")
"""What may be infinite."""
CARRIERS = {"face_body": "point_body", "anchor_body": "tie_body", "damper_anchor_body": "damper_body"}
"""Where the body of a face or an anchor stands, and the body that must be another one."""


def require_inertia(inertia: Array) -> None:
    """Raise ValueError for moments of inertia, or tensors of space, that no body has.

    Tensors are symmetric, and no principal moment is larger than the sum of the other two.
    """
    if inertia.ndim == 1:
        if not (inertia > 0).all():
            raise ValueError(f"inertia = {inertia.min():g} is outside the valid range inertia > 0")
        return
    for tensor in inertia:
        moments = np.linalg.eigvalsh(tensor)
        if not (np.allclose(tensor, tensor.T, rtol=0, atol=1e-9 * np.abs(tensor).max()) and moments[0] > 0):
            raise ValueError(f"inertia = {tensor.tolist()} is no symmetric tensor with three positive moments")
        if moments[2] > (1 + 1e-9) * (moments[0] + moments[1]):
            raise ValueError(
                f"inertia with the principal moments {', '.join(f'{moment:g}' for moment in moments)}: no body has one "
                "that is larger than the sum of the other two"
            )


def nothing() -> NDArray[Any]:
    """An array without values, for what a scene does not have."""
    return np.empty(0)


def checked(given: Mapping[str, Any]) -> dict[str, Array | Integers]:
    """The arrays of a scene, of the kinds that compiled functions take.

    Raises:
        ValueError: for an array of another shape, or an invalid value. The message names it.
    """
    arrays: dict[str, Array | Integers] = {}
    shapes: dict[str, tuple[int, ...]] = {name: (len(given[of]),) for of, names in NUMBERS.items() for name in names}
    directions = 3 if np.shape(given["rest"])[-1:] == (3,) else 2
    shapes |= {name: (len(given[of]), directions) for of, names in VECTORS.items() for name in names}
    if directions == 3:
        shapes["inertia"] = (len(given["names"]), 3, 3)
    for name, wanted in shapes.items():
        try:
            values = np.ascontiguousarray(given[name], dtype=np.int64 if name.endswith("body") else float)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"{name} = {shown(given[name])} is no array of numbers") from None
        values = values if values.size else values.reshape(wanted)
        if values.shape != wanted:
            raise ValueError(f"{name} has the shape {values.shape}; {wanted} is needed")
        if np.isnan(values).any() or (name not in INFINITE and not np.isfinite(values).all()):
            raise ValueError(f"{name} holds a value that is not finite")
        arrays[name] = frozen(values)
    for name in POSITIVE:
        if not (arrays[name] > 0).all():
            raise ValueError(f"{name} = {arrays[name].min():g} is outside the valid range {name} > 0")
    require_inertia(np.asarray(arrays["inertia"], dtype=float))
    for name in NOT_NEGATIVE:
        if not (arrays[name] >= 0).all():
            raise ValueError(f"{name} = {arrays[name].min():g} is outside the valid range, which starts at 0")
    bodies = len(given["names"])
    for name in ("point_body", "tie_body", "damper_body", "force_body"):
        if not ((arrays[name] >= 0) & (arrays[name] < bodies)).all():
            raise ValueError(f"{name} is outside the valid range 0 to {bodies - 1}")
    for name, carrier in CARRIERS.items():
        if not ((arrays[name] >= GROUND) & (arrays[name] < bodies) & (arrays[name] != arrays[carrier])).all():
            raise ValueError(f"{name} is another body, 0 to {bodies - 1}, or {GROUND} for the ground")
    if not np.allclose(np.hypot.reduce(arrays["normal"], axis=1), 1.0):
        raise ValueError("normal holds a vector that is not of unit length")
    names = (*given["names"], *dict.fromkeys(given["group"]), *given["tie_names"], *given["damper_names"])
    names += tuple(given["force_names"])
    for name, number in Counter(names).items():
        if number > 1:
            raise ValueError(
                f"{name} names two things of the scene; bodies, groups of contacts, ties and forces need names of "
                "their own"
            )
    return arrays
