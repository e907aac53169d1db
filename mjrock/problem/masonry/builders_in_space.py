"""Blocks of masonry that is built often, in space: a box, a column, a dome, and a facade with return walls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...quantities import require_array, require_kind, require_real, require_whole, require_within, shown
from ..wall.section import Opening
from .builders import BEYOND, DEEP, MOST_BLOCKS, required_faces, required_unit
from .polyhedron import Polyhedron

WHOLE = 1e-6
"""How far a length may be from a whole number of units, over the unit [-]."""


def ground_below(low: ArrayLike, high: ArrayLike) -> Polyhedron:
    """Fixed ground under what stands on it between two corners x, y, z [m]."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    wide = (high - low)[:2]
    beyond, deep = np.maximum(BEYOND * (high[2] - low[2]), 0.5 * wide), DEEP * float(wide.max())
    middle = 0.5 * (low + high)[:2]
    return Polyhedron.box((*(wide + 2 * beyond), deep), (*middle, low[2] - 0.5 * deep), fixed=True, name="ground")


def whole_units(name: str, extent: float, unit: float, most: int) -> int:
    """How many units an extent has; a ValueError says unless it is a whole number of them, from 1 to `most`."""
    count = require_real(name, extent) / unit
    if not 0 < count < most + 1 or not abs(count - round(count)) <= WHOLE or not 1 <= round(count) <= most:
        raise ValueError(
            f"{name} = {extent:g} m is not a whole number of units of {unit:g} m; the valid range is 1 to {most} units"
        )
    return round(count)


def box_on_ground(size: ArrayLike, density: float) -> list[Polyhedron]:
    """The ground and a box on it, see `Masonry.box`."""
    extents = require_array("size", size, (3,))
    block = Polyhedron.box(extents, (0.0, 0.0, 0.5 * float(extents[2])), density, name="block")
    return [ground_below(block.corners.min(axis=0), block.corners.max(axis=0)), block]


def column_of(width: float, height: float, drums: int, sides: int, density: float) -> list[Polyhedron]:
    """The ground and prismatic drums on it, see `Masonry.column`."""
    width = require_within("width", width, 1e-2, 100.0, "m")
    height = require_within("height", height, 1e-2, 1e3, "m")
    drums, sides = require_whole("drums", drums, 1, 1000), require_whole("sides", sides, 3, 100)
    angles = 2 * math.pi * (np.arange(sides) + 0.5) / sides
    ring = 0.5 * width / math.cos(math.pi / sides) * np.column_stack([np.cos(angles), np.sin(angles)])
    levels = np.linspace(0.0, height, drums + 1)
    blocks = [ground_below((*ring.min(axis=0), 0.0), (*ring.max(axis=0), height))]
    for i in range(drums):
        vertices = [(x, y, z) for z in (levels[i], levels[i + 1]) for x, y in ring]
        blocks.append(Polyhedron(vertices, density, name=f"drum_{i}"))
    return blocks


def dome_of(radius: float, thickness: float, lunes: int, hoops: int, oculus: float, density: float) -> list[Polyhedron]:
    """The ground and the voussoirs of a hemisphere on it, see `Masonry.dome`."""
    inner, outer = required_faces(radius, thickness, 0.1)
    lunes, hoops = require_whole("lunes", lunes, 4, 360), require_whole("hoops", hoops, 1, 360)
    oculus = require_within("oculus", oculus, 0.01, 1.5, "rad")
    if lunes * hoops >= MOST_BLOCKS:
        raise ValueError(f"lunes = {lunes} times hoops = {hoops} is outside the valid range up to {MOST_BLOCKS}")
    polar, around = np.linspace(0.5 * math.pi, oculus, hoops + 1), 2 * math.pi * np.arange(lunes + 1) / lunes
    sines, levels = np.sin(polar), np.append(0.0, np.cos(polar[1:]))
    rays = sines[:, None, None] * np.column_stack([np.cos(around), np.sin(around)])
    directions = np.dstack([rays, np.broadcast_to(levels[:, None], rays.shape[:2])])  # (hoops + 1, lunes + 1, 3)
    directions[:, -1] = directions[:, 0]
    blocks = [ground_below((-outer, -outer, 0.0), (outer, outer, outer))]
    for j in range(hoops):
        for i in range(lunes):
            corners = directions[j : j + 2, i : i + 2].reshape(4, 3)
            name = f"voussoir_{j}_{i}"
            blocks.append(Polyhedron(np.vstack([inner * corners, outer * corners]), density, name=name))
    return blocks


def facade_of(
    length: float,
    height: float,
    depth: float,
    unit: tuple[float, float],
    openings: Sequence[tuple[float, Opening]],
    gable: int,
    density: float,
) -> list[Polyhedron]:
    """The ground, and a facade and two return walls on it, see `Masonry.facade`."""
    long, high = required_unit(unit)
    t = 0.5 * long
    units = whole_units("length", length, long, 1000)
    courses, deep = whole_units("height", height, high, 1000), whole_units("depth", depth, long, 1000)
    if units < 2:
        raise ValueError(f"length = {length:g} m is one unit; the valid range begins at 2 units")
    gable = require_whole("gable", gable, 0, units - courses % 2)
    if (courses + gable) * units + 2 * courses * deep >= MOST_BLOCKS:
        raise ValueError(f"length, height and depth need more units than {MOST_BLOCKS}; give larger units")
    holes = _holes(openings, units, courses + gable, (long, high))
    left = -0.5 * units * long

    def laid(name: str, x: tuple[float, float], cells: tuple[float, float], course: int) -> Polyhedron:
        low = np.array([x[0], left + t * cells[0], course * high])
        top = np.array([x[1], left + t * cells[1], (course + 1) * high])
        return Polyhedron(np.array(np.meshgrid(*np.stack([low, top], axis=1))).reshape(3, -1).T, density, name=name)

    blocks = [ground_below((-deep * long, left, 0.0), (0.0, -left, (courses + gable) * high))]
    for course in range(courses + gable):
        bond = course % 2
        first = bond if course < courses else course - courses + courses % 2
        for start, end in _laid_cells(first, 2 * units - first, bond, course, holes):
            blocks.append(laid(f"facade_{course}_{start}", (-t, 0.0), (start, end), course))
        if course < courses:
            joints = [0, *range(2, 2 * deep + 1, 2)] if bond else [1, *range(2, 2 * deep + 1, 2)]
            for side, cells in (("left", (0, 1)), ("right", (2 * units - 1, 2 * units))):
                for i in range(len(joints) - 1):
                    x = (-t * joints[i + 1], -t * joints[i])
                    blocks.append(laid(f"{side}_{course}_{i}", x, cells, course))
    return blocks


def _holes(
    openings: Sequence[tuple[float, Opening]], units: int, courses: int, unit: tuple[float, float]
) -> list[tuple[int, int, int, int]]:
    """First and last half unit of each opening, and first course and the one above its last, half-open ranges."""
    if not isinstance(openings, Sequence) or isinstance(openings, str):
        raise TypeError(f"openings = {shown(openings)} is not a sequence of (y, Opening)")
    t, high = 0.5 * unit[0], unit[1]
    holes: list[tuple[int, int, int, int]] = []
    for i, pair in enumerate(openings):
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise TypeError(f"openings[{i}] = {shown(pair)} is not (y, Opening)")
        y, opening = require_real(f"openings[{i}], y", pair[0]), pair[1]
        require_kind(f"openings[{i}]", opening, Opening)
        edges = [(y - 0.5 * opening.width) / t + units, (y + 0.5 * opening.width) / t + units]
        edges += [opening.sill / high, opening.head / high]
        for name, edge in zip(("left edge", "right edge", "sill", "head"), edges, strict=True):
            if not abs(edge - round(edge)) <= WHOLE:
                raise ValueError(
                    f"openings[{i}]: the {name} lies {edge:.3f} half units or courses from the corner; the valid ones "
                    f"are whole numbers, of half units of {t:g} m and of courses of {high:g} m"
                )
        hole = tuple(map(round, edges))
        if not (hole[0] >= 2 and hole[1] <= 2 * units - 2 and hole[3] < courses):
            raise ValueError(
                f"openings[{i}] leaves less than a unit beside it or no course above it; the valid range is y from "
                f"{-(units - 2) * t:g} to {(units - 2) * t:g} m and z up to {(courses - 1) * high:g} m"
            )
        for k, (a, b, c, d) in enumerate(holes):
            if hole[0] - 1 < b + 1 and a - 1 < hole[1] + 1 and hole[2] < d + 1 and c < hole[3] + 1:
                raise ValueError(f"openings[{i}] and openings[{k}], or the lintels over them, overlap")
        holes.append(hole)  # type: ignore[arg-type]
    return holes


def _laid_cells(
    first: int, last: int, bond: int, course: int, holes: Sequence[tuple[int, int, int, int]]
) -> list[tuple[int, int]]:
    """Blocks of a course of a facade, from half unit to half unit: units, pieces beside openings, and lintels."""
    owner: dict[int, Any] = {cell: (cell - bond) // 2 for cell in range(first, last)}
    for i, (start, end, sill, head) in enumerate(holes):
        if sill <= course <= head and not (first < start and end < last):
            raise ValueError(f"openings[{i}] or its lintel does not lie within the gable; the valid range is within it")
        if sill <= course < head:
            for cell in range(start, end):
                del owner[cell]
        elif course == head:
            owner |= dict.fromkeys(range(start - 1, end + 1), ("lintel", i))
    cells = sorted(owner)
    starts = [cell for cell in cells if owner.get(cell - 1) != owner[cell]]
    ends = [cell + 1 for cell in cells if owner.get(cell + 1) != owner[cell]]
    return list(zip(starts, ends, strict=True))
