"""The system of bodies, lines, links and laws in the plane or in space, its samples and its energy accounts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..geometry.frames import PLANE, SPACE
from ..quantities import Array, Integers
from ..result.forces import ForceCounts
from ..rows import Rows, joined, numbers, row_type, rows
from ..scene.course import Ground
from .rows import DISSIPATED_BY_LAWS, kinds
from .supports import Supports
from .thread import Thread, pending_forces, spans_of, spans_of_bodies, threads_of

Tables = tuple[Any, ...]
"""Tables of kinds of links, or of laws of joints."""

STATE_ENERGIES, WORK = ("kinetic", "potential", "elastic"), ("friction", "ground", "driven", *DISSIPATED_BY_LAWS)
ENERGY = row_type(numbers(*STATE_ENERGIES, *WORK))
"""Energy at a sample or a check, and the work since the start [J]: what friction has dissipated, what ground and
supports and what actuators have put in, and what `rows.DISSIPATED_BY_LAWS` names."""


class System(NamedTuple):
    """Bodies with their motion, contact lines, and all that acts on them. `tangents` has room for the d - 1 tangential
    directions of each line that sticks rigidly. `laws` has a table for each law of joints beside the dry one, `links`
    one for each kind of links, and `guided` the body of each actuator."""

    axes: tuple[int, ...]
    bodies: Rows
    lines: Rows
    edges: Rows
    tangents: Rows
    laws: Tables
    links: Tables
    guided: Integers
    ground: Ground
    supports: Supports

    def with_room_for_friction(self) -> System:
        """The system with room for the tangential directions of all its lines, if one of them sticks rigidly."""
        needed = (len(self.axes) - 1) * len(self.lines)
        if len(self.tangents) >= needed or not np.isinf(self.lines["k_s"]).any():
            return self
        return self._replace(tangents=rows(self.tangents.dtype, needed))


class Books(NamedTuple):
    """Energy accounts: work since the start [J], with the room that lines need in a step.

    Args:
        dashpots: by group, shape (g,).
        links: by account of the links, see `kinds.link.Kind`, shape (l,).
        totals: a row for each span of lines or bodies of what is booked for all together, see `rows.Kinds`. What is
            booked of the whole is in the first one.
        active, touched: room for the numbers of the lines that stick rigidly, and of those that met or left their face
            in the last step, shape (m,) each.
        impulse, remaining: the impulse of their springs for that in this step, and what is still missing of it [N s],
            likewise.
        encounters: what the dashpots of lines book that a search has found, for each span but the first of these: that
            of span c is the number c + group.
        pending: forces of lines that wait until all threads have pressed, see `thread.pending_forces`.
    """

    dashpots: Array
    links: Array
    totals: Rows
    active: Integers
    touched: Integers
    impulse: Array
    remaining: Array
    encounters: Array
    pending: Rows

    @classmethod
    def empty(cls, system: System, groups: int) -> Books:
        """Empty books of a system."""
        links = sum(len(table.rows) * len(table.booked) for table in system.links)
        none, integers, row_types = np.zeros(0), np.zeros(0, dtype=np.int64), kinds(len(system.axes))
        waiting = rows(row_types.total, 1), integers, integers, none, none, none, rows(row_types.pending, 1)
        return cls(np.zeros(groups), np.zeros(links), *waiting).with_room(system)

    def with_room(self, system: System) -> Books:
        """The books with room for the lines of a system, whose forces wait for no other thread."""
        lines, spans = len(system.lines), spans_of(system.lines)
        books = self._replace(pending=pending_forces(system.bodies, system.lines, spans[[0, -1]]))
        if lines > len(self.active):
            active, touched = (np.zeros(lines, dtype=np.int64) for _ in range(2))
            books = books._replace(active=active, touched=touched, impulse=np.zeros(lines), remaining=np.zeros(lines))
        missing = max(len(spans), len(spans_of_bodies(system.bodies))) - 1 - len(self.totals)
        if missing > 0:
            books = books._replace(totals=joined(self.totals, rows(self.totals.dtype, missing)))
        if (accounts := len(spans) - 1 + len(self.dashpots)) > len(self.encounters):
            encounters = np.zeros(accounts)
            encounters[: len(self.encounters)] = self.encounters
            books = books._replace(encounters=encounters)
        return books

    def of_threads(self, system: System, count: int) -> tuple[Books, tuple[Thread, ...]]:
        """The books with room for the lines of a system, and a number of threads for them."""
        books, (threads, pending) = self.with_room(system), threads_of(system.bodies, system.lines, count)
        return books._replace(pending=pending), threads

    @property
    def size(self) -> int:
        """Accounts that a ledger keeps at each sample."""
        return 2 + len(self.dashpots) + len(self.links)


class Samples(NamedTuple):
    """The motion, the energy and the forces at the samples of a run.

    Args:
        pose, velocity: of the bodies, shapes (samples, n, nq) and (samples, n, nv).
        energy: rows of `ENERGY`, shape (samples,). Friction is that of shear springs alone where there is no ledger.
        checks: rows of `ENERGY` at checks of the energy, at a fixed number of steps, however far apart the
            samples are.
        dashpots, links: the accounts of `Books`, (samples, accounts), without a ledger (samples, 0).
        link_forces: force of each link [N], shape (samples, links).
        loads, contact_reactions: forces of joints and of fixed blocks, see `result.forces.KeptForces`, shapes
            (samples, joints, nv) and (samples, blocks, d).
        damage: share of its bond that each joint has lost, the mean over its area [-], shape (samples, joints).
        guided: force and moment about its centroid of all but a guide on the block of each actuator [N, N m], shape
            (samples, actuators, nv). All four have no columns where no forces are kept.
    """

    pose: Array
    velocity: Array
    energy: Rows
    checks: Rows
    dashpots: Array
    links: Array
    link_forces: Array
    loads: Array
    contact_reactions: Array
    damage: Array
    guided: Array

    @classmethod
    def room(cls, count: int, system: System, books: Books, *, ledger: bool = False, checks: int = 2) -> Samples:
        """Room for some samples and checks, for a sample that is not kept, and for the accounts of a ledger."""
        freedom = PLANE if len(system.axes) == 2 else SPACE
        count, bodies, links = count + 1, len(system.bodies), sum(len(table.rows) for table in system.links)
        pose, velocity = np.zeros((count, bodies, freedom.nq)), np.zeros((count, bodies, freedom.nv))
        accounts = (books.dashpots, books.links)
        arrays: list[Any] = [np.zeros((count, len(account) if ledger else 0)) for account in accounts]
        sizes: tuple[tuple[int, ...], ...] = ((freedom.nv,), (freedom.translations,), (), (freedom.nv,))
        arrays += [np.zeros((count, links)), *(np.zeros((count, 0, *size)) for size in sizes)]
        return cls(pose, velocity, rows(ENERGY, count), rows(ENERGY, checks), *arrays)

    def with_forces(self, counts: ForceCounts) -> Samples:
        """The same with room for the forces of joints, fixed blocks and actuators."""

        def room(empty: Array, count: int) -> Array:
            return np.zeros((len(empty), count, *empty.shape[2:]))

        return self._replace(
            loads=room(self.loads, counts.joints),
            contact_reactions=room(self.contact_reactions, counts.fixed),
            damage=room(self.damage, counts.joints),
            guided=room(self.guided, counts.actuators),
        )

    def chosen(self, index: slice | Integers) -> Samples:
        """Some of the samples, and all checks."""
        parts = {name: part[index] for name, part in self._asdict().items() if name != "checks"}
        return self._replace(**parts)

    def since_the_start(self) -> Samples:
        """The same with accounts that begin at the first sample."""
        for table in (self.energy, self.checks):
            for name in WORK:
                table[name] -= table[name][0]
        for account in (self.dashpots, self.links):
            account -= account[0]
        return self
