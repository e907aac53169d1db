"""Rows: bodies, contact lines, edges of faces and links, each with its numbers by name, for compiled functions.

What belongs together stands together in memory, which is what a step of some thousand lines takes its time for.
Vectors have d = 2 numbers in the plane and 3 in space. Spins, moments and vectors along a face have s = 1 and 3.
Positions are those at rest, and the motion is counted from there. The axes of a body are those of the world at rest.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..quantities import Array, Integers

Rows = NDArray[np.void]
Row = Any
"""One of the rows; its numbers are attributes."""


class Kinds(NamedTuple):
    """The kinds of rows.

    Args:
        body: a rigid body.
        line: a contact line, in space a contact point: a point of a body on the face of another body or fixed block.
        edge: an edge of a face, of which one in the plane has two.
        way: a direction along its face of a line that sticks rigidly. A line has d - 1 of them.
        link: a tie, a damper or a constant force on a point of a body, from the ground or from another body.
        total: what is booked for all lines together.
    """

    body: np.dtype[np.void]
    line: np.dtype[np.void]
    edge: np.dtype[np.void]
    way: np.dtype[np.void]
    link: np.dtype[np.void]
    total: np.dtype[np.void]


@lru_cache
def kinds(d: int) -> Kinds:
    """The kinds of rows of the plane, d = 2, or of space, d = 3."""
    s = 1 if d == 2 else 3
    turned = [("angle", float), ("turn", float, (2,))] if d == 2 else [
        ("quaternion", float, (4,)),
        ("turn", float, (3, 3)),
        ("momentum", float, (3,)),
    ]  # fmt: skip

    def number(*names: str) -> list[Any]:
        return [(name, float) for name in names]

    def integer(*names: str) -> list[Any]:
        return [(name, np.int64) for name in names]

    def vector(*names: str) -> list[Any]:
        return [(name, float, (d,)) for name in names]

    def spin(*names: str) -> list[Any]:
        return [(name, float, (s,)) for name in names]

    body = [
        *number("mass"),  # [kg]
        ("inverse_inertia", float, (s, s)),  # in its axes [1/(kg m2)]
        *vector("rest"),  # centroid at rest [m]
        *vector("place"),  # displacement from there [m]
        *turned,  # rotation from rest, see `turning`
        *vector("velocity"),  # half a step before the pose [m/s]
        *spin("spin"),  # likewise, in the axes of the world at the pose [rad/s]
        *vector("force"),  # at the pose [N]
        *spin("moment"),  # likewise [N m]
    ]
    line = [
        *integer("body", "face"),  # the body that carries the point, and that of the face, -1 for a fixed block
        *integer("support"),  # the support that moves a fixed block, -1 for none
        *integer("group"),  # number of the account
        *integer("corner"),  # 0 for a line of a joint; of a corner near a face see `contact.cornered`
        *vector("at"),  # the point from the centroid of its body [m]
        *vector("origin"),  # a point of the face from the centroid of its body [m]
        *vector("between"),  # from there to the point at rest, zero for a line of a joint [m]
        *vector("normal"),  # unit vector out of the face
        *number("k", "c", "k_s", "c_s"),  # springs and dashpots along the normal and the face
        *number("friction"),  # coefficient [-]
        *number("margin"),  # square of the least way along the face from the origin to its end [m2]
        *integer("first", "last"),  # the edges of the face
        *integer("own_first", "own_last"),  # the edges of the face of its own body
        *spin("grip"),  # stretch of the shear spring [m], or rigid friction of the last step [N], see `friction`
        *number("push", "pressed"),  # force, and force of the dashpot, of the last step [N]
        *spin("dragged"),  # friction of the shear spring in the last step [N]
        *number("widest"),  # largest gap so far [m]
    ]
    edge = [
        *vector("way"),  # its normal in the plane of the face
        *number("reach"),  # how far the face reaches along it from the centroid of the body [m]
        *number("band"),  # way beyond over which the normal of a contact turns [m]
    ]
    way = [
        *vector("way"),  # a direction along the face
        *spin("lever", "lever_on_face"),  # moment of a unit impulse about the two centroids [m]
        *spin("spin", "spin_of_face"),  # angular velocity that it gives to the two bodies [1/(kg m)]
        *number("compliance", "coupling"),  # slip along the way that it makes, and along the other way [1/kg]
        *number("impulse", "slip"),  # [N s], and the slip before the forces act [m/s]
    ]
    link = [
        *integer("body", "anchor"),  # the body that is held, and that of the other end, -1 for the ground
        *vector("at"),  # where, from its centroid [m]
        *vector("origin"),  # the other end from the centroid of the anchor [m]
        *vector("between"),  # from the anchor at rest [m]; components of a force [N]
        *number("k", "c"),  # spring and dashpot [N/m, N s/m]
        *number("reach", "strength", "push"),  # slack length of a tie [m], and its yield either way [N]
        *number("drawn", "ultimate", "broken"),  # plastic elongation, its limit [m], time [s]
        *number("pulled"),  # force of a damper in the last step [N]
    ]
    total = [*number("friction", "ground"), *vector("push")]  # see `system.Books`
    return Kinds(*(np.dtype(fields) for fields in (body, line, edge, way, link, total)))


def rows(kind: np.dtype[np.void], count: int, **columns: Array | Integers | float) -> Rows:
    """Rows with these columns, and zeros in the others."""
    table = np.zeros(count, dtype=kind)
    for name, values in columns.items():
        table[name] = values
    return table.view(np.recarray)


def joined(*tables: Rows) -> Rows:
    """Rows of one kind, one table after the other."""
    return np.concatenate(tables).view(np.recarray)
