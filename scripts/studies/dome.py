"""The least thickness of a hemispherical dome: by limit analysis, and by explicit steps while gravity grows.

The dome has a radius of 5 m to the middle of its thickness, and mu = 0.9. Heyman found a least thickness of 0.042 of
the radius for a smooth membrane of any number of lunes. Limit analysis says from which thickness blocks of the given
number stand. In explicit steps the dome starts unloaded as drawn: the ground falls with g at the start and comes to
rest along a cosine within 0.6 s. It has fallen when a block has sunk by 50 mm within 2 s. Thicknesses are steps of
0.0005 of the radius, and the least that stands is found by bisection. k_s = k_n, xi = 0.01.
The dome of `models/dome` then stands in MuJoCo from its pose of rest, and how far its blocks move is printed.
Writes dome.csv, .png and .txt.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.problem.masonry.limit.statics import falling
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.at_times import at_times
from scripts.shared.models_in_space import IN_SPACE

RADIUS, FRICTION, XI = 5.0, 0.9, 0.01
STEP = 0.0005
"""Spacing of the thicknesses, over the radius [-]."""
LEAST, MOST = 0.039, 0.047
"""Thicknesses that surely fall and stand, over the radius [-]."""
FACETS = ((12, 9), (16, 14))
"""Lunes and hoops."""
STIFFNESSES = (1e9, 1e10)
"""k_n of the joints [N/m3]."""
RAMP, DURATION = 0.6, 2.0
"""Time in which gravity grows, and time that is followed [s]."""
STILL = 0.2
"""Time in which the dome of the models folder stands [s]."""
SUNK, SHOWN = 0.05, 0.6
"""How far a block sinks that falls, and how far it has sunk in the picture [m]."""


def dome(share: float, facets: tuple[int, int], k_n: float) -> mr.Masonry:
    """A dome with a thickness of a share of its radius."""
    return mr.Masonry.dome(RADIUS, share * RADIUS, *facets, k_n=k_n, k_s=k_n, friction=FRICTION, xi=XI)


def growing(masonry: mr.Masonry) -> mr.Response:
    """The dome while gravity grows, from blocks that no force has pressed on one another."""
    t = np.linspace(0.0, DURATION, 2001)
    falls = -mr.GRAVITY * (0.5 + 0.5 * np.cos(np.pi * np.minimum(t / RAMP, 1.0)))
    case = mr.MasonryCase(masonry, DURATION, vertical=mr.GroundMotion(falls, float(t[1])), settled=False)
    return mr.solve_explicit(case, output_step=0.01)


def sunk(answer: mr.Response) -> Array:
    """How far the block that has sunk the most has done so at each sample [m]."""
    return np.asarray(-answer.pose[:, :, 2].min(axis=1))


def stands(facets: tuple[int, int], k_n: float, share: float) -> bool:
    """Whether a dome stands in explicit steps."""
    return bool(sunk(growing(dome(share, facets, k_n))).max() < SUNK)


def stands_rigid(facets: tuple[int, int], share: float) -> bool:
    """Whether a dome stands by limit analysis."""
    return not falling(dome(share, facets, STIFFNESSES[-1]))


def least(stands: Callable[[float], bool]) -> float:
    """The least thickness that stands, over the radius [-]."""
    low, high = round(LEAST / STEP), round(MOST / STEP)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if stands(middle * STEP) else (middle, high)
    return high * STEP


def crept() -> str:
    """How far the dome of the models folder moves in MuJoCo where nothing shakes it."""
    model = next(model for model in IN_SPACE if model.name == "dome")
    still = mr.simulate(mr.MasonryCase(model.case.masonry, STILL), timestep=model.timestep)
    place = still.pose[:, :, :3]
    return (
        f"the dome of models/dome at rest in MuJoCo, steps of {1e3 * model.timestep:g} ms: sunk by "
        f"{1e3 * np.abs(place[0]).max():.2f} mm, moves by up to {1e6 * np.abs(place - place[0]).max():.1g} um "
        f"in {STILL:g} s"
    )


def drawn(answer: mr.Response) -> Figure:
    """The dome at rest, as it falls and at the end."""
    far = sunk(answer)
    moment = int(np.argmax(far > SHOWN)) if far.max() > SHOWN else len(far) - 1
    words = {"as drawn": 0, "rings open": moment, "at the end": len(answer.t) - 1}
    return at_times(answer, words, camera=(28.0, 35.0))


def main(argv: Sequence[str] | None = None) -> None:
    """Find the least thicknesses, draw and print."""
    args = cli.parser(__doc__, "dome").parse_args(argv)
    out = cli.folder(args.out)
    header = ["lunes", "hoops", "limit analysis", *(f"explicit, k_n = {k_n:.0e} N/m3" for k_n in STIFFNESSES)]
    rows: list[list[object]] = []
    standing = []
    if args.quick:
        masonry = dome(0.03, (6, 4), 1e9)
        rows.append([6, 4, "falls at 0.03" if falling(masonry) else "stands at 0.03", "", ""])
    else:
        for facets in FACETS:
            row: list[object] = [*facets, f"{least(partial(stands_rigid, facets)):.4f}"]
            for k_n in STIFFNESSES:
                row.append(f"{least(partial(stands, facets, k_n)):.4f}")
                drop = 1e3 * sunk(growing(dome(float(str(row[-1])), facets, k_n))).max()
                standing.append(f"{facets[0]} x {facets[1]}, k_n = {k_n:.0e} N/m3: {drop:.2f} mm")
            rows.append(row)
        masonry = dome(0.041, FACETS[-1], STIFFNESSES[-1])
    answer = growing(masonry)
    plotting.save(drawn(answer), out / "dome.png")
    text = f"least thickness that stands over the radius, in steps of {STEP:g}; Heyman: 0.042\n" + cli.table(
        header, rows
    )
    if standing:
        text += "\nthe lowest block of the thinnest that stands sinks by, at most:\n" + "\n".join(standing)
        text += f"\n\n{crept()}"
    cli.report(out / "dome", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
