"""Rocking theory against MuJoCo under earthquakes: how the same runs end and how far they go, by base stiffness.

Walls of Table 1's range, one- and two-sided, under every record in both polarities and several intensities. Each run in
theory is paired with the same run in MuJoCo, on bases of three stiffnesses. Peak rotations are compared by Wilcoxon's
signed rank test on their ratio, outcomes by the exact sign test on the pairs of which one alone overturns. Runs under
one record are not independent of each other, so the share that overturns alike is also given record by record.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import binomtest, wilcoxon

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import power_of_ten
from mjrock.study.campaign.campaign import completed
from scripts.shared import cli, suite
from scripts.shared.pairs import pairs

WALLS = [(5.0, 1.6), (7.0, 2.1), (8.0, 1.4), (10.0, 2.8)]
"""Slenderness h/b [-] and half diagonal R [m]."""
LEVELS = [1.2, 1.8, 2.5, 3.5, 5.0]
"""Peak ground acceleration in multiples of what lifts the wall, g tan(alpha) [-]."""
SIDES = ((1, "one-sided"), (0, "two-sided"))
"""Whether there is a side stop, and how that is called."""
STIFFNESSES = (5e8, 3e9, 3e10)
"""Interface stiffness of base and side [N/m3]: the paper's example, the upper end of Table 1, ten times that."""


def main(argv: Sequence[str] | None = None) -> None:
    """Run every combination, compare, draw and print."""
    args = suite.parser(__doc__, "agreement").parse_args(argv)
    out = cli.folder(args.out)

    def build(side_stop: int, wall: int, motion: mr.GroundMotion, polarity: int, level: float, k_n: float) -> Any:
        block = mr.Block.from_slenderness(*WALLS[wall])
        scaled = suite.to_peak(motion, level * math.tan(block.alpha)).polarities[polarity]
        solver = "MuJoCo" if k_n else "analytical"
        return suite.analysis(block, scaled, solver, k_n=k_n or suite.STIFF, side_stop=bool(side_stop))

    shared: dict[str, Any] = {
        "wall": range(1 if args.quick else len(WALLS)),
        "motion": suite.motions(args, 8, quick=1),
        "level": LEVELS[1:3] if args.quick else LEVELS,
        "k_n": (0.0, *STIFFNESSES),  # zero stands for the rigid base of theory
    }
    polarities = {1: (0, 1), 0: (0,)}  # to a wall without a side stop both are the same
    tasks = [
        task for side, _ in SIDES for task in mr.Grid(build, side_stop=[side], polarity=polarities[side], **shared)
    ]
    found = completed(tasks, out / "agreement.sqlite", workers=args.workers)
    table = []
    for side_stop, title in SIDES:
        for k_n in STIFFNESSES:
            own = of_case(found, side_stop, k_n)
            table.append([title, f"{k_n:.0e}", *compared(*suite.in_pairs(own), [row["motion"] for row in own[::2]])])
    plotting.save(drawn(found), out / "agreement.png")
    columns = ("side_stop", "wall", "motion", "polarity", "level", "k_n", "solver", "outcome", "peak_over_alpha")
    header = [
        "wall", "k_n [N/m3]", "cases", "theory rests/rocks/overturns", "MuJoCo", "overturning alike",
        "record by record", "rests, rocks alike too", "falls in theory alone",
        "in MuJoCo alone", "sign test p", "peak ratio 5/50/95 %", "Wilcoxon p",
    ]  # fmt: skip
    cli.report(out / "agreement", cli.table(header, table), columns, [[row[c] for c in columns] for row in found])


def of_case(found: Sequence[Mapping[str, Any]], side_stop: int, k_n: float) -> list[Mapping[str, Any]]:
    """The runs of theory and of a base."""
    return [row for row in found if row["side_stop"] == side_stop and row["k_n"] in (0.0, k_n)]


def drawn(found: Sequence[Mapping[str, Any]]) -> Figure:
    """Peaks of the same runs in theory and in MuJoCo: a row for each side, a column for each stiffness."""
    figure = Figure(figsize=(7.4, 6.0), layout="constrained")
    axes = figure.subplots(len(SIDES), len(STIFFNESSES), squeeze=False, sharex=True, sharey=True)
    for line, (side_stop, title) in zip(axes, SIDES, strict=True):
        for ax, k_n in zip(line, STIFFNESSES, strict=True):
            _, peaks = suite.in_pairs(of_case(found, side_stop, k_n))
            heading = f"{title}, $k_n$ = {power_of_ten(k_n)} N/m³"
            pairs(ax, peaks, ("theory", "MuJoCo"), (suite.STILL / 3, 1.5), heading)
            ax.label_outer()
    return figure


def compared(ends: Any, peaks: Any, records: Sequence[str]) -> list[object]:
    """The line of the table for pairs of runs, theory first, each under the record named."""
    rocks = (ends == "rocks").all(axis=1)
    ratio = peaks[rocks, 1] / peaks[rocks, 0]
    fell = ends == "overturns"
    alone = [int((fell[:, 0] & ~fell[:, 1]).sum()), int((fell[:, 1] & ~fell[:, 0]).sum())]
    counts = ["/".join(str((column == v).sum()) for v in ("rests", "rocks", "overturns")) for column in ends.T]
    percentiles = np.percentile(ratio, [5, 50, 95]) if ratio.size else []
    alike = fell[:, 0] == fell[:, 1]
    of_record = [alike[np.array(records) == record].mean() for record in dict.fromkeys(records)]
    return [
        len(ends),
        *counts,
        f"{alike.mean():.3f}",
        f"{min(of_record):.3f} to {max(of_record):.3f}",
        f"{(ends[:, 0] == ends[:, 1]).mean():.3f}",
        *alone,
        f"{binomtest(alone[0], sum(alone)).pvalue:.2g}" if sum(alone) else "-",
        " / ".join(f"{r:.3f}" for r in percentiles),
        f"{wilcoxon(np.log(ratio)).pvalue:.1e}" if ratio.size else "-",
    ]


if __name__ == "__main__":
    sys.exit(cli.run(main))
