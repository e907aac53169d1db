"""The rows of a system from a scene and what happens to it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse.linalg import lsmr

from ..problem.masonry.lines import edge_ends
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.support import Support
from ..quantities import GRAVITY, Array, Flags, Integers
from ..scene.course import Course
from ..scene.scene import Scene
from .contact import OVERHANG
from .limit import line_rates, ways_of
from .system import BODY, FAR, LINE, LINK, Rows, Supports, System, named, rows, stacked

ENOUGH = 1e-9
"""Tolerance of the search for the friction at rest, relative [-]."""


def system_of(scene: Scene, course: Course, masonry: Masonry | None = None, supports: Sequence[Support] = ()) -> System:
    """The system of a scene at the start of a course. Faces of masonry end where they end, those of a wall do not."""
    pose, velocity = np.asarray(course.pose), np.asarray(course.velocity)
    ties, dampers = scene.links.sprung, scene.links.damped
    bodies = rows(
        BODY,
        len(scene.bodies.mass),
        mass=scene.bodies.mass,
        ease=1 / scene.bodies.inertia,
        **named(("x0", "z0"), scene.bodies.rest),
        **named(("x", "z", "theta"), pose),
        **named(("vx", "vz", "w"), velocity),
    )
    half = np.sin(0.5 * pose[:, 2])
    bodies["sine"], bodies["versine"] = 2 * half * np.cos(0.5 * pose[:, 2]), 2 * half**2
    lines = lines_of(scene)
    if masonry is not None:
        add_joints(lines, scene, masonry, supports)
    system = System(
        bodies,
        lines,
        links_of(ties.body, ties.at, scene.ties.between, k=ties.k, reach=scene.ties.reach, strength=ties.strength,
                 push=ties.push, ultimate=ties.ultimate, broken=np.full(len(ties.k), np.inf)),
        links_of(dampers.body, dampers.at, scene.dampers.between, c=dampers.c),
        links_of(scene.forces.body, scene.forces.at, scene.forces.force),
        course.ground,
        moving(supports),
    )  # fmt: skip
    if masonry is not None:
        take_up_friction(system)
    return system


def lines_of(scene: Scene) -> Rows:
    """The contact lines of a scene, whose faces have no end and which stick rigidly."""
    places = scene.places
    return rows(
        LINE,
        len(scene.contacts.k),
        body=places.body,
        face=places.face_body,
        support=-1,
        group=scene.contacts.joint,
        **named(("at_x", "at_z"), places.at),
        **named(("origin_x", "origin_z"), places.face_at),
        **named(("normal_x", "normal_z"), places.normal),
        **named(("between_x", "between_z"), places.between),
        k=scene.contacts.k,
        c=scene.contacts.c,
        k_s=np.inf,
        friction=scene.contacts.friction,
        low=-FAR,
        high=FAR,
        back=-FAR,
        forth=FAR,
    )


def links_of(body: Integers, at: Array, between: Array, **given: Array) -> Rows:
    """Ties, dampers or forces as rows."""
    if not len(body):
        return rows(LINK, 0)
    held = {**named(("at_x", "at_z"), at), **named(("between_x", "between_z"), between)}
    return rows(LINK, len(body), body=body, **held, **given)


def add_joints(lines: Rows, scene: Scene, masonry: Masonry, supports: Sequence[Support]) -> None:
    """Give lines the shear stiffness of their joint, the ends of its face and edge, and the support that moves it."""
    of = scene.contacts.joint
    ends = np.array(
        [[edge_ends(masonry.blocks[block], joint) for block in (joint.below, joint.above)] for joint in masonry.joints]
    )  # (joints, below and above, 2)
    along = np.array([joint.along for joint in masonry.joints])[of]
    turned = lines["normal_z"] * along[:, 0] - lines["normal_x"] * along[:, 1] < 0  # the point is on the block below
    place = lines["between_x"] * along[:, 0] + lines["between_z"] * along[:, 1]
    face = np.where(turned[:, None], ends[of, 1], ends[of, 0])
    edge = np.where(turned[:, None], ends[of, 0], ends[of, 1]) - place[:, None]
    face, edge = (np.where(turned[:, None], -values[:, ::-1], values) for values in (face, edge))
    for (low, high), ends_of in ((("low", "high"), face), (("back", "forth"), edge)):
        beyond = OVERHANG * (ends_of[:, 1] - ends_of[:, 0])
        lines[low], lines[high] = ends_of[:, 0] - beyond, ends_of[:, 1] + beyond
    lines["k_s"] = masonry.joint_shear[of] * lines["k"] / masonry.joint_stiffness[of]
    sprung = np.isfinite(lines["k_s"])
    lines["c_s"][sprung] = lines["c"][sprung] * lines["k_s"][sprung] / lines["k"][sprung]
    moved = {support.block: i for i, support in enumerate(supports)}
    below = [moved.get(masonry.joints[j].below, -1) for j in of]
    lines["support"] = np.where(lines["face"] < 0, below, -1)


def moving(supports: Sequence[Support], axes: int = 2) -> Supports:
    """The supports for compiled functions, in the plane or along three axes."""
    sizes = [len(support.t) for support in supports]
    return Supports(
        np.concatenate([np.empty(0), *(support.t for support in supports)]),
        np.concatenate([np.empty((0, axes)), *(support.displacement for support in supports)]),
        np.cumsum([0, *sizes]),
        np.zeros((len(supports), axes)),
        np.zeros((len(supports), axes)),
    )


def take_up_friction(system: System) -> None:
    """Let the lines start with the friction that carries the masonry at rest, the smallest forces that do.

    A structure such as an arch needs friction to stand. Its shear springs would else first have to give way.
    """
    bodies, lines = system.bodies, system.lines
    normal, along = (line_rates(system, way) for way in ways_of(lines))
    pose = stacked(bodies, ("x", "z", "theta")).ravel()
    push = np.maximum(-lines["k"] * (normal @ pose), 0.0)
    force = normal.T @ push
    force[1::3] -= GRAVITY * bodies["mass"]
    for row in system.forces:
        arm = row["at_x"], row["at_z"]
        place = 3 * int(row["body"])
        force[place : place + 2] += row["between_x"], row["between_z"]
        force[place + 2] += arm[1] * row["between_x"] - arm[0] * row["between_z"]
    rubs: Flags = (lines["friction"] > 0) & (push > 0)
    if rubs.any():
        needed = lsmr(along[rubs].T, -force, atol=ENOUGH, btol=ENOUGH, maxiter=5000)[0]
        most = lines["friction"][rubs] * push[rubs]
        drag = np.clip(needed, -most, most)
        sprung = np.isfinite(lines["k_s"][rubs])
        lines["grip"][rubs] = np.where(sprung, -drag / np.where(sprung, lines["k_s"][rubs], 1.0), drag)
