"""How often the intervals and bands of a fragility curve hold the truth, in simulated studies of few and many records.

The capacity of a wall under a record is lognormal. Runs at several intensities in both polarities follow from it, as a
campaign has them, and `fit_fragility` draws records. The intensities are many, or eight that are 1.39 times apart.
`fit_capacities` takes the capacities themselves. Counted is the share of the studies whose 90 % interval holds the
median, the dispersion, and the probability at three quarters, once and one and a quarter times the true median. A study
is left out if a single intensity parts what fell.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence

import numpy as np

import mjrock as mr
from scripts.shared import cli

MEDIAN, BETWEEN, WITHIN = 0.8, 0.25, 0.08
"""Median [g], and dispersion between the records and between the polarities of a record [-]."""
LEVELS = {"13 intensities": np.linspace(0.3, 1.5, 13), "8 intensities": MEDIAN * np.geomspace(0.3, 3.0, 8)}
TRUE = math.hypot(BETWEEN, WITHIN)
AT = MEDIAN * np.array([0.75, 1.0, 1.25])
HEADER = ["records", "from", "studies", "median", "dispersion", *(f"P at {x:.2f} g" for x in AT), "no curve"]


def study(records: int, seed: int) -> dict[str, mr.Fragility | None]:
    """The fits of one simulated study: to its runs at some intensities, or None without a curve, and to capacities."""
    rng = np.random.default_rng(seed)
    middle = math.log(MEDIAN) + BETWEEN * rng.normal(size=(records, 1))
    capacity = np.exp(middle + WITHIN * rng.normal(size=(records, 2))).ravel()
    groups = np.repeat(np.arange(records), 2)
    fits: dict[str, mr.Fragility | None] = {}
    for name, levels in LEVELS.items():
        x, group = np.tile(levels, 2 * records), np.repeat(groups, len(levels))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                fits[name] = mr.fit_fragility(x, x > np.repeat(capacity, len(levels)), group, resamples=400)
            except ValueError:
                fits[name] = None
    return fits | {"capacities": mr.fit_capacities(capacity, groups, resamples=400)}


def holds(fit: mr.Fragility) -> list[bool]:
    """Whether each 90 % interval of a fit holds the truth."""
    ends = [(*fit.median_interval(), MEDIAN), (*fit.dispersion_interval(), TRUE)]
    low, high = fit.band(AT)
    truth = mr.Fragility(MEDIAN, TRUE, ((0.0, 0.0), (0.0, 0.0)), 0).probability(AT)
    return [bool(a <= t <= b) for a, b, t in (*ends, *zip(low, high, truth, strict=True))]


def coverage(records: int, studies: int) -> list[list[object]]:
    """Rows of the table for a number of records."""
    rows: list[list[object]] = []
    fits = [study(records, seed) for seed in range(studies)]
    for name in fits[0]:
        kept = [fit for own in fits if (fit := own[name]) is not None]
        shares = np.mean([holds(fit) for fit in kept], axis=0)
        without = np.mean([fit.without_curve / 400 for fit in kept])
        rows.append([records, name, len(kept), *(f"{share:.3f}" for share in shares), f"{without:.4f}"])
    return rows


def main(argv: Sequence[str] | None = None) -> None:
    """Simulate the studies, and print how often the intervals hold the truth."""
    args = cli.parser(__doc__, "fragility_coverage").parse_args(argv)
    out = cli.folder(args.out)
    sizes = {5: 20} if args.quick else {5: 400, 8: 400, 20: 300, 40: 200}
    text = cli.table(HEADER, [row for records, studies in sizes.items() for row in coverage(records, studies)])
    cli.report(out / "fragility_coverage", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
