"""Explicit steps: the contact law of a wall or of masonry by the scheme of distinct-element codes."""

from __future__ import annotations

import math
import time
from typing import Any, TypeGuard

import numpy as np

from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import ON_ITS_FACE, require_flag, require_size, require_within
from ..result.response import Response, State
from ..result.start import required_start
from ..scene.explicit_step import SHARE
from ..scene.of_case import course_of, require_case, scene_of
from .assembly import system_of
from .encounters import Encounters
from .following import Setup, follow, steps_of
from .limit import longest_step
from .loop import Clock, advance
from .reading import Run, response_of
from .space.setup import setup_in_space
from .system import ALWAYS, Books, Samples

SHARE_OF_A_WALL = 0.005
"""Step that is taken for a wall, over the longest stable one [-]. A touch inside a step is met up to half a step late,
which scatters |e| of a wall against a stop by some 0.5 % with 0.02 and by 0.1 % with 0.005."""


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

    Masonry in space is stepped likewise, with its angular momentum and a quaternion for each block, see docs/space.md.
    Edges of blocks that cross do not meet there, which the message of the response says.

    Args:
        case: the wall, its release, its sides; or masonry and what moves it.
        contacts: the interfaces of the wall; masonry has its own joints.
        timestep: length of a step [s]; None takes 0.4 of the longest stable one for masonry and 0.005 of it for a wall,
            whose impacts are read one by one, shortened to a whole share of the spacing of the samples.
        output_step: spacing of the returned samples [s]. A given timestep is kept, and the spacing is a whole number of
            steps.
        ledger: whether to account for every part of the energy. A residual above 1 % of the largest part warns.
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
    setup = setup_in_space(case, state) if in_space(case) else setup_in_plane(case, contacts, state)
    scene, limit = setup.scene, setup.limit
    spacing = min(output_step, setup.course.duration, setup.spacing)
    h, every = steps_of(timestep, setup.share * limit, limit, spacing)
    count = math.floor(setup.course.duration / (h * every) * (1 + 1e-12)) + 1
    require_size("the samples of this answer", count * len(scene.names), "raise output_step or follow it for less")
    groups = tuple(dict.fromkeys(scene.group))
    columns = ALWAYS + (len(scene.damper_names) + 2 * len(scene.tie_names) + len(groups) + 1 if ledger else 0)
    if ledger:
        require_size("the ledger of this answer", count * columns, "raise output_step, or leave the ledger out")
    books = Books.of(setup.system, len(groups) + 1, 0 if setup.encounters is None else setup.encounters.most)
    samples = Samples.of(count, len(scene.names), columns, setup.freedom)
    stepping = time.perf_counter()
    system, steps, kept = follow(setup, books, samples, Clock(0, h, every, 0, count, setup.ends))
    took = time.perf_counter() - stepping
    stats: dict[str, Any] = {
        "steps": steps,
        "timestep": h,
        "stable_timestep": limit,
        "share": h / limit,
        "friction": "springs" if np.isfinite(system.lines["k_s"]).any() else "rigid",
        "stepping_time": took,
    }
    samples = Samples(*(part[:kept] for part in samples))
    run = Run(case, contacts, scene, setup.course, system, books, samples, h * every)
    response = response_of(run, ledger=ledger, stride=max(1, round(output_step / (h * every))), stats=stats)
    response.stats["wall_time"] = time.perf_counter() - begun
    return response


def setup_in_plane(case: Case | MasonryCase, contacts: Contacts | None, state: State | None) -> Setup:
    """A wall or masonry in the plane at its start."""
    scene = scene_of(case, contacts)
    course = course_of(case, scene)
    if state is not None:
        course = course.continued(*state)
    masonry, supports = (case.masonry, case.supports) if isinstance(case, MasonryCase) else (None, ())
    system = system_of(scene, course, masonry, supports)
    limit = longest_step(system)
    if masonry is None:
        assert isinstance(case, Case)
        # peaks and impacts are read off the samples
        return Setup(scene, course, system, advance, limit, SHARE_OF_A_WALL, 1e-3 / case.wall.p, ON_ITS_FACE)
    encounters = Encounters(masonry, system, scene.group)
    return Setup(scene, course, system, advance, limit, SHARE, encounters=encounters)


def in_space(case: Case | MasonryCase) -> TypeGuard[MasonryCase]:
    """Whether a case is one of masonry in space."""
    return isinstance(case, MasonryCase) and case.masonry.in_space
