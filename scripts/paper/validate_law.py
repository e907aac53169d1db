"""What the damping laws are worth: restitution obtained on walls that no fit has seen, the specimens, and the step.

Every wall is asked for the theoretical restitution (Eqs. 2-4). Writes damping_validation.png, damping_validation.txt
and table2_laws.csv. Runs are kept in damping_validation.sqlite: the same call carries on after a kill.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

import mjrock as mr
from mjrock import plotting
from mjrock.problem.damping.law import CALIBRATED, CALIBRATED_BED, PUBLISHED, DampingLaw, Groups
from mjrock.study.campaign.campaign import completed
from mjrock.study.matching.calibration import Plan, regress, well_matched
from mjrock.study.matching.match import Combination, Match, combinations
from scripts.shared import cli, law_pictures
from scripts.shared.paper import K_N, TABLE_2

SEED = 1001
"""Of the validation set; the fits use 1 and 2."""
REBOUNDS = 3
LABELS = {"PUBLISHED": "published law", "CALIBRATED": "calibrated law", "CALIBRATED_BED": "calibrated law, bed"}
"""Of the laws in the figure."""


@contextmanager
def quiet() -> Iterator[None]:
    """Without the laws' warnings: how often they are out of range is counted here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        yield


def laws(folder: Path | None) -> dict[int, list[DampingLaw]]:
    """The laws to compare, by contact lines a face: those of the package, or of a folder."""
    if folder is None:
        return {2: [PUBLISHED, CALIBRATED], 16: [PUBLISHED, CALIBRATED_BED]}
    own = [DampingLaw.load(path) for path in sorted(folder.glob("*.toml"))]
    return {points: [PUBLISHED, *(law for law in own if law.points == points)] for points in (2, 16)}


def main(argv: Sequence[str] | None = None) -> None:
    """Run, write and print."""
    parser = cli.parser(__doc__, "validate_law")
    parser.add_argument("--count", type=int, default=200, help="walls of the validation set")
    parser.add_argument("--laws", type=Path, default=None, help="folder of laws, instead of those of the package")
    parser.add_argument("--workers", type=int, default=None, help="processes; one for each processor by default")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    compared = laws(args.laws)
    ones = combinations(4 if args.quick else args.count, SEED)
    with quiet():
        table, drawings = validation(ones, compared, out, args.workers)
        specimens = table_2(compared, out)
        steps = "" if args.quick else step_study(compared, out / "damping_validation.sqlite", args.workers)
    plotting.save(plotting.panels(drawings), out / "damping_validation.png")
    report = "\n\n".join(part for part in (table, specimens, steps) if part)
    cli.report(out / "damping_validation", report)


def validation(
    ones: Sequence[Combination], compared: Mapping[int, Sequence[DampingLaw]], out: Path, workers: int | None
) -> tuple[str, list[tuple[str, plotting.Drawing]]]:
    """Errors of |e| on the validation set, a row a layout, side and law."""
    tasks = []
    for points, here in compared.items():
        for law in here:
            for one in ones:
                e = mr.Restitution.from_geometry(one.wall.alpha)
                contacts = mr.Contacts.from_law(one.wall, e, one.k_base, one.k_side, law, points)
                for sides in (2, 1):
                    labels = {
                        "points": points, "damping": law.name, "sides": sides, "R": one.R,
                        "slenderness": one.slenderness, "k_base": one.k_base, "k_side": one.k_side,
                        "amplitude": one.amplitude, "e": abs(e.lumped) if sides == 1 else e.base,
                    }  # fmt: skip
                    quarter = math.acosh(1 / (1 - one.amplitude)) / one.wall.p
                    case = mr.Case(one.wall, one.amplitude * one.wall.alpha, 8 * quarter, side_stop=sides == 1)
                    tasks.append(mr.Analysis(case, contacts=contacts, options={"accuracy": 1e-4}, labels=labels))
    rows = completed(tasks, out / "damping_validation.sqlite", workers=workers)
    lines, drawings = [], []
    for points, here in compared.items():
        for sides in (2, 1):
            samples = {}
            for law in here:
                own = [r for r in rows if (r["points"], r["damping"], r["sides"]) == (points, law.name, sides)]
                wanted = np.array([r["e"] for r in own], dtype=float)
                found = np.array([[r[f"restitution_{i + 1}"] for i in range(REBOUNDS)] for r in own], dtype=float)
                samples[LABELS.get(law.name, law.name)] = (
                    wanted,
                    found[:, 0] if sides == 2 else np.nan_to_num(found[:, 0]),
                )
                lines += errors(f"{points} lines, {'one' if sides == 1 else 'two'}-sided", law, ones, wanted, found)
            title = f"{points} lines a face, {'one' if sides == 1 else 'two'}-sided, {len(ones)} walls"
            drawings.append((title, _obtained(samples)))
    header = ["layout", "law", "walls", "rebound", "median error of |e|", "95 %", "largest", "without rebound"]
    return cli.table(header, lines), drawings


def _obtained(samples: Mapping[str, tuple[Any, Any]]) -> plotting.Drawing:
    return lambda ax: law_pictures.obtained(ax, samples)


def errors(title: str, law: DampingLaw, ones: Sequence[Combination], wanted: Any, found: Any) -> list[list[object]]:
    """Errors of the first rebounds, over all walls and over those that can have what is asked for.

    These are the walls whose base reaches e_2s, and whose first rebound in theory goes beyond the rotation at which an
    edge lifts off the base. A wall that does not rebound has lost everything: an error of 100 % at its first rebound.
    Later ones are counted where there is one.
    """
    within = np.array([possible(law, one, e) for one, e in zip(ones, wanted, strict=True)])
    lines: list[list[object]] = []
    for name, chosen in (("all", np.ones(len(wanted), dtype=bool)), ("possible", within)):
        if name == "possible" and within.all():
            continue
        for i in range(REBOUNDS):
            measured = found[chosen, i]
            known = np.isfinite(measured) | (i == 0)
            error = np.abs(np.nan_to_num(measured[known]) / wanted[chosen][known] - 1)
            if error.size:
                shares = (f"{value:.2%}" for value in (np.median(error), np.percentile(error, 95), error.max()))
                lines.append([title, law.name, f"{name}, {known.sum()}", i + 1, *shares, int((error == 1).sum())])
    return lines


def possible(law: DampingLaw, one: Combination, wanted: float) -> bool:
    """Whether the base reaches theory's e_2s, and a rebound with |e| = `wanted` lifts an edge off it."""
    wall = one.wall
    low, high = law.reach(wall, one.k_base)
    peak = wall.rotation_at(wanted**2 * float(wall.potential_energy(one.amplitude * wall.alpha)))
    uplift = Groups.from_wall(wall, mr.Restitution.from_geometry(wall.alpha), one.k_base).softness * wall.alpha
    return bool(low <= mr.Restitution.from_geometry(wall.alpha).base <= high and peak > uplift)


def table_2(compared: Mapping[int, Sequence[DampingLaw]], out: Path) -> str:
    """The six specimens with the measured e_1s: first rebound peak and restitution, law beside law."""
    rows: list[list[object]] = []
    for specimen in TABLE_2:
        wall, e = specimen.block, specimen.restitution
        case = mr.Case(wall, theta0=0.5 * wall.alpha, duration=1.2)
        theory = mr.solve_analytical(case, e)
        for points, here in compared.items():
            for law in here:
                contacts = mr.Contacts.from_law(wall, e, K_N, K_N, law, points)
                assert contacts.side is not None
                candidate = mr.simulate(case, contacts, accuracy=1e-4)
                wanted, peak = mr.compare(theory, candidate).first_rebound_peak
                found = float(candidate.restitution[0]) if len(candidate.restitution) else 0.0
                peak = 0.0 if math.isnan(peak) else peak
                rows.append(
                    [
                        specimen.name, points, law.name, f"{contacts.base.xi:.2%}", f"{contacts.side.xi:.2%}",
                        f"{contacts.uplift_rotation(wall) / wall.alpha:.4f}", f"{wanted:.4f}", f"{peak:.4f}",
                        f"{peak / wanted - 1:+.1%}", f"{-specimen.lumped:.3f}", f"{found:.3f}",
                        f"{found / -specimen.lumped - 1:+.1%}",
                    ]
                )  # fmt: skip
    header = [
        "specimen", "lines", "law", "xi_b", "xi_s", "uplift/alpha", "peak/alpha theory", "peak/alpha MuJoCo",
        "error of peak", "|e_1s| measured", "|e_1s| MuJoCo", "error of |e_1s|",
    ]  # fmt: skip
    cli.write_text(out / "table2_laws.csv", cli.csv_text(header, rows))
    return cli.table(header, rows)


def step_study(compared: Mapping[int, Sequence[DampingLaw]], store: Path, workers: int | None) -> str:
    """How far half the step moves matched damping ratios, and the predictions of a law fitted to them."""
    rows: list[list[object]] = []
    plan = Plan(base_count=12, side_count=12)
    for points, here in compared.items():
        law = here[-1]
        base_tasks, side_tasks = plan.base_tasks(points), plan.side_tasks(points, law.base)
        for part, form, tasks in (
            ("base", type(law.base), base_tasks),
            ("side", type(law.side), side_tasks),
        ):
            fine_tasks = [Match(t.combination, t.e, points, t.xi_base, accuracy=0.25e-4) for t in tasks]
            coarse, fine = (completed(own, store, workers=workers) for own in (tasks, fine_tasks))
            both = [i for i in range(len(tasks)) if well_matched(coarse[i]) and well_matched(fine[i])]
            fits = [regress(form, [tasks[i] for i in both], [own[i] for i in both]) for own in (coarse, fine)]
            groups, loss = fits[0].groups, fits[0].loss
            shift = np.abs(np.asarray(fits[1].form.xi(groups, loss)) / np.asarray(fits[0].form.xi(groups, loss)) - 1)
            matched = np.array([fine[i]["xi"] / coarse[i]["xi"] for i in both])
            rows.append(
                [
                    points, part, len(both), f"{np.exp(np.mean(np.log(matched))) - 1:+.2%}",
                    f"{np.median(np.abs(matched - 1)):.2%}", f"{np.percentile(np.abs(matched - 1), 95):.2%}",
                    f"{np.median(shift):.2%}", f"{np.percentile(shift, 95):.2%}",
                ]
            )  # fmt: skip
    header = ["lines", "part", "pairs", "matched xi: mean change", "median", "95 %", "predicted xi: median", "95 %"]
    return "Half the step (accuracy 0.25e-4 for 1e-4):\n" + cli.table(header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
