"""The answer of rocking theory: impacts, peaks, how the motion ends, and its samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..quantities import Array


@dataclass(frozen=True)
class Motion:
    """A motion of a rigid wall from impact to impact.

    Args:
        impacts: the numbers of each impact, as in `mjrock.result.history.Impact`, shape (m, 5).
        peaks: rotation maxima |theta| [rad] after the release.
        t, theta: time and rotation at the end [s, rad].
        fell: whether the wall lies on its face.
        at_rest: whether the wall rests upright.
        sample: rotation [rad] and angular velocity [rad/s] at increasing times [s].
        arcs: how many arcs, or steps, the motion is made of.
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
    sample: Callable[[Array], tuple[Array, Array]]
    arcs: int
    evaluations: int
    plastic: tuple[Array, Array] | None = None
