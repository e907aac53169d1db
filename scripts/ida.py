"""Incremental dynamic analysis of one wall: peak rotation against intensity under a suite of records.

The one-sided wall of the paper's Figure 3, each record in both polarities, by rocking theory and by MuJoCo. Prints the
peak ground acceleration at which each record overturns the wall first.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import cli
import mjrock as mr
import suite
from mjrock import plotting
from mjrock.study.campaign import completed
from paper import FIGURE_3, K_N


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record at every intensity, draw the curves, and print the capacities."""
    args = suite.parser(__doc__, "ida").parse_args(argv)
    out = cli.folder(args.out)
    motions = [
        polarity for motion in suite.motions(args.records, 2 if args.quick else 12) for polarity in motion.polarities
    ]
    levels = np.linspace(0.1, 1.0, 4 if args.quick else 28)

    def build(solver: str, motion: mr.GroundMotion, pga: float) -> mr.Analysis:
        return suite.analysis(FIGURE_3, suite.to_peak(motion, pga), solver, k_n=K_N)

    grid = mr.Grid(build, solver=suite.SOLVERS, motion=motions, pga=levels.tolist())
    found = completed(grid, out / "ida.sqlite", workers=args.workers)
    fell = [row["outcome"] == mr.Outcome.OVERTURNED.value for row in found]
    peaks = np.where(fell, math.inf, [row["peak_over_alpha"] for row in found])
    peaks = peaks.reshape(len(suite.SOLVERS), len(motions), len(levels))

    figure = Figure(figsize=(8.2, 3.6), layout="constrained")
    for ax, solver, curves in zip(figure.subplots(1, 2, sharey=True), suite.SOLVERS, peaks, strict=True):
        plotting.incremental(ax, levels, curves, solver).label_outer()
        ax.legend(frameon=False, fontsize=8, loc="lower right")
    plotting.save(figure, out / "ida.png")
    capacity = np.where(np.isinf(peaks).any(axis=2), levels[np.isinf(peaks).argmax(axis=2)], math.nan)
    rows = [
        [motion.name, *("-" if math.isnan(c) else f"{c:.3f}" for c in pair)]
        for motion, pair in zip(motions, capacity.T, strict=True)
    ]
    header = ["record", *(f"first overturned at PGA [g], {plotting.STYLES[s]['label']}" for s in suite.SOLVERS)]
    text = cli.table(header, rows)
    cli.write(out / "ida.txt", text + "\n")
    cells = [(r["solver"], r["motion"], r["pga"], r["outcome"], r["peak_over_alpha"]) for r in found]
    cli.write(out / "ida.csv", cli.csv_text(["solver", "record", "PGA [g]", "outcome", "peak theta/alpha [-]"], cells))
    print(text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
