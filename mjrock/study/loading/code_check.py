"""The checks of a local mechanism after a code, clause by clause.

The code is that of a file, see `Code`; where none is given it is the Italian one, Circolare 21 gennaio 2019 n. 7,
C8.7.1.2.1, whose clauses this module cites. `mechanism_check` is the check on a push-over curve. The mechanism is the
single rigid block of a case, which stands on the ground or on a floor whose spectrum or motion is the demand, or a wall
that bends between two floors or side walls. `dynamic_check` is that by nonlinear dynamic analysis.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, NamedTuple, cast

import numpy as np

from ...contacts.files import aligned
from ...notebook import html_of
from ...problem.ground.motion import GroundMotion
from ...problem.ground.oscillator import SHORTEST_PERIOD
from ...problem.ground.spectrum import FloorSpectrum, SpectrumOfCode, response_spectrum
from ...problem.masonry.case import AnyCase, MasonryCase, require_wall
from ...problem.masonry.masonry import Masonry
from ...problem.wall.bending import HorizontalBending, VerticalBending
from ...problem.wall.block import Block
from ...problem.wall.case import Case
from ...problem.wall.effect import Anchored
from ...problem.wall.effects import link_effects
from ...problem.wall.restoring_moment import moment_at_strength
from ...problem.wall.wedge import Corner
from ...quantities import (
    GRAVITY,
    Array,
    Implausible,
    Message,
    OneOf,
    Within,
    is_iterable,
    listed,
    named,
    percent_text,
    ratio_text,
    require_kind,
    require_one_of,
    require_real,
    require_within,
    share_text,
    short_repr,
    shown,
    takes,
    warn_of,
    within_ranges,
)
from ...result.response import Response
from .code import CHECK_STEPS, OF_LIMIT_STATE, OF_MECHANISM, USUAL_CODE, Code, DynamicRule, code_of, codes
from .limit_analysis import MOVED, WEAKER, LimitCurve, collapse_multiplier
from .moving_part import MovingPart, multiplier_of
from .push import Push, of_centroid
from .pushover import falls_to_zero, pushover

if TYPE_CHECKING:  # tasks bring MuJoCo, which a kinematic check does not need
    from ..analysis import Analysis

PERIODS = 60
"""Periods at which the spectrum of a record is looked at, up to the equivalent period."""
SHORT = 0.05
"""Period from which on the spectrum of a record is looked at where T_0 is not known [s]."""
METHODS = "linear", "nonlinear"
"""Methods of the kinematic check whose conditions may count alone."""
NOT_COUNTED = "does not count"
"""What stands beside a ratio of another method than that which counts."""
Demand = GroundMotion | SpectrumOfCode | Callable[[float, float], float]
"""A record, the spectrum of a code on the ground or on a floor, or an elastic displacement spectrum S_De(T, xi) [m]."""


Checked = Case | Corner | VerticalBending | HorizontalBending | LimitCurve
"""What the check is of."""


def case_of(problem: Checked | AnyCase) -> AnyCase:
    """The case that stands for a mechanism where it is run: of a corner its wall and masses, of a wall that bends the
    wall, of a limit curve its masonry and effects."""
    if isinstance(problem, Corner):
        return problem.case
    if isinstance(problem, VerticalBending | HorizontalBending):
        return Case(problem.wall)
    if isinstance(problem, LimitCurve):
        assert problem.start.masonry is not None
        return MasonryCase(problem.start.masonry, 1.0, effects=problem.effects)
    return problem


class Step(NamedTuple):
    """One step of a check.

    Args:
        key: which it is, see `CHECK_STEPS`.
        value: in the unit.
        clause: where it stands in the code; none of a ratio.
        unit: of the value.
        of: the tie or the limit state that it is of.
    """

    key: str
    value: float
    clause: str = ""
    unit: str = ""
    of: str = ""


class Verdict(NamedTuple):
    """One condition of a check.

    Args:
        what: which it is.
        limit_state: of the code, such as "SLV".
        demand, capacity: in the unit.
        unit: of both.
        clause: where it stands in the code.
    """

    what: str
    limit_state: str
    demand: float
    capacity: float
    unit: str
    clause: str

    def __repr__(self) -> str:
        return (
            f"<{self.what}, {self.limit_state}: {self.capacity:.4g} for {self.demand:.4g} {self.unit}, "
            f"ratio {ratio_text(self.ratio)} {self.said}, {self.clause}>"
        )

    @property
    def ratio(self) -> float:
        """Capacity over demand [-]."""
        return self.capacity / self.demand if self.demand > 0 else math.inf

    @property
    def holds(self) -> bool:
        """Whether the capacity is at least the demand."""
        return self.ratio >= 1

    @property
    def said(self) -> str:
        """HOLDS or FAILS."""
        return "HOLDS" if self.holds else "FAILS"


def verdict_rows(verdicts: Sequence[Verdict]) -> list[tuple[str, ...]]:
    """Conditions as rows of a table: limit state, demand, capacity, ratio, HOLDS or FAILS, and the clause."""
    rows: list[tuple[str, ...]] = [("check", "state", "demand", "capacity", "unit", "ratio", "verdict", "clause")]
    for one in verdicts:
        numbers = f"{one.demand:.4f}", f"{one.capacity:.4f}", one.unit, ratio_text(one.ratio)
        rows.append((one.what, one.limit_state, *numbers, one.said, one.clause))
    return rows


def verdicts_of(verdicts: Sequence[Verdict]) -> str:
    """Conditions as a table in text, see `verdict_rows`."""
    return "\n".join(line.rstrip() for line in aligned(verdict_rows(verdicts), "<"))


@dataclass(frozen=True, eq=False)
class LimitState:
    """One limit state of the non-linear check.

    Args:
        capacity: spectral displacement that the mechanism may reach [m].
        period: equivalent period [s].
        demand: spectral displacement that the ground motion demands [m].
    """

    capacity: float
    period: float
    demand: float

    __repr__ = short_repr

    @property
    def ratio(self) -> float:
        """Capacity over demand [-]: the factor on the ground motion that uses the capacity up."""
        return self.capacity / self.demand if self.demand > 0 else math.inf


@dataclass(frozen=True, eq=False, repr=False)
class MechanismCheck:
    """Every step of the check.

    Args:
        alpha_0: multiplier that starts the mechanism [-], its ties slack.
        alpha_tied: the same with its ties at their strength, as forces on the mechanism; None without ties [-].
        participation: e*, the participating share of the mass [-].
        confidence_factor: FC [-].
        d: spectral displacements of the capacity curve [m], shape (n,).
        a: spectral accelerations [m/s2], shape (n,).
        d_0: spectral displacement at which the acceleration falls to zero [m]: that of the centroid over e*.
        states: the limit states of the code, by name.
        peak: peak acceleration of the demand, where the wall stands [m/s2]; None of a displacement spectrum. Of an
            element that vibrates freely it is the spectral acceleration at its period.
        yielding, breaking: displacement at which each tie yields and breaks [m], by name, of those that do up to d_0.
        elastic_period: T_0 of the elastic branch [s], None of a rigid start.
        code: what it is checked after.
        mechanism: what was checked, None where it is not known.
        demands: what each limit state was checked against, by name.
        moving: names of the blocks that move, whose common centroid d is of; none of a wall.
        damage: acceleration that the limit state of the start of the mechanism demands [m/s2], where it has a demand.
        ended: why the curve ends where something is borne, so that its end is taken for d_0; empty where nothing is.
        method: "linear" or "nonlinear" where the conditions of this method alone count; None counts all.
    """

    alpha_0: float
    alpha_tied: float | None
    participation: float
    confidence_factor: float
    d: Array
    a: Array
    d_0: float
    states: dict[str, LimitState]
    peak: float | None = None
    yielding: Mapping[str, float] = field(default_factory=dict)
    breaking: Mapping[str, float] = field(default_factory=dict)
    elastic_period: float | None = None
    code: Code = field(default_factory=code_of)
    mechanism: Checked | None = None
    demands: Mapping[str, Demand] = field(default_factory=dict)
    moving: tuple[str, ...] = ()
    damage: float | None = None
    ended: str = ""
    method: str | None = None

    @property
    def floor_peak(self) -> float | None:
        """The peak acceleration of the demand on a floor [m/s2]; None on the ground and of what vibrates freely."""
        return self.peak if self._is_on_floor else None

    @property
    def _is_on_floor(self) -> bool:
        """Whether the peak of the demand is that of a floor."""
        demand = self.demands.get(self.code.first)
        floor = demand.header.get("FLOOR") if isinstance(demand, GroundMotion) else isinstance(demand, FloorSpectrum)
        return bool(floor) and not self._is_free

    @property
    def free_peak(self) -> float | None:
        """The spectral acceleration at the period of an element that vibrates freely [m/s2]; None of another one."""
        return self.peak if self._is_free else None

    @property
    def _is_free(self) -> bool:
        """Whether it vibrates freely before it opens, and the code counts this."""
        return self.elastic_period is not None and self.code.damage is not None

    @property
    def damage_ratio(self) -> float | None:
        """Capacity over demand of the start of the mechanism [-]; None without a demand of its own."""
        return None if self.damage is None else self._damaged(self.damage).ratio

    def _damaged(self, demand: float) -> Verdict:
        """The condition of the start of the mechanism."""
        rule = self.code.damage
        assert rule is not None
        clause = rule.free_clause if self._is_free else rule.clause
        return Verdict("start of the mechanism", rule.state, demand, self.a_0, "m/s2", clause)

    @property
    def a_0(self) -> float:
        """Acceleration that starts the mechanism [m/s2]; the peak ground acceleration of its damage limit state."""
        return self._acceleration(self.alpha_0)

    @property
    def linear(self) -> float | None:
        """Peak ground acceleration of the linear check, q a_0 [m/s2], the ties slack; None of a code without one."""
        return None if self.code.linear is None else self.code.linear.behaviour * self.a_0

    @property
    def linear_tied(self) -> float | None:
        """The same with the ties at their strength [m/s2]; None without ties."""
        if self.alpha_tied is None or self.code.linear is None:
            return None
        return self.code.linear.behaviour * self._acceleration(self.alpha_tied)

    @property
    def linear_ratio(self) -> float | None:
        """Capacity over demand of the linear check [-], with the ties at their strength; None of a code without one,
        and where the peak acceleration of the demand is not known."""
        return None if self._linear is None else self._linear.ratio

    @property
    def floor_linear_ratio(self) -> float | None:
        """The same on a floor; None elsewhere."""
        return self.linear_ratio if self._is_on_floor else None

    @property
    def free_linear_ratio(self) -> float | None:
        """The same of an element that vibrates freely; None of another one."""
        return self.linear_ratio if self._is_free else None

    @property
    def ground_ratio(self) -> float:
        """a_g,SLV over a_g [-], C8.7.1.2.1.8: that of the displacements, and at least a_g,SLD over a_g, where the peak
        acceleration of the demand is known and the code lets it count."""
        return self._nonlinear(self.code.first).ratio

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """What counts: the linear check, where the code has one and the peak of the demand is known, the non-linear
        ones, and that of the start of the mechanism, where it has a demand.

        That of the SLV is the one of displacements, or where a_g,SLD is more than these allow, that of accelerations.
        """
        found = [] if self._linear is None or not self.counts("linear") else [self._linear]
        found += map(self._nonlinear, self.states if self.counts("nonlinear") else ())
        return *found, *([] if self.damage is None else [self._damaged(self.damage)])

    def counts(self, method: str) -> bool:
        """Whether the conditions of a method count."""
        return self.method in (None, method)

    @property
    def _linear(self) -> Verdict | None:
        """The condition of the linear check; None without one."""
        rule, capacity = self.code.linear, self.linear if self.linear_tied is None else self.linear_tied
        if self.peak is None or rule is None or capacity is None:
            return None
        return Verdict("linear kinematic", rule.state, self.peak, capacity, "m/s2", rule.clause)

    def _nonlinear(self, name: str) -> Verdict:
        """The non-linear condition of a limit state."""
        state = self.states[name]
        verdict = Verdict("nonlinear kinematic", name, state.demand, state.capacity, "m", self.code.clause)
        if self.peak and self.code.states[name].holds_until_start:
            start = verdict._replace(demand=self.peak, capacity=self.a_0, unit="m/s2")
            return start if start.ratio > verdict.ratio else verdict
        return verdict

    def is_of_start(self, name: str) -> bool:
        """Whether the acceleration that starts the mechanism allows more than the displacements of a limit state."""
        return self._nonlinear(name).unit != "m"

    def _acceleration(self, multiplier: float) -> float:
        """Spectral acceleration of a multiplier [m/s2], equation C8.7.1.8."""
        return multiplier * GRAVITY / (self.participation * self.confidence_factor)

    @property
    def steps(self) -> tuple[Step, ...]:
        """Every step with its clause, in the order of the check."""
        found = [(key, "", getattr(self, key)) for key in OF_MECHANISM]
        found += [("yields", tie, d) for tie, d in self.yielding.items()]
        found += [("breaks", tie, d) for tie, d in self.breaking.items()]
        for name, state in self.states.items():
            found += [(key, name, getattr(state, key)) for key in OF_LIMIT_STATE]
        found += [("ground_ratio", name, self._nonlinear(name).ratio) for name in self.states if self.is_of_start(name)]
        kind, steps = "free" if self._is_free else "floor" if self._is_on_floor else "", []
        for key, of, value in found:
            hidden = key in ("peak", "linear_ratio") and f"{kind}_{key}" in self.code.steps
            if value is not None and key in self.code.steps and not hidden:
                unit = CHECK_STEPS[key].unit
                value = value / GRAVITY if unit == "g" else value
                steps.append(Step(key, value, self.code.step(key, of).clause, unit, of))
        return tuple(steps)

    def broken_before(self, limit_state: str) -> list[str]:
        """Names of the ties that have broken at the capacity of a limit state."""
        return [tie for tie, d in self.breaking.items() if d <= self.states[limit_state].capacity]

    def table(self) -> str:
        """The steps with their clauses, as text. Capacity over demand is followed by HOLDS or FAILS."""
        return "\n".join(line.rstrip() for line in aligned(self._rows(), "<><"))

    def _repr_html_(self) -> str:
        return html_of(repr(self).strip("<>"), verdict_rows(self.verdicts), self._rows())

    def _rows(self) -> list[tuple[str, str, str]]:
        """The steps: what it is, its value, and its clause or its verdict."""
        rows = [("what moves", "", named(self.moving))] if self.moving else []
        rows += [("end of the curve, taken for d_0", "", self.ended)] if self.ended else []
        for step in self.steps:
            what, note = self.code.step(step.key, step.of).plain, step.clause
            if step.key.endswith("linear_ratio") and self._linear is not None:
                note = self._linear.said if self.counts("linear") else NOT_COUNTED
            elif step.key == "damage_ratio":
                note = self.verdicts[-1].said
            elif step.key == "ratio" and not self.counts("nonlinear"):
                note = NOT_COUNTED
            elif step.key == "ratio":
                note = "see below" if self.is_of_start(step.of) else self._nonlinear(step.of).said
                if gone := self.broken_before(step.of):
                    note += f", without {', '.join(gone)}, broken"
            elif step.key == "ground_ratio" and self.counts("nonlinear"):
                note = f"{self._nonlinear(step.of).said}, {note}"
            value = (
                ratio_text(step.value)
                if step.key.endswith("ratio")
                else f"{step.value:.{CHECK_STEPS[step.key].digits}f}"
            )
            rows.append((what + (f" [{step.unit}]" if step.unit else ""), value, note))
        return rows

    def __repr__(self) -> str:
        ratios = ", ".join(
            f"{one.limit_state} {ratio_text(one.ratio)} {one.said}" for one in map(self._nonlinear, self.states)
        )
        of = f" of {named(self.moving)}" if self.moving else ""
        return f"<MechanismCheck{of}: starts at {self.a_0 / GRAVITY:.4g} g, capacity over demand {ratios}>"


@within_ranges
def mechanism_check(
    case: Checked,
    demand: Demand | Mapping[str, Demand],
    *,
    confidence_factor: Annotated[float | None, Within(1, 3)] = None,
    elastic_period: Annotated[float | None, Within(1e-3, 5, "s")] = None,
    method: Annotated[str | None, OneOf(METHODS)] = None,
    code: Annotated[Code | str, OneOf(codes)] = USUAL_CODE,
) -> MechanismCheck:
    """The kinematic check of a wall as a local mechanism, linear and non-linear, by a code. Clauses that stand here are
    those of the Italian one, Circolare 2019 n. 7, C8.7.1.2.1.

    The push-over curve of the rigid wall becomes the capacity curve a(d) of an equivalent oscillator. Its displacement
    capacities are shares of the displacement at which it ends. The demand is the elastic displacement at an equivalent
    period: of a code's spectrum its value there, of a record the largest at any period up to it.

    Loads have no mass here, and give no horizontal force. Ties count along the curve with the strength they have until
    they break. In the linear check they stand twice: slack, as they are where rocking starts, and at their strength, a
    stabilising force on the mechanism in the equation of virtual work, for ties that are tensioned or have no slack. Of
    the two conditions of C8.7.1.2.1.6 only the share of d_0 is looked at: whether a beam loses its seat before is for
    the user. A mechanism on a floor (C8.7.1.2.1.4) takes `spectrum.at_height(...)` or `motion.through_building(...)` as
    its demand. The linear check compares 2 a_0 with the peak acceleration of the demand, where that is known, and of an
    element that vibrates freely with the spectral acceleration at T_0 (C8.7.1.2.1.7, C8.7.1.9). The damage limit state
    compares a_0 with the same of its own demand (C8.7.1.2.1.5).

    Of masonry of blocks the curve is that of `limit_curve`, one for each direction. alpha_0 and e* follow from the
    virtual displacements of the mechanism with which it begins, the displacement is that of the common centroid of the
    blocks that move in it, with the masses on them, and d is that over e* (C8.7.1.4). Ties pull with their strength
    along the curve, and are slack in alpha_0, of the same mechanism. Where blocks slide or another joint opens the
    mechanism is another one: the curve up to there is checked, with its end for d_0, as if nothing were borne beyond.

    Args:
        case: the wall and its effects, whose release and motion play no part, a corner, a wall that bends between
            floors or side walls, or the `LimitCurve` of masonry.
        demand: a record, a spectrum of `code_spectrum`, or a function S_De(T, xi) that gives the elastic displacement
            [m] of a spectrum. It is that of all limit states, or a mapping has one for each, "SLV" and "SLC", and may
            have one of the damage limit state, "SLD"; the linear check then takes that of its own, the SLV.
        confidence_factor: FC [-], 1 to 3, by NTC 2018 1 to 1.35; None takes 1.35, as the clause does where the strength
            of the masonry does not enter the curve. Another code has its own range, or none.
        elastic_period: T_0 of an element that vibrates freely before it opens, such as a parapet [s], 0.001 to 5; its
            curve begins with an elastic branch, a = (2 pi / T_0)^2 d, C8.7.1.6. None is a rigid start.
        method: "linear" or "nonlinear" where the conditions of this method alone count in the verdict. The clauses have
            both for the SLV, of which the designer takes one; the linear one has no SLC. None counts all.
        code: the name of a code that comes with the package, "NTC 2018", or a `Code`, such as one of your own file.

    Returns:
        The `MechanismCheck`, which prints in a line and as a table.

    Raises:
        TypeError, ValueError: for a value outside its range, a wall whose curve does not end, as its ties hold it, or a
            limit curve that was ended by `to` or ends as it begins.

    Warns:
        Implausible: for ties that still hold at d_SLC and raise it above d_0 of the wall without them, for a wall that
            is free both ways and is weaker inwards, and for a limit curve that ends while something is borne.

    Examples:
        >>> check = mr.mechanism_check(case, mr.code_spectrum("EC8 type 1", ag=1.0, soil="A"))
        >>> str(check).startswith('<MechanismCheck: starts at 0.1')
        True
    """
    code = code_of(code)
    demands = _by_limit_state(demand, code)
    severe = demands[code.first]
    factor = code.confidence.checked(confidence_factor)
    T_0 = elastic_period
    peak, damage = _starting(severe, T_0, code), None
    if code.damage is not None and code.damage.state in demands:
        damage = _starting(demands[code.damage.state], T_0, code)
    found = _mechanism_of(case, code)
    d, a = found.d, found.multiplier * GRAVITY / (found.participation * factor)
    if T_0 is not None:
        fine = np.union1d(d, np.linspace(0.0, float(d[-1]), 4001))
        d, a = fine, np.minimum(np.interp(fine, d, a), (2 * math.pi / T_0) ** 2 * fine)
    d_0 = float(d[-1])
    states = {}
    for name, rule in code.states.items():
        capacity = rule.share * d_0
        period = rule.period_at(capacity, float(np.interp(capacity, d, a)))
        states[name] = LimitState(capacity, period, _demanded(demands[name], period, rule.damping, T_0 or SHORT))
    alpha_0 = float(found.multiplier[0]) if found.slack is None else found.slack
    ties = found.yielding, found.breaking
    curve = alpha_0, found.tied, found.participation, factor, d, a, d_0, states
    check = MechanismCheck(*curve, peak, *ties, T_0, code, case, demands, found.moving, damage, found.ended, method)
    if method == "linear" and check.linear_ratio is None:
        raise ValueError(f"method = 'linear' needs a linear check in {code.name} and a demand whose peak is known")
    return check


class _Mechanism(NamedTuple):
    """What the check takes of a mechanism.

    Args:
        multiplier: along the curve [-], shape (n,).
        d: spectral displacements [m], shape (n,), C8.7.1.4.
        participation: e* [-], C8.7.1.5.
        tied: multiplier that starts it with the ties at their strength [-]; None without ties.
        yielding, breaking: displacement at which each tie yields and breaks [m], by name.
        slack: multiplier that starts it with the ties slack [-], where it is not the first of the curve.
        moving: names of the blocks that move.
        ended: why the curve ends where something is borne; empty where nothing is.
    """

    multiplier: Array
    d: Array
    participation: float
    tied: float | None = None
    yielding: Mapping[str, float] = MappingProxyType({})
    breaking: Mapping[str, float] = MappingProxyType({})
    slack: float | None = None
    moving: tuple[str, ...] = ()
    ended: str = ""


def _mechanism_of(case: Checked, code: Code) -> _Mechanism:
    """What the check takes of what it is given."""
    if isinstance(case, VerticalBending | HorizontalBending):
        return _of_bending(case)
    if isinstance(case, LimitCurve):
        return _of_blocks(case, code)
    return _of_wall(cast(Case, case_of(case)), code)


def _of_bending(bending: VerticalBending | HorizontalBending) -> _Mechanism:
    """A wall between floors or side walls. The curve is that of the common centroid, and d is its displacement over e*
    then, by C8.7.1.4 and C8.7.1.5."""
    curve, participation = bending.curve, bending.participation
    return _Mechanism(curve.multiplier, curve.displacement / participation, participation)


class _PartCurve(NamedTuple):
    """The curve of the part of masonry that moves, up to where nothing is borne or the curve ends.

    Args:
        part: what moves.
        masonry: it and the rest.
        displacement: of its centroid [m], shape (n,).
        multiplier: [-], shape (n,), zero at the last where nothing is borne.
        along: displacement of the limit curve at each [m], shape (n,).
    """

    part: MovingPart
    masonry: Masonry
    displacement: Array
    multiplier: Array
    along: Array

    @classmethod
    def of(cls, name: str, curve: LimitCurve) -> _PartCurve:
        """That of a limit curve; a ValueError with its name says if it bears nothing or has been ended."""
        masonry, borne = curve.start.masonry, curve.multiplier
        if curve.start.loads:
            raise ValueError(f"{name} = {curve!r} has loads; the check is of a horizontal force: give them as effects")
        if masonry is None or not curve.start.moving or not borne[0] > 0:
            raise ValueError(f"{name} = {curve!r} has no mechanism: nothing gives way, or nothing is borne")
        part = MovingPart.of(curve.start, masonry, curve.effects)
        moved, along = part.displacement(masonry, curve.pose), curve.displacement
        if borne[-1] > 0:
            return cls(part, masonry, moved, borne, along)
        last = int(np.flatnonzero(borne <= 0)[0])
        ends = (falls_to_zero(path[: last + 1], borne[: last + 1]) for path in (moved, along))
        moved, along = (np.append(path[:last], end) for path, end in zip((moved, along), ends, strict=True))
        return cls(part, masonry, moved, np.append(borne[:last], 0.0), along)

    @property
    def is_whole(self) -> bool:
        """Whether it goes on until nothing is borne."""
        return bool(self.multiplier[-1] == 0)


def _of_blocks(curve: LimitCurve, code: Code) -> _Mechanism:
    """Masonry of blocks, up to where nothing is borne, or where the mechanism cannot go on."""
    found = _PartCurve.of("case", curve)
    part, d = found.part, found.displacement / found.part.participation
    alpha_0 = multiplier_of(curve.start, found.masonry, curve.effects)
    if not found.is_whole:
        _require_some(curve, float(d[-1]), alpha_0, part.participation)
    pulled = any(link.law.holds for link in link_effects(curve.effects).values())
    yielding, breaking = (
        {tie: float(np.interp(at, found.along, d)) for tie, at in of.items() if at <= found.along[-1]}
        for of in curve.ties
    )
    last, rule = list(code.states.items())[-1]
    capacity = rule.share * float(d[-1])
    if _stands_by_ties(curve, found.masonry, int(np.searchsorted(d, capacity))):
        _warn_of_ties(link_effects(curve.effects), f"d_{last}", capacity, None, breaking)
    return _Mechanism(
        found.multiplier,
        d,
        part.participation,
        float(found.multiplier[0]) if pulled else None,
        yielding,
        breaking,
        alpha_0,
        part.names,
        "" if found.is_whole else curve.ended,
    )


def _require_some(curve: LimitCurve, d: float, alpha_0: float, participation: float) -> None:
    """Warn of a curve that ends at d [m] while something is borne; a ValueError says if that is where it begins."""
    if curve.ended.startswith(MOVED):
        raise ValueError(Message("case = {curve!r} was ended where something is borne; leave out to", curve=curve))
    if d <= 0:
        raise ValueError(
            Message(
                "case = {curve!r} ends as it begins. Of it the linear check alone can be made, with alpha_0 = "
                "{alpha_0:.4g} and e* = {participation:.4g}; check the limit states by runs, "
                "dynamic_check(runs, curve=push(masonry, direction, to))",
                curve=curve,
                alpha_0=alpha_0,
                participation=participation,
            )
        )
    warn_of(
        Message(
            "case ends at d = {d:.4g} m, where {multiplier:.4g} of the weight is borne: {ended}; the check "
            "takes that for d_0, and counts nothing beyond",
            d=d,
            multiplier=curve.multiplier[-1],
            ended=curve.ended,
        ),
        Implausible,
    )


def _of_wall(case: Case, code: Code) -> _Mechanism:
    """A wall that overturns, with its ties; ValueError if they hold it for good."""
    require_wall("case", case, "mr.limit_curve(masonry, direction)")
    curve = pushover(case)
    if not math.isfinite(curve.end):
        raise ValueError(
            Message("case has a push-over curve that does not end: its ties hold the wall; give them a strength")
        )
    warn_of_inner_edge(case, float(curve.multiplier[0]))
    wall = case.wall
    weights, heights = _masses(case)
    first, second = float(weights @ heights), float(weights @ heights**2)
    moved = wall.pose(curve.rotation)[:, 0]  # of the control point, the centroid
    d = moved * second / (wall.centroid_height * first)
    alone = float(wall.pose(np.array([max(case.restoring.outer.alpha, 0.0)]))[0, 0] * d[-1] / moved[-1])
    yielding, breaking = ({tie: float(np.interp(at, curve.rotation, d)) for tie, at in of.items()} for of in curve.ties)
    last, rule = list(code.states.items())[-1]
    _warn_of_ties(case.springs, f"d_{last}", rule.share * float(d[-1]), alone, breaking)
    tied = None
    if case.pulls:
        tied = float(curve.multiplier[0]) + moment_at_strength(case.pulls) / (wall.weight * wall.centroid_height)
    return _Mechanism(curve.multiplier, d, first**2 / (float(weights.sum()) * second), tied, yielding, breaking)


def warn_of_inner_edge(case: Case, outwards: float) -> None:
    """Warn of a wall that is free both ways and starts inwards at a lower multiplier than it bears outwards [-]."""
    inner = case.restoring.inner.P / (case.wall.weight * case.wall.centroid_height)
    if case.lopsided and inner < (1 - WEAKER) * outwards:
        warn_of(
            Message(
                "case has side_stop=False, and the check is of the way outwards, with {outwards:.4g} g; inwards "
                "the wall starts at {inner:.4g} g: check that way too, with the mirrored wall: the other plumb, "
                "offsets and forces with the other sign",
                outwards=outwards,
                inner=inner,
            ),
            Implausible,
        )


def _warn_of_ties(
    springs: Mapping[str, Anchored], name: str, capacity: float, alone: float | None, breaking: Mapping[str, float]
) -> None:
    """Warn of ties that still hold at the largest capacity [m], d_SLC of NTC 2018, where they raise it above the
    displacement `alone` at which the curve without ties ends [m]; None where that is known to be less. `breaking` has
    the displacement at which ties break [m]."""
    holding = [
        f"{name} (ultimate = {f'{tie.law.ultimate:g} m' if tie.law.ultimate < math.inf else None})"
        for name, tie in springs.items()
        if breaking.get(name, math.inf) > capacity
    ]
    if holding and (alone is None or capacity > alone):
        still = "{holding} would still hold there; say by `ultimate` how far a tie can be drawn out [m]"
        beyond = "{name} = {capacity:.3g} m is more than {alone:.3g} m, at which the curve without ties ends: {still}"
        ended = "{name} = {capacity:.3g} m lies where the curve without ties has ended: {still}"
        values = {"name": name, "capacity": capacity, "still": Message(still, holding=", ".join(holding))}
        warn_of(Message(ended, **values) if alone is None else Message(beyond, alone=alone, **values), Implausible)


def _stands_by_ties(curve: LimitCurve, masonry: Masonry, at: int) -> bool:
    """Whether masonry in a pose of its limit curve bears nothing without its ties."""
    if not (springs := link_effects(curve.effects)):
        return False
    others = [effect for effect in curve.effects if effect not in springs.values()]
    push = curve.start.direction
    way = push[:2] if masonry.in_space else float(push[0])
    try:
        return collapse_multiplier(masonry, way, effects=others, pose=curve.pose[at]).multiplier <= 0
    except ValueError:
        return False


def required_demands(demand: Demand | Mapping[str, Demand], code: Code | str | None = None) -> Mapping[str, Demand]:
    """The demand of each limit state of a code; a TypeError or ValueError says what is wrong with it."""
    return _by_limit_state(demand, code_of(USUAL_CODE if code is None else code))


def _by_limit_state(demand: Demand | Mapping[str, Demand], code: Code) -> Mapping[str, Demand]:
    """The demand of each limit state."""
    demands = demand if isinstance(demand, Mapping) else dict.fromkeys(code.states, demand)
    beside = set() if code.damage is None else {code.damage.state}
    if set(demands) - beside != set(code.states) - beside:
        needed = " and ".join(code.states)
        raise ValueError(f"demand has {', '.join(map(str, demands)) or 'none'}; a mapping needs {needed}")
    for name, one in demands.items():
        if not isinstance(one, GroundMotion) and not takes(one, 2):
            said = f"demand[{name!r}]" if demands is demand else "demand"
            raise TypeError(f"{said} = {shown(one)} is neither a GroundMotion nor a function S_De(T, xi)")
    return demands


def _masses(case: Case) -> tuple[Array, Array]:
    """Weights [N] and heights [m] of the wall and of the masses that the case adds to it."""
    added = [effect for effect in case.effects if effect.mass_added]
    weights = [case.block.mass, *(effect.mass_added for effect in added)]
    heights = [case.block.centroid_height, *(effect.height for effect in added)]
    return GRAVITY * np.array(weights), np.array(heights)


def _starting(demand: Demand, T_0: float | None, code: Code) -> float | None:
    """The acceleration that a demand has where a mechanism starts [m/s2]: its peak, None where it is not known, or of
    an element that vibrates freely with a period that of its spectrum there."""
    if T_0 is None or code.damage is None:
        return demand.peak if isinstance(demand, GroundMotion | SpectrumOfCode) else None
    if isinstance(demand, SpectrumOfCode):
        return float(demand(T_0, code.damage.damping))
    return (2 * math.pi / T_0) ** 2 * _demanded(demand, T_0, code.damage.damping, T_0)


def _demanded(demand: Demand, period: float, damping: float, shortest: float) -> float:
    """The displacement that a demand has at a period [m], of a record the largest from the shortest period on [s]."""
    if isinstance(demand, GroundMotion):
        periods = np.geomspace(max(min(shortest, period), SHORTEST_PERIOD), max(period, SHORTEST_PERIOD), PERIODS)
        return float(response_spectrum(demand, periods, damping).Sd.max())
    if isinstance(demand, SpectrumOfCode):
        return float(demand.displacement(period, damping))
    try:
        asked = require_real("demand(T, xi)", demand(period, damping))
    except (TypeError, ValueError) as error:
        raise type(error)(f"demand = {shown(demand)} gives no displacement for T, xi: {error}") from None
    return require_within("demand(T, xi)", asked, 0.0, 1e3, "m")


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
        return f"the centroid of {named(self.moving)} along {spelt_way(np.array(self.way))}" if self.moving else ""

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
        count, one_way, least = self.records, self.in_one_polarity, self.rule.records
        applies = {
            "records": (count < least, count),
            "polarity": (one_way > 0, one_way),
            "natural": (self.natural is False, count),
            "origin": (self.natural is None, count),
        }
        lacks = {key: number for key, (holds, number) in applies.items() if holds}
        said = (self.code.text(f"lacks_{key}", language, count=n, least=least) for key, n in lacks.items())
        return tuple(filter(None, said))

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
            said = f"{middle:.3f} in the median, {low:.3f} to {high:.3f} in nine of ten"
            lines.append(f"restitution |e| of {len(self.restitution)} impacts: {said}")
        lines += [f"judged: {self.judged}"] if self.judged else []
        lines += [f"lacking: {what}" for what in self.lacking]
        before = () if kinematic is None else kinematic.verdicts
        return "\n".join([*lines, verdicts_of((*before, *self.verdicts))])

    def _repr_html_(self) -> str:
        runs = [(one.name, f"{one.d:.4f}", share_text(one.d / self.d_0)) for one in self.runs]
        head = ("run", "displacement [m]", "of d_0")
        return html_of(repr(self).strip("<>"), verdict_rows(self.verdicts), [head, *runs])

    def __repr__(self) -> str:
        said = f"{self.limit_state} {'HOLDS' if self.holds else 'FAILS'}{f', {self.judged}' if self.judged else ''}"
        return (
            f"<DynamicCheck {said}: mean {self.mean:.4g} m of {self.capacity:.4g} m, "
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
    if not is_iterable(runs) or not (given := cast("list[Response | Analysis]", listed("runs", runs))):
        raise TypeError(f"runs = {shown(runs)} is not a sequence of responses or tasks of a campaign")
    cases = _cases_of(given, curve)
    motions = [case.motion for case in cases if case.motion is not None]
    responses = [run for run in given if isinstance(run, Response)]
    if responses and store is not None:
        raise ValueError("store is for the tasks of a campaign, and runs are responses; leave it out")
    if curve is None:
        case = cast(Case, cases[0])
        d_0, maxima = d_0_of(case), [displaced(case.wall, one * case.wall.alpha) for one in _peaks(given, store)]
    else:
        judged = _Judged.of(curve)
        d_0, maxima = judged.d_0, [judged.largest(one) for one in _moved(given, store, histories)]
        judged.warn_of_weaker_way()
    found = tuple(
        RunMaximum(motion.name, *signal, run.solver, d)
        for motion, signal, run, d in zip(motions, signals_of(cases), given, maxima, strict=True)
    )
    impacts = (impact.restitution for run in responses if curve is None for impact in run.impacts)
    known = tuple(e for e in impacts if not math.isnan(e))
    moved = {} if curve is None else {"moving": judged.blocks, "way": tuple(judged.way.tolist())}
    check = DynamicCheck(limit_state, d_0, found, known, natural, code, cases[0], **moved)
    if check.lacking:
        warn_of(
            Message(
                "{clause} asks for more: {lacking}", clause=rule.clause or code.name, lacking="; ".join(check.lacking)
            ),
            Implausible,
        )
    return check


def _dynamic_rule(code: Code) -> DynamicRule:
    """What a code demands of dynamic runs; ValueError for one without a check by them."""
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


def spelt_way(way: Array) -> str:
    """A direction as text, (1, 0)."""
    return f"({', '.join(f'{part + 0.0:.3g}' for part in way.tolist())})"


class _Judged(NamedTuple):
    """What of masonry is judged in runs: the centroid of some blocks along a direction, shape (d,), and its d_0 [m]."""

    masonry: Masonry
    blocks: tuple[str, ...]
    way: Array
    d_0: float

    @classmethod
    def of(cls, curve: LimitCurve | Push) -> _Judged:
        """The blocks that move in a limit curve, or all free ones in a push."""
        if isinstance(curve, LimitCurve):
            found = _PartCurve.of("curve", curve)
            if not found.is_whole:
                raise ValueError(
                    f"curve = {curve!r} ends where something is borne; give it up to where nothing is, or take the "
                    "push of masonry that slides"
                )
            return cls(found.masonry, found.part.names, found.part.way, float(found.displacement[-1]))
        masonry = cast(MasonryCase, curve.answer.case).masonry
        return cls(masonry, tuple(masonry.names[i] for i in masonry.free), curve.way, curve.d_0)

    def warn_of_weaker_way(self) -> None:
        """Warn of masonry that bears less the other way on its own weight."""
        plan = self.way[:2] if self.masonry.in_space else float(self.way[0])
        with contextlib.suppress(ValueError):  # it stands by its effects alone
            along, back = (collapse_multiplier(self.masonry, way).multiplier for way in (plan, -plan))
            if back < (1 - WEAKER) * along:
                warn_of(
                    f"curve goes along {spelt_way(self.way)}, where the masonry bears {along:.4g} g on its own weight; "
                    f"along {spelt_way(-self.way)} it bears {back:.4g} g: check that way too, with a curve along it",
                    Implausible,
                )

    def largest(self, moved: _Moved) -> float:
        """Its largest displacement in a run [m], infinite where a block fell."""
        case, pose, fell = moved
        return math.inf if fell else max(float(of_centroid(case, pose, self.way, self.blocks).max()), 0.0)


class _Moved(NamedTuple):
    """What a check takes of a run of masonry: its case, its poses at the samples, and whether a block fell."""

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
    responses = [run for run in runs if isinstance(run, Response)]
    if responses:
        return [run.peak_over_alpha for run in responses]
    if store is None:
        raise ValueError("runs are tasks of a campaign; give its file as store")
    from ..campaign.campaign import results

    rows = results([run for run in runs if not isinstance(run, Response)], store)
    done = [float(row["peak_over_alpha"]) for row in rows if row is not None and row["status"] == "done"]
    if len(done) < len(rows):
        raise ValueError(f"{len(rows) - len(done)} of {len(rows)} tasks have no row that is done in {store}; run them")
    return done


def _moved(runs: Sequence[Response | Analysis], store: str | Path | None, histories: str | Path | None) -> list[_Moved]:
    """What runs of masonry have moved, of tasks as their rows and histories have it."""
    if isinstance(runs[0], Response):
        return [_Moved(cast(MasonryCase, run.case), run.pose, bool(run.fallen)) for run in runs]  # type: ignore[union-attr]
    if store is None or histories is None:
        raise ValueError("runs are tasks of a campaign of masonry; give its file as store and its folder as histories")
    from ..campaign.campaign import results

    found = []
    for task, row in zip(runs, results(cast("list[Analysis]", runs), store), strict=True):
        file = Path(histories) / f"{'' if row is None else row['key']}.npz"
        if row is None or row["status"] != "done" or not file.exists():
            raise ValueError(f"{task!r} has no row that is done in {store}, or no history in {histories}; run it")
        with np.load(file) as arrays:
            found.append(_Moved(cast(MasonryCase, task.case), arrays["pose"], bool(row["fallen"])))
    return found


def _of_one_record(one: AnyCase, other: AnyCase) -> bool:
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
        number = next((i for i, first in enumerate(firsts) if _of_one_record(first, case)), len(firsts))
        if number == len(firsts):
            firsts.append(case)
        signals.append((number, case.motion != firsts[number].motion))
    return signals
