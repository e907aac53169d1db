"""A view of blocks in space on an Axes: where the camera stands, what it shows, a scale bar, and ties."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.transforms import BboxBase
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.proj3d import proj_transform

from ..quantities import Integers
from .bodies import round_length
from .depths import View
from .section import Update, pulling
from .solids import Solids
from .style import figure_of

ZOOM = 1.0
"""Size of a picture before it is enlarged [-]."""
MARGIN, TITLED = (0.2, 0.4), (0.2, 0.8)
"""Width and height that stay free around a view, for the scale bar, and for a title too [inch]."""
BELOW, BELOW_FLAT = 0.05, 0.02
"""How far a scale bar stands below what is seen, over its height, and at least over its width [-]."""
FINE, DENSE = 2, 150
"""Pixels that are drawn along each side of one of the picture, where it has fewer than so many to an inch."""
EDGE, RIM = 0.55, 0.1
"""Width of edges [point], and of the rim of the box within which the picture fades [inch]."""


class Rendered(Artist):
    """Blocks in space and the ground below them, drawn over a box of a figure.

    Args:
        ax: of three dimensions.
        bodies: the blocks, and where they are seen from.
        box: what is drawn over [pixel], such as the box of the figure.
    """

    def __init__(self, ax: Axes, bodies: Solids, box: BboxBase) -> None:
        super().__init__()
        self.ax, self.bodies, self.box, self.frame = ax, bodies, box, 0
        self._kept: tuple[object, Integers] = None, np.empty(0, dtype=np.uint8)
        self.set_zorder(2)
        self.set_in_layout(False)

    def draw(self, renderer: Any) -> None:
        """Draw it at the resolution of the renderer."""
        times = renderer.get_image_magnification()
        inch = times * figure_of(self.ax).dpi
        fine = FINE if inch < DENSE else 1
        view, gc = self.view(times, fine), renderer.new_gc()
        key = self.frame, view.size, view.pixel, view.middle.tobytes()
        if key != self._kept[0]:  # a figure is drawn once for its layout, and once more
            self._kept = key, self._picture(view, fine, inch)
        renderer.draw_image(gc, self.box.x0, self.box.y0, self._kept[1])
        gc.restore()

    def _picture(self, view: View, fine: int, inch: float) -> Integers:
        """Red, green, blue and opacity, 0 to 255, with so many pixels to an inch, which fade at the rim."""
        line = max(1, round(fine * EDGE * inch / 72))
        colours = view.picture(*self.bodies.stage(self.frame), line, fine)
        rows, columns = (np.arange(count) + 0.5 for count in colours.shape[:2])
        rim = [np.clip(np.minimum(at, len(at) - at) / (RIM * inch), 0, 1) for at in (rows, columns)]
        colours[..., 3] *= np.outer(*rim)
        return np.rint(255 * colours).astype(np.uint8)

    def view(self, times: float = 1.0, fine: int = 1) -> View:
        """What the box shows, of so many pixels for each of its own, each as so many, along either side."""
        space, bodies = in_three(self.ax), self.bodies
        ends = np.mean([getattr(space, f"get_{name}lim")() for name in "xyz"], axis=1)
        x, y, _ = proj_transform(*np.transpose([ends, ends + bodies.across[0]]), space.get_proj())
        (at, beside) = space.transData.transform(np.column_stack([x, y]))
        metre = float(np.hypot(*(beside - at)))
        middle = ends + (self.box.get_points().mean(axis=0) - at) / metre @ bodies.across
        wide, high = (fine * max(1, round(times * size)) for size in self.box.size)
        return View(np.array([*bodies.across, bodies.eye]), middle, (wide, high), 1 / (metre * times * fine))


def in_three(ax: Axes) -> Any:
    """Axes of three dimensions; a ValueError says if they have two."""
    if not isinstance(ax, Axes3D):
        raise ValueError('ax has two dimensions, and the masonry is in space; add_subplot(projection="3d") makes three')
    return ax


def solids(ax: Axes, bodies: Solids, box: BboxBase, *, animated: bool = True) -> Update:
    """Draw blocks in space, true to scale, with a scale bar, and the ground below them, over a box [pixel]."""
    space = in_three(ax)
    _frame(space, bodies)
    _scale_bar(space, bodies, animated=animated)
    drawn = Rendered(ax, bodies, box)
    drawn.set_animated(animated)
    space.add_artist(drawn)

    def update(frame: int) -> None:
        drawn.frame = frame

    return update


def fill(ax: Axes, bodies: Solids, box: BboxBase, margin: tuple[float, float] = MARGIN) -> None:
    """Enlarge a view until its blocks fill a box [pixel], such as that of its figure, but for a margin."""
    space = in_three(ax)
    figure, seen = figure_of(ax), bodies.seen
    limits = np.array([getattr(space, f"get_{name}lim")() for name in "xyz"])
    if bodies.limits is None:
        off = seen.mean(axis=0) - bodies.across @ limits.mean(axis=1)
        limits += (off @ bodies.across)[:, None]
        space.set(xlim=limits[0], ylim=limits[1], zlim=limits[2])
    x, y, _ = proj_transform(*(seen @ bodies.across).T, space.get_proj())
    space.apply_aspect()
    spans = np.ptp(space.transData.transform(np.column_stack([x, y])), axis=0)
    room = np.maximum(np.array(box.size) - figure.dpi * np.array(margin), 0.4 * np.array(box.size))
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


def _scale_bar(ax: Axes3D, bodies: Solids, *, animated: bool) -> None:
    """Draw a line of 1, 2 or 5 times a power of ten [m] across the line of sight, below what is seen at the left."""
    (left, low), (right, high) = bodies.seen
    length = round_length(float(right - left))
    start = np.array([left, low - max(BELOW * (high - low), BELOW_FLAT * (right - left))])
    ends = np.array([start, start + np.array([length, 0.0])]) @ bodies.across
    (line,) = ax.plot(*ends.T, color="0.15", linewidth=2.5, solid_capstyle="butt", zorder=6, clip_on=False)
    text = ax.text(*ends[1], f"  {length:g} m", va="center", fontsize=8, zorder=6)
    for part in (line, text):
        part.set_in_layout(False)  # its place is known when the view is
        part.set_animated(animated)
