"""Incremental dynamic analysis of one wall: peak rotation against intensity under a suite of records.

The one-sided wall of the paper's Figure 3, each record in both polarities, by rocking theory and by MuJoCo. Prints the
peak ground acceleration at which each record overturns the wall first.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3, K_N


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record at every intensity, draw the curves, and print the capacities."""
    args = suite.parser(__doc__, "ida").parse_args(argv)
    out = cli.folder(args.out)
    motions = [
        polarity for motion in suite.motions(args.records, 2 if args.quick else 12) for polarity in motion.polarities
    ]
    levels = np.linspace(0.1, 1.0, 4 if args.quick else 28)
    found = {
        solver: mr.ida(records(motions, solver), levels, out / "ida.sqlite", workers=args.workers)
        for solver in suite.SOLVERS
    }
    figure = Figure(figsize=(8.2, 3.6), layout="constrained")
    for ax, (solver, one) in zip(figure.subplots(1, 2, sharey=True), found.items(), strict=True):
        plotting.incremental(ax, one.scales, one.peaks, solver).label_outer()
        ax.legend(frameon=False, fontsize=8, loc="lower right")
    plotting.save(figure, out / "ida.png")
    capacities = zip(*(one.capacity for one in found.values()), strict=True)
    rows = [
        [motion.name, *("-" if math.isnan(c) else f"{c:.3f}" for c in pair)]
        for motion, pair in zip(motions, capacities, strict=True)
    ]
    header = ["record", *(f"first overturned at PGA [g], {plotting.STYLES[s]['label']}" for s in suite.SOLVERS)]
    text = cli.table(header, rows)
    cells = [
        (row["solver"], row["record"], row["scale"], row["outcome"], row["peak_over_alpha"])
        for one in found.values()
        for own in one.rows
        for row in own
    ]
    cli.report(out / "ida", text, ["solver", "record", "PGA [g]", "outcome", "peak theta/alpha [-]"], cells)


def records(motions: Sequence[mr.GroundMotion], solver: str) -> dict[str, Callable[[float], mr.Analysis]]:
    """What makes the analysis of a peak ground acceleration in g, for each motion by its name."""

    def scaled(motion: mr.GroundMotion) -> Callable[[float], mr.Analysis]:
        return lambda pga: suite.analysis(FIGURE_3, suite.to_peak(motion, pga), solver, k_n=K_N)

    made = {motion.name: scaled(motion) for motion in motions}
    if len(made) < len(motions):
        raise ValueError(f"{len(motions)} motions have {len(made)} names; each record needs a name of its own")
    return made


if __name__ == "__main__":
    sys.exit(cli.run(main))
