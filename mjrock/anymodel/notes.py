"""What keeps a contact in N/m from being what it says: options of the model, the step, and what has not been written.

Each function gives sentences: `spoilers` of what `PairContact.apply` leaves as it is, `missing` of what it writes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from decimal import ROUND_DOWN, Context

import mujoco
import numpy as np

from ..engine.solref import inertia_of
from ..problem.damping.rebound import rebound_restitution
from .filters import kept_apart
from .geoms import GeomPair
from .mixing import Mixed
from .numbers import ContactNumbers

DEEP = 0.01
"""Static depth over the smallest half extent of the geoms from which a contact is called soft [-]."""
SCATTER = 0.02
"""Scatter of the restitution from step to step that is worth a warning [-]."""
RESOLVED = 0.3
"""omega h from which a step is called long [-]. The mean of e is then off by up to 0.025, most at e = 0.1."""
UNSOUND = 1.0
"""omega h from which a step does not resolve the contact [-]. `contact_for` then makes it lose what the step takes."""
GAINS = 0.5
"""omega h from which a contact of the pyramidal cone is said to gain energy [-]. Undamped it rebounds with 1.03 there,
with 1.09 at 0.9 and with 2.4 at 1.9."""
NOTHING, SMALL = 0.03, 0.2999
"""Restitutions between which gravity is warned of where no speed is given [-]."""
MOST_SPEED = 1e4
"""Largest speed of approach that is looked at [m/s]."""
ENABLED = {
    mujoco.mjtEnableBit.mjENBL_OVERRIDE: "the override flag is set, so that o_solref and o_solimp take the place of "
    "the solref and solimp of every contact",
    mujoco.mjtEnableBit.mjENBL_DIAGEXACT: "the diagexact flag is set, with which the stiffness of a contact changes "
    "with the pose",
    mujoco.mjtEnableBit.mjENBL_SLEEP: "the sleep flag is set, with which the contacts of bodies at rest vanish",
}
DISABLED = {
    mujoco.mjtDisableBit.mjDSBL_CONTACT: "contacts are disabled",
    mujoco.mjtDisableBit.mjDSBL_CONSTRAINT: "constraints are disabled, and contacts with them",
}

VARIES = re.compile(
    r"((joint|tendon|actuator) \S+?(, | (?=adds? |is |are |and \d)))+(and \d+ more )?(adds?|is at its|are at their)"
    r" (limits?)?|equality constraints? .*? yields?|(?<=lands together with ).*(?=, and shares)"
    r"|keyframe=?\s?'[^']*'|[-+]?\d[\d.]*(e[-+]?\d+)?"
)
"""What differs in sentences that are alike."""


class ContactWarning(UserWarning):
    """What keeps a contact in N/m from being what was asked, or what it does to the rest of the model."""


def model_spoilers(model: mujoco.MjModel) -> Iterator[str]:
    """What the options of a model do to every contact."""
    option = model.opt
    if option.integrator == mujoco.mjtIntegrator.mjINT_DISCRETE:
        yield (
            "the integrator `discrete` takes energy from every contact, as much as a damping ratio of omega h / 2; "
            "take Euler, implicitfast or RK4"
        )
    yield from (text for flag, text in ENABLED.items() if option.enableflags & int(flag))
    yield from (text for flag, text in DISABLED.items() if option.disableflags & int(flag))


def spoilers(pair: GeomPair, contact: ContactNumbers) -> Iterator[str]:
    """What `apply` does not mend."""
    model = pair.model
    yield from model_spoilers(model)
    yield from duplicates(pair)
    if pair.explicit < 0 and (reason := kept_apart(pair)):
        yield f"MuJoCo keeps these geoms apart, since {reason}; an explicit <pair> overrides that and lets them collide"
    if pair.explicit >= 0:
        mixed = Mixed.of(pair)
        if mixed.margin != 0:
            yield f"the pair has a margin of {mixed.margin:g} m, at which the spring begins; set it to 0"
        if mixed.adhesion != 0:
            yield f"the pair has an adhesion of {mixed.adhesion:g} N, with which the contact pulls"
    if pair.is_uneven:
        yield uneven(contact.contacts)
    yield from step_spoilers(contact)


def uneven(points: int) -> str:
    """What uneven ground does."""
    return (
        "one of the geoms is uneven, and the number of contact points changes from place to place; the mass is that "
        f"of {points}"
    )


def duplicates(pair: GeomPair) -> Iterator[str]:
    """More than one explicit pair of the geoms."""
    if len(pair.listed) > 1:
        yield (
            f"the model has {len(pair.listed)} explicit <pair>s of these geoms, and MuJoCo makes the contacts of each; "
            "remove all but one"
        )


def resolving_step(k: float, c: float, mass: float) -> float:
    """The longest step [s] that resolves the contact of a mass [kg] on a spring [N/m] and dashpot [N s/m], maybe zero.

    A touch lies anywhere in a step, and the dashpot acts from the next step on. Uniform touches give e a standard
    deviation of e c h / (m sqrt(12)).
    """
    if k == 0:
        return math.inf
    omega = math.sqrt(k / mass)
    e = rebound_restitution(c / (2 * mass * omega))
    return min(RESOLVED / omega, SCATTER * math.sqrt(12) * mass / max(e * c, 1e-300))


def stiffest(h: float, xi: float, mass: float) -> float:
    """The stiffest contact of a mass and a damping ratio that a step resolves [N/m]; see `resolving_step`."""
    e = rebound_restitution(xi)
    omega = min(RESOLVED, SCATTER * math.sqrt(12) / max(2 * e * xi, 1e-300)) / h
    return mass * omega**2


def weight_spoilers(contact: ContactNumbers) -> Iterator[str]:
    """What the weight of the bodies does to a small restitution."""
    e = rebound_restitution(contact.xi)
    if contact.speed is not None or contact.gravity <= 0 or not NOTHING < e < SMALL:
        return
    slow, fast = NOTHING * contact.gravity, MOST_SPEED
    for _ in range(60):
        middle = math.sqrt(slow * fast)
        slow, fast = (slow, middle) if contact.restitution_at(middle) > 0.5 * e else (middle, fast)
    yield (
        f"gravity lowers so small a restitution: e = {e:.3g} becomes {contact.restitution_at(1.0):.2g} at 1 m/s, and "
        f"less than half of it below {slow:.2g} m/s; give speed, that of the approach"
    )


def soft_spoilers(contact: ContactNumbers, model_k: float, thickness: float) -> Iterator[str]:
    """Where the stiffest contact that the step resolves is soft under the weight: against that of the model [N/m], and
    against the smallest half extent of the geoms [m]."""
    h, k = contact.timestep, contact.k
    if k < (1 - SCATTER) * model_k:
        yield (
            f"k = {k:.3g} N/m, the stiffest that a step of {h:g} s resolves, is softer than the contact that "
            f"the model had, {model_k:.3g} N/m under the weight; "
            f"{rounded_down(h * math.sqrt(k / model_k))} s resolves as much"
        )
    if contact.depth > DEEP * thickness:
        resolving = h * math.sqrt(DEEP * thickness / contact.depth)
        yield (
            f"the weight presses the geoms into each other by {contact.depth:.2g} m with the stiffest contact that a "
            f"step of {h:g} s resolves, {contact.depth / thickness:.0%} of their smallest half extent; "
            f"{rounded_down(resolving)} s resolves a hundredth of it"
        )


def rounded_down(value: float, digits: int = 2) -> str:
    """A positive number as text with so many digits, never above what it is."""
    return f"{float(Context(prec=digits, rounding=ROUND_DOWN).create_decimal_from_float(value)):g}"


def step_spoilers(contact: ContactNumbers) -> Iterator[str]:
    """What a long step does to the restitution."""
    h, omega = contact.timestep, contact.frequency
    longest = resolving_step(contact.k, contact.c, contact.mass)
    softer = f"or k = {rounded_down(0.999 * stiffest(h, contact.xi, contact.mass))} N/m at this step"
    if omega * h > UNSOUND:
        yield (
            f"timestep = {h:g} s does not resolve a contact of omega = {omega:.4g} rad/s: it rebounds with less than "
            f"0.6 whatever is asked; {rounded_down(longest)} s resolves it, {softer}"
        )
    elif h > longest:
        yield (
            f"timestep = {h:g} s is long for a contact of omega = {omega:.4g} rad/s and xi = {contact.xi:.3g}: the "
            f"restitution depends on where in a step the geoms touch; {rounded_down(longest)} s resolves it, {softer}"
        )


def missing(pair: GeomPair, contact: ContactNumbers) -> Iterator[str]:
    """What a model lacks that `apply` would write."""
    option, mixed = pair.model.opt, Mixed.of(pair)
    names = ["solref", "solimp"] + (["friction"] if contact.condim > 1 else [])
    if pair.explicit < 0:
        yield "the model has no explicit <pair> of the geoms, so that MuJoCo mixes the parameters of the two geoms"
        if contact.condim > 1:
            yield "geoms have no solreffriction, so that sliding changes the normal force"
    elif contact.condim > 1:
        names.append("solreffriction")
    for name in names:
        if not np.allclose(getattr(mixed, name), getattr(contact, name), rtol=1e-5, atol=1e-12):
            yield f"the pair has another {name}: {getattr(mixed, name)} for {getattr(contact, name)}"
    if mixed.condim != contact.condim:
        yield f"the pair has condim {mixed.condim} for {contact.condim}"
    if not math.isclose(option.timestep, contact.timestep, rel_tol=1e-9):
        yield f"the model steps by {option.timestep:g} s, and the contact was made for {contact.timestep:g} s"
    stage = mujoco.mjtIntegrator.mjINT_RK4
    if (option.integrator == stage) != (contact.integrator == stage.name.removeprefix("mjINT_")):
        yield f"the contact was made for the integrator {contact.integrator}, and the model has another"
    if contact.condim == 1:
        return
    if option.cone != mujoco.mjtCone.mjCONE_ELLIPTIC:
        yield f"the friction cone is pyramidal, which {_pyramidal(pair, contact)}"
    if option.impratio < contact.impratio * (1 - 1e-5):
        yield f"impratio = {option.impratio:g} is below {contact.impratio:g}: sliding changes the normal force"


def _pyramidal(pair: GeomPair, contact: ContactNumbers) -> str:
    """What the pyramidal cone does to a contact: all three numbers of the row grow, the mass and the step do not."""
    factor, h, d = Mixed.of(pair).pyramid(float(pair.model.opt.impratio)), contact.timestep, contact.solimp[0]
    dashpot = -contact.solref[1] / ((1 - d) * contact.inverse_weight)
    used = 0.0 if contact.integrator == "RK4" else 0.5 * h * dashpot
    inertia = factor * max(0.0, inertia_of(d, contact.inverse_weight) - used)
    text = f"makes stiffness and damping of a contact with friction {factor:.3g} times as large"
    if h * math.sqrt(factor * contact.k / (contact.mass + inertia)) <= GAINS:
        return text
    return f"{text}: the step is too long for it, and the contact can gain energy; set cone to elliptic"
