"""Rigid bodies in motion, as a picture needs them: outlines, where they rest, and how they move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.poses import displaced
from ..problem.masonry.case import AnyCase
from ..problem.masonry.masonry import Masonry
from ..quantities import Array, keep, require_array, require_kind, require_reals, require_row, require_within, shown
from ..result.bodies import Moving
from ..result.response import Response


def require_masonry(what: str, response: Response) -> Masonry:
    """The masonry of a response; for one of a wall a ValueError says what takes masonry alone."""
    if response.joints is None:
        raise ValueError(f"{what} takes masonry or a response of it, and this response is one of a wall")
    return response.of_masonry.masonry


Ends = tuple[Array, Array]
"""The lowest and the highest x and z of something [m], shape (2,) each."""


def interpolated(times: Array, t: Array, poses: Array) -> Array:
    """Poses of shape (n, bodies, numbers) at other times, linearly."""
    columns = poses.reshape(len(t), -1).T
    between = np.stack([np.interp(times, t, column) for column in columns], axis=-1)
    return between.reshape(len(times), *poses.shape[1:])


def ends_of(points: Array) -> tuple[Array, Array]:
    """The lowest and the highest x and z of points [m], shape (..., 2)."""
    flat = points.reshape(-1, 2)
    return flat.min(axis=0), flat.max(axis=0)


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
class Bodies:
    """Rigid bodies in their plane, and their motion.

    Args:
        t: times [s], shape (n,), increasing.
        outlines: corners of each body about its centroid, at rest [m], one array of shape (corners, 2) each.
        rests: centroid of each body at rest, x and z [m], shape (bodies, 2).
        poses: displacement x, z of each centroid from rest [m] and rotation [rad], shape (n, bodies, 3). A positive
            rotation turns the top of a body to the right, towards positive x.
        magnify: factor on the displacement of every point [-], 0.01 to 10000; 1 is true to scale.
        fixed: outlines of fixed bodies, in place [m].
        shifts: displacement of each fixed body that is moved, by its number among them [m], shape (n, 2) each.
        limits: lowest and highest x, and lowest and highest z, of the picture [m]; None shows what moves, see `extent`.

    Raises:
        TypeError, ValueError: for arrays that do not fit together, or a factor outside its range.
    """

    t: Array
    outlines: tuple[Array, ...]
    rests: Array
    poses: Array
    magnify: float = 1.0
    fixed: tuple[Array, ...] = ()
    shifts: Mapping[int, Array] = field(default_factory=dict)
    limits: Array | None = None

    def __post_init__(self) -> None:
        times = require_row("t", self.t, "time [s]")
        if not (np.diff(times) >= 0).all():
            raise ValueError(f"t = {shown(self.t)} decreases; one row of increasing times [s] is needed")
        keep(self, outlines=_outlines("outlines", self.outlines), fixed=_outlines("fixed", self.fixed), t=times)
        count = len(self.outlines)
        keep(
            self,
            limits=required_limits(self.limits, "xz"),
            magnify=require_within("magnify", self.magnify, 0.01, 1e4),
            rests=require_array("rests", self.rests, (count, 2)),
            poses=require_array("poses", self.poses, (len(times), count, 3)),
        )

    @classmethod
    def of(cls, response: Response, magnify: float = 1.0, limits: ArrayLike | None = None) -> Bodies:
        """The bodies of a response: the wall, or the blocks of masonry that are not fixed."""
        require_kind("response", response, Response)
        case, t = response.case, response.t
        if case.in_space:
            response.of_masonry.masonry.require_plane("Bodies")
        moved = {i: case.support_of(block) for i, block in enumerate(case.fixed)}
        shifts = {i: support.at(t) for i, support in moved.items() if support is not None}
        corners = tuple(case.fixed.values())
        return cls(t, case.outlines, case.rests, response.pose, magnify, corners, shifts, limits)  # type: ignore[arg-type]

    def of_case(self, case: AnyCase) -> Moving:
        """Where the bodies of the case are drawn."""
        return Moving(case, self.t, self.poses, self.magnify)

    def at(self, times: Array) -> Bodies:
        """The same bodies at other times, their poses interpolated linearly."""
        shifts = {i: interpolated(times, self.t, shift) for i, shift in self.shifts.items()}
        return replace(self, t=times, poses=interpolated(times, self.t, self.poses), shifts=shifts)

    def placed(self, frame: int, body: int, points: Array) -> Array:
        """Where points of a body are drawn at a frame [m], shape (n, 2).

        The points are given about the centroid of the body at rest [m], shape (n, 2). Their displacement is drawn times
        `magnify`. A point that does not move, such as a toe, then stays where it is; what is magnified is distorted.
        """
        return self._drawn(self.poses[frame, body], self.rests[body], points)

    def support(self, frame: int, body: int) -> Array:
        """Where the corners of a fixed body are drawn at a frame [m], shape (corners, 2)."""
        return self.fixed[body] + (self.magnify * self.shifts[body][frame] if body in self.shifts else 0.0)

    def corners(self, frame: int) -> Array:
        """Where the corners of all bodies are drawn at a frame [m], shape (bodies, corners, 2).

        A body with fewer corners than another repeats its last one.
        """
        return self._drawn(self.poses[frame], self.rests, self._padded)

    def extent(self) -> tuple[Array, Array]:
        """The lowest and the highest x and z that any corner reaches in the picture [m], shape (2,) each.

        What moves farther than one extent of the bodies at rest, or falls by a quarter of it below all of them, is
        outside. Fixed bodies are shown up to a quarter beyond those that move. Given limits come first.
        """
        if self.limits is not None:
            return self.limits[:, 0], self.limits[:, 1]
        if not self.outlines:
            corners = np.concatenate(self.fixed)
            return corners.min(axis=0), corners.max(axis=0)
        some = np.unique(np.linspace(0, len(self.t) - 1, 500).astype(int))
        moving = np.array([ends_of(self.corners(int(frame))) for frame in some])
        fixed = np.concatenate(self.fixed) if self.fixed else self.rests
        return window(ends_of(self.rests[:, None] + self._padded), ends_of(moving), ends_of(fixed))

    @cached_property
    def _padded(self) -> Array:
        """The outlines as one array, shape (bodies, corners, 2)."""
        return evened(self.outlines) if self.outlines else np.empty((0, 0, 2))

    def _drawn(self, pose: Array, rest: Array, points: Array) -> Array:
        """Points about centroids [m], shape (..., n, 2), drawn at poses of shape (..., 3)."""
        return np.asarray(rest[..., None, :] + points + self.magnify * displaced(points, pose))
