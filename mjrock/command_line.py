"""Commands: reading of their arguments, their answers, and the files that they may write."""

from __future__ import annotations

import argparse
import errno
import shutil
from collections.abc import Sequence
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

from .contacts.files import aligned
from .notice import notice

WIDEST = 98
"""Columns of a help text, at most."""


class Status(IntEnum):
    """The exit status of a command. One that checks nothing ends as if it held."""

    HOLDS = 0
    FAILS = 1
    ERROR = 2
    INTERRUPTED = 130
    BROKEN_PIPE = 141


class Answer(NamedTuple):
    """The answer of a command.

    Args:
        text: for the standard output.
        status: the exit status.
    """

    text: str
    status: Status = Status.HOLDS


class Help(argparse.RawDescriptionHelpFormatter):
    """Help of at most WIDEST columns, with the lines of a description as they are written."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=min(WIDEST, shutil.get_terminal_size().columns - 2))


def parser_of(name: str, description: str, epilog: str = "") -> argparse.ArgumentParser:
    """The parser of a command.

    Args:
        name: of the command.
        description: what it does.
        epilog: text below its arguments in the help.
    """
    return argparse.ArgumentParser(f"mjrock {name}", description=description, epilog=epilog, formatter_class=Help)


def add_output(parser: argparse.ArgumentParser, what: str, default: str = "") -> None:
    """Add `--output` and `--force`.

    Args:
        parser: of the command.
        what: what the file or folder is, in words.
        default: where it is without `--output`, in words.
    """
    text = f"{what}; without it {default}" if default else what
    parser.add_argument("-o", "--output", type=Path, metavar="PATH", help=text)
    parser.add_argument("-f", "--force", action="store_true", help="replace files that exist")


def ruled(rows: Sequence[Sequence[str]], sides: str) -> list[str]:
    """The lines of a table with a rule below its heads.

    Args:
        rows: cells; the first row has the heads.
        sides: of each column, "<" or ">".
    """
    head, *body = aligned(rows, sides)
    return [head, "-" * max(map(len, (head, *body))), *body]


def require_free(path: Path, force: bool) -> Path:
    """Return a path to write to.

    Args:
        path: of a file.
        force: whether a file that is there may be replaced.

    Raises:
        FileExistsError: with the path and the remedy, if something is there and may not be replaced.
    """
    if not force and path.exists():
        raise FileExistsError(errno.EEXIST, "exists already, and --force replaces it", str(path))
    return path


def message_of(error: Exception) -> str:
    """The message of an error; that of a file begins with its name."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error)


def complain(error: Exception) -> None:
    """Write an error for the user, each of its lines as one."""
    for line in message_of(error).splitlines():
        notice(line, by="error")
