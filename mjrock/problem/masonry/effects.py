"""Effects on masonry: where they act and are anchored, the forces that they bring, and the masses that they add."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...quantities import GRAVITY, Array, named, require_whole
from ..wall.effect import Anchored, Effect
from .actuator import Actuator
from .blocks.compound import AnyBlock
from .masonry import Masonry

BESIDE = 1e-3
"""How far outside its block a point of an effect may lie [m]: coordinates are rounded."""


def place_in_world(masonry: Masonry, effect: Effect) -> tuple[float, ...]:
    """Where an effect acts on its block, from the origin of the world [m]."""
    if effect.at is not None:
        return tuple(point_of_effect(effect).tolist())
    block = masonry.polygons[effect.block]
    x = block.left_at(effect.height) if effect.on_face else float(block.centroid[0]) + effect.offset
    return x, effect.height


def applied(masonry: Masonry, effects: tuple[Effect, ...]) -> Array:
    """Forces [N] and moments about the centroids [N m] of loads, thrusts and added masses on the free blocks.

    The shape is (free, 3), in space (free, 6), as `falling` takes them.
    """
    total = np.zeros((len(masonry.free), masonry.freedom.nv))
    for effect in effects:
        force = effect.force_vector or (0.0, 0.0, -GRAVITY * effect.mass_added)
        arm = place_in_world(masonry, effect) - masonry.centroids[effect.block]
        total[masonry.free.index(effect.block)] += wrench(arm, np.array(force)[list(masonry.freedom.axes)])
    return total


def inertia_of_added_masses(masonry: Masonry, effects: tuple[Effect, ...], direction: Array) -> Array:
    """Forces of the added masses under 1 g along a unit vector, shape (2,), in space (3,), as `applied` gives them."""
    total = np.zeros((len(masonry.free), masonry.freedom.nv))
    for effect in effects:
        arm = place_in_world(masonry, effect) - masonry.centroids[effect.block]
        total[masonry.free.index(effect.block)] += wrench(arm, GRAVITY * effect.mass_added * direction)
    return total


def pulls_of(masonry: Masonry, ties: Sequence[Anchored]) -> Array:
    """Forces and moments on the free blocks of each link that pulls with 1 N, shape (t, free, 3), in space
    (t, free, 6)."""
    pulls = np.zeros((len(ties), len(masonry.free), masonry.freedom.nv))
    for pull, tie in zip(pulls, ties, strict=True):
        point = np.array(place_in_world(masonry, tie))
        anchor = tie.anchor_of(point)
        direction = (anchor - point) / np.linalg.norm(anchor - point)
        for block, end, force in ((tie.block, point, direction), (tie.anchor_block, anchor, -direction)):
            if block is not None and block in masonry.free:
                pull[masonry.free.index(block)] += wrench(end - masonry.centroids[block], force)
    return pulls


def wrench(arm: Array, force: Array) -> Array:
    """A force and its moment about a centroid, with the arm from there to the point where it acts [m]."""
    turn = np.cross(arm, force) if len(arm) == 3 else [arm[1] * force[0] - arm[0] * force[1]]
    return np.array([*force, *turn])


class BlockMasses(NamedTuple):
    """Masses of all blocks with what is added to them.

    Args:
        mass: [kg], shape (blocks,).
        centroid: at rest [m], shape (blocks, d).
        inertia: about the centroid [kg m2], shape (blocks,), in space the tensors, shape (blocks, 3, 3).
    """

    mass: Array
    centroid: Array
    inertia: Array


def with_added_masses(masonry: Masonry, effects: tuple[Effect, ...]) -> BlockMasses:
    """Masses of every block with the masses that effects add to it."""
    mass, inertia = (np.array([getattr(block, name) for block in masonry.blocks]) for name in ("mass", "inertia"))
    centroids = np.array(masonry.centroids)
    for effect in effects:
        added = effect.mass_added
        if added > 0:
            i = effect.block
            arm, total = np.array(place_in_world(masonry, effect)) - centroids[i], mass[i] + added
            square = float(arm @ arm)
            second = square * np.eye(3) - np.outer(arm, arm) if masonry.in_space else square
            inertia[i] += mass[i] * added / total * second
            centroids[i] += added / total * arm
            mass[i] = total
    return BlockMasses(mass, centroids, inertia)


def with_block_numbers(name: str, effect: Effect, masonry: Masonry) -> Effect:
    """An effect with the number of each block that it names.

    Raises:
        ValueError: with the name of the effect, for a block that the masonry does not have.
    """
    for field in ("block", "anchor_block"):
        block = getattr(effect, field, None)
        if isinstance(block, str):
            if block not in masonry.names:
                raise ValueError(f"{name}, {field} = {block!r} is no block; the valid ones are {named(masonry.names)}")
            effect = replace(effect, **{field: masonry.names.index(block)})  # type: ignore[type-var]
    return effect


def require_pushing(name: str, actuator: Actuator, masonry: Masonry) -> None:
    """Raise a ValueError that names the field, unless an actuator pushes its block, in the plane or in space."""
    d = masonry.freedom.translations
    if actuator.block is None:
        if len(actuator.direction) != d:
            raise ValueError(f"{name}, direction = {actuator.direction}: all blocks of this masonry take {d} numbers")
        return
    if len(actuator.at) != d:
        raise ValueError(f"{name}, at = {actuator.at} m has {len(actuator.at)} numbers; this masonry takes {d}")
    _require_on(f"{name}, at", actuator.at, masonry.blocks[actuator.block])
    if actuator.guide.rising and actuator.direction[-1] != 0:
        raise ValueError(
            f"{name}, direction = {actuator.direction} rises, which guided = 'translation' keeps the block from; the "
            "valid ones are horizontal"
        )


def require_placed(name: str, effect: Effect, masonry: Masonry) -> None:
    """Raise a ValueError that names the field, unless an effect that is placed by its point acts on its block and is
    anchored on another, in the plane or in space.

    An added mass may lie outside its block.
    """
    d, letters = (3, "(x, y, z)") if masonry.in_space else (2, "(x, z)")
    if effect.at is None:
        raise ValueError(
            f"{name}, height = {effect.height:g} m is for masonry in the plane; in space give at=(x, y, z)"
        )
    for field in ("at", "anchor"):
        place = getattr(effect, field, None)
        if place is not None and len(place) != d:
            raise ValueError(f"{name}, {field} = {place} m has {len(place)} numbers; this masonry takes {letters}")
    if effect.offset:
        raise ValueError(f"{name}, offset = {effect.offset:g} m goes with a height; at has it")
    if effect.on_block:
        _require_on(f"{name}, at", effect.at, masonry.blocks[effect.block])
    require_anchored(name, effect, masonry)
    point = point_of_effect(effect)
    if isinstance(effect, Anchored) and np.linalg.norm(point - effect.anchor_of(point)) < 1e-2:
        raise ValueError(f"{name}, anchor = {effect.anchor} m lies at the point that is held; the least is 0.01 m")


def require_anchored(name: str, effect: Effect, masonry: Masonry) -> None:
    """Raise a ValueError that names the field, unless the anchor of an effect lies on its `anchor_block`, if it has
    one."""
    number = effect.anchor_block if isinstance(effect, Anchored) else None
    if not isinstance(effect, Anchored) or number is None:
        return
    require_whole(f"{name}, anchor_block", number, 0, len(masonry.blocks) - 1)
    if number == effect.block:
        raise ValueError(f"{name}, anchor_block = {number} is the block itself; give another, or None")
    if masonry.in_space and effect.anchor is None:
        raise ValueError(f"{name}, anchor_block = {number} needs anchor=(x, y, z)")
    anchor = tuple(effect.anchor_of(np.array(place_in_world(masonry, effect))).tolist())
    _require_on(f"{name}, anchor", anchor, masonry.blocks[number])


def _require_on(name: str, point: tuple[float, ...], block: AnyBlock) -> None:
    outside = min(max(float((point - side.corners[0]) @ side.normal) for side in part.sides) for part in block.parts)
    if outside > BESIDE:
        raise ValueError(f"{name} = {point} m lies {outside:.3g} m outside the block; the valid range is on it")


def point_of_effect(effect: Effect) -> Array:
    """The point where an effect acts, at rest [m], shape (2,) or (3,)."""
    return np.array(effect.at)
