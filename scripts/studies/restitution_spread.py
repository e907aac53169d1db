"""What a spread of restitution from impact to impact does to free rocking and to overturning.

The wall of the paper's Figure 3 without a side stop, in rocking theory. e of each impact is drawn about Housner's
(`Restitution.scattered`), with a standard deviation of 0, 0.01 and 0.03. That of the first impact of limestone blocks
is 0.015 to 0.049, with the noise of the readings in it (`limestone_blocks.py`). Prints the peaks of free rocking and
the fragility under synthetic records, and draws both.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array, Flags
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3

SPREADS = (0.0, 0.01, 0.03)
"""Standard deviations of e of one impact [-]."""
SEEDS, RECORDS = 400, 200
"""Runs of free rocking, and ground motions."""
SHOWN = 5
"""Rebounds of which the peaks are printed."""
E = mr.Restitution.from_geometry(FIGURE_3)


def peaks_of(sd: float, seeds: int) -> Array:
    """Peaks of free rocking over that of release, shape (seeds, SHOWN)."""
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 12.0, side_stop=False)
    runs = (mr.solve_analytical(case, E.scattered(sd, seed), rtol=1e-8, output_step=0.1) for seed in range(seeds))
    return np.array([run.peaks[1 : SHOWN + 1] / run.peaks[0] for run in runs])


def overturned(motions: Sequence[mr.GroundMotion], levels: Array, sd: float) -> Flags:
    """Whether the wall overturns, shape (motions, levels)."""
    fell = []
    for i, motion in enumerate(tqdm(motions, desc=f"sd {sd:g}", disable=None, leave=False)):
        for level in levels:
            shaken = suite.to_peak(motion, level)
            case = mr.Case(FIGURE_3, 0.0, motion.duration + suite.SETTLING, side_stop=False, motion=shaken)
            run = mr.solve_analytical(case, E.scattered(sd, i), rtol=1e-8, output_step=0.5)
            fell.append(run.outcome is mr.Outcome.OVERTURNED)
    return np.reshape(fell, (len(motions), len(levels)))


def drawn(peaks: dict[float, Array], fell: dict[float, Flags], fits: Sequence[mr.Fragility], levels: Array) -> Figure:
    """16, 50 and 84 % of the peaks of free rocking, in rows, and fragility."""
    figure = Figure(figsize=(7.4, 3.6), layout="constrained")
    decay, ends = figure.subplots(1, 2)
    for i, (sd, (low, middle, high)) in enumerate(peaks.items()):
        at = np.arange(1, SHOWN + 1) + 0.12 * (i - 1)
        decay.errorbar(
            at, middle, [middle - low, high - middle], fmt="o", color=plotting.PALETTE[i], capsize=3, label=f"sd {sd:g}"
        )
    decay.set(xlabel="rebound", ylabel="peak over release [-],\nmedian and 16 to 84 %", ylim=(0, None))
    for sd, fit, marker in zip(fell, fits, "os^", strict=True):
        plotting.fragility(ends, fit, levels, fell[sd].mean(axis=0), f"sd {sd:g}", marker)
    decay.legend(frameon=False, fontsize=8, title="standard deviation of $e$", title_fontsize=8)
    ends.legend(frameon=False, fontsize=8, title="median, dispersion", title_fontsize=8, loc="lower right")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run every spread, print the table and draw."""
    args = cli.parser(__doc__, "restitution_spread").parse_args(argv)
    out = cli.folder(args.out)
    motions = suite.synthetic(20 if args.quick else RECORDS)
    levels = np.linspace(0.1, 0.9, 9 if args.quick else 17)
    peaks = {sd: peaks_of(sd, 5 if args.quick else SEEDS) for sd in SPREADS}
    fell = {sd: overturned(motions, levels, sd) for sd in SPREADS}
    x, record = np.tile(levels, len(motions)), np.repeat(np.arange(len(motions)), len(levels))
    fits = [mr.fit_fragility(x, own.ravel(), record) for own in fell.values()]
    header = ["sd of e", *(f"peak {i + 1}: 16, 50, 84 %" for i in range(SHOWN))]
    header += ["median PGA [g]", "90 % interval", "dispersion", "fall instead of standing", "stand instead of falling"]
    rows: list[list[object]] = []
    for (sd, found), fit, own in zip(peaks.items(), fits, fell.values(), strict=True):
        parts = [", ".join(f"{x:.3f}" for x in column) for column in np.percentile(found, [16, 50, 84], axis=0).T]
        band = "{:.3f} to {:.3f}".format(*fit.median_interval())
        others = [f"{int(which.sum())} of {own.size}" for which in (own & ~fell[0.0], fell[0.0] & ~own)]
        rows.append([sd, *parts, f"{fit.median:.3f}", band, f"{fit.dispersion:.3f}", *others])
    quantiles = {sd: np.percentile(found, [16, 50, 84], axis=0) for sd, found in peaks.items()}
    plotting.save(drawn(quantiles, fell, fits, levels), out / "restitution_spread.png")
    cli.report(out / "restitution_spread", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
