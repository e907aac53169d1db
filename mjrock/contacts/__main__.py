"""`python -m mjcontacts inspect model.xml`: commands on the contacts of a MuJoCo model, see `command`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from . import command
from .checks import PACKAGE


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit status: 2 for what the user can mend."""
    made = argparse.ArgumentParser(f"python -m {PACKAGE}", description="Contacts of a MuJoCo model in N/m and N s/m.")
    commands = made.add_subparsers(metavar="COMMAND", required=True)
    command.add_arguments(commands.add_parser("inspect", help="what they are, the worst first"))
    args = made.parse_args(argv)
    try:
        text = command.answer(args)
    except (ValueError, TypeError, OSError) as error:
        sys.stderr.write(f"error: {error}\n")
        return 2
    sys.stdout.write(f"{text}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
