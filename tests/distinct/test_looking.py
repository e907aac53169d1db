"""Looking at blocks and lines, one function at a time: where blocks are, which of them are looked at and when, how far
joints have worn, and what springs hold."""

import math

import numpy as np
import pytest
from by_hand import PLACE, SPIN, VELOCITY, matrix, system

from mjrock.distinct import looking
from mjrock.distinct.finder import Found
from mjrock.distinct.handover import Blocks
from mjrock.distinct.looking import Motion, Reach, Seen, Wear
from mjrock.distinct.solids import Poses

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


def still(d, count):
    """Blocks that are where they are drawn and do not move."""
    poses = Poses(np.arange(float(count * d)).reshape(count, d), np.zeros((count, d)), np.zeros((count, d, d)))
    return Motion(poses, np.zeros((count, d)), np.zeros(count))


@BOTH
def test_blocks_are_where_their_bodies_and_supports_are(d):
    """Blocks 3 and 1 are the bodies, block 2 is moved by a support, and block 0 stays."""
    whole, which = system(d), [0, 2] if d == 2 else [0, 1, 2]
    whole.bodies["turn"] = 9.0
    if d == 3:
        whole.bodies["inverse_in_world"] = 9.0
    motion, sizes = still(d, 4), np.array([9.0, 0.5, 7.0, 0.8])
    body, fixed, support = np.array([-1, 1, -1, 0]), np.array([0, -1, 1, -1]), np.array([-1, -1, 0, -1])
    blocks = Blocks(motion.poses, sizes, np.array([3, 1]), body, fixed, support)
    looking.write_motion(whole, blocks, motion, whole.axes)
    poses, none = motion.poses, np.zeros(d)
    np.testing.assert_array_equal(poses.moved, [none, PLACE[1, which], whole.supports.moved[0], PLACE[0, which]])
    np.testing.assert_array_equal(
        motion.velocity, [none, VELOCITY[1, which], whole.supports.moving[0], VELOCITY[0, which]]
    )
    spin = np.abs(SPIN[:, 1]) if d == 2 else np.linalg.norm(SPIN, axis=1)
    np.testing.assert_allclose(motion.about, [0.0, 0.5 * spin[1], 0.0, 0.8 * spin[0]], rtol=1e-12)
    turned = [np.zeros((d, d)), matrix(d, 1) - np.eye(d), np.zeros((d, d)), matrix(d, 0) - np.eye(d)]
    np.testing.assert_allclose(poses.change, turned, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(whole.bodies["turn"], system(d).bodies["turn"], rtol=1e-13)
    if d == 3:
        np.testing.assert_allclose(whole.bodies["inverse_in_world"], system(d).bodies["inverse_in_world"], rtol=1e-12)


@BOTH
def test_a_corner_goes_as_far_as_its_block_moves_and_turns(d):
    """The norm of the change of rotation counts, and that of the way."""
    here, there = still(d, 2).poses, still(d, 2).poses
    here.moved[1], there.moved[1] = np.arange(d) + 1.0, -1.0
    here.change[1], there.change[1] = np.arange(d * d).reshape(d, d), 0.5
    expected = np.linalg.norm(np.arange(d) + 2.0) + 0.3 * np.linalg.norm(np.arange(d * d) - 0.5)
    assert looking.far(here, there, 1, 0.3) == pytest.approx(expected, rel=1e-14)
    assert looking.far(here, there, 0, 0.3) == 0


def watched(d, motion, limits, stay, left=(), seen=()):
    """What a look sees of two blocks of sizes 0.5 and 0.8 m, which were watched and seen at rest."""
    start, flags = still(d, 2).poses, np.isin(np.arange(2), seen)
    known = Seen(flags.copy(), still(d, 2).poses, np.array([3, 5]))
    ahead, reach = np.full(2, 9.0), Reach(start, np.array(limits), np.array(stay))
    gone = np.isin(np.arange(2), left)
    some = looking.watch(motion, np.array([0.5, 0.8]), reach, known, gone, ahead)
    return bool(some), known, ahead


@BOTH
def test_how_far_blocks_may_go_until_the_next_look_is_what_their_speeds_make(d):
    motion = still(d, 2)
    motion.velocity[1], motion.about[:] = 2.0, [0.5, 0.25]
    _, _, ahead = watched(d, motion, [9.0, 9.0], [9.0, 9.0])
    np.testing.assert_allclose(ahead, looking.LOOK * np.array([0.5, 2 * math.sqrt(d) + 0.25]), rtol=1e-14)


@BOTH
def test_a_block_is_looked_at_once_it_may_pass_its_limit(d):
    """By the way that it has gone and that it may go. At the limit it is not."""
    motion = still(d, 2)
    motion.poses.moved[1, 0], motion.about[1] = 0.25, 0.5 / looking.LOOK
    for limit, is_watched in ((0.75, False), (0.7499, True)):
        some, seen, _ = watched(d, motion, [1.0, limit], [9.0, 9.0])
        assert (some, seen.watched.tolist(), seen.moves.tolist()) == (
            is_watched,
            [False, is_watched],
            [3, 5 + is_watched],
        )
        np.testing.assert_array_equal(seen.poses.moved[1], motion.poses.moved[1] * is_watched)


@BOTH
def test_a_block_that_has_left_a_joint_is_looked_at_at_once(d):
    some, seen, _ = watched(d, still(d, 2), [9.0, 9.0], [9.0, 9.0], left=[0])
    assert (some, seen.watched.tolist(), seen.moves.tolist()) == (True, [True, False], [4, 5])


@BOTH
@pytest.mark.parametrize("seen_before", [[], [0], [0, 1]])
def test_a_block_has_moved_where_a_find_of_it_is_not_valid_any_more(d, seen_before):
    """Its pose is kept then, and only then. Nothing is to be done where no block is looked at."""
    motion = still(d, 2)
    motion.poses.moved[:, 0], motion.poses.change[1, 0, 1] = [0.25, 0.5], 0.125
    some, seen, _ = watched(d, motion, [9.0, 9.0], [0.25, 0.5999], seen=seen_before)
    assert (some, seen.moves.tolist()) == (bool(seen_before), [3, 6])
    np.testing.assert_array_equal(seen.poses.moved[:, 0], [0.0, 0.5])
    np.testing.assert_array_equal(seen.poses.change[:, 0, 1], [0.0, 0.125])
    some, seen, _ = watched(d, motion, [9.0, 9.0], [0.25, 0.6], seen=seen_before)
    assert (some, seen.moves.tolist()) == (False, [3, 5])


def found_places(d, pairs, gap):
    """Places of pairs of blocks."""
    face, other = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    each = np.ones(len(gap))
    return Found(face, other, np.zeros((len(gap), d)), np.zeros((len(gap), d)), np.array(gap), each, each)


@BOTH
def test_the_next_look_is_before_a_pair_has_gone_too_far(d):
    """A share of the size of the smaller block, or half of the gap where that is more, at the speed of both."""
    motion, sizes = still(d, 3), np.array([0.5, 0.8, 0.3])
    motion.velocity[0], motion.velocity[1], motion.about[:] = 1.0, -1.0, [0.5, 0.25, 0.125]
    speed = 2 * math.sqrt(d) + 0.75
    for gap, until in ((0.0, 0.01 / speed), (0.015, 0.01 / speed), (-1.0, 0.01 / speed), (0.024, 0.012 / speed)):
        soon = np.zeros(1, dtype=bool)
        assert looking.wait(found_places(d, [[0, 1]], [gap]), motion, sizes, soon) == pytest.approx(until, rel=1e-14)
    both = found_places(d, [[2, 1], [0, 1], [0, 2]], [0.0, 0.0, 0.0])
    expected = min(0.01 / speed, 0.006 / (math.sqrt(d) + 0.625))
    assert looking.wait(both, motion, sizes, np.zeros(3, dtype=bool)) == pytest.approx(expected, rel=1e-14)


def test_looks_are_not_too_seldom_and_not_too_often():
    motion, sizes = still(2, 2), np.array([0.5, 0.8])
    for found in (found_places(2, [], []), found_places(2, [[0, 1]], [0.0])):
        assert looking.wait(found, motion, sizes, np.zeros(len(found.gap), dtype=bool)) == looking.LOOK
    motion.about[0] = 1e3
    assert looking.wait(found_places(2, [[0, 1]], [0.0]), motion, sizes, np.zeros(1, dtype=bool)) == 5e-4


def test_places_are_kept_that_may_touch_before_the_next_look():
    motion, sizes, soon = still(2, 2), np.array([0.5, 0.8]), np.zeros(4, dtype=bool)
    motion.about[0] = 1.0  # the next look is after 5 ms
    within = 2 * (1.0 * 5e-3 + 2 * 0.5 * 9.81 * 5e-3**2 + 1e-3 * 0.5)
    gap = [-0.1, 0.0, within * (1 - 1e-9), within * (1 + 1e-9)]
    assert looking.wait(found_places(2, [[0, 1]] * 4, gap), motion, sizes, soon) == looking.LOOK
    assert soon.tolist() == [True, True, True, False]
    motion.about[0] = 10.0  # the next look is after 1 ms, for all places
    within = 2 * (10.0 * 1e-3 + 2 * 0.5 * 9.81 * 5e-3**2 + 1e-3 * 0.5)
    gap = [within * (1 + 1e-9), within * (1 - 1e-9), 0.0, 0.05]
    assert looking.wait(found_places(2, [[0, 1]] * 4, gap), motion, sizes, soon) == pytest.approx(1e-3)
    assert soon.tolist() == [False, True, True, False]


@BOTH
def test_springs_hold_what_they_store(d):
    lines = [(0, -0.003, 0.02), (0, 0.002, 0.0), (0, -0.001, 0.0)]
    whole, _ = worn(d, lines, [1.0])
    for body in whole.bodies:
        looking.take_turn(body, whole.axes)
    whole.lines["k"] = [1e5, 2e5, 4e5]
    depth = np.full(2, 9.0)
    energy = looking.held_by_lines(whole, np.array([2, 1]), depth, whole.axes)
    assert energy == pytest.approx(0.5 * 4e5 * 1e-6, rel=1e-9)
    np.testing.assert_allclose(depth, [0.001, 0.0], rtol=1e-9)
    energy = looking.held_by_lines(whole, np.array([0, 2]), depth, whole.axes)
    assert energy == pytest.approx(0.5 * 1e5 * 9e-6 + 0.5 * 4e5 * 1e-6, rel=1e-9)
    np.testing.assert_allclose(depth, [0.003, 0.001], rtol=1e-9)
