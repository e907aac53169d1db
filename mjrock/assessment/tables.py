"""TOML text as tables with the line of each key."""

from __future__ import annotations

import contextlib
import re
import tomllib
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, NamedTuple

from ..quantities import Message
from ..reporting.texts import Words

Document = Mapping[str, Any]
"""Tables of a file as plain dictionaries and lists, or the input of the form."""
Place = tuple[str | int, ...]
"""A key by the tables that it is in: ("effects", 0, "height")."""
MOST_CHARACTERS = 1_000_000
"""Most characters of a file."""
MOST_LEVELS = 50
"""Most tables and lists within each other."""
COMMA = re.compile(r"[^#\"'\[{]*=\s*[+-]?\d+,\d")
"""A line with a number that is written with a decimal comma."""
ERROR_PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")
"""What `tomllib` says of the place of an error."""

CLOSINGS = "", "]", "]]", "]]]", '"""', "'''", '"""]', "''']"
"""What may close the last value of a text that ends within it: lists, or a text of several lines."""


class Fault(NamedTuple):
    """What is wrong with a file.

    Args:
        place: the key or table.
        message: in words, with the valid range and the remedy.
        line: of the file, from 1 on; None where there is no file.
    """

    place: Place
    message: str
    line: int | None = None


class AssessmentError(ValueError):
    """What is wrong with a file, or with tables of its form, all at once.

    Args:
        faults: what is wrong, in the order of the file.
        name: of the file; empty where there is none.
        language: of the file, in which the error is written.
    """

    def __init__(self, faults: tuple[Fault, ...], name: str = "", language: str = "en") -> None:
        self.faults, self.name, self.language = faults, name, language
        super().__init__("\n".join(self.lines))

    @property
    def lines(self) -> list[str]:
        """Each fault on a line, with the file and its line."""
        words = Words(self.language)
        lines = []
        for fault in self.faults:
            line = f"{self.name}:{fault.line}" if self.name else words.message(Message("line {line}", line=fault.line))
            lines.append(": ".join(filter(None, (line if fault.line else self.name, words.message(fault.message)))))
        return lines

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.faults, self.name, self.language)


@dataclass(frozen=True)
class Table:
    """A table of a file.

    Args:
        place: where it is.
        values: of its keys: a number, a text, a truth, a date, a list, or a table.
        places: where each of its keys stands, which may be in another table that is shared.
    """

    place: Place
    values: dict[str, Any] = field(default_factory=dict)
    places: dict[str, Place] = field(default_factory=dict)

    def without(self, *names: str) -> Table:
        """The table without some keys."""
        return Table(self.place, {name: item for name, item in self.values.items() if name not in names}, self.places)

    def place_of(self, name: str) -> Place:
        """Where a key stands, or would stand."""
        return self.places.get(name, (*self.place, name))

    def over(self, shared: Table) -> Table:
        """The table with what it shares with others: what it has itself takes the place of that, and its effects come
        after shared ones. False takes a shared table away."""
        values, places = dict(shared.values), dict(shared.places)
        for name, own_value in self.values.items():
            shared_value = values.get(name)
            if isinstance(own_value, Table) and isinstance(shared_value, Table):
                own_value = own_value.over(shared_value)
            elif name == "effects" and isinstance(own_value, list) and isinstance(shared_value, list):
                own_value = [*shared_value, *own_value]
            values[name], places[name] = own_value, self.place_of(name)
            if own_value is False and isinstance(shared_value, Table | list):
                del values[name]
        return Table(self.place, values, places)


def located(value: object, place: Place = ()) -> Any:
    """Nested dictionaries and lists as tables."""
    if isinstance(value, Mapping):
        keys = {str(name): (*place, str(name)) for name in value}
        return Table(place, {str(name): located(item, (*place, str(name))) for name, item in value.items()}, keys)
    if isinstance(value, list | tuple):
        return [located(item, (*place, i)) for i, item in enumerate(value)]
    return value


def spelt_place(place: Place) -> str:
    """A key as it is named in messages: effects[0].height."""
    text = ""
    for part in place:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text or Message("the file")


def parsed(text: str) -> dict[str, Any]:
    """The tables of a text.

    Raises:
        AssessmentError: with the line, for a text that is not TOML, is too long, or is nested too deeply.
    """
    if len(text) > MOST_CHARACTERS:
        message = Message(
            "has {count} characters; the valid range is 0 to {most}", count=len(text), most=MOST_CHARACTERS
        )
        raise AssessmentError((Fault((), message),))
    try:
        tables = tomllib.loads(text)
        if not is_deep(tables):
            return tables
        raise RecursionError
    except tomllib.TOMLDecodeError as error:
        place = ERROR_PLACE.search(str(error))
        line = int(place[1]) if place and place[1] else text.count("\n") + 1
        cause = ERROR_PLACE.sub("", str(error))
        if COMMA.match(text.split("\n")[line - 1]):
            cause = Message("a number has a comma; the decimal mark is a point, as in 0.5")
        raise AssessmentError((Fault((), Message("is not TOML: {cause}", cause=cause), line),)) from None
    except RecursionError:
        message = Message("is nested too deeply; a file has some five levels")
        raise AssessmentError((Fault((), message, 1),)) from None


def is_deep(document: Document) -> bool:
    """Whether tables and lists are within each other more than MOST_LEVELS times."""
    level: list[Any] = [document]
    for _ in range(MOST_LEVELS):
        inside = (container.values() if isinstance(container, Mapping) else container for container in level)
        level = [value for values in inside for value in values if isinstance(value, Mapping | list)]
    return bool(level)


@lru_cache(maxsize=32)
def _first_tables(text: str, count: int) -> dict[str, Any]:
    """The tables of the first lines of a text that is valid TOML, without those at the end that are no TOML even with
    what may close them."""
    for end in range(count, 0, -1):
        part = "\n".join(text.split("\n")[:end])
        for closing in CLOSINGS:
            with contextlib.suppress(tomllib.TOMLDecodeError):
                return tomllib.loads(f"{part}\n{closing}")
    return {}


def _has_key(document: Any, place: Place) -> bool:
    """Whether tables have a key."""
    for part in place:
        try:
            document = document[part]
        except (LookupError, TypeError):
            return False
    return True


def line_of(place: Place, text: str) -> int | None:
    """The line of a key in a text that is valid TOML, from 1 on, or of the table that it would be in: the first line up
    to which the text has it. None where it has neither."""
    count = text.count("\n") + 1
    tables, ends = _first_tables(text, count), range(len(place), 0, -1)
    known_place = next((place[:end] for end in ends if _has_key(tables, place[:end])), None)
    if known_place is None:
        return None
    return bisect_left(range(count), True, lo=1, key=lambda lines: _has_key(_first_tables(text, lines), known_place))
