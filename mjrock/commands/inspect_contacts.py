"""`mjrock inspect model.xml`: what the contacts of a MuJoCo model are in N/m and N s/m."""

from __future__ import annotations

from collections.abc import Sequence

from ..command_line import Answer, parser
from ..contacts import command


def answer(argv: Sequence[str]) -> Answer:
    """The table of the model that is named, see `mjrock.contacts.command`."""
    made = parser("inspect", (__doc__ or "").splitlines()[0])
    command.add_arguments(made)
    return Answer(command.answer(made.parse_args(argv)))
