"""What the rooms that find joints, and all that shows or steps blocks, ask of any block."""

from __future__ import annotations

from typing import Any, Protocol

from ....geometry.hull import Convex, Side
from ....quantities import Array, Flags


class Shape(Protocol):
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

    @property
    def solids(self) -> tuple[Convex, ...]:
        """Its convex parts in space, of a block of the plane prisms over its length."""

    @property
    def inside(self) -> tuple[Flags, ...]:
        """Of each of these, which faces nothing meets: those within the block, and the ends of prisms, (faces,)."""


class Flat(Shape, Protocol):
    """A block of the plane."""

    @property
    def length(self) -> float:
        """Its length out of the plane [m]."""
