"""Potential: what has energy in a scene, this energy at the poses of a motion, as a function of the pose with its
derivatives, and the frequencies that follow.

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

from ..compiled import compiled, inlined
from ..geometry.frames import (
    SPACE,
    Freedom,
    displaced,
    frames_of,
    inverse_rotation_change,
    place,
    push_body,
    rotation_change,
    take_frames,
    velocities,
)
from ..geometry.kinematics import (
    AppliedForces,
    Meeting,
    Places,
    Ties,
    depth,
    displacement,
    meeting,
    opening,
    relative_velocity,
    slack,
    stretch,
    swept_along,
    tangents_at,
    where_friction_acts,
)
from ..geometry.poses import at_rest
from ..geometry.vectors import Vector, dot, minus, plus, vector
from ..linear import highest_square, rates_matrix, stiffness_of_springs, sum_of_pair_matrices, summed
from ..problem.masonry.laws.joint_law import law_rows, resting, stored, tangent_stiffness
from ..problem.masonry.laws.own_law import OwnSprings
from ..quantities import GRAVITY, Array, Flags, Integers, frozen
from ..rows import Rows
from .masses import coupling
from .pattern import PairPattern

NO_PRODUCTS: Array = np.empty((0, 3))
"""Of bodies of the plane, and of bodies of space whose axes are principal ones."""
NO_PRODUCTS.setflags(write=False)
SPRINGS_PER_BATCH = 32768
"""Springs whose geometric stiffness is computed together, which takes 150 MB in space [-]."""


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
    return stored(places.law[i], -depth(places, i, frames))


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
    """Kinetic, potential and elastic energy at the steps of a motion [J], shape (steps, 3), and what ties have
    dissipated up to each step by yielding [J], shape (steps, t).

    The potential energy is that of the weight above the position of rest of the centroids, and that of the constant
    forces.

    Args:
        structure: what has energy.
        q, v: poses and velocities, shapes (steps, n nq) and (steps, n nv).
        broken: the step from which each tie no longer acts, shape (t,), as many as there are steps or more for one that
            does not break. None breaks none.
    """
    parts, dissipated = np.zeros((len(q), 3)), np.zeros((len(q), len(structure.ties.k)))
    ties = structure.ties._replace(reach=np.array(structure.ties.reach))
    freedom, until = structure.places.freedom, np.full(dissipated.shape[1], len(q)) if broken is None else broken
    frames = freedom.frames(q.shape[1] // freedom.nq)
    _energies(structure._replace(ties=ties), frozen(q), frozen(v), frames, until, parts, dissipated)
    return parts, dissipated


@compiled
def _energies(
    structure: Structure, q: Array, v: Array, frames: Array, broken: Integers, parts: Array, dissipated: Array
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
                dissipated[step, i] = dissipated[step - 1, i] if step else 0.0
                if ties.reach[i] < math.inf:  # it yields up to its limit, and breaks
                    remaining = ties.limit[i] - ties.stretch[i] - ties.reach[i]
                    dissipated[step, i] += ties.k[i] * ties.stretch[i] * remaining
                    ties.reach[i] = math.inf
                continue
            stretched, yielded = stretch(ties, i, frames, v[step])
            parts[step, 2] += 0.5 * ties.k[i] * stretched * stretched
            dissipated[step, i] = (dissipated[step - 1, i] if step else 0.0) + ties.k[i] * abs(stretched) * yielded


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


@dataclass(frozen=True, eq=False)
class Potential:
    """The energy of a structure at rest at a pose of shape (n nq,), and its derivatives along the velocities."""

    structure: Structure
    own_springs: OwnSprings | None = None

    @cached_property
    def law(self) -> Rows:
        """Rows of the law of contacts and ties, of which a tie has the spring alone, shape (m + t,)."""
        ties = law_rows(len(self.structure.ties.k), k=self.structure.ties.k)
        return np.append(self.structure.places.law, ties).view(np.recarray)

    @cached_property
    def bonded(self) -> Flags:
        """Which contacts and ties pull as they push, shape (m + t,): those with a bond in tension, or a law that
        pulls."""
        pulls = np.append(self.structure.places.tension > 0, np.zeros(len(self.structure.ties.k), dtype=bool))
        if self.own_springs is not None:
            pulls[self.own_springs.springs] = self.own_springs.pulls
        return pulls

    def closed(self, openings: Array) -> Flags:
        """Which springs act at their openings [m], shape (m + t,)."""
        return np.asarray((openings < 0) | self.bonded)

    def forces_at(self, openings: Array) -> Array:
        """Force of each spring at its opening, below zero where a bond pulls [N], shape (m + t,)."""
        return self.resting(openings)[0]

    def resting(self, openings: Array) -> tuple[Array, Array]:
        """Force [N] and energy [J] of each spring at its opening [m], shape (m + t,) each."""
        force, energy = resting(self.law, openings, self.bonded)
        if self.own_springs is not None:
            force[self.own_springs.springs], energy[self.own_springs.springs] = self.own_springs.answers(openings)
        return force, energy

    def springs_at(self, openings: Array) -> Array:
        """Stiffness of contacts and ties at their openings [N/m], shape (m + t,)."""
        springs = np.array(tangent_stiffness(self.law, np.maximum(-openings, 0.0)))
        if self.own_springs is not None:
            springs[self.own_springs.springs] = self.own_springs.slopes(openings)
        return springs

    @property
    def springs(self) -> Array:
        """Stiffness of contacts and ties [N/m], shape (m + t,)."""
        return np.append(self.structure.places.k, self.structure.ties.k)

    def openings(self, pose: Array) -> Array:
        """Gaps of the contacts and slack of the ties [m], shape (m + t,)."""
        places, ties, masses = self.structure.places, self.structure.ties, self.structure.masses
        values, still = np.empty(len(places.body) + len(ties.k)), np.zeros_like(masses)
        _openings(places, ties, frames_of(pose, places.freedom), still, values)
        return values

    def pressed(self, pose: Array) -> Array:
        """Deformation of each spring, zero where it is open [m], shape (m + t,)."""
        pressed: Array = np.maximum(-self.openings(pose), 0.0)
        return pressed

    def pushes(self, pose: Array) -> Array:
        """Force of each spring [N], zero where it is open and below zero where a bond pulls, shape (m + t,)."""
        return self.forces_at(self.openings(pose))

    def rates(self, pose: Array) -> csr_array:
        """Rates of the openings for unit velocities, shape (m + t, n nv)."""
        return rates_matrix(self.pair_rates(pose), self._bodies, len(self.structure.masses))

    def pair_rates(self, pose: Array) -> Array:
        """The same for the velocities of the two bodies of each contact and tie, shape (m + t, 2, nv)."""
        places, ties, masses = self.structure.places, self.structure.ties, self.structure.masses
        rates = np.zeros((*self._bodies.shape, places.freedom.nv))
        _rates(places, ties, frames_of(pose, places.freedom), np.zeros_like(masses), np.zeros_like(masses), rates)
        return rates

    def slip_rates(self, pose: Array) -> tuple[csr_array, ...]:
        """Rates at which the points move along their faces for unit velocities, shape (m, n nv).

        One matrix for each direction along a face: one in the plane, and in space the two `tangents` of the face at
        rest, which turn with its body, where friction acts: halfway between the point and the face.
        """
        rates, masses = self.pair_slip_rates(pose), self.structure.masses
        return tuple(rates_matrix(values, self._bodies[: len(values)], len(masses)) for values in rates)

    def pair_slip_rates(self, pose: Array) -> Array:
        """The same for the velocities of the two bodies of each contact, shape (directions, m, 2, nv)."""
        places, freedom = self.structure.places._replace(radius=0.0), self.structure.places.freedom
        rates = np.zeros((freedom.translations - 1, len(places.body), 2, freedom.nv))
        _slip_rates(places, frames_of(pose, freedom), np.zeros_like(self.structure.masses), rates)
        return rates

    @cached_property
    def pattern(self) -> PairPattern:
        """Which entries a stiffness of the contacts and ties may have."""
        nv = self.structure.places.freedom.nv
        return PairPattern(self._bodies, nv, len(self.structure.masses) // nv)

    def slips(self, pose: Array) -> Array:
        """Displacement of each point along its face from rest, see `slip_rates` [m], shape (m, directions)."""
        places = self.structure.places
        slips = np.empty((len(places.body), places.freedom.translations - 1))
        _slips(places, frames_of(pose, places.freedom), slips)
        return slips

    @property
    def unmoved(self) -> Array:
        """The undeformed pose, shape (n nq,)."""
        freedom = self.structure.places.freedom
        return at_rest(len(self.structure.masses) // freedom.nv, freedom)

    @cached_property
    def _bodies(self) -> Integers:
        """The two bodies of each contact and then of each tie, shape (m + t, 2)."""
        places, links = self.structure.places, self.structure.ties.links
        bodies = np.concatenate([places.body, links.body]).astype(np.int64)
        return np.column_stack([bodies, np.concatenate([places.face_body, links.anchor_body]).astype(np.int64)])

    def load(self, pose: Array) -> Array:
        """Generalised force of the weight and of the constant forces, shape (n nv,)."""
        places, forces, masses = self.structure.places, self.structure.forces, self.structure.masses
        axes, freedom = places.axes, places.freedom
        total, frames, upwards = np.zeros_like(masses), frames_of(pose, freedom), freedom.translations - 1
        total[upwards :: freedom.nv] = -GRAVITY * masses[upwards :: freedom.nv]
        for i, body in enumerate(forces.body):
            at = vector(forces.at, i, axes)
            push_body(frames, body, plus(at, rotation_change(frames, body, at)), vector(forces.force, i, axes), total)
        return total

    def energy(self, pose: Array) -> float:
        """Energy of springs, weight and constant forces [J]."""
        places, forces, masses = self.structure.places, self.structure.forces, self.structure.masses
        elastic = float(self.resting(self.openings(pose))[1].sum())
        weight = weight_energy(masses, pose, places.axes)
        return elastic + float(weight + force_energy(forces, frames_of(pose, places.freedom)))

    def gradient(self, pose: Array) -> Array:
        """Derivatives of the energy, shape (n nv,)."""
        gradient: Array = -self.load(pose) - self.rates(pose).T @ self.pushes(pose)
        return gradient

    def stiffness(self, pose: Array, springs: Array) -> csr_array:
        """Stiffness of springs of k [N/m], shape (m + t,), at the openings' rates, shape (n nv, n nv)."""
        return stiffness_of_springs(self.rates(pose), springs)

    def curvature(self, pose: Array, friction: Array | None = None, pushes: Array | None = None) -> csr_array:
        """Geometric stiffness: the second derivatives of the openings and slips, times the forces, shape (n nv, n nv).

        A spring that is pressed by g and whose gap has the second derivatives H adds -k g H, which is what the weight
        takes from the stiffness of a tall wall. Friction adds the same with the second derivatives of the slip. A force
        F that follows a turning point at r from the centroid adds F.r 1 - (F r^T + r F^T) / 2 to the rotations in
        space, and F.r to the one rotation of the plane.

        Args:
            pose: of shape (n nq,).
            friction: on the bodies of the points along the tangential directions of `slip_rates` [N], shape
                (m, directions), or None.
            pushes: those at the pose, if they are known.
        """
        places, ties = self.structure.places, self.structure.ties
        forces, masses = self.structure.forces, self.structure.masses
        frames, still = frames_of(pose, places.freedom), np.zeros_like(masses)
        pushes = self.pushes(pose) if pushes is None else pushes
        friction = np.zeros((len(places.body), places.freedom.translations - 1)) if friction is None else friction
        has_force = pushes != 0
        has_force[: len(friction)] |= friction.any(axis=1)
        loaded = np.flatnonzero(has_force)
        parts = []
        for start in range(0, max(len(loaded), 1), SPRINGS_PER_BATCH):
            batch = loaded[start : start + SPRINGS_PER_BATCH]
            curvatures = np.zeros((len(batch), 2 * places.freedom.nv, 2 * places.freedom.nv))
            _curvatures(places, ties, frames, still, (pushes, friction), batch, curvatures)
            parts.append(sum_of_pair_matrices(curvatures, self._bodies[batch], len(masses)))
        of_springs = parts[0] if len(parts) == 1 else summed(parts)
        if not len(forces.body):
            return of_springs
        return csr_array(of_springs + _turning_forces(forces, frames, len(masses)))


def _turning_forces(forces: AppliedForces, frames: Array, unknowns: int) -> csr_array:
    """Second derivatives of the energy of the constant forces, shape (n nv, n nv)."""
    axes = forces.axes
    full, nv = np.zeros((unknowns, unknowns)) if len(axes) == 3 else np.zeros(0), velocities(axes)
    diagonal = np.zeros(unknowns)
    for i, body in enumerate(forces.body):
        at, force = vector(forces.at, i, axes), vector(forces.force, i, axes)
        if len(axes) == 2:
            diagonal[nv * body + 2] += dot(force, plus(at, rotation_change(frames, body, at)))
        else:
            r, local = np.array(at), np.array(plus(force, inverse_rotation_change(frames, body, force)))
            part = slice(nv * body + 3, nv * body + 6)
            full[part, part] += r @ local * np.eye(3) - 0.5 * (np.outer(r, local) + np.outer(local, r))
    return csr_array(diags_array(diagonal) if not full.size else csr_array(full))


@inlined
def _bodies(places: Places, ties: Ties, i: int) -> tuple[int, int]:
    """The two bodies of contact i, or of the tie that follows after the contacts."""
    m = len(places.body)
    return (places.body[i], places.face_body[i]) if i < m else (ties.links.body[i - m], ties.links.anchor_body[i - m])


@compiled
def _openings(places: Places, ties: Ties, frames: Array, still: Array, values: Array) -> None:
    for i in range(len(values)):
        values[i] = opening(places, ties, i, frames, still, still).value


@compiled
def _rates(places: Places, ties: Ties, frames: Array, unit: Array, still: Array, rates: Array) -> None:
    nv = len(unit) // len(frames)
    for i in range(len(rates)):
        bodies = _bodies(places, ties, i)
        for side in range(2):
            for j in range(nv if bodies[side] >= 0 else 0):
                unit[nv * bodies[side] + j] = 1.0
                rates[i, side, j] = opening(places, ties, i, frames, unit, still).rate
                unit[nv * bodies[side] + j] = 0.0


@compiled
def _slip_rates(places: Places, frames: Array, unit: Array, rates: Array) -> None:
    nv = len(unit) // len(frames)
    for i in range(len(places.body)):
        bodies, tangents = (places.body[i], places.face_body[i]), tangents_at(places, i, frames)
        meets = where_friction_acts(places, meeting(places, i, frames))
        for side in range(2):
            for j in range(nv if bodies[side] >= 0 else 0):
                unit[nv * bodies[side] + j] = 1.0
                velocity = relative_velocity(places, i, meets, frames, unit)
                for k in range(len(tangents)):
                    rates[k, i, side, j] = dot(tangents[k], velocity)
                unit[nv * bodies[side] + j] = 0.0


@compiled
def _slips(places: Places, frames: Array, slips: Array) -> None:
    for i in range(len(slips)):
        axes, body, face = places.axes, places.body[i], places.face_body[i]
        at = vector(places.at, i, axes)
        relative = displaced(place(frames, body, axes), frames, body, at)
        tangents = tangents_at(places, i, frames)
        if face >= 0:
            at = plus(vector(places.face_at, i, axes), vector(places.between, i, axes))
            relative = minus(relative, displaced(place(frames, face, axes), frames, face, at))
        for k in range(len(tangents)):
            slips[i, k] = dot(tangents[k], relative)


@compiled
def _curvatures(
    places: Places,
    ties: Ties,
    frames: Array,
    still: Array,
    forces: tuple[Array, Array],
    springs: Integers,
    curvature: Array,
) -> None:
    """Write the geometric stiffness of some springs and of their friction, for the velocities of the first and then of
    the second body of each, shape (springs, 2 nv, 2 nv).

    What is quadratic in the velocities in the second rate of an opening is its second derivative along them."""
    nv, unit, (push, friction) = len(still) // len(frames), still, forces
    for slot, i in enumerate(springs):
        body, other = _bodies(places, ties, i)
        count = 2 * nv if other >= 0 else nv
        if i < len(friction):
            meets, tangents = meeting(places, i, frames), tangents_at(places, i, frames)
        for p in range(count):
            for r in range(p, count):
                row = nv * body + p if p < nv else nv * other + p - nv
                column = nv * body + r if r < nv else nv * other + r - nv
                for sign in (1.0, -1.0):
                    unit[row] += 1.0
                    unit[column] += sign
                    if i < len(friction):
                        power = push[i] * swept_along(places, i, meets, frames, unit, meets.normal)
                        power += swept_by_friction(places, i, meets, tangents, frames, unit, friction[i])
                    else:
                        power = push[i] * slack(ties, i - len(friction), frames, unit, unit).swept
                    curvature[slot, p, r] -= 0.25 * sign * power
                    unit[row], unit[column] = 0.0, 0.0
                curvature[slot, r, p] = curvature[slot, p, r]


@inlined
def swept_by_friction(
    places: Places, i: int, meets: Meeting, tangents: tuple[Vector, ...], frames: Array, v: Array, friction: Array
) -> float:
    """Friction times the second rates of slip, the part of it that is quadratic in the velocities."""
    power = 0.0
    for k in range(len(tangents)):
        power += friction[k] * swept_along(places, i, meets, frames, v, tangents[k])
    return power


Principal = tuple[csr_array, Array]
"""Velocities along principal axes, and the masses of each, see `masses.principal`."""


def highest_frequency(potential: Potential, principal: Principal) -> float:
    """The highest natural frequency with every contact closed and free to slide [rad/s].

    No contact state of a run vibrates faster, because opening a contact or holding it sideways only lowers it.
    """
    stiffness, (columns, masses) = potential.stiffness(potential.unmoved, potential.springs), principal
    if potential.structure.places.freedom == SPACE:
        stiffness = csr_array(columns.T @ stiffness @ columns)
    return math.sqrt(highest_square(stiffness, masses))


def tie_frequency(potential: Potential, principal: Principal) -> float:
    """The highest natural frequency of the bodies on one tie alone [rad/s], zero without ties."""
    k, (columns, masses) = potential.structure.ties.k, principal
    rates = potential.rates(potential.unmoved)[len(potential.structure.places.k) :]
    if potential.structure.places.freedom == SPACE:
        rates = csr_array(rates @ columns)
    return math.sqrt(max(k * (rates.power(2) @ (1 / masses)), default=0.0))


def rocking_frequency(mass: Array, inertia: Array, outlines: tuple[Array, ...]) -> float:
    """The largest p = sqrt(m g R / (I + m R^2)) of bodies [rad/s], R to the farthest of the vertices of each outline.

    In space I is the smallest principal moment of inertia.
    """
    R = np.array([np.hypot.reduce(corners, axis=1).max() for corners in outlines])
    least = inertia if inertia.ndim == 1 else np.linalg.eigvalsh(inertia)[:, 0]
    return math.sqrt(float(np.max(mass * GRAVITY * R / (least + mass * R**2))))
