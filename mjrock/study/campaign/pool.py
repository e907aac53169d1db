"""Worker processes of this machine, by `pebble`, which ends those whose task takes too long and replaces dead ones."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from multiprocessing import resource_tracker
from multiprocessing.context import SpawnContext, SpawnProcess
from multiprocessing.reduction import ForkingPickler
from pathlib import Path

from pebble import ProcessPool
from tqdm import tqdm

from ...interrupts import interrupts_held_back
from ...notice import collect_warnings
from .task import Row, Task, carry_out

CHUNK_SECONDS = 0.5
"""Work that a worker does before it hands over its rows [s]: long compared with the 1 ms of handing over, and short
enough to keep the progress bar moving."""
EXIT_FOR_ZERO = 256
"""Exit status that is given to a worker that ended with 0: `pebble` would take 0 for one that it has ended itself."""


class Workers:
    """Processes that carry out tasks, a list at a time. Leaving the `with` statement ends them at once.

    Args:
        count: how many.
        limit: how long one list may take [s], or None.
    """

    def __init__(self, count: int, limit: float | None) -> None:
        self.limit = limit
        _start_tracker()
        self.pool = ProcessPool(count, initializer=start_worker, context=_Context())

    def submit(self, tasks: Sequence[tuple[Task, Path | None]]) -> Future[list[Row]]:
        """The rows of the first tasks; raises whatever pickle does for a task that it cannot take."""
        content = pickle.dumps(list(tasks))
        with interrupts_held_back():  # the first call starts the processes, and one that is cut off would leave some
            rows: Future[list[Row]] = self.pool.schedule(serve, (content,), timeout=self.limit)
        return rows

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *error: object) -> None:
        self.pool.stop()  # type: ignore[no-untyped-call]
        self.pool.join()


class _Worker(SpawnProcess):
    """A worker process, which Ctrl-C does not reach: the campaign ends it."""

    dead = False

    def start(self) -> None:
        """Start it."""
        with _interrupts_blocked():
            super().start()

    def __getstate__(self) -> dict[str, object]:
        """What the new process reads first. The pipes and locks of the pool are opened in `run`."""
        return vars(self) | {"_args": bytes(ForkingPickler.dumps(vars(self)["_args"]))}

    def run(self) -> None:
        """Carry out tasks, unless the campaign has ended while this process started: its locks are gone then."""
        try:
            vars(self)["_args"] = pickle.loads(vars(self)["_args"])
        except FileNotFoundError:
            return
        super().run()

    def is_alive(self) -> bool:
        """Whether it runs: False from the second call after a death, when `pebble` has read which task it ended."""
        was_dead, self.dead = self.dead, not super().is_alive()
        return not (was_dead and self.dead)

    @property
    def exitcode(self) -> int | None:
        """Its exit status, see EXIT_FOR_ZERO."""
        code = super().exitcode
        return EXIT_FOR_ZERO if code == 0 else code


class _Context(SpawnContext):
    """Starts `_Worker` processes."""

    Process = _Worker


def _start_tracker() -> None:
    """Start the process of Python that removes the semaphores of a campaign that is killed. It does so in silence."""
    silence = "ignore:resource_tracker:UserWarning"
    sys.warnoptions.append(silence)
    try:
        resource_tracker.ensure_running()
    finally:
        sys.warnoptions.remove(silence)


@contextlib.contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Start processes to which Ctrl-C does not go, not even while they start."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    _start_tracker()  # it would unblock the signal as it starts
    blocked_before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked_before)


def start_worker() -> None:
    """What a worker process does first. It can then be ended at once, also while compiled code runs."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    os.environ["MJROCK_INTERPRET"] = "0"  # many runs: one worker compiles a loop, and the others wait for it
    tqdm.set_lock(threading.RLock())  # its own is a semaphore, which a process that is killed would leave behind
    if not sys.warnoptions:
        warnings.simplefilter("always", UserWarning)  # the campaign counts them
    threading.Thread(target=_end_with_the_campaign, daemon=True).start()


def _end_with_the_campaign() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def serve(content: bytes) -> list[Row]:
    """The rows of the first of the pickled tasks, as many as are carried out in CHUNK_SECONDS.

    Raises:
        PicklingError: if the tasks cannot be read here.
    """
    try:
        tasks = pickle.loads(content)
    except BaseException as error:
        raise pickle.PicklingError(f"{type(error).__name__}: {error}") from None
    rows: list[Row] = []
    end = time.monotonic() + CHUNK_SECONDS
    for task, history in tasks:
        warned: list[str] = []
        with collect_warnings(warned.append):
            row = carry_out(task, history)
        row["warned"] = warned
        rows.append(row)
        if time.monotonic() > end:
            break
    return rows
