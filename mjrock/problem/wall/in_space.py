"""Where an effect acts: its block and height, and fields that effects have in space beside those of the plane."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from ...quantities import keep, require_array, require_whole, require_within

Point = tuple[float, float, float]
HIGHEST = 200.0
"""Largest height of a wall, and so of an effect [m]."""
BLOCKS = 100_000
"""Largest number of a block."""
FARTHEST = 1e4
"""Largest coordinate of a point [m]."""
IN_SPACE = {"in space": True}
"""Metadata of a field of an effect that only masonry in space takes."""


def short_repr(effect: Any) -> str:
    """An effect as it would be written, without what may be said by keyword and is not."""
    shown = ((field, getattr(effect, field.name)) for field in fields(effect))
    said = (f"{field.name}={value!r}" for field, value in shown if not (field.kw_only and value == field.default))
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


def keep_place(effect: Any, kind: str) -> None:
    """Check and keep where an effect is: its block, its height or point in space, and the anchor of a tie or damper.

    Raises:
        TypeError, ValueError: with the name and the kind of effect, for what is not a number or point, or out of range.
    """
    for name in ("at", "anchor"):
        if hasattr(effect, name):
            keep(effect, **{name: point_or_none(f"{name} of the {kind}", getattr(effect, name))})
    if getattr(effect, "anchor_block", None) is not None:
        keep(effect, anchor_block=_block(f"anchor_block of the {kind}", effect.anchor_block))
    keep(
        effect,
        height=_height(kind, effect.height, effect.at),
        block=_block(f"block of the {kind}", effect.block),
    )


def _block(name: str, given: Any) -> Any:
    """A block as it is named, of which a case of masonry knows the number, or its number."""
    return given if isinstance(given, str) else require_whole(name, given, 0, BLOCKS)


def _height(kind: str, height: float | None, at: Point | None) -> float:
    """The height of an effect, that of its point in space where it has one [m]."""
    if at is None:
        return require_within(f"height of the {kind}", height, 0.0, HIGHEST, "m")
    if height is not None and require_within(f"height of the {kind}", height, -FARTHEST, FARTHEST, "m") != at[2]:
        raise ValueError(f"height of the {kind} = {height} m is given with at = {at} m; leave it out")
    return at[2]


def require_in_plane(name: str, effect: Any, but: str = "") -> None:
    """Raise a ValueError that names the field, if an effect has one that only masonry in space takes, `but` for one."""
    for entry in fields(effect):
        if entry.metadata.get("in space") and entry.name != but and getattr(effect, entry.name) is not None:
            given = getattr(effect, entry.name)
            raise ValueError(f"{name}, {entry.name} = {given} is for masonry in space; in the plane give height")
