"""Bonds of mortared joints: a spring that acts in tension and compression, and a shear spring with cohesion.

While a bond holds, the stiffness of its line is divided. The secant stiffness of the bond pulls and pushes, here. The
rest pushes only, in `contact`, as a dry line does. An intact bond has the whole stiffness, and once the bond is lost
the line is a dry one. The friction of a bonded line is that of its bond. A line cannot move past an end of its face as
long as the bond holds.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar, Self

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, increase, minus, no_spin, norm, plus, put, read, scaled
from ...problem.masonry.laws.bond import Bond
from ...problem.masonry.laws.bond_law import bonded_limit, crush, tear, wear
from ...problem.masonry.laws.joint_law import normal_force
from ...quantities import Array, Flags
from ...rows import Fields, Row, Rows, numbers
from ...scene.scene import Scene
from ..contacts.faces import meeting, relative_velocity, where_friction_rubs
from ..contacts.friction import along_face, as_vector, carried, sheared, shortened, stretched
from ..rotation import in_body
from ..system import Books, System
from ..thread import add_line_force
from .law import JointLaw
from .link import Table

INTEGRITY_OF_LOST = math.exp(-9)
"""Integrity below which a bond counts as lost [-]."""
INTEGRITY_OF_CRACKED = 0.5
"""Integrity below which a bond counts as cracked [-]."""


class Bonds(JointLaw, Table):
    """Bonds, by `bond_law`: `integrity` is what is left of each, 1 - D [-]."""

    own_fields: ClassVar[Fields] = [
        *numbers("residual", "friction_drop"),  # friction without bond, and what a whole bond adds to it [-]
        *numbers("tension", "cohesion", "strength"),  # of the line [N], `strength` in crushing, or infinite
        *numbers("opening_rate", "slip_rate", "crushing_rate"),  # of its loss [1/m], see `bond_law`
        *numbers("integrity"),
        *numbers("peak", "hardening"),  # strength in crushing at its peak [N], plastic closing there, zero for none [m]
        *numbers("largest_gap", "crack", "crushed"),  # so far, opening of the crack and plastic closing so far [m]
        *numbers("secant"),  # stiffness that pulls and pushes [N/m]
        *numbers("undamped"),  # 1 where the dashpots leave out the secant, or 0 [-]
        *numbers("age"),  # time that it has held until it cracked [s]
    ]
    bond: ClassVar[type[Bond]] = Bond
    endless: ClassVar[tuple[str, ...]] = (*JointLaw.endless, "strength")

    def begin(self, lines: Rows, of_joint: Flags, bond: Bond, area: Array) -> None:
        """Strengths are those of the mortar times the area of each line."""
        bonds, friction = self.rows, lines["friction"][of_joint]
        residual = friction if bond.residual_friction is None else np.full(len(area), bond.residual_friction)
        columns = {
            "integrity": 1.0,
            "strength": bond.elastic_limit * area,
            "tension": bond.tension * area,
            "cohesion": bond.cohesion * area,
            "residual": residual,
            "friction_drop": friction - residual,
            "undamped": float(not bond.damped),
            "opening_rate": bond.tension / bond.opening_energy,
            "slip_rate": bond.cohesion / bond.slip_energy,
        }
        if bond.crushing is not None and bond.crushing_energy is not None:
            columns["peak"], columns["hardening"] = bond.crushing * area, bond.hardening or 0.0
            columns["crushing_rate"] = bond.crushing / (bond.crushing_energy - bond.energy_of_hardening)
        lines["friction"][of_joint], lines["shear_state"][of_joint] = 0.0, 0.0
        if bond.tension > 0:
            columns["secant"] = lines["k"][of_joint]
            lines["k"][of_joint], lines["c"][of_joint], lines["margin"][of_joint] = 0.0, 0.0, np.inf
        for name, column in columns.items():
            bonds[name][of_joint] = column

    @inlined
    def act(self, system: System, books: Books, t: float, h: float) -> None:
        """Lines whose bonds are lost become dry."""
        for p in range(len(self.rows)):
            line, bond = system.lines[p], self.rows[p]
            if bond.k > 0 and bond.integrity <= INTEGRITY_OF_LOST:
                make_dry(books, line, bond)
            if bond.k > 0:
                hold_line(system, books, line, bond, h)

    @inlined
    def stored(self) -> tuple[float, float]:
        """Of the secants and of the shear springs."""
        along_normals, along_faces = 0.0, 0.0
        for p in range(len(self.rows)):
            bond = self.rows[p]
            along_normals += 0.5 * bond.secant * bond.gap * bond.gap
            along_faces += sheared(bond)
        return along_normals, along_faces

    @inlined
    def lost(self, row: Row) -> float:
        """D."""
        damage: float = 1 - row.integrity
        return damage

    @inlined
    def holds(self, row: Row) -> bool:
        """Whether its bond has not gone."""
        return bool(row.k > 0 and row.tension > 0 and row.integrity > INTEGRITY_OF_LOST)

    def release(self, lines: Rows, released: Flags) -> None:
        """The secants go too."""
        self.rows["secant"][released & (self.rows["k"] > 0)] = 0.0
        super().release(lines, released)

    def has_changed(self, bonds: tuple[Any, ...]) -> Flags:
        """Those that have lost a part of it."""
        return np.asarray((self.rows["share"] > 0) & (self.rows["integrity"] < 1))

    def resumed(self, from_rest: Self) -> Self:
        """Ages count from the start of each run."""
        self.rows["age"] = 0.0
        return self

    def cracked(self, scene: Scene) -> dict[str, float]:
        """Those of which all bonds have lost half, the earliest first."""
        when, contacts = {}, scene.contacts
        for i in np.flatnonzero([type(bond) is Bond and bond.tension > 0 for bond in contacts.bonds]):
            of_joint = self.rows[contacts.joint == i]
            if (of_joint["integrity"] <= INTEGRITY_OF_CRACKED).all():
                when[contacts.joints[i]] = float(of_joint["age"].max())
        return dict(sorted(when.items(), key=lambda item: item[1]))


@inlined
def make_dry(books: Books, line: Row, bond: Row) -> None:
    """Make a line dry, whose bond is lost. A bond with a crushing strength still crushes."""
    if bond.tension > 0:
        books.totals[0].tension += 0.5 * bond.secant * max(bond.gap, 0.0) ** 2
        bond.tension = bond.cohesion = bond.secant = bond.slip_rate = 0.0
        line.k, line.c, line.margin = bond.k, bond.c, bond.margin
    if bond.strength == math.inf:
        line.friction = bond.residual
        put(line.shear_state, read(bond.shear_state))
        put(line.shear_force, read(bond.shear_force))
        put(bond.shear_state, no_spin(read(line.normal)))
        put(bond.shear_force, no_spin(read(line.normal)))
        bond.k = bond.push = 0.0


@inlined
def crush_line(books: Books, line: Row, bond: Row, gap: float) -> float:
    """Crush a line at a gap [m]: its face moves back. Returns the distance [m]."""
    closing = crush(bond, gap, bond.k_s * norm(read(bond.shear_state)))
    if closing > 0:
        back = scaled(-closing, read(line.normal))
        increase(line.origin, back)
        increase(line.between, scaled(-1.0, back))
        books.totals[0].crushing += 0.5 * bond.k * closing * (max(-bond.gap, 0.0) - gap - closing)
    return closing


@inlined
def slide(bodies: Rows, line: Row, bond: Row, elongation: Vector, slip: Vector, push: float) -> tuple[Vector, float]:
    """Force of spring and dashpot of a bond along the face [N], see `sprung_friction`, and the energy that its cohesion
    dissipates [J]. That is too much where crushing limits the force: the caller limits it.

    Args:
        bodies, line, bond: the bodies, the line and its bond.
        elongation: of the shear spring, if it does not slide in this step [m].
        slip: velocity along the face [m/s].
        push: force along the normal [N].
    """
    bond.friction = bond.residual + bond.friction_drop * bond.integrity
    limit = bonded_limit(bond, push)
    stretch = shortened(elongation, limit / bond.k_s)
    c_s = bond.c_s * (1 - bond.undamped * bond.secant / bond.k)
    friction = shortened(minus(scaled(-bond.k_s, stretch), scaled(c_s, slip)), limit)
    dissipated = wear(bond, norm(minus(elongation, stretch)))
    if line.face >= 0:
        stretch = in_body(bodies[line.face], stretch)
    put(bond.shear_state, stretch)
    return friction, dissipated


@inlined
def hold_line(system: System, books: Books, line: Row, bond: Row, h: float) -> None:
    """Add the forces of one bond, after its softening and crushing at the pose."""
    bodies, supports, before = system.bodies, system.supports, bond.gap
    meet = where_friction_rubs(meeting(system, line))
    gap = meet.gap
    if gap < 0 and bond.strength < math.inf:
        gap += crush_line(books, line, bond, gap)
    secant = bond.secant
    if bond.tension > 0:
        tear(bond, gap)
        if bond.secant < secant:
            line.k = bond.k - bond.secant
            line.c = bond.c * line.k / bond.k
            if before > 0 or gap > 0:
                books.totals[0].tension += 0.5 * before * gap * (secant - bond.secant)
    velocity = relative_velocity(bodies, line, supports, meet)
    rate, slip = dot(meet.normal, velocity), along_face(meet.normal, velocity)
    damping = -(1 - bond.undamped) * bond.c * bond.secant / bond.k * rate
    push = damping - bond.secant * gap
    books.dashpots[line.group] -= 0.5 * h * (bond.dashpot_force + damping) * rate
    last = read(bond.shear_force)
    stored_before = sheared(bond)
    elongation = stretched(bodies, line.face, bond.shear_state, meet.normal, scaled(h, slip))
    friction, dissipated = slide(bodies, line, bond, elongation, slip, push + normal_force(line, gap, rate))
    mean = scaled(0.5 * h, plus(last, friction))
    friction_work = -dot(mean, slip)
    dissipated = min(dissipated, max(friction_work + stored_before - sheared(bond), 0.0))  # no more than there is
    books.totals[0].slip += dissipated
    books.totals[0].friction += friction_work - dissipated
    if line.support >= 0:
        work = plus(scaled(0.5 * h * (bond.push + push), meet.normal), as_vector(meet.normal, mean))
        books.totals[0].ground += carried(line, supports, work)
    bond.gap, bond.push, bond.dashpot_force = gap, push, damping
    line.widest = max(line.widest, gap)
    put(bond.shear_force, friction)
    if bond.integrity > INTEGRITY_OF_CRACKED:
        bond.age += h
    force = plus(scaled(push, meet.normal), as_vector(meet.normal, friction))
    add_line_force(books.pending, bodies, line, (meet.arm, meet.face_arm), force)
