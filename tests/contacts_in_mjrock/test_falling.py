"""The restitution of a mass with its weight, in closed form, against its differential equation."""

import math

import pytest
from everyday import crossed
from scipy.integrate import solve_ivp

from mjrock.contacts.rebound import (
    deepest,
    falling_damping,
    falling_rebound,
    rebound_damping,
    rebound_restitution,
)


def integrated(xi, pull, share=1.0):
    """e and the time at which the force ends, for unit mass, stiffness and speed of approach."""

    def force(t, y):
        return y[0] + 2 * xi * y[1] + (1 - share) * pull + (1.0 if t < 1e-9 else 0.0)

    def surface(t, y):
        return y[0] + (1.0 if t < 1e-9 else 0.0)

    for event in (force, surface):
        event.terminal, event.direction = True, -1
    solved = solve_ivp(
        lambda t, y: (y[1], share * pull - y[0] - 2 * xi * y[1]), (0, 60), (0.0, 1.0),
        events=(force, surface), rtol=1e-11, atol=1e-13, max_step=0.1,
    )  # fmt: skip
    if solved.status != 1:
        return 0.0, math.inf
    climbs = solved.y[1, -1] ** 2 - 2 * pull * max(solved.y[0, -1], 0)
    return math.sqrt(max(climbs, 0.0)) if solved.y[1, -1] < 0 else 0.0, solved.t[-1]


@pytest.mark.parametrize(
    ("share", "pull", "xi"), crossed([1.0, 0.09], [0.0, 0.054, 0.5, 3.0], [0.0, 0.3, 0.497, 0.99, 1.0, 1.5])
)
def test_it_solves_the_equation(xi, pull, share):
    e, duration = integrated(xi, pull, share)
    rebound = falling_rebound(xi, pull, share)
    assert rebound.restitution == pytest.approx(e, abs=2e-6)
    assert rebound.duration == pytest.approx(duration, rel=1e-6)


def test_what_gravity_takes_at_a_speed():
    """Asking 0.3 gives 0.153 at g / (omega v) = 0.085, asking 0.2 gives none."""
    assert falling_rebound(rebound_damping(0.3), 0.085).restitution == pytest.approx(0.152, abs=1e-3)
    assert falling_rebound(rebound_damping(0.2), 0.085).restitution == 0.0


def test_the_damping_that_mends_it():
    assert falling_damping(0.3, 0.085) == pytest.approx(0.355, abs=1e-3)
    assert falling_damping(0.2, 0.085) == pytest.approx(0.449, abs=1e-3)
    for e in (0.02, 0.1, 0.5, 0.95):
        for pull in (1e-4, 0.05, 0.5, 20.0):
            assert falling_rebound(falling_damping(e, pull), pull).restitution == pytest.approx(e, abs=1e-6)


def test_without_gravity_it_is_the_formula():
    for xi in (0.01, 0.5, 0.999, 1.0, 1.3, 20.0):
        assert falling_rebound(xi, 0.0).restitution == pytest.approx(rebound_restitution(xi), abs=1e-9)
    assert falling_damping(0.4, 0.0) == rebound_damping(0.4)
    assert falling_damping(1.0, 0.2) == 0.0


@pytest.mark.parametrize(
    ("call", "complaint"),
    [
        (lambda: falling_rebound(-1.0, 0.1), "damping ratio xi = -1 is outside"),
        (lambda: falling_rebound(0.1, -0.1), r"pull g / \(omega v\) = -0.1 is outside"),
        (lambda: falling_rebound(0.1, 0.1, 0.0), "share = 0 is outside"),
        (lambda: falling_damping(0.0, 0.1), "restitution = 0 is outside"),
    ],
)
def test_what_cannot_be_is_refused(call, complaint):
    with pytest.raises(ValueError, match=complaint):
        call()


@pytest.mark.parametrize(("xi", "pull"), crossed([0.0, 0.1, 0.7, 1.0, 3.0], [0.0, 0.05, 2.0]))
def test_how_deep_a_blow_goes(xi, pull):
    """Beside an integration of x'' = pull - x - 2 xi x', and the closed form without weight."""
    solved = solve_ivp(
        lambda t, y: (y[1], pull - y[0] - 2 * xi * y[1]), (0, 100), (0.0, 1.0), rtol=1e-8, atol=1e-10, max_step=0.05
    )
    assert deepest(xi, pull) == pytest.approx(solved.y[0].max(), rel=1e-3)
    if xi < 1 and pull == 0:
        assert deepest(xi) == pytest.approx(math.exp(-xi * math.acos(xi) / math.sqrt(1 - xi**2)), rel=1e-12)
