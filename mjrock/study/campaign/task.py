"""Tasks of a campaign, grids of them, the keys by which they are kept apart, and the rows that they return."""

from __future__ import annotations

import dataclasses
import hashlib
import importlib.metadata
import math
import time
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Protocol, cast, overload

import numpy as np

from ..._version import __version__
from ...quantities import is_iterable, listed, shown, spelt

Value = str | int | float | None


def table_value(value: object) -> Value:
    """A value as a table holds it: text, a 64-bit integer, a float or None; NaN becomes None, a truth value 0 or 1.

    Raises:
        ValueError: for anything else.
    """
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
    cells = sorted((name, value) for name, value in row.items() if value is not None)
    return zlib.crc32(repr(cells).encode())


def fingerprint(*contents: object) -> str:
    """A hash of the content of dataclasses, arrays, mappings and plain values, the same on every machine.

    A field of a dataclass that does not take part in comparison does not count: a label, the name of a record.

    Raises:
        TypeError: for a value whose content is not known, such as a function.
    """
    pieces: list[bytes] = []
    _add_content(contents, pieces.append)
    return hashlib.sha256(b"".join(b"%d:" % len(piece) + piece for piece in pieces)).hexdigest()[:32]


def _add_content(value: object, add: Callable[[bytes], None]) -> None:
    """Add the content of a value as pieces of bytes, which are the same for equal contents alone."""
    if isinstance(value, np.generic):
        _add_content(value.item(), add)
    elif value is None or isinstance(value, bool | str):
        add(repr(value).encode())
    elif isinstance(value, int | float):
        add(repr(float(value)).encode())  # 1 and 1.0 are the same thickness
    elif isinstance(value, tuple | list):
        add(b"[%d" % len(value))
        for item in value:
            _add_content(item, add)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        add(type(value).__name__.encode())
        if formula := getattr(type(value), "formula", ""):  # of a law of the user
            add(formula.encode())
        for name in _compared_fields(type(value)):
            add(name.encode())
            _add_content(getattr(value, name), add)
    elif isinstance(value, np.ndarray):
        add(f"{value.dtype.str}{value.shape}".encode())
        add(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Mapping):
        add(b"{%d" % len(value))
        for name in sorted(value):
            _add_content(name, add)
            _add_content(value[name], add)
    else:
        raise TypeError(f"{spelt(value)} is of no type whose content can be hashed")


@cache
def _compared_fields(kind: type) -> tuple[str, ...]:
    """The fields of a dataclass that take part in comparison."""
    return tuple(field.name for field in dataclasses.fields(kind) if field.compare)


Row = dict[str, Any]


class Task(Protocol):
    """What a campaign runs: a frozen dataclass that can be pickled, whose content is its key.

    `labels` are columns by which the user recognizes the case, and are not part of its content; `COLUMNS` names what
    the call returns.
    """

    @property
    def COLUMNS(self) -> tuple[str, ...]:
        """Names of what the call returns."""

    @property
    def labels(self) -> Mapping[str, object]:
        """Columns by which the user recognizes the task."""

    def __call__(self, history: Path | None = None) -> Row:
        """Do it, keep a time history in the file if one is given, and return the columns."""


@dataclass(frozen=True)
class RefusedTask:
    """A task that cannot be run. The campaign gives it a failed row with its error."""

    COLUMNS: ClassVar[tuple[str, ...]] = ()

    error: str
    labels: Mapping[str, object]

    @classmethod
    def because(cls, error: BaseException, labels: Mapping[str, object]) -> RefusedTask:
        """The task of these labels, that cannot be run because of the error. Labels that no table holds become text."""
        cells: dict[str, object] = {}
        for name, value in labels.items():
            try:
                cells[name] = table_value(value)
            except ValueError:
                cells[name] = table_text(value)
        return cls(failed_row(error)["error"], cells)

    def __call__(self, history: Path | None = None) -> Row:
        """Fail with the error."""
        raise ValueError(self.error)


@cache
def programs() -> str:
    """The versions of mjrock and MuJoCo that make a row; its task has another key with other versions."""
    return f"mjrock {__version__}, MuJoCo {importlib.metadata.version('mujoco')}"


def keyed(task: Task) -> tuple[str, Task]:
    """The key of a task, and the task. One that has no key, or labels that no table holds, becomes a `RefusedTask`."""
    labels = getattr(task, "labels", {})
    try:
        if not (callable(task) and hasattr(task, "labels") and hasattr(task, "COLUMNS")):
            raise TypeError(f"{table_text(task)} is not a task, which can be called and has labels and COLUMNS")
        for name, value in labels.items():
            _cell_of(f"the label {name}", value)
        return fingerprint(programs(), task), task
    except Exception as error:
        refused = RefusedTask.because(error, labels)
        return fingerprint(programs(), refused), refused


def column_names(task: Task) -> tuple[str, ...]:
    """The columns of a task beside those of every row.

    A label may have the name of a column whose value it repeats, such as `solver`; it counts once. Any other two names
    that are the same clash, and stay in the answer: `Store.add_columns` refuses them.
    """
    labels, columns = task.labels, task.COLUMNS
    repeated = {name for name in labels if name in columns and getattr(task, name, None) == labels[name]}
    return (*labels, *(name for name in columns if name not in repeated))


def carry_out(task: Task, history: Path | None) -> Row:
    """The row of a task: what it returns, or how it failed; and the seconds that it took."""
    started = time.perf_counter()
    try:
        row = {name: _cell_of(f"the column {name}", value) for name, value in task(history).items()}
        if unexpected := row.keys() - set(task.COLUMNS):
            names, known = ", ".join(sorted(unexpected)), ", ".join(task.COLUMNS)
            raise ValueError(f"the task returned {names}; its COLUMNS are {known}")
        row = {"status": "done", **row}
    except BaseException as error:  # also `sys.exit` in one case does not end the campaign
        row = failed_row(error)
    return row | {"seconds": time.perf_counter() - started}


def _cell_of(name: str, value: object) -> Value:
    """A value as a table holds it. Raises a ValueError with its name for one that no table holds."""
    try:
        return table_value(value)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None


def failed_row(error: BaseException) -> Row:
    """The row of a task that failed."""
    text = f"{type(error).__name__}: {error}".encode("utf-8", "backslashreplace").decode()
    return {"status": "failed", "error": text, "seconds": 0.0}


def carry_out_all(tasks: Sequence[tuple[Task, Path | None]]) -> list[Row]:
    """The rows of tasks with the files of their histories, in another process."""
    return [carry_out(task, history) for task, history in tasks]


class Grid(Sequence[Task]):
    """Every combination of the axes as a task. Each is built only when it is needed, and labelled with its axes.

    A label is the value itself if that is text, a number or None; a NumPy number counts as the Python number. For any
    other value it is its `name`, or its `repr`.

    Args:
        build: makes the task of a point, `build(slenderness=7, scale=0.5)`.
        axes: the values of each axis; the last one varies fastest.

    Raises:
        TypeError: for a build that is not a function, or values that cannot be gone through.
        ValueError: if an axis has no values, or more than 1000000.
    """

    def __init__(self, build: Callable[..., Task], **axes: Iterable[object]) -> None:
        if not callable(build):
            raise TypeError(f"build = {shown(build)} is not a function that makes the task of a point")
        self.build = build
        self.axes = {name: _axis_values(name, values) for name, values in axes.items()}

    def __repr__(self) -> str:
        axes = ", ".join(f"{name} ({len(values)})" for name, values in self.axes.items())
        return f"<Grid of {len(self)} cases: {axes}>"

    def __len__(self) -> int:
        """How many points there are."""
        return math.prod(map(len, self.axes.values()))

    def __iter__(self) -> Iterator[Task]:
        """The tasks in order. A point that `build` fails to make becomes a task that fails with the same message."""
        for i in range(len(self)):
            try:
                yield self[i]
            except (Exception, SystemExit) as error:
                yield RefusedTask.because(error, self._labels(self._point(i)))

    @overload
    def __getitem__(self, index: int) -> Task: ...

    @overload
    def __getitem__(self, index: slice) -> list[Task]: ...

    def __getitem__(self, index: int | slice) -> Task | list[Task]:
        """The task of one point, or a list of them for a slice."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        point = self._point(range(len(self))[index])
        try:
            task = self.build(**point)
        except ValueError as error:
            point_text = ", ".join(f"{name} = {value}" for name, value in self._labels(point).items())
            raise ValueError(f"{error} (at {point_text})") from error
        return labelled(task, self._labels(point))

    def _point(self, index: int) -> dict[str, object]:
        places = np.unravel_index(index, [len(values) for values in self.axes.values()])
        return {name: values[int(i)] for (name, values), i in zip(self.axes.items(), places, strict=True)}

    @staticmethod
    def _labels(point: Mapping[str, object]) -> dict[str, object]:
        return {name: axis_label(value) for name, value in point.items()}


def _axis_values(name: str, values: object) -> list[object]:
    """The values of an axis. Raises a TypeError or ValueError with its name if there are none."""
    if not (isinstance(values, str) or is_iterable(values)):
        raise TypeError(f"the axis {name} = {shown(values)} is not a row of values")
    if not (listed_values := listed(f"the axis {name}", values)):
        raise ValueError(f"the axis {name} has no values")
    return listed_values


def labelled(task: Task, labels: Mapping[str, object]) -> Task:
    """The task with these labels; its own count where both have one of a name.

    Raises:
        TypeError: for what is not a task.
    """
    if not hasattr(task, "labels"):
        raise TypeError(f"build gives {shown(task)}, which is not a task of a campaign, such as an Analysis")
    labels = dict(labels) | dict(task.labels)
    if hasattr(task, "labelled"):
        return cast(Task, task.labelled(labels))
    return cast(Task, replace(cast(Any, task), labels=labels))


def axis_label(value: object) -> object:
    """The label of the value of an axis, see `Grid`."""
    if isinstance(value, np.generic):
        value = value.item()
    return value if value is None or isinstance(value, str | int | float) else getattr(value, "name", spelt(value))
