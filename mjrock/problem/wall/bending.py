"""Bending of a wall, whose two bodies turn about a crack.

In vertical bending between floors they turn about the toe, the crack and the floor above. In horizontal bending of a
wall held at its sides they turn about upright edges, as an arch in plan.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Annotated, NamedTuple, get_args

import numpy as np
import scipy

from ...quantities import (
    GRAVITY,
    Array,
    Density,
    Implausible,
    Within,
    keep,
    keep_declared,
    require_kind,
    require_within,
    short_repr,
    warn_of,
)
from .block import Block
from .effects import AddedMass, Load, required_effects
from .section import moments
from .tie import Tie

FloorLoad = Annotated[float, Within(1, 1e9, "N", "load of the floor")]
Bearing = Annotated[float | None, Within(1e-6, 20, "m")]
CrackHeight = Annotated[float | None, Within(1e-4, 200, "m")]
CRACKS = 0.01, 0.99
"""Lowest and highest crack, over the height of the wall [-]."""
CURVE_POINTS = 20_001
"""Rotations at which the curve is looked at."""
DEEPEST_FLOOR, TYPICAL = 5.0, 2500.0
DENSITIES: Within = get_args(Density)[1]
"""Largest depth of a floor, over the thickness of the wall [-], its density where it has one of between one and as many
thicknesses, and those that a block may have [kg/m3]."""


class BendingCurve(NamedTuple):
    """The static curve of a wall that bends between floors, or between side walls.

    Args:
        rotation: of the lower or first body [rad], shape (n,).
        displacement: horizontal, of the centroid of both bodies [m], shape (n,).
        multiplier: horizontal acceleration over g that holds the wall at each [-], shape (n,), zero at the last.
    """

    rotation: Array
    displacement: Array
    multiplier: Array


class Hinges(NamedTuple):
    """Where a wall that bends outwards turns, from the inner edge of its base outwards and upwards.

    Args:
        edge: x of the outer edge of the base [m].
        x, z: inner edge of the crack [m].
        top: x and z of the place where the floor above bears [m].
    """

    edge: float
    x: float
    z: float
    top: tuple[float, float]


class Weights(NamedTuple):
    """What loads a wall that bends.

    Args:
        weight: downwards [N], shape (n,).
        inertia: weight of what has inertia sideways [N], shape (n,).
        x, z: where they act, from the inner edge of the base outwards and upwards [m], shape (n,) each.
    """

    weight: Array
    inertia: Array
    x: Array
    z: Array


def require_strip(wall: Block, *, stepped: bool) -> None:
    """Raise a TypeError or a ValueError unless a wall is a plain rectangle, or has a profile alone where it may."""
    require_kind("wall", wall, Block)
    if wall.openings or wall.gable or wall.masses or wall.inset or (wall.profile and not stepped):
        valid = "rectangle, with a profile or without" if stepped else "plain rectangle"
        raise ValueError(f"wall = {wall!r} is not a {valid}; cut it to the strip between its openings")


@dataclass(frozen=True)
class VerticalBending:
    """A wall that cracks between two floors, which hold it sideways; the upper one rests on it and may rise.

    The wall is pushed outwards. Its lower body turns about the outer edge of the base, and the upper one about the
    inner edge of the crack and the place where the floor bears. With W the weight of the wall, t its thickness, h its
    height, N the load at a from the inner face and mu h the height of the crack, virtual work gives

        alpha_0 = 2 / (W h) [(W + N) t / mu + N a / (1 - mu)],

    which is least, 2 / (W h) [sqrt((W + N) t) + sqrt(N a)]^2, where mu / (1 - mu) = sqrt((W + N) t / (N a)). Rigid
    bodies, no tension, no sliding.

    A wall with a profile, such as one whose storeys step back inside, is cut into two bodies of the weights W_1 and W_2
    at x_1, z_1 and x_2, z_2 from the inner edge of the base. With c the inner edge of the crack, of the thinner part
    where it is at a step, z its height, r = z / (h - z), and the floor at a,

        alpha_0 = [W_1 (t - x_1) + W_2 (t - c + r (x_2 - c)) + N (t - c + r (a - c))] / [W_1 z_1 + W_2 r (h - z_2)],

    and the crack with the least of it is found in each stretch between steps.

    A floor in between that loads the wall and does not hold it is an effect: a `Load`, or an `AddedMass` where its
    inertia pushes the wall too. With P at a distance x from the inner face and a height z, and r = mu / (1 - mu), it
    adds P (t - x) to the work of the weights below the crack and P (t + r x) above it, over mu h, and a mass adds
    P z or P r (h - z) to W mu h / 2. The crack is then found in each stretch between the effects.

    Args:
        wall: a rectangle, or one with a `profile` and the face of it that is `plumb`.
        load: of the floor on the whole length of the wall [N], 1 to 1e9. It has no inertia sideways, where the floors
            are held.
        bearing: how far from the inner face at the top the floor bears at most [m], 1e-6 to 20 and up to the thickness
            there, where the whole load acts as the wall turns; None is the thickness.
        crack: its height [m], 1e-4 to 200, 0.01 to 0.99 times that of the wall; None is that of the least multiplier.
        effects: loads and masses on the wall, their offsets from the middle of its base, outwards [m].

    Raises:
        TypeError, ValueError: for a wall with openings, a gable, masses or an inset, an effect of another kind or
            beside the wall, or a value outside its range.

    Examples:
        >>> strip = mr.VerticalBending(mr.Block.from_size(0.3, 4.0), load=20e3)
        >>> round(strip.crack_height, 2), round(strip.multiplier, 2)
        (2.38, 0.78)
    """

    wall: Block
    load: FloorLoad
    bearing: Bearing = None
    crack: CrackHeight = None
    effects: tuple[Load | AddedMass, ...] = field(default=(), kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_strip(self.wall, stepped=True)
        keep_declared(self)
        thickness, height = self._top[1], 2 * self.wall.h
        if self.bearing is not None:
            keep(self, bearing=require_within("bearing", self.bearing, 1e-3 * thickness, thickness, "m"))
        if self.crack is not None:
            keep(self, crack=require_within("crack", self.crack, CRACKS[0] * height, CRACKS[1] * height, "m"))
        keep(self, effects=required_effects("effects", self.effects, (Load, AddedMass)))
        for i, effect in enumerate(self.effects):
            require_within(f"effects[{i}], height", effect.height, 0.0, height, "m")
            if isinstance(effect, Load):
                require_within(f"effects[{i}], offset", effect.offset, -self.wall.b, self.wall.b, "m")

    @property
    def lever(self) -> float:
        """Distance of the load from the inner face at the top [m]."""
        return self._top[1] if self.bearing is None else self.bearing

    @property
    def _top(self) -> tuple[float, float]:
        """The inner face at the top, from the inner edge of the base, and the thickness there [m]."""
        inner, outer = (float(face) for face in self.wall.section.faces(np.array(2 * self.wall.h)))
        return inner + self.wall.b, outer - inner

    def hinges(self, crack: float) -> Hinges:
        """Where it turns about a crack at a height [m]."""
        inner = float(self.wall.section.met(np.array(crack))[0]) + self.wall.b
        return Hinges(2 * self.wall.b, inner, crack, (self._top[0] + self.lever, 2 * self.wall.h))

    def weights(self, crack: float) -> Weights:
        """The weights of both bodies about a crack at a height [m], of the floor above and of the effects."""
        wall, b, rows = self.wall, self.wall.b, list[tuple[float, ...]]()
        for between in ((0.0, crack), (crack, 2 * wall.h)):
            part = moments(wall.section, wall.front, between)
            weight = GRAVITY * wall.density * part.volume
            rows.append((weight, weight, b + part.x / part.volume, part.z / part.volume))
        rows.append((self.load, 0.0, *self.hinges(crack).top))
        for effect in self.effects:
            inertia = GRAVITY * effect.mass_added
            weight = effect.force if isinstance(effect, Load) else inertia
            rows.append((weight, inertia, b + effect.offset, effect.height))
        return Weights(*np.transpose(rows))

    def _rates(self, crack: float) -> tuple[Weights, Array, Array]:
        """The weights, and how fast they begin to move outwards and upwards over the rotation of the lower body [m]."""
        weights, at = self.weights(crack), self.hinges(crack)
        h, above = at.top[1], weights.z > crack
        ratio = crack / (h - crack)
        sway = np.where(above, ratio * (h - weights.z), weights.z)
        return weights, sway, np.where(above, at.edge - at.x + ratio * (weights.x - at.x), at.edge - weights.x)

    def _multiplier_of(self, crack: float) -> float:
        """The multiplier of a crack at a height [m]."""
        weights, sway, rise = self._rates(crack)
        return float(weights.weight @ rise / (weights.inertia @ sway))

    @cached_property
    def crack_height(self) -> float:
        """Height of the crack [m], the given one or that of the least multiplier."""
        height = 2 * self.wall.h
        if self.crack is not None:
            return self.crack
        if not self.effects and self.wall.is_plain:
            ratio = math.sqrt((self.wall.weight + self.load) * 2 * self.wall.b / (self.load * self.lever))
            return height * ratio / (1 + ratio)
        low, high = (share * height for share in CRACKS)
        steps = [effect.height for effect in self.effects] + [z for z, _ in self.wall.profile or ()]
        ends = [low, *sorted({z for z in steps if low < z < high}), high]
        options = {"xatol": 1e-9 * height}
        minima = [
            scipy.optimize.minimize_scalar(self._multiplier_of, bounds=stretch, method="bounded", options=options)
            for stretch in pairwise(ends)
        ]
        return float(min(minima, key=lambda minimum: float(minimum.fun)).x)

    @property
    def multiplier(self) -> float:
        """alpha_0, at which the wall begins to bend [-]."""
        return self._multiplier_of(self.crack_height)

    @property
    def participation(self) -> float:
        """e*, the share of the mass that takes part [-], C8.7.1.5; 1 of one thickness without masses, where both bodies
        move alike."""
        weights, sway, _ = self._rates(self.crack_height)
        return min(float((weights.inertia @ sway) ** 2 / (weights.inertia.sum() * (weights.inertia @ sway**2))), 1.0)

    @cached_property
    def curve(self) -> BendingCurve:
        """The static curve up to where the multiplier falls to zero, by virtual work at finite rotations.

        The multiplier is the rate of the potential energy of the weights and the load over that of the horizontal
        displacement of the weights.
        """
        at = self.hinges(self.crack_height)
        t, z, a, above = at.edge - at.x, at.z, at.top[0] - at.x, at.top[1] - at.z  # from the inner edge of the crack
        reach = math.hypot(a, above)
        theta = np.linspace(0.0, 0.5 * math.pi, CURVE_POINTS)
        x = t * (1 - np.cos(theta)) + z * np.sin(theta)  # of the inner edge of the crack
        theta, x = theta[x - a < reach], x[x - a < reach]
        psi = math.atan2(a, above) + np.arcsin((x - a) / reach)  # where the floor bears stays in place sideways
        sine, cosine, sine_up, cosine_up = np.sin(theta), np.cos(theta), np.sin(psi), np.cos(psi)
        across, up = t * sine + z * cosine, t * cosine - z * sine  # rates of the inner edge of the crack
        rate = across / (above * cosine_up + a * sine_up)  # of psi
        weights = self.weights(z)
        rise, sway, moved = (np.zeros_like(theta) for _ in range(3))
        for weight, inertia, px, pz in zip(*weights, strict=True):
            if pz > z:
                lever, high = px - at.x, pz - z
                shift = x + lever * (cosine_up - 1) - high * sine_up
                outwards = across - rate * (lever * sine_up + high * cosine_up)
                upwards = up + rate * (lever * cosine_up - high * sine_up)
            else:
                lever = at.edge - px
                shift = lever * (1 - cosine) + pz * sine
                outwards, upwards = lever * sine + pz * cosine, lever * cosine - pz * sine
            rise, sway, moved = rise + weight * upwards, sway + inertia * outwards, moved + inertia * shift
        multiplier, moved = rise / sway, moved / weights.inertia.sum()
        end = int(np.flatnonzero(multiplier <= 0)[0])
        share = multiplier[end - 1] / (multiplier[end - 1] - multiplier[end])
        last = [row[end - 1] + share * (row[end] - row[end - 1]) for row in (theta, moved)]
        return BendingCurve(
            np.append(theta[:end], last[0]), np.append(moved[:end], last[1]), np.append(multiplier[:end], 0.0)
        )

    @property
    def floor_depth(self) -> float:
        """Depth of a floor with the mass of the load at some 2500 kg/m3 [m], once to five times the thickness."""
        thickness = self._top[1]
        return min(max(self.load / (self._weight_factor * TYPICAL), thickness), DEEPEST_FLOOR * thickness)

    @property
    def floor_density(self) -> float:
        """Density of a floor of that depth with the mass of the load [kg/m3].

        Raises:
            ValueError: for a load that is too small or too large for a block.
        """
        thickness = self._top[1]
        lightest = self._weight_factor * thickness * DENSITIES.low
        heaviest = self._weight_factor * DEEPEST_FLOOR * thickness * DENSITIES.high
        load = require_within("load", self.load, lightest, heaviest, "N")
        return min(max(load / (self._weight_factor * self.floor_depth), DENSITIES.low), DENSITIES.high)

    @property
    def _weight_factor(self) -> float:
        """Weight of a floor over its depth and density [m3/s2]."""
        return GRAVITY * self.wall.length * (self.floor_ends[1] - self.floor_ends[0])

    @property
    def floor_ends(self) -> tuple[float, float]:
        """Between which x from the inner edge of the base the floor above lies [m]: from half a thickness behind the
        inner face at the top to where it bears, and beyond the outer face where it bears on the whole thickness."""
        face, thickness = self._top
        return face - 0.5 * thickness, face + (1.5 * thickness if self.bearing is None else self.bearing)


TYPICAL_FRICTION = 0.4
"""Coefficient of friction of masonry, NTC 2018 and EN 1996-1-1, 3.6.2 [-]."""
TIE_STIFFNESS = 1e3
"""Stiffness of the tie that stands for the side walls, their thrust per thickness of the wall [-]."""


@dataclass(frozen=True)
class HorizontalBending:
    """A strip of wall under the roof that cracks upright between two side walls, and is pushed outwards.

    It is an arch in plan, of two bodies with a rise of one thickness: they turn about the inner edge of the crack and
    about the outer edges of both ends. The side walls bear a thrust H along the wall, give way under it, and hold the
    ends across it. With W the weight, t the thickness, L the length and a the distance of the crack from one end,
    virtual work gives

        alpha_0 = 2 H t / W [1 / a + 1 / (L - a)],

    8 H t / (W L) with a crack in the middle, where it is least. Rigid bodies without tension on a smooth bed; what
    the floor and the masonry below hold is left out, on the safe side.

    Args:
        wall: a plain rectangle, as high as what bends.
        thrust: H that the weaker of both side walls bears along the wall, at any displacement [N], 1 to 1e9.
        crack: its distance from one end [m], 1e-5 to 1000, 0.01 to 0.99 times the length; None is the middle.

    Raises:
        TypeError, ValueError: for a wall that is not a plain rectangle, or a value outside its range.

    Warns:
        Implausible: where it slides before it bends unless friction is above 0.4.

    Examples:
        >>> strip = mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), thrust=12e3)
        >>> round(strip.multiplier, 4), round(strip.friction, 2)
        (0.068, 0.33)
    """

    wall: Block
    thrust: Annotated[float, Within(1, 1e9, "N", "thrust of the side walls")]
    crack: Annotated[float | None, Within(1e-5, 1000, "m")] = None

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_strip(self.wall, stepped=False)
        keep_declared(self)
        if self.crack is not None:
            length = self.wall.length
            keep(self, crack=require_within("crack", self.crack, 0.01 * length, 0.99 * length, "m"))
        if self.friction > TYPICAL_FRICTION:
            warn_of(
                f"the strip slides before it bends unless friction at its ends and crack is {self.friction:.2g}; "
                f"{TYPICAL_FRICTION:g} is usual",
                Implausible,
            )

    @property
    def parts(self) -> tuple[float, float]:
        """Lengths of both bodies [m]."""
        first = 0.5 * self.wall.length if self.crack is None else self.crack
        return first, self.wall.length - first

    @property
    def multiplier(self) -> float:
        """alpha_0, at which the wall begins to bend [-]."""
        return 4 * self.thrust * self.wall.b / self.wall.weight * sum(1 / part for part in self.parts)

    @property
    def participation(self) -> float:
        """e*, the share of the mass that takes part [-], C8.7.1.5: all of it, as both centroids begin to move alike."""
        return 1.0

    @property
    def friction(self) -> float:
        """The least coefficient of friction of the ends and of the crack, without which they slide before [-]."""
        t, H, per_length = 2 * self.wall.b, self.thrust, self.multiplier * self.wall.weight / self.wall.length
        shears = [0.5 * per_length * part + H * t / part for part in self.parts]  # of the ends
        return max(*shears, abs(shears[0] - per_length * self.parts[0])) / H

    @cached_property
    def curve(self) -> BendingCurve:
        """The static curve up to where the multiplier falls to zero and the arch is flat, by virtual work at finite
        rotations.

        The multiplier is the rate of the work on the thrust over that of the weight's displacement.
        """
        t, parts = 2 * self.wall.b, np.array(self.parts)[:, None]
        rise = t * np.cos(np.linspace(0.0, 0.5 * math.pi, CURVE_POINTS))  # of the arch
        spans = np.sqrt(t**2 + parts**2 - rise**2)  # of each body, from edge to edge
        theta = np.arctan2(t, parts) - np.arctan2(rise, spans)
        share = parts / self.wall.length
        displacement = (share * (0.5 * t * (1 - np.cos(theta)) + 0.5 * parts * np.sin(theta))).sum(axis=0)
        sway = (share * (0.5 * t * np.sin(theta) + 0.5 * parts * np.cos(theta)) / spans).sum(axis=0)
        multiplier = self.thrust * (rise / spans).sum(axis=0) / (self.wall.weight * sway)
        multiplier[-1] = 0.0
        return BendingCurve(theta[0], displacement, multiplier)

    @property
    def tie(self) -> Tie:
        """What stands for the thrust in `Masonry.between_sides`: a tie of that strength from side to side."""
        t, half, z = 2 * self.wall.b, 0.5 * self.wall.length, self.wall.h
        ends = [(0.5 * t, sign * (half + 0.5 * t), z) for sign in (-1, 1)]
        blocks = {"block": "side_0", "anchor_block": "side_1"}
        stiffness = TIE_STIFFNESS * self.thrust / t
        return Tie(stiffness=stiffness, strength=self.thrust, at=ends[0], anchor=ends[1], **blocks)  # type: ignore[arg-type]
