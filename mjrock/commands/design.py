"""`mjrock design`: the first of the values of a file for which every condition holds."""

from __future__ import annotations

from collections.abc import Sequence

from ..command_line import Answer, Status, parser, ruled
from ..reporting.texts import Words, languages
from ..reporting.verdicts import design_rows, design_sentence
from .opened import FILE_HELP, opened


def answer(argv: Sequence[str]) -> Answer:
    """Design with a file that has a table `[design]`; the exit status is 1 where no value holds.

    Raises:
        OSError: if the file cannot be read.
        ValueError: for a file that is wrong, or has nothing to design.
    """
    made = parser("design", "Find the first value of the table [design] of a file for which every condition holds.")
    made.add_argument("file", metavar="FILE", help=FILE_HELP)
    made.add_argument("-l", "--language", choices=languages(), help="instead of that of the file")
    args = made.parse_args(argv)
    assessment = opened(args.file, args.language)
    design, words = assessment.design(), Words(assessment.language)
    text = "\n".join([*ruled(design_rows(design, words), "<><<<"), "", design_sentence(design, words)])
    return Answer(text, Status.FAILS if design.chosen is None else Status.HOLDS)
