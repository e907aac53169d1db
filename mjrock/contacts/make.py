"""`contact_for` and `contacts_for`: a stiffness in N/m and a restitution for geoms of any MuJoCo model."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from fnmatch import fnmatchcase
from typing import Annotated, NamedTuple

import mujoco

from .checks import Array, Within, keep_declared, named, require_within, shown, spelt, warn_of, within_ranges
from .contact import PairContact, PairContacts, blow_caveats, merged, remaining_caveats, soft_caveats, weight_caveats
from .effective_mass import PointLaw
from .geoms import BODY, GEOM, NO_LOAD, GeomPair, compiled_model, geom_id, makes, names_of_objects
from .meeting import Keyframe, Neighbours, PairMeeting, Pose, meeting_of_geoms
from .notes import (
    LONG_STEP,
    UNSOUND,
    ContactWarning,
    few_iterations,
    other_keyframes,
    resolving_step,
    restraint_caveats,
    rounded_down,
    shape_caveats,
    stiffest,
    turn_caveats,
    unknown_landing,
    yielding_joints,
)
from .rebound import MOST_PULL, falling_damping, rebound_damping
from .row_of_model import FrictionParameters, ModelRow, PairParameters, unused
from .solref import WITHIN, RowStep, inertia_of, longest_represented_step, pair_values, row
from .solver_trial import solver_need

LEAST_RESTITUTION = 1e-3
"""The smallest coefficient of restitution that a contact is given [-]. e = 0 is the limit of an infinite dashpot."""
RESTITUTIONS = (0.05, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0)
"""Coefficients of restitution of `stiffest_contacts` [-]."""
Geom = str | int


def contact_for(
    model: mujoco.MjModel | mujoco.MjSpec,
    geom1: str | int,
    geom2: str | int,
    *,
    k: float | None = None,
    k_face: float | None = None,
    k_n: float | None = None,
    depth: float | None = None,
    load: float | None = None,
    c: float | None = None,
    restitution: float | None = None,
    xi: float | None = None,
    friction: float | Sequence[float] | None = None,
    mass: float | None = None,
    at: Sequence[float] | Array | None = None,
    normal: Sequence[float] | Array | None = None,
    contacts: int | None = None,
    keyframe: Keyframe = None,
    qpos: Sequence[float] | Array | None = None,
    speed: float | None = None,
    timestep: float | None = None,
    newmark_beta: float = 0.25,
) -> PairContact:
    """A contact of two geoms with a stiffness in N/m and a restitution, a damping ratio or a dashpot.

    The contact is a spring and dashpot that never pull: f = max(0, k x + c v) at each contact point. The loss is given
    once, as `restitution`, `xi` or `c`. The first two refer to an effective mass, that of the contact points in a pose
    of the model. By default the pose is `qpos0`, and the points are found by moving the geoms together along their
    normal. The points share the mass. What moves with them counts: joints, armature, equality constraints, and the
    friction that keeps a point from slipping.

    Args:
        model: a compiled model or a specification; it is not changed. See `PairContact.apply`. A specification is
            compiled at each call; `contacts_for` compiles it once for many contacts.
        geom1, geom2: names or numbers of the geoms. The name of a body stands for its geom, if it has just one.
        k: stiffness of each contact point [N/m], positive. Of k, k_face, k_n and depth one is given; with none of them
            it is the stiffest that the time step resolves, see `stiffest_contacts`.
        k_face: stiffness of all contact points together [N/m]: those that share the mass have equal parts of it.
        k_n: stiffness of the face in which the two geoms meet [N/m3], that of the polygon of their contact points.
        depth: how deep the geoms are pressed into each other at rest [m], under `load`.
        load: static load on all contact points together [N], not of each as `PairContact.load`. None is that of gravity
            and of the actuators, at the `ctrl` of the keyframe, in the pose at rest; where the geoms are apart, the
            weight of the lighter one.
        c: dashpot of each contact point [N s/m], not negative.
        restitution: e of an approach along the normal, within [0, 1] [-]. e below 0.001 is taken as 0.001, because an
            infinite dashpot would be needed for 0. Without `speed` it leaves out gravity.
        xi: damping ratio c / (2 sqrt(k m)) [-], not negative.
        friction: coefficient of sliding friction [-], in place of the two that the contact has in the model. Its
            torsional and rolling friction and its condim remain, but condim 1 becomes 3, and 0 makes the contact
            frictionless. Or all five of a `<pair>`: two sliding [-], one torsional and two rolling [m]. None keeps what
            the model has.
        mass: effective mass of the whole contact [kg], positive. None takes it from the model.
        at: contact point that meets first, in the world's frame and in the pose [m], shape (3,). None is the middle of
            the points that meet. It is not given together with `mass`.
        normal: direction in which geom1 parts from geom2, in the world's frame, shape (3,): (0, 0, 1) for a foot on
            whatever lies below. None is the normal of a plane, the axis of a height field, and the shortest line of
            other geoms.
        contacts: contact points that share the mass, 1 to 50: 4 for a box that lands flat on a plane. None counts
            them, with those of other geoms of the two bodies that land together with these: the four balls of a foot
            share its mass. Another number than is counted refers to the centres of mass, unless `at` is given.
        keyframe: name or number of the keyframe in which the geoms meet, and at whose `ctrl` actuators press. Or
            several, each for the joints that it moves from `qpos0`: robots that are attached bring keyframes of their
            own.
        qpos: positions of the joints in which they meet, shape (nq,). It is not given together with `keyframe`.
        speed: speed of the approach for which `restitution` holds with gravity [m/s], positive. The depth of a blow at
            this speed is compared with the geoms.
        timestep: MuJoCo's step [s], positive. None takes the model's.
        newmark_beta: Newmark's beta of the contact row [-], not negative; 1/4 is average acceleration.

    Returns:
        The contact, with ``.solref .solimp .solreffriction .friction .depth .xml`` and `.apply(model)`.

    Raises:
        TypeError, ValueError: for a value outside its range, geoms that the model does not have or that cannot meet,
            and stiffness or damping that MuJoCo cannot represent at this step.

    Warns:
        ContactWarning: with a sentence for each reason for which the contact differs from the request. The model can be
            one: an option that changes every contact, geoms that MuJoCo keeps apart, or a solver that has too few
            iterations, does not converge or is not tried. The step can be too long for the contact, or without k leave
            a soft one. Other geoms may share the mass, a constraint or a spring may also hold the bodies, or the
            contact stops another mass in a keyframe. The shapes matter where a small turn gives two faces more points,
            two faces meet in one point, a cylinder stands on a plane, or a blow at `speed` is deeper than the geoms.
    """
    arguments = locals()
    whole = compiled_model(model)
    pair = GeomPair.named(whole, geom1, geom2)
    request = ContactRequest(**{entry.name: arguments[entry.name] for entry in fields(ContactRequest)})
    pose = Pose(whole, keyframe, qpos)
    contacts_made = _contacts(pose, [(pair, request)])
    for _, sentence in _sentences(whole, contacts_made):
        warn_of(sentence, ContactWarning)
    return contacts_made.contacts[0]


@within_ranges
def stiffest_contacts(
    model: mujoco.MjModel | mujoco.MjSpec,
    geom1: str | int,
    geom2: str | int,
    *,
    timestep: Annotated[float | None, Within(1e-12, 1e3, "s")] = None,
    keyframe: Keyframe = None,
    qpos: Sequence[float] | Array | None = None,
) -> tuple[PairContact, ...]:
    """The stiffest contact of two geoms that a time step resolves, for each of some coefficients of restitution.

    A step resolves a contact whose restitution is nearly the requested one wherever in a step the geoms touch. The
    stiffness that it resolves is least for restitutions of 0.2 to 0.4: see `.k`, `.depth` and `.restitution`.

    Args:
        model: a compiled model or a specification; it is not changed.
        geom1, geom2: names or numbers of the geoms.
        timestep: MuJoCo's step [s], 1e-12 to 1000. None takes the model's.
        keyframe, qpos: the pose in which they meet; see `contact_for`.

    Returns:
        The contacts for the restitutions of `RESTITUTIONS`, 0.05 to 1.

    Raises:
        TypeError, ValueError: as `contact_for` does.
    """
    whole = compiled_model(model)
    pair, pose = GeomPair.named(whole, geom1, geom2), Pose(whole, keyframe, qpos)
    return tuple(contact_of(pair, pose, ContactRequest(restitution=e, timestep=timestep))[0] for e in RESTITUTIONS)


def contacts_for(
    model: mujoco.MjModel | mujoco.MjSpec,
    pairs: Mapping[tuple[Geom, Geom], Mapping[str, object]],
    *,
    keyframe: Keyframe = None,
    qpos: Sequence[float] | Array | None = None,
    timestep: float | None = None,
) -> PairContacts:
    """Contacts of many geoms at once. A specification is compiled once.

    Args:
        model: a compiled model or a specification; it is not changed.
        pairs: what is requested of the contacts of two geoms, by their names or numbers: arguments of `contact_for` by
            name, such as `{("foot*", "floor"): {"k": 5e4, "restitution": 0.2}}`. Names may have the wildcards `*`, `?`
            and `[...]`. They are looked for among the geoms, and where none has it among the bodies with one geom. They
            name what MuJoCo lets collide, by contype and conaffinity, `<exclude>`, and parent and child, or by an
            explicit pair. Names without wildcards override that. A later entry replaces what wildcards named before.
        keyframe, qpos: the pose in which all of them meet; see `contact_for`.
        timestep: MuJoCo's step [s], positive. None takes the model's.

    Returns:
        The contacts, with ``.xml``, `.apply(model)` and `.caveats(model)` of them all.

    Raises:
        TypeError, ValueError: as `contact_for` does, and for names that nothing has, wildcards of which MuJoCo lets
            none collide, or two geoms that an earlier entry names without wildcards.

    Warns:
        ContactWarning: as `contact_for` does, sentences that are alike once, with the geoms that they are about.
    """
    whole = compiled_model(model)
    if not isinstance(pairs, Mapping):
        raise TypeError(
            f"pairs = {shown(pairs)} has to be a dictionary, such as "
            '{("foot*", "floor"): {"k": 5e4, "restitution": 0.2}}'
        )
    pose = Pose(whole, keyframe, qpos)
    requests: dict[frozenset[int], tuple[tuple[int, int], ContactRequest]] = {}
    without_wildcards = set[frozenset[int]]()
    for key, values in pairs.items():
        request = _request(key, values, timestep)
        for geoms in _geoms_named(whole, key):
            geom_set = frozenset(geoms)
            if geom_set in without_wildcards:
                raise ValueError(f"pairs name the geoms {GeomPair(whole, geoms).labels} twice, last by {shown(key)}")
            requests[geom_set] = geoms, request
            if not any(map(_is_wild, key)):
                without_wildcards.add(geom_set)
    if not requests:
        raise ValueError(f"pairs = {shown(pairs)} name no contact; at least one is needed")
    contacts = _contacts(pose, [(GeomPair.named(whole, *geoms), request) for geoms, request in requests.values()])
    for sentence in merged(_sentences(whole, contacts)):
        warn_of(sentence, ContactWarning)
    return contacts


def _contacts(pose: Pose, requests: Sequence[tuple[GeomPair, ContactRequest]]) -> PairContacts:
    """The requested contacts in a pose, with the iterations that they need and remarks on what lands with each."""
    results = [contact_of(pair, pose, request) for pair, request in requests]
    by_geoms = {frozenset(contact.ids): contact for contact, _ in results}
    landed = {
        frozenset(pair.geoms): (contact, pose.along(request.normal).landing(pair))
        for (pair, request), (contact, _) in zip(requests, results, strict=True)
    }
    needs = solver_need(pose, tuple(landed.values()))
    remarked = (replace(with_neighbours(contact, neighbours, by_geoms), needs=needs) for contact, neighbours in results)
    return PairContacts(tuple(remarked))


def _sentences(model: mujoco.MjModel, contacts: PairContacts) -> Iterator[tuple[PairContact, str]]:
    """Reasons for which contacts differ from the request, each with its contact."""
    for contact in contacts:
        caveats = remaining_caveats(GeomPair(model, contact.ids), contact)
        for sentence in (*caveats, *few_iterations(model.opt, contact.needs, contacts.impratio), *contact.remarks):
            yield contact, sentence


def _request(key: object, values: object, timestep: float | None) -> ContactRequest:
    if not isinstance(key, tuple) or len(key) != 2:
        raise TypeError(f"pairs have the key {shown(key)}; it has to be two geoms, such as ('foot*', 'floor')")
    if not isinstance(values, Mapping):
        raise TypeError(f"pairs of {shown(key)} = {shown(values)} has to be arguments of contact_for by name")
    unknown = [str(name) for name in values if name not in REQUEST_NAMES]
    if unknown:
        raise ValueError(f"pairs of {shown(key)} have {named(unknown)}; each takes {', '.join(REQUEST_NAMES)}")
    return ContactRequest(**values, timestep=timestep)


def _geoms_named(model: mujoco.MjModel, key: tuple[object, object]) -> Iterator[tuple[int, int]]:
    """The numbers of the geoms that a key names; with wildcards, of those for which MuJoCo makes contacts."""
    firsts, seconds = (
        _matching(model, argument, value) for argument, value in zip(("geom1", "geom2"), key, strict=True)
    )
    if not any(map(_is_wild, key)):
        yield firsts[0], seconds[0]
        return
    colliding: dict[frozenset[int], tuple[int, int]] = {}
    for geoms in itertools.product(firsts, seconds):
        if frozenset(geoms) not in colliding and makes(GeomPair(model, geoms)):
            colliding[frozenset(geoms)] = geoms
    if not colliding:
        raise ValueError(
            f"pairs of {shown(key)} are geoms that MuJoCo keeps apart, by contype and conaffinity, <exclude>, or as "
            "one body or parent and child; names without wildcards override that"
        )
    yield from colliding.values()


def _is_wild(name: object) -> bool:
    """Whether a name has wildcards."""
    return isinstance(name, str) and any(mark in name for mark in "*?[")


def _matching(model: mujoco.MjModel, argument: str, value: object) -> list[int]:
    """The numbers of the geoms that a name with wildcards means."""
    if not isinstance(value, str) or not _is_wild(value):
        return [geom_id(model, argument, value)]
    geoms = names_of_objects(model, GEOM)
    numbers = [i for i, name in enumerate(geoms) if name and fnmatchcase(name, value)]
    if not numbers:
        alike = (i for i, name in enumerate(names_of_objects(model, BODY)) if fnmatchcase(name, value))
        numbers = [int(model.body_geomadr[i]) for i in alike if model.body_geomnum[i] == 1]
    if not numbers:
        known = named([name for name in geoms if name]) or "none"
        raise ValueError(
            f"{argument} = {shown(value)} matches no geom, nor a body with a single one; geoms are: {known}"
        )
    return numbers


@dataclass(frozen=True)
class ContactRequest:
    """The request for a contact: the arguments of `contact_for` by name.

    Raises:
        TypeError, ValueError: for a number outside its range, if both a mass and a point are given, or two
            stiffnesses, and unless exactly one of c, restitution and xi is.
    """

    k: Annotated[float | None, Within(1e-30, 1e30, "N/m", "stiffness k")] = None
    k_face: Annotated[float | None, Within(1e-30, 1e30, "N/m")] = None
    k_n: Annotated[float | None, Within(1e-30, 1e30, "N/m3")] = None
    depth: Annotated[float | None, Within(1e-12, 1e3, "m")] = None
    load: Annotated[float | None, Within(1e-12, 1e15, "N")] = None
    c: Annotated[float | None, Within(0.0, 1e30, "N s/m", "damping c")] = None
    restitution: Annotated[float | None, Within(0.0, 1.0)] = None
    xi: Annotated[float | None, Within(0.0, 1e6, name="damping ratio xi")] = None
    friction: object = None
    mass: Annotated[float | None, Within(1e-30, 1e30, "kg")] = None
    at: object = None
    contacts: Annotated[int | None, Within(1, mujoco.mjMAXCONPAIR, whole=True)] = None
    speed: Annotated[float | None, Within(1e-9, 1e6, "m/s")] = None
    timestep: Annotated[float | None, Within(1e-12, 1e3, "s")] = None
    newmark_beta: Annotated[float, Within(0.0, 1e6)] = 0.25
    normal: object = None

    def __post_init__(self) -> None:
        if self.mass is not None and self.at is not None:
            raise ValueError(f"mass = {shown(self.mass)} and at = {shown(self.at)} are both given; give one of them")
        losses = {"c": self.c, "restitution": self.restitution, "xi": self.xi}
        loss = [f"{name} = {spelt(value)}" for name, value in losses.items() if value is not None]
        if len(loss) != 1:
            listed = ", ".join(loss) or "none"
            raise ValueError(f"exactly one of c, restitution and xi has to be given; given are {listed}")
        named_k = {name: getattr(self, name) for name in ("k", "k_face", "k_n", "depth")}
        stiffness = [f"{name} = {spelt(value)}" for name, value in named_k.items() if value is not None]
        if len(stiffness) > 1:
            raise ValueError(f"{' and '.join(stiffness)} are given; give one of them")
        if not stiffness and self.c is not None:
            raise ValueError(f"k = None takes restitution or xi, and c = {spelt(self.c)} is given; give k")
        keep_declared(self)

    def by_point(self, pair: GeomPair, pose: Pose) -> ContactRequest:
        """The request with k, the stiffness of each contact point, in place of k_face, k_n or depth."""
        if self.k_face is None and self.k_n is None and self.depth is None:
            return self
        alone, landing = self.mass is not None, pose.landing(pair)
        points = meeting_of_geoms(pair, pose, contacts=self.contacts, at=self.at, alone=alone).points
        if self.k_face is not None:
            k = self.k_face / points
        elif self.k_n is not None:
            k = self.k_n * landing.area / len(landing.first)
            if not landing.area > 0:
                raise ValueError(
                    f"k_n = {self.k_n:g} N/m3 needs a face, and {pair.labels} meet in {len(landing.first)} point"
                    f"{'s' * (len(landing.first) > 1)} at {pose.label}; give k or k_face"
                )
        else:
            load = pose.load(pair, points, self.contacts) if self.load is None else self.load / points
            if not load > NO_LOAD:
                raise ValueError(
                    f"depth = {self.depth:g} m needs a load, and {pair.labels} carry none at rest at {pose.label}; "
                    "give load, or the keyframe in which they press"
                )
            k = load / self.depth if self.depth else math.inf
        return replace(self, k=k, k_face=None, k_n=None, depth=None)


REQUEST_NAMES = tuple(field.name for field in fields(ContactRequest) if field.name != "timestep")
"""Arguments that each contact of several may have."""


def contact_of(pair: GeomPair, pose: Pose, request: ContactRequest) -> tuple[PairContact, Neighbours]:
    """The contact of a pair in a pose, with `remarks` on how it differs from the request, and the geoms that land with
    it."""
    option, pose = pair.model.opt, pose.along(request.normal)
    request = request.by_point(pair, pose)
    h = require_within("timestep", option.timestep if request.timestep is None else request.timestep, 1e-12, 1e3, "s")
    friction, mixed = FrictionParameters.from_pair(pair, request.friction), PairParameters.from_pair(pair)
    met = meeting_of_geoms(
        pair,
        pose,
        contacts=request.contacts,
        at=request.at,
        alone=request.mass is not None,
        law=PointLaw(friction.sliding, request.k, LONG_STEP / h if request.k is None else None),
    )
    if request.mass is None and not met.effective.mass < math.inf:
        raise ValueError(
            f"geom1 and geom2 = {pair.labels} cannot approach each other along their normal at {pose.label}, so that "
            "the model gives no mass for the restitution; give mass"
        )
    share = met.share if request.mass is None else request.mass / met.points
    gravity = met.effective.gravity
    k = _stiffest_resolved(pair, request, h, share, gravity) if request.k is None else request.k
    c = request.c
    if c is None:
        c = 2 * _damping_ratio(request, math.sqrt(k / share), gravity) * math.sqrt(k * share)
    step = EngineStep(h, request.newmark_beta, option.integrator == mujoco.mjtIntegrator.mjINT_RK4)
    dashpot, inertia = _row(k, c, share, pair.inverse_weight, step)
    stiffness, damping, d = pair_values(k, dashpot, inertia, pair.inverse_weight)
    contact = PairContact(
        *pair.names,
        ids=pair.geoms,
        k=k,
        c=c,
        mass=share,
        inverse_weight=pair.inverse_weight,
        timestep=h,
        integrator=mujoco.mjtIntegrator(option.integrator).name.removeprefix("mjINT_"),
        contacts=met.points,
        solref=(stiffness, damping),
        solimp=(d, d, 0.001, 0.5, 2.0),
        **friction.holding(min(math.sqrt(k / share), 1 / h), d, share, inertia)._asdict(),
        adhesion=mixed.adhesion,
        gap=mixed.gap,
        speed=request.speed,
        gravity=max(0.0, gravity),
        pose=pose.label,
        load=pose.load(pair, met.points, request.contacts) if request.load is None else request.load / met.points,
    )
    remarks = [*unused(request.friction, friction), *shape_caveats(pair, pose), *turn_caveats(pair, pose, k)]
    remarks += _remarks(pair, pose, request, met, PointLaw(friction.sliding, k), c)
    if request.restitution is not None:
        remarks += weight_caveats(contact)
    remarks += blow_caveats(contact, pair)
    if request.k is None:
        remarks += soft_caveats(contact, ModelRow.from_pair(pair).loaded(contact.load), pair.thickness)
    return replace(contact, remarks=tuple(remarks)), met.neighbours


def with_neighbours(
    contact: PairContact, neighbours: Neighbours, contacts: Mapping[frozenset[int], PairContact]
) -> PairContact:
    """The contact with `remarks` on the geoms that land with it and do not have the same contact, or are not level.

    Args:
        contact, neighbours: the contact, and the geoms that land with it.
        contacts: all that were requested, by the numbers of their geoms.
    """
    label = {pair: " on ".join(pair.labels) for pair in (*neighbours.level, *neighbours.separate)}
    others = {pair: contacts.get(frozenset(pair.geoms)) for pair in label}
    unlike = [label[pair] for pair in neighbours.level if not (other := others[pair]) or not contact.is_like(other)]
    apart = [label[pair] for pair in neighbours.separate if others[pair]]
    level = f"give the pose in which the bodies stand level, not {contact.pose}"
    remarks = []
    if unlike:
        remarks.append(
            f"it lands together with {named(unlike)}, and shares the mass; give them the same contact, or give this "
            "one contacts=, the number of its own points, if it does not share the mass"
        )
    if neighbours.late > 0:
        remarks.append(
            f"what is taken to land together with it touches up to {neighbours.late:.2g} m sooner or later; {level}"
        )
    if apart:
        remarks.append(f"it lands together with {named(apart)}, and shares the mass, only on a level; {level}")
    return replace(contact, remarks=(*contact.remarks, *remarks))


def _damping_ratio(request: ContactRequest, omega: float, gravity: float) -> float:
    """The damping ratio [-] of a frequency, from the restitution or the damping ratio that is given."""
    if request.xi is not None:
        return request.xi
    e = max(request.restitution or 0.0, LEAST_RESTITUTION)
    if request.speed is None or gravity <= 0:
        return rebound_damping(e)
    pull = gravity / (omega * request.speed)
    if pull > MOST_PULL:
        slowest = gravity / (omega * MOST_PULL)
        raise ValueError(
            f"speed = {request.speed:g} m/s is too slow to rebound; the valid range is from {slowest:.3g} m/s on"
        )
    return falling_damping(e, pull)


def _stiffest_resolved(pair: GeomPair, request: ContactRequest, h: float, mass: float, gravity: float) -> float:
    """The stiffest contact that the step resolves, rounded down [N/m]."""
    omega = LONG_STEP / h
    for _ in range(20):  # with gravity the damping depends on the frequency, a little
        k = stiffest(h, _damping_ratio(request, omega, gravity), mass)
        omega = math.sqrt(k / mass)
    representable = 0.4 * inertia_of(WITHIN[1], pair.inverse_weight) / h**2
    return float(rounded_down(min(0.999 * k, representable), 3))


def _remarks(
    pair: GeomPair, pose: Pose, request: ContactRequest, met: PairMeeting, law: PointLaw, c: float
) -> Iterator[str]:
    """Reasons in the pose for which a contact differs from the request, one sentence each."""
    if request.mass is not None:
        return
    assert law.k is not None
    xi, speed = c / (2 * math.sqrt(law.k * met.share)), request.speed or 1.0
    if request.at is None:
        yield from unknown_landing(pair, pose)
    yield from yielding_joints(pair, pose, met, law, xi, speed)
    yield from restraint_caveats(pose, met.effective, law.k * met.points, xi, speed)
    if request.c is None and request.at is None:
        yield from other_keyframes(pair, pose, met, request.contacts, law.friction)


class EngineStep(NamedTuple):
    """A step of the engine.

    Args:
        h: its length [s].
        newmark_beta: Newmark's beta of the contact rows [-].
        staged: whether it has the stages of RK4.
    """

    h: float
    newmark_beta: float
    staged: bool


def _row(k: float, c: float, mass: float, inverse_weight: float, step: EngineStep) -> tuple[float, float]:
    """Dashpot [N s/m] and inertia [kg] of the contact row.

    The inertia is Newmark's in steps of Euler's method, and the least that there is in the stages of RK4. A step that
    is longer than 1 / omega could throw a touch back with more energy than it came with. There the row has the extra
    dashpot h k and beta = 1/2 at least, with which e stays below 0.6 whatever the step.
    """
    h, newmark_beta = step.h, step.newmark_beta
    longest = longest_represented_step(k, inverse_weight)
    if h > longest:
        resolving = min(longest, resolving_step(k, c, mass))
        raise ValueError(
            f"stiffness k = {k:g} N/m at timestep = {h:g} s is beyond what MuJoCo represents; "
            f"the longest step is {rounded_down(longest, 3)} s, and {rounded_down(resolving)} s resolves the contact; "
            "k = None takes the stiffest contact that this step resolves"
        )
    sound = h * math.sqrt(k / mass) <= UNSOUND
    beta, ringing = (newmark_beta, 0.0) if sound else (max(newmark_beta, 0.5), 1.0)
    dashpot, inertia = row(k, c, inverse_weight, RowStep(h, beta, ringing))
    if dashpot < c:
        raise ValueError(
            f"damping c = {c:g} N s/m at timestep = {h:g} s is beyond what MuJoCo represents, {dashpot:.3g} N s/m; "
            "lower the timestep"
        )
    if inertia > inertia_of(WITHIN[1], inverse_weight):
        raise ValueError(f"newmark_beta = {newmark_beta:g} requires more inertia than MuJoCo represents; lower it")
    return dashpot, inertia_of(WITHIN[0], inverse_weight) if step.staged and sound else inertia
