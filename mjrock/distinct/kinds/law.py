"""What all laws of joints beside the dry one have: a row for each contact line, and what a run requires of a law.

A contact line is dry: it has pressure and friction. A law adds forces to its lines, and takes over
those springs, dashpots and friction of theirs that it replaces. It is a class in a file of this folder. `LAWS` of
`lists` names the laws, and nothing else knows which there are.
"""

from __future__ import annotations

from collections import Counter
from typing import Any, ClassVar, Self

import numpy as np

from ...compiled import inlined
from ...problem.masonry.laws.bond import Bond
from ...problem.masonry.laws.joint_law import Law
from ...quantities import Array, Flags, Integers
from ...rows import Fields, Row, Rows, numbers, row_type, rows, vectors
from ...scene.scene import Scene
from ..system import Books, System

OF_A_LINE = (*Law._fields, "c_s", "margin", "shear_state")
"""Numbers of a contact line that a law can take over."""


class JointLaw:
    """A law of joints. It is a NamedTuple too, `link.Table` or one of its own, so that compiled loops know it.

    `act`, `stored`, `lost` and `holds` are compiled. The others have here what most laws need.

    Attributes:
        rows: a row for each line of the joints, with the numbers of `table` and `own_fields`; none where no joint has
            the law.
        bond: what a joint of masonry with this law has for its bond.
        endless: numbers of a row that may be infinite.
    """

    rows: Rows
    own_fields: ClassVar[Fields] = []
    bond: ClassVar[type[Bond]]
    endless: ClassVar[tuple[str, ...]] = ("k_s", "margin")

    @classmethod
    def table(cls, d: int, count: int) -> Rows:
        """Rows of a law in d directions, zero throughout."""
        fields = [
            *numbers(*OF_A_LINE[:-1]),  # of the dry line; k is 0 for a line without this law
            *numbers("share"),  # the line's part of the area of the joint [-]
            *numbers("gap", "push", "dashpot_force"),  # gap [m], force, and force of the dashpot, of the last step [N]
            *vectors(2 * d - 3, "shear_state", "shear_force"),  # stretch of the shear spring [m], its last force [N]
            *cls.own_fields,
        ]
        if twice := {name for name, repeats in Counter(name for name, *_ in fields).items() if repeats > 1}:
            raise TypeError(f"{cls.__name__} has {', '.join(sorted(twice))} as a number of a joint too; name one anew")
        return rows(row_type(fields), count)

    @classmethod
    def from_scene(cls, scene: Scene, lines: Rows) -> Self:
        """The law of the joints of a scene that have it, with the springs, dashpots and friction that it replaces."""
        contacts = scene.contacts
        joints = [i for i, bond in enumerate(contacts.bonds) if type(bond) is cls.bond]
        law = cls(cls.table(scene.bodies.rest.shape[1], len(lines) if joints else 0))  # type: ignore[call-arg]
        for i in joints:
            of_joint = contacts.joint == i
            area = np.asarray(contacts.area)[of_joint]
            for name in OF_A_LINE:
                law.rows[name][of_joint] = lines[name][of_joint]
            law.rows["share"][of_joint] = area / area.sum()
            law.begin(lines, of_joint, contacts.bonds[i], area)
        return law

    def begin(self, lines: Rows, of_joint: Flags, bond: Any, area: Array) -> None:
        """Write the numbers of the lines of one joint, and take over what the law replaces of theirs.

        Args:
            lines: all lines.
            of_joint: those of the joint, shape (lines,).
            bond: of the joint.
            area: of each of its lines [m2].
        """
        raise NotImplementedError

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Add the forces at the pose of time t [s], keep them as `push` and `shear_force`, and book what the last step,
        of length h, took."""
        raise NotImplementedError

    @inlined
    def stored(self) -> tuple[float, float]:
        """Energy that the law holds along the normals and along the faces [J]."""
        raise NotImplementedError

    @inlined
    def lost(self, row: Row) -> float:
        """Share of what the law holds that a line has lost [-]."""
        return 0.0

    @inlined
    def holds(self, row: Row) -> bool:
        """Whether a line still holds something beside friction. Its joint is then not handed over."""
        return bool(row.k > 0)

    def springs(self) -> dict[str, Array]:
        """The largest springs and dashpots of each line with this law, for the longest stable step: those of the dry
        line unless a law has others. By the names of its numbers, shape (lines,) each."""
        return {name: np.asarray(self.rows[name]) for name in ("k", "c", "k_s", "c_s")}

    def release(self, lines: Rows, released: Flags) -> None:
        """Give dry lines back what the law has taken over, where they are handed over."""
        released = released & (self.rows["k"] > 0)
        if not released.any():
            return
        for name in ("k", "c", "friction", "margin", "shear_state", "shear_force"):
            lines[name][released] = self.rows[name][released]
        for name in ("k", "shear_state", "shear_force", "push"):
            self.rows[name][released] = 0.0

    def contact_rows(self, joint: Integers, lines: Rows) -> Rows:
        """Rows for lines that are found where blocks are beyond their joints, none where the law ends with its joint.

        Args:
            joint: number of a joint of the two blocks of each, or -1.
            lines: with the springs of dry ones.
        """
        return self.rows[:0]

    def with_search_lines(self, count: int, kept: Flags, added: Rows) -> Self:
        """The law with these rows after those that are kept of the lines that are found, which follow those of joints.

        A law that ends with its joints has none."""
        return self

    @staticmethod
    def stiffest(laws: Rows, springs: dict[str, Array]) -> dict[str, Array]:
        """The largest springs and dashpots of lines that are found, from those of dry ones by name."""
        return springs

    @staticmethod
    def soften(laws: Rows, share: Array) -> None:
        """Reduce the law of found lines to a share, where the time step requires softer contacts [-]."""

    @staticmethod
    def set_secant_stiffness(laws: Rows, lines: Rows, depth: Array) -> None:
        """Give such lines the springs that the law has at some depths [m]."""

    def has_changed(self, bonds: tuple[Any, ...]) -> Flags:
        """Which lines remember something, by what each joint has for its bond, shape (rows,)."""
        return np.zeros(len(self.rows), dtype=bool)

    def resumed(self, from_rest: Self) -> Self:
        """The law with which a run starts that carries on the run of this one, beside that of a start from rest."""
        return self

    def cracked(self, scene: Scene) -> dict[str, float]:
        """When each joint that cracked did [s]."""
        return {}
