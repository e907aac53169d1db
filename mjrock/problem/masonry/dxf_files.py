"""Drawings in DXF: closed polylines are the outlines of blocks, and layers say what these are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...quantities import Array, named, shown
from .mesh_files import bytes_of, plain
from .polygon import Polygon

SHORT = 1e-9
"""Distance of the ends of a polyline that count as one, over its extent [-]."""


OfLayer = float | Mapping[str, float]
"""A number, or one for each layer."""


class Outline(NamedTuple):
    """The outline of a block: its name, which is its layer and a number, the layer, and corners, shape (n, 2)."""

    name: str
    layer: str
    corners: Array


def read_dxf(path: Path) -> tuple[list[Outline], float]:
    """The outlines of a drawing in the order in which they are drawn, and its unit [m], 1 where it names none.

    Raises:
        ImportError: if ezdxf is missing.
        ValueError: with the path, for what is no drawing, for a polyline that is open or has arcs, and where none is.
    """
    try:
        from ezdxf import recover, units
        from ezdxf.disassemble import recursive_decompose
        from ezdxf.enums import InsertUnits
        from ezdxf.lldxf.const import DXFError
    except ImportError as error:
        raise ImportError(f"{error}; ezdxf reads drawings: pip install 'mjrock[dxf]'") from error
    bytes_of(path)
    try:
        document = recover.readfile(path)[0]
    except (DXFError, OSError, ValueError) as error:
        raise ValueError(f"path = {path} is not a drawing in DXF, or is cut short: {error}") from None
    unit = units.conversion_factor(InsertUnits(document.units), InsertUnits.Meters) if document.units else 1
    outlines, counts, others = [], Counter[str](), Counter[str]()
    for entity in recursive_decompose(document.modelspace()):  # with what inserted blocks hold, where they are inserted
        if entity.dxftype() not in ("LWPOLYLINE", "POLYLINE"):
            others[entity.dxftype()] += 1
            continue
        layer = entity.dxf.layer
        try:
            corners = _corners(entity)
        except ValueError as error:
            raise ValueError(f"path = {path}, layer {layer}: {error}") from None
        outlines.append(Outline(f"{plain(layer, 'layer')}_{counts[layer]}", layer, corners))
        counts[layer] += 1
    if not outlines:
        found = ", ".join(f"{count} {kind}" for kind, count in sorted(others.items())) or "nothing"
        raise ValueError(f"path = {path} has no closed polyline; there is {found}")
    return outlines, float(unit)


def _corners(polyline: Any) -> Array:
    """Corners of a closed polyline in the plane x, y of the drawing, shape (n, 2)."""
    if polyline.dxftype() == "POLYLINE" and not polyline.is_2d_polyline:
        raise ValueError("a polyline is not in the plane x, y")
    light = polyline.dxftype() == "LWPOLYLINE"
    places = np.array([tuple(at) for at in (polyline.vertices_in_wcs() if light else polyline.points_in_wcs())])
    at = f"the polyline that begins at {places[0, 0]:g}, {places[0, 1]:g}" if len(places) else "a polyline"
    extent = float(np.ptp(places, axis=0).max()) if len(places) else 0.0
    if len(places) > 1 and np.linalg.norm(places[0] - places[-1]) <= SHORT * extent:
        places = places[:-1]
    elif not polyline.is_closed:
        raise ValueError(f"{at} is open: close it")
    if polyline.has_arc:
        raise ValueError(f"{at} has arcs: draw them as short straight edges")
    if len(places) < 3 or np.ptp(places[:, 2]) > SHORT * extent:
        raise ValueError(f"{at} has {len(places)} corners, and needs three or more in the plane x, y")
    return np.asarray(places[:, :2])


def polygons_of(
    outlines: Sequence[Outline], fixed: Sequence[str], density: OfLayer, length: OfLayer, scale: float
) -> list[Polygon]:
    """The blocks of outlines.

    Args:
        outlines: of a drawing.
        fixed: layers and names of blocks that are fixed.
        density: [kg/m3].
        length: out of the plane [m].
        scale: length of a unit of the drawing [m].

    Raises:
        ValueError: with the name of the block or layer, for what is no convex block, or is not there.
    """
    layers = {outline.layer: None for outline in outlines}
    known = {*layers, *(outline.name for outline in outlines)}
    for name in fixed:
        if name not in known:
            raise ValueError(f"fixed = {name!r} is neither a layer nor a block; the layers are {named(list(layers))}")

    def of(what: str, value: OfLayer, layer: str) -> float:
        if not isinstance(value, Mapping):
            return value
        if layer not in value:
            raise ValueError(f"{what} = {shown(value)} has nothing for the layer {layer!r}")
        return value[layer]

    polygons = []
    for outline in outlines:
        held = outline.layer in fixed or outline.name in fixed
        numbers = of("density", density, outline.layer), of("length", length, outline.layer)
        try:
            polygons.append(Polygon(scale * outline.corners, *numbers, held, outline.name))
        except (ValueError, TypeError) as error:
            x, z = scale * outline.corners[0]
            raise ValueError(f"block {outline.name}, which begins at {x:g}, {z:g} m: {error}") from None
    return polygons
