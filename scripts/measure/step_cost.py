"""What a step, a start and a first run cost, before and now, beside plain C of the same law.

Nanoseconds of the processor for a contact line of the plane or a point of space and step: walls in running bond and
façades, whose ground accelerates at once, with sprung and with rigid friction. The earlier version is taken from the
repository's history and runs in a process of its own, in turn with this one. Then set-up, rocking theory, first runs
with an empty store, what large scenes take, and what it costs to keep the forces of joints. Prints the tables, and
digests of the answers of this version, and writes step_cost.txt and .csv, step_cost_starts.txt,
step_cost_waits.txt and step_cost_forces.txt, each as soon as it is measured.
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
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock.distinct.setup import setup_of
from scripts.measure import speed
from scripts.measure.steps import floor as step_floor
from scripts.measure.steps.tasks import K_SPACE, PUSH, STEPS, THEORY, case_of, stepped
from scripts.shared import cli
from scripts.studies import shear_wall

BEFORE = "5c5a262"
"""The version that was measured when the cost of a step was first looked into."""
TASKS = str(Path(__file__).parent / "steps" / "tasks.py")
LINE_STEPS = 5e7
"""Steps times lines that are timed: a second or two, some ten with rigid friction in space."""
SET_UPS = (1000, 2000, 4000)
SETTLED_IN = 50
"""Blocks of a set-up that warms up."""
MORTAR = mr.BONDS["cement mortar, wall J4D"]
HEADER = ["scene", "lines", "digest", "before [ns]", "now [ns]", "C, one loop [ns]", "C, vectors [ns]"]


@functools.cache
def long_case(name: str, whole: bool = False) -> tuple[mr.MasonryCase, float]:
    """A large scene under a record, for a part of its time or the whole, and the time that a user would ask for [s]."""
    record = mr.GroundMotion.synthetic(3.0, 10.0, seed=1)
    if name.startswith("1,000 units"):
        k_s = None if "rigid" in name else K_SPACE
        bond = MORTAR if "mortar" in name else None
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
    case, asked = long_case(name, whole)
    lines = len(setup_of(case, None, None).system.lines)
    answer = mr.solve_explicit(case, output_step=0.01 if asked > 1 else 1e-3, threads=1)
    spent, stats = answer.stats["stepping_processor_time"], answer.stats
    setting_up = stats["processor_time"] - spent
    whole = setting_up + spent * asked / case.duration
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
        "wall with mortar, explicit steps": (explicit, wall(bond=MORTAR, points=3), 2.0),
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


def floors(folder: Path, names: Sequence[str], rounds: int) -> dict[str, list[float]]:
    """Nanoseconds a line and step of plain C, one loop and vectors, of the sprung walls."""
    found = {}
    for name in names:
        if not name.startswith("wall") or name.endswith("rigid") or not step_floor.is_there():
            continue
        setup = setup_of(case_of(name, 1.0), None, None)
        h, lines = 0.4 * setup.step_length.limit, len(setup.system.lines)
        count = int(LINE_STEPS / lines)
        taken = [
            [
                step_floor.Floor(setup.system, folder).nanoseconds(h, PUSH[2], count, vectors=vectors)
                for _ in range(rounds)
            ]
            for vectors in (False, True)
        ]
        found[name] = [statistics.median(times) for times in taken]
    return found


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
    names = STEPS[:1] if args.quick else STEPS
    with tempfile.TemporaryDirectory() as folder:
        there = speed.ROOT if args.quick else speed.unpacked(args.before, Path(folder))
        versions = speed.Version(there, TASKS), speed.Version(speed.ROOT, TASKS)
        try:
            text, rows = step_table(versions, floors(Path(folder), names, rounds), names, rounds)
            cli.report(out / "step_cost", text, HEADER, rows)
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


def step_table(
    versions: Sequence[speed.Version], floor: dict[str, list[float]], names: Sequence[str], rounds: int
) -> tuple[str, list[list[object]]]:
    """Nanoseconds a line and step of scenes, as a table and as rows."""
    rows: list[list[object]] = []
    for name in tqdm(names, desc="steps", disable=None, leave=False):
        lines = len(setup_of(case_of(name, 1.0), None, None).system.lines)
        count = max(10, int(LINE_STEPS / lines / (1 if len(names) > 1 else 250)))
        compared(versions, name, 10, 1)
        taken = [f"{seconds / lines * 1e9:.1f}" for seconds in compared(versions, name, count, rounds)]
        plain = [f"{value:.1f}" for value in floor.get(name, [])] or ["", ""]
        rows.append([name, lines, digest(name, 200), *taken, *plain])
    return cli.table(HEADER, rows), rows


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
