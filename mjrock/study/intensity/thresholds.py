"""All ranges of intensity in which a wall or masonry falls: a scan, the edges that it finds, and their certainty."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, Unpack

import numpy as np
from numpy.typing import ArrayLike

from ...contacts.files import aligned
from ...notebook import NotebookPicture, html_of
from ...quantities import Array, require_increasing, require_within
from ..analysis import Analysis
from ..campaign.campaign import CampaignOptions, completed
from .ida import Build, builds_of, built


class Island(NamedTuple):
    """A range of scales in which a record makes the wall or the masonry fall.

    Args:
        falls_from, falls_to: the lowest and the highest scale of the range that were tried.
        stands_below: the next lower scale that was tried, at which it stands; NaN if there is none.
        stands_above: the next higher one; NaN if there is none: the range goes on beyond the scan.
        lower, upper: the range of both edges over the repeats with nudged motions, the own one among them.
        seen: share of the repeats that fall somewhere in this range [-].
    """

    falls_from: float
    falls_to: float
    stands_below: float
    stands_above: float
    lower: tuple[float, float]
    upper: tuple[float, float]
    seen: float

    def __str__(self) -> str:
        if math.isnan(self.stands_above):
            return f"from {self.falls_from:.4g} on"
        return f"from {self.falls_from:.4g} to {self.falls_to:.4g}"


@dataclass(frozen=True, eq=False, repr=False)
class Thresholds(NotebookPicture):
    """The ranges of scales in which each record makes a wall or masonry fall.

    Args:
        records: names of the records.
        scales: the scales of the scan, in the unit that `build` takes, shape (scales,).
        shares: share of the repeats, which are nudged by the numbers below, that fall at each scale [-], shape
            (records, scales). What is neither 0 nor 1 is left to chance.
        islands: the ranges of each record, from the lowest.
        nudges: relative changes of the scale of the repeats [-], the first one 0.
        runs: how many runs there were.
    """

    records: tuple[str, ...]
    scales: Array
    shares: Array
    islands: tuple[tuple[Island, ...], ...]
    nudges: tuple[float, ...]
    runs: int

    @property
    def lowest(self) -> Array:
        """The lowest scale at which each record makes it fall, NaN where none does, shape (records,)."""
        return np.array([islands[0].falls_from if islands else math.nan for islands in self.islands])

    @property
    def sentences(self) -> tuple[str, ...]:
        """What each record does, in words."""
        return tuple(self._sentence(islands) for islands in self.islands)

    def _sentence(self, islands: Sequence[Island]) -> str:
        if not islands:
            return f"stands at all {len(self.scales)} scales that were tried, up to {self.scales[-1]:.4g}"
        lower = int((self.scales < islands[0].falls_from).sum())
        below = f"stands at all {lower} lower scales that were tried" if lower else "no lower scale was tried"
        return f"falls {' and '.join(map(str, islands))}; {below}"

    def table(self) -> str:
        """A line for each range: its edges, and in which range nudged motions have them, as text."""
        return "\n".join(aligned(self._rows(), "<>>>>>"))

    def _rows(self) -> list[tuple[str, ...]]:
        rows: list[tuple[str, ...]] = [("record", "falls from", "nudged", "to", "nudged", "seen in repeats")]
        for record, islands in zip(self.records, self.islands, strict=True):
            for island in islands:
                beyond = math.isnan(island.stands_above)
                ends = ("end of the scan", "-") if beyond else (f"{island.falls_to:.4g}", _range(island.upper))
                rows.append((record, f"{island.falls_from:.4g}", _range(island.lower), *ends, f"{island.seen:.0%}"))
            if not islands:
                rows.append((record, "stands", "-", "-", "-", "-"))
        return rows

    def _repr_html_(self) -> str:
        return html_of(repr(self).strip("<>"), self._rows())

    def __repr__(self) -> str:
        several = sum(len(row) > 1 or any(not math.isnan(part.stands_above) for part in row) for row in self.islands)
        return (
            f"<Thresholds of {len(self.records)} records at {len(self.scales)} scales from {self.scales[0]:g} to "
            f"{self.scales[-1]:g}: {int(np.isfinite(self.lowest).sum())} make it fall, {several} not monotonically>"
        )


def _range(band: tuple[float, float]) -> str:
    return f"{band[0]:.4g} to {band[1]:.4g}"


def thresholds(
    build: Build | Mapping[str, Build],
    scales: ArrayLike,
    store: str | Path = "thresholds.sqlite",
    *,
    tolerance: float = 0.01,
    nudges: Sequence[float] = (1e-6, -1e-6),
    **options: Unpack[CampaignOptions],
) -> Thresholds:
    """Find all ranges of intensity in which one or several records make a wall or masonry fall.

    A wall may fall in a range of intensities, stand above it and fall again. Every scale is run; where the outcomes of
    two neighbours differ the interval is halved until it is as narrow as the tolerance. A range that lies between two
    neighbouring scales is not found. Near an edge, and with many blocks almost everywhere, the outcome is left to
    chance. So all is done again with every motion changed by a nudge. To see what seeds do, give a record for each.

    What the store holds already is not run again, so that the same call carries on after a kill.

    Args:
        build: `build(scale)` makes the `Analysis` of a scale, of a wall or of masonry; or one such function for each
            record, by name.
        scales: increasing, not negative, in the unit that `build` takes, shape (scales,).
        store: the SQLite file.
        tolerance: width to which an edge is known, over its scale [-], 1e-6 to 0.5.
        nudges: relative changes of the scale of the repeats [-], -0.01 to 0.01; none for no repeats.
        options: those of `campaign`, such as `workers`.

    Returns:
        The `Thresholds`, with `islands`, `lowest`, `sentences` and `table()`; `mr.plotting.thresholds` draws them.

    Raises:
        TypeError: if `build` is not a function, or returns no `Analysis`.
        ValueError: for a value outside its range, or scales that are none or do not increase; and as `campaign`.
        RuntimeError: if a run has failed; its row in the store says how.
    """
    builds, tolerance = builds_of(build), require_within("tolerance", tolerance, 1e-6, 0.5)
    levels = require_increasing("scales", scales, "scale", math.inf, "0 and above")
    all_nudges = (0.0, *(require_within(f"nudges[{i}]", nudge, -0.01, 0.01) for i, nudge in enumerate(nudges)))
    fell: dict[tuple[str, float], dict[float, bool]] = {(name, nudge): {} for name in builds for nudge in all_nudges}
    pending = [(repeat, scale) for repeat in fell for scale in levels.tolist()]
    while pending:
        tasks = [_task(builds[name], name, nudge, scale) for (name, nudge), scale in pending]
        for (repeat, scale), task, row in zip(pending, tasks, completed(tasks, store, **options), strict=True):
            fell[repeat][scale] = row[task.PEAK] == math.inf
        pending = [
            (repeat, 0.5 * (low + high))
            for repeat, tried in fell.items()
            for low, high in _edges(tried)
            if high - low > tolerance * high
        ]
    shares = [[np.mean([fell[name, nudge][s] for nudge in all_nudges]) for s in levels.tolist()] for name in builds]
    islands = tuple(_islands([fell[name, nudge] for nudge in all_nudges]) for name in builds)
    runs = sum(map(len, fell.values()))
    return Thresholds(tuple(builds), levels, np.array(shares), islands, all_nudges, runs)


def _task(make: Build, name: str, nudge: float, scale: float) -> Analysis:
    """The run of a record at a scale that is changed by a nudge."""
    analysis = built(make, scale * (1 + nudge), f"build of {name}")
    return replace(analysis, labels={"record": name, "scale": scale, "nudge": nudge} | dict(analysis.labels))


def _edges(tried: Mapping[float, bool]) -> Iterator[tuple[float, float]]:
    """Neighbouring scales of different outcome."""
    scales = sorted(tried)
    yield from ((low, high) for low, high in pairwise(scales) if tried[low] != tried[high])


def _ranges(tried: Mapping[float, bool]) -> list[Island]:
    """The ranges of one repeat."""
    islands, before = list[Island](), math.nan
    for scale in sorted(tried):
        if not tried[scale]:
            before = scale
            if islands and math.isnan(islands[-1].stands_above):
                last = islands[-1]
                islands[-1] = last._replace(stands_above=scale, upper=(last.falls_to, scale))
        elif islands and math.isnan(islands[-1].stands_above):
            islands[-1] = islands[-1]._replace(falls_to=scale, upper=(scale, scale))
        else:
            below = scale if math.isnan(before) else before
            islands.append(Island(scale, scale, before, math.nan, (below, scale), (scale, scale), 1.0))
    return islands


def _islands(repeats: Sequence[Mapping[float, bool]]) -> tuple[Island, ...]:
    """The ranges of the first repeat, with the range of their edges over all repeats."""
    islands, *others = map(_ranges, repeats)
    merged = []
    for island in islands:
        overlapping = [[candidate for candidate in repeat if _meets(island, candidate)] for repeat in others]
        firsts = [island.lower, *(matches[0].lower for matches in overlapping if matches)]
        lasts = [island.upper, *(matches[-1].upper for matches in overlapping if matches)]
        lower, upper = ((min(a for a, _ in bands), max(b for _, b in bands)) for bands in (firsts, lasts))
        merged.append(island._replace(lower=lower, upper=upper, seen=len(firsts) / len(repeats)))
    return tuple(merged)


def _meets(island: Island, other: Island) -> bool:
    """Whether two ranges have scales in common."""
    return other.falls_from <= island.falls_to and other.falls_to >= island.falls_from
