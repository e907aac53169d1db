"""The JSON of COMPAS: a model or problem of compas_dem, and an assembly of compas_assembly.

Both name the class of a part in `dtype` and keep it in `data`, as the serialisation of COMPAS 2 does. A file that
cannot be read raises a ValueError with what is wrong.
"""

from __future__ import annotations

import json
import uuid
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..blocks.polyhedron import Polyhedron
from .bodies import AnyPath, Mesh, block_name
from .meshes import file_text

Part = dict[str, Any]
"""A part of a file, as JSON has it."""


def guid_of(kind: str, name: object) -> str:
    """The identity of a part. The same part has the same one in each file."""
    return str(uuid.uuid5(uuid.NAMESPACE_URL, f"{kind} {name}"))


def part_entry(kind: str, data: object, guid: str) -> dict[str, object]:
    """A part, as COMPAS keeps it."""
    return {"dtype": kind, "data": data, "guid": guid}


def read_compas(path: AnyPath) -> list[Mesh]:
    """Blocks of a JSON file of COMPAS: a `BlockModel` of compas_dem, a problem that holds one, an `Assembly` of
    compas_assembly, also of COMPAS 0 and 1, or a list of meshes. Its supports are fixed.

    Args:
        path: of the file. The density of the material of a block replaces `density`.
    """
    try:
        content = _data_of(json.loads(file_text(path)))
        content = _data_of(content["model"]) if "model" in content else content  # a problem up to compas_dem 0.5 has it
        pairs = _parts(content)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"it is not JSON, or is cut short: {error}") from None
    except (KeyError, TypeError, AttributeError):
        raise ValueError(
            "it is not a COMPAS model: it has no data.elements, no data.graph as an assembly, and is no list of meshes"
        ) from None
    materials = content.get("materials") or {} if isinstance(content, dict) else {}
    meshes = []
    for key, part in pairs:
        try:
            meshes.append(_block(_data_of(part), key, materials))
        except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError):
            raise ValueError(
                f"the element {key} is not a block with a mesh, which has x, y and z of each vertex, and faces that "
                "list their vertices"
            ) from None
    if not meshes:
        raise ValueError("it is a COMPAS model without elements")
    return meshes


def _data_of(part: object) -> Any:
    """What a part of a file holds: under `data` since COMPAS 2, under `value` before, and at times in a list of one."""
    while True:
        if isinstance(part, list) and len(part) == 1:
            part = part[0]
        elif isinstance(part, dict) and ("dtype" in part or "datatype" in part or set(part) == {"data"}):
            part = part["data"] if "data" in part else part["value"]
        else:
            return part


def _parts(content: Part | list[Part]) -> list[tuple[object, Part]]:
    """The blocks of a model, an assembly or a list with their keys, or the only one.

    Assemblies are graphs whose nodes hold the blocks. Those of COMPAS 0 are blocks beside a network, which has the
    supports.
    """
    if isinstance(content, list):
        if not all(isinstance(_data_of(part), dict) for part in content):
            raise TypeError
        return list(enumerate(content))
    if "vertex" in content and "face" in content:
        return [(0, content)]
    if "elements" in content:
        parts = content["elements"]
        return list(parts.items() if isinstance(parts, dict) else enumerate(parts))
    if "blocks" in content:
        network = content.get("assembly") or {}
        nodes, blocks = network.get("node") or network.get("vertex") or {}, content["blocks"]
        pairs = list(blocks.items() if isinstance(blocks, dict) else enumerate(blocks))
        return [(key, {"block": block, **(nodes.get(str(key)) or {})}) for key, block in pairs]
    return list((_data_of(content["graph"]) if "graph" in content else content)["node"].items())


def _block(part: Part, key: object, materials: Part) -> Mesh:
    """A block: an element of a model, a node of an assembly, or a mesh."""
    entry = next((name for name in ("geometry", "shape", "block") if name in part), None)
    shape = _data_of(part if entry is None else part[entry])
    order = {str(vertex): i for i, vertex in enumerate(shape["vertex"])}
    places = np.array([[float(vertex[axis]) for axis in "xyz"] for vertex in shape["vertex"].values()])
    faces = [tuple(order[str(vertex)] for vertex in face) for face in shape["face"].values()]
    if part.get("transformation"):
        matrix = np.array(_data_of(part["transformation"])["matrix"], dtype=float)
        places = places @ matrix[:3, :3].T + matrix[:3, 3]
    density = _data_of(materials.get(str(part.get("material")), {})).get("density")
    name = block_name(str(part.get("name") or ""), "block" if entry == "geometry" else f"block_{key}")
    return Mesh(name, places, faces, bool(part.get("is_support", False)), density)


def model_guid(names: Sequence[str]) -> str:
    """The identity of the model of blocks, to which results refer."""
    return guid_of("model", "\n".join(names))


def compas_text(blocks: Sequence[Polyhedron], names: Sequence[str]) -> str:
    """Blocks as the JSON of a COMPAS model, without interactions. The same blocks give the same text."""
    densities = dict.fromkeys(block.density for block in blocks)

    elements: dict[str, object] = {}
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
        inside: dict[str, object] = {"transformation": None, "features": [], "name": name, "material": stone}
        inside |= {"geometry": {"dtype": "compas.datastructures/Mesh", "data": mesh}, "is_support": block.fixed}
        guid = guid_of("block", name)
        elements[guid] = part_entry("compas_dem.elements/Block", inside, guid)
    stones = {
        guid: part_entry("compas_dem.material/Stone", {"name": "Stone", "density": density}, guid)
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
    content: dict[str, object] = {"transformation": None, "elements": elements, "materials": stones, "graph": graph}
    content["tree"] = {"attributes": {}, "root": {"name": "root", "children": children}}
    model = part_entry("compas_dem.models/BlockModel", content, model_guid(names))
    model["inheritance"] = ["compas_model.models/Model"]
    return json.dumps(model, indent=1) + "\n"
