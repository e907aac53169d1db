"""The check of a local mechanism on its push-over curve, after the Italian commentary C8.7.1.2.1, clause by clause.

The clauses are those of Circolare 21 gennaio 2019 n. 7. The mechanism is the single rigid block of a case, which stands
on the ground or on a floor whose spectrum or motion is the demand, or a wall that bends between two floors or side
walls.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...files import aligned
from ...notebook import html_of
from ...problem.ground.motion import GroundMotion
from ...problem.ground.oscillator import SHORTEST_PERIOD
from ...problem.ground.spectrum import SpectrumOfCode, response_spectrum
from ...problem.masonry.case import require_wall
from ...problem.wall.bending import HorizontalBending, VerticalBending
from ...problem.wall.case import Case
from ...problem.wall.restoring_moment import moment_at_strength
from ...problem.wall.wedge import Corner
from ...quantities import (
    GRAVITY,
    Array,
    Implausible,
    ratio_said,
    require_real,
    require_within,
    short_repr,
    shown,
    takes,
)
from .pushover import pushover

SHARE = {"SLV": 0.4, "SLC": 0.6}
"""Displacement capacity over that at which the curve ends [-], C8.7.1.2.1.6."""
PERIOD = {"SLV": 1.68 * math.pi, "SLC": 1.56 * math.pi}
"""Factor of the equivalent period [-], equations C8.7.1.10 and C8.7.1.11."""
DAMPING = {"SLV": 0.08, "SLC": 0.10}
"""Equivalent damping ratio [-], C8.7.1.2.1.8."""
BEHAVIOUR = 2.0
"""Behaviour factor q of the linear check [-], C8.7.1.2.1.7."""
PERIODS = 60
"""Periods at which the spectrum of a record is looked at, up to the equivalent period."""

SHORT = 0.05
"""Period from which on the spectrum of a record is looked at where T_0 is not known [s]."""

Demand = GroundMotion | SpectrumOfCode | Callable[[float, float], float]
"""A record, the spectrum of a code on the ground or on a floor, or an elastic displacement spectrum S_De(T, xi) [m]."""


class Step(NamedTuple):
    """One step of a check.

    Args:
        key: which it is, see `SAID`.
        value: in the unit.
        clause: where it stands in the Circolare; none of a ratio.
        unit: of the value.
        of: the tie or the limit state that it is of.
    """

    key: str
    value: float
    clause: str = ""
    unit: str = ""
    of: str = ""


SAID = {
    "alpha_0": ("multiplier alpha_0", 4),
    "participation": ("participating mass e*", 4),
    "confidence_factor": ("confidence factor FC", 2),
    "a_0": ("a_0 = alpha_0 g / (e* FC), SLD", 4),
    "linear": ("linear SLV, q a_0 with q = 2", 4),
    "alpha_tied": ("alpha_0, ties at their strength", 4),
    "linear_tied": ("linear SLV, ties at their strength", 4),
    "peak": ("peak of the demand, a_g S or a_Z", 4),
    "linear_ratio": ("capacity over demand SLV, linear", 2),
    "elastic_period": ("elastic branch up to the curve, T_0", 3),
    "d_0": ("d_0", 4),
    "yields": ("{of} yields at d", 4),
    "breaks": ("{of} breaks at d", 4),
    "capacity": ("d_{of} = {share:.1f} d_0", 4),
    "period": ("T_{of}", 3),
    "demand": ("demand, xi = {damping:.0%}", 4),
    "ratio": ("capacity over demand {of}", 2),
    "ground_ratio": ("a_g,SLV / a_g, at least a_g,SLD / a_g", 2),
}
"""What a table says of each step, and its decimals."""


class Verdict(NamedTuple):
    """One condition of a check.

    Args:
        what: which it is.
        limit_state: "SLV" or "SLC".
        demand, capacity: in the unit.
        unit: of both.
        clause: where it stands in the Circolare.
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
            f"ratio {ratio_said(self.ratio)} {self.said}, {self.clause}>"
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
    rows += [
        (
            *(one.what, one.limit_state, f"{one.demand:.4f}", f"{one.capacity:.4f}", one.unit, ratio_said(one.ratio)),
            *(one.said, one.clause),
        )
        for one in verdicts
    ]
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
        demand: spectral displacement that the ground motion asks for [m].
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
        d_0: displacement at which the acceleration falls to zero [m].
        states: the limit states SLV and SLC.
        peak: peak acceleration of the demand, where the wall stands [m/s2]; None of a displacement spectrum.
        yielding, breaking: displacement at which each tie yields and breaks [m], by name, of those that do up to d_0.
        elastic_period: T_0 of the elastic branch [s], None of a rigid start.
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

    @property
    def a_0(self) -> float:
        """Acceleration that starts the mechanism [m/s2]; the peak ground acceleration of its damage limit state."""
        return self._acceleration(self.alpha_0)

    @property
    def linear(self) -> float:
        """Peak ground acceleration of the linear check of the SLV with q = 2 [m/s2], the ties slack."""
        return BEHAVIOUR * self.a_0

    @property
    def linear_tied(self) -> float | None:
        """The same with the ties at their strength [m/s2]; None without ties."""
        return None if self.alpha_tied is None else BEHAVIOUR * self._acceleration(self.alpha_tied)

    @property
    def linear_ratio(self) -> float | None:
        """Capacity over demand of the linear check of the SLV [-], with the ties at their strength; None where the peak
        acceleration of the demand is not known."""
        if self.peak is None:
            return None
        capacity = self.linear if self.linear_tied is None else self.linear_tied
        return capacity / self.peak if self.peak > 0 else math.inf

    @property
    def ground_ratio(self) -> float:
        """a_g,SLV over a_g [-], C8.7.1.2.1.8: that of the displacements, and at least a_g,SLD over a_g, where the peak
        acceleration of the demand is known."""
        least = self.a_0 / self.peak if self.peak else 0.0
        return max(self.states["SLV"].ratio, least)

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """The linear check of the SLV, where the peak of the demand is known, and the non-linear ones.

        That of the SLV is the one of displacements, or where a_g,SLD is more than these allow, that of accelerations.
        """
        slv, slc, found = self.states["SLV"], self.states["SLC"], list[Verdict]()
        if self.peak is not None:
            capacity = self.linear if self.linear_tied is None else self.linear_tied
            found.append(Verdict("linear kinematic", "SLV", self.peak, capacity, "m/s2", "C8.7.1.2.1.7"))
        of_slv = slv.demand, slv.capacity, "m"
        if self.peak is not None and self.ground_ratio > slv.ratio:
            of_slv = self.peak, self.a_0, "m/s2"
        found.append(Verdict("nonlinear kinematic", "SLV", *of_slv, "C8.7.1.2.1.8"))
        found.append(Verdict("nonlinear kinematic", "SLC", slc.demand, slc.capacity, "m", "C8.7.1.2.1.8"))
        return tuple(found)

    def _acceleration(self, multiplier: float) -> float:
        """Spectral acceleration of a multiplier [m/s2], equation C8.7.1.8."""
        return multiplier * GRAVITY / (self.participation * self.confidence_factor)

    @property
    def steps(self) -> tuple[Step, ...]:
        """Every step with its clause, in the order of the check."""
        found = [
            Step("alpha_0", self.alpha_0, "C8.7.1.1"),
            Step("participation", self.participation, "C8.7.1.5"),
            Step("confidence_factor", self.confidence_factor, "C8.7.1.2.1.3"),
            Step("a_0", self.a_0 / GRAVITY, "C8.7.1.8", "g"),
            Step("linear", self.linear / GRAVITY, "C8.7.1.2.1.7", "g"),
        ]
        if self.alpha_tied is not None and self.linear_tied is not None:
            found.append(Step("alpha_tied", self.alpha_tied, "C8.7.1.1"))
            found.append(Step("linear_tied", self.linear_tied / GRAVITY, "C8.7.1.2.1.7", "g"))
        if self.peak is not None and self.linear_ratio is not None:
            found.append(Step("peak", self.peak / GRAVITY, "C8.7.1.2.1.7", "g"))
            found.append(Step("linear_ratio", self.linear_ratio))
        if self.elastic_period is not None:
            found.append(Step("elastic_period", self.elastic_period, "C8.7.1.6", "s"))
        found.append(Step("d_0", self.d_0, "C8.7.1.4", "m"))
        found += [Step("yields", d, "", "m", tie) for tie, d in self.yielding.items()]
        found += [Step("breaks", d, "", "m", tie) for tie, d in self.breaking.items()]
        for name, state in self.states.items():
            found += [
                Step("capacity", state.capacity, "C8.7.1.2.1.6", "m", name),
                Step("period", state.period, "C8.7.1.10" if name == "SLV" else "C8.7.1.11", "s", name),
                Step("demand", state.demand, "C8.7.1.2.1.8", "m", name),
                Step("ratio", state.ratio, "", "", name),
            ]
        if self.ground_ratio > self.states["SLV"].ratio:
            found.append(Step("ground_ratio", self.ground_ratio, "C8.7.1.2.1.8"))
        return tuple(found)

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
        *linear, slv, slc = self.verdicts
        floored = self.ground_ratio > self.states["SLV"].ratio
        said = {"ratio SLV": "see a_g,SLV" if floored else slv.said, "ratio SLC": slc.said}
        said |= {"linear_ratio": linear[0].said if linear else "", "ground_ratio": f"{slv.said}, C8.7.1.2.1.8"}
        rows = []
        for step in self.steps:
            what, digits = SAID[step.key]
            what = what.format(of=step.of, share=SHARE.get(step.of, 0.0), damping=DAMPING.get(step.of, 0.0))
            note = said.get(f"{step.key} {step.of}".strip(), step.clause)
            if step.key == "ratio" and (gone := self.broken_before(step.of)):
                note += f", without {', '.join(gone)}, broken"
            value = ratio_said(step.value) if step.key.endswith("ratio") else f"{step.value:.{digits}f}"
            rows.append((what + (f" [{step.unit}]" if step.unit else ""), value, note))
        return rows

    def __repr__(self) -> str:
        ratios = ", ".join(f"{one.limit_state} {ratio_said(one.ratio)} {one.said}" for one in self.verdicts[-2:])
        return f"<MechanismCheck: starts at {self.a_0 / GRAVITY:.4g} g, capacity over demand {ratios}>"


def mechanism_check(
    case: Case | Corner | VerticalBending | HorizontalBending,
    demand: Demand | Mapping[str, Demand],
    *,
    confidence_factor: float = 1.35,
    elastic_period: float | None = None,
) -> MechanismCheck:
    """The kinematic check of a wall as a local mechanism, linear and non-linear, by Circolare 2019 n. 7, C8.7.1.2.1.

    The push-over curve of the rigid wall becomes the capacity curve a(d) of an equivalent oscillator. Its displacement
    capacities are shares of the displacement at which it ends. The demand is the elastic displacement at an equivalent
    period: of a code's spectrum its value there, of a record the largest at any period up to it.

    Loads have no mass here, and give no horizontal force. Ties count along the curve with the strength they have until
    they break. In the linear check they stand twice: slack, as they are where rocking starts, and at their strength, a
    stabilising force on the mechanism in the equation of virtual work, for ties that are tensioned or have no slack. Of
    the two conditions of C8.7.1.2.1.6 only the share of d_0 is looked at: whether a beam loses its seat before is for
    the user. A mechanism on a floor (C8.7.1.2.1.4) takes `spectrum.at_height(...)` or `motion.through_building(...)` as
    its demand. The linear check compares 2 a_0 with the peak acceleration of the demand, where that is known.

    Args:
        case: the wall and its effects, whose release and motion play no part, a corner, or a wall that bends between
            floors or side walls.
        demand: a record, a spectrum of `code_spectrum`, or a function S_De(T, xi) that gives the elastic displacement
            [m] of a spectrum. It is that of both limit states, or a mapping has one for each, "SLV" and "SLC"; the
            linear check then takes that of the SLV.
        confidence_factor: FC [-], 1 to 1.35; 1.35 where the strength of the masonry does not enter the curve.
        elastic_period: T_0 of an element that vibrates freely before it opens, such as a parapet [s], 0.001 to 5; its
            curve begins with an elastic branch, a = (2 pi / T_0)^2 d, C8.7.1.6. None is a rigid start.

    Returns:
        The `MechanismCheck`, which prints in a line and as a table.

    Raises:
        TypeError, ValueError: for a value outside its range, or a wall whose curve does not end, as its ties hold it.

    Warns:
        Implausible: for ties that still hold at d_SLC and raise it above d_0 of the wall without them.

    Examples:
        >>> check = mr.mechanism_check(case, mr.code_spectrum("EC8 type 1", ag=1.0, soil="A"))
        >>> str(check).startswith('<MechanismCheck: starts at 0.1')
        True
    """
    if isinstance(case, Corner):
        case = Case(case.block, 0.0, 1.0, effects=case.masses)
    demands = _by_limit_state(demand)
    severe = demands["SLV"]
    peak = severe.peak if isinstance(severe, GroundMotion | SpectrumOfCode) else None
    factor = require_within("confidence_factor", confidence_factor, 1.0, 1.35)
    T_0 = None if elastic_period is None else require_within("elastic_period", elastic_period, 1e-3, 5.0, "s")
    found = _of_bending(case) if isinstance(case, VerticalBending | HorizontalBending) else _of_wall(case)
    d, a = found.d, found.multiplier * GRAVITY / (found.participation * factor)
    if T_0 is not None:
        fine = np.union1d(d, np.linspace(0.0, float(d[-1]), 4001))
        d, a = fine, np.minimum(np.interp(fine, d, a), (2 * math.pi / T_0) ** 2 * fine)
    d_0 = float(d[-1])
    states = {}
    for name, share in SHARE.items():
        capacity = share * d_0
        period = PERIOD[name] * math.sqrt(capacity / float(np.interp(capacity, d, a)))
        states[name] = LimitState(capacity, period, _asked(demands[name], period, DAMPING[name], T_0 or SHORT))
    alpha_0, ties = float(found.multiplier[0]), (found.yielding, found.breaking)
    return MechanismCheck(alpha_0, found.tied, found.participation, factor, d, a, d_0, states, peak, *ties, T_0)


class _Mechanism(NamedTuple):
    """What the check takes of a mechanism.

    Args:
        multiplier: along the curve [-], shape (n,).
        d: spectral displacements [m], shape (n,), C8.7.1.4.
        participation: e* [-], C8.7.1.5.
        tied: multiplier that starts it with the ties at their strength [-]; None without ties.
        yielding, breaking: displacement at which each tie yields and breaks [m], by name.
    """

    multiplier: Array
    d: Array
    participation: float
    tied: float | None
    yielding: Mapping[str, float]
    breaking: Mapping[str, float]


def _of_bending(bending: VerticalBending | HorizontalBending) -> _Mechanism:
    """A wall between floors or side walls. The centroids of both bodies begin to move alike, so that all of the mass
    takes part."""
    curve = bending.curve
    return _Mechanism(curve.multiplier, curve.displacement, 1.0, None, {}, {})


def _of_wall(case: Case) -> _Mechanism:
    """A wall that overturns, with its ties. A ValueError says if they hold it for good."""
    require_wall("case", case, "collapse_multiplier")
    curve = pushover(case)
    if not math.isfinite(curve.end):
        raise ValueError("case has a push-over curve that does not end: its ties hold the wall; give them a strength")
    wall = case.wall
    weights, heights = _masses(case)
    first, second = float(weights @ heights), float(weights @ heights**2)
    moved = wall.pose(curve.rotation)[:, 0]  # of the control point, the centroid
    d = moved * second / (wall.centroid_height * first)
    alone = float(wall.pose(np.array([max(case.restoring.outer.alpha, 0.0)]))[0, 0] * d[-1] / moved[-1])
    yielding, breaking = ({tie: float(np.interp(at, curve.rotation, d)) for tie, at in of.items()} for of in curve.ties)
    _warn_of_ties(case, SHARE["SLC"] * float(d[-1]), alone, breaking)
    tied = None
    if case.pulls:
        tied = float(curve.multiplier[0]) + moment_at_strength(case.pulls) / (wall.weight * wall.centroid_height)
    return _Mechanism(curve.multiplier, d, first**2 / (float(weights.sum()) * second), tied, yielding, breaking)


def _warn_of_ties(case: Case, capacity: float, alone: float, breaking: Mapping[str, float]) -> None:
    """Warn of ties that still hold at d_SLC, where they raise it above the displacement `alone` at which the curve of
    the wall without them ends [m]. `breaking` has the displacement at which ties break [m]."""
    holding = [
        f"{name} (ultimate = {f'{tie.law.ultimate:g} m' if tie.law.ultimate < math.inf else None})"
        for name, tie in case.springs.items()
        if breaking.get(name, math.inf) > capacity
    ]
    if holding and capacity > alone:
        warnings.warn(
            f"d_SLC = {capacity:.3g} m is more than {alone:.3g} m, at which the curve of the wall without ties ends: "
            f"{', '.join(holding)} would still hold there; say by `ultimate` how far a tie can be drawn out [m]",
            Implausible,
            stacklevel=4,
        )


def _by_limit_state(demand: Demand | Mapping[str, Demand]) -> Mapping[str, Demand]:
    """The demand of each limit state."""
    demands = demand if isinstance(demand, Mapping) else dict.fromkeys(SHARE, demand)
    if set(demands) != set(SHARE):
        raise ValueError(f"demand has {', '.join(map(str, demands)) or 'none'}; a mapping needs {' and '.join(SHARE)}")
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


def _asked(demand: Demand, period: float, damping: float, shortest: float) -> float:
    """The displacement that is asked for at a period [m], by a record the largest from the shortest period on [s]."""
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
