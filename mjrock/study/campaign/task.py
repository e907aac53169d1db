"""What a campaign runs: tasks, what tells them apart, the rows that they return, and the version that made them."""

from __future__ import annotations

import dataclasses
import hashlib
import time
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Protocol

import mujoco
import numpy as np

from ..._version import __version__
from ...quantities import spelt

Value = str | int | float | None


def table_value(value: object) -> Value:
    """A value as a table holds it: text, a 64-bit integer, a float or None; NaN becomes None, a truth value 0 or 1.
    ValueError for anything else."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None:
        return None
    if isinstance(value, str):
        if not value.isascii() and value.encode("utf-8", "ignore").decode() != value:
            raise ValueError(f"{table_text(value)} is text that UTF-8 cannot hold")
        return str(value)
    if isinstance(value, float):
        return None if value != value else float(value)
    if isinstance(value, int):
        if -(2**63) <= value < 2**63:
            return int(value)
        raise ValueError(f"{table_text(value)} is outside the valid range of an integer, -2**63 to 2**63 - 1")
    raise ValueError(f"{table_text(value)} is of type {type(value).__name__}, and a table holds text, numbers and None")


def table_text(value: object) -> str:
    """A value as short text that every table can hold."""
    text = value.encode("utf-8", "backslashreplace").decode() if isinstance(value, str) else spelt(value)
    return text if len(text) <= 200 else text[:200] + "..."


def checksum(row: Mapping[str, Value]) -> int:
    """The checksum of a row, whatever the order of its columns; a column that is None counts as one that is absent."""
    held = sorted((name, value) for name, value in row.items() if value is not None)
    return zlib.crc32(repr(held).encode())


def fingerprint(*contents: object) -> str:
    """A hash of the content of dataclasses, arrays, mappings and plain values, the same on every machine.

    A field of a dataclass that does not take part in comparison does not count: a label, the name of a record.

    Raises:
        TypeError: for a value whose content is not known, such as a function.
    """
    digest = hashlib.sha256()
    _hand_on(contents, lambda piece: digest.update(b"%d:" % len(piece) + piece))
    return digest.hexdigest()[:32]


def _hand_on(value: object, add: Callable[[bytes], None]) -> None:
    """Hand on the content of a value, as pieces of bytes that tell it from any other."""
    if isinstance(value, np.generic):
        _hand_on(value.item(), add)
    elif value is None or isinstance(value, bool | str):
        add(repr(value).encode())
    elif isinstance(value, int | float):
        add(repr(float(value)).encode())  # 1 and 1.0 are the same thickness
    elif isinstance(value, tuple | list):
        add(b"[%d" % len(value))
        for item in value:
            _hand_on(item, add)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        add(type(value).__name__.encode())
        for name in _compared(type(value)):
            add(name.encode())
            _hand_on(getattr(value, name), add)
    elif isinstance(value, np.ndarray):
        add(f"{value.dtype.str}{value.shape}".encode())
        add(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Mapping):
        add(b"{%d" % len(value))
        for name in sorted(value):
            _hand_on(name, add)
            _hand_on(value[name], add)
    else:
        raise TypeError(f"{spelt(value)} is of no type whose content can be hashed")


@cache
def _compared(kind: type) -> tuple[str, ...]:
    """The fields of a dataclass that take part in comparison."""
    return tuple(field.name for field in dataclasses.fields(kind) if field.compare)


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
                held[name] = table_value(value)
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
        return table_value(value)
    except ValueError as error:
        raise ValueError(f"{what}: {error}") from None


def failed_row(error: BaseException) -> Row:
    """The row of a task that failed."""
    text = f"{type(error).__name__}: {error}".encode("utf-8", "backslashreplace").decode()
    return {"status": "failed", "error": text, "seconds": 0.0}


def carry_out_all(tasks: Sequence[tuple[Task, Path | None]]) -> list[Row]:
    """What a worker does."""
    return [carry_out(task, history) for task, history in tasks]
