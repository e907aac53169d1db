"""Does the damping law carry over to contacts that MuJoCo finds itself? Restitution per rebound of plain models.

The wall of Figure 3 against a side stop and free to both sides, at some steps; the six specimens of Table 2, one- and
two-sided; and walls drawn from Table 1. All are compared with `solve_compliant`, which solves the same law with SciPy,
and with the models of contact points at the same step.
Prints the restitution of rebounds, the time of the processor, and how the error goes with omega h, omega the highest
frequency of the closed contacts. Writes plain_models.csv, .png and .txt.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import Look
from scripts.shared import cli, paper

STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)
"""Of the wall of Figure 3 [s]."""
RESOLVED = (0.5, 0.2, 0.1)
"""omega h of the walls of Table 1 [-]."""
WALLS = 30
DOWN, REBOUND = 1.4, 1.4
"""Times in which a wall released at half of its slenderness comes down, and rebounds once, at most, times p [-]."""


@dataclass(frozen=True)
class Released:
    """A wall that is released at half of its slenderness, on the contacts of the law."""

    name: str
    case: mr.Case
    contacts: mr.Contacts
    restitution: mr.Restitution

    @classmethod
    def of(
        cls, name: str, wall: mr.Block, e: mr.Restitution, *, one_sided: bool, k_n: float, rebounds: int
    ) -> Released:
        """The wall against a side stop or on both edges, followed for some rebounds."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of slendernesses at the rim of the fit
            law = mr.Contacts.from_law(wall, e, k_base=k_n, k_side=k_n if one_sided else None)
        duration = (DOWN + REBOUND * rebounds) / wall.p
        return cls(name, mr.Case(wall, 0.5 * wall.alpha, duration, side_stop=one_sided), law, e)

    @property
    def omega(self) -> float:
        """The highest frequency of its closed contacts [rad/s]."""
        return mr.scene_of(self.case, self.contacts).highest_frequency

    def law(self) -> NDArray[np.float64]:
        """What the law loses, by SciPy."""
        return np.abs(mr.solve_compliant(self.case, self.contacts).restitution)

    def theory(self) -> NDArray[np.float64]:
        """What theory loses."""
        return np.abs(mr.solve_analytical(self.case, self.restitution).restitution)

    def run(self, h: float, *, collisions: bool) -> tuple[NDArray[np.float64], float]:
        """What a model at a step loses, and the time of the processor [s]."""
        began = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of steps that are long
            answer = mr.simulate(self.case, self.contacts, timestep=h, output_step=max(h, 2e-4), collisions=collisions)
        return np.abs(answer.restitution), time.process_time() - began


def drawn_walls(count: int) -> list[Released]:
    """Walls of Table 1 against a side stop, which no fit has seen."""
    rng = np.random.default_rng(11)
    made = []
    for i in range(count):
        thickness, slenderness, k_n = rng.uniform(0.4, 1.0), rng.uniform(6.0, 16.0), 10 ** rng.uniform(8.0, 9.5)
        wall = mr.Block.from_size(thickness, thickness * slenderness, density=2000.0)
        e = mr.Restitution.from_geometry(wall)
        made.append(Released.of(f"wall {i}", wall, e, one_sided=True, k_n=k_n, rebounds=1))
    return made


def first(values: NDArray[np.float64]) -> float:
    """The first rebound; NaN where it is too low to be one."""
    return float(values[0]) if len(values) else math.nan


def values_text(values: NDArray[np.float64], count: int = 3) -> str:
    """The first rebounds in words."""
    return " ".join(f"{value:.4f}" for value in values[:count])


def figure_3(lines: list[str], rows: list[list[object]], steps: Sequence[float]) -> list[tuple[float, float, float]]:
    """The wall of Figure 3, one- and two-sided: omega h and errors of both models at the first rebound."""
    errors = []
    for one_sided in (True, False):
        sides = "one-sided" if one_sided else "two-sided"
        e = mr.Restitution.from_geometry(paper.FIGURE_3)
        wall = Released.of("Figure 3", paper.FIGURE_3, e, one_sided=one_sided, k_n=paper.K_N, rebounds=3)
        law = wall.law()
        lines.append(f"Figure 3, {sides}: law {values_text(law)}, theory {values_text(wall.theory())}")
        for h in steps:
            (plain, seconds), (points, took) = (wall.run(h, collisions=given) for given in (True, False))
            lines.append(
                f"  {1e3 * h:4g} ms, omega h {h * wall.omega:.3f}: plain {values_text(plain)} in {seconds:.2f} s, "
                f"contact points {values_text(points)} in {took:.2f} s"
            )
            off = [float(each[0] / law[0] - 1) for each in (plain, points)]
            rows.append([f"Figure 3, {sides}", h, h * wall.omega, law[0], plain[0], points[0]])
            if one_sided:
                errors.append((h * wall.omega, off[0], off[1]))
    return errors


def table_2(lines: list[str], rows: list[list[object]], specimens: Sequence[paper.Specimen], resolved: float) -> None:
    """The specimens of Table 2 at an omega h."""
    lines.append(f"Table 2, |e| of the first rebound at omega h = {resolved:g}: law, plain model, contact points")
    for specimen in tqdm(specimens, desc="Table 2", disable=None, leave=False):
        for one_sided in (True, False):
            wall = Released.of(
                specimen.name, specimen.block, specimen.restitution, one_sided=one_sided, k_n=paper.K_N, rebounds=1
            )
            h, law = resolved / wall.omega, wall.law()
            (plain, _), (points, _) = (wall.run(h, collisions=given) for given in (True, False))
            sides = "one-sided" if one_sided else "two-sided"
            three = first(law), first(plain), first(points)
            lines.append(
                f"  {specimen.name}, {sides}: "
                + " ".join("-" if math.isnan(value) else f"{value:.4f}" for value in three)
            )
            rows.append([f"{specimen.name}, {sides}", h, resolved, *three])


def table_1(
    lines: list[str], rows: list[list[object]], walls: Sequence[Released], every: Sequence[float]
) -> dict[float, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Walls drawn from Table 1: errors of the first rebound of both models, by every omega h."""
    errors = {}
    for resolved in tqdm(every, desc="Table 1", disable=None, leave=False):
        off: list[list[float]] = []
        for wall in walls:
            h, law = resolved / wall.omega, wall.law()
            both = [first(wall.run(h, collisions=given)[0]) for given in (True, False)]
            rows.append([wall.name, h, resolved, first(law), *both])
            off.append([value / first(law) - 1 for value in both])
        plain, points = np.array([pair for pair in off if not np.isnan(pair).any()]).T
        errors[resolved] = (plain, points)
        shares = " and ".join(
            f"{np.median(np.abs(each)):.2%} (median), {np.abs(each).max():.1%} (largest)" for each in (plain, points)
        )
        within = (np.abs(plain) < 0.01).mean()
        lines.append(
            f"{len(plain)} walls of Table 1, omega h = {resolved:g}: plain {shares} for contact points; "
            f"{within:.0%} of the plain ones within 1 %"
        )
    return errors


def picture(
    errors: Sequence[tuple[float, float, float]],
    walls: dict[float, tuple[NDArray[np.float64], NDArray[np.float64]]],
) -> Figure:
    """Errors of |e| at the first rebound against omega h."""
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    ax = figure.subplots()
    for i, (name, solver) in enumerate((("contacts found by MuJoCo", "plain MuJoCo"), ("contact points", "MuJoCo"))):
        colour = plotting.STYLES[solver]["color"]
        at = np.array([each[0] for each in errors])
        off = np.abs([each[1 + i] for each in errors])
        ax.loglog(at, off, ("s--", "o-")[i], color=colour, label=f"{name}: one wall")
        near = np.array(list(walls)) * (0.93, 1.07)[i]
        low, middle, high = np.transpose([np.quantile(np.abs(both[i]), (0.1, 0.5, 0.9)) for both in walls.values()])
        look: Look = {"fmt": "_", "capsize": 4, "elinewidth": 1.5, "markersize": 9}
        label = f"{name}: {len(next(iter(walls.values()))[i])} walls, median and 80 %"
        ax.errorbar(near, middle, (middle - low, high - middle), color=colour, label=label, **look)
    ax.axhline(0.01, color="0.7", linewidth=0.8)
    ax.text(0.99, 0.011, "1 %", transform=ax.get_yaxis_transform(), ha="right", va="bottom", fontsize=9, color="0.3")
    ax.set(xlabel=r"time step times the highest frequency of the closed contacts, $\omega h$ [-]")
    ax.set(ylabel=r"error of $|e|$ at the first rebound [-]", ylim=(3e-4, 2))
    ax.legend(frameon=False, fontsize=9, loc="upper left")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the walls."""
    args = cli.parser(__doc__, "plain_models").parse_args(argv)
    out, lines, rows = cli.folder(args.out), list[str](), list[list[object]]()
    steps, specimens, count, every = (STEPS[:1], 1, 1, RESOLVED[:1]) if args.quick else (STEPS, 6, WALLS, RESOLVED)
    errors = figure_3(lines, rows, steps)
    table_2(lines, rows, paper.TABLE_2[:specimens], every[-1])
    walls = table_1(lines, rows, drawn_walls(count), every)
    header = ["wall", "timestep [s]", "omega h", "|e| of the law", "plain model", "contact points"]
    cli.report(out / "plain_models", "\n".join(lines), header, rows)
    plotting.save(picture(errors, walls), out / "plain_models.png")


if __name__ == "__main__":
    sys.exit(cli.run(main))
