"""Ground motion: a recorded, analytic or synthetic acceleration of the base."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Annotated, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ...contacts.files import write_text
from ...quantities import (
    GRAVITY,
    MOST_SAMPLES,
    Array,
    Integers,
    Within,
    frozen,
    keep,
    require_flag,
    require_kind,
    require_one_of,
    require_path,
    require_reals,
    require_sequence,
    require_size,
    require_whole,
    require_within,
    shown,
    spelt,
    warn_of,
    within_ranges,
)
from .formats import esm_text, parse_at2, parse_esm, parse_sac, recognised
from .oscillator import (
    BuildingDamping,
    ModeShape,
    Participation,
    Periods,
    building_modes,
    of_pieces,
    oscillator_steps,
    total_acceleration,
)
from .records import (
    COARSEST,
    FINEST,
    Parse,
    SampleStep,
    TableOptions,
    Trace,
    checked_record,
    read,
    table_traces,
    text_lines,
)
from .vertices import Vertices

LARGE_PEAK = 3 * GRAVITY
"""A record with a peak acceleration above this is probably in another unit [m/s2]."""
SMALL_PEAK = 1e-3 * GRAVITY
"""A file whose peak acceleration is below this is probably in another unit [m/s2]."""
DRIFT_WARNED_OF = 0.2
"""A record whose residual velocity exceeds this share of its peak velocity probably lacks a baseline correction [-]."""
LONGEST_IMPULSE = 1e-3
"""A piece that is no longer than this is an impulse, whose acceleration says nothing about its unit [s]."""
PEAK_WARNING = "peak beyond 3 g"
"""What a line of a script is warned of once."""
NAME_FIELDS = ("NETWORK", "STATION_CODE", "STREAM", "EVENT_ID")
"""Fields of a header that name its record."""
Amplitude = Annotated[float, Within(-1e4, 1e4, "m/s2")]
"""Largest acceleration of a pulse, with its sign."""
PieceDuration = Annotated[float, Within(FINEST, 1000, "s")]
Samples = Annotated[ArrayLike, Within(-math.inf, math.inf, "m/s2")] | Array
Span = Annotated[float, Within(0.01, 100, "s")]
"""Period or duration of a pulse."""
Cycles = Annotated[float, Within(0.5, 1000)]
"""Number of periods of a pulse."""
BASELINES = {"constant": 0, "linear": 1, "quadratic": 2}
"""Degree of the polynomial of accelerations that is taken off, by name."""
FILTER_ORDER = 4
"""Order of the Butterworth filter, which runs forwards and backwards."""


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """Horizontal acceleration of the base with the sign of Eq. 1: a negative one opens the wall.

    Between samples it is linear, before the first and after the last the ground is quiet. A one-sided wall takes the
    two polarities differently: run both of `polarities`. `pieces` makes motions that jump, and `+` adds two motions.

    Args:
        accel: accelerations [m/s2], shape (n,), n at least 2.
        dt: time step of the samples [s], 1e-5 to 1.
        name: its name in tables and pictures.
        header: the fields of the header of its file, such as the event and the station, where that has some; FLOOR has
            the modes of the building that it came through, and SCALED_TO the spectrum that it was scaled to.

    Attributes:
        instants: times of the accelerations [s], shape (n,), where they are not evenly apart; None where they are. One
            that stands twice is a jump. `dt` is the shortest piece then, and of a sum the shorter of both.

    Raises:
        TypeError, ValueError: for accelerations, a step or a name that are not valid.

    Warns:
        UserWarning: for a peak beyond 3 g, where the unit is probably another one, once a line of a script. A motion
            from a file warns each time, and also for a peak below 1e-3 g and for a residual velocity beyond 20 % of
            the peak velocity.
    """

    accel: Array
    dt: float
    name: str = field(default="ground motion", compare=False)
    header: Mapping[str, str] = field(default_factory=dict, compare=False)
    instants: Array | None = None

    def __init__(
        self, accel: Samples, dt: SampleStep, name: str = "ground motion", header: Mapping[str, str] | None = None
    ) -> None:
        self._fill(accel, dt, name, header)
        self._warn_of_unit(once=PEAK_WARNING)

    @classmethod
    def _of_file(cls, accel: ArrayLike, dt: float, name: str, header: Mapping[str, str]) -> GroundMotion:
        """The motion of a file, each of which is warned of, also where one line of a script reads many."""
        motion = cls.__new__(cls)
        motion._fill(accel, dt, name, header)
        motion._warn_of_unit()
        return motion

    @classmethod
    def _through_vertices(cls, vertices: Vertices, dt: float, name: str) -> Self:
        """The motion through vertices, of even samples where they are those of a record; `dt` resolves it [s]."""
        vertices = vertices.tidied()
        even = vertices.even_step(dt)
        motion = cls.__new__(cls)
        if even is not None and FINEST <= even <= COARSEST:
            motion._fill(vertices.values, even, name, None)
        else:
            motion._fill(vertices.values, min(dt, COARSEST), name, None)
            keep(motion, instants=frozen(vertices.times))
        motion._warn_of_unit(once=PEAK_WARNING)
        return motion

    def _fill(self, accel: ArrayLike, dt: float, name: str, header: Mapping[str, str] | None) -> None:
        require_kind("name", name, str)
        require_kind("header", header, Mapping, type(None))
        values, step = checked_record(accel, dt)
        keep(self, accel=values, dt=step, name=name, header=dict(header or {}), instants=None)

    def _with_accelerations(self, accel: Array, name: str) -> GroundMotion:
        """Other accelerations at the same instants."""
        motion = GroundMotion.__new__(GroundMotion)
        motion._fill(accel, self.dt, name, self.header)
        keep(motion, instants=self.instants)
        motion._warn_of_unit(once=PEAK_WARNING)
        return motion

    def _warn_of_unit(self, once: str = "") -> None:
        """Warn of a peak beyond 3 g, with `once` a line of a script once."""
        if self.peak > LARGE_PEAK and (self.instants is None or self.dt > LONGEST_IMPULSE):
            peak = f"{self.peak:g} m/s2 = {self.peak / GRAVITY:.3g} g"
            warn_of(f"{self.name} peaks at {peak}; accelerations are in m/s2", once=once)

    def __repr__(self) -> str:
        step = f"dt = {self.dt:g} s" if self.instants is None else f"{self.duration:g} s by pieces"
        return f"<GroundMotion {self.name!r}: {len(self.accel)} samples, {step}, peak {self.peak:.3g} m/s2>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, GroundMotion) or self.dt != other.dt or not np.array_equal(self.accel, other.accel):
            return False
        return np.array_equal(self.times, other.times)

    def __hash__(self) -> int:
        return hash((self.dt, (self.accel + 0.0).tobytes()))  # -0.0 equals 0.0, and must hash as it does

    def __add__(self, other: object) -> GroundMotion:
        """The sum of two motions, exact at the samples and jumps of both."""
        if not isinstance(other, GroundMotion):
            return NotImplemented
        total, finest = self.vertices.plus(other.vertices), min(self.dt, other.dt)
        return GroundMotion._through_vertices(total, finest, f"{self.name} + {other.name}")

    def __radd__(self, other: object) -> GroundMotion:
        """The motion itself, where `sum` adds it to the zero with which it begins."""
        return self if type(other) is int and other == 0 else NotImplemented

    def __getstate__(self) -> dict[str, object]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # without cached values

    def __setstate__(self, state: dict[str, object]) -> None:
        self.__dict__.update(state)
        for array in (self.accel, self.instants):
            if array is not None:
                array.setflags(write=False)

    def __call__(self, t: float | Array) -> Array:
        """Acceleration at any time [m/s2]."""
        return np.asarray(np.interp(_instants(t), self.times, self.accel, left=0.0, right=0.0))

    def velocity(self, t: ArrayLike) -> Array:
        """Integral of the acceleration from zero to any time, exact, constant after the last sample [m/s]."""
        j, within, rise = self._place(t)
        return np.asarray(self.velocities[j] + within * (self.accel[j] + 0.5 * rise))

    def displacement(self, t: ArrayLike) -> Array:
        """Integral of the velocity from zero to any time, exact [m]."""
        j, within, rise = self._place(t)
        inside = self.displacements[j] + within * (self.velocities[j] + within * (self.accel[j] / 2 + rise / 6))
        return np.asarray(inside + self.residual_velocity * np.maximum(_instants(t) - self.duration, 0.0))

    def _place(self, t: ArrayLike) -> tuple[Integers, Array, Array]:
        """The samples before some times, held within the motion, the times since them [s], and by how much the
        acceleration has changed there [m/s2]."""
        last = len(self.accel) - 2
        if self.instants is None:
            positions = np.clip(_instants(t) / self.dt, 0, last + 1)
            j = np.minimum(positions.astype(int), last)
            parts, length = positions - j, self.dt
        else:
            place = np.clip(_instants(t), 0, self.duration)
            j = np.minimum(np.searchsorted(self.instants, place, "right") - 1, last)
            length = self.instants[j + 1] - self.instants[j]
            parts = (place - self.instants[j]) / length
        return j, length * parts, parts * (self.accel[j + 1] - self.accel[j])

    @property
    def vertices(self) -> Vertices:
        """Times of the samples [s] and accelerations at them [m/s2], with two of them at a jump."""
        return Vertices(self.times, self.accel)

    @cached_property
    def times(self) -> Array:
        """Times of the samples [s], shape (n,)."""
        return self.dt * np.arange(len(self.accel), dtype=float) if self.instants is None else self.instants

    @property
    def steps(self) -> Array | float:
        """Lengths between the samples [s], one for all where they are the same, zero at a jump."""
        return self.dt if self.instants is None else np.diff(self.instants)

    @property
    def jumps(self) -> Array:
        """Times at which the acceleration jumps, also from and to the quiet ground [s], increasing."""
        jumps = np.append(self.accel[0] != 0, np.diff(self.times) == 0)
        return np.concatenate((self.times[jumps], self.times[-1:] if self.accel[-1] else []))

    @cached_property
    def velocities(self) -> Array:
        """Velocity of the ground at each sample [m/s], shape (n,)."""
        return integral(self.accel, self.steps)

    @cached_property
    def displacements(self) -> Array:
        """Displacement of the ground at each sample [m], shape (n,)."""
        within = self.steps * (2 * self.accel[:-1] + self.accel[1:]) / 6
        return np.concatenate(([0.0], np.cumsum(self.steps * (self.velocities[:-1] + within))))

    @property
    def duration(self) -> float:
        """Time of the last sample [s]."""
        return float(self.times[-1])

    @property
    def peak(self) -> float:
        """Largest |acceleration| [m/s2]."""
        return float(np.abs(self.accel).max())

    @property
    def peak_velocity(self) -> float:
        """Largest |velocity|, between samples too [m/s]."""
        a, b = self.accel[:-1], self.accel[1:]
        i = np.flatnonzero(a * b < 0)
        steps = np.broadcast_to(self.steps, a.shape)[i]
        turns = self.velocities[i] + 0.5 * steps * a[i] ** 2 / (a[i] - b[i])
        return float(np.abs(np.concatenate((self.velocities, turns))).max())

    @property
    def residual_velocity(self) -> float:
        """Velocity after the last sample [m/s]; one far from zero is a baseline left uncorrected."""
        return float(self.velocities[-1])

    @property
    def residual_displacement(self) -> float:
        """Displacement at the last sample [m]."""
        return float(self.displacements[-1])

    @property
    def arias_intensity(self) -> float:
        """pi / (2 g) times the integral of the squared acceleration [m/s]."""
        return float(self.arias_intensities[-1])

    @property
    def arias_intensities(self) -> Array:
        """The Arias intensity up to each sample [m/s], shape (n,)."""
        a, b = self.accel[:-1], self.accel[1:]
        squares = np.cumsum(self.steps * (a * a + a * b + b * b) / 3)
        return np.concatenate(([0.0], math.pi / (2 * GRAVITY) * squares))

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
            raise ValueError(f"factor = {spelt(factor)}, peak = {spelt(peak)}: give either a factor or a peak [m/s2]")
        if peak is None:
            multiple = require_within("factor", factor, -1e6, 1e6)
            return self._with_accelerations(multiple * self.accel, f"{self.name} x {multiple:g}")
        peak = require_within("peak", peak, 0.0, 1e3, "m/s2")
        if self.peak == 0:
            raise ValueError(f"{self.name} is at rest: no factor gives it peak = {peak:g} m/s2")
        return self._with_accelerations(peak / self.peak * self.accel, f"{self.name} to {peak:g} m/s2")

    def delayed(self, time: float) -> GroundMotion:
        """The motion after `time` of quiet ground [s], 0 to 1e4.

        Raises:
            TypeError, ValueError: for a value outside its range, or one that makes more than MOST_SAMPLES.
        """
        time = require_within("time", time, 0.0, 1e4, "s")
        quiet = max(math.floor(time / self.dt + 1e-9), 1) if self.instants is None else 1
        require_size("the number of samples with the delay", quiet + len(self.accel), "choose a shorter delay")
        times = np.concatenate((self.dt * np.arange(quiet), [time], time + self.times))
        accel = np.concatenate((np.zeros(quiet + 1), self.accel))
        later = GroundMotion._through_vertices(Vertices(times, accel), self.dt, f"{self.name} after {time:g} s")
        return later.headed(self.header)

    def along(self, other: GroundMotion, azimuth: float) -> GroundMotion:
        """The component along an azimuth of a record of which this component points north and `other` east.

        Args:
            other: the eastern component, of the same time step and as many samples.
            azimuth: of the direction, from north towards east [rad], -2 pi to 2 pi: of a wall the way that its outer
                face looks, in whose sense the motion is positive then.

        Raises:
            TypeError, ValueError: for a value outside its range, or components of unlike samples.

        Examples:
            >>> north, east = mr.GroundMotion([0.0, 3.0], 0.01), mr.GroundMotion([0.0, 4.0], 0.01)
            >>> round(north.along(east, 0.927295218).peak, 9)
            5.0
        """
        require_kind("other", other, GroundMotion)
        angle = require_within("azimuth", azimuth, -2 * math.pi, 2 * math.pi, "rad")
        if not np.array_equal(self.times, other.times):
            raise ValueError(
                f"other has {len(other.accel)} samples at dt = {other.dt:g} s; the valid one has {len(self.accel)} at "
                f"{self.dt:g} s, as the component that points north"
            )
        accel = math.cos(angle) * self.accel + math.sin(angle) * other.accel
        return self._with_accelerations(accel, f"{self.name} and {other.name} along {angle:.4g} rad")

    def reversed(self) -> GroundMotion:
        """The motion of the other polarity."""
        return self._with_accelerations(-self.accel, f"{self.name}, reversed")

    def resampled(self, dt: SampleStep) -> GroundMotion:
        """The motion at another time step `dt` [s], as long as before within half of it, linear between its samples.

        Before a coarser step it goes through an eighth-order Butterworth filter, forwards and backwards: 0.7 of the new
        Nyquist frequency keeps half its amplitude, the Nyquist frequency 0.3 %. A finer step that divides the old one
        to rounding is made to divide it exactly. Of pieces the samples at a jump have the mean of both sides.

        Raises:
            ValueError: for a step below 1e-5 s, beyond 1 s, the duration or the shortest piece, or that makes more than
                MOST_SAMPLES.
        """
        longest = self.duration if self.instants is None else self.dt
        new = require_within("time step dt", dt, FINEST, min(COARSEST, longest), "s")
        accel, last, parts, name = self.accel, len(self.accel) - 1, round(self.dt / new), f"{self.name} at {new:g} s"
        if self.instants is None and parts and math.isclose(parts * new, self.dt):
            new, steps = self.dt / parts, parts * last
        else:
            steps = round(self.duration / new)
        remedy = f"make dt longer than {self.duration / MOST_SAMPLES:.3g} s"
        require_size(f"the number of samples of {self.duration:g} s at dt = {new:g} s", steps + 1, remedy)
        if self.instants is not None:
            sides = self.vertices.sides(new * np.arange(1, steps, dtype=float))
            return GroundMotion([accel[0], *sides.mean(axis=1), accel[-1]], new, name, self.header)
        if new > self.dt:
            low_pass = scipy.signal.butter(8, 0.7 * self.dt / new, output="sos")
            accel = scipy.signal.sosfiltfilt(low_pass, accel, padlen=min(last, math.ceil(10 * new / self.dt)))
        return GroundMotion(np.interp(new * np.arange(steps + 1), self.times, accel), new, name, self.header)

    def corrected(self, baseline: str | None = None, band: Sequence[float | None] | None = None) -> GroundMotion:
        """The motion without a baseline and within a band of frequencies, as long as before.

        With both, the baseline is taken off before the filter and again after it, which leaves some of its own where
        its zeros before and after the record are cut off.

        `residual_velocity` and `residual_displacement` of both show its effect, and `mr.plotting.record` draws
        them beside each other.

        Args:
            baseline: "constant", "linear" or "quadratic", the polynomial of accelerations that is taken off: that whose
                integral is closest to the velocity. None leaves it.
            band: lower and upper corner of a Butterworth filter [Hz], of fourth order, forwards and backwards, such as
                (0.1, 25.0); one of them may be None. A corner keeps half of the amplitude.

        Raises:
            TypeError, ValueError: for neither of both, another baseline, corners outside 0.001 Hz to 0.49 / dt, or
                pieces, which have no even samples.
        """
        if baseline is None and band is None:
            raise ValueError("corrected takes a baseline, a band, or both")
        self._require_even("corrected takes even samples")
        accel = self.accel if baseline is None else without_baseline(self.accel, self.dt, baseline)
        if band is not None:
            accel = within_band(accel, self.dt, band)
            accel = accel if baseline is None else without_baseline(accel, self.dt, baseline)
        steps = [] if baseline is None else [f"without {baseline} baseline"]
        if band is not None:
            steps += [f"{side} {corner:g} Hz" for side, corner in zip(("above", "below"), band, strict=True) if corner]
        return GroundMotion(accel, self.dt, ", ".join([self.name, *steps]), self.header)

    def _require_even(self, takes: str) -> None:
        """Raise ValueError with what is taken for a motion by pieces."""
        if self.instants is not None:
            finest = min(self.dt, 0.001)
            raise ValueError(f"{takes}, and {self.name} is by pieces; take .resampled({finest:g}), in s, first")

    def headed(self, header: Mapping[str, str]) -> GroundMotion:
        """The same motion with another header."""
        named_so = copy.copy(self)
        keep(named_so, header=dict(header))
        return named_so

    def through_building(
        self,
        period: Periods,
        damping: BuildingDamping = 0.05,
        *,
        participation: Participation = 1.0,
        height: ModeShape = 1.0,
    ) -> GroundMotion:
        """The motion of a floor of a building that vibrates in one or some modes.

        Each mode is a linear oscillator that is solved exactly. What the modes do not account for moves with the
        ground. The motion is followed until the slowest mode has fallen to 1 % of its amplitude.

        Args:
            period: of the modes T_k [s], 0.01 to 100, shape (k,) or one.
            damping: of the building [-], 0.005 to 0.3.
            participation: gamma_k of each mode [-], -3 to 3; 3 n / (2 n + 1) for n equal storeys in the first mode.
            height: psi_k, the shape of each mode at the floor over that at the top [-], -1 to 1; z / H for a straight
                first mode.

        Raises:
            TypeError, ValueError: for a value outside its range, or shapes that differ.
        """
        modes = building_modes(period, damping, participation, height)
        periods, xi, motions = modes.period, modes.damping, modes.motion
        parts = oscillator_steps(self.dt, float(periods.min()))
        h, rings = self.dt / parts, math.log(100.0) * float(periods.max()) / (2 * math.pi * xi)
        steps = parts * (math.ceil(self.duration / self.dt - 1e-9) + math.ceil(rings / self.dt))
        require_size(
            f"the number of samples of {steps * h:g} s at dt = {h:g} s", steps + 1, "leave out the short periods"
        )
        at, rigid, name = h * np.arange(steps + 1, dtype=float), 1 - motions.sum(), f"{self.name} on a floor"
        ground = self(at)
        floor = rigid * ground if self.instants is None else np.zeros(steps + 1)
        for Tk, motion in zip(periods.tolist(), motions.tolist(), strict=True):
            if self.instants is None:
                floor = floor + motion * total_acceleration(ground, h, Tk, xi)
            else:
                floor = floor + motion * of_pieces(self.vertices, at, Tk, xi).acceleration
        moved = GroundMotion(floor, h, name, {**self.header, "FLOOR": modes.label})
        if self.instants is None:
            return moved
        total = moved.vertices.plus(Vertices(self.times, rigid * self.accel))
        return GroundMotion._through_vertices(total, h, name).headed(moved.header)

    @classmethod
    @within_ranges
    def sine(cls, amplitude: Amplitude, period: Span, cycles: Cycles = 1.0, samples: int = 400) -> Self:
        """A sine pulse with `samples` to a cycle. A positive one starts inwards.

        Args:
            amplitude: of the acceleration [m/s2], -1e4 to 1e4.
            period: of the sine [s], 0.01 to 100.
            cycles: number of periods [-], 0.5 to 1000.
            samples: steps to a period, of 1e-5 to 1 s each.

        Raises:
            ValueError: for a value outside its range.
        """
        samples = _samples(samples, period, 2)
        count = math.ceil(cycles * samples)
        require_size("the number of samples", count + 1, "choose fewer cycles or fewer samples to a cycle")
        t = cycles * period * np.arange(count + 1) / count
        accel = amplitude * np.sin(2 * np.pi * t / period)
        return cls(accel, cycles * period / count, f"sine {amplitude:g} m/s2, {period:g} s")

    @classmethod
    @within_ranges
    def half_sine(cls, amplitude: Amplitude, duration: Span, samples: int = 400) -> Self:
        """Half a sine in `samples` steps, at least 2. A positive one pushes inwards.

        Args:
            amplitude: of the acceleration [m/s2], -1e4 to 1e4.
            duration: of the half [s], 0.01 to 100.
            samples: of a period, with a step of 1e-5 to 1 s.

        Raises:
            ValueError: for a value outside its range.
        """
        samples = _samples(samples, duration, 2)
        accel = amplitude * np.sin(np.pi * np.arange(samples + 1) / samples)
        return cls(accel, duration / samples, f"half sine {amplitude:g} m/s2, {duration:g} s")

    @classmethod
    @within_ranges
    def rectangular(cls, amplitude: Amplitude, duration: Span) -> Self:
        """A constant acceleration from zero to `duration`, exactly. A positive one pushes inwards.

        Args:
            amplitude: of the acceleration [m/s2], -1e4 to 1e4.
            duration: of the pulse [s], 0.01 to 100.

        Raises:
            ValueError: for a value outside its range.
        """
        steps = math.ceil(duration / COARSEST)
        name = f"rectangular {amplitude:g} m/s2, {duration:g} s"
        return cls._of_pieces([(duration / steps, amplitude)] * steps, name)

    @classmethod
    def pieces(cls, pieces: Sequence[tuple[PieceDuration, Amplitude]]) -> Self:
        """Constant accelerations one after another, exact where they jump, in every solver.

        A step that spans a jump takes its impulse exactly. A short piece is an impulse: (1e-4, 1e4 v) changes the
        velocity of the ground by v [m/s].

        Args:
            pieces: duration [s], 1e-5 to 1e3, and acceleration [m/s2], -1e6 to 1e6, of each.

        Raises:
            TypeError, ValueError: for what is not at least one pair of them, or a value outside its range.

        Examples:
            >>> pulse = mr.GroundMotion.pieces([(0.3, 2.0), (0.6, -1.0)])
            >>> round(pulse.peak_velocity, 9), round(pulse.residual_velocity, 9)
            (0.6, 0.0)
        """
        takes = "pairs of a duration [s] and an acceleration [m/s2], at least one"
        require_sequence("pieces", pieces, takes)
        require_size("the number of samples", 2 * len(pieces), "give fewer pieces")
        checked = []
        for i, piece in enumerate(pieces):
            if not isinstance(piece, Sequence) or isinstance(piece, str) or len(piece) != 2:
                raise TypeError(f"pieces[{i}] = {shown(piece)} is no pair; pieces takes {takes}")
            duration = require_within(f"duration of pieces[{i}]", piece[0], FINEST, 1e3, "s")
            checked.append((duration, require_within(f"acceleration of pieces[{i}]", piece[1], -1e6, 1e6, "m/s2")))
        if not checked:
            raise ValueError(f"pieces is empty; it takes {takes}")
        return cls._of_pieces(checked, f"{len(checked)} pieces, {sum(duration for duration, _ in checked):g} s")

    @classmethod
    def _of_pieces(cls, pieces: Sequence[tuple[float, float]], name: str) -> Self:
        durations, accel = np.array(pieces, dtype=float).T
        ends = np.cumsum(durations)
        times = np.column_stack((np.append(0.0, ends[:-1]), ends)).ravel()
        return cls._through_vertices(Vertices(times, np.repeat(accel, 2)), float(durations.min()), name)

    @classmethod
    @within_ranges
    def ricker(cls, amplitude: Amplitude, period: Span, antisymmetric: bool = False, samples: int = 400) -> Self:
        """A Ricker wavelet.

        With t from the middle of the wavelet and T the period, the reciprocal of the frequency at which its Fourier
        spectrum peaks,

            symmetric      a = A (1 - 2 u^2) exp(-u^2),           u = pi t / T
            antisymmetric  a = A / beta (s^2 - 3) s exp(-s^2/2),  s = 2 pi t / (sqrt(3) T),  beta = 1.3801

        (Vassiliou and Makris 2011). The symmetric one is given from -1.35 T to 1.35 T, the other from -1.75 T to
        1.75 T, where less than 1e-6 A is left. The motion starts at time zero. A positive one has its large lobe, or
        the first of its two, inwards. The small lobe before it, of 0.45 A or 0.27 A, goes outwards.

        Args:
            amplitude: A, the largest |acceleration|, with its sign [m/s2], -1e4 to 1e4.
            period: T [s], 0.01 to 100.
            antisymmetric: whether it is the antisymmetric one.
            samples: steps to a period, at least 10, of 1e-5 to 1 s each.

        Raises:
            ValueError: for a value outside its range.
        """
        samples = _samples(samples, period, 10)
        symmetry = "antisymmetric" if require_flag("antisymmetric", antisymmetric) else "symmetric"
        half = math.ceil((1.75 if antisymmetric else 1.35) * samples)
        t = np.arange(-half, half + 1) / samples
        u, s = np.pi * t, 2 * np.pi / math.sqrt(3) * t
        shape = (s**2 - 3) * s * np.exp(-(s**2) / 2) if antisymmetric else (1 - 2 * u**2) * np.exp(-(u**2))
        accel = amplitude * shape / np.abs(shape).max()
        return cls(accel, period / samples, f"{symmetry} Ricker {amplitude:g} m/s2, {period:g} s")

    @classmethod
    @within_ranges
    def synthetic(
        cls,
        peak: Annotated[float, Within(1e-3, 100, "m/s2")],
        duration: Annotated[float, Within(1, 1000, "s")],
        *,
        seed: Annotated[int, Within(0, 2**53, whole=True)],
        dt: SampleStep = 0.01,
        ground_frequency: Annotated[float, Within(0.1, 50, "Hz")] = 2.5,
        ground_damping: Annotated[float, Within(0.05, 2)] = 0.6,
        filter_frequency: Annotated[float, Within(0.01, 50, "Hz")] = 0.25,
        filter_damping: Annotated[float, Within(0.05, 2)] = 0.6,
        rise: Annotated[float, Within(0.01, 0.99)] = 0.15,
        fall: Annotated[float, Within(0.01, 0.99)] = 0.35,
    ) -> Self:
        """An artificial record with random phases under a stated spectrum and envelope.

        Cosines at the frequencies f_k = k / duration up to Nyquist are summed (Shinozuka). Their phases are drawn by
        numpy's default_rng: the same seed gives the same bytes. Their power spectral density is that of Kanai and
        Tajimi, high-passed after Clough and Penzien,

            S(f) ~ (1 + (2 zg x)^2) / ((1 - x^2)^2 + (2 zg x)^2) * y^4 / ((1 - y^2)^2 + (2 zf y)^2),
            x = f / ground_frequency,  y = f / filter_frequency,  zg, zf the damping ratios.

        The sum is multiplied by a trapezoid. A multiple of the trapezoid is subtracted so that the ground ends at rest.
        It may end displaced.

        Args:
            peak: largest |acceleration| [m/s2], 1e-3 to 100.
            duration: of the record, to the nearest step [s], 1 to 1000.
            seed: of the phases, a whole number, 0 to 9007199254740992.
            dt: time step [s], 1e-5 to 1 and at most a quarter of the ground's period.
            ground_frequency: of the soil layer [Hz], 0.1 to 50.
            ground_damping: of the soil layer [-], 0.05 to 2.
            filter_frequency: of the high-pass [Hz], 0.01 to 50 and at most ground_frequency.
            filter_damping: of the high-pass [-], 0.05 to 2.
            rise: share of the duration over which the envelope rises [-], 0.01 to 0.99.
            fall: share over which it falls [-], 0.01 to 0.99 and at most 1 less the rise.

        Raises:
            ValueError: for a value outside its range.
        """
        filter_frequency = require_within("filter_frequency", filter_frequency, 0.01, ground_frequency, "Hz")
        dt = require_within("time step dt", dt, FINEST, min(COARSEST, 0.25 / ground_frequency), "s")
        fall = require_within("fall", fall, 0.01, 1 - rise)
        steps = round(duration / dt)
        remedy = "choose a shorter duration or a longer dt"
        require_size(f"the number of samples of {duration:g} s at dt = {dt:g} s", steps + 1, remedy)
        x, y = (np.fft.rfftfreq(steps, dt) / f for f in (ground_frequency, filter_frequency))
        soil = (1 + (2 * ground_damping * x) ** 2) / ((1 - x**2) ** 2 + (2 * ground_damping * x) ** 2)
        high_pass = y**4 / ((1 - y**2) ** 2 + (2 * filter_damping * y) ** 2)
        phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, len(x))
        stationary = np.fft.irfft(np.sqrt(soil * high_pass) * np.exp(1j * phases), steps)
        envelope = np.interp(np.arange(steps + 1) / steps, [0, rise, 1 - fall, 1], [0, 1, 1, 0])
        accel = envelope * np.append(stationary, stationary[0])
        accel -= envelope * accel.sum() / envelope.sum()
        return cls(peak / np.abs(accel).max() * accel, dt, f"synthetic {peak:g} m/s2, seed {seed}")

    @classmethod
    def from_file(
        cls, path: str | PathLike[str], component: str | None = None, *, unit: str | float | None = None
    ) -> GroundMotion:
        """A component of a file of any format that states its time step. Its first lines show the format.

        PEER AT2, ESM and ITACA, K-NET and KiK-net, GeoNet V1A and V2A, SMC, CSMIP and COSMOS V1 and V2, UNAM; a table
        whose header states step and unit; SAC, miniSEED and more by ObsPy (the extra `obspy`), which know no unit.
        `components_in` gives all components of a file.

        Args:
            path: the file.
            component: which one, as the file names it in STREAM, such as "360", "UP", "NS"; None for the only one.
            unit: of a file that states none: "m/s2", "cm/s2", "mm/s2", "g", "ft/s2", or how many m/s2 a count is.

        Raises:
            OSError: if the file cannot be read.
            ImportError: for a file that ObsPy reads, if it is missing.
            ValueError: for another format, a component that is not there, and for what `from_at2` refuses.
        """
        require_kind("component", component, str, type(None))
        traces = read(path, lambda file: recognised(file, unit))
        streams = [trace.header.get("STREAM", "") for trace in traces]
        fit = [trace for trace, name in zip(traces, streams, strict=True) if component in (None, name)]
        if len(fit) != 1:
            raise ValueError(f"{path}: component = {component!r}; the file has {', '.join(map(repr, streams))}")
        return motion_of(fit[0], path)

    @classmethod
    def from_at2(cls, path: str | PathLike[str]) -> GroundMotion:
        """A record of the PEER NGA data base, in g, named after its file.

        Raises:
            OSError: if the file cannot be read.
            ValueError: for another format or unit, another number of samples than is stated, or no finite number.
        """
        return cls._from_text(path, parse_at2)

    @classmethod
    def from_esm(cls, path: str | PathLike[str]) -> GroundMotion:
        """A record of the European ESM or the Italian ITACA data base, a file .ASC of accelerations.

        It is named after network, station, component and event. `header` keeps all fields of the header.

        Raises:
            OSError: if the file cannot be read.
            ValueError: for another format or unit, another number of samples than is stated, or no finite number.
        """
        return cls._from_text(path, parse_esm)

    def to_esm(self, path: str | PathLike[str], **header: str) -> Path:
        """Write the motion as a file of the ESM data base, which `from_esm` and other programs read.

        Args:
            path: the file.
            header: further fields, such as STATION_CODE="AMT" or STREAM="HNE", beside those of `header`. Unit, step and
                number of samples are those of the motion.

        Raises:
            OSError: if the file cannot be written.
            ValueError: for a field that a file of ESM cannot have, or pieces, which have no even samples.
        """
        self._require_even("a file of ESM takes even samples")
        for name, value in header.items():
            require_kind(name, value, str)
        return write_text(require_path("path", path), esm_text(self.accel, self.dt, {**self.header, **header}))

    @classmethod
    def from_csv(
        cls,
        path: str | PathLike[str],
        unit: str | float | None = None,
        *,
        time_unit: str = "s",
        dt: float | None = None,
        columns: int | str | Sequence[int | str] | None = None,
        skip: int | None = None,
        sheet: str | None = None,
    ) -> GroundMotion:
        """A record of a table, in text or a spreadsheet, named after its file; its first row is time zero.

        The table has two columns, time and acceleration, or with `dt` one, the accelerations; of more columns some are
        chosen. With `dt`, samples may also stand in rows, of 5 or 8 for instance. Commas, semicolons, or blanks and
        tabs set the columns apart. A header and lines that begin with #, % or // are skipped. A comma may be a decimal
        point.

        The header, and numbers before the samples, are compared with the arguments. The error shows the values
        of `skip` for either reading.

        Args:
            path: the file: a text, a spreadsheet (.xlsx, .xls, .ods; the extra `frames`), or variables of MATLAB (.mat,
                up to version 7).
            unit: of the accelerations: "m/s2", "cm/s2", "mm/s2", "g" (9.81 m/s2) or "ft/s2", or how many m/s2 it is;
                None for the one that the header names.
            time_unit: "s" or "ms".
            dt: time step, in the time unit; None for that of a column of times or of the header. Beside a column of
                times it has to agree with them.
            columns: time and acceleration, or with `dt` the acceleration, by number from 0 or by name; "rows" for
                samples, or pairs of a time and an acceleration, in rows.
            skip: how many lines to leave out at the start; what they state is not looked at.
            sheet: name of a sheet of a spreadsheet, or of a variable of MATLAB, which has with it all variables of its
                length; None for the only one with rows of numbers.

        Raises:
            OSError: if the file cannot be read.
            ValueError: for an unknown unit, times that do not increase evenly (within 1 % of their step, or what their
                decimals round), what is not a finite number, and where the text can be read in two ways,
                with the line and both readings.
        """
        traces = table_traces(path, TableOptions(unit, time_unit, dt, columns, skip, sheet))
        if len(traces) > 1:
            raise ValueError(f"{path}: columns has {len(traces)} accelerations; components_in reads them all")
        return motion_of(traces[0], path)

    @classmethod
    def from_sac(cls, path: str | PathLike[str], unit: str | float | None = None) -> GroundMotion:
        """A record in the plain text of a SAC set, named after its file: a title, count and time step, values.

        A binary SAC file of seismology is read by `from_file`.

        Args:
            path: the file.
            unit: as in `from_csv`. The file does not state it. Without it, cm/s2 are taken, with a warning.

        Raises:
            OSError: if the file cannot be read.
            ValueError: for another format, another number of samples than is stated, or what is not a finite number.
        """
        if unit is None:
            message = "the text of a SAC set states no unit: give unit=, which will be needed; cm/s2 are taken"
            warn_of(message, FutureWarning)
        return cls._from_text(path, lambda lines: parse_sac(lines, "cm/s2" if unit is None else unit))

    @classmethod
    def _from_text(cls, path: str | PathLike[str], parse: Parse) -> GroundMotion:
        return motion_of(read(path, lambda file: parse(text_lines(file)))[0], path)


def motion_of(trace: Trace, path: str | PathLike[str]) -> GroundMotion:
    """The motion of a trace, named after its header or its file, and warnings about its unit and its baseline."""
    header = trace.header
    named = [header[field] for field in NAME_FIELDS if header.get(field)] if header.get("STATION_CODE") else []
    named += [] if named else [Path(path).stem, *(header.values() if list(header) == ["STREAM"] else ())]
    motion = GroundMotion._of_file(trace.accel, trace.dt, name := " ".join(named), header)
    peak, final, fastest = motion.peak, motion.residual_velocity, motion.peak_velocity
    if peak < SMALL_PEAK:
        remark = "" if "UNITS" in header else "; is its unit right?"
        warn_of(f"{name} peaks at {peak:g} m/s2 = {peak / GRAVITY:.3g} g only{remark}")
    if abs(final) > DRIFT_WARNED_OF * fastest:
        warn_of(
            f"{name} drifts: its residual velocity is {final:.3g} m/s, its peak velocity {fastest:.3g} m/s; it needs a "
            "baseline correction, motion.corrected(baseline='linear')"
        )
    return motion


def _instants(t: ArrayLike) -> Array:
    times = require_reals("t", t, "one or more times [s]")
    if np.isnan(times).any():
        raise ValueError("t holds nan; it takes one or more times [s]")
    return times


def _samples(value: int, span: float, fewest: int) -> int:
    """The number of steps to a span [s], such that a step is one of a motion."""
    return require_whole("samples", value, max(fewest, math.ceil(span / COARSEST)), math.floor(span / FINEST))


def integral(accel: Array, dt: float | Array) -> Array:
    """Integral from zero of a motion that is linear between its samples, at each of them, shape (n,); `dt` is the step
    between all or between each two [s]."""
    return np.concatenate(([0.0], np.cumsum(0.5 * dt * (accel[1:] + accel[:-1]))))


def without_baseline(accel: Array, dt: float, baseline: str) -> Array:
    """Accelerations less a polynomial of time, that whose integral is closest to the velocity in the mean square.

    The velocity starts at zero (Boore, 2001: Bull. Seism. Soc. Am. 91, 1199-1211).

    Raises:
        ValueError: for another baseline than one of BASELINES.
    """
    degree = BASELINES[require_one_of("baseline", baseline, BASELINES)]
    powers = np.linspace(0, 1, len(accel))[:, None] ** np.arange(degree + 1)
    velocities = np.column_stack([integral(power, dt) for power in powers.T])
    factors = np.linalg.lstsq(velocities, integral(accel, dt), rcond=None)[0]
    return np.asarray(accel - powers @ factors)


def within_band(accel: Array, dt: float, band: Sequence[float | None]) -> Array:
    """Accelerations through a Butterworth filter of fourth order, forwards and backwards, which shifts no phase.

    It runs over zeros before and after the record, for 1.5 orders of periods of the lower corner (Boore, 2005: Bull.
    Seism. Soc. Am. 95, 745-750), which are cut off again.

    Args:
        accel: accelerations, shape (n,).
        dt: time step [s].
        band: lower and upper corner [Hz], where half of the amplitude is left; None leaves that side open.

    Raises:
        TypeError, ValueError: unless they are two, one of them at least, within 0.001 Hz and half of the samples a
            second.
    """
    if isinstance(band, str) or not isinstance(band, Sequence) or len(band) != 2 or all(x is None for x in band):
        raise TypeError(f"band = {shown(band)} is not a pair of corners [Hz], one of which may be None")
    low, high = band
    if low is not None:
        low = require_within("lower corner of band", low, 1e-3, 0.49 / dt, "Hz")
    if high is not None:
        high = require_within("upper corner of band", high, max(1e-3, 1.01 * (low or 0.0)), 0.49 / dt, "Hz")
    pad = math.ceil(1.5 * FILTER_ORDER / ((low or high) * dt))  # type: ignore[operator]
    require_size("the number of samples with zeros around them", len(accel) + 2 * pad, "raise the lower corner")
    corners, filter_type = (low or high, "low" if low is None else "high") if None in band else (band, "band")
    sos = scipy.signal.butter(FILTER_ORDER, corners, filter_type, output="sos", fs=1 / dt)
    filtered = scipy.signal.sosfiltfilt(sos, np.pad(accel, pad), padtype=None)
    return np.asarray(filtered[pad : pad + len(accel)])
