"""The system in space: bodies, contact points, faces' edges and links, each a row of named numbers for compiled code.

Positions are those at rest, and the motion is counted from there. The axes of a body are those of the world at rest.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, moment
from ...scene.ground import Ground
from ..system import Row, Rows, Supports

AXES = "xyz"


def three(*names: str) -> list[tuple[str, type]]:
    """Fields of vectors: each name with _x, _y and _z."""
    return [(f"{name}_{axis}", float) for name in names for axis in AXES]


def numbers(*names: str) -> list[tuple[str, type]]:
    """Fields of numbers."""
    return [(name, float) for name in names]


BODY = np.dtype(
    [
        *numbers("mass"),  # [kg]
        *numbers(*(f"ease_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz"))),  # inverse inertia [1/(kg m2)]
        *numbers("x0", "y0", "z0"),  # centroid at rest [m]
        *numbers("x", "y", "z"),  # displacement from there [m]
        *numbers("qw", "qx", "qy", "qz"),  # rotation from rest, a unit quaternion
        *numbers(*(f"turn_{row}{column}" for row in AXES for column in AXES)),  # R - 1, with R the rotation
        *numbers("vx", "vy", "vz"),  # velocity half a step before the pose [m/s]
        *three("momentum"),  # angular momentum in the axes of the world, then too [N m s]
        *numbers("wx", "wy", "wz"),  # angular velocity of that momentum at the pose, in the axes of the world [rad/s]
        *numbers("fx", "fy", "fz"),  # force at the pose [N]
        *three("moment"),  # moment at the pose [N m]
    ]
)
"""A rigid body."""

POINT = np.dtype(
    [
        ("body", np.int64),  # the body that carries the point
        ("face", np.int64),  # the body of the face, -1 for a fixed block
        ("support", np.int64),  # the support that moves a fixed block, -1 for none
        ("group", np.int64),  # number of the account
        ("corner", np.int64),  # 0 for a point of a joint; of a corner near a face see `contact.cornered`
        *three("at"),  # the point from the centroid of its body [m]
        *three("origin"),  # a point of the face from the centroid of its body [m]
        *three("between"),  # from there to the point at rest, zero for a point of a joint [m]
        *three("normal"),  # unit vector out of the face
        *numbers("k", "c", "k_s", "c_s"),  # springs and dashpots along the normal and the face
        ("friction", float),  # coefficient [-]
        ("margin", float),  # square of the least way along the face to its end [m2]
        *((name, np.int64) for name in ("first", "last")),  # the edges of the face
        *((name, np.int64) for name in ("own_first", "own_last")),  # the edges of the face of its own body
        *three("grip"),  # stretch of the shear spring [m], or rigid friction of the last step [N], in axes of the face
        *numbers("push", "pressed"),  # force, and force of the dashpot, of the last step [N]
        *three("dragged"),  # friction of the last step [N]
        ("widest", float),  # largest gap so far [m]
    ]
)
"""A contact point: a point of a body on the face of another body or of a fixed block."""

EDGE = np.dtype([*three("way"), *numbers("reach", "band")])
"""An edge of a face: its normal in the plane of the face, how far the face reaches along it from the centroid of the
body [m], and the way beyond over which the normal of a contact turns [m]."""

WAY = np.dtype(
    [
        *three("way"),  # a direction along the face
        *three("lever", "other"),  # moment of a unit impulse about the two centroids [m]
        *three("turn", "counter"),  # angular velocity that it gives to the two bodies [1/(kg m)]
        *numbers("light", "cross"),  # slip along the way that it makes, and along the other way [1/kg]
        *numbers("impulse", "sliding"),  # [N s], and the slip before the forces act [m/s]
    ]
)
"""One of the two ways along its face of a point that sticks rigidly."""

LINK = np.dtype(
    [
        ("body", np.int64),  # the body that is held
        ("anchor", np.int64),  # the body of the other end, -1 for the ground
        *three("at"),  # where, from its centroid [m]
        *three("origin"),  # the other end from the centroid of the anchor [m]
        *three("between"),  # from the anchor at rest [m]; components of a force [N]
        *numbers("k", "c"),  # spring and dashpot [N/m, N s/m]
        *numbers("reach", "strength", "push"),  # slack length of a tie [m], and its yield either way [N]
        *numbers("drawn", "ultimate", "broken"),  # plastic elongation, its limit [m], time [s]
        ("pulled", float),  # force of a damper in the last step [N]
    ]
)
"""A tie, a damper or a constant force on a point of a body, from the ground or from another body."""


class System(NamedTuple):
    """All that stands and acts in space, and its motion. `ways` is room for two rows of each point."""

    bodies: Rows
    lines: Rows
    edges: Rows
    ways: Rows
    ties: Rows
    dampers: Rows
    forces: Rows
    ground: Ground
    supports: Supports


@inlined
def place_of(body: Row) -> Vector:
    """Displacement of the centroid from rest [m]."""
    return body.x, body.y, body.z


@inlined
def velocity_of(body: Row) -> Vector:
    """Velocity of the centroid [m/s]."""
    return body.vx, body.vy, body.vz


@inlined
def spin_of(body: Row) -> Vector:
    """Angular velocity in the axes of the world [rad/s]."""
    return body.wx, body.wy, body.wz


@inlined
def momentum_of(body: Row) -> Vector:
    """Angular momentum in the axes of the world [N m s]."""
    return body.momentum_x, body.momentum_y, body.momentum_z


@inlined
def at_of(row: Row) -> Vector:
    """Where a point is on its body, from the centroid at rest [m]."""
    return row.at_x, row.at_y, row.at_z


@inlined
def origin_of(row: Row) -> Vector:
    """Where a point or an anchor is on the other body, from its centroid at rest [m]."""
    return row.origin_x, row.origin_y, row.origin_z


@inlined
def between_of(link: Row) -> Vector:
    """The vector from the anchor of a link or from the face to the point at rest [m], or a force [N]."""
    return link.between_x, link.between_y, link.between_z


@inlined
def normal_of(point: Row) -> Vector:
    """The normal of a face at rest."""
    return point.normal_x, point.normal_y, point.normal_z


@inlined
def way_of(row: Row) -> Vector:
    """The direction of an edge's normal, or of friction."""
    return row.way_x, row.way_y, row.way_z


@inlined
def grip_of(point: Row) -> Vector:
    """Shear spring or rigid friction of a point, in the axes of the face."""
    return point.grip_x, point.grip_y, point.grip_z


@inlined
def keep_grip(point: Row, grip: Vector) -> None:
    """Keep the shear spring or the rigid friction of a point."""
    point.grip_x, point.grip_y, point.grip_z = grip[0], grip[1], grip[2]


@inlined
def add_force(body: Row, arm: Vector, force: Vector) -> None:
    """Add a force at an arm from the centroid of a body [N]."""
    body.fx += force[0]
    body.fy += force[1]
    body.fz += force[2]
    add_moment(body, moment(arm, force))


@inlined
def add_moment(body: Row, turning: Vector) -> None:
    """Add a moment on a body [N m]."""
    body.moment_x += turning[0]
    body.moment_y += turning[1]
    body.moment_z += turning[2]


@inlined
def displaced_support(supports: Supports, i: int) -> Vector:
    """Where support i is, from rest [m]."""
    return supports.moved[i, 0], supports.moved[i, 1], supports.moved[i, 2]


@inlined
def moving_support(supports: Supports, i: int) -> Vector:
    """Velocity of support i [m/s]."""
    return supports.moving[i, 0], supports.moving[i, 1], supports.moving[i, 2]
