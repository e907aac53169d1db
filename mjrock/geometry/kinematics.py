"""Kinematics of rigid bodies: gaps between points and faces, their rates, slip, lengths of ties.

A contact is a point of one body and a face of another body or of the ground. At a pose it has a gap, the normal of the
face, and the arms from the two centroids to the point. Rates follow from the velocity of the point relative to the body
of the face. The independent solvers in `mjrock.reference` and `mjrock.distinct` have formulas of their own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled, inlined
from ..quantities import Array, Integers
from .frames import Freedom, displaced, linear, place, push_body, rotation_change, spin, take_frames
from .vectors import Vector, dot, minus, norm, plus, scaled, spun, tangent, tangents, vector


class Places(NamedTuple):
    """Contact points, the faces that they meet and their law, as columns for compiled functions.

    Vectors have d = 2 or 3 numbers.

    Args:
        axes: of the freedom of the bodies, see `Freedom`.
        body: the body that carries each point, shape (m,).
        at: position of the point from the centroid of that body, at rest [m], shape (m, d).
        face_body: the body whose face the point meets, -1 for the ground, shape (m,).
        face_at: origin of the face from the centroid of its body, at rest, or from the origin of the world [m], (m, d).
        normal: unit vector out of the face at rest, shape (m, d).
        between: vector from the origin of the face to the point, at rest [m], shape (m, d).
        radius: of the spheres that stand for the points in MuJoCo [m].
        joint: number of the joint that each point belongs to, shape (m,).
        law: rows of the law of each, see `joint_law.LAW_ROW`, shape (m,).
        k, c: spring [N/m] and dashpot [N s/m] of each, shape (m,), which are columns of the law.
        friction: coefficient of friction, zero for none [-], shape (m,), likewise.
        tension, cohesion: strength of the bond of each in tension, and in shear without pressure [N], shape (m,).
    """

    axes: tuple[int, ...]
    body: Integers
    at: Array
    face_body: Integers
    face_at: Array
    normal: Array
    between: Array
    radius: float
    joint: Integers
    law: NDArray[np.void]
    k: Array
    c: Array
    friction: Array
    tension: Array
    cohesion: Array

    @property
    def freedom(self) -> Freedom:
        """How the bodies may move."""
        return Freedom(self.axes)


class LinkEnds(NamedTuple):
    """The ends of links between points of two bodies, or of a body and the ground, as columns for compiled functions.

    Args:
        axes: of the freedom of the bodies, see `Freedom`.
        body: the body at the first end of each link, shape (t,).
        at: position of that end from the centroid of its body, at rest [m], shape (t, d).
        anchor_body: the body of the anchor, -1 for the ground, shape (t,).
        anchor_at: the anchor from the centroid of its body, at rest, or from the origin of the world [m], shape (t, d).
        between: vector from the anchor to the first end, at rest [m], shape (t, d).
    """

    axes: tuple[int, ...]
    body: Integers
    at: Array
    anchor_body: Integers
    anchor_at: Array
    between: Array


class Ties(NamedTuple):
    """Links with a spring, as columns for compiled functions.

    Args:
        links: their ends.
        k: stiffness [N/m], shape (t,).
        reach: length up to which the tie is slack [m], shape (t,). It grows as the tie yields, and is infinite once
            the tie has broken.
        stretch: elongation at which the tie yields [m], infinite for one that does not, shape (t,).
        limit: length beyond which the tie breaks [m], infinite for one that never does, shape (t,).
        squeeze: shortening below its reach at which it yields [m], zero for one that only pulls, shape (t,).
    """

    links: LinkEnds
    k: Array
    reach: Array
    stretch: Array
    limit: Array
    squeeze: Array


class AppliedForces(NamedTuple):
    """Forces that keep size and direction and follow a point of a body, as columns for compiled functions.

    Args:
        axes: of the freedom of the bodies, see `Freedom`.
        body: the body that each force acts on, shape (f,).
        at: position of its point from the centroid of that body, at rest [m], shape (f, d).
        force: its components [N], shape (f, d).
    """

    axes: tuple[int, ...]
    body: Integers
    at: Array
    force: Array


class Meeting(NamedTuple):
    """A point and its face at a pose.

    Args:
        gap: between point and face [m]; a negative gap is a penetration.
        normal: of the face, in the world.
        offset: from the origin of the face to the point [m].
        arm, face_arm: from the centroids of the two bodies to the point [m]; of the ground no arm is taken.
    """

    gap: float
    normal: Vector
    offset: Vector
    arm: Vector
    face_arm: Vector


class Gap(NamedTuple):
    """How a gap, or the slack of a tie, changes.

    Args:
        value: the gap [m].
        rate: its rate J v [m/s], with v the velocities.
        linear: J a [m/s2], with a the accelerations. The second rate is linear + swept.
        swept: the part that is quadratic in the velocities, centripetal and Coriolis [m/s2].
    """

    value: float
    rate: float
    linear: float
    swept: float


@inlined
def meeting(places: Places, i: int, frames: Array) -> Meeting:
    """Where point i and its face meet at a pose.

    The gap is that at rest plus the change by displacements. These are far smaller than the vectors between points and
    faces, and so is their rounding, which a stiff spring turns into a force.
    """
    axes, body, face = places.axes, places.body[i], places.face_body[i]
    at, normal, between = vector(places.at, i, axes), vector(places.normal, i, axes), vector(places.between, i, axes)
    relative, drawn_gap = displaced(place(frames, body, axes), frames, body, at), dot(normal, between)
    arm = plus(at, rotation_change(frames, body, at))
    if face < 0:
        offset = plus(between, relative)
        return Meeting(drawn_gap + dot(normal, relative), normal, offset, arm, offset)
    at = vector(places.face_at, i, axes)
    relative = minus(relative, displaced(place(frames, face, axes), frames, face, at))
    offset, turning = plus(between, relative), rotation_change(frames, face, normal)
    face_arm = plus(plus(at, rotation_change(frames, face, at)), offset)
    gap = drawn_gap + (dot(normal, relative) + dot(turning, offset))
    return Meeting(gap, plus(normal, turning), offset, arm, face_arm)


@inlined
def where_friction_acts(places: Places, meets: Meeting) -> Meeting:
    """The same meeting, with arms to the point at which MuJoCo applies friction: halfway between the surface of the
    sphere and the face."""
    below = scaled(0.5 * meets.gap + places.radius, meets.normal)
    return Meeting(meets.gap, meets.normal, meets.offset, minus(meets.arm, below), minus(meets.face_arm, below))


@inlined
def relative_velocity(places: Places, i: int, meets: Meeting, frames: Array, v: Array) -> Vector:
    """Velocity of point i, at the ends of the arms, relative to the body of its face [m/s].

    For accelerations it is the part that is linear in them [m/s2].
    """
    axes, body, face = places.axes, places.body[i], places.face_body[i]
    moving = plus(linear(v, body, axes), spun(spin(frames, v, body, axes), meets.arm))
    if face < 0:
        return moving
    return minus(moving, plus(linear(v, face, axes), spun(spin(frames, v, face, axes), meets.face_arm)))


@inlined
def turned_vector(a: Vector, frames: Array, body: int) -> Vector:
    """A vector of a body, or of the ground, in the axes of the world."""
    return a if body < 0 else displaced(a, frames, body, a)


@inlined
def face_tangents(normal: Vector, frames: Array, face: int) -> tuple[Vector, ...]:
    """`tangents_at` for a normal at rest and the body of the face."""
    if len(normal) == 2:
        return (turned_vector(tangent(normal), frames, face),)
    first, second = tangents(normal)
    return turned_vector(first, frames, face), turned_vector(second, frames, face)


@inlined
def tangents_at(places: Places, i: int, frames: Array) -> tuple[Vector, ...]:
    """Unit vectors along the face of point i: one in the plane, and in space the two `tangents` that turn with it."""
    return face_tangents(vector(places.normal, i, places.axes), frames, places.face_body[i])


@inlined
def swept_along(places: Places, i: int, meets: Meeting, frames: Array, v: Array, direction: Vector) -> float:
    """Acceleration of point i relative to its face, along a direction that turns with the face: the part that is
    quadratic in the velocities v [m/s2]."""
    axes, face = places.axes, places.face_body[i]
    turning = spin(frames, v, places.body[i], axes)
    swept = dot(direction, spun(turning, spun(turning, meets.arm)))
    if face >= 0:
        turning, velocity = spin(frames, v, face, axes), relative_velocity(places, i, meets, frames, v)
        swept -= dot(direction, spun(turning, plus(spun(turning, meets.face_arm), scaled(2.0, velocity))))
    return swept


@inlined
def gap(places: Places, i: int, frames: Array, v: Array, a: Array) -> Gap:
    """The gap of point i, and how it changes with the velocities v and accelerations a of the bodies."""
    meets = meeting(places, i, frames)
    velocity, normal = relative_velocity(places, i, meets, frames, v), meets.normal
    swept = swept_along(places, i, meets, frames, v, normal)
    return Gap(meets.gap, dot(normal, velocity), dot(normal, relative_velocity(places, i, meets, frames, a)), swept)


@inlined
def depth(places: Places, i: int, frames: Array) -> float:
    """Penetration of point i [m], negative where it is open."""
    return -meeting(places, i, frames).gap


@inlined
def push_apart(places: Places, i: int, meets: Meeting, frames: Array, force: Vector, total: Array) -> None:
    """Add a force on the body of point i, and its reaction on that of the face, to generalised forces [N]."""
    push_body(frames, places.body[i], meets.arm, force, total)
    if places.face_body[i] >= 0:
        push_body(frames, places.face_body[i], meets.face_arm, scaled(-1.0, force), total)


@inlined
def slack(ties: Ties, i: int, frames: Array, v: Array, a: Array) -> Gap:
    """Slack of tie i: the elongation up to which it does not pull [m], and its rates, as those of a `gap`."""
    links = ties.links
    at, axes, anchor = ends(links, i, frames), links.axes, links.anchor_body[i]
    span, velocity = at.span, link_velocity(links, i, at, frames, v)
    turning = spin(frames, v, links.body[i], axes)
    centripetal = spun(turning, spun(turning, at.arm))
    if anchor >= 0:
        turning = spin(frames, v, anchor, axes)
        centripetal = minus(centripetal, spun(turning, spun(turning, at.anchor_arm)))
    length = norm(span)
    direction = scaled(1 / length, span)
    longer = dot(direction, velocity)
    swept = dot(direction, centripetal) + (dot(velocity, velocity) - longer * longer) / length
    pulling = dot(direction, link_velocity(links, i, at, frames, a))
    return Gap(ties.reach[i] - length, -longer, -pulling, -swept)


@inlined
def opening(places: Places, ties: Ties, i: int, frames: Array, v: Array, a: Array) -> Gap:
    """The gap of contact i, or the slack of the tie that follows after the contacts."""
    if i < len(places.body):
        return gap(places, i, frames, v, a)
    return slack(ties, i - len(places.body), frames, v, a)


@inlined
def stretch(ties: Ties, i: int, frames: Array, v: Array) -> tuple[float, float]:
    """Elastic elongation of tie i, and by how much it yields at this pose, in tension or in compression [m].

    The reach of the tie is changed by the yielding. The velocities v of the bodies make no difference.
    """
    pulled = -slack(ties, i, frames, v, v).value
    yielded = max(pulled - ties.stretch[i], 0.0)
    if ties.squeeze[i] == 0:
        ties.reach[i] += yielded
        return max(pulled - yielded, 0.0), yielded
    yielded += min(pulled + ties.squeeze[i], 0.0)
    ties.reach[i] += yielded
    return pulled - yielded, abs(yielded)


@inlined
def snaps(ties: Ties, i: int, frames: Array, v: Array) -> bool:
    """Whether tie i is longer than its limit and breaks now. It is slack from then on."""
    if ties.limit[i] == math.inf or ties.reach[i] == math.inf:
        return False
    if ties.reach[i] - slack(ties, i, frames, v, v).value <= ties.limit[i]:
        return False
    ties.reach[i] = math.inf
    return True


@inlined
def displacement(forces: AppliedForces, i: int, frames: Array) -> Vector:
    """Displacement of the point of force i from rest [m]."""
    body, axes = forces.body[i], forces.axes
    return displaced(place(frames, body, axes), frames, body, vector(forces.at, i, axes))


def gaps(places: Places, q: Array) -> Array:
    """Gap of every point [m] at many poses of shape (steps, coordinates), shape (steps, m)."""
    values, freedom = np.empty((len(q), len(places.body))), places.freedom
    _gaps(places, q, freedom.frames(q.shape[1] // freedom.nq), values)
    return values


@compiled
def _gaps(places: Places, q: Array, frames: Array, values: Array) -> None:
    for step in range(len(q)):
        take_frames(q[step], frames, places.axes)
        for i in range(len(places.body)):
            values[step, i] = -depth(places, i, frames)


class Ends(NamedTuple):
    """The two ends of a link at a pose.

    Args:
        span: from the anchor to the point [m].
        arm, anchor_arm: from the centroids of the two bodies to them [m]; on the ground there is no such arm.
    """

    span: Vector
    arm: Vector
    anchor_arm: Vector


@inlined
def ends(links: LinkEnds, i: int, frames: Array) -> Ends:
    """The ends of link i."""
    axes, body, anchor = links.axes, links.body[i], links.anchor_body[i]
    at = vector(links.at, i, axes)
    arm = plus(at, rotation_change(frames, body, at))
    span = plus(vector(links.between, i, axes), plus(place(frames, body, axes), minus(arm, at)))
    if anchor < 0:
        return Ends(span, arm, arm)
    at = vector(links.anchor_at, i, axes)
    anchor_arm = plus(at, rotation_change(frames, anchor, at))
    return Ends(minus(span, plus(place(frames, anchor, axes), minus(anchor_arm, at))), arm, anchor_arm)


@inlined
def link_velocity(links: LinkEnds, i: int, at: Ends, frames: Array, v: Array) -> Vector:
    """Velocity of link i's point relative to its anchor [m/s]; for accelerations the part that is linear in them."""
    axes, body, anchor = links.axes, links.body[i], links.anchor_body[i]
    velocity = plus(linear(v, body, axes), spun(spin(frames, v, body, axes), at.arm))
    if anchor < 0:
        return velocity
    return minus(velocity, plus(linear(v, anchor, axes), spun(spin(frames, v, anchor, axes), at.anchor_arm)))
