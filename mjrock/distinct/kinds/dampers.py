"""Viscous dampers of explicit steps."""

from __future__ import annotations

import numpy as np

from ...compiled import inlined
from ...problem.masonry.case import AnyCase
from ...problem.wall.effect import DASHPOT, damping_coefficient, resistance
from ...quantities import Array
from ...rows import Rows
from ...scene.scene import Scene
from ..system import Books, System
from .link import Kind, Named, Table, book_support, lengthening, pull, push_apart


class Dampers(Kind, Table):
    """Dashpots, see `resistance`. They resist the rate of their length both ways.

    `rate` is that of the last step [m/s], half a step before the pose, and `steps_ahead` by how many steps they look
    ahead.
    """

    own_fields = (*DASHPOT, "rate", "steps_ahead")
    booked = ("dashpots",)

    @classmethod
    def from_scene(cls, scene: Scene, case: AnyCase, bodies: Rows) -> Named:
        """Those of a scene."""
        return cls.linking(scene.links.damped, scene.dampers.links.between, rate=0.0, steps_ahead=0.0)

    def look_ahead(self, steps_ahead: float) -> None:
        """All of them."""
        self.rows["steps_ahead"] = steps_ahead

    def springs(self) -> tuple[Array, Array]:
        """No stiffness, and the coefficient of their dashpots [N/m, N s/m]."""
        return np.zeros(len(self.rows)), damping_coefficient(np.asarray(self.rows).view(np.recarray))

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """They take what the mean of their force of two steps does."""
        for i in range(len(self.rows)):
            damper = self.rows[i]
            at_pose = pull(damper, system)
            rate = lengthening(damper, system, at_pose)
            steps_ahead = damper.steps_ahead if h > 0 else 0.0
            force = -resistance(damper, rate + steps_ahead * (rate - damper.rate))
            damper.rate = rate
            books.links[damper.account] -= 0.5 * h * (force + damper.force) * rate
            book_support(damper, system, books, at_pose, force, h)
            push_apart(damper, system, at_pose, force)
