"""Constant forces of explicit steps."""

from __future__ import annotations

from ...compiled import inlined
from ...geometry.vectors import dot, plus, read
from ...problem.masonry.case import AnyCase
from ...rows import Row, Rows
from ...scene.scene import Scene
from ..rotation import rotation_change
from ..system import Books, System
from ..thread import add_force
from .link import Columns, Kind, Named, Table


class ConstantForces(Kind, Table):
    """Forces `between` [N] that keep size and direction and follow points of bodies."""

    reported = False

    @classmethod
    def from_scene(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """Those of a scene."""
        forces, count = scene.forces, len(scene.forces.body)
        columns: Columns = {"body": forces.body, "at": forces.at, "between": forces.force} if count else {}
        return forces.names, cls(cls.table(scene.bodies.rest.shape[1], count, **columns))

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """At their points."""
        for i in range(len(self.rows)):
            row = self.rows[i]
            body, at = system.bodies[row.body], read(row.at)
            add_force(body, plus(at, rotation_change(body, at)), read(row.between))

    @inlined
    def add_energy(self, system: System, books: Books, energy: Row) -> None:
        """They have a potential."""
        for i in range(len(self.rows)):
            row = self.rows[i]
            body = system.bodies[row.body]
            moved = plus(read(body.place), rotation_change(body, read(row.at)))
            energy.potential -= dot(read(row.between), moved)
