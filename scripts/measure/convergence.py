"""The order of convergence of `simulate` in the step, on a wall that vibrates on its base without lifting an edge.

Where edges lift, the touch that falls somewhere inside a step scatters the error and hides the order. Writes
convergence.png and prints the errors and the fitted orders for several Newmark beta, and how much |e| scatters with the
phase of the touch, on walls of Table 1 with the calibrated damping.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.study.matching.match import combinations
from scripts.shared import accuracy, cli
from scripts.shared.paper import FIGURE_3, K_N

BETAS = {r"$\beta$ = 0": 0.0, r"$\beta$ = 1/12": 1 / 12, r"$\beta$ = 1/4, default": 0.25, r"$\beta$ = 1": 1.0}
"""Newmark's beta by its name in the figure."""

RESOLVED = (0.063, 0.1, 0.2, 0.4, 0.8)
"""Fixed steps times the highest contact frequency [-]; the first is the sound step."""
SEED = 77
"""Of the walls whose |e| scatters."""


def errors(steps: Sequence[float], newmark_beta: float) -> list[float]:
    """Largest error of the rotation over 0.6 s, as a share of the release, of `simulate` against `solve_compliant`."""
    wall = FIGURE_3
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.02)
    theta0 = 0.4 * contacts.uplift_rotation(wall)
    case = mr.Case(wall, theta0, duration=0.6, side_stop=False)
    exact = mr.solve_compliant(case, contacts, rtol=1e-11, atol=1e-14, output_step=2.5e-4)
    found = []
    for step in steps:
        run = mr.simulate(case, contacts, step, newmark_beta=newmark_beta)
        found.append(float(np.abs(np.interp(run.t, exact.t, exact.theta) - run.theta).max()) / theta0)
    return found


def order(steps: Sequence[float], found: Sequence[float]) -> float:
    """Slope of the error against the step on logarithmic axes."""
    return float(np.polyfit(np.log(steps), np.log(found), 1)[0])


def scatter(resolved: Sequence[float], walls: int) -> list[list[object]]:
    """Standard deviation of |e| over eight releases at fixed steps of omega h, median and 95 % over walls."""
    lines: list[list[object]] = []
    for side_stop in (True, False):
        spread = np.full((walls, len(resolved)), np.nan)
        for i, one in enumerate(tqdm(combinations(walls, SEED), desc="scatter", disable=None, leave=False)):
            wall = one.wall
            e = mr.Restitution.from_geometry(wall)
            contacts = mr.Contacts.from_law(wall, e, one.k_base, one.k_side if side_stop else None)
            omega = contacts.highest_frequency(wall, side_stop=side_stop)
            for j, share in enumerate(resolved):
                found = [relative(wall, phi, side_stop, contacts, share / omega) for phi in np.linspace(0.45, 0.55, 8)]
                known = np.array(found)[np.isfinite(found)]
                spread[i, j] = known.std() if known.size > 3 else np.nan
        for name, values in (("median", np.nanmedian(spread, 0)), ("95 %", np.nanpercentile(spread, 95, axis=0))):
            sides = "one-sided" if side_stop else "two-sided"
            lines.append([sides, name, *(f"{value:.2%}" for value in values)])
    return lines


def relative(wall: mr.Block, phi: float, side_stop: bool, contacts: mr.Contacts, step: float) -> float:
    """|e| of the first rebound at a fixed step over that of fitted steps; NaN where there is none."""
    case = mr.Case(wall, float(phi) * wall.alpha, 2.9 / wall.p, side_stop=side_stop)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            fitted, fixed = mr.simulate(case, contacts), mr.simulate(case, contacts, step)
        except mr.SimulationError:
            return math.nan
    return float(fixed.restitution[0] / fitted.restitution[0]) if len(fixed.peaks) * len(fitted.peaks) > 1 else math.nan


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "convergence").parse_args(argv)
    out = cli.folder(args.out)
    steps = [4e-3, 2e-3, 1e-3] if args.quick else [6e-3, 4e-3, 3e-3, 2e-3, 1.5e-3, 1e-3]
    found = {name: errors(steps, beta) for name, beta in tqdm(BETAS.items(), disable=None, leave=False)}
    figure = plotting.single(lambda ax: accuracy.convergence(ax, steps, found, order=2), (6.4, 3.6))
    figure.axes[0].set_ylabel(r"largest error of $\theta$ / release [-]")
    plotting.save(figure, out / "convergence.png")
    rows = [
        [name.replace("$\\beta$", "beta"), *(f"{e:.2e}" for e in values), f"{order(steps, values):.2f}"]
        for name, values in found.items()
    ]
    text = cli.table(["step [ms]", *(f"{h * 1e3:g}" for h in steps), "order"], rows)
    resolved = RESOLVED[1:3] if args.quick else RESOLVED
    lines = scatter(resolved, 1 if args.quick else 24)
    text += "\n\nscatter of |e| at a fixed step\n" + cli.table(["walls", "omega h", *map(str, resolved)], lines)
    cli.report(out / "convergence", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
