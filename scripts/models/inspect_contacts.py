"""What every contact of a MuJoCo model is in N/m and N s/m, with its damping ratio and coefficient of restitution.

    python scripts/models/inspect_contacts.py model.xml

It is `mjrock inspect model.xml --all`, which needs no clone of the repository and chooses geoms, bodies and
pairs, and writes inspect_contacts.txt. Without a model, the one-sided wall of `models/` is taken.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from mjrock.__main__ import answered
from scripts.models.make_models import MODELS
from scripts.shared import cli


def main(argv: Sequence[str] | None = None) -> None:
    """Inspect a model and print the table."""
    options = cli.parser(__doc__, "inspect_contacts")
    wall = MODELS / "figure3_one_sided" / "scene.xml"
    options.add_argument("model", type=Path, nargs="?", default=wall, help="MJCF or URDF file")
    args, others = options.parse_known_args(argv)
    arguments = ["inspect", str(args.model), "--all", *(["--pairs"] if args.quick else []), *others]
    cli.report(cli.folder(args.out) / "inspect_contacts", answered(arguments).text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
