"""Ground motion: a recorded or analytic acceleration of the base."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .block import GRAVITY, require_within

Array = NDArray[np.float64]
SUSPICIOUS = 3 * GRAVITY
"""Peak acceleration above which a record is probably in another unit [m/s2]."""


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """Horizontal acceleration of the base with the sign of Eq. 1: a negative one opens the wall.

    Between samples it is linear, before the first and after the last the ground is quiet. A one-sided wall takes the
    two polarities differently: ask for `reversed()` as well.

    Args:
        accel: accelerations [m/s2], shape (n,), n at least 2.
        dt: time step of the samples [s], 1e-5 to 1.
        name: what it is called in tables and pictures.

    Raises:
        ValueError: for a shape, a step or a value that cannot be.

    Warns:
        UserWarning: for a peak beyond 3 g, which smells of another unit.
    """

    accel: Array
    dt: float
    name: str = "ground motion"

    def __init__(self, accel: ArrayLike, dt: float, name: str = "ground motion") -> None:
        values = np.array(accel, dtype=float)
        if values.ndim != 1 or len(values) < 2:
            raise ValueError(
                f"accel has the shape {values.shape}; one row of at least 2 accelerations [m/s2] is needed"
            )
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise ValueError(f"accel[{bad[0]}] = {values[bad[0]]} m/s2 is not finite")
        values.setflags(write=False)
        object.__setattr__(self, "accel", values)
        object.__setattr__(self, "dt", require_within("time step dt", dt, 1e-5, 1.0, "s"))
        object.__setattr__(self, "name", name)
        if self.peak > SUSPICIOUS:
            warnings.warn(
                f"{name} peaks at {self.peak:g} m/s2 = {self.peak / GRAVITY:.3g} g; accelerations are in m/s2",
                stacklevel=2,
            )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, GroundMotion) and self.dt == other.dt and np.array_equal(self.accel, other.accel)

    def __hash__(self) -> int:
        return hash((self.dt, self.accel.tobytes()))

    def __call__(self, t: float | Array) -> Array:
        """Acceleration at any time [m/s2]."""
        return np.asarray(np.interp(t, self.dt * np.arange(len(self.accel)), self.accel, left=0.0, right=0.0))

    @property
    def duration(self) -> float:
        """Time of the last sample [s]."""
        return self.dt * (len(self.accel) - 1)

    @property
    def peak(self) -> float:
        """Largest |acceleration| [m/s2]."""
        return float(np.abs(self.accel).max())

    def scaled(self, factor: float) -> GroundMotion:
        """The motion with every acceleration times `factor`."""
        return GroundMotion(factor * self.accel, self.dt, f"{self.name} x {factor:g}")

    def reversed(self) -> GroundMotion:
        """The motion of the other polarity."""
        return GroundMotion(-self.accel, self.dt, f"{self.name}, reversed")

    @classmethod
    def sine(cls, amplitude: float, period: float, cycles: float = 1.0, samples: int = 400) -> GroundMotion:
        """A sine pulse of `amplitude` [m/s2] and `period` [s], `samples` to a cycle; a positive one starts inwards."""
        require_within("period", period, 1e-2, 100.0, "s")
        require_within("cycles", cycles, 0.5, 1e3)
        count = math.ceil(cycles * samples)
        t = cycles * period * np.arange(count + 1) / count
        return cls(
            amplitude * np.sin(2 * np.pi * t / period),
            cycles * period / count,
            f"sine {amplitude:g} m/s2, {period:g} s",
        )
