"""Time integration: the loop that makes the explicit steps of a run."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from copy import deepcopy
from typing import NamedTuple

import numpy as np

from ..bars import Bar
from ..compiled import for_types_of
from ..quantities import warn_of
from ..rows import unsound
from ..scene.time_step import stepping_seconds
from .kinds.own import ERRORS_OF_LAWS, OwnLaws
from .kinds.own_links import OwnLinks
from .loop import Clock, advance
from .memory import Memory, remember
from .rows import MAY_BE_INFINITE
from .search.contact_search import ContactSearch
from .setup import Setup
from .step_length import STEPS_AHEAD, TimeGrid
from .supports import move_supports
from .system import Books, Samples, System
from .thread_pool import ThreadPool

FIRST_CALL = 100_000
"""Steps of a line that the first call of the compiled steps makes."""
CALL_TIME = 0.3
"""Time that later calls take [s]. The progress bar moves and Ctrl-C acts between them."""
LONG_RUN = 10.0
"""Time of the steps of a run from which on there is a warning [s]."""
STRONG_DASHPOTS = 10.0
"""Step that springs alone would allow over that with dashpots, from which on the warning names the dashpots [-]."""


class Integration(NamedTuple):
    """The end of a time integration: the system, the numbers of steps and samples, the memory for a run that goes on,
    and the number of threads, with the processor time of all but the caller's [s]."""

    system: System
    steps: int
    samples: int
    memory: Memory | None
    threads: int
    processor: float


def integrate(setup: Setup, books: Books, samples: Samples, grid: TimeGrid, threads: int | None = None) -> Integration:
    """Make the steps in some threads, see `ThreadPool`, with a progress bar where they take more than some seconds.

    Ctrl-C acts between two calls of the compiled steps. The number of steps of a call follows from the time of the
    last one.

    Raises:
        RuntimeError: where a row is not finite at the start, or the motion of a block is not after a call. No compiled
            loop gets such a row.
    """
    system, search, stop, memory = setup.system, setup.search, grid.last + 1, setup.memory
    clock = clock_at_start(setup, grid)
    ERRORS_OF_LAWS.clear()
    for table in system.links:
        table.look_ahead(STEPS_AHEAD if setup.step_length.links_look_ahead(grid.h) else 0.0)
    require_sound_rows(system)
    next_search, steps = 0 if memory is None else memory.until_search, advance
    steps_per_call, ended, memory = max(1, FIRST_CALL // max(1, len(system.lines))), False, None
    with Bar("explicit steps", "s", grid.end) as bar, ThreadPool(threads) as pool:
        while clock.step < stop and not ended:
            if clock.step == grid.last:
                memory = remember(setup.structure, system, clock, setup.moving_blocks)
                if search is not None:
                    memory = memory._replace(search=deepcopy(search.state), until_search=next_search - clock.step)
            if search is not None and clock.step == next_search:
                system, books, valid_steps = update_search(search, system, books, clock)
                next_search = clock.step + valid_steps
            begun = time.perf_counter()
            until_search, until_pause = next_search if search is not None else stop, clock.step + steps_per_call
            until_last = stop if clock.step == grid.last else grid.last
            clock = clock._replace(stop=min(until_last, until_search, until_pause))
            step, sample, ended = pool.run(steps, system, books, samples, clock)
            took = time.perf_counter() - begun
            steps_per_call = max(1, min(4 * steps_per_call, int((step - clock.step + 1) * CALL_TIME / took)))
            bar.to(step * clock.h)
            if steps is advance:  # what a search replaces has the same types
                steps = for_types_of(advance, system, books, samples, clock, pool.thread)
            clock = clock._replace(step=step, sample=sample)
            for body in unsound(system.bodies)[:1].tolist():
                moving = f"the motion of {setup.scene.bodies.names[body]}"
                raise breakdown(next(broken_laws(setup, system), moving), step * clock.h)
    return Integration(
        system=system,
        steps=clock.step,
        samples=clock.sample,
        memory=None if ended else memory,
        threads=pool.used,
        processor=pool.processor,
    )


def clock_at_start(setup: Setup, grid: TimeGrid) -> Clock:
    """The clock of a run before its first step."""
    memory = setup.memory
    standstill = (0.0,) * len(setup.system.axes)
    return Clock(
        h=grid.h,
        steps_per_sample=grid.steps_per_sample,
        stop=0,
        last=grid.last,
        ground_acceleration_before=standstill if memory is None else memory.ground_acceleration_before,
        end_rotation=setup.end_rotation,
        h_before=0.0 if memory is None else memory.h_before,
        steps_per_check=grid.steps_per_check,
        steps_ahead=STEPS_AHEAD if setup.step_length.looks_ahead(grid.h) else 0.0,
        mass_damping=setup.mass_damping,
        local_damping=setup.local_damping,
    )


def update_search(search: ContactSearch, system: System, books: Books, clock: Clock) -> tuple[System, Books, int]:
    """An update of the search, see `ContactSearch.update`. What is not finite there ends the run.

    Supports are where they are at the pose. The step that follows moves them there."""
    t, supports = clock.step * clock.h, system.supports
    at_pose = supports._replace(moved=supports.moved.copy(), moving=supports.moving.copy())
    move_supports(at_pose, t, clock.h if clock.step > 0 else clock.h_before)
    try:
        system, books, steps = search.update(system._replace(supports=at_pose), books, t, clock.h)
    except ArithmeticError as error:
        raise breakdown(str(error), t) from None
    return system._replace(supports=supports), books, steps


def broken_laws(setup: Setup, system: System) -> Iterator[str]:
    """Own laws that have answered a number that is not finite, with their joints and links."""
    contacts = setup.scene.contacts
    for law in system.laws:
        if isinstance(law, OwnLaws) and len(law.rows):
            springs = (
                np.isfinite(system.lines["k"]) & np.isfinite(system.lines["k_excess"]) & np.isfinite(system.lines["c"])
            )
            springs[unsound(law.rows, law.endless)] = False
            for joint in law.rows["joint"][~springs & (law.rows["address"] != 0)].tolist():
                yield f"the law {contacts.bonds[joint].name} of {contacts.joints[joint]}"
    for table, names in zip(system.links, setup.link_names, strict=True):
        if isinstance(table, OwnLinks):
            yield from (f"the law of {names[i]}" for i in unsound(table.rows, table.endless).tolist())


def breakdown(subject: str, t: float) -> RuntimeError:
    """The error of a run whose numbers are no longer finite at a time [s], with what an own law has raised."""
    failed = f"; a law raised {type(ERRORS_OF_LAWS[0]).__name__}: {ERRORS_OF_LAWS[0]}" if ERRORS_OF_LAWS else ""
    remedy = "its numbers are not finite; take a shorter timestep"
    return RuntimeError(f"{subject} breaks down by t = {t:.4g} s: {remedy}{failed}")


def require_sound_rows(system: System) -> None:
    """Raise a RuntimeError that names the rows of a system in which a number is not finite."""
    tables = [(name, getattr(system, name), MAY_BE_INFINITE) for name in ("bodies", "lines", "edges", "tangents")]
    tables += [(type(table).__name__, table.rows, table.endless) for table in (*system.laws, *system.links)]
    for name, table, endless in tables:
        if len(wrong := unsound(table, endless)):
            raise RuntimeError(
                f"the {name} {wrong[:5].tolist()} of the explicit steps have numbers that are not finite"
            )


def warn_if_long(setup: Setup, grid: TimeGrid) -> None:
    """Warn of dashpots that make steps many, where these take long."""
    lines, laws = setup.system.lines, [law.rows for law in setup.system.laws]
    sprung = bool(np.isfinite(lines["k_s"]).any())
    seconds = stepping_seconds(grid.last, len(lines), sprung=sprung, in_space=len(setup.system.axes) == 3)
    if seconds < LONG_RUN:
        return
    slowest = max(float((rows["c"] / np.maximum(rows["k"], 1e-300)).max(initial=0.0)) for rows in (lines, *laws))
    shorter = math.sqrt(1 + 2 * slowest / setup.step_length.limit)  # from h^2 K + 2 h C = 4 with C = c/k K
    if shorter > STRONG_DASHPOTS:
        warn_of(
            f"explicit steps would take some {seconds:.2g} s: {grid.last:.2g} steps of {grid.h:.2g} s on "
            f"{len(lines)} contact lines. The dashpots, c/k = {slowest:.2g} s, make each step {shorter:.2g} times "
            "shorter than the springs need: lower xi, or raise the frequency that it refers to",
        )
