"""The system: all that stands and acts in the plane or in space, its motion, and what is kept and booked of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.frames import PLANE, Freedom
from ..quantities import Array, Integers
from ..scene.ground import Ground
from .rows import Rows, kinds, rows

ENERGY = np.dtype(
    [
        *((name, float) for name in ("kinetic", "potential", "elastic", "friction", "ground", "driven")),
        ("ends", float, (2,)),
        ("bonds", float, (3,)),
    ]
)
"""Energy at a sample or a look, what friction has taken, what ground and supports have put in, what actuators have put
in, what lines of joints and of encounters have lost at the ends of faces, and what bonds have taken by then [J]."""


class Supports(NamedTuple):
    """Displacement histories of fixed blocks, and where the blocks are.

    Args:
        t: times of the samples of all supports, one support after the other [s], shape (samples,).
        displacement: along the axes [m], shape (samples, d), linear in between.
        first: where the samples of each support begin, and where those of the last end, shape (s + 1,).
        moved, moving: displacement and velocity at the pose [m, m/s], shape (s, d).
    """

    t: Array
    displacement: Array
    first: Integers
    moved: Array
    moving: Array


class System(NamedTuple):
    """All that stands and acts, and its motion. `ways` is room for d - 1 rows of each line that sticks rigidly, and
    `drives` are the histories of the actuators, along one axis each. `bonds` has a row for each line of the joints, or
    none where all are dry."""

    axes: tuple[int, ...]
    bodies: Rows
    lines: Rows
    edges: Rows
    ways: Rows
    bonds: Rows
    ties: Rows
    dampers: Rows
    forces: Rows
    actuators: Rows
    ground: Ground
    supports: Supports
    drives: Supports

    def with_ways(self) -> System:
        """The system with room for the ways of all its lines, if one of them sticks rigidly."""
        needed = (len(self.axes) - 1) * len(self.lines)
        if len(self.ways) >= needed or not np.isinf(self.lines["k_s"]).any():
            return self
        return self._replace(ways=rows(self.ways.dtype, needed))


class Books(NamedTuple):
    """Work since the start [J].

    Args:
        dashpots: by group, shape (g,).
        ties, broken, dampers: by tie, yielding and breaking, shape (t,) each, and by damper and actuator, shape (d,).
        driven: what each actuator has put in, shape (a,).
        bonds: what bonds have taken in tension, slip and crushing, shape (3,).
        ends: what lines have lost at the ends of faces, those of joints and of encounters, shape (2,).
        totals: a row of `friction`, what is in the shear springs included; of `ground`, the work of ground and
            supports; and of `push`, the acceleration of the ground in the last step [m/s2].
        active, touched: room for the numbers of the lines that stick rigidly, and of those that met or left their face
            in the last step, shape (m,) each.
        struck, asked: what their springs did for that in this step, and what they still ask for [N s], likewise.
    """

    dashpots: Array
    ties: Array
    broken: Array
    dampers: Array
    driven: Array
    ends: Array
    bonds: Array
    totals: Rows
    active: Integers
    touched: Integers
    struck: Array
    asked: Array

    @classmethod
    def empty(cls, system: System, groups: int) -> Books:
        """Empty books of a system."""
        ties, driven = len(system.ties), len(system.actuators)
        sizes = groups, ties, ties, len(system.dampers) + driven, driven, 2, 3
        dashpots, yielding, broken, dampers, actuators, ends, bonds = (np.zeros(size) for size in sizes)
        active, touched = (np.zeros(len(system.lines), dtype=np.int64) for _ in range(2))
        totals, struck = rows(kinds(len(system.axes)).total, 1), np.zeros((2, len(active)))
        work = dashpots, yielding, broken, dampers, actuators, ends, bonds
        return cls(*work, totals, active, touched, *struck)

    def with_room(self, lines: int) -> Books:
        """The books with room for so many lines."""
        if lines <= len(self.active):
            return self
        active, touched = (np.zeros(lines, dtype=np.int64) for _ in range(2))
        return self._replace(active=active, touched=touched, struck=np.zeros(lines), asked=np.zeros(lines))

    @property
    def size(self) -> int:
        """Accounts that a ledger keeps at each sample."""
        return 2 + sum(map(len, (self.dashpots, self.ties, self.broken, self.dampers, self.driven)))


class Samples(NamedTuple):
    """What is kept of a motion at its samples.

    Args:
        pose, velocity: of the bodies, shapes (samples, n, nq) and (samples, n, nv).
        energy: rows of `ENERGY`, shape (samples,). Friction is that of shear springs alone where there is no ledger.
        looks: rows of `ENERGY` at looks, which are made every so many steps, however far the samples are apart.
        dampers, ties, broken, dashpots, driven: what `Books` say, (samples, accounts), without a ledger (samples, 0).
        actuators: force of each actuator [N], shape (samples, a).
        loads, held: forces of joints and of fixed blocks, see `result.forces.Gathered`, shapes (samples, joints, nv)
            and (samples, blocks, d).
        pulled: force of each tie and then of each damper, negative where it pulls [N], shape (samples, links).
        damage: share of its bond that each joint has lost, the mean over its area [-], shape (samples, joints).
        guided: force and moment about its centroid of all but a guide on the block of each actuator [N, N m], shape
            (samples, actuators, nv). All five have no columns where no forces are kept.
    """

    pose: Array
    velocity: Array
    energy: Rows
    looks: Rows
    dampers: Array
    ties: Array
    broken: Array
    dashpots: Array
    driven: Array
    actuators: Array
    loads: Array
    held: Array
    pulled: Array
    damage: Array
    guided: Array

    @classmethod
    def room(
        cls,
        count: int,
        bodies: int,
        books: Books,
        freedom: Freedom = PLANE,
        *,
        ledger: bool = False,
        looks: int = 2,
        actuators: int = 0,
    ) -> Samples:
        """Room for some samples and looks, for a sample that is not kept, and for the accounts of a ledger."""
        count += 1
        pose, velocity = np.zeros((count, bodies, freedom.nq)), np.zeros((count, bodies, freedom.nv))
        kept = (books.dampers, books.ties, books.broken, books.dashpots, books.driven)
        accounts = [np.zeros((count, len(account) if ledger else 0)) for account in kept]
        accounts.append(np.zeros((count, actuators)))
        sizes: tuple[tuple[int, ...], ...] = ((freedom.nv,), (freedom.translations,), (), (), (freedom.nv,))
        accounts += [np.zeros((count, 0, *size)) for size in sizes]
        return cls(pose, velocity, rows(ENERGY, count), rows(ENERGY, looks), *accounts)

    def with_forces(self, joints: int, blocks: int, links: int, actuators: int) -> Samples:
        """The same with room for the forces of so many joints, fixed blocks, links and actuators."""
        counts = {"loads": joints, "held": blocks, "pulled": links, "damage": joints, "guided": actuators}
        parts = {name: (n, getattr(self, name)) for name, n in counts.items()}
        return self._replace(**{name: np.zeros((len(old), n, *old.shape[2:])) for name, (n, old) in parts.items()})

    def taken(self, which: slice | Integers) -> Samples:
        """Some of the samples, and all looks."""
        kept = {name: part[which] for name, part in self._asdict().items() if name != "looks"}
        return self._replace(**kept)

    def since_the_start(self) -> Samples:
        """The same with accounts that begin at the first sample."""
        for table in (self.energy, self.looks):
            for name in ("friction", "ground", "driven", "ends", "bonds"):
                table[name] -= table[name][0]
        for account in (self.dampers, self.ties, self.broken, self.dashpots, self.driven):
            account -= account[0]
        return self
