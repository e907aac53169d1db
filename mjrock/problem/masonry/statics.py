"""Statics of rigid masonry: whether its weight can be carried by joints that push and rub, and which blocks fall."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.linalg import null_space
from scipy.optimize import linprog
from scipy.sparse import csr_array, eye_array, hstack

from ...quantities import GRAVITY, Array
from .lines import rates
from .masonry import Masonry

UNBALANCED = 1e-7
"""Force that may be missing, over the weight of all blocks [-]."""
MOVES = 1e-6
"""Velocity in the mechanism of collapse from which a block counts as moving, over the largest [-]."""

MOST_FRICTION = 2.0
"""Largest coefficient of friction that is thought of as a remedy [-]."""
ROUNDED = 1e-3
"""To how much a coefficient of friction that is lacking is rounded up [-]."""
DEAR = 1e-3
"""Price of a force beyond the friction that a joint has, over that of one that is missing [-]."""


def falling(masonry: Masonry, applied: Array | float = 0.0) -> tuple[str, ...]:
    """Names of the blocks that fall if the blocks are rigid; none where the joints can carry the weight.

    A linear programme looks for forces at the contact lines, pressing and within the cone of friction, that leave the
    least of the weight unbalanced. Where some is left, the multipliers of the equations of equilibrium are the
    velocities of a mechanism, and the blocks that move in it fall. Limit analysis takes friction as associated. Where
    the joints slide, it can find equilibrium where Coulomb friction has none.

    Args:
        masonry: the masonry.
        applied: further forces on each free block and their moment about its centroid, positive where it turns the top
            to the right [N, N, N m], shape (free, 3).
    """
    answer = _balanced(masonry, applied, masonry.joint_friction)
    if _stands(answer):
        return ()
    moving = np.abs(answer.eqlin.marginals).reshape(-1, 3).max(axis=1)
    return tuple(masonry.names[i] for i, v in zip(masonry.free, moving, strict=True) if v > MOVES * moving.max())


def friction_lacking(masonry: Masonry, applied: Array | float = 0.0) -> tuple[float, tuple[str, ...]] | None:
    """Friction that would keep rigid blocks from falling, or None where none does.

    Returns:
        The least coefficient that every joint would need to have at least [-], rounded up, and the names of joints that
        have less and lean on it.
    """
    friction = masonry.joint_friction
    low, high = 0.0, MOST_FRICTION
    if not _stands(_balanced(masonry, applied, np.maximum(friction, high))):
        return None
    while high - low > 0.5 * ROUNDED:
        middle = 0.5 * (low + high)
        low, high = (
            (low, middle) if _stands(_balanced(masonry, applied, np.maximum(friction, middle))) else (middle, high)
        )
    enough = math.ceil(high / ROUNDED) * ROUNDED
    answer = _balanced(masonry, applied, friction, np.maximum(friction, enough))
    m = len(masonry.lines.k)
    beyond = np.reshape(answer.x[2 * m : 4 * m], (2, m)).sum(axis=0)
    short = np.unique(masonry.lines.joint[(beyond > UNBALANCED) & (friction < enough)[masonry.lines.joint]])
    return enough, tuple(masonry.joints[j].name for j in short)


def slippery(masonry: Masonry) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of blocks that can slide without pressing or opening a joint, and of the joints without friction they
    slide on. No stiffness holds them."""
    blocks, lines, friction = masonry.blocks, masonry.lines, masonry.joint_friction
    opening, sliding = rates(blocks, lines, lines.normal), rates(blocks, lines, lines.along)
    slips = np.array([sliding[lines.joint == j].mean(axis=0) for j in range(len(friction))])
    free = null_space(np.vstack([opening, slips[friction > 0]]), rcond=1e-9)
    moving = np.abs(free).max(axis=1, initial=0.0).reshape(-1, 3).max(axis=1)
    loose = np.abs(slips @ free).max(axis=1, initial=0.0)
    return (
        tuple(masonry.names[i] for i, v in zip(masonry.free, moving, strict=True) if v > MOVES),
        tuple(joint.name for joint, v in zip(masonry.joints, loose, strict=True) if v > MOVES),
    )


def _balanced(masonry: Masonry, applied: Array | float, friction: Array, dear: Array | None = None) -> Any:
    """Forces of the contact lines that leave the least of the weight unbalanced, over the weight of all blocks.

    The unknowns are the forces along both edges of the cone of each line, then what is missing. With `dear`, a wider
    cone, forces along its edges come second and are used as little as possible.
    """
    lines, free = masonry.lines, [masonry.blocks[i] for i in masonry.free]
    pressing, rubbing = rates(masonry.blocks, lines, lines.normal), rates(masonry.blocks, lines, lines.along)
    weight = (np.array([(0.0, -GRAVITY * block.mass, 0.0) for block in free]) + applied).ravel()
    total = float(np.abs(weight).sum())
    sizes = np.array([(1.0, 1.0, block.size) for block in free]).ravel()
    # the edges of the cone of each line carry its force; what is missing pushes either way
    edges, cost = [], []
    for cone, price in ((friction, 0.0), (dear, DEAR)):
        if cone is not None:
            mu = cone[lines.joint][:, None]
            edges.append(csr_array(np.vstack([pressing + mu * rubbing, pressing - mu * rubbing]).T / sizes[:, None]))
            cost.append(np.full(2 * len(lines.k), price))
    missing = eye_array(len(weight))
    columns = hstack([*edges, missing, -missing])
    prices = np.concatenate([*cost, np.ones(2 * len(weight))])
    return linprog(prices, A_eq=columns, b_eq=-weight / total / sizes, method="highs")


def _stands(answer: Any) -> bool:
    """Whether nothing of the weight is missing, or the programme found no answer."""
    return bool(answer.status != 0 or answer.fun <= UNBALANCED)
