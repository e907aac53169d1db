"""Ground motions given by a formula: sine, half sine, rectangle, Ricker wavelets, and artificial records."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Self

import numpy as np

from ...quantities import Array, require_flag, require_size, require_whole, require_within
from .records import COARSEST, FINEST

LARGEST = 1e4
"""Bound of the amplitude of a pulse [m/s2]."""


def _amplitude(value: float) -> float:
    return require_within("amplitude", value, -LARGEST, LARGEST, "m/s2")


def _span(name: str, value: float) -> float:
    return require_within(name, value, 1e-2, 100.0, "s")


def _samples(value: int, span: float, least: int) -> int:
    """The number of steps to a span [s], such that a step is one of a motion."""
    return require_whole("samples", value, max(least, math.ceil(span / COARSEST)), math.floor(span / FINEST))


class Pulses:
    """What `GroundMotion` can be made as by a formula."""

    if TYPE_CHECKING:

        def __init__(self, accel: Array, dt: float, name: str) -> None:
            """As `GroundMotion`."""

    @classmethod
    def sine(cls, amplitude: float, period: float, cycles: float = 1.0, samples: int = 400) -> Self:
        """A sine pulse of `amplitude` [m/s2] and `period` [s], `samples` to a cycle. A positive one starts inwards.

        Raises:
            ValueError: for a period outside 0.01 to 100 s, cycles outside 0.5 to 1000, or steps outside 1e-5 to 1 s.
        """
        amplitude, period = _amplitude(amplitude), _span("period", period)
        cycles, samples = require_within("cycles", cycles, 0.5, 1e3), _samples(samples, period, 2)
        count = math.ceil(cycles * samples)
        require_size("the number of samples", count + 1, "choose fewer cycles or fewer samples to a cycle")
        t = cycles * period * np.arange(count + 1) / count
        accel = amplitude * np.sin(2 * np.pi * t / period)
        return cls(accel, cycles * period / count, f"sine {amplitude:g} m/s2, {period:g} s")

    @classmethod
    def half_sine(cls, amplitude: float, duration: float, samples: int = 400) -> Self:
        """Half a sine of `amplitude` [m/s2] over `duration` [s], in `samples` steps. A positive one pushes inwards.

        Raises:
            ValueError: for a duration outside 0.01 to 100 s, fewer than 2 samples, or steps outside 1e-5 to 1 s.
        """
        amplitude, duration = _amplitude(amplitude), _span("duration", duration)
        samples = _samples(samples, duration, 2)
        accel = amplitude * np.sin(np.pi * np.arange(samples + 1) / samples)
        return cls(accel, duration / samples, f"half sine {amplitude:g} m/s2, {duration:g} s")

    @classmethod
    def rectangular(cls, amplitude: float, duration: float) -> Self:
        """A constant `amplitude` [m/s2] from zero to `duration` [s], exactly. A positive one pushes inwards.

        Raises:
            ValueError: for a duration outside 0.01 to 100 s.
        """
        amplitude, duration = _amplitude(amplitude), _span("duration", duration)
        steps = math.ceil(duration)
        name = f"rectangular {amplitude:g} m/s2, {duration:g} s"
        return cls(np.full(steps + 1, amplitude), duration / steps, name)

    @classmethod
    def ricker(cls, amplitude: float, period: float, antisymmetric: bool = False, samples: int = 400) -> Self:
        """A Ricker wavelet whose largest |acceleration| is `amplitude` [m/s2], with `samples` to a `period` [s].

        With t from the middle of the wavelet and T the period, the reciprocal of the frequency at which its Fourier
        spectrum peaks,

            symmetric      a = A (1 - 2 u^2) exp(-u^2),           u = pi t / T
            antisymmetric  a = A / beta (s^2 - 3) s exp(-s^2/2),  s = 2 pi t / (sqrt(3) T),  beta = 1.3801

        (Vassiliou and Makris 2011). The symmetric one is given from -1.35 T to 1.35 T, the other from -1.75 T to
        1.75 T, where less than 1e-6 A is left. The motion starts at time zero. A positive one has its large lobe, or
        the first of its two, inwards. The small lobe before it, of 0.45 A or 0.27 A, goes outwards.

        Raises:
            ValueError: for a period outside 0.01 to 100 s, fewer than 10 samples, or steps outside 1e-5 to 1 s.
        """
        amplitude, period = _amplitude(amplitude), _span("period", period)
        samples = _samples(samples, period, 10)
        kind = "antisymmetric" if require_flag("antisymmetric", antisymmetric) else "symmetric"
        half = math.ceil((1.75 if antisymmetric else 1.35) * samples)
        t = np.arange(-half, half + 1) / samples
        u, s = np.pi * t, 2 * np.pi / math.sqrt(3) * t
        shape = (s**2 - 3) * s * np.exp(-(s**2) / 2) if antisymmetric else (1 - 2 * u**2) * np.exp(-(u**2))
        accel = amplitude * shape / np.abs(shape).max()
        return cls(accel, period / samples, f"{kind} Ricker {amplitude:g} m/s2, {period:g} s")

    @classmethod
    def synthetic(
        cls,
        peak: float,
        duration: float,
        *,
        seed: int,
        dt: float = 0.01,
        ground_frequency: float = 2.5,
        ground_damping: float = 0.6,
        filter_frequency: float = 0.25,
        filter_damping: float = 0.6,
        rise: float = 0.15,
        fall: float = 0.35,
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
            seed: of the phases, a whole number from 0 to 2**53.
            dt: time step [s], at most a quarter of the ground's period.
            ground_frequency, ground_damping: of the soil layer [Hz, -], 0.1 to 50 and 0.05 to 2.
            filter_frequency, filter_damping: of the high-pass [Hz, -], 0.01 to ground_frequency and 0.05 to 2.
            rise, fall: shares of the duration over which the envelope rises and falls [-], above 0, together at most 1.

        Raises:
            ValueError: for a value outside its range.
        """
        peak = require_within("peak", peak, 1e-3, 100.0, "m/s2")
        duration = require_within("duration", duration, 1.0, 1e3, "s")
        seed = require_whole("seed", seed, 0, 2**53)
        ground_frequency = require_within("ground_frequency", ground_frequency, 0.1, 50.0, "Hz")
        ground_damping = require_within("ground_damping", ground_damping, 0.05, 2.0)
        filter_frequency = require_within("filter_frequency", filter_frequency, 0.01, ground_frequency, "Hz")
        filter_damping = require_within("filter_damping", filter_damping, 0.05, 2.0)
        dt = require_within("time step dt", dt, FINEST, min(COARSEST, 0.25 / ground_frequency), "s")
        rise = require_within("rise", rise, 0.01, 0.99)
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
