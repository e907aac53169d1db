"""Following a system by explicit steps: how long a step is, and the steps."""

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
HEARD = 0.3
"""Time that later calls take [s]. The progress bar moves and Ctrl-C acts between them."""
SECONDS_WORTH_SAYING = 10.0
"""Time of the steps of a run from which on there is a warning [s]."""
DASHPOTS_WORTH_SAYING = 10.0
"""Step that springs alone would allow over that with dashpots, from which on the warning names the dashpots [-]."""


class Stepping(NamedTuple):
    """The steps of a run.

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
    def of(cls, setup: Setup, timestep: float | None, output_step: float) -> Stepping:
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
        """Times of the checks of so many steps [s]."""
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


class Followed(NamedTuple):
    """What was followed: the system at the end, how many steps it took, of how many samples, what is remembered, and
    how many threads took part, with the processor time of all but the caller's [s]."""

    system: System
    steps: int
    samples: int
    memory: Memory | None
    threads: int
    processor: float


def follow(setup: Setup, books: Books, samples: Samples, stepping: Stepping, threads: int | None = None) -> Followed:
    """Make the steps in some threads, see `Crew`, with a progress bar where they take more than some seconds.

    Ctrl-C is heard between two calls of the compiled steps. How many a call makes goes by how long the last took.

    Raises:
        RuntimeError: where a row is not finite at the start, or the motion of a block is not after a call. No compiled
            loop gets such a row.
    """
    system, search, stop, memory = setup.system, setup.search, stepping.last + 1, setup.memory
    clock = Clock(
        0, stepping.h, stepping.every, 0, 0, stepping.last, setup.ends, 0.0, (0.0,) * len(system.axes), stepping.check
    )
    clock = clock._replace(lead=LEAD if setup.foresees(stepping.h) else 0.0)
    clock = clock._replace(drag=setup.drag, local=setup.local)
    for table in system.links:
        table.look_ahead(LEAD if stepping.h <= STABLE_AHEAD * setup.limit else 0.0)
    next_search, steps = 0, advance
    require_sound_rows(system)
    if memory is not None:
        clock, next_search = clock._replace(before=memory.before, pushed=memory.pushed), memory.until_search
    at_once, ended, memory = max(1, FIRST_CALL // max(1, len(system.lines))), False, None
    with Bar("explicit steps", "s", stepping.end) as bar, Crew(threads) as crew:
        while clock.step < stop and not ended:
            if clock.step == stepping.last:
                memory = remember(setup.of, system, clock, setup.blocks)
                if search is not None:
                    memory = memory._replace(search=deepcopy(search.state), until_search=next_search - clock.step)
            if search is not None and clock.step == next_search:
                system, books, valid = searched(search, system, books, clock)
                next_search = clock.step + valid
            begun = time.perf_counter()
            ahead = (next_search if search is not None else stop, clock.step + at_once)
            clock = clock._replace(stop=min(stop if clock.step == stepping.last else stepping.last, *ahead))
            step, row, ended = crew.run(steps, system, books, samples, clock)
            took = time.perf_counter() - begun
            at_once = max(1, min(4 * at_once, int((step - clock.step + 1) * HEARD / took)))
            bar.to(step * clock.h)
            if steps is advance:  # what a search replaces has the same types
                steps = for_types_of(advance, system, books, samples, clock, crew.team)
            clock = clock._replace(step=step, row=row)
            for body in unsound(system.bodies)[:1].tolist():
                moving = f"the motion of {setup.scene.bodies.names[body]}"
                raise breakdown(next(broken_laws(setup, system), moving), step * clock.h)
    return Followed(system, clock.step, clock.row, None if ended else memory, crew.used, crew.processor)


def searched(search: ContactSearch, system: System, books: Books, clock: Clock) -> tuple[System, Books, int]:
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


def warn_if_long(setup: Setup, stepping: Stepping) -> None:
    """Warn of dashpots that make steps many, where these take long."""
    lines, laws = setup.system.lines, [law.rows for law in setup.system.laws]
    sprung = bool(np.isfinite(lines["k_s"]).any())
    seconds = stepping_seconds(stepping.last, len(lines), sprung=sprung, in_space=len(setup.system.axes) == 3)
    if seconds < SECONDS_WORTH_SAYING:
        return
    slowest = max(float((of["c"] / np.maximum(of["k"], 1e-300)).max(initial=0.0)) for of in (lines, *laws))
    shorter = math.sqrt(1 + 2 * slowest / setup.limit)  # from h^2 K + 2 h C = 4 with C = c/k K
    if shorter > DASHPOTS_WORTH_SAYING:
        warn_of(
            f"explicit steps would take some {seconds:.2g} s: {stepping.last:.2g} steps of {stepping.h:.2g} s on "
            f"{len(lines)} contact lines. The dashpots, c/k = {slowest:.2g} s, make each step {shorter:.2g} times "
            "shorter than the springs need: lower xi, or raise the frequency that it refers to",
        )
