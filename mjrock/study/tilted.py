"""A wall held still at given rotations: the compression of its base, and the force and moment that hold it.

No time passes here. At each rotation the springs of the base carry the weight and all that pulls on the wall, and the
outer edge is held by friction halfway into its overlap with the base, as in the independent solver.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from tqdm import tqdm

from ..geometry.frames import frames_of
from ..geometry.kinematics import along, gaps, snaps, stretch
from ..quantities import GRAVITY, Array, Flags, Integers
from ..scene.potential import Potential
from ..scene.scene import Scene

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
    """The wall of a scene at rotations that follow each other, its ties yielding and breaking on the way.

    The vertical equilibrium gives the compression of the base. The condition that the held point of the outer edge does
    not slip gives the displacement along the base, by the trapezoidal rule from rest.

    The scene has one body, with a group of contacts `base` from the inner to the outer edge. Rotations increase [rad].

    Returns:
        The poses up to the first at which ties lift the wall off its base; most often all of them.
    """
    base = np.flatnonzero(scene.contacts.joint == scene.contacts.joints.index("base"))
    ties = scene.ties._replace(reach=np.array(scene.ties.reach))
    potential = Potential(scene.structure._replace(ties=ties))
    pose = scene.at_rest[0].copy()
    rows = np.zeros((len(rotations), 5))
    lever = _lever(scene, int(base[-1]), pose)
    for n, theta in enumerate(tqdm(rotations, desc="push-over", delay=3, disable=None, leave=False)):
        step, before = theta - pose[2], lever
        start = pose[0]
        for _ in range(2):  # Heun's method: the second time with the mean of both levers
            moved = np.array([start - 0.5 * (before + lever) * step, pose[1], theta])
            carried = _carried(scene, potential, moved)
            if carried is None:
                return _tilted(scene, base, rows[:n])
            pose, springs = carried
            lever = _lever(scene, int(base[-1]), pose)
        total = potential.load(pose) + springs
        for i in range(len(ties.k)):
            snaps(ties, i, frames_of(pose), pose, scene.places.axes)
            stretch(ties, i, frames_of(pose), pose, scene.places.axes)
        # with F the friction and H the force at the centroid: total_x + F + H = 0 and total_theta + F lever = 0
        rows[n] = *pose, total[2] / lever - total[0], -lever
    return _tilted(scene, base, rows)


def _tilted(scene: Scene, base: Integers, rows: Array) -> Tilted:
    lifted: Flags = np.any(gaps(scene.places, rows[:, :3])[:, base] >= 0, axis=1)
    return Tilted(rows[:, :3], rows[:, 3], rows[:, 4], lifted)


def _lever(scene: Scene, toe: int, pose: Array) -> float:
    """Height of the held point of the outer edge above the centroid [m]: its slip for a unit of angular velocity."""
    return along(scene.places, toe, frames_of(pose), np.array([0.0, 0.0, 1.0])).bodies


def _carried(scene: Scene, potential: Potential, pose: Array) -> tuple[Array, Array] | None:
    """The pose lowered until all vertical forces are in equilibrium, and the generalised force of its springs.

    Ties pull with no more than their strength. None where ties lift the wall off its base.
    """
    pose = scene.lowered(pose[None])[0]
    contacts, weight = len(scene.contacts.k), GRAVITY * float(scene.bodies.mass[0])
    limits = np.append(np.full(contacts, np.inf), scene.ties.stretch)
    down = float(potential.load(pose)[1])
    for _ in range(ITERATIONS):
        rates, pressed = potential.rates(pose).toarray(), np.minimum(potential.pressed(pose), limits)
        springs = rates.T @ (potential.springs * pressed)
        stiffness = float(scene.contacts.k[pressed[:contacts] > 0] @ rates[:contacts, 1][pressed[:contacts] > 0] ** 2)
        if stiffness == 0:
            break
        lift = (down + springs[1]) / stiffness
        if abs(lift) < 1e-15 * scene.bodies.extent or abs(down + springs[1]) < 1e-12 * weight:
            return pose, springs
        pose[1] += lift
    return None
