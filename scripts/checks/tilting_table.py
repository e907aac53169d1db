"""A tilting table in time: columns, a panel and an arch, by explicit steps, beside closed forms.

A table that turns slowly is a push of tan(angle). Columns slide or turn, also one of round drums in space, which turns
about an edge of its section. The panel slides, and the arch has four hinges: its closed form is the least
multiplier of limit analysis, which a test holds to all mechanisms of four hinges.
The table turns to nine tenths of that angle within a second and then on by 5 mrad/s. Masonry moves from when a block
is never slower than 2 mm/s again, which it is a quarter of a second after it no longer stands. Prints the tangents.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import numpy as np

import mjrock as mr
from scripts.shared import cli

K_N, XI = 1e10, 0.05
"""Stiffness of the joints [N/m3] and their damping ratio [-]."""
RATE, MOVES = 0.005, 0.002
"""Rate at which the table turns [rad/s], and speed of a block that moves [m/s]."""
BEFORE, BEYOND = 0.9, 1.05
"""Angles from which on it turns slowly, and at which it stops, over that of the closed form [-]."""
BLOCK = mr.Block.from_size(0.5, 0.6)


def column(friction: float) -> mr.Masonry:
    """Three blocks of 0.5 m by 0.6 m on a base."""
    return mr.Masonry.stack([BLOCK] * 3, k_n=K_N, k_s=K_N, friction=friction, xi=XI)


PANEL = mr.Masonry.running_bond(1.5, 1.75, (0.5, 0.25), thickness=0.3, k_n=K_N, k_s=K_N, friction=0.45, xi=XI)
ARCH = mr.Masonry.arch(radius=5.0, thickness=1.0, voussoirs=9, k_n=K_N, k_s=K_N, friction=1.5, xi=XI)
DRUMS = mr.Masonry.column(0.6, 2.4, 4, sides=12, k_n=K_N, k_s=K_N, friction=0.7, xi=XI)
REACH = max(float(block.corners[:, 0].max()) for block in DRUMS.blocks if not block.fixed)
"""How far the drums reach in the direction in which the table tilts [m]."""
CASES: dict[str, tuple[mr.Masonry, float | None]] = {
    "column of three blocks, friction 0.25, slides": (column(0.25), 0.25),
    "column of three blocks, friction 0.7, turns": (column(0.7), 0.5 / 1.8),
    "column of four drums with twelve sides in space, friction 0.7, turns": (DRUMS, REACH / 1.2),
    "panel in running bond, friction 0.45, slides": (PANEL, 0.45),
    "arch of 9 voussoirs, t/R = 0.2, four hinges": (ARCH, None),
}


def tangent(masonry: mr.Masonry, expected: float) -> float:
    """Tangent of the angle at which masonry begins to move, near one that is expected."""
    slow, last = BEFORE * math.atan(expected), BEYOND * math.atan(expected)
    until = 2.0 + (last - slow) / RATE
    ramp = np.linspace(0.0, 1.0, 101)
    history = np.append(ramp, [2.0, until]), np.append(slow * 0.5 * (1 - np.cos(np.pi * ramp)), [slow, last])
    answer = mr.solve_explicit(mr.MasonryCase(masonry, until, tilt=history), output_step=0.01)
    place = answer.pose[:, :, : 3 if masonry.in_space else 2]
    speed = np.linalg.norm(np.gradient(place, answer.t, axis=0), axis=2).max(axis=1)
    still = int(np.flatnonzero(speed < MOVES)[-1])
    return math.tan(float(np.interp(answer.t[still], *history)))


def main(argv: Sequence[str] | None = None) -> None:
    """Tilt, and print the table."""

    def both(name: str) -> tuple[float, float]:
        masonry, closed = CASES[name]
        expected = mr.collapse_multiplier(masonry).multiplier if closed is None else closed
        return expected, tangent(masonry, expected)

    args = cli.parser(__doc__, "tilting_table").parse_args(argv)
    cli.beside_closed_forms(args, "tilting_table", "masonry", "tan of the angle", list(CASES), both)


if __name__ == "__main__":
    sys.exit(cli.run(main))
