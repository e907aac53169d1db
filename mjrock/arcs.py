"""Rocking arcs, Eq. 1 from one event to the next: free ones by SciPy, forced ones between the samples of a record.

    theta'' = -p^2 [sin(s alpha - theta) + (a_g / g) cos(s alpha - theta)],

s = +1 or -1 the side to which the wall rocks. An arc ends where the wall turns (omega = 0), meets the upright position
(theta = 0), lies on its face, or where the time is over. Splitting it where it turns lets each of these events be
crossed once, from a state that is clearly on one side of it.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from .block import GRAVITY
from .case import ON_ITS_FACE, Case
from .motion import GroundMotion

Array = NDArray[np.float64]
NYSTROM = 50.0
"""(p h)^4 of a forced step over rtol: Nyström's method then errs by about rtol alpha in a fall from alpha/2."""


class Event(enum.Enum):
    """How an arc ended."""

    PEAK = "omega = 0 on the way out"
    TROUGH = "omega = 0 on the way in"
    IMPACT = "theta = 0"
    FALL = "on its face"
    TIME = "the time is over"


State = tuple[float, float, float]
"""Time [s], rotation [rad], angular velocity [rad/s]."""


def _terminal(event: Callable[[float, Array], float], direction: float) -> Callable[[float, Array], float]:
    event.terminal = True  # type: ignore[attr-defined]
    event.direction = direction  # type: ignore[attr-defined]
    return event


class FreeArcs:
    """Arcs over a base at rest (scipy, DOP853)."""

    def __init__(self, case: Case, rtol: float, atol: float) -> None:
        self.alpha, self.p2, self.end = case.block.alpha, case.block.p**2, case.duration
        self.rtol, self.atol = rtol, atol
        self.evaluations = 0
        self.known: list[tuple[float, float, Callable[[Array], Array]]] = []

    def uplift(self, t: float) -> tuple[float, float]:
        """A wall at rest on a base at rest stays so."""
        return math.inf, 1.0

    def advance(self, state: State, s: float) -> tuple[State, Event]:
        """Follow the wall from `state` to the next event.

        Raises:
            RuntimeError: if the integration fails.
        """

        def rocking(t: float, y: Array) -> tuple[float, float]:
            return y[1], -s * self.p2 * math.sin(self.alpha - s * y[0])

        turns = s * state[2] > 0
        arc = solve_ivp(
            rocking,
            (state[0], self.end),
            state[1:],
            method="DOP853",
            events=(
                _terminal((lambda t, y: s * y[1]) if turns else (lambda t, y: s * y[0]), -1),
                _terminal(lambda t, y: s * y[0] - ON_ITS_FACE, 1),
            ),
            dense_output=True,
            rtol=self.rtol,
            atol=self.atol,
        )
        if arc.status < 0:
            raise RuntimeError(f"no solution beyond t = {arc.t[-1]:g} s: {arc.message}; relax rtol or atol")
        self.evaluations += arc.nfev
        t, theta, omega = float(arc.t[-1]), *map(float, arc.y[:, -1])
        self.known.append((state[0], t, arc.sol))
        if arc.t_events[1].size:
            return (t, theta, omega), Event.FALL
        if not arc.t_events[0].size:
            return (t, theta, omega), Event.TIME
        return ((t, theta, 0.0), Event.PEAK) if turns else ((t, 0.0, omega), Event.IMPACT)

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Rotation and velocity at any times; zero between the arcs."""
        theta, omega = np.zeros_like(t), np.zeros_like(t)
        for start, end, solution in self.known:
            within = (t >= start) & (t <= end)
            if within.any():
                theta[within], omega[within] = solution(t[within])
        return theta, omega


class ForcedArcs:
    """Arcs over a shaken base, in steps of Nyström's fourth-order method that end at every sample of the record.

    Between samples the acceleration is linear, so that each step integrates a smooth function. (SciPy's integrators
    would be restarted at each of thousands of samples.)
    """

    def __init__(self, case: Case, motion: GroundMotion, rtol: float) -> None:
        self.alpha, self.p2, self.end = case.block.alpha, case.block.p**2, case.duration
        self.one_sided = case.side_stop
        self.dt, self.last = motion.dt, len(motion.accel) - 1
        shares = motion.accel / GRAVITY
        self.shares: list[float] = shares.tolist()
        self.least = math.tan(self.alpha)
        excess = -shares if self.one_sided else np.abs(shares)
        self.lifting = np.flatnonzero(excess > self.least)
        self.longest = (NYSTROM * rtol) ** 0.25 / case.block.p
        self.evaluations = 0
        self.known: list[tuple[float, float, float, float, float, float]] = []

    def uplift(self, t: float) -> tuple[float, float]:
        """When a wall at rest at time `t` is lifted off its base, |a_g| > g tan(alpha) towards a free side, and to
        which side [s, +1 or -1]; never is infinity."""
        share = self._piece(t)[0]
        if (-share if self.one_sided else abs(share)) > self.least * (1 + 1e-9):
            return t, math.copysign(1.0, -share)
        later = np.searchsorted(self.lifting, t / self.dt, side="right")
        if later == len(self.lifting):
            return math.inf, 1.0
        j = int(self.lifting[later])
        before, after = self.shares[j - 1], self.shares[j]
        crossing = (j - 1 + (math.copysign(self.least, after) - before) / (after - before)) * self.dt
        return max(t, crossing), math.copysign(1.0, -after)

    def _piece(self, t: float) -> tuple[float, float, float]:
        """a_g/g at `t` [-], its rate [1/s], and when the piece of the record ends in which it is linear [s]."""
        i = int(t / self.dt + 1e-9)
        if i >= self.last:
            return 0.0, 0.0, math.inf
        rate = (self.shares[i + 1] - self.shares[i]) / self.dt
        return self.shares[i] + rate * (t - i * self.dt), rate, (i + 1) * self.dt

    def advance(self, state: State, s: float) -> tuple[State, Event]:
        """Follow the wall from `state` to the next event."""
        t, theta, omega = state
        tilt, p2, longest, sin, cos = s * self.alpha, self.p2, self.longest, math.sin, math.cos
        share = rate = 0.0

        def step(h: float) -> tuple[float, float, float, float]:
            """Rotation and velocity a time `h` later, and the accelerations at the start and the end."""
            u, half = tilt - theta, share + 0.5 * h * rate
            k1 = -p2 * (sin(u) + share * cos(u))
            u = tilt - theta - 0.5 * h * (omega + 0.25 * h * k1)
            k2 = -p2 * (sin(u) + half * cos(u))
            u = tilt - theta - h * (omega + 0.5 * h * k2)
            k3 = -p2 * (sin(u) + (share + h * rate) * cos(u))
            return theta + h * (omega + h * (k1 + 2 * k2) / 6), omega + h * (k1 + 4 * k2 + k3) / 6, k1, k3

        def when(which: int, h: float) -> float:
            """When within the next `h` rotation (0) or velocity (1) becomes zero."""
            return float(brentq(lambda tau: step(tau)[which], 0.0, h, xtol=1e-15 * (1 + h), rtol=1e-14))

        while t < self.end:
            share, rate, stop = self._piece(t)
            h = min(longest, stop - t, self.end - t)
            new_theta, new_omega, k1, k3 = step(h)
            self.evaluations += 3
            if k1 * k3 < 0 <= omega * new_omega:
                middle = h * k1 / (k1 - k3)  # of the step's extreme velocity
                if middle > 1e-6 * h and step(middle)[1] * new_omega < 0:  # it turns there and back
                    h = middle
                    new_theta, new_omega = step(h)[:2]
            event = None
            if omega * new_omega < 0:
                h, event = when(1, h), Event.PEAK if s * omega > 0 else Event.TROUGH
                new_theta, new_omega = step(h)[0], 0.0
            if s * new_theta <= 0:
                h, event = when(0, h), Event.IMPACT
                new_theta, new_omega = 0.0, step(h)[1]
            elif s * new_theta > ON_ITS_FACE:
                event = Event.FALL
            self.known.append((t, h, theta, omega, new_theta, new_omega))
            t, theta, omega = t + h, new_theta, new_omega
            if event:
                return (t, theta, omega), event
        return (self.end, theta, omega), Event.TIME

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Rotation and velocity at any times, by cubic Hermite interpolation of the steps; zero between the arcs."""
        if not self.known:
            return np.zeros_like(t), np.zeros_like(t)
        start, h, theta0, omega0, theta1, omega1 = np.array([known for known in self.known if known[1] > 0]).T
        i = np.searchsorted(start, t, side="right") - 1
        u = (t - start[i]) / h[i]
        moving = (i >= 0) & (u <= 1 + 1e-9)
        turned, swept = theta1[i] - theta0[i], h[i]
        theta = theta0[i] + u * (
            swept * omega0[i]
            + u
            * (3 * turned - swept * (2 * omega0[i] + omega1[i]) + u * (swept * (omega0[i] + omega1[i]) - 2 * turned))
        )
        omega = omega0[i] + u * (
            6 * turned / swept - 4 * omega0[i] - 2 * omega1[i] + u * (3 * (omega0[i] + omega1[i]) - 6 * turned / swept)
        )
        return np.where(moving, theta, 0.0), np.where(moving, omega, 0.0)
