"""The order of convergence of `simulate` in the step, on a wall that vibrates on its base without lifting an edge.

Where edges lift, the touch that falls somewhere inside a step scatters the error and hides the order. Writes
convergence.png and prints the errors and the fitted orders for several Newmark beta.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

import cli
import mjrock as mr
from mjrock import plotting
from paper import FIGURE_3, K_N

BETAS = {"beta = 0": 0.0, "beta = 1/12": 1 / 12, "beta = 1/4 (default)": 0.25, "beta = 1": 1.0}


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


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "convergence").parse_args(argv)
    out = cli.folder(args.out)
    steps = [4e-3, 2e-3, 1e-3] if args.quick else [6e-3, 4e-3, 3e-3, 2e-3, 1.5e-3, 1e-3]
    found = {name: errors(steps, beta) for name, beta in tqdm(BETAS.items(), disable=None, leave=False)}
    figure = plotting.single(lambda ax: plotting.convergence(ax, steps, found, order=2))
    figure.axes[0].set_ylabel(r"largest error of $\theta$ / release [-]")
    plotting.save(figure, out / "convergence.png")
    rows = [[name, *(f"{e:.2e}" for e in values), f"{order(steps, values):.2f}"] for name, values in found.items()]
    text = cli.table(["step [ms]", *(f"{h * 1e3:g}" for h in steps), "order"], rows)
    cli.write(out / "convergence.txt", text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
