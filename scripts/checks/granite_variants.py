"""A dry granite wall pushed in its plane, with one assumption changed after the other, beside its test.

WS.250 of `scripts/studies/granite_walls.py`, which says what the study takes. No variant is fitted. Prints the force at
2, 6, 20 and 39 mm and the largest, and of all four walls the share of the rigid bound, load times half the length over
the height of the push, that the courses have with rigid joints, by limit analysis without dilatancy, and in the test.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace

from tqdm import tqdm

import mjrock as mr
from scripts.shared import cli
from scripts.studies.granite_walls import (
    ASSUMED,
    COURSE,
    COURSES,
    LENGTH,
    LOADS,
    SPAN,
    STIFFNESS,
    Assumed,
    at,
    curve_of,
    measured,
    pushed,
    rectangle,
    units,
)

WALL = "WS250"
PLACES = (2.0, 6.0, 20.0, 39.0)
"""Displacements at which forces are given [mm]."""
ONE_BLOCK = "one block, no courses"
VARIANTS: dict[str, Assumed] = {
    "as taken: rollers": ASSUMED,
    "load on a plate that slides on the beam": ASSUMED._replace(on_plate=1.0),
    "load that follows the beam": ASSUMED._replace(on_plate=0.0),
    "friction 0.02 below the plate": ASSUMED._replace(sliding=0.02),
    "beam that does not turn": ASSUMED._replace(guided="upright"),
    "k_n twice": ASSUMED._replace(stiffness=2 * STIFFNESS),
    "k_n half": ASSUMED._replace(stiffness=0.5 * STIFFNESS),
    "friction of the joints 0.5": ASSUMED._replace(friction=0.5),
    "joint on the floor ends 10 mm from the faces": ASSUMED._replace(inset=0.01),
    ONE_BLOCK: ASSUMED._replace(courses=False),
    "16 lines a joint": ASSUMED._replace(points=16),
}


HEAVY = 25000.0
"""Density of a beam that stands for the load [kg/m3]; the blocks are as much lighter as it is lighter than that."""


def rigid_share(force: float) -> float:
    """What courses with rigid joints bear under a vertical force at the base [kN], over the rigid bound [-]."""
    (floor, *blocks), top = units(ASSUMED), COURSES * COURSE
    beam = rectangle(0.0, top, LENGTH, 2 * (SPAN - top), HEAVY, "beam")
    scale = beam.mass / (1e3 * force / mr.GRAVITY - sum(block.mass for block in blocks))
    lighter = [replace(block, density=scale * block.density) for block in blocks]
    masonry = mr.Masonry([floor, *lighter, beam], friction=ASSUMED.friction)
    push = mr.collapse_multiplier(masonry, None, associated=False, loads={"beam": (1.0, 0.0)}).multiplier
    return push / (scale * 1e3 * force * 0.5 * LENGTH / SPAN)


def main(argv: Sequence[str] | None = None) -> None:
    """Push, and print the table."""
    args = cli.parser(__doc__, "granite_variants").parse_args(argv)
    test = measured(WALL)
    peak = test[:, 1].max()
    rows: list[list[object]] = [["test", *(f"{at(test, place):.1f}" for place in PLACES), f"{peak:.1f}", "", ""]]
    header = [
        "variant",
        *(f"V at {place:g} mm [kN]" for place in PLACES),
        "V max [kN]",
        "beside the test",
        "processor [s]",
    ]
    variants = [ONE_BLOCK] if args.quick else list(VARIANTS)
    for name, assumed in tqdm([(name, VARIANTS[name]) for name in variants], disable=None, leave=False):
        push, took = pushed(LOADS[WALL], (0.0005 if args.quick else 0.04,), assumed)
        found = curve_of(push)
        top = found[:, 1].max()
        forces = [f"{at(found, place):.1f}" for place in PLACES]
        rows.append([name, *forces, f"{top:.1f}", f"{top / peak - 1:+.1%}", f"{took:.0f}"])
    shares = []
    for name, force in list(LOADS.items())[: 1 if args.quick else None]:
        bound = force * 0.5 * LENGTH / SPAN
        shares.append([name, f"{rigid_share(force):.3f}", f"{measured(name)[:, 1].max() / bound:.3f}"])
    text = cli.table(header, rows) + "\n\nshare of the rigid bound\n"
    text += cli.table(["wall", "courses with rigid joints", "test"], shares)
    cli.report(cli.folder(args.out) / "granite_variants", text, header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
