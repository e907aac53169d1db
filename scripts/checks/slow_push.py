"""Six walls of the literature by a slow push in explicit steps, beside limit analysis without dilatancy.

The walls are those of `limit_analysis`. A horizontal force in proportion to the weight of each block moves the centroid
of all blocks by 10 mm. Joints have k_n = k_s = 1e10 N/m3, and nothing is fitted. Prints the
largest multiplier of each wall beside the published one, and draws the curves.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from scripts.checks.limit_analysis import PUBLISHED, wall
from scripts.shared import cli
from scripts.shared.labels import beside

FAR = 0.01
"""Displacement to which the walls are pushed [m]."""
BELOW = {1: 4, 2: -4, 4: 2, 5: -4}
"""How far the name of a wall stands above the end of its curve [pt]."""
INERTIA = 0.0025
"""Forces of inertia that are allowed, over the largest force [-]."""


def drawn(found: dict[int, mr.Push]) -> Figure:
    """The curves, and the published multipliers as broken lines."""
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    ax = figure.subplots()
    for i, (number, push) in enumerate(found.items()):
        colour = (*plotting.PALETTE, "0.5")[i % 6]
        ax.plot(1e3 * push.displacement, push.force, color=colour)
        ax.axhline(PUBLISHED[number][1], color=colour, linestyle="--", linewidth=0.8)
        beside(ax, (1e3 * FAR, float(push.force[-1])), f"wall {number}", colour, (4, BELOW.get(number, 0)))
    ax.plot([], [], color="0.4", label="slow push, explicit steps")
    ax.plot([], [], color="0.4", linestyle="--", linewidth=0.8, label="published, limit analysis without dilatancy")
    ax.set(
        xlabel="mean displacement of the blocks [mm]",
        ylabel="force over weight [-]",
        xlim=(0, 1e3 * FAR),
        ylim=(0, 0.85),
    )
    ax.legend(frameon=False, fontsize=8, loc="upper right")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Push, print the table and draw."""
    args = cli.parser(__doc__, "slow_push").parse_args(argv)
    out, found, rows = cli.folder(args.out), dict[int, mr.Push](), list[list[object]]()
    for number in tqdm([1] if args.quick else list(PUBLISHED), desc="walls", disable=None, leave=False):
        masonry, published, begun = wall(number), PUBLISHED[number][1], time.process_time()
        found[number] = mr.push(masonry, 1, 0.03 * FAR if args.quick else FAR, inertia=0.01 if args.quick else INERTIA)
        peak = found[number].peak
        cells = [number, len(masonry.free), published, f"{peak:.4f}", f"{peak / published - 1:+.1%}"]
        rows.append([*cells, f"{found[number].inertia_share:.2%}", f"{time.process_time() - begun:.0f}"])
    plotting.save(drawn(found), out / "slow_push.png")
    header = ["wall", "blocks", "without dilatancy, published", "slow push", "error", "inertia", "processor [s]"]
    cli.report(out / "slow_push", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
