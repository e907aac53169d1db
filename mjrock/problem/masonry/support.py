"""Supports: fixed blocks that are displaced, such as spreading abutments and settling footings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...quantities import Array, require_kind, require_row, shown
from .masonry import Masonry

FARTHEST = 100.0
"""Largest displacement of a support [m]."""


@dataclass(frozen=True)
class Support:
    """How a fixed block is displaced.

    Args:
        block: its number in the masonry.
        t: times [s], increasing. Before the first and after the last the block rests.
        dx, dz: displacements from where it is drawn, linear in between [m].
    """

    block: int
    t: tuple[float, ...]
    dx: tuple[float, ...]
    dz: tuple[float, ...]

    @property
    def displacement(self) -> Array:
        """Displacements [m], shape (samples, 2)."""
        return np.column_stack([self.dx, self.dz])


def supports_of(masonry: Masonry, given: Any) -> tuple[Support, ...]:
    """The supports, from a mapping of names of fixed blocks to (t, dx, dz).

    Raises:
        TypeError: for what is no such mapping.
        ValueError: for a block that is not fixed, times that do not increase, or rows of different lengths.
    """
    if isinstance(given, tuple) and all(isinstance(support, Support) for support in given):
        return given
    require_kind("supports", given, Mapping)
    fixed = [masonry.names[i] for i, block in enumerate(masonry.blocks) if block.fixed]
    supports = []
    for name, histories in given.items():
        if name not in fixed:
            raise ValueError(f"supports: {shown(name)} is no fixed block; the valid ones are {', '.join(fixed)}")
        if not isinstance(histories, list | tuple) or len(histories) != 3:
            raise TypeError(f"supports, {name} = {shown(histories)} is not (t, dx, dz)")
        t, dx, dz = (
            require_row(f"supports, {name}, {label}", values, "number")
            for label, values in zip(("t", "dx", "dz"), histories, strict=True)
        )
        if not len(t) == len(dx) == len(dz):
            raise ValueError(f"supports, {name}: t, dx, dz have {len(t)}, {len(dx)} and {len(dz)} values; give as many")
        if not (np.diff(t) > 0).all():
            raise ValueError(f"supports, {name}: t does not increase")
        far = max(float(np.abs(dx).max()), float(np.abs(dz).max()))
        if far > FARTHEST:
            raise ValueError(
                f"supports, {name}: a displacement of {far:g} m is outside the valid range to {FARTHEST:g} m"
            )
        supports.append(Support(masonry.names.index(name), *(tuple(row.tolist()) for row in (t, dx, dz))))
    return tuple(supports)
