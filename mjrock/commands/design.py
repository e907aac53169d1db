"""`mjrock design`: the first of the values of a file that meets every condition."""

from __future__ import annotations

from collections.abc import Sequence

from ..command_line import Answer, Status, parser_of, ruled
from ..reporting.texts import Words
from ..reporting.verdicts import design_rows, design_sentence
from .assessment_file import add_file, assessment_of_file


def answer(argv: Sequence[str]) -> Answer:
    """Design with a file that has a table `[design]`; the exit status is 1 where no value holds.

    Raises:
        OSError: if the file cannot be read.
        ValueError: for a file that is wrong, or has nothing to design.
    """
    parser = parser_of("design", "Find the first value of the table [design] of a file that meets every condition.")
    add_file(parser)
    args = parser.parse_args(argv)
    assessment = assessment_of_file(args.file, args.language)
    design, words = assessment.design(), Words(assessment.language)
    text = "\n".join([*ruled(design_rows(design, words), "<><<<"), "", design_sentence(design, words)])
    return Answer(text, Status.FAILS if design.chosen is None else Status.HOLDS)
