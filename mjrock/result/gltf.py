"""glTF: the bodies of a run as nodes with an animation, for Blender, three.js and the viewers of operating systems."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..files import replacing, writer
from ..quantities import Array, require_path
from .response import Response
from .shapes import MovingShapes

FLOAT, UNSIGNED = 5126, 5125
VERTICES, INDICES = 34962, 34963
"""Kinds of numbers and of their use, as the standard numbers them."""
UPRIGHT = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]
"""Quaternion, w last, that turns z upwards into y upwards, as glTF has it."""
COLOURS = ([0.83, 0.62, 0.49, 1.0], [0.74, 0.74, 0.74, 1.0])
"""Of what moves and of what is fixed."""


class Buffer:
    """The binary part of a file, and where each array is in it."""

    def __init__(self, gltf: Any) -> None:
        self.gltf, self.data = gltf, b""

    def add(self, values: Array, kind: str, use: int | None = None) -> int:
        """Append an array; the number of its accessor."""
        gltf, number = self.gltf, UNSIGNED if use == INDICES else FLOAT
        stored = np.ascontiguousarray(values, dtype=np.uint32 if use == INDICES else np.float32)
        rows = stored.reshape(len(stored), -1)
        gl, size = writer("pygltflib", "export"), stored.nbytes
        gltf.bufferViews.append(gl.BufferView(buffer=0, byteOffset=len(self.data), byteLength=size, target=use))
        gltf.accessors.append(
            gl.Accessor(
                bufferView=len(gltf.bufferViews) - 1,
                componentType=number,
                count=len(rows),
                type=kind,
                min=rows.min(axis=0).tolist(),
                max=rows.max(axis=0).tolist(),
            )
        )
        self.data += stored.tobytes()
        return len(gltf.accessors) - 1


def write_gltf(response: Response, path: str | Path, fps: float) -> Path:
    """Write a .glb, see `Response.to_gltf`."""
    gl, path = writer("pygltflib", "export"), require_path("path", path)
    if path.suffix != ".glb":
        raise ValueError(f"path = {str(path)!r} does not end with .glb, which is the one file that glTF has")
    moving = MovingShapes.of(response, fps)
    gltf = gl.GLTF2(asset=gl.Asset(generator="mjrock"), scene=0, scenes=[gl.Scene(nodes=[0])])
    gltf.materials = [
        gl.Material(pbrMetallicRoughness=gl.PbrMetallicRoughness(baseColorFactor=colour, metallicFactor=0.0))
        for colour in COLOURS
    ]
    buffer, animation = Buffer(gltf), gl.Animation(name="motion")
    gltf.nodes.append(gl.Node(name="z upwards", rotation=UPRIGHT))
    moved, turned = moving.motion
    times = buffer.add(moving.t - moving.t[0], "SCALAR")
    for i, shape in enumerate(moving.shapes):
        facets = shape.corners[shape.triangles].reshape(-1, 3)  # corners of their own, so that faces are flat
        primitive = gl.Primitive(
            attributes=gl.Attributes(POSITION=buffer.add(facets, "VEC3", VERTICES)),
            indices=buffer.add(np.arange(len(facets))[:, None], "SCALAR", INDICES),
            material=int(shape.fixed),
        )
        gltf.meshes.append(gl.Mesh(name=shape.name, primitives=[primitive]))
        places, turns = shape.rest + moved[:, i], np.roll(turned[:, i], -1, axis=1)
        place, turn = places[0].tolist(), turns[0].tolist()
        gltf.nodes.append(gl.Node(name=shape.name, mesh=i, translation=place, rotation=turn))
        for values, kind, what in ((places, "VEC3", "translation"), (turns, "VEC4", "rotation")):
            if len(values) > 1 and np.ptp(values, axis=0).any():
                target = gl.AnimationChannelTarget(node=i + 1, path=what)
                animation.channels.append(gl.AnimationChannel(sampler=len(animation.samplers), target=target))
                animation.samplers.append(gl.AnimationSampler(input=times, output=buffer.add(values, kind)))
    gltf.nodes[0].children = list(range(1, len(gltf.nodes)))
    gltf.animations = [animation] if animation.channels else []
    gltf.buffers = [gl.Buffer(byteLength=len(buffer.data))]
    gltf.set_binary_blob(buffer.data)
    with replacing(path) as partial:
        gltf.save_binary(str(partial))
    return path
