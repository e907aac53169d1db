"""A wedge of a side wall that a facade drags along as it overturns."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, ClassVar

import numpy as np

from ...quantities import Array, Within, keep_declared, require_kind, require_within, short_repr
from .block import Block
from .effects import AddedMass


@dataclass(frozen=True)
class Wedge:
    """Equal wedges of side walls between the inner face of a facade and inclined cracks, composite overturning.

    A crack rises from the inner face at the base, at an angle from the vertical, up to the top of the side wall. With q
    the height of the wedge and p = q tan(angle) its length there, one has the mass rho t p q / 2, its centroid at p / 3
    behind the inner face and 2 q / 3 above the base, and the moment of inertia m (p^2 + q^2) / 18 about it. Friction
    along the crack and what interlocks there are left out, on the safe side.

    Args:
        angle: of the crack from the vertical [rad], 0.01 to 1.2.
        thickness: of a side wall [m], 0.01 to 10.
        height: of the side walls [m], 0.01 to 200, at most that of the facade.
        number: of wedges, 1 to 100.
        density: mass density [kg/m3], 100 to 30000; None is that of the facade.

    Raises:
        TypeError, ValueError: for a value outside its range.

    Examples:
        >>> facade = mr.Block.from_size(thickness=0.8, height=9.0, length=8.0)
        >>> wedges = mr.Wedge(angle=0.4, thickness=0.5, height=9.0).behind(facade)
        >>> case = mr.Case(facade, 0.0, 10.0, effects=wedges)
        >>> round(mr.pushover(case).start, 3), round(mr.pushover(mr.Case(facade, 0.0, 10.0)).start, 3)
        (0.162, 0.089)
    """

    label: ClassVar[str] = "wedges"
    arguments: ClassVar[str] = "angle, thickness, height"
    angle: Annotated[float, Within(0.01, 1.2, "rad", "angle of the wedge")]
    thickness: Annotated[float, Within(0.01, 10, "m", "thickness of the side wall")]
    height: Annotated[float, Within(0.01, 200, "m", "height of the wedge")]
    number: Annotated[int, Within(1, 100, "wedges", whole=True)] = 2
    density: Annotated[float | None, Within(100, 30_000, "kg/m3", "density of the wedge")] = None

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)

    @property
    def depth(self) -> float:
        """Length of a wedge at its top [m]."""
        return self.height * math.tan(self.angle)

    @property
    def said(self) -> str:
        """For sketches, and for reports that have no words for it."""
        of = "" if self.density is None else f", {self.density:g} kg/m3"
        return (
            f"{self.number} of {self.thickness:g} m, {self.height:g} m high{of},\n"
            f"crack at {math.degrees(self.angle):.3g}° from the vertical"
        )

    def behind(self, facade: Block) -> tuple[AddedMass, AddedMass]:
        """All wedges behind a facade, as two masses that move with it.

        They have the mass, the centroid and the moment of inertia of the wedges, which is all that a rigid body in the
        plane is: half of the mass each, on the level of the centroid, as far apart as the moment of inertia asks for.

        Raises:
            TypeError, ValueError: for what is no wall, a wedge higher than it, or one that reaches too far behind it.
        """
        require_kind("facade", facade, Block)
        require_within("height of the wedge", self.height, 0.01, 2 * facade.h * (1 + 1e-12), "m")
        density = facade.density if self.density is None else self.density
        mass = self.number * density * self.thickness * self.depth * self.height / 2
        radius = math.hypot(self.depth, self.height) / math.sqrt(18)
        middle, level = -facade.b - self.depth / 3, 2 * self.height / 3
        inner, outer = (
            WedgeMass(mass / 2, level, middle + way * radius, wedge=self, face=-facade.b, first=way < 0)
            for way in (-1, 1)
        )
        return inner, outer


@dataclass(frozen=True, repr=False)
class WedgeMass(AddedMass):
    """One of the two masses that stand for wedges, see `Wedge.behind`.

    Args:
        wedge: the wedges.
        face: where the inner face of the facade is, from the middle of its base [m].
        first: whether it is the one that sketch and report speak of.
    """

    wedge: Wedge = field(kw_only=True)
    face: float = field(kw_only=True, repr=False)
    first: bool = field(kw_only=True, repr=False)

    @property
    def told(self) -> Wedge | None:
        """The wedges, once."""
        return self.wedge if self.first else None

    @property
    def outline(self) -> Array:
        """The triangle between the inner face, the crack and the top of the side wall."""
        back, top = self.face - self.wedge.depth, self.wedge.height
        return np.array([[self.face, 0.0], [self.face, top], [back, top]])
