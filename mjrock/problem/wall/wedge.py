"""Masses that a facade or a corner drags along as it overturns: wedges of side walls, and a corner as a wall."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np

from ...quantities import Array, Within, keep, keep_declared, require_kind, require_within, short_repr
from .block import Block
from .case import Case
from .effect import CombinedEffect
from .effects import AddedMass, Load, Thrust, required_effects
from .section import moments_behind
from .tie import Tie

LEAST_ANGLE = 1e-6
"""Angle of a crack below which there is no wedge [rad]."""


@dataclass(frozen=True)
class Wedge(CombinedEffect):
    """Equal wedges of side walls between the inner face of a facade and inclined cracks, composite overturning.

    A crack rises from the inner face at the base, at an angle from the vertical, up to the top of the side wall. With q
    the height of the wedge and p = q tan(angle) its length there, one has the mass rho t p q / 2, its centroid at p / 3
    behind the inner face and 2 q / 3 above the base, and the moment of inertia m (p^2 + q^2) / 18 about it. Where the
    facade steps back inside, the side wall reaches up to its inner face there, and so does the wedge. Friction along
    the crack and what interlocks there are left out, on the safe side.

    Args:
        angle: of the crack from the vertical [rad], 1e-6 to 1.2.
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
    angle: Annotated[float, Within(LEAST_ANGLE, 1.2, "rad", "angle of the wedge")]
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
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        density_text = "" if self.density is None else f", {self.density:g} kg/m3"
        return (
            f"{self.number} of {self.thickness:g} m, {self.height:g} m high{density_text},\n"
            f"crack at {math.degrees(self.angle):.3g}° from the vertical"
        )

    def behind(self, facade: Block) -> tuple[AddedMass, AddedMass]:
        """All wedges behind a facade, as two masses that move with it.

        They have the mass, the centroid and the moment of inertia of the wedges, which is all that a rigid body in the
        plane is: half of the mass each, on the level of the centroid, as far apart as the moment of inertia requires.

        Raises:
            TypeError, ValueError: for what is no wall, a wedge higher than it, or one that reaches too far behind it.
        """
        require_kind("facade", facade, Block)
        require_within("height of the wedge", self.height, 0.01, 2 * facade.h * (1 + 1e-12), "m")
        density = facade.density if self.density is None else self.density
        height = min(self.height, 2 * facade.h)
        area, x, z, xx, zz = moments_behind(facade.section, math.tan(self.angle), height)
        mass, middle, level = self.number * density * self.thickness * area, x / area, z / area
        radius = math.sqrt((xx + zz) / area - middle**2 - level**2)
        face = facade.section.inner_up_to(height).tolist()
        return self.masses(mass, level, middle, radius, [*face, (face[0][0] - self.depth, self.height)])

    def masses(
        self, mass: float, height: float, offset: float, radius: float, corners: Sequence[Sequence[float]]
    ) -> tuple[AddedMass, AddedMass]:
        """All wedges as two masses.

        Args:
            mass: of all [kg].
            height, offset: of their centroid, from the middle of the base of what they move with [m].
            radius: of gyration about it [m].
            corners: of what they are in the section, from there too [m].
        """
        outline = tuple((x, z) for x, z in corners)
        inner, outer = (
            WedgeMass(mass / 2, height, offset + sense * radius, wedge=self, corners=outline, first=sense < 0)
            for sense in (-1, 1)
        )
        return inner, outer

    def on(self, wall: Block) -> tuple[AddedMass, AddedMass]:
        """The same as `behind`."""
        return self.behind(wall)


@dataclass(frozen=True, repr=False)
class WedgeMass(AddedMass):
    """One of the two masses that stand for wedges, see `Wedge.behind`.

    Args:
        wedge: the wedges.
        corners: of what lies between the inner face of the facade, the crack and the top of the side wall, from the
            middle of the base of the facade [m].
        first: whether it is the one that sketch and report speak of.
    """

    wedge: Wedge = field(kw_only=True)
    corners: tuple[tuple[float, float], ...] = field(kw_only=True, repr=False)
    first: bool = field(kw_only=True, repr=False)

    @property
    def report_item(self) -> Wedge | None:
        """The wedges, once."""
        return self.wedge if self.first else None

    @property
    def outline(self) -> Array:
        """What they are in the section."""
        return np.array(self.corners)


def tie_along_bisector(tie: Tie) -> Tie:
    """Two equal ties along two walls at right angles as one along the bisector of both, horizontal and behind it.

    With c the cosine of half the angle between them, which is 1 / sqrt(2) of horizontal ones, the one has the force
    2 c F, and each of them the elongation c u of its u.
    """
    length = tie.length / math.sqrt(2)
    cosine = math.hypot(length, tie.rise) / tie.span
    return replace(
        tie,
        length=length,
        stiffness=2 * cosine**2 * tie.stiffness,
        slack=tie.slack / cosine,
        strength=2 * cosine * tie.strength,
        prestress=2 * cosine * tie.prestress,
        ultimate=None if tie.ultimate is None else tie.ultimate / cosine,
    )


@dataclass(frozen=True)
class Corner:
    """A corner of two equal walls that turns along its diagonal about its outer edge, with a wedge of either wall.

    Seen across the diagonal it is a rigid body in the plane: a wall whose base is the diagonal of the post in the
    corner, with masses. `mechanism_check` takes it, and theory, MuJoCo, SciPy, explicit steps and `pushover` take
    `corner.case`, or `mr.Case(corner.block, ..., effects=corner.masses)`. It stays in that plane, while the blocks of
    `Masonry.corner` may turn aside. With t the thickness, h the height and p = h tan(angle) the length of a wedge at
    the top, the post has the mass rho t^2 h, its centroid t / sqrt(2) behind the outer edge, and m (t^2 + h^2) / 12
    about it. A wedge has the mass rho t p h / 2, its centroid (3 t / 2 + p / 3) / sqrt(2) behind that edge and 2 h / 3
    high, and m (t^2 / 24 + p^2 / 36 + h^2 / 18) about it.
    Friction along the cracks is left out. With W the weights of post, wedges and added masses, a their distances behind
    that edge and z their heights, N and a_N loads and theirs, H and z_H thrusts and theirs,

        alpha_0 = [sum W a + sum N a_N - sum H z_H] / sum W z.

    A tie is a rod in each of both walls, along it. The two are as one along the diagonal of sqrt(2) times their force,
    which adds sqrt(2) F z where it pulls; it is stretched by sqrt(2) times their elongation. That they swing out as the
    corner leans is left out, on the safe side.

    Args:
        thickness: of both walls [m], 0.01 to 10.
        height: of the storey that turns [m], 0.1 to 100, at least sqrt(2) times the thickness.
        angle: of the cracks from the vertical [rad], 0 to 1.2. Without wedges the post turns alone.
        density: mass density [kg/m3], 200 to 30000.
        effects: thrusts along the diagonal, such as that of a hip rafter or sqrt(2) times what the roof pushes either
            wall with, loads and masses on both walls together, their offsets along the diagonal from the middle of the
            post, outwards, and ties, each for a rod in either wall.

    Raises:
        TypeError, ValueError: for a value outside its range, sizes whose wall and masses are beyond those of a `Block`
            and of `AddedMass`, an effect of another kind, or one that is not on the corner.

    Examples:
        >>> corner = mr.Corner(0.5, 4.0, angle=0.5236)
        >>> case = mr.Case(corner.block, 0.0, 10.0, effects=corner.masses)
        >>> round(corner.multiplier, 4), round(mr.pushover(case).start, 4)
        (0.3714, 0.3714)
    """

    thickness: Annotated[float, Within(0.01, 10, "m", "thickness of the corner")]
    height: Annotated[float, Within(0.1, 100, "m", "height of the corner")]
    angle: Annotated[float, Within(0, 1.2, "rad", "angle of the cracks")] = 0.0
    density: Annotated[float, Within(200, 30_000, "kg/m3", "density of the corner")] = 2000.0
    effects: tuple[Tie | Thrust | Load | AddedMass, ...] = field(default=(), kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)
        keep(self, effects=required_effects("effects", self.effects, (Tie, Thrust, Load, AddedMass)))
        try:
            _ = self.block, self.masses
        except ValueError as error:
            sizes = f"thickness = {self.thickness:g} m, height = {self.height:g} m, angle = {self.angle:g} rad"
            raise ValueError(f"{sizes} are no corner that a wall can stand for: {error}") from None
        _ = self.case

    @property
    def depth(self) -> float:
        """Length of a wedge at its top [m]."""
        return self.height * math.tan(self.angle)

    @property
    def multiplier(self) -> float:
        """alpha_0 along the diagonal [-], with ties slack but for their prestress."""
        wall, moment = self.case.wall, sum(float(pull.moment(np.zeros(1))[0]) for pull in self.case.pulls)
        return (self.case.restoring.outer.P + moment) / (wall.weight * wall.centroid_height)

    @cached_property
    def case(self) -> Case:
        """The wall that stands for it, with its effects and masses."""
        effects = (tie_along_bisector(effect) if isinstance(effect, Tie) else effect for effect in self.effects)
        return Case(self.block, effects=(*effects, *self.masses))

    @property
    def block(self) -> Block:
        """A wall with half the mass of the post, on its diagonal and on as much ground."""
        t = self.thickness
        return Block.from_size(math.sqrt(2) * t, self.height, t / math.sqrt(2), 0.5 * self.density)

    @property
    def masses(self) -> tuple[AddedMass, ...]:
        """What is missing in mass and moment of inertia: two masses of the post, and two of the wedges if there are
        any."""
        t, p, h = self.thickness, self.depth, self.height
        post, half = self.density * t * t * h, 0.5 * math.sqrt(2) * t
        masses = [AddedMass(0.25 * post, 0.5 * h, sign * h / math.sqrt(12)) for sign in (-1, 1)]
        if self.angle < LEAST_ANGLE:
            return tuple(masses)
        wedge = Wedge(self.angle, t, h, density=self.density)
        middle = half - (1.5 * t + p / 3) / math.sqrt(2)
        radius = math.sqrt(t**2 / 24 + p**2 / 36 + h**2 / 18)
        corners = [(-half, 0.0), (-half, h), (-half - p / math.sqrt(2), h)]
        return *masses, *wedge.masses(self.density * t * p * h, 2 * h / 3, middle, radius, corners)
