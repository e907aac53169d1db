"""Rows: bodies, contact lines and edges of faces, each with its numbers by name, for compiled functions.

Numbers that are used together are stored together: a step of some thousand lines spends most of its time on memory.
Vectors have d = 2 numbers in the plane and 3 in space. Spins, moments and vectors along a face have s = 1 and 3.
Positions are those at rest, and the motion is counted from there. The axes of a body are those of the world at rest.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..problem.masonry.laws.joint_law import Law
from ..rows import Fields, integers, numbers, row_type, short_integers, vectors

POINT_ON_FIXED_BLOCK = -2
"""Number of the face of a line where the point is on a fixed block and the face on the body."""
DISSIPATED_BY_LAWS = ("tension", "slip", "crushing", "joint_ends", "encounter_ends")
"""Energy that laws of joints dissipate in tension, slip and crushing, and lines of joints and of other contacts at the
ends of faces."""


class Kinds(NamedTuple):
    """The kinds of rows.

    Args:
        body: a rigid body.
        line: a contact line, in space a contact point: a point of a body on the face of another body or fixed block.
        edge: an edge of a face, of which one in the plane has two.
        tangent: a tangential direction of a line that sticks rigidly. A line has d - 1 of them.
        total: what is booked for all lines together [J]: `friction`, what is in the shear springs included, `ground`,
            the work of ground and supports, and `DISSIPATED_BY_LAWS`; `ground_acceleration` is that
            of the last step [m/s2].
        pending: force and moment of a line on a body that wait until all threads have pressed, see `thread`.
    """

    body: np.dtype[np.void]
    line: np.dtype[np.void]
    edge: np.dtype[np.void]
    tangent: np.dtype[np.void]
    total: np.dtype[np.void]
    pending: np.dtype[np.void]


@lru_cache
def kinds(d: int) -> Kinds:
    """The kinds of rows of the plane, d = 2, or of space, d = 3."""
    s = 1 if d == 2 else 3
    fields = (
        _body(d, s),
        _line(d, s),
        _edge(d),
        _tangent(d, s),
        [*numbers("friction", "ground", *DISSIPATED_BY_LAWS), *vectors(d, "ground_acceleration")],
        [*integers("body"), *vectors(d, "force"), *vectors(s, "moment")],
    )
    return Kinds(*map(row_type, fields))


def _body(d: int, s: int) -> Fields:
    flat = [*numbers("angle"), *vectors(2, "rotation")]
    deep = [*vectors(4, "quaternion"), ("rotation", float, (3, 3)), *vectors(3, "momentum")]
    deep += [("inverse_in_world", float, (3, 3))]  # inverse inertia in the axes of the world at the pose [1/(kg m2)]
    return [
        *numbers("mass"),  # [kg]
        *vectors(d, "inverse_mass"),  # along the axes, zero where a guide holds the body [1/kg]
        ("inverse_inertia", float, (s, s)),  # in its axes [1/(kg m2)]
        *vectors(d, "rest"),  # centroid at rest [m]
        *vectors(d, "place"),  # displacement from there [m]
        *(flat if d == 2 else deep),  # rotation from rest, see `rotation`
        *vectors(d, "velocity"),  # half a step before the pose [m/s]
        *vectors(s, "spin"),  # likewise, in the axes of the world at the pose [rad/s]
        *vectors(d, "force"),  # at the pose [N]
        *vectors(s, "moment"),  # likewise [N m]
    ]


def _line(d: int, s: int) -> Fields:
    return [
        # what each step reads and writes
        *short_integers("body", "face"),  # that carries the point, and of the face, -1 or POINT_ON_FIXED_BLOCK
        *short_integers("support"),  # the support that moves a fixed block, -1 for none
        *short_integers("group"),  # number of the account
        *vectors(d, "at"),  # the point from the centroid of its body [m]
        *vectors(d, "between"),  # from the point of the face to the point at rest, zero for a line of a joint [m]
        *vectors(d, "origin"),  # a point of the face from the centroid of its body [m]
        *vectors(d, "normal"),  # unit vector out of the face, of a POINT_ON_FIXED_BLOCK into that of the body
        *numbers(*Law._fields, "c_s"),  # of the law, and the dashpot along the face [N s/m]
        *numbers("margin"),  # square of the least distance of the origin from the end of the face, or infinite [m2]
        *numbers("push", "dashpot_force"),  # force along the normal, and of the dashpot, of the last step [N]
        *numbers("depth", "rate"),  # overlap, and growth of the gap, in the last step [m, m/s]
        *vectors(s, "shear_force"),  # friction of the shear spring in the last step [N]
        *vectors(s, "shear_state"),  # stretch of the shear spring [m], or last rigid friction [N], see `friction`
        *short_integers("pending", "face_pending"),  # its rows of forces that wait, 0 for none, see `thread`
        *short_integers("past"),  # 1 for a line that was past the end of its face then
        # what a step reads where a line touches or slides off
        *short_integers("fixed"),  # number of the fixed block of its face among these, -1 where that is a body
        *numbers("due"),  # what its spring is still to do for a touch in this step, see `touches` [kg]
        *numbers("widest"),  # largest gap so far [m]
        *short_integers("first", "last"),  # the edges of the face
        *short_integers("own_first", "own_last"),  # the edges of the face of its own body
        *numbers("sense"),  # 1 where its body is above its joint, -1 where it is below
    ]


def _edge(d: int) -> Fields:
    return [
        *vectors(d, "normal"),  # unit vector out of it in the plane of the face
        *numbers("reach"),  # how far the face reaches along it from the centroid of the body [m]
        *numbers("band"),  # distance beyond over which the normal of a contact turns [m]
    ]


def _tangent(d: int, s: int) -> Fields:
    return [
        *integers("body", "face", "support"),  # those of its line, so that sweeps need no lines
        *numbers("limit"),  # the most that the face holds in this step [N s]
        *vectors(d, "direction"),  # unit vector
        *vectors(s, "lever", "lever_on_face"),  # moment of a unit impulse about the two centroids [m]
        *vectors(s, "spin", "spin_of_face"),  # angular velocity that it gives to the two bodies [1/(kg m)]
        *numbers("compliance", "coupling"),  # slip by a unit impulse along its direction, along the other [1/kg]
        *numbers("stiffness", "shared"),  # impulse that stops a unit slip along its direction, along the other [kg]
        *numbers("impulse", "slip"),  # [N s], and the slip before the forces act [m/s]
        *numbers("drift"),  # slip that turning bodies gain from the pose to the middle of the step [m/s]
    ]


MAY_BE_INFINITE = ("k_s", "margin")
"""Numbers that may be infinite: of a line that sticks rigidly, and of a face without an end."""
