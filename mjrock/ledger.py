"""The energy ledger: where the energy of a run in MuJoCo is, where it went, and what is missing.

It is the check that a user has where no reference exists. Everything follows from the recorded poses and half-step
velocities. The books are kept at the seams of the leapfrog windows, where a velocity is known and where a touch that is
centred in time falls: over a window a constant force acts, and what it does to the kinetic energy is force times mean
velocity times step, without error. Newmark's beta = 1/4 then stores in a spring just what the spring should hold; with
another beta the residual contains the (1/4 - beta) h^2 k v^2 / 2 by which the step shifts the contact's energy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from .block import GRAVITY, Block
from .case import Case
from .contact import row_terms
from .interface import Contacts, Interface
from .mjcf import inverse_weight
from .pose import base_gaps, side_gaps
from .stepping import Steps, ground_work, push

Array = NDArray[np.float64]
_Gaps = Callable[[Block, Contacts, Array], Array]


@dataclass(frozen=True)
class Ledger:
    """Energies [J] over time, each of shape (n,).

    Args:
        t: times [s].
        kinetic: of the wall.
        potential: of its weight, above the undeformed base.
        elastic: in the springs of the contacts.
        base_dashpots: work that the dashpots of the base have taken since release.
        side_dashpots: the same of the side stop.
        friction: work that friction at the base has taken, along it and by lifting the edge that slides.
        ground: work that the motion of the base has put in, as seen from the base.
    """

    t: Array
    kinetic: Array
    potential: Array
    elastic: Array
    base_dashpots: Array
    side_dashpots: Array
    friction: Array
    ground: Array

    @property
    def residual(self) -> Array:
        """What is there and what was taken, less what was there at release: zero for an exact integration."""
        held = self.kinetic + self.potential + self.elastic
        gone = self.base_dashpots + self.side_dashpots + self.friction - self.ground
        residual: Array = held - held[0] + gone
        return residual

    def at(self, t: Array) -> Ledger:
        """The ledger at other times, interpolated."""
        return Ledger(t, *(np.interp(t, self.t, getattr(self, f.name)) for f in fields(self)[1:]))

    @classmethod
    def of(cls, case: Case, contacts: Contacts, steps: Steps) -> Ledger:
        """The ledger of a run."""
        wall = case.block
        step, weight = steps.h[:, None], inverse_weight(wall.mass)
        start = steps.pose - 0.5 * step * steps.before
        width = steps.widths[:, None]
        middle = np.concatenate([steps.velocity, (steps.after - steps.before) / step], axis=1)
        sine, cosine = np.sin(steps.pose[:, 2, None]), np.cos(steps.pose[:, 2, None])

        def face(interface: Interface, gaps: _Gaps, axis: int, lever: Array) -> tuple[Array, Array, Array]:
            """Elastic energy at the start of each window, work of the dashpots in it, and force of the face."""
            k = interface.stiffness
            rate = middle[:, axis, None] + middle[:, 2, None] * lever
            curve = middle[:, 3 + axis, None] + middle[:, 5, None] * lever
            gap = gaps(wall, contacts, steps.pose)
            beta, ringing = steps.beta[1 - axis, :, None], steps.ringing[1 - axis, :, None]
            dashpot, inertia = row_terms(k, interface.damping, step, weight, beta, ringing)
            # what the dashpot, centred or at the end of the step, exerts at the velocity that the leapfrog keeps
            drag = dashpot * (rate - 0.5 * step * curve) + (inertia - beta * step**2 * k) * curve
            row = -(k * gap + drag + beta * step**2 * k * curve)
            pressed = (gap < 0) & (row > 0)
            stored = 0.5 * k * np.minimum(gaps(wall, contacts, start), 0) ** 2
            given = stored - np.append(stored[1:], stored[-1:], axis=0)
            # the dashpot of a point that has closed but does not press holds its spring back, and takes what it gives
            taken = np.where(pressed, drag * rate * width, given)
            return stored.sum(1), taken.sum(1), np.where(pressed, row, 0).sum(1)

        lever = wall.h * sine - contacts.base.positions * cosine
        elastic, base_work, base_force = face(contacts.base, base_gaps, 1, lever)
        side_work, side_force = np.zeros_like(elastic), np.zeros_like(elastic)
        if case.side_stop and contacts.side is not None:
            lever = wall.b * sine + contacts.side.positions * cosine
            stored, side_work, side_force = face(contacts.side, side_gaps, 0, lever)
            elastic = elastic + stored
        # friction acts at the lower edge, halfway between the two faces that overlap there
        edge = -wall.b * np.abs(sine[:, 0]) - wall.h * cosine[:, 0]
        out = wall.b * np.sign(sine[:, 0]) * cosine[:, 0] - wall.h * sine[:, 0]
        slip = middle[:, 0] + middle[:, 2] * 0.5 * (edge - steps.pose[:, 1] - wall.h)
        lift = middle[:, 1] - middle[:, 2] * out
        pushed = push(case, steps.t, steps.h)
        along = wall.mass * middle[:, 3] - side_force - pushed
        up = wall.mass * (middle[:, 4] + GRAVITY) - base_force  # what a sliding cone presses on top of the law
        friction_work = -(along * slip + up * lift) * width[:, 0]

        before = steps.before
        moving = wall.mass * (before[:, 0] ** 2 + before[:, 1] ** 2) + wall.inertia * before[:, 2] ** 2
        return cls(
            t=steps.seams,
            kinetic=0.5 * moving,
            potential=wall.weight * start[:, 1],
            elastic=elastic,
            base_dashpots=_since_release(base_work),
            side_dashpots=_since_release(side_work),
            friction=_since_release(friction_work),
            ground=_since_release(ground_work(case, steps)),
        )


def _since_release(work: Array) -> Array:
    """Sums up to the start of each window."""
    return np.append(0.0, np.cumsum(work[:-1]))
