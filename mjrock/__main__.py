"""`mjrock COMMAND ...`, which is `python -m mjrock COMMAND ...`: commands that need no script."""

from __future__ import annotations

import importlib
import io
import os
import sys
from argparse import SUPPRESS
from collections.abc import Sequence
from typing import NamedTuple

from ._version import __version__
from .command_line import Answer, Status, complain, parser_of
from .contacts.files import aligned
from .notice import collect_warnings, notice


class Command(NamedTuple):
    """A command.

    Args:
        module: whose function `answer` takes the arguments of the command and returns an `Answer`; in `contacts`, which
            is a package of its own too, it takes what a parser with its `add_arguments` has read, and returns a text.
        line: what it does.
    """

    module: str
    line: str

    def answer(self, name: str, arguments: Sequence[str]) -> Answer:
        """What the command answers under its name."""
        module = importlib.import_module(self.module, "mjrock")
        if not self.module.startswith(".contacts."):
            answer: Answer = module.answer(arguments)
            return answer
        parser = parser_of(name, (module.__doc__ or "").splitlines()[0])
        module.add_arguments(parser)
        return Answer(module.answer(parser.parse_args(arguments)))


COMMANDS = {
    "new": Command(".commands.new", "write a file of a facade, gable, parapet, chimney, bending, corner or masonry"),
    "check": Command(".commands.check", "whether the mechanisms of a file hold, clause by clause"),
    "run": Command(".commands.run", "the motion of a file under its records, with a table, a picture and a film"),
    "design": Command(".commands.design", "the first value of a file for which every condition holds"),
    "report": Command(".commands.report", "the report of a file, as PDF or as HTML, in English or Italian"),
    "schema": Command(".commands.schema", "what a file may have, as JSON schema for editors"),
    "demo": Command(".commands.demo", "a wall in MuJoCo beside rocking theory, with a table and a picture"),
    "examples": Command(".commands.examples", "list the examples, run one, or copy its script"),
    "app": Command(".app.command", "a form in the browser: checks, runs and reports, on this machine alone"),
    "compile": Command(".study.compilation", "compile the loops of all solvers and store them, once"),
    "status": Command(".study.campaign.progress", "how far a campaign is, from its store"),
    "inspect": Command(".contacts.command", "contacts of a MuJoCo model in physical units"),
    "measure": Command(".contacts.measure_command", "drop, press and push a contact of a MuJoCo model, and compare"),
}
"""Every command, in the order of the help."""
STATUSES = "Exit status: 0 holds or done, 1 does not hold, 2 error, 130 interrupted."


def answered(arguments: Sequence[str]) -> Answer:
    """What the command that is named answers; without one, the help."""
    parser = parser_of("", "Rocking masonry in MuJoCo, by explicit steps and by theory. Commands that need no script.")
    parser.prog, parser.usage = "mjrock", "mjrock COMMAND ..."
    lines = aligned([("", name, command.line) for name, command in COMMANDS.items()], "<")
    parser.epilog = "\n".join(["commands:", *lines, "", "mjrock COMMAND --help describes a command.", STATUSES])
    parser.add_argument("--version", action="version", version=f"mjrock {__version__}", help="print the version")
    parser.add_argument("command", choices=COMMANDS, metavar="COMMAND", help=SUPPRESS)
    if not arguments:
        return Answer(parser.format_help().rstrip())
    name = parser.parse_args(arguments[:1]).command
    return COMMANDS[name].answer(name, arguments[1:])


def leave_output() -> None:
    """Let what is still to be written go nowhere, so that Python does not fail to write it at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def write(text: str) -> None:
    """Write to the standard output; nothing if nobody reads on, as of `| head`.

    Raises:
        OSError: if it is full.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        leave_output()
    except OSError as error:
        leave_output()
        raise OSError(error.errno, error.strerror, "standard output") from None


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit status: 1 for what does not hold, 2 for what the user can mend."""
    if isinstance(sys.stdout, io.TextIOWrapper) and not sys.stdout.isatty():
        sys.stdout.reconfigure(encoding="utf-8")  # files of TOML are UTF-8 on every system
    try:
        with collect_warnings(lambda text: notice(text.partition(": ")[2], by="warning")):
            answer = answered(list(sys.argv[1:] if argv is None else argv))
        if answer.text:
            write(answer.text)
    except KeyboardInterrupt as interrupt:
        notice(": ".join(filter(None, ("interrupted", str(interrupt)))))
        return Status.INTERRUPTED
    except BrokenPipeError:
        leave_output()
        return Status.BROKEN_PIPE
    except (ValueError, TypeError, OSError, RuntimeError, ImportError) as error:
        complain(error)
        return Status.ERROR
    return answer.status


if __name__ == "__main__":
    sys.exit(main())
