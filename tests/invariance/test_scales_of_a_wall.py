"""What rocking may not depend on, and how it scales."""

import dataclasses

import numpy as np
import pytest

import mjrock as mr
from scripts.shared.paper import K_N


def run(wall, k_n, xi, step, duration, side_stop):
    contacts = mr.Contacts.from_damping(wall, k_base=k_n, xi_base=xi[0], k_side=k_n, xi_side=xi[1])
    case = mr.Case(wall, 0.5 * wall.alpha, duration, side_stop=side_stop)
    return mr.simulate(case, contacts, step)


# over the first impacts: later ones multiply the rounding that the changed numbers bring
sides = pytest.mark.parametrize(("side_stop", "duration"), [(False, 2.5), (True, 1.2)])
XI = (0.0528, 0.00766)


@sides
def test_length_along_the_wall(wall, side_stop, duration):
    short, long = (
        run(dataclasses.replace(wall, length=length), K_N, XI, 2e-4, duration, side_stop) for length in (1.0, 7.3)
    )
    np.testing.assert_allclose(long.theta, short.theta, atol=1e-5 * wall.alpha)


@sides
def test_density_and_stiffness_together(wall, side_stop, duration):
    light = run(wall, K_N, XI, 2e-4, duration, side_stop)
    heavy = run(dataclasses.replace(wall, density=3 * wall.density), 3 * K_N, XI, 2e-4, duration, side_stop)
    np.testing.assert_allclose(heavy.theta, light.theta, atol=1e-5 * wall.alpha)
    # the twin that must fail: density alone
    alone = run(dataclasses.replace(wall, density=3 * wall.density), K_N, XI, 2e-4, duration, side_stop)
    assert np.abs(alone.theta - light.theta).max() > 1e-3 * wall.alpha


@sides
def test_size_with_stiffness_per_area_and_time(wall, side_stop, duration):
    """Lengths times 2, k_n by 2 (stress over length), time by sqrt 2: theta(p t) is the same."""
    small = run(wall, K_N, XI, 2e-4, duration, side_stop)
    double = dataclasses.replace(wall, b=2 * wall.b, h=2 * wall.h)
    stretch = np.sqrt(2.0)
    large = run(double, K_N, XI, 2e-4 * stretch, duration * stretch, side_stop)
    assert double.p == pytest.approx(wall.p / stretch)
    count = min(len(small.t), len(large.t))
    np.testing.assert_allclose(large.t[:count] * double.p, small.t[:count] * wall.p, rtol=1e-12)
    np.testing.assert_allclose(large.theta[:count], small.theta[:count], atol=1e-5 * wall.alpha)
    # the twin that must fail: stiffness scaled by 4
    other = run(double, 4 * K_N, XI, 2e-4 * stretch, duration * stretch, side_stop)
    assert np.abs(other.theta[:count] - small.theta[:count]).max() > 1e-3 * wall.alpha
