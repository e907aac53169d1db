"""Sets of records: the components of each station in a folder, and one factor for the components of a record.

Headers and names of files state the direction of a component. What a header states comes before what a name looks like.
A vertical component never counts as a horizontal one.
"""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Annotated, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import (
    Array,
    Within,
    named,
    require_kind,
    require_path,
    require_sequence,
    require_text,
    shown,
    spelt,
    warn_of,
)
from .formats import recognised
from .motion import GroundMotion, motion_of
from .oscillator import Periods
from .records import NoRecordError, TableOptions, read, table_traces
from .spectrum import SpectrumOfCode, factor_to_spectrum, response_spectrum, scaled_by

VERTICAL = re.compile(r"(?:[A-Z][GHLNJ])?[ZVU]|UP|DO?W?N|VERT?(?:ICAL)?|VRT|U-?D|VT", re.IGNORECASE)
CHANNEL_CODE = re.compile(r"([A-Z][GHLNJ])([ENXYLTZVU123])", re.IGNORECASE)
"""A code such as HNE: band and instrument, then the direction."""
AZIMUTH = re.compile(r"(\d{1,3}(?:\.\d*)?)(?: ?deg)?", re.IGNORECASE)
BEARING = re.compile(r"([NS]) ?(\d{1,2}) ?([EW])", re.IGNORECASE)
FAMILIES = (
    ("E", "N"), ("EW", "NS"), ("E-W", "N-S"), ("EAST", "NORTH"), ("X", "Y"), ("L", "T"), ("LN", "TR"), ("H1", "H2"),
    ("FN", "FP"), ("1", "2"),
)  # fmt: skip
"""The two horizontal directions of a record, as networks name them; 1 and 2 only in a channel such as HN1."""
UPRIGHT_CODES = "VERT|VER|VRT|UP|DWN|DN|U-D|UD"
TOKENS = "|".join(sorted({token for family in FAMILIES[:-1] for token in family}, key=len, reverse=True))
DIRECTION_IN_NAME = (
    re.compile(rf"(?<![A-Za-z])({UPRIGHT_CODES}|{TOKENS}|[ZVU])(?![A-Za-z])", re.IGNORECASE),
    re.compile(rf"(?<![A-Za-z])({CHANNEL_CODE.pattern})(?![A-Za-z0-9])", re.IGNORECASE),
    re.compile(r"(?<=\d)([xyz])(?=[a-z]\.)", re.IGNORECASE),
    re.compile(r"(?<=[A-Za-z\d-])(\d{3})(?=(?:\.\w*)?$)"),
    re.compile(rf"({UPRIGHT_CODES})(?=(?:\.\w*)?$)"),
)
"""Where the name of a file states a direction: between characters that are no letters, as a channel, after a number as
REXEL has it, as three digits at the end, and as up or down at the end."""
AZIMUTH_AT_END = re.compile(r"\d{3}(?:\.\w*)?")
RIGHT_ANGLE_TOLERANCE = 5.0
"""How far two azimuths of a record may be from square to each other [degrees]."""
COMMON_FIELDS = ("NETWORK", "STATION_CODE", "STATION_NAME", "LOCATION", "EVENT_ID", "EVENT_NAME")
"""Fields of a header that are the same for all components of a record."""


class RecordFiles(NamedTuple):
    """Files of one record.

    Args:
        key: the name of the record.
        tokens: the direction of each component, the horizontal ones first, by the name of its file.
        by: how they were found to go together, in words.
    """

    key: str
    tokens: dict[str, str]
    by: str


def is_vertical(token: str) -> bool:
    """Whether a direction is the vertical one."""
    return VERTICAL.fullmatch(token) is not None


def is_direction(token: str) -> bool:
    """Whether a text is a direction: an azimuth, up, or one of the names of networks, such as N, NS, HNE, H1."""
    return is_vertical(token) or azimuth(token) is not None or any(_bare(token) in family for family in FAMILIES)


def azimuth(token: str) -> float | None:
    """The azimuth of a direction such as 045, 360 deg or N80W [degrees]."""
    if number := AZIMUTH.fullmatch(token):
        return float(number[1])
    if bearing := BEARING.fullmatch(token):
        from_north = float(bearing[2]) * (1 if bearing[3].upper() == "E" else -1)
        return from_north if bearing[1].upper() == "N" else 180 - from_north
    return None


def order(token: str) -> tuple[bool, float, str]:
    """A key by which components stand in order: horizontal ones by azimuth or as E, N; then the vertical one."""
    rank = next((float(family.index(_bare(token))) for family in FAMILIES if _bare(token) in family), None)
    angle = azimuth(token)
    return is_vertical(token), rank if rank is not None else angle if angle is not None else 0.0, token


def of_one_record(tokens: Sequence[str]) -> bool:
    """Whether directions are those of one record: one or two horizontal ones of a kind, and at most one vertical."""
    horizontal = [token for token in tokens if not is_vertical(token)]
    if len(set(tokens)) < len(tokens) or not 1 <= len(horizontal) <= 2 or not 2 <= len(tokens) <= len(horizontal) + 1:
        return False
    angles = [angle for token in horizontal if (angle := azimuth(token)) is not None]
    square = len(angles) == 2 and abs((angles[1] - angles[0]) % 180 - 90) <= RIGHT_ANGLE_TOLERANCE
    return (
        len(horizontal) == 1
        or square
        or any({_bare(token) for token in horizontal} == set(family) for family in FAMILIES)
    )


def grouped(headers: Mapping[str, Mapping[str, str]]) -> list[RecordFiles]:
    """Which files are components of one record, by their names and their headers.

    Raises:
        ValueError: for a name that goes with others in more than one way.
    """
    groups = list(_grouped_by_header(headers))
    used = {name for group in groups for name in group.tokens}
    groups += _grouped_by_names({name: header for name, header in headers.items() if name not in used})
    used = {name for group in groups for name in group.tokens}
    for name, header in headers.items():
        if name not in used:
            upright = [token for token, _ in _candidates(name, header) if re.fullmatch(UPRIGHT_CODES, token)]
            stream = header.get("STREAM", "")
            token = stream if is_direction(stream) or not upright else upright[-1]
            groups.append(RecordFiles(name, {name: token}, "alone"))
    return sorted(groups)


def _grouped_by_header(headers: Mapping[str, Mapping[str, str]]) -> Iterator[RecordFiles]:
    """Files whose headers state one station and event, and directions that go together."""
    sets: dict[tuple[str, ...], dict[str, str]] = {}
    for name, header in headers.items():
        stream = header.get("STREAM", "")
        if is_direction(stream) and {"STATION_CODE", "STATION_NAME"} & header.keys():
            code = CHANNEL_CODE.fullmatch(stream)
            sets.setdefault((*_identity(name, header), code[1] if code else ""), {})[name] = stream
    for tokens in sets.values():
        if of_one_record(list(tokens.values())):
            yield _group(tokens, "header")


def _grouped_by_names(headers: Mapping[str, Mapping[str, str]]) -> list[RecordFiles]:
    """Files whose names differ in their direction alone, and whose headers do not differ."""
    sets: dict[str, dict[str, str]] = {}
    for name, header in headers.items():
        for token, key in _candidates(name, header):
            sets.setdefault(key, {})[name] = token
    alike = {key: len({_identity(name, headers[name]) for name in tokens}) == 1 for key, tokens in sets.items()}
    groups = {key: tokens for key, tokens in sets.items() if alike[key] and of_one_record(list(tokens.values()))}
    for name in headers:
        if len(keys := [key for key, tokens in groups.items() if name in tokens]) > 1:
            raise ValueError(f"{name} goes with other files in more than one way: {', '.join(keys)}; give a pattern")
    return [_group(tokens, "names") for tokens in groups.values()]


def _identity(name: str, header: Mapping[str, str]) -> tuple[str, ...]:
    """The fields of a header that are the same for all components of a record, with the number of PEER in its name."""
    number = re.search(r"RSN\d+", name, re.IGNORECASE)
    return (number[0].upper() if number else "", *(header.get(field, "") for field in COMMON_FIELDS))


def _candidates(name: str, header: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Directions that the name of a file may have, each with the name that has ? in its place.

    One that is vertical where the header states a horizontal one, or the other way round, is part of another word. So
    is what stands before the azimuth at the end, as the station VER in A-VER083.
    """
    stream = header.get("STREAM", "")
    for pattern in DIRECTION_IN_NAME:
        for match in pattern.finditer(name):
            token = match[1]
            if is_direction(stream) and is_vertical(stream) != is_vertical(token):
                continue
            if is_vertical(token) and AZIMUTH_AT_END.fullmatch(name[match.end() :]):
                continue
            first = match.end() - 1 if CHANNEL_CODE.fullmatch(token) else match.start()
            if not token.isdigit() or int(token) <= 360:
                yield token, f"{name[:first].removesuffix('-')}?{name[match.end() :]}"


def _group(tokens: dict[str, str], by: str) -> RecordFiles:
    """The components of a record in their order, under the name that their files have in common."""
    names = sorted(tokens, key=lambda name: order(tokens[name]))
    common = [{key for _, key in _candidates(name, {"STREAM": tokens[name]})} for name in names]
    shared = sorted(set.intersection(*common))
    return RecordFiles(shared[0] if shared else ", ".join(names), {name: tokens[name] for name in names}, by)


def _bare(token: str) -> str:
    """A direction without the band and instrument of its channel, in capitals."""
    code = CHANNEL_CODE.fullmatch(token)
    return code[2].upper() if code else token.upper()


MOST_SHOWN = 8
"""Most records that `repr` of a set names."""
Records = Mapping[str, tuple[GroundMotion, ...]]
"""Components of records by the names of these."""


class RecordSet(dict[str, tuple[GroundMotion, ...]]):
    """Records by name: the components of each, the horizontal ones first, a vertical one last where there is one.

    A component whose header has a vertical one in STREAM, such as HNZ or UP, is never taken for a horizontal one.
    `repr` shows the components of each record, and how `records_in` found that they go together, as `by` has it.
    """

    @cached_property
    def by(self) -> dict[str, str]:
        """How the components of a record were found to go together: "header", "names" or "one file"."""
        return {}

    @cached_property
    def skipped(self) -> dict[str, str]:
        """The files of the folder that hold no record, and why, by their names."""
        return {}

    def __repr__(self) -> str:
        lines = [f"<RecordSet of {len(self)} records>"]
        for name, components in list(self.items())[:MOST_SHOWN]:
            streams = ", ".join(motion.header.get("STREAM") or motion.name for motion in components)
            lines.append(f"  {name}: {streams}{f' (by {self.by[name]})' if name in self.by else ''}")
        lines += ["  ..."] if len(self) > MOST_SHOWN else []
        return "\n".join([*lines, f"  no records: {named(list(self.skipped))}"] if self.skipped else lines)

    def __or__(self, other: Records) -> RecordSet:  # type: ignore[override]
        """The records of both; those of the second where both have one of a name."""
        return _joined(self, other) if isinstance(other, Mapping) else NotImplemented

    def __ror__(self, other: Records) -> RecordSet:  # type: ignore[override]
        """The records of both; those of this set where both have one of a name."""
        return _joined(other, self) if isinstance(other, Mapping) else NotImplemented

    @property
    def horizontal(self) -> list[GroundMotion]:
        """The horizontal components of all records, at most two of each."""
        return [motion for components in self.values() for motion in _horizontal(components)[:2]]

    @property
    def first(self) -> list[GroundMotion]:
        """The first horizontal component of each record that has one."""
        return [horizontal[0] for components in self.values() if (horizontal := _horizontal(components))]

    def scaled_to(
        self, spectrum: ArrayLike | SpectrumOfCode, periods: Periods, damping: Annotated[float, Within(0, 0.9)] = 0.05
    ) -> RecordSet:
        """The set with each record scaled to a spectrum, all components of a record by one factor.

        Args:
            spectrum: of a code, or pseudo-accelerations at the periods [m/s2].
            periods: at which they are compared [s], 0.01 to 100, shape (n,).
            damping: damping ratio [-], 0 to 0.9.

        Raises:
            TypeError, ValueError: for a value outside its range, a motion at rest, or a record with no horizontal
                component.
        """
        if alone := [name for name, components in self.items() if not _horizontal(components)]:
            raise ValueError(f"{named(alone)}: no horizontal component; del records[{alone[0]!r}] leaves it out")
        scaled = {name: scaled_together(components, periods, spectrum, damping) for name, components in self.items()}
        return _with_origins(scaled, self)

    def mean_over(self, spectrum: SpectrumOfCode, periods: ArrayLike, damping: float = 0.05) -> Array:
        """Mean of the spectra of the horizontal components over that of a code at each period [-], shape (n,).

        Raises:
            TypeError, ValueError: for a value outside its range, or a set without records.
        """
        require_kind("spectrum", spectrum, *get_args(SpectrumOfCode))
        if not self:
            raise ValueError("the set has no records")
        spectra = [response_spectrum(motion, periods, damping) for motion in self.horizontal]
        return np.asarray(np.mean([response.Sa for response in spectra], axis=0) / spectrum(spectra[0].period, damping))


def components_in(
    path: str | PathLike[str],
    unit: str | float | None = None,
    *,
    time_unit: str = "s",
    dt: float | None = None,
    columns: int | str | Sequence[int | str] | None = None,
    skip: int | None = None,
    sheet: str | None = None,
) -> tuple[GroundMotion, ...]:
    """All components of the record in one file: of any format that `GroundMotion.from_file` reads, or of a table.

    A file is read as a table where `dt`, `columns`, `skip`, `sheet` or a `time_unit` other than "s" are given.
    Horizontal components come first.

    Args:
        path: the file.
        unit, time_unit, dt, columns, skip, sheet: as `GroundMotion.from_csv` takes them; `columns` may have several
            accelerations, after the times.

    Raises:
        OSError: if the file cannot be read.
        ImportError: for a format whose library is missing.
        ValueError: as `GroundMotion.from_file` and `GroundMotion.from_csv`.
    """
    if time_unit == "s" and all(option is None for option in (dt, columns, skip, sheet)):
        traces = read(path, lambda file: recognised(file, unit))
    else:
        traces = table_traces(path, TableOptions(unit, time_unit, dt, columns, skip, sheet))
    motions = (motion_of(trace, path) for trace in traces)
    return tuple(sorted(motions, key=lambda motion: order(motion.header.get("STREAM", ""))))


def records_in(
    folder: str | PathLike[str],
    read: Callable[[Path], GroundMotion | Sequence[GroundMotion]] = components_in,
    pattern: str = "*",
) -> RecordSet:
    """The records of a folder, as data bases, networks and REXEL write them: a file for each component, or one for all.

    Components go together by what their headers state: STREAM (HNE, HNN, HNZ, an azimuth), station, event and location;
    otherwise by the names of their files, which differ in E, N, Z, or E, N, U, or NS, EW, UD, or X, Y, Z, or L, T, V,
    or in two azimuths that are square to each other and UP, DWN, VER or V. Headers of different stations or events keep
    files apart, and so do the numbers RSN of PEER. The horizontal components come first, the vertical one last. A file
    that goes with no other is a record of one component. Files that hold no record, such as the velocities and lists
    of a download of PEER, are left out with a warning; one that is damaged is refused.

    Args:
        folder: where the files are.
        read: reads one file, such as `GroundMotion.from_at2`; one motion, or all components that are in the file.
        pattern: which files, such as "*.ASC".

    Returns:
        The components of each record, by the name of its files with ? in place of the direction, in order. The set has
        `scaled_to`, which scales it to a spectrum.

    Raises:
        OSError: if the folder cannot be read.
        ValueError: for a folder without records, names that go together in more than one way, or a record that is
            damaged.

    Warns:
        UserWarning: of files that hold no record, which `skipped` of the set names.
    """
    folder, pattern = require_path("folder", folder), require_text("pattern", pattern)
    files = {path.name: path for path in sorted(folder.iterdir()) if path.is_file() and not path.name.startswith(".")}
    names = [name for name in files if fnmatch.fnmatch(name.lower(), pattern.lower())]
    if not names:
        raise ValueError(f"{folder} has no file that fits the pattern {spelt(pattern)}")
    records = RecordSet()
    single: dict[str, GroundMotion] = {}
    for name, motions in _read_all({name: files[name] for name in names}, read, records.skipped).items():
        if isinstance(motions, GroundMotion) or len(motions) == 1:
            single[name] = motions if isinstance(motions, GroundMotion) else motions[0]
        elif of_one_record([motion.header.get("STREAM", "") for motion in motions]):
            records[name], records.by[name] = tuple(motions), "one file"
        else:
            single |= {f"{name}, {i} {motion.header.get('STREAM', '')}": motion for i, motion in enumerate(motions)}
    for key, tokens, by in grouped({name: motion.header for name, motion in single.items()}):
        unused = key if key not in records else next(iter(tokens))
        records[unused] = tuple(_directed(single[name], token) for name, token in tokens.items())
        records.by |= {unused: by} if len(tokens) > 1 else {}
    return _with_origins(dict(sorted(records.items())), records)


def _read_all(
    files: Mapping[str, Path], read: Callable[[Path], GroundMotion | Sequence[GroundMotion]], skipped: dict[str, str]
) -> dict[str, GroundMotion | Sequence[GroundMotion]]:
    """What is read from each file by its name. Those that hold no record are named in `skipped`, with a warning.
    Raises a `NoRecordError` where none holds one."""
    contents = {}
    for name, path in files.items():
        try:
            contents[name] = read(path)
        except NoRecordError as error:
            if len(skipped) + 1 == len(files):
                raise
            skipped[name] = str(error).removeprefix(f"{path}: ")
    if skipped:
        first = next(iter(skipped))
        warn_of(
            f"{len(skipped)} of {len(files)} files hold no record and are left out: {named(list(skipped))}; {first}: "
            f"{skipped[first]}; pattern= takes others, and .skipped has each reason"
        )
    return contents


def _directed(motion: GroundMotion, token: str) -> GroundMotion:
    """A motion whose header has its direction in STREAM."""
    if motion.header.get("STREAM", "") == token:
        return motion
    return motion.headed({**motion.header, "STREAM": token})


def _horizontal(components: Sequence[GroundMotion]) -> list[GroundMotion]:
    """The horizontal ones of the components of a record."""
    return [motion for motion in components if not is_vertical(motion.header.get("STREAM", ""))]


def _with_origins(records: Records, *origins: Records) -> RecordSet:
    """A set, with what the sets that it is made of know of their files."""
    record_set = RecordSet(records)
    for origin in origins:
        if isinstance(origin, RecordSet):
            record_set.by.update(origin.by)
            record_set.skipped.update(origin.skipped)
    return record_set


def _joined(first: Records, second: Records) -> RecordSet:
    """The records of two sets; those of the second where both have one of a name."""
    return _with_origins({**first, **second}, first, second)


def scaled_together(
    motions: Sequence[GroundMotion], periods: ArrayLike, target: ArrayLike | SpectrumOfCode, damping: float = 0.05
) -> tuple[GroundMotion, ...]:
    """The components of a record scaled by one factor to a spectrum, a vertical one by the same.

    The factor is that of `scaled_to_spectrum` for the geometric mean of the spectra of the first two horizontal
    components, or of the only one.

    Args:
        motions: the components, the horizontal ones first, at least one.
        periods, target, damping: as `scaled_to_spectrum` takes them.

    Raises:
        TypeError, ValueError: for a value outside its range, a motion at rest, or vertical components alone.
    """
    require_sequence("motions", motions, "a sequence of at least one GroundMotion")
    if not motions:
        raise TypeError(f"motions = {shown(motions)} is not a sequence of at least one GroundMotion")
    for i, motion in enumerate(motions):
        require_kind(f"motions[{i}]", motion, GroundMotion)
    if not (horizontal := _horizontal(motions)):
        raise ValueError(f"motions has no horizontal component, but {motions[0].header['STREAM']}")
    factors = [factor_to_spectrum(motion, periods, target, damping) for motion in horizontal[:2]]
    factor = float(np.exp(np.log(factors).mean()))
    return tuple(scaled_by(factor, motion, periods, target) for motion in motions)
