"""Worker processes of this machine: what each is doing, and since when."""

from __future__ import annotations

import contextlib
import math
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from pathlib import Path
from types import ModuleType
from typing import Any

from tqdm import tqdm

from .campaign_task import Row, Task, carry_out, failed_row
from .overheard import listening

FLUSH = 0.1
"""Time after which rows of a list of tasks are handed over while the next task runs [s]."""
GUARD = (
    "the worker processes die as they start: they import the script that calls the campaign; let it do so "
    'below `if __name__ == "__main__":`; or give workers=1 without a time limit'
)


class Worker:
    """A process that carries out tasks, a list at a time.

    `jobs` is for the campaign to note what the process has got and has not answered yet. `progress` is shared with the
    process. It holds how many tasks it has started, and when it started the last one, in the time of `time.monotonic`
    [s]; infinity if it is idle.

    Args:
        script: whether the process imports the script that calls the campaign. It has to if the tasks are made of what
            the script defines. The script then needs `if __name__ == "__main__":`.
    """

    def __init__(self, *, script: bool) -> None:
        context = multiprocessing.get_context("spawn")
        self.progress = context.RawArray("d", [0.0, math.inf])
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=serve, args=(theirs, self.progress))
        with _uninterrupted(), contextlib.nullcontext() if script else _unscripted():
            self.process.start()
        theirs.close()
        self.ready = False
        self.received = 0
        self.jobs: list[Any] = []

    def send(self, tasks: Sequence[tuple[Task, Path | None]]) -> None:
        """Hand over tasks to a process that is idle; raises whatever pickle does for a task that it cannot take."""
        content = pickle.dumps(list(tasks))
        with contextlib.suppress(BrokenPipeError, ConnectionError):  # its death shows when rows are received
            self.connection.send_bytes(content)

    def receive(self) -> list[Row] | Row | None:
        """New rows of the tasks that were sent, in order; one failed row if the list of tasks could not be read.

        None stands for the death of the process; one that died as it started raises a RuntimeError.
        """
        rows: list[Row] = []
        try:
            while self.connection.poll() or self.process.is_alive():
                message = self.connection.recv()
                if message is None:
                    self.ready = True
                elif isinstance(message, dict):
                    return message
                else:
                    rows += message
                    self.received += len(message)
                if not self.connection.poll():
                    return rows
        except (EOFError, OSError):
            pass
        if not self.ready:
            raise RuntimeError(GUARD)
        return rows or None  # rows come first; the death shows again at the next call

    @property
    def started(self) -> int:
        """How many of the tasks whose rows have not come yet have been started."""
        return int(self.progress[0]) - self.received

    @property
    def busy(self) -> float:
        """The time that the task in progress has taken so far [s]."""
        return max(time.monotonic() - float(self.progress[1]), 0.0)

    def end(self, patience: float) -> str:
        """Wait for the process [s], end it if it is still there, and say how it ended."""
        self.process.join(patience)
        self.process.kill()
        self.process.join()
        self.connection.close()
        code = self.process.exitcode or 0
        if code < 0:
            return f"was killed by {signal.Signals(-code).name}"
        cause = ", as after a fatal error of MuJoCo, which MUJOCO_LOG.TXT would hold" if code == 1 else ""
        return f"ended with exit status {code}{cause}"


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Start processes to which Ctrl-C does not go, not even while they start: this process ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # it would unblock the signal as it starts
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _unscripted() -> Iterator[None]:
    """Start processes that do not import the script: a module without a file stands for it meanwhile."""
    before = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = before


def serve(connection: Connection, progress: Any) -> None:
    """What a worker process does: carry out lists of tasks until the connection is closed, maybe while it starts."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    tqdm.set_lock(threading.RLock())  # its own is a semaphore, which a process that is killed would leave behind
    if not sys.warnoptions:
        warnings.simplefilter("always", UserWarning)  # the campaign counts them
    with contextlib.suppress(EOFError, OSError):  # what a task raises is in its row
        _serve(connection, progress)


def _serve(connection: Connection, progress: Any) -> None:
    rows: list[Row] = []
    lock = threading.Lock()

    def hand_over() -> None:
        with lock:
            if rows:
                connection.send(rows)
                rows.clear()

    connection.send(None)
    threading.Thread(target=_accompany, args=(hand_over,), daemon=True).start()
    while True:
        content = connection.recv_bytes()
        try:
            tasks = pickle.loads(content)
        except BaseException as error:
            connection.send(failed_row(error))
            continue
        for task, history in tasks:
            progress[0] += 1
            progress[1] = time.monotonic()
            warned: list[str] = []
            with listening(warned.append):
                row = carry_out(task, history)
            row["warned"] = warned
            with lock:
                rows.append(row)
        progress[1] = math.inf
        hand_over()


def _accompany(hand_over: Callable[[], None]) -> None:
    """Hand over rows also in the middle of a long task, and end with the campaign when it is killed."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    while parent.is_alive():
        with contextlib.suppress(OSError):  # the campaign has closed the connection
            hand_over()
        parent.join(FLUSH)
    os._exit(1)
