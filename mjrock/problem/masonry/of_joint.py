"""Properties of joints: one number for all of them, a function of the joint, or values by kind and by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...quantities import Array, require_within, shown
from .joints import Joint
from .joints_in_space import SpaceJoint

OfJoint = float | Callable[[Any], float]
"""A number, or a function of the joint that gives one."""
OF_JOINTS = {
    "k_n": (1e4, 1e14, "N/m3"),
    "friction": (0.0, 10.0, ""),
    "xi": (0.0, 100.0, ""),
    "k_s": (1e4, 1e16, "N/m3"),
}
"""Lowest and highest value of the properties of a joint, and their unit."""


def required(name: str, given: OfJoint) -> OfJoint:
    """A property of joints, a number as a float within its range, or a function as it is; k_s may be None."""
    if callable(given) or (name == "k_s" and given is None):
        return given
    return require_within(name, given, *OF_JOINTS[name])


def values_of(name: str, given: OfJoint | None, joints: Sequence[Joint | SpaceJoint]) -> Array:
    """A property of each joint, infinite where None is given, shape (joints,)."""
    if not callable(given):
        return np.full(len(joints), np.inf if given is None else given)
    values = []
    for joint in joints:
        try:
            values.append(given(joint))
        except TypeError as error:
            raise TypeError(f"{name} = {shown(given)} is not called as {name}(joint): {error}") from None
    pairs = zip(joints, values, strict=True)
    return np.array([require_within(f"{name} of {joint.name}", value, *OF_JOINTS[name]) for joint, value in pairs])


@dataclass(frozen=True)
class ByKind:
    """A property of bed joints, and another of those that are not horizontal, a number or a function of the joint."""

    beds: OfJoint
    others: OfJoint

    def __call__(self, joint: Joint | SpaceJoint) -> float:
        """The value of a joint."""
        given = self.beds if joint.is_bed else self.others
        return given(joint) if callable(given) else given


@dataclass(frozen=True)
class ByName:
    """A property of each joint by its name, as pairs of a name and a value.

    Unlike a function it has content, by which masonry can be compared and a campaign can tell its tasks apart.
    """

    values: tuple[tuple[str, float], ...]

    def __call__(self, joint: Joint | SpaceJoint) -> float:
        """The value of a joint; a ValueError says if it has none."""
        for name, value in self.values:
            if name == joint.name:
                return value
        names = ", ".join(name for name, _ in self.values)
        raise ValueError(f"the joint {joint.name} has no value among those of {names}")
