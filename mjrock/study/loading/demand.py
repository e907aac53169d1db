"""The demand of a check: the displacement and the acceleration of a record or a spectrum, for each limit state."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from ...problem.ground.motion import GroundMotion
from ...problem.ground.oscillator import SHORTEST_PERIOD
from ...problem.ground.spectrum import SpectrumOfCode, response_spectrum
from ...quantities import require_real, require_within, shown, takes
from .code import USUAL_CODE, Code, code_of

PERIODS_OF_RECORD = 60
"""Number of periods up to the equivalent period at which the spectrum of a record is computed."""
SHORTEST_OF_RECORD = 0.05
"""Shortest period at which the spectrum of a record is computed where T_0 is not known [s]."""
Demand = GroundMotion | SpectrumOfCode | Callable[[float, float], float]
"""A record, the spectrum of a code on the ground or on a floor, or an elastic displacement spectrum S_De(T, xi) [m]."""


def required_demands(demand: Demand | Mapping[str, Demand], code: Code | str = USUAL_CODE) -> Mapping[str, Demand]:
    """The demand of each limit state of a code.

    Raises:
        TypeError: for a demand that is neither a record nor a function.
        ValueError: for a mapping with other limit states than those of the code.
    """
    code = code_of(code)
    demands = demand if isinstance(demand, Mapping) else dict.fromkeys(code.states, demand)
    beside = set() if code.damage is None else {code.damage.state}
    if set(demands) - beside != set(code.states) - beside:
        needed = " and ".join(code.states)
        raise ValueError(f"demand has {', '.join(map(str, demands)) or 'none'}; a mapping needs {needed}")
    for name, state_demand in demands.items():
        if not isinstance(state_demand, GroundMotion) and not takes(state_demand, 2):
            place = f"demand[{name!r}]" if demands is demand else "demand"
            raise TypeError(f"{place} = {shown(state_demand)} is neither a GroundMotion nor a function S_De(T, xi)")
    return demands


def starting_acceleration(demand: Demand, T_0: float | None, code: Code) -> float | None:
    """The acceleration of a demand with which the start of a mechanism is compared [m/s2].

    It is the peak of the demand, or for an element that vibrates freely with the period T_0 [s] the spectral
    acceleration at T_0. None where the peak is not known.
    """
    if T_0 is None or code.damage is None:
        return demand.peak if isinstance(demand, GroundMotion | SpectrumOfCode) else None
    if isinstance(demand, SpectrumOfCode):
        return float(demand(T_0, code.damage.damping))
    return (2 * math.pi / T_0) ** 2 * demanded_displacement(demand, T_0, code.damage.damping, T_0)


def demanded_displacement(demand: Demand, period: float, damping: float, T_0: float | None) -> float:
    """The spectral displacement of a demand at a period [m]; of a record the largest one from T_0 up to the period."""
    if isinstance(demand, GroundMotion):
        shortest = SHORTEST_OF_RECORD if T_0 is None else T_0
        periods = np.geomspace(
            max(min(shortest, period), SHORTEST_PERIOD), max(period, SHORTEST_PERIOD), PERIODS_OF_RECORD
        )
        return float(response_spectrum(demand, periods, damping).Sd.max())
    if isinstance(demand, SpectrumOfCode):
        return float(demand.displacement(period, damping))
    try:
        displacement = require_real("demand(T, xi)", demand(period, damping))
    except (TypeError, ValueError) as error:
        raise type(error)(f"demand = {shown(demand)} gives no displacement for T, xi: {error}") from None
    return require_within("demand(T, xi)", displacement, 0.0, 1e3, "m")
