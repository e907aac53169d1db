"""How far the published law carries over to this contact model, and the calibrated one, over the ranges of Table 1.

Prints the restitution of the first rebound in MuJoCo beside the one that theory wants, for corner lines, R = 2.1 m and
a release at alpha/2; a dash where the wall does not rebound beyond the rotation at which an edge lifts.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli


def main(argv: Sequence[str] | None = None) -> None:
    """Run the grid and print the table."""
    args = cli.parser(__doc__, "law_range").parse_args(argv)
    out = cli.folder(args.out)
    grid = [(slenderness, k) for slenderness in (4, 7, 10, 15) for k in (5e7, 5e8, 3e9)]
    rows: list[list[object]] = []
    for slenderness, k in tqdm(grid[:2] if args.quick else grid, disable=None, leave=False):
        wall = mr.Block.from_slenderness(slenderness, 2.1)
        e = mr.Restitution.from_geometry(wall.alpha)
        wanted = {False: e.base, True: abs(e.lumped)}
        row: list[object] = [slenderness, f"{k:.0e}"]
        for side_stop, theory in wanted.items():
            row.append(f"{theory:.3f}")
            for law in (mr.PUBLISHED, mr.CALIBRATED):
                contacts = mr.Contacts.from_law(wall, e, k_base=k, k_side=k, law=law)
                case = mr.Case(wall, 0.5 * wall.alpha, 2.5, side_stop=side_stop)
                found = mr.simulate(case, contacts, accuracy=1e-4).restitution
                row.append(f"{found[0]:.3f}" if len(found) else "-")
        rows.append(row)
    laws = (mr.PUBLISHED.name, mr.CALIBRATED.name)
    header = ["h/b", "k_n [N/m3]", "e_2s theory", *laws, "|e_1s| theory", *laws]
    cli.report(out / "law_range", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
