"""Rocking of a wall: its impacts and rotation peaks, and the restitution between them. How it ended is in `ending`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..problem.damping.contacts import Uplift
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

    def __repr__(self) -> str:
        omega = f"{self.omega_before:.4g} to {self.omega_after:.4g} rad/s"
        return f"<Impact at {self.t:.4g} s: {omega}, {self.energy_before:.4g} to {self.energy_after:.4g} J>"

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
    """Results of the motion of a wall.

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

    The release counts with its velocity. Peaks have their sign where the wall is not symmetric.
    """
    leaving, reaching = (energy.copy() for energy in case.peak_energies(np.asarray(peaks, dtype=float)))
    if len(leaving) and not case.released_outwards and abs(peaks[0]) == case.release_peak and case.omega0:
        leaving[0] += case.release_energy - float(case.restoring.energy(case.release_peak))
    return leaving, reaching


def restitution_of(leaving: Array, reaching: Array) -> Array:
    """|e| between successive peaks, from their energies [-]. It is NaN after a peak of no energy."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(reaching[1:] / leaving[:-1])


def largest_rotations(case: Case, rocking: Rocking, theta: Array) -> tuple[float, float]:
    """Largest rotation of a wall outwards and inwards [rad], from its peaks and the rotations at the samples, (n,).

    The largest rotation may be that of the last sample, where a run ends on its way out. Against a side stop peaks are
    outward, and the inward rotation is that of the wall as it presses the stop or leans over it.
    """
    peak, outwards, inwards = float(rocking.peaks.max(initial=0.0)), float(theta.max()), -float(theta.min())
    if case.one_sided:
        return max(peak, float(theta[-1])), max(inwards, 0.0)
    peak = max(peak, abs(float(theta[-1])))
    return (peak, max(inwards, 0.0)) if outwards >= inwards else (max(outwards, 0.0), peak)


class RockingHistory(NamedTuple):
    """Rotation peaks of a wall and the impacts between them.

    Args:
        times: times of the peaks [s], shape (m,).
        peaks: |theta| at the peaks [rad], shape (m,).
        impacts: the impacts in order.
    """

    times: Array
    peaks: Array
    impacts: tuple[Impact, ...]


class RotationHistory(NamedTuple):
    """The sampled rotation of a wall, finely enough to find its impacts.

    Args:
        t: times of the samples [s], shape (n,).
        theta: rotation [rad], likewise.
        omega: angular velocity [rad/s].
        energy: above rest [J].
    """

    t: Array
    theta: Array
    omega: Array
    energy: Array


def rocking_history(case: Case, motion: RotationHistory, uplift: Uplift, *, released: bool = True) -> RockingHistory:
    """The rotation peaks of a sampled rocking motion, and the impacts between them.

    Args:
        case: the case. Its release is the first peak unless it is released on its way out.
        motion: the motion.
        uplift: the rotation and the energy at which an edge of the base lifts. A smaller maximum is an elastic motion
            of the base and no rocking. With a side stop, a maximum behind theta = 0 is an elastic motion of the stop,
            whatever its size.
        released: whether the motion starts with the release. False where it continues an earlier one.

    Returns:
        Peaks and impacts. In free rocking an impact is found from the peaks before and after it. On a shaken base it is
        found from the velocities at which the wall passes the uplift rotation.
    """
    times, sizes = _maxima(motion, one_sided=case.one_sided)
    rocking = sizes > uplift.rotation
    prepended = released and not case.released_outwards and case.release_energy > 0
    if prepended:
        rocking &= times > motion.t[1]  # the release itself, where its velocity differs from zero by rounding
    residual = sizes[(times > times[rocking][-1]) if rocking.any() else times > motion.t[0]]
    times, sizes = times[rocking], sizes[rocking]
    if prepended:
        times, sizes = np.append(motion.t[0], times), np.append(case.release_peak, sizes)
    if case.shaken:
        return RockingHistory(times, sizes, _impacts_between_passes(case, motion, uplift))
    return RockingHistory(times, sizes, _impacts_between_peaks(case, motion, times, sizes, residual, uplift.rotation))


def _maxima(motion: RotationHistory, *, one_sided: bool) -> tuple[Array, Array]:
    """Times and sizes of the maxima of |theta|, or of theta alone, interpolated between samples."""
    t, theta, omega, _ = motion
    outward = omega * np.sign(theta)
    turns = np.flatnonzero((outward[:-1] > 0) & (outward[1:] <= 0) & ((theta[:-1] > 0) | (not one_sided)))
    share = outward[turns] / (outward[turns] - outward[turns + 1])
    lead = share * (t[turns + 1] - t[turns])
    return t[turns] + lead, np.abs(theta[turns]) + 0.5 * lead * outward[turns]


def _impacts_between_peaks(
    case: Case, motion: RotationHistory, times: Array, sizes: Array, residual: Array, threshold: float
) -> tuple[Impact, ...]:
    """One impact between each pair of peaks, at the time when the wall passes theta = 0 or comes closest to it.

    An impact after which the wall no longer rocks is the last one. Its energy after the impact is that of the largest
    rotation in `residual`, the maxima that follow, or of the motion with which the run ends.
    """
    t, theta, _, _ = motion
    left_over = _energy_after_last(case, motion, residual, threshold)
    signs = np.sign(np.interp(times, t, theta))
    leaving_peak, reaching_peak = peak_energies(case, np.where(signs < 0, -sizes, sizes))
    impacts = []
    for i, start in enumerate(times):
        last = i == len(times) - 1
        if last and math.isnan(left_over):
            break  # the run ends during the impact
        first, stop = np.searchsorted(t, [start, t[-1] if last else times[i + 1]])
        s = math.copysign(1.0, theta[first])
        segment = s * theta[first : stop + 1]
        crossed = np.flatnonzero((segment[:-1] > 0) & (segment[1:] <= 0))
        if crossed.size:
            j = first + crossed[0]
            when = t[j] + theta[j] / (theta[j] - theta[j + 1]) * (t[j + 1] - t[j])
        elif last:
            break
        else:
            j = first + int(np.argmin(segment))
            when = t[j]
        before, after = float(leaving_peak[i]), left_over if last else float(reaching_peak[i + 1])
        arriving, leaving = -s, s if case.side_stop else (-s if last else math.copysign(1.0, theta[stop]))
        impacts.append(
            Impact(
                t=float(when),
                omega_before=arriving * math.sqrt(2 * max(0.0, before) / case.wall.inertia_about(-arriving)),
                omega_after=leaving * math.sqrt(2 * max(0.0, after) / case.wall.inertia_about(leaving)),
                energy_before=before,
                energy_after=after,
            )
        )
    return tuple(impacts)


def _energy_after_last(case: Case, motion: RotationHistory, residual: Array, threshold: float) -> float:
    """Energy that the wall has after its last impact [J]. It is NaN if the run ends during that impact."""
    if residual.size:
        return float(case.restoring.energy(float(residual.max())))
    theta, omega = float(motion.theta[-1]), float(motion.omega[-1])
    if abs(theta) > threshold:  # the run ends while the wall turns outwards
        return float(case.restoring.energy(theta)) + 0.5 * case.wall.inertia_about(theta) * omega**2
    return math.nan


def _impacts_between_passes(case: Case, motion: RotationHistory, uplift: Uplift) -> tuple[Impact, ...]:
    """One impact for each time that the rotation falls below the uplift rotation.

    The energy before it is that of the rigid wall as it falls below that rotation. The energy after it is that of the
    rigid wall as it exceeds it again, to either side. A wall whose energy drops below that of uplift in between has
    come to rest. The energy after the impact is then that lowest energy.
    """
    wall, (threshold, least_energy), (t, theta, omega, energy) = case.wall, uplift, motion
    outside = np.where(np.abs(theta) > threshold, np.sign(theta), 0.0)
    if case.side_stop:
        outside = np.maximum(outside, 0.0)
    changes = np.flatnonzero(np.diff(outside))
    entries = changes[outside[changes] != 0]
    exits = changes[outside[changes + 1] != 0]
    impacts = []
    for i in entries:
        s = outside[i]
        leaves = exits[np.searchsorted(exits, i) :]
        j = int(leaves[0]) if leaves.size else len(t) - 1
        low = float(energy[i : j + 1].min())
        behind = np.flatnonzero(s * theta[i : j + 2] <= 0)
        crossed = i + int(behind[0]) if behind.size else j
        before = float(case.restoring.energy(s * threshold)) + 0.5 * wall.inertia_about(s) * float(omega[i]) ** 2
        if low < least_energy or not leaves.size:
            after, side = max(0.0, low), s
        else:
            side = outside[j + 1]
            after = float(case.restoring.energy(side * threshold))
            after += 0.5 * wall.inertia_about(side) * float(omega[j + 1]) ** 2
        arriving = math.sqrt(2 * before / wall.inertia_about(s))
        leaving = math.sqrt(2 * after / wall.inertia_about(side))
        impacts.append(
            Impact(
                t=float(t[crossed]),
                omega_before=-s * arriving,
                omega_after=side * leaving,
                energy_before=before,
                energy_after=after,
            )
        )
    return tuple(impacts)
