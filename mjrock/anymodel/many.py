"""`contacts_for`: many contacts of a model at once, with one compilation, one `<option>` and one impratio."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from fnmatch import fnmatchcase
from typing import Any

import mujoco

from ..quantities import Array, named, shown
from .contact import PairContact, document, write
from .geoms import BODY, GEOM, GeomPair, compiled, geom_id, names_of
from .make import Asked, contact_of
from .meeting import Pose
from .notes import spoilers

TAKES = tuple(field.name for field in fields(Asked) if field.name != "timestep")
"""What can be asked of each contact."""
Geom = str | int


@dataclass(frozen=True)
class PairContacts:
    """Contacts of one model with one time step.

    Args:
        contacts: the contacts, in the order in which they were asked for.
    """

    contacts: tuple[PairContact, ...]

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

    def apply(self, model: mujoco.MjModel | mujoco.MjSpec, *, on_geoms: bool = False) -> None:
        """Write the contacts into a model, with the options that they need; see `PairContact.apply`."""
        write(self.contacts, model, on_geoms)

    def caveats(self, model: mujoco.MjModel | mujoco.MjSpec) -> tuple[str, ...]:
        """What in a model keeps the contacts from being what they say, one sentence each with the geoms it is about."""
        whole = compiled(model)
        return tuple(_merged((contact, sentence) for contact in self for sentence in contact.caveats(whole)))


def contacts_for(
    model: mujoco.MjModel | mujoco.MjSpec,
    pairs: Mapping[tuple[Geom, Geom], Mapping[str, Any]],
    *,
    keyframe: str | int | None = None,
    qpos: Sequence[float] | Array | None = None,
    timestep: float | None = None,
) -> PairContacts:
    """Contacts of many geoms at once. A specification is compiled once.

    Args:
        model: a compiled model or a specification; it is not changed.
        pairs: what is asked of the contacts of two geoms, by their names or numbers: arguments of `contact_for` by
            name, such as `{("foot*", "floor"): {"k": 5e4, "restitution": 0.2}}`. Names may have the wildcards `*`, `?`
            and `[...]`. They are looked for among the geoms, and where none has it among the bodies with one geom.
        keyframe, qpos: the pose in which all of them meet; see `contact_for`.
        timestep: MuJoCo's step [s], positive. None takes the model's.

    Returns:
        The contacts, with ``.xml``, `.apply(model)` and `.caveats(model)` of them all.

    Raises:
        TypeError, ValueError: as `contact_for` does, and for names that nothing has, or two geoms named twice.

    Warns:
        UserWarning: as `contact_for` does, each sentence once, with the geoms that it is about.
    """
    whole = compiled(model)
    if not isinstance(pairs, Mapping):
        raise TypeError(
            f"pairs = {shown(pairs)} has to be a dictionary, such as "
            '{("foot*", "floor"): {"k": 5e4, "restitution": 0.2}}'
        )
    pose = Pose(whole, keyframe, qpos)
    contacts: dict[frozenset[int], PairContact] = {}
    for key, values in pairs.items():
        asked = _asked(key, values, timestep)
        for geoms in _meant(whole, key):
            if frozenset(geoms) in contacts:
                raise ValueError(f"pairs name the geoms {GeomPair(whole, geoms).labels} twice, last by {shown(key)}")
            contacts[frozenset(geoms)] = contact_of(GeomPair.named(whole, *geoms), pose, asked)
    if not contacts:
        raise ValueError(f"pairs = {shown(pairs)} name no contact; at least one is needed")
    sentences = [
        (contact, sentence)
        for contact in contacts.values()
        for sentence in (*spoilers(GeomPair(whole, contact.ids), contact), *contact.remarks)
    ]
    for sentence in _merged(sentences):
        warnings.warn(sentence, stacklevel=2)
    return PairContacts(tuple(contacts.values()))


def _asked(key: object, values: object, timestep: object) -> Asked:
    if not isinstance(key, tuple) or len(key) != 2:
        raise TypeError(f"pairs have the key {shown(key)}; it has to be two geoms, such as ('foot*', 'floor')")
    if not isinstance(values, Mapping):
        raise TypeError(f"pairs of {shown(key)} = {shown(values)} has to be arguments of contact_for by name")
    unknown = [str(name) for name in values if name not in TAKES]
    if unknown:
        raise ValueError(f"pairs of {shown(key)} have {named(unknown)}; each takes {', '.join(TAKES)}")
    return Asked(**values, timestep=timestep)


def _meant(model: mujoco.MjModel, key: tuple[object, object]) -> Iterator[tuple[int, int]]:
    """The numbers of the geoms that a key names. Geoms of wildcards that cannot meet are left out."""
    firsts, seconds = (
        _matching(model, argument, value) for argument, value in zip(("geom1", "geom2"), key, strict=True)
    )
    seen = set()
    for first in firsts:
        for second in seconds:
            pair = GeomPair(model, (first, second))
            several = len(firsts) + len(seconds) > 2
            if several and (first == second or pair.bodies[0] == pair.bodies[1] or not pair.inverse_weight > 0):
                continue
            if frozenset((first, second)) not in seen:
                seen.add(frozenset((first, second)))
                yield first, second


def _matching(model: mujoco.MjModel, argument: str, value: object) -> list[int]:
    """The numbers of the geoms that a name with wildcards means."""
    if not isinstance(value, str) or not any(mark in value for mark in "*?["):
        return [geom_id(model, argument, value)]
    geoms = names_of(model, GEOM)
    found = [i for i, name in enumerate(geoms) if name and fnmatchcase(name, value)]
    if not found:
        alike = (i for i, name in enumerate(names_of(model, BODY)) if fnmatchcase(name, value))
        found = [int(model.body_geomadr[i]) for i in alike if model.body_geomnum[i] == 1]
    if not found:
        known = named([name for name in geoms if name]) or "none"
        raise ValueError(
            f"{argument} = {shown(value)} matches no geom, nor a body with a single one; geoms are: {known}"
        )
    return found


def _merged(sentences: Any) -> Iterator[str]:
    """Each sentence once, behind the geoms that it is about."""
    about: dict[str, list[str]] = {}
    for contact, sentence in sentences:
        first, second = (
            name or f"[{number}]" for name, number in zip((contact.geom1, contact.geom2), contact.ids, strict=True)
        )
        about.setdefault(sentence, []).append(f"{first} on {second}")
    for sentence, pairs in about.items():
        yield f"{named(pairs)}: {sentence}"
