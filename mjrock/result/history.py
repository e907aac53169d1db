"""Peaks and impacts of a sampled rocking motion."""

from __future__ import annotations

import math

import numpy as np

from ..problem.wall.case import Case
from ..quantities import Array
from .rocking import Impact, peak_energies


def rocking_history(
    case: Case,
    t: Array,
    theta: Array,
    omega: Array,
    energy: Array,
    uplift: tuple[float, float],
    *,
    released: bool = True,
) -> tuple[Array, Array, tuple[Impact, ...]]:
    """Times and sizes of the rotation peaks, and the impacts between them, of a sampled rocking motion.

    Args:
        case: the case. Its release is the first peak unless it is released on its way out.
        t, theta, omega, energy: the motion [s, rad, rad/s, J], shape (n,), finely sampled.
        uplift: the rotation at which an edge of the base lifts [rad], and the energy above rest that belongs to it [J].
            A smaller maximum is an elastic motion of the base and no rocking. With a side stop, a maximum behind
            theta = 0 is an elastic motion of the stop, whatever its size.
        released: whether the motion starts with the release. False where it continues an earlier one.

    Returns:
        Peak times [s], peaks |theta| [rad], and the impacts. In free rocking an impact is found from the peaks before
        and after it. On a shaken base it is found from the velocities at which the wall passes the uplift rotation.
    """
    times, sizes = _maxima(t, theta, omega, one_sided=case.one_sided)
    rocking = sizes > uplift[0]
    prepended = released and not case.released_outwards and case.release_energy > 0
    if prepended:
        rocking &= times > t[1]  # the release itself, where its velocity differs from zero by rounding
    residual = sizes[(times > times[rocking][-1]) if rocking.any() else times > t[0]]
    times, sizes = times[rocking], sizes[rocking]
    if prepended:
        times, sizes = np.append(t[0], times), np.append(case.release_peak, sizes)
    if case.shaken:
        return times, sizes, _between_passes(case, t, theta, omega, energy, uplift)
    return times, sizes, _between_peaks(case, t, theta, omega, times, sizes, residual, uplift[0])


def _maxima(t: Array, theta: Array, omega: Array, *, one_sided: bool) -> tuple[Array, Array]:
    """Times and sizes of the maxima of |theta|, or of theta alone, interpolated between samples."""
    outward = omega * np.sign(theta)
    turns = np.flatnonzero((outward[:-1] > 0) & (outward[1:] <= 0) & ((theta[:-1] > 0) | (not one_sided)))
    share = outward[turns] / (outward[turns] - outward[turns + 1])
    lead = share * (t[turns + 1] - t[turns])
    return t[turns] + lead, np.abs(theta[turns]) + 0.5 * lead * outward[turns]


def _between_peaks(
    case: Case, t: Array, theta: Array, omega: Array, times: Array, sizes: Array, residual: Array, threshold: float
) -> tuple[Impact, ...]:
    """One impact between each pair of peaks, at the time when the wall passes theta = 0 or comes closest to it.

    An impact after which the wall no longer rocks is the last one. Its energy after the impact is that of the largest
    rotation in `residual`, the maxima that follow, or of the motion with which the run ends.
    """
    left_over = _left_over(case, theta, omega, residual, threshold)
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


def _left_over(case: Case, theta: Array, omega: Array, residual: Array, threshold: float) -> float:
    """Energy that the wall has after its last impact [J]. It is NaN if the run ends during that impact."""
    if residual.size:
        return float(case.restoring.energy(float(residual.max())))
    if abs(theta[-1]) > threshold:  # the run ends while the wall turns outwards
        kinetic = 0.5 * case.wall.inertia_about(float(theta[-1])) * float(omega[-1]) ** 2
        return float(case.restoring.energy(float(theta[-1]))) + kinetic
    return math.nan


def _between_passes(
    case: Case, t: Array, theta: Array, omega: Array, energy: Array, uplift: tuple[float, float]
) -> tuple[Impact, ...]:
    """One impact for each time that the rotation falls below the uplift rotation.

    The energy before it is that of the rigid wall as it falls below that rotation. The energy after it is that of the
    rigid wall as it exceeds it again, to either side. A wall whose energy drops below that of uplift in between has
    come to rest. The energy after the impact is then that lowest energy.
    """
    wall, (threshold, least) = case.wall, uplift
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
        if low < least or not leaves.size:
            after, side = max(0.0, low), s
        else:
            side = outside[j + 1]
            after = float(case.restoring.energy(side * threshold))
            after += 0.5 * wall.inertia_about(side) * float(omega[j + 1]) ** 2
        arriving = math.sqrt(2 * before / wall.inertia_about(s))
        leaving = math.sqrt(2 * after / wall.inertia_about(side))
        impacts.append(Impact(float(t[crossed]), -s * arriving, side * leaving, before, after))
    return tuple(impacts)
