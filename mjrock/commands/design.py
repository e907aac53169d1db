"""`mjrock design`: the first of the values of a file for which every condition holds."""

from __future__ import annotations

from collections.abc import Sequence

from ..command_line import Answer, Status, parser
from .opened import FILE_HELP, opened


def answer(argv: Sequence[str]) -> Answer:
    """Design with a file that has a table `[design]`; the exit status is 1 where no value holds.

    Raises:
        OSError: if the file cannot be read.
        ValueError: for a file that is wrong, or has nothing to design.
    """
    made = parser("design", "Find the first value of the table [design] of a file for which every condition holds.")
    made.add_argument("file", metavar="FILE", help=FILE_HELP)
    design = opened(made.parse_args(argv).file).design()
    return Answer(design.table(), Status.FAILS if design.chosen is None else Status.HOLDS)
