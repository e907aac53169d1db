"""A view of blocks in space: the camera, the light, the ground, and blocks that hide those behind them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.ticker import MultipleLocator
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
LABELS = np.array([1.0, 1.2])
"""Width and height that labels need around a view [inch]."""


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
    """Draw blocks in space, true to scale, and the ground below them.

    Blocks, and the convex parts of one that is not convex, are drawn from the farthest to the nearest, see
    `Solids.order`. What has sunk below the ground is left out.
    """
    space = in_three(ax)
    low, high = bodies.extent()
    if bodies.limits is None:
        around = 0.15 * float((high - low).max()) * np.array([1.0, 1.0, 0.0])  # ground
        low, high = low - around, high + around
    level = _ground(space, bodies, (low, high))
    if level is not None and bodies.limits is None:
        low[2] = level
    _frame(space, (low, high), bodies)
    tints = np.array([to_rgb(colour) for colour in bodies.colours])
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


def fill(ax: Axes, box: BboxBase) -> None:
    """Enlarge a view until it fills a box [pixel], such as that of its figure, but for room for its labels."""
    space = in_three(ax)
    figure = figure_of(ax)
    limits = [getattr(space, f"get_{name}lim")() for name in "xyz"]
    corners = np.array(np.meshgrid(*limits)).reshape(3, -1)
    x, y, _ = proj_transform(*corners, space.get_proj())
    space.apply_aspect()
    spans = np.ptp(space.transData.transform(np.column_stack([x, y])), axis=0)
    room = np.maximum(np.array(box.size) - figure.dpi * LABELS, 0.4 * np.array(box.size))
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


def _frame(ax: Axes3D, extent: tuple[Array, Array], bodies: Solids) -> None:
    """Set limits and labels in m, of the same scale along every axis, and the camera."""
    low, high = extent
    size: Array = high - low
    for name, a, b in zip("xyz", low, high, strict=True):
        getattr(ax, f"set_{name}lim")(a, b)
        getattr(ax, f"set_{name}label")(f"${name}$ [m]", fontsize=8, labelpad=-2.5)
        getattr(ax, f"{name}axis").set_major_locator(_locator(float(size.max())))
    ax.tick_params(labelsize=7, pad=0)
    ax.set_box_aspect(size, zoom=ZOOM)
    ax.set_proj_type("ortho")
    ax.view_init(*np.asarray(bodies.camera))
    ax.computed_zorder = False  # the ground lies behind
    ax.grid(False)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))


def _locator(extent: float) -> MultipleLocator:
    """Ticks some five to the largest extent [m], at the same spacing on every axis."""
    rough = extent / 5
    power = 10.0 ** np.floor(np.log10(rough))
    return MultipleLocator(power * min((1, 2, 5, 10), key=lambda step: abs(step * power - rough)))


def _ground(ax: Axes3D, bodies: Solids, extent: tuple[Array, Array]) -> float | None:
    """Draw the upper faces of the fixed blocks below all others, as far as the picture goes; their highest z [m]."""
    (left, near), (right, far) = extent[0][:2], extent[1][:2]
    window, level = np.array([(left, near), (right, near), (right, far), (left, far)]), None
    for block in bodies.ground:
        level = max(float(block.corners[:, 2].max()), -np.inf if level is None else level)
        for face in (side.corners for side in block.sides):
            plan = convex.clipped(face[:, :2], window) if _normals(face[None])[0, 2] > 0.99 else ()
            if len(plan) > 2:
                patch = [np.column_stack([plan, np.full(len(plan), face[:, 2].mean())])]
                look = {"facecolors": GROUND_COLOUR, "edgecolors": "0.6", "zorder": 0.5, "clip_on": False}
                ax.add_collection3d(Poly3DCollection(patch, **look))
    return level


def _normals(corners: Array) -> Array:
    """Unit normals out of faces, shape (faces, 3)."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(length > 0, length, 1.0))
