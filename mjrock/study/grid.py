"""Every combination of some axes, as the tasks of a campaign."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..quantities import spelt
from .campaign_task import Refused


class Grid(Sequence[Any]):
    """Every combination of the axes as a task. Each is built only when it is asked for, and labelled with its axes.

    A label is the value itself if that is text, a number or None; a NumPy number counts as the Python number. For any
    other value it is its `name`, or else its `repr`.

    Args:
        build: makes the task of a point, `build(slenderness=7, scale=0.5)`.
        axes: the values of each axis; the last one varies fastest.

    Raises:
        ValueError: if an axis has no values.
    """

    def __init__(self, build: Callable[..., Any], **axes: Iterable[object]) -> None:
        self.build = build
        self.axes = {name: list(values) for name, values in axes.items()}
        for name, values in self.axes.items():
            if not values:
                raise ValueError(f"the axis {name} has no values")

    def __repr__(self) -> str:
        axes = ", ".join(f"{name} ({len(values)})" for name, values in self.axes.items())
        return f"<Grid of {len(self)} cases: {axes}>"

    def __len__(self) -> int:
        """How many points there are."""
        return int(np.prod([len(values) for values in self.axes.values()], dtype=int))

    def __iter__(self) -> Iterator[Any]:
        """The tasks in order. A point that `build` fails to make becomes a task that fails with the same message."""
        for i in range(len(self)):
            try:
                yield self[i]
            except (Exception, SystemExit) as error:
                yield Refused.because(error, self._labels(self._point(i)))

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
        return {name: _label(value) for name, value in point.items()}


def _label(value: object) -> object:
    if isinstance(value, np.generic):
        value = value.item()
    return value if value is None or isinstance(value, str | int | float) else getattr(value, "name", spelt(value))
