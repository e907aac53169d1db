"""`python -m mjcontacts inspect model.xml`: commands on the contacts of a MuJoCo model."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from . import command, measure_command
from .checks import PACKAGE


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit status: 2 for what the user can mend."""
    parser = argparse.ArgumentParser(f"python -m {PACKAGE}", description="Contacts of a MuJoCo model in N/m and N s/m.")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, module, line in (
        ("inspect", command, "what they are, the worst first"),
        ("measure", measure_command, "drop, press and push a contact of two geoms, and compare"),
    ):
        subparser = commands.add_parser(name, help=line)
        module.add_arguments(subparser)
        subparser.set_defaults(answer=module.answer)
    args = parser.parse_args(argv)
    try:
        text = args.answer(args)
    except (ValueError, TypeError, OSError, ImportError) as error:
        sys.stderr.write(f"error: {error}\n")
        return 2
    sys.stdout.write(f"{text}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
