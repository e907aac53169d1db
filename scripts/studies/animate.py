"""Films: the one-sided wall of the paper's Figure 3, and an arch that a pulse brings down.

Writes figure3 and arch as .mp4 and .webm, with a .webp of one frame, and prints how large they are.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Sequence

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.films import films, folder, summary_of
from scripts.shared.paper import FIGURE_3, K_N

SPEED = 0.5
"""Time of the motion in a second of the film [-]."""


def rocking(duration: float) -> mr.Response:
    """The wall of Figure 3, released at half of alpha."""
    e = mr.Restitution.from_geometry(FIGURE_3)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N)
    return mr.simulate(mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, duration), contacts)


def falling(duration: float) -> mr.Response:
    """An arch of 17 voussoirs under a pulse, until it lies on the ground."""
    arch = mr.Masonry.arch(
        radius=5.0, thickness=0.7, voussoirs=17, k_n=1e9, k_s=1e9, friction=0.7, xi=0.05, ground=True
    )
    return mr.solve_explicit(mr.MasonryCase(arch, duration, motion=mr.GroundMotion.sine(4.0, 0.6)), output_step=0.01)


def main(argv: Sequence[str] | None = None) -> None:
    """Simulate, draw and write."""
    args = cli.parser(__doc__, "animate").parse_args(argv)
    out = folder(args.out)
    wall, arch = (rocking(0.06), falling(0.06)) if args.quick else (rocking(1.4), falling(4.5))
    title = "One-sided rocking, 4.2 x 0.6 m, released at half of alpha"
    written = films(lambda path: plotting.animate(wall, path, speed=SPEED, title=title), out / "figure3", 0.0)
    print(summary_of(written))
    title = "An arch under a pulse"
    seen = [(-7.0, 11.0), (-1.3, 6.0)]  # m
    poster = 0.47 * float(arch.t[-1]) / SPEED
    draw = functools.partial(plotting.animate, arch, speed=SPEED, title=title, limits=seen)
    print(summary_of(films(draw, out / "arch", poster)))


if __name__ == "__main__":
    sys.exit(cli.run(main))
