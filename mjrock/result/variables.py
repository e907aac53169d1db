"""A response as arrays with dimensions, units and descriptions, for files and for xarray."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..quantities import Array
from .forces import Forces
from .joint_motion import JointMotion
from .ledger import Ledger
from .origin import sources
from .rocking import Impact, Rocking
from .tree import Tree, Writer, unit_and_text

STATE_ENERGY = ("kinetic", "potential", "elastic")
"""Accounts of a ledger that are energies of the bodies."""


class Variable(NamedTuple):
    """An array of a response.

    Args:
        dims: names of its dimensions.
        values: the numbers, or texts.
        units: in SI, such as "m"; of several coordinates one after the other.
        text: what it is.
    """

    dims: tuple[str, ...]
    values: Array
    units: str
    text: str


def variables_of(answer: Any) -> dict[str, Variable]:
    """The arrays of a `Response` by name, those that number the dimensions first.

    They are the arrays of the response themselves, and not copies, where it has them as arrays.
    """
    variables = dict[str, Variable]()
    for name, variable in (
        *_coordinates(answer),
        *_motion_variables(answer),
        *_force_variables(answer.kept_forces),
        *_ledger_variables(answer.ledger),
    ):
        variables[_unused_name(re.sub(r"[/\0]", "_", name), variables)] = variable
    return variables


def attributes_of(answer: Any) -> dict[str, str]:
    """Attributes of a file that describe a response as a whole, by name."""
    origin, ground = answer.origin, sources(answer.case)
    attributes = {
        "title": repr(answer),
        "solver": answer.solver,
        "outcome": answer.outcome.value,
        "message": answer.message,
    }
    attributes |= {"mjrock_version": origin.version, "machine": origin.machine} if origin is not None else {}
    return attributes | {f"ground_{name}": text for name, text in ground.items()}


def record_of(answer: Any) -> dict[str, Tree]:
    """Record of a response in files of other programs: what `attributes_of` gives, its case and its origin, see `tree`,
    with all their numbers."""
    writer = Writer()
    return attributes_of(answer) | {name: writer.tree(getattr(answer, name), name) for name in ("case", "origin")}


def _unused_name(name: str, taken: Mapping[str, object]) -> str:
    """The name, with a number behind it where it is taken."""
    number, free = 2, name
    while free in taken:
        free, number = f"{name}_{number}", number + 1
    return free


def _coordinates(answer: Any) -> Iterator[tuple[str, Variable]]:
    """The times, and names of the elements along the other dimensions."""
    yield "t", Variable(("t",), answer.t, "s", "time")
    yield _names("body", answer.bodies, "name of a body that moves")
    pose = rates = ["x", "z", "theta"]
    if answer.in_space:
        pose = [*"xyz", *(f"quaternion {part}" for part in "wxyz")]
        rates = [*"xyz", *(f"spin {axis}" for axis in "xyz")]
    yield _names("coordinate", pose, "displacement from rest along an axis, and rotation")
    yield _names("rate", rates, "velocity along an axis, and angular velocity")
    if answer.joints is not None:
        yield _names("joint", [joint.name for joint in answer.case.masonry.joints], "name of a joint")
    elif answer.kept_forces is not None:
        yield _names("joint", answer.kept_forces.joints, "name of a joint")


def _names(dim: str, names: Iterable[object], text: str) -> tuple[str, Variable]:
    """A dimension, and the names of the elements along it."""
    return dim, Variable((dim,), np.array([str(name) for name in names], dtype=object), "", text)


def _motion_variables(answer: Any) -> Iterator[tuple[str, Variable]]:
    """Motion, impacts or joints, actuators and the ground."""
    units = ("m m m - - - -", "m/s m/s m/s rad/s rad/s rad/s") if answer.in_space else ("m m rad", "m/s m/s rad/s")
    moved = "displacement of each centroid from the undeformed contacts, and rotation from rest"
    yield "pose", Variable(("t", "body", "coordinate"), answer.pose, units[0], moved)
    yield "velocity", Variable(("t", "body", "rate"), answer.velocity, units[1], "rate of the pose")
    yield "energy", Variable(("t",), answer.energy, "J", "kinetic, potential and elastic energy above rest")
    for name, motion in answer.case.grounds.items():
        description = f"acceleration of the ground, {'horizontal' if name == 'motion' else name}"
        yield f"ground_{name}", Variable(("t",), motion(answer.t), "m/s2", description)
    for name, force in answer.actuators.items():
        yield f"actuator {name}", Variable(("t",), force, "N", "force of an actuator along its direction")
    if answer.rocking is not None:
        yield "peaks", _described_variable(Rocking, "peaks", ("peak",), answer.rocking.peaks)
        for name in Impact._fields:
            values = np.array([getattr(impact, name) for impact in answer.rocking.impacts])
            yield f"impact_{name}", _described_variable(Impact, name, ("impact",), values)
    if answer.joints is not None:
        for name in ("opening", "sliding"):
            yield name, _described_variable(JointMotion, name, ("joint",), getattr(answer.joints, name))


def _force_variables(forces: Forces | None) -> Iterator[tuple[str, Variable]]:
    """What `forces` and `reactions` give."""
    if forces is None:
        return
    for name in ("normal", "shear", "eccentricity", "moment", "damage"):
        values = getattr(forces, name)
        apart = (f"part_of_{name}",) if values.ndim == 3 else ()
        yield name, _described_variable(Forces, name, ("t", "joint", *apart), values)
    for name in ("reactions", "guides"):
        for block, values in getattr(forces, name).items():
            yield f"{name} {block}", _described_variable(Forces, name, ("t", f"part_of_{name}"), values)
    for link, values in forces.links.items():
        yield f"pull of {link}", _described_variable(Forces, "links", ("t",), values)


def _ledger_variables(ledger: Ledger | None) -> Iterator[tuple[str, Variable]]:
    """Every part of the energy."""
    if ledger is None:
        return
    for name in (*STATE_ENERGY, "friction", "ground"):
        yield f"ledger {name}", _described_variable(Ledger, name, ("t",), getattr(ledger, name))
    for account in ("dashpots", "actuators", "ties", "broken", "ends", "bonds"):
        for name, values in getattr(ledger, account).items():
            yield f"ledger {account} {name}", _described_variable(Ledger, account, ("t",), values)


def _described_variable(kind: type, name: str, dims: tuple[str, ...], values: Array) -> Variable:
    unit, text = unit_and_text(kind, name)
    return Variable(dims, values, unit or "-", text or name)
