"""Samples of a motion between its steps."""

from __future__ import annotations

import numpy as np

from ..compiled import compiled, jitable
from ..problem.quantities import Array


@jitable
def hermite(u: float, width: float, y0: float, v0: float, y1: float, v1: float) -> tuple[float, float]:
    """Value and rate of the cubic that has the values y and the rates v at both ends.

    Args:
        u: place between the ends, 0 to 1 [-].
        width: distance of the ends.
        y0, v0, y1, v1: values and rates at the ends.
    """
    turned, swept = y1 - y0, width
    value = y0 + u * (swept * v0 + u * (3 * turned - swept * (2 * v0 + v1) + u * (swept * (v0 + v1) - 2 * turned)))
    rate = v0 + u * (6 * turned / swept - 4 * v0 - 2 * v1 + u * (3 * (v0 + v1) - 6 * turned / swept))
    return value, rate


def interpolated(t: Array, y: Array, v: Array, at: Array) -> tuple[Array, Array]:
    """Values and rates at increasing times, by cubic Hermite interpolation between the steps.

    Args:
        t: times of the steps [s], increasing, shape (steps,).
        y, v: values and rates at the steps, shape (steps, columns).
        at: times asked for [s], increasing and within those of the steps, shape (samples,).
    """
    values, rates = np.empty((2, len(at), y.shape[1]))
    _interpolate(t, y, v, at, values, rates)
    return values, rates


@compiled
def _interpolate(t: Array, y: Array, v: Array, at: Array, values: Array, rates: Array) -> None:
    i = 0
    for k in range(len(at)):
        while i < len(t) - 2 and t[i + 1] < at[k]:
            i += 1
        width = t[i + 1] - t[i]
        u = (at[k] - t[i]) / width
        for j in range(y.shape[1]):
            values[k, j], rates[k, j] = hermite(u, width, y[i, j], v[i, j], y[i + 1, j], v[i + 1, j])
