"""The accounts of a run: where its energy is at every step, and what dashpots, friction and the ground did to it.

Everything follows from the recorded poses and half-step velocities. Energies are evaluated half a step before each
pose, where the leapfrog's velocity is exact and where a touch that is centred in time falls. From one of these times to
the next, which is the window of a step, a constant force acts. What it does to the kinetic energy is force times mean
velocity times length, without error. With Newmark's beta = 1/4 a spring stores exactly what it should; with another
beta the residual contains the (1/4 - beta) h^2 k v^2 / 2 by which the step shifts the energy of the contact.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, inlined
from ..geometry.frames import take_frames
from ..geometry.kinematics import Places, gap, meeting, relative_velocity, where_friction_acts
from ..geometry.poses import moved
from ..geometry.vectors import dot
from ..quantities import Array, Integers
from ..result.ledger import Ledger
from ..scene.course import Course, Shaking, mean_acceleration
from ..scene.dampers import dissipated_by_dampers
from ..scene.potential import breaks, spring_energy
from ..scene.scene import Scene
from .record import Record, StepKinds, Steps, Windows
from .rows import Points, Step, impratio_of, points_of, row_of
from .sliding import slip_of


def ground_work(scene: Scene, course: Course, steps: Steps) -> Array:
    """Work that the moving ground has done in the window of each step [J], shape (steps,)."""
    work, windows, freedom = np.zeros(len(steps.t)), steps.windows, scene.places.freedom
    ground = course.ground
    for axis, shaking in ((0, ground.x), (freedom.translations - 1, ground.z), (1, ground.y)):
        if len(shaking.accel):
            momentum = windows.mean[:, axis :: freedom.nv] @ scene.bodies.mass
            _ground_work(shaking, steps.t, steps.h, windows.width, momentum, work)
    return work


@compiled
def _ground_work(shaking: Shaking, t: Array, h: Array, width: Array, momentum: Array, work: Array) -> None:
    for n in range(len(t)):
        work[n] -= mean_acceleration(shaking, t[n], h[n]) * momentum[n] * width[n]


class Work(NamedTuple):
    """What the contacts take from a motion.

    Args:
        dashpots, friction: work in the window of each step [J], shapes (steps, joints) and (steps,).
        impulses: of the lift of contacts that slide on their rows, and of their law [N s], shape (2,).
    """

    dashpots: Array
    friction: Array
    impulses: Array

    @property
    def lift(self) -> float:
        """Impulse that the rows of sliding contacts add to their normal force, over the impulse of the contact law in
        the steps in which they slide [-]."""
        lift, pressed = self.impulses.tolist()
        return lift / pressed if pressed else 0.0


def contact_work(scene: Scene, steps: Steps) -> Work:
    """What the contacts take from a motion."""
    count = len(steps.t)
    work = Work(np.zeros((count, len(scene.contacts.joints))), np.zeros(count), np.zeros(2))
    points, room = points_of(scene, steps.method), LedgerRoom.for_scene(scene)
    _contact_work(points, steps.record, steps.windows, steps.kinds, room, work)
    return work


def ledger(scene: Scene, course: Course, steps: Steps) -> Ledger:
    """The ledger of a run."""
    windows, broken = steps.windows, breaks(scene.ties, steps.pose)
    stored, dissipated = scene.accounts(windows.pose, windows.velocity, broken)
    lost = lost_by_breaking(scene, broken, len(steps.t))
    stored[:, 1] = scene.accounts(windows.placed, windows.velocity)[0][:, 1]
    dashpots, friction, _ = contact_work(scene, steps)
    friction[:-1] -= regained(scene, steps)
    dampers = dissipated_by_dampers(scene.dampers, steps.pose, windows.mean, windows.width, steps.record.damping)
    dashpots = np.concatenate([dashpots, dampers], axis=1)
    return Ledger(
        t=windows.t,
        kinetic=stored[:, 0],
        potential=stored[:, 1],
        elastic=stored[:, 2],
        dashpots={
            name: _since_release(dashpots[:, i])
            for i, name in enumerate((*scene.contacts.joints, *scene.links.damped.names))
        },
        friction=_since_release(friction),
        ground=_since_release(ground_work(scene, course, steps)),
        ties=dict(zip(scene.links.sprung.names, (dissipated - dissipated[0]).T, strict=True)),
        broken={name: account - account[0] for name, account in lost.items()},
    )


def lost_by_breaking(scene: Scene, broken: Integers, steps: int) -> dict[str, Array]:
    """Elastic energy that each tie that may break has lost by doing so, up to each of a number of steps [J]."""
    links, elastic = scene.links.sprung, 0.5 * scene.ties.k * scene.ties.stretch**2
    may = np.flatnonzero(np.isfinite(scene.ties.limit))
    return {links.names[i]: np.where(np.arange(steps) >= broken[i], elastic[i], 0.0) for i in may}


def regained(scene: Scene, steps: Steps) -> Array:
    """Energy that ties and constant forces regain after each step but the last [J], shape (steps - 1,).

    An edge that sticks creeps a little in every step, and is put back to where it stuck. What friction has taken by
    then is there again. Otherwise it would add up under a thrust that a resting wall bears for long.
    """
    pose = np.empty((2 * len(steps.t) - 1, steps.pose.shape[1]))
    pose[::2], pose[1::2] = steps.pose, moved(steps.pose, steps.h[:, None] * steps.record.after, scene.freedom)[:-1]
    broken = np.maximum(2 * breaks(scene.ties, steps.pose) - 1, 0)  # before the drift that ends at the pose
    stored = scene.accounts(pose, np.zeros((len(pose), len(scene.bodies.masses))), broken)[0].sum(axis=1)
    gained: Array = stored[2::2] - stored[1::2]
    return gained


def _since_release(work: Array) -> Array:
    """Sums up to the start of each window."""
    return np.append(0.0, np.cumsum(work[:-1]))


@inlined
def cone_force(normal: float, stopping: float, slip_inertia: float, inertia: float, mu: float) -> tuple[float, float]:
    """Normal and tangential force of an elliptic contact, as MuJoCo solves it.

    A contact that sticks has the forces of its two rows. One that slides has a force on the cone, mu times the normal
    one: the point of the cone that is nearest to the forces of the rows, weighted with their inertias. One that is
    pulled open has none.

    Args:
        normal, stopping: forces of the two rows without the cone [N].
        slip_inertia, inertia: inertias of the two rows [kg].
        mu: coefficient of friction [-].
    """
    sideways = abs(stopping)
    if normal > 0 and sideways <= mu * normal:
        return normal, stopping
    share = mu * mu * inertia / slip_inertia
    pressing = (normal + mu * sideways * inertia / slip_inertia) / (1 + share)
    if pressing <= 0:
        return 0.0, 0.0
    return pressing, math.copysign(mu * pressing, stopping)


class LedgerRoom(NamedTuple):
    """Room for one step.

    Args:
        frames, seam, next_seam: frames of the pose, and of the two ends of its window.
        middle, acceleration, mean: velocity around the pose, acceleration, and mean velocity in the window, (n nv,).
        dashpot, inertia: of the row of each contact, shape (m,).
    """

    frames: Array
    seam: Array
    next_seam: Array
    middle: Array
    acceleration: Array
    mean: Array
    dashpot: Array
    inertia: Array

    @classmethod
    def for_scene(cls, scene: Scene) -> LedgerRoom:
        """Room for a step of a scene."""
        freedom, coordinates, contacts = scene.freedom, len(scene.bodies.masses), len(scene.contacts.k)
        frames = (freedom.frames(len(scene.bodies.mass)) for _ in range(3))
        return cls(*frames, *np.empty((3, coordinates)), *np.empty((2, contacts)))


class RecordedStep(NamedTuple):
    """A step of a record: its number, its length and constants, and impratio of the model in it [-]."""

    n: int
    step: Step
    impratio: float


@inlined
def take_step(
    points: Points, record: Record, windows: Windows, kinds: StepKinds, n: int, room: LedgerRoom
) -> RecordedStep:
    """Write frames, rates and rows of step n of the record into the room, and return the step."""
    axes, kind = points.places.axes, kinds.kind[n]
    take_frames(record.pose[n], room.frames, axes)
    take_frames(windows.pose[n], room.seam, axes)
    take_frames(windows.pose[min(n + 1, len(record.h) - 1)], room.next_seam, axes)
    for j in range(len(room.mean)):
        room.middle[j] = 0.5 * (record.before[n, j] + record.after[n, j])
        room.acceleration[j] = (record.after[n, j] - record.before[n, j]) / record.h[n]
        room.mean[j] = windows.mean[n, j]
    step, impratio = Step(record.h[n], kinds.beta[kind], kinds.ringing[kind]), math.inf
    for i in range(len(room.inertia)):
        room.dashpot[i], room.inertia[i] = row_of(points, i, step)
        impratio = min(impratio, impratio_of(points, i, room.inertia[i], step.h))
    return RecordedStep(n, step, impratio)


@inlined
def slip_along(places: Places, i: int, frames: Array, v: Array, other: Array) -> float:
    """Slip of contact i for velocities v, along the slip for other velocities, against which friction acts [m/s].

    In the plane there is one direction. In space friction of the rows is against the slip after the step, and Coulomb's
    against that at the pose.
    """
    meets = where_friction_acts(places, meeting(places, i, frames))
    velocity = relative_velocity(places, i, meets, frames, v)
    return dot(slip_of(meets.normal, relative_velocity(places, i, meets, frames, other)).direction, velocity)


class ContactForces(NamedTuple):
    """A contact in a step.

    Args:
        gap: [m].
        dashpot: force of its dashpot [N].
        law: force of its row along the normal without friction, negative where it would pull [N].
        row: the same with friction, not below zero. What slides on its row presses more.
        along: friction along its slip, see `slip_along` [N].
        coulomb: whether it slides by Coulomb's law, without a row of friction.
    """

    gap: float
    dashpot: float
    law: float
    row: float
    along: float
    coulomb: bool


@inlined
def contact_in_step(points: Points, record: Record, recorded: RecordedStep, room: LedgerRoom, i: int) -> ContactForces:
    """Gap and forces of contact i in a step of a record. The room has the frames, rates and rows of that step."""
    places, inertia, (n, step, impratio) = points.places, room.inertia[i], recorded
    closed = gap(places, i, room.frames, room.middle, room.acceleration)
    curve = closed.linear
    sprung = step.beta[i] * (step.h * step.h) * places.k[i] * curve  # what Newmark's beta adds to the spring
    # the row acts on the velocity that the leapfrog keeps, half a step before the pose
    dashpot = room.dashpot[i] * (closed.rate - 0.5 * step.h * curve) + inertia * curve - sprung
    pressed = -(places.k[i] * closed.value + dashpot + sprung)
    row, along, coulomb = max(pressed, 0.0), 0.0, not math.isnan(record.friction[n, i])
    if places.friction[i] > 0 and (closed.value < 0 or n == 0):
        along = record.friction[n, i]
        if not coulomb:
            slip = slip_along(places, i, room.frames, record.after[n], record.after[n])
            stopping = -impratio * inertia * slip / step.h
            row, along = cone_force(pressed, stopping, impratio * inertia, inertia, places.friction[i])
    return ContactForces(closed.value, dashpot, pressed, row, along, coulomb)


@compiled
def _contact_work(
    points: Points, record: Record, windows: Windows, kinds: StepKinds, room: LedgerRoom, work: Work
) -> None:
    """Add up the work of dashpots and friction in the window of each step."""
    places, joint = points.places, points.places.joint
    for n in range(len(record.h)):
        recorded = take_step(points, record, windows, kinds, n, room)
        for i in range(len(joint)):
            contact = contact_in_step(points, record, recorded, room, i)
            released = spring_energy(places, i, room.seam) - spring_energy(places, i, room.next_seam)
            if not kinds.released_on[i] if n == 0 else contact.gap >= 0:
                work.dashpots[n, joint[i]] += released
                continue
            # the dashpot of a point that has closed but does not press takes the energy that the spring releases
            opened = gap(places, i, room.frames, room.mean, room.mean).rate * windows.width[n]
            work.dashpots[n, joint[i]] += contact.dashpot * opened if contact.law > 0 else released
            if places.friction[i] > 0:
                lift = contact.row - max(contact.law, 0.0)  # what a sliding cone presses on top of the law
                if points.rubs[i] and lift > 0:
                    work.impulses[0] += lift * record.h[n]
                    work.impulses[1] += max(contact.law, 0.0) * record.h[n]
                slipping = room.middle if contact.coulomb else record.after[n]
                slipped = slip_along(places, i, room.frames, room.mean, slipping) * windows.width[n]
                work.friction[n] -= contact.along * slipped + lift * opened
