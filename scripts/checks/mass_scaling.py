"""How much longer steps of a slow push would be if light blocks were given more inertia, with their weight as it is.

Where all blocks have s times their inertia, the longest stable step is longer by the root of s. A push then has to be
slower by the root of s for forces of inertia that are the same share of the load, so that nothing is gained. What is
left is to raise the inertia of those blocks that make the step short. Here every block that is lighter than a share of
the heaviest one is given that share. Prints the longest stable step before and after and what mass is added, for walls
in running bond, an arch, a dome and a façade.

With s times the inertia of all blocks and the same damping ratios a push at the same speed is that of the masonry as it
is at the speed times the root of s, in as many steps less. A larger share of inertia that is allowed does just that.
Then a wall is pushed with two shares. Prints what it bears and the processor time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock.distinct.setup import setup_of
from mjrock.distinct.stable_step import longest_step
from scripts.shared import cli

JOINTS = mr.Dry(k_n=1e9, k_s=1e9, friction=0.6)
SCENES: dict[str, Callable[[], mr.Masonry]] = {
    "wall, 50 blocks": lambda: mr.Masonry.running_bond(2.8, 1.4, (0.4, 0.2), joints=JOINTS),
    "wall, 1,000 blocks": lambda: mr.Masonry.running_bond(12.4, 6.4, (0.4, 0.2), joints=JOINTS),
    "arch, 17 voussoirs": lambda: mr.Masonry.arch(3.0, 0.5, voussoirs=17, joints=JOINTS),
    "dome": lambda: mr.Masonry.dome(3.0, 0.4, 12, 6, joints=JOINTS),
    "façade with openings": lambda: mr.Masonry.facade(
        3.2, 1.6, 1.2, (0.4, 0.2), openings=[(0.0, mr.Opening(width=0.4, height=0.6, sill=0.6))], joints=JOINTS
    ),
}
SHARES = (0.5, 1.0)
"""Least mass that a block is given, over that of the heaviest one [-]."""
INERTIA, TO = (0.01, 0.0454), 0.004
"""Shares of inertia that are allowed in a push [-], and how far the wall goes [m]."""


def gains(masonry: mr.Masonry) -> list[str]:
    """The longest stable step [us], and for each of `SHARES` the ratio to it [-] and the mass that is added, over that
    of all blocks [-]."""
    system = setup_of(mr.MasonryCase(masonry, 1.0), None, None).system
    before, cells = longest_step(system), list[str]()
    for share in SHARES:
        bodies = system.bodies.copy()
        factor = np.maximum(1.0, share * bodies["mass"].max() / bodies["mass"])
        added = float(((factor - 1) * bodies["mass"]).sum() / bodies["mass"].sum())
        bodies["inverse_mass"] /= factor[:, None]
        bodies["inverse_inertia"] /= factor[:, None, None]
        bodies["mass"] *= factor
        cells += [f"{longest_step(system._replace(bodies=bodies)) / before:.2f}", f"{added:.0%}"]
    return [f"{before * 1e6:.1f}", *cells]


def pushes(masonry: mr.Masonry) -> list[list[object]]:
    """Rows of the pushes: the share of inertia, the multiplier that the wall bears, and the processor time [s]."""
    rows: list[list[object]] = []
    for inertia in tqdm(INERTIA, disable=None, leave=False):
        begun = time.process_time()
        push = mr.push(masonry, 1, TO, inertia=inertia)
        rows.append([f"{inertia:g}", f"{push.peak:.4f}", f"{time.process_time() - begun:.1f}"])
    return rows


def main(argv: Sequence[str] | None = None) -> None:
    """Print the table."""
    args = cli.parser(__doc__, "mass_scaling").parse_args(argv)
    names = list(SCENES)[:1] if args.quick else list(SCENES)
    rows = [[name, *gains(SCENES[name]())] for name in tqdm(names, disable=None, leave=False)]
    header = ["masonry", "step [us]"]
    header += [f"{what} {share:g}" for share in SHARES for what in ("step with at least", "mass added at")]
    cli.report(cli.folder(args.out) / "mass_scaling", cli.table(header, rows))
    if not args.quick:
        wall = mr.Masonry.running_bond(5.6, 2.8, (0.4, 0.2), joints=replace(JOINTS, xi=0.1))
        header = ["inertia", "multiplier", "time [s]"]
        cli.report(cli.folder(args.out) / "mass_scaling_push", cli.table(header, pushes(wall)))


if __name__ == "__main__":
    sys.exit(cli.run(main))
