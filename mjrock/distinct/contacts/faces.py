"""Contact lines over their faces: where a line is at a pose, how fast it moves, and where its face ends.

A line beyond the outline of its face has moved past an end of it. The nearest point of the outline then presses on the
face of the block that carries the line. Past the outline of that face too the contact has no force, and it has none
once the two faces are turned away from each other. A line that the contact search has found has no end.

A face ends at two ends in the plane, and at the edges of its outline in space. Both are rows of edges.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, components, dot, minus, norm, plus, read, scaled, spun, vector
from ...problem.wall.rest_geometry import Face
from ...quantities import Array, Integers
from ...rows import Row, Rows, rows
from ..rotation import in_body, in_world, may_face_away, rotation_change
from ..rows import POINT_ON_FIXED_BLOCK, kinds
from ..supports import Supports
from ..system import System

GAP_OF_OPEN = 1.0
"""Gap of a line that has left its face [m]."""
TURNED_OVER = 2 * GAP_OF_OPEN
"""Gap of a line whose block has turned over [m]. The contact does not close again."""
OVERHANG = 0.02
"""Length by which a face is taken to be longer at either end, over the shorter of its length and that of the face that
it meets [-]. The points of a block that stands flush lie at the very end of the face, and move to and fro there. Over
the same length beyond, the normal turns from that of the face to that of the face of the block above."""
ROUNDS = 3
"""Rounds over the edges of a face in the search for the nearest place of its outline. One is enough in the plane and
for a rectangle."""


def edges_of(faces: Sequence[Face], origins: Array, met: Sequence[Face]) -> tuple[Rows, Integers]:
    """The edges of faces, which are taken to be longer by `OVERHANG` at either end, and where those of each begin.

    Args:
        faces: of joints.
        origins: a point of the block of each [m], shape (faces, d).
        met: the face of the other block of the joint of each.

    Returns:
        The edges, and the number of the first one of each face, with that after the last, shape (faces + 1,).
    """
    begin = np.cumsum([0, *(len(face.edge_normals) for face in faces)])
    edges = rows(kinds(origins.shape[1]).edge, int(begin[-1]))
    pairs = zip(faces, met, strict=True)
    shapes = np.array([(len(face.edge_normals), len(face.corners), len(other.corners)) for face, other in pairs])
    for shape in np.unique(shapes, axis=0):
        alike = np.flatnonzero((shapes == shape).all(axis=1)).tolist()
        normals, corners, others = (
            np.array(part)
            for part in zip(*((faces[i].edge_normals, faces[i].corners, met[i].corners) for i in alike), strict=True)
        )
        along = normals.swapaxes(1, 2)
        places = (corners - origins[alike][:, None]) @ along  # (faces, corners, edges)
        extent = np.minimum(np.ptp(places, axis=1), np.ptp(others @ along, axis=1))
        index = begin[alike][:, None] + np.arange(len(normals[0]))
        edges["normal"][index], edges["reach"][index] = normals, places.max(axis=1) + OVERHANG * extent
        edges["band"][index] = OVERHANG * (1 + 2 * OVERHANG) * extent
    return edges, begin


def margins(lines: Rows, edges: Rows) -> Array:
    """Square of the smallest distance of each line from the end of its face [m2], shape (m,)."""
    margin, counts = np.empty(len(lines)), lines["last"] - lines["first"]
    for count in np.unique(counts):
        numbers = np.flatnonzero(counts == count)
        edge_numbers = lines["first"][numbers][:, None] + np.arange(count)
        along = (edges["normal"][edge_numbers] @ lines["origin"][numbers][:, :, None])[:, :, 0]
        margin[numbers] = np.maximum((edges["reach"][edge_numbers] - along).min(axis=1), 0.0)
    return margin**2


@inlined
def is_beside(edges: Rows, first: int, last: int, place: Vector) -> bool:
    """Whether a place on a body [m] lies beyond the outline of a face of it, whose edges are numbered."""
    beside = False
    for i in range(first, last):
        if dot(components(edges[i].normal, place), place) > edges[i].reach:
            beside = True
    return beside


@inlined
def pulled_inside(edges: Rows, first: int, last: int, place: Vector) -> tuple[Vector, float]:
    """The point of the outline that is nearest to a place on a body [m], and the distance of the place beyond it, over
    the width of its band.
    """
    inside, share = place, 0.0
    for sweep in range(ROUNDS):
        for i in range(first, last):
            edge = edges[i]
            outwards = components(edge.normal, place)
            excess = dot(outwards, inside) - edge.reach
            if excess > 0:
                inside = minus(inside, scaled(excess, outwards))
                if sweep == 0:
                    share = max(share, excess / edge.band)
    return inside, share


class Meeting(NamedTuple):
    """A line at a pose.

    Args:
        gap: [m].
        normal: out of the face.
        arm: from the centroid of the body to the line [m].
        face_arm: from the centroid of the body of the face to the line [m]; of a fixed block no arm is taken.
        past: whether the line is past the end of the face.
    """

    gap: float
    normal: Vector
    arm: Vector
    face_arm: Vector
    past: bool


@inlined
def position_over_face(system: System, line: Row) -> tuple[Vector, Vector, Vector, Vector]:
    """Position of the point of a line relative to its face, the normal of the face, and the arms, see `Meeting`."""
    body, at, normal = system.bodies[line.body], read(line.at), read(line.normal)
    change = rotation_change(body, at)
    arm, offset = plus(at, change), plus(read(line.between), plus(read(body.place), change))
    face_arm = arm
    if line.face >= 0:
        face, origin = system.bodies[line.face], read(line.origin)
        change = rotation_change(face, origin)
        offset = minus(offset, plus(read(face.place), change))
        face_arm = plus(plus(origin, change), offset)
        normal = plus(normal, rotation_change(face, normal))
    else:
        if line.support >= 0:
            offset = minus(offset, vector(system.supports.moved, line.support, at))
        if line.face == POINT_ON_FIXED_BLOCK:
            normal, arm = in_world(body, normal), minus(arm, offset)
    return offset, normal, arm, face_arm


@inlined
def meeting(system: System, line: Row) -> Meeting:
    """Where a line is."""
    body = system.bodies[line.body]
    offset, normal, arm, face_arm = position_over_face(system, line)
    gap = dot(normal, offset)
    if gap < 0 and line.margin < math.inf:
        turned = may_face_away(body) or (line.face >= 0 and may_face_away(system.bodies[line.face]))
        if turned and dot(normal, in_world(body, read(line.normal))) < 0:
            return Meeting(TURNED_OVER, normal, arm, face_arm, True)
        if dot(offset, offset) - gap * gap > line.margin:
            return past_face_edge(system, line, offset, Meeting(gap, normal, arm, face_arm, False))
    return Meeting(gap, normal, arm, face_arm, False)


@inlined
def past_face_edge(system: System, line: Row, offset: Vector, meet: Meeting) -> Meeting:
    """Where a line is that may have moved past the outline of its face, `offset` from its place there at rest [m]."""
    fixed = line.face < 0
    face, body = system.bodies[max(line.face, 0)], system.bodies[line.body]
    reached = plus(read(line.origin), offset if fixed else in_body(face, offset))
    inside, share = pulled_inside(system.edges, line.first, line.last, reached)
    if share == 0:
        return meet
    over = minus(reached, inside)
    from_outline = plus(scaled(meet.gap, meet.normal), over if fixed else in_world(face, over))  # from the outline
    own_normal = in_world(body, read(line.normal))
    gap = dot(own_normal, from_outline)
    along = minus(from_outline, scaled(gap, own_normal))
    place = minus(read(line.at), in_body(body, along))
    if is_beside(system.edges, line.own_first, line.own_last, place):
        gap = GAP_OF_OPEN
    normal = plus(meet.normal, scaled(min(share, 1.0), minus(own_normal, meet.normal)))
    normal = scaled(1 / norm(normal), normal)
    return Meeting(gap, normal, minus(meet.arm, along), minus(meet.face_arm, along), True)


@inlined
def relative_velocity(bodies: Rows, line: Row, supports: Supports, meet: Meeting) -> Vector:
    """Velocity of the point of a line over the face [m/s]."""
    body = bodies[line.body]
    velocity = plus(read(body.velocity), spun(read(body.spin), meet.arm))
    if line.face >= 0:
        face = bodies[line.face]
        of_face = plus(read(face.velocity), spun(read(face.spin), meet.face_arm))
        velocity = minus(velocity, of_face)
    elif line.support >= 0:
        velocity = minus(velocity, vector(supports.moving, line.support, velocity))
    return velocity


@inlined
def where_friction_rubs(meet: Meeting) -> Meeting:
    """The same meeting with arms to halfway into the overlap. The force along the normal turns the bodies alike there,
    and the gap has the same rate."""
    halfway = scaled(-0.5 * min(meet.gap, 0.0), meet.normal)
    return Meeting(meet.gap, meet.normal, plus(meet.arm, halfway), plus(meet.face_arm, halfway), meet.past)
