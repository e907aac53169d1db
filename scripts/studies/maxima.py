"""Distributions of the maxima of a wall on a shake table: those of the tests beside those of each model.

A single motion of a rocking structure cannot be predicted, and its repetition differs. The authors of the tests of the
ETH podium (doi 10.1177/8755293020988017) therefore ask of a model the distribution of its maxima over an ensemble of
runs. The ensemble here is that of the wall US-1, its 24 runs at 2.06 m, as `shaken_wall.py` has them; its twin US-2 is
the repetition. Of each way to damp the wall in the plane the medians of ten starts come from the table that
`cracked_damping.py` has written. The distance is that of Kolmogorov and Smirnov. How often chance alone makes it as
large, if test and model of a run could change places, is found from random exchanges within runs.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mjrock import plotting
from mjrock.plotting.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, Look
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.studies.shaken_wall import RUNS

TABLE = Path(__file__).parents[2] / "docs" / "figures" / "cracked_damping.csv"
"""What `cracked_damping.py` has written: of each way the 16, 50 and 84 % of ten starts [mm]."""
EXCHANGES, RESAMPLED, SEED = 20_000, 2_000, 1
"""Random exchanges, and ensembles of tests that are drawn with replacement for the band of the picture."""
TWIN, DECK = "twin US-2", "3DEC, undamped"
LOOKS: Sequence[Look] = (
    {"color": "0.45", "linestyle": "--"},
    {"color": GREEN, "linestyle": ":"},
    {"color": ORANGE},
    {"color": PURPLE, "linestyle": (0, (1, 1))},
    {"color": BLUE, "linewidth": 1.8},
    {"color": BLUE, "linestyle": "-."},
)
SKIPPED = "published law both bodies"
"""A way that the page on it gives up."""


def ensembles(table: Path) -> dict[str, Array]:
    """Largest displacements of all runs [mm] of the twin, of the authors' model and of each way, shape (runs,)."""
    with table.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if [int(row["run"]) for row in rows] != list(RUNS):
        raise ValueError(
            f"{table} has {len(rows)} runs, and the test has {len(RUNS)}; run cracked_damping.py without --quick"
        )
    found = {TWIN: np.array([run.twin.peak for run in RUNS.values()])}
    found[DECK] = np.array([run.model.peak for run in RUNS.values()])
    ends = " [mm]: 16 50 84 %"
    for column in (name for name in rows[0] if name.endswith(ends) and not name.startswith(SKIPPED)):
        found[column.removesuffix(ends)] = np.array([float(row[column].split(";")[1]) for row in rows])
    return found


def distance(one: Array, other: Array) -> float:
    """Largest difference of two distributions [-], shape (n,) each."""
    both = np.sort(np.concatenate((one, other)))
    shares = [np.searchsorted(np.sort(values), both, side="right") / len(values) for values in (one, other)]
    return float(np.abs(shares[0] - shares[1]).max())


def chance(one: Array, other: Array) -> float:
    """Share of random exchanges within runs whose distance is at least that of the ensembles."""
    draws = np.random.default_rng(SEED).random((EXCHANGES, len(one))) < 0.5
    limit = distance(one, other) - 1e-9
    return float(np.mean([distance(np.where(s, one, other), np.where(s, other, one)) >= limit for s in draws]))


def judged(test: Array, found: Mapping[str, Array], of: Array) -> list[list[object]]:
    """A row an ensemble: distance and chance, and median and scatter of the factors, over the runs of a mask."""
    rows: list[list[object]] = []
    for name, values in found.items():
        factor = np.log(values[of] / test[of])
        row = [name, f"{distance(values[of], test[of]):.2f}", f"{chance(values[of], test[of]):.3f}"]
        rows.append([*row, f"{np.exp(np.median(factor)):.2f}", f"{factor.std(ddof=1):.2f}"])
    return rows


def draw_distribution(ax: Axes, values: Array, name: str, look: Look) -> None:
    """The share of values up to each of them."""
    ax.step(
        [values.min(), *np.sort(values)], np.arange(len(values) + 1) / len(values), where="post", label=name, **look
    )


def drawn(test: Array, found: Mapping[str, Array]) -> Figure:
    """Distributions of the maxima, and of their factors to the test run by run."""
    figure = Figure(figsize=(7.4, 3.9), layout="constrained")
    maxima, factors = figure.subplots(1, 2, sharey=True)
    at = np.geomspace(0.1, 100.0, 400)
    drawn_again = np.random.default_rng(SEED).choice(test, (RESAMPLED, len(test)))
    low, high = np.percentile((drawn_again[:, :, None] <= at).mean(axis=1), [5, 95], axis=0)
    maxima.fill_between(at, low, high, color="0.9", linewidth=0, label="tests, 90 % band")
    draw_distribution(maxima, test, "test US-1", {"color": BLACK, "linewidth": 2})
    for (name, values), look in zip(found.items(), LOOKS, strict=True):
        draw_distribution(maxima, values, name, look)
        draw_distribution(factors, values / test, name, look)
    factors.axvline(1.0, color=BLACK, linewidth=2)
    factors.axvspan(0.5, 2.0, color="0.94", zorder=0)
    maxima.set(xscale="log", xlabel="largest displacement at 2.06 m [mm]", ylabel="share of the runs up to it [-]")
    factors.set(xscale="log", xlabel="over that of the test in the same run [-]", xlim=(0.2, 8))
    factors.set_xticks([0.25, 0.5, 1, 2, 4, 8], ["0.25", "0.5", "1", "2", "4", "8"])
    factors.minorticks_off()
    plotting.style.below_figure(figure, maxima, ncols=4)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Compare the distributions, print the tables and draw."""
    parser = cli.parser(__doc__, "maxima")
    parser.add_argument("--table", type=Path, default=TABLE, help="what cracked_damping.py has written")
    args = parser.parse_args(argv)
    out = cli.folder(args.out)
    test, found = np.array([run.test for run in RUNS.values()]), ensembles(args.table)
    header = ["ensemble", "distance to the tests", "chance of it", "median factor", "scatter of its logarithm"]
    records = np.array([run.record for run in RUNS.values()])
    of = {"all 24 runs": records != ""} | ({} if args.quick else {"17 runs of HU12": records == "HU12"})
    tables = {name: judged(test, found, mask) for name, mask in of.items()}
    plotting.save(drawn(test, found), out / "maxima.png")
    text = "\n\n".join(f"{name}\n{cli.table(header, rows)}" for name, rows in tables.items())
    cli.report(out / "maxima", text, ["runs", *header], [[name, *row] for name, rows in tables.items() for row in rows])


if __name__ == "__main__":
    sys.exit(cli.run(main))
