"""Reasons for which a contact differs from its numbers: options of the model, the step, and what was not written.

Each function gives sentences. Those on one contact stand beside `PairContact`: `spoilers` of what `apply` leaves as it
is, `missing` of what it writes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from decimal import ROUND_DOWN, Context
from typing import NamedTuple

import mujoco

from ..problem.damping.rebound import rebound_restitution
from .geoms import GeomPair

SCATTER_WARNED_OF = 0.02
"""Scatter of the restitution from step to step that is worth a warning [-]."""
LONG_STEP = 0.3
"""omega h from which a step is called long [-]. The mean of e is then off by up to 0.025, most at e = 0.1."""
UNSOUND = 1.0
"""omega h from which a step does not resolve the contact [-]. `contact_for` then makes it lose what the step takes."""
ENABLE, DISABLE = mujoco.mjtEnableBit, mujoco.mjtDisableBit
JUDGED: dict[mujoco.mjtEnableBit | mujoco.mjtDisableBit, str] = {
    ENABLE.mjENBL_OVERRIDE: "the override flag is set, so that o_solref and o_solimp take the place of the solref and "
    "solimp of every contact",
    ENABLE.mjENBL_DIAGEXACT: "the diagexact flag is set, with which the stiffness of a contact changes with the pose",
    ENABLE.mjENBL_SLEEP: "the sleep flag is set, with which the contacts of bodies at rest vanish",
    ENABLE.mjENBL_SPECULATIVE: "the speculative flag is set, with which a contact stops a fast body before it touches, "
    "and takes its rebound",
    DISABLE.mjDSBL_CONTACT: "contacts are disabled",
    DISABLE.mjDSBL_CONSTRAINT: "constraints are disabled, and contacts with them",
    **dict.fromkeys(
        (
            # what is reported, and how inverse dynamics read it
            *(ENABLE.mjENBL_ENERGY, ENABLE.mjENBL_FWDINV, ENABLE.mjENBL_INVDISCRETE, DISABLE.mjDSBL_SENSOR),
            # contacts of flexes under `discrete`, which is warned of
            ENABLE.mjENBL_IPC,
            # what holds the bodies besides: the pose is computed with these flags
            *(DISABLE.mjDSBL_EQUALITY, DISABLE.mjDSBL_FRICTIONLOSS, DISABLE.mjDSBL_LIMIT, DISABLE.mjDSBL_SPRING),
            *(DISABLE.mjDSBL_DAMPER, DISABLE.mjDSBL_GRAVITY, DISABLE.mjDSBL_ACTUATION, DISABLE.mjDSBL_CLAMPCTRL),
            # time constants of MuJoCo's other format
            DISABLE.mjDSBL_REFSAFE,
            # which geoms meet, and in how many points: the trial landing is made with these flags
            *(DISABLE.mjDSBL_FILTERPARENT, DISABLE.mjDSBL_MIDPHASE, DISABLE.mjDSBL_NATIVECCD, DISABLE.mjDSBL_MULTICCD),
            # how the solver begins, and whether it is split: the trial of the solver is made with these flags
            *(DISABLE.mjDSBL_WARMSTART, DISABLE.mjDSBL_ISLAND),
            # damping of joints in the step, and a state that is no longer finite
            *(DISABLE.mjDSBL_EULERDAMP, DISABLE.mjDSBL_AUTORESET),
        ),
        "",
    ),
}
"""What each flag of MuJoCo does to a contact in N/m, once it is set; empty where it does nothing."""

SAFE = "; with refsafe it also replaces contacts that the step does not resolve by some without a rebound"
MOST_TURNS, LINE_SEARCHES = 100, 50
"""Iterations and line searches with which a solver is taken to converge, MuJoCo's defaults."""

VARIES = re.compile(
    r"((joint|tendon|actuator) \S+?(, | (?=adds? |is |are |and \d)))+(and \d+ more )?(adds?|is at its|are at their)"
    r" (limits?)?|equality constraints? .*? yields?|(?<=lands together with ).*(?=, and shares)"
    r"|keyframe=?\s?'[^']*'|[-+]?\d[\d.]*(e[-+]?\d+)?"
)
"""Parts in which sentences of one kind differ."""


class ContactWarning(UserWarning):
    """What keeps a contact in N/m from being what was asked, or what it does to the rest of the model."""


def model_spoilers(model: mujoco.MjModel) -> Iterator[str]:
    """Effects of the options of a model on every contact, one sentence each."""
    option = model.opt
    if option.integrator == mujoco.mjtIntegrator.mjINT_DISCRETE:
        yield (
            "the integrator `discrete` takes energy from every contact, as much as a damping ratio of omega h / 2; "
            "take Euler, implicitfast or RK4" + ("" if option.disableflags & int(DISABLE.mjDSBL_REFSAFE) else SAFE)
        )
    for bits, kind in ((int(option.enableflags), ENABLE), (int(option.disableflags), DISABLE)):
        known = {int(flag): text for flag, text in JUDGED.items() if isinstance(flag, kind)}
        for bit in (1 << i for i in range(bits.bit_length()) if bits >> i & 1):
            if text := known.get(bit, f"{kind.__name__} {bit} is set, and its effect on contacts is not known here"):
                yield text


class SolverNeed(NamedTuple):
    """What contacts need of MuJoCo's solver.

    Args:
        iterations, ls_iterations: the options of these names that are enough; those of the model if it has enough.
        converges: whether the solver converges in `MOST` iterations.
        impratio: with which it converges where it does not with that of the contacts; infinity if none is found. A load
            that friction holds then creeps faster, as much as impratio is smaller.
    """

    iterations: int = 1
    ls_iterations: int = 1
    converges: bool = True
    impratio: float = math.inf


ENOUGH = SolverNeed()
"""What any solver has."""


def few_iterations(option: mujoco.MjOption, needs: SolverNeed) -> Iterator[str]:
    """What the solver of a model lacks, as a sentence."""
    solver = mujoco.mjtSolver(option.solver).name.removeprefix("mjSOL_")
    few = option.iterations < needs.iterations or option.ls_iterations < needs.ls_iterations
    if needs.converges and few:
        yield (
            f"the solver needs iterations = {needs.iterations} and ls_iterations = {needs.ls_iterations} for it, and "
            f"the model has {option.iterations} and {option.ls_iterations}; apply(model, iterations=True) writes them"
        )
    elif not needs.converges and needs.impratio == math.inf:
        yield (
            f"the solver {solver} does not converge with this contact in {max(int(option.iterations), MOST_TURNS)} "
            "iterations, and with no smaller impratio; take Newton, or a smaller ratio of masses"
        )
    elif not needs.converges and (few or option.impratio > needs.impratio):
        yield (
            f"the solver {solver} does not converge with this contact in {max(int(option.iterations), MOST_TURNS)} "
            f"iterations; with impratio = {needs.impratio:g} it does in {needs.iterations}, and friction creeps more: "
            "apply(model, iterations=True) writes both and caveats then says how much; or take Newton"
        )


def uneven(points: int) -> str:
    """The effect of uneven ground, as a sentence."""
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
    return min(LONG_STEP / omega, SCATTER_WARNED_OF * math.sqrt(12) * mass / max(e * c, 1e-300))


def stiffest(h: float, xi: float, mass: float) -> float:
    """The stiffest contact of a mass and a damping ratio that a step resolves [N/m]; see `resolving_step`."""
    e = rebound_restitution(xi)
    omega = min(LONG_STEP, SCATTER_WARNED_OF * math.sqrt(12) / max(2 * e * xi, 1e-300)) / h
    return mass * omega**2


def rounded_down(value: float, digits: int = 2) -> str:
    """A positive number as text with so many digits, never above what it is."""
    return f"{float(Context(prec=digits, rounding=ROUND_DOWN).create_decimal_from_float(value)):g}"
