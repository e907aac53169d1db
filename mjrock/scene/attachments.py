"""Effects on bodies as the links and the constant forces of a scene, in the plane and in space."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

import numpy as np

from ..problem.wall.effect import Effect, LinkLaw
from ..problem.wall.effects import forces_of, links_of
from ..quantities import Array, Integers
from .checks import GROUND
from .parts import ConstantForces, Links


def attachments(
    effects: Sequence[Effect], number: Integers, place: Callable[[Effect], Sequence[float]], centroids: Array
) -> tuple[Links, ConstantForces]:
    """The links and the constant forces that effects bring.

    Args:
        effects: the effects.
        number: of each block among the bodies, GROUND for one that is fixed.
        place: where an effect acts, from the origin of the world, at rest [m].
        centroids: of the bodies at rest [m], shape (bodies, d).
    """
    links, forces, d = links_of(effects), forces_of(effects), centroids.shape[1]

    def on(some: Collection[Effect]) -> tuple[Integers, Array, Array]:
        bodies = number[[effect.block for effect in some]]
        points = np.array([place(effect) for effect in some])
        return bodies, points, points - centroids[bodies]

    pulled, pushed = Links(), ConstantForces()
    if links:
        bodies, points, at = on(links.values())
        blocks = np.array([GROUND if link.anchor_block is None else link.anchor_block for link in links.values()])
        others = np.where(blocks == GROUND, GROUND, number[blocks])
        ends = np.array([link.anchor_of(point) for link, point in zip(links.values(), points, strict=True)])
        ends = ends - np.where(others[:, None] == GROUND, 0.0, centroids[others])
        laws = LinkLaw(*np.array([link.law for link in links.values()]).T)
        pulled = Links(tuple(links), bodies, at, others, ends, **laws._asdict(), anchor_block=blocks)
    if forces:
        bodies, _, at = on([effect for effect, _ in forces.values()])
        vectors = np.array([force for _, force in forces.values()])
        pushed = ConstantForces(tuple(forces), bodies, at, vectors if d == 3 else vectors[:, ::2])
    return pulled, pushed
