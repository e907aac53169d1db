"""Effects on masonry: where they act, the forces that they bring, and the masses that they add."""

from __future__ import annotations

import numpy as np

from ...quantities import GRAVITY, Array
from ..wall.damper import Damper
from ..wall.effects import AddedMass, Effect, Tie
from .effects_in_space import force_of, held_at
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
    """Forces [N] and moments about the centroids [N m] of loads, thrusts and added masses on the free blocks.

    The shape is (free, 3), in space (free, 6), as `falling` takes them.
    """
    total = np.zeros((len(masonry.free), 6 if masonry.in_space else 3))
    for effect in effects:
        force = force_of(effect)
        if isinstance(effect, AddedMass):
            force = np.array([0.0, 0.0, -GRAVITY * effect.mass])
        arm, row = np.array(placed(masonry, effect)) - masonry.centroids[effect.block], masonry.free.index(effect.block)
        if masonry.in_space:
            total[row] += [*force, *np.cross(arm, force)]
        else:
            total[row] += force[0], force[2], force[0] * arm[1] - force[2] * arm[0]
    return total


def laden(masonry: Masonry, effects: tuple[Effect, ...]) -> tuple[Array, Array, Array]:
    """Mass [kg], centroid [m] and inertia [kg m2] of every block with the masses added to it, shape (blocks, ...)."""
    mass, inertia = (np.array([getattr(block, name) for block in masonry.blocks]) for name in ("mass", "inertia"))
    centroids = np.array(masonry.centroids)
    for effect in effects:
        if isinstance(effect, AddedMass) and effect.mass > 0:
            i = effect.block
            apart, total = np.array(placed(masonry, effect)) - centroids[i], mass[i] + effect.mass
            square = float(apart @ apart)
            second = square * np.eye(3) - np.outer(apart, apart) if masonry.in_space else square
            inertia[i] += mass[i] * effect.mass / total * second
            centroids[i] += effect.mass / total * apart
            mass[i] = total
    return mass, centroids, inertia
