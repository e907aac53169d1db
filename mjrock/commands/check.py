"""`mjrock check`: whether the mechanisms of a file hold."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence

from ..assessment.assessment import Assessment
from ..command_line import Answer, Status, complain, parser, ruled
from ..contacts.files import aligned
from ..reporting.texts import FOUND, Words, languages
from ..reporting.verdicts import (
    CONDITION_COLUMNS,
    Mechanism,
    conditions,
    counted,
    ranked,
    required_checks,
    sentence_of,
)
from ..study.loading.mechanism_check import MechanismCheck
from .opened import FILE_HELP, MENDABLE, named_checks, opened


def table_of(mechanisms: Sequence[Mechanism], words: Words) -> str:
    """The conditions of all mechanisms, that with the least ratio first, and what governs."""
    order = ranked(mechanisms)
    rows = [[words(f"verdict_{head}") for head in CONDITION_COLUMNS]]
    for mechanism in order:
        for i, verdict in enumerate(mechanism.verdicts):
            rows.append([mechanism.name * (i == 0), *conditions(verdict, words)])
    sentence = sentence_of(order[0], "lead_governs" if order[1:] else "lead_alone", words)
    return "\n".join([*ruled(rows, "<<<>>><<"), "", " ".join([sentence.start, sentence.end, *counted(order, words)])])


def steps_of(check: MechanismCheck, words: Words) -> list[str]:
    """Every step of a check with its value and its clause."""
    rows = []
    for step in check.steps:
        ratio = step.key.endswith("ratio")
        value = words.ratio(step.value) if ratio else words.quantity(step.value, step.unit, FOUND)
        rows.append((check.code.step(step.key, step.of).text[words.language], value, step.clause))
    return [line.rstrip() for line in aligned(rows, "<><")]


def plain(name: str, file: str, check: MechanismCheck) -> dict[str, object]:
    """A check for other programs: numbers in SI units, None for what is infinite.

    Args:
        name: of the mechanism.
        file: that it stands in.
        check: of it.
    """

    def number(value: float) -> float | None:
        return float(value) if math.isfinite(value) else None

    found = [
        one._asdict() | {"demand": number(one.demand), "capacity": number(one.capacity)} | {"ratio": number(one.ratio)}
        | {"holds": one.holds}
        for one in check.verdicts
    ]  # fmt: skip
    steps = [one._asdict() | {"value": number(one.value)} for one in check.steps]
    holds = all(one.holds for one in check.verdicts)
    return {"file": file, "mechanism": name, "holds": holds, "conditions": found, "steps": steps}


def verdict_on(assessment: Assessment, checks: Mapping[str, MechanismCheck], steps: bool) -> str:
    """The verdict on the mechanisms of a file as text.

    Args:
        assessment: the file.
        checks: of its mechanisms.
        steps: whether every step follows.
    """
    words = Words(assessment.language)
    mechanisms = required_checks(named_checks(checks, words), "")
    text = [assessment.name, table_of(mechanisms, words)]
    for one in mechanisms if steps else ():
        if one.kinematic is not None:
            text += ["", one.name, *steps_of(one.kinematic, words)]
    return "\n".join(text)


def answer(argv: Sequence[str]) -> Answer:
    """Check files. What is wrong with one does not keep others from being checked.

    Raises:
        ValueError: for a language that there is not.
    """
    made = parser("check", "Check the mechanisms of files, those with the least ratio of capacity over demand first.")
    made.add_argument("files", nargs="+", metavar="FILE", help=FILE_HELP)
    made.add_argument("-s", "--steps", action="store_true", help="every step with its clause too")
    made.add_argument("-l", "--language", choices=languages(), help="instead of that of the file")
    made.add_argument("-j", "--json", action="store_true", help="for other programs, in SI units")
    args = made.parse_args(argv)
    texts: list[str] = []
    found: list[dict[str, object]] = []
    status = Status.HOLDS
    for file in args.files:
        try:
            assessment = opened(file, args.language)
            checks = assessment.check()
            texts.append(verdict_on(assessment, checks, args.steps))
        except MENDABLE as error:
            complain(error)
            status = Status.ERROR
            continue
        found += [plain(name, file, check) for name, check in checks.items()]
    if status is Status.HOLDS and not all(one["holds"] for one in found):
        status = Status.FAILS
    text = json.dumps(found, indent=1, ensure_ascii=False) if args.json else "\n\n".join(texts)
    return Answer(text, status)
