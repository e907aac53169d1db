"""`mjrock inspect model.xml`: the contacts of a MuJoCo model in N/m and N s/m.

The worst contacts come first, and equal notes are given once. A line has at most 80 columns where names are short."""

from __future__ import annotations

import argparse
import itertools
import math
import textwrap
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

import mujoco

from .checks import named, require_within
from .files import aligned, csv_text, write_text
from .geoms import BODY, GeomPair, geom_label, keyframe_argument, load, names_of_objects
from .inspect import InspectedContact, inspect_contacts, inspect_flexes
from .notes import VARYING_PARTS, model_caveats

NUMBERS = ("k [N/m]", "k loaded", "c [N s/m]", "mass [kg]", "row adds", "d", "points", "xi", "e", "e at v")
HEADER = ("geom", "geom", "by", *NUMBERS, "notes")
COLUMNS_OF_PAGE = [
    True,
    True,
    False,
    *(name in ("k [N/m]", "c [N s/m]", "mass [kg]", "points", "e") for name in NUMBERS),
    True,
]
"""Which columns a page has; `--all` and `--csv` give the others too."""
GAINS_NOTE, LONG, IMMOBILE = "it can gain energy", "is long for it", ("mass is infinite", "hardly move")
"""Parts of notes that put a contact first or last in the table."""


def has_names(both: GeomPair, geoms: Sequence[str], bodies: Sequence[str], pair: Sequence[str] | None) -> bool:
    """Whether two geoms have names that match, with the wildcards `*`, `?` and `[...]`.

    Args:
        both: the geoms.
        geoms, bodies: names of geoms and of bodies, of which it has at least one; none are all.
        pair: names of its two geoms or bodies, in any order; None are all.
    """
    sides = list(zip(both.labels, both.body_names, strict=True))
    if (geoms and not _fits(both.labels, geoms)) or (bodies and not _fits(both.body_names, bodies)):
        return False
    return pair is None or any(
        all(_fits(side, [pattern]) for side, pattern in zip(order, pair, strict=True)) for order in (sides, sides[::-1])
    )


def require_names(model: mujoco.MjModel, patterns: Sequence[str]) -> None:
    """Raise a ValueError with those names and patterns that no geom and no body of a model has."""
    geoms = [geom_label(model, geom) for geom in range(model.ngeom)]
    names = [*geoms, *(name or f"[{body}]" for body, name in enumerate(names_of_objects(model, BODY)))]
    unknown = [pattern for pattern in patterns if not _fits(names, [pattern])]
    if unknown:
        raise ValueError(f"the model has no geom or body {named(unknown)}; geoms are: {named(geoms)}")


def worst_first(found: Sequence[InspectedContact]) -> list[InspectedContact]:
    """Contacts that can gain energy, then those with a long step, then those with notes; immovable ones last."""

    def rank(contact: InspectedContact) -> tuple[float, ...]:
        notes = " ".join(contact.notes)
        immobile = any(part in notes for part in IMMOBILE)
        frequency = contact.frequency if contact.mass < math.inf else 0.0
        return immobile, GAINS_NOTE not in notes, LONG not in notes, not contact.notes, -frequency

    return sorted(found, key=rank)


def table_and_notes(found: Sequence[InspectedContact], *, speed: float = 1.0, most: int | None = None) -> str:
    """The table, and below it the notes that its last column numbers.

    Args:
        found: contacts from `inspect_contacts`.
        speed: speed of approach at which the column `e at v` counts gravity [m/s].
        most: contacts of which a page has the main columns, those alike in one row; None shows all rows and columns.
    """
    speed = require_within("speed", speed, 1e-9, 1e9, "m/s")
    if not found:
        return "This model has no contact of two geoms that can act."
    shown = found if most is None else found[:most]
    alike: dict[str, list[str]] = {}
    for contact in found:
        for note in contact.notes:
            alike.setdefault(VARYING_PARTS.sub("#", note), []).append(note)
    numbers = {key: number for number, key in enumerate(alike, 1)}
    rows = []
    for contact in shown:
        marks = sorted({numbers[VARYING_PARTS.sub("#", note)] for note in contact.notes})
        rows.append([*values(contact, speed), ",".join(str(mark) for mark in marks)])
    head, *body = aligned([list(HEADER), *rows] if most is None else rows_of_page([list(HEADER), *rows]))
    lines = [head, "-" * len(head), *body]
    if most is not None:
        unshown = f"and {len(found) - len(shown)} more; " if len(shown) < len(found) else ""
        lines.append(f"{unshown}--all shows all rows and columns; --geom, --body and --pair choose")
    else:
        lines.append(f"v is {speed:g} m/s. k loaded carries the static load: that of the pose, or --load.")
    for number, (first, *others) in enumerate(alike.values(), 1):
        lines += textwrap.wrap(f"{number}: {first}" + (f" [and {len(others)} like it]" if others else ""), 80)
    return "\n".join(lines)


def rows_of_page(rows: Sequence[Sequence[str]]) -> list[list[str]]:
    """Rows with the columns of a page. Those that differ in their second geom alone are one, with their number."""
    columns = [list(itertools.compress(row, COLUMNS_OF_PAGE)) for row in rows]
    groups: dict[tuple[str, ...], list[list[str]]] = {}
    for row in columns:
        groups.setdefault((row[0], *row[2:]), []).append(row)
    return [
        [first[0], first[1] + (f" and {len(others)} like it" if others else ""), *first[2:]]
        for first, *others in groups.values()
    ]


def values(contact: InspectedContact, speed: float) -> list[str]:
    """The numbers of a contact as text, in the order of HEADER."""
    mass = "inf" if contact.mass == math.inf else f"{contact.mass:.4g}"
    losses = contact.xi, contact.restitution, contact.restitution_at(speed)
    return [
        contact.geom1,
        contact.geom2,
        "pair" if contact.explicit else "geoms",
        f"{contact.k:.4g}",
        f"{contact.k_loaded:.4g}",
        f"{contact.c:.4g}",
        mass,
        f"{contact.inertia:.4g}",
        f"{contact.impedance:.4g}",
        str(contact.points),
        *("-" if math.isnan(contact.xi) else f"{value:.3f}" for value in losses),
    ]


def flex_report(model: mujoco.MjModel) -> str:
    """A line for each flex and geom that can meet, and what the options of the model do; empty without any."""
    contacts = [str(contact) for contact in inspect_flexes(model)]
    if not contacts:
        return ""
    remarks = [f"For all of them: {sentence}." for sentence in model_caveats(model)]
    return "\n".join(["", "Contacts of flexes, at zero penetration:", *contacts, *remarks])


def _fits(names: Sequence[str], patterns: Sequence[str]) -> bool:
    """Whether one of the names matches one of the patterns."""
    return any(name == pattern or fnmatchcase(name, pattern) for name in names for pattern in patterns)


PAGE = 40
"""Rows that fill a page."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to a parser."""
    parser.add_argument("model", type=Path, help="MJCF or URDF file, or a compiled .mjb")
    parser.add_argument("--geom", action="append", default=[], help="contacts of a geom, such as 'foot*'")
    parser.add_argument("--body", action="append", default=[], help="contacts of a body")
    parser.add_argument("--pair", nargs=2, metavar=("A", "B"), help="contacts of two geoms or bodies")
    parser.add_argument("--pairs", action="store_true", help="explicit pairs only")
    parser.add_argument("--contacts", type=int, help="points that share the mass, instead of those counted")
    parser.add_argument("--keyframe", help="keyframe in which the geoms meet, by name or number")
    parser.add_argument("--load", type=float, help="static load of a contact point [N], instead of the weight")
    parser.add_argument("--speed", type=float, default=1.0, help="speed of approach of the last e of --all [m/s]")
    parser.add_argument("--all", action="store_true", help=f"every row and column, not the worst {PAGE}")
    parser.add_argument("--csv", type=Path, help="a file for every row that is chosen, with its notes")


def answer(args: argparse.Namespace) -> str:
    """The table of the model that is named; the rows are also written where --csv says.

    Raises:
        ValueError, TypeError, OSError: for what the user can mend.
    """
    if not args.model.is_file():
        raise FileNotFoundError(f"model {args.model} is not a file")
    keyframe = keyframe_argument(args.keyframe)
    model = load(args.model)
    require_names(model, [*args.geom, *args.body, *(args.pair or ())])
    contacts = inspect_contacts(
        model,
        candidates=not args.pairs,
        contacts=args.contacts,
        keyframe=keyframe,
        load=args.load,
        chosen=lambda pair: has_names(pair, args.geom, args.body, args.pair),
    )
    chosen = worst_first(contacts)
    if args.csv is not None:
        header = ["geom1", "geom2", *HEADER[2:]]
        rows = [[*values(contact, args.speed), "; ".join(contact.notes)] for contact in chosen]
        write_text(args.csv, csv_text(header, rows))
    flexes = flex_report(model)
    if not chosen and (args.geom or args.body or args.pair):
        return "No contact of this model is of these geoms, bodies or pairs." + flexes
    return table_and_notes(chosen, speed=args.speed, most=None if args.all else PAGE) + flexes
