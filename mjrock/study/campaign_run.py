"""The driver of a campaign: which tasks are pending, where they run, and what happens when a worker dies."""

from __future__ import annotations

import contextlib
import itertools
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

import numpy as np

from .campaign_task import VERSION, Refused, Row, Task, carry_out, carry_out_all, column_names, failed_row, keyed
from .campaign_worker import FLUSH
from .overheard import Overheard
from .progress import Progress
from .store import Store

CHUNK_SECONDS = 0.5
"""Work that a worker is given at a time [s]: long compared with the 1 ms of handing it over, and short enough to keep
the progress bar moving."""


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

    def __init__(self, file: Store, progress: Progress, folder: Path | None, retry: bool) -> None:
        self.file, self.progress, self.folder, self.retry = file, progress, folder, retry
        self.statuses: Counter[str] = Counter()
        self.outcomes: Counter[str] = Counter()
        self.warned = Overheard()
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

    def here(self, job: Job, reason: object) -> None:
        """Run a job that can go to no other process, for a reason that the user is told, in a thread of this one.

        The main thread waits for the row, so that Ctrl-C reaches it also while compiled code runs.
        """
        self.progress.note(f"tasks that no other process can take run in this one, which may die of them: {reason}")
        rows: SimpleQueue[Row] = SimpleQueue()
        Thread(target=lambda: rows.put(carry_out(job.task, job.history)), daemon=True).start()
        while True:
            with contextlib.suppress(Empty):
                return self.write([job], [rows.get(timeout=FLUSH)])

    def chunk(self) -> int:
        """How many jobs are about CHUNK_SECONDS of work."""
        return int(np.clip(CHUNK_SECONDS * self.finished / max(self.seconds, 1e-9), 1, 64)) if self.finished else 1

    def across(self, pending: Iterator[Job], executor: Executor, width: int) -> None:
        """Run jobs on an executor, with twice as many chunks in flight as it has workers.

        A chunk that the executor could not carry out runs again, task by task.
        """
        again: deque[Job] = deque()
        flying: dict[Future[list[Row]], list[Job]] = {}
        try:
            while True:
                while len(flying) < 2 * width:
                    jobs = [again.popleft()] if again else list(itertools.islice(pending, self.chunk()))
                    if not jobs:
                        break
                    flying[executor.submit(carry_out_all, [(job.task, job.history) for job in jobs])] = jobs
                if not flying:
                    return
                for future in wait(flying, return_when=FIRST_COMPLETED).done:
                    jobs = flying.pop(future)
                    try:
                        self.write(jobs, future.result())
                    except (BrokenExecutor, OSError):
                        raise
                    except Exception as error:
                        again.extend(self.singly(jobs, error))
        except BaseException as error:
            for future in flying:
                future.cancel()
            if isinstance(error, BrokenExecutor):
                raise RuntimeError(
                    f"the executor broke down: {error}; what is done is kept, and the same call carries on"
                ) from error
            raise

    def singly(self, jobs: Sequence[Job], error: Exception) -> Sequence[Job]:
        """The jobs of a chunk that could not be handed over, each of which is to be tried alone.

        One that was alone already gets a row with the error.
        """
        if len(jobs) > 1:
            return jobs
        self.write(jobs, [failed_row(error)])
        return ()
