"""A contact from measurements: heights of bounces, times of contact, or the elasticity of a round body.

A body that is dropped from h and bounces to h' has e = sqrt(h' / h), gravity counted, because it passes the surface
with sqrt(2 g h) and sqrt(2 g h'). Its contact lasts for a time T, which gives omega = D(xi, g / (omega v)) / T with the
duration D of `falling_rebound`, and k = m omega^2.

Hertz: a sphere of radius R on a flat body has F = K x^1.5, K = 4/3 E' sqrt(R), 1/E' = (1 - nu^2) / E of both bodies
together. A linear contact has its indentation under one force, or lasts as long at one speed of approach.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...contacts.rebound import MOST_PULL, falling_damping, falling_rebound, rebound_damping
from ...quantities import GRAVITY, Array, Within, is_iterable, require_row, short_repr, shown, within_ranges

Mass = Annotated[float | None, Within(1e-12, 1e12, "kg")]
Modulus = Annotated[float, Within(1, 1e15, "Pa")]
"""Young's modulus of any body."""
Ratio = Annotated[float, Within(-1, 0.5)]
"""Poisson's ratio."""
HERTZ_DURATION = 2.9432
"""Time of a blow between elastic spheres, times the speed of approach over the largest indentation [-]."""
LOWEST_RESTITUTION = 1e-3
"""The smallest restitution for which a damping ratio is given [-]."""


@dataclass(frozen=True)
class MeasuredContact:
    """A contact of a body that was dropped.

    Args:
        restitution, restitution_interval: coefficient of restitution [-], mean and interval of the mean.
        xi: damping ratio with which a contact rebounds so [-], with gravity where the stiffness is known.
        k, k_interval: stiffness [N/m], from the mean time of contact and its interval; None without times.
        bounces, times: how many of each were measured.
    """

    restitution: float
    restitution_interval: tuple[float, float]
    xi: float
    k: float | None
    k_interval: tuple[float, float] | None
    bounces: int
    times: int

    __repr__ = short_repr


@within_ranges
def measured_contact(
    heights: ArrayLike | Sequence[ArrayLike],
    *,
    mass: Mass = None,
    contact_times: ArrayLike | None = None,
    confidence: Annotated[float, Within(1e-6, 1 - 1e-6)] = 0.95,
    gravity: Annotated[float, Within(1e-6, 1e6, "m/s2")] = GRAVITY,
) -> MeasuredContact:
    """Restitution and stiffness of a body that was dropped on a surface.

    Args:
        heights: heights of the lowest point above the surface [m], that of the release first and then of each bounce;
            several drops are a list of such rows.
        mass: mass of the body [kg], 1e-12 to 1e12; needed for the stiffness.
        contact_times: times of contact of first bounces [s].
        confidence: of the intervals [-], 1e-6 to 0.999999. They are Student's, of the mean of independent bounces;
            a single one leaves it open, and the interval is that of all possible values.
        gravity: acceleration of gravity [m/s2], 1e-6 to 1e6.

    Raises:
        TypeError, ValueError: for a value outside its range, fewer than two heights in a drop, a bounce that is higher
            than the height before it, or times without a mass.
    """
    ratios, release = _ratios(heights)
    mean = _mean_of(ratios, confidence, 0.0, 1.0)
    e, interval = mean.value, (mean.low, mean.high)
    if contact_times is None:
        return MeasuredContact(e, interval, rebound_damping(max(e, LOWEST_RESTITUTION)), None, None, len(ratios), 0)
    if mass is None:
        raise ValueError("contact_times are given without mass; the stiffness needs it")
    times = require_row("contact_times", contact_times, "time of contact")
    if times.min() < 1e-9 or times.max() > 1e3:
        raise ValueError(f"contact_times hold {times.min():g} to {times.max():g} s; the valid range is 1e-09 to 1000 s")
    time = _mean_of(times, confidence, 0.0, math.inf)
    speed = math.sqrt(2 * gravity * release)
    ends = time.value, time.high, time.low
    k, softest, stiffest = (mass * _frequency(duration, e, gravity, speed) ** 2 for duration in ends)
    omega = math.sqrt(k / mass)
    xi = falling_damping(max(e, LOWEST_RESTITUTION), min(gravity / (omega * speed), MOST_PULL))
    return MeasuredContact(e, interval, xi, k, (softest, stiffest), len(ratios), len(times))


@within_ranges
def hertz_stiffness(
    radius: Annotated[float, Within(1e-9, 1e6, "m")],
    E: Modulus,
    nu: Ratio,
    *,
    other: tuple[float, float] | None = None,
    force: Annotated[float | None, Within(1e-12, 1e15, "N")] = None,
    mass: Mass = None,
    speed: Annotated[float | None, Within(1e-9, 1e6, "m/s")] = None,
) -> float:
    """Stiffness of a linear contact in place of Hertz's [N/m].

    Args:
        radius: radius of the sphere [m], 1e-9 to 1e6; 1 / (1/R1 + 1/R2) of two.
        E: Young's modulus of the sphere [Pa], 1 to 1e15.
        nu: Poisson's ratio of the sphere [-], -1 to 0.5.
        other: the same of the other body. None is a rigid one.
        force: force at which both contacts have the same indentation [N], 1e-12 to 1e15, such as a weight; or
        mass: effective mass [kg], 1e-12 to 1e12, and
        speed: speed of approach [m/s], 1e-9 to 1e6, at which both last equally long.

    Raises:
        TypeError, ValueError: for a value outside its range, or unless force, or mass and speed, are given.
    """
    compliance = _compliance(E, nu)
    if other is not None:
        if not isinstance(other, tuple | list) or len(other) != 2:
            raise TypeError(f"other = {shown(other)} has to be Young's modulus and Poisson's ratio of the other body")
        compliance += _compliance(*other)
    K = float(4 / 3 * math.sqrt(radius) / compliance)
    if (force is None) == (mass is None and speed is None) or (mass is None) != (speed is None):
        raise ValueError(
            f"force = {shown(force)}, mass = {shown(mass)}, speed = {shown(speed)}: give the force, or mass and speed"
        )
    if mass is None or speed is None:
        load = float(force or 0.0)
        return float(load / (load / K) ** (2 / 3))
    deepest = (5 * mass * speed * speed / (4 * K)) ** 0.4
    return float(mass * (math.pi * speed / (HERTZ_DURATION * deepest)) ** 2)


@within_ranges
def _compliance(E: Modulus, nu: Ratio) -> float:
    return (1 - nu**2) / E


def _ratios(heights: object) -> tuple[Array, float]:
    """e of every bounce [-], and the mean height of the releases [m]."""
    rows: Iterable[object] = [heights]
    if isinstance(heights, list | tuple | np.ndarray) and is_iterable(heights) and any(map(is_iterable, heights)):
        rows = heights
    drops = [require_row("heights", row, "height") for row in rows]
    for drop in drops:
        if len(drop) < 2:
            raise ValueError(f"heights of a drop are {drop.tolist()}; a release and at least one bounce are needed")
        if drop.min() <= 0 or drop.max() > 1e6 or (np.diff(drop) > 0).any():
            raise ValueError(
                f"heights = {drop.tolist()} m have to be positive, and no bounce higher than the one before"
            )
    ratios = np.concatenate([np.sqrt(drop[1:] / drop[:-1]) for drop in drops])
    return ratios, float(np.mean([drop[0] for drop in drops]))


class Mean(NamedTuple):
    """The mean of measured values, and the ends of its confidence interval."""

    value: float
    low: float
    high: float


def _mean_of(values: Array, level: float, lowest: float, highest: float) -> Mean:
    """Mean, and Student's interval of the mean within what is possible."""
    mean = float(values.mean())
    if len(values) < 2:
        return Mean(mean, lowest, highest)
    from scipy.special import stdtrit

    half = float(stdtrit(len(values) - 1, 0.5 + level / 2) * values.std(ddof=1) / math.sqrt(len(values)))
    return Mean(mean, max(lowest, mean - half), min(highest, mean + half))


def _frequency(time: float, e: float, gravity: float, speed: float) -> float:
    """Circular frequency of a contact that lasts so long [rad/s]; 0 for an endless one, infinity for none."""
    if not 0 < time < math.inf:
        return math.inf if time <= 0 else 0.0
    omega = math.pi / time
    for _ in range(100):
        pull = min(gravity / (omega * speed), MOST_PULL)
        next_omega = falling_rebound(falling_damping(max(e, LOWEST_RESTITUTION), pull), pull).duration / time
        if not next_omega < math.inf or abs(next_omega - omega) <= 1e-10 * omega:
            break
        omega = next_omega
    return omega
