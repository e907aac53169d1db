"""Rigid bodies in motion, as a picture needs them: outlines, where they rest, and how they move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from ..problem.masonry.case import AnyCase
from ..problem.masonry.masonry import Masonry
from ..quantities import (
    Array,
    Integers,
    require_array,
    require_kind,
    require_reals,
    require_row,
    require_within,
    shown,
)
from ..result.bodies import Moving
from ..result.response import Response
from ..scene.tints import TINTS, colours_of, told_apart


def require_masonry(what: str, response: Response) -> Masonry:
    """The masonry of a response; for one of a wall a ValueError says what takes masonry alone."""
    if response.joints is None:
        raise ValueError(f"{what} takes masonry or a response of it, and this response is one of a wall")
    return response.of_masonry.masonry


BAR = 0.25
"""Longest scale bar over the width of what is seen [-]."""
Ends = tuple[Array, Array]
"""The lowest and the highest x and z of something [m], shape (2,) each."""


def ends_of(points: Array) -> tuple[Array, Array]:
    """The lowest and the highest x and z of points [m], shape (..., 2)."""
    flat = points.reshape(-1, 2)
    return flat.min(axis=0), flat.max(axis=0)


def round_length(wide: float) -> float:
    """The length of a scale bar of a picture so wide [m]: 1, 2 or 5 times a power of ten, at most a quarter of it."""
    most = BAR * wide * (1 + 1e-9)
    power = float(10.0 ** np.floor(np.log10(most)))
    return power * max(step for step in (1, 2, 5) if step * power <= most)


def evened(rows: Sequence[Array]) -> Array:
    """Rows of points as one array; shorter ones repeat their last point."""
    most = max(map(len, rows))
    return np.array([np.concatenate([row, np.repeat(row[-1:], most - len(row), axis=0)]) for row in rows])


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


def window(rest: Ends, moving: Ends, fixed: Ends) -> Ends:
    """The part of the plane that a picture shows [m]: bodies up to one extent of all from where they are at rest, and a
    quarter of it below, and fixed ones up to a quarter of it beyond. All are given by their lowest and highest x and z.
    """
    room = float((rest[1] - rest[0]).max())
    beyond = 0.25 * room
    low, high = np.maximum(moving[0], rest[0] - [room, beyond]), np.minimum(moving[1], rest[1] + room)
    low, high = np.minimum(low, rest[1]), np.maximum(high, rest[0])
    return (
        np.minimum(low, np.maximum(fixed[0], low - beyond)),
        np.maximum(high, np.minimum(fixed[1], high + beyond)),
    )


def _outlines(name: str, given: object) -> tuple[Array, ...]:
    """Outlines as arrays of shape (corners, 2)."""
    if isinstance(given, np.ndarray) and given.ndim:
        given = list(given)
    if not isinstance(given, Sequence) or isinstance(given, str):
        raise TypeError(f"{name} = {shown(given)} is not a sequence of outlines")
    outlines = []
    for i, outline in enumerate(given):
        corners = require_reals(f"{name}[{i}]", outline, "corners x, z [m], shape (n, 2)")
        outlines.append(require_array(f"{name}[{i}]", corners, (len(np.atleast_1d(corners)), 2)))
    return tuple(outlines)


@dataclass(frozen=True, eq=False)
class Loose:
    """Bodies of the plane without joints, in place of a case.

    Args:
        outlines: corners of each about its centroid, at rest [m], shape (corners, 2) each.
        rests: centroid of each at rest [m], shape (bodies, 2).
        grounds: corners of fixed bodies [m], which are numbered after the others.
    """

    outlines: tuple[Array, ...]
    rests: Array
    grounds: tuple[Array, ...]

    @property
    def fixed(self) -> dict[int, Array]:
        """Corners of the fixed bodies [m], by their numbers."""
        return dict(enumerate(self.grounds, len(self.outlines)))

    @property
    def centroids(self) -> Array:
        """Centroids of all [m], shape (all, 2); fixed ones are given about the origin."""
        return np.concatenate([self.rests, np.zeros((len(self.grounds), 2))])

    def body_of(self, block: int) -> int | None:
        """The number of a body, None of a fixed one."""
        return block if block < len(self.outlines) else None

    def support_of(self, block: int) -> None:
        """Nothing moves what is fixed."""


@dataclass(frozen=True, eq=False)
class Bodies:
    """Rigid bodies of the plane, as a picture shows them.

    Args:
        moving: where they are.
        colours: red, green and blue of those that are not fixed, 0 to 1, shape (bodies, 3).
        limits: lowest and highest x, and lowest and highest z, of the picture [m]; None shows what moves, see `extent`.
    """

    moving: Moving
    colours: Array
    limits: Array | None = None

    @classmethod
    def of(cls, response: Response, magnify: float = 1.0, limits: ArrayLike | None = None) -> Bodies:
        """The bodies of a response: the wall, or the blocks of masonry that are not fixed."""
        require_kind("response", response, Response)
        if response.case.in_space:
            response.of_masonry.masonry.require_plane("Bodies")
        magnify = require_within("magnify", magnify, 0.01, 1e4)
        return cls.at_poses(response.case, response.t, response.pose, magnify, limits)

    @classmethod
    def at_poses(
        cls,
        case: AnyCase,
        t: Array,
        pose: Array,
        magnify: float = 1.0,
        limits: ArrayLike | None = None,
    ) -> Bodies:
        """The bodies of a case at times [s] and poses, see `Moving`."""
        free = [solid.body >= 0 for solid in case.standing.solids]
        colours = colours_of(case.standing)[free]
        return cls(Moving(case, t, pose, magnify), colours, required_limits(limits, "xz"))

    @classmethod
    def loose(
        cls,
        t: ArrayLike,
        outlines: object,
        rests: ArrayLike,
        poses: ArrayLike,
        magnify: float = 1.0,
        fixed: object = (),
        limits: ArrayLike | None = None,
    ) -> Bodies:
        """Bodies that are given one by one.

        Args:
            t: times [s], shape (n,), increasing.
            outlines: corners of each body about its centroid, at rest [m], one array of shape (corners, 2) each.
            rests: centroid of each body at rest, x and z [m], shape (bodies, 2).
            poses: displacement x, z of each centroid from rest [m] and rotation [rad], shape (n, bodies, 3). A positive
                rotation turns the top of a body to the right, towards positive x.
            magnify: factor on the displacement of every point [-], 0.01 to 10000; 1 is true to scale.
            fixed: outlines of fixed bodies, in place [m].
            limits: see above.

        Raises:
            TypeError, ValueError: for arrays that do not fit together, or a factor outside its range.
        """
        times = require_row("t", t, "time [s]")
        if not (np.diff(times) >= 0).all():
            raise ValueError(f"t = {shown(t)} decreases; one row of increasing times [s] is needed")
        free, stays = _outlines("outlines", outlines), _outlines("fixed", fixed)
        magnify = require_within("magnify", magnify, 0.01, 1e4)
        case = cast(AnyCase, Loose(free, require_array("rests", rests, (len(free), 2)), stays))
        moving = Moving(case, times, require_array("poses", poses, (len(times), len(free), 3)), magnify)
        colours = np.array([TINTS[tint] for tint in told_apart(len(free), ())])
        return cls(moving, colours, required_limits(limits, "xz"))

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

    def placed(self, frame: int, body: int, points: Array) -> Array:
        """Where points of a body are drawn at a frame [m], shape (n, 2).

        The points are given about the centroid of the body at rest [m], shape (n, 2). Their displacement is drawn times
        `magnify`. A point that does not move, such as a toe, then stays where it is; what is magnified is distorted.
        """
        return np.asarray(self.moving.placed_at(frame, self._numbers[[body]], points[None])[0])

    def corners(self, frame: int) -> Array:
        """Where the corners of all bodies are drawn at a frame [m], shape (bodies, corners, 2).

        A body with fewer corners than another repeats its last one.
        """
        return self.moving.placed_at(frame, self._numbers, self._padded)

    def extent(self) -> tuple[Array, Array]:
        """The lowest and the highest x and z that any corner reaches in the picture [m], shape (2,) each.

        What moves farther than one extent of the bodies at rest, or falls by a quarter of it below all of them, is
        outside. Fixed bodies are shown up to a quarter beyond those that move. Given limits come first.
        """
        if self.limits is not None:
            return self.limits[:, 0], self.limits[:, 1]
        fixed = [*self.moving.case.fixed.values()]
        if not self.outlines:
            return ends_of(np.concatenate(fixed))
        some = np.unique(np.linspace(0, len(self.t) - 1, 500).astype(int))
        moving = np.array([ends_of(self.corners(int(frame))) for frame in some])
        rests = self.moving.case.rests
        stays = np.concatenate(fixed) if fixed else rests
        return window(ends_of(rests[:, None] + self._padded), ends_of(moving), ends_of(stays))

    @property
    def extent_seen(self) -> Array:
        """Width and height of what the picture has to hold [m], shape (2,)."""
        low, high = self.extent()
        return np.asarray(high - low)

    @cached_property
    def _numbers(self) -> Integers:
        """Numbers of the blocks that are not fixed."""
        case = self.moving.case
        return np.array([i for i in range(len(case.centroids)) if case.body_of(i) is not None], dtype=int)

    @cached_property
    def _padded(self) -> Array:
        """The outlines as one array, shape (bodies, corners, 2)."""
        return evened(self.outlines) if self.outlines else np.empty((0, 0, 2))
