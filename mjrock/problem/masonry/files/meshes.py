"""Files of meshes: Wavefront OBJ, STL and PLY.

A file that cannot be read raises a ValueError with the line, where there is one, and what is wrong.
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ....quantities import Array
from ..blocks.polyhedron import Polyhedron
from .bodies import AnyPath, Mesh, block_name, used

MOST_BYTES = 500_000_000
"""Largest file that is read."""


def bytes_of(path: AnyPath) -> bytes:
    """What a file holds, which is not empty and at most 500 MB."""
    path = Path(path)
    if not path.is_file():
        raise ValueError("it is not a file")
    size = path.stat().st_size
    if not 0 < size <= MOST_BYTES:
        raise ValueError(f"it has {size} bytes; the valid range is 1 to {MOST_BYTES}")
    return path.read_bytes()


def file_text(path: AnyPath) -> str:
    """What a text file holds."""
    try:
        return bytes_of(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("it is not text: it holds bytes that are not UTF-8") from None


def read_obj(path: AnyPath) -> list[Mesh]:
    """Blocks of a Wavefront OBJ file: its objects, or the groups of them, in their order.

    Every body has to be closed, and to touch another within the `tolerance`. A support may be an open plate: it
    becomes a fixed block behind its face, a tenth of its extent thick.

    Args:
        path: of the file. Several bodies of one object are numbered.
    """
    vertices: list[tuple[float, ...]] = []
    faces: dict[tuple[str, str], list[tuple[int, ...]]] = {}
    label, group = "", ""
    for count, line in enumerate(file_text(path).replace("\\\n", " ").splitlines(), 1):
        keyword, _, content = line.partition("#")[0].strip().partition(" ")
        try:
            if keyword == "v":
                vertices.append(_triple(content.split()[:3]))
            elif keyword == "f":
                corners = [int(corner.split("/")[0]) for corner in content.split()]
                face = tuple(i - 1 if i > 0 else len(vertices) + i for i in corners)
                if len(face) < 3 or 0 in corners or not all(0 <= i < len(vertices) for i in face):
                    raise ValueError
                faces.setdefault((label, group), []).append(face)
            elif keyword == "o":
                label, group = content.strip(), ""
            elif keyword == "g":
                group = content.strip()
        except ValueError:
            raise ValueError(f"line {count}: {line[:60]!r} is not a vertex or face of an OBJ file") from None
    if not faces:
        raise ValueError("it has no faces: it is not an OBJ file, or is cut short")
    groups_of = Counter(label for label, _ in faces)
    places, meshes = np.array(vertices), []
    for i, ((label, group), ring) in enumerate(faces.items()):
        name = label if label and groups_of[label] == 1 else "_".join(part for part in (label, group) if part)
        meshes.append(Mesh(block_name(name, f"body_{i}"), *used(places, ring)))
    return meshes


def read_stl(path: AnyPath) -> list[Mesh]:
    """Blocks of an STL file, binary or text: its solids, or the closed bodies that it lists one after the other.

    Args:
        path: of the file. Bodies without a name are `body_0` and so on.
    """
    content = bytes_of(path)
    facets = struct.unpack_from("<I", content, 80)[0] if len(content) >= 84 else -1
    if facets >= 0 and len(content) == 84 + 50 * facets:
        records = np.frombuffer(content, np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
        return [_facets("body", records["v"].reshape(-1, 3).astype(float))]
    if content.lstrip()[:5].lower() != b"solid" or b"facet" not in content:
        needed = f"; its head promises {facets} facets, {84 + 50 * facets} bytes" if 0 <= facets < 10**7 else ""
        raise ValueError(f"it is not an STL file, or is cut short: it has {len(content)} bytes{needed}")
    meshes: list[Mesh] = []
    name, is_open = "body", False
    corners: list[tuple[float, float, float]] = []
    for count, line in enumerate(file_text(path).splitlines(), 1):
        words = line.split()
        keyword = words[0].lower() if words else ""
        if keyword == "solid":
            name, corners, is_open = block_name(" ".join(words[1:]), f"body_{len(meshes)}"), [], True
        elif keyword == "vertex":
            try:
                corners.append(_triple(words[1:]))
            except ValueError:
                raise ValueError(f"line {count}: {line[:60]!r} is not a vertex of an STL file") from None
        elif keyword in ("endfacet", "endsolid") and len(corners) % 3:
            raise ValueError(f"line {count}: a facet of an STL file has three vertices")
        elif keyword == "endsolid":
            meshes.append(_facets(name, np.reshape(corners, (-1, 3))))
            is_open = False
    if is_open or not meshes:
        raise ValueError(f"it is cut short: the solid {name} does not end")
    return meshes


PLY = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8",
}  # fmt: skip
"""Types of numbers in PLY files, as NumPy names them."""
PLY_ORDER = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def read_ply(path: AnyPath) -> list[Mesh]:
    """Blocks of a PLY file, binary or text: the closed bodies that it lists one after the other.

    Args:
        path: of the file. Bodies are `body_0` and so on, or `body` where there is one.
    """
    content = bytes_of(path)
    head, end, body = content.partition(b"end_header")
    lines = [line.split() for line in head.decode("latin-1").splitlines()]
    if not end or not lines or lines[0] != ["ply"]:
        raise ValueError("it is not a PLY file, or is cut short: it has no header from ply to end_header")
    try:
        elements = _elements(lines)
        if not elements.get("face", (0,))[0]:
            raise ValueError("it has no faces, as a cloud of points")
        order = PLY_ORDER[next(line[1] for line in lines if line[:1] == ["format"])]
        take = _words(body) if not order else _numbers(body[body.index(b"\n") + 1 :], order)
        for name, (count, _) in elements.items():
            if not 0 <= count <= len(content):
                raise ValueError(f"{count} of {name} in {len(content)} bytes")
        rows = {name: [_row(take, properties) for _ in range(count)] for name, (count, properties) in elements.items()}
        places = np.array([[row[axis][0] for axis in "xyz"] for row in rows["vertex"]])
        key = "vertex_indices" if "vertex_indices" in rows["face"][0] else "vertex_index"
        faces = [tuple(map(int, row[key])) for row in rows["face"]]
        if not all(len(face) > 2 and min(face) >= 0 and max(face) < len(places) for face in faces):
            raise ValueError("a face is not three or more of the vertices")
    except (KeyError, IndexError, ValueError, TypeError, OverflowError, StopIteration, struct.error) as error:
        cause = f": {error}" if type(error) is ValueError else ""
        raise ValueError(f"it is not a PLY file of faces, or is cut short{cause}") from None
    return [Mesh("body", places, faces)]


def _elements(lines: Sequence[list[str]]) -> dict[str, tuple[int, list[list[str]]]]:
    """How many rows each element of a PLY file has, and its properties, each as its types and its name.

    Two properties may have the same name. Each has its place in a row, and the last is read.
    """
    elements: dict[str, tuple[int, list[list[str]]]] = {}
    name = ""
    for line in lines:
        if line[:1] == ["element"]:
            name = line[1]
            elements[name] = int(line[2]), []
        elif line[:1] == ["property"]:
            elements[name][1].append(line[1:])
    return elements


def _row(take: Callable[[str], float], properties: Sequence[list[str]]) -> dict[str, list[float]]:
    """A row of a PLY file: of each property one number, or a list with its length before it."""
    row = {}
    for kind, *of_list, name in properties:
        row[name] = [take(of_list[1]) for _ in range(int(take(of_list[0])))] if of_list else [take(kind)]
    return row


def _words(body: bytes) -> Callable[[str], float]:
    """What takes number after number from the text of a PLY file."""
    words = iter(body.split())
    return lambda _: float(next(words))


def _numbers(body: bytes, order: str) -> Callable[[str], float]:
    """What takes number after number of a type from the bytes of a PLY file."""
    at = 0

    def take(kind: str) -> float:
        nonlocal at
        code = np.dtype(order + PLY[kind])
        value = struct.unpack_from(order + code.char, body, at)[0]
        at += code.itemsize
        return float(value)

    return take


def _facets(name: str, corners: Array) -> Mesh:
    """A mesh of triangles, from three vertices each."""
    return Mesh(name, corners, [(i, i + 1, i + 2) for i in range(0, len(corners), 3)])


def _triple(words: Sequence[str]) -> tuple[float, float, float]:
    x, y, z = map(float, words)
    return x, y, z


def obj_text(blocks: Sequence[Polyhedron], names: Sequence[str]) -> str:
    """Blocks as the text of an OBJ file, one object each.

    Raises:
        ValueError: for a block whose name it cannot hold.
    """
    lines, before = ["# metres, z upwards"], 1
    for block, name in zip(blocks, names, strict=True):
        if "#" in name or name.endswith("\\") or name.strip() != name:
            raise ValueError(
                f"the block {name!r} has a # in its name, a backslash at its end or a blank at an end, "
                "which no OBJ file holds"
            )
        lines.append(f"o {name}")
        lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in block.vertices]
        lines += ["f " + " ".join(str(before + i) for i in face) for face in block.faces]
        before += len(block.vertices)
    return "\n".join(lines) + "\n"
