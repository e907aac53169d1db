"""Measured restitution of limestone blocks beside Housner's, and what a spread of it does to rocking.

Colombo et al., Experimental dataset on the free-rocking response of masonry blocks (2026, doi 10.60756/uminho-jh25,
CC BY 4.0; Bulletin of Earthquake Engineering, doi 10.1007/s10518-025-02224-8): blocks of 50 mm by 150 mm and 200 to
750 mm in height, which rock freely on a stone. `MEASURED` holds the mean and standard deviation of the first ratio of
angular velocities of each height, calculated from the 134 trials, the one that is there twice counted once. Nothing is
fitted. Housner's ratio is that of `Restitution.from_geometry`. MuJoCo and explicit steps have dashpots by the published
law, and MuJoCo also by the calibrated one, on 3e9 N/m3; the blocks are smaller than the walls of either fit. Release
angles are not among the data, so that all are released at alpha/2.

The spread is that of `Restitution.scattered`. `limestone_blocks` has the restitution, `restitution_spread` the peaks of
a wall of the paper's Figure 3 with a spread, and its fragility without a side stop.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import spearmanr
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from mjrock.study.intensity.fragility import fit_fragility
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3

THICK, LONG, DENSITY = 0.05, 0.15, 2238.0
"""Base [m] and density [kg/m3] of every block."""
K_N, HOLDS = 3e9, 2.0
"""Stiffness of the base [N/m3], and how many standard errors off counts as agreement."""
SPREADS = (0.0, 0.01, 0.03)
"""Standard deviations of e of one impact [-]. The measured ones, 0.015 to 0.049, hold the noise of the readings too: 22
of the 134 ratios are above 1."""
SEEDS, RECORDS = 200, 60
"""Runs with a spread, and ground motions."""
SHOWN = 6
"""Rebounds of which the peaks are printed."""


class Group(NamedTuple):
    """Trials of one height: height [m], trials, mean and standard deviation of the first ratio [-], trials within 0.04
    of Housner's ratio, and trials of a ratio above 1."""

    height: float
    trials: int
    mean: float
    sd: float
    near: int
    above: int

    @property
    def error(self) -> float:
        """Standard error of the mean [-]."""
        return self.sd / math.sqrt(self.trials)


MEASURED = (
    Group(0.20, 12, 0.9401, 0.0370, 8, 1),
    Group(0.25, 10, 0.9397, 0.0486, 5, 1),
    Group(0.30, 12, 0.9319, 0.0419, 7, 1),
    Group(0.35, 9, 0.9616, 0.0343, 7, 2),
    Group(0.40, 11, 0.9539, 0.0304, 9, 0),
    Group(0.45, 12, 0.9729, 0.0265, 10, 1),
    Group(0.50, 13, 0.9827, 0.0191, 13, 2),
    Group(0.55, 10, 0.9677, 0.0360, 6, 1),
    Group(0.60, 8, 0.9960, 0.0153, 8, 3),
    Group(0.65, 13, 0.9964, 0.0283, 10, 7),
    Group(0.70, 13, 0.9466, 0.0429, 7, 1),
    Group(0.75, 11, 0.9712, 0.0298, 9, 2),
)
FOUND = ("Housner", "MuJoCo, published law", "MuJoCo, calibrated law", "explicit, published law")


def first_ratios(group: Group) -> tuple[float, ...]:
    """The first ratio of angular velocities by each of `FOUND` [-]."""
    block = mr.Block.from_size(thickness=THICK, height=group.height, length=LONG, density=DENSITY)
    e = mr.Restitution.from_geometry(block)
    case = mr.Case(block, 0.5 * block.alpha, 1.5, side_stop=False)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*outside the range of the fit", UserWarning)
        published, calibrated = (
            mr.Contacts.from_law(block, e, k_base=K_N, k_side=None, law=law) for law in ("PUBLISHED", "CALIBRATED")
        )
    runs = mr.simulate(case, published), mr.simulate(case, calibrated), mr.solve_explicit(case, published)
    return (e.base, *(float(run.restitution[0]) for run in runs))


def judged(found: Array) -> str:
    """How the means of the groups compare with each column of `first_ratios`, shape (groups, columns)."""
    groups = MEASURED[: len(found)]
    means, errors = np.array([one.mean for one in groups]), np.array([one.error for one in groups])
    trials, lines = np.array([one.trials for one in groups]), []
    for name, column in zip(FOUND, found.T, strict=True):
        off = (means - column) / errors
        rank = f", ranks {spearmanr(column, means).statistic:.2f}" if len(groups) > 2 else ""
        lines.append(
            f"{name}: {int((np.abs(off) < HOLDS).sum())} of {len(groups)} groups within two standard errors{rank}, "
            f"measured less found {np.average(means - column, weights=trials):+.4f} over all trials"
        )
    near, above, count = (sum(getattr(one, name) for one in groups) for name in ("near", "above", "trials"))
    return "\n".join([*lines, f"{near} of {count} trials within 0.04 of Housner's ratio; {above} above 1"])


def restitution_drawn(found: Array) -> Figure:
    """The measured means with two standard errors, and the ratios found."""
    figure = Figure(figsize=(7.0, 4.2), layout="constrained")
    ax = figure.subplots()
    groups = MEASURED[: len(found)]
    slender = [one.height / THICK for one in groups]
    bars = [HOLDS * one.error for one in groups]
    ax.errorbar(
        slender, [one.mean for one in groups], bars, fmt="o", color="0.2", capsize=3, label="measured, two standard errors"
    )
    for name, column, style in zip(FOUND, found.T, ("k-", "C0--", "C0o", "C1x"), strict=True):
        ax.plot(slender, column, style, label=name, markersize=5, markerfacecolor="none")
    ax.set(xlabel="slenderness h/b [-]", ylabel="first ratio of angular velocities [-]")
    ax.legend(frameon=False, fontsize=8)
    return figure


def peaks_of(e: mr.Restitution, sd: float, seeds: int) -> Array:
    """Peaks over that of release of free rocking of the wall of Figure 3, shape (seeds, SHOWN)."""
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 12.0, side_stop=False)
    runs = (mr.solve_analytical(case, e.scattered(sd, seed), rtol=1e-8, output_step=0.1) for seed in range(seeds))
    return np.array([run.peaks[1 : SHOWN + 1] / run.peaks[0] for run in runs])


def overturned(motions: Sequence[mr.GroundMotion], levels: Array, sd: float) -> Array:
    """Whether the wall of Figure 3, without a side stop, overturns, shape (motions, levels)."""
    e, fell = mr.Restitution.from_geometry(FIGURE_3), []
    for i, motion in enumerate(tqdm(motions, desc=f"sd {sd:g}", disable=None, leave=False)):
        for level in levels:
            shaken = suite.to_peak(motion, level)
            case = mr.Case(FIGURE_3, 0.0, motion.duration + suite.SETTLING, side_stop=False, motion=shaken)
            run = mr.solve_analytical(case, e.scattered(sd, i), rtol=1e-8, output_step=case.duration)
            fell.append(run.outcome is mr.Outcome.OVERTURNED)
    return np.reshape(fell, (len(motions), len(levels)))


def spread_drawn(peaks: dict[float, Array], fell: dict[float, Array], levels: Array, fits: Sequence[mr.Fragility]) -> Figure:
    """Peaks of free rocking with their 16 and 84 %, and fragility."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    decay, ends = figure.subplots(1, 2)
    for i, (sd, found) in enumerate(peaks.items()):
        low, middle, high = np.percentile(found, [16, 50, 84], axis=0)
        bars = [middle - low, high - middle]
        at = np.arange(1, SHOWN + 1) + 0.12 * (i - 1)
        decay.errorbar(at, middle, bars, fmt="o", color=f"C{i}", capsize=3, label=f"sd {sd:g}")
    decay.set(xlabel="rebound", ylabel="peak over release [-], median and 16 to 84 %")
    for i, (sd, fit) in enumerate(zip(fell, fits, strict=True)):
        plotting.fragility(ends, fit, levels, fell[sd].mean(axis=0), f"sd {sd:g}", "os^"[i])
    for ax in (decay, ends):
        ax.legend(frameon=False, fontsize=8)
    return figure


def spread(args_quick: bool) -> tuple[str, Figure, list[str], list[list[object]]]:
    """The study of a spread: what is printed, its picture, and its table."""
    e = mr.Restitution.from_geometry(FIGURE_3)
    motions = suite.motions(None, 4 if args_quick else RECORDS)
    levels = np.linspace(0.4, 1.6, 4 if args_quick else 13)
    peaks = {sd: peaks_of(e, sd, 5 if args_quick else SEEDS) for sd in SPREADS}
    fell = {sd: overturned(motions, levels, sd) for sd in SPREADS}
    fits = [fit_fragility(levels, own.mean(axis=0) * len(own), len(own)) for own in fell.values()]
    header = ["sd of e", *(f"peak {i + 1}: 16, 50, 84 %" for i in range(SHOWN)), "median PGA [g]", "dispersion"]
    header += ["runs that end otherwise"]
    rows: list[list[object]] = []
    for (sd, found), fit, own in zip(peaks.items(), fits, fell.values(), strict=True):
        parts = [", ".join(f"{x:.3f}" for x in column) for column in np.percentile(found, [16, 50, 84], axis=0).T]
        others = f"{int((own != fell[0.0]).sum())} of {own.size}"
        rows.append([sd, *parts, f"{fit.median:.3f}", f"{fit.dispersion:.3f}", others])
    return cli.table(header, rows), spread_drawn(peaks, fell, levels, fits), header, rows


def main(argv: Sequence[str] | None = None) -> None:
    """Compare the restitution, study a spread of it, print the tables and draw."""
    args = cli.parser(__doc__, "limestone_blocks").parse_args(argv)
    out = cli.folder(args.out)
    groups = MEASURED[:2] if args.quick else MEASURED
    found = np.array([first_ratios(one) for one in groups])
    header = ["h/b", "trials", "measured", "standard error", *FOUND, "measured less Housner, over the error"]
    rows: list[list[object]] = []
    for one, columns in zip(groups, found, strict=True):
        cells = [f"{one.height / THICK:.0f}", one.trials, f"{one.mean:.4f}", f"{one.error:.4f}"]
        rows.append([*cells, *(f"{x:.4f}" for x in columns), f"{(one.mean - columns[0]) / one.error:+.1f}"])
    plotting.save(restitution_drawn(found), out / "limestone_blocks.png")
    cli.report(out / "limestone_blocks", cli.table(header, rows) + "\n\n" + judged(found), header, rows)
    text, figure, header, rows = spread(args.quick)
    plotting.save(figure, out / "restitution_spread.png")
    cli.report(out / "restitution_spread", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
