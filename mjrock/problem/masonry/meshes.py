"""Meshes of bodies, and the convex blocks that they bound."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...quantities import Array
from .polyhedron import Polyhedron

SAME_VOLUME = 1e-3
"""Largest difference of the volume of a body from that of its hull, over the latter [-]."""

Faces = list[tuple[int, ...]]


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
    faces: Faces
    fixed: bool = False
    density: float | None = None


def bodies_of(mesh: Mesh) -> list[Mesh]:
    """The closed bodies of a mesh; those of one mesh are numbered. A ValueError says if one is open.

    Faces are taken in their order. They are a body as soon as every edge belongs to two of them, so that bodies which
    touch are told apart where they are written one after the other. What is closed together and hangs together nowhere
    is divided.
    """
    places, number = np.unique(mesh.vertices + 0.0, axis=0, return_inverse=True)
    faces = [tuple(number.ravel()[list(face)].tolist()) for face in mesh.faces]
    faces = [face for face in faces if len(set(face)) == len(face)]
    parts: list[Faces] = [[]]
    open_edges: set[tuple[int, int]] = set()
    for face in faces:
        parts[-1].append(face)
        for i, j in zip(face, face[1:] + face[:1], strict=True):
            open_edges ^= {(min(i, j), max(i, j))}
        if not open_edges:
            parts.append([])
    if open_edges:
        raise ValueError(f"body {mesh.name} is open: {len(open_edges)} of its edges belong to one face alone")
    shells = [shell for part in parts if part for shell in _apart(part, len(places))]
    if not shells:
        raise ValueError(f"body {mesh.name} has no faces")
    bodies = []
    for i, shell in enumerate(shells):
        used = sorted({vertex for face in shell for vertex in face})
        where = {vertex: k for k, vertex in enumerate(used)}
        name = mesh.name if len(shells) == 1 else f"{mesh.name}_{i}"
        rings = [tuple(where[vertex] for vertex in face) for face in shell]
        bodies.append(mesh._replace(name=name, vertices=places[used], faces=rings))
    return bodies


def _apart(faces: Faces, count: int) -> Iterator[Faces]:
    """Faces by the parts that share no vertex."""
    pairs = np.array([(face[0], vertex) for face in faces for vertex in face])
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    labels = connected_components(graph, directed=False)[1]
    for label in dict.fromkeys(labels[face[0]] for face in faces):
        yield [face for face in faces if labels[face[0]] == label]


def block_of(body: Mesh, density: float, fixed: bool) -> Polyhedron:
    """The convex block that a closed body is; a ValueError with its name says if it is none."""
    try:
        block = Polyhedron(body.vertices, density if body.density is None else body.density, fixed, body.name)
    except (ValueError, TypeError) as error:
        raise ValueError(f"body {body.name}: {error}") from None
    # about a point inside, the tetrahedra of a convex body fill it once, whichever way its faces turn
    triangles = np.array([(face[0], i, j) for face in body.faces for i, j in pairwise(face[1:])])
    volume = float(np.abs(np.linalg.det(body.vertices[triangles] - block.centroid)).sum()) / 6
    if abs(volume / block.volume - 1) > SAME_VOLUME:
        raise ValueError(
            f"body {body.name} is not convex: its faces enclose {volume:.4g} m3, and their hull {block.volume:.4g} m3; "
            "cut it into convex blocks"
        )
    return block


def blocks_of(meshes: Sequence[Mesh], density: float, fixed: Sequence[str]) -> list[Polyhedron]:
    """The blocks of meshes; names that several have are numbered.

    The density is that of meshes whose file says none [kg/m3]. Fixed are the names given, and what a file calls a
    support. A ValueError says which body is open or not convex, or which name no body has.
    """
    bodies = [body for mesh in meshes for body in bodies_of(mesh)]
    count = Counter(body.name for body in bodies)
    numbered = [body.name if count[body.name] == 1 else f"{body.name}_{i}" for i, body in enumerate(bodies)]
    for name in fixed:
        if name not in numbered:
            raise ValueError(f"fixed = {name!r} is no body; there are {', '.join(numbered[:10])}")
    return [
        block_of(body._replace(name=name), density, body.fixed or name in fixed)
        for body, name in zip(bodies, numbered, strict=True)
    ]
