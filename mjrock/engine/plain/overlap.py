"""Overlap: the volume that two convex solids have in common."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from ...quantities import Array
from .pieces import Piece

THIN = 1e-12
"""Radius of the largest ball within both solids up to which they have nothing in common, over their size [-]."""


class Overlap(NamedTuple):
    """Two pieces that lie inside each other.

    Args:
        depth: of their deepest contact, over the smallest thickness of the two [-].
        t: when [s].
        pieces: the two.
        place, turn: where the frames of their bodies are [m], and how they are turned, shapes (2, 3) and (2, 3, 3).
    """

    depth: float
    t: float
    pieces: tuple[Piece, Piece]
    place: Array
    turn: Array

    @property
    def share(self) -> float:
        """Volume that they have in common, over that of the smaller one [-]."""
        planes = []
        for piece, place, turn in zip(self.pieces, self.place, self.turn, strict=True):
            normals = piece.shape.normals @ turn.T
            own = np.column_stack([normals, -piece.shape.offsets - normals @ place])
            planes.append(own[own[:, 2] > 0.5] if piece.is_ground else own)  # of the ground its top alone
        least = min(piece.shape.bulk.volume for piece in self.pieces if not piece.is_ground)
        return common_volume(np.concatenate(planes)) / least


def common_volume(planes: Array) -> float:
    """Volume of the points x with normal . x + offset <= 0 for all planes [m3], from normals and offsets, (n, 4).

    The middle of the largest ball within is the point about which the planes are taken to their dual.
    """
    normals, offsets = planes[:, :3], planes[:, 3]
    ball = scipy.optimize.linprog(
        (0, 0, 0, -1), np.column_stack([normals, np.ones(len(planes))]), -offsets, bounds=[(None, None)] * 4
    )
    if ball.status != 0 or ball.x[3] <= THIN * np.abs(offsets).max():
        return 0.0
    inner = scipy.spatial.HalfspaceIntersection(planes, ball.x[:3])
    return float(scipy.spatial.ConvexHull(inner.intersections).volume)
