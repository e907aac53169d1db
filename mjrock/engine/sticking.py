"""Sticking: a sticking edge stays where it stuck, although steps are long.

A friction row of MuJoCo stops the slip that a point has in the geometry at the start of a step, half a step early. In a
step h a wall that turns about its toe therefore drags the toe inwards, by h/2 times the integral of
omega^2 (b cos(theta) - h_c sin(theta)) dt with h_c the height of the centroid: some micrometres in a fall. On a stiff
base this presses the wall against its side stop, and later rebounds meet the stop out of true. So each sticking joint
remembers where its deepest point stuck, and after each step the body above it is shifted back by what the point has
drifted. The shifts are micrometres, and their work is of second order in them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..problem.quantities import Array, Flags, Integers
from .contact import row
from .kinematics import Points, along, depth, direction, gap
from .scene import Scene


class Joints(NamedTuple):
    """The joints whose points are put back, from the ground upwards.

    Args:
        of: the joint of each contact point, -1 where it has none, shape (m,).
        body: the body that stands on each joint, shape (joints,).
        stuck: the point of each joint that sticks, -1 where none does, shape (joints,).
        anchor: where that point stuck on its face [m], shape (joints,).
    """

    of: Integers
    body: Integers
    stuck: Integers
    anchor: Array

    @classmethod
    def of_scene(cls, scene: Scene) -> Joints:
        """The joints of a scene in which every body stands on one other body or on the ground; else none."""
        rough = (scene.friction > 0) & scene.points.bears
        below = {
            int(body): set(scene.face_body[rough & (scene.point_body == body)]) for body in scene.point_body[rough]
        }
        order: list[int] = []
        if all(len(bodies) == 1 for bodies in below.values()):
            order = sorted(below, key=lambda body: _height(body, below))
        of = np.full(len(scene.k), -1)
        for joint, body in enumerate(order):
            of[rough & (scene.point_body == body)] = joint
        return cls(of, np.array(order, dtype=np.int64), np.full(len(order), -1), np.zeros(len(order)))


def _height(body: int, below: dict[int, set[int]]) -> int:
    """How many bodies a body stands on, one on the other."""
    count = 0
    while body in below and count <= len(below):
        (body,) = below[body]
        count += 1
    return count


@jitable
def sticks(
    points: Points,
    i: int,
    frame: Array,
    before: Array,
    after: Array,
    h: float,
    beta: float,
    ringing: float,
    impratio: float,
) -> bool:
    """Whether point i was pressed and did not slide in the step from `before` to `after`, the velocities around it.

    The friction row stops the slip with the force that this takes, as long as the force is within the cone.
    """
    g, rate, _ = gap(points, i, frame, before, before)
    if g >= 0:
        return False
    dashpot, inertia = row(points.k[i], points.c[i], h, points.weight[i], beta, ringing)
    acceleration = (gap(points, i, frame, after, after)[1] - rate) / h
    pressing = -(points.k[i] * g + dashpot * rate + inertia * acceleration)
    dragging = impratio * inertia * along(points, i, frame, after)[1] / h
    return pressing > 0 and abs(dragging) <= points.friction[i] * pressing


@jitable
def put_back(points: Points, joints: Joints, q: Array, frame: Array, sticking: Flags) -> None:
    """Shift the bodies so that the deepest sticking point of each joint is where it stuck.

    Args:
        points: the contacts.
        joints: the joints, whose state is brought up to date.
        q, frame: the pose after the step and its frame, which are changed.
        sticking: whether each contact stuck in the step, shape (m,).
    """
    for j in range(len(joints.body)):
        deepest, most = -1, 0.0
        for i in range(len(points.k)):
            if joints.of[i] == j and sticking[i] and depth(points, i, frame) > most:
                deepest, most = i, depth(points, i, frame)
        if deepest < 0:
            joints.stuck[j] = -1
            continue
        here = along(points, deepest, frame, q)[0]
        if joints.stuck[j] != deepest:
            joints.stuck[j], joints.anchor[j] = deepest, here
            continue
        drift, body = here - joints.anchor[j], joints.body[j]
        nx, nz = direction(points, deepest, frame)
        q[3 * body] -= drift * nz
        q[3 * body + 1] += drift * nx
        frame[body, 0], frame[body, 1] = q[3 * body], q[3 * body + 1]
