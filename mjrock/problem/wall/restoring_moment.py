"""The moment that brings a tilted rigid wall back: of its weight, of forces that keep their size, and of ties.

About the toe, at a rotation phi >= 0 towards that toe, the moment is M(phi) = P cos(phi) - Q sin(phi). A weight W at a
height z and a distance d inwards from the toe has P = W d and Q = W z. A horizontal force F outwards at (d, z) has
P = -F z and Q = F d. A wall with loads and thrusts so rocks as a plain one with another P and Q.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...compiled import inlined
from ...quantities import Array, Real
from .effect import Anchored


class Moment(NamedTuple):
    """The restoring moment about one toe.

    Args:
        P: at rest [N m].
        Q: what it loses with the sine of the rotation [N m].
    """

    P: float
    Q: float

    @property
    def alpha(self) -> float:
        """Rotation at which the moment is zero [rad]; beyond it the wall overturns."""
        return math.atan2(self.P, self.Q)

    def at(self, phi: Real) -> Real:
        """The moment at a rotation phi >= 0 [N m]."""
        moment: Real = self.P * np.cos(phi) - self.Q * np.sin(phi)
        return moment

    def energy(self, phi: Real) -> Real:
        """The work that a rotation phi >= 0 takes [J]."""
        work: Real = self.P * np.sin(phi) - 2 * self.Q * np.sin(0.5 * phi) ** 2
        return work

    def rotation_at(self, energy: float) -> float:
        """The rotation in [0, alpha] that takes `energy` [J].

        Raises:
            ValueError: if that is more energy than it takes to overturn the wall.
        """
        size = math.hypot(self.P, self.Q)
        cosine = (self.Q + energy) / size
        if not self.Q / size <= cosine <= 1:
            top = self.energy(self.alpha)
            raise ValueError(f"energy = {energy:g} J is outside the valid range 0 to {top:g} J (overturning)")
        return self.alpha - math.acos(cosine)


class Restoring(NamedTuple):
    """The restoring moments about the outer toe, for theta > 0, and about the inner toe, for theta < 0."""

    outer: Moment
    inner: Moment

    def towards(self, side: float) -> Moment:
        """The one about the outer toe (+1) or the inner toe (-1)."""
        return self.outer if side >= 0 else self.inner

    def energy(self, theta: Real) -> Real:
        """The work that rotations of either sign take [J]."""
        size: Any = np.abs(theta)
        if self.outer == self.inner:
            return self.outer.energy(size)  # type: ignore[no-any-return]
        return np.where(np.asarray(theta) >= 0, self.outer.energy(size), self.inner.energy(size))  # type: ignore[no-any-return]

    def plus(self, moments: list[Restoring]) -> Restoring:
        """The sum of this one and others."""
        sides = [
            Moment(sum(moment.P for moment in side), sum(moment.Q for moment in side))
            for side in zip(self, *moments, strict=True)
        ]
        return Restoring(*sides)


def of_force(x: float, z: float, outwards: float, downwards: float, half_base: float) -> Restoring:
    """The restoring moments of a force that acts at an offset x from the middle of the base and a height z.

    Its components are [N], x and z [m]. Either toe is `half_base` from the middle of the base [m].
    """
    sides = []
    for side in (1.0, -1.0):
        d, out = half_base - side * x, side * outwards
        sides.append(Moment(downwards * d - out * z, downwards * z + out * d))
    return Restoring(*sides)


def pose_of(theta: Array, x: float, z: float, half_base: float) -> Array:
    """Displacement (x, z) [m] of a point of a rigid wall at rotations theta about its toes [rad], and theta, (n, 3).

    At rest the point lies at x, z [m], and either toe at `half_base` [m], from the middle of the base. It stands beside
    `mjrock.geometry` because it takes many rotations at once, and rocking theory uses it.
    """
    lever = np.copysign(half_base, theta) - x
    sine, versine = np.sin(theta), 1 - np.cos(theta)
    return np.stack([lever * versine + z * sine, lever * sine - z * versine, theta], axis=-1)


class TiePull(NamedTuple):
    """A tie on a rigid wall, as numbers for compiled functions.

    Args:
        offset, height: the point that it holds, from the middle of the base, outwards and upwards [m].
        length, rise: horizontal distance of the anchor behind that point, and how much higher it is [m].
        half_base: distance of either toe of the wall from the middle of the base [m].
        reach: length up to which the tie is slack [m].
        stiffness: [N/m].
        strength: force at which it yields [N].
        ultimate: plastic elongation at which it breaks [m], infinite for one that never does.
    """

    offset: float
    height: float
    length: float
    rise: float
    half_base: float
    reach: float
    stiffness: float
    strength: float
    ultimate: float

    @classmethod
    def from_tie(cls, tie: Anchored, wall: Any) -> TiePull:
        """A tie that holds the inner face of a wall, a `Block`."""
        law = tie.law
        shape = wall.inner_face(tie.height), tie.height, tie.length, tie.rise, wall.half_base, law.reach
        return cls(*shape, law.k, law.strength, law.ultimate)

    def moment(self, phi: Array) -> Array:
        """Restoring moment at rotations about the outer toe, stretched for the first time [N m], shape (n,)."""
        elongation, lever = pulled(self, phi, 1.0)
        moment: Array = np.minimum(self.strength, self.stiffness * np.maximum(elongation, 0.0)) * lever
        moment[elongation - self.strength / self.stiffness > self.ultimate] = 0.0
        return moment


@inlined
def pulled(tie: TiePull, theta: Any, side: float) -> tuple[Any, Any]:
    """Elongation of a tie beyond its slack [m], and its lever [m]: the rate of its length with the rotation theta.

    It stands beside `mjrock.geometry` because rocking theory, which uses it, shares no kinematics with the engine.

    theta [rad] may be an array outside compiled functions. `side` is the toe, +1 for the outer one.
    """
    d, z = side * tie.half_base - tie.offset, tie.height
    sine, cosine = np.sin(theta), np.cos(theta)
    # from the anchor to the point that is held
    x = tie.length + d * (1 - cosine) + z * sine
    up = d * sine - z * (1 - cosine) - tie.rise
    length = np.sqrt(x * x + up * up)
    return length - tie.reach, (x * (d * sine + z * cosine) + up * (d * cosine - z * sine)) / length


def moment_at_strength(pulls: Sequence[TiePull]) -> float:
    """Restoring moment of ties that pull with their strength, about the outer toe of a wall at rest [N m]."""
    return sum(pull.strength * float(pulled(pull, 0.0, 1.0)[1]) for pull in pulls)


def tie_limits(pulls: Mapping[str, TiePull], rotations: Array) -> tuple[dict[str, float], dict[str, float]]:
    """Rotations [rad] at which ties yield, and at which they break, under increasing rotation, shape (n,) each."""
    yielding: dict[str, float] = {}
    breaking: dict[str, float] = {}
    for name, pull in pulls.items():
        elongation = pulled(pull, rotations, 1.0)[0] - pull.strength / pull.stiffness
        for at, further in ((yielding, 0.0), (breaking, pull.ultimate)):
            beyond = np.flatnonzero(elongation > further)
            if beyond.size:
                at[name] = float(rotations[beyond[0]])
    return yielding, breaking


def yielded(pulls: Sequence[TiePull], theta: Array) -> Array:
    """Plastic elongation of each tie along a motion that includes its turning points [m], shape (n, ties).

    It is infinite from where the tie has broken: it is slack from then on.
    """
    plastic = np.zeros((len(theta), len(pulls)))
    for i, pull in enumerate(pulls):
        drawn = np.maximum.accumulate(_elongation(pull, theta) - pull.strength / pull.stiffness)
        plastic[:, i] = np.where(drawn > pull.ultimate, np.inf, np.maximum(drawn, 0.0))
    return plastic


def tie_energy(pulls: Sequence[TiePull], theta: Array, plastic: Array) -> Array:
    """Elastic energy of the ties [J], shape (n,), at rotations and plastic elongations of shapes (n,), (n, ties)."""
    energy = np.zeros(len(theta))
    for pull, gone in zip(pulls, plastic.T, strict=True):
        energy += 0.5 * pull.stiffness * np.maximum(_elongation(pull, theta) - gone, 0.0) ** 2
    return energy


def dissipated_by_ties(pulls: Sequence[TiePull], plastic: Array) -> Array:
    """Energy that all ties have dissipated by yielding and breaking so far [J], shape (n,), for plastic elongations (n,
    ties)."""
    total = np.zeros(len(plastic))
    for pull, gone in zip(pulls, plastic.T, strict=True):
        if gone.any():
            broken = np.isinf(gone)
            total = total + pull.strength * np.where(broken, pull.ultimate, gone)
            total[broken] += broken_energy(pull)
    return total


def broken_energy(pull: TiePull) -> float:
    """Elastic energy that a tie loses as it breaks [J]."""
    return 0.5 * pull.strength**2 / pull.stiffness


def _elongation(pull: TiePull, theta: Array) -> Array:
    elongation: Array = np.where(theta >= 0, pulled(pull, theta, 1.0)[0], pulled(pull, theta, -1.0)[0])
    return elongation
