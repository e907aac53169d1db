"""The motion of bodies at the samples of a response, and interpolation between steps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Protocol

import numpy as np

from ..compiled import compiled, inlined
from ..quantities import Array, Integers, Within, require_within


class Motion(Protocol):
    """Where bodies are at the samples, how fast they move, and their energy, as in `Response`."""

    @property
    def pose(self) -> Array:
        """Displacements and rotations from rest, shape (n, bodies, 3), or (n, bodies, 7) in space."""

    @property
    def velocity(self) -> Array:
        """Their rates, shape (n, bodies, 3), or (n, bodies, 6) in space."""

    @property
    def energy(self) -> Array:
        """Energy above rest [J], shape (n,)."""

    @property
    def theta(self) -> Array:
        """Rotations of the bodies of the plane [rad], shape (n, bodies)."""


@dataclass(frozen=True, eq=False)
class SampledMotion:
    """A motion that is given by its samples, see `Motion`."""

    pose: Array
    velocity: Array
    energy: Array

    @property
    def theta(self) -> Array:
        """Rotations of the bodies of the plane [rad], shape (n, bodies)."""
        return self.pose[:, :, 2]


TIME_ROUNDING = 1e-12
"""Part of an interval that counts as rounding, over the number of intervals [-]."""


SPACINGS = Within(1e-9, 1e6, "s")
"""Range of a requested spacing of samples."""
OutputStep = Annotated[float | None, SPACINGS]
"""Largest spacing of the samples of an answer."""
RelativeError = Annotated[float, Within(1e-14, 0.1)]
"""Relative tolerance of an integration."""


def required_spacing(output_step: OutputStep, duration: float, otherwise: float = 1e-3) -> float:
    """The requested largest spacing of samples, checked; `otherwise` where none is [s]."""
    if output_step is None:
        return min(otherwise, duration)
    return SPACINGS.up_to(duration).checked("output_step", output_step)


def intervals(duration: float, spacing: float) -> int:
    """The fewest equal intervals of a duration that are not longer than a spacing, at least one."""
    return max(1, math.ceil(duration / spacing * (1 - TIME_ROUNDING)))


def whole_steps(spacing: float, timestep: float) -> int:
    """The most steps of one length that take no longer than a spacing, at least one."""
    return max(1, math.floor(spacing / timestep * (1 + TIME_ROUNDING)))


def thinned(count: int, stride: int) -> Integers:
    """Numbers of every `stride`-th of some samples, and of the last, which is the end of a run."""
    return np.unique(np.append(np.arange(0, count, stride), count - 1))


def sample_at(t: Array, at: float | None) -> int:
    """Number of the last of some samples up to a time [s], or of the last of all.

    Args:
        t: times of the samples [s], shape (n,).
        at: the time, or None.

    Raises:
        ValueError: if the samples do not reach that time.
    """
    first, last = float(t[0]), float(t[-1])
    at = last if at is None else require_within("at", at, first, last, "s")
    return int(np.searchsorted(t, at * (1 + 1e-12), side="right")) - 1


@inlined
def cubic(width: float, y0: float, v0: float, y1: float, v1: float) -> tuple[float, float]:
    """Coefficients of s^2 and s^3 of the cubic y0 + v0 s + ... that has the values y and the rates v at both ends.

    Args:
        width: distance of the ends; s goes from 0 to it.
        y0, v0, y1, v1: values and rates at the ends.
    """
    slope = (y1 - y0) / width
    return (3 * slope - 2 * v0 - v1) / width, (v0 + v1 - 2 * slope) / (width * width)


def interpolated(t: Array, y: Array, v: Array, at: Array) -> tuple[Array, Array]:
    """Values and rates at increasing times, by cubic Hermite interpolation between the steps.

    Args:
        t: times of the steps [s], shape (steps,). Two may be equal, where a rate jumps.
        y, v: values and rates at the steps, shape (steps, columns).
        at: requested times [s], increasing and within those of the steps, shape (samples,).
    """
    values, rates = np.empty((len(at), y.shape[1])), np.empty((len(at), y.shape[1]))
    _interpolate(t, y, v, at, values, rates)
    return values, rates


@compiled
def _interpolate(t: Array, y: Array, v: Array, at: Array, values: Array, rates: Array) -> None:
    first = 0
    for i in range(len(t) - 1):
        width, end = t[i + 1] - t[i], first
        while end < len(at) and (at[end] <= t[i + 1] or i == len(t) - 2):
            end += 1
        for j in range(y.shape[1] if end > first else 0):
            c2, c3 = cubic(width, y[i, j], v[i, j], y[i + 1, j], v[i + 1, j]) if width > 0 else (0.0, 0.0)
            for k in range(first, end):
                s = at[k] - t[i]
                values[k, j] = y[i, j] + s * (v[i, j] + s * (c2 + s * c3))
                rates[k, j] = v[i, j] + s * (2 * c2 + 3 * s * c3)
        first = end
