"""A heavy stone on four light ones in MuJoCo, with its default contacts and with contacts in N/m: a moving picture.

    python scripts/models/stack_before_and_after.py --out docs/figures

Prints by how much the stones lie inside each other at the end.
"""

from __future__ import annotations

import itertools
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np

import mjrock as mr
from mjrock.plotting import animation
from mjrock.plotting.bodies import Bodies
from mjrock.quantities import Array
from mjrock.result.bodies import BodyMotion
from mjrock.scene.tints import TINTS, distinct_tints
from scripts.shared import cli
from scripts.shared.films import FPS, folder, summary_of
from scripts.shared.films import films as written

HALF = np.array([0.15, 0.1, 0.05])
"""Half extents of a stone [m]."""
LIGHT, HEAVY = 1.5, 300.0
"""Masses [kg]."""
COUNT = 5
NAMES = "MuJoCo's default", "contact_for, 1e6 N/m"
"""Labels of the two stacks."""
DURATION, FRAME = 1.5, 0.02
"""[s]"""
APART = 0.8
"""Distance of the two stacks in the picture [m]."""
DROP, HIGHEST = 0.005, np.arange(COUNT) == COUNT - 1
"""Height from which the highest stone falls [m]."""


def stack() -> mujoco.MjSpec:
    """Stones one on the other, the heavy one on top, which falls by 5 mm."""
    masses = [LIGHT] * (COUNT - 1) + [HEAVY]
    size = " ".join(map(str, HALF))
    bodies = "".join(
        f'<body pos="0 0 {HALF[2] * (2 * i + 1) + DROP * HIGHEST[i]}"><freejoint/>'
        f'<geom name="stone{i}" type="box" size="{size}" mass="{mass}"/></body>'
        for i, mass in enumerate(masses)
    )
    return mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="2e-4"/><worldbody><geom name="floor" type="plane" size="2 2 1"/>{bodies}
        </worldbody></mujoco>"""
    )


def after(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """The same stack with contacts of 1e6 N/m and 1e4 N s/m at each of four points."""
    names = ["floor", *(f"stone{i}" for i in range(COUNT))]
    joint = {"k": 1e6, "c": 1e4, "friction": 0.6}
    warnings.simplefilter("ignore", mr.ContactWarning)  # of the restitution, which dashpots so strong leave near zero
    mr.contacts_for(spec, {(above, below): joint for below, above in itertools.pairwise(names)}).apply(spec)
    return spec.compile()


def followed(model: mujoco.MjModel) -> tuple[Array, Array]:
    """Times [s] and pose x, z, theta of every stone from where it is drawn, shape (n, stones, 3)."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    rest = data.xipos[1:].copy()
    times, poses = [], []
    for frame in range(round(DURATION / FRAME) + 1):
        while data.time < frame * FRAME - 1e-9:
            mujoco.mj_step(model, data)
        turn = np.arctan2(data.xmat[1:, 2], data.xmat[1:, 8])
        moved = data.xipos[1:] - rest
        times.append(data.time)
        poses.append(np.column_stack([moved[:, 0], moved[:, 2], turn]))
    return np.array(times), np.array(poses)


def drawn(bodies: Bodies, labels: Sequence[str], path: Path) -> Path:
    """Write the film of both stacks, with a label under each."""
    times = np.append(np.arange(0.0, DURATION, 1 / FPS), DURATION)
    title = "A stone of 300 kg on four of 1.5 kg in MuJoCo"
    figure, update = animation.scene(bodies.at(times), [], None, title=title)
    (ax,) = figure.axes
    ax.axis("off")
    ax.set_position((0.02, 0.02, 0.96, 0.84))
    for side, label in zip((-1, 1), labels, strict=True):
        ax.text(side * APART / 2, -0.13, label, ha="center", va="center", fontsize=10)
    return animation.write(figure, update, len(times), path, animation.writer_for(path, FPS)[0], 100.0)


def main(argv: Sequence[str] | None = None) -> None:
    """Draw both."""
    out = folder(cli.parser(__doc__, "out/stack_before_and_after").parse_args(argv).out)
    films = [followed(stack().compile()), followed(after(stack()))]
    sunk = np.array([-1000 * (poses[-1, :, 1] + DROP * HIGHEST) for _, poses in films])
    lines = [
        f"{name}: the stones have sunk by {', '.join(f'{depth:.2f}' for depth in each)} mm"
        for name, each in zip(NAMES, sunk, strict=True)
    ]
    box = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * HALF[[0, 2]]
    rests = [(side * APART / 2, HALF[2] * (2 * i + 1)) for side in (-1, 1) for i in range(COUNT)]
    poses = np.concatenate([poses for _, poses in films], axis=1)
    poses[..., 1] += DROP * np.tile(HIGHEST, 2)
    ground = np.array([(-0.9, -0.06), (0.9, -0.06), (0.9, 0.0), (-0.9, 0.0)])
    stones = [mr.Polygon(box + rest) for rest in rests]
    case = mr.MasonryCase(mr.Masonry([*stones, mr.Polygon(ground, fixed=True)]), DURATION)
    colours = np.array([TINTS[tint] for tint in distinct_tints(len(stones), ())])
    bodies = Bodies(BodyMotion(case, films[0][0], poses), colours, np.array([(-0.9, 0.9), (-0.2, 0.55)]))
    labels = [f"{name}: sinks by {depth:.3g} mm" for name, depth in zip(NAMES, sunk[:, -1], strict=True)]
    lines += [summary_of(written(lambda path: drawn(bodies, labels, path), out / "stack_before_and_after", DURATION))]
    cli.report(out / "stack_before_and_after", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(cli.run(main))
