"""The everyday tests of the physics under the kernels of other processors: `make test-processors`.

    python tests/processors.py
    python tests/processors.py --others

NumPy and SciPy take their linear algebra from OpenBLAS, which has kernels for each kind of processor. They order and
fuse sums in other ways. Here every kernel runs the tests that this machine can carry out, and numba compiles once for
any processor, into a store of its own. `--others` is for continuous integration, after the tests have run: kernels
other than the one in use, and the tests of what has differed. The exit code is 1 if a test fails.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from mjrock.machine import kernels

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "out" / "processors"
KERNELS = ("Haswell", "Nehalem", "SkylakeX")
"""Kernels that differ most from each other: Zen's are like the first, those without fused sums like the second."""
WITHOUT_PHYSICS = ("house", "plotting")
DIFFERED = (
    "digests",
    "validation",
    "invariance",
    "scene",
    "distinct/test_rest_in_space.py",
    "distinct/test_starts_at_rest.py",
    "problem/test_collapse.py",
    "problem/test_collapse_without_dilatancy.py",
)
"""Tests that depend on last digits: digests of all solvers, those of rest and of limit analysis, which call linear
algebra, and of motions that multiply rounding. The loops of explicit steps sum alike everywhere."""
PROBE = "import numpy, mjrock.machine as m; numpy.ones((9, 9)) @ numpy.ones((9, 9)); print(*m.kernels().values())"


def carries_out(kernel: str) -> bool:
    """Whether OpenBLAS takes a kernel here when it is named, and the processor carries it out."""
    command, setting = [sys.executable, "-c", PROBE], os.environ | {"OPENBLAS_CORETYPE": kernel}
    done = subprocess.run(command, cwd=ROOT, env=setting, capture_output=True, text=True, check=False)
    return done.returncode == 0 and kernel in done.stdout.split()


def tested(name: str, setting: dict[str, str], folders: list[Path]) -> tuple[int, int, float]:
    """How many tests passed and failed under a setting, and how long they took [s]."""
    results = OUT / f"{name}.xml"
    results.unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "-n", "auto", f"--junitxml={results}", *map(str, folders)]
    subprocess.run(command, cwd=ROOT, env=os.environ | setting, check=False)
    (suite,) = ElementTree.parse(results).getroot()
    failed = int(suite.get("failures", 0)) + int(suite.get("errors", 0))
    return int(suite.get("tests", 0)) - failed - int(suite.get("skipped", 0)), failed, float(suite.get("time", 0))


def main() -> int:
    """Run the tests under each setting, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "--others", action="store_true", help="only kernels that are not in use, and tests of what differed"
    )
    others = parser.parse_args().others
    folders = [path for path in sorted((ROOT / "tests").iterdir()) if any(path.glob("test_*.py"))]
    folders = [path for path in folders if path.name not in WITHOUT_PHYSICS]
    folders = [ROOT / "tests" / name for name in DIFFERED] if others else folders
    named = [kernel for kernel in KERNELS if not (others and kernel in kernels().values())]
    settings = {kernel: {"OPENBLAS_CORETYPE": kernel} for kernel in named if carries_out(kernel)}
    if not others:
        settings["any processor"] = {"NUMBA_CPU_NAME": "generic", "NUMBA_CACHE_DIR": str(OUT / "generic")}
    OUT.mkdir(parents=True, exist_ok=True)
    rows = {name: tested(name, setting, folders) for name, setting in settings.items()}
    for kernel in named:
        if kernel not in settings:
            print(f"{kernel:>14}  this machine does not carry it out")
    for name, (passed, failed, seconds) in rows.items():
        print(f"{name:>14}  {passed:5} passed  {failed:3} failed  {seconds:6.0f} s")
    return int(any(failed for _, failed, _ in rows.values()))


if __name__ == "__main__":
    sys.exit(main())
