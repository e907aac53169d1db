"""Actuators of explicit steps: they drive points of bodies, or all bodies, along histories, and guide bodies."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from scipy.sparse import csr_array

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, increase, plus, read, scaled, spun
from ...linear import rates_matrix
from ...problem.masonry.case import AnyCase
from ...quantities import Array, Integers
from ...rows import Row, Rows
from ...scene.parts import GROUND
from ...scene.scene import Scene
from ..rotation import rotation_change, rotations
from ..supports import Supports, move_supports, moving, places, velocity_changes
from ..system import Books, System
from ..thread import add_force
from .link import Kind, Named


class Histories(NamedTuple):
    """Rows, and the histories that they follow, along one axis each."""

    rows: Rows
    drives: Supports


class Actuators(Kind, Histories):
    """Springs and dashpots, `k` and `c` [N/m, N s/m], from a history to a point of a body along `between`.

    One without a body drives the centroid of all. `reach` is the displacement at the start of the history [m], and
    `dashpot_force` the part of the force of the last step that the dashpot had [N].
    """

    own_fields = ("k", "c", "reach", "dashpot_force")
    driven = True
    booked = ("actuators", "dashpots")

    @classmethod
    def from_scene(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """Those of a case of masonry, which count displacements from the pose of rest."""
        d = bodies["rest"].shape[1]
        if not case.actuators:
            return (), cls(cls.table(d, 0), moving((), 1))
        actuators = tuple(case.actuators.values())
        body = np.array([GROUND if actuator.block is None else case.body_of(actuator.block) for actuator in actuators])
        direction, single = np.array([actuator.direction for actuator in actuators]), (body >= 0)[:, None]
        at = np.array([actuator.direction if actuator.at is None else actuator.at for actuator in actuators])
        at = np.where(single, at - bodies["rest"][body], 0.0)
        change = np.einsum("nij,nj->ni", rotations(bodies)[body], at)
        mean = np.average(bodies["place"], axis=0, weights=bodies["mass"])
        table = cls.table(
            d,
            len(actuators),
            body=body,
            at=at,
            between=direction,
            k=np.array([actuator.stiffness for actuator in actuators]),
            c=np.array([actuator.damping for actuator in actuators]),
            reach=(np.where(single, bodies["place"][body] + change, mean) * direction).sum(axis=1),
        )
        histories = [(actuator.displacement[0], np.array(actuator.displacement[1])[:, None]) for actuator in actuators]
        return tuple(case.actuators), cls(table, moving(histories, 1))

    def rates(self, bodies: Rows) -> csr_array:
        """Rates of what they drive: a point, or the centroid of all."""
        mass = np.asarray(bodies["mass"])
        directions = np.where((self.rows["body"] < 0)[:, None], self.rows["between"], 0.0)
        turning = np.zeros((len(self.rows), 2 * directions.shape[1] - 3))
        shares = np.hstack([directions, turning])[:, None] * (mass / mass.sum())[:, None]
        pairs = np.broadcast_to(np.arange(len(bodies)), shares.shape[:2])
        return csr_array(super().rates(bodies) + rates_matrix(shares, pairs, shares.shape[1] * shares.shape[2]))

    def velocity_changes(self, t: float, until: float) -> tuple[Integers, Array]:
        """Of actuators that drive a block, by their histories."""
        single = self.rows["body"] >= 0
        return self.rows["body"][single], velocity_changes(self.drives, t, until)[single]

    def remembered(self, t: float) -> Actuators:
        """Their displacements count from there."""
        displacement = places(self.drives, t)
        self.rows["reach"] += displacement[:, 0]
        return Actuators(self.rows, self.drives._replace(moved=self.drives.moved - displacement))

    def resumed(self, before: Self) -> Self:
        """The same ones go on from where those before had driven their blocks."""
        columns = ["body", "at", "between", "k", "c"]
        if len(before.rows) == len(self.rows) and not (before.rows[columns] != self.rows[columns]).any():
            for name in ("force", "dashpot_force", "reach"):
                self.rows[name] = before.rows[name]
            self.drives.moved[:] = before.drives.moved
        return self

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Their work is their force times the displacement of their histories."""
        drives = self.drives
        move_supports(drives, t, h)
        for i in range(len(self.rows)):
            row, direction = self.rows[i], read(self.rows[i].between)
            moved, speed = driven_place(row, system.bodies, direction)
            rate = drives.moving[i, 0] - speed
            dashpot_force = row.c * rate
            force = row.k * (drives.moved[i, 0] - (moved - row.reach)) + dashpot_force
            books.links[row.account] += 0.5 * h * (row.force + force) * drives.moving[i, 0]
            books.links[row.account + 1] += 0.5 * h * (row.dashpot_force + dashpot_force) * rate
            row.force, row.dashpot_force = force, dashpot_force
            drive(row, system.bodies, force, direction)

    @inlined
    def add_energy(self, system: System, books: Books, energy: Row) -> None:
        """The energy of their springs, and their work."""
        for i in range(len(self.rows)):
            row = self.rows[i]
            spring_force = row.force - row.dashpot_force
            energy.elastic += 0.5 * spring_force * spring_force / row.k
            energy.driven += books.links[row.account]


@inlined
def drive(row: Row, bodies: Rows, force: float, direction: Vector) -> None:
    """Let an actuator push its point along a direction, or all bodies in proportion to their masses [N]."""
    if row.body >= 0:
        body, at = bodies[row.body], read(row.at)
        add_force(body, plus(at, rotation_change(body, at)), scaled(force, direction))
        return
    acceleration = scaled(force / mass_of(bodies), direction)
    for b in range(len(bodies)):
        increase(bodies[b].force, scaled(bodies[b].mass, acceleration))


@inlined
def mass_of(bodies: Rows) -> float:
    """Mass of all bodies [kg]."""
    mass = 0.0
    for b in range(len(bodies)):
        mass += bodies[b].mass
    return mass


@inlined
def driven_place(row: Row, bodies: Rows, direction: Vector) -> tuple[float, float]:
    """Displacement [m] and velocity [m/s] along a direction of what an actuator drives: its point, or all bodies."""
    if row.body >= 0:
        body, at = bodies[row.body], read(row.at)
        change = rotation_change(body, at)
        speed = plus(read(body.velocity), spun(read(body.spin), plus(at, change)))
        return dot(direction, plus(read(body.place), change)), dot(direction, speed)
    moved, speeds, mass = 0.0, 0.0, mass_of(bodies)
    for b in range(len(bodies)):
        moved += bodies[b].mass * dot(direction, read(bodies[b].place))
        speeds += bodies[b].mass * dot(direction, read(bodies[b].velocity))
    return moved / mass, speeds / mass
