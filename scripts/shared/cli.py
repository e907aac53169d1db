"""What the scripts share: arguments, output folder, tables, files that are whole or absent, times, readable errors."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from tqdm import tqdm

from scripts.shared import figure_record

# The package is imported where it is needed: `speed.py` times versions of it that have other modules.


class Defaults(argparse.ArgumentDefaultsHelpFormatter):
    """Help that names the default of an option where it has one."""

    def _get_help_string(self, action: argparse.Action) -> str | None:
        if action.default is None or action.default is False:
            return action.help
        return super()._get_help_string(action)


def parser(description: str | None, out: str) -> argparse.ArgumentParser:
    """A parser with the options that every script has."""
    made = argparse.ArgumentParser(description=(description or "").splitlines()[0], formatter_class=Defaults)
    made.add_argument("--out", type=Path, default=Path("out") / out, help="folder for the files that are written")
    made.add_argument("--quick", action="store_true", help="a shorter study, to see that it works")
    return made


def write_text(path: Path, text: str) -> Path:
    """Write a file that is whole or absent."""
    from mjrock.contacts.files import write_text as write

    return write(path, text)


def csv_text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Rows as CSV."""
    from mjrock.contacts.files import csv_text as text

    return text(header, rows)


def folder(path: Path) -> Path:
    """Make the output folder, and find out before any work whether it can be written to."""
    path.mkdir(parents=True, exist_ok=True)
    write_text(path / ".writable", "").unlink()
    return path


def table(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Rows as aligned text for a terminal."""
    from mjrock.contacts.files import aligned

    head, *body = aligned([[str(cell) for cell in row] for row in (header, *rows)])
    return "\n".join([head, "-" * len(head), *body])


def report(stem: Path, text: str, header: Sequence[str] = (), rows: Iterable[Sequence[object]] = ()) -> None:
    """Print a text and write it as `stem`.txt, and a table, where there is one, as `stem`.csv."""
    if header:
        write_text(stem.with_suffix(".csv"), csv_text(header, rows))
    write_text(stem.with_suffix(".txt"), text + "\n")
    print(text)


def beside_closed_forms(
    args: argparse.Namespace,
    stem: str,
    what: str,
    quantity: str,
    cases: Sequence[str],
    both: Callable[[str], tuple[float, float]],
) -> None:
    """Print and write a table of some cases: the closed form, what was found, and its error.

    Args:
        args: of the script; `quick` takes the first case alone.
        stem: name of the files, without ending.
        what, quantity: what a case is, and what is compared.
        cases: their names.
        both: the closed form of a case and what was found.
    """
    rows: list[list[object]] = []
    for name in tqdm(cases[:1] if args.quick else cases, desc=stem, disable=None, leave=False):
        expected, found = both(name)
        rows.append([name, f"{expected:.4f}", f"{found:.4f}", f"{found / expected - 1:+.1%}"])
    header = [what, f"{quantity}, closed form", "found", "error"]
    report(folder(args.out) / stem, table(header, rows), header, rows)


def seconds(call: Callable[[], object]) -> float:
    """Wall time of a call [s]."""
    started = time.perf_counter()
    call()
    return time.perf_counter() - started


def run(main: Callable[[Sequence[str] | None], None]) -> int:
    """Call a script's main, and record what it writes into a folder of figures. Returns the exit code.

    An error that the user can mend is printed, not traced.
    """
    try:
        with figure_record.recorded(Path(main.__code__.co_filename), sys.argv[1:]):
            main(None)
    except (ValueError, TypeError, OSError, RuntimeError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt as error:
        print(f"interrupted: {error}", file=sys.stderr)
        return 130
    return 0
