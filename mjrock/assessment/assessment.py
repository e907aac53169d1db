"""An assessment: mechanisms, what they are checked against, and what a report says of them, as one file has them."""

from __future__ import annotations

import codecs
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Literal

from ..contacts.files import require_file
from ..quantities import require_path, require_text
from ..study.loading.code_check import MechanismCheck
from .declarations import Key
from .mechanisms import Mechanism, mechanisms_of
from .reading import Reader
from .tables import LARGEST, AssessmentError, Fault, Place, Table, line_of, lines_of, located, parsed, spelt_place

OF_ALL = {
    "language": Key("language", Literal["en", "it"], "en", "of check and report"),
    "project": Key("project", Mapping[str, str], None, "title block of the report"),
}
"""Keys that a file has once."""


@dataclass(frozen=True, repr=False)
class Assessment:
    """Mechanisms of a building, and what they are checked against, as one file has them. `mjrock.from_toml` reads one.

    Args:
        mechanisms: by name; a file with one that has no name has it as "".
        language: of check and report, "en" or "it".
        project: title block of the report.
        name: of the file, for messages; empty where there is none.
        document: the tables of the file, as plain dictionaries and lists.
        lines: the line of each key of the file.
    """

    mechanisms: Mapping[str, Mechanism]
    language: str = "en"
    project: Mapping[str, str] = field(default_factory=dict)
    name: str = ""
    document: Mapping[str, Any] = field(default_factory=dict, repr=False)
    lines: Mapping[Place, int] = field(default_factory=dict, repr=False, compare=False)

    def __repr__(self) -> str:
        parts = [f"{name or 'mechanism'}: {one.problem!r}" for name, one in self.mechanisms.items()]
        return f"<Assessment of {', '.join(parts)}>"

    def check(self) -> dict[str, MechanismCheck]:
        """The kinematic check of each mechanism, by name.

        Raises:
            AssessmentError: with the line of the mechanism that cannot be checked, and why.
        """
        return {name: self._of(one, one.check) for name, one in self.mechanisms.items()}

    def _of(self, mechanism: Mechanism, call: Callable[[], Any]) -> Any:
        """What a function of a mechanism returns; its error names the table."""
        try:
            return call()
        except (TypeError, ValueError) as error:
            place = mechanism.place
            fault = Fault(place, f"{spelt_place(place)}: {error}", line_of(place, self.lines))
            raise AssessmentError((fault,), self.name) from None


def from_toml(path: str | Path | None = None, *, text: str | None = None) -> Assessment:
    """Read an assessment from a file.

    Every table of the file is a public object or function, and its keys are the arguments, see docs/assessment_file.md.
    Numbers are in SI units, or texts with a unit such as "30 cm".

    Args:
        path: of the TOML file. Paths in it are relative to its folder.
        text: its content instead of a path; then it can name no other files.

    Raises:
        OSError: if the file cannot be read.
        AssessmentError: a ValueError with all that is wrong, each with file, line, key, value, range and remedy.

    Examples:
        >>> wall = "[wall]\\nthickness = '30 cm'\\nheight = 3.0\\n"
        >>> site = "[site]\\ncode = 'EC8 type 1'\\nag = '0.1 g'\\nsoil = 'A'"
        >>> round(mr.from_toml(text=wall + site).check()[""].alpha_0, 3)
        0.1
    """
    if (path is None) == (text is None):
        raise TypeError("from_toml takes a path, or a text")
    if text is not None:
        return assessment_of_text(require_text("text", text, LARGEST))
    path = require_path("path", path)
    return assessment_of_text(read_text(path), str(path), path.parent)


def read_text(path: Path) -> str:
    """The text of a file; an AssessmentError for one that is too large or no text in UTF-8."""
    size = require_file(path).stat().st_size
    if size > 4 * LARGEST:
        raise AssessmentError((Fault((), f"has {size} bytes; the valid range is 0 to {4 * LARGEST}"),), str(path))
    return decoded(path.read_bytes(), str(path))


def decoded(data: bytes, name: str) -> str:
    """The text of a file in UTF-8, or in UTF-16 as PowerShell writes it; an AssessmentError for any other."""
    marked = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        return data.decode("utf-16" if marked else "utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        fault = Fault((), f"is no text in UTF-8: byte {error.start + 1} is 0x{data[error.start]:02x}", line)
        raise AssessmentError((fault,), name) from None


def assessment_of_text(text: str, name: str = "", folder: Path | None = None) -> Assessment:
    """The assessment of a text in TOML, see `from_toml`."""
    try:
        document = parsed(text)
    except AssessmentError as error:
        raise AssessmentError(error.faults, name) from None
    return assessment_of(document, name, folder, lines_of(text))


def assessment_of(
    document: Mapping[str, Any],
    name: str = "",
    folder: Path | None = None,
    lines: Mapping[Place, int] | None = None,
) -> Assessment:
    """The assessment of plain tables, as `tomllib` and a form make them.

    Args:
        document: the tables.
        name: of their file, for messages.
        folder: what paths in them are relative to; None reads no path.
        lines: the line of each key.

    Raises:
        AssessmentError: with all that is wrong.
    """
    reader = Reader(folder, lines or {}, name)
    top: Table = located(document)
    whole: dict[str, Any] = {}
    for name_of in OF_ALL.keys() & top.values.keys():
        whole[name_of] = reader.attempted(partial(reader.value, OF_ALL[name_of], top.values[name_of], (name_of,)))
    mechanisms = mechanisms_of(reader, top.without(*OF_ALL))
    if not mechanisms and not reader.faults:
        reader.refuse((), "the file has no mechanism; give it a table [wall], or several under [mechanisms.NAME]")
    reader.require_sound()
    return Assessment(mechanisms, name=name, document=document, lines=lines or {}, **whole)
