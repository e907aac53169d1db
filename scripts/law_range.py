"""How far the published law carries over to this contact model, across the ranges it was fitted over.

Prints the restitution of the first impact in MuJoCo beside the one that theory wants, for corner lines, R = 2.1 m and a
release at alpha/2.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

from tqdm import tqdm

import cli
import mjrock as mr


def main(argv: Sequence[str] | None = None) -> None:
    """Run the grid and print the table."""
    args = cli.parser(__doc__, "law_range").parse_args(argv)
    out = cli.folder(args.out)
    grid = [(slenderness, k) for slenderness in (4, 7, 10, 15) for k in (5e7, 5e8, 3e9)]
    rows: list[list[object]] = []
    for slenderness, k in tqdm(grid[:2] if args.quick else grid, disable=None, leave=False):
        alpha = math.atan(1 / slenderness)
        wall = mr.Block(b=2.1 * math.sin(alpha), h=2.1 * math.cos(alpha))
        e = mr.Restitution.from_geometry(wall.alpha)
        contacts = mr.Contacts.from_law(wall, e, k_base=k, k_side=k)
        found = []
        for side_stop in (False, True):
            case = mr.Case(wall, 0.5 * alpha, 2.5, side_stop=side_stop)
            found.append(mr.simulate(case, contacts, accuracy=1e-4).impacts[0].restitution)
        rows.append(
            [slenderness, f"{k:.0e}", f"{e.base:.3f}", f"{found[0]:.3f}", f"{abs(e.lumped):.3f}", f"{found[1]:.3f}"]
        )
    text = cli.table(["h/b", "k_n [N/m3]", "e_2s theory", "e_2s MuJoCo", "|e_1s| theory", "|e_1s| MuJoCo"], rows)
    cli.write(out / "law_range.txt", text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
