"""The process that compiles while another one runs as plain Python, see `background_compilation`."""

from __future__ import annotations

import contextlib
import os
import pickle
import sys
import threading
import time
import warnings
from queue import SimpleQueue
from typing import Any

from .background_compilation import Run

ALLOWANCE = {"RLIMIT_CPU": 120, "RLIMIT_AS": 4 << 30, "RLIMIT_CORE": 0}
"""What this process may use: processor time [s], address space [bytes], size of a core dump [bytes]."""


def serve(grace_period: float) -> None:
    """Make the runs that standard input brings, with low priority, and store their loops.

    Args:
        grace_period: time to go on when standard input has ended [s].
    """
    limit()
    runs: SimpleQueue[bytes | None] = SimpleQueue()
    threading.Thread(target=_listen, args=(runs, grace_period), daemon=True).start()
    warnings.simplefilter("ignore")
    lock = lock_of_store()
    content = None if lock is None else runs.get()
    while content is not None:
        with contextlib.suppress(Exception):
            run: Run = pickle.loads(content)
            run.solver(**run.arguments)
        content = None if runs.empty() else runs.get()
    os._exit(0)  # the other thread reads standard input


def limit() -> None:
    """Take low priority, and no more than the `ALLOWANCE`."""
    if hasattr(os, "nice"):
        os.nice(10)
    with contextlib.suppress(ImportError):  # on Windows
        import resource

        for name, allowance in ALLOWANCE.items():
            with contextlib.suppress(ValueError, OSError):  # a smaller limit holds already
                resource.setrlimit(getattr(resource, name), (allowance, allowance))


def lock_of_store() -> Any:
    """The lock of the one process that compiles while others that share the store run as plain Python.

    None where another process has it, and where nothing can be stored.
    """
    from filelock import FileLock

    from .loop_cache import folder  # which imports numba

    with contextlib.suppress(OSError):
        folder().mkdir(parents=True, exist_ok=True)
        lock = FileLock(folder() / "compiler.lock")
        lock.acquire(blocking=False)
        return lock
    return None


def _listen(runs: SimpleQueue[bytes | None], grace_period: float) -> None:
    with contextlib.suppress(Exception):
        while True:
            runs.put(pickle.load(sys.stdin.buffer))
    runs.put(None)
    time.sleep(grace_period)
    os._exit(1)
