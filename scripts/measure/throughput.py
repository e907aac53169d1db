"""Campaigns measured: cases per second on one core and on all, memory over the run, and what kill -9 leaves behind.

One campaign of 10,000 cases in rocking theory, one of 2,000 in MuJoCo with steps that fit the motion, and fixed-step
runs of one geometry by MuJoCo's threads, by processes and as the campaign chooses. Then the campaign of rocking theory
once more in a process of its own: killed, resumed, one of its workers killed, and its table compared with that of the
undisturbed run.
"""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

import mjrock as mr
from mjrock import machine
from scripts.shared import cli, suite
from scripts.shared.paper import FIGURE_3, K_N


def shaken(solver: str, seed: int, slenderness: float, pga: float, polarity: int) -> mr.Analysis:
    """A wall under a synthetic record."""
    motion = suite.to_peak(mr.GroundMotion.synthetic(3.0, 10.0, seed=seed, dt=0.02), pga).polarities[polarity]
    return suite.analysis(mr.Block.from_slenderness(slenderness, 2.1), motion, solver, k_n=K_N, settling=2.0)


def fixed(seed: int, pga: float) -> mr.Analysis:
    """The wall of Figure 3 at a fixed step of 1 ms."""
    motion = suite.to_peak(mr.GroundMotion.synthetic(3.0, 10.0, seed=seed, dt=0.02), pga)
    made = suite.analysis(FIGURE_3, motion, "MuJoCo", k_n=K_N, settling=2.0)
    return mr.Analysis(made.case, contacts=made.contacts, options={"timestep": 1e-3, "output_step": 0.05})


def cases(solver: str, count: int) -> Watched:
    """`count` cases, a multiple of 200, or of 20 below, over record, slenderness, intensity and polarity."""
    levels, slenderness = np.linspace(0.1, 0.8, 10).tolist(), np.linspace(5, 12, min(count // 20, 10)).tolist()
    seeds = range(max(count // 200, 1))
    return Watched(shaken, solver=[solver], seed=seeds, slenderness=slenderness, pga=levels, polarity=(0, 1))


class Watched(mr.Grid):
    """A grid that notes the largest memory that this process has had when it is asked for a task [MB]."""

    def __init__(self, build: Any, **axes: Any) -> None:
        super().__init__(build, **axes)
        self.memory: dict[int, float] = {}

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, int):
            self.memory[index] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        return super().__getitem__(index)

    def growth(self) -> str:
        """Memory after a fifth of the cases, and what came on top until the end."""
        early, late = (self.memory[i] for i in (len(self) // 5, len(self) - 1))
        return f"{early:.0f} + {late - early:.0f}"


def timed(tasks: Any, store: Path, **options: Any) -> float:
    """Seconds of a campaign that starts from nothing."""
    for old in store.parent.glob(store.name + "*"):
        old.unlink()
    return cli.seconds(lambda: mr.campaign(tasks, store, **options))


def workers(campaign: int) -> list[int]:
    """The processes that a campaign has started to work for it."""
    found = subprocess.run(["ps", "-ww", "-o", "pid=,args=", "--ppid", str(campaign)], capture_output=True, text=True)
    return [int(line.split()[0]) for line in found.stdout.splitlines() if "spawn_main" in line]


def disturbed(count: int, store: Path, expected: str) -> list[list[object]]:
    """Kill a campaign, and then a worker of the one that carries on."""
    for old in store.parent.glob(store.name + "*"):
        old.unlink()
    command = [sys.executable, __file__, "--worker", str(count), str(store)]

    def rows() -> int:
        with contextlib.suppress(OSError, ValueError), mr.Store(store) as file:
            return len(file)
        return 0

    table: list[list[object]] = []
    for what, share in (("the campaign", 0.1), ("a worker", 0.3)):
        run = subprocess.Popen(command)
        victims = [run.pid] if what == "the campaign" else []
        while (rows() < share * count or not victims) and run.poll() is None:
            time.sleep(0.05)
            if what == "a worker":
                victims = workers(run.pid)
        if run.poll() is not None:
            raise ValueError(f"the campaign ended with {rows()} of {count} cases before {what} could be killed")
        victim = victims[0]
        os.kill(victim, signal.SIGKILL)
        kept = rows()
        run.wait()
        table.append([f"kill -9 of {what}", kept, rows()])
    with mr.Store(store) as file:
        same = "yes" if file.csv(timings=False) == expected else "NO"
    table.append(["table equal to the undisturbed one", "", same])
    return table


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print the tables."""
    options = cli.parser(__doc__, "throughput")
    options.add_argument("--worker", nargs=2, metavar=("COUNT", "STORE"), help="run one campaign and nothing else")
    args = options.parse_args(argv)
    if args.worker:
        mr.campaign(cases("analytical", int(args.worker[0])), args.worker[1])
        return
    out = cli.folder(args.out)
    store, cores = out / "throughput.sqlite", machine.cores()
    sizes = {"analytical": 1_000} if args.quick else {"analytical": 10_000, "MuJoCo": 2_000}
    rows: list[list[object]] = []
    undisturbed = ""
    for solver, count in sizes.items():
        name = {"analytical": "rocking theory", "MuJoCo": "MuJoCo, fitted steps"}[solver]
        grid = cases(solver, count)
        alone = grid[:: 10 if args.quick else 7]
        one = len(alone) / timed(alone, store, workers=1)
        all_cores = len(grid) / timed(grid, store)
        if solver == "analytical":
            with mr.Store(store) as file:
                undisturbed = file.csv(timings=False)
        rows.append([name, len(grid), f"{one:.0f}", f"{all_cores:.0f}", f"{all_cores / one:.2f}", grid.growth()])
    size = 2 if args.quick else 20
    batch = mr.Grid(fixed, seed=range(size), pga=np.linspace(0.1, 0.8, size).tolist())
    one = len(batch) / timed(batch, store, workers=1)
    with ProcessPoolExecutor(1 if args.quick else cores, mp_context=get_context("spawn")) as pool:
        mr.campaign([shaken("analytical", 0, 7.0, 0.1, 0)] * cores, out / "warm.sqlite", executor=pool)
        (out / "warm.sqlite").unlink()
        warm = len(batch) / timed(batch, store, executor=pool)
    chosen = len(batch) / timed(batch, store)
    for name, rate in (("processes that run already", warm), ("as the campaign chooses", chosen)):
        rows.append([f"MuJoCo, 1 ms, {name}", len(batch), f"{one:.0f}", f"{rate:.0f}", f"{rate / one:.2f}", ""])
    header = ["campaign", "cases", "cases/s, 1 core", f"cases/s, {cores} cores", "ratio", "memory [MB]"]
    text = cli.table(header, rows)
    kills = disturbed(sizes["analytical"], store, undisturbed)
    text += "\n\n" + cli.table(["rocking theory", "rows at the kill", "rows at the end"], kills)
    for old in out.glob("throughput.sqlite*"):
        old.unlink()
    cli.report(out / "throughput", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
