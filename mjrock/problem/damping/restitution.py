"""Coefficients of restitution of classical rocking theory."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Annotated

import numpy as np

from ...deprecation import deprecated
from ...quantities import (
    ON_ITS_FACE,
    Array,
    Implausible,
    Within,
    keep,
    keep_declared,
    require_kind,
    require_real,
    require_whole,
    require_within,
    short_repr,
    warn_of,
)
from ..wall.block import Block
from ..wall.effect import HIGHEST_WALL

ANOTHER_WALL = 1e-2
"""Relative difference of alpha, and of the share of the height, from which a restitution is that of another wall [-].
Masses that a case adds, or a small inset, change alpha by less or are worth a word."""
StopTop = Annotated[float | None, Within(0.01, HIGHEST_WALL, "m", "top of the side stop")]
"""Height that a side stop reaches."""
Alpha = Annotated[float, Within(0, ON_ITS_FACE, "rad")]
LARGEST_ANGLE = 0.4
"""Angle given for alpha above which it is taken for one in degrees [rad]; b/h is then above 0.42."""


@dataclass(frozen=True)
class Restitution:
    """What is left of the angular velocity after an impact.

    Args:
        base: e_2s, one impact on the base, two-sided rocking [-], 0 to 1 and above 0.
        side: e_side, the impact on the side stop [-], -1 to 1; negative where the wall rebounds.
        made_for: alpha of the wall [rad] and the share of its height that the side stop reaches [-], where the values
            come from the geometry; None if unknown.

    Raises:
        ValueError: for a value outside its range.
    """

    base: Annotated[float, Within(0, 1, name="base restitution")]
    side: Annotated[float, Within(-1, 1, name="side restitution")]
    made_for: tuple[Alpha, float] | None = field(default=None, kw_only=True, compare=False, repr=False)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self)
        if self.base == 0:
            raise ValueError("base restitution = 0 is outside the valid range 0 < e <= 1")

    @property
    def lumped(self) -> float:
        """e_1s = e_2s e_side e_2s: base, side, base in quick succession (Eq. 4) [-]."""
        return self.base**2 * self.side

    def stop_top(self, wall: Block) -> float | None:
        """Height on a wall of the side stop that the values were made for [m]; None if unknown."""
        return None if self.made_for is None else 2 * wall.h * self.made_for[1]

    def difference_from(self, wall: Block, stop_top: float | None) -> str | None:
        """How a wall and its side stop up to `stop_top` [m] differ from those that the values were made for, as a
        sentence; None if they do not."""
        if self.made_for is None:
            return None
        alpha, share = self.made_for
        if not math.isclose(alpha, wall.alpha, rel_tol=ANOTHER_WALL):
            return (
                f"the restitution is that of a wall of alpha = {alpha:.4g} rad, and this one has {wall.alpha:.4g} rad; "
                "take one wall for both, with its added masses: Restitution.from_geometry(case.wall)"
            )
        required = share if stop_top is None else min(stop_top / (2 * wall.h), 1.0)
        if abs(required - share) > ANOTHER_WALL:
            top = required * 2 * wall.h
            return (
                f"the restitution is that of a side stop up to {share * 2 * wall.h:.4g} m, and this one reaches "
                f"{top:.4g} m; take Restitution.from_geometry(wall, stop_top={top:.4g})"
            )
        return None

    @deprecated("difference_from", since="1.0", removal="2.0")
    def doubt(self, wall: Block, stop_top: float | None) -> str | None:
        """The same as `difference_from`."""
        return self.difference_from(wall, stop_top)

    def scattered(self, sd: float, seed: int) -> ScatteredRestitution:
        """This restitution as the mean of values that differ from impact to impact.

        Args:
            sd: standard deviation of e of one impact, on the base and on the side stop [-], 0 or more, see
                `ScatteredRestitution`.
            seed: of the draws, a whole number from 0 to 2**53.
        """
        return ScatteredRestitution(self, sd, seed)

    def require_rebound(self) -> None:
        """Raise ValueError unless the wall rebounds from the side stop."""
        if self.side >= 0:
            raise ValueError(f"side restitution = {self.side:g} is not a rebound; the valid range is -1 <= e_side < 0")

    @classmethod
    def from_geometry(cls, wall: Block | float, stop_top: StopTop = None) -> Restitution:
        """Conservation of angular momentum through each impact (Eqs. 2-3).

        Eqs. 2-3 are written for a full rectangle. With the centroid at the height z, its distances d_1 from the edge
        before the impact and d_2 from the edge after it, and I about the centroid, the momentum about the new edge
        gives I + m (z^2 - d_1 d_2) over I + m (z^2 + d_2^2). Where d_1 and d_2 differ, e_2s is the root of the product
        of both directions, which is the root of the energy that is left in either. About the highest point of a side
        stop that reaches to H_s, at the distance d_s of the inner face, it gives e_side =
        [I + m (d_2 d_s + z (z - H_s))] / [I + m (d_s^2 + (z - H_s)^2)].

        Args:
            wall: the wall, or alpha = arctan(b/h) [rad] of a full rectangle whose edges are not inset.
            stop_top: height that the side stop reaches [m], up to that of the wall, which None stands for. A stop that
                reaches less than about two thirds of the height gives an e_side above 0: the wall turns on over it.

        Raises:
            ValueError: if alpha is too large for Eq. 2 to leave any velocity, that is from 54.7 degrees, or the stop
                does not end on the wall, or is so low that e_side exceeds 1, or if the centroid lies behind the inner
                edge.
        """
        if isinstance(wall, Block):
            if stop_top is not None:
                stop_top = require_within("top of the side stop", stop_top, 0.01, 2 * wall.h * (1 + 1e-12), "m")
            if wall.half_base + wall.centroid_offset <= 0:
                raise ValueError(
                    f"the centroid of the wall lies {-wall.centroid_offset:g} m behind the middle of the base, behind "
                    "its inner edge: it lands on a crack or on the stop; give Restitution(base, side)"
                )
            if wall.inset or not wall.is_plain or (stop_top is not None and stop_top < 2 * wall.h):
                top = 2 * wall.h if stop_top is None else stop_top
                base, side = _base_restitution(wall), _side_restitution(wall, top)
                if side > 1:
                    raise ValueError(
                        f"top of the side stop = {top:g} m is so low that the wall turns on over it, e_side = "
                        f"{side:.3g}; it rebounds from about two thirds of its height of {2 * wall.h:g} m on"
                    )
                return cls(base, side, made_for=(wall.alpha, top / (2 * wall.h)))
        elif stop_top is not None:
            raise TypeError("a side stop needs the wall, and not its alpha alone")
        alpha = wall.alpha if isinstance(wall, Block) else require_real("alpha", wall)
        if not 0 < alpha < math.asin(math.sqrt(2 / 3)):
            raise ValueError(f"alpha = {alpha:g} rad is outside the valid range 0 < alpha < 0.9553 rad of Eq. 2")
        if alpha > LARGEST_ANGLE and not isinstance(wall, Block):
            warn_of(f"alpha = {alpha:g} rad is {math.degrees(alpha):.3g} degrees; angles are radians", Implausible)
        base, side = 1 - 1.5 * math.sin(alpha) ** 2, 1 - 1.5 * math.cos(alpha) ** 2
        return cls(base, side, made_for=(alpha, 1.0))

    @classmethod
    def from_lumped(cls, lumped: float, wall: Block | float) -> Restitution:
        """From a measured e_1s: e_2s by Eq. 2, and the side takes the rest, e_side = e_1s / e_2s^2.

        `wall` is the wall, or its alpha [rad], as in `from_geometry`.

        This is how Table 2 of the paper turns its experiments into damping ratios.

        Raises:
            ValueError: if the measured value requires more than a perfect rebound of the side.
        """
        lumped = require_real("lumped restitution", lumped)
        base = cls.from_geometry(wall).base
        if not -(base**2) <= lumped < 0:
            raise ValueError(f"lumped restitution = {lumped:g} is outside the valid range {-(base**2):.4g} to 0")
        return cls(base=base, side=lumped / base**2)


@dataclass(frozen=True)
class ScatteredRestitution:
    """Restitution that differs from impact to impact.

    `solve_analytical` draws |e| of each impact from the beta distribution of this mean and standard deviation: it
    keeps both, and stays between 0 and 1. Draws are independent of each other. The sequence base, side, base of a wall
    beside a stop takes three of them. The i-th impact of a run has the i-th draw of the seed, whatever its tolerance.
    Without a spread the answer is that of the mean, to the last bit.

    Contacts have one damping ratio, so that they take one draw for a whole run: `drawn`.

    Args:
        mean: the mean coefficients [-].
        sd: standard deviation of one impact [-], 0 or more and below sqrt(|e| (1 - |e|)) of the base and of the side
            stop, unless that is 0.
        seed: of the draws, a whole number from 0 to 2**53.

    Raises:
        TypeError: for a value of another type.
        ValueError: for a value outside its range.
    """

    mean: Restitution
    sd: float
    seed: int

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_kind("mean restitution", self.mean, Restitution)
        largest = min(math.sqrt(e * (1 - e)) for e in (self.mean.base, abs(self.mean.side)) if e > 0)
        sd = require_within("sd of the restitution", self.sd, 0.0, math.inf)
        if sd > 0 and sd >= largest:
            raise ValueError(
                f"sd of the restitution = {sd:g} is outside the valid range from 0 to less than {largest:.4g}: with a "
                f"larger one |e| does not stay between 0 and 1, with means of {self.mean.base:g} and {self.mean.side:g}"
            )
        keep(self, sd=sd, seed=require_whole("seed", self.seed, 0, 2**53))

    @property
    def base(self) -> float:
        """The mean of an impact on the base [-]."""
        return self.mean.base

    @property
    def lumped(self) -> float:
        """The mean of the sequence base, side, base [-]."""
        return self.mean.lumped

    def difference_from(self, wall: Block, stop_top: float | None) -> str | None:
        """That of the mean."""
        return self.mean.difference_from(wall, stop_top)

    @deprecated("difference_from", since="1.0", removal="2.0")
    def doubt(self, wall: Block, stop_top: float | None) -> str | None:
        """The same as `difference_from`."""
        return self.difference_from(wall, stop_top)

    def drawn(self) -> Restitution:
        """One draw of each coefficient: the restitution of a run on contacts."""
        base, side, _ = _draws(self, np.random.default_rng(self.seed), 1)[0].tolist()
        return replace(self.mean, base=base, side=side)


AnyRestitution = Restitution | ScatteredRestitution
"""What rocking theory takes."""


def impacts_of(e: AnyRestitution, *, lumped: bool) -> Callable[[int], Array]:
    """A function that gives e of a number of next impacts of a run [-]; `lumped` of the sequence base, side, base."""
    if isinstance(e, Restitution) or e.sd == 0:
        mean = e.lumped if lumped else e.base
        return lambda count: np.full(count, mean)
    random = np.random.default_rng(e.seed)
    return lambda count: _draws(e, random, count)[:, : 3 if lumped else 1].prod(axis=1)


def _draws(e: ScatteredRestitution, random: np.random.Generator, count: int) -> Array:
    """Draws for base, side and base, shape (count, 3)."""
    means = np.array([e.mean.base, e.mean.side, e.mean.base])
    values, scattered = np.tile(means, (count, 1)), means != 0
    if e.sd > 0:
        size = np.abs(means[scattered])
        strength = size * (1 - size) / e.sd**2 - 1
        drawn = random.beta(size * strength, (1 - size) * strength, (count, len(size)))
        values[:, scattered] = np.sign(means[scattered]) * drawn
    return values


def _base_restitution(wall: Block) -> float:
    """e_2s of any wall, see `Restitution.from_geometry`."""
    outer, inner = (wall.half_base - side * wall.centroid_offset for side in (1, -1))
    momentum = wall.inertia + wall.mass * (wall.centroid_height**2 - outer * inner)
    return momentum / math.sqrt(wall.inertia_about(1) * wall.inertia_about(-1))


def _side_restitution(wall: Block, top: float) -> float:
    """e_side of any wall against a stop that reaches to `top`, see `Restitution.from_geometry`."""
    edge, face = wall.half_base + wall.centroid_offset, wall.centroid_offset - wall.inner_face(top)
    z, below = wall.centroid_height, wall.centroid_height - top
    return (wall.inertia + wall.mass * (edge * face + z * below)) / (wall.inertia + wall.mass * (face**2 + below**2))
