"""The effective mass of a contact in a model, with the springs, dampers, dry friction and weight that act on it.

A unit impulse at the contact changes the velocity of its point by W, 3 x 3: the normal n first, then two tangents t.
For a point that does not slip 1/m = W_nn - W_nt W_tt^-1 W_tn, for a point without friction 1/m = W_nn. Where friction
mu cannot hold the point, it slips, with mu times the impulse of the normal against it.

An equality constraint moves with the contact too. Its row yields by its regularisation R at once, and returns with its
own frequency. One that is faster than the contact is rigid. A slower one adds the inertia of its row.

Along the approach a spring of the model adds u^T K u to the stiffness of the contact, and a damper u^T D u to its
dashpot, with u the velocity of the joints for a unit speed of the contact. Dry friction, MuJoCo's `frictionloss`,
resists with up to the sum of |u| times that of each joint."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import mujoco
import numpy as np

from .checks import Array, Flags, Integers
from .geoms import GeomPair
from .versions import NO_DAMPERS, NO_SPRINGS, actuators, dense, field, stretches_of_tendons

JOINT, TENDON, ACTUATOR = mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_TENDON, mujoco.mjtObj.mjOBJ_ACTUATOR
Owner = tuple[mujoco.mjtObj, int]
"""Owner of a spring, damper or dry friction: a joint, a tendon or an actuator, and its number."""


def with_tangents(normal: Array) -> Array:
    """A unit vector and two others that are square to it and to each other, shape (3, 3)."""
    first = np.linalg.qr(normal[:, None], mode="complete")[0][:, 1]
    return np.array((normal, first, np.cross(normal, first)))


class ModelSprings:
    """The springs and dampers of a model in its pose.

    Attributes:
        owners: all joints, then the tendons and actuators that have a spring, a damper or dry friction.
        joint_of: the joint of each degree of freedom, shape (nv,).
        joint_k: stiffness of each joint in the pose [N/m or N m], shape (njnt,).
        dof_c: coefficients of the damping of each degree of freedom [N s/m or N m s, and of higher order], (nv, 3).
        stretch: stretch of each tendon and actuator for a unit velocity of each degree of freedom, shape (n, nv).
        k: stiffness of each tendon and actuator in the pose, shape (n,).
        c: coefficients of their damping, shape (n, 3).
        dof_dry: dry friction of each degree of freedom [N or N m], shape (nv,).
        dry: dry friction of each tendon, and 0 of each actuator, shape (n,).
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        servo_k, servo_c = _actuators(model, data)
        count = actuators(model)
        tendons, spared = (_coefficients(model, f"tendon_{name}", model.ntendon) for name in ("stiffness", "damping"))
        stretch = np.vstack(
            [
                stretches_of_tendons(model, data),
                dense(data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind, model.nv),
            ]
        )
        low, high = model.tendon_lengthspring.reshape(-1, 2).T
        length = np.array(data.ten_length)
        drawn = length - np.clip(length, low, high)  # a range of lengths in which it is slack
        k = np.concatenate([_tangent(tendons, drawn), servo_k])
        geared = np.maximum(np.abs(model.actuator_gear[:, :1]), mujoco.mjMINVAL) ** np.arange(spared.shape[1])
        damping = _coefficients(model, "actuator_damping", count) / geared  # of the speed before the gear
        damping[:, 0] += servo_c
        c = np.vstack([spared, damping])
        rubs = not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS)
        dry = np.concatenate([rubs * np.reshape(model.tendon_frictionloss, -1), np.zeros(count)])
        acts = (k != 0) | (c != 0).any(axis=1) | (dry > 0)
        others = [(TENDON, i) for i in range(model.ntendon)] + [(ACTUATOR, i) for i in range(count)]
        self.owners: list[Owner] = [(JOINT, i) for i in range(model.njnt)] + [others[i] for i in np.flatnonzero(acts)]
        self.joint_of = np.array(model.dof_jntid, dtype=np.int64)
        self.joint_k = _tangent(_coefficients(model, "jnt_stiffness", model.njnt), _strain(model, data))
        self.dof_c = _coefficients(model, "dof_damping", model.nv)
        self.dof_dry = rubs * np.array(model.dof_frictionloss)
        self.stretch, self.k, self.c, self.dry = stretch[acts], k[acts], c[acts], dry[acts]

    def along(self, motion: Array, speed: float = 1.0) -> tuple[Array, Array]:
        """What each owner adds to stiffness [N/m] and damping [N s/m] of a contact, shape (owners,), where `motion` is
        the velocity of the joints for a unit speed of the contact, shape (nv,). Damping is that at a speed [m/s]."""
        squares, joints = motion**2, len(self.joint_k)
        stretch = self.stretch @ motion
        joint_k = self.joint_k * np.bincount(self.joint_of, squares, joints)
        joint_c = np.bincount(self.joint_of, _secant(self.dof_c, speed * np.abs(motion)) * squares, joints)
        moved = stretch**2
        return (
            np.concatenate([joint_k, self.k * moved]),
            np.concatenate([joint_c, _secant(self.c, speed * np.abs(stretch)) * moved]),
        )

    def friction(self, motion: Array) -> Array:
        """The dry friction of each owner along the approach of a contact [N], shape (owners,)."""
        joints = np.bincount(self.joint_of, self.dof_dry * np.abs(motion), len(self.joint_k))
        return np.concatenate([joints, self.dry * np.abs(self.stretch @ motion)])


def moved_or_sprung(model: mujoco.MjModel, data: mujoco.MjData) -> Flags:
    """Which degrees of freedom an actuator moves, or a spring of a joint or a tendon, shape (nv,)."""
    strings = stretches_of_tendons(model, data)
    sprung = _coefficients(model, "tendon_stiffness", model.ntendon).any(axis=1)
    drives = dense(data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind, model.nv)
    act = model.actuator_trntype != int(mujoco.mjtTrn.mjTRN_BODY)  # adhesion of a body
    act &= not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    joints = (_coefficients(model, "jnt_stiffness", model.njnt)[model.dof_jntid] != 0).any(axis=1)
    return np.array(joints | (strings[sprung] != 0).any(axis=0) | (drives[act] != 0).any(axis=0))


def _coefficients(model: mujoco.MjModel, name: str, count: int) -> Array:
    """The linear coefficient of springs or dampers and those of higher order, shape (count, 3); zeros where a flag
    of the model disables them."""
    values = np.hstack([field(model, name, count).reshape(count, 1), *_higher_coefficients(model, name, count)])
    return np.array(values * (not model.opt.disableflags & (NO_DAMPERS if "damping" in name else NO_SPRINGS)))


def _higher_coefficients(model: mujoco.MjModel, name: str, count: int) -> Iterator[Array]:
    """The coefficients of higher order, shape (count, 2), where MuJoCo has them."""
    if hasattr(mujoco, "mjNPOLY"):
        yield np.reshape(getattr(model, f"{name}poly"), (count, mujoco.mjNPOLY))


def _secant(coefficients: Array, size: Array) -> Array:
    """Force over what causes it, a + b s + c s^2 of MuJoCo's polynomials: of a speed's size or a signed stretch."""
    return np.einsum("ij,ij->i", coefficients, size[:, None] ** np.arange(coefficients.shape[1]))


def _tangent(coefficients: Array, size: Array) -> Array:
    """Change of the force with what causes it, a + 2 b s + 3 c s^2."""
    return _secant(coefficients * np.arange(1, coefficients.shape[1] + 1), size)


def _strain(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """How far each hinge and slide is from where its spring is slack [rad or m], 0 for other joints; shape (njnt,)."""
    place = model.jnt_qposadr
    scalar = np.isin(model.jnt_type, (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)))
    return np.where(scalar, np.array(data.qpos)[place] - np.array(model.qpos_spring)[place], 0.0)


def _actuators(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[Array, Array]:
    """Stiffness and damping of every actuator, from its force at two lengths and at two speeds; shape (n,)."""
    force, slopes = np.array(data.actuator_force), []
    for name in ("actuator_length", "actuator_velocity"):
        values = getattr(data, name)
        before = np.array(values)
        values += ACTUATOR_PROBE
        mujoco.mj_fwdActuation(model, data)
        slopes.append(np.maximum((force - data.actuator_force) / ACTUATOR_PROBE, 0.0))
        values[:] = before
    mujoco.mj_fwdActuation(model, data)
    return slopes[0], slopes[1]


ACTUATOR_PROBE = 1e-6
"""Change of the length and of the speed of an actuator at which its force is read [m or rad, and per second]."""


RIGID_CONSTRAINT = 5.0
"""Frequency of an equality constraint over that of the contact above which it counts as rigid without a note [-]."""
RIGID_IN_MASS = 1.0
"""Ratio of these frequencies above which it is rigid in the mass. A slower one adds only the inertia of its row."""
SLIDING_FREEDOM = 0.05
"""A point of which friction leaves less than this share of its freedom along the normal slides as it lands [-]."""
WITHOUT_FREEDOM = 1e-10
"""A point of which rigid constraints leave less than this share of its freedom cannot approach [-]; it is rounding."""
FALL_ALIKE = 1e-9
"""Share of the accelerations of the joints up to which two bodies fall alike [-]."""
NOTABLE_FREEDOM = 0.02
"""A constraint that changes the mass by less than this share gets no sentence [-]."""
LIMITS = (int(mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT), int(mujoco.mjtConstraint.mjCNSTR_LIMIT_TENDON))
EQUALITY = int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)


@dataclass(frozen=True)
class EffectiveMass:
    """The effective mass of a contact, and what else acts on it.

    Args:
        mass: effective mass of the whole contact [kg]; infinity if the geoms cannot approach each other.
        slides: whether the point can approach only while it slides.
        motion: velocity of the joints for a unit speed of parting [1/m or 1], shape (nv,).
        gravity: acceleration with which gravity brings the geoms together where nothing else holds them [m/s2].
        yielding: numbers of the equality constraints that yield in a contact.
        limits: rows of the limits of joints and tendons that hold the contact in this pose.
    """

    mass: float
    slides: bool
    motion: Array
    gravity: float
    yielding: tuple[int, ...]
    limits: tuple[int, ...]

    @classmethod
    def immovable(cls, velocities: int) -> EffectiveMass:
        """Of geoms that cannot approach each other, with a number of velocities of the joints."""
        return cls(math.inf, slides=False, motion=np.zeros(velocities), gravity=0.0, yielding=(), limits=())


class PointLaw(NamedTuple):
    """The numbers of the law of a contact on which its effective mass depends.

    Args:
        friction: coefficient of friction [-], with which the point sticks as long as it can.
        k: stiffness of a contact point [N/m]; or
        frequency: circular frequency of the contact [rad/s]. Without either every equality constraint is rigid.
    """

    friction: float = 0.0
    k: float | None = None
    frequency: float | None = None

    def together(self, count: int) -> PointLaw:
        """The law of a number of such points as one."""
        return self if self.k is None else self._replace(k=count * self.k)


FRICTIONLESS = PointLaw()
"""A contact without friction among rigid constraints."""


def effective_mass(
    pair: GeomPair, constraints: PoseConstraints, away: Array, points: tuple[Array, Array], law: PointLaw
) -> EffectiveMass:
    """The effective mass of a contact in a pose, and what else acts on it.

    Args:
        pair: the geoms.
        constraints: of the pose.
        away: unit vector along which the first geom parts from the second, shape (3,).
        points: the contact point on each of the geoms, in the world's frame [m].
        law: of the contact.
    """
    friction, k, frequency = law
    model, data = constraints.model, constraints.data
    jacobian = np.zeros((3, model.nv))
    for body, point, sign in zip(pair.bodies, points, (1.0, -1.0), strict=True):
        rows = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, rows, None, point, body)
        jacobian += sign * rows
    rows = with_tangents(away) @ jacobian
    if not np.any(np.abs(rows[0]) > 1e-9):
        return EffectiveMass.immovable(model.nv)
    free = constraints.free(rows)
    soft = constraints.answer(free, constraints.softness, constraints.equality)
    mass = _mass(soft, rows, friction)[0]
    if frequency is None:
        frequency = math.sqrt(k / mass) if k is not None and mass < math.inf else 0.0
    limit = ~constraints.equality
    softness = np.where((constraints.rate < RIGID_IN_MASS * frequency) | limit, constraints.softness, 0.0)
    answer = constraints.answer(free, softness, constraints.equality)
    if not _free(answer, rows) > WITHOUT_FREEDOM * _free(free, rows):
        return EffectiveMass.immovable(model.nv)
    mass, impulse = _mass(answer, rows, friction)
    slides = mass == math.inf or bool(friction > 0 and _free(answer, rows) * SLIDING_FREEDOM > _stuck(answer, rows))
    if slides:
        mass, impulse = 1 / _free(answer, rows), np.array((1.0, 0.0, 0.0))
    motion = answer @ impulse
    motion = motion / float(rows[0] @ motion)
    yields = (constraints.rate < RIGID_CONSTRAINT * frequency) & constraints.equality
    matters = not math.isclose(_free(free, rows), _free(answer, rows), rel_tol=NOTABLE_FREEDOM)
    pressed = limit & (constraints.rows @ motion < -1e-9 * np.abs(constraints.rows).max(initial=1.0))
    limited = constraints.answer(free, softness, constraints.equality | pressed) if pressed.any() else answer
    stops = not math.isclose(_free(limited, rows), _free(answer, rows), rel_tol=NOTABLE_FREEDOM)
    return EffectiveMass(
        mass=mass,
        slides=slides,
        motion=motion,
        gravity=_approach_of_gravity(-constraints.weight * answer[:, 0]),
        yielding=tuple(sorted({int(number) for number in constraints.number[yields]})) if matters else (),
        limits=tuple(int(row) for row in constraints.row[pressed]) if stops else (),
    )


def _approach_of_gravity(parts: Array) -> float:
    """Acceleration with which gravity brings the geoms together [m/s2], from the parts of the joints; exactly zero
    where all that is left of it is rounding, as for bodies that fall alike."""
    gravity = float(parts.sum())
    return gravity if abs(gravity) > FALL_ALIKE * float(np.abs(parts).sum()) else 0.0


class PoseConstraints:
    """The constraints of a model in its pose but for contacts, and the force of gravity on the joints.

    Attributes:
        row, number: which row of the engine each is, and of which equality, joint or tendon.
        equality: whether each is an equality constraint; the others are limits.
        rows: their Jacobian, shape (n, nv).
        softness: R of each, its regularisation [1/kg and alike].
        rate: circular frequency with which each returns [rad/s].
        weight: force of gravity on the joints, shape (nv,).
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model, self.data = model, data
        kinds = np.array(data.efc_type[: data.nefc], dtype=int)
        self.row: Integers = np.flatnonzero((kinds == EQUALITY) | np.isin(kinds, LIMITS))
        self.number = np.array(data.efc_id, dtype=np.int64)[self.row]
        self.equality: Flags = kinds[self.row] == EQUALITY
        self.rows = np.zeros((len(self.row), model.nv))
        for i, number in enumerate(self.row):
            unit = np.zeros(data.nefc)
            unit[number] = 1.0
            mujoco.mj_mulJacTVec(model, data, self.rows[i], unit)
        self.softness: Array = np.array(data.efc_R)[self.row]
        constants = np.array(data.efc_KBIP).reshape(-1, 4)[self.row]
        self.rate: Array = np.sqrt(constants[:, 0] * constants[:, 2])
        bias = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 0, bias)
        self.weight: Array = np.array(data.qfrc_gravcomp) - bias

    @cached_property
    def moved(self) -> Array:
        """Change of the joints' velocity for a unit impulse on each constraint, shape (nv, n)."""
        return self.free(self.rows)

    def free(self, rows: Array) -> Array:
        """Change of the joints' velocity for a unit impulse on each row where no constraint holds, shape (nv, n)."""
        moved = np.zeros_like(rows)
        if len(rows):
            mujoco.mj_solveM(self.model, self.data, moved, np.ascontiguousarray(rows))
        return np.array(moved.T)

    def answer(self, free: Array, softness: Array, counted: Flags) -> Array:
        """Change of the joints' velocity with the constraints that count, shape (nv, n); `free` without them."""
        if not counted.any():
            return free
        held, moved = self.rows[counted], self.moved[:, counted]
        inner = held @ moved + np.diag(softness[counted])
        scale = np.abs(inner).max(initial=1e-300)
        solved = np.linalg.lstsq(inner / scale, held @ free / scale, rcond=1e-10)[0]
        return np.array(free - moved @ solved)


def _free(answer: Array, rows: Array) -> float:
    """W_nn [1/kg]."""
    return float(rows[0] @ answer[:, 0])


def _stuck(answer: Array, rows: Array) -> float:
    """W_nn - W_nt W_tt^-1 W_tn [1/kg]."""
    return float(rows[0] @ answer @ _sticking_impulse(rows @ answer))


def _sticking_impulse(weight: Array) -> Array:
    """The impulse, with a normal part of 1, after which the point has not slipped."""
    tangents = np.linalg.lstsq(weight[1:, 1:], -weight[1:, 0], rcond=1e-8)[0]
    return np.array((1.0, *tangents))


def _mass(answer: Array, rows: Array, friction: float) -> tuple[float, Array]:
    """The mass of a point that sticks as long as friction holds it [kg], and the impulse that stops it."""
    weight, impulse = rows @ answer, np.array((1.0, 0.0, 0.0))
    if friction > 0:
        impulse = _sticking_impulse(weight)
        if np.linalg.norm(impulse[1:]) > friction:
            impulse = _slipping_impulse(weight, friction)
    freedom = float(weight[0] @ impulse)
    return (1 / freedom if freedom > 1e-12 * weight[0, 0] else math.inf), impulse


def _slipping_impulse(weight: Array, friction: float) -> Array:
    """The impulse, with a normal part of 1, whose friction is opposite to the slip that it leaves."""
    (first, second), ((a, b), (c, d)) = weight[1:, 0].tolist(), weight[1:, 1:].tolist()
    x, y = _unit(first, second)
    for _ in range(100):
        slip_x, slip_y = _unit(first - friction * (a * x + b * y), second - friction * (c * x + d * y))
        before, (x, y) = (x, y), _unit(0.5 * (x + slip_x), 0.5 * (y + slip_y))
        if abs(x - before[0]) + abs(y - before[1]) < 1e-15:
            break
    return np.array((1.0, -friction * x, -friction * y))


def _unit(x: float, y: float) -> tuple[float, float]:
    size = max(math.hypot(x, y), 1e-300)
    return x / size, y / size
