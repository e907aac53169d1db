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

`rebound_restitution` and `rebound_damping` leave out all other forces. `falling_rebound` and `falling_damping` count
the weight too. A mass m comes down with the speed v, and gravity g presses it on. In units of v, of
omega = sqrt(k / m) and of v / omega, with pull = g / (omega v) and x the indentation,

    x'' = pull - max(0, x + 2 xi x'),    x = 0 and x' = 1 at the touch.

The force ends where x'' = pull. The mass is still below the height of the touch there, and climbs the rest against
gravity. It arrives with e^2 = x'^2 - 2 pull x, or not at all. The more the contact is damped, the deeper it lies where
the force ends: a contact that rebounds with 0.2 without gravity does not rebound at all at pull = 0.085.

A row of MuJoCo can bring an inertia m_i of its own, which moves with the mass and has no weight. With M = m + m_i in
place of m, and share = m / M,

    x'' = share pull - (x + 2 xi x')  in contact, until x'' = pull or x = 0.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

from .checks import require_real, require_within


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
    complement, tan = math.pi / 2 - angle, math.tan(angle)
    return 2 * complement * tan, 2 * complement * (1 + tan * tan) - 2 * tan


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
        reached, slope = function(x)
        if reached == value:
            return x
        low, high = (x, high) if reached < value else (low, x)
        new = x - (reached - value) / slope if slope > 0 else -1.0
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - x) <= 1e-16 * abs(x):
            return new
        x = new
    return x


MOST_PULL = 1e3
"""Largest g / (omega v) that is taken [-]. The weight is then a thousand times the force of the blow."""


@dataclass(frozen=True)
class Rebound:
    """What becomes of a mass that falls on a contact.

    Args:
        restitution: speed with which it passes the height of the touch again, over that of the touch [-]; 0 if it
            stays.
        duration: time from the touch until the force ends, times omega [-]; infinity if the force does not end.
    """

    restitution: float
    duration: float


def falling_rebound(xi: float, pull: float, share: float = 1.0) -> Rebound:
    """The rebound of a mass with its weight.

    Args:
        xi: damping ratio [-], 0 to 1e6.
        pull: g / (omega v) [-], 0 to 1000, with g the acceleration towards the contact [m/s2], omega its frequency
            [rad/s] and v the speed of approach [m/s].
        share: m / (m + m_i), the part of what moves that has weight [-], above 0 to 1.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    xi = require_within("damping ratio xi", xi, 0.0, 1e6)
    pull = require_within("pull g / (omega v)", pull, 0.0, MOST_PULL)
    share = require_within("share", share, 1e-12, 1.0)
    x, speed, acceleration = _motion(xi, share * pull)
    turn = math.pi / math.sqrt((1 - xi) * (1 + xi)) if xi < 1 else math.inf
    top = _first_top(xi, share * pull)
    end = math.inf
    if top is not None and acceleration(top) > pull:
        end = _crossing(lambda t: acceleration(t) - pull, max(0.0, top - turn), top)
    if share < 1 and xi < 1:  # no force beyond the gap, whatever the row would do
        deepest = (math.atan2(1 / turn, (xi - share * pull) / math.pi) % math.pi) * turn / math.pi
        if x(deepest + turn) < 0:
            end = min(end, _crossing(lambda t: -x(t), deepest, deepest + turn))
    if end == math.inf:
        return Rebound(0.0, math.inf)
    climbs = speed(end) ** 2 - 2 * pull * max(x(end), 0.0)
    return Rebound(math.sqrt(climbs) if climbs > 0 and speed(end) < 0 else 0.0, end)


def deepest(xi: float, pull: float = 0.0) -> float:
    """Largest indentation of a blow in units of v / omega [-], with the arguments of `falling_rebound`.

    Without gravity it is exp(-xi acos(xi) / sqrt(1 - xi^2)) for xi < 1. Where the mass comes to rest from above, it is
    the indentation at rest.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    xi = require_within("damping ratio xi", xi, 0.0, 1e6)
    pull = require_within("pull g / (omega v)", pull, 0.0, MOST_PULL)
    x, speed, _ = _motion(xi, pull)
    late = 1.0
    while speed(late) >= 0:  # the mass comes back for longer than it goes in, so that no doubling misses it
        if late > 1e9:
            return pull
        late *= 2
    return x(_crossing(lambda t: -speed(t), 0.0, late))


def falling_damping(restitution: float, pull: float) -> float:
    """Damping ratio with which a mass rebounds with e, above 0 to 1, under gravity [-]; inverts `falling_rebound`.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    e = require_within("restitution", restitution, 1e-300, 1.0)
    pull = require_within("pull g / (omega v)", pull, 0.0, MOST_PULL)
    free = rebound_damping(e)
    if pull == 0 or free == 0:
        return free
    low, high = 0.0, min(free, 1e6)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if falling_rebound(middle, pull).restitution > e else (low, middle)
    return low


def _motion(xi: float, pull: float) -> tuple[Callable[[float], float], ...]:
    """Indentation, speed and acceleration in contact, as functions of time."""

    def x(t: float) -> float:
        return pull + _free(xi, -pull, 1.0, t)

    def speed(t: float) -> float:
        return _free(xi, 1.0, pull - 2 * xi, t)

    def acceleration(t: float) -> float:
        return _free(xi, pull - 2 * xi, -1 - 2 * xi * (pull - 2 * xi), t)

    return x, speed, acceleration


def _free(xi: float, y: float, rate: float, t: float) -> float:
    """Solution of y'' + 2 xi y' + y = 0 at the time t."""
    root = cmath.sqrt(xi * xi - 1)
    if abs(root) * max(t, 1.0) < 1e-6:
        return math.exp(-xi * t) * (y + (rate + xi * y) * t)
    slow = -1 / (xi + root)  # -xi + root, without cancellation
    fast = -(xi + root)
    part = (rate - fast * y) / (slow - fast)
    return float((part * cmath.exp(slow * t) + (y - part) * cmath.exp(fast * t)).real)


def _first_top(xi: float, pull: float) -> float | None:
    """Time of the first maximum of the acceleration after the touch; None if it only approaches zero."""
    start = pull - 2 * xi
    jerk = -1 - 2 * xi * start
    rate = -2 * xi * jerk - start
    lean = rate + xi * jerk
    if xi < 1:
        frequency = math.sqrt((1 - xi) * (1 + xi))
        phase = math.atan2(-jerk * frequency, lean)  # where jerk cos + lean sin / frequency is zero
        top = phase % math.pi / frequency
        if jerk < 0 or (jerk == 0 and rate > 0):  # it falls first, and then rises for half a period
            top += math.pi / frequency
        return top
    if jerk <= 0 or lean >= 0:
        return None
    root = math.sqrt((xi - 1) * (xi + 1))
    ratio = -jerk * root / lean
    if root < 1e-9:
        return -jerk / lean
    return math.atanh(ratio) / root if ratio < 1 else None


def _crossing(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function that rises from low to high is zero, to rounding."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


def rebound_at(speed: float, xi: float, frequency: float, gravity: float, share: float = 1.0) -> float:
    """Coefficient of restitution at a speed, see `falling_rebound` [-].

    Args:
        speed: speed of approach [m/s], 1e-9 to 1e9.
        xi, frequency: damping ratio [-] and circular frequency [rad/s].
        gravity: acceleration that brings the geoms together [m/s2]; a negative one is taken as none.
        share: part of what moves that has weight [-].
    """
    speed = require_within("speed", speed, 1e-9, 1e9, "m/s")
    if frequency == 0 or xi == math.inf or xi > 1e6:
        return rebound_restitution(xi)
    pull = max(0.0, gravity) / (frequency * speed)
    if pull == 0:
        return rebound_restitution(xi)
    return 0.0 if pull > MOST_PULL else falling_rebound(xi, pull, share).restitution
