"""The threads that make the steps of a run: how many, and how they are started and waited for.

They are threads of Python that run a compiled loop, which needs no lock of the interpreter. They live for one run, so
that a fork meets none of them and two runs at once do not meet each other's.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from multiprocessing import parent_process
from types import TracebackType
from typing import Self

from ..compiled import Loop
from ..interrupts import interrupts_held_back
from ..machine import cores
from ..rows import Rows
from .loop import Clock
from .system import Books, Samples, System
from .thread import Thread

WORTH_THREADS = 1000
"""Lines from which on all cores take part where nothing else is given, see docs/cost.md."""
TRIED_AGAIN = 20
"""Calls from one with the slower number of threads to the next, which finds out whether it still is slower."""
SHORT_TRY = 8
"""How many times fewer steps such a call makes."""

Steps = Callable[[System, Books, Samples, Clock, Thread], tuple[int, int, bool]]
"""The compiled steps."""


def all_threads() -> int:
    """How many threads a large run takes: all cores of this process, one in a process that another one has started, and
    no more than NUMBA_NUM_THREADS in the environment."""
    cap = os.environ.get("NUMBA_NUM_THREADS", "")
    count = min(cores(), int(cap)) if cap.isdigit() and int(cap) > 0 else cores()
    return 1 if parent_process() is not None else count


class ThreadPool:
    """Threads that make the steps.

    Args:
        threads: how many, or None for the faster of one and all cores.

    `used` is the largest number that has made steps, and `processor` the processor time of all but the caller's [s].
    """

    def __init__(self, threads: int | None) -> None:
        self.threads, self.used, self.processor = threads, 1, 0.0
        self._most = all_threads() if threads is None else threads
        self._pool: ThreadPoolExecutor | None = None
        self._step_times: dict[int, float] = {}
        self._calls = 0
        self._shared: tuple[Rows, Books, tuple[Thread, ...]] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._pool is not None:
            self._pool.shutdown()

    @property
    def thread(self) -> Thread:
        """The thread that has made the last steps, or the first of them."""
        assert self._shared is not None
        return self._shared[2][0]

    def run(self, steps: Steps, system: System, books: Books, samples: Samples, clock: Clock) -> tuple[int, int, bool]:
        """Make the steps from that of the clock to its stop, with the number of threads that has been the fastest."""
        choices = (self._most,) if self.threads is not None else (self._most, 1)
        few = self.threads is None and len(system.lines) < WORTH_THREADS
        if few or len(system.tangents) or self._most == 1 or isinstance(steps, Loop):
            choices = (1,)  # sweeps over lines that stick rigidly take one after the other, and so does plain Python
        count, stop = self._choice(choices, clock)
        begun = time.perf_counter()
        if count > 1 and self._ready():
            result = self._run_together(count, steps, system, books, samples, clock._replace(stop=stop))
        else:
            shared, (alone,) = self._shared_by(1, system, books)
            result = steps(system, shared, samples, clock._replace(stop=stop), alone)
        if not isinstance(steps, Loop):  # which may have been compiled
            self._step_times[count] = (time.perf_counter() - begun) / max(1, result[0] - clock.step)
        return result

    def _choice(self, choices: tuple[int, ...], clock: Clock) -> tuple[int, int]:
        """How many threads take the next steps, and the step before which they stop: as many as were faster, and now
        and then the others, for a part of the steps."""
        self._calls += 1
        untried = [count for count in choices if count not in self._step_times]
        if len(choices) == 1 or untried:
            return (untried or choices)[0], clock.stop
        faster, slower = sorted(choices, key=self._step_times.__getitem__)
        if self._calls % TRIED_AGAIN:
            return faster, clock.stop
        return slower, clock.step + max(1, (clock.stop - clock.step) // SHORT_TRY)

    def _ready(self) -> bool:
        """Whether all threads are there. Where the machine gives no more, the run goes on with one."""
        if self._pool is None:
            self._pool, barrier = ThreadPoolExecutor(self._most, "mjrock"), threading.Barrier(self._most)
            try:
                with interrupts_held_back():
                    for started in [self._pool.submit(barrier.wait) for _ in range(self._most)]:
                        started.result()
            except RuntimeError:
                barrier.abort()
                self._most = 1
        return self._most > 1

    def _shared_by(self, count: int, system: System, books: Books) -> tuple[Books, tuple[Thread, ...]]:
        """The books of some threads and these, made anew where lines have come or gone."""
        if self._shared is None or len(self._shared[2]) != count or self._shared[0] is not system.lines:
            self._shared = system.lines, *books.of_threads(system, count)
        return self._shared[1:]

    def _run_together(
        self, count: int, steps: Steps, system: System, books: Books, samples: Samples, clock: Clock
    ) -> tuple[int, int, bool]:
        """The same steps by some threads. All of them start, or none: they wait for each other."""
        assert self._pool is not None
        self.used = max(self.used, count)
        shared, threads = self._shared_by(count, system, books)
        with interrupts_held_back():
            running: list[Future[tuple[tuple[int, int, bool], float]]] = [
                self._pool.submit(_timed, steps, system, shared, samples, clock, thread) for thread in threads
            ]
        results = [future.result() for future in running]
        self.processor += sum(spent for _, spent in results)
        return results[0][0]


def _timed(
    steps: Steps, system: System, books: Books, samples: Samples, clock: Clock, thread: Thread
) -> tuple[tuple[int, int, bool], float]:
    """The steps of one thread, and the processor time that they took [s]."""
    begun = time.thread_time()
    return steps(system, books, samples, clock, thread), time.thread_time() - begun
