"""Fragility of one wall: share overturned against peak ground acceleration, by rocking theory and by MuJoCo.

The one-sided wall of the paper's Figure 3 under both polarities of every record; a lognormal curve of greatest
likelihood with its 90 % band for each solver.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

import cli
import mjrock as mr
import suite
from mjrock import plotting
from mjrock.study.campaign import completed
from mjrock.study.fragility import fit_fragility
from paper import FIGURE_3, K_N

SOLVERS = {"analytical": "o", "MuJoCo": "s"}


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record at every intensity, fit, draw and print."""
    args = suite.parser(__doc__, "fragility").parse_args(argv)
    out = cli.folder(args.out)
    motions = [
        polarity for motion in suite.motions(args.records, 8 if args.quick else 40) for polarity in motion.polarities
    ]
    levels = np.linspace(0.6, 0.9, 4) if args.quick else np.linspace(0.3, 1.2, 13)

    def build(solver: str, motion: mr.GroundMotion, pga: float) -> mr.Analysis:
        return suite.analysis(FIGURE_3, suite.to_peak(motion, pga), solver, k_n=K_N)

    grid = mr.Grid(build, solver=SOLVERS, motion=motions, pga=levels.tolist())
    found = completed(grid, out / "fragility.sqlite", workers=args.workers)
    fell = np.array([row["outcome"] == mr.Outcome.OVERTURNED.value for row in found])
    fell = fell.reshape(len(SOLVERS), len(motions), len(levels))
    fits = [fit_fragility(np.tile(levels, len(motions)), own.ravel()) for own in fell]

    def draw(ax: Axes) -> Axes:
        for (solver, marker), fit, own in zip(SOLVERS.items(), fits, fell, strict=True):
            plotting.fragility(ax, fit, levels, own.mean(axis=0), solver, marker)
        ax.legend(frameon=False, fontsize=8, title="median, dispersion", title_fontsize=8, loc="upper left")
        return ax

    plotting.save(plotting.single(draw), out / "fragility.png")
    rows = []
    for solver, fit in zip(SOLVERS, fits, strict=True):
        low, high = fit.median_interval()
        interval = f"{low:.3f} to {high:.3f}"
        rows.append(
            [plotting.STYLES[solver]["label"], fit.count, f"{fit.median:.3f}", interval, f"{fit.dispersion:.3f}"]
        )
    text = cli.table(["solver", "runs", "median PGA [g]", "90 % interval [g]", "dispersion [-]"], rows)
    cli.write(out / "fragility.txt", text + "\n")
    cells = [
        (f"{level:.4f}", *(f"{share:.4f}" for share in own))
        for level, own in zip(levels, fell.mean(axis=1).T, strict=True)
    ]
    header = ["PGA [g]", *(f"share overturned, {plotting.STYLES[s]['label']} [-]" for s in SOLVERS)]
    cli.write(out / "fragility.csv", cli.csv_text(header, cells))
    print(text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
