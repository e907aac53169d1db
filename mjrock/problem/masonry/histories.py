"""Histories of what is driven: supports that are displaced, and a table that tilts.

Numbers at increasing times are linear in between and constant after the last. Supports are fixed blocks, such as
spreading abutments and settling footings.

A table that has turned by an angle a gives every block the accelerations g sin a along x and -g cos a along z, which
are its own. Beside the weight at rest this is a ground that accelerates by -g sin a along x and -g (1 - cos a) along
z. The table turns slowly: what its rate adds, such as centrifugal forces, is left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from ...quantities import GRAVITY, Array, Within, require_increasing, require_kind, require_row, require_within, shown
from ..ground.motion import GroundMotion
from .masonry import Masonry

LATEST_TIME = 1e6
"""Latest time of a history [s]."""

History = tuple[tuple[float, ...], tuple[float, ...]]
"""Times [s] and values."""
FARTHEST_SUPPORT = 100.0
"""Largest displacement of a support [m]."""
STEEPEST = math.pi
"""Largest angle of a table [rad]."""
Times = tuple[Annotated[float, Within(-LATEST_TIME, LATEST_TIME, "s")], ...]
Displacements = tuple[Annotated[float, Within(-FARTHEST_SUPPORT, FARTHEST_SUPPORT, "m")], ...]
OfSupports = Mapping[
    str, tuple[Times, Displacements, Displacements] | tuple[Times, Displacements, Displacements, Displacements]
]
Tilt = tuple[Times, tuple[Annotated[float, Within(-STEEPEST, STEEPEST, "rad")], ...]]
"""Histories of supports and of a table, as a case takes them."""


def require_as_many(name: str, rows: Mapping[str, Array]) -> None:
    """Raise ValueError with the name unless these rows have as many values, see `require_row`."""
    lengths = [len(row) for row in rows.values()]
    if len(set(lengths)) > 1:
        counts = f"{', '.join(map(str, lengths[:-1]))} and {lengths[-1]}"
        raise ValueError(f"{name}: {', '.join(rows)} have {counts} values; give as many")


def history_of(name: str, given: object, largest: float, unit: str, *, from_zero: bool = False) -> History:
    """A history from (t, values).

    Args:
        name: what it is called.
        given: times and values, as many.
        largest: magnitude of the values.
        unit: of the values.
        from_zero: whether the first value has to be zero.

    Raises:
        TypeError, ValueError: with the name, unless it is two rows of as many finite numbers, the times increase from
            zero and the values are in their range.
    """
    if not isinstance(given, list | tuple) or len(given) != 2:
        raise TypeError(f"{name} = {shown(given)} is not (t, values), two rows of numbers")
    t = require_increasing(f"{name}, t", given[0], "time", LATEST_TIME, f"0 to {LATEST_TIME:g} s")
    values = require_row(f"{name}, values", given[1], "number")
    require_as_many(name, {"t": t, "values": values})
    if t[0] != 0:
        raise ValueError(f"{name}: t begins at {t[0]:g} s; the valid start is 0 s")
    if from_zero and values[0] != 0:
        raise ValueError(f"{name} begins at {values[0]:g} {unit}; the valid start is 0 {unit}, where nothing is driven")
    require_within(f"{name}, values", float(values[np.abs(values).argmax()]), -largest, largest, unit)
    return tuple(t.tolist()), tuple(values.tolist())


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

    Supports of an earlier case are checked likewise: the masonry may be another one.

    Raises:
        TypeError, ValueError: for anything else, with the block and what is wrong.
    """
    if isinstance(given, tuple) and all(isinstance(support, Support) for support in given):
        given = {support.block: support.histories for support in given}
    require_kind("supports", given, Mapping)
    fixed = [masonry.names[i] for i, block in enumerate(masonry.blocks) if block.fixed]
    labels = ("t", "dx", "dy", "dz") if masonry.in_space else ("t", "dx", "dz")
    expected, supports = ", ".join(labels), []
    for name, histories in given.items():
        if name not in fixed:
            raise ValueError(f"supports: {shown(name)} is not a fixed block; the valid ones are {', '.join(fixed)}")
        if not isinstance(histories, list | tuple) or len(histories) != len(labels):
            where = "in space" if masonry.in_space else "in the plane"
            raise TypeError(f"supports, {name} = {shown(histories)} is not ({expected}), which masonry {where} takes")
        pairs = zip(labels, histories, strict=True)
        rows = {label: require_row(f"supports, {name}, {label}", values, "number") for label, values in pairs}
        require_as_many(f"supports, {name}", rows)
        if not (np.diff(rows["t"]) > 0).all():
            raise ValueError(f"supports, {name}: t does not increase")
        for end in rows["t"][[0, -1]].tolist():
            require_within(f"supports, {name}, t", end, -LATEST_TIME, LATEST_TIME, "s")
        largest = max(float(np.abs(rows[label]).max()) for label in labels[1:])
        if largest > FARTHEST_SUPPORT:
            raise ValueError(
                f"supports, {name}: a displacement of {largest:g} m is outside the valid range to "
                f"{FARTHEST_SUPPORT:g} m"
            )
        supports.append(Support(name, **{label: tuple(row.tolist()) for label, row in rows.items()}))
    return tuple(supports)


MOTION_SAMPLES, MOST_MOTION_SAMPLES = 2000, 1_000_000
"""Samples of the equivalent ground motion over a run, and most where the angle changes faster [-]."""
LARGEST_STEP = 1.0
"""Largest step of a ground motion [s]."""


def tilt_history(given: object) -> History | None:
    """The history of the angle of a table from (t, angle), or None.

    Raises:
        TypeError, ValueError: for what is not two rows of as many numbers, or out of range.
    """
    return None if given is None else history_of("tilt", given, STEEPEST, "rad")


def motions_of_tilt(tilt: History, duration: float) -> tuple[GroundMotion, GroundMotion]:
    """The horizontal and the vertical motion of the ground that turns gravity as a table does, to the end of a run.

    The angle is linear between its samples. Those of the motion are so close that between them the acceleration is
    within 1e-6 g where the table turns by less than 5 rad in the run.
    """
    t, angle = (np.array(row) for row in tilt)
    closest = 0.25 * float(np.diff(t).min()) if len(t) > 1 else math.inf
    step = min(max(min(duration / MOTION_SAMPLES, closest), duration / MOST_MOTION_SAMPLES), LARGEST_STEP)
    count = math.ceil(duration / step) + 1
    turned = np.interp(duration * np.arange(count + 1) / (count - 1), t, angle)
    accel, dt = (-GRAVITY * np.sin(turned), -2 * GRAVITY * np.sin(0.5 * turned) ** 2), duration / (count - 1)
    return GroundMotion(accel[0], dt, "tilt"), GroundMotion(accel[1], dt, "tilt")
