"""`mjrock check`: whether the mechanisms of a file hold."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence

from ..assessment.assessment import Assessment
from ..command_line import Answer, Status, complain, parser_of, ruled
from ..contacts.files import aligned
from ..reporting import verdicts
from ..reporting.texts import FOUND, Words
from ..study.loading.mechanism_check import MechanismCheck
from .assessment_file import MENDABLE, add_file, assessment_of_file, named_checks


def table_of(mechanisms: Sequence[verdicts.Mechanism], words: Words) -> str:
    """The conditions of all mechanisms, that with the least ratio first, and what governs."""
    ordered = verdicts.ranked(mechanisms)
    rows = [[words(f"verdict_{head}") for head in verdicts.CONDITION_COLUMNS]]
    for mechanism in ordered:
        for i, verdict in enumerate(mechanism.verdicts):
            rows.append([mechanism.name * (i == 0), *verdicts.condition_cells(verdict, words)])
    sentence = verdicts.sentence_of(ordered[0], "lead_governs" if ordered[1:] else "lead_alone", words)
    sentences = [sentence.start, sentence.end, *verdicts.method_sentences(ordered, words)]
    return "\n".join([*ruled(rows, "<<<>>><<"), "", " ".join(sentences)])


def steps_of(check: MechanismCheck, words: Words) -> list[str]:
    """Every step of a check with its value and its clause."""
    rows = []
    for step in check.steps:
        ratio = step.key.endswith("ratio")
        value = words.ratio(step.value) if ratio else words.quantity(step.value, step.unit, FOUND)
        rows.append((check.code.step(step.key, step.of).text[words.language], value, step.clause))
    return aligned(rows, "<><")


def check_for_programs(name: str, file: str, check: MechanismCheck) -> dict[str, object]:
    """A check for other programs: numbers in SI units, None for what is infinite.

    Args:
        name: of the mechanism.
        file: that it stands in.
        check: of it.
    """

    def number(value: float) -> float | None:
        return float(value) if math.isfinite(value) else None

    conditions = []
    for verdict in check.verdicts:
        numbers = {key: number(getattr(verdict, key)) for key in ("demand", "capacity", "ratio")}
        conditions.append(verdict._asdict() | numbers | {"holds": verdict.holds})
    steps = [step._asdict() | {"value": number(step.value)} for step in check.steps]
    holds = all(verdict.holds for verdict in check.verdicts)
    return {"file": file, "mechanism": name, "holds": holds, "conditions": conditions, "steps": steps}


def verdict_on(assessment: Assessment, checks: Mapping[str, MechanismCheck], steps: bool) -> str:
    """The verdict on the mechanisms of a file as text.

    Args:
        assessment: the file.
        checks: of its mechanisms.
        steps: whether every step follows.
    """
    words = Words(assessment.language)
    mechanisms = verdicts.required_checks(named_checks(checks, words), "")
    lines = [assessment.name, table_of(mechanisms, words)]
    for mechanism in mechanisms if steps else ():
        if mechanism.kinematic is not None:
            lines += ["", mechanism.name, *steps_of(mechanism.kinematic, words)]
    return "\n".join(lines)


def answer(argv: Sequence[str]) -> Answer:
    """Check files. What is wrong with one does not keep others from being checked.

    Raises:
        ValueError: for a language that there is not.
    """
    parser = parser_of("check", "Check the mechanisms of files, the least ratio of capacity over demand first.")
    add_file(parser, several=True)
    parser.add_argument("-s", "--steps", action="store_true", help="every step with its clause too")
    parser.add_argument("-j", "--json", action="store_true", help="for other programs, in SI units")
    args = parser.parse_args(argv)
    texts: list[str] = []
    plain_checks: list[dict[str, object]] = []
    status = Status.HOLDS
    for file in args.files:
        try:
            assessment = assessment_of_file(file, args.language)
            checks = assessment.check()
            texts.append(verdict_on(assessment, checks, args.steps))
        except MENDABLE as error:
            complain(error)
            status = Status.ERROR
            continue
        plain_checks += [check_for_programs(name, file, check) for name, check in checks.items()]
    if status is Status.HOLDS and not all(check["holds"] for check in plain_checks):
        status = Status.FAILS
    text = json.dumps(plain_checks, indent=1, ensure_ascii=False) if args.json else "\n\n".join(texts)
    return Answer(text, status)
