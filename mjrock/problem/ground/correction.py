"""Correction of records: a baseline that is taken off, and a band of frequencies that is kept."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy

from ...quantities import Array, require_size, require_within, shown

BASELINES = {"constant": 0, "linear": 1, "quadratic": 2}
"""Degree of the polynomial of accelerations that is taken off, by name."""
ORDER = 4
"""Order of the Butterworth filter, which runs forwards and backwards."""


def integral(accel: Array, dt: float) -> Array:
    """Integral from zero of what is linear between its samples, at each of them, shape (n,)."""
    return np.concatenate(([0.0], np.cumsum(0.5 * dt * (accel[1:] + accel[:-1]))))


def without_baseline(accel: Array, dt: float, baseline: str) -> Array:
    """Accelerations less a polynomial of time, that whose integral is closest to the velocity in the mean square.

    The velocity starts at zero (Boore, 2001: Bull. Seism. Soc. Am. 91, 1199-1211).

    Raises:
        ValueError: for another baseline than one of BASELINES.
    """
    if not isinstance(baseline, str) or baseline not in BASELINES:
        raise ValueError(f"baseline = {shown(baseline)}; the valid ones are {', '.join(BASELINES)} and None")
    powers = np.linspace(0, 1, len(accel))[:, None] ** np.arange(BASELINES[baseline] + 1)
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
    pad = math.ceil(1.5 * ORDER / ((low or high) * dt))  # type: ignore[operator]
    require_size("the number of samples with zeros around them", len(accel) + 2 * pad, "raise the lower corner")
    corners, kind = (low or high, "low" if low is None else "high") if None in band else (band, "band")
    sos = scipy.signal.butter(ORDER, corners, kind, output="sos", fs=1 / dt)
    filtered = scipy.signal.sosfiltfilt(sos, np.pad(accel, pad), padtype=None)
    return np.asarray(filtered[pad : pad + len(accel)])
