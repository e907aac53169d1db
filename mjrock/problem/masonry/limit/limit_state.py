"""States of rigid masonry at its limit: forces of the joints, and a mechanism that these forces do not stop.

Forces of the joints are x >= 0: the pressures n of the contact lines, the shares q of friction along the edges of its
cones, and the friction that is left. They balance the constant forces w, the weight among them, and the multiplier
lambda times the forces f that grow:

    M x + lambda f + w = 0,    M = [N  Q  0; mu G  -E  -I].

The first rows of M are equilibrium. The others say that friction is at most mu times the pressure. A mechanism is p,
the velocities of the blocks and the rates at which joints slide, these negative. Joints open and slide at the rates

    z = M'^T p >= 0,    f . p = 1.

For associated friction M' is M: a joint that slides at a rate s opens at mu s. For Coulomb's friction, without
dilatancy, M' lacks mu G. In a state x . z = 0: what opens bears nothing, and what slides has all its friction against
its slip. With associated friction the largest lambda of a linear programme belongs to the only states. There are many
without dilatancy. The masonry moves in each of them, so that the least lambda is looked for, by descent.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy
from scipy.sparse import block_array, csc_array, csr_array, diags_array, eye_array, hstack, vstack

from ....quantities import Array, Flags, Integers
from ..laws.joint_law import shear_limit
from ..lines import rates
from ..masonry import Masonry
from .statics import Pulls, cone_edges, least_cost, method, sizes_of, weight_of

SLOPE, SHRINKS, LEAST_SLOPE = 0.3, 0.9, 0.01
"""Dilatancy of the first cone that follows the pressures, over the friction, its factor a turn, and the least [-]."""
NEW_SHARE = 0.6
"""Share of the new pressures in those that the next cones stand on [-]."""
TURNS, EVERY = 24, 3
"""Most turns of the search for forces and mechanism of one state, and of the cones; turns from start to start."""
DESCENTS = 60
"""Most steps of a descent."""
SHARED = 1e-10
"""Power x . z up to which forces and mechanism make a state, over that of the forces that grow [-]."""
UNLOADED, UNMOVED_RATE = 1e-9, 1e-8
"""Force that counts as none, over the weight, and a rate, over the largest of its mechanism [-]."""
STATE_TOLERANCE = 1e-7
"""What forces may miss, rates have the wrong sign and both share in a state that is returned, as above [-]."""
GAIN = 1e-9
"""Gain of two steps below which a descent ends [-]."""
PRICE_OF_MULTIPLIER = 1e-3
"""Price of the multiplier in the search for a state, over that of the power that is shared [-]."""
DIGITS = 5
"""Digits of multipliers that tell states apart."""
EXACT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
"""Options of linear programmes: rates and forces are compared with zero."""


class LimitProblem(NamedTuple):
    """Rigid masonry, and what acts on it at its limit.

    Args:
        masonry: the masonry.
        constant: constant forces and moments on the free blocks, the weight among them [N, N m], shape (unknowns,).
        grown: forces and moments that grow [N, N m], shape (free, 3), in space (free, 6).
        tangents: directions along the faces at which the edges of the cones of friction begin, shape (m, d) each.
        ties: those that hold the blocks.
    """

    masonry: Masonry
    constant: Array
    grown: Array
    tangents: tuple[Array, ...]
    ties: Pulls


class State(NamedTuple):
    """A state at the limit.

    Args:
        multiplier: lambda [-].
        x: forces, over the weight of all blocks [-].
        p: velocities of all unknowns, over the size of their block, and rates at which joints slide, negative.
    """

    multiplier: float
    x: Array
    p: Array


@dataclass(frozen=True, eq=False)
class Programme:
    """The matrices of the states of masonry.

    Args:
        matrix: M, moments over the size of their block.
        friction_part: the part mu G of it, in a matrix of the same shape.
        weight: w, weight and other constant forces, over the weight of all blocks, and zero in the rows of friction.
        grown: f, likewise.
        edges: directions of the edges of the cones, shape (edges, groups, d).
        leader: number of the first contact line of each group, shape (groups,). In the plane the lines of a joint are
            one group: they slide as one. In space each is its own.
        unknowns: of the blocks.
        ties: how many there are, whose pulls come last in x, followed by what is left of their strengths.
        method: how linear programmes are solved.
    """

    matrix: csc_array
    friction_part: csc_array
    weight: Array
    grown: Array
    edges: Array
    leader: Integers
    unknowns: int
    ties: int
    method: str

    @classmethod
    def from_problem(cls, problem: LimitProblem) -> Programme:
        """Those of masonry under constant forces, forces that grow, and ties."""
        masonry, ties = problem.masonry, problem.ties
        lines, sizes = masonry.lines, sizes_of(masonry)
        m, group = len(lines.k), np.arange(len(lines.k)) if masonry.in_space else lines.joint
        leader, of_line = np.unique(group, return_index=True, return_inverse=True)[1:]
        edges = cone_edges(problem.tangents)
        rubbing = [rates(masonry.blocks, lines, edge)[leader] for edge in edges]
        limits = np.asarray(shear_limit(masonry.table.laws(lines.joint), 1.0))
        friction, unity = (csr_array((limits, (of_line, np.arange(m))), shape=(len(leader), m)), eye_array(len(leader)))
        pressing = rates(masonry.blocks, lines, lines.normal)
        balance = [diags_array(1 / sizes) @ part.T for part in (pressing, *rubbing)]
        matrix = csc_array(block_array([[*balance, None], [friction, *[-unity] * (len(edges) + 1)]]))
        no_rubbing = csr_array((len(leader), matrix.shape[1] - m))
        friction_part = csc_array(block_array([[csr_array((len(sizes), m)), None], [friction, no_rubbing]]))
        total, none = float(np.abs(weight_of(masonry)).sum()), np.zeros(len(leader))
        down, pushed = (np.append(np.ravel(force) / total / sizes, none) for force in (problem.constant, problem.grown))
        count, yields = len(ties.strength), np.isfinite(ties.strength)
        if count:  # a pull and what is left of it are the strength
            pulls, limit = vstack([ties.columns, csr_array((len(leader), count))]), csr_array(eye_array(count))[yields]
            matrix = csc_array(block_array([[matrix, pulls, None], [None, -limit, -eye_array(limit.shape[0])]]))
            frictionless = csr_array((limit.shape[0], count + limit.shape[0]))
            friction_part = csc_array(block_array([[friction_part, None], [None, frictionless]]))
            down, pushed = np.append(down, ties.strength[yields] / total), np.append(pushed, np.zeros(limit.shape[0]))
        return cls(
            matrix,
            friction_part,
            weight=down,
            grown=pushed,
            edges=edges[:, leader],
            leader=leader,
            unknowns=len(sizes),
            ties=count,
            method=method(masonry),
        )

    def forces(self, cost: Array, price: float, none_at: Flags | None = None) -> scipy.optimize.OptimizeResult:
        """The forces and the multiplier that cost least, the multiplier at `price`, with no force where `none_at`."""
        upper = np.full(len(cost) + 1, np.inf)
        if none_at is not None:
            upper[:-1][none_at] = 0.0
        columns = hstack([self.matrix, csc_array(self.grown[:, None])])
        bounds, prices = np.column_stack([np.zeros_like(upper), upper]), np.append(cost, price)
        return least_cost(prices, A_eq=columns, b_eq=-self.weight, bounds=bounds, method=self.method, options=EXACT)

    def mechanism(self, cost: Array, only_at: Flags | None = None) -> tuple[Array, Array] | None:
        """Rates z and p of the mechanism without dilatancy that costs least, None where nothing can move.

        Joints that are not among `only_at` stay as they are.
        """
        rows, count = self.matrix.shape
        low, high = np.append(np.zeros(count), np.full(rows, -np.inf)), np.full(count + rows, np.inf)
        if only_at is not None:
            high[:count][~only_at] = 0.0
        bounds, right = np.column_stack([low, high]), np.append(np.zeros(count), 1.0)
        prices = np.append(cost, np.zeros(rows))
        answer = least_cost(prices, A_eq=self._moving, b_eq=right, bounds=bounds, method=self.method, options=EXACT)
        if answer.status != 0:
            return None
        z = np.where(answer.x[:count] > UNMOVED_RATE * answer.x[:count].max(), answer.x[:count], 0.0)
        return z, answer.x[count:]

    @cached_property
    def _moving(self) -> csc_array:
        """The equations of z and p in a mechanism."""
        opening = eye_array(self.matrix.shape[1]), (self.friction_part - self.matrix).T
        return csc_array(block_array([[*opening], [None, csr_array(self.grown[None])]]))

    def holds(self, state: State) -> bool:
        """Whether forces balance, nothing that opens or slides does so with the wrong sign, and they share no power."""
        z = (self.matrix - self.friction_part).T @ state.p
        missing = np.abs(self.matrix @ state.x + state.multiplier * self.grown + self.weight).max()
        return bool(max(missing, -z.min() / np.abs(z).max(), abs(state.x @ z)) < STATE_TOLERANCE)

    @property
    def pulled(self) -> int:
        """Where the pulls of the ties begin in x."""
        limited = self.matrix.shape[0] - self.unknowns - len(self.leader)
        return int(self.matrix.shape[1] - self.ties - limited)

    def on_lines(self, masonry: Masonry, x: Array) -> Array:
        """Forces x of a state as those of the contact lines, over the weight of all blocks, shape (m, d)."""
        m, count = len(masonry.lines.k), len(self.edges)
        forces = x[:m, None] * masonry.lines.normal
        shares = x[m : self.pulled].reshape(count + 1, -1)[:count]
        forces[self.leader] += np.einsum("eg,egd->gd", shares, self.edges)
        return np.asarray(forces)


def states_without_dilatancy(programme: Programme) -> tuple[State, ...]:
    """States of friction without dilatancy that differ in their multipliers, the least first, none where nothing moves.

    The starts are those of Gilbert, Casapulla and Ahmed, Computers and Structures 84 (2006) 873: a linear programme in
    which friction is mu times the last pressure, with a dilatancy that shrinks. Its mechanism comes close to a state,
    and often of a high multiplier. From some of them the search descends.

    Raises:
        ValueError: if it finds no state.
    """
    nothing = np.zeros(programme.matrix.shape[1])
    if programme.mechanism(nothing) is None:
        return ()
    ends = [
        _descent_end(programme, _mechanism_near(programme, np.maximum(x, 0.0))) for x in _starts(programme, nothing)
    ]
    limited = [state for state in ends if state is not None and programme.holds(state)]
    states = {round(state.multiplier, DIGITS): state for state in limited}
    if not states:
        raise ValueError(
            "masonry: no state of friction without dilatancy was found near that of associated friction, whose "
            "multiplier is an upper bound; give associated=True, or push the masonry slowly by explicit steps"
        )
    return tuple(states[multiplier] for multiplier in sorted(states))


def _starts(programme: Programme, nothing: Array) -> Iterator[Array]:
    """Forces near states without dilatancy, by cones that follow the pressures from those of associated friction."""
    first = programme.forces(nothing, -1.0)
    last = first.x[:-1] if first.status == 0 else programme.forces(nothing, 1.0).x[:-1]
    yield last
    share = SLOPE
    for turn in range(TURNS):
        moved = replace(
            programme,
            matrix=programme.matrix - (1 - share) * programme.friction_part,
            weight=programme.weight + (1 - share) * (programme.friction_part @ last),
        )
        answer = moved.forces(nothing, -1.0)
        if answer.status != 0:
            return
        if turn % EVERY == EVERY - 1:
            yield answer.x[:-1]
        last = NEW_SHARE * answer.x[:-1] + (1 - NEW_SHARE) * last
        share = max(SHRINKS * share, LEAST_SLOPE)


def _mechanism_near(programme: Programme, x: Array) -> tuple[Array, Array] | None:
    """The mechanism of a state near the forces x, found by turns of forces and mechanisms that share less power."""
    shared: list[float] = []
    for _ in range(TURNS):
        moving = programme.mechanism(x)
        answer = None if moving is None else programme.forces(moving[0], PRICE_OF_MULTIPLIER)
        if moving is None or answer is None or answer.status != 0:
            return None
        x = np.maximum(answer.x[:-1], 0.0)
        shared.append(float(x @ moving[0]))
        if shared[-1] < SHARED:
            return moving
        if len(shared) > 3 and shared[-1] >= shared[-3]:
            return None
    return None


def _descent_end(programme: Programme, moving: tuple[Array, Array] | None) -> State | None:
    """The state at the end of a descent from that of a mechanism, None where it has none.

    The first step takes the least multiplier of all forces that belong to the mechanism. The second looks among the
    forces that the mechanism keeps at zero for those that would lower the multiplier further, and takes the mechanism
    that keeps fewest of them, of those that the forces allow.
    """
    state, nothing = None, np.zeros(programme.matrix.shape[1])
    multipliers: list[float] = []
    while moving is not None and len(multipliers) < DESCENTS:
        moves = moving[0] > 0
        answer = programme.forces(nothing, 1.0, moves)
        if answer.status != 0:
            break
        state = State(float(answer.x[-1]), np.maximum(answer.x[:-1], 0.0), moving[1])
        multipliers.append(state.multiplier)
        gains = np.where(moves, np.maximum(-answer.upper.marginals[:-1], 0.0), 0.0)
        if gains.max() < GAIN or (len(multipliers) > 2 and multipliers[-3] - multipliers[-1] < GAIN):
            break
        moving = programme.mechanism(gains, (state.x < UNLOADED) | moves)
    return state
