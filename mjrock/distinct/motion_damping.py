"""Damping of a slow motion: of all velocities alike, or of each force that is not balanced.

Mass-proportional damping lets every velocity decay at one rate. Local damping takes a share of the unbalanced force
along each axis, against the velocity (Cundall, Distinct element models of rock and soil structure, 1987): a steady
motion is not dragged, and what swings is damped alike at all frequencies. What they take is in the last account of the
dashpots.
"""

from __future__ import annotations

import math

from ..compiled import inlined
from ..geometry.vectors import Vector, dot, put, read, scaled
from ..quantities import Array
from ..rows import Row
from .rotation import momentum_of
from .system import Books, System


@inlined
def damp_velocities(system: System, books: Books, share: float) -> None:
    """Let all velocities decay by exp(-share)."""
    factor, dissipated = math.exp(-share), 0.0
    for b in range(len(system.bodies)):
        body = system.bodies[b]
        velocity, spin = read(body.velocity), read(body.spin)
        dissipated += body.mass * dot(velocity, velocity) + dot(momentum_of(body), spin)
        put(body.velocity, scaled(factor, velocity))
        damp_spin(body, scaled(factor, spin), factor)
    books.dashpots[len(books.dashpots) - 1] += 0.5 * (1 - factor * factor) * dissipated


@inlined
def damp_spin(body: Row, spin: Vector, factor: float) -> None:
    """Give a body a spin, and multiply its angular momentum, which only bodies of space have."""
    put(body.spin, spin)
    if len(spin) == 3:
        put(body.momentum, scaled(factor, read(body.momentum)))


@inlined
def damp_components(force: Array, velocity: Array, share: float) -> float:
    """Take a share of the components of a force against those of a velocity. Returns the power that it takes [W]."""
    power = 0.0
    for i in range(len(force)):
        reduction = math.copysign(share * abs(force[i]), velocity[i]) if velocity[i] != 0 else 0.0
        power += reduction * velocity[i]
        force[i] -= reduction
    return power


@inlined
def damp_unbalanced(system: System, books: Books, share: float, force_time: float) -> None:
    """Take a share of the unbalanced force and moment on each body while they act for a time [s]."""
    dissipated = 0.0
    for b in range(len(system.bodies)):
        body = system.bodies[b]
        dissipated += force_time * (
            damp_components(body.force, body.velocity, share) + damp_components(body.moment, body.spin, share)
        )
    books.dashpots[len(books.dashpots) - 1] += dissipated
