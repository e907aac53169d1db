"""The keywords of joints, which masonry and all its builders take."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable
from functools import wraps
from typing import TypedDict, TypeVar

from ....quantities import within_ranges
from ...damping.contacts import AnyLaw
from .dry import Properties
from .joint_table import PROPERTIES, AnyJoints, OfBond, OfCount, OfJoint, properties_of
from .pairs import AnyPairs

Class = TypeVar("Class", bound=type)


class OtherOptions(TypedDict, total=False):
    """Keywords of `Masonry` beside `k_n`, see `JointOptions`."""

    joints: AnyJoints | None
    friction: OfJoint | None
    xi: OfJoint | None
    k_s: OfJoint | None
    frequency: OfJoint | None
    points: OfCount | None
    bond: OfBond
    law: AnyLaw | str | None
    tolerance: float
    pairs: AnyPairs


class JointOptions(OtherOptions, total=False):
    """Keywords of `Masonry` that its builders hand on: `joints`, or the properties of joints one by one, and the rest.

    What they mean is said at `Masonry`. None takes the usual one.
    """

    k_n: OfJoint | None


def one_by_one(options: JointOptions) -> Properties:
    """The keywords with the properties of joints one by one in the place of `joints`."""
    given = Properties(options)
    properties = {name: given.pop(name, None) for name in PROPERTIES}
    return properties_of(given.pop("joints", None), properties) | given


def keywords_checked(kind: Class) -> Class:
    """A class whose constructors refuse a keyword that they do not take, with the nearest one that they do."""
    for name, member in list(vars(kind).items()):
        if name == "__init__":
            setattr(kind, name, _checked(member, kind.__name__))
        elif isinstance(member, classmethod) and not name.startswith("_"):
            setattr(kind, name, classmethod(_checked(member.__func__, f"{kind.__name__}.{name}")))
    return kind


def _checked(function: Callable[..., object], said: str) -> Callable[..., object]:
    parameters = list(inspect.signature(function).parameters.values())[1:]
    known = [each.name for each in parameters if each.kind is not each.VAR_KEYWORD]
    if len(known) < len(parameters):
        known += [name for name in JointOptions.__annotations__ if name not in known]

    run = within_ranges(function)

    @wraps(function)
    def called(*given: object, **options: object) -> object:
        for each in sorted(options.keys() - set(known)):
            near = difflib.get_close_matches(each, known, 2)
            remedy = f"did you mean {' or '.join(near)}?" if near else f"the valid keywords are {', '.join(known)}"
            raise TypeError(f"{said} does not take {each}; {remedy}")
        return run(*given, **options)

    return called
