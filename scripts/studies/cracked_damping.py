"""Damping of joints that have cracked, and none while they hold: the impact of a strip between floors, and US-1.

A strip that cracks at half its height rocks as two bodies. `mr.rigid_impact` gives the restitution of their impact, and
a law the damping ratio of a joint: of the wall above the crack as one that rocks on it, by `Contacts.from_law`, or with
the restitution of both bodies in the place of its own. Nothing is fitted. The first table has the restitution by
explicit steps with each, on corner lines and on a bed of nine.

The second table takes the wall US-1 of `shaken_wall.py` in the plane: groups of its courses, which are as stiff as
their joints together, with its joists, and bonds whose dashpots wait for cracks (`Bond(..., damped=False)`). It is run
without damping, with 1.5 % of all motion, and with each law. From `SHARED` runs on, each sequence is run from ten
starts whose motions differ by a millionth: medians and 16 to 84 %. `--motions` is the folder of `shaken_wall.py`.
Without it the motions are synthetic, and there is no test to compare with. Draws the peaks by the run.
"""

from __future__ import annotations

import csv
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE
from mjrock.quantities import Array
from mjrock.result.response import End
from scripts.shared import cli
from scripts.studies.shaken_wall import (
    COURSES,
    DENSITY,
    FRICTION,
    HEIGHT,
    JUDGED,
    LENGTH,
    LOAD,
    MORTAR,
    PERIOD,
    QUIET,
    RUNS,
    SENSOR,
    SHARED,
    STEP,
    STRONGER,
    THICK,
    K,
    Way,
    judged,
    of_law,
    period_of,
    spread,
)
from scripts.studies.shaken_wall import motion_of as measured

BEAM = (0.1, 7850.0)
"""Height [m] and density of the beam [kg/m3]."""
CUTS = (0, 5, 8, 12, 17, 22, 27, 31, 35, 38, 41, 44)
"""Courses at which the wall of the plane is divided."""
LEVELS = (5, 35)
"""First courses of the two groups that hold joists."""
JOIST = (1.355, 2 * 0.0808, 5510 * 1.034)
"""Far end from the back of the wall [m], length of two along the wall [m], and density [kg/m3]."""
POINTS, STARTS = 5, 10
"""Lines of a joint, and starts."""
THROWN = 0.35
"""Rate with which the strip of two bodies is thrown out of rest [rad/s]."""
PUSHED, SLOW = (1e-3, 2e-3, 3e-3, 4e-3, 6e-3, 8e-3, 10e-3), {"inertia": 0.03, "local_damping": 0.5}
"""Displacements of the centroid between which a push goes on [m], and how it is kept slow."""
TIPS = 21.1
"""Displacement at 2.06 m at which the model of the authors bears 0.8 of its largest force [mm]."""


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
    return {
        "undamped": Way(),
        "1.5 % of all motion": Way(motion=0.015),
        "calibrated law": of_law("CALIBRATED"),
        "published law": of_law("PUBLISHED"),
        "published law, both bodies": of_law("PUBLISHED", rigid()),
    }


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
        return mr.Mortar(dry, MORTAR)

    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*frequency", mr.Implausible)
        return mr.Masonry(blocks, joints=joint_of)


def on_beam(masonry: mr.Masonry) -> tuple[mr.Load, mr.Actuator]:
    """The load on the beam, and what holds it sideways."""
    held = mr.Actuator("beam", (0.0, HEIGHT + BEAM[0] / 2), (1.0, 0.0), ([0.0], [0.0]), 1e9)
    return mr.Load(LOAD, height=HEIGHT + BEAM[0], block=masonry.names.index("beam")), held


def pushed_over(along: int, stages: Sequence[float] = PUSHED) -> list[object]:
    """Largest force [kN] on wall and joists as a force on every block in proportion to its weight pushes them along x,
    outside of blows, with the displacement at 2.06 m there [mm], and the force at `TIPS` [kN]."""
    masonry, start, places = wall_of(Way()), None, [[0.0, 0.0]]
    weights = {name: mr.GRAVITY * block.mass for name, block in zip(masonry.names, masonry.polygons, strict=True)}
    weight = sum(weights[masonry.names[i]] for i in masonry.free) - weights["beam"]
    curve = list[tuple[float, float]]()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the push was not slow", UserWarning)  # points of blows are left out
        for to in stages:
            push = mr.push(masonry, along, to, effects=on_beam(masonry), start=start, **SLOW)
            start, slow = push.answer.end, np.abs(push.inertia) < 0.05 * np.abs(push.force)
            curve += zip(push.displacement[slow], 1e-3 * weight * push.force[slow], strict=True)
            places.append([push.displacement[-1], 1e3 * abs(at_sensor(masonry, push.answer.pose)[-1])])
    where, force = np.array(curve).T
    moved = np.interp(where, *np.array(places).T)
    return [f"{force.max():.1f}", f"{moved[force.argmax()]:.1f}", f"{np.interp(TIPS, moved, force):.1f}"]


def answers(
    masonry: mr.Masonry, way: Way, motions: Sequence[mr.GroundMotion], start: End | None = None
) -> Iterator[mr.MasonryResponse]:
    """Motions that follow each other."""
    for motion in motions:
        duration = len(motion.accel) * motion.dt + QUIET
        case = mr.MasonryCase(masonry, duration, motion=motion, effects=on_beam(masonry))
        rate = 4 * np.pi * way.motion / PERIOD
        answer = mr.solve_explicit(case, output_step=STEP, start=start, mass_damping=rate)
        start = answer.end
        yield answer


def at_sensor(masonry: mr.Masonry, pose: Array) -> Array:
    """Where the wall is at the height of the sensor [m]."""
    moving = [masonry.free.index(i) for i, name in enumerate(masonry.names) if name.startswith("part")]
    middles = np.convolve(CUTS, (0.5, 0.5), "valid") * HEIGHT / COURSES
    return np.array([np.interp(SENSOR, middles, row) for row in pose[:, moving, 0]])


def rings() -> float:
    """Period in which the whole wall rings after a weak pulse [s]."""
    pulse = mr.GroundMotion.sine(0.3, 0.1)
    masonry = wall_of(Way())
    (answer,) = answers(masonry, Way(), [pulse])
    return period_of(at_sensor(masonry, answer.pose)[answer.t > pulse.duration], STEP)


def peaks_of(
    masonry: mr.Masonry, way: Way, motions: Sequence[mr.GroundMotion], start: End | None = None
) -> tuple[Array, End | None]:
    """Largest displacement at the sensor in motions that follow each other [m], and the end of the last."""
    peaks = []
    for answer in answers(masonry, way, motions, start):
        start = answer.end
        where = at_sensor(masonry, answer.pose)
        peaks.append(float(np.abs(where - where[0]).max()))
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


SHOWN = "calibrated law"
"""What the figure shows in colour, with its band."""
OTHERS = {"undamped": "-", "1.5 % of all motion": "--", "published law": "-.", "published law both bodies": ":"}
"""Lines of the others."""


def drawn(found: Mapping[str, Array], runs: Sequence[int], *, tested: bool) -> Figure:
    """Median peaks by the run, of 16, 50 and 84 % [mm] in rows, shape (3, runs) for each way."""
    figure = Figure(figsize=(7.4, 4.4), layout="constrained")
    ax = figure.subplots()
    if tested:
        ax.plot(runs, [RUNS[run].test for run in runs], "o", color=BLACK, label="test US-1", markersize=5, zorder=4)
    for name, (low, middle, high) in found.items():
        if name == SHOWN:
            ax.fill_between(runs, low, high, color=BLUE, alpha=0.25, linewidth=0, label=f"{name}, 16 to 84 % of starts")
            ax.plot(runs, middle, color=BLUE, linewidth=2.0, label=name, zorder=3)
        else:
            ax.plot(runs, middle, color="0.55", linestyle=OTHERS.get(name, "-"), linewidth=1.2, label=name)
    ax.set(xlabel="run of the shake table", ylabel="largest displacement at 2.06 m [mm]", yscale="log")
    ax.legend(frameon=False, fontsize=8)
    return figure


def of_table(path: Path) -> tuple[dict[str, Array], list[int]]:
    """The quantiles of each way in a table that has been written [mm], and its runs."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = [name for name in rows[0] if "16 50 84 %" in name]
    found = {
        name.partition(" [mm]")[0]: np.array([[float(cell) for cell in row[name].split("; ")] for row in rows]).T
        for name in names
    }
    return found, [int(row["run"]) for row in rows]


def synthetic(count: int) -> list[mr.GroundMotion]:
    """Motions of growing strength, the last three of them slow pulses."""
    short = mr.GroundMotion.synthetic(1.0, 2.0, seed=1)
    slow = [mr.GroundMotion.sine(size, 0.5) for size in (3.0, 4.5, 5.5)]
    return [*(short.scaled(peak=0.5 * (i + 1)) for i in range(count - 3)), *slow]


def main(argv: Sequence[str] | None = None) -> None:
    """Run the mechanism and the wall in every way, print the tables and draw."""
    parser = cli.parser(__doc__, "cracked_damping")
    parser.add_argument("--motions", type=Path, help="folder with the files of shaken_wall.py; else synthetic motions")
    parser.add_argument("--draw", action="store_true", help="draw the table that is in --out, and run nothing")
    args = parser.parse_args(argv)
    out, made = cli.folder(args.out), ways()
    if args.draw:
        table, runs = of_table(out / "cracked_damping.csv")
        plotting.save(drawn(table, runs, tested=True), out / "cracked_damping.png")
        return
    if args.quick:
        made = {name: made[name] for name in ("published law",)}
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
    header = ["pushed", "largest force [kN]", "at 2.06 m there [mm]", f"at {TIPS} mm there [kN]"]
    sides = {"towards the joists": 1} if args.quick else {"towards the joists": 1, "away from them": -1}
    rows = [[side, *pushed_over(along, PUSHED[: 1 if args.quick else None])] for side, along in sides.items()]
    text += f"\n\n{cli.table(header, rows)}"
    runs = list(RUNS)[: SHARED + 1] if args.quick else list(RUNS)
    motions = synthetic(len(runs)) if args.motions is None else [measured(args.motions, run) for run in runs]
    bar = tqdm(made.items(), disable=None, leave=False)
    peaks = {name: runs_of(way, motions, 1 if args.quick else STARTS) for name, way in bar}
    quantiles = {name: np.percentile(own, [16, 50, 84], axis=0) for name, own in peaks.items()}
    in_mm = {name.replace(",", ""): 1e3 * own for name, own in quantiles.items()}
    plotting.save(drawn(in_mm, runs, tested=args.motions is not None), out / "cracked_damping.png")
    if args.motions is not None:
        judgements = [[name, *judged(1e3 * own, runs)] for name, own in peaks.items()]
        text += "\n\n" + cli.table(JUDGED, judgements)
    header = ["run", "record", "test [mm]", *(f"{name} [mm]: 16, 50, 84 %" for name in peaks)]
    rows = []
    for i, run in enumerate(runs):
        given = [run, RUNS[run].record, RUNS[run].test] if args.motions is not None else [i + 1, "synthetic", ""]
        rows.append([*given, *(spread(1e3 * own[:, i]) for own in peaks.values())])
    cli.report(out / "cracked_damping", f"{text}\n\n{cli.table(header, rows)}", header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
