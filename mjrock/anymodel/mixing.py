"""What a contact of two geoms takes from its explicit pair or, without one, from its geoms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..quantities import is_iterable, require_within, shown
from .geoms import GeomPair

HOLD = 1e7
"""Rate with which friction holds [1/s]: a load F creeps at F / (HOLD m), a body on a slope at less than 1e-6 m/s."""


@dataclass(frozen=True)
class Mixed:
    """What a contact takes from its explicit pair or, without one, from its two geoms.

    Args:
        solref, solimp: MuJoCo's parameters of the normal row.
        solreffriction: the same of the friction rows; zeros stand for solref.
        friction: two sliding, one torsional, two rolling coefficients [-].
        condim: 1 without friction, 3 with sliding, 4 with torsional, 6 with rolling friction.
        margin, adhesion: distance at which the contact starts to act [m], and its tensile force [N].
    """

    solref: tuple[float, ...]
    solimp: tuple[float, ...]
    solreffriction: tuple[float, ...]
    friction: tuple[float, float, float, float, float]
    condim: int
    margin: float
    adhesion: float

    @classmethod
    def of(cls, pair: GeomPair) -> Mixed:
        """The parameters of a pair of geoms, by the rules of MuJoCo's manual (Modeling, Contact parameters).

        The geom of higher priority decides. At equal priority solref and solimp are averaged with the weights solmix,
        solref is the element-wise minimum if one of the two is not positive, friction and condim are the larger ones.
        Margins add up.
        """
        model, i = pair.model, pair.explicit
        if i >= 0:
            return cls(
                tuple(model.pair_solref[i].tolist()),
                tuple(model.pair_solimp[i].tolist()),
                tuple(model.pair_solreffriction[i].tolist()),
                tuple(model.pair_friction[i].tolist()),
                int(model.pair_dim[i]),
                float(model.pair_margin[i]),
                float(model.pair_adhesion[i]),
            )
        geoms = np.array(pair.geoms)
        priority = model.geom_priority[geoms]
        if priority[0] != priority[1]:
            weight = (priority > priority.min()).astype(float)
            deciding = geoms[weight == 1]
        else:
            solmix = model.geom_solmix[geoms]
            tiny = solmix < mujoco.mjMINVAL
            weight = np.where(tiny.all(), 0.5, np.where(tiny.any(), ~tiny, solmix / max(solmix.sum(), mujoco.mjMINVAL)))
            deciding = geoms
        solref = model.geom_solref[deciding]
        averaged = weight @ model.geom_solref[geoms]
        sliding, torsional, rolling = model.geom_friction[deciding].max(axis=0).tolist()
        return cls(
            tuple((averaged if (solref[:, 0] > 0).all() else solref.min(axis=0)).tolist()),
            tuple((weight @ model.geom_solimp[geoms]).tolist()),
            (0.0, 0.0),
            (sliding, sliding, torsional, rolling, rolling),
            int(model.geom_condim[deciding].max()),
            float(model.geom_margin[geoms].sum()),
            float(model.geom_adhesion[geoms].sum()),
        )

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


class Grip(NamedTuple):
    """What a `PairContact` has for friction."""

    friction: tuple[float, float, float, float, float]
    condim: int
    solreffriction: tuple[float, float] = (0.0, 0.0)
    impratio: float = 1.0

    @classmethod
    def of(cls, pair: GeomPair, friction: Any = None) -> Grip:
        """Friction of the model, in which one coefficient replaces the two of sliding, and five replace all.

        A contact without friction gets condim 3, and one whose sliding friction is zero gets condim 1.
        """
        mixed = Mixed.of(pair)
        if friction is None:
            return cls(mixed.friction, mixed.condim)
        numbers = list(friction) if is_iterable(friction) else [friction, friction, *mixed.friction[2:]]
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

    def holding(self, rate: float, impedance: float, mass: float, inertia: float) -> Grip:
        """The same with what stops slip: at a rate [1/s], omega at most, as the page on contacts says, for the mass of
        the contact point [kg] and impedance and inertia of its normal row [-, kg]."""
        if self.condim == 1:
            return self
        impratio = max(1.0, HOLD / rate * mass / inertia)
        return self._replace(solreffriction=(-1e-30, -impedance * rate), impratio=impratio)


def unused(given: object, grip: Grip) -> Iterator[str]:
    """Torsional and rolling friction that is given, and that the condim of the model leaves out."""
    if is_iterable(given) and any(grip.friction[max(2, grip.condim - 1) :]):
        yield (
            f"friction = {tuple(f'{mu:g}' for mu in grip.friction)} has torsional or rolling friction that condim "
            f"{grip.condim} leaves out; give the geoms condim 4 for torsional, 6 for both"
        )
