"""Fragility of one wall: share overturned against peak ground acceleration, by rocking theory and by MuJoCo.

The one-sided wall of the paper's Figure 3 under both polarities of every record; a lognormal curve of greatest
likelihood with its 90 % band for each solver. Runs under one record are not independent. The printed table sets the
90 % intervals of median and dispersion that count each record as one, which the band is made of, beside those that take
every run as independent.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

import mjrock as mr
from mjrock import plotting
from mjrock.study.campaign import completed
from mjrock.study.fragility import fit_fragility
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3, K_N

SOLVERS = {"analytical": "o", "MuJoCo": "s"}


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record at every intensity, fit, draw and print."""
    args = suite.parser(__doc__, "fragility").parse_args(argv)
    out = cli.folder(args.out)
    records = suite.motions(args.records, 8 if args.quick else 40)
    motions = [polarity for motion in records for polarity in motion.polarities]
    levels = np.linspace(0.6, 0.9, 4) if args.quick else np.linspace(0.3, 1.2, 13)

    def build(solver: str, motion: mr.GroundMotion, pga: float) -> mr.Analysis:
        return suite.analysis(FIGURE_3, suite.to_peak(motion, pga), solver, k_n=K_N)

    grid = mr.Grid(build, solver=SOLVERS, motion=motions, pga=levels.tolist())
    found = completed(grid, out / "fragility.sqlite", workers=args.workers)
    fell = np.array([row["outcome"] == mr.Outcome.OVERTURNED.value for row in found])
    fell = fell.reshape(len(SOLVERS), len(motions), len(levels))
    x, record = np.tile(levels, len(motions)), np.repeat(np.arange(len(records)), 2 * len(levels))
    fits = [fit_fragility(x, own.ravel(), record) for own in fell]

    def draw(ax: Axes) -> Axes:
        for (solver, marker), fit, own in zip(SOLVERS.items(), fits, fell, strict=True):
            plotting.fragility(ax, fit, levels, own.mean(axis=0), solver, marker)
        ax.legend(frameon=False, fontsize=8, title="median, dispersion", title_fontsize=8, loc="upper left")
        return ax

    plotting.save(plotting.single(draw), out / "fragility.png")
    rows = []
    for solver, fit, own in zip(SOLVERS, fits, fell, strict=True):
        for taken, made in (("records", fit), ("runs", fit_fragility(x, own.ravel()))):
            ends = [*made.median_interval(), *made.dispersion_interval()]
            rows.append(
                [
                    plotting.STYLES[solver]["label"],
                    f"{made.groups or made.count} {taken}",
                    f"{made.median:.3f}",
                    f"{ends[0]:.3f} to {ends[1]:.3f}",
                    f"{made.dispersion:.3f}",
                    f"{ends[2]:.3f} to {ends[3]:.3f}",
                ]
            )
    header = ["solver", "independent", "median PGA [g]", "90 % interval [g]", "dispersion [-]", "90 % interval [-]"]
    text = cli.table(header, rows)
    cells = [
        (f"{level:.4f}", *(f"{share:.4f}" for share in own))
        for level, own in zip(levels, fell.mean(axis=1).T, strict=True)
    ]
    header = ["PGA [g]", *(f"share overturned, {plotting.STYLES[s]['label']} [-]" for s in SOLVERS)]
    cli.report(out / "fragility", text, header, cells)


if __name__ == "__main__":
    sys.exit(cli.run(main))
