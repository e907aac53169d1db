"""The parts of a report: each wall, corner or masonry with its checks, its runs and its drawings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ..problem.masonry.case import AnyCase
from ..problem.wall.bending import HorizontalBending
from ..study.loading.mechanism_curve import case_of
from . import verdicts
from .content import Content, content_of
from .drawings import DRAWN_APART, drawing_of
from .markup import Markup, framed, image_of
from .pictures import Run, by_variant
from .texts import Words
from .verdicts import Mechanism, Subject


class NamedSubject(NamedTuple):
    """What is checked or run, such as a case, with the names of its mechanisms and variants."""

    names: list[str]
    subject: Subject


@dataclass
class Part:
    """What a report has of one wall, corner or masonry.

    Args:
        body: the same without its effects.
        subjects: what is checked and run of it, each with its effects once.
        mechanisms: whose checks are of it.
        runs: of it.
    """

    body: object
    subjects: list[NamedSubject] = field(default_factory=list)
    mechanisms: list[Mechanism] = field(default_factory=list)
    runs: list[Run] = field(default_factory=list)

    def add(self, name: str, subject: Subject) -> None:
        """Add a subject, or a further name of one that is drawn alike."""
        for named in self.subjects:
            if _drawn_features(named.subject) == _drawn_features(subject):
                named.names.extend([name] * (name not in named.names))
                return
        self.subjects.append(NamedSubject([name], subject))

    def is_of(self, subject: Subject) -> bool:
        """Whether a subject is of it."""
        body = body_of(subject)
        return type(body) is type(self.body) and body == self.body

    @property
    def names(self) -> str:
        """The names of all that it has."""
        return "; ".join(dict.fromkeys(name for subject in self.subjects for name in subject.names))

    @property
    def run_names(self) -> str:
        """The names of what is run of it."""
        return "; ".join(filter(None, by_variant(self.runs))) or self.names

    @property
    def content(self) -> Content:
        """It as the report sees it, by the first of its subjects."""
        return content_of(self.subjects[0].subject)


def parts_of(case_name: str, case: Subject, mechanisms: Sequence[Mechanism], runs: Sequence[Run]) -> list[Part]:
    """The parts of a report, that with the least ratio first.

    Args:
        case_name: the name of the case where nothing else is of it.
        case: the wall, corner or masonry that the report is of.
        mechanisms: with their checks.
        runs: each of the case, or of the mechanism that its variant is named after.
    """
    parts: list[Part] = []
    by_name: dict[str, Part] = {}
    for mechanism in verdicts.ranked(mechanisms):
        subjects = mechanism.subjects or [case]
        part = by_name[mechanism.name] = _part_of(subjects[0], parts)
        part.mechanisms.append(mechanism)
        for subject in subjects:
            part.add(mechanism.name, subject)
    for variant, runs_of_variant in by_variant(runs).items():
        subject_run = case if not variant and isinstance(case, DRAWN_APART) else runs_of_variant[0].response.case
        part = by_name[variant or case_name] if (variant or case_name) in by_name else _part_of(subject_run, parts)
        part.runs += runs_of_variant
        part.add(variant or case_name, part.body if isinstance(part.body, DRAWN_APART) else subject_run)
    for part in [part for part in parts if part.is_of(case)] if parts else [_part_of(case, parts)]:
        if all(_drawn_features(named.subject) != _drawn_features(case) for named in part.subjects):
            part.subjects.insert(0, NamedSubject([case_name], case))
    return parts


def body_of(subject: Subject) -> object:
    """A wall, corner or masonry without its effects."""
    if isinstance(subject, DRAWN_APART):
        return subject if isinstance(subject, HorizontalBending) else replace(subject, effects=())
    return case_of(subject).built


def is_of(case: AnyCase, subject: Subject) -> bool:
    """Whether a case is of the wall, corner or masonry of a subject."""
    return bool(case.built == case_of(subject).built)


def _part_of(subject: Subject, parts: list[Part]) -> Part:
    """The part of a subject, which is added where there is none."""
    known_part = next((part for part in parts if part.is_of(subject)), None)
    if known_part is None:
        parts.append(known_part := Part(body_of(subject)))
    return known_part


def _drawn_features(subject: Subject) -> tuple[object, ...]:
    """What a drawing shows of a subject."""
    drawn = subject if isinstance(subject, DRAWN_APART) else case_of(subject)
    return body_of(drawn), getattr(drawn, "effects", ()), getattr(drawn, "side_stop", None)


def drawings_of(part: Part, parts: Sequence[Part], words: Words) -> list[Markup]:
    """The drawings of a part, each once, with its mechanisms or variants in the caption where there are several."""
    static_answers = [check.result for mechanism in part.mechanisms for check in mechanism.loads]
    names_by_drawing: dict[tuple[str, str], list[str]] = {}
    for names, subject in part.subjects:
        figure, caption = drawing_of(subject, words, static_answers)
        names_by_drawing.setdefault((image_of(figure, words), caption), []).extend(names)
    if len(parts) == len(names_by_drawing) == 1:
        return [framed(image, caption) for image, caption in names_by_drawing]
    return [
        framed(image, f"{'; '.join(names)}: {caption[0].lower()}{caption[1:]}")
        for (image, caption), names in names_by_drawing.items()
    ]
