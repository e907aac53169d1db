"""Potential: the energy of springs, weight and constant forces as a function of the pose, and its derivatives.

Contacts and ties are springs alike, which act while they are pressed or taut. Contacts come first, then ties.
Velocities and forces are those of the joints of all bodies, shape (n nv,) with nv velocities a body.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, diags_array

from ..compiled import compiled, inlined, jitable
from ..geometry.frames import Freedom, frames_of, push_body, swung, take_frames
from ..geometry.kinematics import Forces, Places, Ties, along, depth, displacement, opening, slack, stretch
from ..geometry.vectors import dot, plus, vector
from ..linear import entries, sprung
from ..quantities import GRAVITY, Array, Integers


class Structure(NamedTuple):
    """What has energy in a scene, as arrays for compiled functions.

    Args:
        places: the contacts.
        k: their springs [N/m], shape (m,).
        ties, forces: the ties and the constant forces.
        masses: the generalised ones, the mass in every direction and then the moments of inertia of each body, (n nv,).
    """

    places: Places
    k: Array
    ties: Ties
    forces: Forces
    masses: Array


@jitable
def spring_energy(places: Places, k: Array, i: int, frames: Array) -> float:
    """Energy in the spring of contact i [J]."""
    pressed = max(depth(places, i, frames), 0.0)
    return 0.5 * k[i] * pressed * pressed


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


@jitable
def force_energy(forces: Forces, frames: Array, axes: tuple[int, ...]) -> float:
    """Energy of the constant forces above their position at rest [J]."""
    energy = 0.0
    for i in range(len(forces.body)):
        energy -= dot(vector(forces.force, i, axes), displacement(forces, i, frames, axes))
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
    _energies(structure._replace(ties=ties), q, v, frames, until, parts, taken)
    return parts, taken


@compiled
def _energies(
    structure: Structure, q: Array, v: Array, frames: Array, broken: Integers, parts: Array, taken: Array
) -> None:
    places, k, ties, masses = structure.places, structure.k, structure.ties, structure.masses
    for step in range(len(q)):
        take_frames(q[step], frames, places.axes)
        for j in range(len(masses)):
            parts[step, 0] += 0.5 * masses[j] * v[step, j] ** 2
        parts[step, 1] = weight_energy(masses, q[step], places.axes)
        parts[step, 1] += force_energy(structure.forces, frames, places.axes)
        for i in range(len(k)):
            parts[step, 2] += spring_energy(places, k, i, frames)
        for i in range(len(ties.k)):
            if step >= broken[i]:
                taken[step, i] = taken[step - 1, i] if step else 0.0
                if ties.reach[i] < math.inf:  # it yields up to its limit, and breaks
                    left = ties.limit[i] - ties.stretch[i] - ties.reach[i]
                    taken[step, i] += ties.k[i] * ties.stretch[i] * left
                    ties.reach[i] = math.inf
                continue
            stretched, yielded = stretch(ties, i, frames, v[step], places.axes)
            parts[step, 2] += 0.5 * ties.k[i] * stretched * stretched
            taken[step, i] = (taken[step - 1, i] if step else 0.0) + ties.k[i] * stretched * yielded


def breaks(ties: Ties, q: Array, freedom: Freedom) -> Integers:
    """The first step of a motion at whose pose each tie is longer than its limit, or the number of steps, shape (t,).

    No tie has yielded before. Poses have the shape (steps, n nq).
    """
    broken = np.full(len(ties.k), len(q))
    if np.isfinite(ties.limit).any():
        _breaks(ties, q, freedom.axes, freedom.frames(q.shape[1] // freedom.nq), broken)
    return broken


@compiled
def _breaks(ties: Ties, q: Array, axes: tuple[int, ...], frames: Array, broken: Integers) -> None:
    for step in range(len(q)):
        take_frames(q[step], frames, axes)
        for i in range(len(broken)):
            longer = ties.reach[i] - slack(ties, i, frames, q[step], q[step], axes).value > ties.limit[i]
            if longer and broken[i] == len(q):
                broken[i] = step


@dataclass(frozen=True, eq=False)
class Potential:
    """The energy of a structure at rest at a pose of shape (n nq,), and its derivatives along the velocities."""

    structure: Structure

    @property
    def springs(self) -> Array:
        """Stiffness of contacts and ties [N/m], shape (m + t,)."""
        return np.append(self.structure.k, self.structure.ties.k)

    def openings(self, pose: Array) -> Array:
        """Gaps of the contacts and slack of the ties [m], shape (m + t,)."""
        places, ties, masses = self.structure.places, self.structure.ties, self.structure.masses
        values, none = np.empty(len(places.body) + len(ties.k)), np.zeros_like(masses)
        _openings(places, ties, frames_of(pose, places.freedom), none, values)
        return values

    def pressed(self, pose: Array) -> Array:
        """How far each spring is pressed or stretched [m], zero where it is open, shape (m + t,)."""
        pressed: Array = np.maximum(-self.openings(pose), 0.0)
        return pressed

    def rates(self, pose: Array) -> csr_array:
        """Rates of the openings for unit velocities, shape (m + t, n nv)."""
        places, ties, masses = self.structure.places, self.structure.ties, self.structure.masses
        bodies, none = self._bodies, np.zeros_like(masses)
        rates = np.zeros((*bodies.shape, places.freedom.nv))
        _rates(places, ties, frames_of(pose, places.freedom), np.zeros_like(masses), none, rates)
        return entries(rates, bodies, len(masses))

    def slip_rates(self, pose: Array) -> csr_array:
        """Rates at which the points move along their faces for unit velocities, shape (m, n nv)."""
        places, masses = self.structure.places, self.structure.masses
        bodies = self._bodies[: len(places.body)]
        rates = np.zeros((*bodies.shape, places.freedom.nv))
        _slip_rates(places, frames_of(pose, places.freedom), np.zeros_like(masses), rates)
        return entries(rates, bodies, len(masses))

    @cached_property
    def _bodies(self) -> Integers:
        """The two bodies of each contact and then of each tie, shape (m + t, 2)."""
        places, ties = self.structure.places, self.structure.ties
        own = np.concatenate([places.body, ties.body]).astype(np.int64)
        return np.column_stack([own, np.concatenate([places.face_body, ties.anchor_body]).astype(np.int64)])

    def load(self, pose: Array) -> Array:
        """Generalised force of the weight and of the constant forces, shape (n nv,)."""
        places, forces, masses = self.structure.places, self.structure.forces, self.structure.masses
        axes, freedom = places.axes, places.freedom
        total, frames, upwards = np.zeros_like(masses), frames_of(pose, freedom), freedom.translations - 1
        total[upwards :: freedom.nv] = -GRAVITY * masses[upwards :: freedom.nv]
        for i, body in enumerate(forces.body):
            at = vector(forces.at, i, axes)
            push_body(frames, body, plus(at, swung(frames, body, at)), vector(forces.force, i, axes), total)
        return total

    def energy(self, pose: Array) -> float:
        """Energy of springs, weight and constant forces [J]."""
        places, forces, masses = self.structure.places, self.structure.forces, self.structure.masses
        elastic = 0.5 * float(self.springs @ self.pressed(pose) ** 2)
        weight = weight_energy(masses, pose, places.axes)
        return elastic + float(weight + force_energy(forces, frames_of(pose, places.freedom), places.axes))

    def gradient(self, pose: Array) -> Array:
        """Derivatives of the energy, shape (n nv,)."""
        gradient: Array = -self.load(pose) - self.rates(pose).T @ (self.springs * self.pressed(pose))
        return gradient

    def stiffness(self, pose: Array, springs: Array) -> csr_array:
        """Stiffness of springs of k [N/m], shape (m + t,), at the openings' rates, shape (n nv, n nv)."""
        return sprung(self.rates(pose), springs)

    def curvature(self, pose: Array) -> csr_array:
        """Geometric stiffness: the second derivatives of the openings, times the forces, shape (n nv, n nv).

        A spring that is pressed by g and whose gap has the second derivatives H adds -k g H, which is what the weight
        takes from the stiffness of a tall wall. A force that follows a turning point adds its part likewise. This part
        is that of the plane, where a body has one rotation.
        """
        places, ties = self.structure.places, self.structure.ties
        forces, masses = self.structure.forces, self.structure.masses
        frames, none, nv = frames_of(pose, places.freedom), np.zeros_like(masses), places.freedom.nv
        acting = self.springs * self.pressed(pose)
        bent = np.zeros((len(acting), 2 * nv, 2 * nv))
        _curvatures(places, ties, frames, none, acting, bent)
        bodies = np.repeat(self._bodies, nv, axis=1)
        unknown = np.where(bodies < 0, -1, nv * bodies + np.tile(np.arange(nv), 2))
        there = (unknown[:, :, None] >= 0) & (unknown[:, None] >= 0) & (acting != 0)[:, None, None]
        rows, columns = np.broadcast_to(unknown[:, :, None], bent.shape), np.broadcast_to(unknown[:, None], bent.shape)
        turning = np.zeros_like(masses)
        for i, body in enumerate(forces.body):
            at = vector(forces.at, i, places.axes)
            arm = plus(at, swung(frames, body, at))
            turning[3 * body + 2] += dot(vector(forces.force, i, places.axes), arm)
        shape = (len(masses), len(masses))
        return csr_array((bent[there], (rows[there], columns[there])), shape=shape) + diags_array(turning)

    def hessian(self, pose: Array) -> csr_array:
        """Second derivatives of the energy, shape (n nv, n nv)."""
        closed = self.openings(pose) < 0
        return self.stiffness(pose, np.where(closed, self.springs, 0.0)) + self.curvature(pose)


@inlined
def _bodies(places: Places, ties: Ties, i: int) -> tuple[int, int]:
    """The two bodies of contact i, or of the tie that follows after the contacts."""
    m = len(places.body)
    return (places.body[i], places.face_body[i]) if i < m else (ties.body[i - m], ties.anchor_body[i - m])


@compiled
def _openings(places: Places, ties: Ties, frames: Array, none: Array, values: Array) -> None:
    for i in range(len(values)):
        values[i] = opening(places, ties, i, frames, none, none).value


@compiled
def _rates(places: Places, ties: Ties, frames: Array, unit: Array, none: Array, rates: Array) -> None:
    nv = len(unit) // len(frames)
    for i in range(len(rates)):
        bodies = _bodies(places, ties, i)
        for side in range(2):
            for j in range(nv if bodies[side] >= 0 else 0):
                unit[nv * bodies[side] + j] = 1.0
                rates[i, side, j] = opening(places, ties, i, frames, unit, none).rate
                unit[nv * bodies[side] + j] = 0.0


@compiled
def _slip_rates(places: Places, frames: Array, unit: Array, rates: Array) -> None:
    nv = len(unit) // len(frames)
    for i in range(len(rates)):
        bodies = (places.body[i], places.face_body[i])
        for side in range(2):
            for j in range(nv if bodies[side] >= 0 else 0):
                unit[nv * bodies[side] + j] = 1.0
                rates[i, side, j] = along(places, i, frames, unit).rate
                unit[nv * bodies[side] + j] = 0.0


@compiled
def _curvatures(places: Places, ties: Ties, frames: Array, none: Array, force: Array, curvature: Array) -> None:
    """Write the geometric stiffness of each closed spring, for the velocities of its first and then of its second body.

    What is quadratic in the velocities in the second rate of an opening is its second derivative along them."""
    nv, unit = len(none) // len(frames), none
    for i in range(len(force)):
        if force[i] == 0:
            continue
        body, other = _bodies(places, ties, i)
        for p in range(2 * nv if other >= 0 else nv):
            for r in range(2 * nv if other >= 0 else nv):
                row = nv * body + p if p < nv else nv * other + p - nv
                column = nv * body + r if r < nv else nv * other + r - nv
                for sign in (1.0, -1.0):
                    unit[row] += 1.0
                    unit[column] += sign
                    bent = opening(places, ties, i, frames, unit, unit).swept
                    curvature[i, p, r] -= 0.25 * sign * force[i] * bent
                    unit[row], unit[column] = 0.0, 0.0
