"""What a contact of two geoms takes from its explicit pair or, without one, from its geoms."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from .geoms import GeomPair


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
