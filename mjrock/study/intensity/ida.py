"""Incremental dynamic analysis: the peak rotation of a wall under records that are scaled up step by step."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import Array, Implausible, require_increasing, require_kind, require_within, shown, takes
from ..analysis import Analysis
from ..campaign.campaign import CampaignOptions, completed
from ..campaign.task import Row
from .capacities import lost
from .capacity import bracket, halved
from .fragility import Fragility, fit_fragility, labels_for

Build = Callable[[float], Analysis]


@dataclass(frozen=True, eq=False, repr=False)
class IncrementalAnalysis:
    """The peaks of every record at every scale. Masonry overturns when a block falls.

    Args:
        records: names of the records.
        scales: the scales, in the unit that `build` takes, shape (scales,).
        peaks: largest rotation over alpha, infinite where the wall overturned [-], shape (records, scales). Of masonry
            the largest rotation of a block [rad].
        rows: the row of the store for each run, by record and scale.
    """

    records: tuple[str, ...]
    scales: Array
    peaks: Array
    rows: tuple[tuple[Row, ...], ...]

    @property
    def capacity(self) -> Array:
        """The lowest scale at which each record overturns the wall, NaN where none does, shape (records,).

        A record may leave the wall standing again at a higher scale.
        """
        fell = np.isinf(self.peaks)
        return np.where(fell.any(axis=1), self.scales[fell.argmax(axis=1)], math.nan)

    def fragility(self, groups: ArrayLike | None = None, resamples: int = 1000, seed: int = 0) -> Fragility:
        """The fragility curve of these runs, with the records as groups, see `fit_fragility` and `lost`.

        Records that overturn the wall at no scale count: every run does, and not the capacities alone.

        Args:
            groups: what each record belongs to, where both polarities of a record stand for one, shape (records,);
                None takes each as a record of its own.
            resamples, seed: as those of `fit_fragility`.

        Raises:
            TypeError, ValueError: as `fit_fragility`, and for groups of another number.
        """
        own = labels_for(groups, len(self.records))
        used = self.scales > 0
        fell = np.array([lost(rows) for rows in self.rows]).reshape(self.peaks.shape)[:, used]
        levels = self.scales[used]
        runs = np.tile(levels, len(own)), fell.ravel(), np.repeat(own, len(levels))
        return fit_fragility(*runs, resamples=resamples, seed=seed)

    def percentiles(self, shares: Sequence[float] = (16, 50, 84)) -> Array:
        """Peaks over all records that these shares of the records stay below [-], shape (shares, scales).

        Each is the peak of the nearest record, as there is no mean of a finite peak and overturning.

        Shares are 0 to 100 [%].
        """
        levels = [require_within(f"shares[{i}]", share, 0.0, 100.0, "%") for i, share in enumerate(shares)]
        return np.asarray(np.percentile(self.peaks, levels, axis=0, method="nearest"))

    def __repr__(self) -> str:
        fell = np.isfinite(self.capacity)
        return (
            f"<IncrementalAnalysis of {len(self.records)} records at {len(self.scales)} scales from "
            f"{self.scales[0]:g} to {self.scales[-1]:g}: {int(fell.sum())} records overturn the wall>"
        )


def ida(
    build: Build | Mapping[str, Build],
    scales: ArrayLike,
    store: str | Path = "ida.sqlite",
    **options: Unpack[CampaignOptions],
) -> IncrementalAnalysis:
    """Run a wall under one or several records at every scale, and gather the peaks.

    What the store holds already is not run again. The labels `record` and `scale` tell the rows apart there, unless the
    analyses have labels of these names.

    Args:
        build: `build(scale)` makes the `Analysis` of a scale; or one such function for each
            record, by name. The peaks of masonry are those of the rotation of a block [rad].
        scales: increasing, not negative, in the unit that `build` takes, shape (scales,).
        store: the SQLite file.
        options: those of `campaign`, such as `workers`.

    Raises:
        TypeError: if `build` is not a function, or returns no `Analysis`.
        ValueError: if the scales are none, negative or do not increase, or there are no records; and as `campaign`.
        RuntimeError: if a run has failed; its row in the store says how.
    """
    builds = dict(build) if isinstance(build, Mapping) else {"record": build}
    if not builds:
        raise ValueError("build holds no records; at least one is needed")
    levels = require_increasing("scales", scales, "scale", math.inf, "0 and above")
    tasks: list[Analysis] = []
    for name, make in builds.items():
        require_kind("the name of a record in build", name, str)
        for scale in levels.tolist():
            analysis = built(make, scale, f"build[{name!r}]" if isinstance(build, Mapping) else "build")
            tasks.append(replace(analysis, labels={"record": name, "scale": scale} | dict(analysis.labels)))
    rows = completed(tasks, store, **options)
    table = tuple(tuple(rows[i : i + len(levels)]) for i in range(0, len(rows), len(levels)))
    peaks = np.array([[row[tasks[0].PEAK] for row in runs] for runs in table], dtype=float)
    return IncrementalAnalysis(tuple(builds), levels, peaks, table)


def overturning_intensity(
    build: Build,
    low: float | None = None,
    high: float | None = None,
    *,
    tolerance: float = 1e-3,
    start: float = 1.0,
) -> float:
    """A scale at which a record overturns a wall, while at a scale that is hardly lower it does not.

    The interval from `low` to `high` is halved until it is as narrow as asked. Without them the scale goes up from
    `start` by a quarter at a time until the wall falls, or down until it stands. A wall may overturn at a scale and
    stand at a higher one. There may then be several such scales, and this is one of them; `ida` shows all.

    Args:
        build: `build(scale)` makes the `Analysis` of a scale.
        low: a scale at which the wall does not overturn, not negative; None to search for it.
        high: a scale at which it does, above `low`; None to search for it. Both are given, or neither.
        tolerance: how far below the answer the wall may be known to stand, over the answer [-], 1e-9 to 0.5.
        start: where the search starts, 1e-6 to 1e6.

    Returns:
        The upper end of the last interval.

    Raises:
        TypeError: if `build` is not a function, or returns no `Analysis`.
        ValueError: for a value outside its range, if the wall overturns at `low` or does not at `high`, or if no scale
            from 1e-6 to 1e3 times the start parts the two.
    """
    tolerance = require_within("tolerance", tolerance, 1e-9, 0.5)
    start = require_within("start", start, 1e-6, 1e6)

    def falls(scale: float) -> bool:
        return _peak(build, scale) == math.inf

    if low is None and high is None:
        return halved(falls, *bracket(falls, start), tolerance)[1]
    if low is None or high is None:
        raise ValueError(f"low = {low} and high = {high}: give both, or neither")
    low, high = require_within("low", low, 0.0, 1e12), require_within("high", high, 0.0, 1e12)
    if not low < high:
        raise ValueError(f"high = {high:g} is outside the valid range, which is above low = {low:g}")
    peaks = [_peak(build, scale) for scale in (low, high)]
    if peaks[0] == math.inf:
        raise ValueError(f"low = {low:g}: the wall overturns at that scale already; give a lower one")
    if peaks[1] < math.inf:
        raise ValueError(
            f"high = {high:g}: the wall does not overturn at that scale, its largest rotation is "
            f"{peaks[1]:.4g} {'rad' if build(high).PEAK.endswith('_rad') else 'alpha'}; give a higher one"
        )
    return halved(falls, low, high, tolerance)[1]


def _peak(build: Build, scale: float) -> float:
    """The peak at a scale, infinite where the wall has overturned."""
    analysis = built(build, scale, "build")
    return float(analysis()[analysis.PEAK])


def built(build: Build, scale: float, name: str) -> Analysis:
    """The analysis that a function makes of a scale; TypeError with its name unless it returns an `Analysis`."""
    if not takes(build, 1):
        raise TypeError(f"{name} = {shown(build)} is not a function of a scale")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="the record peaks at ", category=Implausible)  # low scales are meant
        analysis = build(scale)
    if not isinstance(analysis, Analysis):
        raise TypeError(f"{name}({scale:g}) = {shown(analysis)} is not an Analysis")
    return analysis
