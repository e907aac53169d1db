"""How near `Capacity` comes to the lowest intensity that overturns a wall, and how many runs it takes for that.

A wall under 14 artificial records, one-sided and two-sided, in rocking theory. All intensities from 0.08 to 1.2 g are
looked at, 0.2 % apart: many walls fall in narrow bands below the intensity at which they fall for good. `Capacity`
starts from five scales, with several spacings of its looks below an edge. Prints how often it finds the lowest
intensity within 2 and 10 %, and its runs.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
SCALES = np.geomspace(0.25, 4.0, 1387)
"""Of records that peak at 3 m/s2, 0.2 % apart."""
STARTS = (0.5, 0.8, 1.0, 1.3, 2.0)
LOOKS = ((0, 0.02), (4, 0.25), (12, 0.02), (30, 0.02), (30, 0.01))
"""How many weaker intensities are looked at, and how far apart they are [-]."""
HEADER = ("below", "spacing", "down to", "runs", "within 2 %", "within 10 %", "worst")


def analysis(seed: int, side_stop: bool) -> mr.Analysis:
    """The wall under a record, in rocking theory."""
    motion = mr.GroundMotion.synthetic(peak=3.0, duration=6.0, seed=seed)
    case = mr.Case(WALL, 0.0, 9.0, side_stop=side_stop, motion=motion)
    return mr.Analysis(case, "analytical", e=mr.Restitution.from_geometry(WALL))


def lowest(of: mr.Analysis, every: int) -> float:
    """The lowest of every so many of the scales that overturns the wall."""
    task = mr.Capacity(of)
    return next(float(scale) for scale in SCALES[::every] if task.scaled(scale)()[of.PEAK] == math.inf)


def main(argv: Sequence[str] | None = None) -> None:
    """Look at the scales, ask `Capacity`, and print the table."""
    args = cli.parser(__doc__, "capacity_bands").parse_args(argv)
    out = cli.folder(args.out)
    seeds, every, starts, looks = (1, 50, STARTS[:1], LOOKS[:2]) if args.quick else (14, 1, STARTS, LOOKS)
    cases = [analysis(seed, one) for seed in range(seeds) for one in (True, False)]
    rows: list[list[object]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mr.Implausible)  # weak records are meant
        truth = [lowest(of, every) for of in tqdm(cases, desc="scales", disable=None, leave=False)]
        for below, spacing in looks:
            found = [mr.Capacity(of, start=s, below=below, spacing=spacing)() for of in cases for s in starts]
            over = np.array([row["capacity_scale"] for row in found]) / np.repeat(truth, len(starts))
            shares = [f"{(over < 1 + share).mean():.0%}" for share in (0.02, 0.1)]
            runs = np.mean([row["runs"] for row in found])
            rows.append([below, f"{spacing:g}", f"{(1 + spacing) ** -below:.2f}", f"{runs:.0f}", *shares])
            rows[-1].append(f"{over.max():.2f}")
    cli.report(out / "capacity_bands", cli.table(HEADER, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
