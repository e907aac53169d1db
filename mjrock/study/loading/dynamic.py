"""The check of a local mechanism by nonlinear dynamic analysis, Circolare 21 gennaio 2019 n. 7, C8.7.1.2.1.9."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...problem.ground.motion import GroundMotion
from ...problem.masonry.case import AnyCase
from ...problem.wall.block import Block
from ...problem.wall.case import Case
from ...quantities import Implausible, is_iterable, require_kind, shown, spelt
from ...result.response import Response
from ..analysis import Analysis
from ..campaign.campaign import results
from .mechanism import SHARE, MechanismCheck, Verdict, verdicts_of

LEAST = 8
"""Records that are more than those of the global response, of which NTC 2018, 7.3.5, takes the mean from seven on."""


class RunMaximum(NamedTuple):
    """One run of the check.

    Args:
        name: of its horizontal motion.
        record: number of its record, the same in both polarities.
        turned: whether its motion is that of the first run of its record, reversed.
        solver: which solver ran it.
        d: largest displacement of the centroid [m], infinite for a wall that has overturned.
    """

    name: str
    record: int
    turned: bool
    solver: str
    d: float


@dataclass(frozen=True, eq=False, repr=False)
class DynamicCheck:
    """The verdict of nonlinear dynamic analysis.

    Args:
        limit_state: "SLV" or "SLC".
        d_0: displacement of the centroid at which nothing brings the wall back [m].
        runs: the largest displacement of each run.
        restitution: |e| of all impacts of the responses [-], shape (n,); none is known of rows of a campaign.
        natural: whether the records were recorded; None is not known.
    """

    limit_state: str
    d_0: float
    runs: tuple[RunMaximum, ...]
    restitution: tuple[float, ...]
    natural: bool | None

    @property
    def records(self) -> int:
        """How many records the runs have."""
        return max(run.record for run in self.runs) + 1

    @property
    def in_one_polarity(self) -> int:
        """How many of the records were run in one polarity alone."""
        return 2 * self.records - len({(run.record, run.turned) for run in self.runs})

    @property
    def lacking(self) -> tuple[str, ...]:
        """What C8.7.1.2.1.9 asks for and the runs do not have, in words."""
        count, lacking = self.records, list[str]()
        if count < LEAST:
            more = f"and more than the {LEAST - 1} of the global response (NTC 2018, 7.3.5) count"
            lacking.append(f"{count} records, {more}")
        if self.in_one_polarity:
            lacking.append(f"{self.in_one_polarity} of {count} records in one polarity alone")
        if not self.natural:
            made = "are artificial" if self.natural is False else "are not said to be"
            lacking.append(f"natural records, and these {made}")
        return tuple(lacking)

    @property
    def worse(self) -> tuple[float, ...]:
        """The larger maximum of both polarities of each record [m], infinite beyond d_0."""
        numbers = dict.fromkeys(run.record for run in self.runs)
        return tuple(max(run.d for run in self.runs if run.record == number) for number in numbers)

    @property
    def mean(self) -> float:
        """Mean of the maxima of the records, in the worse polarity of each [m]."""
        return float(np.mean(self.worse))

    @property
    def exceeded(self) -> tuple[str, ...]:
        """Names of the runs beyond d_0."""
        return tuple(run.name for run in self.runs if run.d > self.d_0)

    @property
    def capacity(self) -> float:
        """The displacement that the mean may reach, 0.4 d_0 at the SLV and 0.6 d_0 at the SLC [m]."""
        return SHARE[self.limit_state] * self.d_0

    @property
    def holds(self) -> bool:
        """Whether no run exceeds d_0 and the mean of the maxima stays within the capacity."""
        return not self.exceeded and self.mean <= self.capacity

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """The two conditions."""
        largest = max(run.d for run in self.runs)
        return (
            Verdict("dynamic, largest run", self.limit_state, largest, self.d_0, "m", "C8.7.1.2.1.9"),
            Verdict("dynamic, mean of maxima", self.limit_state, self.mean, self.capacity, "m", "C8.7.1.2.1.9"),
        )

    def table(self, kinematic: MechanismCheck | None = None) -> str:
        """The runs, the restitution of their impacts, what is lacking and the verdicts, as text.

        Args:
            kinematic: a check of the same wall, whose verdicts then stand above.
        """
        require_kind("kinematic", kinematic, MechanismCheck, type(None))
        lines = [f"{run.solver}, {run.name}: {run.d:.4f} m, {run.d / self.d_0:.2f} d_0" for run in self.runs]
        if self.restitution:
            low, middle, high = np.percentile(self.restitution, [5, 50, 95])
            said = f"{middle:.3f} in the median, {low:.3f} to {high:.3f} in nine of ten"
            lines.append(f"restitution |e| of {len(self.restitution)} impacts: {said}")
        lines += [f"lacking: {what}" for what in self.lacking]
        before = () if kinematic is None else kinematic.verdicts
        return "\n".join([*lines, verdicts_of((*before, *self.verdicts))])

    def __repr__(self) -> str:
        said = "holds" if self.holds else "fails"
        return (
            f"<DynamicCheck {self.limit_state} {said}: mean {self.mean:.4g} m of {self.capacity:.4g} m, "
            f"{len(self.exceeded)} of {len(self.runs)} runs beyond d_0 = {self.d_0:.4g} m>"
        )


def dynamic_check(
    runs: Sequence[Response] | Sequence[Analysis],
    limit_state: str = "SLV",
    *,
    store: str | Path | None = None,
    natural: bool | None = None,
) -> DynamicCheck:
    """The check of a wall by nonlinear dynamic analysis, by Circolare 2019 n. 7, C8.7.1.2.1.9.

    The limit state holds if no run exceeds d_0, and if the mean of the largest displacements is at most 0.4 d_0 at the
    SLV and 0.6 d_0 at the SLC (C8.7.1.2.1.6). d_0 is the displacement of the centroid at which weight, loads and
    thrusts bring the wall back no more. Ties act in the runs, and do not raise d_0, of which the clause counts only
    what is known to hold up to collapse. The worse of both polarities of a record enters the mean, which is on the
    safe side of the clause.

    The clause asks for more records than the global response, natural ones that fit the spectrum together, and a
    restitution of mechanism and slenderness. What the runs lack of it is said. That they fit the spectrum is for the
    user, see `RecordSet.mean_over`.

    Args:
        runs: responses of one wall with the same effects, of any solver, or the `Analysis` tasks of a campaign.
        limit_state: "SLV" or "SLC", whose spectrum the records fit.
        store: the file of the campaign, for tasks.
        natural: whether the records were recorded. None does not know.

    Returns:
        The `DynamicCheck`, with `holds` and `table()`.

    Raises:
        TypeError, ValueError: for runs of masonry, of unlike walls or effects or without ground motion, or tasks
            without a row.

    Warns:
        Implausible: for what the clause asks for and the runs lack.
    """
    if limit_state not in SHARE:
        raise ValueError(f"limit_state = {spelt(limit_state)} is not one of {', '.join(SHARE)}")
    require_kind("natural", natural, bool, type(None))
    if not is_iterable(runs) or not (given := list[Response | Analysis](runs)):
        raise TypeError(f"runs = {shown(runs)} is not a sequence of responses or tasks of a campaign")
    cases = _cases_of(given)
    wall = cases[0].wall
    outer, inner = cases[0].restoring
    alone = max(outer.alpha if cases[0].side_stop else min(outer.alpha, inner.alpha), 0.0)
    found = tuple(
        RunMaximum(motion.name, *signal, run.solver, moved(wall, share * wall.alpha))
        for motion, signal, run, share in zip(
            _motions(cases), signals_of(cases), given, _shares(given, store), strict=True
        )
    )
    impacts = (impact.restitution for run in given if isinstance(run, Response) for impact in run.impacts)
    known = tuple(e for e in impacts if not math.isnan(e))
    check = DynamicCheck(limit_state, moved(wall, alone), found, known, natural)
    if check.lacking:
        warnings.warn(f"C8.7.1.2.1.9 asks for more: {'; '.join(check.lacking)}", Implausible, stacklevel=2)
    return check


def moved(wall: Block, rotation: float) -> float:
    """Displacement of the centroid at a rotation [m], infinite for a wall that has overturned."""
    return math.inf if math.isinf(rotation) else float(wall.pose([rotation])[0, 0])


def _cases_of(runs: Sequence[Response | Analysis]) -> list[Case]:
    """The cases of runs of one kind, which are of one wall with the same effects."""
    cases = list[Case]()
    for i, run in enumerate(runs):
        require_kind(f"runs[{i}]", run, Response if isinstance(runs[0], Response) else Analysis)
        case = run.case
        if not isinstance(case, Case):
            raise TypeError(f"runs[{i}] is one of masonry, and the check takes those of one wall")
        if case.motion is None:
            raise ValueError(f"runs[{i}] has no horizontal ground motion, of which the clause takes the maxima")
        cases.append(case)
        if any(getattr(case, name) != getattr(cases[0], name) for name in ("block", "effects", "side_stop")):
            raise ValueError(f"runs[{i}] is of another wall, side stop or other effects than runs[0]")
    return cases


def _shares(runs: Sequence[Response | Analysis], store: str | Path | None) -> list[float]:
    """The largest rotation of each run over alpha [-], infinite for a wall that has overturned."""
    responses = [run for run in runs if isinstance(run, Response)]
    if responses:
        if store is not None:
            raise ValueError("store is for the tasks of a campaign, and runs are responses; leave it out")
        return [run.peak_over_alpha for run in responses]
    if store is None:
        raise ValueError("runs are tasks of a campaign; give its file as store")
    rows = results([run for run in runs if isinstance(run, Analysis)], store)
    done = [float(row["peak_over_alpha"]) for row in rows if row is not None and row["status"] == "done"]
    if len(done) < len(rows):
        raise ValueError(f"{len(rows) - len(done)} of {len(rows)} tasks have no row that is done in {store}; run them")
    return done


def _same(one: AnyCase, other: AnyCase) -> bool:
    """Whether two cases have one record, in either polarity of its horizontal component."""
    if one.vertical != other.vertical or one.motion is None or other.motion is None:
        return False
    return other.motion in one.motion.polarities


def signals_of(cases: Sequence[AnyCase]) -> list[tuple[int, bool]]:
    """The number of the record of each case, and whether its motion is that of the first such case, reversed."""
    firsts: list[AnyCase] = []
    signals = []
    for case in cases:
        number = next((i for i, first in enumerate(firsts) if _same(first, case)), len(firsts))
        if number == len(firsts):
            firsts.append(case)
        signals.append((number, case.motion != firsts[number].motion))
    return signals


def _motions(cases: Sequence[Case]) -> list[GroundMotion]:
    """The horizontal motion of each case."""
    return [case.motion for case in cases if case.motion is not None]
