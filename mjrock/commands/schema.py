"""`mjrock schema`: the keys of the file of an assessment, for editors that complete and check it."""

from __future__ import annotations

import json
from collections.abc import Sequence

from ..assessment.schema import toml_schema
from ..command_line import Answer, parser_of


def answer(argv: Sequence[str]) -> Answer:
    """The JSON schema of files."""
    parser_of("schema", "Print the JSON schema of files, which editors complete and check TOML by.").parse_args(argv)
    return Answer(json.dumps(toml_schema(), ensure_ascii=False, separators=(",", ":")))
