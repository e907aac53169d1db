"""The kinds of links and the laws of joints: which there are, and the functions that call all of them."""

from __future__ import annotations

import numpy as np

from ...compiled import inlined, method
from ...geometry.vectors import Vector, plus, read
from ...problem.masonry.case import AnyCase
from ...quantities import Array
from ...rows import Row, Rows
from ...scene.scene import Scene
from ..system import Books, System, Tables
from .actuators import Actuators
from .constant_forces import ConstantForces
from .dampers import Dampers
from .law import JointLaw
from .link import Kind
from .mortar import Bonds
from .own import OwnLaws
from .own_links import OwnLinks
from .ties import Ties

KINDS: tuple[type[Kind], ...] = (Ties, Dampers, OwnLinks, Actuators, ConstantForces)
"""The kinds of links, in the order in which they act."""
LAWS: tuple[type[JointLaw], ...] = (Bonds, OwnLaws)
"""The laws of joints beside the dry one, which all lines have."""

act, settle, add_energy = map(method, ("act", "settle", "add_energy"))
stored, lost, holds = map(method, ("stored", "lost", "holds"))


def links_of(scene: Scene, case: AnyCase, bodies: Rows) -> tuple[tuple[tuple[str, ...], ...], Tables]:
    """The links of a scene of a case, whose bodies are at rest: their names, and a table, for each kind."""
    names, links = zip(*(kind.from_scene(scene, case, bodies) for kind in KINDS), strict=True)
    return names, numbered(links)


def numbered(links: Tables) -> Tables:
    """Links whose rows have the numbers of their links and of their accounts."""
    number = account = 0
    for table in links:
        numbers, booked = np.arange(len(table.rows)), len(table.booked)
        table.rows["number"], table.rows["account"] = number + numbers, account + booked * numbers
        number, account = number + len(numbers), account + booked * len(numbers)
    return links


def laws_of(scene: Scene, lines: Rows) -> Tables:
    """The laws of the joints of a scene, which take over the springs of lines that they replace."""
    return tuple(law.from_scene(scene, lines) for law in LAWS)


def no_laws(d: int) -> Tables:
    """The laws of dry joints in d directions."""
    return tuple(law(law.table(d, 0)) for law in LAWS)  # type: ignore[call-arg]


@inlined
def act_all(tables: Tables, system: System, books: Books, t: float, h: float) -> None:
    """Let all links, or all laws, act at time t, and book what the last step of length h took."""
    if len(tables) > 0:
        act(tables[0], system, books, t, h)
        act_all(tables[1:], system, books, t, h)


@inlined
def settle_all(links: Tables, system: System, books: Books, force_time: float) -> tuple[float, float]:
    """Let the links of all kinds do what is left, see `Kind.settle`."""
    if len(links) > 0:
        (dissipated, put_in), (others, others_in) = (
            settle(links[0], system, books, force_time),
            settle_all(links[1:], system, books, force_time),
        )
        return dissipated + others, put_in + others_in
    return 0.0, 0.0


@inlined
def record_links(links: Tables, system: System, books: Books, energy: Row, forces: Array) -> None:
    """Add what the links of all kinds hold to the energy of a sample, and keep the force of each [N]."""
    if len(links) > 0:
        add_energy(links[0], system, books, energy)
        for i in range(len(links[0].rows)):
            forces[links[0].rows[i].number] = links[0].rows[i].force
        record_links(links[1:], system, books, energy, forces)


@inlined
def stored_by_laws(laws: Tables) -> tuple[float, float]:
    """Energy that all laws hold along the normals and along the faces [J]."""
    if len(laws) > 0:
        (along, tangential), (others, others_tangential) = stored(laws[0]), stored_by_laws(laws[1:])
        return along + others, tangential + others_tangential
    return 0.0, 0.0


@inlined
def lost_by_laws(laws: Tables, p: int) -> float:
    """Share of what its law holds that line p has lost, times its part of the area of its joint [-]."""
    if len(laws) > 0:
        share = 0.0
        if p < len(laws[0].rows):
            row = laws[0].rows[p]
            share = row.share * lost(laws[0], row)
        return share + lost_by_laws(laws[1:], p)
    return 0.0


@inlined
def with_laws(laws: Tables, p: int, push: float, friction: Vector, holds: bool) -> tuple[float, Vector, bool]:
    """Force of line p along its normal and its face in the last step with that of its laws [N], and whether one holds
    it, from those of the dry line."""
    if len(laws) > 0:
        if p < len(laws[0].rows) and laws[0].rows[p].k > 0:
            row = laws[0].rows[p]
            push, friction, holds = push + row.push, plus(friction, read(row.shear_force)), True
        return with_laws(laws[1:], p, push, friction, holds)
    return push, friction, holds


@inlined
def is_bonded(laws: Tables, p: int) -> bool:
    """Whether a law holds more of line p than friction."""
    if len(laws) > 0:
        return (p < len(laws[0].rows) and holds(laws[0], laws[0].rows[p])) or is_bonded(laws[1:], p)
    return False
