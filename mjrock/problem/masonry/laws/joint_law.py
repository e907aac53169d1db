"""The law of a joint: what a contact pushes, what its face holds, and what it stores.

A joint pushes and never pulls. Along its face Coulomb's law holds. Explicit steps, their ledger and the search for the
pose of rest take the law from here, and limit analysis takes its limit of friction. MuJoCo has the same law in rows of
its own, see `engine.rows`.

The spring along the normal is linear, or one whose secant stiffness k is that of the pose, see `kinds.own`: the linear
spring that stores the same energy there is stiffer by `k_excess`. The six functions from `secant_stiffness` to
`depth_of_energy` define this spring, and explicit steps and the search for the pose of rest have no other one.

A new number of a joint is a field of `Law` here and one of the same name, with its range, in `dry.Dry`. The scene and
the rows of the steps then have it by its name, and solvers that do not know it refuse it by its name.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ....compiled import compiled, inlined
from ....quantities import Array, Flags
from ....rows import Rows, numbers, row_type, rows

LawRow = Any
"""Anything with the numbers of the law by name: a row of compiled steps, a row of `law_rows`, or a `Law`."""


class Law(NamedTuple):
    """The numbers of the law.

    Args:
        k, c: spring and dashpot along the normal [N/m, N s/m].
        k_s: spring along the face [N/m].
        friction: coefficient of friction [-].
        k_excess: stiffness of the linear spring that holds the same energy, less k [N/m].
    """

    k: Any = 0.0
    c: Any = 0.0
    k_s: Any = 0.0
    friction: Any = 0.0
    k_excess: Any = 0.0


EXTENSIVE = ("k", "c", "k_s", "k_excess")
"""Numbers of the law that a part of the area of a line has in proportion. It has the others as they are."""
INTENSIVE = tuple(name for name in Law._fields if name not in EXTENSIVE)
"""Those others: the friction, and the further numbers of a `Dry`, for which masonry has no keyword."""
LAW_ROW = row_type(numbers(*Law._fields))
"""A row with the numbers of the law."""


def law_rows(count: int, **columns: Array) -> Rows:
    """Rows of the law with these columns, and zeros in the others, shape (count,)."""
    return rows(LAW_ROW, count, **columns).view(np.recarray)


@inlined
def secant_stiffness(row: LawRow, depth: float) -> Any:
    """Force of the spring along the normal over its depth [N/m], at a depth [m]."""
    return row.k


@inlined
def equivalent_stiffness(row: LawRow, depth: float) -> Any:
    """Stiffness of the linear spring that holds the same energy at a depth [N/m]."""
    return row.k + row.k_excess


@inlined
def tangent_stiffness(row: LawRow, depth: Any) -> Any:
    """Increase of the force of the spring along the normal with the depth [N/m], at a depth [m]."""
    return row.k


@inlined
def largest_stiffness(row: LawRow) -> Any:
    """Largest stiffness of the spring along the normal at any depth that a run may reach [N/m]: steps are short enough
    for it. A spring that stiffens without end has that at the largest depth for which the law holds."""
    return row.k


@inlined
def depth_of_force(row: LawRow, factor: float, depth: float) -> float:
    """Depth at which the spring along the normal has a multiple of the force that it has at some depth [m]."""
    return factor * depth


@inlined
def depth_of_energy(row: LawRow, factor: float, depth: float) -> float:
    """Depth at which the spring along the normal holds a multiple of the energy that it holds at some depth [m]."""
    return math.sqrt(factor) * depth


@inlined
def normal_force(row: LawRow, gap: float, rate: float) -> float:
    """Force that presses the two sides apart [N], at a gap [m] that grows at a rate [m/s].

    It is that of spring and dashpot while the gap is negative, and never a tension.
    """
    return max(-(secant_stiffness(row, -gap) * gap + row.c * rate), 0.0) if gap < 0 else 0.0


@inlined
def shear_limit(row: LawRow, push: Any) -> Any:
    """Largest force along the face that holds under a force along the normal [N]."""
    return row.friction * push


@inlined
def stored(row: LawRow, gap: float) -> float:
    """Energy in the spring along the normal [J]."""
    depth = min(gap, 0.0)
    energy: float = 0.5 * equivalent_stiffness(row, -depth) * (depth * depth)
    return energy


@inlined
def stored_along(row: LawRow, square: float) -> float:
    """Energy in the spring along the face [J], from the square of its stretch [m2]."""
    energy: float = 0.5 * row.k_s * square
    return energy


def resting(law: Rows, gap: Array, bonded: Flags) -> tuple[Array, Array]:
    """Force along the normal [N] of contacts at rest, and the energy in their springs [J], shape (m,) each, from their
    rows of the law and their gaps [m].

    Those that are bonded pull as they push.
    """
    force, energy, k = np.empty(len(gap)), np.empty(len(gap)), law["k"]
    _resting(law, gap, force, energy)
    return np.where(bonded, -k * gap, force), np.where(bonded, 0.5 * k * gap * gap, energy)


@compiled
def _resting(law: Rows, gap: Array, force: Array, energy: Array) -> None:
    for i in range(len(gap)):
        force[i], energy[i] = normal_force(law[i], gap[i], 0.0), stored(law[i], gap[i])
