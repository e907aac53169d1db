"""How much faster this version is than an earlier one: ratios of medians, both measured in turn in one run.

The earlier version is taken from the repository's history. Each version runs in a process of its own and does the same
tasks, one call of this version after one of the other, so that a machine that is slow for a while is slow for both.
"""

from __future__ import annotations

import io
import math
import os
import statistics
import subprocess
import sys
import tarfile
import tempfile
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, K_N

ROOT = Path(__file__).parents[2]
BEFORE = "7b8ab7b"
"""The last commit without compiled loops."""
E_THEORY = mr.Restitution.from_geometry(FIGURE_3.alpha)
CONTACTS = mr.Contacts.from_law(FIGURE_3, E_THEORY, k_base=K_N, k_side=K_N, law=mr.CALIBRATED)
MOTION = mr.GroundMotion.synthetic(3.0, 10.0, seed=1)


def shaken(scale: float, polarity: int, solver: str) -> mr.Analysis:
    """The Figure 3 wall under the record, scaled."""
    case = mr.Case(FIGURE_3, 0.0, 12.0, motion=MOTION.scaled(scale).polarities[polarity])
    return mr.Analysis(case, solver, e=E_THEORY, contacts=CONTACTS, options={"output_step": 0.05})


def campaign(count: int, solver: str) -> float:
    """Seconds a wall of a campaign on all cores, the start of its workers excluded."""
    tasks = [shaken(0.5 + 1.5 * i / count, i % 2, solver) for i in range(count)]
    with tempfile.TemporaryDirectory() as folder:

        def spent(some: list[mr.Analysis], name: str) -> float:
            return cli.seconds(lambda: mr.campaign(some, Path(folder) / name, workers=int(os.environ[CORES])))

        few, every = spent(tasks[: count // 4], "few.sqlite"), spent(tasks, "all.sqlite")
        return (every - few) / (count - count // 4)


def another_wall() -> mr.Response:
    """A wall that has not been simulated before: text and compilation included."""
    another_wall.count += 1  # type: ignore[attr-defined]
    wall = mr.Block(b=0.3 * (1 + 1e-6 * another_wall.count), h=2.1)  # type: ignore[attr-defined]
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05, k_side=K_N, xi_side=0.01)
    return mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 3.0), contacts)


another_wall.count = 0  # type: ignore[attr-defined]


def set_up(blocks: int) -> float:
    """Processor seconds from nothing to the first explicit step of a wall in running bond; NaN in a version without.

    A version that does not say what its steps took has the first step in it.
    """
    if not hasattr(mr, "solve_explicit"):
        return math.nan
    set_up.count += 1  # type: ignore[attr-defined]
    rows, density = round((blocks / 2) ** 0.5), 2000.0 + set_up.count  # type: ignore[attr-defined]
    begun = time.process_time()
    wall = mr.Masonry.running_bond(0.5 * round(blocks / rows), 0.25 * rows, (0.5, 0.25), density=density, k_s=1e10)
    answer = mr.solve_explicit(mr.MasonryCase(wall, 1e-6), output_step=1e-6)
    return time.process_time() - begun - float(answer.stats.get("stepping_processor_time", 0.0))


set_up.count = 0  # type: ignore[attr-defined]


def small_wall(peak: float) -> float:
    """Seconds of explicit steps of a wall of 18 blocks on ground that swings with some amplitude [m/s2]; NaN in a
    version without."""
    if not hasattr(mr, "solve_explicit"):
        return math.nan
    wall = mr.Masonry.running_bond(1.6, 0.8, (0.4, 0.2), 0.3, k_n=1e8, k_s=4e7)
    case = mr.MasonryCase(wall, 1.0, mr.GroundMotion.sine(peak, 1.0, 3))
    return cli.seconds(lambda: mr.solve_explicit(case))


ONE_SIDED = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 3.0)
TWO_SIDED = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 6.0, side_stop=False)
UNDER_RECORD = mr.Case(FIGURE_3, 0.0, 12.0, motion=MOTION)
CALLS: dict[str, Callable[[], object]] = {
    "one-sided, 3 s, fitted steps": lambda: mr.simulate(ONE_SIDED, CONTACTS),
    "two-sided, 6 s, fitted steps": lambda: mr.simulate(TWO_SIDED, CONTACTS),
    "one-sided, a new wall each time": another_wall,
    "10 s record, MuJoCo, fitted steps": lambda: mr.simulate(UNDER_RECORD, CONTACTS),
    "one-sided, 3 s, rocking theory": lambda: mr.solve_analytical(ONE_SIDED, E_THEORY),
    "two-sided, 6 s, rocking theory": lambda: mr.solve_analytical(TWO_SIDED, E_THEORY),
    "10 s record, rocking theory": lambda: mr.solve_analytical(UNDER_RECORD, E_THEORY),
    "10 s record, rocking theory, output_step 0.05 s": lambda: mr.solve_analytical(
        UNDER_RECORD, E_THEORY, output_step=0.05
    ),
    "one-sided, 3 s, fixed step 0.1 ms": lambda: mr.simulate(ONE_SIDED, CONTACTS, 1e-4),
}
SMALL_WALLS = {"wall of 18 blocks, 1 s, explicit steps": 2.5, "the same as it falls": 9.0}
"""Amplitude of the ground under each [m/s2]."""
CAMPAIGNS = {"campaign, rocking theory, a wall": "analytical", "campaign, MuJoCo, a wall": "MuJoCo"}
SET_UPS = {f"set-up of {count} blocks, explicit steps": count for count in (50, 1000, 2000, 4000)}
"""Processor time of each; the first one warms up, and is the only one of the quick mode."""
CORES = "SPEED_CORES"
"""Environment variable with the cores for the campaigns of a version; an earlier one does not know a quota of them."""
SIZES = {"analytical": (2000, 100), "MuJoCo": (160, 8)}
"""Walls of a campaign, in full and in the quick mode."""


def serve() -> None:
    """Do the tasks that are named on standard input, one a line, and answer with the seconds that each took."""
    warnings.simplefilter("ignore", UserWarning)
    for line in sys.stdin:
        name, size = line.rstrip("\n").split("\t")
        if name in SET_UPS:
            seconds = set_up(SET_UPS[name])
        elif name in SMALL_WALLS:
            seconds = small_wall(SMALL_WALLS[name])
        else:
            seconds = campaign(int(size), CAMPAIGNS[name]) if name in CAMPAIGNS else cli.seconds(CALLS[name])
        print(f"{seconds!r}", flush=True)


class Version:
    """A version of the package in a process of its own."""

    def __init__(self, tree: Path, script: str = __file__, cores: int = 1) -> None:
        self.environment = os.environ | {"PYTHONPATH": f"{tree}{os.pathsep}{ROOT}", "MJROCK_INTERPRET": "0"}
        self.environment[CORES] = str(cores)
        command = [sys.executable, script, "--serve"]
        self.process = subprocess.Popen(
            command, env=self.environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def seconds(self, task: str, size: int = 0) -> float:
        """Seconds of one call of a task."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(f"{task}\t{size}\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError(f"the process of a version ended at {task!r}")
        return float(answer)

    def run(self, code: str, **environment: str) -> float:
        """Seconds that a fresh interpreter says some code takes."""
        command = [sys.executable, "-c", code]
        done = subprocess.run(command, env=self.environment | environment, capture_output=True, text=True, check=True)
        return float(done.stdout)

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


def unpacked(revision: str, folder: Path) -> Path:
    """The package of a revision, in a folder.

    Raises:
        ValueError: if the repository does not know the revision.
    """
    command = ["git", "-C", str(ROOT), "archive", revision, "mjrock"]
    made = subprocess.run(command, capture_output=True, check=False)
    if made.returncode:
        raise ValueError(f"revision {revision!r}: {made.stderr.decode().strip()}")
    with tarfile.open(fileobj=io.BytesIO(made.stdout)) as archive:
        archive.extractall(folder, filter="data")
    return folder


IMPORT = "import time; s = time.perf_counter(); import {}; print(time.perf_counter() - s)"
DEPENDENCIES = "mujoco, numpy, tqdm, scipy.integrate, scipy.interpolate, scipy.optimize, scipy.signal"
FIRST = """
import time, mjrock as mr
w = mr.Block(b=0.3, h=2.1)
e, case = mr.Restitution.from_geometry(w), mr.Case(w, 0.07, 1.0)
c = mr.Contacts.from_damping(w, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.01)
s = time.process_time(); {}; print(time.process_time() - s)
"""
FIRST_RUNS = {
    "rocking theory": "mr.solve_analytical(case, e)",
    "a wall in MuJoCo": "mr.simulate(case, c)",
    "a wall in MuJoCo at a fixed step": "mr.simulate(case, c, 1e-3)",
    "masonry of the plane by explicit steps": "mr.solve_explicit(mr.MasonryCase(mr.Masonry.arch(5.0, 0.75), 0.01))",
    "masonry of space by explicit steps": "mr.solve_explicit(mr.MasonryCase(mr.Masonry.column(1.0, 3.0, 2), 0.01))",
    "masonry of space in MuJoCo": "mr.simulate(mr.MasonryCase(mr.Masonry.column(1.0, 3.0, 2), 0.01))",
}
"""First runs, one after the other: each compiles what those before have not."""


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print the table."""
    options = cli.parser(__doc__, "speed")
    options.add_argument("--against", default=BEFORE, help="the earlier version, a revision of the repository")
    options.add_argument("--serve", action="store_true", help="do the tasks named on standard input")
    args = options.parse_args(argv)
    if args.serve:
        serve()
        return
    from mjrock import machine  # which an earlier version has not

    out = cli.folder(args.out)
    repeats = 1 if args.quick else 25
    rows: list[list[object]] = []

    def row(task: str, here: list[float], there: list[float]) -> None:
        now, before = statistics.median(here), statistics.median(there)
        rows.append([task, f"{before * 1e3:.3f}", f"{now * 1e3:.3f}", f"{before / now:.1f}"])

    with tempfile.TemporaryDirectory() as folder:
        cores = 1 if args.quick else machine.cores()
        here = Version(ROOT, cores=cores)
        versions = here, here if args.quick else Version(unpacked(args.against, Path(folder)), cores=cores)
        try:
            campaigns = list(CAMPAIGNS)[: 1 if args.quick else None]
            for task in tqdm((*CALLS, *SMALL_WALLS, *campaigns), desc="tasks", disable=None, leave=False):
                size = SIZES[CAMPAIGNS[task]][args.quick] if task in CAMPAIGNS else 0
                count = (1 if args.quick else 3) if task in CAMPAIGNS else repeats
                if task not in CAMPAIGNS and not args.quick:
                    for version in versions:
                        version.seconds(task)
                found = [[version.seconds(task, size) for version in versions] for _ in range(count)]
                row(task, *map(list, zip(*found, strict=True)))
            for task in list(SET_UPS)[: 1 if args.quick else None]:
                found = [[version.seconds(task) for version in versions] for _ in range(1 if args.quick else 2)]
                row(task, *map(list, zip(*found, strict=True)))
            fresh = range(1 if args.quick else 7)
            imports = [[version.run(IMPORT.format("mjrock")) for version in versions] for _ in fresh]
            row("import mjrock", *map(list, zip(*imports, strict=True)))
            alone = [versions[0].run(IMPORT.format(DEPENDENCIES)) for _ in fresh]
            stored = [versions[0].run(FIRST.format(FIRST_RUNS["a wall in MuJoCo"])) for _ in fresh]
            cache = {} if args.quick else {"NUMBA_CACHE_DIR": str(Path(folder) / "cache")}
            first_runs = list(FIRST_RUNS.items())[: 1 if args.quick else None]
            firsts = {name: versions[0].run(FIRST.format(run), **cache) for name, run in first_runs}
        finally:
            for version in set(versions):
                version.close()
    text = cli.table(["task", "before [ms]", "now [ms]", "times as fast"], rows)
    text += f"\n\nimport of the dependencies of before alone: {statistics.median(alone) * 1e3:.0f} ms"
    text += f"\nfirst run of a process, loops stored on disk: {statistics.median(stored):.2f} s"
    text += "\nfirst runs of an installation, which compile the loops, of one core [s], each after those before:\n"
    text += "\n".join(f"  {name}: {seconds:.1f}" for name, seconds in firsts.items())
    text += f"\n  all: {sum(firsts.values()):.1f}"
    cli.report(out / "speed", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
