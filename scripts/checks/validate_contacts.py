"""What contacts are worth beyond a first rebound on a base that holds: amplitude, size, stiffness, friction.

Every wall is asked for the theoretical restitution (Eqs. 2-4), on walls of Table 1 that no fit has seen. Prints five
tables: |e| against the size of the rebound, the law told the amplitude, contacts as theory has them, contacts matched
to friction, and beds inside their domain. Writes validate_contacts.csv with every wall.
"""

from __future__ import annotations

import itertools
import math
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock import machine
from mjrock.study.matching.match import Combination, combinations
from scripts.shared import cli

SEED = 2001
"""Of the walls; the fits use 1 and 2, and `validate_law.py` 1001."""
AMPLITUDES = (0.08, 0.12, 0.2, 0.3, 0.5, 0.7, 0.9)
SIZES = (1.0, 1.5, 2.5, 4.0, 8.0, 16.0, 32.0, 1e3)
"""Classes of theory's rebound over the rotation at which an edge lifts [-]."""
FRICTIONS = ((None, None), (0.8, None), (0.6, None), (0.4, None), (None, 0.6), (0.8, 0.6), (0.6, 0.6), (0.4, 0.6))
REBOUNDS = 4
Row = dict[str, Any]


def case_of(one: Combination) -> mr.Case:
    """One-sided, long enough for four rebounds."""
    quarter = math.acosh(1 / (1 - one.amplitude)) / one.wall.p
    return mr.Case(one.wall, one.amplitude * one.wall.alpha, 10 * quarter)


def obtained(one: Combination, contacts: mr.Contacts, **options: Any) -> Row:
    """The errors of |e| by both measures, and the size of theory's rebounds over the uplift rotation."""
    wall, e, case = one.wall, mr.Restitution.from_geometry(one.wall), case_of(one)
    response = mr.simulate(case, contacts, **options)
    released, uplift = float(wall.potential_energy(case.theta0)), contacts.uplift_rotation(wall)
    row: Row = {"steps": response.stats["steps"]}
    for n in range(REBOUNDS):
        row[f"size_{n + 1}"] = wall.rotation_at(released * abs(e.lumped) ** (2 * n + 2)) / uplift
        for name, found in (("e", response.restitution), ("settled", response.settled_restitution)):
            row[f"{name}_{n + 1}"] = float(found[n]) / abs(e.lumped) - 1 if n < len(found) else math.nan
    return row


def by_law(one: Combination, points: int, amplitude: float) -> Row:
    """A wall with the law of its layout, told an amplitude."""
    e = mr.Restitution.from_geometry(one.wall)
    contacts = mr.Contacts.from_law(one.wall, e, one.k_base, one.k_side, points=points, amplitude=amplitude)
    return obtained(one, contacts, accuracy=1e-4)


def by_theory(one: Combination) -> Row:
    """A wall on contacts as theory has them, and how long a run takes over one on a base of its own stiffness."""
    e = mr.Restitution.from_geometry(one.wall)
    contacts = mr.as_theory(one.wall, e, amplitude=one.amplitude)
    usual = mr.Contacts.from_law(one.wall, e, one.k_base, one.k_side)

    def seconds(these: mr.Contacts) -> float:
        return float(np.median([cli.seconds(lambda: mr.simulate(case_of(one), these)) for _ in range(5)]))

    return obtained(one, contacts) | {"k_n": contacts.base.k_n, "time": seconds(contacts) / seconds(usual)}


def by_match(one: Combination, points: int, friction: float | None, side_friction: float | None) -> Row:
    """A wall on contacts matched to its friction, run at the default accuracy, and with the damping of the law."""
    e = mr.Restitution.from_geometry(one.wall)
    with warnings.catch_warnings(record=True) as missed:
        warnings.simplefilter("always")
        contacts = mr.matched_contacts(
            one.wall, e, one.k_base, one.k_side, points=points, amplitude=one.amplitude,
            friction=friction, side_friction=side_friction,
        )  # fmt: skip
    law = mr.Contacts.from_law(one.wall, e, one.k_base, one.k_side, points=points, amplitude=one.amplitude)
    assert law.side is not None
    law = mr.Contacts(
        replace(law.base, friction=friction), replace(law.side, friction=side_friction), f"{law.law}, not told"
    )
    return obtained(one, contacts) | {"reached": not missed, "law_1": obtained(one, law)["e_1"]}


def carried_out(work: tuple[Callable[..., Row], tuple[Any, ...], Mapping[str, Any]]) -> Row:
    """One wall, in a worker."""
    warnings.simplefilter("ignore", UserWarning)
    function, arguments, labels = work
    return {**labels, **function(*arguments)}


def everywhere(name: str, works: Sequence[tuple[Callable[..., Row], tuple[Any, ...], Mapping[str, Any]]]) -> list[Row]:
    """All walls of a table, on all cores."""
    with ProcessPoolExecutor(machine.cores()) as pool:
        return list(tqdm(pool.map(carried_out, works, chunksize=4), total=len(works), desc=name, disable=None))


def shares(errors: Iterable[float]) -> list[str]:
    """Median and 95 % of the size of errors."""
    sizes = np.abs(np.array(list(errors), dtype=float))
    sizes = sizes[np.isfinite(sizes)]
    return [f"{np.median(sizes):.2%}", f"{np.percentile(sizes, 95):.2%}"] if sizes.size else ["-", "-"]


def rebound_table(rows: Sequence[Row]) -> str:
    """Errors against the size of theory's rebound, over all rebounds of all releases."""
    lines: list[list[object]] = []
    size, e, settled = (
        np.array([[row[f"{name}_{n + 1}"] for n in range(REBOUNDS)] for row in rows]).ravel()
        for name in ("size", "e", "settled")
    )
    for low, high in itertools.pairwise(SIZES):
        within = (size >= low) & (size < high)
        none = float(np.mean(np.isnan(e[within]))) if within.any() else math.nan
        label = f"{low:g} to {high:g}" if high < 1e3 else f"over {low:g}"
        signed = (f"{np.nanmedian(values[within]):+.2%}" for values in (e, settled))
        lines.append([label, within.sum(), *shares(e[within]), *signed, f"{none:.0%}"])
    header = ["rebound / uplift", "rebounds", "median error", "95 %", "signed, V", "signed, settled", "none found"]
    return cli.table(header, lines)


def amplitude_table(rows: Sequence[Row]) -> str:
    """The first rebound from low and high releases, the law told the amplitude or not."""
    lines: list[list[object]] = []
    for points in (2, 16):
        for phi in sorted({row["amplitude"] for row in rows}):
            own = [r for r in rows if (r["points"], r["amplitude"]) == (points, phi) and r["size_1"] > 1.5]
            if not own:
                continue
            informed = [shares(r["e_1"] for r in own if r["told"] is way) for way in (False, True)]
            lines.append([points, f"{phi:g}", len(own) // 2, *informed[0], *informed[1]])
    header = ["lines", "theta_0/alpha", "walls", "default amplitude: median", "95 %", "amplitude given: median", "95 %"]
    return cli.table(header, lines)


def theory_table(rows: Sequence[Row]) -> str:
    """The worst error of each of four rebounds by slenderness, and what the stiffness costs."""
    lines: list[list[object]] = []
    for low, high in ((4.0, 4.5), (4.5, 6.0), (6.0, 9.0), (9.0, 15.0)):
        own = [r for r in rows if low <= r["slenderness"] <= high]
        if not own:
            continue
        worst = (f"{max(abs(r[f'e_{n + 1}']) for r in own):.2%}" for n in range(REBOUNDS))
        stiffness = f"{min(r['k_n'] for r in own):.1e} to {max(r['k_n'] for r in own):.1e}"
        lines.append(
            [f"{low:g} to {high:g}", len(own), stiffness, *worst, f"{np.median([r['time'] for r in own]):.1f}"]
        )
    header = ["h/b", "walls", "k_n [N/m3]", *(f"rebound {n + 1}" for n in range(REBOUNDS)), "time over Table 1's base"]
    return "largest error of |e|\n" + cli.table(header, lines)


def friction_table(rows: Sequence[Row]) -> str:
    """The first rebound on contacts matched to friction, where theory's rebound lifts an edge, and the second."""
    lines: list[list[object]] = []
    for points in (2, 16):
        for friction, side in FRICTIONS:
            own = [r for r in rows if (r["points"], r["friction"], r["side_friction"]) == (points, friction, side)]
            own = [r for r in own if r["size_1"] > 1.0]
            if not own:
                continue
            reached = [r for r in own if r["reached"]]
            second = np.array([r["e_2"] for r in reached if r["size_2"] > 4])
            lines.append(
                [
                    points, "holds" if friction is None else f"{friction:g}", f"{side or 0:g}", len(own), len(reached),
                    *shares(r["e_1"] for r in reached), shares(r["law_1"] for r in reached)[0],
                    f"{np.nanmedian(second):+.0%}" if np.isfinite(second).any() else "-",
                ]
            )  # fmt: skip
    header = [
        "lines", "mu base", "mu side", "walls", "reached", "matched: median", "95 %", "law without friction: median",
        "second rebound, signed",
    ]  # fmt: skip
    return cli.table(header, lines)


def bed_table(rows: Sequence[Row]) -> str:
    """Beds inside the domain that `DampingLaw.covers` states."""
    lines = [[i, len(rows), *shares(r[f"e_{i}"] for r in rows if r[f"size_{i}"] > 1.5)] for i in (1, 2)]
    lost = sum(math.isnan(row["e_1"]) for row in rows)
    return cli.table(["rebound", "walls", "median error", "95 %"], lines) + f"\nwalls without a rebound: {lost}"


def main(argv: Sequence[str] | None = None) -> None:
    """Run, write and print."""
    parser = cli.parser(__doc__, "validate_contacts")
    parser.add_argument("--count", type=int, default=60, help="walls of each table")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    ones = combinations(2 if args.quick else args.count, SEED)
    beds: list[Combination] = []
    for seed in range(SEED + 1, SEED + 50):
        for one in combinations(50, seed):
            e = mr.Restitution.from_geometry(one.wall)
            if mr.CALIBRATED_BED.covers(one.wall, e, one.k_base, one.k_side, one.amplitude):
                beds.append(one)
    beds = beds[: 2 if args.quick else 3 * args.count]

    layouts, frictions = ((2,), FRICTIONS[1:3]) if args.quick else ((2, 16), FRICTIONS)
    released = [replace(one, amplitude=phi) for one in ones for phi in AMPLITUDES]
    rebounds = everywhere("rebounds", [(by_law, (one, 2, 0.5), {}) for one in released])
    informed = everywhere(
        "amplitude",
        [
            (by_law, (replace(one, amplitude=phi), points, phi if way else 0.5),
             {"points": points, "amplitude": phi, "told": way})
            for points in layouts for phi in (0.08, 0.2, 0.8) for way in (False, True) for one in ones
        ],
    )  # fmt: skip
    theory = everywhere("as theory", [(by_theory, (one,), {"slenderness": one.slenderness}) for one in ones])
    friction = everywhere(
        "friction",
        [
            (by_match, (one, points, *mu), {"points": points, "friction": mu[0], "side_friction": mu[1]})
            for points in layouts for mu in frictions for one in ones
        ],
    )  # fmt: skip
    bed = everywhere("beds", [(by_law, (one, 16, one.amplitude), {}) for one in beds])
    tables = {
        "rebounds": (rebounds, "CALIBRATED, every rebound by its size in theory", rebound_table),
        "amplitude": (
            informed,
            "First rebound, rebounds of more than 1.5 times the uplift rotation",
            amplitude_table,
        ),
        "as theory": (theory, "Contacts as theory has them (`as_theory`)", theory_table),
        "friction": (friction, "Contacts matched to friction (`matched_contacts`)", friction_table),
        "beds": (bed, "Beds of 16 lines inside the domain of CALIBRATED_BED", bed_table),
    }
    report = "\n\n".join(f"{title}\n{table(rows)}" for rows, title, table in tables.values())
    names = list(dict.fromkeys(key for rows, _, _ in tables.values() for row in rows for key in row))
    values = [[name, *(row.get(key, "") for key in names)] for name, (rows, _, _) in tables.items() for row in rows]
    cli.report(out / "validate_contacts", report, ["table", *names], values)


if __name__ == "__main__":
    sys.exit(cli.run(main))
