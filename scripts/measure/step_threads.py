"""What a step costs by number of contact lines, and by number of threads of one run.

Walls in running bond, dry and with mortar, and façades in space, whose ground accelerates at once, followed by explicit
steps. The numbers of threads take turns, and the fastest of the rounds counts, as other work on the machine only makes
steps slower. Prints bytes of the row of a line and nanoseconds of the clock a line and step, checks that all poses are
equal to the last bit, and writes step_threads.txt, .csv and .png.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.compiled import for_types_of
from mjrock.distinct.loop import Clock, advance
from mjrock.distinct.setup import setup_of
from mjrock.distinct.system import Books, Samples
from mjrock.distinct.thread import threads_of
from mjrock.distinct.thread_pool import ThreadPool
from mjrock.machine import cores
from mjrock.quantities import Array
from scripts.measure.steps.tasks import K_N, K_SPACE
from scripts.shared import cli

KINDS = ("wall, dry", "wall, mortar", "façade in space, dry")
BLOCKS = {
    "wall, dry": (50, 200, 450, 1000, 3873),
    "wall, mortar": (50, 200, 1000),
    "façade in space, dry": (50, 150, 500),
}
MORTAR = mr.BONDS["cement mortar, wall J4D"]
BATCH = 0.02
"""Time of the steps between two turns of the numbers of threads [s]."""
HEADER = ("scene", "blocks", "lines", "bytes of a line")


def case_of(kind: str, blocks: int) -> mr.MasonryCase:
    """A scene of some blocks."""
    if kind.startswith("wall"):
        rows = max(1, round(math.sqrt(blocks)))
        bond = MORTAR if "mortar" in kind else None
        size = max(1, round(blocks / rows)) * 0.4, rows * 0.2
        masonry = mr.Masonry.running_bond(*size, (0.4, 0.2), k_n=K_N, k_s=K_N, bond=bond, points=3 if bond else 2)
        return mr.MasonryCase(masonry, 1.0, motion=mr.GroundMotion([5.0, 5.0], 1.0))
    length = 0.45 * math.sqrt(blocks)
    masonry = mr.Masonry.facade(length, 0.6 * length, 1.0, (0.5, 0.25), k_n=K_SPACE, k_s=K_SPACE)
    return mr.MasonryCase(masonry, 1.0, motion=mr.GroundMotion([0.5, 0.5], 1.0))


class Turns:
    """A scene that is followed on by some threads in its turns."""

    def __init__(self, case: mr.MasonryCase, threads: int) -> None:
        setup = setup_of(case, None, None)
        self.system, self.pool = setup.system, ThreadPool(threads)
        self.books = Books.empty(self.system, len(setup.scene.contacts.joints) + 1)
        self.samples = Samples.room(2, self.system, self.books)
        start = (0.0,) * len(self.system.axes)
        self.clock = Clock(0, setup.step_length.default, 10**9, 0, 1, 10**9, math.inf, 0.0, start, 10**9)
        (alone,), _ = threads_of(self.system.bodies, self.system.lines, 1)
        advance(self.system, self.books, self.samples, self.clock, alone)
        self.clock = self.clock._replace(step=1, row=1)
        self.steps = for_types_of(advance, self.system, self.books, self.samples, self.clock, alone)

    def seconds(self, count: int) -> float:
        """Time of a step, from so many of them [s]."""
        begun = time.perf_counter()
        self.clock = self.clock._replace(stop=self.clock.step + count)
        self.pool.run(self.steps, self.system, self.books, self.samples, self.clock)
        self.clock = self.clock._replace(step=self.clock.stop)
        return (time.perf_counter() - begun) / count

    @property
    def place(self) -> Array:
        """Where the blocks are [m]."""
        return np.asarray(self.system.bodies["place"])


def measured(kind: str, blocks: int, numbers: Sequence[int], rounds: int) -> list[object]:
    """A row: scene, blocks, lines, bytes of a line, and nanoseconds a line and step for each number of threads."""
    case = case_of(kind, blocks)
    turns = [Turns(case, threads) for threads in numbers]
    lines = turns[0].system.lines
    count = max(5, int(BATCH / (3e-8 * len(lines))))
    taken = np.array([[turn.seconds(count) for turn in turns] for _ in range(rounds)]).min(axis=0)
    for turn in turns:
        turn.pool.__exit__(None, None, None)
        if not (turn.place == turns[0].place).all():
            raise RuntimeError(f"{kind} of {blocks} blocks: {turn.pool.threads} threads have other bits than one")
    return [kind, len(case.masonry.free), len(lines), lines.dtype.itemsize, *taken / len(lines) * 1e9]


def figure_of(rows: Sequence[Sequence[object]], numbers: Sequence[int]) -> Figure:
    """Time of a step against the number of lines, a curve for each number of threads."""
    figure = Figure(figsize=(7.4, 3.2), layout="constrained")
    axes = figure.subplots(1, len(KINDS), sharex=True, sharey=True)
    for ax, kind in zip(axes, KINDS, strict=True):
        found = np.array([row[2:] for row in rows if row[0] == kind], dtype=float)
        for i, threads in enumerate(numbers):
            label = "1 thread" if threads == 1 else f"{threads} threads"
            colour = plotting.PALETTE[i % len(plotting.PALETTE)]
            ax.loglog(found[:, 0], found[:, 0] * found[:, 2 + i] * 1e-3, "o-", color=colour, ms=3, lw=1.2, label=label)
        ax.set_title(kind, fontsize=9)
        ax.set_xlabel("contact lines [-]")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("time of a step [µs]")
    axes[0].legend(frameon=False, fontsize=8)
    return figure


def all_numbers(quick: bool) -> Iterator[int]:
    """1, 2, 4 and so on, up to the cores of this process."""
    most, threads = 2 if quick else max(2, cores()), 1
    while threads <= most:
        yield threads
        threads *= 2


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and write table and picture."""
    options = cli.parser(__doc__, "step_threads")
    options.add_argument("--rounds", type=int, default=40, help="turns of the numbers of threads")
    args = options.parse_args(argv)
    out, numbers, rounds = cli.folder(args.out), [*all_numbers(args.quick)], 2 if args.quick else args.rounds
    scenes = [(kind, blocks) for kind in KINDS for blocks in (BLOCKS[kind][:1] if args.quick else BLOCKS[kind])]
    rows = [measured(kind, blocks, numbers, rounds) for kind, blocks in tqdm(scenes, disable=None, leave=False)]
    header = [*HEADER, *(f"{threads} [ns]" for threads in numbers), f"1 over {numbers[-1]}"]
    shown = [
        [*row[:4], *(f"{value:.1f}" for value in row[4:]), f"{float(str(row[4])) / float(str(row[-1])):.2f}"]
        for row in rows
    ]
    cli.report(out / "step_threads", cli.table(header, shown), header, shown)
    plotting.save(figure_of(rows, numbers), out / "step_threads.png")


if __name__ == "__main__":
    sys.exit(cli.run(main))
