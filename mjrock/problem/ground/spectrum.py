"""Response spectra of a ground motion, and motions scaled to them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import Array, require_kind, require_reals, require_row, require_within, short_repr
from .code_spectrum import SpectrumOfCode
from .motion import GroundMotion
from .oscillator import LONGEST_PERIOD, SHORTEST_PERIOD, oscillator_steps, relative_displacement


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """The largest response of linear oscillators to a ground motion.

    Args:
        period: their periods T [s], shape (n,).
        Sd: largest displacement relative to the ground [m], shape (n,).
        damping: their damping ratio [-].
    """

    period: Array
    Sd: Array
    damping: float

    __repr__ = short_repr

    @property
    def Sv(self) -> Array:
        """Pseudo-velocity 2 pi / T Sd [m/s], shape (n,)."""
        return 2 * math.pi / self.period * self.Sd

    @property
    def Sa(self) -> Array:
        """Pseudo-acceleration (2 pi / T)^2 Sd [m/s2], shape (n,)."""
        return (2 * math.pi / self.period) ** 2 * self.Sd

    @property
    def mean(self) -> float:
        """Geometric mean of Sa over the periods, a measure of intensity [m/s2]."""
        return float(np.exp(np.log(self.Sa).mean()))


def response_spectrum(motion: GroundMotion, periods: ArrayLike, damping: float = 0.05) -> ResponseSpectrum:
    """The response spectrum of a ground motion.

    Each oscillator is solved exactly for an acceleration that is linear between its samples, and followed for one
    period after the last of them.

    Args:
        motion: the ground motion.
        periods: periods [s], 0.01 to 100, shape (n,), or one.
        damping: damping ratio [-], 0 to 0.9.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    require_kind("motion", motion, GroundMotion)
    damping = require_within("damping", damping, 0.0, 0.9)
    T = require_row("periods", np.atleast_1d(require_reals("periods", periods, "periods [s]")), "period [s]")
    for period in T:
        require_within("periods", period, SHORTEST_PERIOD, LONGEST_PERIOD, "s")
    largest = np.array([_largest(motion, float(period), damping) for period in T])
    return ResponseSpectrum(T, largest, damping)


def _largest(motion: GroundMotion, period: float, damping: float) -> float:
    """The largest displacement of an oscillator relative to the ground [m]."""
    parts = oscillator_steps(motion.dt, period)
    h = motion.dt / parts
    steps = parts * (len(motion.accel) - 1) + math.ceil(period / h)
    return float(np.abs(relative_displacement(motion(h * np.arange(steps + 1, dtype=float)), h, period, damping)).max())


def scaled_to_sa(motion: GroundMotion, period: float, sa: float, damping: float = 0.05) -> GroundMotion:
    """The motion scaled to a pseudo-acceleration Sa(T).

    Args:
        motion: the ground motion.
        period: T [s], 0.01 to 100.
        sa: the pseudo-acceleration asked for [m/s2], 1e-6 to 1e4.
        damping: damping ratio [-], 0 to 0.9.

    Raises:
        TypeError, ValueError: for a value outside its range, or a motion at rest.
    """
    period = require_within("period", period, SHORTEST_PERIOD, LONGEST_PERIOD, "s")
    return scaled_to_spectrum(motion, [period], [require_within("sa", sa, 1e-6, 1e4, "m/s2")], damping)


def scaled_to_spectrum(
    motion: GroundMotion,
    periods: ArrayLike,
    target: ArrayLike | SpectrumOfCode,
    damping: float = 0.05,
) -> GroundMotion:
    """The motion scaled so that the geometric mean of its Sa over that of a target spectrum is one.

    One factor for the whole motion has the least squares of ln(Sa / target) over the periods.

    Args:
        motion: the ground motion.
        periods: periods [s], 0.01 to 100, shape (n,).
        target: pseudo-accelerations Sa of the target at them [m/s2], 1e-6 to 1e4, shape (n,), or a spectrum of a code.
        damping: damping ratio [-], 0 to 0.9.

    Raises:
        TypeError, ValueError: for a value outside its range, shapes that differ, or a motion at rest.
    """
    factor = factor_to_spectrum(motion, periods, target, damping)  # refuses what is no motion
    return motion.scaled(factor)


def factor_to_spectrum(
    motion: GroundMotion, periods: ArrayLike, target: ArrayLike | SpectrumOfCode, damping: float
) -> float:
    """The factor of `scaled_to_spectrum` [-]."""
    spectrum = response_spectrum(motion, periods, damping)
    if isinstance(target, SpectrumOfCode):
        target = target(spectrum.period, damping)
    asked = require_row("target", target, "pseudo-acceleration [m/s2]")
    for value in asked:
        require_within("target", value, 1e-6, 1e4, "m/s2")
    if asked.shape != spectrum.period.shape:
        raise ValueError(f"target has {len(asked)} values and periods {len(spectrum.period)}; they have to be pairs")
    if motion.peak == 0:
        raise ValueError("motion is at rest: no factor gives it a spectrum")
    return float(np.exp(np.log(asked / spectrum.Sa).mean()))
