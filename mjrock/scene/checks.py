"""Checks of the parts of a scene: shapes and values of their arrays, and whether they belong together."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..quantities import Array, frozen, shown

GROUND = -1
"""The body of a face or an anchor that belongs to the ground."""


def said_of(part: object) -> str:
    """The name of a part in a message."""
    names = {"Bodies": "bodies", "ContactPoints": "contacts", "Links": "links", "ConstantForces": "forces"}
    return names[type(part).__name__]


def keep_array(
    part: object,
    name: str,
    shape: tuple[int, ...],
    *,
    kind: type = float,
    above: float | None = None,
    least: float | None = None,
    infinite: bool = False,
) -> None:
    """Keep a field of a part as an array of the kind that compiled functions take.

    Raises:
        TypeError, ValueError: for what is not an array of numbers, another shape or a value out of range. The message
            names it.
    """
    given, said = getattr(part, name), f"{name} of the {said_of(part)}"
    try:
        values: NDArray[Any] = np.ascontiguousarray(given, dtype=kind)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{said} = {shown(given)} is not an array of numbers") from None
    values = values if values.size else values.reshape(shape)
    if values.shape != shape:
        raise ValueError(f"{said} has the shape {values.shape}; {shape} is needed")
    require_values(said, values, above, least, infinite)
    object.__setattr__(part, name, frozen(values))


def require_values(
    said: str, values: NDArray[Any], above: float | None = None, least: float | None = None, infinite: bool = False
) -> None:
    """Raise a ValueError for a value that is no number, infinite where none may be, or not above or from `least` on."""
    if np.isnan(values).any() or not (infinite or np.isfinite(values).all()):
        raise ValueError(f"{said} holds a value that is not finite")
    if above is not None and not (values > above).all():
        raise ValueError(f"{said} = {values.min():g} is outside the valid range, which is above {above:g}")
    if least is not None and not (values >= least).all():
        raise ValueError(f"{said} = {values.min():g} is outside the valid range, which starts at {least:g}")


def require_others(part: Any, name: str) -> None:
    """Raise a ValueError where a face or an anchor is on the body that carries the point."""
    if (getattr(part, name) == part.body).any() or (getattr(part, name) < GROUND).any():
        raise ValueError(f"{name} of the {said_of(part)} is another body, or {GROUND} for the ground")


def require_on(bodies: Any, parts: Iterable[Any]) -> None:
    """Raise a ValueError unless parts are of the plane or of space as the bodies are, and on them."""
    n, directions = len(bodies.names), bodies.rest.shape[1]
    for part in parts:
        if len(part.body) and part.at.shape[1] != directions:
            said = f"at of the {said_of(part)}"
            raise ValueError(f"{said} has the shape {part.at.shape}; {(len(part.body), directions)} is needed")
        for name in ("body", "face_body", "anchor_body"):
            least = 0 if name == "body" else GROUND
            on = getattr(part, name, np.empty(0))
            if not ((on >= least) & (on < n)).all():
                raise ValueError(f"{name} of the {said_of(part)} is outside the valid range {least} to {n - 1}")


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
            raise ValueError(f"inertia = {tensor.tolist()} is not a symmetric tensor with three positive moments")
        if moments[2] > (1 + 1e-9) * (moments[0] + moments[1]):
            raise ValueError(
                f"inertia with the principal moments {', '.join(f'{moment:g}' for moment in moments)}: no body has one "
                "that is larger than the sum of the other two"
            )
