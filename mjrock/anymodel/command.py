"""`python -m mjrock inspect model.xml`: what the contacts of a MuJoCo model are in N/m and N s/m."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from ..engine.replay import load
from ..files import write_text
from ..result.table import csv_text
from .inspect import inspect_contacts
from .table import HEADER, is_of, report, require_known, values, worst_first

PAGE = 40
"""Rows that fill a page."""


def parser() -> argparse.ArgumentParser:
    """The arguments of the command line."""
    made = argparse.ArgumentParser("python -m mjrock inspect", description=__doc__)
    made.add_argument("model", type=Path, help="MJCF or URDF file, or a compiled .mjb")
    made.add_argument("--geom", action="append", default=[], help="contacts of a geom, such as 'foot*'")
    made.add_argument("--body", action="append", default=[], help="contacts of a body")
    made.add_argument("--pair", nargs=2, metavar=("A", "B"), help="contacts of two geoms or bodies")
    made.add_argument("--pairs", action="store_true", help="explicit pairs only")
    made.add_argument("--contacts", type=int, help="points that share the mass, instead of those counted")
    made.add_argument("--keyframe", help="keyframe in which the geoms meet, by name or number")
    made.add_argument("--load", type=float, help="static load of a contact point [N], instead of the weight")
    made.add_argument("--speed", type=float, default=1.0, help="speed of approach of the last e [m/s]")
    made.add_argument("--all", action="store_true", help=f"every row, not the worst {PAGE}")
    made.add_argument("--csv", type=Path, help="a file for every row that is chosen, with its notes")
    return made


def answer(argv: Sequence[str]) -> str:
    """The table of the model that is named; the rows are also written where --csv says.

    Raises:
        ValueError, TypeError, OSError: for what the user can mend.
    """
    args = parser().parse_args(argv)
    if not args.model.is_file():
        raise FileNotFoundError(f"model {args.model} is not a file")
    keyframe = int(args.keyframe) if args.keyframe is not None and args.keyframe.isdecimal() else args.keyframe
    model = load(args.model)
    require_known(model, [*args.geom, *args.body, *(args.pair or ())])
    found = inspect_contacts(
        model, candidates=not args.pairs, contacts=args.contacts, keyframe=keyframe, load=args.load
    )
    chosen = worst_first([contact for contact in found if is_of(contact, args.geom, args.body, args.pair)])
    if args.csv is not None:
        header = ["geom1", "geom2", *HEADER[2:]]
        rows = [[*values(contact, args.speed), "; ".join(contact.notes)] for contact in chosen]
        write_text(args.csv, csv_text(header, rows))
    if found and not chosen:
        return f"None of the {len(found)} contacts of this model is of these geoms, bodies or pairs."
    return report(chosen, speed=args.speed, most=None if args.all else PAGE)
