"""Builders of blocks that span: arches on piers or abutments, and barrel and groin vaults."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Annotated

import numpy as np

from ....quantities import Array, Density, Within, require_flag, require_within, within_ranges
from ..blocks.compound import Compound, SolidBlock
from ..blocks.polygon import Polygon
from ..blocks.polyhedron import Polyhedron
from .in_plane import (
    MOST_BODIES,
    Length,
    Radius,
    Size,
    SpanAngle,
    Taper,
    Thick,
    Voussoirs,
    ground_under,
    rings_of,
    voussoirs_of,
)
from .in_space import BELOW_BY_ROUNDING

__all__ = ["barrel_vault", "bridge", "groin_vault"]


def springing_of(radius: float, thickness: Taper, span_angle: float) -> Array:
    """Inner and outer corner of the right springing of an arch, from the centre [m], shape (2, 2)."""
    half, faces = 0.5 * span_angle, rings_of(radius, thickness, np.zeros(1))
    return np.outer(np.concatenate(faces), [math.sin(half), math.cos(half)])


@within_ranges
def bridge(
    radius: Radius,
    thickness: Thick,
    span_angle: SpanAngle = math.pi,
    voussoirs: Voussoirs = 17,
    *,
    spans: Annotated[int, Within(1, 50, whole=True)] = 1,
    pier_width: Size,
    pier_height: Annotated[float, Within(0.01, 1000, "m")],
    abutments: bool = True,
    density: Density = 2000.0,
    length: Length = 1.0,
) -> list[Polygon]:
    """Equal arches side by side on piers: a bridge of several spans, or an arch on buttresses.

    Args:
        radius, thickness, span_angle, voussoirs: of each arch, as of `arch`.
        spans: how many arches, 1 to 50. Voussoirs are `span_0_voussoir_0` and so on, of one span `voussoir_0`.
        pier_width: between the springings of two arches [m], 0.01 to 1000, at least twice the width of a springing,
            once of one span. A pier is one block, `pier_1` that between the first two arches.
        pier_height: from the ground up to the springings [m], 0.01 to 1000.
        abutments: whether the outer arches end on fixed abutments; otherwise on piers of the same width.
        density: mass density [kg/m3], 100 to 30000.
        length: length out of the plane [m], 1e-3 to 1000.

    Raises:
        ValueError: for a value outside its range.
    """
    ends = require_flag("abutments", abutments)
    blocks = voussoirs_of(radius, thickness, span_angle, voussoirs, density, length)
    if spans * len(blocks) >= MOST_BODIES:
        raise ValueError(f"spans = {spans} of {voussoirs} voussoirs are more blocks than {MOST_BODIES}")
    springing, outer = springing_of(radius, thickness, span_angle)
    skew = outer - springing
    wide = require_within("pier_width", pier_width, skew[0] * (1 if spans == 1 else 2), 1e3, "m")
    spacing, level, top = 2 * springing[0] + wide, pier_height - springing[1], pier_height + skew[1]
    polygons = []
    for i in range(spans):
        begin, end = 0 if ends and i == 0 else 1, None if ends and i == spans - 1 else -1
        for block in blocks[begin:end]:
            name = block.name if spans == 1 or block.fixed else f"span_{i}_{block.name}"
            moved = np.add(block.corners, (i * spacing, level))
            polygons.append(Polygon(moved, density, length, block.fixed, name))
    for i in range(ends, spans + 1 - ends):
        right = i * spacing - springing[0]
        left = right - wide
        beside = [(right, pier_height), (right - skew[0], top)] if i < spans else [(right, top)]
        before = [(left + skew[0], top), (left, pier_height)] if i > 0 else [(left, top)]
        corners = [(left, 0.0), (right, 0.0), *beside, *before]
        corners = [at for k, at in enumerate(corners) if not np.allclose(at, corners[k - 1], atol=1e-12 * pier_height)]
        polygons.append(Polygon(corners, density, length, name=f"pier_{i}"))
    if ends and spans == 1:
        return polygons
    places = np.concatenate([polygon.corners for polygon in polygons if not polygon.fixed])
    (left, _), (right, height) = places.min(axis=0), places.max(axis=0)
    return [ground_under(left, right, height, length), *polygons]


@within_ranges
def barrel_vault(
    radius: Radius,
    thickness: Thick,
    length: Annotated[float, Within(0.01, 1000, "m")],
    unit: Size,
    span_angle: SpanAngle = math.pi,
    courses: Annotated[int, Within(1, 1000, whole=True)] = 17,
    *,
    density: Density = 2000.0,
) -> list[Polyhedron]:
    """A barrel vault in space between two fixed abutments, its courses in running bond along y.

    Args:
        radius, thickness, span_angle: of its section, as of `arch`.
        length: along y [m], 0.01 to 1000.
        unit: length of a voussoir [m], 0.01 to 1000 and at most the length; units are made to fit.
        courses: voussoirs of the section, 1 to 1000. `voussoir_2_0` is the first of the third course.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range.
    """
    unit = require_within("unit", unit, 1e-2, length, "m")
    left, *strips, right = voussoirs_of(radius, thickness, span_angle, courses, density, 1.0)
    units = round(length / unit)
    if len(strips) * (units + 1) >= MOST_BODIES:
        raise ValueError(f"unit = {unit:g} m makes a vault of more blocks than {MOST_BODIES}")
    fitted = length / units
    blocks = [_laid(left, (0.0, length), left.name)]
    for i, course in enumerate(strips):
        heads = fitted * (np.arange(1, units) if i % 2 == 0 else np.arange(units) + 0.5)
        for j, ends in enumerate(pairwise([0.0, *heads.tolist(), length])):
            blocks.append(_laid(course, ends, f"{course.name}_{j}"))
    return [*blocks, _laid(right, (0.0, length), right.name)]


SIDES = ("right", "back", "left", "front")
"""The sides of a bay, each a quarter of a turn from x towards y after the one before."""
QUARTER_TURN = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""What turns rows of x, y, z by that."""
SHORTEST_ARM = 0.25
"""How far a stone of the groin reaches along the web at least, over the length of a unit [-]."""


@within_ranges
def groin_vault(
    radius: Radius,
    thickness: Thick,
    length: Size,
    unit: Size,
    span_angle: SpanAngle = math.pi,
    courses: Annotated[int, Within(1, 1000, whole=True)] = 17,
    *,
    cut: bool = False,
    density: Density = 2000.0,
) -> list[SolidBlock]:
    """A groin vault, or cross vault: two equal barrels that cross over a square bay, on four fixed piers.

    The webs are in running bond, and end at the groins, two vertical planes across the corners of the bay. The
    middle of the bay is x = y = 0. Its sides are front, where x is positive, back, left, where y is negative, and
    right; a pier is named by its two sides, `pier_front_right`.

    Args:
        radius, thickness, span_angle: of the section of a web, as of `arch`.
        length: of the sides of the bay [m], 0.01 to 1000, at least the span of the extrados.
        unit: length of a voussoir of the webs [m], 0.01 to 1000 and at most the length. `web_left_2_0` is the first
            of the third course of the left web, from its side inwards, and what is left of a course belongs to the
            groin.
        courses: voussoirs of the section of a web, 1 to 1000. An odd number has a keystone, with four arms.
        cut: whether the stones of a groin are cut along it, each of one web. Otherwise a stone of two arms, a
            `Compound`, belongs to both webs, `groin_front_right_0` above the pier, and binds them.
        density: mass density [kg/m3], 100 to 30000.

    Raises:
        ValueError: for a value outside its range.
    """
    _, *voussoirs, _ = voussoirs_of(radius, thickness, span_angle, courses, density, 1.0)
    (x, z), (reach, top) = springing_of(radius, thickness, span_angle).tolist()
    pier = np.array([(x, z), (reach, top), (reach, z - (reach - x)), (x, z - (reach - x))])
    strips = [Polygon(pier * (-1, 1), density), *voussoirs, Polygon(pier, density)]
    length = require_within("length", length, 2 * reach * BELOW_BY_ROUNDING, 1e3, "m")
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
            stones.setdefault(name, []).append(_web_course(strip, arm, k, f"{name}_{side}", crown=2 * i == last))
            webs += [_web_course(strip, ends, k, f"web_{side}_{i - 1}_{j}") for j, ends in enumerate(units)]
    groins: list[SolidBlock] = []
    for name, parts in stones.items():
        fixed = name.startswith("pier")
        groins += parts if cut and not fixed else [Compound(parts, fixed, name)]
    return [*groins, *webs]


def _web_course(polygon: Polygon, ends: tuple[float, float], turns: int, name: str, crown: bool = False) -> Polyhedron:
    """The part of a course of a web between two distances y from the middle of the bay, the larger one first [m].

    The course ends at the groins, where y = |x|, which meet above the middle in the course at the crown.
    """
    (outer, inner_end), (x, z) = ends, polygon.corners.T
    if crown:
        x, z = np.append(x, [0.0, 0.0]), np.append(z, [z.min(), z.max()])
    inner = np.maximum(np.abs(x), inner_end)
    beyond = outer - inner > 1e-6 * outer
    inside, outside = np.column_stack([x, inner, z]), np.column_stack([x, np.full_like(x, outer), z])[beyond]
    vertices = np.vstack([inside, outside]) @ np.linalg.matrix_power(QUARTER_TURN, turns)
    return Polyhedron(vertices, polygon.density, name=name)


def _laid(polygon: Polygon, ends: Sequence[float], name: str | None) -> Polyhedron:
    """A block of the plane between two y [m]."""
    return Polyhedron.prism(replace(polygon, length=ends[1] - ends[0], name=name), 0.5 * (ends[0] + ends[1]))
