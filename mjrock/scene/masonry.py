"""The scene of masonry: its free blocks as bodies, its contact lines as points and faces."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..machine import memory
from ..problem.masonry.blocks.compound import AnyBlock
from ..problem.masonry.blocks.polyhedron import Polyhedron
from ..problem.masonry.case import MasonryCase
from ..problem.masonry.effects import applied, place_in_world, with_added_masses
from ..problem.masonry.histories import motions_of_tilt
from ..problem.masonry.laws.own_law import Own
from ..problem.masonry.limit.statics import falling, friction_lacking, nudged, slippery
from ..problem.masonry.lines import Lines, free_numbers
from ..problem.masonry.masonry import Masonry
from ..problem.masonry.rest_geometry import MasonryRestGeometry
from ..problem.wall.effect import Effect
from ..problem.wall.effects import link_effects
from ..quantities import GRAVITY, Array, Integers, named, require_kind
from .course import Course
from .parts import GROUND, Bodies, ContactPoints, JointSprings, Limits, attachments
from .rest import UnsettledError, memory_of
from .scene import Scene

SETTLEMENT_OF_STIFF = 1e-5
"""Deformation of joints that count as stiff, at each line under the weight of all blocks [m]."""
BED = 0.5
"""Vertical part of the normal of a joint that counts as level [-]."""
SHARE_OF_FARTHEST = 0.1
"""Displacement of a block that falls in the search for the pose of rest, over the largest of all blocks [-]."""


def masonry_scene(case: MasonryCase) -> Scene:
    """The scene of a case, the masonry under its weight or as drawn: `scene_of` for masonry alone. All cases of it with
    the same effects share it.

    Bodies have the names of the blocks that are not fixed, in order. The groups of contacts are the joints, by name.

    Raises:
        ValueError: if the machine has less memory than set-up takes, or if masonry that is to settle does not stand.
            The message names the blocks that fall.
    """
    require_kind("case", case, MasonryCase)
    require_memory(case.masonry)
    if not case.settled:
        return drawn_masonry(case.masonry, case.passive)
    try:
        require_standing(case.masonry, case.passive)
    except ValueError as error:
        raise ValueError(f"{error}; settled=False in the case runs it as drawn, from springs without load") from None
    return scene_of_masonry(case.masonry, case.passive)


@lru_cache(maxsize=16)
def require_memory(masonry: Masonry) -> None:
    """Raise a ValueError if the machine has less memory than set-up takes, before that takes it: once for each masonry,
    since later runs of it find its set-up done."""
    blocks, lines = len(masonry.free), len(masonry.lines.k)
    needed, available = memory_of(blocks, lines, in_space=masonry.in_space), memory()
    if needed > available:
        raise ValueError(
            f"blocks = {blocks} on {lines} contact lines need about {needed / 1e9:.3g} GB of memory, and the machine "
            f"has {available / 1e9:.3g} GB available; give fewer or larger blocks, or fewer points of a joint"
        )


def masonry_course(case: MasonryCase, scene: Scene) -> Course:
    """The course of the scene of a case: it starts at rest, with the velocities of the case."""
    standstill = np.zeros((len(scene.bodies.names), scene.freedom.nv))
    velocity = standstill if case.velocity is None else np.asarray(case.velocity)
    motion, vertical = case.motion, case.vertical
    if case.tilt is not None:
        motion, vertical = motions_of_tilt(case.tilt, case.duration)
    return Course(scene.at_rest, velocity, case.duration, motion, vertical, transverse=case.transverse)


@lru_cache(maxsize=16)
def require_standing(masonry: Masonry, effects: tuple[Effect, ...] = ()) -> None:
    """Find the masonry at rest under its weight, or raise ValueError with the names of the blocks that fall.

    Blocks that only ties keep from falling are checked by the search for equilibrium alone.
    """
    scene = scene_of_masonry(masonry, effects)
    try:
        pose = scene.at_rest
    except UnsettledError as error:
        require_carried(masonry, effects)
        raise unsettled(masonry, effects, error.pose) from None
    if any(masonry.bonds):
        require_bonds_hold(scene, pose)


def require_bonds_hold(scene: Scene, pose: Array) -> None:
    """Raise ValueError with the names of the joints whose bonds need more than their strength at the pose of rest."""
    contacts = scene.contacts
    push = scene.potential.pushes(pose.ravel())[: len(contacts.k)]
    limit = np.array([np.inf if bond is None else bond.elastic_limit for bond in contacts.bonds])[contacts.joint]
    push = np.where([isinstance(contacts.bonds[i], Own) for i in contacts.joint.tolist()], 0.0, push)  # they hold it
    share = np.where(push < 0, -push / np.maximum(contacts.tension, 1e-300), push / contacts.area / limit)
    torn = np.unique(contacts.joint[share > 1])
    if len(torn):
        names = named([contacts.joints[i] for i in torn])
        raise ValueError(
            f"the masonry cannot stand: at rest the bonds of {names} would need {share.max():.3g} times their strength"
        )


def require_carried(masonry: Masonry, effects: tuple[Effect, ...]) -> None:
    """Raise ValueError with the names of the blocks that fall if rigid blocks cannot carry the weight without ties."""
    falls = falling(masonry, applied(masonry, effects))
    if falls and not any(link.law.holds or link.user_law for link in link_effects(effects).values()):
        lacking = friction_lacking(masonry, applied(masonry, effects))
        remedy = "" if lacking is None else f"; joints that need friction of {lacking[0]:g}: {named(lacking[1])}"
        if masonry.in_space and not any(abs(joint.direction[2]) > BED for joint in masonry.space_joints):
            remedy += "; no joint is level: does z of the drawing point upwards?"
        raise ValueError(f"the masonry cannot stand: {named(falls)} would fall under the weight{remedy}")


def unsettled(masonry: Masonry, effects: tuple[Effect, ...], pose: Array) -> ValueError:
    """The error for masonry that stands as rigid blocks, but for which no pose of rest was found.

    Args:
        masonry, effects: the masonry.
        pose: of its free blocks at the end of the search, shape (free, nq).
    """
    scene = scene_of_masonry(masonry, effects)
    slide, joints = slippery(masonry)
    if slide:
        return ValueError(
            f"the masonry cannot stand: nothing keeps {named(slide)} from sliding, however large k_n is; "
            f"joints that need friction, of any coefficient above 0: {named(joints)}"
        )
    fallen = named(fallen_in(masonry, pose))
    if stands_on_stiff_joints(scene):
        return ValueError(
            f"the masonry cannot stand: rigid blocks would, but on joints of this stiffness {fallen} would fall; "
            "raise k_n"
        )
    if at_limit := nudged(masonry, applied(masonry, effects)):
        names, friction = at_limit
        return ValueError(
            f"the masonry cannot stand: rigid blocks would at their limit alone, and {named(names)} would "
            f"{'slide' if friction else 'tip'}, however large k_n is; give the blocks "
            f"{'more friction' if friction else 'more to stand on'}, or a support or a tie"
        )
    return ValueError(
        f"no pose of rest was found: {fallen} would slide down from the drawn pose on joints of any stiffness that was "
        "tried, although limit analysis finds forces that hold rigid blocks. These joints hold by friction where they "
        "are pressed together, as by wedges, and the weight alone does not press them enough; give the joints more "
        "friction, or the blocks a support or a tie"
    )


def fallen_in(masonry: Masonry, pose: Array) -> tuple[str, ...]:
    """Names of the blocks that have fallen at the end of a search for the pose of rest, of shape (free, nq)."""
    moved = np.linalg.norm(pose[:, : masonry.freedom.translations], axis=1)
    return tuple(
        masonry.names[i]
        for i, distance in zip(masonry.free, moved, strict=True)
        if distance >= SHARE_OF_FARTHEST * moved.max()
    )


def wedged(masonry: Masonry, effects: tuple[Effect, ...] = ()) -> tuple[str, ...]:
    """Names of blocks that rigid blocks would hold by wedging alone, which `falling` does not name; none where the
    masonry comes to rest.

    Friction would hold them if their joints were pressed together. The weight alone does not press joints enough that
    start without load, however stiff they are.
    """
    scene = scene_of_masonry(masonry, effects)
    try:
        _ = scene.at_rest
    except UnsettledError as error:
        if slippery(masonry)[0] or stands_on_stiff_joints(scene) or nudged(masonry, applied(masonry, effects)):
            return ()
        return fallen_in(masonry, error.pose)
    return ()


def stands_on_stiff_joints(scene: Scene) -> bool:
    """Whether masonry comes to rest on joints that settle by no more than SETTLEMENT_OF_STIFF under all of its weight.

    Joints that are stiff for one block are soft for a tall stack, which buckles on them.
    """
    k, k_s = scene.contacts.k, np.asarray(scene.contacts.k_s)
    factor = max(1.0, float(scene.bodies.mass.sum()) * GRAVITY / (SETTLEMENT_OF_STIFF * float(k.min())))
    bonds = tuple(None if isinstance(bond, Own) else bond for bond in scene.contacts.bonds)
    try:
        _ = replace(scene, contacts=replace(scene.contacts, k=factor * k, k_s=factor * k_s, bonds=bonds)).at_rest
    except UnsettledError:
        return False
    return True


@lru_cache(maxsize=16)
def scene_of_masonry(masonry: Masonry, effects: tuple[Effect, ...] = ()) -> Scene:
    """The scene of masonry, which all cases of it with the same effects share."""
    blocks, free, number = masonry.blocks, list(masonry.free), free_numbers(masonry.blocks)
    lines, table = _sorted(masonry.lines, number), masonry.table
    mass, centroids, inertia = with_added_masses(masonry, effects)
    origin = np.where(number[:, None] == GROUND, 0.0, centroids)
    middles = np.array([joint.middle for joint in masonry.joints])
    limits = Limits()
    if len(free) > 1:  # one block is stepped as a wall is
        corners = np.concatenate([blocks[i].corners for i in free])
        extent = max(float(np.abs(blocks[i].corners - centroids[i]).max()) for i in free)
        limits = Limits(float(np.hypot.reduce(np.ptp(corners, axis=0))), 2 * extent, damped_joints=True)
    return Scene(
        Bodies(
            names=tuple(masonry.names[i] for i in free),
            mass=mass[free],
            inertia=inertia[free],
            rest=centroids[free],
            outlines=tuple(blocks[i].corners - centroids[i] for i in free),
            length=max(map(_length, (blocks[i] for i in free))),
            parts={
                body: tuple(part.corners - centroids[i] for part in blocks[i].parts)
                for body, i in enumerate(free)
                if len(blocks[i].parts) > 1
            },
        ),
        ContactPoints(
            body=number[lines.body],
            at=lines.at - centroids[lines.body],
            face_body=number[lines.face],
            face_at=middles[lines.joint] - origin[lines.face],
            normal=lines.normal,
            k=lines.k,
            c=masonry.retardation[lines.joint] * lines.k,
            friction=masonry.joint_friction[lines.joint],
            joint=lines.joint,
            joints=tuple(joint.name for joint in masonry.joints),
            k_s=masonry.joint_shear[lines.joint] * lines.k / masonry.joint_stiffness[lines.joint],
            area=masonry.areas_of(lines.k, lines.joint),
            bonds=masonry.bonds,
            further={name: values[lines.joint] for name, values in table.further.items()},
        ),
        *attachments(effects, number, lambda effect: place_in_world(masonry, effect), centroids[free]),
        limits=limits,
        made_of=MasonryRestGeometry(masonry, centroids),
        springs=JointSprings(
            masonry.joint_stiffness,
            masonry.joint_shear,
            masonry.retardation,
            masonry.joint_friction,
            masonry.residual_friction,
            table.points,
            masonry.of_pair if callable(masonry.pairs) else masonry.of_pair(0, 1),
        ),
        title=f"Masonry of {len(free)} blocks on {len(masonry.joints)} joints",
    )


@lru_cache(maxsize=16)
def drawn_masonry(masonry: Masonry, effects: tuple[Effect, ...] = ()) -> Scene:
    """The same scene with the blocks as drawn in the place of the pose of rest."""
    scene = scene_of_masonry(masonry, effects)
    return replace(scene, settled=scene.potential.unmoved)


def _length(block: AnyBlock) -> float:
    """Extent along the facade [m]."""
    return float(np.ptp(block.corners[:, 1])) if isinstance(block, Polyhedron) else block.length


def _sorted(lines: Lines, number: Integers) -> Lines:
    """Lines in the order in which MuJoCo keeps contacts: by the lower and then the higher of their two bodies."""
    pair = np.sort(number[np.array([lines.body, lines.face])], axis=0)
    order = np.lexsort((pair[1], pair[0]))
    return Lines(*(values[order] for values in lines))  # type: ignore[arg-type]
