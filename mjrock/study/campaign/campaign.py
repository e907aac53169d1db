"""Many cases, headless: any solver, any executor, one row a case in a file that a killed campaign carries on from."""

from __future__ import annotations

import contextlib
import signal
import warnings
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path
from pickle import PickleError
from queue import Empty, SimpleQueue
from threading import Thread
from typing import TypedDict, Unpack, cast

from pebble import ProcessExpired

from ...machine import cores
from ...notice import collect_warnings
from ...quantities import is_iterable, require_flag, require_path, require_real, require_whole, shown
from .pool import CHUNK_SECONDS, EXIT_FOR_ZERO, Workers
from .progress import CampaignProgress
from .store import Store
from .task import RefusedTask, Row, Task, carry_out_all, column_names, failed_row, keyed, programs

MOST_WORKERS = 10_000
"""Most processes of a campaign."""
MOST_DEATHS = 2
"""A task during which this many worker processes have died is run alone."""
POLL_INTERVAL = 0.1
"""Time between two looks for the rows of tasks that run in this process [s]."""
MAIN_GUARD = (
    "the worker processes die as they start: they import the script that calls the campaign; let it do so "
    'below `if __name__ == "__main__":`; or give workers=1 without a time limit'
)

Submit = Callable[[list[tuple[Task, Path | None]]], Future[list[Row]]]
"""Hands tasks over, and returns the future rows of the first of them."""


class CampaignOptions(TypedDict, total=False):
    """The options of `campaign`."""

    executor: Executor | None
    workers: int | None
    histories: str | Path | None
    retry: bool
    time_limit: float | None


def campaign(
    tasks: Iterable[Task],
    store: str | Path,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    histories: str | Path | None = None,
    retry: bool = False,
    time_limit: float | None = None,
) -> Path:
    """Run every task that the store does not hold yet, and write a row for each.

    Killing a campaign loses only the cases in progress, and the rows of about the last half second. The same call
    carries on from there and does nothing twice that has a row. Warnings that differ in their numbers alone are shown
    once, and the last lines say how often each came. Tasks of the same content and other labels share a row, and a line
    says so. A task that fails becomes a row with its error, and so does one that calls `sys.exit`, ends its process, or
    cannot be built, pickled or labelled. The rows do not depend on the order in which tasks finish. Without a terminal
    a line every 30 s says how far the campaign is. A last line says how many tasks are done, failed and left and how
    they ended; `mjrock status walls.sqlite` says it later.

    Args:
        tasks: `Analysis` objects, a `Grid` of them, or an iterator; they are taken as they are needed.
        store: the SQLite file.
        executor: any executor of `concurrent.futures`, such as Dask's `client.get_executor()`; it is not shut down.
            None stands for processes of this machine, which are replaced if they die.
        workers: how many processes, 1 to 10000; None takes one for each core that this process may use. They import the
            script that calls the campaign, which needs `if __name__ == "__main__":`. With workers=1 and no time limit
            tasks run in this process, which a task that ends its process then ends.
        histories: a folder, made where there is none, for the time history of each case, `<key>.npz`.
        retry: whether tasks that have failed before are run again.
        time_limit: how long a case may take [s]; one that takes longer is ended and becomes a failed row that says so.
            It is for processes of this machine.

    Returns:
        The path of the store, for `Store(path)`.

    Raises:
        TypeError: for an argument of another type.
        ValueError: if the file is not a store or is damaged, `workers` or `time_limit` is not positive, a time limit is
            given with an executor, or the name of a label is that of a column or of another label, up to upper and
            lower case. A label that repeats a column, as `solver` does, does not clash. For a list, and for a `Grid`,
            this is found before anything runs.
        OSError: if the disk is full, or another process writes to the store.
        RuntimeError: if the executor given has broken down, or worker processes die as they start.
        KeyboardInterrupt: at Ctrl-C, once the worker processes have been ended; it says how many rows are kept.
    """
    path, tasks = require_path("store", store), required_tasks(tasks)
    count = cores() if workers is None else require_whole("workers", workers, 1, MOST_WORKERS)
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"executor = {shown(executor)} is not an executor of concurrent.futures")
    limit = None if time_limit is None else _required_limit(time_limit, executor)
    retry = require_flag("retry", retry)
    folder = None if histories is None else require_path("histories", histories)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    total = len(tasks) if isinstance(tasks, Sequence) else None
    with Store(path, writing=True) as file, CampaignProgress(file.path, len(file), total) as progress:
        keyed_tasks: Iterable[tuple[str, Task]] = map(keyed, tasks)
        if isinstance(tasks, list | tuple):
            keyed_tasks = list(keyed_tasks)
            for names in dict.fromkeys(column_names(task) for _, task in keyed_tasks):
                file.add_columns(names)
        run = Runner(file, progress, folder, retry=retry, limit=limit)
        try:
            with collect_warnings(progress.warned.add):
                _carry_out(run, run.pending(keyed_tasks), executor, count)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                f"{file.path}: {len(file)} rows are kept, and the same call carries on from there"
            ) from None
        finally:
            progress.close()
        if total is not None and run.seen != total:
            raise RuntimeError(f"the tasks ended after {run.seen} of {total}; the same call carries on from there")
    return path


def _required_limit(limit: float, executor: Executor | None) -> float:
    """A time limit [s]."""
    limit = require_real("time_limit", limit)
    if not limit > 0:
        raise ValueError(f"time_limit = {limit} s is outside the valid range, which is above 0")
    if executor is not None:
        raise ValueError(f"time_limit = {limit} s needs processes of this machine, and executor gives others")
    return limit


def required_tasks(tasks: object) -> Iterable[Task]:
    """Tasks as something that can be gone through.

    Raises:
        TypeError: unless they are, and for a text.
    """
    if not is_iterable(tasks):
        raise TypeError(f"tasks = {shown(tasks)} are not tasks that can be gone through")
    return cast(Iterable[Task], tasks)


def _carry_out(run: Runner, pending: Iterator[Job], executor: Executor | None, count: int) -> None:
    """Run the jobs where they are to run."""
    if executor is None and run.limit is None and count == 1:
        one_by_one = run.progress.total is None  # an iterator may look at the rows before its next task
        while jobs := list(islice(pending, 1 if one_by_one else run.chunk())):
            run.run_here(jobs)
        return
    try:
        if executor is not None:
            width = getattr(executor, "_max_workers", count)
            run.run_in_workers(pending, width, lambda tasks: executor.submit(carry_out_all, tasks))
        elif (first := next(pending, None)) is not None:
            with Workers(count, run.limit) as workers:
                run.run_in_workers(chain([first], pending), count, workers.submit)
    except BrokenExecutor as error:
        if executor is None and not run.progress.finished:
            raise RuntimeError(MAIN_GUARD) from None
        raise RuntimeError(
            f"the processes broke down: {error}; what is done is kept, and the same call carries on"
        ) from error


def results(tasks: Iterable[Task], store: str | Path) -> list[Row | None]:
    """The row of each task, in their order, from a store that may hold other rows too; None where there is none."""
    tasks = required_tasks(tasks)
    with Store(require_path("store", store)) as file:
        rows = {row["key"]: row for row in file.rows()}
    with warnings.catch_warnings():  # a task warned as it was made for the run
        warnings.simplefilter("ignore", UserWarning)
        return [rows.get(keyed(task)[0]) for task in tasks]


def completed(tasks: Iterable[Task], store: str | Path, **options: Unpack[CampaignOptions]) -> list[Row]:
    """The rows of the tasks, in their order, once a `campaign` with these options has run what the store lacks.

    Raises:
        RuntimeError: if a task has failed; its row in the store says how.
        ValueError, OSError: as `campaign`.
    """
    campaign(tasks, store, **options)
    rows = [row or {"status": "missing", "error": "no row"} for row in results(tasks, store)]
    failed = [row for row in rows if row["status"] != "done"]
    if failed:
        raise RuntimeError(
            f"{len(failed)} of {len(rows)} tasks failed, the first with {failed[0]['error']}; see {store}"
        )
    return rows


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
        self.seconds = 0.0
        self.seen = 0

    def pending(self, keyed_tasks: Iterable[tuple[str, Task]]) -> Iterator[Job]:
        """The tasks that have no row yet, each once. One that cannot be run gets its row here."""
        statuses = self.file.statuses()
        partial = self._partial_histories()
        columns: tuple[str, ...] = ()
        labels: dict[str, dict[str, object]] = {}
        for position, (key, task) in enumerate(keyed_tasks):
            self.seen += 1
            if (first_labels := labels.setdefault(key, dict(task.labels))) != task.labels:
                clash = f"the case labelled {dict(task.labels)} is that labelled {first_labels}"
                self.progress.warned.add(f"{clash}, whose row stands for both: they differ in labels alone", "same")
            history = None if self.folder is None else self.folder / f"{key}.npz"
            status = statuses.get(key)
            is_kept = status in ("failed", "taken") or history is None or history.exists()
            if status is not None and is_kept and not (self.retry and status == "failed"):
                self.progress.skipped += 1
                continue
            statuses[key] = "taken"
            names = column_names(task)
            if names != columns:
                self.file.add_columns(names)
                columns = names
            for path in partial.pop(key, ()):
                path.unlink(missing_ok=True)
            job = Job(task, key, position, history)
            if isinstance(task, RefusedTask):
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
            self.progress.warned.add(text)
        self.file.add(
            [
                {"key": job.key, "position": job.position, "version": programs(), **job.task.labels, **row}
                for job, row in zip(jobs, rows, strict=True)
            ]
        )
        self.seconds += sum(row["seconds"] for row in rows)
        self.progress.add(rows)

    def run_here(self, jobs: Sequence[Job]) -> None:
        """Run a chunk of jobs in a thread of this process.

        The main thread waits for the rows, so that Ctrl-C reaches it also while compiled code runs.
        """
        finished: SimpleQueue[list[Row]] = SimpleQueue()
        tasks = [(job.task, job.history) for job in jobs]
        Thread(target=lambda: finished.put(carry_out_all(tasks)), daemon=True).start()
        while True:
            with contextlib.suppress(Empty):
                return self.write(jobs, finished.get(timeout=POLL_INTERVAL))

    def run_in_workers(self, pending: Iterator[Job], width: int, submit: Submit) -> None:
        """Run jobs in other processes, with twice as many chunks in flight as there are processes.

        What a chunk leaves undone runs again, task by task. So does a task whose process was killed: after MOST_DEATHS
        deaths alone, in case memory was short, and if its process dies again, it gets a row that says so.

        Args:
            pending: the jobs.
            width: how many processes there are.
            submit: hands a chunk over. A job that cannot be handed over gets a row with the error.

        Raises:
            BrokenExecutor: if no process can take a job any more.
        """
        retries: deque[Job] = deque()
        in_flight: dict[Future[list[Row]], list[Job]] = {}
        try:
            while True:
                while len(in_flight) < 2 * width and (jobs := self.take(pending, retries, in_flight.values())):
                    try:
                        in_flight[submit([(job.task, job.history) for job in jobs])] = jobs
                    except (PickleError, AttributeError, TypeError) as error:  # what pickle raises
                        retries.extend(self.remaining_jobs(jobs, error))
                if not in_flight:
                    return
                done = wait(in_flight, return_when=FIRST_COMPLETED).done
                for future in [future for future in in_flight if future in done]:  # in the order of the tasks
                    jobs = in_flight.pop(future)
                    try:
                        rows = future.result()
                    except BrokenExecutor:
                        raise
                    except Exception as error:
                        retries.extend(self.remaining_jobs(jobs, error))
                    else:
                        self.write(jobs[: len(rows)], rows)
                        retries.extend(jobs[len(rows) :])
        finally:
            for future in in_flight:
                future.cancel()

    def take(self, pending: Iterator[Job], retries: deque[Job], in_flight: Collection[Sequence[Job]]) -> list[Job]:
        """The jobs of the next chunk, none where one that is in flight, or the next one, has to run alone."""
        if any(job.deaths >= MOST_DEATHS for jobs in in_flight for job in jobs):
            return []
        if retries:
            return [retries.popleft()] if retries[0].deaths < MOST_DEATHS or not in_flight else []
        return list(islice(pending, self.chunk()))

    def chunk(self) -> int:
        """How many jobs are about CHUNK_SECONDS of work; one where there is a time limit."""
        finished = self.progress.finished
        if self.limit is not None or not finished:
            return 1
        return min(max(int(CHUNK_SECONDS * finished / max(self.seconds, 1e-9)), 1), 64)

    def remaining_jobs(self, jobs: Sequence[Job], error: Exception) -> Sequence[Job]:
        """The jobs of a chunk without rows that are to be tried again, each alone. Others get their rows."""
        for job in jobs:
            for path in job.history.parent.glob(f"{job.history.name}.*.partial*") if job.history is not None else ():
                path.unlink(missing_ok=True)
        if len(jobs) > 1:
            return jobs
        (job,) = jobs
        if isinstance(error, ProcessExpired):
            return self.job_after_death(job, error.exitcode or 0)
        if isinstance(error, TimeoutError) and self.limit is not None:
            row = failed_row(TimeoutError(f"the case took longer than the time limit of {self.limit:g} s"))
            self.write(jobs, [row | {"seconds": self.limit}])
        elif isinstance(error, OSError):
            raise error
        else:
            self.write(jobs, [failed_row(error)])
        return ()

    def job_after_death(self, job: Job, exitcode: int) -> Sequence[Job]:
        """The job whose process has died, if it was killed and is to be tried again."""
        job.deaths += 1
        if exitcode < 0 and job.deaths <= MOST_DEATHS:
            return [job]
        if exitcode < 0:
            ending = f"was killed by {signal.Signals(-exitcode).name}"
        else:
            cause = ", as after a fatal error of MuJoCo, which MUJOCO_LOG.TXT would hold" if exitcode == 1 else ""
            ending = f"ended with exit status {exitcode % EXIT_FOR_ZERO}{cause}"
        repetition = f", {job.deaths} times in all" if job.deaths > 1 else ""
        self.write([job], [failed_row(RuntimeError(f"its worker process {ending}{repetition}"))])
        return ()
