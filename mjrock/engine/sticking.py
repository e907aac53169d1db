"""Sticking: after each step, the body on a sticking joint is shifted back by the drift of its deepest point.

Two things move an edge that friction holds. A friction row of MuJoCo stops the slip that a point has in the geometry at
the start of a step. In a step h a wall that turns at omega about its toe moves the toe by a term that the row does not
see, h^2 omega^2 / 2 times the horizontal distance of the toe from the centroid. And the row, which is a dashpot,
creeps. In a fall this adds up to some micrometres, and in an impact it may be as much. On a stiff base this presses the
wall against its side stop, and later rebounds meet the stop out of true. So each joint remembers where its deepest
sticking point stuck. The body that stands on the joint is not shifted where this would press a contact that bears
nothing at rest, such as a side stop, because that would put energy into its spring.

Friction acts halfway between the faces that overlap at the point, not at the point itself. Where that place does not
slip, the point still moves along its face as the body turns, by half the penetration times the rotation. The place that
is remembered moves with it.

In space it is the same along both tangents of the face. Only the displacement is put back: a spin about the normal is
left as it is, because two points that stick hardly creep against each other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..geometry.frames import coordinates, take_frames, turn_between
from ..geometry.kinematics import Meeting, Places, depth, gap, meeting, tangents_at, where_friction_acts
from ..geometry.vectors import Vector, dot, minus, spun
from ..quantities import Array, Integers
from ..scene.scene import Scene
from .rows import Points, Step, row_of
from .sliding import slipping

EQUAL = 1e-6
"""Difference of two penetrations, over the lesser one, that is rounding, as of the two ends of an edge in space [-]."""


class Joints(NamedTuple):
    """The joints whose points are put back, from the ground upwards.

    Args:
        of: the joint of each contact point, -1 where it has none, shape (m,).
        body: the body that stands on each joint, shape (joints,).
        stuck: the point of each joint that sticks, -1 where none does, shape (joints,).
        anchor: where that point stuck along each tangent of its face [m], shape (joints, 1 in the plane or 2).
    """

    of: Integers
    body: Integers
    stuck: Integers
    anchor: Array

    @classmethod
    def of_scene(cls, scene: Scene) -> Joints:
        """The joints of a scene in which every body stands on one other body or on the ground; otherwise none."""
        rough = (scene.contacts.friction > 0) & (scene.bears > 0)
        below = {
            int(body): set(scene.contacts.face_body[rough & (scene.contacts.body == body)])
            for body in scene.contacts.body[rough]
        }
        order: list[int] = []
        if all(len(bodies) == 1 for bodies in below.values()):
            order = sorted(below, key=lambda body: _bodies_below(body, below))
        of = np.full(len(scene.contacts.k), -1)
        for joint, body in enumerate(order):
            of[rough & (scene.contacts.body == body)] = joint
        count = scene.freedom.translations - 1
        return cls(of, np.array(order, dtype=np.int64), np.full(len(order), -1), np.zeros((len(order), count)))


def _bodies_below(body: int, below: dict[int, set[int]]) -> int:
    """How many bodies a body stands on, one on the other."""
    count = 0
    while body in below and count <= len(below):
        (body,) = below[body]
        count += 1
    return count


class StepMotion(NamedTuple):
    """The motion of the bodies in a step, of which pose and frames after it may still be changed.

    Args:
        step: its length and constants.
        impratio: of the model in it [-].
        before, after: velocities half a step before and after its pose, shape (n nv,).
        from_pose, pose: before and after it, shape (n nq,).
        from_frames, frames: those of these poses.
    """

    step: Step
    impratio: float
    before: Array
    after: Array
    from_pose: Array
    pose: Array
    from_frames: Array
    frames: Array


@inlined
def sticks(points: Points, i: int, motion: StepMotion) -> bool:
    """Whether point i was pressed and did not slide in a step.

    The friction row stops the slip with the force that this takes, as long as the force is within the cone.
    """
    places, frames, before, after, h = points.places, motion.from_frames, motion.before, motion.after, motion.step.h
    start = gap(places, i, frames, before, before)
    if start.value >= 0:
        return False
    dashpot, inertia = row_of(points, i, motion.step)
    acceleration = (gap(places, i, frames, after, after).rate - start.rate) / h
    pressing = -(places.k[i] * start.value + dashpot * start.rate + inertia * acceleration)
    slip = slipping(places, i, where_friction_acts(places, meeting(places, i, frames)), frames, after).speed
    return pressing > 0 and abs(motion.impratio * inertia * slip / h) <= places.friction[i] * pressing


@inlined
def deepest_point(places: Places, joints: Joints, j: int, frames: Array) -> int:
    """The deepest point of a joint, -1 where none is closed.

    On an edge in space two points are equally deep but for rounding. It is the one that stuck.
    """
    point, most, stuck = -1, 0.0, joints.stuck[j]
    if len(places.axes) == 3 and stuck >= 0 and depth(places, stuck, frames) > 0:
        point, most = stuck, (1 + EQUAL) * depth(places, stuck, frames)
    for i in range(len(places.body)):
        if joints.of[i] == j and depth(places, i, frames) > most:
            point, most = i, depth(places, i, frames)
    return point


@inlined
def presses_unloaded(points: Points, body: int, frames: Array) -> bool:
    """Whether a contact of a body is closed that bears nothing while the scene is at rest."""
    places = points.places
    for i in range(len(places.body)):
        of_body = places.body[i] == body or places.face_body[i] == body
        if of_body and points.bears[i] == 0 and depth(places, i, frames) > 0:
            return True
    return False


@inlined
def rolling_distance(places: Places, i: int, meets: Meeting, tangent: Vector, motion: StepMotion) -> float:
    """How far point i moves along a tangent of its face in a step without slip, as the bodies turn [m]."""
    axes, face = places.axes, places.face_body[i]
    turn = turn_between(motion.from_pose, motion.pose, places.body[i], axes)
    if face >= 0:
        turn = minus(turn, turn_between(motion.from_pose, motion.pose, face, axes))
    along = turn[0] if len(tangent) == 2 else dot(tangent, spun(turn, meets.normal))
    return -0.25 * along * (depth(places, i, motion.from_frames) + depth(places, i, motion.frames))


@inlined
def shift(frames: Array, body: int, tangent: Vector, distance: float) -> None:
    """Shift a body along a tangent by a distance [m]."""
    for axis in range(len(tangent)):
        frames[body, axis] += distance * tangent[axis]


@inlined
def put_back(points: Points, joints: Joints, j: int, i: int, motion: StepMotion) -> None:
    """Shift the body on joint j along its face so that point i, its deepest and sticking, is where it stuck.

    i is -1 where the deepest point does not stick. Joints, and pose and frames after the step, are brought up to date.
    """
    places, frames, body = points.places, motion.frames, joints.body[j]
    first, start = joints.stuck[j] != i, coordinates(places.axes) * body
    joints.stuck[j] = i
    if i < 0:
        return
    meets, tangents = meeting(places, i, frames), tangents_at(places, i, frames)
    for k in range(len(tangents)):
        place = dot(tangents[k], meets.offset)
        if first:
            joints.anchor[j, k] = place
        else:
            joints.anchor[j, k] += rolling_distance(places, i, meets, tangents[k], motion)
            shift(frames, body, tangents[k], joints.anchor[j, k] - place)
    if first:
        return
    pressed = presses_unloaded(points, body, frames)
    for axis in range(len(places.axes)):
        if pressed:
            frames[body, axis] = motion.pose[start + axis]
        else:
            motion.pose[start + axis] = frames[body, axis]


@inlined
def put_sticking_edges_back(points: Points, joints: Joints, motion: StepMotion) -> None:
    """Take the frames of the pose after a step, with sticking edges put back to where they stuck."""
    take_frames(motion.pose, motion.frames, points.places.axes)
    for j in range(len(joints.body)):
        i = deepest_point(points.places, joints, j, motion.frames)
        if i >= 0 and not sticks(points, i, motion):
            i = -1
        put_back(points, joints, j, i, motion)
