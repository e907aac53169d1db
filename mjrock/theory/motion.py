"""The answer of rocking theory: impacts, peaks, how the motion ends, and its samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from ..problem.wall.case import Case
from ..quantities import Array


@dataclass(frozen=True)
class RockingMotion:
    """A motion of a rigid wall from impact to impact.

    Args:
        impacts: the numbers of each impact, as in `mjrock.result.rocking.Impact`, shape (m, 5).
        peaks: rotation maxima |theta| [rad] after the release.
        t, theta: time and rotation at the end [s, rad].
        fell: whether the wall lies on its face.
        at_rest: whether the wall rests upright.
        sample: rotation [rad] and angular velocity [rad/s] at n increasing times [s], shape (2, n).
        evaluations: evaluations of Eq. 1.
        plastic: times [s] and elongations that ties have yielded by then [m], infinite once they have broken, shapes
            (n,) and (n, ties); or None.
    """

    impacts: Array
    peaks: Array
    t: float
    theta: float
    fell: bool
    at_rest: bool
    sample: Callable[[Array], Array]
    evaluations: int
    plastic: tuple[Array, Array] | None = None


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """A `mjrock.result.motion.Motion` of a rigid wall. Pose, velocity and energy are computed when they are first read:
    campaigns read peaks and impacts alone, and computing them takes longer than the rocking.

    Args:
        case: the wall.
        rotation, rate: rotation [rad] and angular velocity [rad/s] at the samples, shape (n,).
        of_ties: energy of the ties at the samples [J].
    """

    case: Case
    rotation: Array
    rate: Array
    of_ties: Array | float

    @property
    def theta(self) -> Array:
        """Rotation of the one body [rad], shape (n, 1)."""
        return self.rotation[:, None]

    @cached_property
    def pose(self) -> Array:
        """Displacement of the centroid [m] and rotation [rad], shape (n, 1, 3)."""
        return self.case.wall.pose(self.rotation)[:, None]

    @cached_property
    def velocity(self) -> Array:
        """Its rate [m/s, rad/s], shape (n, 1, 3)."""
        return self.case.wall.velocity(self.rotation, self.rate)[:, None]

    @cached_property
    def energy(self) -> Array:
        """Energy of the wall and its ties above rest [J], shape (n,)."""
        return self.case.energy(self.rotation, self.rate) + self.of_ties
