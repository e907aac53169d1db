"""Statics of rigid masonry: whether its weight can be carried by joints that push and rub, and which blocks fall."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array, eye_array, hstack

from .lines import rates
from .masonry import Masonry
from .quantities import GRAVITY, Array

UNBALANCED = 1e-7
"""Force that may be missing, over the weight of all blocks [-]."""
MOVES = 1e-6
"""Velocity in the mechanism of collapse from which a block counts as moving, over the largest [-]."""


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
    lines, free = masonry.lines, [masonry.blocks[i] for i in masonry.free]
    across = np.column_stack([lines.normal[:, 1], -lines.normal[:, 0]])
    mu = masonry.joint_friction[lines.joint][:, None]
    pressing, rubbing = rates(masonry.blocks, lines, lines.normal), rates(masonry.blocks, lines, across)
    weight = (np.array([(0.0, -GRAVITY * block.mass, 0.0) for block in free]) + applied).ravel()
    total = float(np.abs(weight).sum())
    sizes = np.array([(1.0, 1.0, block.size) for block in free]).ravel()
    # the edges of the cone of each line carry its force; what is missing pushes either way
    edges: Array = np.vstack([pressing + mu * rubbing, pressing - mu * rubbing]).T / sizes[:, None]
    missing = eye_array(len(weight))
    columns = hstack([csr_array(edges), missing, -missing])
    cost = np.append(np.zeros(edges.shape[1]), np.ones(2 * len(weight)))
    found = linprog(cost, A_eq=columns, b_eq=-weight / total / sizes, method="highs")
    if found.status != 0 or found.fun <= UNBALANCED:
        return ()
    moving = np.abs(found.eqlin.marginals).reshape(-1, 3).max(axis=1)
    return tuple(masonry.names[i] for i, v in zip(masonry.free, moving, strict=True) if v > MOVES * moving.max())
