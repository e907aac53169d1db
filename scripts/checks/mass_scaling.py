"""How much longer steps of a slow push would be if light blocks were given more inertia, with their weight as it is.

Where all blocks have s times their inertia, the longest stable step is longer by the root of s. A push then has to be
slower by the root of s for forces of inertia that are the same share of the load, so that nothing is gained. What is
left is to raise the inertia of those blocks that make the step short. Here every block that is lighter than a share of
the heaviest one is given that share. Prints the longest stable step before and after and what mass is added, for walls
in running bond, an arch, a dome and a façade.

Then a wall is pushed in three ways: as it is, with `MASS` times the inertia of all blocks under their own weight, whose
steps are longer by the root of that, and as it is with `MASS` times the share of inertia that is allowed. Prints what
it bears and the processor time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock.distinct import explicit
from mjrock.distinct.setup import Setup, setup_of, setup_of_problem
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
MASS, INERTIA, TO = 4.54, 0.01, 0.004
"""Inertia of all blocks over theirs [-], the share of inertia that is allowed [-], and how far the wall goes [m]."""


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


def with_more_mass(masonry: mr.Masonry) -> Callable[..., Setup]:
    """Set-up with `MASS` times the inertia of all blocks. The ground falls away, so that they weigh what they did."""
    falls = mr.GroundMotion(np.full(1001, (1 / MASS - 1) * mr.GRAVITY), 1.0)
    ground = setup_of(mr.MasonryCase(masonry, 1000.0, vertical=falls), None, None).system.ground

    def setup_with_mass(*problem: Any) -> Setup:
        setup = setup_of_problem(*problem)
        bodies, length, longer = setup.system.bodies, setup.step_length, float(np.sqrt(MASS))
        bodies["mass"] *= MASS
        bodies["inverse_mass"] /= MASS
        bodies["inverse_inertia"] /= MASS
        length = length._replace(limit=longer * length.limit, default=longer * length.default)
        return replace(setup, system=setup.system._replace(ground=ground), step_length=length)

    return setup_with_mass


def pushes(masonry: mr.Masonry) -> list[list[object]]:
    """Rows of the three pushes: the multiplier that the wall bears, and the processor time [s]."""
    ways = {
        "as it is": (setup_of_problem, INERTIA),
        f"{MASS:g} times the inertia": (with_more_mass(masonry), INERTIA),
        f"inertia = {MASS * INERTIA:g}": (setup_of_problem, MASS * INERTIA),
    }
    rows: list[list[object]] = []
    for name, (setup, inertia) in tqdm(ways.items(), disable=None, leave=False):
        begun = time.process_time()
        with patch.object(explicit, "setup_of_problem", setup):
            push = mr.push(masonry, 1, TO, inertia=inertia)
        rows.append([name, f"{push.peak:.4f}", f"{time.process_time() - begun:.1f}"])
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
        header = ["push of a wall of 203 blocks", "multiplier", "time [s]"]
        cli.report(cli.folder(args.out) / "mass_scaling_push", cli.table(header, pushes(wall)))


if __name__ == "__main__":
    sys.exit(cli.run(main))
