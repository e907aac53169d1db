"""A corner of two walls that overturns along its diagonal, as a wall that rocks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from ...quantities import Within, keep_declared, short_repr
from .block import Block
from .effects import AddedMass


@dataclass(frozen=True)
class Corner:
    """A corner of two equal walls that turns along its diagonal about its outer edge, with a wedge of either wall.

    Seen across the diagonal it is a rigid body in the plane: a wall whose base is the diagonal of the post in the
    corner, with masses. `mr.Case(corner.block, ..., effects=corner.masses)` is what theory, MuJoCo, SciPy, explicit
    steps, `pushover` and `mechanism_check` take; height and horizontal place of a tie or thrust are along the diagonal.
    It stays in that plane, while the blocks of `Masonry.corner` may turn aside. With t the thickness, h the height and
    p = h tan(angle) the length of a wedge at the top, the post has the mass rho t^2 h, its centroid t / sqrt(2) behind
    the outer edge, and m (t^2 + h^2) / 12 about it. A wedge has the mass rho t p h / 2, its centroid
    (3 t / 2 + p / 3) / sqrt(2) behind that edge and 2 h / 3 high, and m (t^2 / 24 + p^2 / 36 + h^2 / 18) about it.
    Friction along the cracks is left out.

    Args:
        thickness: of both walls [m], 0.01 to 10.
        height: of the storey that turns [m], 0.1 to 100, at least sqrt(2) times the thickness.
        angle: of the cracks from the vertical [rad], 0 to 1.2. Without wedges the post turns alone.
        density: mass density [kg/m3], 200 to 30000.

    Raises:
        ValueError: for a value outside its range, or sizes whose wall and masses are beyond those of a `Block` and of
            `AddedMass`.

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

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)
        try:
            _ = self.block, self.masses
        except ValueError as error:
            said = f"thickness = {self.thickness:g} m, height = {self.height:g} m, angle = {self.angle:g} rad"
            raise ValueError(f"{said} are no corner that a wall can stand for: {error}") from None

    @property
    def depth(self) -> float:
        """Length of a wedge at its top [m]."""
        return self.height * math.tan(self.angle)

    @property
    def multiplier(self) -> float:
        """alpha_0 along the diagonal [-]."""
        t, p = self.thickness, self.depth
        return (t**2 + p * (1.5 * t + p / 3)) / (math.sqrt(2) * self.height * (0.5 * t + 2 * p / 3))

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
        post, wedges = self.density * t * t * h, self.density * t * p * h
        half = 0.5 * math.sqrt(2) * t
        pairs = [(0.5 * post, 0.5 * h, 0.0, h / math.sqrt(12))]
        if wedges:
            radius = math.sqrt(t**2 / 24 + p**2 / 36 + h**2 / 18)
            pairs.append((wedges, 2 * h / 3, half - (1.5 * t + p / 3) / math.sqrt(2), radius))
        ways = [(pair, sign) for pair in pairs for sign in (-1, 1)]
        return tuple(AddedMass(mass / 2, level, x + sign * radius) for (mass, level, x, radius), sign in ways)
