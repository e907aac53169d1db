"""The first minute: how long a newcomer waits for an answer where no loop is stored, and from a clone to a picture.

Each row is a process of its own that imports the package and solves one problem. "first answer" has nothing stored.
"compiled first" has nothing stored either and waits for the compiler, as MJROCK_INTERPRET=0 asks. "full speed" is the
time after which another process has stored the loops. "stored" takes stored loops. "plain" is without the compiler.
With --clone the demo of a fresh clone is timed too, of this commit and of --against, in turn.

A second table has three starts of one short script, one after the other: the wall of the README eight times in each
solver. The next start begins when no process compiles any more. "before" is KILLED, the last commit whose compiler
ended with the script.
"""

from __future__ import annotations

import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Sequence
from pathlib import Path

from filelock import FileLock
from tqdm import tqdm

from mjrock.background_compilation import ENDING
from scripts.shared import cli

ROOT = Path(__file__).parents[2]
BEFORE = "15d7b1f"
"""The last commit that waited for the compiler."""
KILLED = "1fb55d24"
"""The last commit whose compiler ended with the script."""
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
from mjrock import background_compilation as behind
while "numba" not in sys.modules and behind._process.compiler is not None and time.perf_counter() - begun < 300:
    time.sleep(0.2)
    behind.news()
print(time.perf_counter() - begun)
"""
STARTS = """
import time; begun = time.perf_counter()
import mjrock as mr
wall = mr.Block.from_size(0.6, 4.2)
e = mr.Restitution.from_geometry(wall)
contacts = mr.Contacts.from_law(wall, e, k_base=5e8, k_side=5e8)
case, found = mr.Case(wall, 0.5 * wall.alpha, 3.0), []
for solve in (lambda: mr.solve_analytical(case, e), lambda: mr.simulate(case, contacts),
              lambda: mr.simulate(mr.Case(wall, 0.5 * wall.alpha, 0.05), contacts, 1e-4)):
    for _ in range(8):
        once = time.perf_counter()
        solve()
    found.append(time.perf_counter() - once)
print(time.perf_counter() - begun, *found)
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
    setting = {name: value for name, value in setting.items() if name not in ENDING}
    setting |= {"PYTHONPATH": str(folder), "PYTHONWARNINGS": "ignore"} | environment
    command = [sys.executable, "-c", code]  # which looks for the package in its folder first
    done = subprocess.run(command, cwd=folder, env=setting, capture_output=True, text=True, check=True)
    return [float(line) for line in done.stdout.split()]


def emptied(folder: Path) -> None:
    """Forget all loops that are stored."""
    for stored in folder.rglob("*.nb[ic]"):
        stored.unlink()


def times(folder: Path, name: str, *, quick: bool) -> list[str]:
    """First answer, full speed, compiled first, stored, plain Python: of one problem [s]. A quick run compiles once."""
    code = SET_UP.format(RUNS[name])
    emptied(folder)
    first, full = seconds(folder, code + UNTIL_STORED)
    if not quick:
        emptied(folder)
    (compiled,) = seconds(folder, code, MJROCK_INTERPRET="0")
    (stored,) = seconds(folder, code)
    plain = f"{seconds(folder, code, NUMBA_DISABLE_JIT='1')[0]:.2f}" if name != EXPLICIT else ""
    return [f"{first:.2f}", "" if name == EXPLICIT else f"{full:.1f}", f"{compiled:.1f}", f"{stored:.2f}", plain]


def starts(folder: Path) -> list[list[str]]:
    """Three starts of a script with the package in a folder: the script [s], and the last of eight calls of theory, of
    steps in MuJoCo that fit the motion and of steps of one length [ms]."""
    rows, elsewhere = [], folder / "tmp"  # the package does not lie in a folder of temporary files
    elsewhere.mkdir()
    emptied(folder)
    for number in ("first", "second", "third"):
        took, *calls = seconds(folder, STARTS, TMPDIR=str(elsewhere))
        rows.append([number, f"{took:.2f}", *(f"{1e3 * call:.2f}" for call in calls)])
        with FileLock(folder / "mjrock/__pycache__/compiler.lock"):  # which the process that compiles holds to its end
            pass
    return rows


def package(revision: str | None, folder: Path) -> Path:
    """A folder with the package of a revision, or with that of this checkout, without loops."""
    if revision is None:
        shutil.copytree(ROOT / "mjrock", folder / "mjrock", ignore=shutil.ignore_patterns("__pycache__"))
        return folder
    archive = subprocess.run(["git", "-C", str(ROOT), "archive", revision, "mjrock"], capture_output=True, check=True)
    with tarfile.open(fileobj=io.BytesIO(archive.stdout)) as files:
        files.extractall(folder, filter="data")
    return folder


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
        folder = package(None, Path(made) / "now")
        for name in tqdm(names, desc="first runs", disable=None, leave=False):
            rows.append([name, *times(folder, name, quick=args.quick)])
        if args.clone:
            for revision in (args.against, "HEAD"):
                rows.append([f"make demo of {revision}", f"{demo(revision, folder / 'clone'):.0f}", "", "", "", ""])
        cli.report(out / "first_minute", cli.table(header, rows), header, rows)
        if args.quick:
            return
        header, rows = ["start", "script [s]", "theory [ms]", "fitted steps [ms]", "fixed steps [ms]"], []
        for name, revision in (("before", KILLED), ("now", None)):
            found = starts(package(revision, Path(made) / name / "starts"))
            rows += [[f"{number}, {name}", *more] for number, *more in found]
        cli.report(out / "starts", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
