"""Interface stiffness k_n [N/m3]: the usual ways to it, properties of types of masonry, and the range that they leave.

The stiffness of an interface is a pressure over a closing of it [Pa/m = N/m3]. The value spreads over two orders of
magnitude between methods: take more than one where the result matters, see docs/stiffness.md. `reference_frequency`
gives the frequency that a stiffness belongs to. `crushed_inset` gives the inset of a wall whose toe crushes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated

from ...quantities import (
    GRAVITY,
    Within,
    keep,
    require_kind,
    require_real,
    require_stiffness,
    require_text,
    require_within,
    short_repr,
    shown,
    warn_of,
    within_ranges,
)
from ..wall.block import Block
from .contacts import PointCount, base_inertia, contact_lines, reference_frequency

Modulus = Annotated[float, Within(1e5, 1e12, "Pa", "modulus E")]
"""Young's modulus of mortar, masonry or stone."""
UNIT_STIFFNESS = 1e8
"""A stiffness whose frequency is scaled [N/m3]."""


@within_ranges
def joint_stiffness(E: Modulus, thickness: Annotated[float, Within(1e-4, 1, "m")]) -> float:
    """k_n = E / t of a mortar joint or of any thin layer, uniaxially compressed [N/m3].

    It is an upper bound for units much stiffer than the mortar: real joints have voids and touch in spots.

    Args:
        E: Young's modulus of the layer [Pa], 1e5 to 1e12. It is not a pressure: mortar has 1e8 to 1e10.
        thickness: of the layer [m], 1e-4 to 1.

    Raises:
        ValueError: for a value outside its range, or a stiffness outside 1e4 to 1e14 N/m3.

    Source: Lourenço (1996), Computational strategies for masonry structures, TU Delft, for joints between stiff units.
    """
    return require_stiffness("k_n = E / thickness", E / thickness)


@within_ranges
def wall_stiffness(E: Modulus, wall: Block, points: PointCount = 2) -> float:
    """k_n = E / H of a base that stands for the elasticity of the wall above it [N/m3].

    Two corner lines of E / H have the rotational stiffness 3 E I / H of a cantilever with a force at its top. On more
    lines k_n is larger, up to 3 E / H of a bed, so that this rotational stiffness stays. It is a lower bound for a wall
    that presses on one edge: the pressure spreads over less than its height.

    Args:
        E: Young's modulus of the masonry [Pa], 1e5 to 1e12.
        wall: the wall.
        points: contact lines a face, 2 to 1000.

    Raises:
        ValueError: for a modulus outside its range, or a stiffness outside 1e4 to 1e14 N/m3.
    """
    require_kind("wall", wall, Block)
    x, widths = contact_lines(2 * wall.half_base, points)
    lines_factor = 2 * wall.half_base**3 / float((widths * x**2).sum())
    return require_stiffness("k_n = E / H", lines_factor * E / (2 * wall.h))


def layered_stiffness(*stiffnesses: float) -> float:
    """k_n of layers in series, such as a joint and the wall above it: 1 / k_n is the sum of theirs [N/m3].

    Args:
        stiffnesses: of each layer [N/m3], at least one, 1e4 to 1e14.

    Raises:
        ValueError: for a value outside its range, or none.
    """
    if not stiffnesses:
        raise ValueError("stiffnesses is empty; at least one layer is needed")
    checked = [require_stiffness(f"stiffnesses[{i}]", value) for i, value in enumerate(stiffnesses)]
    return require_stiffness("k_n of the layers", 1 / sum(1 / value for value in checked))


@within_ranges
def measured_stiffness(
    wall: Block, frequency: Annotated[float, Within(1e-3, 1e4, "Hz")], points: PointCount = 2
) -> float:
    """k_n for which the wall, rocking in full contact on its base, has a measured natural frequency [N/m3].

    The frequency is the lowest out of plane of the detached wall with its top free, at small amplitude, by ambient
    vibration or a tap. It is the inverse of omega^2 = (K_rot - m g z) / I_base with K_rot the sum of k_i x_i^2 over the
    contact lines, z the height of the centroid and I_base the moment of inertia about the middle of the base.

    Args:
        wall: the wall.
        frequency: in cycles a second [Hz], 1e-3 to 1e4, not in rad/s.
        points: contact lines a face, 2 to 1000. The same wall on two corner lines needs a third of the k_n of a uniform
            bed.

    Raises:
        ValueError: for a value outside its range, or a stiffness outside 1e4 to 1e14 N/m3.

    Source: Small oscillations of a rigid body on springs; the engine agrees, see tests/problem/test_stiffness.py.
    """
    require_kind("wall", wall, Block)
    omega = 2 * math.pi * frequency
    unit = reference_frequency(wall, UNIT_STIFFNESS, points) ** 2 / UNIT_STIFFNESS
    gravity_term = wall.weight * wall.centroid_height / base_inertia(wall)
    return require_stiffness("k_n of the measured frequency", (omega**2 + gravity_term) / unit)


Range = tuple[float, float]
SOURCE = "Circolare 21 gennaio 2019 n. 7, Table C8.5.I"


@dataclass(frozen=True)
class MasonryType:
    """Ranges of the properties of a type of masonry.

    Args:
        name: the type, in English.
        italian: the type as the source names it.
        E: Young's modulus, lowest and highest [Pa].
        f_c: mean compressive strength, lowest and highest [Pa].
        unit_weight: lowest and highest [N/m3].
        source: where the numbers stand.
    """

    name: str
    italian: str
    E: Range
    f_c: Range
    unit_weight: Range
    source: str = SOURCE

    __repr__ = short_repr

    @property
    def density(self) -> float:
        """Mean density, the unit weight over g [kg/m3]."""
        return sum(self.unit_weight) / 2 / GRAVITY


def _type(name: str, italian: str, f_c: Range, E: Range, unit_weight: Range) -> MasonryType:
    """A row of the table in its own units: f_c and E [N/mm2], unit weight [kN/m3]."""
    moduli, strengths = (1e6 * E[0], 1e6 * E[1]), (1e6 * f_c[0], 1e6 * f_c[1])
    return MasonryType(name, italian, moduli, strengths, (1e3 * unit_weight[0], 1e3 * unit_weight[1]))


class MasonryTypes(Mapping[str, MasonryType]):
    """Types of masonry by name, that cannot be changed."""

    def __init__(self, types: Iterable[MasonryType]) -> None:
        self._types = {masonry_type.name: masonry_type for masonry_type in types}

    def __getitem__(self, name: str) -> MasonryType:
        if name not in self._types:
            raise KeyError(f"{name!r} is not one of {', '.join(self._types)}")
        return self._types[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._types)

    def __len__(self) -> int:
        return len(self._types)

    def __repr__(self) -> str:
        return f"<{len(self)} types of masonry, from {next(iter(self))} to {list(self)[-1]}>"


MASONRY_TYPES = MasonryTypes(
    (
        _type("irregular rubble", "pietrame disordinata", (1.0, 2.0), (690, 1050), (19, 19)),
        _type("roughly cut stone", "conci sbozzati", (2.0, 2.0), (1020, 1440), (20, 20)),
        _type("split stone, well laid", "pietre a spacco, buona tessitura", (2.6, 3.8), (1500, 1980), (21, 21)),
        _type("irregular soft stone", "irregolare di pietra tenera", (1.4, 2.2), (900, 1260), (13, 16)),
        _type("regular soft stone", "conci regolari di pietra tenera", (2.0, 3.2), (1200, 1620), (13, 16)),
        _type("squared stone blocks", "blocchi lapidei squadrati", (5.8, 8.2), (2400, 3300), (22, 22)),
        _type("solid brick, lime mortar", "mattoni pieni e malta di calce", (2.6, 4.3), (1200, 1800), (18, 18)),
        _type("hollow brick, cement mortar", "mattoni semipieni", (5.0, 8.0), (3500, 5600), (15, 15)),
    )
)
"""Types of existing masonry by name. The ranges are those of the source, for poor mortar and leaves that are not
connected; its Table C8.5.II has factors for better ones. E is that of masonry that has not cracked."""


@dataclass(frozen=True)
class StiffnessRange:
    """The range of an interface stiffness.

    Args:
        low, best, high: k_n [N/m3].
        basis: the data that it comes from, in words.
    """

    low: float
    best: float
    high: float
    basis: str

    __repr__ = short_repr

    def __post_init__(self) -> None:
        keep(self, **{name: require_stiffness(name, getattr(self, name)) for name in ("low", "best", "high")})
        keep(self, basis=require_text("basis", self.basis))
        if not self.low <= self.best <= self.high:
            raise ValueError(f"best = {self.best:g} N/m3 is outside the valid range {self.low:g} to {self.high:g} N/m3")

    @property
    def ends(self) -> list[float]:
        """Low and high, for `vary` of `mjrock.sensitivity` [N/m3]."""
        return [self.low, self.high]

    def __str__(self) -> str:
        return f"k_n = {self.best:.2g} N/m3 ({self.low:.2g} to {self.high:.2g}), from {self.basis}"


def lines_over_bed(wall: Block, points: int) -> float:
    """k_n on some contact lines over that of a uniform bed of the same rotational stiffness [-], 1/3 for two lines."""
    x, widths = contact_lines(2 * wall.half_base, points)
    return (2 * wall.half_base) ** 3 / 12 / float((widths * x**2).sum())


def stiffness_range(
    wall: Block,
    *,
    E: float | Range | MasonryType | None = None,
    joint: tuple[float, float] | None = None,
    frequency: float | Range | None = None,
    points: int = 2,
) -> StiffnessRange:
    """The k_n of the base that an engineer's data leave open: low, best and high [N/m3].

    Every estimate is turned into the k_n of the contact lines that has its rotational stiffness. The low end is a wall
    of modulus E that bends as a cantilever, 3 E I / H, and the high end one that yields on its edge to a depth of its
    thickness (Saint-Venant), E / t of a bed, both with a mortar joint in series. The best value is their geometric
    mean. A measured frequency takes the place of these estimates; without a range of its own it is known to 10 %.

    Args:
        wall: the wall.
        E: Young's modulus of the wall [Pa], a number, its low and high end, or one of `MASONRY_TYPES`.
        joint: Young's modulus [Pa] and thickness [m] of the mortar joint at the base.
        frequency: lowest measured out-of-plane frequency of the detached wall [Hz], a number or its low and high end.
        points: contact lines a face.

    Raises:
        TypeError, ValueError: for a value outside its range, or if neither E nor a frequency is given: a joint alone is
            an upper bound.

    Warns:
        UserWarning: where the measured stiffness lies outside the range that E and the joint give.
    """
    require_kind("wall", wall, Block)
    share = lines_over_bed(wall, points)
    if E is None and frequency is None:
        raise ValueError("E and frequency are None: a joint alone is an upper bound of k_n; give one of them")
    estimate = None if E is None else _range_of_modulus(wall, E, joint, share)
    if estimate is None and joint is not None:
        raise ValueError("joint needs E of the wall beside it; a measured frequency contains the joint already")
    if frequency is None:
        assert estimate is not None
        return estimate
    ends = _ends_of_range("frequency", frequency, 1e-3, 1e4, "Hz", 0.1)
    low, high = (measured_stiffness(wall, end, points) for end in ends)
    best = measured_stiffness(wall, math.sqrt(ends[0] * ends[1]), points)
    measured = StiffnessRange(low, best, high, f"a frequency of {ends[0]:.3g} to {ends[1]:.3g} Hz")
    if estimate is not None and not (low <= estimate.high and estimate.low <= high):
        warn_of(
            f"the measured frequency gives k_n = {low:.2g} to {high:.2g} N/m3, and {estimate.basis} gives "
            f"{estimate.low:.2g} to {estimate.high:.2g} N/m3; is the wall detached, and the frequency in Hz?"
        )
    return measured


def _range_of_modulus(wall: Block, E: object, joint: object, share: float) -> StiffnessRange:
    """The range that the modulus of the wall and a joint leave open."""
    if isinstance(E, MasonryType):
        moduli, basis = E.E, f"E of {E.name} ({E.source})"
    else:
        moduli = _ends_of_range("modulus E", E, 1e5, 1e12, "Pa", 0.0)
        basis = f"E = {moduli[0]:.3g} to {moduli[1]:.3g} Pa"
    column, edge = 3 * moduli[0] / (2 * wall.h), moduli[1] / (2 * wall.b)
    low, high = min(column, edge), max(column, edge)
    if joint is not None:
        if not isinstance(joint, tuple | list) or len(joint) != 2:
            raise TypeError(f"joint = {shown(joint)} is not a modulus [Pa] and a thickness [m]")
        modulus = require_within("joint, modulus E", joint[0], 1e5, 1e12, "Pa")
        layer = modulus / require_within("joint, thickness", joint[1], 1e-4, 1.0, "m")
        low, high = (1 / (1 / value + 1 / layer) for value in (low, high))
        basis += f" and a joint of {joint[1]:g} m with E = {modulus:.3g} Pa"
    return StiffnessRange(share * low, share * math.sqrt(low * high), share * high, basis)


def _ends_of_range(name: str, value: object, lowest: float, highest: float, unit: str, tolerance: float) -> Range:
    """Low and high end of a quantity; a single number is widened by the share to which it is known."""
    if not isinstance(value, tuple | list):
        number = require_within(name, value, lowest, highest, unit)
        return (1 - tolerance) * number, (1 + tolerance) * number
    if len(value) != 2:
        raise ValueError(f"{name} = {shown(value)} is neither a number nor its low and high end")
    low, high = (require_within(name, end, lowest, highest, unit) for end in value)
    if not low <= high:
        raise ValueError(f"{name} = {shown(value)} is not a low end and a high end, in this order")
    return low, high


def crushed_inset(wall: Block, f_c: float, load: float = 0.0) -> float:
    """How far a toe that crushes moves the edge inwards, for `inset` of the wall [m].

    The stress under the tilted wall is taken as linear, from the strength f_c at the edge to zero. Its resultant, the
    weight W and a load, then lies 2 (W + load) / (3 f_c L) from the edge, L the length of the base.

    Args:
        wall: the wall.
        f_c: compressive strength of the masonry [Pa], 1e4 to 1e9.
        load: vertical force on the wall besides its weight [N], 0 to 1e9.

    Raises:
        ValueError: for a value outside its range, or a strength that cannot carry the wall on its edge.

    Source: Equilibrium of a triangular stress block.
    """
    require_kind("wall", wall, Block)
    f_c = require_within("compressive strength f_c", f_c, 1e4, 1e9, "Pa")
    force = wall.weight + require_within("load", require_real("load", load), 0.0, 1e9, "N")
    inset = 2 * force / (3 * f_c * wall.base_length)
    if not inset < wall.b:
        weakest = 2 * force / (3 * wall.b * wall.base_length)
        raise ValueError(
            f"compressive strength f_c = {f_c:g} Pa cannot carry the wall on its edge; the valid range is above "
            f"{weakest:.3g} Pa"
        )
    return inset
