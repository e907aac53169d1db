"""Incremental dynamic analysis of one wall: peak rotation against intensity under a suite of records.

The one-sided wall of the paper's Figure 3, each record in both polarities, by rocking theory and by MuJoCo. Prints the
peak ground acceleration at which each record overturns the wall first.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3, K_N


def drawn(curves: Mapping[str, tuple[Array, Array]]) -> Figure:
    """Peaks over the intensity, a panel a solver, of its intensities [g] and peaks, shapes (n,) and (records, n)."""
    figure = Figure(figsize=(7.4, 3.4), layout="constrained")
    axes = figure.subplots(1, len(curves), sharey=True)
    for ax, (solver, (levels, peaks)) in zip(axes, curves.items(), strict=True):
        plotting.incremental(ax, levels, peaks, solver, top=1.6).label_outer()
        ax.legend().remove()
    axes[0].legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(0.0, 0.88))
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record at every intensity, draw the curves, and print the capacities."""
    args = suite.parser(__doc__, "ida").parse_args(argv)
    out = cli.folder(args.out)
    motions = [polarity for motion in suite.motions(args, 12, quick=1) for polarity in motion.polarities]
    levels = np.linspace(0.1, 1.0, 4 if args.quick else 28)
    found = {
        solver: mr.ida(records(motions, solver), levels, out / "ida.sqlite", workers=args.workers)
        for solver in suite.SOLVERS
    }
    curves = {solver: (np.asarray(one.scales), one.peaks) for solver, one in found.items()}
    plotting.save(drawn(curves), out / "ida.png")
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
