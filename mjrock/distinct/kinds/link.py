"""What all kinds of links have: two ends, a table of rows, and what a run requires of a kind.

A link stands between a point of a body and an anchor on the ground, on a fixed block or on another body. A kind of
links is a class in a file of this folder, with its rows, its force, its energy, its accounts and what a later run
remembers of it. `KINDS` of `lists` lists the kinds, and nothing else knows which kinds there are.
"""

from __future__ import annotations

import math
from typing import ClassVar, NamedTuple, Self

import numpy as np
from scipy.sparse import csr_array

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, minus, norm, plus, read, scaled, spun, vector
from ...linear import rates_of
from ...problem.masonry.case import AnyCase
from ...problem.wall.effect import LinkLaw
from ...quantities import Array, Integers
from ...rows import Fields, Row, Rows, integers, numbers, row_type, rows, vectors
from ...scene.parts import Links
from ...scene.scene import Scene
from ..rotation import rotation_change
from ..system import Books, System
from ..thread import add_force

Named = tuple[tuple[str, ...], "Kind"]
"""The names of links, and the links."""
Columns = dict[str, Array | Integers | float]
"""Numbers and vectors of links by name."""

INFINITE_IN_LAW = tuple(name for name, usual in LinkLaw._field_defaults.items() if usual == math.inf)
"""Numbers of the law of a link that may be infinite: those that are so where nothing else is given."""


class Table(NamedTuple):
    """Links that have their rows alone."""

    rows: Rows


class Kind:
    """A kind of links. It is a NamedTuple too, `Table` or one of its own, so that compiled loops know it.

    `act`, `settle` and `add_energy` are compiled. The others have here what most kinds need.

    Attributes:
        rows: a row for each link, with the numbers of `table` and `own_fields`.
        further: what its rows have that is no number, such as integers.
        endless: numbers of a row that may be infinite.
        driven: whether histories drive them: actuators, whose forces responses have apart from those of links.
        reported: whether responses have their forces.
        booked: the parts of the ledger in which each link has an account. That of row i begins at `rows[i].account` of
            `Books.links`.
    """

    rows: Rows
    own_fields: ClassVar[tuple[str, ...]] = ()
    further: ClassVar[Fields] = []
    endless: ClassVar[tuple[str, ...]] = INFINITE_IN_LAW
    driven: ClassVar[bool] = False
    reported: ClassVar[bool] = True
    booked: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def table(cls, d: int, count: int, **columns: Array | Integers | float) -> Rows:
        """Rows of links in d directions with these columns, on the ground unless the columns give another anchor."""
        fields = [
            *integers("body", "anchor"),  # the body that is held, and that of the other end, -1 for the ground
            *integers("anchor_block", "support"),  # the block of the other end and what moves it, -1 for none
            *integers("number", "account"),  # of the link among all links, and of its first account
            *vectors(d, "at", "origin"),  # where, from the centroids of the two bodies [m]
            *vectors(d, "between"),  # from the anchor at rest [m]
            *numbers("force"),  # force in the last step, negative where it pulls [N]
            *numbers(*cls.own_fields),
            *cls.further,
        ]
        return rows(row_type(fields), count, **{"anchor": -1, "anchor_block": -1, "support": -1} | columns)

    @classmethod
    def linking(cls, links: Links, between: Array, **columns: Array | Integers | float) -> Named:
        """Links of a scene with these columns. Their other `own_fields` are those of the law of the links."""
        count = len(links.body)
        taken: Columns = {name: links.law[name] for name in cls.own_fields if name not in columns}
        taken |= {"body": links.body, "anchor": links.anchor_body, "anchor_block": links.anchor_block}
        taken |= {"at": links.at, "origin": links.anchor_at, "between": between}
        table = cls.table(between.shape[1], count, **columns | taken if count else {})
        return links.names, cls(table)  # type: ignore[call-arg]

    @classmethod
    def from_scene(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """The links of this kind in a scene of a case, whose bodies are at rest."""
        raise NotImplementedError

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Add the forces at the pose of time t [s], and book what the last step, of length h, has taken."""
        raise NotImplementedError

    @inlined
    def add_energy(self, system: System, books: Books, energy: Row) -> None:
        """Add what the links hold at the pose to the energy of a sample [J], see `system.ENERGY`."""

    @inlined
    def settle(self, system: System, books: Books, force_time: float) -> tuple[float, float]:
        """Let the links do what is left when all forces have acted for a time [s]. Returns the energy that the half of
        it before the pose has taken, which a sample counts as held by them, and the work of supports in that half
        [J]."""
        return 0.0, 0.0

    def springs(self) -> tuple[Array, Array]:
        """The largest stiffness and damping coefficient of each link [N/m, N s/m], for the longest stable step."""
        named, none = self.rows.dtype.names or (), np.zeros(len(self.rows))
        k, c = (np.asarray(self.rows[name]) if name in named else none for name in ("k", "c"))
        return k, c

    def rates(self, bodies: Rows) -> csr_array:
        """Rates at which the links lengthen, for unit velocities at rest, shape (links, unknowns)."""
        table = self.rows
        between, arms = np.asarray(table["between"]), (np.asarray(table["at"]), np.asarray(table["origin"]))
        directions = between / np.linalg.norm(between, axis=1)[:, None]
        return rates_of(np.column_stack([table["body"], table["anchor"]]), arms, directions, len(bodies))

    def look_ahead(self, steps_ahead: float) -> None:
        """Let dashpots look ahead by some steps, see `step_length.STEPS_AHEAD`."""

    def velocity_changes(self, t: float, until: float) -> tuple[Integers, Array]:
        """The bodies that links drive, and the largest change of their velocity between two times [m/s]."""
        return np.empty(0, dtype=np.int64), np.empty(0)

    def remembered(self, t: float) -> Kind:
        """The links for a run that carries on from a time [s], which counts its time from there."""
        return self

    def resumed(self, before: Self) -> Self:
        """The links with which a run starts that carries on one with the links before."""
        for name in ("support", "number", "account"):
            before.rows[name] = self.rows[name]
        return before


class Pull(NamedTuple):
    """A link at a pose: its length [m], its direction away from the anchor, and the arms to its two ends [m]."""

    length: float
    direction: Vector
    arm: Vector
    anchor_arm: Vector


@inlined
def pull(link: Row, system: System) -> Pull:
    """Where a link is."""
    bodies = system.bodies
    body, at = bodies[link.body], read(link.at)
    change = rotation_change(body, at)
    arm, span = plus(at, change), plus(read(link.between), plus(read(body.place), change))
    anchor_arm = read(link.origin)
    if link.anchor >= 0:
        anchor = bodies[link.anchor]
        change = rotation_change(anchor, anchor_arm)
        span = minus(span, plus(read(anchor.place), change))
        anchor_arm = plus(anchor_arm, change)
    elif link.support >= 0:
        span = minus(span, vector(system.supports.moved, link.support, at))
    length = norm(span)
    return Pull(length, scaled(1 / length, span), arm, anchor_arm)


@inlined
def push_apart(link: Row, system: System, at_pose: Pull, force: float) -> None:
    """Add a force along a link on the bodies at both ends [N], positive where it pushes them apart."""
    add_force(system.bodies[link.body], at_pose.arm, scaled(force, at_pose.direction))
    if link.anchor >= 0:
        add_force(system.bodies[link.anchor], at_pose.anchor_arm, scaled(-force, at_pose.direction))


@inlined
def lengthening(link: Row, system: System, at_pose: Pull) -> float:
    """Rate of the length of a link [m/s]."""
    body = system.bodies[link.body]
    velocity = plus(read(body.velocity), spun(read(body.spin), at_pose.arm))
    if link.anchor >= 0:
        anchor = system.bodies[link.anchor]
        velocity = minus(velocity, plus(read(anchor.velocity), spun(read(anchor.spin), at_pose.anchor_arm)))
    elif link.support >= 0:
        velocity = minus(velocity, vector(system.supports.moving, link.support, at_pose.direction))
    return dot(at_pose.direction, velocity)


@inlined
def book_support(link: Row, system: System, books: Books, at_pose: Pull, force: float, h: float) -> None:
    """Book the work that the support of a link does in a time h, from the force of the last step to this one [N].

    The force is then that of the last step."""
    books.totals[0].ground += 0.5 * h * (link.force + force) * carried_along(link, system, at_pose)
    link.force = force


@inlined
def carried_along(link: Row, system: System, at_pose: Pull) -> float:
    """Velocity along a link of the support that it is anchored on, zero for none [m/s]."""
    if link.support < 0:
        return 0.0
    return dot(at_pose.direction, vector(system.supports.moving, link.support, at_pose.direction))
