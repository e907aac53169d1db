"""Statics of rigid masonry: whether its weight can be carried by joints that push and rub, and which blocks fall."""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
import scipy
from scipy.sparse import csc_array, csr_array, eye_array, hstack, vstack

from ....bars import waited
from ....geometry.graph import connected_parts
from ....linear import loose
from ....quantities import GRAVITY, Array, Flags, named
from ..laws.bond import strengths
from ..laws.joint_law import shear_limit
from ..laws.own_law import Own
from ..lines import free_numbers, mean_slip_rates, rates
from ..masonry import Masonry

UNBALANCED = 1e-7
"""Force that may be missing, over the weight of all blocks [-]."""
MOVING_VELOCITY = 1e-6
"""Velocity in the mechanism of collapse from which a block counts as moving, over the largest [-]."""

MOST_FRICTION = 2.0
"""Largest coefficient of friction that is thought of as a remedy [-]."""
ROUNDED = 1e-3
"""To how much a coefficient of friction that is lacking is rounded up [-]."""
NUDGE = 1e-3
"""Push to the side, over the weight, under which blocks fall that stand at their limit alone [-]."""
PRICE_BEYOND_FRICTION = 1e-3
"""Price of a force beyond the friction that a joint has, over that of one that is missing [-]."""
EDGES = 8
"""Edges of the pyramid that stands for the cone of friction in space. They lie on the cone. Halfway between two of them
the pyramid has cos(pi/8) = 0.924 of the friction."""


class Pulls(NamedTuple):
    """Ties that pull with what equilibrium asks, up to their strength.

    Args:
        columns: forces of a pull of 1 N on all unknowns, moments over the size of the block, shape (unknowns, t).
        strength: of each [N], shape (t,).
    """

    columns: csc_array
    strength: Array

    @classmethod
    def from_forces(cls, masonry: Masonry, pulls: Array | None = None, strength: Array | None = None) -> Pulls:
        """Those of forces and moments of unit pulls on the free blocks, shape (t, free, 3), in space (t, free, 6);
        none without."""
        sizes, strength = sizes_of(masonry), np.zeros(0) if strength is None else strength
        shape = (len(strength), len(sizes))
        rows = np.zeros(shape) if pulls is None else np.reshape(pulls, shape)
        return cls(csc_array(rows.T / sizes[:, None]), strength)


def falling(masonry: Masonry, applied: Array | float = 0.0, ties: Pulls | None = None) -> tuple[str, ...]:
    """Names of the blocks that fall if the blocks are rigid; none where the joints can carry the weight.

    A linear programme looks for forces at the contact lines, pressing and within the cone of friction, that leave the
    least of the weight unbalanced. Where some is left, the multipliers of the equations of equilibrium are the
    velocities of a mechanism, and the blocks that move in it fall. Limit analysis takes friction as associated. Where
    the joints slide, it can find equilibrium where Coulomb friction has none. In space the cones are pyramids of eight
    edges within them.

    Args:
        masonry: the masonry.
        applied: further forces on each free block and their moment about its centroid, positive where it turns the top
            to the right [N, N, N m], shape (free, 3). In space three forces and three moments, shape (free, 6).
        ties: that hold the blocks, or None.
    """
    answer = _balanced(masonry, applied, masonry.joint_friction, ties=ties)
    if _stands(answer):
        return ()
    lacks = _lacking(masonry, answer.x)
    free = dict(zip((masonry.names[i] for i in masonry.free), lacks.tolist(), strict=True))
    return tuple(name for name in moving(masonry, answer.eqlin.marginals) if free[name])


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
        stands = _stands(_balanced(masonry, applied, np.maximum(friction, middle)))
        low, high = (low, middle) if stands else (middle, high)
    enough = math.ceil(high / ROUNDED) * ROUNDED
    answer = _balanced(masonry, applied, friction, np.maximum(friction, enough))
    m, edges = len(masonry.lines.k), EDGES if masonry.in_space else 2
    beyond = np.reshape(answer.x[edges * m : 2 * edges * m], (edges, m)).sum(axis=0)
    short = np.unique(masonry.lines.joint[(beyond > UNBALANCED) & (friction < enough)[masonry.lines.joint]])
    return enough, tuple(masonry.joints[j].name for j in short)


def nudged(masonry: Masonry, applied: Array | float = 0.0) -> tuple[tuple[str, ...], bool] | None:
    """What falls of rigid blocks that stand at their limit alone: under a nudge sideways, as a share of the weight.

    Returns:
        The names of the blocks, and whether more friction would keep them; None of blocks that stand it to all sides.
    """
    weight = weight_of(masonry).reshape(len(masonry.free), -1)
    for axis in range(masonry.freedom.translations - 1):
        for direction in (NUDGE, -NUDGE):
            push = np.zeros_like(weight)
            push[:, axis] = direction * weight.sum(axis=1)
            if names := falling(masonry, applied + push):
                return names, friction_lacking(masonry, applied + push) is not None
    return None


def slippery(masonry: Masonry) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of blocks that can slide without pressing or opening a joint, and of the joints without friction they
    slide on. No stiffness holds them."""
    blocks, lines, friction = masonry.blocks, masonry.lines, masonry.joint_friction
    sliding = mean_slip_rates(blocks, lines, len(friction))
    parts = sliding.shape[0] // len(friction)
    free = loose(csr_array(vstack([rates(blocks, lines, lines.normal), sliding[np.tile(friction > 0, parts)]])))
    moved = np.abs(free).max(axis=1, initial=0.0).reshape(len(masonry.free), -1).max(axis=1)
    slides = np.abs(sliding @ free).max(axis=1, initial=0.0).reshape(parts, -1).max(axis=0)
    return (
        tuple(masonry.names[i] for i, v in zip(masonry.free, moved, strict=True) if v > MOVING_VELOCITY),
        tuple(joint.name for joint, v in zip(masonry.joints, slides, strict=True) if v > MOVING_VELOCITY),
    )


def moving(masonry: Masonry, velocities: Array) -> tuple[str, ...]:
    """Names of the blocks that move in a mechanism, of velocities of all unknowns over the size of their block."""
    speeds = np.abs(velocities).reshape(len(masonry.free), -1).max(axis=1)
    return tuple(
        masonry.names[i] for i, v in zip(masonry.free, speeds, strict=True) if v > MOVING_VELOCITY * speeds.max()
    )


def weight_of(masonry: Masonry) -> Array:
    """The weight of each free block as a generalised force, shape (unknowns,) [N, N m]."""
    down = np.zeros((len(masonry.free), masonry.freedom.nv))
    down[:, masonry.freedom.translations - 1] = [-GRAVITY * masonry.blocks[i].mass for i in masonry.free]
    return down.ravel()


def sizes_of(masonry: Masonry) -> Array:
    """What moments of each unknown are divided by to compare with forces: 1, and the size of the block [m]."""
    d, nv = masonry.freedom.translations, masonry.freedom.nv
    return np.array([(*[1.0] * d, *[masonry.blocks[i].size] * (nv - d)) for i in masonry.free]).ravel()


def method(masonry: Masonry) -> str:
    """How linear programmes are solved: in space by an interior point method, which is several times faster there."""
    return "highs-ipm" if masonry.in_space else "highs"


def least_cost(prices: Array, **programme: object) -> scipy.optimize.OptimizeResult:
    """The answer of a linear programme, as `scipy.optimize.linprog`, with a bar. Ctrl-C ends the wait for it."""
    return waited(partial(scipy.optimize.linprog, prices, **programme), "limit analysis")


def cones(masonry: Masonry, friction: Array, tangents: tuple[Array, ...] | None = None) -> csc_array:
    """Generalised forces of unit pressures along the edges of the cones, moments over the size of the block.

    There is a column for each edge and line, the first edges of all lines before the second, shape (unknowns, edges m).
    The friction is that of each joint [-], shape (joints,). The edges begin at the first of the directions `tangents`
    along the faces, which are those of `Lines.tangents` unless others are given.
    """
    lines = masonry.lines
    law = masonry.table.laws(lines.joint, friction=friction[lines.joint])
    limit = np.asarray(shear_limit(law, 1.0))[:, None]  # along the face, of a unit pressure
    return unit_forces(masonry, lines.normal + limit * cone_edges(tangents or lines.tangents))


def unit_forces(masonry: Masonry, directions: Array) -> csc_array:
    """Generalised forces of unit forces along n directions at each line, of shape (n, m, d), moments over the size of
    the block, shape (unknowns, n m)."""
    rows = rates(masonry.blocks, masonry.lines, directions)
    values = (1 / sizes_of(masonry))[rows.indices] * rows.data
    return csc_array((values, rows.indices, rows.indptr), shape=rows.shape[::-1])


class BondForces(NamedTuple):
    """Forces that the bonds of contact lines hold, in n directions; no columns where no joint has a bond.

    Args:
        columns: generalised forces of unit forces, moments over the size of the block, shape (unknowns, n m).
        limits: their limits [N], shape (n m,).
        directions: unit vectors, shape (n, m, d).
    """

    columns: csc_array
    limits: Array
    directions: Array


def bond_forces(masonry: Masonry, tangents: tuple[Array, ...] | None = None) -> BondForces:
    """What bonds hold beyond the cones: pulls, and forces along the faces in both senses.

    In space the forces along a face fill a square about the circle of the cohesion.
    """
    lines, tangents = masonry.lines, tangents or masonry.lines.tangents
    directions = np.stack([-lines.normal, *(sign * direction for direction in tangents for sign in (1.0, -1.0))])
    if not any(masonry.bonds):
        none = csc_array((len(masonry.free) * masonry.freedom.nv, 0))
        return BondForces(none, np.zeros(0), directions[:0])
    joints_with_bonds = zip(masonry.joints, masonry.bonds, strict=True)
    if pulling := [joint.name for joint, bond in joints_with_bonds if isinstance(bond, Own) and bond.pulls]:
        raise ValueError(
            f"law of {named(pulling)} pulls: limit analysis knows friction of a joint, tension and cohesion of a Bond, "
            "and no law of your own that pulls; solve_explicit takes it"
        )
    area = masonry.areas_of(lines.k, lines.joint)
    pull, along = (area * strengths(masonry.bonds, name)[lines.joint] for name in ("tension", "cohesion"))
    limits = np.concatenate([pull, *[along] * (2 * len(tangents))])
    return BondForces(unit_forces(masonry, directions), limits, directions)


def cone_edges(tangents: tuple[Array, ...]) -> Array:
    """Tangential directions of the edges of the friction cones of lines: two in the plane, shape (edges, m, d)."""
    count = 2 if len(tangents) == 1 else EDGES
    turns = 2 * math.pi * np.arange(count) / count
    spread = np.column_stack([np.cos(turns), np.sin(turns)])[:, : len(tangents)]
    return np.asarray(np.einsum("ea,amd->emd", spread, np.stack(tangents)))


def _balanced(
    masonry: Masonry, applied: Array | float, friction: Array, wider: Array | None = None, ties: Pulls | None = None
) -> scipy.optimize.OptimizeResult:
    """Forces of the contact lines that leave the least of the weight unbalanced, over the weight of all blocks.

    The unknowns are the forces along the edges of the cone of each line, then what is missing. With the friction of a
    `wider` cone, forces along its edges come second and are used as little as possible.
    """
    weight = weight_of(masonry) + np.ravel(applied)
    total = float(np.abs(weight).sum())
    # the edges of the cone of each line carry its force; what is missing pushes in both senses
    edges, cost = [], []
    for cone, price in ((friction, 0.0), (wider, PRICE_BEYOND_FRICTION)):
        if cone is not None:
            edges.append(cones(masonry, cone))
            cost.append(np.full(edges[-1].shape[1], price))
    missing = eye_array(len(weight), format="csc")
    bonds, ties = bond_forces(masonry), ties or Pulls.from_forces(masonry)
    limits = np.append(bonds.limits, ties.strength)
    columns = hstack([*edges, missing, -missing, bonds.columns, ties.columns])
    prices = np.concatenate([*cost, np.ones(2 * len(weight)), np.zeros(len(limits))])
    highest = np.append(np.full(len(prices) - len(limits), np.inf), limits / total)
    bounds = np.column_stack([np.zeros_like(highest), highest])
    return least_cost(
        prices, A_eq=columns, b_eq=-weight / total / sizes_of(masonry), bounds=bounds, method=method(masonry)
    )


def _lacking(masonry: Masonry, forces: Array) -> Flags:
    """Which free blocks are connected with one that lacks forces, shape (free,). Others may slide as these fall, and do
    not fall.

    Args:
        masonry: the masonry.
        forces: the answer of the programme of `_balanced` without a wider cone.
    """
    number, count = free_numbers(masonry.blocks), len(masonry.free)
    pairs = number[np.reshape([(joint.below, joint.above) for joint in masonry.joints], (-1, 2))]
    pairs = pairs[(pairs >= 0).all(axis=1)]
    part = connected_parts(pairs, count)
    unknowns = len(weight_of(masonry))
    first = (EDGES if masonry.in_space else 2) * len(masonry.lines.k)
    missing = forces[first : first + 2 * unknowns].reshape(2, count, -1).sum(axis=(0, 2))
    of_part = np.bincount(part, weights=missing)
    return np.asarray((of_part >= min(UNBALANCED, of_part.max()))[part])


def _stands(answer: scipy.optimize.OptimizeResult) -> bool:
    """Whether nothing of the weight is missing, or the programme found no answer."""
    return bool(answer.status != 0 or answer.fun <= UNBALANCED)
