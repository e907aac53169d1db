"""Text of recorded accelerations: lines, numbers, units and steps, which the readers of all formats share.

A parser takes the lines of a file and returns its traces. A number has ASCII digits and may have a Fortran exponent,
1.5D-02. A ValueError with the line says where the samples are not as many as the file states, and where a word on a
line of numbers is not a finite number.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...files import require_file
from ...quantities import GRAVITY, Array, require_one_of, require_path, require_reals, require_within

FINEST, COARSEST = 1e-5, 1.0
"""Bounds of the time step of a motion [s]."""
ACCELERATION_UNITS = {"m/s2": 1.0, "cm/s2": 1e-2, "mm/s2": 1e-3, "g": GRAVITY, "ft/s2": 0.3048}
TIME_UNITS = {"s": 1.0, "ms": 1e-3}

AS_ASCII = re.ASCII | re.IGNORECASE
EXPONENT = r"(?:[ed][-+]?\d+)?"
COUNT, DECIMAL = r"(\d{1,9})", rf"((?:\d+(?:\.\d*)?|\.\d+){EXPONENT})"
"""No run of digits or blanks can be parted in two ways, so that the time of a search goes with the length of a line."""
DECIMAL_NUMBER = re.compile(rf"[-+]?{DECIMAL}", AS_ASCII)
POINTED = rf"[-+]?(?:\d+\.\d*|\.\d+){EXPONENT}"
GLUED = re.compile(rf"{POINTED}(?:(?=[-+]){POINTED})+", AS_ASCII)
"""Columns of fixed width that a sign sets apart. Each has its decimal point: 1.5-102 is an exponent in Fortran."""
BREAK = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\x85\u2028\u2029]")
"""A control character, which could hide a row at the end of a header or comment."""
PER_SECOND = r" ?[/ .] ?s(?:ec)?(?: ?/ ?s(?:ec)?| ?(?:\^|\*\*)? ?-?[2\u00b2])(?![a-z])"
STATED_UNITS = {
    "mm/s2": re.compile(rf"(?<![a-z])mm{PER_SECOND}", AS_ASCII),
    "cm/s2": re.compile(rf"(?<![a-z])(?:cm{PER_SECOND}|gals?(?![a-z]))", AS_ASCII),
    "m/s2": re.compile(rf"(?<![a-z])m{PER_SECOND}", AS_ASCII),
    "ft/s2": re.compile(rf"(?<![a-z])ft{PER_SECOND}", AS_ASCII),
    "g": re.compile(r"\( ?g ?\)|\[ ?g ?\]|(?<![a-z])(?:in|units?)(?: of| ?[:=]| in)* ?g(?![a-z/])", AS_ASCII),
}
"""How files write the units of an acceleration; blanks in a row count as one."""


BINARY = "a binary file or one in UTF-16"
"""What a file is called that is no text and none of the kinds that have a sign of their own."""


class Trace(NamedTuple):
    """One component of a record.

    Args:
        accel: accelerations [m/s2], shape (n,).
        dt: time step [s].
        header: what the file says of it, under the names of fields that ESM has, such as STATION_CODE and STREAM.
    """

    accel: Array
    dt: float
    header: Mapping[str, str]


Parse = Callable[[list[str]], list[Trace]]


def checked_record(accel: ArrayLike, dt: float) -> tuple[Array, float]:
    """Accelerations as an array that cannot be written to, and their time step [s].

    A TypeError or ValueError says unless they are one row of at least 2 finite numbers, and the step is 1e-5 to 1 s.
    """
    values = np.array(require_reals("accel", accel, "one row of at least 2 accelerations [m/s2]"))
    if values.ndim != 1 or len(values) < 2:
        raise ValueError(f"accel has the shape {values.shape}; one row of at least 2 accelerations [m/s2] is needed")
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise ValueError(f"accel[{bad[0]}] = {values[bad[0]]} m/s2 is not finite")
    values.setflags(write=False)
    return values, require_within("time step dt", dt, FINEST, COARSEST, "s")


def read(path: str | PathLike[str], traces: Callable[[Path], list[Trace]]) -> list[Trace]:
    """The traces that a reader finds in a file; a ValueError with its name says if it is not one of the format."""
    path = require_path("path", path)
    try:
        with np.errstate(over="ignore"):  # a number that is too large in m/s2 is named
            return [Trace(*checked_record(trace.accel, trace.dt), trace.header) for trace in traces(require_file(path))]
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def text_lines(path: Path) -> list[str]:
    """The lines of a text file in UTF-8 or Latin-1.

    CR, LF and CR LF end a line, and so does CR CR LF, which a transfer in text mode leaves. A last ^Z of DOS is
    dropped.
    """
    data = path.read_bytes()
    if kind := binary_kind(data):
        raise ValueError(f"{kind}; a text of accelerations in UTF-8 or Latin-1 is needed")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    text = text.removesuffix("\x1a")
    if not text.strip():
        raise ValueError("an empty file; a text of accelerations is needed")
    return re.split(r"\r\r?\n|\r|\n", text)


def binary_kind(data: bytes) -> str | None:
    """What the bytes of a file are in words, if they are no text."""
    if b"\0" not in data:
        return None
    by_obspy = "which GroundMotion.from_file reads by ObsPy"
    if len(data) >= 632 and data[304:308] in (b"\6\0\0\0", b"\0\0\0\6", b"\7\0\0\0", b"\0\0\0\7"):
        return f"a binary SAC file, {by_obspy}"
    if re.match(rb"\d{6}[DRQM] ", data) or data.startswith(b"MS\3"):
        return f"a miniSEED file, {by_obspy}"
    return BINARY


def factor_of(unit: str | float) -> float:
    """How many m/s2 a unit is: one of UNITS, or that number itself, as of the counts of an instrument."""
    if isinstance(unit, int | float) and not isinstance(unit, bool):
        return require_within("unit", unit, 1e-15, 1e3, "m/s2")
    return ACCELERATION_UNITS[require_one_of("unit", unit, ACCELERATION_UNITS)]


def stated_units(text: str) -> list[str]:
    """The units of acceleration that a text names, those of UNITS."""
    plain = " ".join(text.split())
    return [unit for unit, written in STATED_UNITS.items() if written.search(plain)]


def samples(lines: Sequence[str], header: int, count: int, stated: int | None = None) -> Array:
    """All numbers after so many lines; a ValueError if they are not as many as a line states, the last by default."""
    values = [x for place, line in enumerate(lines[header:], header + 1) for x in numbers(line, place)]
    if len(values) != count:
        raise ValueError(f"{len(values)} samples; the header states {count} in line {stated or header}")
    return np.array(values)


def step(text: str, place: int) -> float:
    """A time step [s] that a line states."""
    return require_within(f"line {place}: time step dt", value_of(text), FINEST, COARSEST, "s")


def numbers(line: str, place: int) -> list[float]:
    """The numbers of a line, those of glued columns too."""
    return [number(part, place) for word in words(line) for part in split_columns(word)]


def words(line: str) -> list[str]:
    """What blanks and tabs set apart."""
    return [word for word in re.split("[ \t]+", line) if word]


def split_columns(word: str) -> list[str]:
    """The numbers of a word of glued columns; any other word as it is."""
    return [part[0] for part in DECIMAL_NUMBER.finditer(word)] if GLUED.fullmatch(word) else [word]


def number(word: str, place: int) -> float:
    """A finite number; a ValueError with the line and the word for anything else."""
    if not DECIMAL_NUMBER.fullmatch(word) or not math.isfinite(value := value_of(word)):
        raise ValueError(f"line {place}: {in_message(word)} is not a finite number such as -0.015, 1.5E-02 or 1.5D-02")
    return value


def value_of(text: str) -> float:
    """The value of a text that NUMBER matches."""
    return float(text.lower().replace("d", "e"))


def in_message(text: str) -> str:
    """A text as it stands in a message: what cannot be seen or is not ASCII is escaped."""
    return ascii(text if len(text) <= 60 else f"{text[:57]}...")
