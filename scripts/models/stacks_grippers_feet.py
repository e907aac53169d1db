"""Stacks, grippers and feet: how deep they press, how they creep and bounce, with contacts in N/m and with MuJoCo's.

    python scripts/models/stacks_grippers_feet.py --robot go2/scene.xml --feet FL,FR,RL,RR --floor floor --keyframe home

Prints the indentation of a stack of five boxes over weight / k, the creep of an object that two pads hold, and what a
pushed box lifts by, each with contacts of `contact_for` and with MuJoCo's default; and the iterations that MuJoCo's
solver needs for stacks. With --robot it prints the mass that
each foot feels at qpos0 and in a keyframe. Writes stacks_grippers_feet.txt.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np

import mjrock as mr
from scripts.shared import cli

G = 9.81
STACK = 5
BOX = (
    '<body pos="0 0 {z}"><freejoint/><geom name="box{i}" type="box" size=".1 .07 .05" mass="1.3" friction=".6"/></body>'
)
TURN = "(?s).*a turn of 0.01 degrees"
"""Warning that stacks of equal boxes give; these do not turn."""
GRIPPER = """<body pos="-.06 0 .3"><joint name="left" type="slide" axis="1 0 0"/>
<geom name="left" type="box" size=".01 .03 .03" mass=".2" friction=".7"/></body>
<body pos=".06 0 .3"><joint name="right" type="slide" axis="-1 0 0"/>
<geom name="right" type="box" size=".01 .03 .03" mass=".2" friction=".7"/></body>
<body name="held" pos="0 0 .3"><freejoint/><geom name="held" type="box" size=".05 .02 .04" mass=".3" friction=".7"/>
</body>"""


def model_text(bodies: str, h: float, options: str = "") -> str:
    """A floor and bodies, as MJCF."""
    return (
        f'<mujoco><option timestep="{h}" {options}/><worldbody><geom name="floor" type="plane" size="5 5 1"/>{bodies}'
        "</worldbody></mujoco>"
    )


def stack(seconds: float) -> list[list[str]]:
    """Indentation of each joint of a stack of boxes [mm]: measured with both contacts, and weight / k."""
    bodies = "".join(BOX.format(z=0.05 + 0.1 * i, i=i) for i in range(STACK))
    k, rows = 1e5, []
    measured = []
    for own in (True, False):
        spec = mujoco.MjSpec.from_string(model_text(bodies, 5e-4))
        if own:
            parameters = {"k": k / 4, "xi": 0.5, "friction": 0.6}
            mr.contacts_for(spec, {("box*", "floor"): parameters, ("box*", "box*"): parameters}).apply(spec)
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, int(seconds / 5e-4))
        heights = np.array([0.05, *data.qpos.reshape(STACK, 7)[:, 2]])
        measured.append(1e3 * (np.array([0.1] * STACK) - np.diff([-0.05, *heights[1:]])))
    for i in range(STACK):
        above = (STACK - i) * 1.3 * G
        rows.append([str(i + 1), f"{1e3 * above / k:.4f}", f"{measured[0][i]:.4f}", f"{measured[1][i]:.4f}"])
    return rows


CAPS = (1, 3, 5, 10, 15, 20)
STACKS = ((1, 2.5e4), (2, 2.5e4), (3, 2.5e4), (5, 2.5e4), (10, 2.5e4), (5, 1e3), (5, 1e5))
"""Boxes of 1.3 kg, and k of a contact point [N/m]."""


def iterations(seconds: float) -> list[list[str]]:
    """Most iterations of a step of a stack that slides at first, and the fewest that leave the depth of its joints."""
    rows = []
    for count, k in STACKS:
        bodies = "".join(BOX.format(z=0.05 + 0.1 * i, i=i) for i in range(count))
        spec = mujoco.MjSpec.from_string(model_text(bodies, 5e-4))
        parameters = {"k": k, "xi": 0.5, "friction": 0.6}
        pairs: dict[tuple[str | int, str | int], dict[str, float]] = {("box*", "floor"): parameters}
        if count > 1:
            pairs["box*", "box*"] = parameters
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", mr.ContactWarning)  # of a step that is long for the stiffest
            mr.contacts_for(spec, pairs).apply(spec)
        model, heights, most = spec.compile(), [], 0
        for cap in (300, *CAPS):
            model.opt.iterations = cap
            data = mujoco.MjData(model)
            data.qvel[0] = 0.3
            for _ in range(int(seconds / 5e-4)):
                mujoco.mj_step(model, data)
                most = max(most, int(data.solver_niter.max())) if cap == 300 else most
            heights.append(data.qpos.reshape(-1, 7)[:, 2].copy())
        depth = count * 1.3 * G / (4 * k)
        few = [cap for cap, z in zip(CAPS, heights[1:], strict=True) if np.abs(z - heights[0]).max() < 0.02 * depth]
        rows.append([str(count), f"{k:g}", f"{model.opt.impratio:.2g}", str(most), str(min(few, default="-"))])
    return rows


def creep(seconds: float) -> list[list[str]]:
    """How fast a held object of 0.3 kg sinks between two pads that press with 10 N [um/s], and how deep each pad is in
    it [um]: at four points, with contacts of `contact_for` and with what MuJoCo's manual has against creep."""
    rows, held = [], math.inf
    for name, own, options in (
        ("MuJoCo, default", False, ""),
        ("MuJoCo, elliptic, impratio 10", False, 'cone="elliptic" impratio="10"'),
        ("MuJoCo, elliptic, impratio 1000", False, 'cone="elliptic" impratio="1000"'),
        ("MuJoCo, noslip_iterations 10", False, 'noslip_iterations="10"'),
        ("contacts_for", True, ""),
        ("contacts_for, noslip_iterations 10", True, 'noslip_iterations="10"'),
    ):
        spec = mujoco.MjSpec.from_string(model_text(GRIPPER, 1e-3, options))
        if own:
            parameters = {"restitution": 0.1, "friction": 0.7}  # the stiffest that the step resolves
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # gravity: a grip does not bounce
                pads = mr.contacts_for(spec, {("left", "held"): parameters, ("right", "held"): parameters})
                pads.apply(spec)
            held = pads.contacts[0].k
        model = spec.compile()
        data = mujoco.MjData(model)
        model.body_gravcomp[:] = 0
        data.qfrc_applied[:2] = 10.0
        mujoco.mj_step(model, data, 500)
        before, started, count = float(data.qpos[4]), time.perf_counter(), int(seconds / 1e-3)
        iterations = 0
        for _ in range(count):
            mujoco.mj_step(model, data)
            iterations += int(data.solver_niter[0])
        spent = (time.perf_counter() - started) / count
        sunk, deep = (before - float(data.qpos[4])) / seconds, -float(data.contact.dist.mean())
        cost = [f"{iterations / count:.1f}", f"{1e6 * spent:.0f}"]
        rows.append(
            [name, f"{1e6 * sunk:.2f}", f"{1e6 * deep:.1f}", f"{1e6 * 10 / 4 / held:.1f}" if own else "-", *cost]
        )
    return rows


def push(seconds: float) -> list[list[str]]:
    """What a box of 2 kg that slides at 3 m/s lifts by [mm] and what a step costs [us], at steps of 1 ms."""
    rows = []
    for name, coulomb in (("rows of the cone", False), ("CoulombFriction", True)):
        body = '<body pos="0 0 .1"><freejoint/><geom name="box" type="box" size=".2 .2 .1" mass="2"/></body>'
        spec = mujoco.MjSpec.from_string(model_text(body, 1e-3))
        mr.contact_for(spec, "box", "floor", k=2.5e4, xi=0.3, friction=0.4).apply(spec)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qpos[2] -= 2 * G / 1e5
        data.qvel[0] = 3.0
        friction, top, started = mr.CoulombFriction(model), 0.0, time.perf_counter()
        for _ in range(int(seconds / 1e-3)):
            if coulomb:
                friction(data)
            mujoco.mj_step(model, data)
            top = max(top, float(data.qpos[2]) - 0.1 + 2 * G / 1e5)
        spent = (time.perf_counter() - started) / int(seconds / 1e-3)
        slid = 3 - float(data.qvel[0])
        rows.append([name, f"{1e3 * top:.4f}", f"{slid:.4f}", f"{0.4 * G * seconds:.4f}", f"{1e6 * spent:.0f}"])
    return rows


def feet(path: Path, names: Sequence[str], floor: str, keyframe: str) -> list[list[str]]:
    """Mass that the feet of a robot feel [kg], at qpos0 and in a keyframe, with and without friction."""
    model = mujoco.MjModel.from_xml_path(str(path))
    rows = []
    for name in names:
        masses = []
        for pose in (None, keyframe):
            for friction in (0.0, 0.8):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    made = mr.contact_for(model, name, floor, restitution=0.3, friction=friction, keyframe=pose)
                masses.append(f"{made.mass:.3f}")
        rows.append([name, *masses])
    return rows


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print the tables."""
    warnings.filterwarnings("ignore", TURN, mr.ContactWarning)
    options = cli.parser(__doc__, "stacks_grippers_feet")
    options.add_argument("--robot", type=Path, help="MJCF of a robot that has feet")
    options.add_argument("--feet", default="FL,FR,RL,RR", help="names of its feet")
    options.add_argument("--floor", default="floor", help="name of what it stands on")
    options.add_argument("--keyframe", default="home", help="keyframe in which it stands")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    seconds = 0.3 if args.quick else 10.0
    tables = [
        (["joint", "weight / k [mm]", "contacts_for [mm]", "MuJoCo's default [mm]"], stack(max(seconds, 1.0))),
        (["gripper", "creep [um/s]", "depth [um]", "force / (4 k)", "iterations", "us a step"], creep(seconds)),
        (["pushed box", "lift [mm]", "lost [m/s]", "mu g t", "us a step"], push(0.3)),
    ]
    head = ["boxes", "k of a point [N/m]", "impratio", "most iterations", "fewest that leave the depths"]
    tables.append((head, iterations(0.05 if args.quick else 1.5)))
    if args.robot is not None:
        header = ["foot", "qpos0, mu 0 [kg]", "qpos0, mu .8", f"{args.keyframe}, mu 0", f"{args.keyframe}, mu .8"]
        tables.append((header, feet(args.robot, args.feet.split(","), args.floor, args.keyframe)))
    text = "\n\n".join(cli.table(header, rows) for header, rows in tables)
    cli.report(out / "stacks_grippers_feet", text)


if __name__ == "__main__":
    sys.exit(cli.run(main))
