"""The contacts of any MuJoCo model in N/m and N s/m: `inspect_contacts`, and `inspect_flexes` for flexes.

MuJoCo mixes the parameters of a flex and a geom as those of two geoms. The inverse weight of a contact is that of the
body of the geom and of the bodies of the vertices that meet it, with the weights of the contact point among them. On a
plane it is one vertex. The contacts of all vertices are therefore between the softest and the stiffest of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from .checks import Array, require_flag, require_whole, require_within, short_repr
from .effective_mass import PointLaw
from .geoms import NO_LOAD, GeomPair, compiled_model, every_pair, geom_label
from .meeting import Keyframe, PairMeeting, Pose, meeting_of_geoms
from .notes import (
    IMMOVABLE,
    UNSOUND,
    duplicates,
    model_caveats,
    other_keyframes,
    resolving_step,
    restraint_caveats,
    rounded_down,
    shape_caveats,
    turn_caveats,
    uneven_ground,
    unknown_landing,
)
from .rebound import rebound_at, rebound_restitution
from .row_of_model import ModelRow, PairParameters


@dataclass(frozen=True)
class InspectedContact:
    """A contact of a model in physical units, at zero penetration.

    Args:
        geom1, geom2: names of the geoms; without a name, that of the body with the number of the geom in brackets.
        explicit: whether it has an explicit `<pair>`; otherwise MuJoCo mixes it from the two geoms.
        k, c: spring [N/m] and dashpot [N s/m] of each contact point.
        inertia: inertia that the row adds in a contact, beyond what the Euler step takes [kg].
        mass: effective mass of the whole contact in the pose [kg]; infinity if the geoms cannot approach each other.
        impedance: d at zero penetration [-].
        points: contact points that share the mass; frequency, xi and restitution are those of all of them together.
        load: static load of each contact point in the pose [N], or what was given.
        k_loaded: load over the indentation at which the contact carries it [N/m].
        gravity: acceleration with which gravity brings the geoms together [m/s2], not negative.
        bodies: names of the two bodies, or their numbers in brackets.
        notes: further facts about it, one sentence each.
    """

    geom1: str
    geom2: str
    explicit: bool
    k: float
    c: float
    inertia: float
    mass: float
    impedance: float
    points: int
    load: float
    k_loaded: float
    gravity: float
    bodies: tuple[str, str]
    notes: tuple[str, ...]

    __repr__ = short_repr

    @property
    def frequency(self) -> float:
        """Circular frequency omega in a contact of these points [rad/s]."""
        return math.sqrt(self.k / self.moved)

    @property
    def xi(self) -> float:
        """Damping ratio xi of a contact of these points, with the inertia of the row [-]; NaN without a mass."""
        if not self.mass < math.inf:
            return math.nan
        if self.k == 0:
            return math.inf if self.c > 0 else 0.0
        return self.c / (2 * math.sqrt(self.k * self.moved))

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of an approach along the normal that meets these points [-].

        It is that of a spring and dashpot that never pull, exp(-2 xi acos(xi) / sqrt(1 - xi^2)), beyond xi = 1 with
        acosh(xi) and sqrt(xi^2 - 1). It leaves out gravity, see `restitution_at`, and the time step; a note says where
        the step is too long for it.
        """
        return math.nan if math.isnan(self.xi) else rebound_restitution(self.xi)

    def restitution_at(self, speed: float) -> float:
        """Coefficient of restitution e at a speed of approach [m/s], with gravity [-]; 0 if the body stays.

        Raises:
            TypeError, ValueError: unless the speed is a positive number.
        """
        if math.isnan(self.xi):
            return math.nan
        share = self.mass / self.points / self.moved
        return rebound_at(speed, self.xi, self.frequency, self.gravity, share)

    @property
    def moved(self) -> float:
        """What moves with each contact point: its mass and the inertia of the row [kg]."""
        return self.mass / self.points + self.inertia


def inspect_contacts(
    model: mujoco.MjModel | mujoco.MjSpec,
    *,
    candidates: bool = True,
    contacts: int | None = None,
    keyframe: Keyframe = None,
    qpos: Sequence[float] | Array | None = None,
    load: float | None = None,
    chosen: Callable[[GeomPair], bool] | None = None,
) -> tuple[InspectedContact, ...]:
    """Every contact that a model can make, in physical units.

    Args:
        model: a compiled model or a specification; it is not changed.
        candidates: whether geoms without an explicit pair are listed too, where MuJoCo lets them collide: contype and
            conaffinity match, and their bodies are neither one, nor parent and child, nor excluded.
        contacts: contact points that share the mass, 1 to 50, of geoms that can meet in several points. None counts
            those in which the geoms meet in the pose. 1 is a single point that bears the whole mass.
        keyframe: name or number of the keyframe in which the geoms meet.
        qpos: positions of the joints in which they meet, shape (nq,). Without either it is `qpos0`.
        load: static load of each contact point [N], positive. None is that of the pose at rest, see `contact_for`.
        chosen: which pairs of geoms are looked at, by their `.labels`, `.body_names` or `.geoms`. None are all.

    Returns:
        Explicit pairs first, then candidates. Pairs of which neither body can move are left out.

    Raises:
        TypeError: unless it is a model, and the others of their kind.
        ValueError: if the specification does not compile, or a value is outside its range.
    """
    require_flag("candidates", candidates)
    points = None if contacts is None else require_whole("contacts", contacts, 1, mujoco.mjMAXCONPAIR)
    force = None if load is None else require_within("load", load, 1e-12, 1e15, "N")
    whole = compiled_model(model)
    pose = Pose(whole, keyframe, qpos)
    pairs = (pair for pair in every_pair(whole, candidates=candidates) if chosen is None or chosen(pair))
    return tuple(inspected(pair, pose, points, force) for pair in pairs)


def inspected(pair: GeomPair, pose: Pose, contacts: int | None = None, load: float | None = None) -> InspectedContact:
    """The contact of two geoms in a pose, see `inspect_contacts`."""
    row = ModelRow.from_pair(pair)
    points = contacts if contacts is None or pair.makes_several_points else 1
    met = meeting_of_geoms(pair, pose, contacts=points, law=PointLaw(row.mixed.sliding, row.k))
    force = load if load is not None else pose.load(pair, met.points, points)
    contact = InspectedContact(
        *pair.labels,
        explicit=pair.explicit >= 0,
        k=row.k,
        c=row.c,
        inertia=row.inertia,
        mass=met.effective.mass,
        impedance=row.impedance,
        points=met.points,
        load=force,
        k_loaded=row.loaded(force),
        gravity=max(0.0, met.effective.gravity),
        bodies=pair.body_names,
        notes=(),
    )
    return replace(contact, notes=tuple(_notes(pair, pose, row, met, contact, contacts)))


def _notes(
    pair: GeomPair, pose: Pose, row: ModelRow, met: PairMeeting, contact: InspectedContact, contacts: int | None
) -> Iterator[str]:
    yield from duplicates(pair)
    yield from row.notes()
    yield from shape_caveats(pair, pose)
    if frozenset(pair.geoms) in pose.resting and contact.load <= NO_LOAD < pair.load:
        yield "it touches in this pose and carries nothing at rest"
    yield from turn_caveats(pair, pose, contact.k)
    yield from _step_notes(contact, float(pair.model.opt.timestep))
    yield from model_caveats(pair.model)
    if met.neighbours.level:
        others = len(met.neighbours.level)
        yield f"it lands together with {others} other contact{'s' * (others > 1)} of its bodies, and shares the mass"
    if pair.is_uneven:
        yield uneven_ground(contact.points)
    elif contacts == 1 and pair.makes_several_points:
        yield (
            "it can have several points: xi and e are those of a single one that bears the whole mass; contacts=None "
            "counts them"
        )
    if not contact.mass < math.inf:
        yield "mass is infinite: the geoms cannot approach each other along their normal, and there is no xi and no e"
        return
    total = pair.moving
    if max(contact.mass, 1 / pair.inverse_weight) > IMMOVABLE * total:
        yield (
            f"k, c and mass belong to a body that can hardly move this way: 1/W is {1 / pair.inverse_weight:.2g} kg "
            f"and the mass {contact.mass:.2g} kg, and all that moves weighs {total:.3g} kg"
        )
        return
    yield from unknown_landing(pair, pose)
    if contact.k > 0:
        yield from restraint_caveats(pose, met.effective, contact.k * met.points, contact.xi)
    if pair.explicit >= 0 or not all(pair.model.body_weldid[list(pair.bodies)]):
        yield from other_keyframes(pair, pose, met, contacts, row.mixed.sliding)


def _step_notes(contact: InspectedContact, h: float) -> Iterator[str]:
    """Where the step is too long for the formula of e.

    No row of `contact_for` has an omega h above 1, because its inertia is h^2 k where the step resolves nothing.
    """
    if not contact.mass < math.inf:
        return
    longest = resolving_step(contact.k, contact.c, contact.moved)
    # a dashpot centred in the step leaves (1 - c h / 2 m) / (1 + c h / 2 m) of the speed
    if contact.c * h > 2 * contact.moved:
        longest = min(longest, contact.moved / contact.c)
    if h <= longest:
        return
    gain = ", and it can gain energy" if contact.frequency * h > UNSOUND else ""
    yield (
        f"timestep = {h:g} s is long for it, omega h = {contact.frequency * h:.2g}: e leaves out the step, and the "
        f"rebound can be another{gain}; {rounded_down(longest)} s resolves it"
    )


@dataclass(frozen=True, eq=False)
class FlexContact:
    """The contacts of a flex with a geom.

    Args:
        flex, geom: their labels.
        points: vertices of the flex.
        k, c: spring [N/m] and dashpot [N s/m] at zero penetration of the softest and the stiffest vertex, shape (2,).
    """

    flex: str
    geom: str
    points: int
    k: Array
    c: Array

    __repr__ = short_repr

    def __str__(self) -> str:
        """Its numbers as one line of text."""
        k, c = (" to ".join(dict.fromkeys(f"{value:.4g}" for value in values)) for values in (self.k, self.c))
        return f"{self.flex} on {self.geom}: k = {k} N/m, c = {c} N s/m at each of up to {self.points} points"


def inspect_flexes(model: mujoco.MjModel | mujoco.MjSpec) -> tuple[FlexContact, ...]:
    """Every contact that a flex of a model can make with a geom, in physical units; those of flexes alone are left out.

    Args:
        model: a compiled model or a specification; it is not changed.

    Raises:
        TypeError: unless it is a model.
        ValueError: if the specification does not compile.
    """
    return tuple(_flex_contacts(compiled_model(model)))


def _flex_contacts(model: mujoco.MjModel) -> Iterator[FlexContact]:
    for flex in range(model.nflex):
        start = int(model.flex_vertadr[flex])
        bodies = model.flex_vertbodyid[start : start + int(model.flex_vertnum[flex])]
        if model.flex_interp[flex]:  # nodes move its vertices
            start = int(model.flex_nodeadr[flex])
            bodies = model.flex_nodebodyid[start : start + int(model.flex_nodenum[flex])]
        vertices = model.body_invweight0[bodies, 0]
        kinds, masks = int(model.flex_contype[flex]), int(model.flex_conaffinity[flex])
        for geom in np.flatnonzero(model.geom_contype & masks | model.geom_conaffinity & kinds).tolist():
            weights = model.body_invweight0[model.geom_bodyid[geom], 0] + vertices
            if weights.max() > 0:
                mixed = PairParameters.of_sides(model, (("geom", geom), ("flex", flex)))
                ends = (weights.max(), weights[weights > 0].min())
                rows = [ModelRow(model, float(weight), mixed) for weight in ends]
                name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_FLEX, flex) or f"[{flex}]"
                k, c = (np.array([getattr(row, name_of_number) for row in rows]) for name_of_number in ("k", "c"))
                yield FlexContact(name, geom_label(model, geom), int(model.flex_vertnum[flex]), k, c)
