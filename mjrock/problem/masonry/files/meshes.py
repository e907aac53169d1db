"""Meshes of bodies, the convex blocks that they bound, and their files: Wavefront OBJ and STL.

What reads a file raises a ValueError with the path, the line where there is one, and what is wrong.
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ....geometry.graph import components
from ....quantities import Array
from ..blocks.polyhedron import Polyhedron
from ..builders.in_plane import MOST_BLOCKS

SAME_VOLUME = 1e-3
"""Largest difference of the volume of a body from that of its hull, over the latter [-]."""

MeshFaces = list[tuple[int, ...]]


class Mesh(NamedTuple):
    """Faces between vertices, of one body or of several.

    Args:
        name: of the mesh in its file.
        vertices: [m], shape (n, 3).
        faces: numbers of the vertices of each, in order around it.
        fixed: whether the file says that it is a support.
        density: what the file says [kg/m3], or None.
    """

    name: str
    vertices: Array
    faces: MeshFaces
    fixed: bool = False
    density: float | None = None


def used(vertices: Array, faces: MeshFaces) -> tuple[Array, MeshFaces]:
    """The vertices that faces use, in their order, and the faces with the new numbers of them."""
    numbers = sorted({vertex for face in faces for vertex in face})
    where = {vertex: i for i, vertex in enumerate(numbers)}
    return vertices[numbers], [tuple(where[vertex] for vertex in face) for face in faces]


def bodies_of(mesh: Mesh) -> list[Mesh]:
    """The closed bodies of a mesh; those of one mesh are numbered. A ValueError says if one is open, or they are many.

    Faces are taken in their order. They are a body as soon as every edge belongs to two of them, so that bodies which
    touch are told apart where they are written one after the other. What is closed together and hangs together nowhere
    is divided.
    """
    places, inverse = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)
    number = inverse.ravel().tolist()
    faces = [tuple(number[i] for i in face) for face in mesh.faces]
    faces = [face for face in faces if len(set(face)) == len(face)]
    parts: list[int] = []  # of each face
    open_edges: set[tuple[int, int]] = set()
    part = 0
    for face in faces:
        parts.append(part)
        for i, j in zip(face, face[1:] + face[:1], strict=True):
            open_edges ^= {(min(i, j), max(i, j))}
        part += not open_edges
        if part > MOST_BLOCKS:
            raise ValueError(f"body {mesh.name} is more than {MOST_BLOCKS} closed bodies, which is the most")
    if open_edges:
        raise ValueError(f"body {mesh.name} is open: {len(open_edges)} of its edges belong to one face alone")
    shells = _apart(faces, parts)
    if not shells:
        raise ValueError(f"body {mesh.name} has no faces")
    bodies = []
    for i, shell in enumerate(shells):
        name = mesh.name if len(shells) == 1 else f"{mesh.name}_{i}"
        vertices, rings = used(places, shell)
        bodies.append(mesh._replace(name=name, vertices=vertices, faces=rings))
    return bodies


def _apart(faces: MeshFaces, parts: list[int]) -> list[MeshFaces]:
    """Faces by the bodies that they make: those of one part that hang together by their vertices."""
    own: dict[tuple[int, int], int] = {}  # a vertex counts once in each part
    pairs = []
    for face, part in zip(faces, parts, strict=True):
        numbers = [own.setdefault((part, vertex), len(own)) for vertex in face]
        pairs += [(numbers[0], number) for number in numbers]
    if not pairs:
        return []
    labels = components(pairs, len(own)).tolist()
    shells: dict[int, MeshFaces] = {}
    for face, part in zip(faces, parts, strict=True):
        shells.setdefault(labels[own[part, face[0]]], []).append(face)
    return list(shells.values())


def block_of(body: Mesh, density: float, fixed: bool) -> Polyhedron:
    """The convex block that a closed body is; a ValueError with its name says if it is not one."""
    try:
        block = Polyhedron(body.vertices, density if body.density is None else body.density, fixed, body.name)
    except (ValueError, TypeError) as error:
        raise ValueError(f"body {body.name}: {error}") from None
    # about a point inside, the tetrahedra of a convex body fill it once, whichever way its faces turn
    triangles = np.array([(face[0], i, j) for face in body.faces for i, j in pairwise(face[1:])])
    volume = float(np.abs(np.linalg.det(body.vertices[triangles] - block.centroid)).sum()) / 6
    if abs(volume / block.volume - 1) > SAME_VOLUME:
        raise ValueError(
            f"body {body.name} is not convex: its faces enclose {enclosed_by(body):.4g} m3 within their hull of "
            f"{block.volume:.4g} m3; cut it into convex blocks"
        )
    return block


def enclosed_by(body: Mesh) -> float:
    """Volume that the faces of a closed body enclose, convex or not, whichever way they turn [m3]."""
    faces = list(body.faces)
    of_edge: dict[frozenset[int], list[int]] = {}
    for number, face in enumerate(faces):
        for edge in edges_of(face):
            of_edge.setdefault(frozenset(edge), []).append(number)
    seen, open_ends = {0}, [0]
    while open_ends:
        number = open_ends.pop()
        for edge in edges_of(faces[number]):
            for other in of_edge[frozenset(edge)]:
                if other not in seen:  # beside a face that turns the same way, an edge is passed the other way
                    faces[other] = faces[other][::-1] if edge in edges_of(faces[other]) else faces[other]
                    seen.add(other)
                    open_ends.append(other)
    triangles = np.array([(face[0], i, j) for face in faces for i, j in pairwise(face[1:])])
    return abs(float(np.linalg.det(body.vertices[triangles] - body.vertices.mean(axis=0)).sum())) / 6


def edges_of(face: tuple[int, ...]) -> list[tuple[int, int]]:
    """The edges of a face, in its order."""
    return list(zip(face, (*face[1:], face[0]), strict=True))


def blocks_of(meshes: Sequence[Mesh], density: float, fixed: Sequence[str]) -> list[Polyhedron]:
    """The blocks of meshes; names that several have are numbered.

    The density is that of meshes whose file says none [kg/m3]. Fixed are the names given, and what a file calls a
    support. A ValueError says which body is open or not convex, or which name no body has.
    """
    bodies = [body for mesh in meshes for body in bodies_of(mesh)]
    count = Counter(body.name for body in bodies)
    numbered = [body.name if count[body.name] == 1 else f"{body.name}_{i}" for i, body in enumerate(bodies)]
    for name, times in Counter(fixed).items():
        if times > 1:
            raise ValueError(f"fixed has {name!r} {times} times; each body is named once")
        if name not in numbered:
            raise ValueError(f"fixed = {name!r} is not a body; there are {', '.join(numbered[:10])}")
    return [
        block_of(body._replace(name=name), density, body.fixed or name in fixed)
        for body, name in zip(bodies, numbered, strict=True)
    ]


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
