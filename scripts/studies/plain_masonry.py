"""What plain models of masonry err by and cost: landings against closed forms, and motions against explicit steps.

A block falls flat, on a corner at 20 degrees and on a corner at 60 degrees, without friction, from heights that differ
by less than a step: the energy that a landing takes, against that of a mass on a spring and a dashpot that only press.
It is (1 - e^2) of the energy that the corner brings, with the mass that the corner feels and
e = exp(-zeta omega t), t the time until the force of spring and dashpot is zero. Explicit steps give a side the
stiffness of its area, so that at 60 degrees, where the long side lands, they have twice the stiffness.
A cube is thrown along rough ground: how far it slides, over v^2 / (2 mu g), and what its dashpots take, which is
nothing in theory. Then a block on two supports, columns of four square drums and of four drums of sixteen sides, and an
arch, each moved by one sine of the ground, by plain models at some steps, by explicit steps and on contact points. The
error is the largest distance from explicit steps a sixteenth as long, over the largest displacement.
Prints both tables. Writes plain_masonry.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli

RESOLVED = (1.0, 0.5, 0.2, 0.1, 0.05)
"""omega h of plain models [-]."""
THICKNESS, HEIGHT, LENGTH = 0.3, 0.6, 1.0
"""Of the block that lands [m]."""
K_N, XI = 1e9, 0.05
SPEED, LANDED = 3.0, 0.03
"""Speed at which it falls [m/s], and when it has landed and left [s]."""
HEIGHTS = np.linspace(0.02, 0.022, 6)
"""Heights that it falls from at that speed [m]."""
SAMPLE = 1e-2
LOOKS = {"plain model": "plain MuJoCo", "explicit steps": "explicit", "contact points": "MuJoCo"}
"""The solver whose colour each has."""
NAMES = {"plain model": "plain model", "explicit steps": "explicit steps", "contact points": "MuJoCo, contact points"}

Point = tuple[str, float, float, float]
"""A solver, what sets its step, its error [-] and its time [s]."""


def landing(degrees: float, height: float) -> mr.MasonryCase:
    """A block that falls on level ground, turned by an angle, and another that stands far away on the same ground."""
    corners = turned(degrees)
    corners[:, 1] += height - corners[:, 1].min()
    ground = mr.Polygon([(-30, -1), (30, -1), (30, 0), (-30, 0)], fixed=True, length=LENGTH)
    standing = mr.Polygon([(-20.3, 0), (-20, 0), (-20, 0.6), (-20.3, 0.6)], length=LENGTH)
    blocks = [ground, mr.Polygon(corners, length=LENGTH), standing]
    masonry = mr.Masonry(blocks, k_n=K_N, friction=0.0, xi=XI)
    return mr.MasonryCase(masonry, LANDED, velocity=[(0, -SPEED, 0), (0, 0, 0)], settled=False)


def turned(degrees: float) -> NDArray[np.float64]:
    """The corners of the block, turned about its middle [m], shape (4, 2)."""
    half = 0.5 * np.array([(-THICKNESS, -HEIGHT), (THICKNESS, -HEIGHT), (THICKNESS, HEIGHT), (-THICKNESS, HEIGHT)])
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.asarray(half @ np.array([(c, s), (-s, c)]))


def closed_form(degrees: float, joint: float, damping: float) -> float:
    """Share of its energy that a landing takes [-], by the spring [N/m] and the dashpot [N s/m] of the whole joint, of
    which a corner has half."""
    m, flat = mr.Polygon(turned(0.0), length=LENGTH).mass, degrees == 0
    lever = 0.0 if flat else turned(degrees)[:, 0][turned(degrees)[:, 1].argmin()]
    felt = m / (1 + 12 * lever**2 / (THICKNESS**2 + HEIGHT**2))
    k, c = (joint, damping) if flat else (0.5 * joint, 0.5 * damping)
    zeta = c / (2 * math.sqrt(k * felt))
    damped = math.sqrt(1 - zeta**2)
    e = math.exp(-zeta / damped * (math.pi - math.atan2(2 * zeta * damped, 1 - 2 * zeta**2)))
    return (1 - e**2) * felt / m * (1 + 2 * mr.GRAVITY * float(HEIGHTS.mean()) / SPEED**2)


def lost(answer: mr.Response) -> float:
    """Share of the energy of motion that a landing took [-]."""
    account = answer.ledger
    assert account is not None
    return float(sum(taken[-1] for taken in account.dashpots.values()) / account.kinetic[0])


def landings(lines: list[str], rows: list[list[object]], quick: bool) -> None:
    """The energy that landings take, by step."""
    lines.append("Energy that a landing takes, mean and scatter of heights less than a step apart:")
    for degrees in (20.0,) if quick else (0.0, 20.0, 60.0):
        scene = mr.scene_of(landing(degrees, HEIGHTS[0]))
        exact = closed_form(degrees, scene.contacts.k.sum(), scene.contacts.c.sum())
        parts = [f"  {degrees:2g} degrees: closed form {exact:.3f}"]
        for resolved in RESOLVED[2:3] if quick else RESOLVED:
            cases = [landing(degrees, height) for height in HEIGHTS]
            h = resolved / scene.highest_frequency
            taken = [lost(mr.simulate(case, timestep=h, ledger=True, collisions=True)) for case in cases]
            parts.append(f"omega h {resolved:g}: {np.mean(taken):.3f} +- {np.std(taken):.3f}")
            rows.append([f"landing at {degrees:g} degrees", resolved, exact, np.mean(taken), np.std(taken)])
        parts.append(f"explicit steps: {lost(mr.solve_explicit(landing(degrees, HEIGHTS[0]), ledger=True)):.3f}")
        lines.append(", ".join(parts))


def sliding(lines: list[str], rows: list[list[object]], quick: bool) -> None:
    """A cube that slides: its way, and what dashpots take of its energy."""
    mu, speed = 0.5, 2.0
    ground = mr.Polygon([(-9, -1), (9, -1), (9, 0), (-9, 0)], fixed=True)
    cube = mr.Polygon([(-0.25, 0), (0.25, 0), (0.25, 0.5), (-0.25, 0.5)])
    masonry = mr.Masonry([ground, cube], k_n=K_N, friction=mu, xi=XI)
    case = mr.MasonryCase(masonry, 1.6 * speed / (mu * mr.GRAVITY), velocity=[(speed, 0, 0)])
    highest = mr.scene_of(case).highest_frequency
    runs = {"explicit steps": mr.solve_explicit(case, ledger=True)}
    for resolved in RESOLVED[2:3] if quick else RESOLVED[1:]:
        runs[f"omega h {resolved:g}"] = mr.simulate(case, timestep=resolved / highest, ledger=True, collisions=True)
    parts = [
        f"A cube slides at {speed:g} m/s with mu = {mu:g}, its way over theory's, and the share that dashpots take"
    ]
    for name, run in runs.items():
        way = (run.pose[-1, 0, 0] - run.pose[0, 0, 0]) / (speed**2 / (2 * mu * mr.GRAVITY))
        parts.append(f"{name}: {way:.4f}, {lost(run):.2%}")
        rows.append(["cube that slides", name, 1.0, way, lost(run)])
    lines.append("; ".join(parts))


def on_two_supports() -> mr.MasonryCase:
    """A block across two supports, which rocks from one to the other."""
    supports = [mr.Polygon([(x, 0), (x + 0.3, 0), (x + 0.3, 0.3), (x, 0.3)], fixed=True) for x in (0.0, 0.9)]
    block = mr.Polygon([(0, 0.3), (1.2, 0.3), (1.2, 3.9), (0, 3.9)])
    masonry = mr.Masonry([*supports, block], k_n=1e9, friction=0.8, xi=XI)
    return mr.MasonryCase(masonry, 2.0, mr.GroundMotion.sine(4.5, 0.7))


def drums(sides: int) -> mr.MasonryCase:
    """A column of four drums."""
    column = mr.Masonry.column(0.8, 4.0, 4, sides=sides, k_n=1e9, friction=0.7, xi=XI)
    return mr.MasonryCase(column, 2.0, mr.GroundMotion.sine(2.5, 0.8))


def arch() -> mr.MasonryCase:
    """An arch of eleven voussoirs."""
    masonry = mr.Masonry.arch(radius=2.0, thickness=0.3, voussoirs=11, k_n=1e9, friction=0.8, xi=XI)
    return mr.MasonryCase(masonry, 1.5, mr.GroundMotion.sine(3.0, 0.4))


CASES: dict[str, Callable[[], mr.MasonryCase]] = {
    "block on two supports": on_two_supports,
    "square drums": partial(drums, 4),
    "drums of 16 sides": partial(drums, 16),
    "arch": arch,
}


def points_of(case: mr.MasonryCase, quick: bool) -> list[Point]:
    """Errors and times of the three solvers."""
    highest = mr.scene_of(case).highest_frequency
    usual = mr.solve_explicit(case, output_step=SAMPLE)
    runs = [("explicit steps", 1.0, usual)]
    runs += [("contact points", 1e-3, mr.simulate(case, output_step=SAMPLE))]
    for resolved in RESOLVED[1:2] if quick else RESOLVED:
        h = SAMPLE / math.ceil(SAMPLE * highest / resolved)
        run = mr.simulate(case, timestep=h, output_step=SAMPLE, collisions=True)
        runs.append(("plain model", resolved, run))
    finer = 2.0 if quick else 16.0
    exact = mr.solve_explicit(case, timestep=usual.stats["timestep"] / finer, output_step=SAMPLE)
    d = 3 if case.in_space else 2
    moved = np.linalg.norm(exact.pose[..., :d], axis=2).max()
    points = []
    for name, setting, run in runs:
        count = min(len(run.t), len(exact.t))
        away = np.linalg.norm(run.pose[:count, :, :d] - exact.pose[:count, :, :d], axis=2).max()
        points.append((name, setting, float(away / moved), float(run.stats["stepping_processor_time"])))
    return points


def picture(found: dict[str, list[Point]]) -> Figure:
    """Errors against time, a panel for each case."""
    figure = Figure(figsize=(7.4, 5.6), layout="constrained")
    for ax, (name, points) in zip(figure.subplots(2, 2, sharex=True, sharey=True).ravel(), found.items(), strict=False):
        for solver, of in LOOKS.items():
            own = [(seconds, error) for who, _, error, seconds in points if who == solver]
            ax.loglog(*np.transpose(own), "o-", color=plotting.STYLES[of]["color"], label=NAMES[solver])
        ax.set_title(name, fontsize=10)
        ax.set(xlim=(0.02, 10), ylim=(1e-5, 1))
        ax.grid(alpha=0.3)
    figure.axes[0].legend(frameon=False, fontsize=8)
    figure.supxlabel("CPU time [s]", fontsize=10)
    figure.supylabel("largest error over the largest displacement [-]", fontsize=10)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run landings and motions."""
    args = cli.parser(__doc__, "plain_masonry").parse_args(argv)
    out, lines, rows = cli.folder(args.out), list[str](), list[list[object]]()
    found: dict[str, list[Point]] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of steps that are long
        landings(lines, rows, args.quick)
        sliding(lines, rows, args.quick)
        for name in tqdm(list(CASES)[:1] if args.quick else CASES, desc="cases", disable=None):
            found[name] = points_of(CASES[name](), args.quick)
            lines.append(f"{name}: error over the largest displacement, and time of the processor")
            for solver, setting, error, seconds in found[name]:
                step = f", omega h {setting:g}" if solver == "plain model" else ""
                lines.append(f"  {solver}{step}: {error:.2%} in {seconds:.2f} s")
                rows.append([name, setting, solver, error, seconds])
    header = ["case", "setting", "solver", "found", "scatter, or time [s]"]
    cli.report(out / "plain_masonry", "\n".join(lines), header, rows)
    plotting.save(picture(found), out / "plain_masonry.png")


if __name__ == "__main__":
    sys.exit(cli.run(main))
