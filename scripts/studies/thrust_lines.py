"""Lines of thrust by explicit steps: an arch of nearly the least thickness, one whose support has moved, and a wall.

Prints where the line of the first arch touches its outlines, which theory says too, and what the spread has left of the
thrust of the second.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.labels import without_axes

RADIUS, SPREAD = 5.0, 0.1
"""Radius of the arches and displacement of the support of the second [m]."""
THIN, THICK = 0.11, 0.15
"""Thickness of the two arches over their radius [-]."""


def thin_arch(voussoirs: int) -> mr.Response:
    """An arch at rest whose thickness is nearly the least."""
    arch = mr.Masonry.arch(RADIUS, THIN * RADIUS, voussoirs=voussoirs, k_n=1e11, k_s=1e11)
    return mr.solve_explicit(mr.MasonryCase(arch, 1e-3), forces=True)


def spread_arch(voussoirs: int) -> mr.Response:
    """An arch whose right support moves outwards within a second."""
    arch = mr.Masonry.arch(RADIUS, THICK * RADIUS, voussoirs=voussoirs)
    t = np.linspace(0.0, 1.0, 201)
    way = SPREAD * (0.5 - 0.5 * np.cos(np.pi * t))
    case = mr.MasonryCase(arch, 1.5, supports={"right_abutment": (t, way, 0.0 * t)})
    return mr.solve_explicit(case, forces=True)


def shaken_wall(length: float) -> mr.Response:
    """A wall in running bond under a sine."""
    wall = mr.Masonry.running_bond(length, 1.6, (0.4, 0.2), k_n=1e9, k_s=4e8, friction=0.6)
    return mr.solve_explicit(mr.MasonryCase(wall, 0.5, mr.GroundMotion.sine(3.0, 0.5)), forces=True)


def touches(answer: mr.Response) -> str:
    """Where the line of thrust is nearest to the outlines, in words."""
    forces = answer.forces
    place = forces.frames.middle + forces.eccentricity[0][:, None] * forces.frames.axes[:, 1]
    angle = np.degrees(np.arctan2(place[:, 0], place[:, 1]))
    share = (np.hypot(*place.T) - RADIUS) / (THIN * RADIUS)
    crown, lowest = int(np.argmin(np.abs(angle))), int(np.argmin(share))
    return (
        f"distance from the middle line over the thickness: {share[crown]:.3f} at the crown, {share[0]:.3f} at a "
        f"springing, least {share[lowest]:.3f} at {abs(angle[lowest]):.0f} degrees from the crown"
    )


def main(argv: Sequence[str] | None = None) -> None:
    """Run the study."""
    args = cli.parser(__doc__, "out/thrust_lines").parse_args(argv)
    out = cli.folder(args.out)
    thin, spread = thin_arch(20 if args.quick else 60), spread_arch(11 if args.quick else 15)
    wall = shaken_wall(1.2 if args.quick else 2.4)
    figure = Figure(figsize=(7.4, 2.4), layout="constrained")
    times = ("at rest", 0.0, thin), (f"support {SPREAD:g} m apart", None, spread), ("sine, 0.1 s", 0.1, wall)
    for ax, (title, at, answer) in zip(figure.subplots(1, 3), times, strict=True):
        plotting.thrust(ax, answer, at=at)
        ax.set_title(title, fontsize=10)
        without_axes(ax)
    plotting.save(figure, out / "thrust_lines.png")
    thrust = spread.reactions["left_abutment"][[0, -1], 0] / 1e3
    cli.report(
        out / "thrust_lines",
        f"t/R = {THIN:g}, {touches(thin)}\n"
        f"t/R = {THICK:g}, thrust at rest {thrust[0]:.1f} kN, support {SPREAD:g} m apart {thrust[1]:.1f} kN",
    )


if __name__ == "__main__":
    sys.exit(cli.run(main))
