"""Properties of joints: one number for all of them, a function of the joint, or values by kind and by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .joints import Joint

OfJoint = float | Callable[[Joint], float]
"""A number, or a function of the joint that gives one."""


def value_of(given: OfJoint, joint: Joint) -> float:
    """The value that a joint has."""
    return given(joint) if callable(given) else given


@dataclass(frozen=True)
class ByKind:
    """A property that bed joints have, and another for the joints that are not horizontal.

    Args:
        beds, others: a number each, or a function of the joint.
    """

    beds: OfJoint
    others: OfJoint

    def __call__(self, joint: Joint) -> float:
        """The value of a joint."""
        return value_of(self.beds if joint.is_bed else self.others, joint)


@dataclass(frozen=True)
class ByName:
    """A property of each joint by its name.

    Unlike a function it has content, by which masonry can be compared and a campaign can tell its tasks apart.

    Args:
        values: pairs of a name and a value.
    """

    values: tuple[tuple[str, float], ...]

    def __call__(self, joint: Joint) -> float:
        """The value of a joint.

        Raises:
            ValueError: for a joint that has none.
        """
        for name, value in self.values:
            if name == joint.name:
                return value
        raise ValueError(
            f"the joint {joint.name} has no value among those of {', '.join(name for name, _ in self.values)}"
        )
