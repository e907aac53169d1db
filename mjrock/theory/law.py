"""Eq. 1 with effects, as compiled functions: the acceleration of a rigid wall that rocks about one of its toes.

    theta'' = -[s a cos(theta) - b sin(theta)] - sum T lever / I_0,
    a = (P + W d a_v/g + s W z a_g/g) / I_0,      b = (Q + W z a_v/g - s W d a_g/g) / I_0,

s = +1 or -1 the side to which the wall rocks, d and z the distance of the centroid from that toe inwards and upwards,
P and Q the restoring moment of weight, loads and thrusts (`mjrock.problem.restoring`), and T the force of each tie.
Without effects a = p^2 (sin(alpha) + s cos(alpha) a_g/g) and b = p^2 (cos(alpha) - s sin(alpha) a_g/g), which is Eq. 1.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import jitable
from ..problem.case import Case
from ..problem.motion import GroundMotion
from ..problem.pulling import Pull, pulled
from ..problem.quantities import GRAVITY, Array, Integers

SMALL = 0.05
"""Largest change of an angle in a step for which its sine and cosine are taken from series [rad]."""
SINE, COSINE = (-1 / 6, 1 / 120, -1 / 5040), (-1 / 2, 1 / 24, -1 / 720, 1 / 40320)
"""Coefficients of these series."""
SLACK, TAUT, YIELDING = 0, 1, 2
"""What a tie does in a step."""


class Shaken(NamedTuple):
    """A ground motion in one direction: a_g / g at the samples [-], and their time step [s]."""

    shares: Array
    dt: float

    @classmethod
    def of(cls, motion: GroundMotion | None) -> Shaken:
        """The arrays of a motion; empty ones stand for a base at rest."""
        return cls(np.empty(0), 1.0) if motion is None else cls(motion.accel / GRAVITY, motion.dt)


class Law(NamedTuple):
    """A rigid wall with its effects over a shaken base, as arrays for compiled functions.

    Args:
        inertia: about the outer and the inner toe [kg m2], shape (2,).
        restoring: P / I_0 and Q / I_0 about the two toes [1/s2], shape (2, 2).
        weight: W d / I_0 and W z / I_0 about the two toes [1/s2], shape (2, 2).
        x, z: horizontal and vertical motion of the base.
        ties: the numbers of each `Pull`, shape (t, 8).
        doing: what each tie does, shape (t,).
        plastic: elongation that each tie has yielded [m], shape (t,).
    """

    inertia: Array
    restoring: Array
    weight: Array
    x: Shaken
    z: Shaken
    ties: Array
    doing: Integers
    plastic: Array

    @classmethod
    def of(cls, case: Case) -> Law:
        """The law of a case."""
        inertia = np.array([case.wall.inertia_about(1), case.wall.inertia_about(-1)])
        ties = np.reshape(np.array(case.pulls, dtype=float), (-1, len(Pull._fields)))
        return cls(
            inertia,
            np.array(case.restoring) / inertia[:, None],
            np.array(case.wall.restoring) / inertia[:, None],
            Shaken.of(case.motion),
            Shaken.of(case.vertical),
            ties,
            np.full(len(ties), SLACK),
            np.zeros(len(ties)),
        )

    @property
    def frequency(self) -> float:
        """The largest of p and the frequencies of the ties [rad/s]."""
        p2 = float(np.hypot(*self.restoring.T).max())
        stiff = sum(float(pulled(Pull(*tie), 0.0, 1.0)[1] ** 2 * tie[6] / self.inertia.min()) for tie in self.ties)
        return math.sqrt(max(p2, stiff))


class Push(NamedTuple):
    """The accelerations of the base over g at the start of a step, x before z [-], and their rates [1/s]."""

    x: float
    x_rate: float
    z: float
    z_rate: float


@jitable
def piece(shaken: Shaken, t: float) -> tuple[float, float, float]:
    """a_g / g at a time [-], its rate [1/s], and the end of the interval in which it is linear [s]."""
    i, last = int(t / shaken.dt + 1e-9), len(shaken.shares) - 1
    if i >= last:
        return 0.0, 0.0, math.inf
    rate = (shaken.shares[i + 1] - shaken.shares[i]) / shaken.dt
    return shaken.shares[i] + rate * (t - i * shaken.dt), rate, (i + 1) * shaken.dt


@jitable
def pushed(law: Law, t: float) -> tuple[Push, float]:
    """The motion of the base from a time on, and the end of the interval in which it is linear [s]."""
    x, x_rate, x_end = piece(law.x, t)
    if len(law.z.shares) == 0:
        return Push(x, x_rate, 0.0, 0.0), x_end
    z, z_rate, z_end = piece(law.z, t)
    return Push(x, x_rate, z, z_rate), min(x_end, z_end)


@jitable
def turned_by(theta: float, sine: float, cosine: float, delta: float) -> tuple[float, float]:
    """Sine and cosine of theta + delta from those of theta: by the addition theorem, with series that are exact to
    rounding."""
    if abs(delta) > SMALL:
        return math.sin(theta + delta), math.cos(theta + delta)
    d2 = delta * delta
    s = delta * (1 + d2 * (SINE[0] + d2 * (SINE[1] + d2 * SINE[2])))
    c = 1 + d2 * (COSINE[0] + d2 * (COSINE[1] + d2 * (COSINE[2] + d2 * COSINE[3])))
    return sine * c + cosine * s, cosine * c - sine * s


@jitable
def held_back(law: Law, side: float, theta: float) -> float:
    """Acceleration by the ties, each doing in the step what it did at its start [rad/s2]."""
    total = 0.0
    for i in range(len(law.ties)):
        if law.doing[i] != SLACK:
            tie = pull_of(law, i)
            elongation, lever = pulled(tie, theta, side)
            force = tie.strength if law.doing[i] == YIELDING else tie.stiffness * (elongation - law.plastic[i])
            total -= force * lever
    return total / law.inertia[0 if side > 0 else 1]


@jitable
def pull_of(law: Law, i: int) -> Pull:
    """Tie i."""
    tie = law.ties[i]
    return Pull(tie[0], tie[1], tie[2], tie[3], tie[4], tie[5], tie[6], tie[7])


@jitable
def acceleration(law: Law, side: float, x: float, z: float, theta: float, sine: float, cosine: float) -> float:
    """theta'' at accelerations x and z of the base over g [rad/s2]."""
    i = 0 if side > 0 else 1
    P, Q, Wd, Wz = law.restoring[i, 0], law.restoring[i, 1], law.weight[i, 0], law.weight[i, 1]
    a, b = P + Wd * z + side * Wz * x, Q + Wz * z - side * Wd * x
    total: float = b * sine - side * a * cosine
    return total + held_back(law, side, theta) if len(law.ties) > 0 else total


@jitable
def nystroem(
    law: Law, side: float, push: Push, theta: float, omega: float, h: float
) -> tuple[float, float, float, float]:
    """Rotation and velocity a time `h` later by Nystroem's fourth-order method, and the accelerations at both ends."""
    sine, cosine = math.sin(theta), math.cos(theta)
    k1 = acceleration(law, side, push.x, push.z, theta, sine, cosine)
    delta = 0.5 * h * (omega + 0.25 * h * k1)
    sine_2, cosine_2 = turned_by(theta, sine, cosine, delta)
    x, z = push.x + 0.5 * h * push.x_rate, push.z + 0.5 * h * push.z_rate
    k2 = acceleration(law, side, x, z, theta + delta, sine_2, cosine_2)
    delta = h * (omega + 0.5 * h * k2)
    sine_3, cosine_3 = turned_by(theta, sine, cosine, delta)
    x, z = push.x + h * push.x_rate, push.z + h * push.z_rate
    k3 = acceleration(law, side, x, z, theta + delta, sine_3, cosine_3)
    sixth = h / 6
    return theta + h * (omega + sixth * (k1 + 2 * k2)), omega + sixth * (k1 + 4 * k2 + k3), k1, k3
