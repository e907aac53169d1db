"""Damping laws beside matches in the engine, and which parameters matter: the figures of docs/damping.md.

A tenth of the walls of `calibrate.py` is matched again, and the laws of the package are compared with what is found.
Writes damping_corners.png, damping_bed.png, damping_sensitivity.png and damping_figures.txt. Matches are kept in
damping_figures.sqlite.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import mjrock as mr
from mjrock import plotting
from mjrock.problem.damping.law import Form
from mjrock.study.campaign.campaign import completed
from mjrock.study.campaign.task import Row
from mjrock.study.matching.calibration import Plan, presumed_damping, well_matched
from mjrock.study.matching.match import (
    AMPLITUDE_RANGE,
    K_N_RANGE,
    R_RANGE,
    REFERENCE,
    SLENDERNESS_RANGE,
    Combination,
    Match,
)
from scripts.paper.calibrate import STIFFEST
from scripts.shared import cli, law_pictures
from scripts.shared.law_pictures import SYMBOLS

WALLS = 16, 24
"""Walls whose base, and whose side, is matched; a tenth of those of `calibrate.py`."""
LAWS = {"damping_corners": (mr.CALIBRATED, 2, STIFFEST), "damping_bed": (mr.CALIBRATED_BED, 16, K_N_RANGE[1])}
"""The laws by their figures, with the contact lines of a face and the largest stiffness that they cover [N/m3]."""
STARTS = {"reference wall": REFERENCE, "slender, soft base": Combination(slenderness=10.0, k_base=1e8, k_side=1e8)}
"""Where the one-at-a-time study starts: the reference values of Table 1, and a base that matters more."""


def drawn_law(form: Form, tasks: Sequence[Match], rows: Sequence[Row]) -> tuple[plotting.Drawing, plotting.Drawing]:
    """Matched pairs of eight walls with the curve of the law, from a stiff base to a soft one; and all that the law
    is fitted to, predicted against matched."""
    fitted = [(task, float(row["xi"])) for task, row in zip(tasks, rows, strict=True) if well_matched(row)]
    walls = dict[object, list[tuple[Match, float]]]()
    for task, row in zip(tasks, rows, strict=True):
        if row["reached"]:
            walls.setdefault(task.combination, []).append((task, float(row["xi"])))
    most = max(map(len, walls.values()))
    full = sorted((one for one in walls.values() if len(one) >= 0.7 * most), key=lambda one: one[0][0].groups.softness)
    families = []
    for i in np.unique(np.linspace(0, len(full) - 1, 8).astype(int)):
        groups, losses = full[i][0][0].groups, np.array([task.loss for task, _ in full[i]])
        line = np.linspace(losses.min(), losses.max(), 60)
        matches = np.exp(-losses), np.array([xi for _, xi in full[i]])
        families.append((float(groups.softness), matches, (np.exp(-line), form.xi(groups, line))))
    predicted = [float(form.xi(task.groups, task.loss)) for task, _ in fitted]
    softness = [float(task.groups.softness) for task, _ in fitted]
    matched = [xi for _, xi in fitted]
    return (
        functools.partial(law_pictures.damping_curves, families=families),
        functools.partial(law_pictures.parity, matched=matched, predicted=predicted, color=softness),
    )


def sweep(start: Combination) -> list[tuple[str, Combination]]:
    """Combinations that differ from `start` in one parameter, at five values through its range of Table 1."""
    swept: list[tuple[str, Combination]] = []
    ranges = {"R": R_RANGE, "slenderness": SLENDERNESS_RANGE, "k_base": K_N_RANGE, "k_side": K_N_RANGE}
    for name, (low, high) in (ranges | {"amplitude": AMPLITUDE_RANGE}).items():
        swept += [(name, replace(start, **{name: float(value)})) for value in np.geomspace(low, high, 5)]
    return swept


Panels = list[tuple[str, plotting.Drawing]]
"""Titles of panels, and what draws each."""


def sensitivities(base: Form, points: int, store: Path) -> tuple[list[list[object]], Panels]:
    """One parameter at a time: how much the matched damping ratios depend on it, as a table and as panels."""
    rows: list[list[object]] = []
    panels: Panels = []
    for start, middle in STARTS.items():
        swept = sweep(middle)
        for part in ("base", "side"):
            tasks = []
            for _, one in swept:
                e = mr.Restitution.from_geometry(one.wall.alpha)
                tasks.append(Match(one, e, points, None if part == "base" else presumed_damping(one, e, base)))
            matched = completed(tasks, store, workers=1)
            lines = {}
            for key, symbol in SYMBOLS.items():
                if (part, key) == ("base", "k_side"):
                    continue
                own = [row for (name, _), row in zip(swept, matched, strict=True) if name == key]
                xi = np.array([row["xi"] if row["reached"] else np.nan for row in own], dtype=float)
                known = xi[np.isfinite(xi)]
                spread = f"{known.max() / known.min():.3f}" if known.size > 1 else "-"
                rows.append([points, start, part, key, spread, f"{len(known)} of {len(xi)}"])
                if known.size:
                    lines[symbol] = np.linspace(0, 1, len(xi)), xi / np.exp(np.mean(np.log(known)))
            panels.append((f"{part}, {start}", functools.partial(law_pictures.sensitivity, curves=lines)))
    return rows, panels


def main(argv: Sequence[str] | None = None) -> None:
    """Match, draw and print."""
    args = cli.parser(__doc__, "damping_figures").parse_args(argv)
    out = cli.folder(args.out)
    store = out / "damping_figures.sqlite"
    table: list[list[object]] = []
    for name, (law, points, stiffest) in list(LAWS.items())[: 1 if args.quick else None]:
        base, side = (1, 1) if args.quick else WALLS
        plan = Plan(base_count=base, side_count=side, k_n=(K_N_RANGE[0], stiffest), seed=3)
        panels = []
        parts = ("base", law.base, plan.base_tasks(points)), ("side", law.side, plan.side_tasks(points, law.base))
        for part, form, tasks in parts:
            curves, parity = drawn_law(form, tasks, completed(tasks, store, workers=1))
            panels += [(f"{part}: matches and law", curves), (part, parity)]
        plotting.save(plotting.panels(panels), out / f"{name}.png")
        if args.quick:
            continue
        rows, drawings = sensitivities(law.base, points, store)
        table += rows
        if points == 2:
            plotting.save(plotting.panels(drawings), out / "damping_sensitivity.png")
    header = ["lines", "around", "xi of", "parameter", "largest over smallest xi", "reached"]
    cli.report(out / "damping_figures", cli.table(header, table))


if __name__ == "__main__":
    sys.exit(cli.run(main))
