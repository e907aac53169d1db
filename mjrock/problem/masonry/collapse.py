"""The horizontal acceleration that rigid masonry stands, by limit analysis, and the mechanism in which it fails."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.sparse import hstack

from ...quantities import Array, named, require_kind, require_reals, require_within, shown
from .joints_in_space import axes_along
from .masonry import Masonry
from .statics import cones, falling, method, moving, sizes_of, weight_of

LARGEST = 1e6
"""Multiplier from which it counts as infinite [-]."""


@dataclass(frozen=True)
class Collapse:
    """How rigid masonry fails under a horizontal force that is proportional to its weight.

    Args:
        multiplier: the largest force over the weight that it stands [-]: the acceleration over g. Infinite where no
            mechanism gives way to the force.
        direction: unit vector of the force, shape (2,), in space (3,).
        moving: names of the blocks that move in the mechanism, none where the multiplier is infinite.
        motion: velocity of each free block in it, as in `MasonryCase.velocity`, shape (free, 3), in space (free, 6).
            The mean over the mass of all free blocks is 1 m/s along the force.
    """

    multiplier: float
    direction: Array = field(compare=False)
    moving: tuple[str, ...]
    motion: Array = field(compare=False, repr=False)


def collapse_multiplier(masonry: Masonry, direction: float | ArrayLike = 1, *, angle: float | None = None) -> Collapse:
    """The largest horizontal acceleration over g that masonry of rigid blocks stands, and the mechanism beyond it.

    A linear programme raises a horizontal force on every block, proportional to its weight, for as long as forces at
    the contact lines balance it, pressing and within the cones of friction. The joints are those of the masonry, with
    its `points`. Limit analysis takes friction as associated: where blocks slide, sliding opens the joint, and the
    multiplier is an upper bound of that of Coulomb friction. In space a cone is a pyramid of eight edges within it, of
    which one lies along the force.

    Args:
        masonry: the masonry.
        direction: of the force, which is opposite to the acceleration of the ground: 1 along x, -1 against it, or in
            space a vector in plan, shape (2,), of any length.
        angle: of the force in plan, from x towards y [rad], -2 pi to 2 pi, in space; it takes the place of `direction`.

    Raises:
        ValueError: for masonry that falls under its weight, with the names of the blocks, or a direction out of range.
    """
    require_kind("masonry", masonry, Masonry)
    push = _push(masonry, direction, angle)
    falls = falling(masonry)
    if falls:
        raise ValueError(f"the masonry cannot stand: {named(falls)} would fall under the weight")
    across, weight, sizes = None, weight_of(masonry), sizes_of(masonry)
    if masonry.in_space:
        across = axes_along(masonry.lines.normal, push)
    pressed = cones(masonry, masonry.joint_friction, across)
    sideways = np.zeros((len(masonry.free), 6 if masonry.in_space else 3))
    sideways[:, : len(push)] = np.outer(-weight.reshape(len(masonry.free), -1)[:, len(push) - 1], push)
    total = float(np.abs(weight).sum())
    raised = (sideways.ravel() / total / sizes)[:, None]
    prices = np.zeros(pressed.shape[1] + 1)
    prices[-1] = -1.0
    answer = scipy.optimize.linprog(
        prices, A_eq=hstack([pressed, raised]), b_eq=-weight / total / sizes, method=method(masonry)
    )
    if answer.status == 3 or (answer.status == 0 and answer.x[-1] > LARGEST):
        return Collapse(math.inf, push, (), np.zeros_like(sideways))  # unbounded
    if answer.status != 0:
        raise ValueError(f"masonry: the programme for its multiplier has no answer: {answer.message}")
    velocities = -np.asarray(answer.eqlin.marginals)
    motion = (velocities / sizes).reshape(sideways.shape)
    return Collapse(float(answer.x[-1]), push, moving(masonry, velocities), motion)


def _push(masonry: Masonry, direction: float | ArrayLike, angle: float | None) -> Array:
    """The unit vector of the force, shape (2,), in space (3,)."""
    given = require_reals("direction", direction, "1, -1 or a vector in plan of the shape (2,)")
    if given.shape == () and abs(float(given)) == 1:
        given = np.array([float(given), 0.0])
    elif given.shape != (2,) or not masonry.in_space:
        valid = "1 or -1" + (", or a vector in plan of the shape (2,)" if masonry.in_space else "")
        raise ValueError(f"direction = {shown(direction)} is not a direction; the valid ones are {valid}")
    length = float(np.hypot(*given))
    if not 1e-9 < length < math.inf:
        raise ValueError(f"direction = {shown(direction)} has a length of {length:g}; it is above 1e-9 and finite")
    if angle is not None:
        if not masonry.in_space:
            raise ValueError(f"angle = {shown(angle)} is for masonry in space; in the plane give direction = 1 or -1")
        angle = require_within("angle", angle, -2 * math.pi, 2 * math.pi, "rad")
        return np.array([math.cos(angle), math.sin(angle), 0.0])
    return np.append(given / length, 0.0) if masonry.in_space else given
