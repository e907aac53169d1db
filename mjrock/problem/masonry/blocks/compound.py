"""A unit of several convex parts that move as one body, such as an L, a U or a hook."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, Self

import numpy as np

from ....geometry.graph import connected_parts
from ....geometry.hull import Convex, Side
from ....quantities import Array, Flags, frozen, keep, require_flag, require_kind, require_sequence, short_repr
from .joints import PARTS_APART, Joint, joints_in_plane
from .joints_in_space import SpaceJoint, joints_in_space
from .polygon import COORDINATE, Polygon, checked_name
from .polyhedron import Polyhedron, PrincipalInertia, principal_of
from .surface import Surface, surface_in_plane, surface_in_space

MOST_PARTS = 1000
"""Most parts of a unit."""


@dataclass(frozen=True)
class Compound:
    """A unit that need not be convex: convex parts that are joined for good and move as one body.

    Its mass, centroid and inertia are the sums of those of the parts. Its surface is that of the whole: where parts lie
    on each other there is none, and what lies in one plane across a cut is one side, in space where it is convex. So it
    makes no difference to joints in the plane where a unit is cut.

    Args:
        parts: the convex parts, all `Polygon` or all `Polyhedron`, 2 to 1000, none of them fixed. Each touches another
            along an edge or a face within 1e-5 m, and none overlaps another by more. Their names are not used, and
            their densities may differ, and so may the lengths of polygons out of the plane, as those of a wall and of
            its buttresses. A joint has the length of the part that makes it.
        fixed: whether the unit belongs to the ground.
        name: as of a `Polygon`.

    Raises:
        TypeError: for parts that are not blocks of one kind.
        ValueError: for parts that overlap or do not hang together, or a value outside its range.

    Examples:
        >>> upright, foot = mr.Polygon([(0, 0), (1, 0), (1, 3), (0, 3)]), mr.Polygon([(1, 0), (2, 0), (2, 1), (1, 1)])
        >>> mr.Compound([upright, foot], name="L").mass
        8000.0
    """

    parts: tuple[Polygon | Polyhedron, ...]
    fixed: bool = False
    name: str | None = field(default=None)

    __repr__ = short_repr

    def __init__(self, parts: Sequence[Polygon | Polyhedron], fixed: bool = False, name: str | None = None) -> None:
        keep(self, parts=checked_parts(parts), fixed=require_flag("fixed", fixed), name=checked_name(name))
        _ = self.joined

    @classmethod
    def prism(cls, compound: Compound, middle: Annotated[float, COORDINATE] = 0.0) -> Self:
        """A unit of the plane as a body in space, see `Polyhedron.prism`.

        Args:
            compound: the unit, whose densities, name and support are kept.
            middle: y of the middle of its length [m], -10000 to 10000.

        Raises:
            ValueError: for a value outside its range.
        """
        require_kind("compound", compound, Compound)
        return cls([Polyhedron.prism(part, middle) for part in compound.polygons], compound.fixed, compound.name)

    @property
    def in_space(self) -> bool:
        """Whether it is a body in space."""
        return isinstance(self.parts[0], Polyhedron)

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The parts of a unit in the plane; none in space."""
        return tuple(part for part in self.parts if isinstance(part, Polygon))

    @property
    def polyhedra(self) -> tuple[Polyhedron, ...]:
        """The parts of a unit in space; none in the plane."""
        return tuple(part for part in self.parts if isinstance(part, Polyhedron))

    @property
    def length(self) -> float:
        """Length out of the plane, of the longest part [m]; in space the extent along y."""
        return float(np.ptp(self.corners[:, 1])) if self.in_space else max(part.length for part in self.polygons)

    @cached_property
    def joined(self) -> tuple[Joint | SpaceJoint, ...]:
        """Where the parts lie on each other.

        Raises:
            ValueError: if they overlap or do not hang together.
        """
        find = joints_in_space if self.in_space else joints_in_plane
        try:
            joints: tuple[Joint | SpaceJoint, ...] = find(_named(self.parts), PARTS_APART, PARTS_APART)  # type: ignore[arg-type]
        except ValueError as error:
            raise ValueError(f"parts: {error}") from None
        labels = connected_parts([(joint.below, joint.above) for joint in joints], len(self.parts))
        if labels.any():
            loose = int(labels.argmax())
            raise ValueError(
                f"parts: part {loose} hangs together with part 0 along no {'face' if self.in_space else 'edge'}; parts "
                f"that touch are at most {PARTS_APART:g} m apart"
            )
        return joints

    @cached_property
    def surface(self) -> Surface:
        """The surface of the whole, and the sides of parts that lie inside it."""
        return (surface_in_space if self.in_space else surface_in_plane)(self.parts, self.joined, PARTS_APART)  # type: ignore[arg-type]

    @property
    def sides(self) -> tuple[Side, ...]:
        """Its surface, in plane pieces."""
        return self.surface.sides

    @property
    def solids(self) -> tuple[Convex, ...]:
        """Its parts in space, see `Polygon.solids`."""
        return tuple(solid for part in self.parts for solid in part.solids)

    @property
    def inside(self) -> tuple[Flags, ...]:
        """Of each part, which faces lie inside the unit, see `Polygon.inside`."""
        ends = np.ones(0 if self.in_space else 2, dtype=bool)
        return tuple(np.append(ends, inside) for inside in self.surface.inside)

    @cached_property
    def corners(self) -> Array:
        """Corners of the surface [m], shape (n, d). In the plane they are the outline, counterclockwise; around a hole
        it goes there and back."""
        return frozen(self.surface.corners)

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return float(sum(part.mass for part in self.parts))

    @cached_property
    def centroid(self) -> Array:
        """The centroid at rest [m], shape (d,)."""
        return frozen(sum(part.mass * part.centroid for part in self.parts) / self.mass)

    @cached_property
    def inertia(self) -> Array:
        """Moment of inertia about the centroid [kg m2], in space the tensor in the axes of the world, shape (3, 3)."""
        total = np.zeros((3, 3) if self.in_space else ())
        for part in self.parts:
            arm = part.centroid - self.centroid
            square = float(arm @ arm)
            second = square * np.eye(3) - np.outer(arm, arm) if self.in_space else square
            total = total + part.inertia + part.mass * second
        return frozen(total)

    @cached_property
    def principal(self) -> PrincipalInertia:
        """In space, principal moments of inertia and their axes."""
        return principal_of(self.inertia)

    @cached_property
    def size(self) -> float:
        """Largest distance of a corner from the centroid [m]."""
        return float(np.linalg.norm(self.corners - self.centroid, axis=1).max())

    def left_at(self, z: float) -> float:
        """In the plane, the left end of the unit at a height z [m], x [m], as of a `Polygon`."""
        reaching = [part for part in self.polygons if np.ptp(np.clip(part.corners[:, 1] - z, -1e-9, 1e-9)) > 0]
        return min(part.left_at(z) for part in reaching or self.polygons)


def _named(parts: Sequence[Polygon | Polyhedron]) -> list[Polygon | Polyhedron]:
    """The parts with names for messages."""
    return [part if part.name else replace(part, name=f"part_{i}") for i, part in enumerate(parts)]


def checked_parts(parts: Sequence[Polygon | Polyhedron]) -> tuple[Polygon | Polyhedron, ...]:
    """Parts of one kind.

    Raises:
        TypeError, ValueError: for any other.
    """
    require_sequence("parts", parts, "a list of blocks")
    if not 2 <= len(parts) <= MOST_PARTS:
        raise ValueError(f"parts has {len(parts)} blocks; the valid range is 2 to {MOST_PARTS}")
    for i, part in enumerate(parts):
        require_kind(f"parts[{i}]", part, Polygon, Polyhedron)
        if type(part) is not type(parts[0]):
            raise TypeError(f"parts[{i}] is a {type(part).__name__}, and parts[0] is not; give parts of one kind")
        if part.fixed:
            raise ValueError(f"parts[{i}] is fixed; a unit is fixed as a whole, by fixed=True of the Compound")
    return tuple(parts)


AnyBlock = Polygon | Polyhedron | Compound
"""A block of masonry."""
FlatBlock = Polygon | Compound
"""A block of masonry in the plane."""
SolidBlock = Polyhedron | Compound
"""A block of masonry in space."""
