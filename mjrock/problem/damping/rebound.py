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

Forces other than the contact's are left out. Gravity g lowers e by 0.1 to 0.3 times g / (omega v), with v the speed of
approach, as long as that is small. A slower body stays on the contact.
"""

from __future__ import annotations

import math

from scipy.optimize import brentq

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
    if lost < 2:  # xi = sin(angle); the angle keeps every digit of a small xi

        def excess(angle: float) -> float:
            return 2 * (math.pi / 2 - angle) * math.tan(angle) - lost

        if excess(_CRITICAL) <= 0:
            return 1.0
        return math.sin(brentq(excess, 0.0, _CRITICAL, xtol=1e-300, rtol=1e-15))
    if lost == 2:
        return 1.0
    # xi = cosh(angle), with 2 angle coth(angle) = lost, so that the angle is below half of what is lost
    return math.cosh(brentq(lambda angle: 2 * angle / math.tanh(angle) - lost, 1e-12, lost / 2, xtol=1e-14, rtol=1e-14))


_CRITICAL = math.pi / 2 - 1e-7
"""The angle from which xi = sin(angle) is 1 to rounding."""
