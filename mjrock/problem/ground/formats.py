"""Formats of records that state their step and unit: the files of data bases and of networks, and seismograms by ObsPy.

Each parser takes the lines of a file and returns its traces, the components in their order, or raises a ValueError
with the line where the header is another. FORMATS has all of them, and how each is recognised.
"""

from __future__ import annotations

import importlib.util
import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...quantities import GRAVITY, Array, require_within, warn_of
from .records import (
    ACCELERATION_UNITS,
    AS_ASCII,
    BINARY,
    BREAK,
    COARSEST,
    COUNT,
    DECIMAL,
    FINEST,
    NoRecordError,
    OtherContentError,
    Parse,
    TableOptions,
    Trace,
    all_numbers,
    binary_kind,
    factor_of,
    in_message,
    is_book,
    numbers,
    parse_table,
    require_accelerations,
    require_visible,
    samples,
    stated_units,
    step,
    table_lines,
    value_of,
)

AT2_UNIT = re.compile(
    r"\s*acceleration\s+(time\s+(series|history)\s+)?in\s+units\s+of\s+g(\s*[.,;])?\s*(filter\s+points\b.*)?", AS_ASCII
)
FILTERS = rf"(?:[\s.,;]*(?:[-+]?\d+\s*pole\s*@|[hl]p\s*[=:]?|filter\s+points\s*:?)\s*(?:{DECIMAL}\s*(?:hz)?)?)*[\s.,]*"
"""What may follow the time step of an AT2 file: the filters that the record went through."""
AT2_HEAD = re.compile(
    rf"\s*npts\s*=\s*{COUNT}[\s,]*dt\s*=\s*(?>{DECIMAL})(?:\s*(?:s|sec|seconds)\b)?{FILTERS}", AS_ASCII
)
AT2_OLD_HEAD = re.compile(rf"\s*{COUNT}[\s,]+{DECIMAL}[\s,]+npts[\s,]+dt[\s,]*", AS_ASCII)
AT2_PLACE = re.compile(r"([^,]*)(?:,\s*\d[\d/ -]*)?,\s*(.*?),\s*(?:-(?=[A-Z]))?([^,(]*?)\s*(?:\(.*)?", AS_ASCII)
"""Event, date, station and component, the last of them an azimuth or UP."""
EVENT_LINE = 200
"""Characters of a line with the names of event and station that are looked at."""
ESM_FIELD = re.compile(r"([A-Z0-9_/^]+):[ \t]*(.*)", AS_ASCII)
ESM_LINES = 64
"""Lines of the header of an ESM or ITACA file, one field in each."""
ESM_UNITS = {"cm/s^2": 1e-2, "m/s^2": 1.0, "g": GRAVITY}
SAC_HEAD = re.compile(rf"[ \t]*{COUNT}[ \t]+{DECIMAL}(?:[ \t]+(.*))?", AS_ASCII)

KNET = {
    "Station Code": r"(?P<STATION_CODE>\S+)", "Origin Time": "(?P<EVENT_ID>.+)", "Dir.": "(?P<dir>[NEU]-[SWD]|[1-6])",
    "Sampling Freq(Hz)": rf"(?P<rate>{DECIMAL[1:-1]})\s*Hz", "Duration Time(s)": rf"(?P<span>{DECIMAL[1:-1]})",
    "Scale Factor": rf"(?P<gal>{DECIMAL[1:-1]})\(gal\)/(?P<counts>{DECIMAL[1:-1]})",
}  # fmt: skip
"""Fields of the header of a K-NET file, and how each is written."""
KNET_STREAMS = "NS", "EW", "UD"
KNET_HEAD = 17
SAMPLE_COUNT = re.compile(rf"\s*{COUNT}\s+(?:points\s+of\s+)?accel(?:eration|erogram)?\b.*", AS_ASCII)
"""What stands before the samples of a channel in files of CSMIP and COSMOS, with their number."""
SAMPLING_LINE = re.compile(rf"\bat\s+{DECIMAL}\s*(sec|pts/sec)", AS_ASCII)
WIDTH = re.compile(r"\(\s*+\d*+\s*+[efg](\d{1,3})\.\d{1,3}\s*\)", AS_ASCII)
CHANNEL_LINE = re.compile(r"(?:Sta )?Cha[n:]?\s*[\d?]+:\s*(H\d|[\d.]+(?=\s*deg)|[a-z]+)", AS_ASCII)
STATION = re.compile(r"Stat?n?(?:ion)? (?:No\.?|Id\.?)[ :.]*([\w-]+)(?:\s+Code: ?(?:(\w+)-)?(\w+))?", AS_ASCII)
SCNL = re.compile(r"<SCNL>(\w+)\.(\w+)\.(\w+)", AS_ASCII)
GEONET_STEP = re.compile(rf"(?:.*\bat\s+{DECIMAL}\s*s(?:ec)?\s+intervals|.*intervals\s+of\s+{DECIMAL}\s*s).*", AS_ASCII)
GEONET_COUNT = re.compile(rf"Number of points\s+{COUNT}\b.*", AS_ASCII)
GEONET_HEAD = 26
"""Lines of the header of a component of GeoNet: 16 of text and 10 of numbers."""
SEISMOGRAM = {
    "NETWORK": "network", "STATION_CODE": "station", "LOCATION": "location", "STREAM": "channel",
    "DATE_TIME_FIRST_SAMPLE": "starttime",
}  # fmt: skip
"""Fields of the header of a seismogram, as ObsPy names them."""
SAC_QUANTITIES = {6: "displacements", 7: "velocities", 8: "accelerations"}
"""What the field IDEP of the header of a SAC file says; 5 is unknown."""
INSTRUMENTS = {
    "H": "a seismometer", "L": "a seismometer", "P": "a geophone", "M": "the mass position of a seismometer",
    "J": "a rotation sensor", "D": "a pressure sensor",
}  # fmt: skip
"""Instruments that are no accelerometers, by the second letter of the channel (SEED manual, appendix A)."""
UNAM = (
    "CLAVE DE LA ESTACION", "INTERVALO DE MUESTREO, C1", "ORIENTACION C1", "NUM. TOTAL DE MUESTRAS, C1",
    "UNIDADES DE LOS DATOS",
)  # fmt: skip
"""How the fields of the header of a file of UNAM begin: station, step, direction, number of samples, unit."""
SMC_HEAD = 27
"""Lines of the header of an SMC file: 11 of text, 6 of whole numbers and 10 of real ones; then its comments."""


def esm_header(lines: Sequence[str]) -> dict[str, str]:
    """The fields of the header of an ESM or ITACA file, by name: EVENT_ID, STATION_CODE, STREAM, UNITS and so on."""
    fields = [ESM_FIELD.fullmatch(line.rstrip()) for line in lines[:ESM_LINES]]
    for place, field in enumerate(fields, 1):
        if field is None:
            raise NoRecordError(
                f"line {place} is {in_message(lines[place - 1])}: not an ESM or ITACA file, whose first {ESM_LINES} "
                "lines are fields such as STATION_CODE: AMT"
            )
    return {field[1].upper(): field[2] for field in fields if field is not None}


def parse_esm(lines: list[str]) -> list[Trace]:
    """The record of an ESM or ITACA file: unit, step and number of samples of its header, and a value a line."""
    head = esm_header(lines)
    for name in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS"):
        if not head.get(name):
            raise ValueError(f"the header has no {name}; an ESM or ITACA file of accelerations states it")
    if (data_type := head.get("DATA_TYPE", "ACCELERATION").upper()) != "ACCELERATION":
        raise NoRecordError(f"DATA_TYPE is {in_message(data_type)}; the record has to be one of ACCELERATION")
    require_accelerations({list(head).index("UNITS") + 1: f"UNITS: {head['UNITS']}"})
    if (unit := head["UNITS"].lower()) not in ESM_UNITS:
        raise ValueError(f"UNITS is {in_message(head['UNITS'])}; the valid ones are {', '.join(ESM_UNITS)}")
    if not re.fullmatch(COUNT, head["NDATA"]):
        raise ValueError(f"NDATA is {in_message(head['NDATA'])}; it has to be the number of samples")
    place = list(head).index("SAMPLING_INTERVAL_S") + 1
    dt = step(head["SAMPLING_INTERVAL_S"], place)
    values = samples(lines, ESM_LINES, int(head["NDATA"]), list(head).index("NDATA") + 1)
    return [Trace(ESM_UNITS[unit] * values, dt, head)]


def esm_text(accel: Array, dt: float, header: Mapping[str, str]) -> str:
    """An ESM file of accelerations [m/s2] every dt seconds, which states its own unit, step, and number of samples.

    Raises:
        ValueError: for a field of the header that such a file cannot have.
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
            f"header = {in_message(str(dict(header)))}: at most {ESM_LINES - len(stated)} fields, each one line "
            "NAME: value with its name in capitals, as in an ESM file"
        )
    return "\n".join([*lines, *(repr(value) for value in (accel / ESM_UNITS["cm/s^2"]).tolist())]) + "\n"


def parse_at2(lines: list[str]) -> list[Trace]:
    """The record of a PEER NGA file: four header lines, the last with NPTS and DT, then values in g."""
    if len(lines) < 4 or not AT2_UNIT.fullmatch(lines[2]):
        instead = f"line 3 is {in_message(lines[2])}" if len(lines) > 2 else f"{len(lines)} lines"
        raise NoRecordError(f"{instead}: not an AT2 file, whose line 3 is ACCELERATION TIME SERIES IN UNITS OF G")
    head = AT2_HEAD.fullmatch(lines[3]) or AT2_OLD_HEAD.fullmatch(lines[3])
    if head is None:
        raise ValueError(f"line 4 states no NPTS and DT as in NPTS= 4000, DT= .0100 SEC alone: {in_message(lines[3])}")
    place = AT2_PLACE.fullmatch(BREAK.sub(" ", lines[1])[:EVENT_LINE].strip())
    stated = dict(zip(("EVENT_NAME", "STATION_NAME", "STREAM"), place.groups(), strict=True)) if place else {}
    return [Trace(GRAVITY * samples(lines, 4, int(head[1])), step(head[2], 4), stated)]


def parse_sac(lines: list[str], unit: str | float) -> list[Trace]:
    """The record of a text with a title line, a line that begins with count and time step [s], then its values."""
    head = SAC_HEAD.fullmatch(lines[1]) if len(lines) > 1 else None
    if head is None:
        instead = f"line 2 is {in_message(lines[1])}" if len(lines) > 1 else "1 line"
        raise NoRecordError(
            f"{instead}: not the plain text of a SAC record: line 2 begins with the number of samples and dt"
        )
    require_accelerations({1: lines[0]})
    numbers(head[3] or "", 2)  # the other columns are not used
    return [Trace(factor_of(unit) * samples(lines, 2, int(head[1])), step(head[2], 2), {})]


def parse_knet(lines: list[str]) -> list[Trace]:
    """The component of a K-NET or KiK-net file: 17 header lines, then counts, which are taken from their mean.

    So does the network, whose header states the largest |acceleration| from the mean. The component of KiK-net is a
    number, 1 to 3 in the borehole (LOCATION 1) and 4 to 6 at the surface (LOCATION 2).
    """
    stated: dict[str, str] = {}
    for place, line in enumerate(lines[:KNET_HEAD], 1):
        for name, written in KNET.items():
            if line.startswith(name):
                match = re.fullmatch(written, line[len(name) :].strip(), AS_ASCII)
                if match is None:
                    raise ValueError(f"line {place} is {in_message(line)}: not as in a K-NET or KiK-net file")
                stated |= match.groupdict()
    if missing := [name for name, written in KNET.items() if re.findall(r"P<(\w+)>", written)[0] not in stated]:
        raise NoRecordError(f"the first {KNET_HEAD} lines have no {missing[0]}: not a K-NET or KiK-net file")
    rate, gal, full = (value_of(stated[name]) for name in ("rate", "gal", "counts"))
    require_within("line 11: sampling frequency", rate, 1 / COARSEST, 1 / FINEST, "Hz")
    require_within("line 14: counts of the scale factor", full, 1, 1e12)
    counts = samples(lines, KNET_HEAD, round(value_of(stated["span"]) * rate), 12)
    header = {name: stated[name] for name in ("STATION_CODE", "EVENT_ID")}
    if stated["dir"].isdigit():  # KiK-net
        number_of = int(stated["dir"]) - 1
        header |= {"STREAM": KNET_STREAMS[number_of % 3], "LOCATION": str(1 + number_of // 3)}
    else:
        header["STREAM"] = stated["dir"].replace("-", "")
    return [Trace(ACCELERATION_UNITS["cm/s2"] * gal / full * (counts - counts.mean()), 1 / rate, header)]


class Field(NamedTuple):
    """What stands after the colon of a field of a header, and the number of its line."""

    text: str
    place: int


class Channel(NamedTuple):
    """The samples of a channel within a file, and the text that stands before them.

    Args:
        place: number of the line that announces them.
        text: the lines with letters since the channel before, this one included.
        values: the samples, in the unit of the file.
    """

    place: int
    text: str
    values: Array


def channels(lines: Sequence[str]) -> Iterator[Channel]:
    """The channels of a file of CSMIP or COSMOS: a line such as "7500 points of accel data" and as many numbers.

    Velocities and displacements that follow are passed over. Where the line has the format, as in (8f10.6), the columns
    have that width.
    """
    text: list[str] = []
    numbered = iter(enumerate(lines, 1))
    for place, line in numbered:
        require_visible(line, place)
        text += [line] if re.search("[a-zA-Z]{2}", line) else []
        if head := SAMPLE_COUNT.fullmatch(line):
            values: list[float] = []
            while len(values) < int(head[1]) and (row := next(numbered, None)):
                values += numbers(_columns(row[1], line), row[0])
            if len(values) != int(head[1]):
                raise ValueError(f"{len(values)} samples; line {place} states {head[1]}")
            yield Channel(place, "\n".join(text), np.array(values))
            text = []


def _columns(line: str, announced: str) -> str:
    """A line whose columns are set apart, where the line that announces it states their width."""
    stated = WIDTH.search(announced)
    width = int(stated[1]) if stated else 0
    return " ".join(line[k : k + width] for k in range(0, len(line.rstrip()), width)) if width else line


def parse_channels(lines: list[str]) -> list[Trace]:
    """The channels of a file of CSMIP (V1, V2) or COSMOS (V0 to V2) that state their unit; V0 in counts is refused.

    The step stands in the line before the samples. In COSMOS it is the 62nd number of the header of real ones [ms].
    """
    traces = []
    for channel in channels(lines):
        announced = lines[channel.place - 1]
        units = stated_units(announced)
        if len(units) != 1:
            raise ValueError(f"line {channel.place} names no unit of accelerations: {in_message(announced)}")
        if every := SAMPLING_LINE.search(announced):
            dt = value_of(every[1]) if every[2].lower() == "sec" else 1 / max(value_of(every[1]), 1 / COARSEST)
        else:
            dt = _cosmos_step(lines, channel.place)
        traces.append(Trace(ACCELERATION_UNITS[units[0]] * channel.values, dt, _channel_header(channel.text)))
    if not traces:
        raise NoRecordError("no line such as 7500 points of accel data at .010 sec: not a file of CSMIP or COSMOS")
    return traces


def _cosmos_step(lines: Sequence[str], place: int) -> float:
    """The step of the samples that a line announces, from the last header of real numbers before it."""
    heads = [i for i in range(place) if re.match(r"\s*\d+ Real-header values follow", lines[i], AS_ASCII)]
    if not heads:
        raise ValueError(f"line {place} states no time step, and no header of real numbers stands before it")
    rows = itertools.takewhile(lambda i: not re.search("[|a-zA-Z]", lines[i]), range(heads[-1] + 1, place))
    values = [x for i in rows for x in numbers(_columns(lines[i], lines[heads[-1]]), i + 1)]
    if len(values) < 62:
        raise ValueError(f"line {heads[-1] + 1}: {len(values)} numbers follow; the 62nd is the time step [ms]")
    return values[61] / 1000


def _channel_header(text: str) -> dict[str, str]:
    """Station, component and event of a channel, from the text before its samples."""
    header = {}
    if station := STATION.search(text):
        named = {"NETWORK": station[2], "STATION_CODE": station[3] or station[1]}
        header = {name: value for name, value in named.items() if value}
    if channel := CHANNEL_LINE.findall(text):
        header["STREAM"] = channel[-1].upper()
    if scnl := SCNL.search(text):
        header |= {"STATION_CODE": scnl[1], "STREAM": scnl[2], "NETWORK": scnl[3]}
    return header


def parse_geonet(lines: list[str]) -> list[Trace]:
    """The components of a GeoNet file, V1A or V2A: 26 header lines each, then accelerations in mm/s2.

    In V2A velocities and displacements follow, which are passed over.
    """
    heads = [i for i, line in enumerate(lines) if re.match("(Unc|C)orrected accelerogram .*GNS", line)]
    if heads[:1] != [0]:
        raise NoRecordError(f"line 1 is {in_message(lines[0])}: not a GeoNet file, which begins Corrected accelerogram")
    return [_geonet_component(lines[:end], first) for first, end in itertools.pairwise([*heads, len(lines)])]


def _geonet_component(lines: list[str], first: int) -> Trace:
    """The component that begins at a line, the first as number 0."""
    stated: dict[str, tuple[int, re.Match[str]]] = {}
    patterns = {
        "count": GEONET_COUNT, "step": GEONET_STEP, "STREAM": re.compile(r"Component (\S+).*"),
        "STATION_CODE": re.compile(r"Site (\S+).*"), "EVENT_ID": re.compile(r"(\d{4} \w+ +\d+ +[\d:]+ UT).*"),
        "unit": re.compile(r"Acceleration:\s+peak\s+\S+ (mm/s/s).*", AS_ASCII),
    }  # fmt: skip
    for place, line in enumerate(lines[first : first + 16], first + 1):
        stated |= {name: (place, match) for name, pattern in patterns.items() if (match := pattern.fullmatch(line))}
    if missing := [name for name in patterns if name not in stated]:
        raise ValueError(f"lines {first + 1} to {first + 16} state no {missing[0]}: no header of a GeoNet component")
    count, (place, every) = int(stated["count"][1][1]), stated["step"]
    after = first + GEONET_HEAD
    values = np.array(all_numbers(lines, after))
    if len(values) not in (count, 3 * count):
        raise ValueError(
            f"{len(values)} samples from line {after + 1} on; line {stated['count'][0]} states {count}, of "
            "accelerations alone or of velocities and displacements too"
        )
    header = {name: stated[name][1][1] for name in ("STATION_CODE", "STREAM", "EVENT_ID")}
    return Trace(ACCELERATION_UNITS["mm/s2"] * values[:count], step(every[1] or every[2], place), header)


def parse_smc(lines: list[str]) -> list[Trace]:
    """The record of an SMC file of the USGS: a corrected accelerogram at a stated rate, in cm/s2."""
    if len(lines) < SMC_HEAD or not re.match(r"\s*2 CORRECTED ACCELEROGRAM", lines[0], AS_ASCII):
        raise NoRecordError(f"line 1 is {in_message(lines[0])}: not an SMC file of a record, 2 CORRECTED ACCELEROGRAM")
    integers, real = all_numbers(lines, 11, 17), all_numbers(lines, 17, SMC_HEAD)
    if len(integers) != 48 or len(real) != 50:
        raise ValueError(f"lines 12 to 27 hold {len(integers)} whole and {len(real)} real numbers; they are 48 and 50")
    rate = require_within("line 18: samples a second", real[1], 1 / COARSEST, 1 / FINEST, "Hz")
    comments = int(require_within("line 13: number of comments", integers[15], 0, 10_000))
    values = samples(lines, SMC_HEAD + comments, int(integers[16]), 14)
    header = {"STREAM": "UP" if integers[12] in (0, 180) else f"{integers[13]:03g}"}
    if station := re.match(r"station =(.*?)\s*component=", lines[5]):
        header["STATION_NAME"] = station[1].strip()
    return [Trace(ACCELERATION_UNITS["cm/s2"] * values, 1 / rate, header)]


def parse_unam(lines: list[str]) -> list[Trace]:
    """The channels of a file of UNAM (Archivo Standard de Aceleracion 2.0): a header of fields, then a column for each.

    Fields of the channels have a value of each after a slash, as in /.01/.01/.01.
    """
    fields: dict[str, Field] = {}
    last = 0
    for place, line in enumerate(lines, 1):
        if re.search("CANAL|[:=]|-{3}", line):
            require_visible(line, place)
            name, _, value = line.partition(":")
            fields.setdefault(next((key for key in UNAM if name.strip().startswith(key)), ""), Field(value, place))
            last = place
    if missing := [name for name in UNAM if name not in fields]:
        raise ValueError(f"the header has no {missing[0]}: not a file of UNAM of accelerations")
    station, steps, streams, counts, units = (fields[name] for name in UNAM)
    named = [word.strip() for word in streams.text.split("/")[1:] if word.strip()]
    every = [step(word.strip(), steps.place) for word in steps.text.split("/")[1 : len(named) + 1]]
    rows = [numbers(line, place) for place, line in enumerate(lines[last:], last + 1) if line.strip()]
    stated = [word.strip() for word in counts.text.split("/")[1 : len(named) + 1]]
    if len(named) != len(every) or stated != [str(len(rows))] * len(named):
        raise ValueError(
            f"{len(rows)} samples of {len(named)} channels; line {counts.place} states {', '.join(stated)}"
        )
    if bad := [last + i for i, row in enumerate(rows, 1) if len(row) != len(named)]:
        raise ValueError(f"line {bad[0]} has {len(rows[bad[0] - last - 1])} columns for {len(named)} channels")
    require_accelerations({units.place: f"units: {units.text}"})
    if len(unit := stated_units(units.text)) != 1:
        raise ValueError(f"line {units.place} names no unit of accelerations: {in_message(units.text.strip())}")
    factor, code = ACCELERATION_UNITS[unit[0]], station.text.strip()
    columns = np.array(rows).T
    return [
        Trace(factor * column, dt, {"STATION_CODE": code, "STREAM": stream})
        for column, dt, stream in zip(columns, every, named, strict=True)
    ]


def seismograms(path: Path, unit: str | float | None) -> list[Trace]:
    """The traces of a file of seismology, such as SAC and miniSEED, by ObsPy, in a unit that the file does not state.

    Raises:
        ImportError: if ObsPy is missing.
        ValueError: for a file that ObsPy cannot read, a record with gaps, or no unit.
    """
    try:
        import obspy
    except ImportError as error:
        raise ImportError(f"{error}; ObsPy reads SAC, miniSEED and more: pip install obspy") from error
    try:
        stream = obspy.read(str(path))
    except Exception as error:
        error_type = NoRecordError if isinstance(error, TypeError) else ValueError  # of none of its formats, or damaged
        raise error_type(f"ObsPy does not read it: {in_message(str(error))}") from error
    if unit is None:
        raise NoRecordError(
            f"a file of {stream[0].stats._format} states no unit: give unit=, one of "
            f"{', '.join(ACCELERATION_UNITS)}, or as a number how many m/s2 a count is"
        )
    ids = [trace.id for trace in stream]
    if broken := [name for name in ids if ids.count(name) > 1]:
        raise ValueError(f"{broken[0]} has a gap or an overlap: {ids.count(broken[0])} pieces; one is needed")
    traces = []
    for trace in stream:
        _require_accelerometer(trace.stats, unit)
        stated = {name: str(getattr(trace.stats, field)) for name, field in SEISMOGRAM.items()}
        header = {name: value for name, value in stated.items() if value}
        traces.append(Trace(factor_of(unit) * np.asarray(trace.data, dtype=float), float(trace.stats.delta), header))
    return traces


def _require_accelerometer(stats: Any, unit: str | float) -> None:
    """Raise a `NoRecordError` for a trace of velocities or displacements, by its SAC header or the code of its channel.

    A unit by name says that the samples of a seismometer have been turned into accelerations. A warning repeats it.
    """
    stated = SAC_QUANTITIES.get(int(getattr(stats, "sac", {}).get("idep", 5)))
    if stated is not None and stated != "accelerations":
        raise NoRecordError(f"the field IDEP of its SAC header says {stated}; a record of accelerations is needed")
    code = re.fullmatch(r"[BCDEFGHLMS]([A-Z])[ENZ1-9UVWTR]", stats.channel)
    if stated is not None or code is None or code[1] not in INSTRUMENTS:
        return
    channel = f"the channel {stats.channel} is of {INSTRUMENTS[code[1]]}, as its second letter says"
    if not isinstance(unit, str):
        raise NoRecordError(
            f"{channel}, and its counts are no accelerations. Remove its response to accelerations, and give their "
            "unit by its name, such as unit='m/s2'"
        )
    warn_of(f"{channel}; its samples are taken as accelerations in {unit}, without its response")


class Format(NamedTuple):
    """A format of text.

    Args:
        name: its name.
        signs: what one of its first lines holds, and no other format's.
        parse: its parser.
    """

    name: str
    signs: re.Pattern[str]
    parse: Parse


FORMATS = (
    Format("PEER AT2", re.compile(r"\s*acceleration\s.*units\s+of", AS_ASCII), parse_at2),
    Format("ESM and ITACA", re.compile(r"EVENT_NAME:|NETWORK:|STATION_CODE:", AS_ASCII), parse_esm),
    Format("K-NET and KiK-net", re.compile(r"Sampling Freq\(Hz\)"), parse_knet),
    Format("GeoNet V1A and V2A", re.compile(r"(Unc|C)orrected accelerogram .*GNS"), parse_geonet),
    Format("SMC", re.compile(r"\s*\d\s+\w+ accelerogram\s*$", AS_ASCII), parse_smc),
    Format("UNAM", re.compile(r"(CLAVE DE LA ESTACION|INTERVALO DE MUESTREO, C1|ORIENTACION C1)"), parse_unam),
    Format(
        "CSMIP and COSMOS",
        re.compile(r"(un)?corrected (accelerogram|acceleration)|raw acceleration", AS_ASCII),
        parse_channels,
    ),
)
"""Formats of text that state their step and unit, in the order in which they are tried."""

FIRST_LINES = 60
"""First lines of a file that are looked at for the signs of formats."""
UTF_16 = b"\xff\xfe", b"\xfe\xff"
"""How a text in UTF-16 begins, which is refused by that name."""
SEISMOLOGY = re.compile(r"TIMESERIES |WID[12] |BEGIN GSE2")
"""How texts of seismology begin, which ObsPy reads."""


def recognised(path: Path, unit: str | float | None) -> list[Trace]:
    """The traces of a file: of a format that its first lines show, of a table whose header states its step and unit, or
    of a file of seismology by ObsPy."""
    start = path.read_bytes()[:4096]
    binary = None if is_book(path) or start.startswith(UTF_16) else binary_kind(start)
    if binary and (binary != BINARY or importlib.util.find_spec("obspy")):
        return seismograms(path, unit)
    lines = table_lines(path)
    for file_format in FORMATS:
        if any(file_format.signs.match(line) for line in lines[:FIRST_LINES]):
            return file_format.parse(lines)
    if SEISMOLOGY.match(lines[0]):
        return seismograms(path, unit)
    try:
        return parse_table(lines, TableOptions(unit))
    except OtherContentError:
        raise
    except ValueError as error:
        names = ", ".join(file_format.name for file_format in FORMATS)
        raise type(error)(
            f"{error}. It was read as a table, as from_csv and components_in do with unit=, dt=, columns= and skip=, "
            f"since it is none of the formats {names}, SAC, miniSEED"
        ) from error
