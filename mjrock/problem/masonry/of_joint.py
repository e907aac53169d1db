"""Properties of joints: one number for all of them, a function of the joint, or values by kind and by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ...quantities import Array, require_whole, require_within, shown
from .joints import Joint
from .joints_in_space import SpaceJoint

AnyJoint = Joint | SpaceJoint
T = TypeVar("T")
FunctionOfJoint = Callable[[Any], T]
OfJoint = float | FunctionOfJoint[float]
"""A number, or a function of the joint that gives one."""
RANGES = {
    "k_n": (1e4, 1e14, "N/m3"),
    "friction": (0.0, 10.0, ""),
    "xi": (0.0, 100.0, ""),
    "k_s": (1e4, 1e16, "N/m3"),
    "frequency": (1e-3, 1e9, "rad/s"),
}
"""Lowest and highest value of the properties of a joint, and their unit."""
WITHOUT = {"k_s": np.inf, "frequency": np.nan}
"""What stands for None in a table: a joint that sticks rigidly, and the lowest frequency of the masonry."""
LEAST_LINES, MOST_LINES = 2, 1000
"""Fewest and most contact lines of a joint."""


def required_number(name: str, value: object) -> float | None:
    """A property of a joint, a number within its range; k_s and frequency may be None."""
    if name == "points":
        return require_whole(name, value, LEAST_LINES, MOST_LINES)
    return None if value is None and name in WITHOUT else require_within(name, value, *RANGES[name])


def asked(name: str, given: FunctionOfJoint[T], joint: AnyJoint) -> T:
    """What a function of the joint gives for one, or a TypeError that says how it is called."""
    try:
        return given(joint)
    except TypeError as error:
        raise TypeError(f"{name} = {shown(given)} is not called as {name}(joint): {error}") from None


def values_of(name: str, given: OfJoint | None, joints: Sequence[AnyJoint]) -> Array:
    """A property of each joint, with what stands for None, shape (joints,)."""
    if not callable(given):
        return np.full(len(joints), WITHOUT[name] if given is None else given)
    values = [asked(name, given, joint) for joint in joints]
    return np.array(
        [
            WITHOUT[name]
            if value is None and name in WITHOUT
            else require_within(f"{name} of {joint.name}", value, *RANGES[name])
            for joint, value in zip(joints, values, strict=True)
        ]
    )


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


def required_points(given: int | FunctionOfJoint[int], joints: Sequence[AnyJoint], most: int) -> int:
    """The contact lines of all joints, up to the most that they may have; a ValueError names joints that differ."""
    if not callable(given):
        return require_whole("points", given, LEAST_LINES, most)
    first, *others = [(joint.name, given(joint)) for joint in joints]
    for name, points in others:
        if points != first[1]:
            raise ValueError(
                f"points = {first[1]} of {first[0]} and {points} of {name}: all joints of masonry have as many"
            )
    return require_whole("points", first[1], LEAST_LINES, most)
