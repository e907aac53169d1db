"""What the contact layout and the reading of the reference frequency do to the restitution, on the Figure 3 wall.

Prints the first rebound by `solve_compliant` for corner lines and beds, with the damping ratios of the published law
referred to the full-contact rocking mode (`mjrock.reference_frequency`) and to the vertical bounce.
"""

from __future__ import annotations

import dataclasses
import math
import sys
from collections.abc import Sequence

from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli
from scripts.shared.paper import FIGURE_3, K_N


def main(argv: Sequence[str] | None = None) -> None:
    """Solve every combination and print the table."""
    options = cli.parser(__doc__, "layouts")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    wall = FIGURE_3
    e = mr.Restitution.from_geometry(wall.alpha)
    bounce = math.sqrt(K_N * 2 * wall.b * wall.length / wall.mass)
    rows: list[list[object]] = []
    for points in tqdm((2,) if args.quick else (2, 4, 8, 32), desc="layouts", disable=None, leave=False):
        made = mr.Contacts.from_law(wall, e, k_base=K_N, k_side=K_N, law="PUBLISHED", points=points)
        for mode, omega in (("rocking in full contact", made.base.frequency), ("vertical bounce", bounce)):
            assert made.side is not None
            contacts = dataclasses.replace(
                made,
                base=dataclasses.replace(made.base, frequency=omega),
                side=dataclasses.replace(made.side, frequency=omega),
            )
            rebounds = []
            for side_stop in (False, True):
                case = mr.Case(wall, 0.5 * wall.alpha, duration=2.5, side_stop=side_stop)
                rebounds.append(mr.solve_compliant(case, contacts).restitution[0])
            rows.append([points, mode, f"{omega:.1f}", *(f"{r:.3f}" for r in rebounds)])
    header = ["lines", "omega of", "omega [rad/s]", f"e_2s ({e.base:.3f})", f"|e_1s| ({abs(e.lumped):.3f})"]
    cli.report(out / "layouts", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
