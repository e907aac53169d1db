"""The rows of a system in space from masonry, its effects and what happens to it."""

from __future__ import annotations

import numpy as np

from ...problem.masonry.faces_of_joints import faces_of_joints
from ...problem.masonry.masonry import Masonry
from ...quantities import Array, Integers
from ...scene.ground import Ground
from ..contact import OVERHANG
from ..system import Rows, Supports, rows
from .columns import PLACE, QUATERNION, REST, ease_columns, ease_of, named, named_vectors, turns, vectors
from .system import BODY, EDGE, LINK, POINT, WAY, System


def masonry_system(masonry: Masonry) -> System:
    """Masonry in space as it is drawn, at rest, without effects."""
    free = list(masonry.free)
    blocks = [masonry.blocks[i] for i in free]
    bodies = bodies_of(
        np.array([block.mass for block in blocks]),
        np.array([block.inertia for block in blocks]),
        masonry.centroids[free],
    )
    lines, edges = points_of(masonry)
    ways = rows(WAY, 2 * len(lines) if np.isinf(lines["k_s"]).any() else 0)
    none = [rows(LINK, 0) for _ in range(3)]
    return System(bodies, lines, edges, ways, *none, Ground.of(None), resting())


def bodies_of(mass: Array, inertia: Array, centroids: Array) -> Rows:
    """Bodies at rest with masses [kg], tensors of inertia [kg m2] and centroids [m], shapes (n,), (n, 3, 3), (n, 3)."""
    return rows(BODY, len(mass), mass=mass, qw=1.0, **ease_columns(inertia), **named(REST, centroids))


def resting() -> Supports:
    """No support that moves."""
    none = np.empty((0, 3))
    return Supports(np.empty(0), none, np.zeros(1, dtype=np.int64), none.copy(), none.copy())


def points_of(masonry: Masonry) -> tuple[Rows, Rows]:
    """The contact points of masonry, and the edges of the faces of its joints."""
    lines, joints, number = masonry.lines, masonry.joints, numbers_of(masonry)
    origins = np.where(number[:, None] < 0, 0.0, masonry.centroids)
    edges, ends = edges_of(masonry, origins)
    of, body, face = lines.joint, number[lines.body], number[lines.face]
    above = np.array([joint.above for joint in joints])[of] == lines.body
    of_face, of_body = np.where(above, 0, 1), np.where(above, 1, 0)
    k_s = masonry.joint_shear[of] * lines.k / masonry.joint_stiffness[of]
    c = masonry.retardation[of] * lines.k
    points = rows(
        POINT,
        len(of),
        body=body,
        face=face,
        support=-1,
        group=of,
        **named_vectors(at=lines.at - origins[lines.body], origin=lines.at - origins[lines.face], normal=lines.normal),
        k=lines.k,
        c=c,
        k_s=k_s,
        c_s=np.where(np.isfinite(k_s), masonry.retardation[of] * np.where(np.isfinite(k_s), k_s, 0.0), 0.0),
        friction=masonry.joint_friction[of],
        first=ends[of, of_face, 0],
        last=ends[of, of_face, 1],
        own_first=ends[of, of_body, 0],
        own_last=ends[of, of_body, 1],
    )
    points["margin"] = margins(points, edges)
    return points, edges


def numbers_of(masonry: Masonry) -> Integers:
    """Number of the body of each block, -1 for a fixed one, shape (blocks,)."""
    number = np.full(len(masonry.blocks), -1)
    number[list(masonry.free)] = np.arange(len(masonry.free))
    return number


def edges_of(masonry: Masonry, origins: Array) -> tuple[Rows, Integers]:
    """The edges of the two faces of each joint, from an origin of each block, and which are those of each face.

    A face is taken to be longer by `OVERHANG` at either end, as in the plane.

    Returns:
        The edges, and the numbers of the first and of the one after the last, of the faces of the block below and of
        the one above of each joint, shape (joints, 2, 2).
    """
    table: list[list[float]] = []
    ends = []
    for joint, faces in zip(masonry.joints, faces_of_joints(masonry), strict=True):
        for block, face in zip((joint.below, joint.above), faces, strict=True):
            ways = np.cross(np.roll(face.corners, -1, axis=0) - face.corners, face.normal)
            ways /= np.linalg.norm(ways, axis=1)[:, None]
            places = (face.corners - origins[block]) @ ways.T  # (corners, edges)
            extent = np.ptp(places, axis=0)
            reach, band = places.max(axis=0) + OVERHANG * extent, OVERHANG * (1 + 2 * OVERHANG) * extent
            ends.append((len(table), len(table) + len(ways)))
            table += np.column_stack([ways, reach, band]).tolist()
    columns = np.reshape(table, (-1, 5))
    edges = rows(EDGE, len(columns), **named_vectors(way=columns[:, :3]), reach=columns[:, 3], band=columns[:, 4])
    return edges, np.reshape(ends, (-1, 2, 2))


def margins(points: Rows, edges: Rows) -> Array:
    """Square of the least way that each point has along its face to its end [m2], shape (m,)."""
    places, ways = vectors(points, "origin"), vectors(edges, "way")
    margin = np.empty(len(points))
    for i, (place, first, last) in enumerate(zip(places, points["first"], points["last"], strict=True)):
        margin[i] = max(float((edges["reach"][first:last] - ways[first:last] @ place).min()), 0.0)
    square: Array = margin**2
    return square


def links_of(body: Integers, at: Array, anchor: Integers, origin: Array, between: Array, **given: Array) -> Rows:
    """Ties or dampers, or forces as `between`, as rows."""
    if not len(body):
        return rows(LINK, 0)
    places = named_vectors(at=at, origin=origin, between=between)
    return rows(LINK, len(body), body=body, anchor=anchor, **places, **given)


def started(system: System, pose: Array, velocity: Array) -> None:
    """Give the bodies of a system a pose and velocities, shapes (n, 7) and (n, 6)."""
    bodies, turn = system.bodies, turns(pose[:, 3:])
    spin = velocity[:, 3:]
    momentum = np.linalg.solve(ease_of(bodies), spin[:, :, None])[:, :, 0]
    momentum = momentum + np.einsum("nij,nj->ni", turn, momentum)
    columns = named((*PLACE, *QUATERNION), pose) | named(("vx", "vy", "vz"), velocity[:, :3])
    for name, values in (columns | named_vectors(momentum=momentum)).items():
        bodies[name] = values


def copied(system: System) -> System:
    """A system whose motion leaves the first as it is."""
    return System(*(part.copy() if isinstance(part, np.ndarray) else part for part in system))
