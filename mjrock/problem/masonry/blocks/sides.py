"""Sides: the plane pieces of the surface of a block, and what the rooms that find joints ask of any block."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from ....quantities import Array


class Side(NamedTuple):
    """A plane piece of the surface of a block.

    Args:
        corners: in the plane the two ends of an edge, counterclockwise about the block [m], shape (2, 2). In space
            those of a convex polygon, counterclockwise as seen from outside [m], shape (n, 3).
        normal: unit vector out of the block, shape (d,).
        parts: numbers of the convex parts of the block that it bounds.
    """

    corners: Array
    normal: Array
    parts: tuple[int, ...] = (0,)


class Solid(Protocol):
    """What a block says of itself, convex or not: `Polygon`, `Polyhedron` or `Compound`."""

    @property
    def name(self) -> str | None:
        """What it is called, or None."""

    @property
    def fixed(self) -> bool:
        """Whether it belongs to the ground."""

    @property
    def corners(self) -> Array:
        """Its corners [m], shape (n, d)."""

    @property
    def parts(self) -> tuple[Any, ...]:
        """The convex parts that it is made of, all of one kind."""

    @property
    def sides(self) -> tuple[Side, ...]:
        """Its surface, in plane pieces."""


class Flat(Solid, Protocol):
    """A block of the plane."""

    @property
    def length(self) -> float:
        """Its length out of the plane [m]."""
