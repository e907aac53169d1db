"""A wall held still at given rotations: the compression of its base, and the force and moment that hold it.

No time passes here. At each rotation the springs of the base carry the weight and all that pulls on the wall, and the
outer edge is held by friction halfway into its overlap with the base, as in the independent solver.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..problem.quantities import GRAVITY, Array, Flags, Integers
from .kinematics import Points, Ties, along, depth, frame_of, gap, gaps, slack, stretch
from .rest import load
from .scene import Scene

ITERATIONS = 100
"""Most iterations of Newton's method for the vertical equilibrium of one pose."""


class Tilted(NamedTuple):
    """What holds a wall at its rotations.

    Args:
        pose: displacement x, z from rest [m] and rotation [rad], shape (n, 3).
        force: horizontal force at the centroid, positive outwards [N], shape (n,).
        height: height of the centroid above the point that friction holds [m], shape (n,). Times the force it is the
            moment that would hold the wall instead.
        lifted: whether a line of the base carries nothing, shape (n,).
    """

    pose: Array
    force: Array
    height: Array
    lifted: Flags


def tilted(scene: Scene, rotations: Array) -> Tilted:
    """The wall of a scene at rotations that follow each other, its ties yielding on the way.

    The vertical equilibrium gives the compression of the base. The condition that the held point of the outer edge does
    not slip gives the displacement along the base, by the trapezoidal rule from rest.

    Args:
        scene: the scene of a wall, one body with a group of contacts `base` from the inner to the outer edge.
        rotations: in increasing order [rad], shape (n,).

    Returns:
        The poses up to the first at which ties lift the wall off its base; most often all of them.
    """
    base = np.flatnonzero(np.array(scene.group) == "base")
    ties = scene.ties._replace(reach=np.array(scene.ties.reach))
    pose = scene.at_rest[0].copy()
    found = np.zeros((len(rotations), 5))
    above = _above(scene, int(base[-1]), pose)
    for n, theta in enumerate(rotations):
        step, before = theta - pose[2], above
        start = pose[0]
        for _ in range(2):  # Heun's method: the second time with the mean of both levers
            moved = np.array([start - 0.5 * (before + above) * step, pose[1], theta])
            carried = _carried(scene, ties, moved)
            if carried is None:
                return _found(scene, base, found[:n])
            pose, springs = carried
            above = _above(scene, int(base[-1]), pose)
        total = load(scene.forces, scene.masses, pose) + springs
        frame = frame_of(pose)
        for i in range(len(ties.k)):
            stretch(ties, i, frame, pose)
        # with F the friction and H the force at the centroid: total_x + F + H = 0 and total_theta + F above = 0
        found[n] = *pose, total[2] / above - total[0], -above
    return _found(scene, base, found)


def _found(scene: Scene, base: Integers, found: Array) -> Tilted:
    lifted: Flags = np.any(gaps(scene.points, found[:, :3])[:, base] >= 0, axis=1)
    return Tilted(found[:, :3], found[:, 3], found[:, 4], lifted)


def _above(scene: Scene, toe: int, pose: Array) -> float:
    """Height of the held point of the outer edge above the centroid [m]: its slip for a unit of angular velocity."""
    return along(scene.points, toe, frame_of(pose), np.array([0.0, 0.0, 1.0]))[2]


def _carried(scene: Scene, ties: Ties, pose: Array) -> tuple[Array, Array] | None:
    """The pose lowered until all vertical forces are in equilibrium, and the generalised force of its springs.

    None where ties lift the wall off its base.
    """
    pose = scene.lowered(pose[None])[0]
    weight = GRAVITY * float(scene.mass[0])
    down = float(load(scene.forces, scene.masses, pose)[1])
    found, unit, none = np.empty(4), np.eye(3), np.zeros(3)
    for _ in range(ITERATIONS):
        _springs(scene.points, ties, frame_of(pose), unit, none, found)
        if found[3] == 0:
            break
        lift = (down + found[1]) / found[3]
        if abs(lift) < 1e-15 * scene.extent or abs(down + found[1]) < 1e-12 * weight:
            return pose, found[:3].copy()
        pose[1] += lift
    return None


@compiled
def _springs(points: Points, ties: Ties, frame: Array, unit: Array, none: Array, found: Array) -> None:
    """Write the generalised force of contacts and ties on one body, and its vertical stiffness, shape (4,)."""
    found[:] = 0.0
    for i in range(len(points.k)):
        pressed = depth(points, i, frame)
        if pressed > 0:
            for j in range(3):
                found[j] += points.k[i] * pressed * gap(points, i, frame, unit[j], none)[1]
            found[3] += points.k[i] * gap(points, i, frame, unit[1], none)[1] ** 2
    for i in range(len(ties.k)):
        pulled = -slack(ties, i, frame, none, none)[0]
        if pulled > 0:
            for j in range(3):
                found[j] += ties.k[i] * min(pulled, ties.stretch[i]) * slack(ties, i, frame, unit[j], none)[1]
