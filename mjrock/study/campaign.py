"""Many cases, headless: any solver, any executor, one row a case in a file that a killed campaign carries on from."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from tqdm import tqdm

from .fingerprint import fingerprint
from .runner import Runner, processes
from .store import Store
from .task import VERSION, Row, Task, carry_out


def campaign(
    tasks: Iterable[Task],
    store: str | Path,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    histories: str | Path | None = None,
    retry: bool = False,
) -> Path:
    """Run every task that the store does not hold yet, and write a row for each.

    Killing a campaign loses only the cases in progress. The same call carries on from there and does nothing twice. A
    task that fails becomes a row with its error. The rows do not depend on the order in which tasks finish.

    Args:
        tasks: `Analysis` objects, a `Grid` of them, or an iterator; they are taken as they are needed.
        store: the SQLite file.
        executor: any executor of `concurrent.futures`, such as Dask's `client.get_executor()`; it is not shut down.
            None stands for processes of this machine, which are replaced if they die. Fixed-step runs of one geometry
            go to threads of this process instead, if a measured first batch says that this is faster.
        workers: how many processes, one for each processor by default; 1 runs in this process.
        histories: a folder, made where there is none, for the time history of each case, `<key>.npz`.
        retry: whether tasks that have failed before are run again.

    Returns:
        The path of the store, for `Store(path)`.

    Raises:
        ValueError: if the file is not a store, two labels clash, or `workers` is not positive.
        OSError: if the disk is full, or another process writes to the store.
        RuntimeError: if the executor given has broken down.
    """
    if workers is not None and workers < 1:
        raise ValueError(f"workers = {workers} is outside the valid range, which starts at 1")
    folder = None if histories is None else Path(histories)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    total = len(tasks) if isinstance(tasks, Sequence) else None
    count = workers or os.cpu_count() or 1
    with Store(store, writing=True) as file:
        run = Runner(file, folder, retry)
        pending = run.pending(tasks)
        with tqdm(total=total, unit="case", desc="campaign", delay=1, disable=None, smoothing=0.05) as run.bar:
            if executor is not None:
                width = getattr(executor, "_max_workers", count)
                run.across(pending, lambda: contextlib.nullcontext(executor), width, own=False)
            elif count == 1:
                for job in pending:
                    run.write([job], [carry_out(job.task, job.history)])
            else:
                run.across(run.by_threads(pending, count, total), lambda: processes(count), count, own=True)
        if total is not None and run.asked != total:
            raise RuntimeError(f"the tasks ended after {run.asked} of {total}; the same call carries on from there")
    return Path(store)


def results(tasks: Iterable[Task], store: str | Path) -> list[Row | None]:
    """The row of each task, in the order asked, from a store that may hold other rows too; None where there is none."""
    with Store(store) as file:
        rows = {row["key"]: row for row in file.rows()}
    return [rows.get(fingerprint(VERSION, task)) for task in tasks]


def completed(tasks: Iterable[Task], store: str | Path, **options: Any) -> list[Row]:
    """The rows of the tasks, in the order asked, once a campaign has run those that the store does not hold.

    Args:
        tasks: the tasks, that can be gone through more than once.
        store: the SQLite file.
        options: those of `campaign`.

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
