"""`python -m mjrock COMMAND ...`: what can be asked without a script."""

from __future__ import annotations

import importlib
import sys

COMMANDS = {"status": ".study.status"}
"""Where the function `main` of each command is."""


def main() -> None:
    """Hand the arguments to the command that is named."""
    name, *rest = sys.argv[1:] or [""]
    if name not in COMMANDS:
        sys.exit(f"usage: python -m mjrock {{{','.join(COMMANDS)}}} ...; {name!r} is no command")
    importlib.import_module(COMMANDS[name], "mjrock").main(rest)


if __name__ == "__main__":
    main()
