"""Explicit steps: the contact law of a wall or of masonry by the scheme of distinct-element codes."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

import numpy as np

from ..background_compilation import first_answer
from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import AnyCase
from ..problem.wall.plausibility import warn_if_still
from ..quantities import Within, require_flag, require_sample_count, require_size, require_whole, within_ranges
from ..result.ending import Outcome, Stopwatch
from ..result.forces import required_room
from ..result.motion import OutputStep, required_spacing
from ..result.problem import problem_of, required_start
from ..result.response import End, Response, State, recorded
from ..result.ties import warn_of_ties
from ..scene.time_step import EXPLICIT_STEP, required_timestep
from .response import Run, response_of
from .search.overlap import checked_overlap
from .setup import Setup, continued, setup_of_problem, with_motion_damping
from .step_length import TimeGrid, TimeStep
from .system import Books, Samples
from .time_integration import Integration, integrate, warn_if_long

MOST_THREADS = 256
"""Most threads of a run."""
COMPILING_RUN = 0.02
"""Duration of the run by which another process compiles the loops [s]."""


@within_ranges
def solve_explicit(
    case: AnyCase,
    contacts: Contacts | None = None,
    timestep: TimeStep = None,
    *,
    output_step: OutputStep = None,
    ledger: bool = False,
    forces: bool = False,
    start: End | State | None = None,
    mass_damping: Annotated[float, Within(0, 1e4, "1/s")] = 0.0,
    local_damping: Annotated[float, Within(0, 0.9)] = 0.0,
    threads: Annotated[int | None, Within(1, MOST_THREADS)] = None,
) -> Response:
    """Rocking of a wall, or motion of masonry of many blocks, by explicit steps.

    The scheme is that of the distinct element method: symplectic Euler, a unilateral spring and dashpot along each
    normal, and along each face a spring of stiffness k_s with a Coulomb slider, or rigid friction where k_s is None
    (Cundall and Strack, Geotechnique 29, 1979, 47-65). It shares no kinematics and no time integration with MuJoCo.

    Masonry in space is stepped likewise, with an angular momentum and a quaternion for each block (docs/masonry.md).
    Blocks that leave their joints meet others wherever they are, in the plane and in space.

    Args:
        case: the wall, its release, its sides; or masonry and what moves it.
        contacts: the interfaces of the wall; masonry has its own joints.
        timestep: length of a step [s], 1e-12 to 1; None takes 0.4 of the longest stable one for masonry, less where
            dashpots are strong or ties stiff, and 0.05 of it for a wall, whose impacts are read one by one, shortened
            to a whole share of the spacing of the samples.
        output_step: largest spacing of the returned samples [s], 1e-9 to 1e6 and at most the duration; None stands for
            1 ms. The last sample is the end of the run. A given timestep is kept: the spacing is a whole number of
            steps, the last one may be shorter, and the run ends with the step that is nearest to the duration.
        ledger: whether to account for every part of the energy. A residual above 1 % of the largest part warns.
        forces: whether to keep `forces` and `reactions` at every sample, see `Forces`.
        start: pose and velocity to start from instead of the release, the `end` of an earlier response. The end of
            explicit steps of the same structure carries on to rounding, histories of supports from wherever they have
            ended. Ties that yield go with such an end alone.
        mass_damping: rate at which every velocity decays [1/s], 0 to 1e4, for slow motions.
        local_damping: share of the unbalanced force along each axis of a body that acts against its velocity, for slow
            motions of masonry with k_s [-], 0 to 0.9. The account "motion" of the dashpots has what both take.
        threads: how many threads make the steps [-], 1 to 256; the answer is the same to the last bit for any number.
            Rigid friction takes one, whatever is given. None takes one for less than 1,000 contact lines and in a
            worker of a campaign, and else all cores of this process, as long as these are faster.

    Returns:
        The `Response`: `t`, `pose`, `energy`, `outcome` and `message`, and `impacts`, `peaks` of a
        wall or `opening`, `fallen` of masonry.

    Raises:
        ValueError: if the contacts do not fit the case, if the masonry does not stand, for a step that is not stable,
            or for a value outside its range.
        TypeError: for an argument of another type.
        RuntimeError: if numbers are no longer finite, or if more energy appears than was there and was put in.

    Warns:
        UserWarning: of dashpots that make the steps take more than some ten seconds, of a tie drawn out too far, of
            blocks inside each other, and of contacts that had to be softened.
        Implausible: of a given timestep that is far below what the contacts need, and of a wall at rest that nothing
            moves.

    Examples:
        >>> column = mr.Masonry.column(width=0.5, height=2.0, drums=4)
        >>> mr.solve_explicit(mr.MasonryCase(column, duration=0.1)).outcome.value
        'at rest'
    """
    arguments, watch = locals().copy(), Stopwatch()
    problem = problem_of(case, contacts)
    require_flag("ledger", ledger)
    require_flag("forces", forces)
    if threads is not None:
        threads = require_whole("threads", threads, 1, MOST_THREADS)
    timestep = required_timestep(timestep, EXPLICIT_STEP, case.duration)
    spacing = required_spacing(output_step, case.duration)
    state = None if start is None else required_start(start, case, remembers=True)
    if start is None:
        warn_if_still(case.is_still, forces=forces)
    with first_answer(solve_shortly, case=case, contacts=contacts):
        setup = with_motion_damping(
            continued(setup_of_problem(problem, contacts, state), start), mass_damping, local_damping
        )
    scene, grid = setup.scene, TimeGrid.of_run(setup.step_length, setup.course.duration, timestep, spacing)
    count, bodies = grid.samples, len(scene.bodies.names)
    require_sample_count(count * bodies)
    books = Books.empty(setup.system, len(scene.contacts.joints) + 1 + setup.has_motion_damping)
    if ledger:
        require_size("the ledger of this answer", count * books.size, "raise output_step, or leave the ledger out")
    samples = Samples.room(count, setup.system, books, ledger=ledger, checks=len(grid.checks(grid.last + 1)))
    if forces:
        samples = samples.with_forces(required_room(case, count))
    warn_if_long(setup, grid)
    stepping = Stopwatch()
    integration = integrate(setup, books, samples, grid, threads)
    stats = step_stats(setup, grid, integration, stepping.stepping())
    kept = slice(integration.samples)
    samples = samples.chosen(kept).since_the_start()
    if setup.search is not None:
        stats["overlap"] = checked_overlap(setup, case, samples.pose, grid.times()[kept], grid.h)
    checked = grid.checks(integration.steps)
    run = Run(setup, integration, books, samples, grid.times()[kept], checked)
    response = response_of(run, ledger=ledger, stride=grid.stride, stats=stats)
    if response.outcome is not Outcome.OVERTURNED:
        warn_of_ties(case, response.plastic)
    response.stats.update(watch.took())
    response.stats["processor_time"] += integration.processor
    return recorded(response, arguments)


def step_stats(setup: Setup, grid: TimeGrid, integration: Integration, took: dict[str, float]) -> dict[str, Any]:
    """What the steps took, of all threads, and what they were."""
    return took | {
        "stepping_processor_time": took["stepping_processor_time"] + integration.processor,
        "steps": integration.steps,
        "timestep": grid.h,
        "stable_timestep": setup.step_length.limit,
        "share": grid.h / setup.step_length.limit,
        "threads": integration.threads,
        "friction": "springs" if np.isfinite(integration.system.lines["k_s"]).any() else "rigid",
    }


def solve_shortly(case: AnyCase, contacts: Contacts | None) -> None:
    """The first steps of a case, which call all loops."""
    solve_explicit(replace(case, duration=min(case.duration, COMPILING_RUN)), contacts)
