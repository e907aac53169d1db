"""A contact in N/m and N s/m for anyone's MuJoCo model: `contact_for`, and what it writes into the model."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import mujoco
import numpy as np

from ..problem.quantities import require_real, require_whole, require_within, shown
from ..problem.rebound import rebound_damping, rebound_restitution
from .contact import WITHIN, inertia_of, longest_step, pair_values, row
from .geompair import GeomPair, Mixed, compiled
from .scene import HELD_MASSES
from .spoilers import missing, spoilers

LEAST_RESTITUTION = 1e-3
"""The smallest coefficient of restitution that a contact is given [-]. e = 0 is the limit of an infinite dashpot."""
FRICTION = (1.0, 1.0, 0.005, 1e-4, 1e-4)
"""MuJoCo's own coefficients: two sliding, torsional [m], two rolling [m]."""


@dataclass(frozen=True)
class PairContact:
    """A spring and dashpot between two geoms that never pull, and the numbers with which MuJoCo has them.

    Args:
        geom1, geom2: names of the geoms; an empty name is a geom without one.
        ids: the numbers of the geoms.
        k, c: spring [N/m] and dashpot [N s/m] of each contact point.
        mass: effective mass that each contact point stops [kg].
        inverse_weight: W of the pair [1/kg], the sum of `body_invweight0` of both bodies.
        timestep, integrator: step [s] and integrator of MuJoCo for which the numbers hold.
        contacts: contact points that share the mass, or None where it was not said.
        solref, solimp, solreffriction, friction, condim: what the `<pair>` carries.
        impratio: smallest impratio of the model with which the friction holds [-]; 1 without friction.
    """

    geom1: str
    geom2: str
    ids: tuple[int, int]
    k: float
    c: float
    mass: float
    inverse_weight: float
    timestep: float
    integrator: str
    contacts: int | None
    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]
    solreffriction: tuple[float, float]
    friction: tuple[float, float, float, float, float]
    condim: int
    impratio: float

    @property
    def frequency(self) -> float:
        """Circular frequency omega of the mass on the spring [rad/s]."""
        return math.sqrt(self.k / self.mass)

    @property
    def xi(self) -> float:
        """Damping ratio [-]."""
        return self.c / (2 * math.sqrt(self.k * self.mass))

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of an approach along the normal, see `rebound_restitution` [-]."""
        return rebound_restitution(self.xi)

    @property
    def xml(self) -> str:
        """The elements to put into `<mujoco>`: the options that the contact needs, and the explicit pair.

        Raises:
            ValueError: if one of the geoms has no name.
        """
        self._require_names()
        options = [f"timestep={_text(self.timestep)}"]
        numbers = {"solref": self.solref, "solimp": self.solimp}
        if self.condim > 1:
            options += ['cone="elliptic"', f"impratio={_text(self.impratio)}"]
            numbers |= {"solreffriction": self.solreffriction, "friction": self.friction}
        attributes = " ".join(f"{name}={_text(*values)}" for name, values in numbers.items())
        return (
            f"<option {' '.join(options)}/>\n<contact>\n"
            f"  <pair geom1={quoteattr(self.geom1)} geom2={quoteattr(self.geom2)}"
            f' condim="{self.condim}" {attributes}/>\n</contact>\n'
        )

    def apply(self, model: mujoco.MjModel | mujoco.MjSpec) -> None:
        """Write the contact into a model, with the options that it needs.

        A compiled model has to have an explicit `<pair>` of the two geoms, which takes the numbers. A specification
        that has none is given one. The time step is set, and for a contact with friction the elliptic cone and
        impratio, which keeps its value if that is larger.

        Args:
            model: the model for which the contact was made, or another with the same geoms and bodies. It is changed.

        Raises:
            ValueError: if a compiled model has no such pair, a geom has no name where a name is needed, or the bodies
                have another inverse weight.
        """
        found = self._found(compiled(model))
        if isinstance(model, mujoco.MjSpec):
            self._require_names()
            target = next((pair for pair in model.pairs if {pair.geomname1, pair.geomname2} == {*found.names}), None)
            pair = target if target is not None else model.add_pair(geomname1=self.geom1, geomname2=self.geom2)
            pair.condim = self.condim
            pair.solref, pair.solimp, pair.solreffriction = self.solref, self.solimp, self.solreffriction
            pair.friction = self.friction
            option = model.option
        else:
            i = found.explicit
            if i < 0:
                raise ValueError(
                    f"model has no explicit <pair> of {self.geom1 or self.ids[0]!r} and {self.geom2 or self.ids[1]!r}; "
                    "apply the contact to its MjSpec before compiling, or put the text of .xml into the MJCF"
                )
            model.pair_dim[i] = self.condim
            model.pair_solref[i], model.pair_solimp[i] = self.solref, self.solimp
            model.pair_solreffriction[i], model.pair_friction[i] = self.solreffriction, self.friction
            option = model.opt
        option.timestep = self.timestep
        if self.condim > 1:
            option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
            option.impratio = max(float(option.impratio), self.impratio)

    def caveats(self, model: mujoco.MjModel | mujoco.MjSpec) -> tuple[str, ...]:
        """What in a model keeps the contact from being what it says, one sentence each; empty if nothing does.

        Args:
            model: the model in which the contact is, from `apply` or from the text of `xml`.

        Raises:
            ValueError: if the geoms are not in the model, or the bodies have another inverse weight.
        """
        pair = self._found(compiled(model))
        return (*missing(pair, self), *spoilers(pair, self))

    def _found(self, model: mujoco.MjModel) -> GeomPair:
        """The pair in a model, which has to be the same two bodies."""
        pair = GeomPair.named(model, self.geom1 or self.ids[0], self.geom2 or self.ids[1])
        if not math.isclose(pair.inverse_weight, self.inverse_weight, rel_tol=1e-9):
            raise ValueError(
                f"model has the inverse weight {pair.inverse_weight:.9g} 1/kg for these geoms, and the contact was "
                f"made for {self.inverse_weight:.9g} 1/kg; make the contact for this model"
            )
        return pair

    def _require_names(self) -> None:
        if not (self.geom1 and self.geom2):
            raise ValueError(f"geom1 or geom2 (numbers {self.ids}) has no name, which an explicit <pair> needs")


def contact_for(
    model: mujoco.MjModel | mujoco.MjSpec,
    geom1: str | int,
    geom2: str | int,
    *,
    k: float,
    c: float | None = None,
    restitution: float | None = None,
    xi: float | None = None,
    friction: float | None = None,
    mass: float | None = None,
    contacts: int | None = None,
    timestep: float | None = None,
    newmark_beta: float = 0.25,
) -> PairContact:
    """A contact of two geoms with a stiffness in N/m and a restitution, a damping ratio or a dashpot.

    The contact is a spring and dashpot that never pull: f = max(0, k x + c v) at each contact point. The loss is given
    once, as `restitution`, `xi` or `c`. The first two refer to an effective mass. By default it is that of an approach
    of the two centres of mass along the normal, 1 / (1/m1 + 1/m2) for two free bodies, with the joints as they are at
    `qpos0`, shared equally by the `contacts`. It does not hold for a blow off the centre, such as on one corner of a
    box: give the `mass` that is felt there.

    Args:
        model: a compiled model or a specification; it is not changed. See `PairContact.apply`.
        geom1, geom2: names or numbers of the geoms. The name of a body stands for its geom, if it has just one.
        k: stiffness of each contact point [N/m], positive.
        c: dashpot of each contact point [N s/m], not negative.
        restitution: e of an approach along the normal, within [0, 1] [-]. e below 0.001 is taken as 0.001, because an
            infinite dashpot would be needed for 0.
        xi: damping ratio c / (2 sqrt(k m)) [-], not negative.
        friction: coefficient of sliding friction [-]; 0 makes the contact frictionless. None keeps what the model has.
        mass: effective mass of the whole contact [kg], positive. None takes it from the model.
        contacts: contact points that share the mass, 1 to 50: 4 for a box that lands flat on a plane. None is 1.
        timestep: MuJoCo's step [s], positive. None takes the model's.
        newmark_beta: Newmark's beta of the contact row [-], not negative; 1/4 is stable at every step.

    Returns:
        The contact, with `.solref .solimp .solreffriction .friction .xml` and `.apply(model)`.

    Raises:
        TypeError, ValueError: for a value outside its range, geoms that the model does not have or that cannot meet,
            and stiffness or damping that MuJoCo cannot represent at this step.

    Warns:
        UserWarning: of what in the model spoils the contact and is not mended by `apply`, and of a long step.
    """
    made = compiled(model)
    pair = GeomPair.named(made, geom1, geom2)
    k = require_within("stiffness k", k, 1e-30, 1e30, "N/m")
    h = require_within("timestep", made.opt.timestep if timestep is None else timestep, 1e-12, 1e3, "s")
    beta = require_within("newmark_beta", newmark_beta, 0.0, 1e6)
    points = 1 if contacts is None else require_whole("contacts", contacts, 1, mujoco.mjMAXCONPAIR)
    share = _mass(pair, mass) / points
    c = _dashpot(k, share, c, restitution, xi)
    explicit_euler = made.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4
    inertia = _inertia(k, c, h, pair.inverse_weight, beta if explicit_euler else None)
    stiffness, damping, d = pair_values(k, c, inertia, pair.inverse_weight)
    coefficients, condim = _friction(pair, friction)
    contact = PairContact(
        *pair.names,
        ids=pair.geoms,
        k=k,
        c=c,
        mass=share,
        inverse_weight=pair.inverse_weight,
        timestep=h,
        integrator=mujoco.mjtIntegrator(made.opt.integrator).name.removeprefix("mjINT_"),
        contacts=contacts if contacts is None else points,
        solref=(stiffness, damping),
        solimp=(d, d, 0.001, 0.5, 2.0),
        solreffriction=(-1e-30, -d / h) if condim > 1 else (0.0, 0.0),
        friction=coefficients,
        condim=condim,
        impratio=max(1.0, HELD_MASSES * share / inertia) if condim > 1 else 1.0,
    )
    for sentence in spoilers(pair, contact):
        warnings.warn(sentence, stacklevel=2)
    return contact


def _mass(pair: GeomPair, mass: float | None) -> float:
    """The effective mass of the whole contact [kg]."""
    if mass is not None:
        return require_within("mass", mass, 1e-30, 1e30, "kg")
    found = pair.mass()
    if not found < np.inf:
        raise ValueError(
            f"geom1 and geom2 = {pair.names} cannot approach each other along their normal at qpos0, so that the model "
            "gives no mass for the restitution; give mass"
        )
    return found


def _dashpot(k: float, mass: float, c: float | None, restitution: float | None, xi: float | None) -> float:
    """The dashpot of a contact point [N s/m], from the one of the three that is given."""
    given = {name: value for name, value in (("c", c), ("restitution", restitution), ("xi", xi)) if value is not None}
    if len(given) != 1:
        raise ValueError(f"exactly one of c, restitution and xi has to be given; given are {given or 'none'}")
    if c is not None:
        return require_within("damping c", c, 0.0, 1e30, "N s/m")
    if restitution is not None:
        e = require_within("restitution", restitution, 0.0, 1.0)
        ratio = rebound_damping(max(e, LEAST_RESTITUTION))
    else:
        ratio = require_within("damping ratio xi", xi, 0.0, 1e6)
    return 2 * ratio * math.sqrt(k * mass)


def _inertia(k: float, c: float, h: float, inverse_weight: float, newmark_beta: float | None) -> float:
    """Inertia of the contact row [kg]: Newmark's in steps of Euler's method, the least that there is without beta."""
    if h > longest_step(k, inverse_weight):
        raise ValueError(
            f"stiffness k = {k:g} N/m at timestep = {h:g} s is beyond what MuJoCo represents; "
            f"the longest step is {longest_step(k, inverse_weight):.3g} s"
        )
    dashpot, inertia = row(k, c, h, inverse_weight, newmark_beta or 0.0, 0.0)
    if dashpot < c:
        raise ValueError(
            f"damping c = {c:g} N s/m at timestep = {h:g} s is beyond what MuJoCo represents, {dashpot:.3g} N s/m; "
            "lower the timestep"
        )
    if inertia > inertia_of(WITHIN[1], inverse_weight):
        raise ValueError(f"newmark_beta = {newmark_beta:g} asks for more inertia than MuJoCo represents; lower it")
    return inertia_of(WITHIN[0], inverse_weight) if newmark_beta is None else inertia


def _friction(pair: GeomPair, friction: float | None) -> tuple[tuple[float, float, float, float, float], int]:
    """The five coefficients of friction, and condim."""
    if friction is None:
        mixed = Mixed.of(pair)
        first, second, torsional, rolling, last = mixed.friction
        return (first, second, torsional, rolling, last), mixed.condim
    if not require_real("friction", friction) >= 0 or friction > 1e6:
        raise ValueError(f"friction = {shown(friction)} is outside the valid range 0 to 1e+06")
    sliding = float(friction)
    return (sliding, sliding, *FRICTION[2:]), 3 if sliding > 0 else 1


def _text(*values: float) -> str:
    return f'"{" ".join(repr(float(value)) for value in values)}"'
