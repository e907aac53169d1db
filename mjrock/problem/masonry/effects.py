"""Effects on masonry: where they act, the forces that they bring, and the masses that they add."""

from __future__ import annotations

import numpy as np

from ...quantities import GRAVITY, Array
from ..wall.damper import Damper
from ..wall.effects import AddedMass, Effect, Load, Thrust, Tie
from .effects_in_space import applied_in_space, held_at
from .masonry import Masonry


def placed(masonry: Masonry, effect: Effect) -> tuple[float, ...]:
    """Where an effect acts on its block, from the origin of the world [m]."""
    if masonry.in_space:
        return tuple(held_at(effect).tolist())
    block = masonry.blocks[effect.block]
    if isinstance(effect, Tie | Damper):
        return block.left_at(effect.height), effect.height
    return float(block.centroid[0]) + getattr(effect, "offset", 0.0), effect.height


def applied(masonry: Masonry, effects: tuple[Effect, ...]) -> Array:
    """Forces and moments of loads, thrusts and added masses on the free blocks, as `falling` takes them."""
    if masonry.in_space:
        return applied_in_space(masonry, effects)
    total = np.zeros((len(masonry.free), 3))
    for effect in effects:
        if not isinstance(effect, Tie):
            row = masonry.free.index(effect.block)
            x, z = np.array(placed(masonry, effect)) - masonry.blocks[effect.block].centroid
            across = effect.force if isinstance(effect, Thrust) else 0.0
            down = (
                effect.force
                if isinstance(effect, Load)
                else GRAVITY * effect.mass
                if isinstance(effect, AddedMass)
                else 0.0
            )
            total[row] += across, -down, across * z + down * x
    return total


def laden(masonry: Masonry, effects: tuple[Effect, ...]) -> tuple[Array, Array, Array]:
    """Mass [kg], centroid [m] and inertia [kg m2] of every block with the masses added to it, shape (blocks, ...)."""
    mass, inertia = (np.array([getattr(block, name) for block in masonry.blocks]) for name in ("mass", "inertia"))
    centroids = np.array(masonry.centroids)
    for effect in effects:
        if isinstance(effect, AddedMass) and effect.mass > 0:
            i = effect.block
            apart, total = np.array(placed(masonry, effect)) - centroids[i], mass[i] + effect.mass
            inertia[i] += mass[i] * effect.mass / total * _second(apart)
            centroids[i] += effect.mass / total * apart
            mass[i] = total
    return mass, centroids, inertia


def _second(apart: Array) -> float | Array:
    """Moment or tensor of inertia of a unit mass at a distance [m2]."""
    square = float(apart @ apart)
    return square if len(apart) == 2 else square * np.eye(3) - np.outer(apart, apart)
