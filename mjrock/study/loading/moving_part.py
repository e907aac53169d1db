"""The part of masonry that moves in a mechanism: its weights, their displacements, and the virtual work."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...problem.masonry.effects import applied, inertia_of_added_masses, place_in_world, wrench
from ...problem.masonry.limit.collapse import Collapse, pushed
from ...problem.masonry.limit.pose import Moves
from ...problem.masonry.limit.statics import weight_of
from ...problem.masonry.masonry import Masonry
from ...problem.wall.effect import Effect
from ...quantities import GRAVITY, Array, Integers


class MovingPart(NamedTuple):
    """The blocks that move as a mechanism begins, and the masses on them.

    Args:
        names: of the blocks.
        weight: of each block and then of each added mass [N], shape (k,).
        block: numbers of their blocks, shape (k,).
        at: where they are at rest [m], shape (k, d).
        direction: unit vector of the horizontal force, shape (d,).
        sway: virtual displacement of each along it, over that of their common centroid [-], shape (k,).
    """

    names: tuple[str, ...]
    weight: Array
    block: Integers
    at: Array
    direction: Array
    sway: Array

    @classmethod
    def from_collapse(cls, collapse: Collapse, masonry: Masonry, effects: tuple[Effect, ...]) -> MovingPart:
        """That of the mechanism of masonry with its effects."""
        numbers = [masonry.names.index(name) for name in collapse.moving]
        masses = [effect for effect in effects if effect.mass_added and effect.block in numbers]
        block = np.array(numbers + [effect.block for effect in masses])
        mass = [masonry.blocks[i].mass for i in numbers] + [effect.mass_added for effect in masses]
        at = np.array([masonry.centroids[i] for i in numbers] + [place_in_world(masonry, effect) for effect in masses])
        arms = at - np.asarray(masonry.centroids)[block]
        rows = [masonry.free.index(i) for i in block]
        sway = [wrench(arm, collapse.direction) @ collapse.motion[row] for arm, row in zip(arms, rows, strict=True)]
        weight, speed = GRAVITY * np.array(mass), np.array(sway)
        return cls(collapse.moving, weight, block, at, collapse.direction, speed * weight.sum() / (weight @ speed))

    @property
    def participation(self) -> float:
        """e*, the share of its mass that takes part [-], C8.7.1.5."""
        first, second = float(self.weight @ self.sway), float(self.weight @ self.sway**2)
        return min(first**2 / (float(self.weight.sum()) * second), 1.0)

    def displacement(self, masonry: Masonry, pose: Array) -> Array:
        """How far its centroid has gone along the force in poses of the free blocks [m], shape (n,)."""
        places = np.array([Moves.from_pose(masonry, placed).at(self.block, self.at) for placed in pose])
        return np.asarray(((places - self.at) @ self.direction) @ self.weight / self.weight.sum())


def multiplier_of(collapse: Collapse, masonry: Masonry, effects: tuple[Effect, ...]) -> float:
    """The multiplier of a mechanism without its ties, by virtual work of what is constant and of what grows [-]."""
    velocity, direction = collapse.motion.ravel(), collapse.direction
    constant = weight_of(masonry) + applied(masonry, effects).ravel()
    grown = pushed(masonry, direction) + inertia_of_added_masses(masonry, effects, direction)
    return float(-(constant @ velocity) / (grown.ravel() @ velocity))
