"""A code for the check of local mechanisms: its limit states, its clauses and its texts, in one file.

The check asks the code for every number, and the report for every clause and text. A further code is a further file in
the folder of those that come with the package, or a file of your own, see `Code.load` and docs/own_code.md.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import Field, asdict, dataclass, field, fields, replace
from functools import cache
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Self

from ...contacts.files import require_file
from ...quantities import (
    Within,
    keep_declared,
    require_flag,
    require_kind,
    require_one_of,
    require_path,
    require_text,
    require_within,
)

CODE_FILES = Path(__file__).with_name("codes")
"""Folder of the codes that come with the package."""
USUAL_CODE = "NTC 2018"
"""The code of a check where none is given."""
Texts = Mapping[str, str]
"""A text by language, "en" and others."""

IN_FORMULA = re.compile(r"(?<![^\W_])(?:OF|SHARE|PERIOD|DAMPING|BEHAVIOUR)(?![^\W_])")
"""What stands for a number in a formula."""


class StepOutput(NamedTuple):
    """How a value of the check is written: its unit, its decimals in a table, and what the value is of."""

    unit: str
    digits: int
    of: str = "mechanism"


CHECK_STEPS = {
    "alpha_0": StepOutput("", 4), "participation": StepOutput("", 4), "confidence_factor": StepOutput("", 2),
    "a_0": StepOutput("g", 4), "linear": StepOutput("g", 4), "alpha_tied": StepOutput("", 4),
    "linear_tied": StepOutput("g", 4), "peak": StepOutput("g", 4), "floor_peak": StepOutput("g", 4),
    "free_peak": StepOutput("g", 4), "linear_ratio": StepOutput("", 2), "floor_linear_ratio": StepOutput("", 2),
    "free_linear_ratio": StepOutput("", 2), "damage": StepOutput("g", 4), "damage_ratio": StepOutput("", 2),
    "elastic_period": StepOutput("s", 3), "d_0": StepOutput("m", 4), "yields": StepOutput("m", 4, "tie"),
    "breaks": StepOutput("m", 4, "tie"), "capacity": StepOutput("m", 4, "limit state"),
    "period": StepOutput("s", 3, "limit state"), "demand": StepOutput("m", 4, "limit state"),
    "ratio": StepOutput("", 2, "limit state"), "ground_ratio": StepOutput("", 2, "ground motion"),
}  # fmt: skip
"""The steps of the check. The key of one of the whole mechanism is the name of its attribute of `MechanismCheck`, that
of a limit state the name of its attribute of `LimitState`."""
OF_MECHANISM, OF_LIMIT_STATE = (
    tuple(key for key, output in CHECK_STEPS.items() if output.of == of) for of in ("mechanism", "limit state")
)
"""The keys of the steps of a mechanism, and of those of a limit state."""


@dataclass(frozen=True)
class CodeLimitState:
    """A limit state of the non-linear check.

    Args:
        share: displacement capacity over d_0, at which the curve ends [-], 0.01 to 1.
        period: factor of the equivalent period T = period pi sqrt(d / a(d)) at the capacity d [-], 0.1 to 10.
        damping: equivalent damping ratio [-], 0 to 0.9.
        equation: of the period, in the code.
        holds_until_start: whether the limit state also holds where the peak of the demand starts no mechanism.
    """

    share: Annotated[float, Within(0.01, 1)]
    period: Annotated[float, Within(0.1, 10)]
    damping: Annotated[float, Within(0, 0.9)]
    equation: str = ""
    holds_until_start: bool = False

    def __post_init__(self) -> None:
        keep_declared(self)
        require_text("equation", self.equation)
        require_flag("holds_until_start", self.holds_until_start)

    def period_at(self, d: float, a: float) -> float:
        """Equivalent period at a point of the curve, d [m] and a [m/s2] [s]."""
        return self.period * math.pi * math.sqrt(d / a)


@dataclass(frozen=True)
class CodeStep:
    """How a step of the check is printed. {of} stands for the tie or the limit state, and {share}, {period}, {damping}
    and {equation} for those of the limit state.

    Args:
        text: what it is, by language, in a report.
        plain: the same in English with its formula, in a table of plain text. Empty is the English text.
        formula: in a report, see `mjrock.reporting.markup.formula`. OF, SHARE, PERIOD, DAMPING [%] and BEHAVIOUR stand
            for the limit state, its numbers, and q.
        clause: where it stands in the code.
    """

    text: Texts
    plain: str = ""
    formula: str = ""
    clause: str = ""


@dataclass(frozen=True)
class LinearRule:
    """The linear check: q a_0 is compared with the peak acceleration of the demand.

    Args:
        state: the limit state that it is of.
        behaviour: q [-], 1 to 10.
        clause: where it stands in the code.
    """

    state: str
    behaviour: Annotated[float, Within(1, 10)]
    clause: str = ""

    def __post_init__(self) -> None:
        keep_declared(self)


@dataclass(frozen=True)
class DamageRule:
    """The limit state of the start of the mechanism: a_0 is compared with the acceleration of its demand.

    Args:
        state: its name, by which a mapping of demands has its own.
        damping: damping ratio of an element that vibrates freely before it opens [-], 0 to 0.9: its demand, also in the
            linear check, is the spectral acceleration at its period T_0.
        clause: where it stands in the code.
        free_clause: where that of elements that vibrate freely does.
    """

    state: str
    damping: Annotated[float, Within(0, 0.9)]
    clause: str = ""
    free_clause: str = ""

    def __post_init__(self) -> None:
        keep_declared(self)


@dataclass(frozen=True)
class DynamicRule:
    """The check by dynamic runs: none beyond d_0, and the mean of the maxima at most the share of the limit state.

    Args:
        records: how many records the code demands at least, 1 to 1000.
        clause: where it stands in the code.
    """

    records: Annotated[int, Within(1, 1000, whole=True)]
    clause: str = ""

    def __post_init__(self) -> None:
        keep_declared(self)


@dataclass(frozen=True)
class ConfidenceRule:
    """The confidence factor FC that divides the acceleration which starts the mechanism.

    Args:
        low: the least valid value [-], 1 to 3.
        high: the largest valid value [-], 1 to 3.
        usual: the value where none is given [-], 1 to 3.
    """

    low: Annotated[float, Within(1, 3)] = 1.0
    high: Annotated[float, Within(1, 3)] = 1.0
    usual: Annotated[float, Within(1, 3)] = 1.0

    def __post_init__(self) -> None:
        keep_declared(self)
        if not self.low <= self.usual <= self.high:
            raise ValueError(f"low, usual, high = {self.low:g}, {self.usual:g}, {self.high:g} do not increase")

    def checked(self, factor: float | None) -> float:
        """A confidence factor within the range, the usual one for None [-]."""
        return self.usual if factor is None else require_within("confidence_factor", factor, self.low, self.high)


@dataclass(frozen=True)
class Code:
    """A code for the check of local mechanisms, see `Code.load`.

    Args:
        name: by which messages call it.
        clause: of the non-linear check.
        states: its limit states by name, the least severe first.
        steps: the steps that it prints, by their keys, those of `CHECK_STEPS`. One that it does not have is left out.
        texts: sentences of a report about the check, by key and language.
        confidence: the range of the confidence factor; 1 where the code has none.
        linear: the linear check; None where the code has none.
        damage: the limit state of the start of the mechanism; None where the code has none.
        dynamic: the check by dynamic runs; None where the code has none.
    """

    name: str
    states: Mapping[str, CodeLimitState]
    steps: Mapping[str, CodeStep]
    texts: Mapping[str, Texts]
    clause: str = ""
    confidence: ConfidenceRule = field(default_factory=ConfidenceRule)
    linear: LinearRule | None = None
    damage: DamageRule | None = None
    dynamic: DynamicRule | None = None

    def __post_init__(self) -> None:
        require_text("name", self.name)
        if not self.states:
            raise ValueError("states is empty; at least one limit state is needed")
        if self.linear is not None:
            require_one_of("linear.state", self.linear.state, self.states)
        for key in self.steps:
            require_one_of("a key of steps", key, CHECK_STEPS)
            for state in self.states if key in (*OF_LIMIT_STATE, "ground_ratio") else [""]:
                self.step(key, state)
                self.formula(key, state, str)

    def __repr__(self) -> str:
        return f"<Code {self.name}: {', '.join(self.states)}>"

    @property
    def first(self) -> str:
        """The name of the first limit state, which the linear check is of where the code has one."""
        return next(iter(self.states)) if self.linear is None else self.linear.state

    @property
    def languages(self) -> list[str]:
        """The languages that every text has."""
        texts = [*self.texts.values(), *(step.text for step in self.steps.values())]
        return sorted(set.intersection(*map(set, texts))) if texts else []

    def step(self, key: str, of: str = "") -> CodeStep:
        """A step with the numbers of its limit state in their places.

        Args:
            key: of the step.
            of: the limit state, or the name of a tie.

        Raises:
            ValueError: for a text with another place than those of `CodeStep`.
        """
        step, numbers = self.steps[key], {"of": of}
        places = numbers | (asdict(self.states[of]) if of in self.states else {})
        try:
            plain = step.plain or step.text.get("en", key)
            filled = (text.format(**places) for text in (plain, step.clause, *step.text.values()))
            plain, clause, *texts = filled
        except (KeyError, IndexError) as error:
            known = ", ".join(f"{{{place}}}" for place in places)
            raise ValueError(f"steps.{key} has a place for {error}; the places are {known}") from None
        return replace(step, plain=plain, clause=clause, text=dict(zip(step.text, texts, strict=True)))

    def formula(self, key: str, of: str, written: Callable[[float], str]) -> str:
        """The formula of a step, with its numbers as `written` writes them.

        Raises:
            ValueError: for a number that the code does not have.
        """
        state, known = self.states.get(of), {"OF": of}
        if state is not None:
            numbers = {"SHARE": state.share, "PERIOD": state.period, "DAMPING": 100 * state.damping}
            known |= {name: written(number) for name, number in numbers.items()}
        if self.linear is not None:
            known["BEHAVIOUR"] = written(self.linear.behaviour)
        try:
            return IN_FORMULA.sub(lambda match: known[match[0]], self.steps[key].formula)
        except KeyError as error:
            raise ValueError(f"steps.{key}.formula has {error}, which the code does not have there") from None

    def text(self, key: str, language: str = "en", **values: object) -> str:
        """A sentence about the check, with values in their places; empty where the code has none."""
        return self.texts[key][language].format(**values) if key in self.texts else ""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a code from a file.

        Args:
            path: of a TOML file, as those in `mjrock/study/loading/codes`; docs/own_code.md has a short one.

        Raises:
            OSError: if the file cannot be read.
            ValueError: if it is not TOML, lacks an entry, or has one that is unknown or outside its range.
        """
        path = require_path("path", path)
        try:
            return cls(**_parts_of(tomllib.loads(require_file(path).read_text(encoding="utf-8"))))
        except (TypeError, ValueError) as error:
            raise ValueError(f"{path} is not a code of local mechanisms: {error}") from None


def _parts_of(table: dict[str, Any]) -> dict[str, Any]:
    """The arguments of a `Code` that a file gives."""
    parts = _checked_table("the file", Code, table)
    kinds: dict[str, Callable[..., object]] = {"linear": LinearRule, "damage": DamageRule, "dynamic": DynamicRule}
    kinds["confidence"] = ConfidenceRule
    for name in kinds.keys() & parts.keys():
        parts[name] = _make_part(name, kinds[name], parts[name])
    kinds = {"states": CodeLimitState, "steps": CodeStep}
    for name, kind in kinds.items():
        require_kind(name, parts[name], dict)
        parts[name] = {key: _make_part(f"{name}.{key}", kind, entry) for key, entry in parts[name].items()}
    require_kind("texts", parts["texts"], dict)
    for name, text in [*parts["texts"].items(), *((f"steps.{key}", step.text) for key, step in parts["steps"].items())]:
        require_kind(name, text, dict)
        for language, sentence in text.items():
            require_text(f"{name}.{language}", sentence, 100_000)
    return parts


def _make_part(name: str, kind: Callable[..., object], table: object) -> object:
    """A part of a code, whose errors name the table of the file that has it."""
    require_kind(name, table, dict)
    try:
        return kind(**_checked_table(name, kind, dict(table)))  # type: ignore[call-overload]
    except (TypeError, ValueError) as error:
        raise type(error)(f"{name}: {error}") from None


def _checked_table(name: str, kind: Callable[..., object], table: dict[str, Any]) -> dict[str, Any]:
    """A table of the file whose entries are arguments of a class, with all that have no default."""
    arguments = {argument.name: argument for argument in fields(kind)}  # type: ignore[arg-type]
    for key in table:
        require_one_of(f"an entry of {name}", key, arguments)
    missing = next((key for key, argument in arguments.items() if key not in table and _is_needed(argument)), None)
    if missing is not None:
        raise ValueError(f"{name} has no {missing}")
    return table


def _is_needed(argument: Field[object]) -> bool:
    """Whether a field of a dataclass has no default."""
    return argument.default is argument.default_factory  # both are MISSING


@cache
def _codes() -> dict[str, Code]:
    """The codes that come with the package, by name."""
    return {code.name: code for code in map(Code.load, sorted(CODE_FILES.glob("*.toml")))}


def codes() -> tuple[str, ...]:
    """The names of the codes that come with the package."""
    return tuple(_codes())


def code_of(code: Code | str = USUAL_CODE) -> Code:
    """A code, or that of a name.

    Raises:
        TypeError, ValueError: for anything else.
    """
    require_kind("code", code, Code, str)
    return code if isinstance(code, Code) else _codes()[require_one_of("code", code, _codes())]
