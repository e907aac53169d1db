"""The motion of bodies as glTF 2.0 in one binary file, which Blender and viewers on the web open.

The standard library is enough: a file is one JSON text and one buffer of numbers, which another library would need too.
In glTF y points upwards: x, y, z become x, z, -y.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np

from ..files import replacing
from ..quantities import Array, Integers, require_path
from .bodies import Body

Json = dict[str, object]
"""An object in the text of the file."""
GLTF_FLOAT, GLTF_INTEGER = 5126, 5125
"""glTF's codes for numbers of 32 bits: floating point, and whole."""


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
    along = (quaternions[1:] * quaternions[:-1]).sum(axis=1)
    signs = np.cumprod(np.append(1.0, np.where(along < 0, -1.0, 1.0)))
    smooth = quaternions * signs[:, None]
    return np.column_stack([upright(smooth[:, 1:]), smooth[:, 0]])


def linear(colour: Array) -> list[float]:
    """A colour as a screen shows it, in the parts of light of which glTF makes it (IEC 61966-2-1), 0 to 1."""
    parts = np.where(colour > 0.04045, ((colour + 0.055) / 1.055) ** 2.4, colour / 12.92)
    return [float(f"{part:.4g}") for part in parts]


def write_gltf(path: str | Path, t: Array, bodies: list[Body]) -> Path:
    """Write bodies at their times [s] to a .glb, one node each; those that move are animated.

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
        for what, values, kind in moves:
            channels.append({"sampler": len(samplers), "target": {"node": node, "path": what}})
            samplers.append({"input": times, "output": numbers.add(values, kind), "interpolation": "LINEAR"})
    text = {
        "asset": {"version": "2.0", "generator": "mjrock"},
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
