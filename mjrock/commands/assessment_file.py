"""The file of an assessment that a command is given."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..assessment.assessment import Assessment, assessment_of_text, decoded, from_toml
from ..reporting.texts import Words, languages
from ..reporting.verdicts import kind_of
from ..study.loading.mechanism_check import MechanismCheck

if TYPE_CHECKING:  # tasks bring MuJoCo, which a check does not need
    from ..study.analysis import Analysis

INPUT = "-"
"""The name of the standard input."""
MENDABLE = (ValueError, TypeError, OSError)
"""What is raised for a file that cannot be read or checked."""


def add_file(parser: argparse.ArgumentParser, *, several: bool = False) -> None:
    """Add FILE, or several of them, and `--language`."""
    name, count = ("files", "+") if several else ("file", None)
    parser.add_argument(name, nargs=count, metavar="FILE", help="the file; - is the standard input")
    parser.add_argument("-l", "--language", choices=languages(), help="instead of that of the file")


def assessment_of_file(file: str, language: str | None = None) -> Assessment:
    """The assessment of a file, or of the standard input, whose paths are relative to the current folder.

    Args:
        file: its path, or INPUT.
        language: in place of that of the file; None keeps it.

    Raises:
        OSError, ValueError: as `from_toml`.
    """
    if file == INPUT:
        name = "standard input"
        assessment = assessment_of_text(decoded(sys.stdin.buffer.read(), name), name, Path.cwd())
    else:
        assessment = from_toml(file)
    return assessment if language is None else replace(assessment, language=language)


def named_checks(checks: Mapping[str, MechanismCheck], words: Words) -> dict[str, MechanismCheck]:
    """Checks by the names of their mechanisms; one that has none is that of the wall, the corner or the masonry."""
    return {name or words(f"kind_{kind_of(check.mechanism)}"): check for name, check in checks.items()}


def runs_of(assessment: Assessment) -> dict[str, list[Analysis]]:
    """The runs of each mechanism that something moves, labelled with what does; those that nothing moves have none."""
    analyses = assessment.analyses() if assessment.moved else {}
    return {name: [replace(run, labels={"motion": motion_of(run)}) for run in runs] for name, runs in analyses.items()}


def motion_of(run: Analysis) -> str:
    """What moves the wall or the masonry of a run."""
    case = run.case
    if case.motion is not None:
        return case.motion.name
    return "supports" if getattr(case, "supports", ()) else "release"
