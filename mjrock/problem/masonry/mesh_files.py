"""Files of meshes: Wavefront OBJ, STL, and the JSON of a COMPAS model.

What reads a file raises a ValueError with the path, the line where there is one, and what is wrong.
"""

from __future__ import annotations

import json
import struct
import uuid
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...quantities import Array
from .meshes import Mesh, used
from .polyhedron import Polyhedron

MOST_BYTES = 500_000_000
"""Largest file that is read."""


def bytes_of(path: Path) -> bytes:
    """What a file holds, which is not empty and at most 500 MB."""
    if not path.is_file():
        raise ValueError(f"path = {path} is not a file")
    size = path.stat().st_size
    if not 0 < size <= MOST_BYTES:
        raise ValueError(f"path = {path} has {size} bytes; the valid range is 1 to {MOST_BYTES}")
    return path.read_bytes()


def text_of(path: Path) -> str:
    """What a text file holds."""
    try:
        return bytes_of(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"path = {path} is not text: it holds bytes that are not UTF-8") from None


def read_obj(path: Path) -> list[Mesh]:
    """The meshes of an OBJ file: one for each object, or group of it, in their order."""
    vertices: list[tuple[float, ...]] = []
    faces: dict[tuple[str, str], list[tuple[int, ...]]] = {}
    thing, group = "", ""
    for count, line in enumerate(text_of(path).replace("\\\n", " ").splitlines(), 1):
        kind, _, rest = line.partition("#")[0].strip().partition(" ")
        try:
            if kind == "v":
                vertices.append(_triple(rest.split()[:3]))
            elif kind == "f":
                corners = [int(corner.split("/")[0]) for corner in rest.split()]
                face = tuple(i - 1 if i > 0 else len(vertices) + i for i in corners)
                if len(face) < 3 or 0 in corners or not all(0 <= i < len(vertices) for i in face):
                    raise ValueError
                faces.setdefault((thing, group), []).append(face)
            elif kind == "o":
                thing, group = rest.strip(), ""
            elif kind == "g":
                group = rest.strip()
        except ValueError:
            raise ValueError(
                f"path = {path}, line {count}: {line[:60]!r} is not a vertex or face of an OBJ file"
            ) from None
    if not faces:
        raise ValueError(f"path = {path} has no faces: it is not an OBJ file, or is cut short")
    things = Counter(thing for thing, _ in faces)
    places, meshes = np.array(vertices), []
    for i, ((thing, group), ring) in enumerate(faces.items()):
        name = thing if thing and things[thing] == 1 else "_".join(part for part in (thing, group) if part)
        meshes.append(Mesh(_plain(name, f"body_{i}"), *used(places, ring)))
    return meshes


def read_stl(path: Path) -> list[Mesh]:
    """The meshes of an STL file: one for each solid of a text, one of a binary file."""
    content = bytes_of(path)
    facets = struct.unpack_from("<I", content, 80)[0] if len(content) >= 84 else -1
    if len(content) == 84 + 50 * facets:
        records = np.frombuffer(content, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
        return [_facets("body", records["v"].reshape(-1, 3).astype(float))]
    if content.lstrip()[:5].lower() != b"solid" or b"facet" not in content:
        needed = f"; its head promises {facets} facets, {84 + 50 * facets} bytes" if 0 <= facets < 10**7 else ""
        raise ValueError(f"path = {path} is not an STL file, or is cut short: it has {len(content)} bytes{needed}")
    meshes: list[Mesh] = []
    name, is_open = "body", False
    corners: list[tuple[float, float, float]] = []
    for count, line in enumerate(text_of(path).splitlines(), 1):
        words = line.split()
        kind = words[0].lower() if words else ""
        if kind == "solid":
            name, corners, is_open = _plain(" ".join(words[1:]), f"body_{len(meshes)}"), [], True
        elif kind == "vertex":
            try:
                corners.append(_triple(words[1:]))
            except ValueError:
                raise ValueError(f"path = {path}, line {count}: {line[:60]!r} is not a vertex of an STL file") from None
        elif kind == "endfacet" and len(corners) % 3:
            raise ValueError(f"path = {path}, line {count}: a facet of an STL file has three vertices")
        elif kind == "endsolid":
            meshes.append(_facets(name, np.reshape(corners, (-1, 3))))
            is_open = False
    if is_open or not meshes:
        raise ValueError(f"path = {path} is cut short: the solid {name} does not end")
    return meshes


def _facets(name: str, corners: Array) -> Mesh:
    """A mesh of triangles, from three vertices each."""
    return Mesh(name, corners, [(i, i + 1, i + 2) for i in range(0, len(corners), 3)])


def _triple(words: Sequence[str]) -> tuple[float, float, float]:
    x, y, z = map(float, words)
    return x, y, z


def _plain(name: str, otherwise: str) -> str:
    """A name that a block can have."""
    name = name.strip().replace("|", "_")
    return otherwise if name in ("", "world") else name


def read_compas(path: Path) -> list[Mesh]:
    """The elements of a COMPAS model, each of which is a mesh, with their supports and densities of their materials."""
    try:
        model = json.loads(text_of(path))
        content = model["data"]
        elements = content["elements"]
        pairs = list(elements.items() if isinstance(elements, dict) else enumerate(elements))
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"path = {path} is not JSON, or is cut short: {error}") from None
    except (KeyError, TypeError):
        raise ValueError(f"path = {path} is not a COMPAS model: it has no data.elements") from None
    materials = content.get("materials") or {}
    meshes = []
    for key, element in pairs:
        try:
            meshes.append(_element(element["data"], materials))
        except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as error:
            raise ValueError(
                f"path = {path}: the element {key} is not a block with a mesh: {type(error).__name__} {error}"
            ) from None
    if not meshes:
        raise ValueError(f"path = {path} is a COMPAS model without elements")
    return meshes


def _element(element: dict[str, Any], materials: dict[str, Any]) -> Mesh:
    """A block of a COMPAS model."""
    shape = element["geometry"]["data"]
    order = {key: i for i, key in enumerate(shape["vertex"])}
    places = np.array([[float(vertex[axis]) for axis in "xyz"] for vertex in shape["vertex"].values()])
    faces = [tuple(order[str(vertex)] for vertex in face) for face in shape["face"].values()]
    if element.get("transformation"):
        matrix = np.array(element["transformation"]["data"]["matrix"], dtype=float)
        places = places @ matrix[:3, :3].T + matrix[:3, 3]
    density = materials.get(str(element.get("material")), {}).get("data", {}).get("density")
    name = _plain(str(element.get("name") or ""), "block")
    return Mesh(name, places, faces, bool(element.get("is_support", False)), density)


def obj_text(blocks: Sequence[Polyhedron], names: Sequence[str]) -> str:
    """Blocks as the text of an OBJ file, one object each. A ValueError says which name it cannot hold."""
    lines, before = ["# metres, z upwards"], 1
    for block, name in zip(blocks, names, strict=True):
        if "#" in name or name.endswith("\\") or name.strip() != name:
            raise ValueError(
                f"the block {name!r} has a # in its name, a backslash at its end or a blank at one of its ends, which "
                "an OBJ file does not hold"
            )
        lines.append(f"o {name}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in block.vertices]
        lines += ["f " + " ".join(str(before + i) for i in face) for face in block.faces]
        before += len(block.vertices)
    return "\n".join(lines) + "\n"


def compas_text(blocks: Sequence[Polyhedron], names: Sequence[str]) -> str:
    """Blocks as the JSON of a COMPAS model, without interactions. The same blocks give the same text."""
    densities = dict.fromkeys(block.density for block in blocks)

    def key(kind: str, name: object) -> str:
        return str(uuid.uuid5(uuid.NAMESPACE_URL, f"{kind} {name}"))

    def held(kind: str, data: dict[str, Any], guid: str) -> dict[str, Any]:
        return {"dtype": kind, "data": data, "guid": guid}

    elements: dict[str, Any] = {}
    for block, name in zip(blocks, names, strict=True):
        mesh = {
            "attributes": {},
            "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
            "default_edge_attributes": {},
            "default_face_attributes": {},
            "vertex": {str(i): dict(zip("xyz", place, strict=True)) for i, place in enumerate(block.vertices)},
            "face": {str(i): list(face) for i, face in enumerate(block.faces)},
            "facedata": {},
            "edgedata": {},
            "max_vertex": len(block.vertices) - 1,
            "max_face": len(block.faces) - 1,
        }
        stone = key("density", block.density)
        inside: dict[str, Any] = {"transformation": None, "features": [], "name": name, "material": stone}
        inside |= {"geometry": {"dtype": "compas.datastructures/Mesh", "data": mesh}, "is_support": block.fixed}
        guid = key("block", name)
        elements[guid] = held("compas_dem.elements/Block", inside, guid)
    stones = {
        guid: held("compas_dem.material/Stone", {"name": "Stone", "density": density}, guid)
        for guid, density in ((key("density", density), density) for density in densities)
    }
    children = [{"name": "ElementNode", "element": element} for element in elements]
    graph = {
        "attributes": {},
        "default_node_attributes": {"x": 0.0, "y": 0.0, "z": 0.0, "element": None},
        "default_edge_attributes": {"modifiers": None, "contacts": None},
        "node": {str(i): {"element": element} for i, element in enumerate(elements)},
        "edge": {str(i): {} for i in range(len(elements))},
        "max_node": len(elements) - 1,
    }
    content: dict[str, Any] = {"transformation": None, "elements": elements, "materials": stones, "graph": graph}
    content["tree"] = {"attributes": {}, "root": {"name": "root", "children": children}}
    model = {"dtype": "compas_dem.models/BlockModel", "data": content, "inheritance": ["compas_model.models/Model"]}
    return json.dumps(model, indent=1) + "\n"
