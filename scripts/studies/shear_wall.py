"""The shear wall J4D of Raijmakers and Vermeltfoort: mortar that cracks, slips and crushes, and units that split.

The wall is 990 x 1000 x 100 mm, 16 courses of four and a half bricks between two steel beams. It is pressed to 0.30 MPa
and then sheared by a beam on top that neither turns nor rises. Each brick is two halves with a potential crack between.
The mortar is that of the micro-models of Lourenco and Rots (1997), see docs/mortar.md. Its crushing and the cracks of
bricks are assumed. The blocks are rigid, so that the stiffness of the joints holds that of the bricks.
Prints the force on the beam beside that of the test, what lines of a joint, rate, damping and bricks that do not split
change, and 16 to 84 % of walls whose stiffness differs by a millionth. The same wall in the mortar of J6D and J7D,
under 1.21 and 2.12 MPa, is a prediction: no curve of these tests was to be had. Draws the curve of J4D beside the
cracks.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

import mjrock as mr
from mjrock import plotting
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.labels import without_axes

WIDTH, COURSES, BRICK, THICK = 0.99, 16, (0.22, 1.0 / 16), 0.1
TOP = 4e-3
MEASURED = {0.2: 18, 0.4: 34, 0.7: 48, 1.0: 57, 1.4: 54, 1.8: 48, 2.2: 42, 2.6: 38, 3.0: 35}
"""Force of the test [kN] by the displacement of the beam [mm], digitised by others, +-8 kN."""
MORTAR = replace(mr.BONDS["cement mortar, wall J4D"], crushing=10.5e6, crushing_energy=5e3)
"""Its crushing is assumed: no source was at hand."""
STRONGLY_PRESSED = mr.Bond(0.16e6, 0.224e6, 11.3, 50.0, 11.5e6, 5e3)
"""Mortar of J6D and J7D. G_I is the estimate 25 (2 f_t)^0.7 N/m, G_c that of J4D."""
SPLITS = mr.Bond(2e6, 2.8e6, 80.0, 500.0)
BRICK_N, BRICK_S = 4e11, 2e11
"""Stiffness of the potential crack in a brick along the normal and the face [N/m3]."""


class Setting(NamedTuple):
    """What is varied: lines of a joint, rate of the beam [m/s], damping ratio at 1 kHz, whether bricks split, pressure
    [Pa], mortar, and stiffness of the mortar with its bricks along the normal and the face [N/m3]."""

    points: int = 3
    rate: float = 20e-3
    xi: float = 0.02
    splits: bool = True
    pressure: float = 0.30e6
    mortar: mr.Bond = MORTAR
    k_n: float = 62.7e9
    k_s: float = 27.5e9


def kind_of(joint: mr.Joint) -> str:
    """Whether a joint lies within a brick."""
    first, second = joint.name.split("|")
    return "brick" if first[:-1] == second[:-1] else "mortar"


def wall_of(setting: Setting, courses: int = COURSES) -> mr.Masonry:
    """The wall between its beams."""
    return mr.Masonry.shear_wall(
        WIDTH,
        courses * BRICK[1],
        BRICK,
        THICK,
        1900.0,
        halves=SPLITS if setting.splits else mr.Bond(1e9, 1e9, 1e9, 1e9),
        bond=setting.mortar,
        k_n=lambda joint: {"mortar": setting.k_n, "brick": BRICK_N}[kind_of(joint)],
        k_s=lambda joint: {"mortar": setting.k_s, "brick": BRICK_S}[kind_of(joint)],
        friction=lambda joint: {"mortar": 0.75, "brick": 1.0}[kind_of(joint)],
        xi=setting.xi,
        frequency=2 * np.pi * 1000,
        points=setting.points,
    )


def loading(setting: Setting, courses: int, top: float) -> tuple[Array, Array, Array]:
    """Times [s] and displacements of the beam [m]: down with a smooth start, then sideways."""
    down, share = setting.pressure / setting.k_n * (courses + 1), np.linspace(0, 1, 400)
    eased = np.where(share < 0.1, share**2 / 0.2, share - 0.05) / 0.95
    pressed = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, 50))
    t = np.concatenate([0.05 * np.linspace(0, 1, 50), 0.07 + top / setting.rate * share])
    return t, np.concatenate([0 * pressed, top * eased]), -down * np.append(pressed, np.ones(400))


def sheared(setting: Setting, courses: int = COURSES, top: float = TOP) -> tuple[mr.MasonryResponse, Array, Array]:
    """The answer, the displacement of the beam [m] and the force that it takes [N] at the samples."""
    t, dx, dz = loading(setting, courses, top)
    case = mr.MasonryCase(wall_of(setting, courses), float(t[-1]), supports={"beam": (t, dx, dz)}, settled=False)
    answer = mr.solve_explicit(case, forces=True, ledger=True)
    moved = np.interp(answer.t, t, dx)
    force = np.convolve(np.pad(answer.reactions["beam"][:, 0], 7, mode="edge"), np.ones(15) / 15, "valid")
    return answer, moved, force


SETTINGS = {
    "3 lines a joint": Setting(),
    "5 lines": Setting(points=5),
    "9 lines": Setting(points=9),
    "5 lines, 10 mm/s": Setting(points=5, rate=10e-3),
    "5 lines, damping 0.005": Setting(points=5, xi=0.005),
    "5 lines, damping 0.1": Setting(points=5, xi=0.1),
    "5 lines, bricks that do not split": Setting(points=5, splits=False),
    "5 lines, crushing hardens over 0.09 mm": Setting(points=5, mortar=replace(MORTAR, hardening=9e-5)),
    "J6D, 1.21 MPa": Setting(points=5, pressure=1.21e6, mortar=STRONGLY_PRESSED, k_n=60.3e9, k_s=26.9e9),
    "J7D, 2.12 MPa": Setting(points=5, pressure=2.12e6, mortar=STRONGLY_PRESSED, k_n=60.3e9, k_s=26.9e9),
}
DRAWN = "5 lines"
WALLS, STIFFER, READING = 8, 1e-6, 8.0
"""Walls of `DRAWN`, by how much the stiffness of each differs from the last [-], and the error of the reading [kN]."""


def forces_of(moved: Array, force: Array) -> list[float]:
    """Force at the displacements of the test and its peak [kN]."""
    begun = moved > 0
    at = np.interp(1e-3 * np.array(list(MEASURED)), moved[begun], 1e-3 * force[begun])
    return [*map(float, at), 1e-3 * float(force.max())]


def of_many_walls() -> list[list[object]]:
    """Rows of walls whose stiffness differs by a millionth: 16, 50 and 84 % of their forces, and the share of walls
    within the error of the reading of the test."""
    setting, test = SETTINGS[DRAWN], np.array([*MEASURED.values(), 57.0])
    walls = [setting._replace(k_n=setting.k_n * (1 + i * STIFFER)) for i in range(WALLS)]
    curves = np.array([forces_of(*sheared(wall)[1:]) for wall in walls])
    rows: list[list[object]] = [
        [f"{DRAWN}, {part} % of {WALLS} walls", *np.percentile(curves, part, axis=0).round(1).tolist(), "", ""]
        for part in (16, 50, 84)
    ]
    near = (np.abs(curves - test) <= READING).mean(axis=0)
    return [*rows, [f"share of walls within {READING:g} kN of the test", *near.round(1).tolist(), "", ""]]


def drawn(answer: mr.MasonryResponse, moved: Array, force: Array) -> Figure:
    """The curve beside the test, and the cracks at the end: lines by the width of the crack."""
    figure = Figure(figsize=(7.4, 3.5), layout="constrained")
    curve, cracks = figure.subplots(1, 2)
    begun = answer.t > 0.07
    look = plotting.STYLES["explicit"] | {"linestyle": "-"}
    curve.plot(1e3 * moved[begun], 1e-3 * force[begun], **look)
    curve.errorbar(list(MEASURED), list(MEASURED.values()), 8, fmt="o", color="0.2", capsize=2, label="test J4D")
    curve.set(xlabel="displacement of the beam [mm]", ylabel="force [kN]", ylim=(0, None))
    curve.legend(frameon=False, fontsize=8)
    plotting.blocks(cracks, answer, forces="cracks", limits=[(-0.05, WIDTH + 0.05), (-0.05, 1.05)])
    cracks.set_title("cracks at 4 mm", fontsize=10)
    without_axes(cracks)
    return figure


def main(argv: Sequence[str] | None = None) -> None:
    """Run the study."""
    args = cli.parser(__doc__, Path("out/shear_wall").as_posix()).parse_args(argv)
    out = cli.folder(args.out)
    settings = {DRAWN: SETTINGS[DRAWN]} if args.quick else SETTINGS
    rows: list[list[object]] = [["test", *map(float, MEASURED.values()), 57.0, "", ""]]
    for name, setting in settings.items():
        answer, moved, force = sheared(setting, 2, 2e-4) if args.quick else sheared(setting)
        assert answer.ledger is not None
        gap = np.abs(answer.ledger.residual).max() / answer.ledger.largest
        seconds = answer.stats["stepping_processor_time"]
        rows.append([name, *np.round(forces_of(moved, force), 1).tolist(), round(seconds, 1), f"{gap:.0e}"])
        if name == DRAWN:
            plotting.save(drawn(answer, moved, force), out / "shear_wall.png")
    rows += [] if args.quick else of_many_walls()
    header = ["force [kN] at", *(f"{u:g} mm" for u in MEASURED), "peak", "processor [s]", "gap of the ledger"]
    cli.report(out / "shear_wall", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
