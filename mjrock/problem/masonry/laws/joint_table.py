"""The table of the joints of masonry: a row a joint, a column a property."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....quantities import Array, Integers, Within, declared, require_kind
from ..blocks.joints_in_space import SpaceJoint
from .bond import Bond
from .dry import Dry, Properties
from .of_joint import AnyJoint, OfBond, OfJoint, asked

WITHOUT = {"k_s": np.inf, "frequency": np.nan}
"""What stands for None in a table: a joint that sticks rigidly, and the lowest frequency of the masonry."""


IN_SPACE = Within(2, 50, whole=True)
"""Valid `points` of a joint in space. In the plane they are those of `Dry`."""


class JointTable(NamedTuple):
    """Properties of the joints of masonry.

    Args:
        k_n, k_s: stiffness along the normal and along the face [N/m3], k_s infinite for a joint that sticks rigidly,
            shape (joints,) each.
        friction: coefficient [-], shape (joints,).
        xi: damping ratio [-], shape (joints,).
        frequency: to which it refers [rad/s], NaN for the lowest one of the masonry, shape (joints,).
        points: contact lines, shape (joints,).
        bonds: what mortar holds, None where a joint is dry.
    """

    k_n: Array
    k_s: Array
    friction: Array
    xi: Array
    frequency: Array
    points: Integers
    bonds: tuple[Bond | None, ...]

    @classmethod
    def of(cls, joints: Sequence[AnyJoint], given: Properties) -> JointTable:
        """The table of joints from their properties, a number or a function of the joint each.

        Raises:
            TypeError, ValueError: with the name of the joint, for a value outside its range or a bond that its springs
                cannot have.
        """
        columns = {name: _values(name, given[name], joints) for name in ("k_n", "k_s", "friction", "xi", "frequency")}
        points = _values("points", given["points"], joints).astype(int)
        for joint, count in zip(joints, points.tolist(), strict=True):
            if isinstance(joint, SpaceJoint):
                IN_SPACE.checked(f"points of {joint.name}" if callable(given["points"]) else "points", count)
        table = cls(**columns, points=points, bonds=_bonds(given["bond"], joints))
        springs = (column.tolist() for column in (table.k_n, table.k_s, table.friction, points))
        for joint, bond, *numbers in zip(joints, table.bonds, *springs, strict=True):
            if bond is not None:
                bond.require_fit(joint.name, *numbers)
        return table

    @property
    def residual_friction(self) -> Array:
        """Coefficient of friction of joints that have lost their bond [-], shape (joints,)."""
        given = [bond and bond.residual_friction for bond in self.bonds]
        return np.array([most if least is None else least for least, most in zip(given, self.friction, strict=True)])


def _values(name: str, given: OfJoint | None, joints: Sequence[AnyJoint]) -> Array:
    """A property of each joint, with what stands for None, shape (joints,)."""
    if not callable(given):
        return np.full(len(joints), WITHOUT[name] if given is None else given)
    (within, optional), values = declared(Dry)[name], [asked(name, given, joint) for joint in joints]
    pairs = zip(joints, values, strict=True)
    return np.array(
        [
            WITHOUT[name] if optional and value is None else within.checked(f"{name} of {joint.name}", value)
            for joint, value in pairs
        ]
    )


def _bonds(given: OfBond, joints: Sequence[AnyJoint]) -> tuple[Bond | None, ...]:
    """The bond of each joint, None where it is dry."""
    found = []
    for joint in joints:
        bond = asked("bond", given, joint) if callable(given) else given
        require_kind(f"bond of {joint.name}" if callable(given) else "bond", bond, Bond, type(None))
        found.append(None if bond is None or bond.is_dry else bond)
    return tuple(found)
