"""Rock one wall in MuJoCo beside classical rocking theory: the energy lost at every impact.

It is `mjrock demo` with options: it writes scene.xml (the model that ran), comparison.png and comparison.csv, and
prints the table.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import mjrock as mr
from mjrock.commands import demo
from scripts.shared import cli

LAWS = {"published": mr.PUBLISHED, "calibrated": mr.CALIBRATED, "calibrated-bed": mr.CALIBRATED_BED}


def law(name: str | None, points: int) -> mr.DampingLaw:
    """The law of a name, of a file, or the one that was calibrated for a layout."""
    if name is None:
        return mr.CALIBRATED if points == 2 else mr.CALIBRATED_BED
    if name not in LAWS and not name.endswith(".toml"):
        raise ValueError(f"law = {name!r} is not one of {', '.join(LAWS)} and not a .toml file")
    return LAWS[name] if name in LAWS else mr.DampingLaw.load(name)


def main(argv: Sequence[str] | None = None) -> None:
    """Parse the options, run the solvers, write and print the comparison."""
    options = cli.parser(__doc__, "compare_wall")
    options.add_argument("--thickness", type=float, default=0.6, help="thickness 2b [m]")
    options.add_argument("--height", type=float, default=4.2, help="height 2h [m]")
    options.add_argument("--length", type=float, default=1.0, help="length along the wall [m]")
    options.add_argument("--density", type=float, default=2000.0, help="density [kg/m3]")
    options.add_argument("--k-base", type=float, default=5e8, help="interface stiffness of the base [N/m3]")
    options.add_argument("--k-side", type=float, default=5e8, help="interface stiffness of the side stop [N/m3]")
    options.add_argument("--points", type=int, default=2, help="contact lines on each face; 2 are the corners")
    options.add_argument(
        "--law", help=f"{', '.join(LAWS)}, or a .toml file (default: the calibrated law of the layout)"
    )
    options.add_argument("--release", type=float, default=0.5, help="rotation at release as a share of alpha [-]")
    options.add_argument("--sides", type=int, choices=(1, 2), default=1, help="1: against a side stop; 2: free to both")
    options.add_argument("--duration", type=float, default=3.0, help="time to follow the motion [s]")
    options.add_argument("--timestep", type=float, default=None, help="fixed step [s]; else steps fit the motion")
    options.add_argument("--accuracy", type=float, default=1e-3, help="relative tolerance of fitted steps [-]")
    options.add_argument("--lumped", type=float, default=None, help="measured e_1s, negative [-]; else from geometry")
    options.add_argument("--check", action="store_true", help="solve the contact law with SciPy as well")
    args = options.parse_args(argv)

    wall = mr.Block.from_size(args.thickness, args.height, args.length, args.density)
    if args.lumped is None:
        e = mr.Restitution.from_geometry(wall.alpha)
    else:
        e = mr.Restitution.from_lumped(args.lumped, wall.alpha)
    k_side = args.k_side if args.sides == 1 else None
    chosen = law(args.law, args.points)
    contacts = mr.Contacts.from_law(wall, e, k_base=args.k_base, k_side=k_side, law=chosen, points=args.points)
    duration = min(args.duration, 1.0) if args.quick else args.duration
    case = mr.Case(wall, theta0=args.release * wall.alpha, duration=duration, side_stop=args.sides == 1)
    out = cli.folder(args.out)

    tables = demo.compared(case, e, contacts, out, demo.StepOptions(args.timestep, args.accuracy), check=args.check)
    side = f", side {contacts.side.xi:.2%} (e = {e.side:.3f})" if contacts.side else ""
    print(
        f"wall {2 * wall.b:g} x {2 * wall.h:g} x {wall.length:g} m, "
        f"alpha = {wall.alpha:.4f} rad, p = {wall.p:.3f} rad/s"
    )
    print(f"damping ratios by {contacts.law}: base {contacts.base.xi:.2%} (e = {e.base:.3f}){side}")
    print(tables)


if __name__ == "__main__":
    sys.exit(cli.run(main))
