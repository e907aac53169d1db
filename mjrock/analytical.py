"""Classical rocking: Eq. 1 between impacts, a coefficient of restitution at each. Knows no stiffness and no MuJoCo."""

from __future__ import annotations

import math
import time

import numpy as np

from .arcs import Event, ForcedArcs, FreeArcs
from .block import require_within
from .case import Case
from .response import Impact, Outcome, Response, describe
from .restitution import Restitution


def solve_analytical(
    case: Case,
    e: Restitution,
    *,
    rtol: float = 1e-10,
    atol: float = 1e-12,
    output_step: float = 1e-3,
    rest: float = 1e-9,
) -> Response:
    """Rocking of a rigid wall by integrating Eq. 1 from peak to impact to peak, free or over a shaken base.

    Impacts that accumulate end the rocking: a rebound with less than `rest` of the energy of release leaves the wall at
    rest. Under ground motion that share is of the energy that overturns the wall, and a wall at rest is lifted again
    when |a_g| > g tan(alpha) towards a free side.

    Args:
        case: the wall, its release, its sides, its ground motion. With a side stop `e.lumped` rules and theta >= 0,
            without one `e.base`.
        e: the coefficients of restitution.
        rtol, atol: tolerances of the integration of free arcs (scipy, DOP853), on rotation [rad] and velocity [rad/s];
            `rtol` sets the longest step of forced ones, see `mjrock.arcs`.
        output_step: spacing of the returned samples [s].
        rest: smallest rebound that is still followed, as a share of the energy of release [-].

    Raises:
        ValueError: for a tolerance or step out of range, or a side stop from which the wall does not rebound.
        RuntimeError: if the integration fails.
    """
    require_within("rtol", rtol, 1e-14, 0.1)
    require_within("atol", atol, 1e-16, 0.1)
    require_within("output_step", output_step, 1e-7, 1e6, "s")
    require_within("rest", rest, 1e-30, 0.1)
    if case.side_stop and not -1 <= e.lumped < 0:
        raise ValueError(f"lumped restitution = {e.lumped:g} is outside the valid range -1 <= e_1s < 0 for a side stop")
    started = time.perf_counter()
    wall = case.block
    if case.motion is None:
        arcs: FreeArcs | ForcedArcs = FreeArcs(case, rtol, atol)
        least = rest * case.release_energy
    else:
        arcs = ForcedArcs(case, case.motion, rtol)
        least = rest * float(wall.potential_energy(wall.alpha))

    state = (0.0, case.theta0, case.omega0)
    s, event = case.direction, Event.TIME
    impacts: list[Impact] = []
    peaks = [] if case.released_outwards or case.release_energy == 0 else [case.release_peak]
    at_rest = case.theta0 == 0 and case.omega0 == 0
    while state[0] < case.duration:
        if at_rest:
            lifted, side = arcs.uplift(state[0])
            if lifted >= case.duration:
                break
            state, s, at_rest = (lifted, 0.0, 0.0), side, False
        state, event = arcs.advance(state, s)
        if event is Event.FALL:
            break
        if event is Event.PEAK:
            peaks.append(abs(state[1]))
        elif event is Event.IMPACT:
            before = state[2]
            after = e.lumped * before if case.side_stop else e.base * before
            energies = [0.5 * wall.toe_inertia * omega**2 for omega in (before, after)]
            impacts.append(Impact(state[0], before, after, *energies))
            at_rest = energies[1] <= least
            s = math.copysign(1.0, after)
            state = (state[0], 0.0, 0.0 if at_rest else after)

    if event is Event.FALL or abs(state[1]) > wall.alpha:
        outcome = Outcome.OVERTURNED
    else:
        outcome = Outcome.AT_REST if at_rest else Outcome.TIME_ENDED
    t_end = state[0] if outcome is Outcome.OVERTURNED else case.duration
    samples = np.linspace(0.0, t_end, max(2, math.ceil(t_end / output_step) + 1))
    theta, omega = arcs.sample(samples)
    return Response(
        case=case,
        solver="analytical",
        t=samples,
        theta=theta,
        omega=omega,
        energy=wall.potential_energy(theta) + 0.5 * wall.toe_inertia * omega**2,
        impacts=tuple(impacts),
        peaks=np.array(peaks),
        outcome=outcome,
        message=describe(outcome, case, t_end, float(theta[-1])),
        stats={
            "wall_time": time.perf_counter() - started,
            "evaluations": arcs.evaluations,
            "arcs": len(arcs.known),
            "rtol": rtol,
            "atol": atol,
        },
    )
