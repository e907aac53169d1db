"""Bodies in space drawn pixel by pixel, each where it lies before all others, with edges and the shadows they throw."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled
from ..quantities import Array, Flags, Integers

SHADOW_MAP = 1500
"""Pixels along each side of the view from the sun, which finds the shadows."""
SHADOW_TOLERANCE = 6.0
"""How far behind the nearest surface a point may lie, seen from the sun, and still be lit [pixel of that view]."""
FLOOR, INK = (0.91, 0.9, 0.87), (0.17, 0.13, 0.11)
"""Colours of the ground and of edges."""
SHADE_BRIGHTNESS, UPWARD_GAIN, SUN_GAIN = 0.60, 0.08, 0.40
"""Brightness of a face in the shade that is vertical, what it gains as it turns upwards, and towards the sun [-]."""
SHADED = 0.78
"""Brightness of the ground in the shade [-]."""
FADE_START = 0.65
"""Where the ground begins to fade, over its radius [-]."""
EDGE_ON = 1e-9
"""Cosine of the angle between the line of sight and the normal of a face that is seen as a line [-]."""
BARE_GROUND, NO_SURFACE = -1, -2
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
        return cls(axes, 0.5 * (low + high), (SHADOW_MAP, SHADOW_MAP), float(np.linalg.norm(high - low)) / SHADOW_MAP)

    def seen(self, points: Array) -> Array:
        """Where points are: to the right and upwards from the lowest left corner, and how far before the middle
        [pixel], shape (..., 3)."""
        return (points - self.middle) @ self.axes.T / self.pixel + (0.5 * self.size[0], 0.5 * self.size[1], 0.0)

    @property
    def places(self) -> Array:
        """A point at the lowest left corner, and how it moves with each pixel to the right, upwards, and outwards [m],
        shape (4, 3)."""
        right, upwards, outwards = self.pixel * self.axes
        corner = self.middle - 0.5 * self.size[0] * right - 0.5 * self.size[1] * upwards
        return np.array([corner, right, upwards, outwards])

    def drawn(self, surfaces: Surfaces) -> tuple[Array, Integers]:
        """Distance of the surface that each pixel shows before the middle [pixel], and its number, (height, width)."""
        depth, shown = np.full(self.size[::-1], -np.inf), np.full(self.size[::-1], NO_SURFACE)
        _draw(self.seen(surfaces.corners), surfaces.normals @ self.axes[2] > EDGE_ON, depth, shown)
        return depth, shown

    def picture(self, surfaces: Surfaces, sun: Array, ground: Ground | None, edge: int, fine: int = 1) -> Array:
        """Red, green, blue and opacity, 0 to 1, shape (height, width, 4), lowest row first.

        Args:
            surfaces: what is drawn.
            sun: unit vector to the sun, shape (3,).
            ground: below them, or None.
            edge: width of edges [pixel].
            fine: pixels along each side of one of the picture, which has the mean of their colours.
        """
        depth, shown = self.drawn(surfaces)
        to_ground = self.places
        if ground is not None and self.axes[2, 2] > 0:
            to_ground[0] -= (*ground.middle, ground.level)
            to_ground[:, :2] /= ground.radius
            _uncover(to_ground, depth, shown)
        sun_view = View.of_the_sun(sun, surfaces.corners)
        sun_depth, to_sun, normals = sun_view.drawn(surfaces)[0], sun_view.seen(self.places), surfaces.normals
        to_sun[1:] -= sun_view.seen(np.zeros(3))
        brightness = (SHADE_BRIGHTNESS + UPWARD_GAIN * normals[:, 2])[:, None]
        brightness = brightness + SUN_GAIN * np.outer(np.maximum(normals @ sun, 0.0), (0.0, 1.0))
        tones = np.concatenate([brightness[..., None] * surfaces.colour[:, None], [np.outer((SHADED, 1.0), FLOOR)]])
        colours = np.zeros((self.size[1] // fine, self.size[0] // fine, 4))
        piece = np.append(surfaces.number, (NO_SURFACE, BARE_GROUND))
        light = Light(sun_depth, to_sun, to_ground, np.minimum(tones, 1.0))
        _paint(Parts(depth, shown, piece, edge, fine), light, colours)
        return colours


class Parts(NamedTuple):
    """The parts of a picture, some to a pixel.

    Args:
        depth: how far before the middle each lies [part].
        shown: number of the surface that each shows.
        piece: the plane piece of a body that each surface is of.
        edge: width of edges [part].
        fine: number of parts along each side of a pixel.
    """

    depth: Array
    shown: Integers
    piece: Integers
    edge: int
    fine: int


class Light(NamedTuple):
    """Sun and shade.

    Args:
        sun_depth: how far before the middle the surfaces lie that are seen from the sun.
        to_sun: the pixel of the view from the sun, as `View.places` has it.
        to_ground: the place over the radius of the ground, likewise.
        tones: colours of each surface, and of the ground, in the shade and in the sun, shape (n + 1, 2, 3).
    """

    sun_depth: Array
    to_sun: Array
    to_ground: Array
    tones: Array


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
def _uncover(to_ground: Array, depth: Array, shown: Integers) -> None:
    """Show the ground where it lies before what is there; `to_ground` is as `View.places`, from its level."""
    for row in range(depth.shape[0]):
        for column in range(depth.shape[1]):
            height = to_ground[0, 2] + (column + 0.5) * to_ground[1, 2] + (row + 0.5) * to_ground[2, 2]
            out = -height / to_ground[3, 2]
            if out > depth[row, column]:
                depth[row, column], shown[row, column] = out, BARE_GROUND


@compiled
def _paint(parts: Parts, light: Light, colours: Array) -> None:
    """Colour each pixel of a picture by the mean of its parts. Colours are 0 at first, shape (height, width, 4)."""
    depth, shown, piece, edge, fine = parts
    sun_depth, to_sun, to_ground, tones = light
    high, wide = depth.shape
    for part in range(colours.shape[0] * fine * colours.shape[1] * fine):
        row, column = part // (colours.shape[1] * fine), part % (colours.shape[1] * fine)
        surface, pixel = shown[row, column], colours[row // fine, column // fine]
        on_edge = False
        for k in range(edge):
            next_row, next_column = row + k, column + k
            if 0 < next_row < high and piece[shown[next_row, column]] != piece[shown[next_row - 1, column]]:
                on_edge = True
            if 0 < next_column < wide and piece[shown[row, next_column]] != piece[shown[row, next_column - 1]]:
                on_edge = True
        if on_edge:
            for i in range(3):
                pixel[i] += INK[i]
            pixel[3] += 1.0
        elif surface != NO_SURFACE:
            right, up, out = column + 0.5, row + 0.5, depth[row, column]
            x = to_sun[0, 0] + right * to_sun[1, 0] + up * to_sun[2, 0] + out * to_sun[3, 0]
            y = to_sun[0, 1] + right * to_sun[1, 1] + up * to_sun[2, 1] + out * to_sun[3, 1]
            before = to_sun[0, 2] + right * to_sun[1, 2] + up * to_sun[2, 2] + out * to_sun[3, 2]
            lit = 1
            in_sun_view = 0 <= x < sun_depth.shape[1] and 0 <= y < sun_depth.shape[0]
            if in_sun_view and before < sun_depth[int(y), int(x)] - SHADOW_TOLERANCE:
                lit = 0
            opaque = 1.0
            if surface == BARE_GROUND:
                x = to_ground[0, 0] + right * to_ground[1, 0] + up * to_ground[2, 0] + out * to_ground[3, 0]
                y = to_ground[0, 1] + right * to_ground[1, 1] + up * to_ground[2, 1] + out * to_ground[3, 1]
                opaque = min(max((1 - math.hypot(x, y)) / (1 - FADE_START), 0.0), 1.0)
                opaque *= opaque * (3 - 2 * opaque)
            for i in range(3):
                pixel[i] += opaque * tones[surface, lit, i]
            pixel[3] += opaque
        if row % fine == fine - 1 and column % fine == fine - 1 and pixel[3] > 0:
            for i in range(3):
                pixel[i] /= pixel[3]
            pixel[3] /= fine * fine
