"""A stone that rocks in stock MuJoCo, with the contacts of MuJoCo's guide "Model tuning" and with those of the law.

    python scripts/models/rocking_by_the_guide.py

The stone is released from half of its slenderness, alone and beside a wall. |e| is that of its first landing, by the
rotations at rest before and after it. Then it stands for ten seconds on a slope that friction holds. Writes
rocking_by_the_guide.csv and rocking_by_the_guide.txt.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import mujoco
import numpy as np

import mjrock as mr
from scripts.shared import cli

WALL = mr.Block.from_size(thickness=0.2, height=1.0, length=0.2)
START, SLOPE, FRICTION = 0.5 * WALL.alpha, math.radians(5), 20.0
E = mr.Restitution.from_geometry(WALL)
LAW = {alone: mr.Contacts.from_law(WALL, E, k_base=5e8, k_side=None if alone else 5e8) for alone in (True, False)}
"""Contacts of the stone alone and beside a wall, both of 5e8 N/m3 and with the damping ratios of the law."""
STEP, STANDS = 1e-4, 10.0
"""[s]"""
ELLIPTIC = 'cone="elliptic" impratio="10"'
GUIDE = {
    "defaults, elliptic": ("", 'cone="elliptic"'),
    "guide, rigid": ('solref="0.004 1"', ELLIPTIC),
    "guide, rigid, noslip": ('solref="0.004 1"', f'{ELLIPTIC} noslip_iterations="3"'),
    "guide, 20 ms": ('solref="0.02 1"', ELLIPTIC),
    "guide, bounces": ('solref="-1e5 -10"', ELLIPTIC),
}
"""Attributes of the geoms and of the options."""
MADE = "law, in N/m"


def spec_of(name: str, *, alone: bool) -> mujoco.MjSpec:
    """The stone on a plane, upright, alone or beside a wall, with the contacts of a row."""
    geom, option = GUIDE.get(name, ("", ELLIPTIC))
    size = f"{WALL.b} {WALL.length / 2} {WALL.h}"
    beside = '<geom name="side" type="box" pos="-1.1 0 1" size="1 1 1.5" friction="0 0 0" priority="1"/>'
    spec = mujoco.MjSpec.from_string(
        f"""<mujoco><option timestep="{STEP}" {option}/><default><geom friction="{FRICTION} 0 0" {geom}/></default>
        <worldbody><geom name="floor" type="plane" size="2 2 1"/>{"" if alone else beside}<body pos="0 0 {WALL.h}">
        <freejoint/><geom name="stone" type="box" size="{size}" mass="{WALL.mass}"/></body></worldbody></mujoco>"""
    )
    if name == MADE:
        law = LAW[alone]
        meets = {"floor": law.base} if law.side is None else {"floor": law.base, "side": law.side}
        pairs: dict[tuple[str | int, str | int], dict[str, float]] = {
            (other, "stone"): {"k": face.stiffness.sum() / 4, "c": face.damping.sum() / 4}
            | {"friction": FRICTION if other == "floor" else 0.0}
            for other, face in meets.items()
        }
        mr.contacts_for(spec, pairs).apply(spec)
    return spec


def rocked(model: mujoco.MjModel) -> tuple[float, float]:
    """Time of the first landing [s], and the rotation to which the stone turns after it [rad]."""
    data = mujoco.MjData(model)
    cos, sin = math.cos(START), math.sin(START)
    x, z = WALL.b * (1 - cos) + WALL.h * sin, WALL.b * sin + WALL.h * cos
    data.qpos[:] = x, 0, z, math.cos(START / 2), 0, math.sin(START / 2), 0
    turned = [START]
    landed = 0
    while not landed or data.time < landed + 0.01 or abs(turned[-1]) > abs(turned[-2]):
        mujoco.mj_step(model, data)
        turned.append(2 * math.atan2(data.qpos[5], data.qpos[3]))
        if not landed and turned[-1] <= 0:
            landed = data.time
    return landed, abs(turned[-2])


def kept(peak: float) -> float:
    """The restitution of a landing between two rotations at rest, by the energy of the rigid stone there [-]."""
    at_start, after = (float(WALL.potential_energy(np.array([turn]))[0]) for turn in (START, peak))
    return math.sqrt(after / at_start)


def slid(model: mujoco.MjModel) -> float:
    """How far the stone creeps down a slope that friction holds [m], in its last five seconds."""
    model.opt.gravity[:] = mr.GRAVITY * math.sin(SLOPE), 0, -mr.GRAVITY * math.cos(SLOPE)
    data = mujoco.MjData(model)
    at = []
    for moment in (STANDS - 5, STANDS):
        while data.time < moment:
            mujoco.mj_step(model, data)
        at.append(data.qpos[0])
    return float(at[1] - at[0])


def main(argv: Sequence[str] | None = None) -> None:
    """Both landings for every row, and the table."""
    args = cli.parser(__doc__, "rocking_by_the_guide").parse_args(argv)
    cases = {alone: mr.Case(WALL, START, 1.0, side_stop=not alone) for alone in LAW}
    rows = []
    for name, runs in {
        "theory": [mr.solve_analytical(case, E) for case in cases.values()],
        "law, SciPy": [mr.solve_compliant(cases[alone], law) for alone, law in LAW.items()],
    }.items():
        rows.append([name, f"{runs[0].impacts[0].t:.4f}", *(f"{kept(run.peaks[1]):.3f}" for run in runs), "0"])
    for name in [MADE] if args.quick else [*GUIDE, MADE]:
        models = [spec_of(name, alone=alone).compile() for alone in LAW]
        (landing, _), *_ = found = [rocked(model) for model in models]
        creep = 1e3 * slid(models[0])
        rows.append([name, f"{landing:.4f}", *(f"{kept(peak):.3f}" for _, peak in found), f"{creep:.2g}"])
    header = ["contacts", "first landing [s]", "|e| alone", "|e| beside a wall", "creeps in 5 s [mm]"]
    cli.report(cli.folder(args.out) / "rocking_by_the_guide", cli.table(header, rows), header, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
