"""`mjrock new`: a complete file of a mechanism, with the meaning of each key."""

from __future__ import annotations

from collections.abc import Sequence

from ..assessment.templates import seeds, template
from ..command_line import Answer, add_output, parser_of, require_free
from ..contacts.files import aligned, write_text


def answer(argv: Sequence[str]) -> Answer:
    """Write a template.

    Raises:
        OSError: if the file cannot be written, or is there and may not be replaced.
    """
    known = seeds()
    parser = parser_of("new", "Write a file of a mechanism that can be checked as it is, to be changed.")
    parser.add_argument("name", nargs="?", choices=known, metavar="TEMPLATE", help="what it is of; none lists them")
    add_output(parser, "the file", "the standard output")
    args = parser.parse_args(argv)
    if args.name is None:
        lines = aligned([(name, values["title"]) for name, values in known.items()], "<")
        return Answer("\n".join([*lines, "", "mjrock new TEMPLATE -o FILE writes one."]))
    text = template(args.name)
    if args.output is None:
        return Answer(text.rstrip("\n"))
    return Answer(f"written: {write_text(require_free(args.output, args.force), text)}")
