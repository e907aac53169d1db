"""Bridge, arches and vaults that stand: a picture, the push over g that each bears, and the thrust of a groin vault.

python scripts/studies/vaults.py --out docs/figures
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli

FRICTION = 0.7
groin_vault = partial(mr.Masonry.groin_vault, 2.0, 0.3, length=4.1, unit=0.8, span_angle=2.4, courses=9)
"""Two barrels over a bay of 4.1 m."""
VIEWS = [("barrel vault", (25, 35)), ("groin vault", (25, 35)), ("groin vault", (-30, 35))]
"""What is drawn in space, and its camera."""
AROUND = 0.2
"""What is drawn around arches [m]."""


def main(argv: Sequence[str] | None = None) -> None:
    """Build, draw and push them."""
    out = cli.folder(cli.parser(__doc__, "out/vaults").parse_args(argv).out)
    arches = {
        "bridge of three spans": mr.Masonry.bridge(
            4.0, 0.5, 2.4, 13, spans=3, pier_width=1.5, pier_height=3.0, friction=FRICTION
        ),
        "arch on buttresses": mr.Masonry.bridge(
            3.0, 0.45, voussoirs=20, pier_width=1.6, pier_height=3.0, abutments=False, friction=FRICTION
        ),
        "tapered arch": mr.Masonry.arch(3.0, (0.6, 0.3), voussoirs=15, friction=FRICTION),
        "arch of curved voussoirs": mr.Masonry.arch(3.0, 0.45, voussoirs=7, chords=4, friction=FRICTION),
    }
    vaults = {
        "barrel vault": mr.Masonry.barrel_vault(2.0, 0.4, 3.0, 1.0, 2.8, 9, friction=FRICTION),
        "groin vault": groin_vault(friction=FRICTION),
        "groin vault with cut groins": groin_vault(cut=True, friction=FRICTION),
    }
    lines = []
    for name, each in (arches | vaults).items():
        bears = mr.collapse_multiplier(each).multiplier
        lines.append(
            f"{name}: {len(each.free)} blocks, {len(each.joints)} joints, bears a push of {bears:.3f} g along x"
        )
    lines += [f"{name}: {thrust_of(vault)}" for name, vault in vaults.items() if name.startswith("groin")]
    figure = Figure(figsize=(7.4, 6.2), layout="constrained")
    rows = figure.add_gridspec(3, 1, height_ratios=[0.9, 0.8, 1.2])
    upper, middle, lower = rows[0].subgridspec(1, 2, width_ratios=[2.6, 1.0]), rows[1].subgridspec(1, 2), rows[2]
    places = [upper[0], upper[1], middle[0], middle[1]]
    for place, (name, each) in zip(places, arches.items(), strict=True):
        ax = figure.add_subplot(place)
        corners = np.concatenate([each.blocks[i].corners for i in each.free])
        limits = np.array([corners.min(axis=0) - AROUND, corners.max(axis=0) + AROUND]).T
        plotting.blocks(ax, each, joints=False, limits=limits)
        ax.set_title(name, fontsize=10)
        ax.axis("off")
    lowest = lower.subgridspec(1, len(VIEWS))
    for i, (name, camera) in enumerate(VIEWS):
        ax = figure.add_subplot(lowest[i], projection="3d")
        plotting.blocks(ax, vaults[name], joints=False, camera=camera)
        ax.set_title(name if camera[0] > 0 else f"{name} from below", fontsize=10, y=0.92)
    plotting.save(figure, out / "vaults.png")
    cli.report(out / "vaults", "\n".join(lines))


def thrust_of(vault: mr.Masonry) -> str:
    """What a groin vault weighs, what a pier bears at rest, and the thrust and the push across the corners."""
    weight = sum(vault.blocks[i].mass for i in vault.free) * mr.GRAVITY
    rest = mr.solve_explicit(mr.MasonryCase(vault, 0.002), forces=True, output_step=0.001)
    x, y, z = np.abs(rest.reactions["pier_front_right"][-1])
    across = mr.collapse_multiplier(vault, angle=math.pi / 4).multiplier
    return (
        f"weighs {weight / 1e3:.2f} kN; a pier bears {z / 1e3:.2f} kN and a thrust of {x / 1e3:.2f} kN along x and "
        f"{y / 1e3:.2f} kN along y; bears a push of {across:.3f} g across the corners"
    )


if __name__ == "__main__":
    sys.exit(cli.run(main))
