"""MuJoCo: step the scene of a case, and turn what it did into a response."""

from __future__ import annotations

import inspect

from ..background_compilation import expect, first_answer
from ..method import METHOD, Method
from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import AnyCase
from ..problem.wall.plausibility import warn_if_still, warn_of_low_stop
from ..quantities import require_flag
from ..result.ending import Outcome, Stopwatch
from ..result.forces import required_room
from ..result.ledger import StepError
from ..result.motion import OutputStep
from ..result.problem import Problem, problem_of, require_in_text, required_start
from ..result.response import End, Response, State, recorded
from ..result.ties import warn_of_ties
from ..scene.course import Course
from ..scene.scene import Scene
from ..scene.time_step import sound_timestep, warn_if_tiny
from .mjcf import pair_rows
from .model import engine_of
from .options import Accuracy, FixedStep, NewmarkBeta, Options
from .plain.run import simulate_plain
from .run import EngineRun, Settings, simulation_error
from .run_warnings import (
    interpreted_seconds,
    require_for_contact_points,
    warn_if_coarse,
    warn_if_lifted,
    warn_if_sheared,
    warn_if_slid,
    warn_if_slow,
    warn_of_gain,
)
from .step_control import short_step
from .stepping import fitted_steps, fixed_steps

ACCURACY, ACCURACY_SHAKEN = 1e-3, 1e-4
"""Accuracy of fitted steps by default [-], the second for a wall on moving ground, whose rocking
multiplies what an impact errs by (`scripts/measure/records_accuracy.py`)."""
FINEST_REPEATED, SHARE_REPEATED = 1e-6, 1e-2
"""Accuracy down to which a run that breaks down is repeated by default [-], and the share of the accuracy of the user
down to which it is [-]."""


def simulate(
    case: AnyCase,
    contacts: Contacts | None = None,
    timestep: FixedStep = None,
    *,
    accuracy: Accuracy | None = None,
    newmark_beta: NewmarkBeta = 0.25,
    coulomb: bool | None = None,
    output_step: OutputStep = None,
    ledger: bool = False,
    forces: bool = False,
    start: End | State | None = None,
    method: Method = METHOD,
    collisions: bool = False,
) -> Response:
    """Rocking of a wall, or motion of masonry of many blocks, on compliant contacts in MuJoCo.

    Args:
        case: the wall, its release, its sides; or masonry and what moves it. Masonry settles under its weight first.
        contacts: the interfaces of the wall; masonry has its own joints.
        timestep: a fixed step [s]; None lets the steps fit the motion, see `mjrock.engine.stepping`.
        accuracy: what fitted steps aim at, as a relative tolerance on rotation and energy from one impact to the next
            [-], 1e-8 to 0.1. None means 1e-3, and 1e-4 for a wall on moving ground, whose rocking multiplies
            what an impact errs by. A run in which energy appears from nowhere is discarded and repeated with a tenth of
            it, twice at most, or down to 1e-6 where none is given.
        newmark_beta: Newmark's beta of the contact rows at a fixed step [-], 0 to 10, see `mjrock.contacts.solref`.
        coulomb: whether contacts that slide obey Coulomb's law, see `mjrock.engine.sliding`. None means True where
            steps fit the motion, and False at a fixed step, which then is the model text, stepped by MuJoCo.
        output_step: largest spacing of the returned samples [s], 1e-9 to the duration; the last is the end of the run.
            Fixed steps are thinned to whole steps, so that the spacing may be less, or one step. None returns them all,
            with collisions one every 1 ms. The run ends with the step that is nearest to the duration. Fitted steps are
            interpolated at even distances, and None stands for 1 ms.
        ledger: whether to account for every part of the energy, see `mjrock.engine.energy_work`.
        forces: whether to keep `forces` and `reactions` at every sample, see `Forces`. Those of fitted steps are of the
            step in whose window the sample lies.
        start: pose and velocity to start from instead of the release, the `end` of an earlier response; the release is
            then no peak, and the first is the first that is reached. It does not go with ties that yield.
        method: the constants of the method, see `mjrock.method`, for studies that vary them.
        collisions: whether MuJoCo finds the contacts itself, between boxes and hulls, so that blocks meet wherever they
            are and run on when they have fallen, see `mjrock.engine.plain`. Steps have one length; None means 0.1
            over the highest frequency of the closed contacts for a wall and 0.5 over it for masonry, and less with
            strong dampers. It does not go with accuracy, newmark_beta, coulomb and method.

    Returns:
        The `Response`: `t`, `pose`, `energy`, `outcome` and `message`, and `impacts`, `peaks` of a
        wall or `opening`, `fallen` of masonry.

    Raises:
        ValueError: if the contacts do not fit the case or cannot be represented at this step, if the masonry does not
            stand, for a tie that breaks with a fixed step, or for a value outside its range.
        SimulationError: if the run produces a NaN, an engine warning, or more energy than was there and was put in.

    Warns:
        UserWarning: if a fixed step is too long to resolve the contacts, if explicit steps would follow masonry of more
            than eight blocks in a fraction of the time, if energy appears from nowhere after blocks of masonry fell, if
            a ledger does not close, or if a tie without an `ultimate` was drawn out by more than a bar or an anchor
            follows.

    Examples:
        >>> answer = mr.simulate(case, contacts)
        >>> answer.outcome.value
        'at rest'
    """
    arguments, watch = locals().copy(), Stopwatch()
    problem = problem_of(case, contacts)
    if require_flag("collisions", collisions):
        refuse_with_collisions(accuracy=accuracy, newmark_beta=newmark_beta, coulomb=coulomb, method=method)
    aim = default_accuracy(case) if accuracy is None else accuracy
    options = Options(case.duration, timestep, aim, newmark_beta, coulomb, output_step, ledger, forces, method)
    finest = FINEST_REPEATED if accuracy is None else SHARE_REPEATED * options.accuracy
    if not collisions:
        require_for_contact_points(case)
    if contacts is not None and contacts.base.friction is None:
        warn_of_low_stop(case)
    if start is None:
        warn_if_still(case.is_still, forces=forces)
    if options.timestep is not None:
        require_in_text(case)
    if forces:
        required_room(case, options.samples)
    state = None if start is None else required_start(start, case)
    with first_answer(simulate, **arguments):
        if collisions:
            response = simulate_plain(problem, options, state)
            response.stats.update(watch.took())
            return recorded(response, arguments)
        scene = problem.scene(method)
        warn_if_sheared(scene)
        course = problem.course(scene)
        if state is not None:
            course = course.continued(*state)
        expect(interpreted_seconds(scene, course.duration, options.timestep))
        if options.timestep is None:
            warn_if_slow(scene)
            run, settings = run_fitted_steps(problem, scene, course, options, finest)
        else:
            warn_if_coarse(scene, options.timestep)
            warn_if_tiny(options.timestep, sound_timestep(scene.highest_frequency))
            run, settings = run_fixed_steps(problem, scene, course, options, options.timestep)
        response = run.response(options, settings)
    if not (options.timestep is None or options.slides):
        warn_if_lifted(scene, run.steps)
    warn_if_slid(run)
    warn_of_gain(response, run, options.remedy)
    if response.outcome is not Outcome.OVERTURNED:
        warn_of_ties(case, response.plastic)
    response.stats.update(watch.took())
    return recorded(response, arguments)


def refuse_with_collisions(**options: object) -> None:
    """Raise a ValueError for options of `simulate` that do not go with collisions, unless they have their defaults."""
    parameters = inspect.signature(simulate).parameters
    for name, value in options.items():
        if value != parameters[name].default:
            raise ValueError(f"{name} = {value!r} does not go with collisions=True; leave it out")


def default_accuracy(case: AnyCase) -> float:
    """Default accuracy of fitted steps [-]."""
    return ACCURACY_SHAKEN if case.rocks_on_moving_ground else ACCURACY


def run_fitted_steps(
    problem: Problem, scene: Scene, course: Course, options: Options, finest: float
) -> tuple[EngineRun, Settings]:
    """A run with steps that fit the motion, and its settings and times for `stats`. It is repeated with finer steps
    where it breaks down.

    Raises:
        SimulationError: if it breaks down with the finest accuracy too.
    """
    used, method = options.accuracy, options.method
    while True:
        h = short_step(scene, used, method)
        try:
            with engine_of(scene) as engine:
                engine.place(course)
                watch = Stopwatch()
                steps = fitted_steps(engine, scene, course, used, coulomb=options.slides, method=method)
            took = watch.stepping()
            run = EngineRun.checked(problem, scene, course, steps)
            return run, {"timestep": h, "accuracy": used, "newmark_beta": None, **took}
        except StepError as error:
            if used < 2 * finest:
                raise simulation_error(error, scene, h, used) from None
            used /= 10


def run_fixed_steps(
    problem: Problem, scene: Scene, course: Course, options: Options, h: float
) -> tuple[EngineRun, Settings]:
    """A run at steps of one length h [s], and its settings and times for `stats`.

    Raises:
        SimulationError: if it breaks down.
    """
    beta, method = options.newmark_beta, options.method
    try:
        with engine_of(scene) as engine:
            engine.set_step(h, pair_rows(scene, h, beta, method))
            engine.release(course)
            watch = Stopwatch()
            steps = fixed_steps(engine, scene, course, beta, coulomb=options.slides, method=method)
        took = watch.stepping()
        run = EngineRun.checked(problem, scene, course, steps)
    except StepError as error:
        raise simulation_error(error, scene, h, None) from None
    return run, {"timestep": h, "accuracy": None, "newmark_beta": beta, **took}
