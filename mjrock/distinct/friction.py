"""Rigid friction: impulses along the faces that stop the slip, as far as Coulomb's law lets them.

They are found by projected Gauss-Seidel: one line after the other gets the impulse that stops its slip, at most mu
times its pressure, until the impulses no longer change. They start from those of the last step. A unit impulse along
the way of a line moves its body along it and turns it by the lever, and the body of the face against it.
"""

from __future__ import annotations

from ..compiled import inlined, jitable
from ..quantities import Integers
from .contact import carried
from .system import Books, Row, Rows, Supports, System

SWEEPS = 50
"""Most sweeps over the lines in a step."""
SETTLED = 1e-3
"""Change of an impulse in a sweep, over the largest of a line that is pressed most, below which the sweeps end [-]."""


@inlined
def slip_of(bodies: Rows, line: Row, supports: Supports) -> float:
    """Velocity along its face of a line that sticks rigidly [m/s]."""
    body = bodies[line.body]
    slip: float = line.way_x * body.vx + line.way_z * body.vz + line.lever * body.w
    if line.face >= 0:
        face = bodies[line.face]
        slip -= line.way_x * face.vx + line.way_z * face.vz + line.other * face.w
    return slip - carried(line, supports, line.way_x, line.way_z)


@inlined
def strike(bodies: Rows, line: Row, impulse: float) -> None:
    """Change the velocities on both sides of a line by an impulse [N s]."""
    body = bodies[line.body]
    body.vx += line.way_x * impulse / body.mass
    body.vz += line.way_z * impulse / body.mass
    body.w += line.lever * impulse * body.ease
    if line.face >= 0:
        face = bodies[line.face]
        face.vx -= line.way_x * impulse / face.mass
        face.vz -= line.way_z * impulse / face.mass
        face.w -= line.other * impulse * face.ease


@jitable
def stick(system: System, active: Integers, count: int, kick: float) -> None:
    """Stop the slip of the lines that stick rigidly. Their impulses are left in `dragged` [N s]."""
    bodies, lines, largest = system.bodies, system.lines, 0.0
    for i in range(count):
        line = lines[active[i]]
        line.dragged = min(max(kick * line.grip, -line.most), line.most)
        strike(bodies, line, line.dragged)
        largest = max(largest, line.most)
    for sweep in range(SWEEPS):
        changed = 0.0
        for turn in range(count):
            line = lines[active[turn if sweep % 2 else count - 1 - turn]]
            impulse = line.dragged - slip_of(bodies, line, system.supports) / line.light
            impulse = min(max(impulse, -line.most), line.most)
            change = impulse - line.dragged
            strike(bodies, line, change)
            line.dragged = impulse
            changed = max(changed, abs(change))
        if changed <= SETTLED * largest:
            break
    for i in range(count):
        lines[active[i]].grip = lines[active[i]].dragged / kick


@jitable
def note_slips(system: System, active: Integers, count: int) -> None:
    """Keep the slip of the lines that stick rigidly before the forces act."""
    for i in range(count):
        line = system.lines[active[i]]
        line.sliding = slip_of(system.bodies, line, system.supports)


@jitable
def book_rubbing(system: System, books: Books, count: int) -> None:
    """Book what rigid friction takes in a step, its impulses along the mean of the slips before and after, and what
    the supports put in through it."""
    for i in range(count):
        line = system.lines[books.active[i]]
        slip = 0.5 * (line.sliding + slip_of(system.bodies, line, system.supports))
        books.friction[0] -= line.dragged * slip
        books.friction[1] += line.dragged * carried(line, system.supports, line.way_x, line.way_z)
