"""Rock one wall in MuJoCo beside classical rocking theory: the energy lost at every impact.

Writes scene.xml (the model that ran), comparison.png and comparison.csv, and prints the table.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.plotting.wall import section
from scripts.shared import cli
from scripts.shared.labels import beside

LAWS = {"published": mr.PUBLISHED, "calibrated": mr.CALIBRATED, "calibrated-bed": mr.CALIBRATED_BED}


def law(name: str | None, points: int) -> mr.DampingLaw:
    """The law of a name, of a file, or the one that was calibrated for a layout."""
    if name is None:
        return mr.CALIBRATED if points == 2 else mr.CALIBRATED_BED
    if name not in LAWS and not name.endswith(".toml"):
        raise ValueError(f"law = {name!r} is not one of {', '.join(LAWS)} and not a .toml file")
    return LAWS[name] if name in LAWS else mr.DampingLaw.load(name)


STEP = 0.05
"""Least step of the energy that is marked, over the first energy [-]."""


def drawn(case: mr.Case, responses: Sequence[mr.Response], title: str) -> Figure:
    """Rotation and energy until the wall is at rest, |e| at the steps of the energy, and the wall."""
    figure = plotting.comparison(responses, title)
    above, below = figure.axes
    theory = responses[0]
    assert theory.rocking is not None
    moving = np.flatnonzero(np.abs(theory.theta) > 1e-3 * theory.of_wall[0].wall.alpha)
    below.set_xlim(0, min(theory.t[-1], 1.3 * theory.t[moving[-1]]))
    for impact in theory.impacts:
        if impact.energy_before > STEP * theory.energy[0]:
            at = impact.t, 0.5e-3 * (impact.energy_before + impact.energy_after)
            beside(below, at, f"$|e|$ = {abs(impact.restitution):.2f}", "0.2", (6, 0))
    inset = above.inset_axes((0.72, 0.16, 0.28, 0.82))
    section(inset, case)
    inset.axis("off")
    return figure


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

    reference = mr.solve_analytical(case, e)
    candidate = mr.simulate(case, contacts, args.timestep, accuracy=args.accuracy)
    comparison = mr.compare(reference, candidate)
    responses = [reference, candidate]  # the last is drawn on top
    if args.check:
        responses.append(mr.solve_compliant(case, contacts))

    step = candidate.stats["timestep"]
    cli.write_text(out / "scene.xml", mr.wall_mjcf(case, contacts, step))
    cli.write_text(out / "comparison.csv", comparison.csv())
    title = f"2h = {2 * wall.h:g} m, 2b = {2 * wall.b:g} m, {'one' if case.side_stop else 'two'}-sided"
    plotting.save(drawn(case, responses, title), out / "comparison.png")

    side = f", side {contacts.side.xi:.2%} (e = {e.side:.3f})" if contacts.side else ""
    print(
        f"wall {2 * wall.b:g} x {2 * wall.h:g} x {wall.length:g} m, "
        f"alpha = {wall.alpha:.4f} rad, p = {wall.p:.3f} rad/s"
    )
    print(f"damping ratios by {contacts.law}: base {contacts.base.xi:.2%} (e = {e.base:.3f}){side}")
    stats = candidate.stats
    steps = f"{step * 1e3:.3g} ms" if args.timestep else f"{step * 1e3:.3g} to {stats['longest_timestep'] * 1e3:.3g} ms"
    print(f"MuJoCo: {stats['steps']} steps of {steps} in {stats['wall_time']:.3f} s\n")
    print(comparison.table())
    if args.check:
        print("\nThe same contact law solved by SciPy, against MuJoCo:\n")
        print(mr.compare(responses[2], candidate).table())
    print(f"\nwritten: {', '.join(str(out / name) for name in ('scene.xml', 'comparison.png', 'comparison.csv'))}")


if __name__ == "__main__":
    sys.exit(cli.run(main))
