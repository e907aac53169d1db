"""Reasons for which a contact differs from the requested values: options of the model, the step, unwritten numbers.

Each function gives sentences. Those on a `PairContact` stand in its module: `remaining_caveats`, which `apply` leaves,
and `missing`, which it mends.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from decimal import ROUND_DOWN, Context
from typing import NamedTuple

import mujoco
import numpy as np

from .checks import Array, named
from .effective_mass import ACTUATOR, JOINT, TENDON, EffectiveMass, PointLaw, effective_mass
from .geoms import FACING, GeomPair
from .meeting import TOUCHING_AT_REST, PairMeeting, Pose, keyframe_names, meeting_of_geoms
from .rebound import rebound_at, rebound_restitution
from .versions import BOXES_HALF_AS_DEEP, DISABLE, ENABLE, disable_bits, give_several_points, has_several_points

SCATTER_WARNED_OF = 0.02
"""Scatter of the restitution from step to step above which there is a warning [-]."""
LONG_STEP = 0.3
"""omega h from which a step is called long [-]. The mean of e is then off by up to 0.025, most at e = 0.1."""
UNSOUND = 1.0
"""omega h from which a step does not resolve the contact [-]. `contact_for` then makes it lose what the step takes."""
NOTABLE_STIFFNESS = 0.05
"""Stiffness of springs of the model over that of the contact above which there is a warning [-]."""
NOTABLE_LOSS = 0.02
"""Change of the restitution by dampers and dry friction above which there is a warning [-]."""
NOTABLE_MASS_RATIO = 1.2
"""Ratio of the masses of a contact in two poses above which there is a warning [-]."""
IMMOVABLE = 10.0
"""Effective mass over that of all that moves from which a body is reported as hardly able to move [-]."""
SMALL_TURN = 0.01
"""Turn about the normal with which the points of two faces are counted again [degrees]."""
CONSTRAINT = mujoco.mjtObj.mjOBJ_EQUALITY
FLAG_EFFECTS = {
    "ENBL_OVERRIDE": "the override flag is set, so that o_solref and o_solimp take the place of the solref and "
    "solimp of every contact",
    "ENBL_DIAGEXACT": "the diagexact flag is set, with which the stiffness of a contact changes with the pose",
    "ENBL_SLEEP": "the sleep flag is set, with which the contacts of bodies at rest vanish",
    "ENBL_SPECULATIVE": "the speculative flag is set, with which a contact stops a fast body before it touches, "
    "and takes its rebound",
    "DSBL_CONTACT": "contacts are disabled",
    "DSBL_CONSTRAINT": "constraints are disabled, and contacts with them",
    **dict.fromkeys(
        (
            # what is reported, and how inverse dynamics read it
            *("ENBL_ENERGY", "ENBL_FWDINV", "ENBL_INVDISCRETE", "DSBL_SENSOR"),
            # contacts of flexes under `discrete`, which is warned of
            "ENBL_IPC",
            # what holds the bodies besides: the pose is computed with these flags
            *("DSBL_EQUALITY", "DSBL_FRICTIONLOSS", "DSBL_LIMIT", "DSBL_SPRING", "DSBL_DAMPER", "DSBL_PASSIVE"),
            *("DSBL_GRAVITY", "DSBL_ACTUATION", "DSBL_CLAMPCTRL"),
            # time constants of MuJoCo's other format
            "DSBL_REFSAFE",
            # which geoms meet, and in how many points: the trial landing is made with these flags
            *("DSBL_FILTERPARENT", "DSBL_MIDPHASE", "DSBL_NATIVECCD", "DSBL_MULTICCD", "ENBL_MULTICCD"),
            # how the solver begins, and whether it is split: the trial of the solver is made with these flags
            *("DSBL_WARMSTART", "DSBL_ISLAND", "ENBL_ISLAND"),
            # damping of joints in the step, and a state that is no longer finite
            *("DSBL_EULERDAMP", "DSBL_AUTORESET"),
        ),
        "",
    ),
}
"""What each flag of MuJoCo does to a contact in N/m, once it is set; empty where it does nothing."""

SAFE = "; with refsafe it also replaces contacts that the step does not resolve by some without a rebound"
MOST_ITERATIONS, LINE_SEARCHES = 100, 50
"""Iterations and line searches with which a solver is taken to converge, MuJoCo's defaults."""

VARYING_PARTS = re.compile(
    r"((joint|tendon|actuator) \S+?(, | (?=adds? |is |are |and \d)))+(and \d+ more )?(adds?|is at its|are at their)"
    r" (limits?)?|equality constraints? .*? yields?|(?<=lands together with ).*(?=, and shares)"
    r"|keyframe=?\s?'[^']*'|[-+]?\d[\d.]*(e[-+]?\d+)?"
)
"""Parts in which sentences of one kind differ."""


class ContactWarning(UserWarning):
    """A reason for which a contact in N/m differs from the request, or an effect of it on the rest of the model."""


def model_caveats(model: mujoco.MjModel) -> Iterator[str]:
    """Effects of the options of a model on every contact, one sentence each."""
    option = model.opt
    if option.integrator == getattr(mujoco.mjtIntegrator, "mjINT_DISCRETE", None):
        yield (
            "the integrator `discrete` takes energy from every contact, as much as a damping ratio of omega h / 2; "
            "take Euler, implicitfast or RK4" + ("" if option.disableflags & disable_bits("REFSAFE") else SAFE)
        )
    for bits, flags in ((int(option.enableflags), ENABLE), (int(option.disableflags), DISABLE)):
        known = {
            int(flag): FLAG_EFFECTS.get(name.removeprefix("mj"))
            for name, flag in flags.__members__.items()
            if "_" in name
        }
        for bit in (1 << i for i in range(bits.bit_length()) if bits >> i & 1):
            text = known.get(bit)
            if text is None:
                yield f"{flags.__name__} {bit} is set, and its effect on contacts is not known here"
            elif text:
                yield text


class SolverNeed(NamedTuple):
    """Iterations of MuJoCo's solver that contacts need.

    Args:
        iterations, ls_iterations: the options of these names that are enough; those of the model if it has enough.
        converges: whether the solver converges in `MOST_ITERATIONS` iterations.
        impratio: with which it converges where it does not with that of the contacts; infinity if none is found. A load
            that friction holds then creeps faster, as much as impratio is smaller.
        tried: whether the contacts could be tried; the numbers are those of the model where not.
    """

    iterations: int = 1
    ls_iterations: int = 1
    converges: bool = True
    impratio: float = math.inf
    tried: bool = True


ENOUGH = SolverNeed()
"""A need that every solver meets."""


def few_iterations(option: mujoco.MjOption, needs: SolverNeed, impratio: float = 0.0) -> Iterator[str]:
    """What the solver of a model lacks, as a sentence. The contacts raise impratio to a value [-]."""
    if not needs.tried:
        yield (
            "whether the solver has enough iterations for it is not tried: no contact in question carries a force in "
            "the model as it is, or its memory is too small for them"
        )
    solver = mujoco.mjtSolver(option.solver).name.removeprefix("mjSOL_")
    few = option.iterations < needs.iterations or option.ls_iterations < needs.ls_iterations
    cap = max(int(option.iterations), MOST_ITERATIONS)
    if needs.converges and few:
        yield (
            f"the solver needs iterations = {needs.iterations} and ls_iterations = {needs.ls_iterations} for it, and "
            f"the model has {option.iterations} and {option.ls_iterations}; apply(model, iterations=True) writes them"
        )
    elif not needs.converges and needs.impratio == math.inf:
        yield (
            f"the solver {solver} does not converge with this contact in {cap} iterations, and with no smaller "
            "impratio; take Newton, or a smaller ratio of masses"
        )
    elif not needs.converges and (few or max(option.impratio, impratio) > needs.impratio):
        yield (
            f"the solver {solver} does not converge with this contact in {cap} iterations; with impratio = "
            f"{needs.impratio:g} it does in {needs.iterations}, and friction creeps more: apply(model, "
            "iterations=True) writes both and caveats then says how much; or take Newton"
        )


def uneven_ground(points: int) -> str:
    """The effect of uneven ground on a contact that is made for a number of points, as a sentence."""
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
    """A positive number as text with a number of digits, rounded down."""
    return f"{float(Context(prec=digits, rounding=ROUND_DOWN).create_decimal_from_float(value)):g}"


def unknown_landing(pair: GeomPair, pose: Pose) -> Iterator[str]:
    """A sentence where the pose does not show how two geoms land."""
    landing = pose.landing(pair)
    if pose.normal is None and int(mujoco.mjtGeom.mjGEOM_SDF) in pose.model.geom_type[list(pair.geoms)]:
        yield (
            "MuJoCo has no shortest line to a geom of signed distances, and that of the centres is taken; give "
            "normal, the direction in which the first geom parts from the second"
        )
    elif pose.normal is None and landing.distance > TOUCHING_AT_REST and pair.meets_edges(pose.data, landing.away):
        yield (
            f"the geoms are {landing.distance:.2g} m apart in this pose, and their shortest line meets a face of "
            "neither: how they land is not known, nor the mass; give normal, the direction in which the first "
            "parts from the second, or the pose in which they land"
        )


def turn_caveats(pair: GeomPair, pose: Pose, k: float) -> Iterator[str]:
    """A sentence where a small turn gives the faces of two geoms another number of points, with both stiffnesses of
    the joint. Each point has the stiffness k [N/m]."""
    landing = pose.landing(pair)
    if not pair.has_two_faces or not pair.can_turn(pose.data, landing.away):
        return
    before, after = len(landing.first), len(pose.landing_trial.points(pair, landing.away, landing.distance, SMALL_TURN))
    if after > before:
        yield (
            f"a turn of {SMALL_TURN:g} degrees about the normal gives the two faces {after} points for {before}: the "
            f"joint then has {k * after:.3g} N/m for {k * before:.3g} N/m, and as much more "
            "damping; faces of which one lies within the other, and meshes in place of boxes, keep their points"
        )


def shape_caveats(pair: GeomPair, pose: Pose) -> Iterator[str]:
    """What MuJoCo's contact detection does to the shapes of two geoms, one sentence each."""
    model, landing = pair.model, pose.landing(pair)
    kinds = [mujoco.mjtGeom(model.geom_type[geom]) for geom in pair.geoms]
    if {*kinds} == {mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_CYLINDER}:
        cylinder = pair.geoms[kinds.index(mujoco.mjtGeom.mjGEOM_CYLINDER)]
        upright = abs(float(pose.data.geom_xmat[cylinder].reshape(3, 3)[:, 2] @ landing.away)) > FACING
        if upright and pair.can_turn(pose.data, landing.away):
            yield (
                "MuJoCo throws a cylinder that stands on a plane and turns about its axis: by rounding it finds "
                "contact points up to the radius deep; take a box in place of the plane"
            )
    if BOXES_HALF_AS_DEEP and kinds == [mujoco.mjtGeom.mjGEOM_BOX] * 2:
        yield (
            "MuJoCo before 3.4 finds two boxes half as deep as they are, so that their contact is half as stiff; "
            "take a newer MuJoCo"
        )
    if len(landing.first) == 1 and pair.makes_several_points and not has_several_points(model.opt):
        option = pose.landing_trial.model.opt
        flags = option.disableflags, option.enableflags
        give_several_points(option)
        several = len(pose.landing_trial.points(pair, landing.away, landing.distance))
        option.disableflags, option.enableflags = flags
        if several > 1:
            yield (
                f"the two faces meet in one point, where the multiccd flag gives them {several}: a face on one point "
                "has no stiffness against turning; enable multiccd"
            )


def restraint_caveats(pose: Pose, effective: EffectiveMass, k: float, xi: float, speed: float = 1.0) -> Iterator[str]:
    """Constraints, springs, dampers and dry friction of the model that hold the bodies of a contact too, one sentence
    each. The whole contact has the stiffness k [N/m] and the damping ratio xi [-]. Dry friction is judged at a speed of
    approach [m/s]."""
    model, data = pose.model, pose.data
    if effective.slides:
        yield (
            "the joints let the point approach only while it slides, so that friction takes part in the blow and the "
            "restitution depends on it; with friction=0 it is the requested one"
        )
    if effective.yielding:
        names = [_name(model, CONSTRAINT, number) for number in effective.yielding]
        many, one = ("s", "") if len(names) > 1 else ("", "s")
        yield (
            f"equality constraint{many} {named(names)} yield{one} in a contact, so that bodies move neither as one nor "
            "apart, and the restitution is another; shorten the time of solref there"
        )
    if effective.limits:
        tendon = int(mujoco.mjtConstraint.mjCNSTR_LIMIT_TENDON)
        kinds = (TENDON if data.efc_type[row] == tendon else JOINT for row in effective.limits)
        rows = {_name(model, kind, data.efc_id[row]) for kind, row in zip(kinds, effective.limits, strict=True)}
        be = "is at its limit" if len(rows) == 1 else "are at their limits"
        yield f"{named(sorted(rows))} {be} in this pose, which holds the contact too; give mass"
    yield from _spring_caveats(pose, effective, k, xi, speed)


def _spring_caveats(pose: Pose, effective: EffectiveMass, k: float, xi: float, speed: float) -> Iterator[str]:
    """Effects of springs, dampers and dry friction, where they are notable, one sentence each.

    A dry friction F that is small beside the force m omega v of the contact lowers e by F / (m omega v) times
    2 sqrt(e) - 2 xi e, which is its work on the way in and out. MuJoCo's row of dry friction yields, and in a short
    contact it pulls the bodies together on both ways, as gravity does. What it takes is at most the larger of both.
    """
    springs, e = pose.springs, rebound_restitution(xi)
    stiffness, damping = springs.along(effective.motion, speed)
    friction, mass = springs.friction(effective.motion), effective.mass
    added = float(stiffness.sum())
    if abs(added) > NOTABLE_STIFFNESS * k:
        yield (
            f"{_owners_and_verb(pose, stiffness)} {added:.3g} N/m to the {k:.3g} N/m of the contact along the "
            "approach, which changes its restitution"
        )
    omega = math.sqrt(k / mass)
    ratio, pull = float(damping.sum()) / (2 * mass * omega), float(friction.sum()) / (mass * omega * speed)
    damped = e - rebound_restitution(xi + ratio) if ratio > 0 else 0.0
    rubbed = (
        min(e, max(pull * (2 * math.sqrt(e) - 2 * xi * e), e - rebound_at(1.0, xi, 1.0, pull))) if pull > 0 else 0.0
    )
    notable = NOTABLE_LOSS if damped + rubbed <= NOTABLE_LOSS else 0.25 * NOTABLE_LOSS
    if damped > notable:
        yield (
            f"{_owners_and_verb(pose, damping)} a damping ratio of {ratio:.2g} to the {xi:.2g} of the contact "
            "along the approach, which lowers its restitution"
        )
    if rubbed > notable:
        yield (
            f"{_owners_and_verb(pose, friction)} a dry friction of {friction.sum():.3g} N along the approach, which "
            f"lowers e = {e:.3g} by up to {rubbed:.2g} at {speed:g} m/s, and by more at a lower speed"
        )


def _owners_and_verb(pose: Pose, shares: Array) -> str:
    """The owners of the largest shares of a sum, the largest first, and the verb."""
    shares = np.abs(shares)
    order = np.argsort(-shares, kind="stable")
    largest = [_name(pose.model, *pose.springs.owners[i]) for i in order[shares[order] >= 0.1 * shares[order[0]]]]
    return f"{named(largest)} add{'s' * (len(largest) == 1)}"


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    """An element of the model by kind and name, or by its number where it has no name."""
    label = {JOINT: "joint", TENDON: "tendon", ACTUATOR: "actuator", CONSTRAINT: ""}[kind]
    return f"{label} {mujoco.mj_id2name(model, kind, number) or f'[{number}]'!s}".strip()


def yielding_joints(
    pair: GeomPair, pose: Pose, met: PairMeeting, law: PointLaw, xi: float, speed: float
) -> Iterator[str]:
    """A sentence where joints give way within a blow, so that the mass at its end is another.

    Args:
        pair, pose, met: the geoms, the pose, and how they meet in it.
        law: of a contact point, with its stiffness.
        xi: damping ratio [-].
        speed: speed of the approach [m/s].

    A blow lasts about pi / omega, and its impulse grows to (1 + e) m v: the joints move by half of that on average.
    """
    if met.effective.yielding:  # `restraint_caveats` names them
        return
    model, landing = pair.model, pose.landing(pair)
    assert law.k is not None
    lasts = math.pi / math.sqrt(law.k / met.share)
    moved = np.array(pose.data.qpos)
    mujoco.mj_integratePos(model, moved, met.effective.motion, 0.5 * (1 + rebound_restitution(xi)) * speed * lasts)
    later = Pose(model, qpos=moved)
    before, after = [], []
    for body, point in zip(pair.bodies, (landing.first.mean(axis=0), landing.second.mean(axis=0)), strict=True):
        turned = later.data.xmat[body].reshape(3, 3) @ pose.data.xmat[body].reshape(3, 3).T
        before.append(point)
        after.append(later.data.xpos[body] + turned @ (point - pose.data.xpos[body]))
    first, last = (
        effective_mass(pair, at_pose.constraints, landing.away, (points[0], points[1]), law.together(met.points)).mass
        for at_pose, points in ((pose, before), (later, after))
    )
    if max(last / first, first / last) > NOTABLE_MASS_RATIO:
        yield (
            f"joints give way within a blow of {lasts:.2g} s at {speed:g} m/s, in which a contact of {first:.3g} kg "
            f"comes to stop {last:.3g} kg, and the restitution is another; a stiffer contact is over sooner"
        )


def other_keyframes(
    pair: GeomPair, pose: Pose, met: PairMeeting, contacts: int | None, friction: float
) -> Iterator[str]:
    """A sentence on the keyframe in which the mass of a contact point differs most, if it differs much."""
    if pose.given and (pose.exact or not pose.keeps_qpos0(pair)):
        return
    names, worst = keyframe_names(pair.model), (NOTABLE_MASS_RATIO, "", 0.0)
    for name, other in zip(names, pose.others, strict=False):
        if pose.given and other.keeps_qpos0(pair):
            continue
        share = meeting_of_geoms(pair, other, contacts=contacts, law=PointLaw(friction)).share
        if 0 < share < IMMOVABLE * pair.moving:  # beyond that the motion is one that cannot be
            worst = max(worst, (max(share / met.share, met.share / share), name, share))
    _, name, share = worst
    if name:
        yield (
            f"a contact point stops {share:.3g} kg at keyframe '{name}' and {met.share:.3g} kg at {pose.label}, "
            f"for which the contact is made; give keyframe='{name}' if that is where the model stands"
        )
