"""The first minute: how long a newcomer waits for an answer where no loop is stored, and from a clone to a picture.

Each row is a process of its own that imports the package and solves one problem. "first answer" has nothing stored.
"compiled first" has nothing stored either and waits for the compiler, as MJROCK_INTERPRET=0 asks. "full speed" is the
time after which another process has stored the loops. "stored" takes stored loops. "plain" is without the compiler.
With --clone the demo of a fresh clone is timed too, of this commit and of --against, in turn.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tqdm import tqdm

from scripts.shared import cli

ROOT = Path(__file__).parents[2]
BEFORE = "15d7b1f"
"""The last commit that waited for the compiler."""
SET_UP = """
import time; begun = time.perf_counter()
import sys, mjrock as mr
wall = mr.Block.from_size(0.6, 4.2)
e = mr.Restitution.from_geometry(wall)
contacts = mr.Contacts.from_law(wall, e, k_base=5e8, k_side=5e8)
record = mr.GroundMotion.synthetic(4.0, 10.0, seed=1)
stack, arch = mr.Masonry.stack([wall] * 3, 1e9), mr.Masonry.arch(5.0, 0.75)
def run():
    {}
run()
first = time.perf_counter() - begun
print(first)
"""
UNTIL_STORED = """
from mjrock import patience
while "numba" not in sys.modules and patience._here.compiling is not None and time.perf_counter() - begun < 300:
    time.sleep(0.2)
    patience.news()
print(time.perf_counter() - begun)
"""
RUNS = {
    "the wall of the README, 3 s": "mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 3.0), contacts)",
    "the same by theory": "mr.solve_analytical(mr.Case(wall, 0.5 * wall.alpha, 3.0), e)",
    "a wall under a record of 10 s": "mr.simulate(mr.Case(wall, 0.0, 10.0, motion=record), contacts)",
    "a stack of three, 3 s": "mr.simulate(mr.MasonryCase(stack, 3.0, motion=record.scaled(0.3)))",
    (EXPLICIT := "an arch by explicit steps, 1 s"): "mr.solve_explicit(mr.MasonryCase(arch, 1.0, motion=record))",
}


def seconds(folder: Path, code: str, **environment: str) -> list[float]:
    """What a program prints that takes the package in a folder [s]."""
    setting = {name: value for name, value in os.environ.items() if not name.startswith(("MJROCK_", "NUMBA_"))}
    setting |= {"PYTHONPATH": str(folder), "PYTHONWARNINGS": "ignore"} | environment
    command = [sys.executable, "-c", code]  # which looks for the package in its folder first
    done = subprocess.run(command, cwd=folder, env=setting, capture_output=True, text=True, check=True)
    return [float(line) for line in done.stdout.split()]


def emptied(folder: Path) -> None:
    """Forget all loops that are stored."""
    for stored in folder.rglob("*.nb[ic]"):
        stored.unlink()


def times(folder: Path, name: str) -> list[str]:
    """First answer, full speed, compiled first, stored, plain Python: of one problem [s]."""
    code = SET_UP.format(RUNS[name])
    emptied(folder)
    (first,) = seconds(folder, code)
    emptied(folder)
    _, full = seconds(folder, code + UNTIL_STORED)
    emptied(folder)
    (compiled,) = seconds(folder, code, MJROCK_INTERPRET="0")
    (stored,) = seconds(folder, code)
    plain = f"{seconds(folder, code, NUMBA_DISABLE_JIT='1')[0]:.2f}" if name != EXPLICIT else ""
    return [f"{first:.2f}", "" if name == EXPLICIT else f"{full:.1f}", f"{compiled:.1f}", f"{stored:.2f}", plain]


def demo(revision: str, folder: Path) -> float:
    """Time from a fresh clone of a revision to the picture of `make demo` [s]."""
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(folder)], check=True)
    subprocess.run(["git", "-C", str(folder), "checkout", "--quiet", revision], check=True)
    took = cli.seconds(lambda: subprocess.run(["make", "demo"], cwd=folder, check=True, capture_output=True))
    if not (folder / "out/demo/comparison.png").stat().st_size:
        raise RuntimeError("make demo wrote no picture")
    shutil.rmtree(folder)
    return took


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print and write the tables."""
    options = cli.parser(__doc__, "first_minute")
    options.add_argument("--clone", action="store_true", help="time `make demo` of a fresh clone too")
    options.add_argument("--against", default=BEFORE, help="the earlier version, a revision of the repository")
    args = options.parse_args(argv)
    out, names = cli.folder(args.out), list(RUNS)[1:2] if args.quick else list(RUNS)
    header = ["[s]", "first answer", "full speed after", "compiled first", "stored", "plain"]
    rows: list[list[object]] = []
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        shutil.copytree(ROOT / "mjrock", folder / "mjrock", ignore=shutil.ignore_patterns("__pycache__"))
        for name in tqdm(names, desc="first runs", disable=None, leave=False):
            rows.append([name, *times(folder, name)])
        if args.clone:
            for revision in (args.against, "HEAD"):
                rows.append([f"make demo of {revision}", f"{demo(revision, folder / 'clone'):.0f}", "", "", "", ""])
    cli.report(out / "first_minute", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
