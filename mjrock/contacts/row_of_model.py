"""The row that MuJoCo makes of a contact of a model, in N/m and N s/m.

A contact takes its parameters from its explicit pair or, without one, from its geoms. MuJoCo's two formats of solref
become the spring K and dashpot B of a row. With the impedance d at zero penetration and W of the two bodies,

    k = K d^2 / ((1 - d) W),    c = B d / ((1 - d) W),    m_i = d / ((1 - d) W).

In the direct format K = stiffness / dw^2 and B = damping / dw, otherwise K = 1 / (dw timeconst dampratio)^2 and
B = 2 / (dw timeconst), where dw is the impedance at the full width. With friction and the pyramidal cone all three
change by the factor of `PairParameters.pyramid`. An Euler step of length h uses up h c / 2 of the inertia m_i (see
`solref`). The rest moves with the mass in a contact.

Under a load at rest the row is a spring of the stiffness K d^2 / ((1 - d) W), with d at the indentation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np

from .checks import Array, is_iterable, listed, require_within, shown
from .geoms import GeomPair
from .solref import IMPEDANCE_RANGE
from .versions import GAP_IS_BEYOND, MARGINS_ADD_UP, field

HOLDING_RATE = 1e7
"""Rate with which friction holds [1/s]: a load F creeps at F / (HOLDING_RATE m), a body on a slope at less than
1e-6 m/s."""


@dataclass(frozen=True)
class PairParameters:
    """The parameters of a contact, those of its explicit pair or, without one, of its two geoms.

    Args:
        solref, solimp: MuJoCo's parameters of the normal row.
        solreffriction: the same of the friction rows; zeros stand for solref.
        friction: two sliding, one torsional, two rolling coefficients [-].
        condim: 1 without friction, 3 with sliding, 4 with torsional, 6 with rolling friction.
        margin: distance at which the contact starts to act [m].
        gap: distance from there on up to which it pulls [m].
        adhesion: its tensile force [N].
    """

    solref: tuple[float, ...]
    solimp: tuple[float, ...]
    solreffriction: tuple[float, ...]
    friction: tuple[float, float, float, float, float]
    condim: int
    margin: float
    gap: float
    adhesion: float

    @classmethod
    def from_pair(cls, pair: GeomPair) -> PairParameters:
        """The parameters of a pair of geoms, by the rules of MuJoCo's manual (Modeling, Contact parameters).

        The geom of higher priority decides. At equal priority solref and solimp are averaged with the weights solmix,
        solref is the element-wise minimum if one of the two is not positive, friction and condim are the larger ones.
        Margins and gaps add up, and adhesion at equal priority.
        """
        model, i = pair.model, pair.explicit
        if i >= 0:
            return cls(
                tuple(model.pair_solref[i].tolist()),
                tuple(model.pair_solimp[i].tolist()),
                tuple(model.pair_solreffriction[i].tolist()),
                tuple(model.pair_friction[i].tolist()),
                int(model.pair_dim[i]),
                *_reach(model.pair_margin[i], model.pair_gap[i]),
                float(field(model, "pair_adhesion", model.npair)[i]),
            )
        return cls.of_sides(model, [("geom", geom) for geom in pair.geoms])

    @classmethod
    def of_sides(cls, model: mujoco.MjModel, sides: Sequence[tuple[str, int]]) -> PairParameters:
        """The parameters of two sides without an explicit pair, each a geom or a flex with its number."""

        def values(name: str) -> Array:
            return np.array([getattr(model, f"{kind}_{name}")[number] for kind, number in sides])

        priority = values("priority")
        deciding = priority == priority.max()
        if priority[0] != priority[1]:
            weight = deciding.astype(float)
        else:
            solmix = values("solmix")
            tiny = solmix < mujoco.mjMINVAL
            weight = np.where(tiny.all(), 0.5, np.where(tiny.any(), ~tiny, solmix / max(solmix.sum(), mujoco.mjMINVAL)))
        solref, averaged = values("solref")[deciding], weight @ values("solref")
        sliding, torsional, rolling = values("friction")[deciding].max(axis=0).tolist()
        pulls = field(model, "geom_adhesion", model.ngeom)
        pulling = [pulls[number] for kind, number in np.array(sides, dtype=object)[deciding] if kind == "geom"]
        together = np.sum if MARGINS_ADD_UP else np.max
        return cls(
            tuple((averaged if (solref[:, 0] > 0).all() else solref.min(axis=0)).tolist()),
            tuple((weight @ values("solimp")).tolist()),
            (0.0, 0.0),
            (sliding, sliding, torsional, rolling, rolling),
            int(values("condim")[deciding].max()),
            *_reach(together(values("margin")), together(values("gap"))),
            float(sum(pulling)),
        )

    def write(self, model: mujoco.MjModel, pair: int) -> None:
        """Write the numbers into an explicit pair of a compiled model, by its number."""
        for name, value in vars(self).items():
            if name in WRITTEN:
                getattr(model, "pair_dim" if name == "condim" else f"pair_{name}")[pair] = value

    def write_spec(self, pair: mujoco.MjsPair) -> None:
        """Write the numbers into an explicit pair of a specification."""
        for name, value in vars(self).items():
            if name in WRITTEN:
                setattr(pair, name, value)

    @property
    def sliding(self) -> float:
        """Coefficient of sliding friction, 0 without friction [-]."""
        return self.friction[0] if self.condim > 1 else 0.0

    def pyramid(self, impratio: float) -> float:
        """Factor of the pyramidal cone on stiffness, damping and inertia of an approach without sliding [-].

        Each friction dimension has two edges. All have the regularisation 2 mu^2 R / impratio of a row of the weight
        W (1 + mu^2), with mu the first coefficient, which MuJoCo takes as 1e-5 at least.
        """
        mu = max(self.friction[0], mujoco.mjMINMU)
        return (self.condim - 1) * impratio / (mu**2 * (1 + mu**2))


WRITTEN = tuple(name for name in PairParameters.__annotations__ if hasattr(mujoco.MjsPair, name))
"""Attributes of an explicit pair that MuJoCo has."""


def _reach(margin: float, gap: float) -> tuple[float, float]:
    """The distance from which a contact acts, and that from there on up to which it pulls [m]."""
    return (float(margin), float(gap)) if GAP_IS_BEYOND else (float(margin - gap), 0.0)


class FrictionParameters(NamedTuple):
    """Friction of a `PairContact`, with the parameters of its rows, see there."""

    friction: tuple[float, float, float, float, float]
    condim: int
    solreffriction: tuple[float, float] = (0.0, 0.0)
    impratio: float = 1.0

    @classmethod
    def from_pair(cls, pair: GeomPair, friction: object = None) -> FrictionParameters:
        """Friction of the model, in which one coefficient replaces the two of sliding, and five replace all.

        A contact without friction gets condim 3, and one whose sliding friction is zero gets condim 1.
        """
        mixed = PairParameters.from_pair(pair)
        if friction is None:
            return cls(mixed.friction, mixed.condim)
        sliding_alone = [friction, friction, *mixed.friction[2:]]
        numbers = listed("friction", friction) if is_iterable(friction) else sliding_alone
        if len(numbers) != 5:
            raise ValueError(
                f"friction = {shown(friction)} has {len(numbers)} numbers; one of sliding is needed, or five: two of "
                "sliding, one of torsion, two of rolling"
            )
        first, second, torsion, *rolling = (require_within("friction", number, 0.0, 1e6) for number in numbers)
        condim = max(3, mixed.condim) if max(first, second) > 0 else 1
        return cls((first, second, torsion, rolling[0], rolling[1]), condim)

    @property
    def sliding(self) -> float:
        """Coefficient of sliding friction [-]."""
        return self.friction[0] if self.condim > 1 else 0.0

    def holding(self, rate: float, impedance: float, mass: float, inertia: float) -> FrictionParameters:
        """The same with the parameters that stop slip.

        Args:
            rate: at which slip stops [1/s], omega at most, see the page on contacts.
            impedance, inertia: of the normal row [-, kg].
            mass: of the contact point [kg].
        """
        if self.condim == 1:
            return self
        impratio = max(1.0, HOLDING_RATE / rate * mass / inertia)
        return self._replace(solreffriction=(-1e-30, -impedance * rate), impratio=impratio)


def unused(friction: object, parameters: FrictionParameters) -> Iterator[str]:
    """A sentence on torsional and rolling friction of the request that the condim of the model leaves out."""
    if is_iterable(friction) and any(parameters.friction[max(2, parameters.condim - 1) :]):
        yield (
            f"friction = {tuple(f'{mu:g}' for mu in parameters.friction)} has torsional or rolling friction that "
            f"condim {parameters.condim} leaves out; give the geoms condim 4 for torsional, 6 for both"
        )


class ModelRow:
    """The row of a contact of a model, from the inverse weight W of its sides [1/kg] and its parameters.

    Attributes:
        mixed: the parameters.
        k, c: spring [N/m] and dashpot [N s/m] at zero penetration.
        inertia: inertia that the row adds, beyond what the Euler step takes [kg].
        impedance: d at zero penetration [-].
        constant: whether d is the same at every penetration.
        spring, dashpot, slip_dashpot: K [1/s2] and B [1/s], and B of the rows of friction.
        scale: what 1 / W is multiplied by for the cone, over W [kg].
        solimp: impedances at zero and full width [-], width [m], midpoint and power [-].
        impratio: of the model [-].
        elliptic: whether the model has the elliptic cone.
    """

    def __init__(self, model: mujoco.MjModel, inverse_weight: float, mixed: PairParameters) -> None:
        option = model.opt
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
        slip = mixed.solreffriction if any(mixed.solreffriction) else solref
        self.slip_dashpot = _reference(float(slip[0]), float(slip[1]), full, h, safe)[1]
        self.mixed, self.impratio, self.impedance = mixed, float(option.impratio), d
        self.elliptic = option.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        cone = mixed.pyramid(self.impratio) if mixed.condim > 1 and not self.elliptic else 1.0
        self.spring, self.dashpot, self.scale = spring, dashpot, cone / inverse_weight
        moved = self.scale * d / (1 - d)
        self.k, self.c = moved * d * spring, moved * dashpot
        staged = option.integrator == mujoco.mjtIntegrator.mjINT_RK4
        self.inertia = moved if staged else max(0.0, moved - 0.5 * h * self.c)
        self.solimp = d, full, *(float(value) for value in solimp[2:5])

    @classmethod
    def from_pair(cls, pair: GeomPair) -> ModelRow:
        """The row of two geoms."""
        return cls(pair.model, pair.inverse_weight, PairParameters.from_pair(pair))

    def loaded(self, load: float) -> float:
        """The load [N] over the indentation at which the row carries it [N/m]; 0 without a spring."""
        if self.constant or self.spring == 0:
            return self.k
        low, high = 0.0, max(load / (self._stiffness(0.0)), load / self._stiffness(self.solimp[2]))
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if middle * self._stiffness(middle) < load else (low, middle)
        return self._stiffness(0.5 * (low + high))

    def creep(self, force: float, indentation: float) -> float:
        """Speed at which a contact point slips under a force that friction holds [m/s]; NaN for the pyramidal cone, or
        without friction."""
        if not self.elliptic or self.mixed.condim == 1:
            return math.nan
        d = self._impedance(indentation)
        return force * (1 - d) / (d * self.scale * self.impratio * self.slip_dashpot)

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
        """Notes on the row, one sentence each."""
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
