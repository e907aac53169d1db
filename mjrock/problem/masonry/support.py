"""Supports: fixed blocks that are displaced, such as spreading abutments and settling footings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...quantities import Array, require_kind, require_row, shown
from .histories import require_as_many
from .masonry import Masonry

FARTHEST = 100.0
"""Largest displacement of a support [m]."""


@dataclass(frozen=True)
class Support:
    """How a fixed block is displaced.

    Args:
        block: its name.
        t: times [s], increasing. Before the first and after the last the block rests.
        dx, dz: displacements from where it is drawn, linear in between [m].
        dy: the same along y, in space; None in the plane.
    """

    block: str
    t: tuple[float, ...]
    dx: tuple[float, ...]
    dz: tuple[float, ...]
    dy: tuple[float, ...] | None = field(default=None, kw_only=True)

    @property
    def displacement(self) -> Array:
        """Displacements [m], shape (samples, 2), in space (samples, 3)."""
        return np.column_stack(self.histories[1:])

    def at(self, t: Array) -> Array:
        """Displacement at some times [m], shape (times, 2), in space (times, 3)."""
        return np.column_stack([np.interp(t, self.t, history) for history in self.histories[1:]])

    @property
    def histories(self) -> tuple[tuple[float, ...], ...]:
        """t, dx and dz, in space t, dx, dy and dz."""
        return (self.t, self.dx, self.dz) if self.dy is None else (self.t, self.dx, self.dy, self.dz)


def supports_of(masonry: Masonry, given: Any) -> tuple[Support, ...]:
    """The supports, from a mapping of names of fixed blocks to (t, dx, dz), in space to (t, dx, dy, dz).

    Supports of an earlier case are checked likewise: the masonry may be another one. A TypeError or ValueError names
    the block and what is wrong.
    """
    if isinstance(given, tuple) and all(isinstance(support, Support) for support in given):
        given = {support.block: support.histories for support in given}
    require_kind("supports", given, Mapping)
    fixed = [masonry.names[i] for i, block in enumerate(masonry.blocks) if block.fixed]
    labels = ("t", "dx", "dy", "dz") if masonry.in_space else ("t", "dx", "dz")
    wanted, supports = ", ".join(labels), []
    for name, histories in given.items():
        if name not in fixed:
            raise ValueError(f"supports: {shown(name)} is not a fixed block; the valid ones are {', '.join(fixed)}")
        if not isinstance(histories, list | tuple) or len(histories) != len(labels):
            where = "in space" if masonry.in_space else "in the plane"
            raise TypeError(f"supports, {name} = {shown(histories)} is not ({wanted}), which masonry {where} takes")
        pairs = zip(labels, histories, strict=True)
        rows = {label: require_row(f"supports, {name}, {label}", values, "number") for label, values in pairs}
        require_as_many(f"supports, {name}", rows)
        if not (np.diff(rows["t"]) > 0).all():
            raise ValueError(f"supports, {name}: t does not increase")
        far = max(float(np.abs(rows[label]).max()) for label in labels[1:])
        if far > FARTHEST:
            raise ValueError(
                f"supports, {name}: a displacement of {far:g} m is outside the valid range to {FARTHEST:g} m"
            )
        supports.append(Support(name, **{label: tuple(row.tolist()) for label, row in rows.items()}))
    return tuple(supports)
