"""First cracks of mortared walls out of plane, by explicit steps, beside closed forms of linear springs.

A horizontal acceleration grows slowly until a joint has lost some of its bond. Joints are brittle. Their
lines have the stiffness of the whole face in bending, so that the outermost one cracks where a closed form says,
whatever their number.
- A cantilever, one block on a base: (f_t + g rho h) t / (3 rho g h^2). Once cracked it rocks from t / h on.
- A strip between two floors, in n blocks with n + 1 equal joints. At rest half of its weight hangs. The moment at its
  ends is the mean over the joints of q z (h - z) / 2, since their rotations cancel, and the joint at its head cracks.
- A corner: a façade of one block bonded by poor lime to two return walls over its height. It has no base and depends on
  them, with the moment of its weight W t / 2. It is pulled off at the tops.
Prints the accelerations over g.

Then what lines do to what follows: the cantilever of 2 m by 0.25 m, with f_t = 0.1 MPa on 6e10 N/m3, is pushed until it
has opened by 2 mm, over the closed form of its first crack.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

import mjrock as mr
from scripts.shared import cli

DENSITY, T, H = 2000.0, 0.24, 3.0
"""Density of the masonry [kg/m3], thickness and height of the walls [m]."""
K, POINTS, XI = 2e10, 5, 0.05
"""Stiffness of the joints [N/m3], lines across each, and damping ratio [-]."""
SLOWLY = 1.0
"""Time in which the acceleration grows to 1.1 of the closed form [s]."""
BOND = mr.Bond(tension=0.2e6, cohesion=0.3e6, opening_energy=1.0, slip_energy=130.0)
LIME = mr.Bond(tension=0.05e6, cohesion=0.07e6, opening_energy=0.1, slip_energy=10.0)
"""Bond of the façade."""
WEIGHT = mr.GRAVITY * DENSITY
"""Of a cubic metre [N/m3]."""


def rectangle(left: float, low: float, right: float, high: float, **options: Any) -> mr.Polygon:
    """A block of the plane, 1 m long."""
    corners = [(left, low), (right, low), (right, high), (left, high)]
    return mr.Polygon(corners, length=1.0, density=DENSITY, **options)


def masonry(blocks: Sequence[mr.Polygon | mr.Polyhedron], **options: Any) -> mr.Masonry:
    """Blocks with bonded joints."""
    given: dict[str, Any] = {"k_n": K, "k_s": K, "friction": 0.7, "xi": XI, "points": POINTS, "bond": BOND} | options
    return mr.Masonry(blocks, **given)


def cantilever() -> tuple[mr.Masonry, float]:
    """The cantilever, and the acceleration over g at which it cracks."""
    base = rectangle(-0.5, -0.3, T + 0.5, 0.0, fixed=True)
    return masonry([base, rectangle(0.0, 0.0, T, H)]), (BOND.tension + WEIGHT * H) * T / (3 * WEIGHT * H**2)


def strip(blocks: int) -> tuple[mr.Masonry, float]:
    """The strip between two floors in so many blocks, and the acceleration over g at which it cracks."""
    z = np.linspace(0.0, H, blocks + 1)
    floors = [rectangle(-0.5, low, T + 0.5, low + 0.3, fixed=True) for low in (-0.3, H)]
    wall = [rectangle(0.0, low, T, high) for low, high in pairwise(z.tolist())]
    moment = 0.5 * WEIGHT * T * np.mean(z * (H - z))  # at the ends, for 1 g
    return masonry([*floors, *wall]), float((BOND.tension - 0.5 * WEIGHT * H) / (6 * moment / T**2))


def corner() -> tuple[mr.Masonry, float]:
    """The façade between two return walls, and the acceleration over g at which it parts from them."""
    length, back = 4.0, 0.5
    facade = mr.Polyhedron.box((T, length, H), (0.5 * T, 0.0, 0.5 * H), density=DENSITY, name="facade")
    returns = [
        mr.Polyhedron.box((back, T, H), (-0.5 * back, side * 0.5 * (length - T), 0.5 * H), fixed=True, name=name)
        for side, name in ((-1, "left"), (1, "right"))
    ]
    wall = masonry([facade, *returns], bond=LIME)
    weight = facade.mass * mr.GRAVITY
    hangs = 6 * (0.5 * weight * T) / (2 * T * H**2)
    return wall, 2 * T * H * (LIME.tension - hangs) / weight


def first_crack(wall: mr.Masonry, expected: float) -> float:
    """Acceleration over g at which a joint first loses some of its bond, while it grows beyond one that is expected.

    The ground goes to the left, so that what stands on it is pushed to the right."""
    duration = 1.1 * SLOWLY
    ground = mr.GroundMotion(np.linspace(0.0, -1.1 * expected * mr.GRAVITY, 1001), duration / 1000)
    answer = mr.solve_explicit(mr.MasonryCase(wall, duration, ground), output_step=2e-3, forces=True)
    harmed = np.flatnonzero(np.nanmax(answer.forces.damage, axis=1) > 0)
    return float(1.1 * expected * answer.t[harmed[0]] / duration) if len(harmed) else float("inf")


CASES = {
    "cantilever": cantilever,
    "strip between floors, 4 blocks": lambda: strip(4),
    "strip between floors, 12 blocks": lambda: strip(12),
    "façade bonded to return walls": corner,
}


def opened(points: int, opening_energy: float) -> tuple[float, float]:
    """Accelerations over that of the closed form at which a joint of so many lines first loses some of its bond,
    and at which it has opened by 2 mm."""
    thick, high, strength, duration = 0.25, 2.0, 0.1e6, 6.0
    closed = (strength + WEIGHT * high) * thick / (3 * WEIGHT * high**2)
    blocks = [rectangle(-5.0, -1.0, 5.0, 0.0, fixed=True), rectangle(0.0, 0.0, thick, high)]
    bond = mr.Bond(strength, 2 * strength, opening_energy, 10 * opening_energy)
    wall = masonry(blocks, k_n=6e10, k_s=2.4e10, points=points, bond=bond)
    ground = mr.GroundMotion(np.linspace(0.0, -4.5 * closed * mr.GRAVITY, 601), duration / 600)
    answer = mr.solve_explicit(mr.MasonryCase(wall, duration, ground), output_step=2e-3, forces=True)
    harmed = np.argmax(answer.forces.damage[:, 0] > 0)
    far = np.argmax(np.abs(answer.theta[:, 0]) * thick > 2e-3)
    return tuple(float(4.5 * answer.t[i] / duration) for i in (harmed, far))  # type: ignore[return-value]


def main(argv: Sequence[str] | None = None) -> None:
    """Crack, and print the table."""

    def both(name: str) -> tuple[float, float]:
        wall, expected = CASES[name]()
        return expected, first_crack(wall, expected)

    args = cli.parser(__doc__, "mortar").parse_args(argv)
    cli.beside_closed_forms(args, "mortar", "wall", "first crack at [g]", list(CASES), both)
    counts = (3,) if args.quick else (3, 5, 9, 17)
    rows = [[n, *(f"{value:.2f}" for energy in (1.0, 20.0) for value in opened(n, energy))] for n in counts]
    header = ["lines", "first harm, G_I 1 N/m", "2 mm open, 1 N/m", "first harm, G_I 20 N/m", "2 mm open, 20 N/m"]
    cli.report(cli.folder(args.out) / "mortar_lines", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
