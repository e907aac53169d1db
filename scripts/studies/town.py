"""A town of 200 façades from a table: which of them lean far or fall, on a map, and the fragility of the town.

The walls are made up: their numbers are drawn by a seed, as no table of real façades is at hand. Each is shaken by
artificial records that fit the NTC 2018 spectrum of its soil, in both polarities, at peak accelerations on rock from
0.15 to 0.65 g, by rocking theory. The campaign is first killed with SIGKILL and then carries on. The curves stand
beside published ones of whole buildings, which are of another limit state. `--dask` runs the same call on Dask.
"""

from __future__ import annotations

import contextlib
import csv
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

import mjrock as mr
from mjrock import plotting
from mjrock.study.campaign.campaign import completed
from mjrock.study.campaign.task import Row
from scripts.shared import cli

COLUMNS = ("id", "x_m", "y_m", "height_m", "thickness_m", "length_m", "density_kg_m3", "soil", "tie_kN")
"""Of the table of walls. A façade with a tie_kN of zero has no tie."""
Walls = Mapping[str, Mapping[str, str]]
"""Rows of the table of walls, by their ids."""
SOILS = {"C": (0.0, 130.0, 0.2), "B": (130.0, 350.0, 0.08), "A": (350.0, 500.0, 0.0)}
"""From where to where each soil lies, northwards [m]: the river, the plain, the hill. And how grey the map is there."""
F0, TC = 2.45, 0.33
"""Amplification [-] and corner period [s] of the spectrum on rock, the same at all levels."""
PERIODS = np.linspace(0.3, 2.0, 18)
"""Over which a record fits the spectrum of its soil [s]."""
LEVELS, SHOWN = (0.15, 0.2, 0.3, 0.45, 0.65), 0.3
"""Peak accelerations on rock [g], and that of the map."""
FAR = 0.4
"""The share of the overturning rotation that the Circolare allows at the SLV [-], C8.7.1.2.1.6."""
RESAMPLES = 200
PUBLISHED = {"Saretta et al. 2023": 0.10, "Masi et al. 2021": 0.11, "Rosti et al. 2022": 0.14}
"""Medians of the damage state D2 of whole buildings of class A [g], as Saretta et al. (2023), Procedia Structural
Integrity 44, 59-66, compare them."""


def drawn(seed: int = 7, count: int = 200) -> list[tuple[object, ...]]:
    """Walls of two to four storeys along crooked streets, two in five with a tie, as rows of COLUMNS."""
    rng, walls = np.random.default_rng(seed), list[tuple[object, ...]]()
    for i in range(count):
        x, y = 40 * (i % 20 + 0.5) + rng.uniform(-12, 12), 50 * (i // 20 + 0.5) + rng.uniform(-15, 15)
        height = rng.choice([2, 3, 4], p=[0.45, 0.4, 0.15]) * rng.uniform(2.9, 3.6)
        size = f"{height:.1f}", f"{rng.uniform(0.45, 0.8):.2f}", f"{rng.uniform(5, 11):.1f}"
        density, tie = rng.choice([1800, 1900, 2100]), rng.choice([0, 0, 0, 30, 60])
        soil = next(name for name, (low, high, _) in SOILS.items() if low <= y < high)
        walls.append((f"W{i:03d}", f"{x:.0f}", f"{y:.0f}", *size, density, soil, tie))
    return walls


@cache
def motion(soil: str, level: float, record: int) -> mr.GroundMotion:
    """An artificial record that fits the spectrum of a soil at a peak acceleration on rock [g]."""
    spectrum = mr.code_spectrum("NTC 2018", ag=level * mr.GRAVITY, F0=F0, Tc=TC, soil=soil)
    return mr.scaled_to_spectrum(mr.GroundMotion.synthetic(3.0, 12.0, seed=record), PERIODS, spectrum)


def grid_of(walls: Walls, records: int) -> mr.Grid:
    """Every wall at every level under every record, both ways."""

    def build(wall: str, level: float, record: int, polarity: int) -> mr.Analysis:
        own = walls[wall]
        height, thickness, length, density = (float(own[name]) for name in COLUMNS[3:7])
        block, pull = mr.Block.from_size(thickness, height, length, density), 1e3 * float(own["tie_kN"])
        ties = (mr.Tie(0.95 * height, 15e6, strength=pull, length=6.0, ultimate=0.04),) if pull else ()
        ground = motion(own["soil"], level, record).polarities[polarity]
        case = mr.Case(block, 0.0, ground.duration + 3.0, motion=ground, effects=ties)
        e = mr.Restitution.from_geometry(block)
        return mr.Analysis(case, "analytical", e=e, options={"rtol": 1e-8, "output_step": 0.05})

    return mr.Grid(build, wall=walls, level=LEVELS, record=range(records), polarity=[0, 1])


def killed(out: Path, least: int, options: Sequence[str]) -> int:
    """Let another process run the campaign, kill it with SIGKILL from so many rows on, and count the rows."""
    command = [sys.executable, "-m", "scripts.studies.town", "--only-run", "--out", str(out.resolve())]
    process = subprocess.Popen([*command, *options], cwd=Path(__file__).parents[2], stderr=subprocess.DEVNULL)
    count = 0
    while count < least and process.poll() is None:
        time.sleep(0.1)
        with contextlib.suppress(OSError, ValueError), mr.Store(out / "town.sqlite") as store:
            count = len(store)
    process.kill()
    process.wait()
    with mr.Store(out / "town.sqlite") as store:
        return len(store)


@contextlib.contextmanager
def executor_of(dask: bool) -> Iterator[Executor | None]:
    """That of Dask, with two workers, or None for processes of this machine."""
    if not dask:
        yield None
        return
    from distributed import Client

    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:  # type: ignore[no-untyped-call]
        yield client.get_executor()


class Town:
    """The rows of the campaign, and what is asked of them.

    Args:
        walls: the table.
        rows: one for each run.
    """

    def __init__(self, walls: Walls, rows: Sequence[Row]) -> None:
        self.walls, self.rows = walls, rows
        self.wall, self.record = (np.array([row[name] for row in rows]) for name in ("wall", "record"))
        self.level = np.array([float(row["level"] or 0) for row in rows])
        self.lost = mr.lost(rows)
        self.far = self.lost | (np.array([float(row["peak_over_overturning"] or 0) for row in rows]) > FAR)
        self.tied = np.array([float(walls[name]["tie_kN"]) > 0 for name in self.wall])

    def fits(self) -> dict[str, tuple[mr.Fragility, mr.Fragility]]:
        """Curves over the peak acceleration [g] and the peak velocity [m/s] where the walls stand."""
        soils = [self.walls[name]["soil"] for name in self.wall]
        grounds = [motion(*where) for where in zip(soils, self.level.tolist(), self.record.tolist(), strict=True)]
        pga, pgv = np.array([(one.peak / mr.GRAVITY, one.peak_velocity) for one in grounds]).T
        every = np.ones(len(self.rows), dtype=bool)

        def fit(x: NDArray[np.float64], bad: NDArray[np.bool_], of: NDArray[np.bool_]) -> mr.Fragility:
            return mr.fit_fragility(x[of], bad[of], self.record[of], resamples=RESAMPLES)

        parts = {"beyond 0.4 $d_0$": (self.far, every), "overturned": (self.lost, every)}
        parts |= {"overturned, no tie": (self.lost, ~self.tied), "overturned, tie": (self.lost, self.tied)}
        return {name: (fit(pga, *part), fit(pgv, *part)) for name, part in parts.items()}

    @cached_property
    def share(self) -> dict[str, float]:
        """The share of the runs of each wall at SHOWN that lean beyond 0.4 d_0 [-]."""
        here = self.level == SHOWN
        return {wall: float(self.far[here & (self.wall == wall)].mean()) for wall in self.walls}

    def lines(self) -> list[str]:
        """On how many walls of each soil most runs at SHOWN do so."""
        found = []
        for soil in sorted(SOILS):
            shares = np.array([share for wall, share in self.share.items() if self.walls[wall]["soil"] == soil])
            found.append(
                f"soil {soil}: most runs at {SHOWN:g} g beyond 0.4 d_0 in {(shares > 0.5).sum()} of {len(shares)} walls"
            )
        return found

    def draw(self, ax: Axes) -> Axes:
        """The map: where the walls stand, coloured by their `share`."""
        for soil, (low, high, grey) in SOILS.items():
            ax.axhspan(low, high, color="0.5", alpha=grey, linewidth=0)
            ax.text(806, 0.5 * (low + high), f"soil {soil}", rotation=90, va="center", fontsize=8)
        for marker, tied in (("o", False), ("s", True)):
            names = [wall for wall in self.walls if (float(self.walls[wall]["tie_kN"]) > 0) == tied]
            at = np.array([[float(self.walls[wall][axis]) for axis in ("x_m", "y_m")] for wall in names])
            share = [self.share[wall] for wall in names]
            points = ax.scatter(at[:, 0], at[:, 1], 26, share, marker=marker, cmap="YlOrRd", vmin=0, vmax=1)
            points.set(edgecolor="0.3", linewidth=0.5)
        bar = plotting.style.figure_of(ax).colorbar(points, ax=ax, fraction=0.04, pad=0.02)
        bar.set_label(f"share of runs beyond 0.4 $d_0$\nat {SHOWN:g} g on rock [-]", fontsize=9)
        marks = [Line2D([], [], marker=mark, linestyle="", color="white", markeredgecolor="0.3") for mark in "os"]
        ax.legend(marks, ["no tie", "tie"], fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), ncols=2, frameon=False)
        ax.set(aspect="equal", xlabel="x [m]", ylabel="y, northwards [m]", xlim=(0, 830), ylim=(0, 500))
        return ax


def draw_curves(ax: Axes, fits: Mapping[str, tuple[mr.Fragility, mr.Fragility]], which: int) -> Axes:
    """Both states of all walls over the peak acceleration, which is 0, or the peak velocity, which is 1."""
    if which == 0:
        ends = min(PUBLISHED.values()), max(PUBLISHED.values())
        ax.axvspan(*ends, color="0.8", linewidth=0)
        ax.text(ends[1] + 0.02, 0.8, "medians of D2,\nwhole buildings,\nclass A", fontsize=8, va="center", color="0.3")
    for name in list(fits)[:2]:
        plotting.fragility(ax, fits[name][which], solver=name, unit=("g", "m/s")[which])
    ax.set(xlabel=f"peak {('acceleration', 'velocity')[which]} at the wall [{('g', 'm/s')[which]}]", xlim=(0, 1.2))
    ax.set_ylabel("share of walls [-]" if which == 0 else "")
    look: dict[str, Any] = {"fontsize": 8, "title_fontsize": 8, "frameon": False, "alignment": "left"}
    ax.legend(title="median, dispersion", loc="lower left", bbox_to_anchor=(0, 1), **look)
    return ax


def finish(out: Path, town: Town, sentences: Sequence[str]) -> None:
    """Fit, draw and print."""
    fits = town.fits()
    figure = Figure(figsize=(7.4, 7.6), layout="constrained")
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.15, 1.0))
    town.draw(parts[0].subplots())
    for which, ax in enumerate(parts[1].subplots(1, 2)):
        draw_curves(ax, fits, which)
    plotting.save(figure, out / "town.png")
    header, cells = ["walls"], [[name.replace("$", "")] for name in fits]
    for which, unit in enumerate(("PGA [g]", "PGV [m/s]")):
        header += [f"median {unit}", "90 % interval", "dispersion"]
        for row, both in zip(cells, fits.values(), strict=True):
            low, high = both[which].median_interval()
            row += [f"{both[which].median:.2f}", f"{low:.2f} to {high:.2f}", f"{both[which].dispersion:.2f}"]
    lines = [f"{name}, D2 of whole buildings of class A: median {median:.2f} g" for name, median in PUBLISHED.items()]
    cli.report(out / "town", "\n".join([*sentences, cli.table(header, cells), *town.lines(), *lines]))
    names = ["wall", "record", "polarity", "outcome"]
    here = [row for row in town.rows if row["level"] == SHOWN]
    kept = [[*(row[name] for name in names), f"{float(row['peak_over_overturning'] or 0):.4f}"] for row in here]
    cli.write_text(out / "town.csv", cli.csv_text([*names, "peak_over_overturning"], kept))


def main(argv: Sequence[str] | None = None) -> None:
    """Draw the walls, run them, kill and resume, fit, draw and print."""
    made = cli.parser(__doc__, "town")
    made.add_argument("--workers", type=int, help="processes; else one for each processor")
    made.add_argument("--dask", action="store_true", help="run on two workers of Dask")
    made.add_argument("--only-run", action="store_true", help="end after the campaign")
    args = made.parse_args(argv)
    out = cli.folder(args.out)
    table = cli.csv_text(COLUMNS, drawn(count=10 if args.quick else 200))
    with cli.write_text(out / "town_walls.csv", table).open(newline="", encoding="utf-8") as file:
        walls = {row["id"]: row for row in csv.DictReader(file)}
    grid, store, sentences = grid_of(walls, 5 if args.quick else 6), out / "town.sqlite", list[str]()
    if not (args.only_run or store.exists()):
        options = ["--quick"] * args.quick + (["--workers", str(args.workers)] if args.workers else [])
        count = killed(out, len(grid) // 4, options)
        sentences.append(
            f"killed with SIGKILL at {count} of {len(grid)} rows; the same call kept them and ran the others"
        )
    with executor_of(args.dask) as executor:
        rows = completed(grid, store, executor=executor, workers=args.workers)
    if not args.only_run:
        finish(out, Town(walls, rows), sentences)


if __name__ == "__main__":
    sys.exit(cli.run(main))
