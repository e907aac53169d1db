"""Bodies in space drawn pixel by pixel, each where it lies before all others, with edges and the shadows they throw."""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from ..quantities import Array, Flags, Integers

MAP = 1500
"""Pixels along each side of what the sun sees."""
BEHIND = 6.0
"""How far behind what the sun sees a point may lie and still be lit [pixel of the sun]."""
FLOOR, INK = np.array((0.91, 0.9, 0.87)), np.array((0.17, 0.13, 0.11))
"""Colours of the ground and of edges."""
DARK, ALOFT, SUNNY = 0.60, 0.08, 0.40
"""Brightness of a face in the shade that is vertical, what it gains as it turns upwards, and towards the sun [-]."""
SHADED = 0.78
"""Brightness of the ground in the shade [-]."""
FADES = 0.65
"""Where the ground begins to fade, over its radius [-]."""
ASIDE = 1e-9
"""Cosine of the angle between the line of sight and the normal of a face that is seen as a line [-]."""
BARE, EMPTY = -1, -2
"""Numbers of the surface where a picture shows the ground, and where it shows nothing."""


class Surfaces(NamedTuple):
    """Convex faces.

    Args:
        corners: of each, counterclockwise as seen from outside [m], shape (n, most, 3). Those with few repeat the last.
        number: of the plane piece of a body that it is part of. Where two of them meet in a picture, there is an edge.
        colour: red, green and blue, 0 to 1, shape (n, 3).
    """

    corners: Array
    number: Integers
    colour: Array

    @property
    def normals(self) -> Array:
        """Unit normals, shape (n, 3)."""
        arms = self.corners - self.corners[:, :1]
        normals = np.cross(arms, np.roll(arms, -1, axis=1)).sum(axis=1)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.asarray(normals / np.where(length > 0, length, 1.0))


class Ground(NamedTuple):
    """Level ground that fades at its rim.

    Args:
        level: its height [m].
        middle: x and y of its middle [m], shape (2,).
        radius: of its rim [m].
    """

    level: float
    middle: Array
    radius: float


class View(NamedTuple):
    """A picture without perspective.

    Args:
        axes: unit vectors to the right, upwards and out of it, shape (3, 3).
        middle: a point that is seen in its middle [m], shape (3,).
        size: its width and height [pixel].
        pixel: side of a pixel [m].
    """

    axes: Array
    middle: Array
    size: tuple[int, int]
    pixel: float

    @classmethod
    def of_the_sun(cls, sun: Array, corners: Array) -> View:
        """What the sun sees of all corners [m], shape (..., 3); `sun` is a unit vector to it."""
        ends = corners.reshape(-1, 3)
        low, high = ends.min(axis=0), ends.max(axis=0)
        right = np.cross((0.0, 0.0, 1.0), sun)
        right /= np.linalg.norm(right)
        axes = np.array([right, np.cross(sun, right), sun])
        return cls(axes, 0.5 * (low + high), (MAP, MAP), float(np.linalg.norm(high - low)) / MAP)

    def seen(self, points: Array) -> Array:
        """Where points are: to the right and upwards from the lowest left corner, and how far before the middle
        [pixel], shape (..., 3)."""
        return (points - self.middle) @ self.axes.T / self.pixel + (0.5 * self.size[0], 0.5 * self.size[1], 0.0)

    @property
    def places(self) -> Array:
        """A point at the lowest left corner, and how it moves with each pixel to the right, upwards, and outwards [m],
        shape (4, 3)."""
        ways = self.pixel * self.axes
        return np.array([self.middle - 0.5 * self.size[0] * ways[0] - 0.5 * self.size[1] * ways[1], *ways])

    def along(self, way: Array) -> Array:
        """A number at the centre of each pixel, which grows linearly from the lowest left corner, (height, width).

        Args:
            way: the number there, and what it grows by with each pixel to the right and upwards, shape (3,).
        """
        right, up = (np.arange(count, dtype=np.float32) + 0.5 for count in self.size)
        return np.float32(way[0]) + np.float32(way[2]) * up[:, None] + np.float32(way[1]) * right

    def drawn(self, surfaces: Surfaces) -> tuple[Array, Integers]:
        """How far before the middle what each pixel shows lies [pixel], and which surface it is, (height, width)."""
        depth, shown = np.full(self.size[::-1], -np.inf, dtype=np.float32), np.full(self.size[::-1], EMPTY)
        corners = self.seen(surfaces.corners)
        for i in np.flatnonzero(surfaces.normals @ self.axes[2] > ASIDE).tolist():
            self._draw(corners[i], i, depth, shown)
        return depth, shown

    def _draw(self, corners: Array, number: int, depth: Array, shown: Integers) -> None:
        """Draw a face that faces the camera, whose corners are given [pixel], where it lies before what is there."""
        low = np.clip(np.floor(corners[:, :2].min(axis=0)), 0, self.size).astype(int)
        high = np.clip(np.ceil(corners[:, :2].max(axis=0)), 0, self.size).astype(int)
        x, y = np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1])[:, None] + 0.5
        inside, after = np.ones((len(y), len(x)), dtype=bool), np.roll(corners, -1, axis=0)
        for (x0, y0, _), (x1, y1, _) in zip(corners.tolist(), after.tolist(), strict=True):
            if (x0, y0) != (x1, y1):
                inside &= (x1 - x0) * (y - y0) >= (y1 - y0) * (x - x0)
        normal = np.cross(corners - corners[0], after - corners[0]).sum(axis=0)
        slope = normal[:2] / normal[2]
        there = np.s_[low[1] : high[1], low[0] : high[0]]
        before = corners[0, 2] - (x - corners[0, 0]) * slope[0] - (y - corners[0, 1]) * slope[1]
        inside &= before > depth[there]
        depth[there][inside], shown[there][inside] = before[inside], number

    def picture(self, surfaces: Surfaces, sun: Array, ground: Ground | None, line: int) -> Array:
        """Red, green, blue and opacity, 0 to 1, shape (height, width, 4), lowest row first.

        Args:
            surfaces: what is drawn.
            sun: unit vector to the sun, shape (3,).
            ground: below them, or None.
            line: width of edges [pixel].
        """
        depth, shown = self.drawn(surfaces)
        if ground is not None and self.axes[2, 2] > 0:
            fall = self.places[:, 2] - (ground.level, 0.0, 0.0, 0.0)
            bare = self.along(-fall[:3] / fall[3])
            shown[bare > depth] = BARE
            depth = np.maximum(depth, bare)
        lit = self._lit(surfaces, sun, np.where(shown == EMPTY, 0, depth))
        normals = surfaces.normals
        bright = (DARK + ALOFT * normals[:, 2])[:, None] + SUNNY * np.outer(np.maximum(normals @ sun, 0.0), (0.0, 1.0))
        tones = np.minimum(bright[..., None] * surfaces.colour[:, None], 1.0)
        table = np.concatenate([tones, np.zeros((1, 2, 3)), [[SHADED * FLOOR, FLOOR]]]).astype(np.float32)
        table = np.concatenate([table, np.float32(table[..., :1] > 0)], axis=2)  # what is empty is not opaque
        colours = table.reshape(-1, 4)[2 * (shown % len(table)) + lit]
        if ground is not None:
            x, y = (self.along(self.places[:3, i] - ground.middle[i] * np.eye(3)[0]) for i in range(2))
            far = np.hypot(x + depth * self.places[3, 0], y + depth * self.places[3, 1]) / ground.radius
            fade = np.clip((1 - far) / (1 - FADES), 0.0, 1.0)
            colours[..., 3] = np.where(shown == BARE, fade**2 * (3 - 2 * fade), colours[..., 3])
        colours[edges_of(np.where(shown < 0, shown, surfaces.number[shown]), line)] = (*INK, 1.0)
        return cast(Array, colours)

    def _lit(self, surfaces: Surfaces, sun: Array, depth: Array) -> Flags:
        """Whether the sun shines on what the pixels show."""
        shining = View.of_the_sun(sun, surfaces.corners)
        shade, ways = shining.drawn(surfaces)[0], shining.seen(self.places)
        ways[1:] -= shining.seen(np.zeros(3))
        x, y, before = (self.along(ways[:3, i]) + np.float32(ways[3, i]) * depth for i in range(3))
        within = (x >= 0) & (x < MAP) & (y >= 0) & (y < MAP)
        seen = shade[np.where(within, y, 0).astype(int), np.where(within, x, 0).astype(int)]
        return np.asarray(~within | (before > seen - BEHIND))


def edges_of(numbers: Integers, line: int) -> Flags:
    """Which pixels lie on an edge, of a width in pixels, where a picture shows another number than beside it."""
    edge = np.zeros(numbers.shape, dtype=bool)
    for before, after in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
        edge[after] |= numbers[before] != numbers[after]
        for _ in range(line - 1):
            edge[before] |= edge[after].copy()
    return edge


def coarser(colours: Array, times: int) -> Array:
    """Colours of pixels that are so many times as wide and high, each in proportion to the opacity of its parts."""
    if times == 1:
        return colours
    weighted = np.concatenate([colours[..., :3] * colours[..., 3:], colours[..., 3:]], axis=2)
    every = [weighted[i::times, j::times] for i in range(times) for j in range(times)]
    mean = np.sum(every, axis=0) / len(every)
    mean[..., :3] /= np.maximum(mean[..., 3:], 1e-6)
    return np.asarray(mean)
