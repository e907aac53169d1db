"""A view of blocks in space: the camera, the light, the ground, and blocks that hide those behind them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.transforms import BboxBase
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.proj3d import proj_transform

from ..geometry import convex
from ..quantities import Array
from .section import Update, pulling
from .solids import Solids
from .style import figure_of

GROUND_COLOUR = "#e6e6e2"
LIGHT = np.array([0.62, -0.25, 0.74])
"""Where the light comes from."""
DARKEST = 0.62
"""Brightness of a face that is turned away from the light [-]."""
ZOOM = 1.0
"""Size of a picture before it is enlarged [-]."""
MARGIN = np.array([0.2, 0.8])
"""Width and height that stay free around a view, for the scale bar and a title [inch]."""
BAR, BELOW = 0.25, 0.05
"""Longest scale bar over the width of what is seen, and how far below it stands over its height [-]."""


class Faces(PolyCollection):
    """Faces in space, drawn in the order given and not by their depth."""

    corners: Sequence[Array] = ()
    """Corners of each face [m], shape (n, 3)."""

    def do_3d_projection(self) -> float:
        """Bring the faces into the plane of the picture, whenever the axes are drawn."""
        if len(self.corners):
            space: Any = self.axes
            x, y, _ = proj_transform(*np.concatenate(self.corners).T, space.M)
            ends = np.cumsum([len(face) for face in self.corners])[:-1]
            self.set_verts(np.split(np.column_stack([x, y]), ends))
        return 0.0


def in_three(ax: Axes) -> Any:
    """Axes of three dimensions; a ValueError says if they have two."""
    if not isinstance(ax, Axes3D):
        raise ValueError('ax has two dimensions, and the masonry is in space; add_subplot(projection="3d") makes three')
    return ax


def solids(ax: Axes, bodies: Solids, *, animated: bool = True) -> Update:
    """Draw blocks in space, true to scale, with a scale bar, and the ground below them.

    Blocks, and the convex parts of one that is not convex, are drawn from the farthest to the nearest, see
    `Solids.order`. What has sunk below the ground is left out.
    """
    space = in_three(ax)
    level = _ground(space, bodies)
    _frame(space, bodies)
    _scale_bar(space, bodies)
    tints = bodies.colours
    moving = Faces([], linewidths=0.4, edgecolors="0.2", zorder=2, animated=animated, clip_on=False)
    space.add_collection(moving, autolim=False)

    def update(frame: int) -> None:
        corners = bodies.corners(frame)
        normals = _normals(corners)
        seen = normals @ bodies.eye > 0
        if level is not None and bodies.eye[2] > 0:
            seen &= corners[..., 2].mean(axis=1) > level
        place = np.argsort(bodies.order(frame))  # of each convex part in the order
        number = np.flatnonzero(seen)[np.argsort(place[bodies.facets.part[seen]], kind="stable")]
        bright = DARKEST + (1 - DARKEST) * np.clip(normals[number] @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
        counts = bodies.facets.counts[number]
        moving.corners = [face[:count] for face, count in zip(corners[number], counts, strict=True)]
        moving.set_facecolor(cast(Any, tints[number] * bright[:, None]))
        if space.M is not None:
            moving.do_3d_projection()

    return update


def fill(ax: Axes, bodies: Solids, box: BboxBase) -> None:
    """Enlarge a view until its blocks fill a box [pixel], such as that of its figure, but for a margin.

    The ground is cut at the box.
    """
    space = in_three(ax)
    for ground in space.collections:
        if isinstance(ground, Poly3DCollection):
            ground.set_clip_path(None)
            ground.set_clip_box(box)
    figure, seen = figure_of(ax), bodies.seen
    limits = np.array([getattr(space, f"get_{name}lim")() for name in "xyz"])
    if bodies.limits is None:
        off = seen.mean(axis=0) - bodies.across @ limits.mean(axis=1)
        limits += (off @ bodies.across)[:, None]
        space.set(xlim=limits[0], ylim=limits[1], zlim=limits[2])
    x, y, _ = proj_transform(*(seen @ bodies.across).T, space.get_proj())
    space.apply_aspect()
    spans = np.ptp(space.transData.transform(np.column_stack([x, y])), axis=0)
    room = np.maximum(np.array(box.size) - figure.dpi * MARGIN, 0.4 * np.array(box.size))
    space.set_box_aspect(np.ptp(limits, axis=1), zoom=ZOOM * float((room / spans).min()))


def ties_in_view(ax: Axes, bodies: Solids) -> Update:
    """Links of blocks, each from the point that it holds to its anchor: solid where it pulls, dotted where it is slack,
    gone once it broke."""
    space, moves, moving = in_three(ax), [], bodies.moving
    for link in bodies.case.links.values():
        held = bodies.case.held_by(link)
        ends = [(held, link.block), (link.anchor_of(held), link.anchor_block)]
        drawn = [moving.placed(block, point[None])[:, 0] for point, block in ends]
        (line,) = space.plot([], [], [], color=link.colour, linewidth=1.8, zorder=4, animated=True)
        moves.append((line, link.dashes, np.stack(drawn, axis=1), *pulling(moving, link)))

    def update(frame: int) -> None:
        for line, dashes, ends, pulls, broken in moves:
            line.set_data_3d(*ends[frame].T)
            line.set_linestyle(dashes if pulls[frame] else ":")
            line.set_visible(not broken[frame])

    return update


def _frame(ax: Axes3D, bodies: Solids) -> None:
    """Set limits of the same scale along every axis, and the camera. No axes are drawn."""
    low, high = bodies.extent()
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(high - low, zoom=ZOOM)
    ax.set_proj_type("ortho")
    ax.view_init(*np.asarray(bodies.camera))
    ax.computed_zorder = False  # the ground lies behind
    ax.set_axis_off()


def _scale_bar(ax: Axes3D, bodies: Solids) -> None:
    """Draw a line of 1, 2 or 5 times a power of ten [m] across the line of sight, below what is seen at the left."""
    (left, low), (right, high) = bodies.seen
    power = 10.0 ** np.floor(np.log10(BAR * (right - left)))
    length = power * max(step for step in (1, 2, 5) if step * power <= BAR * (right - left) * (1 + 1e-9))
    start = np.array([left, low - BELOW * (high - low)])
    ends = np.array([start, start + np.array([length, 0.0])]) @ bodies.across
    (line,) = ax.plot(*ends.T, color="0.15", linewidth=2.5, solid_capstyle="butt", zorder=6, clip_on=False)
    text = ax.text(*ends[1], f"  {length:g} m", va="center", fontsize=8, zorder=6)
    for part in (line, text):
        part.set_in_layout(False)  # its place is known when the view is


def _ground(ax: Axes3D, bodies: Solids) -> float | None:
    """Draw the upper faces of the fixed blocks below all others, beyond all that moves; their highest z [m]."""
    (left, near), (right, far) = bodies.floor
    window, level = np.array([(left, near), (right, near), (right, far), (left, far)]), None
    for block in bodies.ground:
        level = max(float(block.corners[:, 2].max()), -np.inf if level is None else level)
        for face in (side.corners for side in block.sides):
            plan = convex.clipped(face[:, :2], window) if _normals(face[None])[0, 2] > 0.99 else ()
            if len(plan) > 2:
                patch = [np.column_stack([plan, np.full(len(plan), face[:, 2].mean())])]
                look = {"facecolors": GROUND_COLOUR, "edgecolors": "0.6", "linewidths": 0.6, "zorder": 0.5}
                ax.add_collection3d(Poly3DCollection(patch, **look)).set_in_layout(False)
    return level


def _normals(corners: Array) -> Array:
    """Unit normals out of faces, shape (faces, 3)."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(length > 0, length, 1.0))
