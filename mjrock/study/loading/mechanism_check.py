"""The kinematic check of a local mechanism on its push-over curve, linear and non-linear, after a code.

The code is that of a file, see `Code`; where none is given it is the Italian one, Circolare 21 gennaio 2019 n. 7,
C8.7.1.2.1, whose clauses this module cites.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from ...contacts.files import aligned
from ...notebook import html_of
from ...problem.ground.motion import GroundMotion
from ...problem.ground.spectrum import FloorSpectrum
from ...quantities import GRAVITY, Array, OneOf, Within, named, ratio_text, short_repr, within_ranges
from .code import CHECK_STEPS, OF_LIMIT_STATE, OF_MECHANISM, USUAL_CODE, Code, code_of, codes
from .demand import Demand, demanded_displacement, required_demands, starting_acceleration
from .mechanism_curve import Checked, curve_of
from .verdict import Step, Verdict, verdict_rows

METHODS = "linear", "nonlinear"
"""Methods of the kinematic check whose conditions may count alone."""
FREE, ON_FLOOR = "free_", "floor_"
"""How the keys of steps begin that are those of elements that vibrate freely, and of mechanisms on a floor."""
NOT_COUNTED = "does not count"
"""What stands beside a ratio of another method than that which counts."""


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
    def _is_on_floor(self) -> bool:
        """Whether the peak of the demand is that of a floor."""
        demand = self.demands.get(self.code.first)
        floor = demand.header.get("FLOOR") if isinstance(demand, GroundMotion) else isinstance(demand, FloorSpectrum)
        return bool(floor) and not self._is_free

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
        linear = [] if self._linear is None or not self.counts("linear") else [self._linear]
        nonlinear = map(self._nonlinear, self.states if self.counts("nonlinear") else ())
        return *linear, *nonlinear, *([] if self.damage is None else [self._damaged(self.damage)])

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
        values = [(key, "", getattr(self, key)) for key in OF_MECHANISM if not key.startswith((FREE, ON_FLOOR))]
        values += [("yields", tie, d) for tie, d in self.yielding.items()]
        values += [("breaks", tie, d) for tie, d in self.breaking.items()]
        for name, state in self.states.items():
            values += [(key, name, getattr(state, key)) for key in OF_LIMIT_STATE]
        ratios = {name: self._nonlinear(name).ratio for name in self.states if self.is_of_start(name)}
        values += [("ground_ratio", name, ratio) for name, ratio in ratios.items()]
        prefix, steps = FREE if self._is_free else ON_FLOOR if self._is_on_floor else "", []
        for key, owner, value in values:
            key = prefix + key if prefix + key in self.code.steps else key
            if value is not None and key in self.code.steps:
                unit = CHECK_STEPS[key].unit
                steps.append(
                    Step(key, value / GRAVITY if unit == "g" else value, self.code.step(key, owner).clause, unit, owner)
                )
        return tuple(steps)

    def broken_before(self, limit_state: str) -> list[str]:
        """Names of the ties that have broken at the capacity of a limit state."""
        return [tie for tie, d in self.breaking.items() if d <= self.states[limit_state].capacity]

    def table(self) -> str:
        """The steps with their clauses, as text. Capacity over demand is followed by HOLDS or FAILS."""
        return "\n".join(aligned(self._rows(), "<><"))

    def _repr_html_(self) -> str:
        return html_of(repr(self).strip("<>"), verdict_rows(self.verdicts), self._rows())

    def _rows(self) -> list[tuple[str, str, str]]:
        """The steps: what it is, its value, and its clause or its verdict."""
        rows = [("what moves", "", named(self.moving))] if self.moving else []
        rows += [("end of the curve, taken for d_0", "", self.ended)] if self.ended else []
        for step in self.steps:
            label = self.code.step(step.key, step.of).plain + (f" [{step.unit}]" if step.unit else "")
            is_ratio, digits = step.key.endswith("ratio"), CHECK_STEPS[step.key].digits
            rows.append((label, ratio_text(step.value) if is_ratio else f"{step.value:.{digits}f}", self._note(step)))
        return rows

    def _note(self, step: Step) -> str:
        """The verdict of a ratio, or the clause of another step."""
        if step.key == "damage_ratio" and self.damage is not None:
            return self._damaged(self.damage).label
        if step.key.endswith("linear_ratio") and self._linear is not None:
            return self._linear.label if self.counts("linear") else NOT_COUNTED
        if step.key == "ground_ratio" and self.counts("nonlinear"):
            return f"{self._nonlinear(step.of).label}, {step.clause}"
        if step.key != "ratio":
            return step.clause
        if not self.counts("nonlinear"):
            return NOT_COUNTED
        verdict = "see below" if self.is_of_start(step.of) else self._nonlinear(step.of).label
        broken = self.broken_before(step.of)
        return f"{verdict}, without {', '.join(broken)}, broken" if broken else verdict

    def __repr__(self) -> str:
        ratios = ", ".join(
            f"{check.limit_state} {ratio_text(check.ratio)} {check.label}"
            for check in map(self._nonlinear, self.states)
        )
        moving = f" of {named(self.moving)}" if self.moving else ""
        return f"<MechanismCheck{moving}: starts at {self.a_0 / GRAVITY:.4g} g, capacity over demand {ratios}>"


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
    demands = required_demands(demand, code)
    severe = demands[code.first]
    factor = code.confidence.checked(confidence_factor)
    T_0 = elastic_period
    peak, damage = starting_acceleration(severe, T_0, code), None
    if code.damage is not None and code.damage.state in demands:
        damage = starting_acceleration(demands[code.damage.state], T_0, code)
    curve = curve_of(case, code)
    d, a = curve.d, curve.multiplier * GRAVITY / (curve.participation * factor)
    if T_0 is not None:
        fine = np.union1d(d, np.linspace(0.0, float(d[-1]), 4001))
        d, a = fine, np.minimum(np.interp(fine, d, a), (2 * math.pi / T_0) ** 2 * fine)
    d_0 = float(d[-1])
    states = {}
    for name, rule in code.states.items():
        capacity = rule.share * d_0
        period = rule.period_at(capacity, float(np.interp(capacity, d, a)))
        states[name] = LimitState(capacity, period, demanded_displacement(demands[name], period, rule.damping, T_0))
    check = MechanismCheck(
        alpha_0=float(curve.multiplier[0]) if curve.slack is None else curve.slack,
        alpha_tied=curve.tied,
        participation=curve.participation,
        confidence_factor=factor,
        d=d,
        a=a,
        d_0=d_0,
        states=states,
        peak=peak,
        yielding=curve.yielding,
        breaking=curve.breaking,
        elastic_period=T_0,
        code=code,
        mechanism=case,
        demands=demands,
        moving=curve.moving,
        damage=damage,
        ended=curve.ended,
        method=method,
    )
    if method == "linear" and check.linear_ratio is None:
        raise ValueError(f"method = 'linear' needs a linear check in {code.name} and a demand whose peak is known")
    return check
