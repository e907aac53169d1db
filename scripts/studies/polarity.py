"""What the polarity of a record does to a one-sided wall: the same record both ways, by rocking theory and by MuJoCo.

Prints how often the two polarities end differently, and how far apart their peak rotations are.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.study.campaign.campaign import completed
from scripts.shared import cli, suite
from scripts.shared.pairs import pairs
from scripts.shared.paper import FIGURE_3, K_N


def drawn(found: Sequence[Mapping[str, Any]]) -> Figure:
    """Peaks of both polarities, a panel a solver."""
    figure = Figure(figsize=(7.4, 4.3), layout="constrained")
    for ax, solver in zip(figure.subplots(1, 2, sharey=True), suite.SOLVERS, strict=True):
        _, peaks = suite.in_pairs([row for row in found if row["solver"] == solver])
        pairs(ax, peaks, ("as recorded", "reversed"), (suite.STILL / 3, 1.5), plotting.STYLES[solver]["label"])
        ax.label_outer()
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run both polarities of every record, draw them against each other, and print."""
    args = suite.parser(__doc__, "polarity").parse_args(argv)
    out = cli.folder(args.out)
    motions = suite.motions(args, 40, quick=2)
    levels = [0.3, 0.5] if args.quick else np.linspace(0.25, 0.75, 6).tolist()

    def build(solver: str, motion: mr.GroundMotion, pga: float, polarity: int) -> mr.Analysis:
        return suite.analysis(FIGURE_3, suite.to_peak(motion, pga).polarities[polarity], solver, k_n=K_N)

    grid = mr.Grid(build, solver=suite.SOLVERS, motion=motions, pga=levels, polarity=(0, 1))
    found = completed(grid, out / "polarity.sqlite", workers=args.workers)
    rows = []
    for solver in suite.SOLVERS:
        own = [row for row in found if row["solver"] == solver]
        ends, peaks = suite.in_pairs(own)
        rocking = (ends == "rocks").all(axis=1)
        apart = np.exp(np.abs(np.log(peaks[rocking, 0] / peaks[rocking, 1])))
        one = (ends == "overturns").sum(axis=1) == 1
        rows.append(
            [
                plotting.STYLES[solver]["label"],
                len(ends),
                f"{(ends[:, 0] != ends[:, 1]).mean():.3f}",
                f"{one.mean():.3f}",
                *(f"{q:.2f}" for q in np.percentile(apart, [50, 90])),
            ]
        )
    plotting.save(drawn(found), out / "polarity.png")
    columns = ("solver", "motion", "pga", "polarity", "outcome", "peak_over_alpha")
    header = ["solver", "pairs", "ends differ", "one alone overturns", "peaks apart, median", "peaks apart, 90 %"]
    cli.report(out / "polarity", cli.table(header, rows), columns, [[row[c] for c in columns] for row in found])


if __name__ == "__main__":
    sys.exit(cli.run(main))
