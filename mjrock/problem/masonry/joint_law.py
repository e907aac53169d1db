"""The law of a joint: what a contact pushes, what its face holds, and what it stores.

A joint pushes and never pulls. Along its face Coulomb's law holds. Explicit steps and their ledger, the search for the
pose of rest and limit analysis all take the law from here. MuJoCo has the same law in its rows, see `engine.rows`.

A row is anything with these numbers by name: a row of compiled steps, or `Law` with a number or an array for each.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ...compiled import inlined
from ...quantities import Array


class Law(NamedTuple):
    """The numbers of the law, each an array or one for all contacts.

    Args:
        k, c: spring and dashpot along the normal [N/m, N s/m].
        k_s: spring along the face [N/m].
        friction: coefficient of friction [-].
    """

    k: Array | float = 0.0
    c: Array | float = 0.0
    k_s: Array | float = 0.0
    friction: Array | float = 0.0


@inlined
def normal_force(row: Any, gap: Any, rate: Any) -> Any:
    """Force that presses the two sides apart [N], at a gap [m] that grows at a rate [m/s].

    It is that of spring and dashpot while the gap is negative, and never a tension.
    """
    force = -(row.k * gap + row.c * rate)
    return force * ((gap < 0) & (force > 0))


@inlined
def shear_limit(row: Any, push: Any) -> Any:
    """Largest force along the face that holds under a force along the normal [N]."""
    return row.friction * push


@inlined
def stored(row: Any, gap: Any) -> Any:
    """Energy in the spring along the normal [J]."""
    return 0.5 * row.k * gap**2 * (gap < 0)


@inlined
def stored_along(row: Any, square: Any) -> Any:
    """Energy in the spring along the face [J], from the square of its stretch [m2]."""
    return 0.5 * row.k_s * square
