"""Bodies that meshes bound, in which unit and with which axes they are drawn, and the blocks that they become."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from operator import index
from os import PathLike
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....geometry.graph import connected_parts
from ....geometry.hull import THINNEST, Hull, bulk_of, face_edges, hull_of, triangles_of
from ....geometry.parts import convex_parts
from ....quantities import (
    Array,
    Density,
    Within,
    named,
    require_flag,
    require_one_of,
    require_reals,
    require_text,
    shown,
    warn_of,
)
from ..blocks.compound import Compound, SolidBlock
from ..blocks.polygon import MOST_VERTICES, require_near
from ..blocks.polyhedron import Polyhedron
from ..builders.in_plane import MOST_BODIES

SAME_VOLUME = 1e-3
"""Largest difference of the volume of a body from that of its hull, over the latter [-]."""
SAME_PLANE = 1e-2
"""Largest distance of a face of a body from a face of its hull, over the extent of the body [-]."""
SPLINTER = 1e-4
"""Volume of a part below which it is left out, over that of the body [-]."""
MOST_CUTS = 64
"""Most parts that a body is cut into."""
PLATE_THICKNESS = 0.1
"""Thickness of a support that is drawn as an open plate, over its extent [-]."""
LENGTH_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
"""Length of the units that files are drawn in [m]."""
UPWARDS = {
    "x": ((0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)),
    "y": ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
    "z": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
}
"""Rotations that turn an axis of a file upwards."""
CONVEX = ("hull", "parts")
"""What a body that is not convex can become."""

AnyPath = str | PathLike[str]
MeshFaces = list[tuple[int, ...]]
Scale = Annotated[float | None, Within(1e-6, 1e3, "m")]
"""Length of a unit of a file."""


class Mesh(NamedTuple):
    """Faces between vertices, of one body or of several.

    Args:
        name: of the mesh in its file.
        vertices: [m], shape (n, 3).
        faces: numbers of the vertices of each, in order around it.
        fixed: whether the file marks it as a support.
        density: that of the file [kg/m3], or None.
    """

    name: str
    vertices: Array
    faces: MeshFaces
    fixed: bool = False
    density: float | None = None


@contextmanager
def about(subject: str, errors: tuple[type[Exception], ...] = (ValueError,)) -> Iterator[None]:
    """An error that is raised within becomes a ValueError that names a file or body first."""
    try:
        yield
    except errors as error:
        raise ValueError(f"{subject}: {error}") from None


@dataclass(frozen=True)
class FileOptions:
    """The arguments that describe a file.

    Args:
        fixed: names of bodies that are fixed, beside those that the file marks as supports.
        ground: whether fixed ground is put under the lowest point.
        density: mass density of blocks whose file has none [kg/m3], 100 to 30000.
        scale: length of a unit of the file [m], 1e-6 to 1e3: 0.001 for millimetres. None takes the `unit`.
        unit: of the file, "m", "cm", "mm", "in" or "ft", in the place of `scale`. None is m.
        up: axis of the file that points upwards, "x", "y" or "z": the file is turned until that is z. Blender and
            glTF have "y". None is "z", and there is a warning if the masonry seems to stand along another axis.
        convex: what becomes of a body that is not convex. "hull" takes its convex hull and warns of the volume that
            is added. "parts" cuts it along the planes of its faces into a `Compound`, which fills the same volume.
            None refuses it.

    Raises:
        TypeError: for names that are no list, and for `ground` that is neither True nor False.
        ValueError: if the file is not valid, or a body is open, not convex or touches no other; the message names
            both.

    Warns:
        Implausible: as `Masonry` does, for masonry that seems to stand along another axis, and for faces that lie
            as little apart as twenty tolerances. A UserWarning gives the volume that hulls add.
    """

    fixed: Sequence[str] = ()
    ground: bool = field(default=False, kw_only=True)
    density: Density = field(default=2000.0, kw_only=True)
    scale: Scale = field(default=None, kw_only=True)
    unit: str | None = field(default=None, kw_only=True)
    up: str | None = field(default=None, kw_only=True)
    convex: str | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if self.convex is not None:
            require_one_of("convex", self.convex, CONVEX)
        required_names("fixed", self.fixed)
        require_flag("ground", self.ground)
        self.matrix()  # which refuses a unit, a scale or an axis

    def matrix(self, own: float = 1.0, usual: str = "z") -> Array:
        """What takes places of the file to m with z upwards, shape (3, 3).

        Args:
            own: unit that the file states [m], taken where no other is given.
            usual: axis that points upwards where none is given.

        Raises:
            ValueError: for a unit or an axis that is none, or a unit beside a scale.
        """
        scale = own if self.scale is None else self.scale
        if self.unit is not None:
            if self.scale is not None:
                raise ValueError(f"unit = {shown(self.unit)} and scale = {self.scale:g} are both given; give one")
            scale = LENGTH_UNITS[require_one_of("unit", self.unit, LENGTH_UNITS)]
        return scale * np.array(UPWARDS[require_one_of("up", usual if self.up is None else self.up, UPWARDS)])


def required_names(argument: str, names: Sequence[str]) -> Sequence[str]:
    """A list of names.

    Raises:
        TypeError: with the argument, for any other.
    """
    if not isinstance(names, list | tuple):
        raise TypeError(f"{argument} = {shown(names)} is not a list of names")
    for name in names:
        require_text(argument, name)
    return names


def meshes_of(meshes: Mapping[str, tuple[ArrayLike, Sequence[Sequence[int]]]]) -> list[Mesh]:
    """Blocks of meshes that another library has read, such as those of IFC, glTF or Blender.

    Args:
        meshes: by the names of bodies, vertices, shape (n, 3), and faces, numbers of the vertices around each.

    Raises:
        TypeError, ValueError: for what is no mesh.
    """
    if not isinstance(meshes, Mapping):
        raise TypeError(f"meshes = {shown(meshes)} is not a dict of vertices and faces by name")
    if not meshes:
        raise ValueError(
            "meshes is empty: the model has no element of the kind that was taken from it. Most models of IFC have "
            "whole walls, IfcWall, and no IfcBuildingElementPart"
        )
    bodies = []
    for name, mesh in meshes.items():
        label = f"meshes[{shown(name)}]"
        if not isinstance(mesh, tuple | list) or len(mesh) != 2:
            raise TypeError(f"{label} = {shown(mesh)} is not a pair of vertices and faces")
        vertices = require_reals(label, mesh[0], "vertices of the shape (n, 3)")
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise ValueError(f"{label}: vertices has the shape {vertices.shape}; (n, 3) is needed")
        try:
            faces = [tuple(map(index, face)) for face in mesh[1]]
        except TypeError:
            raise TypeError(f"{label}: faces = {shown(mesh[1])} are not lists of numbers of vertices") from None
        for face in faces:
            if len(face) < 3 or min(face) < 0 or max(face) >= len(vertices):
                raise ValueError(f"{label}: the face {face} is not three or more of {len(vertices)} vertices")
        bodies.append(Mesh(block_name(require_text("meshes", name), "body"), vertices, faces))
    return bodies


def block_name(name: str, otherwise: str) -> str:
    """A name that a block can have."""
    name = name.strip().replace("|", "_")
    return otherwise if name in ("", "world") else name


def used(vertices: Array, faces: MeshFaces) -> tuple[Array, MeshFaces]:
    """The vertices that faces use, in their order, and the faces with the new numbers of them."""
    numbers = sorted({vertex for face in faces for vertex in face})
    where = {vertex: i for i, vertex in enumerate(numbers)}
    return vertices[numbers], [tuple(where[vertex] for vertex in face) for face in faces]


def mesh_bodies(mesh: Mesh) -> list[Mesh]:
    """The closed bodies of a mesh, and plane plates that are open.

    Faces are taken in their order. They are a body as soon as every edge belongs to two of them, so that bodies which
    touch are separate where they are written one after the other. Closed parts that have no vertex in common are
    separate bodies.

    Raises:
        ValueError: for a body that is open and no plate, or for too many.
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
        for i, j in face_edges(face):
            open_edges ^= {(min(i, j), max(i, j))}
        part += not open_edges
        if part > MOST_BODIES:
            raise ValueError(f"body {mesh.name} is more than {MOST_BODIES} closed bodies, which is the most")
    bodies = [mesh._replace(vertices=corners, faces=rings) for corners, rings in _separate_bodies(places, faces, parts)]
    if not bodies:
        raise ValueError(f"body {mesh.name} has no faces")
    if open_edges and not all(is_plate(body) or not _open_edges(body) for body in bodies):
        raise ValueError(f"body {mesh.name} is open: {len(open_edges)} of its edges belong to one face alone")
    return bodies


def _all_bodies(meshes: Sequence[Mesh]) -> list[Mesh]:
    """The bodies of all meshes with names of their own. It warns of those with the vertices of one before them, which
    are left out."""
    seen: set[bytes] = set()
    repeated, bodies = list[Mesh](), list[Mesh]()
    for mesh in meshes:
        of_mesh = list[Mesh]()
        for body in mesh_bodies(mesh):
            places = np.unique(body.vertices, axis=0).tobytes()
            (repeated if places in seen else of_mesh).append(body)
            seen.add(places)
        if len(of_mesh) > 1:
            of_mesh = [body._replace(name=f"{mesh.name}_{i}") for i, body in enumerate(of_mesh)]
        bodies += of_mesh
    if repeated:
        names = named([body.name for body in repeated])
        warn_of(f"{len(repeated)} bodies are drawn twice, and read once: {names}")
    count = Counter(body.name for body in bodies)
    return [body if count[body.name] == 1 else body._replace(name=f"{body.name}_{i}") for i, body in enumerate(bodies)]


def _separate_bodies(places: Array, faces: MeshFaces, parts: list[int]) -> list[tuple[Array, MeshFaces]]:
    """The vertices and faces of bodies: of one part, and hanging together by their vertices."""
    number_of: dict[tuple[int, int], int] = {}  # a vertex counts once in each part
    pairs = []
    for face, part in zip(faces, parts, strict=True):
        numbers = [number_of.setdefault((part, vertex), len(number_of)) for vertex in face]
        pairs += [(numbers[0], number) for number in numbers]
    if not pairs:
        return []
    labels = connected_parts(pairs, len(number_of)).tolist()
    shells: dict[int, MeshFaces] = {}
    for face, part in zip(faces, parts, strict=True):
        shells.setdefault(labels[number_of[part, face[0]]], []).append(face)
    return [used(places, shell) for shell in shells.values()]


def _open_edges(body: Mesh) -> int:
    """How many edges of a body belong to an odd number of faces."""
    count = Counter(frozenset(edge) for face in body.faces for edge in face_edges(face))
    return sum(number % 2 for number in count.values())


def is_plate(body: Mesh) -> bool:
    """Whether the vertices of a body lie in a plane."""
    about = body.vertices - body.vertices.mean(axis=0)
    thick = np.abs(about @ np.linalg.svd(about, full_matrices=False)[2][-1]).max()
    return bool(len(about) < 4 or thick <= THINNEST * np.ptp(about, axis=0).max())


def oriented(body: Mesh) -> Mesh:
    """A closed body with all its faces counterclockwise from outside, whatever their order was."""
    faces = list(body.faces)
    of_edge: dict[frozenset[int], list[int]] = {}
    for number, face in enumerate(faces):
        for edge in face_edges(face):
            of_edge.setdefault(frozenset(edge), []).append(number)
    seen, ahead = {0}, [0]
    while ahead:
        number = ahead.pop()
        for edge in face_edges(faces[number]):
            for other in of_edge[frozenset(edge)]:
                if other not in seen:  # a face of the same sense passes their common edge in reverse
                    faces[other] = faces[other][::-1] if edge in face_edges(faces[other]) else faces[other]
                    seen.add(other)
                    ahead.append(other)
    if enclosed_by(body._replace(faces=faces)) < 0:
        faces = [face[::-1] for face in faces]
    return body._replace(faces=faces)


def enclosed_by(body: Mesh) -> float:
    """Volume that the faces of a closed body enclose, negative where they are clockwise as seen from outside [m3]."""
    triangles = body.vertices[triangles_of(body.faces)]
    return float(np.linalg.det(triangles - body.vertices.mean(axis=0)).sum()) / 6


class Bound(NamedTuple):
    """A closed body with its faces outwards, the hull of its vertices, and the volumes of both [m3]."""

    body: Mesh
    hull: Hull
    enclosed: float
    of_hull: float

    @classmethod
    def from_mesh(cls, body: Mesh) -> Bound:
        """A body with its hull.

        Raises:
            ValueError: with its name, if its vertices bound none.
        """
        with about(f"body {body.name}"):
            hull = hull_of(body.vertices)
        body = oriented(body)
        return cls(body, hull, enclosed_by(body), bulk_of(body.vertices[list(hull.corners)], hull.faces).volume)

    @property
    def added(self) -> float:
        """Volume that the hull has more, over that of the body [-]."""
        return self.of_hull / self.enclosed - 1 if self.enclosed > 0 else np.inf

    @property
    def is_convex(self) -> bool:
        """Whether the faces enclose the volume of the hull, and each of their triangles lies on a face of the hull."""
        if abs(self.enclosed / self.of_hull - 1) > SAME_VOLUME:
            return False
        places, extent = self.body.vertices, float(np.ptp(self.body.vertices, axis=0).max())
        on = places[[self.hull.corners[face[0]] for face in self.hull.faces]]
        offsets = (on * self.hull.normals).sum(axis=1)
        off = (
            np.abs(ring @ self.hull.normals.T - offsets).max(axis=0).min()
            for ring in places[triangles_of(self.body.faces)]
        )
        return bool(max(off) <= SAME_PLANE * extent)


def blocks_of(meshes: Sequence[Mesh], file: FileOptions) -> list[SolidBlock]:
    """The blocks of meshes of a file; names that several have are numbered.

    The density is that of meshes whose file has none [kg/m3]. Bodies are fixed that are named, or are marked as a
    support.

    Raises:
        ValueError: with the name of a body that is open or not convex, or a name that no body has.

    Warns:
        UserWarning: of the volume that hulls add.
    """
    turn, fixed, convex, density = file.matrix(), file.fixed, file.convex, file.density
    with np.errstate(invalid="ignore"):  # an infinite coordinate is named below
        meshes = [mesh._replace(vertices=mesh.vertices @ turn.T) for mesh in meshes]
    bodies = _all_bodies(meshes)
    names = [body.name for body in bodies]
    for name, times in Counter(fixed).items():
        if times > 1:
            raise ValueError(f"fixed has {name!r} {times} times; each body is named once")
        if name not in names:
            raise ValueError(f"fixed = {name!r} is not a body; there are {', '.join(names[:10])}")
    bodies = [body._replace(fixed=body.fixed or body.name in fixed) for body in bodies]
    for body in bodies:
        with about(f"body {body.name}"):
            require_near(body.vertices)
    middle = np.concatenate([body.vertices for body in bodies]).mean(axis=0)
    bounds = [Bound.from_mesh(_support(body, middle)) for body in bodies]
    dented = sorted((bound for bound in bounds if not bound.is_convex), key=lambda bound: -bound.added)
    if dented and convex != "parts":
        _warn_of_dents(dented, bounds, convex)
    cut = {bound.body.name for bound in dented} if convex == "parts" else set()
    return [_cut_block(bound, density) if bound.body.name in cut else _hull_block(bound, density) for bound in bounds]


def _support(body: Mesh, middle: Array) -> Mesh:
    """A body; an open plate that is fixed is made a body that lies on the far side of it from the middle of all [m]."""
    if not is_plate(body) or not _open_edges(body):
        return body
    if not body.fixed:
        raise ValueError(f"body {body.name} is open: it is a plane plate; name it in fixed to make a support")
    about = body.vertices.mean(axis=0)
    normal = np.linalg.svd(body.vertices - about)[2][-1]
    away = -np.sign(normal @ (middle - about)) or 1.0
    behind = body.vertices + away * PLATE_THICKNESS * float(np.ptp(body.vertices, axis=0).max()) * normal
    hull = hull_of(np.concatenate([body.vertices, behind]))
    return body._replace(vertices=np.concatenate([body.vertices, behind])[list(hull.corners)], faces=list(hull.faces))


def _warn_of_dents(dented: Sequence[Bound], bounds: Sequence[Bound], convex: str | None) -> None:
    """Warn of the volume that the hulls of bodies which are not convex add, or refuse these."""
    worst, total = dented[0], sum(bound.enclosed for bound in bounds)
    added = sum(bound.of_hull - bound.enclosed for bound in dented) / total
    if convex == "hull":
        names = named([f"{bound.body.name} {bound.added:.2%}" for bound in dented])
        warn_of(f"convex='hull' adds volume to {len(dented)} bodies: {names}; to all {added:.2%}")
        return
    others = f", the most of {len(dented)} such bodies of {len(bounds)}" if len(dented) > 1 else ""
    raise ValueError(
        f"body {worst.body.name} is not convex: its faces enclose {worst.enclosed:.4g} m3 within their hull of "
        f"{worst.of_hull:.4g} m3{others}; convex='hull' takes hulls, which adds {added:.2%} to the volume of all, and "
        "convex='parts' cuts into convex parts"
    )


def _hull_block(bound: Bound, density: float) -> Polyhedron:
    """The hull of a body as a block."""
    body, corners = bound.body, bound.body.vertices[list(bound.hull.corners)]
    with about(f"body {body.name}", (ValueError, TypeError)):
        if len(corners) > MOST_VERTICES:
            raise ValueError(f"its hull has {len(corners)} corners; a block has at most {MOST_VERTICES}")
        return Polyhedron(corners, density if body.density is None else body.density, body.fixed, body.name)


def _cut_block(bound: Bound, density: float) -> SolidBlock:
    """A body that is not convex as a unit of convex parts, which fill it."""
    body, parts = bound.body, list[Polyhedron]()
    try:
        for part in convex_parts(body.vertices, body.faces, MOST_CUTS):
            with suppress(ValueError):  # what is too thin for a block is missed by the volume
                parts.append(Polyhedron(part, density if body.density is None else body.density))
        parts = [part for part in parts if part.volume > SPLINTER * bound.enclosed]
        filled = sum(part.volume for part in parts)
        if abs(filled / bound.enclosed - 1) > SAME_VOLUME:
            raise ValueError(f"parts fill {filled:.4g} m3 of {bound.enclosed:.4g} m3; do its faces cross?")
        return Compound(parts, body.fixed, body.name) if len(parts) > 1 else _hull_block(bound, density)
    except (ValueError, TypeError) as error:
        raise ValueError(
            f"body {body.name} is not convex, and cannot be cut into parts: {error}; convex='hull' takes its hull, "
            f"which adds {bound.added:.2%} to its volume"
        ) from None
