"""Own laws of links, see `problem.wall.own_link`: a class of a user's file answers for each link at each pose."""

from __future__ import annotations

from typing import Any, ClassVar, Self

import numpy as np

from ...compiled import inlined
from ...problem.masonry.case import AnyCase
from ...problem.wall.user_law import OF_DAMPING, OF_DISSIPATED, OF_ENERGY, OF_STRESS, ROOM
from ...quantities import Array
from ...rows import Fields, Row, Rows, integers
from ...scene.scene import Scene
from ..system import Books, System
from .link import Kind, Named, Table, book_support, lengthening, pull, push_apart
from .own import address_of, call_law


class OwnLinks(Kind, Table):
    """Links with a law of their own, by the length that each has beyond the one as drawn, `reach` [m].

    `stiffest` and `strongest` are the spring and the dashpot for which steps are short enough [N/m, N s/m]. `rate` is
    that of the last step [m/s], `dashpot_force` that of the dashpot in it [N], and `steps_ahead` by how many steps
    dashpots look ahead.
    """

    own_fields = ("reach", "stiffest", "strongest", "rate", "dashpot_force", "steps_ahead")
    further: ClassVar[Fields] = [*integers("address"), ("values", float, (ROOM,))]
    booked = ("dashpots",)

    @classmethod
    def from_scene(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """Those of a scene."""
        links = scene.links.owned
        laws = [law for law in links.user_laws if law is not None]
        between = scene.bodies.between(links.body, links.at, links.anchor_body, links.anchor_at)
        columns: dict[str, Any] = {name: 0.0 for name in cls.own_fields}
        if laws:
            k, c = np.array([law.stiffest for law in laws]).T
            columns |= {"reach": np.linalg.norm(between, axis=1), "stiffest": k, "strongest": c}
            columns |= {"address": np.array([address_of(law.kind) for law in laws])}
            columns |= {"values": np.array([law.values for law in laws])}
        return cls.linking(links, between, **columns)

    def springs(self) -> tuple[Array, Array]:
        """The largest ones within the strokes."""
        return np.asarray(self.rows["stiffest"]), np.asarray(self.rows["strongest"])

    def look_ahead(self, steps_ahead: float) -> None:
        """All of them."""
        self.rows["steps_ahead"] = steps_ahead

    def resumed(self, before: Self) -> Self:
        """Addresses are those of this process."""
        carried = super().resumed(before)
        carried.rows["address"] = self.rows["address"]
        return carried

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """They answer at the pose, and what their dashpots and memories take of the work is booked."""
        for i in range(len(self.rows)):
            link = self.rows[i]
            at_pose = pull(link, system)
            rate = lengthening(link, system, at_pose)
            ahead = rate + (link.steps_ahead if h > 0 else 0.0) * (rate - link.rate)
            bears, energy_before = link.values[OF_STRESS], link.values[OF_ENERGY]
            call_law(link.values, link.address, at_pose.length - link.reach, ahead)
            dashpot_force = link.values[OF_DAMPING]
            books.links[link.account] += 0.5 * h * (link.dashpot_force + dashpot_force) * rate
            if link.values[OF_DISSIPATED] != 0 and h > 0:
                work = 0.5 * h * (bears + link.values[OF_STRESS]) * rate
                books.links[link.account] += work - (link.values[OF_ENERGY] - energy_before)
            link.rate, link.dashpot_force = rate, dashpot_force
            force = -link.values[OF_STRESS] - dashpot_force
            book_support(link, system, books, at_pose, force, h)
            push_apart(link, system, at_pose, force)

    @inlined
    def add_energy(self, system: System, books: Books, energy: Row) -> None:
        """What their laws hold."""
        for i in range(len(self.rows)):
            energy.elastic += self.rows[i].values[OF_ENERGY]
