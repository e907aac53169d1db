"""The one-sided wall of the paper's Figure 3 as a moving picture: the wall in section beside its rotation.

Writes figure3.gif, or what --format says, and prints how long it plays and how large it is.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import cli
import mjrock as mr
from mjrock import plotting
from paper import FIGURE_3, K_N


def main(argv: Sequence[str] | None = None) -> None:
    """Simulate, draw and write."""
    parser = cli.parser(__doc__, "animate")
    parser.add_argument("--format", default="gif", choices=["gif", "mp4", "html"], help="ending of the file")
    parser.add_argument("--speed", type=float, default=0.5, help="time of the motion in a second of the picture")
    parser.add_argument("--magnify", type=float, default=1.0, help="factor on the displacements")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    e = mr.Restitution.from_geometry(FIGURE_3)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N)
    duration = 0.06 if args.quick else 2.0
    response = mr.simulate(mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, duration), contacts)
    title = "One-sided rocking, 4.2 x 0.6 m, released at half of alpha"
    path = plotting.animate(
        response, out / f"figure3.{args.format}", speed=args.speed, magnify=args.magnify, title=title, dpi=80
    )
    size = path.stat().st_size / 1e6
    print(f"{path}: {duration:g} s of motion in {duration / args.speed:g} s, {size:.2f} MB")


if __name__ == "__main__":
    sys.exit(cli.run(main))
