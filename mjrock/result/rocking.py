"""Rocking of a wall: its impacts and rotation peaks, and the restitution between them. How it ended is in `ending`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..problem.wall.case import Case
from ..quantities import Array


class Impact(NamedTuple):
    """One rebound: the motion just before and just after the wall passes the upright position.

    Args:
        t: time of the impact [s].
        omega_before: angular velocity just before [rad/s].
        omega_after: angular velocity just after [rad/s].
        energy_before: energy of the rigid wall just before, above the wall at rest [J].
        energy_after: energy just after [J].
    """

    t: float
    omega_before: float
    omega_after: float
    energy_before: float
    energy_after: float

    @property
    def restitution(self) -> float:
        """|e| [-]."""
        return math.sqrt(self.energy_after / self.energy_before) if self.energy_before > 0 else math.nan

    @property
    def energy_loss(self) -> float:
        """Energy lost in the impact [J]."""
        return self.energy_before - self.energy_after


@dataclass(frozen=True, eq=False)
class Rocking:
    """What is read from the motion of a wall.

    Args:
        impacts: the impacts in order.
        peaks: rotation maxima |theta| [rad], the release first, shape (m,).
    """

    impacts: tuple[Impact, ...]
    peaks: Array

    def restitution(self, case: Case) -> Array:
        """|e| of each rebound, from successive peaks [-], shape (m - 1,).

        e_n = sqrt(V_(n+1) / V_n), with V the potential energy of the rigid wall at a rotation peak, or its whole energy
        at the release. Every solver is measured with this one rule. It is exact for a rigid wall, and it does not count
        the energy that a compliant base stores under a pivoting wall as a loss. On a shaken base the ground does work
        between two peaks. There, with ties and for a lopsided wall, |e| is that of the impacts, shape (len(impacts),).
        """
        if case.shaken or case.pulls or case.lopsided:
            return np.array([impact.restitution for impact in self.impacts])
        return restitution_of(*peak_energies(case, self.peaks))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Rocking):
            return NotImplemented
        return self.impacts == other.impacts and np.array_equal(self.peaks, other.peaks)

    __hash__ = None  # type: ignore[assignment]


def peak_energies(case: Case, peaks: Array) -> tuple[Array, Array]:
    """Energy of the rigid wall at its rotation peaks, on leaving each and on the way to it [J], shape (m,) each.

    The release counts with its velocity. Peaks have their sign where the wall is lopsided.
    """
    leaving, reaching = (energy.copy() for energy in case.peak_energies(np.asarray(peaks, dtype=float)))
    if len(leaving) and not case.released_outwards and abs(peaks[0]) == case.release_peak and case.omega0:
        leaving[0] += case.release_energy - float(case.restoring.energy(case.release_peak))
    return leaving, reaching


def restitution_of(leaving: Array, reaching: Array) -> Array:
    """|e| between successive peaks, from their energies [-]. It is NaN after a peak of no energy."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(reaching[1:] / leaving[:-1])


def farthest(case: Case, rocking: Rocking, theta: Array) -> tuple[float, float]:
    """Largest rotation of a wall outwards, and inwards [rad], from its peaks and the rotations at the samples, (n,).

    The largest rotation may be that of the last sample, where a run ends on its way out. Against a side stop peaks are
    outward, and the inward rotation is that of the wall as it presses the stop or leans over it.
    """
    peak, outwards, inwards = float(rocking.peaks.max(initial=0.0)), float(theta.max()), -float(theta.min())
    if case.one_sided:
        return max(peak, float(theta[-1])), max(inwards, 0.0)
    peak = max(peak, abs(float(theta[-1])))
    return (peak, max(inwards, 0.0)) if outwards >= inwards else (max(outwards, 0.0), peak)
