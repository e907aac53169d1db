"""Linear oscillators on a moving ground, solved exactly for an acceleration that is linear between its samples."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Annotated, NamedTuple, get_args

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ...quantities import Array, Within, require_reals, require_row, require_within, within_ranges
from .vertices import Vertices

STEPS_A_PERIOD = 20
"""Steps to a period at least, between which the peak of a sine is missed by at most 1.2 %."""
SHORTEST_PERIOD, LONGEST_PERIOD = 0.01, 100.0
"""Bounds of a period [s]."""
Periods = Annotated[ArrayLike, Within(SHORTEST_PERIOD, LONGEST_PERIOD, "s")]
Participation = Annotated[ArrayLike, Within(-3, 3)]
ModeShape = Annotated[ArrayLike, Within(-1, 1)]
BuildingDamping = Annotated[float, Within(0.005, 0.3)]
"""Periods, participation and shape of the modes of a building, and its damping, see `building_modes`."""


def oscillator_steps(dt: float, period: float) -> int:
    """Steps of an oscillator to one of the ground, whose length is dt [s]."""
    return math.ceil(STEPS_A_PERIOD * dt / period)


def relative_displacement(accel: Array, h: float, period: float, damping: float) -> Array:
    """Displacement of an oscillator relative to the ground [m], shape (n,), from the acceleration of the ground every
    h seconds [m/s2], shape (n,)."""
    return _answer(accel, h, period, damping, (1.0, 0.0))


def total_acceleration(accel: Array, h: float, period: float, damping: float) -> Array:
    """Acceleration of an oscillator, that of the ground included [m/s2], shape (n,)."""
    omega = 2 * math.pi / period
    return _answer(accel, h, period, damping, (-(omega**2), -2 * damping * omega))


def _answer(accel: Array, h: float, period: float, damping: float, reading: tuple[float, float]) -> Array:
    """What is read from displacement and velocity of an oscillator relative to the ground."""
    numerator, denominator = _filter_of(h, period, damping, reading)
    return np.asarray(scipy.signal.lfilter(numerator, denominator, accel))


@lru_cache(maxsize=1024)
def _filter_of(h: float, period: float, damping: float, reading: tuple[float, float]) -> tuple[Array, Array]:
    """Numerator and denominator of the filter of `_answer`, shape (3,) each: records of one set have many in common."""
    omega = 2 * math.pi / period
    rates = np.array([[0.0, 1.0], [-(omega**2), -2 * damping * omega]])
    system = rates, np.array([[0.0], [-1.0]]), np.array([reading]), np.array([[0.0]])
    A, B, C, D, _ = scipy.signal.cont2discrete(system, h, method="foh")
    upper, lower = scipy.signal.ss2tf(A, B, C, D)
    return upper[0], lower


class Oscillation(NamedTuple):
    """The motion of an oscillator on moving ground, each of shape (n,).

    Args:
        displacement: relative to the ground [m].
        acceleration: that of the ground included [m/s2].
    """

    displacement: Array
    acceleration: Array


def of_pieces(ground: Vertices, at: Array, period: float, damping: float) -> Oscillation:
    """The motion of an oscillator at increasing times [s] on ground that is linear between vertices [m/s2], in closed
    form from vertex to vertex."""
    omega = 2 * math.pi / period
    decay, free = damping * omega, omega * math.sqrt(1 - damping**2)
    place = np.append(np.searchsorted(at, ground.times), len(at))
    lengths, rises = np.append(np.diff(ground.times), math.inf), np.append(np.diff(ground.values), 0.0)
    states, u, v = np.zeros((2, len(at))), 0.0, 0.0
    for k, (start, length) in enumerate(zip(ground.times.tolist(), lengths.tolist(), strict=True)):
        if length == 0:
            continue
        accel, rate = (0.0, 0.0) if math.isinf(length) else (float(ground.values[k]), float(rises[k]) / length)
        steady = np.array([-accel / omega**2 + 2 * damping * rate / omega**3, -rate / omega**2])
        c, d = u - steady[0], v - steady[1]
        tau = np.append(at[place[k] : place[k + 1]] - start, 0.0 if math.isinf(length) else length)
        shrink, cosine, sine = np.exp(-decay * tau), np.cos(free * tau), np.sin(free * tau) / free
        us = steady[0] + steady[1] * tau + shrink * (c * cosine + (d + decay * c) * sine)
        vs = steady[1] + shrink * (d * cosine - (omega**2 * c + decay * d) * sine)
        states[:, place[k] : place[k + 1]] = us[:-1], vs[:-1]
        u, v = float(us[-1]), float(vs[-1])
    return Oscillation(states[0], -(omega**2) * states[0] - 2 * decay * states[1])


def one_or_row(name: str, values: ArrayLike, low: float, high: float, unit: str = "") -> Array:
    """One value or a row of them, each within a range, as a row, shape (n,)."""
    element = f"value [{unit}]" if unit else "value"
    row = require_row(name, np.atleast_1d(require_reals(name, values, f"one {element} or a row of them")), element)
    for value in row.tolist():
        require_within(name, value, low, high, unit)
    return row


class Modes(NamedTuple):
    """Modes of a building as a floor has them.

    Args:
        period: T_k [s], shape (k,).
        damping: of the building [-].
        participation: gamma_k of each mode [-], shape (k,).
        height: psi_k, the shape of each mode at the floor over that at the top [-], shape (k,).
    """

    period: Array
    damping: float
    participation: Array
    height: Array

    @property
    def motion(self) -> Array:
        """gamma_k psi_k of each mode [-], shape (k,)."""
        return self.participation * self.height

    @property
    def label(self) -> str:
        """Periods [s], damping [-], gamma and psi on one line."""
        rows = (", ".join(f"{value:.10g}" for value in row) for row in (self.period, self.participation, self.height))
        period, gamma, psi = rows
        return f"T_k = {period} s, xi = {self.damping:.10g}, gamma_k = {gamma}, psi_k = {psi}"


@within_ranges
def building_modes(period: Periods, damping: BuildingDamping, participation: Participation, height: ArrayLike) -> Modes:
    """The modes of a building.

    Args:
        period: of the modes T_k [s], 0.01 to 100, shape (k,) or one.
        damping: of the building [-], 0.005 to 0.3.
        participation: gamma_k of each mode [-], -3 to 3.
        height: psi_k, the shape of each mode at the floor over that at the top [-], -1 to 1.

    Raises:
        TypeError, ValueError: for a value outside its range, or shapes that differ.
    """
    periods, gammas = (np.atleast_1d(np.asarray(argument, dtype=float)) for argument in (period, participation))
    for name, row in (("period", periods), ("participation", gammas)):
        require_row(name, row, "value")
    valid: Within = get_args(ModeShape)[1]
    try:
        shapes = one_or_row("height", height, valid.low, valid.high)
    except ValueError as error:
        meant = "it is a share, the shape of a mode at the floor over that at the top; z / H for a straight first mode"
        raise ValueError(f"{error}; {meant}") from None
    if not len(periods) == len(gammas) == len(shapes):
        raise ValueError(
            f"period has {len(periods)} values, participation {len(gammas)} and height {len(shapes)}; "
            "each mode needs one of each"
        )
    return Modes(periods, damping, gammas, shapes)
