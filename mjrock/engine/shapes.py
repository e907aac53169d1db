"""Shapes: the bodies of a model text, with their joints, faces and contact points, and the faces of the ground.

Numbers have every digit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..contacts.files import quoted
from ..geometry.frames import PLANE
from ..quantities import Array
from ..scene.parts import GROUND
from ..scene.scene import Scene
from ..scene.tints import TINTS, distinct_tints

BALL = (("x", "slide", "1 0 0"), ("y", "slide", "0 1 0"), ("z", "slide", "0 0 1"))
"""The slides of a body of space, by the name, kind and axis of the joint. A ball joint `turn` follows them."""
HINGE = (("x", "slide", "1 0 0"), ("z", "slide", "0 0 1"), ("theta", "hinge", "0 1 0"))
"""The joints of a body of the plane."""

PLATE = 4.0
"""How far the plate of a face reaches from the middle of its joint, over the largest extent of the bodies [-]."""
SMALLEST_SLAB = 0.05
"""Half the length of the slab that is seen behind a face that one point meets, over the extent of the bodies [-]."""
LEAST_MOMENT = 1e-14
"""Smallest principal moment of a tensor of inertia that MuJoCo takes [kg m2]."""


def section(name: str, lines: Iterator[str]) -> list[str]:
    """A section of the text, or nothing where it would be empty."""
    elements = list(lines)
    return [f"<{name}>", *elements, f"</{name}>"] if elements else []


def value_text(value: object) -> str:
    """A quoted attribute: texts as they are, numbers with every digit that distinguishes them from their neighbours."""
    if isinstance(value, str):
        return quoted(value)
    return f'"{" ".join(repr(float(number)) for number in np.ravel(np.asarray(value)))}"'


def tag(kind: str, within: str = "", /, **attributes: object) -> str:
    """An element with attributes."""
    opened = f"<{kind} {' '.join(f'{key}={value_text(value)}' for key, value in attributes.items())}"
    return f"{opened}>{within}</{kind}>" if within else f"{opened}/>"


def in_space(vector: Array, raised: float = 0.0) -> tuple[float, ...]:
    """A vector of the plane or of space in MuJoCo's world, raised by a length."""
    if len(vector) == 2:
        return vector[0], 0.0, vector[1] + raised
    return vector[0], vector[1], vector[2] + raised


def world(scene: Scene) -> Iterator[str]:
    """The faces of the ground, and each body with its faces and its contact points."""
    faces = {name: i for i, name in reversed(list(enumerate(scene.contacts.face_names)))}  # by its first point
    paved: set[float] = set()
    for name in sorted(faces, key=faces.__getitem__):
        if scene.contacts.face_body[faces[name]] == GROUND:
            height = float(scene.contacts.face_at[faces[name]][-1])
            yield from _ground(scene, name, faces[name], hidden=scene.freedom != PLANE and height in paved)
            paved.add(height)
    for j, tint in enumerate(tints(scene)):
        yield from _body(scene, j, faces, tint)


def tints(scene: Scene) -> list[dict[str, object]]:
    """Colours of the bodies, each another one than those of the bodies that it touches."""
    count, contacts = len(scene.bodies.names), scene.contacts
    touching = zip(contacts.body.tolist(), contacts.face_body.tolist(), strict=True)
    chosen = distinct_tints(count, (pair for pair in touching if GROUND not in pair))
    return [{"rgba": (*TINTS[tint], 1.0)} for tint in chosen]


def _body(scene: Scene, j: int, faces: dict[str, int], tint: dict[str, object]) -> Iterator[str]:
    """A body with its joints, its shape, its faces by their first points, and its contact points."""
    name, radius = scene.bodies.names[j], scene.radius
    prefix = "" if len(scene.bodies.names) == 1 else f"{name}_"
    yield f"  <body name={quoted(name)} pos={value_text(in_space(scene.bodies.rest[j], radius))}>"
    yield "    " + tag("inertial", pos=(0, 0, 0), mass=scene.bodies.mass[j], **inertia_of_body(scene, j))
    for joint, kind, axis in HINGE if scene.freedom == PLANE else BALL:
        yield "    " + tag("joint", name=prefix + joint, type=kind, axis=axis)
    if scene.freedom != PLANE:
        yield "    " + tag("joint", name=f"{prefix}turn", type="ball")
    for part, outline in zip(part_names(scene, j), scene.bodies.parts_of(j), strict=True):
        if _is_box(outline):
            yield "    " + tag("geom", name=part, type="box", size=_half(scene, outline), **tint)
        else:
            yield "    " + tag("geom", name=part, type="mesh", mesh=part, **tint)
    for face in (face for face, i in faces.items() if scene.contacts.face_body[i] == j):
        yield "    " + tag("geom", name=face, type="box", group="3", **_plate(scene, faces[face]))
    for i in np.flatnonzero(scene.contacts.body == j):
        at = in_space(scene.contacts.at[i])
        yield "    " + tag("geom", name=scene.contacts.point_names[i], type="sphere", group="3", size=radius, pos=at)
    yield from (f"    {site}" for site in sites(scene, j))
    yield "  </body>"


def inertia_of_body(scene: Scene, j: int) -> dict[str, object]:
    """Moments of inertia of a body: of the plane, those of a rectangle about the other two axes; any will do that can
    be."""
    if scene.freedom == PLANE:
        mass, (width, height) = scene.bodies.mass[j], np.ptp(scene.bodies.outlines[j], axis=0)
        across = [mass * (scene.bodies.length**2 + side**2) / 12 for side in (height, width)]
        if not abs(across[0] - across[1]) <= scene.bodies.inertia[j] <= sum(across):
            across = [scene.bodies.inertia[j]] * 2
        return {"diaginertia": (across[0], scene.bodies.inertia[j], across[1])}
    moments = np.diagonal(scene.bodies.inertia[j])
    if not scene.bodies.products[j].any():
        return {"diaginertia": moments}
    smallest = float(np.linalg.eigvalsh(scene.bodies.inertia[j])[0])
    if smallest < LEAST_MOMENT:
        raise ValueError(
            f"{scene.bodies.names[j]} has a moment of inertia of {smallest:.3g} kg m2; MuJoCo takes those of at least "
            f"{LEAST_MOMENT:g} kg m2, and mr.solve_explicit any"
        )
    return {"fullinertia": np.concatenate([moments, scene.bodies.products[j]])}


def sites(scene: Scene, body: int, raised: float = 0.0) -> Iterator[str]:
    """Ends of links and points of forces on a body or on the ground, raised by a length [m]."""
    links = scene.links
    ends = (
        (links.names, links.body, links.at),
        ([f"{name}_anchor" for name in links.names], links.anchor_body, links.anchor_at),
        (scene.forces.names, scene.forces.body, scene.forces.at),
    )
    for names, bodies, places in ends:
        for name, on, place in zip(names, bodies, places, strict=True):
            if on == body:
                yield tag("site", name=name, pos=in_space(place, raised))
    if body == GROUND and scene.forces.names:
        yield tag("site", name="origin")


def _ground(scene: Scene, name: str, i: int, *, hidden: bool) -> Iterator[str]:
    """The face of the ground that point i meets, as a plane.

    Level ground is seen as paving, any other face of the plane as a slab behind it. In space no other face is seen,
    and of several faces at one height, which would flicker, only the first.
    """
    face, normal, radius = scene.contacts.face_at[i], scene.contacts.normal[i], scene.radius
    at = in_space(face - radius * normal, radius)
    layer = {"group": "3"} if hidden else {}
    if normal[-1] == 1:
        yield "  " + tag("geom", name=name, type="plane", size=(0, 0, 1), pos=at, material="paving", **layer)
    elif scene.freedom == PLANE:
        yield from _slab(scene, name, i, at)
    else:
        size = (scene.bodies.extent, scene.bodies.extent, 1.0)
        yield "  " + tag("geom", name=name, type="plane", size=size, pos=at, zaxis=normal, group="3")


def _slab(scene: Scene, name: str, i: int, at: tuple[float, ...]) -> Iterator[str]:
    """The face of point i, which is not level, as a plane at a place, and the slab that is seen behind it."""
    x, z = scene.contacts.face_at[i]
    nx, nz = scene.contacts.normal[i]
    met = np.array(scene.contacts.face_names) == name
    along = (scene.bodies.rest[scene.contacts.body] + scene.contacts.at)[met] - scene.contacts.face_at[i]
    places = along @ np.array([nz, -nx])
    half = max(0.5 * float(np.ptp(places)), SMALLEST_SLAB * scene.bodies.extent)
    middle = 0.5 * float(places.max() + places.min())
    x, z = x + middle * nz, z - middle * nx
    size, axis = (half, 0.6 * scene.bodies.length, 1.0), (nx, 0.0, nz)
    yield "  " + tag("geom", name=name, type="plane", size=size, pos=at, zaxis=axis, group="3")
    thick = 0.15 * half
    slab, behind = (half, 0.6 * scene.bodies.length, thick), (x - thick * nx, 0.0, z - thick * nz)
    yield "  " + tag("geom", name=f"{name}_wall", type="box", size=slab, pos=behind, zaxis=axis, material="plaster")


def _plate(scene: Scene, i: int) -> dict[str, object]:
    """The face of a body as a plate that is wider than blocks and thicker than any penetration. MuJoCo pushes a point
    out of the nearest side of it, so that it is as wide out of the plane too, where blocks may be short.

    It is so thick that its middle lies outside the body. MuJoCo takes a geom within 1e-6 m of the origin of its body to
    be at the origin, and a thinner plate of a square block would have its middle a radius away from there.
    """
    extent, deep, normal = scene.bodies.extent, 2 * scene.bodies.extent, scene.contacts.normal[i]
    at = in_space(scene.contacts.face_at[i] - (deep + scene.radius) * normal)
    return {"size": (PLATE * extent, PLATE * extent, deep), "pos": at, "zaxis": in_space(normal)}


def meshes(scene: Scene) -> Iterator[str]:
    """The bodies that are not boxes; those of the plane as prisms."""
    half = scene.bodies.length / 2
    for j in range(len(scene.bodies.names)):
        for name, outline in zip(part_names(scene, j), scene.bodies.parts_of(j), strict=True):
            if not _is_box(outline):
                vertices = outline
                if scene.freedom == PLANE:
                    vertices = np.array([(x, y, z) for y in (-half, half) for x, z in outline])
                yield tag("mesh", name=name, vertex=np.ravel(vertices))


def part_names(scene: Scene, body: int) -> list[str]:
    """Names of the geoms that show a body: its own, and of a body of several parts with their numbers."""
    name, count = scene.bodies.names[body], len(scene.bodies.parts_of(body))
    return [name, *(f"{name} part {i}" for i in range(1, count))]


def _half(scene: Scene, outline: Array) -> tuple[float, ...]:
    """Half the sizes of a box."""
    size = np.ptp(outline, axis=0)
    if scene.freedom == PLANE:
        return size[0] / 2, scene.bodies.length / 2, size[1] / 2
    return tuple(size / 2)


def _is_box(outline: Array) -> bool:
    """Whether vertices about a centroid are those of a box along the axes."""
    half = np.ptp(outline, axis=0) / 2
    return len(outline) == 2 ** len(half) and bool(np.allclose(np.abs(outline), half, rtol=1e-12))
