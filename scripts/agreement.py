"""Rocking theory against MuJoCo under earthquakes: outcomes, ratios of peak rotations, distributions of both.

Walls of Table 1's range, one- and two-sided, under every record in both polarities and several intensities. Single
histories part after a few impacts, in either solver, from the smallest difference; what has to agree is how the walls
end, and how their peak rotations are distributed (two-sample Kolmogorov-Smirnov test).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import ks_2samp

import cli
import mjrock as mr
import suite
from mjrock import plotting
from mjrock.study.campaign import completed

WALLS = [(5.0, 1.6), (7.0, 2.1), (8.0, 1.4), (10.0, 2.8)]
"""Slenderness h/b [-] and half diagonal R [m]."""
LEVELS = [1.2, 1.8, 2.5, 3.5, 5.0]
"""Peak ground acceleration in multiples of what lifts the wall, g tan(alpha) [-]."""


def main(argv: Sequence[str] | None = None) -> None:
    """Run every combination in both solvers, compare, draw and print."""
    args = suite.parser(__doc__, "agreement").parse_args(argv)
    out = cli.folder(args.out)

    def build(
        side_stop: int, wall: int, motion: mr.GroundMotion, polarity: int, level: float, solver: str
    ) -> mr.Analysis:
        block = mr.Block.from_slenderness(*WALLS[wall])
        scaled = suite.to_peak(motion, level * math.tan(block.alpha)).polarities[polarity]
        return suite.analysis(block, scaled, solver, k_n=suite.STIFF, side_stop=bool(side_stop))

    grid = mr.Grid(
        build,
        side_stop=(1, 0),
        wall=range(1 if args.quick else len(WALLS)),
        motion=suite.motions(args.records, 3 if args.quick else 8),
        polarity=(0, 1),
        level=LEVELS[1:4] if args.quick else LEVELS,
        solver=suite.SOLVERS,
    )
    found = completed(grid, out / "agreement.sqlite", workers=args.workers)
    figure = Figure(figsize=(8.4, 7.2), layout="constrained")
    table = []
    for line, (side_stop, title) in zip(figure.subplots(2, 2), ((1, "one-sided"), (0, "two-sided")), strict=True):
        own = [row for row in found if row["side_stop"] == side_stop]
        ends, peaks = suite.in_pairs(own)
        rocks = (ends == "rocks").all(axis=1)
        ratio = np.percentile(peaks[rocks, 1] / peaks[rocks, 0], [5, 50, 95]) if rocks.any() else []
        test = ks_2samp(*np.maximum(peaks, suite.STILL).T)
        plotting.pairs(line[0], peaks, ("rocking theory", "MuJoCo"), (suite.STILL / 3, 1.5)).set_title(
            title, fontsize=10
        )
        plotting.distributions(line[1], dict(zip(suite.SOLVERS, peaks.T, strict=True)), suite.STILL)
        line[1].set_title(f"{title}, Kolmogorov-Smirnov p = {test.pvalue:.2f}", fontsize=10)
        line[1].legend(frameon=False, fontsize=8, loc="upper left")
        counts = ["/".join(str((column == v).sum()) for v in ("rests", "rocks", "overturns")) for column in ends.T]
        table.append(
            [
                title,
                len(ends),
                *counts,
                f"{(ends[:, 0] == ends[:, 1]).mean():.3f}",
                " / ".join(f"{r:.2f}" for r in ratio),
                f"{test.statistic:.3f}",
                f"{test.pvalue:.3f}",
            ]
        )
    plotting.save(figure, out / "agreement.png")
    columns = ("side_stop", "wall", "motion", "polarity", "level", "solver", "outcome", "peak_over_alpha")
    cli.write(out / "agreement.csv", cli.csv_text(columns, [[row[c] for c in columns] for row in found]))
    header = ["wall", "cases", "theory rests/rocks/overturns", "MuJoCo", "equal", "peak ratio 5/50/95 %", "KS", "p"]
    text = cli.table(header, table)
    cli.write(out / "agreement.txt", text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
