"""The answers of a report: the verdicts of the checks, their steps clause by clause, and the governing condition."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import permutations
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
from ..study.loading.load_check import LoadCheck, StaticAnswer, load_check
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
COLUMNS_ABREAST = 4
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
        cases = [check.case for check in self.dynamic]
        loaded = [check.subject for check in self.loads]
        return [subject for subject in (*checked, *cases, *loaded) if subject is not None]

    @property
    def least_verdict(self) -> Verdict:
        """The condition with the least ratio of capacity over demand."""
        return min(self.verdicts, key=lambda verdict: verdict.ratio)

    @property
    def holding_count(self) -> int:
        """How many conditions hold."""
        return sum(verdict.holds for verdict in self.verdicts)

    @property
    def kind(self) -> str:
        """The key of the word for its verdict: "holds", "part" where some conditions hold, or "fails"."""
        return "holds" if self.holding_count == len(self.verdicts) else "part" if self.holding_count else "fails"

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """All conditions."""
        first = self.kinematic.verdicts if self.kinematic else ()
        others: tuple[Check, ...] = (*self.dynamic, *self.loads)
        return (*first, *(verdict for check in others for verdict in check.verdicts))


def required_checks(checks: object, default_name: str) -> list[Mechanism]:
    """Checks by the names of their mechanisms.

    Args:
        checks: one, several of one mechanism, or a mapping of names to such.
        default_name: the name of the mechanism where none is given.

    Raises:
        TypeError: for anything else.
        ValueError: for two kinematic ones of one.
    """
    if checks is None:
        return []
    mechanisms = []
    for name, checks_of_one in (checks if isinstance(checks, Mapping) else {default_name: checks}).items():
        of_mechanism = [checks_of_one] if isinstance(checks_of_one, Check | StaticAnswer) else checks_of_one
        if not isinstance(of_mechanism, Sequence) or isinstance(of_mechanism, str):
            raise TypeError(
                f"checks = {shown(checks_of_one)} is no MechanismCheck, DynamicCheck or LoadCheck, nor several of them"
            )
        if not of_mechanism:
            raise ValueError(f"checks[{name!r}] is empty; at least one check is needed")
        of_mechanism = [load_check(check) if isinstance(check, StaticAnswer) else check for check in of_mechanism]
        for check in of_mechanism:
            require_kind(f"checks[{name!r}]", check, MechanismCheck, DynamicCheck, LoadCheck)
        kinematic = [check for check in of_mechanism if isinstance(check, MechanismCheck)]
        if len(kinematic) > 1:
            raise ValueError(f"checks[{name!r}] has {len(kinematic)} kinematic checks; name each mechanism")
        dynamic = tuple(check for check in of_mechanism if isinstance(check, DynamicCheck))
        loads = tuple(check for check in of_mechanism if isinstance(check, LoadCheck))
        mechanism_name = require_text("a name of checks", name)
        mechanisms.append(Mechanism(mechanism_name, kinematic[0] if kinematic else None, dynamic, loads))
    return mechanisms


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
    checks = [
        check for mechanism in mechanisms for check in (mechanism.kinematic, *mechanism.dynamic) if check is not None
    ]
    codes = {check.code.name: check.code for check in checks}
    for code in codes.values():
        if language not in code.languages:
            raise ValueError(f"language = {language!r}: the texts of {code.name} are in {', '.join(code.languages)}")
    return list(codes.values())


def code_sentences(codes: Sequence[Code], key: str, words: Words) -> list[str]:
    """The text of each code under a key, where it has one."""
    return [text for code in codes if (text := code.text(key, words.language))]


def answer_parts(mechanisms: Sequence[Mechanism], others: Sequence[Subject], words: Words) -> list[Markup]:
    """What holds: a sentence for what governs as it is, one for each proposal, and all conditions, the worst first.

    Args:
        mechanisms: at least one.
        others: further cases of the report, beside which a mechanism may be a proposal.
        words: of the report.
    """
    by_ratio = ranked(mechanisms)
    subjects = [*others, *(subject for mechanism in mechanisms for subject in mechanism.subjects)]
    proposals = [mechanism for mechanism in by_ratio if _is_proposal(mechanism, subjects)]
    present = [mechanism for mechanism in by_ratio if mechanism not in proposals]
    lead = "governs" if present[1:] else "alone"
    lines = [_sentence(mechanism, f"lead_{lead}", words, bool(proposals)) for mechanism in present[:1]]
    lines += [_sentence(mechanism, "lead_proposed", words, False) for mechanism in proposals]
    lines += [element("p", sentence) for sentence in method_sentences(by_ratio, words)]
    return [*lines, verdict_table(by_ratio, words)]


def method_sentences(mechanisms: Sequence[Mechanism], words: Words) -> list[str]:
    """Which method alone counts in kinematic checks, with the names of the mechanisms where it is not so in all; or of
    one that holds by some of its methods, that these are alternatives."""
    sentences = []
    for method in METHODS:
        names = [
            mechanism.name for mechanism in mechanisms if mechanism.kinematic and mechanism.kinematic.method == method
        ]
        start = "; ".join(names) + ": " if len(names) < len(mechanisms) else ""
        sentences += [start + words("method_counts", method=words(f"method_{method}"))] * bool(names)
    return sentences or [words("methods_alternative")] * any(_holds_by_one(mechanism) for mechanism in mechanisms)


def _holds_by_one(mechanism: Mechanism) -> bool:
    """Whether a limit state holds by one method, and not by another one."""
    holds = dict[tuple[str, str], bool]()
    for verdict in mechanism.verdicts:
        if verdict.limit_state:
            key = verdict.limit_state, verdict.what.partition(",")[0]
            holds[key] = verdict.holds and holds.get(key, True)
    return any(holds[a] and not holds[b] and a[0] == b[0] for a, b in permutations(holds, 2))


def verdict_table(mechanisms: Sequence[Mechanism], words: Words) -> Markup:
    """All conditions of mechanisms."""
    rows = []
    for mechanism in mechanisms:
        count = len(mechanism.verdicts)
        count_text = words("conditions_held", held=mechanism.holding_count, count=count)
        name = element("td", element("b", mechanism.name), Markup("<br>"), count_text, rowspan=str(count))
        for i, verdict in enumerate(mechanism.verdicts):
            rows.append([*([name] if i == 0 else []), *_marked_condition_cells(verdict, words)])
    return table([words(f"verdict_{name}") for name in CONDITION_COLUMNS], rows, right=(3, 4, 5))


def ranked(mechanisms: Sequence[Mechanism]) -> list[Mechanism]:
    """Mechanisms, that with the least ratio first."""
    return sorted(mechanisms, key=lambda mechanism: mechanism.least_verdict.ratio)


def _is_proposal(mechanism: Mechanism, subjects: Sequence[Subject]) -> bool:
    """Whether a case of a mechanism is one of some others with further ties or dampers."""
    return any(_has_further_links(subject, base) for subject in mechanism.subjects for base in subjects)


def _has_further_links(subject: Subject, base: Subject) -> bool:
    """Whether a case is another one of the same wall or masonry with further ties or dampers."""
    if not (isinstance(subject, AnyCase) and isinstance(base, AnyCase) and subject.built == base.built):
        return False
    further = tuple(effect for effect in subject.effects if effect not in base.effects)
    return bool(link_effects(further)) and all(effect in subject.effects for effect in base.effects)


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
    least, verdicts, lead = mechanism.least_verdict, mechanism.verdicts, mechanism.kind
    refused = "; ".join(_check_and_state(verdict, words) for verdict in verdicts if not verdict.holds)
    numbers = {"ratio": words.ratio(least.ratio), "check": _check_and_state(least, words)}
    end = words("lead_ratio", held=mechanism.holding_count, count=len(verdicts), **numbers)
    start = f"{words(key, name=mechanism.name)} {words(f'lead_{lead}', refused=refused)}"
    return Sentence(lead, start, end)


def _sentence(mechanism: Mechanism, key: str, words: Words, is_present: bool) -> Markup:
    """The sentence on a mechanism as a paragraph; `is_present` calls it the present state."""
    is_present = is_present and words("as_it_is") not in mechanism.name.casefold()
    lead, start, end = sentence_of(mechanism, f"{key}_now" if is_present else key, words)
    return element("p", element("span", words(lead), kind=lead), " ", element("b", start), f" {end}")


def _check_and_state(verdict: Verdict, words: Words) -> str:
    """Which check and limit state a condition is of."""
    return ", ".join(filter(None, (words(verdict.what), verdict.limit_state)))


def condition_cells(verdict: Verdict, words: Words) -> list[str]:
    """Cells of one condition: its check, limit state, demand, capacity, ratio, whether it holds, and its clause."""

    def amount(value: float) -> str:
        fell = math.isinf(value) and value == verdict.demand
        return words("fell") if fell else words.quantity(value, verdict.unit, FOUND)

    numbers = amount(verdict.demand), amount(verdict.capacity), words.ratio(verdict.ratio)
    word = words("holds" if verdict.holds else "fails")
    return [words(verdict.what), verdict.limit_state or DASH, *numbers, word, verdict.clause or DASH]


def _marked_condition_cells(verdict: Verdict, words: Words) -> list[str]:
    """The same with what they look like."""
    check, state, *numbers, word, clause = condition_cells(verdict, words)
    mark = "holds" if verdict.holds else "fails"
    return [check, state, *(element("td", n, kind="right") for n in numbers), element("td", word, kind=mark), clause]


def design_rows(design: Design, words: Words) -> list[list[str]]:
    """Cells of each value that was tried: its least ratio, whether it holds, and the condition that governs it with its
    clause; below their heads."""
    rows = [[words(f"verdict_{key}") for key in ("value", "ratio", "verdict", "check", "clause")]]
    for trial in design.trials:
        if trial.governs is None:
            rows.append([words.marked(trial.label), DASH, DASH, trial.refused, DASH])
            continue
        verdict, clause = words("holds" if trial.holds else "fails"), trial.governs.verdict.clause or DASH
        rows.append(
            [words.marked(trial.label), words.ratio(trial.ratio), verdict, condition_text(trial.governs, words), clause]
        )
    return rows


def design_results(design: Design, words: Words) -> list[Markup]:
    """Each value that was tried with what governs it, and the result in a sentence."""
    heads, *cells = design_rows(design, words)
    rows = list[list[str]]()
    for trial, (label, ratio, word, *governing_cells) in zip(design.trials, cells, strict=True):
        verdict = word if trial.governs is None else element("td", word, kind="holds" if trial.holds else "fails")
        rows.append([element("td", label, kind="short"), ratio, verdict, *governing_cells])
    parts = [table(heads, rows, right=(1,)), element("p", design_sentence(design, words))]
    if design.chosen is None:
        return parts
    checks = {name or words.marked(design.chosen.label): check for name, check in design.chosen.checks.items()}
    proposed = element("p", words("proposed", name=words.marked(design.chosen.label)), kind="head")
    return [*parts, proposed, verdict_table(required_checks(checks, ""), words)]


def condition_text(condition: Condition, words: Words) -> str:
    """A condition of a design in words, with its mechanism where it has a name."""
    return ": ".join(filter(None, (condition.mechanism, _check_and_state(condition.verdict, words))))


def design_sentence(design: Design, words: Words) -> str:
    """The result of a design in one sentence."""
    count, method = len(design.trials), design.trials[0].method
    every_condition = words("every_method", method=words(f"method_{method}")) if method else words("every_condition")
    if len(design.trials) > 1 and design.trials[0].holds:
        holding_count = sum(trial.holds for trial in design.trials)
        least = {"name": words.marked(design.least.label), "ratio": words.ratio(design.least.ratio)}
        return words("design_held", held=holding_count, count=count, **least)
    if design.chosen is not None:
        return words("design_chosen", name=words.marked(design.chosen.label), count=count, every=every_condition)
    nearest = design.nearest
    return words("design_none", name=words.marked(nearest.label), count=count, ratio=words.ratio(nearest.ratio))


def governing_table(mechanisms: Sequence[Mechanism], records: Mapping[str, str], words: Words) -> Markup:
    """The least ratio of each mechanism with its check, and the record with the largest displacement.

    Args:
        mechanisms: in their order.
        records: what records are called in the report, by their names in the checks.
        words: of the report.
    """
    rows = []
    has_runs = any(mechanism.dynamic for mechanism in mechanisms)
    for mechanism in mechanisms:
        least = mechanism.least_verdict
        runs = [run for check in mechanism.dynamic for run in check.runs]
        worst_record = [DASH, DASH]
        if runs:
            run = max(runs, key=lambda run: run.d)
            name = run.name.removesuffix(REVERSED)
            d = words("fell") if math.isinf(run.d) else words.quantity(run.d, "m", FOUND)
            worst_record = [records.get(name, name) + (f" ({words('reversed')})" if name != run.name else ""), d]
        least_cells = words.ratio(least.ratio), _check_and_state(least, words)
        rows.append((mechanism.name, *least_cells, *worst_record * has_runs))
    columns = ["verdict_mechanism", "least_ratio", "verdict_check", *["worst_record", "run_largest"] * has_runs]
    return table([words(name) for name in columns], rows, right=(1, 4))


def kinematic_limits(mechanisms: Sequence[Mechanism], words: Words) -> list[str]:
    """What the kinematic checks do not cover."""
    codes = codes_of([mechanism._replace(dynamic=()) for mechanism in mechanisms], words.language)
    sentences = code_sentences(codes, "limit_seat", words)
    for name, check, *_ in mechanisms:
        if check and (broken_states := [state for state in check.states if check.broken_before(state)]):
            sentences.append(words("limit_broken", name=name, states=", ".join(broken_states)))
    return sentences


def kinematic_steps(mechanisms: Sequence[Mechanism], words: Words) -> list[Markup]:
    """The steps of the kinematic checks, a column a mechanism."""
    named_checks = [(mechanism.name, mechanism.kinematic) for mechanism in mechanisms if mechanism.kinematic]
    tables = []
    for code in dict.fromkeys(check.code.name for _, check in named_checks):
        of_code = [(name, check) for name, check in named_checks if check.code.name == code]
        for abreast in (of_code[start : start + COLUMNS_ABREAST] for start in range(0, len(of_code), COLUMNS_ABREAST)):
            checks = [check for _, check in abreast]
            rows = [_step_row(step, checks, words) for step in _merged_steps(checks)]
            if any(check.moving for check in checks):
                rows.insert(0, [words("in_moving"), "", *(words.named(check.moving) or DASH for check in checks), DASH])
            heads = [words("step"), words("formula"), *(name for name, _ in abreast), words("verdict_clause")]
            tables.append(table(heads, rows, right=range(2, 2 + len(abreast))))
    return tables


def _merged_steps(checks: Sequence[MechanismCheck]) -> list[Step]:
    """The steps of several checks, each once, those of the mechanism in the order of a check: one of a limit state that
    the first has not follows the one that stands before it."""
    merged: list[Step] = []
    for check in checks:
        position = 0
        for step in check.steps:
            places = [i for i, other in enumerate(merged) if (other.key, other.of) == (step.key, step.of)]
            if not places:
                merged.insert(position, step)
            position = 1 + (places[0] if places else position)
    order = {key: i for i, key in enumerate(OF_MECHANISM)}
    return sorted(merged, key=lambda step: order.get(step.key, len(order)))


def _step_row(step: Step, checks: Sequence[MechanismCheck], words: Words) -> list[str]:
    """A row: what it is, its formula, its value in each check, and its clause."""
    code, effect = checks[0].code, effect_name(step.of, words)
    formula_text = code.formula(step.key, step.of, lambda number: words.number(number, GIVEN))
    cells = []
    for check in checks:
        same_steps = [other for other in check.steps if (other.key, other.of) == (step.key, step.of)]
        cells.append(_value_cell(same_steps[0], check, words) if same_steps else DASH)
    return [code.step(step.key, effect).text[words.language], formula(formula_text), *cells, step.clause or DASH]


def _value_cell(step: Step, check: MechanismCheck, words: Words) -> Markup:
    """The cell of a value; the colour of a ratio shows whether it holds, if none below takes its place."""
    if not step.key.endswith("ratio"):
        return element("td", words.quantity(step.value, step.unit, FOUND), kind="right")
    method = "linear" if step.key.endswith("linear_ratio") else "nonlinear"
    counts = step.key == "damage_ratio" or check.counts(method)
    counts &= step.key != "ratio" or not check.is_of_start(step.of)
    cell_class = f"right {'holds' if step.value >= 1 else 'fails'}" if counts else "right"
    return element("td", words.ratio(step.value), kind=cell_class)


def effect_label(name: str, effect: Effect, words: Words) -> str:
    """The name of an effect in a report: its own, or that of what several effects stand for."""
    item = effect.report_item
    return effect_name(name, words) if item is None or item is effect else words(f"effect_{item.label}")


def dynamic_steps(mechanisms: Sequence[Mechanism], words: Words) -> list[Markup]:
    """The conditions of the checks by dynamic runs, a column a check."""
    named_checks = [(mechanism.name, check) for mechanism in mechanisms for check in mechanism.dynamic]
    tables = []
    for start in range(0, len(named_checks), COLUMNS_ABREAST):
        columns = [dynamic_results(check, words) for _, check in named_checks[start : start + COLUMNS_ABREAST]]
        keys = [key for key in columns[0] if any(column[key] != DASH for column in columns)]
        rows = [[words(f"dynamic_{key}"), *(column[key] for column in columns)] for key in keys]
        heads = [words("step"), *(name for name, _ in named_checks[start : start + COLUMNS_ABREAST])]
        tables.append(table(heads, rows))
    return tables


def dynamic_results(check: DynamicCheck, words: Words) -> dict[str, str]:
    """What a check by dynamic runs found, by its key."""

    def length(d: float) -> str:
        return words("fell") if math.isinf(d) else words.quantity(d, "m", FOUND)

    e = DASH
    if check.restitution:
        low, middle, high = (words.number(value, FOUND) for value in np.percentile(check.restitution, [5, 50, 95]))
        e = words("restitution_found", middle=middle, low=low, high=high, count=len(check.restitution))
    direction = "; ".join(words.number(part + 0.0) for part in check.way)
    return {
        "state": check.limit_state,
        "runs": words("runs_and_records", runs=len(check.runs), records=check.records),
        "d_0": length(check.d_0),
        "exceeded": str(len(check.exceeded)),
        "largest": length(max(run.d for run in check.runs)),
        "mean": length(check.mean),
        "capacity": words("share_of", d=length(check.capacity), share=words.number(check.share)),
        "restitution": e,
        "judged": words("centroid_along", names=words.named(check.moving), way=direction) if check.moving else DASH,
        "lacks": "; ".join(check.lacking_in(words.language)) or words("nothing"),
    }
