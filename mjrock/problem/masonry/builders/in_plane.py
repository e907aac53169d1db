"""Builders of blocks in the plane: a stack, an arch, walls in running bond, and a wall between floors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, NamedTuple

import numpy as np

from ....quantities import (
    Array,
    Density,
    P,
    Result,
    Within,
    require_flag,
    require_kind,
    require_sequence,
    require_whole,
    require_within,
    shown,
    within_ranges,
)
from ...wall.bending import Bearing, CrackHeight, FloorLoad, VerticalBending
from ...wall.block import Block
from ...wall.effects import SideStop
from ..blocks.compound import Compound, FlatBlock
from ..blocks.polygon import Polygon
from ..laws.bond import Bond

__all__ = ["arch", "between_floors", "running_bond", "shear_wall", "stack"]

Taper = float | tuple[float, float]
"""A measure [m], or a pair: what it is at one end and at the other, between which it changes linearly."""
Radius = Annotated[float, Within(0.01, 1000, "m")]
Thick = Annotated[Taper, Within(1e-5, 1000, "m")]
SpanAngle = Annotated[float, Within(0.1, math.pi, "rad")]
Voussoirs = Annotated[int, Within(1, 1000, whole=True)]
Length = Annotated[float, Within(1e-3, 1000, "m")]
Size = Annotated[float, Within(0.01, 1000, "m")]
Side = Annotated[float, Within(0.01, 100, "m")]
Unit = tuple[Side, Side]
"""Sizes that builders share."""

GROUND_DEPTH = 0.25
"""Depth of the ground, over the width of what stands on it [-]."""
GROUND_BEYOND = 2.0
"""How far the ground reaches beyond what stands on it, over the height of that [-]: what falls over lies on it."""
THINNEST_GROUND = 1e-3
"""Depth of the ground, over its own width, at least [-]: what stands on it may be ever so slender."""
SMALLEST_PIECE = 0.1
"""Length of the shortest piece of a unit at the end of a course, over the length of the unit [-]."""
DEEP_BEAM, BEYOND_BEAM = 0.2, 0.2
"""Depth of a loading beam, and how far it reaches beyond the wall at either end, over the length of the wall [-]."""
MOST_BODIES = 25_000
"""Most blocks of masonry. What memory they need is known when their joints are, see `scene.masonry.require_memory`."""


def rectangle(
    x: tuple[float, float], z: tuple[float, float], density: float, length: float, fixed: bool, name: str
) -> Polygon:
    """A rectangular block between two x and two z [m]."""
    (left, right), (low, high) = x, z
    corners = [(left, low), (right, low), (right, high), (left, high)]
    return Polygon(corners, density=density, length=length, fixed=fixed, name=name)


def ground_under(left: float, right: float, height: float, length: float, level: float = 0.0) -> Polygon:
    """Fixed ground with its surface at a level [m], under what stands on it between two x, of a height [m]."""
    wide = right - left
    beyond, deep = extent_of_ground(wide, height)
    return rectangle((left - beyond, right + beyond), (level - deep, level), 2000.0, length, True, "ground")


def extent_of_ground(wide: float, height: float) -> tuple[float, float]:
    """How far ground reaches beyond what stands on it, of a width and a height [m], and how deep it is [m]."""
    beyond = max(GROUND_BEYOND * height, 0.5 * wide)
    return beyond, max(GROUND_DEPTH * wide, THINNEST_GROUND * (wide + 2 * beyond))


def ground_below_all(blocks: Sequence[FlatBlock]) -> Polygon:
    """Fixed ground with its surface at the lowest point of some blocks, see `ground_under`."""
    corners = np.concatenate([block.corners for block in blocks])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    return ground_under(left, right, high - low, max(block.length for block in blocks), low)


def friction_of(**words: float) -> Callable[[Callable[P, Result]], Callable[P, Result]]:
    """Mark a builder: in `Masonry`, joints whose name has one of these words have its coefficient of friction [-]."""

    def marked(builder: Callable[P, Result]) -> Callable[P, Result]:
        builder.friction = words  # type: ignore[attr-defined]
        return builder

    return marked


def stack(blocks: Sequence[Block], ground: bool = True, side_stop: bool | SideStop = False) -> list[FlatBlock]:
    """Blocks one on the other, their bases centred on x = 0, from the lowest upwards. One with a profile is a
    `Compound`.

    A `Block` is at least as high as it is thick. Flatter ones are drawn as polygons.

    Args:
        blocks: the blocks, whose insets are zero.
        ground: whether fixed ground is put under them. Otherwise the lowest block is fixed.
        side_stop: True for a side stop over the whole inner face, which is the left one, or the `SideStop` that
            reaches only so high. It is a fixed block of the name `side`, the last of the blocks, and has a joint
            with each face that it lies behind, at whose ends they meet. It follows setbacks, as side walls do,
            clear of the ledge as that rises, and does not reach under a block that stands out farther than those
            below it.

    Raises:
        TypeError, ValueError: for a value outside its range.
    """
    require_flag("ground", ground)
    require_sequence("blocks", blocks, "a list of blocks")
    if not blocks:
        raise TypeError(f"blocks = {shown(blocks)} is not a list of blocks")
    polygons, z = list[FlatBlock](), 0.0
    for i, block in enumerate(blocks):
        require_kind(f"blocks[{i}]", block, Block)
        if block.inset:
            raise ValueError(
                f"blocks[{i}]: inset = {block.inset:g} m; a block of a stack has its edges at its faces: give Masonry "
                "a Polygon with its corners cut off"
            )
        fixed = i == 0 and not ground
        polygons.append(_standing_block(block, (0.0, z), fixed, f"block_{i}"))
        if not math.isclose(polygons[-1].mass, block.mass, rel_tol=1e-9):
            raise ValueError(
                f"blocks[{i}] has openings, a gable or masses, and a block of a stack has one length: cut it at sills "
                "and heads into blocks of the length that is left there, as Polygon where one is flatter than thick; "
                "or take the Block in a Case, which has them all"
            )
        z += 2 * block.h
    if ground:
        b, length = max(block.b for block in blocks), max(block.length for block in blocks)
        polygons.insert(0, ground_under(-b, b, z, length))
    side = side_of(polygons, side_stop)
    return polygons if side is None else [*polygons, side]


def _standing_block(
    block: Block, at: tuple[float, float], fixed: bool, name: str, between: tuple[float, float] = (0.0, math.inf)
) -> FlatBlock:
    """A block, or its part between two heights, the middle of whose base is at x and z [m]: a polygon, or one for each
    slab of its profile."""
    parts, (x, z) = [], at
    for (low, high), thickness in block.section.slabs(between):
        if between[0] <= low < high <= between[1]:
            inner, outer = (x + face for face in block.section.x_of_faces(thickness))
            corners = [(inner[0], z + low), (outer[0], z + low), (outer[1], z + high), (inner[1], z + high)]
            parts.append(Polygon(corners, block.density, block.length))
    return Compound(parts, fixed, name) if len(parts) > 1 else replace(parts[0], fixed=fixed, name=name)


class InnerFace(NamedTuple):
    """A piece of the inner face of a stack: x and z of its lower and upper end [m], and how far its upper end rises as
    its block turns about its outer edge [m]."""

    x: tuple[float, float]
    z: tuple[float, float]
    rise: float


def side_of(blocks: Sequence[FlatBlock], side_stop: bool | SideStop) -> FlatBlock | None:
    """The fixed block behind the inner face of a stack, from z = 0 up to its top or to that of the stop; or None.

    Raises:
        ValueError: if the stop ends above the stack.
    """
    require_kind("side_stop", side_stop, bool, SideStop)
    if not side_stop:
        return None
    standing = [block for block in blocks if block.name != "ground"]
    back = 2 * min(float(block.corners[:, 0].min()) for block in standing)
    height = max(float(block.corners[:, 1].max()) for block in blocks)
    top = height
    if isinstance(side_stop, SideStop):
        top = require_within("top of the side stop", side_stop.top, 0.01, height, "m")
    length = max(block.length for block in blocks)
    parts = [
        Polygon([(back, low), (x, low), (x_high, high), (back, high)], 2000.0, length)
        for (x, x_high), (low, high) in _stop_ends([piece for block in standing for piece in _inner_faces(block)], top)
    ]
    return Compound(parts, True, "side") if parts[1:] else replace(parts[0], fixed=True, name="side")


def _inner_faces(block: FlatBlock) -> list[InnerFace]:
    """The inner face of a block of a stack, from below: of each part of it its left edge."""
    low, edge, pieces = float(block.corners[:, 1].min()), float(block.corners[:, 0].max()), list[InnerFace]()
    for part in block.parts:
        ends = [part.corners[part.corners[:, 1] == z] for z in (part.corners[:, 1].min(), part.corners[:, 1].max())]
        (x, z), (x_high, high) = (tuple(end[end[:, 0].argmin()].tolist()) for end in ends)
        pieces.append(InnerFace((x, x_high), (z, high), math.hypot(edge - x_high, high - low) - (high - low)))
    return sorted(pieces, key=lambda piece: piece.z)


def _stop_ends(pieces: Sequence[InnerFace], top: float) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """x and z of both ends of each piece of a side stop up to a height [m], see `stack`."""
    inmost, faces = math.inf, list[InnerFace]()
    for piece in reversed(pieces):
        x_high = min(inmost, piece.x[1])
        inmost = min(x_high, piece.x[0])
        faces.insert(0, piece._replace(x=(inmost, x_high)))
    parts = list[tuple[tuple[float, float], tuple[float, float]]]()
    for before, piece in pairwise([faces[0], *faces]):
        (x, x_high), (low, high) = piece.x, piece.z
        if low >= top:
            break
        if high > top:
            x_high, high = x + (x_high - x) * (top - low) / (high - low), top
        if parts and x > before.x[1]:  # above a ledge
            low = min(low + before.rise, high)
            parts[-1] = (parts[-1][0], (parts[-1][1][0], low))
        if parts and parts[-1][0] == (x, x) == (x, x_high):
            parts[-1] = ((x, x), (parts[-1][1][0], high))
        elif high > low:
            parts.append(((x, x_high), (low, high)))
    return parts


def required_unit(unit: object) -> tuple[float, float]:
    """Length and height of a unit [m].

    Raises:
        TypeError, ValueError: for any other.
    """
    if not isinstance(unit, tuple | list) or len(unit) != 2:
        raise TypeError(f"unit = {shown(unit)} is not the length and the height of a unit")
    long = require_within("unit length", unit[0], 1e-2, 100.0, "m")
    return long, require_within("unit height", unit[1], 1e-2, 100.0, "m")


def required_ends(name: str, measure: Taper, low: float, high: float) -> tuple[float, float]:
    """A measure at both ends [m].

    Raises:
        TypeError, ValueError: for any other.
    """
    if not isinstance(measure, tuple | list):
        measure = (measure, measure)
    if len(measure) != 2:
        raise ValueError(f"{name} = {shown(measure)} is neither a number nor a pair, one for each end")
    return require_within(name, measure[0], low, high, "m"), require_within(name, measure[1], low, high, "m")


def rings_of(radius: float, thickness: Taper, share: Array) -> tuple[Array, Array]:
    """Radii of the inner and the outer face of an arch or a dome at its joints [m], from that of the middle.

    Args:
        radius: of the middle [m].
        thickness: at the springing and at the crown [m].
        share: where the joints are, from 0 at the springing to 1 at the crown [-].
    """
    springing, crown = required_ends("thickness", thickness, 1e-3 * radius, radius)
    half = 0.5 * (springing + (crown - springing) * share)
    return radius - half, radius + half


def voussoirs_of(
    radius: float, thickness: Taper, span_angle: float, voussoirs: int, density: float, length: float
) -> list[Polygon]:
    """Voussoirs of equal angles between two fixed abutments, from left to right, see `arch`."""
    along = np.arange(voussoirs + 1) / voussoirs
    inner, outer = rings_of(radius, thickness, 1 - np.abs(1 - 2 * along))
    angles = 0.5 * math.pi + span_angle * (0.5 - along)
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    intrados, extrados = inner[:, None] * directions, outer[:, None] * directions
    polygons = [
        Polygon(
            [extrados[i], extrados[i + 1], intrados[i + 1], intrados[i]],
            density=density,
            length=length,
            name=f"voussoir_{i}",
        )
        for i in range(voussoirs)
    ]
    for name, i, side in (("left_abutment", 0, -1.0), ("right_abutment", voussoirs, 1.0)):
        at = directions[i]
        down = (outer[i] - inner[i]) * side * np.array([at[1], -at[0]])  # along the axis of the arch, away from it
        corners = [intrados[i], extrados[i], extrados[i] + down, intrados[i] + down]
        polygons.append(Polygon(corners, density=density, length=length, fixed=True, name=name))
    return [polygons[-2], *polygons[:-2], polygons[-1]]


def curved(arch: Sequence[Polygon], chords: int) -> list[FlatBlock]:
    """An arch in which a number of successive voussoirs are one each, see `arch`."""
    if chords == 1:
        return list(arch)
    left, *pieces, right = arch
    starts = range(0, len(pieces), chords)
    joined = [Compound(pieces[k : k + chords], name=f"voussoir_{i}") for i, k in enumerate(starts)]
    return [left, *joined, right]


@within_ranges
def arch(
    radius: Radius,
    thickness: Thick,
    span_angle: SpanAngle = math.pi,
    voussoirs: Voussoirs = 17,
    *,
    density: Density = 2000.0,
    length: Length = 1.0,
    chords: Annotated[int, Within(1, 50, whole=True)] = 1,
    ground: bool = False,
) -> list[FlatBlock]:
    """A circular arch of voussoirs of equal angles, between two fixed abutments.

    Edges are straight: halfway between joints that are delta apart [rad], an arch of one thickness is
    cos(delta / 2) times as thick as at the joints.

    Args:
        radius: of the middle of the arch at the joints [m], 0.01 to 1000.
        thickness: across the arch at the joints [m], 1e-5 to 1000, 0.001 to 1 times the radius; or a pair, at the
            springing and at the crown, between which it changes linearly with the angle.
        span_angle: angle between the two springings [rad], 0.1 to pi.
        voussoirs: how many, 1 to 1000. They are named `voussoir_0` and so on, from left to right.
        density: mass density [kg/m3], 100 to 30000.
        length: length out of the plane [m], 1e-3 to 1000.
        chords: straight edges of the intrados and of the extrados of a voussoir, 1 to 50. With two or more a
            voussoir is a `Compound`. Voussoirs times chords are at most 1000.
        ground: whether fixed ground lies under the lowest point of the abutments, two heights beyond them. Without
            it voussoirs that leave the arch fall on, and explicit steps name them.

    Raises:
        TypeError, ValueError: for a value outside its range.

    Examples:
        >>> arch = mr.Masonry.arch(radius=5.0, thickness=(0.9, 0.6), voussoirs=16)
        >>> sorted(round(joint.width, 2) for joint in arch.joints)[::8]
        [0.6, 0.75, 0.9]
    """
    count = require_whole("voussoirs", voussoirs, 1, 1000 // chords)
    blocks = curved(voussoirs_of(radius, thickness, span_angle, count * chords, density, length), chords)
    return [*blocks, ground_below_all(blocks)] if require_flag("ground", ground) else blocks


@within_ranges
def running_bond(
    length: Size,
    height: Size,
    unit: Unit,
    thickness: Length = 1.0,
    density: Density = 2000.0,
    *,
    halves: Bond | None = None,
) -> list[Polygon]:
    """A wall of units in running bond on the ground, which moves in the plane of its face.

    Args:
        length, height: of the wall [m], 0.01 to 1000. The height is a whole number of units. What is left of a
            course at its end is a piece of a unit.
        unit: length and height of a unit [m], 0.01 to 100.
        thickness: of the wall, out of the plane [m], 1e-3 to 1000.
        density: mass density [kg/m3], 100 to 30000.
        halves: the bond of a potential crack in the middle of each whole unit, which divides it in two, or None.
            The halves of `unit_2_0` are `unit_2_0a` and `unit_2_0b`, by which functions of the joint know them.

    Raises:
        ValueError: for a value outside its range.
    """
    require_kind("halves", halves, Bond, type(None))
    long, high = required_unit(unit)
    length = require_within("wall length", length, long, 1e3, "m")
    height = require_within("wall height", height, high, 1e3, "m")
    halved = halves is not None
    courses = round(height / high)
    if not math.isclose(courses * high, height, rel_tol=1e-6):
        raise ValueError(f"wall height = {height:g} m is not a whole number of units of {high:g} m")
    count = courses * length / long * (2 if halved else 1)
    if count + courses > MOST_BODIES:
        raise ValueError(
            f"length = {length:g} m makes a wall of {count:.3g} units; the valid range ends at {MOST_BODIES}"
        )
    polygons = [ground_under(0.0, length, height, thickness)]
    for course in range(courses):
        shift = 0.5 * long if course % 2 else long
        inner = shift + long * np.arange(math.ceil(length / long))
        ends = [0.0, *(x for x in inner.tolist() if x < length - SMALLEST_PIECE * long), length]
        for i, (left, right) in enumerate(pairwise(ends)):
            name = f"unit_{course}_{i}"
            level = course * high, (course + 1) * high
            parts = {name: (left, right)}
            if halved and math.isclose(right - left, long):
                middle = 0.5 * (left + right)
                parts = {f"{name}a": (left, middle), f"{name}b": (middle, right)}
            polygons += [rectangle(ends, level, density, thickness, False, part) for part, ends in parts.items()]
    return polygons


def between_beams(units: Sequence[Polygon]) -> list[Polygon]:
    """Units of a wall between a base and a beam, both fixed, see `shear_wall`."""
    corners = np.concatenate([unit.corners for unit in units])
    (left, low), (right, high) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    deep, beyond, thickness = DEEP_BEAM * (right - left), BEYOND_BEAM * (right - left), units[0].length
    ends = left - beyond, right + beyond
    base = rectangle(ends, (low - deep, low), 2000.0, thickness, True, "base")
    beam = rectangle(ends, (high, high + deep), 2000.0, thickness, True, "beam")
    return [base, *units, beam]


@within_ranges
def shear_wall(
    length: Size,
    height: Size,
    unit: Unit,
    thickness: Length = 1.0,
    density: Density = 2000.0,
    *,
    halves: Bond | None = None,
) -> list[Polygon]:
    """A wall in running bond between a fixed base and a loading beam, as laboratories press and shear it.

    The blocks are "base", the units as of `running_bond`, and "beam". Base and beam are fixed and reach a fifth of
    the length beyond the wall. The case leads the beam by `supports={"beam": (t, dx, dz)}`; it does not turn: dz
    presses the wall and dx shears it.

    Args:
        length, height, unit, thickness, density, halves: as of `running_bond`.

    Raises:
        ValueError: for a value outside its range.

    Examples:
        >>> wall = mr.Masonry.shear_wall(0.8, 0.4, (0.2, 0.1), thickness=0.1)
        >>> wall.names[0], wall.names[-1], len(wall.free)
        ('base', 'beam', 18)
    """
    return between_beams(running_bond(length, height, unit, thickness, density, halves=halves)[1:])


@friction_of(guide=0.0, floor=10.0)
@within_ranges
def between_floors(
    wall: Block, load: FloorLoad, *, bearing: Bearing = None, crack: CrackHeight = None
) -> list[FlatBlock]:
    """A wall that cracks between two floors, which hold it sideways, seen along its length.

    The inner face at the base is x = 0. The upper floor is a block with the mass of the load between two smooth
    guides, so that it may rise and not turn. It is anchored to the wall: its joint has a friction of 10, the
    largest there is.

    `friction` of `Masonry` is that of the base and the crack. The blocks are "base", "lower", "upper", "floor",
    "inner_guide" and "outer_guide". All but the two of the wall and the floor are fixed.

    Args:
        wall, load, bearing, crack: as of `VerticalBending`.

    Raises:
        TypeError, ValueError: as `VerticalBending` does.

    Examples:
        >>> strip = mr.Masonry.between_floors(mr.Block.from_size(0.3, 4.0), load=20e3)
        >>> round(float(mr.collapse_multiplier(strip).multiplier), 2)
        0.78
    """
    bending = VerticalBending(wall, load, bearing, crack)
    middle = bending.crack_height
    thickness, height, deep = 2 * wall.b, 2 * wall.h, bending.floor_depth
    left, right = bending.floor_ends
    low, top = height + 0.5 * deep, height + 1.5 * deep

    def part(name: str, sides: tuple[float, float], levels: tuple[float, float], density: float = 2000.0) -> Polygon:
        fixed = name not in ("lower", "upper", "floor")
        return rectangle(sides, levels, density, wall.length, fixed, name)

    return [
        part("base", (-2 * thickness, 3 * thickness), (-thickness, 0.0)),
        _standing_block(wall, (wall.b, 0.0), False, "lower", (0.0, middle)),
        _standing_block(wall, (wall.b, 0.0), False, "upper", (middle, height)),
        part("floor", (left, right), (height, height + deep), bending.floor_density),
        part("inner_guide", (left - thickness, left), (low, top)),
        part("outer_guide", (right, right + thickness), (low, top)),
    ]
