"""What a report answers: the verdicts of the checks, their steps clause by clause, and what governs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..problem.masonry.case import AnyCase
from ..problem.masonry.limit.collapse import Collapse
from ..problem.wall.bending import HorizontalBending, VerticalBending
from ..problem.wall.effect import Effect
from ..problem.wall.effects import link_effects
from ..problem.wall.wedge import Corner
from ..quantities import require_kind, require_text, shown
from ..study.loading.code import OF_MECHANISM, Code
from ..study.loading.design import Condition, Design
from ..study.loading.dynamic_check import DynamicCheck
from ..study.loading.load_check import Borne, LoadCheck, load_check
from ..study.loading.mechanism_check import METHODS, MechanismCheck
from ..study.loading.mechanism_curve import Checked
from ..study.loading.verdict import Step, Verdict
from .markup import Markup, element, formula, table
from .texts import DASH, FOUND, GIVEN, Words, effect_name

Check = MechanismCheck | DynamicCheck | LoadCheck
Subject = Checked | AnyCase | Collapse
"""What a check or a run is of."""
REVERSED = ", reversed"
"""How the name of a reversed motion ends."""
ABREAST = 4
"""Mechanisms whose steps stand beside each other in one table."""
CONDITION_COLUMNS = ("mechanism", "check", "state", "demand", "capacity", "ratio", "verdict", "clause")
"""Keys of the columns of a table of conditions."""


class Mechanism(NamedTuple):
    """A mechanism, or a variant of one, and its checks.

    Args:
        name: what it is called.
        kinematic: the check on its push-over curve, or None.
        dynamic: those by dynamic runs.
        loads: those of what is borne.
    """

    name: str
    kinematic: MechanismCheck | None
    dynamic: tuple[DynamicCheck, ...]
    loads: tuple[LoadCheck, ...] = ()

    @property
    def subjects(self) -> list[Subject]:
        """What its checks are of, where they know it."""
        checked = [self.kinematic.mechanism] if self.kinematic else []
        shaken = [check.case for check in self.dynamic]
        return [one for one in (*checked, *shaken, *(check.subject for check in self.loads)) if one is not None]

    @property
    def least(self) -> Verdict:
        """The condition with the least ratio."""
        return min(self.verdicts, key=lambda verdict: verdict.ratio)

    @property
    def holding(self) -> int:
        """How many conditions hold."""
        return sum(verdict.holds for verdict in self.verdicts)

    @property
    def kind(self) -> str:
        """The key of the word for its verdict: "holds", "part" where some conditions hold, or "fails"."""
        return "holds" if self.holding == len(self.verdicts) else "part" if self.holding else "fails"

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """All conditions."""
        first = self.kinematic.verdicts if self.kinematic else ()
        others: tuple[Check, ...] = (*self.dynamic, *self.loads)
        return (*first, *(verdict for check in others for verdict in check.verdicts))


def required_checks(checks: object, alone: str) -> list[Mechanism]:
    """Checks by the names of their mechanisms.

    Args:
        checks: one, several of one mechanism, or a mapping of names to such.
        alone: the name of the mechanism where none is given.

    Raises:
        TypeError: for anything else.
        ValueError: for two kinematic ones of one.
    """
    if checks is None:
        return []
    found = []
    for name, given in (checks if isinstance(checks, Mapping) else {alone: checks}).items():
        several = [given] if isinstance(given, Check | Borne) else given
        if not isinstance(several, Sequence) or isinstance(several, str):
            raise TypeError(
                f"checks = {shown(given)} is no MechanismCheck, DynamicCheck or LoadCheck, nor several of them"
            )
        if not several:
            raise ValueError(f"checks[{name!r}] is empty; at least one check is needed")
        several = [load_check(one) if isinstance(one, Borne) else one for one in several]
        for one in several:
            require_kind(f"checks[{name!r}]", one, MechanismCheck, DynamicCheck, LoadCheck)
        kinematic = [one for one in several if isinstance(one, MechanismCheck)]
        if len(kinematic) > 1:
            raise ValueError(f"checks[{name!r}] has {len(kinematic)} kinematic checks; name each mechanism")
        dynamic = tuple(one for one in several if isinstance(one, DynamicCheck))
        loads = tuple(one for one in several if isinstance(one, LoadCheck))
        called = require_text("a name of checks", name)
        found.append(Mechanism(called, kinematic[0] if kinematic else None, dynamic, loads))
    return found


def kind_of(subject: object) -> str:
    """The end of the key of the word for what is checked: "wall", "bending", "corner" or "masonry"."""
    if isinstance(subject, Corner):
        return "corner"
    if isinstance(subject, VerticalBending | HorizontalBending):
        return "bending"
    return "wall" if hasattr(getattr(subject, "case", None) or subject, "block") else "masonry"


def codes_of(mechanisms: Sequence[Mechanism], language: str) -> list[Code]:
    """The codes of all checks, each once.

    Raises:
        ValueError: for one without texts in the language of the report.
    """
    checks = [check for one in mechanisms for check in (one.kinematic, *one.dynamic) if check is not None]
    codes = {check.code.name: check.code for check in checks}
    for code in codes.values():
        if language not in code.languages:
            raise ValueError(f"language = {language!r}: the texts of {code.name} are in {', '.join(code.languages)}")
    return list(codes.values())


def sentences(codes: Sequence[Code], key: str, words: Words) -> list[str]:
    """The text of each code under a key, where it has one."""
    return [text for code in codes if (text := code.text(key, words.language))]


def answers(mechanisms: Sequence[Mechanism], others: Sequence[Subject], words: Words) -> list[Markup]:
    """What holds: a sentence for what governs as it is, one for each proposal, and all conditions, the worst first.

    Args:
        mechanisms: at least one.
        others: further cases of the report, beside which a mechanism may be a proposal.
        words: of the report.
    """
    order = ranked(mechanisms)
    bases = [*others, *(one for mechanism in mechanisms for one in mechanism.subjects)]
    proposals = [one for one in order if any(_adds(subject, base) for subject in one.subjects for base in bases)]
    present = [one for one in order if one not in proposals]
    leads = [(present[0], "governs" if present[1:] else "alone", bool(proposals))] if present else []
    lines = [_sentence(one, f"lead_{kind}", words, now) for one, kind, now in leads]
    lines += [_sentence(one, "lead_proposed", words, False) for one in proposals]
    lines += [element("p", one) for one in counted(order, words)]
    return [*lines, verdict_table(order, words)]


def counted(mechanisms: Sequence[Mechanism], words: Words) -> list[str]:
    """Which method alone counts in kinematic checks, with the names of the mechanisms where it is not so in all; or of
    one that holds by some of its methods, that these are alternatives."""
    found = []
    for method in METHODS:
        some = [one for one in mechanisms if one.kinematic and one.kinematic.method == method]
        names = "; ".join(one.name for one in some) + ": " if len(some) < len(mechanisms) else ""
        found += [names + words("method_counts", method=words(f"method_{method}"))] * bool(some)
    return found or [words("methods_alternative")] * any(_holds_by_one(one) for one in mechanisms)


def _holds_by_one(mechanism: Mechanism) -> bool:
    """Whether a limit state holds by one method, and not by another one."""
    given = [(one.limit_state, one.what.partition(",")[0], one.holds) for one in mechanism.verdicts if one.limit_state]
    met, refused = ({(state, how) for state, how, holds in given if holds == wanted} for wanted in (True, False))
    return any(state == other for state, _ in met - refused for other, _ in refused)


def verdict_table(order: Sequence[Mechanism], words: Words) -> Markup:
    """All conditions of mechanisms."""
    rows = []
    for mechanism in order:
        held, count = mechanism.holding, len(mechanism.verdicts)
        count_text = words("conditions_held", held=held, count=count)
        name = element("td", element("b", mechanism.name), Markup("<br>"), count_text, rowspan=str(count))
        for i, verdict in enumerate(mechanism.verdicts):
            rows.append([*([name] if i == 0 else []), *_conditions(verdict, words)])
    return table([words(f"verdict_{name}") for name in CONDITION_COLUMNS], rows, right=(3, 4, 5))


def ranked(mechanisms: Sequence[Mechanism]) -> list[Mechanism]:
    """Mechanisms, that with the least ratio first."""
    return sorted(mechanisms, key=lambda one: one.least.ratio)


def _adds(subject: Subject, base: Subject) -> bool:
    """Whether a case is another one of the same wall or masonry with further ties or dampers: a proposal."""
    if not (isinstance(subject, AnyCase) and isinstance(base, AnyCase) and subject.built == base.built):
        return False
    further = tuple(one for one in subject.effects if one not in base.effects)
    return bool(link_effects(further)) and all(one in subject.effects for one in base.effects)


class Sentence(NamedTuple):
    """What holds of a mechanism.

    Args:
        kind: of its verdict, see `Mechanism.kind`.
        start: the name, whether it holds, and the conditions that refuse it.
        end: the least ratio.
    """

    kind: str
    start: str
    end: str


def sentence_of(mechanism: Mechanism, key: str, words: Words) -> Sentence:
    """What holds of a mechanism, with its least ratio and the conditions that refuse it.

    Args:
        mechanism: it.
        key: of the words that it starts with.
        words: of the language.
    """
    least, verdicts, kind = mechanism.least, mechanism.verdicts, mechanism.kind
    refused = "; ".join(_of(verdict, words) for verdict in verdicts if not verdict.holds)
    numbers = {"ratio": words.ratio(least.ratio), "check": _of(least, words)}
    end = words("lead_ratio", held=mechanism.holding, count=len(verdicts), **numbers)
    start = f"{words(key, name=mechanism.name)} {words(f'lead_{kind}', refused=refused)}"
    return Sentence(kind, start, end)


def _sentence(mechanism: Mechanism, key: str, words: Words, now: bool) -> Markup:
    """The sentence on a mechanism as a paragraph; `now` calls it the present state."""
    now = now and words("as_it_is") not in mechanism.name.casefold()
    kind, start, end = sentence_of(mechanism, f"{key}_now" if now else key, words)
    return element("p", element("span", words(kind), kind=kind), " ", element("b", start), f" {end}")


def _of(verdict: Verdict, words: Words) -> str:
    """Which check and limit state a condition is of."""
    return ", ".join(filter(None, (words(verdict.what), verdict.limit_state)))


def conditions(verdict: Verdict, words: Words) -> list[str]:
    """Cells of one condition: its check, limit state, demand, capacity, ratio, whether it holds, and its clause."""

    def amount(value: float) -> str:
        fell = math.isinf(value) and value == verdict.demand
        return words("fell") if fell else words.quantity(value, verdict.unit, FOUND)

    numbers = amount(verdict.demand), amount(verdict.capacity), words.ratio(verdict.ratio)
    held = words("holds" if verdict.holds else "fails")
    return [words(verdict.what), verdict.limit_state or DASH, *numbers, held, verdict.clause or DASH]


def _conditions(verdict: Verdict, words: Words) -> list[str]:
    """The same with what they look like."""
    what, state, *numbers, held, clause = conditions(verdict, words)
    kind = "holds" if verdict.holds else "fails"
    return [what, state, *(element("td", one, kind="right") for one in numbers), element("td", held, kind=kind), clause]


def design_rows(found: Design, words: Words) -> list[list[str]]:
    """Cells of each value that was tried: its least ratio, whether it holds, and the condition that governs it with its
    clause; below their heads."""
    rows = [[words(f"verdict_{key}") for key in ("value", "ratio", "verdict", "check", "clause")]]
    for trial in found.trials:
        if trial.governs is None:
            rows.append([words.marked(trial.label), DASH, DASH, trial.refused, DASH])
            continue
        held, clause = words("holds" if trial.holds else "fails"), trial.governs.verdict.clause or DASH
        rows.append(
            [words.marked(trial.label), words.ratio(trial.ratio), held, condition(trial.governs, words), clause]
        )
    return rows


def design_results(found: Design, words: Words) -> list[Markup]:
    """Each value that was tried with what governs it, and the result in a sentence."""
    heads, *cells = design_rows(found, words)
    rows = list[list[str]]()
    for trial, (label, ratio, held, *rest) in zip(found.trials, cells, strict=True):
        verdict = held if trial.governs is None else element("td", held, kind="holds" if trial.holds else "fails")
        rows.append([element("td", label, kind="short"), ratio, verdict, *rest])
    made = [table(heads, rows, right=(1,)), element("p", design_sentence(found, words))]
    if found.chosen is None:
        return made
    named = {name or words.marked(found.chosen.label): one for name, one in found.chosen.checks.items()}
    proposed = element("p", words("proposed", name=words.marked(found.chosen.label)), kind="head")
    return [*made, proposed, verdict_table(required_checks(named, ""), words)]


def condition(one: Condition, words: Words) -> str:
    """A condition of a design in words, with its mechanism where it has a name."""
    return ": ".join(filter(None, (one.mechanism, _of(one.verdict, words))))


def design_sentence(found: Design, words: Words) -> str:
    """The result of a design in one sentence."""
    count, method = len(found.trials), found.trials[0].method
    every = words("every_method", method=words(f"method_{method}")) if method else words("every_condition")
    if len(found.trials) > 1 and found.trials[0].holds:
        held = sum(trial.holds for trial in found.trials)
        least = {"name": words.marked(found.least.label), "ratio": words.ratio(found.least.ratio)}
        return words("design_held", held=held, count=count, **least)
    if found.chosen is not None:
        return words("design_chosen", name=words.marked(found.chosen.label), count=count, every=every)
    best = found.nearest
    return words("design_none", name=words.marked(best.label), count=count, ratio=words.ratio(best.ratio))


def governing(mechanisms: Sequence[Mechanism], records: Mapping[str, str], words: Words) -> Markup:
    """The least ratio of each mechanism with its check, and the record with the largest displacement.

    Args:
        mechanisms: in their order.
        records: what records are called in the report, by their names in the checks.
        words: of the report.
    """
    rows = []
    shaken = any(mechanism.dynamic for mechanism in mechanisms)
    for mechanism in mechanisms:
        least = mechanism.least
        runs = [run for check in mechanism.dynamic for run in check.runs]
        worst = [DASH, DASH]
        if runs:
            run = max(runs, key=lambda one: one.d)
            name = run.name.removesuffix(REVERSED)
            d = words("fell") if math.isinf(run.d) else words.quantity(run.d, "m", FOUND)
            worst = [records.get(name, name) + (f" ({words('reversed')})" if name != run.name else ""), d]
        rows.append((mechanism.name, words.ratio(least.ratio), _of(least, words), *worst * shaken))
    columns = ["verdict_mechanism", "least_ratio", "verdict_check", *["worst_record", "run_largest"] * shaken]
    return table([words(name) for name in columns], rows, right=(1, 4))


def limits(mechanisms: Sequence[Mechanism], words: Words) -> list[str]:
    """What the kinematic checks do not cover."""
    codes = codes_of([one._replace(dynamic=()) for one in mechanisms], words.language)
    found = sentences(codes, "limit_seat", words)
    for name, check, *_ in mechanisms:
        if check and (gone := [state for state in check.states if check.broken_before(state)]):
            found.append(words("limit_broken", name=name, states=", ".join(gone)))
    return found


def kinematic_steps(mechanisms: Sequence[Mechanism], words: Words) -> list[Markup]:
    """The steps of the kinematic checks, a column a mechanism."""
    given = [(mechanism.name, mechanism.kinematic) for mechanism in mechanisms if mechanism.kinematic]
    made = []
    for code in dict.fromkeys(check.code.name for _, check in given):
        own = [(name, check) for name, check in given if check.code.name == code]
        for some in (own[start : start + ABREAST] for start in range(0, len(own), ABREAST)):
            checks = [check for _, check in some]
            rows = [_step(step, checks, words) for step in _all_steps(checks)]
            if any(check.moving for check in checks):
                rows.insert(0, [words("in_moving"), "", *(words.named(check.moving) or DASH for check in checks), DASH])
            heads = [words("step"), words("formula"), *(name for name, _ in some), words("verdict_clause")]
            made.append(table(heads, rows, right=range(2, 2 + len(some))))
    return made


def _all_steps(checks: Sequence[MechanismCheck]) -> list[Step]:
    """The steps of several checks, each once, those of the mechanism in the order of a check: one of a limit state that
    the first has not follows the one that stands before it."""
    merged: list[Step] = []
    for check in checks:
        at = 0
        for step in check.steps:
            same = [i for i, one in enumerate(merged) if (one.key, one.of) == (step.key, step.of)]
            if not same:
                merged.insert(at, step)
            at = 1 + (same[0] if same else at)
    order = {key: i for i, key in enumerate(OF_MECHANISM)}
    return sorted(merged, key=lambda step: order.get(step.key, len(order)))


def _step(step: Step, checks: Sequence[MechanismCheck], words: Words) -> list[str]:
    """A row: what it is, its formula, its value in each check, and its clause."""
    code, of = checks[0].code, effect_name(step.of, words)
    shape = code.formula(step.key, step.of, lambda number: words.number(number, GIVEN))
    cells = []
    for check in checks:
        found = [one for one in check.steps if (one.key, one.of) == (step.key, step.of)]
        cells.append(_value(found[0], check, words) if found else DASH)
    return [code.step(step.key, of).text[words.language], formula(shape), *cells, step.clause or DASH]


def _value(step: Step, check: MechanismCheck, words: Words) -> Markup:
    """The cell of a value; the colour of a ratio shows whether it holds, if none below takes its place."""
    if not step.key.endswith("ratio"):
        return element("td", words.quantity(step.value, step.unit, FOUND), kind="right")
    method = "linear" if step.key.endswith("linear_ratio") else "nonlinear"
    counts = step.key == "damage_ratio" or check.counts(method)
    counts &= step.key != "ratio" or not check.is_of_start(step.of)
    kind = f"right {'holds' if step.value >= 1 else 'fails'}" if counts else "right"
    return element("td", words.ratio(step.value), kind=kind)


def effect_label(name: str, effect: Effect, words: Words) -> str:
    """The name of an effect in a report: its own, or that of what several effects stand for."""
    whole = effect.report_item
    return effect_name(name, words) if whole is None or whole is effect else words(f"effect_{whole.label}")


def dynamic_steps(mechanisms: Sequence[Mechanism], words: Words) -> list[Markup]:
    """The conditions of the checks by dynamic runs, a column a check."""
    given = [(mechanism.name, check) for mechanism in mechanisms for check in mechanism.dynamic]
    made = []
    for start in range(0, len(given), ABREAST):
        columns = [dynamic_found(check, words) for _, check in given[start : start + ABREAST]]
        keys = [key for key in columns[0] if any(column[key] != DASH for column in columns)]
        rows = [[words(f"dynamic_{key}"), *(column[key] for column in columns)] for key in keys]
        heads = [words("step"), *(name for name, _ in given[start : start + ABREAST])]
        made.append(table(heads, rows))
    return made


def dynamic_found(check: DynamicCheck, words: Words) -> dict[str, str]:
    """What a check by dynamic runs found, by its key."""

    def length(d: float) -> str:
        return words("fell") if math.isinf(d) else words.quantity(d, "m", FOUND)

    e = DASH
    if check.restitution:
        low, middle, high = (words.number(one, FOUND) for one in np.percentile(check.restitution, [5, 50, 95]))
        e = words("restitution_found", middle=middle, low=low, high=high, count=len(check.restitution))
    way = "; ".join(words.number(part + 0.0) for part in check.way)
    return {
        "state": check.limit_state,
        "runs": words("runs_and_records", runs=len(check.runs), records=check.records),
        "d_0": length(check.d_0),
        "exceeded": str(len(check.exceeded)),
        "largest": length(max(run.d for run in check.runs)),
        "mean": length(check.mean),
        "capacity": words("share_of", d=length(check.capacity), share=words.number(check.share)),
        "restitution": e,
        "judged": words("centroid_along", names=words.named(check.moving), way=way) if check.moving else DASH,
        "lacks": "; ".join(check.lacking_in(words.language)) or words("nothing"),
    }
