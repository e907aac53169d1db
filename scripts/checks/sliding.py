"""What contacts that slide do: by Coulomb's law, and on the rows of the engine alone.

A cube is thrown along level ground, which it must not leave, and a wall rocks against a side that rubs. Both run with
steps that fit the motion, with `coulomb=True`, their default, and with `coulomb=False`, which leaves sliding to the
rows of MuJoCo as the model text does. Two boxes in space slide on each other and on the ground and strike, for several
tolerances of the direction of friction. Prints how far the cube rises and where it stops, |e| of the wall over the
friction of its side, how far forces of the boxes are from what moves them, and what a step costs that slides. Writes
sliding.png.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from tqdm import tqdm

import mjrock as mr
from mjrock import plotting
from mjrock.method import METHOD
from mjrock.plotting.style import GREEN, ORANGE
from mjrock.quantities import Array
from scripts.shared import cli
from scripts.shared.labels import beside

SPEED, MU = 4.0, 0.5
"""Speed of the cube [m/s] and its coefficient of friction [-]."""
WALL = mr.Block.from_size(0.6, 4.2)
ACCURACIES = (1e-3, 1e-4, 1e-5)
LINES: dict[bool, dict[str, Any]] = {
    True: {"color": ORANGE, "linestyle": "-", "linewidth": 1.8},
    False: {"color": GREEN, "linestyle": "--", "linewidth": 1.2},
}
"""Of runs by Coulomb's law, and of runs on the rows."""


def box(left: float, right: float, low: float, high: float, fixed: bool = False) -> mr.Polygon:
    """A rectangle [m]."""
    return mr.Polygon([(left, low), (right, low), (right, high), (left, high)], fixed=fixed)


def thrown(duration: float, **options: Any) -> mr.MasonryResponse:
    """The cube, half a metre wide."""
    cube = mr.Masonry((box(-19, 19, -1, 0, True), box(-0.25, 0.25, 0, 0.5)), k_n=1e9, friction=MU, xi=0.05)
    case = mr.MasonryCase(cube, duration, velocity=[[SPEED, 0, 0]])
    return mr.simulate(case, output_step=1e-3, **options)


def cube_table(accuracies: Sequence[float]) -> str:
    """Rise, rotation and place of rest of the cube."""
    rows: list[list[object]] = []
    for coulomb in (True, False):
        for options in (*({"accuracy": a} for a in accuracies), {"timestep": 1e-4}):
            run = thrown(1.2, coulomb=coulomb, **options)
            x, z, theta = np.moveaxis(run.pose[:, 0], 1, 0)
            numbers = f"{1e3 * (z.max() - z[0]):.4f}", f"{1e3 * np.abs(theta).max():.3f}", f"{x[-1]:.5f}"
            how = ", ".join(f"{name} {value:g}" for name, value in options.items())
            rows.append(["Coulomb" if coulomb else "rows", how, *numbers, run.stats["steps"]])
    exact = SPEED**2 / (2 * MU * mr.GRAVITY)
    header = ["sliding", "steps", "rise [mm]", "rotation [mrad]", f"rest [m] ({exact:.5f})", "number"]
    return cli.table(header, rows)


def restitution(side_friction: float, accuracy: float, coulomb: bool) -> float:
    """|e| of the first rebound of the wall."""
    contacts = mr.Contacts.from_damping(
        WALL, k_base=5e8, xi_base=0.05, k_side=5e8, xi_side=0.012, friction=0.8, side_friction=side_friction
    )
    case = mr.Case(WALL, 0.5 * WALL.alpha, 1.3)
    return float(mr.simulate(case, contacts, accuracy=accuracy, coulomb=coulomb).restitution[0])


def costs(repeats: int) -> str:
    """Time of a step in which blocks slide over that of one in which they rest, at a fixed step, the least of some."""
    wall, rows = mr.Masonry.running_bond(1.5, 1.25, (0.5, 0.25), thickness=0.3, k_n=1e9, friction=0.5, xi=0.05), []
    stack = mr.Masonry.stack([mr.Block(0.3, 0.3)] * 4, 1e9, friction=0.5, xi=0.05)
    cube = mr.Masonry((box(-19, 19, -1, 0, True), box(-0.25, 0.25, 0, 0.5)), k_n=1e9, friction=MU, xi=0.05)
    for name, masonry in (("a cube", cube), ("4 blocks in a stack", stack), (f"{len(wall.free)} units in bond", wall)):
        height = masonry.centroids[list(masonry.free), 1]
        thrust = np.column_stack([SPEED * height / height.max(), np.zeros((len(height), 2))])
        times = {}
        for moves, coulomb in ((0, True), (1, True), (1, False)):
            case = mr.MasonryCase(masonry, 0.1, velocity=moves * thrust)
            runs = [mr.simulate(case, timestep=1e-4, coulomb=coulomb).stats for _ in range(repeats)]
            times[moves, coulomb] = min(run["stepping_time"] / run["steps"] for run in runs)
        rest, slides, on_rows = times.values()
        rows.append([name, f"{rest * 1e6:.1f}", f"{slides / rest:.2f}", f"{on_rows / rest:.2f}"])
    return cli.table(["scene", "a step at rest [us]", "sliding by Coulomb", "sliding on rows"], rows)


def boxes() -> mr.Masonry:
    """A small box on a larger one on the ground, in space."""
    sizes = ((20, 20, 1), (0, 0, -0.5)), ((0.7, 0.5, 0.6), (0, 0, 0.3)), ((0.5, 0.4, 0.3), (0.1, 0.05, 0.75))
    blocks = [mr.Polyhedron.box(size, at, fixed=i == 0) for i, (size, at) in enumerate(sizes)]
    return mr.Masonry(blocks, k_n=1e9, friction=0.6, xi=0.05)


def directions(repeats: int, h: float = 1e-4) -> str:
    """What friction in space lacks of what moves the boxes, over friction, and the time of a step, over tolerances."""
    masonry, rows = boxes(), []
    mass = np.array([block.mass for block in masonry.blocks if not block.fixed])
    case = mr.MasonryCase(masonry, 0.15, velocity=[[0, 0, 0, 0, 0.3, 0], [1.0, 0.2, 0.5, 0, 0.3, 0]])
    for tolerance in (2e-2, 2e-3, 5e-4):
        method = METHOD._replace(way_known=tolerance)
        run = mr.simulate(case, timestep=h, output_step=h, coulomb=True, forces=True, method=method)
        moved = np.einsum("b,nbd->nd", mass, np.diff(run.pose[:, :, :2], n=2, axis=0)) / h**2
        rubs = 0.6 * run.forces.normal[1:-1].sum(axis=1)
        apart = np.abs(np.sum(list(run.reactions.values()), axis=0)[1:-1, :2] - moved).max(axis=1)
        pressed = rubs > 0.1 * mr.GRAVITY * mass.sum()
        share = apart[pressed] / rubs[pressed]
        runs = [mr.simulate(case, timestep=h, coulomb=True, method=method).stats for _ in range(repeats)]
        took = min(each["stepping_time"] / each["steps"] for each in runs)
        mean = float(np.sqrt(np.mean(share**2)))
        rows.append([f"{tolerance:g}", f"{share.max():.2%}", f"{mean:.3%}", f"{1e6 * took:.0f}"])
    return cli.table(["direction known to", "largest", "root mean square", "a step [us]"], rows)


def draw_cube(ax: Axes) -> Axes:
    """The path of the cube in the first half second."""
    for coulomb, label, at in ((True, "Coulomb's law", (0.02, -1.0)), (False, "MuJoCo's own friction", (0.02, 4.0))):
        run = thrown(0.5, coulomb=coulomb)
        x, z = run.pose[:, 0, 0], 1e3 * (run.pose[:, 0, 1] - run.pose[0, 0, 1])
        ax.plot(x, z, **LINES[coulomb])
        ax.text(*at, label, color=LINES[coulomb]["color"], fontsize=8)
    ax.set_ylim(bottom=-1.6)
    ax.set_xlabel("way of the cube [m]")
    ax.set_ylabel("rise [mm]")
    return ax


def draw_wall(ax: Axes, frictions: Array, found: dict[tuple[bool, float], list[float]]) -> Axes:
    """|e| over the friction of the side; by Coulomb's law all accuracies are alike, and one is drawn."""
    finest = min(accuracy for _, accuracy in found)
    for (coulomb, accuracy), values in found.items():
        if not coulomb or accuracy == finest:
            ax.plot(frictions, values, marker="o" if coulomb else "s", markersize=3.5, **LINES[coulomb])
            legend = "Coulomb's law,\nall accuracies" if coulomb else f"accuracy {accuracy:g}"
            beside(ax, (frictions[-1], values[-1]), legend, LINES[coulomb]["color"], (8, 0))
    ax.text(0.0, 0.25, "MuJoCo's own friction", color=LINES[False]["color"], fontsize=8)
    ax.set_xlabel("coefficient of friction of the side [-]")
    ax.set_ylabel(r"$|e|$ of the first rebound [-]")
    ax.set(xlim=(-0.03, 1.27), ylim=(0.2, 0.39), xticks=frictions[::2])
    return ax


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, draw and print."""
    args = cli.parser(__doc__, "sliding").parse_args(argv)
    out = cli.folder(args.out)
    for legend in ("contacts that slide", "with a fixed step of"):
        warnings.filterwarnings("ignore", legend, UserWarning)
    accuracies = ACCURACIES[:1] if args.quick else ACCURACIES
    frictions = np.linspace(0, 0.8, 3 if args.quick else 9)
    found = {
        (coulomb, accuracy): [restitution(float(mu), accuracy, coulomb) for mu in frictions]
        for coulomb in (True, False)
        for accuracy in tqdm(accuracies, desc="walls", disable=None, leave=False)
    }
    drawings = [
        ("a cube thrown along the ground, 4 m/s", draw_cube),
        ("a wall that rubs against its side", lambda ax: draw_wall(ax, frictions, found)),
    ]
    figure = plotting.panels(drawings)
    plotting.save(figure, out / "sliding.png")
    rows = [
        ["Coulomb" if coulomb else "rows", f"{accuracy:g}", *(f"{value:.4f}" for value in values)]
        for (coulomb, accuracy), values in found.items()
    ]
    text = cube_table(accuracies) + "\n\n|e| of the first rebound over the friction of the side\n"
    text += cli.table(["sliding", "accuracy", *(f"{mu:g}" for mu in frictions)], rows)
    text += "\n\ntwo boxes in space: friction less what moves them, over friction\n" + directions(
        2 if args.quick else 7
    )
    text += "\n\nthe time of a step\n" + costs(2 if args.quick else 7)
    cli.report(out / "sliding", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
