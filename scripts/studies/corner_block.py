"""A block that rocks about a corner of its base: the energy that the impact leaves it, against stiffness and damping.

The block has a square base of 0.5 m and is 2 m high, 2000 kg/m3. It is set turning about one corner, along the
diagonal, rises to a quarter of the angle that overturns it, comes back, and rises about the opposite corner. The share
of the energy is that of the second peak over the first. About an edge rocking theory gives (1 - 3/2 sin^2 alpha)^2
(Housner). About a corner conservation of angular momentum gives two bounds, since it does not say how the impulse is
shared between the corners: all of it at the far corner, or first at the two side corners and then at the far one.
The damping is c = retardation x k: the retardation is c/k [s]. mu = 1, k_s = None. A block that is set turning about a
corner at 20 degrees from the diagonal also turns about the vertical, which the last table gives.
Writes corner_block.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import argrelmax

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import OWN
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.labels import SMALL

SIDE, HEIGHT = 0.5, 2.0
STIFFNESSES = (1e8, 1e9, 1e10, 1e11)
"""k_n [N/m3]."""
RETARDATIONS = (1e-4, 1e-3, 1e-2)
"""c/k [s]."""
AROUND = [(-0.32, 0.32), (-0.32, 0.32), (0.0, 2.1)]
"""What is drawn around the block [m]."""
RISE = 0.25
"""Largest rotation of the first flight, over that which overturns the block [-]."""
DURATION, SPACING, SHARE = 1.6, 1e-3, 0.1
"""Time that is followed, spacing of the samples [s], and step over the longest stable one [-]."""
ASKEW = math.radians(20)


def block(k_n: float, retardation: float) -> mr.Masonry:
    """The block on its ground."""
    return mr.Masonry.box((SIDE, SIDE, HEIGHT), k_n=k_n, friction=1.0, xi=0.5 * retardation, frequency=1.0)


def set_turning(masonry: mr.Masonry, arm: Array, along: Array) -> mr.Response:
    """The block turning about a point of its base, in a direction of plan.

    Args:
        masonry: the block.
        arm: from the middle of the base to the point in plan [m].
        along: unit vector in plan towards which the top moves.
    """
    body = masonry.blocks[1]
    radius = np.array([-arm[0], -arm[1], 0.5 * HEIGHT])
    spin = np.array([-along[1], along[0], 0.0])
    about = spin @ body.inertia @ spin + body.mass * np.sum(np.cross(spin, radius) ** 2)
    reach = math.hypot(arm @ along, 0.5 * HEIGHT)
    alpha = math.atan2(arm @ along, 0.5 * HEIGHT)
    lift = reach * (math.cos((1 - RISE) * alpha) - math.cos(alpha))
    rate = math.sqrt(2 * body.mass * mr.GRAVITY * lift / about) * spin
    velocity = [(*np.cross(rate, radius), *rate)]
    stable = mr.solve_explicit(mr.MasonryCase(masonry, 1e-5)).stats["stable_timestep"]
    h = SPACING / np.ceil(SPACING / (SHARE * stable))
    return mr.solve_explicit(mr.MasonryCase(masonry, DURATION, velocity=velocity), timestep=h, output_step=SPACING)


def kept(masonry: mr.Masonry, arm: Array, along: Array) -> float:
    """Energy at the second peak of the tilt over that at the first [-]."""
    answer = set_turning(masonry, arm, along)
    tilt = answer.tilt[:, 0]
    peaks = [i for i in argrelmax(tilt, order=60)[0] if tilt[i] > 0.1 * tilt.max()]
    return float(answer.energy[peaks[1]] / answer.energy[peaks[0]])


def bounds() -> tuple[float, float, float]:
    """Share of the energy after an impact on an edge, and the lower and upper bound of that on a corner [-]."""
    edge = math.atan2(SIDE, HEIGHT)
    body = mr.Polyhedron.box((SIDE, SIDE, HEIGHT))
    about = body.inertia[0, 0] + body.mass * (0.5 * SIDE * SIDE + 0.25 * HEIGHT**2)
    moved = body.mass * 0.5 * SIDE**2
    return (
        (1 - 1.5 * math.sin(edge) ** 2) ** 2,
        ((about - 2 * moved) / about) ** 2,
        ((about - moved) / about) ** 2,
    )


def drawn(shares: dict[float, list[float]], stiffnesses: Sequence[float], answer: mr.Response) -> Figure:
    """The block on its corner, and the share of the energy over the stiffness."""
    figure = Figure(figsize=(7.4, 3.8), layout="constrained")
    grid = figure.add_gridspec(1, 2, width_ratios=(1, 2))
    solid = figure.add_subplot(grid[0], projection="3d")
    at = int(argrelmax(answer.tilt[:, 0], order=60)[0][0])
    plotting.blocks(solid, answer.of_masonry.masonry, answer.pose[at], camera=(12.0, -40.0), limits=AROUND)
    ax = figure.add_subplot(grid[1])
    for (retardation, values), look, marker in zip(shares.items(), OWN, "vso", strict=False):
        label = f"{1e3 * retardation:g} ms"
        ax.plot(stiffnesses, values, **look | {"label": label, "marker": marker, "markerfacecolor": "none"})
    edge, low, high = bounds()
    ax.axhspan(low, high, color="0.92")
    ax.text(stiffnesses[0], low, " bounds of theory for a corner", fontsize=SMALL, va="bottom", color="0.3")
    ax.axhline(edge, color="0.5", linestyle="-.", linewidth=0.8)
    ax.text(stiffnesses[0], edge, " about an edge,\n Housner", fontsize=SMALL, va="top", color="0.3")
    ax.set_xscale("log")
    ax.set_xlabel(r"stiffness of the joint $k_n$ [N/m$^3$]")
    ax.set_ylabel("energy after a corner impact\nover that before [-]")
    ax.legend(frameon=False, fontsize=SMALL, title="dashpot over spring, $c/k$", title_fontsize=SMALL)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Measure every impact, draw and print."""
    args = cli.parser(__doc__, "corner_block").parse_args(argv)
    out = cli.folder(args.out)
    stiffnesses, retardations = (STIFFNESSES[:2], RETARDATIONS[:1]) if args.quick else (STIFFNESSES, RETARDATIONS)
    half, diagonal = 0.5 * SIDE, np.array([math.sqrt(0.5), math.sqrt(0.5)])
    corner, side = np.array([half, half]), np.array([half, 0.0])
    shares, edges = {}, {}
    for retardation in retardations:
        blocks = [block(k_n, retardation) for k_n in stiffnesses]
        shares[retardation] = [kept(masonry, corner, diagonal) for masonry in blocks]
        edges[retardation] = [kept(masonry, side, np.array([1.0, 0.0])) for masonry in blocks]
    along = np.array([math.cos(0.25 * math.pi - ASKEW), math.sin(0.25 * math.pi - ASKEW)])
    masonry = block(stiffnesses[-1], retardations[-1])
    askew = set_turning(masonry, corner, along)
    plotting.save(drawn(shares, stiffnesses, set_turning(masonry, corner, diagonal)), out / "corner_block.png")
    header = ["about", "c/k [s]", *(f"k_n = {k_n:.0e} N/m3" for k_n in stiffnesses)]
    rows = [
        [name, f"{retardation:g}", *(f"{value:.3f}" for value in values)]
        for name, table in (("a corner", shares), ("an edge", edges))
        for retardation, values in table.items()
    ]
    edge, low, high = bounds()
    yaw = 2 * np.degrees(np.arctan2(askew.pose[:, 0, 6], askew.pose[:, 0, 3]))
    at = [int(np.searchsorted(askew.t, t)) for t in (0.4, 0.8, 1.2, 1.6)]
    turned = cli.table(
        ["t [s]", "tilt [deg]", "about the vertical [deg]"],
        [[f"{askew.t[i]:.1f}", f"{np.degrees(askew.tilt[i, 0]):.2f}", f"{yaw[i]:.2f}"] for i in at if i < len(yaw)],
    )
    text = f"share of the energy that an impact leaves; an edge: {edge:.4f}, a corner: {low:.4f} to {high:.4f}\n"
    text += cli.table(header, rows) + f"\n\nset turning {np.degrees(ASKEW):.0f} degrees off the diagonal:\n{turned}"
    cli.report(out / "corner_block", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
