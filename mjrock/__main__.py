"""`python -m mjrock COMMAND ...`: commands that need no script."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence

from .notice import notice

COMMANDS = {
    "compile": ".study.compilation",
    "inspect": ".anymodel.command",
    "status": ".study.campaign.progress",
    "view": ".engine.replay",
}
"""Where the function `answer` of each command is, which takes its arguments and returns a text."""
HELP = {
    "compile": "compile the loops of all solvers and store them, once for an installation",
    "inspect": "contacts of a MuJoCo model in physical units",
    "status": "how far a campaign is, from its store",
    "view": "a model and its answer in MuJoCo's viewer",
}


def parser() -> argparse.ArgumentParser:
    """The command that is named; the arguments after it are its own."""
    told = "; ".join(f"{name}: {text}" for name, text in HELP.items())
    made = argparse.ArgumentParser(
        "python -m mjrock", f"python -m mjrock {{{','.join(COMMANDS)}}} ...", "Commands that need no script."
    )
    made.add_argument("command", choices=COMMANDS, help=told)
    return made


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit code: 2 for what the user can mend."""
    given = list(sys.argv[1:] if argv is None else argv)
    module = COMMANDS[parser().parse_args(given[:1]).command]
    try:
        text = importlib.import_module(module, "mjrock").answer(given[1:])
    except (ValueError, TypeError, OSError) as error:
        notice(str(error), by="error")
        return 2
    try:
        print(text, flush=True)
    except BrokenPipeError:  # nobody reads on, as of `| head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0


if __name__ == "__main__":
    sys.exit(main())
