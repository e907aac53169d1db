"""Uplift: the rotation and the energy from which a wall on compliant contacts rocks."""

from __future__ import annotations

from typing import NamedTuple

from .case import Case
from .contacts import Contacts


class Uplift(NamedTuple):
    """Where the rocking of a wall starts.

    Args:
        rotation: rotation at which the first edge of the wall decompresses under its weight and loads [rad].
        energy: energy above the wall at rest that tilts it so far [J].
    """

    rotation: float
    energy: float

    @classmethod
    def of(cls, case: Case, contacts: Contacts) -> Uplift:
        """The uplift of a case.

        Weight, loads and thrusts tilt the springs of the base by their moment M about its middle, up to the rotation
        M / (K_rot - Q). From there the energy grows with the square of the rotation. A load that is never lifted by the
        elastic base, because its moment is too large, counts as none.
        """
        base, moment = contacts.base, case.restoring
        rotation = case.pressing / (float(base.stiffness.sum()) * case.block.half_base)
        stiffness = base.K_rot - 0.5 * (moment.outer.Q + moment.inner.Q)
        leaning = 0.5 * (moment.inner.P - moment.outer.P) / stiffness
        return cls(rotation, 0.5 * stiffness * max(rotation - abs(leaning), 0.1 * rotation) ** 2)
