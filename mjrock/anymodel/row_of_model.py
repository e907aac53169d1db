"""The row that MuJoCo makes of a contact of a model, in N/m and N s/m.

MuJoCo's two formats of solref become the spring K and dashpot B of a row. With the impedance d at zero penetration and
W of the two bodies,

    k = K d^2 / ((1 - d) W),    c = B d / ((1 - d) W),    m_i = d / ((1 - d) W).

In the direct format K = stiffness / dw^2 and B = damping / dw, otherwise K = 1 / (dw timeconst dampratio)^2 and
B = 2 / (dw timeconst), where dw is the impedance at the full width. With friction and the pyramidal cone all three
change by the factor of `Mixed.pyramid`. An Euler step of length h uses up h c / 2 of the inertia m_i (see `contact`).
What is left moves with the mass in a contact.

Under a load at rest the row is a spring of the stiffness K d^2 / ((1 - d) W), with d at the indentation.
"""

from __future__ import annotations

from collections.abc import Iterator

import mujoco
import numpy as np

from ..engine.solref import IMPEDANCE_RANGE
from .geoms import GeomPair
from .mixing import Mixed


class ModelRow:
    """The row of a contact of two geoms of a model.

    Attributes:
        mixed: what the contact takes from its pair or its geoms.
        k, c: spring [N/m] and dashpot [N s/m] at zero penetration.
        inertia: inertia that the row adds, beyond what the Euler step takes [kg].
        impedance: d at zero penetration [-].
        constant: whether d is the same at every penetration.
        spring, dashpot: K [1/s2] and B [1/s].
        scale: what 1 / W is multiplied by for the cone, over W [kg].
        solimp: impedances at zero and full width [-], width [m], midpoint and power [-].
        impratio: of the model [-].
        elliptic: whether the model has the elliptic cone.
    """

    def __init__(self, pair: GeomPair, mixed: Mixed | None = None) -> None:
        mixed, option = mixed or Mixed.of(pair), pair.model.opt
        if option.enableflags & int(mujoco.mjtEnableBit.mjENBL_OVERRIDE):
            solref, solimp = option.o_solref, option.o_solimp
        else:
            solref, solimp = mixed.solref, mixed.solimp
        h = float(option.timestep)
        d, full = (float(np.clip(value, *IMPEDANCE_RANGE)) for value in solimp[:2])
        self.constant = d == full or solimp[2] <= mujoco.mjMINVAL
        if self.constant:
            d = 0.5 * (d + full)
        safe = not option.disableflags & int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)  # time constants above two steps
        spring, dashpot = _reference(float(solref[0]), float(solref[1]), full, h, safe)
        self.mixed, self.impratio, self.impedance = mixed, float(option.impratio), d
        self.elliptic = option.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        cone = mixed.pyramid(self.impratio) if mixed.condim > 1 and not self.elliptic else 1.0
        self.spring, self.dashpot, self.scale = spring, dashpot, cone / pair.inverse_weight
        moved = self.scale * d / (1 - d)
        self.k, self.c = moved * d * spring, moved * dashpot
        staged = option.integrator == mujoco.mjtIntegrator.mjINT_RK4
        self.inertia = moved if staged else max(0.0, moved - 0.5 * h * self.c)
        self.solimp = d, full, *(float(value) for value in solimp[2:5])

    def loaded(self, load: float) -> float:
        """The load [N] over the indentation at which the row carries it [N/m]; 0 without a spring."""
        if self.constant or self.spring == 0:
            return self.k
        low, high = 0.0, max(load / (self._stiffness(0.0)), load / self._stiffness(self.solimp[2]))
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if middle * self._stiffness(middle) < load else (low, middle)
        return self._stiffness(0.5 * (low + high))

    def _stiffness(self, indentation: float) -> float:
        d = self._impedance(indentation)
        return self.spring * self.scale * d * d / (1 - d)

    def _impedance(self, indentation: float) -> float:
        """MuJoCo's impedance at an indentation [-]; see its manual, Modeling, Solver parameters."""
        near, full, width, midpoint, power = self.solimp
        x = min(max(indentation / width, 0.0), 1.0)
        midpoint = min(max(midpoint, IMPEDANCE_RANGE[0]), IMPEDANCE_RANGE[1])
        power = max(power, 1.0)
        if x in (0.0, 1.0) or power == 1:
            y = x
        elif x <= midpoint:
            y = x**power / midpoint ** (power - 1)
        else:
            y = 1 - (1 - x) ** power / (1 - midpoint) ** (power - 1)
        return near + y * (full - near)

    def notes(self) -> Iterator[str]:
        """What else is to be known of the row, one sentence each."""
        mixed = self.mixed
        if not self.constant:
            yield "the impedance grows with penetration, and stiffness and damping with it"
        if mixed.condim > 1 and not self.elliptic:
            yield "the cone is pyramidal: k and c hold for a head-on approach"
        elif mixed.condim > 1 and max(mixed.friction[:2]) ** 2 > 0.02 * self.impratio:
            yield f"impratio = {self.impratio:g} is small: sliding changes the normal force"
        if mixed.margin != 0:
            yield f"it begins at a distance of {mixed.margin:g} m"
        if mixed.adhesion != 0:
            yield f"it pulls with up to {mixed.adhesion:g} N"


def _reference(first: float, second: float, full: float, h: float, safe: bool) -> tuple[float, float]:
    """K [1/s2] and B [1/s] of a row, with the impedance `full` at the full width."""
    if (first > 0) != (second > 0):
        first, second = 0.02, 1.0  # MuJoCo takes its default in place of a mixture of the two formats
    if first <= 0:
        return -first / full**2, -second / full
    timeconst = max(first, 2 * h) if safe else first
    return 1 / max(mujoco.mjMINVAL, (full * timeconst * second) ** 2), 2 / max(mujoco.mjMINVAL, full * timeconst)
