"""Eq. 1 with effects, as compiled functions: the acceleration of a rigid wall that rocks about one of its toes.

    theta'' = -[s a cos(theta) - b sin(theta)] - sum T lever / I_0,
    a = (P + W d a_v/g + s W z a_g/g) / I_0,      b = (Q + W z a_v/g - s W d a_g/g) / I_0,

s = +1 or -1 the side to which the wall rocks, d and z the distance of the centroid from that toe inwards and upwards, P
and Q the restoring moment of weight, loads and thrusts (`mjrock.problem.wall.restoring_moment`), and T the force of
each tie. Without effects a = p^2 (sin(alpha) + s cos(alpha) a_g/g) and b = p^2 (cos(alpha) - s sin(alpha) a_g/g), which
is Eq. 1.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import inlined
from ..problem.ground.motion import GroundMotion
from ..problem.wall.case import Case
from ..problem.wall.restoring_moment import TiePull, pulled
from ..quantities import GRAVITY, Array, Integers
from ..rows import Rows, numbers, row_type
from ..scene.course import instants_of, last_before

SMALL = 0.05
"""Largest change of an angle in a step for which its sine and cosine are taken from series [rad]."""
SINE, COSINE = (-1 / 6, 1 / 120, -1 / 5040), (-1 / 2, 1 / 24, -1 / 720, 1 / 40320)
"""Coefficients of these series."""
SLACK, TAUT, YIELDING, BROKEN = 0, 1, 2, 3
"""States of a tie in a step."""


class GroundArrays(NamedTuple):
    """A ground motion in one direction: a_g / g at the samples [-], and their time step or instants [s], see
    `mjrock.scene.course.Shaking`."""

    shares: Array
    dt: float
    instants: Array

    @classmethod
    def from_motion(cls, motion: GroundMotion | None) -> GroundArrays:
        """The arrays of a motion; empty ones stand for a base at rest."""
        if motion is None:
            return cls(np.empty(0), 1.0, np.empty(0))
        return cls(motion.accel / GRAVITY, motion.dt, instants_of(motion))


class Toe(NamedTuple):
    """A wall that rocks about one toe.

    Args:
        side: +1 for the outer toe, -1 for the inner one.
        inertia: about the toe [kg m2].
        P, Q: restoring moment of weight, loads and thrusts over the inertia [1/s2].
        Wd, Wz: moments of the weight over the inertia [1/s2].
    """

    side: float
    inertia: float
    P: float
    Q: float
    Wd: float
    Wz: float

    @classmethod
    def from_case(cls, case: Case, side: float) -> Toe:
        """The wall of a case about one of its toes."""
        inertia = case.wall.inertia_about(side)
        moments = (*case.restoring.towards(side), *case.wall.restoring.towards(side))
        return cls(side, inertia, *(float(moment / inertia) for moment in moments))


class WallTies(NamedTuple):
    """The ties of a wall.

    Args:
        pulls: the fields of each `TiePull`, shape (t,).
        state: of each tie, one of SLACK to BROKEN, shape (t,).
        plastic: elongation that each tie has yielded [m], shape (t,).
    """

    pulls: Rows
    state: Integers
    plastic: Array

    @classmethod
    def from_case(cls, case: Case) -> WallTies:
        """The ties of a case."""
        pulls = np.array([*case.pulls], dtype=row_type(numbers(*TiePull._fields)))
        return cls(pulls, np.full(len(pulls), SLACK), np.zeros(len(pulls)))


class RockingLaw(NamedTuple):
    """A rigid wall with its effects over a shaken base, for compiled functions.

    Args:
        outer, inner: the wall about its two toes.
        x, z: horizontal and vertical motion of the base.
        ties: its ties.
    """

    outer: Toe
    inner: Toe
    x: GroundArrays
    z: GroundArrays
    ties: WallTies

    @classmethod
    def from_case(cls, case: Case) -> RockingLaw:
        """The law of a case."""
        return cls(
            Toe.from_case(case, 1.0),
            Toe.from_case(case, -1.0),
            GroundArrays.from_motion(case.motion),
            GroundArrays.from_motion(case.vertical),
            WallTies.from_case(case),
        )

    @property
    def frequency(self) -> float:
        """The largest of p and the frequencies of the ties [rad/s]."""
        p2 = max(math.hypot(toe.P, toe.Q) for toe in (self.outer, self.inner))
        least = min(self.outer.inertia, self.inner.inertia)
        stiff = sum(pulled(tie, 0.0, 1.0)[1] ** 2 * tie.stiffness / least for tie in self.ties.pulls)
        return math.sqrt(max(p2, float(stiff)))


class Push(NamedTuple):
    """The accelerations of the base over g at the start of a step, x before z [-], and their rates [1/s]."""

    x: float
    x_rate: float
    z: float
    z_rate: float


class Loads(NamedTuple):
    """The loads on a wall in a step: restoring moments about its toe, its ties, and the motion of its base."""

    toe: Toe
    ties: WallTies
    push: Push


@inlined
def piece(shaken: GroundArrays, t: float) -> tuple[float, float, float]:
    """a_g / g at a time [-], its rate [1/s], and the end of the interval in which it is linear [s]."""
    if len(shaken.instants) > 0:
        return piece_between(shaken, last_before(shaken.instants, t + 1e-9 * shaken.dt), t)
    i, last = int(t / shaken.dt + 1e-9), len(shaken.shares) - 1
    if i >= last:
        return 0.0, 0.0, math.inf
    rate = (shaken.shares[i + 1] - shaken.shares[i]) / shaken.dt
    return shaken.shares[i] + rate * (t - i * shaken.dt), rate, (i + 1) * shaken.dt


@inlined
def piece_between(shaken: GroundArrays, i: int, t: float) -> tuple[float, float, float]:
    """The same in the interval that begins at instant i."""
    if i >= len(shaken.instants) - 1:
        return 0.0, 0.0, math.inf
    start, end = shaken.instants[i], shaken.instants[i + 1]
    rate = (shaken.shares[i + 1] - shaken.shares[i]) / (end - start)
    return shaken.shares[i] + rate * (t - start), rate, end


@inlined
def pushed(horizontal: GroundArrays, vertical: GroundArrays, t: float) -> tuple[Push, float]:
    """The motion of the base from a time on, and the end of the interval in which it is linear [s]."""
    x, x_rate, x_end = piece(horizontal, t)
    if len(vertical.shares) == 0:
        return Push(x, x_rate, 0.0, 0.0), x_end
    z, z_rate, z_end = piece(vertical, t)
    return Push(x, x_rate, z, z_rate), min(x_end, z_end)


@inlined
def turned_by(theta: float, sine: float, cosine: float, delta: float) -> tuple[float, float]:
    """Sine and cosine of theta + delta from those of theta: by the addition theorem, with series that are exact to
    rounding."""
    if abs(delta) > SMALL:
        return math.sin(theta + delta), math.cos(theta + delta)
    d2 = delta * delta
    s = delta * (1 + d2 * (SINE[0] + d2 * (SINE[1] + d2 * SINE[2])))
    c = 1 + d2 * (COSINE[0] + d2 * (COSINE[1] + d2 * (COSINE[2] + d2 * COSINE[3])))
    return sine * c + cosine * s, cosine * c - sine * s


@inlined
def acceleration_by_ties(toe: Toe, ties: WallTies, theta: float) -> float:
    """Acceleration by the ties, each in the state that it had at the start of the step [rad/s2]."""
    total = 0.0
    for i in range(len(ties.state)):
        if ties.state[i] == TAUT or ties.state[i] == YIELDING:
            tie = ties.pulls[i]
            elongation, lever = pulled(tie, theta, toe.side)
            force = tie.strength if ties.state[i] == YIELDING else tie.stiffness * (elongation - ties.plastic[i])
            total -= force * lever
    return total / toe.inertia


@inlined
def acceleration(loads: Loads, after: float, theta: float, sine: float, cosine: float) -> float:
    """theta'' a time after the start of a step [rad/s2], with the sine and the cosine of the rotation."""
    toe, push = loads.toe, loads.push
    x, z = toe.side * (push.x + after * push.x_rate), push.z + after * push.z_rate
    a, b = toe.P + toe.Wd * z + toe.Wz * x, toe.Q + toe.Wz * z - toe.Wd * x
    total: float = b * sine - toe.side * a * cosine
    return total + acceleration_by_ties(toe, loads.ties, theta) if len(loads.ties.state) > 0 else total


class RotationStep(NamedTuple):
    """Rotation and angular velocity after a step, and the angular accelerations at its start and its end."""

    theta: float
    omega: float
    acceleration_at_start: float
    acceleration_at_end: float


@inlined
def nystroem(loads: Loads, theta: float, omega: float, h: float) -> RotationStep:
    """A step of length `h` by Nystroem's fourth-order method."""
    sine, cosine = math.sin(theta), math.cos(theta)
    k1 = acceleration(loads, 0.0, theta, sine, cosine)
    delta = 0.5 * h * (omega + 0.25 * h * k1)
    sine_2, cosine_2 = turned_by(theta, sine, cosine, delta)
    k2 = acceleration(loads, 0.5 * h, theta + delta, sine_2, cosine_2)
    delta = h * (omega + 0.5 * h * k2)
    sine_3, cosine_3 = turned_by(theta, sine, cosine, delta)
    k3 = acceleration(loads, h, theta + delta, sine_3, cosine_3)
    sixth = h / 6
    return RotationStep(theta + h * (omega + sixth * (k1 + 2 * k2)), omega + sixth * (k1 + 4 * k2 + k3), k1, k3)
