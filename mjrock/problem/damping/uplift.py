"""Uplift: the rotation and the energy from which a wall on compliant contacts rocks."""

from __future__ import annotations

from typing import NamedTuple

from ..wall.case import Case
from .contacts import Contacts


class Uplift(NamedTuple):
    """Where the rocking of a wall starts.

    Args:
        rotation: rotation at which the first edge of the wall decompresses under its weight and loads [rad].
        energy: energy that tilts the wall so far from upright, its loads in the middle [J].
    """

    rotation: float
    energy: float

    @classmethod
    def of(cls, case: Case, contacts: Contacts) -> Uplift:
        """The uplift of a case. Loads and thrusts that make the wall lean leave the energy as it is."""
        base, moment = contacts.base, case.restoring
        rotation = case.pressing / (float(base.stiffness.sum()) * case.block.half_base)
        stiffness = base.K_rot - 0.5 * (moment.outer.Q + moment.inner.Q)
        return cls(rotation, 0.5 * stiffness * rotation**2)
