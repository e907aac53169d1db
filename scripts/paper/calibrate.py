"""Calibrate the damping laws in the engine, for two corner lines and for a bed of 16.

Writes the laws (TOML), every search (CSV), the figures and a report. Searches run on all cores and are kept in
calibration.sqlite as they come: the same call carries on after a kill. With --quick one small law is fitted, of corner
lines.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mjrock import Restitution, Store, plotting
from mjrock.problem.damping.law import HIGHEST_XI, LEAST_XI, PowerLaw
from mjrock.study.matching.calibration import (
    Calibration,
    Plan,
    Regression,
    calibrate,
    coefficients,
    r_squared,
    regress,
)
from mjrock.study.matching.match import (
    K_N_RANGE,
    Combination,
)
from scripts.shared import cli, law_pictures
from scripts.shared.law_pictures import SYMBOLS

LAYOUTS = {"CALIBRATED": 2, "CALIBRATED_BED": 16}
STIFFEST = 1e11
"""Stiffness up to which corner lines are calibrated [N/m3], for walls as rocking theory has them."""
QUICK = Plan(base_count=6, side_count=4, losses=(0.8, 1.0, 1.1), sides=(0.3, 0.4, 0.5))


def main(argv: Sequence[str] | None = None) -> None:
    """Calibrate, write and print."""
    parser = cli.parser(__doc__, "calibrate")
    parser.add_argument("--workers", type=int, default=None, help="processes; one for each processor by default")
    parser.add_argument("--laws", type=Path, default=None, help="folder for the laws, that of --out by default")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    laws = cli.folder(args.laws or out)
    store = out / "calibration.sqlite"
    report: list[str] = []
    for name, points in list(LAYOUTS.items())[: 1 if args.quick else 2]:
        plan = Plan(k_n=(K_N_RANGE[0], STIFFEST)) if points == 2 else Plan()
        found = calibrate(name, store, points=points, plan=QUICK if args.quick else plan, workers=args.workers)
        slug = name.lower()
        found.law.save(laws / f"{slug}.toml")
        for part, regression in (("base", found.base), ("side", found.side)):
            save_residuals(f"{name}, {part}", regression, out / f"{slug}_residuals_{part}.png")
        report += [name, "", summary(found), "", reach(found), ""]
    with Store(store) as file:
        cli.write_text(out / "calibration.csv", file.csv(timings=False))
    cli.write_text(out / "calibration.txt", "\n".join(report))
    print("\n".join(report))


def summary(found: Calibration) -> str:
    """The formulas with their coefficients and errors, how many were reached, and R2 beside the paper's form."""
    text = []
    for part, fit, tasks, rows in (
        ("base", found.base, found.base_tasks, found.base_rows),
        ("side", found.side, found.side_tasks, found.side_rows),
    ):
        names = coefficients(type(fit.form))
        values = ", ".join(f"{name} = {getattr(fit.form, name):.4g} +- {fit.errors[name]:.2g}" for name in names)
        power = regress(PowerLaw, tasks, rows)
        reached = [(task, row["xi"]) for task, row in zip(tasks, rows, strict=True) if row["reached"]]
        xi = np.array([value for _, value in reached])
        predicted = [float(fit.form.xi(task.groups, task.loss)) for task, _ in reached]
        whole = r_squared(np.clip(predicted, LEAST_XI, HIGHEST_XI) if part == "base" else np.array(predicted), xi)
        text += [
            f"{part}: {type(fit.form).__name__}({values})",
            f"  {len(rows)} searches of {sum(row['runs'] for row in rows)} simulations, {len(xi)} reached, "
            f"{len(fit.xi)} fitted",
            f"  R2 of xi {fit.form.r_squared:.4f}, of ln xi {fit.logarithmic:.4f}; by fits that have not seen the "
            f"combination {fit.held_out:.4f}; median |error| of xi {np.median(np.abs(fit.predicted / fit.xi - 1)):.1%}",
            f"  R2 of xi over all that were reached {whole:.4f}",
            f"  the paper's power law on the same pairs: R2 of xi {power.form.r_squared:.4f}, of ln xi "
            f"{power.logarithmic:.4f}",
        ]
    return "\n".join(text)


def reach(found: Calibration) -> str:
    """The restitution of the base that the law can give, beside Eq. 2's."""
    rows: list[list[object]] = []
    for slenderness in (4.0, 7.0, 10.0, 15.0):
        for k in (5e7, 5e8, 3e9):
            wall = Combination(slenderness=slenderness).wall
            low, high = found.law.reach(wall, k)
            theory = Restitution.from_geometry(wall.alpha).base
            rows.append([f"{slenderness:g}", f"{k:.0e}", f"{theory:.4f}", f"{low:.4f}", f"{high:.4f}"])
    return cli.table(["h/b", "k_n [N/m3]", "e_2s of Eq. 2", "lowest e_2s", "highest e_2s"], rows)


def save_residuals(title: str, fit: Regression, picture: Path) -> None:
    """Residuals against every variable."""
    values = {name: np.array([getattr(one, name) for one in fit.combinations]) for name in SYMBOLS}
    variables = {label: (values[name], "log") for name, label in SYMBOLS.items()}
    variables |= {"softness": (np.asarray(fit.groups.softness), "log"), "|e| asked for": (np.exp(-fit.loss), "linear")}
    plotting.save(law_pictures.residuals(title, fit.predicted / fit.xi, variables), picture)


if __name__ == "__main__":
    sys.exit(cli.run(main))
