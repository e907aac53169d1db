"""The paper's Table 2: damping ratios of the six specimens, and their rocking with the measured restitution.

Writes table2.png, table2.csv and prints both. The experimental time histories are not public as numbers: what is
compared with MuJoCo is the event-driven solution with the measured e_1s. Release at alpha/2 and density are assumed.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Sequence

from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli
from scripts.shared.paper import K_N, TABLE_2

LINES = "theory, measured restitution", "published law in MuJoCo", "calibrated law in MuJoCo"
"""Lines of a panel."""


def main(argv: Sequence[str] | None = None) -> None:
    """Run the six specimens, write and print."""
    args = cli.parser(__doc__, "table2").parse_args(argv)
    out = cli.folder(args.out)
    rows: list[list[object]] = []
    panels = []
    notes: list[str] = []
    for specimen in tqdm(TABLE_2, desc="specimens", disable=None, leave=False):
        wall, e = specimen.block, specimen.restitution
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            contacts = mr.Contacts.from_law(wall, e, k_base=K_N, k_side=K_N, law="PUBLISHED")
        notes += [f"{specimen.name}: {warning.message}" for warning in caught]
        assert contacts.side is not None
        case = mr.Case(wall, theta0=0.5 * wall.alpha, duration=0.5 if args.quick else 1.2)
        theory = mr.solve_analytical(case, e)
        run = mr.simulate(case, contacts)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            calibrated = mr.simulate(case, mr.Contacts.from_law(wall, e, k_base=K_N, k_side=K_N))
        title = f"{specimen.name.partition(',')[0]}, {specimen.height:.2f} m high\n$|e_{{1s}}|$ measured"
        panels.append((f"{title} {-specimen.lumped:.2f}", [theory, run, calibrated]))
        comparison = mr.compare(theory, run)
        rows.append(
            [
                specimen.name,
                f"{contacts.base.xi:.2%}",
                f"{specimen.xi_base:.2%}",
                f"{contacts.side.xi:.3%}",
                f"{specimen.xi_side:.2%}",
                f"{contacts.side.xi / specimen.xi_side - 1:+.1%}",
                f"{specimen.lumped:.3f}",
                f"{-run.impacts[0].restitution:.3f}" if run.impacts else "-",
                len(run.restitution),
                *("-" if math.isnan(peak) else f"{peak:.4f}" for peak in comparison.first_rebound_peak),
                f"{contacts.uplift_rotation(wall) / wall.alpha:.4f}",
                f"{comparison.rms:.4f}",
            ]
        )
    header = [
        "specimen", "xi_b Eq. 5", "xi_b printed", "xi_s Eq. 6", "xi_s printed", "xi_s difference",
        "e_1s measured", "e_1s MuJoCo", "rebounds MuJoCo", "peak/alpha theory", "peak/alpha MuJoCo",
        "uplift/alpha", "RMS/alpha",
    ]  # fmt: skip
    cli.write_text(out / "table2.csv", cli.csv_text(header, rows))
    figure = plotting.grid(panels, top=0.12, labels=LINES)
    for ax in figure.axes:
        ax.set_xlim(0, 0.5 if args.quick else 0.85)
    plotting.save(figure, out / "table2.png")
    print(cli.table(header, rows))
    print("\n" + "\n".join(notes))


if __name__ == "__main__":
    sys.exit(cli.run(main))
