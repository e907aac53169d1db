"""The structure of a scene: the parts that have energy, and this energy at the poses of a motion."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.frames import Freedom, take_frames
from ..geometry.kinematics import AppliedForces, Places, Ties, depth, displacement, slack, stretch
from ..geometry.vectors import dot, vector
from ..problem.masonry.laws.joint_law import Law, stored
from ..quantities import GRAVITY, Array, Integers, frozen
from .masses import coupling

NO_PRODUCTS: Array = np.empty((0, 3))
"""Of bodies of the plane, and of bodies of space whose axes are principal ones."""
NO_PRODUCTS.setflags(write=False)


class Structure(NamedTuple):
    """The parts of a scene that have energy, as arrays for compiled functions.

    Args:
        places: the contacts.
        ties, forces: the ties and the constant forces.
        masses: the generalised ones, the mass in every direction and then the moments of inertia of each body, (n nv,).
        products: products of inertia of bodies of space [kg m2], see `mjrock.scene.masses`, shape (n, 3), or (0, 3).
    """

    places: Places
    ties: Ties
    forces: AppliedForces
    masses: Array
    products: Array = NO_PRODUCTS


@inlined
def spring_energy(places: Places, i: int, frames: Array) -> float:
    """Energy in the spring of contact i [J]."""
    return stored(Law(places.k[i], 0.0, 0.0, 0.0), -depth(places, i, frames))


@inlined
def weight_energy(masses: Array, q: Array, axes: tuple[int, ...]) -> float:
    """Energy of the weight of all bodies above their position at rest [J]."""
    energy = 0.0
    if len(axes) == 2:
        for body in range(len(masses) // 3):
            energy += GRAVITY * masses[3 * body] * q[3 * body + 1]
    else:
        for body in range(len(masses) // 6):
            energy += GRAVITY * masses[6 * body] * q[7 * body + 2]
    return energy


@inlined
def force_energy(forces: AppliedForces, frames: Array) -> float:
    """Energy of the constant forces above their position at rest [J]."""
    energy = 0.0
    for i in range(len(forces.body)):
        energy -= dot(vector(forces.force, i, forces.axes), displacement(forces, i, frames))
    return energy


def energies(structure: Structure, q: Array, v: Array, broken: Integers | None = None) -> tuple[Array, Array]:
    """Kinetic, potential and elastic energy at the steps of a motion [J], shape (steps, 3), and what ties have taken.

    The potential energy is that of the weight above the position of rest of the centroids, and that of the constant
    forces. Ties yield as the motion goes on. What they have taken up to each step has the shape (steps, t) [J].

    Args:
        structure: what has energy.
        q, v: poses and velocities, shapes (steps, n nq) and (steps, n nv).
        broken: the step from which each tie no longer acts, shape (t,), as many as there are steps or more for one that
            does not break. None breaks none.
    """
    parts, taken = np.zeros((len(q), 3)), np.zeros((len(q), len(structure.ties.k)))
    ties = structure.ties._replace(reach=np.array(structure.ties.reach))
    freedom, until = structure.places.freedom, np.full(taken.shape[1], len(q)) if broken is None else broken
    frames = freedom.frames(q.shape[1] // freedom.nq)
    _energies(structure._replace(ties=ties), frozen(q), frozen(v), frames, until, parts, taken)
    return parts, taken


@compiled
def _energies(
    structure: Structure, q: Array, v: Array, frames: Array, broken: Integers, parts: Array, taken: Array
) -> None:
    places, ties, masses = structure.places, structure.ties, structure.masses
    for step in range(len(q)):
        take_frames(q[step], frames, places.axes)
        for j in range(len(masses)):
            parts[step, 0] += 0.5 * masses[j] * (v[step, j] * v[step, j])
        if len(structure.products) > 0:
            parts[step, 0] += 0.5 * coupling(structure.products, v[step])
        parts[step, 1] = weight_energy(masses, q[step], places.axes)
        parts[step, 1] += force_energy(structure.forces, frames)
        for i in range(len(places.k)):
            parts[step, 2] += spring_energy(places, i, frames)
        for i in range(len(ties.k)):
            if step >= broken[i]:
                taken[step, i] = taken[step - 1, i] if step else 0.0
                if ties.reach[i] < math.inf:  # it yields up to its limit, and breaks
                    left = ties.limit[i] - ties.stretch[i] - ties.reach[i]
                    taken[step, i] += ties.k[i] * ties.stretch[i] * left
                    ties.reach[i] = math.inf
                continue
            stretched, yielded = stretch(ties, i, frames, v[step])
            parts[step, 2] += 0.5 * ties.k[i] * stretched * stretched
            taken[step, i] = (taken[step - 1, i] if step else 0.0) + ties.k[i] * abs(stretched) * yielded


def breaks(ties: Ties, q: Array) -> Integers:
    """The first step of a motion at whose pose each tie is longer than its limit, or the number of steps, shape (t,).

    No tie has yielded before. Poses have the shape (steps, n nq).
    """
    broken, freedom = np.full(len(ties.k), len(q)), Freedom(ties.links.axes)
    if np.isfinite(ties.limit).any():
        _breaks(ties, q, freedom.frames(q.shape[1] // freedom.nq), broken)
    return broken


@compiled
def _breaks(ties: Ties, q: Array, frames: Array, broken: Integers) -> None:
    for step in range(len(q)):
        take_frames(q[step], frames, ties.links.axes)
        for i in range(len(broken)):
            longer = ties.reach[i] - slack(ties, i, frames, q[step], q[step]).value > ties.limit[i]
            if longer and broken[i] == len(q):
                broken[i] = step
