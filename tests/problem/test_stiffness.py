import math

import numpy as np
import pytest

import mjrock as mr

WALL = mr.Block.from_size(thickness=0.6, height=4.2)


def test_a_joint_is_its_modulus_over_its_thickness():
    assert mr.joint_stiffness(1e9, 0.01) == pytest.approx(1e11)
    assert mr.joint_stiffness(E=2e9, thickness=0.02) == pytest.approx(1e11)


def test_a_wall_on_the_base_that_stands_for_it_shortens_as_the_wall_does():
    k_n = mr.wall_stiffness(2.1e9, WALL)
    contacts = mr.Contacts.from_damping(WALL, k_base=k_n, xi_base=0.05)
    assert contacts.base.stiffness.sum() == pytest.approx(2.1e9 * 0.6 * 1.0 / 4.2)


def test_layers_in_series_add_their_closings():
    assert mr.layered_stiffness(3e9) == pytest.approx(3e9)
    assert mr.layered_stiffness(2e9, 2e9) == pytest.approx(1e9)
    assert 1e-3 / mr.layered_stiffness(1e9, 4e9) == pytest.approx(1e-3 / 1e9 + 1e-3 / 4e9)


@pytest.mark.parametrize("points", [2, 16])
def test_the_engine_vibrates_at_the_measured_frequency(points):
    frequency = 6.0
    k_n = mr.measured_stiffness(WALL, frequency, points)
    contacts = mr.Contacts.from_damping(WALL, k_base=k_n, xi_base=0.0, points=points)
    uplift = contacts.uplift_rotation(WALL)
    start = mr.simulate(mr.Case(WALL, 0.0, 0.01, side_stop=False), contacts).end
    pose, velocity = (np.array(part) for part in start)
    kick = 0.2 * uplift * 2 * math.pi * frequency
    velocity[0] += kick * np.array([WALL.h, 0.0, 1.0])
    case = mr.Case(WALL, 0.0, 3.0, side_stop=False)
    response = mr.simulate(case, contacts, start=(pose, velocity), accuracy=1e-4)
    crossed = np.flatnonzero((response.theta[:-1] < 0) & (response.theta[1:] >= 0))
    share = response.theta[crossed] / (response.theta[crossed] - response.theta[crossed + 1])
    times = response.t[crossed] + share * np.diff(response.t)[crossed]
    assert len(times) > 10
    assert 1 / np.diff(times).mean() == pytest.approx(frequency, rel=2e-3)


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: mr.joint_stiffness(1000, 0.01), "modulus E = 1000 Pa is outside the valid range 100000 to 1e[+]12 Pa"),
        (lambda: mr.joint_stiffness(1e9, 10), "thickness = 10 m is outside"),
        (lambda: mr.wall_stiffness(1e9, 4.2), "wall = 4.2 of type float is not a Block"),
        (lambda: mr.layered_stiffness(), "stiffnesses is empty"),
        (lambda: mr.layered_stiffness(1e9, -1), r"stiffnesses\[1\] = -1 N/m3 is outside"),
        (lambda: mr.measured_stiffness(WALL, 0), "frequency = 0 Hz is outside"),
        (lambda: mr.measured_stiffness(WALL, 9e3), "k_n of the measured frequency = .* is outside"),
    ],
)
def test_it_says_what_is_wrong(make, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        make()
