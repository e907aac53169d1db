"""Sticking: a sticking edge stays where it stuck, although steps are long and friction is a dashpot.

Two things move an edge that friction holds. A friction row of MuJoCo stops the slip that a point has in the geometry at
the start of a step. In a step h a wall that turns at omega about its toe moves the toe by a term that the row does not
see, h^2 omega^2 / 2 times the horizontal distance of the toe from the centroid. And the row, which is a dashpot,
creeps. In a fall this adds up to some micrometres, and in an impact it may be as much. On a stiff base this presses the
wall against its side stop, and later rebounds meet the stop out of true. So each joint remembers where its deepest
sticking point stuck. After a step, the body that stands on the joint is shifted back by what this point has drifted.
It is not shifted where this would press a contact that bears nothing at rest, such as a side stop, because that would
put energy into its spring.

Friction acts halfway between the faces that overlap at the point, not at the point itself. Where that place does not
slip, the point still moves along its face as the body turns, by half the penetration times the rotation. The place that
is remembered moves with it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..problem.quantities import Array, Integers
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
        rough = (scene.friction > 0) & (scene.points.bears > 0)
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
    g, rate, _, _ = gap(points, i, frame, before, before)
    if g >= 0:
        return False
    dashpot, inertia = row(points.k[i], points.c[i], h, points.weight[i], beta, ringing, points.overdamped[i])
    acceleration = (gap(points, i, frame, after, after)[1] - rate) / h
    pressing = -(points.k[i] * g + dashpot * rate + inertia * acceleration)
    dragging = impratio * inertia * along(points, i, frame, after)[2] / h
    return pressing > 0 and abs(dragging) <= points.friction[i] * pressing


@jitable
def deepest(points: Points, joints: Joints, j: int, frame: Array) -> int:
    """The deepest point of a joint, -1 where none is closed."""
    found, most = -1, 0.0
    for i in range(len(points.k)):
        if joints.of[i] == j and depth(points, i, frame) > most:
            found, most = i, depth(points, i, frame)
    return found


@jitable
def presses(points: Points, body: int, frame: Array) -> bool:
    """Whether a contact of a body is closed that bears nothing while the scene is at rest."""
    for i in range(len(points.k)):
        own = points.body[i] == body or points.face_body[i] == body
        if own and points.bears[i] == 0 and depth(points, i, frame) > 0:
            return True
    return False


@jitable
def rolled(points: Points, i: int, before: Array, frame: Array, from_: Array, q: Array) -> float:
    """How far point i moves along its face in a step without slip, as the bodies turn [m].

    Args:
        points: the contacts.
        i: the point.
        before, frame: frames before and after the step.
        from_, q: poses before and after it.
    """
    turned, face = q[3 * points.body[i] + 2] - from_[3 * points.body[i] + 2], points.face_body[i]
    if face >= 0:
        turned -= q[3 * face + 2] - from_[3 * face + 2]
    return -0.25 * turned * (depth(points, i, before) + depth(points, i, frame))


@jitable
def put_back(
    points: Points, joints: Joints, j: int, i: int, before: Array, from_: Array, q: Array, frame: Array
) -> None:
    """Shift the body on joint j so that point i, the deepest of the joint and sticking, is where it stuck.

    Args:
        points: the contacts.
        joints: the joints, whose state is brought up to date.
        j, i: the joint and the point, -1 where the deepest point does not stick.
        before, from_: frame and pose before the step.
        q, frame: the pose after the step and its frame, which are changed.
    """
    if i < 0 or joints.stuck[j] != i:
        joints.stuck[j] = i
        if i >= 0:
            joints.anchor[j] = along(points, i, frame, q)[0]
        return
    joints.anchor[j] += rolled(points, i, before, frame, from_, q)
    drift, body = along(points, i, frame, q)[0] - joints.anchor[j], joints.body[j]
    nx, nz = direction(points, i, frame)
    frame[body, 0], frame[body, 1] = q[3 * body] - drift * nz, q[3 * body + 1] + drift * nx
    if presses(points, body, frame):
        frame[body, 0], frame[body, 1] = q[3 * body], q[3 * body + 1]
    else:
        q[3 * body], q[3 * body + 1] = frame[body, 0], frame[body, 1]
