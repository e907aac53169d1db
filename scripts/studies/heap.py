"""A wall in running bond under a strong sine, by explicit steps: it slides, falls, and lies in a heap.

Blocks that leave their joints meet the ground and each other. Draws the wall at six times, and prints how many blocks
fall and how well the books of energy close through the collapse.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import figure_of_panels
from scripts.shared import cli

UNIT = (0.5, 0.25)
AMPLITUDE, PERIOD = 12.0, 0.8
"""Of the sine [m/s2, s]."""
FRAMES = 6


def heap(length: float, height: float, duration: float) -> mr.Response:
    """The run of a wall of some length and height [m]."""
    wall = mr.Masonry.running_bond(length, height, UNIT, k_n=1e9, friction=0.6)
    case = mr.MasonryCase(wall, duration, mr.GroundMotion.sine(AMPLITUDE, PERIOD))
    return mr.solve_explicit(case, ledger=True)


def drawn(answer: mr.Response) -> Figure:
    """The wall at some times of its fall, seen from the ground."""
    masonry = answer.of_masonry.masonry
    length, height = np.concatenate([masonry.blocks[i].corners for i in masonry.free]).max(axis=0)
    limits = [(-0.3 * length, 3.6 * length), (-0.3, height + 0.5)]
    figure, axes = figure_of_panels(FRAMES, 2, (3.7, 1.6))
    for ax, row in zip(axes.flat, np.linspace(0, len(answer.t) - 1, FRAMES).astype(int), strict=True):
        plotting.blocks(ax, masonry, answer.pose[row], joints=False, limits=limits)
        ax.set_title(f"{answer.t[row]:.1f} s", fontsize=9)
        ax.axis("off")
    ax = axes.flat[0]
    ax.add_artist(AnchoredSizeBar(ax.transData, 1.0, "1 m", "center", frameon=False, sep=4))
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the study."""
    args = cli.parser(__doc__, "out/heap").parse_args(argv)
    out = cli.folder(args.out)
    answer = heap(1.0, 1.0, 0.5) if args.quick else heap(2.0, 2.0, 4.0)
    assert answer.ledger is not None
    moved = float(np.abs(answer.ledger.kinetic).max())
    gap = float(np.abs(answer.ledger.residual).max())
    text = (
        f"{len(answer.bodies)} blocks, {len(answer.fallen)} fallen by {answer.t[-1]:.1f} s, in "
        f"{answer.stats['steps']} steps of {1e6 * answer.stats['timestep']:.0f} us\n"
        f"largest gap in the books of energy: {gap:.3g} J, {gap / moved:.2%} of the largest kinetic energy\n"
        f"taken by dashpots of encounters {answer.ledger.dashpots['encounters'][-1]:.3g} J, by friction "
        f"{answer.ledger.friction[-1]:.3g} J"
    )
    plotting.save(drawn(answer), out / "heap.png")
    cli.report(out / "heap", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
