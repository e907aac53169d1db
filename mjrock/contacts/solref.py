"""MuJoCo's contact units. A spring k [N/m] and a dashpot c [N s/m] become solref and solimp, and back.

With a constant impedance d, a contact row of MuJoCo's Euler step obeys

    f = max(0, -(k r + c v + m_i a)),    m_i = d / ((1 - d) W),

with r the gap, v and a its rates, and W the inverse weight of the pair, the sum of `body_invweight0` of its two bodies.
In the direct format solref = (-(1 - d) W k, -(1 - d) W c) and solimp = (d, d, ...). The Euler step is a leapfrog: v
lies half a step before r, and v+ = v + h a. So mjrock chooses the inertia m_i of a row. With

    m_i = h c / 2 + beta h^2 k

the step is that of Newmark's method: c acts on the mean of v and v+, and k on r + beta h^2 a. beta = 1/4 (average
acceleration) is stable at every step and adds no numerical damping. beta = 0 is central difference, 1/12 Fox-Goodwin.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar, overload

import numpy as np

from .checks import Array, is_iterable, require_reals, require_row, require_within, short_repr, shown

IMPEDANCE_RANGE = (1e-4, 0.9999)
"""mjMINIMP and mjMAXIMP. MuJoCo clamps an impedance outside this range silently, and so changes the stiffness."""
WITHIN = (IMPEDANCE_RANGE[0] * (1 + 1e-9), IMPEDANCE_RANGE[1] * (1 - 1e-9))
"""The same range less a margin for rounding."""
STIFF_DASHPOT = 0.2
"""c h W above which a dashpot acts on the velocity at the end of the step [-], see `row`."""
INLINED: list[Callable[..., Any]] = []
"""Functions of numbers alone, which loops that are compiled may call."""
Function = TypeVar("Function", bound=Callable[..., Any])


def inlined(function: Function) -> Function:
    """Add a function to `INLINED`."""
    INLINED.append(function)
    return function


Numbers = Array | float
"""A number, or an array of them."""


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

    __repr__ = short_repr

    @property
    def impedance(self) -> float:
        """d [-]."""
        return self.solimp[0]


def body_weight(mass: Array, translations: int) -> Array:
    """Inverse weight of bodies [1/kg]: 2 / (3 m) of those that move in a plane, with 2 translations, 1 / m in space.

    MuJoCo's `body_invweight0` is the mean of the inverse masses along three axes. Two slides and a hinge leave two, and
    three slides and a ball about the centroid all three.
    """
    return translations / (3 * mass)


@inlined
def inertia_of(impedance: float, inverse_weight: float) -> float:
    """m_i = d / ((1 - d) W) [kg]."""
    return impedance / ((1 - impedance) * inverse_weight)


@inlined
def impedance_of(inertia: float, inverse_weight: float) -> float:
    """d of a row with the inertia m_i [-], the inverse of `inertia_of`."""
    return inverse_weight * inertia / (1 + inverse_weight * inertia)


@inlined
def newmark_inertia(k: float, c: float, timestep: float, newmark_beta: float) -> float:
    """m_i = h c / 2 + beta h^2 k [kg], which makes the Euler step Newmark's with centred damping."""
    return 0.5 * timestep * c + newmark_beta * (timestep * timestep) * k


class RowStep(NamedTuple):
    """How a step integrates a contact row.

    Args:
        h: length of the step [s].
        newmark_beta: beta [-].
        ringing: an extra dashpot in units of h k [-], for steps that do not resolve the contact.
        overdamped: c h W above which a dashpot is stiff for the step [-].
    """

    h: float
    newmark_beta: float = 0.25
    ringing: float = 0.0
    overdamped: float = STIFF_DASHPOT


@inlined
def row(k: float, c: float, inverse_weight: float, step: RowStep) -> tuple[float, float]:
    """Dashpot [N s/m] and inertia [kg] of a contact row that is sound at any step: f = -(k r + dashpot v + inertia a).

    They are c and `newmark_inertia` but for three cases:

    * A dashpot that would take more than half the inertia that MuJoCo represents is no stronger than that. This is
      thousands of times the mass of the body.
    * A dashpot that is stiff for the step, c h W > `overdamped`, acts on the velocity at the end of the step, m_i = h c
      instead of h c / 2. Centred in the step, it would throw back the contact that it should stop.
    * A row whose impedance MuJoCo would clamp has the least inertia that it represents. More inertia than requested
      then changes a frequency by less than 1e-4, and it damps nothing.

    Args:
        k, c: spring [N/m] and dashpot [N s/m].
        inverse_weight: W [1/kg].
        step: its length and how it integrates the row.
    """
    h = step.h
    strongest = 0.5 * inertia_of(WITHIN[1], inverse_weight) / h
    dashpot = min(c + step.ringing * h * k, strongest)
    inertia = newmark_inertia(k, dashpot, h, step.newmark_beta)
    if dashpot * h * inverse_weight > step.overdamped:
        inertia += 0.5 * h * dashpot
    return dashpot, max(inertia, inertia_of(WITHIN[0], inverse_weight))


@inlined
def pair_values(k: float, dashpot: float, inertia: float, inverse_weight: float) -> tuple[float, float, float]:
    """The two numbers of solref, in the direct format [1/s2, 1/s], and the impedance [-] of a row."""
    d = impedance_of(inertia, inverse_weight)
    scale = (1 - d) * inverse_weight
    return -scale * k, -scale * dashpot, d


@inlined
def longest_represented_step(k: float, inverse_weight: float) -> float:
    """The longest step at which MuJoCo can represent a spring of stiffness k [s]. It is no limit of stability.

    h^2 k is then 0.4 of the largest inertia that its range of impedances leaves to a row.
    """
    return math.sqrt(0.4 * inertia_of(WITHIN[1], inverse_weight) / k)


@dataclass(frozen=True)
class ManyContactParameters:
    """What the `<pair>` elements of MuJoCo carry for arrays of contacts, such as one for each environment.

    Args:
        solref: (-stiffness, -damping) [1/s2, 1/s], shape (..., 2).
        solimp: (d0, dwidth, width, midpoint, power), shape (..., 5).
        inertia: m_i, the inertia of each contact row [kg].
    """

    solref: Array
    solimp: Array
    inertia: Array

    __repr__ = short_repr


@overload
def contact_parameters(
    k: float, c: float, *, timestep: float, inverse_weight: float, newmark_beta: float = 0.25
) -> ContactParameters: ...


@overload
def contact_parameters(
    k: Array, c: Array | float, *, timestep: Array | float, inverse_weight: Array | float, newmark_beta: float = 0.25
) -> ManyContactParameters: ...


def contact_parameters(
    k: Numbers, c: Numbers, *, timestep: Numbers, inverse_weight: Numbers, newmark_beta: float = 0.25
) -> ContactParameters | ManyContactParameters:
    """MuJoCo's parameters for a unilateral spring and dashpot, integrated as Newmark's method does.

    Arrays give arrays: stiffness that differs from environment to environment, or the contacts of another engine that
    hands N/m and N s/m to MuJoCo. They have shapes that NumPy broadcasts.

    Args:
        k: stiffness [N/m], positive.
        c: damping [N s/m], not negative.
        timestep: step h of MuJoCo's Euler integrator [s], positive.
        inverse_weight: W [1/kg], positive: 2/(3 m) for the planar wall (two slides and a hinge), 1/m for a free body.
        newmark_beta: beta [-], not negative.

    Raises:
        ValueError: for a value outside its range, or one that needs an impedance which MuJoCo would silently clamp.
    """
    arguments = {"stiffness k": k, "damping c": c, "timestep": timestep, "inverse_weight": inverse_weight}
    if any(isinstance(value, list | tuple) or np.ndim(value) > 0 for value in arguments.values() if is_iterable(value)):
        return _many_parameters(arguments, newmark_beta)
    k = require_within("stiffness k", k, 1e-30, 1e30, "N/m")
    c = require_within("damping c", c, 0.0, 1e30, "N s/m")
    timestep = require_within("timestep", timestep, 1e-12, 1e3, "s")
    inverse_weight = require_within("inverse_weight", inverse_weight, 1e-30, 1e30, "1/kg")
    newmark_beta = require_within("newmark_beta", newmark_beta, 0.0, 1e6)
    inertia = newmark_inertia(k, c, timestep, newmark_beta)
    stiffness, damping, d = pair_values(k, c, inertia, inverse_weight)
    low, high = IMPEDANCE_RANGE
    if not low <= d <= high:
        remedy = "raise the timestep or newmark_beta" if d < low else "lower the timestep"
        raise ValueError(
            f"impedance d = {d:.6g} for k = {k:g} N/m, c = {c:g} N s/m, timestep = {timestep:g} s is outside the valid "
            f"range {low:g} to {high:g}, where MuJoCo would clamp it and change the stiffness; {remedy}"
        )
    return ContactParameters(solref=(stiffness, damping), solimp=(d, d, 0.001, 0.5, 2.0), inertia=inertia)


def _many_parameters(arguments: dict[str, Numbers], newmark_beta: float) -> ManyContactParameters:
    """The parameters of arrays of contacts, one by one."""
    arrays = [require_reals(name, value, "numbers or arrays of numbers") for name, value in arguments.items()]
    try:
        together = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in zip(arguments, arrays, strict=True))
        raise ValueError(f"the shapes of {shapes} do not go together") from None
    solref, solimp = np.empty((*together[0].shape, 2)), np.empty((*together[0].shape, 5))
    inertia = np.empty(together[0].shape)
    for i in np.ndindex(inertia.shape):
        k, c, h, weight = (float(array[i]) for array in together)
        parameters = contact_parameters(k, c, timestep=h, inverse_weight=weight, newmark_beta=newmark_beta)
        solref[i], solimp[i], inertia[i] = parameters.solref, parameters.solimp, parameters.inertia
    return ManyContactParameters(solref, solimp, inertia)


def contact_stiffness(
    solref: tuple[float, ...], solimp: tuple[float, ...], *, inverse_weight: float
) -> tuple[float, float]:
    """The spring k [N/m] and dashpot c [N s/m] of a contact in MuJoCo's direct format; inverts `contact_parameters`.

    Raises:
        ValueError: if solref is not in the direct (negative) format, or the impedance is not constant or is one that
            MuJoCo would clamp, or the weight is not positive.
    """
    for name, numbers in (("solref", solref), ("solimp", solimp)):
        if not isinstance(numbers, tuple | list | np.ndarray) or len(require_row(name, numbers, "number")) < 2:
            raise TypeError(f"{name} = {shown(numbers)} has to be at least two numbers")
    direct, impedances = (np.asarray(numbers, dtype=float).tolist() for numbers in (solref, solimp))
    inverse_weight = require_within("inverse_weight", inverse_weight, 1e-30, 1e30, "1/kg")
    d, d_width = impedances[:2]
    low, high = IMPEDANCE_RANGE
    if not (direct[0] < 0 and direct[1] <= 0):
        raise ValueError(f"solref = {tuple(solref)} is not in the direct format (-stiffness, -damping)")
    if d != d_width or not low <= d <= high:
        raise ValueError(f"solimp = {tuple(solimp)} is not a constant impedance in the valid range {low:g} to {high:g}")
    scale = (1 - d) * inverse_weight
    return -direct[0] / scale, -direct[1] / scale
