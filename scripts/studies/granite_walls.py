"""Dry granite walls of Vasconcelos (2005), pushed in their plane under a constant load, beside the tests.

The walls are 1.0 x 1.2 x 0.2 m, of blocks of 0.2 x 0.15 m without mortar. A beam stands on the wall and may turn; the
actuator pushes it 1.325 m above the base. The vertical load is taken to come through rollers from a head that stays
level. A roller between the level head and a beam that has moved by u and turned by theta has moved by u / 2, and the
line of its two contacts, along which it presses, leans against the push by theta / 2. So half of the load is put on a
plate that slides without friction on the beam, held by an actuator that rests, whose part stays where it is and presses
square on the beam, and half on the beam itself, whose part moves with it and stays vertical: to first order their sum
is the force of the roller. Prints a table and draws the curves over the tests, which are in
`tests/records/granite_walls` (stone masonry database of EPFL's EESD group, MIT licence; Vanin et al. 2017, doi
10.1007/s10518-017-0188-5).

The stiffness of the joints is fitted on WS.175; the other walls are shown with it.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.labels import SMALL, beside

RECORDS = Path(__file__).resolve().parents[2] / "tests" / "records" / "granite_walls"
"""The curves of the tests."""
LENGTH, THICK, UNIT, COURSE, COURSES, SPAN = 1.0, 0.2, 0.2, 0.15, 8, 1.325
"""Wall, blocks, courses and height of the push [m]."""
DENSITY, FRICTION = 2040.0, 0.62
"""Of the blocks, from the weight that the source gives [kg/m3], and of the joints [-]."""
ON_PLATE, SLIDING = 0.5, 1e-3
"""Share of the load on the plate, and friction below it [-]: without any it would not stand before it is held."""
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
    effects: tuple[mr.Load | mr.Actuator, ...]
    jack: mr.Actuator


def rectangle(x: float, z: float, width: float, height: float, density: float, name: str) -> mr.Polygon:
    """A block by its lower left corner [m]."""
    corners = [(x, z), (x + width, z), (x + width, z + height), (x, z + height)]
    return mr.Polygon(corners, density=density, length=THICK, name=name, fixed=name == "floor")


class Assumed(NamedTuple):
    """What is taken of a wall that the source does not say.

    Args:
        stiffness, shear: k_n of the joints [N/m3], and k_s over it.
        friction: of the joints [-].
        points: lines of a joint.
        on_plate: share of the load on the plate [-]: 1 is a plate that slides on the beam, 0 a load that follows it.
        sliding: friction below the plate [-].
        guided: how the beam is guided, see `Actuator`.
        inset: how far the joint on the floor ends from the faces of the wall [m].
        courses: False for a wall of one block.
    """

    stiffness: float = STIFFNESS
    shear: float = SHEAR
    friction: float = FRICTION
    points: int = POINTS
    on_plate: float = ON_PLATE
    sliding: float = SLIDING
    guided: Literal["upright"] | None = None
    inset: float = 0.0
    courses: bool = True


ASSUMED = Assumed()
"""What the study takes."""


def units(assumed: Assumed) -> list[mr.Polygon]:
    """The floor and the blocks of the wall."""
    left = assumed.inset or -0.5
    blocks = [rectangle(left, -0.2, LENGTH - 2 * left, 0.2, DENSITY, "floor")]
    if not assumed.courses:
        return [*blocks, rectangle(0.0, 0.0, LENGTH, COURSES * COURSE, DENSITY, "wall")]
    for course in range(COURSES):
        edges = np.arange(0.0, LENGTH + 1e-9, UNIT)
        if course % 2:
            edges = np.concatenate([[0.0], edges[:-1] + UNIT / 2, [LENGTH]])
        for i, (left, right) in enumerate(pairwise(edges)):
            name = f"course_{course}_{i}"
            blocks.append(rectangle(float(left), course * COURSE, float(right - left), COURSE, DENSITY, name))
    return blocks


def wall_of(force: float, assumed: Assumed = ASSUMED) -> Wall:
    """A wall with a vertical force at its base [kN]."""
    blocks, top = units(assumed), COURSES * COURSE
    rise = 2 * (SPAN - top)
    blocks.append(rectangle(0.0, top, LENGTH, rise, BEAM, "beam"))
    blocks.append(rectangle(0.4, top + rise, 0.2, 0.1, BEAM, "plate"))

    def friction(joint: mr.Joint) -> float:
        return assumed.sliding if "plate" in joint.name else assumed.friction

    k_n, k_s = assumed.stiffness, assumed.shear * assumed.stiffness
    masonry = mr.Masonry(blocks, k_n=k_n, k_s=k_s, friction=friction, xi=0.1, points=assumed.points)
    load = 1e3 * force - sum(block.mass for block in blocks if not block.fixed) * mr.GRAVITY
    parts = (("plate", assumed.on_plate), ("beam", 1.0 - assumed.on_plate))
    loads = tuple(
        mr.Load(share * load, top + rise, block=masonry.names.index(name)) for name, share in parts if share > 0
    )
    held = mr.Actuator("plate", (0.5, top + rise), 1, None, JACK, damping=1e4)
    jack = mr.Actuator("beam", (0.0, SPAN), 1, None, JACK, damping=1e5, guided=assumed.guided)
    return Wall(masonry, (*loads, held), jack)


def measured(name: str) -> Array:
    """Displacement [mm] and force [kN] of a test, shape (n, 2)."""
    return np.loadtxt(RECORDS / f"{name}.csv", delimiter=",", skiprows=4, usecols=(0, 1))


def pushed(force: float, to: Sequence[float] = (0.04,), assumed: Assumed = ASSUMED) -> tuple[mr.Push, float]:
    """The push of a wall under a vertical force [kN], to displacements [m], and the processor time [s]."""
    wall, begun = wall_of(force, assumed), time.process_time()
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


def cyclic(test: Array, found: Array, took: float) -> str:
    """The forces of test and cyclic push at the turns, in a sentence."""
    turns = (6e-3, -6e-3, 16e-3, -16e-3, 25e-3)
    ends = ", ".join(f"{at_turn(test, turn):.1f} / {at_turn(found, turn):.1f}" for turn in turns)
    return f"cyclic, test / found at 6, -6, 16, -16 and 25 mm [kN]: {ends}, processor {took:.0f} s"


def drawn(pushes: Mapping[str, Array], turned: Array | None) -> Figure:
    """The wall, the curves of tests and of the model, and the cyclic push over the envelope of its test."""
    figure = Figure(figsize=(7.4, 6.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.9))
    wall, ax, below = (figure.add_subplot(grid[place]) for place in ((0, 0), (0, 1), (1, slice(None))))
    look = plotting.STYLES["explicit"] | {"linestyle": "-", "linewidth": 1.3, "label": None}
    plotting.blocks(wall, wall_of(LOADS["WS100"]).masonry, joints=False)
    top = COURSES * COURSE
    vertical = (0.5 * LENGTH, top + 0.35), (0.5 * LENGTH, top + 0.7)
    for name, (end, start), shift in (("$N$", vertical, (4, -6)), ("$V$", ((0.0, SPAN), (-0.4, SPAN)), (2, 8))):
        wall.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": "black"})
        beside(wall, start, name, "black", shift)
    wall.axis("off")
    for name, found in pushes.items():
        test = measured(name)
        first = name == next(iter(pushes))
        ax.plot(*test.T, color="0.65", linewidth=3, label="test, Vasconcelos (2005)" if first else None)
        ax.plot(*found.T, **look | {"label": plotting.STYLES["explicit"]["label"] if first else None})
        sigma = 1e-3 * LOADS[name] / (LENGTH * THICK)
        beside(ax, (float(found[-1, 0]), float(found[-1, 1])), rf"$\sigma$ = {sigma:.2f} MPa", "0.2", (-2, 8))
    ax.set(xlim=(0, 45), ylim=(0, 115))
    ax.legend(frameon=False, loc="upper left", fontsize=SMALL)
    if turned is not None:
        below.plot(*measured("WS1100_cyclic_envelope").T, "o", color="0.4", markersize=4, label="test, envelope")
        below.plot(*turned.T, **look | {"label": plotting.STYLES["explicit"]["label"], "linewidth": 0.9})
        below.legend(frameon=False, loc="upper left", fontsize=SMALL)
    below.set_title(rf"to and fro, $\sigma$ = {1e-3 * LOADS['WS100'] / (LENGTH * THICK):.2f} MPa", fontsize=10)
    ax.set_title("pushed to 40 mm", fontsize=10)
    for each in (ax, below):
        each.set(xlabel="displacement at 1.325 m [mm]", ylabel="horizontal force $V$ [kN]")
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Push the walls, print the table, draw the curves."""
    args = cli.parser(__doc__, "granite_walls").parse_args(argv)
    out = cli.folder(args.out)
    rows: list[list[object]] = []
    pushes: dict[str, Array] = {}
    for name, force in list(LOADS.items())[: 1 if args.quick else None]:
        test = measured(name)
        push, took = pushed(force, *(((0.0005,), ASSUMED._replace(points=2, courses=False)) if args.quick else ()))
        pushes[name] = found = curve_of(push)
        peak, top = test[:, 1].max(), found[:, 1].max()
        rises = [(at(test, place), at(found, place)) for place in (2.0, 6.0)]
        changes = [f"{a:.1f} / {b:.1f} ({b / a - 1:+.0%})" for a, b in rises]
        share = found[-1, 1] / top
        rows.append(
            [name, force, f"{peak:.1f} / {top:.1f} ({top / peak - 1:+.1%})", *changes, f"{share:.2f}", f"{took:.0f}"]
        )
    summary, turned = "", None
    if not args.quick:
        push, took = pushed(LOADS["WS100"], TURNS)
        turned = curve_of(push)
        summary = cyclic(measured("WS1100_cyclic_envelope"), turned, took)
    plotting.save(drawn(pushes, turned), out / "granite_walls.png")
    header = ("wall", "N [kN]", "V max, test / found [kN]", "at 2 mm", "at 6 mm", "V at the end / max", "processor [s]")
    cli.report(out / "granite_walls", f"{cli.table(header, rows)}\n\n{summary}".rstrip(), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
