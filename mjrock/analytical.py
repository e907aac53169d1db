"""Classical rocking: Eq. 1 between impacts, a coefficient of restitution at each. Knows no stiffness and no MuJoCo."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .block import require_within
from .case import ON_ITS_FACE, Case
from .response import Impact, Outcome, Response, describe
from .restitution import Restitution

Array = NDArray[np.float64]


def _terminal(event: Callable[[float, Array], float], direction: float) -> Callable[[float, Array], float]:
    event.terminal = True  # type: ignore[attr-defined]
    event.direction = direction  # type: ignore[attr-defined]
    return event


def solve_analytical(
    case: Case,
    e: Restitution,
    *,
    rtol: float = 1e-10,
    atol: float = 1e-12,
    output_step: float = 1e-3,
    rest: float = 1e-9,
) -> Response:
    """Free rocking of a rigid wall by integrating Eq. 1 from peak to impact to peak.

    Each rocking arc is split at its peak, where the velocity changes sign, so that the two events that end its halves
    (omega = 0, theta = 0) are each crossed once, from a state that is clearly on one side of them. Impacts that
    accumulate end the motion: a rebound with less than `rest` of the energy of release leaves the wall at rest.

    Args:
        case: the wall, its release, its sides. With a side stop `e.lumped` rules and theta >= 0, without one `e.base`.
        e: the coefficients of restitution.
        rtol, atol: tolerances of the integration (scipy, DOP853), on rotation [rad] and velocity [rad/s].
        output_step: spacing of the returned samples [s].
        rest: smallest rebound that is still followed, as a share of the energy of release [-].

    Raises:
        ValueError: for a case with ground motion, a tolerance or step out of range, or a side stop from which the wall
            does not rebound.
        RuntimeError: if the integration fails.
    """
    require_within("rtol", rtol, 1e-14, 0.1)
    require_within("atol", atol, 1e-16, 0.1)
    require_within("output_step", output_step, 1e-7, 10.0, "s")
    require_within("rest", rest, 1e-30, 0.1)
    if case.motion is not None:
        raise ValueError("solve_analytical answers free rocking only; motion must be None")
    if case.side_stop and not -1 <= e.lumped < 0:
        raise ValueError(f"lumped restitution = {e.lumped:g} is outside the valid range -1 <= e_1s < 0 for a side stop")
    started = time.perf_counter()
    wall = case.block
    alpha, p2, restitution = wall.alpha, wall.p**2, abs(e.lumped) if case.side_stop else e.base

    def rocking(t: float, y: Array) -> tuple[float, float]:
        # s theta is the rotation about the toe that carries the wall (Eq. 1 without ground motion)
        return y[1], -s * p2 * math.sin(alpha - s * y[0])

    peak = _terminal(lambda t, y: s * y[1], -1)
    impact = _terminal(lambda t, y: s * y[0], -1)
    overturning = _terminal(lambda t, y: s * y[0] - ON_ITS_FACE, 1)

    t, y = 0.0, np.array([case.theta0, case.omega0])
    s = case.direction
    impacts: list[Impact] = []
    peaks: list[float] = []
    arcs: list[tuple[float, float, Callable[[Array], Array]]] = []
    evaluations = 0
    outcome = Outcome.TIME_ENDED
    rising = case.released_outwards
    if not rising:
        peaks.append(case.release_peak)
    if case.theta0 == 0 and case.omega0 == 0:
        outcome = Outcome.AT_REST
    while outcome is Outcome.TIME_ENDED and t < case.duration:
        if rising or y[0] * s > 0:
            first = peak if rising else impact
            arc = solve_ivp(
                rocking,
                (t, case.duration),
                y,
                method="DOP853",
                events=(first, overturning),
                dense_output=True,
                rtol=rtol,
                atol=atol,
            )
            evaluations += arc.nfev
            if arc.status < 0:
                raise RuntimeError(f"no solution beyond t = {arc.t[-1]:g} s: {arc.message}; relax rtol or atol")
            arcs.append((t, float(arc.t[-1]), arc.sol))
            t, y = float(arc.t[-1]), arc.y[:, -1]
            if arc.t_events[1].size:
                outcome = Outcome.OVERTURNED
                break
            if not arc.t_events[0].size:
                break  # the time is over
        if rising:
            peaks.append(abs(float(y[0])))
            rising = False
            continue
        before, after = float(y[1]), float(restitution * y[1])
        if case.side_stop:
            after = -after
        energies = [0.5 * wall.toe_inertia * w**2 for w in (before, after)]
        impacts.append(Impact(t, before, after, *energies))
        if energies[1] <= rest * case.release_energy:
            outcome = Outcome.AT_REST
            break
        s = math.copysign(1.0, after)
        y = np.array([0.0, after])
        rising = True
    if outcome is Outcome.TIME_ENDED and abs(y[0]) > alpha:
        outcome = Outcome.OVERTURNED

    t_end = t if outcome is Outcome.OVERTURNED else case.duration
    samples = np.linspace(0.0, t_end, max(2, math.ceil(t_end / output_step) + 1))
    theta, omega = np.zeros_like(samples), np.zeros_like(samples)
    for start, end, solution in arcs:
        within = (samples >= start) & (samples <= end)
        if within.any():
            theta[within], omega[within] = solution(samples[within])
    energy = wall.potential_energy(theta) + 0.5 * wall.toe_inertia * omega**2
    return Response(
        case=case,
        solver="analytical",
        t=samples,
        theta=theta,
        omega=omega,
        energy=energy,
        impacts=tuple(impacts),
        peaks=np.array(peaks),
        outcome=outcome,
        message=describe(outcome, case, t_end, float(theta[-1])),
        stats={
            "wall_time": time.perf_counter() - started,
            "evaluations": evaluations,
            "arcs": len(arcs),
            "rtol": rtol,
            "atol": atol,
        },
    )
