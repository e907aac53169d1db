"""Answers before the compiler is done: short runs as plain Python, while another process compiles their loops.

Where a loop is not stored yet, a run that is short as plain Python has its answer sooner than the compiler would be
done. The digits are the same. Meanwhile a process of low priority makes the same run compiled, which stores its loops,
if the machine has a second core. It finishes also when a short script has ended before it, so that the next start has
the loops. There is one such process for each store, and its time and memory are limited. It ends with its parent where
nobody would take what it stores or where it would hold something up, see `may_outlive`. Later calls take what is
stored. Once plain Python has taken as long in a process as compiling does, loops are compiled there and then.
MJROCK_INTERPRET=0 in the environment switches this off.
"""

from __future__ import annotations

import atexit
import contextlib
import importlib.util
import os
import pickle
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple, TypeVar

import numpy as np

from .machine import cores
from .notice import notice

Result = TypeVar("Result")
COMPILING = 20.0
"""Time that compiling the loops of a run in MuJoCo takes, of one core [s] (`scripts/measure/first_minute.py`)."""
MOST = 3
"""Processes that this one starts to compile. Another kind of scene needs another one."""
LEFT = 120.0
"""Time that a process goes on compiling when its parent has ended [s]."""
ENDING = ("PYTEST_CURRENT_TEST", "CI", "SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "JOB_ID")
"""Variables of environments that end or wait for all of their processes: tests, continuous integration, batch jobs."""


class NotStoredError(Exception):
    """A loop is not stored."""


class Run(NamedTuple):
    """A call of a solver, which another process can repeat."""

    solver: Callable[..., object]
    arguments: dict[str, object]


class _Process:
    """State of this process: time that plain Python has taken [s], the process that compiles, how many have been
    started, and how many have ended."""

    def __init__(self) -> None:
        self.taken = 0.0
        self.compiler: Compiler | None = None
        self.started = self.ended = 0


_process = _Process()
_run: ContextVar[Run | None] = ContextVar("run", default=None)


@contextlib.contextmanager
def first_answer(solver: Callable[..., object], **arguments: object) -> Iterator[None]:
    """Let loops that are not stored run as plain Python in this block, which is a call of a solver."""
    token = _run.set(Run(solver, arguments) if _is_wanted() else None)
    try:
        yield
    finally:
        _run.reset(token)


def compiles() -> bool:
    """Whether there is a compiler, and it is not switched off."""
    return os.environ.get("NUMBA_DISABLE_JIT", "0") == "0" and importlib.util.find_spec("numba") is not None


def _is_wanted() -> bool:
    return compiles() and os.environ.get("MJROCK_INTERPRET") != "0"


def expect(seconds: float) -> None:
    """Compile at once from here to the end of the block where plain Python would take too long [s]."""
    if _process.taken + seconds > COMPILING:
        _run.set(None)


def allowed(at_once: bool) -> bool:
    """Whether a loop that is not stored runs as plain Python here and now, unless it has to be compiled at once."""
    return not at_once and _run.get() is not None and _process.taken < COMPILING


def news() -> int:
    """A number that grows when another process may have stored something."""
    if _process.compiler is not None and _process.compiler.process.poll() is not None:
        _process.compiler, _process.ended = None, _process.ended + 1
    return _process.ended


def as_plain_python(function: Callable[..., Result], arguments: tuple[object, ...]) -> Result:
    """What a loop gives as plain Python. Its time counts, and another process compiles it."""
    begun = time.perf_counter()
    if (run := _run.get()) is not None:
        with contextlib.suppress(Exception):  # what cannot be handed over is compiled when plain Python has taken long
            _hand_over(run, function)
    try:
        with np.errstate(all="ignore"):  # compiled loops divide by zero without a word
            return function(*arguments)
    finally:
        _process.taken += time.perf_counter() - begun


def _hand_over(run: Run, function: Callable[..., object]) -> None:
    """Let another process make a run, for one of its loops, if there may be such a process."""
    may_start = _process.started < MOST and cores() > 1 and not hasattr(sys, "frozen")  # which would start the program
    if _process.compiler is None and may_start:
        _process.started += 1
        _process.compiler = Compiler()
    if _process.compiler is not None:
        _process.compiler.take(run, function)


def may_outlive() -> bool:
    """Whether a process may go on compiling when this one has ended.

    Not in a test, a batch job or continuous integration; not of a worker of another process; not where this process is
    the first of a container or is started by the first; and not where loops are stored in a temporary folder.
    """
    from multiprocessing import parent_process  # needed only where something is interpreted

    store = Path(os.environ.get("NUMBA_CACHE_DIR") or __file__).resolve()
    ends = any(name in os.environ for name in ENDING) or parent_process() is not None
    return not (ends or 1 in (os.getpid(), os.getppid()) or Path(tempfile.gettempdir()).resolve() in store.parents)


class Compiler:
    """A process that makes runs, compiled. Ctrl-C does not reach it."""

    def __init__(self) -> None:
        self.outlives = may_outlive()
        self._functions: set[Callable[..., object]] = set()
        self._run: Run | None = None
        self._runs: SimpleQueue[bytes | None] = SimpleQueue()
        command = f"from mjrock.compiler import serve; serve({LEFT if self.outlives else 0.0})"
        self.process: subprocess.Popen[bytes] = subprocess.Popen(
            [sys.executable, "-c", f"import sys; sys.path = {sys.path!r}; {command}"],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=os.environ | {"MJROCK_INTERPRET": "0", "OPENBLAS_NUM_THREADS": "1"},
            # on Windows a process group and a low priority, elsewhere a session of its own
            creationflags=0x4200 if sys.platform == "win32" else 0,
            start_new_session=sys.platform != "win32",
        )
        self._writer = threading.Thread(target=self._write, daemon=True)
        self._writer.start()
        atexit.register(self._finish_or_kill)

    def take(self, run: Run, function: Callable[..., object]) -> None:
        """Make a run, unless it or another one with this loop is made already."""
        if function not in self._functions and run is not self._run:
            self._runs.put(pickle.dumps(run))
            self._run = run
        self._functions.add(function)

    def _write(self) -> None:
        """Write runs as they come. When this process ends, the pipe closes."""
        assert self.process.stdin is not None
        with contextlib.suppress(OSError), self.process.stdin as pipe:  # the other process has ended
            for content in iter(self._runs.get, None):
                pickle.dump(content, pipe)
                pipe.flush()

    def _finish_or_kill(self) -> None:
        """Leave it to finish, if it may, or end it."""
        self._runs.put(None)
        self._writer.join(timeout=5.0)
        if self.process.poll() is None and self.outlives:
            self.process.returncode = 0  # so that Python does not warn that it is still running
            notice(
                f"process {self.process.pid} goes on compiling for at most {LEFT:.0f} s, at low priority; the next "
                "start takes what it stores. It can be ended without harm"
            )
        elif self.process.returncode is None:
            self.process.kill()
            self.process.wait()
