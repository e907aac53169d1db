"""A bridge, an arch on buttresses and a barrel vault that stand: a picture, and the push over g that each bears.

python scripts/studies/vaults.py --out docs/figures
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli

FRICTION = 0.7


def main(argv: Sequence[str] | None = None) -> None:
    """Build, draw and push them."""
    out = cli.folder(cli.parser(__doc__, "out/vaults").parse_args(argv).out)
    masonry = {
        "bridge of three spans": mr.Masonry.bridge(
            4.0, 0.5, 2.4, 13, spans=3, pier_width=1.5, pier_height=3.0, friction=FRICTION
        ),
        "arch on buttresses": mr.Masonry.bridge(
            3.0, 0.45, voussoirs=20, pier_width=1.6, pier_height=3.0, abutments=False, friction=FRICTION
        ),
        "barrel vault": mr.Masonry.barrel_vault(2.0, 0.4, 3.0, 1.0, 2.8, 9, friction=FRICTION),
    }
    figure = Figure(figsize=(13, 3.6), layout="constrained")
    lines = []
    grid = figure.add_gridspec(1, 3, width_ratios=[2.2, 1, 1])
    for i, (name, each) in enumerate(masonry.items()):
        ax = figure.add_subplot(grid[i], projection="3d" if each.in_space else None)
        plotting.blocks(ax, each, joints=False)
        ax.set_title(name)
        bears = mr.collapse_multiplier(each).multiplier
        lines.append(
            f"{name}: {len(each.free)} blocks, {len(each.joints)} joints, bears a push of {bears:.3f} g along x"
        )
    plotting.save(figure, out / "vaults.png")
    cli.report(out / "vaults", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
