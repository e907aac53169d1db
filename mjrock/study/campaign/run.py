"""The driver of a campaign: which tasks are pending, where they run, and what happens when a worker dies."""

from __future__ import annotations

import contextlib
import itertools
import signal
from collections import Counter, deque
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from pickle import PickleError
from queue import Empty, SimpleQueue
from threading import Thread

import numpy as np
from pebble import ProcessExpired

from .pool import CHUNK_SECONDS, QUIT
from .progress import CampaignProgress, WarningCounter
from .store import Store
from .task import VERSION, Refused, Row, Task, carry_out, column_names, failed_row, keyed

DEATHS = 2
"""A task during which this many worker processes have died is run alone."""
LOOK_EVERY = 0.1
"""Time between two looks for the row of a task that runs in this process [s]."""

Submit = Callable[[list[tuple[Task, Path | None]]], Future[list[Row]]]
"""Hands tasks over, and returns the future rows of the first of them."""


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

    def __init__(
        self, file: Store, progress: CampaignProgress, folder: Path | None, *, retry: bool, limit: float | None
    ) -> None:
        self.file, self.progress, self.folder, self.retry, self.limit = file, progress, folder, retry, limit
        self.statuses: Counter[str] = Counter()
        self.outcomes: Counter[str] = Counter()
        self.warned = WarningCounter()
        self.seconds = 0.0
        self.finished = 0
        self.skipped = 0
        self.asked = 0

    def pending(self, tasks: Iterable[Task]) -> Iterator[Job]:
        """The tasks that have no row yet, each once. One that cannot be run gets its row here."""
        statuses = self.file.statuses()
        partial = self._partial_histories()
        columns: tuple[str, ...] = ()
        labels: dict[str, dict[str, object]] = {}
        for position, asked in enumerate(tasks):
            self.asked += 1
            key, task = keyed(asked)
            if (first := labels.setdefault(key, dict(task.labels))) != task.labels:
                same = f"the case labelled {dict(task.labels)} is that labelled {first}"
                self.warned.add(f"{same}, whose row stands for both: they differ in labels alone", "same")
            history = None if self.folder is None else self.folder / f"{key}.npz"
            status = statuses.get(key)
            kept = status in ("failed", "taken") or history is None or history.exists()
            if status is not None and kept and not (self.retry and status == "failed"):
                self.skipped += 1
                continue
            statuses[key] = "taken"
            names = column_names(task)
            if names != columns:
                self.file.add_columns(names)
                columns = names
            for path in partial.pop(key, ()):
                path.unlink(missing_ok=True)
            job = Job(task, key, position, history)
            if isinstance(task, Refused):
                self.write([job], [{"status": "failed", "error": task.error, "seconds": 0.0}])
            else:
                yield job

    def _partial_histories(self) -> dict[str, list[Path]]:
        """What killed campaigns have left of time histories, by the key of the task."""
        partial: dict[str, list[Path]] = {}
        for path in self.folder.glob("*.npz.*.partial*") if self.folder is not None else ():
            partial.setdefault(path.name.partition(".")[0], []).append(path)
        return partial

    def write(self, jobs: Sequence[Job], rows: Sequence[Row]) -> None:
        """Write the rows of jobs and show how far the campaign is. What a worker has warned of is counted."""
        for text in (text for row in rows for text in row.pop("warned", ())):
            self.warned.add(text)
        self.file.add(
            [
                {"key": job.key, "position": job.position, "version": VERSION, **job.task.labels, **row}
                for job, row in zip(jobs, rows, strict=True)
            ]
        )
        self.finished += len(rows)
        self.seconds += sum(row["seconds"] for row in rows)
        self.statuses.update(row["status"] for row in rows)
        self.outcomes.update(str(row["outcome"]) for row in rows if row.get("outcome") is not None)
        self.progress.show(self.skipped, self.finished, self.statuses["failed"])

    def close(self) -> None:
        """Say what was warned of, and how the campaign ended."""
        self.progress.close(self.skipped, self.statuses, self.outcomes, self.warned.lines())

    def here(self, job: Job) -> None:
        """Run a job in a thread of this process.

        The main thread waits for the row, so that Ctrl-C reaches it also while compiled code runs.
        """
        rows: SimpleQueue[Row] = SimpleQueue()
        Thread(target=lambda: rows.put(carry_out(job.task, job.history)), daemon=True).start()
        while True:
            with contextlib.suppress(Empty):
                return self.write([job], [rows.get(timeout=LOOK_EVERY)])

    def across(self, pending: Iterator[Job], width: int, submit: Submit) -> None:
        """Run jobs in other processes, with twice as many chunks in flight as there are processes.

        What a chunk leaves undone runs again, task by task. So does a task whose process was killed: after DEATHS
        deaths alone, in case memory was short, and if its process dies again, it gets a row that says so.

        Args:
            pending: the jobs.
            width: how many processes there are.
            submit: hands a chunk over. A job that cannot be handed over gets a row with the error.

        Raises:
            BrokenExecutor: if no process can take a job any more.
        """
        again: deque[Job] = deque()
        flying: dict[Future[list[Row]], list[Job]] = {}
        try:
            while True:
                while len(flying) < 2 * width and (jobs := self.take(pending, again, flying.values())):
                    try:
                        flying[submit([(job.task, job.history) for job in jobs])] = jobs
                    except (PickleError, AttributeError, TypeError) as error:  # what pickle raises
                        again.extend(self.left(jobs, error))
                if not flying:
                    return
                done = wait(flying, return_when=FIRST_COMPLETED).done
                for future in [future for future in flying if future in done]:  # in the order of the tasks
                    jobs = flying.pop(future)
                    try:
                        rows = future.result()
                    except BrokenExecutor:
                        raise
                    except Exception as error:
                        again.extend(self.left(jobs, error))
                    else:
                        self.write(jobs[: len(rows)], rows)
                        again.extend(jobs[len(rows) :])
        finally:
            for future in flying:
                future.cancel()

    def take(self, pending: Iterator[Job], again: deque[Job], flying: Collection[Sequence[Job]]) -> list[Job]:
        """The jobs of the next chunk, none where one that is in flight, or the next one, has to run alone."""
        if any(job.deaths >= DEATHS for jobs in flying for job in jobs):
            return []
        if again:
            return [again.popleft()] if again[0].deaths < DEATHS or not flying else []
        return list(itertools.islice(pending, self.chunk()))

    def chunk(self) -> int:
        """How many jobs are about CHUNK_SECONDS of work; one where there is a time limit."""
        if self.limit is not None or not self.finished:
            return 1
        return int(np.clip(CHUNK_SECONDS * self.finished / max(self.seconds, 1e-9), 1, 64))

    def left(self, jobs: Sequence[Job], error: Exception) -> Sequence[Job]:
        """The jobs of a chunk without rows that are to be tried again, each alone. Others get their rows."""
        for job in jobs:
            for path in job.history.parent.glob(f"{job.history.name}.*.partial*") if job.history is not None else ():
                path.unlink(missing_ok=True)
        if len(jobs) > 1:
            return jobs
        (job,) = jobs
        if isinstance(error, ProcessExpired):
            return self.died(job, error.exitcode or 0)
        if isinstance(error, TimeoutError) and self.limit is not None:
            row = failed_row(TimeoutError(f"the case took longer than the time limit of {self.limit:g} s"))
            self.write(jobs, [row | {"seconds": self.limit}])
        elif isinstance(error, OSError):
            raise error
        else:
            self.write(jobs, [failed_row(error)])
        return ()

    def died(self, job: Job, exitcode: int) -> Sequence[Job]:
        """The job whose process has died, if it was killed and is to be tried again."""
        job.deaths += 1
        if exitcode < 0 and job.deaths <= DEATHS:
            return [job]
        if exitcode < 0:
            how = f"was killed by {signal.Signals(-exitcode).name}"
        else:
            cause = ", as after a fatal error of MuJoCo, which MUJOCO_LOG.TXT would hold" if exitcode == 1 else ""
            how = f"ended with exit status {exitcode % QUIT}{cause}"
        often = f", {job.deaths} times in all" if job.deaths > 1 else ""
        self.write([job], [failed_row(RuntimeError(f"its worker process {how}{often}"))])
        return ()
