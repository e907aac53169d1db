"""The map of overturning: the outcome for a wall or masonry under pulses of every amplitude and period of a grid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Unpack, cast

import numpy as np
from numpy.typing import ArrayLike

from ...contacts.files import aligned
from ...notebook import NotebookPicture, html_of
from ...quantities import Array, Integers, require_increasing, require_within, shown, takes
from ..analysis import Analysis
from ..campaign.campaign import CampaignOptions, completed
from ..campaign.task import Grid
from .ida import builds_of, built

PulseBuild = Callable[[float, float], Analysis]
"""Makes the analysis of an amplitude [m/s2] and a period [s]."""
ENDINGS = ("stands", "overturns after impacts", "overturns without impact", "falls")
"""What a wall does under a pulse, and last what masonry does that falls."""
STOOD, FELL_AFTER_IMPACTS, FELL_WITHOUT_IMPACT, FELL = range(len(ENDINGS))


@dataclass(frozen=True, eq=False, repr=False)
class OverturningMap(NotebookPicture):
    """What a wall or masonry does under pulses of every amplitude and period.

    Args:
        periods: of the pulses [s], increasing, shape (p,).
        amplitudes: of the pulses [m/s2], increasing, shape (a,).
        endings: under each pulse, of the first build, a number of `ENDINGS`: 0 stands, 1 overturns after impacts, 2
            overturns without impact, 3 masonry falls; shape (p, a).
        shares: share of the builds and the nudged repeats that overturn [-], shape (p, a). What is neither 0 nor 1 is
            left to chance, or to the build.
    """

    periods: Array
    amplitudes: Array
    endings: Integers
    shares: Array

    @property
    def lowest(self) -> Array:
        """The lowest amplitude at which it overturns under pulses of each period [m/s2], NaN for none, shape (p,)."""
        return self._first_amplitude(self.endings != STOOD)

    @property
    def lowest_without_impact(self) -> Array:
        """The same of overturning without impact [m/s2], NaN for none and for masonry, shape (p,)."""
        return self._first_amplitude(self.endings == FELL_WITHOUT_IMPACT)

    @property
    def islands(self) -> Array:
        """Where it stands although a lower amplitude of the same period overturns it, shape (p, a)."""
        fell = np.logical_or.accumulate(self.endings != STOOD, axis=1)
        return np.asarray(fell & (self.endings == STOOD))

    def _first_amplitude(self, flags: Array) -> Array:
        return np.where(flags.any(axis=1), self.amplitudes[flags.argmax(axis=1)], math.nan)

    def table(self) -> str:
        """A line for each period: from which amplitude it overturns, and in which ranges it stands above, as text."""
        return "\n".join(aligned(self._rows(), ">>><"))

    def _rows(self) -> list[tuple[str, ...]]:
        heads = "period [s]", "falls from [m/s2]", "without impact from [m/s2]", "stands again at [m/s2]"
        rows: list[tuple[str, ...]] = [heads]
        firsts = zip(self.periods, self.lowest, self.lowest_without_impact, self.islands, strict=True)
        for period, low, free, island in firsts:
            standing = [(run[0], run[-1]) for run in _runs(self.amplitudes, island)]
            ranges = ", ".join(f"{a:.4g}" if a == b else f"{a:.4g} to {b:.4g}" for a, b in standing)
            edges = ("-" if math.isnan(edge) else f"{edge:.4g}" for edge in (low, free))
            rows.append((f"{period:.4g}", *edges, ranges or "-"))
        return rows

    def _repr_html_(self) -> str:
        return html_of(repr(self).strip("<>"), self._rows())

    def __repr__(self) -> str:
        return (
            f"<OverturningMap of {len(self.amplitudes)} amplitudes up to {self.amplitudes[-1]:g} m/s2 and "
            f"{len(self.periods)} periods up to {self.periods[-1]:g} s: {(self.endings != STOOD).mean():.0%} "
            f"overturn, {int(self.islands.sum())} stand above an amplitude that does>"
        )


def _runs(amplitudes: Array, island: Array) -> Iterator[list[float]]:
    """The amplitudes of each range that stands."""
    for stands, pairs in groupby(zip(island.tolist(), amplitudes.tolist(), strict=True), key=lambda pair: pair[0]):
        if stands:
            yield [amplitude for _, amplitude in pairs]


def overturning_map(
    build: PulseBuild | Mapping[str, PulseBuild],
    amplitudes: ArrayLike,
    periods: ArrayLike,
    store: str | Path = "map.sqlite",
    *,
    nudges: Sequence[float] = (),
    **options: Unpack[CampaignOptions],
) -> OverturningMap:
    """Run a wall or masonry under pulses of every amplitude and period.

    Every pulse is run, as a wall may stand under an amplitude above one that overturns it. For the edges at one period
    to a tolerance see `thresholds`. What the store holds already is not run again, so that the same call carries on
    after a kill, and a finer grid runs what is new. The labels `record`, `period`, `amplitude` and `nudge` tell the
    rows apart there.

    Args:
        build: `build(amplitude, period)` makes the `Analysis` of a pulse, of a wall or of masonry [m/s2, s]; or some
            such functions by name, such as one for each seed of a record.
        amplitudes: increasing [m/s2], 0 to 1e4, shape (a,).
        periods: increasing [s], 0 to 100, shape (p,).
        store: the SQLite file.
        nudges: relative changes of the amplitude with which every pulse is run again [-], -0.01 to 0.01.
        options: those of `campaign`, such as `workers`.

    Returns:
        The `OverturningMap`, with `endings`, `shares`, `lowest`, `islands` and `table()`; `mr.plotting.overturning_map`
        draws it.

    Raises:
        TypeError: if `build` is not a function, or returns no `Analysis`.
        ValueError: for a value outside its range, or rows that do not increase; and as `campaign`.
        RuntimeError: if a run has failed; its row in the store says how.
    """
    builds = builds_of(build)
    for name, make in builds.items():
        if not takes(make, 2):
            raise TypeError(f"build of {name} = {shown(make)} is not a function of an amplitude and a period")
    levels = require_increasing("amplitudes", amplitudes, "amplitude [m/s2]", 1e4, "0 to 1e4 m/s2")
    lengths = require_increasing("periods", periods, "period [s]", 100.0, "0 to 100 s")
    moved = [0.0, *(require_within(f"nudges[{i}]", nudge, -0.01, 0.01) for i, nudge in enumerate(nudges))]

    def analysis(period: float, amplitude: float, record: str, nudge: float) -> Analysis:
        return built(lambda level: builds[record](level, period), amplitude * (1 + nudge), f"build of {record}")

    grid = Grid(analysis, period=lengths.tolist(), amplitude=levels.tolist(), record=list(builds), nudge=moved)
    tasks = cast(list[Analysis], grid[:])
    rows = completed(tasks, store, **options)
    shape = (len(lengths), len(levels), -1)
    fell = np.reshape([row[task.PEAK] == math.inf for task, row in zip(tasks, rows, strict=True)], shape)
    counts = [row.get("impacts") for row in rows]  # None of masonry, also in a store with rows of walls
    impacts = np.reshape([-1 if count is None else count for count in counts], shape)[:, :, 0]
    kinds = np.where(impacts < 0, FELL, np.where(impacts == 0, FELL_WITHOUT_IMPACT, FELL_AFTER_IMPACTS))
    return OverturningMap(lengths, levels, np.where(fell[:, :, 0], kinds, STOOD), fell.mean(axis=2))
