"""Forced rocking: Eq. 1 over a shaken base, in compiled steps that end at every sample of the record.

    theta'' = -p^2 [sin(s alpha - theta) + (a_g / g) cos(s alpha - theta)],

s = +1 or -1 the side to which the wall rocks. Between two samples the acceleration of the ground is linear, so that
each step of Nystroem's fourth-order method integrates a smooth function. (A general integrator would be restarted at
each of thousands of samples.) The wall rests until |a_g| > g tan(alpha) towards a free side.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..problem.case import Case
from ..problem.motion import GroundMotion
from ..problem.quantities import GRAVITY, ON_ITS_FACE, Array, Integers
from ..result.samples import interpolated
from .rocking import Rocking

NYSTROEM = 50.0
"""(p h)^4 of a forced step over rtol. Nystroem's method then errs by about rtol alpha in a fall from alpha/2."""
NEWTON = 60
"""Most iterations of a root, of which bisection alone would need 53."""
SMALL = 0.05
"""Largest change of an angle in a step for which its sine and cosine are taken from series [rad]."""
SINE, COSINE = (-1 / 6, 1 / 120, -1 / 5040), (-1 / 2, 1 / 24, -1 / 720, 1 / 40320)
"""Coefficients of these series."""
CHUNK = 4096
"""Room for knots, and for a quarter as many impacts and peaks, which is emptied when it is full."""


class Forcing(NamedTuple):
    """A wall on a shaken base, as numbers and arrays for compiled functions.

    Args:
        alpha: angle of the diagonal to the vertical [rad].
        p2: square of the frequency parameter [1/s2].
        one_sided: whether a side stop keeps the rotation from becoming negative.
        inertia: moment of inertia about the toe [kg m2].
        e: restitution of an impact [-].
        rest: an impact that leaves less angular velocity than this leaves the wall at rest [rad/s].
        shares: a_g / g at the samples [-].
        dt: time step of the samples [s].
        longest: longest step [s].
        duration: time to follow the motion [s].
    """

    alpha: float
    p2: float
    one_sided: bool
    inertia: float
    e: float
    rest: float
    shares: Array
    dt: float
    longest: float
    duration: float


class Clock(NamedTuple):
    """Where the motion is: time [s], rotation [rad], velocity [rad/s], side, and whether the wall rests or is done."""

    t: float
    theta: float
    omega: float
    side: float
    at_rest: bool
    fell: bool
    ended: bool


class Room(NamedTuple):
    """Room for what is found.

    Args:
        knots: time [s], rotation [rad] and velocity [rad/s] before and after each step and each impact, shape (n, 3).
        impacts: the numbers of each impact, as in `mjrock.result.history.Impact`, shape (n, 5).
        peaks: rotation maxima |theta| [rad], shape (n,).
        counts: how many of each there are, shape (3,).
    """

    knots: Array
    impacts: Array
    peaks: Array
    counts: Integers

    @classmethod
    def empty(cls) -> Room:
        """Room for CHUNK knots."""
        few = CHUNK // 4
        return cls(np.empty((CHUNK, 3)), np.empty((few, 5)), np.empty(few), np.zeros(3, dtype=np.int64))

    def filled(self) -> tuple[Array, Array, Array]:
        """Copies of what has been found."""
        knots, impacts, peaks = self.counts
        return self.knots[:knots].copy(), self.impacts[:impacts].copy(), self.peaks[:peaks].copy()


@jitable
def piece(forcing: Forcing, t: float) -> tuple[float, float, float]:
    """a_g / g at a time [-], its rate [1/s], and the end of the interval in which it is linear [s]."""
    i, last = int(t / forcing.dt + 1e-9), len(forcing.shares) - 1
    if i >= last:
        return 0.0, 0.0, math.inf
    rate = (forcing.shares[i + 1] - forcing.shares[i]) / forcing.dt
    return forcing.shares[i] + rate * (t - i * forcing.dt), rate, (i + 1) * forcing.dt


@jitable
def uplift(forcing: Forcing, t: float) -> tuple[float, float]:
    """When a wall that rests at time `t` is lifted, and to which side [s, +1 or -1]. Never is infinity."""
    least, sign = math.tan(forcing.alpha), -1.0
    share, _, _ = piece(forcing, t)
    if (-share if forcing.one_sided else abs(share)) > least * (1 + 1e-9):
        return t, math.copysign(1.0, -share)
    for j in range(int(t / forcing.dt) + 1, len(forcing.shares)):
        after, before = forcing.shares[j], forcing.shares[j - 1]
        if (-after if forcing.one_sided else abs(after)) > least:
            sign = math.copysign(1.0, after)
            crossing = (j - 1 + (sign * least - before) / (after - before)) * forcing.dt
            return max(t, crossing), -sign
    return math.inf, 1.0


@jitable
def turned_by(u: float, sine: float, cosine: float, delta: float) -> tuple[float, float]:
    """Sine and cosine of u - delta from those of u: by the addition theorem, with series that are exact to rounding."""
    if abs(delta) > SMALL:
        return math.sin(u - delta), math.cos(u - delta)
    d2 = delta * delta
    s = delta * (1 + d2 * (SINE[0] + d2 * (SINE[1] + d2 * SINE[2])))
    c = 1 + d2 * (COSINE[0] + d2 * (COSINE[1] + d2 * (COSINE[2] + d2 * COSINE[3])))
    return sine * c - cosine * s, cosine * c + sine * s


@jitable
def nystroem(
    p2: float, tilt: float, share: float, rate: float, theta: float, omega: float, h: float
) -> tuple[float, float, float, float]:
    """Rotation and velocity a time `h` later, and the accelerations at the start and at the end.

    Args:
        p2: square of the frequency parameter [1/s2].
        tilt: s alpha [rad].
        share, rate: a_g / g at the start [-] and its rate [1/s].
        theta, omega: rotation and velocity at the start.
        h: the step [s].
    """
    u = tilt - theta
    sine, cosine = math.sin(u), math.cos(u)
    k1 = -p2 * (sine + share * cosine)
    sine_2, cosine_2 = turned_by(u, sine, cosine, 0.5 * h * (omega + 0.25 * h * k1))
    k2 = -p2 * (sine_2 + (share + 0.5 * h * rate) * cosine_2)
    sine_3, cosine_3 = turned_by(u, sine, cosine, h * (omega + 0.5 * h * k2))
    k3 = -p2 * (sine_3 + (share + h * rate) * cosine_3)
    sixth = h / 6
    return theta + h * (omega + sixth * (k1 + 2 * k2)), omega + sixth * (k1 + 4 * k2 + k3), k1, k3


@jitable
def root(which: int, p2: float, tilt: float, share: float, rate: float, theta: float, omega: float, h: float) -> float:
    """When within the next `h` rotation (0) or velocity (1) becomes zero [s].

    Newton's method, from the root at a constant acceleration, held by bisection. The other arguments are those of
    `nystroem`.
    """
    k1 = -p2 * (math.sin(tilt - theta) + share * math.cos(tilt - theta))
    if which == 0:
        closing = math.copysign(math.sqrt(max(0.0, omega * omega - 2 * k1 * theta)), theta)
        start, over, under = theta, 2 * theta, closing - omega
    else:
        start, over, under = omega, -omega, k1
    low, high, tau = 0.0, h, over / under if under != 0 else 0.0
    if not low < tau < high:
        tau = 0.5 * h
    for _ in range(NEWTON):
        at, speed, _, push = nystroem(p2, tilt, share, rate, theta, omega, tau)
        value, slope = (at, speed) if which == 0 else (speed, push)
        if start * value > 0:
            low = tau
        else:
            high = tau
        better = tau - value / slope if slope != 0 else low
        if abs(better - tau) <= 1e-15 * (1 + h):
            break
        tau = better if low < better < high else 0.5 * (low + high)
    return tau


@jitable
def noted(room: Room, t: float, theta: float, omega: float) -> None:
    """Write a knot."""
    n = room.counts[0]
    room.knots[n, 0], room.knots[n, 1], room.knots[n, 2] = t, theta, omega
    room.counts[0] += 1


@jitable
def met(room: Room, forcing: Forcing, t: float, omega: float) -> None:
    """Write an impact."""
    impact, after = room.impacts[room.counts[1]], forcing.e * omega
    impact[0], impact[1], impact[2] = t, omega, after
    impact[3], impact[4] = 0.5 * forcing.inertia * omega * omega, 0.5 * forcing.inertia * after * after
    room.counts[1] += 1


@compiled
def forced_loop(forcing: Forcing, clock: Clock, room: Room) -> Clock:
    """Follow the wall until the room is nearly full, or until it lies on its face or the time is over."""
    t, theta, omega, side, at_rest, fell, ended = clock
    p2 = forcing.p2
    while room.counts[0] + 4 < len(room.knots) and max(room.counts[1], room.counts[2]) < len(room.peaks) and not ended:
        if at_rest:
            lifted, towards = uplift(forcing, t)
            noted(room, t, 0.0, 0.0)
            if lifted >= forcing.duration:
                t, ended = forcing.duration, True
                noted(room, t, 0.0, 0.0)
                break
            t, theta, omega, side, at_rest = lifted, 0.0, 0.0, towards, False
        noted(room, t, theta, omega)
        tilt = side * forcing.alpha
        share, rate, stop = piece(forcing, t)
        h = min(forcing.longest, stop - t, forcing.duration - t)
        new_theta, new_omega, k1, k3 = nystroem(p2, tilt, share, rate, theta, omega, h)
        if k1 * k3 < 0 and omega * new_omega >= 0:
            middle = h * k1 / (k1 - k3)  # of the step's extreme velocity
            if middle > 1e-6 * h and nystroem(p2, tilt, share, rate, theta, omega, middle)[1] * new_omega < 0:
                h = middle  # the wall turns, and turns again within the step
                new_theta, new_omega, _, _ = nystroem(p2, tilt, share, rate, theta, omega, h)
        turned = omega * new_omega < 0
        if turned:
            h = root(1, p2, tilt, share, rate, theta, omega, h)
            new_theta, new_omega = nystroem(p2, tilt, share, rate, theta, omega, h)[0], 0.0
        hit = side * new_theta <= 0
        if hit:
            h = root(0, p2, tilt, share, rate, theta, omega, h)
            new_theta, new_omega = 0.0, nystroem(p2, tilt, share, rate, theta, omega, h)[1]
        elif turned and side * omega > 0:
            room.peaks[room.counts[2]] = abs(new_theta)
            room.counts[2] += 1
        t, theta, omega = t + h, new_theta, new_omega
        noted(room, t, theta, omega)
        fell = side * theta > ON_ITS_FACE
        if hit:
            met(room, forcing, t, omega)
            omega *= forcing.e
            at_rest = abs(omega) <= forcing.rest
            side = math.copysign(1.0, omega)
        ended = fell or t >= forcing.duration
    return Clock(t, theta, omega, side, at_rest, fell, ended)


def rock_forced(case: Case, motion: GroundMotion, e: float, least: float, rtol: float) -> Rocking:
    """Rocking over a shaken base.

    Args:
        case: the wall and its release.
        motion: the motion of the base.
        e: restitution of an impact [-], negative where the wall leaves to the side that it came from.
        least: an impact that leaves less energy than this leaves the wall at rest [J].
        rtol: sets the longest step, see NYSTROEM.
    """
    wall = case.block
    forcing = Forcing(
        alpha=wall.alpha,
        p2=wall.p**2,
        one_sided=case.side_stop,
        inertia=wall.toe_inertia,
        e=e,
        rest=math.sqrt(2 * least / wall.toe_inertia),
        shares=motion.accel / GRAVITY,
        dt=motion.dt,
        longest=(NYSTROEM * rtol) ** 0.25 / wall.p,
        duration=case.duration,
    )
    clock = Clock(0.0, case.theta0, case.omega0, case.direction, case.release_energy == 0, False, False)
    room, found = Room.empty(), []
    while not clock.ended:
        room.counts[:] = 0
        clock = forced_loop(forcing, clock, room)
        found.append(room.filled())
    knots, impacts, peaks = found[0] if len(found) == 1 else map(np.concatenate, zip(*found, strict=True))
    t, theta, omega = np.ascontiguousarray(knots.T)

    def sample(times: Array) -> tuple[Array, Array]:
        rotations, velocities = interpolated(t, theta[:, None], omega[:, None], times)
        return rotations[:, 0], velocities[:, 0]

    steps = len(t) // 2
    return Rocking(impacts, peaks, clock.t, clock.theta, clock.fell, clock.at_rest, sample, steps, 3 * steps)
