"""The closed form of the restitution of a spring and dashpot that never pull, against its differential equation."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mjrock.contacts.rebound import rebound_damping, rebound_restitution


def integrated(xi, gravity=0.0):
    """Speed at which the force of the contact reaches zero, for unit mass, stiffness and speed of approach."""

    def force(t, y):
        return y[0] + 2 * xi * y[1] + (1.0 if t == 0 else 0.0)  # xi = 0 starts without a force

    force.terminal, force.direction = True, -1
    end = 10 * (1 + xi)
    solved = solve_ivp(
        lambda t, y: (y[1], gravity - y[0] - 2 * xi * y[1]), (0, end), (0.0, 1.0), events=force, rtol=1e-11, atol=1e-13
    )
    assert solved.status == 1
    return -solved.y[1, -1]


@pytest.mark.parametrize("xi", [0.0, 0.01, 0.05, 0.3, 0.7, 0.99, 1.0, 1.01, 1.5, 4.0])
def test_it_is_the_speed_at_which_the_force_ends(xi):
    assert rebound_restitution(xi) == pytest.approx(integrated(xi), abs=2e-9)


def test_it_is_not_the_formula_of_a_dashpot_that_pulls():
    """At 30 % damping the textbook's formula loses a quarter more speed."""
    assert rebound_restitution(0.3) == pytest.approx(0.4510, abs=1e-4)
    assert math.exp(-math.pi * 0.3 / math.sqrt(1 - 0.09)) == pytest.approx(0.3723, abs=1e-4)


@pytest.mark.parametrize("xi", [0.05, 0.3, 1.0])
def test_what_gravity_takes_from_it(xi):
    """At g / (omega v) = 0.01."""
    assert 0.0008 < rebound_restitution(xi) - integrated(xi, gravity=0.01) < 0.0034


def test_its_limits():
    assert rebound_restitution(0.0) == 1.0
    assert rebound_restitution(1.0) == math.exp(-2)
    for near in (1 - 1e-9, 1 + 1e-9):
        assert rebound_restitution(near) == pytest.approx(math.exp(-2), rel=1e-8)
    assert rebound_restitution(1e8) == pytest.approx(1 / (4 * 1e16), rel=1e-12)
    assert rebound_restitution(math.inf) == 0.0
    assert rebound_damping(1.0) == 0.0
    assert rebound_damping(math.exp(-2)) == pytest.approx(1.0, abs=1e-9)
    assert rebound_damping(0.0) == math.inf
    assert rebound_damping(1 - 1e-10) == pytest.approx(1e-10 / math.pi, rel=1e-6)


def test_the_inverse_holds_for_every_restitution():
    for e in (*np.linspace(1e-3, 1, 1000), 1e-300, 1e-20, math.exp(-2), math.nextafter(math.exp(-2), 1), 1 - 1e-15):
        assert rebound_restitution(rebound_damping(float(e))) == pytest.approx(e, rel=1e-12)


def test_more_damping_rebounds_less():
    xi = np.concatenate([np.linspace(0, 2.9, 500), np.geomspace(3, 1e6, 100)])
    assert (np.diff([rebound_restitution(float(x)) for x in xi]) < 0).all()


@pytest.mark.parametrize("xi", [-0.1, math.nan])
def test_a_damping_ratio_that_cannot_be(xi):
    with pytest.raises(ValueError, match=r"damping ratio xi = .* valid range xi >= 0"):
        rebound_restitution(xi)


@pytest.mark.parametrize("e", [-0.1, 1.1, math.nan])
def test_a_restitution_that_cannot_be(e):
    with pytest.raises(ValueError, match=r"restitution = .* is outside the valid range 0 to 1"):
        rebound_damping(e)
