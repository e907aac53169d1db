"""Moving pictures: the one-sided wall of the paper's Figure 3, and an arch that a pulse brings down.

Writes figure3.gif and arch.gif, or what --format says, and prints how long they play and how large they are.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, K_N


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
    duration = 0.06 if args.quick else 1.4
    response = mr.simulate(mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, duration), contacts)
    title = "One-sided rocking, 4.2 x 0.6 m, released at half of alpha"
    path = plotting.animate(
        response, out / f"figure3.{args.format}", speed=args.speed, magnify=args.magnify, title=title, dpi=80
    )
    told(path, duration / args.speed)
    arch = mr.Masonry.arch(radius=5.0, thickness=0.7, voussoirs=17, k_n=1e10, friction=0.7, xi=0.05)
    answer = mr.simulate(mr.MasonryCase(arch, 0.06 if args.quick else 3.0, motion=mr.GroundMotion.sine(4.0, 0.6)))
    path = plotting.animate(
        answer, out / f"arch.{args.format}", speed=args.speed, title="An arch under a pulse", dpi=80
    )
    told(path, float(answer.t[-1]) / args.speed)


def told(path: Path, plays: float) -> None:
    """Print what was written, and how long it plays [s]."""
    print(f"{path}: plays {plays:g} s, {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    sys.exit(cli.run(main))
