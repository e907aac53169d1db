"""Processes that do the work of the form, a task at a time. A process without a waiting client is killed."""

from __future__ import annotations

import contextlib
import importlib
import multiprocessing
import os
import signal
import tempfile
import threading
import time
import traceback
from collections.abc import Callable, Generator, Mapping
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
from typing import Any, NamedTuple

from ..notice import notice

Payload = Mapping[str, Any]
"""What a task is to answer: an object of JSON that the page has sent."""
Item = dict[str, Any]
"""A part of an answer, such as how far a run is, or a verdict. What is under "keep" stays with the server as bytes."""
Parts = Generator[Item, None, None]
Send = Callable[[Item], None]
Task = Callable[[Payload, Send], None]
"""A function that answers a request in parts, each of which it sends."""
MOST_BUSY, MOST_IDLE = 4, 2
"""Most processes at work at once, and most that wait for work."""
CHILD_POLL_INTERVAL = 0.1
"""Time between two checks whether somebody still waits for the answer [s]."""


class BusyError(Exception):
    """All processes are at work."""


class EndedError(Exception):
    """A process has ended in the middle of a task."""


class Done(NamedTuple):
    """The end of an answer."""


def serve(pipe: Connection, module: str, folder: str) -> None:
    """Do the tasks of a module until the pipe closes or the process at its other end is gone.

    Ctrl-C ends that process alone, which then kills this one. Temporary files stand in a folder that goes with it.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    tempfile.tempdir = folder
    threading.Thread(target=_end_with_parent, daemon=True).start()
    tasks: Mapping[str, Task] = importlib.import_module(module).TASKS
    while True:
        try:
            name, request = pipe.recv()
        except EOFError:
            return
        try:
            if name not in tasks:
                raise ValueError(f"{name!r} is not one of {', '.join(tasks)}")
            tasks[name](request, pipe.send)
        except Exception as error:
            notice("".join(traceback.format_exception(error)), by="error")
            pipe.send({"error": f"{type(error).__name__}: {error}"})
        pipe.send(Done())


def _end_with_parent() -> None:
    """End this process at once when the one that started it is gone, however that ended."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)


class Worker:
    """A process that does tasks.

    Args:
        module: whose TASKS it can do. It is imported by that process alone.
    """

    def __init__(self, module: str) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, child_end = context.Pipe()
        self.folder = tempfile.TemporaryDirectory(prefix="mjrock-", ignore_cleanup_errors=True)
        self.process = context.Process(target=serve, args=(child_end, module, self.folder.name), daemon=True)
        self.process.start()
        child_end.close()

    def parts(self, name: str, request: Payload, is_disconnected: Callable[[], bool], limit: float) -> Parts:
        """The parts of an answer as they come.

        Args:
            name: of the task.
            request: what it is to answer.
            is_disconnected: whether nobody waits for the answer any more.
            limit: on the time of the task [s].

        Raises:
            ConnectionAbortedError: where nobody waits any more.
            TimeoutError: where it takes too long.
            EndedError: where the process ends by itself.
        """
        end = time.monotonic() + limit
        try:
            self.pipe.send((name, request))
            while True:
                while not self.pipe.poll(CHILD_POLL_INTERVAL):
                    if is_disconnected():
                        raise ConnectionAbortedError("nobody waits for the answer")
                    if time.monotonic() > end:
                        raise TimeoutError(f"this took longer than {limit:g} s and was ended")
                item = self.pipe.recv()
                if isinstance(item, Done):
                    return
                yield item
        except (EOFError, BrokenPipeError):
            raise EndedError("the process that computed this has ended, as it does where memory is short") from None

    def kill(self) -> None:
        """End the process at once."""
        self.process.kill()
        self.process.join()
        self.pipe.close()
        self.folder.cleanup()


class Team:
    """Workers: those at work, and those that wait for work. Close it to end them all.

    Args:
        module: whose TASKS they can do.
    """

    def __init__(self, module: str) -> None:
        self.module = module
        self._lock = threading.Lock()
        self._idle, self._busy = [Worker(module)], list[Worker]()
        self._closed = False

    def parts(self, name: str, request: Payload, is_disconnected: Callable[[], bool], limit: float) -> Parts:
        """The parts of an answer as they come, see `Worker.parts`. The process is killed if they do not all come.

        Raises:
            BusyError: where all workers are at work.
        """
        worker = self._take_worker()
        is_complete = False
        try:
            yield from worker.parts(name, request, is_disconnected, limit)
            is_complete = True
        finally:
            self._return_worker(worker, is_complete)

    def _take_worker(self) -> Worker:
        with self._lock:
            if self._closed or len(self._busy) >= MOST_BUSY:
                raise BusyError
            while self._idle:
                worker = self._idle.pop()
                if worker.process.is_alive():
                    break
                worker.kill()
            else:
                worker = Worker(self.module)
            self._busy.append(worker)
            return worker

    def _return_worker(self, worker: Worker, is_complete: bool) -> None:
        with self._lock:
            if worker in self._busy:  # and is not closed with the others
                self._busy.remove(worker)
            if is_complete and not self._closed and len(self._idle) < MOST_IDLE:
                self._idle.append(worker)
                return
        with contextlib.suppress(OSError):
            worker.kill()

    def close(self) -> None:
        """End all processes at once."""
        with self._lock:
            self._closed = True
            workers = self._idle + self._busy
            self._idle, self._busy = [], []
        for worker in workers:
            with contextlib.suppress(OSError):
                worker.kill()
