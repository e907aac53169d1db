"""The input of LMGC90: bodies of the kind RBDY3 with polyhedra POLYR, from the files of a folder DATBOX.

BODIES.DAT has the bodies in axes of their own, DOF.INI how these are turned, BULK_BEHAV.DAT the densities, and
DRV_DOF.DAT the bodies that are held. A file that cannot be read raises a ValueError with what is wrong.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import numpy as np

from ....quantities import Array, named, warn_of
from .bodies import AnyPath, Mesh, MeshFaces
from .meshes import file_text

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EDed][-+]?\d+)?"
VALUE = re.compile(rf"(\w+(?:\(\d\))?) *= *({NUMBER})")
BODY_OF_LMGC90 = re.compile(r"\$bdyty\s+(\w+)\s+(\d+)(.*?)(?=\$bdyty|\Z)", re.DOTALL)
"""A body: its kind, its number, and the lines of it."""
SHAPE = re.compile(r"^ ?(\w{5}) +\d+ +color .*?(?=^ ?\w{5} +\d+ +color|^\$|\Z)", re.MULTILINE | re.DOTALL)
"""A shape of a body: its kind, and its lines."""
MATERIAL = re.compile(rf"^ *(\S+) +RIGID +Umas *= *({NUMBER})", re.MULTILINE)
DRIVEN = re.compile(rf"^ *vlocy +(\d) +({NUMBER}) +({NUMBER})", re.MULTILINE)
"""A velocity that is driven: its number, its constant, and the amplitude of its wave."""


def read_lmgc90(path: AnyPath) -> list[Mesh]:
    """Blocks of the input of LMGC90: bodies RBDY3 with one polyhedron POLYR each. Driven bodies are fixed.

    Joints are those of mjrock: laws of contact, loads and gravity of the folder are not read. A UserWarning names
    planes, spheres and other shapes, which are left out, and a file that is missing.

    Args:
        path: of a folder DATBOX with BODIES.DAT, BULK_BEHAV.DAT, DRV_DOF.DAT and DOF.INI, or of its BODIES.DAT. The
            density of the material of a body replaces `density`.

    Raises:
        ValueError: for bodies of other kinds or of several polyhedra.
    """
    path = Path(path)
    bodies = path / "BODIES.DAT" if path.is_dir() else path
    body_texts = list(BODY_OF_LMGC90.finditer(file_text(bodies)))
    if not body_texts:
        raise ValueError("it has no $bdyty: it is not a file BODIES.DAT of LMGC90, or is cut short")
    materials = {name: _value(text) for name, text in MATERIAL.findall(_text_beside(bodies, "BULK_BEHAV.DAT"))}
    frames = {number: _values(text) for number, text in _rigid(_text_beside(bodies, "DOF.INI")).items()}
    driven = {number: _driven(text) for number, text in _rigid(_text_beside(bodies, "DRV_DOF.DAT")).items()}
    meshes, others = [], Counter[str]()
    for kind, digits, text in (body.groups() for body in body_texts):
        number = int(digits)
        if kind != "RBDY3":
            raise ValueError(f"body {number} is of the kind {kind}; bodies in space of the kind RBDY3 are read")
        shapes = [shape for shape in SHAPE.finditer(text) if shape[1] == "POLYR"]
        others.update(shape[1] for shape in SHAPE.finditer(text) if shape[1] != "POLYR")
        if len(shapes) > 1:
            raise ValueError(f"body {number} has {len(shapes)} polyhedra POLYR; one in each body is read")
        for shape in shapes:
            places, faces = _polyhedron(shape[0], number)
            placed = _placed(
                places, _values(text.partition("$nodty")[2].partition("$tacty")[0]), frames.get(number, {})
            )
            behaviour = re.search(r"behav +(\S+)", text)
            density = materials.get(behaviour[1]) if behaviour else None
            meshes.append(Mesh(f"body_{number}", placed, faces, driven.get(number) is not None, density))
    if others:
        kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(others.items()))
        warn_of(
            f"path = {bodies}: only polyhedra POLYR are read; left out are {kinds}; ground=True puts ground under all"
        )
    if moved := [f"body_{number}" for number, speed in driven.items() if speed]:
        warn_of(f"path = {bodies}: {named(moved)} are driven, and read as fixed; supports= of MasonryCase moves them")
    if not meshes:
        raise ValueError("it has no polyhedra POLYR")
    return meshes


def _text_beside(bodies: Path, name: str) -> str:
    """The text of another file of the folder, empty with a warning where it is missing."""
    path = bodies.parent / name
    if not path.is_file():
        warn_of(f"path = {bodies}: no {name} lies beside it, which states {CONTENT[name]}")
        return ""
    return file_text(path)


CONTENT = {
    "BULK_BEHAV.DAT": "the density of each material; density= takes its place",
    "DOF.INI": "how each body is turned; all are taken as not turned",
    "DRV_DOF.DAT": "which bodies are held; fixed= takes its place",
}
"""What each file beside BODIES.DAT contains, and what happens without it."""


def _value(text: str) -> float:
    return float(text.lower().replace("d", "e"))


def _values(text: str) -> dict[str, float]:
    """Values by their names, the last one of each."""
    return {name: _value(value) for name, value in VALUE.findall(text)}


def _polyhedron(text: str, number: int) -> tuple[Array, MeshFaces]:
    """The vertices of a polyhedron in the axes of its body, and its faces."""
    rows = [_values(line) for line in text.splitlines()]
    places = [[row[f"coo{i}"] for i in (1, 2, 3)] for row in rows if {"coo1", "coo2", "coo3"} <= row.keys()]
    faces = [
        tuple(int(row[f"ver{i}"]) - 1 for i in (1, 2, 3)) for row in rows if {"ver1", "ver2", "ver3"} <= row.keys()
    ]
    stated = _values(text)
    counts = stated.get("nb_vertex", -1), stated.get("nb_faces", stated.get("nb_face", -1))
    if counts != (len(places), len(faces)) or not all(0 <= i < len(places) for face in faces for i in face):
        raise ValueError(
            f"body {number} has {len(places)} vertices and {len(faces)} faces between vertices 1 to {len(places)}; it "
            f"states {counts[0]:g} and {counts[1]:g}"
        )
    return np.array(places), faces


def _placed(places: Array, node: dict[str, float], frame: dict[str, float]) -> Array:
    """Vertices where the body is: its centre and displacement, and its axes a, b and g [m]."""
    centre = [node.get(f"coo{i}", 0.0) + frame.get(f"X({i})", 0.0) for i in (1, 2, 3)]
    axes = np.eye(3)
    if {f"{axis}({i})" for axis in "abg" for i in (1, 2, 3)} <= frame.keys():
        axes = np.array([[frame[f"{axis}({i})"] for i in (1, 2, 3)] for axis in "abg"])
    return np.asarray(centre + places @ axes)


def _rigid(text: str) -> dict[int, str]:
    """The lines of rigid bodies by their numbers."""
    return {int(body[2]): body[3] for body in BODY_OF_LMGC90.finditer(text) if body[1] == "RBDY3"}


def _driven(text: str) -> bool | None:
    """Whether the three velocities of a body that are given move it; None where they are not all given."""
    velocities = {
        int(direction): (_value(constant), _value(wave)) for direction, constant, wave in DRIVEN.findall(text)
    }
    return any(map(any, velocities.values())) if {1, 2, 3} <= velocities.keys() else None
