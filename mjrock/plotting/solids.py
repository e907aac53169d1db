"""Blocks in space in motion, as a picture shows them: their faces, the camera, the ground, a scale bar, and ties."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.transforms import BboxBase
from mpl_toolkits.mplot3d import Axes3D
from mpl_toolkits.mplot3d.proj3d import proj_transform
from numpy.typing import ArrayLike

from ..problem.masonry.case import MasonryCase
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, Integers, keep, require_array, require_within
from ..result.bodies import BodyMotion
from ..result.response import Response
from ..result.ties import link_ends
from ..scene.tints import colours_of
from .bodies import Update, combined, ends_of, link, padded_rows, placed_ends, required_limits, round_length
from .rasterizer import Ground, Surfaces, View
from .style import figure_of

GROUND_ROOM, FARTHEST = 0.6, 3.0
"""How far the ground is drawn beyond all corners, and the farthest corners that count for it, over the extent [-]."""
DEEPEST_SUNK = 0.05
"""Largest depth of blocks below the ground with which it is still drawn, over the extent [-]."""
PLANE_ROUNDING = 1e-6
"""Part of normals and of the extent to which two faces lie in one plane [-]."""
SUN = np.array([-0.75, 0.55, 1.0])
"""Where the sun stands: to the right of the camera, towards it, and upwards."""
MARGIN, TITLED = (0.2, 0.4), (0.2, 0.8)
"""Width and height that stay free around a view, for the scale bar, and for a title too [inch]."""
BAR_BELOW, BAR_BELOW_FLAT = 0.05, 0.02
"""How far a scale bar stands below what is seen, over its height, and at least over its width [-]."""
SUBPIXELS, DENSE_RESOLUTION = 2, 150
"""Subpixels along each side of a pixel of the picture, and the resolution below which they are drawn [1/inch]."""
EDGE_WIDTH, FADING_RIM = 0.55, 0.1
"""Width of edges [point], and of the rim of the box within which the picture fades [inch]."""


class Facets(NamedTuple):
    """The faces of bodies: corners about the centroid of the body, at rest [m], shape (faces, most, 3), of which a face
    with few repeats the last one; and the numbers of the block and of the plane piece of it, shape (faces,) each."""

    corners: Array
    block: Integers
    plane: Integers


@dataclass(frozen=True, eq=False)
class Solids:
    """Masonry in space, as a picture shows it.

    Args:
        moving: where its blocks are.
        camera: elevation and azimuth that the blocks are seen from [deg], -90 to 90 and -360 to 360; None is (18, 35).
        limits: lowest and highest x, y and z of the picture [m], three pairs; None shows the blocks, see `extent`.

    Raises:
        ValueError: for a value outside its range.
    """

    moving: BodyMotion
    camera: Sequence[float] | None = None
    limits: Array | None = None

    def __post_init__(self) -> None:
        elevation, azimuth = require_array("camera", (18.0, 35.0) if self.camera is None else self.camera, (2,))
        elevation = require_within("elevation of the camera", elevation, -90.0, 90.0, "degrees")
        keep(
            self,
            camera=(elevation, require_within("azimuth of the camera", azimuth, -360.0, 360.0, "degrees")),
            limits=required_limits(self.limits, "xyz"),
        )

    @classmethod
    def of(
        cls,
        response: Response,
        magnify: float = 1.0,
        camera: Sequence[float] | None = None,
        limits: ArrayLike | None = None,
    ) -> Solids:
        """The blocks of a response in space."""
        magnify = require_within("magnify", magnify, 0.01, 1e4)
        return cls(replace(response.moving, magnify=magnify), camera, required_limits(limits, "xyz"))

    @property
    def t(self) -> Array:
        """Times [s], shape (n,)."""
        return self.moving.t

    @property
    def case(self) -> MasonryCase:
        """The case that is drawn."""
        return cast(MasonryCase, self.moving.case)

    @property
    def masonry(self) -> Masonry:
        """The blocks."""
        return self.case.masonry

    def at(self, times: Array) -> Solids:
        """The same blocks at other times, their poses interpolated linearly."""
        return replace(self, moving=self.moving.between(times))

    @cached_property
    def eye(self) -> Array:
        """Unit vector to the camera, shape (3,)."""
        elevation, azimuth = np.radians(np.asarray(self.camera))
        level = np.cos(elevation)
        return np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])

    @property
    def shown(self) -> Integers:
        """Numbers of the blocks that are drawn as bodies: all but the ground, fixed ones too."""
        return np.flatnonzero(~self.moving.are_ground)

    @cached_property
    def facets(self) -> Facets:
        """The faces of the blocks that are shown."""
        return self._faces_of(self.shown)

    def _faces_of(self, blocks: Integers) -> Facets:
        """The faces of some blocks."""
        parts = [(block, part) for block in blocks.tolist() for part in self.case.rest_geometry.solids[block].parts]
        block = np.repeat([block for block, _ in parts], [len(part.faces) for _, part in parts])
        corners = padded_rows([part.corners[list(face)] for _, part in parts for face in part.faces])
        normals = np.concatenate([part.normals for _, part in parts])
        offsets = np.concatenate([part.offsets for _, part in parts])
        planes = np.column_stack([block * PLANE_ROUNDING, normals, offsets / np.abs(corners).max()])
        planes = np.round(planes / PLANE_ROUNDING)
        return Facets(corners, block, np.unique(planes, axis=0, return_inverse=True)[1].ravel())

    def corners(self, frame: int) -> Array:
        """Where the corners of all facets are drawn at a frame [m], shape (faces, most, 3)."""
        return self.moving.placed_at(frame, self.facets.block, self.facets.corners)

    def stage(self, frame: int) -> tuple[Surfaces, Array, Ground | None]:
        """The surfaces at a frame, a unit vector to the sun, which stands to the left of the camera, and the ground."""
        (right, _), azimuth = self.across, np.radians(np.asarray(self.camera)[1])
        sun = SUN @ np.array([right, (np.cos(azimuth), np.sin(azimuth), 0.0), (0.0, 0.0, 1.0)])
        corners, block, plane = self._staged
        surfaces = Surfaces(
            self.moving.placed_at(frame, block, corners), plane, colours_of(self.case.rest_geometry)[block]
        )
        return surfaces, sun / np.linalg.norm(sun), self.ground

    @cached_property
    def _staged(self) -> Facets:
        """The facets, and those of the ground where blocks fall past its edge."""
        return self.facets if self.ground is not None else self._faces_of(np.arange(len(self.masonry.blocks)))

    @cached_property
    def ground(self) -> Ground | None:
        """The ground, which reaches beyond all corners; None where there is none, or blocks fall past its edge."""
        grounds = np.flatnonzero(self.moving.are_ground).tolist()
        tops = [float(self.masonry.blocks[i].corners[:, 2].max()) for i in grounds]
        low, high = self.extent()
        size = float((high - low).max())
        if not tops or self.reached[0, 2] < max(tops) - DEEPEST_SUNK * size:
            return None
        lowest, highest = np.clip(self.reached, low - FARTHEST * size, high + FARTHEST * size)[:, :2]
        low, high = np.minimum(lowest, low[:2]), np.maximum(highest, high[:2])
        return Ground(max(tops), 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low)) + GROUND_ROOM * size)

    def extent(self) -> Array:
        """The lowest and the highest x, y and z that the blocks reach in the picture [m], shape (2, 3).

        What goes farther than one extent of the blocks at rest is outside. Where all has, these are the blocks at rest.
        Given limits come first.
        """
        if self.limits is not None:
            return self.limits.T
        bounds = ends_of(self.facets.corners + self.case.centroids[self.facets.block, None])
        room = float((bounds[1] - bounds[0]).max())
        shown = np.array([np.maximum(self.reached[0], bounds[0] - room), np.minimum(self.reached[1], bounds[1] + room)])
        return shown if (shown[0] < shown[1]).all() else bounds

    @cached_property
    def reached(self) -> Array:
        """The lowest and the highest x, y and z of all corners [m], shape (2, 3)."""
        return ends_of(np.array([ends_of(self.corners(frame)) for frame in self._sampled_frames]))

    @cached_property
    def across(self) -> Array:
        """Unit vectors to the right and upwards in the picture, shape (2, 3)."""
        azimuth = np.radians(np.asarray(self.camera)[1])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        return np.array([right, np.cross(self.eye, right)])

    @cached_property
    def seen(self) -> Array:
        """The lowest and the highest coordinates, to the right and upwards, that the picture holds [m], shape (2, 2).

        They are those of the blocks as far as `extent` goes, and with given limits those of their box.
        """
        low, high = self.extent()
        box = np.stack(np.meshgrid(*np.transpose([low, high]), indexing="ij"), axis=-1).reshape(-1, 3)
        clipped = (np.clip(self.corners(frame), low, high) for frame in self._sampled_frames)
        corner_sets = [box] if self.limits is not None else list(clipped)
        return ends_of(np.array([ends_of(corners.reshape(-1, 3) @ self.across.T) for corners in corner_sets]))

    @property
    def extent_seen(self) -> Array:
        """Width and height of the drawing [m], shape (2,)."""
        return np.asarray(np.ptp(self.seen, axis=0))

    @property
    def _sampled_frames(self) -> list[int]:
        """Numbers of at most 100 frames, from the first to the last."""
        numbers: list[int] = np.unique(np.linspace(0, len(self.t) - 1, 100).astype(int)).tolist()
        return numbers


class Rendering(Artist):
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
        self.set_animated(True)

    def draw(self, renderer: RendererBase) -> None:
        """Draw it at the resolution of the renderer."""
        magnification = renderer.get_image_magnification()
        resolution = magnification * figure_of(self.ax).dpi
        fine = SUBPIXELS if resolution < DENSE_RESOLUTION else 1
        view, gc = self.view(magnification, fine), renderer.new_gc()
        key = self.frame, view.size, view.pixel, view.middle.tobytes()
        if key != self._kept[0]:  # a figure is drawn once for its layout, and once more
            self._kept = key, self._picture(view, fine, resolution)
        renderer.draw_image(gc, self.box.x0, self.box.y0, self._kept[1])
        gc.restore()

    def _picture(self, view: View, fine: int, resolution: float) -> Integers:
        """Red, green, blue and opacity, 0 to 255, at a resolution [pixel/inch]; it fades at the rim."""
        edge = max(1, round(fine * EDGE_WIDTH * resolution / 72))
        colours = view.picture(*self.bodies.stage(self.frame), edge, fine)
        rows, columns = (np.arange(count) + 0.5 for count in colours.shape[:2])
        to_rim = [np.minimum(positions, len(positions) - positions) for positions in (rows, columns)]
        rim = [np.clip(distances / (FADING_RIM * resolution), 0, 1) for distances in to_rim]
        colours[..., 3] *= np.outer(*rim)
        return np.rint(255 * colours).astype(np.uint8)

    def view(self, magnification: float = 1.0, fine: int = 1) -> View:
        """The view in the box, of `magnification` pixels for each of the box along a side, each of `fine` ones."""
        space, bodies = in_three(self.ax), self.bodies
        centre = np.mean([getattr(space, f"get_{name}lim")() for name in "xyz"], axis=1)
        x, y, _ = proj_transform(*np.transpose([centre, centre + bodies.across[0]]), space.get_proj())
        (start, end) = space.transData.transform(np.column_stack([x, y]))
        metre = float(np.hypot(*(end - start)))
        middle = centre + (self.box.get_points().mean(axis=0) - start) / metre @ bodies.across
        width, height = (fine * max(1, round(magnification * size)) for size in self.box.size)
        return View(np.array([*bodies.across, bodies.eye]), middle, (width, height), 1 / (metre * magnification * fine))


def in_three(ax: Axes) -> Axes3D:
    """Axes of three dimensions.

    Raises:
        ValueError: for those of two.
    """
    if not isinstance(ax, Axes3D):
        raise ValueError('ax has two dimensions, and the masonry is in space; add_subplot(projection="3d") makes three')
    return ax


def draw_solids(ax: Axes, bodies: Solids, box: BboxBase) -> Update:
    """Draw blocks in space, true to scale, with a scale bar, and the ground below them, over a box [pixel]."""
    space = in_three(ax)
    _frame(space, bodies)
    _scale_bar(space, bodies)
    rendering = Rendering(ax, bodies, box)
    space.add_artist(rendering)

    def update(frame: int) -> None:
        rendering.frame = frame

    return update


def fill_view(ax: Axes, bodies: Solids, box: BboxBase, margin: tuple[float, float] = MARGIN) -> None:
    """Enlarge a view until its blocks fill a box [pixel], such as that of its figure, but for a margin."""
    space = in_three(ax)
    figure, seen = figure_of(ax), bodies.seen
    limits = np.array([getattr(space, f"get_{name}lim")() for name in "xyz"])
    if bodies.limits is None:
        shift = seen.mean(axis=0) - bodies.across @ limits.mean(axis=1)
        limits += (shift @ bodies.across)[:, None]
        space.set(xlim=limits[0], ylim=limits[1], zlim=limits[2])
    x, y, _ = proj_transform(*(seen @ bodies.across).T, space.get_proj())
    space.apply_aspect()
    spans = np.ptp(space.transData.transform(np.column_stack([x, y])), axis=0)
    room = np.maximum(np.array(box.size) - figure.dpi * np.array(margin), 0.4 * np.array(box.size))
    space.set_box_aspect(np.ptp(limits, axis=1), zoom=float((room / spans).min()))


def ties_in_view(ax: Axes, bodies: Solids) -> Update:
    """Draw the links of blocks, each from the point that it holds to its anchor."""
    space, moving = in_three(ax), bodies.moving
    links = bodies.case.links.values()
    return combined([link(space, moving, tie, placed_ends(moving, *link_ends(moving.case, tie))) for tie in links])


def _frame(ax: Axes3D, bodies: Solids) -> None:
    """Set limits of the same scale along every axis, and the camera. No axes are drawn."""
    low, high = bodies.extent()
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(high - low)
    ax.set_proj_type("ortho")
    ax.view_init(*np.asarray(bodies.camera))
    ax.computed_zorder = False  # the ground lies behind
    ax.set_axis_off()


def _scale_bar(ax: Axes3D, bodies: Solids) -> None:
    """Draw a line of 1, 2 or 5 times a power of ten [m] across the line of sight, below what is seen at the left."""
    (left, low), (right, high) = bodies.seen
    length = round_length(float(right - left))
    start = np.array([left, low - max(BAR_BELOW * (high - low), BAR_BELOW_FLAT * (right - left))])
    ends = np.array([start, start + np.array([length, 0.0])]) @ bodies.across
    (line,) = ax.plot(*ends.T, color="0.15", linewidth=2.5, solid_capstyle="butt", zorder=6, clip_on=False)
    text = ax.text(*ends[1], f"  {length:g} m", va="center", fontsize=8, zorder=6)
    for part in (line, text):
        part.set_in_layout(False)  # its place is known when the view is
        part.set_animated(True)
