"""How hard friction has to hold the base: MuJoCo's friction coefficient and row inertia against the no-slip limit.

Prints the first two rebounds of the Figure 3 wall in MuJoCo beside `solve_compliant`, whose base cannot slip.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from tqdm import tqdm

import mjrock as mr
from mjrock.method import METHOD
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, K_N


def main(argv: Sequence[str] | None = None) -> None:
    """Vary the coefficient of friction, the inertia of its row and the step, and print the table."""
    args = cli.parser(__doc__, "friction").parse_args(argv)
    out = cli.folder(args.out)
    steps = (1e-4,) if args.quick else (1e-5, 1e-4)
    e = mr.Restitution.from_geometry(FIGURE_3.alpha)
    contacts = mr.Contacts.from_law(FIGURE_3, e, k_base=K_N, k_side=K_N, law="PUBLISHED")
    one_sided = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 1.6)
    two_sided = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 3.0, side_stop=False)
    limits = [mr.solve_compliant(case, contacts) for case in (two_sided, one_sided)]
    variants = [(mu, METHOD.held_masses) for mu in (1.0, 3.0, 10.0, 30.0, 100.0)]
    variants += [(METHOD.held_friction, masses) for masses in (1e1, 1e2, 1e4)]
    rows: list[list[object]] = [
        ["no slip", "", "SciPy", *(f"{r:.4f}" for limit in limits for r in limit.restitution[:2])]
    ]
    for step in steps:
        for mu, masses in tqdm(variants, desc=f"step {step:g} s", disable=None, leave=False):
            method = METHOD._replace(held_friction=mu, held_masses=masses)
            runs = [mr.simulate(case, contacts, step, method=method) for case in (two_sided, one_sided)]
            rows.append([mu, masses, step * 1e3, *(f"{r:.4f}" for run in runs for r in run.restitution[:2])])
    header = ["mu [-]", "row inertia [m]", "step [ms]", "2s e_1", "2s e_2", "1s e_1", "1s e_2"]
    cli.report(out / "friction", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
