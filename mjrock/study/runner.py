"""The driver of a campaign: which tasks are pending, where they run, and what happens when a worker dies."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .batch import BATCH, batch_rows, geometry
from .fingerprint import fingerprint
from .store import Store
from .task import VERSION, Row, Task, carry_out_all, failed_row

CHUNK_SECONDS = 0.5
"""Work that a worker is given at a time [s]: long compared with the 1 ms of handing it over, and short enough to keep
the progress bar moving."""
START_UP = 2.5
"""Time that worker processes need to import what they use [s]."""
DEATHS = 2
"""A task that was in progress at this many deaths of workers is run alone."""


def processes(count: int) -> ProcessPoolExecutor:
    """Worker processes of this machine, which end when the campaign is killed."""
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(count, mp_context=context, initializer=_die_with_the_campaign)


def _await_worker(executor: Executor) -> None:
    """Wait until a worker answers, so that a death at start-up is not blamed on a case."""
    try:
        executor.submit(os.getpid).result()
    except BrokenExecutor as error:
        raise RuntimeError(
            "the worker processes die as they start: they import the script that calls the campaign; let it do so "
            'below `if __name__ == "__main__":`; or give workers=1'
        ) from error


def _die_with_the_campaign() -> None:
    """Make a worker end when its campaign is killed. It would wait for work for ever otherwise."""

    def watch() -> None:
        parent = multiprocessing.parent_process()
        assert parent is not None
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@dataclass
class Job:
    """A task that is to be run, and how often a worker has died while it was in progress."""

    task: Task
    key: str
    position: int
    history: Path | None
    deaths: int = 0


class Runner:
    """A running campaign: its store, its counts, and where its tasks are."""

    bar: Any

    def __init__(self, file: Store, folder: Path | None, retry: bool) -> None:
        self.file, self.folder, self.retry = file, folder, retry
        self.failed = 0
        self.seconds = 0.0
        self.finished = 0
        self.skipped = 0
        self.asked = 0

    def pending(self, tasks: Iterable[Task]) -> Iterator[Job]:
        """The tasks that have no row yet, each once."""
        statuses = self.file.statuses()
        columns: tuple[str, ...] = ()
        for position, task in enumerate(tasks):
            self.asked += 1
            key = fingerprint(VERSION, task)
            history = None if self.folder is None else self.folder / f"{key}.npz"
            status = statuses.get(key)
            kept = status == "failed" or history is None or history.exists()
            if status is not None and kept and not (self.retry and status == "failed"):
                self.skipped += 1
                continue
            statuses[key] = "taken"
            names = (*task.labels, *task.COLUMNS)
            if names != columns:
                self.file.add_columns(names)
                columns = names
            yield Job(task, key, position, history)

    def write(self, jobs: Sequence[Job], rows: Sequence[Row]) -> None:
        """Write the rows of jobs and show how far the campaign is."""
        self.file.add(
            [
                {"key": job.key, "position": job.position, "version": VERSION, **job.task.labels, **row}
                for job, row in zip(jobs, rows, strict=True)
            ]
        )
        self.finished += len(rows)
        self.seconds += sum(row["seconds"] for row in rows)
        self.failed += sum(row["status"] == "failed" for row in rows)
        if not self.bar.disable:
            self.bar.initial = self.skipped  # what was there already is no part of the rate
            self.bar.set_postfix_str(f"{self.failed} failed" if self.failed else "", refresh=False)
            self.bar.update(self.skipped + self.finished - self.bar.n)

    def by_threads(self, pending: Iterator[Job], threads: int, total: int | None) -> Iterator[Job]:
        """Run batches by threads while there are any and threads are faster; return the jobs that are left.

        Threads share the time that the engine takes for its steps. They do not share the time that Python takes. Each
        batch measures both. Processes would share both, but they have to start first.
        """
        while job := next(pending, None):
            batch, mark = [job], geometry(job.task)
            if mark is None:
                return itertools.chain(batch, pending)
            for job in pending:
                if len(batch) == BATCH * threads or geometry(job.task) != mark:
                    pending = itertools.chain([job], pending)
                    break
                batch.append(job)
            started = time.perf_counter()
            rows, stepping = batch_rows([(job.task, job.history) for job in batch])
            by_threads = (time.perf_counter() - started) / len(batch)
            self.write(batch, rows)
            by_processes = stepping + (by_threads - stepping) / threads
            left = (total or sys.maxsize) - self.skipped - self.finished
            if left * (by_threads - by_processes) > START_UP:
                break
        return pending

    def take(self, pending: Iterator[Job], again: deque[Job], flying: Iterable[list[Job]]) -> list[Job]:
        """The jobs of the next chunk, about CHUNK_SECONDS of work. Jobs that a dying worker had go one by one."""
        if any(jobs[0].deaths >= DEATHS for jobs in flying):
            return []
        if again:
            return [again.popleft()] if again[0].deaths < DEATHS or not flying else []
        size = int(np.clip(CHUNK_SECONDS * self.finished / max(self.seconds, 1e-9), 1, 64)) if self.finished else 1
        return list(itertools.islice(pending, size))

    def across(self, pending: Iterator[Job], make: Callable[[], Any], width: int, *, own: bool) -> None:
        """Run jobs on an executor, with twice as many chunks in flight as it has workers.

        If one of our own processes dies, all of them are replaced. The tasks that were in progress are run again, one
        at a time. A task that was in progress at DEATHS deaths runs alone. If its worker dies again, the row of the
        task says so.
        """
        again: deque[Job] = deque()
        ended = False
        while not ended:
            flying: dict[Future[list[Row]], list[Job]] = {}
            with make() as executor:
                if own:
                    _await_worker(executor)
                try:
                    while True:
                        while len(flying) < 2 * width and (jobs := self.take(pending, again, flying.values())):
                            again.extendleft(reversed(jobs))  # where they are safe if the executor is broken
                            future = executor.submit(carry_out_all, [(job.task, job.history) for job in jobs])
                            for _ in jobs:
                                again.popleft()
                            flying[future] = jobs
                        if ended := not flying:
                            break
                        for future in wait(flying, return_when=FIRST_COMPLETED).done:
                            self.collect(future, flying, again)
                except BrokenExecutor as error:
                    if not own:
                        raise RuntimeError(
                            f"the executor broke down: {error}; what is done is kept, and the same call carries on"
                        ) from error
                    for job in itertools.chain.from_iterable(flying.values()):
                        job.deaths += 1
                        if job.deaths > DEATHS:
                            self.write([job], [failed_row(error)])
                        else:
                            again.append(job)
                except BaseException:
                    for future in flying:
                        future.cancel()
                    raise

    def collect(self, future: Future[list[Row]], flying: dict[Future[list[Row]], list[Job]], again: deque[Job]) -> None:
        """Write the rows of a chunk. A chunk that the executor could not carry out runs again, task by task."""
        jobs = flying[future]
        try:
            rows = future.result()
        except BrokenExecutor:
            raise
        except Exception as error:
            if len(jobs) > 1:
                for job in jobs:
                    job.deaths = max(job.deaths, 1)
                again.extend(jobs)
            else:
                self.write(jobs, [failed_row(error)])
        else:
            self.write(jobs, rows)
        del flying[future]
