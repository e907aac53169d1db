"""Blocks of masonry that spans: arches on piers or abutments, one or several, and barrels, alone or crossing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....quantities import Array, require_flag, require_within
from ..blocks.compound import Compound, SolidBlock
from ..blocks.polygon import Polygon
from ..blocks.polyhedron import Polyhedron
from .in_plane import LEAST_RADIUS, MOST_BODIES, Taper, arch_of, ground_under, rings_of
from .in_space import JUST_LESS


class Span(NamedTuple):
    """An arch: radius of its middle and thickness [m], angle between its springings [rad], and how many voussoirs."""

    radius: float
    thickness: Taper
    angle: float
    voussoirs: int

    @property
    def springing(self) -> Array:
        """Inner and outer corner of the right springing, from the centre [m], shape (2, 2)."""
        half, faces = 0.5 * self.angle, rings_of(self.radius, self.thickness, LEAST_RADIUS, np.zeros(1))
        return np.outer(np.concatenate(faces), [math.sin(half), math.cos(half)])


def bridge_of(
    spans: int, arch: Span, pier: tuple[float, float], abutments: bool, density: float, length: float
) -> list[Polygon]:
    """The ground, and arches on piers of a width and a height up to the springings [m], see `Masonry.bridge`."""
    ends = require_flag("abutments", abutments)
    blocks = arch_of(*arch, density, length)
    if spans * len(blocks) >= MOST_BODIES:
        raise ValueError(f"spans = {spans} of {arch.voussoirs} voussoirs are more blocks than {MOST_BODIES}")
    springing, outer = arch.springing
    skew = outer - springing
    wide = require_within("pier_width", pier[0], skew[0] * (1 if spans == 1 else 2), 1e3, "m")
    high = pier[1]
    apart, level, top = 2 * springing[0] + wide, high - springing[1], high + skew[1]
    polygons = []
    for i in range(spans):
        begin, end = 0 if ends and i == 0 else 1, None if ends and i == spans - 1 else -1
        for block in blocks[begin:end]:
            name = block.name if spans == 1 or block.fixed else f"span_{i}_{block.name}"
            moved = np.add(block.corners, (i * apart, level))
            polygons.append(Polygon(moved, density, length, block.fixed, name))
    for i in range(ends, spans + 1 - ends):
        right = i * apart - springing[0]
        left = right - wide
        beside = [(right, high), (right - skew[0], top)] if i < spans else [(right, top)]
        before = [(left + skew[0], top), (left, high)] if i > 0 else [(left, top)]
        corners = [(left, 0.0), (right, 0.0), *beside, *before]
        corners = [at for k, at in enumerate(corners) if not np.allclose(at, corners[k - 1], atol=1e-12 * high)]
        polygons.append(Polygon(corners, density, length, name=f"pier_{i}"))
    if ends and spans == 1:
        return polygons
    places = np.concatenate([polygon.corners for polygon in polygons if not polygon.fixed])
    (left, _), (right, height) = places.min(axis=0), places.max(axis=0)
    return [ground_under(left, right, height, length), *polygons]


def barrel_of(arch: Span, length: float, unit: float, density: float) -> list[Polyhedron]:
    """Courses of voussoirs in running bond between two abutments, see `Masonry.barrel_vault`."""
    unit = require_within("unit", unit, 1e-2, length, "m")
    left, *courses, right = arch_of(*arch, density, 1.0)
    whole = round(length / unit)
    if len(courses) * (whole + 1) >= MOST_BODIES:
        raise ValueError(f"unit = {unit:g} m makes a vault of more blocks than {MOST_BODIES}")
    fitted = length / whole
    blocks = [_laid(left, (0.0, length), left.name)]
    for i, course in enumerate(courses):
        heads = fitted * (np.arange(1, whole) if i % 2 == 0 else np.arange(whole) + 0.5)
        for j, ends in enumerate(pairwise([0.0, *heads.tolist(), length])):
            blocks.append(_laid(course, ends, f"{course.name}_{j}"))
    return [*blocks, _laid(right, (0.0, length), right.name)]


SIDES = ("right", "back", "left", "front")
"""The sides of a bay, each a quarter of a turn from x towards y after the one before."""
QUARTER_TURN = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""What turns rows of x, y, z by that."""
SHORTEST_ARM = 0.25
"""How far a stone of the groin reaches along the web at least, over the length of a unit [-]."""


def groin_of(arch: Span, length: float, unit: float, cut: bool, density: float) -> list[SolidBlock]:
    """Two barrels that cross over a square bay, on four fixed piers, see `Masonry.groin_vault`.

    The four webs are one web, turned. It has its axis along y, lies where y >= |x|, and ends at the side of the bay.
    """
    _, *courses, _ = arch_of(*arch, density, 1.0)
    (x, z), (reach, top) = arch.springing.tolist()
    pier = np.array([(x, z), (reach, top), (reach, z - (reach - x)), (x, z - (reach - x))])
    strips = [Polygon(pier * (-1, 1), density), *courses, Polygon(pier, density)]
    length = require_within("length", length, 2 * reach * JUST_LESS, 1e3, "m")
    unit, cut = require_within("unit", unit, 1e-2, length, "m"), require_flag("cut", cut)
    if 4 * len(strips) * (0.5 * length / unit + 1) >= MOST_BODIES:
        raise ValueError(f"unit = {unit:g} m makes a vault of more blocks than {MOST_BODIES}")
    webs: list[SolidBlock] = []
    stones: dict[str, list[Polyhedron]] = {}
    for i, strip in enumerate(strips):
        level, last = min(i, len(strips) - 1 - i), len(strips) - 1
        near = float(np.abs(strip.corners[:, 0]).max()) + SHORTEST_ARM * unit
        heads = np.arange(0.5 * length - (1.0 if level % 2 else 0.5) * unit, near, -unit).tolist() if level else []
        *units, arm = pairwise([0.5 * length, *heads, 0.0])
        for k, side in enumerate(SIDES):
            corner = "_".join(sorted((side, SIDES[(k + 1) % 4] if 2 * i < last else SIDES[k - 1])))
            name = "keystone" if 2 * i == last else f"groin_{corner}_{level - 1}" if level else f"pier_{corner}"
            stones.setdefault(name, []).append(_of_web(strip, arm, k, f"{name}_{side}", crown=2 * i == last))
            webs += [_of_web(strip, ends, k, f"web_{side}_{i - 1}_{j}") for j, ends in enumerate(units)]
    groins: list[SolidBlock] = []
    for name, parts in stones.items():
        fixed = name.startswith("pier")
        groins += parts if cut and not fixed else [Compound(parts, fixed, name)]
    return [*groins, *webs]


def _of_web(polygon: Polygon, ends: tuple[float, float], turns: int, name: str, crown: bool = False) -> Polyhedron:
    """What a course of a web has between two distances y from the middle of the bay, the farther one first [m].

    The course ends at the groins, where y = |x|, which meet above the middle in the course at the crown.
    """
    (far, near), (x, z) = ends, polygon.corners.T
    if crown:
        x, z = np.append(x, [0.0, 0.0]), np.append(z, [z.min(), z.max()])
    inner = np.maximum(np.abs(x), near)
    beyond = far - inner > 1e-6 * far
    inside, outside = np.column_stack([x, inner, z]), np.column_stack([x, np.full_like(x, far), z])[beyond]
    vertices = np.vstack([inside, outside]) @ np.linalg.matrix_power(QUARTER_TURN, turns)
    return Polyhedron(vertices, polygon.density, name=name)


def _laid(polygon: Polygon, ends: Sequence[float], name: str | None) -> Polyhedron:
    """A block of the plane between two y [m]."""
    return Polyhedron.prism(replace(polygon, length=ends[1] - ends[0], name=name), 0.5 * (ends[0] + ends[1]))
