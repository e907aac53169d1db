"""Components of records: their directions, as headers and names of files tell them, and which go together.

A vertical component never counts as a horizontal one. What a header states comes before what a name looks like.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

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
"""Where the name of a file has a direction: between what are no letters, as a channel, after a number as REXEL has it,
as three digits at the end, and as up or down at the end."""
SQUARE = 5.0
"""How far two azimuths of a record may be from square to each other [degrees]."""
IDENTITY = ("NETWORK", "STATION_CODE", "STATION_NAME", "LOCATION", "EVENT_ID", "EVENT_NAME")
"""Fields of a header that are the same for all components of a record."""


class RecordFiles(NamedTuple):
    """Files of one record.

    Args:
        key: the name of the record.
        tokens: the direction of each component, the horizontal ones first, by the name of its file.
        by: what told that they go together, in words.
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
    level = [token for token in tokens if not is_vertical(token)]
    if len(set(tokens)) < len(tokens) or not 1 <= len(level) <= 2 or not 2 <= len(tokens) <= len(level) + 1:
        return False
    angles = [angle for token in level if (angle := azimuth(token)) is not None]
    square = len(angles) == 2 and abs((angles[1] - angles[0]) % 180 - 90) <= SQUARE
    return len(level) == 1 or square or any({_bare(token) for token in level} == set(family) for family in FAMILIES)


def grouped(headers: Mapping[str, Mapping[str, str]]) -> list[RecordFiles]:
    """Which files are components of one record, by their names and the headers of what is in them.

    Raises:
        ValueError: for a name that goes with others in more than one way.
    """
    groups = list(_by_header(headers))
    taken = {name for group in groups for name in group.tokens}
    groups += _by_names({name: header for name, header in headers.items() if name not in taken})
    taken = {name for group in groups for name in group.tokens}
    for name, header in headers.items():
        if name not in taken:
            upright = [token for token, _ in _candidates(name) if re.fullmatch(UPRIGHT_CODES, token)]
            groups.append(RecordFiles(name, {name: (upright or [header.get("STREAM", "")])[-1]}, "alone"))
    return sorted(groups)


def _by_header(headers: Mapping[str, Mapping[str, str]]) -> Iterator[RecordFiles]:
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


def _by_names(headers: Mapping[str, Mapping[str, str]]) -> list[RecordFiles]:
    """Files whose names differ in their direction alone, and whose headers do not tell them apart."""
    sets: dict[str, dict[str, str]] = {}
    for name in headers:
        for token, key in _candidates(name):
            sets.setdefault(key, {})[name] = token
    same = {key: len({_identity(name, headers[name]) for name in tokens}) == 1 for key, tokens in sets.items()}
    groups = {key: tokens for key, tokens in sets.items() if same[key] and of_one_record(list(tokens.values()))}
    for name in headers:
        if len(keys := [key for key, tokens in groups.items() if name in tokens]) > 1:
            raise ValueError(f"{name} goes with other files in more than one way: {', '.join(keys)}; give a pattern")
    return [_group(tokens, "names") for tokens in groups.values()]


def _identity(name: str, header: Mapping[str, str]) -> tuple[str, ...]:
    """What tells the records of headers and of PEER, which numbers them in the names of its files, apart."""
    number = re.search(r"RSN\d+", name, re.IGNORECASE)
    return (number[0].upper() if number else "", *(header.get(field, "") for field in IDENTITY))


def _candidates(name: str) -> Iterator[tuple[str, str]]:
    """Directions that the name of a file may have, each with the name that has ? in its place."""
    for pattern in DIRECTION_IN_NAME:
        for found in pattern.finditer(name):
            token = found[1]
            first = found.end() - 1 if CHANNEL_CODE.fullmatch(token) else found.start()
            if not token.isdigit() or int(token) <= 360:
                yield token, f"{name[:first].removesuffix('-')}?{name[found.end() :]}"


def _group(tokens: dict[str, str], by: str) -> RecordFiles:
    """The components of a record in their order, under the name that their files have in common."""
    names = sorted(tokens, key=lambda name: order(tokens[name]))
    common = [{key for _, key in _candidates(name)} for name in names]
    shared = sorted(set.intersection(*common))
    return RecordFiles(shared[0] if shared else ", ".join(names), {name: tokens[name] for name in names}, by)


def _bare(token: str) -> str:
    """A direction without the band and instrument of its channel, in capitals."""
    code = CHANNEL_CODE.fullmatch(token)
    return code[2].upper() if code else token.upper()
