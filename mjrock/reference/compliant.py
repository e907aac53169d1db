"""The contact law itself, integrated by SciPy: unilateral Kelvin-Voigt points.

This solver uses neither restitution nor MuJoCo, and it shares no kinematics with the engine that it checks. Each
contact point carries f = max(0, -(k r + c dr/dt)) while its gap r is negative, so never a tension. The base does not
slip. While an edge of it is loaded, friction without a bound holds the lower edge, halfway between the two faces that
overlap there. An edge that lands with a sliding velocity loses it at once, in the impulse of that friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from ..bars import Bar
from ..problem.damping.contacts import Contacts
from ..problem.ground.motion import GroundMotion
from ..problem.masonry.case import require_wall
from ..problem.wall.case import Case
from ..problem.wall.plausibility import warn_if_still, warn_of_low_stop
from ..quantities import ON_ITS_FACE, Array, Within, require_kind, require_sample_count, within_ranges
from ..result.ending import Stopwatch
from ..result.motion import OutputStep, RelativeError, SampledMotion, intervals, required_spacing, thinned
from ..result.reading import wall_reading
from ..result.response import Response, recorded
from ..result.ties import Plastic
from .equations import Wall

RECAUGHT_LOAD = 1e-3
"""Load of an edge at which friction catches it again, as a share of the weight [-]. Friction releases it at no load.
With a gap between the two, a hardly loaded edge is caught and released at a finite rate. The ideal law would do both at
once."""
MOST_SWITCHES = 100_000
"""Most changes between sticking and slipping in one run, of the base and of all friction dampers. More are an error."""


@within_ranges
def solve_compliant(
    case: Case,
    contacts: Contacts,
    *,
    rtol: RelativeError = 1e-8,
    atol: Annotated[float, Within(1e-16, 0.1)] = 1e-10,
    output_step: OutputStep = None,
) -> Response:
    """Rocking of a wall on compliant contacts: what `simulate` has to reproduce.

    Args:
        case: the wall, its release, its sides.
        contacts: the interfaces.
        rtol: relative tolerance of the integration (scipy, DOP853) [-], 1e-14 to 0.1.
        atol: absolute tolerance of it [-], in m, rad, m/s and rad/s, 1e-16 to 0.1.
        output_step: largest spacing of the returned samples [s], 1e-9 to 1e6 and at most the duration; None means
            0.5 ms. They are evenly spaced, and the last is the end of the run.

    Returns:
        The `Response`: `t`, `pose`, `energy`, `outcome` and `message`, `impacts` and `peaks`.

    Raises:
        ValueError: if the contacts do not fit the case, for a tolerance or step out of range, or a tie that yields.
        RuntimeError: if the integration fails.

    Examples:
        >>> answer = mr.solve_compliant(case, contacts)
        >>> answer.outcome.value
        'at rest'
    """
    arguments = locals().copy()
    require_wall("case", case, "solve_explicit or simulate")
    require_kind("contacts", contacts, Contacts)
    spacing = required_spacing(output_step, case.duration, 5e-4)
    wall = case.wall
    contacts.require_fit(case.block, side_stop=case.one_sided)
    warn_of_low_stop(case)
    warn_if_still(case.is_still)
    watch = Stopwatch()
    system = Wall(case, contacts)
    period = 2 * math.pi / contacts.highest_frequency(wall, side_stop=case.one_sided)
    count = intervals(case.duration, spacing)
    parts = intervals(case.duration / count, 1e-3 / wall.p)  # peaks and impacts are read off finer samples
    require_sample_count(count * parts)
    output = np.linspace(0.0, case.duration, count * parts + 1)
    solution = _integrate(system, case, output, period, rtol, atol)
    t, states = solution.t, solution.states
    motion = SampledMotion(states[:, None, :3], states[:, None, 3:6], system.energy(states))
    reading, kept = wall_reading(case, contacts, t, motion), thinned(len(t), parts)
    response = Response(
        case=case,
        solver="compliant",
        t=t[kept],
        motion=SampledMotion(motion.pose[kept], motion.velocity[kept], motion.energy[kept]),
        rocking=reading.rocking,
        outcome=reading.outcome,
        message=reading.message,
        plastic={
            name: Plastic(slider.path, slider.path * slider.law.strength, start=slider.start)
            for name, slider in system.sliders.items()
        },
        stats={
            **reading.stats,
            **watch.took(),
            "evaluations": solution.evaluations,
            "switches": solution.switches,
            "rtol": rtol,
            "atol": atol,
        },
    )
    return recorded(response, arguments)


class Solution(NamedTuple):
    """The motion of a wall.

    Args:
        t: times of the output up to the end [s], shape (n,).
        states: of the wall, and behind them the places of the sliders of friction dampers, shape (n, 6 + sliders).
        evaluations: of the equations of motion.
        switches: how often the base or a slider was caught or released.
    """

    t: Array
    states: Array
    evaluations: int
    switches: int


def _integrate(system: Wall, case: Case, output: Array, period: float, rtol: float, atol: float) -> Solution:
    """The motion of a wall at the times of the output, which ends where the wall overturns.

    The integration is split where friction catches or releases the base, where a slider begins to slip or to stick, and
    where the ground jumps.
    """

    def switch(t: float, y: Array) -> float:
        return system.edge_load(t, y) - (0.0 if is_held else RECAUGHT_LOAD * system.weight)

    def overturning(t: float, y: Array) -> float:
        return abs(float(y[2])) - ON_ITS_FACE

    switch.terminal = overturning.terminal = True  # type: ignore[attr-defined]
    t, y = 0.0, system.released()
    is_held, slider_events = system.edge_load(t, y) > 0, [slider_event(system, i) for i in range(len(system.sliders))]
    have_fired = [False] * len(slider_events)
    system.settle(y, have_fired)
    states, times = [system.with_places(y[:, None])], [np.zeros(1)]
    evaluations = switches = 0
    with Bar("contact law, SciPy", "s", case.duration) as bar:
        while switches < MOST_SWITCHES:
            if is_held:
                y = system.caught(y)
            system.settle(y, have_fired)
            switch.direction = -1 if is_held else 1  # type: ignore[attr-defined]
            end = system.begin_arc(t)
            inside = output[(output > t) & (output <= end)]
            arc = solve_ivp(
                system.sticking if is_held else system.free,
                (t, end),
                y,
                method="DOP853",
                t_eval=np.unique(np.append(inside, end)),
                events=(switch, overturning, *slider_events),
                rtol=rtol,
                atol=atol,
                max_step=min([10 * period, *(motion.dt for motion in system.grounds if _is_sampled(motion, t, end))]),
            )
            if arc.status < 0:
                raise RuntimeError(f"no solution beyond t = {arc.t[-1]:g} s: {arc.message}; relax rtol or atol")
            evaluations += arc.nfev
            times.append(arc.t[: len(inside)])
            states.append(system.with_places(np.reshape(arc.y, (6, -1))[:, : len(inside)]))
            if arc.status == 0 and end < case.duration:
                t, y, have_fired = end, arc.y[:, -1], [False] * len(slider_events)
                continue
            if arc.status == 0 or arc.t_events[1].size:
                system.settle(arc.y_events[1][0] if arc.t_events[1].size else arc.y[:, -1], have_fired)
                return Solution(np.concatenate(times), np.concatenate(states, axis=1).T, evaluations, switches)
            have_fired = [bool(instants.size) for instants in arc.t_events[2:]]
            event = next(i for i, instants in enumerate(arc.t_events) if instants.size)
            t, y = float(arc.t_events[event][0]), arc.y_events[event][0]
            bar.to(t)
            is_held = is_held != bool(arc.t_events[0].size)
            switches += 1
    raise RuntimeError(
        f"base or dampers began to stick or slip {MOST_SWITCHES} times by t = {t:g} s; relax rtol or atol"
    )


def _is_sampled(motion: GroundMotion, t: float, end: float) -> bool:
    """Whether a motion has samples within an arc, which its steps then resolve."""
    return motion.instants is None or bool(((motion.instants > t) & (motion.instants < end)).any())


def slider_event(system: Wall, i: int) -> Callable[[float, Array], float]:
    """The event at which slider i begins to slip or to stick."""
    slider = list(system.sliders.values())[i]

    def change(t: float, y: Array) -> float:
        return slider.change(*map(float, system.elongations(y)[i]))

    change.terminal, change.direction = True, -1  # type: ignore[attr-defined]
    return change
