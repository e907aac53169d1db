"""The table of the joints of masonry: a row a joint, a column a property."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....quantities import Array, declared, require_kind
from .bond import Bond
from .dry import Dry, Properties
from .of_joint import AnyJoint, OfBond, OfJoint, asked

WITHOUT = {"k_s": np.inf, "frequency": np.nan}
"""What stands for None in a table: a joint that sticks rigidly, and the lowest frequency of the masonry."""


class JointTable(NamedTuple):
    """Properties of the joints of masonry.

    Args:
        k_n, k_s: stiffness along the normal and along the face [N/m3], k_s infinite for a joint that sticks rigidly,
            shape (joints,) each.
        friction: coefficient [-], shape (joints,).
        xi: damping ratio [-], shape (joints,).
        frequency: to which it refers [rad/s], NaN for the lowest one of the masonry, shape (joints,).
        bonds: what mortar holds, None where a joint is dry.
    """

    k_n: Array
    k_s: Array
    friction: Array
    xi: Array
    frequency: Array
    bonds: tuple[Bond | None, ...]

    @classmethod
    def of(cls, joints: Sequence[AnyJoint], given: Properties) -> JointTable:
        """The table of joints from their properties, a number or a function of the joint each.

        Raises:
            TypeError, ValueError: with the name of the joint, for a value outside its range or a bond that its springs
                cannot have.
        """
        columns = {name: _values(name, given[name], joints) for name in ("k_n", "k_s", "friction", "xi", "frequency")}
        table = cls(**columns, bonds=_bonds(given["bond"], joints))
        springs = zip(table.k_n.tolist(), table.k_s.tolist(), table.friction.tolist(), strict=True)
        for joint, bond, (k_n, k_s, friction) in zip(joints, table.bonds, springs, strict=True):
            if bond is not None:
                bond.require_fit(joint.name, k_n, k_s, friction, given["points"])
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
