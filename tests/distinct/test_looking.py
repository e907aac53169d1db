"""Looking at lines, one function at a time: how far joints have worn, and what springs hold."""

import numpy as np
import pytest
from by_hand import matrix, system

from mjrock.distinct import looking
from mjrock.distinct.looking import Wear
from mjrock.distinct.turning import take_turn

BOTH = pytest.mark.parametrize("d", [2, 3])
NORMAL = {2: np.array([0.6, 0.8]), 3: np.array([0.48, 0.6, 0.64])}
ALONG = {2: np.array([0.8, -0.6]), 3: np.array([-0.8, 0.0, 0.6])}
AT = {2: np.array([0.2, -0.5]), 3: np.array([0.2, 0.3, -0.5])}
ORIGIN = {2: np.array([-0.1, 0.4]), 3: np.array([-0.1, -0.25, 0.4])}


def put_line(line, d, whole, face, gap, slip):
    """A line of body 1 that has opened by a gap and slipped along its face."""
    line.body, line.face, line.support = 1, -1 if face == "support" else face, 0 if face == "support" else -1
    line.at, line.origin, line.normal = AT[d], ORIGIN[d], NORMAL[d]
    turn, over = np.eye(d), np.zeros(d)
    if face == 0:
        turn = matrix(d, 0)
        over = whole.bodies[0].place + turn @ ORIGIN[d] - ORIGIN[d]
    elif face == "support":
        over = whole.supports.moved[0]
    own = whole.bodies[1].place + matrix(d, 1) @ AT[d] - AT[d]
    line.between = turn @ (gap * NORMAL[d] + slip * ALONG[d]) - own + over


def worn(d, lines, left, faces=(0,)):
    """A system whose bodies have been turned since their rotations were taken, and the wear of its joints.

    Lines are (pair, gap, slip).
    """
    whole = system(d, len(lines))
    for i, (_, gap, slip) in enumerate(lines):
        put_line(whole.lines[i], d, whole, faces[i % len(faces)], gap, slip)
    whole.bodies["turn"] = 9.0
    pairs, count = np.array([pair for pair, _, _ in lines]), len(left)
    return whole, Wear(pairs, np.full(count, 7.0), np.full(count, -7.0), np.array(left))


@BOTH
@pytest.mark.parametrize("face", [-1, 0, "support"])
def test_slip_and_gap_of_a_pair_are_those_of_its_lines(d, face):
    """The largest slip, and the least gap. What a line had before as its widest gap stays."""
    lines = [(1, 0.003, 0.02), (0, -0.001, -0.004), (1, -0.002, -0.05), (1, 0.001, 0.01)]
    whole, wear = worn(d, lines, [1.0, 1.0], (face,))
    whole.lines["widest"] = [0.0, 0.002, 0.0, 0.005]
    assert not looking.wears_joints(whole, wear, whole.axes)
    np.testing.assert_allclose(wear.slip, [0.004, 0.05], rtol=1e-9)
    np.testing.assert_allclose(wear.gap, [-0.001, -0.002], rtol=1e-9)
    np.testing.assert_allclose(whole.lines["widest"], [0.003, 0.002, 0.0, 0.005], rtol=1e-9)
    np.testing.assert_allclose(whole.bodies["turn"], system(d).bodies["turn"], rtol=1e-13)


@BOTH
@pytest.mark.parametrize(
    ("lines", "left", "expected"),
    [
        ([(0, 0.0, 0.05), (1, 0.0, 0.01)], [0.04, 0.04], True),
        ([(0, 0.0, 0.01), (1, 0.0, 0.05)], [0.04, 0.04], True),
        ([(0, 0.0, 0.05), (1, 0.0, 0.01)], [0.06, 0.04], False),
        ([(0, 0.05, 0.0), (1, 0.0, 0.0)], [0.04, 0.04], True),
        ([(0, 0.05, 0.0), (0, 0.03, 0.0)], [0.04], False),
    ],
)
def test_a_pair_has_left_its_joints_where_it_has_slipped_or_opened_too_far(d, lines, left, expected):
    whole, wear = worn(d, lines, left)
    assert bool(looking.wears_joints(whole, wear, whole.axes)) is expected


def test_at_the_limit_a_pair_has_not_left():
    whole, wear = worn(2, [(0, 0.0, 0.0)], [0.0])
    whole.bodies["place"], whole.lines["between"], whole.lines["face"] = 0.0, 0.0, -1
    whole.bodies["angle"] = 0.0
    assert not looking.wears_joints(whole, wear, whole.axes)
    assert (wear.slip[0], wear.gap[0]) == (0.0, 0.0)
    np.testing.assert_array_equal(whole.lines["widest"], 0.0)


@BOTH
def test_springs_hold_what_they_store(d):
    lines = [(0, -0.003, 0.02), (0, 0.002, 0.0), (0, -0.001, 0.0)]
    whole, _ = worn(d, lines, [1.0])
    for body in whole.bodies:
        take_turn(body, whole.axes)
    whole.lines["k"] = [1e5, 2e5, 4e5]
    depth = np.full(2, 9.0)
    energy = looking.held_by_lines(whole, np.array([2, 1]), depth, whole.axes)
    assert energy == pytest.approx(0.5 * 4e5 * 1e-6, rel=1e-9)
    np.testing.assert_allclose(depth, [0.001, 0.0], rtol=1e-9)
    energy = looking.held_by_lines(whole, np.array([0, 2]), depth, whole.axes)
    assert energy == pytest.approx(0.5 * 1e5 * 9e-6 + 0.5 * 4e5 * 1e-6, rel=1e-9)
    np.testing.assert_allclose(depth, [0.003, 0.001], rtol=1e-9)
