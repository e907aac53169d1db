"""The scene of a wall: a case and its contacts as one body on a base, with a side stop where the case has one."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..method import METHOD, Method
from ..problem.damping.contacts import Contacts
from ..problem.wall.block import Block
from ..problem.wall.case import Case
from ..problem.wall.effect import Effect
from ..problem.wall.rest_geometry import WallRestGeometry
from ..quantities import Array, require_kind
from .course import Course
from .parts import GROUND, Bodies, ContactPoints, attachments
from .rest import settled_without_slip
from .scene import Scene


def inner_friction(wall: Block, contacts: Contacts, method: Method = METHOD) -> float:
    """Friction coefficient of the inner edge of a wall with a side stop [-], `free_friction` to `held_friction`.

    While both edges are loaded, up to the uplift rotation theta_u, they slide against each other by b theta_u^2. This
    takes the energy mu m g b theta_u^2. A release at alpha/2 has about (3/8) m g b alpha. On a stiff base the share is
    negligible, and the inner edge has to hold where a soft side stop lets the wall lean on it. On a soft base the wall
    never leans on it.
    """
    allowed = method.self_work * 0.375 * wall.alpha / contacts.uplift_rotation(wall) ** 2
    return min(max(allowed, method.free_friction), method.held_friction)


def base_friction(wall: Block, contacts: Contacts, side_stop: bool, method: Method) -> Array:
    """Friction coefficients of the lines of the base [-], shape (points,).

    A given coefficient acts at every line. A base that cannot slide has friction at its two edges alone: if all lines
    stuck, they would lock the rotation that shears the base.
    """
    points = contacts.base.points
    if contacts.base.friction is not None:
        return np.full(points, contacts.base.friction)
    friction = np.zeros(points)
    if side_stop:
        friction[0], friction[-1] = inner_friction(wall, contacts, method), method.held_friction * points / 2
    else:
        friction[0] = friction[-1] = method.free_friction * points / 2
    return friction


def wall_scene(case: Case, contacts: Contacts, method: Method = METHOD) -> Scene:
    """The scene of a case on its contacts: `scene_of` for walls alone.

    All cases of one wall with the same effects share it.

    The body is `wall`. The groups of contacts are `base`, from the inner to the outer edge, and `side`, from the bottom
    to the top. The ties are `tie_0`, `tie_1` and so on in the order of the case, the forces `load_0` and `thrust_0`.

    Raises:
        ValueError: if the contacts do not fit the case, or cannot carry it.
    """
    require_kind("case", case, Case)
    require_kind("contacts", contacts, Contacts)
    contacts.require_fit(case.block, side_stop=case.one_sided)
    require_carried(case, contacts)
    return standing_wall(case.wall, contacts, case.stop_top, case.effects, method)


def wall_course(case: Case, scene: Scene) -> Course:
    """The course of the scene of a case.

    The wall is released tilted about its toe, on a base that is compressed until it carries the weight. A wall set down
    on undeformed springs would fall by m g / k and bounce. It would lose in its base an energy of the order of what an
    impact is measured by, 1 % of the release energy on the paper's wall. A wall that is not tilted and not moving is
    released from its equilibrium under all effects.

    Raises:
        ValueError: if the bodies do not stand.
    """
    pose, velocity = scene.at_rest, np.zeros((1, 3))
    if not case.theta0 == case.omega0 == 0:
        pose = scene.lowered(case.wall.pose(np.array([case.theta0])))
        velocity = case.omega0 * case.wall.turning(case.theta0, case.direction)[None]
    return Course(pose, velocity, case.duration, case.motion, case.vertical)


@lru_cache(maxsize=64)
def standing_wall(
    wall: Block, contacts: Contacts, stop_top: float | None, effects: tuple[Effect, ...], method: Method = METHOD
) -> Scene:
    """The scene of a wall, its added masses included, against a stop up to a height [m], or None."""
    base = contacts.base
    centroid = np.array([wall.centroid_offset, wall.centroid_height])
    places = [(x - centroid[0], -centroid[1]) for x in base.positions]
    faces, normals, joint, joints = [(0.0, 0.0)] * base.points, [(0.0, 1.0)] * base.points, [0] * base.points, ["base"]
    k, c, friction = base.stiffness, base.damping, base_friction(wall, contacts, stop_top is not None, method)
    facts: dict[str, float | str] = {"k_n_base": base.k_n, "xi_base": base.xi}
    if stop_top is not None:
        side = contacts.side_up_to(stop_top)
        heights = side.positions + 0.5 * stop_top
        inner = [wall.inner_face(z) for z in heights]
        places += [(x - centroid[0], z - centroid[1]) for x, z in zip(inner, heights, strict=True)]
        faces, normals = faces + [(x, 0.0) for x in inner], normals + [(1.0, 0.0)] * side.points
        joint, joints = joint + [1] * side.points, [*joints, "side"]
        k, c = np.concatenate([k, side.stiffness]), np.concatenate([c, side.damping])
        friction = np.concatenate([friction, np.full(side.points, side.friction or 0.0)])
        facts |= {"k_n_side": side.k_n, "xi_side": side.xi}
    facts |= {"reference_frequency": base.frequency, "law": contacts.law}

    def place(effect: Effect) -> tuple[float, float]:
        return wall.inner_face(effect.height) if effect.on_face else effect.offset, effect.height

    links, forces = attachments(effects, np.zeros(1, dtype=np.int64), place, centroid[None])
    even = wall.centroid_offset == 0 and not (links.bearing.names or forces.names)
    scene = Scene(
        Bodies(
            ("wall",), np.array([wall.mass]), np.array([wall.inertia]), centroid[None], (wall.outline,), wall.length
        ),
        ContactPoints(
            body=np.zeros(len(places), dtype=np.int64),
            at=np.array(places),
            face_body=np.full(len(places), GROUND),
            face_at=np.array(faces),
            normal=np.array(normals),
            k=k,
            c=c,
            friction=friction,
            joint=np.array(joint),
            joints=tuple(joints),
            holds=(np.array(joint) == 0) & (base.friction is None),
        ),
        links,
        forces,
        settled=np.array([[0.0, -wall.weight / float(base.stiffness.sum()), 0.0]]) if even else None,
        title=_title(wall, stop_top),
        facts=facts,
        made_of=WallRestGeometry(wall, stop_top),
    )
    if even:
        return scene
    on_base = replace(scene.contacts, friction=np.where(scene.contacts.joint == 0, friction, 0.0))
    return replace(scene, settled=settled_without_slip(replace(scene, contacts=on_base).potential))


def require_carried(case: Case, contacts: Contacts) -> None:
    """Raise ValueError unless the springs of the base hold the wall upright with its masses and loads."""
    toppling = 0.5 * (case.restoring.outer.Q + case.restoring.inner.Q)
    if not contacts.base.K_rot > toppling:
        least_k_n = contacts.base.k_n * toppling / contacts.base.K_rot
        raise ValueError(
            f"base stiffness k_n = {contacts.base.k_n:g} N/m3 cannot hold the wall upright with its masses and loads; "
            f"the valid range is k_n > {least_k_n:.3g} N/m3"
        )


def _title(wall: Block, stop_top: float | None) -> str:
    """The title of the scene."""
    against = "against a side stop" if stop_top is not None else "on both edges"
    if stop_top is not None and stop_top < 2 * wall.h:
        against += f" {stop_top:g} m high"
    return (
        f"A masonry wall, {2 * wall.b:g} m thick, {2 * wall.h:g} m high, {wall.length:g} m long, "
        f"{wall.density:g} kg/m3, rocking {against}"
    )
