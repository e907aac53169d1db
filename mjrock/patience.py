"""Answers before the compiler is done: short runs as plain Python, while another process compiles their loops.

Where a loop is not stored yet, a run that is short as plain Python has its answer sooner than the compiler would be
done. The digits are the same. Meanwhile a process of low priority makes the same run compiled, which stores its loops,
if the machine has a second core. It ends with its parent. Later calls take what is stored. Once plain Python has taken
as long in a process as compiling does, loops are compiled there and then. MJROCK_INTERPRET=0 in the environment
switches this off.
"""

from __future__ import annotations

import atexit
import contextlib
import importlib.util
import os
import pickle
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from typing import NamedTuple, TypeVar

import numpy as np

Result = TypeVar("Result")
COMPILING = 20.0
"""Time that compiling the loops of a run in MuJoCo takes, of one core [s] (`scripts/measure/first_minute.py`)."""
BEHIND = "behind"
"""Value of MJROCK_INTERPRET in a process that compiles for another one."""
MOST = 3
"""Processes that this one starts to compile. Another kind of scene needs another one."""


class NotStoredError(Exception):
    """A loop is not stored."""


class Run(NamedTuple):
    """A call of a solver, which another process can repeat."""

    solver: Callable[..., object]
    given: dict[str, object]


class _Process:
    """State of this process: time that plain Python has taken [s], the process that compiles, how many have been
    started, and how many have ended."""

    def __init__(self) -> None:
        self.taken = 0.0
        self.compiling: subprocess.Popen[bytes] | None = None
        self.started = self.ended = 0


_here = _Process()
_run: ContextVar[Run | None] = ContextVar("run", default=None)


@contextlib.contextmanager
def first_answer(solver: Callable[..., object], **given: object) -> Iterator[None]:
    """Let loops that are not stored run as plain Python in this block, which is a call of a solver."""
    token = _run.set(Run(solver, given) if _wanted() else None)
    try:
        yield
    finally:
        _run.reset(token)


def _wanted() -> bool:
    compiles = os.environ.get("NUMBA_DISABLE_JIT", "0") == "0" and importlib.util.find_spec("numba") is not None
    return compiles and os.environ.get("MJROCK_INTERPRET") not in ("0", BEHIND)


def expect(seconds: float) -> None:
    """Compile at once from here to the end of the block where plain Python would take too long [s]."""
    if _here.taken + seconds > COMPILING:
        _run.set(None)


def allowed(at_once: bool) -> bool:
    """Whether a loop that is not stored runs as plain Python here and now, unless it has to be compiled at once."""
    return not at_once and _run.get() is not None and _here.taken < COMPILING


def is_behind() -> bool:
    """Whether this process compiles for another one."""
    return os.environ.get("MJROCK_INTERPRET") == BEHIND


def news() -> int:
    """A number that grows when another process may have stored something."""
    if _here.compiling is not None and _here.compiling.poll() is not None:
        _here.compiling, _here.ended = None, _here.ended + 1
    return _here.ended


def as_plain_python(function: Callable[..., Result], arguments: tuple[object, ...]) -> Result:
    """What a loop gives as plain Python. Its time counts, and another process begins to compile."""
    run, begun = _run.get(), time.perf_counter()
    if run is not None and _here.compiling is None and _here.started < MOST and _cores() > 1:
        _here.started += 1
        with contextlib.suppress(Exception):  # what cannot be handed over is compiled when plain Python has taken long
            _here.compiling = _compiling(run)
    try:
        with np.errstate(all="ignore"):  # compiled loops divide by zero without a word
            return function(*arguments)
    finally:
        _here.taken += time.perf_counter() - begun


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _compiling(run: Run) -> subprocess.Popen[bytes]:
    """A process that makes a run, compiled. Ctrl-C does not reach it."""
    content = pickle.dumps(run)
    process: subprocess.Popen[bytes] = subprocess.Popen(
        [sys.executable, "-c", f"import sys; sys.path = {sys.path!r}; from {__name__} import behind; behind()"],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=os.environ | {"MJROCK_INTERPRET": BEHIND},
        # on Windows a process group and a low priority, elsewhere a session of its own
        creationflags=0x4200 if sys.platform == "win32" else 0,
        start_new_session=sys.platform != "win32",
    )
    atexit.register(_end, process)
    threading.Thread(target=_tell, args=(process, content), daemon=True).start()
    return process


def _tell(process: subprocess.Popen[bytes], content: bytes) -> None:
    assert process.stdin is not None
    with contextlib.suppress(OSError):  # it has ended
        process.stdin.write(content)
        process.stdin.flush()  # and stays open: the process ends when it closes


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()


def behind() -> None:
    """Make the run that standard input brings, with low priority, and store its loops. End with standard input."""
    if hasattr(os, "nice"):
        os.nice(10)
    run: Run = pickle.load(sys.stdin.buffer)
    threading.Thread(target=_end_with_the_parent, daemon=True).start()
    warnings.simplefilter("ignore")
    run.solver(**run.given)


def _end_with_the_parent() -> None:
    sys.stdin.buffer.read()
    os._exit(1)
