"""Cores on which a test runs."""

import os
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_core() -> Iterator[None]:
    """Threads that are started here share a core, where one that waits lets the others run at once.

    On cores that other tests use, too, each wait takes milliseconds. Tests in `tests/distinct/test_threads.py` have
    threads on several cores."""
    cores = os.sched_getaffinity(0) if hasattr(os, "sched_setaffinity") else set()
    if cores:
        os.sched_setaffinity(0, {min(cores)})
    try:
        yield
    finally:
        if cores:
            os.sched_setaffinity(0, cores)
