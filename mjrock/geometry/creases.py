"""The edges that a body of convex parts shows: where its surface bends, and not where its parts lie on each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..quantities import Array
from .hull import Convex

PROBES = 72
"""Points around an edge at which the body is asked for."""
ASIDE_OF_EDGE = 1e-3
"""Distance of these points from the edge, over the extent of the body [-]."""
ALONG_EDGE = 1e-6
"""Distance from an edge at which a corner lies on it, over the extent of the body [-]."""


def creases_of(parts: Sequence[Convex]) -> Array:
    """Ends of the edges of a body [m], shape (n, 2, 3).

    An edge of a part is cut at the corners of other parts that lie on it. A piece of it is shown unless the points
    around it lie all within the body, or those of one half of a circle do: its surface is plane there.
    """
    edges = np.concatenate([_edges(part) for part in parts])
    if len(parts) == 1:
        return edges
    corners = np.concatenate([part.corners for part in parts])
    extent = float(np.ptp(corners, axis=0).max())
    pieces = np.concatenate([_cut(edge, corners, ALONG_EDGE * extent) for edge in edges])
    middles = pieces.mean(axis=1)
    _, once = np.unique(np.round(middles / (ALONG_EDGE * extent)), axis=0, return_index=True)
    pieces, middles = pieces[np.sort(once)], middles[np.sort(once)]
    around = np.stack([_circle(end - start) for start, end in pieces])
    probes = middles[:, None] + ASIDE_OF_EDGE * extent * around
    within = np.zeros(probes.shape[:2], dtype=bool)
    for part in parts:
        within |= (probes @ part.normals.T <= part.offsets + ALONG_EDGE * extent).all(axis=2)
    count = within.sum(axis=1)
    return np.asarray(pieces[(count < PROBES) & (np.abs(count - PROBES // 2) > 1)])


def _edges(part: Convex) -> Array:
    """Ends of the edges of a part [m], each once, shape (n, 2, 3)."""
    rings = ((face, (*face[1:], face[0])) for face in part.faces)
    pairs = {(min(i, j), max(i, j)) for ring, after in rings for i, j in zip(ring, after, strict=True)}
    return part.corners[np.array(sorted(pairs))]


def _cut(edge: Array, corners: Array, near: float) -> Array:
    """The pieces of an edge between the corners that lie on it [m], shape (n, 2, 3)."""
    start, along = edge[0], edge[1] - edge[0]
    length = float(np.linalg.norm(along))
    places = (corners - start) @ along / length
    off = np.linalg.norm(corners - start - places[:, None] * along / length, axis=1)
    inner = np.unique(np.round(places[(off < near) & (places > near) & (places < length - near)] / near)) * near
    points = start + np.concatenate([[0.0], inner, [length]])[:, None] * along / length
    return np.stack([points[:-1], points[1:]], axis=1)


def _circle(along: Array) -> Array:
    """Unit vectors square to a vector, all around it, shape (PROBES, 3)."""
    first = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    first /= np.linalg.norm(first)
    second = np.cross(along, first) / np.linalg.norm(along)
    angles = 2 * np.pi * (np.arange(PROBES) + 0.5) / PROBES
    return np.asarray(np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))
