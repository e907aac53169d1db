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
from ..scene.time_step import stepping_seconds
from .kinds.own import OwnLaws
from .kinds.own_links import OwnLinks
from .loop import Clock, advance
from .memory import Memory, remember
from .rows import MAY_BE_INFINITE, unsound
from .search.contact_search import ContactSearch
from .setup import Setup
from .step_length import LEAD, TimeGrid
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
    clock = Clock(0, grid.h, grid.every, 0, 0, grid.last, setup.ends, 0.0, (0.0,) * len(system.axes), grid.check)
    clock = clock._replace(lead=LEAD if setup.step_length.looks_ahead(grid.h) else 0.0)
    clock = clock._replace(drag=setup.drag, local=setup.local)
    for table in system.links:
        table.look_ahead(LEAD if setup.step_length.links_look_ahead(grid.h) else 0.0)
    next_search, steps = 0, advance
    require_sound_rows(system)
    if memory is not None:
        clock, next_search = clock._replace(before=memory.before, pushed=memory.pushed), memory.until_search
    at_once, ended, memory = max(1, FIRST_CALL // max(1, len(system.lines))), False, None
    with Bar("explicit steps", "s", grid.end) as bar, ThreadPool(threads) as pool:
        while clock.step < stop and not ended:
            if clock.step == grid.last:
                memory = remember(setup.structure, system, clock, setup.blocks)
                if search is not None:
                    memory = memory._replace(search=deepcopy(search.state), until_search=next_search - clock.step)
            if search is not None and clock.step == next_search:
                system, books, valid = update_search(search, system, books, clock)
                next_search = clock.step + valid
            begun = time.perf_counter()
            ahead = (next_search if search is not None else stop, clock.step + at_once)
            clock = clock._replace(stop=min(stop if clock.step == grid.last else grid.last, *ahead))
            step, row, ended = pool.run(steps, system, books, samples, clock)
            took = time.perf_counter() - begun
            at_once = max(1, min(4 * at_once, int((step - clock.step + 1) * CALL_TIME / took)))
            bar.to(step * clock.h)
            if steps is advance:  # what a search replaces has the same types
                steps = for_types_of(advance, system, books, samples, clock, pool.thread)
            clock = clock._replace(step=step, row=row)
            for body in unsound(system.bodies)[:1].tolist():
                moving = f"the motion of {setup.scene.bodies.names[body]}"
                raise breakdown(next(broken_laws(setup, system), moving), step * clock.h)
    return Integration(system, clock.step, clock.row, None if ended else memory, pool.used, pool.processor)


def update_search(search: ContactSearch, system: System, books: Books, clock: Clock) -> tuple[System, Books, int]:
    """An update of the search, see `ContactSearch.update`. What is not finite there ends the run.

    Supports are where they are at the pose. The step that follows moves them there."""
    t, supports = clock.step * clock.h, system.supports
    there = supports._replace(moved=supports.moved.copy(), moving=supports.moving.copy())
    move_supports(there, t, clock.h if clock.step > 0 else clock.before)
    try:
        system, books, steps = search.update(system._replace(supports=there), books, t, clock.h)
    except ArithmeticError as error:
        raise breakdown(str(error), t) from None
    return system._replace(supports=supports), books, steps


def broken_laws(setup: Setup, system: System) -> Iterator[str]:
    """Own laws that have answered a number that is not finite, with their joints and links."""
    contacts = setup.scene.contacts
    for law in system.laws:
        if isinstance(law, OwnLaws) and len(law.rows):
            springs = (
                np.isfinite(system.lines["k"]) & np.isfinite(system.lines["bent"]) & np.isfinite(system.lines["c"])
            )
            springs[unsound(law.rows, law.endless)] = False
            for joint in law.rows["joint"][~springs & (law.rows["address"] != 0)].tolist():
                yield f"the law {contacts.bonds[joint].name} of {contacts.joints[joint]}"
    for table, names in zip(system.links, setup.names, strict=True):
        if isinstance(table, OwnLinks):
            yield from (f"the law of {names[i]}" for i in unsound(table.rows, table.endless).tolist())


def breakdown(what: str, t: float) -> RuntimeError:
    """The error of a run whose numbers are finite no longer at a time [s]."""
    return RuntimeError(f"{what} breaks down by t = {t:.4g} s: its numbers are not finite; take a shorter timestep")


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
    slowest = max(float((of["c"] / np.maximum(of["k"], 1e-300)).max(initial=0.0)) for of in (lines, *laws))
    shorter = math.sqrt(1 + 2 * slowest / setup.step_length.limit)  # from h^2 K + 2 h C = 4 with C = c/k K
    if shorter > STRONG_DASHPOTS:
        warn_of(
            f"explicit steps would take some {seconds:.2g} s: {grid.last:.2g} steps of {grid.h:.2g} s on "
            f"{len(lines)} contact lines. The dashpots, c/k = {slowest:.2g} s, make each step {shorter:.2g} times "
            "shorter than the springs need: lower xi, or raise the frequency that it refers to",
        )
