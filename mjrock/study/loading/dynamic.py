"""The check of a local mechanism by nonlinear dynamic analysis, Circolare 21 gennaio 2019 n. 7, C8.7.1.2.1.9."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, cast

import numpy as np

from ...notebook import html_of
from ...problem.masonry.case import AnyCase, MasonryCase, require_wall
from ...problem.wall.block import Block
from ...problem.wall.case import Case
from ...quantities import Array, Implausible, is_iterable, require_kind, share_said, shown, spelt, warn_of
from ...result.response import Response
from ..analysis import Analysis
from ..campaign.campaign import results
from .mechanism import SHARE, MechanismCheck, Verdict, verdict_rows, verdicts_of
from .push import Push, of_centroid

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
        restitution: |e| of all impacts of the responses [-], shape (n,); none is known of masonry and of rows of a
            campaign.
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
        lines = [f"{run.solver}, {run.name}: {run.d:.4f} m, {share_said(run.d / self.d_0)} d_0" for run in self.runs]
        if self.restitution:
            low, middle, high = np.percentile(self.restitution, [5, 50, 95])
            said = f"{middle:.3f} in the median, {low:.3f} to {high:.3f} in nine of ten"
            lines.append(f"restitution |e| of {len(self.restitution)} impacts: {said}")
        lines += [f"lacking: {what}" for what in self.lacking]
        before = () if kinematic is None else kinematic.verdicts
        return "\n".join([*lines, verdicts_of((*before, *self.verdicts))])

    def _repr_html_(self) -> str:
        runs = [(one.name, f"{one.d:.4f}", share_said(one.d / self.d_0)) for one in self.runs]
        head = ("run", "displacement [m]", "of d_0")
        return html_of(repr(self).strip("<>"), verdict_rows(self.verdicts), [head, *runs])

    def __repr__(self) -> str:
        said = "HOLDS" if self.holds else "FAILS"
        return (
            f"<DynamicCheck {self.limit_state} {said}: mean {self.mean:.4g} m of {self.capacity:.4g} m, "
            f"{len(self.exceeded)} of {len(self.runs)} runs beyond d_0 = {self.d_0:.4g} m>"
        )


def dynamic_check(
    runs: Sequence[Response] | Sequence[Analysis],
    limit_state: str = "SLV",
    *,
    curve: Push | None = None,
    store: str | Path | None = None,
    natural: bool | None = None,
) -> DynamicCheck:
    """The check of a wall or of masonry by nonlinear dynamic analysis, by Circolare 2019 n. 7, C8.7.1.2.1.9.

    The limit state holds if no run exceeds d_0, and if the mean of the largest displacements is at most 0.4 d_0 at the
    SLV and 0.6 d_0 at the SLC (C8.7.1.2.1.6). d_0 is the displacement of the centroid at which weight, loads and
    thrusts bring the wall back no more. Ties act in the runs, and do not raise d_0, of which the clause counts only
    what is known to hold up to collapse. The worse of both polarities of a record enters the mean, which is on the
    safe side of the clause.

    Of masonry of many blocks d_0 is that of its `push` along a direction, of the common centroid of its free blocks,
    and the maxima are those of the same centroid along that direction. Leave ties out of the push, and give it what
    else is constant. A run from which a block has fallen exceeds d_0. Masonry that may go either way is checked with
    the push either way.

    The clause asks for more records than the global response, natural ones that fit the spectrum together, and a
    restitution of mechanism and slenderness. What the runs lack of it is said. That they fit the spectrum is for the
    user, see `RecordSet.mean_over`.

    Args:
        runs: responses of one wall or masonry with the same effects, of any solver, or of a wall the `Analysis` tasks
            of a campaign.
        limit_state: "SLV" or "SLC", whose spectrum the records fit.
        curve: of masonry, its push along the direction that is checked, until nothing is borne any more.
        store: the file of the campaign, for tasks.
        natural: whether the records were recorded. None does not know.

    Returns:
        The `DynamicCheck`, with `holds` and `table()`.

    Raises:
        TypeError, ValueError: for runs of unlike walls or effects or without ground motion, masonry without a curve or
            with one that ends too early, or tasks without a row.

    Warns:
        Implausible: for what the clause asks for and the runs lack.
    """
    if not isinstance(limit_state, str) or limit_state not in SHARE:
        raise ValueError(f"limit_state = {spelt(limit_state)} is not one of {', '.join(SHARE)}")
    require_kind("natural", natural, bool, type(None))
    require_kind("curve", curve, Push, type(None))
    if not is_iterable(runs) or not (given := list[Response | Analysis](runs)):
        raise TypeError(f"runs = {shown(runs)} is not a sequence of responses or tasks of a campaign")
    cases = _cases_of(given, curve)
    motions = [case.motion for case in cases if case.motion is not None]
    responses = [run for run in given if isinstance(run, Response)]
    if responses and store is not None:
        raise ValueError("store is for the tasks of a campaign, and runs are responses; leave it out")
    if curve is None:
        d_0, maxima = displacements_of(cast(Case, cases[0]), _shares(given, store))
    else:
        d_0, maxima = curve.d_0, [_along(run, cast(MasonryCase, run.case), curve.way) for run in responses]
    found = tuple(
        RunMaximum(motion.name, *signal, run.solver, d)
        for motion, signal, run, d in zip(motions, signals_of(cases), given, maxima, strict=True)
    )
    impacts = (impact.restitution for run in responses if curve is None for impact in run.impacts)
    known = tuple(e for e in impacts if not math.isnan(e))
    check = DynamicCheck(limit_state, d_0, found, known, natural)
    if check.lacking:
        warn_of(f"C8.7.1.2.1.9 asks for more: {'; '.join(check.lacking)}", Implausible)
    return check


def displacements_of(case: Case, shares: Sequence[float]) -> tuple[float, list[float]]:
    """d_0 of a wall and the largest displacements of its centroid [m], from its largest rotations over alpha [-]."""
    outer, inner = case.restoring
    alone = max(outer.alpha if case.side_stop else min(outer.alpha, inner.alpha), 0.0)
    return _moved(case.wall, alone), [_moved(case.wall, share * case.wall.alpha) for share in shares]


def _moved(wall: Block, rotation: float) -> float:
    """Displacement of the centroid at a rotation [m], infinite for a wall that has overturned."""
    return math.inf if math.isinf(rotation) else float(wall.pose([rotation])[0, 0])


def _along(run: Response, case: MasonryCase, way: Array) -> float:
    """Largest displacement of the centroid of the free blocks along a direction [m], infinite where a block fell."""
    return math.inf if run.fallen else max(float(of_centroid(case, run.pose, way).max()), 0.0)


def _cases_of(runs: Sequence[Response | Analysis], curve: Push | None) -> list[AnyCase]:
    """The cases of runs of one kind, which are of one wall or masonry with the same effects."""
    first = runs[0].case
    if curve is not None:
        _require_whole(curve)
    for i, run in enumerate(runs):
        require_kind(f"runs[{i}]", run, Response if isinstance(runs[0], Response) else Analysis)
        case = run.case
        if curve is None:
            require_wall(f"runs[{i}]", case, "curve, its push along the direction that is checked")
        elif case.built != curve.answer.case.built:
            raise ValueError(f"runs[{i}] is not of the masonry of curve")
        if case.motion is None:
            raise ValueError(f"runs[{i}] has no horizontal ground motion, of which the clause takes the maxima")
        if any(getattr(case, name, None) != getattr(first, name, None) for name in ("built", "side_stop", "effects")):
            raise ValueError(f"runs[{i}] has another wall, side stop, masonry or other effects than runs[0]")
    return [run.case for run in runs]


def _require_whole(curve: Push) -> None:
    """Refuse a curve that has no d_0."""
    if curve.unit != "-":
        raise ValueError("curve is that of an Actuator; push along a direction, which moves all blocks")
    if math.isnan(curve.d_0):
        raise ValueError(
            f"curve ends at {curve.displacement[-1]:.4g} m, where {curve.force[-1] / curve.peak:.0%} of its peak is "
            "borne; push on until nothing is"
        )


def _shares(runs: Sequence[Response | Analysis], store: str | Path | None) -> list[float]:
    """The largest rotation of each run over alpha [-], infinite for a wall that has overturned."""
    responses = [run for run in runs if isinstance(run, Response)]
    if responses:
        return [run.peak_over_alpha for run in responses]
    if store is None:
        raise ValueError("runs are tasks of a campaign; give its file as store")
    rows = results([run for run in runs if isinstance(run, Analysis)], store)
    done = [float(row["peak_over_alpha"]) for row in rows if row is not None and row["status"] == "done"]
    if len(done) < len(rows):
        raise ValueError(f"{len(rows) - len(done)} of {len(rows)} tasks have no row that is done in {store}; run them")
    return done


def _same(one: AnyCase, other: AnyCase) -> bool:
    """Whether two cases have one record, in either polarity of each horizontal component."""
    return one.vertical == other.vertical and all(
        now == then or (then is not None and now in then.polarities)
        for now, then in ((other.motion, one.motion), (other.transverse, one.transverse))
    )


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
