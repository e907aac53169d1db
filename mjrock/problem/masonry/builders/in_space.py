"""Builders of blocks in space: a box, a column, a dome, a corner, a wallette, and a facade with return walls."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....quantities import (
    Density,
    Within,
    require_array,
    require_flag,
    require_kind,
    require_sequence,
    require_whole,
    require_within,
    shown,
    spelt,
    within_ranges,
)
from ...wall.bending import HorizontalBending
from ...wall.section import Opening
from ..blocks.compound import Compound, SolidBlock
from ..blocks.polygon import COORDINATE, Polygon
from ..blocks.polyhedron import Extents, Polyhedron
from ..laws.bond import Bond
from .in_plane import (
    MOST_BODIES,
    SMALLEST_PIECE,
    Length,
    Size,
    Taper,
    Thick,
    Unit,
    extent_of_ground,
    friction_of,
    required_ends,
    required_unit,
    rings_of,
    shear_wall,
)

__all__ = ["between_sides", "box", "column", "corner", "dome", "facade", "wallette"]

COINCIDING = 1e-6
"""How far edges that are to coincide may lie apart, over the unit [-]."""
SLENDEREST = 100.0
"""Height of a drum over its width at most, and the other way round [-]: a hundred sides can still be distinguished."""


def ground_below(low: ArrayLike, high: ArrayLike) -> Polyhedron:
    """Fixed ground under what stands on it between two corners x, y, z [m]."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    wide = (high - low)[:2]
    beyond, depths = np.array([extent_of_ground(extent, high[2] - low[2]) for extent in wide]).T
    deep = float(depths.max())
    middle = 0.5 * (low + high)[:2]
    return Polyhedron.box((*(wide + 2 * beyond), deep), (*middle, low[2] - 0.5 * deep), fixed=True, name="ground")


@within_ranges
def box(size: Extents, *, density: Density = 2000.0) -> list[Polyhedron]:
    """One box, `block`, on the ground, in the middle of it.

    Args:
        size: its extents along x, y and z [m], 1e-3 to 10000 each.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range.
    """
    extents = require_array("size", size, (3,))
    block = Polyhedron.box(extents, (0.0, 0.0, 0.5 * float(extents[2])), density, name="block")
    return [ground_below(block.corners.min(axis=0), block.corners.max(axis=0)), block]


@within_ranges
def column(
    width: Annotated[Taper, Within(0.01, 100, "m")],
    height: Annotated[float, Within(0.01, 1000, "m")],
    drums: Annotated[int, Within(1, 1000, whole=True)],
    *,
    sides: Annotated[int, Within(3, 100, whole=True)] = 4,
    density: Density = 2000.0,
) -> list[Polyhedron]:
    """A column of drums of equal height on the ground.

    Args:
        width: diameter of the circle within the section [m], 0.01 to 100: the side of a square. A pair is that of
            the bottom and of the top of a column that tapers.
        height: of the column [m], 0.01 to 1000.
        drums: how many, 1 to 1000, each of a height of 0.01 to 100 widths. They are named `drum_0` and so on, from
            the lowest upwards.
        sides: of the section, a regular polygon, 3 to 100. A square one has its sides along x and y.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range.
    """
    ends = required_ends("width", width, 1e-2, 100.0)
    angles = 2 * math.pi * (np.arange(sides) + 0.5) / sides
    for wide in ends:
        if not 1 / SLENDEREST <= (slender := height / (drums * wide)) <= SLENDEREST:
            raise ValueError(
                f"height is {height:g} m for {drums} drums {wide:g} m wide: a drum is {slender:.3g} times as high as "
                f"wide; the valid range is [{1 / SLENDEREST:g}, {SLENDEREST:g}]"
            )
    ring = 0.5 / math.cos(math.pi / sides) * np.column_stack([np.cos(angles), np.sin(angles)])
    levels, widths = np.linspace(0.0, height, drums + 1), np.linspace(*ends, drums + 1)
    blocks = [ground_below((*(max(ends) * ring.min(axis=0)), 0.0), (*(max(ends) * ring.max(axis=0)), height))]
    for i in range(drums):
        vertices = [(*(widths[j] * at), levels[j]) for j in (i, i + 1) for at in ring]
        blocks.append(Polyhedron(vertices, density, name=f"drum_{i}"))
    return blocks


@within_ranges
def dome(
    radius: Annotated[float, Within(0.1, 1000, "m")],
    thickness: Thick,
    lunes: Annotated[int, Within(4, 360, whole=True)],
    hoops: Annotated[int, Within(1, 360, whole=True)],
    *,
    oculus: Annotated[float, Within(0.01, 1.5, "rad")] = 0.05,
    density: Density = 2000.0,
) -> list[Polyhedron]:
    """A hemispherical dome of voussoirs with plane faces, which springs from the ground.

    Args:
        radius: of the middle of the thickness at the corners of the voussoirs [m], 0.1 to 1000.
        thickness: [m], 1e-5 to 1000, 0.001 to 1 times the radius; or a pair, at the springing and at the oculus,
            between which it changes linearly with the angle.
        lunes: how many voussoirs a hoop has, 4 to 360.
        hoops: how many hoops of equal angles, 1 to 360. `voussoir_0_3` is the fourth of the lowest hoop.
        oculus: angle at the centre between the axis and the edge of the opening at the crown [rad], 0.01 to 1.5.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range.
    """
    if lunes * hoops >= MOST_BODIES:
        raise ValueError(f"lunes = {lunes} times hoops = {hoops} is outside the valid range up to {MOST_BODIES}")
    inner, outer = rings_of(radius, thickness, np.arange(hoops + 1) / hoops)
    polar, around = np.linspace(0.5 * math.pi, oculus, hoops + 1), 2 * math.pi * np.arange(lunes + 1) / lunes
    sines, levels = np.sin(polar), np.append(0.0, np.cos(polar[1:]))
    rays = sines[:, None, None] * np.column_stack([np.cos(around), np.sin(around)])
    directions = np.dstack([rays, np.broadcast_to(levels[:, None], rays.shape[:2])])  # (hoops + 1, lunes + 1, 3)
    directions[:, -1] = directions[:, 0]
    wide = float(outer.max())
    blocks = [ground_below((-wide, -wide, 0.0), (wide, wide, wide))]
    faces = np.stack([face[:, None, None] * directions for face in (inner, outer)])
    for j in range(hoops):
        for i in range(lunes):
            corners = faces[:, j : j + 2, i : i + 2].reshape(8, 3)
            blocks.append(Polyhedron(corners, density, name=f"voussoir_{j}_{i}"))
    return blocks


BELOW_BY_ROUNDING = 1 - 1e-9
"""Factor on the least size of a wall, so that rounding does not refuse it [-]."""
RETURNS = {"both": (True, True), "left": (True, False), "right": (False, True), "none": (False, False)}
"""Whether there is a return wall at the left, where y is negative, and at the right end of a facade."""
Rectangle = tuple[float, float, float, float]
"""Part of the face of a wall: from y to y, and from z to z [m]."""


class Walls(NamedTuple):
    """Measures of a facade and of the return walls behind it, with units that are made to fit [m].

    Args:
        length, depth, thickness: of the facade, of the return walls from the face of the facade, and of both.
        unit, behind: length of a unit of the facade and of the return walls.
        high: height of a course.
        courses, gable: how many courses the walls have, and the facade above them.
        sides: whether there is a return wall at the left and at the right.
    """

    length: float
    depth: float
    thickness: float
    unit: float
    behind: float
    high: float
    courses: int
    gable: int
    sides: tuple[bool, bool]

    @property
    def ends(self) -> tuple[float, float]:
        """Length of the corners at the left and at the right, where a return wall and the facade take turns [m]."""
        return self.thickness * self.sides[0], self.thickness * self.sides[1]

    def span(self, course: int) -> tuple[float, float]:
        """Where a course of the facade begins and ends [m]. In every second course the return walls come through."""
        shorter = course % 2 if course < self.courses else course - self.courses + self.courses % 2
        left, right = (end + 0.5 * (shorter - 1) * self.unit if shorter else 0.0 for end in self.ends)
        return left - 0.5 * self.length, 0.5 * self.length - right

    def heads(self, course: int) -> list[float]:
        """Where the head joints of a course of the facade are [m]: half a unit beside those below."""
        first = self.ends[0] - 0.5 * self.length + (1.0 if course % 2 else 0.5) * self.unit
        return np.arange(first, 0.5 * self.length, self.unit).tolist()

    def behind_ends(self, course: int) -> list[float]:
        """Where the blocks of a course of a return wall end, from the face of the facade inwards [m]."""
        first = self.thickness + (0.5 if course % 2 else 1.0) * self.behind
        heads = np.arange(first, self.depth - COINCIDING * self.behind, self.behind).tolist()
        return [0.0 if course % 2 else self.thickness, *heads, self.depth]


class FacadeSize(NamedTuple):
    """Length and height of a facade, and depth of its return walls [m]."""

    length: float
    height: float
    depth: float


def walls_of(
    size: FacadeSize, unit: tuple[float, float], *, thickness: float | None, returns: str, gable: int
) -> Walls:
    """Measures of a facade, checked, see `facade`."""
    (length, height, depth), (long, high) = size, required_unit(unit)
    if not isinstance(returns, str) or returns not in RETURNS:
        raise ValueError(f"returns = {spelt(returns)} is not one of {', '.join(RETURNS)}")
    sides = RETURNS[returns]
    t = 0.5 * long if thickness is None else thickness
    corners = t * sum(sides)
    length = require_within("length", length, (corners + long) * BELOW_BY_ROUNDING, 1e3, "m")
    height = require_within("height", height, high * BELOW_BY_ROUNDING, 1e3, "m")
    depth = require_within("depth", depth, (t + 0.5 * long) * BELOW_BY_ROUNDING, 1e3, "m") if any(sides) else t
    units, courses = round((length - corners) / long), round(height / high)
    halves = max(round(2 * (depth - t) / long), 1)
    gable = require_whole("gable", gable, 0, units + 1 - courses % 2)
    if (courses + gable) * (units + 1) + courses * (halves // 2 + 1) * sum(sides) >= MOST_BODIES:
        raise ValueError(f"length, height and depth need more units than {MOST_BODIES}; give larger units")
    fitted, behind = (length - corners) / units, 2 * (depth - t) / halves
    return Walls(length, depth, t, fitted, behind, height / courses, courses, gable, sides)


@within_ranges
def facade(
    length: Size,
    height: Size,
    depth: Annotated[float, Within(0, 1000, "m")],
    unit: Unit,
    *,
    thickness: Annotated[float | None, Within(0.01, 10, "m")] = None,
    returns: str = "both",
    openings: Sequence[tuple[Annotated[float, COORDINATE], Opening]] = (),
    gable: int = 0,
    ground: Polyhedron | None = None,
    density: Density = 2000.0,
) -> list[Polyhedron]:
    """A facade and return walls behind it, on the ground.

    All walls are one unit thick and in running bond, by half a unit. In every second course the return walls come
    through to the face of the facade as headers. Units are made to fit: their length and height are the nearest to
    the given ones that divide the walls. The face of the facade is x = 0, and the middle of its length is y = 0.
    Blocks are named `facade_`, `left_` and `right_` with the course and a number in it.

    Args:
        length: of the facade with its corners [m], 0.01 to 1000.
        height: of the walls [m], 0.01 to 1000.
        depth: of the return walls with the thickness of the facade [m], 0 to 1000; without any it
            plays no part.
        unit: length and height of a unit [m], 0.01 to 100.
        thickness: of all walls [m], 0.01 to 10; None is half the length of a unit.
        returns: where return walls are: "both" ends, "left" where y is negative, "right" or "none".
        openings: pairs of the y of the middle of an opening [m], -10000 to 10000, and the `Opening`. They cut
            units. A lintel of half a course or more lies over each, up to a bed joint, and bears on half a unit on
            either side.
        gable: courses above the walls, each of which is a unit shorter than the one below, 0 to as many as there
            are. The first is as long as the facade, or shorter by the corners over an odd number of courses.
        ground: a fixed block with its upper face at z = 0; None is ground that reaches two heights beyond.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range, or an opening that does not fit.
    """
    require_kind("ground", ground, Polyhedron, type(None))
    walls = walls_of(FacadeSize(length, height, depth), unit, thickness=thickness, returns=returns, gable=gable)
    holes, lintels = _holes(openings, walls)
    half, top = 0.5 * walls.length, (walls.courses + walls.gable) * walls.high
    if ground is None:
        ground = ground_below((-walls.depth, -half, 0.0), (0.0, half, top))
    blocks, names = [ground], Counter[str]()

    def lay(name: str, x: tuple[float, float], face: Rectangle) -> None:
        low, high = (x[0], face[0], face[2]), (x[1], face[1], face[3])
        corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
        names[name] += 1
        suffix = "" if names[name] == 1 else chr(ord("a") + names[name] - 1)
        blocks.append(Polyhedron(corners, density, name=name + suffix))

    for course in range(walls.courses + walls.gable):
        z = course * walls.high, (course + 1) * walls.high
        over = [face for face in lintels if z[0] * (1 - COINCIDING) <= face[2] < z[1] * (1 - COINCIDING)]
        for face in sorted([*over, *_pieces(walls, course, [*holes, *lintels])]):
            lay(f"facade_{course}_{int((face[0] + half) / (0.5 * walls.unit) + 0.01)}", (-walls.thickness, 0.0), face)
        if course < walls.courses:
            for side, y in (("left", (-half, walls.thickness - half)), ("right", (half - walls.thickness, half))):
                if walls.sides[side == "right"]:
                    for i, (front, back) in enumerate(pairwise(walls.behind_ends(course))):
                        lay(f"{side}_{course}_{i}", (-back, -front), (*y, *z))
    return blocks


def _holes(openings: Sequence[tuple[float, Opening]], walls: Walls) -> tuple[list[Rectangle], list[Rectangle]]:
    """The openings, and the lintels over them: up to a bed joint, half a course high or more."""
    require_sequence("openings", openings, "a sequence of (y, Opening)")
    holes: list[Rectangle] = []
    lintels: list[Rectangle] = []
    for i, pair in enumerate(openings):
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise TypeError(f"openings[{i}] = {shown(pair)} is not (y, Opening)")
        y, opening = COORDINATE.checked(f"openings[{i}], y", pair[0]), pair[1]
        require_kind(f"openings[{i}]", opening, Opening)
        if opening.round:
            raise ValueError(f"openings[{i}] is round, and blocks are convex: give the rectangle that is left open")
        left, right = y - 0.5 * opening.width, y + 0.5 * opening.width
        top = walls.high * math.ceil(opening.head / walls.high + 0.5 - COINCIDING)
        bearing = 0.5 * walls.unit
        _require_inside(i, (left - bearing, right + bearing, opening.sill, top), walls)
        for k, (hole, lintel) in enumerate(zip(holes, lintels, strict=True)):
            near = COINCIDING * walls.unit
            beside = left - bearing > lintel[1] - near or right + bearing < lintel[0] + near
            if not beside and opening.sill < lintel[3] - near and hole[2] < top - near:
                raise ValueError(f"openings[{i}] and openings[{k}], or the lintels over them, overlap")
        holes.append((left, right, opening.sill, opening.head))
        lintels.append((left - bearing, right + bearing, opening.head, top))
    return holes, lintels


def _require_inside(i: int, occupied: Rectangle, walls: Walls) -> None:
    """Raise a ValueError for an opening that does not lie, with its lintel, within the courses that it cuts."""
    left, right, sill, top = occupied
    near = COINCIDING * walls.unit
    if top > (walls.courses + walls.gable) * walls.high + near:
        raise ValueError(f"openings[{i}] has no course above it for its lintel, which ends at {top:g} m")
    for course in range(int(sill / walls.high + COINCIDING), round(top / walls.high)):
        first, last = walls.span(course)
        if left < first - near or right > last + near:
            raise ValueError(
                f"openings[{i}] with its lintel reaches from y = {left:g} to {right:g} m; the valid range in course "
                f"{course} is {first:g} to {last:g} m"
            )


def _pieces(walls: Walls, course: int, holes: Sequence[Rectangle]) -> list[Rectangle]:
    """Units of a course of the facade, cut where openings and lintels are."""
    (first, last), low, high = walls.span(course), course * walls.high, (course + 1) * walls.high
    near, smallest = COINCIDING * walls.unit, SMALLEST_PIECE * (1 - COINCIDING)
    cutting = [hole for hole in holes if hole[2] < high - near and hole[3] > low + near]
    edges = [edge for hole in cutting for edge in hole[:2] if first + near < edge < last - near]
    cuts = sorted({first, *edges, last})
    cuts = [cut for i, cut in enumerate(cuts) if i == 0 or cut > cuts[i - 1] + near]
    uncut: list[Rectangle] = []
    for left, right in pairwise(cuts):
        middle, start = 0.5 * (left + right), low
        above = sorted((hole[2:] for hole in cutting if hole[0] < middle < hole[1]), key=lambda z: z[0])
        for sill, head in [*above, (high, high)]:
            if sill > start + near:
                grown = [k for k, part in enumerate(uncut) if part[1:] == (left, start, sill)]
                part = (uncut.pop(grown[0])[0] if grown else left, right, start, sill)
                uncut.append(part)
            start = max(start, head)
    pieces = []
    for left, right, start, end in uncut:
        if right - left < smallest * walls.unit or end - start < smallest * walls.high:
            raise ValueError(
                f"openings leave a piece of {right - left:.3g} x {end - start:.3g} m at y = {left:g} m in course "
                f"{course}; the valid range begins at {SMALLEST_PIECE} of a unit, {walls.unit:.4g} x {walls.high:.4g} m"
            )
        inner = [
            head
            for head in walls.heads(course)
            if left + smallest * walls.unit <= head <= right - smallest * walls.unit
        ]
        pieces += [(start_y, end_y, start, end) for start_y, end_y in pairwise([left, *inner, right])]
    return pieces


@friction_of(rest=0.0)
@within_ranges
def corner(
    thickness: Annotated[float, Within(0.01, 10, "m")],
    height: Annotated[float, Within(0.1, 100, "m")],
    angle: Annotated[float, Within(0, 1.4, "rad")] = 0.0,
    *,
    density: Annotated[float, Within(100, 30000, "kg/m3")] = 2000.0,
) -> list[SolidBlock]:
    """A corner of two walls that overturns with a wedge of either, from smooth cracks.

    The outer faces are x = 0 and y = 0, and the walls go towards -x and y. Along its diagonal, which is
    `angle=-math.pi / 4` of `push` and `collapse_multiplier`, the corner turns about its outer edge at the origin.
    Across one wall it turns about the outer face of that, at 1 / sqrt(2) of the multiplier below. With t the
    thickness, h the height and p = h tan(angle) the length of a wedge at the top,

        alpha_0 = [t^2 + p (3 t / 2 + p / 3)] / (sqrt(2) h (t / 2 + 2 p / 3)).

    `friction` of `Masonry` is that of the base. The blocks are "ground", "corner", and "rest_0" and "rest_1", what
    stays of the walls. All but the corner are fixed.

    Args:
        thickness: of both walls [m], 0.01 to 10.
        height: of the storey that turns [m], 0.1 to 100.
        angle: of the cracks from the vertical [rad], 0 to 1.4. Without wedges the post in the corner turns alone.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> corner = mr.Masonry.corner(0.5, 4.0, angle=math.radians(30))
        >>> round(float(mr.collapse_multiplier(corner, angle=-math.pi / 4).multiplier), 4)
        0.3714
    """
    t, long = thickness, height * math.tan(angle)
    end = long + max(t, 0.5 * height)

    def along(shape: Sequence[tuple[float, float]], name: str = "") -> list[Polyhedron]:
        sides = (
            [(x, t + s, z) for x in (-t, 0.0) for s, z in shape],
            [(-t - s, y, z) for y in (0.0, t) for s, z in shape],
        )
        return [
            Polyhedron(corners, density, fixed=bool(name), name=f"{name}_{i}" if name else None)
            for i, corners in enumerate(sides)
        ]

    post = Polyhedron.box((t, t, height), (-0.5 * t, 0.5 * t, 0.5 * height), density, name="corner")
    turning = [post, *along([(0.0, 0.0), (0.0, height), (long, height)])] if long > 0 else [post]
    staying = along([(0.0, 0.0), (long, height), (end, height), (end, 0.0)], "rest")
    ground = ground_below((-t - end, 0.0, 0.0), (0.0, t + end, height))
    return [ground, Compound(turning, name="corner") if long > 0 else post, *staying]


@friction_of(guide=0.0, ground=0.0)
@within_ranges
def between_sides(bending: HorizontalBending) -> list[Polyhedron]:
    """A wall that cracks upright between two side walls, on a smooth bed.

    The inner face is x = 0, and the middle of the wall y = 0. A block at either end stands for a side wall: smooth
    guides hold it across the wall, and `effects=bending.tie` along it, up to the thrust.

    `friction` of `Masonry` is that of the ends and of the crack, see `HorizontalBending.friction`. The blocks are
    "ground", "left", "right", "side_0", "side_1" and four fixed guides.

    Args:
        bending: the wall, its crack and its thrust.

    Raises:
        TypeError, ValueError: as `Masonry` does.

    Examples:
        >>> strip = mr.HorizontalBending(mr.Block.from_size(0.5, 2.0, 6.0), thrust=12e3)
        >>> blocks = mr.Masonry.between_sides(strip)
        >>> round(float(mr.collapse_multiplier(blocks, effects=strip.tie).multiplier), 4)
        0.068
    """
    require_kind("bending", bending, HorizontalBending)
    t, high, half = 2 * bending.wall.b, 2 * bending.wall.h, 0.5 * bending.wall.length
    crack = bending.parts[0] - half

    def part(name: str, x: tuple[float, float], y: tuple[float, float]) -> Polyhedron:
        (back, front), (left, right) = x, y
        middle = 0.5 * (back + front), 0.5 * (left + right), 0.5 * high
        size = front - back, right - left, high
        return Polyhedron.box(size, middle, bending.wall.density, name.startswith("guide"), name)

    through, guides = (0.0, t), ((-t, 0.0), (t, 2 * t))
    blocks = [part("left", through, (-half, crack)), part("right", through, (crack, half))]
    blocks += [part("side_0", through, (-half - t, -half)), part("side_1", through, (half, half + t))]
    beyond = half + 0.5 * t, half + 2.5 * t
    directions = [(x, (-beyond[1], -beyond[0])) for x in guides] + [(x, beyond) for x in guides]
    blocks += [part(f"guide_{i}", x, y) for i, (x, y) in enumerate(directions)]
    return [ground_below((-t, -beyond[1], 0.0), (2 * t, beyond[1], high)), *blocks]


def wallette_of(blocks: Sequence[Polygon], unit: float, leaves: int, headers: int) -> list[Polyhedron]:
    """Rectangles of a wall of the plane, its base and beam, as boxes in space, see `wallette`."""
    middle = 0.5 * float(blocks[0].corners[:, 0].min() + blocks[0].corners[:, 0].max())
    boxes: list[tuple[Polygon, str, tuple[float, float, float], tuple[float, float, float]]] = []
    for block in blocks:
        (left, low), (right, high) = block.corners.min(axis=0).tolist(), block.corners.max(axis=0).tolist()
        name, thick = str(block.name), block.length
        deep, count, names = [(0.0, thick)], 1, [name]
        if block.fixed:
            deep = [(-thick, 2 * thick)]
        elif headers and (int(name.split("_")[1]) + 1) % headers == 0:
            count = max(1, round(2 * (right - left) / unit))
            names = [f"{name}{'abcdefgh'[i]}" for i in range(count)] if count > 1 else names
        elif leaves > 1:
            faces = np.linspace(0.0, thick, leaves + 1).tolist()
            deep, names = list(pairwise(faces)), [f"{name}_{i}" for i in range(leaves)]
        along = list(pairwise(np.linspace(left, right, count + 1).tolist()))
        spans = [(x, y) for x in deep for y in along]
        for part, ((front, back), (a, b)) in zip(names, spans, strict=True):
            size = back - front, b - a, high - low
            centre = -0.5 * (front + back), 0.5 * (a + b) - middle, 0.5 * (low + high)
            boxes.append((block, part, size, centre))
    if len(boxes) > MOST_BODIES:
        request = f"leaves = {leaves} and headers = {headers} make a wall of {len(boxes)} blocks"
        raise ValueError(f"{request}; the valid range ends at {MOST_BODIES}")
    return [Polyhedron.box(size, centre, block.density, block.fixed, part) for block, part, size, centre in boxes]


@within_ranges
def wallette(
    length: Size,
    height: Size,
    unit: Unit,
    thickness: Length,
    density: Density = 2000.0,
    *,
    leaves: Annotated[int, Within(1, 10, whole=True)] = 1,
    headers: Annotated[int, Within(0, 1000, whole=True)] = 0,
    beam: bool = True,
    halves: Bond | None = None,
) -> list[Polyhedron]:
    """A wall in running bond in space on a fixed base, as laboratories load it out of its plane.

    Its length runs along y, and its outer face is x = 0, as that of a facade.

    The blocks are "base", the units as of `running_bond` with the number of the leaf or a letter of the header,
    and "beam".

    Args:
        length, height, unit, thickness, density, halves: as of `running_bond`; units of several leaves are whole.
        leaves: wythes beside each other through the thickness, 1 to 10. The joints between them have the normal x,
            so that a function of the joint gives them a bond of their own.
        headers: courses from one course of headers to the next, 0 to 1000, 0 for none. Headers are half a unit long
            and go through all leaves.
        beam: whether a fixed beam lies on it, which the case leads by `supports={"beam": (t, dx, dy, dz)}`.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> wall = mr.Masonry.wallette(0.8, 0.4, (0.2, 0.1), 0.2, leaves=2, headers=4)
        >>> wall.names[1], wall.names[-2], len(wall.free)
        ('unit_0_0_0', 'unit_3_4', 34)
    """
    if halves is not None and (leaves, headers) != (1, 0):
        raise ValueError(f"halves with leaves = {leaves} and headers = {headers}: units of several leaves are whole")
    flat = shear_wall(length, height, unit, thickness, density, halves=halves)
    return wallette_of(flat if require_flag("beam", beam) else flat[:-1], unit[0], leaves, headers)
