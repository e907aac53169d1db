"""Properties of joints as they are given: one for all, a function of the joint, or what such a function is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from ....quantities import declared, require_kind, shown
from ..blocks.joints import Joint
from ..blocks.joints_in_space import SpaceJoint
from .bond import Bond
from .dry import Dry, Mortar, Properties

AnyJoint = Joint | SpaceJoint
T = TypeVar("T")
FunctionOfJoint = Callable[[Any], T]
OfJoint = float | FunctionOfJoint[float]
"""A number, or a function of the joint that gives one."""
OfCount = int | FunctionOfJoint[int]
"""A whole number, or a function of the joint that gives one."""
OfBond = Bond | FunctionOfJoint[Bond | None] | None
"""A bond, a function of the joint that gives one or None where the joint is dry, or None where all are dry."""
AnyJoints = Dry | Mortar | FunctionOfJoint[Dry | Mortar]
"""What all joints of masonry are, or a function of the joint that says what it is."""
PROPERTIES = tuple(Dry().properties)
"""Names of what a joint has, which are keywords of `Masonry` too."""


def asked(name: str, given: FunctionOfJoint[T], joint: AnyJoint) -> T:
    """What a function of the joint gives for one, or a TypeError that says how it is called."""
    try:
        return given(joint)
    except TypeError as error:
        raise TypeError(f"{name} = {shown(given)} is not called as {name}(joint): {error}") from None


def properties_of(joints: AnyJoints | None, given: Properties) -> Properties:
    """The properties of joints by name, a number or a function of the joint each.

    Args:
        joints: what all joints are, or a function of the joint that gives it, or None.
        given: the properties that are given by keyword instead; None takes that of a `Dry`.

    Raises:
        TypeError: for another kind.
        ValueError: for a number outside its range, or where both are given.
    """
    named = {name: value for name, value in given.items() if value is not None}
    if joints is None:
        ranges = declared(Dry)
        return Dry().properties | {
            name: value if callable(value) or name not in ranges else ranges[name][0].checked(name, value)
            for name, value in named.items()
        }
    if named:
        raise ValueError(f"joints is given with {', '.join(named)}, which it says itself; give one or the other")
    if callable(joints):
        choice = Choice(joints)
        return {name: Chosen(choice, name) for name in PROPERTIES}
    require_kind("joints", joints, Dry, Mortar)
    return joints.properties


@dataclass(frozen=True)
class Choice:
    """A function of the joint that gives what it is, which is asked once of each joint."""

    function: FunctionOfJoint[Dry | Mortar]
    known: dict[AnyJoint, Properties] = field(default_factory=dict, compare=False, repr=False)

    def __call__(self, joint: AnyJoint) -> Properties:
        """The properties of a joint by name."""
        if joint not in self.known:
            chosen = asked("joints", self.function, joint)
            require_kind(f"joints of {joint.name}", chosen, Dry, Mortar)
            self.known[joint] = chosen.properties
        return self.known[joint]


@dataclass(frozen=True)
class Chosen:
    """One property of what a function of the joint gives."""

    choice: Choice
    name: str

    def __call__(self, joint: AnyJoint) -> Any:
        """The value of a joint."""
        return self.choice(joint)[self.name]


@dataclass(frozen=True)
class ByKind:
    """A property of bed joints, and another of those that are not horizontal, a number or a function of the joint."""

    beds: OfJoint
    others: OfJoint

    def __call__(self, joint: AnyJoint) -> float:
        """The value of a joint."""
        given = self.beds if joint.is_bed else self.others
        return given(joint) if callable(given) else given


@dataclass(frozen=True)
class ByName:
    """A property of each joint by its name, as pairs of a name and a value.

    Unlike a function it has content, by which masonry can be compared and a campaign can tell its tasks apart.
    """

    values: tuple[tuple[str, float], ...]

    def __call__(self, joint: AnyJoint) -> float:
        """The value of a joint; a ValueError says if it has none."""
        for name, value in self.values:
            if name == joint.name:
                return value
        names = ", ".join(name for name, _ in self.values)
        raise ValueError(f"the joint {joint.name} has no value among those of {names}")


@dataclass(frozen=True)
class OrElse:
    """A function of the joint, and a number that stands where it gives None."""

    given: FunctionOfJoint[float | None]
    otherwise: float

    def __call__(self, joint: AnyJoint) -> float:
        """The value of a joint."""
        value = self.given(joint)
        return self.otherwise if value is None else value


@dataclass(frozen=True)
class Halved:
    """Bonds of a wall of divided units: `between` them, one or a function of the joint, and `within` them."""

    between: OfBond
    within: Bond

    def __call__(self, joint: AnyJoint) -> Bond | None:
        """The bond of a joint."""
        first, second = joint.name.split("|")
        if first[:-1] == second[:-1] and first[-1] + second[-1] == "ab":
            return self.within
        return self.between(joint) if callable(self.between) else self.between
