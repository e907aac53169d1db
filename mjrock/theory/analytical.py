"""Classical rocking theory: Eq. 1 between impacts, and a coefficient of restitution at each impact.

This solver uses neither stiffness nor MuJoCo.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from ..background_compilation import first_answer
from ..problem.damping.restitution import AnyRestitution, Restitution, ScatteredRestitution, impacts_of
from ..problem.masonry.case import require_wall
from ..problem.wall.case import Case
from ..problem.wall.plausibility import warn_if_still
from ..problem.wall.restoring_moment import broken_energy, tie_energy
from ..quantities import GRAVITY, Array, Implausible, Within, require_kind, require_sample_count, warn_of, within_ranges
from ..result.ending import Outcome, Stopwatch, describe
from ..result.motion import OutputStep, RelativeError, intervals, required_spacing
from ..result.response import Response, recorded
from ..result.rocking import Impact, Rocking
from ..result.ties import Plastic, ties_message, warn_of_ties
from .arcs import RockingMotion, rock


@within_ranges
def solve_analytical(
    case: Case,
    e: AnyRestitution,
    *,
    rtol: RelativeError = 1e-10,
    output_step: OutputStep = None,
    rest: Annotated[float, Within(1e-30, 0.1)] = 1e-9,
) -> Response:
    """Rocking of a rigid wall by integrating Eq. 1 from peak to impact to peak, free or over a shaken base.

    Loads, thrusts, ties, added masses, openings, insets and vertical ground motion enter Eq. 1 as in
    `mjrock.theory.law`. Ties carry no impulse. A side stop that reaches only so high changes the restitution
    alone: give `Restitution.from_geometry(wall, stop_top)` or a measured one.

    A rebound with less than `rest` of the energy of release leaves the wall at rest. Under ground motion that share is
    of the energy that overturns the wall, and a wall at rest is lifted when |a_g| > g tan(alpha) towards a free side.

    Args:
        case: the wall, its release, its sides, its ground motion. With a side stop `e.lumped` rules and theta >= 0,
            without one `e.base`.
        e: the coefficients of restitution, or those from which each impact draws its own.
        rtol: error of the integration, about, over alpha in a fall from alpha/2 [-], 1e-14 to 0.1. It sets the
            longest step.
        output_step: largest spacing of the returned samples [s], 1e-9 to 1e6 and at most the duration; None means
            1 ms. They are evenly spaced, and the last is the end of the run.
        rest: smallest rebound that is still followed, as a share of the energy of release [-], 1e-30 to 0.1.

    Returns:
        The `Response`: `t`, `pose`, `energy`, `outcome` and `message`, `impacts` and `peaks`.

    Raises:
        ValueError: for a tolerance or step out of range, a side stop from which the wall does not rebound, or a
            vertical motion that lifts the wall off its base.
    Warns:
        Implausible: if the restitution was made for another wall or another side stop.
        UserWarning: if a tie without an `ultimate` was drawn out by more than a bar or an anchor follows.

    Examples:
        >>> answer = mr.solve_analytical(case, e)
        >>> answer.outcome.value
        'at rest'
    """
    arguments = locals().copy()
    require_wall("case", case, "solve_explicit or simulate")
    require_kind("e", e, Restitution, ScatteredRestitution)
    spacing = required_spacing(output_step, case.duration)
    require_sample_count(case.duration / spacing)
    _require_solvable(case, e)
    if difference := e.difference_from(case.wall, case.stop_top):
        warn_of(difference, Implausible)
    warn_if_still(case.is_still)
    watch = Stopwatch()
    with first_answer(solve_analytical, **arguments):
        motion = _rocking(case, e, rtol, rest)
        outcome = _outcome(case, motion)
        t_end = float(motion.end.t) if outcome is Outcome.OVERTURNED else case.duration
        samples = np.linspace(0.0, t_end, intervals(t_end, spacing) + 1)
        theta, omega = motion.sample(samples)
    release_peaks = [] if case.released_outwards or case.release_energy == 0 else [case.release_peak]
    energy_of_ties, plastic = _tie_states(case, motion, samples, theta)
    if outcome is not Outcome.OVERTURNED:
        warn_of_ties(case, plastic)
    response = Response(
        case=case,
        solver="analytical",
        t=samples,
        motion=RigidMotion(case, theta, omega, energy_of_ties),
        rocking=Rocking(tuple(map(Impact._make, motion.impacts.tolist())), np.append(release_peaks, motion.peaks)),
        outcome=outcome,
        plastic=plastic,
        message=describe(outcome, case, t_end, float(theta[-1])) + ties_message(plastic),
        stats={**watch.took(), "evaluations": motion.evaluations, "rtol": rtol},
    )
    return recorded(response, arguments)


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """A `mjrock.result.motion.Motion` of a rigid wall. Pose, velocity and energy are computed when they are first read:
    campaigns read peaks and impacts alone, and computing them takes longer than the rocking.

    Args:
        case: the wall.
        rotation, rate: rotation [rad] and angular velocity [rad/s] at the samples, shape (n,).
        of_ties: energy of the ties at the samples [J].
    """

    case: Case
    rotation: Array
    rate: Array
    of_ties: Array | float

    @property
    def theta(self) -> Array:
        """Rotation of the one body [rad], shape (n, 1)."""
        return self.rotation[:, None]

    @cached_property
    def pose(self) -> Array:
        """Displacement of the centroid [m] and rotation [rad], shape (n, 1, 3)."""
        return self.case.wall.pose(self.rotation)[:, None]

    @cached_property
    def velocity(self) -> Array:
        """Its rate [m/s, rad/s], shape (n, 1, 3)."""
        return self.case.wall.velocity(self.rotation, self.rate)[:, None]

    @cached_property
    def energy(self) -> Array:
        """Energy of the wall and its ties above rest [J], shape (n,)."""
        return self.case.energy(self.rotation, self.rate) + self.of_ties


def _outcome(case: Case, motion: RockingMotion) -> Outcome:
    """How a motion ended."""
    if motion.end.fell or not case.returns_from(np.array([motion.end.theta]))[0]:
        return Outcome.OVERTURNED
    return Outcome.AT_REST if motion.end.at_rest else Outcome.TIME_ENDED


def _require_solvable(case: Case, e: AnyRestitution) -> None:
    """Raise ValueError for a case that rocking theory does not cover."""
    if case.side_stop and not -1 <= e.lumped < 0:
        hint = "" if case.stop_top == 2 * case.block.h else f": a stop of {case.stop_top:g} m may be too low"
        raise ValueError(
            f"lumped restitution = {e.lumped:g} is outside the valid range -1 <= e_1s < 0 for a side stop{hint}"
        )
    case.require_for("rocking theory")
    for name, link in case.links.items():
        if not link.law.holds:
            raise ValueError(
                f"rocking theory has links that only pull, and {name} is none; "
                "simulate, solve_explicit and solve_compliant take it"
            )
    if case.restoring.outer.P <= 0:
        raise ValueError(
            "the thrust tilts the wall until its ties hold it, and rocking theory knows no rest but upright; "
            "simulate and solve_compliant do"
        )
    if case.vertical is not None and case.vertical.accel.min() <= -GRAVITY:
        raise ValueError(
            f"the vertical ground motion reaches {case.vertical.accel.min():.4g} m/s2, which lifts the wall off its "
            f"base; the valid range of rocking theory is above {-GRAVITY:g} m/s2, and simulate has none"
        )


def _rocking(case: Case, e: AnyRestitution, rtol: float, rest: float) -> RockingMotion:
    """The motion from impact to impact."""
    shaken = case.motion is not None or case.vertical is not None
    outer, inner = case.restoring
    weaker = outer if case.side_stop or outer.P <= inner.P else inner
    least_energy = rest * (float(weaker.energy(weaker.alpha)) if shaken else case.release_energy)
    return rock(case, impacts_of(e, lumped=bool(case.side_stop)), least_energy, rtol)


def _tie_states(case: Case, motion: RockingMotion, t: Array, theta: Array) -> tuple[Array | float, dict[str, Plastic]]:
    """Energy of the ties at the samples [J], and what they have yielded."""
    if not case.pulls:
        return 0.0, {}
    times = motion.knots["t"]
    plastic, ends = np.empty((len(t), len(case.pulls))), {}
    for i, (pull, elongation) in enumerate(zip(case.pulls, motion.yielded.T, strict=True)):
        broken = np.isinf(elongation)
        yielded, break_time = np.where(broken, pull.ultimate, elongation), float(times[broken].min(initial=math.inf))
        plastic[:, i], final = np.where(t >= break_time, np.inf, np.interp(t, times, yielded)), float(yielded[-1])
        ends[f"tie_{i}"] = Plastic(
            final, final * pull.strength if final else 0.0, break_time, broken_energy(pull) if broken.any() else 0.0
        )
    return tie_energy(case.pulls, theta, plastic), ends
