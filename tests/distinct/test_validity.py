"""Validity of contacts, one function at a time: where blocks are, which of them are searched and when, how far
joints have slipped and opened, and what springs hold."""

import math

import numpy as np
import pytest
from by_hand import PLACE, SPIN, VELOCITY, matrix, system

from mjrock.distinct.search import validity
from mjrock.distinct.search.finder import ContactPlaces
from mjrock.distinct.search.handover import Blocks
from mjrock.distinct.search.solids import Poses
from mjrock.distinct.search.validity import JointState, Limits, Motion, Validity

BOTH = pytest.mark.parametrize("d", [2, 3])
INTERVAL = 5e-3
"""Longest time between two updates [s]."""
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


def slipped(d, lines, left, faces=(0,)):
    """A system whose bodies have been turned since their rotations were taken, and the joints of its joints.

    Lines are (pair, gap, slip).
    """
    whole = system(d, len(lines))
    for i, (_, gap, slip) in enumerate(lines):
        put_line(whole.lines[i], d, whole, faces[i % len(faces)], gap, slip)
    whole.bodies["rotation"] = 9.0
    pairs, count = np.array([pair for pair, _, _ in lines]), len(left)
    blocks = np.arange(count)[:, None] + [0, 1]
    written = np.full(count, 7.0), np.full(count, -7.0), np.full(count, 7.0), np.full(count, True)
    return whole, JointState(pairs, blocks, np.array(left), np.full(count, 2.0), *written)


def left_by(whole, joints, handed_over=None):
    """Which blocks have left a joint since the last update."""
    count = len(joints.left)
    left, handed_over = np.full(count + 1, True), np.zeros(count, dtype=bool) if handed_over is None else handed_over
    for body in whole.bodies:
        validity.update_rotation(body)
    validity.update_joints(whole, joints)
    validity.mark_left(whole.laws, joints, handed_over, left)
    np.testing.assert_array_equal(left, np.append(joints.left, False) | np.append(False, joints.left))
    return left


@BOTH
@pytest.mark.parametrize("face", [-1, 0, "support"])
def test_slip_and_gap_of_a_pair_are_those_of_its_lines(d, face):
    """The largest slip, and the least gap. What a line had before as its widest gap stays."""
    lines = [(1, 0.003, 0.02), (0, -0.001, -0.004), (1, -0.002, -0.05), (1, 0.001, 0.01)]
    whole, joints = slipped(d, lines, [1.0, 1.0], (face,))
    whole.lines["widest"] = [0.0, 0.002, 0.0, 0.005]
    assert not left_by(whole, joints).any()
    np.testing.assert_allclose(joints.slip, [0.004, 0.05], rtol=1e-9)
    np.testing.assert_allclose(joints.gap, [-0.001, -0.002], rtol=1e-9)
    np.testing.assert_allclose(whole.lines["widest"], [0.003, 0.002, 0.0, 0.005], rtol=1e-9)
    np.testing.assert_allclose(whole.bodies["rotation"], system(d).bodies["rotation"], rtol=1e-13)


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
    whole, joints = slipped(d, lines, left)
    assert bool(left_by(whole, joints).any()) is expected
    assert not left_by(whole, joints, np.full(len(left), True)).any()  # had left before


@BOTH
@pytest.mark.parametrize("face", [-1, 0])
def test_a_pair_has_left_its_joints_where_their_faces_have_tilted_too_far(d, face):
    """A turn about the normal does not tilt them."""
    whole, joints = slipped(d, [(0, -0.001, 0.0), (1, -0.001, 0.0)], [1.0, 1.0], (face,))
    own, other = matrix(d, 1) @ NORMAL[d], (matrix(d, 0) if face == 0 else np.eye(d)) @ NORMAL[d]
    for rolled, left in ((1.01, False), (0.99, True)):
        joints.tilt_limit[:] = 2.0, rolled * (1 - own @ other)
        assert left_by(whole, joints).tolist() == [False, left, left]
        np.testing.assert_allclose(joints.tilt, 1 - own @ other, rtol=1e-9)


def test_at_the_limit_a_pair_has_not_left():
    whole, joints = slipped(2, [(0, 0.0, 0.0)], [0.0])
    whole.bodies["place"], whole.lines["between"], whole.lines["face"] = 0.0, 0.0, -1
    whole.bodies["angle"] = 0.0
    assert not left_by(whole, joints).any()
    assert (joints.slip[0], joints.gap[0], joints.tilt[0]) == (0.0, 0.0, 0.0)
    np.testing.assert_array_equal(whole.lines["widest"], 0.0)


def still(d, count):
    """Blocks that are where they are drawn and do not move."""
    poses = Poses(np.arange(float(count * d)).reshape(count, d), np.zeros((count, d)), np.zeros((count, d, d)))
    return Motion(poses, np.zeros((count, d)), np.zeros(count), np.zeros(count))


@BOTH
def test_blocks_are_where_their_bodies_and_supports_are(d):
    """Blocks 3 and 1 are the bodies, block 2 is moved by a support, and block 0 stays."""
    whole, which = system(d), [0, 2] if d == 2 else [0, 1, 2]
    whole.bodies["rotation"] = 9.0
    if d == 3:
        whole.bodies["inverse_in_world"] = 9.0
    motion, sizes = still(d, 4), np.array([9.0, 0.5, 7.0, 0.8])
    body, fixed, support = np.array([-1, 1, -1, 0]), np.array([0, -1, 1, -1]), np.array([-1, -1, 0, -1])
    blocks = Blocks(motion.poses, sizes, np.array([3, 1]), body, fixed, support)
    motion.surge[:] = [0.0, 0.25, 0.75, 0.0]
    validity.update_motion(whole, blocks, motion)
    poses, none = motion.poses, np.zeros(d)
    np.testing.assert_array_equal(poses.moved, [none, PLACE[1, which], whole.supports.moved[0], PLACE[0, which]])
    np.testing.assert_array_equal(
        motion.velocity, [none, VELOCITY[1, which], whole.supports.moving[0], VELOCITY[0, which]]
    )
    spin = np.abs(SPIN[:, 1]) if d == 2 else np.linalg.norm(SPIN, axis=1)
    np.testing.assert_allclose(motion.about, [0.0, 0.5 * spin[1] + 0.25, 0.75, 0.8 * spin[0]], rtol=1e-12)
    turned = [np.zeros((d, d)), matrix(d, 1) - np.eye(d), np.zeros((d, d)), matrix(d, 0) - np.eye(d)]
    np.testing.assert_allclose(poses.change, turned, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(whole.bodies["rotation"], system(d).bodies["rotation"], rtol=1e-13)
    if d == 3:
        np.testing.assert_allclose(whole.bodies["inverse_in_world"], system(d).bodies["inverse_in_world"], rtol=1e-12)


@BOTH
def test_a_corner_goes_as_far_as_its_block_moves_and_turns(d):
    """The norm of the change of rotation counts, and that of the way."""
    here, there = still(d, 2).poses, still(d, 2).poses
    here.moved[1], there.moved[1] = np.arange(d) + 1.0, -1.0
    here.change[1], there.change[1] = np.arange(d * d).reshape(d, d), 0.5
    expected = np.linalg.norm(np.arange(d) + 2.0) + 0.3 * np.linalg.norm(np.arange(d * d) - 0.5)
    assert validity.displacement_of(here, there, 1, 0.3) == pytest.approx(expected, rel=1e-14)
    assert validity.displacement_of(here, there, 0, 0.3) == 0


def updated(
    d,
    motion,
    limits=(9.0, 9.0),
    displacement=(0.25, 0.5999),
    left=(),
    searched=(),
    since=1e-3,
    valid_for=5e-3,
    speed=0.0,
):
    """What an update makes of two blocks of sizes 0.5 and 0.8 m, some searched before, all at rest or at a speed.

    Returns which ones are outdated, and the validity."""
    start, known = still(d, 2).poses, still(d, 2)
    known.about[:] = speed
    (flags, gone), each = (np.isin(np.arange(2), those) for those in (searched, left)), np.full((2, 2), valid_for)
    sight = Validity(flags, known, np.array([3, 5]), each[0], each[1], np.array([False, True]), gone)
    known_limits = Limits(start, np.array(limits), np.array(displacement), INTERVAL)
    some = validity.mark_outdated(motion, np.array([0.5, 0.8]), known_limits, sight, since)
    assert bool(some) is bool(sight.outdated.any())
    np.testing.assert_array_equal(sight.searches, np.array([3, 5]) + sight.outdated)
    return sight.outdated.tolist(), sight


def test_the_time_between_updates_is_that_of_the_smallest_block():
    """Of 0.5 x 0.25 m it is 5 ms, and goes with the root of the size, as times of a model do."""
    size = 0.5 * math.hypot(0.5, 0.25)
    assert validity.longest_interval(np.array([9.0, size, 1.0])) == pytest.approx(INTERVAL, rel=0.02)
    assert validity.longest_interval(4 * np.array([size])) == 2 * validity.longest_interval(np.array([size]))
    assert validity.fall_within(0.1) == pytest.approx(0.04905)


@BOTH
def test_how_far_blocks_may_go_until_the_next_update_is_what_their_speeds_make(d):
    motion = still(d, 2)
    motion.velocity[1], motion.about[:] = 2.0, [0.5, 0.25]
    _, searched = updated(d, motion)
    np.testing.assert_allclose(searched.ahead, INTERVAL * np.array([0.5, 2 * math.sqrt(d) + 0.25]), rtol=1e-14)


@BOTH
def test_a_block_is_searched_once_it_may_pass_its_limit(d):
    """By the way that it has gone and that it may go. At the limit it is not."""
    motion = still(d, 2)
    motion.poses.moved[1, 0], motion.about[1], motion.velocity[1, -1] = 0.25, 0.375 / INTERVAL, 0.125 / INTERVAL
    motion.poses.change[0, 0, 1] = 0.125
    for limit, is_searched in ((0.75, False), (0.7499, True)):
        outdated, searched = updated(d, motion, [1.0, limit], [9.0, 9.0])
        assert outdated == searched.searched.tolist() == [False, is_searched]
        np.testing.assert_array_equal(searched.motion.poses.moved[1], motion.poses.moved[1] * is_searched)
        np.testing.assert_array_equal(searched.motion.velocity[1], motion.velocity[1] * is_searched)
        assert searched.motion.about.tolist() == [0.0, motion.about[1] * is_searched]
        assert not searched.motion.poses.change.any()


@BOTH
@pytest.mark.parametrize("searched", [[], [0]])
def test_a_block_that_has_left_a_joint_is_found_at_once(d, searched):
    outdated, sight = updated(d, still(d, 2), left=[0], searched=searched)
    assert outdated == sight.searched.tolist() == [True, False]


@BOTH
@pytest.mark.parametrize("searched", [[], [0], [0, 1]])
def test_contacts_of_a_block_that_has_moved_are_valid_for_their_time(d, searched):
    """Its pose is kept when they are found again, and only then. Nothing is to be done where no block is searched."""
    motion = still(d, 2)
    motion.poses.moved[:, 0], motion.poses.change[1, 0, 1] = [0.25, 0.5], 0.125
    for since, valid_for, serves in (
        (1e-3, 5e-3, True),
        (2.4e-3, 5e-3, True),
        (2.6e-3, 5e-3, False),
        (0.0, 1e-3, False),
    ):
        outdated, sight = updated(d, motion, searched=searched, since=since, valid_for=valid_for)
        assert outdated == [False, not serves and 1 in searched]
        left = [valid_for - since if serves else INTERVAL, INTERVAL]
        np.testing.assert_allclose(sight.valid_for, [left[0 if i in searched else 1] for i in range(2)], rtol=1e-12)
        np.testing.assert_array_equal(sight.motion.poses.moved[:, 0], [0.0, 0.5 * outdated[1]])
        np.testing.assert_array_equal(sight.motion.poses.change[:, 0, 1], [0.0, 0.125 * outdated[1]])
    outdated, _ = updated(d, motion, displacement=(0.25, 0.6), searched=[0, 1], since=5e-3)  # it has not moved further
    assert outdated == [False, False]


@BOTH
def test_a_block_that_has_become_too_fast_for_its_places_is_found(d):
    """For those that were kept within twice the way at its speed then, half of what it falls by, and its size."""
    motion, size = still(d, 2), 0.8
    for valid_for, speed in ((4e-3, 0.0), (3e-3, 0.5), (-1e-4, 9.0)):
        within = 2 * (speed * valid_for + 0.5 * 9.81 * 5e-3**2 + 1e-3 * size)
        for more in (1e-6, -1e-6):
            motion.about[1] = within / valid_for * (1 + more) if valid_for > 0 else 99.0
            outdated, _ = updated(
                d, motion, searched=[0, 1], since=0.0, valid_for=valid_for, speed=speed, displacement=(9.0, 9.0)
            )
            assert outdated == [False, more > 0 and valid_for > 0]


def found_places(d, pairs, gap):
    """Places of pairs of blocks."""
    face, other = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    each = np.ones(len(gap))
    return ContactPlaces(face, other, np.zeros((len(gap), d)), np.zeros((len(gap), d)), np.array(gap), each, each)


def valid_times(found, motion, sizes, outdated=(0, 1, 2), valid_for=9.0):
    """For how long the contacts of blocks are valid, and which may touch by then."""
    count = len(sizes)
    valid_for, may_touch = np.full(count, valid_for), np.zeros(len(found.gap), dtype=bool)
    searched = Validity.initial(motion.poses, INTERVAL)._replace(
        valid_for=valid_for, outdated=np.isin(np.arange(count), outdated)
    )
    validity.set_validity(found, motion, sizes, searched, may_touch, INTERVAL)
    return valid_for, may_touch.tolist()


@BOTH
def test_contacts_are_valid_until_a_pair_has_gone_too_far(d):
    """A share of the size of the smaller block, or half of the gap where that is more, at the speed of both. The faster
    block is found again then."""
    motion, sizes = still(d, 3), np.array([0.5, 0.8, 0.3])
    motion.velocity[0], motion.velocity[1], motion.about[:] = 1.0, -1.0, [0.5, 0.25, 0.125]
    speed = 2 * math.sqrt(d) + 0.75
    for gap, until in ((0.0, 0.01 / speed), (0.015, 0.01 / speed), (-1.0, 0.01 / speed), (0.024, 0.012 / speed)):
        valid_for, _ = valid_times(found_places(d, [[0, 1]], [gap]), motion, sizes)
        np.testing.assert_allclose(valid_for, [until, 5e-3, 5e-3], rtol=1e-14)
    both = found_places(d, [[2, 1], [0, 1], [2, 0]], [0.0, 0.0, 0.0])
    valid_for, _ = valid_times(both, motion, sizes)
    with_third = 0.006 / (math.sqrt(d) + 0.375), 0.006 / (math.sqrt(d) + 0.625)
    np.testing.assert_allclose(valid_for, [min(0.01 / speed, with_third[1]), with_third[0], 5e-3], rtol=1e-14)
    valid_for, _ = valid_times(both, motion, sizes, outdated=[1, 2])  # the faster one of those that are found
    np.testing.assert_allclose(valid_for, [9.0, min(0.01 / speed, with_third[0]), with_third[1]], rtol=1e-14)
    motion.about[0], motion.about[1] = 0.25, 0.25  # as fast: the block of the face
    for pair in ([0, 1], [1, 0]):
        valid_for, _ = valid_times(found_places(d, [pair], [0.0]), motion, sizes)
        assert valid_for[pair[0]] < valid_for[pair[1]] == 5e-3


def test_contacts_are_valid_neither_too_long_nor_too_short():
    motion, sizes = still(2, 2), np.array([0.5, 0.8])
    for found in (found_places(2, [], []), found_places(2, [[0, 1]], [0.0])):
        assert valid_times(found, motion, sizes)[0].tolist() == [INTERVAL] * 2
    motion.about[0] = 1e3
    valid_for, _ = valid_times(found_places(2, [[0, 1]], [0.0]), motion, sizes)
    assert valid_for.tolist() == [5e-4, 5e-3]


def test_places_are_kept_that_may_touch_before_either_block_is_found_again():
    motion, sizes = still(2, 2), np.array([0.5, 0.8])
    motion.about[0] = 1.0  # found again after 5 ms
    within = 2 * (1.0 * 5e-3 + 2 * 0.5 * 9.81 * 5e-3**2 + 1e-3 * 0.5)
    gap = [-0.1, 0.0, within * (1 - 1e-9), within * (1 + 1e-9)]
    valid_for, may_touch = valid_times(found_places(2, [[0, 1]] * 4, gap), motion, sizes)
    assert (valid_for.tolist(), may_touch) == ([5e-3, 5e-3], [True, True, True, False])
    within = 2 * (1.0 * 2e-3 + 2 * 0.5 * 9.81 * 5e-3**2 + 1e-3 * 0.5)  # the other one is found again after 2 ms
    found = found_places(2, [[0, 1], [1, 0]] * 2, np.repeat([within * (1 - 1e-9), within * (1 + 1e-9)], 2))
    valid_for, may_touch = valid_times(found, motion, sizes, outdated=[0], valid_for=2e-3)
    assert (valid_for.tolist(), may_touch) == ([5e-3, 2e-3], [True, True, False, False])
    motion.about[0] = 10.0  # found again after 1 ms, for all places
    within = 2 * (10.0 * 1e-3 + 2 * 0.5 * 9.81 * 5e-3**2 + 1e-3 * 0.5)
    gap = [within * (1 + 1e-9), within * (1 - 1e-9), 0.0, 0.05]
    valid_for, may_touch = valid_times(found_places(2, [[0, 1]] * 4, gap), motion, sizes)
    np.testing.assert_allclose(valid_for, [1e-3, 5e-3])
    assert may_touch == [False, True, True, False]


@BOTH
def test_springs_hold_what_they_store(d):
    lines = [(0, -0.003, 0.02), (0, 0.002, 0.0), (0, -0.001, 0.0)]
    whole, _ = slipped(d, lines, [1.0])
    for body in whole.bodies:
        validity.update_rotation(body)
    whole.lines["k"] = [1e5, 2e5, 4e5]
    depth = np.full(2, 9.0)
    assert validity.account(whole, np.array([2, 1]), depth).energy == pytest.approx(0.5 * 4e5 * 1e-6, rel=1e-9)
    np.testing.assert_allclose(depth, [0.001, 0.0], rtol=1e-9)
    assert validity.account(whole, np.array([0, 2]), depth).energy == pytest.approx(
        0.5 * 1e5 * 9e-6 + 0.5 * 4e5 * 1e-6, rel=1e-9
    )
    np.testing.assert_allclose(depth, [0.003, 0.001], rtol=1e-9)


@pytest.mark.parametrize("face", [-1, 0])
def test_springs_give_what_they_hold_less_a_moment_later(face):
    """A central difference of the energy, with the bodies moved along their velocities. An open line gives nothing."""
    whole, _ = slipped(2, [(0, -0.003, 0.02), (0, 0.002, 0.0), (0, -0.001, 0.0)], [1.0], (face,))
    whole.lines["k"], moment = [1e5, 2e5, 4e5], 1e-6
    place, angle = np.array(whole.bodies["place"]), np.array(whole.bodies["angle"])

    def at(time):
        whole.bodies["place"] = place + time * np.array(whole.bodies["velocity"])
        whole.bodies["angle"] = angle + time * np.array(whole.bodies["spin"])[:, 0]
        for body in whole.bodies:
            validity.update_rotation(body)
        return validity.account(whole, np.arange(3), np.empty(3))

    gives = (at(-moment).energy - at(moment).energy) / (2 * moment)
    assert abs(gives) > 10.0
    assert at(0.0).power == pytest.approx(gives, rel=1e-6)
