"""The damping law in space: what a block loses when it rocks on its base, in the plane and as a prism in space.

A block of 0.6 m x 4.2 m, 1 m long, 2000 kg/m3, stands on a joint of k_n = 1e9 N/m3 with the damping of the calibrated
law, as `Contacts.from_law` and `Masonry(law=...)` give it, in the plane and in space. The
block is set turning about its edge so that it rises to 0.3 alpha, and rocks. `points` are the lines of the joint in
the plane, and in space its corners or a grid of points x points. Given is the share of the energy that each of the
first impacts leaves, from the energy at successive peaks of the rotation, beside e^2 of theory.
Writes law_in_space.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure
from scipy.signal import argrelmax

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli

WALL = mr.Block.from_size(thickness=0.6, height=4.2)
K_N, FRICTION = 1e9, 0.7
POINTS = {2: "CALIBRATED", 16: "CALIBRATED_BED"}
"""Points of a joint, and the law for so many lines."""
RISE, DURATION, IMPACTS, SPACING, SHARE = 0.3, 5.0, 3, 1e-3, 0.1
"""First peak over alpha [-], time that is followed [s], impacts that are shown, spacing of samples [s], share of the
longest stable step that is taken [-]."""


def in_plane(points: int) -> mr.Masonry:
    """The block on its ground, with the law."""
    return mr.Masonry.stack([WALL], K_N, law=POINTS[points], points=points, friction=FRICTION)


def in_space(plane: mr.Masonry) -> mr.Masonry:
    """The same as prisms."""
    prisms = tuple(mr.Polyhedron.prism(block) for block in plane.blocks if isinstance(block, mr.Polygon))
    return mr.Masonry(prisms, K_N, FRICTION, law=plane.law, points=plane.points)


def set_rocking(masonry: mr.Masonry, duration: float) -> mr.Response:
    """The block turning about the edge of its base."""
    lift = WALL.R * (math.cos((1 - RISE) * WALL.alpha) - math.cos(WALL.alpha))
    rate = math.sqrt(2 * WALL.mass * mr.GRAVITY * lift / (WALL.inertia + WALL.mass * WALL.R**2))
    velocity = [
        (rate * WALL.h, 0, rate * WALL.b, 0, rate, 0) if masonry.in_space else (rate * WALL.h, rate * WALL.b, rate)
    ]
    stable = mr.solve_explicit(mr.MasonryCase(masonry, 1e-5)).stats["stable_timestep"]
    h = SPACING / np.ceil(SPACING / (SHARE * stable))
    return mr.solve_explicit(mr.MasonryCase(masonry, duration, velocity=velocity), timestep=h, output_step=SPACING)


def kept(answer: mr.Response) -> list[float]:
    """Share of the energy that each impact leaves [-]."""
    tilt = answer.tilt[:, 0]
    energy = answer.energy[argrelmax(tilt, order=30)[0]]
    return [float(after / before) for before, after in pairwise(energy[: IMPACTS + 1])]


def drawn(answers: dict[str, mr.Response]) -> Figure:
    """Rotation over time in the plane, and how far the block in space is off it."""
    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    names, tilts = list(answers), [answer.tilt[:, 0] / WALL.alpha for answer in answers.values()]
    for i, colour in zip(range(0, len(names), 2), plotting.PALETTE, strict=False):
        plane, space = tilts[i], tilts[i + 1]
        t = answers[names[i]].t
        above.plot(t, plane, color=colour, label=names[i].removeprefix("plane ") + " of the plane")
        below.plot(t, 1e3 * (space - plane), color=colour, linewidth=1.0)
    above.set(ylabel=r"tilt over $\alpha$ [-]")
    above.set_ylim(top=1.3 * above.get_ylim()[1])
    above.legend(frameon=False, fontsize=8, ncols=2)
    below.set(xlabel="time $t$ [s]", ylabel="space less\nplane [10$^{-3}$]")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Rock every block, draw and print."""
    args = cli.parser(__doc__, "law_in_space").parse_args(argv)
    out = cli.folder(args.out)
    answers = {}
    for points in list(POINTS)[: 1 if args.quick else 2]:
        plane = in_plane(points)
        for name, masonry in (
            (f"plane {points} lines", plane),
            (f"space {points} x {points} points", in_space(plane)),
        ):
            answers[name] = set_rocking(masonry, 0.2 if args.quick else DURATION)
    plotting.save(drawn(answers), out / "law_in_space.png")
    e = mr.Restitution.from_geometry(WALL).base
    shares = {name: kept(answer) for name, answer in answers.items()}
    header = ["base", *(f"impact {i + 1}" for i in range(IMPACTS))]
    rows = [
        [name, *(f"{share:.4f}" for share in values), *[""] * (IMPACTS - len(values))]
        for name, values in shares.items()
    ]
    text = f"share of the energy that an impact leaves; theory, e^2: {e**2:.4f}\n" + cli.table(header, rows)
    cli.report(out / "law_in_space", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
