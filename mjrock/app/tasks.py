"""The tasks that the form requests: its plan, the verdict on its input, runs, and reports. Each answers in parts.

A request brings the whole input and the files that go with it. Nothing else is read, and nothing is written but in a
folder that goes with the request.
"""

from __future__ import annotations

import base64
import binascii
import contextlib
import math
import pickle
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from io import BytesIO
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from ..assessment.assessment import Assessment, assessment_of
from ..assessment.schema import whole_schema
from ..assessment.tables import AssessmentError, Document, Fault, parsed, spelt_place
from ..assessment.templates import seeds
from ..bars import Progress, progress_given_to
from ..plotting.browser import view
from ..quantities import Message, brief, reason, require_kind, shown
from ..reporting.content import content_of
from ..reporting.drawings import drawing_of
from ..reporting.markup import Markup, element
from ..reporting.page import Request, outcome_sentence, required_runs, run_tables
from ..reporting.parts import parts_of
from ..reporting.texts import FOUND, Words, languages
from ..reporting.verdicts import Mechanism, answer_parts, kinematic_steps, ranked, required_checks
from ..result.response import Response
from ..toml_text import toml_text
from .form import TEXTS, UPLOAD_FOLDER, Plan, languages_named, state_of, texts_of
from .worker import Item, Payload, Send, Task

MOST_FILES, LONGEST_NAME = 50, 200
"""Most files of a request, and most characters of the name of one."""

MESSAGE_INTERVAL = 0.15
"""Time between two messages on how far a run is [s]."""
MEDIA_TYPES = {".pdf": "application/pdf", ".html": "text/html", ".csv": "text/csv"}
"""Types of the files of a report."""


def words_of(language: object) -> Words:
    """The words of a language; English where it is none."""
    return Words(language if isinstance(language, str) and language in languages() else "en", TEXTS)


@cache
def plan_of(language: str) -> Plan:
    """The plan of the form in a language."""
    return Plan(whole_schema(), words_of(language))


def form(request: Payload, send: Send) -> None:
    """The plan of the form in a language, with its texts and templates."""
    words = words_of(request.get("language"))
    states = {name: state_of(template) for name, template in templates_of().items()}
    plan_parts = {
        "language": words.language,
        "languages": languages_named(words),
        "texts": texts_of(words),
        "templates": [(name, words.or_else(f"template_{name}", name)) for name in states],
        "states": states,
    }
    send(plan_of(words.language).as_json | plan_parts)


def templates_of() -> dict[str, dict[str, Any]]:
    """The tables of each template by its name, with an empty title block."""
    left_out = "title", "project"
    return {name: {key: value for key, value in seed.items() if key not in left_out} for name, seed in seeds().items()}


def open_file(request: Payload, send: Send) -> None:
    """The input of the form that stands for the text of a file, and what is wrong with that."""
    text: Any = request.get("text")
    with faults_sent(send, words_of(request.get("language")), TypeError):
        require_kind("text", text, str)
        send({"state": state_of(parsed(text))})


def save(request: Payload, send: Send) -> None:
    """The input as the text of a file, as it is, also where something is wrong with it."""
    with faults_sent(send, words_in(request), TypeError, ValueError):
        send({"name": "mjrock.toml", "text": toml_text(tables_in(request))})


def check(request: Payload, send: Send) -> None:
    """The verdict clause by clause, the steps, and the sketch; or what is wrong, with the place of each fault."""
    words = words_in(request)
    with Folder(request) as folder, faults_sent(send, words):
        assessment = folder.assessment()
        with faults_sent(send, words):
            checks = {
                name or kind_named(mechanism.problem, words): mechanism
                for name, mechanism in assessment.mechanisms.items()
            }
            mechanisms = required_checks(dict(zip(checks, assessment.check().values(), strict=True)), "")
            send(verdict(mechanisms, folder.notes(words), words))
        for part in sketch_parts(assessment, words):
            send(part)


def verdict(mechanisms: Sequence[Mechanism], notes: Sequence[Markup], words: Words) -> Item:
    """What holds clause by clause, what is doubtful, and the steps."""
    return {
        "verdict": "".join([*answer_parts(mechanisms, [], words), *notes]),
        "ratio": short_verdict(mechanisms, words),
        "steps": element("h2", words("checks")) + "".join(kinematic_steps(mechanisms, words)),
    }


def kind_named(problem: object, words: Words) -> str:
    """What a mechanism without a name is called."""
    return words(f"table_{type(problem).__name__}")


def short_verdict(mechanisms: Sequence[Mechanism], words: Words) -> str:
    """Whether the mechanism with the least ratio holds, in the word of its verdict, and that ratio."""
    first = ranked(mechanisms)[0]
    return f"{words(first.kind)} {words.ratio(first.least_verdict.ratio)}"


def sketch_parts(assessment: Assessment, words: Words) -> Iterator[Item]:
    """The drawing of each mechanism, with its name where there are several, and its number."""
    count = len(assessment.mechanisms)
    for number, (name, mechanism) in enumerate(assessment.mechanisms.items()):
        figure, caption = drawing_of(mechanism.problem, words)
        yield {"sketch": svg_of(figure), "alt": caption, "name": name, "number": number, "count": count}


def svg_of(figure: Figure) -> str:
    """A figure as the address of an image without a ground, with its words as text."""
    file = BytesIO()
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": "mjrock"}):
        figure.savefig(file, format="svg", metadata={"Date": None}, transparent=True)
    return f"data:image/svg+xml;base64,{base64.b64encode(file.getvalue()).decode()}"


class Sender:
    """Sends how far a run is, not too often.

    Args:
        send: to the page.
        words: of the page.
        count: of runs.
    """

    def __init__(self, send: Send, words: Words, count: int) -> None:
        self.send, self.words, self.count = send, words, count
        self.before, self.last = 0, -math.inf

    def __call__(self, progress: Progress) -> None:
        """Take how far the current run is."""
        now = time.monotonic()
        if now - self.last < MESSAGE_INTERVAL:
            return
        self.last = now
        part = progress.done / progress.total if progress.total else 0.0
        run = self.words("form_run_of", number=self.before + 1, count=self.count)
        text = f"{run}: {self.words.number(progress.done, FOUND)} / {self.words.number(progress.total or 0.0, FOUND)} s"
        self.send({"share": (self.before + part) / self.count, "what": text if progress.total else run})


def run(request: Payload, send: Send) -> None:
    """The runs of the input, how far they are, what comes of them, and the film of the one that goes farthest."""
    words = words_in(request)
    with Folder(request) as folder, faults_sent(send, words):
        assessment = folder.assessment()
        analyses = assessment.analyses()
        sender = Sender(send, words, sum(map(len, analyses.values())))
        responses: dict[str, list[Response]] = {}
        for name, runs in analyses.items():
            for analysis in runs:
                with progress_given_to(sender):
                    responses.setdefault(name, []).append(analysis.solve())
                sender.before += 1
        notes = folder.notes(words)
        parts = dynamic_answers(assessment, responses, words)
        parts += [part for name, of_mechanism in responses.items() for part in run_parts(name, of_mechanism, words)]
        send({"answers": "".join([*parts, *notes])})
        film = view(farthest_response(list(chain(*responses.values()))), folder.path / "film.html")
        send({"keep": {"film": film.read_bytes(), "responses": pickle.dumps(responses)}})


def dynamic_answers(assessment: Assessment, responses: Mapping[str, Sequence[Response]], words: Words) -> list[Markup]:
    """What holds by the runs under records; nothing of a release, and without a site."""
    try:
        checks = assessment.dynamic_check(responses)
    except AssessmentError:
        return []
    named = {name or kind_named(assessment.mechanisms[name].problem, words): check for name, check in checks.items()}
    return answer_parts(required_checks(named, ""), [], words)


def run_parts(name: str, responses: Sequence[Response], words: Words) -> list[Markup]:
    """How many of the runs of a mechanism overturn, and a table of them."""
    case = responses[0].case
    runs = required_runs(Request(case, responses), words)
    heading = [element("h3", name)] if name else []
    return [*heading, element("p", outcome_sentence(runs, words)), *run_tables(parts_of("", case, [], runs), words)]


def farthest_response(responses: Sequence[Response]) -> Response:
    """The response with the largest displacement."""
    return max(responses, key=lambda response: content_of(response.case).largest_displacement(response))


def report(request: Payload, send: Send) -> None:
    """The report in a language, with the runs that are kept: a PDF, or a page of HTML where WeasyPrint is missing."""
    words = words_of(request.get("language"))
    kept_responses = request.get("responses")
    with Folder(request) as folder, faults_sent(send, words):
        assessment = folder.assessment()
        runs = None if kept_responses is None else pickle.loads(kept_responses)
        written, note = folder.path / "written", ""
        written.mkdir()
        try:
            assessment.report(written / "mjrock.pdf", runs, language=words.language)
        except ImportError:
            note = words("form_no_pdf")
            assessment.report(written / "mjrock.html", runs, language=words.language)
        send({"documents": [document(path) for path in sorted(written.iterdir())], "note": note})


def document(path: Path) -> Item:
    """A file as the page takes it."""
    data = base64.b64encode(path.read_bytes()).decode()
    return {"name": path.name, "type": MEDIA_TYPES.get(path.suffix, "application/octet-stream"), "data": data}


def words_in(request: Payload) -> Words:
    """The words of the language of the input."""
    state = request.get("state")
    return words_of(state.get("language") if isinstance(state, Mapping) else None)


def tables_in(request: Payload) -> Document:
    """The tables of the file that the input of a request stands for."""
    state: Any = request.get("state")
    require_kind("state", state, dict)
    return plan_of("en").tables_of(state)


@contextlib.contextmanager
def faults_sent(send: Send, words: Words, *kinds: type[Exception]) -> Iterator[None]:
    """Send what is found wrong with the input in a `with` statement, with its place in the form, and end that.

    Args:
        send: to the page.
        words: of the page.
        kinds: of errors that are sent too, without a place.
    """
    try:
        yield
    except AssessmentError as error:
        faults = [fault._replace(message=words.message(fault.message)) for fault in error.faults]
        lines = [
            words("form_line", line=fault.line, message=fault.message) if fault.line else fault.message
            for fault in faults
        ]
        send(
            {
                "faults": [
                    {"place": list(fault.place), "message": line} for fault, line in zip(faults, lines, strict=True)
                ]
            }
        )
    except kinds as error:
        send({"faults": [{"place": [], "message": words.message(reason(error))}]})


class Folder:
    """The files of a request in a folder of their own, and what is warned of. Use it in a `with` statement.

    Args:
        request: with `files`, their content by name, as base64.

    Raises:
        TypeError, ValueError: for a name with a folder, for too many files, and for what is no base64.
    """

    def __init__(self, request: Payload) -> None:
        self.request, self.files = request, dict[str, bytes]()
        files = request.get("files") or {}
        require_kind("files", files, dict)
        if len(files) > MOST_FILES:
            raise ValueError(f"files has {len(files)} files; the valid range is 0 to {MOST_FILES}")
        for name, content in files.items():
            require_kind(f"files[{name!r}]", content, str)
            is_plain = name == Path(name).name and not {"\\", "\0"} & set(name)
            if not is_plain or name in ("", ".", "..") or len(name) > LONGEST_NAME:
                raise ValueError(f"files has {shown(name)}, which is no plain name of a file")
            try:
                self.files[name] = base64.b64decode(content, validate=True)
            except binascii.Error:
                raise ValueError(f"files[{name!r}] is no base64") from None

    def __enter__(self) -> Folder:
        self._contexts = contextlib.ExitStack()
        caught = self._contexts.enter_context(warnings.catch_warnings(record=True))
        self._caught = [] if caught is None else caught
        warnings.simplefilter("always")
        self.path = Path(self._contexts.enter_context(TemporaryDirectory()))
        for name, content in self.files.items():
            (self.path / name).write_bytes(content)
        return self

    def __exit__(self, *error: object) -> None:
        self._contexts.close()

    def notes(self, words: Words) -> list[Markup]:
        """What has been warned of so far, each once."""
        texts = [words.message(reason(note.message)) for note in self._caught if isinstance(note.message, Warning)]
        return [element("p", text, kind="note") for text in dict.fromkeys(texts)]

    def assessment(self) -> Assessment:
        """What the input stands for.

        Raises:
            AssessmentError: with all that is wrong, and for a path that is not that of a file of the request.
        """
        tables = tables_in(self.request)
        template = "{place} = {value} is no file that is uploaded; choose the file again"
        faults = [
            Fault(place, Message(template, place=spelt_place(place), value=brief(name)))
            for place, name in plan_of("en").files_in(tables)
            if name not in (*self.files, UPLOAD_FOLDER)
        ]
        if faults:
            raise AssessmentError(tuple(faults))
        return assessment_of(tables, folder=self.path, confined=True)


TASKS: dict[str, Task] = {"form": form, "open": open_file, "save": save, "check": check, "run": run, "report": report}
"""What the form may request, by name."""
