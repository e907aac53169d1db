"""What a campaign runs: tasks, the rows that they return, and the version that made them."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Protocol

import mujoco

from .._version import __version__

VERSION = f"mjrock {__version__}, MuJoCo {mujoco.__version__}"
"""What made a row; another version makes other rows."""

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


def carry_out(task: Task, history: Path | None) -> Row:
    """The row of a task: what it returns, or how it failed; and the seconds that it took."""
    started = time.perf_counter()
    try:
        row: Row = {"status": "done", **task(history)}
    except Exception as error:  # whatever it is, it belongs in the row of the case and not at the end of the campaign
        row = failed_row(error)
    return row | {"seconds": time.perf_counter() - started}


def failed_row(error: BaseException) -> Row:
    """The row of a task that failed."""
    return {"status": "failed", "error": f"{type(error).__name__}: {error}", "seconds": 0.0}


def carry_out_all(tasks: Sequence[tuple[Task, Path | None]]) -> list[Row]:
    """What a worker does."""
    return [carry_out(task, history) for task, history in tasks]
