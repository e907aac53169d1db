"""A tie that holds a wall back."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, TypedDict, Unpack

from ...quantities import OneOf, Within, require_array, require_one_of, require_within, within_ranges
from .effect import HIGHEST_WALL, OF_MASONRY, Anchored, Height, LinkLaw, OfBlock, PointOf

GOVERNING = ("bar", "punching", "bearing", "other end")
"""What the strength of a tie with an anchor plate may be that of."""
Diameter = Annotated[float, Within(0.004, 0.2, "m", "diameter of the bar")]
YieldStress = Annotated[float, Within(50e6, 2e9, "Pa", "yield_stress of the bar")]
Plate = Annotated[float | tuple[float, float], Within(0.02, 3, "m", "plate")]
Spacing = Annotated[float | None, Within(0.02, 1000, "m", "spacing of the ties")]
Thickness = Annotated[float, Within(0.05, 10, "m", "thickness of the wall")]
STRONGEST_TIE = 1e12
"""Largest strength of a tie [N]."""
ShearStrength = Annotated[float, Within(1e3, 5e6, "Pa", "shear_strength of the masonry")]
Strength = Annotated[float, Within(1e5, 1e8, "Pa", "compressive_strength of the masonry")]
Count = Annotated[int, Within(1, 1000, name="number of ties", whole=True)]


class TieOptions(TypedDict, total=False):
    """Fields of a `Tie` that `Tie.of_bar` hands on."""

    slack: float
    anchor_height: float | None
    block: OfBlock
    ultimate: float | None
    at: PointOf | None
    anchor: PointOf | None
    anchor_block: OfBlock | None
    prestress: float


@dataclass(frozen=True, repr=False)
class Tie(Anchored):
    """A tie that holds the inner face of the wall back: it pulls, never pushes, yields plastically, and may break.

    The tie runs horizontally from the inner face to an anchor behind the wall, unless `anchor_height` says otherwise.
    Its force is min(strength, prestress plus stiffness times elongation), the elongation beyond the slack and beyond
    what has yielded.
    A tie that has yielded by `ultimate` breaks: it pulls no more, and its elastic energy is lost.

    Args:
        height: where it holds the wall [m], 0 to 200.
        stiffness: E A over its length [N/m], 1 to 1e12.
        slack: elongation before it pulls [m], 0 to 10.
        strength: force at which it yields [N], above 0 to 1e12; infinite for one that does not.
        length: distance from the inner face to the anchor [m], 0.01 to 1000.
        anchor_height: height of the anchor [m], -200 to 200; None is that of the tie.
        block: the block that it holds.
        ultimate: plastic elongation at which it breaks [m], 0 to 10, such as the slip at which an anchor plate is
            pulled through; 0 for one that breaks as it begins to yield. None never breaks.
        at: of masonry, the point that it holds, x, z or x, y, z at rest [m]; it takes the place of the height.
        anchor: of masonry, its other end at rest [m]. None is `length` behind the point.
        anchor_block: of masonry, the block that the other end is fixed to and moves with; None is the ground. In the
            plane the end lies `length` to the left.
        prestress: its force at rest [N], 0 to 1e9 and below the strength; without slack. It pulls with it before
            anything moves.
        governed_by: what its strength is that of, "bar", "punching", "bearing" or "other end", for sketch and report;
            `of_bar` sets it. None does not say.

    Raises:
        ValueError: for a value outside its range, an `ultimate` without a finite strength, or a prestress that the
            tie cannot have.

    Examples:
        >>> tie = mr.Tie(height=3.8, stiffness=20e6, strength=40e3)
        >>> mr.Case(wall, 0.0, 1.0, effects=(tie,)).effects[0].strength
        40000.0
    """

    label: ClassVar[str] = "tie"
    arguments: ClassVar[str] = "height, stiffness, slack,\nstrength, ultimate, length, anchor_height"
    height: Height = None  # type: ignore[assignment]
    stiffness: Annotated[float, Within(1, 1e12, "N/m")] = None  # type: ignore[assignment]
    slack: Annotated[float, Within(0, 10, "m")] = 0.0
    strength: Annotated[float, Within(0, STRONGEST_TIE, "N", infinite=True)] = math.inf
    length: Annotated[float, Within(0.01, 1000, "m")] = 5.0
    anchor_height: Annotated[float | None, Within(-HIGHEST_WALL, HIGHEST_WALL, "m", "height of the anchor")] = None
    block: OfBlock = 0
    ultimate: Annotated[float | None, Within(0, 10, "m")] = None
    at: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor: PointOf | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    anchor_block: OfBlock | None = field(default=None, kw_only=True, metadata=OF_MASONRY)
    governed_by: Annotated[str | None, OneOf(GOVERNING)] = field(default=None, kw_only=True)
    prestress: Annotated[float, Within(0, 1e9, "N")] = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.strength == 0:
            raise ValueError(
                f"strength of the tie = 0 N is outside the valid range, which is above 0 N to {STRONGEST_TIE:g} "
                "N, or inf for a tie that does not yield"
            )
        if self.governed_by is not None:
            require_one_of("governed_by of the tie", self.governed_by, GOVERNING)
        if self.prestress and (self.slack or self.prestress >= self.strength):
            conflicting = f"slack = {self.slack:g} m" if self.slack else f"strength = {self.strength:g} N"
            raise ValueError(f"prestress of the tie = {self.prestress:g} N does not go with its {conflicting}")
        if self.ultimate is not None and self.strength == math.inf:
            raise ValueError(
                f"ultimate of the tie = {self.ultimate:g} m, and its strength is infinite: it does not yield "
                "and never breaks; give it a strength [N], or leave ultimate out"
            )

    @classmethod
    @within_ranges
    def of_bar(
        cls,
        height: Height,
        diameter: Diameter,
        yield_stress: YieldStress,
        length: Annotated[float, Within(0.01, 1000, "m", "length of the tie")],
        *,
        plate: Plate,
        thickness: Thickness,
        shear_strength: ShearStrength,
        compressive_strength: Strength,
        elastic_modulus: Annotated[float, Within(5e10, 3e11, "Pa", "elastic_modulus of the bar")] = 210e9,
        number: Count = 1,
        spacing: Spacing = None,
        other_end: Annotated[float | None, Within(1, 1e9, "N", "other_end of the tie")] = None,
        **options: Unpack[TieOptions],
    ) -> Tie:
        """Ties of round steel bars with anchor plates on a wall, from what is known of them.

        The stiffness is n E A / L. The strength is the least of three [N], and `governed_by` names it: that of the
        bars, n f_y A; that against punching, n f_v0 2 t (a + b + 2 t), of prisms of masonry whose sides run outwards
        at 45 degrees from the plate, cut at half the thickness t; and that of the masonry under the plates, n f_m a b.
        Plates in a row at the `spacing` s may punch as one plate of (n - 1) s + a by b instead, where that is less.
        `strengths_of_bar` has all three. `ultimate` is not known from these. All are without partial factors. The bar
        is that of EN 1993-1-1, 6.2.3(2), and the bearing that of EN 1996-1-1, 6.1.3(2), with beta = 1. No clause gives
        the punching: it is usual practice, such as in an example for a round plate in Master Magazine 7, p. 75.

        Args:
            height: where they hold the wall [m], 0 to 200.
            diameter: of a bar [m], 0.004 to 0.2.
            yield_stress: f_y of the steel [Pa], 50e6 to 2e9.
            length: free length L of a bar, from the inner face to its anchor [m], 0.01 to 1000.
            plate: side of a square plate, or its two sides a and b [m], 0.02 to 3.
            thickness: of the wall behind the plate t [m], 0.05 to 10.
            shear_strength: f_v0 of the masonry [Pa], 1e3 to 5e6.
            compressive_strength: f_m of the masonry [Pa], 1e5 to 1e8.
            elastic_modulus: E of the steel [Pa], 5e10 to 3e11.
            number: n of equal ties at this height, 1 to 1000.
            spacing: s of several ties between centres, along the side a [m], 0.02 to 1000 and at least a;
                None is far apart.
            other_end: what holds the other end of all of them bears [N], 1 to 1e9: the least of `strengths_of_bar` of a
                plate on the wall there, or of `strengths_of_anchor`; None does not govern.
            options: other fields of `Tie`, such as `slack` and `ultimate`.

        Raises:
            TypeError, ValueError: for a value outside its range.
        """
        masonry = (thickness, shear_strength, compressive_strength)
        strengths = strengths_of_bar(diameter, yield_stress, plate, *masonry, number=number, spacing=spacing)
        stiffness = number * elastic_modulus * area_of_bar(diameter) / length
        if other_end is not None:
            strengths["other end"] = other_end
        weakest = min(strengths, key=lambda name: strengths[name])
        return cls(height, stiffness, length=length, strength=strengths[weakest], governed_by=weakest, **options)

    @property
    def rise(self) -> float:
        """How much higher the anchor is than the point that is held [m]."""
        return 0.0 if self.anchor_height is None else self.anchor_height - self.height

    @property
    def reach(self) -> float:
        """Length up to which the tie is slack [m]."""
        return self.span + self.slack - self.prestress / self.stiffness

    @property
    def stretch(self) -> float:
        """Elastic elongation at which it yields [m]."""
        return self.strength / self.stiffness

    @property
    def breaks_at(self) -> float:
        """Plastic elongation at which it breaks [m], infinite for one that never does."""
        return math.inf if self.ultimate is None else self.ultimate

    @property
    def law(self) -> LinkLaw:
        """A spring that pulls."""
        return LinkLaw(self.stiffness, self.reach, self.strength, ultimate=self.breaks_at)

    @property
    def description(self) -> str:
        """For sketches, and for reports that have no words for it."""
        text = f"z = {self.height:g} m, {self.length:g} m long,\n"
        text += f"k = {self.stiffness / 1e6:.4g} kN/mm, slack {1e3 * self.slack:g} mm"
        if self.prestress:
            text += f", prestress {self.prestress / 1e3:.4g} kN"
        if self.strength < math.inf:
            text += f",\nyields at {self.strength / 1e3:.4g} kN"
        if self.governed_by is not None:
            text += f" ({self.governed_by})"
        return text if self.ultimate is None else f"{text}, breaks at {1e3 * self.ultimate:g} mm"


def area_of_bar(diameter: float) -> float:
    """Section of a round bar [m2]."""
    return 0.25 * math.pi * diameter**2


@within_ranges
def strengths_of_bar(
    diameter: Diameter,
    yield_stress: YieldStress,
    plate: Plate,
    thickness: Thickness,
    shear_strength: ShearStrength,
    compressive_strength: Strength,
    *,
    number: Count = 1,
    spacing: Spacing = None,
) -> dict[str, float]:
    """Strengths of equal ties [N], by what gives way: "bar", "punching" and "bearing", of which `Tie.of_bar` takes the
    least. The arguments and their ranges are those of `Tie.of_bar`.

    Raises:
        TypeError, ValueError: for a value outside its range.

    Examples:
        >>> masonry = {"thickness": 0.55, "shear_strength": 30e3, "compressive_strength": 2e6}
        >>> found = mr.strengths_of_bar(0.024, 235e6, 0.3, **masonry)
        >>> {name: round(force / 1e3, 1) for name, force in found.items()}
        {'bar': 106.3, 'punching': 56.1, 'bearing': 180.0}
    """
    a, b = (plate, plate) if isinstance(plate, int | float) else require_array("plate", plate, (2,)).tolist()
    perimeter = a + b + 2 * thickness
    punched_length = number * perimeter
    if spacing is not None:
        spacing = require_within("spacing of the ties", spacing, a, 1000.0, "m")
        punched_length = min(punched_length, perimeter + (number - 1) * spacing)
    bar, bearing = number * yield_stress * area_of_bar(diameter), number * compressive_strength * a * b
    strengths = bar, shear_strength * 2 * thickness * punched_length, bearing
    return dict(zip(GOVERNING, strengths, strict=False))


@within_ranges
def strengths_of_anchor(
    hole: Annotated[float, Within(0.008, 0.3, "m", "diameter of the hole")],
    length: Annotated[float, Within(0.05, 20, "m", "length of the anchor")],
    bond_strength: Annotated[float, Within(1e4, 1e7, "Pa", "bond_strength of the grout")],
    shear_strength: ShearStrength,
    *,
    number: Count = 1,
) -> dict[str, float]:
    """Strengths of equal anchors that are grouted into holes in a wall [N], by what gives way, for `Tie.of_bar`.

    "bond" is n f_b pi D l, on the surface of the hole. "cone" is n f_v0 pi (D + l) l: masonry that is drawn out at 45
    degrees, cut at half the depth, as under the plates of `Tie.of_bar`. The bar itself is that of the tie. All are
    without partial factors, and both are usual practice and from no clause. Holes are farther apart than their length.

    Args:
        hole: D [m], 0.008 to 0.3.
        length: l that is grouted [m], 0.05 to 20.
        bond_strength: f_b of grout on masonry [Pa], 1e4 to 1e7.
        shear_strength: f_v0 of the masonry [Pa], 1e3 to 5e6.
        number: n of equal anchors, 1 to 1000.

    Raises:
        TypeError, ValueError: for a value outside its range.

    Examples:
        >>> found = mr.strengths_of_anchor(0.05, 0.6, 0.3e6, 60e3)
        >>> {name: round(force / 1e3, 1) for name, force in found.items()}
        {'bond': 28.3, 'cone': 73.5}
    """
    bond = number * bond_strength * math.pi * hole * length
    return {"bond": bond, "cone": number * shear_strength * math.pi * (hole + length) * length}
