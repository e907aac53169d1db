"""Tables as CSV text that NumPy, pandas and a spreadsheet read, and as aligned text."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence


def csv_text(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Rows as CSV text that `np.genfromtxt(path, delimiter=",", names=True)` and pandas read, see `written`.

    NumPy knows no quotation marks and takes # for the start of a comment. Commas, quotation marks and # are therefore
    left out of the header, and in the cells a comma becomes a semicolon. Numbers keep all their digits.

    Raises:
        ValueError: if two columns have the same name.
    """
    names = [" ".join(re.sub('[,"#]', "", name).split()) for name in header]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"two columns have the name {twice[0]!r}")
    return written([names, *([_cell(value) for value in row] for row in rows)])


def written(rows: Iterable[Sequence[object]]) -> str:
    """Rows as CSV text. Text that a spreadsheet would take for a formula has an apostrophe before it."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(map(_guarded, row) for row in rows)
    return text.getvalue()


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows of cells as lines whose columns end below each other."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]


def _cell(value: object) -> object:
    if not isinstance(value, str):
        return value
    return value.replace(",", ";").replace("#", "no. ").replace('"', "'")


def _guarded(value: object) -> object:
    """A cell that no spreadsheet computes: text that begins like a formula, and is not a number, gets an apostrophe."""
    if not isinstance(value, str) or not value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value
