"""What the answer for one wall depends on: the peak of a single run, and the intensity that overturns it.

A façade of 12 m by 0.9 m under synthetic records, one-sided. The first table shifts the intensity of one run by very
little. The second has the intensity that overturns the wall on bases of several stiffnesses, on two corner lines and on
a bed of sixteen, over that of rocking theory.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli, suite

WALL = mr.Block.from_size(thickness=0.9, height=12.0, length=10.0, density=1900.0)
E = mr.Restitution.from_geometry(WALL)
SHIFTS = [1 + 1e-5, 1 + 1e-4, 1 - 1e-3, 1 + 1e-3]
STIFFNESSES = [3e8, 1e9, 3e9]
SEEDS = {"2": 2, "3": 3, "4": 4, "5": 5}


def build(
    intensity: float = 1.0, k_n: float = 1e9, points: int = 2, seed: int = 2, polarity: int = 0, solver: str = "MuJoCo"
) -> mr.Analysis:
    """The wall under a synthetic record."""
    motion = mr.GroundMotion.synthetic(4.0, 12.0, seed=seed).scaled(intensity).polarities[polarity]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the bed of 3e9 N/m3 lies just beyond the range of its law
        contacts = mr.Contacts.from_law(WALL, E, k_base=k_n, k_side=k_n, points=points)
    case = mr.Case(WALL, 0.0, 15.0, motion=motion)
    return mr.Analysis(case, solver, e=E, contacts=contacts, options=suite.OPTIONS[solver])


def capacity(**settings: Any) -> mr.Capacity:
    """The lowest intensity that overturns the wall."""
    return mr.Capacity(build(**settings), tolerance=0.01)


LABELS = {
    "seed": "the seed of the record",
    "polarity": "its polarity, 1 is reversed",
    "k_n": "stiffness $k_n$",
    "points": "contact lines",
    "capacity_g": "intensity that overturns the wall",
}
"""What the figure calls the settings and the result."""


def drawn(found: mr.Sensitivity) -> Figure:
    """How far one setting at a time moves the intensity that overturns the wall."""
    return plotting.single(lambda ax: plotting.tornado(ax, found, LABELS), (6.4, 3.2))


def main(argv: Sequence[str] | None = None) -> None:
    """Run the studies, draw them, and print the tables."""
    args = suite.parser(__doc__, "sensitivity", records=False).parse_args(argv)
    out = cli.folder(args.out)
    store = out / "sensitivity.sqlite"
    options: dict[str, Any] = {"workers": args.workers}
    single: dict[str, dict[str, object]] = {
        "rocking theory": {"solver": "analytical"},
        "MuJoCo, 1e9 N/m3": {"solver": "MuJoCo"},
        "MuJoCo, 3e9 N/m3": {"solver": "MuJoCo", "k_n": 3e9},
    }
    text = []
    for name, base in list(single.items())[: 1 if args.quick else None]:
        found = mr.sensitivity(build, {"intensity": 1.0} | base, {"intensity": SHIFTS}, store, **options)
        text += [name, found.csv()]
    seeds = list(SEEDS.values())[: 1 if args.quick else None]
    stiffnesses = STIFFNESSES[1:2] if args.quick else STIFFNESSES
    unknown: dict[str, Sequence[object]] = {"k_n": stiffnesses, "points": [2] if args.quick else [2, 16]}
    rows = []
    for seed in seeds:
        theory = mr.sensitivity(capacity, {"seed": seed}, {"solver": ["analytical"]}, store, **options).base_value
        found = mr.sensitivity(capacity, {"seed": seed, "k_n": stiffnesses[0]}, unknown, store, **options)
        ratio = {(row["k_n"], row["points"]): row["capacity_g"] / theory for row in found.rows}
        rows += [[seed, f"{theory:.3f}", f"{k:.0e}", n, f"{share:.2f}"] for (k, n), share in ratio.items()]
    text.append(cli.table(["seed", "theory [g]", "k_n [N/m3]", "lines", "over theory"], rows))
    middle: dict[tuple[object, object], list[float]] = {}
    for row in rows:
        middle.setdefault((row[2], row[3]), []).append(float(str(row[4])))
    lines = [[*key, f"{np.median(v):.2f}", f"{min(v):.2f} to {max(v):.2f}"] for key, v in middle.items()]
    text.append(cli.table(["k_n [N/m3]", "lines", "median over theory", "over the records"], lines))
    base = {"k_n": stiffnesses[-1] if args.quick else 1e9, "seed": seeds[0]}
    vary = unknown | {"seed": seeds, "polarity": [0] if args.quick else [0, 1]}
    found = mr.sensitivity(capacity, base, vary, store, together=False, **options)
    plotting.save(drawn(found), out / "sensitivity.png")
    text.append(found.table())
    cli.report(out / "sensitivity", "\n\n".join(text))


if __name__ == "__main__":
    sys.exit(cli.run(main))
