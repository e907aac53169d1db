"""Numbers with a unit as text, such as "60 kN", turned into the SI unit of a declaration."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import NamedTuple

from ..quantities import GRAVITY, Message

BASES = ("m", "kg", "s", "rad")
Exponents = tuple[int, int, int, int]


class UnitError(ValueError):
    """What is wrong with the text of a number, as the rest of a sentence that begins with the key and the text."""


class Unit(NamedTuple):
    """A unit as a product of powers of m, kg, s and rad.

    Args:
        exponents: of m, kg, s and rad.
        factor: SI units in one of it, exact.
        times: what it is multiplied with besides, such as GRAVITY, which has no short fraction.
    """

    exponents: Exponents
    factor: Fraction = Fraction(1)
    times: float = 1.0

    def __mul__(self, other: Unit) -> Unit:  # type: ignore[override]
        total = tuple(a + b for a, b in zip(self.exponents, other.exponents, strict=True))
        return Unit(total, self.factor * other.factor, self.times * other.times)  # type: ignore[arg-type]

    def raised(self, power: int) -> Unit:
        """The unit to a whole power."""
        return Unit(tuple(power * exponent for exponent in self.exponents), self.factor**power, self.times**power)  # type: ignore[arg-type]


PLAIN = Unit((0, 0, 0, 0))
METRES, NEWTONS, PASCALS, SECONDS = (1, 0, 0, 0), (1, 1, -2, 0), (-1, 1, -2, 0), (0, 0, 1, 0)
PER_S2, RADIANS, KILOGRAMS, HERTZ = (1, 0, -2, 0), (0, 0, 0, 1), (0, 1, 0, 0), (0, 0, -1, 0)
UNITS = {
    "m": Unit(METRES), "dm": Unit(METRES, Fraction(1, 10)), "cm": Unit(METRES, Fraction(1, 100)),
    "mm": Unit(METRES, Fraction(1, 1000)), "km": Unit(METRES, Fraction(1000)),
    "kg": Unit(KILOGRAMS), "t": Unit(KILOGRAMS, Fraction(1000)),
    "s": Unit(SECONDS), "ms": Unit(SECONDS, Fraction(1, 1000)), "min": Unit(SECONDS, Fraction(60)),
    "Hz": Unit(HERTZ),
    "N": Unit(NEWTONS), "daN": Unit(NEWTONS, Fraction(10)), "kN": Unit(NEWTONS, Fraction(1000)),
    "MN": Unit(NEWTONS, Fraction(10**6)),
    "Pa": Unit(PASCALS), "kPa": Unit(PASCALS, Fraction(1000)), "MPa": Unit(PASCALS, Fraction(10**6)),
    "GPa": Unit(PASCALS, Fraction(10**9)), "bar": Unit(PASCALS, Fraction(10**5)),
    "J": Unit((2, 1, -2, 0)), "kJ": Unit((2, 1, -2, 0), Fraction(1000)),
    "g": Unit(PER_S2, times=GRAVITY),
    "rad": Unit(RADIANS), "mrad": Unit(RADIANS, Fraction(1, 1000)),
    "deg": Unit(RADIANS, times=math.pi / 180), "°": Unit(RADIANS, times=math.pi / 180),
    "-": PLAIN, "%": Unit((0, 0, 0, 0), Fraction(1, 100)),
}  # fmt: skip
"""The units that a text may have. g is the acceleration of gravity."""
POWERS = str.maketrans({"²": "2", "³": "3", "·": " ", "*": " ", "µ": "u"})
TEXT = re.compile(r"\s*([+-]?(?:\d{1,30}\.?\d{0,30}|\.\d{1,30})(?:[eE][+-]?\d{1,3})?)\s*(.*?)\s*", re.DOTALL)
"""A number and its unit."""
COMMA = re.compile(r",\d")
"""What follows a number that is written with a decimal comma."""
PART = re.compile(r"([a-zA-Z°%-]+?)\^?(\d?)")


def unit_named(text: str) -> Unit | None:
    """A unit such as "kN/m2" or "N s/m"; None for a text that is none."""
    over, *under = text.translate(POWERS).split("/")
    if len(under) > 1 or (under and not under[0].strip()):
        return None
    total = PLAIN
    for part, sign in [*((word, 1) for word in over.split()), *((word, -1) for term in under for word in term.split())]:
        match = PART.fullmatch(part)
        if match is None or match[1] not in UNITS:
            if not (part == "1" and sign > 0):
                return None
            continue
        total = total * UNITS[match[1]].raised(sign * int(match[2] or 1))
    return total


def examples_of(unit: str) -> str:
    """What a number of a unit may be written like, for messages."""
    usual = {
        "m": '"30 cm"', "N": '"60 kN"', "Pa": '"1.5 MPa"', "kg/m3": '"18 kN/m3"', "rad": '"12 deg"',
        "m/s2": '"0.24 g"', "kg": '"9 kN"', "N/m": '"22 kN/mm"', "N/m3": '"0.5 N/mm3"', "s": '"0.3 s"',
    }  # fmt: skip
    return usual.get(unit, f'"1 {unit}"')


def value_in(text: str, unit: str) -> float:
    """The number of a text such as "60 kN" in a declared unit, rounded once.

    Where a mass [kg] or a density [kg/m3] is declared, a weight, or a weight per volume, is divided by 9.81 m/s2.

    Raises:
        UnitError: for a text that is no number with a unit, or one of another dimension, with what is due.
    """
    match = TEXT.fullmatch(text)
    declared_unit = unit_named(unit) or PLAIN
    due = Message("a number in {unit}", unit=unit) if unit else Message("a number")
    example = examples_of(unit) if unit else "0.5"
    if match is None:
        raise UnitError(Message("is not {kind}, such as {example}", kind=due, example=example))
    number = Fraction(match[1])
    if not match[2]:
        plain = unit or Message("a plain number")
        raise UnitError(Message("has no unit; write the number without quotes for {plain}", plain=plain))
    if COMMA.match(match[2]):
        raise UnitError(Message("has a comma; the decimal mark is a point, as in 0.5"))
    values = {"unit": match[2], "kind": due, "example": example}
    given_unit = unit_named(match[2])
    if given_unit is None:
        unknown = "has the unit {unit!r}, which is not known; {kind} is due, such as {example}"
        raise UnitError(Message(unknown, **values))
    scale = given_unit.factor / declared_unit.factor
    if given_unit.exponents == declared_unit.exponents:
        return float(number * scale) * (given_unit.times / declared_unit.times)
    weight = (Unit(declared_unit.exponents) * Unit(PER_S2)).exponents
    if declared_unit.exponents[BASES.index("kg")] == 1 and unit in ("kg", "kg/m3") and given_unit.exponents == weight:
        return float(number * scale) * given_unit.times / GRAVITY
    raise UnitError(Message("has the unit {unit}, and {kind} is due, such as {example}", **values))
