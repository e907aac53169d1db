"""Blocks that are driven and turn round at once, fixed ones by their history and others by a jack, miss no contact."""

import math

import numpy as np
import pytest
from everyday import among
from masonry_blocks import box

import mjrock as mr
from mjrock.distinct.supports import velocity_changes
from mjrock.distinct.system import Supports

K_N, SPEED, SIDE = 1e10, 3.0, 0.05


def history(*corners):
    """Two supports: one along these corners (t, x, z), and one that is still."""
    t, x, z = np.array([*corners, (0.0, 0.0, 0.0), (9.0, 0.0, 0.0)]).T
    count = len(corners)
    moving = np.array([[1.0, 0.0], [0.0, 0.0]])
    return Supports(t, np.column_stack([x, z]), np.array([0, count, count + 2]), np.zeros((2, 2)), moving)


@pytest.mark.parametrize(
    ("t", "until", "expected"),
    [(0.1, 0.5, 0.0), (0.1, 1.5, 3.0), (1.2, 1.5, 3.0), (1.5, 2.5, 3.0), (2.5, 2.6, 1.0), (-1.0, -0.5, 1.0)],
)
def test_a_surge_is_the_largest_change_of_velocity_until_a_time(t, until, expected):
    """It moves with 1 m/s along x, from 1 s on with -2 m/s, and from 2 s on it is still, as it is before its start."""
    supports = history((0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (2.0, -1.0, 0.0))
    np.testing.assert_allclose(velocity_changes(supports, t, until), [expected, 0.0])


@pytest.mark.parametrize("turns", among((0.054, 0.066, 0.068, 0.07, 0.072, 0.078), 0.072))
def test_a_box_that_flies_is_caught_by_a_support_that_turns_round(turns):
    """The table falls away with 0.4 m/s and comes up with 3 m/s. It meets the box at no more than these and what the
    box has fallen with, and its springs stop it within v sqrt(m / k)."""
    table, free = box(-0.3, 0.4, -0.1, 0.0, fixed=True, name="table"), box(0.0, 0.1, 0.0, SIDE)
    masonry = mr.Masonry([table, free], k_n=K_N, friction=0.6, xi=0.2)
    t, z = [0.0, turns, turns + 0.05], [0.0, -0.4 * turns, -0.4 * turns + 0.05 * SPEED]
    case = mr.MasonryCase(masonry, turns + 0.01, supports={"table": (t, [0.0] * 3, z)}, settled=False)
    run = mr.solve_explicit(case, output_step=1e-4)
    deepest = (SPEED + mr.GRAVITY * turns) * math.sqrt(free.mass / (K_N * 0.1))
    assert -(run.pose[:, 0, 1] - np.interp(run.t, t, z)).min() < deepest


@pytest.mark.parametrize("begins", [0.003, 0.0035])
def test_a_box_is_caught_by_a_plate_that_a_jack_pushes(begins):
    """The plate is 5 mm away and gets 3 m/s at once."""
    ground = box(-2.0, 2.0, -0.1, 0.0, fixed=True)
    plate, free = box(-0.055, -0.005, 0.0, SIDE, name="plate"), box(0.0, 0.05, 0.0, SIDE)
    masonry = mr.Masonry([ground, plate, free], k_n=K_N, friction=0.0, xi=0.2)
    stroke = [0.0, begins, begins + 0.01], [0.0, 0.0, 0.01 * SPEED]
    jack = mr.Actuator("plate", (-0.055, 0.025), (1.0, 0.0), stroke, 1e8, 1e4, guided="translation")
    case = mr.MasonryCase(masonry, begins + 0.004, effects=(jack,), settled=False)
    run = mr.solve_explicit(case, output_step=5e-5)
    deepest = SPEED * math.sqrt(free.mass / (K_N * SIDE))
    assert -(0.005 + run.pose[:, 1, 0] - run.pose[:, 0, 0]).min() < deepest
