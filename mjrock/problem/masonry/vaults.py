"""Blocks of masonry that spans: arches on piers or abutments, one or several, and a barrel vault."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...quantities import require_flag, require_whole, require_within
from .builders import MOST_BLOCKS, arch_of, ground_under
from .polygon import Polygon
from .polyhedron import Polyhedron


class Span(NamedTuple):
    """An arch: radius of its middle and thickness [m], angle between its springings [rad], and how many voussoirs."""

    radius: float
    thickness: float
    angle: float
    voussoirs: int


def bridge_of(
    spans: int, arch: Span, pier: tuple[float, float], abutments: bool, density: float, length: float
) -> list[Polygon]:
    """The ground, and arches on piers of a width and a height up to the springings [m], see `Masonry.bridge`."""
    spans, ends = require_whole("spans", spans, 1, 50), require_flag("abutments", abutments)
    blocks = arch_of(*arch, density, length)
    if spans * len(blocks) >= MOST_BLOCKS:
        raise ValueError(f"spans = {spans} of {arch.voussoirs} voussoirs are more blocks than {MOST_BLOCKS}")
    half, t = 0.5 * arch.angle, arch.thickness
    springing = (arch.radius - 0.5 * t) * np.array([math.sin(half), math.cos(half)])
    skew = t * np.array([math.sin(half), math.cos(half)])
    wide = require_within("pier_width", pier[0], skew[0] * (1 if spans == 1 else 2), 1e3, "m")
    high = require_within("pier_height", pier[1], 1e-2, 1e3, "m")
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
    length = require_within("length", length, 1e-2, 1e3, "m")
    unit = require_within("unit", unit, 1e-2, length, "m")
    left, *courses, right = arch_of(*arch, density, 1.0)
    whole = round(length / unit)
    if len(courses) * (whole + 1) >= MOST_BLOCKS:
        raise ValueError(f"unit = {unit:g} m makes a vault of more blocks than {MOST_BLOCKS}")
    fitted = length / whole
    blocks = [_laid(left, (0.0, length), left.name)]
    for i, course in enumerate(courses):
        heads = fitted * (np.arange(1, whole) if i % 2 == 0 else np.arange(whole) + 0.5)
        for j, ends in enumerate(pairwise([0.0, *heads.tolist(), length])):
            blocks.append(_laid(course, ends, f"{course.name}_{j}"))
    return [*blocks, _laid(right, (0.0, length), right.name)]


def _laid(polygon: Polygon, ends: Sequence[float], name: str | None) -> Polyhedron:
    """A block of the plane between two y [m]."""
    return Polyhedron.prism(replace(polygon, length=ends[1] - ends[0], name=name), 0.5 * (ends[0] + ends[1]))
