"""The paper's Figure 3, one-sided and two-sided: rocking theory, MuJoCo, and the same contact law solved by SciPy.

Writes figure3_one_sided.png, figure3_two_sided.png, figure3.csv and prints the restitution of every rebound.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.style import below_figure
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, FIGURE_3_XI, K_N

SHOWN = {"one-sided": 2.0, "two-sided": 6.0}
"""What is drawn of each case [s]: after it the one-sided wall is at rest."""


def drawn(panels: dict[str, list[mr.Response]]) -> Figure:
    """Rotation above and energy below, a column a case."""
    figure = Figure(figsize=(7.4, 4.8), layout="constrained")
    axes = figure.subplots(2, len(panels), sharex="col")
    for (above, below), (label, responses) in zip(axes.T, panels.items(), strict=True):
        plotting.rotation(above, responses).set(title=label, xlabel="")
        plotting.energy(below, responses)
        below.set_xlim(0, SHOWN[label])
    for ax in axes[:, 1]:
        ax.set_ylabel("")
    below_figure(figure, axes[0, 0])
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run both cases at several steps, write and print."""
    args = cli.parser(__doc__, "figure3").parse_args(argv)
    out = cli.folder(args.out)
    steps = (1e-3,) if args.quick else (None, 1e-4, 1e-3)
    e = mr.Restitution.from_geometry(FIGURE_3.alpha)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N, law="PUBLISHED")
    xi = mr.PUBLISHED(FIGURE_3, e, K_N)
    for name, value, printed in zip(("xi_b", "xi_s"), xi, FIGURE_3_XI, strict=True):
        print(f"{name} = {value:.3%} by the law, {printed:.2%} as printed")

    rows: list[list[object]] = []
    panels: dict[str, list[mr.Response]] = {}
    for label, side_stop, duration in (("one_sided", True, 3.0), ("two_sided", False, 6.0)):
        case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, duration, side_stop=side_stop)
        theory = mr.solve_analytical(case, e)
        law = mr.solve_compliant(case, contacts)
        runs = [mr.simulate(case, contacts, step) for step in tqdm(steps, desc=label, disable=None, leave=False)]
        panels[label.replace("_", "-")] = [theory, runs[0], law]
        for response in (theory, law, *runs):
            step = response.stats.get("timestep")
            rms = [mr.compare(reference, response).rms for reference in (theory, law)]
            rebounds = np.append(response.restitution, np.full(4, np.nan))[:4]
            row = [label, response.solver, f"{step * 1e3:.3g}" if step else "-"]
            rows.append([*row, *(f"{r:.4f}" for r in rebounds), *(f"{r:.5f}" for r in rms)])
    header = ["case", "solver", "step [ms]", *(f"e_{i}" for i in (1, 2, 3, 4))]
    header += ["RMS/alpha to theory", "RMS/alpha to contact law"]
    plotting.save(drawn(panels), out / "figure3.png")
    cli.write_text(out / "figure3.csv", cli.csv_text(header, rows))
    print(cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
