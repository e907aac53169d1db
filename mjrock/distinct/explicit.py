"""Explicit steps: the contact law of a wall or of masonry by the scheme of distinct-element codes."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from ..problem.damping.contacts import Contacts
from ..problem.masonry.case import MasonryCase
from ..problem.wall.case import Case
from ..quantities import require_flag, require_size, require_within
from ..result.response import Response, State
from ..result.start import required_start
from ..scene.of_case import require_case
from .following import follow, steps_of
from .loop import Clock
from .reading import Run, response_of
from .setup import setup_of
from .system import Books, Samples


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
    setup = setup_of(case, contacts, state)
    scene, limit = setup.scene, setup.limit
    spacing = min(output_step, setup.course.duration, setup.spacing)
    h, every = steps_of(timestep, setup.share * limit, limit, spacing)
    count = math.floor(setup.course.duration / (h * every) * (1 + 1e-12)) + 1
    require_size(
        "the samples of this answer", count * len(scene.bodies.names), "raise output_step or follow it for less"
    )
    books = Books.of(
        setup.system, len(scene.contacts.joints) + 1, 0 if setup.encounters is None else setup.encounters.most
    )
    if ledger:
        require_size("the ledger of this answer", count * books.size, "raise output_step, or leave the ledger out")
    samples = Samples.of(count, len(scene.bodies.names), books, scene.freedom, ledger=ledger)
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
    samples = samples.taken(slice(kept))
    run = Run(case, contacts, scene, setup.course, system, books, samples, h * every)
    response = response_of(run, ledger=ledger, stride=max(1, round(output_step / (h * every))), stats=stats)
    response.stats["wall_time"] = time.perf_counter() - begun
    return response
