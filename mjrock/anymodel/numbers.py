"""The numbers of a contact between two geoms: what it is in N/m, and what MuJoCo is given for it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..problem.damping.rebound import rebound_restitution


@dataclass(frozen=True)
class ContactNumbers:
    """The numbers of a contact between two geoms.

    Args:
        geom1, geom2: names of the geoms; an empty name is a geom without one.
        ids: the numbers of the geoms.
        k, c: spring [N/m] and dashpot [N s/m] of each contact point.
        mass: effective mass that each contact point stops [kg].
        inverse_weight: W of the pair [1/kg], the sum of `body_invweight0` of both bodies.
        timestep, integrator: step [s] and integrator of MuJoCo for which the numbers hold.
        contacts: contact points that share the mass, or None where it was not said.
        solref, solimp, solreffriction, friction, condim: what the `<pair>` carries.
        impratio: smallest impratio of the model with which the friction holds [-]; 1 without friction.
    """

    geom1: str
    geom2: str
    ids: tuple[int, int]
    k: float
    c: float
    mass: float
    inverse_weight: float
    timestep: float
    integrator: str
    contacts: int | None
    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]
    solreffriction: tuple[float, float]
    friction: tuple[float, float, float, float, float]
    condim: int
    impratio: float

    @property
    def frequency(self) -> float:
        """Circular frequency omega of the mass on the spring [rad/s]."""
        return math.sqrt(self.k / self.mass)

    @property
    def xi(self) -> float:
        """Damping ratio [-]."""
        return self.c / (2 * math.sqrt(self.k * self.mass))

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of an approach along the normal, see `rebound_restitution` [-]."""
        return rebound_restitution(self.xi)
