"""Files of meshes: Wavefront OBJ and STL.

What reads a file raises a ValueError with the path, the line where there is one, and what is wrong.
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ....quantities import Array
from ..blocks.polyhedron import Polyhedron
from .meshes import Mesh, used

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
        meshes.append(Mesh(plain(name, f"body_{i}"), *used(places, ring)))
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
            name, corners, is_open = plain(" ".join(words[1:]), f"body_{len(meshes)}"), [], True
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


def plain(name: str, otherwise: str) -> str:
    """A name that a block can have."""
    name = name.strip().replace("|", "_")
    return otherwise if name in ("", "world") else name


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
