"""Another time step for a record."""

from __future__ import annotations

import math

import numpy as np
import scipy

from ...quantities import MOST_SAMPLES, Array, require_size
from .records import Record


def resample(accel: Array, dt: float, new: float) -> Record:
    """Accelerations [m/s2] at the time step `new` instead of `dt` [s], linear between the old samples.

    Before a coarser step, the record goes through an eighth-order Butterworth filter, forwards and backwards: 0.7 of
    the new Nyquist frequency keeps half its amplitude, the Nyquist frequency 0.3 %. A finer step that divides the old
    one to rounding is made to divide it exactly.

    Raises:
        ValueError: for a step that gives more than MOST_SAMPLES.
    """
    last, parts = len(accel) - 1, round(dt / new)
    if parts and math.isclose(parts * new, dt):
        new, steps = dt / parts, parts * last
    else:
        steps = round(last * dt / new)
    remedy = f"make dt longer than {last * dt / MOST_SAMPLES:.3g} s"
    require_size(f"the number of samples of {last * dt:g} s at dt = {new:g} s", steps + 1, remedy)
    if new > dt:
        low_pass = scipy.signal.butter(8, 0.7 * dt / new, output="sos")
        accel = scipy.signal.sosfiltfilt(low_pass, accel, padlen=min(last, math.ceil(10 * new / dt)))
    return np.interp(new * np.arange(steps + 1), dt * np.arange(last + 1), accel), new
