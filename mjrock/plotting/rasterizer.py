"""Bodies in space drawn pixel by pixel, each where it lies before all others, with edges and the shadows they throw."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..quantities import Array, Flags, Integers

MAP = 1500
"""Pixels along each side of the view from the sun, which finds the shadows."""
BEHIND = 6.0
"""How far behind the nearest surface a point may lie, seen from the sun, and still be lit [pixel of that view]."""
FLOOR, INK = (0.91, 0.9, 0.87), (0.17, 0.13, 0.11)
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
"""Numbers of the surface where a picture shows the ground, and where it is empty."""


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
        """The view from the sun of all corners [m], shape (..., 3); `sun` is a unit vector to it."""
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

    def drawn(self, surfaces: Surfaces) -> tuple[Array, Integers]:
        """Distance of the surface that each pixel shows before the middle [pixel], and its number, (height, width)."""
        depth, shown = np.full(self.size[::-1], -np.inf), np.full(self.size[::-1], EMPTY)
        _draw(self.seen(surfaces.corners), surfaces.normals @ self.axes[2] > ASIDE, depth, shown)
        return depth, shown

    def picture(self, surfaces: Surfaces, sun: Array, ground: Ground | None, line: int, times: int = 1) -> Array:
        """Red, green, blue and opacity, 0 to 1, shape (height, width, 4), lowest row first.

        Args:
            surfaces: what is drawn.
            sun: unit vector to the sun, shape (3,).
            ground: below them, or None.
            line: width of edges [pixel].
            times: pixels along each side of one of the picture, which has the mean of their colours.
        """
        depth, shown = self.drawn(surfaces)
        flat = self.places
        if ground is not None and self.axes[2, 2] > 0:
            flat[0] -= (*ground.middle, ground.level)
            flat[:, :2] /= ground.radius
            _uncover(flat, depth, shown)
        shining = View.of_the_sun(sun, surfaces.corners)
        shade, to_sun, normals = shining.drawn(surfaces)[0], shining.seen(self.places), surfaces.normals
        to_sun[1:] -= shining.seen(np.zeros(3))
        bright = (DARK + ALOFT * normals[:, 2])[:, None] + SUNNY * np.outer(np.maximum(normals @ sun, 0.0), (0.0, 1.0))
        tones = np.concatenate([bright[..., None] * surfaces.colour[:, None], [np.outer((SHADED, 1.0), FLOOR)]])
        colours = np.zeros((self.size[1] // times, self.size[0] // times, 4))
        number = np.append(surfaces.number, (EMPTY, BARE))
        _paint((depth, shown, number), (shade, to_sun, flat), np.minimum(tones, 1.0), (line, times), colours)
        return colours


@compiled
def _draw(corners: Array, facing: Flags, depth: Array, shown: Integers) -> None:
    """Draw each face that faces the camera, whose corners are given [pixel], where it lies before what is there."""
    high, wide = depth.shape
    for i in range(len(corners)):
        if not facing[i]:
            continue
        points, most, nx, ny, nz = corners[i], corners.shape[1], 0.0, 0.0, 0.0
        left, right, low, top = points[0, 0], points[0, 0], points[0, 1], points[0, 1]
        for k in range(1, most):
            x0, y0, z0 = (
                points[k - 1, 0] - points[0, 0],
                points[k - 1, 1] - points[0, 1],
                points[k - 1, 2] - points[0, 2],
            )
            x1, y1, z1 = points[k, 0] - points[0, 0], points[k, 1] - points[0, 1], points[k, 2] - points[0, 2]
            nx, ny, nz = nx + y0 * z1 - z0 * y1, ny + z0 * x1 - x0 * z1, nz + x0 * y1 - y0 * x1
            left, right = min(left, points[k, 0]), max(right, points[k, 0])
            low, top = min(low, points[k, 1]), max(top, points[k, 1])
        for row in range(max(0, math.floor(low)), min(high, math.ceil(top))):
            for column in range(max(0, math.floor(left)), min(wide, math.ceil(right))):
                x, y, inside = column + 0.5, row + 0.5, True
                for k in range(most):
                    before = k - 1 if k else most - 1
                    x0, y0, x1, y1 = points[before, 0], points[before, 1], points[k, 0], points[k, 1]
                    if (x1 - x0) * (y - y0) < (y1 - y0) * (x - x0):
                        inside = False
                        break
                if inside:
                    out = points[0, 2] - ((x - points[0, 0]) * nx + (y - points[0, 1]) * ny) / nz
                    if out > depth[row, column]:
                        depth[row, column], shown[row, column] = out, i


@compiled
def _uncover(flat: Array, depth: Array, shown: Integers) -> None:
    """Show the ground where it lies before what is there; `flat` is the height above it, as `View.places` has it."""
    for row in range(depth.shape[0]):
        for column in range(depth.shape[1]):
            out = -(flat[0, 2] + (column + 0.5) * flat[1, 2] + (row + 0.5) * flat[2, 2]) / flat[3, 2]
            if out > depth[row, column]:
                depth[row, column], shown[row, column] = out, BARE


@compiled
def _paint(
    seen: tuple[Array, Integers, Integers],
    ways: tuple[Array, Array, Array],
    tones: Array,
    sizes: tuple[int, int],
    colours: Array,
) -> None:
    """Colour each pixel of a picture by the mean of its parts.

    Args:
        seen: how far before the middle the parts lie, which surface they show, and of which plane piece each is.
        ways: how far before the middle the surfaces lie that are seen from the sun; how to get from a pixel to one of
            that view, and to a place over the radius of the ground, as in `View.places`.
        tones: colours of each surface, and of the ground, in the shade and in the sun, shape (n + 1, 2, 3).
        sizes: width of edges, and number of parts along each side [pixel].
        colours: of the pixels, 0 at first, shape (height, width, 4).
    """
    (depth, shown, number), (shade, sun, flat), (line, times) = seen, ways, sizes
    high, wide = depth.shape
    for part in range(colours.shape[0] * times * colours.shape[1] * times):
        row, column = part // (colours.shape[1] * times), part % (colours.shape[1] * times)
        there, pixel = shown[row, column], colours[row // times, column // times]
        edge = False
        for k in range(line):
            above, beside = row + k, column + k
            if 0 < above < high and number[shown[above, column]] != number[shown[above - 1, column]]:
                edge = True
            if 0 < beside < wide and number[shown[row, beside]] != number[shown[row, beside - 1]]:
                edge = True
        if edge:
            for i in range(3):
                pixel[i] += INK[i]
            pixel[3] += 1.0
        elif there != EMPTY:
            right, up, out = column + 0.5, row + 0.5, depth[row, column]
            x = sun[0, 0] + right * sun[1, 0] + up * sun[2, 0] + out * sun[3, 0]
            y = sun[0, 1] + right * sun[1, 1] + up * sun[2, 1] + out * sun[3, 1]
            before = sun[0, 2] + right * sun[1, 2] + up * sun[2, 2] + out * sun[3, 2]
            lit = 1
            if 0 <= x < shade.shape[1] and 0 <= y < shade.shape[0] and before < shade[int(y), int(x)] - BEHIND:
                lit = 0
            opaque = 1.0
            if there == BARE:
                x = flat[0, 0] + right * flat[1, 0] + up * flat[2, 0] + out * flat[3, 0]
                y = flat[0, 1] + right * flat[1, 1] + up * flat[2, 1] + out * flat[3, 1]
                opaque = min(max((1 - math.hypot(x, y)) / (1 - FADES), 0.0), 1.0)
                opaque *= opaque * (3 - 2 * opaque)
            for i in range(3):
                pixel[i] += opaque * tones[there, lit, i]
            pixel[3] += opaque
        if row % times == times - 1 and column % times == times - 1 and pixel[3] > 0:
            for i in range(3):
                pixel[i] /= pixel[3]
            pixel[3] /= times * times
