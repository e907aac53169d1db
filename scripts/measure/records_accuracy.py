"""Accuracy under records: errors of the peak rotation of shaken walls, and how far rocking multiplies an error.

Walls one-sided and two-sided, on three bases, each under a synthetic record: those that rock by explicit steps and
stand by the reference, `simulate(accuracy=1e-5)`, in the order of their seeds. Explicit steps and SciPy on the same
contacts stand beside it. Times are those of the processor, in one process, for one run. Rocking theory says how much a
peak changes with the restitution of every impact. Writes records_accuracy.csv and records_accuracy.png, and prints the
tables.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import accuracy, cli

BASES = (5e8, 5e9, 1.5e10)
"""Interface stiffness [N/m3]."""
SIDES = {"one-sided": True, "two-sided": False}
REFERENCE = 1e-5
ROCKS = 3.0
"""Peak over uplift rotation from which a wall rocks [-]."""
SCATTER = (1e-4, 0.014, 0.046)
"""Changes of the restitution of every impact [-]. Measured restitution of single limestone blocks has a standard
deviation of 0.014 to 0.046 from trial to trial (Colombo et al., doi 10.60756/uminho-jh25, 134 first impacts)."""


class Run(NamedTuple):
    """A wall under its record, and what the reference finds."""

    case: mr.Case
    contacts: mr.Contacts
    peak: float
    outcome: mr.Outcome


class Row(NamedTuple):
    """Errors of the peaks of some runs by one method, and what one run takes."""

    sides: str
    k_n: float
    method: str
    setting: str
    errors: Array
    other_outcomes: int
    steps: float
    seconds: float


Solve = Callable[[mr.Case, mr.Contacts], mr.Response]


def peak_of(response: mr.Response) -> float:
    """Largest rotation over alpha, 1 or more for a wall that overturns."""
    return float(np.abs(response.theta).max() / response.of_wall[0].block.alpha)


def drawn(k_n: float, side_stop: bool, seed: int, duration: float) -> tuple[mr.Case, mr.Contacts]:
    """A wall under a synthetic record of 2 to 5 times the acceleration that starts rocking."""
    rng = np.random.default_rng(seed)
    wall = mr.Block.from_slenderness(rng.uniform(5, 14), rng.uniform(1, 5))
    e = mr.Restitution.from_geometry(wall)
    contacts = mr.Contacts.from_law(wall, e, k_base=k_n, k_side=k_n if side_stop else None)
    peak = rng.uniform(2, 5) * 9.81 * math.tan(wall.alpha)
    record = mr.GroundMotion.synthetic(peak=peak, duration=duration, seed=seed)
    return mr.Case(wall, 0.0, duration, side_stop=side_stop, motion=record), contacts


def references(k_n: float, side_stop: bool, count: int, duration: float) -> list[Run]:
    """The first walls that rock and stand."""
    found: list[Run] = []
    seed = 0
    with tqdm(total=count, desc=f"reference, {k_n:g} N/m3", disable=None, leave=False) as bar:
        while len(found) < count:
            case, contacts = drawn(k_n, side_stop, seed, duration)
            seed += 1
            rough = peak_of(mr.solve_explicit(case, contacts))
            if ROCKS * contacts.uplift_rotation(case.block) / case.block.alpha < rough < 1:
                fine = mr.simulate(case, contacts, accuracy=REFERENCE)
                if fine.outcome is not mr.Outcome.OVERTURNED:
                    found.append(Run(case, contacts, peak_of(fine), fine.outcome))
                    bar.update()
    return found


def methods(quick: bool) -> dict[tuple[str, str], tuple[Solve, int]]:
    """Every method with its setting, and for how many of the walls it is run."""

    def fitted(accuracy: float) -> Solve:
        return lambda case, contacts: mr.simulate(case, contacts, accuracy=accuracy)

    def scipy(rtol: float) -> Solve:
        return lambda case, contacts: mr.solve_compliant(case, contacts, rtol=rtol, atol=1e-2 * rtol)

    accuracies = (1e-3, 1e-4) if quick else (1e-3, 3e-4, 1e-4, 3e-5)
    made: dict[tuple[str, str], tuple[Solve, int]] = {
        ("MuJoCo, fitted steps", f"accuracy {a:g}"): (fitted(a), sys.maxsize) for a in accuracies
    }
    made["explicit steps", "default"] = mr.solve_explicit, sys.maxsize
    if not quick:
        made["SciPy", "rtol 1e-06"] = scipy(1e-6), 2
    return made


def measured(sides: str, k_n: float, name: tuple[str, str], solve: Solve, runs: Sequence[Run]) -> Row:
    """Errors of the peaks, mean steps and mean processor time."""
    errors, others, steps, seconds = [], 0, 0, 0.0
    for run in tqdm(runs, desc=", ".join(name), disable=None, leave=False):
        started = time.process_time()
        found = solve(run.case, run.contacts)
        seconds += time.process_time() - started
        steps += found.stats.get("steps", found.stats.get("evaluations", 0))
        overturns = found.outcome is mr.Outcome.OVERTURNED
        others += overturns
        errors.append(math.inf if overturns else abs(peak_of(found) / run.peak - 1))
    return Row(sides, k_n, *name, np.array(errors), others, steps / len(runs), seconds / len(runs))


def changed(case: mr.Case, e: mr.Restitution, by: float) -> mr.Restitution:
    """The restitution of every rebound changed: of the base two-sided, of base and side together one-sided."""
    if case.side_stop:
        return mr.Restitution(e.base, min(max(e.side + by / e.base**2, -1.0), -1e-3))
    return mr.Restitution(min(max(e.base + by, 1e-3), 1.0), e.side)


def amplified(runs: Sequence[Run], by: float) -> Array:
    """By how much the peaks of rocking theory change with the restitution, for both signs of the change [-].

    Runs that overturn before or after the change are infinite, but for those that do in both.
    """
    changes = []
    for run in runs:
        e = mr.Restitution.from_geometry(run.case.block)
        before = peak_of(mr.solve_analytical(run.case, e))
        for sign in (-1, 1):
            after = peak_of(mr.solve_analytical(run.case, changed(run.case, e, sign * by)))
            if before < 1 or after < 1:
                changes.append(abs(after / before - 1) if max(before, after) < 1 else math.inf)
    return np.array(changes)


def quantile(values: Array, share: float) -> float:
    """The value that a share of all stays below, one of them and no mean of two."""
    return float(np.quantile(values, share, method="higher"))


def table_of(rows: Sequence[Row]) -> tuple[list[str], list[list[object]]]:
    """The table of errors in %."""
    header = ["walls", "k_n [N/m3]", "method", "setting", "runs", "median [%]", "nine of ten [%]", "worst [%]"]
    header += ["other outcomes", "steps", "time [ms]", "time / accuracy 1e-3"]
    base = {(row.sides, row.k_n): row.seconds for row in rows if row.setting == "accuracy 0.001"}
    lines: list[list[object]] = []
    for row in rows:
        values = [100 * quantile(row.errors, share) for share in (0.5, 0.9, 1.0)]
        numbers = [f"{value:.2f}" for value in values]
        lines.append([row.sides, f"{row.k_n:g}", row.method, row.setting, len(row.errors), *numbers])
        lines[-1] += [row.other_outcomes, round(row.steps), f"{row.seconds * 1e3:.0f}"]
        lines[-1].append(f"{row.seconds / base[row.sides, row.k_n]:.2f}")
    return header, lines


def pooled(rows: Sequence[Row]) -> list[Row]:
    """A row for each method with the runs of all bases together, and the means of their steps and times."""
    made = []
    for sides, method, setting in dict.fromkeys((row.sides, row.method, row.setting) for row in rows):
        here = [row for row in rows if (row.sides, row.method, row.setting) == (sides, method, setting)]
        errors, others = np.concatenate([row.errors for row in here]), sum(row.other_outcomes for row in here)
        steps, seconds = (float(np.mean(values)) for values in ([r.steps for r in here], [r.seconds for r in here]))
        made.append(Row(sides, math.nan, method, setting, errors, others, steps, seconds))
    return made


def drawn_points(rows: Sequence[Row]) -> list[tuple[str, str, float, float]]:
    """Points of the picture: all bases together."""
    errors = [quantile(row.errors, 0.9) for row in rows]
    return [
        (row.sides, row.method, row.seconds, error)
        for row, error in zip(rows, errors, strict=True)
        if 0 < error < math.inf
    ]


def picture(points: Sequence[tuple[str, str, float, float]]) -> Figure:
    """Errors of the peaks against time, by solver."""
    looks = {"MuJoCo, fitted steps": plotting.STYLES["MuJoCo"], "explicit steps": plotting.STYLES["explicit"]}
    looks["SciPy"] = plotting.STYLES["compliant"]
    return accuracy.work_precision(points, looks, "peak error of nine of ten runs [-]", "processor time of a run [s]")


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "records_accuracy").parse_args(argv)
    out = cli.folder(args.out)
    warnings.simplefilter("ignore", UserWarning)  # some walls lie outside the range of the law
    count, duration, bases = (2, 3.0, BASES[:1]) if args.quick else (16, 10.0, BASES)
    rows: list[Row] = []
    lines: list[list[object]] = []
    for sides, side_stop in SIDES.items():
        of_sides: list[Run] = []
        for k_n in bases:
            runs = references(k_n, side_stop, count, duration)
            for name, (solve, most) in methods(args.quick).items():
                rows.append(measured(sides, k_n, name, solve, runs[:most]))
            of_sides += runs
        for by in SCATTER:
            changes = amplified(of_sides, by)
            values = [quantile(changes, share) for share in (0.5, 0.9)]
            numbers = [f"{100 * value:.2g}" for value in values] + [f"{value / by:.2g}" for value in values]
            lines.append([sides, by, *numbers, f"{100 * np.mean(np.isinf(changes)):.0f}"])
    header, table = table_of(rows)
    together = pooled(rows)
    plotting.save(picture(drawn_points(together)), out / "records_accuracy.png")
    of_all = [
        [row.sides, row.method, row.setting, f"{100 * quantile(row.errors, 0.9):.2f}", f"{row.seconds * 1e3:.0f}"]
        for row in together
    ]
    changes_of = ["theory", "change of e", "median [%]", "nine of ten [%]", "median / change", "nine of ten / change"]
    all_bases = ["walls, all bases", "method", "setting", "nine of ten [%]", "time [ms]"]
    tables = [cli.table(header, table), cli.table(all_bases, of_all)]
    text = "\n\n".join([*tables, cli.table([*changes_of, "overturn in one [%]"], lines)])
    cli.report(out / "records_accuracy", text, header, table)


if __name__ == "__main__":
    sys.exit(cli.run(main))
