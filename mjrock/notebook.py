"""Pictures and tables that a notebook shows of an answer without a call."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import ClassVar

VERDICTS = {"HOLDS": "#2c6e49", "FAILS": "#b5402a"}
"""Colours of the words of a verdict."""


class NotebookPicture:
    """Base of classes that a notebook shows as pictures, which `mjrock.plotting.notebook` draws by their types."""

    _png_of: ClassVar[Callable[[object], bytes | None]]
    """Draws it. The top of the package sets this, since pictures stand above what they show."""

    def _repr_png_(self) -> bytes | None:
        return NotebookPicture._png_of(self)


def html_of(text: str, *tables: Iterable[Sequence[str]]) -> str:
    """A line of text above tables, the words of a verdict in their colours.

    Args:
        text: the line.
        tables: rows of cells, all texts.
    """
    html_tables = ["".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows) for rows in tables]
    return f"<p>{escape(text)}</p>" + "".join(f"<table>{rows}</table>" for rows in html_tables)


def _cell(text: str) -> str:
    colour = VERDICTS.get(text.partition(",")[0])
    look = f"text-align: left; color: {colour}; font-weight: bold" if colour else "text-align: left"
    return f'<td style="{look}">{escape(text)}</td>'
