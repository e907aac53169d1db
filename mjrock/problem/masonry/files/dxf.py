"""Drawings in DXF: closed polylines are the outlines of blocks, and layers give their kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple, TypeGuard

import numpy as np

from ....geometry.hull import prism
from ....quantities import Array, Density, P, Result, named, shown, warn_of
from ..blocks.compound import Compound, FlatBlock, SolidBlock
from ..blocks.polygon import LENGTHS, InwardsError, Polygon
from ..builders.in_plane import MOST_BODIES
from .bodies import FileOptions, Mesh, about, block_name, blocks_of
from .meshes import bytes_of

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities.dxfentity import DXFEntity
    from ezdxf.entities.insert import Insert
    from ezdxf.entities.lwpolyline import LWPolyline
    from ezdxf.entities.polyline import Polyline

CLOSED_WITHIN = 1e-9
"""Distance of the ends of a polyline that count as one, over its extent [-]."""
MOST_INSERTED = 10 * MOST_BODIES
"""Most lines, texts and whatever else that the blocks of a drawing may insert; they take some ten seconds."""
DEEPEST = 50
"""Most levels of inserted blocks within each other."""
NO_DRAWING = {
    b"%PDF": "a PDF",
    b"PK": "a zip archive or a document of an office",
    b"AC10": "a drawing in DWG",
    b"AutoCAD Binary DXF": "a binary drawing",
}
"""What a file is that begins so, and is given for a drawing in DXF."""

AREAS = ("SPLINE", "HATCH", "CIRCLE", "ELLIPSE", "REGION", "SOLID", "TRACE", "MPOLYGON", "3DFACE", "3DSOLID", "MESH")
"""What may be the outline of a block beside a polyline, and is not read."""

DensityOfLayer = Density | Mapping[str, Density]
LengthOfLayer = Annotated[float, LENGTHS] | Mapping[str, Annotated[float, LENGTHS]]
OfLayer = float | Mapping[str, float]
"""A number, or one for each layer."""


class Outline(NamedTuple):
    """The outline of a block: its name, which is its layer and a number, the layer, and corners in the units and axes
    of the drawing, shape (n, 3)."""

    name: str
    layer: str
    corners: Array


class DxfDrawing(NamedTuple):
    """The outlines of a drawing in the order in which they are drawn, and its unit [m], None where it names none."""

    outlines: list[Outline]
    unit: float | None


def read_dxf(path: Path, layers: Sequence[str] | None) -> DxfDrawing:
    """The outlines of a drawing on some layers, or on all.

    Raises:
        ImportError: if ezdxf is missing.
        ValueError: for what is no drawing or is damaged, for inserted blocks that hold each other or are too many, for
            a polyline that is open or has arcs, for a layer that holds nothing, and where no polyline is.

    Warns:
        UserWarning: of what the library repairs while it reads the drawing, and of areas that are left out.
    """
    try:
        from ezdxf import recover, units
        from ezdxf.enums import InsertUnits
    except ImportError as error:
        raise ImportError(f"{error}; ezdxf reads drawings: pip install ezdxf") from error
    content = bytes_of(path)
    if other_kinds := [description for start, description in NO_DRAWING.items() if content.startswith(start)]:
        raise ValueError(f"it is {other_kinds[0]}, and no drawing in DXF; save it as text in DXF")
    document, auditor = _read_by_library(recover.readfile, str(path))
    unit = None
    if _read_by_library(lambda: document.units):
        unit = _read_by_library(lambda: units.conversion_factor(InsertUnits(document.units), InsertUnits.Meters))
    space = document.modelspace()
    _read_by_library(_require_few, document, space)
    entities = _read_by_library(lambda: list(_with_inserted(space)))
    layer_names = _read_by_library(lambda: {entity.dxf.layer: None for entity in entities})
    for layer in layers or ():
        if layer not in layer_names:
            raise ValueError(f"layers = {layer!r} holds nothing; the layers are {named(list(layer_names))}")
    every, others = _outlines([entity for entity in entities if layers is None or entity.dxf.layer in layers])
    if repairs := [*auditor.errors, *auditor.fixes]:
        text = named([" ".join(str(repair.message).split())[:120] for repair in repairs])
        warn_of(f"path = {path} is damaged, and was repaired while it was read: {text}")
    first: dict[bytes, Outline] = {}
    if repeated := [outline.name for outline in every if first.setdefault(_places(outline), outline) is not outline]:
        warn_of(f"path = {path}: {len(repeated)} outlines are drawn twice, and read once: {named(repeated)}")
    outlines = list(first.values())
    if ignored := {kind: count for kind, count in others.items() if kind in AREAS}:
        warn_of(f"path = {path}: only closed polylines are read; left out are {_counted(ignored)}")
    return DxfDrawing(outlines, unit)


def _outlines(entities: Sequence[DXFEntity]) -> tuple[list[Outline], Counter[str]]:
    """The outlines among things of a drawing, and how many there are of each other kind."""
    outlines, counts, others = [], Counter[str](), Counter[str]()
    for entity in entities:
        if not _is_polyline(entity):
            others[entity.dxftype()] += 1
            continue
        layer = entity.dxf.layer
        try:
            corners = _read_by_library(_corners, entity)
        except DrawingError as error:
            raise ValueError(f"layer {layer}: {error}; or give the layers that hold blocks by layers=") from None
        outlines.append(Outline(f"{block_name(layer, 'layer')}_{counts[layer]}", layer, corners))
        counts[layer] += 1
    if not outlines:
        join = "; join its lines to closed polylines" if others["LINE"] > 2 else ""
        raise ValueError(f"it has no closed polyline; there is {_counted(others) or 'nothing'}{join}")
    return outlines, others


def _places(outline: Outline) -> bytes:
    """The corners of an outline without their order, the same for one that is drawn twice."""
    return np.unique(outline.corners.round(9) + 0.0, axis=0).tobytes()


def _counted(counts: Mapping[str, int]) -> str:
    """Kinds of things and how many of each, in words."""
    return ", ".join(f"{count} {name}" for name, count in sorted(counts.items()))


class DrawingError(ValueError):
    """A polyline that is no outline of a block, or inserted blocks that hold each other or are too many."""


def _read_by_library(call: Callable[P, Result], *arguments: P.args, **options: P.kwargs) -> Result:
    """What a call into the library of drawings returns. Raises a ValueError for any error of it."""
    try:
        return call(*arguments, **options)
    except DrawingError:
        raise
    except Exception as error:  # a damaged file ends in IndexError, AttributeError, AssertionError and others there
        text = " ".join(str(error).split())[:200] or type(error).__name__
        raise ValueError(f"it is not a drawing in DXF, or is damaged: {text}") from None


def _is_polyline(entity: DXFEntity) -> TypeGuard[LWPolyline | Polyline]:
    """Whether an entity of a drawing is a polyline, which may be the outline of a block."""
    return entity.dxftype() in ("LWPOLYLINE", "POLYLINE")


def _is_insert(entity: DXFEntity) -> TypeGuard[Insert]:
    """Whether an entity of a drawing is an inserted block."""
    return entity.dxftype() == "INSERT"


class InsertCount(NamedTuple):
    """How many outlines and how many things in all are inserted, also those of outlines."""

    outlines: int = 0
    inserted: int = 0


def _require_few(document: Drawing, space: Iterable[DXFEntity]) -> None:
    """Raise a `DrawingError` for blocks that insert each other, or that are too many, before they are inserted."""
    counts: dict[str, InsertCount] = {}

    def counted(entities: Iterable[DXFEntity], within: tuple[str, ...]) -> InsertCount:
        outlines = inserted = 0
        for entity in entities:
            if _is_insert(entity):
                times, contents = max(1, entity.mcount), block(entity.dxf.name, within)
                outlines, inserted = outlines + times * contents.outlines, inserted + times * contents.inserted
            else:
                outlines += _is_polyline(entity)
                inserted += bool(within)
        return InsertCount(outlines, inserted)

    def block(name: str, within: tuple[str, ...]) -> InsertCount:
        if name in within:
            raise DrawingError(f"the blocks {named(within[within.index(name) :])} insert each other")
        if len(within) >= DEEPEST:
            raise DrawingError(f"blocks are inserted in each other on more than {DEEPEST} levels, from {within[0]} on")
        if name not in counts:
            counts[name] = counted(document.blocks.get(name) or (), (*within, name))
        return counts[name]

    total = counted(space, ())
    for count, subject, allowed in (
        (total.outlines, "outlines", MOST_BODIES),
        (total.inserted, "things that are inserted", MOST_INSERTED),
    ):
        if count > allowed:
            raise DrawingError(f"there are {count:.3g} {subject}, and at most {allowed} are taken")


def _with_inserted(entities: Iterable[DXFEntity]) -> Iterator[DXFEntity]:
    """Entities with those of inserted blocks, where they are inserted."""
    for entity in entities:
        if not _is_insert(entity):
            yield entity
            continue
        if entity.dxf.zscale == 0.0:  # as some programs write it into plane drawings, and the library cannot turn it
            entity.dxf.zscale = 1.0
        yield from _with_inserted(entity.multi_insert() if entity.mcount > 1 else entity.virtual_entities())


def _corners(polyline: LWPolyline | Polyline) -> Array:
    """Corners of a closed polyline in the axes of the drawing, shape (n, 3)."""
    from ezdxf.entities.polyline import Polyline

    if isinstance(polyline, Polyline) and not (polyline.is_2d_polyline or polyline.is_3d_polyline):
        raise DrawingError("a polyline is a mesh, and no outline")
    corners = polyline.points_in_wcs() if isinstance(polyline, Polyline) else polyline.vertices_in_wcs()
    places = np.array([tuple(at) for at in corners])
    at = f"the polyline that begins at {places[0, 0]:g}, {places[0, 1]:g}" if len(places) else "a polyline"
    extent = float(np.ptp(places, axis=0).max()) if len(places) else 0.0
    if len(places) > 1 and np.abs(places[0] - places[-1]).max() <= CLOSED_WITHIN * extent:
        places = places[:-1]
    elif not polyline.is_closed:
        raise DrawingError(f"{at} is open: close it")
    if polyline.has_arc:
        raise DrawingError(f"{at} has arcs: draw them as short straight edges")
    if len(places) < 3:
        raise DrawingError(f"{at} has {len(places)} corners, and needs three or more")
    return places


def polygons_of(drawing: DxfDrawing, file: FileOptions, density: OfLayer, length: OfLayer) -> list[FlatBlock]:
    """The blocks of a drawing, in m with z upwards.

    Args:
        drawing: the outlines and their unit.
        file: the arguments that describe the file; layers, and names of blocks, are fixed.
        density: [kg/m3].
        length: out of the plane [m].

    Raises:
        ValueError: with the name of the block or layer, for what is no convex block, or is not there.
    """
    turn, fixed = file.matrix(1.0 if drawing.unit is None else drawing.unit, "y"), file.fixed
    layers = {outline.layer: None for outline in drawing.outlines}
    known = {*layers, *(outline.name for outline in drawing.outlines)}
    for name in fixed:
        if name not in known:
            raise ValueError(f"fixed = {name!r} is neither a layer nor a block; the layers are {named(list(layers))}")

    def of_layer(argument: str, value: OfLayer, layer: str) -> float:
        if not isinstance(value, Mapping):
            return value
        if layer not in value:
            raise ValueError(f"{argument} = {shown(value)} has nothing for the layer {layer!r}")
        return value[layer]

    polygons: dict[str, FlatBlock] = {}
    dented: dict[str, tuple[Mesh, tuple[float, float]]] = {}
    for outline in drawing.outlines:
        is_fixed, layer = outline.layer in fixed or outline.name in fixed, outline.layer
        density_and_length = of_layer("density", density, layer), of_layer("length", length, layer)
        corners = outline.corners @ turn.T
        begins = f"block {outline.name}, which begins at {corners[0, 0]:g}, {corners[0, 2]:g} m"
        if np.ptp(corners[:, 1]) > CLOSED_WITHIN * np.ptp(corners, axis=0).max():
            raise ValueError(f"{begins}: it is not in the plane of the drawing; up='z' takes one in the plane x, z")
        ring = corners[:, [0, 2]]
        with about(begins, (ValueError, TypeError)):
            try:
                polygons[outline.name] = Polygon(ring, *density_and_length, is_fixed, outline.name)
            except InwardsError as error:
                if file.convex is None:
                    raise ValueError(f"{error}; convex='parts' cuts it, and convex='hull' fills it") from None
                places, faces = prism(ring, 1.0)
                dented[outline.name] = Mesh(outline.name, places, list(faces), is_fixed), density_and_length
    meshes = [mesh for mesh, _ in dented.values()]
    for block in blocks_of(meshes, FileOptions(convex=file.convex)) if meshes else ():
        polygons[str(block.name)] = _block_in_plane(block, dented[str(block.name)][1])
    return [polygons[outline.name] for outline in drawing.outlines]


def _block_in_plane(block: SolidBlock, density_and_length: tuple[float, float]) -> FlatBlock:
    """A prism along y as a block of the plane, with its density and length."""
    polygons = []
    for part in block.parts:
        front = part.corners[part.corners[:, 1] < 0][:, [0, 2]]
        about = front - front.mean(axis=0)
        polygons.append(Polygon(front[np.argsort(np.arctan2(about[:, 1], about[:, 0]))], *density_and_length))
    if len(polygons) > 1:
        return Compound(polygons, block.fixed, block.name)
    return replace(polygons[0], fixed=block.fixed, name=block.name)
