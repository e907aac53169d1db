"""Calibrate the damping laws in the engine, for two corner lines and for a bed of 16.

Writes the laws (TOML), every search (CSV), the figures and a report. Searches run on all cores and are kept in
calibration.sqlite as they come: the same call carries on after a kill. With --quick one small law is fitted, of corner
lines.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mjrock import Restitution, Store, plotting
from mjrock.problem.damping.law import HIGHEST_XI, LEAST_XI, PowerLaw
from mjrock.study.campaign.campaign import completed
from mjrock.study.matching.calibration import (
    Calibration,
    Plan,
    Regression,
    calibrate,
    coefficients,
    presumed_damping,
    r_squared,
    regress,
)
from mjrock.study.matching.match import (
    AMPLITUDE_RANGE,
    K_N_RANGE,
    R_RANGE,
    REFERENCE,
    SLENDERNESS_RANGE,
    Combination,
    Match,
)
from scripts.shared import cli, law_pictures

LAYOUTS = {"CALIBRATED": 2, "CALIBRATED_BED": 16}
STIFFEST = 1e11
"""Stiffness up to which corner lines are calibrated [N/m3], for walls as rocking theory has them."""
QUICK = Plan(base_count=10, side_count=6, losses=(0.8, 1.0, 1.1), sides=(0.3, 0.4, 0.5))
STARTS = {"reference": REFERENCE, "soft and slender": Combination(slenderness=10.0, k_base=1e8, k_side=1e8)}
"""Where the one-at-a-time study starts: the reference values of Table 1, and a base that matters more."""
NAMES = {"R": "R", "slenderness": "h/b", "k_base": "k_n,b", "k_side": "k_n,s", "amplitude": "theta_0/alpha"}
SYMBOLS = {
    "R": "$R$",
    "slenderness": "$h/b$",
    "k_base": "$k_{n,b}$",
    "k_side": "$k_{n,s}$",
    "amplitude": r"$\theta_0/\alpha$",
}
"""Names of the parameters in tables and in figures."""


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
        drawings = [
            ("base: matches and law", curves(found, "base")),
            ("base", parity(found.base)),
            ("side: matches and law", curves(found, "side")),
            ("side", parity(found.side)),
        ]
        plotting.save(plotting.panels(drawings), out / f"{slug}_fit.png")
        for part, regression in (("base", found.base), ("side", found.side)):
            save_residuals(f"{name}, {part}", regression, out / f"{slug}_residuals_{part}.png")
        report += [name, "", summary(found), "", reach(found), ""]
        if not args.quick:
            text = sensitivities(found, store, args.workers, out / f"{slug}_sensitivity.png")
            report += [text, ""]
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


def curves(found: Calibration, part: str) -> plotting.Drawing:
    """Matched pairs of eight combinations, from a stiff base to a soft one, and the curve of the law."""
    tasks, rows = (found.base_tasks, found.base_rows) if part == "base" else (found.side_tasks, found.side_rows)
    form = found.law.base if part == "base" else found.law.side
    pairs: dict[object, list[tuple[Match, float]]] = {}
    for task, row in zip(tasks, rows, strict=True):
        if row["reached"]:
            pairs.setdefault(task.combination, []).append((task, row["xi"]))
    most = max(len(matches) for matches in pairs.values())
    full = sorted((m for m in pairs.values() if len(m) >= 0.7 * most), key=lambda m: float(m[0][0].groups.softness))
    families = []
    for i in np.unique(np.linspace(0, len(full) - 1, 8).astype(int)):
        matches = full[i]
        softness = float(matches[0][0].groups.softness)
        losses = np.array([task.loss for task, _ in matches])
        line = np.linspace(losses.min(), losses.max(), 60)
        xi = np.array([value for _, value in matches])
        families.append((softness, (np.exp(-losses), xi), (np.exp(-line), form.xi(matches[0][0].groups, line))))
    return lambda ax: law_pictures.damping_curves(ax, families)


def parity(fit: Regression) -> plotting.Drawing:
    """Predicted against matched."""
    return lambda ax: law_pictures.parity(ax, fit.xi, fit.predicted, fit.groups.softness)


def save_residuals(title: str, fit: Regression, picture: Path) -> None:
    """Residuals against every variable."""
    values = {name: np.array([getattr(one, name) for one in fit.combinations]) for name in NAMES}
    variables = {label: (values[name], "log") for name, label in SYMBOLS.items()}
    variables |= {"softness": (np.asarray(fit.groups.softness), "log"), "|e| asked for": (np.exp(-fit.loss), "linear")}
    plotting.save(law_pictures.residuals(title, fit.predicted / fit.xi, variables), picture)


def sweep(start: Combination) -> list[tuple[str, Combination]]:
    """Combinations that differ from `start` in one parameter, at five values through its range of Table 1."""
    swept: list[tuple[str, Combination]] = []
    ranges = {"R": R_RANGE, "slenderness": SLENDERNESS_RANGE, "k_base": K_N_RANGE, "k_side": K_N_RANGE}
    for name, (low, high) in (ranges | {"amplitude": AMPLITUDE_RANGE}).items():
        swept += [(name, replace(start, **{name: float(value)})) for value in np.geomspace(low, high, 5)]
    return swept


def sensitivities(found: Calibration, store: Path, workers: int | None, picture: Path) -> str:
    """One parameter at a time: how much the matched damping ratios depend on it, as a table and a figure."""
    points = found.law.points or 2
    rows: list[list[object]] = []
    panels: list[tuple[str, plotting.Drawing]] = []
    for start, middle in STARTS.items():
        swept = sweep(middle)
        for part in ("base", "side"):
            tasks = []
            for _, one in swept:
                e = Restitution.from_geometry(one.wall.alpha)
                presumed = None if part == "base" else presumed_damping(one, e, found.law.base)
                tasks.append(Match(one, e, points, presumed))
            matched = completed(tasks, store, workers=workers)
            lines = {}
            for key, name in NAMES.items():
                if (part, key) == ("base", "k_side"):
                    continue
                own = [(one, row) for (swept_key, one), row in zip(swept, matched, strict=True) if swept_key == key]
                xi = np.array([row["xi"] if row["reached"] else np.nan for _, row in own])
                known = xi[np.isfinite(xi)]
                spread = f"{known.max() / known.min():.3f}" if known.size > 1 else "-"
                rows.append([start, part, name, spread, f"{len(known)} of {len(xi)}"])
                if known.size:
                    lines[SYMBOLS[key]] = np.linspace(0, 1, len(xi)), xi / np.exp(np.mean(np.log(known)))
            panels.append((f"{part}, {start}", functools.partial(law_pictures.sensitivity, curves=lines)))
    plotting.save(plotting.panels(panels), picture)
    return cli.table(["around", "xi of", "parameter", "largest over smallest xi", "reached"], rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
