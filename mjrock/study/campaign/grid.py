"""Every combination of some axes, as the tasks of a campaign."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, cast, overload

import numpy as np

from ...quantities import is_iterable, shown, spelt
from .task import Refused, Task


class Grid(Sequence[Task]):
    """Every combination of the axes as a task. Each is built only when it is asked for, and labelled with its axes.

    A label is the value itself if that is text, a number or None; a NumPy number counts as the Python number. For any
    other value it is its `name`, or its `repr`.

    Args:
        build: makes the task of a point, `build(slenderness=7, scale=0.5)`.
        axes: the values of each axis; the last one varies fastest.

    Raises:
        TypeError: for a build that is not a function, or values that cannot be gone through.
        ValueError: if an axis has no values, or more than memory holds.
    """

    def __init__(self, build: Callable[..., Task], **axes: Iterable[object]) -> None:
        if not callable(build):
            raise TypeError(f"build = {shown(build)} is not a function that makes the task of a point")
        self.build = build
        self.axes = {name: _listed(name, values) for name, values in axes.items()}

    def __repr__(self) -> str:
        axes = ", ".join(f"{name} ({len(values)})" for name, values in self.axes.items())
        return f"<Grid of {len(self)} cases: {axes}>"

    def __len__(self) -> int:
        """How many points there are."""
        return int(np.prod([len(values) for values in self.axes.values()], dtype=int))

    def __iter__(self) -> Iterator[Task]:
        """The tasks in order. A point that `build` fails to make becomes a task that fails with the same message."""
        for i in range(len(self)):
            try:
                yield self[i]
            except (Exception, SystemExit) as error:
                yield Refused.because(error, self._labels(self._point(i)))

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
            at = ", ".join(f"{name} = {value}" for name, value in self._labels(point).items())
            raise ValueError(f"{error} (at {at})") from error
        return labelled(task, self._labels(point))

    def _point(self, index: int) -> dict[str, object]:
        places = np.unravel_index(index, [len(values) for values in self.axes.values()])
        return {name: values[int(i)] for (name, values), i in zip(self.axes.items(), places, strict=True)}

    @staticmethod
    def _labels(point: Mapping[str, object]) -> dict[str, object]:
        return {name: axis_label(value) for name, value in point.items()}


def _listed(name: str, values: object) -> list[object]:
    """The values of an axis; a TypeError or ValueError with its name if there are none."""
    if not (isinstance(values, str) or is_iterable(values)):
        raise TypeError(f"the axis {name} = {shown(values)} is not a row of values")
    try:
        listed = list(values)
    except MemoryError:
        raise ValueError(f"the axis {name} = {shown(values)} has more values than memory holds") from None
    if not listed:
        raise ValueError(f"the axis {name} has no values")
    return listed


def labelled(task: Task, labels: Mapping[str, object]) -> Task:
    """The task with these labels; its own count where both have one of a name. TypeError for what is not a task."""
    if not hasattr(task, "labels"):
        raise TypeError(f"build gives {shown(task)}, which is not a task of a campaign, such as an Analysis")
    labels = dict(labels) | dict(task.labels)
    if hasattr(task, "labelled"):
        return cast(Task, task.labelled(labels))
    return cast(Task, replace(cast(Any, task), labels=labels))


def axis_label(value: object) -> object:
    """What a table says of the value of an axis, see `Grid`."""
    if isinstance(value, np.generic):
        value = value.item()
    return value if value is None or isinstance(value, str | int | float) else getattr(value, "name", spelt(value))
