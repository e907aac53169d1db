"""The restitution that is asked of contacts in any MuJoCo model, and the one that MuJoCo gives.

    python scripts/checks/requested_and_found.py --quick

Shapes land on a face, an edge and a corner, a leg on its foot in two poses, and bodies that welds, gears and springs
hold, without gravity; a ball lands under gravity at three speeds. Prints e asked and e found, and the warning where
there is one. Writes requested_and_found.csv.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np

import mjrock as mr
from scripts.shared import cli

REQUESTED = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.95)
QUICK = (0.1, 0.5)
STEP = 2e-5
FREQUENCY = 500.0
"""omega of a contact [rad/s]: a step is a hundredth of 1 / omega."""
RIGHT = 0.03
"""Difference of e up to which it is called right [-]."""
PYRAMID = "-.1 -.1 0  .1 -.1 0  .1 .1 0  -.1 .1 0  0 0 .15"
BOX = '<body pos="0 0 1" {turn}><freejoint/><geom name="foot" type="{kind}" {size} mass="1.3"/></body>'
LEG = """<body pos="0 0 .6"><freejoint/><geom type="box" size=".2 .1 .05" mass="6" contype="0" conaffinity="0"/><body>
<joint name="hip" axis="0 1 0" {hip}/><geom type="capsule" fromto="0 0 0 0 0 -.2" size=".02" mass=".8" contype="0"
conaffinity="0"/><body pos="0 0 -.2"><joint name="knee" axis="0 1 0" {knee}/><geom type="capsule" fromto="0 0 0 0 0 -.2"
size=".015" mass=".2" contype="0" conaffinity="0"/><geom name="foot" pos="0 0 -.2" size=".02" mass=".02"/>
</body></body></body>"""
BENT = '<keyframe><key name="bent" qpos="0 0 .6 1 0 0 0 .7 -1.4"/></keyframe>'
TWO = """<body name="foot" pos="0 0 .5"><freejoint/><geom name="foot" size=".05" mass=".5"/></body>
<body name="load" pos="0 0 .7"><freejoint/><geom size=".05" mass="4"/></body>"""
WELD = '<equality><weld body1="foot" body2="load" solref="{time} 1"/></equality>'
GEAR = """<body pos="0 0 .5"><joint name="lift" type="slide" axis="0 0 1"/>
<geom name="foot" size=".05" mass="1"/></body>
<body pos="1 0 1"><joint name="wheel" axis="0 1 0"/><geom type="cylinder" size=".1 .02" mass="2"/></body>"""
GEARED = '<equality><joint joint1="wheel" joint2="lift" polycoef="0 12 0 0 0" solref="{time} 1"/></equality>'
SPRUNG = """<body pos="0 0 .5"><joint type="slide" axis="0 0 1"/><geom size=".05" mass="3" contype="0" conaffinity="0"/>
<body pos="0 0 -.3"><joint name="strut" type="slide" axis="0 0 1" {strut}/><geom name="foot" size=".02" mass=".5"/>
</body></body>"""
TENDON = """<site name="above" pos="0 0 2"/><body pos="0 0 .5"><freejoint/><geom name="foot" size=".06" mass=".75"/>
<site name="hook"/></body>"""
CABLE = """<tendon><spatial name="cable" {cable}><site site="above"/><site site="hook"/></spatial></tendon>"""


@dataclass(frozen=True)
class Landing:
    """A landing on a plane.

    Args:
        bodies, others: what falls, and the rest of the model, as MJCF. It falls in the pose of its keyframe.
        pose: `keyframe` or nothing, for `contact_for`.
        speed, gravity: speed of approach [m/s] and gravity [m/s2].
        moving: velocity of the joints for an approach of 1 m/s.
        friction: of the contact [-].
        frequency: omega that the contact is to have [rad/s].
    """

    bodies: str
    others: str = ""
    pose: dict[str, Any] = field(default_factory=dict)
    speed: float = 1.0
    gravity: float = 0.0
    moving: dict[int, float] = field(default_factory=lambda: {2: -1.0})
    friction: float = 1.0
    frequency: float = FREQUENCY

    def text(self) -> str:
        """The model as MJCF."""
        return (
            f'<mujoco><option timestep="{STEP}" gravity="0 0 {-self.gravity}"/><asset><mesh name="tent" '
            f'vertex="{PYRAMID}"/></asset><worldbody><geom name="floor" type="plane" size="5 5 1"/>{self.bodies}'
            f"</worldbody>{self.others}</mujoco>"
        )

    def found(self, e: float) -> tuple[float, str]:
        """The restitution that MuJoCo gives for one that is asked, and what was warned of."""
        spec = mujoco.MjSpec.from_string(self.text())
        options = {"friction": self.friction, "speed": self.speed if self.gravity else None, **self.pose}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            mass = mr.contact_for(spec, "foot", "floor", k=1e5, xi=0.1, **options).mass
            caught.clear()
            contact = mr.contact_for(spec, "foot", "floor", k=mass * self.frequency**2, restitution=e, **options)
        contact.apply(spec)
        model = spec.compile()
        return self.rebound(model, contact), "; ".join(str(warning.message) for warning in caught)

    def rebound(self, model: mujoco.MjModel, contact: mr.PairContact) -> float:
        """Speed at which the contact parts over that at which it meets."""
        data = mujoco.MjData(model)
        if model.nkey:
            mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_kinematics(model, data)
        foot, floor = model.geom("foot").id, model.geom("floor").id
        ends = np.zeros(6)
        gap = mujoco.mj_geomDistance(model, data, foot, floor, 100, ends)
        for dof, rate in self.moving.items():
            place = dof + dof // 6 * (model.nq - model.nv) // 2  # behind the quaternion of the first of two bodies
            data.qpos[place] += rate * (gap - 0.5 * STEP * self.speed)
            data.qvel[dof] = rate * self.speed
        point = None
        body = int(model.geom_bodyid[foot])
        jacobian = np.zeros((3, model.nv))
        for _ in range(int(60 * max(1, contact.xi) / contact.frequency / STEP)):
            mujoco.mj_step(model, data)
            if point is None and data.ncon:
                place = data.contact.pos.mean(axis=0)
                point = data.xmat[body].reshape(3, 3).T @ (place - data.xpos[body])
            elif point is not None and not data.ncon:
                place = data.xpos[body] + data.xmat[body].reshape(3, 3) @ point
                mujoco.mj_jac(model, data, jacobian, None, place, body)
                return float(jacobian[2] @ data.qvel) / self.speed
        return 0.0


def shape(kind: str, size: str, turn: str = "") -> Landing:
    """A geom that falls without gravity."""
    return Landing(BOX.format(turn=turn, kind=kind, size=f'size="{size}"' if size else 'mesh="tent"'))


def leg(hip: str = "", knee: str = "", **more: Any) -> Landing:
    """A body of 6 kg on a leg with a hip and a knee."""
    return Landing(LEG.format(hip=hip, knee=knee), **more)


def welded(time: float) -> Landing:
    """A foot of 0.5 kg welded to 4 kg by an equality constraint."""
    return Landing(TWO, WELD.format(time=time), moving={2: -1.0, 8: -1.0})


def geared(time: float) -> Landing:
    """A foot on a slide that turns a wheel."""
    return Landing(GEAR, GEARED.format(time=time), moving={0: -1.0, 1: -12.0})


BALL = BOX.format(turn="", kind="sphere", size='size=".06"')
LANDINGS = {
    "ball": shape("sphere", ".06"),
    "box on a face": shape("box", ".1 .07 .05"),
    "box on an edge, 20 deg": shape("box", ".1 .07 .05", 'euler="0 20 0"'),
    "box on an edge, 45 deg": shape("box", ".1 .07 .05", 'euler="0 45 0"'),
    "box on a corner": shape("box", ".1 .07 .05", 'euler="30 20 0"'),
    "capsule, upright": shape("capsule", ".05 .1"),
    "capsule, lying": shape("capsule", ".05 .1", 'euler="90 0 0"'),
    "capsule, leaning": shape("capsule", ".05 .1", 'euler="30 0 0"'),
    "cylinder on its end": shape("cylinder", ".1 .05"),
    "cylinder, lying": shape("cylinder", ".1 .05", 'euler="90 0 0"'),
    "ellipsoid": shape("ellipsoid", ".1 .07 .05"),
    "mesh on its base": shape("mesh", ""),
    "ball, g/(omega v) = .009": Landing(BALL, gravity=9.81, speed=9.81 / FREQUENCY / 0.009),
    "ball, g/(omega v) = .054": Landing(BALL, gravity=9.81, speed=9.81 / FREQUENCY / 0.054),
    "ball, g/(omega v) = .085": Landing(BALL, gravity=9.81, speed=9.81 / FREQUENCY / 0.085),
    "leg, straight": leg(),
    "leg, bent": leg(others=BENT, pose={"keyframe": "bent"}),
    "leg, bent, unsaid": leg(others=BENT),
    "leg, bent, armature": leg('armature=".01"', 'armature=".01"', others=BENT, pose={"keyframe": "bent"}),
    "leg, bent, sprung": leg(
        'stiffness="300" springref="40.11"',
        'stiffness="300" springref="-80.21"',
        others=BENT,
        pose={"keyframe": "bent"},
    ),
    "leg, bent, damped": leg('damping="2"', 'damping="2"', others=BENT, pose={"keyframe": "bent"}),
    "welded, 0.2 ms": welded(0.0002),
    "welded, 1 ms": welded(0.001),
    "welded, 20 ms": welded(0.02),
    "welded, 1 s": welded(1.0),
    "geared, 0.2 ms": geared(0.0002),
    "geared, 20 ms": geared(0.02),
    "strut without spring": Landing(SPRUNG.format(strut=""), moving={0: -1.0}),
    "strut of 1e5 N/m": Landing(SPRUNG.format(strut='stiffness="100000"'), moving={0: -1.0}),
    "tendon, armature": Landing(TENDON, CABLE.format(cable='armature=".2"')),
    "tendon, spring": Landing(TENDON, CABLE.format(cable='stiffness="50000" springlength="1.5"')),
}
FEW = (
    "ball",
    "box on an edge, 20 deg",
    "cylinder on its end",
    "leg, bent",
    "welded, 20 ms",
    "ball, g/(omega v) = .085",
)


def main(argv: Sequence[str] | None = None) -> None:
    """Let everything land, and print the table."""
    args = cli.parser(__doc__, "requested_and_found").parse_args(argv)
    out = cli.folder(args.out)
    requested = QUICK if args.quick else REQUESTED
    names = FEW if args.quick else tuple(LANDINGS)
    notes: dict[str, str] = {}
    rows, values = [], []
    for name in names:
        results = [LANDINGS[name].found(e) for e in requested]
        worst = max(abs(found - e) for e, (found, _) in zip(requested, results, strict=True))
        warned = next((sentences for _, sentences in results if sentences), "")
        notes |= {name: warned} if warned else {}
        verdict = "right" if worst <= RIGHT else "warned of" if warned else "WRONG"
        rows.append([name, *(f"{found:.3f}" for found, _ in results), f"{worst:.3f}", verdict])
        values += [[name, e, found, sentences] for e, (found, sentences) in zip(requested, results, strict=True)]
    text = cli.table(["e asked", *(f"{e:g}" for e in requested), "worst", ""], rows)
    text += "".join(f"\n\n{name}: {sentences}" for name, sentences in notes.items())
    cli.report(out / "requested_and_found", text, ["landing", "asked", "found", "warning"], values)


if __name__ == "__main__":
    sys.exit(cli.run(main))
