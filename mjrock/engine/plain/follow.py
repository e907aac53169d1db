"""Follow: MuJoCo's steps of a plain model, with energy and forces at the samples.

A step takes the velocities from half a step before its pose to half a step after it. So the velocity at the pose is the
mean of both, and a force does the work that is its product with that mean and the step. At a sample half of the work of
its step is done.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import mujoco
import numpy as np

from ...bars import Bar
from ...geometry.frames import PLANE
from ...problem.masonry.histories import Support
from ...quantities import GRAVITY, Array, Integers
from ...scene.course import Course, mean_acceleration
from ...scene.scene import Scene
from ..model import require_finite
from .pairs import Pairs
from .pieces import Overlap, Piece

WARNINGS_CHECKED_EVERY = 1000
"""Steps between two checks for warnings of the engine."""
NEGLIGIBLE_DEPTH = 1e-4
"""Depth of a contact, over the smallest thickness of the two pieces, up to which an overlap is negligible [-]."""


class FoundContacts(NamedTuple):
    """The contacts that MuJoCo has found at a pose, those in the constraints.

    Args:
        number: of each among all that it lists, shape (n,).
        pair: number of its pair, the number of pairs for one without a joint, shape (n,).
        k: its spring [N/m], shape (n,).
        row: its first row among the constraints, shape (n,).
        gap: negative where it is pressed [m], shape (n,).
        pieces: numbers of the two pieces, the one that its normal points out of first, shape (n, 2).
    """

    number: Integers
    pair: Integers
    k: Array
    row: Integers
    gap: Array
    pieces: Integers


@dataclass(frozen=True, eq=False)
class PlainEngine:
    """A compiled plain model and its data, and how its geoms belong to pieces and pairs.

    Args:
        model, data: of MuJoCo.
        scene, pieces, pairs: the structure.
        supports: fixed blocks that are moved, in the order of their bodies.
    """

    model: mujoco.MjModel
    data: mujoco.MjData
    scene: Scene
    pieces: list[Piece]
    pairs: Pairs
    supports: tuple[Support, ...]

    @cached_property
    def piece(self) -> Integers:
        """Number of the piece of each geom, shape (geoms,)."""
        numbers = {piece.name: i for i, piece in enumerate(self.pieces)}
        return np.array([numbers[self.model.geom(i).name] for i in range(self.model.ngeom)])

    @cached_property
    def keys(self) -> Integers:
        """One number for the two pieces of each pair, shape (p,); they increase."""
        return np.asarray(self.pairs.pieces @ np.array([len(self.pieces), 1]))

    @cached_property
    def inverse_weight(self) -> Array:
        """Inverse weight of the body of each geom [1/kg], shape (geoms,)."""
        return np.asarray(self.model.body_invweight0[self.model.geom_bodyid, 0])

    @cached_property
    def thickness(self) -> Array:
        """The smallest extent of each piece along the axes at rest, that of the ground without end [m], (pieces,)."""
        return np.array([piece.thickness for piece in self.pieces])

    @property
    def driven(self) -> int:
        """How many velocities belong to fixed blocks that are moved; they come first."""
        return 3 * len(self.supports)

    @cached_property
    def masses(self) -> Array:
        """Masses that the ground pushes along the axes of the scene, by velocity [kg], shape (d, nv)."""
        bodies, d = self.scene.bodies, self.scene.freedom.translations
        masses = np.zeros((d, self.model.nv))
        first = self.driven + self.scene.freedom.nv * np.arange(len(bodies.mass))
        for axis in range(d):
            masses[axis, first + axis] = bodies.mass
        return masses

    @cached_property
    def dampers(self) -> list[int]:
        """Numbers of the tendons with a dashpot."""
        return [self.scene.links.names.index(name) for name in self.scene.links.damped.names]

    def contacts(self) -> FoundContacts:
        """The contacts of the last step."""
        contact = self.data.contact
        number = np.flatnonzero(contact.efc_address >= 0)
        geoms = contact.geom[number]
        pieces = self.piece[geoms]
        key = np.sort(pieces, axis=1) @ np.array([len(self.pieces), 1])
        at = np.minimum(np.searchsorted(self.keys, key), len(self.keys) - 1)
        pair = np.where(self.keys[at] == key, at, len(self.keys))
        weight = np.where(pair < len(self.keys), 1.0, self.inverse_weight[geoms].sum(axis=1))
        k, gap = self.pairs.k[pair] / weight, contact.dist[number]
        return FoundContacts(number, pair, k, contact.efc_address[number], gap, pieces)

    def deepest(self, contacts: FoundContacts, t: float, before: Overlap | None) -> Overlap | None:
        """The deepest contact at the pose of a time [s], or the one of an earlier time where that is deeper."""
        depth = -contacts.gap / self.thickness[contacts.pieces].min(axis=1)
        i = int(depth.argmax()) if len(depth) else -1
        if i < 0 or depth[i] <= (NEGLIGIBLE_DEPTH if before is None else before.depth):
            return before
        data, first, second = self.data, *(self.pieces[j] for j in contacts.pieces[i].tolist())
        bodies = self.model.geom_bodyid[data.contact.geom[contacts.number[i]]]
        place, turn = data.xpos[bodies].copy(), data.xmat[bodies].reshape(2, 3, 3).copy()
        return Overlap(float(depth[i]), t, (first, second), place, turn)

    def pose(self) -> Array:
        """Pose of the bodies as in a `Response`, shape (bodies, nq)."""
        pose = self.data.qpos[self.driven :].reshape(len(self.scene.bodies.names), -1).copy()
        if self.scene.freedom != PLANE:
            pose[:, :3] -= self.scene.bodies.rest
        return pose

    def drive(self, course: Course, t: float) -> Array:
        """Set gravity and moved supports for the step at a time [s].

        Returns:
            The mean acceleration of the ground in the step [m/s2], shape (d,).
        """
        h, ground, axes = self.model.opt.timestep, course.ground, self.scene.freedom.axes
        shaken = np.array([mean_acceleration(shaking, t, h) for shaking in (ground.x, ground.y, ground.z)])
        self.model.opt.gravity[:] = -shaken - (0.0, 0.0, GRAVITY)
        for i, support in enumerate(self.supports):
            before, places, after = support.at(np.array([t - 0.5 * h, t, t + 0.5 * h]))
            for axis, place, rate in zip(axes, places, (after - before) / h, strict=True):
                self.data.qpos[3 * i + axis], self.data.qvel[3 * i + axis] = place, rate
        return shaken[list(axes)]


class Work(NamedTuple):
    """Work in a step, or since the release [J], of one step or along the first axis of several.

    Args:
        ground: of the ground and of moved supports.
        pressed: of the normal forces of each pair, and in the last place of all other contacts, shape (p + 1,).
        rubbed: of friction.
        damped: what each damper has taken, shape (dampers,).
    """

    ground: Array
    pressed: Array
    rubbed: Array
    damped: Array

    def plus(self, other: Work, share: float = 1.0) -> Work:
        """The sum of this work and a share of another one."""
        return Work(*(part + share * added for part, added in zip(self, other, strict=True)))


class Sample(NamedTuple):
    """What is kept at a sample, or at all samples one after the other.

    Args:
        t: time [s].
        pose, velocity: shapes (bodies, nq) and (bodies, nv).
        elastic: energy in the springs of each pair and of all others [J], shape (p + 1,).
        work: since the release [J].
        deepest: the deepest contact since the sample before, if any.
        loads, contact_reactions: forces of the contacts on each joint and each fixed block, see `KeptForces`, or
            empty.
        damper_forces: force of each damper [N], shape (dampers,).
    """

    t: Array
    pose: Array
    velocity: Array
    elastic: Array
    work: Work
    deepest: list[Overlap]
    loads: Array
    contact_reactions: Array
    damper_forces: Array


def follow(engine: PlainEngine, course: Course, steps: int, stride: int, joints: JointForces | None) -> list[Sample]:
    """The samples of a run of a number of steps, every `stride`-th of which and the last are kept.

    Args:
        engine: at the release.
        course: what happens.
        steps, stride: numbers of steps.
        joints: computes forces; None where they are not kept.

    Returns:
        One sample after the other, the last at the end of the run.

    Raises:
        StepError: if the engine warns or the state is not finite.
    """
    h, data, samples = float(engine.model.opt.timestep), engine.data, list[Sample]()
    before, mean, none = np.zeros(engine.model.nv), np.zeros(engine.model.nv), len(engine.pairs.k)
    total = Work(np.zeros(()), np.zeros(none), np.zeros(()), np.zeros(len(engine.dampers)))
    nv, deepest = engine.scene.freedom.nv, None
    with Bar("plain MuJoCo", "s", steps * h) as bar:
        for n in range(steps + 1):
            t, is_sample = n * h, n % stride == 0 or n == steps
            shaken = engine.drive(course, t)
            pose = engine.pose() if is_sample else None
            before[:] = data.qvel
            mujoco.mj_step(engine.model, data)
            np.multiply(before + data.qvel, 0.5, out=mean)
            mean[: engine.driven] = before[: engine.driven]
            contacts = engine.contacts()
            work = work_of_step(engine, contacts, mean, shaken)
            deepest = engine.deepest(contacts, t, deepest)
            if pose is not None:
                energies = 0.5 * contacts.k * np.minimum(contacts.gap, 0.0) ** 2
                loads, reactions = (np.empty(0), np.empty(0)) if joints is None else joints.loads(engine, contacts)
                sample = Sample(
                    t=np.array(t),
                    pose=pose,
                    velocity=mean[engine.driven :].reshape(-1, nv).copy(),
                    elastic=sums_by_pair(engine, contacts, energies),
                    work=total.plus(work, 0.5),
                    deepest=[] if deepest is None else [deepest],
                    loads=loads,
                    contact_reactions=reactions,
                    damper_forces=engine.scene.links.damped.law["c"] * data.ten_velocity[engine.dampers],
                )
                samples.append(sample)
                deepest = None
            total = total.plus(work)
            if n % WARNINGS_CHECKED_EVERY == 0 or n == steps:
                require_finite(data, t)
                bar.to(t)
    return samples


def sums_by_pair(engine: PlainEngine, contacts: FoundContacts, values: Array) -> Array:
    """Sums of values of the contacts of each pair, and in the last place of all others, shape (p + 1,)."""
    return np.asarray(np.bincount(contacts.pair, weights=values, minlength=len(engine.pairs.k)), dtype=float)


def work_of_step(engine: PlainEngine, contacts: FoundContacts, mean: Array, shaken: Array) -> Work:
    """Work in the step that was made, from mean velocities (nv,) and the acceleration of the ground (d,)."""
    data, h, driven = engine.data, float(engine.model.opt.timestep), slice(engine.driven)
    ground = -h * float(shaken @ (engine.masses @ mean) + data.qfrc_constraint[driven] @ mean[driven])
    rates = np.zeros(data.nefc)
    if data.nefc:
        mujoco.mj_mulJacVec(engine.model, data, rates, mean)
    powers = rates * data.efc_force
    pressed = sums_by_pair(engine, contacts, h * powers[contacts.row])
    rubbed = h * float(powers.sum()) - float(pressed.sum())
    damped = h * engine.scene.links.damped.law["c"] * data.ten_velocity[engine.dampers] ** 2
    return Work(np.asarray(ground), pressed, np.asarray(rubbed), damped)


@dataclass(frozen=True, eq=False)
class JointForces:
    """Computes the forces on joints and fixed blocks.

    Args:
        joint: number of the joint of each pair and of all others, how many there are where it is none, shape (p + 1,).
        above: number of the body above each joint, shape (joints,).
        fixed: number of each fixed block by its name.
    """

    joint: Integers
    above: Integers
    fixed: dict[str, int]

    def loads(self, engine: PlainEngine, contacts: FoundContacts) -> tuple[Array, Array]:
        """Loads of joints, shape (joints, nv), and forces of fixed blocks, (blocks, d), see `KeptForces`."""
        freedom, model, data = engine.scene.freedom, engine.model, engine.data
        axes, local = list(freedom.axes), np.zeros(6)
        loads = np.zeros((len(self.above), freedom.nv))
        reactions = np.zeros((len(self.fixed), freedom.translations))
        for number, pair, (first, second) in zip(contacts.number, contacts.pair, contacts.pieces, strict=True):
            mujoco.mj_contactForce(model, data, number, local)
            contact = data.contact[number]
            force = contact.frame.reshape(3, 3).T @ local[:3]  # on the second
            moment = np.cross(contact.pos, force)
            for piece, sense in ((engine.pieces[first], -1.0), (engine.pieces[second], 1.0)):
                if piece.block in self.fixed:
                    reactions[self.fixed[piece.block]] -= sense * force[axes]
                elif self.joint[pair] < len(self.above) and piece.body == self.above[self.joint[pair]]:
                    about = moment if freedom != PLANE else moment[1:2]
                    loads[self.joint[pair]] += sense * np.concatenate([force[axes], about])
        return loads, reactions
