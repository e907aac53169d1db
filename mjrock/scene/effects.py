"""Ties, dampers, loads and thrusts on bodies, as arrays of a scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..problem.wall.effects import Effect, Load, Thrust, Tie
from ..quantities import Array
from .arrays import GROUND
from .dampers import damper_fields


def attachments(
    effects: Sequence[Effect], body: Callable[[Effect], int], x: Callable[[Effect], float], centroids: Array
) -> dict[str, Any]:
    """Fields of a scene for its ties, loads and thrusts; nothing where there are none.

    They are named `tie_0`, `load_0`, `thrust_0` and so on, each kind in its order.

    Args:
        effects: the effects; other kinds make no difference.
        body, x: of an effect, the body that it acts on, and where it does from the origin of the world, at rest [m].
        centroids: of the bodies at rest [m], shape (bodies, 2).
    """
    parts = damper_fields(effects, body, x, centroids)
    ties = [tie for tie in effects if isinstance(tie, Tie)]
    loads = [load for load in effects if isinstance(load, Load)]
    thrusts = [thrust for thrust in effects if isinstance(thrust, Thrust)]

    def placed(some: Sequence[Effect]) -> tuple[Array, Array]:
        return np.array([body(effect) for effect in some]), np.array([(x(effect), effect.height) for effect in some])

    if ties:
        bodies, points = placed(ties)
        parts |= {
            "tie_names": tuple(f"tie_{i}" for i in range(len(ties))),
            "tie_body": bodies,
            "tie_point": points - centroids[bodies],
            "anchor_body": np.full(len(ties), GROUND),
            "anchor": points + [(-tie.length, tie.rise) for tie in ties],
            "tie_k": np.array([tie.stiffness for tie in ties]),
            "tie_length": np.array([tie.reach for tie in ties]),
            "tie_strength": np.array([tie.strength for tie in ties]),
            "tie_ultimate": np.array([tie.breaks_at for tie in ties]),
        }
    if loads or thrusts:
        bodies, points = placed([*loads, *thrusts])
        parts |= {
            "force_names": (*(f"load_{i}" for i in range(len(loads))), *(f"thrust_{i}" for i in range(len(thrusts)))),
            "force_body": bodies,
            "force_point": points - centroids[bodies],
            "force": np.array([(0.0, -load.force) for load in loads] + [(thrust.force, 0.0) for thrust in thrusts]),
        }
    return parts
