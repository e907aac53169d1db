"""Bonds of mortared joints: the part of a line that pulls as it pushes, and its shear spring with cohesion.

While a bond holds, its line is split in two. The secant of the bond acts both ways, here. What stiffness is missing to
that of the line pushes only, in `contact`, as a line without bond. An intact bond leaves nothing to its line, and once
the bond has gone the line is the dry one. Friction of a bonded line is that of the bond, and its faces have no ends as
long as it holds.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import inlined
from ...geometry.vectors import Vector, dot, increase, minus, no_spin, plus, put, read, scaled
from ...problem.masonry.case import AnyCase
from ...problem.masonry.laws.bond_law import bonded_limit, crush, tear, wear
from ...problem.masonry.laws.joint_law import normal_force, stored_along
from ...problem.masonry.masonry import Masonry
from ...quantities import Flags, Integers
from ..rows import Row, Rows, kinds, rows
from ..system import Books, System
from ..turning import in_body
from .contact import add_force, meeting, relative, where_friction_rubs
from .friction import along_face, as_vector, carried, shortened, stretched

GONE = math.exp(-9)
"""What is left of a bond when it counts as gone [-]."""
CRACKED = 0.5
"""What is left of a bond when it counts as cracked [-]."""


def bonded(system: System, masonry: Masonry, joint: Integers) -> System:
    """The system with the bonds of its masonry, from the number of the joint of each line. What they take over of the
    lines is zero there."""
    if not any(masonry.bonds):
        return system
    lines = system.lines
    bonds = rows(kinds(len(system.axes)).bond, len(lines), left=1.0, bears=np.inf)
    area = masonry.areas_of(lines["k"], joint)
    for i, bond in enumerate(masonry.bonds):
        if bond is None:
            continue
        which = joint == i
        for name in ("k", "c", "k_s", "c_s", "friction", "margin", "grip"):
            bonds[name][which] = lines[name][which]
        bonds["tension"][which], bonds["cohesion"][which] = bond.tension * area[which], bond.cohesion * area[which]
        bonds["share"][which] = area[which] / area[which].sum()
        bonds["residual"][which] = masonry.residual_friction[i]
        bonds["falls"][which] = masonry.joint_friction[i] - masonry.residual_friction[i]
        bonds["torn"][which] = bond.tension / bond.opening_energy
        bonds["worn"][which] = bond.cohesion / bond.slip_energy
        if bond.crushing is not None and bond.crushing_energy is not None:
            bonds["bears"][which] = bond.elastic_limit * area[which]
            bonds["peak"][which], bonds["hardens"][which] = bond.crushing * area[which], bond.hardening or 0.0
            bonds["crumbled"][which] = bond.crushing / (bond.crushing_energy - bond.energy_of_hardening)
        lines["friction"][which], lines["grip"][which] = 0.0, 0.0
        if bond.tension > 0:
            bonds["secant"][which] = lines["k"][which]
            lines["k"][which], lines["c"][which], lines["margin"][which] = 0.0, 0.0, np.inf
    return system._replace(bonds=bonds)


def holding(bonds: Rows) -> Flags:
    """Whether each bond still holds something beside friction."""
    return np.asarray((bonds["k"] > 0) & (bonds["tension"] > 0) & (bonds["left"] > GONE))


def cracked(bonds: Rows, joint: Integers, masonry: Masonry | AnyCase) -> dict[str, float]:
    """When each joint that cracked did [s], the first first, from the number of the joint of each line."""
    when = {}
    for i in np.flatnonzero([bond is not None and bond.tension > 0 for bond in masonry.bonds]):
        of_joint = bonds[joint == i]
        if (of_joint["left"] <= CRACKED).all():
            when[masonry.joints[i].name] = float(of_joint["age"].max())
    return dict(sorted(when.items(), key=lambda item: item[1]))


def released(lines: Rows, bonds: Rows, which: Flags) -> None:
    """Give lines back what their bonds have taken over, where they are handed over."""
    which = which & (bonds["k"] > 0)
    for name in ("k", "c", "friction", "margin", "grip", "dragged"):
        lines[name][which] = bonds[name][which]
    for name in ("k", "secant", "grip", "dragged", "push"):
        bonds[name][which] = 0.0


@inlined
def hold_bonds(system: System, books: Books, h: float) -> None:
    """Add the forces of all bonds. `h` is the length of the step that led to the pose [s], zero at the start."""
    for p in range(len(system.bonds)):
        line, bond = system.lines[p], system.bonds[p]
        if bond.k > 0 and bond.left <= GONE:
            let_go(books, line, bond)
        if bond.k > 0:
            hold(system, books, line, bond, h)


@inlined
def let_go(books: Books, line: Row, bond: Row) -> None:
    """Leave the line to itself whose bond has gone, but for its crushing where it has a strength for that."""
    if bond.tension > 0:
        books.totals[0].tension += 0.5 * bond.secant * max(bond.gap, 0.0) ** 2
        bond.tension = bond.cohesion = bond.secant = bond.worn = 0.0
        line.k, line.c, line.margin = bond.k, bond.c, bond.margin
    if bond.bears == math.inf:
        line.friction = bond.residual
        put(line.grip, read(bond.grip))
        put(line.dragged, read(bond.dragged))
        put(bond.grip, no_spin(read(line.normal)))
        put(bond.dragged, no_spin(read(line.normal)))
        bond.k = bond.push = 0.0


@inlined
def crush_line(books: Books, line: Row, bond: Row, gap: float) -> float:
    """Crush a line at a gap [m]: its face steps back. Returns by how much [m]."""
    grip = read(bond.grip)
    closing = crush(bond, gap, bond.k_s * math.sqrt(dot(grip, grip)))
    if closing > 0:
        back = scaled(-closing, read(line.normal))
        increase(line.origin, back)
        increase(line.between, scaled(-1.0, back))
        books.totals[0].crushing += 0.5 * bond.k * closing * (max(-bond.gap, 0.0) - gap - closing)
    return closing


@inlined
def slide(
    bodies: Rows, line: Row, bond: Row, normal: Vector, slip: Vector, push: float, h: float
) -> tuple[Vector, float]:
    """Force of spring and dashpot of a bond along the face [N], see `sprung_friction`, and what all its cohesion takes
    [J]. Where crushing limits the force there is not as much."""
    bond.friction = bond.residual + bond.falls * bond.left
    limit = bonded_limit(bond, push)
    trial = stretched(bodies, line.face, bond.grip, normal, scaled(h, slip))
    grip = shortened(trial, limit / bond.k_s)
    drag = shortened(minus(scaled(-bond.k_s, grip), scaled(bond.c_s, slip)), limit)
    slid = minus(trial, grip)
    taken = wear(bond, math.sqrt(dot(slid, slid)))
    if line.face >= 0:
        grip = in_body(bodies[line.face], grip)
    put(bond.grip, grip)
    return drag, taken


@inlined
def hold(system: System, books: Books, line: Row, bond: Row, h: float) -> None:
    """Add the forces of one bond, after it has torn and been crushed as far as the pose asks."""
    bodies, supports, before = system.bodies, system.supports, bond.gap
    meet = where_friction_rubs(meeting(system, line))
    gap = meet.gap
    if gap < 0 and bond.bears < math.inf:
        gap += crush_line(books, line, bond, gap)
    secant = bond.secant
    if bond.tension > 0:
        tear(bond, gap)
        if bond.secant < secant:
            line.k = bond.k - bond.secant
            line.c = bond.c * line.k / bond.k
            if before > 0 or gap > 0:
                books.totals[0].tension += 0.5 * before * gap * (secant - bond.secant)
    velocity = relative(bodies, line, supports, meet)
    rate, slip = dot(meet.normal, velocity), along_face(meet.normal, velocity)
    pressed = -bond.c * bond.secant / bond.k * rate
    push = pressed - bond.secant * gap
    books.dashpots[line.group] -= 0.5 * h * (bond.pressed + pressed) * rate
    last = read(bond.dragged)
    held = sheared(bond)
    drag, taken = slide(bodies, line, bond, meet.normal, slip, push + normal_force(line, gap, rate), h)
    mean = scaled(0.5 * h, plus(last, drag))
    done = -dot(mean, slip)
    taken = min(taken, max(done + held - sheared(bond), 0.0))  # no more than there is
    books.totals[0].slip += taken
    books.totals[0].friction += done - taken
    if line.support >= 0:
        work = plus(scaled(0.5 * h * (bond.push + push), meet.normal), as_vector(meet.normal, mean))
        books.totals[0].ground += carried(line, supports, work)
    bond.gap, bond.push, bond.pressed = gap, push, pressed
    line.widest = max(line.widest, gap)
    put(bond.dragged, drag)
    if bond.left > CRACKED:
        bond.age += h
    force = plus(scaled(push, meet.normal), as_vector(meet.normal, drag))
    add_force(bodies[line.body], meet.arm, force)
    if line.face >= 0:
        add_force(bodies[line.face], meet.face_arm, scaled(-1.0, force))


@inlined
def sheared(bond: Row) -> float:
    """Energy in the spring of a bond along the face [J]."""
    grip = read(bond.grip)
    energy: float = stored_along(bond, dot(grip, grip))
    return energy


@inlined
def bonded_energy(system: System) -> tuple[float, float]:
    """Energy in the springs of all bonds along normals and along faces [J]."""
    along_normals, along_faces = 0.0, 0.0
    for p in range(len(system.bonds)):
        bond = system.bonds[p]
        along_normals += 0.5 * bond.secant * bond.gap * bond.gap
        along_faces += sheared(bond)
    return along_normals, along_faces
