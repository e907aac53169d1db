"""The links of explicit steps: which kinds there are, and what the steps and a run ask of all of them."""

from __future__ import annotations

import numpy as np

from ..compiled import inlined, method
from ..problem.masonry.case import AnyCase
from ..quantities import Array
from ..scene.scene import Scene
from .kinds.actuators import Actuators
from .kinds.constant_forces import ConstantForces
from .kinds.dampers import Dampers
from .kinds.link import Kind
from .kinds.ties import Ties
from .rows import Row, Rows
from .system import Books, Links, System

KINDS: tuple[type[Kind], ...] = (Ties, Dampers, Actuators, ConstantForces)
"""The kinds of links, in the order in which they act."""

act, hold = method("act"), method("hold")


def links_of(scene: Scene, case: AnyCase, bodies: Rows) -> tuple[tuple[tuple[str, ...], ...], Links]:
    """The links of a scene of a case, whose bodies are at rest: their names, and a table, for each kind."""
    names, links = zip(*(kind.of(scene, case, bodies) for kind in KINDS), strict=True)
    return names, numbered(links)


def numbered(links: Links) -> Links:
    """Links whose rows have the numbers of their links and of their accounts."""
    number = account = 0
    for table in links:
        each, booked = np.arange(len(table.rows)), len(table.booked)
        table.rows["number"], table.rows["account"] = number + each, account + booked * each
        number, account = number + len(each), account + booked * len(each)
    return links


@inlined
def act_all(links: Links, system: System, books: Books, t: float, h: float) -> None:
    """Let the links of all kinds act at time t, and book what the last step of length h took."""
    if len(links) > 0:
        act(links[0], system, books, t, h)
        act_all(links[1:], system, books, t, h)


@inlined
def hold_all(links: Links, system: System, books: Books, energy: Row, pulled: Array) -> None:
    """Add what the links of all kinds hold to the energy of a sample, and keep the force of each [N]."""
    if len(links) > 0:
        hold(links[0], system, books, energy)
        for i in range(len(links[0].rows)):
            pulled[links[0].rows[i].number] = links[0].rows[i].pulled
        hold_all(links[1:], system, books, energy, pulled)
