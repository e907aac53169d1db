"""Free rocking: Eq. 1 over a base at rest, from one event to the next, by SciPy.

    theta'' = -s [P cos(theta) - s Q sin(theta)] / I_0,

s = +1 or -1 the side to which the wall rocks, and P and Q the restoring moment of its weight, loads and thrusts about
the toe of that side. Without effects this is -p^2 sin(s alpha - theta).

An arc ends where the wall turns (omega = 0), meets the upright position (theta = 0), lies on its face, or where the
time is over. Each event is crossed once, from a state that is clearly on one side of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp

from ..problem.wall.case import Case
from ..quantities import ON_ITS_FACE, Array
from ..result.rocking import Impact
from .motion import RockingMotion

Event = Literal["peak", "impact", "fall", "time"]
"""How an arc ended."""
WallState = tuple[float, float, float]
"""Time [s], rotation [rad], angular velocity [rad/s]."""


def _terminal(event: Callable[[float, Array], float], direction: float) -> Callable[[float, Array], float]:
    event.terminal = True  # type: ignore[attr-defined]
    event.direction = direction  # type: ignore[attr-defined]
    return event


class Arcs:
    """Arcs over a base at rest (scipy, DOP853)."""

    def __init__(self, case: Case, rtol: float, atol: float) -> None:
        self.restoring, self.wall, self.end = case.restoring, case.wall, case.duration
        self.rtol, self.atol = rtol, atol
        self.evaluations = 0
        self.known: list[tuple[float, float, Callable[[Array], Array]]] = []

    def advance(self, state: WallState, s: float) -> tuple[WallState, Event]:
        """Follow the wall from `state` to the next event; RuntimeError if the integration fails."""
        moment, inertia = self.restoring.towards(s), self.wall.inertia_about(s)
        P, Q = moment.P / inertia, moment.Q / inertia

        def rocking(t: float, y: Array) -> tuple[float, float]:
            return y[1], -s * (P * math.cos(y[0]) - s * Q * math.sin(y[0]))

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
            return (t, theta, omega), "fall"
        if not arc.t_events[0].size:
            return (t, theta, omega), "time"
        return ((t, theta, 0.0), "peak") if turns else ((t, 0.0, omega), "impact")

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Rotation and velocity at any times. They are zero between the arcs."""
        theta, omega = np.zeros_like(t), np.zeros_like(t)
        for start, end, solution in self.known:
            within = (t >= start) & (t <= end)
            if within.any():
                theta[within], omega[within] = solution(t[within])
        return theta, omega


def rock_freely(case: Case, e: float, least: float, rtol: float, atol: float) -> RockingMotion:
    """Rocking over a base at rest.

    Args:
        case: the wall and its release.
        e: restitution of an impact [-], as the root of the energy that is left; negative where the wall leaves to the
            side that it came from.
        least: an impact that leaves less energy than this leaves the wall at rest [J].
        rtol, atol: tolerances of the integration, on rotation [rad] and velocity [rad/s].
    """
    arcs = Arcs(case, rtol, atol)
    state, s = (0.0, case.theta0, case.omega0), case.direction
    event: Event = "time"
    impacts: list[Impact] = []
    peaks: list[float] = []
    at_rest = case.release_energy == 0
    while state[0] < case.duration and not at_rest and event != "fall":
        state, event = arcs.advance(state, s)
        if event == "peak":
            peaks.append(abs(state[1]))
        elif event == "impact":
            arriving, leaving = case.wall.inertia_about(s), case.wall.inertia_about(math.copysign(1.0, e * state[2]))
            before, after = state[2], e * state[2] * math.sqrt(arriving / leaving)
            impacts.append(Impact(state[0], before, after, 0.5 * arriving * before**2, 0.5 * leaving * after**2))
            at_rest = impacts[-1].energy_after <= least
            s, state = math.copysign(1.0, after), (state[0], 0.0, after)
    return RockingMotion(
        impacts=np.reshape(np.array(impacts, dtype=float), (-1, 5)),
        peaks=np.array(peaks),
        t=state[0],
        theta=0.0 if at_rest else state[1],
        fell=event == "fall",
        at_rest=at_rest,
        sample=arcs.sample,
        arcs=len(arcs.known),
        evaluations=arcs.evaluations,
    )
