"""The reference wall in the codes that a user would pick instead: error of |e| against wall time, each at its best.

Stock MuJoCo, PyBullet, OpenSeesPy and Siconos run in processes of their own. One that is not installed is skipped,
unless the folder has its numbers already: these are not written over.
Errors are the worst of the first rebounds (four two-sided, two one-sided) over three releases. They are measured
against the contact law with the same springs and dashpots, solved by SciPy, and against rocking theory. Times are the
least of several runs, over the simulated time. Writes peers.csv, peers.png and peers.txt, and prints the table.
"""

from __future__ import annotations

import importlib.metadata
import importlib.util
import math
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.problem.damping.contacts import Uplift
from mjrock.quantities import Array
from mjrock.result.rocking import RotationHistory, peak_energies, restitution_of, rocking_history
from scripts.peers.codes.question import Question
from scripts.peers.codes.worker import Task
from scripts.shared import accuracy, cli
from scripts.shared.paper import FIGURE_3, K_N

ROOT = Path(__file__).parents[2]
LIMIT = 180.0
"""Seconds after which a peer is stopped at one step."""
SETTLED = 0.01
"""Seconds after the release that no peak is looked for: peers start a little off their equilibrium."""
CLOSE = 0.01
"""Error of |e| at which times are compared."""


@dataclass(frozen=True)
class Setup:
    """One way of using one code.

    Args:
        label: how it is called in picture and table.
        given: what it is told about the impacts.
        code: module in `codes`, or empty for mjrock.
        variant: which of its setups.
        steps: from the longest [s], or accuracies of mjrock.
        law: whether it has the springs and dashpots of the reference.
    """

    label: str
    given: str
    code: str
    variant: str
    steps: tuple[float, ...]
    law: bool


MUJOCO, BULLET, OPENSEES, SICONOS = "stock_mujoco", "bullet", "opensees", "siconos_contacts"
NEEDS = {MUJOCO: "mujoco", BULLET: "pybullet", OPENSEES: "openseespylinux" if sys.platform == "linux" else "openseespy"}
NEEDS |= {SICONOS: "siconos"}
DEBIAN = {SICONOS: "python3-siconos"}
"""Peers that no package index has, and the packages of Debian that hold them."""
PYTHON = "/usr/bin/python3"
"""Runs the peers of Debian; the gaps of Siconos are compiled by `cc`."""
SHORT = (2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5)
TICKS = (1 / 240, 1 / 1000, 1 / 2000, 1 / 5000, 1 / 10_000)
SETUPS = (
    Setup("mjrock", "k, c", "", "", (1e-2, 3e-3, 1e-3, 1e-4, 1e-5), True),
    Setup("mjrock, as_theory", "e", "", "as_theory", (1e-2, 3e-3, 1e-3, 1e-4, 1e-5), False),
    Setup("MuJoCo, default", "nothing", MUJOCO, "default, pyramidal", SHORT[:5], False),
    Setup("MuJoCo, default, elliptic", "nothing", MUJOCO, "default, elliptic", SHORT[:5], False),
    Setup("MuJoCo, direct solref", "k/m, c/m", MUJOCO, "direct", SHORT, True),
    Setup("MuJoCo, direct, d = 1e-4, pairs", "k/m, c/m", MUJOCO, "direct, small d, pairs", SHORT, True),
    Setup("PyBullet, default", "nothing", BULLET, "defaults", TICKS, False),
    Setup("PyBullet, restitution typed in", "|e| at the stop", BULLET, "restitution", TICKS, False),
    Setup("PyBullet, contactStiffness", "k, c", BULLET, "stiffness and damping", (*TICKS, 2e-5), True),
    Setup("OpenSees, parallel dashpot", "k, c", OPENSEES, "parallel", SHORT[:5], True),
    Setup("OpenSees, ViscoelasticGap", "k, c", OPENSEES, "ViscoelasticGap", SHORT[:6], True),
    Setup("OpenSees, dashpot under a gap", "k, c", OPENSEES, "dashpot under a gap", SHORT[:6], True),
    Setup("Siconos, restitution typed in", "|e| at the stop", SICONOS, "restitution", (5e-3, *SHORT), False),
)

LABELS = {
    "mjrock": "mjrock",
    "mjrock, as_theory": "mjrock, contacts as of theory",
    "MuJoCo, direct, d = 1e-4, pairs": "stock MuJoCo, stiffness and damping by hand",
    "PyBullet, contactStiffness": "PyBullet, stiffness and damping",
    "OpenSees, ViscoelasticGap": "OpenSees, viscoelastic gap",
    "Siconos, restitution typed in": "Siconos, restitution typed in",
}
"""The best way of each code, and its name in the figure."""


@dataclass(frozen=True)
class Point:
    """What one step of one setup costs, and how wrong it is; NaN where it was not given the law, or did not run."""

    case: str
    setup: Setup
    step: float
    seconds: float
    law: float
    theory: float
    first: tuple[float, ...]
    note: str = ""


class Problem:
    """One case at several releases: what is asked of everyone, and what is right."""

    def __init__(self, label: str, *, side_stop: bool, quick: bool) -> None:
        self.label, self.rebounds = label, 2 if side_stop else 4
        wall = FIGURE_3
        self.e = mr.Restitution.from_geometry(wall.alpha)
        self.contacts = mr.Contacts.from_law(wall, self.e, k_base=K_N, k_side=K_N)
        shares = (0.5,) if quick else (0.5, 0.47, 0.53)
        duration = 2.0 if side_stop else 6.0
        self.cases = [mr.Case(wall, share * wall.alpha, duration, side_stop=side_stop) for share in shares]
        self.theory = abs(self.e.lumped) if side_stop else self.e.base
        self.exact = [mr.solve_compliant(case, self.contacts, rtol=1e-9).restitution for case in self.cases]

    def questions(self) -> tuple[Question, ...]:
        """The cases as numbers."""
        base, side = self.contacts.base, self.contacts.side
        assert side is not None
        wall = FIGURE_3
        return tuple(
            Question(
                thickness=2 * wall.b,
                height=2 * wall.h,
                length=wall.length,
                mass=wall.mass,
                theta0=case.theta0,
                duration=case.duration,
                side_stop=case.one_sided,
                k_base=float(base.stiffness[0]),
                c_base=float(base.damping[0]),
                k_side=float(side.stiffness[0]),
                c_side=float(side.damping[0]),
                e=abs(self.e.lumped),
            )
            for case in self.cases
        )

    def point(self, setup: Setup, step: float, seconds: float, found: Sequence[Array]) -> Point:
        """The errors of |e| per rebound, one list a release; a rebound that is missing is an error of 1."""
        n = self.rebounds
        padded = [np.append(one, np.zeros(n))[:n] for one in found]
        law = max(float(np.abs(one / exact[:n] - 1).max()) for one, exact in zip(padded, self.exact, strict=True))
        theory = max(float(np.abs(one / self.theory - 1).max()) for one in padded)
        first = tuple(float(v) for v in padded[0])
        per_second = seconds / self.cases[0].duration
        return Point(self.label, setup, step, per_second, law if setup.law else math.nan, theory, first)

    def restitution(self, case: mr.Case, motion: Array) -> Array:
        """|e| per rebound of a peer's motion, by the rule of `Response.restitution`.

        Springs make a wall tremble, so that one rotation peak is several maxima. The highest one between two passes of
        the uplift rotation counts.
        """
        t, theta, omega = motion[:, motion[0] >= SETTLED]
        if not np.isfinite(theta).all() or np.abs(theta).max() > math.pi / 2:
            return np.zeros(0)
        uplift = self.contacts.uplift_rotation(FIGURE_3)
        times, sizes, _ = rocking_history(case, RotationHistory(t, theta, omega, 0 * t), Uplift(uplift, 0.0))
        kept: list[tuple[float, float]] = []
        for time, size in zip(times, sizes, strict=True):
            between = np.abs(theta[(t >= kept[-1][0]) & (t <= time)]) if kept else np.zeros(1)
            if between.min(initial=math.inf) < uplift:
                kept.append((time, size))
            else:
                kept[-1] = time, max(size, kept[-1][1])
        return restitution_of(*peak_energies(case, np.array([size for _, size in kept])))


def ours(problem: Problem, setup: Setup, accuracy: float) -> Point:
    """`simulate`, on the contacts of the reference or on stiff ones that rebound as theory does."""
    contacts = mr.as_theory(FIGURE_3, problem.e) if setup.variant else problem.contacts
    runs = [mr.simulate(case, contacts, accuracy=accuracy) for case in problem.cases]
    seconds = min(mr.simulate(problem.cases[0], contacts, accuracy=accuracy).stats["wall_time"] for _ in range(20))
    return problem.point(setup, accuracy, seconds, [run.restitution for run in runs])


def theirs(problem: Problem, setup: Setup, h: float) -> Point:
    """A peer at one step, in its own process."""
    nothing = Point(problem.label, setup, h, math.nan, math.nan, math.nan, ())
    with tempfile.TemporaryDirectory() as folder:
        task = Task(setup.code, setup.variant, h, problem.questions(), str(Path(folder) / "answers.npz"))
        command, text = (
            [PYTHON if setup.code in DEBIAN else sys.executable, "-m", "scripts.peers.codes.worker"],
            task.text,
        )
        try:
            subprocess.run(
                command, input=text, text=True, capture_output=True, check=True, timeout=LIMIT, env=env(setup.code)
            )
        except subprocess.TimeoutExpired:
            return replace(nothing, note=f"stopped after {LIMIT:g} s")
        except subprocess.CalledProcessError as error:
            errors = [line for line in error.stderr.splitlines() if "Error: " in line]
            return replace(nothing, note=(errors or ["failed"])[-1].split("Error: ")[-1])
        with np.load(task.file) as answers:
            pairs = enumerate(problem.cases)
            found = [problem.restitution(case, answers[f"motion_{i}"]) for i, case in pairs]
            return problem.point(setup, h, float(answers["seconds"]), found)


def env(code: str) -> dict[str, str]:
    """The environment of a peer; that of OpenSees has the libraries that its wheel brings along and does not find."""
    made = dict(os.environ)
    if code in DEBIAN:
        return made | {"PYTHONPATH": str(ROOT)}
    paths, libraries = [str(ROOT), *filter(None, sys.path)], made.get("LD_LIBRARY_PATH", "")
    found = importlib.util.find_spec(NEEDS[code])
    for place in (found.submodule_search_locations or []) if found and code == OPENSEES else []:
        paths.append(place)
        libraries = f"{place}/lib:{libraries}"
    return made | {"PYTHONPATH": os.pathsep.join(paths), "LD_LIBRARY_PATH": libraries}


def missing() -> dict[str, str]:
    """The peers that are not installed, with the line that says so."""
    missing_codes = {}
    for code, name in NEEDS.items():
        if not (found_by_debian(name) if code in DEBIAN else importlib.util.find_spec(name) is not None):
            how = f"apt-get install {DEBIAN[code]} gcc" if code in DEBIAN else "pip install pybullet openseespy"
            missing_codes[code] = f"{name} is not installed, it needs {how}"
    return missing_codes


def keep_peers(table: Path, absent: dict[str, str]) -> None:
    """Refuse to write over a table that has peers which are not installed.

    Raises:
        RuntimeError: with what each of them needs.
    """
    stored = table.read_text(encoding="utf-8").splitlines() if table.is_file() else []
    labels = {line.split(",")[1] for line in stored}
    lost = {one.code: absent[one.code] for one in SETUPS if one.code in absent and plain(one.label) in labels}
    if lost:
        raise RuntimeError(f"{table} has numbers that would be lost; take another --out:\n" + "\n".join(lost.values()))


def plain(cell: object) -> str:
    """A cell without commas, as NumPy reads no quoted ones."""
    return str(cell).replace(",", " and")


def found_by_debian(name: str) -> bool:
    """Whether Python as Debian installs it finds a module, and there is a compiler."""
    if shutil.which(PYTHON) is None or shutil.which("cc") is None:
        return False
    look = f"import importlib.util, sys; sys.exit(importlib.util.find_spec({name!r}) is None)"
    return subprocess.run([PYTHON, "-c", look], check=False).returncode == 0


def points(problems: Sequence[Problem], absent: dict[str, str], quick: bool) -> Iterator[Point]:
    """Every setup at every step."""
    setups = [setup for setup in SETUPS if setup.code not in absent]
    steps = {setup: setup.steps[: (1 if setup.code else 2) if quick else None] for setup in setups}
    todo = [(p, s, h) for p in problems for s in setups for h in steps[s]]
    for problem, setup, step in tqdm(todo, desc="peers", disable=None, leave=False):
        yield (theirs if setup.code else ours)(problem, setup, step)


def quickest(found: Sequence[Point], measure: str) -> Point | None:
    """The quickest setting whose error, and that of every finer one, is below CLOSE, so that none is met by luck."""
    fine: list[Point] = []
    for point in sorted(found, key=lambda p: p.step):
        if not getattr(point, measure) <= CLOSE:
            break
        fine.append(point)
    return min(fine, key=lambda p: p.seconds, default=None)


def summary(case: str, found: Sequence[Point]) -> str:
    """A line a setup: its longest and its best step, what it reaches, and its times as multiples of mjrock's."""
    header = ["given", "setup", "against", "error, longest step", "best step [ms]", "|e| there", "error of law"]
    header += ["error of theory", "time / mjrock", f"time at {CLOSE:.0%} / mjrock"]
    of_case = [p for p in found if p.case == case]
    usual = min((p for p in of_case if p.setup is SETUPS[0]), key=lambda p: abs(math.log(p.step / 1e-3)))
    rows: list[list[object]] = []
    for setup in dict.fromkeys(p.setup for p in of_case):
        measure = "law" if setup.law else "theory"
        own = [p for p in of_case if p.setup is setup]
        ran = [p for p in own if math.isfinite(p.theory)]
        if not ran:
            rows.append([setup.given, setup.label, measure, own[0].note, *[""] * 6])
            continue
        best = min(ran, key=lambda p: (getattr(p, measure), p.seconds))
        reference = SETUPS[0] if setup.law else SETUPS[1]
        mine, its = (quickest([p for p in of_case if p.setup is one], measure) for one in (setup, reference))
        rows.append(
            [
                *(setup.given, setup.label, measure),
                f"{getattr(own[0], measure):.1e}" if own[0] in ran else own[0].note,
                f"{best.step * 1e3:.3g}" if setup.code else f"accuracy {best.step:g}",
                ", ".join(f"{e:.4f}" if e else "none" for e in best.first[:2]),
                f"{best.law:.1e}" if setup.law else "not given it",
                f"{best.theory:.1e}",
                f"{best.seconds / usual.seconds:.3g}",
                f"{mine.seconds / its.seconds:.3g}" if mine and its else "not reached",
            ]
        )
    return f"{case}\n" + cli.table(header, rows)


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "peers").parse_args(argv)
    out = cli.folder(args.out)
    absent = missing()
    keep_peers(out / "peers.csv", absent)
    sides = (("one-sided", True), ("two-sided", False))
    problems = [Problem(label, side_stop=side_stop, quick=args.quick) for label, side_stop in sides]
    found = list(points(problems, absent, args.quick))
    header = ["case", "setup", "given", "step [s] or accuracy [-]", "wall time / simulated time [-]"]
    header += ["error against the law [-]", "error against theory [-]", "|e| of the first two rebounds", "note"]
    rows = [
        [
            *(p.case, p.setup.label, p.setup.given, f"{p.step:.4g}"),
            *(f"{value:.3g}" for value in (p.seconds, p.law, p.theory)),
            *(" ".join(f"{e:.4f}" for e in p.first[:2]), p.note),
        ]
        for p in found
    ]
    drawn = [(p.case, p.setup.label, p.seconds, p.law, p.theory) for p in found if math.isfinite(p.theory)]
    plotting.save(accuracy.peers(drawn, LABELS), out / "peers.png")
    lines = [summary(problem.label, found) for problem in problems]
    lines.append(
        "\n".join([f"mjrock {mr.__version__}, accuracy 1e-3 is its default", *versions(absent), *absent.values()])
    )
    cli.report(out / "peers", "\n\n".join(lines), header, [[plain(cell) for cell in row] for row in rows])


def versions(absent: dict[str, str]) -> list[str]:
    """The versions of the peers that ran."""
    return [f"{name} {version(code)}" for code, name in NEEDS.items() if code not in absent]


def version(code: str) -> str:
    """The version of a peer."""
    if code not in DEBIAN:
        return importlib.metadata.version(NEEDS[code])
    query = ["dpkg-query", "-W", "-f", "${Version}", DEBIAN[code]]
    return subprocess.run(query, capture_output=True, text=True, check=True).stdout


if __name__ == "__main__":
    sys.exit(cli.run(main))
