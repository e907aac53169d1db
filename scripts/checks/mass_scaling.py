"""How much longer steps of a slow push would be if light blocks were given more inertia, with their weight as it is.

Where all blocks have s times their inertia, the longest stable step is longer by the root of s. A push then has to be
slower by the root of s for forces of inertia that are the same share of the load, so that nothing is gained. What is
left is to raise the inertia of those blocks that make the step short. Here every block that is lighter than a share of
the heaviest one is given that share. Prints the longest stable step before and after and what mass is added, for walls
in running bond, an arch, a dome and a façade.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

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


def main(argv: Sequence[str] | None = None) -> None:
    """Print the table."""
    args = cli.parser(__doc__, "mass_scaling").parse_args(argv)
    names = list(SCENES)[:1] if args.quick else list(SCENES)
    rows = [[name, *gains(SCENES[name]())] for name in tqdm(names, disable=None, leave=False)]
    header = ["masonry", "step [us]"]
    header += [f"{what} {share:g}" for share in SHARES for what in ("step with at least", "mass added at")]
    cli.report(cli.folder(args.out) / "mass_scaling", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
