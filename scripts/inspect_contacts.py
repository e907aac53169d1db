"""What every contact of a MuJoCo model is in N/m and N s/m, with its damping ratio and coefficient of restitution.

    python scripts/inspect_contacts.py model.xml

Prints a table with a row for each explicit `<pair>` and for each two geoms that can collide without one, and below it
what else is to be known of them. Values hold at zero penetration, for an approach of the centres of mass along the
normal, and xi and e for as many points as are given by --contacts. Without a model, the one-sided wall of `models/` is
taken.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import mujoco

import cli
import mjrock as mr
from make_models import MODELS


def main(argv: Sequence[str] | None = None) -> None:
    """Inspect a model and print the table."""
    options = cli.parser(__doc__, "inspect_contacts")
    options.add_argument(
        "model", type=Path, nargs="?", default=MODELS / "figure3_one_sided" / "scene.xml", help="MJCF or URDF file"
    )
    options.add_argument("--pairs", action="store_true", help="explicit pairs only")
    options.add_argument(
        "--contacts",
        type=int,
        help="points that share the mass where there can be several, instead of those counted",
    )
    args = options.parse_args(argv)
    if not args.model.is_file():
        raise FileNotFoundError(f"model {args.model} is no file")
    model = mujoco.MjModel.from_xml_path(str(args.model))
    found = mr.inspect_contacts(model, candidates=not (args.pairs or args.quick), contacts=args.contacts)
    out = cli.folder(args.out)
    text = report(found)
    cli.write_text(out / "inspect_contacts.txt", text + "\n")
    print(text)


def report(found: Sequence[mr.InspectedContact]) -> str:
    """The table, and the notes that its last column numbers."""
    if not found:
        return "This model has no contact that can act."
    notes = list(dict.fromkeys(note for contact in found for note in contact.notes))
    rows = [
        [
            contact.geom1,
            contact.geom2,
            "pair" if contact.explicit else "geoms",
            *(f"{value:.4g}" for value in (contact.k, contact.c, contact.mass, contact.inertia, contact.impedance)),
            str(contact.points),
            f"{contact.xi:.3f}",
            f"{contact.restitution:.3f}",
            ",".join(str(notes.index(note) + 1) for note in contact.notes),
        ]
        for contact in found
    ]
    header = [
        "geom",
        "geom",
        "by",
        "k [N/m]",
        "c [N s/m]",
        "mass [kg]",
        "row adds [kg]",
        "d",
        "points",
        "xi",
        "e",
        "notes",
    ]
    lines = [f"{number}: {note}" for number, note in enumerate(notes, 1)]
    return "\n".join([cli.table(header, rows), *([""] if lines else []), *lines])


if __name__ == "__main__":
    sys.exit(cli.run(main))
