"""Ten falls by explicit steps and by plain models, in which MuJoCo finds the contacts: two codes that share no contact.

Two of them are run once more with joints ten times as damped, on which blocks do not bounce. Each scene runs ten times
by both, from starts that differ by a speed of 1 mm/s in a random direction: what blocks that fall do depends on the
last digit, so that two codes can agree only within the scatter of each.
Prints for each scene how many blocks fall, when the first falls, how far blocks come to rest from where they stood, the
energy lost, the largest overlap, the time of the processor, and how far the two means lie apart over their scatter.
Writes second_opinion.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli

SEEDS = 10
SPACING = 5e-3
"""Of the samples [s]."""
NUDGE = 1e-3
"""Largest speed by which starts differ [m/s]."""
JOINTS, DAMPED = (mr.Dry(1e9, 0.6, xi=xi, frequency=200.0) for xi in (0.05, 0.5))
"""Joints of all scenes but the wheel and the arch, and the same ten times as damped. Friction sticks rigidly in both
codes: MuJoCo has no k_s."""
RESOLVED = 0.5
"""omega h of the plain models, omega the highest frequency of the closed contacts [-]."""
SOLVERS = ("explicit", "plain")
CODES = {"explicit": "explicit", "plain": "plain MuJoCo"}
"""The line of each in a figure."""
COMPARED = ("fallen", "first fall [s]", "moved [m]", "lost [J]")
"""What is compared."""


def block(left: float, right: float, low: float, high: float, **options: object) -> mr.Polygon:
    """A rectangle between two places along the ground and two heights [m]."""
    return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], **options)  # type: ignore[arg-type]


def cuboid(middle: tuple[float, float, float], size: tuple[float, float, float], **options: object) -> mr.Polyhedron:
    """A box about its middle [m]."""
    return mr.Polyhedron.box(size, centre=middle, **options)  # type: ignore[arg-type]


SLAB = cuboid((0, 0, -0.25), (12, 12, 0.5), fixed=True, name="slab")


def off_a_table() -> mr.MasonryCase:
    """A block that slides off a table."""
    table = cuboid((0, 0, 0.5), (1, 1, 1), fixed=True, name="table")
    masonry = mr.Masonry([SLAB, table, cuboid((0.3, 0, 1.15), (0.3, 0.3, 0.3), name="die")], joints=JOINTS)
    return mr.MasonryCase(masonry, 2.0, velocity=[(2.0, 0, 0, 0, 0, 0)])


def thrown(joints: mr.Dry = JOINTS) -> mr.MasonryCase:
    """Five blocks that are thrown up and spin."""
    rng = np.random.default_rng(4)
    blocks = [cuboid((0.6 * i, 0, 0.1), (0.4, 0.3, 0.2), name=f"block_{i}") for i in range(5)]
    velocity = np.column_stack([rng.uniform(-1, 1, (5, 2)), rng.uniform(2, 4, 5), rng.uniform(-4, 4, (5, 3))])
    return mr.MasonryCase(mr.Masonry([SLAB, *blocks], joints=joints), 2.0, velocity=velocity)


def dominoes() -> mr.MasonryCase:
    """Ten slender blocks, the first of which is pushed."""
    blocks = [block(0.25 * i, 0.25 * i + 0.06, 0, 0.5, length=0.2, name=f"domino_{i}") for i in range(10)]
    ground = block(-2, 5, -0.5, 0, length=0.2, fixed=True, name="ground")
    velocity = np.zeros((10, 3))
    velocity[0] = (0.5, 0.0, 1.5)
    return mr.MasonryCase(mr.Masonry([ground, *blocks], joints=JOINTS), 2.0, velocity=velocity)


def wheel() -> mr.MasonryCase:
    """A wheel of twelve sides that rolls down 9 degrees, from a push."""
    sides, radius, slope = 12, 0.3, math.radians(9.0)
    around = 2 * math.pi / sides * np.arange(sides)
    ring = radius * np.column_stack(
        [np.sin(around - 0.5 * around[1]), math.cos(0.5 * around[1]) - np.cos(around - 0.5 * around[1])]
    )
    turn = np.array([[math.cos(slope), math.sin(slope)], [-math.sin(slope), math.cos(slope)]])
    ground, rolling = (each @ turn.T for each in (block(-1, 12, -1, 0).corners, ring))
    blocks = [mr.Polygon(ground, fixed=True, name="ground"), mr.Polygon(rolling, name="wheel")]
    along = 0.8 * radius * turn @ (1.0, 0.0)
    masonry = mr.Masonry(blocks, k_n=1e9, friction=1.0, xi=1.0, frequency=400.0)
    return mr.MasonryCase(masonry, 2.0, velocity=[(*along, 0.8)], settled=False)


def heap() -> mr.MasonryCase:
    """Twelve blocks that are poured onto each other."""
    rng = np.random.default_rng(7)
    blocks = [
        cuboid((*rng.uniform(-0.2, 0.2, 2), 0.125 + 0.45 * i), (0.35, 0.3, 0.25), name=f"block_{i}") for i in range(12)
    ]
    velocity = np.column_stack([np.zeros((12, 3)), rng.uniform(-1, 1, (12, 3))])
    return mr.MasonryCase(mr.Masonry([SLAB, *blocks], joints=JOINTS), 3.0, velocity=velocity, settled=False)


def arch() -> mr.MasonryCase:
    """An arch whose right abutment moves away by half a metre in a second, on ground to fall on."""
    arch = mr.Masonry.arch(radius=2.0, thickness=0.3, voussoirs=11, k_n=1e9, friction=0.6)
    ground = block(-6, 6, -1.5, -1.0, fixed=True, name="ground")
    masonry = mr.Masonry([*arch.blocks, ground], joints=JOINTS)
    return mr.MasonryCase(masonry, 2.0, supports={"right_abutment": ([0.2, 1.2], [0.0, 0.5], [0.0, 0.0])})


def tilting_panel() -> mr.MasonryCase:
    """A panel in running bond on a table that tilts to 35 degrees in a second."""
    panel = mr.Masonry.running_bond(1.5, 1.25, (0.5, 0.25), thickness=0.3, joints=JOINTS)
    return mr.MasonryCase(panel, 1.6, tilt=([0.0, 1.0], [0.0, math.radians(35.0)]))


def facade() -> mr.MasonryCase:
    """A facade with a window and two return walls under a sine out of its plane."""
    window = mr.Opening(width=0.4, height=0.4, sill=0.2)
    walls = mr.Masonry.facade(1.6, 0.8, 0.8, (0.4, 0.2), openings=[(0.0, window)], joints=JOINTS)
    return mr.MasonryCase(walls, 2.0, motion=mr.GroundMotion.sine(-9.0, 0.5))


def two_storeys() -> mr.MasonryCase:
    """A wall of two storeys in small, in running bond, under a sine in its plane."""
    wall = mr.Masonry.running_bond(2.0, 2.0, (0.5, 0.25), thickness=0.3, joints=JOINTS)
    return mr.MasonryCase(wall, 2.0, motion=mr.GroundMotion.sine(10.0, 0.7))


def pier(joints: mr.Dry = JOINTS) -> mr.MasonryCase:
    """A lintel of five blocks on two piers, one of which goes down by half a metre in a fifth of a second."""
    ground = block(-3, 3, -1.5, -1.0, length=0.5, fixed=True, name="ground")
    piers = [
        block(-1.5, -0.9, -1.0, 0.0, length=0.5, fixed=True, name="left"),
        block(0.9, 1.5, -1.0, 0.0, length=0.5, fixed=True, name="right"),
    ]
    beam = block(-1.4, 1.4, 0.0, 0.25, length=0.5, name="lintel")
    load = [block(-1.2 + 0.6 * i, -0.65 + 0.6 * i, 0.25, 0.65, length=0.5, name=f"load_{i}") for i in range(4)]
    masonry = mr.Masonry([ground, *piers, beam, *load], joints=joints)
    return mr.MasonryCase(masonry, 2.0, supports={"right": ([0.1, 0.3], [0.0, 0.0], [0.0, -0.5])})


SCENES: dict[str, Callable[[], mr.MasonryCase]] = {
    "off a table": off_a_table,
    "thrown blocks": thrown,
    "dominoes": dominoes,
    "rolling wheel": wheel,
    "heap": heap,
    "spreading arch": arch,
    "tilting panel": tilting_panel,
    "facade": facade,
    "two storeys": two_storeys,
    "lost pier": pier,
    "thrown, damped": partial(thrown, DAMPED),
    "lost pier, damped": partial(pier, DAMPED),
}


@dataclass(frozen=True)
class Fall:
    """One run: what is compared, the largest overlap [-], the time of the processor [s] and where the blocks end."""

    compared: NDArray[np.float64]
    overlap: float
    seconds: float
    end: NDArray[np.float64]


def nudged(case: mr.MasonryCase, seed: int) -> mr.MasonryCase:
    """The case from a start that differs by a small speed."""
    shape = (len(case.bodies), 6 if case.in_space else 3)
    start = np.zeros(shape) if case.velocity is None else np.asarray(case.velocity)
    return replace(case, velocity=start + np.random.default_rng(seed).uniform(-NUDGE, NUDGE, shape))


def fall(case: mr.MasonryCase, solver: str) -> Fall:
    """A run of a case."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of overlap, which is in the table
        if solver == "explicit":
            answer = mr.solve_explicit(case, ledger=True, output_step=SPACING)
        else:
            h = RESOLVED / mr.scene_of(case).highest_frequency
            answer = mr.simulate(case, timestep=h, collisions=True, ledger=True, output_step=SPACING)
    d = 3 if case.in_space else 2
    moved = np.linalg.norm(answer.pose[-1, :, :d], axis=1)
    assert answer.ledger is not None
    lost = answer.ledger.friction[-1] + sum(account[-1] for account in answer.ledger.dashpots.values())
    first = next(iter(answer.fallen.values()), math.nan)
    compared = np.array([len(answer.fallen), first, moved.mean(), lost])
    seconds = float(answer.stats["stepping_processor_time"])
    return Fall(compared, float(answer.stats["overlap"]), seconds, answer.pose[-1, :, :d])


def apart(one: Sequence[Fall], other: Sequence[Fall]) -> NDArray[np.float64]:
    """How far the means of two codes lie apart, over their scatter [-], of all that is compared."""
    both = [np.array([each.compared for each in runs]) for runs in (one, other)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # where no block falls there is no first one
        means, scatter = (np.array([of(each, axis=0) for each in both]) for of in (np.nanmean, np.nanstd))
    least = 0.01 * np.abs(means).max(axis=0)  # what is equal to 1 % is equal
    return np.asarray(np.abs(means[0] - means[1]) / np.maximum(np.hypot(*scatter), np.maximum(least, 1e-9)))


def drawn(runs: dict[str, dict[str, list[Fall]]]) -> Figure:
    """For each scene, how far blocks moved and what was lost, with their scatter, by both codes."""
    figure = Figure(figsize=(7.4, 4.4), layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    rows = np.arange(len(runs))
    for ax, i, label in ((axes[0], 2, "mean displacement in the end"), (axes[1], 3, "energy lost")):
        for (solver, of), shift in zip(CODES.items(), (0.15, -0.15), strict=True):
            values = [np.array([each.compared[i] for each in by[solver]]) for by in runs.values()]
            scale = [np.mean([each.compared[i] for each in by["explicit"]]) for by in runs.values()]
            middle = np.array([one.mean() / by for one, by in zip(values, scale, strict=True)])
            spread = np.array([one.std() / by for one, by in zip(values, scale, strict=True)])
            look = plotting.STYLES[of]
            ax.errorbar(middle, rows + shift, xerr=spread, fmt="o", color=look["color"], capsize=3, label=look["label"])
        ax.set_xlabel(f"{label},\nover the mean of explicit steps [-]", fontsize=9)
        ax.axvline(1.0, color="0.8", zorder=0)
        ax.locator_params(axis="x", nbins=5)
    axes[0].set_yticks(rows, list(runs))
    axes[0].invert_yaxis()
    axes[0].legend(frameon=False, fontsize=9)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the scenes by both codes."""
    parser = cli.parser(__doc__, "second_opinion")
    parser.add_argument("--scenes", nargs="*", choices=list(SCENES), default=list(SCENES), help="which scenes")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="runs of each by each code")
    args = parser.parse_args(argv)
    out, seeds = cli.folder(args.out), 1 if args.quick else args.seeds
    names = ["off a table"] if args.quick else args.scenes
    runs: dict[str, dict[str, list[Fall]]] = {}
    with tqdm(total=2 * seeds * len(names), desc="falls", disable=None, leave=False) as bar:
        for name in names:
            case, runs[name] = SCENES[name](), {solver: [] for solver in SOLVERS}
            for solver in SOLVERS:
                for seed in range(seeds):
                    runs[name][solver].append(fall(nudged(case, seed), solver))
                    bar.update()
    header = ["scene", "blocks", "code", *COMPARED, "overlap", "time [s]", "apart over scatter"]
    rows: list[list[object]] = []
    for name, by in runs.items():
        parted = apart(by["explicit"], by["plain"])
        for solver, falls in by.items():
            compared = np.array([each.compared for each in falls])
            cells = [f"{values.mean():.3g} +- {values.std():.2g}" for values in compared.T]
            overlap, seconds = max(each.overlap for each in falls), np.mean([each.seconds for each in falls])
            far = " ".join("-" if math.isnan(value) else f"{value:.1f}" for value in parted)
            blocks = len(falls[0].end)
            rows.append(
                [name, blocks, solver, *cells, f"{overlap:.2%}", f"{seconds:.2g}", far if solver == "plain" else ""]
            )
    cli.report(out / "second_opinion", cli.table(header, rows), header, rows)
    plotting.save(drawn(runs), out / "second_opinion.png")


if __name__ == "__main__":
    sys.exit(cli.run(main))
