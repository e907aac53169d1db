"""Friction of base and side that can slide, against an explicit integration of the same contacts that stands here."""

import math

import numba
import numpy as np
import pytest

import mjrock as mr
from paper import FIGURE_3, K_N

STEP = 1e-6
TANGENTIAL = 100.0
"""Stiffness of the tangential springs of the explicit integration over that of the normal ones [-]. With 300 |e| is
0.001 lower still. MuJoCo, whose friction has no such spring, lies between."""


@numba.njit
def explicit(mass, inertia, at, normal, origin, k, c, mu, h, start, steps, every):
    """Rotation of a wall by symplectic Euler steps on springs along and across its faces, limited by Coulomb's law."""
    x, v = start.copy(), np.zeros(3)
    stretch, found = np.zeros(len(k)), np.empty(steps // every)
    for n in range(steps):
        if n % every == 0:
            found[n // every] = x[2]
        s, co = math.sin(x[2]), math.cos(x[2])
        fx, fz, moment = 0.0, -mass * 9.81, 0.0
        for i in range(len(k)):
            ox, oz = at[i, 0] * co + at[i, 1] * s, -at[i, 0] * s + at[i, 1] * co
            rx, rz = x[0] + ox - origin[i, 0], x[1] + h + oz - origin[i, 1]
            vx, vz = v[0] + v[2] * oz, v[1] - v[2] * ox
            nx, nz = normal[i, 0], normal[i, 1]
            gap, rate = nx * rx + nz * rz, nx * vx + nz * vz
            if gap >= 0:
                stretch[i] = 0.0
                continue
            pressed = max(0.0, -k[i] * gap - c[i] * rate)
            # friction acts halfway between the face and the point, as it does in MuJoCo
            mx, mz = ox - 0.5 * gap * nx, oz - 0.5 * gap * nz
            slip = nz * (v[0] + v[2] * mz) - nx * (v[1] - v[2] * mx)
            kt = TANGENTIAL * k[i]
            ct = 0.2 * math.sqrt(kt * mass)
            stretch[i] += slip * STEP
            along = -(kt * stretch[i] + ct * slip)
            if abs(along) > mu[i] * pressed:
                along = math.copysign(mu[i] * pressed, along)
                stretch[i] = -along / kt
            gx, gz = pressed * nx + along * nz, pressed * nz - along * nx
            fx, fz, moment = fx + gx, fz + gz, moment + gx * mz - gz * mx
        v[0] += STEP * fx / mass
        v[1] += STEP * fz / mass
        v[2] += STEP * moment / inertia
        for j in range(3):
            x[j] += STEP * v[j]
    return found


def energies_left(case, theta):
    """|e| of the rebounds from the maxima of the rotation."""
    inner = theta[1:-1]
    peaks = inner[(inner > theta[:-2]) & (inner >= theta[2:]) & (inner > 2e-3 * FIGURE_3.alpha)]
    V = FIGURE_3.potential_energy(np.append(case.theta0, peaks))
    return np.sqrt(V[1:] / V[:-1])


@pytest.mark.parametrize(("friction", "side"), [(0.6, None), (0.4, None), (0.6, 0.6)])
def test_restitution_with_a_base_that_slides(friction, side):
    """The first rebound within one percent, and the sliding is booked."""
    e = mr.Restitution.from_geometry(FIGURE_3)
    xi_base, xi_side = mr.CALIBRATED(FIGURE_3, e, K_N)
    contacts = mr.Contacts.from_damping(
        FIGURE_3, k_base=K_N, xi_base=xi_base, k_side=K_N, xi_side=xi_side, friction=friction, side_friction=side
    )
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 1.2)
    scene = mr.wall_scene(case, contacts)
    exact = explicit(
        float(scene.mass[0]), float(scene.inertia[0]), scene.point, scene.normal, scene.face,
        scene.k, scene.c, scene.friction, FIGURE_3.h, scene.started[0][0], 1_200_000, 200,
    )  # fmt: skip
    wanted = energies_left(case, exact)[0]
    assert wanted < 0.40  # a base that holds gives 0.443
    found = mr.simulate(case, contacts, ledger=True, accuracy=1e-4)
    assert found.restitution[0] == pytest.approx(wanted, rel=1e-2)
    assert mr.simulate(case, contacts).restitution[0] == pytest.approx(found.restitution[0], rel=5e-3)
    assert found.ledger.friction[-1] > 0.01 * found.ledger.held[0]
    assert np.abs(found.energy_residual).max() < 2e-3 * found.ledger.held[0]


def test_a_wall_slides_under_a_push_it_cannot_bear():
    """A squat wall at rest under half a sine of 0.8 g at mu = 0.4 slides as a rigid block does."""
    wall, mu = mr.Block(b=1.0, h=1.05), 0.4
    motion = mr.GroundMotion.half_sine(8.0, 0.4)
    contacts = mr.Contacts.from_damping(wall, k_base=5e9, xi_base=0.05, friction=mu)
    response = mr.simulate(mr.Case(wall, 0.0, 1.5, side_stop=False, motion=motion), contacts, accuracy=1e-4)
    t = np.arange(0, 1.5, 1e-5)
    ground, v, x = motion(t), 0.0, 0.0
    for a in ground:
        drag = mu * mr.GRAVITY
        if v == 0.0 and abs(a) <= drag:
            continue
        rate = -a - drag * (math.copysign(1.0, v) if v else math.copysign(1.0, -a))
        faster = v + 1e-5 * rate
        v = 0.0 if v * faster < 0 else faster
        x += 1e-5 * v
    assert abs(x) > 0.05
    assert response.stats["base_displacement"] == pytest.approx(x, rel=1e-2)
