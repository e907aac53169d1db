"""The inverse of a check: the first of some values, such as bars, plates or thicknesses, for which it holds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from ...contacts.files import aligned
from ...notebook import NotebookPicture
from ...quantities import OneOf, brief, is_iterable, listed, ratio_text, require_one_of, shown
from .code import USUAL_CODE
from .demand import Demand, required_demands
from .dynamic_check import DynamicCheck
from .load_check import LoadCheck, StaticAnswer, load_check
from .mechanism_check import METHODS as KINEMATIC
from .mechanism_check import MechanismCheck, mechanism_check
from .mechanism_curve import Checked
from .verdict import Verdict

METHODS = *KINEMATIC, "dynamic"
"""The methods of a code whose conditions may count alone."""
ROUNDED = 1e-9
"""Ratios that are alike, over their size [-]."""
Check = MechanismCheck | DynamicCheck | LoadCheck
Built = Checked | StaticAnswer | Check
"""What is built with a value: a mechanism, what is borne, or a check of one."""


class Condition(NamedTuple):
    """A condition of a check: the name of its mechanism, empty where there is one alone, and what it demands."""

    mechanism: str
    verdict: Verdict

    @property
    def label(self) -> str:
        """Which it is, in words."""
        check = ", ".join(filter(None, (self.verdict.what, self.verdict.limit_state)))
        return ": ".join(filter(None, (self.mechanism, check)))


@dataclass(frozen=True, eq=False, repr=False)
class Trial:
    """A value that was tried.

    Args:
        value: the value.
        label: the same as a short text.
        checks: the checks of what is built with it, by the name of the mechanism; none where it cannot be built.
        refused: why it cannot be built or checked, in words.
        method: the one whose conditions count, as of `design`; None counts all.
        built: what was built with it, None where it cannot be.
    """

    value: Any
    label: str
    checks: Mapping[str, Check]
    refused: str = ""
    method: str | None = None
    built: Any = None

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """Every condition of every check, or those of the method that counts."""
        every = [Condition(name, verdict) for name, check in self.checks.items() for verdict in check.verdicts]
        return tuple(check for check in every if self.method is None or check.verdict.what.startswith(self.method))

    @property
    def governs(self) -> Condition | None:
        """The condition with the least ratio; None where the value cannot be built."""
        return min(self.conditions, key=lambda condition: condition.verdict.ratio, default=None)

    @property
    def ratio(self) -> float:
        """The least capacity over demand [-]; NaN where the value cannot be built."""
        return np.nan if self.governs is None else self.governs.verdict.ratio

    @property
    def holds(self) -> bool:
        """Whether every condition holds."""
        return self.governs is not None and all(condition.verdict.holds for condition in self.conditions)

    def __repr__(self) -> str:
        if self.governs is None:
            return f"<Trial {self.label}: {self.refused}>"
        return f"<Trial {self.label}: {ratio_text(self.ratio)} {_verdict_word(self)}, {self.governs.label}>"


@dataclass(frozen=True, eq=False, repr=False)
class Design(NotebookPicture):
    """The values that were tried, in their order.

    Args:
        trials: one for each value.
    """

    trials: tuple[Trial, ...]

    @property
    def chosen(self) -> Trial | None:
        """The first for which every condition holds; None where none does."""
        return next((trial for trial in self.trials if trial.holds), None)

    @property
    def marked(self) -> Trial | None:
        """The value that the sentence names: the chosen one, or the least where the first value holds already."""
        return self.least if self._first_holds else self.chosen

    @property
    def _first_holds(self) -> bool:
        """Whether the first of several values holds already."""
        return len(self.trials) > 1 and self.trials[0].holds

    @property
    def value(self) -> Any:
        """The first value for which every condition holds; None where none does."""
        return None if self.chosen is None else self.chosen.value

    @property
    def least(self) -> Trial:
        """The first value with the least ratio but for rounding, such as the worst place of an axle."""
        built = [trial for trial in self.trials if trial.governs is not None]
        low = min(trial.ratio for trial in built)
        return next(trial for trial in built if trial.ratio <= low * (1 + ROUNDED))

    @property
    def governs(self) -> Condition | None:
        """The condition with the least ratio, of the chosen value, or of the best one where none holds."""
        return (self.chosen or self.nearest).governs

    @property
    def nearest(self) -> Trial:
        """The value with the largest of the least ratios."""
        return max((trial for trial in self.trials if trial.governs is not None), key=lambda trial: trial.ratio)

    def table(self) -> str:
        """Each value with its least ratio and the condition that it is of, as text."""
        rows = [("value", "ratio", "", "governed by", "clause")]
        for trial in self.trials:
            if trial.governs is None:
                rows.append((trial.label, "-", "-", trial.refused, ""))
            else:
                last = trial.governs.label, trial.governs.verdict.clause
                rows.append((trial.label, ratio_text(trial.ratio), _verdict_word(trial), *last))
        return "\n".join([*aligned(rows, "<><<<"), self.sentence])

    @property
    def sentence(self) -> str:
        """The result in one sentence."""
        method = self.trials[0].method
        if self._first_holds:
            held = f"{sum(trial.holds for trial in self.trials)} of {len(self.trials)} values hold"
            return f"{held}; the least ratio is {ratio_text(self.least.ratio)}, of {self.least.label}"
        if self.chosen is not None:
            every = f"every {method} condition" if method else "every condition"
            return f"{self.chosen.label} is the first of {len(self.trials)} values for which {every} holds"
        best, count = self.nearest, len(self.trials)
        return f"none of {count} values holds; {best.label} comes nearest, {ratio_text(best.ratio)}"

    def __repr__(self) -> str:
        return f"<Design: {self.sentence}>"


def design(
    build: Callable[[Any], Built | Mapping[str, Built]],
    values: Sequence[Any],
    demand: Demand | Mapping[str, Demand] | float | None = None,
    *,
    method: Annotated[str | None, OneOf(METHODS)] = None,
    **options: Any,
) -> Design:
    """The first of some values for which every condition of the check holds, with the checks of all.

    Values are tried in their order, from the least effort to the largest. All are checked, so that the table shows what
    each would bring. `least` has the worst of them, as of an axle that is tried at each place of a bridge.

    Args:
        build: `build(value)` makes the mechanism of a value, what `mechanism_check` takes: a `Case`, a bending, the
            `limit_curve` of masonry; or what bears a load, as `load_check` takes it, such as a `collapse_multiplier`.
            It may make a check instead, such as one with a demand of its own or by dynamic runs, or a mapping of names
            to several, all of which have to hold.
        values: the values to try: bars, plates, spacings, thicknesses, places, or pairs and mappings of them.
        demand: as of `mechanism_check`, or a number as of `load_check`; None where `build` makes checks, or loads that
            grow have a factor of 1 to bear.
        method: "linear", "nonlinear" or "dynamic" where the conditions of this method alone count: a code may have
            several for one limit state, of which the designer takes one. None counts all.
        options: further arguments of `mechanism_check`, such as `confidence_factor` and `code`.

    Returns:
        The `Design`: `value`, `table()` and what `governs`; `mjrock.plotting.design` draws ratio against value.

    Raises:
        TypeError: for a build that is not a function, values that are not a sequence, or what cannot be checked.
        ValueError: for no values, or where none of them can be built and checked, with the reason of the first. A value
            that cannot be built among others that can is a row of the table with its reason.

    Examples:
        >>> slv = mr.code_spectrum("NTC 2018", ag=1.5, F0=2.5, Tc=0.33, soil="B")
        >>> walls = [0.4, 0.6, 0.8, 1.0]
        >>> mr.design(lambda t: mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), walls, slv).value
        0.6
        >>> wind = mr.Thrust(height=2.0, force=3.2e3)
        >>> safety = lambda t: mr.collapse_multiplier(mr.Case(mr.Block.from_size(t, 4.0), 0.0, 1.0), None, loads=wind)
        >>> mr.design(safety, walls, 1.5)
        <Design: 0.6 is the first of 4 values for which every condition holds>
    """
    if not callable(build):
        raise TypeError(f"build = {shown(build)} is not a function of a value")
    if not is_iterable(values) or isinstance(values, str | Mapping):
        raise TypeError(f"values = {shown(values)} is not a sequence of values")
    candidates = listed("values", values)
    if not candidates:
        raise ValueError("values is empty; at least one is needed")
    if demand is not None and (isinstance(demand, bool) or not isinstance(demand, int | float)):
        required_demands(demand, options.get("code", USUAL_CODE))
    if method is not None:
        require_one_of("method", method, METHODS)
    trials = tuple(replace(_trial_of(build, value, demand, options), method=method) for value in candidates)
    if any(trial.checks and not trial.conditions for trial in trials):
        raise ValueError(f"method = {method!r}: the checks have no condition of it")
    if not any(trial.checks for trial in trials):
        raise ValueError(f"none of the values can be built and checked; {trials[0].label}: {trials[0].refused}")
    return Design(trials)


def _trial_of(build: Callable[[Any], object], value: object, demand: object, options: Mapping[str, Any]) -> Trial:
    """The checks of a value, or why there are none."""
    try:
        built = build(value)
        named = built if isinstance(built, Mapping) else {"": built}
        checks = {name: _checked(value, mechanism, demand, options) for name, mechanism in named.items()}
    except ValueError as error:
        return Trial(value, label_of(value), {}, str(error))
    if not checks:
        raise TypeError(f"build({label_of(value)}) is an empty mapping; it has one check at least")
    return Trial(value, label_of(value), checks, built=built)


def _checked(value: object, built: Any, demand: Any, options: Mapping[str, Any]) -> Check:
    """The check of what was built with a value, or the check that was built. A limit curve is a mechanism, and bears
    loads."""
    if isinstance(built, Check):
        return built
    name = f"build({label_of(value)})"
    if built is None:
        raise TypeError(f"{name} is None; build has to return a mechanism, what bears a load, or a check")
    if isinstance(demand, int | float) or (demand is None and isinstance(built, StaticAnswer)):
        if not isinstance(built, StaticAnswer):
            raise TypeError(
                f"demand = {demand:g} is a factor on loads, an acceleration over g or a force, and {name} = "
                f"{brief(built)} bears none yet: let build return its collapse_multiplier, limit_curve, push or "
                "pushover, or give the spectrum of the site as demand"
            )
        return load_check(built, demand, **options)
    if demand is None:
        raise TypeError("demand is None, and build makes no check; give a demand")
    try:
        return mechanism_check(built, demand, **options)
    except TypeError as error:
        if isinstance(built, Checked):
            raise
        raise TypeError(f"{name} = {brief(built)}: {error}") from error


def label_of(value: object) -> str:
    """A value as a short text."""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {label_of(part)}" for name, part in value.items())
    if isinstance(value, tuple | list):
        return ", ".join(map(label_of, value))
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)[:60]


def _verdict_word(trial: Trial) -> str:
    return "HOLDS" if trial.holds else "FAILS"
