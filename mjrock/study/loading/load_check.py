"""The verdict of a static answer: the resistance of masonry or a wall against the demand."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...problem.masonry.case import AnyCase, MasonryCase
from ...problem.masonry.limit.collapse import Collapse
from ...problem.masonry.masonry import Masonry
from ...problem.wall.case import Case
from ...quantities import require_kind, require_within, shown
from .limit_analysis import LimitCurve
from .mechanism_curve import warn_of_inner_edge
from .push import Push
from .pushover import PushoverCurve
from .verdict import Verdict, verdicts_of

StaticAnswer = Collapse | LimitCurve | Push | PushoverCurve
"""What has a load that is borne."""
WHAT = {
    Collapse: "limit analysis",
    LimitCurve: "limit analysis, as the mechanism goes on",
    Push: "slow push",
    PushoverCurve: "push-over",
}
"""What a verdict calls each."""
ANSWERED_BY = {
    Case: "mr.pushover(case)",
    MasonryCase: "mr.collapse_multiplier(case.masonry)",
    Masonry: "mr.collapse_multiplier(masonry)",
}
"""The call that gives an answer for what bears."""


@dataclass(frozen=True, eq=False, repr=False)
class LoadCheck:
    """What is borne beside what is demanded, see `load_check`.

    Args:
        result: what bears it.
        demand: in its unit: a factor on the loads or an acceleration over g [-], or the force of an actuator [N].
    """

    result: StaticAnswer
    demand: float

    @property
    def unit(self) -> str:
        """Of capacity and demand: empty, or N."""
        return "N" if isinstance(self.result, Push) and self.result.unit == "N" else ""

    @property
    def capacity(self) -> float:
        """The largest that is borne, in the unit of the demand."""
        if isinstance(self.result, Collapse):
            return self.result.multiplier
        return float(self.result.multiplier.max()) if isinstance(self.result, LimitCurve) else self.result.peak

    @property
    def subject(self) -> AnyCase | Collapse | LimitCurve:
        """What bears it, with what acts on it."""
        if isinstance(self.result, Push):
            return self.result.answer.case
        return self.result.case if isinstance(self.result, PushoverCurve) else self.result

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """The one condition."""
        return (Verdict(WHAT[type(self.result)], "", self.demand, self.capacity, self.unit, ""),)

    @property
    def holds(self) -> bool:
        """Whether at least the demand is borne."""
        return self.verdicts[0].holds

    def table(self) -> str:
        """The condition as text."""
        return verdicts_of(self.verdicts)

    def __repr__(self) -> str:
        (verdict,), unit = self.verdicts, " N" * bool(self.unit)
        return f"<LoadCheck {verdict.label}: {self.capacity:.4g} for {self.demand:.4g}{unit}, {verdict.what}>"


def load_check(result: StaticAnswer, demand: float | None = None) -> LoadCheck:
    """The verdict of limit analysis, of a slow push or of a push-over: what is borne, over what is demanded.

    Args:
        result: of `collapse_multiplier`, `limit_curve`, `push` or `pushover`. The capacity is the multiplier, the
            largest one of a limit curve, or the peak of a push or a push-over.
        demand: what is to be borne, above 0 and up to 1e12: a factor on the loads or a horizontal acceleration over g
            [-], or of an actuator a force [N]. None is a factor of 1 on `loads` that grow, where no horizontal force
            does.

    Returns:
        The `LoadCheck`, with `holds`, `verdicts` and `table()`, which `mr.report` takes among its `checks`.

    Raises:
        TypeError, ValueError: for another result, a demand outside its range, or none where a horizontal force grows.

    Warns:
        Implausible: for the push-over of a wall that is free both ways and bears less inwards.

    Examples:
        >>> column = mr.Masonry.stack([mr.Block.from_size(0.6, 1.0)] * 3)
        >>> mr.load_check(mr.collapse_multiplier(column), 0.15)
        <LoadCheck HOLDS: 0.2 for 0.15, limit analysis>
    """
    if call := next((call for result_type, call in ANSWERED_BY.items() if isinstance(result, result_type)), None):
        raise TypeError(f"result = {shown(result)} is what bears, and no answer; take mr.load_check({call}, demand)")
    require_kind("result", result, *WHAT)
    if isinstance(result, PushoverCurve):
        warn_of_inner_edge(result.case, result.peak)
    if demand is None:
        start = result.start if isinstance(result, LimitCurve) else result
        if not isinstance(start, Collapse) or start.direction.any():
            raise ValueError(
                f"demand is missing: {result!r} is of a horizontal force or of an actuator; give the acceleration over "
                "g [-] or the force [N] that is to be borne"
            )
        return LoadCheck(result, 1.0)
    return LoadCheck(result, require_within("demand", demand, math.ulp(0.0), 1e12))
