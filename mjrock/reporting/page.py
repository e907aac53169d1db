"""A report as one page that needs no other file: HTML with its pictures inside, which prints to PDF."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure

from ..files import write_text
from ..plotting.histories import history, required_labels, same_ground
from ..problem.damping.contacts import Contacts
from ..problem.damping.restitution import Restitution
from ..problem.masonry.case import AnyCase, MasonryCase
from ..problem.wall.case import Case
from ..quantities import require_kind, require_path, require_text, shown
from ..result.response import Response
from . import content
from .subject import Reported, reported

LOOK = """
@page { size: A4; margin: 18mm 16mm }
body { font: 10.5pt/1.4 Georgia, serif; color: #222; max-width: 46em; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.6em; border-bottom: 2px solid #12406b; padding-bottom: .2em }
h2 { font-size: 1.15em; margin: 1.6em 0 .4em; color: #12406b; break-after: avoid }
table { border-collapse: collapse; width: 100%; font: .85em/1.35 Helvetica, Arial, sans-serif }
th, td { text-align: left; vertical-align: top; padding: .18em .5em; border-bottom: 1px solid #ddd }
th { border-bottom: 1px solid #888; font-weight: 600 }
tr, figure { break-inside: avoid }
thead { break-after: avoid }
tr:nth-child(-n+2) { break-before: avoid }
figure { margin: .6em 0; text-align: center }
figure img { max-width: 100% }
pre { font-size: .75em; white-space: pre-wrap; break-inside: avoid }
ul.cautions { background: #fdf3e7; border-left: 4px solid #e07b2a; padding: .6em 1em .6em 2em }
footer { margin-top: 2em; font-size: .8em; color: #666 }
"""


def report(
    case: AnyCase,
    responses: Response | Sequence[Response],
    path: str | Path,
    *,
    title: str = "Rocking of a wall",
    labels: Sequence[str] | None = None,
    e: Restitution | None = None,
    contacts: Contacts | None = None,
    basis: Mapping[str, str] | None = None,
    notes: str = "",
    sections: Mapping[str, object] | None = None,
) -> Path:
    """Write a report of a case and its responses: one HTML page that needs no other file and prints to PDF.

    It has a sketch with dimensions, the inputs with their units and what they rest on, what to be careful of, the
    histories with the forces of the ties, a table of the results and the versions of the programs. Of masonry it has
    pictures of the blocks at rest and as each response ends.

    Args:
        case: the wall or masonry and its effects, for the sketch and the inputs.
        responses: of walls of this size or of this masonry, by any solver, under any motions. Those under one motion
            share a picture.
        path: where to, an .html.
        title: of the page.
        labels: what each response is called, one for each.
        e, contacts: what the responses were computed with, for the inputs.
        basis: what inputs rest on, by the name that the page gives them, such as {"density": "3 cores, 2024", "k_base":
            "E of the mortar 800 MPa, 30 mm"}.
        notes: a paragraph that stands first: the question, the building, who asked.
        sections: further sections after the results, by their headings: each a text, a figure, a result that has a
            table, as those of `mechanism_check`, `sensitivity`, `fit_fragility` and `compare` have, or some of these.

    Returns:
        The path that was written.

    Raises:
        TypeError: for an argument of another type.
        ValueError: for another ending of the path, no response, one of another wall or of other masonry, e or contacts
            of masonry, another number of labels, or a basis of an input that the page does not have.
    """
    require_kind("case", case, Case, MasonryCase)
    path = require_path("path", path)
    if path.suffix.lower() != ".html":
        raise ValueError(f"path = {(path.name or str(path))!r} does not end in .html")
    require_text("title", title)
    require_text("notes", notes, 100_000)
    require_kind("e", e, Restitution, type(None))
    require_kind("contacts", contacts, Contacts, type(None))
    several = required_responses(case, responses)
    names = required_labels(several, labels) or [response.solver for response in several]
    case.require_own_joints(e, contacts)
    subject = reported(case)
    inputs = {
        subject.NAME: subject.inputs(),
        "Effects": content.of_effects(case),
        "Impacts and contacts": content.of_contacts(e, contacts),
    }
    further = [part for name, pieces in required_sections(sections).items() for part in section(name, pieces)]
    rests = required_basis(basis, {row[0] for rows in inputs.values() for row in rows})
    head = [f"<h1>{html.escape(title)}</h1>", *([f"<p>{html.escape(notes)}</p>"] if notes else [])]
    parts = [*head, heading(f"The {subject.NAME.lower()}"), picture(*subject.at_rest())]
    parts += [heading("What to be careful of"), listed(subject.cautions(several, names))]
    parts += [heading("Results"), results(subject, several, names), *histories(subject, several, names), *further]
    for name, rows in inputs.items():
        if rows:
            found = [(key, value, rests.get(key, "")) for key, value in rows]
            parts += [heading(f"Inputs: {name.lower()}"), table(("quantity", "value", "basis"), found)]
    motions = content.of_motions(several)
    if motions:
        parts += [heading("Inputs: ground motions"), table(("direction", "name", "peak, duration, step"), motions)]
    parts += [heading("Versions"), table(("program", "version"), content.versions())]
    parts.append(f"<footer>{subject.RIGID} SI units; rotations in radians.</footer>")
    write_text(path, page(title, parts))
    return path


def required_responses(case: AnyCase, responses: object) -> list[Response]:
    """At least one response, each of the wall or masonry of the case; TypeError or ValueError for any other."""
    given = [responses] if isinstance(responses, Response) else responses
    if not isinstance(given, Sequence) or isinstance(given, str):
        raise TypeError(f"responses = {shown(responses)} is neither a Response nor a sequence of them")
    if not given:
        raise ValueError("responses is empty; at least one response is needed")
    for i, response in enumerate(given):
        require_kind(f"responses[{i}]", response, Response)
        if response.case.built != case.built:
            own, asked = response.case.said, case.said
            other = "other " if own == asked else ""
            raise ValueError(f"responses[{i}] is of {own}, and the case of {other}{asked}")
    return list(given)


def required_basis(basis: object, known: set[str]) -> dict[str, str]:
    """What inputs rest on, by their names; TypeError for no mapping of texts, ValueError for a name that is unknown."""
    if basis is None:
        return {}
    if not isinstance(basis, Mapping):
        raise TypeError(f"basis = {shown(basis)} is not a mapping of names to texts")
    for name, text in basis.items():
        if name not in known:
            raise ValueError(f"basis has {name!r}, which is not one of {', '.join(sorted(known))}")
        require_text(f"basis[{name!r}]", text)
    return dict(basis)


def required_sections(sections: object) -> dict[str, object]:
    """Further sections by their headings; TypeError if they are not a mapping of texts."""
    if not isinstance(sections, Mapping | None):
        raise TypeError(f"sections = {shown(sections)} is not a mapping of headings to texts, figures and results")
    return {require_text("a heading of sections", name): pieces for name, pieces in (sections or {}).items()}


def section(name: str, pieces: object) -> list[str]:
    """A section: texts, figures and the tables of results; TypeError for anything else."""
    parts = [heading(name)]
    for piece in pieces if isinstance(pieces, list | tuple) else [pieces]:
        if isinstance(piece, Figure):
            parts.append(picture(piece, name))
        elif isinstance(piece, str):
            parts.append(f"<p>{html.escape(piece)}</p>")
        elif callable(made := getattr(piece, "table", None)):
            parts.append(f"<pre>{html.escape(made())}</pre>")
        else:
            raise TypeError(f"sections[{name!r}] = {shown(piece)} is not a text, a figure or a result with a table")
    return parts


def results(subject: Reported, responses: Sequence[Response], names: Sequence[str]) -> str:
    """The tables of results, of ties, of forces that were kept, and the messages."""
    columns, rows = subject.COLUMNS, subject.results(responses, names)
    shared, own = content.settings(responses)
    made = f"<p>Solved with {html.escape(shared)}.</p>" if shared else ""
    if any(own):
        columns, rows = (*columns, "solved with"), [(*row, said) for row, said in zip(rows, own, strict=True)]
    made += table(columns, rows)
    ties = content.of_ties(responses, names)
    if ties:
        of_tie = "response", "tie", "largest force", "drawn out by", "energy taken", "broke at"
        made += "<p></p>" + table(of_tie, ties)
    forces = content.of_forces(responses, names)
    if forces:
        made += "<p></p>" + table(("response", "largest reaction", "largest force of a joint", "of"), forces)
    return made + listed(content.of_messages(responses, names), "")


def histories(subject: Reported, responses: Sequence[Response], names: Sequence[str]) -> list[str]:
    """A picture for each ground motion."""
    left, made = list(zip(responses, names, strict=True)), []
    while left:
        first = left[0][0]
        own = [pair for pair in left if same_ground(first, pair[0])]
        left = [pair for pair in left if not same_ground(first, pair[0])]
        motion = first.case.motion
        over_time = history([response for response, _ in own], labels=[name for _, name in own])
        made.append(picture(over_time, "No ground motion." if motion is None else f"Ground motion: {motion.name}."))
    for response, name in zip(responses, names, strict=True):
        made += [picture(*end) for end in subject.at_end(response, name)]
    return made


def heading(text: str) -> str:
    """A heading."""
    return f"<h2>{html.escape(text)}</h2>"


def listed(texts: Sequence[str], kind: str = "cautions") -> str:
    """Texts as a list; a sentence where there are none."""
    if not texts:
        return "<p>No warnings.</p>"
    return f'<ul class="{kind}">' + "".join(f"<li>{html.escape(text)}</li>" for text in texts) + "</ul>"


def table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table."""
    head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
    lines = ("".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows)
    return f"<table><thead><tr>{head}</tr></thead>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"


def picture(figure: Figure, caption: str) -> str:
    """A figure inside the page."""
    file = BytesIO()
    figure.savefig(file, format="png", dpi=160, metadata={"Software": None})
    data, said = base64.b64encode(file.getvalue()).decode("ascii"), html.escape(caption)
    return f'<figure><img alt="{said}" src="data:image/png;base64,{data}"><figcaption>{said}</figcaption></figure>'


def page(title: str, parts: Sequence[str]) -> str:
    """The whole page."""
    body = "\n".join(parts)
    head = f'<meta charset="utf-8"><title>{html.escape(title)}</title><style>{LOOK}</style>'
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head>\n<body>\n{body}\n</body></html>\n'
