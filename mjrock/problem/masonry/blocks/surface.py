"""The surface of convex parts that are joined: what of their sides lies inside, and what lies in one plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy

from ....geometry import convex
from ....geometry.hull import Side
from ....quantities import Array, Flags
from .joints import SHORTEST_JOINT, Joint
from .joints_in_space import SpaceJoint, tangent_axes
from .polygon import Polygon
from .polyhedron import Polyhedron

LEFT_OF_SIDE = 1e-6
"""Part of the area of a side that may be left of one that lies inside [-]."""
PARALLEL_NORMALS = 1 - 1e-10
"""Cosine of the angle between the normals of two sides that may lie in one plane [-]."""


class Surface(NamedTuple):
    """The surface of parts that are joined.

    Args:
        sides: its plane pieces.
        corners: of these [m], shape (n, d), in the plane in order around the outline.
        inside: of each part, which of its own sides lie inside the whole, shape (sides,).
    """

    sides: tuple[Side, ...]
    corners: Array
    inside: tuple[Flags, ...]


def surface_in_plane(parts: Sequence[Polygon], joined: Sequence[Joint], close: float) -> Surface:
    """The surface of parts in the plane from where they lie on each other, which is within a distance [m].

    What is shorter than the shortest joint is left out. Parts of unlike lengths have sides of their own.
    """
    covered = [[list[Array]() for _ in part.sides] for part in parts]
    for joint in joined:
        for k, side in zip((joint.below, joint.above), joint.sides, strict=True):
            covered[k][side].append(np.array([joint.start, joint.end]))
    pieces, inside = list[Side](), []
    for i, part in enumerate(parts):
        uncovered = [uncovered_ends(side, covered[i][j], SHORTEST_JOINT * close) for j, side in enumerate(part.sides)]
        inside.append(np.array([not len(ends_left) for ends_left in uncovered]))
        pieces += [
            Side(ends, side.normal, (i,))
            for side, ends_left in zip(part.sides, uncovered, strict=True)
            for ends in ends_left
        ]
    lengths = [part.length for part in parts]
    loops = [_straightened(loop, lengths, close) for loop in _loops(pieces)]
    sides = tuple(side for loop in loops for side in loop)
    outer = max(range(len(loops)), key=lambda k: _area(loops[k]))
    ring = [side.corners[0] for side in loops[outer]]
    for loop in (loop for k, loop in enumerate(loops) if k != outer):
        hole = [side.corners[0] for side in loop]
        ring += [ring[0], *hole, hole[0]]
    return Surface(sides, np.array(ring), tuple(inside))


def surface_in_space(parts: Sequence[Polyhedron], joined: Sequence[SpaceJoint], close: float) -> Surface:
    """The surface of parts in space. A face that is covered in part is kept whole, since no block reaches what is
    covered. Faces in one plane are one side where that is convex."""
    covered = [np.zeros(len(part.faces)) for part in parts]
    for joint in joined:
        for i, side in zip((joint.below, joint.above), joint.sides, strict=True):
            covered[i][side] += joint.area
    sides, inside = list[Side](), []
    for k, part in enumerate(parts):
        areas = np.array([_area_in_space(side) for side in part.sides])
        inside.append(covered[k] > (1 - LEFT_OF_SIDE) * areas)
        sides += [side._replace(parts=(k,)) for side, hidden in zip(part.sides, inside[k], strict=True) if not hidden]
    merged = _merged(sides, close)
    corners = np.unique(np.concatenate([side.corners for side in merged]), axis=0)
    return Surface(tuple(merged), corners, tuple(inside))


def uncovered_ends(side: Side, covered: Sequence[Array], shortest: float) -> list[Array]:
    """The ends of what is left of an edge, shape (2, 2) each, without what is covered."""
    start, end = side.corners
    length = float(np.linalg.norm(end - start))
    direction = (end - start) / length
    spans = sorted(sorted(((ends - start) @ direction).tolist()) for ends in covered)
    uncovered, at = [], 0.0
    for low, high in [*spans, [length, length]]:
        if low - at > shortest:
            ends = start + at * direction if at > 0 else start, start + low * direction if low < length else end
            uncovered.append(np.array(ends))
        at = max(at, high)
    return uncovered


def _loops(pieces: Sequence[Side]) -> list[list[Side]]:
    """Pieces of edges in the order in which they follow each other, one list for each closed outline."""
    remaining, loops = list(pieces), []
    while remaining:
        loop = [remaining.pop(0)]
        while remaining:
            off = [float(np.linalg.norm(piece.corners[0] - loop[-1].corners[1])) for piece in remaining]
            closing = float(np.linalg.norm(loop[0].corners[0] - loop[-1].corners[1]))
            if closing <= min(off):
                break
            loop.append(remaining.pop(int(np.argmin(off))))
        loops.append(loop)
    return loops


def _straightened(loop: Sequence[Side], lengths: Sequence[float], close: float) -> list[Side]:
    """The pieces of a loop, those that lie on one line and are of parts of one length as one."""

    def goes_on(side: Side, piece: Side) -> bool:
        return _continues(side, piece, close) and lengths[side.parts[0]] == lengths[piece.parts[0]]

    if len(loop) > 1 and goes_on(loop[-1], loop[0]):
        turns = [i for i in range(len(loop)) if not goes_on(loop[i - 1], loop[i])]
        loop = [*loop[turns[0] :], *loop[: turns[0]]]
    sides = [loop[0]]
    for piece in loop[1:]:
        if goes_on(sides[-1], piece):
            last = sides.pop()
            x, z = along = piece.corners[1] - last.corners[0]
            normal = np.array([z, -x]) / np.hypot(*along) + 0.0
            ends = np.stack([last.corners[0], piece.corners[1]])
            sides.append(Side(ends, normal, tuple(sorted({*last.parts, *piece.parts}))))
        else:
            sides.append(piece)
    return sides


def _continues(side: Side, piece: Side, close: float) -> bool:
    """Whether a piece goes on along the line of the side before it."""
    off = (piece.corners - side.corners[0]) @ side.normal
    return bool(side.normal @ piece.normal > 0.5 and np.abs(off).max() <= close)


def _area(loop: Sequence[Side]) -> float:
    return convex.area(np.array([side.corners[0] for side in loop]))


def _area_in_space(side: Side) -> float:
    return convex.area(side.corners @ tangent_axes(side.normal[None])[0].T)


def _merged(sides: list[Side], close: float) -> list[Side]:
    """Sides of which those that lie in one plane and make a convex one are one."""
    sides = list(sides)
    while True:
        normals = np.array([side.normal for side in sides])
        for i, j in np.argwhere(np.triu(normals @ normals.T > PARALLEL_NORMALS - 1e-12, 1)).tolist():
            if (union := _united(sides[i], sides[j], close)) is not None:
                sides = [union, *(side for k, side in enumerate(sides) if k not in (i, j))]
                break
        else:
            return sides


def _united(side: Side, other: Side, close: float) -> Side | None:
    """Two sides as one, if they lie in one plane and make a convex one."""
    origin = side.corners[0]
    if side.normal @ other.normal < PARALLEL_NORMALS or np.abs((other.corners - origin) @ side.normal).max() > close:
        return None
    axes = tangent_axes(side.normal[None])[0]
    flat, beside = (side.corners - origin) @ axes.T, (other.corners - origin) @ axes.T
    points = np.concatenate([flat, beside])
    hull = scipy.spatial.ConvexHull(points)
    if hull.volume - convex.area(flat) - convex.area(beside) > close * hull.area:
        return None
    ring = convex.cleaned(points[hull.vertices], close)
    return Side(origin + ring @ axes, side.normal, tuple(sorted({*side.parts, *other.parts})))
