"""The JSON of COMPAS: a model or problem of compas_dem, and an assembly of compas_assembly.

Both name the class of a part in `dtype` and keep it in `data`, as the serialisation of COMPAS 2 does. What reads a file
raises a ValueError with the path and what is wrong.
"""

from __future__ import annotations

import json
import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..blocks.polyhedron import Polyhedron
from .meshes import Mesh, plain, text_of


def guid_of(kind: str, name: object) -> str:
    """The identity of a part. The same part has the same one in each file."""
    return str(uuid.uuid5(uuid.NAMESPACE_URL, f"{kind} {name}"))


def held(kind: str, data: object, guid: str) -> dict[str, Any]:
    """A part, as COMPAS keeps it."""
    return {"dtype": kind, "data": data, "guid": guid}


def read_compas(path: Path) -> list[Mesh]:
    """The blocks of a file, each of which is a mesh, with their supports and the densities of their materials."""
    try:
        content = json.loads(text_of(path))["data"]
        content = content["model"]["data"] if "model" in content else content  # a problem up to compas_dem 0.5 has it
        assembled = "elements" not in content
        parts = content["graph"]["data"]["node"] if assembled else content["elements"]
        pairs = list(parts.items() if isinstance(parts, dict) else enumerate(parts))
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"path = {path} is not JSON, or is cut short: {error}") from None
    except (KeyError, TypeError):
        raise ValueError(
            f"path = {path} is not a COMPAS model: it has no data.elements, and no data.graph as an assembly has"
        ) from None
    materials = content.get("materials") or {}
    meshes = []
    for key, part in pairs:
        try:
            meshes.append(_block(part, key) if assembled else _element(part["data"], materials))
        except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as error:
            raise ValueError(
                f"path = {path}: the element {key} is not a block with a mesh: {type(error).__name__} {error}"
            ) from None
    if not meshes:
        raise ValueError(f"path = {path} is a COMPAS model without elements")
    return meshes


def _block(node: dict[str, Any], key: object) -> Mesh:
    """A block of an assembly, at a node of its graph."""
    return Mesh(f"block_{key}", *_shape(node["block"]["data"]), bool(node.get("is_support", False)))


def _shape(mesh: dict[str, Any]) -> tuple[Any, list[tuple[int, ...]]]:
    """Vertices [m] and faces of a mesh."""
    order = {key: i for i, key in enumerate(mesh["vertex"])}
    places = np.array([[float(vertex[axis]) for axis in "xyz"] for vertex in mesh["vertex"].values()])
    return places, [tuple(order[str(vertex)] for vertex in face) for face in mesh["face"].values()]


def _element(element: dict[str, Any], materials: dict[str, Any]) -> Mesh:
    """A block of a COMPAS model."""
    places, faces = _shape(element["geometry"]["data"])
    if element.get("transformation"):
        matrix = np.array(element["transformation"]["data"]["matrix"], dtype=float)
        places = places @ matrix[:3, :3].T + matrix[:3, 3]
    density = materials.get(str(element.get("material")), {}).get("data", {}).get("density")
    name = plain(str(element.get("name") or ""), "block")
    return Mesh(name, places, faces, bool(element.get("is_support", False)), density)


def model_guid(names: Sequence[str]) -> str:
    """The identity of the model of blocks, to which results refer."""
    return guid_of("model", "\n".join(names))


def compas_text(blocks: Sequence[Polyhedron], names: Sequence[str]) -> str:
    """Blocks as the JSON of a COMPAS model, without interactions. The same blocks give the same text."""
    densities = dict.fromkeys(block.density for block in blocks)

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
        stone = guid_of("density", block.density)
        inside: dict[str, Any] = {"transformation": None, "features": [], "name": name, "material": stone}
        inside |= {"geometry": {"dtype": "compas.datastructures/Mesh", "data": mesh}, "is_support": block.fixed}
        guid = guid_of("block", name)
        elements[guid] = held("compas_dem.elements/Block", inside, guid)
    stones = {
        guid: held("compas_dem.material/Stone", {"name": "Stone", "density": density}, guid)
        for guid, density in ((guid_of("density", density), density) for density in densities)
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
    model = held("compas_dem.models/BlockModel", content, model_guid(names))
    model["inheritance"] = ["compas_model.models/Model"]
    return json.dumps(model, indent=1) + "\n"
