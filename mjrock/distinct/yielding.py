"""How links with a spring yield in explicit steps: ties as they get longer, friction dampers either way."""

from __future__ import annotations

from ..compiled import inlined, jitable
from .system import Books, Row


@inlined
def elongation(tie: Row, length: float) -> float:
    """Elastic elongation of a link [m], zero where one that only pulls is slack."""
    elastic: float = length - tie.reach
    return elastic if tie.push > 0 else max(0.0, elastic)


@jitable
def let_yield(tie: Row, length: float, books: Books, i: int, t: float) -> None:
    """Let link i yield at its length [m] and the time t, break where it has been drawn out so far, and book it."""
    beyond, shorter = length - tie.reach - tie.strength / tie.k, tie.reach - length - tie.push / tie.k
    if beyond > 0:
        left = tie.ultimate - tie.drawn
        tie.drawn, tie.reach = tie.drawn + min(beyond, left), tie.reach + min(beyond, left)
        books.ties[i] += tie.strength * min(beyond, left)
        if beyond >= left:
            tie.broken = t
            books.broken[i] = 0.5 * tie.strength**2 / tie.k
    elif tie.push > 0 and shorter > 0:
        tie.drawn, tie.reach = tie.drawn + shorter, tie.reach - shorter
        books.ties[i] += tie.push * shorter
