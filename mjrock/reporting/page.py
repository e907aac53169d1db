"""A report as one page that needs no other file: HTML with its pictures inside, or the same as PDF."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from matplotlib.figure import Figure

from .._version import __version__
from ..contacts.files import csv_text, write_text
from ..plotting.histories import required_labels
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.ground.motion import GroundMotion
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.bending import HorizontalBending, VerticalBending
from ..problem.wall.case import Case
from ..problem.wall.wedge import Corner
from ..quantities import require_kind, require_path, require_text, shown
from ..result.response import Response
from ..study.intensity.fragility import Fragility
from ..study.loading.code import code_of
from ..study.loading.design import Design
from ..study.loading.dynamic_check import signals_of
from ..study.loading.load_check import Borne
from ..study.loading.mechanism_curve import case_of
from . import content, inputs, verdicts
from .content import Content, content_of
from .drawings import OTHERS
from .markup import Markup, element, listed, page, picture, table, write_pdf
from .parts import Part, drawings_of, is_of, parts_of
from .pictures import PANELS, Run, borne_drawn, by_variant, capacity_curves, design_drawn, histories, strips
from .texts import DASH, FOUND, MINUS, Words, grouped
from .verdicts import REVERSED, Check, Mechanism, Subject, required_checks

HEADS = ("project", "client", "author", "date", "place")
"""What the title block has a place for."""
Responses = Response | Sequence[Response] | Mapping[str, Response | Sequence[Response]]


def report(
    case: AnyCase | Corner | VerticalBending | HorizontalBending,
    responses: Responses,
    path: str | Path,
    *,
    title: str | None = None,
    labels: Sequence[str] | None = None,
    e: Restitution | Mapping[str, Restitution] | None = None,
    contacts: Contacts | Mapping[str, Contacts] | None = None,
    checks: Check | Sequence[Check] | Mapping[str, Check | Sequence[Check]] | None = None,
    project: Mapping[str, str] | None = None,
    language: str = "en",
    basis: Mapping[str, str] | None = None,
    notes: str = "",
    sections: Mapping[str, object] | None = None,
) -> Path:
    """Write a report of a case, its checks and its responses: a page of HTML that needs no other file, or a PDF.

    The first page answers: a title block, the question, what holds and what fails with demand, capacity and ratio, and
    a drawing with hinge and effects. Then come the checks step by step with their formulae, the dynamic runs, what
    governs, what the results do not say, and what NTC 2018, 10.2, asks of a calculation by program. At the end stand
    the inputs with their units and what they rest on, every run, and the versions of the programs.

    Args:
        case: the wall or masonry and its effects, for the drawing and the inputs; or the corner or the wall that bends
            that is checked.
        responses: of walls of this size or of this masonry, by any solver, under any motions. A mapping gives those of
            each variant, such as a wall without ties and with them, or of each mechanism by its name in `checks`. An
            empty `()` for a report of checks alone.
        path: where to, an .html, or a .pdf, which WeasyPrint makes.
        title: of the page; None is that of the language.
        labels: what each response is called, one for each; variants need none.
        e, contacts: what the responses were computed with, for the inputs, or a mapping of those of each variant.
        checks: of `mechanism_check`, `dynamic_check` and `load_check`, by the names of their mechanisms or variants:
            one or several of each, at most one of them kinematic. Those of several walls have a section each, with
            drawing, steps and curve.
        project: "project", "client", "author", "date" and "place" of the title block, which leaves room for what is not
            given.
        language: "en" or "it". Texts of yours stay as they are. `mjrock/reporting/texts.toml` has all others.
        basis: what inputs rest on, by their names in the program, such as {"density": "3 cores, 2024", "k_base": "E of
            the mortar 800 MPa, 30 mm"}.
        notes: the question, the building, and who requests it.
        sections: further sections, by their headings: each a text, a figure, a result of `collapse_multiplier`,
            `limit_curve`, `push`, `pushover` or `design`, one that has a table, as those of `sensitivity` and
            `compare`, a mapping of names to `Fragility` curves, or some of these.

    Returns:
        The path that was written.

    Raises:
        TypeError: for an argument of another type.
        ValueError: for another ending of the path, another language, no response, one of another wall or of other
            masonry, e or contacts of masonry, another number of labels, or a name in `basis` or `project` that the
            page does not have.
        ImportError: for a PDF without WeasyPrint.
    """
    require_kind("case", case, Case, MasonryCase, *OTHERS)
    path = require_path("path", path)
    if path.suffix.lower() not in (".html", ".pdf"):
        raise ValueError(f"path = {(path.name or str(path))!r} does not end in .html or .pdf")
    words = Words(language)
    require_text("notes", notes, 100_000)
    own = words(f"kind_{verdicts.kind_of(case)}")
    mechanisms = required_checks(checks, own)
    runs = required_runs(Request(case, responses, labels, mechanisms, not (checks or sections)), words)
    parts = parts_of(own, case, mechanisms, runs)
    kind = "several" if parts[1:] else verdicts.kind_of(parts[0].subjects[0].subject)
    head = words(f"title_{kind}") if title is None else require_text("title", title)
    subjects = inputs.subjects(own, case, mechanisms, runs)
    given = {
        words("seismic_action"): inputs.of_demands(mechanisms, words),
        words("what_stands"): inputs.of_subjects(subjects, own, words),
        words("contacts"): of_impacts(case, e, contacts, runs, words),
    }
    rests = required_texts("basis", basis, [row.key for some in given.values() for one in some for row in one.rows])
    drawings = [drawings_of(part, parts, words) for part in parts]
    lists = lists_of([one for _, one in subjects], path, words)
    block = required_texts("project", project, HEADS)
    pieces = [
        element("h1", head),
        title_block(block, words),
        *([element("p", element("b", words("question")), " ", notes)] if notes else []),
        *answer_section(parts, drawings, runs, mechanisms, words),
        *checks_section(parts, drawings, mechanisms, words),
        *runs_section(parts, words),
        *[piece for name, some in required_sections(sections).items() for piece in section(name, some, words)],
        *judgement_section(parts, runs, mechanisms, words, inputs.loads_in([one for _, one in subjects], words)),
        *appendix(given, rests, words),
        *(piece for one in lists for piece in input_table_parts(one, words)),
        *every_run(parts, words),
    ]
    text = page(words, head, block.get("project", ""), f"mjrock {__version__}", pieces)
    if path.suffix.lower() == ".pdf":
        write_pdf(path, text)
    else:
        write_text(path, text)
    for one in lists:
        if one.file is not None:
            write_text(one.file, csv_text(one.listing.columns, one.listing.rows))
    return path


class Request(NamedTuple):
    """The request for a report, beside its checks.

    Args:
        case: the wall or masonry.
        responses, labels: as they are given.
        mechanisms: that are checked.
        bare: whether neither checks nor sections are given, so that responses have to be.
    """

    case: Subject
    responses: object
    labels: object = None
    mechanisms: Sequence[Mechanism] = ()
    bare: bool = False


def required_runs(request: Request, words: Words) -> list[Run]:
    """The runs of the responses, each of what the case or a mechanism is of.

    Raises:
        TypeError, ValueError: for others, or for none in a report without checks.
    """
    responses, labels = request.responses, request.labels
    if isinstance(responses, Mapping) and labels is not None:
        raise ValueError("labels are for a sequence of responses, and the names of a mapping are those of variants")
    given: list[tuple[str, Response]] = []
    for variant, of in (responses if isinstance(responses, Mapping) else {"": responses}).items():
        require_text("a name of responses", variant)
        name = f"responses[{variant!r}]" if variant else "responses"
        several = [of] if isinstance(of, Response) else of
        if not isinstance(several, Sequence) or isinstance(several, str):
            raise TypeError(f"{name} = {shown(of)} is neither a Response nor a sequence of them")
        for i, response in enumerate(several):
            require_kind(f"{name}[{i}]", response, Response)
            require_same(f"{name}[{i}]", response, request)
        given += [(variant, response) for response in several]
    if not given and request.bare:
        raise ValueError("responses is empty; give at least one response, or checks, or sections")
    answers = [response for _, response in given]
    motions = [DASH if (motion := response.case.motion) is None else motion.name for response in answers]
    records = named_records([response.case.motion for response in answers], words)
    by_record = DASH not in records and len({response.solver for response in answers}) == 1
    alone = isinstance(responses, Mapping) or (labels is None and by_record and len(answers) > 1)
    names = records if alone else required_labels(answers, labels)
    if names is None or not (labels or alone):
        own = names or [response.solver for response in answers]
        names = [in_words(name, response.solver, words) for name, response in zip(own, answers, strict=True)]
    signals = signals_of([response.case for response in answers])
    largest = [content_of(response.case).largest(response) for response in answers]
    turned = [motion.endswith(REVERSED) for motion in motions]
    return [
        Run(response, variant, names[i], signals[i][0], records[i], turned[i], largest[i])
        for i, (variant, response) in enumerate(given)
    ]


def named_records(motions: Sequence[GroundMotion | None], words: Words) -> list[str]:
    """What records are called: in words where no two are alike then, otherwise as they are."""
    own = [DASH if motion is None else motion.name.removesuffix(REVERSED) for motion in motions]
    called = {name: inputs.record_name(motion, words) for name, motion in zip(own, motions, strict=True) if motion}
    return own if len(set(called.values())) < len(called) else [called.get(name, name) for name in own]


def in_words(name: str, solver: str, words: Words) -> str:
    """A name that a response has by its solver, in words."""
    known = words.or_else(f"short_{solver}", solver)
    return known + name.removeprefix(solver).replace(REVERSED, f", {words('reversed')}")


def require_same(name: str, response: Response, request: Request) -> None:
    """Raise a ValueError for a response of another wall or of other masonry than the case and what is checked."""
    subjects = [request.case, *(one for mechanism in request.mechanisms for one in mechanism.subjects)]
    if not any(is_of(response.case, subject) for subject in subjects):
        own, due = response.case.description, case_of(request.case).description
        other = "other " if own == due else ""
        raise ValueError(f"{name} is of {own}, and the case of {other}{due}")


def required_texts(name: str, given: object, known: Sequence[str]) -> dict[str, str]:
    """Texts by names that are known.

    Raises:
        TypeError: for no mapping of texts.
        ValueError: for a name that is unknown.
    """
    if not isinstance(given, Mapping | None):
        raise TypeError(f"{name} = {shown(given)} is not a mapping of names to texts")
    for key, text in (given or {}).items():
        if key not in known:
            raise ValueError(f"{name} has {key!r}, which is not one of {', '.join(dict.fromkeys(known))}")
        require_text(f"{name}[{key!r}]", text)
    return dict(given or {})


def required_sections(sections: object) -> dict[str, object]:
    """Further sections by their headings.

    Raises:
        TypeError: if they are not a mapping of texts.
    """
    if not isinstance(sections, Mapping | None):
        raise TypeError(f"sections = {shown(sections)} is not a mapping of headings to texts, figures and results")
    return {require_text("a heading of sections", name): pieces for name, pieces in (sections or {}).items()}


def title_block(block: Mapping[str, str], words: Words) -> Markup:
    """Project, client, author, date and place, with room to write where one is not given."""
    cells = [cell for name in HEADS for cell in (words(f"head_{name}"), block.get(name, ""))]
    return table((), [cells[i : i + 4] for i in range(0, len(cells), 4)], kind="block")


def answer_section(
    parts: Sequence[Part],
    drawings: Sequence[Sequence[Markup]],
    runs: Sequence[Run],
    mechanisms: Sequence[Mechanism],
    words: Words,
) -> list[Markup]:
    """The answer, and the first drawing of a report of one wall; several walls are drawn with their checks."""
    others = [one.subject for part in parts for one in part.subjects]
    found = verdicts.answers(mechanisms, others, words) if mechanisms else []
    codes = verdicts.codes_of(mechanisms, words.language)
    borne = any(mechanism.loads for mechanism in mechanisms)
    methods = verdicts.sentences(codes, "methods", words) if codes or borne else [words("no_check")]
    methods += [words("borne")] * borne
    texts = [*methods, *([outcomes(runs, words)] if runs else [])]
    drawing = drawings[0][:1] if len(parts) == 1 else []
    return [element("h2", words("answer")), *found[:-1], *drawing, *found[-1:], *(element("p", one) for one in texts)]


def outcomes(runs: Sequence[Run], words: Words) -> str:
    """How many runs of each variant overturn."""
    counts = []
    for variant, own in by_variant(runs).items():
        count = sum(run.largest == math.inf for run in own)
        counts.append(words("runs_overturn", name=variant or words("all_runs"), count=count, of=len(own)))
    return f"{words('falls')} {'; '.join(counts)}."


def checks_section(
    wholes: Sequence[Part], drawings: Sequence[Sequence[Markup]], mechanisms: Sequence[Mechanism], words: Words
) -> list[Markup]:
    """The checks, of each wall with its drawings, its curves and its steps."""
    parts: list[Markup] = []
    several, kinematic = len(wholes) > 1, any(one.kinematic for one in mechanisms)
    drawings = [some[not several :] for some in drawings]
    if any(drawings) or kinematic:
        codes = verdicts.codes_of([one._replace(dynamic=()) for one in mechanisms], words.language)
        parts += [element("h2", words("checks" if kinematic else "drawings"))]
        parts += [element("p", text) for text in verdicts.sentences(codes, "kinematic", words)]
    for one, drawing in zip(wholes, drawings, strict=True):
        parts += [*[element("h3", one.names)] * several, *drawing, *curves_and_steps(one.mechanisms, words)]
    if loaded := [(one.name, check.result) for one in mechanisms for check in one.loads]:
        parts.append(element("h2", words("loaded")))
        parts += [part for name, result in loaded for part in of_borne(name, result, words)]
    if dynamic := verdicts.dynamic_steps(mechanisms, words):
        codes = verdicts.codes_of([one._replace(kinematic=None) for one in mechanisms], words.language)
        texts = verdicts.sentences(codes, "dynamic", words)
        parts += [element("h2", words("dynamic")), *(element("p", one) for one in texts), *dynamic]
    return parts


def curves_and_steps(mechanisms: Sequence[Mechanism], words: Words) -> list[Markup]:
    """The curves of kinematic checks, and their steps; nothing where there are none."""
    figure = capacity_curves(mechanisms, words)
    if figure is None:
        return []
    cut = [(one.name, one.kinematic.d_0) for one in mechanisms if one.kinematic and one.kinematic.ended]
    notes = [element("p", words("curve_cut", name=name, d=words.quantity(d, "m", FOUND))) for name, d in cut]
    return [picture(figure, words("curves_caption"), words), *notes, *verdicts.kinematic_steps(mechanisms, words)]


def runs_section(parts: Sequence[Part], words: Words) -> list[Markup]:
    """The runs as pictures, those of each wall for themselves; nothing without runs."""
    moved = [part for part in parts if part.runs]
    found = [element("h2", words("runs"))] if moved else []
    for part in moved:
        found += [*[element("h3", part.names_run)] * (len(moved) > 1), *pictures_of_runs(part, words)]
    return found


def pictures_of_runs(part: Part, words: Words) -> list[Markup]:
    """The runs of a wall or masonry as pictures."""
    whole, runs, mechanisms = part.whole, part.runs, part.mechanisms
    limits, limit = {}, whole.limit()
    if limit is not None:
        limits[words("limit_d_0")] = limit
        for check in (check for mechanism in mechanisms for check in mechanism.dynamic):
            limits[words("limit_of_mean", state=check.limit_state)] = check.capacity
    solved = content.solved_with([run.response for run in runs], words)
    found = [element("p", text) for text in solved]
    drawings = strips(runs, list(limits.items()), words(f"beyond_{whole.KIND}"), words)
    found += [picture(drawing, words(f"strip_{whole.KIND}"), words) for drawing in drawings]
    drawings = histories(runs, [whole.moved(run.response) for run in runs], limit, words)
    count = len({run.record for run in runs})
    caption = words("histories_caption", count=min(count, PANELS), of=count)
    found += [picture(drawing, caption, words) for drawing in drawings]
    end = whole.at_end(runs, words)
    return found if end is None else [*found, picture(end, words("ends_caption"), words)]


def judgement_section(
    wholes: Sequence[Part], runs: Sequence[Run], mechanisms: Sequence[Mechanism], words: Words, loads: Sequence[str]
) -> list[Markup]:
    """What governs, the limits of the results and of the loads, and the chapter of the code on programs."""
    parts = []
    if mechanisms:
        motions = [(run.response.case.motion, run.motion) for run in runs]
        records = {motion.name.removesuffix(REVERSED): called for motion, called in motions if motion is not None}
        parts += [element("h2", words("governing")), verdicts.governing(verdicts.ranked(mechanisms), records, words)]
    if broken := content.broken_ties(runs, words):
        parts.append(listed(broken))
    limits = [*verdicts.limits(mechanisms, words)]
    limits += dict.fromkeys(text for part in wholes for text in part.whole.limits(part.runs, words))
    limits += [words("limit_load", names=words.named(loads))] if loads else []
    parts += [element("h2", words("limits")), listed(limits)]
    solvers = list(dict.fromkeys(run.response.solver for run in runs))
    used = [words("kinematic_analysis")] * any(mechanism.kinematic for mechanism in mechanisms)
    used += dict.fromkeys(words(one.what) for each in mechanisms for check in each.loads for one in check.verdicts)
    used += [words.or_else(f"solver_{solver}", solver) for solver in solvers]
    codes = verdicts.codes_of(mechanisms, words.language) or [code_of()]
    heading = "; ".join(verdicts.sentences(codes, "program", words)) or words("program")
    parts += [element("h2", heading), table((), content.code_chapter(used, words), kind="block")]
    parts += by_hand(wholes, words)
    judgement = element("p", words("ntc_judgement")), element("div", kind="sign"), element("p", words("sign"))
    return [*parts, element("div", *judgement, kind="whole")]


def by_hand(parts: Sequence[Part], words: Words) -> list[Markup]:
    """Checks by hand of walls that overturn, a column each."""
    walls = [one for part in parts for one in part.subjects if verdicts.kind_of(one.subject) == "wall"]
    found = grouped((name, content_of(wall).by_hand(words)) for names, wall in walls for name in names)
    made = []
    for start in range(0, len(found), verdicts.ABREAST):
        some = found[start : start + verdicts.ABREAST]
        rows = [(one[0][0], *(value for _, value in one)) for one in zip(*(rows for _, rows in some), strict=True)]
        heads = ("", *("; ".join(names) for names, _ in some)) if found[1:] else ()
        made.append(table(heads, rows, right=range(1, 1 + len(some))))
    return [element("p", words("hand"), kind="head"), *made] if made else []


def of_borne(name: str, result: Borne, words: Words) -> list[Markup]:
    """What a static answer bears: its picture and its numbers."""
    figure = borne_drawn(result, words)
    rows = [(words(key), value) for key, value in content.of_borne(result, words)]
    return [*([] if figure is None else [picture(figure, name, words)]), table((), rows)]


def section(name: str, pieces: object, words: Words) -> list[Markup]:
    """A section: texts, figures and the tables of results.

    Raises:
        TypeError: for anything else.
    """
    parts = [element("h2", name)]
    for piece in pieces if isinstance(pieces, list | tuple) else [pieces]:
        if isinstance(piece, Figure):
            parts.append(picture(piece, name, words, own=True))
        elif isinstance(piece, str):
            parts.append(element("p", piece))
        elif isinstance(piece, Design):
            parts.append(picture(design_drawn(piece, words), words("design_caption"), words))
            parts += verdicts.design_results(piece, words)
        elif isinstance(piece, Borne):
            parts += of_borne(name, piece, words)
        elif isinstance(piece, Fragility):
            parts.append(content.of_fragility({"": piece}, words))
        elif isinstance(piece, Mapping) and piece and all(isinstance(one, Fragility) for one in piece.values()):
            parts.append(content.of_fragility(dict(piece), words))
        elif callable(made := getattr(piece, "table", None)):
            parts += tables(made())
        else:
            raise TypeError(f"sections[{name!r}] = {shown(piece)} is not a text, a figure or a result with a table")
    return parts


def tables(text: str) -> list[Markup]:
    """The table of a result, whose cells stand two spaces apart, and the sentences above and below it."""
    if "|" in text:  # a head of two levels
        return [element("div", element("pre", text), kind="wide")]
    lines = [re.split(r"\s{2,}", line.strip()) for line in text.splitlines()]
    parts = []
    for several, some in groupby(lines, lambda cells: len(cells) > 1):
        rows = list(some)
        wide = max(map(len, rows))
        rows = [row + [""] * (wide - len(row)) for row in rows]
        head = several and not re.search(r"\d", " ".join(rows[0]))
        parts += [table(rows[0] if head else (), rows[head:])] if several else [element("p", row[0]) for row in rows]
    return parts


def of_impacts(
    case: Subject,
    e: Restitution | Mapping[str, Restitution] | None,
    contacts: Contacts | Mapping[str, Contacts] | None,
    runs: Sequence[Run],
    words: Words,
) -> list[inputs.Section]:
    """Restitution and contacts, of all responses or of each variant.

    Raises:
        TypeError: for anything else.
    """
    cases = {run.variant: run.response.case for run in runs}
    e_of = dict(e) if isinstance(e, Mapping) else {"": e}
    contacts_of = dict(contacts) if isinstance(contacts, Mapping) else {"": contacts}
    for name, kind, given in (("e", Restitution, e_of), ("contacts", Contacts, contacts_of)):
        for variant, own in given.items():
            require_kind(f"{name}[{variant!r}]" if variant else name, own, kind, type(None))
            cases.get(variant, case_of(case)).require_own_joints(own)
    variants = dict.fromkeys((*e_of, *contacts_of))
    return [inputs.Section(one, inputs.of_contacts(e_of.get(one), contacts_of.get(one), words)) for one in variants]


class InputTable(NamedTuple):
    """A table of inputs, and the file beside the page that has it where it is long."""

    listing: inputs.Listing
    file: Path | None


def lists_of(subjects: Sequence[Subject], path: Path, words: Words) -> list[InputTable]:
    """The tables of what a report is of, each once, in the page or in a file beside it."""
    found: list[InputTable] = []
    for one_of in subjects:
        both = (inputs.listings(one_of, words, written) for written in (words.number, "{:.12g}".format))
        for short, exact in zip(*both, strict=True):
            one = exact if len(exact.rows) > inputs.LISTED else short
            if any(other.listing == one for other in found):
                continue
            number = 1 + sum(other.listing.key == one.key for other in found)
            name = f"{path.stem}_{one.key}{f'_{number}' if number > 1 else ''}.csv"
            found.append(InputTable(one, path.with_name(name) if one is exact else None))
    return found


def input_table_parts(one: InputTable, words: Words) -> list[Markup]:
    """A table of inputs, or the name of the file that has it."""
    heading = element("p", element("b", one.listing.heading), kind="head")
    if one.file is not None:
        return [heading, element("p", words("in_a_file", count=len(one.listing.rows), file=one.file.name))]
    return [heading, table(one.listing.columns, one.listing.rows, kind="runs")]


def appendix(given: Mapping[str, Sequence[inputs.Section]], rests: Mapping[str, str], words: Words) -> list[Markup]:
    """The inputs and what they rest on."""
    parts = [element("h2", words("inputs"))]
    for heading, sections in given.items():
        for some in inputs.beside([section for section in sections if section.rows]):
            cells = []
            for row in some.rows:
                one = next(cell for cell in row if cell is not None)
                rest = rests[one.key] if one.key in rests else element("td", words(one.rests), kind="short")
                cells.append((one.name, *alike([DASH if cell is None else cell.value for cell in row]), rest))
            names = some.names if any(some.names) else [words("input_value")]
            kind = "inputs" if len(names) == 1 else "beside"
            parts.append(element("p", element("b", heading), kind="head"))
            parts.append(table([words("input_name"), *names, words("input_basis")], cells, kind=kind))
    return parts


def alike(values: Sequence[str]) -> Sequence[str]:
    """The cells of a row, or one that spans them all where they are alike."""
    if len(values) == 1 or len(set(values)) > 1:
        return values
    return [element("td", values[0], colspan=str(len(values)), kind="all")]


def every_run(parts: Sequence[Part], words: Words) -> list[Markup]:
    """The records, and every run, those of each wall in a table."""
    runs = [run for part in parts for run in part.runs]
    if not runs:
        return []
    grounds, called = [run.response.case.grounds for run in runs], records_called(runs, words)
    found = []
    if called:
        keys = ("name", "direction", "peak", "peak_g", "duration", "step", "origin")
        heads = [words(f"motion_{key}") for key in keys]
        rows = content.of_motions(grounds, called, words)
        found += [element("h2", words("motions")), table(heads, rows, right=(2, 3, 4, 5))]
    moved = [part for part in parts if part.runs]
    found.append(element("h2", words("every_run")))
    for part in moved:
        found += [*[element("h3", part.names_run)] * (len(moved) > 1), *runs_of(part.whole, part.runs, called, words)]
    if forces := content.forces_kept(runs, words):
        heads = [words(f"forces_{key}") for key in ("run", "reaction", "normal", "joint")]
        found.append(table(heads, forces, right=(1, 2)))
    return found


def records_called(runs: Sequence[Run], words: Words) -> dict[str, str]:
    """What the records of runs are called, by their own names."""
    motions = [motion for run in runs for motion in run.response.case.grounds.values()]
    own = (motion.name.removesuffix(REVERSED) for motion in motions)
    return dict(zip(own, named_records(motions, words), strict=True))


def runs_of(whole: Content, runs: Sequence[Run], called: Mapping[str, str], words: Words) -> list[Markup]:
    """The table of the runs of a wall or masonry, with what their records are called."""
    grounds = [run.response.case.grounds for run in runs]
    beside = [name for name in ("vertical", "transverse") if any(name in ground for ground in grounds)]
    variants, ties = any(run.variant for run in runs), any(run.response.ties for run in runs)
    columns = ["variant"] * variants + ["run", *beside, "polarity", *whole.COLUMNS] + ["force", "drawn", "broke"] * ties
    rows = list[list[str]]()
    for run, ground in zip(runs, grounds, strict=True):
        others = [called[ground[name].name.removesuffix(REVERSED)] if name in ground else DASH for name in beside]
        own = [run.variant] * variants + [run.label, *others, MINUS if run.turned else "+"]
        rows.append([*own, *whole.result(run.response, words), *(content.tied(run.response, words) if ties else [])])
    heads = [words(f"run_{key}") for key in columns]
    left = ("variant", "run", *beside, "polarity", "outcome", "fallen")
    right = [i for i, name in enumerate(columns) if name not in left]
    return [table(heads, rows, right=right, kind="runs")]
