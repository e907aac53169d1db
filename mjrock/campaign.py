"""Many cases, headless: any solver, any executor, one row a case in a file that a killed campaign carries on from."""

from __future__ import annotations

import contextlib
import inspect
import itertools
import multiprocessing
import os
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Protocol

import mujoco
import numpy as np
from tqdm import tqdm

from ._version import __version__
from .analytical import solve_analytical
from .case import Case
from .compliant import solve_compliant
from .interface import Contacts
from .response import Response
from .restitution import Restitution
from .simulation import simulate, simulate_batch
from .store import Store, fingerprint

SOLVERS: dict[str, Callable[..., Response]] = {
    "analytical": solve_analytical,
    "compliant": solve_compliant,
    "MuJoCo": simulate,
}
VERSION = f"mjrock {__version__}, MuJoCo {mujoco.__version__}"
"""What made a row; another version makes other rows."""
CHUNK_SECONDS = 0.5
"""Work that a worker is given at a time [s]: long beside the 1 ms of handing it over, short beside one's patience."""
START_UP = 2.0
"""What it takes until worker processes have imported what they need [s]."""
DEATHS = 2
"""Deaths of workers at which a task was in flight, after which it goes alone."""
BATCH = 8
"""Fixed-step runs that each of MuJoCo's threads takes up in one batch."""
BATCHED = frozenset({"timestep", "newmark_beta", "output_step", "ledger"})
"""Options of runs that can be stepped together."""

Row = dict[str, Any]


class Task(Protocol):
    """What a campaign runs: a frozen dataclass that can be pickled, whose content is its key.

    `labels` tell the user which case it was, and are no part of its content; `COLUMNS` names what the call returns.
    """

    COLUMNS: ClassVar[tuple[str, ...]]

    @property
    def labels(self) -> Mapping[str, object]:
        """Columns that tell the user which task it was."""

    def __call__(self, history: Path | None = None) -> Row:
        """Do it, keep a time history in the file if one is given, and return the columns."""


@dataclass(frozen=True)
class Analysis:
    """One case for one solver.

    Args:
        case: the case.
        solver: "analytical", "compliant" or "MuJoCo".
        e: coefficients of restitution, for the analytical solver.
        contacts: interfaces, for the other two.
        options: keyword arguments of the solver, such as `accuracy`, `timestep` or `rtol`.
        labels: columns that tell the user which case it is: text, numbers.

    Raises:
        ValueError: for a solver or an option that there is not, or if `e` or `contacts` are missing.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = (
        "solver",
        "law",
        "outcome",
        "peak_over_alpha",
        "impacts",
        "restitution_1",
        "restitution_2",
        "restitution_3",
        "end_s",
        "message",
    )

    case: Case
    solver: str = "MuJoCo"
    e: Restitution | None = None
    contacts: Contacts | None = None
    options: Mapping[str, object] = field(default_factory=dict)
    labels: Mapping[str, object] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        if self.solver not in SOLVERS:
            raise ValueError(f"solver = {self.solver!r} is none of {', '.join(SOLVERS)}")
        needed = "e" if self.solver == "analytical" else "contacts"
        if getattr(self, needed) is None:
            raise ValueError(f"the solver {self.solver} needs {needed}")
        if self.contacts is not None and self.solver != "analytical":
            self.contacts.require_fit(self.case.block, side_stop=self.case.side_stop)
        valid = list(inspect.signature(SOLVERS[self.solver]).parameters)[2:]
        unknown = self.options.keys() - set(valid)
        if unknown:
            raise ValueError(f"{self.solver} has no option {', '.join(sorted(unknown))}; it has {', '.join(valid)}")

    def solve(self) -> Response:
        """The response."""
        return SOLVERS[self.solver](self.case, self.e if self.solver == "analytical" else self.contacts, **self.options)

    def __call__(self, history: Path | None = None) -> Row:
        """Solve, keep the history in the file given, and return the columns of the row."""
        return self.row(self.solve(), history)

    def row(self, response: Response, history: Path | None = None) -> Row:
        """The columns of a response, whose history is kept in the file given."""
        if history is not None:
            save_history(response, history)
        restitution = [float(value) for value in response.restitution[:3]] + [None] * 3
        largest = max(response.peaks.max(initial=0.0), abs(response.theta[-1]))  # a run may end on its way out
        law = "restitution" if self.contacts is None or self.solver == "analytical" else self.contacts.law
        values = (
            self.solver,
            law,
            response.outcome.value,
            float(largest) / self.case.block.alpha,
            len(response.impacts),
            *restitution[:3],
            float(response.t[-1]),
            response.message,
        )
        return dict(zip(self.COLUMNS, values, strict=True))


def save_history(response: Response, path: Path) -> None:
    """Write t [s], theta [rad], omega [rad/s] and energy [J] to an .npz file, whole or not at all."""
    partial = path.with_name(path.name + f".{os.getpid()}.partial")
    try:
        with open(partial, "wb") as file:
            np.savez_compressed(file, t=response.t, theta=response.theta, omega=response.omega, energy=response.energy)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


class Grid(Sequence[Any]):
    """Every combination of the axes, made only when it is asked for, with the axes as labels.

    Args:
        build: makes the task of a point, `build(slenderness=7, scale=0.5)`.
        axes: the values of each axis; the last one varies fastest.
    """

    def __init__(self, build: Callable[..., Any], **axes: Iterable[object]) -> None:
        self.build = build
        self.axes = {name: list(values) for name, values in axes.items()}
        for name, values in self.axes.items():
            if not values:
                raise ValueError(f"the axis {name} has no values")

    def __len__(self) -> int:
        """How many points there are."""
        return int(np.prod([len(values) for values in self.axes.values()], dtype=int))

    def __iter__(self) -> Iterator[Any]:
        """The tasks in order; a point whose values `build` refuses becomes a task that fails with what it said."""
        for i in range(len(self)):
            try:
                yield self[i]
            except ValueError as error:
                yield Refused(str(error), self._labels(self._point(i)))

    def __getitem__(self, index: Any) -> Any:
        """The task of one point, or a list of them for a slice."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        point = self._point(range(len(self))[index])
        try:
            task = self.build(**point)
        except ValueError as error:
            shown = ", ".join(f"{name} = {value}" for name, value in self._labels(point).items())
            raise ValueError(f"{error} (at {shown})") from error
        return replace(task, labels=self._labels(point) | dict(task.labels))

    def _point(self, index: int) -> dict[str, Any]:
        places = np.unravel_index(index, [len(values) for values in self.axes.values()])
        return {name: values[int(i)] for (name, values), i in zip(self.axes.items(), places, strict=True)}

    @staticmethod
    def _labels(point: Mapping[str, object]) -> dict[str, object]:
        return {n: v if isinstance(v, str | int | float) else getattr(v, "name", repr(v)) for n, v in point.items()}


@dataclass(frozen=True)
class Refused:
    """A point of a grid that its builder refused."""

    COLUMNS: ClassVar[tuple[str, ...]] = ()

    complaint: str
    labels: Mapping[str, object]

    def __call__(self, history: Path | None = None) -> Row:
        """Fail with the complaint."""
        raise ValueError(self.complaint)


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

    Started again after it was killed, at whatever moment, it carries on with nothing lost and nothing done twice. A
    task that fails is a row with its error. The order in which tasks finish shows in no row and no export.

    Args:
        tasks: `Analysis` objects, a `Grid` of them, or an iterator; they are taken as they are needed.
        store: the SQLite file.
        executor: any executor of `concurrent.futures`, such as Dask's `client.get_executor()`; it is not shut down.
            None stands for processes of this machine, which are replaced if they die; or for MuJoCo's own threads where
            the tasks are fixed-step runs of one geometry and a measured first batch says that this is faster.
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
        run = _Campaign(file, folder, retry)
        pending = run.pending(tasks)
        with tqdm(total=total, unit="case", desc="campaign", delay=1, disable=None, smoothing=0.05) as run.bar:
            if executor is not None:
                width = getattr(executor, "_max_workers", count)
                run.across(pending, lambda: contextlib.nullcontext(executor), width, own=False)
            elif count == 1:
                for job in pending:
                    run.write([job], [_carry_out(job.task, job.history)])
            else:
                run.across(run.by_threads(pending, count, total), lambda: _processes(count), count, own=True)
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


def _processes(count: int) -> ProcessPoolExecutor:
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(count, mp_context=context, initializer=_die_with_the_campaign)


def _await_worker(executor: Executor) -> None:
    """Wait until a worker answers, so that a death at start-up is not taken for the work of a case."""
    try:
        executor.submit(os.getpid).result()
    except BrokenExecutor as error:
        raise RuntimeError(
            "the worker processes die as they start: they import the script that calls the campaign; let it do so "
            'below `if __name__ == "__main__":`; or give workers=1'
        ) from error


def _die_with_the_campaign() -> None:
    """Let a worker end when its campaign is killed, instead of waiting for work for ever."""

    def watch() -> None:
        parent = multiprocessing.parent_process()
        assert parent is not None
        parent.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _carry_out(task: Task, history: Path | None) -> Row:
    """The row of a task: what it returns, or how it failed; and the seconds that it took."""
    started = time.perf_counter()
    try:
        row: Row = {"status": "done", **task(history)}
    except Exception as error:  # whatever it is, it belongs in the row of the case and not at the end of the campaign
        row = _failed(error)
    return row | {"seconds": time.perf_counter() - started}


def _failed(error: BaseException) -> Row:
    return {"status": "failed", "error": f"{type(error).__name__}: {error}", "seconds": 0.0}


def _carry_out_all(tasks: Sequence[tuple[Task, Path | None]]) -> list[Row]:
    """What a worker does."""
    return [_carry_out(task, history) for task, history in tasks]


@dataclass
class _Job:
    """A task on its way."""

    task: Task
    key: str
    position: int
    history: Path | None
    deaths: int = 0


class _Campaign:
    """What is known while a campaign runs."""

    bar: Any

    def __init__(self, file: Store, folder: Path | None, retry: bool) -> None:
        self.file, self.folder, self.retry = file, folder, retry
        self.failed = 0
        self.seconds = 0.0
        self.finished = 0
        self.skipped = 0
        self.asked = 0

    def pending(self, tasks: Iterable[Task]) -> Iterator[_Job]:
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
            yield _Job(task, key, position, history)

    def write(self, jobs: Sequence[_Job], rows: Sequence[Row]) -> None:
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

    def by_threads(self, pending: Iterator[_Job], threads: int, total: int | None) -> Iterator[_Job]:
        """Run batches by MuJoCo's threads for as long as there are any and that is faster; return what is left.

        A batch tells how long its cases were stepped, which threads share, and how long they took besides, which they
        do not. Processes would share both, once they have started.
        """
        while job := next(pending, None):
            batch, mark = [job], _geometry(job.task)
            if mark is None:
                return itertools.chain(batch, pending)
            for job in pending:
                if len(batch) == BATCH * threads or _geometry(job.task) != mark:
                    pending = itertools.chain([job], pending)
                    break
                batch.append(job)
            started = time.perf_counter()
            rows, stepping = _batch_rows(batch)
            by_threads = (time.perf_counter() - started) / len(batch)
            self.write(batch, rows)
            by_processes = stepping + (by_threads - stepping) / threads
            left = (total or sys.maxsize) - self.skipped - self.finished
            if left * (by_threads - by_processes) > START_UP:
                break
        return pending

    def take(self, pending: Iterator[_Job], again: deque[_Job], flying: Iterable[list[_Job]]) -> list[_Job]:
        """The jobs of the next chunk, about CHUNK_SECONDS of work; those that went down with a worker go one by one."""
        if any(jobs[0].deaths >= DEATHS for jobs in flying):
            return []
        if again:
            return [again.popleft()] if again[0].deaths < DEATHS or not flying else []
        size = int(np.clip(CHUNK_SECONDS * self.finished / max(self.seconds, 1e-9), 1, 64)) if self.finished else 1
        return list(itertools.islice(pending, size))

    def across(self, pending: Iterator[_Job], make: Callable[[], Any], width: int, *, own: bool) -> None:
        """Run jobs on an executor, with twice as many chunks in flight as it has workers.

        Of our own processes, one that dies takes the others with it: they are replaced, and what was in flight is done
        again, one task at a time. What was in flight at DEATHS of them goes alone, and if it dies alone that is its
        result.
        """
        again: deque[_Job] = deque()
        ended = False
        while not ended:
            flying: dict[Future[list[Row]], list[_Job]] = {}
            with make() as executor:
                if own:
                    _await_worker(executor)
                try:
                    while True:
                        while len(flying) < 2 * width and (jobs := self.take(pending, again, flying.values())):
                            again.extendleft(reversed(jobs))  # where they are safe if the executor is broken
                            future = executor.submit(_carry_out_all, [(job.task, job.history) for job in jobs])
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
                            self.write([job], [_failed(error)])
                        else:
                            again.append(job)
                except BaseException:
                    for future in flying:
                        future.cancel()
                    raise

    def collect(
        self, future: Future[list[Row]], flying: dict[Future[list[Row]], list[_Job]], again: deque[_Job]
    ) -> None:
        """Write what a chunk has brought; a chunk that the executor could not carry out goes again, task by task."""
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
                self.write(jobs, [_failed(error)])
        else:
            self.write(jobs, rows)
        del flying[future]


def _geometry(task: Task) -> str | None:
    """What fixed-step runs have to share to be stepped together, or None for any other task."""
    if not isinstance(task, Analysis) or task.solver != "MuJoCo" or "timestep" not in task.options:
        return None
    if task.options.keys() - BATCHED:
        return None
    return fingerprint(task.case.block, task.case.side_stop, task.contacts, task.options)


def _batch_rows(batch: Sequence[_Job]) -> tuple[list[Row], float]:
    """Rows of runs that are stepped together, and the time per run that the engine took [s]."""
    analyses = [job.task for job in batch if isinstance(job.task, Analysis)]
    options: dict[str, Any] = dict(analyses[0].options)
    assert analyses[0].contacts is not None
    started = time.perf_counter()
    try:
        answers = simulate_batch([analysis.case for analysis in analyses], analyses[0].contacts, **options)
    except Exception as error:
        return [_failed(error)] * len(batch), 0.0
    rows: list[Row] = []
    for job, analysis, answer in zip(batch, analyses, answers, strict=True):
        if isinstance(answer, Response):
            row = {"status": "done", **analysis.row(answer, job.history)}
        else:
            row = _failed(answer)
        rows.append(row | {"seconds": (time.perf_counter() - started) / len(batch)})
    stepping = [answer.stats["stepping_time"] for answer in answers if isinstance(answer, Response)]
    return rows, stepping[0] if stepping else 0.0
