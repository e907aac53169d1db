"""A façade with a tie, a thrust and openings under one earthquake: rocking theory and MuJoCo side by side.

Draws the ground acceleration, the rotation in both solvers and the force of the tie. Prints how far the two are apart
on the base of the picture and on stiffer ones: what is left on a stiff base is not the compliance.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from scripts.shared import cli, suite

WALL = mr.Block.from_size(
    thickness=0.65,
    height=9.0,
    length=6.0,
    density=1600.0,
    openings=(mr.Opening(1.2, 2.2), mr.Opening(1.0, 1.5, sill=4.0)),
)
TIE = mr.Tie(height=7.0, stiffness=8e6, slack=0.005, strength=20e3)
THRUST = mr.Thrust(height=7.0, force=4e3)
PGA = 0.4
"""Peak of the picture's ground motion [g]."""
STIFFNESSES = (5e8, 3e9, 3e10, 3e11)
"""Of base and side [N/m3]; the first is that of the picture."""


def contacts_on(k_n: float) -> mr.Contacts:
    """Contacts with the calibrated damping. The stiffest bases lie beyond the range of its fit."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if k_n > 30e8 else "error", UserWarning)
        return mr.Contacts.from_law(WALL, mr.Restitution.from_geometry(WALL), k_base=k_n, k_side=k_n)


def drawn(theory: mr.Response, engine: mr.Response) -> Figure:
    """Ground acceleration, rotation and tie force over time, as long as the wall moves."""
    figure = plotting.history([theory, engine])
    moving = np.flatnonzero(np.abs(theory.theta) > suite.STILL * WALL.alpha)
    figure.axes[0].set_xlim(0, theory.t[moving[-1]] + 3 if moving.size else None)
    return figure


def apart(theory: mr.Response, engine: mr.Response) -> list[str]:
    """Peaks over alpha, plastic elongations [mm], and the RMS distance of the rotations over alpha [-]."""
    both = (theory, engine)
    peaks = [float(np.abs(one.theta).max()) / WALL.alpha for one in both]
    plastic = [1e3 * one.plastic["tie_0"].elongation for one in both]
    t = theory.t[theory.t <= engine.t[-1]]
    gap = np.interp(t, theory.t, theory.theta) - np.interp(t, engine.t, engine.theta)
    rms = float(np.sqrt(np.mean(gap**2))) / WALL.alpha
    ratio = f"{peaks[1] / peaks[0] - 1:+.1%}"
    return [*(f"{x:.3f}" for x in peaks), ratio, *(f"{x:.0f}" for x in plastic), f"{rms:.4f}"]


def main(argv: Sequence[str] | None = None) -> None:
    """Solve both ways, draw and print."""
    options = suite.parser(__doc__, "facade")
    options.add_argument("--pga", type=float, default=PGA, help="peak of the ground motion [g]")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    rows = []
    for number, record in enumerate(suite.motions(args, 1, quick=1)):
        motion = suite.to_peak(record, args.pga)
        case = mr.Case(WALL, 0.0, motion.duration, motion=motion, effects=(TIE, THRUST))
        theory = mr.solve_analytical(case, mr.Restitution.from_geometry(WALL), rtol=1e-8)
        for k_n in STIFFNESSES[: 2 if args.quick else None]:
            engine = mr.simulate(case, contacts_on(k_n))
            rows.append([motion.name.split("*")[0].strip()[:30], f"{k_n:.0e}", *apart(theory, engine)])
            if k_n == STIFFNESSES[0] and number == 0:
                plotting.save(drawn(theory, engine), out / "facade.png")
    header = ["motion", "k_n [N/m3]", "peak, theory", "MuJoCo", "apart", "plastic, theory [mm]", "MuJoCo", "RMS"]
    cli.report(out / "facade", cli.table(header, rows))


if __name__ == "__main__":
    sys.exit(cli.run(main))
