"""Ties, dampers, loads and thrusts on bodies of space, as arrays of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..problem.masonry.effects import anchored_at, force_of, held_at
from ..problem.wall.damper import Damper
from ..problem.wall.effects import Effect, Load, Thrust, Tie
from ..quantities import Array, Integers
from .arrays import GROUND


def attachments_in_space(effects: Sequence[Effect], number: Integers, centroids: Array) -> dict[str, Any]:
    """Fields of a scene for its ties, dampers, loads and thrusts; nothing where there are none.

    They are named as in the plane, see `attachments`.

    Args:
        effects: the effects; other kinds make no difference.
        number: of each block among the bodies, GROUND for one that is fixed.
        centroids: of the bodies at rest [m], shape (bodies, 3).
    """
    parts: dict[str, Any] = {}
    ties = [effect for effect in effects if isinstance(effect, Tie)]
    dampers = [effect for effect in effects if isinstance(effect, Damper)]
    loads = [effect for effect in effects if isinstance(effect, Load)]
    thrusts = [effect for effect in effects if isinstance(effect, Thrust)]

    def on(some: Sequence[Effect]) -> tuple[Integers, Array]:
        bodies = number[[effect.block for effect in some]]
        return bodies, np.array([held_at(effect) for effect in some]) - centroids[bodies]

    def anchored(some: Sequence[Tie | Damper]) -> tuple[Integers, Array]:
        bodies = np.array([GROUND if link.anchor_block is None else number[link.anchor_block] for link in some])
        start = np.where(bodies[:, None] == GROUND, 0.0, centroids[bodies])
        return bodies, np.array([anchored_at(link) for link in some]) - start

    if ties:
        parts["tie_names"] = tuple(f"tie_{i}" for i in range(len(ties)))
        parts["tie_body"], parts["tie_point"] = on(ties)
        parts["anchor_body"], parts["anchor"] = anchored(ties)
        parts["tie_k"] = np.array([tie.stiffness for tie in ties])
        parts["tie_length"] = np.array([tie.reach for tie in ties])
        parts["tie_strength"] = np.array([tie.strength for tie in ties])
        parts["tie_ultimate"] = np.array([tie.breaks_at for tie in ties])
    if dampers:
        parts["damper_names"] = tuple(f"damper_{i}" for i in range(len(dampers)))
        parts["damper_body"], parts["damper_point"] = on(dampers)
        parts["damper_anchor_body"], parts["damper_anchor"] = anchored(dampers)
        parts["damper_c"] = np.array([damper.c for damper in dampers])
    if loads or thrusts:
        forces: list[Effect] = [*loads, *thrusts]
        names = (*(f"load_{i}" for i in range(len(loads))), *(f"thrust_{i}" for i in range(len(thrusts))))
        parts["force_names"] = names
        parts["force_body"], parts["force_point"] = on(forces)
        parts["force"] = np.array([force_of(effect) for effect in forces])
    return parts
