"""An assessment: mechanisms, the demand of their checks, and the content of a report, as in one file."""

from __future__ import annotations

import codecs
import copy
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..contacts.files import require_file, write_text
from ..quantities import Message, require_path, require_text
from ..result.response import Response
from ..study.loading.design import Design, design
from ..study.loading.dynamic_check import DynamicCheck
from ..study.loading.mechanism_check import MechanismCheck
from ..toml_text import toml_text
from .declarations import REQUIRED, Key, Maker, maker_of
from .documents import UnwrittenError, mechanism_table, values_of
from .mechanisms import Mechanism, mechanisms_of
from .reading import Reader, caused
from .tables import MOST_CHARACTERS, AssessmentError, Document, Fault, Place, Table, line_of, located, parsed

if TYPE_CHECKING:  # tasks bring MuJoCo, which a kinematic check does not need
    from ..study.analysis import Analysis

FILE_KEYS = {
    "language": Key("language", Literal["en", "it"], "en", "of check and report"),
    "project": Key("project", Mapping[str, str], None, "title block of the report"),
}
"""Keys that a file has once."""
DESIGN = Maker(
    design,
    {
        "key": Key("key", str, REQUIRED, "the key of the file whose values are tried, such as effects[0].diameter"),
        "method": maker_of(design).keys["method"],
    },
    "The first of some values for which every condition holds.",
)
"""What `[design]` has, beside the values that are tried."""
KEYS_BY_MECHANISM = "checks", "e", "contacts"
"""Arguments of `report` that may be mappings by mechanism."""


@dataclass(frozen=True, repr=False)
class Assessment:
    """Mechanisms of a building, and what they are checked against, as one file has them. `mjrock.from_toml` reads one.

    Args:
        mechanisms: by name; a file with one that has no name has it as "".
        language: of check and report, "en" or "it".
        project: title block of the report.
        name: of the file, for messages; empty where there is none.
        document: the tables of the file, as plain dictionaries and lists.
        source: the text of the file, for the lines of messages; empty where there is none.
        folder: what paths in the tables are relative to; None reads none.
        texts: further arguments of `report`.
        trials: of `[design]`, the key, its values and the method that counts; empty where the file has none.
        confined: whether a path that leads out of that folder is refused.
    """

    mechanisms: Mapping[str, Mechanism]
    language: str = "en"
    project: Mapping[str, str] = field(default_factory=dict)
    name: str = field(default="", compare=False)
    document: Document = field(default_factory=dict, repr=False, compare=False)
    source: str = field(default="", repr=False, compare=False)
    folder: Path | None = field(default=None, compare=False)
    texts: Mapping[str, Any] = field(default_factory=dict)
    trials: Mapping[str, Any] = field(default_factory=dict)
    confined: bool = False

    def __repr__(self) -> str:
        parts = [f"{name or 'mechanism'}: {mechanism.problem!r}" for name, mechanism in self.mechanisms.items()]
        return f"<Assessment of {', '.join(parts)}>"

    def check(self) -> dict[str, MechanismCheck]:
        """The kinematic check of each mechanism, by name.

        Raises:
            AssessmentError: with the line of the mechanism that cannot be checked, and why.
        """
        return {name: self._call(mechanism, mechanism.check) for name, mechanism in self.mechanisms.items()}

    def analyses(self) -> dict[str, list[Analysis]]:
        """Tasks of all runs for `campaign`, by mechanism: each record in both polarities, or the release.

        Mechanisms that nothing moves have none. Where nothing moves any of them, each has a run at rest.

        Raises:
            AssessmentError: with the line of the mechanism that cannot be run, and why.
        """
        mechanisms = self.moved or self.mechanisms
        return {name: self._call(mechanism, mechanism.analyses) for name, mechanism in mechanisms.items()}

    def run(self) -> dict[str, list[Response]]:
        """The responses of all runs, by mechanism, see `analyses`."""
        return {
            name: [self._call(self.mechanisms[name], analysis.solve) for analysis in analyses]
            for name, analyses in self.analyses().items()
        }

    def dynamic_check(self, runs: Mapping[str, Sequence[Response]]) -> dict[str, DynamicCheck]:
        """The check by its runs of each mechanism, see `mjrock.dynamic_check`.

        Args:
            runs: responses by mechanism, such as those of `run`.
        """
        mechanisms = {name: self.mechanisms[name] for name in runs}
        return {name: self._call(item, partial(item.dynamic, runs[name])) for name, item in mechanisms.items()}

    def design(self) -> Design:
        """The first of the values of `[design]` for which every condition holds.

        The conditions are those of the mechanism that has the key, or of all where they share it.

        Raises:
            AssessmentError: without that table, or where no value can be checked.
        """
        if not self.trials:
            raise self._error((), Message("the file has no [design]; give it key and values"))
        place, values = place_of(self.trials["key"]), self.trials["values"]

        def build(value: object) -> dict[str, MechanismCheck]:
            document = replaced(self.document, place, value)
            for table in (document, *document.get("mechanisms", {}).values()):
                table.pop("records", None)  # no condition of a design is about them, and reading them takes long
            assessment = assessment_of(document, folder=self.folder, confined=self.confined)
            changed = [str(place[1])] if place[0] == "mechanisms" else list(assessment.mechanisms)
            return {name: assessment.mechanisms[name].check() for name in changed}

        try:
            return design(build, values, method=self.trials.get("method"))
        except (TypeError, ValueError) as error:
            raise self._error(("design",), caused(("design",), error)) from None

    def report(
        self, path: str | Path, runs: Mapping[str, Sequence[Response]] | None = None, *, language: str | None = None
    ) -> Path:
        """Write the report of all checks, of the design, and of runs where they are given, see `mjrock.report`.

        Args:
            path: where to, an .html or a .pdf.
            runs: responses by mechanism, such as those of `run`.
            language: "en" or "it"; None is that of the file.
        """
        from ..reporting.page import report
        from ..reporting.texts import Words

        problem: Any = next(iter(self.mechanisms.values())).problem
        checks: dict[str, Any] = {name: [check] for name, check in self.check().items()} if self.has_site else {}
        responses_by_name = dict(runs or {})
        for name, responses_of_one in responses_by_name.items():
            mechanism = self.mechanisms[name]
            if (verdict := self._call(mechanism, partial(mechanism.verdict_on, responses_of_one))) is not None:
                checks.setdefault(name, []).append(verdict)
        shakings = {name: self.mechanisms[name].shaking for name in responses_by_name}
        options: dict[str, Any] = {
            "checks": checks or None,
            "project": dict(self.project) or None,
            "language": language or self.language,
            "e": {name: shaking.e for name, shaking in shakings.items() if shaking.e is not None} or None,
            "contacts": {name: shaking.contacts for name, shaking in shakings.items() if shaking.contacts} or None,
        }
        if self.trials:
            words = Words(options["language"])
            key = words("design_of", key=self.trials["key"])
            options["sections"] = {words("design"): [key, self.design()]}
        if list(self.mechanisms) == [""]:
            options |= {name: value[""] for name, value in options.items() if name in KEYS_BY_MECHANISM and value}
        responses: Any = responses_by_name.get("", ()) if "" in self.mechanisms else responses_by_name or ()
        return report(problem, responses, path, **options, **self.texts)

    @property
    def moved(self) -> dict[str, Mechanism]:
        """The mechanisms that something moves, by name."""
        return {name: mechanism for name, mechanism in self.mechanisms.items() if mechanism.is_moved}

    @property
    def has_site(self) -> bool:
        """Whether each mechanism has what a check is against."""
        return all(mechanism.demand is not None for mechanism in self.mechanisms.values())

    def to_toml(self, path: str | Path | None = None) -> str:
        """The file as TOML text, floats with all their digits; written to a path where one is given.

        Values are those of the file, with their units. Comments are not kept. One that was made in Python, or changed
        there, is written in SI units, blocks by their vertices and records by their samples.

        Raises:
            AssessmentError: with the key, for what a file has no words for, such as functions.
        """
        is_read = bool(self.document) and assessment_of(self.document, folder=self.folder) == self
        text = toml_text(self.document if is_read else self._tables())
        if path is not None:
            write_text(require_path("path", path), text)
        return text

    def _tables(self) -> dict[str, object]:
        """Its tables, from the objects."""
        tables: dict[str, object] = {} if self.language == "en" else {"language": self.language}
        tables |= {name: dict(value) for name, value in (("project", self.project), ("design", self.trials)) if value}
        try:
            if list(self.mechanisms) == [""]:
                tables |= mechanism_table(self.mechanisms[""])
            else:
                named = self.mechanisms.items()
                tables["mechanisms"] = {name: mechanism_table(item, ("mechanisms", name)) for name, item in named}
            tables |= {"report": values_of(self.texts, report_maker().keys, ("report",))} if self.texts else {}
        except UnwrittenError as error:
            raise self._error(error.place, str(error)) from None
        reread = assessment_of(tables, folder=self.folder)
        for name, mechanism in () if reread == self else self.mechanisms.items():
            for part in (part.name for part in fields(mechanism) if part.compare):
                value, of_file = getattr(mechanism, part), getattr(reread.mechanisms[name], part)
                if value != of_file:
                    text = f"{name or 'mechanism'}: its {part} is {value!r:.300}; a file gives {of_file!r:.300}"
                    raise self._error((), text)
        return tables

    def _call(self, mechanism: Mechanism, call: Callable[[], Any]) -> Any:
        """What a function of a mechanism returns; its error names the table."""
        try:
            return call()
        except (TypeError, ValueError) as error:
            raise self._error(mechanism.place, caused(mechanism.place, error)) from None

    def _error(self, place: Place, message: str) -> AssessmentError:
        """An error at a table of the file."""
        return AssessmentError((Fault(place, message, line_of(place, self.source)),), self.name, self.language)


def place_of(text: str) -> Place:
    """A key as messages spell it, effects[0].diameter, as a place."""
    return tuple(int(number) if number else name for number, name in re.findall(r"\[(\d+)\]|([^.\[\]]+)", text))


def replaced(document: Document, place: Place, value: object) -> dict[str, Any]:
    """A copy of tables in which a key has another value.

    Raises:
        LookupError: for a place that they have not.
    """
    copied = copy.deepcopy(dict(document))
    table: Any = copied
    for part in place[:-1]:
        table = table[part]
    table[place[-1]] = value
    return copied


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
        return assessment_of_text(require_text("text", text, MOST_CHARACTERS))
    path = require_path("path", path)
    return assessment_of_text(read_text(path), str(path), path.parent)


def read_text(path: Path) -> str:
    """The text of a file.

    Raises:
        AssessmentError: for one that is too large or no text in UTF-8.
    """
    size = require_file(path).stat().st_size
    if size > 4 * MOST_CHARACTERS:
        large = Message("has {size} bytes; the valid range is 0 to {most}", size=size, most=4 * MOST_CHARACTERS)
        raise AssessmentError((Fault((), large),), str(path))
    return decoded(path.read_bytes(), str(path))


def decoded(data: bytes, name: str) -> str:
    """The text of a file in UTF-8, or in UTF-16 as PowerShell writes it.

    Raises:
        AssessmentError: for any other.
    """
    marked = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        return data.decode("utf-16" if marked else "utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        values = {"place": error.start + 1, "byte": data[error.start]}
        fault = Fault((), Message("is no text in UTF-8: byte {place} is 0x{byte:02x}", **values), line)
        raise AssessmentError((fault,), name) from None


def assessment_of_text(text: str, name: str = "", folder: Path | None = None) -> Assessment:
    """The assessment of a text in TOML, see `from_toml`."""
    try:
        document = parsed(text)
    except AssessmentError as error:
        raise AssessmentError(error.faults, name) from None
    return assessment_of(document, name, folder, text)


def assessment_of(
    document: Document, name: str = "", folder: Path | None = None, source: str = "", *, confined: bool = False
) -> Assessment:
    """The assessment of plain tables, as `tomllib` and a form make them.

    Args:
        document: the tables.
        name: of their file, for messages.
        folder: what paths in them are relative to; None reads no path.
        source: the text of their file, for the lines of messages.
        confined: whether a path that leads out of that folder is refused.

    Raises:
        AssessmentError: with all that is wrong.
    """
    reader = Reader(folder, source, name, confined=confined)
    top: Table = located(document)
    file_values: dict[str, Any] = {}
    for key in FILE_KEYS.keys() & top.values.keys():
        file_values[key] = reader.attempt(partial(reader.value, FILE_KEYS[key], top.values[key], (key,)))
    reader.language = file_values.get("language") or reader.language
    texts = reader.attempt(partial(_texts, reader, top)) or {}
    trials = reader.attempt(partial(_trials, reader, top, document))
    mechanisms = mechanisms_of(reader, top.without(*FILE_KEYS, "report", "design"))
    if not mechanisms and not reader.faults:
        reader.refusal((), "{place} has no mechanism; give it a table [wall], or several under [mechanisms.NAME]")
    reader.require_sound()
    details: dict[str, Any] = {"source": source, "folder": folder, "texts": texts, "trials": trials or {}}
    details["confined"] = confined
    return Assessment(mechanisms, name=name, document=document, **details, **file_values)


def _texts(reader: Reader, top: Table) -> dict[str, Any]:
    """What `[report]` has for the report."""
    return reader.arguments(reader.required_table(top, "report"), report_maker()) if "report" in top.values else {}


def _trials(reader: Reader, top: Table, document: Document) -> dict[str, Any]:
    """What `[design]` has: a key of the file, its values, and the method that counts."""
    if "design" not in top.values:
        return {}
    table = reader.required_table(top, "design")
    arguments = reader.arguments(table.without("values"), DESIGN)
    try:
        replaced(document, place_of(str(arguments["key"])), None)
    except (LookupError, TypeError):
        unknown = "{place} = {key!r} is no key of the file; spell it effects[0].diameter"
        reader.refusal(table.place_of("key"), unknown, key=arguments["key"])
    values = table.values.get("values")
    if not isinstance(values, list) or not values:
        reader.refusal(table.place_of("values"), "{place} is no list of at least one value of that key")
    return arguments | {"values": document["design"].get("values")}


@cache
def report_maker() -> Maker:
    """The keys of `[report]`."""
    from ..reporting.page import report

    left_out = "case", "responses", "path", "e", "contacts", "checks", "project", "language", "sections"
    return maker_of(report).without(*left_out)
