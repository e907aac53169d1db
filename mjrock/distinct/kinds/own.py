"""Own laws of joints, see `own_law`: a class of a user's file gives the stress of each line.

A law that only presses sets the spring of its line at each pose: `k` is the secant stiffness, and `k_excess` what a
linear spring of the same energy has beyond it. Friction, dashpots, touches and the ends of faces are then those of a
dry line. A law that also pulls acts here, with friction by its own push, until it has lost all of its tension; from
then on its line only presses.

The loops call a law by the address of its compiled function, so that they are compiled and stored once for all laws.
"""

from __future__ import annotations

import ctypes
import math
import os
from functools import cache
from typing import Any, ClassVar, Self

import numpy as np

from ...background_compilation import compiles
from ...compiled import by_type, inlined
from ...geometry.vectors import dot, no_spin, plus, put, read, scaled
from ...problem.masonry.laws.joint_law import normal_force, stored
from ...problem.masonry.laws.own_law import OF_K_N, Own
from ...problem.wall.user_law import ANSWERS, OF_DAMPING, OF_DISSIPATED, OF_ENERGY, OF_LOST, OF_STRESS, ROOM, row_of
from ...quantities import GRAVITY, Array, Flags, Integers
from ...rows import Fields, Row, Rows, chosen, integers, joined, numbers, rows
from ...scene.scene import Scene
from ..contacts.faces import meeting, relative_velocity, where_friction_rubs
from ..contacts.friction import along_face, as_vector, carried, sprung_friction
from ..system import Books, System
from ..thread import add_line_force
from .law import JointLaw
from .link import Table

CLOSING_OF_STABLE_STEPS = 2.0
"""Closing for which steps are stable, over the largest at rest [-]."""
EXHAUSTED_TENSION = math.exp(-9)
"""Share of its tension that is left of a law which counts as one that pulls no more [-]."""
NO_RATE = 1e-12
"""Rate below which a dashpot has no force [m/s]."""
NO_CLOSING = 1e-20
"""Closing below which the spring of a line is not changed [m]."""
SIGNATURE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)
ERRORS_OF_LAWS: list[Exception] = []
"""The first error that an own law, run as plain Python, has raised in this run."""
AS_PYTHON = "laws"
"""Value of MJROCK_INTERPRET with which own laws run as plain Python in compiled loops."""


def _call_by_ctypes(values: Array, address: int, closing: float, rate: float) -> None:
    SIGNATURE(int(address))(values.ctypes.data, closing, rate)


def _choice(values: Any) -> Any:
    if isinstance(values, np.ndarray):
        return _call_by_ctypes
    from .own_calls import called  # which imports numba

    return called


call_law = by_type(_choice)


@cache
def function_of(kind: Any) -> Any:
    """A function of C that evaluates a law for a row at an address; plain Python where nothing is compiled."""
    if compiles() and os.environ.get("MJROCK_INTERPRET") != AS_PYTHON:
        from .own_calls import compiled_text

        return compiled_text(kind)
    plain = kind.answering()

    def text(values: int, closing: float, rate: float) -> None:
        room = np.ctypeslib.as_array(ctypes.cast(values, ctypes.POINTER(ctypes.c_double)), (ROOM,))
        try:
            plain(row_of(kind, room), closing, rate)
        except Exception as error:  # nothing can be raised through the loops, which end where a number is not finite
            if not ERRORS_OF_LAWS:
                ERRORS_OF_LAWS.append(error)
            room[OF_STRESS] = math.nan

    return SIGNATURE(text)


def address_of(kind: Any) -> int:
    """The address of the function of a law in this process."""
    text = function_of(kind)
    return int(getattr(text, "address", 0) or ctypes.cast(text, ctypes.c_void_p).value or 0)


class OwnLaws(JointLaw, Table):
    """Own laws of joints."""

    own_fields: ClassVar[Fields] = [
        *integers("address"),  # of its text in this process, zero for a line without an own law
        *integers("joint"),  # number of the joint that the law is given for
        *numbers("area"),  # of the line [m2]
        *numbers("stiffest", "strongest"),  # spring and dashpot for which steps are short enough [N/m, N s/m]
        *numbers("pulls", "damps", "remembers"),  # 1 where the law does
        ("values", float, (ROOM,)),  # see `user_law.layout`
    ]
    bond: ClassVar[Any] = Own

    @classmethod
    def from_scene(cls, scene: Scene, lines: Rows) -> Self:
        """Lines begin with the largest stiffness of their law. Joints of the same law and area share its answers."""
        law, closing_at, stiffest = super().from_scene(scene, lines), cache(Own.closing_at), cache(Own.stiffest)
        weight, joint = GRAVITY * float(scene.bodies.mass.sum()), scene.contacts.joint
        for i, bond in enumerate(scene.contacts.bonds):
            if isinstance(bond, Own):
                of_joint = joint == i
                law.rows["joint"][of_joint] = i
                area = np.asarray(scene.contacts.area)[of_joint]
                deepest = max(float(scene.bears[of_joint].max()), closing_at(bond, weight / float(area.sum())))
                k, c = stiffest(bond, CLOSING_OF_STABLE_STEPS * deepest)
                lines["k"][of_joint] = np.where(law.rows["pulls"][of_joint] > 0, 0.0, k * area)
                law.rows["stiffest"][of_joint] = k * area
                law.rows["strongest"][of_joint] = c * area if bond.damps else law.rows["c"][of_joint]
        return law

    def begin(self, lines: Rows, of_joint: Flags, bond: Own, area: Array) -> None:
        """Write the numbers of a law into its rows. A law that pulls holds its lines alone; their faces have no end."""
        columns: dict[str, Any] = {
            "address": address_of(type(bond.law)),
            "area": area,
            "pulls": float(bond.pulls),
            "damps": float(bond.damps),
            "remembers": float(bool(bond.law.memory)),
            "values": bond.values,
        }
        for name, column in columns.items():
            self.rows[name][of_joint] = column
        if bond.damps:
            lines["c"][of_joint] = 0.0
        if bond.pulls:
            lines["k"][of_joint], lines["c"][of_joint], lines["margin"][of_joint] = 0.0, 0.0, np.inf

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Add the forces of own laws at the pose. A law that pulls holds its line, and another one presses."""
        for p in range(len(self.rows)):
            line, law = system.lines[p], self.rows[p]
            if law.k > 0:
                if law.pulls > 0 and law.values[OF_LOST] > 1 - EXHAUSTED_TENSION:
                    press_only(books, line, law)
                if law.pulls > 0:
                    add_force_of_law(system, books, line, law, h)
                else:
                    set_spring_of_law(system, books, line, law, h)

    @inlined
    def stored(self) -> tuple[float, float]:
        """Of laws that pull. The energy of the others is in their lines."""
        energy = 0.0
        for p in range(len(self.rows)):
            law = self.rows[p]
            if law.k > 0 and law.pulls > 0:
                energy += law.area * law.values[OF_ENERGY]
        return energy, 0.0

    @inlined
    def lost(self, row: Row) -> float:
        """The share that the law gives."""
        share: float = row.values[OF_LOST]
        return share

    @inlined
    def holds(self, row: Row) -> bool:
        """Whether it may still pull."""
        return bool(row.k > 0 and row.pulls > 0)

    def springs(self) -> dict[str, Array]:
        """The largest springs and dashpots up to `CLOSING_OF_STABLE_STEPS`, for the length of a step."""
        dry = super().springs()
        return dry | {"k": np.asarray(self.rows["stiffest"]), "c": np.asarray(self.rows["strongest"])}

    def release(self, lines: Rows, released: Flags) -> None:
        """A line that only presses keeps the spring of its law."""
        for name in ("k", "push", "shear_force"):
            self.rows[name][: len(released)][released] = 0.0

    def contact_rows(self, joint: Integers, lines: Rows) -> Rows:
        """The law of a place is scaled by its spring, and presses only. A law with a memory ends with its joint: a new
        place would have to harden again."""
        added = rows(self.rows.dtype, len(joint) if len(self.rows) else 0)
        lasting = (self.rows["address"] != 0) & (self.rows["remembers"] == 0)
        for i in np.unique(self.rows["joint"][lasting]).tolist():
            of_joint = joint == i
            first = np.flatnonzero((self.rows["address"] != 0) & (self.rows["joint"] == i))[:1]
            law = chosen(self.rows, np.repeat(first, of_joint.sum()))
            part = lines["k"][of_joint] / law["area"] / law["values"][:, OF_K_N]
            for name in ("area", "stiffest", "strongest"):
                law[name] *= part
            law["k"], law["c"], law["pulls"] = lines["k"][of_joint], lines["c"][of_joint], 0.0
            law["values"][:, : len(ANSWERS)] = 0.0
            for name in ("push", "dashpot_force", "gap", "shear_state", "shear_force"):
                law[name] = 0.0
            added[of_joint] = law
        return added

    def with_search_lines(self, count: int, kept: Flags, added: Rows) -> Self:
        """The rows of the lines that are kept, and those that are added. Every line has one."""
        if not len(self.rows):
            return self
        return self._replace(rows=joined(self.rows[:count], chosen(self.rows[count:], kept), added))

    @staticmethod
    def stiffest(laws: Rows, springs: dict[str, Array]) -> dict[str, Array]:
        """Springs and dashpots of the law where a place has one."""
        if not len(laws):
            return springs
        k, c = (
            np.where(laws["k"] > 0, laws[key], springs[name]) for name, key in (("k", "stiffest"), ("c", "strongest"))
        )
        return springs | {"k": k, "c": c}

    @staticmethod
    def soften(laws: Rows, share: Array) -> None:
        """Scale whole laws by shares."""
        for name in ("k", "c", "area", "stiffest", "strongest") if len(laws) else ():
            laws[name] *= share

    @staticmethod
    def set_secant_stiffness(laws: Rows, lines: Rows, depth: Array) -> None:
        """Give lines the secant stiffness of their laws at some depths [m], and what a linear spring of the same energy
        has beyond it."""
        has_law = laws["k"] > 0 if len(laws) else np.zeros(0, dtype=bool)
        lines["c"][: len(has_law)][has_law & (laws["damps"] > 0)] = 0.0
        for i in np.flatnonzero(has_law & (depth[: len(has_law)] > 0)).tolist():
            law, closing = laws[i], float(depth[i])
            call_law(law.values, law.address, closing, 0.0)
            lines["k"][i] = law.area * law.values[OF_STRESS] / closing
            lines["k_excess"][i] = 2 * law.area * law.values[OF_ENERGY] / closing**2 - lines["k"][i]

    def has_changed(self, bonds: tuple[Any, ...]) -> Flags:
        """Those whose numbers are not those of a new line."""
        changed, known = super().has_changed(bonds), slice(len(ANSWERS), None)
        for i in np.flatnonzero((self.rows["address"] != 0) & (self.rows["remembers"] > 0)).tolist():
            row = self.rows[i]
            changed[i] = (row["values"][known] != bonds[row["joint"]].values[known]).any()
        return changed

    def resumed(self, from_rest: Self) -> Self:
        """The rows of an earlier process, with the addresses that the compiled laws have in this one."""
        has_law = self.rows["address"] != 0
        addresses = dict(zip(from_rest.rows["joint"].tolist(), from_rest.rows["address"].tolist(), strict=True))
        self.rows["address"][has_law] = [addresses[joint] for joint in self.rows["joint"][has_law].tolist()]
        return self


@inlined
def press_only(books: Books, line: Row, law: Row) -> None:
    """Make a line, whose law has lost its tension, press only."""
    if law.gap > 0:
        books.totals[0].tension += law.area * law.values[OF_ENERGY]
    line.margin, law.pulls, law.push, law.dashpot_force = law.margin, 0.0, 0.0, 0.0
    line.c = law.c if law.damps == 0 else 0.0
    put(law.shear_force, no_spin(read(line.normal)))


@inlined
def evaluate_law(law: Row, books: Books, closing: float, rate: float, h: float) -> None:
    """Evaluate a law at a closing [m] that grows at a rate [m/s], and book the energy that its memory has dissipated
    since the last pose, a time h ago [s]."""
    stress, energy = law.values[OF_STRESS], law.values[OF_ENERGY]
    call_law(law.values, law.address, closing, rate)
    if law.values[OF_DISSIPATED] != 0 and h > 0:
        work = 0.5 * h * (stress + law.values[OF_STRESS]) * rate
        dissipated = law.area * (work - (law.values[OF_ENERGY] - energy))
        if closing > 0:
            books.totals[0].crushing += dissipated
        else:
            books.totals[0].tension += dissipated


@inlined
def set_spring_of_law(system: System, books: Books, line: Row, law: Row, h: float) -> None:
    """Give a line the spring and the dashpot that its law has at the pose."""
    meet = meeting(system, line)
    if meet.gap >= 0 and (law.remembers == 0 or meet.past):
        law.values[OF_STRESS] = law.values[OF_ENERGY] = 0.0
        return
    rate = -dot(meet.normal, relative_velocity(system.bodies, line, system.supports, meet))
    closing = -meet.gap
    evaluate_law(law, books, closing, rate, h)
    if closing > NO_CLOSING:
        energy, force = stored(line, -line.depth), normal_force(line, -line.depth, 0.0)
        line.k = law.area * law.values[OF_STRESS] / closing
        line.k_excess = 2 * law.area * law.values[OF_ENERGY] / (closing * closing) - line.k
        if law.damps > 0:
            line.c = law.area * law.values[OF_DAMPING] / rate if abs(rate) > NO_RATE else 0.0
        if meet.past or line.past == 1:  # `lost_past_face_edge` takes the spring of this pose for that of the last one
            energy -= stored(line, -line.depth)
            force -= normal_force(line, -line.depth, 0.0)
            books.totals[0].joint_ends += energy + 0.5 * force * h * rate


@inlined
def add_force_of_law(system: System, books: Books, line: Row, law: Row, h: float) -> None:
    """Add the forces of a law that pulls, with its friction."""
    bodies, supports = system.bodies, system.supports
    meet = where_friction_rubs(meeting(system, line))
    velocity = relative_velocity(bodies, line, supports, meet)
    rate, slip = dot(meet.normal, velocity), along_face(meet.normal, velocity)
    evaluate_law(law, books, -meet.gap, -rate, h)
    damping = law.area * law.values[OF_DAMPING]
    if law.damps == 0:
        damping = -law.c * rate
        if meet.gap > 0:
            damping *= min(-law.area * law.values[OF_STRESS] / (law.k * meet.gap), 1.0)
    push = damping + law.area * law.values[OF_STRESS]
    books.dashpots[line.group] -= 0.5 * h * (law.dashpot_force + damping) * rate
    last = read(law.shear_force)
    friction = sprung_friction(bodies, line, meet.normal, slip, max(push, 0.0), h)
    mean = scaled(0.5 * h, plus(last, friction))
    books.totals[0].friction -= dot(mean, slip)
    if line.support >= 0:
        work = plus(scaled(0.5 * h * (law.push + push), meet.normal), as_vector(meet.normal, mean))
        books.totals[0].ground += carried(line, supports, work)
    law.gap, law.push, law.dashpot_force = meet.gap, push, damping
    line.widest = max(line.widest, meet.gap)
    put(law.shear_force, friction)
    force = plus(scaled(push, meet.normal), as_vector(meet.normal, friction))
    add_line_force(books.pending, bodies, line, (meet.arm, meet.face_arm), force)
