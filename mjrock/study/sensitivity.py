"""The change of an answer with uncertain settings: one at a time, and all together."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Unpack

import numpy as np

from ..contacts.files import aligned, csv_text
from ..notebook import NotebookPicture
from ..quantities import Array, require_flag, require_kind, require_path, require_size, require_text, shown
from .campaign.campaign import CampaignOptions, completed
from .campaign.task import Row, Task, axis_label, labelled

MEASURE_UNITS = {"peak_over_alpha": "alpha", "g": "g", "m": "m", "s": "s", "rad": "rad", "N": "N", "J": "J"}
"""Units of a measure, by the name of its column or by the end of that name."""


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(NotebookPicture):
    """A measure of a wall for every setting that was tried.

    Args:
        measure: the column of the rows that is looked at.
        settings: names of the settings that were varied.
        base: the label of each of them in the base.
        rows: the row of each run, that of the base first.
        values: the measure of each run, infinite where a wall overturned, shape (runs,).
        changed: which settings of each run differ from the base.
    """

    measure: str
    settings: tuple[str, ...]
    base: Mapping[str, object]
    rows: tuple[Row, ...]
    values: Array
    changed: tuple[tuple[str, ...], ...]

    @property
    def unit(self) -> str:
        """Unit of the measure, or nothing where the name of its column has none."""
        return MEASURE_UNITS.get(self.measure, MEASURE_UNITS.get(self.measure.rpartition("_")[2], ""))

    @property
    def base_value(self) -> float:
        """The measure in the base."""
        return float(self.values[0])

    @property
    def range(self) -> tuple[float, float]:
        """The lowest and the highest value of all runs."""
        return float(self.values.min()), float(self.values.max())

    def swing(self, setting: str) -> tuple[float, float]:
        """The lowest and the highest value where this setting alone changes; the base is one of them.

        Raises:
            ValueError: for a setting that was not varied.
        """
        if setting not in self.settings:
            raise ValueError(f"setting = {shown(setting)} is not one of {', '.join(self.settings)}")
        values = self._values_alone(setting)
        return min(values), max(values)

    def _values_alone(self, setting: str) -> list[float]:
        """The values of the base and of the runs in which this setting alone changes."""
        runs = zip(self.values.tolist(), self.changed, strict=True)
        return [value for value, names in runs if names in ((), (setting,))]

    @property
    def swings(self) -> dict[str, tuple[float, float]]:
        """The swing of each setting, the widest first. Whether a wall overturns counts more than any finite change."""

        def width(name: str) -> tuple[bool, float]:
            low, high = self.swing(name)
            finite = [value for value in self._values_alone(name) if math.isfinite(value)]
            return low < high == math.inf, max(finite, default=0.0) - min(finite, default=0.0)

        return {name: self.swing(name) for name in sorted(self.settings, key=width, reverse=True)}

    @property
    def governs(self) -> str | None:
        """The setting that changes the measure most when it alone changes; None if none does."""
        name, (low, high) = next(iter(self.swings.items()))
        return name if low < high else None

    @property
    def sentence(self) -> str:
        """The result in one sentence, such as "0.35 to 0.48 g, governed by k_n"."""
        low, high = (self.written(value) for value in self.range)
        digits = 4
        while low == high and self.governs is not None:  # they differ
            low, high = (f"{value:.{digits}g}" for value in self.range)
            digits += 1
        if self.governs is None:
            alone = "no setting changes it alone" if low != high else "no setting changes it"
            return f"{low} {self.unit}".strip() + f", {alone}" if low == high else f"{low} to {high}, {alone}"
        unit = f" {self.unit}" if self.unit and math.isfinite(self.range[1]) else ""
        return f"{low} to {high}{unit}, governed by {self.governs}"

    @staticmethod
    def written(value: float) -> str:
        """A value of the measure as text; an infinite one is "overturned"."""
        return "overturned" if value == math.inf else f"{value:.3g}" if abs(value) < 0.1 else f"{value:.2f}"

    def table(self) -> str:
        """The swing of each setting, the widest first, and the range of all runs, as text."""
        combined = sum(len(names) > 1 for names in self.changed)
        rows = [["setting", "in the base", "lowest", "highest", "runs"]]
        for name, ends in self.swings.items():
            count = sum(names == (name,) for names in self.changed)
            rows.append([name, setting_text(self.base[name]), *map(self.written, ends), str(count)])
        if combined:
            rows.append(["together", "", *map(self.written, self.range), str(combined)])
        title = f"{self.measure}{f' [{self.unit}]' if self.unit else ''}"
        return "\n".join([f"{title}: {self.written(self.base_value)} in the base", *aligned(rows), self.sentence])

    def csv(self) -> str:
        """Every run as CSV text: its settings and the measure."""
        rows = [[*(row[name] for name in self.settings), row[self.measure]] for row in self.rows]
        return csv_text([*self.settings, self.measure], rows)

    def __repr__(self) -> str:
        return f"<Sensitivity of {self.measure} to {', '.join(self.settings)}, {len(self.rows)} runs: {self.sentence}>"


def sensitivity(
    build: Callable[..., Task],
    base: Mapping[str, object],
    vary: Mapping[str, Sequence[object]],
    store: str | Path | None = None,
    *,
    measure: str | None = None,
    together: bool = True,
    **options: Unpack[CampaignOptions],
) -> Sensitivity:
    """How much the answer changes with settings that are not known: one at a time, and all together.

    The runs are a campaign: what the store holds is not run again, and a campaign that was killed carries on.

    Args:
        build: `build(**settings)` makes the task of some settings: an `Analysis`, or a `Capacity` of one, where the
            question is at which intensity a wall overturns. Whatever it takes can be varied: an intensity, a polarity,
            a record, a stiffness, a damping ratio, a number of contact lines.
        base: the settings of the base. A varied setting that it leaves out has its default in `build`, or without one
            its first value.
        vary: the values to try of each setting.
        store: the SQLite file; None keeps no rows.
        measure: the column of the rows to look at; None is `peak_over_alpha` of an `Analysis`, the
            `largest_rotation_rad` of a block of masonry, `capacity_g` of a `Capacity`.
        together: whether every combination of the values runs too, those of the base among them. Their number is the
            product over the settings.
        options: those of `campaign`, such as `workers`.

    Returns:
        The `Sensitivity`: `table()`, the `range` of the answer, and what `governs` it.

    Raises:
        TypeError: for a build that is not a function, or settings that are not a mapping of names.
        ValueError: for a setting without values, nothing to vary, a measure that is not a column of numbers, and as
            `campaign`.
        RuntimeError: if a run has failed.
    """
    points, changed = _points(build, base, vary, require_flag("together", together))
    tasks: list[Task] = []
    for point in points:
        labels = {name: axis_label(point[name]) for name in vary}
        try:
            tasks.append(labelled(build(**point), labels))
        except Exception as error:
            settings_text = ", ".join(f"{name} = {shown(value)}" for name, value in point.items())
            raise ValueError(f"build fails at {settings_text}: {type(error).__name__}: {error}") from error
    column = _column(tasks[0], measure)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "sensitivity.sqlite" if store is None else require_path("store", store)
        rows = completed(tasks, path, **options)
    rows = [row | dict(task.labels) for row, task in zip(rows, tasks, strict=True)]  # an older row has other labels
    for row in rows:
        if isinstance(row[column], str) or row[column] is None:
            raise ValueError(f"measure = {column!r} is {row[column]!r} in a row; it has to be a number")
    values = np.array([row[column] for row in rows], dtype=float)
    base_labels = {name: axis_label(points[0][name]) for name in vary}
    return Sensitivity(column, tuple(vary), base_labels, tuple(rows), values, changed)


def _points(
    build: Callable[..., Task], base: Mapping[str, object], vary: Mapping[str, Sequence[object]], together: bool
) -> tuple[list[dict[str, object]], tuple[tuple[str, ...], ...]]:
    """The settings of each run, those of the base first, and the names of those that differ from the base."""
    if not callable(build):
        raise TypeError(f"build = {shown(build)} is not a function of settings")
    for name, settings in (("base", base), ("vary", vary)):
        if not isinstance(settings, Mapping) or not all(isinstance(key, str) for key in settings):
            raise TypeError(f"{name} = {shown(settings)} is not a mapping of the names of settings")
    if not vary:
        raise ValueError("vary is empty; at least one setting is needed")
    base = {**defaults_of(build, vary), **base}
    choices: dict[str, list[object]] = {}
    for name, values in vary.items():
        if isinstance(values, str) or not isinstance(values, Sequence | np.ndarray) or not len(values):
            raise ValueError(f"vary[{name!r}] = {shown(values)} is not a row of at least one value")
        candidates = [base[name], *values] if name in base else list(values)
        distinct: dict[object, object] = {}
        for value in candidates:
            distinct.setdefault(axis_label(value), value)
        choices[name] = list(distinct.values())
    require_size("the number of runs", math.prod(map(len, choices.values())) if together else 1, "vary fewer settings")
    first = dict(base) | {name: values[0] for name, values in choices.items()}
    places = [(0,) * len(choices)]
    places += [
        tuple(j if k == i else 0 for k in range(len(choices)))
        for i, values in enumerate(choices.values())
        for j in range(1, len(values))
    ]
    if together:
        places += list(product(*(range(len(values)) for values in choices.values())))
    names, points, changed = list(choices), [], []
    for place in dict.fromkeys(places):
        points.append(first | {name: choices[name][j] for name, j in zip(names, place, strict=True)})
        changed.append(tuple(name for name, j in zip(names, place, strict=True) if j))
    return points, tuple(changed)


def defaults_of(build: Callable[..., object], names: Iterable[str]) -> dict[str, object]:
    """The defaults of these arguments of a function, of those that have one."""
    try:
        arguments = inspect.signature(build).parameters
    except (TypeError, ValueError):  # some built-in functions have no signature
        return {}
    defaults = {name: arguments[name].default for name in names if name in arguments}
    return {name: value for name, value in defaults.items() if value is not inspect.Parameter.empty}


def _column(task: Task, measure: str | None) -> str:
    """The column to look at."""
    if measure is None:
        return str(getattr(task, "PEAK", task.COLUMNS[0]))
    require_kind("measure", measure, str)
    if require_text("measure", measure) not in task.COLUMNS:
        raise ValueError(f"measure = {shown(measure)} is not one of the columns {', '.join(task.COLUMNS)}")
    return measure


def setting_text(value: object) -> str:
    """The value of a setting as a short text."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)[:30]
