"""The rows of a system from a scene, the joints of its masonry, and what happens to it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..geometry.vectors import tangents
from ..problem.masonry.actuator import Actuator
from ..problem.masonry.lines import free_numbers
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.support import Support
from ..problem.wall.effect import LinkLaw
from ..quantities import Array
from ..scene.checks import GROUND
from ..scene.ground import Ground
from ..scene.parts import Links
from ..scene.scene import Scene
from .faces import edges_of, margins, outlines_of_joints
from .rows import Rows, joined, kinds, rows
from .system import Supports, System
from .turning import is_flat, rotations, start_turning


def system_of(scene: Scene, masonry: Masonry | None = None) -> System:
    """The system of a scene, undeformed. Faces of masonry end where they end, those of a wall do not."""
    d, n = scene.bodies.rest.shape[1], len(scene.bodies.mass)
    kind = kinds(d)
    inverse = np.linalg.inv(np.reshape(scene.bodies.inertia, (n, 2 * d - 3, -1)))
    bodies = rows(kind.body, n, mass=scene.bodies.mass, inverse_inertia=inverse, rest=scene.bodies.rest)
    bodies["inverse_mass"] = 1 / scene.bodies.mass[:, None]
    lines, edges = lines_of(scene), rows(kind.edge, 0)
    if masonry is not None:
        edges = add_joints(lines, scene, masonry)
    acting = *links_of(scene), rows(kind.link, 0), Ground.of(None), moving((), d), moving((), 1)
    system = System(scene.freedom.axes, bodies, lines, edges, rows(kind.way, 0), rows(kind.bond, 0), *acting)
    return started(system.with_ways(), scene.potential.unmoved.reshape(n, -1))


def lines_of(scene: Scene) -> Rows:
    """The contact lines of a scene, whose faces have no end and which stick rigidly."""
    places = scene.places
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
        k=scene.contacts.k,
        c=scene.contacts.c,
        k_s=np.inf,
        friction=scene.contacts.friction,
        margin=np.inf,
    )


def links_of(scene: Scene) -> tuple[Rows, Rows, Rows]:
    """The links with a spring, those with a dashpot, and the constant forces of a scene."""
    kind, forces = kinds(scene.bodies.rest.shape[1]).link, scene.forces

    def links(some: Links, between: Array, **more: Array | float) -> Rows:
        columns = {name: getattr(some, name) for name in LinkLaw._fields} | more
        ends = {"anchor": some.anchor_body, "support": -1, "at": some.at, "origin": some.anchor_at, "between": between}
        return rows(kind, len(some.body), body=some.body, **columns | ends if len(some.body) else {})

    ties = links(scene.links.sprung, scene.ties.between, reach=scene.ties.reach, broken=np.inf)
    held: dict[str, Any] = {"anchor": -1, "at": forces.at, "between": forces.force} if len(forces.body) else {}
    return (
        ties,
        links(scene.links.damped, scene.dampers.between),
        rows(kind, len(forces.body), body=forces.body, **held),
    )


def add_joints(lines: Rows, scene: Scene, masonry: Masonry) -> Rows:
    """Give lines the shear stiffness of their joint and the ends of its two faces. Returns the edges of all faces."""
    of, number = scene.contacts.joint, free_numbers(masonry.blocks)
    origins = np.where(number[:, None] < 0, 0.0, scene.bodies.rest[number])
    tables = [
        edges_of(face, origins[block], met)
        for joint, faces in zip(masonry.joints, outlines_of_joints(masonry), strict=True)
        for block, face, met in zip((joint.below, joint.above), faces, faces[::-1], strict=True)
    ]
    edges, counts = joined(*tables), np.cumsum([0, *(len(table) for table in tables)])
    ends = np.column_stack([counts[:-1], counts[1:]]).reshape(-1, 2, 2)  # (joints, below and above, first and last)
    above = number[[joint.above for joint in masonry.joints]][of] == lines["body"]
    fixed = np.cumsum([block.fixed for block in masonry.blocks]) - 1
    below = fixed[[joint.below for joint in masonry.joints]]
    lines["sense"], lines["fixed"] = np.where(above, 1.0, -1.0), np.where(lines["face"] < 0, below[of], -1)
    lines["first"], lines["last"] = ends[of, np.where(above, 0, 1)].T
    lines["own_first"], lines["own_last"] = ends[of, np.where(above, 1, 0)].T
    lines["margin"] = margins(lines, edges)
    lines["k_s"] = masonry.joint_shear[of] * lines["k"] / masonry.joint_stiffness[of]
    sprung = np.isfinite(lines["k_s"])
    lines["c_s"][sprung] = lines["c"][sprung] * lines["k_s"][sprung] / lines["k"][sprung]
    return edges


def started(system: System, pose: Array, velocity: Array | None = None) -> System:
    """The system with its bodies at a pose, shape (n, nq), with velocities, shape (n, nv), or at rest."""
    bodies, d = system.bodies, len(system.axes)
    if velocity is None:
        velocity = np.zeros((len(bodies), 3 * d - 3))
    bodies["place"], bodies["velocity"] = pose[:, :d], velocity[:, :d]
    start_turning(bodies, pose, velocity)
    return system


def moved_by(system: System, scene: Scene, masonry: Masonry, supports: Sequence[Support]) -> System:
    """The system with supports that move fixed blocks, and the links that are anchored on these."""
    numbers = {masonry.names.index(support.block): i for i, support in enumerate(supports)}
    for links, of_scene in ((system.ties, scene.links.sprung), (system.dampers, scene.links.damped)):
        links["support"] = [numbers.get(block, -1) for block in of_scene.anchor_block.tolist()]
    below = np.array([numbers.get(joint.below, -1) for joint in masonry.joints])
    of = scene.contacts.joint
    system.lines["support"] = np.where(system.lines["face"] < 0, below[of], -1)
    return system._replace(supports=moving([(each.t, each.displacement) for each in supports], len(system.axes)))


def moving(histories: Sequence[tuple[Sequence[float], Array]], d: int) -> Supports:
    """Histories of displacement along d axes for compiled functions: times, and displacements of the shape (t, d)."""
    return Supports(
        np.concatenate([np.empty(0), *(t for t, _ in histories)]),
        np.concatenate([np.empty((0, d)), *(displacement for _, displacement in histories)]),
        np.cumsum([0, *(len(t) for t, _ in histories)]),
        np.zeros((len(histories), d)),
        np.zeros((len(histories), d)),
    )


def driven_by(system: System, scene: Scene, masonry: Masonry, actuators: Sequence[Actuator]) -> System:
    """The system with actuators, which count displacements from the pose of rest, and with the blocks they guide.

    One that drives all blocks has no body."""
    if not actuators:
        return system
    number, d, bodies = free_numbers(masonry.blocks), len(system.axes), system.bodies
    held = np.array([GROUND if each.block is None else number[each.block] for each in actuators])
    way, single = np.array([each.way for each in actuators]), (held >= 0)[:, None]
    at = np.array([each.way if each.at is None else each.at for each in actuators])
    at = np.where(single, at - scene.bodies.rest[held], 0.0)
    change = np.einsum("nij,nj->ni", rotations(bodies)[held], at)
    mean = np.average(bodies["place"], axis=0, weights=bodies["mass"])
    table = rows(
        kinds(d).link,
        len(actuators),
        body=held,
        anchor=-1,
        support=-1,
        at=at,
        between=way,
        k=np.array([each.stiffness for each in actuators]),
        c=np.array([each.damping for each in actuators]),
        reach=(np.where(single, bodies["place"][held] + change, mean) * way).sum(axis=1),
    )
    for body, each in zip(held, actuators, strict=True):
        if each.guide.turning:
            bodies["inverse_inertia"][body] = 0.0
        if each.guide.rising:
            bodies["inverse_mass"][body, d - 1] = 0.0
    histories = [(each.displacement[0], np.array(each.displacement[1])[:, None]) for each in actuators]
    return system._replace(actuators=table, drives=moving(histories, 1))


def guided_as(bodies: Rows, others: Rows) -> None:
    """Give moving bodies the guides of others. What a guide holds, or has held, has no velocity."""
    held = [~some["inverse_inertia"].any(axis=(1, 2)) for some in (bodies, others)]
    for name in ("inverse_mass", "inverse_inertia"):
        bodies[name] = others[name]
    bodies["velocity"][bodies["inverse_mass"] == 0] = 0.0
    for name in ("spin",) if is_flat(bodies) else ("spin", "momentum"):
        bodies[name][held[0] | held[1]] = 0.0


def copied(system: System) -> System:
    """A system whose motion leaves the first as it is."""
    tables = ("bodies", "lines", "edges", "ways", "bonds", "ties", "dampers", "forces", "actuators")
    return system._replace(**{name: getattr(system, name).copy() for name in tables})


def take_grips(lines: Rows, drag: Array) -> None:
    """Let lines start with the friction at rest along the ways of their faces [N], shape (m, d - 1)."""
    force = drag
    if drag.shape[1] == 2:
        first, second = np.array([tangents(tuple(normal)) for normal in lines["normal"].tolist()]).swapaxes(0, 1)
        force = drag[:, :1] * first + drag[:, 1:] * second
    sprung = np.isfinite(lines["k_s"])[:, None]
    lines["grip"] = np.where(sprung, -force / np.where(sprung, lines["k_s"][:, None], 1.0), force)
