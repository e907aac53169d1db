"""MuJoCo: step the scene of a case, and turn what it did into a response."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from typing import overload

from ..problem.block import Block
from ..problem.case import Case
from ..problem.contacts import Contacts
from ..problem.masonry_case import MasonryCase
from ..problem.quantities import (
    ON_ITS_FACE,
    require_flag,
    require_kind,
    require_size,
    require_within,
    shown,
)
from ..problem.uplift import Uplift
from ..result.masonry import MasonryResponse
from ..result.response import Response, State
from .attempts import fitted, fixed, require_coulomb, required_start, stride_of
from .caveats import warn_if_coarse, warn_if_lifted, warn_if_open, warn_if_slid
from .masonry_run import simulate_masonry
from .mjcf import pair_rows
from .model import SimulationError
from .run import Run, sound_timestep
from .scene import Scene
from .steps import Steps
from .wall import wall_scene


def automatic_timestep(wall: Block, contacts: Contacts, *, side_stop: bool) -> float:
    """The step [s] at which a touch misplaces no more than ENERGY_GAIN of the energy that it meets.

    A point that touches inside a step of length h is met up to h/2 too early or too late, and its spring then stores up
    to k (v h/2)^2 / 2 that the motion has not paid. Against the kinetic energy m v^2 / 2 behind the point that is
    (omega h / 2)^2, with omega the frequency of the contact. So omega h = 2 sqrt(ENERGY_GAIN), omega the highest
    frequency of the wall with every contact closed: about a hundred steps in the shortest contact period.
    """
    require_kind("wall", wall, Block)
    require_kind("contacts", contacts, Contacts)
    require_flag("side_stop", side_stop)
    contacts.require_fit(wall, side_stop=side_stop)
    return sound_timestep(contacts.highest_frequency(wall, side_stop=side_stop))


@overload
def simulate(
    case: Case,
    contacts: Contacts,
    timestep: float | None = None,
    *,
    accuracy: float = 1e-3,
    newmark_beta: float = 0.25,
    coulomb: bool | None = None,
    output_step: float | None = None,
    ledger: bool = False,
    start: State | None = None,
) -> Response: ...


@overload
def simulate(
    case: MasonryCase,
    contacts: None = None,
    timestep: float | None = None,
    *,
    accuracy: float = 1e-3,
    newmark_beta: float = 0.25,
    coulomb: bool | None = None,
    output_step: float | None = None,
    ledger: bool = False,
    start: State | None = None,
) -> MasonryResponse: ...


def simulate(
    case: Case | MasonryCase,
    contacts: Contacts | None = None,
    timestep: float | None = None,
    *,
    accuracy: float = 1e-3,
    newmark_beta: float = 0.25,
    coulomb: bool | None = None,
    output_step: float | None = None,
    ledger: bool = False,
    start: State | None = None,
) -> Response | MasonryResponse:
    """Rocking of a wall, or motion of masonry of many blocks, on compliant contacts in MuJoCo.

    Args:
        case: the wall, its release, its sides; or masonry and what moves it. Masonry settles under its weight first.
        contacts: the interfaces of the wall; masonry has its own joints.
        timestep: a fixed step [s]; None lets the steps fit the motion, see `mjrock.engine.stepping`.
        accuracy: what fitted steps aim at, as a relative tolerance on rotation and energy [-], 1e-8 to 0.1. A run in
            which energy appears from nowhere is discarded and repeated with a tenth of it, twice at most.
        newmark_beta: Newmark's beta of the contact rows at a fixed step [-], 0 to 10, see `mjrock.engine.contact`.
        coulomb: whether contacts that slide obey Coulomb's law, see `mjrock.engine.sliding`. None stands for True where
            steps fit the motion, and for False at a fixed step, which then is the model text, stepped by MuJoCo.
        output_step: spacing of the returned samples [s]. Fixed steps are thinned to whole steps, None returns them
            all; fitted steps are interpolated, None stands for 1 ms.
        ledger: whether to account for every part of the energy, see `mjrock.engine.accounts`.
        start: pose and velocity to start from instead of the release, the `end` of an earlier response; the release is
            then no peak, and the first is the first that is reached. It does not go with ties that yield.

    Raises:
        ValueError: if the contacts do not fit the case or cannot be represented at this step, if the masonry does not
            stand, or for a value outside its range.
        SimulationError: if the run produces a NaN, an engine warning, or more energy than was there and was put in.

    Warns:
        UserWarning: if a fixed step is too long to resolve the contacts.
    """
    if isinstance(case, MasonryCase):
        if contacts is not None:
            raise TypeError(f"contacts = {shown(contacts)}: masonry has its joints; call simulate(case)")
        return simulate_masonry(case, timestep, accuracy, newmark_beta, coulomb, output_step, ledger, start)
    output_step = _required_spacing(case, contacts, output_step, ledger)
    assert contacts is not None
    accuracy = require_within("accuracy", accuracy, 1e-8, 0.1)
    start = None if start is None else _required_state(start, case)
    if timestep is not None:
        (answer,) = _simulate_fixed([case], contacts, timestep, newmark_beta, coulomb, output_step, ledger, start)
        if isinstance(answer, SimulationError):
            raise answer
        return answer
    return _simulate_fitted(case, contacts, accuracy, newmark_beta, coulomb, output_step or 1e-3, ledger, start)


def simulate_batch(
    cases: Sequence[Case],
    contacts: Contacts,
    timestep: float,
    *,
    newmark_beta: float = 0.25,
    coulomb: bool | None = None,
    output_step: float | None = None,
    ledger: bool = False,
) -> list[Response | SimulationError]:
    """Many cases of one wall on the same contacts at one fixed step, stepped by threads.

    Each answer is what `simulate(case, contacts, timestep, ...)` returns or raises, to the last bit; a run that breaks
    down leaves the others alone.

    Args:
        cases: the cases; they differ in release, duration and ground motion only.
        contacts: the interfaces.
        timestep: the step [s].
        newmark_beta, coulomb, output_step, ledger: as in `simulate`.

    Raises:
        ValueError: if the walls or sides of the cases differ, or as `simulate` does.
    """
    if not isinstance(cases, Sequence):
        raise TypeError(f"cases = {shown(cases)} is not a list of cases")
    for i, case in enumerate(cases):
        require_kind(f"cases[{i}]", case, Case)
        output_step = _required_spacing(case, contacts, output_step, ledger)
    if not cases:
        return []
    first = cases[0]
    for i, case in enumerate(cases):
        if any(getattr(case, name) != getattr(first, name) for name in ("block", "side_stop", "effects")):
            raise ValueError(f"cases[{i}] has another wall, sides or effects than cases[0]; a batch has one geometry")
    return _simulate_fixed(cases, contacts, timestep, newmark_beta, coulomb, output_step, ledger, None)


def _simulate_fitted(
    case: Case,
    contacts: Contacts,
    accuracy: float,
    newmark_beta: float,
    coulomb: bool | None,
    output_step: float,
    want_ledger: bool,
    start: State | None,
) -> Response:
    """A run with steps that fit the motion, repeated with finer ones where energy appears from nowhere."""
    newmark_beta = require_within("newmark_beta", newmark_beta, 0.0, 10.0)
    require_coulomb(coulomb)
    require_size("the samples of this answer", case.duration / output_step, "raise output_step or follow it for less")
    started = time.perf_counter()
    scene, uplift = wall_scene(case, contacts), Uplift.of(case, contacts)

    def judge(steps: Steps) -> Run:
        return Run(case, uplift, scene, steps, released=start is None)

    run, settings = fitted(scene, scene.started if start is None else start, accuracy, coulomb, judge)
    warn_if_slid(run, contacts)
    response = run.response(output_step, 1, want_ledger, settings)
    warn_if_open(response, run, f"lower accuracy = {accuracy:g}")
    response.stats["wall_time"] = time.perf_counter() - started
    return response


def _simulate_fixed(
    cases: Sequence[Case],
    contacts: Contacts,
    timestep: float,
    newmark_beta: float,
    coulomb: bool | None,
    output_step: float | None,
    want_ledger: bool,
    start: State | None,
) -> list[Response | SimulationError]:
    """Runs of one geometry at one fixed step, or how each broke down."""
    timestep = require_within("timestep", timestep, 1e-9, 1.0, "s")
    newmark_beta = require_within("newmark_beta", newmark_beta, 0.0, 10.0)
    require_coulomb(coulomb)
    longest = max(case.duration for case in cases)
    require_size("the steps of this run", longest / timestep, "take a longer timestep, or steps that fit the motion")
    scenes, uplift = [wall_scene(case, contacts) for case in cases], Uplift.of(cases[0], contacts)
    warn_if_coarse(scenes[0], timestep)
    rows = pair_rows(scenes[0], timestep, newmark_beta)
    stride = stride_of(output_step, timestep)

    def one(case: Case, scene: Scene) -> Response | SimulationError:
        started = time.perf_counter()

        def judge(steps: Steps) -> Run:
            return Run(case, uplift, scene, steps, released=start is None)

        try:
            begin = scene.started if start is None else start
            run, settings = fixed(scene, begin, timestep, newmark_beta, rows, coulomb, judge)
        except SimulationError as error:
            return error
        warn_if_slid(run, contacts)
        if coulomb is not True:
            warn_if_lifted(scene, run.steps)
        response = run.response(None, stride, want_ledger, settings)
        warn_if_open(response, run, "take a shorter timestep")
        response.stats["wall_time"] = time.perf_counter() - started
        return response

    threads = min(len(cases), cpu_count() or 1)
    if threads == 1:
        return [one(case, scene) for case, scene in zip(cases, scenes, strict=True)]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(one, cases, scenes))


def _required_spacing(case: object, contacts: object, output_step: object, ledger: object) -> float | None:
    """The spacing of samples as a float [s]; TypeError or ValueError for arguments of a run that cannot be."""
    if isinstance(case, Contacts) and isinstance(contacts, Case):
        raise TypeError("case and contacts are swapped: simulate(case, contacts)")
    require_kind("case", case, Case)
    require_kind("contacts", contacts, Contacts)
    require_flag("ledger", ledger)
    assert isinstance(case, Case)
    return None if output_step is None else require_within("output_step", output_step, 1e-9, case.duration, "s")


def _required_state(start: object, case: Case) -> State:
    """A start as pose and velocity of one wall, which does not lie beyond its face."""
    pose, velocity = required_start(start, 1, case.effects)
    require_within("start, rotation", float(pose[0, 2]), -ON_ITS_FACE, ON_ITS_FACE, "rad")
    for name, value in zip(("x", "z", "rotation"), velocity[0].tolist(), strict=True):
        require_within(f"start, rate of {name}", value, -1e3, 1e3, "m/s or rad/s")
    for name, value in zip("xz", pose[0].tolist(), strict=False):
        require_within(f"start, {name}", value, -1e3, 1e3, "m")
    return pose, velocity
