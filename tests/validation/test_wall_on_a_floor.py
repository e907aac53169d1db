"""A wall on the floor of a building: its motion in the four solvers, and what the stiffness of the base does."""

import numpy as np
import pytest

import mjrock as mr

WALL = mr.Block(b=0.25, h=2.0)
E = mr.Restitution.from_geometry(WALL)
TIMES = np.arange(0.0, 0.505, 0.005)
FLOOR = mr.GroundMotion(2 * np.sin(np.pi * TIMES / 0.5), 0.005).through_building(0.4, participation=1.2, height=0.7)
"""A half sine of 2 m/s2 and 0.5 s as a floor at 0.7 of the height of a building with a period of 0.4 s has it."""
CASE = mr.Case(WALL, 0.0, 1.5, motion=FLOOR, side_stop=False)


def contacts(k):
    return mr.Contacts.from_damping(WALL, k_base=k, xi_base=0.05)


def peak(answer):
    return float(np.abs(answer.theta).max()) / WALL.alpha


@pytest.fixture(scope="module")
def theory():
    return peak(mr.solve_analytical(CASE, E))


def test_the_three_compliant_solvers_agree():
    answers = [solve(CASE, contacts(1e9)) for solve in (mr.simulate, mr.solve_compliant, mr.solve_explicit)]
    peaks = [peak(answer) for answer in answers]
    np.testing.assert_allclose(peaks, peaks[1], rtol=3e-3)


def test_rocking_theory_is_the_limit_of_a_stiff_base(theory):
    """The base of 1e9 N/m3 adds a tenth to the peak, and a base of ten times the stiffness a tenth of that."""
    beyond = [peak(mr.simulate(CASE, contacts(k), accuracy=1e-4)) / theory - 1 for k in (1e9, 1e10, 1e11)]
    assert 0.05 < beyond[0] < 0.15
    assert beyond[1] < 0.15 * beyond[0]
    assert beyond[2] < 0.15 * beyond[1]
