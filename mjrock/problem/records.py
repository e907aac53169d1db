"""Text of recorded accelerations: PEER AT2, columns of time and acceleration, the plain text of a SAC set.

Each parser takes the lines of a file and returns its accelerations [m/s2], shape (n,), and its time step [s].
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from .quantities import GRAVITY, Array, require_within

Record = tuple[Array, float]

UNITS = {"m/s2": 1.0, "cm/s2": 1e-2, "mm/s2": 1e-3, "g": GRAVITY, "ft/s2": 0.3048}
TIME_UNITS = {"s": 1.0, "ms": 1e-3}
UNEVEN = 0.01
"""How far a printed time may lie from the even grid, as a share of the time step."""

COUNT, STEP = r"(\d+)", r"([\d.]+(?:e[-+]?\d+)?)"
UNITS_OF_G = re.compile(r"\bunits\s+of\s+g\b", re.IGNORECASE)
AT2_HEAD = re.compile(rf"npts\s*=\s*{COUNT}[\s,]*dt\s*=\s*{STEP}", re.IGNORECASE)
AT2_OLD_HEAD = re.compile(rf"\s*{COUNT}[\s,]+{STEP}[\s,]+npts", re.IGNORECASE)
COMMENT = re.compile(r"\s*(#|%|//|$)")
NUMBER = re.compile(r"\s*[-+]?(\.?\d|nan\b|inf\b)", re.IGNORECASE)


def checked(accel: ArrayLike, dt: float) -> Record:
    """Accelerations as an array that cannot be written to, and their time step [s].

    Raises:
        ValueError: unless they are one row of at least 2 finite numbers, and the step is 1e-5 to 1 s.
    """
    values = np.array(accel, dtype=float)
    if values.ndim != 1 or len(values) < 2:
        raise ValueError(f"accel has the shape {values.shape}; one row of at least 2 accelerations [m/s2] is needed")
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise ValueError(f"accel[{bad[0]}] = {values[bad[0]]} m/s2 is not finite")
    values.setflags(write=False)
    return values, require_within("time step dt", dt, 1e-5, 1.0, "s")


def read(path: str | PathLike[str], parse: Callable[[list[str]], Record]) -> Record:
    """The record that a parser finds in a file.

    Raises:
        OSError: if the file cannot be read.
        ValueError: with the name of the file, if it is not one of the format.
    """
    try:
        return checked(*parse(text_lines(path)))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def text_lines(path: str | PathLike[str]) -> list[str]:
    """The lines of a text file.

    Raises:
        FileNotFoundError: if there is none.
        ValueError: if it is binary or empty.
    """
    data = Path(path).read_bytes()
    if b"\0" in data:
        raise ValueError("a binary file, not a text of accelerations")
    if not data.strip():
        raise ValueError("an empty file")
    try:
        return data.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        return data.decode("latin-1").splitlines()


def parse_at2(lines: Sequence[str]) -> Record:
    """The record of a PEER NGA file: four header lines, the last with NPTS and DT, then values in g.

    Raises:
        ValueError: for another header, another number of samples than it states, or something that is no number.
    """
    if len(lines) < 4 or not UNITS_OF_G.search(lines[2]):
        raise ValueError("not an AT2 file; the third of its four header lines would say UNITS OF G")
    head = AT2_HEAD.search(lines[3]) or AT2_OLD_HEAD.match(lines[3])
    if head is None:
        raise ValueError(f"line 4 states no NPTS and DT: {lines[3].strip()!r}")
    return GRAVITY * _samples(lines, 4, int(head[1])), float(head[2])


def parse_sac(lines: Sequence[str]) -> Record:
    """The record of a text with a title line, a line that begins with count and time step [s], then values in cm/s2.

    Raises:
        ValueError: for another header, another number of samples than it states, or something that is no number.
    """
    head = re.match(rf"\s*{COUNT}\s+{STEP}(\s|$)", lines[1] if len(lines) > 1 else "", re.IGNORECASE)
    if head is None:
        raise ValueError("not the plain text of a SAC record; line 2 would begin with the number of samples and dt")
    return UNITS["cm/s2"] * _samples(lines, 2, int(head[1])), float(head[2])


def parse_columns(lines: Sequence[str], unit: str, time_unit: str) -> Record:
    """The record of two columns, time and acceleration, set apart by commas, semicolons or white space.

    Lines ahead of the first number are a header; blank lines and those that begin with #, % or // are skipped. Between
    semicolons a comma is a decimal point.

    Raises:
        ValueError: for an unknown unit, another number of columns, something that is no number, or uneven times.
    """
    scale, time_scale = _factor("unit", unit, UNITS), _factor("time_unit", time_unit, TIME_UNITS)
    rows: list[list[float]] = []
    places: list[int] = []
    for place, line in enumerate(lines, 1):
        if COMMENT.match(line) or not (rows or NUMBER.match(line)):
            continue
        row = _numbers(_columns(line), place)
        if len(row) != 2:
            raise ValueError(f"line {place} has {len(row)} columns; two are needed, time and acceleration")
        rows.append(row)
        places.append(place)
    if len(rows) < 2:
        raise ValueError(f"{len(rows)} rows of time and acceleration; at least 2 are needed")
    time, accel = np.array(rows).T
    return scale * accel, _even_step(time_scale * time, places)


def _columns(line: str) -> list[str]:
    if ";" in line:
        return line.replace(",", ".").split(";")
    return line.split("," if "," in line else None)


def _even_step(time: Array, places: Sequence[int]) -> float:
    lost = np.flatnonzero(~np.isfinite(time))
    if lost.size:
        raise ValueError(f"line {places[lost[0]]}: time {time[lost[0]]} s is not finite")
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
    if unit not in units:
        raise ValueError(f"{name} = {unit!r} is not one of {', '.join(units)}")
    return units[unit]


def _samples(lines: Sequence[str], header: int, count: int) -> Array:
    values = [x for place, line in enumerate(lines[header:], header + 1) for x in _numbers(line.split(), place)]
    if len(values) != count:
        raise ValueError(f"{len(values)} samples; the header states {count}")
    return np.array(values)


def _numbers(words: Iterable[str], place: int) -> list[float]:
    try:
        return [float(word) for word in words]
    except ValueError as error:
        raise ValueError(f"line {place}: {error}") from None
