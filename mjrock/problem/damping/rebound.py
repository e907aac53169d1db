"""Restitution of a mass that meets a spring and dashpot which never pull, in closed form, and its inverse.

A mass m meets a spring k and a dashpot c with f = max(0, k x + c v). The contact ends when the force reaches zero, not
when the gap does: the dashpot would pull before the spring is slack again. With xi = c / (2 sqrt(k m)) the mass then
leaves with e times the speed it came with,

    e = exp(-2 xi acos(xi)  / sqrt(1 - xi^2))    for xi < 1,
    e = exp(-2)                                  for xi = 1,
    e = exp(-2 xi acosh(xi) / sqrt(xi^2 - 1))    for xi > 1, which tends to 1 / (4 xi^2).

Derivation: the force is zero where the acceleration is. With xi = cos(phi), the free vibration that starts at x = 0 has
its first zero of acceleration at the phase 2 phi = 2 acos(xi) of the damped period, and the speed has fallen to
exp(-2 phi xi / sqrt(1 - xi^2)) there. The textbook's exp(-pi xi / sqrt(1 - xi^2)) waits for x = 0 instead. It lets the
dashpot pull, and is zero from xi = 1 on.

Forces other than the contact's are left out. `falling` has the same with gravity.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from ...quantities import require_real, require_within


def rebound_restitution(xi: float) -> float:
    """Coefficient of restitution e of a spring and dashpot that never pull [-].

    Args:
        xi: damping ratio c / (2 sqrt(k m)) [-], not negative; infinity gives 0.

    Raises:
        TypeError, ValueError: unless xi is a number that is not negative.
    """
    xi = require_real("damping ratio xi", xi)
    if not xi >= 0:
        raise ValueError(f"damping ratio xi = {xi:g} is outside the valid range xi >= 0")
    if xi == math.inf:
        return 0.0
    if xi == 1:
        return math.exp(-2.0)
    if xi < 1:
        return math.exp(-2 * xi * math.acos(xi) / math.sqrt((1 - xi) * (1 + xi)))
    return math.exp(-2 * math.acosh(xi) * (xi / (math.sqrt(xi - 1) * math.sqrt(xi + 1))))


def rebound_damping(restitution: float) -> float:
    """Damping ratio xi of a spring and dashpot that never pull and rebound with e [-]; inverts `rebound_restitution`.

    Args:
        restitution: e within [0, 1] [-]. 1 needs no damping, exp(-2) = 0.135 critical damping, and 0 is the limit of
            infinite damping: xi is about 1 / (2 sqrt(e)) for small e.

    Raises:
        TypeError, ValueError: unless e is a number within [0, 1].
    """
    e = require_within("restitution", restitution, 0.0, 1.0)
    if e == 0:
        return math.inf
    lost = -math.log(e)
    if lost == 0:
        return 0.0
    if lost == 2:
        return 1.0
    if lost > 2:  # xi = cosh(angle), with 2 angle coth(angle) = lost, so that the angle is below half of what is lost
        return math.cosh(_root(_overdamped, lost, lost / 2))
    if _underdamped(_CRITICAL)[0] <= lost:
        return 1.0
    return math.sin(_root(_underdamped, lost, _CRITICAL))


_CRITICAL = math.pi / 2 - 1e-7
"""The angle from which xi = sin(angle) is 1 to rounding."""


def _underdamped(angle: float) -> tuple[float, float]:
    """-log(e) of xi = sin(angle), which keeps every digit of a small xi, and its slope."""
    rest, tan = math.pi / 2 - angle, math.tan(angle)
    return 2 * rest * tan, 2 * rest * (1 + tan * tan) - 2 * tan


def _overdamped(angle: float) -> tuple[float, float]:
    """-log(e) of xi = cosh(angle), and its slope."""
    if angle < 1e-8:
        return 2.0, 0.0
    tanh, sinh = math.tanh(angle), math.sinh(angle)
    return 2 * angle / tanh, 2 / tanh - 2 * angle / (sinh * sinh)


def _root(function: Callable[[float], tuple[float, float]], value: float, high: float) -> float:
    """Where a function that rises from below `value` at 0 to above it at `high` has this value, to rounding.

    Newton's steps, halved where they leave the bracket.
    """
    low, x = 0.0, min(value / math.pi, high)
    for _ in range(200):
        found, slope = function(x)
        if found == value:
            return x
        low, high = (x, high) if found < value else (low, x)
        new = x - (found - value) / slope if slope > 0 else -1.0
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - x) <= 1e-16 * abs(x):
            return new
        x = new
    return x
