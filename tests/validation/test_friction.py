"""Friction of base and side that can slide, against an explicit integration of the same contacts."""

import math

import numpy as np
import pytest
from everyday import among
from explicit_blocks import explicit

import mjrock as mr
from mjrock.scene.wall import wall_course
from scripts.shared.paper import FIGURE_3, K_N


def energies_left(case, theta):
    """|e| of the rebounds from the maxima of the rotation."""
    inner = theta[1:-1]
    peaks = inner[(inner > theta[:-2]) & (inner >= theta[2:]) & (inner > 2e-3 * FIGURE_3.alpha)]
    V = FIGURE_3.potential_energy(np.append(case.theta0, peaks))
    return np.sqrt(V[1:] / V[:-1])


@pytest.mark.parametrize(("friction", "side"), among([(0.6, None), (0.4, None), (0.6, 0.6)], (0.4, None), (0.6, 0.6)))
def test_restitution_with_a_base_that_slides(friction, side):
    """The first rebound, and the sliding is booked."""
    e = mr.Restitution.from_geometry(FIGURE_3)
    xi_base, xi_side = mr.CALIBRATED(FIGURE_3, e, K_N)
    contacts = mr.Contacts.from_damping(
        FIGURE_3, k_base=K_N, xi_base=xi_base, k_side=K_N, xi_side=xi_side, friction=friction, side_friction=side
    )
    case = mr.Case(FIGURE_3, 0.5 * FIGURE_3.alpha, 1.2)
    scene = mr.wall_scene(case, contacts)
    _, pose = explicit(scene, wall_course(case, scene), 1e-6, 200)
    wanted = energies_left(case, pose[:, 0, 2])[0]
    assert wanted < 0.40  # a base that holds gives 0.443
    found = mr.simulate(case, contacts, ledger=True, accuracy=1e-4)
    assert found.restitution[0] == pytest.approx(wanted, rel=2e-3)
    assert mr.simulate(case, contacts).restitution[0] == pytest.approx(wanted, rel=5e-3)
    assert found.ledger.friction[-1] > 0.01 * found.ledger.held[0]
    assert np.abs(found.energy_residual).max() < 5e-4 * found.ledger.held[0]


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
