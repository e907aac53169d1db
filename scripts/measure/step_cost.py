"""What a step, a start and a first run cost, before and now, by number of threads and beside plain C of the same law.

Nanoseconds for a contact line of the plane or a point of space and step: walls in running bond, dry and with mortar,
and façades, whose ground accelerates at once, with sprung and with rigid friction. The earlier version is taken from
the repository's history and runs in a process of its own, in turn with this one and its numbers of threads. The fastest
of the turns counts, as other work on the machine only makes steps slower. All poses are checked to be equal to the last
bit for any number of threads. Then set-up, rocking theory, first runs with an empty store, what large scenes take, and
what it costs to keep the forces of joints. Prints the tables, with bytes of the row of a line and digests of the
answers, and writes step_cost.txt, .csv and .png, step_cost_starts.txt, step_cost_waits.txt and step_cost_forces.txt,
each as soon as it is measured.
"""

from __future__ import annotations

import functools
import hashlib
import math
import statistics
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.distinct.setup import setup_of
from mjrock.machine import cores
from mjrock.plotting.style import legend_below
from scripts.measure import speed
from scripts.measure.steps import floor as step_floor
from scripts.measure.steps.tasks import K_SPACE, MORTAR, PUSH, STEPS, STEPS_BEFORE, THEORY, case_of, stepped
from scripts.measure.steps.turns import Turns
from scripts.shared import cli
from scripts.studies import shear_wall

BEFORE = "5c5a262"
"""The version that was measured when the cost of a step was first looked into."""
TASKS = str(Path(__file__).parent / "steps" / "tasks.py")
LINE_STEPS = 5e7
"""Steps times lines of one turn of the earlier version and of plain C: a second or two."""
BATCHES, BATCH = 8, 0.02
"""How often each number of threads makes steps in a turn, and for how long [s]."""
SET_UPS = (1000, 2000, 4000)
SETTLED_IN = 50
"""Blocks of a set-up that warms up."""
PANELS = {"walls, dry": "wall sprung", "walls, mortar": "wall mortar", "façades, dry": "facade sprung"}
"""What the picture shows: the titles of its panels, and the kind and friction of their scenes."""


@functools.cache
def long_case(name: str, whole: bool = False) -> tuple[mr.MasonryCase, float]:
    """A large scene under a record, for a part of its time or the whole, and the time that a user would ask for [s]."""
    record = mr.GroundMotion.synthetic(3.0, 10.0, seed=1)
    if name.startswith("1,000 units"):
        k_s = None if "rigid" in name else K_SPACE
        bond = mr.BONDS[MORTAR] if "mortar" in name else None
        points = 3 if bond else 2
        masonry = mr.Masonry.running_bond(15.0, 8.0, (0.5, 0.25), k_n=K_SPACE, k_s=k_s, bond=bond, points=points)
        return mr.MasonryCase(masonry, 10.0 if whole else 0.5, motion=record), 10.0
    if name.startswith("façade"):
        masonry = mr.Masonry.facade(4.0, 3.0, 1.0, (0.5, 0.25), k_n=K_SPACE, k_s=K_SPACE)
        return mr.MasonryCase(masonry, 10.0 if whole else 0.5, motion=record), 10.0
    blocks = [block for block in shear_wall.wall_of(shear_wall.Setting()).blocks if block.name != "beam"]
    masonry = mr.Masonry(blocks, k_n=62.7e9, k_s=27.5e9, friction=0.75, xi=0.02, frequency=2e3 * math.pi)
    return mr.MasonryCase(masonry, 1.0 if whole else 0.02, motion=record), 1.0


WAITS = (
    "1,000 units, sprung, 10 s",
    "1,000 units, mortar, 10 s",
    "1,000 units, rigid, 10 s",
    "façade in space, sprung, 10 s",
    "wall of the size of J4D, dry, 1 s",
)
WAITED = ["scene", "blocks", "lines", "step [us]", "timed [s]", "took [s]", "the whole [s]"]


def waited(name: str, whole: bool = False) -> list[object]:
    """A row of the table of large scenes: blocks, lines, step, what is timed, and how long the whole would take."""
    case, requested = long_case(name, whole)
    lines = len(setup_of(case, None, None).system.lines)
    answer = mr.solve_explicit(case, output_step=0.01 if requested > 1 else 1e-3, threads=1)
    spent, stats = answer.stats["stepping_processor_time"], answer.stats
    setting_up = stats["processor_time"] - spent
    whole = setting_up + spent * requested / case.duration
    blocks = len(answer.of_masonry.masonry.blocks)
    return [name, blocks, lines, f"{stats['timestep'] * 1e6:.1f}", f"{case.duration:g}", f"{spent:.1f}", f"{whole:.0f}"]


def forces_kept(rounds: int) -> list[list[object]]:
    """Rows of the table of forces: blocks, and processor seconds of runs in turn without forces and with them."""
    record = mr.GroundMotion.synthetic(1.0, 10.0, seed=1)
    joints: dict[str, Any] = {"k_n": K_SPACE, "k_s": K_SPACE}
    wall = functools.partial(mr.Masonry.running_bond, 4.0, 2.0, (0.4, 0.2), **joints)
    explicit, engine = functools.partial(mr.solve_explicit, threads=1), mr.simulate
    runs = {
        "wall, explicit steps": (explicit, wall(), 2.0),
        "wall with mortar, explicit steps": (explicit, wall(bond=mr.BONDS[MORTAR], points=3), 2.0),
        "façade in space, explicit steps": (explicit, mr.Masonry.facade(3.2, 1.6, 1.2, (0.4, 0.2), **joints), 1.0),
        "wall, MuJoCo": (engine, mr.Masonry.running_bond(1.6, 0.8, (0.4, 0.2), k_n=1e8), 1.0),
        "façade in space, MuJoCo": (engine, mr.Masonry.facade(1.6, 0.8, 0.8, (0.4, 0.2), k_n=1e8), 0.5),
    }
    rows: list[list[object]] = []
    for name, (solve, masonry, duration) in tqdm(runs.items(), desc="forces", disable=None, leave=False):
        case, took = mr.MasonryCase(masonry, duration, record), dict[bool, list[float]]({False: [], True: []})
        for i in range(2 * rounds + 2):
            begun = time.process_time()
            solve(case, forces=i % 2 == 1, output_step=0.01)
            if i > 1:  # the first of both compile what is not compiled yet
                took[i % 2 == 1].append(time.process_time() - begun)
        without, kept = (statistics.median(times) for times in took.values())
        rows.append([name, len(masonry.free), f"{without:.2f}", f"{kept:.2f}", f"{kept / without:.2f}"])
    return rows


def plain_c(folder: Path, name: str, rounds: int) -> list[float]:
    """Nanoseconds a line and step of plain C, one loop and vectors; none but of walls with sprung joints."""
    if not (name.startswith("wall") and name.endswith("sprung") and step_floor.is_there()):
        return []
    setup = setup_of(case_of(name, 1.0), None, None)
    h, lines = 0.4 * setup.step_length.limit, len(setup.system.lines)
    count = int(LINE_STEPS / lines)
    floor = step_floor.Floor
    return [
        min(floor(setup.system, folder).nanoseconds(h, PUSH[2], count, vectors=vectors) for _ in range(rounds))
        for vectors in (False, True)
    ]


def digest(name: str, steps: int) -> str:
    """The first letters of a digest of the poses of this version after so many steps."""
    first, _ = stepped(name, 1e-6)
    answer, _ = stepped(name, steps * 0.4 * first.stats["stable_timestep"])
    return hashlib.sha256(np.ascontiguousarray(answer.pose[-1]).tobytes()).hexdigest()[:12]


def compared(versions: Sequence[speed.Version], task: str, size: int, rounds: int) -> list[float]:
    """The median seconds of each version for a task, one after the other in each round."""
    found = [[version.seconds(task, size) for version in versions] for _ in range(rounds)]
    return [statistics.median(times) for times in zip(*found, strict=True)]


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print the tables."""
    options = cli.parser(__doc__, "step_cost")
    options.add_argument("--before", default=BEFORE, help="the earlier version, a revision of the repository")
    options.add_argument("--rounds", type=int, default=5, help="turns of the two versions")
    options.add_argument("--steps-only", action="store_true", help="leave out set-up, theory, first runs, large scenes")
    options.add_argument("--whole", action="store_true", help="only the large scenes, for the whole of their time")
    args = options.parse_args(argv)
    if args.whole:
        rows = [waited(name, whole=True) for name in tqdm(WAITS, disable=None, leave=False)]
        cli.report(cli.folder(args.out) / "step_cost_whole", cli.table(WAITED, rows))
        return
    out, rounds = cli.folder(args.out), 1 if args.quick else args.rounds
    with tempfile.TemporaryDirectory() as folder:
        there = speed.ROOT if args.quick else speed.unpacked(args.before, Path(folder))
        trees = (there,) if args.quick else (there, speed.ROOT)
        versions = [speed.Version(tree, TASKS) for tree in trees]
        try:
            steps_measured(out, versions, Path(folder), rounds, quick=args.quick)
            if args.quick or args.steps_only:
                return
            starts = start_table(versions, rounds, Path(folder))
        finally:
            for version in versions:
                version.close()
    cli.report(out / "step_cost_starts", starts)
    waits = cli.table(WAITED, [waited(name) for name in tqdm(WAITS, disable=None, leave=False)])
    cli.report(out / "step_cost_waits", waits)
    header = ["scene", "blocks", "without forces [s]", "with forces [s]", "ratio [-]"]
    cli.report(out / "step_cost_forces", cli.table(header, forces_kept(rounds)))


@dataclass(frozen=True)
class StepCost:
    """What a step of a scene costs: nanoseconds a line and step, of this version for each number of threads."""

    scene: str
    lines: int
    bytes_of_line: int
    digest: str
    before: float | None
    by_threads: dict[int, float]
    plain_c: list[float]

    def row(self, numbers: Sequence[int]) -> list[object]:
        """The row of the table."""
        now = [self.by_threads.get(threads) for threads in numbers]
        times = ["" if value is None else f"{value:.1f}" for value in (self.before, *now)]
        times += [f"{value:.1f}" for value in self.plain_c] or ["", ""]
        gain = "" if now[-1] is None else f"{self.by_threads[1] / now[-1]:.2f}"
        return [self.scene, self.lines, self.bytes_of_line, self.digest, *times, gain]


def step_cost(
    name: str, before: speed.Version, numbers: Sequence[int], rounds: int, folder: Path, line_steps: float
) -> StepCost:
    """What a step of a scene costs, by the earlier version, some numbers of threads and plain C.

    Raises:
        RuntimeError: if the poses of two numbers of threads differ.
    """
    case = case_of(name, 1.0)
    turns = {threads: Turns(case, threads) for threads in (numbers[:1] if name.endswith("rigid") else numbers)}
    rows = turns[1].system.lines
    lines, batch = len(rows), max(5, int(BATCH / (3e-8 * len(rows))))
    earlier: list[float] = []
    by_threads: dict[int, list[float]] = {threads: [] for threads in turns}
    for _ in range(rounds):
        if name in STEPS_BEFORE:
            earlier.append(before.seconds(name, max(10, int(line_steps / lines))) / lines * 1e9)
        for _ in range(BATCHES):
            for threads, turn in turns.items():
                by_threads[threads].append(turn.seconds(batch) / lines * 1e9)
    for threads, turn in turns.items():
        turn.pool.__exit__(None, None, None)
        if not (turn.place == turns[1].place).all():
            raise RuntimeError(f"{name}: {threads} threads have other bits than one")
    best = {threads: min(taken) for threads, taken in by_threads.items()}
    c = plain_c(folder, name, rounds)
    return StepCost(name, lines, rows.dtype.itemsize, digest(name, 200), min(earlier, default=None), best, c)


def figure_of(costs: Sequence[StepCost], numbers: Sequence[int]) -> Figure:
    """Time of a step against the number of lines: a curve for each number of threads, the earlier version, plain C."""
    figure = Figure(figsize=(7.4, 3.2), layout="constrained")
    axes = figure.subplots(1, len(PANELS), sharex=True, sharey=True)
    for ax, (title, kind) in zip(axes, PANELS.items(), strict=True):
        shown = [cost for cost in costs if [cost.scene.split()[i] for i in (0, 2)] == kind.split()]
        curves = {
            ("1 thread" if threads == 1 else f"{threads} threads"): [cost.by_threads[threads] for cost in shown]
            for threads in numbers
        }
        curves |= {
            "one thread, earlier version": [cost.before or np.nan for cost in shown],
            "plain C, one loop": [cost.plain_c[0] if cost.plain_c else np.nan for cost in shown],
        }
        lines = np.array([cost.lines for cost in shown])
        for i, (label, taken) in enumerate(curves.items()):
            now = i < len(numbers)
            style: dict[str, Any] = {"color": plotting.PALETTE[i % len(plotting.PALETTE)]} if now else {"color": "0.5"}
            style["ls"] = "-" if now else ("--", ":")[i - len(numbers)]
            ax.loglog(lines, lines * np.array(taken) * 1e-3, "o", ms=3, lw=1.2, label=label, **style)
        ax.set_title(title, fontsize=9)
        ax.set_xlabel("contact lines [-]")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("time of a step [µs]")
    handles, labels = axes[0].get_legend_handles_labels()
    legend_below(figure, handles, labels, len(labels), fontsize=9)
    return figure


def numbers_of_threads(quick: bool) -> list[int]:
    """1, 2, 4 and so on, up to the cores of this process."""
    most = 2 if quick else max(2, cores())
    return [2**i for i in range(most.bit_length()) if 2**i <= most]


def steps_measured(out: Path, versions: Sequence[speed.Version], folder: Path, rounds: int, *, quick: bool) -> None:
    """Measure the steps, and write table and picture."""
    numbers, names = numbers_of_threads(quick), STEPS[:1] if quick else STEPS
    line_steps = LINE_STEPS / (250 if quick else 1)
    costs = [
        step_cost(name, versions[0], numbers, rounds, folder, line_steps)
        for name in tqdm(names, desc="steps", disable=None, leave=False)
    ]
    threads = [f"{number} thread{'s' * (number > 1)} [ns]" for number in numbers]
    header = ["scene", "lines", "bytes of a line", "digest", "before [ns]", *threads]
    header += ["C, one loop [ns]", "C, vectors [ns]", f"1 over {numbers[-1]} threads"]
    rows = [cost.row(numbers) for cost in costs]
    cli.report(out / "step_cost", cli.table(header, rows), header, rows)
    plotting.save(figure_of(costs, numbers), out / "step_cost.png")


def start_table(versions: Sequence[speed.Version], rounds: int, folder: Path) -> str:
    """Set-up and rocking theory of both versions, and first runs of this one, with an empty store."""
    rows: list[list[object]] = []
    compared(versions, "set-up", SETTLED_IN, 1)
    for count in SET_UPS:
        taken = compared(versions[count > SET_UPS[1] :], "set-up", count, 1)
        rows.append([f"set-up of {count} blocks [s]", *[""] * (2 - len(taken)), *(f"{value:.2f}" for value in taken)])
    for name in THEORY:
        rows.append([f"{name} [ms]", *(f"{value * 1e3:.2f}" for value in compared(versions, name, 0, rounds))])
    for name, run in speed.FIRST_RUNS.items():
        runs = [
            version.run(speed.FIRST.format(run), NUMBA_CACHE_DIR=str(folder / f"store{i}"))
            for i, version in enumerate(versions)
        ]
        rows.append([f"first run: {name} [s]", *(f"{value:.1f}" for value in runs)])
    return cli.table(["start", "before", "now"], rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
