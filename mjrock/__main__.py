"""`python -m mjrock inspect model.xml`: what the contacts of a MuJoCo model are in N/m and N s/m."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import mujoco

from .anymodel.inspect import inspect_contacts
from .anymodel.table import HEADER, Filter, report, values, worst_first
from .files import write_text
from .result.table import csv_text

PAGE = 40
"""Rows that fill a page."""


def parser() -> argparse.ArgumentParser:
    """The arguments of the command line."""
    made = argparse.ArgumentParser(prog="python -m mjrock", description="Contacts of MuJoCo models in physical units.")
    commands = made.add_subparsers(dest="command", required=True)
    inspect = commands.add_parser("inspect", help="what every contact of a model is", description=__doc__)
    inspect.add_argument("model", type=Path, help="MJCF or URDF file, or a compiled .mjb")
    inspect.add_argument("--geom", action="append", default=[], help="contacts of a geom, such as 'foot*'")
    inspect.add_argument("--body", action="append", default=[], help="contacts of a body")
    inspect.add_argument("--pair", nargs=2, metavar=("A", "B"), help="contacts of two geoms or bodies")
    inspect.add_argument("--pairs", action="store_true", help="explicit pairs only")
    inspect.add_argument("--contacts", type=int, help="points that share the mass, instead of those counted")
    inspect.add_argument("--keyframe", help="keyframe in which the geoms meet, by name or number")
    inspect.add_argument("--load", type=float, help="static load of a contact point [N], instead of the weight")
    inspect.add_argument("--speed", type=float, default=1.0, help="speed of approach of the last e [m/s]")
    inspect.add_argument("--all", action="store_true", help=f"every row, not the worst {PAGE}")
    inspect.add_argument("--csv", type=Path, help="a file for every row that is chosen, with its notes")
    return made


def inspected(args: argparse.Namespace) -> str:
    """The table of a model; the rows are also written where --csv says."""
    if not args.model.is_file():
        raise FileNotFoundError(f"model {args.model} is no file")
    load = mujoco.MjModel.from_binary_path if args.model.suffix == ".mjb" else mujoco.MjModel.from_xml_path
    keyframe = int(args.keyframe) if args.keyframe is not None and args.keyframe.isdecimal() else args.keyframe
    found = inspect_contacts(
        load(str(args.model)), candidates=not args.pairs, contacts=args.contacts, keyframe=keyframe, load=args.load
    )
    wanted = Filter(tuple(args.geom), tuple(args.body), None if args.pair is None else (args.pair[0], args.pair[1]))
    chosen = worst_first([contact for contact in found if wanted.takes(contact)])
    if args.csv is not None:
        header = ["geom1", "geom2", *HEADER[2:]]
        rows = [[*values(contact, args.speed), "; ".join(contact.notes)] for contact in chosen]
        write_text(args.csv, csv_text(header, rows))
    if found and not chosen:
        return f"None of the {len(found)} contacts of this model is of these geoms, bodies or pairs."
    return report(chosen, speed=args.speed, most=None if args.all else PAGE)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit code: 2 for what the user can mend."""
    try:
        sys.stdout.write(inspected(parser().parse_args(argv)) + "\n")
    except (ValueError, TypeError, OSError) as error:
        sys.stderr.write(f"error: {error}\n")
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
