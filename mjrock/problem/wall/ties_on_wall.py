"""Ties on a rigid wall: how far they are stretched, and the lever of their force about the toe."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...compiled import inlined
from ...quantities import Array
from .effect import Anchored


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
    def of(cls, tie: Anchored, b: float, half_base: float) -> TiePull:
        """A tie that holds the inner face of a wall of half thickness `b` and half base `half_base` [m]."""
        law = tie.law
        shape = -b, tie.height, tie.length, tie.rise, half_base, law.reach
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
    """Rotations [rad] at which ties yield, and at which they break, of those that do at increasing rotations (n,)."""
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


def taken(pulls: Sequence[TiePull], plastic: Array) -> Array:
    """Energy that all ties have taken by yielding and breaking so far [J], shape (n,), for plastic elongations (n,
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
