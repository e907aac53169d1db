"""Explicit steps: the contact law of a wall or of masonry by the scheme of distinct-element codes."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Any

import numpy as np
from tqdm import tqdm

from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import ON_ITS_FACE, require_flag, require_size, require_within
from ..result.response import Response, State
from ..result.start import required_start
from ..scene.of_case import course_of, require_case, scene_of
from .assembly import system_of
from .encounters import Encounters
from .limit import SHARE, SHARE_OF_A_WALL, longest_step
from .loop import Clock, advance
from .reading import Run, response_of
from .system import Books, Samples, System

AT_ONCE = 2e7
"""Steps of a line that are made before the progress bar moves and Ctrl-C is heard: about a second."""
LOOK = 5e-3
"""Longest time between two looks for blocks that meet others [s]."""


def solve_explicit(
    case: Case | MasonryCase,
    contacts: Contacts | None = None,
    timestep: float | None = None,
    *,
    output_step: float = 1e-3,
    ledger: bool = False,
    start: State | None = None,
) -> Response:
    """Rocking of a wall, or motion of masonry of many blocks, by explicit steps.

    The scheme is that of the distinct element method: symplectic Euler, a unilateral spring and dashpot along each
    normal, and along each face a spring of stiffness k_s with a Coulomb slider, or rigid friction where k_s is None
    (Cundall and Strack, Geotechnique 29, 1979, 47-65). It shares no kinematics and no time integration with MuJoCo.

    Args:
        case: the wall, its release, its sides; or masonry and what moves it.
        contacts: the interfaces of the wall; masonry has its own joints.
        timestep: length of a step [s]; None takes 0.4 of the longest stable one for masonry and 0.02 of it for a wall,
            whose impacts are read one by one, shortened to a whole share of the spacing of the samples.
        output_step: spacing of the returned samples [s]. A given timestep is kept, and the spacing is a whole number of
            steps.
        ledger: whether to account for every part of the energy.
        start: pose and velocity to start from instead of the release, the `end` of an earlier response. It does not go
            with ties that yield.

    Raises:
        ValueError: if the contacts do not fit the case, if the masonry does not stand, for a step that is not stable,
            or for a value outside its range.
        RuntimeError: if more energy appears than was there and was put in.
    """
    begun = time.perf_counter()
    require_case(case, contacts)
    require_flag("ledger", ledger)
    if timestep is not None:
        timestep = require_within("timestep", timestep, 1e-9, 1.0, "s")
    output_step = require_within("output_step", output_step, 1e-9, 1e3, "s")
    state = None if start is None else required_start(start, case)
    scene = scene_of(case, contacts)
    course = course_of(case, scene)
    if state is not None:
        course = replace(course, pose=state[0], velocity=state[1], released=False)
    masonry, supports = (case.masonry, case.supports) if isinstance(case, MasonryCase) else (None, ())
    system = system_of(scene, course, masonry, supports)
    limit = longest_step(system)
    spacing = min(output_step, course.duration)
    if isinstance(case, Case):
        spacing = min(spacing, 1e-3 / case.wall.p)  # peaks and impacts are read off the samples
    share = SHARE if isinstance(case, MasonryCase) else SHARE_OF_A_WALL
    h, every = steps_of(timestep, share * limit, limit, spacing)
    count = math.floor(course.duration / (h * every) * (1 + 1e-12)) + 1
    require_size("the samples of this answer", count * len(scene.names), "raise output_step or follow it for less")
    groups = tuple(dict.fromkeys(scene.group))
    encounters = None if masonry is None else Encounters(masonry, system, scene.group)
    columns = 2 + (len(scene.damper_names) + 2 * len(scene.tie_names) + len(groups) + 1 if ledger else 0)
    if ledger:
        require_size("the ledger of this answer", count * columns, "raise output_step, or leave the ledger out")
    books = Books.of(system, len(groups) + 1, 0 if encounters is None else len(encounters.room))
    samples = Samples.of(count, len(scene.names), columns)
    ends = ON_ITS_FACE if isinstance(case, Case) else math.inf
    stepping = time.perf_counter()
    system, steps, kept = follow(system, encounters, books, samples, Clock(0, h, every, 0, count, ends))
    took = time.perf_counter() - stepping
    stats: dict[str, Any] = {
        "steps": steps,
        "timestep": h,
        "stable_timestep": limit,
        "share": h / limit,
        "friction": "springs" if np.isfinite(system.lines["k_s"]).any() else "rigid",
        "stepping_time": took,
    }
    run = Run(case, contacts, scene, course, system, books, Samples(*(part[:kept] for part in samples)), h * every)
    response = response_of(run, ledger=ledger, stride=max(1, round(output_step / (h * every))), stats=stats)
    response.stats["wall_time"] = time.perf_counter() - begun
    return response


def steps_of(timestep: float | None, taken: float, limit: float, spacing: float) -> tuple[float, int]:
    """Length of a step [s], and how many lie between two samples.

    Raises:
        ValueError: for a step that is not stable.
    """
    if timestep is None:
        every = max(1, math.ceil(spacing / taken))
        return spacing / every, every
    if timestep > limit:
        raise ValueError(
            f"timestep = {timestep:.3g} s is not stable; the valid range is up to {limit:.3g} s, which the stiffest "
            "contacts and the strongest dashpots allow"
        )
    return timestep, max(1, round(spacing / timestep))


def follow(
    system: System, encounters: Encounters | None, books: Books, samples: Samples, clock: Clock
) -> tuple[System, int, int]:
    """Make the steps, with a progress bar where they take more than some seconds.

    Returns:
        The system at the end, how many steps it took, and of how many samples.
    """
    total, sample, ended = clock.rows, clock.every * clock.h, False
    with tqdm(total=total, desc="explicit", unit="sample", delay=3, disable=None, leave=False) as bar:
        while clock.row < total and not ended:
            rows = max(1, int(AT_ONCE / (clock.every * max(1, len(system.lines)))))
            if encounters is not None:
                rows = min(rows, max(1, int(LOOK / sample)))
                loose = encounters.loose(system)
                if loose.any():
                    system = encounters.looked_for(system, loose, rows * sample)
            step, row, ended = advance(system, books, samples, clock._replace(rows=min(rows, total - clock.row)))
            bar.update(row - clock.row)
            clock = clock._replace(step=step, row=row)
    return system, clock.step, clock.row
