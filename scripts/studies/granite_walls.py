"""Dry granite walls of Vasconcelos (2005), pushed in their plane under a constant load, beside the tests.

The walls are 1.0 x 1.2 x 0.2 m, of blocks of 0.2 x 0.15 m without mortar. A beam stands on the wall and may turn; the
actuator pushes it 1.325 m above the base. The vertical load is taken to come through rollers, so that its line stays
where it is as the beam moves: a plate on rollers, held by an actuator that rests, carries it. Prints a table and draws
the curves over the tests, which are in `tests/records/granite_walls` (stone masonry database of EPFL's EESD group, MIT
licence; Vanin et al. 2017, doi 10.1007/s10518-017-0188-5).

The stiffness of the joints is fitted on WS.175; the other walls are shown with it.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli

RECORDS = Path(__file__).resolve().parents[2] / "tests" / "records" / "granite_walls"
"""The curves of the tests."""
LENGTH, THICK, UNIT, COURSE, COURSES, SPAN = 1.0, 0.2, 0.2, 0.15, 8, 1.325
"""Wall, blocks, courses and height of the push [m]."""
DENSITY, FRICTION = 2040.0, 0.62
"""Of the blocks, from the weight that the source gives [kg/m3], and of the joints [-]."""
ROLLERS = 1e-3
"""Friction of the rollers below the plate [-]: without any it would not stand before it is held."""
BEAM = 500.0
"""Density of beam and plate [kg/m3]: their weight is part of the load."""
STIFFNESS, SHEAR = 9e9, 0.4
"""k_n of the joints, fitted on WS.175 [N/m3], and k_s over k_n."""
POINTS = 8
"""Lines of a joint."""
TURNS = tuple(side * 1e-3 * far for far in (3, 6, 10, 16, 25) for side in (1, -1))
"""Displacements at which the cyclic push turns back [m]."""
JACK = 1e8
"""Stiffness of the actuators [N/m]."""
LOADS = {"WS40": 44.8, "WS100": 104.8, "WS175": 179.8, "WS250": 254.8}
"""Vertical force at the base of each wall, its weight included [kN]."""


class Wall(NamedTuple):
    """A wall with its beam and plate, what loads it, and the actuator that pushes it."""

    masonry: mr.Masonry
    effects: tuple[mr.Load, mr.Actuator]
    jack: mr.Actuator


def rectangle(x: float, z: float, width: float, height: float, density: float, name: str) -> mr.Polygon:
    """A block by its lower left corner [m]."""
    corners = [(x, z), (x + width, z), (x + width, z + height), (x, z + height)]
    return mr.Polygon(corners, density=density, length=THICK, name=name, fixed=name == "floor")


def wall_of(force: float, stiffness: float = STIFFNESS, shear: float = SHEAR) -> Wall:
    """A wall with a vertical force at its base [kN]."""
    blocks = [rectangle(-0.5, -0.2, 2.0, 0.2, DENSITY, "floor")]
    for course in range(COURSES):
        edges = np.arange(0.0, LENGTH + 1e-9, UNIT)
        if course % 2:
            edges = np.concatenate([[0.0], edges[:-1] + UNIT / 2, [LENGTH]])
        for i, (left, right) in enumerate(pairwise(edges)):
            name = f"course_{course}_{i}"
            blocks.append(rectangle(float(left), course * COURSE, float(right - left), COURSE, DENSITY, name))
    top = COURSES * COURSE
    rise = 2 * (SPAN - top)
    blocks.append(rectangle(0.0, top, LENGTH, rise, BEAM, "beam"))
    blocks.append(rectangle(0.4, top + rise, 0.2, 0.1, BEAM, "plate"))

    def friction(joint: mr.Joint) -> float:
        return ROLLERS if "plate" in joint.name else FRICTION

    masonry = mr.Masonry(blocks, k_n=stiffness, k_s=shear * stiffness, friction=friction, xi=0.1, points=POINTS)
    own = sum(block.mass for block in blocks if not block.fixed) * mr.GRAVITY
    number = masonry.names.index("plate")
    load = mr.Load(1e3 * force - own, top + rise, block=number)
    held = mr.Actuator("plate", (0.5, top + rise), 1, None, JACK, damping=1e4)
    return Wall(masonry, (load, held), mr.Actuator("beam", (0.0, SPAN), 1, None, JACK, damping=1e5))


def measured(name: str) -> Array:
    """Displacement [mm] and force [kN] of a test, shape (n, 2)."""
    return np.loadtxt(RECORDS / f"{name}.csv", delimiter=",", skiprows=4, usecols=(0, 1))


def pushed(force: float, to: Sequence[float] = (0.04,), **joints: float) -> tuple[mr.Push, float]:
    """The push of a wall under a vertical force [kN], to displacements [m], and the processor time [s]."""
    wall, begun = wall_of(force, **joints), time.process_time()
    push = mr.push(wall.masonry, wall.jack, to, effects=wall.effects, inertia=0.02)
    return push, time.process_time() - begun


def at(curve: Array, place: float) -> float:
    """Force of a measured or found curve at a displacement on its first way there [kN]."""
    return float(np.interp(place, np.maximum.accumulate(curve[:, 0]), curve[:, 1]))


def curve_of(push: mr.Push) -> Array:
    """Displacement [mm] and force [kN] of a push, shape (n, 2)."""
    return np.column_stack([1e3 * push.displacement, push.force / 1e3])


def at_turn(curve: Array, place: float) -> float:
    """Largest force of an envelope near a displacement [m], with its sign [kN]."""
    near = np.abs(curve[:, 0] - 1e3 * place) < 1.5
    forces = curve[near, 1]
    return float(forces[np.abs(forces).argmax()]) if near.any() else math.nan


def main(argv: Sequence[str] | None = None) -> None:
    """Push the walls, print the table, draw the curves."""
    args = cli.parser(__doc__, "granite_walls").parse_args(argv)
    out = cli.folder(args.out)
    figure = Figure(figsize=(10.5, 4.0), layout="constrained")
    ax, cyclic = figure.subplots(1, 2)
    rows = []
    for i, (name, force) in enumerate(list(LOADS.items())[: 1 if args.quick else None]):
        test = measured(name)
        push, took = pushed(force, (0.002 if args.quick else 0.04,))
        found = curve_of(push)
        peak, top = test[:, 1].max(), found[:, 1].max()
        rises = [(at(test, place), at(found, place)) for place in (2.0, 6.0)]
        told = [f"{a:.1f} / {b:.1f} ({b / a - 1:+.0%})" for a, b in rises]
        share = found[-1, 1] / top
        rows.append(
            (name, force, f"{peak:.1f} / {top:.1f} ({top / peak - 1:+.1%})", *told, f"{share:.2f}", f"{took:.0f}")
        )
        for curve, line in ((test, {"linewidth": 3, "alpha": 0.35}), (found, {"label": f"{name}, {force:g} kN"})):
            ax.plot(*curve.T, color=f"C{i}", **line)
    test = measured("WS1100_cyclic_envelope")
    push, took = pushed(LOADS["WS100"], TURNS[:1] if args.quick else TURNS)
    cyclic.plot(*test.T, "o", color="0.4", markersize=4, label="envelope of WS1.100")
    cyclic.plot(*curve_of(push).T, color="C1", linewidth=0.9, label="found, pushed to and fro")
    for each, title in ((ax, "pushed to 40 mm; tests broad"), (cyclic, "104.8 kN, cyclic")):
        each.set(xlabel="displacement at 1.325 m [mm]", ylabel="horizontal force [kN]", title=title)
        each.legend(frameon=False)
    ax.set(xlim=(0, 45), ylim=(0, None))
    plotting.save(figure, out / "granite_walls.png")
    ends = [
        f"{at_turn(test, turn):.1f} / {at_turn(curve_of(push), turn):.1f}"
        for turn in (6e-3, -6e-3, 16e-3, -16e-3, 25e-3)
    ]
    header = ("wall", "N [kN]", "V max, test / found [kN]", "at 2 mm", "at 6 mm", "V at the end / max", "processor [s]")
    said = f"cyclic, test / found at 6, -6, 16, -16 and 25 mm [kN]: {', '.join(ends)}, processor {took:.0f} s"
    cli.report(out / "granite_walls", said, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
