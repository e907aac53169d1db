"""The collapse load of rigid masonry by limit analysis, its mechanism, and the forces of joints at rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, hstack

from ....notebook import NotebookPicture
from ....quantities import Array, named
from ...wall.case import Case
from ...wall.effect import Effect
from ..blocks.joints_in_space import tangent_axes_along
from ..laws.joint_law import shear_limit
from ..masonry import Masonry
from .limit_state import LimitProblem, Programme, states_without_dilatancy
from .statics import Pulls, bond_forces, cone_edges, cones, least_cost, method, moving, sizes_of, weight_of


@dataclass(frozen=True, eq=False)
class JointForces:
    """Force of each joint on the block above it, in the order of `masonry.joints`.

    Args:
        normal: along the normal, positive where it presses [N], shape (joints,).
        shear: along `Joint.along`, which is x on a bed joint [N], shape (joints,). In space along the two axes of
            `SpaceJoint.axes`, shape (joints, 2).
        eccentricity: from the middle of the joint to where the force passes through it, in the same directions [m], of
            the shape of `shear`, also where a bond pulls; NaN without a normal force.
    """

    normal: Array
    shear: Array
    eccentricity: Array


def joint_forces(masonry: Masonry, forces: Array) -> JointForces:
    """The forces of joints from those of their contact lines on the block `Lines.body` [N], shape (m, d)."""
    lines, joints = masonry.lines, masonry.joints
    above = np.array([joint.above for joint in joints])[lines.joint]
    forces = np.where(above == lines.body, 1.0, -1.0)[:, None] * forces
    axes = np.array([joint.frame for joint in joints])
    parts = np.einsum("mad,md->ma", axes[lines.joint], forces)
    arms = np.einsum(
        "mad,md->ma", axes[lines.joint], lines.at - np.array([joint.middle for joint in joints])[lines.joint]
    )
    total, moments = np.zeros((len(joints), axes.shape[1])), np.zeros((len(joints), axes.shape[1]))
    np.add.at(total, lines.joint, parts)
    np.add.at(moments, lines.joint, parts[:, :1] * arms)
    normal = total[:, 0]
    shear, eccentricity = total[:, 1:], moments[:, 1:] / np.where(normal != 0, normal, np.nan)[:, None]
    if axes.shape[1] == 2:
        shear, eccentricity = shear[:, 0], eccentricity[:, 0]
    return JointForces(normal.copy(), shear.copy(), eccentricity.copy())


INFINITE_MULTIPLIER = 1e6
"""Multiplier from which it counts as infinite [-]."""
BALANCED_RESULTANT = 1e-9
"""Resultant of forces that grow below which they have no direction, over the sum of their components [-]."""


class UnbalancedError(ValueError):
    """A pose in which no multiplier brings equilibrium."""


@dataclass(frozen=True)
class Collapse(NotebookPicture):
    """How rigid masonry fails under forces that grow.

    Args:
        multiplier: of the forces that grow, at which the masonry moves [-]; of a horizontal force on all blocks it is
            the acceleration over g. Infinite where no mechanism gives way to them.
        direction: unit vector of the horizontal force, shape (2,), in space (3,); zero where only loads grow.
        moving: names of the blocks that move in the mechanism, none where the multiplier is infinite.
        motion: velocity of each free block in it, as in `MasonryCase.velocity`, shape (free, 3), in space (free, 6).
            Under a horizontal force alone the mean along it over the mass of all free blocks is 1 m/s. In general the
            forces that grow do the work of the weight of all free blocks over 1 m, in each second.
        forces: of the joints as the masonry begins to move, or None where the multiplier is infinite. Where the joints
            leave them open, they are one of the choices.
        others: multipliers of other states at the limit that were found without dilatancy, ascending [-].
        masonry: the masonry.
        wedged: names of blocks that stand only by wedging: friction holds them if their joints were pressed together
            before, and no load on joints without load presses them so. Solvers let them fall.
        pulls: of the ties among the effects, in their order [N], shape (ties,).
        loads: the loads that grow, by the name of their block [N] and [N m], or of a wall as effects.
        effects: what is constant.
        case: the wall, where it is that of a `Case`.
    """

    multiplier: float
    direction: Array = field(compare=False)
    moving: tuple[str, ...]
    motion: Array = field(compare=False, repr=False)
    forces: JointForces | None = field(default=None, compare=False, repr=False)
    others: tuple[float, ...] = ()
    masonry: Masonry | None = field(default=None, compare=False, repr=False)
    wedged: tuple[str, ...] = field(default=(), compare=False)
    pulls: Array | None = field(default=None, compare=False, repr=False)
    loads: Mapping[str, tuple[float, ...]] | tuple[Effect, ...] = field(default=(), compare=False, repr=False)
    effects: tuple[Effect, ...] = field(default=(), compare=False, repr=False)
    case: Case | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        if not self.moving:
            return "<Collapse: nothing gives way>"
        wedged = f", which stands by wedging of {named(self.wedged)}" if self.wedged else ""
        return f"<Collapse at {self.multiplier:.4g} times the forces that grow: {named(self.moving)} move{wedged}>"


class LimitLoads(NamedTuple):
    """What acts on masonry at its limit, beside its weight.

    Args:
        push: the unit vector of a horizontal force, or zero, shape (2,), in space (3,).
        grown: forces that grow and their moments about the centroids of the free blocks [N, N m], shape (free, 3), in
            space (free, 6).
        applied: constant ones, likewise.
    """

    push: Array
    grown: Array
    applied: Array | float = 0.0


def limit_of(
    masonry: Masonry, loads: LimitLoads, *, associated: bool = True, ties: Pulls | None = None, least: float = 0.0
) -> Collapse:
    """The multiplier at which rigid masonry moves that stands under its weight, and its mechanism.

    Args:
        masonry: the masonry.
        loads: what acts on it.
        associated: whether sliding opens joints.
        ties: that hold the blocks, or None.
        least: lower bound of the multiplier with associated friction [-], below zero where the masonry is held back.

    Raises:
        ValueError: if no state without dilatancy is found, or no multiplier from `least` on holds the masonry.
    """
    push, grown, applied = loads
    weight, lines, resultant = weight_of(masonry), masonry.lines, grown[:, :3].sum(axis=0)
    turned = masonry.in_space and np.linalg.norm(resultant) > BALANCED_RESULTANT * np.abs(grown[:, :3]).sum()
    tangents = tangent_axes_along(lines.normal, resultant) if turned else lines.tangents
    problem = LimitProblem(masonry, weight + np.ravel(applied), grown, tangents, ties or Pulls.from_forces(masonry))
    forces = _associated(problem, least) if associated else _without_dilatancy(problem)
    if forces is None:
        return Collapse(math.inf, push, (), np.zeros_like(grown), masonry=masonry)
    total, multipliers = float(np.abs(weight).sum()), forces.multipliers
    return Collapse(
        multipliers[0],
        push,
        moving(masonry, forces.velocities),
        (forces.velocities / sizes_of(masonry)).reshape(grown.shape),
        joint_forces(masonry, total * forces.lines),
        multipliers[1:],
        masonry,
        pulls=total * forces.pulls,
    )


def pushed(masonry: Masonry, push: Array) -> Array:
    """A force on every free block in proportion to its weight, along a unit vector, as `LimitLoads` have it."""
    weight = weight_of(masonry).reshape(len(masonry.free), -1)
    force = np.zeros_like(weight)
    force[:, : len(push)] = np.outer(np.abs(weight).sum(axis=1), push)
    return force


class LimitForces(NamedTuple):
    """A state at the limit.

    Args:
        multipliers: of all states found, the least first [-].
        velocities: of the mechanism, over the size of their block.
        lines: forces that the contact lines press with, over the weight of all blocks, shape (m, d).
        pulls: of the ties, likewise, shape (t,).
    """

    multipliers: tuple[float, ...]
    velocities: Array
    lines: Array
    pulls: Array


def _associated(problem: LimitProblem, lowest_multiplier: float) -> LimitForces | None:
    """The state of associated friction, None where nothing gives way. The multiplier is at least the lowest one [-]."""
    masonry, constant, grown, tangents, ties = problem
    sizes, friction, total = sizes_of(masonry), masonry.joint_friction, float(np.abs(weight_of(masonry)).sum())
    pressed, lines = cones(masonry, friction, tangents), masonry.lines
    bonds = bond_forces(masonry, tangents)
    raised, count = csc_array((grown.ravel() / total / sizes)[:, None]), pressed.shape[1]
    end = count + len(bonds.limits)
    highest = np.concatenate([np.full(count, np.inf), bonds.limits / total, ties.strength / total, [np.inf]])
    bounds, prices = np.column_stack([np.zeros_like(highest), highest]), np.zeros(len(highest))
    bounds[-1, 0], prices[-1] = lowest_multiplier, -1.0
    columns = hstack([pressed, bonds.columns, ties.columns, raised])
    answer = least_cost(prices, A_eq=columns, b_eq=-constant / total / sizes, bounds=bounds, method=method(masonry))
    if answer.status == 3 or (answer.status == 0 and answer.x[-1] > INFINITE_MULTIPLIER):
        return None  # unbounded
    if answer.status == 2 and lowest_multiplier < 0:
        raise UnbalancedError("pose: no multiplier of the forces that grow holds the masonry there, either way")
    if answer.status != 0:
        raise ValueError(f"masonry: the programme for its multiplier has no answer: {answer.message}")
    shares, limits = (
        answer.x[:count].reshape(-1, len(lines.k), 1),
        shear_limit(masonry.table.laws(lines.joint, friction=friction[lines.joint]), 1.0),
    )
    forces = (shares * (lines.normal + np.asarray(limits)[:, None] * cone_edges(tangents))).sum(axis=0)
    forces += (answer.x[count:end].reshape(-1, len(lines.k), 1) * bonds.directions).sum(axis=0)
    return LimitForces((float(answer.x[-1]),), -np.asarray(answer.eqlin.marginals), forces, answer.x[end:-1])


def _without_dilatancy(problem: LimitProblem) -> LimitForces | None:
    """The least state without dilatancy, None where nothing gives way."""
    programme = Programme.from_problem(problem)
    states = states_without_dilatancy(programme)
    if not states:
        return None
    multipliers, x = tuple(state.multiplier for state in states), states[0].x
    pulls = x[programme.pulled : programme.pulled + programme.ties]
    return LimitForces(multipliers, states[0].p[: programme.unknowns], programme.on_lines(problem.masonry, x), pulls)
