"""Ground motion: a recorded, analytic or synthetic acceleration of the base."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ...quantities import (
    GRAVITY,
    MOST_SAMPLES,
    Array,
    keep,
    require_kind,
    require_reals,
    require_size,
    require_within,
    spelt,
)
from .pulses import Pulses
from .records import COARSEST, FINEST, Record, checked, parse_at2, parse_columns, parse_sac, read

SUSPICIOUS = 3 * GRAVITY
"""A record with a peak acceleration above this is probably in another unit [m/s2]."""
FAINT = 1e-3 * GRAVITY
"""A file whose peak acceleration is below this is probably in another unit [m/s2]."""
DRIFT = 0.2
"""A record whose residual velocity exceeds this share of its peak velocity probably lacks a baseline correction [-]."""


@dataclass(frozen=True, eq=False)
class GroundMotion(Pulses):
    """Horizontal acceleration of the base with the sign of Eq. 1: a negative one opens the wall.

    Between samples it is linear, before the first and after the last the ground is quiet. A one-sided wall takes the
    two polarities differently: ask for both of `polarities`.

    Args:
        accel: accelerations [m/s2], shape (n,), n at least 2.
        dt: time step of the samples [s], 1e-5 to 1.
        name: what it is called in tables and pictures.

    Raises:
        TypeError, ValueError: for accelerations, a step or a name that are not valid.

    Warns:
        UserWarning: for a peak beyond 3 g, where the unit is probably another one. A motion from a file also warns for
            a peak below 1e-3 g and for a residual velocity beyond 20 % of the peak velocity.
    """

    accel: Array
    dt: float
    name: str = field(default="ground motion", compare=False)

    def __init__(self, accel: ArrayLike, dt: float, name: str = "ground motion") -> None:
        require_kind("name", name, str)
        values, step = checked(accel, dt)
        keep(self, accel=values, dt=step, name=name)
        if self.peak > SUSPICIOUS:
            warnings.warn(
                f"{name} peaks at {self.peak:g} m/s2 = {self.peak / GRAVITY:.3g} g; accelerations are in m/s2",
                stacklevel=2,
            )

    def __repr__(self) -> str:
        return f"<GroundMotion {self.name!r}: {len(self.accel)} samples, dt = {self.dt:g} s, peak {self.peak:.3g} m/s2>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, GroundMotion) and self.dt == other.dt and np.array_equal(self.accel, other.accel)

    def __hash__(self) -> int:
        return hash((self.dt, (self.accel + 0.0).tobytes()))  # -0.0 equals 0.0, and must hash as it does

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # what is cached stays at home

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.accel.setflags(write=False)

    def __call__(self, t: float | Array) -> Array:
        """Acceleration at any time [m/s2]."""
        return np.asarray(np.interp(_instants(t), self._times, self.accel, left=0.0, right=0.0))

    def velocity(self, t: ArrayLike) -> Array:
        """Integral of the acceleration from zero to any time, exact, constant after the last sample [m/s]."""
        steps = len(self.accel) - 1
        positions = np.clip(_instants(t) / self.dt, 0, steps)
        j = np.minimum(positions.astype(int), steps - 1)
        parts = positions - j
        means = self.accel[j] + 0.5 * parts * (self.accel[j + 1] - self.accel[j])
        return np.asarray(self.velocities[j] + self.dt * parts * means)

    @cached_property
    def _times(self) -> Array:
        return self.dt * np.arange(len(self.accel), dtype=float)

    @cached_property
    def velocities(self) -> Array:
        """Velocity of the ground at each sample [m/s], shape (n,)."""
        means = 0.5 * (self.accel[1:] + self.accel[:-1])
        return np.concatenate(([0.0], np.cumsum(self.dt * means)))

    @property
    def duration(self) -> float:
        """Time of the last sample [s]."""
        return self.dt * (len(self.accel) - 1)

    @property
    def peak(self) -> float:
        """Largest |acceleration| [m/s2]."""
        return float(np.abs(self.accel).max())

    @property
    def peak_velocity(self) -> float:
        """Largest |velocity|, between samples too [m/s]."""
        a, b = self.accel[:-1], self.accel[1:]
        i = np.flatnonzero(a * b < 0)
        turns = self.velocity(self.dt * (i + a[i] / (a[i] - b[i])))
        return float(np.abs(np.concatenate((self.velocities, turns))).max())

    @property
    def residual_velocity(self) -> float:
        """Velocity after the last sample [m/s]; one far from zero is a baseline left uncorrected."""
        return float(self.velocities[-1])

    @property
    def residual_displacement(self) -> float:
        """Displacement at the last sample [m]."""
        within = self.dt * (2 * self.accel[:-1] + self.accel[1:]) / 6
        return float(self.dt * (self.velocities[:-1] + within).sum())

    @property
    def arias_intensity(self) -> float:
        """pi / (2 g) times the integral of the squared acceleration [m/s]."""
        a, b = self.accel[:-1], self.accel[1:]
        return float(math.pi / (2 * GRAVITY) * self.dt * (a * a + a * b + b * b).sum() / 3)

    @property
    def polarities(self) -> tuple[GroundMotion, GroundMotion]:
        """The motion as it is, and reversed."""
        return self, self.reversed()

    def scaled(self, factor: float | None = None, *, peak: float | None = None) -> GroundMotion:
        """The motion with every acceleration times `factor`, -1e6 to 1e6, or scaled to a `peak` [m/s2], 0 to 1e3.

        Raises:
            ValueError: for a value outside its range, both or neither, or a peak of a motion that has none.
        """
        if (factor is None) == (peak is None):
            raise ValueError(
                f"scaled takes either a factor or a peak [m/s2]; factor = {spelt(factor)}, peak = {spelt(peak)}"
            )
        if peak is None:
            multiple = require_within("factor", factor, -1e6, 1e6)
            return GroundMotion(multiple * self.accel, self.dt, f"{self.name} x {multiple:g}")
        peak = require_within("peak", peak, 0.0, 1e3, "m/s2")
        if self.peak == 0:
            raise ValueError(f"{self.name} is at rest: no factor gives it peak = {peak:g} m/s2")
        return GroundMotion(peak / self.peak * self.accel, self.dt, f"{self.name} to {peak:g} m/s2")

    def reversed(self) -> GroundMotion:
        """The motion of the other polarity."""
        return GroundMotion(-self.accel, self.dt, f"{self.name}, reversed")

    def resampled(self, dt: float) -> GroundMotion:
        """The motion at another time step `dt` [s], as long as before within half of it, linear between its samples.

        Before a coarser step it goes through an eighth-order Butterworth filter, forwards and backwards: 0.7 of the new
        Nyquist frequency keeps half its amplitude, the Nyquist frequency 0.3 %. A finer step that divides the old one
        to rounding is made to divide it exactly.

        Raises:
            ValueError: for a step below 1e-5 s, beyond 1 s or the duration, or that makes more than MOST_SAMPLES.
        """
        new = require_within("time step dt", dt, FINEST, min(COARSEST, self.duration), "s")
        accel, last, parts, name = self.accel, len(self.accel) - 1, round(self.dt / new), f"{self.name} at {new:g} s"
        if parts and math.isclose(parts * new, self.dt):
            new, steps = self.dt / parts, parts * last
        else:
            steps = round(last * self.dt / new)
        remedy = f"make dt longer than {last * self.dt / MOST_SAMPLES:.3g} s"
        require_size(f"the number of samples of {last * self.dt:g} s at dt = {new:g} s", steps + 1, remedy)
        if new > self.dt:
            low_pass = scipy.signal.butter(8, 0.7 * self.dt / new, output="sos")
            accel = scipy.signal.sosfiltfilt(low_pass, accel, padlen=min(last, math.ceil(10 * new / self.dt)))
        return GroundMotion(np.interp(new * np.arange(steps + 1), self._times, accel), new, name)

    @classmethod
    def from_at2(cls, path: str | PathLike[str]) -> GroundMotion:
        """A record of the PEER NGA data base, in g, named after its file.

        Raises:
            OSError: if the file cannot be read.
            ValueError: for another format or unit, another number of samples than is stated, or no finite number.
        """
        return cls._from_file(path, parse_at2)

    @classmethod
    def from_csv(cls, path: str | PathLike[str], unit: str, *, time_unit: str = "s") -> GroundMotion:
        """A record of two columns, time and acceleration, named after its file; its first row is time zero.

        Commas, semicolons, or blanks and tabs set the columns apart; a header and lines that begin with #, % or // are
        skipped; between semicolons a comma is a decimal point.

        Args:
            path: the file.
            unit: of the accelerations: "m/s2", "cm/s2", "mm/s2", "g" (9.81 m/s2) or "ft/s2".
            time_unit: "s" or "ms".

        Raises:
            OSError: if the file cannot be read.
            ValueError: for an unknown unit, times that do not increase evenly (within 1 % of their step), or what is
                not two finite numbers a line.
        """
        return cls._from_file(path, lambda lines: parse_columns(lines, unit, time_unit))

    @classmethod
    def from_sac(cls, path: str | PathLike[str]) -> GroundMotion:
        """A record in the plain text of a SAC set, named after its file: a title, count and time step, cm/s2.

        Raises:
            OSError: if the file cannot be read.
            ValueError: for another format, another number of samples than is stated, or what is no finite number.
        """
        return cls._from_file(path, parse_sac)

    @classmethod
    def _from_file(cls, path: str | PathLike[str], parse: Callable[[list[str]], Record]) -> GroundMotion:
        motion = cls(*read(path, parse), name := Path(path).stem)
        peak, final, fastest = motion.peak, motion.residual_velocity, motion.peak_velocity
        if peak < FAINT:
            warnings.warn(
                f"{name} peaks at {peak:g} m/s2 = {peak / GRAVITY:.3g} g only; is its unit right?", stacklevel=3
            )
        if abs(final) > DRIFT * fastest:
            warnings.warn(
                f"{name} drifts: its residual velocity is {final:.3g} m/s, its peak velocity {fastest:.3g} m/s; "
                "it needs a baseline correction",
                stacklevel=3,
            )
        return motion


def _instants(t: ArrayLike) -> Array:
    times = require_reals("t", t, "one or more times [s]")
    if np.isnan(times).any():
        raise ValueError("t holds nan; it takes one or more times [s]")
    return times
