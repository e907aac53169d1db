"""What a campaign runs: tasks, the rows that they return, and the version that made them."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Protocol

import mujoco

from ..._version import __version__
from .fingerprint import fingerprint
from .values import plain, table_text

VERSION = f"mjrock {__version__}, MuJoCo {mujoco.__version__}"
"""What made a row; another version makes other rows."""

Row = dict[str, Any]


class Task(Protocol):
    """What a campaign runs: a frozen dataclass that can be pickled, whose content is its key.

    `labels` tell the user which case it was, and are not part of its content; `COLUMNS` names what the call returns.
    """

    @property
    def COLUMNS(self) -> tuple[str, ...]:
        """Names of what the call returns."""

    @property
    def labels(self) -> Mapping[str, object]:
        """Columns that tell the user which task it was."""

    def __call__(self, history: Path | None = None) -> Row:
        """Do it, keep a time history in the file if one is given, and return the columns."""


@dataclass(frozen=True)
class Refused:
    """A task that cannot be run. The campaign gives it a failed row with its error."""

    COLUMNS: ClassVar[tuple[str, ...]] = ()

    error: str
    labels: Mapping[str, object]

    @classmethod
    def because(cls, error: BaseException, labels: Mapping[str, object]) -> Refused:
        """The task of these labels, that cannot be run because of the error. Labels that no table holds become text."""
        held: dict[str, object] = {}
        for name, value in labels.items():
            try:
                held[name] = plain(value)
            except ValueError:
                held[name] = table_text(value)
        return cls(failed_row(error)["error"], held)

    def __call__(self, history: Path | None = None) -> Row:
        """Fail with the error."""
        raise ValueError(self.error)


def keyed(task: Task) -> tuple[str, Task]:
    """The key of a task, and the task. One that has no key, or labels that no table holds, becomes a `Refused`."""
    labels = getattr(task, "labels", {})
    try:
        if not (callable(task) and hasattr(task, "labels") and hasattr(task, "COLUMNS")):
            raise TypeError(f"{table_text(task)} is not a task, which can be called and has labels and COLUMNS")
        for name, value in labels.items():
            _named(f"the label {name}", value)
        return fingerprint(VERSION, task), task
    except Exception as error:
        refused = Refused.because(error, labels)
        return fingerprint(VERSION, refused), refused


def column_names(task: Task) -> tuple[str, ...]:
    """The columns of a task beside those of every row.

    A label may have the name of a column whose value it repeats, such as `solver`; it counts once. Any other two names
    that are the same clash, and stay in the answer for the store to complain about.
    """
    labels = task.labels
    repeated = {n for n in labels if n in task.COLUMNS and getattr(task, n, None) == labels[n]}
    return (*labels, *(name for name in task.COLUMNS if name not in repeated))


def carry_out(task: Task, history: Path | None) -> Row:
    """The row of a task: what it returns, or how it failed; and the seconds that it took."""
    started = time.perf_counter()
    try:
        row = {name: _named(f"the column {name}", value) for name, value in task(history).items()}
        if unexpected := row.keys() - set(task.COLUMNS):
            names, known = ", ".join(sorted(unexpected)), ", ".join(task.COLUMNS)
            raise ValueError(f"the task returned {names}; its COLUMNS are {known}")
        row = {"status": "done", **row}
    except BaseException as error:  # also `sys.exit` in one case does not end the campaign
        row = failed_row(error)
    return row | {"seconds": time.perf_counter() - started}


def _named(what: str, value: object) -> Any:
    try:
        return plain(value)
    except ValueError as error:
        raise ValueError(f"{what}: {error}") from None


def failed_row(error: BaseException) -> Row:
    """The row of a task that failed."""
    text = f"{type(error).__name__}: {error}".encode("utf-8", "backslashreplace").decode()
    return {"status": "failed", "error": text, "seconds": 0.0}


def carry_out_all(tasks: Sequence[tuple[Task, Path | None]]) -> list[Row]:
    """What a worker does."""
    return [carry_out(task, history) for task, history in tasks]
