"""Names of contact points and of the faces that they meet, from the groups of contacts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ..quantities import Array, Integers


def point_names(group: Sequence[str]) -> tuple[str, ...]:
    """Name of each contact point: its group and its number in it."""
    numbers: Counter[str] = Counter()
    names = []
    for name in group:
        names.append(f"{name}_{numbers[name]}")
        numbers[name] += 1
    return tuple(names)


def face_names(group: Sequence[str], bodies: Integers, faces: Array, normals: Array) -> tuple[str, ...]:
    """Name of the face that each point meets: its group, with a number where the points of a group meet several."""
    known: dict[tuple[object, ...], str] = {}
    names = []
    for name, body, face, normal in zip(group, bodies, faces, normals, strict=True):
        mark = (name, int(body), *face.tolist(), *normal.tolist())
        number = sum(met[0] == name for met in known)
        names.append(known.setdefault(mark, f"{name}_face_{number}" if number else name))
    return tuple(names)
