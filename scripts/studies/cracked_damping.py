"""Damping of joints that have cracked, and none while they hold: the impact of a strip between floors, and US-1.

A strip that cracks at half its height rocks as two bodies. `mr.rigid_impact` gives the restitution of their impact, and
a law the damping ratio of a joint: of the wall above the crack as one that rocks on it, by `Contacts.from_law`, or with
the restitution of both bodies in the place of its own. Nothing is fitted. The first table has the restitution by
explicit steps with each, on corner lines and on a bed of nine.

The second table takes the wall US-1 of `shaken_wall.py` in the plane: groups of its courses, which are as stiff as
their joints together, with its joists, and bonds whose dashpots wait for cracks (`Bond(..., damped=False)`). It is run
without damping, with 1.5 % of all motion, and with each law. From `SHARED` runs on, each sequence is run from ten
starts whose motions differ by a millionth: medians and 16 to 84 %. `--records` is the folder of `shaken_wall.py`.
Without it the motions are synthetic, and there is no test to compare with. Draws the peaks by the run.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import spearmanr
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.figures import BLACK
from mjrock.quantities import Array
from mjrock.result.response import End
from scripts.shared import cli
from scripts.studies.shaken_wall import (
    COURSES,
    FRICTION,
    HEIGHT,
    LENGTH,
    LOAD,
    PERIOD,
    QUIET,
    RUNS,
    SENSOR,
    STEP,
    THICK,
    K,
    period_of,
)
from scripts.studies.shaken_wall import motion_of as measured

DENSITY, BEAM = 1885.0, (0.1, 7850.0)
"""Density of the wall [kg/m3]; height [m] and density of the beam."""
CUTS = (0, 5, 8, 12, 17, 22, 27, 31, 35, 38, 41, 44)
"""Courses at which the wall of the plane is divided."""
LEVELS = (5, 35)
"""First courses of the two groups that hold joists."""
JOIST = (1.355, 2 * 0.0808, 5510 * 1.034)
"""Far end from the back of the wall [m], length of two along the wall [m], and density [kg/m3]."""
POINTS, STARTS, SHARED = 5, 10, 8
"""Lines of a joint, starts, and runs before them that all starts share: the wall is still whole there."""
STRONGER = 1e-6
"""By how much the motions of two starts differ [-]."""
THROWN = 0.35
"""Rate with which the strip of two bodies is thrown out of rest [rad/s]."""


class Way(NamedTuple):
    """A way to damp the wall: damping ratio of cracked joints and the frequency that it refers to [rad/s], and damping
    ratio of all motion."""

    xi: float = 0.0
    frequency: float = 1.0
    motion: float = 0.0


def mechanism(lines: int, way: Way) -> mr.Masonry:
    """A dry strip like US-1 between floors, cracked at half its height, under its beam."""
    wall = mr.Block.from_size(thickness=THICK, height=HEIGHT, length=LENGTH, density=DENSITY)
    load = BEAM[0] * BEAM[1] * THICK * LENGTH * mr.GRAVITY
    return mr.Masonry.between_floors(
        wall,
        load,
        crack=HEIGHT / 2,
        k_n=K,
        k_s=K,
        friction=FRICTION,
        xi=way.xi,
        frequency=way.frequency,
        points=lines,
    )


OPENING = np.array([[HEIGHT / 4, THICK / 2, 1.0], [HEIGHT / 4, 1.5 * THICK, -1.0], [0.0, 2 * THICK, 0.0]])
"""Velocity of lower body, upper body and floor as the mechanism opens outwards, at 1 rad/s."""


def rigid() -> float:
    """Restitution of the impact of both bodies [-]."""
    return float(np.sqrt(mr.rigid_impact(mechanism(2, Way()), -OPENING).kept))


def found(lines: int, way: Way) -> float:
    """Restitution of the first impact by explicit steps [-]: the root of the energy of motion and height 20 ms after it
    over that 12 ms before it."""
    strip = mechanism(lines, way)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*frequency", mr.Implausible)
        answer = mr.solve_explicit(mr.MasonryCase(strip, 0.6, velocity=THROWN * OPENING), output_step=2e-4)
    mass = np.array([(b.mass, b.mass, float(b.inertia)) for b in (strip.polygons[i] for i in strip.free)])
    energy = 0.5 * (mass * answer.velocity**2).sum(axis=(1, 2))
    energy += mr.GRAVITY * (answer.pose - answer.pose[0])[:, :, 1] @ mass[:, 0]
    moved = answer.pose[:, 0, 0] - answer.pose[0, 0, 0]
    met = int(np.flatnonzero((moved[:-1] > 0) & (moved[1:] <= 0))[0])
    return float(np.sqrt(energy[met + 100] / energy[met - 60]))


def ways() -> dict[str, Way]:
    """Every way, with what the laws say of the wall above the crack."""
    part = mr.Block.from_size(thickness=THICK, height=HEIGHT / 2, length=LENGTH, density=DENSITY)
    made = {"undamped": Way(), "1.5 % of all motion": Way(motion=0.015)}
    own = mr.Restitution.from_geometry(part)
    for name, law, e in (
        ("calibrated law, part above", "CALIBRATED", own),
        ("published law, part above", "PUBLISHED", own),
        ("published law, both bodies", "PUBLISHED", mr.Restitution(rigid(), own.side)),
    ):
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", ".*(outside the range of the fit|no damping of this base)", UserWarning)
            warnings.filterwarnings("ignore", "xi = ", mr.Implausible)
            base = mr.Contacts.from_law(part, e, k_base=K, law=law).base
        made[name] = Way(base.xi, base.frequency)
    return made


def rectangle(low: float, high: float, density: float, **given: object) -> mr.Polygon:
    """A rectangle as thick as the wall, between two heights [m]."""
    b = THICK / 2
    corners = [(-b, low), (b, low), (b, high), (-b, high)]
    return mr.Polygon(corners, density=density, length=LENGTH, **given)  # type: ignore[arg-type]


def wall_of(way: Way) -> mr.Masonry:
    """The wall US-1 in the plane."""
    course, b = HEIGHT / COURSES, THICK / 2
    far, wide, density = JOIST
    blocks: list[mr.Polygon | mr.Compound] = [rectangle(-0.1, 0.0, 2000.0, fixed=True, name="base")]
    supports, courses = [], {"base": 0, "beam": 0}
    for first, end in pairwise(CUTS):
        low, high, name = first * course, end * course, f"part_{first}"
        courses[name] = end - first
        if first in LEVELS:
            joist = [(b, low), (far - b, low), (far - b, high), (b, high)]
            joists = mr.Polygon(joist, density=density * wide / LENGTH, length=LENGTH)
            blocks.append(mr.Compound([rectangle(low, high, DENSITY), joists], name=name))
            bed = [(1.0 - b, low - 0.1), (1.5 - b, low - 0.1), (1.5 - b, low), (1.0 - b, low)]
            supports.append(mr.Polygon(bed, length=LENGTH, fixed=True, name=f"support_{first}"))
        else:
            blocks.append(rectangle(low, high, DENSITY, name=name))
    blocks += [rectangle(HEIGHT, HEIGHT + BEAM[0], BEAM[1], name="beam"), *supports]

    def joint_of(joint: mr.Joint) -> mr.Dry | mr.Mortar:
        if "support" in joint.name:
            return mr.Dry(0.1 * K * wide / LENGTH, float(np.tan(np.radians(1.0))), 0.0, 1e4, 1.0, POINTS)
        below, above = (courses[name] for name in joint.name.split("|"))
        stiffness = K / max(1.0, 0.5 * (below + above + (below == 0) + (above == 0)))
        dry = mr.Dry(stiffness, FRICTION, way.xi, stiffness, way.frequency, POINTS)
        return mr.Mortar(dry, mr.Bond(0.2e6, 0.4e6, 32.0, 320.0, damped=False))

    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*frequency", mr.Implausible)
        return mr.Masonry(blocks, joints=joint_of)


def answers(
    masonry: mr.Masonry, way: Way, motions: Sequence[mr.GroundMotion], start: End | None = None
) -> Iterator[mr.MasonryResponse]:
    """Motions that follow each other."""
    held = mr.Actuator("beam", (0.0, HEIGHT + BEAM[0] / 2), (1.0, 0.0), ([0.0], [0.0]), 1e9)
    load = mr.Load(LOAD, height=HEIGHT + BEAM[0], block=masonry.names.index("beam"))
    for motion in motions:
        case = mr.MasonryCase(masonry, len(motion.accel) * motion.dt + QUIET, motion=motion, effects=(load, held))
        rate = 4 * np.pi * way.motion / PERIOD
        answer = mr.solve_explicit(case, output_step=STEP, start=start, mass_damping=rate)
        start = answer.end
        yield answer


def at_sensor(masonry: mr.Masonry, answer: mr.MasonryResponse) -> Array:
    """Displacement at the height of the sensor [m]."""
    moving = [masonry.free.index(i) for i, name in enumerate(masonry.names) if name.startswith("part")]
    middles = np.convolve(CUTS, (0.5, 0.5), "valid") * HEIGHT / COURSES
    return np.array([np.interp(SENSOR, middles, row) for row in answer.pose[:, moving, 0] - answer.pose[0, moving, 0]])


def rings() -> float:
    """Period in which the whole wall rings after a weak pulse [s]."""
    pulse = mr.GroundMotion.sine(0.3, 0.1)
    masonry = wall_of(Way())
    (answer,) = answers(masonry, Way(), [pulse])
    return period_of(at_sensor(masonry, answer)[answer.t > pulse.duration], STEP)


def peaks_of(
    masonry: mr.Masonry, way: Way, motions: Sequence[mr.GroundMotion], start: End | None = None
) -> tuple[Array, End | None]:
    """Largest displacement at the sensor in motions that follow each other [m], and the end of the last."""
    peaks = []
    for answer in answers(masonry, way, motions, start):
        start = answer.end
        peaks.append(float(np.abs(at_sensor(masonry, answer)).max()))
    return np.array(peaks), start


def runs_of(way: Way, motions: Sequence[mr.GroundMotion], starts: int) -> Array:
    """Peaks of every start [m], shape (starts, runs)."""
    masonry = wall_of(way)
    with warnings.catch_warnings():  # what lies on the ground after a fall is not looked at
        warnings.filterwarnings("ignore", ".*lie inside each other", UserWarning)
        whole, start = peaks_of(masonry, way, motions[:SHARED])
        later = [
            peaks_of(masonry, way, [motion.scaled(1 + i * STRONGER) for motion in motions[SHARED:]], start)[0]
            for i in range(starts)
        ]
    return np.column_stack([np.tile(whole, (starts, 1)), later])


def judged(peaks: Array, test: Array, rocking: Array) -> list[str]:
    """Ranks, mean factor on the test and runs within a factor of two by the median peaks, the factors of the runs that
    rock, and how many of their starts are within a factor of two; peaks of starts by run and those of the test [mm]."""
    factor = np.median(peaks, axis=0) / test
    near = np.abs(np.log(factor)) < np.log(2)
    single = np.abs(np.log(peaks[:, rocking] / test[rocking])) < np.log(2)
    mean = np.exp(np.log(factor).mean())
    return [
        f"{spearmanr(factor * test, test).statistic:.3f}",
        f"{mean:.2f}",
        f"{int(near.sum())} of {len(test)}",
        ", ".join(f"{x:.2f}" for x in factor[rocking]),
        f"{int(single.sum())} of {single.size}",
    ]


def drawn(found: dict[str, Array], runs: Sequence[int], *, tested: bool) -> Figure:
    """Median peaks by the run with their 16 to 84 %, of 16, 50 and 84 % [m] in rows, shape (3, runs) for each way."""
    figure = Figure(figsize=(7.4, 4.4), layout="constrained")
    ax = figure.subplots()
    if tested:
        ax.plot(runs, [RUNS[run].test for run in runs], "o", color=BLACK, label="test US-1", markersize=5, zorder=4)
    for (name, quantiles), colour in zip(found.items(), (*plotting.PALETTE[:4], "0.5"), strict=False):
        low, middle, high = 1e3 * quantiles
        ax.fill_between(runs, low, high, color=colour, alpha=0.2, linewidth=0)
        ax.plot(runs, middle, color=colour, marker=".", label=name)
    ax.set(xlabel="run of the shake table", ylabel="largest displacement at 2.06 m [mm]", yscale="log")
    ax.legend(frameon=False, fontsize=8)
    return figure


def synthetic(count: int) -> list[mr.GroundMotion]:
    """Motions of growing strength, the last three of them slow pulses."""
    short = mr.GroundMotion.synthetic(1.0, 2.0, seed=1)
    slow = [mr.GroundMotion.sine(size, 0.5) for size in (3.0, 4.5, 5.5)]
    return [*(short.scaled(peak=0.5 * (i + 1)) for i in range(count - 3)), *slow]


def main(argv: Sequence[str] | None = None) -> None:
    """Run the mechanism and the wall in every way, print the tables and draw."""
    parser = cli.parser(__doc__, "cracked_damping")
    parser.add_argument("--records", type=Path, help="folder with the files of shaken_wall.py; else synthetic motions")
    args = parser.parse_args(argv)
    out, made = cli.folder(args.out), ways()
    if args.quick:
        made = {name: made[name] for name in ("undamped", "published law, part above")}
    rows: list[list[object]] = [
        [
            name,
            f"{way.xi:.3f}",
            f"{2e3 * way.xi / way.frequency:.2f}",
            *(f"{found(lines, way):.3f}" for lines in (2, 9)),
        ]
        for name, way in made.items()
        if way.motion == 0
    ]
    heading = f"restitution of the impact of both bodies, rigid: {rigid():.4f}"
    header = ["damping of the joints", "xi", "c/k [ms]", "e on two lines", "e on nine lines"]
    text = f"{heading}\n{cli.table(header, rows)}\n\nperiod of the whole wall: {rings():.4f} s"
    runs = list(RUNS)[: SHARED + 1] if args.quick else list(RUNS)
    motions = synthetic(len(runs)) if args.records is None else [measured(args.records, run) for run in runs]
    bar = tqdm(made.items(), disable=None, leave=False)
    peaks = {name: runs_of(way, motions, 2 if args.quick else STARTS) for name, way in bar}
    quantiles = {name: np.percentile(own, [16, 50, 84], axis=0) for name, own in peaks.items()}
    plotting.save(drawn(quantiles, runs, tested=args.records is not None), out / "cracked_damping.png")
    if args.records is not None:
        test = np.array([RUNS[run].test for run in runs])
        rocking = np.array([RUNS[run].record == "FR76" for run in runs])
        header = [
            "damping",
            "ranks",
            "mean factor",
            "within two",
            "factors of runs 22 to 24",
            "their starts within two",
        ]
        judgements = [[name, *judged(1e3 * own, test, rocking)] for name, own in peaks.items()]
        text += "\n\n" + cli.table(header, judgements)
    header = ["run", "record", "test [mm]", *(f"{name} [mm]: 16, 50, 84 %" for name in peaks)]
    rows = []
    for i, run in enumerate(runs):
        cells = (np.percentile(1e3 * own[:, i], [16, 50, 84]) for own in peaks.values())
        given = [run, RUNS[run].record, RUNS[run].test] if args.records is not None else [i + 1, "synthetic", ""]
        rows.append([*given, *(", ".join(f"{x:.2f}" for x in three) for three in cells)])
    cli.report(out / "cracked_damping", f"{text}\n\n{cli.table(header, rows)}", header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
