"""The rows of a system in space from the scene of masonry, its faces, and what happens to it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...geometry.vectors import tangents
from ...problem.masonry.faces_of_joints import faces_of_joints
from ...problem.masonry.joints_in_space import Face
from ...problem.masonry.lines import free_numbers
from ...problem.masonry.masonry import Masonry
from ...problem.masonry.support import Support
from ...quantities import Array, Integers
from ...scene.ground import Ground
from ...scene.scene import Scene
from ..assembly import moving
from ..contact import OVERHANG
from ..system import Rows, named, rows
from .columns import PLACE, QUATERNION, REST, ease_columns, ease_of, named_vectors, turns, vectors
from .system import BODY, EDGE, LINK, POINT, WAY, System


def masonry_system(scene: Scene, masonry: Masonry) -> System:
    """Masonry in space as it is drawn, at rest on ground that does not move."""
    sprung, damped = scene.links.sprung, scene.links.damped
    bodies = rows(
        BODY,
        len(scene.bodies.mass),
        mass=scene.bodies.mass,
        qw=1.0,
        **ease_columns(scene.bodies.inertia),
        **named(REST, scene.bodies.rest),
    )
    lines, edges = points_of(scene, masonry)
    ways = rows(WAY, 2 * len(lines) if np.isinf(lines["k_s"]).any() else 0)
    ties = rows(
        LINK,
        len(sprung.k),
        body=sprung.body,
        anchor=sprung.anchor_body,
        **named_vectors(at=sprung.at, origin=sprung.anchor_at, between=scene.ties.between),
        k=sprung.k,
        reach=scene.ties.reach,
        strength=sprung.strength,
        push=sprung.push,
        ultimate=sprung.ultimate,
        broken=np.inf,
    )
    forces = rows(
        LINK,
        len(scene.forces.names),
        body=scene.forces.body,
        anchor=-1,
        **named_vectors(at=scene.forces.at, between=scene.forces.force),
    )
    dampers = rows(
        LINK,
        len(damped.c),
        body=damped.body,
        anchor=damped.anchor_body,
        **named_vectors(at=damped.at, origin=damped.anchor_at, between=scene.dampers.between),
        c=damped.c,
    )
    return System(bodies, lines, edges, ways, ties, dampers, forces, Ground.of(None), moving((), axes=3))


def points_of(scene: Scene, masonry: Masonry) -> tuple[Rows, Rows]:
    """The contact points of masonry, and the edges of the faces of its joints."""
    places, of = scene.places, scene.contacts.joint
    edges, ends = edges_of(scene, masonry)
    above = free_numbers(masonry.blocks)[[joint.above for joint in masonry.joints]][of] == places.body
    of_face, of_body = np.where(above, 0, 1), np.where(above, 1, 0)
    k_s = masonry.joint_shear[of] * scene.contacts.k / masonry.joint_stiffness[of]
    sprung = np.isfinite(k_s)
    points = rows(
        POINT,
        len(of),
        body=places.body,
        face=places.face_body,
        support=-1,
        group=scene.contacts.joint,
        **named_vectors(at=places.at, origin=places.face_at + places.between, normal=places.normal),
        k=scene.contacts.k,
        c=scene.contacts.c,
        k_s=k_s,
        c_s=np.where(sprung, scene.contacts.c * np.where(sprung, k_s, 0.0) / scene.contacts.k, 0.0),
        friction=scene.contacts.friction,
        first=ends[of, of_face, 0],
        last=ends[of, of_face, 1],
        own_first=ends[of, of_body, 0],
        own_last=ends[of, of_body, 1],
    )
    points["margin"] = margins(points, edges)
    return points, edges


def edges_of(scene: Scene, masonry: Masonry) -> tuple[Rows, Integers]:
    """The edges of the two faces of each joint, from the centroids of their bodies, and which are those of each face.

    Returns:
        The edges, and the numbers of the first and of the one after the last, of the faces of the block below and of
        the one above of each joint, shape (joints, 2, 2).
    """
    number = free_numbers(masonry.blocks)
    origins = np.where(number[:, None] < 0, 0.0, scene.bodies.rest[number])
    tables = [
        edges_of_face(face, origins[block])
        for joint, faces in zip(masonry.joints, faces_of_joints(masonry), strict=True)
        for block, face in zip((joint.below, joint.above), faces, strict=True)
    ]
    ends = np.cumsum([0, *(len(table) for table in tables)])
    return np.concatenate(tables).view(np.recarray), np.column_stack([ends[:-1], ends[1:]]).reshape(-1, 2, 2)


def edges_of_face(face: Face, origin: Array) -> Rows:
    """The edges of a face, which is taken to be longer by `OVERHANG` at either end, from a point of its block [m]."""
    ways = np.cross(np.roll(face.corners, -1, axis=0) - face.corners, face.normal)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    places = (face.corners - origin) @ ways.T  # (corners, edges)
    extent = np.ptp(places, axis=0)
    reach, band = places.max(axis=0) + OVERHANG * extent, OVERHANG * (1 + 2 * OVERHANG) * extent
    return rows(EDGE, len(ways), **named_vectors(way=ways), reach=reach, band=band)


def margins(points: Rows, edges: Rows) -> Array:
    """Square of the least way that each point has along its face to its end [m2], shape (m,)."""
    places, ways = vectors(points, "origin"), vectors(edges, "way")
    margin = np.empty(len(points))
    for i, (place, first, last) in enumerate(zip(places, points["first"], points["last"], strict=True)):
        margin[i] = max(float((edges["reach"][first:last] - ways[first:last] @ place).min()), 0.0)
    return np.asarray(margin**2)


def started(system: System, pose: Array, velocity: Array) -> None:
    """Give the bodies of a system a pose and velocities, shapes (n, 7) and (n, 6)."""
    bodies, turn = system.bodies, turns(pose[:, 3:])
    momentum = np.linalg.solve(ease_of(bodies), velocity[:, 3:, None])[:, :, 0]
    momentum = momentum + np.einsum("nij,nj->ni", turn, momentum)
    columns = named((*PLACE, *QUATERNION), pose) | named(("vx", "vy", "vz"), velocity[:, :3])
    for name, values in (columns | named_vectors(momentum=momentum)).items():
        bodies[name] = values


def take_grips(points: Rows, drag: Array) -> None:
    """Let points start with the friction at rest, see `settled_in_space`, in the axes of their faces."""
    first, second = np.array([tangents(tuple(normal)) for normal in vectors(points, "normal").tolist()]).swapaxes(0, 1)
    force, sprung = drag[:, :1] * first + drag[:, 1:] * second, np.isfinite(points["k_s"])[:, None]
    grip = np.where(sprung, -force / np.where(sprung, points["k_s"][:, None], 1.0), force)
    for name, values in named_vectors(grip=grip).items():
        points[name] = values


def moved_by(system: System, scene: Scene, masonry: Masonry, supports: Sequence[Support]) -> System:
    """The system with supports that move fixed blocks."""
    numbers = {support.block: i for i, support in enumerate(supports)}
    below = np.array([numbers.get(joint.below, -1) for joint in masonry.joints])
    support = below[scene.contacts.joint]
    system.lines["support"] = np.where(system.lines["face"] < 0, support, -1)
    return system._replace(supports=moving(supports, axes=3))


def copied(system: System) -> System:
    """A system whose motion leaves the first as it is."""
    tables = ("bodies", "lines", "edges", "ways", "ties", "dampers", "forces")
    return system._replace(**{name: getattr(system, name).copy() for name in tables})
