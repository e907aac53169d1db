"""Many cases, headless: any solver, any executor, one row a case in a file that a killed campaign carries on from."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from concurrent.futures import BrokenExecutor, Executor
from itertools import chain
from pathlib import Path
from typing import TypedDict, Unpack, cast

from ...quantities import is_iterable, require_flag, require_path, require_real, require_whole, shown
from .pool import Workers
from .progress import CampaignProgress, collect_warnings
from .run import Runner
from .store import Store
from .task import Row, Task, carry_out_all, column_names, keyed

MOST_WORKERS = 10_000
"""Most processes of a campaign."""
GUARD = (
    "the worker processes die as they start: they import the script that calls the campaign; let it do so "
    'below `if __name__ == "__main__":`; or give workers=1 without a time limit'
)


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
    they ended; `python -m mjrock status walls.sqlite` says it later.

    Args:
        tasks: `Analysis` objects, a `Grid` of them, or an iterator; they are taken as they are needed.
        store: the SQLite file.
        executor: any executor of `concurrent.futures`, such as Dask's `client.get_executor()`; it is not shut down.
            None stands for processes of this machine, which are replaced if they die.
        workers: how many processes, 1 to 10000, one for each processor by default. They import the script that calls
            the campaign, which needs `if __name__ == "__main__":`. With workers=1 and no time limit tasks run in this
            process, which a task that ends its process then ends.
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
    count = (os.cpu_count() or 1) if workers is None else require_whole("workers", workers, 1, MOST_WORKERS)
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"executor = {shown(executor)} is not an executor of concurrent.futures")
    limit = None if time_limit is None else _required_limit(time_limit, executor)
    retry = require_flag("retry", retry)
    folder = None if histories is None else require_path("histories", histories)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    total = len(tasks) if isinstance(tasks, Sequence) else None
    with Store(path, writing=True) as file, CampaignProgress(file.path, len(file), total) as progress:
        if isinstance(tasks, list | tuple):
            for names in dict.fromkeys(column_names(keyed(task)[1]) for task in tasks):
                file.add_columns(names)
        run = Runner(file, progress, folder, retry=retry, limit=limit)
        try:
            with collect_warnings(run.warned.add):
                _carry_out(run, tasks, executor, count)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                f"{file.path}: {len(file)} rows are kept, and the same call carries on from there"
            ) from None
        finally:
            run.close()
        if total is not None and run.asked != total:
            raise RuntimeError(f"the tasks ended after {run.asked} of {total}; the same call carries on from there")
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
    """Tasks as something that can be gone through; TypeError unless they are, and for a text."""
    if not is_iterable(tasks):
        raise TypeError(f"tasks = {shown(tasks)} are not tasks that can be gone through")
    return cast(Iterable[Task], tasks)


def _carry_out(run: Runner, tasks: Iterable[Task], executor: Executor | None, count: int) -> None:
    """Run the tasks where they are to run."""
    pending = run.pending(tasks)
    if executor is None and run.limit is None and count == 1:
        for job in pending:
            run.here(job)
        return
    try:
        if executor is not None:
            width = getattr(executor, "_max_workers", count)
            run.across(pending, width, lambda tasks: executor.submit(carry_out_all, tasks))
        elif (first := next(pending, None)) is not None:
            with Workers(count, run.limit) as workers:
                run.across(chain([first], pending), count, workers.submit)
    except BrokenExecutor as error:
        if executor is None and not run.finished:
            raise RuntimeError(GUARD) from None
        raise RuntimeError(
            f"the processes broke down: {error}; what is done is kept, and the same call carries on"
        ) from error


def results(tasks: Iterable[Task], store: str | Path) -> list[Row | None]:
    """The row of each task, in the order asked, from a store that may hold other rows too; None where there is none."""
    tasks = required_tasks(tasks)
    with Store(require_path("store", store)) as file:
        rows = {row["key"]: row for row in file.rows()}
    with warnings.catch_warnings():  # what a task warns of as it is made was said when it ran
        warnings.simplefilter("ignore", UserWarning)
        return [rows.get(keyed(task)[0]) for task in tasks]


def completed(tasks: Iterable[Task], store: str | Path, **options: Unpack[CampaignOptions]) -> list[Row]:
    """The rows of the tasks, in the order asked, once a `campaign` with these options has run what the store lacks.

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
