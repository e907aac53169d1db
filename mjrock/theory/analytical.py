"""Classical rocking theory: Eq. 1 between impacts, and a coefficient of restitution at each impact.

This solver knows no stiffness and no MuJoCo.
"""

from __future__ import annotations

import math
import time

import numpy as np

from ..problem.case import Case
from ..problem.quantities import require_kind, require_size, require_within
from ..problem.restitution import Restitution
from ..result.history import Impact
from ..result.response import Outcome, Response, describe
from .forced import rock_forced
from .free import rock_freely
from .rocking import Rocking


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

    A rebound with less than `rest` of the energy of release leaves the wall at rest. Under ground motion that share is
    of the energy that overturns the wall, and a wall at rest is lifted when |a_g| > g tan(alpha) towards a free side.

    Args:
        case: the wall, its release, its sides, its ground motion. With a side stop `e.lumped` rules and theta >= 0,
            without one `e.base`.
        e: the coefficients of restitution.
        rtol, atol: tolerances of the integration of free arcs (scipy, DOP853), on rotation [rad] and velocity [rad/s];
            `rtol` sets the longest step of forced ones, see `mjrock.theory.forced`.
        output_step: spacing of the returned samples [s].
        rest: smallest rebound that is still followed, as a share of the energy of release [-].

    Raises:
        ValueError: for a tolerance or step out of range, or a side stop from which the wall does not rebound.
        RuntimeError: if the integration fails.
    """
    require_kind("case", case, Case)
    require_kind("e", e, Restitution)
    require_within("rtol", rtol, 1e-14, 0.1)
    require_within("atol", atol, 1e-16, 0.1)
    require_within("output_step", output_step, 1e-7, 1e6, "s")
    require_within("rest", rest, 1e-30, 0.1)
    require_size("the samples of this answer", case.duration / output_step, "raise output_step or follow it for less")
    if case.side_stop and not -1 <= e.lumped < 0:
        raise ValueError(f"lumped restitution = {e.lumped:g} is outside the valid range -1 <= e_1s < 0 for a side stop")
    started = time.perf_counter()
    found = _rocking(case, e, rtol, atol, rest)
    if found.fell or abs(found.theta) > case.block.alpha:
        outcome = Outcome.OVERTURNED
    else:
        outcome = Outcome.AT_REST if found.at_rest else Outcome.TIME_ENDED
    t_end = found.t if outcome is Outcome.OVERTURNED else case.duration
    samples = np.linspace(0.0, t_end, max(2, math.ceil(t_end / output_step) + 1))
    theta, omega = found.sample(samples)
    released = [] if case.released_outwards or case.release_energy == 0 else [case.release_peak]
    return Response(
        case=case,
        solver="analytical",
        t=samples,
        theta=theta,
        omega=omega,
        impacts=tuple(map(Impact._make, found.impacts.tolist())),
        peaks=np.append(released, found.peaks),
        outcome=outcome,
        message=describe(outcome, case, t_end, float(theta[-1])),
        stats={
            "wall_time": time.perf_counter() - started,
            "evaluations": found.evaluations,
            "arcs": found.arcs,
            "rtol": rtol,
            "atol": atol,
        },
    )


def _rocking(case: Case, e: Restitution, rtol: float, atol: float, rest: float) -> Rocking:
    """The motion from impact to impact, free or forced."""
    wall, restitution = case.block, e.lumped if case.side_stop else e.base
    if case.motion is None:
        return rock_freely(case, restitution, rest * case.release_energy, rtol, atol)
    least = rest * float(wall.potential_energy(wall.alpha))
    return rock_forced(case, case.motion, restitution, least, rtol)
