"""Measured restitution of limestone blocks beside that of theory and of both solvers.

Colombo et al., Experimental dataset on the free-rocking response of masonry blocks (2026, doi 10.60756/uminho-jh25,
CC BY 4.0; Bulletin of Earthquake Engineering, doi 10.1007/s10518-025-02224-8): blocks of 50 mm by 150 mm and 200 to
750 mm in height, which rock freely on a stone. `MEASURED` holds the mean and standard deviation of the first ratio of
angular velocities of each height, calculated from the 134 trials, the one that is there twice counted once. Nothing is
fitted. Housner's ratio is that of `Restitution.from_geometry`. MuJoCo and explicit steps have dashpots by the published
law, and MuJoCo also by the calibrated one, on 3e9 N/m3; the blocks are smaller than the walls of either fit. Release
angles are not among the data, so that all are released at alpha/2.
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

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli

THICK, LONG, DENSITY = 0.05, 0.15, 2238.0
"""Base [m] and density [kg/m3] of every block."""
K_N, HOLDS = 3e9, 2.0
"""Stiffness of the base [N/m3], and how many standard errors off counts as agreement."""


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
LOOKS = (("analytical", "-"), ("MuJoCo", "--"), ("MuJoCo", "o"), ("explicit", "x"))
"""The solver and the line of each."""


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


def drawn(found: Array) -> Figure:
    """The measured means with two standard errors, and the ratios found."""
    figure = Figure(figsize=(7.0, 4.2), layout="constrained")
    ax = figure.subplots()
    groups = MEASURED[: len(found)]
    slender = [one.height / THICK for one in groups]
    bars = [HOLDS * one.error for one in groups]
    ax.errorbar(
        slender,
        [one.mean for one in groups],
        bars,
        fmt="o",
        color="0.2",
        capsize=3,
        label="measured, two standard errors",
    )
    for name, column, (solver, style) in zip(FOUND, found.T, LOOKS, strict=True):
        colour = plotting.STYLES[solver]["color"]
        ax.plot(slender, column, style, color=colour, label=name, markersize=5, markerfacecolor="none")
    ax.set(xlabel="slenderness $h/b$ [-]", ylabel="first ratio of angular velocities [-]")
    ax.legend(frameon=False, fontsize=8)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Compare the ratios of every group, print the table and draw."""
    args = cli.parser(__doc__, "limestone_blocks").parse_args(argv)
    out = cli.folder(args.out)
    groups = MEASURED[:2] if args.quick else MEASURED
    found = np.array([first_ratios(one) for one in groups])
    header = ["h/b", "trials", "measured", "standard error", *FOUND, "measured less Housner, over the error"]
    rows: list[list[object]] = []
    for one, columns in zip(groups, found, strict=True):
        cells = [f"{one.height / THICK:.0f}", one.trials, f"{one.mean:.4f}", f"{one.error:.4f}"]
        rows.append([*cells, *(f"{x:.4f}" for x in columns), f"{(one.mean - columns[0]) / one.error:+.1f}"])
    plotting.save(drawn(found), out / "limestone_blocks.png")
    cli.report(out / "limestone_blocks", cli.table(header, rows) + "\n\n" + judged(found), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
