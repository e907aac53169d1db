"""The accounts of a run: where its energy is at every step, and what dashpots, friction and the ground did to it.

Everything follows from the recorded poses and half-step velocities. The books are kept at the seams of the leapfrog's
windows, where a velocity is known and where a touch that is centred in time falls. Over a window a constant force acts.
What it does to the kinetic energy is force times mean velocity times length, without error. With Newmark's beta = 1/4 a
spring stores exactly what it should; with another beta the residual contains the (1/4 - beta) h^2 k v^2 / 2 by which
the step shifts the energy of the contact.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import compiled, jitable
from ..problem.quantities import Array, Flags, Integers
from ..result.ledger import Ledger
from .contact import row
from .ground import Ground, Shaking, mean_acceleration
from .kinematics import Points, along, gap, spring_energy, take_frame
from .scene import Scene
from .steps import Steps, Windows


def ground_work(scene: Scene, steps: Steps) -> Array:
    """Work that the moving ground has done in the window of each step [J], shape (steps,)."""
    work, ground, windows = np.zeros(len(steps.t)), Ground.of(scene.motion, scene.vertical), steps.windows
    for first, shaking in enumerate(ground):
        if len(shaking.accel):
            momentum = windows.mean[:, first::3] @ scene.mass
            _ground_work(shaking, steps.t, steps.h, windows.width, momentum, work)
    return work


@compiled
def _ground_work(shaking: Shaking, t: Array, h: Array, width: Array, momentum: Array, work: Array) -> None:
    for n in range(len(t)):
        work[n] -= mean_acceleration(shaking, t[n], h[n]) * momentum[n] * width[n]


class ContactWork(NamedTuple):
    """What the contacts take from a motion.

    Args:
        groups: names of the groups of contacts.
        dashpots, friction: work in the window of each step [J], shapes (steps, groups) and (steps,).
        lift: impulse that the rows of sliding contacts add to their normal force, over the impulse of the contact law
            in the steps in which they slide [-].
    """

    groups: tuple[str, ...]
    dashpots: Array
    friction: Array
    lift: float


def contact_work(scene: Scene, steps: Steps) -> ContactWork:
    """What the contacts take from a motion."""
    groups = tuple(dict.fromkeys(scene.group))
    dashpots, friction = np.zeros((len(steps.t), len(groups))), np.zeros(len(steps.t))
    impulses = np.zeros(2)
    _contact_work(
        scene.points,
        np.array([groups.index(name) for name in scene.group]),
        steps.h,
        steps.pose,
        steps.before,
        steps.after,
        steps.windows,
        steps.beta,
        steps.ringing,
        steps.kind,
        steps.friction,
        steps.released_on,
        np.empty((3, len(scene.mass), 4)),
        np.empty((len(scene.k), 2)),
        np.empty((3, len(scene.masses))),
        dashpots,
        friction,
        impulses,
    )
    return ContactWork(groups, dashpots, friction, float(impulses[0] / impulses[1]) if impulses[1] else 0.0)


def ledger(scene: Scene, steps: Steps) -> Ledger:
    """The ledger of a run."""
    windows = steps.windows
    stored, taken = scene.accounts(windows.pose, windows.velocity)
    stored[:, 1] = scene.accounts(windows.placed, windows.velocity)[0][:, 1]
    groups, dashpots, friction, _ = contact_work(scene, steps)
    friction[:-1] -= given_back(scene, steps)
    return Ledger(
        t=windows.t,
        kinetic=stored[:, 0],
        potential=stored[:, 1],
        elastic=stored[:, 2],
        dashpots={name: _since_release(dashpots[:, i]) for i, name in enumerate(groups)},
        friction=_since_release(friction),
        ground=_since_release(ground_work(scene, steps)),
        ties=dict(zip(scene.tie_names, (taken - taken[0]).T, strict=True)),
    )


def given_back(scene: Scene, steps: Steps) -> Array:
    """Energy that ties and constant forces regain after each step but the last [J], shape (steps - 1,).

    An edge that sticks creeps a little in every step, and is put back to where it stuck. What friction has taken on the
    way is then there again. It would else add up under a thrust that a resting wall bears for long.
    """
    pose = np.empty((2 * len(steps.t) - 1, steps.pose.shape[1]))
    pose[::2], pose[1::2] = steps.pose, (steps.pose + steps.h[:, None] * steps.after)[:-1]
    stored = scene.accounts(pose, np.zeros_like(pose))[0].sum(axis=1)
    gained: Array = stored[2::2] - stored[1::2]
    return gained


def _since_release(work: Array) -> Array:
    """Sums up to the start of each window."""
    return np.append(0.0, np.cumsum(work[:-1]))


@jitable
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


@jitable
def take_rows(points: Points, h: float, beta: Array, ringing: Array, rows: Array) -> float:
    """Write dashpot [N s/m] and inertia [kg] of every contact in a step, shape (m, 2), and return impratio [-]."""
    impratio = math.inf
    for i in range(len(points.k)):
        rows[i, 0], rows[i, 1] = row(
            points.k[i], points.c[i], h, points.weight[i], beta[i], ringing[i], points.overdamped[i]
        )
        if points.held[i] > 0:
            impratio = min(impratio, max(points.growth * h, 1.0) * points.held[i] / rows[i, 1])
    return impratio


@jitable
def drag_of(
    points: Points, i: int, dashpot: float, inertia: float, beta: float, h: float, rate: float, curve: float
) -> tuple[float, float]:
    """Force of the dashpot of contact i, centred or at the end of the step, and what Newmark's beta adds to its spring.

    Args:
        points: the contacts.
        i: which contact.
        dashpot, inertia: its row [N s/m, kg].
        beta, h: Newmark's beta [-] and the step [s].
        rate, curve: mean velocity of the contact in the step, and its acceleration [m/s, m/s2].
    """
    sprung = beta * h**2 * points.k[i] * curve
    # the row acts on the velocity that the leapfrog keeps, half a step before the pose
    return dashpot * (rate - 0.5 * h * curve) + inertia * curve - sprung, sprung


@compiled
def _contact_work(
    points: Points,
    number: Integers,
    h: Array,
    pose: Array,
    before: Array,
    after: Array,
    windows: Windows,
    beta: Array,
    ringing: Array,
    kind: Integers,
    sliding: Array,
    released_on: Flags,
    frames: Array,
    rows: Array,
    rates: Array,
    dashpots: Array,
    friction: Array,
    impulses: Array,
) -> None:
    """Add up the work that dashpots and friction take in the window of each step.

    Args:
        points: the contacts.
        number: the group of each contact, shape (m,).
        h: lengths of the steps [s], shape (steps,).
        pose, before, after: poses, and velocities around them, shape (steps, 3 n).
        windows: their windows.
        beta, ringing, kind: as in `Steps`.
        sliding: friction of the contacts that slide by Coulomb's law, `Steps.friction`, shape (steps, m).
        released_on: the contacts that are closed in the first step, shape (m,).
        frames, rows, rates: room for three frames, the rows and three rates, shapes (3, n, 4), (m, 2) and (3, 3 n).
        dashpots, friction: the work [J], shapes (steps, groups) and (steps,).
        impulses: of the lift of contacts that slide on their rows, and of their law [N s], shape (2,).
    """
    frame, seam, next_seam = frames[0], frames[1], frames[2]
    middle, acceleration, mean = rates[0], rates[1], rates[2]
    for n in range(len(h)):
        take_frame(pose[n], frame)
        take_frame(windows.pose[n], seam)
        take_frame(windows.pose[min(n + 1, len(h) - 1)], next_seam)
        for j in range(len(middle)):
            middle[j] = 0.5 * (before[n, j] + after[n, j])
            acceleration[j] = (after[n, j] - before[n, j]) / h[n]
            mean[j] = windows.mean[n, j]
        impratio = take_rows(points, h[n], beta[kind[n]], ringing[kind[n]], rows)
        for i in range(len(points.k)):
            g, rate, curve, _ = gap(points, i, frame, middle, acceleration)
            given = spring_energy(points, i, seam) - spring_energy(points, i, next_seam)
            inertia = rows[i, 1]
            drag, sprung = drag_of(points, i, rows[i, 0], inertia, beta[kind[n], i], h[n], rate, curve)
            law = -(points.k[i] * g + drag + sprung)
            if not released_on[i] if n == 0 else g >= 0:
                dashpots[n, number[i]] += given
                continue
            # the dashpot of a point that has closed but does not press holds its spring back, and takes what it gives
            opened = gap(points, i, frame, mean, mean)[1] * windows.width[n]
            dashpots[n, number[i]] += drag * opened if law > 0 else given
            if points.friction[i] > 0:
                dragging, lift = sliding[n, i], 0.0
                if math.isnan(dragging):
                    stopping = -impratio * inertia * along(points, i, frame, after[n])[2] / h[n]
                    pressing, dragging = cone_force(law, stopping, impratio * inertia, inertia, points.friction[i])
                    lift = pressing - max(law, 0.0)  # what a sliding cone presses on top of the law
                    if points.rubs[i] and abs(stopping) > points.friction[i] * max(law, 0.0):
                        impulses[0] += lift * h[n]
                        impulses[1] += max(law, 0.0) * h[n]
                slipped = along(points, i, frame, mean)[2] * windows.width[n]
                friction[n] -= dragging * slipped + lift * opened
