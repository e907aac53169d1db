"""Below which height of its side stop a wall depends on whether its base can slide.

Twelve walls rock against stops of falling height, released and under an artificial record, on a base that holds and on
one with a coefficient of friction of 0.6. Heights are over that at which the impulse of the stop leaves the inner edge
of the base at rest, some two thirds of the height of the wall. Prints by how much |e| of the first rebound and the peak
under the record differ, sliding over holding, in the median and at most, and how many runs end otherwise.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock.problem.wall.plausibility import rebound_height
from scripts.shared import cli

SHARES = (1.2, 1.05, 1.0, 0.975, 0.95, 0.925, 0.9, 0.85, 0.75, 0.5, 0.25)
"""Heights of the stop, over the height of rebound [-]."""
FRICTION = 0.6


def difference(wall: mr.Block, share: float, seed: int) -> tuple[float, float, bool]:
    """How much |e| and the peak under a record differ [-], and whether the outcome does."""
    stop = mr.SideStop(share * rebound_height(mr.Case(wall, 0.0, 1.0)))
    e, k_n = mr.Restitution.from_geometry(wall), (5e8, 3e9)[seed % 2]
    motion = mr.GroundMotion.synthetic(peak=4 * mr.GRAVITY / wall.slenderness, duration=8.0, seed=seed)
    runs = []
    for friction in (None, FRICTION):
        contacts = mr.Contacts.from_law(wall, e, k_base=k_n, k_side=k_n, friction=friction)
        released = mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 3.0, side_stop=stop), contacts)
        shaken = mr.simulate(mr.Case(wall, 0.0, 10.0, side_stop=stop, motion=motion), contacts)
        rebound = released.restitution[0] if released.restitution.size else 0.0
        runs.append((rebound, float(shaken.peaks.max(initial=0.0)), shaken.outcome))
    held, slid = runs
    return slid[0] / held[0] - 1, slid[1] / held[1] - 1, held[2] is not slid[2]


def main(argv: Sequence[str] | None = None) -> None:
    """Lower the stop, and print the table."""
    args = cli.parser(__doc__, "low_stop").parse_args(argv)
    out = cli.folder(args.out)
    sizes = [(0.4 + 0.1 * (i % 5), (6, 8, 10, 13, 15, 7, 9, 11, 12, 14, 5.5, 10)[i]) for i in range(12)]
    walls = [mr.Block.from_size(thickness, thickness * slenderness, 6.0, 1800.0) for thickness, slenderness in sizes]
    walls, shares = (walls[:2], SHARES[::5]) if args.quick else (walls, SHARES)
    rows: list[list[object]] = []
    for share in tqdm(shares, desc="heights", disable=None, leave=False):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # low stops are meant
            found = [difference(wall, share, seed) for seed, wall in enumerate(walls)]
        rebounds, peaks, outcomes = (np.array(values) for values in zip(*found, strict=True))
        cells = [
            f"{value:+.0%}" for size in (rebounds, peaks) for value in (np.median(size), size[np.abs(size).argmax()])
        ]
        apart = f"{np.median(np.abs(peaks)):.0%}"
        rows.append([f"{share:g}", *cells, apart, f"{outcomes.sum()} of {len(walls)}"])
    header = ["stop", "|e|, median", "most", "peak, median", "most", "median size", "ends otherwise"]
    cli.report(out / "low_stop", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
