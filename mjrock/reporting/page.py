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
from ..study.loading.load_check import StaticAnswer
from ..study.loading.mechanism_curve import case_of
from . import content, inputs, pictures, verdicts
from .content import Content, content_of
from .drawings import DRAWN_APART
from .markup import Markup, element, listed, page, picture, table, write_pdf
from .parts import Part, drawings_of, is_of, parts_of
from .pictures import Run, by_variant
from .texts import DASH, FOUND, MINUS, Words, grouped
from .verdicts import REVERSED, Check, Mechanism, Subject, required_checks

TITLE_BLOCK_KEYS = ("project", "client", "author", "date", "place")
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
    governs, what the results do not cover, and what NTC 2018, 10.2, requires of a calculation by program. At the end
    stand the inputs with their units and what they rest on, every run, and the versions of the programs.

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
    require_kind("case", case, Case, MasonryCase, *DRAWN_APART)
    path = require_path("path", path)
    if path.suffix.lower() not in (".html", ".pdf"):
        raise ValueError(f"path = {(path.name or str(path))!r} does not end in .html or .pdf")
    words = Words(language)
    require_text("notes", notes, 100_000)
    case_name = words(f"kind_{verdicts.kind_of(case)}")
    mechanisms = required_checks(checks, case_name)
    runs = required_runs(Request(case, responses, labels, mechanisms, not (checks or sections)), words)
    parts = parts_of(case_name, case, mechanisms, runs)
    subject_kind = "several" if parts[1:] else verdicts.kind_of(parts[0].subjects[0].subject)
    heading = words(f"title_{subject_kind}") if title is None else require_text("title", title)
    named_subjects = inputs.named_subjects(case_name, case, mechanisms, runs)
    subjects = [subject for _, subject in named_subjects]
    input_groups = {
        words("seismic_action"): inputs.demand_groups(mechanisms, words),
        words("what_stands"): inputs.subject_groups(named_subjects, case_name, words),
        words("contacts"): contact_groups(case, e, contacts, runs, words),
    }
    input_keys = [row.key for groups in input_groups.values() for group in groups for row in group.rows]
    bases = required_texts("basis", basis, input_keys)
    drawings = [drawings_of(part, parts, words) for part in parts]
    tables = input_tables(subjects, path, words)
    project_texts = required_texts("project", project, TITLE_BLOCK_KEYS)
    pieces = [
        element("h1", heading),
        title_block(project_texts, words),
        *([element("p", element("b", words("question")), " ", notes)] if notes else []),
        *answer_section(parts, drawings, runs, mechanisms, words),
        *checks_section(parts, drawings, mechanisms, words),
        *runs_section(parts, words),
        *[piece for key, items in required_sections(sections).items() for piece in further_section(key, items, words)],
        *judgement_section(parts, runs, mechanisms, words, inputs.massless_load_names(subjects, words)),
        *input_section(input_groups, bases, words),
        *(piece for input_table in tables for piece in input_table_parts(input_table, words)),
        *run_tables(parts, words),
    ]
    text = page(words, heading, project_texts.get("project", ""), f"mjrock {__version__}", pieces)
    write = write_pdf if path.suffix.lower() == ".pdf" else write_text
    write(path, text)
    for input_table in tables:
        if input_table.file is not None:
            write_text(input_table.file, csv_text(input_table.listing.columns, input_table.listing.rows))
    return path


class Request(NamedTuple):
    """The request for a report, beside its checks.

    Args:
        case: the wall or masonry.
        responses, labels: as they are given.
        mechanisms: that are checked.
        needs_responses: whether neither checks nor sections are given.
    """

    case: Subject
    responses: object
    labels: object = None
    mechanisms: Sequence[Mechanism] = ()
    needs_responses: bool = False


def required_runs(request: Request, words: Words) -> list[Run]:
    """The runs of the responses, each of what the case or a mechanism is of.

    Raises:
        TypeError, ValueError: for others, or for none in a report without checks.
    """
    responses, labels = request.responses, request.labels
    if isinstance(responses, Mapping) and labels is not None:
        raise ValueError("labels are for a sequence of responses, and the names of a mapping are those of variants")
    variants, all_responses = list[str](), list[Response]()
    for variant, answer in (responses if isinstance(responses, Mapping) else {"": responses}).items():
        require_text("a name of responses", variant)
        name = f"responses[{variant!r}]" if variant else "responses"
        of_variant = [answer] if isinstance(answer, Response) else answer
        if not isinstance(of_variant, Sequence) or isinstance(of_variant, str):
            raise TypeError(f"{name} = {shown(answer)} is neither a Response nor a sequence of them")
        for i, response in enumerate(of_variant):
            require_kind(f"{name}[{i}]", response, Response)
            require_known_subject(f"{name}[{i}]", response, request)
        variants += [variant] * len(of_variant)
        all_responses += of_variant
    if not all_responses and request.needs_responses:
        raise ValueError("responses is empty; give at least one response, or checks, or sections")
    solvers = [response.solver for response in all_responses]
    records = record_names([response.case.motion for response in all_responses], words)
    differ_by_record = DASH not in records and len(set(solvers)) == 1
    named_by_record = isinstance(responses, Mapping) or (labels is None and differ_by_record and len(records) > 1)
    names = records if named_by_record else required_labels(all_responses, labels)
    if names is None or not (labels or named_by_record):
        names = [label_in_words(name, solver, words) for name, solver in zip(names or solvers, solvers, strict=True)]
    signals = signals_of([response.case for response in all_responses])
    largest = [content_of(response.case).largest_displacement(response) for response in all_responses]
    return [
        Run(response, variants[i], names[i], signals[i][0], records[i], largest[i])
        for i, response in enumerate(all_responses)
    ]


def record_names(motions: Sequence[GroundMotion | None], words: Words) -> list[str]:
    """What records are called: in words where no two are alike then, otherwise as they are."""
    names = [DASH if motion is None else motion.name.removesuffix(REVERSED) for motion in motions]
    in_words = {name: inputs.record_name(motion, words) for name, motion in zip(names, motions, strict=True) if motion}
    return names if len(set(in_words.values())) < len(in_words) else [in_words.get(name, name) for name in names]


def label_in_words(name: str, solver: str, words: Words) -> str:
    """A name that a response has by its solver, in words."""
    solver_name = words.or_else(f"short_{solver}", solver)
    return solver_name + name.removeprefix(solver).replace(REVERSED, f", {words('reversed')}")


def require_known_subject(name: str, response: Response, request: Request) -> None:
    """Raise a ValueError for a response of another wall or other masonry than the case and all checked mechanisms."""
    checked = [subject for mechanism in request.mechanisms for subject in mechanism.subjects]
    if not any(is_of(response.case, subject) for subject in (request.case, *checked)):
        known = list(dict.fromkeys(case_of(subject).description for subject in (request.case, *checked)))
        other = "other " if response.case.description in known else ""
        owners = "the case and the checked mechanisms" if checked else "the case"
        raise ValueError(f"{name} is of {response.case.description}, and {owners} of {other}{', '.join(known)}")


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
    return {require_text("a heading of sections", heading): items for heading, items in (sections or {}).items()}


def title_block(project: Mapping[str, str], words: Words) -> Markup:
    """Project, client, author, date and place, with room to write where one is not given."""
    cells = [cell for key in TITLE_BLOCK_KEYS for cell in (words(f"head_{key}"), project.get(key, ""))]
    return table((), [cells[i : i + 4] for i in range(0, len(cells), 4)], kind="block")


def answer_section(
    parts: Sequence[Part],
    drawings: Sequence[Sequence[Markup]],
    runs: Sequence[Run],
    mechanisms: Sequence[Mechanism],
    words: Words,
) -> list[Markup]:
    """The answer, and the first drawing of a report of one wall; several walls are drawn with their checks."""
    others = [named.subject for part in parts for named in part.subjects]
    answers = verdicts.answer_parts(mechanisms, others, words) if mechanisms else []
    codes = verdicts.codes_of(mechanisms, words.language)
    has_loads = any(mechanism.loads for mechanism in mechanisms)
    texts = verdicts.code_sentences(codes, "methods", words) if codes or has_loads else [words("no_check")]
    texts += [words("borne")] * has_loads + ([outcome_sentence(runs, words)] if runs else [])
    drawing = drawings[0][:1] if len(parts) == 1 else []
    sentences = [element("p", text) for text in texts]
    return [element("h2", words("answer")), *answers[:-1], *drawing, *answers[-1:], *sentences]


def outcome_sentence(runs: Sequence[Run], words: Words) -> str:
    """How many runs of each variant overturn."""
    counts = []
    for variant, runs_of_variant in by_variant(runs).items():
        count = sum(run.largest == math.inf for run in runs_of_variant)
        counts.append(words("runs_overturn", name=variant or words("all_runs"), count=count, of=len(runs_of_variant)))
    return f"{words('falls')} {'; '.join(counts)}."


def checks_section(
    parts: Sequence[Part], drawings: Sequence[Sequence[Markup]], mechanisms: Sequence[Mechanism], words: Words
) -> list[Markup]:
    """The checks, of each wall with its drawings, its curves and its steps."""
    pieces: list[Markup] = []
    several, kinematic = len(parts) > 1, any(mechanism.kinematic for mechanism in mechanisms)
    drawings = [drawings_of_part[not several :] for drawings_of_part in drawings]
    if any(drawings) or kinematic:
        codes = verdicts.codes_of([mechanism._replace(dynamic=()) for mechanism in mechanisms], words.language)
        pieces += [element("h2", words("checks" if kinematic else "drawings"))]
        pieces += [element("p", text) for text in verdicts.code_sentences(codes, "kinematic", words)]
    for part, drawing in zip(parts, drawings, strict=True):
        pieces += [*[element("h3", part.names)] * several, *drawing, *curves_and_steps(part.mechanisms, words)]
    if loaded := [(mechanism.name, check.result) for mechanism in mechanisms for check in mechanism.loads]:
        pieces.append(element("h2", words("loaded")))
        pieces += [piece for name, result in loaded for piece in static_answer_parts(name, result, words)]
    if dynamic := verdicts.dynamic_steps(mechanisms, words):
        codes = verdicts.codes_of([mechanism._replace(kinematic=None) for mechanism in mechanisms], words.language)
        texts = verdicts.code_sentences(codes, "dynamic", words)
        pieces += [element("h2", words("dynamic")), *(element("p", text) for text in texts), *dynamic]
    return pieces


def curves_and_steps(mechanisms: Sequence[Mechanism], words: Words) -> list[Markup]:
    """The curves of kinematic checks, and their steps; nothing where there are none."""
    figure = pictures.capacity_curves(mechanisms, words)
    if figure is None:
        return []
    checks = [(mechanism.name, mechanism.kinematic) for mechanism in mechanisms if mechanism.kinematic]
    ends = [(name, words.quantity(check.d_0, "m", FOUND)) for name, check in checks if check.ended]
    notes = [element("p", words("curve_cut", name=name, d=end)) for name, end in ends]
    return [picture(figure, words("curves_caption"), words), *notes, *verdicts.kinematic_steps(mechanisms, words)]


def runs_section(parts: Sequence[Part], words: Words) -> list[Markup]:
    """The runs as pictures, those of each wall for themselves; nothing without runs."""
    parts_with_runs = [part for part in parts if part.runs]
    pieces = [element("h2", words("runs"))] if parts_with_runs else []
    for part in parts_with_runs:
        pieces += [*[element("h3", part.run_names)] * (len(parts_with_runs) > 1), *pictures_of_runs(part, words)]
    return pieces


def pictures_of_runs(part: Part, words: Words) -> list[Markup]:
    """The runs of a wall or masonry as pictures."""
    part_content, runs, mechanisms = part.content, part.runs, part.mechanisms
    limits, limit = {}, part_content.limit_displacement()
    if limit is not None:
        limits[words("limit_d_0")] = limit
        for check in (check for mechanism in mechanisms for check in mechanism.dynamic):
            limits[words("limit_of_mean", state=check.limit_state)] = check.capacity
    sentences = content.solver_sentences([run.response for run in runs], words)
    pieces = [element("p", text) for text in sentences]
    figures = pictures.strips(runs, list(limits.items()), words(f"beyond_{part_content.KIND}"), words)
    pieces += [picture(figure, words(f"strip_{part_content.KIND}"), words) for figure in figures]
    figures = pictures.histories(runs, [part_content.displacement(run.response) for run in runs], limit, words)
    count = len({run.record for run in runs})
    caption = words("histories_caption", count=min(count, pictures.MOST_PANELS), of=count)
    pieces += [picture(figure, caption, words) for figure in figures]
    end_figure = part_content.end_drawing(runs, words)
    return pieces if end_figure is None else [*pieces, picture(end_figure, words("ends_caption"), words)]


def judgement_section(
    parts: Sequence[Part], runs: Sequence[Run], mechanisms: Sequence[Mechanism], words: Words, loads: Sequence[str]
) -> list[Markup]:
    """What governs, the limits of the results and of the loads, and the chapter of the code on programs."""
    pieces = []
    if mechanisms:
        motions = [(run.response.case.motion, run.motion) for run in runs]
        records = {motion.name.removesuffix(REVERSED): name for motion, name in motions if motion is not None}
        governing = verdicts.governing_table(verdicts.ranked(mechanisms), records, words)
        pieces += [element("h2", words("governing")), governing]
    if tie_sentences := content.broken_ties(runs, words):
        pieces.append(listed(tie_sentences))
    limits = [*verdicts.kinematic_limits(mechanisms, words)]
    limits += dict.fromkeys(text for part in parts for text in part.content.limitations(part.runs, words))
    limits += [words("limit_load", names=words.named(loads))] if loads else []
    pieces += [element("h2", words("limits")), listed(limits)]
    solvers = list(dict.fromkeys(run.response.solver for run in runs))
    analyses = [words("kinematic_analysis")] * any(mechanism.kinematic for mechanism in mechanisms)
    load_checks = [check for mechanism in mechanisms for check in mechanism.loads]
    analyses += dict.fromkeys(words(verdict.what) for check in load_checks for verdict in check.verdicts)
    analyses += [words.or_else(f"solver_{solver}", solver) for solver in solvers]
    codes = verdicts.codes_of(mechanisms, words.language) or [code_of()]
    heading = "; ".join(verdicts.code_sentences(codes, "program", words)) or words("program")
    pieces += [element("h2", heading), table((), content.program_chapter(analyses, words), kind="block")]
    pieces += hand_check_tables(parts, words)
    signature = element("p", words("ntc_judgement")), element("div", kind="sign"), element("p", words("sign"))
    return [*pieces, element("div", *signature, kind="whole")]


def hand_check_tables(parts: Sequence[Part], words: Words) -> list[Markup]:
    """Checks by hand of walls that overturn, a column each."""
    walls = [named for part in parts for named in part.subjects if verdicts.kind_of(named.subject) == "wall"]
    checks = grouped((name, content_of(wall).hand_check_rows(words)) for names, wall in walls for name in names)
    tables = []
    for start in range(0, len(checks), verdicts.COLUMNS_ABREAST):
        columns = checks[start : start + verdicts.COLUMNS_ABREAST]
        labels = [label for label, _ in columns[0][1]]
        values = [[value for _, value in rows] for _, rows in columns]
        heads = ("", *("; ".join(names) for names, _ in columns)) if checks[1:] else ()
        tables.append(table(heads, list(zip(labels, *values, strict=True)), right=range(1, 1 + len(columns))))
    return [element("p", words("hand"), kind="head"), *tables] if tables else []


def static_answer_parts(name: str, result: StaticAnswer, words: Words) -> list[Markup]:
    """What a static answer bears: its picture and its numbers."""
    figure = pictures.static_answer_figure(result, words)
    rows = [(words(key), value) for key, value in content.static_answer_rows(result, words)]
    return [*([] if figure is None else [picture(figure, name, words)]), table((), rows)]


def further_section(heading: str, items: object, words: Words) -> list[Markup]:
    """A section of the user: texts, figures and the tables of results.

    Raises:
        TypeError: for anything else.
    """
    pieces = [element("h2", heading)]
    for item in items if isinstance(items, list | tuple) else [items]:
        if isinstance(item, Figure):
            pieces.append(picture(item, heading, words, of_user=True))
        elif isinstance(item, str):
            pieces.append(element("p", item))
        elif isinstance(item, Design):
            pieces.append(picture(pictures.design_figure(item, words), words("design_caption"), words))
            pieces += verdicts.design_results(item, words)
        elif isinstance(item, StaticAnswer):
            pieces += static_answer_parts(heading, item, words)
        elif isinstance(item, Fragility):
            pieces.append(content.fragility_table({"": item}, words))
        elif isinstance(item, Mapping) and item and all(isinstance(fit, Fragility) for fit in item.values()):
            pieces.append(content.fragility_table(dict(item), words))
        elif callable(table_text := getattr(item, "table", None)):
            pieces += result_tables(table_text())
        else:
            raise TypeError(f"sections[{heading!r}] = {shown(item)} is not a text, a figure or a result with a table")
    return pieces


def result_tables(text: str) -> list[Markup]:
    """The table of a result, whose cells stand two spaces apart, and the sentences above and below it."""
    if "|" in text:  # a head of two levels
        return [element("div", element("pre", text), kind="wide")]
    lines = [re.split(r"\s{2,}", line.strip()) for line in text.splitlines()]
    pieces = []
    for in_columns, grouped_lines in groupby(lines, lambda cells: len(cells) > 1):
        rows = list(grouped_lines)
        width = max(map(len, rows))
        rows = [row + [""] * (width - len(row)) for row in rows]
        has_head = not re.search(r"\d", " ".join(rows[0]))
        head = rows[0] if has_head else ()
        pieces += [table(head, rows[has_head:])] if in_columns else [element("p", row[0]) for row in rows]
    return pieces


def contact_groups(
    case: Subject,
    e: Restitution | Mapping[str, Restitution] | None,
    contacts: Contacts | Mapping[str, Contacts] | None,
    runs: Sequence[Run],
    words: Words,
) -> list[inputs.InputGroup]:
    """Restitution and contacts, of all responses or of each variant.

    Raises:
        TypeError: for anything else.
    """
    cases = {run.variant: run.response.case for run in runs}
    e_of = dict(e) if isinstance(e, Mapping) else {"": e}
    contacts_of = dict(contacts) if isinstance(contacts, Mapping) else {"": contacts}
    for name, required, value_of in (("e", Restitution, e_of), ("contacts", Contacts, contacts_of)):
        for variant, value in value_of.items():
            require_kind(f"{name}[{variant!r}]" if variant else name, value, required, type(None))
            cases.get(variant, case_of(case)).require_own_joints(value)
    return [
        inputs.InputGroup(variant, inputs.contact_inputs(e_of.get(variant), contacts_of.get(variant), words))
        for variant in dict.fromkeys((*e_of, *contacts_of))
    ]


class InputTable(NamedTuple):
    """A table of inputs, and the file beside the page that has it where it is long."""

    listing: inputs.Listing
    file: Path | None


def input_tables(subjects: Sequence[Subject], path: Path, words: Words) -> list[InputTable]:
    """The tables of what a report is of, each once, in the page or in a file beside it."""
    tables: list[InputTable] = []
    for subject in subjects:
        rounded, exact = (inputs.listings(subject, words, written) for written in (words.number, "{:.12g}".format))
        for for_page, for_file in zip(rounded, exact, strict=True):
            listing = for_file if len(for_file.rows) > inputs.LONGEST_TABLE else for_page
            if any(other.listing == listing for other in tables):
                continue
            number = 1 + sum(other.listing.key == listing.key for other in tables)
            name = f"{path.stem}_{listing.key}{f'_{number}' if number > 1 else ''}.csv"
            tables.append(InputTable(listing, path.with_name(name) if listing is for_file else None))
    return tables


def input_table_parts(input_table: InputTable, words: Words) -> list[Markup]:
    """A table of inputs, or the name of the file that has it."""
    listing, file = input_table
    heading = element("p", element("b", listing.heading), kind="head")
    if file is not None:
        return [heading, element("p", words("in_a_file", count=len(listing.rows), file=file.name))]
    return [heading, table(listing.columns, listing.rows, kind="runs")]


def input_section(
    input_groups: Mapping[str, list[inputs.InputGroup]], bases: Mapping[str, str], words: Words
) -> list[Markup]:
    """The inputs and what they rest on."""
    pieces = [element("h2", words("inputs"))]
    for heading, groups in input_groups.items():
        for columns in inputs.side_by_side([group for group in groups if group.rows]):
            cells = []
            for row in columns.rows:
                known = next(cell for cell in row if cell is not None)
                basis = bases[known.key] if known.key in bases else element("td", words(known.basis), kind="short")
                cells.append((known.name, *spanned([DASH if cell is None else cell.value for cell in row]), basis))
            names = columns.names if any(columns.names) else [words("input_value")]
            table_class = "inputs" if len(names) == 1 else "beside"
            pieces.append(element("p", element("b", heading), kind="head"))
            pieces.append(table([words("input_name"), *names, words("input_basis")], cells, kind=table_class))
    return pieces


def spanned(values: Sequence[str]) -> Sequence[str]:
    """The cells of a row, or one that spans them all where they are alike."""
    if len(values) == 1 or len(set(values)) > 1:
        return values
    return [element("td", values[0], colspan=str(len(values)), kind="all")]


def run_tables(parts: Sequence[Part], words: Words) -> list[Markup]:
    """The records, and every run, those of each wall in a table."""
    runs = [run for part in parts for run in part.runs]
    if not runs:
        return []
    grounds, names = [run.response.case.grounds for run in runs], names_by_record(runs, words)
    pieces = []
    if names:
        keys = ("name", "direction", "peak", "peak_g", "duration", "step", "origin")
        heads = [words(f"motion_{key}") for key in keys]
        rows = content.motion_rows(grounds, names, words)
        pieces += [element("h2", words("motions")), table(heads, rows, right=(2, 3, 4, 5))]
    parts_with_runs = [part for part in parts if part.runs]
    pieces.append(element("h2", words("every_run")))
    for part in parts_with_runs:
        pieces += [element("h3", part.run_names)] * (len(parts_with_runs) > 1)
        pieces.append(run_table(part.content, part.runs, names, words))
    if forces := content.kept_force_rows(runs, words):
        heads = [words(f"forces_{key}") for key in ("run", "reaction", "normal", "joint")]
        pieces.append(table(heads, forces, right=(1, 2)))
    return pieces


def names_by_record(runs: Sequence[Run], words: Words) -> dict[str, str]:
    """What the records of runs are called, by their own names."""
    motions = [motion for run in runs for motion in run.response.case.grounds.values()]
    own_names = (motion.name.removesuffix(REVERSED) for motion in motions)
    return dict(zip(own_names, record_names(motions, words), strict=True))


def run_table(part_content: Content, runs: Sequence[Run], names: Mapping[str, str], words: Words) -> Markup:
    """The table of the runs of a wall or masonry, with what their records are called."""
    grounds = [run.response.case.grounds for run in runs]
    directions = [name for name in ("vertical", "transverse") if any(name in ground for ground in grounds)]
    variants, ties = any(run.variant for run in runs), any(run.response.ties for run in runs)
    columns = ["variant"] * variants + ["run", *directions, "polarity", *part_content.COLUMNS]
    columns += ["force", "drawn", "broke"] * ties
    rows = list[list[str]]()
    for run, ground in zip(runs, grounds, strict=True):
        others = [names[ground[name].name.removesuffix(REVERSED)] if name in ground else DASH for name in directions]
        cells = [run.variant] * variants + [run.label, *others, MINUS if run.is_reversed else "+"]
        cells += part_content.result_cells(run.response, words)
        rows.append([*cells, *(content.tie_cells(run.response, words) if ties else [])])
    heads = [words(f"run_{key}") for key in columns]
    left = ("variant", "run", *directions, "polarity", "outcome", "fallen")
    right = [i for i, name in enumerate(columns) if name not in left]
    return table(heads, rows, right=right, kind="runs")
