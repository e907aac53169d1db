"""`mjrock measure model.xml ball floor`: what a contact does, beside what its numbers promise."""

from __future__ import annotations

from collections.abc import Sequence

from ..command_line import Answer, parser
from ..contacts import measure_command


def answer(argv: Sequence[str]) -> Answer:
    """The table of the contact that is named, see `mjrock.contacts.measure_command`."""
    made = parser("measure", (__doc__ or "").splitlines()[0])
    measure_command.add_arguments(made)
    return Answer(measure_command.answer(made.parse_args(argv)))
