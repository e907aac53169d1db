"""Pictures of masonry: its blocks to scale, its joints, and where a motion has brought them."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon as Patch
from numpy.typing import ArrayLike

from ..problem.masonry.masonry import Masonry
from ..quantities import Array, require_array, require_kind, require_within

BRICK, STONE, MORTAR = "#e3b79a", "0.85", "#12406b"


def moved(corners: Array, centroid: Array, pose: Array) -> Array:
    """Corners of a block that has moved by a pose x, z, theta [m, m, rad], shape (n, 2)."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    placed: Array = (corners - centroid) @ np.array([[c, -s], [s, c]]) + centroid + pose[:2]
    return placed


def blocks(
    ax: Axes, masonry: Masonry, pose: ArrayLike | None = None, *, magnified: float = 1.0, joints: bool = True
) -> Axes:
    """The blocks of masonry to scale, fixed ones in grey, where they rest or at a pose.

    Args:
        ax: where to draw.
        masonry: the masonry.
        pose: x, z and theta of each block that is not fixed [m, m, rad], shape (bodies, 3), such as `answer.pose[-1]`;
            None draws it at rest.
        magnified: factor on the pose, to show a small motion, 0 to 1e6.
        joints: whether to draw the joints as lines, where no pose is given.

    Raises:
        ValueError: for a pose of another shape, or a factor outside its range.
    """
    require_kind("masonry", masonry, Masonry)
    magnified = require_within("magnified", magnified, 0.0, 1e6)
    bodies = (len(masonry.free), 3)
    at = np.zeros(bodies) if pose is None else magnified * require_array("pose", pose, bodies)
    where = dict(zip(masonry.free, at, strict=True))
    for i, block in enumerate(masonry.blocks):
        corners = block.corners if block.fixed else moved(block.corners, block.centroid, where[i])
        colour = STONE if block.fixed else BRICK
        ax.add_patch(Patch(corners, closed=True, facecolor=colour, edgecolor="0.25", linewidth=0.6))
    for joint in masonry.joints if joints and pose is None else ():
        ax.plot(*np.transpose([joint.start, joint.end]), color=MORTAR, linewidth=1.4, solid_capstyle="butt")
    ax.autoscale_view()
    ax.set_aspect("equal")
    ax.set_xlabel("$x$ [m]")
    ax.set_ylabel("$z$ [m]")
    return ax
