"""The rows of a system from a scene, the joints of its masonry, and what happens to it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np

from ..geometry.vectors import tangents
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.histories import Support
from ..problem.masonry.laws.joint_law import Law
from ..quantities import Array
from ..rows import Rows, rows
from ..scene.course import Ground
from ..scene.scene import Scene
from .contacts.faces import edges_of, margins
from .contacts.touches import FIRST_OPENING
from .kinds.lists import no_laws
from .rotation import is_flat, set_rotations_and_spins
from .rows import kinds
from .supports import moving
from .system import System


def system_of(scene: Scene, *, ended: bool = False) -> System:
    """The system of a scene without its links, undeformed. Faces of joints may be `ended`, as those of masonry are."""
    d, n = scene.bodies.rest.shape[1], len(scene.bodies.mass)
    row_types = kinds(d)
    inverse = np.linalg.inv(np.reshape(scene.bodies.inertia, (n, 2 * d - 3, -1)))
    bodies = rows(row_types.body, n, mass=scene.bodies.mass, inverse_inertia=inverse, rest=scene.bodies.rest)
    bodies["inverse_mass"] = 1 / scene.bodies.mass[:, None]
    lines, edges = lines_of(scene), rows(row_types.edge, 0)
    if ended:
        edges = add_joints(lines, scene)
    acting = (), np.zeros(0, dtype=np.int64), Ground.from_motions(None), moving((), d)
    system = System(scene.freedom.axes, bodies, lines, edges, rows(row_types.tangent, 0), no_laws(d), *acting)
    return at_pose(system.with_room_for_friction(), scene.potential.unmoved.reshape(n, -1))


def lines_of(scene: Scene) -> Rows:
    """The contact lines of a scene, whose faces have no end."""
    places, law = scene.places, scene.contacts.law
    return rows(
        kinds(scene.bodies.rest.shape[1]).line,
        len(scene.contacts.k),
        body=places.body,
        face=places.face_body,
        support=-1,
        group=scene.contacts.joint,
        fixed=np.where(places.face_body < 0, scene.contacts.joint, -1),
        sense=1.0,
        at=places.at,
        origin=places.face_at + places.between,
        normal=places.normal,
        margin=np.inf,
        **{name: law[name] for name in Law._fields},
    )


def add_joints(lines: Rows, scene: Scene) -> Rows:
    """Give lines their dashpots along the two faces of their joint and the ends of these. Returns the edges of all."""
    joint_of_line, joints = scene.contacts.joint, scene.rest_geometry.joints
    number = np.array([solid.body for solid in scene.rest_geometry.solids])
    origins = np.where(number[:, None] < 0, 0.0, scene.bodies.rest[number])
    below, above = np.array([(joint.below, joint.above) for joint in joints]).T
    faces = list(chain.from_iterable(scene.rest_geometry.faces))
    met = [face for pair in scene.rest_geometry.faces for face in reversed(pair)]
    edges, counts = edges_of(faces, origins[np.column_stack([below, above]).ravel()], met)
    ends = np.column_stack([counts[:-1], counts[1:]]).reshape(-1, 2, 2)  # (joints, below and above, first and last)
    is_above = scene.sense > 0
    fixed = np.cumsum(number < 0) - 1
    lines["sense"], lines["fixed"] = scene.sense, np.where(lines["face"] < 0, fixed[below][joint_of_line], -1)
    lines["first"], lines["last"] = ends[joint_of_line, np.where(is_above, 0, 1)].T
    lines["own_first"], lines["own_last"] = ends[joint_of_line, np.where(is_above, 1, 0)].T
    lines["margin"] = margins(lines, edges)
    sprung = np.isfinite(lines["k_s"])
    lines["c_s"][sprung] = lines["c"][sprung] * lines["k_s"][sprung] / lines["k"][sprung]
    return edges


def open_slightly(lines: Rows, scene: Scene) -> None:
    """Let the lines of joints as drawn begin a little open, see `touches.FIRST_OPENING`. Those of bonds that pull begin
    as drawn: they hold both ways."""
    sizes = np.array([solid.size for solid in scene.rest_geometry.solids])
    smaller = np.array([min(sizes[joint.below], sizes[joint.above]) for joint in scene.rest_geometry.joints])
    pulls = np.array([bond is not None and bond.pulls for bond in scene.contacts.bonds])
    opening = (FIRST_OPENING * np.where(pulls, 0.0, smaller))[scene.contacts.joint]
    lines["between"] += opening[:, None] * lines["normal"]


def at_pose(system: System, pose: Array, velocity: Array | None = None) -> System:
    """The system with its bodies at a pose, shape (n, nq), with velocities, shape (n, nv), or at rest."""
    bodies, d = system.bodies, len(system.axes)
    if velocity is None:
        velocity = np.zeros((len(bodies), 3 * d - 3))
    bodies["place"], bodies["velocity"] = pose[:, :d], velocity[:, :d]
    set_rotations_and_spins(bodies, pose, velocity)
    return system


def with_supports(system: System, scene: Scene, supports: Sequence[Support]) -> System:
    """The system with supports that move fixed blocks, and the links that are anchored on these."""
    names, joints = [solid.name for solid in scene.rest_geometry.solids], scene.rest_geometry.joints
    numbers = {names.index(support.block): i for i, support in enumerate(supports)}
    for table in system.links:
        table.rows["support"] = [numbers.get(block, -1) for block in table.rows["anchor_block"].tolist()]
    below = np.array([numbers.get(joint.below, -1) for joint in joints])
    joint_of_line = scene.contacts.joint
    system.lines["support"] = np.where(system.lines["face"] < 0, below[joint_of_line], -1)
    histories = [(support.t, support.displacement) for support in supports]
    return system._replace(supports=moving(histories, len(system.axes)))


def guide(system: System, case: MasonryCase) -> None:
    """Let the actuators of a case guide their blocks."""
    fixed, d = case.guided, len(system.axes)
    system.bodies["inverse_mass"][fixed[:, :d]] = 0.0
    system.bodies["inverse_inertia"][fixed[:, d:].any(axis=1)] = 0.0


def guided_as(bodies: Rows, others: Rows) -> None:
    """Give moving bodies the guides of others. What a guide fixes, or has fixed, has no velocity."""
    fixed = [~table["inverse_inertia"].any(axis=(1, 2)) for table in (bodies, others)]
    for name in ("inverse_mass", "inverse_inertia"):
        bodies[name] = others[name]
    bodies["velocity"][bodies["inverse_mass"] == 0] = 0.0
    for name in ("spin",) if is_flat(bodies) else ("spin", "momentum"):
        bodies[name][fixed[0] | fixed[1]] = 0.0


def copied(system: System) -> System:
    """A system whose motion leaves the first as it is."""
    tables: dict[str, Any] = {name: getattr(system, name).copy() for name in ("bodies", "lines", "edges", "tangents")}
    for name in ("laws", "links"):
        tables[name] = tuple(table._replace(rows=table.rows.copy()) for table in getattr(system, name))
    return system._replace(**tables)


def set_initial_friction(lines: Rows, friction: Array) -> None:
    """Let lines start with the friction at rest along the tangents of their faces [N], shape (m, d - 1)."""
    force = friction
    if friction.shape[1] == 2:
        first, second = np.array([tangents(tuple(normal)) for normal in lines["normal"].tolist()]).swapaxes(0, 1)
        force = friction[:, :1] * first + friction[:, 1:] * second
    sprung = np.isfinite(lines["k_s"])[:, None]
    lines["shear_state"] = np.where(sprung, -force / np.where(sprung, lines["k_s"][:, None], 1.0), force)
