"""`contacts_for`: many contacts of a model at once, with one compilation, one `<option>` and one impratio."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from fnmatch import fnmatchcase
from typing import Any

import mujoco

from ..quantities import Array, named, short_repr, shown
from .contact import PairContact, Writing, document, options_of, spoilers, write
from .geoms import BODY, GEOM, GeomPair, compiled_model, geom_id, makes, names_of_objects
from .make import ContactRequest, beside, contact_of
from .meeting import Keyframe, Pose
from .notes import VARIES, ContactWarning
from .trial import solver_need

TAKES = tuple(field.name for field in fields(ContactRequest) if field.name != "timestep")
"""What can be asked of each contact."""
Geom = str | int


@dataclass(frozen=True)
class PairContacts:
    """Contacts of one model with one time step.

    Args:
        contacts: the contacts, in the order in which they were asked for.
    """

    contacts: tuple[PairContact, ...]

    __repr__ = short_repr

    def __iter__(self) -> Iterator[PairContact]:
        return iter(self.contacts)

    def __len__(self) -> int:
        return len(self.contacts)

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
        return document(self.contacts)

    @property
    def options(self) -> dict[str, Any]:
        """The attributes of `<option>` that the contacts need together, by name; see `PairContact.attributes`."""
        return options_of(self.contacts)

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
        write(self.contacts, model, Writing(on_geoms, keep_others, iterations, name_geoms))

    def caveats(self, model: mujoco.MjModel | mujoco.MjSpec, prefix: str = "") -> tuple[str, ...]:
        """What in a model keeps the contacts from being what they say, alike sentences once with the geoms that they
        are about; see `PairContact.caveats`."""
        whole = compiled_model(model)
        return tuple(_merged((contact, sentence) for contact in self for sentence in contact.caveats(whole, prefix)))

    def __str__(self) -> str:
        """A line for each contact."""
        return "\n".join(str(contact) for contact in self)


def contacts_for(
    model: mujoco.MjModel | mujoco.MjSpec,
    pairs: Mapping[tuple[Geom, Geom], Mapping[str, Any]],
    *,
    keyframe: Keyframe = None,
    qpos: Sequence[float] | Array | None = None,
    timestep: float | None = None,
) -> PairContacts:
    """Contacts of many geoms at once. A specification is compiled once.

    Args:
        model: a compiled model or a specification; it is not changed.
        pairs: what is asked of the contacts of two geoms, by their names or numbers: arguments of `contact_for` by
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
            none collide, or two geoms named twice without wildcards.

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
    meant: dict[frozenset[int], tuple[tuple[int, int], ContactRequest, bool]] = {}
    for key, values in pairs.items():
        asked = _asked(key, values, timestep)
        for geoms in _meant(whole, key):
            if not meant.get(frozenset(geoms), (geoms, asked, True))[2]:
                raise ValueError(f"pairs name the geoms {GeomPair(whole, geoms).labels} twice, last by {shown(key)}")
            meant[frozenset(geoms)] = geoms, asked, any(map(_is_wild, key))
    if not meant:
        raise ValueError(f"pairs = {shown(pairs)} name no contact; at least one is needed")
    found = [contact_of(GeomPair.named(whole, *geoms), pose, asked) for geoms, asked, _ in meant.values()]
    made = {frozenset(contact.ids): contact for contact, _ in found}
    needs = solver_need(whole, pose, list(made.values()))
    contacts = PairContacts(tuple(replace(beside(contact, company, made), needs=needs) for contact, company in found))
    sentences = [
        (contact, sentence)
        for contact in contacts
        for sentence in (*spoilers(GeomPair(whole, contact.ids), contact), *contact.remarks)
    ]
    for sentence in _merged(sentences):
        warnings.warn(sentence, ContactWarning, stacklevel=2)
    return contacts


def _asked(key: object, values: object, timestep: object) -> ContactRequest:
    if not isinstance(key, tuple) or len(key) != 2:
        raise TypeError(f"pairs have the key {shown(key)}; it has to be two geoms, such as ('foot*', 'floor')")
    if not isinstance(values, Mapping):
        raise TypeError(f"pairs of {shown(key)} = {shown(values)} has to be arguments of contact_for by name")
    unknown = [str(name) for name in values if name not in TAKES]
    if unknown:
        raise ValueError(f"pairs of {shown(key)} have {named(unknown)}; each takes {', '.join(TAKES)}")
    return ContactRequest(**values, timestep=timestep)


def _meant(model: mujoco.MjModel, key: tuple[object, object]) -> Iterator[tuple[int, int]]:
    """The numbers of the geoms that a key names. Of wildcards they are those that MuJoCo lets collide."""
    firsts, seconds = (
        _matching(model, argument, value) for argument, value in zip(("geom1", "geom2"), key, strict=True)
    )
    if not any(map(_is_wild, key)):
        yield firsts[0], seconds[0]
        return
    found: dict[frozenset[int], tuple[int, int]] = {}
    for geoms in itertools.product(firsts, seconds):
        if frozenset(geoms) not in found and makes(GeomPair(model, geoms)):
            found[frozenset(geoms)] = geoms
    if not found:
        raise ValueError(
            f"pairs of {shown(key)} are geoms that MuJoCo keeps apart, by contype and conaffinity, <exclude>, or as "
            "one body or parent and child; names without wildcards override that"
        )
    yield from found.values()


def _is_wild(name: object) -> bool:
    """Whether a name has wildcards."""
    return isinstance(name, str) and any(mark in name for mark in "*?[")


def _matching(model: mujoco.MjModel, argument: str, value: object) -> list[int]:
    """The numbers of the geoms that a name with wildcards means."""
    if not isinstance(value, str) or not _is_wild(value):
        return [geom_id(model, argument, value)]
    geoms = names_of_objects(model, GEOM)
    found = [i for i, name in enumerate(geoms) if name and fnmatchcase(name, value)]
    if not found:
        alike = (i for i, name in enumerate(names_of_objects(model, BODY)) if fnmatchcase(name, value))
        found = [int(model.body_geomadr[i]) for i in alike if model.body_geomnum[i] == 1]
    if not found:
        known = named([name for name in geoms if name]) or "none"
        raise ValueError(
            f"{argument} = {shown(value)} matches no geom, nor a body with a single one; geoms are: {known}"
        )
    return found


def _merged(sentences: Iterable[tuple[PairContact, str]]) -> Iterator[str]:
    """Sentences that are alike once, with the geoms that they are about. The first of several with other numbers or
    names is given in full."""
    alike: dict[str, dict[str, list[str]]] = {}
    for contact, sentence in sentences:
        alike.setdefault(VARIES.sub("#", sentence), {}).setdefault(sentence, []).append(contact.label)
    for (sentence, about), *others in (each.items() for each in alike.values()):
        rest = list(dict.fromkeys(label for _, labels in others for label in labels))
        yield f"{named(about)}: {sentence}" + (f" [and alike for {named(rest)}]" if rest else "")
