"""Motions that are scaled until they overturn a wall: incremental dynamic analysis, and the search for its capacity."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar, Unpack

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import (
    GRAVITY,
    Array,
    Implausible,
    Within,
    keep_declared,
    require_increasing,
    require_kind,
    require_within,
    short_repr,
    shown,
    takes,
)
from ..analysis import Analysis, subject_of
from ..campaign.campaign import CampaignOptions, completed
from ..campaign.task import Row
from .fragility import Fragility, fit_fragility, labels_for, lost

Build = Callable[[float], Analysis]
"""Makes the analysis of a scale."""
AnyBuild = TypeVar("AnyBuild", bound=Callable[..., Analysis])
GROWTH = 1.25
"""Ratio of neighbouring scales while a bracket is searched [-]. A wall may stand again above a scale that overturns it:
a finer ratio misses fewer of such islands."""
LARGEST_SCALE, LEAST_SCALE = 1e3, 1e-6
"""Scales beyond which the search for a bracket gives up, over the scale it starts at [-]."""


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
        labels = labels_for(groups, len(self.records))
        used = self.scales > 0
        fell = np.array([lost(rows) for rows in self.rows]).reshape(self.peaks.shape)[:, used]
        levels = self.scales[used]
        runs = np.tile(levels, len(labels)), fell.ravel(), np.repeat(labels, len(levels))
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
    """Run a wall under one or several records at every scale, and collect the peaks.

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
        ValueError: if the scales are none, negative or do not increase, if there are no records, or some of walls and
            some of masonry; and as `campaign`.
        RuntimeError: if a run has failed; its row in the store says how.
    """
    builds = builds_of(build)
    levels = require_increasing("scales", scales, "scale", math.inf, "0 and above")
    tasks: list[Analysis] = []
    for name, make in builds.items():
        for scale in levels.tolist():
            analysis = built(make, scale, f"build[{name!r}]" if isinstance(build, Mapping) else "build")
            tasks.append(replace(analysis, labels={"record": name, "scale": scale} | dict(analysis.labels)))
    if len({analysis.PEAK for analysis in tasks}) > 1:
        raise ValueError("build makes walls and masonry, whose peaks have different units; call ida for each kind")
    rows = completed(tasks, store, **options)
    table = tuple(tuple(rows[i : i + len(levels)]) for i in range(0, len(rows), len(levels)))
    peaks = np.array([[row[tasks[0].PEAK] for row in runs] for runs in table], dtype=float)
    return IncrementalAnalysis(tuple(builds), levels, peaks, table)


def overturning_intensity(
    build: Build, low: float | None = None, high: float | None = None, *, tolerance: float = 1e-3, start: float = 1.0
) -> float:
    """A scale at which a record overturns a wall, while at a scale that is hardly lower it does not.

    The interval from `low` to `high` is halved down to the tolerance. Without them the scale goes up from
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


def builds_of(build: AnyBuild | Mapping[str, AnyBuild]) -> dict[str, AnyBuild]:
    """The function of each record, by name.

    Raises:
        TypeError: for a name that is no text.
        ValueError: for no records.
    """
    builds = dict(build) if isinstance(build, Mapping) else {"record": build}
    if not builds:
        raise ValueError("build holds no records; at least one is needed")
    for name in builds:
        require_kind("the name of a record in build", name, str)
    return builds


def _peak(build: Build, scale: float) -> float:
    """The peak at a scale, infinite where the wall has overturned."""
    analysis = built(build, scale, "build")
    return float(analysis()[analysis.PEAK])


def built(build: Build, scale: float, name: str) -> Analysis:
    """The analysis that a function makes of a scale.

    Raises:
        TypeError: unless it returns an `Analysis`, with its name.
    """
    if not takes(build, 1):
        raise TypeError(f"{name} = {shown(build)} is not a function of a scale")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="the record peaks at ", category=Implausible)  # low scales are meant
        analysis = build(scale)
    if not isinstance(analysis, Analysis):
        raise TypeError(f"{name}({scale:g}) = {shown(analysis)} is not an Analysis")
    return analysis


def bracket(falls: Callable[[float], bool], start: float = 1.0) -> tuple[float, float]:
    """Two neighbouring scales of which the lower leaves a wall standing and the upper overturns it.

    From `start` the scale goes up by GROWTH until the wall falls, or down until it stands.

    Raises:
        ValueError: if it stands at LARGEST_SCALE times the start, or falls at LEAST_SCALE times the start.
    """
    low = high = start
    if falls(start):
        while falls(low := high / GROWTH):
            if low < LEAST_SCALE * start:
                raise ValueError(f"the wall overturns at every scale from {start:g} down to {low:g}")
            high = low
        return low, high
    while not falls(high := low * GROWTH):
        if high > LARGEST_SCALE * start:
            raise ValueError(f"the wall stands at every scale from {start:g} up to {high:g}; no capacity is found")
        low = high
    return low, high


def halved(falls: Callable[[float], bool], low: float, high: float, tolerance: float) -> tuple[float, float]:
    """The interval between a scale that leaves a wall standing and one that overturns it, halved until it is narrower
    than `tolerance` times its upper end."""
    while high - low > tolerance * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return low, high


def lowest(falls: Callable[[float], bool], low: float, high: float, below: int, spacing: float) -> tuple[float, float]:
    """Two neighbouring scales, as those given, below which the wall has stood at `below` weaker ones in a row.

    From `low` the scale goes down by `spacing` [-] at a time. Where the wall falls, that scale is the upper one of the
    two, and the count begins again.

    Raises:
        ValueError: if it falls at LEAST_SCALE times `low` or less.
    """
    scale, stood, limit = low, 0, LEAST_SCALE * low
    while stood < below:
        scale /= 1 + spacing
        if falls(scale):
            if scale < limit:
                raise ValueError(f"the wall overturns at scales down to {scale:g}; no capacity is found")
            high, stood = scale, -1
        else:
            low = scale if stood < 0 else low
            stood += 1
    return low, high


@dataclass(frozen=True)
class Capacity:
    """The lowest intensity found at which the motion of a case overturns its wall; a task of a campaign, as an
    `Analysis` is.

    Masonry is lost when a block falls. The motions of the case in all directions are scaled together, and the intensity
    is that of `motion`, or in space without it of `transverse`. From the scale `start` the search goes up by a quarter
    at a time until the wall falls, or down until it stands, and then halves the interval. A wall may fall in a band of
    intensities, stand above it and fall again. So the search then goes down, `spacing` at a time, until the wall has
    stood at `below` intensities in a row. The lowest at which it falls is the upper end of the answer.

    Its row has `capacity_g`, the peak ground acceleration over g that overturns the wall, `capacity_scale`, the factor
    on the motion of the case, `stands_at_g`, hardly lower, at which the wall stands, and `stands_down_to_g`, the lowest
    of the intensities tried below, at all of which it stands. `stands_above_g` is the highest above the capacity that
    was tried and at which the wall stands, None if there is none; the message then says "Not monotonic". A band
    narrower than the spacing, or below the last look, may be missed. With `below=0` the answer is one edge of perhaps
    several.

    Looks below make the search longer. In 28 cases of theory, each from five starts, `below=0` takes 10 runs in the
    mean, the default 27, and 30 looks at 1 % take 52. The answer is within 2 % of the lowest intensity that overturns
    in 31, 63 and 79 % of them, within 10 % in 51, 83 and 89 % (`scripts/checks/capacity_bands.py`).

    Args:
        analysis: the case with its motion, solver and, of a wall, contacts.
        tolerance: how far below the answer the wall may be known to stand, over the answer [-], 1e-6 to 0.5.
        start: scale of the motion from which the search starts [-], 1e-6 to 1e6.
        below: at how many weaker intensities the wall has to stand, 0 to 1000.
        spacing: ratio of two of them, less one [-], 1e-4 to 0.25.

    Raises:
        TypeError: for what is no `Analysis`.
        ValueError: for a value outside its range, or a case whose ground does not move horizontally.
    """

    COLUMNS: ClassVar[tuple[str, ...]] = (
        "solver", "law", "capacity_g", "capacity_scale", "stands_at_g", "stands_down_to_g", "stands_above_g", "runs",
        "message",
    )  # fmt: skip
    PEAK: ClassVar[str] = "capacity_g"
    """The column that a study of sensitivity looks at."""

    analysis: Analysis
    tolerance: Annotated[float, Within(1e-6, 0.5)] = 0.01
    start: Annotated[float, Within(1e-6, 1e6)] = 1.0
    below: Annotated[int, Within(0, 1000, whole=True)] = 12
    spacing: Annotated[float, Within(1e-4, GROWTH - 1)] = 0.02

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_kind("analysis", self.analysis, Analysis)
        keep_declared(self)
        if not self.peak > 0:
            raise ValueError(f"analysis = {shown(self.analysis)} has no horizontal motion to scale")

    @property
    def peak(self) -> float:
        """Largest horizontal acceleration of the case over g [-], 0 where there is none."""
        case = self.analysis.case
        motion = case.motion or case.transverse
        return 0.0 if motion is None else motion.peak / GRAVITY

    @property
    def labels(self) -> Mapping[str, object]:
        """The labels of the analysis."""
        return self.analysis.labels

    @property
    def solver(self) -> str:
        """The solver of the analysis."""
        return self.analysis.solver

    def labelled(self, labels: Mapping[str, object]) -> Capacity:
        """The same task with other labels."""
        return replace(self, analysis=replace(self.analysis, labels=labels))

    def scaled(self, scale: float) -> Analysis:
        """The analysis with its motions times `scale`."""
        case = self.analysis.case
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".* peaks at ", category=UserWarning)  # weak and strong are meant
            moved: dict[str, Any] = {name: ground.scaled(scale) for name, ground in case.grounds.items()}
            return replace(self.analysis, case=replace(case, **moved))

    def __call__(self, history: Path | None = None) -> Row:
        """Search, and return the columns of the row; a history is that of the run that overturned the wall."""
        tried: dict[float, bool] = {}

        def falls(scale: float) -> bool:
            if scale not in tried:
                analysis = self.scaled(scale)
                tried[scale] = bool(analysis()[analysis.PEAK] == math.inf)
            return tried[scale]

        low, high = halved(falls, *bracket(falls, self.start), max(self.tolerance, self.spacing))
        low, high = lowest(falls, low, high, self.below, self.spacing)
        lowest_scale, (low, high) = low / (1 + self.spacing) ** self.below, halved(falls, low, high, self.tolerance)
        if history is not None:
            self.scaled(high)(history)
        peak = self.peak
        above = max((scale for scale, fell in tried.items() if scale > high and not fell), default=None)
        values = (
            self.solver, self.analysis.law, high * peak, high, low * peak, lowest_scale * peak,
            None if above is None else above * peak, len(tried), self._message(low, high, lowest_scale, above),
        )  # fmt: skip
        return dict(zip(self.COLUMNS, values, strict=True))

    def _message(self, low: float, high: float, lowest_scale: float, above: float | None) -> str:
        """What is known, in words: the scales between which the outcome changes, and what was tried beside them."""
        falls = subject_of(self.analysis.case).FALLS
        message = f"The {falls} at {high * self.peak:.4g} g and stands at {low * self.peak:.4g} g"
        if self.below:
            down = f"{100 * self.spacing:.3g} % apart, down to {lowest_scale * self.peak:.4g} g"
            message += f" and at all {self.below} lower intensities that were tried, {down}."
        else:
            message += ". It is an edge: whether a weaker intensity does so too was not looked at."
        if above is not None:
            message += f" Not monotonic: it stands at {above * self.peak:.4g} g too."
        return message
