"""Places that take the place of lines, one function at a time: where they are, and what they take over."""

import math

import numpy as np
import pytest
from by_hand import ANGLES, PLACE, REST, TURNS, matrix, system

from mjrock.distinct.contacts import faces
from mjrock.distinct.contacts.touches import FIRST_OPENING
from mjrock.distinct.rows import POINT_ON_FIXED_BLOCK, kinds
from mjrock.distinct.search import handover
from mjrock.distinct.search.finder import ContactPlaces
from mjrock.distinct.search.handover import Blocks, Lines, Pairs, Place
from mjrock.distinct.search.solids import Poses
from mjrock.rows import rows

BOTH = pytest.mark.parametrize("d", [2, 3])
MOVED = np.array([0.21, -0.32, 0.23])


def cut(a, d):
    """The components of a vector that the plane has."""
    return np.ascontiguousarray(np.asarray(a)[..., [0, 2] if d == 2 else [0, 1, 2]])


def blocks(d):
    """Block 0 is fixed and moved by a support, blocks 1 and 2 are the bodies of `system`."""
    drawn = cut(np.vstack([[0.1, 0.2, -0.3], REST]), d)
    moved = cut(np.vstack([MOVED, PLACE]), d)
    change = np.array([np.zeros((d, d)), *(matrix(d, i) - np.eye(d) for i in range(2))])
    numbers = np.array([-1, 0, 1]), np.array([0, -1, -1]), np.array([0, -1, -1])
    return Blocks(Poses(drawn, moved, change), np.array([1.0, 0.5, 0.8]), np.array([1, 2]), *numbers)


def turn(d, block):
    return np.eye(d) if block == 0 else matrix(d, block - 1)


def centre(d, block):
    poses = blocks(d).poses
    return poses.drawn[block] + poses.moved[block]


NORMAL = {2: np.array([0.6, 0.8]), 3: np.array([0.48, 0.6, 0.64])}
ALONG = np.cross(NORMAL[3], (1.0, 0.0, 0.3))
ALONG /= np.linalg.norm(ALONG)
"""A unit vector along the face in space."""
AT = {2: np.array([0.2, 0.7]), 3: np.array([0.2, -0.4, 0.7])}


def found(d, face, other, gap=-0.004, count=1):
    """Places of two blocks, all at one point."""
    place = np.tile(AT[d], (count, 1)) + np.arange(count)[:, None] * 0.05
    each = np.ones(count)
    return ContactPlaces(
        np.full(count, face), np.full(count, other), place, np.tile(NORMAL[d], (count, 1)), gap * each, each, each
    )


def written(d, face, other, gap=-0.004, slack=0.0):
    """A system whose line is written by a place."""
    whole = system(d)
    whole.supports.moved[0] = cut(MOVED, d)
    handover.write_line(whole.lines[0], 0, slack, found(d, face, other, gap), blocks(d))
    return whole


@BOTH
def test_vectors_turn_with_their_block(d):
    for block in range(3):
        there = handover.turned(blocks(d).poses, block, tuple(AT[d]))
        np.testing.assert_allclose(there, turn(d, block) @ AT[d], rtol=1e-13)
        back = handover.turned_back(blocks(d).poses, block, tuple(AT[d]))
        np.testing.assert_allclose(back, turn(d, block).T @ AT[d], rtol=1e-13)
        axes = system(d).axes
        np.testing.assert_allclose(handover.centroid(blocks(d).poses, block, axes), centre(d, block), rtol=1e-13)
    assert TURNS.magnitude().min() > 0.5
    assert np.abs(ANGLES).min() > 0.3


@BOTH
@pytest.mark.parametrize(("face", "other"), [(1, 2), (2, 1), (0, 1), (0, 2), (1, 0), (2, 0)])
@pytest.mark.parametrize("slack", [0.0, 0.0015])
def test_a_line_is_where_its_place_was_found(d, face, other, slack):
    """Its gap is that of the place less what presses nothing, and its points are half a gap to either side."""
    whole = written(d, face, other, slack=slack)
    line, numbers = whole.lines[0], blocks(d)
    meet = faces.meeting(whole, line)
    assert meet.gap == pytest.approx(-0.004 + slack, rel=1e-10)
    point = other == 0  # the corner of a fixed block meets the face of a body
    carries, faced = (face, other) if point else (other, face)
    normal = -NORMAL[d] if point else NORMAL[d]
    np.testing.assert_allclose(meet.normal, normal, rtol=1e-12)
    assert (line.body, line.face) == (carries - 1, POINT_ON_FIXED_BLOCK if point else numbers.body[faced])
    assert (line.support, line.fixed) == ((0, 0) if 0 in (face, other) else (-1, -1))
    half = -0.002 * normal
    at = turn(d, carries).T @ (AT[d] + half - centre(d, carries))
    np.testing.assert_allclose(line.at, at, rtol=1e-11)
    arm = AT[d] - half - slack * normal - centre(d, carries) if point else AT[d] + half - centre(d, carries)
    np.testing.assert_allclose(meet.arm, arm, rtol=1e-11)
    if 0 not in (face, other):
        np.testing.assert_allclose(meet.face_arm, AT[d] + half - centre(d, face), rtol=1e-11)
    place = handover.place_of(line, face + other, numbers)
    assert place.sense == (1.0 if carries > faced else -1.0)
    assert place.face == faced
    np.testing.assert_allclose(place.normal, normal, rtol=1e-12)
    expected = AT[d] - half - slack * normal if point else AT[d] + half
    np.testing.assert_allclose(place.at, expected, rtol=1e-11)


def with_points(table, both, d):
    """Lines with their points, of two blocks whose numbers have some sum."""
    lines = Lines.unwritten(table, np.zeros(len(table)))
    for line, at in zip(table, lines.at, strict=True):
        at[:] = handover.place_of(line, both, blocks(d)).at
    return lines


def lines_of(table, slack, depth):
    """Lines of which it is known how deep they press."""
    lines = Lines.unwritten(table, np.array(slack, dtype=float))
    lines.depth[:] = depth
    return lines


@BOTH
def test_the_nearest_of_some_lines_is_found(d):
    numbers = blocks(d)
    table, places = rows(kinds(d).line, 4), found(d, 1, 2, count=4)
    for i in range(4):
        handover.write_line(table[i], i, 0.0, places, numbers)
    lines = with_points(table, 3, d)
    where = lines.at
    aim = where[1] + 0.004
    j, off = handover.nearest(lines, (0, 4), tuple(aim))
    assert (j, off) == (1, pytest.approx(0.004 * math.sqrt(d), rel=1e-9))
    j, off = handover.nearest(lines, (2, 4), tuple(aim))
    assert (j, off) == (2, pytest.approx(np.linalg.norm(where[2] - aim)))
    assert handover.nearest(lines, (3, 3), tuple(aim)) == (-1, math.inf)
    lines.at[2] = lines.at[1]
    assert handover.nearest(lines, (0, 4), tuple(aim))[0] == 1
    assert handover.nearest(lines, (0, 4), tuple(aim + 1e6))[0] == 3


def gone_at(d, shift=0.0, normal=None, slack=0.0, blocks_of=(1, 2)):
    """One line that is gone, at the place of `found` moved by a shift along x."""
    table, place = rows(kinds(d).line, 1), found(d, *blocks_of)
    place.place[0, 0] += shift
    if normal is not None:
        place.normal[0] = normal
    handover.write_line(table[0], 0, 0.0, place, blocks(d))
    lines = with_points(table, sum(blocks_of), d)
    lines.slack[:], lines.depth[:] = slack, 0.003
    return lines


def presses(d, gone, new=None, ends=(0, 1)):
    new = found(d, 1, 2) if new is None else new
    return handover.pressed_overlap(system(d).lines[0], 0, new, gone, ends, blocks(d))


@BOTH
def test_what_presses_is_the_overlap_less_the_slack_of_the_line_that_was_there(d):
    assert presses(d, gone_at(d)) == pytest.approx(0.004)
    assert presses(d, gone_at(d, slack=0.001)) == pytest.approx(0.003)
    assert presses(d, gone_at(d, slack=0.005)) == 0.0
    assert presses(d, gone_at(d), ends=(0, 0)) == 0.0
    assert presses(d, gone_at(d), found(d, 1, 2, gap=0.001)) == 0.0
    assert presses(d, gone_at(d), found(d, 1, 2, gap=0.0)) == 0.0


@BOTH
def test_a_line_was_there_within_a_fifth_of_the_smaller_block_and_with_a_like_normal(d):
    """Along the face, whatever the overlap: the point of the line is half of it off the place along the normal."""
    bound = 0.2 * 0.5 / math.sqrt(1 - NORMAL[d][0] ** 2)
    assert presses(d, gone_at(d, bound - 1e-6)) > 0
    assert presses(d, gone_at(d, bound + 1e-6)) == 0
    assert presses(d, gone_at(d), found(d, 1, 2, gap=-0.4)) == pytest.approx(0.4)
    across = np.array([0.8, -0.6]) if d == 2 else np.array([-0.8, 0.0, 0.6])
    for cosine, there in ((0.71, True), (0.69, False)):
        normal = cosine * NORMAL[d] + math.sqrt(1 - cosine**2) * across
        assert bool(presses(d, gone_at(d, normal=normal)) > 0) is there
        swapped = found(d, 2, 1)
        swapped.normal[0] *= -1
        assert bool(presses(d, gone_at(d, normal=normal), swapped) > 0) is there


@pytest.mark.parametrize(("off", "there"), [(0.0999, True), (0.2 * 0.5, True), (math.hypot(0.1, 0.002) + 1e-9, False)])
def test_at_a_fifth_of_the_smaller_block_no_line_was_there(off, there, monkeypatch):
    monkeypatch.setattr(handover, "square_between", lambda *given: off**2)
    assert bool(presses(2, gone_at(2)) > 0) is there


@BOTH
def test_normals_of_a_pair_are_compared_out_of_the_same_block(d):
    """A place with the other block's face has the opposite normal."""
    swapped = found(d, 2, 1)
    assert presses(d, gone_at(d), swapped) == 0.0
    swapped.normal[0] *= -1
    assert presses(d, gone_at(d), swapped) == pytest.approx(0.004)
    fixed = found(d, 0, 1)
    assert presses(d, gone_at(d, blocks_of=(0, 1)), fixed) == pytest.approx(0.004)
    other = gone_at(d, normal=-NORMAL[d], blocks_of=(1, 0))
    assert presses(d, other, fixed) == pytest.approx(0.004)


def pressing(k, depth, gaps, had_k, had_depth):
    kind = kinds(2).line
    new = lines_of(rows(kind, len(k), k=k), np.zeros(len(k)), depth)
    gone = lines_of(rows(kind, len(had_k), k=had_k), np.zeros(len(had_k)), had_depth)
    places = found(2, 1, 2, count=len(k))._replace(gap=np.array(gaps, dtype=float))
    handover.press(new, (1, len(k)), places, gone, (1, len(had_k)))
    return new.depth


def test_places_press_as_much_in_all_as_the_lines_before_them():
    """The first place and the first line are of another pair."""
    depth = pressing([9.0, 2.0, 3.0], [9.0, 0.2, 0.1], [-9.0, -1.0, -1.0], [9.0, 1.0, 2.0], [9.0, 0.1, 0.25])
    had, force = 1.0 * 0.1 + 2.0 * 0.25, 2.0 * 0.2 + 3.0 * 0.1
    np.testing.assert_allclose(depth, [9.0, 0.2 * had / force, 0.1 * had / force], rtol=1e-12)


def test_places_hold_no_more_energy_and_regain_a_quarter_at_most():
    depth = pressing([1.0, 1.0, 1.0], [0.0, 0.3, 0.0], [0.0, -1.0, -1.0], [1.0, 1.0, 1.0], [0.0, 0.2, 0.2])
    np.testing.assert_allclose(depth, [0.0, math.sqrt(0.08), 0.0], rtol=1e-12)
    depth = pressing([1.0, 1.0], [0.0, 0.1], [0.0, -1.0], [1.0, 1.0], [0.0, 1.0])
    np.testing.assert_allclose(depth, [0.0, 0.125])


def test_places_press_no_more_than_their_overlap_and_nothing_where_nothing_presses():
    np.testing.assert_allclose(pressing([1.0, 1.0], [0.0, 0.1], [0.0, -0.11], [1.0, 1.0], [0.0, 1.0]), [0.0, 0.11])
    np.testing.assert_allclose(pressing([1.0, 1.0], [0.0, 0.1], [0.0, 0.5], [1.0, 1.0], [0.0, 1.0]), [0.0, 0.0])
    np.testing.assert_allclose(pressing([1.0, 1.0], [0.0, 0.0], [0.0, -1.0], [1.0, 1.0], [0.0, 1.0]), [0.0, 0.0])
    small = pressing([1.0, 1.0], [0.0, 0.1], [0.0, -1.0], [1.0, 1.0], [0.0, 0.05])
    np.testing.assert_allclose(small, [0.0, 0.05])


def place(d, normal, sense, face=1):
    return Place((0.0,) * d, tuple(normal), face, sense)


def test_what_acts_along_a_face_turns_with_it():
    """In the plane it is along the tangent, whose sense is that of the normal; in space it is a vector, of which its
    part along the new face is left. Past an end of its face it is turned back along this first, as long as it is."""
    one, other = place(2, (0.0, 1.0), 1.0), place(2, (0.6, 0.8), -1.0)
    assert handover.along_new((2.0,), one, other) == pytest.approx((-1.6,))
    assert handover.along_new((2.0,), other, other) == pytest.approx((2.0,))
    deep = place(3, NORMAL[3], -1.0), place(3, NORMAL[3], 1.0)
    assert handover.along_new(tuple(2.0 * ALONG), *deep) == pytest.approx(tuple(-2.0 * ALONG))
    one, other = place(3, (0.0, 0.0, 1.0), 1.0), place(3, (0.6, 0.0, 0.8), -1.0)
    expected = tuple(-1.6 * np.array([0.8, 0.0, -0.6]))
    assert handover.along_new((2.0, 0.0, 0.0), one, other) == pytest.approx(expected)
    past = tuple(2.0 * np.array([0.96, 0.0, 0.28]))
    assert handover.along_new(past, one, other) == pytest.approx(expected)


def line_at(whole, number, face, other, **law):
    """A line of a system that is written by a place whose face is that of one of two blocks."""
    place = found(len(whole.axes), face, other)
    place.normal[0] *= 1.0 if other > face else -1.0
    handover.write_line(whole.lines[number], 0, 0.0, place, blocks(len(whole.axes)))
    for name, value in law.items():
        whole.lines[number][name] = value
    return whole.lines[number]


def in_world(line, d):
    """What a line keeps along its face, in the axes of the world; a number along the tangent in the plane."""
    return line.shear_state if d == 2 or line.face < 0 else matrix(d, line.face) @ line.shear_state


@BOTH
@pytest.mark.parametrize(("old", "new"), [((1, 2), (2, 1)), ((2, 1), (1, 2)), ((0, 1), (1, 0)), ((1, 0), (0, 1))])
@pytest.mark.parametrize("k_s", [(3e4, 6e4), (math.inf, math.inf)])
@pytest.mark.parametrize("share", [1.0, 0.25])
def test_a_line_takes_over_a_share_of_force_and_friction(d, old, new, k_s, share):
    """The force of a shear spring stays, and rigid friction. In space they turn into the axes of the new face."""
    whole = system(d, 2)
    drag = [0.3] if d == 2 else 0.3 * ALONG
    gone = line_at(
        whole, 0, *old, k_s=k_s[0], shear_state=0.4, shear_force=drag, push=5.0, dashpot_force=2.0, depth=0.1, rate=0.7
    )
    if d == 3:
        gone.shear_state[:] = 0.4 * ALONG if gone.face < 0 else matrix(d, gone.face).T @ (0.4 * ALONG)
    line = line_at(whole, 1, *new, k_s=k_s[1], shear_force=2.0, push=3.0, dashpot_force=4.0, depth=0.05, rate=0.2)
    ends = [handover.place_of(one, sum(old), blocks(d)) for one in (gone, line)]
    sense = ends[0].sense * ends[1].sense
    if d == 2:
        sense *= np.dot(ends[0].normal, ends[1].normal)  # tangents turn as normals do
    handover.give(gone, line, share, sum(old), blocks(d))
    assert (line.push, line.dashpot_force) == pytest.approx((3.0 + 5.0 * share, 4.0 + 2.0 * share))
    assert (line.depth, line.rate) == (0.1, 0.7)
    softer = 0.5 if k_s[0] < math.inf else 1.0
    np.testing.assert_allclose(in_world(line, d), share * softer * sense * in_world(gone, d), rtol=1e-12)
    np.testing.assert_allclose(line.shear_force, 2.0 + share * sense * np.array(drag), rtol=1e-12)
    kept = line.shear_state.copy()
    gone.depth = 0.01
    handover.give(gone, line, share, sum(old), blocks(d))
    assert line.depth == 0.1
    np.testing.assert_allclose(line.shear_state, 2 * kept, rtol=1e-12)


@BOTH
def test_places_that_are_as_near_share_what_a_line_has(d):
    """The first two of three places lie on either side of the line, and the third one is farther."""
    whole = system(d, 4)
    gone = line_at(whole, 0, 1, 2, push=5.0, depth=0.1)
    for number, shift in ((1, 0.1), (2, -0.1), (3, 0.11)):
        place = found(d, 1, 2)
        place.place[0, 0] += shift
        handover.write_line(whole.lines[number], 0, 0.0, place, blocks(d))
    lines = with_points(whole.lines, 3, d)
    handover.give_to_nearest(gone, lines, (1, 4), 3, blocks(d))
    np.testing.assert_allclose(whole.lines["push"], [5.0, 2.5, 2.5, 0.0])
    handover.give_to_nearest(gone, lines, (2, 4), 3, blocks(d))
    np.testing.assert_allclose(whole.lines["push"], [5.0, 2.5, 7.5, 0.0])


def test_places_and_lines_of_the_same_two_blocks_belong_together():
    pairs = Pairs.belonging(np.array([4, 4, 9, 2]), np.array([1, 4, 4, 9]))
    np.testing.assert_array_equal(pairs.first, [0, 2, 3, 4])
    np.testing.assert_array_equal(pairs.low, [1, 3, 1])
    np.testing.assert_array_equal(pairs.high, [3, 4, 1])
    none = Pairs.belonging(np.zeros(0, dtype=int), np.array([1]))
    assert len(none.low) == len(none.high) == 0


def hand_over(*given):
    handover.keep_depths(*given)
    handover.hand_over(*given)


@BOTH
@pytest.mark.parametrize("k_s", [2e4, math.inf])
def test_lines_are_handed_over_pair_by_pair(d, k_s):
    """Two places of bodies 1 and 2 follow two lines, and one of the ground follows none."""
    numbers, kind = blocks(d), kinds(d).line
    two, one = found(d, 1, 2, count=2), found(d, 0, 1)
    places = ContactPlaces(*(np.concatenate([a, b]) for a, b in zip(two, one, strict=True)))
    old = rows(kind, 3, k=1e4, k_s=k_s, friction=0.5)
    for i in range(2):
        handover.write_line(old[i], i, 0.0, two, numbers)
    handover.write_line(old[2], 1, 0.0, two, numbers)
    along = np.ones(1) if d == 2 else ALONG
    shear_state = along if d == 2 else turn(d, 1).T @ along
    old["push"], old["shear_force"] = [30.0, 0.0, 0.0], along * [[1.0], [2.0], [4.0]]
    old["shear_state"] = shear_state * (1.0 if k_s == math.inf else 1e-5)
    gone = lines_of(old, np.zeros(3), [0.003, 0.002, 0.0])
    old["depth"] = [0.003, 0.002, 0.0]
    new = lines_of(rows(kind, 3, k=1e4, k_s=k_s, friction=0.5), np.zeros(3), 0.0)
    pairs = Pairs.belonging(np.array([5, 5, 1]), np.array([5, 5, 5]))
    hand_over(new, places, gone, pairs, numbers)
    np.testing.assert_allclose(new.depth, [0.0025, 0.0025, 0.0], rtol=1e-9)  # the sum of what pressed before
    opening = FIRST_OPENING * numbers.sizes[:2].min()  # what follows nothing begins open, though its blocks overlap
    np.testing.assert_allclose(new.slack, [0.0015, 0.0015, 0.004 + opening], rtol=1e-11)
    np.testing.assert_allclose(new.rows["push"], [30.0, 0.0, 0.0])
    np.testing.assert_allclose(
        new.rows["shear_force"] @ along, [1.0, 2.0, 0.0], rtol=1e-12
    )  # what was open gives nothing
    ends = zip(new.rows, (3, 3, 1), strict=True)
    sides = np.array([handover.place_of(line, both, numbers).at for line, both in ends])
    np.testing.assert_allclose(sides, places.place - 0.002 * NORMAL[d], rtol=1e-9)
    grips = np.linalg.norm(new.rows["shear_state"], axis=1)
    if k_s == math.inf:
        np.testing.assert_allclose(grips, np.linalg.norm(old["shear_state"], axis=1) * [1, 1, 0], rtol=1e-9)
    else:
        np.testing.assert_allclose(grips, [1e-5, 1e-5, 0.0], rtol=1e-9)
        old["shear_state"] = shear_state  # more than the face holds
        new = lines_of(rows(kind, 3, k=1e4, k_s=k_s, friction=0.5), np.zeros(3), 0.0)
        hand_over(new, places, gone, pairs, numbers)
        held = 0.5 * 1e4 * 0.0025 / k_s
        np.testing.assert_allclose(np.linalg.norm(new.rows["shear_state"], axis=1), [held, held, 0.0], rtol=1e-9)


def test_friction_turns_from_the_face_of_one_block_to_that_of_the_other():
    """A place on the other block's face: what acts on its body is against what acted on the one before."""
    numbers, kind = blocks(3), kinds(3).line
    old, places = rows(kind, 1, k=1e4, k_s=math.inf, friction=0.5), found(3, 2, 1)
    handover.write_line(old[0], 0, 0.0, found(3, 1, 2), numbers)
    old["push"], old["depth"], old["shear_state"] = 30.0, 0.003, turn(3, 1).T @ (0.4 * ALONG)
    places.normal[0] *= -1
    new = lines_of(rows(kind, 1, k=1e4, k_s=math.inf, friction=0.5), np.zeros(1), 0.0)
    pairs = Pairs.belonging(np.array([5]), np.array([5]))
    hand_over(new, places, lines_of(old, np.zeros(1), 0.003), pairs, numbers)
    before, after = turn(3, 1) @ old["shear_state"][0], turn(3, 2) @ new.rows["shear_state"][0]
    np.testing.assert_allclose(after, -before, rtol=1e-12)
