"""Forces that are kept at a sample: of joints, of fixed blocks and of what actuators drive.

A row keeps the force along its normal and that of its friction in the last step. They are recorded when all forces of
the step have acted, those of rigid friction and of touches too.
"""

from __future__ import annotations

import math

from ..compiled import inlined
from ..geometry.vectors import Vector, increase, moment, plus, put, read, scaled
from ..quantities import Array
from ..rows import Row
from .contacts.faces import meeting, where_friction_rubs
from .contacts.friction import as_vector, last_friction
from .contacts.touches import was_open
from .kinds.lists import lost_by_laws, with_laws
from .system import Samples, System


@inlined
def total_friction(system: System, line: Row) -> Vector:
    """Friction of a line in the last step, along its face [N]. A line that sticks rigidly has a shear force only as it
    leaves its face."""
    shear_force: Vector = read(line.shear_force)
    if line.k_s < math.inf:
        return shear_force
    return plus(shear_force, last_friction(system.bodies, line, shear_force))


@inlined
def add_moment(load: Array, factor: float, place: Vector, force: Vector) -> None:
    """Add a force to a force and its moment [N, N m], about the origin of the place, which is that of the world or the
    centroid of a body."""
    increase(load, scaled(factor, force))
    increase(load[len(force) :], scaled(factor, moment(place, force)))


@inlined
def record_guide_loads(system: System, samples: Samples, row: int) -> None:
    """Keep the forces of weight, ground motion and links on the blocks of actuators, before contacts act on them."""
    guided = samples.guided[row]
    for i in range(len(guided)):
        if system.guided[i] < 0:
            continue
        body = system.bodies[system.guided[i]]
        put(guided[i], read(body.force))
        put(guided[i][len(body.force) :], read(body.moment))


@inlined
def record_forces(system: System, samples: Samples, row: int) -> None:
    """Keep the forces of the last step at a sample, where there is room for them."""
    loads, reactions, guided = samples.loads[row], samples.contact_reactions[row], samples.guided[row]
    if len(reactions) == 0:
        return
    for p in range(len(system.lines)):
        line = system.lines[p]
        push, friction, holds = with_laws(system.laws, p, line.push, total_friction(system, line), False)
        if line.group < len(loads):
            samples.damage[row, line.group] += lost_by_laws(system.laws, p)
        if was_open(line) and not holds:
            continue
        meet = where_friction_rubs(meeting(system, line))
        force = plus(scaled(push, meet.normal), as_vector(meet.normal, friction))
        if line.group < len(loads):
            body = system.bodies[line.body]
            place = plus(read(body.rest), plus(read(body.place), meet.arm))
            add_moment(loads[line.group], line.sense, place, force)
        if line.fixed >= 0:
            increase(reactions[line.fixed], force)
        for i in range(len(guided)):
            if system.guided[i] < 0:
                continue
            if system.guided[i] == line.body:
                add_moment(guided[i], 1.0, meet.arm, force)
            elif system.guided[i] == line.face:
                add_moment(guided[i], -1.0, meet.face_arm, force)
