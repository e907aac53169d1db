"""MuJoCo's contact units. A spring k [N/m] and a dashpot c [N s/m] become solref and solimp, and back.

With a constant impedance d, a contact row of MuJoCo's Euler step obeys

    f = max(0, -(k r + c v + m_i a)),    m_i = d / ((1 - d) W),

r the gap, v and a its rates, W the pair's inverse weight (the sum of `body_invweight0` of its two bodies). In the
direct format solref = (-(1 - d) W k, -(1 - d) W c) and solimp = (d, d, ...). The Euler step is a leapfrog: v lives half
a step back, v+ = v + h a. The row's inertia m_i is therefore not an error to hide but a choice,

    m_i = h c / 2 + beta h^2 k,

which turns the step into Newmark's: c acts on the mean of v and v+, and k on r + beta h^2 a. beta = 1/4 (average
acceleration) is stable at every step and adds no numerical damping; beta = 0 is central difference, 1/12 Fox-Goodwin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .block import Real

IMPEDANCE_RANGE = (1e-4, 0.9999)
"""mjMINIMP and mjMAXIMP: MuJoCo clamps an impedance outside it without a word, and the stiffness with it."""


OVERDAMPED = 0.2
"""c h W above which a dashpot is taken at the end of the step instead of centred in it [-]. A contact's own inverse
mass is up to six times W, so that the centred dashpot would still leave a quarter of the velocity here."""


@dataclass(frozen=True)
class ContactParameters:
    """What a MuJoCo `<pair>` carries, and the inertia that comes with it.

    Args:
        solref: (-stiffness, -damping), MuJoCo's direct format [1/s2, 1/s].
        solimp: (d0, dwidth, width, midpoint, power) with d0 = dwidth, so that the impedance is constant.
        inertia: m_i, the inertia of the contact row [kg].
    """

    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]
    inertia: float

    @property
    def impedance(self) -> float:
        """d [-]."""
        return self.solimp[0]


def most_inertia(inverse_weight: float) -> float:
    """The largest row inertia whose impedance MuJoCo does not clamp [kg]."""
    d = IMPEDANCE_RANGE[1] * (1 - 1e-9)
    return d / ((1 - d) * inverse_weight)


def newmark_inertia(k: Real, c: Real, timestep: float | Real, newmark_beta: float | Real) -> Real:
    """m_i = h c/2 + beta h^2 k [kg], what makes the Euler step Newmark's with centred damping."""
    return timestep * c / 2 + newmark_beta * timestep**2 * k


def impedance(inertia: Real, inverse_weight: float) -> Real:
    """d of a row with the inertia m_i [-], from m_i = d / ((1 - d) W)."""
    return inverse_weight * inertia / (1 + inverse_weight * inertia)


def least_inertia(inverse_weight: float) -> float:
    """The smallest row inertia whose impedance MuJoCo does not clamp [kg]."""
    d = IMPEDANCE_RANGE[0] * (1 + 1e-9)
    return d / ((1 - d) * inverse_weight)


def least_beta(k: float, c: float, timestep: float, inverse_weight: float) -> float:
    """The smallest Newmark beta whose impedance MuJoCo does not clamp.

    It exceeds 1/4 only where the row's inertia falls below 1e-4 / inverse_weight: a soft spring with little damping
    and a small step. More inertia than asked then moves a frequency by less than 1e-4, and damps nothing.
    """
    return (least_inertia(inverse_weight) - timestep * c / 2) / (timestep**2 * k)


def lag_inertia(
    c: float | NDArray[np.float64], timestep: float | NDArray[np.float64], inverse_weight: float
) -> NDArray[np.float64]:
    """What a row's inertia takes on top for a dashpot that is stiff for the step, m_i = h c instead of h c/2 [kg].

    A dashpot that would stop its contact within the step would, centred in the step, throw it back instead. With this
    it acts on the velocity at the end of the step, and stops what it should stop.
    """
    return np.where(c * timestep * inverse_weight > OVERDAMPED, timestep * c / 2, 0.0)


def row_terms(
    k: NDArray[np.float64],
    c: NDArray[np.float64],
    timestep: float | NDArray[np.float64],
    inverse_weight: float,
    newmark_beta: float | NDArray[np.float64],
    ringing: float | NDArray[np.float64] = 0.0,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Dashpot [N s/m] and inertia [kg] of many rows: f = -(k r + dashpot v + inertia a); arguments broadcast.

    `ringing` is an extra dashpot in units of h k, for steps that do not resolve the contact. A dashpot that would take
    more than half the inertia that MuJoCo represents, thousands of times the wall's, is no stronger than that.
    """
    damping = np.minimum(c + ringing * timestep * k, 0.5 * most_inertia(inverse_weight) / timestep)
    inertia = newmark_inertia(k, damping, timestep, newmark_beta) + lag_inertia(damping, timestep, inverse_weight)
    return damping, np.maximum(inertia, least_inertia(inverse_weight))


def sound_beta(k: float, c: float, timestep: float, inverse_weight: float, newmark_beta: float) -> float:
    """The Newmark beta to take where `newmark_beta` is asked for.

    It is larger where MuJoCo would clamp the row (`least_beta`), and where the dashpot is stiff for the step
    (`lag_inertia`).
    """
    newmark_beta += float(lag_inertia(c, timestep, inverse_weight)) / (timestep**2 * k)
    return max(newmark_beta, least_beta(k, c, timestep, inverse_weight))


def contact_parameters(
    k: float, c: float, *, timestep: float, inverse_weight: float, newmark_beta: float = 0.25
) -> ContactParameters:
    """MuJoCo's parameters for a unilateral spring and dashpot, integrated as Newmark's method does.

    Args:
        k: stiffness [N/m], positive.
        c: damping [N s/m], not negative.
        timestep: step h of MuJoCo's Euler integrator [s], positive.
        inverse_weight: W [1/kg], positive: 2/(3 m) for the planar wall (two slides and a hinge), 1/m for a free body.
        newmark_beta: beta [-], not negative.

    Raises:
        ValueError: for a value outside its range, or one that needs an impedance which MuJoCo would silently clamp.
    """
    for name, value, least in (
        ("stiffness k [N/m]", k, "k > 0"),
        ("timestep [s]", timestep, "timestep > 0"),
        ("inverse_weight [1/kg]", inverse_weight, "inverse_weight > 0"),
    ):
        if not 0 < value < float("inf"):
            raise ValueError(f"{name} = {value:g} is outside the valid range {least}")
    for name, value in (("damping c [N s/m]", c), ("newmark_beta", newmark_beta)):
        if not 0 <= value < float("inf"):
            raise ValueError(f"{name} = {value:g} is outside the valid range, which starts at 0")
    inertia = newmark_inertia(k, c, timestep, newmark_beta)
    d = impedance(inertia, inverse_weight)
    low, high = IMPEDANCE_RANGE
    if not low <= d <= high:
        remedy = "raise the timestep or newmark_beta" if d < low else "lower the timestep"
        raise ValueError(
            f"impedance d = {d:.6g} for k = {k:g} N/m, c = {c:g} N s/m, timestep = {timestep:g} s is outside the valid "
            f"range {low:g} to {high:g}, where MuJoCo would clamp it and change the stiffness; {remedy}"
        )
    scale = (1 - d) * inverse_weight
    return ContactParameters(solref=(-scale * k, -scale * c), solimp=(d, d, 0.001, 0.5, 2.0), inertia=inertia)


def contact_stiffness(
    solref: tuple[float, ...], solimp: tuple[float, ...], *, inverse_weight: float
) -> tuple[float, float]:
    """The spring k [N/m] and dashpot c [N s/m] of a contact in MuJoCo's direct format; inverts `contact_parameters`.

    Raises:
        ValueError: if solref is not in the direct (negative) format, or the impedance is not constant or is one that
            MuJoCo would clamp, or the weight is not positive.
    """
    if len(solref) < 2 or len(solimp) < 2 or not 0 < inverse_weight < float("inf"):
        raise ValueError(
            f"solref = {tuple(solref)}, solimp = {tuple(solimp)} and inverse_weight = {inverse_weight:g} 1/kg: "
            "two and at least two numbers and a positive weight are needed"
        )
    d, d_width = solimp[0], solimp[1]
    low, high = IMPEDANCE_RANGE
    if not (solref[0] < 0 and solref[1] <= 0):
        raise ValueError(f"solref = {tuple(solref)} is not in the direct format (-stiffness, -damping)")
    if d != d_width or not low <= d <= high:
        raise ValueError(f"solimp = {tuple(solimp)} is not a constant impedance in the valid range {low:g} to {high:g}")
    scale = (1 - d) * inverse_weight
    return -solref[0] / scale, -solref[1] / scale


def friction_that_holds(
    normal: ContactParameters, *, timestep: float, held_inertia: float
) -> tuple[tuple[float, float], float]:
    """The friction row of an elliptic contact that stops sliding within one step: (solreffriction, impratio).

    A friction row has no spring, only a dashpot, and impratio times the inertia of its normal row. With a damping rate
    of 1/h (solreffriction = (~0, -d/h)) the sliding velocity half a step ahead is zero, up to the share of the force
    that the row's inertia leaves: with `held_inertia` [kg], a load F creeps at F h / held_inertia [m/s].
    """
    return (-1e-30, -normal.impedance / timestep), held_inertia / normal.inertia
