"""What a solver returns: the motion, its impacts and rotation peaks, and how it ended."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .case import Case

if TYPE_CHECKING:
    from .ledger import Ledger

Array = NDArray[np.float64]
State = tuple[Array, Array]
"""Pose (x, z, theta) and velocity of the wall at one time, see `mjrock.pose`."""


class Outcome(enum.Enum):
    """How a run ended."""

    AT_REST = "at rest"
    OVERTURNED = "overturned"
    TIME_ENDED = "time ended"


@dataclass(frozen=True)
class Impact:
    """One rebound: what arrives at the upright position and what leaves it.

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


@dataclass(frozen=True)
class Response:
    """The motion that a solver found.

    Args:
        case: what was asked.
        solver: which solver answered.
        t: times [s], shape (n,).
        theta: rotation [rad], shape (n,).
        omega: angular velocity [rad/s], shape (n,).
        energy: kinetic, potential and, where contacts are compliant, elastic energy above the wall at rest [J],
            shape (n,).
        impacts: the impacts in order.
        peaks: rotation maxima |theta| [rad], the release first, shape (m,).
        outcome: how the run ended.
        message: the same in words, for the user.
        ledger: every part of the energy, or None where none was asked for.
        stats: what the run took: `steps`, `timestep` [s] or solver tolerances, `wall_time` [s]; from MuJoCo also the
            deepest penetrations `deepest_base` and `deepest_side` and the `base_displacement` at the end [m].
        end: pose and velocity at the end, to go on from with `simulate(..., start=...)`; None from other solvers.
    """

    case: Case
    solver: str
    t: Array
    theta: Array
    omega: Array
    energy: Array
    impacts: tuple[Impact, ...]
    peaks: Array
    outcome: Outcome
    message: str
    ledger: Ledger | None = None
    stats: dict[str, Any] = field(default_factory=dict)
    end: State | None = None

    @property
    def energy_residual(self) -> Array | None:
        """Closure error of the energy ledger [J], shape (n,), or None where none was asked for."""
        return None if self.ledger is None else self.ledger.residual

    @property
    def restitution(self) -> Array:
        """|e| of each rebound, from successive peaks [-], shape (m - 1,).

        e_n = sqrt(V_(n+1) / V_n), V the potential energy of the rigid wall at a rotation peak, or its whole energy at
        release. Every solver is measured with this one rule, which is exact for a rigid wall, and the energy that a
        compliant base still stores under a pivoting wall is not taken for a loss. On a shaken base the ground works
        between two peaks, and |e| is that of the impacts, one each.
        """
        if self.case.motion is not None:
            return np.array([impact.restitution for impact in self.impacts])
        return restitution_of(peak_energies(self.case, self.peaks))


def peak_energies(case: Case, peaks: Array) -> Array:
    """Energy of the rigid wall at its rotation peaks [J], shape (m,); the release counts with its velocity."""
    energy: Array = case.block.potential_energy(np.asarray(peaks, dtype=float))
    if len(energy) and not case.released_outwards and peaks[0] == case.release_peak:
        energy[0] = case.release_energy
    return energy


def restitution_of(energy: Array) -> Array:
    """|e| between successive energies [-]; NaN after a peak of no energy."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(energy[1:] / energy[:-1])


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
        case: the case, whose release is the first peak unless it is released on its way out.
        t, theta, omega, energy: the motion [s, rad, rad/s, J], shape (n,), finely sampled.
        uplift: rotation below which a maximum is the spring of the base and not rocking [rad], and the energy above
            rest that goes with it [J]. With a side stop a maximum on its side of theta = 0 is the spring of the stop,
            whatever its size.
        released: whether the motion starts with the release, and does not go on from an earlier one.

    Returns:
        Peak times [s], peaks |theta| [rad], and the impacts: of free rocking as the peaks on their two sides tell, on a
        shaken base as the wall itself does where it passes the uplift rotation.
    """
    times, sizes = _maxima(t, theta, omega, one_sided=case.side_stop)
    rocking = sizes > uplift[0]
    prepended = released and not case.released_outwards and case.release_energy > 0
    if prepended:
        rocking &= times > t[1]  # the release itself, where its velocity is not zero to the last digit
    residual = sizes[(times > times[rocking][-1]) if rocking.any() else times > t[0]]
    times, sizes = times[rocking], sizes[rocking]
    if prepended:
        times, sizes = np.append(t[0], times), np.append(case.release_peak, sizes)
    if case.motion is None:
        impacts = _between_peaks(case, t, theta, omega, times, sizes, residual, uplift[0])
    else:
        impacts = _between_passes(case, t, theta, omega, energy, uplift)
    return times, sizes, impacts


def _between_peaks(
    case: Case, t: Array, theta: Array, omega: Array, times: Array, sizes: Array, residual: Array, threshold: float
) -> tuple[Impact, ...]:
    """One impact between each pair of peaks, at the time when the wall passes theta = 0, or comes closest to it.

    An impact after which the wall no longer rocks is the last one: what it leaves is the energy of the largest rotation
    that follows, of those in `residual`, or of the motion with which the run ends.
    """
    wall = case.block
    if residual.size:
        left_over = float(wall.potential_energy(float(residual.max())))
    elif abs(theta[-1]) > threshold:  # the run ends on the way out
        left_over = float(wall.potential_energy(float(theta[-1]))) + 0.5 * wall.toe_inertia * float(omega[-1]) ** 2
    else:
        left_over = math.nan
    energies = peak_energies(case, sizes)
    impacts = []
    for i, start in enumerate(times):
        last = i == len(times) - 1
        if last and math.isnan(left_over):
            break  # the run ends in the impact
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
        before, after = float(energies[i]), left_over if last else float(energies[i + 1])
        arriving, leaving = -s, s if case.side_stop else (-s if last else math.copysign(1.0, theta[stop]))
        impacts.append(
            Impact(
                t=float(when),
                omega_before=arriving * math.sqrt(2 * max(0.0, before) / wall.toe_inertia),
                omega_after=leaving * math.sqrt(2 * max(0.0, after) / wall.toe_inertia),
                energy_before=before,
                energy_after=after,
            )
        )
    return tuple(impacts)


def _between_passes(
    case: Case, t: Array, theta: Array, omega: Array, energy: Array, uplift: tuple[float, float]
) -> tuple[Impact, ...]:
    """One impact for each time that the wall comes back below the uplift rotation.

    Before it the energy is that of the rigid wall on its way in past that rotation, after it on its way out again, to
    either side. A wall whose energy in between falls below that of uplift has come to rest, and this is what it leaves.
    """
    wall, (threshold, least) = case.block, uplift
    outside = np.where(np.abs(theta) > threshold, np.sign(theta), 0.0)
    if case.side_stop:
        outside = np.maximum(outside, 0.0)
    changes = np.flatnonzero(np.diff(outside))
    entries = changes[outside[changes] != 0]
    exits = changes[outside[changes + 1] != 0]
    rigid = wall.potential_energy(threshold)
    impacts = []
    for i in entries:
        s = outside[i]
        leaves = exits[exits >= i]
        j = int(leaves[0]) if leaves.size else len(t) - 1
        low = float(energy[i : j + 1].min())
        behind = np.flatnonzero(s * theta[i : j + 2] <= 0)
        crossed = i + int(behind[0]) if behind.size else j
        before = rigid + 0.5 * wall.toe_inertia * float(omega[i]) ** 2
        if low < least or not leaves.size:
            after, side = max(0.0, low), s
        else:
            after, side = rigid + 0.5 * wall.toe_inertia * float(omega[j + 1]) ** 2, outside[j + 1]
        arriving, leaving = (math.sqrt(2 * value / wall.toe_inertia) for value in (before, after))
        impacts.append(Impact(float(t[crossed]), -s * arriving, side * leaving, before, after))
    return tuple(impacts)


def _maxima(t: Array, theta: Array, omega: Array, *, one_sided: bool) -> tuple[Array, Array]:
    """Times and sizes of the maxima of |theta|, or of theta alone, interpolated between samples."""
    outward = omega * np.sign(theta)
    turns = np.flatnonzero((outward[:-1] > 0) & (outward[1:] <= 0) & ((theta[:-1] > 0) | (not one_sided)))
    share = outward[turns] / (outward[turns] - outward[turns + 1])
    lead = share * (t[turns + 1] - t[turns])
    return t[turns] + lead, np.abs(theta[turns]) + 0.5 * lead * outward[turns]


def ending(case: Case, t: Array, theta: Array, energy: Array, uplift_energy: float) -> tuple[Outcome, str]:
    """How a run on compliant contacts ended, and the same in words.

    The wall is at rest when its energy above the settled wall no longer lifts an edge off the base; it has overturned
    when it lies on its face or ends beyond alpha, where its weight no longer brings it back.
    """
    if abs(theta[-1]) > case.block.alpha:
        outcome = Outcome.OVERTURNED
    elif energy[-1] < uplift_energy:
        outcome = Outcome.AT_REST
    else:
        outcome = Outcome.TIME_ENDED
    return outcome, describe(outcome, case, min(float(t[-1]), case.duration), float(theta[-1]))


def describe(outcome: Outcome, case: Case, t_end: float, theta_end: float) -> str:
    """The ending in words."""
    share = abs(theta_end) / case.block.alpha
    match outcome:
        case Outcome.AT_REST:
            return f"The wall came to rest; last looked at {t_end:.4g} s."
        case Outcome.OVERTURNED:
            return f"The wall overturned; at {t_end:.4g} s its rotation was {share:.3g} alpha."
        case Outcome.TIME_ENDED:
            return f"The wall was still rocking when the asked {t_end:.4g} s ended, at {share:.3g} alpha."
