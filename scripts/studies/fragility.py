"""Fragility of one wall: share overturned against peak ground acceleration, by rocking theory and by MuJoCo.

The one-sided wall of the paper's Figure 3 under both polarities of every record; a lognormal curve of greatest
likelihood with its 90 % band for each solver. Runs under one record are not independent. The printed table sets the
90 % intervals of median and dispersion that count each record as one, which the band is made of, beside those that take
every run as independent. A line below it says how many runs of one intensity end otherwise by finer or explicit steps,
and under a record that is stronger by a millionth.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.study.campaign.campaign import completed
from mjrock.study.intensity.fragility import fit_fragility
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3, K_N

SOLVERS = {"analytical": "o", "MuJoCo": "s"}
CHECKED, FINER, STRONGER = 0.9, 1e-5, 1e-6
"""Intensity whose runs are made again [g], by which accuracy, and by how much stronger a record is then [-]."""


def again(motions: Sequence[mr.GroundMotion], pga: float, fell: Sequence[bool]) -> str:
    """How many runs of an intensity end otherwise by finer steps, by explicit ones and under stronger records."""

    def finer(case: mr.Case, contacts: mr.Contacts) -> mr.Response:
        return mr.simulate(case, contacts, accuracy=FINER)

    def stronger(case: mr.Case, contacts: mr.Contacts) -> mr.Response:
        assert case.motion is not None
        return mr.simulate(replace(case, motion=case.motion.scaled(1 + STRONGER)), contacts)

    ways: dict[str, Callable[[mr.Case, mr.Contacts], mr.Response]] = {
        f"at an accuracy of {FINER:g}": finer,
        "by explicit steps": mr.solve_explicit,
        f"under records {STRONGER:g} stronger": stronger,
    }
    runs = [suite.analysis(FIGURE_3, suite.to_peak(motion, pga), "MuJoCo", k_n=K_N) for motion in motions]
    sentences = []
    for name, solve in ways.items():
        bar = tqdm(runs, desc=name, disable=None, leave=False)
        ends = [solve(run.case, run.contacts).outcome is mr.Outcome.OVERTURNED for run in bar]
        others = sum(end != own for end, own in zip(ends, fell, strict=True))
        sentences.append(f"{others} end otherwise {name}, where {np.mean(ends):.3f} overturn")
    head = f"MuJoCo at {pga:g} g: {np.mean(fell):.3f} of {len(runs)} runs overturn"
    return "; ".join([head, *sentences])


def main(argv: Sequence[str] | None = None) -> None:
    """Run every record at every intensity, fit, draw and print."""
    args = suite.parser(__doc__, "fragility").parse_args(argv)
    out = cli.folder(args.out)
    records = suite.motions(args, 40, quick=8)
    motions = [polarity for motion in records for polarity in motion.polarities]
    levels = np.linspace(0.6, 0.9, 3) if args.quick else np.linspace(0.3, 1.2, 13)

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
    checked, count = int(np.abs(levels - CHECKED).argmin()), 1 if args.quick else len(motions)
    sentences = again(motions[:count], float(levels[checked]), fell[1, :count, checked].tolist())
    text = f"{cli.table(header, rows)}\n\n{sentences}"
    cells = [
        (f"{level:.4f}", *(f"{share:.4f}" for share in own))
        for level, own in zip(levels, fell.mean(axis=1).T, strict=True)
    ]
    header = ["PGA [g]", *(f"share overturned, {plotting.STYLES[s]['label']} [-]" for s in SOLVERS)]
    cli.report(out / "fragility", text, header, cells)


if __name__ == "__main__":
    sys.exit(cli.run(main))
