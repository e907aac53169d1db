"""Two free-standing blocks one on the other, against an explicit integration of the same contacts that stands here."""

import math

import numba
import numpy as np
import pytest
from scenes import two_blocks

import mjrock as mr
from mjrock.engine.mjcf import pair_rows
from mjrock.engine.model import engine_of
from mjrock.engine.pace import short_step
from mjrock.engine.stepping import fitted_steps, fixed_steps

STEP = 1e-6
PULSE = mr.GroundMotion.sine(2.0, 0.7)


@numba.njit
def explicit(mass, inertia, b, h, k, c, mu, settled, accel, dt, steps, every):
    """Rotations of two blocks, x, z, theta each, by symplectic Euler steps; tangential springs are ten times as stiff.

    The contacts are the lower edges of each block; `k` and `c` are those of the two joints. A tangential spring is
    stretched by the slip at the edge and gives way at Coulomb's limit.
    """
    x, v = settled.copy(), np.zeros(6)
    stretch = np.zeros(4)
    found = np.empty((steps // every, 2))
    for n in range(steps):
        if n % every == 0:
            found[n // every, 0], found[n // every, 1] = x[2], x[5]
        t = n * STEP
        i = int(t / dt)
        ground = 0.0
        if i < len(accel) - 1:
            ground = accel[i] + (accel[i + 1] - accel[i]) * (t / dt - i)
        force = np.zeros(6)
        for body in range(2):
            force[3 * body], force[3 * body + 1] = -mass * ground, -mass * 9.81
        for p in range(4):
            upper = p // 2
            j = 3 * upper
            s, co = math.sin(x[j + 2]), math.cos(x[j + 2])
            lx = -b if p % 2 == 0 else b
            ox, oz = lx * co - h * s, -lx * s - h * co
            px, pz = x[j] + ox, x[j + 1] + h + (2 * h if upper else 0.0) + oz
            vx, vz = v[j] + v[j + 2] * oz, v[j + 1] - v[j + 2] * ox
            nx, nz, fx, fz, gx, gz = 0.0, 1.0, 0.0, 0.0, 0.0, 0.0
            if upper:  # the face is the top of the lower block
                sl, cl = math.sin(x[2]), math.cos(x[2])
                nx, nz = sl, cl
                gx, gz = h * sl, h * cl
                fx, fz = x[0] + gx, x[1] + h + gz
                # velocity of the material point of the lower block that lies under the edge
                ax, az = px - x[0], pz - (x[1] + h)
                vx, vz = vx - (v[0] + v[2] * az), vz - (v[1] - v[2] * ax)
            gap = nx * (px - fx) + nz * (pz - fz)
            if gap >= 0:
                stretch[p] = 0.0
                continue
            rate, slip = nx * vx + nz * vz, nz * vx - nx * vz
            normal = max(0.0, -k[upper] * gap - c[upper] * rate)
            stretch[p] += slip * STEP
            along = -10 * (k[upper] * stretch[p] + c[upper] * slip)
            limit = mu * normal
            if abs(along) > limit:
                along = math.copysign(limit, along)
                stretch[p] = -along / (10 * k[upper])
            Fx, Fz = normal * nx + along * nz, normal * nz - along * nx
            force[j] += Fx
            force[j + 1] += Fz
            force[j + 2] += Fx * oz - Fz * ox
            if upper:
                ax, az = px - x[0], pz - (x[1] + h)
                force[0] -= Fx
                force[1] -= Fz
                force[2] -= Fx * az - Fz * ax
        for body in range(2):
            for q in range(3):
                v[3 * body + q] += STEP * force[3 * body + q] / (inertia if q == 2 else mass)
                x[3 * body + q] += STEP * v[3 * body + q]
    return found


def fitted(scene, accuracy):
    """Times and rotations of both blocks."""
    h = short_step(scene, accuracy)
    with engine_of(scene) as engine:
        engine.follow(h, pair_rows(scene, h, 0.25))
        engine.release(scene.started)
        steps = fitted_steps(engine, scene, accuracy)
    return steps.t, steps.pose[:, [2, 5]]


@pytest.fixture(scope="module")
def reference():
    scene = two_blocks(motion=PULSE)
    b, h = 0.3, 1.05
    k, c = scene.k[[0, 2]], scene.c[[0, 2]]
    args = float(scene.mass[0]), float(scene.inertia[0]), b, h, k, c, 0.7, scene.at_rest.ravel()
    found = explicit(*args, PULSE.accel.copy(), PULSE.dt, 1_000_000, 100)
    return STEP * 100 * np.arange(len(found)), found


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_rotations_within_a_thousandth_of_the_peak(reference, accuracy):
    times, exact = reference
    t, theta = fitted(two_blocks(motion=PULSE), accuracy)
    for body in range(2):
        peak = np.abs(exact[:, body]).max()
        assert peak > 0.02
        assert np.abs(np.interp(times, t, theta[:, body]) - exact[:, body]).max() < 1e-3 * peak


def test_a_fixed_step_follows_too(reference):
    times, exact = reference
    scene = two_blocks(motion=PULSE)
    with engine_of(scene) as engine:
        engine.follow(1e-4, pair_rows(scene, 1e-4, 0.25))
        engine.release(scene.started)
        steps = fixed_steps(engine, scene, 1e-4, 0.25)
    for body in range(2):
        found = np.interp(times, steps.t, steps.pose[:, 3 * body + 2])
        assert np.abs(found - exact[:, body]).max() < 3e-3 * np.abs(exact[:, body]).max()


def test_a_joint_without_friction_fails(reference):
    """The twin that must fail: the upper block slips off the motion."""
    times, exact = reference
    t, theta = fitted(two_blocks(motion=PULSE, friction=0.05), 1e-3)
    assert np.abs(np.interp(times, t, theta[:, 1]) - exact[:, 1]).max() > 0.1 * np.abs(exact[:, 1]).max()
