"""The motion of bodies and the forces of joints as files of other programs.

The standard library is enough to write them.
* glTF 2.0, in one binary file: one JSON text and one buffer of numbers. Blender and viewers on the web open it. There y
  points upwards: x, y, z become x, z, -y.
* VTK, as series of files of XML, which ParaView opens.
* COMPAS, the `Results` of compas_dem 0.6, for its viewer and its Rhino plug-in: transformations by block, and by pair
  of blocks the polygon of their joint, the forces at its corners, gaps and status. Blocks are numbered as
  `Masonry.to_compas` writes them.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..contacts.files import quoted, replacing, write_text
from ..geometry.poses import rotations
from ..problem.masonry.blocks.joints_in_space import SpaceJoint
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.files.compas import guid_of, model_guid, part_entry
from ..quantities import Array, Integers, require_path
from .bodies import Body, without_jumps
from .forces import Forces

Json = dict[str, object]
"""An object in the text of a file."""
GLTF_FLOAT, GLTF_INTEGER = 5126, 5125
"""glTF's codes for numbers of 32 bits: floating point, and whole."""
VTK_POINT, VTK_POLYGON = 1, 7
"""VTK's numbers of kinds of cells."""
NEGLIGIBLE_FORCE = 1e-9
"""Normal force of a joint that carries none, over the largest of all [-]."""
SLIPS = 1 - 1e-6
"""Share of the friction from which a joint slides [-]."""


class Numbers:
    """The buffer of a file, and the tables of what it holds."""

    def __init__(self) -> None:
        self.data, self.views, self.accessors = bytearray(), list[Json](), list[Json]()

    def add(self, values: Array | Integers, kind: str, whole: bool = False) -> int:
        """Append values of a kind such as "VEC3", as numbers of 32 bits; returns the number of their accessor."""
        packed = np.ascontiguousarray(values, dtype="<u4" if whole else "<f4")
        rows = packed.reshape(len(packed), -1)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": packed.nbytes})
        table = {
            "bufferView": len(self.views) - 1,
            "componentType": GLTF_INTEGER if whole else GLTF_FLOAT,
            "count": len(packed),
        }
        ends = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(table | {"type": kind} | ends)
        self.data += packed.tobytes()
        return len(self.accessors) - 1


def upright(vectors: Array) -> Array:
    """Vectors in the axes of glTF, shape (..., 3)."""
    return vectors[..., [0, 2, 1]] * (1.0, 1.0, -1.0)


def turns(quaternions: Array) -> Array:
    """Unit quaternions with w first in the axes and the order of glTF, w last, without jumps of sign, shape (n, 4)."""
    smooth = without_jumps(quaternions)
    return np.column_stack([upright(smooth[:, 1:]), smooth[:, 0]])


def linear(colour: Array) -> list[float]:
    """A colour of a screen (sRGB) as the linear intensities that glTF takes (IEC 61966-2-1), 0 to 1."""
    parts = np.where(colour > 0.04045, ((colour + 0.055) / 1.055) ** 2.4, colour / 12.92)
    return [float(f"{part:.4g}") for part in parts]


def comments_text(record: Mapping[str, Json]) -> str:
    """A record as comments of a table, a line each. A text stands as it is, and all else as JSON."""
    texts = {name: value if isinstance(value, str) else json.dumps(value) for name, value in record.items()}
    return "".join(f"# {name}: {' '.join(text.split())}\n" for name, text in texts.items())


def write_gltf(path: str | Path, t: Array, bodies: list[Body], record: Json) -> Path:
    """Write bodies at their times [s] to a .glb, one node each; those that move are animated. A record is beside them.

    Raises:
        ValueError: for another ending.
        OSError: if the file cannot be written.
    """
    path = require_path("path", path)
    if path.suffix.lower() != ".glb":
        raise ValueError(f"path = {(path.name or str(path))!r} does not end in .glb")
    numbers, nodes, meshes = Numbers(), list[Json](), list[Json]()
    samplers, channels, colours = list[Json](), list[Json](), dict[tuple[float, ...], int]()
    times = numbers.add(t - t[0], "SCALAR")
    for node, body in enumerate(bodies):
        at = numbers.add(upright(body.corners), "VEC3")
        indices = numbers.add(np.ravel(body.triangles), "SCALAR", whole=True)
        colour = (*linear(body.colour), 1.0)
        material = colours.setdefault(colour, len(colours))
        part = {"attributes": {"POSITION": at}, "indices": indices, "material": material}
        meshes.append({"name": body.name, "primitives": [part]})
        places, turned = upright(body.rest + body.pose[:, :3]), turns(body.pose[:, 3:])
        start = {"translation": places[0].tolist(), "rotation": turned[0].tolist()}
        nodes.append({"name": body.name, "mesh": node} | start)
        moves = (("translation", places, "VEC3"), ("rotation", turned, "VEC4")) if body.moves else ()
        for property_moved, values, vector_type in moves:
            channels.append({"sampler": len(samplers), "target": {"node": node, "path": property_moved}})
            samplers.append({"input": times, "output": numbers.add(values, vector_type), "interpolation": "LINEAR"})
    text = {
        "asset": {"version": "2.0", "generator": "mjrock", "extras": record},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [
            {"name": f"tint {i}", "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0.0}}
            for colour, i in colours.items()
        ],
        "animations": [{"name": "motion", "samplers": samplers, "channels": channels}],
        "buffers": [{"byteLength": len(numbers.data)}],
        "bufferViews": numbers.views,
        "accessors": numbers.accessors,
    }
    written = json.dumps(text, separators=(",", ":")).encode()
    written += b" " * (-len(written) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(written) + len(numbers.data))
    with replacing(path) as partial, open(partial, "wb") as file:
        file.write(head + struct.pack("<I4s", len(written), b"JSON") + written)
        file.write(struct.pack("<I4s", len(numbers.data), b"BIN\0") + bytes(numbers.data))
    return path


def write_series(folder: str | Path, name: str, t: Array, texts: Sequence[str]) -> Path:
    """Write the text of each time [s] to a file of its own, and the .pvd that lists them, whose path is returned.

    Raises:
        OSError: if a file cannot be written.
    """
    folder = require_path("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for i, (time, text) in enumerate(zip(t.tolist(), texts, strict=True)):
        file = write_text(folder / f"{name}_{i:05d}.vtu", text)
        rows.append(f'<DataSet timestep="{time!r}" part="0" file={quoted(file.name)}/>')
    return write_text(folder / f"{name}.pvd", _file("Collection", "\n".join(rows)))


def texts_of_bodies(bodies: Sequence[Body], record: Json) -> list[str]:
    """The faces of the bodies at each of their times, with the displacement [m] and the velocity [m/s] of each corner,
    and with the number of the body, whether it is fixed and its colour, of three bytes, of each face. The first has a
    record too, since all say the same."""
    counts = np.cumsum([0, *(len(body.corners) for body in bodies)])
    faces = [tuple(counts[k] + i for i in face) for k, body in enumerate(bodies) for face in body.faces]
    sizes = [len(body.faces) for body in bodies]
    of_face = {"block": np.arange(len(bodies)), "fixed": np.array([int(body.fixed) for body in bodies])}
    of_face["colour"] = np.rint(255 * np.array([body.colour for body in bodies])).astype(np.uint8)
    cells = {name: np.repeat(values, sizes, axis=0) for name, values in of_face.items()}
    places = np.concatenate([body.placed(body.corners) for body in bodies], axis=1)
    at_rest = np.concatenate([body.rest + body.corners for body in bodies])
    rates = np.concatenate([body.rate(body.corners) for body in bodies], axis=1)
    return [
        _grid(at, faces, VTK_POLYGON, {"displacement": at - at_rest, "velocity": rate}, cells, {} if i else record)
        for i, (at, rate) in enumerate(zip(places, rates, strict=True))
    ]


def texts_of_joints(middles: Array, values: Mapping[str, Array]) -> list[str]:
    """Points in the middle of joints [m], shape (n, joints, 3), with values of the shapes (n, joints, ...)."""
    cells = [(i,) for i in range(middles.shape[1])]
    return [
        _grid(at, cells, VTK_POINT, {name: value[i] for name, value in values.items()}, {})
        for i, at in enumerate(middles)
    ]


def _grid(
    points: Array,
    cells: Sequence[tuple[int, ...]],
    kind: int,
    at_points: Mapping[str, Array],
    at_cells: Mapping[str, Array],
    record: Json | None = None,
) -> str:
    """The text of points and cells of one kind, with values at both, and with a record where there is one."""
    kinds = np.full(len(cells), kind, dtype=np.uint8)
    ends = np.cumsum([len(cell) for cell in cells])
    tables = {"connectivity": np.concatenate([np.array(cell) for cell in cells]), "offsets": ends, "types": kinds}
    shown = {"CellData": ' Scalars="colour"'} if "colour" in at_cells else {}
    parts = {"Points": {"Points": points}, "Cells": tables, "PointData": at_points, "CellData": at_cells}
    text = "\n".join(
        f"<{part}{shown.get(part, '')}>\n"
        + "\n".join(_array(name, array) for name, array in arrays.items())
        + f"\n</{part}>"
        for part, arrays in parts.items()
    )
    piece = f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n{text}\n</Piece>'
    if record:  # as bytes, since meshio reads no texts
        content = np.frombuffer(json.dumps(record).encode(), np.uint8)
        piece = f"<FieldData>\n{_array('answer', content, tuples=len(content))}\n</FieldData>\n{piece}"
    return _file("UnstructuredGrid", piece)


def _array(name: str, values: Array | NDArray[np.uint8], tuples: int = 0) -> str:
    """The element of an array. One of neither points nor cells has its number of tuples."""
    number_type = {"f": "Float64", "i": "Int64", "u": "UInt8"}[values.dtype.kind]
    wide = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    wide += f' NumberOfTuples="{tuples}"' if tuples else ""
    text = " ".join(f"{value:.12g}" for value in values.ravel().tolist())
    return f'<DataArray type="{number_type}" Name={quoted(name)}{wide} format="ascii">\n{text}\n</DataArray>'


def _file(kind: str, text: str) -> str:
    return (
        f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">\n'
        f"<{kind}>\n{text}\n</{kind}>\n</VTKFile>\n"
    )


def results_text(case: MasonryCase, bodies: list[Body], at: float, forces: Forces | None, sample: int) -> str:
    """The text of a file.

    Args:
        case: the problem.
        bodies: all blocks at one time.
        at: that time [s].
        forces: of the run, or None.
        sample: number of the sample of the forces.
    """
    names = case.masonry.names
    nodes = {str(i): {"transformation": _transformation(body, f"{names[i]} {at!r}")} for i, body in enumerate(bodies)}
    edges = {} if forces is None else dict(_edge(case, bodies, forces, sample, i) for i in range(len(forces.joints)))
    content = {
        "model_id": model_guid(names),
        "problem_id": guid_of("problem", repr(case.masonry)),
        "displacement_scale": 1.0,
        "node_data": nodes,
        "edge_data": edges,
        "metadata": {"solver": "mjrock", "time": at},
    }
    return json.dumps(part_entry("compas_dem.problem/Results", content, guid_of("results", at)), indent=1) + "\n"


def _transformation(body: Body, name: str) -> Json:
    """The transformation from the drawn to the present position of a body."""
    turn, matrix = rotations(body.pose)[0], np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, body.rest + body.pose[0, :3] - turn @ body.rest
    return part_entry("compas.geometry/Transformation", {"matrix": matrix.tolist()}, guid_of("transformation", name))


def _edge(case: MasonryCase, bodies: list[Body], forces: Forces, sample: int, number: int) -> tuple[str, Json]:
    """The key and the contact of a joint: the block above it comes first, and forces are those on it."""
    joint = case.masonry.joints[number]
    assert isinstance(joint, SpaceJoint)
    below, above = bodies[joint.below], bodies[joint.above]
    corners, met = (body.placed(joint.outline - body.rest)[0] for body in (below, above))
    normal, *along = below.turned(np.array([joint.normal, *joint.axes]))[0]
    place = (joint.outline - joint.middle) @ joint.axes.T
    pressed, slid = forces.normal[sample, number], forces.shear[sample, number]
    presses = pressed > NEGLIGIBLE_FORCE * forces.normal.max()
    shares = at_corners(place, forces.eccentricity[sample, number]) if presses else np.full(len(place), 1 / len(place))
    parts = {"normal": shares * pressed + 0.0}
    parts |= {f"tangent{i}": shares * part + 0.0 for i, part in enumerate(slid, 1)}
    total = pressed * normal + slid @ along
    slides = presses and np.linalg.norm(slid) >= SLIPS * case.masonry.joint_friction[number] * pressed
    frame = {"point": corners.mean(axis=0).tolist(), "xaxis": along[0].tolist(), "yaxis": along[1].tolist()}
    where = part_entry("compas.geometry/Frame", frame, guid_of("frame", joint.name))
    guids = [guid_of("point", (joint.name, i)) for i in range(len(corners))]
    points = [part_entry("compas.geometry/Point", *point) for point in zip(corners.tolist(), guids, strict=True)]
    rows = np.column_stack([*parts.values()]).tolist()
    at_points = [{"c_np": max(0.0, n), "c_nn": max(0.0, -n), "c_u": u, "c_v": v} for n, u, v in rows]
    contact = {"points": points, "frame": where, "size": joint.area, "mesh": None, "name": joint.name}
    contact["forces"] = at_points
    polygon = part_entry("compas.geometry/Polygon", {"points": corners.tolist()}, guid_of("polygon", joint.name))
    edge = {
        "face_contact": True,
        "edge_contact": False,
        "point_contact": False,
        "contact_polygon": polygon,
        "contact_points": corners.tolist(),
        "contact_frame": where,
        "contact_data": part_entry("compas_dem.interactions/FrictionContact", contact, guid_of("contact", joint.name)),
        **{f"force_{name}": part.tolist() for name, part in parts.items()},
        "force_point": (shares @ corners).tolist(),
        "resultant_global": total.tolist(),
        "resultant_local": [*slid.tolist(), float(pressed)],
        "force_magnitude": float(np.linalg.norm(total)),
        "gap": ((met - corners) @ normal).tolist(),
        "status": ["slide" if slides else "stick" if presses else "noctc"] * len(corners),
    }
    return f"{joint.above},{joint.below}", edge


def at_corners(corners: Array, eccentricity: Array) -> Array:
    """Shares of a force at corners, none of them negative, that add up to it and act where it does.

    They have the least sum of squares, where none of these pulls. A force beyond the outline, as on an
    edge that has slipped, is put on it.

    Args:
        corners: from the middle of the joint [m], shape (n, 2).
        eccentricity: of the force from there [m], shape (2,).
    """
    conditions = np.vstack([np.ones(len(corners)), corners.T / np.abs(corners).max()])
    resultant = np.append(1.0, eccentricity / np.abs(corners).max())
    shares = np.linalg.lstsq(conditions, resultant)[0]
    if shares.min() < 0:
        from scipy.optimize import nnls  # takes half a second, and is seldom needed

        shares = nnls(conditions, resultant)[0]
    return np.asarray(shares / shares.sum())
