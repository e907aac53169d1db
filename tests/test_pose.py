import math

import numpy as np
import pytest

import mjrock as mr
from mjrock.pose import base_gaps, mechanical_energy, release_pose, side_gaps
from paper import K_N


@pytest.mark.parametrize("points", [2, 9])
@pytest.mark.parametrize("share", [0.0, 1e-6, 1e-3, 0.5, 0.999, -0.5])
def test_the_released_wall_is_carried_by_its_springs(wall, points, share):
    contacts = mr.Contacts.from_damping(wall, k_base=K_N, xi_base=0.05, points=points)
    case = mr.Case(wall, share * wall.alpha, 1.0, side_stop=False)
    pose, velocity = release_pose(case, contacts)
    forces = -contacts.base.stiffness * np.minimum(base_gaps(wall, contacts, pose), 0)
    # a gap is a small difference of lengths like h: rounding leaves eps h of it, and k times that of the force
    assert forces.sum() == pytest.approx(
        wall.weight, abs=10 * np.finfo(float).eps * wall.h * contacts.base.stiffness.sum()
    )
    assert not velocity.any()


def test_the_toe_stays_where_it_is(wall, contacts):
    for theta in (0.05, -0.05):
        pose, _ = release_pose(mr.Case(wall, theta, 1.0, side_stop=False), contacts)
        toe = math.copysign(wall.b, theta)
        assert pose[0] + toe * math.cos(theta) - wall.h * math.sin(theta) == pytest.approx(toe, abs=1e-15)


def test_release_velocity_turns_about_the_toe(wall, contacts):
    case = mr.Case(wall, 0.05, 1.0, omega0=0.2)
    pose, velocity = release_pose(case, contacts)
    dt = 1e-6
    later, _ = release_pose(mr.Case(wall, 0.05 + 0.2 * dt, 1.0), contacts)
    np.testing.assert_allclose((later - pose) / dt, velocity, rtol=1e-5)


def test_gaps_are_those_of_the_corners(wall, contacts):
    pose = np.array([0.02, -0.001, 0.1])
    c, s = math.cos(0.1), math.sin(0.1)
    heights = [wall.h - 0.001 - x * s - wall.h * c for x in (-wall.b, wall.b)]
    np.testing.assert_allclose(base_gaps(wall, contacts, pose), heights, rtol=1e-14)
    distances = [0.02 - wall.b * c + z * s + wall.b for z in (-wall.h, wall.h)]
    np.testing.assert_allclose(side_gaps(wall, contacts, pose), distances, rtol=1e-14)


def test_energy_is_none_at_rest_and_the_rigid_one_at_release(wall, contacts):
    at_rest = mr.Case(wall, 0.0, 1.0)
    pose, velocity = release_pose(at_rest, contacts)
    assert mechanical_energy(at_rest, contacts, pose, velocity) == pytest.approx(0, abs=1e-9)
    tilted = mr.Case(wall, 0.5 * wall.alpha, 1.0)
    energy = mechanical_energy(tilted, contacts, *release_pose(tilted, contacts))
    # one corner instead of two carries the wall: m g (m g / 4 k) less, k that of one corner
    less = wall.weight**2 / (4 * contacts.base.stiffness[0])
    assert energy == pytest.approx(tilted.release_energy - less, rel=1e-10)
