"""Effects on masonry in space: where they act, where they are anchored, and their forces."""

from __future__ import annotations

import numpy as np

from ...quantities import Array, require_whole
from ..wall.damper import Damper
from ..wall.effects import AddedMass, Effect, Load, Thrust, Tie
from .masonry import Masonry
from .polyhedron import Polyhedron

BESIDE = 1e-3
"""How far outside its block a point of an effect may lie [m]: coordinates are rounded."""


def require_in_space(name: str, effect: Effect, masonry: Masonry) -> None:
    """Raise a ValueError that names the field, unless an effect acts on its block and is anchored on another.

    An added mass may lie outside its block.
    """
    if effect.at is None:
        raise ValueError(
            f"{name}, height = {effect.height:g} m is for masonry in the plane; in space give at=(x, y, z)"
        )
    if getattr(effect, "offset", 0.0):
        raise ValueError(f"{name}, offset = {effect.offset:g} m is for masonry in the plane; at has it")  # type: ignore[union-attr]
    block: Polyhedron = masonry.blocks[effect.block]
    if not isinstance(effect, AddedMass):
        _require_on(f"{name}, at", effect.at, block)
    if isinstance(effect, Tie | Damper):
        number = effect.anchor_block
        if number is not None:
            require_whole(f"{name}, anchor_block", number, 0, len(masonry.blocks) - 1)
            if number == effect.block:
                raise ValueError(f"{name}, anchor_block = {number} is the block itself; give another, or None")
            if effect.anchor is None:
                raise ValueError(f"{name}, anchor_block = {number} needs anchor=(x, y, z)")
            _require_on(f"{name}, anchor", effect.anchor, masonry.blocks[number])
        if np.linalg.norm(held_at(effect) - anchored_at(effect)) < 1e-2:
            raise ValueError(f"{name}, anchor = {effect.anchor} m lies at the point that is held; the least is 0.01 m")


def _require_on(name: str, point: tuple[float, ...], block: Polyhedron) -> None:
    outside = float(((point - block.corners[[face[0] for face in block.faces]]) * block.normals).sum(axis=1).max())
    if outside > BESIDE:
        raise ValueError(f"{name} = {point} m lies {outside:.3g} m outside the block; the valid range is on it")


def held_at(effect: Effect) -> Array:
    """The point where an effect acts, at rest [m], shape (3,)."""
    return np.array(effect.at)


def anchored_at(effect: Tie | Damper) -> Array:
    """The anchor of a tie or damper at rest [m], shape (3,)."""
    if effect.anchor is not None:
        return np.array(effect.anchor)
    rise = effect.rise if isinstance(effect, Tie) else 0.0
    return np.asarray(held_at(effect) + np.array([-effect.length, 0.0, rise]))


def force_of(effect: Effect) -> Array:
    """The constant force of a load or a thrust [N], zero of any other effect, shape (3,)."""
    if isinstance(effect, Load):
        return np.array([0.0, 0.0, -effect.force])
    if isinstance(effect, Thrust):
        return np.array([effect.force * part for part in effect.direction or (1.0, 0.0, 0.0)])
    return np.zeros(3)
