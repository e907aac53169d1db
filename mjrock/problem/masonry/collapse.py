"""The push that rigid masonry bears, by limit analysis, and the mechanism in which it fails."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.sparse import hstack

from ...quantities import Array, named, require_array, require_flag, require_kind, require_reals, require_within, shown
from .joint_forces import JointForces, joint_forces
from .joint_law import Law, shear_limit
from .joints_in_space import axes_along
from .limit_state import Programme, states_without_dilatancy
from .masonry import Masonry
from .statics import bonded, cones, edges_of, falling, method, moving, sizes_of, weight_of

LARGEST = 1e6
"""Multiplier from which it counts as infinite [-]."""


@dataclass(frozen=True)
class Collapse:
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
    """

    multiplier: float
    direction: Array = field(compare=False)
    moving: tuple[str, ...]
    motion: Array = field(compare=False, repr=False)
    forces: JointForces | None = field(default=None, compare=False, repr=False)
    others: tuple[float, ...] = ()
    masonry: Masonry | None = field(default=None, compare=False, repr=False)


def collapse_multiplier(
    masonry: Masonry,
    direction: float | ArrayLike | None = 1,
    *,
    angle: float | None = None,
    associated: bool = True,
    loads: Mapping[str, ArrayLike] | None = None,
) -> Collapse:
    """The largest horizontal acceleration over g that masonry of rigid blocks stands, and the mechanism beyond it.

    A horizontal force on every block, proportional to its weight, grows for as long as forces at the contact lines
    balance it, pressing and within the cones of friction. The joints are those of the masonry, with its `points`. In
    space a cone is a pyramid of eight edges within it, of which one lies along the force.

    Limit analysis has two answers. With associated friction what slides also opens its joint, as if the cone were its
    plastic potential. A linear programme then has one answer, and where blocks slide it is an upper bound of that of
    Coulomb friction. Without dilatancy what slides stays closed. There are many states then in which forces within the
    cones do not stop a mechanism, as the joints may be more or less wedged. The answer is the least multiplier that a
    descent finds from some starts, and `Collapse.others` has the rest. A state below it may exist.

    Bonds of mortared joints hold their tension and cohesion everywhere at once, which moves the apex of the cones. As
    they soften, this is an upper bound.

    Args:
        masonry: the masonry.
        direction: of the force, which is opposite to the acceleration of the ground: 1 along x, -1 against it, or in
            space a vector in plan, shape (2,), of any length. None for `loads` alone.
        angle: of the force in plan, from x towards y [rad], -2 pi to 2 pi, in space; it takes the place of `direction`.
        associated: whether sliding opens joints. False for friction without dilatancy, which takes some seconds for a
            hundred blocks in the plane, and half a minute for thirty in space.
        loads: further forces that grow with the multiplier, by the name of their block: at its centroid along x and z
            [N], or with the moment about it, positive where it turns the top to the right [N m], shape (2,) or (3,); in
            space forces along x, y and z, or with three moments, shape (3,) or (6,).

    Returns:
        The `Collapse`: `multiplier` [-], and the mechanism and the forces of the joints at it.

    Raises:
        ValueError: for masonry that falls under its weight, with the names of the blocks, a direction or a load out of
            range, or if no state without dilatancy is found.

    Examples:
        >>> arch = mr.Masonry.arch(radius=5.0, thickness=0.9)
        >>> round(float(mr.collapse_multiplier(arch).multiplier), 2)
        0.23
    """
    require_kind("masonry", masonry, Masonry)
    dilates = require_flag("associated", associated)
    if not dilates:
        masonry.require_dry("collapse_multiplier without dilatancy")
    parts = 3 if masonry.in_space else 2
    push = np.zeros(parts) if direction is None and angle is None else horizontal(masonry, direction, angle)
    weight, free = weight_of(masonry), len(masonry.free)
    grown = _loads(masonry, {} if loads is None else loads)
    grown[:, :parts] += np.outer(-weight.reshape(free, -1)[:, parts - 1], push)
    if not grown.any():
        raise ValueError("direction = None needs loads that grow with the multiplier, and there are none")
    falls = falling(masonry)
    if falls:
        raise ValueError(f"the masonry cannot stand: {named(falls)} would fall under the weight")
    across = axes_along(masonry.lines.normal, push) if masonry.in_space and push.any() else masonry.lines.across
    found = _associated(masonry, grown, across) if dilates else _without_dilatancy(masonry, grown, across)
    if found is None:
        return Collapse(math.inf, push, (), np.zeros_like(grown), masonry=masonry)
    multipliers, velocities, on_lines = found
    motion = (velocities / sizes_of(masonry)).reshape(grown.shape)
    forces = joint_forces(masonry, float(np.abs(weight).sum()) * on_lines)
    return Collapse(multipliers[0], push, moving(masonry, velocities), motion, forces, multipliers[1:], masonry)


def _associated(masonry: Masonry, grown: Array, across: tuple[Array, ...]) -> tuple[tuple[float], Array, Array] | None:
    """The multiplier, velocities of the mechanism over the size of their block, and forces of the contact lines.

    The forces are those that the lines press with, over the weight of all blocks, shape (m, d).
    """
    weight, sizes, friction = weight_of(masonry), sizes_of(masonry), masonry.joint_friction
    pressed, total, lines = cones(masonry, friction, across), float(np.abs(weight).sum()), masonry.lines
    raised, count = (grown.ravel() / total / sizes)[:, None], pressed.shape[1]
    pulls, held, ways = bonded(masonry, across)
    highest = np.concatenate([np.full(count, np.inf), held / total, [np.inf]])
    bounds, prices = np.column_stack([np.zeros_like(highest), highest]), np.zeros(len(highest))
    prices[-1] = -1.0
    columns = hstack([pressed, pulls, raised])
    answer = scipy.optimize.linprog(
        prices, A_eq=columns, b_eq=-weight / total / sizes, bounds=bounds, method=method(masonry)
    )
    if answer.status == 3 or (answer.status == 0 and answer.x[-1] > LARGEST):
        return None  # unbounded
    if answer.status != 0:
        raise ValueError(f"masonry: the programme for its multiplier has no answer: {answer.message}")
    shares, limits = (
        answer.x[:count].reshape(-1, len(lines.k), 1),
        shear_limit(Law(friction=friction[lines.joint]), 1.0),
    )
    forces = (shares * (lines.normal + np.asarray(limits)[:, None] * edges_of(across))).sum(axis=0)
    forces += (answer.x[count:-1].reshape(-1, len(lines.k), 1) * ways).sum(axis=0)
    return (float(answer.x[-1]),), -np.asarray(answer.eqlin.marginals), forces


def _without_dilatancy(
    masonry: Masonry, grown: Array, across: tuple[Array, ...]
) -> tuple[tuple[float, ...], Array, Array] | None:
    """The same, with the multipliers of all states found, the least first."""
    programme = Programme.of(masonry, grown, across)
    states = states_without_dilatancy(programme)
    if not states:
        return None
    multipliers = tuple(state.multiplier for state in states)
    return multipliers, states[0].p[: programme.unknowns], programme.on_lines(masonry, states[0].x)


def _loads(masonry: Masonry, loads: Mapping[str, ArrayLike]) -> Array:
    """Loads by the name of their block as forces and moments of free blocks, shape (free, 3), in space (free, 6)."""
    require_kind("loads", loads, Mapping)
    forces, full = (3, 6) if masonry.in_space else (2, 3)
    total = np.zeros((len(masonry.free), full))
    rows = {masonry.names[i]: row for row, i in enumerate(masonry.free)}
    for name, load in loads.items():
        if name not in rows:
            raise ValueError(f"loads: {name!r} is not the name of a free block; those are {named(tuple(rows))}")
        given = require_reals(f"loads of {name}", load, f"an array of the shape ({forces},) or ({full},)")
        count = forces if given.shape == (forces,) else full
        total[rows[name], :count] += require_array(f"loads of {name}", given, (count,))
    return total


def horizontal(
    masonry: Masonry, direction: float | ArrayLike | None, angle: float | None, name: str = "direction"
) -> Array:
    """The unit vector of a horizontal force, shape (2,), in space (3,), from what `collapse_multiplier` takes.

    Raises:
        TypeError, ValueError: for what is no direction, with its name.
    """
    given = require_reals(name, 1.0 if direction is None else direction, "1, -1 or a vector in plan of the shape (2,)")
    if given.shape == () and abs(float(given)) == 1:
        given = np.array([float(given), 0.0])
    elif given.shape != (2,) or not masonry.in_space:
        valid = "1 or -1" + (", or a vector in plan of the shape (2,)" if masonry.in_space else "")
        raise ValueError(f"{name} = {shown(direction)} is not a direction; the valid ones are {valid}")
    length = float(np.hypot(*given))
    if not 1e-9 < length < math.inf:
        raise ValueError(f"{name} = {shown(direction)} has a length of {length:g}; it is above 1e-9 and finite")
    if angle is not None:
        if not masonry.in_space:
            raise ValueError(f"angle = {shown(angle)} is for masonry in space; in the plane give {name} = 1 or -1")
        angle = require_within("angle", angle, -2 * math.pi, 2 * math.pi, "rad")
        return np.array([math.cos(angle), math.sin(angle), 0.0])
    return np.append(given / length, 0.0) if masonry.in_space else given
