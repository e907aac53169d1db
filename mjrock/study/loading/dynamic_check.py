"""The check of a wall or of masonry by nonlinear dynamic runs, after a code."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from ...notebook import html_of
from ...problem.masonry.case import AnyCase, MasonryCase, require_wall
from ...problem.masonry.masonry import Masonry
from ...problem.wall.block import Block
from ...problem.wall.case import Case
from ...quantities import (
    Array,
    Implausible,
    is_iterable,
    listed,
    named,
    percent_text,
    require_kind,
    require_one_of,
    share_text,
    shown,
    warn_of,
)
from ...result.response import Response
from .code import USUAL_CODE, Code, DynamicRule, code_of
from .limit_analysis import WEAKER, LimitCurve, collapse_multiplier
from .mechanism_check import MechanismCheck
from .mechanism_curve import PartCurve
from .push import Push, of_centroid
from .verdict import Verdict, verdict_rows, verdicts_of

if TYPE_CHECKING:  # tasks bring MuJoCo, which a kinematic check does not need
    from ..analysis import Analysis
    from ..campaign.task import Row


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
        limit_state: of the code, such as "SLV".
        d_0: displacement of the centroid at which nothing brings the wall back [m]. Over e* it is `MechanismCheck.d_0`.
        runs: the largest displacement of each run.
        restitution: |e| of all impacts of the responses [-], shape (n,); none is known of masonry and of rows of a
            campaign.
        natural: whether the records are natural ones; None if it is not known.
        code: what it is checked after, which has a check by dynamic runs.
        case: that of the first run, whose wall or masonry and effects all runs have; None where it is not known.
        moving: of masonry, names of the blocks whose common centroid is displaced; none of a wall.
        way: unit vector along which it is displaced, shape (d,); empty of a wall.
    """

    limit_state: str
    d_0: float
    runs: tuple[RunMaximum, ...]
    restitution: tuple[float, ...]
    natural: bool | None
    code: Code = field(default_factory=code_of)
    case: AnyCase | None = None
    moving: tuple[str, ...] = ()
    way: tuple[float, ...] = ()

    @property
    def judged(self) -> str:
        """Of masonry, what is displaced and which way, in words; empty of a wall."""
        return f"the centroid of {named(self.moving)} along {direction_text(np.array(self.way))}" if self.moving else ""

    @property
    def share(self) -> float:
        """What the mean may reach over d_0 [-]."""
        return self.code.states[self.limit_state].share

    @property
    def rule(self) -> DynamicRule:
        """What the code demands of dynamic runs."""
        return _dynamic_rule(self.code)

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
        """What the code demands of dynamic runs and these lack, in English, C8.7.1.2.1.9."""
        return self.lacking_in("en")

    def lacking_in(self, language: str) -> tuple[str, ...]:
        """What the code demands of dynamic runs and these lack, in a language of the code."""
        count, one_way, needed = self.records, self.in_one_polarity, self.rule.records
        applies = {
            "records": (count < needed, count),
            "polarity": (one_way > 0, one_way),
            "natural": (self.natural is False, count),
            "origin": (self.natural is None, count),
        }
        lacks = {key: number for key, (holds, number) in applies.items() if holds}
        texts = (self.code.text(f"lacks_{key}", language, count=n, least=needed) for key, n in lacks.items())
        return tuple(filter(None, texts))

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
        """The displacement that the mean may reach, of NTC 2018 0.4 d_0 at the SLV and 0.6 d_0 at the SLC [m]."""
        return self.share * self.d_0

    @property
    def holds(self) -> bool:
        """Whether no run exceeds d_0 and the mean of the maxima stays within the capacity."""
        return all(verdict.holds for verdict in self.verdicts)

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """The two conditions."""
        largest, clause = max(run.d for run in self.runs), self.rule.clause
        return (
            Verdict("dynamic, largest run", self.limit_state, largest, self.d_0, "m", clause),
            Verdict("dynamic, mean of maxima", self.limit_state, self.mean, self.capacity, "m", clause),
        )

    def table(self, kinematic: MechanismCheck | None = None) -> str:
        """The runs, the restitution of their impacts, what is lacking and the verdicts, as text.

        Args:
            kinematic: a check of the same wall, whose verdicts then stand above.
        """
        require_kind("kinematic", kinematic, MechanismCheck, type(None))
        lines = [f"{run.solver}, {run.name}: {run.d:.4f} m, {share_text(run.d / self.d_0)} d_0" for run in self.runs]
        lines.append(f"d_0 of the centroid: {self.d_0:.4f} m; over e* it is that of the curve a(d)")
        if self.restitution:
            low, middle, high = np.percentile(self.restitution, [5, 50, 95])
            spread = f"{middle:.3f} in the median, {low:.3f} to {high:.3f} in nine of ten"
            lines.append(f"restitution |e| of {len(self.restitution)} impacts: {spread}")
        lines += [f"judged: {self.judged}"] if self.judged else []
        lines += [f"lacking: {lack}" for lack in self.lacking]
        before = () if kinematic is None else kinematic.verdicts
        return "\n".join([*lines, verdicts_of((*before, *self.verdicts))])

    def _repr_html_(self) -> str:
        runs = [(run.name, f"{run.d:.4f}", share_text(run.d / self.d_0)) for run in self.runs]
        head = ("run", "displacement [m]", "of d_0")
        return html_of(repr(self).strip("<>"), verdict_rows(self.verdicts), [head, *runs])

    def __repr__(self) -> str:
        verdict = f"{self.limit_state} {'HOLDS' if self.holds else 'FAILS'}{f', {self.judged}' if self.judged else ''}"
        return (
            f"<DynamicCheck {verdict}: mean {self.mean:.4g} m of {self.capacity:.4g} m, "
            f"{len(self.exceeded)} of {len(self.runs)} runs beyond d_0 = {self.d_0:.4g} m of the centroid>"
        )


def dynamic_check(
    runs: Sequence[Response] | Sequence[Analysis],
    limit_state: str = "SLV",
    *,
    curve: LimitCurve | Push | None = None,
    store: str | Path | None = None,
    histories: str | Path | None = None,
    natural: bool | None = None,
    code: Code | str = USUAL_CODE,
) -> DynamicCheck:
    """The check of a wall or of masonry by nonlinear dynamic analysis, by a code. Clauses that stand here are those of
    the Italian one, Circolare 2019 n. 7, C8.7.1.2.1.9.

    The limit state holds if no run exceeds d_0, and if the mean of the largest displacements is at most 0.4 d_0 at the
    SLV and 0.6 d_0 at the SLC (C8.7.1.2.1.6). d_0 is the displacement of the centroid at which weight, loads and
    thrusts bring the wall back no more. Ties act in the runs, and do not raise d_0, of which the clause counts only
    what is known to hold up to collapse. The worse of both polarities of a record enters the mean, which is on the
    safe side of the clause.

    Of masonry of many blocks d_0 is that of its `limit_curve` along a direction, of the common centroid of the blocks
    that move in the mechanism, and the maxima are those of the same centroid along that direction. Where joints slide,
    so that a limit curve ends early, it is that of its `push`, of the common centroid of all free blocks. Leave ties
    out of the curve, and give it what else is constant. A run from which a block has fallen exceeds d_0. Masonry that
    may go either way is checked with the curve either way.

    The clause demands more records than the global response, natural ones that fit the spectrum together, and a
    restitution of mechanism and slenderness. A warning names what the runs lack of it. Whether they fit the spectrum is
    for the user, see `RecordSet.mean_over`.

    Args:
        runs: responses of one wall or masonry with the same effects, of any solver, or the `Analysis` tasks of a
            campaign.
        limit_state: "SLV" or "SLC", or one of another code, whose spectrum the records fit.
        curve: of masonry, its limit curve or push along the direction that is checked, until nothing is borne any more.
        store: the file of the campaign, for tasks.
        histories: the folder of its time histories, for tasks of masonry.
        natural: whether the records are natural ones. None if it is not known.
        code: the name of a code that comes with the package, "NTC 2018", or a `Code`.

    Returns:
        The `DynamicCheck`, with `holds` and `table()`.

    Raises:
        TypeError, ValueError: for runs of unlike walls or effects or without ground motion, masonry without a curve or
            with one that ends too early, or tasks without a row.

    Warns:
        Implausible: for what the clause demands and the runs lack.
    """
    code = code_of(code)
    rule = _dynamic_rule(code)
    require_one_of("limit_state", limit_state, code.states)
    require_kind("natural", natural, bool, type(None))
    require_kind("curve", curve, LimitCurve, Push, type(None))
    if not is_iterable(runs) or not (items := cast("list[Response | Analysis]", listed("runs", runs))):
        raise TypeError(f"runs = {shown(runs)} is not a sequence of responses or tasks of a campaign")
    cases = _cases_of(items, curve)
    motions = [case.motion for case in cases if case.motion is not None]
    responses = [run for run in items if isinstance(run, Response)]
    if responses and store is not None:
        raise ValueError("store is for the tasks of a campaign, and runs are responses; leave it out")
    if curve is None:
        case = cast(Case, cases[0])
        d_0, maxima = (
            d_0_of(case),
            [displaced(case.wall, peak * case.wall.alpha) for peak in _peaks(items, store)],
        )
    else:
        centroid = MovingCentroid.from_curve(curve)
        d_0, maxima = centroid.d_0, [centroid.largest(run) for run in _masonry_runs(items, store, histories)]
        centroid.warn_of_weaker_direction()
    run_maxima = tuple(
        RunMaximum(motion.name, *signal, run.solver, d)
        for motion, signal, run, d in zip(motions, signals_of(cases), items, maxima, strict=True)
    )
    impacts = (impact.restitution for run in responses if curve is None for impact in run.impacts)
    known = tuple(e for e in impacts if not math.isnan(e))
    moved = {} if curve is None else {"moving": centroid.blocks, "way": tuple(centroid.direction.tolist())}
    check = DynamicCheck(limit_state, d_0, run_maxima, known, natural, code, cases[0], **moved)
    if check.lacking:
        warn_of(f"{rule.clause or code.name} requires more: {'; '.join(check.lacking)}", Implausible)
    return check


def _dynamic_rule(code: Code) -> DynamicRule:
    """What a code demands of dynamic runs. Raises a ValueError for one without a check by them."""
    if code.dynamic is None:
        raise ValueError(f"code = {code.name} has no check by dynamic runs")
    return code.dynamic


def d_0_of(case: Case) -> float:
    """Displacement of the centroid of a wall at which nothing but its ties brings it back [m]."""
    outer, inner = case.restoring
    return displaced(case.wall, max(outer.alpha if case.side_stop else min(outer.alpha, inner.alpha), 0.0))


def displaced(wall: Block, rotation: float) -> float:
    """Displacement of the centroid at a rotation [m], infinite for a wall that has overturned."""
    return math.inf if math.isinf(rotation) else float(wall.pose([rotation])[0, 0])


def direction_text(direction: Array) -> str:
    """A direction as text, (1, 0)."""
    return f"({', '.join(f'{part + 0.0:.3g}' for part in direction.tolist())})"


class MovingCentroid(NamedTuple):
    """The centroid of some blocks of masonry, its direction, shape (d,), and its d_0 [m]."""

    masonry: Masonry
    blocks: tuple[str, ...]
    direction: Array
    d_0: float

    @classmethod
    def from_curve(cls, curve: LimitCurve | Push) -> MovingCentroid:
        """The blocks that move in a limit curve, or all free ones in a push."""
        if isinstance(curve, LimitCurve):
            moving = PartCurve.from_curve("curve", curve)
            if not moving.is_whole:
                raise ValueError(
                    f"curve = {curve!r} ends where something is borne; give it up to where nothing is, or take the "
                    "push of masonry that slides"
                )
            return cls(moving.masonry, moving.part.names, moving.part.direction, float(moving.displacement[-1]))
        masonry = cast(MasonryCase, curve.answer.case).masonry
        return cls(masonry, tuple(masonry.names[i] for i in masonry.free), curve.way, curve.d_0)

    def warn_of_weaker_direction(self) -> None:
        """Warn of masonry that bears less the other way on its own weight."""
        plan = self.direction[:2] if self.masonry.in_space else float(self.direction[0])
        with contextlib.suppress(ValueError):  # it stands by its effects alone
            along, back = (collapse_multiplier(self.masonry, sense).multiplier for sense in (plan, -plan))
            if back < (1 - WEAKER) * along:
                warn_of(
                    f"curve goes along {direction_text(self.direction)}, where the masonry bears {along:.4g} g on its "
                    f"own weight; along {direction_text(-self.direction)} it bears {back:.4g} g: check that way too, "
                    "with a curve along it",
                    Implausible,
                )

    def largest(self, moved: MasonryRun) -> float:
        """Its largest displacement in a run [m], infinite where a block fell."""
        case, pose, fell = moved
        return math.inf if fell else max(float(of_centroid(case, pose, self.direction, self.blocks).max()), 0.0)


class MasonryRun(NamedTuple):
    """A run of masonry: its case, its poses at the samples, and whether a block fell."""

    case: MasonryCase
    pose: Array
    fell: bool


def _cases_of(runs: Sequence[Response | Analysis], curve: LimitCurve | Push | None) -> list[AnyCase]:
    """The cases of runs of one kind, which are of one wall or masonry with the same effects."""
    from ..analysis import Analysis

    require_kind("runs[0]", runs[0], Response, Analysis)
    first, masonry = runs[0].case, None
    if isinstance(curve, Push):
        _require_whole(curve)
        masonry = curve.answer.case.built
    elif curve is not None:
        masonry = curve.start.masonry
    for i, run in enumerate(runs):
        require_kind(f"runs[{i}]", run, Response if isinstance(runs[0], Response) else Analysis)
        case = run.case
        if curve is None:
            require_wall(f"runs[{i}]", case, "curve, its limit_curve or push along the direction that is checked")
        elif case.built != masonry:
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
            f"curve ends at {curve.displacement[-1]:.4g} m, where {percent_text(curve.force[-1] / curve.peak)} of its "
            "peak is borne; push on until nothing is"
        )


def _peaks(runs: Sequence[Response | Analysis], store: str | Path | None) -> list[float]:
    """The largest rotation of each run over alpha [-], infinite for a wall that has overturned."""
    if isinstance(runs[0], Response):
        return [cast(Response, run).peak_over_alpha for run in runs]
    return [float(row["peak_over_alpha"]) for row in _rows(cast("list[Analysis]", runs), store)]


def _masonry_runs(
    runs: Sequence[Response | Analysis], store: str | Path | None, histories: str | Path | None
) -> list[MasonryRun]:
    """Runs of masonry, those of a campaign from its rows and histories."""
    if isinstance(runs[0], Response):
        return [MasonryRun(cast(MasonryCase, run.case), run.pose, bool(run.fallen)) for run in runs]  # type: ignore[union-attr]
    if histories is None:
        raise ValueError("runs are tasks of a campaign of masonry; give its file as store and its folder as histories")
    masonry_runs = []
    for task, row in zip(runs, _rows(cast("list[Analysis]", runs), store), strict=True):
        file = Path(histories) / f"{row['key']}.npz"
        if not file.exists():
            raise ValueError(f"{task!r} has no history in {histories}; run it with that folder as histories")
        with np.load(file) as arrays:
            masonry_runs.append(MasonryRun(cast(MasonryCase, task.case), arrays["pose"], bool(row["fallen"])))
    return masonry_runs


def _rows(tasks: Sequence[Analysis], store: str | Path | None) -> list[Row]:
    """The row of each task of a campaign."""
    if store is None:
        raise ValueError("runs are tasks of a campaign; give its file as store")
    from ..campaign.campaign import results

    rows = [row for row in results(tasks, store) if row is not None and row["status"] == "done"]
    if len(rows) < len(tasks):
        raise ValueError(
            f"{len(tasks) - len(rows)} of {len(tasks)} tasks have no row that is done in {store}; run them"
        )
    return rows


def _share_record(one: AnyCase, other: AnyCase) -> bool:
    """Whether two cases have one record, in either polarity of each horizontal component."""
    return one.vertical == other.vertical and all(
        motion == first_motion or (first_motion is not None and motion in first_motion.polarities)
        for motion, first_motion in ((other.motion, one.motion), (other.transverse, one.transverse))
    )


def signals_of(cases: Sequence[AnyCase]) -> list[tuple[int, bool]]:
    """The number of the record of each case, and whether its motion is that of the first such case, reversed."""
    firsts: list[AnyCase] = []
    signals = []
    for case in cases:
        number = next((i for i, first in enumerate(firsts) if _share_record(first, case)), len(firsts))
        if number == len(firsts):
            firsts.append(case)
        signals.append((number, case.motion != firsts[number].motion))
    return signals
