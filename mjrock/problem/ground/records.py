"""Text of recorded accelerations: lines, numbers, units and steps, and tables of times and accelerations.

A parser takes the lines of a file and returns its traces. A number has ASCII digits and may have a Fortran exponent,
1.5D-02. A parser raises a ValueError with the line where the samples are not as many as the file states, and where a
word on a line of numbers is not a finite number.

A table, in text or a spreadsheet, has columns of times and accelerations, or samples in rows. The arguments are
compared with the file: counts, steps and units in its header, a column of times beside a time step, numbers that stand
alone before the samples. Where they differ, a ValueError is raised with the line and both readings.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
import scipy.io
from numpy.typing import ArrayLike

from ...contacts.files import require_file
from ...quantities import (
    GRAVITY,
    Array,
    Within,
    require_one_of,
    require_path,
    require_reals,
    require_whole,
    require_within,
    within_ranges,
)

FINEST, COARSEST = 1e-5, 1.0
"""Bounds of the time step of a motion [s]."""
SampleStep = Annotated[float, Within(FINEST, COARSEST, "s", "time step dt")]
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
LENGTH = r"(?:mm|cm|m|in|ft|inch(?:es)?)"
UNIT_NAMED = r"(?:[(\[] ?|(?<![a-z])(?:in |units?(?: of| ?[:=]| in)*) ?)"
QUANTITIES = {
    "accelerations": re.compile(
        r"(?<![a-z])(?:acc(?:el)?s?|acc?[e\xe9]l[e\xe9]ra\w*|accelerogram\w*|beschleunigung\w*)(?![a-z])", re.IGNORECASE
    ),
    "velocities": re.compile(
        r"(?<![a-z])(?:vel(?:oc(?:it(?:y|ies|\xe0))?|ocidad(?:es)?)?|vitesses?|geschwindigkeit\w*)(?![a-z])|"
        rf"{UNIT_NAMED}(?:kine|{LENGTH} ?(?:/ ?s(?:ec)?|s\^?-1))(?![a-z0-9/.^*\xb2]| ?[/^*-]| ?[2\xb2])",
        re.IGNORECASE,
    ),
    "displacements": re.compile(
        r"(?<![a-z])(?:disp(?:l(?:acements?)?)?|desplazamientos?|spostament[io]|d\xe9placements?|verschiebung\w*)"
        rf"(?![a-z])|{UNIT_NAMED}{LENGTH}(?: ?[)\]]|$)",
        re.IGNORECASE,
    ),
    "spectra": re.compile(r"^\W*(?:response|fourier)(?:[ &]|and|fourier|amplitude)* spectra\b", re.IGNORECASE),
}
"""How headers name what their samples are: by the quantity, or by its unit."""
NO_QUANTITY = re.compile(
    r"\b(?:peak|max\w*|largest|residual|final|initial|shear|wave|pg[avd]|vs ?,?30)\b|\bvs30|height|depth|dist|elev",
    re.IGNORECASE,
)
"""What stands in lines of a header with a velocity or length that is none of the samples."""


BINARY = "a binary file or one in UTF-16"
"""What a file is called that is no text and none of the kinds that have a sign of their own."""


class Trace(NamedTuple):
    """One component of a record.

    Args:
        accel: accelerations [m/s2], shape (n,).
        dt: time step [s].
        header: its fields in the file, by the names that ESM gives them, such as STATION_CODE and STREAM.
    """

    accel: Array
    dt: float
    header: Mapping[str, str]


Parse = Callable[[list[str]], list[Trace]]


@within_ranges
def checked_record(accel: ArrayLike, dt: SampleStep) -> tuple[Array, float]:
    """Accelerations as an array that cannot be written to, and their time step [s].

    Raises:
        TypeError, ValueError: unless they are a row of at least 2 finite numbers, and the step 1e-5 to 1 s.
    """
    values = np.array(require_reals("accel", accel, "one row of at least 2 accelerations [m/s2]"))
    if values.ndim != 1 or len(values) < 2:
        raise ValueError(f"accel has the shape {values.shape}; one row of at least 2 accelerations [m/s2] is needed")
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise ValueError(f"accel[{bad[0]}] = {values[bad[0]]} m/s2 is not finite")
    values.setflags(write=False)
    return values, dt


def read(path: str | PathLike[str], traces: Callable[[Path], list[Trace]]) -> list[Trace]:
    """The traces that a reader finds in a file.

    Raises:
        ValueError: for a file of another format, with its name.
    """
    path = require_path("path", path)
    try:
        with np.errstate(over="ignore"):  # a number that is too large in m/s2 is named
            return [Trace(*checked_record(trace.accel, trace.dt), trace.header) for trace in traces(require_file(path))]
    except ValueError as error:
        raise (NoRecordError if isinstance(error, NoRecordError) else ValueError)(f"{path}: {error}") from error


def text_lines(path: Path) -> list[str]:
    """The lines of a text file in UTF-8 or Latin-1.

    CR, LF and CR LF end a line, and so does CR CR LF, which a transfer in text mode leaves. The ^Z of DOS that fill
    the end are dropped.
    """
    data = path.read_bytes()
    if binary := binary_kind(data):
        raise NoRecordError(f"{binary}; a text of accelerations in UTF-8 or Latin-1 is needed")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\x1a" in text[len(trimmed := text.rstrip(" \t\r\n\x1a")) :]:
        text = trimmed
    if not text.strip():
        raise NoRecordError("an empty file; a text of accelerations is needed")
    return re.split(r"\r\r?\n|\r|\n", text)


class NoRecordError(ValueError):
    """A file that holds no record of accelerations, or does not state what its reader has to know of it."""


class OtherContentError(NoRecordError):
    """A file that says that it holds something else: velocities, displacements, spectra, JSON."""


def quantities(text: str) -> list[str]:
    """The quantities that a text names: accelerations, velocities, displacements or spectra."""
    plain = " ".join(text.split())
    names = [name for name, written in QUANTITIES.items() if written.search(plain)]
    return ["accelerations", *names] if stated_units(plain) and "accelerations" not in names else names


def require_accelerations(head: Mapping[int, str], name: str = "") -> None:
    """Raise an `OtherContentError` where a header, or the name of a column, names velocities, displacements or spectra.

    The name of the column counts first. Of the lines of the header the last one that names a single quantity counts.

    Args:
        head: lines of the header, by their number.
        name: that of the column.
    """
    lines = {place: line[:HEADER_LINE] for place, line in head.items() if not NO_QUANTITY.search(line[:HEADER_LINE])}
    named_so = [(quantities(name), f"the name of the column is {in_message(name)}")]
    named_so += [(quantities(line), f"line {i} is {in_message(line.strip())}") for i, line in reversed(lines.items())]
    single = ((names[0], where) for names, where in named_so if len(names) == 1)
    quantity, where = next(single, ("accelerations", ""))
    if quantity != "accelerations":
        raise OtherContentError(
            f"{where}: these are {quantity}, whatever unit is given; a record of accelerations is needed"
        )


def require_visible(line: str, place: int) -> None:
    """Raise a ValueError for a control character, which could hide a row at the end of a header or comment."""
    if hidden := BREAK.search(line):
        raise ValueError(f"line {place} has a {hidden[0]!a}; only CR, LF and CR LF end a line")


def binary_kind(data: bytes) -> str | None:
    """What the bytes of a file are in words, if they are no text."""
    if b"\0" not in data:
        return None
    by_obspy = "which GroundMotion.from_file reads by ObsPy"
    if len(data) >= 632 and data[304:308] in (b"\6\0\0\0", b"\0\0\0\6", b"\7\0\0\0", b"\0\0\0\7"):
        return f"a binary SAC file, {by_obspy}"
    if data.startswith(b"MATLAB"):
        return "a MATLAB file, which GroundMotion.from_csv reads by its name .mat"
    if re.match(rb"\d{6}[DRQM] ", data) or data.startswith(b"MS\3"):
        return f"a miniSEED file, {by_obspy}"
    return BINARY


def factor_of(unit: str | float) -> float:
    """How many m/s2 a unit is: one of ACCELERATION_UNITS, or that number itself, as of the counts of an instrument."""
    if isinstance(unit, int | float) and not isinstance(unit, bool):
        return require_within("unit", unit, 1e-15, 1e3, "m/s2")
    return ACCELERATION_UNITS[require_one_of("unit", unit, ACCELERATION_UNITS)]


def stated_units(text: str) -> list[str]:
    """The units of acceleration that a text names, those of ACCELERATION_UNITS."""
    plain = " ".join(text.split())
    return [unit for unit, written in STATED_UNITS.items() if written.search(plain)]


def samples(lines: Sequence[str], header: int, count: int, stated: int | None = None) -> Array:
    """All numbers after the header.

    Raises:
        ValueError: if they are not as many as a line states, the last by default.
    """
    values = all_numbers(lines, header)
    if len(values) != count:
        raise ValueError(f"{len(values)} samples; the header states {count} in line {stated or header}")
    return np.array(values)


def step(text: str, place: int) -> float:
    """A time step [s] that a line states."""
    return require_within(f"line {place}: time step dt", number(text, place), FINEST, COARSEST, "s")


def all_numbers(lines: Sequence[str], first: int, end: int | None = None) -> list[float]:
    """The numbers of lines, after the first ones up to an end."""
    return [x for place, line in enumerate(lines[first:end], first + 1) for x in numbers(line, place)]


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
    """A finite number.

    Raises:
        ValueError: with the line and the word for anything else.
    """
    if not DECIMAL_NUMBER.fullmatch(word) or not math.isfinite(value := value_of(word)):
        raise ValueError(f"line {place}: {in_message(word)} is not a finite number such as -0.015, 1.5E-02 or 1.5D-02")
    return value


def value_of(text: str) -> float:
    """The value of a text that DECIMAL_NUMBER matches."""
    return float(text.lower().replace("d", "e"))


def in_message(text: str) -> str:
    """A text as it stands in a message: what cannot be seen or is not ASCII is escaped."""
    return ascii(text if len(text) <= 60 else f"{text[:57]}...")


UNEVEN_TIME = 0.01
"""How far a printed time may lie from the even grid, as a share of the time step."""
UNEVEN_ROUNDED = 0.1
"""The same for times that are rounded to so few decimals that they cannot lie closer."""
SLOW_SAMPLING = 0.1
"""Time steps from here on [s] are doubted: no accelerograph is so slow, and the column may be of row numbers."""
HEADER_RATIO, NUMBERS_COMPARED = 5.0, 10
"""A first number that is the largest, and this many times as large as the numbers after it, is doubted: it may be one
of the header. How many numbers after it are compared."""
ROWS = "rows"
"""What `columns` is where the samples stand in rows, one after the other."""
SMOOTH_ROWS = 0.7
"""Samples stand in rows where they jump less along the rows than this share of what they jump down the columns."""
HEADER_LINE = 1000
"""Characters of a line of the header that are looked at."""
MOST_HEADER_NUMBERS = 4
"""Most numbers of a header that may stand before the samples."""
SPREADSHEETS = (".xlsx", ".xlsm", ".xls", ".ods")
MATLAB = ".mat"

DECIMAL_COMMA = re.compile(rf"[-+]?(?:\d+,\d*|,\d+){EXPONENT}", AS_ASCII)
COMMENT = re.compile(r"[ \t]*(#|%|//|$)")
DATA = re.compile(r"\W*(\d|(nan|inf|infinity)\b)", re.IGNORECASE)
"""A line of columns whose first letter or digit is a digit of any script, so that a damaged number is not a header."""
PROSE = re.compile(r"(?!\b(?:nan|inf|infinity)\b)[a-z]{3}", re.IGNORECASE)
HEAD_STEP = re.compile(
    r"(?:(?<![a-z])dt|time[ _]step|(?:sampling|time|sample)[ _](?:interval|period|step))"
    rf"[ _]*(?:[(\[]s(?:ec)?[)\]])?[ :=]*{DECIMAL} *(ms|msec)?(?![\w.])",
    AS_ASCII,
)
HEAD_RATE = re.compile(
    r"(?:sampl\w*[ _]*(?:rate|freq\w*)|(?<![a-z])fs)[ _]*(?:[(\[](?:hz|sps)[)\]])?[ :=]*"
    rf"{DECIMAL} *(?:hz|sps|samples)?",
    AS_ASCII,
)
HEAD_SCALE = re.compile(rf"(?:scal\w*|multipl\w*)(?:[ _]factor)?[ :=]*{DECIMAL}(?![\w.])", AS_ASCII)
HEAD_COUNT = re.compile(
    rf"(?:npts|ndata|(?:n[ou]\.?|number) of (?:data|points|samples|pts))[ :=]*{COUNT}(?![\w.])", AS_ASCII
)


class TableOptions(NamedTuple):
    """The arguments that describe a table.

    Args:
        unit: of the accelerations, one of ACCELERATION_UNITS or how many m/s2 it is; None takes that of the header.
        time_unit: of the times and the step.
        dt: the time step in that unit; None takes that of the column of times or of the header.
        columns: those to read, by number from 0 or name: the times first, unless a step is given. "rows" for samples in
            rows. None where there is one choice only.
        skip: the first lines to leave out; None finds the header and compares it with the other arguments.
        sheet: of a spreadsheet, or a variable of a MATLAB file; None for the only one with rows of numbers.
    """

    unit: str | float | None = None
    time_unit: str = "s"
    dt: float | None = None
    columns: int | str | Sequence[int | str] | None = None
    skip: int | None = None
    sheet: str | None = None


class HeaderNumber(NamedTuple):
    """A number that a line of a header states."""

    value: float
    place: int


@dataclass(frozen=True)
class RecordTable:
    """The rows of numbers of a file, and its header.

    Args:
        head: the lines before the rows, by their number.
        names: of the columns, as the header has them; empty where it has none.
        values: the numbers of each row.
        places: number of the line of each row.
        decimals: most decimals of a number in the first column.
    """

    head: dict[int, str]
    names: list[str]
    values: list[list[float]]
    places: list[int]
    decimals: int

    @cached_property
    def width(self) -> int:
        """The number of columns that most rows have."""
        return Counter(map(len, self.values)).most_common(1)[0][0]

    def without(self, rows: int) -> RecordTable:
        """The table after its first rows, which are some of the header."""
        return replace(self, values=self.values[rows:], places=self.places[rows:])

    def stated(self, *patterns: re.Pattern[str]) -> HeaderNumber | None:
        """The number that the header states in one of these forms; a rate is turned into a step."""
        for place, line in self.head.items():
            for pattern in patterns:
                if match := pattern.search(line[:HEADER_LINE]):
                    value = value_of(match[1]) * (1e-3 if pattern is HEAD_STEP and match[2] else 1)
                    return HeaderNumber(1 / value if pattern is HEAD_RATE and value else value, place)
        return None

    def column(self, number_of: int) -> Array:
        """The numbers of a column, shape (rows,)."""
        return np.array([row[number_of] for row in self.values])

    def name(self, number_of: int) -> str:
        """The name of a column, empty where the header has none."""
        return self.names[number_of] if number_of < len(self.names) else ""

    def bare(self, number_of: int) -> str:
        """The name of a column without what stands there in brackets."""
        return re.split(r"[(\[]", self.name(number_of))[0].strip()

    def row_text(self, line: int = 0) -> str:
        """A row, by the number of its line and its words."""
        return f"line {self.places[line]} is {' '.join(f'{x:g}' for x in self.values[line])}"

    def choice(self, timed: bool) -> str:
        """The columns and how one chooses among them, in words."""
        named = f": {', '.join(f'{i} {in_message(name)}' for i, name in enumerate(self.names))}" if self.names else ""
        example = "(0, 1) for times and accelerations" if timed else "0 for one of accelerations"
        return f"{self.width} columns{named}; choose with columns=, such as columns={example}"


def table_lines(path: Path, sheet: str | None = None) -> list[str]:
    """The lines of a text, or of a sheet of a spreadsheet or of variables of MATLAB, their cells set apart by tabs.

    Raises:
        ImportError: for a spreadsheet where pandas, or its library for the format, is missing.
        ValueError: for a sheet that is not there, and where none is given, for numbers on several or on none.
    """
    if not is_book(path):
        if sheet is not None:
            raise ValueError(f"sheet = {in_message(sheet)} is of a spreadsheet or a MATLAB file, and this is a text")
        return text_lines(path)
    tables = _variables(path) if path.suffix.lower() == MATLAB else _sheets(path)
    if sheet is not None:
        return tables[require_one_of("sheet", sheet, tables)]
    full = [name for name, lines in tables.items() if sum(bool(DATA.match(line)) for line in lines) > 1]
    if len(full) != 1:
        choose = f"; choose with sheet=, such as sheet={in_message(full[0])}" if full else ""
        raise NoRecordError(f"{len(full)} sheets have rows of numbers, {in_message(', '.join(full))}{choose}")
    return tables[full[0]]


def is_book(path: Path) -> bool:
    """Whether a file is a spreadsheet or of MATLAB, and holds tables by name."""
    return path.suffix.lower() in (*SPREADSHEETS, MATLAB)


def _variables(path: Path) -> dict[str, list[str]]:
    """The tables of a MATLAB file by their names: a matrix, or all rows of numbers of one length, under the first name.

    Scalars and words are lines of the header of each, such as dt = 0.01. Fields of a structure have names such as a.b.
    """
    try:
        content = scipy.io.loadmat(path, simplify_cells=True)
    except NotImplementedError:
        raise NoRecordError("a MATLAB file of version 7.3; save it there with -v7") from None
    except Exception as error:
        raise ValueError(f"SciPy does not read it as a MATLAB file: {in_message(str(error))}") from None
    head: list[str] = []
    columns: dict[int, dict[str, Array]] = {}
    for name, value in _flat_variables(content):
        array = np.squeeze(np.asarray(value))
        if isinstance(value, str):
            head.append(f"{name}: {' '.join(value.split())}")
        elif array.dtype.kind in "iuf" and array.ndim == 0:
            head.append(f"{name} = {float(array):.17g}")
        elif array.dtype.kind in "iuf" and array.ndim < 3 and array.size:
            rows = array if array.ndim == 1 or array.shape[0] > array.shape[1] else array.T
            group = {name: rows} if rows.ndim == 1 else {f"{name} {i}": rows[:, i] for i in range(rows.shape[1])}
            columns.setdefault(len(rows), {}).update(group)
    tables = {}
    for group in columns.values():
        rows = np.column_stack([values.astype(float) for values in group.values()]).tolist()
        tables[next(iter(group)).split(" ")[0]] = [
            *head,
            "\t".join(group),
            *("\t".join(map(repr, row)) for row in rows),
        ]
    return tables


def _flat_variables(content: Mapping[str, object], before: str = "") -> Iterator[tuple[str, object]]:
    """The variables of a MATLAB file by their names, those within structures too."""
    for name, value in content.items():
        if isinstance(value, Mapping):
            yield from _flat_variables(value, f"{before}{name}.")
        elif not name.startswith("__"):
            yield f"{before}{name}", value


def _sheets(path: Path) -> dict[str, list[str]]:
    """The lines of each sheet of a spreadsheet by its name."""
    try:
        import pandas

        sheets = pandas.read_excel(path, sheet_name=None, header=None, dtype=object)
    except ImportError as error:
        raise ImportError(f"{error}; pandas reads spreadsheets: pip install pandas openpyxl") from error
    except Exception as error:
        raise ValueError(f"pandas does not read it as a spreadsheet: {in_message(str(error))}") from error
    tables = ((name, sheet.to_numpy()) for name, sheet in sheets.items())
    return {name: ["\t".join(map(_cell, row)).rstrip() for row in rows] for name, rows in tables}


def table_traces(path: str | PathLike[str], options: TableOptions) -> list[Trace]:
    """The accelerations of a file that is a table, see `parse_table`."""
    return read(path, lambda file: parse_table(table_lines(file, options.sheet), options))


def _cell(value: object) -> str:
    return "" if value != value else " ".join(str(value).split())


def parse_table(lines: list[str], options: TableOptions) -> list[Trace]:
    """The accelerations of a table, a trace for each of its columns that is wanted, in their order.

    Lines ahead of the first number are a header; blank lines and those that begin with #, % or // are skipped.

    Raises:
        TypeError, ValueError: for an unknown unit, uneven times, a column that is not there, a choice that the caller
            has to make, and where the file contradicts the arguments.
    """
    scale = TIME_UNITS[require_one_of("time_unit", options.time_unit, TIME_UNITS)]
    if options.unit is not None:
        factor_of(options.unit)
    if options.dt is not None:
        dt = scale * require_within("dt", options.dt, FINEST / scale, COARSEST / scale, options.time_unit)
        options = options._replace(dt=dt)
    if lines[0].lstrip()[:1] in ("{", "["):
        raise OtherContentError("it is JSON; a text of accelerations in columns or rows is needed")
    table = _table_of(lines, options.skip)
    if len(table.values) < 2:
        raise NoRecordError(
            f"{len(table.values)} rows of numbers in {len(lines)} lines, the first of them {in_message(lines[0])}; at "
            "least 2 rows are needed, of time and acceleration or with dt of accelerations alone"
        )
    try:
        return _traces_of(table, options, scale)
    except ValueError as error:
        if not isinstance(error, NoRecordError):
            require_accelerations(table.head)
        raise


def _traces_of(table: RecordTable, options: TableOptions, scale: float) -> list[Trace]:
    """The accelerations of a table, with the step of `options` in s, and the length of a unit of time [s]."""
    dt = options.dt
    stated, scaled = table.stated(HEAD_STEP, HEAD_RATE), table.stated(HEAD_SCALE)
    if scaled and scaled.value != 1:
        raise ValueError(
            f"line {scaled.place} states a scale of {scaled.value:g}: of the samples, or one that they have already? "
            f"skip= leaves it out, and scaled({scaled.value:g}) applies it"
        )
    if options.skip is None:
        table, stated = _without_header(table, dt, stated)
    rows_requested = isinstance(options.columns, str) and options.columns == ROWS
    timed = not rows_requested and table.width > 1 and _is_grid(scale * table.column(0), table.decimals, scale)
    if stated and not FINEST <= stated.value <= COARSEST:
        stated = None
    if stated:
        _require_agreement("dt, which was given,", dt, stated)
        dt = stated.value if dt is None and not timed else dt
    in_rows = rows_requested or (options.columns is None and dt is not None and not timed and _stands_in_rows(table))
    if in_rows:
        columns, dt = _samples_in_rows(table, dt, scale)
    else:
        columns, dt = _columns_of(table, options, dt)
        _require_agreement("the step of the times", dt, stated)
    for i in columns:
        require_accelerations(table.head, "" if in_rows else table.name(i))
    count = table.stated(HEAD_COUNT)
    if count and count.value != (n := len(next(iter(columns.values())))):
        raise ValueError(f"{n} samples; the header states {count.value:g} in line {count.place}; skip= leaves it out")
    return [
        Trace(_factor(table, options.unit, i) * values, dt, {"STREAM": name or f"{i}"} if len(columns) > 1 else {})
        for (i, values), name in zip(columns.items(), [table.bare(i) for i in columns], strict=True)
    ]


def _samples_in_rows(table: RecordTable, dt: float | None, scale: float) -> tuple[dict[int, Array], float]:
    """The accelerations of rows as one column, and their time step [s].

    Rows of pairs, each a time and its acceleration, have a step of their own.
    """
    values = np.array([x for row in table.values for x in row])
    if _has_pairs(values, table.decimals, scale):
        step_of_pairs = float(f"{_grid(scale * values[::2])[0]:.12g}")
        _require_agreement("dt, which was given,", dt, HeaderNumber(step_of_pairs, table.places[0]))
        return {0: values[1::2]}, step_of_pairs
    if dt is None:
        raise NoRecordError("samples in rows need their time step: give dt")
    return {0: values}, dt


def _has_pairs(values: Array, decimals: int, scale: float) -> bool:
    """Whether numbers in rows are pairs of a time and an acceleration: every other one increases evenly."""
    return len(values) % 2 == 0 and len(values) > 6 and _is_grid(scale * values[::2], decimals, scale)


def _table_of(lines: Sequence[str], skip: int | None) -> RecordTable:
    """The header and the rows of a file. Raises a ValueError with the first word of a row that is no number."""
    first = 0 if skip is None else require_whole("skip", skip, 0, max(len(lines) - 1, 0))
    head: dict[int, str] = {}
    texts: dict[int, str] = {}
    for place, line in enumerate(lines[first:], first + 1):
        if COMMENT.match(line) or not (texts or _is_row(lines, place)):
            require_visible(line, place)
            head |= {} if texts else {place: line}
        else:
            texts[place] = line
    commas = _decimal_commas(texts.values())
    rows: list[list[float]] = []
    decimals = 0
    for place, line in texts.items():
        words_of = _cells(line, commas)
        try:
            rows.append([number(word, place) for word in words_of])
        except ValueError as error:
            require_accelerations(head | {place: line})
            error_type = NoRecordError if PROSE.search(line) else ValueError
            raise error_type(f"{error}; skip={place} leaves out what is above" if not rows else str(error)) from error
        decimals = max(decimals, len(words_of[0].partition(".")[2]))
    return RecordTable({} if skip is not None else head, _names(list(head.values()), rows), rows, list(texts), decimals)


def _is_row(lines: Sequence[str], place: int) -> bool:
    """Whether a line may be the first row: a line of words that has not as many columns as the next one is a header."""
    line = lines[place - 1]
    if not DATA.match(line) or not PROSE.search(line):
        return bool(DATA.match(line))
    after = next((line for line in lines[place:] if not COMMENT.match(line)), line)
    return len(re.split(r"[\s,;]+", line.strip())) == len(re.split(r"[\s,;]+", after.strip()))


def _decimal_commas(texts: Iterable[str]) -> bool:
    """Whether each comma of some rows is a decimal one: all columns between tabs or blanks have such numbers, or one
    column has, where a digit of zero follows a comma, with which no number begins."""
    with_commas = [text for text in texts if "," in text]
    if not with_commas or any("." in text or ";" in text for text in texts):
        return False
    if not all(DECIMAL_COMMA.fullmatch(word) for text in with_commas for word in words(text) if "," in word):
        return False
    return any(len(words(text)) > 1 or re.search(r",0\d", text) for text in with_commas)


def _cells(line: str, commas: bool) -> list[str]:
    """The words of a row, set apart by semicolons, commas, or blanks and tabs, without quotes; a last separator is
    none. Between semicolons and within quotes a comma is a decimal point."""
    line = re.sub('"([^"]*)"', lambda quoted: quoted[1].replace(",", "."), line)
    if commas or ";" in line:
        line = line.replace(",", ".")
    mark = next((mark for mark in ";," if mark in line), None)
    if mark is None:
        return [part for word in words(line) for part in split_columns(word)]
    return [word.strip(" \t") for word in line.strip(" \t").removesuffix(mark).split(mark)]


def _names(head: Sequence[str], rows: Sequence[Sequence[float]]) -> list[str]:
    """Names of the columns: the last line of the header if it has as many words as the rows have columns."""
    last = next((line for line in reversed(head) if line.strip()), "").lstrip("#%/ ")
    width = len(rows[-1]) if rows else 0
    for separator in (";", "\t", ",", r"\s{2,}", r"\s+"):
        names = [name.strip(' "\t') for name in re.split(separator, last)]
        names = names[:-1] if names and not names[-1] else names
        if len(names) == width and any(names):
            return names
    return []


def _without_header(
    table: RecordTable, dt: float | None, stated: HeaderNumber | None
) -> tuple[RecordTable, HeaderNumber | None]:
    """The table without rows that are numbers of a header, and the step that they state.

    They are some where one of them is the number of rows or samples that follow.

    Raises:
        ValueError: with both readings where they may be: one equals dt, stands alone, or the row is not as wide as the
            others.
    """
    for rows in range(1, MOST_HEADER_NUMBERS):
        lead, below = [x for row in table.values[:rows] for x in row], table.values[rows:]
        if len(lead) > MOST_HEADER_NUMBERS or len(below) < 10:
            break
        counts = {float(len(below))} | ({float(sum(map(len, below)))} if table.width > 2 else set())
        if set(lead) & counts:
            steps = [x for x in lead if FINEST <= x < COARSEST]
            return table.without(rows), HeaderNumber(steps[0], table.places[0]) if len(steps) == 1 else stated
    first, *others = table.values
    doubted = 0
    if len(others) >= 3:
        wide = table.width > 1
        follows = others[0] == [dt] and first[0] != 0 and first[0] == int(first[0])
        alone = len(others) >= 10 and abs(first[0]) > max(
            max(abs(row[0]) for row in others), HEADER_RATIO * max(abs(row[0]) for row in others[:NUMBERS_COMPARED])
        )
        grid = wide and len(first) == table.width and _is_grid(table.without(1).column(0), table.decimals, 1.0)
        early = grid and not _is_grid(table.column(0), table.decimals, 1.0)
        if len(first) == 1 and not wide and dt is not None:
            doubted = 2 if follows else int(first == [dt] or alone)
        elif len(first) != table.width or early:
            doubted = 1
    if doubted:
        where, hint = table.places[0], "" if dt is None else f" (dt = {dt:g} s was given)"
        raise ValueError(
            f"{' and '.join(table.row_text(i) for i in range(doubted))}{hint}: of the header, or the first row? "
            f"skip={table.places[doubted] - 1} reads what follows, skip={where - 1} takes it as a row"
        )
    return table, stated


def _columns_of(table: RecordTable, options: TableOptions, dt: float | None) -> tuple[dict[int, Array], float]:
    """The accelerations by the number of their column, in the unit of the file, and their time step [s]."""
    if options.columns is not None:
        requested = [options.columns] if isinstance(options.columns, int | str) else list(options.columns)
        if len(requested) > table.width == 1:
            step = "" if dt else " and give its time step dt"
            chosen = f"columns = {in_message(str(options.columns))}"
            raise ValueError(f"line {table.places[0]} has one column, and {chosen} takes several; leave it out{step}")
        picked = [_number_of(table, column) for column in requested]
    else:
        picked = list(range(table.width))
    for place, row in zip(table.places, table.values, strict=True):
        if len(row) != table.width:
            rows = "; samples in rows are read with dt" if dt is None and place == table.places[-1] else ""
            raise ValueError(f"line {place} has {len(row)} columns; the others have {table.width}{rows}")
    scale = TIME_UNITS[options.time_unit]
    if table.width > 2 and table.width % 2 == 0 and _has_pairs(np.concatenate(table.values), table.decimals, scale):
        raise ValueError(
            f"line {table.places[0]} begins rows of {table.width // 2} pairs of a time and an acceleration: "
            "columns='rows' reads them"
        )
    time = scale * table.column(picked[0])
    grid = _is_grid(time, table.decimals, scale)
    timed = len(picked) > 1 and (dt is None or grid)
    if options.columns is None and (len(picked) > 2 or (len(picked) == 2 and not timed)):
        rows = "" if grid else f", or {'' if dt else 'dt= and '}columns='rows' for samples in rows"
        raise NoRecordError(f"line {table.places[0]} has {table.choice(timed)}{rows}")
    if not timed:
        if dt is None:
            raise NoRecordError(f"line {table.places[0]} has one column of accelerations; give its time step dt")
        return {i: table.column(i) for i in picked}, dt
    if len(picked) < 2:
        raise ValueError("a column of accelerations is needed beside the one of times")
    return {i: table.column(i) for i in picked[1:]}, _step_of(time, table, scale, dt)


def _number_of(table: RecordTable, column: object) -> int:
    """The number of a column that is given by it or by its name, with or without what stands there in brackets."""
    if not isinstance(column, str):
        return require_whole("a number in columns", column, 0, table.width - 1)
    for names in (table.names, [table.bare(i) for i in range(len(table.names))]):
        fit = [i for i, name in enumerate(names) if name.casefold() == column.strip().casefold()]
        if len(fit) == 1:
            return fit[0]
    if not table.names:
        raise ValueError(
            f"columns has {in_message(column)}; the file has no names; give numbers, 0 to {table.width - 1}"
        )
    valid = ", ".join(map(in_message, table.names))
    raise ValueError(f"columns has {in_message(column)}; the names are {valid}")


def _grid(time: Array) -> tuple[float, float]:
    """The step of the even grid that lies closest to times, and how far from it one of them lies at most."""
    i = np.arange(len(time)) - 0.5 * (len(time) - 1)
    dt = float(i @ time / (i @ i))
    return dt, float(np.abs(time - time.mean() - dt * i).max())


def _is_even(time: Array, decimals: int, scale: float) -> bool:
    """Whether times lie on an even grid within 1 % of its step, or what their decimals round, up to a tenth of it."""
    dt, off = _grid(time)
    return 0 <= off <= max(UNEVEN_TIME * dt, min(0.51 * scale * 10.0**-decimals, UNEVEN_ROUNDED * dt))


def _is_grid(time: Array, decimals: int, scale: float) -> bool:
    """Whether a column may be one of times: at least three that increase evenly."""
    return len(time) > 2 and bool((np.diff(time) > 0).all()) and _is_even(time, decimals, scale)


def _step_of(time: Array, table: RecordTable, scale: float, given: float | None) -> float:
    """The step of a column of times [s], or the given one, against which the column is held."""
    steps, places = np.diff(time), table.places
    back = np.flatnonzero(steps <= 0)
    if back.size:
        i = back[0]
        if steps[i] == 0:
            raise ValueError(
                f"line {places[i + 1]}: the time {time[i]:g} s stands twice; a motion that jumps is made by "
                "GroundMotion.pieces, and a record has one value at each time"
            )
        raise ValueError(f"line {places[i + 1]}: time does not increase, {time[i]:g} s to {time[i + 1]:g} s")
    dt = float(f"{_grid(time)[0]:.12g}")  # so that two components have one step
    if not _is_even(time, table.decimals, scale):
        usual = float(np.median(steps))
        i = int(np.abs(steps - usual).argmax())
        raise ValueError(
            f"line {places[i + 1]}: uneven time steps, {steps[i]:g} s from {time[i]:g} s on where {usual:g} s is usual"
        )
    if given is not None:
        numbered = table.decimals == 0 and math.isclose(dt, scale)
        if abs(given - dt) > max(UNEVEN_TIME * given, 10.0**-table.decimals * scale / len(steps)) and not numbered:
            raise ValueError(f"dt = {given:g} s was given, and the times from line {places[0]} on step by {dt:g} s")
        return given
    if SLOW_SAMPLING <= dt <= COARSEST:
        raise ValueError(
            f"line {places[0]}: the first column steps by {dt:g} s: times so far apart, or the numbers of the rows? "
            f"dt= gives the time step, and dt={dt / scale:g} takes it as times"
        )
    return dt


def _require_agreement(name: str, given: float | None, stated: HeaderNumber | None) -> None:
    """Raise a ValueError with both readings where a step is another than the one that a header states."""
    if given is not None and stated is not None and abs(given - stated.value) > UNEVEN_TIME * stated.value:
        raise ValueError(
            f"{name} is {given:g} s, and line {stated.place} states {stated.value:g} s; skip= leaves it out"
        )


def _stands_in_rows(table: RecordTable) -> bool:
    """Whether samples stand in rows.

    They do where the last row is shorter. They also do where at least four jump less along the rows than down the
    columns, and from the end of a row to the next not much more than within it.
    """
    *full, last = table.values
    if table.width < 3 or any(len(row) != table.width for row in full) or len(last) > table.width:
        return False
    if len(last) < table.width:
        return True
    values = np.array(table.values)
    down, within = (float(np.abs(np.diff(values, axis=axis)).mean()) for axis in (0, 1))
    on = float(np.abs(values[1:, 0] - values[:-1, -1]).mean())
    return table.width > 3 and within < SMOOTH_ROWS * down and on < 2 * within


def _factor(table: RecordTable, unit: str | float | None, column: int) -> float:
    """The unit of a column [m/s2], held against that of its name, or against the only one that the header names."""
    name = table.name(column)
    of_name = stated_units(name)
    of_head = {unit: place for place, line in table.head.items() for unit in stated_units(line[:HEADER_LINE])}
    stated = of_name or list(of_head)
    if unit is None:
        if len(stated) != 1:
            names = " and ".join(stated) or "no unit"
            raise NoRecordError(f"the header names {names}; give unit=, one of {', '.join(ACCELERATION_UNITS)}")
        return ACCELERATION_UNITS[stated[0]]
    if isinstance(unit, str) and table.head and len(stated) == 1 and stated != [unit]:
        where = f"the name {in_message(name)} of the column" if of_name else f"line {of_head[stated[0]]}"
        raise ValueError(f"unit = {unit!r} was given, and {where} says {stated[0]}; skip= leaves it out")
    return factor_of(unit)
