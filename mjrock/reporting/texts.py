"""The words of a report in its language, and how it writes numbers."""

from __future__ import annotations

import math
import re
import string
import tomllib
from collections.abc import Iterable, Sequence
from decimal import Decimal
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from ..quantities import NAMED, Message, ratio_text, require_kind, require_one_of

Value = TypeVar("Value")
FILE = Path(__file__).with_name("texts.toml")
"""The texts of all languages. A further language is a further line of each."""
MESSAGES = FILE.with_name("messages.toml")
"""Messages about input in other languages, by their English templates."""
SCALES: dict[str, tuple[tuple[float, float, str], ...]] = {
    "m": ((0.1, 1, "m"), (0, 1e-3, "mm")),
    "s": ((0.01, 1, "s"), (0, 1e-3, "ms")),
    "kg": ((1e4, 1e3, "t"), (0, 1, "kg")),
    "N": ((1e6, 1e6, "MN"), (0, 1e3, "kN")),
    "J": ((1e6, 1e6, "MJ"), (1e3, 1e3, "kJ"), (0, 1, "J")),
    "N m": ((1e6, 1e6, "MN m"), (0, 1e3, "kN m")),
    "N/m": ((1e6, 1e6, "MN/m"), (0, 1e3, "kN/m")),
    "N s/m": ((0, 1e3, "kN s/m"),),
    "N/m3": ((1e9, 1e9, "GN/m³"), (0, 1e6, "MN/m³")),
    "kg/m3": ((0, 1, "kg/m³"),),
    "m/s2": ((0, 1, "m/s²"),),
}
"""How a unit is written: from which value on, divided by what, and its name then."""
SMALL = 1e-3
"""Below it a number is written with a power of ten."""
POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Digits of a power."""
DASH, MINUS = "\u2013", "\u2212"
"""What stands where there is no value, and the sign of a negative one."""
GIVEN, FOUND, BY_HAND = 7, 3, 4
"""Digits of what was given, of what was found, and of what follows from inputs and a check by hand starts from."""
LENGTH_DECIMALS = 9
"""Decimals of a length [m]: what lies below a nanometre is rounding."""
WITH_UNIT = re.compile(r"[-\u2212\d.]+ \w+")
"""A number with its unit, such as the length beside a dimension line."""
PRINTED_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?")
"""A number as a message has it."""
SHARED = 4
"""Digits of a share."""


@cache
def texts(*more: Path) -> dict[str, dict[str, str]]:
    """Every text by its key and its language: those of the report, and those of further files."""
    every_text: dict[str, dict[str, str]] = {}
    for file in (FILE, *more):
        every_text |= tomllib.loads(file.read_text(encoding="utf-8"))
    return every_text


@cache
def drawn_patterns() -> list[tuple[re.Pattern[str], str]]:
    """What plot functions print, in English and with groups for the values, and its key: every text of a key that
    begins with `drawn_`, and the names of solvers."""
    keys = (key for key in texts() if key.startswith(("drawn_", "short_")))
    return [(_pattern(texts()[key]["en"]), key) for key in keys]


@cache
def messages() -> dict[str, Any]:
    """The texts of messages by their language and their English template, and under `texts` those of messages that are
    raised without one."""
    return tomllib.loads(MESSAGES.read_text(encoding="utf-8"))


@cache
def plain_patterns(language: str) -> list[tuple[re.Pattern[str], str]]:
    """Messages that are raised without a template, with groups for the values, and their texts in a language; the one
    that states most comes first."""
    texts = messages()["texts"].get(language, {})
    return [(_pattern(text), texts[text]) for text in sorted(texts, key=lambda text: -len(re.sub("{.*?}", "", text)))]


def _pattern(template: str) -> re.Pattern[str]:
    """What is written by a template, with a group for each value."""
    parts = ((re.escape(literal), name) for literal, name, *_ in string.Formatter().parse(template))
    return re.compile("".join(text if name is None else f"{text}(?P<{name}>.*?)" for text, name in parts), re.DOTALL)


def languages() -> list[str]:
    """The languages that every text has."""
    return sorted(set.intersection(*(set(text) for text in texts().values())))


class Words:
    """The words of one language.

    Args:
        language: one of `languages()`.
        more: files of further texts, such as those of the form.

    Raises:
        TypeError, ValueError: for any other, with those that there are.
    """

    def __init__(self, language: str, *more: Path) -> None:
        require_kind("language", language, str)
        self.language = require_one_of("language", language, languages())
        self.texts = texts(*more)
        self.mark = self.texts["decimal_mark"][language]

    def __call__(self, key: str, /, **values: object) -> str:
        """The text of a key, with values in their places."""
        return self.texts[key][self.language].format(**values)

    def or_else(self, key: str, other: str) -> str:
        """The text of a key, or another one where there is none."""
        return self(key) if key in self.texts else other

    def drawn(self, text: str) -> str:
        """The text of a picture in this language, line by line where a plot function has printed it; else as it is."""
        return "\n".join(self._drawn_line(line) for line in text.split("\n"))

    def _drawn_line(self, line: str) -> str:
        line = re.sub(r"[a-z_]+_\d+", lambda name: effect_name(name[0], self), line)
        for pattern, key in drawn_patterns():
            if match := pattern.fullmatch(line):
                values = {
                    name: re.sub(
                        r"(?<=\d)\.(?=\d)", self.mark, self.or_else(f"effect_{value.replace(' ', '_')}", value)
                    )
                    for name, value in match.groupdict().items()
                }
                return self(key, **values)
        return self.marked(line) if WITH_UNIT.fullmatch(line) else line

    def message(self, text: str) -> str:
        """A message of the program in this language, as far as it has a text; else as it is, in English.

        The cause of a refusal that has no text stays behind what is known of its place: the key, value and range.
        """
        if not isinstance(text, Message):
            return self._plain(text)
        template = messages().get(self.language, {}).get(text.template)
        if template is None:
            return text
        cause = text.values.get("cause")
        if "known" in text.values and isinstance(cause, str) and self.message(cause) is cause:
            template = self.texts["cause_in_english"][self.language]
        return Filling(self).vformat(template, (), text.values)

    def _plain(self, text: str) -> str:
        """A message without a template in this language; as it is where it has no text, or its cause has none."""
        for pattern, template in plain_patterns(self.language):
            if match := pattern.fullmatch(text):
                values = {name: self.message(value) for name, value in match.groupdict().items()}
                if values.get("cause") is None or values["cause"] != match["cause"]:
                    numbers = {
                        name: self.marked(part) for name, part in values.items() if PRINTED_NUMBER.fullmatch(part)
                    }
                    return template.format(**values | numbers)
        return text

    def marked(self, text: str) -> str:
        """Numbers of a text with the decimal mark of the language."""
        return text.replace(".", self.mark)

    def number(self, value: float, digits: int = GIVEN) -> str:
        """A number with a given number of significant digits; results keep their last zeros."""
        if not math.isfinite(value):
            return "∞" if value > 0 else DASH
        if 0 < abs(value) < SMALL:
            power = math.floor(math.log10(abs(value)) + 1e-12)
            return f"{self.number(value / 10**power, digits)}\u00b710{str(power).translate(POWERS)}"
        text = format(Decimal(f"{value:#.{digits}g}"), "f")
        if digits != FOUND and "." in text:
            text = text.rstrip("0").rstrip(".")
        return self.marked(text).replace("-", MINUS)

    def ratio(self, value: float) -> str:
        """A ratio of capacity over demand, see `ratio_text`."""
        return self.marked(ratio_text(value))

    def quantity(self, value: float, unit: str, digits: int = GIVEN) -> str:
        """A number with its unit and the prefix that suits it."""
        value = round(value, LENGTH_DECIMALS) + 0.0 if unit == "m" and math.isfinite(value) else value
        scales = SCALES.get(unit, ((0.0, 1.0, unit),))
        suits = (scale for scale in scales if (abs(value) >= scale[0] if value else scale[1] == 1))
        _, factor, name = next(suits, scales[-1])
        return f"{self.number(value / factor, digits)}\u00a0{name}" if name else self.number(value / factor, digits)

    def named(self, names: Sequence[str]) -> str:
        """Names, not too many."""
        text = ", ".join(names[:NAMED])
        return self("and_more", names=text, count=len(names) - NAMED) if names[NAMED:] else text

    def share(self, value: float) -> str:
        """A share in per cent."""
        return f"{self.number(100 * value, SHARED)}\u00a0%"


class Filling(string.Formatter):
    """Fills values into the text of a message: numbers with the decimal mark of a language, and messages in it.

    Args:
        words: of the language.
    """

    def __init__(self, words: Words) -> None:
        self.words = words

    def format_field(self, value: object, format_spec: str) -> str:
        """A value as it stands in the text."""
        text = self.words.message(value) if isinstance(value, str) else super().format_field(value, format_spec)
        return self.words.marked(text) if isinstance(value, int | float) else str(text)


def grouped(named: Iterable[tuple[str, Value]]) -> list[tuple[list[str], Value]]:
    """Equal values once, each with all of its names, in the order of the first."""
    groups: list[tuple[list[str], Value]] = []
    for name, value in named:
        names = next((names for names, other in groups if other == value), None)
        if names is None:
            groups.append(([name], value))
        elif name not in names:
            names.append(name)
    return groups


def effect_name(name: str, words: Words) -> str:
    """An effect, such as the second of the ties, in words; a limit state as it is."""
    stem, _, number = name.rpartition("_")
    known = words.or_else(f"effect_{stem}", "")
    return f"{known} {int(number) + 1}" if known and number.isdigit() else name
