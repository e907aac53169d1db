"""Drawings in DXF: closed polylines are the outlines of blocks, and layers say what these are."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ....quantities import Array, named, shown
from ..blocks.polygon import Polygon
from ..builders.in_plane import MOST_BLOCKS
from .meshes import bytes_of, plain

SHORT = 1e-9
"""Distance of the ends of a polyline that count as one, over its extent [-]."""
MOST_INSERTED = 10 * MOST_BLOCKS
"""Most lines, texts and whatever else that the blocks of a drawing may insert; they take some ten seconds."""
OUTLINES = ("LWPOLYLINE", "POLYLINE")
DEEPEST = 50
"""Most levels of inserted blocks within each other."""
NO_DRAWING = {
    b"%PDF": "a PDF",
    b"PK": "a zip archive or a document of an office",
    b"AC10": "a drawing in DWG",
    b"AutoCAD Binary DXF": "a binary drawing",
}
"""What a file is that begins so, and is given for a drawing in DXF."""

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
        ValueError: with the path, for what is no drawing or is damaged, for inserted blocks that hold each other or are
            too many, for a polyline that is open or has arcs, and where none is.

    Warns:
        UserWarning: of what the library repairs while it reads the drawing.
    """
    try:
        from ezdxf import recover, units
        from ezdxf.enums import InsertUnits
    except ImportError as error:
        raise ImportError(f"{error}; ezdxf reads drawings: pip install ezdxf") from error
    for start, what in NO_DRAWING.items():
        if bytes_of(path).startswith(start):
            raise ValueError(f"path = {path} is {what}, and no drawing in DXF; save it as text in DXF")
    document, auditor = _sound(path, recover.readfile, str(path))
    unit = 1.0
    if document.units:
        unit = _sound(path, lambda: units.conversion_factor(InsertUnits(document.units), InsertUnits.Meters))
    space = document.modelspace()
    try:
        _sound(path, _require_few, document, space)
    except InsertError as error:
        raise ValueError(f"path = {path}: {error}") from None
    outlines, counts, others = [], Counter[str](), Counter[str]()
    for entity in _sound(path, lambda: list(_inserted(space))):
        if entity.dxftype() not in OUTLINES:
            others[entity.dxftype()] += 1
            continue
        layer = entity.dxf.layer
        try:
            corners = _sound(path, _corners, entity)
        except OutlineError as error:
            raise ValueError(f"path = {path}, layer {layer}: {error}") from None
        outlines.append(Outline(f"{plain(layer, 'layer')}_{counts[layer]}", layer, corners))
        counts[layer] += 1
    if not outlines:
        found = ", ".join(f"{count} {kind}" for kind, count in sorted(others.items())) or "nothing"
        raise ValueError(f"path = {path} has no closed polyline; there is {found}")
    _warn_of_repairs(path, [*auditor.errors, *auditor.fixes])
    return outlines, float(unit)


class OutlineError(ValueError):
    """A polyline that is no outline of a block."""


class InsertError(ValueError):
    """Inserted blocks that hold each other, or are too many."""


def _sound(path: Path, call: Callable[..., Any], *arguments: Any) -> Any:
    """What a call into the library of drawings returns; a ValueError with the path for whatever it raises."""
    try:
        return call(*arguments)
    except (OutlineError, InsertError):
        raise
    except Exception as error:  # a damaged file ends in IndexError, AttributeError, AssertionError and others there
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise ValueError(f"path = {path} is not a drawing in DXF, or is damaged: {said}") from None


def _warn_of_repairs(path: Path, repairs: Sequence[Any]) -> None:
    """Warn of a drawing that was repaired while it was read."""
    if repairs:
        said = named([" ".join(str(repair.message).split())[:120] for repair in repairs])
        warnings.warn(f"path = {path} is damaged, and was repaired while it was read: {said}", stacklevel=4)


class Held(NamedTuple):
    """How many outlines and how many things in all are inserted, also those of outlines."""

    outlines: int = 0
    inserted: int = 0


def _require_few(document: Any, space: Iterable[Any]) -> None:
    """Raise `InsertError` for blocks that insert each other, or that are too many, before they are inserted."""
    counts: dict[str, Held] = {}

    def held(entities: Iterable[Any], within: tuple[str, ...]) -> Held:
        outlines = inserted = 0
        for entity in entities:
            if entity.dxftype() == "INSERT":
                times, one = max(1, entity.mcount), block(entity.dxf.name, within)
                outlines, inserted = outlines + times * one.outlines, inserted + times * one.inserted
            else:
                outlines += entity.dxftype() in OUTLINES
                inserted += bool(within)
        return Held(outlines, inserted)

    def block(name: str, within: tuple[str, ...]) -> Held:
        if name in within:
            raise InsertError(f"the blocks {named(within[within.index(name) :])} insert each other")
        if len(within) >= DEEPEST:
            raise InsertError(f"blocks are inserted in each other on more than {DEEPEST} levels, from {within[0]} on")
        if name not in counts:
            counts[name] = held(document.blocks.get(name) or (), (*within, name))
        return counts[name]

    found = held(space, ())
    for count, what, most in zip(
        found, ("outlines", "things that are inserted"), (MOST_BLOCKS, MOST_INSERTED), strict=True
    ):
        if count > most:
            raise InsertError(f"there are {count:.3g} {what}, and at most {most} are taken")


def _inserted(entities: Iterable[Any]) -> Iterator[Any]:
    """Entities with those of inserted blocks, where they are inserted."""
    for entity in entities:
        if entity.dxftype() != "INSERT":
            yield entity
        elif entity.mcount > 1:
            yield from _inserted(entity.multi_insert())
        else:
            yield from _inserted(entity.virtual_entities())


def _corners(polyline: Any) -> Array:
    """Corners of a closed polyline in the plane x, y of the drawing, shape (n, 2)."""
    if polyline.dxftype() == "POLYLINE" and not polyline.is_2d_polyline:
        raise OutlineError("a polyline is not in the plane x, y")
    light = polyline.dxftype() == "LWPOLYLINE"
    places = np.array([tuple(at) for at in (polyline.vertices_in_wcs() if light else polyline.points_in_wcs())])
    at = f"the polyline that begins at {places[0, 0]:g}, {places[0, 1]:g}" if len(places) else "a polyline"
    extent = float(np.ptp(places, axis=0).max()) if len(places) else 0.0
    if len(places) > 1 and np.abs(places[0] - places[-1]).max() <= SHORT * extent:
        places = places[:-1]
    elif not polyline.is_closed:
        raise OutlineError(f"{at} is open: close it")
    if polyline.has_arc:
        raise OutlineError(f"{at} has arcs: draw them as short straight edges")
    if len(places) < 3 or np.ptp(places[:, 2]) > SHORT * extent:
        raise OutlineError(f"{at} has {len(places)} corners, and needs three or more in the plane x, y")
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
