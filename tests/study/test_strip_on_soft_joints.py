"""A strip between floors under a pulse beside its equation of one coordinate: the error by the stiffness of joints.

`pytest -m slow -s tests/study/test_strip_on_soft_joints.py` prints what docs/code_check.md says.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import mjrock as mr

T, H, DENSITY, LOAD, STEP = 0.35, 3.2, 1800.0, 12e3, 1e-4
WALL = mr.Block.from_size(thickness=T, height=H, length=1.0, density=DENSITY)
PULSE = mr.GroundMotion.half_sine(-11.0, 0.2)
LOWER = mr.VerticalBending(WALL, LOAD).crack_height
UPPER = H - LOWER
MASS = DENSITY * T * LOWER, DENSITY * T * UPPER, LOAD / mr.GRAVITY


def turned(angle, point):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * point[0] + s * point[1], c * point[1] - s * point[0]])


def place(theta):
    """Centroids and rotations of both parts, and height of the load at the outer face, from that of the lower one."""
    toe = np.array([T, 0.0])
    hinge = toe + turned(theta, (-T, LOWER))
    back = brentq(lambda angle: (hinge + turned(-angle, (T, UPPER)))[0] - T, -0.3, 0.9, xtol=1e-14)
    lower = toe + turned(theta, (-0.5 * T, 0.5 * LOWER))
    upper, top = (hinge + turned(-back, (x, z)) for x, z in ((0.5 * T, 0.5 * UPPER), (T, UPPER)))
    return np.array([*lower, theta, *upper, -back, top[1]])


def by_hand():
    """The first peak of the rotation of the lower part [rad], of rigid parts, by Lagrange's equation."""
    inertia = (mass * (T**2 + part**2) / 12 for mass, part in zip(MASS, (LOWER, UPPER), strict=False))
    lower, upper = inertia
    masses = np.array([MASS[0], MASS[0], lower, MASS[1], MASS[1], upper, MASS[2]])
    weight = mr.GRAVITY * np.array([0, MASS[0], 0, 0, MASS[1], 0, MASS[2]])
    pushed = np.array([MASS[0], 0, 0, MASS[1], 0, 0, 0])

    def ground(t):
        return np.interp(t, np.arange(len(PULSE.accel)) * PULSE.dt, PULSE.accel, right=0.0)

    def acceleration(theta, rate, t):
        before, here, after = (place(theta + shift) for shift in (-STEP, 0, STEP))
        first, second = (after - before) / (2 * STEP), (after - 2 * here + before) / STEP**2
        force = -weight @ first - ground(t) * (pushed @ first) - masses @ (first * second) * rate**2
        return force / (masses @ first**2)

    def back(t, state):
        return state[0] + 1e-7

    back.terminal, back.direction = True, -1
    start = next(t for t in np.linspace(0, 0.2, 2001) if acceleration(1e-3, 0.0, t) > 0)
    path = solve_ivp(
        lambda t, y: [y[1], acceleration(*y, t)], (start, 0.6), [1e-9, 0.0], rtol=1e-8, max_step=2e-3, events=back
    )
    return path.y[0].max()


@pytest.mark.slow
def test_a_strip_between_floors_is_followed_on_stiff_joints():
    """Its joints are crushed at three hinges, and it leans farther than rigid parts do."""
    expected = by_hand()
    for k_n, low, high in ((1e10, 0.09, 0.15), (1e11, 0.005, 0.02)):
        strip = mr.Masonry.between_floors(WALL, LOAD, k_n=k_n, friction=5.0, xi=0.01)
        run = mr.solve_explicit(mr.MasonryCase(strip, 0.6, motion=PULSE))
        farther = run.pose[:, 0, 2].max() / expected - 1
        print(f"k_n {k_n:.0e} N/m3: {farther:.1%} farther than rigid parts")
        assert low < farther < high
