"""The numbers of a contact between two geoms: what it is in N/m, and what MuJoCo is given for it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..problem.damping.falling import MOST_PULL, falling_rebound
from ..problem.damping.rebound import rebound_restitution
from ..quantities import require_within


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
        contacts: contact points that share the mass.
        solref, solimp, solreffriction, friction, condim: what the `<pair>` carries.
        impratio: smallest impratio of the model with which the friction holds [-]; 1 without friction.
        speed: speed of approach for which the contact was made [m/s], or None where it leaves out gravity.
        gravity: acceleration with which gravity brings the geoms together [m/s2], not negative.
        pose: the pose in which they meet: `qpos0`, a keyframe, or `qpos`.
        load: static load of each contact point [N], the weight of the lighter of the two trees of bodies, shared.
        remarks: what in this pose keeps the contact from being what was asked, one sentence each.
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
    contacts: int
    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]
    solreffriction: tuple[float, float]
    friction: tuple[float, float, float, float, float]
    condim: int
    impratio: float
    speed: float | None = None
    gravity: float = 0.0
    pose: str = "qpos0"
    load: float = 0.0
    remarks: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """The names of the geoms, or their numbers in brackets."""
        names = zip((self.geom1, self.geom2), self.ids, strict=True)
        return " on ".join(name or f"[{number}]" for name, number in names)

    def is_like(self, other: ContactNumbers) -> bool:
        """Whether another contact has the same spring and dashpot."""
        return math.isclose(self.k, other.k) and math.isclose(self.c, other.c, rel_tol=1e-6)

    @property
    def frequency(self) -> float:
        """Circular frequency omega of the mass on the spring [rad/s]."""
        return math.sqrt(self.k / self.mass)

    @property
    def xi(self) -> float:
        """Damping ratio [-]."""
        return self.c / (2 * math.sqrt(self.k * self.mass))

    @property
    def depth(self) -> float:
        """How deep the static load presses the geoms into each other [m], load / k."""
        return self.load / self.k

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of an approach along the normal [-], at the speed for which the contact was made
        with gravity, else without gravity, see `rebound_restitution`."""
        return rebound_restitution(self.xi) if self.speed is None else self.restitution_at(self.speed)

    def restitution_at(self, speed: float) -> float:
        """Coefficient of restitution e at a speed of approach [m/s], with gravity [-]; 0 if the body stays.

        Raises:
            TypeError, ValueError: unless the speed is a positive number.
        """
        return rebound_at(speed, self.xi, self.frequency, self.gravity)


def rebound_at(speed: float, xi: float, frequency: float, gravity: float, share: float = 1.0) -> float:
    """Coefficient of restitution at a speed, see `falling_rebound` [-].

    Args:
        speed: speed of approach [m/s], 1e-9 to 1e9.
        xi, frequency: damping ratio [-] and circular frequency [rad/s].
        gravity: acceleration that brings the geoms together [m/s2]; a negative one is taken as none.
        share: part of what moves that has weight [-].
    """
    speed = require_within("speed", speed, 1e-9, 1e9, "m/s")
    if frequency == 0 or xi == math.inf or xi > 1e6:
        return rebound_restitution(xi)
    pull = max(0.0, gravity) / (frequency * speed)
    if pull == 0:
        return rebound_restitution(xi)
    return 0.0 if pull > MOST_PULL else falling_rebound(xi, pull, share).restitution
