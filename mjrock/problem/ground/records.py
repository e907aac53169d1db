"""Text of recorded accelerations: ESM and ITACA, PEER AT2, columns of time and acceleration, plain text of a SAC set.

Each parser takes the lines of a file and returns its accelerations [m/s2], shape (n,), and its time step [s]. A number
has ASCII digits and may have a Fortran exponent, 1.5D-02. A ValueError with the line says where the header is another,
where the samples are not as many as it states, and where a word on a line of numbers is not a finite number.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ...files import require_file
from ...quantities import GRAVITY, Array, require_path, require_reals, require_within, spelt

ReadRecord = tuple[Array, float]

FINEST, COARSEST = 1e-5, 1.0
"""Bounds of the time step of a motion [s]."""
UNITS = {"m/s2": 1.0, "cm/s2": 1e-2, "mm/s2": 1e-3, "g": GRAVITY, "ft/s2": 0.3048}
TIME_UNITS = {"s": 1.0, "ms": 1e-3}
UNEVEN = 0.01
"""How far a printed time may lie from the even grid, as a share of the time step."""

AS_ASCII = re.ASCII | re.IGNORECASE
EXPONENT = r"(?:[ed][-+]?\d+)?"
COUNT, STEP = r"(\d{1,9})", rf"((?:\d+(?:\.\d*)?|\.\d+){EXPONENT})"
"""No run of digits or blanks can be parted in two ways, so that the time of a search goes with the length of a line."""
NUMBER = re.compile(rf"[-+]?{STEP}", AS_ASCII)
POINTED = rf"[-+]?(?:\d+\.\d*|\.\d+){EXPONENT}"
GLUED = re.compile(rf"{POINTED}(?:(?=[-+]){POINTED})+", AS_ASCII)
"""Columns of fixed width that a sign sets apart. Each has its decimal point: 1.5-102 is an exponent in Fortran."""
AT2_UNIT = re.compile(
    r"\s*acceleration\s+(time\s+(series|history)\s+)?in\s+units\s+of\s+g(\s*[.,;])?\s*(filter\s+points\b.*)?", AS_ASCII
)
AT2_HEAD = re.compile(rf"\s*npts\s*=\s*{COUNT}[\s,]*dt\s*=\s*{STEP}(\s*(s|sec|seconds))?[\s.,]*", AS_ASCII)
AT2_OLD_HEAD = re.compile(rf"\s*{COUNT}[\s,]+{STEP}[\s,]+npts[\s,]+dt[\s,]*", AS_ASCII)
ESM_FIELD = re.compile(r"([A-Z0-9_/^]+):[ \t]*(.*)", AS_ASCII)
ESM_LINES = 64
"""Lines of the header of an ESM or ITACA file, one field in each."""
ESM_UNITS = {"cm/s^2": 1e-2, "m/s^2": 1.0, "g": GRAVITY}
SAC_HEAD = re.compile(rf"[ \t]*{COUNT}[ \t]+{STEP}(?:[ \t]+(.*))?", AS_ASCII)
BREAK = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\x85\u2028\u2029]")
"""A control character, which could hide a row at the end of a header or comment."""
DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+", AS_ASCII)
COMMENT = re.compile(r"[ \t]*(#|%|//|$)")
DATA = re.compile(r"\W*(\d|(nan|inf|infinity)\b)", re.IGNORECASE)
"""A line of columns whose first letter or digit is a digit of any script, so that a damaged number is not a header."""


def checked(accel: ArrayLike, dt: float) -> ReadRecord:
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


def read(path: str | PathLike[str], parse: Callable[[list[str]], ReadRecord]) -> ReadRecord:
    """The record that a parser finds in a file; a ValueError with its name says if it is not one of the format."""
    path = require_path("path", path)
    try:
        return checked(*parse(text_lines(path)))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def text_lines(path: Path) -> list[str]:
    """The lines of a text file in UTF-8 or Latin-1. Only CR, LF and CR LF end a line. A last ^Z of DOS is dropped."""
    data = require_file(path).read_bytes()
    if b"\0" in data:
        raise ValueError("a binary file or one in UTF-16; a text of accelerations in UTF-8 or Latin-1 is needed")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    text = text.removesuffix("\x1a")
    if not text.strip():
        raise ValueError("an empty file; a text of accelerations is needed")
    return re.split(r"\r\n|\r|\n", text)


def esm_header(lines: Sequence[str]) -> dict[str, str]:
    """The fields of the header of an ESM or ITACA file, by name: EVENT_ID, STATION_CODE, STREAM, UNITS and so on."""
    fields = [ESM_FIELD.fullmatch(line.rstrip()) for line in lines[:ESM_LINES]]
    for place, field in enumerate(fields, 1):
        if field is None:
            raise ValueError(
                f"line {place} is {_short(lines[place - 1])}: not an ESM or ITACA file, whose first {ESM_LINES} lines "
                "are fields such as STATION_CODE: AMT"
            )
    return {field[1].upper(): field[2] for field in fields if field is not None}


def parse_esm(lines: Sequence[str], head: Mapping[str, str]) -> ReadRecord:
    """The record of an ESM or ITACA file with this header: its unit, step and number of samples, and a value a line."""
    for name in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS"):
        if not head.get(name):
            raise ValueError(f"the header has no {name}; an ESM or ITACA file of accelerations states it")
    if (kind := head.get("DATA_TYPE", "ACCELERATION").upper()) != "ACCELERATION":
        raise ValueError(f"DATA_TYPE is {_short(kind)}; the record has to be one of ACCELERATION")
    if (unit := head["UNITS"].lower()) not in ESM_UNITS:
        raise ValueError(f"UNITS is {_short(head['UNITS'])}; the valid ones are {', '.join(ESM_UNITS)}")
    if not re.fullmatch(COUNT, head["NDATA"]):
        raise ValueError(f"NDATA is {_short(head['NDATA'])}; it has to be the number of samples")
    place = list(head).index("SAMPLING_INTERVAL_S") + 1
    dt = require_within(
        f"line {place}: time step dt", _number(head["SAMPLING_INTERVAL_S"], place), FINEST, COARSEST, "s"
    )
    values = _samples(lines, ESM_LINES, int(head["NDATA"]), list(head).index("NDATA") + 1)
    return ESM_UNITS[unit] * values, dt


def esm_text(accel: Array, dt: float, header: Mapping[str, str]) -> str:
    """An ESM file of accelerations [m/s2] every dt seconds, which states its own unit, step, and number of samples.

    A ValueError says where the header has a field that such a file cannot have.
    """
    stated = {
        "SAMPLING_INTERVAL_S": repr(dt),
        "NDATA": str(len(accel)),
        "DURATION_S": f"{dt * (len(accel) - 1):.6f}",
        "UNITS": "cm/s^2",
        "PGA_CM/S^2": f"{accel[np.abs(accel).argmax()] / ESM_UNITS['cm/s^2']:.6f}",
        "DATA_TYPE": "ACCELERATION",
    }
    fields = {**header, **stated}
    spare = [name for name in (f"USER{i}" for i in range(1, ESM_LINES + 1)) if name not in fields]
    fields |= dict.fromkeys(spare[: max(ESM_LINES - len(fields), 0)], "")
    lines = [f"{name}: {value}" for name, value in fields.items()]
    fit = all(ESM_FIELD.fullmatch(line) and not BREAK.search(line) for line in lines)
    if len(lines) != ESM_LINES or not fit or any(name != name.upper() for name in fields):
        raise ValueError(
            f"header = {_short(str(dict(header)))}: at most 58 fields of one line, named as in an ESM file"
        )
    return "\n".join([*lines, *(repr(value) for value in (accel / ESM_UNITS["cm/s^2"]).tolist())]) + "\n"


def parse_at2(lines: Sequence[str]) -> ReadRecord:
    """The record of a PEER NGA file: four header lines, the last with NPTS and DT, then values in g."""
    if len(lines) < 4 or not AT2_UNIT.fullmatch(lines[2]):
        instead = f"line 3 is {_short(lines[2])}" if len(lines) > 2 else f"{len(lines)} lines"
        raise ValueError(f"{instead}: not an AT2 file, whose line 3 is ACCELERATION TIME SERIES IN UNITS OF G")
    head = AT2_HEAD.fullmatch(lines[3]) or AT2_OLD_HEAD.fullmatch(lines[3])
    if head is None:
        raise ValueError(f"line 4 states no NPTS and DT as in NPTS= 4000, DT= .0100 SEC alone: {_short(lines[3])}")
    return GRAVITY * _samples(lines, 4, int(head[1])), _step(head[2], 4)


def parse_sac(lines: Sequence[str]) -> ReadRecord:
    """The record of a text with a title line, a line that begins with count and time step [s], then values in cm/s2."""
    head = SAC_HEAD.fullmatch(lines[1]) if len(lines) > 1 else None
    if head is None:
        instead = f"line 2 is {_short(lines[1])}" if len(lines) > 1 else "1 line"
        raise ValueError(
            f"{instead}: not the plain text of a SAC record, whose line 2 begins with the number of samples and dt"
        )
    _numbers(head[3] or "", 2)  # what the other columns say is not used
    return UNITS["cm/s2"] * _samples(lines, 2, int(head[1])), _step(head[2], 2)


def parse_columns(lines: Sequence[str], unit: str, time_unit: str, dt: float | None = None) -> ReadRecord:
    """The record of two columns, time and acceleration, set apart by commas, semicolons, or blanks and tabs.

    With a time step dt [s] it is one column, the accelerations.

    Lines ahead of the first number are a header; blank lines and those that begin with #, % or // are skipped. Between
    semicolons a comma is a decimal point. A ValueError says where a unit is unknown, a control character stands, or
    times are uneven.
    """
    scale, time_scale = _factor("unit", unit, UNITS), _factor("time_unit", time_unit, TIME_UNITS)
    what = "time and acceleration" if dt is None else "the acceleration"
    wanted, said = (2, "two are") if dt is None else (1, "one is")
    rows: list[list[float]] = []
    places: list[int] = []
    for place, line in enumerate(lines, 1):
        if COMMENT.match(line) or not (rows or DATA.match(line)):
            if hidden := BREAK.search(line):
                raise ValueError(f"line {place} has a {hidden[0]!a}; only CR, LF and CR LF end a line")
            continue
        row = _columns(line)
        if len(row) != wanted:
            remedy = "; one column needs its time step: give dt" if dt is None and len(row) == 1 else ""
            if all(DECIMAL_COMMA.fullmatch(word) for word in _words(line)):
                remedy = "; write decimal points, since a comma is one between semicolons alone"
            raise ValueError(f"line {place} has {len(row)} columns, {_short(line)}; {said} needed, {what}{remedy}")
        rows.append([_number(word, place) for word in row])
        places.append(place)
    if len(rows) < 2:
        raise ValueError(
            f"{len(rows)} rows of {what} in {len(lines)} lines, the first of them {_short(lines[0])}; "
            "at least 2 rows are needed"
        )
    if dt is not None:
        return scale * np.array(rows)[:, 0], time_scale * require_within(
            "dt", dt, FINEST / time_scale, COARSEST / time_scale, time_unit
        )
    time, accel = np.array(rows).T
    return scale * accel, _even_step(time_scale * time, places)


def _columns(line: str) -> list[str]:
    if ";" in line:
        line = line.replace(",", ".").replace(";", ",")
    return [word.strip(" \t") for word in (line.split(",") if "," in line else _words(line))]


def _even_step(time: Array, places: Sequence[int]) -> float:
    steps = np.diff(time)
    back = np.flatnonzero(steps <= 0)
    if back.size:
        i = back[0]
        raise ValueError(f"line {places[i + 1]}: time does not increase, {time[i]:g} s to {time[i + 1]:g} s")
    dt = float(time[-1] - time[0]) / len(steps)
    if np.abs(time - time[0] - dt * np.arange(len(time))).max() > UNEVEN * dt:
        usual = float(np.median(steps))
        i = int(np.abs(steps - usual).argmax())
        raise ValueError(
            f"line {places[i + 1]}: uneven time steps, {steps[i]:g} s from {time[i]:g} s on where {usual:g} s is usual"
        )
    return dt


def _factor(name: str, unit: str, units: dict[str, float]) -> float:
    if not isinstance(unit, str) or unit not in units:
        raise ValueError(f"{name} = {spelt(unit)} is not one of {', '.join(units)}")
    return units[unit]


def _samples(lines: Sequence[str], header: int, count: int, stated: int | None = None) -> Array:
    values = [x for place, line in enumerate(lines[header:], header + 1) for x in _numbers(line, place)]
    if len(values) != count:
        raise ValueError(f"{len(values)} samples; the header states {count} in line {stated or header}")
    return np.array(values)


def _step(text: str, place: int) -> float:
    return require_within(f"line {place}: time step dt", _value(text), FINEST, COARSEST, "s")


def _numbers(line: str, place: int) -> list[float]:
    """The numbers of a line, those of glued columns too."""
    values: list[float] = []
    for word in _words(line):
        parts = [part[0] for part in NUMBER.finditer(word)] if GLUED.fullmatch(word) else [word]
        values += [_number(part, place) for part in parts]
    return values


def _words(line: str) -> list[str]:
    return [word for word in re.split("[ \t]+", line) if word]


def _number(word: str, place: int) -> float:
    if not NUMBER.fullmatch(word) or not math.isfinite(value := _value(word)):
        raise ValueError(f"line {place}: {_short(word)} is not a finite number such as -0.015, 1.5E-02 or 1.5D-02")
    return value


def _value(text: str) -> float:
    return float(text.lower().replace("d", "e"))


def _short(text: str) -> str:
    """A text as it stands in a message: what cannot be seen or is not ASCII is escaped."""
    return ascii(text if len(text) <= 60 else f"{text[:57]}...")
