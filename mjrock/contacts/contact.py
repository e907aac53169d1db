"""A contact of two geoms in N/m and N s/m, as numbers, as text, and written into a model."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import mujoco
import numpy as np

from .checks import named, require_flag, require_text, short_repr, warn_of
from .files import quoted
from .geoms import NO_LOAD, GeomPair, compiled_model, every_pair, geom_label, reason_for_no_contact
from .notes import (
    ENOUGH,
    SCATTER_WARNED_OF,
    UNSOUND,
    VARYING_PARTS,
    ContactWarning,
    SolverNeed,
    duplicates,
    few_iterations,
    model_caveats,
    resolving_step,
    rounded_down,
    stiffest,
    uneven_ground,
)
from .rebound import MOST_PULL, deepest, rebound_at, rebound_restitution
from .row_of_model import HOLDING_RATE, WRITTEN, ModelRow, PairParameters
from .solref import inertia_of

Attribute = str | float | tuple[float, ...]
"""Of an element of MJCF."""
SOFT_DEPTH = 0.01
"""Static depth over the smallest half extent of the geoms from which a contact is called soft [-]."""
GAINS_ENERGY_FROM = 0.5
"""omega h from which a contact of the pyramidal cone is reported to gain energy [-]. Undamped it rebounds with 1.03
there, with 1.09 at 0.9 and with 2.4 at 1.9."""
NO_REBOUND, SMALL_REBOUND = 0.03, 0.2999
"""Restitutions between which there is a warning of the effect of gravity where no speed is given [-]."""
NOTABLE_CHANGE = 0.05
"""Change of the stiffness of another contact by the options from which there is a warning [-]."""
KEEPS_STIFFNESS = 0.1
"""Largest change of stiffness with which a contact counts as kept [-]; it is 5 % for MuJoCo's impedance of 0.9 to 0.95
and mu = 1.5."""
LEAST_SPEED, MOST_SPEED = 1e-9, 1e4
"""Range of speeds in which the one is searched at which gravity halves a small restitution [m/s]."""


@dataclass(frozen=True)
class PairContact:
    """A spring and dashpot between two geoms that never pull, and MuJoCo's parameters for them.

    Args:
        geom1, geom2: names of the geoms; an empty name is a geom without one.
        ids: the numbers of the geoms.
        k, c: spring [N/m] and dashpot [N s/m] of each contact point.
        mass: effective mass that each contact point stops [kg].
        inverse_weight: W of the pair [1/kg], the sum of `body_invweight0` of both bodies.
        timestep, integrator: step [s] and integrator of MuJoCo for which the numbers hold.
        contacts: contact points that share the mass.
        solref, solimp, solreffriction, friction, condim: what the `<pair>` carries.
        impratio: smallest impratio of the model with which the friction holds [-]; 1 without friction.
        adhesion, gap: tensile force of each contact point [N] and the distance up to which it pulls [m], as the model
            has them. The margin of a contact is zero.
        speed: speed of approach for which the contact was made [m/s], or None where it leaves out gravity.
        gravity: acceleration with which gravity brings the geoms together [m/s2], not negative.
        pose: the pose in which they meet: `qpos0`, a keyframe, or `qpos`.
        load: static load of each contact point [N], that of gravity and actuators in the pose at rest, or the weight of
            the lighter tree of bodies where the geoms are apart.
        needs: iterations of the solver that the contact needs, found by a trial in the pose.
        remarks: reasons in this pose for which the contact differs from the request, one sentence each.
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
    contacts: int
    solref: tuple[float, float]
    solimp: tuple[float, float, float, float, float]
    solreffriction: tuple[float, float]
    friction: tuple[float, float, float, float, float]
    condim: int
    impratio: float
    adhesion: float = 0.0
    gap: float = 0.0
    speed: float | None = None
    gravity: float = 0.0
    pose: str = "qpos0"
    load: float = 0.0
    needs: SolverNeed = ENOUGH
    remarks: tuple[str, ...] = ()

    __repr__ = short_repr

    @property
    def label(self) -> str:
        """The names of the geoms, or their numbers in brackets."""
        names = zip((self.geom1, self.geom2), self.ids, strict=True)
        return " on ".join(name or f"[{number}]" for name, number in names)

    def is_like(self, other: PairContact) -> bool:
        """Whether another contact has the same spring and dashpot."""
        return math.isclose(self.k, other.k) and math.isclose(self.c, other.c, rel_tol=1e-6)

    @property
    def frequency(self) -> float:
        """Circular frequency omega of the mass on the spring [rad/s]."""
        return math.sqrt(self.k / self.mass)

    @property
    def xi(self) -> float:
        """Damping ratio [-]."""
        return self.c / (2 * math.sqrt(self.k * self.mass))

    @property
    def depth(self) -> float:
        """How deep the static load presses the geoms into each other [m], load / k."""
        return self.load / self.k

    @property
    def restitution(self) -> float:
        """Coefficient of restitution e of an approach along the normal [-], at the speed for which the contact was made
        with gravity, otherwise without gravity, see `rebound_restitution`."""
        return rebound_restitution(self.xi) if self.speed is None else self.restitution_at(self.speed)

    def restitution_at(self, speed: float) -> float:
        """Coefficient of restitution e at a speed of approach [m/s], with gravity [-]; 0 if the body stays.

        Raises:
            TypeError, ValueError: unless the speed is a positive number.
        """
        return rebound_at(speed, self.xi, self.frequency, self.gravity)

    @property
    def xml(self) -> str:
        """The elements to put into `<mujoco>`: the options that the contact needs, and the explicit pair.

        Put it behind every other `<option>`, because the last one is taken, and in place of any `<pair>` of the same
        geoms, because MuJoCo makes the contacts of both. Of several contacts keep one `<option>`, with the largest
        impratio. An impratio of 1e6 to 1e9 is normal here.

        Raises:
            ValueError: if one of the geoms has no name.
        """
        return PairContacts((self,)).xml

    def apply(
        self,
        model: mujoco.MjModel | mujoco.MjSpec,
        *,
        on_geoms: bool = False,
        keep_others: bool = False,
        iterations: bool = False,
        name_geoms: bool = False,
    ) -> None:
        """Write the contact into a model, with the options that it needs.

        A compiled model has to have an explicit `<pair>` of the two geoms, which takes the numbers. A specification
        that has none is given one. The time step is set, and for a contact with friction the elliptic cone and
        impratio, which keeps its value if that is larger. `MjSpec.attach` brings the pair into another specification
        and leaves these options behind: attach first, and make and apply the contact on the whole.

        Args:
            model: the model for which the contact was made, or another with the same geoms and bodies. It is changed.
            on_geoms: whether the two geoms of a compiled model without such a pair take the numbers. An approach
                without sliding is then the same. Geoms have no solreffriction, so that sliding changes the normal
                force, and every other contact of these geoms mixes the numbers too.
            keep_others: whether other contacts that the options change are kept as stiff as they were. Named geoms of a
                specification get explicit pairs, which their own parameters and filters do not change any more, and
                existing pairs get other numbers.
            iterations: whether the options `iterations` and `ls_iterations` are raised to what the contact needs, see
                `needs`. Models for MJX have few. A solver that does not converge is given a smaller impratio.
            name_geoms: whether geoms of a specification without a name get one, that of their body with their number.

        Raises:
            ValueError: if a compiled model has no such pair, a geom has no name where a name is needed, or the bodies
                have another inverse weight.

        Warns:
            ContactWarning: of other contacts that are stiffer or softer now, with k before and after. The elliptic cone
                makes contacts with friction mu softer by 2 impratio / (mu^2 (1 + mu^2)), or stiffer for mu above 1. And
                of a solver that has too few iterations for the contact, or that does not converge with it.
        """
        PairContacts((self,)).apply(
            model, on_geoms=on_geoms, keep_others=keep_others, iterations=iterations, name_geoms=name_geoms
        )

    def write_pair(self, model: mujoco.MjModel | mujoco.MjSpec, whole: mujoco.MjModel, on_geoms: bool) -> None:
        """Write the pair into a model or a specification, of which `whole` is the compiled model; not the options."""
        geoms = self._pair_in(whole)
        if isinstance(model, mujoco.MjSpec):
            self._require_names()
            self.parameters.write_spec(_spec_pair(model, geoms))
        elif geoms.explicit >= 0 or on_geoms:
            self.write_numbers(model, geoms)
        else:
            raise ValueError(
                f"model has no explicit <pair> of {self.geom1 or self.ids[0]!r} and {self.geom2 or self.ids[1]!r}; "
                "apply the contact to its MjSpec before compiling, put the text of .xml into the MJCF, or let both "
                "geoms take it with on_geoms=True"
            )

    def with_names(self, spec: mujoco.MjSpec, whole: mujoco.MjModel) -> PairContact:
        """The contact with the names of its geoms, which are given to those of a specification that have none."""
        names = []
        for name, number in zip((self.geom1, self.geom2), self.ids, strict=True):
            if not name:
                geom = next(geom_spec for geom_spec in spec.geoms if geom_spec.id == number)
                geom.name = geom.name or geom_label(whole, number)
            names.append(name or geom.name)
        return replace(self, geom1=names[0], geom2=names[1])

    @property
    def attributes(self) -> dict[str, Attribute]:
        """The attributes of the explicit pair by name, for tools that make MJCF; see `options` for those of `<option>`.

        Raises:
            ValueError: if one of the geoms has no name.
        """
        self._require_names()
        names = ["condim", "solref", "solimp", "margin", "gap", "adhesion"]
        names += ["solreffriction", "friction"] if self.condim > 1 else []
        numbers = {name: getattr(self.parameters, name) for name in names if name in WRITTEN}
        return {"geom1": self.geom1, "geom2": self.geom2, **numbers}

    @property
    def options(self) -> dict[str, Attribute]:
        """The attributes of `<option>` that the contact needs, by name."""
        return PairContacts((self,)).options

    @property
    def parameters(self) -> PairParameters:
        """The parameters of the explicit pair."""
        return PairParameters(
            solref=self.solref,
            solimp=self.solimp,
            solreffriction=self.solreffriction,
            friction=self.friction,
            condim=self.condim,
            margin=0.0,
            gap=self.gap,
            adhesion=self.adhesion,
        )

    def write_numbers(self, model: mujoco.MjModel, pair: GeomPair) -> None:
        """Write the numbers into the explicit pair of a compiled model or, without one, into both geoms, which mix to
        the contact, as equal geoms of equal priority do; margin, gap and adhesion add up."""
        if pair.explicit >= 0:
            self.parameters.write(model, pair.explicit)
            return
        geoms = list(pair.geoms)
        model.geom_margin[geoms], model.geom_gap[geoms] = 0.0, 0.5 * self.gap
        if "adhesion" in WRITTEN:
            model.geom_adhesion[geoms] = 0.5 * self.adhesion
        model.geom_solref[geoms], model.geom_solimp[geoms] = self.solref, self.solimp
        model.geom_condim[geoms], model.geom_friction[geoms] = self.condim, self.friction[1:4]
        model.geom_priority[geoms] = model.geom_priority[geoms].max()

    def caveats(self, model: mujoco.MjModel | mujoco.MjSpec, prefix: str = "") -> tuple[str, ...]:
        """Reasons in a model for which the contact differs from the requested values, a sentence each.

        Args:
            model: a model with the contact, from `apply` or from the text of `xml`.
            prefix: what the names of the geoms have in front, where `MjSpec.attach` brought them into the model.

        Raises:
            ValueError: if the geoms are not in the model, or the bodies have another inverse weight.
        """
        if require_text("prefix", prefix):
            self._require_names()
            return replace(self, geom1=prefix + self.geom1, geom2=prefix + self.geom2).caveats(model)
        pair = self._pair_in(compiled_model(model))
        few = few_iterations(pair.model.opt, self.needs)
        return (*missing(pair, self), *remaining_caveats(pair, self), *few, *self.remarks)

    def __str__(self) -> str:
        """Its numbers as one line of text."""
        with_gravity = "" if self.speed is None else f" at {self.speed:g} m/s with gravity"
        friction_text = f"; friction {self.friction[0]:g}, impratio {self.impratio:.2g}" if self.condim > 1 else ""
        at_rest = f"depth {self.depth:.3g} m under the weight" if self.load > NO_LOAD else "carries nothing at rest"
        return (
            f"{self.label}: k = {self.k:.4g} N/m, c = {self.c:.4g} N s/m at {self.contacts} "
            f"point{'s' * (self.contacts > 1)} of {self.mass:.4g} kg; e = {self.restitution:.3g}{with_gravity}, "
            f"xi = {self.xi:.3g}; {at_rest}{friction_text}; timestep {self.timestep:g} s"
        )

    def _pair_in(self, model: mujoco.MjModel) -> GeomPair:
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
            raise ValueError(
                f"geom1 or geom2 (numbers {self.ids}) has no name, which an explicit <pair> needs; "
                "let apply(spec, name_geoms=True) name it, or both geoms of a compiled model take the contact with "
                "apply(model, on_geoms=True)"
            )


@dataclass(frozen=True)
class PairContacts:
    """Contacts of one model with one time step.

    Args:
        contacts: the contacts, in the order of the request.
    """

    contacts: tuple[PairContact, ...]

    __repr__ = short_repr

    def __iter__(self) -> Iterator[PairContact]:
        return iter(self.contacts)

    def __len__(self) -> int:
        return len(self.contacts)

    @property
    def has_friction(self) -> bool:
        """Whether any of them has friction."""
        return any(contact.condim > 1 for contact in self)

    @property
    def impratio(self) -> float:
        """The impratio with which the friction of every contact holds [-]."""
        return max(contact.impratio for contact in self.contacts)

    @property
    def xml(self) -> str:
        """The elements to put into `<mujoco>`: one `<option>`, and the explicit pairs; see `PairContact.xml`.

        Raises:
            ValueError: if a geom has no name.
        """
        pairs = "".join(f"  {_element('pair', contact.attributes)}\n" for contact in self)
        return f"{_element('option', self.options)}\n<contact>\n{pairs}</contact>\n"

    @property
    def options(self) -> dict[str, Attribute]:
        """The attributes of `<option>` that the contacts need together, by name; see `PairContact.attributes`."""
        attributes: dict[str, Attribute] = {"timestep": self.contacts[0].timestep}
        return attributes | ({"cone": "elliptic", "impratio": self.impratio} if self.has_friction else {})

    def apply(
        self,
        model: mujoco.MjModel | mujoco.MjSpec,
        *,
        on_geoms: bool = False,
        keep_others: bool = False,
        iterations: bool = False,
        name_geoms: bool = False,
    ) -> None:
        """Write the contacts into a model, with the options that they need; see `PairContact.apply`."""
        flags = {"on_geoms": on_geoms, "keep_others": keep_others, "iterations": iterations, "name_geoms": name_geoms}
        for name, value in flags.items():
            require_flag(name, value)
        whole, contacts, h = compiled_model(model), self.contacts, self.contacts[0].timestep
        if name_geoms and isinstance(model, mujoco.MjSpec):
            contacts = tuple(contact.with_names(model, whole) for contact in contacts)
            whole = compiled_model(model)
        option = model.option if isinstance(model, mujoco.MjSpec) else model.opt
        switches = self.has_friction and option.cone != mujoco.mjtCone.mjCONE_ELLIPTIC
        others: list[tuple[GeomPair, ModelRow]] = []
        if switches or on_geoms or option.timestep != h:
            written = {frozenset(contact._pair_in(whole).geoms) for contact in contacts}
            others = [
                (pair, ModelRow.from_pair(pair)) for pair in every_pair(whole) if frozenset(pair.geoms) not in written
            ]
        for contact in contacts:
            contact.write_pair(model, whole, on_geoms)
        for opt in (option, whole.opt):
            opt.timestep = h
            if self.has_friction:
                opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
                opt.impratio = max(float(opt.impratio), self.impratio)
            for name in ("iterations", "ls_iterations") if iterations else ():
                setattr(opt, name, max([getattr(opt, name), *(getattr(contact.needs, name) for contact in contacts)]))
            if iterations:
                opt.impratio = min([float(opt.impratio), *(contact.needs.impratio for contact in contacts)])
        changes = [StiffnessChange(pair, before, ModelRow.from_pair(pair)) for pair, before in others]
        changed = [change for change in changes if not math.isclose(*change.stiffness, rel_tol=NOTABLE_CHANGE)]
        changed = [change for change in changed if not (keep_others and _keep(model, change))]
        if changed:
            warn_of(changes_message(changed), ContactWarning)
        for sentence in dict.fromkeys(text for contact in self for text in few_iterations(whole.opt, contact.needs)):
            warn_of(sentence, ContactWarning)

    def caveats(self, model: mujoco.MjModel | mujoco.MjSpec, prefix: str = "") -> tuple[str, ...]:
        """Reasons in a model for which the contacts differ from their numbers, equal sentences once with the geoms that
        they concern; see `PairContact.caveats`."""
        whole = compiled_model(model)
        return tuple(merged((contact, sentence) for contact in self for sentence in contact.caveats(whole, prefix)))

    def __str__(self) -> str:
        """A line for each contact."""
        return "\n".join(str(contact) for contact in self)


def merged(sentences: Iterable[tuple[PairContact, str]]) -> Iterator[str]:
    """Sentences that are alike once, with the geoms that they concern. The first of several with other numbers or
    names is given in full."""
    alike: dict[str, dict[str, list[str]]] = {}
    for contact, sentence in sentences:
        alike.setdefault(VARYING_PARTS.sub("#", sentence), {}).setdefault(sentence, []).append(contact.label)
    for (sentence, about), *others in (sentences_alike.items() for sentences_alike in alike.values()):
        further = list(dict.fromkeys(label for _, labels in others for label in labels))
        yield f"{named(about)}: {sentence}" + (f" [and alike for {named(further)}]" if further else "")


def _text(value: Attribute) -> str:
    """The value of an attribute, numbers with all of their digits."""
    if isinstance(value, tuple):
        return " ".join(repr(float(number)) for number in value)
    return value if isinstance(value, str) else repr(value)


def _element(name: str, attributes: dict[str, Attribute]) -> str:
    return f"<{name} {' '.join(f'{key}={quoted(_text(value))}' for key, value in attributes.items())}/>"


def _spec_pair(spec: mujoco.MjSpec, geoms: GeomPair) -> mujoco.MjsPair:
    """The explicit pair of two geoms in a specification, made where there is none."""
    first, second = geoms.names
    listed = (pair for pair in spec.pairs if {pair.geomname1, pair.geomname2} == {first, second})
    return next(listed, None) or spec.add_pair(geomname1=first, geomname2=second)


class StiffnessChange(NamedTuple):
    """A contact that the options change, and its rows before and after."""

    pair: GeomPair
    before: ModelRow
    after: ModelRow

    @property
    def kept(self) -> PairParameters | None:
        """Parameters of an explicit pair that keep its row as before; None where MuJoCo has no such row.

        With the pyramidal cone the rows of a contact with friction are as stiff as one row of the elliptic cone times
        `PairParameters.pyramid`, f. A contact is kept by a row that is f times as large in all three of its numbers.
        For K [1/s2], B [1/s] and the impedance d these are K d / R, B / R and 1 / R with 1 / R = d / ((1 - d) W), so
        that

            d' = f d / (1 - d + f d),    K' = K d / d',    B' = B.

        Where d grows with penetration, both of its ends become d', and K' belongs to their geometric mean.
        """
        before, factor = self.before, self.before.scale / self.after.scale
        d, dw, *shape = before.solimp
        if before.constant:
            dw = d
        near, full = (factor * end / (1 - end + factor * end) for end in (d, dw))
        spring = before.spring * math.sqrt(d * dw / (near * full))
        mixed = replace(before.mixed, solref=(-spring * full**2, -before.dashpot * full), solimp=(near, full, *shape))
        load, row = self.pair.load, ModelRow(self.pair.model, self.pair.inverse_weight, mixed)
        return mixed if math.isclose(row.loaded(load), before.loaded(load), rel_tol=KEEPS_STIFFNESS) else None

    @property
    def stiffness(self) -> tuple[float, float]:
        """k before and after, under the weight [N/m]."""
        return self.before.loaded(self.pair.load), self.after.loaded(self.pair.load)


def changes_message(changed: Collection[StiffnessChange]) -> str:
    """Contacts that the options change, the one that changes most first, as a sentence."""
    changes = []
    for change in sorted(changed, key=lambda other: -abs(math.log(other.stiffness[1] / other.stiffness[0]))):
        changes.append("{} ({:.3g} to {:.3g} N/m)".format(" on ".join(change.pair.labels), *change.stiffness))
    return (
        f"the options that the contact needs change the stiffness of {len(changes)} other contacts of the model under "
        f"the weight: {named(changes)}; contacts_for gives them numbers of their own, or keep_others=True writes pairs "
        "that keep named geoms as they were"
    )


def _keep(model: mujoco.MjModel | mujoco.MjSpec, changed: StiffnessChange) -> bool:
    """Write the numbers that keep a contact as it was; returns whether MuJoCo has such numbers."""
    geoms, numbers = changed.pair, changed.kept
    if numbers is None or len(geoms.listed) > 1:
        return False
    if isinstance(model, mujoco.MjModel):
        if geoms.explicit >= 0:
            numbers.write(model, geoms.explicit)
        return geoms.explicit >= 0
    if not all(geoms.names):
        return False
    numbers.write_spec(_spec_pair(model, geoms))
    return True


def remaining_caveats(pair: GeomPair, contact: PairContact) -> Iterator[str]:
    """Reasons that `apply` does not correct, one sentence each."""
    model = pair.model
    yield from model_caveats(model)
    yield from duplicates(pair)
    if pair.explicit < 0 and (reason := reason_for_no_contact(pair)):
        yield f"MuJoCo keeps these geoms apart, since {reason}; an explicit <pair> overrides that and lets them collide"
    mixed = PairParameters.from_pair(pair)
    if mixed.margin != 0:
        yield f"it has a margin of {mixed.margin:g} m, at which the spring begins; apply writes a margin of 0"
    if mixed.adhesion != 0:
        within = f" within {mixed.gap:g} m" if mixed.gap else ""
        yield f"it has an adhesion of {mixed.adhesion:g} N a point, with which the contact pulls{within}"
    if pair.is_uneven:
        yield uneven_ground(contact.contacts)
    yield from step_caveats(contact)


def weight_caveats(contact: PairContact) -> Iterator[str]:
    """The effect of weight on a small restitution, as a sentence."""
    e = rebound_restitution(contact.xi)
    if contact.speed is not None or contact.gravity <= 0 or not NO_REBOUND < e < SMALL_REBOUND:
        return
    slow, fast = max(NO_REBOUND * contact.gravity, LEAST_SPEED), MOST_SPEED
    for _ in range(60):
        middle = math.sqrt(slow * fast)
        slow, fast = (slow, middle) if contact.restitution_at(middle) > 0.5 * e else (middle, fast)
    yield (
        f"gravity lowers so small a restitution: e = {e:.3g} becomes {contact.restitution_at(1.0):.2g} at 1 m/s, and "
        f"less than half of it below {slow:.2g} m/s; give speed, that of the approach"
    )


def soft_caveats(contact: PairContact, model_k: float, thickness: float) -> Iterator[str]:
    """Where the stiffest contact that the step resolves is soft under the weight: against that of the model [N/m], and
    against the smallest half extent of the geoms [m]."""
    h, k = contact.timestep, contact.k
    if k < (1 - SCATTER_WARNED_OF) * model_k:
        yield (
            f"k = {k:.3g} N/m, the stiffest that a step of {h:g} s resolves, is softer than the contact that "
            f"the model had, {model_k:.3g} N/m under the weight, by a factor of {model_k / k:.2g}; "
            f"{rounded_down(h * math.sqrt(k / model_k))} s resolves as much"
        )
    if contact.depth > SOFT_DEPTH * thickness:
        resolving = h * math.sqrt(SOFT_DEPTH * thickness / contact.depth)
        yield (
            f"the weight presses the geoms into each other by {contact.depth:.2g} m with the stiffest contact that a "
            f"step of {h:g} s resolves, {contact.depth / thickness:.0%} of their smallest half extent; "
            f"{rounded_down(resolving)} s resolves a hundredth of it"
        )


def blow_caveats(contact: PairContact, pair: GeomPair) -> Iterator[str]:
    """Where a blow at the speed of the contact goes deeper than the smallest half extent of the geoms, as a sentence.
    A plane and a height field have no other side."""
    if contact.speed is None or pair.has_one_side:
        return
    pull = min(contact.gravity / (contact.frequency * contact.speed), MOST_PULL)
    thickness, h = pair.thickness, contact.timestep
    in_a_step = contact.speed * h
    depth = max(contact.speed / contact.frequency * deepest(min(contact.xi, 1e6), pull), in_a_step)
    if depth <= thickness:
        return
    k = 1.01 * contact.k * (depth / thickness) ** 2
    step = min(resolving_step(k, 2 * contact.xi * math.sqrt(k * contact.mass), contact.mass), h * thickness / in_a_step)
    yield (
        f"a blow at {contact.speed:g} m/s goes {depth:.2g} m deep, {depth / thickness:.2g} times the smallest half "
        "extent of the geoms, from where MuJoCo may push it out on the other side; "
        f"k = {k:.3g} N/m stops it within that, and {rounded_down(min(h, step))} s resolves it"
    )


def step_caveats(contact: PairContact) -> Iterator[str]:
    """The effect of a long step on the restitution, as a sentence."""
    h, omega = contact.timestep, contact.frequency
    longest = resolving_step(contact.k, contact.c, contact.mass)
    softer = f"or k = {rounded_down(0.999 * stiffest(h, contact.xi, contact.mass))} N/m at this step"
    if omega * h > UNSOUND:
        yield (
            f"timestep = {h:g} s does not resolve a contact of omega = {omega:.4g} rad/s: it rebounds with less than "
            f"0.6 whatever is requested; {rounded_down(longest)} s resolves it, {softer}"
        )
    elif h > longest:
        yield (
            f"timestep = {h:g} s is long for a contact of omega = {omega:.4g} rad/s and xi = {contact.xi:.3g}: the "
            f"restitution depends on where in a step the geoms touch; {rounded_down(longest)} s resolves it, {softer}"
        )


def missing(pair: GeomPair, contact: PairContact) -> Iterator[str]:
    """Parameters and options that `apply` would write and a model lacks, one sentence each."""
    option, mixed = pair.model.opt, PairParameters.from_pair(pair)
    names = ["solref", "solimp"] + (["friction"] if contact.condim > 1 else [])
    if pair.explicit < 0:
        yield "the model has no explicit <pair> of the geoms, so that MuJoCo mixes the parameters of the two geoms"
        if contact.condim > 1:
            yield "geoms have no solreffriction, so that sliding changes the normal force"
    elif contact.condim > 1:
        names.append("solreffriction")
    for name in (*names, "adhesion", "gap"):
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
        held = HOLDING_RATE * float(option.impratio) / contact.impratio
        yield (
            f"impratio = {option.impratio:g} is below {contact.impratio:g}: sliding changes the normal force, and a "
            f"load F that friction holds creeps at F / ({held:.2g} 1/s m)"
        )


def _pyramidal(pair: GeomPair, contact: PairContact) -> str:
    """The effect of the pyramidal cone on a contact: all numbers of the row grow, the mass and the step do not."""
    factor, h, d = (
        PairParameters.from_pair(pair).pyramid(float(pair.model.opt.impratio)),
        contact.timestep,
        contact.solimp[0],
    )
    dashpot = -contact.solref[1] / ((1 - d) * contact.inverse_weight)
    used = 0.0 if contact.integrator == "RK4" else 0.5 * h * dashpot
    inertia = factor * max(0.0, inertia_of(d, contact.inverse_weight) - used)
    text = f"makes stiffness and damping of a contact with friction {factor:.3g} times as large"
    if h * math.sqrt(factor * contact.k / (contact.mass + inertia)) <= GAINS_ENERGY_FROM:
        return text
    return f"{text}: the step is too long for it, and the contact can gain energy; set cone to elliptic"
