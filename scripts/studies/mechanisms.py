"""Local mechanisms as blocks: how each moves, and its multiplier by limit analysis beside the closed form.

It draws an arch with its fill under an axle too, at the worst of the places that `mr.design` tries.

python scripts/studies/mechanisms.py --out docs/figures
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli

THICKNESS, HEIGHT = 0.6, 4.0
ANGLE = math.radians(30)
"""Of the cracks of side walls from the vertical."""
LOAD = 20e3


def smooth_cracks(joint: mr.Joint | mr.SpaceJoint) -> float:
    """Friction of a joint: none on a crack."""
    return 0.0 if "rest" in joint.name else 0.7


def overturning(rests: Sequence[mr.Polygon], body: mr.Polygon | mr.Compound) -> mr.Masonry:
    """A body on the ground, in the plane, before what stays of the side walls."""
    corners = [(-0.75 * HEIGHT, -0.4), (HEIGHT, -0.4), (HEIGHT, 0.0), (-0.75 * HEIGHT, 0.0)]
    ground = mr.Polygon(corners, length=4.0, fixed=True, name="ground")
    return mr.Masonry([ground, *rests, body], friction=smooth_cracks)


def simple() -> tuple[mr.Masonry, float]:
    """A wall that overturns."""
    corners = [(0.0, 0.0), (THICKNESS, 0.0), (THICKNESS, HEIGHT), (0.0, HEIGHT)]
    return overturning([], mr.Polygon(corners, length=4.0, name="wall")), THICKNESS / HEIGHT


def composite() -> tuple[mr.Masonry, float]:
    """The same of 4 m with wedges of two side walls, each half as thick; blocks of one length, the wedges lighter."""
    p = HEIGHT * math.tan(ANGLE)
    corners = [(0.0, 0.0), (THICKNESS, 0.0), (THICKNESS, HEIGHT), (0.0, HEIGHT)]
    share = THICKNESS / 4.0
    wedge = mr.Polygon([(0.0, 0.0), (0.0, HEIGHT), (-p, HEIGHT)], density=2000.0 * share, length=4.0)
    rest = mr.Polygon([(0.0, 0.0), (-p, HEIGHT), (-p, 0.0)], length=4.0, fixed=True, name="rest")
    body = mr.Compound([mr.Polygon(corners, length=4.0), wedge], name="facade")
    wall, side = THICKNESS * HEIGHT, share * p * HEIGHT / 2
    alpha_0 = (wall * THICKNESS / 2 + side * (THICKNESS + p / 3)) / (wall * HEIGHT / 2 + side * 2 * HEIGHT / 3)
    return overturning([rest], body), alpha_0


def bending() -> tuple[mr.Masonry, float]:
    """A wall that bends between floors."""
    wall = mr.Block.from_size(THICKNESS, HEIGHT)
    return mr.Masonry.between_floors(wall, LOAD), mr.VerticalBending(wall, LOAD).multiplier


def sideways() -> tuple[mr.Masonry, float]:
    """A strip that bends between side walls."""
    return mr.Masonry.between_sides(STRIP), STRIP.multiplier


def corner() -> tuple[mr.Masonry, float]:
    """A corner that overturns along the diagonal."""
    t, h = THICKNESS, 0.75 * HEIGHT
    p = h * math.tan(ANGLE)
    alpha_0 = (t**2 + p * (1.5 * t + p / 3)) / (math.sqrt(2) * h * (t / 2 + 2 * p / 3))
    return mr.Masonry.corner(t, h, ANGLE), alpha_0


def gable() -> tuple[mr.Masonry, float]:
    """A triangular gable."""
    h = 0.5 * HEIGHT
    corners = [(x, y, z) for x in (-THICKNESS, 0.0) for y, z in ((-1.0, 0.0), (3.5, 0.0), (1.25, h))]
    ground = mr.Polyhedron.box((4.0, 6.0, 0.3), (-0.3, 1.25, -0.15), fixed=True, name="ground")
    return mr.Masonry([ground, mr.Polyhedron(corners, name="gable")], friction=0.7), 1.5 * THICKNESS / h


STRIP = mr.HorizontalBending(mr.Block.from_size(THICKNESS, 1.5, 5.0), thrust=40e3)
"""A strip between side walls, and what these bear."""


MECHANISMS = {
    "simple overturning": (simple, None),
    "composite overturning": (composite, None),
    "vertical bending": (bending, None),
    "horizontal bending": (sideways, 0.0),
    "corner": (corner, -math.pi / 4),
    "gable": (gable, 0.0),
}
"""What is built, and the direction of the push in plan where it is in space [rad]."""


def axles() -> mr.Design:
    """The factor on an axle of 100 kN/m at each place over the arch of docs/wind_earth_axles.md, with its fill."""
    arch = mr.Masonry.arch(radius=5.0, thickness=0.5, span_angle=1.855, voussoirs=25, friction=0.6)
    fill = mr.Fill(max(block.corners[:, 1].max() for block in arch.blocks) + 0.5, density=18e3 / mr.GRAVITY)

    def build(x: float) -> mr.Collapse:
        axle = fill.under(arch, 100e3, at=x, width=0.3)
        return mr.collapse_multiplier(arch, None, loads=axle, effects=fill.on(arch))

    return mr.design(build, np.arange(-4.0, 0.01, 0.25).tolist())


def main(argv: Sequence[str] | None = None) -> None:
    """Push and draw them."""
    out = cli.folder(cli.parser(__doc__, "mechanisms").parse_args(argv).out)
    figure = Figure(figsize=(7.4, 4.4), layout="constrained")
    places = figure.add_gridspec(2, 3)
    lines = []
    for i, (name, (make, angle)) in enumerate(MECHANISMS.items()):
        masonry, alpha_0 = make()
        effects = STRIP.tie if make is sideways else ()
        found = mr.collapse_multiplier(masonry, None if angle is not None else 1, angle=angle, effects=effects)
        lines.append(f"{name}: {found.multiplier:.4f} by limit analysis, {alpha_0:.4f} by the closed form")
        ax = figure.add_subplot(places[i], projection=None if angle is None else "3d")
        plotting.mechanism(ax, found, share=0.06, forces=False)
        if angle is None:
            below = {"bbox_to_anchor": (0.5, 0.0), "bbox_transform": ax.transAxes}
            ax.add_artist(AnchoredSizeBar(ax.transData, 1.0, "1 m", "upper center", frameon=False, sep=4, **below))
        ax.axis("off")
        ax.set_title(f"{name}\n$\\alpha_0$ = {alpha_0:.3f}", fontsize=10)
    plotting.save(figure, out / "mechanisms.png")
    scan = axles()
    plotting.save(plotting.mechanism(scan.least.built, share=0.04), out / "axle.png")
    lines.append(f"an axle of 100 kN/m on an arch with its fill: {scan.sentence}")
    cli.report(out / "mechanisms", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
