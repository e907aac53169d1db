"""The range of a number is declared once, and the docstring of its class says the same."""

import inspect
import math
import re
from dataclasses import is_dataclass
from typing import Annotated

import numpy as np
import pytest

import mjrock as mr
from mjrock.quantities import Within, declared, keep_declared, within_ranges

PUBLIC = [getattr(mr, name) for name in mr.HOME] + [getattr(mr.blocks, name) for name in mr.blocks.__all__]
CLASSES = [kind for kind in PUBLIC if isinstance(kind, type) and is_dataclass(kind)]
FUNCTIONS = [
    function
    for kind in PUBLIC
    for member in ([kind] if not isinstance(kind, type) else vars(kind).values())
    if hasattr(function := getattr(member, "__func__", member), "__wrapped__") and inspect.isfunction(function)
]
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?(?: pi)?|pi"


def of_argument(kind, name):
    """What the docstring of a class or function says of an argument, all of it where it names none."""
    of_class = kind.__name__ == "__init__"
    text = inspect.getdoc(getattr(mr, kind.__qualname__.split(".")[0]) if of_class else kind)
    entry = rf"^ {{4}}(?:\w+, )*{name}(?:, \w+)*: (.*?)(?=^ {{4}}\w|^\S|\Z)"
    found = re.search(entry, text, re.MULTILINE | re.DOTALL)
    return " ".join((found[1] if found else text).split())


def number(text):
    """A number in words, such as "-2 pi"."""
    times = text.removesuffix("pi").strip()
    return float(times or 1) * (math.pi if text.endswith("pi") else 1)


def faults(kind):
    """The declared numbers of a class or function whose docstring lacks or contradicts their range or unit."""
    for name, one in declared(kind).items():
        within = one.within
        text = of_argument(kind, name)
        found = re.findall(rf"({NUMBER}) to ({NUMBER})", text)
        ranges = [tuple(number(end) for end in ends) for ends in found]
        if re.search(r"(as|those) of `", text):
            continue
        if (within.low, within.high) not in ranges or (f"[{within.unit or '-'}]" not in text and not within.whole):
            message = f"{within.low:g} to {within.high:g} [{within.unit or '-'}]"
            yield f"{kind.__qualname__}.{name}: {message} is not in {text!r}"


def test_docstrings_have_the_declared_ranges():
    assert [fault for kind in (*CLASSES, *FUNCTIONS) for fault in faults(kind)] == []


def test_numbers_are_declared():
    assert sum(len(declared(kind)) for kind in CLASSES) > 50
    assert sum(len(declared(function)) for function in FUNCTIONS) > 40


class Wall:
    """A class of a test.

    Args:
        height: of the wall [m], 0 to 10.
        length: of the wall [cm], 0 to 5.
        floors: of the wall, 1 to 3.
        thickness: of the wall [m], 0 to 0.5; None is not known.
    """

    height: Annotated[float, Within(0, 20, "m")]
    length: Annotated[float, Within(0, 5, "m")]
    floors: Annotated[int, Within(1, 3, whole=True)]
    thickness: Annotated[float | None, Within(0, 0.5, "m")]

    def __init__(self, height, length, floors, thickness):
        self.height, self.length, self.floors, self.thickness = height, length, floors, thickness
        keep_declared(self, "wall")


def test_docstrings_with_another_range_or_unit_are_found():
    assert [fault.split(":")[0] for fault in faults(Wall)] == ["Wall.height", "Wall.length"]


def test_numbers_are_checked_and_kept_as_declared():
    wall = Wall(np.float32(20), 5, 3.0, None)
    assert [type(value) for value in vars(wall).values()] == [float, float, int, type(None)]
    for wrong, message in (
        ((20.1, 5, 3, None), "height of the wall = 20.1 m is outside the valid range 0 to 20 m"),
        ((math.nan, 5, 3, None), "height of the wall = nan m"),
        ((20, None, 3, None), "length of the wall = None is not a real number"),
        ((20, 5, 2.5, None), "floors of the wall = 2.5 is not a whole number"),
        ((20, 5, 3, 0.6), "thickness of the wall = 0.6 m"),
    ):
        with pytest.raises((TypeError, ValueError), match=re.escape(message)):
            Wall(*wrong)


@within_ranges
def volume(height: Annotated[float, Within(0, 20, "m")], count: Annotated[int | None, Within(1, 3, whole=True)] = None):
    """A function of a test."""
    return height, count


def test_arguments_are_checked_and_converted_as_declared():
    assert [type(value) for value in volume(np.float32(20), count=3.0)] == [float, int]
    assert volume(5, None) == (5.0, None)
    assert volume.__doc__ == "A function of a test."
    for call, message in (
        (lambda: volume(-1), "height = -1 m is outside the valid range 0 to 20 m"),
        (lambda: volume(1, count=2.5), "count = 2.5 is not a whole number"),
        (lambda: volume(), "volume() missing 1 required positional argument: 'height'"),
        (lambda: volume(1, depth=2), "volume() got an unexpected keyword argument 'depth'"),
    ):
        with pytest.raises((TypeError, ValueError), match=re.escape(message)):
            call()
