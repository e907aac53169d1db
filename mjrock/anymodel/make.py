"""`contact_for`: a stiffness in N/m and a restitution for two geoms of anyone's MuJoCo model."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from ..engine.contact import WITHIN, inertia_of, longest_step, pair_values, row
from ..method import METHOD
from ..problem.damping.rebound import rebound_damping
from ..quantities import Array, require_whole, require_within, shown, spelt
from .contact import PairContact
from .geoms import GeomPair, compiled
from .mixing import Mixed
from .notes import UNSOUND, resolving_step, rounded_down, spoilers

LEAST_RESTITUTION = 1e-3
"""The smallest coefficient of restitution that a contact is given [-]. e = 0 is the limit of an infinite dashpot."""
SPINNING = (0.005, 1e-4, 1e-4)
"""MuJoCo's own coefficients of torsional and rolling friction [m]."""
HOLD = 1e7
"""Rate with which friction holds [1/s]: a load F creeps at F / (HOLD m), a body on a slope at less than 1e-6 m/s."""


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
    at: Sequence[float] | Array | None = None,
    contacts: int | None = None,
    timestep: float | None = None,
    newmark_beta: float = 0.25,
) -> PairContact:
    """A contact of two geoms with a stiffness in N/m and a restitution, a damping ratio or a dashpot.

    The contact is a spring and dashpot that never pull: f = max(0, k x + c v) at each contact point. The loss is given
    once, as `restitution`, `xi` or `c`. The first two refer to an effective mass. By default it is that of an approach
    of the two centres of mass along the normal, 1 / (1/m1 + 1/m2) for two free bodies, with the joints as they are at
    `qpos0`, shared equally by the `contacts`. It does not hold for a blow off the centre, such as on one corner of a
    box: give that point as `at`, or the `mass` that is felt there.

    Args:
        model: a compiled model or a specification; it is not changed. See `PairContact.apply`.
        geom1, geom2: names or numbers of the geoms. The name of a body stands for its geom, if it has just one.
        k: stiffness of each contact point [N/m], positive. A box that is to have 1e5 N/m on four corners has k=2.5e4
            and contacts=4.
        c: dashpot of each contact point [N s/m], not negative.
        restitution: e of an approach along the normal, within [0, 1] [-]. e below 0.001 is taken as 0.001, because an
            infinite dashpot would be needed for 0.
        xi: damping ratio c / (2 sqrt(k m)) [-], not negative.
        friction: coefficient of sliding friction [-]; 0 makes the contact frictionless. None keeps what the model has.
        mass: effective mass of the whole contact [kg], positive. None takes it from the model.
        at: contact point that meets first, in the world's frame at `qpos0` [m], shape (3,). None takes the centres of
            mass. It is not given together with `mass`.
        contacts: contact points that share the mass, 1 to 50: 4 for a box that lands flat on a plane. None is 1.
        timestep: MuJoCo's step [s], positive. None takes the model's.
        newmark_beta: Newmark's beta of the contact row [-], not negative; 1/4 is average acceleration.

    Returns:
        The contact, with `.solref .solimp .solreffriction .friction .xml` and `.apply(model)`. The `.xml` of several
        contacts has an `<option>` each: keep the one with the largest impratio, and let no later `<option>` override
        it. An impratio of 1e6 to 1e9 is normal here.

    Raises:
        TypeError, ValueError: for a value outside its range, geoms that the model does not have or that cannot meet,
            and stiffness or damping that MuJoCo cannot represent at this step.

    Warns:
        UserWarning: of what in the model spoils the contact and is not mended by `apply`, and of a long step.
    """
    whole = compiled(model)
    pair = GeomPair.named(whole, geom1, geom2)
    k = require_within("stiffness k", k, 1e-30, 1e30, "N/m")
    h = require_within("timestep", whole.opt.timestep if timestep is None else timestep, 1e-12, 1e3, "s")
    beta = require_within("newmark_beta", newmark_beta, 0.0, 1e6)
    points = 1 if contacts is None else require_whole("contacts", contacts, 1, mujoco.mjMAXCONPAIR)
    share = _mass(pair, mass, at) / points
    c = _dashpot(k, share, c, restitution, xi)
    staged = whole.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
    dashpot, inertia = _row(k, c, share, h, pair.inverse_weight, beta, staged)
    stiffness, damping, d = pair_values(k, dashpot, inertia, pair.inverse_weight)
    grip = _grip(pair, friction, min(math.sqrt(k / share), 1 / h), d, share, inertia)
    contact = PairContact(
        *pair.names,
        ids=pair.geoms,
        k=k,
        c=c,
        mass=share,
        inverse_weight=pair.inverse_weight,
        timestep=h,
        integrator=mujoco.mjtIntegrator(whole.opt.integrator).name.removeprefix("mjINT_"),
        contacts=contacts if contacts is None else points,
        solref=(stiffness, damping),
        solimp=(d, d, 0.001, 0.5, 2.0),
        **grip._asdict(),
    )
    for sentence in spoilers(pair, contact):
        warnings.warn(sentence, stacklevel=2)
    return contact


def _mass(pair: GeomPair, mass: float | None, at: object) -> float:
    """The effective mass of the whole contact [kg]."""
    if mass is not None:
        if at is not None:
            raise ValueError(f"mass = {shown(mass)} and at = {shown(at)} are both given; give one of them")
        return require_within("mass", mass, 1e-30, 1e30, "kg")
    approached = pair.mass(at=at)
    if not approached < np.inf:
        raise ValueError(
            f"geom1 and geom2 = {pair.names} cannot approach each other along their normal at qpos0, so that the model "
            "gives no mass for the restitution; give mass"
        )
    return approached


def _dashpot(k: float, mass: float, c: float | None, restitution: float | None, xi: float | None) -> float:
    """The dashpot of a contact point [N s/m], from the one of the three that is given."""
    given = {name: value for name, value in (("c", c), ("restitution", restitution), ("xi", xi)) if value is not None}
    if len(given) != 1:
        listed = ", ".join(f"{name} = {spelt(value)}" for name, value in given.items()) or "none"
        raise ValueError(f"exactly one of c, restitution and xi has to be given; given are {listed}")
    if c is not None:
        return require_within("damping c", c, 0.0, 1e30, "N s/m")
    if restitution is not None:
        e = require_within("restitution", restitution, 0.0, 1.0)
        ratio = rebound_damping(max(e, LEAST_RESTITUTION))
    else:
        ratio = require_within("damping ratio xi", xi, 0.0, 1e6)
    return 2 * ratio * math.sqrt(k * mass)


def _row(
    k: float, c: float, mass: float, h: float, inverse_weight: float, newmark_beta: float, staged: bool
) -> tuple[float, float]:
    """Dashpot [N s/m] and inertia [kg] of the contact row.

    The inertia is Newmark's in steps of Euler's method, and the least that there is in the stages of RK4. A step that
    is longer than 1 / omega could throw a touch back with more energy than it came with. There the row has the extra
    dashpot h k and beta = 1/2 at least, with which e stays below 0.6 whatever the step.
    """
    longest = longest_step(k, inverse_weight)
    if h > longest:
        resolving = min(longest, resolving_step(k, c, mass))
        raise ValueError(
            f"stiffness k = {k:g} N/m at timestep = {h:g} s is beyond what MuJoCo represents; "
            f"the longest step is {rounded_down(longest, 3)} s, and {rounded_down(resolving)} s resolves the contact"
        )
    sound = h * math.sqrt(k / mass) <= UNSOUND
    beta, ringing = (newmark_beta, 0.0) if sound else (max(newmark_beta, 0.5), 1.0)
    dashpot, inertia = row(k, c, h, inverse_weight, beta, ringing, METHOD.overdamped)
    if dashpot < c:
        raise ValueError(
            f"damping c = {c:g} N s/m at timestep = {h:g} s is beyond what MuJoCo represents, {dashpot:.3g} N s/m; "
            "lower the timestep"
        )
    if inertia > inertia_of(WITHIN[1], inverse_weight):
        raise ValueError(f"newmark_beta = {newmark_beta:g} asks for more inertia than MuJoCo represents; lower it")
    return dashpot, inertia_of(WITHIN[0], inverse_weight) if staged and sound else inertia


class Grip(NamedTuple):
    """What a `PairContact` has for friction."""

    friction: tuple[float, float, float, float, float]
    condim: int
    solreffriction: tuple[float, float] = (0.0, 0.0)
    impratio: float = 1.0


def _grip(pair: GeomPair, friction: float | None, rate: float, impedance: float, mass: float, inertia: float) -> Grip:
    """Friction of the contact: that of the model, or the coefficient that is given.

    Args:
        pair: the geoms.
        friction: the coefficient [-], or None.
        rate: with which friction stops slip, omega at most [1/s]; see the page on contacts for why not sooner.
        impedance, inertia: of the normal row [-, kg].
        mass: of the contact point [kg].
    """
    if friction is None:
        mixed = Mixed.of(pair)
        first, second, torsional, rolling, last = mixed.friction
        grip = Grip((first, second, torsional, rolling, last), mixed.condim)
    else:
        sliding = require_within("friction", friction, 0.0, 1e6)
        grip = Grip((sliding, sliding, *SPINNING), 3 if sliding > 0 else 1)
    if grip.condim == 1:
        return grip
    return grip._replace(solreffriction=(-1e-30, -impedance * rate), impratio=max(1.0, HOLD / rate * mass / inertia))
