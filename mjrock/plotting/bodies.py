"""Rigid bodies of the plane in motion, as a picture shows them: outlines, how they move, what it shows, and ties."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.transforms import ScaledTranslation
from numpy.typing import ArrayLike

from ..problem.masonry.case import MasonryCase
from ..problem.wall.effect import Anchored
from ..quantities import Array, Flags, Integers, require_array, require_kind, require_within
from ..result.bodies import BodyMotion
from ..result.response import Response
from ..result.ties import LinkEnd, elongation_of, link_ends
from ..scene.tints import FIXED_COLOUR, TINTS, colours_of
from .style import Look, figure_of, plain_names

STONE, GROUND_COLOUR, FORCE = TINTS[0], FIXED_COLOUR, "#a8201a"
"""Colours of a wall, of what does not move, and of forces."""
UNDER = 34.0
"""Height of the numbers and the label of an x axis [pt]."""
Update = Callable[[int], None]
"""Moves what is drawn to a frame."""
BAR = 0.25
"""Longest scale bar over the width of what is seen [-]."""


def ends_of(points: Array) -> Array:
    """The lowest and the highest coordinates of points [m], shape (..., d), as (2, d)."""
    rows = points.reshape(-1, points.shape[-1])
    return np.array([rows.min(axis=0), rows.max(axis=0)])


def round_length(wide: float) -> float:
    """The length of a scale bar of a picture so wide [m]: 1, 2 or 5 times a power of ten, at most a quarter of it."""
    longest = BAR * wide * (1 + 1e-9)
    power = float(10.0 ** np.floor(np.log10(longest)))
    return power * max(step for step in (1, 2, 5) if step * power <= longest)


def padded_rows(rows: Sequence[Array]) -> Array:
    """Rows of points as one array; shorter ones repeat their last point."""
    count = max(map(len, rows))
    return np.array([np.concatenate([row, np.repeat(row[-1:], count - len(row), axis=0)]) for row in rows])


def required_limits(limits: ArrayLike | None, axes: str) -> Array | None:
    """The lowest and the highest coordinate of a picture along each axis [m], shape (d, 2), or None.

    Raises:
        TypeError, ValueError: unless each axis has a lower and a higher limit.
    """
    if limits is None:
        return None
    checked = require_array("limits", limits, (len(axes), 2))
    for name, (a, b) in zip(axes, checked.tolist(), strict=True):
        if not a < b:
            raise ValueError(f"limits along {name} = {a:g} to {b:g} m are not a lower and a higher one")
    return checked


@dataclass(frozen=True, eq=False)
class Bodies:
    """Rigid bodies of the plane, as a picture shows them.

    Args:
        moving: where they are.
        colours: red, green and blue of those that are not fixed, 0 to 1, shape (bodies, 3).
        limits: lowest and highest x, and lowest and highest z, of the picture [m]; None shows what moves, see `extent`.
    """

    moving: BodyMotion
    colours: Array
    limits: Array | None = None

    @classmethod
    def of(cls, response: Response, magnify: float = 1.0, limits: ArrayLike | None = None) -> Bodies:
        """The bodies of a response: the wall, or the blocks of masonry that are not fixed."""
        require_kind("response", response, Response)
        if response.case.in_space:
            response.of_masonry.masonry.require_plane("Bodies")
        magnify = require_within("magnify", magnify, 0.01, 1e4)
        return cls.of_moving(replace(response.moving, magnify=magnify), limits)

    @classmethod
    def of_moving(cls, moving: BodyMotion, limits: ArrayLike | None = None) -> Bodies:
        """The bodies of a case."""
        geometry = moving.case.rest_geometry
        free = [solid.body >= 0 for solid in geometry.solids]
        return cls(moving, colours_of(geometry)[free], required_limits(limits, "xz"))

    @property
    def t(self) -> Array:
        """Times [s], shape (n,)."""
        return self.moving.t

    @property
    def outlines(self) -> tuple[Array, ...]:
        """Corners of each body about its centroid, at rest [m]."""
        return self.moving.case.outlines

    def at(self, times: Array) -> Bodies:
        """The same bodies at other times, their poses interpolated linearly."""
        return replace(self, moving=self.moving.between(times))

    def corners(self, frame: int) -> Array:
        """Where the corners of all bodies are drawn at a frame [m], shape (bodies, corners, 2).

        A body with fewer corners than another repeats its last one. The displacement of a point is drawn times
        `magnify`. A point that does not move, such as a toe, then stays where it is; what is magnified is distorted.
        """
        return self.moving.placed_at(frame, self._numbers, self._padded)

    def extent(self) -> Array:
        """The lowest and the highest x and z that any corner reaches in the picture [m], shape (2, 2).

        What moves farther than two extents of the bodies at rest, or falls by a quarter of one below all of them, is
        outside. Fixed bodies are shown up to a quarter beyond those that move. Given limits come first.
        """
        if self.limits is not None:
            return self.limits.T
        case, fixed = self.moving.case, [*self.moving.case.fixed.values()]
        if not self.outlines:
            return ends_of(np.concatenate(fixed))
        frames = np.unique(np.linspace(0, len(self.t) - 1, 500).astype(int)).tolist()
        moving, at_rest = (
            ends_of(np.array([self.corners(frame) for frame in frames])),
            ends_of(case.rests[:, None] + self._padded),
        )
        stays = ends_of(np.concatenate(fixed) if fixed else case.rests)
        room = float((at_rest[1] - at_rest[0]).max())
        beyond = 0.25 * room
        low = np.minimum(np.maximum(moving[0], at_rest[0] - [2 * room, beyond]), at_rest[1])
        high = np.maximum(np.minimum(moving[1], at_rest[1] + 2 * room), at_rest[0])
        fixed_shown = np.maximum(stays[0], low - beyond), np.minimum(stays[1], high + beyond)
        return np.array([np.minimum(low, fixed_shown[0]), np.maximum(high, fixed_shown[1])])

    @property
    def extent_seen(self) -> Array:
        """Width and height of the drawing [m], shape (2,)."""
        return np.asarray(np.ptp(self.extent(), axis=0))

    @cached_property
    def _numbers(self) -> Integers:
        """Numbers of the blocks that are not fixed."""
        case = self.moving.case
        return np.array([i for i in range(len(case.centroids)) if case.body_of(i) is not None], dtype=int)

    @cached_property
    def _padded(self) -> Array:
        """The outlines as one array, shape (bodies, corners, 2)."""
        return padded_rows(self.outlines) if self.outlines else np.empty((0, 0, 2))


def combined(updates: Sequence[Update]) -> Update:
    """One update that makes several."""

    def update(frame: int) -> None:
        for move in updates:
            move(frame)

    return update


def make_static(ax: Axes, others: Sequence[Artist]) -> None:
    """Make all that is drawn part of a picture that does not move, but for what the axes had before."""
    for artist in set(ax.get_children()).difference(others):
        artist.set_animated(False)


def draw_outlines(ax: Axes, bodies: Bodies) -> Update:
    """Draw the outlines of bodies true to scale."""
    moving, supports = bodies.moving, list[tuple[Polygon, Array]]()
    for number, outline in moving.case.fixed.items():
        patch = Polygon(outline, facecolor=GROUND_COLOUR, edgecolor="0.4", linewidth=0.8)
        if moving.case.support_of(number) is not None:
            supports.append((patch, moving.placed(number, outline)))
            patch.set_animated(True)
        ax.add_patch(patch)
    width = min(1.2, 12 / np.sqrt(max(1, len(bodies.outlines))))  # lines of many blocks would hide them
    look: Look = {"facecolors": bodies.colours, "edgecolor": "0.15", "linewidth": width}
    outlines = PolyCollection([], **look, zorder=2, animated=True)
    ax.add_collection(outlines, autolim=False)
    ax.set(aspect="equal", xlabel="$x$ [m]", ylabel="$z$ [m]")

    def update(frame: int) -> None:
        for patch, places in supports:
            patch.set_xy(places[frame])
        outlines.set_verts(bodies.corners(frame))  # type: ignore[arg-type]  # one array is drawn the fastest

    return update


def named_line(ax: Axes, label: str, colour: str, width: float) -> None:
    """A legend of one line of a width [pt]: below the label of the x axis, in space in the upper right."""
    look: Look = {"loc": "upper right", "frameon": False, "fontsize": 8, "borderpad": 0.0}
    if ax.name != "3d":
        below = ScaledTranslation(0.0, -UNDER / 72, figure_of(ax).dpi_scale_trans)
        look |= {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "bbox_transform": ax.transAxes + below}
    line = Line2D([], [], color=colour, linewidth=width, solid_capstyle="butt")
    ax.legend([line], [label], **look)


def frame_view(ax: Axes, bodies: Bodies) -> None:
    """Set limits that every frame fits into, with a margin unless they are given."""
    low, high = bodies.extent()
    margin = 0.0 if bodies.limits is not None else 0.06 * float((high - low).max())
    ax.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))


def ties_of_masonry(ax: Axes, case: MasonryCase, bodies: Bodies) -> Update:
    """Links of blocks, each from its block to an anchor. An anchor that is far lies at the edge of the picture."""
    low, high = bodies.extent()
    edge = float(low[0]) - 0.25 * float(high[1] - low[1])
    updates = [anchored(ax, bodies.moving, tie, markersize=5, edge=edge) for tie in case.links.values()]
    plain = plain_names(case.links)
    for name, tie in case.links.items():
        place = edge, case.held_by(tie)[1] + tie.rise
        ax.annotate(plain[name], place, (4, 4), textcoords="offset points", fontsize=8, color=tie.colour)
    if updates and bodies.limits is None:
        ax.set_xlim(left=edge - 0.03 * float(high[1] - low[1]))
    return combined(updates)


def anchored(ax: Axes, moving: BodyMotion, tie: Anchored, *, markersize: float, edge: float = -np.inf) -> Update:
    """Draw a link of the plane, and its anchor as a square. An anchor beyond an x [m] is drawn there."""
    block_end, anchor = link_ends(moving.case, tie)
    if anchor.block is None and anchor.point[0] < edge:
        arm = anchor.point - block_end.point
        anchor = LinkEnd(None, block_end.point + arm * (block_end.point[0] - edge) / tie.length)
    ends = placed_ends(moving, anchor, block_end)
    follow = link(ax, moving, tie, ends)
    look: Look = {"marker": "s", "markersize": markersize, "color": tie.colour, "zorder": 4}
    (mark,) = ax.plot(*anchor.point[:, None], animated=anchor.block is not None, **look)

    def update(frame: int) -> None:
        mark.set_data(ends[frame, 0][:, None])
        follow(frame)

    return update


def link(ax: Axes, moving: BodyMotion, tie: Anchored, ends: Array) -> Update:
    """Draw a link between its ends [m], shape (n, 2, d): solid where it pulls, dotted where it is slack, gone once it
    broke."""
    pulls, broken = pulling(moving, tie)
    (line,) = ax.plot(*np.empty((ends.shape[2], 0)), color=tie.colour, linewidth=1.8, zorder=4, animated=True)
    set_points = getattr(line, "set_data" if ends.shape[2] == 2 else "set_data_3d")

    def update(frame: int) -> None:
        set_points(*ends[frame].T)
        line.set_linestyle(tie.dashes if pulls[frame] else ":")
        line.set_visible(not broken[frame])

    return update


def placed_ends(moving: BodyMotion, *ends: LinkEnd) -> Array:
    """Where the ends of a link are drawn [m], shape (n, ends, d)."""
    return np.stack([moving.placed(end.block, end.point[None])[:, 0] for end in ends], axis=1)


def pulling(moving: BodyMotion, tie: Anchored, before: float = 0.0) -> tuple[Flags, Flags]:
    """Whether a link acts at each frame, and whether it has broken, from how far its slider had moved before [m].

    A tie acts where it is longer than when it was slack or last yielded, and what also pushes acts always.
    """
    law = tie.law
    if not law.holds:
        return np.ones(len(moving.t), dtype=bool), np.zeros(len(moving.t), dtype=bool)
    elongation = elongation_of(moving, tie)
    yielded = law.plastic_elongation(elongation, before)
    broken: Flags = yielded > law.ultimate
    return (elongation > yielded) & ~broken, broken
