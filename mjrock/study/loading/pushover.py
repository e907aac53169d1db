"""Push-over: the horizontal acceleration that holds a wall at each rotation, without any motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...bars import counted
from ...geometry.frames import frames_of
from ...geometry.kinematics import gaps, meeting, relative_velocity, snaps, stretch, where_friction_acts
from ...geometry.vectors import dot, tangent
from ...notebook import NotebookPicture
from ...problem.damping.contacts import Contacts, Uplift
from ...problem.masonry.case import require_wall
from ...problem.wall.case import Case
from ...problem.wall.restoring_moment import pulled, yielded
from ...quantities import GRAVITY, ON_ITS_FACE, Array, Flags, Integers, require_increasing, require_kind, require_whole
from ...scene.potential import Potential
from ...scene.scene import Scene
from ...scene.wall import wall_scene

MOST_NEWTON_STEPS = 100
"""Most iterations of Newton's method for the vertical equilibrium of one pose."""
CURVE_MARGIN = 1.1
"""How far a curve is followed, as a multiple of the rotation at which that of the rigid wall falls to zero [-]. The
softest base that carries a wall moves that rotation by some hundredths."""


class HeldPoses(NamedTuple):
    """What holds a wall at its rotations.

    Args:
        pose: displacement x, z from rest [m] and rotation [rad], shape (n, 3).
        force: horizontal force at the centroid, positive outwards [N], shape (n,).
        height: height of the centroid above the point that friction holds [m], shape (n,). Times the force it is the
            moment that would hold the wall instead.
        lifted: whether a line of the base carries nothing, shape (n,).
    """

    pose: Array
    force: Array
    height: Array
    lifted: Flags


def tilted(scene: Scene, rotations: Array) -> HeldPoses:
    """The wall of a scene at rotations that follow each other, its ties yielding and breaking on the way.

    The vertical equilibrium gives the compression of the base. The condition that the held point of the outer edge does
    not slip gives the displacement along the base, by the trapezoidal rule from rest.

    The scene has one body, with a group of contacts `base` from the inner to the outer edge. Rotations increase [rad].

    Returns:
        The poses up to the first at which ties lift the wall off its base; most often all of them.
    """
    base = np.flatnonzero(scene.contacts.joint == scene.contacts.joints.index("base"))
    ties = scene.ties._replace(reach=np.array(scene.ties.reach))
    potential = Potential(scene.structure._replace(ties=ties))
    pose = scene.at_rest[0].copy()
    rows = np.zeros((len(rotations), 5))
    lever = _lever(scene, int(base[-1]), pose)
    for n, theta in counted(list(enumerate(rotations)), "push-over", "points"):
        step, before = theta - pose[2], lever
        start = pose[0]
        for _ in range(2):  # Heun's method: the second time with the mean of both levers
            moved = np.array([start - 0.5 * (before + lever) * step, pose[1], theta])
            carried = _carried(scene, potential, moved)
            if carried is None:
                return _held_poses(scene, base, rows[:n])
            pose, springs = carried
            lever = _lever(scene, int(base[-1]), pose)
        total = potential.load(pose) + springs
        for i in range(len(ties.k)):
            snaps(ties, i, frames_of(pose), pose)
            stretch(ties, i, frames_of(pose), pose)
        # with F the friction and H the force at the centroid: total_x + F + H = 0 and total_theta + F lever = 0
        rows[n] = *pose, total[2] / lever - total[0], -lever
    return _held_poses(scene, base, rows)


def _held_poses(scene: Scene, base: Integers, rows: Array) -> HeldPoses:
    lifted: Flags = np.any(gaps(scene.places, rows[:, :3])[:, base] >= 0, axis=1)
    return HeldPoses(rows[:, :3], rows[:, 3], rows[:, 4], lifted)


def _lever(scene: Scene, toe: int, pose: Array) -> float:
    """Height of the held point of the outer edge above the centroid [m]: its slip for a unit of angular velocity."""
    places, frames = scene.places, frames_of(pose)
    acts = where_friction_acts(places, meeting(places, toe, frames))
    return dot(tangent(acts.normal), relative_velocity(places, toe, acts, frames, np.array([0.0, 0.0, 1.0])))


def _carried(scene: Scene, potential: Potential, pose: Array) -> tuple[Array, Array] | None:
    """The pose lowered until all vertical forces are in equilibrium, and the generalised force of its springs.

    Ties pull with no more than their strength. None where ties lift the wall off its base.
    """
    pose = scene.lowered(pose[None])[0]
    contacts, weight = len(scene.contacts.k), GRAVITY * float(scene.bodies.mass[0])
    limits = np.append(np.full(contacts, np.inf), scene.ties.stretch)
    down = float(potential.load(pose)[1])
    for _ in range(MOST_NEWTON_STEPS):
        rates, pressed = potential.rates(pose).toarray(), np.minimum(potential.pressed(pose), limits)
        springs = rates.T @ (potential.springs * pressed)
        stiffness = float(scene.contacts.k[pressed[:contacts] > 0] @ rates[:contacts, 1][pressed[:contacts] > 0] ** 2)
        if stiffness == 0:
            break
        lift = (down + springs[1]) / stiffness
        if abs(lift) < 1e-15 * scene.bodies.extent or abs(down + springs[1]) < 1e-12 * weight:
            return pose, springs
        pose[1] += lift
    return None


@dataclass(frozen=True, eq=False, repr=False)
class PushoverCurve(NotebookPicture):
    """The static curve of a wall that is pushed outwards.

    Args:
        case: the wall and its effects.
        contacts: its interfaces, or None for a rigid wall on a rigid base.
        rotation: rotations theta [rad], shape (n,).
        multiplier: horizontal acceleration over g that holds the wall at each, acting on its mass [-], shape (n,).
        moment: restoring moment of weight, loads, thrusts, ties and base about the held edge [N m], shape (n,).
        start: multiplier at which the base begins to lift off [-]. For a rigid wall it is lambda_0, at which rocking
            starts.
        end: rotation at which the multiplier first falls to zero [rad]; infinite if it does not before the wall lies
            on its face or its ties lift it off the base.
        peak: largest multiplier up to `end` [-].
    """

    case: Case
    contacts: Contacts | None
    rotation: Array
    multiplier: Array
    moment: Array
    start: float
    end: float
    peak: float

    @property
    def ties(self) -> tuple[dict[str, float], dict[str, float]]:
        """Rotations [rad] at which ties yield, and at which they break, by name, of those that do along the curve.

        They are those of a wall that turns about its outer toe.
        """
        fine = np.linspace(self.rotation[0], self.rotation[-1], 20_001)
        return self.case.limits_of_ties(fine)

    def __repr__(self) -> str:
        base = "rigid" if self.contacts is None else f"{self.contacts.base.points} lines"
        return (
            f"<PushoverCurve of a wall on a base that is {base}: {len(self.rotation)} points, "
            f"starts at {self.start:.4g} g, peak {self.peak:.4g} g, ends at {self.end:.4g} rad>"
        )


def pushover(
    case: Case, contacts: Contacts | None = None, *, rotations: ArrayLike | None = None, points: int = 400
) -> PushoverCurve:
    """The static curve of a wall that a horizontal acceleration pushes outwards, away from its side stop.

    The acceleration acts on the mass of the wall, with all added masses, at its centroid. Loads and thrusts have no
    mass. Ties yield and break along the curve. The release, the ground motion and the duration play no part.

    A rigid wall has the closed form lambda = [P cos(theta) - Q sin(theta) + T(theta) lever] / (W z'), with P and Q of
    `case.restoring`, T the pull of the ties, and z' = z cos(theta) + d sin(theta) the height of the centroid. On
    contacts each point is an equilibrium of their springs at that rotation. The outer edge is held by friction halfway
    into its overlap with the base. The curve then starts at the rotation of the wall at rest, with a multiplier of
    zero.

    Args:
        case: the wall and its effects.
        contacts: its interfaces; None for a rigid wall on a rigid base.
        rotations: at which rotations [rad], increasing, 0 to pi/2, shape (n,). None takes the whole curve until the
            multiplier falls to zero, the wall lies on its face, or its ties lift it off its contacts.
        points: about how many points the whole curve has, 20 to 100000. Rotations at which a tie begins to pull or to
            yield come on top.

    Returns:
        The curve, with `rotation` [rad] and `multiplier` [-], and where ties yield and break.

    Raises:
        ValueError: for a value outside its range, or if the contacts do not fit the case or cannot carry it.

    Examples:
        >>> curve = mr.pushover(case, contacts)
        >>> round(float(curve.multiplier.max()), 2)
        0.14
    """
    require_wall("case", case, "push or collapse_multiplier")
    case.require_for("push-over")
    require_kind("contacts", contacts, Contacts, type(None))
    points = require_whole("points", points, 20, 100_000)
    requested = np.zeros(0)
    if rotations is not None:
        requested = require_increasing("rotations", rotations, "rotation [rad]", ON_ITS_FACE, "0 to pi/2 rad")
    if contacts is None:
        path = np.unique(np.concatenate([_path(case, 0.0, 0.0, points), requested]))
        multiplier, moment = _rigid(case, path)
        start = float(multiplier[0])
    else:
        scene, uplift = wall_scene(case, contacts), Uplift.from_case(case, contacts).rotation
        rest_rotation = float(scene.at_rest[0, 2])
        path = np.unique(np.concatenate([_path(case, rest_rotation, uplift, points), requested]))
        held = tilted(scene, path)
        if requested.size and len(held.pose) < len(path) and requested[-1] > path[len(held.pose) - 1]:
            raise ValueError(
                f"rotations reach {requested[-1]:g} rad, and the ties lift the wall off its base at "
                f"{path[len(held.pose)]:.4g} rad; the valid range ends there"
            )
        path = path[: len(held.pose)]
        multiplier = held.force / case.wall.weight
        moment = held.force * held.height
        start = float(multiplier[held.lifted.argmax()]) if held.lifted.any() else math.nan
    end = falls_to_zero(path, multiplier, math.inf)
    selected = np.isin(path, requested) if rotations is not None else path < end
    peak = float(multiplier[path < end].max())
    path, multiplier, moment = path[selected], multiplier[selected], moment[selected]
    if rotations is None and end < math.inf:
        path, multiplier, moment = np.append(path, end), np.append(multiplier, 0.0), np.append(moment, 0.0)
    return PushoverCurve(case, contacts, path, multiplier, moment, start, end, peak)


def _rigid(case: Case, phi: Array) -> tuple[Array, Array]:
    """Multiplier [-] and moment [N m] of a rigid wall at increasing rotations."""
    moment = case.restoring.outer.at(phi)
    for pull, plastic in zip(case.resisting, yielded(case.resisting, phi).T, strict=True):
        elongation, lever = pulled(pull, phi, 1.0)
        moment = moment + pull.stiffness * np.maximum(elongation - plastic, 0.0) * lever
    wall = case.wall
    return moment / (wall.weight * (wall.centroid_height * np.cos(phi) + wall.lever * np.sin(phi))), moment


def _path(case: Case, rest_rotation: float, uplift: float, points: int) -> Array:
    """Rotations from rest to beyond overturning [rad], denser about the uplift and where a tie changes."""
    fine = np.linspace(0.0, ON_ITS_FACE, 20_001)
    limit = min(CURVE_MARGIN * falls_to_zero(fine, _rigid(case, fine)[0], math.inf), ON_ITS_FACE)
    parts = [np.linspace(rest_rotation, limit, points if not uplift else points // 2)]
    if uplift:
        near = min(max(uplift, 1e-9), limit)
        parts += [np.linspace(rest_rotation, near, points // 8), np.geomspace(near, limit, points // 2)]
        # the uplift itself is known to second order in the rotation
        parts += [near * np.array([1 - 1e-3, 1 - 1e-4, 1 + 1e-6, 1 + 1e-4, 1 + 1e-3])]
    for pull in case.resisting:
        stretch = pull.strength / pull.stiffness
        for elongation in (0.0, stretch, stretch + pull.ultimate):
            beyond = np.flatnonzero(pulled(pull, fine, 1.0)[0] > elongation)
            if beyond.size:
                parts.append(fine[max(beyond[0] - 1, 0) : beyond[0] + 1])
    path = np.concatenate(parts)
    return path[(path >= rest_rotation) & (path <= limit)]


def falls_to_zero(at: Array, borne: Array, never: float = math.nan) -> float:
    """Where along a curve what is borne first falls to zero from above it, linear between the points.

    Args:
        at: displacements or rotations, shape (n,).
        borne: what is borne there, shape (n,).
        never: what is returned of a curve that does not fall to zero.
    """
    falls = np.flatnonzero((borne[:-1] > 0) & (borne[1:] <= 0))
    if not falls.size:
        return never
    i = falls[0]
    share = borne[i] / (borne[i] - borne[i + 1])
    return float(at[i] + share * (at[i + 1] - at[i]))
