"""The shape of a wall: openings, a gable, a thickness that changes with the height, and the moments that follow.

A wall is cut into slabs at every height where its thickness, its length or the width of its openings has a corner.
Within a slab thickness and length are linear in the height, and round openings have the width of a chord, so that
Gauss's rule makes each moment exact to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Annotated, NamedTuple

import numpy as np

from ...quantities import (
    Array,
    Within,
    keep_declared,
    require_flag,
    require_sequence,
    require_within,
    short_repr,
    shown,
)

NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)
"""Gauss's rule on -1 to 1: with 24 points chords of a circle are exact to 1e-15."""
HEIGHTS_TRIED = 201
"""Heights at which it is made sure that something is left beside the openings."""
Thickness = tuple[Annotated[float, Within(0, 200, "m")], Annotated[float, Within(1e-3, 20, "m")]]
"""A height [m] and the thickness there [m]."""
Profile = tuple[Thickness, ...]
"""Height [m] and thickness [m] from the base to the top, linear in between. Two at one height are a step."""


@dataclass(frozen=True, repr=False)
class Opening:
    """A door or a window through the whole thickness of the wall.

    Where it lies along the wall makes no difference to the rocking. Openings at the same height lie side by side.

    Args:
        width: along the wall [m], 0.01 to 1000.
        height: its own height [m], 0.01 to 200.
        sill: height of its lower edge above the base [m], 0 to 200; 0 is a door, which shortens the base too.
        round: whether it is a circle, or an ellipse where width and height differ, such as a rose window.
        at: where its middle lies along the wall, from the middle of the wall [m], -500 to 500, for solids and pictures.
            None has openings of one sill at equal distances.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> door = mr.Opening(width=1.2, height=2.1)
        >>> round(mr.Block.from_size(0.55, 9.0, 6.0, openings=[door]).mass)
        56628
    """

    width: Annotated[float, Within(0.01, 1000, "m")]
    height: Annotated[float, Within(0.01, 200, "m")]
    sill: Annotated[float, Within(0, 200, "m")] = 0.0
    round: bool = field(default=False, kw_only=True)
    at: Annotated[float | None, Within(-500, 500, "m")] = field(default=None, kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        require_flag("round of the opening", self.round)
        keep_declared(self, "opening")

    @property
    def head(self) -> float:
        """Height of its upper edge above the base [m]."""
        return self.sill + self.height

    def across(self, z: Array) -> Array:
        """Its width at heights above the base [m], shape (n,)."""
        if not self.round:
            return np.where((self.sill < z) & (z < self.head), self.width, 0.0)
        up = (z - self.sill) / (0.5 * self.height) - 1
        return self.width * np.sqrt(np.maximum(1 - up**2, 0.0))


@dataclass(frozen=True)
class Gable:
    """The upper part of a wall, whose length falls from that of the wall to that of its top.

    Args:
        height: of the gable alone, from the eaves to the top of the wall [m], 0.01 to 200.
        top: length of the wall at its top [m], 0 for a triangle, more for a trapezium, 0 to 1000.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> gable = mr.Gable(height=2.0)
        >>> round(mr.Block.from_size(0.55, 9.0, 6.0, gable=gable).mass)
        52800
    """

    height: Annotated[float, Within(0.01, 200, "m")]
    top: Annotated[float, Within(0, 1000, "m")] = 0.0

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep_declared(self, "gable")


class Moments(NamedTuple):
    """Volume [m3], and its moments of the first order from the middle of the base outwards and upwards, x and z [m4],
    and of the second order, xx and zz [m5]."""

    volume: float
    x: float
    z: float
    xx: float
    zz: float


def require_profile(profile: Sequence[Sequence[float]], thickness: float, height: float) -> Profile:
    """A profile as pairs of floats.

    Raises:
        ValueError: if it does not go from the base of this thickness up to this height [m], or if a value is out of
            range.
    """
    require_sequence("profile", profile, "a sequence of pairs of height and thickness [m]")
    pairs: list[tuple[float, float]] = []
    for i, pair in enumerate(profile):
        if not isinstance(pair, Sequence) or isinstance(pair, str) or len(pair) != 2:
            raise TypeError(f"profile[{i}] = {shown(pair)} is not a pair of height and thickness [m]")
        z = require_within(f"profile[{i}], height", pair[0], pairs[-1][0] if pairs else 0.0, height * (1 + 1e-12), "m")
        pairs.append((min(z, height), require_within(f"profile[{i}], thickness", pair[1], 1e-3, 20.0, "m")))
    is_complete = len(pairs) > 1 and pairs[0][0] == 0 and abs(pairs[-1][0] - height) <= 1e-9 * height
    if not is_complete or abs(pairs[0][1] / thickness - 1) > 1e-9:
        raise ValueError(
            f"profile = {shown(profile)} is outside the valid range: it starts at height 0 with the thickness "
            f"{thickness:g} m and ends at the height {height:g} m"
        )
    return ((0.0, thickness), *pairs[1:])


PLUMB = "inner", "outer"
"""The face that is plumb where the thickness changes."""


class Section(NamedTuple):
    """The wall across its thickness, x outwards from the middle of its base and z upwards.

    Args:
        profile: thickness over the height.
        plumb: "inner" or "outer", the face that is plumb.
    """

    profile: Profile
    plumb: str

    def x_of_faces(self, thickness: Array) -> tuple[Array, Array]:
        """x of the inner and of the outer face at places of a thickness [m], shape (n,) each."""
        half = 0.5 * self.profile[0][1]
        if self.plumb == "outer":
            return half - thickness, np.full(np.shape(thickness), half)
        return np.full(np.shape(thickness), -half), thickness - half

    def faces(self, z: Array) -> tuple[Array, Array]:
        """Where the inner and the outer face are at heights [m], x [m], of the thicker part at a step; (n,) each."""
        return self.x_of_faces(np.maximum(*self._thicknesses(z)))

    def met(self, z: Array) -> tuple[Array, Array]:
        """Where a crack at heights [m] begins and ends, x [m]: the faces of the thinner part at a step; (n,) each."""
        return self.x_of_faces(np.minimum(*self._thicknesses(z)))

    def _thicknesses(self, z: Array) -> tuple[Array, Array]:
        """The thickness just above and just below heights [m], shape (n,) each."""
        heights, thicknesses = np.transpose(self.profile)
        return np.interp(z, heights, thicknesses), np.interp(-z, -heights[::-1], thicknesses[::-1])

    def slabs(self, cuts: Collection[float]) -> Iterator[tuple[tuple[float, float], Array]]:
        """The slabs between the corners of the profile and further heights: lower and upper end, z [m], and thickness
        at both [m], shape (2,)."""
        for (low, t_low), (high, t_high) in pairwise(self.profile):
            for ends in pairwise(sorted({low, high} | {z for z in cuts if low < z < high})):
                yield ends, t_low + (t_high - t_low) * (np.array(ends) - low) / (high - low)

    def inner_up_to(self, top: float) -> Array:
        """Corners of the inner face from the base up to a height [m], shape (n, 2)."""
        if self.plumb == "inner":
            return np.array([(-0.5 * self.profile[0][1], 0.0), (-0.5 * self.profile[0][1], top)])
        slabs = [(z, self.x_of_faces(t)[0]) for z, t in self.slabs({top}) if z[1] <= top]
        return np.concatenate([np.column_stack([inner, z]) for z, inner in slabs])

    @property
    def outline(self) -> Array:
        """Corners, counter-clockwise from the inner edge of the base [m], shape (n, 2)."""
        heights, thicknesses = np.transpose(self.profile)
        inner, outer = (np.column_stack([x, heights]) for x in self.x_of_faces(thicknesses))
        if self.plumb == "outer":
            outer = outer[[0, -1]]
        else:
            inner = inner[[0, -1]]
        return np.concatenate([inner[:1], outer, inner[:0:-1]])


class Front(NamedTuple):
    """The wall as seen from outside.

    Args:
        length: length along the wall [m].
        height: whole height [m].
        openings: doors and windows.
        gable: its upper part, or None where the length is the same up to the top.
    """

    length: float
    height: float
    openings: tuple[Opening, ...] = ()
    gable: Gable | None = None

    @property
    def eaves(self) -> float:
        """Height at which the gable begins, or that of the wall [m]."""
        return self.height - (0.0 if self.gable is None else self.gable.height)

    @property
    def places(self) -> tuple[float, ...]:
        """Where the middle of each opening is along the wall, from its middle [m]. Those of one sill that say nothing
        are at equal distances."""
        sills = [opening.sill for opening in self.openings if opening.at is None]
        places, earlier_sills = list[float](), list[float]()
        for opening in self.openings:
            if opening.at is not None:
                places.append(opening.at)
                continue
            length = float(self.long(np.array(opening.head)))
            places.append(length * ((earlier_sills.count(opening.sill) + 0.5) / sills.count(opening.sill) - 0.5))
            earlier_sills.append(opening.sill)
        return tuple(places)

    def long(self, z: Array) -> Array:
        """Length of the wall at heights above the base, its openings not taken off [m], shape (n,)."""
        if self.gable is None:
            return np.full(np.shape(z), self.length)
        return np.interp(z, [self.eaves, self.height], [self.length, self.gable.top])

    def net_length(self, z: Array) -> Array:
        """Length of what is left beside the openings at heights above the base [m], shape (n,)."""
        widths = [opening.across(z) for opening in self.openings]
        return np.asarray(self.long(z) - sum(widths, np.zeros(np.shape(z))))

    @property
    def is_curved(self) -> bool:
        """Whether its length changes otherwise than by steps."""
        return self.gable is not None or any(opening.round for opening in self.openings)

    @property
    def corners(self) -> set[float]:
        """Heights at which its length has a corner [m]."""
        return {self.eaves, *(z for opening in self.openings for z in (opening.sill, opening.head))}

    def require(self) -> None:
        """Raise ValueError unless gable and openings lie within the wall and leave some of it at every height."""
        if self.gable is not None:
            require_within("gable, height", self.gable.height, 0.01, self.height, "m")
            require_within("gable, top", self.gable.top, 0.0, self.length, "m")
        for i, opening in enumerate(self.openings):
            if opening.head > self.height * (1 + 1e-12):
                raise ValueError(
                    f"openings[{i}] reaches from {opening.sill:g} to {opening.head:g} m; the valid range is 0 "
                    f"to {self.height:g} m, the height of the wall"
                )
        edge = 1e-9 * self.height
        ends = [z for opening in self.openings for z in (opening.sill + edge, opening.head - edge)]
        heights = {*ends, *np.linspace(min(ends), max(ends), HEIGHTS_TRIED).tolist()} if ends else set()
        for z in sorted(heights):
            height = np.array(z)
            width, length = sum(float(opening.across(height)) for opening in self.openings), float(self.long(height))
            if not width < length * (1 - 1e-9):
                level_text = f"at a height of {z:.4g} m" if z > 2 * edge else "at the base"
                raise ValueError(
                    f"the openings {level_text} are {width:g} m wide together; the valid range is less than "
                    f"{length:g} m, the length of the wall there"
                )


def moments(section: Section, front: Front, between: tuple[float, float] = (0.0, math.inf)) -> Moments:
    """Volume and moments of a wall, or of its part between two heights [m].

    Between corners a wall of one length has moments of at most the third degree, which Simpson's rule integrates
    exactly. Where the length changes the height is the sine of an angle between the ends, which makes chords of a
    circle smooth there, and Gauss's rule is taken.
    """
    total = np.zeros(5)
    for (low, high), ends in section.slabs(front.corners | set(between)):
        if not between[0] <= low < high <= between[1]:
            continue
        if front.is_curved:
            angle = 0.5 * math.pi * NODES
            share, weight = 0.5 * (1 + np.sin(angle)), WEIGHTS * 0.25 * math.pi * np.cos(angle)
            z = low + (high - low) * share
            weight = weight * front.net_length(z)
        else:
            share, weight = np.array([0.0, 0.5, 1.0]), np.array([1.0, 4.0, 1.0]) / 6
            z = low + (high - low) * share
            weight = weight * front.net_length(np.array(0.5 * (low + high)))
        faces = section.x_of_faces(ends[0] + (ends[1] - ends[0]) * share)
        total += (high - low) * np.array([weight @ term for term in _integrands(z, *faces)])
    return Moments(*total.tolist())


def _integrands(z: Array, inner: Array, outer: Array) -> tuple[Array, ...]:
    """What the moments of a section are integrals of, at heights with both faces [m], shape (n,) each."""
    t = outer - inner
    return t, 0.5 * (outer**2 - inner**2), t * z, (outer**3 - inner**3) / 3, t * z**2


def moments_behind(section: Section, slope: float, height: float) -> Moments:
    """Area and moments of what lies between the inner face of a wall and a plane that rises from its inner edge
    backwards by a slope [-], up to a height [m]."""
    total, half = np.zeros(5), 0.5 * section.profile[0][1]
    for (low, high), ends in section.slabs({height}):
        if low < high <= height:
            share, weight = np.array([0.0, 0.5, 1.0]), np.array([1.0, 4.0, 1.0]) / 6
            z = low + (high - low) * share
            inner, _ = section.x_of_faces(ends[0] + (ends[1] - ends[0]) * share)
            total += (high - low) * np.array([weight @ term for term in _integrands(z, -half - slope * z, inner)])
    return Moments(*total.tolist())
