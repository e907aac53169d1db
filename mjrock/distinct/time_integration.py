"""The explicit steps of a run: when they are made, and the loop that makes them."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from copy import deepcopy
from typing import NamedTuple

import numpy as np

from ..bars import Bar
from ..compiled import for_types_of
from ..quantities import Array, warn_of
from ..result.motion import intervals
from ..scene.explicit_step import stepping_seconds
from .crew import Crew
from .kinds.own import OwnLaws
from .kinds.own_links import OwnLinks
from .limit import LEAD, STABLE_AHEAD
from .loop import Clock, advance
from .memory import Memory, remember
from .rows import MAY_BE_INFINITE, unsound
from .search.contact_search import ContactSearch
from .setup import Setup
from .supports import move_supports
from .system import Books, Samples, System

CHECKED_EVERY, MOST_CHECKS = 100, 1_000_000
"""Steps from one check of the energy to the next, and most checks."""
FIRST_CALL = 100_000
"""Steps of a line that the first call of the compiled steps makes."""
CALL_TIME = 0.3
"""Time that later calls take [s]. The progress bar moves and Ctrl-C acts between them."""
LONG_RUN = 10.0
"""Time of the steps of a run from which on there is a warning [s]."""
STRONG_DASHPOTS = 10.0
"""Step that springs alone would allow over that with dashpots, from which on the warning names the dashpots [-]."""


class TimeGrid(NamedTuple):
    """When the steps of a run are made, and which of them are sampled.

    Args:
        h: length of a step [s].
        every: steps from one sample to the next.
        stride: samples from one that is returned to the next.
        last: number of the last step, of which there is a sample too.
        end: when it is made [s].
    """

    h: float
    every: int
    stride: int
    last: int
    end: float

    @classmethod
    def of(cls, setup: Setup, timestep: float | None, output_step: float) -> TimeGrid:
        """Steps that end with the duration: in equal parts of it no longer than `output_step`.

        A given step is kept, and the run ends with the one that is nearest to the duration.

        Raises:
            ValueError: if the given step is not stable.
        """
        duration = setup.course.duration
        if timestep is None:
            count = intervals(duration, output_step)
            parts = intervals(duration / count, setup.spacing)
            every = intervals(duration / (count * parts), setup.share * setup.limit)
            last = count * parts * every
            return cls(duration / last, every, parts, last, duration)
        if timestep > setup.limit:
            raise ValueError(
                f"timestep = {timestep:.3g} s is not stable; the valid range is up to {setup.limit:.3g} s, which the "
                "stiffest contacts and the strongest dashpots allow"
            )
        steps, last = max(1, round(output_step / timestep)), max(1, round(duration / timestep))
        every = steps // min(steps, intervals(steps * timestep, setup.spacing))
        return cls(timestep, every, round(steps / every), last, last * timestep)

    @property
    def check(self) -> int:
        """Steps from one check of the energy to the next."""
        return max(CHECKED_EVERY, -(-self.last // MOST_CHECKS))

    def checks(self, steps: int) -> Array:
        """Times of the checks of a number of steps [s]."""
        count = steps // self.check + 1 if steps <= self.last else -(-self.last // self.check) + 1
        return self.h * np.minimum(self.check * np.arange(count), self.last)

    @property
    def samples(self) -> int:
        """How many samples there are."""
        return -(-self.last // self.every) + 1

    def times(self) -> Array:
        """Times of the samples [s], shape (samples,)."""
        t = self.h * self.every * np.arange(self.samples)
        t[-1] = self.end
        return np.asarray(t)


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
    """Make the steps in some threads, see `Crew`, with a progress bar where they take more than some seconds.

    Ctrl-C acts between two calls of the compiled steps. The number of steps of a call follows from the time of the
    last one.

    Raises:
        RuntimeError: where a row is not finite at the start, or the motion of a block is not after a call. No compiled
            loop gets such a row.
    """
    system, search, stop, memory = setup.system, setup.search, grid.last + 1, setup.memory
    clock = Clock(0, grid.h, grid.every, 0, 0, grid.last, setup.ends, 0.0, (0.0,) * len(system.axes), grid.check)
    clock = clock._replace(lead=LEAD if setup.looks_ahead(grid.h) else 0.0)
    clock = clock._replace(drag=setup.drag, local=setup.local)
    for table in system.links:
        table.look_ahead(LEAD if grid.h <= STABLE_AHEAD * setup.limit else 0.0)
    next_search, steps = 0, advance
    require_sound_rows(system)
    if memory is not None:
        clock, next_search = clock._replace(before=memory.before, pushed=memory.pushed), memory.until_search
    at_once, ended, memory = max(1, FIRST_CALL // max(1, len(system.lines))), False, None
    with Bar("explicit steps", "s", grid.end) as bar, Crew(threads) as crew:
        while clock.step < stop and not ended:
            if clock.step == grid.last:
                memory = remember(setup.of, system, clock, setup.blocks)
                if search is not None:
                    memory = memory._replace(search=deepcopy(search.state), until_search=next_search - clock.step)
            if search is not None and clock.step == next_search:
                system, books, valid = update_search(search, system, books, clock)
                next_search = clock.step + valid
            begun = time.perf_counter()
            ahead = (next_search if search is not None else stop, clock.step + at_once)
            clock = clock._replace(stop=min(stop if clock.step == grid.last else grid.last, *ahead))
            step, row, ended = crew.run(steps, system, books, samples, clock)
            took = time.perf_counter() - begun
            at_once = max(1, min(4 * at_once, int((step - clock.step + 1) * CALL_TIME / took)))
            bar.to(step * clock.h)
            if steps is advance:  # what a search replaces has the same types
                steps = for_types_of(advance, system, books, samples, clock, crew.team)
            clock = clock._replace(step=step, row=row)
            for body in unsound(system.bodies)[:1].tolist():
                moving = f"the motion of {setup.scene.bodies.names[body]}"
                raise breakdown(next(broken_laws(setup, system), moving), step * clock.h)
    return Integration(system, clock.step, clock.row, None if ended else memory, crew.used, crew.processor)


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
    tables = [(name, getattr(system, name), MAY_BE_INFINITE) for name in ("bodies", "lines", "edges", "ways")]
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
    shorter = math.sqrt(1 + 2 * slowest / setup.limit)  # from h^2 K + 2 h C = 4 with C = c/k K
    if shorter > STRONG_DASHPOTS:
        warn_of(
            f"explicit steps would take some {seconds:.2g} s: {grid.last:.2g} steps of {grid.h:.2g} s on "
            f"{len(lines)} contact lines. The dashpots, c/k = {slowest:.2g} s, make each step {shorter:.2g} times "
            "shorter than the springs need: lower xi, or raise the frequency that it refers to",
        )
