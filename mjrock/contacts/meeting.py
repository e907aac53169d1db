"""The contact of two geoms in a pose: the number of contact points, and the mass that each point stops."""

from __future__ import annotations

import copy
import itertools
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import mujoco
import numpy as np

from .checks import Array, Integers, is_iterable, require_array, require_whole, shown
from .effective_mass import (
    FRICTIONLESS,
    EffectiveMass,
    ModelSprings,
    PointLaw,
    PoseConstraints,
    effective_mass,
    moved_or_sprung,
    with_tangents,
)
from .geoms import BOUNDLESS, FARTHEST_GEOM, NO_LOAD, GeomPair, makes
from .versions import enable_bits, make_mass_matrix

DEPTH = 1e-3
"""How far the geoms are pressed into each other, as a share of the smaller one's radius [-]: a face that is level to
one in a thousand meets in all of its points."""
LANDING_HALVINGS = 40
"""Halvings of the way on which a landing is looked for."""
KEY = mujoco.mjtObj.mjOBJ_KEY
Keyframe = str | int | Sequence[str | int] | None
"""A keyframe by name or number, or several."""
NEARLY_LEVEL = 0.05
"""Slope within which geoms of one body are taken to land together [-]: a foot of several geoms that is nearly level."""
SLOPING = 0.3
"""Slope within which they land one after the other, as those of a foot that is not level do [-]."""
LEAST_LOAD = 1e-3
"""Force at rest up to which a contact carries nothing, over the weight of the lighter body [-]."""
TOUCHING_AT_REST = 1e-4
"""Distance within which geoms of a pose at rest touch, and joints are at their limits [m or rad]."""
RIGID_AT_REST = ("eq_{}", "jnt_{}", "dof_{}", "tendon_{}_lim", "tendon_{}_fri")
"""Fields of a model with the parameters of constraints that are no contacts: equality, limits, and dry friction."""
MOST_KEYFRAMES = 20
"""Most keyframes whose masses are compared."""


class LandingTrial:
    """A copy of a model in a pose, see `state_of`, in which geoms are moved together until they meet."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model = copy.copy(model)
        option, disabled = self.model.opt, mujoco.mjtDisableBit
        option.disableflags |= int(disabled.mjDSBL_MIDPHASE | disabled.mjDSBL_FILTERPARENT)
        option.disableflags &= ~int(disabled.mjDSBL_CONTACT | disabled.mjDSBL_CONSTRAINT)
        option.enableflags &= ~enable_bits("SPECULATIVE")
        self.data = state_alike(self.model, data)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        for name in ("geom_contype", "geom_conaffinity", "body_contype", "body_conaffinity"):
            getattr(self.model, name)[:] = 0

    def points(self, pair: GeomPair, away: Array, distance: float, turn: float = 0.0) -> Array:
        """The points in which the geoms meet, with the first moved by `distance` against `away`, and one of them turned
        about `away` [degrees]; shape (n, 3)."""
        bodies, geoms = list(pair.bodies), list(pair.geoms)
        self._let_meet(geoms, bodies, 1)
        moved = 1 if self.model.geom_type[geoms[0]] in BOUNDLESS else 0
        place, frame = (np.array(values[geoms[moved]]) for values in (self.data.geom_xpos, self.data.geom_xmat))
        shift = (distance + self.pressed(pair)) * away
        if turn:
            turned, matrix = np.zeros(4), np.zeros(9)
            mujoco.mju_axisAngle2Quat(turned, away, np.radians(turn))
            mujoco.mju_quat2Mat(matrix, turned)
            self.data.geom_xmat[geoms[moved]] = (matrix.reshape(3, 3) @ frame.reshape(3, 3)).ravel()
        self.data.geom_xpos[geoms[moved]] += shift if moved else -shift
        try:
            mujoco.mj_collision(self.model, self.data)
            contact = self.data.contact
            met = contact.pos[(np.sort(contact.geom, axis=1) == sorted(geoms)).all(axis=1)]
        finally:
            self.data.geom_xpos[geoms[moved]], self.data.geom_xmat[geoms[moved]] = place, frame
            self._let_meet(geoms, bodies, 0)
        points = met[:: max(1, len(pair.listed))]
        return points + shift if moved == 0 else points

    def drop(self, pair: GeomPair, away: Array) -> Landing | None:
        """Where the first geom lands as it moves against `away`; if it passes the second, over the middle of that.
        None where it meets nothing."""
        geoms, place, radii = pair.geoms, self.data.geom_xpos, self.model.geom_rbound
        apart, moved = place[geoms[0]] - place[geoms[1]], geoms[self.model.geom_type[geoms[0]] in BOUNDLESS]
        level, start = float(apart @ away), np.array(place[moved])
        for aside in (np.zeros(3), level * away - apart):
            place[moved] = start + (aside if moved == geoms[0] else -aside)
            beyond, near = level - 1.01 * float(radii[list(geoms)].sum()), level
            if not len(self.points(pair, away, near)):
                continue
            for _ in range(LANDING_HALVINGS):
                middle = 0.5 * (beyond + near)
                beyond, near = (beyond, middle) if len(self.points(pair, away, middle)) else (middle, near)
            distance = near + self.pressed(pair)
            points = self.points(pair, away, distance)
            place[moved] = start
            if moved == geoms[0]:
                points = points - aside
            return Landing(away, distance, points, points - distance * away + aside) if len(points) else None
        place[moved] = start
        return None

    def pressed(self, pair: GeomPair) -> float:
        """How far the geoms are pressed into each other [m]."""
        radii = self.model.geom_rbound[list(pair.geoms)]
        return DEPTH * float(min((radius for radius in radii if radius > 0), default=1.0))

    def _let_meet(self, geoms: list[int], bodies: list[int], value: int) -> None:
        self.model.geom_contype[geoms] = self.model.geom_conaffinity[geoms] = value
        self.model.body_contype[bodies] = self.model.body_conaffinity[bodies] = value


def state_alike(model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
    """Data of a copy of a model in the pose of others, with their controls."""
    copied = mujoco.MjData(model)
    copied.qpos[:], copied.mocap_pos[:], copied.mocap_quat[:] = data.qpos, data.mocap_pos, data.mocap_quat
    copied.ctrl[:], copied.act[:] = data.ctrl, data.act
    return copied


class Landing(NamedTuple):
    """Where two geoms meet.

    Args:
        away: unit vector along which the first geom parts from the second, shape (3,).
        distance: their distance [m].
        first, second: the points of the contact on each of them where it is now, in the world's frame [m], shape
            (n, 3). They are the same points once the geoms have met.
    """

    away: Array
    distance: float
    first: Array
    second: Array

    @property
    def area(self) -> float:
        """Area of the polygon of the points across the direction in which the geoms part [m2]; zero of one or two."""
        x, y = with_tangents(self.away)[1:] @ (self.first - self.first.mean(axis=0)).T
        order = np.argsort(np.arctan2(y, x))
        x, y = x[order], y[order]
        return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def keyframe_names(model: mujoco.MjModel) -> tuple[str, ...]:
    """The names of all keyframes, with a number in brackets where there is none."""
    return tuple(mujoco.mj_id2name(model, KEY, i) or f"[{i}]" for i in range(model.nkey))


def keyframe_id(model: mujoco.MjModel, keyframe: object) -> int:
    """The number of a keyframe given by name or number.

    Raises:
        TypeError, ValueError: for any other, with those that the model has.
    """
    known = ", ".join(keyframe_names(model)) or "none"
    if isinstance(keyframe, str):
        number = mujoco.mj_name2id(model, KEY, keyframe) if "\0" not in keyframe and keyframe.isprintable() else -1
        if number < 0:
            raise ValueError(f"keyframe = {shown(keyframe)} is not a keyframe of this model; it has: {known}")
        return int(number)
    if model.nkey == 0:
        raise ValueError(f"keyframe = {shown(keyframe)} is given, and this model has none")
    return require_whole("keyframe", keyframe, 0, model.nkey - 1)


def state_of(model: mujoco.MjModel, keyframe: object = None, qpos: object = None) -> mujoco.MjData:
    """The model in a pose, at rest, with its mass matrix, its constraints but for contacts, and its weight.

    Arguments are those of `Pose`.

    Raises:
        TypeError, ValueError: for a keyframe or positions that the model cannot have, or both.
    """
    if keyframe is not None and qpos is not None:
        raise ValueError(f"keyframe = {shown(keyframe)} and qpos are both given; give one of them")
    data = mujoco.MjData(model)
    if is_iterable(keyframe):
        for name in keyframe:
            number = keyframe_id(model, name)
            pose, controls = model.key_qpos[number], model.key_ctrl[number]
            data.qpos[:] = np.where(pose == model.qpos0, data.qpos, pose)
            data.ctrl[:] = np.where(controls == 0, data.ctrl, controls)
    elif keyframe is not None:
        mujoco.mj_resetDataKeyframe(model, data, keyframe_id(model, keyframe))
        data.qvel[:] = 0
    elif qpos is not None:
        data.qpos[:] = require_array("qpos", qpos, (model.nq,))
        if np.abs(data.qpos).max(initial=0) > 1e10:
            raise ValueError("qpos holds a value outside the valid range -1e10 to 1e10")
        mujoco.mj_normalizeQuat(model, data.qpos)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_flex(model, data)
        mujoco.mj_tendon(model, data)
        mujoco.mj_transmission(model, data)
        make_mass_matrix(model, data)
        mujoco.mj_factorM(model, data)
        mujoco.mj_makeConstraint(model, data)
        mujoco.mj_fwdVelocity(model, data)
    return data


def forces_at_rest(model: mujoco.MjModel, data: mujoco.MjData) -> dict[frozenset[int], list[float]]:
    """Normal forces of all contact points of a pose at rest [N], by the numbers of their geoms.

    Contacts within `TOUCHING_AT_REST` of touch, limits, equality constraints and dry friction hold the bodies, and do
    not yield. Joints that an actuator or a spring moves are held by a great armature, as servos hold a robot that
    stands, and what actuators give at the controls of the pose presses. No other joint is held: pads, trailers and
    rockers on joints that turn freely find their balance.
    """
    rigid = copy.copy(model)
    rigid.opt.enableflags = rigid.opt.enableflags & ~enable_bits("SPECULATIVE") | enable_bits("OVERRIDE")
    rigid.opt.o_solref[:], rigid.opt.o_solimp[:3], rigid.opt.o_margin = 0, (0.9999, 0.9999, 0.001), TOUCHING_AT_REST
    rigid.opt.solver, rigid.opt.cone = mujoco.mjtSolver.mjSOL_NEWTON, mujoco.mjtCone.mjCONE_ELLIPTIC
    rigid.opt.iterations, rigid.opt.ls_iterations, rigid.opt.tolerance = 100, 50, 0.0
    rigid.opt.impratio = 1e-4  # friction carries what the normal forces cannot
    for name in RIGID_AT_REST:
        getattr(rigid, name.format("solref"))[:] = 0
        getattr(rigid, name.format("solimp"))[..., :3] = 0.9999, 0.9999, 0.001
    for margin in (rigid.jnt_margin, rigid.tendon_margin):
        margin[:] = np.maximum(margin, TOUCHING_AT_REST)
    for name in ("body_invweight0", "dof_invweight0", "tendon_invweight0"):
        getattr(rigid, name)[:] *= 1e-6  # of the regularisation
    rigid.dof_armature[moved_or_sprung(model, data)] += 1e6 * float(rigid.body_mass.sum())
    state = state_alike(rigid, data)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mujoco.mj_forward(rigid, state)
    forces: dict[frozenset[int], list[float]] = {}
    force = np.zeros(6)
    for i, geoms in enumerate(state.contact.geom.tolist()):
        mujoco.mj_contactForce(rigid, state, i, force)
        forces.setdefault(frozenset(geoms), []).append(float(force[0]))
    return forces


class Pose:
    """A model in a pose.

    Args:
        model: the model, which is only read.
        keyframe: name or number of a keyframe, or several, each for the joints that it moves from `qpos0`.
        qpos: positions of the joints, shape (nq,). Without either it is `qpos0`.
    """

    def __init__(self, model: mujoco.MjModel, keyframe: object = None, qpos: object = None) -> None:
        sleep = enable_bits("SLEEP")  # MuJoCo makes no constraints of bodies that begin asleep
        if model.opt.enableflags & sleep:
            model = copy.copy(model)
            model.opt.enableflags &= ~sleep
        self.model, self.data = model, state_of(model, keyframe, qpos)
        self.given, self.exact = keyframe is not None or qpos is not None, qpos is not None
        self.label = "qpos0" if not self.given else "qpos" if keyframe is None else f"keyframe {keyframe!r}"
        self.normal: Array | None = None
        self._landings: dict[tuple[int, ...], Landing] = {}
        self._groups: dict[tuple[int, ...], BodyPair] = {}

    def at_positions(self, qpos: Array) -> Pose:
        """The same pose with other positions of the joints: controls and activations stay."""
        pose = Pose(self.model, qpos=qpos)
        pose.data.ctrl[:], pose.data.act[:] = self.data.ctrl, self.data.act
        pose.exact, pose.label = self.exact, self.label
        return pose

    def landing(self, pair: GeomPair) -> Landing:
        """Where two geoms meet in the pose."""
        key = (*pair.geoms, *([] if self.normal is None else self.normal.tolist()))
        if key not in self._landings:
            self._landings[key] = self._landing_of(pair)
        return self._landings[key]

    def _landing_of(self, pair: GeomPair) -> Landing:
        """Where two geoms meet: along the normal that is given, that of a plane, the axis of a height field, or the
        shortest line."""
        trial = self.landing_trial if pair.makes_several_points or self.normal is not None else None
        along = pair.axis(self.data, mujoco.mjtGeom.mjGEOM_HFIELD) if self.normal is None else self.normal
        if along is not None and trial is not None and (landing := trial.drop(pair, along)):
            return landing
        away, distance, ends = pair.separation(self.data)
        away = away if along is None else along
        if trial is not None:
            points = trial.points(pair, away, distance)
            if len(points):
                return Landing(away, distance, points, points - distance * away)
        first, second = [pair.centre(self.data, body) for body in pair.bodies] if ends is None else ends
        return Landing(away, distance, first[None, :], second[None, :])

    def along(self, normal: object) -> Pose:
        """The pose in which geoms part along a direction, in the world's frame, shape (3,); itself for None."""
        if normal is None:
            return self
        vector = require_array("normal", normal, (3,))
        if not (size := float(np.linalg.norm(vector))) > 0:
            raise ValueError(f"normal = {shown(normal)} has no direction; give a vector that is not zero")
        pose = copy.copy(self)
        pose.normal, pose._groups = vector / size, {}
        return pose

    def group(self, pair: GeomPair) -> BodyPair:
        """The geoms of the two bodies of a pair."""
        bodies = tuple(int(self.model.body_weldid[body]) for body in pair.bodies)
        if bodies not in self._groups:
            self._groups[bodies] = BodyPair(pair, self)
        return self._groups[bodies]

    @cached_property
    def resting(self) -> dict[frozenset[int], list[float]]:
        """Normal forces of the contact points of geoms that touch, in the pose at rest [N]; see `forces_at_rest`.
        Positions that are given without a keyframe have no controls, and no actuator presses in them."""
        if not self.exact:
            return forces_at_rest(self.model, self.data)
        model = copy.copy(self.model)
        model.actuator_gainprm[:], model.actuator_biasprm[:] = 0, 0
        return forces_at_rest(model, self.data)

    def load(self, pair: GeomPair, points: int, contacts: int | None) -> float:
        """Static load of each contact point [N]: that of the pose at rest where the geoms touch, otherwise the weight
        of the lighter of the two. `points` share it, or those that `contacts` gives."""
        forces = self.resting.get(frozenset(pair.geoms))
        if forces is None:
            return pair.load / points
        carried = sum(forces) if sum(forces) > LEAST_LOAD * pair.load else 0.0
        return max(NO_LOAD, carried) / (contacts or len(forces))

    @cached_property
    def landing_trial(self) -> LandingTrial:
        """A copy of the model in which geoms are moved together until they meet."""
        return LandingTrial(self.model, self.data)

    @cached_property
    def constraints(self) -> PoseConstraints:
        """The constraints of the pose."""
        return PoseConstraints(self.model, self.data)

    @cached_property
    def springs(self) -> ModelSprings:
        """The springs and dampers of joints, tendons and actuators."""
        return ModelSprings(self.model, self.data)

    @cached_property
    def others(self) -> tuple[Pose, ...]:
        """The poses of the model's keyframes."""
        return tuple(Pose(self.model, i) for i in range(min(self.model.nkey, MOST_KEYFRAMES)))

    def keeps_qpos0(self, pair: GeomPair) -> bool:
        """Whether the joints that move the two geoms are where they are in `qpos0`."""
        moved = np.flatnonzero(np.array(self.data.qpos) != self.model.qpos0)
        joints = np.searchsorted(self.model.jnt_qposadr, moved, side="right") - 1
        bodies = self.model.jnt_bodyid[joints]
        return not any(tree[bodies].any() for tree in pair.trees)


class Neighbours(NamedTuple):
    """The other geoms of two bodies that land at about the same time as a pair.

    Args:
        level: those that land together with it, and share the mass.
        late: how much sooner or later they touch [m], where that is more than on a level face, otherwise zero.
        separate: those that land before or after it.
    """

    level: tuple[GeomPair, ...] = ()
    late: float = 0.0
    separate: tuple[GeomPair, ...] = ()


@dataclass(frozen=True)
class PairMeeting:
    """The contact of two geoms in a pose.

    Args:
        points: contact points that share the mass.
        effective: the effective mass, and what else of the model acts on the contact.
        neighbours: the other geoms that land with these.
    """

    points: int
    effective: EffectiveMass
    neighbours: Neighbours

    @property
    def share(self) -> float:
        """Mass that each contact point stops [kg]."""
        return self.effective.mass / self.points


def meeting_of_geoms(
    pair: GeomPair,
    pose: Pose,
    *,
    contacts: int | None = None,
    at: object = None,
    alone: bool = False,
    law: PointLaw = FRICTIONLESS,
) -> PairMeeting:
    """How two geoms meet in a pose.

    Args:
        pair, pose: the geoms and the pose.
        contacts: contact points that share the mass. None takes those of a trial landing, with those of `neighbours`.
        at: contact point in the world's frame [m], shape (3,). None is the middle of the points of a trial landing, or
            the centres of mass if the landing has other points than `contacts`.
        alone: whether other geoms of the two bodies are left out, as they are where `contacts` or `at` is given.
        law: of each contact point.
    """
    if at is not None:
        point = require_array("at", at, (3,))
        if np.abs(point).max() > FARTHEST_GEOM:
            raise ValueError(f"at = {shown(at)} is outside the valid range of {FARTHEST_GEOM:g} m")
    landing = pose.landing(pair)
    others = Neighbours() if alone or contacts is not None or at is not None else neighbours(pair, pose)
    landings = [landing, *(pose.landing(other) for other in others.level)]
    first, second = (np.concatenate([getattr(landed, side) for landed in landings]) for side in ("first", "second"))
    count = len(first) if contacts is None else contacts
    if at is not None:
        places = point, point
    elif count != len(first):
        places = pair.centre(pose.data, pair.bodies[0]), pair.centre(pose.data, pair.bodies[1])
    else:
        places = first.mean(axis=0), second.mean(axis=0)
    effective = effective_mass(pair, pose.constraints, landing.away, places, law.together(count))
    return PairMeeting(count, effective, others)


class BodyPair:
    """All geoms of two bodies of which MuJoCo makes contacts, in a pose, and where they land, found when needed.

    Attributes:
        pairs: the geoms, those of the first body first.
        geoms: their numbers, shape (2, n).
    """

    def __init__(self, pair: GeomPair, pose: Pose) -> None:
        model, self.pose = pair.model, pose
        bodies = model.body_weldid[model.geom_bodyid]
        ours, theirs = (np.flatnonzero(bodies == bodies[geom]).tolist() for geom in pair.geoms)
        every = (GeomPair(model, geoms) for geoms in itertools.product(ours, theirs))
        self.pairs = [geom_pair for geom_pair in every if makes(geom_pair)]
        self.geoms = np.reshape([geom_pair.geoms for geom_pair in self.pairs], (-1, 2)).T
        self._landed = np.full((len(self.pairs), 7), np.nan)

    def landed(self, chosen: Integers) -> tuple[Array, Array, Array]:
        """Distances [m] of some pairs, shape (n,), directions in which they part, and middles of their points [m]."""
        for i in chosen[np.isnan(self._landed[chosen, 0])].tolist():
            landing = self.pose.landing(self.pairs[i])
            self._landed[i] = landing.distance, *landing.away, *landing.first.mean(axis=0)
        return self._landed[chosen, 0], self._landed[chosen, 1:4], self._landed[chosen, 4:]


def neighbours(pair: GeomPair, pose: Pose) -> Neighbours:
    """The other geoms of the two bodies that land about when a pair does. They part along the same line, and their
    distances differ by less than a share of what lies between them."""
    group, landing, place = pose.group(pair), pose.landing(pair), pose.data.geom_xpos
    radius = np.where(pair.model.geom_rbound > 0, pair.model.geom_rbound, np.inf)  # planes have none
    ends, reach, pair_geoms = place[group.geoms], radius[group.geoms], np.array(pair.geoms)[:, None]
    between = reach + np.linalg.norm(ends - place[pair_geoms], axis=2) + radius[pair_geoms]
    least_distance = np.linalg.norm(ends[0] - ends[1], axis=1) - (reach + SLOPING * between).sum(axis=0)
    met = (group.geoms != pair_geoms).any(axis=0)
    if pose.normal is not None:  # of several geoms that may lie below, one does
        met &= group.geoms[1] == pair.geoms[1]
    near = np.flatnonzero((least_distance <= max(landing.distance, 0.0)) & met)
    distance, away, middle = group.landed(near)
    between, differs = np.linalg.norm(middle - landing.first.mean(axis=0), axis=1), np.abs(distance - landing.distance)
    along = (away @ landing.away >= 1 - SLOPING**2) & (differs <= SLOPING * between)
    level = along & (differs <= NEARLY_LEVEL * between)
    late = level & (differs > DEPTH * (between + pair.thickness))
    return Neighbours(
        tuple(group.pairs[i] for i in near[level]),
        float(differs[late].max(initial=0.0)),
        tuple(group.pairs[i] for i in near[along & ~level]),
    )
